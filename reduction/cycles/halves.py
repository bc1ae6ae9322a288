"""Half cycles: which of the movements between reversals belong to cycling, and from where to where.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from reduction.phases.standstill import Standstills
from reduction.record import Bools, Floats

__all__ = ["HalfCycles", "find_half_cycles"]

_DIFFERENT = 0.3  # share by which ranges of neighbouring half cycles may differ
_FEWEST_DWELLS = 3
_DWELL_RATIO = 2.0
_GAP_SHARE = 0.3  # of a half cycle
_GAP_STEPS = 3.5  # median time steps
_BLOCK_SAMPLES = 1 << 16

Indices = NDArray[np.intp]


@dataclass(frozen=True)
class HalfCycles:
    """Half cycles in order of time, shape (n_half_cycles,) each.

    ``first`` and ``last`` are samples, both inside, and ``run`` counts runs of half cycles
    that follow each other; within a run they rise and fall in turn.
    """

    first: Indices
    last: Indices
    rises: Bools
    run: Indices
    notes: tuple[str, ...]


def _dwells(
    values: Floats, reversals: Indices, standstills: Standstills, band: float
) -> tuple[Indices, Bools]:
    """Reversal at which each standstill is (-1: none), and whether it is a dwell of cycles."""
    at = np.full(standstills.n_standstills, -1, dtype=np.intp)
    if at.size == 0 or reversals.size == 0:
        return at, np.zeros(at.size, dtype=bool)
    centre = (standstills.first + standstills.last) // 2
    level = values[np.clip(centre, 0, values.size - 1)]
    after = np.searchsorted(reversals, centre)
    near = np.clip(np.stack([after - 1, after]), 0, reversals.size - 1)
    distance = np.abs(reversals[near] - centre)
    nearest = np.where(distance[0] <= distance[1], near[0], near[1])
    is_level = np.abs(values[reversals[nearest]] - level) < band
    at[is_level] = nearest[is_level]

    holds = np.zeros(reversals.size, dtype=bool)
    duration = np.zeros(reversals.size)
    holds[at[is_level]] = True
    duration[at[is_level]] = (standstills.end_time - standstills.start_time)[is_level]
    stroke = np.abs(np.diff(values[reversals]))
    of_cycles = np.zeros(reversals.size, dtype=bool)
    for kind in (0, 1):  # peaks among peaks, valleys among valleys
        held, lasting = holds[kind::2], duration[kind::2]
        levels = values[reversals[kind::2]]
        same = held[1:] & held[:-1]
        same &= np.maximum(lasting[1:], lasting[:-1]) <= _DWELL_RATIO * np.minimum(
            lasting[1:], lasting[:-1]
        )
        same &= np.abs(np.diff(levels)) <= _DIFFERENT * stroke[kind::2][: same.size]
        in_a_row = _longest_row(same)
        dwell = np.zeros(held.size, dtype=bool)
        dwell[1:] |= in_a_row >= _FEWEST_DWELLS - 1
        dwell[:-1] |= in_a_row >= _FEWEST_DWELLS - 1
        of_cycles[kind::2] = dwell
    return at, (at >= 0) & of_cycles[at]


def _longest_row(true: Bools) -> Indices:
    """Length of the row of true values that each belongs to; 0 where false."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], true, [False]]).astype(np.int8)))
    length = edges[1::2] - edges[::2]
    rows = np.zeros(true.size, dtype=np.intp)
    rows[true] = np.repeat(length, length)
    return rows


def _gaps(time: Floats, values: Floats, longest: float) -> tuple[Indices, Indices]:
    """Samples before and after every step of time longer than allowed, missing samples left out."""
    before, after = [], []
    carried = np.empty(0, dtype=np.intp)
    for begin in range(0, time.size, _BLOCK_SAMPLES):
        block = values[begin : begin + _BLOCK_SAMPLES]
        rows = np.concatenate([carried, begin + np.flatnonzero(np.isfinite(block))])
        long = np.flatnonzero(np.diff(time[rows]) > longest)
        before.append(rows[long])
        after.append(rows[long + 1])
        carried = rows[-1:]
    return np.concatenate(before), np.concatenate(after)


def _stretches(
    values: Floats, reversals: Indices, breaks: tuple[Indices, Indices], band: float
) -> list[Indices]:
    """Extremes of each stretch between breaks; a break's own edge where a movement begins there."""
    order = np.argsort(breaks[0], kind="stable")
    break_first, break_last = breaks[0][order], breaks[1][order]
    bounds = np.searchsorted(reversals, np.stack([break_last, break_first]))
    begins = np.concatenate(
        [[0], bounds[0] + (reversals[np.minimum(bounds[0], reversals.size - 1)] == break_last)]
    )
    ends = np.concatenate([bounds[1], [reversals.size]])
    found = []
    for i, (begin, end) in enumerate(zip(begins, ends, strict=True)):
        nodes = reversals[begin : max(begin, end)]
        edge_before = break_last[i - 1 : i] if i > 0 else reversals[:0]
        edge_after = break_first[i : i + 1]
        if nodes.size:
            if edge_before.size and abs(values[edge_before[0]] - values[nodes[0]]) < band:
                edge_before = edge_before[:0]
            if edge_after.size and abs(values[edge_after[0]] - values[nodes[-1]]) < band:
                edge_after = edge_after[:0]
        elif (
            not (edge_before.size and edge_after.size)
            or abs(values[edge_before[0]] - values[edge_after[0]]) < band
        ):
            continue
        found.append(np.concatenate([edge_before, nodes, edge_after]))
    return [nodes for nodes in found if nodes.size > 1]


def _cut(values: Floats, nodes: Indices, ranges: Floats, at_end: bool) -> None:
    """Move an end to where a longer half cycle passes the level of its neighbour's other end."""
    end, turn, level_node = (-1, -2, -3) if at_end else (0, 1, 2)
    begin, stop = sorted((int(nodes[end]), int(nodes[turn])))
    level = values[nodes[level_node]]
    beyond = values[begin : stop + 1] <= level
    if values[nodes[turn]] < level:
        beyond = values[begin : stop + 1] >= level
    passed = np.flatnonzero(beyond)
    nodes[end] = begin + (passed[0] if at_end else passed[-1])
    ranges[-1 if at_end else 0] = abs(values[nodes[turn]] - level)


def find_half_cycles(
    time: Floats,
    values: Floats,
    reversals: Indices,
    standstills: Standstills,
    *,
    band: float,
) -> HalfCycles:
    """Keep the half cycles of runs that cycle, ends cut or left out.

    Parameters
    ----------
    time : ndarray, shape (n_samples,)
        Elapsed time. [s]
    values : ndarray, shape (n_samples,)
        Control channel; NaN where missing. [m] or [N]
    reversals : ndarray of int, shape (n_reversals,)
        From `reduction.cycles.reversals.find_reversals`, at least two. [1]
    standstills : Standstills
        They end a run, unless they are dwells. [SI]
    band : float
        With which the reversals were found. [m] or [N]

    Returns
    -------
    half_cycles : HalfCycles
        In order of time; empty where nothing cycles.

    Raises
    ------
    IndexError
        If there are fewer than two reversals.

    Notes
    -----
    A *run* is a stretch between standstills and between gaps of the record of more than
    30 % of a half cycle.  It cycles where two half cycles in a row have ranges that
    differ by at most 30 %: the moves between holds before a test do not.  A standstill
    at a reversal is a *dwell* and ends no run where three or more peaks in a row, or
    valleys, have one at the same level, and their durations differ by at most a factor 2.
    A half cycle at least as long as its two neighbours together is a move from one level
    to another: the run is parted there, and the move serves as an end of both parts.

    *Ends.* A first or last half cycle with a range over 1.3 times its neighbour's is cut
    where it passes the neighbour's level, cf. the return to slack after the tenth peak
    in [1]_.  One below 0.7 times is incomplete and left out.

    Examples
    --------
    Slack, two cycles between 2 and 3, and back to slack.

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
    half_duration = float(np.median(np.diff(time[reversals])))
    at, is_dwell = _dwells(values, reversals, standstills, band)
    gap_before, gap_after = _gaps(
        time, values, max(_GAP_SHARE * half_duration, _GAP_STEPS * _median_step(time))
    )
    breaks = (
        np.concatenate([standstills.first[~is_dwell], gap_before]),
        np.concatenate([standstills.last[~is_dwell], gap_after]),
    )
    arrives, leaves = reversals.copy(), reversals.copy()
    arrives[at[is_dwell]] = standstills.first[is_dwell]
    leaves[at[is_dwell]] = standstills.last[is_dwell]
    dwell_at = {
        int(node): (int(one), int(other))
        for node, one, other in zip(
            reversals[at[is_dwell]], arrives[at[is_dwell]], leaves[at[is_dwell]], strict=True
        )
    }

    firsts, lasts, rising, runs = [], [], [], []
    cut, short = [], []
    n_runs = 0
    for stretch in _stretches(values, reversals, breaks, band):
        for nodes in _parts(values, stretch):
            ranges = np.abs(np.diff(values[nodes]))
            if not _is_cycling(ranges):
                continue
            if ranges[0] > (1 + _DIFFERENT) * ranges[1]:
                cut.append(time[nodes[1]])
                _cut(values, nodes, ranges, at_end=False)
            if ranges[-1] > (1 + _DIFFERENT) * ranges[-2]:
                cut.append(time[nodes[-2]])
                _cut(values, nodes, ranges, at_end=True)
            if ranges[0] < (1 - _DIFFERENT) * ranges[1]:
                short.append(time[nodes[0]])
                nodes, ranges = nodes[1:], ranges[1:]
            if ranges.size > 1 and ranges[-1] < (1 - _DIFFERENT) * ranges[-2]:
                short.append(time[nodes[-1]])
                nodes, ranges = nodes[:-1], ranges[:-1]
            firsts.append(nodes[:-1])
            lasts.append(nodes[1:])
            rising.append(values[nodes[1:]] > values[nodes[:-1]])
            runs.append(np.full(nodes.size - 1, n_runs))
            n_runs += 1
    if not firsts:
        none = np.empty(0, dtype=np.intp)
        return HalfCycles(none, none, none > 0, none, ())
    first, last = np.concatenate(firsts), np.concatenate(lasts)
    if dwell_at:
        first = np.array([dwell_at.get(int(i), (i, i))[1] for i in first])
        last = np.array([dwell_at.get(int(i), (i, i))[0] for i in last])
    notes = []
    if cut:
        notes.append(
            f"{len(cut)} first or last half cycles ran on beyond the level of their neighbours "
            f"and are cut there, first near {cut[0]:g} s"
        )
    if short:
        notes.append(
            f"{len(short)} first or last half cycles fall short of their neighbours by more than "
            f"30 % and are not counted, first near {short[0]:g} s"
        )
    if gap_before.size:
        notes.append(
            f"{gap_before.size} gaps longer than 30 % of a half cycle end a run of cycles, "
            f"first near {time[gap_before[0]]:g} s"
        )
    return HalfCycles(first, last, np.concatenate(rising), np.concatenate(runs), tuple(notes))


def _median_step(time: Floats) -> float:
    """Median time step, of at most 100,001 steps."""
    first = np.arange(0, time.size - 1, max(1, time.size // 100_001))
    return float(np.median(time[first + 1] - time[first]))


def _parts(values: Floats, nodes: Indices) -> list[Indices]:
    """A stretch, parted at moves from one level to another; the move ends both parts."""
    ranges = np.abs(np.diff(values[nodes]))
    moves = 1 + np.flatnonzero(ranges[1:-1] >= ranges[:-2] + ranges[2:])
    begins = np.concatenate([[0], moves])
    ends = np.concatenate([moves + 2, [nodes.size]])
    return [nodes[begin:end].copy() for begin, end in zip(begins, ends, strict=True)]


def _is_cycling(ranges: Floats) -> bool:
    """Whether two half cycles in a row have similar ranges."""
    if ranges.size < 2:
        return False
    smaller = np.minimum(ranges[1:], ranges[:-1])
    return bool((smaller >= (1 - _DIFFERENT) * np.maximum(ranges[1:], ranges[:-1])).any())
