"""One run at a time on the products of a campaign."""

from __future__ import annotations

import errno
import json
import os
import platform
import shlex
import sys
import uuid
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from pathlib import Path

from reduction.address import without_secrets
from reduction.errors import ArchiveError

__all__ = ["LOCK_NAME", "RunLock", "run_lock"]

LOCK_NAME = "run.lock"
_BOOT = Path("/proc/sys/kernel/random/boot_id")
# FAT, and shares of other systems
_NO_LINKS = {errno.EPERM, errno.ENOTSUP, errno.EOPNOTSUPP, errno.ENOSYS, errno.EMLINK}
_NAMESPACE = Path("/proc/self/ns/pid")


@dataclass(frozen=True)
class _Holder:
    """Who holds a lock.

    Names of processes are those of a host and of a space of its own in a container; one process
    is told from a later one of the same number by its start, in ticks of a boot of the machine.
    """

    host: str
    space: str
    boot: str
    pid: int
    process_start: str
    started: str
    command: str
    token: str

    def __str__(self) -> str:
        """Name who, where and since when."""
        return f"'{self.command}', process {self.pid} on {self.host}, since {self.started}"


@dataclass(frozen=True)
class RunLock:
    """A lock as the workers of a run know it."""

    path: Path
    token: str

    def confirm(self) -> None:
        """Refuse to go on where the lock is not this run's, or is not seen.

        Raises
        ------
        ArchiveError
            So that what is left of a run that was ended writes nothing into those of the next.
        """
        text, refused = _read(self.path)
        holder = _holder_in(text)
        if holder is not None and holder.token == self.token:
            return
        if refused:
            raise ArchiveError(f"{self.path}, the lock of this run, cannot be read", found=refused)
        raise ArchiveError(
            f"{self.path} is not the lock of this run any more",
            found="no such file on this machine" if text is None else str(holder or "another text"),
            needed="a folder of products that every worker sees, and one run at a time on it",
            hint="Products that were finished are kept; run again to go on.",
        )


@contextmanager
def run_lock(folder: Path, *, remark: Callable[[str], None]) -> Iterator[RunLock]:
    """Hold the folder of a campaign's products for one run.

    Parameters
    ----------
    folder : pathlib.Path
        Made where it is not there.
    remark : callable
        Told where the lock of a process that is no more was taken over.

    Yields
    ------
    lock : RunLock
        Given back at the end, however it comes about.

    Raises
    ------
    ArchiveError
        If another run holds it, or the folder cannot be written to.
    """
    path = folder / LOCK_NAME
    own = _own()
    new: list[Path] = []
    try:
        new += [one for one in (folder, *folder.parents) if not one.exists()]
        folder.mkdir(parents=True, exist_ok=True)
        _take(path, own, remark)
        _remove_begun(folder)  # by a run that was killed
    except ArchiveError:
        raise
    except OSError as error:
        _remove_empty(new)
        raise ArchiveError(
            f"{path} cannot be written",
            found=error.strerror or str(error),
            needed="a folder for products that this user may write to",
        ) from error
    try:
        yield RunLock(path, own.token)
    finally:
        holder = _holder_in(_text_of(path))
        if holder is not None and holder.token == own.token:
            _remove_begun(folder)  # by a worker that was killed
            with suppress(OSError):  # a disk that is gone keeps it, and the next run says so
                path.unlink()
        _remove_empty(new)


def _remove_begun(folder: Path) -> None:
    """Take files away that were begun and have no name yet."""
    with suppress(OSError):  # they are in nobody's way, and the next run tries again
        for part in folder.rglob(".*.part"):
            part.unlink(missing_ok=True)


def _remove_empty(folders: Sequence[Path]) -> None:
    """Take folders away that were made for products, where nothing was written."""
    with suppress(OSError):
        for one in folders:
            one.rmdir()


def _take(path: Path, own: _Holder, remark: Callable[[str], None]) -> None:
    # with a text from its first moment: one without, of a process that was killed, is nobody's
    part = path.with_name(f".{path.name}.{own.token}.part")
    try:
        for _ in range(100):
            if _made(path, part, own):
                return
            text, refused = _read(path)
            if refused:
                raise _refusal(path, None, own, refused)
            if text is None:
                continue  # given back in this moment
            holder = _holder_in(text)
            if holder is None or not _is_gone(holder, own):
                raise _refusal(path, holder, own)
            if _put_away(path, text):
                remark(f"{path}: taken over from {holder}, which is no more")
        raise _refusal(path, None, own)
    finally:
        with suppress(OSError):  # the next run takes it away
            part.unlink(missing_ok=True)


def _made(path: Path, part: Path, own: _Holder) -> bool:
    """Whether the lock was not there, and is now."""
    try:
        if not part.exists():  # who held the lock before may have swept it
            _write(part, own)
        os.link(part, path)
    except (FileExistsError, FileNotFoundError):
        return False
    except OSError as error:
        if error.errno not in _NO_LINKS:
            raise
        return _made_in_place(path, own)
    return True


def _made_in_place(path: Path, own: _Holder) -> bool:
    """The same on a file system without links."""
    try:
        _write(path, own)
    except FileExistsError:
        return False
    return True


def _write(path: Path, own: _Holder) -> None:
    # one of several that try at once makes the file, on NFS too
    with path.open("x", encoding="utf-8") as file:
        try:
            json.dump(asdict(own), file, indent=1)
            file.flush()
            os.fsync(file.fileno())
        except BaseException:
            # a lock without its text would hold the folder for ever
            path.unlink(missing_ok=True)
            raise


def _put_away(path: Path, text: str) -> bool:
    """Remove the lock of a process that is gone; of several that try, one does."""
    aside = path.with_name(f".{path.name}.{uuid.uuid4().hex}.part")
    try:
        path.rename(aside)
    except FileNotFoundError:
        return False
    # it is gone where one that was quicker has swept the folder
    is_his = _text_of(aside) in (text, None)
    if not is_his:
        # another was quicker, and this is its lock
        with suppress(FileExistsError):
            os.link(aside, path)
    aside.unlink(missing_ok=True)
    return is_his


def _refusal(
    path: Path, holder: _Holder | None, own: _Holder, found: str = "a text that is no lock"
) -> ArchiveError:
    if holder is None:
        hint = "Try again in a moment; if no run is at work there, delete the file."
    elif (holder.host, holder.space) == (own.host, own.space):
        hint = "Wait for it or end it; products that it finished are kept."
    else:
        hint = (
            "Wait for it or end it there. If it is no more, which cannot be seen from "
            f"{own.host}, delete the file."
        )
    return ArchiveError(
        f"another run holds {path.parent}",
        found=f"{path}: {found if holder is None else holder}",
        needed="one run at a time on a folder of products",
        hint=hint,
    )


def _own() -> _Holder:
    return _Holder(
        host=platform.node(),
        space=_NAMESPACE.readlink().name if _NAMESPACE.is_symlink() else "",
        boot=(_text_of(_BOOT) or "").strip(),
        pid=os.getpid(),
        process_start=_process_start(os.getpid()) or "",
        started=datetime.now(UTC).isoformat(sep=" ", timespec="seconds"),
        command=without_secrets(shlex.join([Path(sys.argv[0]).name, *sys.argv[1:]])),
        token=uuid.uuid4().hex,
    )


def _is_gone(holder: _Holder, own: _Holder) -> bool:
    """Whether the process of a lock is known to be no more."""
    if (holder.host, holder.space) != (own.host, own.space) or os.name != "posix":
        return False
    if holder.boot != own.boot:
        return True
    if own.process_start:
        return _process_start(holder.pid) != holder.process_start
    try:
        os.kill(holder.pid, 0)
    except ProcessLookupError:
        return True
    except PermissionError:
        return False  # of another user
    return False


def _process_start(pid: int) -> str | None:
    """Start of a process in ticks since the boot; None where it ended or the system tells not."""
    text = _text_of(Path(f"/proc/{pid}/stat"))
    if text is None:
        return None
    # the name of the program, in brackets, may hold blanks and brackets
    fields = text.rpartition(")")[2].split()
    return None if fields[0] in "ZX" else fields[19]


def _text_of(path: Path) -> str | None:
    return _read(path)[0]


def _read(path: Path) -> tuple[str | None, str]:
    """Text of a file, and why there is none; neither where there is no such file."""
    try:
        return path.read_text(encoding="utf-8"), ""
    except FileNotFoundError:
        return None, ""
    except OSError as error:
        return None, error.strerror or type(error).__name__
    except UnicodeDecodeError:
        return None, "a text that is no lock"


def _holder_in(text: str | None) -> _Holder | None:
    try:
        return _Holder(**json.loads(text or ""))
    except (TypeError, ValueError):
        return None
