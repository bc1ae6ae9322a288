"""Writes files completely or not at all."""

from __future__ import annotations

import errno
import hashlib
import os
import platform
import re
import shutil
import uuid
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path

from reduction.record.errors import ArchiveError

# from network disks without support for flushing folders
_NO_SUCH_CALL = (errno.EINVAL, errno.ENOTSUP, errno.ENOSYS)


@contextmanager
def atomic_file(path: Path) -> Iterator[Path]:
    """Yield a temporary path beside ``path``, which becomes ``path`` if the block succeeds."""
    path.parent.mkdir(parents=True, exist_ok=True)
    # workers on two machines may have the same process number
    part = path.with_name(f".{path.name}.{_machine()}-{os.getpid()}-{uuid.uuid4().hex[:8]}.part")
    is_there = False
    try:
        yield part
        with part.open("rb+") as file:
            os.fsync(file.fileno())
        part.replace(path)
        is_there = True
    finally:
        if not is_there:
            with suppress(OSError):  # if the disk refuses this too, the cause must stay visible
                part.unlink(missing_ok=True)
    _flush_folder(path)


def remove_abandoned(path: Path) -> None:
    """Remove files left unfinished by processes of this machine that have ended."""
    begun = re.compile(rf"\.{re.escape(path.name)}\.{_machine()}-(\d+)-[0-9a-f]+\.part")
    with suppress(OSError):  # files that cannot be removed do no harm
        for name in os.listdir(path.parent):
            found = begun.fullmatch(name)
            if found is not None and not _is_alive(int(found[1])):
                path.with_name(name).unlink(missing_ok=True)


def _machine() -> str:
    """A few letters that distinguish machines, and containers, which renumber processes."""
    space = Path("/proc/self/ns/pid")
    name = f"{platform.node()} {space.readlink() if space.is_symlink() else ''}"
    return hashlib.sha256(name.encode()).hexdigest()[:8]


def _is_alive(process: int) -> bool:
    if os.name != "posix":
        return True  # no way to ask without ending it
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except (PermissionError, OverflowError):
        pass  # another user's process, or not a process number
    return True


def take_away(path: Path) -> None:
    """Remove a file from an earlier run, if it exists."""
    try:
        path.unlink(missing_ok=True)
    except OSError as error:
        raise ArchiveError(
            f"{path} cannot be removed",
            found=error.strerror or str(error),
            hint="It is of an earlier run. Remove it, or run again.",
        ) from error


def _flush_folder(path: Path) -> None:
    """Flush the new name of a file to disk; only POSIX systems open a folder for this."""
    if os.name != "posix":
        return
    try:
        handle = os.open(path.parent, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)
    except OSError as error:
        if error.errno in _NO_SUCH_CALL:
            return
        raise ArchiveError(
            f"{path} is written, and may not be on the disk yet",
            found=error.strerror or str(error),
            hint="Check the disk, and run again.",
        ) from error


def write_text_atomically(path: Path, *pieces: str | bytes) -> None:
    """Write a UTF-8 text file completely or not at all, with line ends unchanged."""
    with append_atomically(path) as append:
        for one in pieces:
            append(one)


@contextmanager
def append_atomically(path: Path) -> Iterator[Callable[[str | bytes], None]]:
    """Yield a function that appends to a file, which appears only if the block succeeds."""
    is_in_block = False
    remove_abandoned(path)
    try:
        with atomic_file(path) as part:
            is_in_block = True
            yield partial(_append, part, path)
            is_in_block = False
    except OSError as error:
        if is_in_block or isinstance(error, ArchiveError):  # of another file, or complete
            raise
        raise not_written(path, error) from error


def _append(part: Path, path: Path, text: str | bytes) -> None:
    try:
        with part.open("ab") as file:
            file.write(text.encode("utf-8") if isinstance(text, str) else text)
    except OSError as error:
        raise not_written(path, error) from error


def not_written(path: Path, error: Exception) -> ArchiveError:
    """The error of a file that the system or a library could not write."""
    found = getattr(error, "strerror", None)
    if not isinstance(found, str) or (getattr(error, "errno", None) or 0) < 0:
        # netCDF library error numbers, which hide the system's message
        with suppress(OSError):
            free = shutil.disk_usage(path.parent).free
            found = f"{error}, with {free / 1e6:.0f} MB free on the disk"
    return ArchiveError(
        f"{path} cannot be written",
        found=found or str(error),
        hint="What was there before is kept. Check the folder and the space on the disk.",
    )
