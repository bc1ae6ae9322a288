"""One run at a time on the products of a campaign, held by a lock of the system.

The system frees it when the process ends, however that comes about.  The file stays: two runs that
find it gone could each make and lock one of their own.  It names a run while one is at work, and
still does after one that was killed.
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
    _FAR = 1 << 30  # a byte that is locked cannot be read, and the text of the file is to be

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
    """A lock as the workers of a run know it; ``holder`` is what its file says of the run."""

    path: Path
    holder: str

    def confirm(self) -> None:
        """Refuse to go on where the lock is not this run's, or is not seen."""
        try:
            text = self.path.read_text(encoding="utf-8", errors="replace")
        except FileNotFoundError:
            text = "no such file on this machine"
        except OSError as error:
            text = error.strerror or type(error).__name__
        if text != self.holder:
            raise ArchiveError(
                f"{self.path} is not the lock of this run any more",
                found=text or "that it was given back",
                needed="a folder that every worker can access, and one run at a time in it",
                hint="Archives that were finished are kept; run again to go on.",
            )


@contextmanager
def run_lock(folder: Path) -> Iterator[RunLock]:
    """Hold the folder of a campaign's products for one run."""
    lock = RunLock(folder / LOCK_NAME, _own())
    try:
        folder.mkdir(parents=True, exist_ok=True)
        file = lock.path.open("ab", buffering=0)
    except OSError as error:
        raise _refused(lock.path, error) from error
    with file:
        _hold(file, lock)
        _remove_begun(folder)  # by a run that was killed
        try:
            yield lock
        finally:
            # where a person has removed the file the folder may be another run's
            if _run_named(folder) == lock.holder:
                _remove_begun(folder)  # by a worker that was killed
                with suppress(OSError):  # a disk that is gone
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
    except OSError as error:  # a disk of the network that keeps no locks
        raise _refused(lock.path, error) from error
    try:
        file.truncate(0)
        file.write(lock.holder.encode())
        os.fsync(file.fileno())
    except OSError as error:
        with suppress(OSError):  # half of its text names nobody
            file.truncate(0)
        raise _refused(lock.path, error) from error


def _refused(path: Path, error: OSError) -> ArchiveError:
    return ArchiveError(
        f"{path} cannot be written",
        found=error.strerror or str(error),
        needed="a folder that this user may write to",
    )


def _run_named(folder: Path) -> str:
    """The run that is at work in a folder of products, or was killed there; empty without one."""
    try:
        return (folder / LOCK_NAME).read_text(encoding="utf-8", errors="replace")
    except OSError:
        return ""


def _own() -> str:
    command = without_secrets(shlex.join([Path(sys.argv[0]).name, *sys.argv[1:]]))
    command = command.encode("utf-8", "backslashreplace").decode()  # of names in other letters
    started = datetime.now(UTC).isoformat(sep=" ", timespec="seconds")
    return f"'{command}', process {os.getpid()} on {platform.node()}, since {started}"


def _remove_begun(folder: Path) -> None:
    """Take files away that were begun and have no name yet."""
    with suppress(OSError):  # they are in nobody's way, and the next run tries again
        for part in folder.rglob(".*.part"):
            part.unlink(missing_ok=True)
