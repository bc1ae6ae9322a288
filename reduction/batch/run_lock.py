"""Allows one run at a time on the products of a campaign, by an operating-system lock.

The system releases the lock whenever the process ends.  The file is kept, because two runs that
find it gone could each create and lock their own.  It names the active run, or one that was killed.
"""

from __future__ import annotations

import os
import platform
import shlex
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import BinaryIO

from reduction.record.errors import ArchiveError
from reduction.record.plain_text import without_secrets

if sys.platform == "win32":
    import msvcrt

    _HELD = PermissionError
    _FAR = 1 << 30  # a locked byte cannot be read, but the text of the file must be readable

    def _take(file: BinaryIO) -> None:
        file.seek(_FAR)
        msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
else:
    import fcntl

    _HELD = BlockingIOError

    def _take(file: BinaryIO) -> None:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)


LOCK_NAME = "run.lock"


@dataclass(frozen=True)
class RunLock:
    """A lock as passed to the workers of a run; ``holder`` is the run named in its file."""

    path: Path
    holder: str

    def confirm(self) -> None:
        """Raise an error if the lock is not this run's, or is not visible."""
        try:
            text = self.path.read_text(encoding="utf-8", errors="replace")
        except FileNotFoundError:
            text = "no such file on this machine"
        except OSError as error:
            text = error.strerror or type(error).__name__
        if text != self.holder:
            raise ArchiveError(
                f"{self.path} is no longer the lock of this run",
                found=text or "an empty lock",
                needed="a folder that every worker can access, and one run at a time in it",
                hint="Archives that were finished are kept; run again to continue.",
            )


@contextmanager
def run_lock(folder: Path) -> Iterator[RunLock]:
    """Lock the folder of a campaign's products for one run."""
    lock = RunLock(folder / LOCK_NAME, _own())
    try:
        folder.mkdir(parents=True, exist_ok=True)
        file = lock.path.open("ab", buffering=0)
    except OSError as error:
        raise _refused(lock.path, error) from error
    with file:
        _hold(file, lock)
        _remove_begun(folder)  # left by a killed run
        try:
            yield lock
        finally:
            # if the file was removed, the folder may belong to another run
            if _run_named(folder) == lock.holder:
                _remove_begun(folder)  # left by a killed worker
                with suppress(OSError):  # a lost disk
                    file.truncate(0)


def _hold(file: BinaryIO, lock: RunLock) -> None:
    try:
        _take(file)
    except _HELD:
        folder = lock.path.parent
        raise ArchiveError(
            f"another run holds {folder}",
            found=f"{lock.path}: {_run_named(folder)}",
            needed="one run at a time in a folder of archives",
            hint="Wait for it or end it; archives that it finished are kept.",
        ) from None
    except OSError as error:  # a network disk without locks
        raise _refused(lock.path, error) from error
    try:
        file.truncate(0)
        file.write(lock.holder.encode())
        os.fsync(file.fileno())
    except OSError as error:
        with suppress(OSError):  # half of its text names no run
            file.truncate(0)
        raise _refused(lock.path, error) from error


def _refused(path: Path, error: OSError) -> ArchiveError:
    return ArchiveError(
        f"{path} cannot be written",
        found=error.strerror or str(error),
        needed="a folder that this user may write to",
    )


def _run_named(folder: Path) -> str:
    """The run that is active in a folder of products, or was killed there; empty without one."""
    try:
        return (folder / LOCK_NAME).read_text(encoding="utf-8", errors="replace")
    except OSError:
        return ""


def _own() -> str:
    command = without_secrets(shlex.join([Path(sys.argv[0]).name, *sys.argv[1:]]))
    command = command.encode("utf-8", "backslashreplace").decode()  # for names in other alphabets
    started = datetime.now(UTC).isoformat(sep=" ", timespec="seconds")
    return f"'{command}', process {os.getpid()} on {platform.node()}, since {started}"


def _remove_begun(folder: Path) -> None:
    """Remove unfinished files that have no final name yet."""
    with suppress(OSError):  # they are harmless, and the next run tries again
        for part in folder.rglob(".*.part"):
            part.unlink(missing_ok=True)
