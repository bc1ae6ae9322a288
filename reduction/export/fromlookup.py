"""A line for export from what is known of it for look-up: its curve, its dynamics at a mean.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, eqs. 1-4, Tables 6, 8, 14, 17.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Literal

import numpy as np

from reduction.errors import DataError, SettingsError
from reduction.export.linedynamics import line_dynamics
from reduction.export.product import ExportLine
from reduction.lookup.curve import evaluate_curve
from reduction.lookup.product import LineCurve, LineSource
from reduction.record import Floats

__all__ = ["line_from_lookup"]

_POINTS = 201
_MOST_CUT, _LEAST_CUT = 0.9, 0.05  # shares of the greatest tension that a cut may leave or take
_STRAIN = ("strain", "quasi_static_strain")
_TENSION = ("tension", "branch_tension")
Branch = Literal["ascending", "descending"]


def line_from_lookup(
    source: LineSource,
    *,
    branch: Branch | None = None,
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
    curve = _curve_of(source, branch)
    strain, tension, cut = _points(source, curve)
    notes = [*source.notes, *curve.notes, *cut]
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
    return ExportLine(
        name=source.name,
        strain=strain,
        tension=tension,
        curve=f"{curve.quantity} over {curve.variable}, {words}; one curve, no loop",
        tested=_tested(curve, strain, tension),
        viscoelasticity=part,
        sources=tuple(sources),
        notes=tuple(dict.fromkeys(notes)),
        **own | given,
    )


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


def _points(source: LineSource, curve: LineCurve) -> tuple[Floats, Floats, list[str]]:
    """Strain and tension where both rise, and what was cut."""
    at = curve.at if curve.at.size else np.linspace(curve.low, curve.high, _POINTS)
    value = evaluate_curve(curve, at)[0]
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
                found=f"strain {strain[first]:.4g} to {strain[first + 1]:.4g}, tension "
                f"{tension[first]:.5g} to {tension[first + 1]:.5g} N",
                needed="one that rises",
            )
        strain, tension = strain[: first + 1], tension[: first + 1]
        notes.append(
            f"ends at {tension[-1]:.5g} N, where the polynomial turns back; the source gives it up "
            f"to {top:.5g} N"
        )
    below = (strain < 0) | ((strain == 0) & (tension > 0))
    if below.any() and tension[below][-1] < _LEAST_CUT * tension[-1]:
        notes.append(
            f"the polynomial has no strain up to {tension[below][-1]:.4g} N; that part is left out"
        )
        strain, tension = strain[~below], tension[~below]
    return strain, tension, notes


def _tested(curve: LineCurve, strain: Floats, tension: Floats) -> tuple[float, float]:
    ends = np.array([curve.low, curve.high])
    if curve.quantity in _STRAIN:
        ends = np.interp(ends, tension, strain)
    return max(float(ends[0]), 0.0), min(float(ends[1]), float(strain[-1]))
