"""Errors that a test shares with others, carried to all of its results.

**Effect of shared errors on results from the table of cycles: trends, slips, rope steps.** A
mean over cycles, or a slope against their number, is linear in the cycles: the errors of the cycles
go through the same mean or slope.

**Effect of shared errors on the other results of a test.** Names of the contributions are
those of the variables of the archive; the axis of the specimens follows that of the
components.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any, Literal, TypeVar

import numpy as np
import scipy

from reduction.quantities.flags import LAG_REFUSALS
from reduction.record.contributions import (
    Component,
    Contributions,
    InstrumentErrors,
    added,
    merged,
    renamed,
    stacked,
)
from reduction.record.measurement import Floats, Integers, Record, areas_of
from reduction.record.notes import Note, note
from reduction.record.samples import empty_like, full_like, release_pages, take_samples
from reduction.record.settings import CycleSettings
from reduction.stages.channel_lag import (
    LagEstimate,
    delay_by_noise,
    lag_at_stops,
    lag_by_turns,
)
from reduction.stages.cycles.cycle_product import Cycles, Loops
from reduction.stages.cycles.cycle_search import control_channel
from reduction.stages.cycles.reading_noise import reading_noise
from reduction.stages.cycles.turns import kind_of_turns
from reduction.stages.holds.hold_product import HoldResult, hold_numbers
from reduction.stages.load_train import length_by_stroke
from reduction.stages.moduli.elastomer_laws import LAWS
from reduction.stages.moduli.modulus_product import (
    AmplitudeSummary,
    ElastomerFit,
    ModulusCurves,
    PeakTrend,
    Segments,
)
from reduction.stages.moduli.secant_modulus import (
    cycles_at_an_end,
    first_of_trend,
    slope_per_decade,
)
from reduction.stages.reduced_test import ReducedTest
from reduction.stages.standstills import Standstills, median_step
from reduction.stages.strain.strain_model import StrainModel, position_by_model
from reduction.stages.three_parameter_line.hold_pairs import CreepOfHold, HeldPair
from reduction.stages.three_parameter_line.line_product import LineParameters, SlowPull
from reduction.stages.three_parameter_line.rope_programme import (
    BeddingIn,
    DynamicStiffness,
    TensilePull,
)
from reduction.stages.three_parameter_line.slow_pull import (
    BREAK_SHARES,
    error_of_pull_rate,
    is_short_pull,
    quasi_static_spring_constant,
    strain_at_tension,
    tension_grid,
)
from reduction.uncertainty.error_field import (
    ErrorField,
    Inertia,
    coefficient_errors,
    error_field,
    splice_friction_error,
)
from reduction.uncertainty.propagation import (
    LoopQuantities,
    by_diameter,
    chord_contributions,
    curve_contributions,
    diameter_error,
    elastomer_contributions,
    fit_contributions,
    hold_contributions,
    line_contributions,
    loop_contributions,
    over_strength,
    pull_contributions,
    ratio_contributions,
    reversibility_error,
    secant_contributions,
    section_contributions,
    segment_contributions,
    stepwise_contributions,
    strain_rate_of_wave,
    stress_contributions,
    with_diameter,
    with_shared_interval,
)

# every component has a row for each quantity of each cycle
_BLOCK = 1 << 14

Product = TypeVar("Product")


def _blocks_of_cycles(n_cycles: int) -> Iterator[slice]:
    """Slices that cover the cycles of a test."""
    for start in range(0, n_cycles, _BLOCK):
        yield slice(start, min(start + _BLOCK, n_cycles))


def _cycles_of_test(test: ReducedTest, block: slice) -> ReducedTest:
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


Reading = Literal["amplitude", "fundamental"]

_OF_FUNDAMENTAL = ("storage_spring_constant", "loss_spring_constant")

_K_0 = "quasi_static_spring_constant"


def _speed_ratio(
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


def _inertia_of(
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


def _slipped(
    test: ReducedTest, index: int, errors: InstrumentErrors, cycles: slice | Integers
) -> InstrumentErrors:
    """Errors of a mean over some of the cycles, where some precede a slip."""
    if not errors.splices_slipped_by:
        return errors
    slipped = _slipped_length(test, index)
    share = float(slipped[cycles].mean() / slipped[-1])
    return replace(errors, splices_slipped_by=errors.splices_slipped_by * share)


def _slipped_by_cycle(
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


def _of_loops(
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
        speed_ratio=_speed_ratio(loops, index, model, cycles, settings, record),
        has_corners=_has_corners(cycles, settings, record),
        inertia=_inertia_of(record, loops, index, errors, model, cycles),
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


def _of_dynamic_modulus(
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


def _of_line(
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


_SMOOTHED = 5  # bins: a slope of the modulus from bin to bin is mostly scatter


def _strain_rates(
    test: ReducedTest, index: int, model: StrainModel, cycles: CycleSettings
) -> Floats:
    """Strain rate on the grid, and its slope over strain; descending below ascending."""
    if test.amplitude is None or test.cycles is None or test.curves is None:
        return np.zeros((2, 2, 0 if test.curves is None else test.curves.strain_bin.size))
    summary = test.amplitude
    frequency, amplitude = summary.frequency[index], summary.strain_amplitude[index]
    if not (frequency > 0 and amplitude > 0):
        return np.zeros((2, 2, test.curves.strain_bin.size))
    rate, slope = strain_rate_of_wave(
        test.curves.strain_bin,
        frequency=float(frequency),
        mean_strain=float(summary.mean_strain[index]),
        strain_amplitude=float(amplitude),
        waveform=cycles.waveform,
        speed_ratio=float(_speed_ratio(summary, index, model, test.cycles, cycles, test.record)),
    )
    return np.stack([[rate, -rate], [slope, -slope]])


def _rise_rates(test: ReducedTest, index: int) -> Floats:
    """Strain rate of the first rise on its grid, and its slope; zero on the descending branch.

    Computed from the times at which each strain is first reached: a stop on the way is one slow
    bin, which a running median removes.
    """
    if test.first_loading is None or test.record is None or test.strain is None:
        return np.zeros(
            (2, 2, 0 if test.first_loading is None else test.first_loading.strain_bin.size)
        )
    at = test.first_loading.strain_bin
    still = np.zeros(at.size)
    strain = test.strain[index]
    reached = strain >= at[-1]
    end = int(reached.argmax()) + 1 if reached.any() else strain.size
    highest = np.fmax.accumulate(strain[:end])
    begin = int(np.isfinite(highest).argmax())
    place = np.searchsorted(highest[begin:], at) + begin
    inside = place < end
    if inside.sum() <= _SMOOTHED:
        return np.stack([[still, still], [still, still]])
    reach, time = at[inside], test.record.time[place[inside]]
    with np.errstate(divide="ignore"):
        found = scipy.ndimage.median_filter(
            np.gradient(reach) / np.gradient(time), size=_SMOOTHED, mode="nearest"
        )
    rate = np.interp(at, reach, np.where(np.isfinite(found), found, 0.0))
    return np.stack([[rate, still], [_smooth_slope(rate, at), still]])


def _smooth_slope(modulus: Floats, strain: Floats) -> Floats:
    """Slope of the modulus over strain, from lines over a few bins; zero if there are too few."""
    known = np.isfinite(modulus)
    if known.sum() <= _SMOOTHED:
        return np.zeros(modulus.shape)
    at, values = strain[known], modulus[known]
    edge = _SMOOTHED // 2
    # straight lines in windows: a running mean would flatten the ends
    left = np.clip(np.arange(at.size) - edge, 0, at.size - _SMOOTHED)
    window = left[:, None] + np.arange(_SMOOTHED)
    x = at[window] - at[window].mean(axis=1, keepdims=True)
    slope = np.sum(x * values[window], axis=1) / np.sum(x**2, axis=1)
    return np.asarray(np.interp(strain, at, slope))


def _of_curves(
    curves: ModulusCurves,
    suffix: str,
    index: int,
    errors: InstrumentErrors,
    model: StrainModel,
    area: float,
    rate: Floats,
    inertia: Inertia | None = None,
) -> Contributions:
    """Both branches of one specimen, by name of the archive."""
    known = curves.tangent_modulus[index], curves.tangent_modulus_untrimmed[index]
    # readers remove an error of strain from the tension by the slope stored in the archive
    slope = np.where(np.isfinite(known[1]), known[1], known[0])
    tension, slope = _completed(curves.strain_bin, curves.branch_tension[index], slope, area)
    strain = np.broadcast_to(curves.strain_bin, tension.shape)
    field = error_field(errors, model, strain=strain, tension=tension, inertia=inertia)
    of_inertia = (
        np.zeros(tension.shape)
        if inertia is None
        else inertia.mass * inertia.acceleration(model, strain=strain, tension=tension)[1]
    )

    def at_slope(modulus: Floats) -> Contributions:
        bend = np.stack([_smooth_slope(row, curves.strain_bin) for row in modulus])
        return curve_contributions(
            field, errors, tangent_modulus=modulus, area=area, modulus_slope=bend,
            strain_rate=rate[0], strain_rate_slope=rate[1], inertia_slope=of_inertia,
        )  # fmt: skip

    of_tension = at_slope(slope)
    values = {f"branch_tension{suffix}": of_tension.values["branch_tension"]}
    names = ("tangent_modulus",) if suffix else ("tangent_modulus", "tangent_modulus_untrimmed")
    for name, modulus in zip(names, known, strict=False):
        whole = np.where(np.isfinite(modulus), modulus, slope)
        values[f"{name}{suffix}"] = at_slope(whole).values["tangent_modulus"]
    component = of_tension.component
    if errors.splice_friction and not suffix:  # the marks are read on the way of a first rise
        away, steeper = _friction_on_branches(errors, model, curves.strain_bin, tension)
        rise = area * slope
        values["branch_tension"] = np.concatenate([values["branch_tension"], (-rise * away)[None]])
        for name in names:
            modulus = getattr(curves, name)[index]
            modulus = np.where(np.isfinite(modulus), modulus, slope)
            bend = np.stack([_smooth_slope(row, curves.strain_bin) for row in modulus])
            own = -(modulus * steeper + bend * away)
            values[name] = np.concatenate([values[name], own[None]])
        component = (*component, Component("splice_friction", errors.specimen))
    if errors.tension_reversibility and not suffix:  # a first rise has no way down
        off, steeper = _reversibility_on_branches(errors, tension)
        felt = 1 - field.strain_by_tension * area * slope
        values["branch_tension"] = np.concatenate([values["branch_tension"], (felt * off)[None]])
        for name in names:
            modulus = getattr(curves, name)[index]
            own = felt * steeper * np.where(np.isfinite(modulus), modulus, slope)
            values[name] = np.concatenate([values[name], own[None]])
        component = (*component, Component("tension_reversibility", errors.tension_instrument))
    if curves.tangent_modulus_window_uncertainty is None:
        return Contributions(component, values)
    missed = np.nan_to_num(curves.tangent_modulus_window_uncertainty[index])
    by_window = {
        "branch_tension": np.zeros_like(missed),
        "tangent_modulus_untrimmed": np.hypot(missed, _window_blur(curves, index)),
    }
    values = {
        name: np.concatenate([rows, by_window.get(name, missed)[None]])
        for name, rows in values.items()
    }
    window = Component("window", f"{errors.test} {errors.specimen}")
    return Contributions((*component, window), values)


def _reversibility_on_branches(errors: InstrumentErrors, tension: Floats) -> tuple[Floats, Floats]:
    """Error of tension by the load cell on the way down, and its slope over tension."""
    off, steeper = np.zeros(tension.shape), np.zeros(tension.shape)
    down = tension[1]
    known = np.isfinite(down)
    if known.sum() > 1:
        off[1, known], steeper[1, known] = reversibility_error(
            errors, down[known], np.min(down[known]), np.max(down[known])
        )
    return off, steeper


_TINY = 1e-12  # of the strain 1


def _friction_on_branches(
    errors: InstrumentErrors, model: StrainModel, strain: Floats, tension: Floats
) -> tuple[Floats, Floats]:
    """Error of strain by the friction of splices, and its slope over strain, for both branches.

    After a reversal a splice stands still until the length by its law differs by more than friction
    can hold.
    """
    at = np.broadcast_to(strain, tension.shape)
    longer = splice_friction_error(errors, model, strain=at, tension=tension)
    away, steeper = np.zeros(tension.shape), np.zeros(tension.shape)
    for branch in range(2):
        known = np.isfinite(longer[branch])
        if known.sum() < 2:
            continue
        own = longer[branch, known]
        reversal = own[-branch]
        gone = np.abs(own / max(reversal, _TINY) - 1)
        share = np.exp(-gone / (2 * errors.splice_friction))
        away[branch, known] = own * (share if branch == 0 else 1 - share)
        steeper[branch, known] = np.gradient(away[branch, known], strain[known])
    return away, steeper


_MOVED = 1e-3


def _window_blur(curves: ModulusCurves, index: int) -> Floats:
    """Possible error of the untrimmed modulus near a reversal, due to the window. [Pa].

    The modulus changes at a reversal within less than a window: where the trimmed
    samples change it, it is known to lie between there and half a window further in.
    """
    half = curves.window / 2
    smeared: Floats = np.zeros_like(curves.tangent_modulus[index])
    rows = zip(
        curves.tangent_modulus[index], curves.tangent_modulus_untrimmed[index], smeared, strict=True
    )
    for trimmed, whole, row in rows:
        known = np.isfinite(whole)
        if not known.any():
            continue
        strain = curves.strain_bin[known]
        inwards = np.where(strain < (strain[0] + strain[-1]) / 2, half, -half)
        further = np.interp(strain + inwards, strain, whole[known])
        # a bin without samples left (NaN) counts as moved
        moved = ~np.isclose(trimmed[known], whole[known], rtol=_MOVED, atol=0.0)
        row[known] = np.where(moved, np.abs(whole[known] - further) / np.sqrt(3), 0.0)
    return smeared


def _completed(
    strain: Floats, tension: Floats, modulus: Floats, area: float
) -> tuple[Floats, Floats]:
    """Tension and modulus of each branch where either is known, the other derived from it.

    A bin may have enough samples for a mean and too few for a slope, or the reverse: an error of
    its strain changes both.
    """
    filled, slopes = tension.copy(), modulus.copy()
    for row, slope in zip(filled, slopes, strict=True):
        has = np.isfinite(row)
        if has.sum() < 2:
            continue
        bare = has & ~np.isfinite(slope)
        slope[bare] = np.gradient(row[has], strain[has])[bare[has]] / area
        lacks = np.isfinite(slope) & ~has
        nearest = np.flatnonzero(has)[np.abs(strain[lacks, None] - strain[has]).argmin(axis=1)]
        row[lacks] = row[nearest] + area * slope[lacks] * (strain[lacks] - strain[nearest])
    return filled, slopes


def _of_segments(
    curves: ModulusCurves,
    segments: Segments,
    index: int,
    errors: InstrumentErrors,
    model: StrainModel,
    area: float,
    rate: Floats,
    inertia: Inertia | None,
) -> Contributions:
    """Segments of both branches; zero where a branch has none."""
    of_curve = _of_curves(curves, "", index, errors, model, area, rate, inertia)
    low, high = segments.segment_strain_low[index], segments.segment_strain_high[index]
    shape = (len(of_curve.component), *low.shape)
    names = ("segment_modulus", "segment_tension_low", "segment_tension_high")
    values = {name: np.zeros(shape) for name in names}
    for branch in range(low.shape[0]):
        known = np.isfinite(low[branch])
        if not known.any():
            continue
        knot = np.append(low[branch, known], high[branch, known][-1])
        rows = of_curve.values["branch_tension"][:, branch]
        inside = (curves.strain_bin >= knot[0]) & (curves.strain_bin <= knot[-1])
        inside &= np.isfinite(rows).all(axis=0)
        found = segment_contributions(
            Contributions(of_curve.component, {"branch_tension": rows[:, inside]}),
            errors, strain=curves.strain_bin[inside], knot=knot,
            segment_modulus=segments.segment_modulus[index, branch, known], area=area,
        )  # fmt: skip
        for name in names:
            values[name][:, branch, known] = found.values[name]
    return Contributions(of_curve.component, values)


_LENGTHS = ("relaxed_free_length", "gauge_length")


def _of_material(
    test: ReducedTest, index: int, errors: InstrumentErrors, model: StrainModel, area: float
) -> Iterator[Contributions]:
    """Stress at stated elongations, strain at slack, section of one specimen."""
    if test.stress_at_strain is not None and test.first_loading is not None:
        yield _of_stress(test, index, errors, model, area)
    yield from _of_slack(test, index, errors, model)
    if np.isfinite(area):
        yield section_contributions(errors, area=area)


def _of_stress(
    test: ReducedTest, index: int, errors: InstrumentErrors, model: StrainModel, area: float
) -> Contributions:
    """In the order of the archive: rising elongation."""
    if test.first_loading is None or test.stress_at_strain is None:
        return Contributions(())
    level = np.asarray(test.stress_at_strain_levels, dtype=np.float64)
    stress = test.stress_at_strain[index]
    modulus = test.first_loading.tangent_modulus[index, 0]
    known = np.isfinite(modulus)
    slope = (
        np.interp(level, test.first_loading.strain_bin[known], modulus[known])
        if known.any()
        else np.full(level.shape, np.nan)
    )
    field = error_field(errors, model, strain=level, tension=stress * area)
    rate = (
        np.interp(level, test.first_loading.strain_bin, _rise_rates(test, index)[0, 0])
        if errors.lag
        else 0.0
    )
    found = stress_contributions(
        field, errors, stress=stress, tension_slope=slope * area, area=area, strain_rate=rate
    )
    order = np.argsort(level, kind="stable")
    return Contributions(found.component, {"stress_at_strain": found.values["stress"][:, order]})


def _of_slack(
    test: ReducedTest, index: int, errors: InstrumentErrors, model: StrainModel
) -> Iterator[Contributions]:
    """Differences of two positions at one small tension, over the relaxed length.

    A zero of the crosshead is in both and cancels.  A load cell with a high zero finds both at less
    tension than intended; they move by the extension of the specimen for that tension there.
    A gain scales the slack tension too where this is a fraction of the greatest tension.  A stated
    slack tension would have only the gain error of that small tension, which is left out.
    """
    of_model = errors.strain_model or errors.specimen
    # for each error: its effect on the length, the tension at the crossings, and their time
    parts = [
        (Component("position_gain", errors.position_instrument), errors.position_gain, 0.0, 0.0),
        (Component("strain_gain", of_model), errors.strain_gain, 0.0, 0.0),
        (Component("tension_offset", errors.tension_instrument), 0.0, -errors.tension_offset, 0.0),
        (Component("lag", errors.tension_instrument), 0.0, 0.0, errors.lag),
    ]
    name = next((one for one in _LENGTHS if one in model.coefficients), None)
    if name is not None:
        # the errors of the tape that enter every strain of the test
        by_tape = coefficient_errors(model)[list(model.coefficients).index(name)]
        parts += [
            (Component("strain_calibration", of_model, number), -share, 0.0, 0.0)
            for number, share in enumerate((by_tape / model.coefficients[name]).tolist())
        ]
    parts = [one for one in parts if any(one[1:])]
    if not parts:
        return
    component = tuple(one[0] for one in parts)
    by_length, by_tension, by_time = np.array([one[1:] for one in parts]).T
    history, slack = test.history, test.slack_strain
    values = {}
    if slack is not None:
        values["slack_strain_at_unloading"] = (
            by_length * slack.strain[index]
            + by_tension * slack.by_tension[index]
            + by_time * slack.by_lag[index]
        )
    if history is not None:
        # both crossings of a set are on first rises at the same rate: a lag does not change it
        values["permanent_set"] = (
            by_length * history.permanent_set[index]
            + by_tension * history.permanent_set_by_tension[index]
        )
    yield Contributions(component, values)


def _of_elastomers(
    test: ReducedTest, errors: Sequence[InstrumentErrors], found: Contributions
) -> list[Contributions]:
    """Every parameter of every law, along one axis; an empty list where there is none.

    ``found`` holds the contributions to the tension of the first loading.
    """
    first = test.first_loading
    rows = found.values.get("branch_tension_first_loading")
    if not test.elastomers or first is None or rows is None:
        return []
    names = [one.name for one in test.specimens]
    areas = areas_of(test.specimens)
    own = []
    for fit in test.elastomers:
        place = names.index(fit.specimen)
        area = float(areas[place])
        stress = Contributions(found.component, {"stress": rows[:, place, 0] / area})
        value = {"stress": first.branch_tension[place, 0] / area}
        diameterless = [one.source != "diameter" for one in stress.component]
        stress = Contributions(
            tuple(one for one in stress.component if one.source != "diameter"),
            {"stress": stress.values["stress"][diameterless]},
        )
        stress = with_diameter(stress, errors[place], value, area=area)
        own += _of_fit(stress, first.strain_bin, value["stress"], fit)
    return [stacked(own)]


def _of_fit(
    contribution: Contributions, strain: Floats, stress: Floats, fit: ElastomerFit
) -> list[Contributions]:
    """One entry a parameter: a modulus or an exponent, whichever it is."""
    if np.isfinite(list(fit.parameters.values())).all():
        rows = elastomer_contributions(
            contribution.values["stress"], strain=strain, stress=stress,
            law=next(one for one in LAWS if one == fit.law), parameters=fit.parameters,
        )  # fmt: skip
    else:
        rows = np.full((len(contribution.component), len(fit.parameters)), np.nan)
    return [
        merged(
            [
                Contributions(
                    contribution.component,
                    {"elastomer_modulus": column, "elastomer_exponent": column},
                )
            ]
        )
        for column in rows.T
    ]


def _of_ratios(test: ReducedTest, found: Contributions) -> list[Contributions]:
    """Every ratio, along one axis; ``found`` holds the contributions to the moduli.

    Two sets of cycles of one specimen have the errors of instruments, section and
    splices in equal proportion: they cancel.
    """
    rows = found.values.get("tangent_modulus")
    if not test.ratios or test.curves is None or rows is None:
        return []
    names = [one.name for one in test.specimens]
    moduli = test.curves.tangent_modulus
    tables: list[Floats] = []
    for ratio in test.ratios:
        if ratio.numerator not in names or ratio.denominator not in names:
            tables.append(np.zeros((len(found.component), *ratio.ratio.shape)))
            continue
        above, below = names.index(ratio.numerator), names.index(ratio.denominator)
        tables.append(
            ratio_contributions(
                ratio.ratio,
                numerator=moduli[above],
                of_numerator=rows[:, above],
                denominator=moduli[below],
                of_denominator=rows[:, below],
            )
        )
    return [Contributions(found.component, {"modulus_ratio": np.stack(tables, axis=1)})]


def with_shared_ratios(test: ReducedTest) -> ReducedTest:
    """Ratios with the interval of all errors; as they are where none is shared."""
    shared = test.contributions
    rows = None if shared is None else shared.values.get("modulus_ratio")
    if shared is None or rows is None:
        return test
    names = {one.name for one in test.specimens}
    wider = [
        with_shared_interval(ratio, rows[:, place], of_contribution=shared.degrees_of_freedom)
        if ratio.numerator in names
        else ratio
        for place, ratio in enumerate(test.ratios)
    ]
    return replace(test, ratios=tuple(wider))


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


def _of_ends(
    test: ReducedTest, index: int, errors: InstrumentErrors, area: float
) -> Iterator[Contributions]:
    """Secant and chord moduli of each cycle, at the two ends of its loop."""
    loops, ends, model = test.loops, test.end_moduli, test.strain_models[index]
    if loops is None or ends is None:
        return
    mean, half = loops.mean_strain[index], loops.strain_amplitude[index]
    inertia = _inertia_of(test.record, loops, index, errors, model, test.cycles)
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


def _of_slips(test: ReducedTest, errors: Sequence[InstrumentErrors]) -> list[Contributions]:
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
    for block in _blocks_of_cycles(test.cycles.n_cycles):
        part = _cycles_of_test(test, block)
        if part.loops is None or part.cycles is None:
            continue
        of_block = _slipped_by_cycle(
            _of_loops(part.loops, index, errors, model, part.cycles, settings, test.record),
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


def _of_holds(test: ReducedTest, errors: Sequence[InstrumentErrors]) -> list[Contributions]:
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
        one = _slipped(test, place, errors[place], slice(max(begun - 1, 0), max(begun, 1)))
        found = _of_hold(_padded(hold, terms), one, test.strain_models[place])
        parts = [found]
        if len(creep) == len(test.holds):
            parts.append(_of_creep(found, creep[number], hold, errors[place]))
        own.append(merged(parts))
    return [stacked(own)]


def _of_pairs(test: ReducedTest, errors: Sequence[InstrumentErrors]) -> list[Contributions]:
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


def _quasi_static_contributions(
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
    found = added([at_tension, along, fit_contributions(pull, tension, of=name)])
    tau = float(line.relaxation_time[index])
    if not is_short_pull(pull, tau):
        return found
    by_rate = error_of_pull_rate(
        pull, float(tension), relaxation_time=tau,
        spring_constant=float(line.dissipation_spring_constant[index]),
    )  # fmt: skip
    of_rate = Contributions((Component("pull_rate", name),), {_K_0: np.array([by_rate])})
    return added([found, of_rate])


def _of_pull(
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


_NOTED = 2.0  # standard uncertainties


def lag_of_test(
    record: Record,
    position: Floats,
    tension: Floats,
    cycles: Cycles,
    *,
    standstills: Standstills | None = None,
    stated: Sequence[float] = (),
) -> tuple[LagEstimate, list[Note]]:
    """Estimate the lag of each tension channel, with a note where it exceeds the stated lag."""
    turns = np.concatenate([cycles.branch_first.ravel(), cycles.branch_last.ravel()])
    estimate = lag_by_turns(record.time, position, tension, turns)
    is_of_stops = np.isin(estimate.refusal, _WITHOUT_TURNS).all()
    if standstills is not None and is_of_stops:
        edges = np.concatenate([turns, standstills.first, standstills.last])
        stops = standstills.first[~standstills.is_rest]
        estimate = lag_at_stops(record.time, position, tension, stops, edges)
    known = np.asarray(stated) if len(stated) else np.zeros(len(record.specimens))
    total = np.hypot(estimate.standard_uncertainty, known)
    step = median_step(record.time)
    period = step * float(np.median(cycles.last - cycles.first))
    notes = []
    for place, name in enumerate(record.specimens):
        lag, spread, own = estimate.lag[place], estimate.standard_uncertainty[place], known[place]
        if lag > _NOTED * total[place]:
            notes.append(note(
                "tension-late", name, lag=float(lag), spread=float(spread), stated=float(own),
                is_of_stops=bool(is_of_stops),
            ))  # fmt: skip
            continue
        late = step * delay_by_noise(position, tension[place], samples_per_cycle=period / step)
        if late > max(_NOTED * own, _LEAST_DELAY * period):
            notes.append(note("tension-filtered", name, lag=late, spread=late / 4))
    return estimate, notes


_LEAST_DELAY = 5e-4  # of a period: a phase of 0.003, a thirtieth of a loss factor of 0.1

_WITHOUT_TURNS = [LAG_REFUSALS[name] for name in ("few_turns", "turns_not_sharp")]


# an archive has them for each cycle, not for the means of a test
_OF_CYCLES_ALONE = ("peak_tension", "valley_tension", "foot_strain")


def contributions_of_test(
    test: ReducedTest,
    errors: Sequence[InstrumentErrors],
    *,
    cycles: CycleSettings,
    pulls: Sequence[SlowPull | None] | None = None,
    pull_origins: Sequence[PullOrigin | None] = (),
) -> Contributions | None:
    """Contribution of each shared error to the curves, segments and means of a test."""
    own = []
    for index, one in enumerate(errors):
        pull = None if pulls is None else pulls[index]
        origin = pull_origins[index] if pull_origins else None
        own.append(merged(list(_of_specimen(test, index, one, cycles, pull, origin))))
    found = stacked(own)
    parts = [
        found,
        *_of_holds(test, errors),
        *_of_pairs(test, errors),
        *_of_slips(test, errors),
        *_of_elastomers(test, errors, found),
        *_of_ratios(test, found),
    ]
    whole = merged(parts)
    return whole if whole.component else None


def shared_uncertainty_of_cycles(
    test: ReducedTest,
    errors: Sequence[InstrumentErrors],
    *,
    cycles: CycleSettings,
    pulls: Sequence[SlowPull | None] | None = None,
    pull_origins: Sequence[PullOrigin | None] = (),
) -> dict[str, Floats]:
    """Shared standard uncertainty of each cycle quantity, shape (n_specimens, n_cycles)."""
    if test.loops is None:
        return {}
    n_specimens, n_cycles = test.loops.mean_tension.shape
    shared: dict[str, Floats] = {}
    for block in _blocks_of_cycles(n_cycles):
        part = _cycles_of_test(test, block)
        for index, one in enumerate(errors):
            pull = None if pulls is None else pulls[index]
            origin = pull_origins[index] if pull_origins else None
            found = _slipped_by_cycle(
                _contributions_to_cycles(test, part, index, one, cycles, pull, origin),
                test, index, block,
            )  # fmt: skip
            for name in found.values if found.component else ():
                spread = found.shared_standard_uncertainty(name)
                if name not in shared:
                    # a specimen without a slow pull has no line: its uncertainty is unknown
                    shared[name] = full_like(
                        test.loops.mean_tension, np.nan,
                        shape=(n_specimens, n_cycles, *spread.shape[1:]),
                    )  # fmt: skip
                shared[name][index, block] = spread
        release_pages(*shared.values())
        test.loops.release_pages()
    return shared


def _of_specimen(
    test: ReducedTest,
    index: int,
    errors: InstrumentErrors,
    cycles: CycleSettings,
    pull: SlowPull | None,
    origin: PullOrigin | None,
) -> Iterator[Contributions]:
    model = test.strain_models[index]
    area = float(areas_of(test.specimens)[index])
    summary = test.amplitude
    # a first rise comes before the cycles
    at_first = _slipped(test, index, errors, slice(0, 1))
    yield from _of_material(test, index, at_first, model, area)
    yield from trend_and_step_contributions(test, index, errors, model, cycles, area)
    own = test.pulls[index] if test.pulls else None
    if own is not None:
        strength = test.specimens[index].rated_break_strength
        yield from _of_pull(
            own, errors, model, tension=tension_grid(test.pulls), share=np.array(BREAK_SHARES),
            rated_break_strength=strength,
        )  # fmt: skip
    if test.curves is not None:
        rate = _strain_rates(test, index, model, cycles)
        # there is no acceleration along the ramps of a triangle
        inertia = (
            None
            if summary is None or cycles.waveform == "triangular"
            else _inertia_of(test.record, summary, index, errors, model, test.cycles)
        )
        at_curves = _slipped(test, index, errors, test.curves.selected_cycle - 1)
        yield _of_curves(test.curves, "", index, at_curves, model, area, rate, inertia)
        if test.segments is not None:
            yield _of_segments(
                test.curves, test.segments, index, at_curves, model, area, rate, inertia
            )
    # without an area the curve is one of tension, whose slope is not kept
    if test.first_loading is not None and np.isfinite(area):
        rate = _rise_rates(test, index) if errors.lag else np.zeros((2, 2, 1))
        yield _of_curves(test.first_loading, "_first_loading", index, at_first, model, area, rate)
    if summary is not None and test.cycles is not None:
        errors = _slipped(test, index, errors, slice(cycles.break_in_cycles, None))
        of_loop = _of_loops(summary, index, errors, model, test.cycles, cycles, test.record)
        yield _named(of_loop, "test_", left_out=_OF_CYCLES_ALONE)
        if np.isfinite(area):
            yield _named(_of_dynamic_modulus(of_loop, summary, index, errors, area), "test_")
        if test.line_of_test is not None and pull is not None:
            rest = _quasi_static_contributions(
                pull, origin or PullOrigin(errors, model),
                np.asarray(summary.mean_tension[index]), of_loop, test.line_of_test, index,
            )  # fmt: skip
            yield _named(rest, "test_")
            line = test.line_of_test
            of_both = _of_loops(
                summary, index, errors, model, test.cycles, cycles, test.record, line=line
            )
            yield _named(_of_line(line, summary, index, of_both, rest), "test_")


def _contributions_to_cycles(
    test: ReducedTest,
    part: ReducedTest,
    index: int,
    errors: InstrumentErrors,
    cycles: CycleSettings,
    pull: SlowPull | None,
    origin: PullOrigin | None,
) -> Contributions:
    """Quantities of each cycle in part of a test; those of its line where it has one."""
    if part.loops is None or part.cycles is None or test.cycles is None:
        return Contributions(())
    model = test.strain_models[index]
    of_loop = _of_loops(part.loops, index, errors, model, part.cycles, cycles, test.record)
    parts = [of_loop]
    if part.end_moduli is not None:
        parts += _of_ends(part, index, errors, float(areas_of(test.specimens)[index]))
    line, amplitude = test.line_of_test, test.amplitude
    if part.line is not None and line is not None and amplitude is not None and pull is not None:
        rest = _quasi_static_contributions(
            pull, origin or PullOrigin(errors, model),
            np.asarray(amplitude.mean_tension[index]),
            _of_loops(
                amplitude, index, errors, model, test.cycles, cycles, test.record
            ),
            line, index,
        )  # fmt: skip
        of_both = _of_loops(
            part.loops, index, errors, model, part.cycles, cycles, test.record, line=part.line
        )
        parts.append(_of_line(part.line, part.loops, index, of_both, rest))
    return merged(parts)


def _named(found: Contributions, prefix: str, *, left_out: Sequence[str] = ()) -> Contributions:
    names = [name for name in found.values if name not in left_out]
    return renamed(found, {name: f"{prefix}{name}" for name in names})
