"""What the product of one test rests on beside its log: history, models, slow pulls, settings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from reduction.batch.describe import settings_json
from reduction.batch.history import Past, history_of, history_remarks
from reduction.batch.pulls import origins_of, pulls_of
from reduction.batch.survey import Survey
from reduction.campaign.plan import Campaign
from reduction.line.product import SlowPull
from reduction.pipeline.shared.pulls import PullOrigin
from reduction.product import History
from reduction.strain.model import StrainModel


@dataclass(frozen=True)
class Basis:
    """What a test's product rests on now; ``settings`` is all of it as JSON.

    ``remarks`` is what the campaign leaves open about the test.
    """

    history: History | None
    models: tuple[StrainModel, ...]
    pulls: list[SlowPull | None] | None
    pull_origins: tuple[PullOrigin | None, ...]
    settings: str
    remarks: tuple[str, ...]


def basis_of(
    campaign: Campaign,
    survey: Survey,
    past: Past,
    *,
    pulls: Mapping[tuple[str, str], SlowPull],
) -> Basis:
    """Gather what one test rests on.

    Parameters
    ----------
    campaign : Campaign
        As loaded.
    survey : Survey
        The test.
    past : Past
        All tests of the campaign, with their models.
    pulls : mapping of (test, specimen) to SlowPull
        Every slow pull that an experiment names.

    Returns
    -------
    basis : Basis
        As it stands in this run.
    """
    history = history_of(survey, past, campaign)
    of_run = pulls_of(campaign, survey, pulls)
    origins = () if of_run is None else origins_of(campaign, survey, past.surveys, past.models)
    names = [(survey.plan.id, specimen) for specimen in survey.plan.specimens]
    of_test = tuple(past.models[name] for name in names if name in past.models)
    return Basis(
        history=history,
        models=of_test,
        pulls=of_run,
        pull_origins=origins,
        settings=settings_json(campaign, survey, of_test, history, of_run, origins),
        remarks=history_remarks(survey, past, campaign),
    )
