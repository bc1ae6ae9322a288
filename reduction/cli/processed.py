"""Folders of products that a command is given: one campaign's, or all of them."""

from __future__ import annotations

from pathlib import Path

from reduction.archive.products import archives_in
from reduction.errors import ArchiveError


def processed_folders(processed: Path) -> list[Path]:
    """Folders with archives: the one that is given, or those in it.

    Parameters
    ----------
    processed : pathlib.Path
        ``processed/CAMPAIGN``, or ``processed``.

    Returns
    -------
    folders : list of pathlib.Path
        By name.

    Raises
    ------
    ArchiveError
        If there is no archive.
    OSError
        If a folder cannot be looked into.
    """
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
