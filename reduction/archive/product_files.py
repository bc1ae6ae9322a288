"""Which archives a folder of products holds."""

from __future__ import annotations

import os
from pathlib import Path

from reduction.record.errors import ArchiveError

OF_CAMPAIGN = ("surfaces", "predictions", "comparisons", "outcomes", "change_in_length")
"""Archives of a whole campaign, by their file names; no test may be called so."""

SUPERSEDED = "superseded"
"""Folder, beside the archives of a campaign, of those that it no longer makes."""

CLIENT_PAGE_NAME = "client-report.html"
"""Report to a client, beside the page of a campaign."""

DESIGN_PAGE_NAME = "design-values.html"
"""Page of design values, beside the folders of the reports."""


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
