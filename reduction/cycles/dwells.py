"""Standstills that are parts of cycles: dwells at their peaks and valleys.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from reduction.phases.standstill import Standstills
from reduction.record import Bools, Floats
from reduction.samples.blocks import take_samples

_SAME_LEVEL = 0.3  # of the stroke
_FEWEST_DWELLS = 3
_DWELL_RATIO = 2.0

Indices = NDArray[np.intp]


def dwells_of_cycles(
    values: Floats, reversals: Indices, standstills: Standstills, *, band: float
) -> tuple[Indices, Bools]:
    """Tell dwells at the peaks or valleys of cycles from standstills that end cycling.

    Parameters
    ----------
    values : ndarray, shape (n_samples,)
        Control channel; NaN where missing. [m] or [N]
    reversals : ndarray of int, shape (n_reversals,)
        From `reduction.cycles.reversals.find_reversals`. [1]
    standstills : Standstills
        Of the record. [SI]
    band : float
        With which the reversals were found. [m] or [N]

    Returns
    -------
    at : ndarray of int, shape (n_standstills,)
        Place among the reversals at which each standstill is, -1 where at none. [1]
    is_dwell : ndarray of bool, shape (n_standstills,)
        Whether it is a dwell of cycles. [1]

    Raises
    ------
    IndexError
        If a reversal is not a sample of the values.

    Notes
    -----
    A standstill is at the nearest reversal whose level is within the band of its own.  It is
    a dwell where three or more peaks in a row, or valleys, have one at the same level (within
    30 % of the stroke), and their durations differ by at most a factor 2.

    Examples
    --------
    Three peaks held for 4 s, and a rest at slack.

    >>> from reduction.phases.standstill import find_standstills
    >>> from reduction.settings import PhaseSettings
    >>> knots = [0, 8, 10, 14, 16, 18, 22, 24, 26, 30, 33]
    >>> levels = [0, 0, 3, 3, 1, 3, 3, 1, 3, 3, 1]
    >>> time = np.arange(0, 33, 0.25)
    >>> position = np.interp(time, knots, levels)
    >>> stand = find_standstills(time, position, [100 * position], settings=PhaseSettings())
    >>> reversals = np.searchsorted(time, [8, 12, 16, 20, 24, 28, 32.75])
    >>> dwells_of_cycles(position, reversals, stand, band=0.5)
    (array([0, 1, 3, 5]), array([False,  True,  True,  True]))
    """
    at = np.full(standstills.n_standstills, -1, dtype=np.intp)
    if at.size == 0 or reversals.size == 0:
        return at, np.zeros(at.size, dtype=bool)
    centre = (standstills.first + standstills.last) // 2
    level = take_samples(values, np.clip(centre, 0, values.size - 1))
    of_reversals = take_samples(values, reversals)
    after = np.searchsorted(reversals, centre)
    near = np.clip(np.stack([after - 1, after]), 0, reversals.size - 1)
    distance = np.abs(reversals[near] - centre)
    nearest = np.where(distance[0] <= distance[1], near[0], near[1])
    is_level = np.abs(of_reversals[nearest] - level) < band
    at[is_level] = nearest[is_level]

    holds = np.zeros(reversals.size, dtype=bool)
    duration = np.zeros(reversals.size)
    holds[at[is_level]] = True
    duration[at[is_level]] = (standstills.end_time - standstills.start_time)[is_level]
    stroke = np.abs(np.diff(of_reversals))
    of_cycles = np.zeros(reversals.size, dtype=bool)
    for kind in (0, 1):  # peaks among peaks, valleys among valleys
        held, lasting = holds[kind::2], duration[kind::2]
        levels = of_reversals[kind::2]
        same = held[1:] & held[:-1]
        same &= np.maximum(lasting[1:], lasting[:-1]) <= _DWELL_RATIO * np.minimum(
            lasting[1:], lasting[:-1]
        )
        same &= np.abs(np.diff(levels)) <= _SAME_LEVEL * stroke[kind::2][: same.size]
        in_a_row = _longest_row(same)
        dwell = np.zeros(held.size, dtype=bool)
        dwell[1:] |= in_a_row >= _FEWEST_DWELLS - 1
        dwell[:-1] |= in_a_row >= _FEWEST_DWELLS - 1
        of_cycles[kind::2] = dwell
    return at, (at >= 0) & of_cycles[at]


def _longest_row(true: Bools) -> Indices:
    """Length of the row of true values that each belongs to; 0 where false."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], true, [False]]).astype(np.int8)))
    length = edges[1::2] - edges[::2]
    rows = np.zeros(true.size, dtype=np.intp)
    rows[true] = np.repeat(length, length)
    return rows
