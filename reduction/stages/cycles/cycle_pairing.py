"""Half cycles between reversals, and their pairing to whole cycles.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole,
   MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from math import ceil
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from reduction.record.arrays import evenly_spread, runs_of_true
from reduction.record.measurement import Bools, Floats, Integers
from reduction.record.notes import Note, note
from reduction.record.samples import BLOCK, sample_blocks, step_of_codes, take_samples
from reduction.stages.standstills import Standstills, median_step, noise_range

_SAME_LEVEL = 0.3  # of the stroke

_FEWEST_DWELLS = 3

_DWELL_RATIO = 2.0

_TURNS_READ = 25  # enough for a median, few enough to cost nothing

Indices = NDArray[np.intp]


def _dwells_of_cycles(
    time: Floats, values: Floats, reversals: Indices, standstills: Standstills, *, band: float
) -> tuple[Indices, Bools]:
    """Distinguish dwells at the peaks or valleys of cycles from standstills that end cycling.

    Notes
    -----
    A standstill belongs to the nearest reversal whose level is within the band of its own.  It is
    a dwell where three or more consecutive peaks, or valleys, have one at the same level (within
    30 % of the stroke), with durations that differ by at most a factor 2.  It is also a dwell where
    it lasts at most twice as long as those turns of its kind that are too short for a standstill.

    Examples
    --------
    Three peaks held for 4 s, and a rest at slack:

    >>> from reduction.stages.standstills import find_standstills
    >>> from reduction.record.settings import PhaseSettings
    >>> knots = [0, 8, 10, 14, 16, 18, 22, 24, 26, 30, 33]
    >>> levels = [0, 0, 3, 3, 1, 3, 3, 1, 3, 3, 1]
    >>> time = np.arange(0, 33, 0.25)
    >>> position = np.interp(time, knots, levels)
    >>> stand = find_standstills(time, position, [100 * position], settings=PhaseSettings())
    >>> reversals = np.searchsorted(time, [8, 12, 16, 20, 24, 28, 32.75])
    >>> _dwells_of_cycles(time, position, reversals, stand, band=0.5)
    (array([0, 1, 3, 5]), array([False,  True,  True,  True]))
    """
    at = np.full(standstills.n_standstills, -1, dtype=np.intp)
    if at.size == 0 or reversals.size == 0:
        return at, np.zeros(at.size, dtype=bool)
    centre = (standstills.first + standstills.last) // 2
    level = take_samples(values, np.clip(centre, 0, values.size - 1))
    of_reversals = take_samples(values, reversals)
    after = np.searchsorted(reversals, centre)
    near = np.clip(np.stack([after - 1, after]), 0, reversals.size - 1)
    distance = np.abs(reversals[near] - centre)
    nearest = np.where(distance[0] <= distance[1], near[0], near[1])
    is_level = np.abs(of_reversals[nearest] - level) < band
    at[is_level] = nearest[is_level]

    holds = np.zeros(reversals.size, dtype=bool)
    duration = np.zeros(reversals.size)
    holds[at[is_level]] = True
    duration[at[is_level]] = (standstills.end_time - standstills.start_time)[is_level]
    stroke = np.abs(np.diff(of_reversals))
    is_dwell_of_cycle = np.zeros(reversals.size, dtype=bool)
    for kind in (0, 1):  # peaks among peaks, valleys among valleys
        held, lasting = holds[kind::2], duration[kind::2]
        levels = of_reversals[kind::2]
        same = held[1:] & held[:-1]
        same &= np.maximum(lasting[1:], lasting[:-1]) <= _DWELL_RATIO * np.minimum(
            lasting[1:], lasting[:-1]
        )
        same &= np.abs(np.diff(levels)) <= _SAME_LEVEL * stroke[kind::2][: same.size]
        in_a_row = _longest_row(same)
        dwell = np.zeros(held.size, dtype=bool)
        dwell[1:] |= in_a_row >= _FEWEST_DWELLS - 1
        dwell[:-1] |= in_a_row >= _FEWEST_DWELLS - 1
        short = held & ~dwell
        if short.any():
            others = kind + 2 * np.flatnonzero(~held)
            usual = _usual_turn(time, values, reversals, others, within=_still(standstills))
            dwell |= short & (lasting <= _DWELL_RATIO * usual)
        is_dwell_of_cycle[kind::2] = dwell
    return at, (at >= 0) & is_dwell_of_cycle[at]


def _still(standstills: Standstills) -> float:
    """Tolerance of the channel that stands still: tension where this is held, else position."""
    held = standstills.tension_tolerance
    return standstills.position_tolerance if held is None else held


def _usual_turn(
    time: Floats, values: Floats, reversals: Indices, places: Indices, *, within: float
) -> float:
    """Median duration at the level of some reversals of a channel; 0 if they are too few."""
    if places.size < _FEWEST_DWELLS:
        return 0.0
    lasting = []
    for place in evenly_spread(places, _TURNS_READ).tolist():
        at = int(reversals[place])
        first = int(reversals[max(place - 1, 0)])
        last = int(reversals[min(place + 1, reversals.size - 1)])
        away = np.flatnonzero(np.abs(values[first : last + 1] - values[at]) > within) + first
        before, after = away[away < at], away[away > at]
        begin = int(before[-1]) + 1 if before.size else first
        end = int(after[0]) - 1 if after.size else last
        lasting.append(float(time[end] - time[begin]))
    return float(np.median(lasting))


def _longest_row(true: Bools) -> Indices:
    """Length of the row of true values that each value belongs to; 0 where false."""
    length = np.ptp(runs_of_true(true), axis=1)
    rows = np.zeros(true.size, dtype=np.intp)
    rows[true] = np.repeat(length, length)
    return rows


DIFFERENT = 0.3
"""Relative difference allowed between ranges of neighbouring half cycles. [1]."""

_STANDING = 0.04  # of a half cycle: movement in the first tenth of one that begins at a stand

_EDGE_SHARE = 0.1  # of a half cycle

Edge = Literal["reversal", "standstill", "record"]  # a gap counts as an end of the record


@dataclass(frozen=True)
class _Run:
    """Consecutive extremes, and whether the record or the movement ends at them."""

    nodes: Indices
    begins_at: Edge
    ends_at: Edge


def _gaps_of_record(time: Floats, values: Floats, *, longest: float) -> tuple[Indices, Indices]:
    """Samples before and after every time step longer than allowed, without missing samples.

    Examples
    --------
    >>> _gaps_of_record(np.arange(6.0), np.array([0.0, 1, np.nan, np.nan, 4, 5]), longest=2.0)
    (array([1]), array([4]))
    """
    before, after = [], []
    carried = np.empty(0, dtype=np.intp)
    for part in sample_blocks(time.size, time, values):
        rows = np.concatenate([carried, part.start + np.flatnonzero(np.isfinite(values[part]))])
        long = np.flatnonzero(np.diff(time[rows]) > longest)
        before.append(rows[long])
        after.append(rows[long + 1])
        carried = rows[-1:]
    return np.concatenate(before), np.concatenate(after)


def _runs_that_cycle(
    values: Floats,
    reversals: Indices,
    breaks: tuple[Indices, Indices],
    *,
    n_standstills: int,
    band: float,
) -> list[_Run]:
    """Runs in which two half cycles in a row have similar ranges, in order of time.

    Examples
    --------
    Two cycles, a gap, and a single movement:

    >>> values = np.array([0.0, 2, 0, 2, 0, 1, 3])
    >>> gap = np.array([4]), np.array([5])
    >>> for run in _runs_that_cycle(values, np.arange(1, 4), gap, n_standstills=0, band=0.5):
    ...     print(run.nodes, run.begins_at, run.ends_at)
    [0 1 2 3 4] record record
    """
    return [
        part
        for stretch in _stretches(values, reversals, breaks, n_standstills, band)
        for part in _parts(values, stretch)
        if _is_cycling(np.abs(np.diff(take_samples(values, part.nodes))))
    ]


def _stretches(
    values: Floats,
    reversals: Indices,
    breaks: tuple[Indices, Indices],
    n_standstills: int,
    band: float,
) -> list[_Run]:
    """Extremes of each stretch between breaks; the standstills come first among the breaks.

    The edge of a break counts as an extreme where a movement begins there.
    """
    order = np.argsort(breaks[0], kind="stable")
    start, stop = _finite_ends(values)
    begins = np.concatenate([[start], breaks[1][order]])
    ends = np.concatenate([breaks[0][order], [stop]])
    edges: list[Edge] = ["standstill" if at < n_standstills else "record" for at in order]
    edges = ["record", *edges, "record"]
    found = []
    for place, (begin, end) in enumerate(zip(begins, ends, strict=True)):
        nodes = reversals[slice(*np.searchsorted(reversals, [begin + 1, end]))]
        # the edge is an extreme of its own where the nearest one is at least a band away
        inner = nodes if nodes.size else np.array([end])
        if abs(values[begin] - values[inner[0]]) >= band:
            at = begin
            if edges[place] == "record":
                at = _farthest(values, begin, int(inner[0]))
            nodes = np.concatenate([[at], nodes])
        inner = nodes if nodes.size else np.array([begin])
        if abs(values[end] - values[inner[-1]]) >= band:
            at = end
            if edges[place + 1] == "record":
                at = _farthest(values, end, int(inner[-1]))
            nodes = np.concatenate([nodes, [at]])
        if nodes.size > 1:
            near = _EDGE_SHARE * (nodes[-1] - nodes[0]) / (nodes.size - 1)
            edge = edges[place]
            if _is_standing(values, nodes, begin, ceil(near)):
                edge = "standstill"
            last_edge = edges[place + 1] if end - nodes[-1] <= near else "reversal"
            if last_edge == "reversal" and _comes_to_stand(values, nodes, end):
                last_edge = "standstill"
            found.append(_Run(nodes, edge if nodes[0] - begin <= near else "reversal", last_edge))
    return found


def _farthest(values: Floats, edge: int, turn: int) -> int:
    """Sample between an edge of the record and a turn that is farthest from the turn.

    A log, or a part of it between gaps, may begin a little before a turn or end a little behind
    it, by less than the band of reversals.

    Examples
    --------
    >>> _farthest(np.array([0.1, 0.0, 1.0, 2.0]), 0, 3)
    1
    """
    begin, stop = min(edge, turn), max(edge, turn) + 1
    is_valley = values[edge] < values[turn]
    part = values[begin:stop]
    return begin + int(np.nanargmin(part) if is_valley else np.nanargmax(part))


def _finite_ends(values: Floats) -> tuple[int, int]:
    """First and last sample that is not missing; the ends of the record if all are missing."""
    start, stop = 0, values.size - 1
    for part in sample_blocks(values.size, values):
        there = np.flatnonzero(np.isfinite(values[part]))
        if there.size:
            start = part.start + int(there[0])
            break
    for begin in reversed(range(0, values.size, BLOCK)):
        there = np.flatnonzero(np.isfinite(values[begin : begin + BLOCK]))
        if there.size:
            stop = begin + int(there[-1])
            break
    return start, stop


def _is_standing(values: Floats, nodes: Indices, begin: int, n_steps: int) -> bool:
    """Whether the movement begins at a stand, even one too short for a standstill."""
    moved = values[min(begin + n_steps, values.size - 1)] - values[begin]
    return bool(abs(moved) < _STANDING * abs(values[nodes[1]] - values[nodes[0]]))


def _comes_to_stand(values: Floats, nodes: Indices, end: int) -> bool:
    """Whether nothing moves after the last node, as a load at slack while the specimen recovers."""
    after = values[nodes[-1] : end + 1]
    moved = np.fmax.reduce(after) - np.fmin.reduce(after)
    return bool(moved < _STANDING * abs(values[nodes[-1]] - values[nodes[-2]]))


def _parts(values: Floats, run: _Run) -> list[_Run]:
    """A stretch, split at moves from one level to another; the move ends both parts."""
    nodes = run.nodes
    ranges = np.abs(np.diff(take_samples(values, nodes)))
    moves = 1 + np.flatnonzero(ranges[1:-1] >= ranges[:-2] + ranges[2:])
    begins = np.concatenate([[0], moves])
    ends = np.concatenate([moves + 2, [nodes.size]])
    return [
        _Run(
            nodes[begin:end].copy(),
            run.begins_at if begin == 0 else "reversal",
            run.ends_at if end == nodes.size else "reversal",
        )
        for begin, end in zip(begins, ends, strict=True)
    ]


def _is_cycling(ranges: Floats) -> bool:
    """Whether two half cycles in a row have similar ranges."""
    smaller = np.minimum(ranges[1:], ranges[:-1])
    return bool((smaller >= (1 - DIFFERENT) * np.maximum(ranges[1:], ranges[:-1])).any())


_SHORT = 0.05  # of its neighbour: a half cycle at an edge may end short of the level by this

_FEWEST_ALIKE = 3  # half cycles beside one at an edge, which serve to judge it

_UNLIKE = 3.0  # times the spread of those

_PACE = 0.25  # relative difference in duration allowed for a half cycle at the end of a run

_TURNS_BESIDE = 8  # turns of the run with which an end is compared

_LINGERS = 1.5  # times as long as at the slowest of them

_FEWEST_STILL = 2  # samples longer than at the slowest of them

_STEPS_READ = 64  # looked at first, then twice as many


@dataclass(frozen=True)
class _FittedRun:
    """Extremes of a run with its ends fitted, and samples near which an end was changed.

    ``cut`` went beyond its neighbour's level, ``short`` fell short of it, ``paced`` had
    a different duration from the sine.
    """

    nodes: Indices
    cut: tuple[int, ...] = ()
    short: tuple[int, ...] = ()
    paced: tuple[int, ...] = ()


_CODES_APART = 1.5  # steps of a converter, which flickers between two codes even without noise


def _without_stands(
    values: Floats, nodes: Indices, *, first: int, last: int, tolerance: float
) -> Indices:
    """Extremes of a run, with its first and last moved to where the movement begins and ends.

    Notes
    -----
    Where a machine waits before the first stroke, for too short a time to be a standstill,
    any sample of the wait may be the extreme.  An end at which the signal stays within the
    tolerance for more than 1.5 times as long as at the turns of the run is such a wait.  It is
    moved to the median distance of those turns from the end of the stand.
    With only two extremes nothing is moved.  A hold in every cycle, and the flat turn
    of a sine, are not changed.

    Examples
    --------
    Three samples of waiting at the valley before two strokes:

    >>> values = np.array([2.0, 2, 2, 2, 4, 2, 4, 2])
    >>> _without_stands(values, np.array([0, 4, 5, 6, 7]), first=0, last=7, tolerance=0.1)
    array([3, 4, 5, 6, 7])
    """
    moved = nodes.copy()
    if nodes.size < 3:
        return moved
    for end, beyond, series in ((0, first, nodes), (-1, last, nodes[::-1])):
        own, before = (
            _steps_still(values, int(nodes[end]), int(far), tolerance)
            for far in (series[1], beyond)
        )
        turns = range(2, nodes.size - 1, 2) or range(1, 2)  # valleys among valleys, if any
        after, width = np.array(
            [
                _both_sides(values, series[at - 1 : at + 2], tolerance)
                for at in turns[:_TURNS_BESIDE]
            ]
        ).T
        slowest = max(_LINGERS * width.max(), width.max() + _FEWEST_STILL)
        if own + before > slowest and own > after.max() + 1:
            step = 1 if end == 0 else -1
            way = values[nodes[end] : nodes[end] + step * (own - int(np.median(after)) + 1) : step]
            moved[end] += step * int(np.flatnonzero(np.isfinite(way))[-1])
    return moved


def _both_sides(values: Floats, nodes: Indices, tolerance: float) -> tuple[int, int]:
    """Samples for which the signal stays at the second of three extremes: after it, and in all."""
    before, at, after = (int(node) for node in nodes)
    own = _steps_still(values, at, after, tolerance)
    return own, own + _steps_still(values, at, before, tolerance)


def _steps_still(values: Floats, turn: int, far: int, tolerance: float) -> int:
    """Samples from a turn, towards another, to the last one before the signal moves away.

    A single sample beyond the tolerance, followed by one within it, is noise, not a movement.

    Examples
    --------
    >>> print(_steps_still(np.array([0.0, 1, 2, 1, 1, 5, 9]), 0, 6, 1.5))
    4
    """
    step, reach = (1 if far > turn else -1), abs(far - turn)
    begin, count, last = 0, _STEPS_READ, 0
    while begin <= reach:
        stop = min(begin + count, reach + 1)
        # one more than the samples searched, to see whether the last of them comes back
        level = values[turn + step * np.arange(begin, min(stop, reach) + 1)]
        away = np.abs(level - values[turn]) > tolerance  # a missing sample is not a movement
        away[:-1] &= away[1:] | np.isnan(level[1:])
        away, level = away[: stop - begin], level[: stop - begin]
        seen = np.flatnonzero(np.isfinite(level[: int(np.argmax(away)) if away.any() else None]))
        last = begin + int(seen[-1]) if seen.size else last
        if away.any():
            break
        begin, count = stop, 2 * count
    return last


def _fit_ends(
    time: Floats,
    values: Floats,
    run: _Run,
    *,
    is_sinusoidal: bool,
    still: float,
    tolerance: float,
) -> _FittedRun:
    """Fit the ends of a run that cycles.

    Notes
    -----
    The rules are those of `reduction.stages.cycles.cycle_pairing.find_half_cycles`; the beginning
    and end of the movement are found by `_without_stands`.

    Examples
    --------
    From slack at 0; the first half cycle is cut where it passes the valley:

    >>> values = np.array([0.0, 1, 2, 3, 2, 3, 2])
    >>> _fit_ends(np.arange(7.0), values, _Run(np.array([0, 3, 4, 5, 6]), "record", "record"),
    ...     is_sinusoidal=False, still=0.1, tolerance=0.1)
    _FittedRun(nodes=array([2, 3, 4, 5, 6]), cut=(3,), short=(), paced=())
    """
    moving = partial(
        _without_stands,
        values,
        first=int(run.nodes[0]),
        last=int(run.nodes[-1]),
        tolerance=tolerance,
    )
    nodes = moving(run.nodes)
    ranges = np.abs(np.diff(take_samples(values, nodes)))
    cut: list[int] = []
    short: list[int] = []
    paced: list[int] = []
    left_out = [0, 0]
    for side, (end, turn, beside, edge) in enumerate(
        ((0, 1, 2, run.begins_at), (-1, -2, -3, run.ends_at))
    ):
        at_edge = edge != "reversal"
        own, neighbour = ranges[end], ranges[-2 if end else 1]
        ran_on = own > (1 + DIFFERENT) * neighbour or (
            own - neighbour > _beyond(ranges[::-1] if end else ranges, still)
        )
        # a machine that begins or ends a sine at its mean moves half a range, then away
        is_fragment = ranges.size > 4 and neighbour < (1 - DIFFERENT) * ranges[beside]
        if is_fragment and (ran_on or at_edge):
            left_out[side] = 2
            short.append(int(nodes[turn]))
            continue
        far, alike = int(nodes[end]), 2 * beside - turn
        if (
            not is_sinusoidal
            and nodes.size > _FEWEST_ALIKE + 1
            and (ran_on or (at_edge and own > _NEARLY_WHOLE * neighbour))
            and _waits(time, values, nodes[[turn, beside, alike]], far, is_whole=not ran_on)
        ):
            nodes[end] = nodes[turn]
        elif ran_on and is_sinusoidal:
            nodes[end] = _end_of_sine(values, nodes[[turn, beside]], far, tolerance)
        elif ran_on:
            nodes[end] = _passing(values, nodes[turn], far, values[nodes[beside]])
        if ran_on:
            ranges[end] = neighbour
        if nodes[end] == nodes[turn] or (
            is_sinusoidal and not _keeps_pace(time, nodes, end, turn, beside, at_edge)
        ):
            left_out[side] = 1
            paced.append(int(nodes[turn]))
        elif ran_on:
            cut.append(int(nodes[turn]))
        # a short one between true reversals is whole: an amplitude that grows or decays
        elif at_edge and neighbour - own > _allowed(
            neighbour, abs(int(nodes[turn] - nodes[beside])), edge, begins=side == 0, still=still
        ):
            left_out[side] = 1
            short.append(int(nodes[end]))
    nodes = nodes[left_out[0] : nodes.size - left_out[1]]
    # cycles run from valley to valley: a half cycle before the first valley is not part of one
    valley = slice(*_valleys(values, nodes))
    nodes[valley] = moving(nodes[valley])
    return _FittedRun(nodes, tuple(cut), tuple(short), tuple(paced))


def _beyond(ranges: Floats, still: float) -> float:
    """Allowed excess of the first movement over its neighbour, from the spread of the next ones.

    Examples
    --------
    >>> print(_beyond(np.array([2.4, 2.0, 2.01, 2.0, 2.0]), still=0.001))
    0.1
    """
    if ranges.size <= _FEWEST_ALIKE:
        return np.inf
    beside = ranges[1 : 1 + _FEWEST_ALIKE]
    return max(_SHORT * float(beside[0]), still, _UNLIKE * float(np.ptp(beside)))


def _valleys(values: Floats, nodes: Indices) -> tuple[int, int]:
    """Place of the first valley of a run, and the place after its last."""
    if nodes.size < 2:
        return 0, nodes.size
    falls = np.diff(values[nodes[[0, 1, -2, -1]]]) < 0
    return int(falls[0]), nodes.size - int(not falls[-1])


def _passing(values: Floats, turn: int, end: int, level: float) -> int:
    """Sample, between a turn and a far end, nearest to where the signal passes a level."""
    step = 1 if end > turn else -1
    way = values[turn : end + step if end + step >= 0 else None : step]
    beyond = way <= level if values[turn] > level else way >= level
    at = int(np.argmax(beyond))
    if at and abs(way[at - 1] - level) < abs(way[at] - level):
        at -= 1
    return turn + step * at


def _end_of_sine(values: Floats, nodes: Indices, far: int, tolerance: float) -> int:
    """Sample where a half cycle that goes too far from a turn ends, by the one beside it.

    The turn itself where the two are not mirror images beyond the middle of the stroke.

    Examples
    --------
    Two cycles, a wait of one sample at the valley, and a move to slack:

    >>> values = np.concatenate([-np.cos(np.pi * np.arange(33) / 8), [-1], np.arange(-1, -6, -0.5)])
    >>> _end_of_sine(values, np.array([24, 16]), 42, 0.0)
    32
    >>> values[29:32] = values[28]  # it waits half way
    >>> _end_of_sine(values, np.array([24, 16]), 42, 0.0)
    24
    """
    turn, beside = (int(node) for node in nodes)
    stroke, middle = abs(values[turn] - values[beside]), (values[turn] + values[beside]) / 2
    own, other = (_passing(values, turn, end, middle) for end in (far, beside))
    step = 1 if beside > turn else -1
    image = np.arange(other, beside + step, step)
    at = np.clip(own + other - image, 0, values.size - 1)
    # each passes the middle up to half a sample from the one that is taken
    allowed = max(_SHORT * stroke, 2 * stroke / abs(turn - beside), tolerance)
    apart = np.abs(values[at] - values[image])
    return turn if (apart > allowed).any() else int(at[-1])


def _waits(time: Floats, values: Floats, nodes: Indices, far: int, *, is_whole: bool) -> bool:
    """Whether an end half cycle, from a turn to a far end, waits on its way.

    ``nodes`` are its turn, the one beside it and the next like its turn.

    Examples
    --------
    A ramp from slack, and one that waits half way:

    >>> wave = np.interp(np.arange(37), [0, 12, 20, 28, 36], [0.0, 6, 2, 6, 2])
    >>> _waits(np.arange(37.0), wave, np.array([12, 20, 28]), 0, is_whole=False)
    False
    >>> wave = np.insert(wave, 8, [4.0] * 3)
    >>> _waits(np.arange(40.0), wave, np.array([15, 23, 31]), 0, is_whole=False)
    True
    """
    low, high = min(int(nodes.min()), far), max(int(nodes.max()), far) + 1
    time, values = time[low:high], values[low:high]
    # missing readings are no wait
    known = np.flatnonzero(np.isfinite(values))
    values = np.interp(np.arange(values.size), known, values[known])
    far, turn, beside, alike = (int(node) - low for node in (far, *nodes))
    passed = np.array(
        [
            [
                _passing(values, begin, end, level)
                for level in np.linspace(values[begin], values[beside], _LEVELS)[1:-1]
            ]
            for begin, end in ((turn, far), (alike, beside))
        ]
    )
    own, usual = np.abs(np.diff(time[passed]))
    lasts, n_steps = float(usual.sum()), abs(int(passed[1, -1] - passed[1, 0]))
    # a ramp that is slower from level to level waits nowhere
    longer = own - usual
    longer -= max(float(longer.min()), 0.0)
    return bool(longer.max() > max(_WAITS[is_whole], 2 / max(n_steps, 1)) * lasts)


_LEVELS = 11  # of a stroke, of which the first and the last are turns, where others wait too

_NEARLY_WHOLE = 1 - 1 / (_LEVELS - 1)  # reaches the last level but one

_WAITS = (0.1, 0.2)
"""Of the duration of a half cycle, by which it lasts longer between two levels than another one.

The second is that of one that does not go beyond the cycles: they may stutter as well."""


def _keeps_pace(
    time: Floats, nodes: Indices, end: int, turn: int, beside: int, at_edge: bool
) -> bool:
    """Whether an end half cycle has the duration of its neighbour, as in a sine."""
    lasts, usual = np.abs(time[nodes[[end, beside]]] - time[nodes[turn]])
    return not at_edge or bool(abs(lasts - usual) <= _PACE * usual)


def _allowed(neighbour: float, n_steps: int, edge: Edge, *, begins: bool, still: float) -> float:
    """Distance by which a half cycle at an edge may end short of the level of its neighbour."""
    if begins and edge == "standstill":
        return DIFFERENT * neighbour  # nothing was cut off: a machine settles as it starts
    within = max(_SHORT * neighbour, neighbour / n_steps)
    return max(within, still) if edge == "standstill" else within


_GAP_SHARE = 0.3  # of a half cycle

_GAP_STEPS = 3.5  # median time steps


@dataclass(frozen=True)
class _HalfCycles:
    """Half cycles in order of time, shape (n_half_cycles,) each.

    ``first`` and ``last`` are samples, both inside, and ``run`` numbers the runs of consecutive
    half cycles; within a run they rise and fall alternately.
    """

    first: Indices
    last: Indices
    rises: Bools
    run: Indices
    notes: tuple[Note, ...]
    made: tuple[str, ...] = ()
    n_ends_left_out: int = 0


def _replaced(samples: Indices, old: Indices, new: Integers) -> Indices:
    """Samples in order of time, with each of the old ones replaced by the new one."""
    if old.size == 0:
        return samples
    place = np.minimum(np.searchsorted(old, samples), old.size - 1)
    return np.where(old[place] == samples, new[place], samples)


def find_half_cycles(
    time: Floats,
    values: Floats,
    reversals: Indices,
    standstills: Standstills,
    *,
    band: float,
    skips: Indices | None = None,
    is_sinusoidal: bool = False,
) -> _HalfCycles:
    """Find the half cycles of runs that cycle, with their ends cut or left out.

    Parameters
    ----------
    time : ndarray, shape (n_samples,)
        Elapsed time. [s]
    values : ndarray, shape (n_samples,)
        Control channel; NaN where missing. [m] or [N]
    reversals : ndarray of int, shape (n_reversals,)
        From `reduction.stages.cycles.cycle_search.find_reversals`, at least two. [1]
    standstills : Standstills
        They end a run, unless they are dwells. [SI]
    band : float
        Band by which the reversals were found. [m] or [N]
    skips : ndarray of int, shape (n_skips,), optional
        Samples after which the log continues with a later cycle, though its time does not show it.
        They end a run, as a gap does. [1]
    is_sinusoidal : bool
        Whether all half cycles have the same duration.

    Returns
    -------
    half_cycles : HalfCycles
        In order of time; empty where nothing cycles.

    Notes
    -----
    A *run* is a stretch between standstills and between gaps of the record of more than
    30 % of a half cycle.  It cycles where two consecutive half cycles have ranges that
    differ by at most 30 %: the moves between holds before a test do not.  A standstill
    at a reversal is a *dwell* and does not end a run where three or more consecutive peaks, or
    valleys, have one at the same level, with durations that differ by at most a factor 2, or
    where it lasts at most twice as long as the turns of its kind.
    A half cycle at least as long as its two neighbours together is a move from one level
    to another: the run is split there, and the move serves as an end of both parts.

    *Ends.* A first or last half cycle with a range over 1.3 times its neighbour's is cut
    where it passes the neighbour's level, cf. the return to slack after the tenth peak
    in [1]_.  So is one that moves 5 % more, if also by three times the spread of the three beside
    it: it contains the approach.  One that begins or ends with the record or at a gap, or ends at
    a standstill, is incomplete and left out if it is short of the neighbour's level by more than
    5 % of its range, the travel of a sample and the tolerance of the standstill.  So is one that
    begins at a standstill, or at an edge where the signal stands, with less than 0.7 times its
    range.  Between two reversals it is whole, except beside a move away: a sine that begins or
    ends at its mean has moved half a range there.
    In a sinusoidal test an end that takes 25 % more or less time is left out, as is one that goes
    too far, unless it is a mirror image of its neighbour (`_end_of_sine`).  In any other test one
    is left out if it waits on its way, as the next like it does not (`_waits`).
    A wait at an end, too short for a standstill, is not part of the half cycle there
    (`reduction.stages.cycles.cycle_pairing._without_stands`).

    Examples
    --------
    Slack, two cycles between 2 and 3, and back to slack:

    >>> values = np.array([0.0, 1, 2, 3, 2.5, 2, 3, 2, 1, 0])
    >>> none = np.empty(0)
    >>> rests = Standstills(
    ...     none.astype(int), none.astype(int), none, none, none, np.empty((1, 0)),
    ...     none > 0, 0.1, 1.0)
    >>> halves = find_half_cycles(
    ...     np.arange(10.0), values, np.array([0, 3, 5, 6, 9]), rests, band=0.5)
    >>> print(halves.first, halves.last, halves.rises)
    [2 3 5 6] [3 5 6 7] [ True False  True False]
    """
    half_duration = float(np.median(np.diff(take_samples(time, reversals))))
    at, is_dwell = _dwells_of_cycles(time, values, reversals, standstills, band=band)
    longest = max(_GAP_SHARE * half_duration, _GAP_STEPS * median_step(time))
    gap_before, gap_after = _gaps_of_record(time, values, longest=longest)
    apart = np.empty(0, dtype=np.intp) if skips is None else skips
    breaks = (
        np.concatenate([standstills.first[~is_dwell], gap_before, apart]),
        np.concatenate([standstills.last[~is_dwell], gap_after, apart + 1]),
    )
    tolerance = _still(standstills)
    noise = max(noise_range(values, time), _CODES_APART * step_of_codes(values))
    runs = [
        _fit_ends(time, values, run, is_sinusoidal=is_sinusoidal, still=tolerance, tolerance=noise)
        for run in _runs_that_cycle(
            values, reversals, breaks, n_standstills=int(np.sum(~is_dwell)), band=band
        )
    ]
    cut = [at for run in runs for at in run.cut]
    short = [at for run in runs for at in run.short]
    paced = [at for run in runs for at in run.paced]
    made = [
        f"half cycles at the end of a run of cycles{what}: {len(samples)}, first near"
        f" {time[samples[0]]:g} s"
        for samples, what in (
            (cut, ", cut where they go beyond the level of their neighbours"),
            (short, ", short of the level of their neighbours, not counted"),
            (paced, " that are no part of the wave, not counted"),
        )
        if samples
    ]
    empty = np.empty(0, dtype=np.intp)
    first = np.concatenate([empty, *(run.nodes[:-1] for run in runs)])
    last = np.concatenate([empty, *(run.nodes[1:] for run in runs)])
    rises = take_samples(values, last) > take_samples(values, first)
    # at a dwell one half cycle ends where the crosshead arrives, the next begins where it leaves
    dwell = reversals[at[is_dwell]]
    first = _replaced(first, dwell, standstills.last[is_dwell])
    last = _replaced(last, dwell, standstills.first[is_dwell])
    return _HalfCycles(
        first=first,
        last=last,
        rises=rises,
        run=np.repeat(np.arange(len(runs)), [run.nodes.size - 1 for run in runs]),
        made=tuple(made),
        n_ends_left_out=len(short) + len(paced),
        notes=(note("gaps-end-runs", n_gaps=gap_before.size, time=float(time[gap_before[0]])),)
        if gap_before.size
        else (),
    )


# an amplitude that is halved leaves a cycle open by a quarter of its range if that happens at
# the peak, by a third at the valley
_OPEN = 0.2

_SETTLING = 0.3  # for the first cycle of a run, in which a machine settles

_BESIDE = 24  # parts of a cycle, from a turn: where the drop-outs of a logger end

_SMALL = 0.4  # of the median range: a cycle in which the band may hide others

_RUNS_OVER = 0.3  # of the range of a cycle: a way back within a branch that is a cycle of its own

_STEADY = 0.5  # of the step of a valley: least step of a neighbour in the same direction


def whole_cycles(values: Floats, halves: _HalfCycles) -> tuple[Indices, Indices, Indices]:
    """Branches of the cycles, and the first samples of pairs that are not a cycle.

    Parameters
    ----------
    values : ndarray, shape (n_samples,)
        Control channel; NaN where missing. [m] or [N]
    halves : HalfCycles
        From `reduction.stages.cycles.cycle_pairing.find_half_cycles`. [1]

    Returns
    -------
    branch_first, branch_last : ndarray of int, shape (n_cycles, 2)
        Samples of the ascending and the descending branch, both inside. [1]
    left_out : ndarray of int, shape (n_left_out,)
        First sample of each pair that lies between two amplitudes. [1]

    Notes
    -----
    An ascending half cycle with the descending one after it, in the same run, is a cycle [1]_.
    Where the two valleys differ by more than 20 % of its range (30 % in the first of a run,
    since a machine settles), one branch belongs to one amplitude or level and the other to the
    next: such a pair is left out. It is kept where the amplitude grows or decays steadily, that
    is, where the valley before or after steps in the same direction by at least half as much. The
    median of each valley and its neighbours is used, so that a drop-out at one does not open a
    cycle; but not where the channel stays below for longer, as when a specimen is unloaded.
    Where amplitudes grow, the band hides the first cycles, and a branch may run over several of
    them: a pair with a way back of more than three tenths of its range is left out.

    Examples
    --------
    Two cycles of 2, two of 1; the rise between them has a range of 1.5:

    >>> values = np.array([-1.0, 1, -1, 1, -1, 0.5, -0.5, 0.5, -0.5])
    >>> place = np.arange(8)
    >>> halves = _HalfCycles(place, place + 1, place % 2 == 0, np.zeros(8, dtype=int), ())
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
    # a fall to another level and back takes longer than a drop-out
    own = end - begin
    differ = np.flatnonzero(
        (np.abs(own) > _OPEN * np.abs(peak - end)) & (np.abs(own - step) > np.abs(own) / 2)
    )
    at = np.stack([halves.first[rising[differ]], halves.last[rising[differ] + 1]])
    is_end = np.abs(end - peak)[differ] > np.abs(begin - peak)[differ]
    reach = np.maximum((at[1] - at[0]) // _BESIDE, 2)
    beside = np.where(is_end, at[1], at[0])[:, None] + np.stack([-reach, reach], axis=1)
    level = np.maximum(begin, end)[differ] - np.abs(own[differ]) / 2
    stays = take_samples(values, np.clip(beside, 0, len(values) - 1)) < level[:, None]
    longer = differ[stays.all(axis=1)]
    step[longer] = own[longer]
    allowed = np.full(rising.size, _SETTLING)
    allowed[1:][follows] = _OPEN
    is_open = np.abs(step) > allowed * np.abs(peak - np.minimum(begin, end))
    goes_on = follows & (step[1:] * step[:-1] > 0)
    slower = _STEADY * np.abs(step)
    steady = np.zeros(rising.size, dtype=bool)
    steady[1:] |= goes_on & (np.abs(step[:-1]) >= slower[1:])
    steady[:-1] |= goes_on & (np.abs(step[1:]) >= slower[:-1])
    broken = is_open & ~steady
    reach = np.abs(peak - np.minimum(begin, end))
    small = _SMALL * np.median(reach) if reach.size else 0.0
    for pair in np.flatnonzero(~broken & (reach < small)).tolist():
        rise, fall = (
            values[halves.first[branch] : halves.last[branch] + 1] for branch in both[pair]
        )
        broken[pair] = max(_back(rise), _back(-fall)) > _RUNS_OVER * reach[pair]
    kept = both[~broken]
    return halves.first[kept], halves.last[kept], halves.first[rising[broken]]


def _back(rise: Floats) -> float:
    """Greatest way back within a rise.

    Examples
    --------
    >>> _back(np.array([0.0, 3.0, 1.0, np.nan, 4.0]))
    2.0
    """
    return float(np.nanmax(np.fmax.accumulate(rise) - rise))


def _steps(begin: Floats, end: Floats, follows: Bools) -> Floats:
    """Step between the valleys of each pair, each valley the median of it and its neighbours."""
    before, after = begin.copy(), end.copy()
    before[1:] = np.where(follows, begin[:-1], begin[1:])
    after[:-1] = np.where(follows, end[1:], end[:-1])
    first = np.median([before, begin, end], axis=0)
    last = np.median([begin, end, after], axis=0)
    return np.asarray(last - first)
