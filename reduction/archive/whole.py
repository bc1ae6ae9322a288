"""Files that appear whole or not at all."""

from __future__ import annotations

import os
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

__all__ = ["whole_file"]


@contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """Give a temporary name beside ``path``; when the block ends well it becomes ``path``.

    If the block or the disk fails, ``path`` is what it was before, and nothing else is left.

    Parameters
    ----------
    path : pathlib.Path
        Name that the file is to have; its folder is made where it is not there.

    Yields
    ------
    part : pathlib.Path
        Where to write.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    # workers on two machines may have one number
    part = path.with_name(f".{path.name}.{os.getpid()}-{uuid.uuid4().hex[:8]}.part")
    try:
        yield part
        with part.open("rb+") as file:
            os.fsync(file.fileno())
        part.replace(path)
        _flush_folder(path.parent)
    finally:
        part.unlink(missing_ok=True)


def _flush_folder(folder: Path) -> None:
    """Put the new name on the disk; only POSIX systems open a folder for this."""
    if os.name != "posix":
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
