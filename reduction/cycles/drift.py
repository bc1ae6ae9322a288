"""Drift of a series from cycle to cycle, apart from the cycles themselves.

References
----------
.. [1] CG-D-39-80, sec. 4.3: break-in, after which loops still creep.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from reduction.cycles.energy import sums_over_cycles
from reduction.cycles.harmonic import CycleBasis
from reduction.record import Floats, Integers


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
    >>> from reduction.cycles.harmonic import cycle_basis
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
