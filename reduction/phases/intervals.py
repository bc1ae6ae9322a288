"""Intervals in which a channel stands still, whatever the channel.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from math import ceil

import numpy as np

from reduction.errors import DataError
from reduction.phases.blocks import block_extremes, still_blocks
from reduction.record import Floats, Integers
from reduction.samples.blocks import sample_blocks, take_samples
from reduction.samples.intervals import over_intervals

FEWEST_SAMPLES = 4  # two equal samples may be the two sides of a peak
_STEPS_READ = 100_001


def median_step(time: Floats) -> float:
    """Return the median time step, of at most 100,001 steps that advance.

    Parameters
    ----------
    time : ndarray, shape (n_samples,)
        Elapsed time. [s]

    Returns
    -------
    median_step : float
        Greater than zero. [s]

    Raises
    ------
    DataError
        If time does not advance.

    Examples
    --------
    >>> median_step(np.array([0.0, 0.1, 0.2, 0.2, 0.3, 60.0]))
    0.1
    """
    first = np.arange(0, time.size - 1, max(1, time.size // _STEPS_READ))
    steps = take_samples(time, first + 1) - take_samples(time, first)
    steps = steps[steps > 0]
    if steps.size == 0:
        raise DataError("time does not advance", needed="at least one later sample")
    return float(np.median(steps))


def _reach(values: Floats, edge: Integers, centre: Floats, half: float, step: int) -> Integers:
    """Samples beyond each edge, at most ``abs(step)``, that stay near the centre."""
    offsets = np.sign(step) * np.arange(1, abs(step) + 1)
    index = edge[:, None] + offsets
    inside = (index >= 0) & (index < values.size)
    value = take_samples(values, np.clip(index, 0, values.size - 1))
    near = inside & ~(np.abs(value - centre[:, None]) > half)  # a missing sample is no movement
    return np.where(near.all(axis=1), abs(step), np.argmin(near, axis=1))


def interval_means(values: Floats, first: Integers, last: Integers) -> Floats:
    """Mean of the finite values of each interval.

    Parameters
    ----------
    values : ndarray, shape (n_samples,)
        Channel; NaN where missing. [any unit]
    first : ndarray of int, shape (n_intervals,)
        First sample of each interval, in order of time. [1]
    last : ndarray of int, shape (n_intervals,)
        Last sample, inside. [1]

    Returns
    -------
    mean : ndarray, shape (n_intervals,)
        NaN where no value is finite. [unit of the channel]

    Raises
    ------
    IndexError
        If an interval begins beyond the record.

    Examples
    --------
    >>> print(interval_means(np.array([1.0, 3.0, np.nan, 5.0]), np.array([0, 2]), np.array([1, 3])))
    [2. 5.]
    """
    if first.size == 0:
        return np.empty(0)
    mean = np.asarray(over_intervals(np.add, values, first, last + 1) / (last - first + 1))
    for i in np.flatnonzero(np.isnan(mean)):
        mean[i] = _mean_of_finite(values[first[i] : last[i] + 1])
    return mean


def _mean_of_finite(values: Floats) -> float:
    total, count = 0.0, 0
    for part in sample_blocks(values.size, values):
        finite = values[part][np.isfinite(values[part])]
        total, count = total + float(finite.sum()), count + finite.size
    return total / count if count else float("nan")


def still_intervals(
    time: Floats, values: Floats, *, tolerance: float, minimum_duration: float
) -> tuple[Integers, Integers]:
    """First and last sample of every interval in which a channel stands still.

    Parameters
    ----------
    time : ndarray, shape (n_samples,)
        Elapsed time. [s]
    values : ndarray, shape (n_samples,)
        Channel; NaN where missing. [any unit]
    tolerance : float
        Range that the channel keeps over every stretch of the shortest duration; twice that
        over the whole interval. [unit of the channel]
    minimum_duration : float
        Shortest interval; four samples at least. [s]

    Returns
    -------
    first : ndarray of int, shape (n_intervals,)
        First sample, in order of time. [1]
    last : ndarray of int, shape (n_intervals,)
        Last sample, inside. [1]

    Raises
    ------
    DataError
        If time does not advance.

    Notes
    -----
    The record is read in blocks of a quarter of the shortest interval (`still_blocks`);
    edges, found to the sample, are where the channel comes and goes nearer to the mean than
    half the tolerance.  Missing samples do not end an interval and are no edge of one.

    Examples
    --------
    >>> time = np.arange(0, 130.0)
    >>> values = np.interp(time, [0, 60, 70, 130], [0, 0, 1, 1])
    >>> first, last = still_intervals(time, values, tolerance=0.01, minimum_duration=3.0)
    >>> print(first, last)
    [ 0 70] [ 60 129]
    """
    fewest = max(ceil(minimum_duration / median_step(time) - 1e-6) + 1, FEWEST_SAMPLES)
    length = max(fewest // 4, 1)
    # a standstill of the fewest samples holds this many whole blocks, wherever it begins
    window = max((fewest - length + 1) // length, 1)
    least, greatest = block_extremes(values, length)
    first_block, last_block = still_blocks(least, greatest, window=window, tolerance=tolerance)

    first = first_block * length
    last = np.minimum((last_block + 1) * length, values.size) - 1
    centre = interval_means(values, first, last)
    for block, step in ((first_block, 1), (last_block, -1)):  # a block that moves is no edge
        outside = np.ones(centre.size, dtype=bool)
        while outside.any():
            outside = (greatest[block] - centre > tolerance / 2) | (
                centre - least[block] > tolerance / 2
            )
            outside &= first_block < last_block
            block[outside] += step
    first = first_block * length
    last = np.minimum((last_block + 1) * length, values.size) - 1
    first -= _reach(values, first, centre, tolerance / 2, -length)
    last += _reach(values, last, centre, tolerance / 2, length)
    last[:-1] = np.minimum(last[:-1], first[1:] - 1)

    for edge, step in ((first, 1), (last, -1)):  # an edge is a sample that is there
        for i in np.flatnonzero(np.isnan(take_samples(values, edge))):
            edge[i] += step * np.argmax(np.isfinite(values[first[i] : last[i] + 1][::step]))

    duration = take_samples(time, last) - take_samples(time, first)
    long_enough = (duration >= minimum_duration * (1 - 1e-6)) & (last - first + 1 >= FEWEST_SAMPLES)
    return first[long_enough], last[long_enough]
