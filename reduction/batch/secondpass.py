"""The second pass over a campaign: each test reduced by itself, from what all surveys say."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from reduction.batch.basis import Basis
from reduction.batch.executor import Task, Workers, work_on
from reduction.batch.firstpass import FirstPass, with_one_log, with_record
from reduction.batch.lock import RunLock
from reduction.batch.outcome import status_row
from reduction.batch.progress import Progress
from reduction.batch.reduce import bring_up_to_date
from reduction.batch.status import Status, TestStatus
from reduction.batch.survey import Survey, as_reduction_error
from reduction.campaign.plan import Campaign
from reduction.errors import ReductionError


@dataclass(frozen=True)
class _Made:
    """What became of one test where it was reduced."""

    status: Status
    message: str
    error: ReductionError | None
    seconds: float


def reduce_campaign(
    campaign: Campaign,
    first: FirstPass,
    chosen: Sequence[Survey],
    *,
    errors: Mapping[str, ReductionError],
    basis: Callable[[Survey], Basis],
    folder: Path,
    workers: Workers | None,
    lock: RunLock,
    progress: Progress,
    clock: Callable[[], float],
    force: bool,
    command: str,
) -> list[TestStatus]:
    """Bring the archives of tests up to date.

    Parameters
    ----------
    campaign : Campaign
        As loaded.
    first : FirstPass
        From `survey_campaign`; the records that it keeps are let go.
    chosen : sequence of Survey
        The tests that are asked for.
    errors : mapping of test to ReductionError
        Tests that cannot be reduced, beside those whose survey says so.
    basis : callable
        What the product of a test rests on.
    folder : pathlib.Path
        Of the archives.
    workers : Workers or None
        Where it is done; None: in this process.
    lock : RunLock
        That the run holds.
    progress : Progress
        Told of each test.
    clock : callable
        Seconds, for the status alone.
    force : bool
        Redo tests that stand.
    command : str
        For the attribute ``command``.

    Returns
    -------
    statuses : list of TestStatus
        In the order of the tests that were asked for.
    """
    progress.stage("reduce", len(chosen))
    known = {survey.plan.id: survey for survey in chosen}
    of_log = Counter(survey.plan.log for survey in chosen)
    kept = {log: first.kept[log] for log in of_log if log in first.kept}
    first.kept.clear()
    statuses: dict[str, TestStatus] = {}

    def end(name: str, made: _Made, worker: str = "") -> None:
        statuses[name] = status_row(
            campaign, known[name], made.status, error=made.error, message=made.message,
            seconds=made.seconds, worker=worker,
        )  # fmt: skip
        progress.ended(name, statuses[name])

    def tasks() -> Iterator[Task]:
        for name, survey in known.items():
            log = survey.plan.log
            of_log[log] -= 1
            # each record goes with the last task that takes it
            record = kept.get(log) if of_log[log] else kept.pop(log, None)
            error = survey.error or errors.get(name)
            try:
                if error is not None:
                    raise error
                rests_on = basis(survey)
            except Exception as failure:
                # a campaign goes on after a failed test, even where the failure is a defect here
                end(name, _Made("failed", "", as_reduction_error(failure), 0.0))
                continue
            given = (
                with_one_log(campaign, log), survey, record, rests_on, folder / f"{name}.nc",
                lock, clock, force, command,
            )  # fmt: skip
            yield Task(name, given, survey.n_rows)

    for ended in work_on(_make, tasks(), workers=workers, begun=progress.begun):
        made = ended.value or _Made("failed", "", ended.error, 0.0)
        end(ended.test, made, ended.worker)
    return [statuses[name] for name in known]


def _make(
    campaign: Campaign,
    survey: Survey,
    kept: Sequence[Survey] | None,
    basis: Basis,
    path: Path,
    lock: RunLock,
    clock: Callable[[], float],
    force: bool,
    command: str,
) -> _Made:
    """Bring one archive up to date, wherever this runs."""
    lock.confirm()
    start = clock()
    status: Status
    try:
        status, message = bring_up_to_date(
            campaign, with_record(survey, kept), basis, path, force=force, command=command,
            before_writing=lock.confirm,
        )  # fmt: skip
    except Exception as failure:
        # a campaign goes on after a failed test, even where the failure is a defect here
        return _Made("failed", "", as_reduction_error(failure), clock() - start)
    return _Made(status, message, None, clock() - start)
