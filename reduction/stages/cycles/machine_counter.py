"""Cycles by the counter of a machine: where its count changes, skips and runs over gaps."""

from __future__ import annotations

import numpy as np

from reduction.record.errors import DataError
from reduction.record.measurement import Floats, Integers
from reduction.record.notes import Note, note
from reduction.record.samples import (
    release_pages,
    sample_blocks,
    take_samples,
)
from reduction.stages.cycles.reversals import Indices
from reduction.stages.standstills import Standstills, median_step

_CYCLES_READ = 64  # before their samples are released


def changes_of_count(cycle_counter: Integers) -> Indices:
    """Samples after which the machine's count changes.

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
    >>> first, last, begin, end, number = counted_cycles(
    ...     np.arange(9.0), np.array([9.0, 0, 1, 2, 1, 0, 3, 2, 0]), counter)
    >>> print(first, last, begin.tolist(), end.tolist(), number)
    [1 5] [5 8] [[1, 3], [5, 6]] [[3, 5], [6, 8]] [1 2]
    """
    change = changes_of_count(cycle_counter)
    step = take_samples(time, change + 1) - take_samples(time, change)
    counts = take_samples(cycle_counter, np.concatenate([[0], change + 1]))
    # where the count skips, the log has a gap too, though its time may not show it
    goes_on = (step < _GOES_ON * median_step(time)) & (np.diff(counts) <= 1)
    begin = change + 1
    length = np.diff(begin, prepend=0, append=time.size)
    reach = (np.minimum(length[:-1], length[1:]) * _LATE_COUNT).astype(np.intp)
    # a count may change some samples after the valley
    for row in np.flatnonzero(goes_on & (counts[:-1] > 0)):
        before = values[begin[row] - 2 * reach[row] : begin[row] + 1]
        if np.isfinite(before).any():
            late = before.size - 1 - int(np.nanargmin(before))
            # on a rise it is lower still beyond the reach: the count changes beside no valley
            begin[row] -= late if late <= reach[row] else 0
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


def change_at_valleys(
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


def begin_at_peaks(values: Floats, branch_first: Indices, branch_last: Indices) -> bool:
    """Whether most counted cycles lack a large part of the rise to their peak, or of the fall."""
    peak = take_samples(values, branch_last[:, 0])
    ways = np.stack([
        peak - take_samples(values, at) for at in (branch_first[:, 0], branch_last[:, 1])
    ])  # fmt: skip
    lesser, greater = np.sort(ways, axis=0)
    return float(np.nanmedian(lesser / np.fmax(greater, np.finfo(np.float64).tiny))) < _OF_RANGE


_OF_RANGE = 0.25


def skips_of_count(cycle_counter: Integers, reversals: Indices) -> Indices:
    """Samples after which the count increases by more than one, if each count lasts one cycle.

    A machine that stores some of its cycles writes them one below the other, often with a time
    that counts rows: the halves on both sides of a skip belong to two cycles.  A count that is
    logged more slowly than the cycles skips too, but each value lasts longer than a cycle.

    Examples
    --------
    >>> counter = np.array([1, 1, 1, 1, 2, 2, 2, 2, 500, 500, 500, 500])
    >>> skips_of_count(counter, np.array([0, 2, 4, 6, 8, 10]))
    array([7])
    >>> skips_of_count(counter, np.arange(12))
    array([], dtype=int64)
    """
    change = changes_of_count(cycle_counter)
    count = take_samples(cycle_counter, np.concatenate([[0], change + 1]))
    length = np.diff(change, prepend=-1, append=cycle_counter.size - 1)
    cycle = 2 * float(np.median(np.diff(reversals)))
    lasts_one = abs(float(np.median(length[count > 0])) - cycle) < _AS_LONG * cycle
    return change[(np.diff(count) > 1) & (count[:-1] > 0) & lasts_one]


_AS_LONG = 0.25  # of a cycle: tolerance on the duration of a count


def _skips(number: Integers) -> Indices:
    """Cycles after which the count goes on neither by one nor with 1, as a counter that wraps."""
    return np.flatnonzero((np.diff(number) != 1) & (number[1:] != 1))


def are_apart(number: Integers, n_reversals: int) -> bool:
    """Whether counted cycles stand alone in the log, so that reversals do not separate them.

    Examples
    --------
    >>> are_apart(np.array([1, 50, 100]), 3), are_apart(np.array([1, 2, 3, 1, 2, 3, 1]), 7)
    (True, False)
    """
    begins = np.append(0, _skips(number) + 1)
    lengths = np.diff(begins, append=number.size)
    return bool((lengths == 1).any()) or n_reversals < number.size - 2 * begins.size


def number_of_cycles(cycle_counter: Integers, first: Indices, last: Indices) -> Integers:
    """The machine's number of each cycle from valley to valley, wherever its count changes.

    The number is read half a cycle away from the change.

    Examples
    --------
    >>> counter = np.array([1, 2, 2, 2, 2, 3, 3, 3, 3])
    >>> number_of_cycles(counter, np.array([0, 4]), np.array([4, 8])).tolist()
    [2, 3]
    """
    change = changes_of_count(cycle_counter) + 1
    cycle = np.searchsorted(first, change, side="right") - 1
    inside = (cycle >= 0) & (change <= last[cycle])
    share = (change - first[cycle])[inside] / (last - first)[cycle[inside]]
    turn = np.exp(2j * np.pi * share).sum()
    away = (np.angle(turn) / (2 * np.pi) + 0.5) % 1 if inside.any() else 0.5
    return take_samples(cycle_counter, first + (away * (last - first)).astype(np.intp))


def count_over_gaps(
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
    >>> count_over_gaps(time, np.array([0, 2, 5]), np.array([2, 4, 7]), rest)
    array([ 1,  2, 26])

    Where it stores the peaks and valleys alone between them:

    >>> time = np.array([0.0, 1, 2, 3, 4, 5, 6, 7, 8, 8.5, 9, 9.5, 10])
    >>> count_over_gaps(time, np.array([0, 2, 8]), np.array([2, 4, 12]), rest)
    array([1, 2, 5])
    """
    period = float(np.median(take_samples(time, last) - take_samples(time, first)))
    between = take_samples(time, first[1:]) - take_samples(time, last[:-1])
    hidden = np.zeros(first.size, dtype=np.int64)
    for row in np.flatnonzero(between > period / 2):
        span = slice(int(last[row]), int(first[row + 1]) + 1)
        steps = np.diff(time[span])
        gap = span.start + int(np.argmax(steps))
        rests = (standstills.first <= gap + 1) & (gap <= standstills.last)
        if steps[gap - span.start] > _OFF * period and not rests.any():
            hidden[row + 1] = round(float(between[row]) / period)
    if not hidden.any():
        return None
    return np.arange(1, first.size + 1) + np.cumsum(hidden)


_OFF = 0.4  # of a period, without a reading; a logger of turns has half a period


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


def counter_notes(
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
    skips = _skips(number)
    if skips.size:
        row = int(skips[0])
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
    n_cut = 2 * (1 + skips.size)
    # and a machine that counts in mid-cycle has one count less than its log has cycles
    if not moving - n_cut <= n_reversals <= moving + 1:
        notes.append(note("counter-differs", n_counted=moving, n_reversals=n_reversals))
    return notes
