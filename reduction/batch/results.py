"""Outcomes without a log as the product ``outcomes.nc``."""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import asdict
from pathlib import Path
from typing import Any

from reduction import __version__
from reduction.archive.outcomes import outcomes_to_dataset
from reduction.archive.write import write_archive
from reduction.campaign.plan import Campaign
from reduction.provenance import Origin, Step


def results_found(campaign: Campaign) -> dict[str, Any] | None:
    """What the table of results holds, as `check` prints it.

    Parameters
    ----------
    campaign : Campaign
        As loaded.

    Returns
    -------
    found : dict or None
        File, hash, and by quantity how many rows there are of each use; None without results.
    """
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
    }


def write_outcomes(campaign: Campaign, folder: Path, *, command: str) -> Path | None:
    """Write the outcomes of a campaign.

    Parameters
    ----------
    campaign : Campaign
        As loaded.
    folder : pathlib.Path
        Of its products.
    command : str
        For the product's ``command`` attribute, without paths.

    Returns
    -------
    path : pathlib.Path or None
        ``outcomes.nc``; None where the campaign has no results.

    Raises
    ------
    ArchiveError
        If it cannot be written.
    """
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
            steps=(Step("outcomes", _in_one_line(campaign)),),
            settings_json=json.dumps(settings, sort_keys=True, ensure_ascii=False, allow_nan=False),
            version=__version__,
            command=command,
        ),
    )
    write_archive(dataset, path)
    return path


def _in_one_line(campaign: Campaign) -> str:
    counts = Counter(outcome.quantity for outcome in campaign.outcomes)
    listed = ", ".join(f"{number} {quantity}" for quantity, number in counts.items())
    completed = sum(bool(outcome.specimen) for outcome in campaign.outcomes)
    sheets = f"; {completed} rows completed from sheets of specimens" if completed else ""
    return f"read {listed}{sheets}"
