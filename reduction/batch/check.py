"""What a campaign holds, without a product of it: which tests are asked for and can be reduced."""

from __future__ import annotations

from collections.abc import Sequence

from reduction.batch.firstpass import survey_campaign
from reduction.batch.models import fit_strain_models
from reduction.batch.outcome import status_row
from reduction.batch.progress import Progress
from reduction.batch.status import TestStatus
from reduction.batch.survey import Survey
from reduction.campaign.plan import Campaign
from reduction.errors import SettingsError
from reduction.strain.model import StrainModel


def refuse_unknown_tests(campaign: Campaign, tests: Sequence[str]) -> None:
    """Refuse names that are of no test and of no step, before anything is read or written."""
    known = set(campaign.tests)
    known |= {step.product(name) for name, plan in campaign.tests.items() for step in plan.steps}
    unknown = sorted(set(tests) - known)
    if unknown:
        raise SettingsError(
            "--test names a test that the campaign lacks",
            found=", ".join(unknown),
            needed="one of " + ", ".join(sorted(known)),
        )


def selected_surveys(surveys: Sequence[Survey], tests: Sequence[str]) -> list[Survey]:
    """The surveys that were asked for; a test's name stands for all its steps."""
    if not tests:
        return list(surveys)
    return [
        survey
        for survey in surveys
        if survey.plan.id in tests or survey.plan.id.rpartition(".")[0] in tests
    ]


def check_campaign(
    campaign: Campaign, *, tests: Sequence[str] = (), progress: Progress | None = None
) -> tuple[list[TestStatus], dict[tuple[str, str], StrainModel]]:
    """Read and validate everything, write nothing.

    Parameters
    ----------
    campaign : Campaign
        As loaded.
    tests : sequence of str
        Only these; all where empty.
    progress : Progress, optional
        Told of each log.

    Returns
    -------
    statuses : list of TestStatus
        ``no_work`` (nothing was reduced) or ``failed``.
    models : dict of (test, specimen) to StrainModel
        How position would become strain.
    """
    refuse_unknown_tests(campaign, tests)
    surveys = survey_campaign(campaign, progress=progress).surveys
    models, errors = fit_strain_models(campaign, surveys)
    statuses = []
    for survey in selected_surveys(surveys, tests):
        error = survey.error or errors.get(survey.plan.id)
        statuses.append(
            status_row(campaign, survey, "no_work", message="ready for a run")
            if error is None
            else status_row(campaign, survey, "failed", error=error)
        )
    return statuses, models
