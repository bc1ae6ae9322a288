"""Shared errors carried to cycles, trends, slips, steps of a programme, holds and slow pulls.

A mean over cycles, or a slope against their number, is linear in the cycles: the errors of the
cycles go through the same mean or slope.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any, Literal, TypeVar

import numpy as np

from reduction.record.contributions import (
    Component,
    Contributions,
    InstrumentErrors,
    merged,
    stacked,
)
from reduction.record.measurement import Floats, Integers, Record
from reduction.record.samples import empty_like, take_samples
from reduction.record.settings import CycleSettings
from reduction.stages.cycles.cycle_product import Cycles, Loops
from reduction.stages.cycles.cycle_search import control_channel
from reduction.stages.cycles.reading_noise import reading_noise
from reduction.stages.cycles.turns import kind_of_turns
from reduction.stages.holds.hold_product import HoldResult, hold_numbers
from reduction.stages.load_train import length_by_stroke
from reduction.stages.moduli.modulus_product import (
    AmplitudeSummary,
    PeakTrend,
)
from reduction.stages.moduli.secant_modulus import (
    cycles_at_an_end,
    first_of_trend,
    slope_per_decade,
)
from reduction.stages.reduced_test import ReducedTest
from reduction.stages.strain.strain_model import StrainModel, position_by_model
from reduction.stages.three_parameter_line.hold_pairs import CreepOfHold, HeldPair
from reduction.stages.three_parameter_line.line_of_loops import Reading
from reduction.stages.three_parameter_line.line_product import LineParameters, SlowPull
from reduction.stages.three_parameter_line.rope_programme import (
    BeddingIn,
    DynamicStiffness,
    TensilePull,
)
from reduction.stages.three_parameter_line.slow_pull import (
    error_of_pull_rate,
    is_short_pull,
    quasi_static_spring_constant,
    strain_at_tension,
)
from reduction.uncertainty.error_field import (
    ErrorField,
    Inertia,
    error_field,
    splice_friction_error,
)
from reduction.uncertainty.propagation import (
    LoopQuantities,
    by_diameter,
    chord_contributions,
    diameter_error,
    fit_contributions,
    hold_contributions,
    line_contributions,
    loop_contributions,
    over_strength,
    pull_contributions,
    secant_contributions,
    section_contributions,
    stepwise_contributions,
    with_diameter,
)

# every component has a row for each quantity of each cycle
_BLOCK = 1 << 14


Product = TypeVar("Product")


def blocks_of_cycles(n_cycles: int) -> Iterator[slice]:
    """Slices that cover the cycles of a test."""
    for start in range(0, n_cycles, _BLOCK):
        yield slice(start, min(start + _BLOCK, n_cycles))


def cycles_of_test(test: ReducedTest, block: slice) -> ReducedTest:
    """The test with the quantities of some of its cycles; means and curves stay those of all."""
    if test.cycles is None:
        return test
    return replace(
        test,
        cycles=_cycles(test.cycles, block),
        loops=_part(test.loops, block),
        end_moduli=_part(test.end_moduli, block),
        line=_part(test.line, block),
    )


def _cycles(cycles: Cycles, block: slice) -> Cycles:
    return replace(
        cycles,
        first=cycles.first[block],
        last=cycles.last[block],
        branch_first=cycles.branch_first[block],
        branch_last=cycles.branch_last[block],
        plateau_rate=cycles.plateau_rate[block],
    )


def _part(product: Product, block: slice) -> Product:
    """A product whose arrays have shape (n_specimens, n_cycles, ...), of some of the cycles."""
    if product is None:
        return product
    changes: dict[str, Any] = {}
    for item in fields(product):  # type: ignore[arg-type]
        value = getattr(product, item.name)
        if isinstance(value, np.ndarray):
            changes[item.name] = value[:, block]
        elif isinstance(value, dict):
            changes[item.name] = {name: array[:, block] for name, array in value.items()}
    return replace(product, **changes)  # type: ignore[type-var]


_OF_FUNDAMENTAL = ("storage_spring_constant", "loss_spring_constant")


_K_0 = "quasi_static_spring_constant"


def ramp_speed_ratio(
    loops: Loops | AmplitudeSummary,
    index: int,
    model: StrainModel,
    cycles: Cycles,
    settings: CycleSettings,
    record: Record | None,
) -> Floats:
    """Speed of the ramps over that of ramps without a stop at their ends."""
    frequency, mean, amplitude = (
        getattr(loops, name)[index] for name in ("frequency", "mean_strain", "strain_amplitude")
    )
    tension, swing = loops.mean_tension[index], loops.tension_amplitude[index]
    if settings.control == "load":
        half = swing
    elif model.method == "extensometer":
        if record is None:
            return np.ones(np.shape(frequency))
        valley, peak = (
            take_samples(record.crosshead_position, at[:, 0])
            for at in (cycles.branch_first, cycles.branch_last)
        )
        half = (peak - valley) / 2
        if np.ndim(frequency) == 0:
            half = np.asarray(np.nanmedian(half))
    else:
        ends = [
            position_by_model(model, strain=mean + way * amplitude, tension=tension + way * swing)
            for way in (1, -1)
        ]
        half = (ends[0] - ends[1]) / 2
    plateau = cycles.plateau_rate.mean(axis=1)
    if np.ndim(frequency) == 0:
        plateau = np.asarray(np.nanmedian(plateau))
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = plateau / (4 * frequency * half)
    usable = np.isfinite(ratio) & (ratio > 1)
    return np.asarray(np.where(usable, ratio, 1.0))


def inertia_of(
    record: Record | None,
    loops: Loops | AmplitudeSummary,
    index: int,
    errors: InstrumentErrors,
    model: StrainModel,
    cycles: Cycles | None,
) -> Inertia | None:
    """Inertia subtracted from the tension of a specimen, for each cycle or for the means."""
    if record is None or not record.load_train.end_mass:
        return None
    train = record.load_train
    error = []
    if train.load_cell_at == "moving" and errors.attached_mass:
        of_machine = Component("attached_mass", errors.position_instrument)
        error.append((of_machine, errors.attached_mass))
    of_specimen = train.end_mass_by_density[index] * errors.linear_density
    if of_specimen:
        error.append((Component("linear_density", errors.specimen), of_specimen))
    if not (train.end_mass[index] or error):
        return None
    length = np.nan
    if model.method == "extensometer" and cycles is not None:
        length = length_by_stroke(record.crosshead_position, cycles, loops.strain_amplitude[index])
    return Inertia(
        train.end_mass[index], tuple(error),
        frequency=np.asarray(loops.frequency[index]),
        mean_strain=np.asarray(loops.mean_strain[index]),
        mean_tension=np.asarray(loops.mean_tension[index]),
        length_by_stroke=length,
    )  # fmt: skip


# a cycle is steeper than the compliance of a relaxed specimen, for rubber by up to a factor of two:
# the length let out lies between that found by the slope of a cycle and its double.  Root mean
# square: sqrt(7/3).  Slip that makes no step is not detected
_OF_SLIP = (7 / 3) ** 0.5


def with_splice_slips(
    test: ReducedTest, errors: Sequence[InstrumentErrors]
) -> tuple[InstrumentErrors, ...]:
    """Errors with the length let out by the splices by the end of a test, from steps of tension.

    It has one sign and is not corrected: its standard uncertainty is the root of its mean square
    about zero (JCGM 100:2008, F.2.4.5).
    """
    return tuple(
        replace(one, splices_slipped_by=_OF_SLIP * float(_slipped_length(test, index)[-1]))
        for index, one in enumerate(errors)
    )


def with_drift_not_placed(
    test: ReducedTest, errors: Sequence[InstrumentErrors]
) -> tuple[InstrumentErrors, ...]:
    """Errors with the part of a cycle in which it drifts, for the means of a test.

    A specimen drifts in the same part of the cycle in all of its tests.  Each cycle has this in its
    own uncertainty.
    """
    if test.loops is None:
        return tuple(errors)
    shares = test.loops.drift_not_placed()
    return tuple(
        replace(one, drift_not_placed=float(share))
        for one, share in zip(errors, shares, strict=True)
    )


def _slipped_length(test: ReducedTest, index: int) -> Floats:
    """Least length let out by splices at each cycle since their marks were read. [m].

    A step may be at any of the cycles that it is dated to.  One value where there are no cycles.
    """
    n_cycles = 1 if test.cycles is None else test.cycles.n_cycles
    before = 0.0 if test.history is None else float(test.history.splices_slipped_by[index])
    found = np.full(n_cycles, before)
    slips, number = test.slips, np.arange(1, n_cycles + 1)
    if slips is None:
        return found
    for place, name in enumerate(slips.specimen):
        length = float(slips.slip_length[place])
        if name == test.specimens[index].name and length > 0:
            low, high = int(slips.slip_cycle_low[place]), int(slips.slip_cycle_high[place])
            found += length * np.clip((number - low + 1) / (high - low + 1), 0.0, 1.0)
    return found


def errors_after_slip(
    test: ReducedTest, index: int, errors: InstrumentErrors, cycles: slice | Integers
) -> InstrumentErrors:
    """Errors of a mean over some of the cycles, where some precede a slip."""
    if not errors.splices_slipped_by:
        return errors
    slipped = _slipped_length(test, index)
    share = float(slipped[cycles].mean() / slipped[-1])
    return replace(errors, splices_slipped_by=errors.splices_slipped_by * share)


def slipped_by_cycle(
    found: Contributions, test: ReducedTest, index: int, block: slice
) -> Contributions:
    """Contributions to each cycle, scaled by the length that the splices had let out by then."""
    by_steps = Component("splice_slip", test.specimens[index].name)
    if by_steps not in found.component:
        return found
    slipped = _slipped_length(test, index)
    place, share = found.component.index(by_steps), slipped[block] / slipped[-1]
    values = {name: rows.copy() for name, rows in found.values.items()}
    for rows in values.values():
        rows[place] = (rows[place].T * share).T
    return Contributions(found.component, values)


def errors_of_loops(
    loops: Loops | AmplitudeSummary,
    index: int,
    errors: InstrumentErrors,
    model: StrainModel,
    cycles: Cycles,
    settings: CycleSettings,
    record: Record | None,
    *,
    line: LineParameters | None = None,
) -> Contributions:
    """Each cycle of a specimen, or the means of its test; with E' and E'' of its line if given.

    The line of a wave that is not a sine comes from its fundamental over time, and a lag turns the
    phase of a fundamental.
    """
    values = {name: np.asarray(getattr(loops, name)[index]) for name in LoopQuantities._fields}
    over_time = line is not None and line.reading == "fundamental"
    if line is not None and over_time:
        values |= {name: np.asarray(getattr(line, name)[index]) for name in _OF_FUNDAMENTAL}
    return loop_contributions(
        errors, model, LoopQuantities(**values),
        waveform="sinusoidal" if over_time else settings.waveform,
        control=settings.control,
        speed_ratio=ramp_speed_ratio(loops, index, model, cycles, settings, record),
        has_corners=_has_corners(cycles, settings, record),
        inertia=inertia_of(record, loops, index, errors, model, cycles),
    )  # fmt: skip


_CYCLES_LOOKED_AT = 10


def _has_corners(cycles: Cycles, settings: CycleSettings, record: Record | None) -> bool:
    """Whether the driven channel turns at corners, as far as its first cycles show."""
    if record is None or not cycles.n_cycles:
        return True
    last = min(cycles.n_cycles, _CYCLES_LOOKED_AT) - 1
    begin = int(cycles.first[0])
    part = slice(begin, int(cycles.last[last]) + 1)
    driven = control_channel(record.crosshead_position[part], record.tension[:, part], settings)
    peaks = cycles.branch_last[: last + 1, 0] - begin
    return kind_of_turns(driven, peaks, noise=reading_noise(driven)) != "rounded"


def errors_of_dynamic_modulus(
    of_loop: Contributions,
    summary: AmplitudeSummary,
    index: int,
    errors: InstrumentErrors,
    area: float,
) -> Contributions:
    """Spring constant over area."""
    rows = of_loop.values["apparent_spring_constant"] / area
    component = of_loop.component
    if errors.diameter:
        component = (*component, diameter_error(errors))
        own = by_diameter(summary.dynamic_modulus[index], errors, area=area)
        rows = np.concatenate([rows, own[None]])
    return Contributions(component, {"dynamic_modulus": rows})


def errors_of_line(
    line: LineParameters,
    loops: Loops | AmplitudeSummary,
    index: int,
    of_loop: Contributions,
    of_rest: Contributions,
) -> Contributions:
    """K_1, tau and K_1 tau of each cycle of a specimen, or of the means of its test."""
    values: Mapping[str, Floats] = {
        item.name: getattr(line, item.name)[index]
        for item in fields(line)
        if isinstance(getattr(line, item.name), np.ndarray)
    } | {
        name: np.asarray(getattr(loops, name)[index])
        for name in LoopQuantities._fields
        if name not in ("storage_spring_constant", "loss_spring_constant", "closed_loop_energy")
    }
    # a run has one K_0, so its error is common to every cycle
    rest = of_rest.values[_K_0]
    shape = (*rest.shape[:1], *np.shape(values[_K_0]))
    rest = np.broadcast_to(rest.reshape(rest.shape[:1] + (1,) * (len(shape) - 1)), shape)
    reading: Reading = "fundamental" if line.reading == "fundamental" else "amplitude"
    found = line_contributions(
        of_loop, Contributions(of_rest.component, {_K_0: rest}), values, reading=reading
    )
    names = ("dissipation_spring_constant", "relaxation_time", "dashpot_coefficient")
    return Contributions(found.component, {name: found.values[name] for name in names})


_DYNAMIC = {
    "dynamic_stiffness": "apparent_spring_constant",
    "dynamic_mean_tension": "mean_tension",
    "dynamic_tension_amplitude": "tension_amplitude",
}

"""Means over the last cycles of a step, and the cycle quantity that each is a mean of."""


_OF_TREND = ("peak_tension", "apparent_spring_constant", "mean_strain")


_OF_STEP = (
    "mean_tension", "tension_amplitude", "strain_amplitude", "valley_tension",
)  # fmt: skip


def trend_and_step_contributions(
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
                test.loops, test.trend, test.cycles.number, index, of_each, errors,
                cycles.break_in_cycles, area,
            )  # fmt: skip
        if step is not None and step.dynamic is not None and step.dynamic.n_cycles[index, 0] > 0:
            yield _of_dynamic(test.loops, step.dynamic, index, of_each, errors)
        if step is not None and step.bedding_in is not None:
            yield _of_bedding(test.loops, step.bedding_in, index, of_each, errors)
    if step is not None and step.tensile is not None:
        yield _of_tensile(step.tensile, index, errors, model, cycles)


def errors_of_ends(
    test: ReducedTest, index: int, errors: InstrumentErrors, area: float
) -> Iterator[Contributions]:
    """Secant and chord moduli of each cycle, at the two ends of its loop."""
    loops, ends, model = test.loops, test.end_moduli, test.strain_models[index]
    if loops is None or ends is None:
        return
    mean, half = loops.mean_strain[index], loops.strain_amplitude[index]
    inertia = inertia_of(test.record, loops, index, errors, model, test.cycles)
    high, low = (
        error_field(errors, model, strain=strain, tension=tension[index], inertia=inertia)
        for strain, tension in (
            (mean + half, loops.peak_tension), (mean - half, loops.valley_tension),
        )
    )  # fmt: skip
    secant, chord = ends.secant_modulus[index], ends.chord_modulus[index]
    yield secant_contributions(high, errors, strain=mean + half, secant_modulus=secant, area=area)
    rows = [
        chord_contributions(low, high, stroke=2 * half, chord=chord[:, branch] * area)
        for branch in range(2)
    ]
    both = np.stack([one.values["chord"] / area for one in rows], axis=-1)
    found = Contributions(low.component, {"chord_modulus": both})
    yield with_diameter(found, errors, {"chord_modulus": chord}, area=area)


def errors_of_slips(test: ReducedTest, errors: Sequence[InstrumentErrors]) -> list[Contributions]:
    """Every step of a splice, along one axis; an empty list where there is none.

    The length is a step of tension over a slope of it: gain and temperature affect both, a scale of
    position only the slope.
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
    """Contributions to the cycle quantities used by trends and steps."""
    names = _OF_TREND if test.rope_step is None else (*_OF_TREND, *_OF_STEP)
    component: tuple[Component, ...] = ()
    rows: dict[str, Floats] = {}
    if test.loops is None or test.cycles is None:
        return Contributions(component)
    for block in blocks_of_cycles(test.cycles.n_cycles):
        part = cycles_of_test(test, block)
        if part.loops is None or part.cycles is None:
            continue
        of_block = slipped_by_cycle(
            errors_of_loops(part.loops, index, errors, model, part.cycles, settings, test.record),
            test, index, block,
        )  # fmt: skip
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
    number: Integers,
    index: int,
    of_each: Contributions,
    errors: InstrumentErrors,
    break_in: int,
    area: float,
) -> Contributions:
    """The slopes of `fit_peak_trend`, over the cycles that it uses."""
    peak = _of_series(loops, index, of_each, "peak_tension")
    modulus = _of_series(loops, index, of_each, "apparent_spring_constant") / area
    strain = _of_series(loops, index, of_each, "mean_strain")
    n_ends = cycles_at_an_end(strain.shape[1])
    start = first_of_trend(peak.shape[1], break_in)
    settled = first_of_trend(peak.shape[1], break_in, is_creep=True)
    found = Contributions(
        of_each.component,
        {
            "peak_tension_per_decade": slope_per_decade(peak[:, start:], number=number[start:])[0],
            "dynamic_modulus_per_decade": slope_per_decade(
                modulus[:, start:], number=number[start:]
            )[0],
            "mean_strain_per_decade": slope_per_decade(
                strain[:, settled:], number=number[settled:]
            )[0],
            "mean_strain_drift": strain[:, -n_ends:].mean(axis=1) - strain[:, :n_ends].mean(axis=1),
            "peak_tension_change": _of_change(loops.peak_tension[index], peak),
        },
    )
    value = np.asarray(trend.dynamic_modulus_per_decade[index])
    return with_diameter(found, errors, {"dynamic_modulus_per_decade": value}, area=area)


def _of_change(peak: Floats, of_peak: Floats) -> Floats:
    """Effect of errors of the peaks, one row a component, on the ratio of the last to the first."""
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
    """Secants of the first and the last cycle, their ratio, and the shift of the foot."""
    rows = {
        name: _of_series(loops, index, of_each, name)[:, [0, -1]]
        for name in ("apparent_spring_constant", "mean_strain", "strain_amplitude",
                     "valley_tension")
    }  # fmt: skip
    secant = np.array([bedding.first_stiffness[index], bedding.last_stiffness[index]])
    # the first secant is that of its way up, which its loop without drift does not have: it moves
    # by the same share
    ends = [0, -1]
    of_loops = loops.apparent_spring_constant[index, ends]
    first, last = (rows["apparent_spring_constant"] * secant / of_loops).T
    share = np.array(
        [bedding.first_stiffness_over_strength[index], bedding.last_stiffness_over_strength[index]]
    )
    # nor does a foot lie an amplitude without drift below the mean
    depth = loops.mean_strain[index, ends] - loops.foot_strain[index, ends]
    below = rows["strain_amplitude"] * depth / loops.strain_amplitude[index, ends]
    foot = np.diff(rows["mean_strain"] - below, axis=1)[:, 0]
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
    """Greatest tension of a pull, and its strain; those of a break also under a second name."""
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


def errors_of_holds(test: ReducedTest, errors: Sequence[InstrumentErrors]) -> list[Contributions]:
    """Every hold of a test, along one axis; an empty list where there is none."""
    if not test.holds:
        return []
    places = [_place(test, hold.specimen) for hold in test.holds]
    terms = max(hold.prony_tension.size for hold in test.holds)
    creep = () if test.rope_step is None else test.rope_step.creep
    own = []
    for number, (hold, place) in enumerate(zip(test.holds, places, strict=True)):
        # a hold lies before the first cycle or after the last, or among them
        begun = (
            0
            if test.cycles is None or test.record is None
            else int(np.searchsorted(test.record.time[test.cycles.first], hold.hold_start_time))
        )
        one = errors_after_slip(test, place, errors[place], slice(max(begun - 1, 0), max(begun, 1)))
        found = _of_hold(_padded(hold, terms), one, test.strain_models[place])
        parts = [found]
        if len(creep) == len(test.holds):
            parts.append(_of_creep(found, creep[number], hold, errors[place]))
        own.append(merged(parts))
    return [stacked(own)]


def errors_of_pairs(test: ReducedTest, errors: Sequence[InstrumentErrors]) -> list[Contributions]:
    """Every pair of holds of a test, along one axis; an empty list where there is none."""
    if test.rope_step is None or not test.rope_step.held:
        return []
    numbers = hold_numbers(test.holds).tolist()
    upper = {
        (hold.specimen, number): hold for number, hold in zip(numbers, test.holds, strict=True)
    }
    own = []
    for pair in test.rope_step.held:
        place = _place(test, pair.specimen)
        high = upper[pair.specimen, pair.high_hold]
        own.append(_of_pair(pair, high, errors[place], test.strain_models[place]))
    return [stacked(own)]


def _place(test: ReducedTest, specimen: str) -> int:
    return [one.name for one in test.specimens].index(specimen)


def _constant_channel(hold: HoldResult) -> Literal["position", "tension"]:
    """Channel that the machine holds constant."""
    return "tension" if hold.kind == "creep" else "position"


def _padded(hold: HoldResult, n_terms: int) -> HoldResult:
    missing = n_terms - hold.prony_tension.size
    return replace(hold, prony_tension=np.pad(hold.prony_tension, (0, missing),
                                              constant_values=np.nan))  # fmt: skip


def _of_hold(hold: HoldResult, errors: InstrumentErrors, model: StrainModel) -> Contributions:
    def field_at(strain: Floats, tension: Floats) -> ErrorField:
        return error_field(
            errors, model, strain=strain, tension=tension, held=_constant_channel(hold)
        )

    found = hold_contributions(field_at, hold)
    if not (errors.splice_friction and hold.is_unloading):
        return found
    longer = splice_friction_error(
        errors, model, strain=hold.hold_strain, tension=hold.hold_final_tension
    )
    values = {
        name: np.concatenate(
            [rows, np.full((1, *rows.shape[1:]), longer if name in _STRAINS_OF_HOLD else 0.0)]
        )
        for name, rows in found.values.items()
    }
    return Contributions((*found.component, Component("splice_friction", errors.specimen)), values)


_STRAINS_OF_HOLD = ("hold_strain", "strain_at_time")


def _of_creep(
    of_hold: Contributions, creep: CreepOfHold, hold: HoldResult, errors: InstrumentErrors
) -> Contributions:
    """Tension of a hold over the break strength, and its creep over that fraction."""
    ends = of_hold.values["hold_initial_tension"] + of_hold.values["hold_final_tension"]
    relative = ends / (hold.hold_initial_tension + hold.hold_final_tension)
    value = creep.creep_compliance_per_decade
    rate = of_hold.values["creep_rate_per_decade"] / hold.rate_per_decade
    share = np.array(creep.tension_over_strength)
    found = Contributions(
        of_hold.component,
        {
            "creep_tension_over_strength": share * relative,
            "creep_compliance_per_decade": value * (rate - relative),
        },
    )
    powers = {
        "creep_tension_over_strength": (share, -1.0),
        "creep_compliance_per_decade": (np.array(value), 1.0),
    }
    return over_strength(found, errors, powers)


def _of_pair(
    pair: HeldPair, high: HoldResult, errors: InstrumentErrors, model: StrainModel
) -> Contributions:
    """Tensions of a pair, and the secant between them at the reference time."""
    found = pair.stiffness
    secant, slope, over = (
        (np.nan,) * 3
        if found is None
        else (found.stiffness_at_reference, found.slope_per_decade, found.stiffness_over_strength)
    )
    # the machine holds one of the two at the upper hold; the secant gives the other at that time
    is_creep = high.kind == "creep"
    rise = pair.high_tension - pair.low_tension
    stroke = rise / secant if is_creep else high.hold_strain - pair.low_strain
    rise_then = stroke * secant
    field = error_field(
        errors, model,
        strain=pair.low_strain + np.array([0.0, 0.0, stroke]),
        tension=pair.low_tension + np.array([0.0, rise, rise_then]),
        held=_constant_channel(high),
    )  # fmt: skip
    begin, level, then = range(3)
    low_tension, high_tension = field.tension[:, begin], field.tension[:, level]
    of_rise = (field.tension[:, then] - low_tension) / rise_then
    of_stroke = (field.strain[:, then] - field.strain[:, begin]) / stroke
    chord = secant * (of_rise - of_stroke)
    # the secant is rise over stroke, one of which grows with time.  The error of that growth scales
    # by the slope of its error; for a growing stroke the secant changes by its square
    of_slope = slope * (
        of_rise + field.strain_slope[:, then] - 2 * of_stroke
        if is_creep
        else field.tension_slope[:, then] - of_stroke
    )
    per_strength = over / secant
    values = {
        "held_pair_low_tension": low_tension,
        "held_pair_high_tension": high_tension,
        "static_stiffness": chord,
        "static_stiffness_per_decade": of_slope,
        "static_stiffness_over_strength": chord * per_strength,
        "static_stiffness_per_decade_over_strength": of_slope * per_strength,
    }
    powers = {
        "static_stiffness_over_strength": (np.array(over), -1.0),
        "static_stiffness_per_decade_over_strength": (np.array(slope * per_strength), -1.0),
    }
    return over_strength(Contributions(field.component, values), errors, powers)


_STEP = 1e-3  # of the range of a pull, for the slope of its compliance


@dataclass(frozen=True)
class PullOrigin:
    """Origin of a slow pull: its instruments, and how its position became strain."""

    errors: InstrumentErrors
    model: StrainModel


def _compliance_slope(pull: SlowPull, tension: Floats) -> Floats:
    """Second derivative of strain over tension; zero at the very ends of the pull. [N-2]."""
    step = _STEP * pull.tension_half_range
    beside = [1 / quasi_static_spring_constant(pull, tension + way * step)[0] for way in (1, -1)]
    bend = (beside[0] - beside[1]) / (2 * step)
    return np.asarray(np.where(np.isfinite(bend), bend, 0.0))


def quasi_static_contributions(
    pull: SlowPull,
    origin: PullOrigin,
    tension: Floats,
    of_mean_tension: Contributions,
    line: LineParameters,
    index: int,
) -> Contributions:
    """K_0 at the mean tension of a run, with the errors of the run and those of the pull."""
    field, constant = _at(pull, origin.errors, origin.model, tension)
    bend = _compliance_slope(pull, tension)
    at_tension = pull_contributions(
        field, quasi_static_spring_constant=constant, compliance_slope=bend
    )
    # K_0 is read at the mean tension by the load cell of the run
    along = Contributions(
        of_mean_tension.component,
        {_K_0: -(constant**2) * bend * of_mean_tension.values["mean_tension"]},
    )
    errors = origin.errors
    name = f"{errors.specimen}, {errors.test}" if errors.test else errors.specimen
    found = merged([at_tension, along, fit_contributions(pull, tension, of=name)])
    tau = float(line.relaxation_time[index])
    if not is_short_pull(pull, tau):
        return found
    by_rate = error_of_pull_rate(
        pull, float(tension), relaxation_time=tau,
        spring_constant=float(line.dissipation_spring_constant[index]),
    )  # fmt: skip
    of_rate = Contributions((Component("pull_rate", name),), {_K_0: np.array([by_rate])})
    return merged([found, of_rate])


def errors_of_pull(
    pull: SlowPull,
    errors: InstrumentErrors,
    model: StrainModel,
    *,
    tension: Floats,
    share: Floats,
    rated_break_strength: float | None,
) -> Iterator[Contributions]:
    """K_0 and strain on a grid of tension, and strain at shares of the break strength."""
    field, constant = _at(pull, errors, model, tension)
    found = pull_contributions(
        field,
        quasi_static_spring_constant=constant,
        compliance_slope=_compliance_slope(pull, tension),
    )
    yield found
    of_strain = _at_tension(field, constant)
    yield Contributions(
        field.component,
        {
            "quasi_static_strain": of_strain,
            "pull_strain_coefficient": _of_cubic(pull, tension, of_strain),
        },
    )
    if rated_break_strength is None:
        return
    load = share * rated_break_strength
    field, constant = _at(pull, errors, model, load)
    at_share = Contributions(
        field.component, {"strain_at_break_share": _at_tension(field, constant)}
    )
    # a higher strength means more tension at the fraction, through the compliance there
    yield over_strength(at_share, errors, {"strain_at_break_share": (load / constant, 1.0)})


def _at(
    pull: SlowPull, errors: InstrumentErrors, model: StrainModel, tension: Floats
) -> tuple[ErrorField, Floats]:
    strain = strain_at_tension(pull, tension)[0]
    # a pull is read at a given tension: a stiffer specimen has stretched less there
    field = error_field(errors, model, strain=strain, tension=tension, held="tension")
    return field, quasi_static_spring_constant(pull, tension)[0]


def _of_cubic(pull: SlowPull, tension: Floats, of_strain: Floats) -> Floats:
    """Contributions to A, B, C and D: a cubic through the errors of strain, where there is one."""
    known = np.isfinite(of_strain).all(axis=0)
    scaled = (tension[known] - pull.tension_centre) / pull.tension_half_range
    basis = np.stack([scaled**power for power in range(4)], axis=1)
    solved = of_strain[:, known] @ np.linalg.pinv(basis).T
    rows = [replace(pull, coefficient=row).strain_coefficient for row in solved]
    return np.reshape(rows, (len(rows), 4))


def _at_tension(field: ErrorField, constant: Floats) -> Floats:
    """Error of strain at one tension of the cell."""
    return np.asarray(field.strain - field.tension / constant)


_OF_READINGS = ("tension", "strain")


_MODULI = ("interval_modulus", "secant_modulus")


def with_shared_steps(test: ReducedTest, instruments: Sequence[InstrumentErrors]) -> ReducedTest:
    """Readings with their shared errors, and the moduli between them with each contribution."""
    result, (specimen,) = test.stepwise, test.specimens
    if result is None or not instruments:
        return test
    errors = instruments[0]
    found = stepwise_contributions(result, errors, area=specimen.area)
    if not found.component:
        return test
    moduli = Contributions(found.component, {name: found.values[name] for name in _MODULI})
    section = section_contributions(errors, area=specimen.area)
    if np.isnan(result.tension_standard_uncertainty) and np.any(found.values["tension"]):
        # nothing is stated for a reading of a weight: beside stated errors that counts as zero
        result = replace(result, tension_standard_uncertainty=0.0)
    whole = merged([moduli, stacked([section])] if section.component else [moduli])
    return replace(
        test,
        stepwise=result,
        contributions=whole,
        shared_uncertainty_of_cycles={
            name: found.shared_standard_uncertainty(name) for name in _OF_READINGS
        },
    )
