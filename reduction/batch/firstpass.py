"""The first pass over a campaign: every log read and located, before any is reduced."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace

from reduction.batch.executor import Executor, Serial, Task
from reduction.batch.lock import RunLock
from reduction.batch.progress import Progress, Silent
from reduction.batch.survey import Survey, survey_log
from reduction.campaign.plan import Campaign
from reduction.samples.scratch import is_on_disk

__all__ = ["FirstPass", "survey_campaign", "with_record"]

# records larger than this together are read again rather than kept between the passes
KEPT_SAMPLES = 10_000_000


@dataclass
class FirstPass:
    """What the tests of a campaign hold, without their samples; and the records that are kept.

    ``surveys`` are in the order of the campaign; a test that failed carries its error.  ``kept``
    holds, by log, the surveys with their records, where the log was read.
    """

    surveys: list[Survey]
    kept: dict[str, Task[list[Survey]]] = field(default_factory=dict)


def survey_campaign(
    campaign: Campaign,
    *,
    executor: Executor | None = None,
    lock: RunLock | None = None,
    progress: Progress | None = None,
) -> FirstPass:
    """Read and locate every test of a campaign.

    Parameters
    ----------
    campaign : Campaign
        As loaded.
    executor : Executor, optional
        Where it is done; one log after another in this process where left out.
    lock : RunLock, optional
        That the run holds.
    progress : Progress, optional
        Told of each log.

    Returns
    -------
    first : FirstPass
        The surveys, and the records as far as they are kept.
    """
    executor = executor or Serial()
    progress = progress or Silent()
    progress.stage("survey", len(campaign.tests))
    shared = executor.send(campaign)
    kept: dict[str, Task[list[Survey]]] = {}
    told: list[Task[list[Survey]]] = []
    for log in campaign.tests:
        kept[log] = executor.start(
            _survey, shared, log, lock, executor.is_elsewhere,
            stage="survey", test=log, size=_n_bytes(campaign, log),
        )  # fmt: skip
        told.append(executor.start(_without_records, kept[log], stage="", test=log))
    of_log: dict[str, list[Survey]] = {}
    n_kept = 0
    for ended in executor.ended(told):
        found = ended.value or [Survey(campaign.tests[ended.test], error=ended.error)]
        of_log[ended.test] = found
        n_kept += sum(survey.n_rows for survey in found)
        if n_kept > KEPT_SAMPLES and len(campaign.tests) > 1:
            del kept[ended.test]
        progress.ended(ended.test)
    return FirstPass([survey for log in campaign.tests for survey in of_log[log]], kept)


def _n_bytes(campaign: Campaign, log: str) -> int:
    """Size of the files of a log, as far as they can be looked at."""
    n_bytes = 0
    for name, _ in campaign.tests[log].files:
        if name not in campaign.unread:
            with suppress(OSError):  # what is wrong with it is said by the test, when it is read
                n_bytes += campaign.file(name).stat().st_size
    return n_bytes


def _survey(campaign: Campaign, log: str, lock: RunLock | None, is_elsewhere: bool) -> list[Survey]:
    if lock is not None:
        lock.confirm()
    surveys = survey_log(campaign, log)
    for survey in surveys:
        record = None if survey.located is None else survey.located.record
        if is_elsewhere and record is not None and is_on_disk(record.time):
            # between workers it would go through memory: it is read again instead
            survey.located = None
    return surveys


def _without_records(surveys: Sequence[Survey]) -> list[Survey]:
    return [replace(survey, located=None) for survey in surveys]


def with_record(survey: Survey, kept: Sequence[Survey] | None) -> Survey:
    """Give a survey the record that was kept of its log, where it is of the same file."""
    for one in kept or ():
        if one.plan.id == survey.plan.id and one.sources == survey.sources:
            return replace(survey, located=one.located)
    return survey
