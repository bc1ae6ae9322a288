"""The first look at a test: what its log holds, before it is reduced.

The marks of a specimen are pooled over its tests, and a test's history is what came
before it; so every log is read and located once, and only then reduced.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

from reduction.batch.found import found_in
from reduction.batch.steps import step_plan, step_record
from reduction.campaign.plan import Campaign, TestPlan
from reduction.errors import DataError, LogError, ReductionError, refused_by_system
from reduction.ingest.datum import length_at_slack
from reduction.ingest.record_of_test import read_record
from reduction.ingest.source import unreadable
from reduction.ingest.stepwise import read_step_readings
from reduction.pipeline.extremes import Extremes, extremes_of_readings, extremes_of_test
from reduction.pipeline.locate import Located, locate
from reduction.pipeline.markreadings import tension_at_marks
from reduction.provenance import Source
from reduction.record import Floats, Record, SpliceMarks, StepReadings
from reduction.strain.fit import zero_strain_position

Reader = Callable[..., tuple[Record, tuple[Source, ...]]]
"""Gives the record of a log, as `reduction.ingest.record_of_test.read_record` does."""


@dataclass
class Survey:
    """One test after the first pass.

    ``mark_tension`` and ``mark_tension_at_start`` hold, by specimen, one tension [N] for each
    pooled mark that was read in this test, in the order of the marks.  ``extremes`` is how far
    the test went; ``found`` what a person is told of the log.
    """

    plan: TestPlan
    sources: tuple[Source, ...] = ()
    located: Located | None = None
    step_readings: StepReadings | None = None
    n_rows: int = 0
    n_cycles: int = 0
    mark_tension: dict[str, Floats] = field(default_factory=dict)
    mark_tension_at_start: dict[str, Floats] = field(default_factory=dict)
    zero_strain_position: float | None = None
    is_zero_logged: bool = False
    extremes: Extremes = field(default_factory=Extremes)
    found: dict[str, Any] = field(default_factory=dict)
    error: ReductionError | None = None


def read_test(campaign: Campaign, plan: TestPlan, *, reader: Reader = read_record) -> list[Survey]:
    """Read one log and locate what it holds: one survey a test, or one a step.

    Parameters
    ----------
    campaign : Campaign
        Where the files, layouts and specimens are.
    plan : TestPlan
        The test.
    reader : callable
        What reads its record; one that keeps records reads a log once.

    Returns
    -------
    surveys : list of Survey
        With the records in memory.

    Raises
    ------
    ReductionError
        Whatever is wrong with the log or its data, with file, row and channel.
    """
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
    record, sources = reader(
        files,
        test_id=plan.id,
        specimens=plan.specimens,
        quality=plan.settings.quality,
        length_needed=_needs_length(campaign, plan),
        limits=campaign.limits,
    )
    if not plan.steps:
        survey = _located(plan, record, sources)
        if survey.located is not None:
            _find_zero_strain(survey, survey.located, campaign, plan)
        _measure_marks(survey, survey.located, campaign.marks)
        return [survey]
    # a mark, and the position of zero strain, belong to the whole log and not to a step of it
    whole = locate(record, kind="relaxation", settings=plan.settings)
    surveys = []
    for place, step in enumerate(plan.steps, start=1):
        part = step_plan(plan, step, place)
        try:
            record_of_step = replace(step_record(record, step, plan), test_id=part.id)
            survey = _located(part, record_of_step, sources)
        except ReductionError as error:
            survey = Survey(part, sources, n_rows=record.n_samples, error=error)
        _find_zero_strain(survey, whole, campaign, plan)
        surveys.append(survey)
    _measure_marks(surveys[0], whole, campaign.marks)
    return surveys


def _find_zero_strain(survey: Survey, located: Located, campaign: Campaign, plan: TestPlan) -> None:
    """Set where strain is zero, and whether that is a position of the log."""
    layouts = [campaign.layouts[layout] for _, layout in plan.files]
    survey.is_zero_logged = bool(located.standstills.is_rest.any())
    survey.zero_strain_position = zero_strain_position(
        located.standstills,
        position_is_length=located.record.position_is_length,
        length_at_slack=length_at_slack(layouts),
    )


def _needs_length(campaign: Campaign, plan: TestPlan) -> bool:
    """Whether strain of some specimen comes from the distance between the thimbles."""
    method = plan.settings.strain.method
    if method is not None:
        return method not in ("extensometer", "gauge-length")
    return any(name in campaign.marks for name in plan.specimens)


def _located(plan: TestPlan, record: Record, sources: tuple[Source, ...]) -> Survey:
    located = locate(record, kind=plan.kind, settings=plan.settings)
    return Survey(
        plan,
        sources,
        located,
        n_rows=record.n_samples,
        n_cycles=0 if located.cycles is None else located.cycles.n_cycles,
        extremes=extremes_of_test(located),
        found=found_in(located),
    )


def _measure_marks(survey: Survey, located: Located | None, marks: dict[str, SpliceMarks]) -> None:
    """Tension while each mark of a log was read, into the survey of its test or first step."""
    if located is not None:
        at = tension_at_marks(located, marks, survey.plan.specimens, log=survey.plan.log)
        survey.mark_tension, survey.mark_tension_at_start = at["end"], at["start"]


def survey_log(campaign: Campaign, name: str, *, reader: Reader = read_record) -> list[Survey]:
    """Read and locate one log; a log that cannot be read has one survey, with its error."""
    plan = campaign.tests[name]
    try:
        return read_test(campaign, plan, reader=reader)
    except Exception as error:
        if isinstance(error, OSError) and error.errno is not None:
            error = unreadable(error.filename or plan.files[0][0], error)
        return [Survey(plan, error=as_reduction_error(error))]


def located_again(campaign: Campaign, survey: Survey) -> Located:
    """The record of a survey, read again where it was not kept."""
    if survey.located is not None:
        return survey.located
    for again in read_test(campaign, campaign.tests[survey.plan.log]):
        if again.plan.id == survey.plan.id and again.located is not None:
            if again.sources != survey.sources:
                raise LogError(
                    campaign.file(survey.plan.files[0][0]),
                    "the file changed while the campaign ran",
                    found=f"another content than the {survey.n_rows} rows that were read first",
                    needed="raw files that stay as they are",
                )
            return again.located
    raise DataError(
        f"test '{survey.plan.id}' was read before and cannot be read again",
        needed="raw files that stay as they are while a campaign runs",
    )


def as_reduction_error(error: Exception) -> ReductionError:
    """An error as a test carries it; one that was not raised on purpose is a defect here."""
    if isinstance(error, ReductionError):
        return error
    if isinstance(error, OSError) and error.errno is not None:
        return refused_by_system(error)
    return ReductionError(
        f"internal error, a defect of this program: {type(error).__name__}: {error}"
    )
