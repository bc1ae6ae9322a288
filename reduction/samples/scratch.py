"""Arrays in memory or, where a log is long, in scratch files on disk.

Both are plain arrays, so that every stage is written once.  What lies on disk is mapped: pages
that a stage has touched count as memory of the process until they are let go.
"""

from __future__ import annotations

import ctypes
import mmap
import os
import tempfile
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from reduction.errors import DataError

# of the GNU C library; other systems give back by themselves
_MALLOC_TRIM = getattr(ctypes.CDLL(None), "malloc_trim", None) if os.name == "posix" else None

_ON_DISK_FROM = 1 << 20  # bytes; less is not worth a file
_LONG = 1 << 22  # bytes of a series from which what its stages have freed is worth giving back


_name: str | None = None  # how the names of scratch files begin, where they have one


class _ScratchMap(mmap.mmap):
    """A mapped scratch file; one without a name is gone with the last array on it."""

    folder: Path
    name: str | None


def scratch_folder() -> Path:
    """Return where scratch files lie: TMPDIR, else /var/tmp, which is on disk where /tmp is not."""
    if stated := os.environ.get("TMPDIR"):
        return Path(stated)  # tempfile would pass over one that is full or not there, for /tmp
    usual = Path("/var/tmp")  # noqa: S108 - files there have no name
    return usual if os.access(usual, os.W_OK) else Path(tempfile.gettempdir())


def check_room(folder: Path, n_bytes: int) -> None:
    """Refuse what a file states before the disk is full of it.

    Parameters
    ----------
    folder : pathlib.Path
        Where scratch files are to lie.
    n_bytes : int
        How many bytes they will have at least. [1]

    Raises
    ------
    DataError
        If the disk has less room.
    """
    if not hasattr(os, "statvfs"):  # only POSIX systems say it in this way
        return
    try:
        disk = os.statvfs(folder)
    except OSError:  # a folder that is not there is told when a file is made in it
        return
    free = disk.f_bavail * disk.f_frsize
    if n_bytes > free:
        raise _no_space(folder, n_bytes, f"{free / 1e6:.0f} MB are free")


def name_scratch_files(beginning: str) -> None:
    """Give scratch files names from now on, so that another process can take them over.

    Parameters
    ----------
    beginning : str
        Of each name; the other process removes them.
    """
    global _name
    _name = beginning


def name_of_scratch_file(array: NDArray[Any]) -> tuple[str, Path] | None:
    """Name and folder of the file that holds an array and no more; None where there is none."""
    found = _map_of(array)
    if found is None or found.name is None or array.nbytes != len(found) or array.ndim != 1:
        return None
    return found.name, found.folder


def is_on_disk(array: NDArray[Any]) -> bool:
    """Whether an array lies in a scratch file."""
    return _map_of(array) is not None


def let_go(*arrays: NDArray[Any]) -> None:
    """Take the pages of arrays on disk off the memory of the process; their numbers stay."""
    for array in arrays:
        found = _map_of(array)
        if found is not None and hasattr(mmap, "MADV_DONTNEED"):
            found.madvise(mmap.MADV_DONTNEED)


def give_back(*arrays: NDArray[Any]) -> None:
    """Give what earlier work has freed back to the system, if any of the arrays is long or on disk.

    The C library keeps what is freed, in pieces between what is not: half of the memory of a
    long log after a few stages.
    """
    if _MALLOC_TRIM is not None and any(
        array.nbytes >= _LONG or is_on_disk(array) for array in arrays
    ):
        _MALLOC_TRIM(0)


def empty_like(
    reference: NDArray[Any],
    *,
    shape: int | tuple[int, ...] | None = None,
    dtype: DTypeLike | None = None,
) -> NDArray[Any]:
    """Return an array that holds anything, on disk where the reference is.

    Parameters
    ----------
    reference : ndarray
        Beside which it shall lie. [any]
    shape : int or tuple of int, optional
        That of the reference where left out. [1]
    dtype : dtype, optional
        Likewise.

    Returns
    -------
    array : ndarray
        Of the shape. [any]

    Raises
    ------
    DataError
        If the disk is full, or a limit on address space is reached.

    Examples
    --------
    >>> empty_like(np.zeros(3), dtype=bool).shape
    (3,)
    """
    shape = reference.shape if shape is None else shape
    kind = np.dtype(reference.dtype if dtype is None else dtype)
    n_bytes = int(np.prod(shape)) * kind.itemsize
    beside = _map_of(reference)
    if beside is None or n_bytes < _ON_DISK_FROM:
        return np.empty(shape, dtype=kind)
    with _scratch_file(beside.folder) as file:
        _reserve(file, n_bytes, beside.folder)
        return mapped(file, n_bytes, beside.folder, kind).reshape(shape)


def beside(reference: NDArray[Any], made: NDArray[Any]) -> NDArray[Any]:
    """Return an array moved to disk where the reference is, else as it is; both are let go."""
    if not is_on_disk(reference):
        return made
    moved = empty_like(reference, shape=made.shape, dtype=made.dtype)
    moved[...] = made
    let_go(reference, moved)
    return moved


def zeros_like(
    reference: NDArray[Any],
    *,
    shape: int | tuple[int, ...] | None = None,
    dtype: DTypeLike | None = None,
) -> NDArray[Any]:
    """Return an array of zeros; parameters as in `empty_like`."""
    made = empty_like(reference, shape=shape, dtype=dtype)
    # a new scratch file holds zeros, and so does memory that the system gives when it is touched
    return made if is_on_disk(made) else np.zeros(made.shape, dtype=made.dtype)


class ColumnWriter:
    """A column that grows by parts: in memory, or in a scratch file where a folder is given.

    Parameters
    ----------
    folder : pathlib.Path or None
        Where the scratch file lies; None keeps the column in memory.
    dtype : dtype
        Of the column.
    """

    def __init__(self, folder: Path | None, dtype: DTypeLike = np.float64) -> None:
        """Begin an empty column."""
        self._folder = folder
        self._dtype = np.dtype(dtype)
        self._parts: list[NDArray[Any]] = []
        self._file: IO[bytes] | None = None
        self._file = None if folder is None else _scratch_file(folder)
        self.size = 0

    def append(self, values: NDArray[Any]) -> None:
        """Add samples at the end.

        Raises
        ------
        DataError
            If the disk is full.
        """
        part = np.ascontiguousarray(values, dtype=self._dtype)
        self.size += part.size
        if self._file is None or self._folder is None:
            self._parts.append(part)
            return
        left = part.data.cast("B") if part.size else memoryview(b"")
        try:
            while left:  # a disk that fills takes what it can
                left = left[self._file.write(left) :]
        except OSError as error:
            n_bytes = self.size * self._dtype.itemsize
            raise _no_space(self._folder, n_bytes, error.strerror) from error

    def finish(self) -> NDArray[Any]:
        """Return the column, shape (size,); nothing may be added any more.

        Raises
        ------
        DataError
            If a limit on address space is reached.
        """
        if self._file is not None and self._folder is not None:
            with self._file as file:
                return mapped(file, self.size * self._dtype.itemsize, self._folder, self._dtype)
        if len(self._parts) == 1 and self._parts[0].flags.writeable:
            return self._parts[0]
        return np.concatenate([np.empty(0, dtype=self._dtype), *self._parts])

    def __del__(self) -> None:
        """Close the file of a column that was given up."""
        if self._file is not None:
            self._file.close()


def _map_of(array: NDArray[Any]) -> _ScratchMap | None:
    base: object = array
    while isinstance(base, np.ndarray):
        base = base.base
    return base if isinstance(base, _ScratchMap) else None


def _scratch_file(folder: Path) -> IO[bytes]:
    try:
        if _name is not None:
            return tempfile.NamedTemporaryFile(buffering=0, prefix=_name, dir=folder, delete=False)
        return tempfile.TemporaryFile(buffering=0, dir=folder)
    except OSError as error:
        raise DataError(
            "no scratch file can be made for a long log",
            found=f"{folder}: {error.strerror}",
            needed="a folder that this user may write to",
            hint="Set TMPDIR to a folder on a disk with room.",
        ) from error


def _reserve(file: IO[bytes], n_bytes: int, folder: Path) -> None:
    """Take the room at once: a map of a file that the disk cannot hold ends the process."""
    try:
        if hasattr(os, "posix_fallocate"):
            os.posix_fallocate(file.fileno(), 0, n_bytes)
        else:
            file.truncate(n_bytes)
    except OSError as error:
        raise _no_space(folder, n_bytes, error.strerror) from error


def mapped(file: IO[bytes], n_bytes: int, folder: Path, dtype: np.dtype[Any]) -> NDArray[Any]:
    """A scratch file as an array; `DataError` where a limit on address space is reached."""
    if not n_bytes:
        return np.empty(0, dtype=dtype)
    try:
        found = _ScratchMap(file.fileno(), n_bytes)
    except OSError as error:
        raise DataError(
            "a scratch file of a long log cannot be mapped",
            found=f"{n_bytes / 1e6:.0f} MB: {error.strerror}",
            needed="address space for all scratch files, about 60 bytes a row and specimen",
            hint="Scratch files take no memory, but a limit on address space or on open files "
            "counts them: see ulimit -v and ulimit -n.",
        ) from error
    found.folder = folder
    found.name = file.name if isinstance(file.name, str) else None  # a number where it has none
    return np.ndarray(n_bytes // dtype.itemsize, dtype=dtype, buffer=found)


def _no_space(folder: Path, n_bytes: int, why: str | None) -> DataError:
    return DataError(
        "the scratch files of a long log do not fit on the disk",
        found=f"no room for {n_bytes / 1e6:.0f} MB in {folder}: {why}",
        needed="about 60 bytes a row and specimen",
        hint="Set TMPDIR to a folder on a disk with room.",
    )
