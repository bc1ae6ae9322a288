"""Reduction of one test: from its located record to strain, cycles, moduli, holds and notes.

Beforehand, for every test of a campaign, `reduction.pipeline.located_test` finds where the
crosshead stands still and where it cycles and measures the tension at the
splice marks there, and `reduction.batch.test_history` pools the marks of a specimen into strain
models.
`reduce_test` does the rest; results of the cycles and of the first rise are computed in
`reduction.pipeline.cyclic_test`.  `reduce_stepwise_test` is for tests read by
a person.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from reduction.pipeline.cyclic_test import (
    notes_on_jumps,
    parts_of_cycles,
    parts_of_first_loading,
)
from reduction.pipeline.located_test import (
    HELD,
    PULLED,
    Located,
    flagged_record,
    parts_of_stress,
    strain_of_record,
)
from reduction.pipeline.rope_test import PullConditions, parts_of_line, pull_specimens, rope_step
from reduction.quantities.flags import PHASE_VALUES
from reduction.record.arrays import finite_median
from reduction.record.contributions import (
    Component,
    Contributions,
    InstrumentErrors,
    merged,
    stacked,
)
from reduction.record.errors import DataError, SettingsError
from reduction.record.measurement import (
    Floats,
    Integers,
    Record,
    Source,
    Specimen,
    Step,
    StepReadings,
)
from reduction.record.notes import Note, note
from reduction.record.samples import (
    count_samples,
    finite_extremes,
    over_intervals,
    take_samples,
    thinned,
)
from reduction.record.settings import Control, CycleSettings, ReductionSettings, Waveform
from reduction.stages.channel_lag import delay_of_extensometer
from reduction.stages.cycles.cycle_product import Cycles, Loops
from reduction.stages.cycles.cycle_search import control_channel, label_phases
from reduction.stages.cycles.loop_sense import (
    OPEN,
    change_of_wave,
    missed_between_changes,
    notes_of_loops,
    unlike_neighbours,
    waveform_of_log,
)
from reduction.stages.cycles.periods import change_of_period
from reduction.stages.cycles.reading_noise import vibration_beside_wave
from reduction.stages.holds.hold_product import HoldResult
from reduction.stages.holds.relaxation_and_creep import reduce_holds
from reduction.stages.moduli.cycle_alignment import CLEAR_JUMP, jump_at_stop
from reduction.stages.moduli.modulus_product import ModulusCurves
from reduction.stages.moduli.slack_length import slack_strain_at_unloading
from reduction.stages.moduli.stepwise_test import reduce_stepwise
from reduction.stages.reduced_test import History, ReducedTest, TestDescription
from reduction.stages.standstills import Standstills, median_step
from reduction.stages.strain.strain_model import StrainModel, strain_by_model
from reduction.stages.strain.stress import check_constant_volume
from reduction.stages.three_parameter_line.line_product import SlowPull
from reduction.uncertainty.effects_on_answers import (
    load_train_notes,
    splice_friction_notes,
    splice_slip_notes,
    with_weighed_notes,
)
from reduction.uncertainty.error_field import error_field
from reduction.uncertainty.errors_of_curves import with_shared_ratios
from reduction.uncertainty.errors_of_cycles import (
    PullOrigin,
    with_drift_not_placed,
    with_shared_steps,
    with_splice_slips,
)
from reduction.uncertainty.monte_carlo import with_line_spread
from reduction.uncertainty.propagation import with_diameter
from reduction.uncertainty.shared_contributions import (
    contributions_of_test,
    lag_of_test,
    shared_uncertainty_of_cycles,
)

_GREATEST_STRAIN = 10.0  # no rubber is stretched to eleven times its length

_TRIANGULAR_SHARE = 0.6  # of samples at a constant rate; a sine has half of them

_MOST_DRIFT = 0.2  # of the range of a cycle: a rope that creeps drifts by a hundredth

_FEW_FAR = 0.25  # of the cycles

# of the slack level used without a reading at slack: allowance for readings of a line at speed
_BEYOND_REST = 0.25

_FEWEST_SAMPLES = 10  # of a branch: in a shorter one its two ends are a large part


def _plausibility_notes(
    strain: Floats,
    *,
    specimens: tuple[Specimen, ...],
    slack_tensions: Sequence[float],
    waveform: Waveform,
    cycles: Cycles | None,
    loops: Loops | None,
    curves: ModulusCurves | None,
    is_snap: bool = False,
    is_bedding: bool = False,
) -> tuple[Note, ...]:
    """Name implausible signs, units of position, slack or drift in cycles, and waveforms."""
    notes = []
    greatest = [finite_extremes(one)[1] for one in strain]
    for specimen, one in zip(specimens, greatest, strict=True):
        if one > _GREATEST_STRAIN:
            notes.append(note("strain-impossible", specimen.name, strain=one))
    if cycles is None or loops is None:
        return tuple(notes)
    for index, specimen in enumerate(specimens):
        name = specimen.name
        slopes = None if curves is None else curves.tangent_modulus[index]
        slack = _taut if is_snap else _slack
        # in a channel of the wrong sign a valley is no evidence of slack
        half_strain = _half_range(strain[index], cycles)
        if waveform != "sinusoidal" and not is_bedding:  # the first cycles leave a rope longer
            notes += _drift(name, loops, index, half_strain, cycles)
        notes += _sign(name, loops, index, slopes) or (
            []
            if specimen.can_push
            else slack(name, loops.valley_tension[index], slack_tensions[index])
        )
    return (*notes, *_waveform(cycles, waveform))


def _tones(
    record: Record, tension: Floats, cycles: Cycles | None, loops: Loops | None, waveform: Waveform
) -> Iterator[Note]:
    """Oscillations of the load beside its wave that are in its extremes; a fundamental has none."""
    if cycles is None or loops is None or waveform == "sinusoidal":
        return
    for row, (name, load) in enumerate(zip(record.specimens, tension, strict=True)):
        frequency, size = vibration_beside_wave(record.time, load, cycles)
        amplitude = finite_median(loops.tension_amplitude[row])
        # it is in the extremes of all cycles alike
        own = finite_median(loops.uncertainty["tension_amplitude"][row]) / np.sqrt(cycles.n_cycles)
        if size > max(_OF_AMPLITUDE * amplitude, _BEYOND * own):
            effect = size / amplitude
            yield note("tension-hums", name, frequency=frequency, size=size, effect=effect)


_OF_AMPLITUDE, _BEYOND = 0.002, 2.0  # of the tension amplitude; standard uncertainties of the mean


def _half_range(strain: Floats, cycles: Cycles) -> Floats:
    """Half the range of strain within each cycle."""
    high, low = (
        over_intervals(extreme, strain, cycles.first, cycles.last) for extreme in (np.fmax, np.fmin)
    )
    return np.asarray((high - low) / 2, dtype=np.float64)


def _drift(name: str, loops: Loops, index: int, half_strain: Floats, cycles: Cycles) -> list[Note]:
    """Cycles whose loop is the small remainder of a drift: half of it was subtracted."""
    half_tension = (loops.peak_tension[index] - loops.valley_tension[index]) / 2
    # a cycle after a break has no load that could drift
    half_strain = np.where(np.isfinite(half_tension), half_strain, np.nan)
    kept = [
        amplitude[index][half > 0] / half[half > 0]
        for amplitude, half in (
            (loops.tension_amplitude, half_tension),
            (loops.strain_amplitude, half_strain),
        )
    ]
    # NaN, where nothing is left, counts as far off
    is_far = max((~(share >= 1 - _MOST_DRIFT / 2) for share in kept), key=np.count_nonzero)
    n_far, n_cycles = int(np.count_nonzero(is_far)), half_tension.size
    if not n_far:
        return []
    found = note("cycles-drift", name, n_far=n_far, n_cycles=n_cycles, limit=_MOST_DRIFT)
    # the ramp before a first cycle makes its drift, which has its own correction and uncertainty
    begins = np.r_[True, cycles.first[1:] != cycles.last[:-1]]
    of_ramps = is_far.size == n_cycles and not (is_far & ~begins).any()
    return [replace(found, severity="note") if of_ramps and n_far <= _FEW_FAR * n_cycles else found]


def _sign(name: str, loops: Loops, index: int, slopes: Floats | None) -> list[Note]:
    """Tension that falls with stretch; where it is negative, the log itself shows the wrong sign.

    Where loops run backward, the loops show which channel is reversed.
    """
    level = finite_median(loops.mean_tension[index])
    slope = np.nan if slopes is None else finite_median(slopes)
    is_backward = finite_median(loops.storage_over_time[index]) < 0
    if level < 0 or not slope <= 0 or is_backward:
        return []
    return [note("sign-of-tension", name, slope=slope)]


_PUSHED = 5.0  # times the slack level, below zero


def _slack_in_cycles(located: Located, settings: ReductionSettings) -> list[float]:
    """Tension at or below which each specimen is slack in its cycles. [N].

    Two hundredths of the peak, unless the log shows the reading of the cell at slack: the tension
    of a hose or soft rope that stiffens is well below that. Half of it where the load turns there
    at once, as a machine that is set to a low load turns a stiff line.
    """
    level = located.standstills.slack_tension
    if settings.phases.slack_tension is not None:
        return [level] * len(located.record.specimens)
    rests = located.load_at_slack or (None,) * len(located.record.specimens)
    levels = [
        level if one is None else min(level, max(one.earlier, one.later) + _BEYOND_REST * level)
        for one in rests
    ]
    if located.cycles is None or not located.cycles.n_cycles:
        return levels
    return [
        one / 2 if _turns_at_once_below(one, load, located.position, located.cycles) else one
        for one, load in zip(levels, located.tension, strict=True)
    ]  # fmt: skip


_AT_A_TURN = 0.01  # of the stroke: the last hundredth at which a load of 2 % of the peak turns

_OF_MEAN_STIFFNESS = 0.25  # that a taut line has at least, at the foot of its curve


def _turns_at_once_below(level: float, load: Floats, position: Floats, cycles: Cycles) -> bool:
    """Whether a specimen pulls at loads below a level, in all cycles.

    It does if the crosshead hardly moves there, or the load falls further as that of a taut line.
    """
    for block in cycles.blocks():
        low, high = int(cycles.first[block.start]), int(cycles.last[block.stop - 1]) + 1
        place, pull = position[low:high], load[low:high]
        at_low_load = np.where(pull <= level, place, np.nan)
        first, stop = cycles.first[block] - low, cycles.last[block] + 1 - low
        least, most = (over_intervals(way, pull, first, stop) for way in (np.fmin, np.fmax))
        moved, stroke = (
            over_intervals(np.fmax, one, first, stop) - over_intervals(np.fmin, one, first, stop)
            for one in (at_low_load, place)
        )
        with np.errstate(divide="ignore", invalid="ignore"):
            fallen = (level - least) / (most - least)
            taut = np.where(least > level / 2, fallen / _OF_MEAN_STIFFNESS, 0.0)
            allowed = np.fmax(_AT_A_TURN, taut)
            if (moved / stroke >= allowed).any():
                return False
    return True


def _slack(name: str, valley_tension: Floats, slack_tension: float) -> list[Note]:
    """Cycles that go slack: below slack, the strain is not that of the specimen."""
    slack = int(np.count_nonzero(valley_tension <= slack_tension))
    if not slack:
        return []
    least = finite_median(valley_tension)
    if least < -_PUSHED * slack_tension:
        return [note("pushed-in-cycles", name, least=least)]
    return [
        note(
            "slack-in-cycles",
            name,
            n_slack=slack,
            n_cycles=valley_tension.size,
            slack_tension=slack_tension,
        )
    ]


def _taut(name: str, valley_tension: Floats, slack_tension: float) -> list[Note]:
    """Cycles without a snap load, in which the line stays taut."""
    taut = int(np.count_nonzero(valley_tension > slack_tension))
    if not taut:
        return []
    return [
        note(
            "no-snap-loads",
            name,
            n_taut=taut,
            n_cycles=valley_tension.size,
            slack_tension=slack_tension,
        )
    ]


def _waveform(cycles: Cycles, waveform: str) -> list[Note]:
    """A triangular test with too small a part at a constant rate."""
    n_samples = cycles.branch_last - cycles.branch_first + 1
    if waveform != "triangular" or np.median(n_samples) < _FEWEST_SAMPLES:
        return []
    share = count_samples(cycles.is_in_trimmed_branch) / int(n_samples.sum())
    return [note("not-triangular", share=share)] if share < _TRIANGULAR_SHARE else []


_TIMES = 10.0  # the greatest reading of a log

_RECORD = 0.25  # of a record without cycles, for a lag

_LINEAR = 0.05  # of a cycle: a loop turned by more than this has lost 5 % of its stiffness


@dataclass(frozen=True)
class _Limit:
    key: str
    stated: float
    most: float
    unit: str
    what: str

    @property
    def channel(self) -> str:
        """Channel whose unit, if wrong, makes the limit too small."""
        return "time" if self.key == "lag" else self.key.partition(".")[0]


def check_stated_errors(
    located: Located, instruments: Sequence[InstrumentErrors], *, place: str
) -> tuple[Note, ...]:
    """Refuse standard uncertainties that a log shows to be impossible; note those too large."""
    for index, errors in enumerate(instruments):
        for limit in _limits(located, index, errors):
            if np.isfinite(limit.most) and limit.stated > limit.most:
                raise SettingsError(
                    f"{place}.{limit.key}: this is not a standard uncertainty for test "
                    f"'{located.record.test_id}'",
                    found=f"{limit.stated:.4g} {limit.unit}",
                    needed=f"at most {limit.most:.4g} {limit.unit}, {limit.what}",
                    hint=f"Correct it, or the unit of {limit.channel} in the layout.",
                )
    notes = list(_not_used(located.record, instruments))
    period = _periods(located)
    lag = max((errors.lag for errors in instruments), default=0.0)
    is_short = lag > _LINEAR * period
    if is_short.any():
        notes.append(note(
            "stated-lag-long", lag=lag, n_short=int(is_short.sum()), n_cycles=period.size,
            shortest=float(period.min()),
        ))  # fmt: skip
    return tuple(notes)


def _not_used(record: Record, instruments: Sequence[InstrumentErrors]) -> Iterator[Note]:
    """Noise and resolution stated for readings for which the layout already declares them."""
    pairs = (
        ("tension", "N", record.tension_standard_uncertainty, "tension_reading"),
        (
            "crosshead_position",
            "m",
            (record.position_standard_uncertainty,) * len(instruments),
            "position_reading",
        ),
    )
    for channel, unit, declared, name in pairs:
        for own, errors in zip(declared, instruments, strict=False):
            stated = getattr(errors, name)
            if np.isfinite(own) and stated > 0:
                yield note(
                    "reading-error-not-used",
                    channel=channel, stated=stated, declared=float(own), unit=unit,
                )  # fmt: skip
                break


def _limits(located: Located, index: int, errors: InstrumentErrors) -> Iterator[_Limit]:
    record, period = located.record, _periods(located)
    tension = _TIMES * _greatest(located.tension[index])
    position = _TIMES * _greatest(located.position)
    of_tension = f"ten times the greatest tension of '{errors.specimen}'"
    of_position = "ten times the greatest position"
    yield _Limit("tension.offset", errors.tension_offset, tension, "N", of_tension)
    yield _Limit("crosshead_position.offset", errors.position_offset, position, "m", of_position)
    # readings as used here; one that the layout declares is not in this table
    declared = (*record.tension_standard_uncertainty, *len(located.tension) * (np.nan,))[index]
    if not np.isfinite(declared):
        yield _Limit(
            "tension.noise and resolution", errors.tension_reading, tension, "N", of_tension
        )
    if not np.isfinite(record.position_standard_uncertainty):
        yield _Limit(
            "crosshead_position.noise and resolution",
            errors.position_reading, position, "m", of_position,
        )  # fmt: skip
    if period.size:
        yield _Limit("lag", errors.lag, float(period.max()), "s", "the longest cycle")
    else:
        first, last = finite_extremes(record.time)
        most = _RECORD * (last - first)
        yield _Limit("lag", errors.lag, most, "s", "a quarter of the record")


def _periods(located: Located) -> Floats:
    """Duration of each cycle; empty where there are none. [s]."""
    time, cycles = located.record.time, located.cycles
    if cycles is None:
        return np.empty(0)
    return np.asarray(take_samples(time, cycles.last) - take_samples(time, cycles.first))


def _greatest(values: Floats) -> float:
    low, high = finite_extremes(values)
    return max(-low, high) if low <= high else float("nan")


_SAMPLES = 4096  # spread over the record: the uncertainty changes slowly with strain


def _readings_of(
    record: Record, instruments: Sequence[InstrumentErrors]
) -> tuple[InstrumentErrors, ...]:
    """Errors with that of one reading of each channel; decides which statement is used."""
    known = instruments or tuple(InstrumentErrors(name) for name in record.specimens)
    tension = record.tension_standard_uncertainty or (np.nan,) * len(known)
    position = record.position_standard_uncertainty
    return tuple(
        replace(
            errors,
            tension_reading=own if np.isfinite(own) else errors.tension_reading,
            position_reading=position if np.isfinite(position) else errors.position_reading,
        )
        for errors, own in zip(known, tension, strict=True)
    )


def _with_late_readings(
    record: Record, instruments: Sequence[InstrumentErrors]
) -> tuple[InstrumentErrors, ...]:
    """Errors with the lag of a channel whose new readings come at an unknown time within a row."""
    steps = [
        one.numbers["step"]
        for one in record.notes
        if one.code in ("read-less-often", "extensometer-late")
    ]
    own = float(np.hypot.reduce(steps)) / np.sqrt(3) if steps else 0.0
    return tuple(replace(errors, lag=float(np.hypot(errors.lag, own))) for errors in instruments)


def _with_late_loads(
    record: Record, instruments: Sequence[InstrumentErrors], late: Sequence[Note]
) -> tuple[InstrumentErrors, ...]:
    """Errors with the delay of a load that lags more than stated, by a filter or a clock."""
    found = dict.fromkeys(record.specimens, 0.0)
    for one in late:
        # damping makes tension lead, so the lag found is a lower bound of the delay
        found[one.subject] = 2 * one.numbers["lag"] + _BEYOND_LAG * one.numbers["spread"]
    known = instruments or tuple(InstrumentErrors(name) for name in found if late)
    return tuple(
        replace(errors, lag=float(np.hypot(errors.lag, own / np.sqrt(3))), smoothed_over=own)
        for errors, own in zip(known, found.values(), strict=False)
    )


def _late_extensometers(
    located: Located,
    models: Sequence[StrainModel],
    strain: Floats,
    instruments: Sequence[InstrumentErrors],
) -> list[Note]:
    """Extensometers that lag the crosshead by more than stated."""
    if located.cycles is None:
        return []
    stated = [one.lag for one in instruments] or [0.0] * len(models)
    delays = [
        delay_of_extensometer(
            located.record.time, located.position, one, load, located.cycles.cycle_number
        )
        if model.method == "extensometer"
        else 0.0
        for model, one, load in zip(models, strain, located.tension, strict=True)
    ]
    return [
        note("extensometer-late", model.specimen, step=delay)
        for model, delay, own in zip(models, delays, stated, strict=True)
        if delay > _BEYOND_LAG * own
    ]


_BEYOND_LAG = 2.0  # stated standard uncertainties


def _with_zero_at_slack(
    located: Located, instruments: Sequence[InstrumentErrors], *, control: Control
) -> tuple[tuple[InstrumentErrors, ...], list[Note]]:
    """Errors with the zero of a load cell uncertain by what the log shows of it, with notes."""
    rests = located.load_at_slack or (None,) * len(instruments)
    found, notes = [], []
    for index, (errors, rest) in enumerate(zip(instruments, rests, strict=False)):
        stated = errors.tension_offset
        moved = 0.0 if rest is None else rest.zero_uncertainty(stated)
        jump = _jump_at_stop(located, index) if control == "position" else None
        if jump is not None and jump[1] ** 2 > max(2 * stated, 3**0.5 * moved) ** 2:
            number, size, explained = jump
            moved = abs(size) / 3**0.5  # of a uniform distribution from zero to the step
            if abs(size) > CLEAR_JUMP * explained:
                name = located.record.specimens[index]
                notes.append(note("zero-moves-at-stop", name, number=number, size=size,
                                  explained=explained))  # fmt: skip
        found.append(replace(errors, tension_offset=float(np.hypot(stated, moved))))
    return tuple(found), notes


def _jump_at_stop(located: Located, index: int) -> tuple[int, float, float] | None:
    """Step of the mean tension of a specimen across a stop between two cycles."""
    cycles, time = located.cycles, located.record.time
    if cycles is None or cycles.n_cycles < 2:
        return None
    ends = np.column_stack([cycles.first, cycles.last]).ravel()[:-1]
    load = located.tension[index][: cycles.last[-1]]
    # a sum over a cycle changes with the reading at which it turns
    middle = (np.maximum.reduceat(load, ends) + np.minimum.reduceat(load, ends))[::2] / 2
    begin, end = (take_samples(time, one) for one in (cycles.first, cycles.last))
    between = zip(cycles.last[:-1].tolist(), cycles.first[1:].tolist(), strict=True)
    is_stop = [
        bool(np.diff(time[last : first + 1]).max(initial=0) < (end[0] - begin[0]) / 2)
        or located.standstills.covers(slice(last, first + 1)).any()
        for last, first in between
    ]
    return jump_at_stop(begin, end, middle, np.array(is_stop, dtype=bool))


def _with_readings(record: Record, readings: Sequence[InstrumentErrors]) -> Record:
    """Record with the standard uncertainty of one reading; NaN where unknown."""
    tension = tuple(one.tension_reading or np.nan for one in readings)
    return replace(
        record,
        tension_standard_uncertainty=tension if np.isfinite(tension).any() else (),
        position_standard_uncertainty=readings[0].position_reading or np.nan,
    )


def _reading_spread(
    located: Located,
    models: Sequence[StrainModel],
    readings: Sequence[InstrumentErrors],
    *,
    phase: NDArray[np.int8],
) -> Floats:
    """Standard uncertainty of strain due to one reading of position and tension. [1]."""
    rows = _rows_of(phase)
    position, tension = take_samples(located.position, rows), take_samples(located.tension, rows)
    found = np.full(len(models), np.nan)
    for index, (model, errors) in enumerate(zip(models, readings, strict=True)):
        if model.method == "extensometer" or not (
            errors.position_reading or errors.tension_reading
        ):
            continue
        parts = []
        for of_position, of_tension in (
            (errors.position_reading, 0.0),
            (0.0, errors.tension_reading),
        ):
            # a step of one standard uncertainty: finite where a law is steep near zero tension
            high, low = (
                strain_by_model(
                    model,
                    position=position + way * of_position,
                    tension=tension[index] + way * of_tension,
                )
                for way in (1, -1)
            )
            parts.append((high - low) / 2)
        found[index] = _rms(np.hypot(*parts))
    return found


def _channel_contributions(
    located: Located,
    strain: Floats,
    models: Sequence[StrainModel],
    specimens: Sequence[Specimen],
    errors: Sequence[InstrumentErrors],
    *,
    phase: NDArray[np.int8],
) -> Contributions:
    """Effect of shared errors on the samples, by archive name of the channel."""
    if not errors:
        return Contributions(())
    rows = _rows_of(phase)
    own = [
        _of_specimen(
            take_samples(located.tension[index], rows),
            take_samples(strain[index], rows),
            model,
            specimen,
            one,
        )
        for index, (model, specimen, one) in enumerate(zip(models, specimens, errors, strict=True))
    ]
    first = errors[0]
    reach = _rms(take_samples(located.position, rows) - first.position_of_scale_zero)
    is_length = located.record.position_is_length
    of_position = _of_channel(
        "crosshead_position" if is_length else "crosshead_displacement",
        {
            Component("position_gain", first.position_instrument): first.position_gain * reach,
            Component("position_offset", first.position_instrument): first.position_offset,
        },
    )
    return merged([stacked(own), of_position])


def _of_specimen(
    tension: Floats,
    strain: Floats,
    model: StrainModel,
    specimen: Specimen,
    errors: InstrumentErrors,
) -> Contributions:
    level = _rms(tension)
    cell = errors.tension_instrument
    of_tension = _of_channel(
        "tension",
        {
            Component("tension_gain", cell): errors.tension_gain * level,
            Component("tension_offset", cell): errors.tension_offset,
        },
    )
    field = error_field(errors, model, strain=strain, tension=tension)
    of_strain = Contributions(
        field.component,
        {"strain": np.array([_signed_rms(row) for row in field.strain]).reshape(-1)},
    )
    if not specimen.has_area:
        return merged([of_tension, of_strain])
    of_stress = Contributions(
        of_tension.component, {"nominal_stress": of_tension.values["tension"] / specimen.area}
    )
    value = {"nominal_stress": np.asarray(level / specimen.area)}
    return merged(
        [of_tension, of_strain, with_diameter(of_stress, errors, value, area=specimen.area)]
    )


def _of_channel(name: str, stated: dict[Component, float]) -> Contributions:
    """Contributions to one channel, without those that are zero."""
    kept = {one: value for one, value in stated.items() if value}
    return Contributions(tuple(kept), {name: np.array(list(kept.values()))})


def _rows_of(phase: NDArray[np.int8]) -> Integers:
    """Cycling samples, or all but rests if none is cycling."""
    cycling, rest = PHASE_VALUES["cycling"], PHASE_VALUES["rest"]
    rows = thinned(lambda part: phase[part] == cycling, phase.size, most=_SAMPLES, samples=(phase,))
    if rows.size:
        return rows
    return thinned(lambda part: phase[part] != rest, phase.size, most=_SAMPLES, samples=(phase,))


def _rms(values: Floats) -> float:
    known = values[np.isfinite(values)]
    return float(np.sqrt(np.mean(known**2))) if known.size else 0.0


def _signed_rms(values: Floats) -> float:
    known = values[np.isfinite(values)]
    return float(np.copysign(_rms(known), known.mean())) if known.size else 0.0


def _notes_of_test(
    located: Located,
    strain: Floats,
    *,
    kind: str,
    specimens: tuple[Specimen, ...],
    settings: ReductionSettings,
    holds: tuple[HoldResult, ...],
    parts: Mapping[str, Any],
    of_stages: Iterable[Note],
    slack_remarks: Sequence[Note | None],
) -> tuple[Note, ...]:
    """Notes that a reader needs before using the numbers, without duplicates."""
    record, standstills = located.record, located.standstills
    notes = [one for specimen in specimens for one in check_constant_volume(specimen)]
    notes += of_stages
    notes += [note("no-diameter", one.name) for one in specimens if not one.has_area]
    if kind in HELD and not holds:
        notes.append(_no_hold(standstills, settings))
    notes += _plausibility_notes(
        strain, specimens=specimens, slack_tensions=_slack_in_cycles(located, settings),
        waveform=settings.cycles.waveform, cycles=located.cycles,
        loops=parts.get("loops"), curves=parts.get("curves"), is_snap=kind == "snap",
        is_bedding=kind == "bedding-in",
    )  # fmt: skip
    notes += [
        replace(one, subject=name)
        for name, one in zip(record.specimens, slack_remarks, strict=True)
        if one
    ]
    return tuple(notes)


def _stage_lines(located: Located, models: Sequence[StrainModel]) -> tuple[Step, ...]:
    """One line a stage, with the numbers that it found."""
    record, standstills, cycles = located.record, located.standstills, located.cycles
    lines = [
        Step("ingest", f"{record.n_rows_read} rows read, {record.n_samples} kept"),
        Step(
            "phases",
            f"standstills: {standstills.n_standstills}, within {standstills.position_tolerance:.4g}"
            " m"
            + (
                ""
                if standstills.tension_tolerance is None
                else f", holds on tension within {standstills.tension_tolerance:.4g} N"
            )
            + f", slack at {standstills.slack_tension:.4g} N"
            + "".join(
                f", load of {name} at slack rests {one.load:.4g} N"
                for name, one in zip(record.specimens, located.load_at_slack, strict=False)
                if one is not None
            ),
        ),
    ]
    for model in models:
        numbers = ", ".join(f"{name} {value:.6g}" for name, value in model.coefficients.items())
        lines.append(Step("strain", f"{model.specimen} by {model.method}: {numbers}"))
    if cycles is not None:
        lines.append(
            Step("cycles", f"{cycles.n_cycles} by {cycles.counted_by}, band {cycles.band:.4g}")
        )
        lines.append(Step("moduli", "regression in a moving window on a strain grid, SI"))
    return tuple(lines)


def _no_hold(standstills: Standstills, settings: ReductionSettings) -> Note:
    """Reason why a test with planned holds has no result of a hold."""
    held = standstills.tension_tolerance
    of_position = ("the crosshead", standstills.position_tolerance, "m", "position_tolerance")
    channel, tolerance, unit, key = (
        of_position if held is None else ("the tension", held, "N", "tension_tolerance")
    )
    return note(
        "no-hold", slack_tension=standstills.slack_tension, channel=channel, tolerance=tolerance,
        unit=unit, duration=settings.phases.minimum_duration, key=key,
    )  # fmt: skip


def _with_waveform_of_log(
    settings: ReductionSettings, located: Located
) -> tuple[ReductionSettings, tuple[Note, ...]]:
    """Treat a wave that is neither a triangle nor a sine as "other", whatever is stated.

    The same applies to a sine whose period changes: its cycles have no common wave.
    """
    cycles = located.cycles
    if cycles is None or not cycles.n_cycles:
        return settings, ()
    time = located.record.time
    driven = control_channel(located.position, located.tension, settings.cycles)
    as_other = replace(settings, cycles=replace(settings.cycles, waveform="other"))
    if waveform_of_log(time, driven, cycles) == "other":
        return as_other, ()
    is_sine = settings.cycles.waveform == "sinusoidal"
    change = change_of_period(time, driven, cycles) if is_sine else 0.0
    if not change:
        return settings, ()
    return as_other, (note("period-changes", share=change),)


def _unlike_waves(
    time: Floats, driven: Floats, cycles: Cycles | None, unlike: float, *, is_sine: bool
) -> tuple[Note, ...]:
    """Waves that differ from cycle to cycle or between parts of the log, or lack their turns."""
    if unlike:
        return (note("wave-not-periodic", share=unlike, is_open=unlike > OPEN),)
    if cycles is None:
        return ()
    if missed := 0.0 if is_sine else missed_between_changes(time, driven, cycles):
        return (note("changes-alone-logged", share=missed),)
    changed = change_of_wave(time, driven, cycles)
    if changed is None:
        return ()
    share, last, first = changed
    number, begin = cycles.number, float(time[cycles.first[first]])
    return (
        note(
            "wave-changes", share=share, last=int(number[last]), first=int(number[first]),
            begin=begin,
        ),
    )  # fmt: skip


def reduce_test(
    located: Located,
    *,
    description: TestDescription,
    specimens: tuple[Specimen, ...],
    models: Sequence[StrainModel],
    history: History | None,
    sources: tuple[Source, ...],
    settings: ReductionSettings,
    settings_json: str,
    pulls: Sequence[SlowPull | None] | None = None,
    pull_origins: Sequence[PullOrigin | None] = (),
    pull_conditions: PullConditions | None = None,
    instruments: Sequence[InstrumentErrors] = (),
) -> ReducedTest:
    """Reduce one located test."""
    record, standstills, cycles = located.record, located.standstills, located.cycles
    position, tension = located.position, located.tension
    settings, of_wave = _with_waveform_of_log(settings, located)
    is_sine = settings.cycles.waveform == "sinusoidal"
    driven = control_channel(position, tension, settings.cycles)
    unlike = 0.0 if cycles is None else unlike_neighbours(record.time, driven, cycles, standstills)
    phase = label_phases(record.time, standstills=standstills, cycles=cycles)
    strain = strain_of_record(record, position, tension, models)
    late = _late_extensometers(located, models, strain, instruments)
    record = replace(record, notes=(*record.notes, *late))
    located = replace(located, record=record)
    drifting, of_zero = _with_zero_at_slack(located, instruments, control=settings.cycles.control)
    instruments = _with_late_readings(record, drifting)
    lag, lag_notes = (
        (None, [])
        if cycles is None
        else lag_of_test(
            record, position, tension, cycles,
            standstills=standstills, stated=[one.lag for one in instruments],
        )
    )  # fmt: skip
    instruments = _with_late_loads(record, instruments, lag_notes)
    readings = _readings_of(record, instruments)
    stated = replace(located, record=_with_readings(record, readings))
    cycle_parts = parts_of_cycles(
        located, strain, tension, specimens=specimens, history=history, settings=settings,
        lag=[one.lag for one in instruments] or [0.0] * len(specimens), is_open=unlike > OPEN,
    )  # fmt: skip
    of_first_rise, first_rise_notes = parts_of_first_loading(
        located, strain, tension, specimens, settings, history, kind=description.kind,
    )  # fmt: skip
    of_line = (
        parts_of_line(
            cycle_parts["loops"], pulls, settings.cycles,
            strain=strain, tension=tension, cycles=cycles,
        )
        if pulls is not None and "loops" in cycle_parts and cycles is not None
        else {}
    )  # fmt: skip
    of_pulls, refused_pulls = (
        pull_specimens(
            located, strain, tension, pull_conditions or PullConditions(), models=models,
        )
        if description.kind in PULLED
        else ((), ())
    )  # fmt: skip
    holds = reduce_holds(
        record.time, position, tension, strain, standstills,
        specimens=record.specimens, settings=settings.holds,
        kind="relaxation" if standstills.tension_tolerance is None else "creep",
        at_slack=located.load_at_slack,
    )  # fmt: skip
    slack_strain = slack_strain_at_unloading(
        position,
        tension,
        slack_tension=standstills.slack_tension,
        relaxed_free_length=np.array([model.relaxed_length for model in models]),
        time=record.time,
    )
    loop_notes = (
        (
            *of_wave,
            *of_zero,
            *_unlike_waves(record.time, driven, cycles, unlike, is_sine=is_sine),
            *notes_of_loops(
                cycle_parts["loops"], names=record.specimens, time_step=median_step(record.time),
                lag=[one.lag for one in instruments] or [0.0] * len(specimens),
                is_sinusoidal=is_sine,
            ),
            *_tones(record, tension, cycles, cycle_parts["loops"], settings.cycles.waveform),
            *notes_on_jumps(
                cycle_parts["loops"], record.specimens,
                break_in=settings.cycles.break_in_cycles,
                number=None if located.cycles is None else located.cycles.number,
            ),
        )
        if "loops" in cycle_parts
        else ()
    )  # fmt: skip
    notes = _notes_of_test(
        located, strain, kind=description.kind, specimens=specimens, settings=settings, holds=holds,
        parts=cycle_parts, of_stages=(*first_rise_notes, *refused_pulls),
        slack_remarks=slack_strain.remarks,
    )  # fmt: skip
    reduced = ReducedTest(
        description=description,
        specimens=specimens,
        record=flagged_record(stated, models),
        sources=sources,
        stage_lines=_stage_lines(located, models),
        settings_json=settings_json,
        notes=(*notes, *lag_notes),
        history=history,
        standstills=standstills,
        phase=phase,
        strain=strain,
        strain_standard_uncertainty=_reading_spread(located, models, readings, phase=phase),
        strain_models=tuple(models),
        cycles=cycles,
        holds=holds,
        pulls=of_pulls,
        channel_lag=lag,
        loop_notes=loop_notes,
        slack_strain=slack_strain,
        rope_step=rope_step(
            located, strain, tension, kind=description.kind, specimens=specimens,
            loops=cycle_parts.get("loops"), holds=holds, failed=description.failed,
            settings=settings.rope,
        ),
        **cycle_parts,
        **of_first_rise,
        **of_line,
        **parts_of_stress(stated.record, specimens),
    )  # fmt: skip
    instruments = with_splice_slips(reduced, instruments)
    shared = _with_shared_errors(
        reduced,
        instruments,
        settings=settings.cycles,
        pulls=pulls,
        pull_origins=pull_origins,
        of_channels=_channel_contributions(
            located, strain, models, specimens, instruments, phase=phase
        ),
    )
    whole = with_weighed_notes(with_line_spread(with_shared_ratios(shared), settings.cycles))
    of_friction = splice_friction_notes(whole, instruments)
    weighed = (*splice_slip_notes(whole), *load_train_notes(whole, instruments), *of_friction)
    return replace(whole, notes=(*whole.notes, *weighed))


def _with_shared_errors(
    test: ReducedTest,
    instruments: Sequence[InstrumentErrors],
    *,
    settings: CycleSettings,
    pulls: Sequence[SlowPull | None] | None,
    pull_origins: Sequence[PullOrigin | None],
    of_channels: Contributions,
) -> ReducedTest:
    """The test with the effect of errors common to all its samples, where these are stated."""
    if not instruments:
        return test
    of_numbers = contributions_of_test(
        test, with_drift_not_placed(test, instruments), cycles=settings, pulls=pulls,
        pull_origins=pull_origins,
    )  # fmt: skip
    whole = merged([of_channels] if of_numbers is None else [of_numbers, of_channels])
    return replace(
        test,
        contributions=whole if whole.component else None,
        shared_uncertainty_of_cycles=shared_uncertainty_of_cycles(
            test, instruments, cycles=settings, pulls=pulls, pull_origins=pull_origins
        ),
    )


def reduce_stepwise_test(
    readings: StepReadings,
    *,
    description: TestDescription,
    specimens: tuple[Specimen, ...],
    history: History | None,
    sources: tuple[Source, ...],
    settings_json: str,
    instruments: Sequence[InstrumentErrors] = (),
) -> ReducedTest:
    """Reduce a stepwise test of one specimen; parameters as in `reduce_test`."""
    if len(specimens) != 1:
        raise DataError(
            f"stepwise test '{description.test_id}' has several specimens",
            found=str(len(specimens)),
            needed="one",
        )
    specimen = specimens[0]
    stepwise = reduce_stepwise(
        readings, area=specimen.area, stated_gauge_length=specimen.gauge_length
    )
    test = ReducedTest(
        description=description,
        specimens=specimens,
        record=None,
        sources=sources,
        stage_lines=(
            Step("ingest", f"{readings.tension.size} readings"),
            Step("moduli", "gauge length recovered, slopes between readings"),
        ),
        settings_json=settings_json,
        notes=check_constant_volume(specimen),
        history=history,
        stepwise=stepwise,
    )
    return with_shared_steps(test, instruments)
