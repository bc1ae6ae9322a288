"""Results against what is plausible, and against the stated limits of the instruments.

A reading has an error of its own, which no other sample shares; a load cell's gain and zero, a
crosshead's, the tape and the diameter are in every sample of the test.  The two are kept apart, as
in every number of a product.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from reduction.pipeline.located_test import Located
from reduction.quantities.names import PHASE_VALUES
from reduction.record.contributions import (
    Component,
    Contributions,
    InstrumentErrors,
    merged,
    stacked,
)
from reduction.record.errors import SettingsError
from reduction.record.measurement import Floats, Integers, Record, Specimen
from reduction.record.notes import Note, note
from reduction.record.samples import (
    count_samples,
    finite_extremes,
    over_intervals,
    take_samples,
    thinned,
)
from reduction.stages.cycles.cycle_product import Cycles, Loops
from reduction.stages.moduli.modulus_product import ModulusCurves
from reduction.stages.strain.strain_model import StrainModel, strain_by_model
from reduction.uncertainty.error_field import error_field
from reduction.uncertainty.propagation import with_diameter

_GREATEST_STRAIN = 10.0  # no rubber is stretched to eleven times its length

# a sine logged thirteen times a cycle misses 1.5 % of its range, a triangle has 23 % more
_OFF_THE_SINE = 0.05

_TRIANGULAR_SHARE = 0.6  # of samples at a constant rate; a sine has a half

_MOST_DRIFT = 0.2  # of the range of a cycle: a rope that creeps drifts by a hundredth

_FEWEST_SAMPLES = 10  # of a branch: below, its two ends are a good part of it


def plausibility_notes(
    strain: Floats,
    *,
    specimens: tuple[str, ...],
    slack_tension: float,
    waveform: Literal["triangular", "sinusoidal", "other"],
    cycles: Cycles | None,
    loops: Loops | None,
    curves: ModulusCurves | None,
    control: Literal["position", "load"] = "position",
    is_snap: bool = False,
) -> tuple[Note, ...]:
    """Name what is hardly so: sign, unit of position, slack or drift in cycles, waveform."""
    notes = []
    greatest = [finite_extremes(one)[1] for one in strain]
    for name, one in zip(specimens, greatest, strict=True):
        if one > _GREATEST_STRAIN:
            notes.append(note("strain-impossible", name, strain=one))
    if cycles is None or loops is None:
        return tuple(notes)
    for index, name in enumerate(specimens):
        slopes = None if curves is None else curves.tangent_modulus[index]
        slack = _taut if is_snap else _slack
        # of a channel of the wrong sign a valley says nothing about slack
        half_strain = _half_range(strain[index], cycles)
        if waveform == "sinusoidal":
            notes += _shape(name, loops, index, half_strain, control)
        else:
            notes += _drift(name, loops, index, half_strain)
        notes += _sign(name, loops.mean_tension[index], slopes) or slack(
            name, loops.valley_tension[index], slack_tension
        )
    return (*notes, *_waveform(cycles, waveform))


def _half_range(strain: Floats, cycles: Cycles) -> Floats:
    """Half the range of strain within each cycle."""
    high, low = (
        over_intervals(extreme, strain, cycles.first, cycles.last) for extreme in (np.fmax, np.fmin)
    )
    return np.asarray((high - low) / 2, dtype=np.float64)


def _shape(name: str, loops: Loops, index: int, half_strain: Floats, control: str) -> list[Note]:
    """A sinusoidal test whose range is not that of its fundamental, from which numbers come."""
    half_tension = (loops.peak_tension[index] - loops.valley_tension[index]) / 2
    of_strain = _median(half_strain / loops.strain_amplitude[index]) - 1
    of_tension = _median(half_tension / loops.tension_amplitude[index]) - 1
    moved, excess = ("tension", of_tension) if control == "load" else ("strain", of_strain)
    if abs(excess) > _OFF_THE_SINE:
        return [note("not-sinusoidal", name, moved=moved, effect=excess)]
    other, excess = ("strain", of_strain) if control == "load" else ("tension", of_tension)
    if not abs(excess) > _OFF_THE_SINE:
        return []
    return [note("answer-not-sinusoidal", name, moved=moved, other=other, effect=excess)]


def _drift(name: str, loops: Loops, index: int, half_strain: Floats) -> list[Note]:
    """Cycles whose loop is what is left of a drift: half of it has been taken off the range."""
    half_tension = (loops.peak_tension[index] - loops.valley_tension[index]) / 2
    kept = [
        amplitude[index][half > 0] / half[half > 0]
        for amplitude, half in (
            (loops.tension_amplitude, half_tension),
            (loops.strain_amplitude, half_strain),
        )
    ]
    # NaN, where nothing is left, is no comparison either
    n_far = max(int(np.count_nonzero(~(share >= 1 - _MOST_DRIFT / 2))) for share in kept)
    if not n_far:
        return []
    n_cycles = half_tension.size
    return [note("cycles-drift", name, n_far=n_far, n_cycles=n_cycles, limit=_MOST_DRIFT)]


def _sign(name: str, mean_tension: Floats, slopes: Floats | None) -> list[Note]:
    """Tension that pushes, or falls with stretch."""
    level = _median(mean_tension)
    slope = np.nan if slopes is None else _median(slopes)
    if not (level < 0 or slope <= 0):
        return []
    return [note("sign-of-tension", name, tension=level, slope=slope)]


def _slack(name: str, valley_tension: Floats, slack_tension: float) -> list[Note]:
    """Cycles that go slack: strain below it is no strain of the specimen."""
    slack = int(np.count_nonzero(valley_tension <= slack_tension))
    if not slack:
        return []
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
    """Snap loads that are none: cycles in which the line stays taut."""
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
    """A triangular test of which little runs at a constant rate."""
    n_samples = cycles.branch_last - cycles.branch_first + 1
    if waveform != "triangular" or np.median(n_samples) < _FEWEST_SAMPLES:
        return []
    share = count_samples(cycles.is_constant_rate) / int(n_samples.sum())
    return [note("not-triangular", share=share)] if share < _TRIANGULAR_SHARE else []


def _median(values: Floats) -> float:
    known = values[np.isfinite(values)]
    return float(np.median(known)) if known.size else float("nan")


_TIMES = 10.0  # the greatest reading of a log

_RECORD = 0.25  # of a record without cycles, for a lag

_LINEAR = 0.05  # of a cycle: a loop that is turned by more has lost 5 % of its stiffness


@dataclass(frozen=True)
class _Limit:
    key: str
    stated: float
    most: float
    unit: str
    what: str


def check_stated_errors(
    located: Located, instruments: Sequence[InstrumentErrors], *, place: str
) -> tuple[Note, ...]:
    """Refuse standard uncertainties that a log shows to be impossible; say which are too large."""
    for index, errors in enumerate(instruments):
        for limit in _limits(located, index, errors):
            if np.isfinite(limit.most) and limit.stated > limit.most:
                raise SettingsError(
                    f"{place}.{limit.key}: this is no standard uncertainty for test "
                    f"'{located.record.test_id}'",
                    found=f"{limit.stated:.4g} {limit.unit}",
                    needed=f"at most {limit.most:.4g} {limit.unit}, {limit.what}",
                )
    period = _periods(located)
    lag = max((errors.lag for errors in instruments), default=0.0)
    is_short = lag > _LINEAR * period
    if not is_short.any():
        return ()
    return (
        note(
            "stated-lag-long", lag=lag, n_short=int(is_short.sum()), n_cycles=period.size,
            shortest=float(period.min()),
        ),
    )  # fmt: skip


def _limits(located: Located, index: int, errors: InstrumentErrors) -> Iterator[_Limit]:
    record, period = located.record, _periods(located)
    tension = _TIMES * _greatest(located.tension[index])
    position = _TIMES * _greatest(located.position)
    of_tension = f"ten times the greatest tension of '{errors.specimen}'"
    of_position = "ten times the greatest position"
    yield _Limit("tension.offset", errors.tension_offset, tension, "N", of_tension)
    yield _Limit("crosshead_position.offset", errors.position_offset, position, "m", of_position)
    # readings as they count here; one that the layout declares is not of this table
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
    """How long each cycle lasts; empty where there are none. [s]."""
    time, cycles = located.record.time, located.cycles
    if cycles is None:
        return np.empty(0)
    return np.asarray(take_samples(time, cycles.last) - take_samples(time, cycles.first))


def _greatest(values: Floats) -> float:
    low, high = finite_extremes(values)
    return max(-low, high) if low <= high else float("nan")


_SAMPLES = 4096  # spread over the record: the uncertainty changes slowly with strain


def readings_of(
    record: Record, instruments: Sequence[InstrumentErrors]
) -> tuple[InstrumentErrors, ...]:
    """Errors with that of one reading of each channel: the one rule of which statement counts."""
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


def with_readings(record: Record, readings: Sequence[InstrumentErrors]) -> Record:
    """Record with the standard uncertainty of one reading; NaN where nothing says it."""
    tension = tuple(one.tension_reading or np.nan for one in readings)
    return replace(
        record,
        tension_standard_uncertainty=tension if np.isfinite(tension).any() else (),
        position_standard_uncertainty=readings[0].position_reading or np.nan,
    )


def reading_spread(
    located: Located,
    models: Sequence[StrainModel],
    readings: Sequence[InstrumentErrors],
    *,
    phase: NDArray[np.int8],
) -> Floats:
    """Standard uncertainty of strain by one reading of position and tension. [1]."""
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
            # a step of one standard uncertainty: finite where a law is steep near no tension
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


def channel_contributions(
    located: Located,
    strain: Floats,
    models: Sequence[StrainModel],
    specimens: Sequence[Specimen],
    errors: Sequence[InstrumentErrors],
    *,
    phase: NDArray[np.int8],
) -> Contributions:
    """What shared errors do to the samples, by archive name of the channel."""
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
    reach = _rms(take_samples(located.position, rows))
    first = errors[0]
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
    if not specimen.diameter:
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
    """Cycling samples, or all but rests where none cycles."""
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
