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
from reduction.export.dynamics import Viscoelasticity
from reduction.export.product import ExportLine
from reduction.lookup.curve import evaluate_curve
from reduction.lookup.line import look_up
from reduction.lookup.product import DesignValues, LineCurve, LineSource
from reduction.record import Floats

__all__ = ["line_from_lookup"]

_POINTS = 201
_MEANS = 9
_ROUNDING = 1e-9
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
    EA_s is K_0 at the mean tension, EA_d is K_0 + K_1, and N = K_1 tau ([1]_).  The growth with
    the mean tension is that of the straight line of least squares through K_0 + K_1 at nine means
    over the tested ones, at the frequency and amplitude that were asked for, as far as no cycle
    among them goes slack; the note says how far off it is.
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
        part, told = _dynamics(source, levels, extrapolate)
        sources += told
    given = {
        name: value
        for name, value in stated.items()
        if value is not None and not (isinstance(value, float) and math.isnan(value))
    }
    sources += [f"{name.replace('_', ' ')}: stated at the export" for name in given]
    own = {
        name: getattr(source, name)
        for name in ("diameter", "rated_break_strength", "linear_density", "wet_linear_density")
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


def _dynamics(
    source: LineSource, levels: Mapping[str, float], extrapolate: Literal["refuse", "flag"]
) -> tuple[Viscoelasticity, list[str]]:
    """Static and dynamic stiffness and the dashpot at the levels, and where they are from."""
    if "mean_tension" not in levels:
        raise SettingsError(
            "static and dynamic stiffness need a mean tension", needed="--mean-tension"
        )
    rest = _value(source, "quasi_static_spring_constant", levels, extrapolate)
    spring = _value(source, "dissipation_spring_constant", levels, extrapolate)
    time = _value(source, "relaxation_time", levels, extrapolate)
    static, dynamic = float(rest.value), float(rest.value + spring.value)
    mean = float(levels["mean_tension"])
    slope, worst = _growth(source, levels)
    holds = ", ".join(f"{name.replace('_', ' ')} {value:.5g}" for name, value in levels.items())
    told = [
        f"{found.source}: {found.quantity} {float(found.value):.6g} {found.unit}, "
        + (
            f"95 percent {float(found.low):.4g} to {float(found.high):.4g}"
            if math.isfinite(float(found.high))
            else "no interval known"
        )
        + (f", errata {', '.join(found.errata)}" if found.errata else "")
        + ("" if found.is_inside else ", OUTSIDE what was tested")
        + (", untested corner" if found.is_untested else "")
        for found in (rest, spring, time)
    ]
    if slope > 0 and dynamic - slope * mean > 0:
        told.append(
            f"growth of the dynamic stiffness with the mean tension: {slope:.4g}, a straight line "
            f"over the tested means, off by up to {worst:.3g} N"
        )
    else:
        slope = 0.0
    return (
        Viscoelasticity(
            static_stiffness=static,
            dynamic_stiffness=dynamic - slope * mean,
            dashpot_coefficient=float(spring.value * time.value),
            dynamic_stiffness_per_mean_tension=slope,
            mean_tension=mean,
            holds=f"{holds} (SI)",
        ),
        told,
    )


def _value(
    source: LineSource,
    quantity: str,
    levels: Mapping[str, Any],
    extrapolate: Literal["refuse", "flag"],
) -> DesignValues:
    """Design value at those of the levels that the quantity varies with."""
    if quantity in source.surfaces:
        names = source.factor_names
    else:
        names = tuple(one.variable for one in source.curves if one.quantity == quantity)
    # a pull is over the tension, which is the mean of the cycles
    given = {
        name: levels["mean_tension"] if name == "tension" else levels[name]
        for name in names
        if name in levels or name == "tension"
    }
    return look_up(source, quantity, extrapolate=extrapolate, **given)


def _growth(source: LineSource, levels: Mapping[str, float]) -> tuple[float, float]:
    """Slope of K_0 + K_1 over the mean tension, and how far the line is off. [1], [N]."""
    surface = source.surfaces.get("dissipation_spring_constant")
    if surface is None or "mean_tension" not in source.factor_names:
        return 0.0, math.nan
    place = source.factor_names.index("mean_tension")
    low = max(float(surface.low[place]), levels.get("tension_amplitude", 0.0))
    means = np.linspace(low, float(surface.high[place]), _MEANS)
    over = {name: np.full(_MEANS, value) for name, value in levels.items()} | {
        "mean_tension": means
    }
    total = sum(
        _value(source, name, over, "flag").value
        for name in ("quasi_static_spring_constant", "dissipation_spring_constant")
    )
    slope, start = np.polyfit(means, total, 1)
    if abs(slope) * np.ptp(means) < _ROUNDING * np.abs(total).max():
        slope = 0.0
    return float(slope), float(np.abs(slope * means + start - total).max())
