"""The campaign.toml of a folder of products: archives say which campaign, but not where it lies."""

from __future__ import annotations

import tomllib
from pathlib import Path

from reduction.archive.open import reading
from reduction.archive.products import archives_of_tests
from reduction.campaign.textfiles import read_small_text
from reduction.errors import ArchiveError, SettingsError


def id_of_products(processed: Path) -> str:
    """Id of the campaign whose archives lie in a folder.

    Raises
    ------
    ArchiveError
        If there is none, or the first cannot be read.
    SettingsError
        If it is a folder of several campaigns.
    """
    archives = archives_of_tests(processed) if processed.is_dir() else []
    if archives:
        with reading(archives[0]) as archive:
            return str(archive.attrs.get("campaign", ""))
    folders = sorted(processed.iterdir()) if processed.is_dir() else []
    inside = [one.name for one in folders if archives_of_tests(one)]
    if inside:
        raise SettingsError(
            f"{processed} holds a folder for each campaign", found=", ".join(inside),
            needed=f"one of them, such as {processed / inside[0]}",
        )  # fmt: skip
    raise ArchiveError(
        f"there is no archive of a test in {processed}",
        needed="the folder of a campaign, such as processed/CAMPAIGN",
        hint="Run the campaign first.",
    )


def find_campaign(processed: Path, stated: Path | None = None, *, name: str = "") -> Path:
    """Find the campaign.toml that a folder of archives was made from.

    It is looked for where it lies by habit: ``raw/ID/campaign.toml`` and ``ID/campaign.toml``,
    beside ``processed`` and in the working folder.

    Parameters
    ----------
    processed : pathlib.Path
        ``processed/CAMPAIGN``.
    stated : pathlib.Path, optional
        Where the user says that it is.
    name : str, optional
        Id of the campaign; that of the first archive where left out.

    Returns
    -------
    path : pathlib.Path
        Of a campaign of that id.

    Raises
    ------
    SettingsError
        If it is not found, or is another campaign.
    ArchiveError
        If there are no archives.
    """
    name = name or id_of_products(processed)
    if stated is not None:
        found = _id_of(stated)
        if found != name:
            raise SettingsError(
                f"{stated} is not the campaign of {processed}",
                found="no campaign.toml" if found is None else f"campaign '{found}'",
                needed=f"campaign '{name}'",
            )
        return stated
    above = processed.absolute().parent.parent
    places = [
        root / folder / name / "campaign.toml"
        for root in (above, Path.cwd())
        for folder in ("raw", "")
    ]
    for path in dict.fromkeys(places):
        if _id_of(path) == name:
            return path
    raise SettingsError(
        f"the campaign.toml of '{name}' is not where it is looked for",
        found="none at " + " or ".join(str(path) for path in dict.fromkeys(places)),
        needed="--campaign CAMPAIGN.toml",
        hint="An archive keeps what its numbers were made with, and no path.",
    )


def _id_of(path: Path) -> str | None:
    """Id that a campaign.toml states; None of a file that is none."""
    try:
        document = tomllib.loads(read_small_text(path))
        return str(document["campaign"]["id"])
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return None
