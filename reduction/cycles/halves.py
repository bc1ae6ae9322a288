"""Half cycles: which of the movements between reversals belong to cycling, and from where to where.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from reduction.cycles.dwells import dwells_of_cycles
from reduction.phases.intervals import median_step
from reduction.phases.standstill import Standstills
from reduction.record import Bools, Floats, Integers

__all__ = ["HalfCycles", "find_half_cycles"]

_DIFFERENT = 0.3  # share by which ranges of neighbouring half cycles may differ
_SHORT = 0.05  # share of its neighbour by which one at an edge may end short of the level
_STANDING = 0.04  # of a half cycle: movement in its first tenth of one that begins standing
_PACE = 0.25  # share by which a half cycle at the end of a run may last longer or shorter
_GAP_SHARE = 0.3  # of a half cycle
_GAP_STEPS = 3.5  # median time steps
_EDGE_SHARE = 0.1  # of a half cycle
_BLOCK_SAMPLES = 1 << 16

Indices = NDArray[np.intp]
_Edge = Literal["reversal", "standstill", "record"]  # a gap is an end of the record


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


def _replaced(samples: Indices, old: Indices, new: Integers) -> Indices:
    """Samples with each of the old ones, in order of time, replaced by the new."""
    if old.size == 0:
        return samples
    place = np.minimum(np.searchsorted(old, samples), old.size - 1)
    return np.where(old[place] == samples, new[place], samples)


@dataclass(frozen=True)
class _Run:
    """Extremes that follow each other, and whether the record or the movement ends at them."""

    nodes: Indices
    begins_at: _Edge
    ends_at: _Edge


def _stretches(
    values: Floats,
    reversals: Indices,
    breaks: tuple[Indices, Indices],
    n_standstills: int,
    band: float,
) -> list[_Run]:
    """Extremes of each stretch between breaks, of which the standstills are first.

    The edge of a break is one where a movement begins there.
    """
    order = np.argsort(breaks[0], kind="stable")
    finite = np.isfinite(values)
    start, stop = int(np.argmax(finite)), values.size - 1 - int(np.argmax(finite[::-1]))
    begins = np.concatenate([[start], breaks[1][order]])
    ends = np.concatenate([breaks[0][order], [stop]])
    edges: list[_Edge] = ["standstill" if at < n_standstills else "record" for at in order]
    edges = ["record", *edges, "record"]
    found = []
    for place, (begin, end) in enumerate(zip(begins, ends, strict=True)):
        nodes = reversals[slice(*np.searchsorted(reversals, [begin + 1, end]))]
        # the edge is an extreme of its own where the nearest one is a band away
        inner = nodes if nodes.size else np.array([end])
        if abs(values[begin] - values[inner[0]]) >= band:
            nodes = np.concatenate([[begin], nodes])
        inner = nodes if nodes.size else np.array([begin])
        if abs(values[end] - values[inner[-1]]) >= band:
            nodes = np.concatenate([nodes, [end]])
        if nodes.size > 1:
            near = _EDGE_SHARE * (nodes[-1] - nodes[0]) / (nodes.size - 1)
            edge = edges[place]
            if _is_standing(values, nodes, begin, ceil(near)):
                edge = "standstill"
            found.append(
                _Run(
                    nodes,
                    edge if nodes[0] - begin <= near else "reversal",
                    edges[place + 1] if end - nodes[-1] <= near else "reversal",
                )
            )
    return found


def _is_standing(values: Floats, nodes: Indices, begin: int, n_steps: int) -> bool:
    """Whether the movement begins at a stand, if for too short a time to be a standstill."""
    moved = values[min(begin + n_steps, values.size - 1)] - values[begin]
    return bool(abs(moved) < _STANDING * abs(values[nodes[1]] - values[nodes[0]]))


def _parts(values: Floats, run: _Run) -> list[_Run]:
    """A stretch, parted at moves from one level to another; the move ends both parts."""
    nodes = run.nodes
    ranges = np.abs(np.diff(values[nodes]))
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
    return bool((smaller >= (1 - _DIFFERENT) * np.maximum(ranges[1:], ranges[:-1])).any())


def _passing(values: Floats, turn: int, end: int, level: float) -> int:
    """Sample between a turn and a far end at which the signal passes a level."""
    step = 1 if end > turn else -1
    way = values[turn : end + step if end + step >= 0 else None : step]
    beyond = way <= level if values[turn] > level else way >= level
    return turn + step * int(np.argmax(beyond))


def _keeps_pace(turns: Floats, end: int, turn: int, beside: int, at_edge: bool) -> bool:
    """Whether an end half cycle takes the time of its neighbour, as every one of a sine does."""
    lasts, usual = np.abs(turns[[end, beside]] - turns[turn])
    return not at_edge or bool(abs(lasts - usual) <= _PACE * usual)


def _allowed(neighbour: float, n_steps: int, edge: _Edge, *, begins: bool, still: float) -> float:
    """How far a half cycle at an edge may be short of the level of its neighbour."""
    if begins and edge == "standstill":
        return _DIFFERENT * neighbour  # nothing was broken off: a machine settles as it starts
    within = max(_SHORT * neighbour, neighbour / n_steps)
    return max(within, still) if edge == "standstill" else within


def _fit_ends(
    time: Floats, values: Floats, run: _Run, *, is_sinusoidal: bool, still: float
) -> tuple[Indices, list[int], list[int], list[int]]:
    """Extremes of a run that cycles; ends that ran on, fell short, or kept another pace."""
    nodes = run.nodes
    ranges = np.abs(np.diff(values[nodes]))
    cut, short, paced = [], [], []
    left_out = [0, 0]
    for side, (end, turn, beside, edge) in enumerate(
        ((0, 1, 2, run.begins_at), (-1, -2, -3, run.ends_at))
    ):
        at_edge = edge != "reversal"
        own, neighbour = ranges[end], ranges[-2 if end else 1]
        ran_on = own > (1 + _DIFFERENT) * neighbour
        # a machine that begins or ends a sine at its mean moves half a range, then away
        is_fragment = ranges.size > 4 and neighbour < (1 - _DIFFERENT) * ranges[beside]
        if is_fragment and (ran_on or at_edge):
            left_out[side] = 2
            short.append(int(nodes[turn]))
            continue
        if is_sinusoidal and (ran_on or not _keeps_pace(time[nodes], end, turn, beside, at_edge)):
            left_out[side] = 1
            paced.append(int(nodes[turn]))
        elif ran_on:
            cut.append(int(nodes[turn]))
            nodes[end] = _passing(values, nodes[turn], nodes[end], values[nodes[beside]])
            ranges[end] = neighbour
        # a short one between true reversals is whole: an amplitude that grows or decays
        elif at_edge and neighbour - own > _allowed(
            neighbour, abs(int(nodes[turn] - nodes[beside])), edge, begins=side == 0, still=still
        ):
            left_out[side] = 1
            short.append(int(nodes[end]))
    return nodes[left_out[0] : nodes.size - left_out[1]], cut, short, paced


def find_half_cycles(
    time: Floats,
    values: Floats,
    reversals: Indices,
    standstills: Standstills,
    *,
    band: float,
    is_sinusoidal: bool = False,
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
    is_sinusoidal : bool
        Whether every half cycle takes the same time.

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
    in [1]_.  One that begins or ends with the record or at a gap, or ends at a standstill,
    short of the neighbour's level by more than 5 % of its range, the travel of a sample and
    the tolerance of the standstill, is incomplete and left out; so is one that begins at a
    standstill, or at an edge where the signal stands, with less than 0.7 times its range.
    Between two reversals it is whole, but for one beside a move away: a sine that begins or
    ends at its mean has moved half a range there.
    In a sinusoidal test an end that ran on, or takes 25 % more or less time, is left out.

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
    at, is_dwell = dwells_of_cycles(values, reversals, standstills, band=band)
    longest = max(_GAP_SHARE * half_duration, _GAP_STEPS * median_step(time))
    gap_before, gap_after = _gaps(time, values, longest)
    breaks = (
        np.concatenate([standstills.first[~is_dwell], gap_before]),
        np.concatenate([standstills.last[~is_dwell], gap_after]),
    )
    # of the channel that stands still: the tension where it is held, else the position
    still = standstills.tension_tolerance
    tolerance = standstills.position_tolerance if still is None else still
    runs: list[Indices] = []
    cut: list[int] = []
    short: list[int] = []
    paced: list[int] = []
    for stretch in _stretches(values, reversals, breaks, int(np.sum(~is_dwell)), band):
        for run in _parts(values, stretch):
            if _is_cycling(np.abs(np.diff(values[run.nodes]))):
                nodes, ran_on, fell_short, other_pace = _fit_ends(
                    time, values, run, is_sinusoidal=is_sinusoidal, still=tolerance
                )
                runs.append(nodes)
                cut += ran_on
                short += fell_short
                paced += other_pace

    notes = []
    for samples, what in (
        (cut, "half cycles at the end of a run, cut where they pass their neighbours' level"),
        (short, "half cycles at the end of a run, short of their neighbours' level, not counted"),
        (paced, "half cycles at the end of a run that are no part of the sine, not counted"),
        (gap_before, "gaps of the record longer than 30 % of a half cycle, each the end of a run"),
    ):
        if len(samples):
            notes.append(f"{what}: {len(samples)}, first near {time[samples[0]]:g} s")
    empty = np.empty(0, dtype=np.intp)
    first = np.concatenate([empty, *(nodes[:-1] for nodes in runs)])
    last = np.concatenate([empty, *(nodes[1:] for nodes in runs)])
    rises = values[last] > values[first]
    # at a dwell one half cycle ends where the crosshead arrives, the next begins where it leaves
    dwell = reversals[at[is_dwell]]
    first = _replaced(first, dwell, standstills.last[is_dwell])
    last = _replaced(last, dwell, standstills.first[is_dwell])
    return HalfCycles(
        first=first,
        last=last,
        rises=rises,
        run=np.repeat(np.arange(len(runs)), [nodes.size - 1 for nodes in runs]),
        notes=tuple(notes),
    )
