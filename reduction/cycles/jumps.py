"""Jumps of a channel: drop-outs that last a few samples and make a false reversal at each end.

References
----------
.. [1] ASTM E1049-85(2017), "Standard Practices for Cycle Counting in Fatigue Analysis,"
   ASTM International, West Conshohocken, PA.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from reduction.record import Floats
from reduction.samples.blocks import take_samples

_JUMP_SHARE = 0.8  # of the range of a half cycle, in one step
_LONGEST = 0.25  # of a typical half cycle
_FEWEST_STEPS = 8  # with fewer steps a half cycle, one step is a good part of it

Indices = NDArray[np.intp]


def drop_jumps(values: Floats, reversals: Indices) -> tuple[Indices, Indices]:
    """Leave out pairs of reversals that a jump of the channel makes.

    Parameters
    ----------
    values : ndarray, shape (n_samples,)
        Control channel; NaN where missing. [m] or [N]
    reversals : ndarray of int, shape (n_reversals,)
        From `reduction.cycles.reversals.find_reversals`. [1]

    Returns
    -------
    reversals : ndarray of int, shape (n_kept,)
        Without the two ends of every jump, valleys and peaks in turn. [1]
    jumps : ndarray of int, shape (n_jumps,)
        First sample of each jump that was left out. [1]

    Raises
    ------
    IndexError
        If a reversal is not a sample of the values.

    Notes
    -----
    A channel that drops out on a branch leaves it and comes back: one half cycle more
    each way, one of which is nothing but the jump.  A half cycle is a jump where a
    single step at its begin or end makes 80 % of its range, while it lasts at most a
    quarter as long as the half cycle of median length, and that has at least 8 steps.
    The samples themselves are left as they are.

    Examples
    --------
    A drop-out of two samples on the way up.

    >>> values = np.r_[np.arange(9.0), [0, 0], np.arange(9.0, 20), np.arange(20.0, 0, -1)]
    >>> drop_jumps(values, np.array([0, 8, 9, 22, 41]))
    (array([ 0, 22, 41]), array([8]))
    """
    none = np.empty(0, dtype=np.intp)
    if reversals.size < 4:
        return reversals, none
    begin, end = reversals[:-1], reversals[1:]
    steps = end - begin
    typical = float(np.median(steps))
    if typical < _FEWEST_STEPS:
        return reversals, none
    level = take_samples(values, reversals)
    size = np.abs(np.diff(level))
    at_begin = np.abs(take_samples(values, begin + 1) - level[:-1])
    at_end = np.abs(level[1:] - take_samples(values, end - 1))
    is_jump = (np.fmax(at_begin, at_end) >= _JUMP_SHARE * size) & (steps <= _LONGEST * typical)
    is_jump[[0, -1]] = False  # without a neighbour at each side it is an end, not a pair
    rows = np.flatnonzero(is_jump)
    if rows.size == 0:
        return reversals, none
    # of jumps that follow each other, there and back, every other one: each takes two reversals
    row_start = np.concatenate([[True], np.diff(rows) > 1])
    place = np.arange(rows.size)
    place -= np.maximum.accumulate(np.where(row_start, place, 0))
    rows = rows[place % 2 == 0]
    stays = np.ones(reversals.size, dtype=bool)
    stays[rows] = stays[rows + 1] = False
    return reversals[stays], reversals[rows]
