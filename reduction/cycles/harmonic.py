r"""Fundamental of a series over each cycle, at the frequency of the cycles around it.

.. math:: y(t) \approx \bar y + a \cos \omega t + b \sin \omega t

by least squares over the samples of the cycle, weighted by time.  Noise and sampling put a turn
a sample early or late, so that a cycle's own duration is no period; the mean over twenty is.

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

_AROUND = 10  # cycles on either side whose durations make the period of one

__all__ = ["CycleBasis", "cycle_basis", "fundamental", "mean_drift", "part_means"]


@dataclass(frozen=True)
class CycleBasis:
    """Cosine and sine of each sample's phase in its cycle, times its share of the cycle.

    ``share`` (twice the trapezoid's weight over the duration), ``cosine`` and ``sine`` have
    shape (n_samples,); ``end_share`` is the share of the last sample of each cycle,
    ``end_cosine`` and ``end_sine`` the same times those of its phase.  ``inverse``, shape
    (n_cycles, 3, 3), turns sums of a series over share, cosine and sine into its mean and
    its two amplitudes; ``first`` and ``last`` are the cycles they were made for.
    """

    share: Floats
    cosine: Floats
    sine: Floats
    end_share: Floats
    end_cosine: Floats
    end_sine: Floats
    inverse: Floats
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
    turn_rate = 2 * np.pi / _mean_period(time, first, last)
    phase = time[begin:] - np.repeat(np.column_stack([time[first], nothing]).ravel(), lengths)
    phase *= np.repeat(np.column_stack([turn_rate, nothing]).ravel(), lengths)
    share, cosine, sine = np.zeros_like(time), np.zeros_like(time), np.zeros_like(time)
    rate = np.repeat(np.column_stack([1 / period, nothing]).ravel(), lengths)
    np.multiply(rate, weight[begin:], out=share[begin:])
    bare = np.cos(phase), np.sin(phase, out=phase)
    np.multiply(bare[0], share[begin:], out=cosine[begin:])
    np.multiply(bare[1], share[begin:], out=sine[begin:])
    end_share = (time[last] - time[last - 1]) / period
    end_phase = turn_rate * period
    end = end_share * np.cos(end_phase), end_share * np.sin(end_phase)
    gram = np.empty((first.size, 3, 3))
    gram[:, 0, 0] = sums_over_cycles(share, first, last) + end_share
    for row, (weighted, at_end) in enumerate(zip((cosine, sine), end, strict=True), start=1):
        gram[:, 0, row] = gram[:, row, 0] = sums_over_cycles(weighted, first, last) + at_end
        products = weighted[begin:] * bare[0]
        gram[:, row, 1] = gram[:, 1, row] = sums_over_cycles(
            products, first - begin, last - begin
        ) + at_end * np.cos(end_phase)
    gram[:, 2, 2] = gram[:, 0, 0] - gram[:, 1, 1]
    return CycleBasis(
        share, cosine, sine, end_share, *end, np.linalg.inv(gram).astype(np.float64), first, last
    )


def _mean_period(time: Floats, first: Integers, last: Integers) -> Floats:
    """Mean duration of up to 21 cycles that touch, around each cycle. [s]."""
    breaks = np.flatnonzero(last[:-1] != first[1:]) + 1
    place = np.arange(first.size)
    run = np.searchsorted(breaks, place, side="right")
    starts = np.concatenate([[0], breaks])
    stops = np.append(breaks, first.size) - 1
    low = np.maximum(place - _AROUND, starts[run])
    high = np.minimum(place + _AROUND, stops[run])
    mean: Floats = (time[last[high]] - time[first[low]]) / (high - low + 1)
    return mean


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
    sums = np.stack(
        [
            sums_over_cycles(values * weights, first, last) + values[last] * at_end
            for weights, at_end in (
                (basis.share, basis.end_share),
                (basis.cosine, basis.end_cosine),
                (basis.sine, basis.end_sine),
            )
        ],
        axis=-1,
    )
    mean, cosine, sine = np.einsum("cij,cj->ic", basis.inverse, sums)
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
