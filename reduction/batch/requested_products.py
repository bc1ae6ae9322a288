"""Finds the products that a campaign requests."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from reduction.archive.product_files import OF_CAMPAIGN
from reduction.batch.campaign_status import Progress, TestStatus
from reduction.batch.plausibility import implausible
from reduction.batch.reuse import Basis, basis_of
from reduction.batch.run_lock import RunLock
from reduction.batch.slow_pulls import fit_pulls
from reduction.batch.survey import FirstPass, Survey, status_row, survey_campaign
from reduction.batch.test_history import earlier_tests_of, fit_strain_models
from reduction.batch.workers import Workers
from reduction.campaign.plan import Campaign
from reduction.record.errors import ReductionError, SettingsError
from reduction.record.notes import note_message
from reduction.stages.strain.strain_model import StrainModel
from reduction.stages.strain.stress import check_constant_volume


def requested_parts(campaign: Campaign) -> set[str]:
    """Names of the campaign-wide archives requested by campaign.toml."""
    asked = {
        "surfaces": bool(campaign.experiments),
        "predictions": bool(campaign.hoses),
        "comparisons": bool(campaign.comparisons),
        "outcomes": campaign.results is not None,
    }
    return {name for name, is_asked in asked.items() if is_asked}


def requested_products(campaign: Campaign, folder: Path, *, has_lengths: bool) -> dict[str, Path]:
    """Requested campaign-wide archives that exist."""
    asked = requested_parts(campaign) | ({"change_in_length"} if has_lengths else set())
    paths = {name: folder / f"{name}.nc" for name in OF_CAMPAIGN if name in asked}
    return {name: path for name, path in paths.items() if path.exists()}


@dataclass(frozen=True)
class ReductionInputs:
    """The tests after the first pass, and the inputs of each product.

    ``errors`` are those of tests that were read but cannot be reduced; ``failed`` are all that
    cannot.
    """

    first: FirstPass
    errors: dict[str, ReductionError]
    failed: tuple[str, ...]
    basis: Callable[[Survey], Basis]


def find_reduction_inputs(
    campaign: Campaign,
    *,
    workers: Workers | None = None,
    lock: RunLock | None = None,
    progress: Progress,
) -> ReductionInputs:
    """Read every log of a campaign, and fit the models shared by its tests."""
    first = survey_campaign(campaign, workers=workers, lock=lock, progress=progress)
    return reduction_inputs(campaign, first, workers=workers, progress=progress)


def reduction_inputs(
    campaign: Campaign,
    first: FirstPass,
    *,
    workers: Workers | None = None,
    progress: Progress,
) -> ReductionInputs:
    """Fit the models shared by tests whose logs are read."""
    models, errors = fit_strain_models(campaign, first.surveys)
    pulls, errors_of_pulls = fit_pulls(campaign, first, models, workers=workers, progress=progress)
    errors |= errors_of_pulls
    failed = [entry.plan.id for entry in first.surveys if entry.error or entry.plan.id in errors]
    basis = partial(
        basis_of, campaign, past=earlier_tests_of(first.surveys, models), pulls=pulls,
        doubts=implausible(campaign, first.surveys, models),
    )  # fmt: skip
    return ReductionInputs(first, errors, tuple(failed), basis)


def refuse_unknown_tests(campaign: Campaign, tests: Sequence[str]) -> None:
    """Refuse unknown names of tests and steps before anything is read or written."""
    known = set(campaign.tests)
    known |= {step.product(name) for name, plan in campaign.tests.items() for step in plan.steps}
    # a level found in a log is named after the log
    unstated = {name for name, plan in campaign.tests.items() if not plan.steps}
    unknown = sorted(name for name in set(tests) - known if name.rpartition(".")[0] not in unstated)
    if unknown:
        raise SettingsError(
            "--test names a test that the campaign lacks",
            found=", ".join(unknown),
            needed="one of " + ", ".join(sorted(known)),
        )


def selected_surveys(surveys: Sequence[Survey], tests: Sequence[str]) -> list[Survey]:
    """The requested surveys; the name of a test selects all its steps."""
    if not tests:
        return list(surveys)
    missing = set(tests) - {survey.plan.id for survey in surveys}
    missing -= {survey.plan.log for survey in surveys}
    of_log = {survey.plan.log for survey in surveys if survey.error is None}
    for name in sorted(missing):
        if name.rpartition(".")[0] in of_log:
            raise SettingsError(
                "--test names a level that was not found in its log",
                found=name,
                needed="one of " + ", ".join(survey.plan.id for survey in surveys),
            )
    return [survey for survey in surveys if {survey.plan.id, survey.plan.log} & set(tests)]


def _ready(survey: Survey, models: Mapping[tuple[str, str], StrainModel]) -> str:
    """Message that a test can be reduced, with its most serious note so far."""
    known = [replace(one, stage="ingest") for one in survey.notes]
    for name in survey.plan.specimens:
        model = models.get((survey.plan.id, name))
        if model is not None:
            known += [replace(one, stage=f"strain {name}") for one in model.notes]
    # for levels that were found, how to state them
    levels = [one for one in survey.remarks if one.code in ("levels-found", "cycles-unlike")]
    told = {str(one) for one in levels}
    other = [one for one in known if str(one) not in told]
    return "; ".join(["ready for a run", *map(str, levels), *filter(None, [note_message(other)])])


def check_campaign(
    campaign: Campaign, *, tests: Sequence[str] = (), progress: Progress | None = None
) -> tuple[list[TestStatus], dict[tuple[str, str], StrainModel]]:
    """Read and validate everything, write nothing."""
    refuse_unknown_tests(campaign, tests)
    surveys = survey_campaign(campaign, progress=progress).surveys
    models, errors = fit_strain_models(campaign, surveys)
    statuses = []
    doubts = implausible(campaign, surveys, models)
    for survey in selected_surveys(surveys, tests):
        survey.notes += doubts.get(survey.plan.id, ())
        for name in survey.plan.specimens:
            survey.notes += check_constant_volume(campaign.specimens[name])
        survey.found.get("notes", []).extend(map(str, doubts.get(survey.plan.id, ())))
        error = survey.error or errors.get(survey.plan.id)
        statuses.append(
            status_row(campaign, survey, "no_work", message=_ready(survey, models))
            if error is None
            else status_row(campaign, survey, "failed", error=error)
        )
    return statuses, models
