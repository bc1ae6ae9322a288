"""Readings of a series: their noise, and those that are missing.

References
----------
.. [1] J. von Neumann, R. H. Kent, H. R. Bellinson and B. I. Hart, "The mean square successive
   difference," Ann. Math. Stat., vol. 12, 1941, pp. 153-162, for differences as noise.
"""

from __future__ import annotations

import numpy as np

from reduction.cycles.energy import sums_over_cycles
from reduction.record import Bools, Floats, Integers

# a cycle that lacks a larger share of its readings gives no numbers
_MISSING_SHARE = 0.1
_NOISE_SAMPLES = 65_536


def reading_noise(values: Floats) -> float:
    r"""Standard deviation of one reading, from third differences.

    .. math:: \sigma = 1.4826 \, \mathrm{median} |\Delta^3 y| / \sqrt{20}

    Parameters
    ----------
    values : ndarray, shape (n_samples,)
        A series that is smooth but for noise; at most its first 65,536 samples
        are used, so that reading in pieces changes nothing. [any]

    Returns
    -------
    noise : float
        In the unit of the series; 0 where fewer than four readings are finite. [any]

    Raises
    ------
    TypeError
        If the series is not numeric.

    Notes
    -----
    A third difference of white noise has 1 + 9 + 9 + 1 = 20 times its variance.  The
    median makes the turns of a triangular test count for nothing.

    Examples
    --------
    >>> noise = np.random.default_rng(1).normal(0, 0.25, 10_000)
    >>> print(round(reading_noise(noise + np.arange(10_000) ** 2), 2))
    0.25
    """
    third = np.diff(values[:_NOISE_SAMPLES], n=3)
    third = third[np.isfinite(third)]
    if third.size == 0:
        return 0.0
    return float(1.4826 * np.median(np.abs(third)) / np.sqrt(20))


def bridge_gaps(values: Floats, first: Integers, last: Integers) -> tuple[Floats, Bools]:
    """Series with missing readings bridged, and the cycles that lack too many of them.

    Parameters
    ----------
    values : ndarray, shape (n_samples,)
        A series; NaN where a reading is missing. [any]
    first, last : ndarray of int, shape (n_cycles,)
        First and last sample of each cycle. [1]

    Returns
    -------
    bridged : ndarray, shape (n_samples,)
        Straight lines over the gaps; zero throughout where nothing was read. [any]
    lacks_too_many : ndarray of bool, shape (n_cycles,)
        More than a tenth of the cycle's readings are missing. [1]

    Raises
    ------
    IndexError
        If a cycle lies outside the series.

    Notes
    -----
    Over a tenth of a cycle a straight line is off by up to 5 % of its amplitude at a turn.

    Examples
    --------
    >>> bridged, lacks = bridge_gaps(np.array([0.0, np.nan, 2.0]), np.array([0]), np.array([2]))
    >>> print(bridged, lacks)
    [0. 1. 2.] [ True]
    """
    missing = np.isnan(values)
    if not missing.any():
        return values, np.zeros(first.size, dtype=bool)
    present = np.flatnonzero(~missing)
    lost = sums_over_cycles(missing.astype(np.float64), first, last)
    too_many = lost > _MISSING_SHARE * (last - first)
    if present.size == 0:
        return np.zeros_like(values), np.ones(first.size, dtype=bool)
    bridged = values.copy()
    gaps = np.flatnonzero(missing)
    bridged[gaps] = np.interp(gaps, present, values[present])
    return bridged, too_many
