"""Whole cycles from half cycles: which ascending and descending ones belong together.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from reduction.cycles.halves import HalfCycles
from reduction.record import Bools, Floats
from reduction.samples.blocks import take_samples

# an amplitude that is halved leaves a cycle open by a quarter of its range where that happens at
# the peak, by a third at the valley
_OPEN = 0.2
_SETTLING = 0.3  # for the first of a run, in which a machine settles
_STEADY = 0.5  # share of the step of a valley by which the one beside it goes on

Indices = NDArray[np.intp]


def whole_cycles(values: Floats, halves: HalfCycles) -> tuple[Indices, Indices, Indices]:
    """Branches of the cycles, and the first samples of those that are no cycle.

    Parameters
    ----------
    values : ndarray, shape (n_samples,)
        Control channel; NaN where missing. [m] or [N]
    halves : HalfCycles
        From `reduction.cycles.halves.find_half_cycles`. [1]

    Returns
    -------
    branch_first, branch_last : ndarray of int, shape (n_cycles, 2)
        Samples of the ascending and the descending branch, both inside. [1]
    left_out : ndarray of int, shape (n_left_out,)
        First sample of each pair that lies between two amplitudes. [1]

    Raises
    ------
    IndexError
        If a half cycle is not within the values.

    Notes
    -----
    An ascending half cycle with the descending one after it, in the same run, is a cycle [1]_.
    Where the two valleys lie apart by more than 20 % of its range (30 % in the first of a run,
    since a machine settles), one branch is of one amplitude or level and the other of the
    next: such a pair is left out. It stays where the amplitude grows or decays steadily, that
    is where the valley before or after goes on in the same sense by at least half as much. Of
    each valley and its neighbours the median is taken, so that a drop-out at one opens no
    cycle.

    Examples
    --------
    Two cycles of 2, two of 1: the rise between them has a range of 1.5.

    >>> values = np.array([-1.0, 1, -1, 1, -1, 0.5, -0.5, 0.5, -0.5])
    >>> place = np.arange(8)
    >>> halves = HalfCycles(place, place + 1, place % 2 == 0, np.zeros(8, dtype=int), ())
    >>> first, last, left_out = whole_cycles(values, halves)
    >>> print(first[:, 0], last[:, 1], left_out)
    [0 2 6] [2 4 8] [4]
    """
    rising = np.flatnonzero(
        halves.rises[:-1] & ~halves.rises[1:] & (halves.run[:-1] == halves.run[1:])
    )
    both = np.stack([rising, rising + 1], axis=1)
    begin = take_samples(values, halves.first[rising])
    end = take_samples(values, halves.last[rising + 1])
    peak = take_samples(values, halves.last[rising])
    follows = (np.diff(rising) == 2) & (halves.run[rising[1:]] == halves.run[rising[:-1]])
    step = _steps(begin, end, follows)
    allowed = np.full(rising.size, _SETTLING)
    allowed[1:][follows] = _OPEN
    is_open = np.abs(step) > allowed * np.abs(peak - np.minimum(begin, end))
    goes_on = follows & (step[1:] * step[:-1] > 0)
    slower = _STEADY * np.abs(step)
    steady = np.zeros(rising.size, dtype=bool)
    steady[1:] |= goes_on & (np.abs(step[:-1]) >= slower[1:])
    steady[:-1] |= goes_on & (np.abs(step[1:]) >= slower[:-1])
    broken = is_open & ~steady
    kept = both[~broken]
    return halves.first[kept], halves.last[kept], halves.first[rising[broken]]


def _steps(begin: Floats, end: Floats, follows: Bools) -> Floats:
    """From the first to the last valley of each pair, each the median of it and its neighbours."""
    before, after = begin.copy(), end.copy()
    before[1:] = np.where(follows, begin[:-1], begin[1:])
    after[:-1] = np.where(follows, end[1:], end[:-1])
    first = np.median([before, begin, end], axis=0)
    last = np.median([begin, end, after], axis=0)
    return np.asarray(last - first)
