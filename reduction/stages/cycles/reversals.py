"""Reversals of a signal by a hysteresis band.

Reversals of a signal by a hysteresis band, without a loop over samples.

Jumps of a channel: drop-outs that last a few samples and make a false reversal at each end.

Cycles as the machine itself counted them.

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
from reduction.record.measurement import Floats, Integers
from reduction.record.samples import release_pages, sample_blocks, take_samples
from reduction.stages.standstills import noise_range

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


def _typical_range(values: ArrayLike) -> float:
    """Range of a half cycle of typical size: half of all travel is in larger ones.

    Notes
    -----
    A few long moves to and from the test level do not count against many cycles, and
    what noise leaves does not count at all.

    Examples
    --------
    A move of 12 in and out, and five cycles of 5.

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


def first_pass(values: ArrayLike) -> tuple[NDArray[np.intp], float]:
    """Reversals of a record that states no band, and the band: above its noise, below its cycles.

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
        wider = _BAND_SHARE * _typical_range(levels)
        if wider <= band:
            break
        # dropping with the smaller band first changes nothing
        reversals, band = reversals[find_reversals(levels, band=wider)], wider
    return reversals, band


_JUMP_SHARE = 0.8  # of the range of a half cycle, in one step

_LONGEST = 0.25  # of a typical half cycle

_FEWEST_STEPS = 8  # with fewer steps a half cycle, one step is a good part of it


def drop_jumps(values: Floats, reversals: Indices) -> tuple[Indices, Indices]:
    """Leave out pairs of reversals that a jump of the channel makes.

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


_CYCLES_READ = 64  # before their samples are let go


def changes_of_count(cycle_counter: Integers) -> Indices:
    """Samples after which the machine's count is another.

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
            release_pages(values)
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
