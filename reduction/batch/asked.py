"""Which archives of the whole campaign it asks for."""

from __future__ import annotations

from pathlib import Path

from reduction.archive.products import OF_CAMPAIGN
from reduction.campaign.plan import Campaign


def parts_asked(campaign: Campaign) -> set[str]:
    """Names of the archives of the whole campaign that its campaign.toml asks for."""
    asked = {
        "surfaces": bool(campaign.experiments),
        "predictions": bool(campaign.hoses),
        "comparisons": bool(campaign.comparisons),
        "outcomes": campaign.results is not None,
    }
    return {name for name, is_asked in asked.items() if is_asked}


def products_asked(campaign: Campaign, folder: Path, *, has_lengths: bool) -> dict[str, Path]:
    """Archives of the whole campaign that it asks for and that are there.

    Parameters
    ----------
    campaign : Campaign
        As loaded.
    folder : pathlib.Path
        Of its products.
    has_lengths : bool
        Whether it has ropes of which change in length is told.

    Returns
    -------
    products : dict of str to pathlib.Path
        By the names of `reduction.archive.products.OF_CAMPAIGN`.
    """
    asked = parts_asked(campaign) | ({"change_in_length"} if has_lengths else set())
    paths = {name: folder / f"{name}.nc" for name in OF_CAMPAIGN if name in asked}
    return {name: path for name, path in paths.items() if path.exists()}
