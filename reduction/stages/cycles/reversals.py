"""Reversals of a signal, and the band below which a turn is none.

References
----------
.. [1] ASTM E1049-85(2017), "Standard Practices for Cycle Counting in Fatigue Analysis," ASTM
   International, West Conshohocken, PA.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from reduction.record.arrays import as_positive
from reduction.record.errors import DataError
from reduction.record.measurement import Floats
from reduction.record.samples import (
    sample_blocks,
    take_samples,
)
from reduction.stages.standstills import noise_range

_BAND_SHARE = 0.1

_SLOW_PASS = 0.1

_GROUP = 4

Indices = NDArray[np.intp]


def turning_points(values: Floats) -> Indices:
    """First sample of every local extreme of finite values, the two ends among them."""
    moves = np.flatnonzero(values[1:] != values[:-1])
    rises = values[moves + 1] > values[moves]
    turns = moves[np.flatnonzero(rises[1:] != rises[:-1])] + 1
    return np.concatenate([[0], turns, moves[-1:] + 1])


def _turns_of_record(values: Floats, band: float) -> Indices:
    """Turning points of a record, without those that the band drops within a block.

    The last two of a block are carried over to the next: the level may go on beyond the end of
    the block, and only if it does not is the end a turn.  An unfinished swing can only grow, so
    any point dropped beside it would be dropped later as well.
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
        turning = turning_points(level)
        points, level = points[turning], level[turning]
        stays = _without_small_pairs(level, band)
        while not stays.all():
            points, level = points[stays], level[stays]
            stays = _without_small_pairs(level, band)
        found.append(points[:-2])
        carried = points[-2:]
    return np.concatenate([*found, carried])


def _without_small_pairs(level: Floats, band: float) -> NDArray[np.bool_]:
    """Mark turning points left when pairs with the smallest swings are dropped; ends are kept."""
    swing = np.abs(np.diff(level))
    stays = np.ones(level.size, dtype=bool)
    pair = 1 + np.flatnonzero(
        (swing[1:-1] < band) & (swing[1:-1] <= swing[:-2]) & (swing[1:-1] < swing[2:])
    )
    stays[pair] = stays[pair + 1] = False
    return stays


def _drop_pairs(level: Floats, band: float) -> NDArray[np.bool_]:
    """Mark turning points left after one pass that drops the smallest swings."""
    stays = _without_small_pairs(level, band)
    swing = np.abs(np.diff(level))
    # An end that moved less than the band before a larger swing is not an extreme.
    if swing[0] < band and (swing.size == 1 or swing[0] < swing[1]):
        stays[0] = False
    if swing[-1] < band and (swing.size == 1 or swing[-1] <= swing[-2]):
        stays[-1] = False
    return stays


def _merge_groups(level: Floats, band: float) -> NDArray[np.bool_]:
    """Mark turning points left when groups narrower than the band keep only their extremes."""
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
    """Reversals between which a signal moves by at least a band.

    Notes
    -----
    These are the extremes confirmed by a hysteresis of width ``band``, together with the extreme
    before the first and after the last movement of that size.  They do not depend on crossing a
    mid-level, so drift and changes of level do not matter.

    All turning points are found, block by block.  Then pairs of neighbours whose swing is below
    the band and no larger than the swings on both sides are dropped, many at once.  This is
    the removal of small ranges of [1]_ in order of size: the result does not
    depend on the order within a pass, and dropping with a smaller band first changes
    nothing.  Where swings grow steadily, a pass drops few points.  Then groups of four that are
    narrower than the band keep only their extremes, which loses no reversal since two
    reversals are never that close.  Each pass drops a fraction of the points: O(n).

    A level that is reached several times counts where it is first reached, or next to
    the larger swing.

    Examples
    --------
    >>> find_reversals([0, 3, 2.9, 5, 4.8, 5.1, 0, 0.2, 0.1], band=1.0)
    array([0, 5, 6])
    """
    as_positive("band", band)
    values = np.asarray(values, dtype=np.float64)
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
            turning = turning_points(level)
            points, level = points[turning], level[turning]
    if level.size < 2:
        return np.empty(0, dtype=np.intp)
    return points


def _typical_range(values: ArrayLike) -> float:
    """Range of a half cycle of typical size: half of all travel is in larger half cycles.

    Notes
    -----
    A few long moves to and from the test level do not outweigh many cycles, and
    residual noise does not count at all.

    Examples
    --------
    A move of 12 in and out, and five cycles of 5:

    >>> _typical_range([0, 12] + [7, 12] * 5 + [0])
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


def reversals_of_typical_cycles(
    values: ArrayLike, time: Floats | None = None
) -> tuple[NDArray[np.intp], float]:
    """Reversals of a record without a stated band, and the band found: between noise and cycles.

    Notes
    -----
    The band is the greater of the range that noise alone may span (`noise_range`) and a
    tenth of the typical half cycle: backward slips of less than a tenth of the stroke
    make no cycles.  Slips split half cycles, so the typical one is found again with
    each wider band until it no longer changes.  Cycles smaller than a tenth of the typical ones
    need a stated band.

    Examples
    --------
    >>> stroke = np.tile(np.concatenate([np.arange(0, 1, 0.01), np.arange(1, 0, -0.01)]), 5)
    >>> reversals, band = reversals_of_typical_cycles(stroke)
    >>> print(reversals.size, round(band, 2))
    11 0.1
    """
    values = np.asarray(values, dtype=np.float64)
    noise = noise_range(values, time)
    reversals, band = find_reversals(values, band=noise), noise
    while reversals.size > 1:
        levels = take_samples(values, reversals)
        wider = _BAND_SHARE * _typical_range(levels)
        if wider <= band:
            break
        # dropping with the smaller band first changes nothing
        reversals, band = reversals[find_reversals(levels, band=wider)], wider
    return reversals, band


def reversals_of_small_cycles(values: Floats, time: Floats | None = None) -> tuple[Indices, float]:
    """Reversals of small cycles in a record dominated by large pulls, and the band.

    The band is a tenth of the range of the most numerous movements.

    Examples
    --------
    A move of 12 in and out, and ten cycles of 0.5:

    >>> wave = np.interp(np.arange(0, 24, 0.01), np.arange(24), [0, 12, *[11.5, 12] * 10, 6, 0])
    >>> reversals_of_typical_cycles(wave)[0].size, reversals_of_small_cycles(wave)[0].size
    (3, 23)
    """
    band = noise_range(values, time)
    reversals = find_reversals(values, band=band)
    if reversals.size < 2 * FEWEST_SMALL:
        return reversals, band
    levels = take_samples(values, reversals)
    wider = _BAND_SHARE * float(np.median(np.abs(np.diff(levels))))
    return (reversals[find_reversals(levels, band=wider)], wider) if wider > band else (
        reversals, band
    )  # fmt: skip


FEWEST_SMALL = 5  # small cycles that are not accidental

_JUMP_SHARE = 0.8  # of the range of a half cycle, in one step

_LONGEST = 0.25  # of a typical half cycle

_FEWEST_STEPS = 8  # in a half cycle with fewer steps, one step is a large part of it


def drop_jumps(values: Floats, reversals: Indices) -> tuple[Indices, Indices]:
    """Leave out pairs of reversals that a jump of the channel makes.

    Notes
    -----
    A channel that drops out on a branch leaves it and comes back: one more half cycle
    each way, one of which is only the jump.  A half cycle is a jump where a
    single step at its beginning or end makes 80 % of its range, while it lasts at most a
    quarter as long as the half cycle of median length, and that has at least 8 steps.
    The samples themselves are left unchanged. A channel that is set to zero after a short
    preload does not come back: the part before that does not belong to the first cycle.

    Examples
    --------
    A drop-out of two samples on the way up:

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
    is_jump[[0, -1]] = False  # an end has no neighbour on one side, so it is not a pair
    rows = np.flatnonzero(is_jump)
    if rows.size == 0:
        return reversals, none
    # in a run of jumps there and back, every other one: each takes two reversals
    row_start = np.concatenate([[True], np.diff(rows) > 1])
    place = np.arange(rows.size)
    place -= np.maximum.accumulate(np.where(row_start, place, 0))
    rows = rows[place % 2 == 0]
    stays = np.ones(reversals.size, dtype=bool)
    stays[rows] = stays[rows + 1] = False
    if rows[0] == 1 and steps[0] <= _LONGEST * typical:
        after = values[reversals[2] : reversals[2] + int(_LONGEST * typical) + 2]
        if not np.nanmax(np.abs(np.diff(after))) >= _JUMP_SHARE / 2 * size[1]:
            stays[[0, 2]] = False, True
    return reversals[stays], reversals[rows]
