"""Ends of a run of half cycles: cut where they ran on, left out where they are no half cycle.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from reduction.cycles.runs import DIFFERENT, Edge, Run
from reduction.record import Floats
from reduction.samples.blocks import take_samples

_SHORT = 0.05  # share of its neighbour by which one at an edge may end short of the level
_PACE = 0.25  # share by which a half cycle at the end of a run may last longer or shorter
_TURNS_BESIDE = 8  # turns of the run that an end is held against
_LINGERS = 1.5  # times as long as at the slowest of them
_FEWEST_STILL = 2  # samples longer than at the slowest of them
_STEPS_READ = 64  # looked at first, then twice as many

Indices = NDArray[np.intp]


@dataclass(frozen=True)
class FittedRun:
    """Extremes of a run with its ends fitted, and samples near which an end was changed.

    ``cut`` ran on beyond its neighbour's level, ``short`` fell short of it, ``paced`` kept
    another pace than the sine.
    """

    nodes: Indices
    cut: tuple[int, ...] = ()
    short: tuple[int, ...] = ()
    paced: tuple[int, ...] = ()


def without_stands(
    values: Floats, nodes: Indices, *, first: int, last: int, tolerance: float
) -> Indices:
    """Extremes of a run, its first and last where the movement begins and where it ends.

    Parameters
    ----------
    values : ndarray, shape (n_samples,)
        Control channel; NaN where missing. [m] or [N]
    nodes : ndarray of int, shape (n_nodes,)
        Extremes that follow each other, at samples that are there. [1]
    first, last : int
        Samples between which the signal is the run's. [1]
    tolerance : float
        Range in which the signal stands. [m] or [N]

    Returns
    -------
    nodes : ndarray of int, shape (n_nodes,)
        The first one no earlier, the last one no later. [1]

    Raises
    ------
    IndexError
        If an extreme is not a sample of the values.

    Notes
    -----
    Where a machine waits before the first stroke, for too short a time to be a standstill,
    any sample of the wait may be the extreme.  An end at which the signal stays within the
    tolerance for more than 1.5 times as long as at the turns of the run is such a wait; it is
    moved to where it lies as far from the end of the stand as those turns do, by their median.
    Between two extremes alone nothing is moved.  A hold that each cycle has, and the flat turn
    of a sine, stay as they are.

    Examples
    --------
    Three samples of waiting at the valley before two strokes.

    >>> values = np.array([2.0, 2, 2, 2, 4, 2, 4, 2])
    >>> without_stands(values, np.array([0, 4, 5, 6, 7]), first=0, last=7, tolerance=0.1)
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
        turns = range(2, nodes.size - 1, 2) or range(1, 2)  # valleys among valleys, if there are
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
    """Samples from a turn, towards another, up to the last before the signal goes away."""
    step, reach = (1 if far > turn else -1), abs(far - turn)
    begin, count, last = 0, _STEPS_READ, 0
    while begin <= reach:
        stop = min(begin + count, reach + 1)
        level = values[turn + step * np.arange(begin, stop)]
        away = np.abs(level - values[turn]) > tolerance  # a missing sample is no movement
        seen = np.flatnonzero(np.isfinite(level[: int(np.argmax(away)) if away.any() else None]))
        last = begin + int(seen[-1]) if seen.size else last
        if away.any():
            break
        begin, count = stop, 2 * count
    return last


def fit_ends(
    time: Floats,
    values: Floats,
    run: Run,
    *,
    is_sinusoidal: bool,
    still: float,
    tolerance: float,
) -> FittedRun:
    """Fit the ends of a run that cycles.

    Parameters
    ----------
    time : ndarray, shape (n_samples,)
        Elapsed time. [s]
    values : ndarray, shape (n_samples,)
        Control channel; NaN where missing. [m] or [N]
    run : Run
        From `reduction.cycles.runs.runs_that_cycle`. [1]
    is_sinusoidal : bool
        Whether every half cycle takes the same time.
    still : float
        Tolerance of a standstill, by which an end at one may be short. [m] or [N]
    tolerance : float
        Range that noise alone may span in the control channel. [m] or [N]

    Returns
    -------
    fitted : FittedRun
        The extremes that are left. [1]

    Raises
    ------
    IndexError
        If an extreme is not a sample of the values.

    Notes
    -----
    The rules are those of `reduction.cycles.halves.find_half_cycles`; where the movement
    begins and ends, `without_stands` says.

    Examples
    --------
    From slack at 0; the first half cycle is cut where it passes the valley.

    >>> values = np.array([0.0, 1, 2, 3, 2, 3, 2])
    >>> fit_ends(np.arange(7.0), values, Run(np.array([0, 3, 4, 5, 6]), "record", "record"),
    ...     is_sinusoidal=False, still=0.1, tolerance=0.1)
    FittedRun(nodes=array([2, 3, 4, 5, 6]), cut=(3,), short=(), paced=())
    """
    moving = partial(
        without_stands,
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
        ran_on = own > (1 + DIFFERENT) * neighbour
        # a machine that begins or ends a sine at its mean moves half a range, then away
        is_fragment = ranges.size > 4 and neighbour < (1 - DIFFERENT) * ranges[beside]
        if is_fragment and (ran_on or at_edge):
            left_out[side] = 2
            short.append(int(nodes[turn]))
            continue
        if is_sinusoidal and (ran_on or not _keeps_pace(time, nodes, end, turn, beside, at_edge)):
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
    nodes = nodes[left_out[0] : nodes.size - left_out[1]]
    # cycles run from valley to valley: a half cycle before the first valley is in none of them
    valley = slice(*_valleys(values, nodes))
    nodes[valley] = moving(nodes[valley])
    return FittedRun(nodes, tuple(cut), tuple(short), tuple(paced))


def _valleys(values: Floats, nodes: Indices) -> tuple[int, int]:
    """Place of the first valley of a run, and the place after its last."""
    if nodes.size < 2:
        return 0, nodes.size
    falls = np.diff(values[nodes[[0, 1, -2, -1]]]) < 0
    return int(falls[0]), nodes.size - int(not falls[-1])


def _passing(values: Floats, turn: int, end: int, level: float) -> int:
    """Sample between a turn and a far end at which the signal passes a level."""
    step = 1 if end > turn else -1
    way = values[turn : end + step if end + step >= 0 else None : step]
    beyond = way <= level if values[turn] > level else way >= level
    return turn + step * int(np.argmax(beyond))


def _keeps_pace(
    time: Floats, nodes: Indices, end: int, turn: int, beside: int, at_edge: bool
) -> bool:
    """Whether an end half cycle takes the time of its neighbour, as every one of a sine does."""
    lasts, usual = np.abs(time[nodes[[end, beside]]] - time[nodes[turn]])
    return not at_edge or bool(abs(lasts - usual) <= _PACE * usual)


def _allowed(neighbour: float, n_steps: int, edge: Edge, *, begins: bool, still: float) -> float:
    """How far a half cycle at an edge may be short of the level of its neighbour."""
    if begins and edge == "standstill":
        return DIFFERENT * neighbour  # nothing was broken off: a machine settles as it starts
    within = max(_SHORT * neighbour, neighbour / n_steps)
    return max(within, still) if edge == "standstill" else within
