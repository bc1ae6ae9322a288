"""Where a slow pull loads the line: from the rise out of slack to the peak.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.4.2 ("a slow uni-directional
   loading").
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_same_shape
from reduction.cycles.readings import reading_noise
from reduction.errors import DataError
from reduction.record import Integers

# a rise out of slack shows above this many standard deviations of a reading
_NOISE_FACTOR = 6.0
# and above this share of the whole rise: the foot of the curve, where the line straightens
_FOOT = 0.005
_FEWEST_SAMPLES = 8


def greatest_fall(tension: ArrayLike) -> float:
    """Largest fall of a series below what it had reached before.

    Parameters
    ----------
    tension : array_like, shape (n_samples,)
        Without NaN. [N]

    Returns
    -------
    fall : float
        Zero for a series that never falls. [N]

    Raises
    ------
    ValueError
        If the series is empty.

    Examples
    --------
    >>> greatest_fall([0.0, 3.0, 2.5, 4.0])
    0.5
    """
    series = np.asarray(tension, dtype=np.float64)
    return float((np.maximum.accumulate(series) - series).max())


def find_loading(
    tension: ArrayLike, strain: ArrayLike, *, reference_tension: float | None = None
) -> Integers:
    """Samples of the loading part of a slow pull.

    Parameters
    ----------
    tension : array_like, shape (n_samples,)
        NaN where missing. [N]
    strain : array_like, shape (n_samples,)
        NaN where missing. [1]
    reference_tension : float, optional
        Tension from which the pull counts; left out, the first rise out of the lowest
        tension before the peak. [N]

    Returns
    -------
    samples : ndarray of int, shape (n_loading,)
        Rows with both readings, from the last one at or below the start to the peak. [1]

    Raises
    ------
    DataError
        If the series differ in shape, tension never rises above the start, or fewer than
        eight readings lie between the start and the peak.

    Notes
    -----
    The last crossing of the start before the peak is taken, so that bedding-in cycles that
    return to it are left out.  The start without a reference tension is the lowest reading
    before the peak plus six standard deviations of a reading, or plus half a percent of
    the rise where that is more.  What follows the peak (unloading, failure) is left out;
    [1]_ pulls to failure.

    Examples
    --------
    >>> tension = np.concatenate([np.zeros(5), np.arange(1, 21.0), [3.0, 0.0]])
    >>> print(find_loading(tension, tension / 100)[[0, -1]])
    [ 4 24]
    """
    load, stretch = as_same_shape(tension=tension, strain=strain)
    rows = np.flatnonzero(np.isfinite(load) & np.isfinite(stretch))
    if load.ndim != 1 or rows.size < _FEWEST_SAMPLES:
        raise DataError(
            "a slow pull has too few readings of tension and strain",
            found=str(rows.size),
            needed=f"{_FEWEST_SAMPLES} or more",
        )
    load = load[rows]
    peak = int(np.argmax(load))
    lowest = float(load[: peak + 1].min())
    rise = float(load[peak]) - lowest
    start = reference_tension
    if start is None:
        start = lowest + max(_NOISE_FACTOR * reading_noise(load[: peak + 1]), _FOOT * rise)
    if not load[peak] > start:
        raise DataError(
            "tension does not rise in the slow pull",
            found=f"a peak of {load[peak]:.4g} N",
            needed=f"more than the {start:.4g} N from which it counts",
        )
    below = np.flatnonzero(load[:peak] <= start)
    first = int(below[-1]) if below.size else 0
    if peak + 1 - first < _FEWEST_SAMPLES:
        raise DataError(
            "the loading part of the slow pull has too few readings",
            found=f"{peak + 1 - first} from {load[first]:.4g} N to the peak of {load[peak]:.4g} N",
            needed=f"{_FEWEST_SAMPLES} or more",
        )
    return rows[first : peak + 1]
