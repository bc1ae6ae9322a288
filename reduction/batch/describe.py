"""What goes with a product: the laboratory's words, and every setting that was in force."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from reduction.batch.instruments import instruments_of
from reduction.batch.pulls import pull_tests
from reduction.batch.survey import Survey
from reduction.campaign.plan import Campaign
from reduction.line.product import SlowPull
from reduction.pipeline.shared.pulls import PullOrigin
from reduction.product import History, TestDescription
from reduction.record import Floats
from reduction.strain.model import StrainModel


def describe(campaign: Campaign, survey: Survey) -> TestDescription:
    """What the laboratory kept about a test."""
    plan = survey.plan
    attributes = campaign.attributes | plan.attributes
    if plan.part_of is not None:
        attributes["part_of"] = plan.part_of
    if plan.failed is not None:
        attributes["failed"] = "yes" if plan.failed else "no"
    if plan.target_strain:
        attributes["target_strain"] = " to ".join(f"{value:g}" for value in plan.target_strain)
    return TestDescription(
        campaign_id=campaign.id,
        test_id=plan.id,
        kind=plan.kind,
        control=plan.control,
        waveform=plan.waveform,
        order=plan.order,
        attributes=attributes,
        failed=plan.failed,
    )


def _plain(values: Floats) -> list[float | None]:
    """Numbers as JSON has them: a missing one is null."""
    return [None if math.isnan(value) else value for value in values.tolist()]


def _strain_document(campaign: Campaign, model: StrainModel) -> dict[str, Any]:
    """A strain model, and all that its covariance and the errors of its load cells follow from."""
    document: dict[str, Any] = {
        "method": model.method,
        "coefficients": model.coefficients,
        "splice_law": model.splice_law,
        "marks": [
            list(row)
            for row in zip(
                model.mark_test,
                model.mark_hold,
                _plain(model.mark_position),
                _plain(model.mark_tension),
                model.mark_load_cell or (None,) * len(model.mark_test),
                strict=True,
            )
        ],
    }
    if model.mark_test:
        # every reading of the specimen: the covariance has no digit that these do not give again
        tape = campaign.marks[model.specimen]
        lengths = (tape.near_toe, tape.far_toe, tape.far_thimble)
        document["tape"] = {
            "standard_uncertainty": tape.reading_uncertainty,
            "readings": [
                list(row) for row in zip(tape.test, tape.hold, *map(_plain, lengths), strict=True)
            ],
        }
    return document


def settings_json(
    campaign: Campaign,
    survey: Survey,
    models: Sequence[StrainModel],
    history: History | None,
    pulls: Sequence[SlowPull | None] | None = None,
    pull_origins: Sequence[PullOrigin | None] = (),
) -> str:
    """Every setting that was in force, so that a product says how it can be made again."""
    plan = survey.plan
    document: dict[str, Any] = {
        "description": asdict(describe(campaign, survey)),
        "target_strain": plan.target_strain,
        "reduction": asdict(plan.settings),
        "uncertainty": asdict(campaign.uncertainty),
        "layouts": {
            layout: campaign.layouts[layout].model_dump(exclude_defaults=True)
            for _, layout in plan.files
        },
        "specimens": {name: asdict(campaign.specimens[name]) for name in plan.specimens},
        "strain": {model.specimen: _strain_document(campaign, model) for model in models},
        "instruments": {
            errors.specimen: {
                "tension": errors.tension_instrument,
                "crosshead_position": errors.position_instrument,
            }
            for errors in instruments_of(campaign, survey, models)
        },
        "history": None
        if history is None
        else {
            "earlier_tests": history.earlier_tests,
            "earlier_maximum_strain": _plain(history.earlier_maximum_strain),
            "earlier_maximum_tension": _plain(history.earlier_maximum_tension),
            "earlier_cycles": _plain(history.earlier_cycles),
            "permanent_set": _plain(history.permanent_set),
            **(
                {}
                if history.earlier_flex_cycles is None
                else {"earlier_flex_cycles": _plain(history.earlier_flex_cycles)}
            ),
        },
    }
    if pulls is not None:
        test_of = pull_tests(campaign, plan.id)
        read_with = pull_origins or (None,) * len(pulls)
        document["quasi_static"] = {
            name: None
            if pull is None
            else {
                "test": test_of[name],
                "strain_coefficient": pull.strain_coefficient.tolist(),
                "tension_low": pull.tension_low,
                "tension_high": pull.tension_high,
                "instruments": None if origin is None else asdict(origin.errors),
                "strain": None if origin is None else _strain_document(campaign, origin.model),
            }
            for name, pull, origin in zip(plan.specimens, pulls, read_with, strict=True)
        }
    return json.dumps(document, sort_keys=True, ensure_ascii=False, allow_nan=False)
