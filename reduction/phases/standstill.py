"""Where the crosshead stands still: holds under tension and rests at slack.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_same_shape
from reduction.errors import DataError
from reduction.phases.intervals import FEWEST_SAMPLES, interval_means, still_intervals
from reduction.phases.noise import noise_range
from reduction.record import Bools, Floats, Integers, read_only_arrays
from reduction.samples.blocks import sample_blocks, take_samples
from reduction.settings import PhaseSettings

_SLACK_SHARE = 0.02
_STEPS_READ = 100_001


@dataclass(frozen=True)
@read_only_arrays
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
        Range of position that was allowed inside a standstill of the crosshead. [m]
    slack_tension : float
        Tension at or below which a standstill is a rest. [N]
    tension_tolerance : float or None
        Range of tension that was allowed inside a hold, where holds are intervals of
        constant tension; None where the crosshead stands still in them. [N]
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
    tension_tolerance: float | None = None

    @property
    def n_standstills(self) -> int:
        """Number of intervals."""
        return int(self.first.shape[0])

    def covers(self, part: slice) -> Bools:
        """Which samples of a part of the record lie inside a standstill."""
        is_still = np.zeros(part.stop - part.start, dtype=bool)
        here = slice(np.searchsorted(self.last, part.start), np.searchsorted(self.first, part.stop))
        for first, last in zip(self.first[here], self.last[here], strict=True):
            is_still[max(first - part.start, 0) : last + 1 - part.start] = True
        return is_still


def _slack_tension(tension: Floats) -> float:
    """Two hundredths of the greatest tension, or the noise about zero, of any specimen."""
    levels = [0.0]
    for one in tension:
        sampled = take_samples(one, np.arange(0, one.size, max(1, one.size // _STEPS_READ)))
        sampled = sampled[np.isfinite(sampled)]
        if sampled.size >= 8:
            levels += [_SLACK_SHARE * float(sampled.max()), noise_range(one) / 2]
    return max(levels)


def describe_standstills(
    time: Floats,
    position: Floats,
    tension: Floats,
    first: Integers,
    last: Integers,
    *,
    position_tolerance: float,
    slack_tension: float,
    tension_tolerance: float | None = None,
) -> Standstills:
    """Means over given intervals, and which of them are rests.

    Parameters
    ----------
    time : ndarray, shape (n_samples,)
        Elapsed time. [s]
    position : ndarray, shape (n_samples,)
        Crosshead position; NaN where missing. [m]
    tension : ndarray, shape (n_specimens, n_samples)
        Tension; NaN where missing. [N]
    first : ndarray of int, shape (n_standstills,)
        First sample of each interval, in order of time. [1]
    last : ndarray of int, shape (n_standstills,)
        Last sample, inside. [1]
    position_tolerance : float
        As `Standstills` has it. [m]
    slack_tension : float
        As `Standstills` has it. [N]
    tension_tolerance : float, optional
        As `Standstills` has it. [N]

    Returns
    -------
    standstills : Standstills
        Of these intervals. [SI]

    Raises
    ------
    IndexError
        If an interval reaches beyond the record.

    Examples
    --------
    >>> time, load = np.arange(4.0), np.array([[0.0, 0.0, 9.0, 11.0]])
    >>> found = describe_standstills(
    ...     time, time, load, np.array([0, 2]), np.array([1, 3]),
    ...     position_tolerance=1.0, slack_tension=1.0)
    >>> print(found.mean_tension, found.is_rest)
    [[ 0. 10.]] [ True False]
    """
    mean_tension = np.array([interval_means(one, first, last) for one in tension])
    return Standstills(
        first=first,
        last=last,
        start_time=take_samples(time, first),
        end_time=take_samples(time, last),
        mean_position=interval_means(position, first, last),
        mean_tension=mean_tension.reshape(tension.shape[0], first.size),
        is_rest=(mean_tension <= slack_tension).all(axis=0).reshape(first.size),
        position_tolerance=float(position_tolerance),
        slack_tension=float(slack_tension),
        tension_tolerance=tension_tolerance,
    )


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
    if time.size < FEWEST_SAMPLES:
        raise DataError(
            "the record is too short to stand still",
            found=f"{time.size} rows",
            needed=f"{FEWEST_SAMPLES} rows or more",
        )
    parts = sample_blocks(position.size, position)
    if not any(np.isfinite(position[part]).any() for part in parts):
        raise DataError(
            "no position of the record may be used: each is missing, stuck or a spike",
            found=f"0 positions in {time.size} rows",
            needed="a position channel that follows the crosshead",
        )
    tolerance = settings.position_tolerance
    if tolerance is None:
        tolerance = noise_range(position)
    slack = settings.slack_tension
    if slack is None:
        slack = _slack_tension(tension)

    first, last = still_intervals(
        time, position, tolerance=tolerance, minimum_duration=settings.minimum_duration
    )
    return describe_standstills(
        time, position, tension, first, last, position_tolerance=tolerance, slack_tension=slack
    )
