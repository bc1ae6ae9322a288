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

__all__ = ["block_extremes", "still_blocks"]

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
    whole = position.size // length * length
    parts = [position[:whole].reshape(-1, length), position[None, whole:]]
    least = np.concatenate([part.min(axis=1) for part in parts if part.size])
    greatest = np.concatenate([part.max(axis=1) for part in parts if part.size])
    for block in np.flatnonzero(np.isnan(least)):
        finite = position[block * length : (block + 1) * length]
        finite = finite[np.isfinite(finite)]
        least[block] = finite.min(initial=np.inf)
        greatest[block] = finite.max(initial=-np.inf)
    return least, greatest


def _still_runs(
    least: Floats, greatest: Floats, window: int, tolerance: float
) -> tuple[Integers, Integers]:
    """First and last block of each run in which every window of blocks stays in tolerance."""
    n_windows = least.size - window + 1
    low, high, covered = least, greatest, 1
    while covered < window:  # windows of twice the width from two of the width before
        step = min(covered, window - covered)
        low = np.minimum(low[: low.size - step], low[step:])
        high = np.maximum(high[: high.size - step], high[step:])
        covered += step
    is_still = np.zeros(n_windows + 2, dtype=bool)
    is_still[1:-1] = high - low <= tolerance
    edges = np.flatnonzero(is_still[1:] != is_still[:-1])
    first, last = edges[::2], edges[1::2] - 1 + window - 1
    last[:-1] = np.minimum(last[:-1], first[1:] - 1)
    return first, last


def _extremes_between(
    least: Floats, greatest: Floats, first: Integers, last: Integers
) -> tuple[Floats, Floats]:
    """Least and greatest position of each run of blocks, both ends inside."""
    bounds = np.column_stack([first, last + 1]).ravel()
    # one more block, of no samples, so that a run may end with the record
    low = np.minimum.reduceat(np.append(least, np.inf), bounds)[::2]
    high = np.maximum.reduceat(np.append(greatest, -np.inf), bounds)[::2]
    return low, high


def _outlasts_its_approach(
    least: Floats, greatest: Floats, first: Integers, last: Integers, tolerance: float
) -> Bools:
    """Whether the crosshead comes or goes faster than it stays."""
    if first.size == 0 or greatest.max() - least.min() <= 2 * _AWAY * tolerance:
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
