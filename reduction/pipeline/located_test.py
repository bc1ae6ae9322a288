"""Rests, holds and cycles of a test, and its usable samples."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, get_args

import numpy as np
from numpy.typing import NDArray

from reduction.record.arrays import run_blocks
from reduction.record.errors import DataError
from reduction.record.measurement import (
    UNUSABLE,
    Floats,
    LoadTrain,
    Quality,
    Record,
    Specimen,
    SpliceMarks,
    areas_of,
)
from reduction.record.notes import note
from reduction.record.row_counts import ROWS_FLAGGED, notes_on_rows
from reduction.record.samples import (
    copied,
    empty_like,
    finite_extremes,
    first_sample,
    last_sample,
    over_intervals,
    release_pages,
    sample_blocks,
    take_samples,
)
from reduction.record.settings import ReductionSettings
from reduction.stages.cycles.cycle_product import Cycles
from reduction.stages.cycles.cycle_search import find_cycles
from reduction.stages.load_at_slack import LoadAtSlack
from reduction.stages.load_train import without_load_train
from reduction.stages.moduli.loop_balance import cycle_tension_level
from reduction.stages.moduli.modulus_product import Slips
from reduction.stages.moduli.splice_slip import find_slips
from reduction.stages.standstills import (
    Standstills,
    find_standstills,
    find_tension_stands,
    median_step,
)
from reduction.stages.strain.impossible_strain import refuse_impossible_strain
from reduction.stages.strain.mark_readings import MarkReading, measure_mark_tension
from reduction.stages.strain.strain_model import StrainModel, extrapolated, strain_by_model

CYCLIC = ("cyclic", "fatigue", "snap", "bedding-in")

PULLED = ("quasi-static", "tensile")

HELD = ("relaxation", "creep")

_REPEATS = Quality.SATURATED | Quality.STUCK

# of the greatest load: below the first a specimen is slack, above the second taut
_SLACK, _TAUT = 0.05, 0.25

FEWEST_SLACK = 3  # readings

# of the travel, while a load falls from one to the other: for any log, and with few readings
_GIVEN_BACK, _MOST_BACK = 0.05, 0.15

_TOP_SHARE = 0.02  # of the travel: positions within this count as the greatest

_FEW_STEPS = 5  # of the clock: flagged repeats of a load last longer than this


@dataclass(frozen=True)
class Located:
    """A record with its standstills and, where the test has them, its cycles.

    ``position`` (n_samples,) [m] and ``tension`` (n_specimens, n_samples) [N] are those of
    the record, NaN where they are not usable; ``load_at_slack`` is the reading of each load cell at
    the slack rests of its log, by specimen, empty if it was not determined; ``parted`` is the
    sample from which a specimen is slack for good, by specimen, -1 if it is not.
    """

    record: Record
    position: Floats
    tension: Floats
    standstills: Standstills
    cycles: Cycles | None
    load_at_slack: tuple[LoadAtSlack | None, ...] = ()
    parted: tuple[int, ...] = ()


def locate(
    record: Record,
    *,
    kind: str,
    settings: ReductionSettings,
    specimens: tuple[Specimen, ...] | None = None,
) -> Located:
    """Find the standstills and the cycles of a record; only cyclic kinds have cycles.

    With the specimens given, the effects of mass and compliance of the load train are removed.
    """
    if kind not in (*CYCLIC, *PULLED, *HELD):
        raise DataError(
            f"test '{record.test_id}' is of a kind that this version does not reduce",
            found=kind,
            needed="one of " + ", ".join((*CYCLIC, *PULLED, *HELD, "stepwise")),
        )
    position = _without_flagged_samples(
        record.crosshead_position, record.crosshead_position_quality_flag
    )
    if kind == "creep" or (settings.cycles.control == "load" and kind != "relaxation"):
        record, standstills = _held_on_tension(
            record, position, settings, is_held=kind not in CYCLIC
        )
        tension = _without_flagged_samples(record.tension, record.quality_flag)
    else:
        tension = _without_flagged_samples(record.tension, record.quality_flag)
        standstills = find_standstills(
            record.time, position, tension, settings=settings.phases, is_held=kind in HELD
        )
    parted = tuple(_parted_at(position, load) for load in tension)
    standstills = _before_break(standstills, parted)
    if kind in CYCLIC and max(parted) > 0:
        record, tension = _without_parted(record, tension, parted, kind=kind)
    cycles = None
    if kind in CYCLIC:
        cycles = find_cycles(
            record.time,
            position,
            tension,
            standstills,
            settings=settings.cycles,
            cycle_counter=record.cycle_counter,
        )
    if specimens is None or record.load_train == LoadTrain():
        return Located(record, position, tension, standstills, cycles, parted=parted)
    on_tension = standstills.tension_tolerance is not None
    crosshead = position
    record, position, tension = without_load_train(
        record, position, tension, standstills=standstills, cycles=cycles, specimens=specimens,
        parted=parted,
    )  # fmt: skip
    if not on_tension:
        # the crosshead stands still in a hold; slack is a fraction of the tension of the specimen
        standstills = find_standstills(
            record.time, crosshead, tension, settings=settings.phases, is_held=kind in HELD
        )
        standstills = _before_break(standstills, parted)
    given = (record.load_train.machine_compliance or 0.0) * standstills.mean_tension.sum(axis=0)
    standstills = replace(standstills, mean_position=standstills.mean_position - given)
    return Located(record, position, tension, standstills, cycles, parted=parted)


def _parted_at(position: Floats, load: Floats) -> int:
    """First sample from which a specimen is slack for good, after being taut throughout; or -1.

    An unloaded specimen is slack because the crosshead went back.
    """
    peak = finite_extremes(load)[1]
    if not peak > 0:
        return -1
    n_samples = load.size
    # a taut sample near the end, as in most logs, ends the search in its first block
    last = last_sample(lambda part: load[part] > _SLACK * peak, 0, n_samples, load)
    if last is None or n_samples - 1 - last < FEWEST_SLACK:
        return -1
    after = np.sort(position[last + 1 :][np.isfinite(load[last + 1 :])])
    after = after[np.isfinite(after)]
    low, high = finite_extremes(position[: last + 1])
    taut = last_sample(lambda part: load[part] > _TAUT * peak, 0, last + 1, load)
    if after.size < FEWEST_SLACK or taut is None:
        return -1
    # a line that is let slack goes back first, and more so if it has yielded; one that breaks
    # on the way back goes slack within a reading
    travel = high - low
    top = high - _TOP_SHARE * travel
    reading = abs(float(position[taut] - position[taut - 1])) if taut > 0 else 0.0
    allowed = max(_GIVEN_BACK * travel, min(1.5 * reading, _MOST_BACK * travel))
    # it may break where the log has a gap, and the machine runs on to the top without it
    if after[-FEWEST_SLACK] < top and not position[taut] - position[last + 1] < allowed:
        return -1
    least = min(after[-FEWEST_SLACK], top)
    is_slack_there = first_sample(
        lambda part: (position[part] >= least) & (load[part] < _TAUT * peak), 0, last + 1,
        position, load,
    )  # fmt: skip
    was_there = first_sample(lambda part: position[part] >= least, 0, last + 1, position)
    if was_there is None:
        return -1
    # the load falls over some readings, the first of which may still be above
    fell_over = is_slack_there is not None and last + 1 - is_slack_there <= FEWEST_SLACK
    return last + 1 if is_slack_there is None or fell_over else -1


def _before_break(standstills: Standstills, parted: Sequence[int]) -> Standstills:
    """Leave out standstills after all specimens parted: no rest there is a slack length."""
    if min(parted) < 0:
        return standstills
    before = standstills.first < max(parted)
    return replace(
        standstills,
        **{
            name: getattr(standstills, name)[..., before]
            for name in ("first", "last", "start_time", "end_time", "mean_position",
                         "mean_tension", "is_rest")
        },
    )  # fmt: skip


def _without_parted(
    record: Record, tension: Floats, parted: Sequence[int], *, kind: str
) -> tuple[Record, Floats]:
    """Leave out readings of a load cell after its specimen parted, with a note."""
    tension = copied(tension)
    code = "specimen-parted" if kind in ("cyclic", "bedding-in") else "specimen-parted-as-meant"
    told = []
    for row, (name, sample) in enumerate(zip(record.specimens, parted, strict=True)):
        if sample > 0:
            tension[row, sample:] = np.nan
            told.append(note(code, name, time=float(record.time[sample])))
    return replace(record, notes=(*record.notes, *told)), tension


def slips_of(located: Located, settings: ReductionSettings) -> Slips | None:
    """Slips of the splices; None for a test without cycles in which to find them."""
    cycles = located.cycles
    if cycles is None or cycles.n_cycles < settings.slip.minimum_cycles:
        return None
    level, slope = cycle_tension_level(
        located.position, located.tension, cycle_number=cycles.cycle_number, branch=cycles.branch,
        n_cycles=cycles.n_cycles,
    )  # fmt: skip
    peaks = [
        over_intervals(np.fmax, load, cycles.first, cycles.last + 1) for load in located.tension
    ]
    # the cycle in which a specimen parts is low, and none after it is its own
    for row, sample in enumerate(located.parted):
        if sample > 0:
            gone = cycles.last >= sample
            level[row, gone] = peaks[row][gone] = np.nan
    begin, end = take_samples(located.record.time, np.stack([cycles.first, cycles.last]))
    # the time of rows does not show the cycles that a machine counted and did not store
    lasts = np.fmax(np.diff(begin), np.diff(cycles.number) * np.median(end - begin))
    return find_slips(
        peaks, specimens=located.record.specimens, settings=settings.slip,
        tension_level=level, tension_slope=slope, time=np.append(0.0, np.cumsum(lasts)),
    )  # fmt: skip


def _held_on_tension(
    record: Record, position: Floats, settings: ReductionSettings, *, is_held: bool
) -> tuple[Record, Standstills]:
    """Holds at constant tension, in which a load that repeats one value is not a fault."""
    repeats = _without_flagged_samples(record.tension, record.quality_flag, but=_REPEATS)
    standstills = stands = find_tension_stands(
        record.time, position, repeats, settings=settings.phases, is_held=is_held
    )
    if settings.cycles.waveform == "other":  # it may rest for less than the duration of a hold
        few = _FEW_STEPS * median_step(record.time)
        if few < settings.phases.minimum_duration:
            shorter = replace(settings.phases, minimum_duration=few)
            stands = find_tension_stands(record.time, position, repeats, settings=shorter)
    flags, freed = copied(record.quality_flag), 0
    for first, last, is_rest in zip(stands.first, stands.last, stands.is_rest, strict=True):
        is_held_here = not is_rest and (
            record.time[last] - record.time[first] >= settings.phases.minimum_duration
            or _goes_on(position[first : last + 1])
        )
        of_hold = flags[:, first : last + 1]
        for part in sample_blocks(of_hold.shape[1] if is_held_here else 0, flags):
            freed += int(np.count_nonzero(of_hold[:, part] & _REPEATS))
            of_hold[:, part] &= ~np.uint16(_REPEATS)
    if not freed:
        return record, standstills
    record = replace(record, quality_flag=flags)
    told = [one for one in record.notes if one.code not in ROWS_FLAGGED]
    notes = (*told, *notes_on_rows(record), note("held-load-repeats", n_samples=freed))
    return replace(record, notes=notes), standstills


def _goes_on(position: Floats) -> bool:
    """Whether a crosshead creeps on, instead of turning at a peak that a load cell cannot read."""
    low, high = finite_extremes(position)
    return bool(abs(position[-1] - position[0]) > (high - low) / 2)


def _without_flagged_samples(values: Floats, flags: NDArray[np.uint16], *, but: int = 0) -> Floats:
    """A channel with NaN for the samples that must not be used."""
    masks = UNUSABLE & ~np.uint16(but)
    n_samples = values.shape[-1]
    if not any(np.any(flags[..., part] & masks) for part in sample_blocks(n_samples, flags)):
        return values
    kept = empty_like(values)
    for part in sample_blocks(n_samples, values, flags, kept):
        flagged = (flags[..., part] & masks) != 0
        kept[..., part] = np.where(flagged, np.nan, values[..., part])
    return np.asarray(kept)


def strain_of_record(
    record: Record, position: Floats, tension: Floats, models: Sequence[StrainModel]
) -> Floats:
    """Strain of each specimen; NaN where position, or a tension that it needs, is not usable."""
    strain = empty_like(tension)
    measured = record.measured_strain

    def fill(place: tuple[int, slice]) -> None:
        index, part = place
        strain[place] = strain_by_model(
            models[index],
            position=position[part],
            tension=tension[place],
            measured_strain=None if measured is None else measured[place],
        )

    parts = list(sample_blocks(record.n_samples))
    run_blocks(
        fill,
        [(row, part) for row in range(len(models)) for part in parts],
        samples=(position, tension, strain, *(() if measured is None else (measured,))),
    )
    for one, model in zip(strain, models, strict=True):
        refuse_impossible_strain(one, specimen=model.specimen, test_id=record.test_id)
    return strain


def parts_of_stress(record: Record, specimens: tuple[Specimen, ...]) -> dict[str, Any]:
    """Uncertainty of one reading of nominal stress, by field of `ReducedTest`."""
    spread = record.tension_standard_uncertainty
    if not spread or not any(specimen.has_area for specimen in specimens):
        return {}
    return {"nominal_stress_standard_uncertainty": np.array(spread) / areas_of(specimens)}


def flagged_record(located: Located, models: Sequence[StrainModel]) -> Record:
    """The record with the flags that only cycles and strain models can set."""
    record, cycles = located.record, located.cycles
    position, tension = record.crosshead_position, record.tension
    flags = copied(record.quality_flag)
    of_position = copied(record.crosshead_position_quality_flag)
    for part in sample_blocks(record.n_samples, position, tension, flags, of_position):
        for index, model in enumerate(models):
            outside = extrapolated(model, position[part], tension[index, part])
            flags[index, part][outside] |= np.uint16(Quality.EXTRAPOLATED)
        if cycles is not None:
            uneven = (cycles.cycle_number[part] > 0) & ~cycles.is_in_trimmed_branch[part]
            flags[:, part][:, uneven] |= np.uint16(Quality.NOT_CONSTANT_RATE)
            of_position[part][uneven] |= np.uint16(Quality.NOT_CONSTANT_RATE)
            release_pages(cycles.cycle_number, cycles.is_in_trimmed_branch)
    return replace(record, quality_flag=flags, crosshead_position_quality_flag=of_position)


def tension_at_marks(
    located: Located, marks: Mapping[str, SpliceMarks], specimens: Sequence[str], *, log: str
) -> dict[MarkReading, dict[str, Floats]]:
    """Tension of each specimen while each of its marks was read."""
    in_log = {
        name: tension
        for name, tension in zip(specimens, located.tension, strict=True)
        if name in marks and log in marks[name].test
    }

    def measured(reading: MarkReading) -> dict[str, Floats]:
        return {
            name: measure_mark_tension(
                marks[name],
                test_id=log,
                standstills=located.standstills,
                tension=tension,
                reading=reading,
            )
            for name, tension in in_log.items()
        }

    return {one: measured(one) for one in get_args(MarkReading)}
