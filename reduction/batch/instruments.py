"""What a campaign states of the instruments, for each specimen of a test."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from reduction.batch.survey import Survey
from reduction.campaign.plan import Campaign
from reduction.record import Specimen
from reduction.strain.model import StrainModel
from reduction.uncertainty.product import InstrumentErrors


def instruments_of(
    campaign: Campaign, survey: Survey, models: Sequence[StrainModel]
) -> tuple[InstrumentErrors, ...]:
    """Stated errors of each specimen, with the names by which tests share them.

    Tests share the load cell and the machine that they name in the same words, and the strain
    model of a specimen where it is of one method and of marks pooled over the campaign; what
    rests on marks of one test is its own.  A diameter of which nothing is stated has the scatter
    of its readings.
    """
    plan = survey.plan
    return tuple(
        _with_readings(
            campaign.uncertainty.of_channel(
                model.specimen,
                channel=number,
                test=plan.log,
                load_cell=plan.attributes.get("load_cell", ""),
                machine=plan.attributes.get("machine", ""),
                strain_model=_name_of(model, plan.log),
            ),
            campaign.specimens[model.specimen],
        )
        for number, model in enumerate(models, start=1)
    )


def stepwise_instruments(campaign: Campaign, survey: Survey) -> tuple[InstrumentErrors, ...]:
    """Stated errors of a test with weights, which has no channels and no strain model."""
    return tuple(
        _with_readings(
            campaign.uncertainty.of_channel(
                name,
                channel=number,
                test=survey.plan.log,
                load_cell=survey.plan.attributes.get("load_cell", "weights"),
            ),
            campaign.specimens[name],
        )
        for number, name in enumerate(survey.plan.specimens, start=1)
    )


def _name_of(model: StrainModel, log: str) -> str:
    """Name of a strain model: models that differ in their coefficients have names that differ."""
    # constant-fraction has the relaxed length of its own slack row, wherever its share is from
    has_own_length = model.method == "constant-fraction" and log in model.mark_test
    is_own = model.marks_from == "this test" or has_own_length
    return f"{model.specimen}, {model.method}" + (f", marks of {log}" if is_own else "")


def _with_readings(errors: InstrumentErrors, specimen: Specimen) -> InstrumentErrors:
    """Give a diameter of which nothing is stated what its readings say of their mean."""
    scatter = specimen.diameter_scatter
    if errors.diameter or not np.isfinite(scatter) or scatter == 0:
        return errors
    return replace(errors, diameter=scatter, diameter_readings=len(specimen.diameter))
