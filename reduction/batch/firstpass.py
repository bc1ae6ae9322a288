"""The first pass over a campaign: every log read and located, before any is reduced."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace

from reduction.batch.executor import Task, Workers, work_on
from reduction.batch.lock import RunLock
from reduction.batch.progress import Progress, Silent
from reduction.batch.survey import Survey, survey_log
from reduction.campaign.plan import Campaign

# records larger than this together are read again rather than kept between the passes
KEPT_SAMPLES = 10_000_000


@dataclass
class FirstPass:
    """What the tests of a campaign hold, without their samples; and the records that are kept.

    ``surveys`` are in the order of the campaign; a test that failed carries its error.  ``kept``
    holds, by log, the surveys with their records, where the log was read in this process.
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
    """Read and locate every test of a campaign.

    Parameters
    ----------
    campaign : Campaign
        As loaded.
    workers : Workers, optional
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
    progress = progress or Silent()
    progress.stage("survey", len(campaign.tests))
    is_elsewhere = workers is not None
    tasks = [
        Task(log, (with_one_log(campaign, log), log, lock, is_elsewhere), _n_bytes(campaign, log))
        for log in campaign.tests
    ]
    kept: dict[str, list[Survey]] = {}
    of_log: dict[str, list[Survey]] = {}
    n_rows = 0
    for ended in work_on(_survey, tasks, workers=workers, begun=progress.begun):
        found = ended.value or [Survey(campaign.tests[ended.test], error=ended.error)]
        n_rows += sum(survey.n_rows for survey in found)
        if not is_elsewhere and (n_rows <= KEPT_SAMPLES or len(campaign.tests) == 1):
            kept[ended.test] = found
        of_log[ended.test] = [replace(survey, located=None) for survey in found]
        progress.ended(ended.test)
    return FirstPass([survey for log in campaign.tests for survey in of_log[log]], kept)


def with_one_log(campaign: Campaign, log: str) -> Campaign:
    """What the work on one log needs of a campaign: of thousands of tests each is sent one."""
    return replace(campaign, tests={log: campaign.tests[log]})


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
    # to send a record between processes takes longer than to read it again
    return [replace(one, located=None) for one in surveys] if is_elsewhere else surveys


def with_record(survey: Survey, kept: Sequence[Survey] | None) -> Survey:
    """Give a survey the record that was kept of its log, where it is of the same file."""
    for one in kept or ():
        if one.plan.id == survey.plan.id and one.sources == survey.sources:
            return replace(survey, located=one.located)
    return survey
