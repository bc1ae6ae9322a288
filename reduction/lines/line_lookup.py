r"""Look-up of design values of a line from its surfaces and curves.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 3.4, 5.0; eq. 5, App. C; sec. 4.4.
.. [2] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole, MA,
   Tech. Rep. WHOI-2005-10, Dec. 2005, sec. 2.3.2.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from reduction.experiments.designs import (
    box_behnken,
    model_matrix,
    quadratic_exponents,
)
from reduction.experiments.surface_points import ABOVE_LEVERAGE
from reduction.lines.line_consistency import consistency_warnings
from reduction.lines.line_curve import (
    End,
    evaluate_curve,
    half_width_of_parts,
    interval_between_lines,
    is_even,
    own_half_width,
    shared_half_width,
    shared_of,
)
from reduction.lines.line_levels import completed_levels, evaluate_levels, refuse_mixed_conditions
from reduction.lines.line_surface import evaluate_surface
from reduction.lines.lookup_product import (
    OF_MEAN,
    CycleLoads,
    DesignValues,
    LineCurve,
    LineLevels,
    LineSource,
    LineSurface,
)
from reduction.quantities.digits import plain_number
from reduction.quantities.names import quantity as quantity_of
from reduction.record.contributions import (
    Component,
)
from reduction.record.errors import DataError, SettingsError
from reduction.record.measurement import Bools, Floats

LOADED_SHARE = 0.6
"""Greatest share of the break strength for a line that is always loaded. [1]"""

SLACK_SHARE = 0.3
"""The same for a line that goes slack. [1]"""

LEAST_SHARE = 0.03
"""Least tension over the break strength at which a line was found to keep its strength. [1]"""

_HOW_FLAGGED = "--extrapolate flag gives the number, where there is one, and flags it."

_SLACK = 1e-9


def cycle_loads(
    mean_tension: ArrayLike,
    tension_amplitude: ArrayLike,
    *,
    rated_break_strength: float,
    tensile_strength: float = float("nan"),
) -> CycleLoads:
    """Peak and minimum tension of a cycle, as loads and as shares of the break strength.

    Notes
    -----
    Source: [1]_, sec. 3.4, 5.0: at most 60 % of the break strength where a line is always loaded,
    30 % where it goes slack.  Between 3 % and 62 % (sec. 5.0) it kept its strength; from zero to
    above 30 % it failed.  Nothing was tested with less than 3 %, so the lower share is used there.
    For a line that lost strength, shares are of its residual strength.

    Examples
    --------
    Mean 21 % and amplitude 8.5 % of the break strength:

    >>> loads = cycle_loads(2100.0, 850.0, rated_break_strength=1e4)
    >>> print(loads.peak_share, loads.minimum_share, loads.is_above_rule)
    0.295 0.125 False
    """
    mean = np.asarray(mean_tension, dtype=np.float64)
    amplitude = np.asarray(tension_amplitude, dtype=np.float64)
    mean, amplitude = np.broadcast_arrays(mean, amplitude)
    if np.any(amplitude < 0):
        raise DataError("an amplitude is negative", found=f"{amplitude.min():g} N")
    least = mean - amplitude
    pushed = least < -_SLACK * np.maximum(mean, 1.0)
    if np.any(pushed):
        first = np.unravel_index(int(np.argmax(pushed)), pushed.shape)
        raise DataError(
            f"{int(pushed.sum())} of {pushed.size} amplitudes are above their mean tension: the"
            " line goes slack, which no surface describes",
            found=f"{plain_number(amplitude[first], 4)} N about {plain_number(mean[first], 4)} N",
            needed="an amplitude of at most the mean",
        )
    peak, least = mean + amplitude, np.maximum(least, 0.0)
    is_slack = least <= _SLACK * peak
    with np.errstate(invalid="ignore"):
        peak_share, least_share = peak / rated_break_strength, least / rated_break_strength
        own_peak, own_least = peak_share, least_share
        if np.isfinite(tensile_strength):
            own_peak, own_least = peak / tensile_strength, least / tensile_strength
        is_low = own_least < LEAST_SHARE * (1 - _SLACK)
        above = own_peak > np.where(is_low, SLACK_SHARE, LOADED_SHARE) * (1 + _SLACK)
    return CycleLoads(
        peak_tension=np.asarray(peak),
        minimum_tension=np.asarray(least),
        peak_share=np.asarray(peak_share),
        minimum_share=np.asarray(least_share),
        own_peak_share=np.asarray(own_peak),
        own_minimum_share=np.asarray(own_least),
        is_slack=np.asarray(is_slack),
        is_above_rule=np.asarray(above),
    )


def _loads_of_line(
    line: LineSource, given: Mapping[str, Floats], shape: tuple[int, ...], *, branch: str = ""
) -> CycleLoads:
    """Peak and minimum tension at the points of a look-up.

    Notes
    -----
    The rule of [1]_, sec. 3.4, 5.0 is for nylon and polyester, whose strength in cycles is lower
    with zero tension; a rubber tether must not go slack at all, since it tangles and is cut ([2]_).
    Beyond a curve given by points the tension is unknown, and no rule can be checked.

    Examples
    --------
    >>> rope = LineSource("a", "", "nylon", "braid", "new", 0.0127, 1e4)
    >>> loads = _loads_of_line(rope, {"mean_tension": np.array(3000.0)}, ())
    >>> print(loads.peak_share, loads.minimum_share)
    0.3 0.3
    """
    if {"mean_tension", "tension_amplitude"} <= set(given):
        mean, amplitude = given["mean_tension"], given["tension_amplitude"]
    else:
        mean, amplitude = _one_tension(line, given, branch), np.zeros(())
    known = np.where(np.isfinite(mean), mean, 0.0) if np.isnan(mean).any() else mean
    loads = cycle_loads(
        np.broadcast_to(known, shape),
        np.broadcast_to(amplitude, shape),
        rated_break_strength=line.rated_break_strength,
        tensile_strength=line.tensile_strength,
    )
    if known is not mean:
        unknown = np.broadcast_to(np.isnan(mean), shape)
        loads = _unknown_at(loads, unknown)
    if line.is_tether:
        _refuse_slack(line, loads)
        # the shares of the rule are for fibres
        loads = replace(loads, is_above_rule=np.zeros(shape, dtype=bool))
    return loads


def _one_tension(line: LineSource, given: Mapping[str, Floats], branch: str) -> Floats:
    """Tension at points without a cycle; NaN where it is not known."""
    for name in ("tension", "mean_tension"):
        if name in given:
            if np.any(given[name] < 0):
                raise DataError(
                    f"{name} is negative", found=f"{plain_number(given[name].min(), 4)} N"
                )
            return given[name]
    if "strain" in given:
        for curve in line.curves:
            if curve.quantity == "branch_tension" and curve.branch == branch:
                # noise about zero is zero
                return np.maximum(evaluate_curve(curve, given["strain"]).value, 0.0)
    return np.asarray(np.nan)


def _unknown_at(loads: CycleLoads, unknown: Bools) -> CycleLoads:
    numbers = (
        "peak_tension", "minimum_tension", "peak_share", "minimum_share", "own_peak_share",
        "own_minimum_share",
    )  # fmt: skip
    return replace(
        loads,
        **{name: np.where(unknown, np.nan, getattr(loads, name)) for name in numbers},
        is_slack=loads.is_slack & ~unknown,
    )


def _refuse_slack(line: LineSource, loads: CycleLoads) -> None:
    if loads.is_slack.any():
        peak = loads.peak_tension[loads.is_slack].ravel()[0]
        raise DataError(
            f"{line.name} goes slack at {int(loads.is_slack.sum())} of {loads.is_slack.size} "
            "points, which a tether must not",
            found=f"a minimum tension of zero, peak {plain_number(peak, 4)} N",
            needed="a minimum above zero",
            hint="A slack tether tangles and is cut: choose more stretch or less amplitude.",
        )


def _at(flags: Bools) -> str:
    """Number of points at which a flag is set; empty where it is set everywhere."""
    return "" if flags.all() else f"at {int(flags.sum())} of {flags.size} points "


def _design_values(
    line: LineSource,
    of: LineSurface | LineCurve | LineLevels,
    *,
    loads: CycleLoads,
    inside: Bools,
    untested: Bools,
    words: tuple[str, str],
    more: tuple[str, ...] = (),
    doubts: tuple[str, ...] = (),
    component: tuple[Component, ...] = (),
    **numbers: Floats,
) -> DesignValues:
    """Assemble the result of a look-up.

    Examples
    --------
    See `reduction.lines.line_lookup._values_of_curve`.
    """
    notes = [*line.notes, *of.notes, *more]
    if words[0] or words[1]:
        notes.append(_scatter_note(of, words))
    elif isinstance(of, LineCurve):
        notes.append("no interval is given: the source does not state the scatter of this curve")
    if loads.is_above_rule.any():
        notes.append(
            f"{_at(loads.is_above_rule)}the peak tension exceeds the limit of the source:"
            f" {line.rule}"
        )
    if loads.is_slack.any() and loads.peak_tension.max() > 0:
        notes.append(
            f"{_at(loads.is_slack)}the minimum is zero: a snap load, which breaks fibres"
            " (CG-D-39-80, sec. 5.0)"
        )
    below = int(np.sum(numbers["value"] < 0))
    if below:
        notes.append(
            f"{below} of {inside.size} values {'is' if below == 1 else 'are'} negative, which"
            f" {of.quantity} cannot be: the surface is not valid there"
        )
    return DesignValues(
        quantity=of.quantity,
        unit=quantity_of(of.quantity).unit,
        component=component,
        is_inside=inside,
        is_untested=untested,
        **(vars(loads) | numbers),
        rule=line.rule,
        source=line.source,
        errata=() if isinstance(of, LineLevels) else of.errata,
        notes=tuple(dict.fromkeys(notes)),
        warnings=of.warnings if isinstance(of, LineCurve) else doubts,
        branch=of.branch if isinstance(of, LineCurve) else "",
        interval_of=words[0],
        surface_interval_of=words[1],
    )


def _scatter_note(of: LineSurface | LineCurve | LineLevels, words: tuple[str, str]) -> str:
    """Scatter that the intervals include or leave out."""
    if isinstance(of, LineSurface) and np.isfinite(of.line_scatter):
        return (
            f"specimens of this kind scatter by about {100 * of.line_scatter:.0f} % (CG-D-39-80,"
            " sec. 4.4.1): included only in the intervals of the kind and of another specimen"
        )
    return interval_note(*words)


def interval_note(interval_of: str, surface_interval_of: str) -> str:
    """Note for an interval without scatter between lines, named as in `DesignValues`."""
    told = interval_of or surface_interval_of
    return f"the interval applies to {told}; scatter between specimens is not included"


def sigma_from_r2(coefficient: ArrayLike, r2: float) -> float:
    r"""Scatter of a run about a surface for which only coefficients and r2 are printed.

    .. math:: s^2 = \frac{(1 - r^2)}{r^2 \, \nu} \sum_i (\hat y_i - \bar{\hat y})^2

    Notes
    -----
    Least squares with a mean term keeps the mean of the fitted values equal to that of the runs,
    so the explained sum of squares follows from the coefficients and the design, which [1]_, eq. 5,
    App. C states.  The rounding of r2 matters: 0.985 stands for 0.9845 to 0.9855, sigma for
    +-1.7 %.

    Examples
    --------
    A slope of 1 alone explains 8 of fifteen runs; with r2 = 0.5 the residual is as much, over 5:

    >>> round(sigma_from_r2([0, 0, 0, 0, 1, 0, 0, 0, 0, 0], 0.5) ** 2, 12)
    1.6
    """
    values = np.asarray(coefficient, dtype=np.float64)
    exponents = quadratic_exponents(3)
    if not 0 < r2 < 1:
        return float("nan")
    coded = box_behnken(3).coded
    fitted = model_matrix(coded, exponents) @ values
    explained = float(np.sum((fitted - fitted.mean()) ** 2))
    freedom = len(coded) - len(exponents)
    return float(np.sqrt(explained * (1 - r2) / r2 / freedom))


def _values_of_curve(
    line: LineSource, curve: LineCurve, given: Mapping[str, Floats], extrapolate: str
) -> DesignValues:
    """Design values of a curve.

    Notes
    -----
    The interval is Student's t, with the effective degrees of freedom of all parts.

    Examples
    --------
    >>> pull = LineCurve("strain", "tension", 0.0, 100.0, coefficient=np.array([0.0, 0.01]))
    >>> rope = LineSource("rope", "", "nylon", "", "new", 0.0127, 1e4, curves=(pull,))
    >>> found = _values_of_curve(rope, pull, {"tension": np.array([10.0, 50.0])}, "refuse")
    >>> print(found.value, found.peak_share)
    [0.1 0.5] [0.001 0.005]
    """
    unknown = sorted(set(given) - {curve.variable})
    if unknown:
        raise SettingsError(
            f"{curve.quantity} of {line.name} does not vary with {', '.join(unknown)}",
            needed=f"levels of {curve.variable}",
        )
    at = given[curve.variable]
    found = evaluate_curve(curve, at)
    value, half, inside = found.value, found.half_width, found.is_inside
    if extrapolate == "refuse" and not inside.all():
        first = at.ravel()[np.flatnonzero(~inside.ravel())[0]]
        unit = _unit(curve.variable)
        gaps = "".join(
            f", nothing between {plain_number(low)} and {plain_number(high)}"
            for low, high in curve.gaps
            if low < first < high
        )
        raise DataError(
            f"outside the tested range of {curve.quantity} of {line.name}: {int((~inside).sum())}"
            f" of {inside.size} points",
            found=f"{curve.variable} {plain_number(first)}{unit}",
            needed=f"{plain_number(curve.low)} to {plain_number(curve.high)}{unit}{gaps}",
            hint=". ".join(
                part
                for part in (
                    curve.range_note, _HOW_FLAGGED
                )
                if part
            ),
        )  # fmt: skip
    nothing = np.full(at.shape, np.nan)
    return _design_values(
        line,
        curve,
        loads=_loads_of_line(line, given, at.shape, branch=curve.branch),
        inside=inside,
        untested=np.zeros(at.shape, dtype=bool),
        words=("", curve.spread_of if curve.standard_uncertainty.size else ""),
        more=(*((curve.range_note,) if curve.range_note else ()), *_joints(curve, at)),
        component=curve.component,
        contribution=found.contribution,
        random_standard_uncertainty=found.random,
        random_degrees_of_freedom=found.freedom,
        value=value,
        low=nothing,
        high=nothing,
        surface_low=value - half,
        surface_high=value + half,
        kind_low=nothing,
        kind_high=nothing,
        line_low=nothing,
        line_high=nothing,
    )


_TEST = "the tests at this level, of this specimen"

_MORE_TEST = "one more test at this level, of this specimen"


def _values_of_levels(
    line: LineSource, levels: LineLevels, given: Mapping[str, Floats]
) -> DesignValues:
    """Design values at levels of single tests; see `reduction.lines.line_levels`."""
    refuse_mixed_conditions(levels, line.name)
    whole = completed_levels(levels, given, line.name)
    columns = np.broadcast_arrays(*whole.values())
    shape = columns[0].shape
    found = evaluate_levels(levels, np.stack([one.ravel() for one in columns], axis=1), line.name)
    nothing = np.full(shape, np.nan)
    # the valley of a test that went slack is noise about zero
    ends = dict(whole)
    if "tension_amplitude" in ends:
        ends["tension_amplitude"] = np.minimum(ends["tension_amplitude"], ends["mean_tension"])
    is_apart = bool(np.isfinite(found.random).all())

    def part(values: Floats) -> Floats:
        return values.reshape(shape) if is_apart else np.empty(0)

    has_run = bool(np.isfinite(found.low).any())
    return _design_values(
        line,
        levels,
        loads=_loads_of_line(line, ends, shape),
        inside=np.ones(shape, dtype=bool),
        untested=np.zeros(shape, dtype=bool),
        words=(_MORE_TEST if has_run else "", _TEST),
        more=found.notes,
        doubts=found.warnings,
        component=levels.component,
        contribution=found.contribution.reshape(len(levels.component), *shape),
        random_standard_uncertainty=part(found.random),
        random_degrees_of_freedom=part(found.freedom),
        run_standard_uncertainty=part(found.run_random) if has_run else np.empty(0),
        value=found.value.reshape(shape),
        low=found.low.reshape(shape),
        high=found.high.reshape(shape),
        surface_low=found.test_low.reshape(shape),
        surface_high=found.test_high.reshape(shape),
        kind_low=nothing,
        kind_high=nothing,
        line_low=nothing,
        line_high=nothing,
    )


def _unit(name: str) -> str:
    """Unit as written after a number; empty for a dimensionless number."""
    unit = quantity_of(name).unit
    return "" if unit == "1" else f" {unit}"


def _joints(curve: LineCurve, at: Floats) -> list[str]:
    """Joints of two pieces with different values that coincide with a point."""
    if not curve.value.size:
        return []
    meet = (np.diff(curve.at) == 0) & (np.diff(curve.value) != 0)
    return [
        f"at {curve.variable} {plain_number(curve.at[place])} two pieces meet:"
        f" {plain_number(curve.value[place], 4)}{_unit(curve.quantity)} below,"
        f" {plain_number(curve.value[place + 1], 4)} above"
        for place in np.flatnonzero(meet)
        if np.any(at == curve.at[place])
    ]


_RUN = "one more run of the same specimens"

_SURFACE = "the surface of these specimens"


def _values_of_surface(
    line: LineSource, surface: LineSurface, given: Mapping[str, Floats], extrapolate: str
) -> DesignValues:
    """Design values of a surface.

    Notes
    -----
    For a run and the surface see `reduction.lines.line_surface.evaluate_surface`, for other lines
    `reduction.lines.line_curve.interval_between_lines`.

    Examples
    --------
    A surface that is constant, of one line among lines that differ by a tenth:

    >>> surface = LineSurface(
    ...     "relaxation_time", np.array([1.5]), np.array([[0]]), np.array([0.1]),
    ...     np.array([0.5]), np.eye(1) / 15, 0.1, 14.0, 1.0, line_scatter=0.1, n_lines=1.0,
    ... )
    >>> rope = LineSource("rope", "", "nylon", "", "new", 0.0127, 1e4, ("frequency",))
    >>> found = _values_of_surface(rope, surface, {"frequency": np.array([0.3])}, "refuse")
    >>> print(found.value, found.high.round(2), found.line_high.round(2))
    [1.5] [1.72] [2.1]
    """
    asked = _with_shares(line, given)
    unknown = sorted(set(asked) - set(line.factor_names))
    if unknown:
        raise SettingsError(
            f"{surface.quantity} of {line.name} does not vary with {', '.join(unknown)}",
            needed="levels of " + ", ".join(line.factor_names),
        )
    columns = np.broadcast_arrays(*(asked[name] for name in line.factor_names))
    shape = columns[0].shape
    at = np.stack([one.ravel() for one in columns], axis=1)
    points = evaluate_surface(surface, at)
    boxes = [(surface.low, surface.high), *surface.alternative_boxes]
    # the first choice is the surface itself
    choices = [
        (low, high, one)
        for low, high in boxes
        for one in (surface.coefficient, *surface.alternatives)
    ]
    others = [
        evaluate_surface(replace(surface, coefficient=one, low=low, high=high), at)
        for low, high, one in choices[1:]
    ]

    def span(name: str, ends: Callable[..., Floats]) -> Floats:
        found: Floats = getattr(points, name)
        for other in others:
            found = ends(found, getattr(other, name))
        return found.reshape(shape)

    inside = points.is_inside.reshape(shape)
    if extrapolate == "refuse" and not inside.all():
        _refuse_outside(line, surface, columns, inside)
    untested = points.leverage.reshape(shape) > ABOVE_LEVERAGE * surface.greatest_leverage
    value = points.value.reshape(shape)
    low, high = span("low", np.minimum), span("high", np.maximum)
    surface_low, surface_high = span("surface_low", np.minimum), span("surface_high", np.maximum)

    def between(low: Floats, high: Floats, *, is_another: bool) -> tuple[Floats, Floats]:
        return interval_between_lines(
            value, low, high, line_scatter=surface.line_scatter, n_lines=surface.n_lines,
            degrees_of_freedom=surface.degrees_of_freedom, is_another=is_another,
        )  # fmt: skip

    kind_low, kind_high = between(surface_low, surface_high, is_another=False)
    line_low, line_high = between(low, high, is_another=True)
    has_interval = bool(np.isfinite(surface.sigma))
    # where alternative surfaces may be right, the interval cannot be split into two parts
    is_apart = bool(surface.component) and not others

    def part(values: Floats) -> Floats:
        return values.reshape(shape) if is_apart else np.empty(0)

    return _design_values(
        line,
        surface,
        loads=_loads_of_line(line, given, shape),
        inside=inside,
        untested=inside & untested,
        words=(_RUN, _SURFACE) if has_interval else ("", ""),
        component=surface.component,
        contribution=points.contribution.reshape(len(surface.component), *shape),
        random_standard_uncertainty=part(points.random),
        random_degrees_of_freedom=part(points.random_freedom),
        run_standard_uncertainty=part(points.run_random),
        value=value,
        low=low,
        high=high,
        surface_low=surface_low,
        surface_high=surface_high,
        kind_low=kind_low,
        kind_high=kind_high,
        line_low=line_low,
        line_high=line_high,
    )


def _with_shares(line: LineSource, given: Mapping[str, Floats]) -> Mapping[str, Floats]:
    """Levels with the amplitude as a share of the mean, if the surfaces are over that."""
    loads = ("mean_tension", "tension_amplitude")
    if OF_MEAN not in line.factor_names or not set(loads) <= set(given):
        return given
    mean, amplitude = (given[name] for name in loads)
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.asarray(amplitude / mean)
    rest = {name: value for name, value in given.items() if name != "tension_amplitude"}
    return {**rest, OF_MEAN: share}


def _refuse_outside(
    line: LineSource, surface: LineSurface, columns: tuple[Floats, ...], inside: Bools
) -> None:
    first = np.flatnonzero(~inside.ravel())[0]
    told = []
    for place, (name, column) in enumerate(zip(line.factor_names, columns, strict=True)):
        value, low, high = column.ravel()[first], surface.low[place], surface.high[place]
        rounded = surface.rounding[place] if surface.rounding.size else 0.0
        if not low - rounded <= value <= high + rounded:
            unit = "1" if name == OF_MEAN else quantity_of(name).unit
            unit, factor = ("%", 100.0) if unit == "1" else (unit, 1.0)
            asked, least, most = (plain_number(factor * float(one)) for one in (value, low, high))
            told.append(f"{name} {asked} {unit}, tested {least} to {most} {unit}")
    raise DataError(
        f"outside the tested range of {surface.quantity} of {line.name}: {int((~inside).sum())} of"
        f" {inside.size} points",
        found="; ".join(told),
        needed="levels inside the tested range",
        hint=_HOW_FLAGGED,
    )


_DASHPOT = "dashpot_coefficient"

Branch = Literal["ascending", "descending"]


def look_up(
    line: LineSource,
    quantity: str,
    *,
    branch: Branch | None = None,
    extrapolate: Literal["refuse", "flag"] = "refuse",
    **levels: ArrayLike,
) -> DesignValues:
    """Design values of one quantity of a line.

    Parameters
    ----------
    line : LineSource
        Published, or from a campaign.
    quantity : str
        Quantity of the line.
    branch : {"ascending", "descending"}, optional
        Branch, for a quantity that differs by branch; needed where both exist.
    extrapolate : {"refuse", "flag"}
        Action for points outside the tested range.
    **levels : array_like, shape (...)
        Levels by name: the factors of the surface (``frequency``, ``mean_tension``,
        ``tension_amplitude``), the variable of the curve (``mean_tension``, ``tension``,
        ``strain``), or levels of single tests; levels equal in all tests may be left out. They are
        broadcast together. [SI]

    Returns
    -------
    values : DesignValues
        With interval, range, source and errata.

    Raises
    ------
    SettingsError
        If the line has no such quantity, a level is missing, not a factor of the quantity, not
        finite or does not broadcast, a frequency is not positive, or a branch is given for a
        quantity without branches.
    DataError
        If a point is outside the tested range and ``extrapolate`` is "refuse", an amplitude is
        above its mean tension, or a tether goes slack.

    Notes
    -----
    [1]_, sec. 4.4 calls the range of its levels the range of usefulness.  Inside it, the corners of
    a Box-Behnken cube are farther from the runs than any run is: they are flagged as untested.

    Examples
    --------
    >>> line = LineSource(
    ...     "rope", "an example", "nylon", "braid", "new", 0.0127, 28e3,
    ...     curves=(LineCurve("strain", "tension", 0.0, 100.0, coefficient=np.array([0, 0.01])),),
    ... )
    >>> look_up(line, "strain", tension=[10.0, 50.0]).value
    array([0.1, 0.5])
    """
    if quantity == _DASHPOT and quantity not in line.surfaces and line.has_dashpot:
        if branch is not None:
            raise _no_branch(quantity, line, branch)
        found = _dashpot(line, extrapolate, levels)
        return _warned(line, found, _numbers(levels))
    surface = line.surfaces.get(quantity)
    given = _numbers(levels)
    if surface is not None and set(_with_shares(line, given)) >= set(line.factor_names):
        if branch is not None:
            raise _no_branch(quantity, line, branch)
        return _warned(line, _values_of_surface(line, surface, given, extrapolate), given)
    curves = [one for one in line.curves if one.quantity == quantity]
    tested = next((one for one in line.levels if one.quantity == quantity), None)
    if tested is not None and surface is None and not curves:
        if branch is not None:
            raise _no_branch(quantity, line, branch)
        return _warned(line, _values_of_levels(line, tested, given), given)
    if not curves and surface is None:
        why = line.absent.get(quantity)
        raise SettingsError(
            f"{line.name} has no {quantity}" + (f": {why}" if why else ""),
            needed="one of " + ", ".join(line.quantities) if line.quantities else None,
            hint=None if line.quantities else "No quantity is printed for this line.",
        )
    curves = [one for one in curves if one.variable in given]
    if not curves:
        names = ["tension_amplitude" if one == OF_MEAN else one for one in line.factor_names]
        needed = [", ".join(names)] if surface is not None else []
        needed += [one.variable for one in line.curves if one.quantity == quantity]
        raise SettingsError(
            f"{quantity} of {line.name} needs another variable",
            found=", ".join(given) or "none",
            needed=" or ".join(dict.fromkeys(needed)),
        )
    curve = _of_branch(line, curves, branch)
    return _warned(line, _values_of_curve(line, curve, given, extrapolate), given)


def _warned(line: LineSource, found: DesignValues, given: dict[str, Floats]) -> DesignValues:
    """The values with warnings from other numbers of the line."""
    told = consistency_warnings(line, found.quantity, given)
    return replace(found, warnings=tuple(dict.fromkeys((*line.warnings, *found.warnings, *told))))


def _numbers(levels: Mapping[str, ArrayLike]) -> dict[str, Floats]:
    """Levels as finite numbers of shapes that broadcast."""
    given = {}
    for name, value in levels.items():
        try:
            found = np.asarray(value)
        except ValueError:
            found = np.array("rows of different lengths")
        if found.dtype.kind not in "iuf":
            raise SettingsError(
                f"{name} is not a real number", found=str(found.dtype), needed="numbers, in SI"
            )
        if not np.all(np.isfinite(found)):
            raise SettingsError(f"{name} is not finite", needed="numbers")
        if name == "frequency" and np.any(found <= 0):
            raise SettingsError(
                "a frequency is not positive", found=f"{found.min():.5g} Hz", needed="above zero"
            )
        given[name] = found.astype(np.float64, copy=False)
    try:
        np.broadcast_shapes(*(value.shape for value in given.values()))
    except ValueError:
        raise SettingsError(
            "the levels do not pair up",
            found="; ".join(f"{name} of shape {value.shape}" for name, value in given.items()),
            needed="shapes that broadcast together",
        ) from None
    return given


def _no_branch(quantity: str, line: LineSource, branch: Branch) -> SettingsError:
    return SettingsError(
        f"{quantity} of {line.name} does not differ by branch", found=branch, needed="no branch"
    )


def _dashpot(
    line: LineSource,
    extrapolate: Literal["refuse", "flag"],
    levels: Mapping[str, ArrayLike],
) -> DesignValues:
    """N = K_1 tau: shared errors enter with their sign, the others as independent."""
    spring, time = (
        look_up(line, name, branch=None, extrapolate=extrapolate, **levels)
        for name in ("dissipation_spring_constant", "relaxation_time")
    )
    value = spring.value * time.value
    shared = shared_of({"spring": spring, "time": time})
    rows = shared.values["spring"] * time.value + shared.values["time"] * spring.value

    parts = _own_parts(spring, time)

    def half(end: End) -> Floats:
        if parts:
            random = parts["random" if end.startswith("surface") else "run"]
            return half_width_of_parts(random, parts["few"], rows, shared.degrees_of_freedom)
        own = (own_half_width(spring, end) * time.value, own_half_width(time, end) * spring.value)
        return np.asarray(np.sqrt(np.square(own).sum(axis=0) + shared_half_width(rows) ** 2))

    return replace(
        spring,
        quantity=_DASHPOT,
        unit=quantity_of(_DASHPOT).unit,
        value=value,
        component=shared.component,
        contribution=rows,
        low=value - half("low"),
        high=value + half("high"),
        surface_low=value - half("surface_low"),
        surface_high=value + half("surface_high"),
        # combined from two surfaces: to be read from the intervals
        random_standard_uncertainty=np.empty(0),
        random_degrees_of_freedom=np.empty(0),
        run_standard_uncertainty=np.empty(0),
        errata=tuple(dict.fromkeys((*spring.errata, *time.errata))),
        notes=tuple(
            dict.fromkeys(
                (
                    "N = K_1 tau; the intervals treat the scatter of the two as independent and"
                    " include the errors that the runs share",
                    *spring.notes,
                    *time.notes,
                )
            )
        ),
    )


def _of_branch(line: LineSource, curves: list[LineCurve], branch: Branch | None) -> LineCurve:
    if branch is not None and not any(one.branch for one in curves):
        raise _no_branch(curves[0].quantity, line, branch)
    # where only one branch is known it need not be named
    found = [one for one in curves if branch is None or one.branch == branch]
    if len(found) == 1:
        return found[0]
    branches = [one.branch for one in curves if one.branch]
    raise SettingsError(
        f"{curves[0].quantity} of {line.name} differs by branch",
        found=branch or "no branch",
        needed="branch = " + " or ".join(branches),
    )


def _own_parts(spring: DesignValues, time: DesignValues) -> dict[str, Floats]:
    """Contributions of the scatter of K_1 and tau to N, one row each; empty where not known."""
    if not (is_even(spring) and is_even(time)):
        return {}
    by = (time.value, spring.value)
    return {
        "random": np.stack(
            [
                one.random_standard_uncertainty * other
                for one, other in zip((spring, time), by, strict=True)
            ]
        ),
        "run": np.stack(
            [
                one.run_standard_uncertainty * other
                for one, other in zip((spring, time), by, strict=True)
            ]
        ),
        "few": np.stack([one.random_degrees_of_freedom for one in (spring, time)]),
    }
