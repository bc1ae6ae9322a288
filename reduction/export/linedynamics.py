"""K_0, K_1 and tau of a line for export, such that it gives back its own K_ap and H.

K_1 and tau have surfaces of their own in [1]_, fitted to what was identified run by run.  Beside
the surfaces of K_ap and H they are a second fit of the same runs, and the two do not agree: over
the tested levels of the printed lines the first give K_ap from 0.7 to 2.3 times the second.  K_ap
and H are what was measured, so K_1 and tau are identified from them at the point that is asked for.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, eqs. 1-4, Tables 3-19.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from reduction.digits import plain_number
from reduction.errors import DataError, SettingsError
from reduction.export.dynamics import Viscoelasticity
from reduction.export.dynamicswords import (
    doubts_of_identified,
    doubts_of_printed,
    interval_of,
    said_identified,
    said_instead,
    said_of_value,
    said_over_frequency,
    said_printed,
)
from reduction.export.linespread import half_widths
from reduction.line.identify import identify_by_amplitude
from reduction.line.product import REASONS, LineParameters
from reduction.lookup.line import look_up
from reduction.lookup.product import DesignValues, LineSource
from reduction.record import Floats

_REST, _APPARENT, _ENERGY = (
    "quasi_static_spring_constant", "apparent_spring_constant", "hysteresis_energy",
)  # fmt: skip
_SPRING, _TIME = "dissipation_spring_constant", "relaxation_time"
_MEANS, _FEWEST_MEANS, _FREQUENCIES = 9, 3, 3
_ROUNDING = 1e-9
Extrapolate = Literal["refuse", "flag"]


@dataclass(frozen=True)
class LineDynamics:
    """The three parameters at one point, where they are from, and what is against them."""

    part: Viscoelasticity
    sources: tuple[str, ...]
    notes: tuple[str, ...]


def line_dynamics(
    source: LineSource, levels: Mapping[str, float], extrapolate: Extrapolate = "refuse"
) -> LineDynamics:
    """Static and dynamic stiffness and dashpot of a line at a frequency, a mean and an amplitude.

    Parameters
    ----------
    source : LineSource
        With K_0, and K_ap and H, or K_1 and tau.
    levels : mapping of str to float
        ``frequency``, ``mean_tension`` and ``tension_amplitude``. [Hz], [N], [N]
    extrapolate : {"refuse", "flag"}
        Outside the levels that were tested.

    Returns
    -------
    found : LineDynamics
        With what the line's own surfaces say of K_ap and H beside what is exported.

    Raises
    ------
    SettingsError
        If a level or a quantity is missing.
    DataError
        If a level is outside what was tested, or no K_1 and tau give back K_ap within its 95 %
        interval.

    Notes
    -----
    K_1 and tau are identified from K_ap, H and K_0 ([1]_, eqs. 1 and 4 solved at once), as
    `reduction.line.identify.identify_by_amplitude` does for a run; so the exported line gives back
    K_ap and H at that point.  Where there is no such line (E' not above K_0, or H not above zero),
    the printed K_1 and tau take their place as long as K_ap of them is in the 95 % interval of
    the surface of K_ap.  How well they are known is by `reduction.export.linespread`: one load cell
    is in K_ap, H and K_0.  The growth with the mean tension is that of the straight line of least
    squares through K_0 + K_1, found in the same way at nine means over the tested ones.
    """
    if "mean_tension" not in levels:
        raise SettingsError(
            "static and dynamic stiffness need a mean tension", needed="--mean-tension"
        )
    rest = _value(source, _REST, levels, extrapolate)
    known = set(source.quantities)

    def values(*names: str) -> dict[str, DesignValues]:
        return {name: _value(source, name, levels, extrapolate) for name in names}

    measured = values(_APPARENT, _ENERGY) if {_APPARENT, _ENERGY} <= known else {}
    printed = values(_SPRING, _TIME) if {_SPRING, _TIME} <= known or not measured else {}
    amplitude, frequency = (
        float(levels.get(name, math.nan)) for name in ("tension_amplitude", "frequency")
    )
    is_identified = False
    if measured:
        line = _identified(rest, measured, levels)
        reason = int(line.reason)
        is_identified = reason == 0
        if is_identified:
            spring = float(line.dissipation_spring_constant)
            half = half_widths(line, rest, measured[_APPARENT], measured[_ENERGY])
            part = _part(rest, spring, float(line.relaxation_time), levels)
            notes = [
                said_identified(part, amplitude, half, is_exact=not np.isfinite(rest.surface_high)),
                said_printed(float(rest.value), printed, measured, frequency, amplitude),
                *doubts_of_identified(line, half, measured[_ENERGY]),
            ]
        else:
            part = _instead(source, rest, measured, printed, levels, reason)
            notes = [
                said_instead(part, measured, amplitude, reason),
                *doubts_of_printed(printed[_TIME]),
            ]
        notes += _over_frequency(source, part, levels)
    else:
        spring, time = (float(one.value) for one in printed.values())
        part = _part(rest, spring, time, levels)
        notes = [
            "K_1 and tau are those of the source: it has no K_ap and H to hold them against",
            *doubts_of_printed(printed[_TIME]),
        ]
    slope, growth = _growth(source, levels, part.fast_stiffness, is_identified=is_identified)
    every = (rest, *measured.values(), *printed.values())
    texts = dict.fromkeys(text for found in every for text in found.notes)
    for text in (one for one in texts if one not in source.notes):
        notes.append(f"{', '.join(one.quantity for one in every if text in one.notes)}: {text}")
    part = replace(
        part,
        dynamic_stiffness=part.fast_stiffness - slope * float(levels["mean_tension"]),
        dynamic_stiffness_per_mean_tension=slope,
        growth=growth,
    )
    return LineDynamics(part, tuple(map(said_of_value, every)), (*notes, growth))


def _part(
    rest: DesignValues, spring: float, time: float, levels: Mapping[str, float]
) -> Viscoelasticity:
    holds = ", ".join(
        f"{name.replace('_', ' ')} {plain_number(value)}" for name, value in levels.items()
    )
    return Viscoelasticity(
        static_stiffness=float(rest.value),
        dynamic_stiffness=float(rest.value) + spring,
        dashpot_coefficient=spring * time,
        mean_tension=float(levels["mean_tension"]),
        holds=f"{holds} (SI)",
        frequency=levels.get("frequency", math.nan),
    )


def _value(
    source: LineSource, quantity: str, levels: Mapping[str, Any], extrapolate: Extrapolate
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


def _identified(
    rest: DesignValues, measured: Mapping[str, DesignValues], levels: Mapping[str, Any]
) -> LineParameters:
    """K_1 and tau of K_ap, H and K_0."""
    return identify_by_amplitude(
        apparent_spring_constant=measured[_APPARENT].value,
        hysteresis_energy=measured[_ENERGY].value,
        tension_amplitude=levels["tension_amplitude"],
        frequency=levels["frequency"],
        quasi_static_spring_constant=rest.value,
    )


def _instead(
    source: LineSource,
    rest: DesignValues,
    measured: Mapping[str, DesignValues],
    printed: Mapping[str, DesignValues],
    levels: Mapping[str, float],
    reason: int,
) -> Viscoelasticity:
    """Printed K_1 and tau, where K_ap of them is not to be told from that of the surface."""
    apparent = measured[_APPARENT]
    why = f"no K_1 and tau of {source.name} give back its K_ap and H there: {REASONS[reason]}"
    numbers = (
        f"K_0 {plain_number(float(rest.value))} N, K_ap {plain_number(float(apparent.value))} N, H "
        f"{plain_number(float(measured[_ENERGY].value), 4)} J/m"
    )
    if not printed:
        raise DataError(why, found=numbers, needed="other levels")
    spring, time = (float(one.value) for one in printed.values())
    if not (spring > 0 and time > 0):
        raise DataError(
            f"{why}; and the printed ones are not above zero",
            found=f"K_1 {plain_number(spring, 4)} N, tau {plain_number(time, 4)} s; {numbers}",
            needed="other levels",
        )
    part = _part(rest, spring, time, levels)
    model = part.apparent_stiffness
    if not float(apparent.surface_low) <= model <= float(apparent.surface_high):
        raise DataError(
            f"{why}; and the printed ones give another K_ap than the line has",
            found=f"K_ap {plain_number(model)} N; {numbers}",
            needed=interval_of(apparent),
            hint="Another level, or the curve alone: leave the levels away.",
        )
    return part


def _over_frequency(
    source: LineSource, part: Viscoelasticity, levels: Mapping[str, float]
) -> list[str]:
    surface = source.surfaces.get(_APPARENT)
    if surface is None or "frequency" not in source.factor_names:
        return []
    place = source.factor_names.index("frequency")
    frequencies = np.linspace(surface.low[place], surface.high[place], _FREQUENCIES)
    over = {name: np.full(_FREQUENCIES, value) for name, value in levels.items()}
    found = _value(source, _APPARENT, over | {"frequency": frequencies}, "flag")
    return [said_over_frequency(part, frequencies, found)]


def _growth(
    source: LineSource, levels: Mapping[str, float], fast: float, *, is_identified: bool
) -> tuple[float, str]:
    """Slope of K_0 + K_1 over the mean tension, zero where none can be written, and words. [1]."""
    surface = source.surfaces.get(_APPARENT if is_identified else _SPRING)
    if surface is None or "mean_tension" not in source.factor_names:
        return 0.0, "growth of the dynamic stiffness with the mean tension is not known"
    place = source.factor_names.index("mean_tension")
    low = max(float(surface.low[place]), levels.get("tension_amplitude", 0.0))
    means = np.linspace(low, float(surface.high[place]), _MEANS)
    over = {name: np.full(_MEANS, value) for name, value in levels.items()} | {
        "mean_tension": means
    }
    total = _totals(source, over, is_identified=is_identified)
    stands = np.isfinite(total)
    if stands.sum() < _FEWEST_MEANS:
        return 0.0, (
            "growth of the dynamic stiffness with the mean tension is not known: K_1 is found at "
            f"{int(stands.sum())} of {_MEANS} means"
        )
    means, total = means[stands], total[stands]
    slope, start = (float(one) for one in np.polyfit(means, total, 1))
    worst = float(np.abs(slope * means + start - total).max())
    words = (
        f"growth of the dynamic stiffness with the mean tension: {slope:.4g}, a straight line "
        f"through {means.size} of {_MEANS} means over the tested ones, off by up to "
        f"{plain_number(worst, 3)} N, "
        f"{100 * worst / fast:.2g} percent of EA_d"
    )
    if slope * np.ptp(means) < _ROUNDING * np.abs(total).max():
        return 0.0, f"{words}; it does not grow, and no slope is exported"
    if fast - slope * levels["mean_tension"] <= 0:
        return 0.0, (
            f"{words}; with it EA_d would be below zero at no tension, and no slope is exported: "
            "the stiffness holds at this mean tension alone"
        )
    return slope, words


def _totals(source: LineSource, over: Mapping[str, Floats], *, is_identified: bool) -> Floats:
    """K_0 + K_1 at points, NaN where there is none. [N]."""
    rest = _value(source, _REST, over, "flag")
    if is_identified:
        measured = {name: _value(source, name, over, "flag") for name in (_APPARENT, _ENERGY)}
        spring = _identified(rest, measured, over).dissipation_spring_constant
    else:
        spring = _value(source, _SPRING, over, "flag").value
    # a K_0 that is not trusted says nothing of the growth
    return np.where(rest.is_inside, rest.value + spring, np.nan)
