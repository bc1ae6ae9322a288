"""Blocks of samples, and the runs of blocks in which the crosshead stands still.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

import numpy as np

from reduction.record import Bools, Floats, Integers
from reduction.samples.blocks import BLOCK, sample_blocks
from reduction.samples.intervals import over_intervals
from reduction.samples.scratch import empty_like

_AWAY = 4.0  # tolerances


def block_extremes(position: Floats, length: int) -> tuple[Floats, Floats]:
    """Return the least and greatest position of each block of samples.

    Parameters
    ----------
    position : ndarray, shape (n_samples,)
        Crosshead position; NaN where missing. [m]
    length : int
        Samples of a block; the last one has what is left. [1]

    Returns
    -------
    least : ndarray, shape (n_blocks,)
        +inf where all samples are missing. [m]
    greatest : ndarray, shape (n_blocks,)
        -inf where all samples are missing. [m]

    Raises
    ------
    ZeroDivisionError
        If the length is zero.

    Notes
    -----
    Blocks are counted from the first sample of the record, so that a record read in
    pieces of whole blocks gives the same.

    Examples
    --------
    >>> block_extremes(np.array([1.0, 2, 3, 5, np.nan]), 2)
    (array([ 1., 3., inf]), array([ 2., 5., -inf]))
    """
    n_blocks = -(-position.size // length)
    least = empty_like(position, shape=n_blocks)
    greatest = empty_like(position, shape=n_blocks)
    step = length * max(BLOCK // length, 1)
    for part in sample_blocks(position.size, position, least, greatest, size=step):
        samples = position[part]
        start, whole = part.start // length, samples.size // length
        rows = samples[: whole * length].reshape(-1, length)
        low, high = least[start : start + whole + 1], greatest[start : start + whole + 1]
        np.min(rows, axis=1, out=low[:whole])
        np.max(rows, axis=1, out=high[:whole])
        if samples.size > whole * length:  # the last block has what is left
            low[whole], high[whole] = (
                samples[whole * length :].min(),
                samples[whole * length :].max(),
            )
        for block in np.flatnonzero(np.isnan(low)):
            finite = samples[block * length : (block + 1) * length]
            finite = finite[np.isfinite(finite)]
            low[block] = finite.min(initial=np.inf)
            high[block] = finite.max(initial=-np.inf)
    return least, greatest


def _still_runs(
    least: Floats, greatest: Floats, window: int, tolerance: float
) -> tuple[Integers, Integers]:
    """First and last block of each run in which every window of blocks stays in tolerance."""
    n_windows = least.size - window + 1
    is_still = np.zeros(n_windows + 2, dtype=bool)
    for part in sample_blocks(n_windows, least, greatest):
        low, high = (one[part.start : part.stop + window - 1] for one in (least, greatest))
        covered = 1
        while covered < window:  # windows of twice the width from two of the width before
            step = min(covered, window - covered)
            low = np.minimum(low[: low.size - step], low[step:])
            high = np.maximum(high[: high.size - step], high[step:])
            covered += step
        is_still[1 + part.start : 1 + part.stop] = high - low <= tolerance
    edges = np.flatnonzero(is_still[1:] != is_still[:-1])
    first, last = edges[::2], edges[1::2] - 1 + window - 1
    last[:-1] = np.minimum(last[:-1], first[1:] - 1)
    return first, last


def _extremes_between(
    least: Floats, greatest: Floats, first: Integers, last: Integers
) -> tuple[Floats, Floats]:
    """Least and greatest position of each run of blocks, both ends inside."""
    low = over_intervals(np.minimum, least, first, last + 1)
    high = over_intervals(np.maximum, greatest, first, last + 1)
    return low, high


def _range(least: Floats, greatest: Floats) -> float:
    every = np.array([0]), np.array([least.size])
    low, high = (
        over_intervals(np.minimum, least, *every),
        over_intervals(np.maximum, greatest, *every),
    )
    return float(high[0] - low[0])


def _outlasts_its_approach(
    least: Floats, greatest: Floats, first: Integers, last: Integers, tolerance: float
) -> Bools:
    """Whether the crosshead comes or goes faster than it stays."""
    if first.size == 0 or _range(least, greatest) <= 2 * _AWAY * tolerance:
        return np.ones(first.size, dtype=bool)  # there is nowhere to go
    length = last - first + 1
    low, high = _extremes_between(least, greatest, first, last)
    middle = (low + high) / 2
    low, high = _extremes_between(
        least,
        greatest,
        np.maximum(first - length, 0),
        np.minimum(last + length, least.size - 1),
    )
    return np.asarray(np.maximum(high - middle, middle - low) > _AWAY * tolerance)


def still_blocks(
    least: Floats, greatest: Floats, *, window: int, tolerance: float
) -> tuple[Integers, Integers]:
    """First and last block of each standstill.

    Parameters
    ----------
    least : ndarray, shape (n_blocks,)
        Least position of each block. [m]
    greatest : ndarray, shape (n_blocks,)
        Greatest position of each block. [m]
    window : int
        Blocks that the shortest standstill holds. [1]
    tolerance : float
        Range of position that any so many blocks in a row keep. [m]

    Returns
    -------
    first : ndarray of int, shape (n_standstills,)
        First block, up to one window before the true edge. [1]
    last : ndarray of int, shape (n_standstills,)
        Last block, inside. [1]

    Raises
    ------
    ValueError
        If there is no block.

    Notes
    -----
    A run of windows within the tolerance is a standstill where it keeps within twice the
    tolerance as a whole: at each end a window may hold the begin of a move.  A run that
    goes further is a slow movement, with or without holds in it, and is looked through
    again with windows of twice the width, and so on.

    The turn of a slow cycle keeps within the tolerance for a while, too, but takes as
    long again to get away from there: a standstill is kept where the position is four
    tolerances away within as many blocks as it lasted, before it or after it, or where
    the record never goes that far.

    Examples
    --------
    Rising, standing for four blocks, rising.

    >>> least = np.array([0.0, 1, 2, 2, 2, 2, 3, 4, 5])
    >>> still_blocks(least, least + 0.1, window=3, tolerance=0.5)
    (array([2]), array([5]))
    """
    found = []
    work = [(0, least.size, window)]
    while work:
        begin, end, width = work.pop()
        if end - begin < width:
            continue
        firsts, lasts = _still_runs(least[begin:end], greatest[begin:end], width, tolerance)
        if firsts.size == 0:
            continue
        firsts, lasts = begin + firsts, begin + lasts
        low, high = _extremes_between(least, greatest, firsts, lasts)
        # a window at each end may hold the begin of a move, one up and one down
        within = high - low <= 2 * tolerance
        # blocks without a sample keep within anything, and say nothing
        found.append(np.column_stack([firsts, lasts])[within & (low <= high)])
        work += [
            (int(first), int(last) + 1, 2 * width)
            for first, last in zip(firsts[~within], lasts[~within], strict=True)
        ]
    both = np.concatenate([np.empty((0, 2), dtype=np.intp), *found])
    first, last = both[np.argsort(both[:, 0])].T.copy()
    stays = _outlasts_its_approach(least, greatest, first, last, tolerance)
    return first[stays], last[stays]
