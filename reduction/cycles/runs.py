"""Runs of extremes that follow each other, between standstills, gaps and moves to other levels.

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

from reduction.record import Floats
from reduction.samples.blocks import BLOCK, sample_blocks, take_samples

DIFFERENT = 0.3
"""Share by which ranges of neighbouring half cycles may differ. [1]."""

_STANDING = 0.04  # of a half cycle: movement in its first tenth of one that begins standing
_EDGE_SHARE = 0.1  # of a half cycle

Indices = NDArray[np.intp]
Edge = Literal["reversal", "standstill", "record"]  # a gap is an end of the record


@dataclass(frozen=True)
class Run:
    """Extremes that follow each other, and whether the record or the movement ends at them."""

    nodes: Indices
    begins_at: Edge
    ends_at: Edge


def gaps_of_record(time: Floats, values: Floats, *, longest: float) -> tuple[Indices, Indices]:
    """Samples before and after every step of time longer than allowed, missing samples left out.

    Parameters
    ----------
    time : ndarray, shape (n_samples,)
        Elapsed time. [s]
    values : ndarray, shape (n_samples,)
        Control channel; NaN where missing. [m] or [N]
    longest : float
        Step that is no gap yet. [s]

    Returns
    -------
    before, after : ndarray of int, shape (n_gaps,)
        Samples that are there. [1]

    Raises
    ------
    IndexError
        If the values are longer than time.

    Examples
    --------
    >>> gaps_of_record(np.arange(6.0), np.array([0.0, 1, np.nan, np.nan, 4, 5]), longest=2.0)
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


def runs_that_cycle(
    values: Floats,
    reversals: Indices,
    breaks: tuple[Indices, Indices],
    *,
    n_standstills: int,
    band: float,
) -> list[Run]:
    """Runs in which two half cycles in a row have similar ranges, in order of time.

    Parameters
    ----------
    values : ndarray, shape (n_samples,)
        Control channel; NaN where missing. [m] or [N]
    reversals : ndarray of int, shape (n_reversals,)
        From `reduction.cycles.reversals.find_reversals`. [1]
    breaks : tuple of two ndarray of int, shape (n_breaks,)
        First and last sample of each standstill, then samples before and after each gap. [1]
    n_standstills : int
        How many of the breaks are standstills. [1]
    band : float
        With which the reversals were found. [m] or [N]

    Returns
    -------
    runs : list of Run
        The edge of a break is an extreme where a movement begins there; a stretch between
        breaks is parted at moves from one level to another, and a move ends both parts.

    Raises
    ------
    IndexError
        If a reversal or a break is not a sample of the values.

    Examples
    --------
    Two cycles, a gap, and a movement alone.

    >>> values = np.array([0.0, 2, 0, 2, 0, 1, 3])
    >>> gap = np.array([4]), np.array([5])
    >>> for run in runs_that_cycle(values, np.arange(1, 4), gap, n_standstills=0, band=0.5):
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
) -> list[Run]:
    """Extremes of each stretch between breaks, of which the standstills are first.

    The edge of a break is one where a movement begins there.
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
                Run(
                    nodes,
                    edge if nodes[0] - begin <= near else "reversal",
                    edges[place + 1] if end - nodes[-1] <= near else "reversal",
                )
            )
    return found


def _finite_ends(values: Floats) -> tuple[int, int]:
    """First and last sample that is there; the ends of the record where none is."""
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
    """Whether the movement begins at a stand, if for too short a time to be a standstill."""
    moved = values[min(begin + n_steps, values.size - 1)] - values[begin]
    return bool(abs(moved) < _STANDING * abs(values[nodes[1]] - values[nodes[0]]))


def _parts(values: Floats, run: Run) -> list[Run]:
    """A stretch, parted at moves from one level to another; the move ends both parts."""
    nodes = run.nodes
    ranges = np.abs(np.diff(take_samples(values, nodes)))
    moves = 1 + np.flatnonzero(ranges[1:-1] >= ranges[:-2] + ranges[2:])
    begins = np.concatenate([[0], moves])
    ends = np.concatenate([moves + 2, [nodes.size]])
    return [
        Run(
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
