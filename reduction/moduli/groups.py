"""Which cycles make one curve, in what blocks they are read, and whose curves are kept.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic
   Modulus of Rubber Mooring Tethers and their Use in Coastal Moorings," Woods
   Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from reduction.cycles.product import Cycles
from reduction.errors import DataError
from reduction.record import Bools, Integers, read_only_arrays

# Large enough that threads do not wait for the interpreter between the steps of a block;
# twice as large, and the system hands out fresh memory for every step, which costs more.
_BLOCK_SAMPLES = 1 << 17
_BLOCK_CELLS = 1 << 16
_END_CYCLES = 3  # kept at the start and end of a long test, enough for a mean of each


def select_cycles(n_cycles: int, *, longest: int) -> Integers:
    """Numbers of the cycles whose own curves are kept.

    Parameters
    ----------
    n_cycles : int
        Cycles of the test. [1]
    longest : int
        Longest test of which every cycle is kept. [1]

    Returns
    -------
    selected : ndarray of int, shape (n_selected,)
        Cycle numbers, from 1: all of a short test; of a long one the first three,
        the last three, and between them about as many, spaced by equal ratio, as
        make up ``longest``. [1]

    Raises
    ------
    DataError
        If there is no cycle.

    Examples
    --------
    >>> print(select_cycles(3000, longest=12))
    [   1    2    3    7   20   55  149  405 1103 2998 2999 3000]
    """
    if n_cycles < 1:
        raise DataError("there is no cycle to select", found=f"{n_cycles}", needed="1 or more")
    if n_cycles <= longest:
        return np.arange(1, n_cycles + 1)
    ends = np.arange(1, _END_CYCLES + 1)
    spaced = np.geomspace(1, n_cycles, max(longest - 2 * _END_CYCLES + 3, 2))
    return np.unique(np.concatenate([ends, np.rint(spaced).astype(int), n_cycles + 1 - ends]))


@dataclass(frozen=True)
@read_only_arrays
class CycleGroups:
    """Consecutive cycles that give one curve; group g holds cycles first[g]..first[g+1]-1."""

    first: Integers
    of_cycle: Integers  # by cycle number, index 0 (outside cycles) is -1
    is_break_in: Bools

    @classmethod
    def of(cls, n_cycles: int, break_in_cycles: int, pooled: int) -> CycleGroups:
        """Groups of the cycles after break-in, and of the break-in cycles apart."""
        # The last group takes the remainder: a group of fewer cycles than the
        # others would be a curve of fewer samples than a window needs.
        n_after = max((n_cycles - break_in_cycles) // pooled, 1)
        after = break_in_cycles + pooled * np.arange(n_after)
        before = np.arange(0, break_in_cycles, pooled)
        first = np.concatenate([before, after])
        of_cycle = np.searchsorted(first, np.arange(n_cycles), side="right") - 1
        return cls(first, np.concatenate([[-1], of_cycle]), first < break_in_cycles)

    def blocks(self, cycles: Cycles, n_bins: int) -> Iterator[tuple[int, int, slice]]:
        """Groups [start, stop) and their samples, small enough to stay in the cache."""
        start_sample = cycles.first[self.first]
        start, n_groups = 0, self.first.size
        most_groups = max(_BLOCK_CELLS // (4 * n_bins), 1)
        while start < n_groups:
            stop = int(np.searchsorted(start_sample, start_sample[start] + _BLOCK_SAMPLES))
            stop = min(max(stop, start + 1), start + most_groups, n_groups)
            last_cycle = self.first[stop] - 1 if stop < n_groups else cycles.n_cycles - 1
            yield start, stop, slice(int(start_sample[start]), int(cycles.last[last_cycle]) + 1)
            start = stop
