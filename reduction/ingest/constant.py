"""A channel that repeats one value while the crosshead moves: stuck, or at the end of its range.

A hold repeats values too, and so does a slack specimen: neither is a fault.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reduction.ingest.quality import noise_of
from reduction.record import Bools, Floats, Integers
from reduction.samples.blocks import BLOCK, finite_extremes, sample_blocks, take_samples
from reduction.samples.intervals import interval_labels, over_intervals

_EDGES = 1 << 10  # of runs, looked at together: a quantised channel has one for every level
_SATURATED_SAMPLES = 5
_SATURATED_STEPS = 16.0
_MOVING_NOISE = 10.0
_MOVING_SHARE = 1e-3
# places in a run at which position is looked at; uneven, or cycles could hide in between
_LOOKS = np.sort(np.arange(16) * (np.sqrt(5) - 1) / 2 % 1)
_SLACK_SHARE = 0.02
_JUMP_SHARE = 0.1
_RISE_SHARE = 0.25
_RISE_NOISE = 20.0


@dataclass(frozen=True)
class Runs:
    """Runs of equal values: first sample and the one after the last, shape (n_runs,) each."""

    start: Integers
    stop: Integers

    def where(self, keep: Bools) -> Runs:
        """Some of the runs."""
        return Runs(self.start[keep], self.stop[keep])

    def mask(self, like: Floats) -> Bools:
        """True inside the runs, for each sample of a series like that."""
        return interval_labels(like, self.start, self.stop, np.ones(self.start.size, dtype=bool))


def constant_runs(values: Floats, minimum: int) -> Runs:
    """Runs of at least ``minimum`` equal values.

    A run that long holds a whole block of half that length, and a block can be ruled
    out by three of its samples.

    Parameters
    ----------
    values : ndarray, shape (n_samples,)
        A channel. [any]
    minimum : int
        Shortest run. [1]

    Returns
    -------
    runs : Runs
        In order.
    """
    length = max(minimum // 2, 1)
    found = [np.empty(0, dtype=np.intp)]
    step = length * max(BLOCK // length, 1)
    for part in sample_blocks(values.size // length * length, values, size=step):
        grid = values[part].reshape(-1, length)
        equal = np.flatnonzero((grid[:, 0] == grid[:, length // 2]) & (grid[:, 0] == grid[:, -1]))
        equal = equal[(grid[equal] == grid[equal, :1]).all(axis=1)]
        found.append(part.start // length + equal)
    place = np.concatenate(found)
    if not place.size:
        return Runs(place, place)
    level = take_samples(values, place * length)
    is_first = np.concatenate([[True], (np.diff(place) > 1) | (np.diff(level) != 0)])
    is_last = np.concatenate([is_first[1:], [True]])
    start, stop = place[is_first] * length, (place[is_last] + 1) * length
    start = start - _repeats(values, start, -np.arange(1, length))
    stop = stop + _repeats(values, stop - 1, np.arange(1, length))
    runs = Runs(start, stop)
    return runs.where(stop - start >= minimum)


def _repeats(values: Floats, edge: Integers, reach: Integers) -> Integers:
    """Samples next to each edge, in the order of the reach, that repeat its value."""
    repeats = np.empty(edge.size, dtype=np.intp)
    for part in sample_blocks(edge.size, size=_EDGES):
        beyond = edge[part, np.newaxis] + reach
        inside = np.clip(beyond, 0, values.size - 1)
        same = take_samples(values, inside) == take_samples(values, edge[part])[:, np.newaxis]
        same &= inside == beyond
        repeats[part] = np.cumprod(same, axis=1).sum(axis=1)
    return repeats


def moves(position: Floats, runs: Runs) -> Bools:
    """Whether the crosshead moves in each run, shape (n_runs,)."""
    if not runs.start.size:
        return np.empty(0, dtype=bool)
    noise, _ = noise_of(position)
    low, high = finite_extremes(position)
    reach = np.fmax(high - position[0], position[0] - low)
    tolerance = _MOVING_NOISE * noise + _MOVING_SHARE * reach
    length = (runs.stop - runs.start)[:, np.newaxis]
    places = runs.start[:, np.newaxis] + (_LOOKS * length).astype(np.int64)
    looks = take_samples(position, places)
    travel = np.fmax.reduce(looks, axis=1) - np.fmin.reduce(looks, axis=1)
    return np.asarray(travel > tolerance)


def find_stuck(tension: Floats, position: Floats, *, samples: int) -> Bools:
    """Where a load channel repeats one value while the crosshead moves.

    Parameters
    ----------
    tension : ndarray, shape (n_samples,)
        Load. [N]
    position : ndarray, shape (n_samples,)
        Crosshead position. [m]
    samples : int
        ``stuck_samples`` of the settings. [1]

    Returns
    -------
    is_stuck : ndarray of bool, shape (n_samples,)
        A run at the level of a slack specimen counts only where the load jumps to it
        or from it, as when a cable comes loose.
    """
    runs = constant_runs(tension, samples)
    runs = runs.where(moves(position, runs))
    if not runs.start.size:
        return runs.mask(tension)
    low, high = finite_extremes(tension)
    level = take_samples(tension, runs.start)
    into = np.abs(level - take_samples(tension, np.maximum(runs.start - 1, 0)))
    out = np.abs(level - take_samples(tension, np.minimum(runs.stop, tension.size - 1)))
    is_slack = (level <= low + _SLACK_SHARE * (high - low)) & (high > low)
    jumps = np.fmax(into, out) > _JUMP_SHARE * (high - low)
    return runs.where(~is_slack | jumps).mask(tension)


def find_saturated(tension: Floats, position: Floats) -> Bools:
    """Where a load channel stands at its greatest or least value because it can go no further.

    A quantised peak repeats its greatest value as well.  It is saturated only where the
    load came, in as many samples before or after, from further than a rounded peak does.

    Parameters
    ----------
    tension : ndarray, shape (n_samples,)
        Load. [N]
    position : ndarray, shape (n_samples,)
        Crosshead position. [m]

    Returns
    -------
    is_saturated : ndarray of bool, shape (n_samples,)
        Runs of at least five samples while the crosshead moves.
    """
    starts: list[Integers] = [np.empty(0, dtype=np.intp)]
    stops = list(starts)
    low, high = finite_extremes(tension)
    for level in (low, high):
        if level == low and (low == high or abs(low) <= _SLACK_SHARE * (high - low)):
            continue  # a slack specimen reads zero, a dead channel is stuck
        place = np.concatenate(
            [
                part.start + np.flatnonzero(tension[part] == level)
                for part in sample_blocks(tension.size, tension)
            ]
        )
        if place.size < _SATURATED_SAMPLES:
            continue
        is_first = np.concatenate([[True], np.diff(place) > 1])
        is_last = np.concatenate([is_first[1:], [True]])
        runs = Runs(place[is_first], place[is_last] + 1)
        length = runs.stop - runs.start
        runs = runs.where(length >= _SATURATED_SAMPLES)
        if not runs.start.size:
            continue
        runs = runs.where(_comes_from_afar(tension, runs))
        runs = runs.where(moves(position, runs))
        starts.append(runs.start)
        stops.append(runs.stop)
    return Runs(np.sort(np.concatenate(starts)), np.sort(np.concatenate(stops))).mask(tension)


def _comes_from_afar(tension: Floats, runs: Runs) -> Bools:
    """Whether the load beside a run changes by far more than it does at a rounded peak.

    Where the top of a sine is one printed step high and as wide as the run, the load one
    width further out is eight such steps lower; that of a triangle, two.
    """
    length, last = runs.stop - runs.start, tension.size - 1
    level = take_samples(tension, runs.start)

    def away(places: Integers) -> Floats:
        return np.asarray(np.abs(level - take_samples(tension, np.clip(places, 0, last))))

    step = np.fmin(
        away(runs.start - 1) + np.where(runs.start == 0, np.inf, 0),
        away(runs.stop) + np.where(runs.stop > last, np.inf, 0),
    )
    before, after = away(runs.start - length), away(runs.stop - 1 + length)
    return np.asarray(np.fmax(before, after) >= _SATURATED_STEPS * step)


def find_stuck_position(position: Floats, tension: Floats, *, samples: int) -> Bools:
    """Where position stands still although tension rises: a hold does not make it rise.

    Parameters
    ----------
    position : ndarray, shape (n_samples,)
        Crosshead position. [m]
    tension : ndarray, shape (n_specimens, n_samples)
        Loads. [N]
    samples : int
        ``stuck_samples`` of the settings. [1]

    Returns
    -------
    is_stuck : ndarray of bool, shape (n_samples,)
        Runs in which any load rises by a quarter of its range.
    """
    runs = constant_runs(position, samples)
    if not runs.start.size:
        return runs.mask(position)
    rises = np.zeros(runs.start.size, dtype=bool)
    middle = (runs.start + runs.stop) // 2
    for load in tension:
        noise, _ = noise_of(load)
        low, high = finite_extremes(load)
        enough = max(_RISE_SHARE * (high - low), _RISE_NOISE * noise)
        halves = (runs.start, middle), (middle, runs.stop - 1)
        most = [over_intervals(np.fmax, load, *half) for half in halves]
        least = [over_intervals(np.fmin, load, *half) for half in halves]
        rises |= most[1] - least[0] > enough
        rises |= np.fmax(*most) - take_samples(load, runs.start) > enough
        rises |= take_samples(load, runs.stop - 1) - np.fmin(*least) > enough
    return runs.where(rises).mask(position)
