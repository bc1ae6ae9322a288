"""Which archives a folder of products holds."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path

from reduction.archive.atomic_write import atomic_file
from reduction.record.errors import ArchiveError

OF_CAMPAIGN = ("surfaces", "predictions", "comparisons", "outcomes", "change_in_length")
"""Archives of a whole campaign, by their file names; no test may be called so."""

SUPERSEDED = "superseded"
"""Folder, beside the archives of a campaign, of those that it no longer makes."""

CLIENT_PAGE_NAME = "client-report.html"
"""Report to a client, beside the page of a campaign."""

DESIGN_PAGE_NAME = "design-values.html"
"""Page of design values, beside the folders of the reports."""


CAMPAIGN_PLACE = ".campaign"
"""File, beside the archives of a campaign, that says where the campaign.toml of the last run is."""


def campaign_of(folder: Path) -> Path | None:
    """Where the campaign.toml that made a folder of archives was; None where it does not say."""
    try:
        text = (folder / CAMPAIGN_PLACE).read_text(encoding="utf-8").strip()
    except (OSError, ValueError):
        return None
    # by the folder, so that both may be moved together
    return Path(os.path.normpath(folder.absolute() / text)) if text else None


def record_campaign(folder: Path, campaign: Path) -> None:
    """Say in a folder of archives which campaign.toml made them."""
    try:
        place = os.path.relpath(campaign.absolute(), folder.absolute())
    except ValueError:  # another drive
        place = str(campaign.absolute())
    if campaign_of(folder) == Path(os.path.normpath(folder.absolute() / place)):
        return
    # without it the archives are as good, and the campaign is found where it lies by habit
    with suppress(OSError), atomic_file(folder / CAMPAIGN_PLACE) as begun:
        begun.write_text(Path(place).as_posix() + "\n", encoding="utf-8")


def archives_in(folder: Path) -> list[Path]:
    """All archives in a folder, by name; `OSError` where the system refuses it."""
    try:
        names = os.listdir(folder)
    except (FileNotFoundError, NotADirectoryError):
        return []
    # a folder that may not be read is no empty one, as `Path.glob` has it
    return [folder / name for name in sorted(names) if name.endswith(".nc")]


def processed_folders(processed: Path) -> list[Path]:
    """Folders with archives: the one that is given, or those in it."""
    inside = sorted(processed.iterdir()) if processed.is_dir() else []
    folders = [processed] if archives_in(processed) else [one for one in inside if one.is_dir()]
    folders = [folder for folder in folders if archives_in(folder)]
    if not folders:
        raise ArchiveError(
            f"{processed}: no archive was found",
            needed="a folder processed/CAMPAIGN with *.nc in it",
            hint="`reduction run CAMPAIGN.toml` makes one.",
        )
    return folders


def archives_of_tests(folder: Path) -> list[Path]:
    """Archives of reduced tests in a folder, by name; `OSError` where the system refuses it."""
    return [path for path in archives_in(folder) if path.stem not in OF_CAMPAIGN]
