"""Series of samples block by block, in bounded memory wherever they lie.

A stage goes over samples by `sample_blocks`, takes single ones by `take_samples`, and makes what
is as long as a record by `reduction.samples.scratch.empty_like`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from reduction.samples.scratch import empty_like, is_on_disk, let_go

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
            let_go(*arrays)
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
    if not is_on_disk(series):
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
            let_go(series)
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
