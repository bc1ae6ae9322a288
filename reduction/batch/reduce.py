"""One test of a campaign: reduced, or left as it stands."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import xarray as xr

from reduction import __version__
from reduction.archive.dataset import to_dataset
from reduction.archive.kept import kept_samples
from reduction.archive.write import write_archive
from reduction.batch.basis import Basis
from reduction.batch.describe import describe
from reduction.batch.instruments import instruments_of, stepwise_instruments
from reduction.batch.outcome import note_message
from reduction.batch.pulls import pull_conditions
from reduction.batch.standing import standing_product
from reduction.batch.status import Status
from reduction.batch.survey import Survey, located_again
from reduction.campaign.plan import Campaign
from reduction.errors import LogError
from reduction.ingest.source import hash_source
from reduction.line.product import SlowPull
from reduction.pipeline.reduce import reduce_stepwise_test, reduce_test
from reduction.pipeline.shared.pulls import PullOrigin
from reduction.pipeline.statedlimits import check_stated_errors
from reduction.product import History, ReducedTest
from reduction.strain.model import StrainModel


def reduce_survey(
    campaign: Campaign,
    survey: Survey,
    models: Sequence[StrainModel],
    history: History | None,
    settings: str,
    pulls: Sequence[SlowPull | None] | None = None,
    pull_origins: Sequence[PullOrigin | None] = (),
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
    pull_origins : sequence of PullOrigin or None, optional
        With what each pull was read.

    Returns
    -------
    test : ReducedTest
        Ready for the archive.

    Raises
    ------
    SettingsError
        If what is stated of the instruments cannot be meant of this log.
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
) -> tuple[xr.Dataset, tuple[tuple[str, str], ...]]:
    """Reduce one surveyed test to all that its archive is to hold.

    Parameters
    ----------
    campaign : Campaign
        Where its files, layouts and specimens are.
    survey : Survey
        The test after the first pass.
    basis : Basis
        What its product rests on beside its own log.
    command : str
        For the product's ``command`` attribute, without paths.

    Returns
    -------
    dataset : xarray.Dataset
        The archive, not written.
    notes : tuple of (stage, text)
        That it holds.

    Raises
    ------
    ReductionError
        If the record cannot support a stage that its kind needs.
    """
    product = reduce_survey(
        campaign, survey, basis.models, basis.history, basis.settings, basis.pulls,
        basis.pull_origins,
    )  # fmt: skip
    kept = kept_samples(product, survey.plan.settings)
    of_archive = () if kept is None else (kept.note,)
    product = replace(product, notes=(*product.notes, *basis.remarks, *of_archive))
    dataset = to_dataset(product, version=__version__, command=command, kept=kept)
    return dataset, product.all_notes()


def bring_up_to_date(
    campaign: Campaign,
    survey: Survey,
    basis: Basis,
    path: Path,
    *,
    force: bool,
    command: str,
    before_writing: Callable[[], None],
) -> tuple[Status, str]:
    """Write the archive of one test, unless one stands that is of the same logs and settings.

    Parameters
    ----------
    campaign : Campaign
        Where its files, layouts and specimens are.
    survey : Survey
        The test after the first pass.
    basis : Basis
        What its product rests on beside its own log.
    path : pathlib.Path
        Of the archive.
    force : bool
        Write it in any case.
    command : str
        For the product's ``command`` attribute, without paths.
    before_writing : callable
        Raises an error where nothing may be written any more.

    Returns
    -------
    status : Status
        ``unchanged``, ``reduced`` or ``reduced_with_notes``.
    message : str
        What a reader of the table of tests has to know.

    Raises
    ------
    ReductionError
        If the record cannot support a stage that its kind needs, a raw file is not what it was
        when it was read, or the archive cannot be written.
    """
    if not force:
        notes = standing_product(path, survey, basis.settings, remarks=basis.remarks)
        if notes is not None:
            return "unchanged", note_message(notes)
    dataset, notes = dataset_of(campaign, survey, basis, command=command)
    _check_raw_files(campaign, survey)
    before_writing()
    write_archive(dataset, path)
    return "reduced_with_notes" if notes else "reduced", note_message(notes)


def _check_raw_files(campaign: Campaign, survey: Survey) -> None:
    """Refuse an archive of a raw file that is another now, or gone, since it was read.

    Times and sizes are not enough: a copy may keep both.
    """
    for (name, _), read in zip(survey.plan.files, survey.sources, strict=True):
        path = campaign.file(name)
        now = hash_source(path, read.name)
        if now != read:
            raise LogError(
                path,
                "the file changed while the campaign ran",
                found=f"sha256 {now.sha256[:16]}... of {now.size} bytes",
                needed=f"sha256 {read.sha256[:16]}... of {read.size} bytes, as it was read",
                hint="The product before is kept. Run again when nothing writes to the file.",
            )
