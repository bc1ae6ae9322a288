"""Series of samples in memory or on disk, processed block by block."""

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

# GNU C library only; other systems return freed memory by themselves
_MALLOC_TRIM = getattr(ctypes.CDLL(None), "malloc_trim", None) if os.name == "posix" else None

_ON_DISK_FROM = 1 << 20  # bytes; less is not worth a file

_LONG = 1 << 22  # bytes of a series above which memory freed by earlier stages is worth returning

_name: str | None = None  # prefix of named scratch files, None for files without a name


class _ScratchMap(mmap.mmap):
    """A mapped scratch file; one without a name disappears with the last array on it."""

    folder: Path
    name: str | None


def scratch_folder() -> Path:
    """Return the scratch folder: TMPDIR, else /var/tmp, on disk where /tmp may not be."""
    if stated := os.environ.get("TMPDIR"):
        return Path(stated)  # tempfile would fall back to /tmp if the folder is full or absent
    usual = Path("/var/tmp")  # noqa: S108 - files there have no name
    return usual if os.access(usual, os.W_OK) else Path(tempfile.gettempdir())


def check_room(folder: Path, n_bytes: int) -> None:
    """Refuse a file whose stated size exceeds the free disk space."""
    if not hasattr(os, "statvfs"):  # available only on POSIX systems
        return
    try:
        disk = os.statvfs(folder)
    except OSError:  # a missing folder is reported when a file is created in it
        return
    free = disk.f_bavail * disk.f_frsize
    if n_bytes > free:
        raise _no_space(folder, n_bytes, f"{free / 1e6:.0f} MB are free")


def name_scratch_files(beginning: str) -> None:
    """Give new scratch files names, so that another process can take them over."""
    global _name
    _name = beginning


def name_of_scratch_file(array: NDArray[Any]) -> tuple[str, Path] | None:
    """Name and folder of the file that holds exactly this array; None if there is none."""
    found = _map_of(array)
    if found is None or found.name is None or array.nbytes != len(found) or array.ndim != 1:
        return None
    return found.name, found.folder


def _is_on_disk(array: NDArray[Any]) -> bool:
    """Whether an array is stored in a scratch file."""
    return _map_of(array) is not None


def release_pages(*arrays: NDArray[Any]) -> None:
    """Release the memory pages of arrays on disk; their values are kept."""
    for array in arrays:
        found = _map_of(array)
        if found is not None and hasattr(mmap, "MADV_DONTNEED"):
            found.madvise(mmap.MADV_DONTNEED)


def trim_heap() -> None:
    """Return memory freed by earlier work to the system.

    The C library keeps freed memory in fragments: half of the memory for a long log after a few
    stages, and 50 MB after the tables of a batch.
    """
    if _MALLOC_TRIM is not None:
        _MALLOC_TRIM(0)


def trim_heap_after(*arrays: NDArray[Any]) -> None:
    """Return freed memory to the system if any of the arrays is long or on disk."""
    if any(array.nbytes >= _LONG or _is_on_disk(array) for array in arrays):
        trim_heap()


def empty_like(
    reference: NDArray[Any],
    *,
    shape: int | tuple[int, ...] | None = None,
    dtype: DTypeLike | None = None,
) -> NDArray[Any]:
    """Return an uninitialised array, on disk if the reference is.

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
    """Return an array moved to disk if the reference is there, else the array itself."""
    if not _is_on_disk(reference):
        return made
    moved = empty_like(reference, shape=made.shape, dtype=made.dtype)
    moved[...] = made
    release_pages(reference, moved)
    return moved


def zeros_like(reference: NDArray[Any], *, dtype: DTypeLike | None = None) -> NDArray[Any]:
    """Return an array of zeros with the shape of another; parameters as in `empty_like`."""
    made = empty_like(reference, dtype=dtype)
    # a new scratch file contains zeros, and so does memory that the system allocates on first use
    return made if _is_on_disk(made) else np.zeros(made.shape, dtype=made.dtype)


class ColumnWriter:
    """A column built from parts, in memory or in a scratch file if a folder is given.

    Parameters
    ----------
    folder : pathlib.Path or None
        Folder of the scratch file; None keeps the column in memory.
    dtype : dtype
        Type of the column.
    """

    def __init__(self, folder: Path | None, dtype: DTypeLike = np.float64) -> None:
        """Start an empty column."""
        self._folder = folder
        self._dtype = np.dtype(dtype)
        self._parts: list[NDArray[Any]] = []
        self._file: IO[bytes] | None = None
        self._file = None if folder is None else _scratch_file(folder)
        self.size = 0

    def append(self, values: NDArray[Any]) -> None:
        """Append samples."""
        part = np.ascontiguousarray(values, dtype=self._dtype)
        self.size += part.size
        if self._file is None or self._folder is None:
            self._parts.append(part)
            return
        left = part.data.cast("B") if part.size else memoryview(b"")
        try:
            while left:  # a nearly full disk writes only what fits
                left = left[self._file.write(left) :]
        except OSError as error:
            n_bytes = self.size * self._dtype.itemsize
            raise _no_space(self._folder, n_bytes, error.strerror) from error

    def finish(self) -> NDArray[Any]:
        """Return the column, shape (size,); nothing can be appended afterwards."""
        if self._file is not None and self._folder is not None:
            with self._file as file:
                return mapped(file, self.size * self._dtype.itemsize, self._folder, self._dtype)
        if len(self._parts) == 1 and self._parts[0].flags.writeable:
            return self._parts[0]
        return np.concatenate([np.empty(0, dtype=self._dtype), *self._parts])

    def __del__(self) -> None:
        """Close the file of an abandoned column."""
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
    """Reserve the space at once: mapping a file that does not fit on the disk ends the process."""
    try:
        if hasattr(os, "posix_fallocate"):
            os.posix_fallocate(file.fileno(), 0, n_bytes)
        else:
            file.truncate(n_bytes)
    except OSError as error:
        raise _no_space(folder, n_bytes, error.strerror) from error


def mapped(file: IO[bytes], n_bytes: int, folder: Path, dtype: np.dtype[Any]) -> NDArray[Any]:
    """A scratch file as an array; `DataError` if the address-space limit is reached."""
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
    found.name = file.name if isinstance(file.name, str) else None  # an integer for an unnamed file
    return np.ndarray(n_bytes // dtype.itemsize, dtype=dtype, buffer=found)


def _no_space(folder: Path, n_bytes: int, why: str | None) -> DataError:
    return DataError(
        "the scratch files of a long log do not fit on the disk",
        found=f"no room for {n_bytes / 1e6:.0f} MB in {folder}: {why}",
        needed="about 60 bytes a row and specimen",
        hint="Set TMPDIR to a folder on a disk with room.",
    )


BLOCK = 1 << 16
"""Samples in a block, which fits in the cache. [1]."""

_SPAN = 1 << 20  # samples between releases; each sample touched may load 2 MB of its file


def sample_blocks(
    n_samples: int, *arrays: NDArray[Any], overlap: int = 0, size: int = BLOCK
) -> Iterator[slice]:
    """Consecutive slices that cover a series; pages of arrays on disk are released regularly.

    Yields
    ------
    part : slice
        Slice of samples. [1]

    Examples
    --------
    >>> list(sample_blocks(5, size=2, overlap=1))
    [slice(0, 3, None), slice(2, 5, None), slice(4, 5, None)]
    """
    kept = 0
    for start in range(0, n_samples, size):
        yield slice(start, min(start + size + overlap, n_samples))
        kept += size
        if kept >= _SPAN // 2 or start + size >= n_samples:  # not worth the call for less
            release_pages(*arrays)
            kept = 0


def take_samples(series: NDArray[Any], index: NDArray[np.integer[Any]]) -> NDArray[Any]:
    """Return selected samples of a series, like ``series[..., index]``, in bounded memory.

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
    if is_to_and_fro:  # one pass over all samples instead
        order = np.argsort(flat, kind="stable")
        taken[..., order] = take_samples(series, flat[order])
    else:
        for start, stop in pairwise([0, *edges.tolist(), flat.size]):
            taken[..., start:stop] = series[..., flat[start:stop]]
            release_pages(series)
    return taken.reshape(*series.shape[:-1], *index.shape)


def readings_between(
    at: NDArray[np.float64], stamps: NDArray[np.float64], series: NDArray[np.float64]
) -> NDArray[np.float64]:
    r"""Readings of a channel at other times, by cubics through the four readings around each.

    Parameters
    ----------
    at : ndarray, shape (n_samples,)
        Times, finite or NaN. [s]
    stamps : ndarray, shape (n_readings,)
        Times of the readings, increasing. [s]
    series : ndarray, shape (n_readings,)
        Readings. [any]

    Returns
    -------
    values : ndarray, shape (n_samples,)
        NaN between two readings of which one is missing; beyond the ends those of the ends. [as
        series]

    Notes
    -----
    A straight line between two readings cuts the crest of a wave off: half way between two of n
    readings a cycle it leaves :math:`\cos(\pi / n)` of the amplitude, 3.4 % less at n = 12.  The
    cubic is the line plus the second divided differences :math:`D_1, D_2` at its two readings:

    .. math:: (x - x_1)(x - x_2) \frac{D_1 (x_3 - x) + D_2 (x - x_0)}{x_3 - x_0}

    Beside a jump, a corner, or a level at which a channel stays, only one of them differs from
    zero, and a cubic overshoots: neither counts as more than three times the other, and if they
    differ in sign, as noise makes them, the line is kept.

    Examples
    --------
    Half way between twelve readings a cycle of a sine, and beside a level:

    >>> rows = np.arange(24.0)
    >>> found = readings_between(rows + 0.5, rows, np.cos(np.pi / 6 * rows))
    >>> print(round(float(found[12] / np.cos(np.pi / 12)), 3))
    0.998
    >>> print(readings_between(np.array([1.5]), rows[:4], np.array([0.0, 8.0, 8.0, 8.0])))
    [8.]
    """
    values = empty_like(at, dtype=np.float64)
    for part in sample_blocks(at.size, at, stamps, series, values):
        place = at[part]
        second = np.clip(np.searchsorted(stamps, place), 1, max(stamps.size - 1, 1))
        begin, end = max(int(second.min()) - 2, 0), int(second.max()) + 2
        t, x = stamps[begin:end], series[begin:end]
        values[part] = np.interp(place, t, x)
        if t.size < 4:
            continue
        slope = np.diff(x) / np.diff(t)
        bend = np.diff(slope) / (t[2:] - t[:-2])
        first = np.clip(second - begin - 2, 0, t.size - 4)  # reading before the two beside
        one, other = bend[first], bend[first + 1]
        is_inside = (place > t[first + 1]) & (place < t[first + 2]) & (one * other > 0)
        most = 3 * np.minimum(abs(one), abs(other))
        one, other = np.clip(one, -most, most), np.clip(other, -most, most)
        before, after = place - t[first], t[first + 3] - place
        cubic = (place - t[first + 1]) * (place - t[first + 2]) * (one * after + other * before)
        values[part] += np.where(is_inside, cubic / (before + after), 0.0)
    return values


def count_samples(where: NDArray[Any]) -> int:
    """Number of samples that are true or nonzero."""
    return sum(int(np.count_nonzero(where[part])) for part in sample_blocks(where.size, where))


def finite_extremes(series: NDArray[np.float64]) -> tuple[float, float]:
    """Smallest and largest finite sample; infinity and minus infinity if there is none.

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
    """Sample-by-sample mean of several series, shape (n_samples,); on disk if they are.

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
    """Return a writeable copy, on disk if the series is."""
    copy = empty_like(series)
    for part in sample_blocks(series.shape[-1], series, copy):
        copy[..., part] = series[..., part]
    return copy


def full_like(
    reference: NDArray[Any], value: float, *, shape: int | tuple[int, ...] | None = None
) -> NDArray[Any]:
    """Return an array filled with one number; parameters as in `empty_like`."""
    made = empty_like(reference, shape=shape)
    flat = made.reshape(-1)
    for part in sample_blocks(flat.size, flat):
        flat[part] = value
    return made


def join_columns(parts: Sequence[NDArray[Any]]) -> NDArray[Any]:
    """Join columns, on disk if the first one is; a single column is returned unchanged."""
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
"""Condition on a slice of samples, true or false for each of them."""


def first_sample(where: Where, start: int, stop: int, *samples: NDArray[Any]) -> int | None:
    """First sample from ``start`` up to ``stop`` for which a condition on slices is true.

    ``samples`` are the arrays that the condition reads.
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
    """Samples that meet a condition, thinned evenly to fewer than twice a number.

    Indices in order.

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
        kept.append(block[-before % step :: step].copy())  # a view would keep the block in memory
        before += block.size
    return np.concatenate(kept)


Floats = NDArray[np.float64]


def select_samples(where: Where, *series: NDArray[Any]) -> tuple[NDArray[Any], ...]:
    """Samples of several series at which a condition on slices is true.

    The series themselves if all samples are wanted.

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
    """Series minus a number, shape (n_samples,); on disk if the series is.

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
    """Mean of a series of at least one sample.

    Notes
    -----
    Differences from the first sample are summed, so that the mean of a nearly constant series
    agrees to the last digit or two for any block length.

    Examples
    --------
    >>> mean_of(np.array([1.0, 2.0]))
    1.5
    """
    first = float(series[0])
    parts = sample_blocks(series.size, series)
    return first + float(sum((series[part] - first).sum() for part in parts)) / series.size


_CODES_READ = 1 << 16  # samples

_OF_CODES = 0.99  # minimum share of steps that are whole multiples of one

_OF_TURNS = 0.3  # minimum share of steps followed by a different one


def step_of_codes(values: Floats) -> float:
    """Quantisation step of a channel whose steps are all multiples of it; 0 for others.

    A noiseless ramp also has a single step, but its steps do not vary between multiples.

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
    # if a wave skips codes, the levels of its fall lie between those of its rise
    levels = np.sort(values[:_CODES_READ][np.isfinite(values[:_CODES_READ])])
    apart = np.diff(levels)
    step = float(apart[apart > 1e-9 * moves.max()].min())
    multiple = moves / step
    whole = np.abs(multiple - np.round(multiple)) < 0.05
    turns = np.count_nonzero(np.diff(np.round(steps / step)))
    return step if whole.mean() >= _OF_CODES and turns > _OF_TURNS * moves.size else 0.0


def rounding_left(step: float, noise: float) -> float:
    r"""Standard uncertainty from rounding that remains in the mean of readings with normal noise.

    .. math:: u = q / \sqrt{12} \; e^{-2 (\pi \sigma / q)^2}

    Noise above half a step spreads the readings over several codes, and their mean is then free of
    the quantisation.

    Examples
    --------
    >>> print(round(rounding_left(1.0, 0.0), 3), round(rounding_left(1.0, 0.5), 3))
    0.289 0.002
    """
    if not step:
        return 0.0
    return float(step / np.sqrt(12) * np.exp(-2 * (np.pi * noise / step) ** 2))


def step_that_fills(values: Floats) -> float:
    """Step between sorted neighbours such that half of the range lies in steps at least as long.

    Readings that repeat the same few values do not shorten it below the distance between these.

    Examples
    --------
    >>> print(round(step_that_fills(np.array([0.0, 1, 2, 3, 0.001, 1.001, 2.001])), 9))
    0.999
    """
    steps = np.sort(np.diff(np.sort(values[np.isfinite(values)])))
    if not steps.size:
        return 0.0
    reached = np.cumsum(steps)
    return float(steps[np.searchsorted(reached, reached[-1] / 2)])


def median_step_reaches(series: Floats, factor: float, value: float) -> bool:
    """Whether a multiple of the median step reaches a value.

    Notes
    -----
    The differences below the limit are counted, so that the median itself is not needed.  If
    exactly half are below, the median is the mean of the two differences on either side.

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
    """Value of the interval that contains each sample, 0 outside all.

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
    """Sum, minimum or maximum over each interval, in bounded memory.

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
            if reached[end - 1] == series.size:  # reduceat accepts no end after the last sample
                samples = np.append(samples, samples[-1:])
            results[at:end] = operation.reduceat(samples, bounds)[::2]
        release_pages(series)
        at = end
    return results
