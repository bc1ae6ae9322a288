"""Look-up of design values of a line: surfaces over frequency and loads, curves over one variable.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.4.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import DataError, SettingsError
from reduction.lookup.curve import evaluate_curve
from reduction.lookup.loads import CycleLoads, loads_of_line
from reduction.lookup.product import DesignValues, LineCurve, LineSource, LineSurface
from reduction.lookup.surface import evaluate_surface
from reduction.record import Bools, Floats
from reduction.vocabulary import quantity as quantity_of

__all__ = ["Branch", "look_up"]

_LEVERAGE = 1 + 1e-9
_K = 1.96
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
        One of its quantities.
    branch : {"ascending", "descending"}, optional
        Of a quantity that differs by it; needed then.
    extrapolate : {"refuse", "flag"}
        What to do outside the tested range.
    **levels : array_like, shape (...)
        By name: the factors of the surface (``frequency``, ``mean_tension``,
        ``tension_amplitude``), or the variable of the curve (``mean_tension``, ``tension``,
        ``strain``). They are broadcast together. [SI]

    Returns
    -------
    values : DesignValues
        With interval, range, source and errata.

    Raises
    ------
    SettingsError
        If the line has no such quantity, or a level is missing or not of it.
    DataError
        If a point is outside the tested range and ``extrapolate`` is "refuse", an amplitude is
        above its mean tension, or a tether goes slack.

    Notes
    -----
    [1]_ calls the range of its levels the range of usefulness.  Inside it, the corners of a
    Box-Behnken cube are farther from the runs than any run is: they are flagged as untested.

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
        return _dashpot(line, extrapolate, levels)
    surface = line.surfaces.get(quantity)
    given = {name: np.asarray(value, dtype=np.float64) for name, value in levels.items()}
    for name, value in given.items():
        if not np.all(np.isfinite(value)):
            raise SettingsError(f"{name} is not finite", needed="numbers")
    if surface is not None and set(given) >= set(line.factor_names):
        return _of_surface(line, surface, given, extrapolate)
    curves = [one for one in line.curves if one.quantity == quantity]
    if not curves and surface is None:
        why = line.absent.get(quantity)
        raise SettingsError(
            f"{line.name} has no {quantity}" + (f": {why}" if why else ""),
            needed="one of " + ", ".join(line.quantities),
        )
    curves = [one for one in curves if one.variable in given]
    if not curves:
        needed = [", ".join(line.factor_names)] if surface is not None else []
        needed += [one.variable for one in line.curves if one.quantity == quantity]
        raise SettingsError(
            f"{quantity} of {line.name} needs another variable",
            found=", ".join(given) or "none",
            needed=" or ".join(dict.fromkeys(needed)),
        )
    return _of_curve(line, _of_branch(line, curves, branch), given, extrapolate)


def _dashpot(
    line: LineSource,
    extrapolate: Literal["refuse", "flag"],
    levels: Mapping[str, ArrayLike],
) -> DesignValues:
    """N = K_1 tau, whose two surfaces are of the same runs and taken as independent."""
    spring, time = (
        look_up(line, name, branch=None, extrapolate=extrapolate, **levels)
        for name in ("dissipation_spring_constant", "relaxation_time")
    )
    value = spring.value * time.value

    def half(end: str) -> Floats:
        parts = (
            (getattr(one, end) - one.value) * other.value
            for one, other in ((spring, time), (time, spring))
        )
        return np.asarray(np.hypot(*parts))

    return replace(
        spring,
        quantity=_DASHPOT,
        unit=quantity_of(_DASHPOT).unit,
        value=value,
        low=value - half("low"),
        high=value + half("high"),
        surface_low=value - half("surface_low"),
        surface_high=value + half("surface_high"),
        errata=tuple(dict.fromkeys((*spring.errata, *time.errata))),
        notes=tuple(
            dict.fromkeys(
                (
                    "N = K_1 tau; the intervals take the scatter of the two as independent",
                    *spring.notes,
                    *time.notes,
                )
            )
        ),
    )


def _of_branch(line: LineSource, curves: list[LineCurve], branch: Branch | None) -> LineCurve:
    found = [one for one in curves if one.branch in ("", branch or "")]
    if len(found) == 1:
        return found[0]
    branches = [one.branch for one in curves if one.branch]
    raise SettingsError(
        f"{curves[0].quantity} of {line.name} differs by branch",
        found=branch or "no branch",
        needed="branch = " + " or ".join(branches),
    )


def _of_surface(
    line: LineSource, surface: LineSurface, given: dict[str, Floats], extrapolate: str
) -> DesignValues:
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
    others = [
        evaluate_surface(replace(surface, coefficient=one), at) for one in surface.alternatives
    ]

    def span(name: str, ends: Callable[..., Floats]) -> Floats:
        found: Floats = getattr(points, name)
        for other in others:
            found = ends(found, getattr(other, name))
        return found.reshape(shape)

    inside = points.is_inside.reshape(shape)
    if extrapolate == "refuse" and not inside.all():
        _refuse_outside(line, surface, columns, inside)
    untested = points.leverage.reshape(shape) > _LEVERAGE * surface.greatest_leverage
    return _values(
        line,
        surface,
        loads=loads_of_line(line, given, shape),
        inside=inside,
        untested=inside & untested,
        value=points.value.reshape(shape),
        low=span("low", np.minimum),
        high=span("high", np.maximum),
        surface_low=span("surface_low", np.minimum),
        surface_high=span("surface_high", np.maximum),
    )


def _of_curve(
    line: LineSource, curve: LineCurve, given: dict[str, Floats], extrapolate: str
) -> DesignValues:
    at = given[curve.variable]
    value, spread, inside = evaluate_curve(curve, at)
    if extrapolate == "refuse" and not inside.all():
        first = np.flatnonzero(~inside.ravel())[0]
        raise DataError(
            f"{int((~inside).sum())} of {inside.size} points are outside what was tested of "
            f"{curve.quantity} of {line.name}",
            found=f"{curve.variable} {at.ravel()[first]:.5g}",
            needed=f"{curve.low:.5g} to {curve.high:.5g} {quantity_of(curve.variable).unit}",
            hint="--extrapolate flag gives the number and flags it.",
        )
    half = _K * spread
    return _values(
        line,
        curve,
        loads=loads_of_line(line, given, at.shape, branch=curve.branch),
        inside=inside,
        untested=np.zeros(at.shape, dtype=bool),
        value=value,
        low=value - half,
        high=value + half,
        surface_low=value - half,
        surface_high=value + half,
    )


def _refuse_outside(
    line: LineSource, surface: LineSurface, columns: tuple[Floats, ...], inside: Bools
) -> None:
    first = np.flatnonzero(~inside.ravel())[0]
    told = []
    for place, (name, column) in enumerate(zip(line.factor_names, columns, strict=True)):
        value, low, high = column.ravel()[first], surface.low[place], surface.high[place]
        if not low <= value <= high:
            told.append(f"{name} {value:.5g}, tested {low:.5g} to {high:.5g}")
    raise DataError(
        f"{int((~inside).sum())} of {inside.size} points are outside what was tested of "
        f"{surface.quantity} of {line.name}",
        found="; ".join(told) + " (SI)",
        needed="levels inside, which the source calls the range of usefulness",
        hint="--extrapolate flag gives the number and flags it.",
    )


def _values(
    line: LineSource,
    of: LineSurface | LineCurve,
    *,
    loads: CycleLoads,
    inside: Bools,
    untested: Bools,
    **numbers: Floats,
) -> DesignValues:
    notes = [*line.notes, *of.notes]
    if loads.is_above_rule.any():
        notes.append(f"the peak tension is above what the source allows: {line.rule}")
    below = int(np.sum(numbers["value"] < 0))
    if below:
        notes.append(
            f"{below} of {inside.size} values are below zero, which {of.quantity} cannot be: the "
            "surface says nothing there"
        )
    return DesignValues(
        quantity=of.quantity,
        unit=quantity_of(of.quantity).unit,
        **numbers,
        is_inside=inside,
        is_untested=untested,
        peak_tension=loads.peak_tension,
        minimum_tension=loads.minimum_tension,
        peak_share=loads.peak_share,
        minimum_share=loads.minimum_share,
        is_above_rule=loads.is_above_rule,
        rule=line.rule,
        source=line.source,
        errata=of.errata,
        notes=tuple(dict.fromkeys(notes)),
        branch=of.branch if isinstance(of, LineCurve) else "",
    )
