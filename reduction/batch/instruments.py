"""What a campaign states of the instruments, for each specimen of a test."""

from __future__ import annotations

from collections.abc import Sequence

from reduction.batch.survey import Survey
from reduction.campaign.plan import Campaign
from reduction.strain.model import StrainModel
from reduction.uncertainty.product import InstrumentErrors

__all__ = ["instruments_of", "stepwise_instruments"]


def instruments_of(
    campaign: Campaign, survey: Survey, models: Sequence[StrainModel]
) -> tuple[InstrumentErrors, ...]:
    """Stated errors of each specimen, with the names by which tests share them.

    Tests share the load cell and the machine that they name in the same words, and a strain
    model that was pooled over the campaign; marks of one test are its own.
    """
    plan = survey.plan
    return tuple(
        campaign.uncertainty.of_channel(
            model.specimen,
            channel=number,
            test=plan.log,
            load_cell=plan.attributes.get("load_cell", ""),
            machine=plan.attributes.get("machine", ""),
            strain_model=f"{model.specimen}, marks of {plan.log}"
            if model.marks_from == "this test"
            else model.specimen,
        )
        for number, model in enumerate(models, start=1)
    )


def stepwise_instruments(campaign: Campaign, survey: Survey) -> tuple[InstrumentErrors, ...]:
    """Stated errors of a test with weights, which has no channels and no strain model."""
    return tuple(
        campaign.uncertainty.of_channel(
            name,
            channel=number,
            test=survey.plan.log,
            load_cell=survey.plan.attributes.get("load_cell", "weights"),
        )
        for number, name in enumerate(survey.plan.specimens, start=1)
    )
