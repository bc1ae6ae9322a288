r"""Fundamental of a series over each cycle, at the cycle's own frequency.

.. math:: y(t) \approx \bar y + a \cos \omega t + b \sin \omega t, \qquad
          \omega = 2\pi / (t_\text{last} - t_\text{first})

References
----------
.. [1] CG-D-39-80, sec. 2.2 and eqs. 1-4: a rope's tension leads its strain; the part in
   phase is stored, the part in quadrature is lost.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from reduction.cycles.energy import sums_over_cycles
from reduction.errors import DataError
from reduction.record import Floats, Integers, freeze_arrays

__all__ = ["CycleBasis", "cycle_basis", "fundamental", "mean_drift", "part_means"]


@dataclass(frozen=True)
class CycleBasis:
    """Cosine and sine of each sample's phase in its cycle, times its share of the cycle.

    ``share`` (twice the trapezoid's weight over the period), ``cosine`` and ``sine`` have
    shape (n_samples,); ``end_share`` is the share of the last sample of each cycle, whose
    phase is a whole turn; ``first`` and ``last`` are the cycles they were made for.
    """

    share: Floats
    cosine: Floats
    sine: Floats
    end_share: Floats
    first: Integers
    last: Integers

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        freeze_arrays(self)


def cycle_basis(time: Floats, first: Integers, last: Integers) -> CycleBasis:
    """Basis of the fundamental, common to all specimens of a test.

    Parameters
    ----------
    time : ndarray, shape (n_samples,)
        Elapsed time, rising inside a cycle; steps need not be equal. [s]
    first, last : ndarray of int, shape (n_cycles,)
        First and last sample of each cycle, both inside. [1]

    Returns
    -------
    basis : CycleBasis
        Weighted cosine and sine.

    Raises
    ------
    DataError
        If a cycle takes no time.

    Examples
    --------
    >>> basis = cycle_basis(np.arange(9.0), np.array([0]), np.array([8]))
    >>> bool(abs(basis.sine[:8].sum()) < 1e-15)
    True
    """
    period = time[last] - time[first]
    if not np.all(period > 0):
        bad = int(np.flatnonzero(~(period > 0))[0])
        raise DataError(
            f"cycle {bad + 1} takes no time",
            found=f"{period[bad]:g} s from its first to its last sample",
            needed="a time channel that rises over the cycle",
        )
    weight = np.zeros_like(time)
    np.subtract(time[2:], time[:-2], out=weight[1:-1])
    # an end of the cycle counts half; the other half belongs to the cycle that it touches
    weight[first] = time[first + 1] - time[first]
    # one value a sample from one value a cycle, with nothing between cycles
    gaps = np.diff(first, append=time.size) - (last - first)
    lengths = np.column_stack([last - first, gaps]).ravel()
    nothing = np.zeros(first.size)
    begin = int(first[0]) if first.size else time.size
    rate = np.repeat(np.column_stack([2 * np.pi / period, nothing]).ravel(), lengths)
    phase = time[begin:] - np.repeat(np.column_stack([time[first], nothing]).ravel(), lengths)
    phase *= rate
    rate *= weight[begin:]
    rate /= 2 * np.pi
    share, cosine, sine = np.zeros_like(time), np.zeros_like(time), np.zeros_like(time)
    share[begin:] = rate
    np.multiply(np.cos(phase), rate, out=cosine[begin:])
    np.multiply(np.sin(phase, out=phase), rate, out=sine[begin:])
    end_share = (time[last] - time[last - 1]) / period
    return CycleBasis(share, cosine, sine, end_share, first, last)


def fundamental(values: Floats, basis: CycleBasis) -> tuple[Floats, Floats, Floats]:
    """Cosine and sine amplitude of the fundamental in each cycle, and its mean.

    Parameters
    ----------
    values : ndarray, shape (n_samples,)
        Without NaN. [any]
    basis : CycleBasis
        From `cycle_basis`.

    Returns
    -------
    cosine, sine, mean : ndarray, shape (n_cycles,)
        Amplitudes and mean over time, in the unit of the series. [any]

    Raises
    ------
    IndexError
        If the series is shorter than the cycles.

    Notes
    -----
    A drift d over the cycle, linear in time, adds -d/pi to the sine: see `mean_drift`.

    Examples
    --------
    >>> t = np.arange(13.0)
    >>> basis = cycle_basis(t, np.array([0]), np.array([12]))
    >>> wave = 7 + 3 * np.cos(2 * np.pi * t / 12) - np.sin(2 * np.pi * t / 12)
    >>> print(*(part.round(12) for part in fundamental(wave, basis)))
    [3.] [-1.] [7.]
    """
    first, last = basis.first, basis.last
    at_end = values[last] * basis.end_share
    cosine = sums_over_cycles(values * basis.cosine, first, last) + at_end
    sine = sums_over_cycles(values * basis.sine, first, last)
    mean = (sums_over_cycles(values * basis.share, first, last) + at_end) / 2
    return cosine, sine, mean


def part_means(values: Floats, basis: CycleBasis, middles: Integers) -> Floats:
    """Mean over time of a series in the three parts of each cycle between its middles.

    Parameters
    ----------
    values : ndarray, shape (n_samples,)
        Without NaN. [any]
    basis : CycleBasis
        From `cycle_basis`.
    middles : ndarray of int, shape (2, n_cycles)
        Middle sample of the rise and of the fall, rising between the ends of the cycle. [1]

    Returns
    -------
    means : ndarray, shape (3, n_cycles)
        In the unit of the series. [any]

    Raises
    ------
    IndexError
        If the series is shorter than the cycles.

    Examples
    --------
    >>> basis = cycle_basis(np.arange(9.0), np.array([0]), np.array([8]))
    >>> print(part_means(np.repeat([1.0, 3.0, 5.0], 3), basis, np.array([[3], [6]])).ravel())
    [1. 3. 5.]
    """
    first, last, share = basis.first, basis.last, basis.share
    weighted = values * share
    ends = (first, *middles, last)
    means = []
    for start, stop in pairwise(ends):
        total = sums_over_cycles(weighted, start, stop)
        weight = sums_over_cycles(share, start, stop)
        if stop is last:
            total += values[last] * basis.end_share
            weight += basis.end_share
        means.append(total / weight)
    return np.array(means)


def mean_drift(means: Floats, ends: Floats) -> Floats:
    """Steady drift of a series over each cycle, from its means across the ends of cycles.

    Parameters
    ----------
    means : ndarray, shape (3, n_cycles)
        Of the three parts of each cycle, from `part_means`. [any]
    ends : ndarray, shape (4, n_cycles)
        Times of the start, the middles of rise and fall, and the end; where the end of a
        cycle is the start of the next, the two touch. [s]

    Returns
    -------
    drift : ndarray, shape (n_cycles,)
        That of the next cycle at an end of a run; zero where fewer than three cycles touch.
        [any]

    Raises
    ------
    IndexError
        If the arrays differ in length.

    Notes
    -----
    A mean from the middle of one rise to the middle of the next, or from fall to fall, is
    that of a period; the two together lie around the end of a cycle, and the change from one
    end to the other is the drift.  At such a middle the series is near its mean, so a sample
    more or less, as noise puts the turns, does not enter; in a mean from turn to turn it does,
    with the whole amplitude.  Beside a transient (the first cycle after a ramp, a change of
    amplitude) one of these changes says nothing of this cycle: the median of three neighbours
    is taken, and of two the lesser, or zero where they disagree in sign.

    Examples
    --------
    Means that grow by 2 a cycle, and a transient in the first cycle of four.

    >>> ends = np.array([[0.0], [2], [6], [8]]) + np.arange(0, 32, 8)
    >>> print(mean_drift(np.tile(2 * np.arange(4.0), (3, 1)), ends))
    [2. 2. 2. 2.]
    >>> print(mean_drift(np.array([[9.0, 5, 5, 5], [6, 5, 5, 5], [5, 5, 5, 5]]), ends))
    [0. 0. 0. 0.]
    """
    n_cycles = means.shape[1]
    if n_cycles < 3:
        return np.zeros(n_cycles)
    times = np.diff(ends, axis=0)
    low, mid, high = means * times
    from_rise = mid[:-1] + high[:-1] + low[1:]
    from_fall = high[:-1] + low[1:] + mid[1:]
    around_end = from_rise / (times[1, :-1] + times[2, :-1] + times[0, 1:])
    around_end += from_fall / (times[2, :-1] + times[0, 1:] + times[1, 1:])
    around_end /= 2
    around_end[ends[3, :-1] != ends[0, 1:]] = np.nan
    change = np.full(n_cycles, np.nan)
    change[1:-1] = np.diff(around_end)
    beside = np.stack([np.append(np.nan, change[:-1]), change, np.append(change[1:], np.nan)])
    n_known = np.isfinite(beside).sum(axis=0)
    drift = np.where(n_known == 3, np.median(beside, axis=0), change)
    two = n_known == 2
    pair = np.sort(beside[:, two], axis=0)[:2]  # NaN is sorted last
    lesser = np.where(np.abs(pair[0]) < np.abs(pair[1]), pair[0], pair[1])
    drift[two] = np.where(pair[0] * pair[1] > 0, lesser, 0.0)
    # an end of a run has no change of its own: that of its neighbour is the best guess
    touches = np.isfinite(around_end)
    of_next = np.append(np.where(touches, drift[1:], np.nan), np.nan)
    of_last = np.append(np.nan, np.where(touches, drift[:-1], np.nan))
    own = np.where(np.isfinite(change), drift, np.nan)
    found = np.where(np.isfinite(own), own, np.where(np.isfinite(of_next), of_next, of_last))
    return np.nan_to_num(found, nan=0.0)
