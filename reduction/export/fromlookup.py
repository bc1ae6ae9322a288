"""A line for export from what is known of it for look-up: its curve, its dynamics at a mean.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, eqs. 1-4, Tables 6, 8, 14, 17.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, Literal

import numpy as np

from reduction.digits import plain_number
from reduction.errors import DataError, SettingsError
from reduction.export.linedynamics import line_dynamics
from reduction.export.product import ExportLine
from reduction.export.start import start_against
from reduction.lookup.curve import evaluate_curve
from reduction.lookup.product import LineCurve, LineSource
from reduction.record import Floats

_POINTS = 201
_LARGE_CONSTANT = 0.01
_MOST_CUT, _LEAST_CUT = 0.9, 0.05  # shares of the greatest tension that a cut may leave or take
_STRAIN = ("strain", "quasi_static_strain")
_TENSION = ("tension", "branch_tension")
Branch = Literal["ascending", "descending"]


def line_from_lookup(
    source: LineSource,
    *,
    branch: Branch | None = None,
    siblings: Sequence[LineSource] = (),
    levels: Mapping[str, float] | None = None,
    extrapolate: Literal["refuse", "flag"] = "refuse",
    **stated: Any,
) -> ExportLine:
    """Make a line for export of a source of design values.

    Parameters
    ----------
    source : LineSource
        Published, or of a campaign.
    branch : {"ascending", "descending"}, optional
        Where curves differ by it.
    siblings : sequence of LineSource
        Other tests of the same tether: what they measured below the first point of the curve is
        held against the straight line that stands there.
    levels : mapping of str to float, optional
        ``frequency``, ``mean_tension`` and ``tension_amplitude`` at which static and dynamic
        stiffness are taken; without them the line has a curve alone. [Hz], [N], [N]
    extrapolate : {"refuse", "flag"}
        Outside the levels that were tested.
    **stated
        Fields of `ExportLine` that are better known; None and NaN are passed over.

    Returns
    -------
    line : ExportLine
        With source, range and errata of every number.

    Raises
    ------
    SettingsError
        If there is no curve of strain and tension, or it differs by branch and none is said, or
        the dynamics were not measured.
    DataError
        If the curve falls before its last tenth of tension, or a level is outside what was tested.

    Notes
    -----
    Static and dynamic stiffness are those of `reduction.export.linedynamics.line_dynamics`: K_0 and
    K_0 + K_1 at the mean tension, N = K_1 tau ([1]_), identified so that the line gives back its
    own K_ap and H.
    """
    curve = _trusted(source, _curve_of(source, branch))
    strain, tension, cut = _points(source, curve)
    start = start_against(strain, tension, curve.branch, siblings)
    notes = [*source.notes, *curve.notes, curve.range_note, *cut, *start]
    words = "of a pull" if not curve.branch else f"{curve.branch} branch"
    sources = [f"{source.source}: {curve.quantity} over {curve.variable}, {words}"]
    if curve.errata:
        sources.append(f"errata that touch the curve: {', '.join(curve.errata)}")
    part = None
    if levels:
        dynamics = line_dynamics(source, levels, extrapolate)
        part = dynamics.part
        sources += dynamics.sources
        notes += dynamics.notes
    given = {
        name: value
        for name, value in stated.items()
        if value is not None and not (isinstance(value, float) and math.isnan(value))
    }
    sources += [f"{name.replace('_', ' ')}: stated at the export" for name in given]
    own = {
        name: getattr(source, name)
        for name in (
            "diameter",
            "rated_break_strength",
            "linear_density",
            "wet_linear_density",
            "material",
        )
    }
    own["rated_break_strength"], said = _strength(source)
    if "rated_break_strength" not in given:
        notes.append(said)
    return ExportLine(
        name=source.name,
        strain=strain,
        tension=tension,
        curve=f"{curve.quantity} over {curve.variable}, {words}; one curve, no loop",
        tested=_tested(curve, strain, tension),
        viscoelasticity=part,
        sources=tuple(sources),
        notes=tuple(note for note in dict.fromkeys(notes) if note),
        **own | given,
    )


def _strength(source: LineSource) -> tuple[float, str]:
    """Strength that a code is told where none is stated, and why it is not the rated one. [N]."""
    if source.strength_of:
        return math.nan, (
            f"no break strength is exported: that of the source is of {source.strength_of}; state "
            "--rated-break-strength"
        )
    left = source.tensile_strength
    # NaN where the line is new: then the rated one stands
    if left < source.rated_break_strength:
        return left, (
            f"break strength {plain_number(left)} N: what the line has in its condition; "
            f"new it was rated "
            f"{plain_number(source.rated_break_strength)} N"
        )
    return source.rated_break_strength, ""


def _curve_of(source: LineSource, branch: Branch | None) -> LineCurve:
    """The one curve of strain and tension."""
    found = [
        one
        for one in source.curves
        if (one.quantity in _STRAIN and one.variable in ("tension", "mean_tension"))
        or (one.quantity in _TENSION and one.variable == "strain")
    ]
    if not found:
        why = next(
            (source.absent[name] for name in (*_STRAIN, *_TENSION) if name in source.absent), ""
        )
        raise SettingsError(
            f"{source.name} has no curve of tension and strain" + (f": {why}" if why else ""),
            found=", ".join(source.quantities) or "nothing",
            needed="strain over tension, or tension over strain",
        )
    # where one branch alone was measured it need not be asked for
    wanted = branch or (found[0].branch if len(found) == 1 else "")
    of_branch = [one for one in found if one.branch in ("", wanted)]
    if not of_branch:
        raise SettingsError(
            f"the curve of {source.name} differs by branch",
            found=branch or "no branch",
            needed=" or ".join(one.branch for one in found),
        )
    return of_branch[0]


def _trusted(source: LineSource, curve: LineCurve) -> LineCurve:
    """The curve as far as its slope can be trusted, where the source gives K_0 by that slope."""
    for rest in source.curves:
        if rest.is_inverse_slope and rest.high < curve.high and curve.variable == "tension":
            why = f"{curve.range_note}; {rest.range_note}" if curve.range_note else rest.range_note
            return replace(curve, high=rest.high, range_note=why)
    return curve


def _points(source: LineSource, curve: LineCurve) -> tuple[Floats, Floats, list[str]]:
    """Strain and tension where both rise, and what was cut."""
    at = curve.at if curve.at.size else np.linspace(curve.low, curve.high, _POINTS)
    value = evaluate_curve(curve, at).value
    strain, tension = (value, at) if curve.quantity in _STRAIN else (at, value)
    if not (np.isfinite(strain).all() and np.isfinite(tension).all()):
        raise DataError(
            f"the curve of {source.name} is not known throughout",
            found="values that are open or lost",
            hint="The errata of the source say which.",
        )
    # segments that meet give their joint twice
    new = np.append(True, (np.diff(strain) != 0) | (np.diff(tension) != 0))
    strain, tension, notes = strain[new], tension[new], []
    back = np.flatnonzero((np.diff(strain) <= 0) | (np.diff(tension) <= 0))
    if back.size:
        first, top = int(back[0]), float(tension.max())
        if not curve.coefficient.size or tension[first] < _MOST_CUT * top:
            raise DataError(
                f"the curve of {source.name} does not rise throughout what was tested",
                found=f"strain {plain_number(strain[first], 4)} to "
                f"{plain_number(strain[first + 1], 4)}, tension "
                f"{plain_number(tension[first])} to {plain_number(tension[first + 1])} N",
                needed="one that rises",
            )
        strain, tension = strain[: first + 1], tension[: first + 1]
        notes.append(
            f"ends at {plain_number(tension[-1])} N, where the polynomial turns back; the "
            f"source gives it up "
            f"to {plain_number(top)} N"
        )
    below = (strain < 0) | ((strain == 0) & (tension > 0))
    if below.any() and tension[below][-1] < _LEAST_CUT * tension[-1]:
        notes.append(
            f"the polynomial has strain below zero up to "
            f"{plain_number(tension[below][-1], 4)} N, by the "
            "constant of its fit; that part is left out"
        )
        strain, tension = strain[~below], tension[~below]
    if curve.coefficient.size and strain[0] > 0 and tension[0] == 0:
        strain, tension, said = _without_constant(strain, tension)
        notes.append(said)
    return strain, tension, notes


def _without_constant(strain: Floats, tension: Floats) -> tuple[Floats, Floats, str]:
    """The curve of a regression from where its constant weighs little.

    A pull starts at no strain and no tension; what a cubic has there is an error of its fit, and
    no slack that anybody measured.  Its share in the strain is a half at twice the constant; there,
    or at a twentieth of the greatest tension, the straight line from 0 0 joins the curve.
    """
    constant = float(strain[0])
    joins = (strain >= 2 * constant) | (tension >= _LEAST_CUT * tension[-1])
    first = int(np.argmax(joins))
    doubt = "DOUBTFUL: " if constant > _LARGE_CONSTANT else ""
    said = (
        f"{doubt}the regression has strain {constant:.4g} at no tension, a constant of its fit and "
        f"no slack that was measured: in its place a straight line from 0 0 joins it at strain "
        f"{plain_number(strain[first], 4)} and {plain_number(tension[first], 4)} N; as "
        f"slack it would be "
        f"{100 * constant:.2g} m in 100 m of line"
    )
    return strain[first:], tension[first:], said


def _tested(curve: LineCurve, strain: Floats, tension: Floats) -> tuple[float, float]:
    ends = np.array([curve.low, curve.high])
    if curve.quantity in _STRAIN:
        ends = np.interp(ends, tension, strain)
    return max(float(ends[0]), 0.0), min(float(ends[1]), float(strain[-1]))
