"""A log as read, and the bytes it was read from.

A reader works on the bytes that were hashed, so that the hash of a product is that of the parsed
bytes.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from reduction.readers.layout import check_regular
from reduction.record.errors import LogError, ReductionError
from reduction.record.measurement import Bools, Floats, Integers, Source
from reduction.record.notes import Note


@dataclass(frozen=True)
class RawLog:
    """Result of a reader.

    Parameters
    ----------
    source : Source
        Name, hash and size of the file.
    columns : dict of str to ndarray, shape (n_rows,)
        By channel key (``time``, ``tension.1``; own time stamps as ``tension.1.time``),
        in the file's unit; a declared missing mark is NaN.  Nothing else may be NaN.
    text : dict of str to tuple of str
        Channels that are text by nature (the clock of a stepwise test).
    first_row : int
        Editor's row of the first data row; 0 for formats without rows.
    row : ndarray of int, shape (n_rows,), optional
        Editor's row of each data row if they are not consecutive.
    n_rows_read : int
        Number of data rows; equal to the length of the columns.
    metadata : dict of str to str
        Preamble and comment lines and file properties, unchanged.
    notes : tuple of Note
        Notes of the reader for the user.
    """

    source: Source
    columns: dict[str, Floats]
    first_row: int
    n_rows_read: int
    text: dict[str, tuple[str, ...]] = field(default_factory=dict)
    row: Integers | None = None
    metadata: dict[str, str] = field(default_factory=dict)
    notes: tuple[Note, ...] = ()

    def missing(self, name: str) -> Bools:
        """Where a channel holds a declared missing mark, shape (n_rows,)."""
        return np.isnan(self.columns[name])


_BLOCK = 1 << 20


def hash_source(path: Path, name: str) -> Source:
    """Hash a file in pieces, so that it may be of any size."""
    _state(path)
    digest, size = hashlib.sha256(), 0
    try:
        with path.open("rb") as stream:
            while block := stream.read(_BLOCK):
                digest.update(block)
                size += len(block)
    except OSError as error:
        raise unreadable(path, error) from error
    check_not_empty(path, size)
    return Source(name, digest.hexdigest(), size)


class RunningHash:
    """Hash of a file read in parts: a worker hashes one while the next is read."""

    def __init__(self) -> None:
        """Start with no bytes."""
        self._digest = hashlib.sha256()
        self._size = 0
        self._worker = ThreadPoolExecutor(1)
        self._last: Future[None] | None = None

    def add(self, data: memoryview) -> None:
        """Hash the next bytes, which must not change; earlier ones are finished on return."""
        if self._last is not None:
            self._last.result()
        self._size += len(data)
        self._last = self._worker.submit(self._digest.update, data)

    def source(self, name: str) -> Source:
        """Source for the whole file."""
        self.close()
        return Source(name, self._digest.hexdigest(), self._size)

    def close(self) -> None:
        """Stop the worker."""
        self._worker.shutdown()


def source_of(data: bytes, name: str) -> Source:
    """Hash of bytes already read."""
    return Source(name, hashlib.sha256(data).hexdigest(), len(data))


def read_bytes(path: Path) -> bytes:
    """Read a file whole."""
    with unchanged(path):
        try:
            data = path.read_bytes()
        except OSError as error:
            raise unreadable(path, error) from error
    check_not_empty(path, len(data))
    return data


@contextmanager
def unchanged(path: Path) -> Iterator[int]:
    """Size of a regular file; `LogError` if it changes in the ``with`` block or is refused.

    A change takes precedence over errors raised in the block: a changed file may be cut off.
    """
    before = _state(path)
    try:
        yield before[0]
    except LogError as error:
        if (found := _change(path, before)) is not None:
            raise found from error
        raise
    except OSError as error:
        if isinstance(error, ReductionError):
            raise  # an error of another file
        raise _change(path, before) or unreadable(path, error) from error
    if (found := _change(path, before)) is not None:
        raise found


def _change(path: Path, before: tuple[int, int]) -> LogError | None:
    """Error for a file that has changed."""
    after = _state(path)
    if after == before:
        return None
    verb = "shrank" if after[0] < before[0] else "grew" if after[0] > before[0] else "changed"
    return LogError(
        path,
        f"the file {verb} while it was read",
        found=f"{before[0]} bytes, then {after[0]} bytes",
        needed="a file that nothing writes to",
        hint="Wait until the logger or the copy has ended.",
    )


def _state(path: Path) -> tuple[int, int]:
    try:
        status = path.stat()
    except OSError as error:
        raise unreadable(path, error) from error
    check_regular(path, status.st_mode)
    return status.st_size, status.st_mtime_ns


def unreadable(path: Path | str, error: OSError) -> LogError:
    """Error for a file that the system does not allow to be read."""
    return LogError(
        path,
        "the file cannot be read",
        found=error.strerror or type(error).__name__,
        needed="a file that this user may read",
    )


def check_not_empty(path: Path, size: int) -> None:
    """Raise `LogError` if a file has no bytes."""
    if size == 0:
        raise LogError(path, "the file is empty", found="0 bytes", needed="a log")
