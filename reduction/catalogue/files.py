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
        begin with a dot are left out, since a part of a file that is being written has one. A
        folder that is closed to this user stands for its archives.

    Raises
    ------
    SettingsError
        If there is no such folder, it cannot be read, or it is that of one campaign.
    """
    if not folder.is_dir():
        raise SettingsError(
            f"there is no folder {shown_path(str(folder))}",
            needed="a folder of processed campaigns",
            hint="Run a campaign first, or name the folder of its products.",
        )
    found: dict[str, Path] = {}
    try:
        with os.scandir(folder) as entries:
            campaigns = [one for one in entries if not one.name.startswith(".")]
    except OSError as error:
        raise SettingsError(
            f"the folder {shown_path(str(folder))} cannot be read",
            found=error.strerror or str(error),
            needed="a folder of processed campaigns",
        ) from error
    for campaign in campaigns:
        if campaign.name.endswith(".nc") and Path(campaign.path).is_file():
            raise SettingsError(
                f"{shown_path(str(folder))} is the folder of one campaign",
                found=f"the archive {shown_path(campaign.name)}",
                needed="the folder above it, which holds the campaigns",
                hint="To see one of them, use --campaign.",
            )
        found |= _archives_of(campaign)
    return dict(sorted(found.items()))


def _archives_of(campaign: os.DirEntry[str]) -> dict[str, Path]:
    """Archives of one folder; the folder itself where this user may not look into it."""
    try:
        if not campaign.is_dir():
            return {}
        with os.scandir(campaign) as entries:
            return {
                shown_path(f"{campaign.name}/{one.name}"): Path(one.path)
                for one in entries
                if one.name.endswith(".nc") and not one.name.startswith(".")
            }
    except PermissionError:
        return {shown_path(campaign.name): Path(campaign.path)}
    except OSError:
        return {}  # went away since its name was read, or is a link to itself
