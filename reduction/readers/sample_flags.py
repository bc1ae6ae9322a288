"""Quality flags of samples: missing, stuck, saturated, spikes, gaps."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import comb
from typing import Any

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from reduction.record.arrays import finite_median, noise_of_differences, run_blocks
from reduction.record.errors import DataError
from reduction.record.measurement import Bools, Floats, Integers, Quality, Record
from reduction.record.notes import Note, note
from reduction.record.row_counts import notes_on_rows
from reduction.record.samples import (
    BLOCK,
    any_sample,
    copied,
    count_samples,
    finite_extremes,
    first_sample,
    interval_labels,
    over_intervals,
    readings_between,
    sample_blocks,
    take_samples,
    zeros_like,
)
from reduction.record.settings import QualitySettings

LONGEST = 10  # maximum length of an excursion, in samples

_NEIGHBOURS = 4  # steps on each side used to estimate the trend

_JUMP_TO_STEPS = 5.0

_OFF_COURSE = 0.5  # minimum offset from the trend between jumps, as a fraction of the jump

_RETURN = 0.1  # largest mismatch with the trend after the return, as a fraction of the jump

_SMALL_JUMP = 0.2  # below this fraction of the largest nearby, a jump starts a ramp

_MOST_IN_A_ROW = 3  # more jumps in close succession than this are signal

_SIGNAL_SHARE = 0.1  # excursions in more than this share of a series are its signal


def _usual_step(values: Floats, first: Integers, last: Integers) -> Floats:
    """Third largest of the eight steps before `first` and after `last`, for each place."""
    around = np.arange(1, _NEIGHBOURS + 1)
    left = np.concatenate([first[:, np.newaxis] - around, last[:, np.newaxis] + around], axis=1)
    is_inside = (left >= 0) & (left < values.size - 1)
    left = np.where(is_inside, left, 0)
    change = np.abs(take_samples(values, left + 1) - take_samples(values, left))
    steps = np.where(is_inside, change, 0.0)
    usual: Floats = np.sort(np.nan_to_num(steps), axis=1)[:, -3]
    return usual


def _find_excursions(values: Floats, jumps: Integers, *, limit: float) -> Integers:
    """Samples between a jump off the trend of a series and the jump back to it."""
    none = np.empty(0, dtype=np.intp)
    size = take_samples(values, jumps + 1) - take_samples(values, jumps)
    is_jump = np.abs(size) > np.fmax(limit, _JUMP_TO_STEPS * _usual_step(values, jumps, jumps))
    jumps, size = jumps[is_jump], np.abs(size[is_jump])
    if not jumps.size:
        return none
    row_start, n_jumps = _rows(jumps)
    largest = np.repeat(np.maximum.reduceat(size, row_start), n_jumps)
    out, back = _pairs(jumps[size > _SMALL_JUMP * largest])
    returns = _returns(values, out, back, limit)
    off = np.unique(_between(out[returns], back[returns]))
    return none if off.size > _SIGNAL_SHARE * values.size else off


def _rows(jumps: Integers) -> tuple[Integers, Integers]:
    """First jump and number of jumps in each group of closely spaced jumps."""
    row_start = np.flatnonzero(np.diff(jumps, prepend=-np.inf) > LONGEST)
    return row_start, np.diff(row_start, append=jumps.size)


def _pairs(jumps: Integers) -> tuple[Integers, Integers]:
    """Alternate jumps out and back in each small group of closely spaced jumps."""
    row_start, n_jumps = _rows(jumps)
    even = (n_jumps % 2 == 0) & (n_jumps <= 2 * _MOST_IN_A_ROW)
    place = np.arange(jumps.size) - np.repeat(row_start, n_jumps)
    in_even = np.repeat(even, n_jumps)
    out, back = jumps[in_even & (place % 2 == 0)], jumps[in_even & (place % 2 == 1)]
    if not out.size:
        return out, back
    n_pairs = n_jumps[even] // 2
    first = np.cumsum(n_pairs) - n_pairs
    between = np.append(out[1:] - back[:-1], 0).astype(np.float64)
    between[first + n_pairs - 1] = np.inf
    is_sparse = np.maximum.reduceat(back - out, first) <= np.minimum.reduceat(between, first)
    kept = np.repeat(is_sparse, n_pairs)
    return out[kept], back[kept]


def _between(out: Integers, back: Integers) -> Integers:
    """Samples after each jump out up to the jump back, ten per row, the last one repeated."""
    rows = out[:, np.newaxis] + np.arange(1, LONGEST + 1)
    return np.asarray(np.minimum(rows, back[:, np.newaxis]))


def _returns(values: Floats, out: Integers, back: Integers, limit: float) -> Bools:
    """Whether the samples between two jumps are off the trend, which resumes after them."""
    n_steps = back + 1 - out
    before, after = take_samples(values, out), take_samples(values, back + 1)
    leaves = take_samples(values, out + 1) - before
    comes = after - take_samples(values, back)
    size = np.fmin(np.abs(leaves), np.abs(comes))
    earlier = np.maximum(out - _NEIGHBOURS, 0)
    later = np.minimum(back + 1 + _NEIGHBOURS, values.size - 1)
    rise_before = (before - take_samples(values, earlier)) / np.maximum(out - earlier, 1)
    rise_after = (take_samples(values, later) - after) / np.maximum(later - back - 1, 1)
    ends = n_steps * np.nan_to_num(np.stack([rise_before, rise_after]))
    change = after - before
    missed = np.fmax(np.fmax(ends.min(axis=0) - change, change - ends.max(axis=0)), 0)
    rows = _between(out, back)
    line = before[:, np.newaxis] + (rows - out[:, np.newaxis]) * (change / n_steps)[:, np.newaxis]
    off = np.sign(leaves)[:, np.newaxis] * (take_samples(values, rows) - line)
    is_large = (n_steps > 2) & (
        size > np.fmax(limit, _JUMP_TO_STEPS * _usual_step(values, out, back))
    )
    is_back = (leaves * comes < 0) & (missed <= limit + _RETURN * size)
    return np.asarray(is_large & is_back & (off > _OFF_COURSE * size[:, np.newaxis]).all(axis=1))


_WINDOWS, _WINDOW = 64, 1024

_SPIKE_TO_NEIGHBOURS = 3.0

_STEP = np.sqrt(12.0)  # one step of a quantised value over its standard deviation


@dataclass(frozen=True)
class _Timing:
    """Faults of the time stamps."""

    step: float
    gap: Bools
    backward: Bools
    n_uneven: int
    shortest: float
    longest: float


def _find_missing(values: Floats) -> Bools:
    """Where a value is NaN, shape (n_samples,)."""
    missing = zeros_like(values, dtype=bool)
    for part in sample_blocks(values.size, values, missing):
        if not np.isfinite(values[part].sum()):
            np.isnan(values[part], out=missing[part])
    return missing


def _find_outside_range(values: Floats, low: float, high: float) -> Bools:
    """Where a value lies outside the verified range of the load cell, shape (n_samples,)."""
    outside = zeros_like(values, dtype=bool)
    for part in sample_blocks(values.size, values, outside):
        block = values[part]
        outside[part] = (block < low) | (block > high)
    return outside


def _sampled_windows(values: Floats) -> Floats:
    """Windows spread evenly over a series, one per row; a short series is one window."""
    if values.size <= _WINDOWS * _WINDOW:
        return values[np.newaxis]
    starts = np.linspace(0, values.size - _WINDOW, _WINDOWS).astype(np.int64)
    windows: Floats = take_samples(values, starts[:, np.newaxis] + np.arange(_WINDOW))
    return windows


def _time_faults(time: Floats, *, gap_factor: float, rate_tolerance: float) -> _Timing:
    """Gaps, backward or repeated time, and steps that differ from the median."""
    n_samples = time.size
    gap, backward = zeros_like(time, dtype=bool), zeros_like(time, dtype=bool)
    steps = np.diff(_sampled_windows(time), axis=1).ravel()
    steps = steps[steps > 0]
    if not steps.size:
        backward[1:] = True
        return _Timing(np.nan, gap, backward, 0, np.nan, np.nan)
    step = float(np.median(steps))
    low, high = (1 - rate_tolerance) * step, (1 + rate_tolerance) * step
    latest, n_uneven, shortest, longest = -np.inf, 0, np.inf, -np.inf
    for part in sample_blocks(n_samples, time, gap, backward, overlap=1):
        piece = time[part]
        step_here = np.diff(piece)
        least, most = (step_here.min(), step_here.max()) if step_here.size else (step, step)
        if low <= least and most <= high and piece[0] >= latest:  # the usual case; False on NaN
            latest = piece[-1]
            shortest, longest = min(shortest, least), max(longest, most)
            continue
        reached = np.fmax.accumulate(np.concatenate([[latest], piece]))
        late = piece[1:] <= reached[1:-1]
        backward[part][1:] = late
        latest = reached[-1]
        ahead = piece[1:] - reached[1:-1]  # past the latest time so far: no gap after a step back
        long = np.flatnonzero(ahead > gap_factor * step)
        stands_out = ahead[long] > gap_factor * _usual_time_step(time, long + part.start)
        gap[1 + part.start + long[stands_out]] = True
        usual = ahead[(ahead > 0) & ~gap[part][1:]]
        if usual.size:
            n_uneven += int(np.count_nonzero((usual < low) | (usual > high)))
            shortest, longest = min(shortest, usual.min()), max(longest, usual.max())
    # a machine that stops between two readings writes a last one
    if n_uneven == 1 and 0 < time[-1] - time[-2] < low:
        n_uneven = 0
    return _Timing(step, gap, backward, n_uneven, float(shortest), float(longest))


def _usual_time_step(time: Floats, place: Integers) -> Floats:
    """Median of the forward steps around each step; 0 where there are none."""
    around = np.concatenate([np.arange(-_NEIGHBOURS, 0), np.arange(1, _NEIGHBOURS + 1)])
    near = place[:, np.newaxis] + around
    is_inside = (near >= 0) & (near < time.size - 1)
    near = np.where(is_inside, near, 0)
    steps = take_samples(time, near + 1) - take_samples(time, near)
    steps = np.where(is_inside & (steps > 0), steps, np.nan)
    usual = np.zeros(place.size)
    is_known = np.isfinite(steps).any(axis=1)
    usual[is_known] = np.nanmedian(steps[is_known], axis=1)
    return usual


def _noise_of(values: Floats, order: int = 2) -> tuple[float, float]:
    """Standard deviation of a series about its trend, and its quantisation step.

    The noise is that of differences of the given order: the fourth contains less of the curvature
    of a wave with few readings a cycle than the second.
    """
    windows = _sampled_windows(values)
    levels = np.unique(
        windows[np.isfinite(windows)]
    )  # successive readings of a ramp are many codes apart
    step = float(np.diff(levels).min()) if levels.size > 1 else 0.0
    bends = np.diff(windows, n=order, axis=1)
    return max(noise_of_differences(bends, comb(2 * order, order)), step / _STEP), step


def _usual_code(values: Floats) -> float:
    """Size of the steps of a channel that is constant in most samples; 0 if it has none.

    An encoder logged with more digits than it resolves steps by 0.19 or 0.20 of its unit.

    Examples
    --------
    >>> counted = np.floor(np.arange(300.0) / 7)
    >>> round(_usual_code(0.2 * counted + np.where(counted % 3 == 0, 0.01, 0.0)), 2)
    0.19
    """
    changes = np.abs(np.diff(_sampled_windows(values), axis=1))
    moving = np.sort(changes[changes > 0])
    if not moving.size or 2 * moving.size > np.isfinite(changes).sum():
        return 0.0
    alike = np.searchsorted(moving, 1.1 * moving, side="right") - np.arange(moving.size)
    usual = int(np.argmax(alike))
    return float(moving[usual]) if alike[usual] >= _ONE_SIZE * moving.size else 0.0


_ONE_SIZE = 0.25  # minimum share of changes that have the size of one step

_MORE_THAN_A_CODE = 1.5


def _find_spikes(values: Floats, *, noise: float, factor: float) -> Bools:
    """Samples off the trend of their neighbours: single ones, and excursions of up to ten."""
    is_spike = zeros_like(values, dtype=bool)
    limit = max(factor * noise, _MORE_THAN_A_CODE * _usual_code(values))
    if limit <= 0:
        return is_spike
    jumps = []
    for part in sample_blocks(values.size, values, overlap=3):
        step = np.diff(values[part])
        bend = step[1:] - step[:-1]
        # a jump gives two second differences of opposite sign; a spike is two jumps
        product = bend[:-1] * bend[1:]
        jumps.append(np.flatnonzero(product < -(limit**2)) + 1 + part.start)
    jump = np.unique(np.concatenate(jumps))
    if not jump.size:
        return is_spike
    place = np.unique(np.concatenate([jump, jump + 1]))
    before, here, after = (take_samples(values, place + step) for step in (-1, 0, 1))
    off = np.minimum(np.abs(here - before), np.abs(here - after))
    opposite = (here - before) * (after - here) < -(limit**2)
    nearby = np.fmax(np.abs(after - before), _usual_step(values, place - 1, place))
    single = place[opposite & (off > limit) & (off > _SPIKE_TO_NEIGHBOURS * nearby)]
    is_spike[single] = True
    of_single = is_spike[jump] | is_spike[jump + 1]
    is_spike[_find_excursions(values, jump[~of_single], limit=limit)] = True
    return is_spike


_STEP_TO_STEPS = 5.0

_SHARE_OF_RANGE = 0.05

_STAYS = 0.5  # minimum fraction of the step that remains between the levels on its two sides

_OUTER = (0.01, 0.99)

_STIFFENS = 4.0  # greatest stiffness of a specimen over the mean of its range


def _find_lone_steps(
    values: Floats, beside: Floats, *, noise: float, noise_beside: Floats, factor: float
) -> Integers:
    """Lasting steps of a channel that do not occur in the channels beside it.

    Examples
    --------
    >>> time = np.arange(200.0)
    >>> tension = np.sin(time / 10) + np.where(time > 120, 3.0, 0.0)
    >>> position = np.sin(time / 10)[np.newaxis]
    >>> given = {"noise": 0.01, "noise_beside": np.array([0.01]), "factor": 12.0}
    >>> _find_lone_steps(tension, position, **given)
    array([120])
    >>> _find_lone_steps(tension, tension[np.newaxis], **given).size
    0
    >>> _find_lone_steps(tension, np.roll(tension, 1)[np.newaxis], **given).size
    0
    """
    reach = _usual_range(values)
    limit = max(factor * noise, _SHARE_OF_RANGE * reach)
    found = []
    for part in sample_blocks(values.size, values, overlap=1):
        some = _candidates(np.abs(np.diff(values[part])), limit) + part.start
        found.append(some[_stands_out(values, some, limit)])
    step: Integers = np.concatenate(found)
    change = take_samples(values, step + 1) - take_samples(values, step)
    step = step[_level_change(values, step) * np.sign(change) > _STAYS * np.abs(change)]
    for channel, its_noise in zip(beside, noise_beside, strict=True):
        its_limit = factor * float(its_noise)
        # channels that are read in turn show one step in neighbouring samples
        beside_it = np.clip(step + np.array([[-1], [0], [1]]), 0, values.size - 2)
        steps_too = np.stack([_stands_out(channel, at, its_limit) for at in beside_it]).any(axis=0)
        # what its noise would hide, or its motion explains, does not show that it stood still
        moved = np.abs(take_samples(channel, beside_it + 1) - take_samples(channel, beside_it))
        hides = np.fmax(its_limit, _STIFFENS * np.nan_to_num(np.median(moved, axis=0)))
        change = np.abs(take_samples(values, step + 1) - take_samples(values, step))
        step = step[~steps_too & (change * _usual_range(channel) > hides * reach)]
    return step


def _usual_range(values: Floats) -> float:
    """Range of a channel without its outer values."""
    seen = _sampled_windows(values)
    seen = seen[np.isfinite(seen)]
    return float(np.ptp(np.quantile(seen, _OUTER))) if seen.size else 0.0


def _candidates(step: Floats, limit: float) -> Integers:
    """Steps above five times the smallest of three beside them: few, even in coarse samples."""
    is_large = step > limit
    if step.size > 3 and is_large.any():
        # a lower bound of the third largest of eight; missing neighbours are ignored
        near = np.fmin(np.fmin(step[:-3], step[1:-2]), step[3:])
        is_large[2:-1] &= ~(step[2:-1] <= _STEP_TO_STEPS * near)
    return np.flatnonzero(is_large)


def _stands_out(values: Floats, step: Integers, limit: float) -> Bools:
    change = np.abs(take_samples(values, step + 1) - take_samples(values, step))
    return np.asarray(change > np.fmax(limit, _STEP_TO_STEPS * _usual_step(values, step, step)))


def _level_change(values: Floats, step: Integers) -> Floats:
    """Median of the samples after a step minus the median of those before it."""
    after = step[:, np.newaxis] + np.arange(1, _NEIGHBOURS + 1)
    before = after - _NEIGHBOURS
    last = values.size - 1
    levels = [np.nanmedian(take_samples(values, np.clip(rows, 0, last)), axis=1)
              for rows in (after, before)]  # fmt: skip
    return np.asarray(levels[0] - levels[1], dtype=np.float64)


_EDGES = 1 << 10  # run edges processed together: a quantised channel has one for every level

_SATURATED_SAMPLES = 5

_FEWEST_SATURATED = 3  # for a channel whose noise exceeds its quantisation step

_FEWEST_PAIRS = 3

_FINE = 4.0  # quantisation steps

_SATURATED_STEPS = 16.0

_NOISY = 0.75  # steps of noise that part the readings of a channel

_FEWEST_PILED, _TIMES_PILED = 10, 5  # readings at the end of a channel, and times those beside it

_MOVING_NOISE = 10.0

_MOVING_SHARE = 1e-3

_CODES_OF_RUN = 2.0

# relative positions in a run at which position is sampled; uneven, so that no cycle is missed
_LOOKS = np.sort(np.arange(16) * (np.sqrt(5) - 1) / 2 % 1)

_SLACK_SHARE = 0.02

_JUMP_SHARE = 0.1

_RISE_SHARE = 0.25

_RISE_NOISE = 20.0


@dataclass(frozen=True)
class _Runs:
    """Runs of equal values: first sample and the one after the last, shape (n_runs,) each."""

    start: Integers
    stop: Integers

    def where(self, keep: Bools) -> _Runs:
        """The selected runs."""
        return _Runs(self.start[keep], self.stop[keep])

    def mask(self, like: Floats) -> Bools:
        """True inside the runs, for each sample of a series of the same shape."""
        return interval_labels(like, self.start, self.stop, np.ones(self.start.size, dtype=bool))


def _constant_runs(values: Floats, minimum: int) -> _Runs:
    """Runs of at least ``minimum`` equal values."""
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
        return _Runs(place, place)
    level = take_samples(values, place * length)
    is_first = np.concatenate([[True], (np.diff(place) > 1) | (np.diff(level) != 0)])
    is_last = np.concatenate([is_first[1:], [True]])
    start, stop = place[is_first] * length, (place[is_last] + 1) * length
    start = start - _repeats(values, start, -np.arange(1, length))
    stop = stop + _repeats(values, stop - 1, np.arange(1, length))
    runs = _Runs(start, stop)
    return runs.where(stop - start >= minimum)


def _repeats(values: Floats, edge: Integers, reach: Integers) -> Integers:
    """Number of samples equal to each edge that follow it without a break along `reach`."""
    repeats = np.empty(edge.size, dtype=np.intp)
    for part in sample_blocks(edge.size, size=_EDGES):
        beyond = edge[part, np.newaxis] + reach
        inside = np.clip(beyond, 0, values.size - 1)
        same = take_samples(values, inside) == take_samples(values, edge[part])[:, np.newaxis]
        same &= inside == beyond
        repeats[part] = np.cumprod(same, axis=1).sum(axis=1)
    return repeats


def _moves(position: Floats, runs: _Runs) -> Bools:
    """Whether the crosshead moves in each run, shape (n_runs,)."""
    if not runs.start.size:
        return np.empty(0, dtype=bool)
    noise, _ = _noise_of(position, order=4)
    low, high = finite_extremes(position)
    reach = np.fmax(high - position[0], position[0] - low)
    tolerance = _MOVING_NOISE * noise + _MOVING_SHARE * reach
    return np.asarray(_range_beside(position, runs, 0) > tolerance)


def _range_beside(values: Floats, runs: _Runs, lengths: int) -> Floats:
    """Range of a series over each run, shifted by a number of run lengths, from a few samples."""
    length = (runs.stop - runs.start)[:, np.newaxis]
    places = runs.start[:, np.newaxis] + ((_LOOKS + lengths) * length).astype(np.int64)
    looks = take_samples(values, np.clip(places, 0, values.size - 1))
    return np.asarray(np.fmax.reduce(looks, axis=1) - np.fmin.reduce(looks, axis=1))


def _codes_near(values: Floats, level: Floats) -> Floats:
    """Steps of a channel near given readings: rounding to so many digits makes them coarser there.

    Examples
    --------
    >>> load = np.concatenate([np.arange(0.0, 10, 0.01), np.arange(10.0, 100, 0.1)])
    >>> _codes_near(load, np.array([5.0, 50.0])).round(3)
    array([0.01, 0.1 ])
    """
    _, step = _noise_of(values)
    windows = _sampled_windows(values)
    levels = np.unique(windows[np.isfinite(windows)])
    if levels.size <= 2 * _CODES_BESIDE:
        return np.full(level.shape, step)
    first = np.clip(
        np.searchsorted(levels, level) - _CODES_BESIDE, 0, levels.size - 2 * _CODES_BESIDE - 1
    )
    gaps = np.diff(levels[first[:, np.newaxis] + np.arange(2 * _CODES_BESIDE + 1)], axis=1)
    least = gaps.min(axis=1)
    # readings of a fine channel that happen to be apart are no multiples of one step
    codes = gaps / least[:, np.newaxis]
    is_code = (np.abs(codes - codes.round()) < _OF_A_CODE).all(axis=1)
    return np.where(is_code, least, step)


_CODES_BESIDE = 5  # values on each side of a reading

_OF_A_CODE = 0.01


def _outlasts_one_code(tension: Floats, position: Floats, runs: _Runs) -> Bools:
    """Whether the load should change by more than its converter step in each run.

    The expected change follows from the travel in the run and the load change over an equal travel
    beside it. A reading at the end of a ramp or at a rounded peak lasts long; the travel during it
    is then worth one converter step, for slopes that differ by less than a factor of two.
    """
    if not runs.start.size:
        return np.empty(0, dtype=bool)
    step = _codes_near(tension, take_samples(tension, runs.start))
    travel = _range_beside(position, runs, 0)
    expected = np.full(travel.size, np.nan)
    for way in (-1, 1):
        # a window with little movement shows only relaxation
        moved = _range_beside(position, runs, way)
        moves = moved >= np.fmax(travel, np.finfo(float).tiny)
        change = _range_beside(tension, runs, way)[moves] * (travel[moves] / moved[moves])
        expected[moves] = np.fmax(expected[moves], change)
    return np.asarray(~(expected <= _CODES_OF_RUN * step))


def _find_stuck(tension: Floats, position: Floats, *, samples: int) -> Bools:
    """Where a load channel repeats one value while the crosshead moves."""
    runs = _constant_runs(tension, samples)
    runs = runs.where(_moves(position, runs))
    runs = runs.where(_outlasts_one_code(tension, position, runs))
    if not runs.start.size:
        return runs.mask(tension)
    low, high = finite_extremes(tension)
    level = take_samples(tension, runs.start)
    into = np.abs(level - take_samples(tension, np.maximum(runs.start - 1, 0)))
    out = np.abs(level - take_samples(tension, np.minimum(runs.stop, tension.size - 1)))
    is_slack = (level <= low + _SLACK_SHARE * (high - low)) & (high > low)
    jumps = np.fmax(into, out) > _JUMP_SHARE * (high - low)
    return runs.where(~is_slack | jumps).mask(tension)


def _find_saturated(tension: Floats, position: Floats) -> Bools:
    """Where a load channel stays at its extreme value because it has reached its limit."""
    starts: list[Integers] = [np.empty(0, dtype=np.intp)]
    stops = list(starts)
    low, high = finite_extremes(tension)
    noise, step = _noise_of(tension)
    # a peak that rounding flattens to three readings has noise and curvature within its steps
    is_fine = noise > _FINE * step
    for level in (low, high):
        if level == low and (low == high or abs(low) <= _SLACK_SHARE * (high - low)):
            continue  # a slack specimen reads zero; a dead channel counts as stuck
        every = runs = _runs_at(tension, level)
        length = runs.stop - runs.start
        if length.sum() < _SATURATED_SAMPLES:
            continue
        fewest = _SATURATED_SAMPLES
        if noise > _NOISY * step and _is_piled_up(tension, level, runs, step):
            is_fine, fewest = True, 2
        elif is_fine:
            # pairs suffice if noise separates all readings except those at the channel limit
            beside = take_samples(tension, np.maximum(runs.start[length > 1] - 1, 0))
            is_noisy = beside.size > _FEWEST_PAIRS and np.nanstd(beside) > _FINE * step
            fewest = 2 if is_noisy else _FEWEST_SATURATED
        runs = runs.where(length >= fewest)
        if not runs.start.size:
            continue
        if not is_fine:
            runs = runs.where(_comes_from_afar(tension, runs))
        runs = runs.where(_moves(position, runs))
        runs = runs.where(_outlasts_one_code(tension, position, runs))
        if is_fine and runs.start.size:
            runs = every  # the channel limit is there, however short the run
        starts.append(runs.start)
        stops.append(runs.stop)
    return _Runs(np.sort(np.concatenate(starts)), np.sort(np.concatenate(stops))).mask(tension)


def _runs_at(values: Floats, level: float) -> _Runs:
    """Runs of a value, of any length."""
    places = np.concatenate(
        [
            part.start + np.flatnonzero(values[part] == level)
            for part in sample_blocks(values.size, values)
        ]
    )
    is_first = np.diff(places, prepend=-2) > 1
    is_last = np.append(is_first[1:], True)[: places.size]
    return _Runs(places[is_first], places[is_last] + 1)


def _is_piled_up(values: Floats, level: float, runs: _Runs, step: float) -> bool:
    """Whether a noisy channel has far more readings at its extreme value than in the next code.

    The tail of the noise has fewer readings towards the extreme, and a sine has at most 2.4 times
    as many readings in its last code as in the one before it.  A sine in step with the sampling may
    have more, but then the readings just before the extreme are equal.
    """
    n_there = int(np.sum(runs.stop - runs.start))
    before = take_samples(values, np.maximum(runs.start - 1, 0))
    if n_there < _FEWEST_PILED or not np.nanstd(before) > _NOISY * step:
        return False
    n_beside = sum(
        np.count_nonzero((np.abs(values[part] - level) < 1.5 * step) & (values[part] != level))
        for part in sample_blocks(values.size, values)
    )
    return n_there >= _FEWEST_PILED + _TIMES_PILED * int(n_beside)


_FEWEST_ENDS = 3  # runs, and readings in each

_PASSED_NOISE, _PASSED_SHARE = 3.0, 0.001  # least change of load: in noise, and share of its range

_GOES_ON = 0.15  # change of load in a run over that beside it; a third at the crest of a sine


def _find_end_of_position(position: Floats, tension: Floats) -> Bools:
    """Where position stays at its extreme value while the load goes on rising and comes back.

    In a dwell the load changes too, by relaxation or lag, but little compared with its change in an
    equal time before and after the dwell.
    """
    noise, _ = _noise_of(tension)
    low, high = finite_extremes(tension)
    least = _PASSED_NOISE * noise + _PASSED_SHARE * (high - low)
    starts: list[Integers] = [np.empty(0, dtype=np.intp)]
    stops = list(starts)
    for level, way in zip(finite_extremes(position), (-1, 1), strict=True):
        runs = _runs_at(position, level)
        length = runs.stop - runs.start
        runs = runs.where(
            (length >= _FEWEST_ENDS)
            & (runs.start >= length)
            & (runs.stop + length <= position.size)
        )
        if runs.start.size < _FEWEST_ENDS:
            continue
        half = (runs.stop - runs.start) // 2
        before, first, middle, last, after = (
            way * take_samples(tension, at)
            for at in (
                runs.start - half, runs.start, runs.start + half, runs.stop - 1,
                runs.stop - 1 + half,
            )
        )  # fmt: skip
        goes_on = middle - first > np.fmax(least, _GOES_ON * (first - before))
        comes_back = middle - last > np.fmax(least, _GOES_ON * (last - after))
        runs = runs.where(goes_on & comes_back)
        runs = runs.where(_outlasts_one_code(position, tension, runs))
        if runs.start.size >= _FEWEST_ENDS:
            starts.append(runs.start)
            stops.append(runs.stop)
    return _Runs(np.sort(np.concatenate(starts)), np.sort(np.concatenate(stops))).mask(position)


def _comes_from_afar(tension: Floats, runs: _Runs) -> Bools:
    """Whether the load beside a run changes by far more than at a rounded peak."""
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


_SETTLING = 0.2  # of the fewest readings of a channel that is stuck


def _without_spikes(load: Floats, flags: _Flags) -> Floats:
    """The load with NaN for its spikes, which are not a rise."""
    parts = sample_blocks(flags.size, flags)
    rows = [part.start + np.flatnonzero(flags[part] & Quality.SPIKE) for part in parts]
    spikes = np.concatenate(rows)
    if not spikes.size:
        return load
    kept = copied(load)
    kept[spikes] = np.nan
    return kept


def _find_stuck_position(position: Floats, tension: Sequence[Floats], *, samples: int) -> Bools:
    """Where position is constant although tension rises, which a hold does not cause."""
    runs = _constant_runs(position, samples)
    if not runs.start.size:
        return runs.mask(position)
    rises = np.zeros(runs.start.size, dtype=bool)
    # a load that was logged late still rises when the crosshead has stopped
    begin = runs.start + int(_SETTLING * samples)
    middle = (begin + runs.stop) // 2
    for load in tension:
        noise, _ = _noise_of(load)
        low, high = finite_extremes(load)
        enough = max(_RISE_SHARE * (high - low), _RISE_NOISE * noise)
        halves = (begin, middle), (middle, runs.stop - 1)
        most = [over_intervals(np.fmax, load, *half) for half in halves]
        least = [over_intervals(np.fmin, load, *half) for half in halves]
        rises |= most[1] - least[0] > enough
        rises |= np.fmax(*most) - take_samples(load, begin) > enough
        rises |= take_samples(load, runs.stop - 1) - np.fmin(*least) > enough
    return runs.where(rises).mask(position)


_STEPS_READ = 100_001


def _bridge_stamps(time: Floats, missing: Bools) -> Floats:
    """Fill missing time stamps: even steps between neighbours, the median step at the ends."""
    lost = np.concatenate(
        [part.start + np.flatnonzero(missing[part]) for part in sample_blocks(time.size, missing)]
    )
    if not lost.size:
        return time
    # rows before and after each run of missing stamps; -1 and n_samples at the ends of the record
    is_first = np.diff(lost, prepend=-2) > 1
    run = np.cumsum(is_first) - 1
    before = lost[is_first] - 1
    after = lost[np.append(is_first[1:], True)] + 1
    known = before >= 0, after < time.size
    left = take_samples(time, np.where(known[0], before, after))
    right = take_samples(time, np.where(known[1], after, before))
    step = np.where(known[0] & known[1], (right - left) / (after - before), _step(time))
    # before the first stamp, rows are counted back from it
    start = np.where(known[0], left, right - (after - before) * step)
    bridged = copied(time)
    bridged[lost] = start[run] + (lost - before[run]) * step[run]
    return bridged


_FEWEST_STAMPS = 100  # minimum number of stamps to recognise a steady clock from two step sizes

_FINE_STEP = 0.05  # of the sampling interval: finer rounding has no effect

# Any one or two steps of double length fit a steady clock; five lost rows in such places have a
# chance of 5!/5^5, one in twenty-six.
_FEWEST_OF_EITHER = 5


def _evenly_logged(time: Floats) -> tuple[Floats, float]:
    """Times of a steady clock stored with coarse resolution, and that resolution.

    Such stamps advance by two adjacent multiples of the resolution, each several times, and deviate
    from one line by no more than its rounding. Other times are returned unchanged, with 0.
    """
    steps = np.diff(time[:_STEPS_READ])
    if steps.size < _FEWEST_STAMPS:
        return time, 0.0
    low, high = float(steps.min()), float(steps.max())
    step = high - low
    if not (low > 0 and step > _FINE_STEP * high):
        return time, 0.0
    multiple = low / step
    is_either = np.minimum(steps - low, high - steps) < 1e-3 * step
    if abs(multiple - round(multiple)) > 1e-3 * multiple or not is_either.all():
        return time, 0.0
    n_long = int(np.count_nonzero(steps > (low + high) / 2))
    if min(n_long, steps.size - n_long) < _FEWEST_OF_EITHER:
        return time, 0.0
    middle, start = (time.size - 1) / 2, float(time[0])
    product = 0.0
    for part in sample_blocks(time.size, time):
        product += float((np.arange(part.start, part.stop) - middle) @ (time[part] - start))
    every = product * 12 / (float(time.size) * (float(time.size) ** 2 - 1))
    away = [np.inf, -np.inf]
    for part in sample_blocks(time.size, time):
        off = time[part] - start - every * np.arange(part.start, part.stop)
        away = [min(away[0], float(off.min())), max(away[1], float(off.max()))]
    if not away[1] - away[0] < (1 + _FINE_STEP) * step:
        return time, 0.0
    even = copied(time)
    for part in sample_blocks(time.size, even):
        even[part] = start + sum(away) / 2 + every * np.arange(part.start, part.stop)
    return even, step


def _step(time: Floats) -> float:
    """Median time step; 0 where no two consecutive samples have a stamp."""
    first = np.arange(0, time.size - 1, max(1, time.size // _STEPS_READ))
    steps = take_samples(time, first + 1) - take_samples(time, first)
    return finite_median(steps, otherwise=0.0)


def _updates(values: Floats) -> Integers | None:
    """Samples with a new reading in a channel that stores each reading several times.

    A converter slower than the log repeats each reading over the same number of rows. A coarse
    converter repeats one until the signal has moved by a step, so that few of its steps exceed one
    code. None if readings are not repeated regularly.

    Examples
    --------
    >>> signal = np.sin(0.02 * np.arange(600.0)) + 1e-4 * np.cos(7.0 * np.arange(600))
    >>> print(_updates(np.repeat(signal[::3], 3))[:4], _updates(np.round(signal, 1)))
    [ 3  6  9 12] None
    """
    looked = values[:_LOOKED_AT]
    place = _new_readings(looked)
    if place.size < _FEWEST_UPDATES:
        return None
    step = np.nan_to_num(np.abs(looked[place] - looked[place - 1]))
    least = np.quantile(step[step > 0], 0.01) if step.any() else np.inf
    # some signals are constant in places: repeats there do not count
    gaps = np.diff(place)[step[1:] > _SEVERAL_CODES * least]
    if gaps.size < _FEWEST_UPDATES:
        return None
    usual = int(np.median(gaps))
    if (
        usual < 2
        or np.mean(np.abs(gaps - usual) <= 1) < _REGULAR
        or np.mean(gaps == 1) > 1 - _REGULAR
    ):
        return None
    parts = sample_blocks(values.size, values, overlap=1)
    return np.concatenate([part.start + _new_readings(values[part]) for part in parts])


def _new_readings(values: Floats) -> Integers:
    """Samples that differ from the one before; a missing sample is not a new reading."""
    found: Integers = np.flatnonzero((values[1:] != values[:-1]) & np.isfinite(values[1:])) + 1
    return found


_LOOKED_AT = 1 << 18  # samples

_FEWEST_UPDATES = 50

_SEVERAL_CODES = 3.0

_REGULAR = 0.98


def _at_updates(record: Record) -> tuple[Record, Integers | None]:
    """The record at the rows with new readings of its slow channel, and these rows or None.

    Between them the channel lags, unless all channels have new readings in the same rows.
    """
    names = ["crosshead_position", *(f"tension.{i + 1}" for i in range(len(record.specimens)))]
    series = [record.crosshead_position, *record.tension]
    found = {
        name: rows
        for name, one in zip(names, series, strict=True)
        if (rows := _updates(one)) is not None
    }
    if not found:
        return record, None
    (slow, rows), *others = found.items()
    all_repeat = len(found) == len(names) and all(_alike(rows, one) for _, one in others)
    rows = _without_breaks(rows, record.n_samples)
    kept = []
    for name, one in zip(names, series, strict=True):
        own = found.get(name)
        if own is None or _alike(own, rows):
            kept.append(take_samples(one, rows))
        else:  # this channel lags in these rows too
            at = rows.astype(np.float64)
            known = (rows >= own[0]) & (rows <= own[-1])
            read = readings_between(at, own.astype(np.float64), take_samples(one, own))
            kept.append(np.where(known, read, np.nan))
    at_rows = _at_rows(record, rows)
    said = note(
        "rows-repeated" if all_repeat else "read-less-often",
        channel=slow,
        every=float(np.median(np.diff(rows))),
        interval=float(np.median(np.diff(at_rows["time"]))),
        n_rows=record.n_samples,
        step=_step(record.time),
    )
    at_rows |= {"crosshead_position": kept[0], "tension": np.stack(kept[1:])}
    return replace(record, notes=(*record.notes, said), **at_rows), rows


def _at_rows(record: Record, rows: Integers) -> dict[str, Any]:
    """The series of a record at some of its rows, except position and tension."""
    return {
        name: take_samples(one, rows)
        for name in (
            "time", "quality_flag", "crosshead_position_quality_flag", "measured_strain",
            "fill_pressure", "cycle_counter",
        )
        if (one := getattr(record, name)) is not None
    }  # fmt: skip


def _in_order(record: Record) -> tuple[Record, Integers | None]:
    """The record sorted by time without duplicate rows, and the rows kept or None.

    A logger that writes a buffer twice, or two buffers in the wrong order, leaves rows that are
    evenly spaced once sorted. Rows from a clock that slips back are not.
    """
    time = record.time
    parts = sample_blocks(time.size, time, overlap=1)
    stalls = any((np.diff(time[part]) <= 0).any() for part in parts)
    if not stalls or time.size > _MOST_SORTED or not np.isfinite(time).all():
        return record, None
    rows = np.argsort(time, kind="stable")
    place, load = take_samples(record.crosshead_position, rows), take_samples(record.tension, rows)
    both = np.vstack([time[rows], place, load])
    is_copy = np.all(np.diff(both, axis=1) == 0, axis=0)
    rows = rows[np.concatenate([[True], ~is_copy])]
    steps = np.diff(time[rows])
    if not steps.size or steps.min() < _EVEN * np.median(steps):
        return record, None
    n_moved = int(np.count_nonzero(np.diff(rows) < 0))
    said = note("rows-sorted", n_rows=time.size, n_twice=time.size - rows.size, n_moved=n_moved)
    at_rows = _at_rows(record, rows) | {
        "crosshead_position": take_samples(record.crosshead_position, rows),
        "tension": take_samples(record.tension, rows),
    }
    return replace(record, notes=(*record.notes, said), **at_rows), rows


_MOST_SORTED = 10_000_000  # rows, held in memory

_EVEN = 0.5  # minimum interval between sorted rows, as a fraction of the usual step


def _without_breaks(rows: Integers, n_samples: int) -> Integers:
    """Rows of all readings, including those equal to the one before.

    Examples
    --------
    >>> _without_breaks(np.array([3, 6, 12, 15]), 20).tolist()
    [0, 3, 6, 9, 12, 15, 18]
    """
    every = int(np.median(np.diff(rows)))
    ends = np.concatenate([[rows[0] % every], rows[rows > every]])
    n_between = np.maximum(np.rint(np.diff(ends) / every).astype(np.intp), 1)
    within = np.arange(n_between.sum()) - np.repeat(np.cumsum(n_between) - n_between, n_between)
    share = np.repeat(np.diff(ends) / n_between, n_between)
    found: Integers = np.repeat(ends[:-1], n_between) + (within * share).astype(np.intp)
    return np.unique(np.concatenate([found, np.arange(rows[-1], n_samples, every)]))


_NO_BEND = 0.02  # second differences below this fraction of the larger ones are a straight line

_STRAIGHT = 0.1  # minimum share of the moving rows that lie on straight lines

_AS_FAST = 0.5  # minimum step over the greatest step beside it; less is a turn or a stop

_LEVELS = 0.5  # minimum share of fifty levels of second difference; a coarse converter has fewer

_FEWEST_BENDS = 500

_BLOCK, _OF_BLOCK = 64, 4  # block length; rows required both on and off lines

_MOST_BLOCKS = 0.9  # the first ones may be on a straight ramp


def _is_interpolated(values: Floats) -> bool:
    """Whether a channel was linearly interpolated before it was logged.

    Between two readings the rows lie exactly on a line; at the readings the second difference shows
    their noise. White noise has few second differences this small, or many that are little larger.
    The ramps of a triangular wave are lines too, so rows at turns and stops are not considered.

    Examples
    --------
    >>> own = np.sin(0.1 * np.arange(1000)) + 0.01 * np.cos(700.0 * np.arange(1000) ** 2)
    >>> rows = np.interp(np.arange(0, 999, 0.3), np.arange(1000), own)
    >>> print(_is_interpolated(own), _is_interpolated(rows))
    False True
    """
    looked = values[:_LOOKED_AT]
    bend, step = np.abs(np.diff(looked, 2)), np.diff(looked)
    moves = (step[1:] != 0) & (step[:-1] != 0) & np.isfinite(bend)
    if np.count_nonzero(moves) < _FEWEST_BENDS:
        return False
    on_stroke = moves & ~_at_turns(step)
    if np.count_nonzero(on_stroke) < _FEWEST_BENDS:
        return False
    large = float(np.quantile(bend[on_stroke], 0.95))
    is_line = on_stroke & (bend <= _NO_BEND * large)
    is_bent = on_stroke & ~is_line
    n_lines = np.count_nonzero(is_line)
    if (
        n_lines < _STRAIGHT * np.count_nonzero(on_stroke)
        or np.count_nonzero(is_bent & (bend <= 4 * _NO_BEND * large)) > n_lines / 2
    ):
        return False
    n_levels = round(1 / _NO_BEND)
    levels = np.unique((bend[is_bent & (bend < large)] / large * n_levels).astype(int))
    if levels.size < _LEVELS * n_levels:
        return False
    whole = bend.size // _BLOCK * _BLOCK
    lines, bends = (one[:whole].reshape(-1, _BLOCK).sum(axis=1) for one in (is_line, is_bent))
    full = moves[:whole].reshape(-1, _BLOCK).all(axis=1)
    mixed = (lines >= _OF_BLOCK) & (bends >= _OF_BLOCK)
    return bool(full.any()) and bool(np.mean(mixed[full]) >= _MOST_BLOCKS)


def _at_turns(step: Floats) -> Bools:
    """Rows between two steps that lie within a step of a turn, stop or start of a wave.

    Examples
    --------
    >>> _at_turns(np.array([1.0, 1.0, 1.0, 1.0, 0.3, -1.0, -1.0, -1.0, -1.0])).astype(int)
    array([0, 0, 1, 1, 1, 1, 0, 0])
    """
    around = sliding_window_view(np.pad(step, 1, mode="edge"), 4)
    greatest = np.abs(around).max(axis=1)
    way = np.sign(around.sum(axis=1))[:, None]
    found: Bools = (around * way).min(axis=1) < _AS_FAST * greatest
    return found


def _interpolation_notes(record: Record, resampled: Sequence[str]) -> list[Note]:
    """Notes on the channels that were interpolated before they were logged."""
    series = {"crosshead_position": record.crosshead_position}
    series |= {f"tension.{index + 1}": one for index, one in enumerate(record.tension)}
    return [
        note("interpolated-by-logger", channel=name)
        for name, one in series.items()
        if name not in resampled and _is_interpolated(one)
    ]


def _alike(one: Integers, other: Integers) -> bool:
    """Whether the two sets of rows are nearly the same."""
    return np.intersect1d(one, other).size > _REGULAR * max(one.size, other.size)


_Flags = NDArray[np.uint16]

_NO_READING = np.uint16(Quality.MISSING | Quality.STUCK)

_TOLD_OTHERWISE = np.uint16(
    Quality.MISSING | Quality.STUCK | Quality.SATURATED | Quality.SPIKE | Quality.GAP
    | Quality.REPEATED_OR_BACKWARD_TIME
)  # fmt: skip

_IMPOSSIBLE_SHARE = 0.01  # a larger share of lengths at or below zero means that the datum is wrong


def flag_record(
    record: Record,
    *,
    settings: QualitySettings,
    resampled: Sequence[str] = (),
    verified: Mapping[tuple[int, int, int], tuple[float, float]] | None = None,
    notes: Sequence[Note] = (),
) -> Record:
    """Return the record with its flags set and explained in its notes."""
    for arrange in (_in_order, _at_updates):
        record, rows = arrange(record)
        if rows is not None and verified:
            rows = np.sort(rows)  # a piece with its own limits is contiguous
            verified = {
                (index, int(np.searchsorted(rows, start)), int(np.searchsorted(rows, stop))): limits
                for (index, start, stop), limits in verified.items()
            }
    record = replace(record, notes=(*record.notes, *_interpolation_notes(record, resampled)))
    position_flag: _Flags = zeros_like(record.time, dtype=np.uint16)
    tension_flag: _Flags = zeros_like(record.tension, dtype=np.uint16)
    position = record.crosshead_position
    no_stamp = _missing("time", record.time)
    time, clock_step = _evenly_logged(_bridge_stamps(record.time, no_stamp))
    record = replace(record, time=time)
    timing = _time_faults(
        record.time, gap_factor=settings.gap_factor, rate_tolerance=settings.rate_tolerance
    )
    _set(position_flag, no_stamp, Quality.MISSING)
    _set(position_flag, _missing("crosshead_position", position), Quality.MISSING)
    _set(position_flag, timing.gap, Quality.GAP)
    _set(position_flag, timing.backward, Quality.REPEATED_OR_BACKWARD_TIME)
    _set(position_flag, find_spikes(position, settings, record.time), Quality.SPIKE)
    if record.position_is_length:
        _set(position_flag, _no_length(position, position_flag), Quality.SPIKE)
    if "crosshead_position" in resampled:
        _set_all(position_flag, Quality.RESAMPLED)

    def flag_tension(index: int) -> None:
        load, flags = record.tension[index], tension_flag[index]
        _set(flags, _missing(f"tension of '{record.specimens[index]}'", load), Quality.MISSING)
        saturated = _find_saturated(load, position)
        stuck = _find_stuck(load, position, samples=settings.stuck_samples)
        _set(flags, stuck, Quality.STUCK)
        _set(flags, saturated, Quality.SATURATED, instead_of=Quality.STUCK)
        _set(flags, find_spikes(load, settings, record.time), Quality.SPIKE)
        if f"tension.{index + 1}" in resampled:
            _set_all(flags, Quality.RESAMPLED)

    run_blocks(flag_tension, range(len(record.specimens)))
    for (index, start, stop), (low, high) in (verified or {}).items():
        outside = _find_outside_range(record.tension[index, start:stop], low, high)
        _set(tension_flag[index, start:stop], outside, Quality.OUTSIDE_VERIFIED_RANGE)
    loads = [_without_spikes(*one) for one in zip(record.tension, tension_flag, strict=True)]
    stuck = _find_stuck_position(position, loads, samples=settings.stuck_samples)
    _set(position_flag, stuck, Quality.STUCK)
    flagged = replace(
        record, quality_flag=tension_flag, crosshead_position_quality_flag=position_flag
    )
    found = [*record.notes, *notes]
    first_lost = first_sample(no_stamp.__getitem__, 0, no_stamp.size, no_stamp)
    if first_lost is not None:
        n_lost = count_samples(no_stamp)
        hold_nothing = first_lost + n_lost == no_stamp.size and not any(
            np.isfinite(one[first_lost:]).any() for one in (position, *record.tension)
        )
        code = "rows-after-the-end" if hold_nothing else "rows-without-time"
        found.append(note(code, n_rows=n_lost, sample=first_lost + 1))
    _check_usable(flagged)
    if clock_step:
        found.append(note("clock-in-steps", step=clock_step, every=timing.step))
    if timing.n_uneven:
        found.append(
            note(
                "sampling-uneven",
                n_uneven=timing.n_uneven,
                n_steps=record.n_samples - 1,
                tolerance=settings.rate_tolerance,
                median=timing.step,
                shortest=timing.shortest,
                longest=timing.longest,
            )
        )
    found += [
        note("load-never-falls", name)
        for name, load in zip(record.specimens, record.tension, strict=True)
        if _never_falls(position, load)
    ]
    strains = None if record.measured_strain is None else copied(record.measured_strain)
    for name, strain in zip(record.specimens, () if strains is None else strains, strict=False):
        lost = find_spikes(strain, settings, record.time)
        if n_samples := count_samples(lost):
            strain[lost] = np.nan
            found.append(note("extensometer-drops-out", name, n_samples=n_samples))
        if n_samples := count_samples(_find_saturated(strain, position)):
            found.append(note("extensometer-ends", name, n_samples=n_samples))
    n_samples = max(
        (count_samples(_find_end_of_position(position, load)) for load in record.tension),
        default=0,
    )
    if n_samples:
        found.append(note("position-ends", n_samples=n_samples))
    flagged = replace(flagged, measured_strain=strains)
    found += _lone_steps(flagged, settings)
    found += notes_on_rows(flagged)
    return replace(flagged, notes=tuple(found))


_COMES_BACK, _FALLS = 0.5, 0.1  # of the ranges of position and tension

_POINTS = 4000


def _never_falls(position: Floats, load: Floats) -> bool:
    """Whether tension stays near its maximum so far while position falls by half its range."""
    some = slice(None, None, max(1, position.size // _POINTS))
    x, y = position[some], load[some]
    known = np.isfinite(x) & np.isfinite(y)
    x, y = x[known], y[known]
    if not x.size or not (np.ptp(x) > 0 and np.ptp(y) > 0):
        return False
    back, falls = (float((np.maximum.accumulate(one) - one).max() / np.ptp(one)) for one in (x, y))
    return back > _COMES_BACK and falls < _FALLS


def _set(flags: _Flags, where: Bools, mask: Quality, *, instead_of: int = 0) -> None:
    """Set a mask on some samples, and clear another mask there."""
    for part in sample_blocks(flags.size, flags, where):
        chosen = where[part]
        if chosen.any():
            flags[part][chosen] &= ~np.uint16(instead_of)
            flags[part][chosen] |= np.uint16(mask)


def _set_all(flags: _Flags, mask: Quality) -> None:
    for part in sample_blocks(flags.size, flags):
        flags[part] |= np.uint16(mask)


def _missing(name: str, values: Floats) -> Bools:
    missing = _find_missing(values)
    if count_samples(missing) == missing.size:
        raise DataError(
            f"{name} holds no number", found=f"{values.size} missing values", needed="a channel"
        )
    return missing


def find_spikes(values: Floats, settings: QualitySettings, time: Floats) -> Bools:
    """Spikes, except steps of the signal where the logging rate changes."""
    low, high = finite_extremes(values)
    # smaller deviations change no result, however little noise the channel has
    least = _SPIKE_OF_RANGE * (high - low) / settings.spike_factor
    noise = max(_noise_of(values)[0], least)
    found = _find_spikes(values, noise=noise, factor=settings.spike_factor)
    if count_samples(found):
        rows = np.flatnonzero(found)
        first = rows[np.diff(rows, prepend=-2) > 1]
        last = rows[np.diff(rows, append=values.size + 1) > 1]
        beside = first[:, np.newaxis] + np.arange(-2 * _NEIGHBOURS, 2 * _NEIGHBOURS + 1)
        stamps = take_samples(time, np.clip(beside, 0, time.size - 1))
        # the second shortest, since a clock repeats a stamp at times
        usual = np.sort(np.diff(stamps, axis=1), axis=1)[:, 1]
        out = take_samples(time, first) - take_samples(time, np.maximum(first - 1, 0))
        back = take_samples(time, np.minimum(last + 1, time.size - 1)) - take_samples(time, last)
        # a signal moves further in longer steps, on both sides of the rows; one is a gap
        is_slow = np.minimum(out, back) > _OTHER_RATE * usual
        is_code = _are_codes(values, first, last, most=_SMALL_CODE * (high - low))
        found[rows[np.repeat(is_slow | is_code, last + 1 - first)]] = False
    return found


def _are_codes(values: Floats, first: Integers, last: Integers, *, most: float) -> Bools:
    """Whether excursions are one step of the digits that a channel is written with around them.

    A log with four digits steps by 0.0001 below 1 and by 0.001 above.  Where nothing else moves,
    any small excursion is one step.

    Examples
    --------
    >>> written = np.round(2 + 0.0002 * np.arange(100), 3)
    >>> written[[40, 70]] += [0.001, 0.003]
    >>> print(_are_codes(written, np.array([40, 70]), np.array([40, 70]), most=0.01))
    [ True False]
    """
    size = np.abs(take_samples(values, first) - take_samples(values, np.maximum(first - 1, 0)))
    small = np.flatnonzero(size <= most)
    is_code = np.zeros(first.size, np.bool_)
    for part in sample_blocks(small.size, values, size=_AT_ONCE):
        here = small[part]
        begin, end = first[here, np.newaxis], last[here, np.newaxis]
        beside = begin + np.arange(-_AROUND, _AROUND + 1)
        steps = np.abs(np.diff(take_samples(values, np.clip(beside, 0, values.size - 1)), axis=1))
        is_own = (beside[:, 1:] >= begin) & (beside[:, :-1] <= end)
        steps[is_own | ~(steps > 0)] = np.inf
        is_code[here] = size[here] <= _MORE_THAN_A_CODE * steps.min(axis=1)
    return is_code


_SMALL_CODE = 2e-3  # of the range: a step of four digits is at most a thousandth of the reading

_AROUND = 64  # samples

_AT_ONCE = 4096  # excursions: a log of impulses has one in twenty samples


_SPIKE_OF_RANGE = 1e-4

_OTHER_RATE = 2.0


def _lone_steps(record: Record, settings: QualitySettings) -> list[Note]:
    """A note for each channel with a lasting step that the opposite channel does not show."""
    position, tension = record.crosshead_position[np.newaxis], record.tension
    of_time = record.crosshead_position_quality_flag
    channels = [("crosshead_position", "m", position[0], tension, of_time)]
    for name, load, of_load in zip(record.specimens, tension, record.quality_flag, strict=True):
        channels.append((f"tension of '{name}'", "N", load, position, of_load))
    noise = [_noise_of(channel[2])[0] for channel in channels]
    notes: list[Note | None] = [None] * len(channels)

    def look(index: int) -> None:
        name, unit, values, beside, flags = channels[index]
        step = _find_lone_steps(
            values, beside, noise=noise[index], factor=settings.spike_factor,
            noise_beside=np.array(noise[1:] if index == 0 else noise[:1]),
        )  # fmt: skip
        # steps beside a flagged sample are already reported
        told = take_samples(flags, step) | take_samples(flags, step + 1)
        told |= take_samples(of_time, step + 1)
        step = step[(told & _TOLD_OTHERWISE) == 0]
        if index:
            step = _without_friction(step, values, position[0], noise=noise[0])
        if step.size and step[0] == values.size - 2:  # nothing shows that it lasts
            low, high = values[-2:].tolist()
            notes[index] = note("last-reading-off", channel=name, low=low, high=high, unit=unit)
        elif step.size:
            first = int(step[0])
            low, high = values[first : first + 2].tolist()
            notes[index] = note(
                "channel-steps", channel=name, low=low, high=high, unit=unit, sample=first + 1,
                time=float(record.time[first]), n_more=step.size - 1,
                beside="tension does" if index == 0 else "the position does",
            )  # fmt: skip

    run_blocks(look, range(len(channels)))
    return [one for one in notes if one]


def _without_friction(
    step: Integers, tension: Floats, position: Floats, *, noise: float
) -> Integers:
    """Steps of tension without those of friction, which turn with the motion, at both of its turns.

    Examples
    --------
    A spring beside friction, which turns at samples 20, 40 and 60, and a step of the load:

    >>> place = np.arange(81)
    >>> length = np.abs((place / 20) % 2 - 1)
    >>> load = length + np.sign(np.diff(length, append=1.0)) + np.where(place > 50, 3, 0)
    >>> _without_friction(np.array([19, 39, 50, 59]), load, length, noise=0.0)
    array([50])
    """
    change = take_samples(tension, step + 1) - take_samples(tension, step)
    turns = np.zeros(step.size, dtype=bool)
    for reach in (_NEIGHBOURS, 4 * _NEIGHBOURS):
        ends = (step - reach, step, step + 1 + reach)
        before, at, after = (
            take_samples(position, np.clip(one, 0, position.size - 1)) for one in ends
        )
        told = np.minimum(np.abs(at - before), np.abs(after - at)) > _TURN_TOLD * noise
        turns |= told & ((at - before) * (after - at) < 0) & ((after - at) * change > 0)
    # at one turn alone it may be a slip at the greatest load
    both = change[turns].size and change[turns].min() < 0 < change[turns].max()
    # the log may end beside a turn
    return step[~turns & (step < tension.size - 1 - _NEIGHBOURS)] if both else step


_TURN_TOLD = 4.0  # standard deviations: where the crosshead stands, noise turns too


def _no_length(position: Floats, flags: _Flags) -> Bools:
    """Where a pin-to-pin length is zero or less in a sample without other flags."""
    not_positive: Bools = zeros_like(position, dtype=bool)
    for part in sample_blocks(position.size, position, flags, not_positive):
        not_positive[part] = (position[part] <= 0) & (flags[part] == 0)
    share = count_samples(not_positive) / position.size
    if share > _IMPOSSIBLE_SHARE:
        raise DataError(
            "a pin-to-pin length is not positive",
            found=f"{100 * share:.0f} % of the samples at or below 0 m, least "
            f"{finite_extremes(position)[0]:.4g} m",
            needed="the distance between the pins",
            hint='Set datum = "displacement", with a reference_length where one is known; of a '
            "displacement correct sign, zero or reference_length.",
        )
    return not_positive


def _any_reading(flags: _Flags) -> bool:
    """Whether a channel has any usable reading."""
    return any_sample(lambda part: (flags[part] & _NO_READING) == 0, flags.size, flags)


def _check_usable(record: Record) -> None:
    """Refuse a channel without information, whose flags would leave no sample."""
    position = record.crosshead_position
    if not _any_reading(record.crosshead_position_quality_flag):
        known = position[np.isfinite(position)]
        stuck = f" or stuck at {known.mean():.4g} m while tension changes" if known.size else ""
        raise DataError(
            "the crosshead position has no sample that can be used",
            found=f"{position.size} samples missing{stuck}",
            needed="a position that follows the crosshead",
            hint="Is it the right column, and was the transducer connected?",
        )
    for name, load, flags in zip(
        record.specimens, record.tension, record.quality_flag, strict=True
    ):
        if not count_samples(load):
            raise DataError(
                f"tension of '{name}' is zero throughout",
                found=f"{load.size} samples of 0 N",
                needed="a load cell that is connected, or a test without this specimen",
            )
        if not _any_reading(flags):
            raise DataError(
                f"tension of '{name}' has no sample that can be used",
                found=f"{load.size} samples missing or stuck at {np.nanmean(load):.4g} N",
                needed="a load that changes while the crosshead moves",
            )
