"""Series of samples in memory or on disk, block by block."""

from __future__ import annotations

import ctypes
import mmap
import os
import tempfile
from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from reduction.record.errors import DataError

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


def _is_on_disk(array: NDArray[Any]) -> bool:
    """Whether an array lies in a scratch file."""
    return _map_of(array) is not None


def release_pages(*arrays: NDArray[Any]) -> None:
    """Take the pages of arrays on disk off the memory of the process; their numbers stay."""
    for array in arrays:
        found = _map_of(array)
        if found is not None and hasattr(mmap, "MADV_DONTNEED"):
            found.madvise(mmap.MADV_DONTNEED)


def trim_heap() -> None:
    """Give what earlier work has freed back to the system.

    The C library keeps what is freed, in pieces between what is not: half of the memory of a
    long log after a few stages, and 50 MB after the tables of a batch.
    """
    if _MALLOC_TRIM is not None:
        _MALLOC_TRIM(0)


def trim_heap_after(*arrays: NDArray[Any]) -> None:
    """Give back what earlier work has freed, if any of the arrays is long or on disk."""
    if any(array.nbytes >= _LONG or _is_on_disk(array) for array in arrays):
        trim_heap()


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


def like_storage(reference: NDArray[Any], made: NDArray[Any]) -> NDArray[Any]:
    """Return an array moved to disk where the reference is, else as it is; both are let go."""
    if not _is_on_disk(reference):
        return made
    moved = empty_like(reference, shape=made.shape, dtype=made.dtype)
    moved[...] = made
    release_pages(reference, moved)
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
    return made if _is_on_disk(made) else np.zeros(made.shape, dtype=made.dtype)


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


BLOCK = 1 << 16
"""Samples of a block, which stay in the cache. [1]."""

_SPAN = 1 << 20  # samples of a stretch; each one touched may bring 2 MB of its file into memory


def sample_blocks(
    n_samples: int, *arrays: NDArray[Any], overlap: int = 0, size: int = BLOCK
) -> Iterator[slice]:
    """Slices that cover a series, in order; arrays on disk are let go behind every few.

    Parameters
    ----------
    n_samples : int
        Length of the series. [1]
    *arrays : ndarray
        What is read or written in the blocks. [any]
    overlap : int
        Samples of the next block that each slice has too. [1]
    size : int
        Samples of a block. [1]

    Yields
    ------
    part : slice
        Of the samples. [1]

    Raises
    ------
    ValueError
        If the size is zero.

    Examples
    --------
    >>> list(sample_blocks(5, size=2, overlap=1))
    [slice(0, 3, None), slice(2, 5, None), slice(4, 5, None)]
    """
    kept = 0
    for start in range(0, n_samples, size):
        yield slice(start, min(start + size + overlap, n_samples))
        kept += size
        if kept >= _SPAN // 2 or start + size >= n_samples:  # less is not worth the call
            release_pages(*arrays)
            kept = 0


def take_samples(series: NDArray[Any], index: NDArray[np.integer[Any]]) -> NDArray[Any]:
    """Return single samples of series, as ``series[..., index]`` does, in bounded memory.

    Parameters
    ----------
    series : ndarray, shape (..., n_samples)
        In memory or on disk. [any]
    index : ndarray of int, any shape
        Which samples. [1]

    Returns
    -------
    values : ndarray, shape (..., *index.shape)
        In memory. [as series]

    Raises
    ------
    IndexError
        If a sample is not in the series.

    Examples
    --------
    >>> take_samples(np.array([5.0, 6.0, 7.0]), np.array([2, 0]))
    array([7., 5.])
    """
    if not _is_on_disk(series):
        return np.asarray(series.take(index, axis=-1))
    flat = index.reshape(-1)
    taken = np.empty((*series.shape[:-1], flat.size), dtype=series.dtype)
    edges = np.flatnonzero(np.diff(flat // _SPAN)) + 1
    is_to_and_fro = edges.size > series.shape[-1] // _SPAN and bool((np.diff(flat) < 0).any())
    if is_to_and_fro:  # once over all instead
        order = np.argsort(flat, kind="stable")
        taken[..., order] = take_samples(series, flat[order])
    else:
        for start, stop in pairwise([0, *edges.tolist(), flat.size]):
            taken[..., start:stop] = series[..., flat[start:stop]]
            release_pages(series)
    return taken.reshape(*series.shape[:-1], *index.shape)


def count_samples(where: NDArray[Any]) -> int:
    """Samples of a series that are true, or not zero."""
    return sum(int(np.count_nonzero(where[part])) for part in sample_blocks(where.size, where))


def finite_extremes(series: NDArray[np.float64]) -> tuple[float, float]:
    """Least and greatest finite sample; infinity and its negative where there is none.

    Examples
    --------
    >>> finite_extremes(np.array([1.0, np.nan, 3.0]))
    (1.0, 3.0)
    """
    low, high = np.inf, -np.inf
    for part in sample_blocks(series.size, series):
        finite = series[part]
        least, greatest = finite.min(), finite.max()
        if not (np.isfinite(least) and np.isfinite(greatest)):
            finite = finite[np.isfinite(finite)]
            least, greatest = finite.min(initial=low), finite.max(initial=high)
        low, high = min(low, least), max(high, greatest)
    return float(low), float(high)


def mean_of_rows(rows: NDArray[np.float64]) -> NDArray[np.float64]:
    """Mean of several series sample by sample, shape (n_samples,); on disk where they are.

    Examples
    --------
    >>> mean_of_rows(np.array([[1.0, 2.0], [3.0, 6.0]]))
    array([2., 4.])
    """
    mean = empty_like(rows, shape=rows.shape[1])
    for part in sample_blocks(rows.shape[1], rows, mean):
        np.mean(rows[:, part], axis=0, out=mean[part])
    return mean


def copied(series: NDArray[Any]) -> NDArray[Any]:
    """Return a copy that may be written to, on disk where the series is."""
    copy = empty_like(series)
    for part in sample_blocks(series.shape[-1], series, copy):
        copy[..., part] = series[..., part]
    return copy


def full_like(
    reference: NDArray[Any], value: float, *, shape: int | tuple[int, ...] | None = None
) -> NDArray[Any]:
    """Return an array of one number; parameters as in `empty_like`."""
    made = empty_like(reference, shape=shape)
    flat = made.reshape(-1)
    for part in sample_blocks(flat.size, flat):
        flat[part] = value
    return made


def join_columns(parts: Sequence[NDArray[Any]]) -> NDArray[Any]:
    """Columns one after another, on disk where the first is; one alone is given back."""
    if len(parts) == 1:
        return parts[0]
    joined = empty_like(parts[0], shape=sum(part.size for part in parts))
    start = 0
    for part in parts:
        for block in sample_blocks(part.size, part, joined):
            joined[start + block.start : start + block.stop] = part[block]
        start += part.size
    return joined


Where = Callable[[slice], NDArray[np.bool_]]
"""Of a slice of samples: for which of them it is true."""


def first_sample(where: Where, start: int, stop: int, *samples: NDArray[Any]) -> int | None:
    """First sample from ``start`` up to ``stop`` for which a condition on slices is true.

    ``samples`` is what the condition reads.
    """
    for low in range(start, stop, BLOCK):
        found = where(slice(low, min(low + BLOCK, stop)))
        release_pages(*samples)
        if found.any():
            return low + int(found.argmax())
    return None


def last_sample(where: Where, start: int, stop: int, *samples: NDArray[Any]) -> int | None:
    """Last sample from ``start`` up to ``stop`` for which a condition on slices is true."""
    for high in range(stop, start, -BLOCK):
        low = max(high - BLOCK, start)
        found = where(slice(low, high))
        release_pages(*samples)
        if found.any():
            return high - 1 - int(found[::-1].argmax())
    return None


def any_sample(where: Where, n_samples: int, *samples: NDArray[Any]) -> bool:
    """Whether a condition on slices is true for any sample of a series."""
    return first_sample(where, 0, n_samples, *samples) is not None


def thinned(
    where: Where, n_samples: int, *, most: int, every: int = 1, samples: Sequence[NDArray[Any]] = ()
) -> NDArray[np.intp]:
    """Samples for which a condition is true, evenly thinned to fewer than twice a number.

    Parameters
    ----------
    where : callable
        Of a slice, which may have a step: whether each of its samples is wanted.
    n_samples : int
        Length of the series. [1]
    most : int
        So many are kept, or up to twice as many. [1]
    every : int
        Every so manieth sample of the series is looked at. [1]
    samples : sequence of ndarray
        What the condition reads.

    Returns
    -------
    kept : ndarray of int, shape (n_kept,)
        In order. [1]

    Raises
    ------
    ValueError
        If ``every`` is zero.

    Examples
    --------
    >>> thinned(lambda part: np.arange(10)[part] > 3, 10, most=3)
    array([4, 6, 8])
    """

    def rows() -> Iterator[NDArray[np.intp]]:
        for part in sample_blocks(n_samples, *samples, size=every * BLOCK):
            looked = slice(part.start, part.stop, every)
            yield part.start + every * np.flatnonzero(where(looked))

    step = max(1, sum(block.size for block in rows()) // most)
    kept, before = [np.empty(0, dtype=np.intp)], 0
    for block in rows():
        kept.append(block[-before % step :: step].copy())  # a view would keep the block
        before += block.size
    return np.concatenate(kept)


Floats = NDArray[np.float64]


def select_samples(where: Where, *series: NDArray[Any]) -> tuple[NDArray[Any], ...]:
    """Samples of several series for which a condition on slices is true, beside them.

    Parameters
    ----------
    where : callable
        Of a slice: whether each of its samples is wanted.
    *series : ndarray, shape (n_samples,)
        In memory or on disk. [any]

    Returns
    -------
    kept : tuple of ndarray, shape (n_kept,)
        The series themselves where all is wanted. [as series]

    Raises
    ------
    IndexError
        If the series differ in length and not all is wanted.

    Examples
    --------
    >>> values = np.array([5.0, np.nan, 7.0])
    >>> select_samples(lambda part: np.isfinite(values[part]), np.arange(3), values)
    (array([0, 2]), array([5., 7.]))
    """
    n_samples = series[0].size
    counts = [int(np.count_nonzero(where(part))) for part in sample_blocks(n_samples, *series)]
    n_kept = sum(counts)
    if n_kept == n_samples:
        return series
    kept = tuple(empty_like(one, shape=n_kept) for one in series)
    ends = np.cumsum(counts, dtype=np.intp)
    for number, part in enumerate(sample_blocks(n_samples, *series, *kept)):
        wanted = where(part)
        for one, made in zip(series, kept, strict=True):
            made[ends[number] - counts[number] : ends[number]] = one[part][wanted]
    return kept


def shifted(series: Floats, by: float) -> Floats:
    """Series less a number, shape (n_samples,); on disk where the series is.

    Examples
    --------
    >>> shifted(np.array([5.0, 7.0]), 5.0)
    array([0., 2.])
    """
    made = empty_like(series)
    for part in sample_blocks(series.size, series, made):
        np.subtract(series[part], by, out=made[part])
    return made


def mean_of(series: Floats) -> float:
    """Mean of a series of one sample or more.

    Notes
    -----
    Samples are summed as they differ from the first one: of a level that hardly changes the sum
    of blocks of any length then gives the same mean to the last digit or two.

    Examples
    --------
    >>> mean_of(np.array([1.0, 2.0]))
    1.5
    """
    first = float(series[0])
    parts = sample_blocks(series.size, series)
    return first + float(sum((series[part] - first).sum() for part in parts)) / series.size


_CODES_READ = 1 << 16  # samples

_OF_CODES = 0.99  # of the steps, that are whole multiples of one

_OF_TURNS = 0.3  # of them, that are followed by another


def step_of_codes(values: Floats) -> float:
    """Step between the codes of a channel, all of whose steps are multiples of it; 0 of others.

    A ramp without noise has one step too, but does not go now by one code and now by another.

    Examples
    --------
    >>> wave = np.sin(np.arange(500) / 20)
    >>> print(round(step_of_codes(np.round(wave, 2)), 3), step_of_codes(wave))
    0.01 0.0
    >>> print(step_of_codes(0.25 * np.arange(100)))
    0.0
    """
    steps = np.abs(np.diff(values[:_CODES_READ]))
    steps = steps[np.isfinite(steps)]
    moves = steps[steps > 1e-9 * steps.max(initial=0.0)]
    if not moves.size:
        return 0.0
    # of a wave that passes over codes the levels of its rise and of its fall lie between each other
    levels = np.sort(values[:_CODES_READ][np.isfinite(values[:_CODES_READ])])
    apart = np.diff(levels)
    step = float(apart[apart > 1e-9 * moves.max()].min())
    multiple = moves / step
    whole = np.abs(multiple - np.round(multiple)) < 0.05
    turns = np.count_nonzero(np.diff(np.round(steps / step)))
    return step if whole.mean() >= _OF_CODES and turns > _OF_TURNS * moves.size else 0.0


def rounding_left(step: float, noise: float) -> float:
    r"""Standard uncertainty that rounding leaves in a mean of readings with normal noise.

    .. math:: u = q / \sqrt{12} \; e^{-2 (\pi \sigma / q)^2}

    Noise of more than half a step spreads the readings over several codes, and their mean is free
    of the steps.

    Examples
    --------
    >>> print(round(rounding_left(1.0, 0.0), 3), round(rounding_left(1.0, 0.5), 3))
    0.289 0.002
    """
    if not step:
        return 0.0
    return float(step / np.sqrt(12) * np.exp(-2 * (np.pi * noise / step) ** 2))


def step_that_fills(values: Floats) -> float:
    """Step between neighbours by value: half of the whole range lies in steps at least as long.

    Readings that fall on the same few places again and again leave it as long as those are apart.

    Examples
    --------
    >>> print(step_that_fills(np.array([0.0, 1, 2, 3, 0.001, 1.001, 2.001])))
    0.999
    """
    steps = np.sort(np.diff(np.sort(values[np.isfinite(values)])))
    if not steps.size:
        return 0.0
    reached = np.cumsum(steps)
    return float(steps[np.searchsorted(reached, reached[-1] / 2)])


def median_step_reaches(series: Floats, factor: float, value: float) -> bool:
    """Whether a multiple of the median difference of neighbours is as great as a value.

    Parameters
    ----------
    series : ndarray, shape (n_samples,)
        Two samples or more, such as times. [any]
    factor : float
        Positive. [1]
    value : float
        What the multiple is held against. [as series]

    Returns
    -------
    reaches : bool
        As ``factor * np.median(np.diff(series)) >= value`` has it. [1]

    Raises
    ------
    ZeroDivisionError
        If there is no difference.

    Notes
    -----
    The median lies where half of the differences are below it, so it need not be known: they are
    counted.  Where one half is below and the other is not, it is the mean of the two beside.

    Examples
    --------
    >>> median_step_reaches(np.array([0.0, 1.0, 2.0, 9.0]), 3.0, 7.0)
    False
    """
    n_below, below, above = 0, -np.inf, np.inf
    for part in sample_blocks(series.size, series, overlap=1):
        steps = np.diff(series[part])
        is_below = factor * steps < value
        n_below += int(np.count_nonzero(is_below))
        below = max(below, float(steps[is_below].max(initial=-np.inf)))
        above = min(above, float(steps[~is_below].min(initial=np.inf)))
    share = 2 * n_below / (series.size - 1)
    return share < 1 or (share == 1 and bool(factor * ((below + above) / 2) >= value))


def interval_labels(
    like: NDArray[Any],
    first: NDArray[np.integer[Any]],
    stop: NDArray[np.integer[Any]],
    values: NDArray[Any],
) -> NDArray[Any]:
    """Value of the interval of each sample, 0 outside all.

    Parameters
    ----------
    like : ndarray, shape (..., n_samples)
        A series of the record, beside which the labels lie. [any]
    first, stop : ndarray of int, shape (n_intervals,)
        First sample, and the one after the last; in order, without overlap. [1]
    values : ndarray, shape (n_intervals,)
        One an interval. [any]

    Returns
    -------
    labels : ndarray, shape (n_samples,)
        Of the type of the values. [as values]

    Raises
    ------
    ValueError
        If intervals overlap.

    Examples
    --------
    >>> interval_labels(np.zeros(5), np.array([1, 3]), np.array([2, 5]), np.array([7, 8]))
    array([0, 7, 0, 8, 8])
    """
    edges = np.column_stack([first, stop]).ravel()
    between = np.zeros(edges.size + 1, dtype=values.dtype)
    between[1::2] = values
    labels = empty_like(like, shape=like.shape[-1], dtype=values.dtype)
    for part in sample_blocks(labels.size, labels):
        inside = slice(*np.searchsorted(edges, [part.start, part.stop]))
        lengths = np.diff(np.concatenate([[part.start], edges[inside], [part.stop]]))
        labels[part] = np.repeat(between[inside.start : inside.stop + 1], lengths)
    return labels


def over_intervals(
    operation: np.ufunc,
    series: NDArray[Any],
    first: NDArray[np.integer[Any]],
    stop: NDArray[np.integer[Any]],
) -> NDArray[Any]:
    """Sum, least or greatest of the samples of each interval, in bounded memory.

    Parameters
    ----------
    operation : ufunc
        ``np.add``, ``np.minimum``, ``np.maximum``.
    series : ndarray, shape (n_samples,)
        In memory or on disk. [any]
    first : ndarray of int, shape (n_intervals,)
        First sample of each; intervals may overlap, in any order. [1]
    stop : ndarray of int, shape (n_intervals,)
        Sample after the last, greater than ``first``. [1]

    Returns
    -------
    results : ndarray, shape (n_intervals,)
        One an interval. [as series]

    Raises
    ------
    IndexError
        If an interval begins beyond the series.

    Examples
    --------
    >>> over_intervals(np.add, np.arange(6.0), np.array([0, 3]), np.array([3, 5]))
    array([3., 7.])
    """
    results = np.empty(first.size, dtype=series.dtype)
    if (np.diff(first) < 0).any():
        order = np.argsort(first, kind="stable")
        results[order] = over_intervals(operation, series, first[order], stop[order])
        return results
    reached = np.maximum.accumulate(stop)
    at = 0
    while at < first.size:
        low = int(first[at])
        end = int(np.searchsorted(reached, low + BLOCK, side="right"))
        if end <= at:  # longer than a block
            own, end = series[low : int(stop[at])], at + 1
            parts = [
                operation.reduce(own[part]) for part in sample_blocks(own.size, own, size=BLOCK)
            ]
            results[at] = operation.reduce(np.array(parts))
        else:
            bounds = np.column_stack([first[at:end], stop[at:end]]).ravel() - low
            samples = series[low : int(reached[end - 1]) + 1]
            if reached[end - 1] == series.size:  # reduceat takes no bound after the last sample
                samples = np.append(samples, samples[-1:])
            results[at:end] = operation.reduceat(samples, bounds)[::2]
        release_pages(series)
        at = end
    return results
