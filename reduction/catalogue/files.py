"""Which archives a folder of products has, and how a changed one is told."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

from reduction.errors import SettingsError

__all__ = ["FileState", "archives_below", "shown_path", "state_of"]


@dataclass(frozen=True)
class FileState:
    """What the file system says of an archive; equal where nobody wrote it since.

    ``changed`` is the time of the last change to the file or to what is known of it, which no
    program sets: a copy that keeps the time of writing is told by it.
    """

    size: int
    modified: int
    changed: int

    def is_written_alike(self, other: FileState) -> bool:
        """Size and time of writing agree."""
        return (self.size, self.modified) == (other.size, other.modified)


def state_of(path: Path) -> FileState:
    """State of one file; `OSError` where there is none."""
    found = path.stat()
    return FileState(found.st_size, found.st_mtime_ns, found.st_ctime_ns)


def shown_path(path: str) -> str:
    r"""A path as text that any file takes: bytes that are no text stand as ``\\xff``.

    Examples
    --------
    >>> shown_path("campaign\udcff/T-1.nc")
    'campaign\\xff/T-1.nc'
    """
    return path.encode("utf-8", "surrogateescape").decode("utf-8", "backslashreplace")


def archives_below(folder: Path) -> dict[str, Path]:
    """Archives of every campaign of a folder of products.

    Parameters
    ----------
    folder : pathlib.Path
        Holds one folder for each campaign.

    Returns
    -------
    archives : dict of str to pathlib.Path
        By what is shown of the path below ``folder``, in order; files and folders whose names
        begin with a dot are left out, since a part of a file that is being written has one.

    Raises
    ------
    SettingsError
        If there is no such folder, or it is that of one campaign.
    """
    if not folder.is_dir():
        raise SettingsError(
            f"there is no folder {shown_path(str(folder))}",
            needed="a folder of processed campaigns",
            hint="Run a campaign first, or name the folder of its products.",
        )
    found: dict[str, Path] = {}
    with os.scandir(folder) as entries:
        campaigns = [one for one in entries if not one.name.startswith(".")]
    for campaign in campaigns:
        if campaign.is_file() and campaign.name.endswith(".nc"):
            raise SettingsError(
                f"{shown_path(str(folder))} is the folder of one campaign",
                found=f"the archive {shown_path(campaign.name)}",
                needed="the folder above it, which holds the campaigns",
                hint="To see one of them, use --campaign.",
            )
        if campaign.is_dir():
            with os.scandir(campaign) as entries:
                found |= {
                    shown_path(f"{campaign.name}/{one.name}"): Path(one.path)
                    for one in entries
                    if one.name.endswith(".nc") and not one.name.startswith(".")
                }
    return dict(sorted(found.items()))
