"""Fewer points for a figure, with every extreme and every gap still in it.

A record of millions of rows is cut into intervals of equal width along its axis; of
each interval the least and the greatest sample stay, at their own places.  A single
spike therefore cannot disappear, however long the record is.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from reduction.errors import DataError
from reduction.record import Floats, Integers

POINTS = 2000
"""Most points of one trace; a screen has fewer columns than that."""


def keep_extremes(coordinate: Floats, *channels: Floats, limit: int = POINTS) -> NDArray[np.intp]:
    """Return the indices of the samples to draw, in order.

    Parameters
    ----------
    coordinate : ndarray, shape (n_samples,)
        Along which the intervals have equal width: time, or its logarithm.  Where it
        runs backward or is missing the sample stays in the interval before it.
    *channels : ndarray, shape (n_samples,)
        Whose extremes are kept; a sample that is not finite is a gap.
    limit : int
        Most indices returned.

    Returns
    -------
    indices : ndarray of int, shape (n_kept,)
        Rising.  All of them where there are no more than ``limit`` samples.

    Raises
    ------
    DataError
        If there is no channel, or the limit leaves no room for one interval.

    Examples
    --------
    >>> tension = np.zeros(10000)
    >>> tension[1234] = 5.0
    >>> bool(1234 in keep_extremes(np.arange(10000.0), tension, limit=100))
    True
    """
    n_samples = coordinate.shape[0]
    gaps = [~np.isfinite(channel) for channel in channels]
    # least, greatest, and where a channel has gaps one sample of a gap, for each interval
    share = sum(2 + bool(gap.any()) for gap in gaps)
    n_intervals = (limit - 2) // share if share else 0
    if n_intervals < 1:
        raise DataError(
            "a trace cannot be thinned out",
            found=f"{len(channels)} channels and at most {limit} points",
            needed="at least one channel, and four points for each",
        )
    if n_samples <= limit:
        return np.arange(n_samples)
    interval = _intervals(coordinate, n_intervals)
    starts = np.flatnonzero(np.diff(interval, prepend=-1))
    kept = [np.array([0, n_samples - 1])]
    for channel, gap in zip(channels, gaps, strict=True):
        kept.append(_least(np.where(gap, np.inf, channel), interval, starts))
        kept.append(_least(np.where(gap, np.inf, -channel), interval, starts))
        if gap.any():
            missing = np.flatnonzero(gap)
            kept.append(missing[np.flatnonzero(np.diff(interval[missing], prepend=-1))])
    return np.unique(np.concatenate(kept))


def least_and_greatest(
    coordinate: Floats, channel: Floats, *, n_intervals: int = POINTS // 4
) -> tuple[Floats, Floats, Floats]:
    """Return the edges of what a channel does in intervals of equal width.

    For a record of so many cycles that a line through them would be a block of colour.

    Parameters
    ----------
    coordinate : ndarray, shape (n_samples,)
        Along which the intervals have equal width, as in `keep_extremes`.
    channel : ndarray, shape (n_samples,)
        What is drawn; a sample that is not finite is left out. [any]
    n_intervals : int
        Most intervals. [1]

    Returns
    -------
    middle : ndarray, shape (n_found,)
        Middle of the samples of each interval. [as coordinate]
    least, greatest : ndarray, shape (n_found,)
        NaN of an interval without a finite sample. [as channel]

    Examples
    --------
    >>> wave = np.tile([1.0, 5.0, 2.0], 100)
    >>> middle, least, greatest = least_and_greatest(np.arange(300.0), wave, n_intervals=3)
    >>> print(middle, least, greatest)
    [ 49.5 149.5 249.5] [1. 1. 1.] [5. 5. 5.]
    """
    if not channel.size:
        return coordinate, channel, channel
    interval = _intervals(coordinate, n_intervals)
    starts = np.flatnonzero(np.diff(interval, prepend=-1))
    ends = np.append(starts[1:], channel.size) - 1
    middle = (coordinate[starts] + coordinate[ends]) / 2
    return middle, np.fmin.reduceat(channel, starts), np.fmax.reduceat(channel, starts)


def with_gaps(piece: Integers, *series: Floats) -> list[Floats]:
    """Put a sample that is not there between pieces, so that no line is drawn across.

    Parameters
    ----------
    piece : ndarray of int, shape (n_samples,)
        Number of the piece that each sample is in.
    *series : ndarray, shape (n_samples,)
        What is drawn. [any]

    Returns
    -------
    broken : list of ndarray, shape (n_samples + n_gaps,)
        NaN in each gap. [as in series]

    Examples
    --------
    >>> print(*with_gaps(np.array([0, 0, 1]), np.array([1.0, 2.0, 9.0])))
    [ 1.  2. nan  9.]
    """
    places = np.flatnonzero(np.diff(piece)) + 1
    return [np.insert(values, places, np.nan) for values in series]


def _intervals(coordinate: Floats, n_intervals: int) -> NDArray[np.int64]:
    """Return the number of the interval of each sample, never falling."""
    finite = np.isfinite(coordinate)
    rising = np.maximum.accumulate(np.where(finite, coordinate, -np.inf))
    if not finite.any() or rising[-1] <= coordinate[finite][0]:
        # no axis to go by: equal numbers of samples instead
        rank = np.arange(coordinate.shape[0], dtype=np.int64)
        return np.asarray(rank * n_intervals // coordinate.shape[0])
    first = coordinate[finite][0]
    place = np.maximum(rising - first, 0.0) / (rising[-1] - first) * n_intervals
    return np.asarray(np.minimum(place.astype(np.int64), n_intervals - 1))


def _least(
    channel: Floats, interval: NDArray[np.int64], starts: NDArray[np.intp]
) -> NDArray[np.intp]:
    """Return the index of the first least sample of each interval."""
    counts = np.diff(np.append(starts, channel.shape[0]))
    is_least = channel == np.repeat(np.minimum.reduceat(channel, starts), counts)
    hits = np.flatnonzero(is_least)
    return hits[np.flatnonzero(np.diff(interval[hits], prepend=-1))]
