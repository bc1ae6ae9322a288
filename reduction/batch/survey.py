"""First pass over a campaign, which records the contents of each log."""

from __future__ import annotations

from collections.abc import Container, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from reduction.batch.campaign_status import Progress, Silent, Status, TestStatus
from reduction.batch.run_lock import RunLock
from reduction.batch.step_detection import FOUND, find_steps, remark_on_cycles
from reduction.batch.workers import Task, Workers, work_on
from reduction.campaign.plan import Campaign, StepPlan, TestPlan, cycles_of_kind
from reduction.pipeline.extremes import Extremes, extremes_of_readings, extremes_of_test
from reduction.pipeline.located_test import (
    CYCLIC,
    FEWEST_SLACK,
    Located,
    locate,
    slips_of,
    tension_at_marks,
)
from reduction.readers.layout import Layout
from reduction.readers.raw_log import unreadable
from reduction.readers.read_log import read_record, read_step_readings
from reduction.readers.record_in_si import length_at_slack, reference_of, zero_to_set
from reduction.record.errors import (
    DataError,
    LogError,
    ReductionError,
    SettingsError,
    refused_by_system,
)
from reduction.record.measurement import Floats, Record, Source, Specimen, StepReadings
from reduction.record.note_sentences import JERKS
from reduction.record.notes import Note, note
from reduction.record.row_counts import ROWS_FLAGGED, count_rows, notes_on_rows
from reduction.record.samples import finite_extremes
from reduction.stages.load_at_slack import (
    load_at_slack,
    notes_on_zero,
    pulls_as_at_reference,
    rises_with_stretch,
    stands_at_slack_length,
)
from reduction.stages.moduli.cycle_alignment import jump_of_mean, time_with_hidden
from reduction.stages.standstills import median_step
from reduction.stages.strain.mark_readings import MarkReading
from reduction.stages.strain.tape_and_crosshead import (
    TAPE_UNCERTAINTY,
    check_tape_against_crosshead,
)
from reduction.stages.strain.zero_strain import (
    ZeroStrain,
    half_band_of,
    jumps_of_length,
    zero_at_slack,
    zero_at_start,
    zero_at_tension,
    zero_before_a_move,
    zero_of_bent,
)
from reduction.stages.test_levels import TestLevels, levels_of_test
from reduction.stages.three_parameter_line.rope_programme import tensile_pull


def _log_summary(located: Located) -> dict[str, Any]:
    """Rate, gaps, standstills, load at slack, flags and notes of a record."""
    record = located.record
    n_flagged = count_rows(record).n_flagged
    return {
        "rate": {"value": 1 / median_step(record.time), "unit": "Hz"},
        "gaps": int(n_flagged.get("crosshead_position", {}).get("gap", 0)),
        "standstills": located.standstills.n_standstills,
        "load_at_slack": {
            name: None if one is None else {"value": one.load, "unit": "N"}
            for name, one in zip(record.specimens, located.load_at_slack, strict=False)
        },
        "flags": {channel: masks for channel, masks in n_flagged.items() if masks},
        "notes": [
            *map(str, record.notes),
            *(() if located.cycles is None else map(str, located.cycles.notes)),
        ],
    }


def _slice(record: Record, first: int, stop: int) -> Record:
    """The rows from ``first`` up to ``stop`` as a separate record."""
    part = slice(first, stop)
    own = replace(
        record,
        time=record.time[part],
        crosshead_position=record.crosshead_position[part],
        tension=record.tension[:, part],
        quality_flag=record.quality_flag[:, part],
        crosshead_position_quality_flag=record.crosshead_position_quality_flag[part],
        measured_strain=None if record.measured_strain is None else record.measured_strain[:, part],
        fill_pressure=None if record.fill_pressure is None else record.fill_pressure[:, part],
        cycle_counter=None if record.cycle_counter is None else record.cycle_counter[part],
        n_rows_read=stop - first,
    )
    of_log = [one for one in record.notes if one.code not in ROWS_FLAGGED]
    return replace(own, notes=(*of_log, *notes_on_rows(own)))


_OF_STEP = 0.01  # an end behind that of the log or of the next step by less is rounded


def _step_record(record: Record, step: StepPlan, plan: TestPlan) -> Record:
    """The rows of one step of a log."""
    if step.time_range is not None:
        low, high = step.time_range
        inside = np.flatnonzero((record.time >= low) & (record.time <= high))
        if inside.size == 0:
            raise DataError(
                f"step '{step.name}' of test '{plan.id}' contains no row of the log",
                found=f"{record.time[0]:g} to {record.time[-1]:g} s in the log",
                needed=f"rows from {low:g} to {high:g} s",
            )
        part = _slice(record, int(inside[0]), int(inside[-1]) + 1)
        end = float(record.time[-1])
        least = max(_OF_STEP * (high - low), 2 * median_step(record.time))
        notes = [
            note("steps-overlap", other=other.name)
            for other in plan.steps
            if other.time_range is not None
            and other.name != step.name
            and min(high, other.time_range[1]) - max(low, other.time_range[0]) > least
        ]
        if high - end > least:
            notes.append(note("log-ends-in-step", end=end, stated=high))
        return replace(part, notes=(*part.notes, *notes))
    whole = locate(record, kind="cyclic", settings=plan.settings)
    first, last = step.cycle_range or (1, 1)
    if whole.cycles is None or not 1 <= first <= last <= whole.cycles.n_cycles:
        raise DataError(
            f"step '{step.name}' of test '{plan.id}' asks for cycles that are not in the log",
            found=f"cycles {first} to {last}",
            needed=f"1 to {0 if whole.cycles is None else whole.cycles.n_cycles}",
        )
    return _slice(record, int(whole.cycles.first[first - 1]), int(whole.cycles.last[last - 1]) + 1)


def _step_plan(plan: TestPlan, step: StepPlan, place: int) -> TestPlan:
    """The plan of one step in the form of a test plan."""
    cycles = replace(
        plan.settings.cycles, expected_cycles=step.expected_cycles, waveform=plan.waveform
    )
    note = {"step": step.name} | ({"step_note": step.note} if step.note else {})
    return replace(
        plan,
        id=step.product(plan.id),
        kind=step.kind,
        target_strain=step.target_strain or plan.target_strain,
        settings=replace(plan.settings, cycles=cycles_of_kind(cycles, step.kind)),
        attributes=plan.attributes | note,
        step_place=place,
        step_range=step.time_range or step.cycle_range,
        failed=step.failed,
        steps=(),
    )


@dataclass(frozen=True)
class SpliceSlip:
    """One slip of the splices: time of the first cycle after it [s], and length let out [m]."""

    time: float
    length: float


@dataclass
class Survey:
    """One test after the first pass.

    ``mark_tension`` holds, by time of reading and by specimen, one tension [N] for each pooled
    mark read in this test, in the order of the marks; ``mark_errors`` holds the marks that the
    crosshead contradicts.  ``zero_strain`` is the position of zero strain, by specimen, and
    ``reference_length`` [m] the length at displacement zero, if stated.  ``extremes`` is the
    range covered by the test and ``levels`` its operating levels; ``found`` and ``notes`` are
    reported on the log, ``remarks`` on its levels.  ``first_time`` is that of the first row
    [s]; ``broken`` names the specimens that broke, as stated or according to the log of a pull,
    and ``slips`` holds the splice slips by specimen that matter to a later test.
    ``n_cycles_between`` is the number of cycles counted by the machine between those of the
    log.  ``loaded_before`` is, by specimen, the greatest tension [N] in the log before the first
    cycle of a step, if it went back from there, and whether that was before the step.
    """

    plan: TestPlan
    sources: tuple[Source, ...] = ()
    located: Located | None = None
    step_readings: StepReadings | None = None
    n_rows: int = 0
    n_cycles: int = 0
    n_cycles_between: int = 0
    first_time: float = float("nan")
    slips: dict[str, list[SpliceSlip]] = field(default_factory=dict)
    mark_tension: dict[MarkReading, dict[str, Floats]] = field(default_factory=dict)
    mark_errors: dict[str, DataError] = field(default_factory=dict)
    zero_strain: dict[str, ZeroStrain] = field(default_factory=dict)
    reference_length: float | None = None
    extremes: Extremes = field(default_factory=Extremes)
    levels: TestLevels | None = None
    broken: frozenset[str] = frozenset()
    loaded_before: dict[str, tuple[float, bool]] = field(default_factory=dict)
    found: dict[str, Any] = field(default_factory=dict)
    remarks: tuple[Note, ...] = ()
    notes: tuple[Note, ...] = ()
    error: ReductionError | None = None


def _read_test(campaign: Campaign, plan: TestPlan) -> list[Survey]:
    """Read one log and locate its contents: one survey per test, or one per step."""
    files = [(campaign.file(name), campaign.layouts[layout], name) for name, layout in plan.files]
    if plan.kind == "stepwise":
        readings, sources = read_step_readings(files, test_id=plan.id, limits=campaign.limits)
        name = plan.specimens[0]  # weights hang from one specimen
        extremes = extremes_of_readings(
            readings, name, stated_gauge_length=campaign.specimens[name].gauge_length
        )
        return [
            Survey(
                plan,
                sources,
                step_readings=readings,
                n_rows=readings.time.size,
                extremes=extremes,
            )
        ]
    record, sources = read_record(
        files,
        test_id=plan.id,
        specimens=plan.specimens,
        quality=plan.settings.quality,
        length_needed=_needs_length(campaign, plan),
        limits=campaign.limits,
    )
    found = None
    if not plan.steps:
        located = locate(
            record, kind=plan.kind, settings=plan.settings, specimens=_specimens(campaign, plan)
        )
        found = find_steps(plan, located, campaign)
        remarks = () if found.remark is None else (found.remark,)
        record = replace(record, notes=(*record.notes, *remarks))
        if not found.steps:
            told = replace(located.record, notes=(*located.record.notes, *remarks))
            located = replace(located, record=told)
            located = _with_load_at_slack(located, located, campaign, plan)
            survey = _located(plan, located, sources)
            survey.remarks = remarks
            survey.loaded_before = _loaded_before(located, located)
            _find_zero_strain(survey, located, campaign, plan)
            _measure_marks(survey, located, campaign)
            return [survey]
        plan = replace(plan, steps=found.steps, attributes=plan.attributes | FOUND)
    # marks and the position of zero strain belong to the whole log, not to a step; it is located as
    # a pull, which has no cycles to search for
    whole = locate(
        record, kind="quasi-static", settings=plan.settings, specimens=_specimens(campaign, plan)
    )
    surveys: list[Survey] = []
    slipped: list[tuple[float, Note]] = []
    for place, step in enumerate(plan.steps, start=1):
        part = _step_plan(plan, step, place)
        try:
            record_of_step = replace(_step_record(record, step, plan), test_id=part.id)
            located = locate(
                record_of_step,
                kind=part.kind,
                settings=part.settings,
                specimens=_specimens(campaign, plan),
            )
            begin = located.record.time[0]
            located = _with_load_at_slack(
                located, whole, campaign, plan,
                earlier=[told for when, told in slipped if when < begin],
            )  # fmt: skip
            slipped += _slips_of_step(located, part)
            remark = remark_on_cycles(part, located) if found is None else found.remark
            remarks = () if remark is None else (remark,)
            if found is None:
                told = replace(located.record, notes=(*located.record.notes, *remarks))
                located = replace(located, record=told)
            survey = _located(part, located, sources)
            survey.remarks = remarks
            survey.loaded_before = _loaded_before(whole, located)
        except ReductionError as error:
            survey = Survey(part, sources, n_rows=record.n_samples, error=error)
        _find_zero_strain(survey, whole, campaign, plan)
        surveys.append(survey)
    _measure_marks(surveys[0], whole, campaign)
    return surveys


_WENT_BACK = 0.1  # of the greatest tension of a step


def _loaded_before(whole: Located, step: Located) -> dict[str, tuple[float, bool]]:
    """Greatest tension [N] in the log before the first cycle of a step, by specimen.

    Of specimens whose load went back from there; with whether that was before the step.
    """
    time, begin = whole.record.time, step.record.time
    found = {}
    for name, loads, own in zip(whole.record.specimens, whole.tension, step.tension, strict=True):
        _, top = finite_extremes(own)
        firsts = [0] if step.cycles is None else [0, int(step.cycles.first[0])]
        for first in firsts:
            _, peak = finite_extremes(loads[: np.searchsorted(time, begin[first])])
            level = own[first:][np.isfinite(own[first:])][:1].sum()
            if peak > level + _WENT_BACK * top:
                found[name] = (peak, first == 0)
                break
    return found


def _layouts(campaign: Campaign, plan: TestPlan) -> list[Layout]:
    return [campaign.layouts[layout] for _, layout in plan.files]


def _find_zero_strain(survey: Survey, located: Located, campaign: Campaign, plan: TestPlan) -> None:
    """Set the zero of strain for each specimen, and whether that is a position in the log."""
    layouts = _layouts(campaign, plan)
    is_length = located.record.position_is_length
    length, tension_of_layout = reference_of(layouts)
    survey.reference_length = length
    at_slack = zero_at_slack(
        located.standstills,
        located.position,
        located.tension,
        position_is_length=is_length,
        length_at_slack=length_at_slack(layouts),
    )
    if not at_slack.is_logged and plan.kind not in CYCLIC:
        slack = located.standstills.slack_tension
        start = zero_at_start(
            located.position, located.tension, slack_tension=slack, stated=at_slack.position
        )
        at_slack = start or at_slack
        if located.standstills.is_rest.any():  # shows how far the specimen is slack
            at_slack = replace(at_slack, stated_position=None)
    has_marks = any(name in campaign.marks for name in plan.specimens)
    if at_slack.position is None and not (has_marks or _is_measured(located, campaign, plan)):
        start = zero_before_a_move(
            located.record.time, located.position, located.tension,
            slack_tension=located.standstills.slack_tension,
            minimum_duration=plan.settings.phases.minimum_duration,
        )  # fmt: skip
        at_slack = start or at_slack
    for name, tension in zip(plan.specimens, located.tension, strict=True):
        reference = campaign.specimens[name].reference_tension or tension_of_layout
        if not reference:
            gauge = campaign.specimens[name].gauge_length
            survey.zero_strain[name] = (
                zero_of_bent(at_slack, located.position, tension, gauge_length=gauge)
                if is_length and gauge
                else at_slack
            )
            continue
        survey.zero_strain[name] = zero_at_tension(
            located.position,
            tension,
            reference_tension=reference,
            stated_position=length if reference == tension_of_layout else None,
        )


# at the slack length read by tape the crosshead is within this; tension starts beyond it
_AT_SLACK_LENGTH = 4 * TAPE_UNCERTAINTY

# of the maximum load: possible size of a wrong zero; a hold under tension is larger
_LITTLE = 0.1

# the same for a length read slack by tape, where a stretch within tolerance pulls little
_LITTLE_BY_TAPE = 0.5

_SHORT = 0.01  # of the slack length: tolerance within which the tension is small


def _with_load_at_slack(
    located: Located,
    whole: Located,
    campaign: Campaign,
    plan: TestPlan,
    *,
    earlier: Sequence[Note] = (),
) -> Located:
    """Add the load-cell readings at the slack rests of the whole log."""
    layouts, stands = _layouts(campaign, plan), whole.standstills
    slack_length, tension_of_layout = length_at_slack(layouts), reference_of(layouts)[1]
    found, zeros = [], []
    stroke = float(np.subtract(*finite_extremes(whole.position)[::-1]))
    for number, (name, tension) in enumerate(zip(plan.specimens, whole.tension, strict=True), 1):
        little = finite_extremes(tension)[1]
        lengths = [] if slack_length is None else [(slack_length, _LITTLE * little)]
        if name in campaign.marks and whole.record.position_is_length:
            tape = campaign.marks[name]
            of_log = np.array([test == plan.log for test in tape.test], dtype=bool)
            lengths += [
                (one, little * (_LITTLE_BY_TAPE if _AT_SLACK_LENGTH < _SHORT * one else _LITTLE))
                for one in tape.far_thimble[of_log & tape.is_slack].tolist()
            ]
        is_slack = stands.is_rest.copy()
        for length, most in lengths:
            near = np.abs(stands.mean_position - length) <= _AT_SLACK_LENGTH
            is_slack |= near & (stands.mean_tension[number - 1] < most)
        can_push = campaign.specimens[name].can_push
        if can_push:  # loaded once, it may stand pushed
            is_low = np.abs(stands.mean_tension[number - 1]) <= stands.slack_tension
            is_slack &= is_low | (stands.first == 0)
        elif rises_with_stretch(whole.position, tension):
            is_slack = stands_at_slack_length(stands, is_slack)
        reference = campaign.specimens[name].reference_tension or tension_of_layout
        if reference:
            is_slack = is_slack & ~pulls_as_at_reference(
                stands, stands.mean_tension[number - 1], reference_tension=reference,
                half=half_band_of(reference, tension),
            )  # fmt: skip
        one = load_at_slack(tension, stands, is_slack, stroke=stroke)
        if one is not None and can_push:
            one = replace(one, drift=0.0)
        found.append(one)
        zeros.append("" if one is None else zero_to_set(layouts, number, one.load))
    notes = [
        one
        for one in notes_on_zero(
            plan.specimens, whole.position, whole.tension, found, zeros,
            offset_uncertainty=campaign.uncertainty.tension_offset,
        )
        if not campaign.specimens[one.subject].can_push
    ]  # fmt: skip
    until = float(located.record.time[-1])
    jumps = _jumps_of_length(whole, campaign, plan, until=until)
    of_record = [
        _doubt_of_step(
            one, plan, until=until, slack_tension=stands.slack_tension, parted=located.parted
        )
        for one in located.record.notes
        # with an extensometer, strain does not depend on the length
        if not (one.code.startswith("reference-length") and _is_measured(whole, campaign, plan))
    ]
    record = replace(located.record, notes=(*notes, *jumps, *earlier, *of_record))
    return replace(located, record=record, load_at_slack=tuple(found))


def _doubt_of_step(
    one: Note, plan: TestPlan, *, until: float, slack_tension: float, parted: Sequence[int]
) -> Note:
    """A step between two loads of a taut specimen is a warning; one to or from slack is told so."""
    step = one.numbers
    if (
        one.code != "channel-steps"
        or step["unit"] != "N"
        or min(step["low"], step["high"]) <= slack_tension
        or step["n_more"] >= JERKS
        or step["time"] > until
        # a load that falls to slack over some readings
        or any(0 < at - step["sample"] <= FEWEST_SLACK for at in parted)
        or plan.kind == "tensile"
        or plan.failed
    ):
        return one
    names = ("channel", "low", "high", "sample", "time")
    return note("load-steps", **{name: step[name] for name in names})


def _is_measured(located: Located, campaign: Campaign, plan: TestPlan) -> bool:
    """Whether strain is measured by extensometers."""
    method = plan.settings.strain.method
    has_marks = any(name in campaign.marks for name in plan.specimens)
    return located.record.measured_strain is not None and (
        method == "extensometer" or (method is None and not has_marks)
    )


def _jumps_of_length(
    whole: Located, campaign: Campaign, plan: TestPlan, *, until: float
) -> list[Note]:
    """Note jumps under load in the length used for strain, up to the end of a test."""
    measured, is_measured = whole.record.measured_strain, _is_measured(whole, campaign, plan)
    found = {}
    for index, (name, tension) in enumerate(zip(plan.specimens, whole.tension, strict=True)):
        if campaign.specimens[name].can_push and not is_measured:
            continue
        length, what, unit = (
            (measured[index], f"the extensometer of {name}", "%")
            if measured is not None and is_measured
            else (whole.position, "crosshead_position", "m")
        )
        slack = whole.standstills.slack_tension
        for time, size in jumps_of_length(whole.record.time, length, tension, slack_tension=slack):
            if time <= until:
                found[what] = note("length-jumps", what=what, size=size, unit=unit, time=time)
                break  # only the first is reported
    return list(found.values())


def _slips_of_step(located: Located, plan: TestPlan) -> list[tuple[float, Note]]:
    """Times of slips between two cycles of a step, with notes for the later steps."""
    cycles, break_in = located.cycles, plan.settings.cycles.break_in_cycles
    if cycles is None or cycles.n_cycles <= break_in + 1:
        return []
    if plan.settings.strain.method == "extensometer":
        return []  # it does not see slip in a grip
    first, last = cycles.first[break_in:], cycles.last[break_in:]
    ends = np.column_stack([first, last]).ravel()[:-1]

    def of_cycles(values: Floats) -> tuple[Floats, Floats]:
        """Mean and half-range of each cycle."""
        sums, most, least = (
            one.reduceat(values[: last[-1]], ends)[::2] for one in (np.add, np.maximum, np.minimum)
        )
        return sums / (last - first), (most - least) / 2

    time, length = located.record.time[first], of_cycles(located.position)
    counted = time_with_hidden(time, cycles.number[break_in:])
    found = []
    for name, tension in zip(plan.specimens, located.tension, strict=True):
        load = of_cycles(tension)
        for what, (mean, half), (other, reach) in (
            ("position", length, load), ("tension", load, length),
        ):  # fmt: skip
            jump = jump_of_mean(counted, mean, other, reach / half, half)
            if jump is not None:
                told = note(
                    "slipped-in-earlier-step", name, step=plan.id, size=jump[1], what=what,
                    number=jump[0] + break_in,
                )  # fmt: skip
                found.append((float(time[jump[0]]), told))
    return found


def _needs_length(campaign: Campaign, plan: TestPlan) -> bool:
    """Whether the strain of any specimen is derived from the thimble-to-thimble length."""
    method = plan.settings.strain.method
    if method is not None:
        return method not in ("extensometer", "gauge-length")
    return any(name in campaign.marks for name in plan.specimens)


def _specimens(campaign: Campaign, plan: TestPlan) -> tuple[Specimen, ...]:
    return tuple(campaign.specimens[name] for name in plan.specimens)


def _located(plan: TestPlan, located: Located, sources: tuple[Source, ...]) -> Survey:
    record, cycles = located.record, located.cycles
    return Survey(
        plan,
        sources,
        located,
        n_rows=record.n_samples,
        n_cycles=0 if cycles is None else cycles.n_cycles,
        n_cycles_between=0 if cycles is None else cycles.n_between,
        first_time=float(record.time[0]),
        extremes=extremes_of_test(located),
        levels=levels_of_test(
            record.time,
            located.position,
            located.tension,
            record.measured_strain,
            located.standstills,
            cycles,
            control=plan.control,
        ),
        broken=_broken(located, plan),
        found=_log_summary(located),
        notes=(*record.notes, *(() if cycles is None else cycles.notes)),
    )


def _broken(located: Located, plan: TestPlan) -> frozenset[str]:
    """Broken specimens: as stated, or those whose tension in a pull falls and stays low."""
    if plan.failed is not None or plan.kind != "tensile":
        return frozenset(plan.specimens if plan.failed else ())
    try:
        pull = tensile_pull(
            located.position, located.tension, located.tension, rated_break_strength=np.nan
        )
    except DataError:  # too few readings, which the reduction itself reports
        return frozenset()
    return frozenset(np.array(plan.specimens)[pull.is_break].tolist())


def _measure_marks(survey: Survey, located: Located, campaign: Campaign) -> None:
    """Store the tension at each mark reading of a log in the survey of its test or first step."""
    plan = survey.plan
    if located.record.position_is_length and _needs_length(campaign, plan):
        for name in plan.specimens:
            if name not in campaign.marks:
                continue
            try:
                notes = check_tape_against_crosshead(
                    campaign.marks[name],
                    test_id=plan.log,
                    standstills=located.standstills,
                    position=located.position,
                    position_uncertainty=_of_position(campaign, located),
                )
            except DataError as error:
                survey.mark_errors[name] = error
                continue
            survey.notes += notes
            survey.found.get("notes", []).extend(map(str, notes))
            if survey.located is not None:
                record = survey.located.record
                record = replace(record, notes=(*notes, *record.notes))
                survey.located = replace(survey.located, record=record)
    survey.mark_tension = tension_at_marks(located, campaign.marks, plan.specimens, log=plan.log)


def _of_position(campaign: Campaign, located: Located) -> float:
    """Standard uncertainty of the crosshead's zero and scale, if stated. [m]."""
    stated = campaign.uncertainty
    return float(
        np.hypot(
            stated.position_offset, stated.position_gain * finite_extremes(located.position)[1]
        )
    )


def survey_log(campaign: Campaign, name: str) -> list[Survey]:
    """Read and locate one log; an unreadable log gives one survey with its error."""
    plan = campaign.tests[name]
    try:
        return _read_test(campaign, plan)
    except Exception as error:  # fails only this test, even for a defect of this program
        if isinstance(error, OSError) and error.errno is not None:
            error = unreadable(error.filename or plan.files[0][0], error)
        return [Survey(plan, error=as_reduction_error(error))]


def located_again(campaign: Campaign, survey: Survey) -> Located:
    """The record of a survey, read again if it was not kept."""
    if survey.located is not None:
        return survey.located
    for again in _read_test(campaign, campaign.tests[survey.plan.log]):
        if again.plan.id == survey.plan.id and again.located is not None:
            if again.sources != survey.sources:
                raise LogError(
                    campaign.file(survey.plan.files[0][0]),
                    "the file changed while the campaign ran",
                    found=f"other content than the {survey.n_rows} rows read at first",
                    needed="raw files that stay as they are",
                )
            return again.located
    raise DataError(
        f"test '{survey.plan.id}' was read before and cannot be read again",
        needed="raw files that stay as they are while a campaign runs",
    )


def as_reduction_error(error: Exception) -> ReductionError:
    """An error for a test; one not raised on purpose is reported as a defect of this program."""
    if isinstance(error, ReductionError):
        return error
    if isinstance(error, OSError) and error.errno is not None:
        return refused_by_system(error)
    return ReductionError(
        f"internal error, a defect of this program: {type(error).__name__}: {error}"
    )


# beyond this total, records are read again instead of kept between the passes: 90 bytes a row
KEPT_SAMPLES = 500_000

# longer records are not sent between processes: sending 10,000 rows takes 1 ms, reading them again
# 40 ms
SENT_SAMPLES = 100_000


@dataclass
class FirstPass:
    """Contents of all tests of a campaign without their samples, and the records kept.

    ``surveys`` are in the order of the campaign; a failed test has its error.  ``kept`` holds, by
    log, surveys with their records, as far as memory allows.
    """

    surveys: list[Survey]
    kept: dict[str, list[Survey]] = field(default_factory=dict)


def survey_campaign(
    campaign: Campaign,
    *,
    workers: Workers | None = None,
    lock: RunLock | None = None,
    progress: Progress | None = None,
) -> FirstPass:
    """Read and locate every test of a campaign."""
    progress = progress or Silent()
    progress.stage("survey", len(campaign.tests))
    is_elsewhere = workers is not None
    followed = _followed_logs(campaign)
    tasks = [
        Task(
            log,
            (with_one_log(campaign, log), log, lock, is_elsewhere, log in followed),
            _n_bytes(campaign, log),
        )
        for log in campaign.tests
    ]
    kept: dict[str, list[Survey]] = {}
    of_log: dict[str, list[Survey]] = {}
    n_rows = 0
    for ended in work_on(_survey, tasks, workers=workers, begun=progress.begun):
        found = ended.value or [Survey(campaign.tests[ended.test], error=ended.error)]
        n_rows += sum(survey.n_rows for survey in found)
        if n_rows <= KEPT_SAMPLES or len(campaign.tests) == 1:
            kept[ended.test] = found
        of_log[ended.test] = [replace(survey, located=None) for survey in found]
        progress.ended(ended.test)
    return FirstPass([survey for log in campaign.tests for survey in of_log[log]], kept)


def _followed_logs(campaign: Campaign) -> set[str]:
    """Logs that are followed by another test of the same specimen, or repeated in part."""
    last: dict[str, int] = {}
    for plan in campaign.tests.values():
        for name in plan.specimens:
            last[name] = max(plan.order or 0, last.get(name, 0))
    whole = {plan.part_of for plan in campaign.tests.values()}
    return {
        log
        for log, plan in campaign.tests.items()
        if log in whole
        or (plan.order is not None and any(last[name] > plan.order for name in plan.specimens))
    }


def with_one_log(campaign: Campaign, log: str) -> Campaign:
    """Reduced campaign for work on one log, so that only one of thousands of tests is sent."""
    return replace(campaign, tests={log: campaign.tests[log]})


def _n_bytes(campaign: Campaign, log: str) -> int:
    """Total size of the accessible files of a log."""
    n_bytes = 0
    for name, _ in campaign.tests[log].files:
        if name not in campaign.unread:
            with suppress(OSError):  # reported when the test is read
                n_bytes += campaign.file(name).stat().st_size
    return n_bytes


def _survey(
    campaign: Campaign, log: str, lock: RunLock | None, is_elsewhere: bool, is_followed: bool
) -> list[Survey]:
    if lock is not None:
        lock.confirm()
    surveys = survey_log(campaign, log)
    for survey in surveys if is_followed or len(surveys) > 1 else ():
        if survey.located is not None:
            survey.slips = _splice_slips(survey.located, survey.plan, campaign.marks)
    is_sent = sum(survey.n_rows for survey in surveys) <= SENT_SAMPLES
    return (
        surveys if is_sent or not is_elsewhere else [replace(one, located=None) for one in surveys]
    )


def _splice_slips(
    located: Located, plan: TestPlan, spliced: Container[str] = ()
) -> dict[str, list[SpliceSlip]]:
    """Slips of the splices by specimen, for a test with enough cycles to find them.

    With few cycles, a slip is a fall of the mean tension between two of them that position does
    not follow, in specimens with splices.
    """
    found, cycles = slips_of(located, plan.settings), located.cycles
    if cycles is None:
        return {}
    if found is None:
        return _falls_between_cycles(located, plan, spliced)
    times = located.record.time[cycles.first[found.slip_cycle - 1]]
    slips: dict[str, list[SpliceSlip]] = {}
    for name, time, length in zip(found.specimen, times, found.slip_length, strict=True):
        if not length < 0:  # a splice lets out: an upward step is not a slip
            slips.setdefault(name, []).append(SpliceSlip(float(time), float(length)))
    return slips


def _falls_between_cycles(
    located: Located, plan: TestPlan, spliced: Container[str]
) -> dict[str, list[SpliceSlip]]:
    """Slips from the fall of the mean tension, using the stiffness of the cycles."""
    slips: dict[str, list[SpliceSlip]] = {}
    cycles = located.cycles
    if (
        cycles is None
        or plan.control == "load"
        or not any(one in spliced for one in plan.specimens)
    ):
        return slips
    within = slice(int(cycles.first[0]), int(cycles.last[-1]) + 1)
    stroke = np.ptp(finite_extremes(located.position[within]))
    for time, told in _slips_of_step(located, plan):
        name, fall = told.subject, -told.numbers["size"]
        if told.numbers["what"] == "tension" and fall > 0 and name in spliced:
            load = located.tension[plan.specimens.index(name)]
            length = fall * stroke / np.ptp(finite_extremes(load[within]))
            slips.setdefault(name, []).append(SpliceSlip(time, float(length)))
    return slips


def with_record(survey: Survey, kept: Sequence[Survey] | None) -> Survey:
    """Return a survey with the record kept for its log, if it is of the same file."""
    for one in kept or ():
        if one.plan.id == survey.plan.id and one.sources == survey.sources:
            return replace(survey, located=one.located)
    return survey


def _error_message(campaign: Campaign, survey: Survey, error: ReductionError) -> str:
    """``FILE:ROW [CHANNEL]: problem``; data errors get the file of their test."""
    if isinstance(error, (LogError, SettingsError)):
        return campaign.in_words(str(error))
    if error.where():  # its file, named as in the campaign, row and channel
        name = str(error.facts["file"])
        return f"{campaign.shown(name)}{str(error).removeprefix(name)}"
    return campaign.in_words(f"{campaign.shown(survey.plan.files[0][0])}: {error}")


def status_row(
    campaign: Campaign,
    survey: Survey,
    status: Status,
    *,
    error: ReductionError | None = None,
    message: str = "",
    seconds: float = 0.0,
    worker: str = "",
) -> TestStatus:
    """One row of the status table."""
    return TestStatus(
        test=survey.plan.id,
        status=status,
        exit_status=0 if error is None else error.exit_status,
        message=message if error is None else _error_message(campaign, survey, error),
        n_rows=survey.n_rows,
        n_cycles=survey.n_cycles,
        raw_sha256=" ".join(source.sha256 for source in survey.sources),
        seconds=seconds,
        found=survey.found,
        worker=worker,
    )
