"""The first pass over a campaign: what each test holds, before any is reduced.

The marks of a specimen are pooled over its tests, and a test's history is what came
before it; so every log is read and located once, and only then reduced.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from reduction.batch.found import found_in
from reduction.batch.steps import step_plan, step_record
from reduction.campaign.plan import Campaign, TestPlan
from reduction.errors import DataError, LogError, ReductionError
from reduction.ingest.datum import length_at_slack
from reduction.ingest.record_of_test import read_record
from reduction.ingest.stepwise import read_step_readings
from reduction.moduli.stepwise import greatest_step_strain
from reduction.pipeline.locate import Located, locate
from reduction.provenance import Source
from reduction.record import Floats, Record, SpliceMarks, StepReadings
from reduction.strain.fit import zero_strain_position
from reduction.strain.marks import measure_mark_tension

__all__ = ["Survey", "as_reduction_error", "located_again", "read_test", "survey_campaign"]

# records larger than this together are read again rather than kept between the passes
KEPT_SAMPLES = 10_000_000
# share of the greatest tension up to which the first rise is kept, to tell where slack ends
FIRST_RISE = 0.5


@dataclass
class Survey:
    """One test after the first pass.

    ``mark_tension`` holds, by specimen, one tension [N] for each pooled mark that was
    read in this test, in the order of the marks.  ``greatest`` holds, by specimen, position
    [m] and tension [N] of the samples at the greatest position, ``greatest_tension`` [N] that
    of the test; ``greatest_measured_strain`` [1] that of the extensometer, where there is one,
    or of the readings of a stepwise test;
    ``first_rise`` position [m] and tension [N] of the samples up to half of its peak; ``found``
    what a person is told of the log.
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
    has_extensometer: bool = False
    position_is_length: bool = True
    greatest: dict[str, tuple[Floats, Floats]] = field(default_factory=dict)
    greatest_tension: dict[str, float] = field(default_factory=dict)
    greatest_measured_strain: dict[str, float] = field(default_factory=dict)
    first_rise: dict[str, tuple[Floats, Floats]] = field(default_factory=dict)
    slack_tension: float = float("nan")
    found: dict[str, Any] = field(default_factory=dict)
    error: ReductionError | None = None


def read_test(campaign: Campaign, plan: TestPlan) -> list[Survey]:
    """Read one log and locate what it holds: one survey a test, or one a step.

    Parameters
    ----------
    campaign : Campaign
        Where the files, layouts and specimens are.
    plan : TestPlan
        The test.

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
        readings, sources = read_step_readings(files, test_id=plan.id)
        survey = Survey(plan, sources, step_readings=readings, n_rows=readings.time.size)
        for name in plan.specimens[:1]:  # weights hang from one specimen
            gauge = campaign.specimens[name].gauge_length
            survey.greatest_tension[name] = float(readings.tension.max())
            survey.greatest_measured_strain[name] = greatest_step_strain(
                readings, stated_gauge_length=gauge
            )
        return [survey]
    record, sources = read_record(
        files,
        test_id=plan.id,
        specimens=plan.specimens,
        quality=plan.settings.quality,
        length_needed=_needs_length(campaign, plan),
    )
    if not plan.steps:
        survey = _located(plan, record, sources)
        if survey.located is not None:
            survey.zero_strain_position = _zero_strain_position(survey.located, campaign, plan)
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
        survey.zero_strain_position = _zero_strain_position(whole, campaign, plan)
        surveys.append(survey)
    _measure_marks(surveys[0], whole, campaign.marks)
    return surveys


def _zero_strain_position(located: Located, campaign: Campaign, plan: TestPlan) -> float | None:
    return zero_strain_position(
        located.standstills,
        position_is_length=located.record.position_is_length,
        length_at_slack=length_at_slack([campaign.layouts[layout] for _, layout in plan.files]),
    )


def _needs_length(campaign: Campaign, plan: TestPlan) -> bool:
    """Whether strain of some specimen comes from the distance between the thimbles."""
    method = plan.settings.strain.method
    if method is not None:
        return method not in ("extensometer", "gauge-length")
    return any(name in campaign.marks for name in plan.specimens)


def _located(plan: TestPlan, record: Record, sources: tuple[Source, ...]) -> Survey:
    located = locate(record, kind=plan.kind, settings=plan.settings)
    survey = Survey(plan, sources, located, n_rows=record.n_samples)
    survey.has_extensometer = record.measured_strain is not None
    survey.position_is_length = record.position_is_length
    survey.found = found_in(located)
    survey.n_cycles = 0 if located.cycles is None else located.cycles.n_cycles
    survey.greatest = _greatest(located)
    survey.greatest_tension = {
        name: float(np.nanmax(tension))
        for name, tension in zip(record.specimens, located.tension, strict=True)
        if np.isfinite(tension).any()
    }
    if record.measured_strain is not None:
        survey.greatest_measured_strain = {
            name: float(np.nanmax(strain))
            for name, strain in zip(record.specimens, record.measured_strain, strict=True)
            if np.isfinite(strain).any()
        }
    survey.slack_tension = located.standstills.slack_tension
    position = located.position
    for name, tension in zip(record.specimens, located.tension, strict=True):
        taut = tension > FIRST_RISE * np.nanmax(tension, initial=0.0)
        stop = int(np.argmax(taut)) + 1 if taut.any() else 0
        survey.first_rise[name] = (position[:stop].copy(), tension[:stop].copy())
    return survey


def _greatest(located: Located) -> dict[str, tuple[Floats, Floats]]:
    """Position and tension of the samples at the greatest position.

    At a held length the rubber goes on stretching as its splices relax, so the greatest
    strain is at one of these samples, which the strain model tells.
    """
    record = located.record
    position = located.position
    if not np.isfinite(position).any():
        return {}
    far = float(np.nanmax(position))
    at_top = np.flatnonzero(position >= far - located.standstills.position_tolerance)
    found = {}
    for name, tension in zip(record.specimens, located.tension, strict=True):
        if np.isfinite(tension[at_top]).any():
            found[name] = (position[at_top], tension[at_top])
    return found


def _measure_marks(survey: Survey, located: Located | None, marks: dict[str, SpliceMarks]) -> None:
    """Tension while each mark of a log was read, into the survey of its test or first step."""
    if located is None:
        return
    for index, name in enumerate(survey.plan.specimens):
        if name in marks and survey.plan.log in marks[name].test:
            read_at_end, read_at_start = (
                measure_mark_tension(
                    marks[name],
                    test_id=survey.plan.log,
                    standstills=located.standstills,
                    tension=located.tension[index],
                    reading=reading,
                )
                for reading in ("end", "start")
            )
            survey.mark_tension[name] = read_at_end
            survey.mark_tension_at_start[name] = read_at_start


def survey_campaign(
    campaign: Campaign, *, progress: Callable[[str, str], None] | None = None
) -> list[Survey]:
    """Read and locate every test of a campaign.

    Parameters
    ----------
    campaign : Campaign
        As loaded.
    progress : callable, optional
        Called with ("survey", test id) before each test.

    Returns
    -------
    surveys : list of Survey
        In the order of the campaign; a test that failed carries its error.
    """
    surveys: list[Survey] = []
    kept = 0
    for plan in campaign.tests.values():
        if progress is not None:
            progress("survey", plan.id)
        try:
            of_test = read_test(campaign, plan)
        except Exception as error:
            of_test = [Survey(plan, error=as_reduction_error(error))]
        for survey in of_test:
            kept += survey.n_rows
            if kept > KEPT_SAMPLES and len(campaign.tests) > 1:
                survey.located = None
        surveys.extend(of_test)
    return surveys


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
    return ReductionError(
        f"internal error, a defect of this program: {type(error).__name__}: {error}"
    )
