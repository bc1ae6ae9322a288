"""Runs a campaign from its logs to its products; a failed test does not affect the others."""

from __future__ import annotations

import json
import sys
from collections import Counter
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from reduction import __version__
from reduction.archive.atomic_write import write_text_atomically
from reduction.archive.campaign_products import outcomes_to_dataset
from reduction.archive.csv_tables import write_tables
from reduction.archive.open import Opener, ReadOnce, as_kept, keep_written, reading
from reduction.archive.product_files import (
    OF_CAMPAIGN,
    SUPERSEDED,
    archives_of_tests,
    record_campaign,
)
from reduction.archive.report_details import keep_details
from reduction.archive.rope_properties import CHANGES_LENGTH, properties_to_dataset, step_of_archive
from reduction.archive.write import write_archive
from reduction.batch.campaign_status import (
    CampaignResult,
    PartStatus,
    Progress,
    ShownAnswers,
    ShownTable,
    Silent,
    TestStatus,
    read_status,
    status_csv,
)
from reduction.batch.catalogue import FILE_NAME
from reduction.batch.catalogue_entries import CatalogueEntries, write_catalogue
from reduction.batch.experiment_product import write_experiments
from reduction.batch.prediction_product import write_comparisons, write_predictions
from reduction.batch.reduce_tests import reduce_campaign
from reduction.batch.requested_products import (
    find_reduction_inputs,
    refuse_unknown_tests,
    requested_products,
    selected_surveys,
)
from reduction.batch.reuse import NOT_REDUCED, Basis, outdated_runs
from reduction.batch.run_lock import RunLock, run_lock
from reduction.batch.survey import Survey
from reduction.batch.test_history import instruments_of
from reduction.batch.workers import Workers
from reduction.campaign.plan import Campaign
from reduction.experiments.outcome_groups import odd_outcomes
from reduction.quantities.units import UnitSystem
from reduction.readers.raw_log import hash_source
from reduction.record.contributions import Component, InstrumentErrors
from reduction.record.errors import ArchiveError, SettingsError
from reduction.record.measurement import Origin, Source, Specimen, Step
from reduction.record.samples import trim_heap
from reduction.report.campaign_page import CampaignAnswers, CampaignPage
from reduction.stages.strain.strain_model import StrainModel
from reduction.stages.three_parameter_line.change_in_length import (
    ChangeInLength,
    StepOfProgramme,
    change_in_length,
)

_Models = Callable[[Survey], Sequence[StrainModel]]


@dataclass(frozen=True)
class _Found:
    """Results from the archives of the tests of one rope."""

    steps: tuple[StepOfProgramme, ...]
    sources: tuple[Source, ...]
    missing: tuple[str, ...]
    is_programme: bool
    component: dict[str, tuple[Component, ...]]


def _tests_of_ropes(campaign: Campaign, surveys: Sequence[Survey]) -> set[str]:
    """Tests that may be steps of a rope programme."""
    return {
        entry.plan.id
        for entry in surveys
        if entry.plan.part_of is None
        and any(campaign.specimens[name].is_rope for name in entry.plan.specimens)
    }


def _write_change_in_length(
    campaign: Campaign,
    folder: Path,
    surveys: Sequence[Survey],
    *,
    models: _Models,
    failed: Collection[str],
    waiting: Collection[str],
    command: str,
    opener: Opener = reading,
) -> Path | None:
    """Write the change-in-length properties of the ropes of a campaign."""
    found: dict[str, tuple[ChangeInLength, ...]] = {}
    sources: dict[str, Source] = {}
    used: dict[str, list[str]] = {}
    component: dict[tuple[str, str], tuple[Component, ...]] = {}
    for name, specimen in campaign.specimens.items():
        if not specimen.is_rope:
            continue
        own, is_ordered = _in_order(surveys, name)
        known = {
            entry.plan.id: _instruments(campaign, entry, name, models(entry))
            for entry in own
            if entry.plan.id not in failed and entry.plan.id not in waiting
        }
        given = _read(folder, own, name, known, failed=failed, waiting=waiting, opener=opener)
        if not given.is_programme:
            continue
        found[name] = change_in_length(
            given.steps,
            loaded_before=_loaded_before(name, specimen, own, given.steps),
            loaded_in_step=_loaded_in_step(name, own),
            is_ordered=is_ordered,
            missing="; ".join(given.missing),
            rated_break_strength=specimen.rated_break_strength or float("nan"),
        )
        sources |= {source.name: source for source in given.sources}
        used[name] = [one.name for one in given.steps]
        component |= {(name, step): own for step, own in given.component.items()}
    if not found:
        return None
    settings = {
        "tests": used,
        "specimens": {name: asdict(campaign.specimens[name]) for name in found},
    }
    origin = Origin(
        campaign_id=campaign.id,
        attributes=campaign.attributes,
        sources=tuple(sources.values()),
        steps=[
            Step("change in length", _properties_in_one_line(name, own))
            for name, own in found.items()
        ],
        settings_json=json.dumps(settings, sort_keys=True, ensure_ascii=False, allow_nan=False),
        version=__version__,
        command=command,
    )
    path = folder / "change_in_length.nc"
    written = write_archive(properties_to_dataset(found, component, origin=origin), path)
    keep_written(opener, path, as_kept(written))
    return path


def _in_order(surveys: Sequence[Survey], name: str) -> tuple[list[Survey], bool]:
    """Tests of a specimen, oldest first, and whether the order is known."""
    own = [
        entry for entry in surveys if name in entry.plan.specimens and entry.plan.part_of is None
    ]
    is_ordered = (
        len({entry.plan.log for entry in own}) < 2
        or not any(entry.plan.order is None for entry in own)
    )  # fmt: skip
    if is_ordered:
        own.sort(key=lambda entry: (entry.plan.order or 0, entry.plan.step_place))
    return own, is_ordered


_STATE_IT = ": state that part as a step before it, of kind quasi-static if it has no cycles"


def _loaded_in_step(name: str, own: Sequence[Survey]) -> str:
    """Load in the first step, before its first cycle, that is above the foot of this cycle."""
    peak, is_before_step = own[0].loaded_before.get(name, (0.0, True))
    if is_before_step:
        return ""
    return f"{own[0].plan.id} loads it to {peak:.4g} N before its first cycle{_STATE_IT}"


def _loaded_before(
    name: str, specimen: Specimen, own: Sequence[Survey], steps: Sequence[StepOfProgramme]
) -> str:
    """Loads on a rope before its first step with numbers; empty for a new rope."""
    first = own[0].plan
    count = (specimen.earlier_cycles or 0) + (first.unlogged_cycles or 0)
    if count:
        return f"it had carried {count} cycles before the first test"
    if not steps or steps[0].name != first.id:
        return f"{first.id} came first, and gave no archive"
    peak, is_before_step = own[0].loaded_before.get(name, (0.0, False))
    if is_before_step:
        return f"the log loads it to {peak:.4g} N before {first.id}{_STATE_IT}"
    return ""


def _read(
    folder: Path,
    own: Sequence[Survey],
    specimen: str,
    known: Mapping[str, tuple[InstrumentErrors, StrainModel] | tuple[None, None]],
    *,
    failed: Collection[str],
    waiting: Collection[str],
    opener: Opener,
) -> _Found:
    steps, sources, missing, is_programme = [], [], [], False
    component = {}
    for entry in own:
        test = entry.plan.id
        if test in failed or test in waiting:
            missing.append(f"{test} {'failed' if test in failed else NOT_REDUCED}")
            continue
        path = folder / f"{test}.nc"
        # a test that neither failed nor is pending has an archive that is up to date
        with opener(path) as archive:
            found = step_of_archive(archive, specimen, *known[test])
            steps.append(found.step)
            component[found.step.name] = found.component
            kind = (
                str(archive.variables["programme_step"].values)
                if "programme_step" in archive
                else ""
            )
            is_programme |= kind in CHANGES_LENGTH
        sources.append(hash_source(path, path.name))
    return _Found(tuple(steps), tuple(sources), tuple(missing), is_programme, component)


def _instruments(
    campaign: Campaign, survey: Survey, specimen: str, models: Sequence[StrainModel]
) -> tuple[InstrumentErrors, StrainModel] | tuple[None, None]:
    """Stated instrument errors of a specimen and its strain model; None for weights."""
    errors = instruments_of(campaign, survey, models)
    pairs = zip(errors, models, strict=True)
    return next((pair for pair in pairs if pair[1].specimen == specimen), (None, None))


def _properties_in_one_line(name: str, own: Sequence[ChangeInLength]) -> str:
    known = sum(bool(np.isfinite(one.value)) for one in own)
    return f"{name}: {known} of {len(own)} properties have a number"


def results_found(campaign: Campaign) -> dict[str, Any] | None:
    """Contents of the table of results, as printed by `check`."""
    if campaign.results is None:
        return None
    uses: dict[str, Counter[str]] = {}
    for outcome in campaign.outcomes:
        uses.setdefault(outcome.quantity, Counter())[outcome.use] += 1
    return {
        "file": campaign.results.name,
        "sha256": campaign.results.sha256,
        "outcomes": len(campaign.outcomes),
        "quantities": {
            quantity: {use: count[use] for use in ("value", "lower_bound", "excluded")}
            for quantity, count in uses.items()
        },
        "notes": [str(one) for one in odd_outcomes(campaign.outcomes)],
    }


def _write_outcomes(
    campaign: Campaign, folder: Path, *, command: str, opener: Opener
) -> Path | None:
    """Write the outcomes of a campaign."""
    if campaign.results is None:
        return None
    path = folder / "outcomes.nc"
    named = {outcome.specimen for outcome in campaign.outcomes}
    sheets = {name: asdict(sheet) for name, sheet in campaign.specimens.items() if name in named}
    settings = {"results": campaign.results.name, "specimens": sheets}
    dataset = outcomes_to_dataset(
        campaign.outcomes,
        origin=Origin(
            campaign_id=campaign.id,
            attributes=campaign.attributes,
            sources=(campaign.results,),
            steps=(Step("outcomes", _outcomes_in_one_line(campaign)),),
            settings_json=json.dumps(settings, sort_keys=True, ensure_ascii=False, allow_nan=False),
            version=__version__,
            command=command,
        ),
    )
    keep_written(opener, path, as_kept(write_archive(dataset, path)))
    return path


def _outcomes_in_one_line(campaign: Campaign) -> str:
    counts = Counter(outcome.quantity for outcome in campaign.outcomes)
    listed = ", ".join(f"{number} {quantity}" for quantity, number in counts.items())
    completed = sum(bool(outcome.specimen) for outcome in campaign.outcomes)
    sheets = f"; {completed} rows completed from sheets of specimens" if completed else ""
    return f"read {listed}{sheets}"


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
    values_page: str = "",
    workers: Workers | None = None,
    progress: Progress | None = None,
    opener: Opener | None = None,
) -> CampaignResult:
    """Reduce a campaign to archives, tables, catalogue, status and report.

    No other run may use the same products.  Tests with current archives are left alone, so that an
    interrupted run continues from where it stopped.

    ``workers``: workers for the tests; by default they run one after another in this process.  No
    product depends on it. ``opener``: opens finished archives; by default `ReadOnce`, which reads a
    small one once.
    """
    progress = progress or Silent()
    refuse_unknown_tests(campaign, tests)
    _refuse_name(processed / campaign.id)
    with run_lock(processed / campaign.id) as lock:
        try:
            return _run(
                campaign, processed / campaign.id, reports, lock, clock=clock, tests=tests,
                force=force, command=command, units=units, values_page=values_page,
                workers=workers, progress=progress, opener=opener or ReadOnce(),
            )  # fmt: skip
        except BaseException:
            if workers is not None:  # no one writes after the lock is released
                workers.end()
            raise


def _refuse_name(folder: Path) -> None:
    """Refuse a folder name that netCDF does not support, before anything is reduced."""
    name = str(folder.absolute())
    try:
        name.encode(sys.getfilesystemencoding())
    except UnicodeEncodeError as error:
        raise SettingsError(
            "archives cannot be written to this folder",
            found=f"{name!a}, a name that {error.encoding} cannot represent",
            needed="a path in the character set of this process",
            hint="Rename the folder, or choose another with --processed.",
        ) from error


def _run(
    campaign: Campaign,
    folder: Path,
    reports: Path,
    lock: RunLock,
    *,
    clock: Callable[[], float],
    tests: Sequence[str],
    force: bool,
    command: str,
    units: UnitSystem,
    values_page: str,
    workers: Workers | None,
    progress: Progress,
    opener: Opener,
) -> CampaignResult:
    wanted = find_reduction_inputs(campaign, workers=workers, lock=lock, progress=progress)
    first, basis = wanted.first, wanted.basis
    surveys = first.surveys
    chosen = selected_surveys(surveys, tests)
    statuses = reduce_campaign(
        campaign, first, chosen, errors=wanted.errors, basis=basis, folder=folder,
        workers=workers, lock=lock, progress=progress, clock=clock, force=force,
        command=command,
        written=partial(keep_written, opener),
    )  # fmt: skip
    if workers is not None:
        workers.executor.shutdown()  # frees the memory of the tests for the products of all tests
    lock.confirm()  # before products of all tests are written
    replaced = record_campaign(folder, campaign.path) if archives_of_tests(folder) else None
    failed = {status.test for status in statuses if status.status == "failed"}
    failed |= set(wanted.failed)
    asked = {survey.plan.id for survey in chosen}
    parts, has_lengths = _write_parts(
        campaign,
        folder,
        surveys,
        asked=asked,
        failed=failed,
        basis=basis,
        command=command,
        opener=opener,
    )
    names = [survey.plan.id for survey in surveys]
    # the steps of a failed log are unknown
    unknown = tuple(f"{survey.plan.id}." for survey in surveys if survey.error is not None)
    read = {source.name: source.sha256 for survey in surveys for source in survey.sources}
    # the remaining log data take 0.1 MB a test, which the tables and pages need
    del wanted, first, basis, surveys, chosen
    trim_heap()
    progress.stage("tables", 0)
    ours = [folder / f"{name}.nc" for name in names]
    archives = [path for path in ours if path.exists()]
    report, tables, answers = None, [], ShownAnswers((), (), ())
    rows = _all_rows(folder / "status.csv", names, statuses)
    if statuses:
        write_text_atomically(folder / "status.csv", status_csv(rows))
    keep_details(folder, campaign.report)
    products = requested_products(campaign, folder, has_lengths=has_lengths)
    gone = [path for path in archives_of_tests(folder) if path not in ours]
    gone += [folder / f"{name}.nc" for name in OF_CAMPAIGN if name not in products]
    stray = [path.name for path in gone if path.stem.startswith(unknown)]
    superseded = _put_aside([path for path in gone if path.name not in stray], folder)
    page = CampaignPage(folder, units=units, stray=stray, opener=opener)
    if archives or products:
        entries = CatalogueEntries()

        def each(path: Path, archive: xr.Dataset) -> None:
            entries.add(path, archive)
            page.add(path, archive)

        # each of up to a thousand archives is opened only once for everything made from it
        tables = write_tables(archives, folder / "tables", opener=opener, each=each, **products)
        write_catalogue(
            [*archives, *products.values()], folder / FILE_NAME, entries=entries, opener=opener
        )
        trim_heap()
    if archives or products or statuses:  # if all tests failed, the page states this and the reason
        progress.stage("report", 0)
        made = {one.test for one in statuses if one.status not in ("failed", "no_work")}
        report, found = page.write(
            reports / campaign.id, values_page=values_page,
            unreadable=partial(_keep_pages, [*ours, *products.values()]), only=made,
        )  # fmt: skip
        if made or not statuses:
            answers = _shown(found)
    return CampaignResult(
        tests=tuple(statuses),
        parts=parts,
        processed=folder,
        report=report,
        results=results_found(campaign),
        superseded=tuple(superseded),
        replaced=replaced,
        stray=tuple(stray),
        tables=tuple(tables),
        read=campaign.small_files | read,
        answers=answers,
    )


def _shown(found: CampaignAnswers) -> ShownAnswers:
    """Answers and doubts in printed form."""
    return ShownAnswers(
        [
            ShownTable(
                one.caption,
                list(one.columns),
                list(one.number_columns),
                [[cell.text for cell in row] for row in one.rows],
            )
            for one in found.tables
        ],
        [(", ".join(one.tests), one.text) for one in found.doubts],
        sorted(found.answered),
        found.is_synthetic,
        found.withheld,
    )


def _put_aside(products: Sequence[Path], folder: Path) -> list[Path]:
    """Move products that the campaign no longer makes to where no query reads them."""
    moved = []
    for path in filter(Path.is_file, products):
        target = folder / SUPERSEDED / path.name
        target.parent.mkdir(exist_ok=True)
        path.replace(target)
        moved.append(target)
    return moved


def _keep_pages(ours: Sequence[Path], name: str, why: str) -> None:
    """Keep the older pages if new ones would lack results of the run."""
    for path in ours:
        if path.name == name:
            raise ArchiveError(
                f"{path} cannot be read, and the report is left as it was",
                found=why.removesuffix("."),
                hint="Check the disk, and run again.",
            )


def _write_parts(
    campaign: Campaign,
    folder: Path,
    surveys: Sequence[Survey],
    *,
    asked: set[str],
    failed: set[str],
    basis: Callable[[Survey], Basis],
    command: str,
    opener: Opener,
) -> tuple[dict[str, list[PartStatus]], bool]:
    """Write the campaign-wide archives from those of its up-to-date tests.

    Returns the status of its parts, and whether a rope changed in length.
    """
    runs = {run for plan in campaign.experiments.values() for run in plan.runs}
    compared = {plan.measured for plan in campaign.comparisons.values()}
    needed = runs | compared | _tests_of_ropes(campaign, surveys)
    left_out = [entry for entry in surveys if entry.plan.id in needed - asked - failed]
    waiting = outdated_runs(folder, left_out, basis)
    parts = {}
    parts["experiments"] = write_experiments(
        campaign,
        folder,
        failed=failed,
        waiting=waiting,
        raw_sha256={
            entry.plan.id: "\n".join(source.sha256 for source in entry.sources)
            for entry in surveys
            if entry.plan.id in runs
        },
        command=command,
        opener=opener,
    )
    _write_outcomes(campaign, folder, command=command, opener=opener)
    lengths = _write_change_in_length(
        campaign, folder, surveys, models=lambda survey: basis(survey).models,
        failed=failed, waiting=waiting, command=command, opener=opener,
    )  # fmt: skip
    parts["hoses"] = write_predictions(campaign, folder, command=command, opener=opener)
    parts["comparisons"] = write_comparisons(
        campaign, folder, failed=failed, waiting=waiting, command=command, opener=opener
    )
    return parts, lengths is not None


def _all_rows(path: Path, names: Sequence[str], statuses: Sequence[TestStatus]) -> list[TestStatus]:
    """One row for each test of the campaign; tests not requested keep their old row."""
    new = {status.test: status for status in statuses}
    before = read_status(path) if len(new) < len(names) else {}
    rows = [new.get(name) or before.get(name) for name in names]
    return [row for row in rows if row is not None]
