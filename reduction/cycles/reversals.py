"""Reversals of a signal by a hysteresis band, without a loop over samples.

References
----------
.. [1] ASTM E1049-85(2017), "Standard Practices for Cycle Counting in Fatigue Analysis,"
   ASTM International, West Conshohocken, PA.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from reduction.checks import as_positive
from reduction.errors import DataError
from reduction.phases.noise import noise_range
from reduction.record import Floats
from reduction.samples.blocks import sample_blocks, take_samples

_BAND_SHARE = 0.1
_SLOW_PASS = 0.1
_GROUP = 4

Indices = NDArray[np.intp]


def _turning_points(values: Floats) -> Indices:
    """First sample of every local extreme of finite values, the two ends among them."""
    moves = np.flatnonzero(values[1:] != values[:-1])
    rises = values[moves + 1] > values[moves]
    turns = moves[np.flatnonzero(rises[1:] != rises[:-1])] + 1
    return np.concatenate([[0], turns, moves[-1:] + 1])


def _turns_of_record(values: Floats, band: float) -> Indices:
    """Turning points of a record, without those that the band drops within a block.

    The last two of a block go on to the next: from there to the end the level may still go
    on, and only then is the end a turn.  A swing that is not over can but grow, so that
    what is dropped beside it would be dropped later.
    """
    found = []
    carried = np.empty(0, dtype=np.intp)
    for part in sample_blocks(values.size, values):
        block = values[part]
        finite = np.flatnonzero(np.isfinite(block))
        points = np.concatenate([carried, part.start + finite])
        if not points.size:
            continue
        level = np.concatenate([take_samples(values, carried), block[finite]])
        turning = _turning_points(level)
        points, level = points[turning], level[turning]
        stays = _without_small_pairs(level, band)
        while not stays.all():
            points, level = points[stays], level[stays]
            stays = _without_small_pairs(level, band)
        found.append(points[:-2])
        carried = points[-2:]
    return np.concatenate([*found, carried])


def _without_small_pairs(level: Floats, band: float) -> NDArray[np.bool_]:
    """Turning points that stay after pairs with the smallest swings are dropped, ends never."""
    swing = np.abs(np.diff(level))
    stays = np.ones(level.size, dtype=bool)
    pair = 1 + np.flatnonzero(
        (swing[1:-1] < band) & (swing[1:-1] <= swing[:-2]) & (swing[1:-1] < swing[2:])
    )
    stays[pair] = stays[pair + 1] = False
    return stays


def _drop_pairs(level: Floats, band: float) -> NDArray[np.bool_]:
    """Turning points that stay after the smallest swings of one pass are dropped."""
    stays = _without_small_pairs(level, band)
    swing = np.abs(np.diff(level))
    # An end that moved less than the band before a larger swing is no extreme.
    if swing[0] < band and (swing.size == 1 or swing[0] < swing[1]):
        stays[0] = False
    if swing[-1] < band and (swing.size == 1 or swing[-1] <= swing[-2]):
        stays[-1] = False
    return stays


def _merge_groups(level: Floats, band: float) -> NDArray[np.bool_]:
    """Turning points that stay when groups narrower than the band keep only their extremes."""
    whole = level.size // _GROUP * _GROUP
    group = level[:whole].reshape(-1, _GROUP)
    is_narrow = np.ptp(group, axis=1) < band
    stays = np.ones(level.size, dtype=bool)
    kept = stays[:whole].reshape(-1, _GROUP)
    kept[is_narrow] = False
    rows = np.flatnonzero(is_narrow)
    kept[rows, group[rows].argmin(axis=1)] = True
    kept[rows, group[rows].argmax(axis=1)] = True
    return stays


def find_reversals(values: ArrayLike, *, band: float) -> NDArray[np.intp]:
    r"""Reversals between which a signal moves by at least a band.

    Parameters
    ----------
    values : array_like, shape (n_samples,)
        Any signal; NaN is left out. [any unit]
    band : float
        Smallest range that makes a reversal. [unit of the values]

    Returns
    -------
    reversals : ndarray of int, shape (n_reversals,)
        Samples of the extremes, valleys and peaks in turn; empty where the signal never
        moves by the band. Between two of them is a half cycle. [1]

    Raises
    ------
    DataError
        If the band is not positive or the values are not a series.

    Notes
    -----
    The extremes that a hysteresis of width ``band`` confirms, together with the extreme
    before the first and after the last movement of that size.  They do not cross a
    mid-level, so drift and changes of level do not matter.

    All turning points are found, block by block; then pairs of neighbours are dropped, many
    at once, whose swing is below the band and no larger than the swings at both sides.  This is
    the removal of small ranges of [1]_ in the order of size: what is left does not
    depend on the order within a pass, and dropping with a smaller band first changes
    nothing.  Where swings grow steadily a pass drops few; then groups of four that are
    narrower than the band keep their extremes only, which loses no reversal since two
    of them are never that close.  Each pass drops a share of the points: O(n).

    A level that is reached several times counts where it is reached first, or next to
    the larger swing.

    Examples
    --------
    >>> find_reversals([0, 3, 2.9, 5, 4.8, 5.1, 0, 0.2, 0.1], band=1.0)
    array([0, 5, 6])
    """
    as_positive("band", band)
    values = np.asarray(values, dtype=np.float64)
    if values.ndim != 1:
        raise DataError("values are not a series", found=f"shape {values.shape}", needed="1-D")
    points = _turns_of_record(values, band)
    level = take_samples(values, points)
    while level.size > 1:
        before = level.size
        stays = _drop_pairs(level, band)
        if stays.all():
            break
        points, level = points[stays], level[stays]
        if level.size > (1 - _SLOW_PASS) * before and level.size > _GROUP:
            stays = _merge_groups(level, band)
            points, level = points[stays], level[stays]
            turning = _turning_points(level)
            points, level = points[turning], level[turning]
    if level.size < 2:
        return np.empty(0, dtype=np.intp)
    return points


def typical_range(values: ArrayLike) -> float:
    """Range of a half cycle of typical size: half of all travel is in larger ones.

    Parameters
    ----------
    values : array_like, shape (n_reversals,)
        Levels of successive reversals. [any unit]

    Returns
    -------
    typical_range : float
        Median of the ranges, each weighted by itself. [unit of the values]

    Raises
    ------
    DataError
        If there are fewer than two levels.

    Notes
    -----
    A few long moves to and from the test level do not count against many cycles, and
    what noise leaves does not count at all.

    Examples
    --------
    A move of 12 in and out, and five cycles of 5.

    >>> typical_range([0, 12] + [7, 12] * 5 + [0])
    5.0
    """
    levels = np.asarray(values, dtype=np.float64)
    if levels.size < 2:
        raise DataError(
            "there is no half cycle", found=f"{levels.size} reversals", needed="2 or more"
        )
    ranges = np.sort(np.abs(np.diff(levels)))
    travel = np.cumsum(ranges)
    return float(ranges[np.searchsorted(travel, travel[-1] / 2)])


def first_pass(values: ArrayLike) -> tuple[NDArray[np.intp], float]:
    """Reversals of a record that states no band, and the band: above its noise, below its cycles.

    Parameters
    ----------
    values : array_like, shape (n_samples,)
        Control channel; NaN is left out. [any unit]

    Returns
    -------
    reversals : ndarray of int, shape (n_reversals,)
        As `find_reversals` with that band gives them. [1]
    band : float
        Smallest range that makes a reversal. [unit of the values]

    Raises
    ------
    DataError
        If fewer than 8 samples are finite.

    Notes
    -----
    The band is the greater of the range that noise alone may span (`noise_range`) and a
    tenth of the typical half cycle: backward slips of less than a tenth of the stroke
    make no cycles.  Slips part half cycles, so that the typical one is found again with
    each wider band until it stays.  Cycles smaller than a tenth of the typical ones need
    a stated band.

    Examples
    --------
    >>> stroke = np.tile(np.concatenate([np.arange(0, 1, 0.01), np.arange(1, 0, -0.01)]), 5)
    >>> reversals, band = first_pass(stroke)
    >>> print(reversals.size, round(band, 2))
    11 0.1
    """
    values = np.asarray(values, dtype=np.float64)
    noise = noise_range(values)
    reversals, band = find_reversals(values, band=noise), noise
    while reversals.size > 1:
        levels = take_samples(values, reversals)
        wider = _BAND_SHARE * typical_range(levels)
        if wider <= band:
            break
        # dropping with the smaller band first changes nothing
        reversals, band = reversals[find_reversals(levels, band=wider)], wider
    return reversals, band
