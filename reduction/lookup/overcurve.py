"""Design values of a curve at points: value, interval, what was tested, loads.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.4, 4.4.1.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from reduction.digits import plain_number
from reduction.errors import DataError, SettingsError
from reduction.lookup.curve import evaluate_curve
from reduction.lookup.loads import loads_of_line
from reduction.lookup.product import DesignValues, LineCurve, LineSource
from reduction.lookup.told import design_values
from reduction.record import Floats
from reduction.vocabulary import quantity as quantity_of


def values_of_curve(
    line: LineSource, curve: LineCurve, given: Mapping[str, Floats], extrapolate: str
) -> DesignValues:
    """Design values of a curve.

    Parameters
    ----------
    line : LineSource
        Whose curve it is.
    curve : LineCurve
        Polynomial or points.
    given : mapping of str to ndarray, shape (...)
        The variable of the curve alone. [SI]
    extrapolate : {"refuse", "flag"}
        What to do outside the range.

    Returns
    -------
    values : DesignValues
        With one interval, of the curve itself: a curve of one test says nothing of others.

    Raises
    ------
    SettingsError
        If a level is not of the curve.
    DataError
        If a point is outside and ``extrapolate`` is "refuse", or the loads are refused.

    Notes
    -----
    The interval is Student's, by the effective degrees of freedom of all parts.

    Examples
    --------
    >>> pull = LineCurve("strain", "tension", 0.0, 100.0, coefficient=np.array([0.0, 0.01]))
    >>> rope = LineSource("rope", "", "nylon", "", "new", 0.0127, 1e4, curves=(pull,))
    >>> found = values_of_curve(rope, pull, {"tension": np.array([10.0, 50.0])}, "refuse")
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
            f"{int((~inside).sum())} of {inside.size} points are outside what was tested of "
            f"{curve.quantity} of {line.name}",
            found=f"{curve.variable} {plain_number(first)}{unit}",
            needed=f"{plain_number(curve.low)} to {plain_number(curve.high)}{unit}{gaps}",
            hint=". ".join(
                part
                for part in (
                    curve.range_note, "--extrapolate flag gives the number and flags it."
                )
                if part
            ),
        )  # fmt: skip
    nothing = np.full(at.shape, np.nan)
    return design_values(
        line,
        curve,
        loads=loads_of_line(line, given, at.shape, branch=curve.branch),
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


def _unit(name: str) -> str:
    """Unit as it stands behind a number; a plain number has none."""
    unit = quantity_of(name).unit
    return "" if unit == "1" else f" {unit}"


def _joints(curve: LineCurve, at: Floats) -> list[str]:
    """Where two pieces meet with two values, and a point is just there."""
    if not curve.value.size:
        return []
    meet = (np.diff(curve.at) == 0) & (np.diff(curve.value) != 0)
    return [
        f"at {curve.variable} {plain_number(curve.at[place])} two pieces meet: "
        f"{plain_number(curve.value[place], 4)}"
        f"{_unit(curve.quantity)} below, {plain_number(curve.value[place + 1], 4)} above"
        for place in np.flatnonzero(meet)
        if np.any(at == curve.at[place])
    ]
