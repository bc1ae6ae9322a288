"""What the products of a campaign would be made from now, before any is made."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from reduction.batch.basis import Basis, basis_of
from reduction.batch.executor import Workers
from reduction.batch.firstpass import FirstPass, survey_campaign
from reduction.batch.history import past_of
from reduction.batch.lock import RunLock
from reduction.batch.models import fit_strain_models
from reduction.batch.progress import Progress
from reduction.batch.pulls import fit_pulls
from reduction.batch.survey import Survey
from reduction.campaign.plan import Campaign
from reduction.errors import ReductionError


@dataclass(frozen=True)
class Wanted:
    """The tests after the first pass, and what the product of each rests on.

    ``errors`` are of tests whose log was read and that cannot be reduced all the same, ``failed``
    all that cannot.
    """

    first: FirstPass
    errors: dict[str, ReductionError]
    failed: tuple[str, ...]
    basis: Callable[[Survey], Basis]


def find_wanted(
    campaign: Campaign,
    *,
    workers: Workers | None = None,
    lock: RunLock | None = None,
    progress: Progress,
) -> Wanted:
    """Read every log of a campaign, and fit what its tests share.

    Parameters
    ----------
    campaign : Campaign
        As loaded.
    workers : Workers, optional
        Where it is done; in this process where left out.
    lock : RunLock, optional
        That the run holds.
    progress : Progress
        Told of each log.

    Returns
    -------
    wanted : Wanted
        A test that fails carries its error; the others are looked at all the same.
    """
    first = survey_campaign(campaign, workers=workers, lock=lock, progress=progress)
    return wanted_of(campaign, first, workers=workers, progress=progress)


def wanted_of(
    campaign: Campaign,
    first: FirstPass,
    *,
    workers: Workers | None = None,
    progress: Progress,
) -> Wanted:
    """Fit what tests share whose logs are read."""
    models, errors = fit_strain_models(campaign, first.surveys)
    pulls, errors_of_pulls = fit_pulls(campaign, first, models, workers=workers, progress=progress)
    errors |= errors_of_pulls
    failed = [entry.plan.id for entry in first.surveys if entry.error or entry.plan.id in errors]
    basis = partial(basis_of, campaign, past=past_of(first.surveys, models), pulls=pulls)
    return Wanted(first, errors, tuple(failed), basis)
