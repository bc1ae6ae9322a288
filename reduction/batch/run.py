"""A campaign from its logs to its products; each test fails or succeeds by itself."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from reduction import __version__
from reduction.archive.dataset import to_dataset
from reduction.archive.products import OF_CAMPAIGN, archives_of_tests
from reduction.archive.write import write_archive, write_whole
from reduction.batch.basis import basis_of
from reduction.batch.check import Progress, selected_surveys
from reduction.batch.comparisons import write_comparisons
from reduction.batch.describe import describe
from reduction.batch.experiments import write_experiments
from reduction.batch.instruments import instruments_of
from reduction.batch.models import fit_strain_models
from reduction.batch.outcome import note_message, status_row
from reduction.batch.part import PartStatus
from reduction.batch.predictions import write_predictions
from reduction.batch.properties import tests_of_ropes, write_change_in_length
from reduction.batch.pulls import fit_pulls, pull_conditions
from reduction.batch.results import write_outcomes
from reduction.batch.standing import standing_product
from reduction.batch.status import Status, TestStatus, read_status, status_csv
from reduction.batch.survey import Survey, as_reduction_error, located_again, survey_campaign
from reduction.batch.waiting import waiting_runs
from reduction.campaign.plan import Campaign
from reduction.line.product import SlowPull
from reduction.pipeline.reduce import reduce_stepwise_test, reduce_test
from reduction.product import History, ReducedTest
from reduction.report.page import write_report
from reduction.strain.model import StrainModel
from reduction.tables.write import write_tables
from reduction.units import UnitSystem

__all__ = ["CampaignResult", "reduce_survey", "run_campaign"]


@dataclass(frozen=True)
class CampaignResult:
    """What a run did: one status a test and a part, and what it wrote."""

    tests: tuple[TestStatus, ...]
    experiments: tuple[PartStatus, ...]
    hoses: tuple[PartStatus, ...]
    comparisons: tuple[PartStatus, ...]
    processed: Path
    report: Path | None
    stray: tuple[str, ...]
    tables: tuple[Path, ...] = ()

    @property
    def parts(self) -> tuple[PartStatus, ...]:
        """Everything that is not a test."""
        return (*self.experiments, *self.hoses, *self.comparisons)

    @property
    def exit_status(self) -> int:
        """The highest seen."""
        seen = [test.exit_status for test in self.tests]
        return max([*seen, *(one.exit_status for one in self.parts)], default=0)


def reduce_survey(
    campaign: Campaign,
    survey: Survey,
    models: Sequence[StrainModel],
    history: History | None,
    settings: str,
    pulls: Sequence[SlowPull | None] | None = None,
) -> ReducedTest:
    """Reduce one surveyed test.

    Parameters
    ----------
    campaign : Campaign
        Where its files, layouts and specimens are.
    survey : Survey
        The test after the first pass.
    models : sequence of StrainModel
        One a specimen, in the order of the test; none for a stepwise test.
    history : History or None
        What the specimens had seen before.
    settings : str
        Every setting in force, as JSON, for the product.
    pulls : sequence of SlowPull or None, optional
        Slow pull of each specimen, where the test is a run of an experiment.

    Returns
    -------
    test : ReducedTest
        Ready for the archive.

    Raises
    ------
    ReductionError
        If the record cannot support a stage that its kind needs.
    """
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
        )
    located = located_again(campaign, survey)
    return reduce_test(
        located,
        description=description,
        specimens=specimens,
        models=models,
        history=history,
        sources=survey.sources,
        settings=survey.plan.settings,
        settings_json=settings,
        pulls=pulls,
        pull_conditions=pull_conditions(campaign, survey),
        instruments=instruments_of(campaign, survey, models),
    )


def run_campaign(
    campaign: Campaign,
    *,
    processed: Path,
    reports: Path,
    clock: Callable[[], float],
    tests: Sequence[str] = (),
    force: bool = False,
    command: str = "",
    units: UnitSystem = "si",
    progress: Progress | None = None,
) -> CampaignResult:
    """Reduce a campaign: archives, tables, status, report.

    Parameters
    ----------
    campaign : Campaign
        As loaded.
    processed, reports : pathlib.Path
        Folders of the products and of the report; the campaign's id is added.
    clock : callable
        Seconds, for the status table only; no product depends on it.
    tests : sequence of str
        Only these; all where empty.
    force : bool
        Redo tests whose raw files, settings and version have not changed.
    command : str
        For the product's ``command`` attribute, without paths.
    units : {"si", "us"}
        What the report shows; files are SI.
    progress : callable, optional
        Called with a stage and a test id.

    Returns
    -------
    result : CampaignResult
        A failed test is a row in it, not an exception; its older product is kept.

    Raises
    ------
    SettingsError
        If ``tests`` names a test that the campaign lacks.
    ArchiveError
        If the folder or a table cannot be written.
    """
    folder = processed / campaign.id
    surveys = survey_campaign(campaign, progress=progress)
    chosen = selected_surveys(surveys, tests)
    models, errors = fit_strain_models(campaign, surveys)
    pulls, errors_of_pulls = fit_pulls(campaign, surveys, models)
    errors |= errors_of_pulls
    failed = [entry.plan.id for entry in surveys if entry.error or entry.plan.id in errors]
    basis = partial(
        basis_of,
        campaign,
        surveys=surveys,
        models=models,
        pulls=pulls,
        failed=failed,
    )
    statuses: list[TestStatus] = []
    for survey in chosen:
        name = survey.plan.id
        path = folder / f"{name}.nc"
        start = clock()
        error = survey.error or errors.get(name)
        if error is None and progress is not None:
            progress("reduce", name)
        try:
            if error is not None:
                raise error
            now = basis(survey)
            standing = (
                None
                if force
                else standing_product(
                    path, survey, now.settings, remarks=now.remarks, failed=now.failed
                )
            )
            if standing is not None:
                status: Status = "unchanged"
                message = "; ".join(filter(None, [standing.remark, note_message(standing.notes)]))
            else:
                product = reduce_survey(
                    campaign, survey, now.models, now.history, now.settings, now.pulls
                )
                product = replace(product, notes=(*product.notes, *now.remarks))
                write_archive(to_dataset(product, version=__version__, command=command), path)
                notes = product.all_notes()
                status = "reduced_with_notes" if notes else "reduced"
                message = note_message(notes)
        except Exception as failure:
            # a campaign goes on after a failed test, even where the failure is a defect here
            error, status, message = as_reduction_error(failure), "failed", ""
        survey.located = None  # its record is in the archive now, or is of no more use
        seconds = clock() - start
        statuses.append(
            status_row(campaign, survey, status, error=error, message=message, seconds=seconds)
        )
    now_failed = {status.test for status in statuses if status.status == "failed"}.union(failed)
    runs = {run for plan in campaign.experiments.values() for run in plan.runs}
    compared = {plan.measured for plan in campaign.comparisons.values()}
    asked = {survey.plan.id for survey in chosen}
    needed = runs | compared | tests_of_ropes(campaign, surveys)
    left_out = [entry for entry in surveys if entry.plan.id in needed - asked - now_failed]
    waiting = waiting_runs(folder, left_out, basis)
    experiments = write_experiments(
        campaign,
        folder,
        failed=now_failed,
        waiting=waiting,
        raw_sha256={
            entry.plan.id: "\n".join(source.sha256 for source in entry.sources)
            for entry in surveys
            if entry.plan.id in runs
        },
        command=command,
    )
    write_outcomes(campaign, folder, command=command)
    lengths = write_change_in_length(
        campaign, folder, surveys, failed=now_failed, waiting=waiting, command=command
    )
    hoses = write_predictions(campaign, folder, command=command)
    comparisons = write_comparisons(
        campaign, folder, failed=now_failed, waiting=waiting, command=command
    )
    if progress is not None:
        progress("tables", campaign.id)
    ours = [folder / f"{survey.plan.id}.nc" for survey in surveys]
    archives = [path for path in ours if path.exists()]
    report, tables = None, []
    rows = _all_rows(folder / "status.csv", surveys, statuses)
    if statuses:
        write_whole(folder / "status.csv", status_csv(rows))
    products = _products_of_campaign(campaign, folder, has_lengths=lengths is not None)
    if archives or products:
        tables = write_tables(archives, folder / "tables", **products)
        if progress is not None:
            progress("report", campaign.id)
        report = write_report(folder, reports / campaign.id, units=units)
    stray = sorted(path.name for path in archives_of_tests(folder) if path not in ours)
    stray += [
        f"{name}.nc"
        for name in OF_CAMPAIGN
        if name not in products and (folder / f"{name}.nc").exists()
    ]
    return CampaignResult(
        tests=tuple(statuses),
        experiments=tuple(experiments),
        hoses=tuple(hoses),
        comparisons=tuple(comparisons),
        processed=folder,
        report=report,
        stray=tuple(stray),
        tables=tuple(tables),
    )


def _products_of_campaign(
    campaign: Campaign, folder: Path, *, has_lengths: bool
) -> dict[str, Path]:
    """Archives of the whole campaign that it asks for and that are there, by their names."""
    asked = {
        "surfaces": bool(campaign.experiments),
        "predictions": bool(campaign.hoses),
        "comparisons": bool(campaign.comparisons),
        "outcomes": campaign.results is not None,
        "change_in_length": has_lengths,
    }
    paths = {name: folder / f"{name}.nc" for name, is_asked in asked.items() if is_asked}
    return {name: path for name, path in paths.items() if path.exists()}


def _all_rows(
    path: Path, surveys: Sequence[Survey], statuses: Sequence[TestStatus]
) -> list[TestStatus]:
    """One row for each test of the campaign; a test that was not asked for keeps its own."""
    new = {status.test: status for status in statuses}
    before = read_status(path) if len(new) < len(surveys) else {}
    rows = [new.get(survey.plan.id) or before.get(survey.plan.id) for survey in surveys]
    return [row for row in rows if row is not None]
