"""Where the crosshead stands still: holds under tension and rests at slack.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_same_shape
from reduction.errors import DataError
from reduction.phases.blocks import block_extremes, still_blocks
from reduction.phases.noise import noise_range
from reduction.record import Bools, Floats, Integers, freeze_arrays
from reduction.settings import PhaseSettings

__all__ = ["Standstills", "find_standstills", "median_step"]

_FEWEST_SAMPLES = 4  # two equal samples may be the two sides of a peak
_SLACK_SHARE = 0.02
_STEPS_READ = 100_001


@dataclass(frozen=True)
class Standstills:
    """Every interval in which the crosshead stands still, in order of time.

    Parameters
    ----------
    first, last : ndarray of int, shape (n_standstills,)
        First and last sample, both inside.
    start_time, end_time : ndarray, shape (n_standstills,)
        Elapsed time at them. [s]
    mean_position : ndarray, shape (n_standstills,)
        Mean crosshead position. [m]
    mean_tension : ndarray, shape (n_specimens, n_standstills)
        Mean tension over the interval. [N]
    is_rest : ndarray of bool, shape (n_standstills,)
        True where every specimen is slack.
    position_tolerance : float
        Range of position that was allowed inside a standstill. [m]
    slack_tension : float
        Tension at or below which a standstill is a rest. [N]
    """

    first: Integers
    last: Integers
    start_time: Floats
    end_time: Floats
    mean_position: Floats
    mean_tension: Floats
    is_rest: Bools
    position_tolerance: float
    slack_tension: float

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        freeze_arrays(self)

    @property
    def n_standstills(self) -> int:
        """Number of intervals."""
        return int(self.first.shape[0])

    def covers(self, n_samples: int) -> Bools:
        """Samples of a record that lie inside a standstill, shape (n_samples,)."""
        is_still = np.zeros(n_samples, dtype=bool)
        for first, last in zip(self.first, self.last, strict=True):
            is_still[first : last + 1] = True
        return is_still


def _reach(position: Floats, edge: Integers, centre: Floats, half: float, step: int) -> Integers:
    """Samples beyond each edge, at most ``abs(step)``, that stay near the centre."""
    offsets = np.sign(step) * np.arange(1, abs(step) + 1)
    index = edge[:, None] + offsets
    inside = (index >= 0) & (index < position.size)
    value = position[np.clip(index, 0, position.size - 1)]
    near = inside & ~(np.abs(value - centre[:, None]) > half)  # a missing sample is no movement
    return np.where(near.all(axis=1), abs(step), np.argmin(near, axis=1))


def _interval_means(values: Floats, first: Integers, last: Integers) -> Floats:
    """Mean of the finite values of each interval, NaN where there are none."""
    if first.size == 0:
        return np.empty(0)
    bounds = np.column_stack([first, last + 1]).ravel()
    if bounds[-1] == values.size:
        bounds = bounds[:-1]
    total = np.add.reduceat(values, bounds)[::2]
    mean = np.asarray(total / (last - first + 1))
    for i in np.flatnonzero(np.isnan(mean)):
        finite = values[first[i] : last[i] + 1]
        finite = finite[np.isfinite(finite)]
        mean[i] = finite.mean() if finite.size else np.nan
    return mean


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
    steps = time[first + 1] - time[first]
    steps = steps[steps > 0]
    if steps.size == 0:
        raise DataError("time does not advance", needed="at least one later sample")
    return float(np.median(steps))


def _slack_tension(tension: Floats) -> float:
    """Two hundredths of the greatest tension, or the noise about zero, of any specimen."""
    levels = [0.0]
    for one in tension:
        sampled = one[:: max(1, one.size // _STEPS_READ)]
        sampled = sampled[np.isfinite(sampled)]
        if sampled.size >= 8:
            levels += [_SLACK_SHARE * float(sampled.max()), noise_range(one) / 2]
    return max(levels)


def find_standstills(
    time: ArrayLike, position: ArrayLike, tension: ArrayLike, *, settings: PhaseSettings
) -> Standstills:
    """Find every interval in which the crosshead stands still, and say which are rests.

    Parameters
    ----------
    time : array_like, shape (n_samples,)
        Elapsed time. [s]
    position : array_like, shape (n_samples,)
        Crosshead position; NaN where missing. [m]
    tension : array_like, shape (n_specimens, n_samples)
        Tension; NaN where missing. [N]
    settings : PhaseSettings
        What is None there is found here and written into the result. [SI]

    Returns
    -------
    standstills : Standstills
        In order of time; none where the crosshead never stands. [SI]

    Raises
    ------
    DataError
        If the series do not pair up, have fewer than four samples or no finite
        position, or time does not advance.

    Notes
    -----
    *Tolerance.* None: `noise_range` of position.  The crosshead stands where the range
    of position stays within it over every stretch of the shortest duration, and within
    twice that over the whole interval; the edges are where it comes and goes nearer to
    the mean than half the tolerance.

    *Duration.* At least ``minimum_duration`` and at least four samples, so that the two
    samples beside a peak of a slow log are no hold.  A movement too slow to leave the
    tolerance within that time is told from a hold by wider windows, and the turn of a
    slow cycle by its neighbourhood: from a standstill the crosshead gets four tolerances
    away within as long as it stood, before it or after it.

    *Rests.* A standstill whose mean tension is at or below the slack tension for every
    specimen.  None: the greater of 2 % of the greatest tension of the record and half
    the `noise_range` of tension, by the specimen where it is larger; a record that
    never goes slack has no rests.

    Missing samples inside a standstill do not end it.  The record is read in blocks of
    a quarter of the shortest standstill; edges are found to the sample.

    Examples
    --------
    One minute slack, a pull of 10 s, one minute at 1 m.

    >>> time = np.arange(0, 130.0)
    >>> position = np.interp(time, [0, 60, 70, 130], [0, 0, 1, 1])
    >>> found = find_standstills(time, position, [100 * position], settings=PhaseSettings())
    >>> print(found.start_time, found.end_time, found.is_rest)
    [ 0. 70.] [ 60. 129.] [ True False]
    """
    tension = np.atleast_2d(np.asarray(tension, dtype=np.float64))
    time, position, _ = as_same_shape(time=time, position=position, tension=tension[0])
    if time.size < _FEWEST_SAMPLES or not np.isfinite(position).any():
        raise DataError(
            "the record is too short to stand still",
            found=f"{int(np.isfinite(position).sum())} positions in {time.size} rows",
            needed=f"{_FEWEST_SAMPLES} rows or more",
        )
    tolerance = settings.position_tolerance
    if tolerance is None:
        tolerance = noise_range(position)
    slack = settings.slack_tension
    if slack is None:
        slack = _slack_tension(tension)

    fewest = max(ceil(settings.minimum_duration / median_step(time) - 1e-6) + 1, _FEWEST_SAMPLES)
    length = max(fewest // 4, 1)
    # a standstill of the fewest samples holds this many whole blocks, wherever it begins
    window = max((fewest - length + 1) // length, 1)
    least, greatest = block_extremes(position, length)
    first_block, last_block = still_blocks(least, greatest, window=window, tolerance=tolerance)

    first = first_block * length
    last = np.minimum((last_block + 1) * length, position.size) - 1
    centre = _interval_means(position, first, last)
    for block, step in ((first_block, 1), (last_block, -1)):  # a block that moves is no edge
        outside = np.ones(centre.size, dtype=bool)
        while outside.any():
            outside = (greatest[block] - centre > tolerance / 2) | (
                centre - least[block] > tolerance / 2
            )
            outside &= first_block < last_block
            block[outside] += step
    first = first_block * length
    last = np.minimum((last_block + 1) * length, position.size) - 1
    first -= _reach(position, first, centre, tolerance / 2, -length)
    last += _reach(position, last, centre, tolerance / 2, length)
    last[:-1] = np.minimum(last[:-1], first[1:] - 1)

    for edge, step in ((first, 1), (last, -1)):  # an edge is a sample that is there
        for i in np.flatnonzero(np.isnan(position[edge])):
            edge[i] += step * np.argmax(np.isfinite(position[first[i] : last[i] + 1][::step]))

    long_enough = (time[last] - time[first] >= settings.minimum_duration * (1 - 1e-6)) & (
        last - first + 1 >= _FEWEST_SAMPLES
    )
    first, last = first[long_enough], last[long_enough]
    mean_tension = np.array([_interval_means(one, first, last) for one in tension])
    return Standstills(
        first=first,
        last=last,
        start_time=time[first],
        end_time=time[last],
        mean_position=_interval_means(position, first, last),
        mean_tension=mean_tension.reshape(tension.shape[0], first.size),
        is_rest=(mean_tension <= slack).all(axis=0).reshape(first.size),
        position_tolerance=float(tolerance),
        slack_tension=float(slack),
    )
