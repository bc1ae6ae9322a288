"""What shared errors add to what is made from the table of cycles: trends, slips, rope steps.

A mean over cycles, or a slope against their number, is linear in the cycles: the errors of the
cycles go through the same mean or slope.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Literal

import numpy as np

from reduction.cycles.product import Loops
from reduction.line.programme import BeddingIn, DynamicStiffness
from reduction.line.tensile import TensilePull
from reduction.moduli.product import PeakTrend
from reduction.moduli.trend import FEWEST_CYCLES, cycles_at_an_end, slope_per_decade
from reduction.pipeline.shared.blocks import blocks_of_cycles, cycles_of_test
from reduction.pipeline.shared.loops import of_loops
from reduction.product import ReducedTest
from reduction.record import Floats
from reduction.samples.scratch import empty_like
from reduction.settings import CycleSettings
from reduction.strain.model import StrainModel
from reduction.uncertainty.field import error_field
from reduction.uncertainty.join import merged, stacked
from reduction.uncertainty.points import (
    chord_contributions,
    secant_contributions,
    with_diameter,
)
from reduction.uncertainty.product import Component, Contributions, InstrumentErrors
from reduction.uncertainty.strength import over_strength

_DYNAMIC = {
    "dynamic_stiffness": "apparent_spring_constant",
    "dynamic_mean_tension": "mean_tension",
    "dynamic_tension_amplitude": "tension_amplitude",
}
"""Means over the last cycles of a step, and the quantity of a cycle that they are of."""

_OF_TREND = ("peak_tension", "apparent_spring_constant")
_OF_STEP = (
    "mean_tension", "tension_amplitude", "mean_strain", "strain_amplitude", "valley_tension",
)  # fmt: skip


def of_cycles(
    test: ReducedTest,
    index: int,
    errors: InstrumentErrors,
    model: StrainModel,
    cycles: CycleSettings,
    area: float,
) -> Iterator[Contributions]:
    """Trends and steps of a programme of one specimen."""
    step = test.rope_step
    if test.loops is not None and test.cycles is not None:
        of_each = _of_each(test, index, errors, model, cycles)
        if test.trend is not None:
            yield _of_trend(
                test.loops, test.trend, index, of_each, errors, cycles.break_in_cycles, area
            )
        if step is not None and step.dynamic is not None and step.dynamic.n_cycles[index, 0] > 0:
            yield _of_dynamic(test.loops, step.dynamic, index, of_each, errors)
        if step is not None and step.bedding_in is not None:
            yield _of_bedding(test.loops, step.bedding_in, index, of_each, errors)
    if step is not None and step.tensile is not None:
        yield _of_tensile(step.tensile, index, errors, model, cycles)


def of_ends(
    test: ReducedTest, index: int, errors: InstrumentErrors, area: float
) -> Iterator[Contributions]:
    """Secant and chord moduli of each cycle, at the two ends of its loop."""
    loops, ends, model = test.loops, test.end_moduli, test.strain_models[index]
    if loops is None or ends is None:
        return
    mean, half = loops.mean_strain[index], loops.strain_amplitude[index]
    high = error_field(errors, model, strain=mean + half, tension=loops.peak_tension[index])
    low = error_field(errors, model, strain=mean - half, tension=loops.valley_tension[index])
    secant, chord = ends.secant_modulus[index], ends.chord_modulus[index]
    yield secant_contributions(high, errors, strain=mean + half, secant_modulus=secant, area=area)
    rows = [
        chord_contributions(low, high, stroke=2 * half, chord=chord[:, branch] * area)
        for branch in range(2)
    ]
    both = np.stack([one.values["chord"] / area for one in rows], axis=-1)
    found = Contributions(low.component, {"chord_modulus": both})
    yield with_diameter(found, errors, {"chord_modulus": chord}, area=area)


def of_slips(test: ReducedTest, errors: Sequence[InstrumentErrors]) -> list[Contributions]:
    """Every step of a splice, along one axis; an empty list where there is none.

    The length is a step of tension over a slope of it: gain and warmth are in both, a scale of
    position in the slope alone.
    """
    slips = test.slips
    if slips is None or not slips.specimen:
        return []
    names = [one.name for one in test.specimens]
    own = []
    for number, name in enumerate(slips.specimen):
        one = errors[names.index(name)]
        model = test.strain_models[names.index(name)]
        field = error_field(one, model, strain=0.0, tension=0.0)
        step = slips.slip_tension_step[number] * field.tension_slope
        length = np.atleast_1d(slips.slip_length[number] * one.position_gain)
        scale = Component("position_gain", one.position_instrument)
        own.append(
            merged(
                [
                    Contributions(field.component, {"slip_tension_step": step}),
                    Contributions((scale,), {"slip_length": length}),
                ]
            )
        )
    return [stacked(own)]


def _of_each(
    test: ReducedTest,
    index: int,
    errors: InstrumentErrors,
    model: StrainModel,
    settings: CycleSettings,
) -> Contributions:
    """Contributions to what trends and steps read of each cycle."""
    names = _OF_TREND if test.rope_step is None else (*_OF_TREND, *_OF_STEP)
    component: tuple[Component, ...] = ()
    rows: dict[str, Floats] = {}
    if test.loops is None or test.cycles is None:
        return Contributions(component)
    for block in blocks_of_cycles(test.cycles.n_cycles):
        part = cycles_of_test(test, block)
        if part.loops is None or part.cycles is None:
            continue
        of_block = of_loops(part.loops, index, errors, model, part.cycles, settings)
        component = of_block.component
        for name in names:
            if name not in rows:
                shape = (len(component), test.cycles.n_cycles)
                rows[name] = empty_like(test.loops.frequency, shape=shape)
            rows[name][:, block] = of_block.values[name]
    return Contributions(component, rows)


def _of_series(loops: Loops, index: int, of_each: Contributions, name: str) -> Floats:
    """Contributions to a quantity of each cycle, NaN where the cycle has none."""
    known = np.isfinite(getattr(loops, name)[index])
    return np.where(known, of_each.values[name], np.nan)


def _of_trend(
    loops: Loops,
    trend: PeakTrend,
    index: int,
    of_each: Contributions,
    errors: InstrumentErrors,
    break_in: int,
    area: float,
) -> Contributions:
    """The slopes of `fit_peak_trend`, over the cycles that it takes."""
    peak = _of_series(loops, index, of_each, "peak_tension")
    modulus = _of_series(loops, index, of_each, "apparent_spring_constant") / area
    start = min(break_in, max(0, peak.shape[1] - FEWEST_CYCLES))
    found = Contributions(
        of_each.component,
        {
            "peak_tension_per_decade": slope_per_decade(peak[:, start:], first_cycle=start + 1)[0],
            "dynamic_modulus_per_decade": slope_per_decade(
                modulus[:, start:], first_cycle=start + 1
            )[0],
            "peak_tension_change": _of_change(loops.peak_tension[index], peak),
        },
    )
    value = np.asarray(trend.dynamic_modulus_per_decade[index])
    return with_diameter(found, errors, {"dynamic_modulus_per_decade": value}, area=area)


def _of_change(peak: Floats, of_peak: Floats) -> Floats:
    """What errors of the peaks, one row a component, make of the last ones over the first."""
    n_ends = cycles_at_an_end(peak.size)
    first, last = peak[:n_ends].mean(), peak[-n_ends:].mean()
    of_first, of_last = of_peak[:, :n_ends].mean(axis=1), of_peak[:, -n_ends:].mean(axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray((of_last - last / first * of_first) / first)


def _of_dynamic(
    loops: Loops,
    dynamic: DynamicStiffness,
    index: int,
    of_each: Contributions,
    errors: InstrumentErrors,
) -> Contributions:
    """Means over the last cycles, and their drift."""
    series = _of_series(loops, index, of_each, "apparent_spring_constant")
    used = np.flatnonzero(np.isfinite(loops.apparent_spring_constant[index]))[
        -int(dynamic.n_cycles[index, 0]) :
    ]
    values = {
        name: _of_series(loops, index, of_each, source)[:, used].mean(axis=1)
        for name, source in _DYNAMIC.items()
    }
    away = used - used.mean()
    power = float(np.sum(away**2))
    values["dynamic_stiffness_drift"] = (
        series[:, used] @ away / power if power else np.full(len(series), np.nan)
    )
    powers = {}
    for name in _DYNAMIC:
        source = name if name == "dynamic_stiffness" else name.removeprefix("dynamic_")
        share = getattr(dynamic, f"{source}_over_strength")[index, 0]
        strength = getattr(dynamic, source)[index, 0] / share
        values[f"{name}_over_strength"] = values[name] / strength
        powers[f"{name}_over_strength"] = (np.array(share), -1.0)
    return over_strength(Contributions(of_each.component, values), errors, powers)


def _of_bedding(
    loops: Loops,
    bedding: BeddingIn,
    index: int,
    of_each: Contributions,
    errors: InstrumentErrors,
) -> Contributions:
    """Secants of the first and the last cycle, their ratio, and what the foot moved by."""
    rows = {
        name: _of_series(loops, index, of_each, name)[:, [0, -1]]
        for name in ("apparent_spring_constant", "mean_strain", "strain_amplitude",
                     "valley_tension")
    }  # fmt: skip
    first, last = rows["apparent_spring_constant"].T
    secant = np.array([bedding.first_stiffness[index], bedding.last_stiffness[index]])
    share = np.array(
        [bedding.first_stiffness_over_strength[index], bedding.last_stiffness_over_strength[index]]
    )
    foot = np.diff(rows["mean_strain"] - rows["strain_amplitude"], axis=1)[:, 0]
    of_valley = np.diff(rows["valley_tension"], axis=1)[:, 0]
    valley = loops.valley_tension[index, -1] - loops.valley_tension[index, 0]
    values = {
        "bedding_first_stiffness": first,
        "bedding_last_stiffness": last,
        "bedding_first_stiffness_over_strength": first * share[0] / secant[0],
        "bedding_last_stiffness_over_strength": last * share[1] / secant[1],
        "bedding_stiffening": bedding.stiffening[index] * (last / secant[1] - first / secant[0]),
        "bedding_permanent_strain": foot - of_valley / secant[1] + valley * last / secant[1] ** 2,
    }
    powers = {
        "bedding_first_stiffness_over_strength": (share[0], -1.0),
        "bedding_last_stiffness_over_strength": (share[1], -1.0),
    }
    return over_strength(Contributions(of_each.component, values), errors, powers)


def _of_tensile(
    pull: TensilePull,
    index: int,
    errors: InstrumentErrors,
    model: StrainModel,
    cycles: CycleSettings,
) -> Contributions:
    """Greatest tension of a pull, and the strain there; of a break both have another name too."""
    peak, strain = pull.peak_tension[index], pull.strain_at_peak[index]
    held: Literal["position", "tension"] = "tension" if cycles.control == "load" else "position"
    field = error_field(errors, model, strain=strain, tension=peak, held=held)
    share = np.asarray(pull.peak_tension_over_strength[index])
    values = {
        "pull_peak_tension": field.tension,
        "pull_peak_tension_over_strength": field.tension * share / peak,
        "pull_peak_strain": field.strain,
        "tensile_strength": field.tension,
        "strain_at_failure": field.strain,
    }
    powers = {"pull_peak_tension_over_strength": (share, -1.0)}
    return over_strength(Contributions(field.component, values), errors, powers)
