"""Small texts that a campaign is made of: campaign.toml and its tables, read whole."""

from __future__ import annotations

from pathlib import Path

from reduction.errors import LogError
from reduction.ingest.limits import check_regular

_LARGEST = 16_000_000  # bytes; a campaign of 10^5 tests has a third of it


def read_small_text(path: Path) -> str:
    """Text of a small file, in UTF-8 with or without a byte-order mark.

    Parameters
    ----------
    path : pathlib.Path
        The file.

    Returns
    -------
    text : str
        With its line ends.

    Raises
    ------
    LogError
        If it is no regular file (a pipe may never end), or too large to be kept by a person.
    OSError, UnicodeDecodeError
        If it cannot be read, or is no such text.
    """
    status = path.stat()
    check_regular(path, status.st_mode)
    if status.st_size > _LARGEST:
        raise LogError(
            path,
            "the file is too large to be a table or a campaign",
            found=f"{status.st_size:,} bytes",
            needed=f"{_LARGEST:,} bytes at most",
        )
    return path.read_bytes().decode("utf-8-sig")
