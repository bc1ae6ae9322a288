"""Reduces each test of a campaign, unless nothing has changed."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import xarray as xr

from reduction import __version__
from reduction.archive.open import KeptArchive, as_kept
from reduction.archive.test_dataset import kept_samples, to_dataset
from reduction.archive.write import write_archive
from reduction.batch.campaign_status import Progress, Status, TestStatus
from reduction.batch.reuse import Basis, describe, reusable_product
from reduction.batch.run_lock import RunLock
from reduction.batch.slow_pulls import pull_conditions
from reduction.batch.survey import (
    FirstPass,
    Survey,
    as_reduction_error,
    located_again,
    status_row,
    with_one_log,
    with_record,
)
from reduction.batch.test_history import instruments_of, stepwise_instruments
from reduction.batch.workers import Task, Workers, work_on
from reduction.campaign.plan import Campaign
from reduction.pipeline.reduce_test import check_stated_errors, reduce_stepwise_test, reduce_test
from reduction.readers.raw_log import hash_source
from reduction.record.errors import LogError, ReductionError
from reduction.record.notes import Note, note_message
from reduction.stages.reduced_test import History, ReducedTest
from reduction.stages.strain.strain_model import StrainModel
from reduction.stages.three_parameter_line.line_product import SlowPull
from reduction.uncertainty.errors_of_cycles import PullOrigin


def _reduce_survey(
    campaign: Campaign,
    survey: Survey,
    models: Sequence[StrainModel],
    history: History | None,
    settings: str,
    pulls: Sequence[SlowPull | None] | None = None,
    pull_origins: Sequence[PullOrigin | None] = (),
) -> ReducedTest:
    """Reduce one surveyed test."""
    description = describe(campaign, survey)
    specimens = tuple(campaign.specimens[name] for name in survey.plan.specimens)
    if survey.step_readings is not None:
        return reduce_stepwise_test(
            survey.step_readings,
            description=description,
            specimens=specimens,
            history=history,
            sources=survey.sources,
            settings_json=settings,
            instruments=stepwise_instruments(campaign, survey),
        )
    located = located_again(campaign, survey)
    instruments = instruments_of(campaign, survey, models)
    notes = check_stated_errors(located, instruments, place=f"{campaign.path}: uncertainty")
    reduced = reduce_test(
        located,
        description=description,
        specimens=specimens,
        models=models,
        history=history,
        sources=survey.sources,
        settings=survey.plan.settings,
        settings_json=settings,
        pulls=pulls,
        pull_origins=pull_origins,
        pull_conditions=pull_conditions(campaign, survey),
        instruments=instruments,
    )
    return replace(reduced, notes=(*reduced.notes, *notes))


def dataset_of(
    campaign: Campaign,
    survey: Survey,
    basis: Basis,
    *,
    command: str,
) -> tuple[xr.Dataset, tuple[Note, ...]]:
    """Reduce one surveyed test to the contents of its archive."""
    product = _reduce_survey(
        campaign, survey, basis.models, basis.history, basis.settings, basis.pulls,
        basis.pull_origins,
    )  # fmt: skip
    kept = kept_samples(product, survey.plan.settings)
    product = replace(product, notes=(*product.notes, *basis.remarks))
    dataset = to_dataset(product, version=__version__, command=command, kept=kept)
    return dataset, product.all_notes()


def _bring_up_to_date(
    campaign: Campaign,
    survey: Survey,
    basis: Basis,
    path: Path,
    *,
    force: bool,
    command: str,
    before_writing: Callable[[], None],
) -> tuple[Status, str, xr.Dataset | None]:
    """Write the archive of one test, unless there is one from the same logs and settings.

    Returns the status, the message and the dataset written.
    """
    if not force:
        notes = reusable_product(path, survey, basis.settings, remarks=basis.remarks)
        if notes is not None:
            return "unchanged", note_message(notes), None
    dataset, notes = dataset_of(campaign, survey, basis, command=command)
    _check_raw_files(campaign, survey)
    before_writing()
    written = write_archive(dataset, path)
    may_move = any(one.severity == "warning" for one in notes)
    return "check" if may_move else "reduced", note_message(notes), written


def _check_raw_files(campaign: Campaign, survey: Survey) -> None:
    """Refuse an archive if its raw file has changed or disappeared since it was read."""
    for (name, _), read in zip(survey.plan.files, survey.sources, strict=True):
        path = campaign.file(name)
        now = hash_source(path, read.name)
        if now != read:
            raise LogError(
                path,
                "the file changed while the campaign ran",
                found=f"sha256 {now.sha256[:16]}... of {now.size} bytes",
                needed=f"sha256 {read.sha256[:16]}... of {read.size} bytes, as it was read",
                hint="The earlier archive is kept. Run again when nothing writes to the file.",
            )


@dataclass(frozen=True)
class _Made:
    """Result of reducing one test."""

    status: Status
    message: str
    error: ReductionError | None
    seconds: float
    written: KeptArchive | None = None


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
    written: Callable[[Path, KeptArchive], None] = lambda path, archive: None,
) -> list[TestStatus]:
    """Bring the archives of tests up to date; ``written`` receives the small ones."""
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
            # each record goes with the last task that uses it
            record = kept.get(log) if of_log[log] else kept.pop(log, None)
            error = survey.error or errors.get(name)
            try:
                if error is not None:
                    raise error
                rests_on = basis(survey)
            except Exception as failure:
                # a campaign continues after a failed test, even for a defect of this program
                end(name, _Made("failed", "", as_reduction_error(failure), 0.0))
                continue
            given = (
                with_one_log(campaign, log), survey, record, rests_on, folder / f"{name}.nc",
                lock, clock, force, command,
            )  # fmt: skip
            yield Task(name, given, survey.n_rows)

    for ended in work_on(_make, tasks(), workers=workers, begun=progress.begun):
        made = ended.value or _Made("failed", "", ended.error, 0.0)
        if made.written is not None:
            written(folder / f"{ended.test}.nc", made.written)
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
    """Bring one archive up to date, in any process."""
    lock.confirm()
    start = clock()
    status: Status
    try:
        status, message, written = _bring_up_to_date(
            campaign, with_record(survey, kept), basis, path, force=force, command=command,
            before_writing=lock.confirm,
        )  # fmt: skip
    except Exception as failure:
        # a campaign continues after a failed test, even for a defect of this program
        return _Made("failed", "", as_reduction_error(failure), clock() - start)
    as_found = None if written is None else as_kept(written)
    return _Made(status, message, None, clock() - start, as_found)
