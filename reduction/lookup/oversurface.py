"""Design values of a surface at points: value, intervals, what was tested, loads.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.4, 4.4.1.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from reduction.digits import plain_number
from reduction.errors import DataError, SettingsError
from reduction.lookup.linesurface import LineSurface
from reduction.lookup.loads import loads_of_line
from reduction.lookup.product import DesignValues, LineSource
from reduction.lookup.scatter import interval_between_lines
from reduction.lookup.surface import evaluate_surface
from reduction.lookup.told import design_values
from reduction.record import Bools, Floats
from reduction.surface.tested import ABOVE_LEVERAGE
from reduction.vocabulary import quantity as quantity_of

_RUN = "one more run of the same lines"
_SURFACE = "the surface of these lines"


def values_of_surface(
    line: LineSource, surface: LineSurface, given: Mapping[str, Floats], extrapolate: str
) -> DesignValues:
    """Design values of a surface.

    Parameters
    ----------
    line : LineSource
        Whose surface it is.
    surface : LineSurface
        One quantity.
    given : mapping of str to ndarray, shape (...)
        All its factors, of shapes that broadcast. [SI]
    extrapolate : {"refuse", "flag"}
        What to do outside the levels.

    Returns
    -------
    values : DesignValues
        Intervals span coefficients and levels that are open.

    Raises
    ------
    SettingsError
        If a level is not of the surface.
    DataError
        If a point is outside and ``extrapolate`` is "refuse", or the loads are refused.

    Notes
    -----
    See `reduction.lookup.surface.evaluate_surface` for a run and the surface, and
    `reduction.lookup.scatter.interval_between_lines` for other lines.

    Examples
    --------
    A surface that is its mean, of one line among lines that differ by a tenth:

    >>> surface = LineSurface(
    ...     "relaxation_time", np.array([1.5]), np.array([[0]]), np.array([0.1]),
    ...     np.array([0.5]), np.eye(1) / 15, 0.1, 14.0, 1.0, line_scatter=0.1, n_lines=1.0,
    ... )
    >>> rope = LineSource("rope", "", "nylon", "", "new", 0.0127, 1e4, ("frequency",))
    >>> found = values_of_surface(rope, surface, {"frequency": np.array([0.3])}, "refuse")
    >>> print(found.value, found.high.round(2), found.line_high.round(2))
    [1.5] [1.72] [2.1]
    """
    unknown = sorted(set(given) - set(line.factor_names))
    if unknown:
        raise SettingsError(
            f"{surface.quantity} of {line.name} does not vary with {', '.join(unknown)}",
            needed="levels of " + ", ".join(line.factor_names),
        )
    columns = np.broadcast_arrays(*(given[name] for name in line.factor_names))
    shape = columns[0].shape
    at = np.stack([one.ravel() for one in columns], axis=1)
    points = evaluate_surface(surface, at)
    boxes = [(surface.low, surface.high), *surface.alternative_boxes]
    # the first of all is the surface itself
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
    # where other surfaces may be the right one the interval is not of two parts
    is_apart = bool(surface.component) and not others

    def part(values: Floats) -> Floats:
        return values.reshape(shape) if is_apart else np.empty(0)

    return design_values(
        line,
        surface,
        loads=loads_of_line(line, given, shape),
        inside=inside,
        untested=inside & untested,
        words=(_RUN, _SURFACE) if has_interval else ("", ""),
        component=surface.component,
        contribution=points.contribution.reshape(len(surface.component), *shape),
        random_standard_uncertainty=part(points.random),
        random_degrees_of_freedom=part(np.full(points.random.shape, surface.degrees_of_freedom)),
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


def _refuse_outside(
    line: LineSource, surface: LineSurface, columns: tuple[Floats, ...], inside: Bools
) -> None:
    first = np.flatnonzero(~inside.ravel())[0]
    told = []
    for place, (name, column) in enumerate(zip(line.factor_names, columns, strict=True)):
        value, low, high = column.ravel()[first], surface.low[place], surface.high[place]
        rounded = surface.rounding[place] if surface.rounding.size else 0.0
        if not low - rounded <= value <= high + rounded:
            unit = quantity_of(name).unit
            told.append(
                f"{name} {plain_number(value)} {unit}, tested {plain_number(low)} to "
                f"{plain_number(high)} {unit}"
            )
    raise DataError(
        f"{int((~inside).sum())} of {inside.size} points are outside what was tested of "
        f"{surface.quantity} of {line.name}",
        found="; ".join(told),
        needed="levels inside, which the source calls the range of usefulness",
        hint="--extrapolate flag gives the number and flags it.",
    )
