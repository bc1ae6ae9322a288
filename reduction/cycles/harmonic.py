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

import numpy as np

from reduction.cycles.energy import sums_over_cycles
from reduction.errors import DataError
from reduction.record import Floats, Integers, freeze_arrays

__all__ = ["CycleBasis", "cycle_basis", "fundamental", "mean_drift"]


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


def mean_drift(mean: Floats, first: Integers, last: Integers) -> Floats:
    r"""Steady drift of a series over each cycle, from the means of the cycles beside it.

    .. math:: d = 2 a b / (a + b) \quad \text{where } a b > 0, \text{ else } 0

    with a and b the changes of the mean from the cycle before and to the cycle after.

    Parameters
    ----------
    mean : ndarray, shape (n_cycles,)
        Mean over each cycle. [any]
    first, last : ndarray of int, shape (n_cycles,)
        First and last sample of each cycle. [1]

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
    The difference of the two end samples of a cycle would do without noise; with it, that
    difference puts 0.45 standard deviations of a reading into the sine, where the sum
    over a hundred samples puts 0.14.  Means of cycles carry a tenth of that noise.

    A drift is steady only where both changes say so.  Beside a transient (the first cycle after
    a ramp, a change of amplitude) one of them is large and says nothing of this cycle: the
    harmonic mean follows the smaller one, and is the geometric mean to 1 % where the changes
    decay by a fifth from cycle to cycle.

    Examples
    --------
    >>> first = np.array([0, 9, 18, 27])
    >>> print(mean_drift(np.array([0.0, 4.0, 6.0, 7.0]), first, first + 9).round(3))
    [2.667 2.667 1.333 1.333]
    >>> print(mean_drift(np.array([9.0, 5.0, 5.0, 5.0]), first, first + 9))
    [0. 0. 0. 0.]
    """
    drift = np.zeros(mean.size)
    if mean.size < 3:
        return drift
    change = np.where(last[:-1] == first[1:], np.diff(mean), np.nan)
    before, after = change[:-1], change[1:]
    agree = before * after > 0
    inner = np.where(np.isnan(before) | np.isnan(after), np.nan, 0.0)
    inner[agree] = 2 * before[agree] * after[agree] / (before + after)[agree]
    drift[1:-1] = inner
    drift[[0, -1]] = np.nan
    # the ends of a run have one neighbour, whose drift is the best guess of their own
    touches = np.concatenate([[False], np.isfinite(change), [False]])
    of_next = np.where(touches[1:], np.append(drift[1:], np.nan), np.nan)
    of_last = np.where(touches[:-1], np.append(np.nan, drift[:-1]), np.nan)
    drift = np.where(np.isnan(drift), np.where(np.isnan(of_next), of_last, of_next), drift)
    return np.nan_to_num(drift, nan=0.0)
