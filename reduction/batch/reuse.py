"""Checks whether the product of an earlier run is still valid: same log, settings and version."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from reduction import __version__
from reduction.archive.dataset_builder import SCHEMA_VERSION, key_of
from reduction.archive.open import variables_if
from reduction.archive.variables import NOTE_VARIABLES, read_notes
from reduction.batch.slow_pulls import origins_of, pull_tests, pulls_of
from reduction.batch.survey import Survey
from reduction.batch.test_history import EarlierTests, history_of, history_remarks, instruments_of
from reduction.campaign.plan import Campaign
from reduction.record.measurement import Floats
from reduction.record.notes import Note
from reduction.stages.reduced_test import History, TestDescription
from reduction.stages.strain.strain_model import StrainModel
from reduction.stages.three_parameter_line.line_product import SlowPull
from reduction.uncertainty.errors_of_cycles import PullOrigin


def describe(campaign: Campaign, survey: Survey) -> TestDescription:
    """Laboratory information on a test."""
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
    """Numbers for JSON, with null for missing ones."""
    return [None if math.isnan(value) else value for value in values.tolist()]


def _strain_document(campaign: Campaign, model: StrainModel) -> dict[str, Any]:
    """A strain model with all inputs of its covariance and of its load-cell errors."""
    document: dict[str, Any] = {
        "method": model.method,
        "coefficients": model.coefficients,
        "by_marks": {} if model.by_marks is None else model.by_marks.coefficients,
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
        # every reading of the specimen: the covariance follows from these exactly
        tape = campaign.marks[model.specimen]
        lengths = (tape.near_toe, tape.far_toe, tape.far_thimble)
        document["tape"] = {
            "standard_uncertainty": tape.reading_uncertainty,
            "splice_creep": tape.splice_creep,
            "readings": [
                list(row) for row in zip(tape.test, tape.hold, *map(_plain, lengths), strict=True)
            ],
        }
    return document


def _settings_json(
    campaign: Campaign,
    survey: Survey,
    models: Sequence[StrainModel],
    history: History | None,
    pulls: Sequence[SlowPull | None] | None = None,
    pull_origins: Sequence[PullOrigin | None] = (),
) -> str:
    """All settings in force, so that a product states how to reproduce it."""
    plan = survey.plan
    document: dict[str, Any] = {
        "description": asdict(describe(campaign, survey)),
        "target_strain": plan.target_strain,
        **({} if plan.step_range is None else {"step_range": plan.step_range}),
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
                "splice_friction": errors.splice_friction,
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
            "splices_slipped_by": _plain(history.splices_slipped_by),
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
                "curve_coefficient": pull.curve_coefficient.tolist(),
                "tension_low": pull.tension_low,
                "tension_high": pull.tension_high,
                "instruments": None if origin is None else asdict(origin.errors),
                "strain": None if origin is None else _strain_document(campaign, origin.model),
            }
            for name, pull, origin in zip(plan.specimens, pulls, read_with, strict=True)
        }
    return json.dumps(document, sort_keys=True, ensure_ascii=False, allow_nan=False)


@dataclass(frozen=True)
class Basis:
    """Current inputs of a test's product; ``settings`` is all of them as JSON.

    ``remarks`` are the open points about the test in the campaign; other tests can cause them.
    """

    history: History | None
    models: tuple[StrainModel, ...]
    pulls: list[SlowPull | None] | None
    pull_origins: tuple[PullOrigin | None, ...]
    settings: str
    remarks: tuple[Note, ...]


def basis_of(
    campaign: Campaign,
    survey: Survey,
    past: EarlierTests,
    *,
    pulls: Mapping[tuple[str, str], SlowPull],
    doubts: Mapping[str, tuple[Note, ...]] | None = None,
) -> Basis:
    """Collect the inputs of one test."""
    history = history_of(survey, past, campaign)
    of_run = pulls_of(campaign, survey, pulls)
    origins = () if of_run is None else origins_of(campaign, survey, past.surveys, past.models)
    names = [(survey.plan.id, specimen) for specimen in survey.plan.specimens]
    of_test = tuple(past.models[name] for name in names if name in past.models)
    remarks = *history_remarks(survey, past, campaign), *(doubts or {}).get(survey.plan.id, ())
    return Basis(
        history=history,
        models=of_test,
        pulls=of_run,
        pull_origins=origins,
        settings=_settings_json(campaign, survey, of_test, history, of_run, origins),
        remarks=tuple(replace(one, stage=_STAGE) for one in remarks),
    )


_STAGE = "campaign"

NOT_REDUCED = "not reduced yet from logs and settings as they stand now"


def reusable_product(
    path: Path, survey: Survey, settings: str, *, remarks: Sequence[Note] = ()
) -> tuple[Note, ...] | None:
    """Notes of a valid product of an earlier run; None if it has to be made."""
    try:
        if not path.exists():
            return None
        wanted = {
            "software_version": __version__,
            "schema_version": SCHEMA_VERSION,
            "test": survey.plan.id,  # another test's product may have been put in its place
            "raw_file_sha256": "\n".join(source.sha256 for source in survey.sources),
            "key": key_of(settings),
        }
        archive = variables_if(path, wanted, NOTE_VARIABLES)
        if archive is None:
            return None
        notes = read_notes(archive)
    except OSError:
        return None  # an unreadable archive is made again
    # other tests have changed since: a remark is missing, or its cause is gone
    now = {str(one) for one in remarks}
    before = {str(one) for one in notes if one.stage == _STAGE}
    return notes if before <= now <= {str(one) for one in notes} else None


def outdated_runs(
    folder: Path, surveys: Sequence[Survey], basis_of: Callable[[Survey], Basis]
) -> set[str]:
    """Runs that have to be reduced before their experiment is fitted."""
    waiting = set()
    for survey in surveys:
        now = basis_of(survey)
        path = folder / f"{survey.plan.id}.nc"
        if reusable_product(path, survey, now.settings, remarks=now.remarks) is None:
            waiting.add(survey.plan.id)
    return waiting
