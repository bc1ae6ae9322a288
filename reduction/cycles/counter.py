"""Cycles as the machine itself counted them.

References
----------
.. [1] ASTM E1049-85(2017), "Standard Practices for Cycle Counting in Fatigue Analysis,"
   ASTM International, West Conshohocken, PA.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from reduction.errors import DataError
from reduction.record import Floats, Integers
from reduction.samples.blocks import sample_blocks, take_samples
from reduction.samples.scratch import let_go

_CYCLES_READ = 64  # before their samples are let go

Indices = NDArray[np.intp]


def changes_of_count(cycle_counter: Integers) -> Indices:
    """Samples after which the machine's count is another.

    Parameters
    ----------
    cycle_counter : ndarray of int, shape (n_samples,)
        The count. [1]

    Returns
    -------
    changes : ndarray of int, shape (n_changes,)
        Last sample of each count but the last. [1]

    Raises
    ------
    IndexError
        If the count is not a series.

    Examples
    --------
    >>> changes_of_count(np.array([0, 0, 1, 1, 2]))
    array([1, 3])
    """
    found = [np.empty(0, dtype=np.intp)]
    for part in sample_blocks(cycle_counter.size, cycle_counter, overlap=1):
        count = cycle_counter[part]
        found.append(part.start + np.flatnonzero(count[1:] != count[:-1]))
    return np.concatenate(found)


def counted_cycles(
    cycle_counter: Integers, values: Floats
) -> tuple[Indices, Indices, Indices, Indices, Integers]:
    """First and last sample, the turns, and the machine's number of every counted cycle.

    Parameters
    ----------
    cycle_counter : ndarray of int, shape (n_samples,)
        The machine's count; zero or less outside cycles. [1]
    values : ndarray, shape (n_samples,)
        Control channel; NaN where missing. [m] or [N]

    Returns
    -------
    first, last : ndarray of int, shape (n_cycles,)
        Samples with the same count, both inside. [1]
    branch_first, branch_last : ndarray of int, shape (n_cycles, 2)
        Ascending and descending branch: from the valley before the peak to the peak, and
        to the valley after it, all within the counted samples. [1]
    number : ndarray of int, shape (n_cycles,)
        The machine's number. [1]

    Raises
    ------
    IndexError
        If the series do not pair up.
    DataError
        If the count runs backward to another number than 1, where a new block may begin.

    Notes
    -----
    A machine changes its count at a phase of its own command, which the crosshead follows
    late, so that a count may begin a little before the valley; the cycle is as counted,
    and its extremes are those the machine prints, while its branches run between the
    extremes.  Missing samples are passed over.

    Examples
    --------
    >>> counter = np.array([0, 1, 1, 1, 1, 2, 2, 2])
    >>> first, last, begin, end, number = counted_cycles(
    ...     counter, np.array([9.0, 0, 1, 2, 1, 0, 3, 0]))
    >>> print(first, last, begin.tolist(), end.tolist(), number)
    [1 5] [4 7] [[1, 3], [5, 6]] [[3, 4], [6, 7]] [1 2]
    """
    change = changes_of_count(cycle_counter)
    first = np.concatenate([[0], change + 1])
    last = np.concatenate([change, [cycle_counter.size - 1]])
    counts = take_samples(cycle_counter, first)
    _check_rises(counts)
    counted = counts > 0
    first, last = first[counted], last[counted]
    branch_first = np.stack([first, first], axis=1)
    branch_last = np.stack([last, last], axis=1)
    for i, (begin, end) in enumerate(zip(first, last, strict=True)):
        level = values[begin : end + 1]
        if np.isnan(level).all():
            branch_last[i, 0] = branch_first[i, 1] = begin
            continue
        peak = begin + int(np.nanargmax(level))
        rising, falling = values[begin : peak + 1], values[peak : end + 1]
        branch_first[i, 0] = begin + rising.size - 1 - int(np.nanargmin(rising[::-1]))
        branch_last[i, 0] = branch_first[i, 1] = peak
        branch_last[i, 1] = peak + int(np.nanargmin(falling))
        if i % _CYCLES_READ == 0:
            let_go(values)
    return first, last, branch_first, branch_last, counts[counted]


def _check_rises(counts: Integers) -> None:
    """Refuse a channel that falls and rises as no count does."""
    counts = counts[counts > 0]
    backward = np.flatnonzero((counts[1:] < counts[:-1]) & (counts[1:] > 1))
    if backward.size:
        place = int(backward[0])
        raise DataError(
            f"the cycle counter runs backward {backward.size} times",
            found=f"{int(counts[place + 1])} after {int(counts[place])}",
            needed="a count that rises, or begins again with 1",
            hint="Correct the column of cycle_counter, or leave it out: reversals then count.",
        )
