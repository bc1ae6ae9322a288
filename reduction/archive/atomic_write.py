"""Files that appear whole or not at all."""

from __future__ import annotations

import errno
import hashlib
import os
import platform
import re
import uuid
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from reduction.record.errors import ArchiveError

# of disks on a network that know nothing of folders that are flushed
_NO_SUCH_CALL = (errno.EINVAL, errno.ENOTSUP, errno.ENOSYS)


@contextmanager
def atomic_file(path: Path) -> Iterator[Path]:
    """Give a temporary name beside ``path``; when the block ends well it becomes ``path``."""
    path.parent.mkdir(parents=True, exist_ok=True)
    # workers on two machines may have one number
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
            with suppress(OSError):  # a disk that refuses this too would hide why
                part.unlink(missing_ok=True)
    _flush_folder(path)


def remove_abandoned(path: Path) -> None:
    """Remove what processes of this machine that are no more began of a file."""
    begun = re.compile(rf"\.{re.escape(path.name)}\.{_machine()}-(\d+)-[0-9a-f]+\.part")
    with suppress(OSError):  # what cannot be removed is in nobody's way
        for name in os.listdir(path.parent):
            found = begun.fullmatch(name)
            if found is not None and not _is_alive(int(found[1])):
                path.with_name(name).unlink(missing_ok=True)


def _machine() -> str:
    """Few letters that tell machines apart, and containers, which number processes anew."""
    space = Path("/proc/self/ns/pid")
    name = f"{platform.node()} {space.readlink() if space.is_symlink() else ''}"
    return hashlib.sha256(name.encode()).hexdigest()[:8]


def _is_alive(process: int) -> bool:
    if os.name != "posix":
        return True  # nothing there asks without ending it
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except (PermissionError, OverflowError):
        pass  # of another user, or no number of a process
    return True


def take_away(path: Path) -> None:
    """Remove a file that an earlier run made, where it is there."""
    try:
        path.unlink(missing_ok=True)
    except OSError as error:
        raise ArchiveError(
            f"{path} cannot be removed",
            found=error.strerror or str(error),
            hint="It is of an earlier run. Remove it, or run again.",
        ) from error


def _flush_folder(path: Path) -> None:
    """Put the new name of a file on the disk; only POSIX systems open a folder for this."""
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
