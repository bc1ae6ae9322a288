"""The hoses of a campaign as the product ``predictions.nc``."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from reduction import __version__
from reduction.archive.predictions import predictions_to_dataset
from reduction.archive.write import write_archive
from reduction.batch.part import PartStatus
from reduction.campaign.plan import Campaign
from reduction.errors import ReductionError
from reduction.ingest.source import hash_source
from reduction.pipeline.prediction import predict_from_plan
from reduction.prediction import HosePlan, PredictedHose
from reduction.provenance import Origin, Source, Step


def write_predictions(campaign: Campaign, folder: Path, *, command: str) -> list[PartStatus]:
    """Predict the hoses of a campaign, and write them as one archive.

    Parameters
    ----------
    campaign : Campaign
        As loaded; nothing is written where it has no hoses.
    folder : pathlib.Path
        Of its products.
    command : str
        For the product's ``command`` attribute, without paths.

    Returns
    -------
    statuses : list of PartStatus
        One a hose, in the order of the campaign.

    Raises
    ------
    ArchiveError
        If the archive cannot be written.
    """
    hoses, statuses = [], []
    for plan in campaign.hoses.values():
        try:
            hose = predict_from_plan(plan)
        except ReductionError as error:
            text = f"hose '{plan.name}': {error}"
            statuses.append(PartStatus(plan.name, "failed", error.exit_status, text))
            continue
        hoses.append(hose)
        status = "predicted_with_notes" if hose.notes else "predicted"
        message = "; ".join([_in_one_line(hose), *hose.notes[:1]])
        statuses.append(PartStatus(plan.name, status, 0, message))
    if hoses:
        write_hoses(
            hoses,
            folder / "predictions.nc",
            campaign_id=campaign.id,
            attributes=campaign.attributes,
            source=hash_source(campaign.path, campaign.path.name),
            command=command,
        )
    return statuses


def write_hoses(
    hoses: Sequence[PredictedHose],
    path: Path,
    *,
    campaign_id: str,
    attributes: Mapping[str, str],
    source: Source,
    command: str,
) -> None:
    """Write predicted hoses as one archive.

    Parameters
    ----------
    hoses : sequence of PredictedHose
        One or more.
    path : pathlib.Path
        The archive.
    campaign_id : str
        For its ``id``.
    attributes : mapping of str to str
        What there is to say of them together.
    source : Source
        The file that says how they are made.
    command : str
        For the product's ``command`` attribute, without paths.

    Raises
    ------
    ArchiveError
        If the archive cannot be written.
    """
    settings = {hose.plan.name: settings_of_hose(hose.plan) for hose in hoses}
    dataset = predictions_to_dataset(
        hoses,
        origin=Origin(
            campaign_id=campaign_id,
            attributes=attributes,
            sources=[source],
            steps=[Step("predict", _in_one_line(hose)) for hose in hoses],
            settings_json=json.dumps(settings, sort_keys=True, ensure_ascii=False),
            version=__version__,
            command=command,
        ),
    )
    write_archive(dataset, path)


def settings_of_hose(plan: HosePlan) -> dict[str, Any]:
    """Every number of a plan, in SI, for JSON.

    Parameters
    ----------
    plan : HosePlan
        As read.

    Returns
    -------
    settings : dict
        None where a number is not stated.
    """
    found: dict[str, Any] = _plain(asdict(plan))
    return found


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _plain(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(entry) for entry in value]
    if isinstance(value, np.ndarray):
        return _plain(value.tolist())
    return None if isinstance(value, float) and np.isnan(value) else value


def _in_one_line(hose: PredictedHose) -> str:
    design, events = hose.plan.design, hose.events
    return (
        f"{hose.plan.name}: {np.degrees(float(design.wrap_angle)):.4g} deg, {design.rubber_law} "
        f"rubber, cords pick up at {100 * float(events.pick_up.strain):.4g} %, working load "
        f"{float(events.working.tension):.4g} N at {100 * float(events.working.strain):.4g} %"
    )
