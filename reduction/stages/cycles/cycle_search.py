"""Reversals of a signal, and the cycles between them.

References
----------
.. [1] ASTM E1049-85(2017), "Standard Practices for Cycle Counting in Fatigue Analysis," ASTM
   International, West Conshohocken, PA.
.. [2] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole,
   MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from math import ceil, hypot, sqrt
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from reduction.quantities.flags import BRANCH_VALUES, PHASE_VALUES
from reduction.quantities.names import BRANCH_NAMES
from reduction.record.arrays import as_positive, as_same_shape
from reduction.record.errors import DataError, SettingsError
from reduction.record.measurement import Bools, Floats, Integers
from reduction.record.notes import Note, note
from reduction.record.samples import (
    empty_like,
    finite_extremes,
    interval_labels,
    mean_of_rows,
    release_pages,
    sample_blocks,
    take_samples,
)
from reduction.record.settings import CycleSettings
from reduction.stages.cycles.cycle_pairing import find_half_cycles, whole_cycles
from reduction.stages.cycles.cycle_product import Cycles
from reduction.stages.standstills import Standstills, estimate_noise, median_step, noise_range

_BAND_SHARE = 0.1

_SLOW_PASS = 0.1

FEWEST_SAMPLES = 4
"""Per cycle, not counting the last, which belongs to the next: two turns, a sample per branch."""

ENOUGH_SAMPLES = 12
"""Per cycle: the polygon through that many encloses 4.5 % less than the loop."""

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
            turning = _turning_points(level)
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


def _first_pass(values: ArrayLike) -> tuple[NDArray[np.intp], float]:
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
    >>> reversals, band = _first_pass(stroke)
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


def _small_pass(values: Floats) -> tuple[Indices, float]:
    """Reversals of small cycles in a record dominated by large pulls, and the band.

    The band is a tenth of the range of the most numerous movements.

    Examples
    --------
    A move of 12 in and out, and ten cycles of 0.5:

    >>> wave = np.interp(np.arange(0, 24, 0.01), np.arange(24), [0, 12, *[11.5, 12] * 10, 6, 0])
    >>> _first_pass(wave)[0].size, _small_pass(wave)[0].size
    (3, 23)
    """
    band = noise_range(values)
    reversals = find_reversals(values, band=band)
    if reversals.size < 2 * _FEWEST_SMALL:
        return reversals, band
    levels = take_samples(values, reversals)
    wider = _BAND_SHARE * float(np.median(np.abs(np.diff(levels))))
    return (reversals[find_reversals(levels, band=wider)], wider) if wider > band else (
        reversals, band
    )  # fmt: skip


_FEWEST_SMALL = 5  # small cycles that are not accidental

_ALIKE = 0.3  # relative spread of stroke and of duration, for nine tenths of the cycles


def _are_alike(time: Floats, values: Floats, branch_first: Indices, branch_last: Indices) -> bool:
    """Whether whole cycles are so many and so similar that a machine made them."""
    if branch_first.shape[0] < _FEWEST_SMALL:
        return False
    stroke = np.abs(take_samples(values, branch_last) - take_samples(values, branch_first))
    period = take_samples(time, branch_last[:, 1]) - take_samples(time, branch_first[:, 0])
    for of in (stroke, period):
        low, middle, high = np.quantile(of, [0.05, 0.5, 0.95])
        if not (1 - _ALIKE) * middle <= low <= high <= (1 + _ALIKE) * middle:
            return False
    return True


_JUMP_SHARE = 0.8  # of the range of a half cycle, in one step

_LONGEST = 0.25  # of a typical half cycle

_FEWEST_STEPS = 8  # in a half cycle with fewer steps, one step is a large part of it


def _drop_jumps(values: Floats, reversals: Indices) -> tuple[Indices, Indices]:
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
    >>> _drop_jumps(values, np.array([0, 8, 9, 22, 41]))
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


_CYCLES_READ = 64  # before their samples are released


def _changes_of_count(cycle_counter: Integers) -> Indices:
    """Samples after which the machine's count changes.

    Examples
    --------
    >>> _changes_of_count(np.array([0, 0, 1, 1, 2]))
    array([1, 3])
    """
    found = [np.empty(0, dtype=np.intp)]
    for part in sample_blocks(cycle_counter.size, cycle_counter, overlap=1):
        count = cycle_counter[part]
        found.append(part.start + np.flatnonzero(count[1:] != count[:-1]))
    return np.concatenate(found)


def _counted_cycles(
    time: Floats, values: Floats, cycle_counter: Integers
) -> tuple[Indices, Indices, Indices, Indices, Integers]:
    """First and last sample, turns, and machine's number of every counted cycle.

    Notes
    -----
    A machine changes its count at a phase of its own command, which the crosshead follows with
    a delay, so a count may begin a little before the valley.  The cycle is as counted
    and has the extremes that the machine prints, while its branches run between the
    extremes.  It lasts until the first sample of the next count, unless the log has a gap between
    them or the count skips.  If the count changes after the valley, the cycle begins at the valley.
    A cycle that is cut off by an end of the log is left out.  Missing samples are skipped.

    Examples
    --------
    >>> counter = np.array([0, 1, 1, 1, 1, 2, 2, 2, 2])
    >>> first, last, begin, end, number = _counted_cycles(
    ...     np.arange(9.0), np.array([9.0, 0, 1, 2, 1, 0, 3, 2, 0]), counter)
    >>> print(first, last, begin.tolist(), end.tolist(), number)
    [1 5] [5 8] [[1, 3], [5, 6]] [[3, 5], [6, 8]] [1 2]
    """
    change = _changes_of_count(cycle_counter)
    step = take_samples(time, change + 1) - take_samples(time, change)
    counts = take_samples(cycle_counter, np.concatenate([[0], change + 1]))
    # where the count skips, the log has a gap too, though its time may not show it
    goes_on = (step < _GOES_ON * median_step(time)) & (np.diff(counts) <= 1)
    begin = change + 1
    length = np.diff(begin, prepend=0, append=time.size)
    reach = (np.minimum(length[:-1], length[1:]) * _LATE_COUNT).astype(np.intp)
    # a count may change some samples after the valley
    for row in np.flatnonzero(goes_on & (counts[:-1] > 0)):
        before = values[begin[row] - reach[row] : begin[row] + 1]
        if np.isfinite(before).any():
            begin[row] -= before.size - 1 - int(np.nanargmin(before))
    first = np.concatenate([[0], begin])
    last = np.concatenate([np.where(goes_on, begin, begin - 1), [time.size - 1]])
    _check_rises(counts)
    length = last - first
    is_cut = np.zeros(first.size, dtype=np.bool_)
    counted = counts > 0
    is_cut[1:] |= ~goes_on | ~counted[:-1]
    is_cut[:-1] |= ~goes_on | ~counted[1:]
    is_cut[[0, -1]] = True
    usual = np.median(length[counted]) if counted.any() else 0
    counted &= ~(is_cut & (length < _WHOLE_COUNT * usual))
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


_GOES_ON = 3.0  # steps of the log

_LATE_COUNT = 0.1  # of a cycle

_WHOLE_COUNT = 0.8  # of the usual length: a cycle cut off by an end of the log is shorter


_NEAR_VALLEY = 0.15
"""Fraction of a stroke above the valley at which a count may change: crosshead late by .8 rad."""


def _change_at_valleys(
    values: Floats, first: Indices, last: Indices, branch_first: Indices, branch_last: Indices
) -> bool:
    """Whether most counts that have a stroke begin where cycles begin."""
    begin, peak, end = (take_samples(values, at) for at in (first, branch_first[:, 1], last))
    valley = np.fmin(
        take_samples(values, branch_first[:, 0]), take_samples(values, branch_last[:, 1])
    )
    with np.errstate(divide="ignore", invalid="ignore"):
        above = (np.stack([begin, end]) - valley) / (peak - valley)
    above = above[:, np.isfinite(above).all(axis=0)]
    return bool(above.size) and float(np.median(above, axis=1).max()) < _NEAR_VALLEY


def _begin_at_peaks(values: Floats, branch_first: Indices, branch_last: Indices) -> bool:
    """Whether most counted cycles lack a large part of the rise to their peak, or of the fall."""
    peak = take_samples(values, branch_last[:, 0])
    ways = np.stack([
        peak - take_samples(values, at) for at in (branch_first[:, 0], branch_last[:, 1])
    ])  # fmt: skip
    lesser, greater = np.sort(ways, axis=0)
    return float(np.nanmedian(lesser / np.fmax(greater, np.finfo(np.float64).tiny))) < _OF_RANGE


_OF_RANGE = 0.25


def _skips_of_count(cycle_counter: Integers, reversals: Indices) -> Indices:
    """Samples after which the count increases by more than one, if each count lasts one cycle.

    A machine that stores some of its cycles writes them one below the other, often with a time
    that counts rows: the halves on both sides of a skip belong to two cycles.  A count that is
    logged more slowly than the cycles skips too, but each value lasts longer than a cycle.

    Examples
    --------
    >>> counter = np.array([1, 1, 1, 1, 2, 2, 2, 2, 500, 500, 500, 500])
    >>> _skips_of_count(counter, np.array([0, 2, 4, 6, 8, 10]))
    array([7])
    >>> _skips_of_count(counter, np.arange(12))
    array([], dtype=int64)
    """
    change = _changes_of_count(cycle_counter)
    count = take_samples(cycle_counter, np.concatenate([[0], change + 1]))
    length = np.diff(change, prepend=-1, append=cycle_counter.size - 1)
    cycle = 2 * float(np.median(np.diff(reversals)))
    lasts_one = abs(float(np.median(length[count > 0])) - cycle) < _AS_LONG * cycle
    return change[(np.diff(count) > 1) & (count[:-1] > 0) & lasts_one]


_AS_LONG = 0.25  # of a cycle: tolerance on the duration of a count


def _are_apart(number: Integers, n_reversals: int) -> bool:
    """Whether counted cycles stand alone in the log, so that reversals do not separate them."""
    begins = np.flatnonzero(np.diff(number, prepend=number[:1] - 2) != 1)
    lengths = np.diff(begins, append=number.size)
    return bool((lengths == 1).any()) or n_reversals < number.size - 2 * begins.size


def _number_of_cycles(cycle_counter: Integers, first: Indices, last: Indices) -> Integers:
    """The machine's number of each cycle from valley to valley, wherever its count changes.

    The number is read half a cycle away from the change.

    Examples
    --------
    >>> counter = np.array([1, 2, 2, 2, 2, 3, 3, 3, 3])
    >>> _number_of_cycles(counter, np.array([0, 4]), np.array([4, 8])).tolist()
    [2, 3]
    """
    change = _changes_of_count(cycle_counter) + 1
    cycle = np.searchsorted(first, change, side="right") - 1
    inside = (cycle >= 0) & (change <= last[cycle])
    share = (change - first[cycle])[inside] / (last - first)[cycle[inside]]
    turn = np.exp(2j * np.pi * share).sum()
    away = (np.angle(turn) / (2 * np.pi) + 0.5) % 1 if inside.any() else 0.5
    return take_samples(cycle_counter, first + (away * (last - first)).astype(np.intp))


def _count_over_gaps(
    time: Floats, first: Indices, last: Indices, standstills: Standstills
) -> Integers | None:
    """Number of each cycle, counting those that would fit into gaps of the log; None without gaps.

    A logger that stores a few cycles in a hundred leaves gaps while the machine runs.  A
    logger that is off while the machine rests leaves gaps in a standstill, where no cycle fits.

    Examples
    --------
    >>> none = np.empty(0, dtype=np.intp)
    >>> rest = Standstills(*[none] * 4, *[np.empty(0)] * 1, np.empty((1, 0)), none, 0.01, 0.0)
    >>> time = np.array([0.0, 1, 2, 3, 4, 50, 51, 52])
    >>> _count_over_gaps(time, np.array([0, 2, 5]), np.array([2, 4, 7]), rest)
    array([ 1,  2, 26])
    """
    period = float(np.median(take_samples(time, last) - take_samples(time, first)))
    between = take_samples(time, first[1:]) - take_samples(time, last[:-1])
    hidden = np.zeros(first.size, dtype=np.int64)
    for row in np.flatnonzero(between > period / 2):
        span = slice(int(last[row]), int(first[row + 1]) + 1)
        steps = np.diff(time[span])
        gap = span.start + int(np.argmax(steps))
        rests = (standstills.first <= gap + 1) & (gap <= standstills.last)
        if steps[gap - span.start] > period / 2 and not rests.any():
            hidden[row + 1] = round(float(between[row]) / period)
    if not hidden.any():
        return None
    return np.arange(1, first.size + 1) + np.cumsum(hidden)


def _cycles_before(time: Floats, values: Floats, reversals: Indices, begin: int) -> int:
    """Number of cycles before the first whole one, of its pace and half of its range or more.

    Examples
    --------
    Slack, a sine that grows, of which the cycles from 7 on are whole:

    >>> values = np.array([0.0, 0, 2, 3.6, 2.2, 3.8, 2.1, 4, 2, 4, 2, 4])[[0, *range(12)]]
    >>> time = np.array([0.0, *range(20, 32)])
    >>> print(_cycles_before(time, values, np.arange(2, 13), 9))
    3
    """
    near = int(np.searchsorted(reversals, begin))
    turns = np.concatenate([reversals[:near], [begin], reversals[near:]])
    turns = turns[np.concatenate([[True], np.diff(turns) > 0])]
    at = int(np.searchsorted(turns, begin))
    lasts = np.diff(take_samples(time, turns))
    ranges = np.abs(np.diff(take_samples(values, turns)))
    n_found = 0
    # the half cycles before it, from the last one back, beside those of its kind behind it
    for place in range(at - 1, -1, -1):
        own = slice(at + (at - place) % 2, at + 5, 2)
        if not lasts[own].size:
            break
        pace, part = (one[place] / np.median(one[own]) for one in (lasts, ranges))
        if not (abs(pace - 1) < _OFF_PACE and _LEAST_PART < part < _MOST_PART):
            break
        n_found += 1
    return n_found // 2


_OFF_PACE = 0.25  # of the time of a half cycle
_LEAST_PART, _MOST_PART = 0.5, 1.3  # of its range


def _check_rises(counts: Integers) -> None:
    """Refuse a channel that falls and rises as a cycle count cannot."""
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


_RATE_NOISE = 0.01

_WIDEST = 4  # a window is at most this part of a branch

_RATES_READ = 33

_CELLS = 1 << 18  # samples searched in one step, so that they stay in the cache

_FIRST_STEPS = 8

_FEWEST = 8

_STROKE_END = 0.05


def _rate(time: Floats, values: Floats, begin: Indices, end: Indices) -> Floats:
    """Rate between two samples; NaN where time does not advance."""
    elapsed = take_samples(time, end) - take_samples(time, begin)
    travel = take_samples(values, end) - take_samples(values, begin)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(travel / np.where(elapsed == 0, np.nan, elapsed))


def _steps_until(
    start: Indices, direction: int, reach: Indices, passes: Callable[[Indices, Indices], Bools]
) -> Indices:
    """Number of samples from each start to the first that passes, -1 if none within reach does.

    ``passes`` takes samples, shape (n_rows, n_steps), and the rows of ``start`` they belong to.
    Ends of branches are short, so all branches are searched at once, a few steps at a time.
    """
    found = np.full(start.size, -1, dtype=np.intp)
    for row in range(0, start.size, _CELLS // _FIRST_STEPS):
        rows = np.arange(row, min(row + _CELLS // _FIRST_STEPS, start.size))
        rows = rows[reach[rows] >= 0]
        begin, count = 0, _FIRST_STEPS
        while rows.size:
            steps = np.minimum(np.arange(begin, begin + count), reach[rows, None])
            hits = passes(start[rows, None] + direction * steps, rows)
            is_hit = hits.any(axis=1)
            found[rows[is_hit]] = begin + hits[is_hit].argmax(axis=1)
            begin += count
            rows = rows[~is_hit & (reach[rows] >= begin)]
            count = max(_FIRST_STEPS, min(2 * count, _CELLS // max(rows.size, 1)))
    return found


def _constant_rate_span(
    time: Floats,
    values: Floats,
    branch_first: Indices,
    branch_last: Indices,
    *,
    noise: float,
    trim_threshold: float,
) -> tuple[Indices, Indices, Floats]:
    r"""First and last sample of the trimmed part of each branch, and the plateau rate.

    Notes
    -----
    The rate is taken between two samples a window apart, both inside the branch.  The
    window has as many samples as reduce the noise of the rate to 1 % of it,
    :math:`\sqrt 2 / 0.01` times the noise of a sample and of its time stamp over the
    travel and the time of a step, at most a quarter of the branch.  The trimmed
    part runs from the beginning of the first window to the end of the last
    window whose rate is at least ``trim_threshold`` times the plateau: a window that
    begins in the turn of the machine is slow as a whole.  A missing sample gives no rate.

    Examples
    --------
    One slow sample at each end:

    >>> values = np.array([0.0, 0.2, 1.2, 2.2, 3.2, 4.2, 5.2, 5.4])
    >>> _constant_rate_span(
    ...     np.arange(8.0), values, np.array([0]), np.array([7]), noise=0.0, trim_threshold=0.97)
    (array([1]), array([6]), array([1.]))
    """
    if not 0 < trim_threshold <= 1:
        raise SettingsError(
            "cycles.trim_threshold is not a share",
            found=f"{trim_threshold:g}",
            needed="above 0 and at most 1",
        )
    plateau, sign, width = _plateau(time, values, branch_first, branch_last, noise)
    reach = branch_last - branch_first - width
    least = trim_threshold * plateau

    def passes(samples: Indices, rows: Indices, direction: int) -> Bools:
        other = samples + direction * width[rows, None]
        rate = sign[rows, None] * _rate(time, values, samples, other)
        return np.asarray(rate >= least[rows, None])

    searched = np.where(plateau > 0, reach, -1)
    head = _steps_until(branch_first, 1, searched, partial(passes, direction=1))
    tail = _steps_until(branch_last, -1, searched, partial(passes, direction=-1))
    first = branch_first + np.maximum(head, 0)
    last = np.where(head >= 0, branch_last - tail, branch_first - 1)
    return first, last, plateau


def _plateau_rates(
    time: Floats, values: Floats, branch_first: Indices, branch_last: Indices, *, noise: float
) -> Floats:
    """Plateau rate of each branch, without its ends: parameters as in `_constant_rate_span`.

    Examples
    --------
    >>> values = np.array([0.0, 0.2, 1.2, 2.2, 3.2, 4.2, 5.2, 5.4])
    >>> _plateau_rates(np.arange(8.0), values, np.array([0]), np.array([7]), noise=0.0)
    array([1.])
    """
    return _plateau(time, values, branch_first, branch_last, noise)[0]


def _plateau(
    time: Floats, values: Floats, branch_first: Indices, branch_last: Indices, noise: float
) -> tuple[Floats, Floats, Indices]:
    """Plateau rate, direction and steps of a window of each branch."""
    n_steps = branch_last - branch_first
    travel = take_samples(values, branch_last) - take_samples(values, branch_first)
    sign = np.sign(travel)
    width = _window(time, travel, n_steps, noise)
    reach = n_steps - width  # last start of a window, from the first sample

    plateau = np.full(n_steps.size, np.nan)
    n_read = min(_RATES_READ, int(reach.max(initial=0)) + 1)
    places = np.linspace(0, 1, n_read)
    rows_read = max(_CELLS // n_read, 1)
    for begin in range(0, n_steps.size, rows_read):
        part = slice(begin, begin + rows_read)
        steps = np.maximum(reach[part], 0)[:, None] * places
        at = branch_first[part, None] + steps.astype(np.intp)
        end = np.minimum(at + width[part, None], branch_last[part, None])
        plateau[part] = _median(sign[part, None] * _rate(time, values, at, end))
    return plateau, sign, width


def _window(time: Floats, travel: Floats, n_steps: Indices, noise: float) -> Indices:
    """Steps between the two samples of a rate."""
    known = np.isfinite(travel) & (n_steps > 0)
    step_travel = float(np.median(np.abs(travel[known]) / n_steps[known])) if known.any() else 0.0
    step_time = median_step(time)
    time_noise = estimate_noise(time)[0] if time.size >= _FEWEST else 0.0
    share = 0.0
    if step_travel > 0:
        share = hypot(noise / step_travel, time_noise / step_time)
    wanted = ceil(sqrt(2) * share / _RATE_NOISE - 1e-6)
    return np.clip(np.minimum(wanted, n_steps // _WIDEST), 1, None)


def _median(rates: Floats) -> Floats:
    """Median of each row without missing values; NaN where all are missing."""
    missing = np.isnan(rates)
    if not missing.any():
        ordered, middle = np.sort(rates, axis=1), rates.shape[1] // 2  # faster than np.median
        return np.asarray((ordered[:, middle] + ordered[:, ~middle]) / 2)
    median = np.full(rates.shape[0], np.nan)
    known = ~missing.all(axis=1)
    median[known] = np.nanmedian(rates[known], axis=1)
    return median


def _stroke_span(
    values: Floats, branch_first: Indices, branch_last: Indices
) -> tuple[Indices, Indices]:
    """First and last sample of the middle 90 % of the stroke of each branch.

    Notes
    -----
    For waveforms without a plateau.  Five hundredths of the stroke are left out at each
    end, where a sine has 44 % of its greatest rate.

    Examples
    --------
    >>> values = np.sin(np.linspace(-np.pi / 2, np.pi / 2, 21))
    >>> _stroke_span(values, np.array([0]), np.array([20]))
    (array([3]), array([17]))
    """
    begin, end = take_samples(values, branch_first), take_samples(values, branch_last)
    stroke = end - begin
    low, high = begin + _STROKE_END * stroke, end - _STROKE_END * stroke
    sign = np.sign(stroke)

    def passes(samples: Indices, rows: Indices) -> Bools:
        level, up = take_samples(values, samples), sign[rows, None]
        is_in = (up * (level - low[rows, None]) >= 0) & (up * (high[rows, None] - level) >= 0)
        return np.asarray(is_in)

    reach = np.where(sign == 0, -1, branch_last - branch_first)
    head = _steps_until(branch_first, 1, reach, passes)
    tail = _steps_until(branch_last, -1, reach, passes)
    first = branch_first + np.maximum(head, 0)
    return first, np.where(head >= 0, branch_last - tail, branch_first - 1)


def label_phases(
    time: Floats, *, standstills: Standstills, cycles: Cycles | None
) -> NDArray[np.int8]:
    """Return the phase of each sample, by the values of `reduction.quantities.names.PHASE_VALUES`.

    Parameters
    ----------
    time : ndarray, shape (n_samples,)
        Elapsed time of the record, aligned with the labels. [s]
    standstills : Standstills
        Rests and holds. [SI]
    cycles : Cycles or None
        Cycles, where the test has them. [SI]

    Returns
    -------
    phase : ndarray of int8, shape (n_samples,)
        Cycling during a cycle, including dwells; else rest or hold where the crosshead
        stands; else approach: every other movement, to and from the test. [1]

    Raises
    ------
    DataError
        If a standstill or the cycles reach beyond the record.

    Notes
    -----
    The order of a test in [2]_ is rest, approach and hold in turn, cycling, approach, rest.

    Examples
    --------
    >>> stand = Standstills(
    ...     np.array([0, 5]), np.array([2, 6]), np.zeros(2), np.zeros(2), np.zeros(2),
    ...     np.zeros((1, 2)), np.array([True, False]), 0.1, 1.0)
    >>> label_phases(np.arange(8.0), standstills=stand, cycles=None)
    array([0, 0, 0, 1, 1, 2, 2, 1], dtype=int8)
    """
    n_samples = time.size
    if standstills.n_standstills and int(standstills.last[-1]) >= n_samples:
        raise DataError(
            "a standstill reaches beyond the record",
            found=f"sample {int(standstills.last[-1])}",
            needed=f"less than {n_samples}",
        )
    phase = empty_like(time, dtype=np.int8)
    for part in sample_blocks(n_samples, phase):
        phase[part] = PHASE_VALUES["approach"]
    for first, last, is_rest in zip(
        standstills.first, standstills.last, standstills.is_rest, strict=True
    ):
        stand = phase[first : last + 1]
        for part in sample_blocks(stand.size, stand):
            stand[part] = PHASE_VALUES["rest" if is_rest else "hold"]
    if cycles is not None:
        if cycles.cycle_number.size != n_samples:
            raise DataError(
                "the cycles are of another record",
                found=f"{cycles.cycle_number.size} samples",
                needed=f"{n_samples}",
            )
        cycling = np.int8(PHASE_VALUES["cycling"])
        for part in sample_blocks(n_samples, phase, cycles.cycle_number):
            np.copyto(phase[part], cycling, where=cycles.cycle_number[part] > 0)
    return phase


_HINT = (
    "Check cycles.control, cycles.band and the layout, or give the test the kind it is "
    "(relaxation, creep, quasi-static)."
)


_CUT_OFF = 0.03  # of the samples, at the top of the range: a sine has 2 % of them there

_AT_TOP = 1e-3  # of the range

_AT_TURNS = 0.9  # of the readings


_BETWEEN = (
    "Loops and moduli need the readings between: take the log that was not thinned. The ranges of"
    " load and strain give K_ap alone, of which `reduction surface` takes a table of runs."
)


_NO_LOAD = 0.1  # of the greatest


def _let_back(tension: Floats, settings: CycleSettings) -> str:
    """Advice for a specimen that is longer when it returns to no load than it was before."""
    ends, most = tension[:, [0, -1]], np.nanmax(tension)
    if settings.control == "load" or not bool((ends < _NO_LOAD * most).all()):
        return ""
    return (
        "The load begins and ends near zero: of a specimen that is longer when it is let back to no"
        ' load the cycle is found with control = "load". '
    )


def _hint(time: Floats, values: Floats) -> str:
    """Advice where no cycle is found; a log may be too coarse, or cut off at a value."""
    step = median_step(time)
    if values.size > FEWEST_SAMPLES and _turning_points(values).size > _AT_TURNS * values.size:
        return (
            "Nearly every reading is a turn: the log holds the greatest and least value of each"
            f" cycle. {_BETWEEN}"
        )
    top = float(np.nanmax(values))
    share = float(np.mean(values > top - _AT_TOP * (top - float(np.nanmin(values)))))
    cut_off = (
        f"{100 * share:.0f} % of the samples stand at {top:.6g}, the greatest value: the channel is"
        " saturated there, or the machine dwells. "
    )
    return (
        f"{cut_off if share > _CUT_OFF else ''}{_HINT} The samples stand {step:.4g} s"
        f" apart: cycles shorter than {FEWEST_SAMPLES * step:.4g} s need a log with more of them."
    )


_BRANCHES = np.array([BRANCH_VALUES[name] for name in BRANCH_NAMES], dtype=np.int8)


def control_channel(position: Floats, tension: Floats, settings: CycleSettings) -> Floats:
    """Return the channel that the machine moves: position, or the mean tension of the specimens.

    Parameters
    ----------
    position : ndarray, shape (n_samples,)
        Position of the crosshead. [m]
    tension : ndarray, shape (n_specimens, n_samples)
        [N]
    settings : CycleSettings
        Which channel is controlled.

    Returns
    -------
    driven : ndarray, shape (n_samples,)
        [m] or [N]

    Raises
    ------
    ValueError
        If tension is not a table.

    Examples
    --------
    >>> settings = CycleSettings(control="load")
    >>> print(control_channel(np.zeros(2), np.array([[1.0, 2.0], [3.0, 4.0]]), settings))
    [2. 3.]
    """
    if settings.control == "position":
        return position
    return mean_of_rows(tension)


@dataclass(frozen=True)
class _Paired:
    """Reversals found with a band, without those of jumps, and the whole cycles between them."""

    reversals: Indices
    band: float
    jumps: Indices
    branch_first: Indices
    branch_last: Indices
    left_out: Indices
    notes: tuple[Note, ...] = ()
    made: tuple[str, ...] = ()
    n_ends_left_out: int = 0


def _paired(
    time: Floats,
    values: Floats,
    standstills: Standstills,
    found: tuple[Indices, float],
    *,
    is_sinusoidal: bool,
    counter: Integers | None,
) -> _Paired:
    """Whole cycles between reversals."""
    none = np.empty((0, 2), dtype=np.intp)
    if found[0].size < 3:
        return _Paired(*found, none[:, 0], none, none, none[:, 0])
    reversals, jumps = _drop_jumps(values, found[0])
    skips = none[:, 0] if counter is None else _skips_of_count(counter, reversals)
    halves = find_half_cycles(
        time, values, reversals, standstills,
        band=found[1], skips=skips, is_sinusoidal=is_sinusoidal,
    )  # fmt: skip
    return _Paired(
        reversals, found[1], jumps, *whole_cycles(values, halves),
        notes=tuple(halves.notes), made=tuple(halves.made),
        n_ends_left_out=halves.n_ends_left_out,
    )  # fmt: skip


def _paired_cycles(
    time: Floats,
    values: Floats,
    standstills: Standstills,
    settings: CycleSettings,
    *,
    counter: Integers | None,
    is_counted: bool,
) -> tuple[_Paired, list[Note]]:
    """Cycles by the stated or the estimated band; small cycles where there are no others.

    A band of a tenth of the typical travel hides cycles that are small beside the pull to them.
    """
    pair = partial(
        _paired, time, values, standstills,
        is_sinusoidal=settings.waveform == "sinusoidal", counter=counter,
    )  # fmt: skip
    if settings.band is not None:
        found = pair((find_reversals(values, band=settings.band), settings.band))
    else:
        found = pair(_first_pass(values))
    if settings.band is None and not is_counted and not found.branch_first.size:
        small = pair(_small_pass(values))
        if _are_alike(time, values, small.branch_first, small.branch_last):
            ends = take_samples(values, small.branch_last) - take_samples(
                values, small.branch_first
            )
            stroke = float(np.median(np.abs(ends)))
            of_record = _range(values)
            return small, [
                note("cycles-small", stroke=stroke, of_record=of_record, band=small.band,
                     unit="N" if settings.control == "load" else "m")
            ]  # fmt: skip
    if found.reversals.size < 3:
        load = settings.control == "load"
        channel, unit = ("tension", "N") if load else ("crosshead position", "m")
        raise DataError(
            f"no cycle: {channel} does not reverse",
            found=f"a range of {_range(values):.4g} {unit}, "
            f"{max(found.reversals.size - 1, 0)} movements of {found.band:.4g} {unit} or more",
            needed="two half cycles or more",
            hint=_hint(time, values),
        )
    return found, []


def _range(values: Floats) -> float:
    """Range of the finite samples; 0 where there is none."""
    low, high = finite_extremes(values)
    return max(high - low, 0.0)


_STEADY = 0.015  # of a range: a smaller difference changes a mean of a dozen by a thousandth

_STARTING = 0.25  # of a range: a larger difference is another level, not a machine that starts

_OTHER_LENGTH = 0.1

_MOST_STARTING = 3

_LEFT_STEADY = 5

_READ_CLOSELY = 0.5  # of the cycles: a lower fraction is a log that goes on at the turns only


def _steady_span(values: Floats, branch_first: Indices, branch_last: Indices) -> slice:
    """Cycles without those at either end in which the machine starts or stops.

    A controller takes one or a few cycles to reach its set amplitude, and the phase of those
    cycles differs from that of the others.

    Examples
    --------
    >>> wave = np.append(np.tile([0.0, 100.0], 12), 0.0)
    >>> wave[1] = 90
    >>> ends = np.stack([np.arange(0, 24, 2), np.arange(1, 24, 2)], axis=1)
    >>> _steady_span(wave, ends, ends + 1)
    slice(1, 12, None)
    """
    begin, peak, end = branch_first[:, 0], branch_last[:, 0], branch_last[:, 1]
    falls, rises = values[peak] - values[end], values[peak] - values[begin]
    n_cycles = peak.size
    if n_cycles < _LEFT_STEADY + _MOST_STARTING or not np.isfinite(falls + rises).all():
        return slice(0, n_cycles)

    def apart(of: Floats) -> Floats:
        """Relative distance of ranges from the median; zero within their scatter."""
        middle = np.median(of)
        far = np.abs(of - middle)
        return np.where(far > 6 * 1.5 * np.median(far), far / middle, 0.0)

    of_rise, of_fall = apart(rises), apart(falls)
    # one branch with the range of the others shows that the level is the same
    worse, better = np.maximum(of_rise, of_fall), np.minimum(of_rise, of_fall)
    # a machine that waits before it starts makes a cycle of different length
    length = end - begin
    is_long = np.abs(length / np.median(length) - 1) > _OTHER_LENGTH
    is_off = ((worse > _STEADY) | is_long) & (better < _STARTING)
    # a record may begin and end within a cycle: the branch there is no evidence
    reach = int(np.median(end - begin)) // 20
    if begin[0] <= reach:
        is_off[0] = _STEADY < of_fall[0] < _STARTING
    if end[-1] >= values.size - 1 - reach:
        is_off[-1] = _STEADY < of_rise[-1] < _STARTING

    def n_off(of: Bools) -> int:
        first = int(np.argmin(of))  # the first that is like the others
        return first if first <= min(_MOST_STARTING, (n_cycles - _LEFT_STEADY + 1) // 2) else 0

    return slice(n_off(is_off), n_cycles - n_off(is_off[::-1]))


_MOST_ODD = 0.1  # of the cycles, and at most this many

_FEW = 3


def _odd_cycles(time: Floats, first: Indices, last: Indices, ranges: Floats) -> Bools:
    """Cycles within a row whose duration differs from all others: the machine jumped or waited.

    A function generator that restarts continues at another phase.  A cycle at an end of the row
    may have been cut there; if both its ranges, shape (n_cycles, 2), differ from those of the two
    beside it, it is part of the way to the cycles or from them.

    Examples
    --------
    >>> turns = np.append(np.arange(0, 60, 10), np.arange(67, 130, 10))
    >>> time, ranges = np.arange(130.0), np.ones((turns.size - 1, 2))
    >>> print(np.flatnonzero(_odd_cycles(time, turns[:-1], turns[1:], ranges)))
    [5]
    """
    length = take_samples(time, last) - take_samples(time, first)
    is_odd = np.zeros(length.size, dtype=np.bool_)
    if length.size < _LEFT_STEADY + _MOST_STARTING:
        return is_odd
    middle = float(np.median(length))
    sample = length / np.maximum(last - first, 1)
    limit = np.maximum(
        _OTHER_LENGTH * middle + 2 * sample, 6 * 1.5 * np.median(abs(length - middle))
    )
    is_odd[1:-1] = (np.abs(length - middle) > limit)[1:-1]
    # two that together last as long as two others only have a misplaced turn between them
    beside = is_odd[1:] & is_odd[:-1] & (np.abs(length[1:] + length[:-1] - 2 * middle) < limit[1:])
    is_odd[1:][beside] = is_odd[:-1][beside] = False
    n_odd = np.count_nonzero(is_odd)
    is_odd &= n_odd <= min(_FEW, _MOST_ODD * length.size)
    for end, beside in ((0, [1, 2]), (-1, [-2, -3])):
        apart = np.abs(length[end] - length[beside]) > limit[end]
        is_odd[end] = apart.all() and (np.abs(ranges[end] / ranges[beside] - 1) > _STARTING).all()
    return is_odd


def _labels(first: Indices, last: Indices, values: NDArray[Any], time: Floats) -> NDArray[Any]:
    """Value of the interval of each sample, 0 outside; a shared sample belongs to the later one."""
    end = last + 1
    end[:-1] = np.minimum(end[:-1], first[1:])
    return interval_labels(time, first, end, values)


def _trimmed(
    time: Floats,
    values: Floats,
    branch_first: Indices,
    branch_last: Indices,
    settings: CycleSettings,
) -> tuple[Indices, Indices, Floats, list[Note]]:
    noise = estimate_noise(values)[0]
    if settings.waveform != "triangular":
        first, last = _stroke_span(values, branch_first, branch_last)
        # a wave that stops at its turns has a ramp only within the stroke
        ends = (first, last) if settings.waveform == "other" else (branch_first, branch_last)
        return (
            first,
            last,
            _plateau_rates(time, values, *ends, noise=noise),
            [note("no-plateau", waveform=settings.waveform)],
        )
    first, last, rate = _constant_rate_span(
        time,
        values,
        branch_first,
        branch_last,
        noise=noise,
        trim_threshold=settings.trim_threshold,
    )
    bare = int(np.sum(last < first))
    return (
        first,
        last,
        rate,
        [
            note(
                "branches-without-constant-rate",
                n_bare=bare,
                n_branches=first.size,
                time=float(time[branch_first[np.argmax(last < first)]]),
            )
        ]
        if bare
        else [],
    )


@dataclass(frozen=True)
class _Chosen:
    """Cycles of a record with their number in the machine's count, before branches are trimmed."""

    first: Indices
    last: Indices
    branch_first: Indices
    branch_last: Indices
    count: Integers | None
    counted_by: str
    is_odd: Bools
    n_unsteady: int = 0
    n_starting: int = 0  # of them before the first cycle
    notes: tuple[Note, ...] = ()
    made: tuple[str, ...] = ()


def _between_reversals(
    time: Floats,
    values: Floats,
    found: _Paired,
    settings: CycleSettings,
    counter: Integers | None,
    *,
    is_stored: bool,
) -> _Chosen:
    """Cycles between reversals, without those in which the machine starts, stops, jumps or waits.

    ``is_stored``: the log has a counter; it does not change where ``counter`` is None.
    """
    notes = list(found.notes)
    branch_first, branch_last = found.branch_first, found.branch_last
    n_starting = 0
    # a stroke of constant speed has its full amplitude from the start, a sine grows into it
    if settings.waveform == "sinusoidal":
        steady = _steady_span(values, branch_first, branch_last)
        n_last = branch_first.shape[0] - steady.stop
        if steady.start or n_last:
            code = "cycles-of-starting-machine"
            notes.append(note(code, n_first=steady.start, n_last=n_last))
        branch_first, branch_last = branch_first[steady], branch_last[steady]
        n_starting = steady.start
    n_unsteady = found.branch_first.shape[0] - branch_first.shape[0]
    first, last = branch_first[:, 0], branch_last[:, 1]
    # the only cycle of a log, stored by a machine
    is_counted = is_stored and counter is None and first.size == 1
    n_moves = found.reversals.size // 2
    has_gaps = any(one.code == "gaps-end-runs" for one in notes)
    if counter is None and has_gaps and 0 < first.size < _READ_CLOSELY * n_moves:
        ends = float(time[last[-1]])
        notes.append(note("cycles-by-turns", n_cycles=first.size, n_moves=n_moves, time=ends))
    turned = take_samples(values, branch_last) - take_samples(values, branch_first)
    is_odd = _odd_cycles(time, first, last, np.abs(turned))
    if is_odd.any():
        begins = float(time[first[is_odd][0]])
        notes.append(note("cycles-of-other-length", n_cycles=int(is_odd.sum()), time=begins))
        branch_first, branch_last = branch_first[~is_odd], branch_last[~is_odd]
        first, last = first[~is_odd], last[~is_odd]
    if found.left_out.size:
        begins = float(time[found.left_out[0]])
        notes.append(note("cycles-of-two-amplitudes", n_cycles=found.left_out.size, time=begins))
    count = None
    if counter is not None and first.size:
        count = _number_of_cycles(counter, first, last)
        has_number = count > 0
        first, last, count = first[has_number], last[has_number], count[has_number]
        branch_first, branch_last = branch_first[has_number], branch_last[has_number]
    elif counter is None and is_stored:
        notes.append(note("counter-constant"))
    return _Chosen(
        first, last, branch_first, branch_last, count,
        counted_by="machine counter" if is_counted else "reversals",
        is_odd=is_odd, n_unsteady=n_unsteady, n_starting=n_starting, notes=tuple(notes),
        made=found.made,
    )  # fmt: skip


def find_cycles(
    time: ArrayLike,
    position: ArrayLike,
    tension: ArrayLike,
    standstills: Standstills,
    *,
    settings: CycleSettings,
    cycle_counter: Integers | None = None,
) -> Cycles:
    """Find the whole cycles of a record, valley to peak to valley.

    Notes
    -----
    Reversals are found by a hysteresis band (`_first_pass` where none is stated; `_small_pass`
    where that gives no cycle and this gives five similar ones), half cycles by the rules of
    `find_half_cycles`. An ascending half cycle with the descending one after it is a
    cycle; a run that begins at a peak loses its first half cycle. A pair whose branches have
    different amplitudes is left out (`whole_cycles`). At a dwell the
    branches end where the crosshead arrives and begin where it leaves. A sample shared by two
    branches or cycles is labelled with the later cycle and with the earlier branch of a
    cycle; a peak gets the later branch where only that has its rate (`_own_begin`).
    Constant rate: `_constant_rate_span`; without a triangular waveform `_stroke_span`.

    Examples
    --------
    Slack, two cycles between 1 and 3 m, and back:

    >>> from reduction.stages.standstills import find_standstills
    >>> from reduction.record.settings import PhaseSettings
    >>> time = np.arange(0, 90, 0.5)
    >>> position = np.interp(time, [0, 20, 40, 50, 60, 70, 90], [0, 0, 3, 1, 3, 1, 0])
    >>> tension = [100 * position]
    >>> stand = find_standstills(time, position, tension, settings=PhaseSettings())
    >>> cycles = find_cycles(time, position, tension, stand, settings=CycleSettings())
    >>> print(time[cycles.first], time[cycles.last], cycles.plateau_rate[1].round(3))
    [26.5 50. ] [50. 70.] [0.2 0.2]
    """
    tension = np.atleast_2d(np.asarray(tension, dtype=np.float64))
    time, position, _ = as_same_shape(time=time, position=position, tension=tension[0])
    values = control_channel(position, tension, settings)
    counter, counted = cycle_counter, None
    if counter is not None and not _changes_of_count(counter).size:
        counter = None
    if counter is not None and _changes_of_count(counter).size > _AT_TURNS * counter.size:
        raise DataError(
            "the log has one row a cycle",
            found=f"{counter.size} rows, and {_changes_of_count(counter).size} changes of the"
            " cycle_counter",
            needed=f"{FEWEST_SAMPLES} readings a cycle or more",
            hint=f"It is a table of the values of each cycle. {_BETWEEN}",
        )
    if counter is not None:
        counted = _counted_cycles(time, values, counter)
    at_valleys = counted is not None and _change_at_valleys(values, *counted[:4])
    found, notes = _paired_cycles(
        time, values, standstills, settings, counter=counter, is_counted=at_valleys
    )
    reversals, band, jumps = found.reversals, found.band, found.jumps
    if jumps.size:
        notes.append(note("jumps-no-reversals", n_jumps=jumps.size, time=float(time[jumps[0]])))
    n_between = found.branch_first.shape[0]
    stand_alone = at_valleys
    if counter is not None and counted is not None:
        notes += _counter_notes(values, *counted[2:], n_between, band)
        skips = () if at_valleys else _skips_of_count(counter, reversals)
        if len(skips):
            # a cycle stored alone has no other half, wherever the count changes in it
            stand_alone = not _begin_at_peaks(values, *counted[2:4])
            if not stand_alone:
                notes.append(note("stored-from-peak", n_cycles=len(skips)))
    if counted is not None and stand_alone and _are_apart(counted[4], n_between):
        none_odd = np.zeros(counted[0].size, dtype=np.bool_)
        chosen = _Chosen(*counted, counted_by="machine counter", is_odd=none_odd)
    else:
        chosen = _between_reversals(
            time, values, found, settings, counter, is_stored=cycle_counter is not None
        )
    notes += chosen.notes
    first, last, count, odd = chosen.first, chosen.last, chosen.count, chosen.is_odd
    branch_first, branch_last = chosen.branch_first, chosen.branch_last
    if first.size == 0:
        raise DataError(
            "no whole cycle",
            found=f"{reversals.size - 1} movements of {band:.4g} or more, none followed by one "
            "of similar range without a standstill or a gap between",
            needed="an ascending and a descending half cycle of similar range",
            hint=_let_back(tension, settings) + _hint(time, values),
        )
    notes += _refuse_coarse(time, first, branch_first[:, 1], last)
    is_sure = count is not None and bool(np.all(np.diff(count) > 0))  # it may restart at 1
    if not is_sure:
        count = _count_over_gaps(time, first, last, standstills)
        if count is not None:
            n_hidden = int(count[-1]) - count.size
            notes.append(note("cycles-in-gaps", n_cycles=first.size, n_hidden=n_hidden))
        elif odd.any():
            count, is_sure = np.flatnonzero(~odd) + 1 - int(odd[0]), True
        # creep, and softening, began with the cycles in which the machine started
        n_before = max(chosen.n_starting, _cycles_before(time, values, reversals, int(first[0])))
        if n_before:
            if count is None:
                count, is_sure = np.arange(1, first.size + 1), True
            count = count + n_before
    if first.size == 1:
        notes.append(note("one-cycle"))
    # the way to the cycles and from them is not a cycle
    n_left = chosen.n_unsteady + np.count_nonzero(odd[1:-1])
    n_made = first.size + (n_left if chosen.counted_by == "reversals" else 0)
    if settings.expected_cycles is not None and settings.expected_cycles != n_made:
        # each end that is left out removes at most one cycle
        is_ends = 0 < settings.expected_cycles - n_made <= found.n_ends_left_out
        code = "planned-cycles-not-whole" if is_ends else "cycles-not-as-planned"
        notes.append(note(code, n_found=n_made, n_planned=settings.expected_cycles))

    start, stop, rate, trim_notes = _trimmed(
        time, values, branch_first.ravel(), branch_last.ravel(), settings
    )
    notes += trim_notes
    begin = _own_begin(branch_first, branch_last, start.reshape(-1, 2), stop.reshape(-1, 2)).ravel()
    end = branch_last.ravel().copy()
    end[:-1] = np.minimum(end[:-1], begin[1:] - 1)
    start, stop = np.maximum(start, begin), np.minimum(stop, end)
    kept = stop >= start
    return Cycles(
        first=first,
        last=last,
        branch_first=branch_first,
        branch_last=branch_last,
        plateau_rate=rate.reshape(-1, 2),
        cycle_number=_labels(first, last, np.arange(1, first.size + 1, dtype=np.int32), time),
        branch=_labels(begin, branch_last.ravel(), np.tile(_BRANCHES, first.size), time),
        is_in_trimmed_branch=_labels(
            start[kept], stop[kept], np.ones(int(kept.sum()), dtype=np.bool_), time
        ),
        band=float(band),
        counted_by=chosen.counted_by,
        count=count,
        is_count_sure=is_sure or count is None,
        notes=tuple(notes),
        made=chosen.made,
    )


def _own_begin(
    branch_first: Indices, branch_last: Indices, start: Indices, stop: Indices
) -> Indices:
    """First sample that is a branch's own, shape (n_cycles, 2); `start`, `stop`: its trimmed part.

    Branches alternate: a shared peak is the end of the ascending branch, a shared valley its
    beginning.  But a reading just after the corner of a ramp is the greatest and lies on the way
    down: a peak at the rate of the descending branch alone is the beginning of that branch.

    Examples
    --------
    Ramps that turn at 3.5, shortly before the reading of 3.4, and shortly after it.

    >>> first, last = np.array([[0, 4]]), np.array([[4, 8]])
    >>> _own_begin(first, last, np.array([[0, 4]]), np.array([[3, 8]]))
    array([[0, 4]])
    >>> _own_begin(first, last, np.array([[0, 5]]), np.array([[4, 8]]))
    array([[0, 5]])
    """
    begin = branch_first.copy()
    peak = branch_last[:, 0]
    is_behind = (start[:, 1] == peak) & (stop[:, 0] < peak)
    begin[:, 1] += (branch_first[:, 1] == peak) & ~is_behind
    return np.minimum(begin, branch_last)  # for a count that ends at its peak


def _refuse_coarse(time: Floats, first: Indices, leaves_peak: Indices, last: Indices) -> list[Note]:
    """Refuse a log with too few samples in its cycles; a note where they are few.

    Examples
    --------
    >>> time = np.arange(0.0, 30.0, 4.0)
    >>> _refuse_coarse(time, np.array([0, 3]), np.array([2, 5]), np.array([3, 6]))
    Traceback (most recent call last):
    reduction.record.errors.DataError: too few samples in a cycle; found 3 in cycle 1, which lasts
    12 s; needed 4 or more, and 12 for sound peaks and loops. Log every 1 s or faster, or take the
    log that was not thinned.
    """
    counts = last - first
    duration = take_samples(time, last) - take_samples(time, first)
    usual, period = float(np.median(counts)), float(np.median(duration))
    wanted = f"{period / ENOUGH_SAMPLES:.3g} s or faster"
    least = int(np.argmin(counts))
    if usual < FEWEST_SAMPLES or counts[least] < FEWEST_SAMPLES - 1:
        raise DataError(
            "too few samples in a cycle",
            found=f"{counts[least]} in cycle {least + 1}, which lasts {duration[least]:.4g} s",
            needed=f"{FEWEST_SAMPLES} or more, and {ENOUGH_SAMPLES} for sound peaks and loops",
            hint=f"Log every {wanted}, or take the log that was not thinned.",
        )
    if usual < ENOUGH_SAMPLES:
        return [note("few-samples-a-cycle", n_samples=usual, needed=ENOUGH_SAMPLES, step=wanted)]
    # the faster stroke, with the rest after it: a turn between its samples is in no reading
    goes_on = np.append(first[1:], last[-1])
    faster = np.minimum(leaves_peak - first, goes_on - leaves_peak)
    fewest = float(np.median(faster))
    if fewest < ENOUGH_SAMPLES / 2:
        wanted = f"{period * fewest / usual / (ENOUGH_SAMPLES / 2):.3g} s or faster"
        return [
            note("few-samples-a-stroke", n_samples=fewest, needed=ENOUGH_SAMPLES // 2, step=wanted)
        ]
    return []


def _counter_notes(
    values: Floats,
    branch_first: Indices,
    branch_last: Indices,
    number: Integers,
    n_reversals: int,
    band: float,
) -> list[Note]:
    """Differences between the machine's counter and the reversals."""
    notes = []
    travel = take_samples(values, branch_last) - take_samples(values, branch_first)
    stroke = np.abs(travel).max(axis=1)
    still = stroke < band
    if still.any():
        first_still = int(number[np.argmax(still)])
        notes.append(note("counted-without-stroke", n_cycles=int(still.sum()), first=first_still))
    if number.size and (np.diff(number) != 1).any():
        row = int(np.argmax(np.diff(number) != 1))
        notes.append(
            note(
                "counter-skips",
                n_cycles=number.size,
                first=int(number[0]),
                last=int(number[-1]),
                after=int(number[row + 1]),
                before=int(number[row]),
            )
        )
    moving = int((~still).sum())
    # a count is cut off at each end of the log or of a part of it
    n_cut = 2 * (1 + int((np.diff(number) != 1).sum()))
    if not moving - n_cut <= n_reversals <= moving:
        notes.append(note("counter-differs", n_counted=moving, n_reversals=n_reversals))
    return notes
