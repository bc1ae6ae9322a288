"""Intervals in which a test stands still: holds, rests, constant tension.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole,
   MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil, comb, sqrt

import numpy as np
from numpy.typing import ArrayLike

from reduction.record.arrays import as_same_shape
from reduction.record.errors import DataError
from reduction.record.measurement import Bools, Floats, Integers, read_only_arrays
from reduction.record.samples import (
    BLOCK,
    empty_like,
    finite_extremes,
    mean_of_rows,
    over_intervals,
    sample_blocks,
    take_samples,
)
from reduction.record.settings import PhaseSettings
from reduction.stages.approach import NEAR_SHARE, SLOW_SHARE, corner_in_noise, find_approach

_STRETCHES, _STRETCH_SAMPLES = 64, 1024

_ORDERS = (2, 4, 6)

_ROUNDING = 1e-9  # of a mean of many readings
_TINY = 1e-12  # least range, for a channel that is zero throughout

_NORMAL_MEDIAN = 0.67449  # median of |z| of a normal variable

_NOISE_WIDTHS = 12.0  # range that 10**7 normal samples rarely exceed, in standard deviations

_MOST_NOISE = 0.05  # of the range of a channel: more noise than this is checked again

_STRAIGHT_SHARE, _NORMAL_FIFTH = 0.2, 0.25335  # of second differences; |z| below which a fifth is

_QUANTA = 3.0  # range of a level between two steps, with noise below one step

_FLICKER_SHARE = 0.2  # steps undone by the next step; 0.1 at 10 samples a triangle's branch

_ONE_CODE = 1.5  # times the least step: larger steps are of two codes


def _places(n_samples: int) -> Integers:
    """At most 64 rows of consecutive samples, spread over the record."""
    length = min(_STRETCH_SAMPLES, n_samples)
    n_rows = min(_STRETCHES, n_samples // length)
    first = np.linspace(0, n_samples - length, n_rows).astype(np.intp)
    return first[:, None] + np.arange(length)


def _stretches(values: Floats) -> Floats:
    """Finite samples in at most 64 rows of consecutive ones, spread over the record."""
    rows: Floats = take_samples(values, _places(values.size))
    if np.isfinite(rows).all():
        return rows
    finite = _finite(values)
    return _stretches(finite) if finite.size else finite[None, :]


def _finite(values: Floats) -> Floats:
    """The finite samples of a series."""
    counts = [
        int(np.count_nonzero(np.isfinite(values[part])))
        for part in sample_blocks(values.size, values)
    ]
    finite = empty_like(values, shape=sum(counts))
    ends = np.cumsum(counts)
    for part, count, end in zip(
        sample_blocks(values.size, values, finite), counts, ends, strict=True
    ):
        block = values[part]
        finite[end - count : end] = block[np.isfinite(block)]
    return finite


def _noise_about_chords(values: Floats, time: Floats) -> float:
    """Standard deviation of the noise, from each reading and the chord of the two beside it.

    Differences of order two or more take movement for noise if the steps of time alternate, as in a
    log of the least and the greatest reading of every interval; a chord does not.

    Examples
    --------
    A ramp, read at steps of 0.1 and 0.9 s:

    >>> time = np.arange(1000) + np.tile([0.0, -0.9], 500)
    >>> values = time + np.random.default_rng(0).normal(0, 0.01, 1000)
    >>> print(round(_noise_about_chords(values, time), 2), estimate_noise(values)[0] > 0.5)
    0.01 True
    """
    places = _places(values.size)
    rows, clock = take_samples(values, places), take_samples(time, places)
    steps = np.diff(clock, axis=1)
    before, after = steps[:, :-1], steps[:, 1:]
    known = (before > 0) & (after > 0) & np.isfinite(np.diff(rows, n=2, axis=1))
    if not known.any():
        return np.inf
    near = (after / np.where(known, before + after, 1.0))[known]
    one, middle, other = (rows[:, i : rows.shape[1] - 2 + i][known] for i in range(3))
    away = (middle - near * one - (1 - near) * other) / np.sqrt(1 + near**2 + (1 - near) ** 2)
    return float(np.median(np.abs(away))) / _NORMAL_MEDIAN


def estimate_noise(values: ArrayLike, time: Floats | None = None) -> tuple[float, float]:
    r"""Standard deviation of the noise and size of the quantisation step of a channel.

    .. math:: s = \min_k \; \mathrm{median}|\Delta^k x| / (0.674 \sqrt{\tbinom{2k}{k}})

    Parameters
    ----------
    values : array_like, shape (n_samples,)
        Channel as logged; NaN is left out. [any unit]
    time : ndarray, shape (n_samples,), optional
        Time of the samples, for a log whose steps may alternate. [s]

    Returns
    -------
    noise : float
        Standard deviation. [unit of the channel]
    quantum : float
        Size of one step of the converter, 0 where the channel does not appear
        quantised. [unit of the channel]

    Raises
    ------
    DataError
        If fewer than 8 samples are finite.

    Notes
    -----
    Differences of order k = 2, 4 and 6 remove the movement: order 2 leaves only the
    corners of a triangular wave, order 6 next to nothing of a sine with 19
    samples a cycle.  All respond equally to white noise, so the least is taken.  At most 65,536
    samples are read, in 64 stretches spread over the record.

    A channel counts as quantised where more than a fifth of its steps are undone by the
    next step: the flicker of a level between two codes.  The quantum is the median such
    step.  A record that mostly moves has few of them, so its least steps are also tested alone.
    With noise far below the quantum the differences are mostly zero, and ``noise`` may be 0
    while ``quantum`` is not.

    Examples
    --------
    A ramp with noise of 0.5:

    >>> generator = np.random.default_rng(0)
    >>> noise, quantum = estimate_noise(np.arange(5000) + generator.normal(0, 0.5, 5000))
    >>> print(round(noise, 2), quantum)
    0.5 0.0
    """
    rows = _stretches(np.asarray(values, dtype=np.float64))
    if rows.size < 8:
        raise DataError(
            "too few samples to tell noise from movement",
            found=f"{rows.size} finite samples",
            needed="8 or more",
        )
    noise = min(
        float(np.median(np.abs(np.diff(rows, n=order, axis=1))))
        / (_NORMAL_MEDIAN * sqrt(comb(2 * order, order)))
        for order in _ORDERS
        if order < rows.shape[1]
    )
    steps = np.diff(rows, axis=1).ravel()
    steps = steps[steps != 0]
    size = np.abs(steps)
    if time is not None and rows.shape[1] > 2:
        about_chords = _noise_about_chords(np.asarray(values, dtype=np.float64), time)
        # readings of one code lie on their chord
        about_chords = max(about_chords, size.min(initial=np.inf) / sqrt(12))
        noise = about_chords if about_chords < noise / 2 else noise
    undone = np.abs(steps[1:] + steps[:-1]) < 0.05 * size[1:]
    is_least = size < _ONE_CODE * size.min(initial=np.inf)
    for compared in (np.ones_like(undone), is_least[1:] & is_least[:-1]):
        if compared.any() and undone[compared].mean() > _FLICKER_SHARE:
            return noise, float(np.median(size[1:][undone & compared]))
    return noise, 0.0


def noise_range(values: ArrayLike, time: Floats | None = None) -> float:
    """Range that noise alone may span in a channel: twelve deviations or three quanta.

    Parameters
    ----------
    values : array_like, shape (n_samples,)
        Channel as logged; NaN is left out. [any unit]
    time : ndarray, shape (n_samples,), optional
        Time of the samples, for a log whose steps may alternate. [s]

    Returns
    -------
    noise_range : float
        The greater of twelve standard deviations of the noise and three quanta; at least
        1e-9 of the greatest magnitude, so that rounding alone is not a movement, and 1e-12.
        [unit of the channel]

    Raises
    ------
    DataError
        If fewer than 8 samples are finite.

    Notes
    -----
    Ten million normal samples span eleven deviations; a level between two codes with noise
    below one of them flickers over two or three, cf. the 12-bit position of [1]_.

    In a wave of ramps and rests with a dozen readings a cycle most differences have a corner, and
    `estimate_noise` takes the wave for noise.  Where that noise is large, and a fifth of the second
    differences give less than half of it, these are taken as the straight parts.

    Examples
    --------
    >>> print(round(noise_range(np.random.default_rng(0).normal(0, 0.5, 5000)), 1))
    6.0
    """
    values = np.asarray(values, dtype=np.float64)
    noise, quantum = estimate_noise(values, time)
    rows = _stretches(values)
    if _NOISE_WIDTHS * noise > _MOST_NOISE * float(np.ptp(rows)):
        bends = np.abs(np.diff(rows, n=2, axis=1))
        least = float(np.quantile(bends, _STRAIGHT_SHARE)) / (_NORMAL_FIFTH * sqrt(comb(4, 2)))
        if least < noise / 2:
            noise = min(noise, max(least, quantum / 2))
    floor = max(1e-9 * float(np.nanmax(np.abs(rows))), _TINY)
    return max(_NOISE_WIDTHS * noise, _QUANTA * quantum, floor)


_AWAY = 4.0  # tolerances


def _block_extremes(position: Floats, length: int) -> tuple[Floats, Floats]:
    """Return the least and greatest position of each block of samples.

    Notes
    -----
    Blocks are counted from the first sample of the record, so that reading a record in
    pieces of whole blocks gives the same result.

    Examples
    --------
    >>> _block_extremes(np.array([1.0, 2, 3, 5, np.nan]), 2)
    (array([ 1., 3., inf]), array([ 2., 5., -inf]))
    """
    n_blocks = -(-position.size // length)
    least = empty_like(position, shape=n_blocks)
    greatest = empty_like(position, shape=n_blocks)
    step = length * max(BLOCK // length, 1)
    for part in sample_blocks(position.size, position, least, greatest, size=step):
        samples = position[part]
        start, whole = part.start // length, samples.size // length
        rows = samples[: whole * length].reshape(-1, length)
        low, high = least[start : start + whole + 1], greatest[start : start + whole + 1]
        np.min(rows, axis=1, out=low[:whole])
        np.max(rows, axis=1, out=high[:whole])
        if samples.size > whole * length:  # the last block has the remaining samples
            low[whole], high[whole] = (
                samples[whole * length :].min(),
                samples[whole * length :].max(),
            )
        for block in np.flatnonzero(np.isnan(low)):
            finite = samples[block * length : (block + 1) * length]
            finite = finite[np.isfinite(finite)]
            low[block] = finite.min(initial=np.inf)
            high[block] = finite.max(initial=-np.inf)
    return least, greatest


def _still_runs(
    least: Floats, greatest: Floats, window: int, tolerance: float
) -> tuple[Integers, Integers]:
    """First and last block of each run in which every window of blocks stays in tolerance."""
    n_windows = least.size - window + 1
    is_still = np.zeros(n_windows + 2, dtype=bool)
    for part in sample_blocks(n_windows, least, greatest):
        low, high = (one[part.start : part.stop + window - 1] for one in (least, greatest))
        covered = 1
        while covered < window:  # windows of twice the width from two of the width before
            step = min(covered, window - covered)
            low = np.minimum(low[: low.size - step], low[step:])
            high = np.maximum(high[: high.size - step], high[step:])
            covered += step
        is_still[1 + part.start : 1 + part.stop] = high - low <= tolerance
    edges = np.flatnonzero(is_still[1:] != is_still[:-1])
    first, last = edges[::2], edges[1::2] - 1 + window - 1
    last[:-1] = np.minimum(last[:-1], first[1:] - 1)
    is_whole = last - first + 1 >= window  # others are pieces of a slow movement
    return first[is_whole], last[is_whole]


def _extremes_between(
    least: Floats, greatest: Floats, first: Integers, last: Integers
) -> tuple[Floats, Floats]:
    """Least and greatest position of each run of blocks, both ends inside."""
    low = over_intervals(np.minimum, least, first, last + 1)
    high = over_intervals(np.maximum, greatest, first, last + 1)
    return low, high


def _range(least: Floats, greatest: Floats) -> float:
    every = np.array([0]), np.array([least.size])
    low, high = (
        over_intervals(np.minimum, least, *every),
        over_intervals(np.maximum, greatest, *every),
    )
    return float(high[0] - low[0])


def _outlasts_its_approach(
    least: Floats, greatest: Floats, first: Integers, last: Integers, tolerance: float
) -> Bools:
    """Whether the crosshead comes or goes faster than it stays."""
    if first.size == 0 or _range(least, greatest) <= 2 * _AWAY * tolerance:
        return np.ones(first.size, dtype=bool)  # the whole record is within reach
    length = last - first + 1
    low, high = _extremes_between(least, greatest, first, last)
    middle = (low + high) / 2
    low, high = _extremes_between(
        least,
        greatest,
        np.maximum(first - length, 0),
        np.minimum(last + length, least.size - 1),
    )
    return np.asarray(np.maximum(high - middle, middle - low) > _AWAY * tolerance)


def _still_blocks(
    least: Floats, greatest: Floats, *, window: int, tolerance: float
) -> tuple[Integers, Integers]:
    """First and last block of each standstill.

    Notes
    -----
    A run of windows within the tolerance is a standstill where it stays within twice the
    tolerance as a whole: at each end a window may hold the beginning of a move.  A run that
    goes further is a slow movement, with or without holds in it, and is searched
    again with windows of twice the width, and so on.

    Examples
    --------
    Rising, standing for four blocks, rising:

    >>> least = np.array([0.0, 1, 2, 2, 2, 2, 3, 4, 5])
    >>> _still_blocks(least, least + 0.1, window=3, tolerance=0.5)
    (array([2]), array([5]))
    """
    found = []
    work = [(0, least.size, window)]
    while work:
        begin, end, width = work.pop()
        if end - begin < width:
            continue
        firsts, lasts = _still_runs(least[begin:end], greatest[begin:end], width, tolerance)
        if firsts.size == 0:
            continue
        firsts, lasts = begin + firsts, begin + lasts
        low, high = _extremes_between(least, greatest, firsts, lasts)
        # a window at each end may hold the beginning of a move, one up and one down
        within = high - low <= 2 * tolerance
        # blocks without a sample are within any tolerance, and show nothing
        found.append(np.column_stack([firsts, lasts])[within & (low <= high)])
        work += [
            (int(first), int(last) + 1, 2 * width)
            for first, last in zip(firsts[~within], lasts[~within], strict=True)
        ]
    both = np.concatenate([np.empty((0, 2), dtype=np.intp), *found])
    first, last = both[np.argsort(both[:, 0])].T.copy()
    return first, last


def _levels_between(
    values: Floats, found: Sequence[tuple[int, int]], span: slice, *, fewest: int, tolerance: float
) -> list[tuple[int, int]]:
    """First and last samples of levels before, between and after the standstills of a span.

    Two holds a small step apart are one run of `_still_intervals` if the ramp between them is slow,
    and its mean is near the longer one.

    Examples
    --------
    >>> values = np.repeat([0.0, 1.0], [40, 80])
    >>> _levels_between(values, [(40, 119)], slice(0, 120), fewest=8, tolerance=0.9)
    [(0, 39)]
    """
    ends = np.array(sorted(found), dtype=np.intp).reshape(-1, 2)
    first, last = np.r_[span.start, ends[:, 1] + 1], np.r_[ends[:, 0] - 1, span.stop - 1]
    is_long = last - first + 1 >= fewest
    first, last = first[is_long], last[is_long]
    level = _levels(values, first, last, tolerance)
    between = []
    for i in np.flatnonzero(np.isfinite(level)):
        near = np.abs(values[first[i] : last[i] + 1] - level[i]) <= tolerance / 4
        between.append((int(first[i] + np.argmax(near)), int(last[i] - np.argmax(near[::-1]))))
    return between


def _levels(values: Floats, first: Integers, last: Integers, tolerance: float) -> Floats:
    """Level of half of the readings of each interval, or NaN: the others are its edges.

    Examples
    --------
    A rest before a slow ramp, and the turn of a slow cycle of ramps:

    >>> noise = np.random.default_rng(0).normal(0, 1.0, 100)
    >>> clock, whole = np.arange(100.0), (np.array([0]), np.array([99]))
    >>> ramp = noise + 0.2 * np.clip(clock - 60, 0, None)
    >>> print(_levels(ramp, *whole, tolerance=12.0).round(1))
    [-0.2]
    >>> print(_levels(noise + 0.2 * np.abs(clock - 50), *whole, tolerance=12.0))
    [nan]
    """
    level = np.full(first.size, np.nan)
    for index, (one, end) in enumerate(zip(first.tolist(), last.tolist(), strict=True)):
        stride = max((end + 1 - one) // _LEVEL_SAMPLES, 1)
        readings = take_samples(values, np.arange(one, end + 1, stride))
        readings = np.sort(readings[np.isfinite(readings)])
        if readings.size < FEWEST_SAMPLES:
            continue
        half = readings.size // 2
        width = readings[half:] - readings[: readings.size - half]
        nearest = int(np.argmin(width))
        if width[nearest] <= _LEVEL_SHARE * tolerance:
            level[index] = readings[nearest : nearest + half + 1].mean()
    return level


def _without_ramps(
    values: Floats, first: Integers, last: Integers, level: Floats, tolerance: float
) -> tuple[Integers, Integers]:
    """Intervals of known level without the beginning of the ramp at either end.

    A slow ramp takes long to leave the noise; the last reading on the near side of the level is
    where it begins.

    Examples
    --------
    >>> values = np.array([0.1, -0.1, 0.2, -0.2, 0.5, 1.0, 1.5])
    >>> whole = np.array([0]), np.array([6])
    >>> ends = _without_ramps(values, *whole, level=np.array([0.0]), tolerance=3.0)
    >>> print([int(one[0]) for one in ends])
    [0, 3]
    """
    for i in np.flatnonzero(np.isfinite(level)):
        away = values[first[i] : last[i] + 1] - level[i]
        for edge, step in ((first, 1), (last, -1)):
            known = away[::step][np.isfinite(away[::step])]
            ramp = known[: max(away.size // 8, 1)].mean()
            if abs(ramp) > tolerance / 8:
                edge[i] += step * int(np.argmax(away[::step] * ramp <= 0))
    return first, last


_LEVEL_SAMPLES = 4096

# of the tolerance, for the half of the readings nearest to each other: noise has 0.11, a ramp 0.5
_LEVEL_SHARE = 0.22


FEWEST_SAMPLES = 4  # two equal samples may be the two sides of a peak

_STEPS_READ = 100_001


def median_step(time: Floats) -> float:
    """Return the median time step, of at most 100,001 steps that advance.

    Parameters
    ----------
    time : ndarray, shape (n_samples,)
        Elapsed time. [s]

    Returns
    -------
    median_step : float
        Greater than zero. [s]

    Raises
    ------
    DataError
        If time does not advance.

    Examples
    --------
    >>> median_step(np.array([0.0, 0.1, 0.2, 0.2, 0.3, 60.0]))
    0.1
    """
    first = np.arange(0, time.size - 1, max(1, time.size // _STEPS_READ))
    steps = take_samples(time, first + 1) - take_samples(time, first)
    later = steps[steps > 0]
    if later.size == 0:
        if (steps < 0).any():
            raise DataError(
                "time falls from row to row",
                found=f"{time[0]:.6g} s in the first row, {time[-1]:.6g} s in the last",
                needed="the earliest row first",
                hint="The log was written newest first: reverse its rows",
            )
        raise DataError("time does not advance", needed="at least one later sample")
    return float(np.median(later))


def _reach(values: Floats, edge: Integers, centre: Floats, half: Floats, step: int) -> Integers:
    """Samples beyond each edge, at most ``abs(step)``, that stay near the centre."""
    offsets = np.sign(step) * np.arange(1, abs(step) + 1)
    index = edge[:, None] + offsets
    inside = (index >= 0) & (index < values.size)
    value = take_samples(values, np.clip(index, 0, values.size - 1))
    # a missing sample is not a movement
    near = inside & ~(np.abs(value - centre[:, None]) > half[:, None])
    return np.where(near.all(axis=1), abs(step), np.argmin(near, axis=1))


def _interval_means(values: Floats, first: Integers, last: Integers) -> Floats:
    """Mean of the finite values of each interval.

    Examples
    --------
    >>> values = np.array([1.0, 3.0, np.nan, 5.0])
    >>> print(_interval_means(values, np.array([0, 2]), np.array([1, 3])))
    [2. 5.]
    """
    if first.size == 0:
        return np.empty(0)
    mean = np.asarray(over_intervals(np.add, values, first, last + 1) / (last - first + 1))
    for i in np.flatnonzero(np.isnan(mean)):
        mean[i] = _mean_of_finite(values[first[i] : last[i] + 1])
    return mean


def _mean_of_finite(values: Floats) -> float:
    total, count = 0.0, 0
    for part in sample_blocks(values.size, values):
        finite = values[part][np.isfinite(values[part])]
        total, count = total + float(finite.sum()), count + finite.size
    return total / count if count else float("nan")


def _fewest_of(time: Floats, minimum_duration: float) -> int:
    """Number of samples in the shortest standstill."""
    return max(ceil(minimum_duration / median_step(time) - 1e-6) + 1, FEWEST_SAMPLES)


def _still_intervals(
    time: Floats,
    values: Floats,
    *,
    tolerance: float,
    minimum_duration: float,
    is_noise: bool = True,
) -> tuple[Integers, Integers]:
    """First and last sample of every interval in which a channel stands still.

    Notes
    -----
    The record is read in blocks of a quarter of the shortest interval (`_still_blocks`).
    Edges are found to the sample: there the channel comes and goes nearer to the mean than
    half the tolerance.  Missing samples do not end an interval and are not edges of one.

    The turn of a slow cycle also stays within the tolerance for a while, but takes as
    long again to get away from there.  An interval is kept where the channel is four
    tolerances away within as long as it lasts, before or after it, where the record never goes
    that far, or, if the tolerance ``is_noise``, where half of its readings are at one level (a rest
    before a slow pull).

    Examples
    --------
    >>> time = np.arange(0, 130.0)
    >>> values = np.interp(time, [0, 60, 70, 130], [0, 0, 1, 1])
    >>> first, last = _still_intervals(time, values, tolerance=0.01, minimum_duration=3.0)
    >>> print(first, last)
    [ 0 70] [ 60 129]
    """
    fewest = _fewest_of(time, minimum_duration)
    length = max(fewest // 4, 1)
    # a standstill of the fewest samples holds this many whole blocks, wherever it begins
    window = max((fewest - length + 1) // length, 1)
    least, greatest = _block_extremes(values, length)
    first_block, last_block = _still_blocks(least, greatest, window=window, tolerance=tolerance)

    stays = _outlasts_its_approach(least, greatest, first_block, last_block, tolerance)
    first = first_block * length
    last = np.minimum((last_block + 1) * length, values.size) - 1
    level = np.full(first.size, np.nan)
    if is_noise:
        level[~stays] = _levels(values, first[~stays], last[~stays], tolerance)
        stays |= np.isfinite(level)
    level = level[stays]
    first_block, last_block, first, last = (
        one[stays] for one in (first_block, last_block, first, last)
    )
    centre = _interval_means(values, first, last)
    # the mean of equal readings is off by its rounding
    half = np.maximum(tolerance / 2, _ROUNDING * np.abs(centre))
    for block, step in ((first_block, 1), (last_block, -1)):  # a block that moves is not an edge
        outside = np.ones(centre.size, dtype=bool)
        while outside.any():
            outside = (greatest[block] - centre > half) | (centre - least[block] > half)
            outside &= first_block < last_block
            block[outside] += step
    first = first_block * length
    last = np.minimum((last_block + 1) * length, values.size) - 1
    first -= _reach(values, first, centre, half, -length)
    last += _reach(values, last, centre, half, length)
    last[:-1] = np.minimum(last[:-1], first[1:] - 1)

    for edge, step in ((first, 1), (last, -1)):  # an edge is a sample that is not missing
        for i in np.flatnonzero(np.isnan(take_samples(values, edge))):
            edge[i] += step * np.argmax(np.isfinite(values[first[i] : last[i] + 1][::step]))
    first, last = _without_ramps(values, first, last, level, tolerance)

    duration = take_samples(time, last) - take_samples(time, first)
    long_enough = (duration >= minimum_duration * (1 - 1e-6)) & (last - first + 1 >= FEWEST_SAMPLES)
    return first[long_enough], last[long_enough]


def _from_approaches(
    time: Floats, values: Floats, first: Integers, last: Integers, *, noise: float
) -> tuple[Integers, Integers]:
    """Standstills, each from the end of its approach until the channel leaves.

    The first sample of the next ramp may lie within the tolerance.  Backward in time the departure
    is an approach.

    Examples
    --------
    A pull of 10 s to 1 m, with half a centimetre left to settle:

    >>> time = np.arange(0.0, 60.0)
    >>> values = np.where(time < 10, 0.0995 * time, 1 - 0.005 * np.exp(-(time - 10) / 3))
    >>> print(_from_approaches(time, values, np.array([24]), np.array([59]), noise=1e-5))
    (array([10]), array([59]))

    A hold left by a ramp of 0.2 m a second, whose first sample is 5 mm away:

    >>> values = np.clip(0.1 * time, 0, 1) - np.clip(0.2 * (time - 39.975), 0, None)
    >>> print(_from_approaches(time, values, np.array([10]), np.array([40]), noise=1e-5))
    (array([10]), array([39]))

    A broad step of a position that goes on in steps is all approach and departure:

    >>> down, on = np.linspace(89, 84.2, 108), np.linspace(83.5, 75, 560)
    >>> values = np.round(np.r_[down, np.full(10, 84.0), np.full(10, 83.8), on], 1)
    >>> time = 0.2 * np.arange(values.size)
    >>> print(_from_approaches(time, values, np.array([108]), np.array([127]), noise=0.3))
    (array([], dtype=int64), array([], dtype=int64))
    """
    starts, stops = first.copy(), last.copy()
    for index, (one, end) in enumerate(zip(first.tolist(), last.tolist(), strict=True)):
        begin = int(last[index - 1]) + 1 if index else 0
        approach = find_approach(time, values, begin=begin, first=one, last=end, noise_range=noise)
        if approach is None:
            # the ramp may begin before the end of the standstill before it
            since = (int(first[index - 1]) + begin) // 2 if index else 0
            corner = corner_in_noise(
                time, values, begin=since, first=one, last=end, noise_range=noise
            )
            starts[index] = end + 1 if corner is None else max(corner, begin)  # a ramp has none
        else:
            starts[index] = approach.end
        stop = int(first[index + 1]) if index + 1 < first.size else values.size
        left = find_approach(
            -time[one:stop][::-1], values[one:stop][::-1],
            begin=0, first=stop - 1 - end, last=stop - 1 - one, noise_range=noise,
        )  # fmt: skip
        if left is not None:
            stops[index] = _without_first_step(values, one, min(stop - 1 - left.end, end), noise)
    stands = starts <= stops  # else approach and departure overlap: it is all motion
    return starts[stands], stops[stands]


def _without_first_step(values: Floats, first: int, last: int, noise: float) -> int:
    """Last sample of a standstill, without a sample in which the departure has begun.

    A fraction of a log step appears slow: the sample differs from those before by more than noise,
    towards the next one.
    """
    before = values[max(first, last - _SAMPLES_BEFORE) : last]
    if last + 1 >= values.size or not np.isfinite(before).any():
        return last
    off = values[last : last + 2] - np.nanmedian(before)
    leaves = abs(off[0]) > _FROM_NOISE * noise and off[0] * (off[1] - off[0]) > 0
    return last - 1 if leaves else last


_SAMPLES_BEFORE = 8

_FROM_NOISE = 0.25  # of the range of the noise: three of its deviations


def _held_intervals(
    time: Floats,
    values: Floats,
    *,
    tolerance: float,
    noise: float,
    minimum_duration: float,
    hunts: bool = False,
) -> tuple[Integers, Integers]:
    """First and last sample of every hold of a record that consists of ramps and holds.

    Notes
    -----
    A channel that is held may settle, creep and drift by more than its noise.  Intervals are
    searched with a tolerance of 2 % of the range of the record.  One is a hold where it
    stays within 2 % of the stroke of its own approach and, once it is slow, stays slow
    (`_stays_slow`).  The others are searched again with a quarter of the tolerance, down to that
    of the noise.  A load controller ``hunts`` about its level during the whole hold, by more than
    2 % of a small step and as fast as a slow ramp: its tension stays within half of the stroke.

    Examples
    --------
    A pull to 1 m, followed by a drift of 6 mm:

    >>> time = np.arange(0.0, 200.0)
    >>> values = np.interp(time, [0, 20, 30, 200], [0, 0, 1, 1.006])
    >>> found = _held_intervals(time, values, tolerance=1e-5, noise=1e-5, minimum_duration=3.0)
    >>> print(found)
    (array([ 0, 30]), array([ 20, 199]))
    """
    clock, series, index = _evenly(time, values, minimum_duration)
    low, high = finite_extremes(series)
    tolerance = max(tolerance, _FINEST_SHARE * (high - low))
    fewest = _fewest_of(clock, minimum_duration)
    found: list[tuple[int, int]] = []
    work = [(0, series.size, max(tolerance, NEAR_SHARE * (high - low)), 0)]
    while work:
        begin, stop, width, origin = work.pop()
        if stop - begin < FEWEST_SAMPLES:
            continue
        firsts, lasts = _still_intervals(
            clock[begin:stop], series[begin:stop],
            tolerance=width, minimum_duration=minimum_duration, is_noise=width <= tolerance,
        )  # fmt: skip
        for first, last in zip((begin + firsts).tolist(), (begin + lasts).tolist(), strict=True):
            # the approach to a hold begins at the one before, even outside the part searched
            if width <= tolerance or any(
                _stays_slow(clock, series, since, first, last, noise=noise, hunts=hunts)
                for since in {begin, origin}
            ):
                found.append((first, last))
            else:
                work.append((first, last + 1, max(tolerance, width / 4), origin))
            origin = last
        if width <= tolerance:
            inside = [one for one in found if begin <= one[0] < stop]
            found += _levels_between(
                series, inside, slice(begin, stop), fewest=2 * fewest, tolerance=tolerance
            )
        else:  # between them are parts that are one hold at this width, or none
            starts, stops = [begin, *(begin + lasts + 1).tolist()], [*(begin + firsts), stop]
            work += [
                (start, int(end), max(tolerance, width / 4), start)
                for start, end in zip(starts, stops, strict=True)
            ]
    both = np.array(sorted(found), dtype=np.intp).reshape(-1, 2)
    return index[both[:, 0]], index[both[:, 1]]


def _evenly(
    time: Floats, values: Floats, minimum_duration: float
) -> tuple[Floats, Floats, Integers]:
    """A series at even steps, with the sample of each; unchanged if its steps are nearly even.

    A log that is dense in its ramp and sparse in its hold has few samples in the duration of a
    hold when this is counted in steps of the ramp.
    """
    step = median_step(time)
    duration = float(time[-1] - time[0])
    if duration <= _UNEVEN * step * time.size:
        return time, values, np.arange(time.size)
    known = np.flatnonzero(np.isfinite(values))
    advances = np.diff(time[known], prepend=-np.inf) > 0
    known = known[advances]
    clock = np.arange(time[0], time[-1], max(step, minimum_duration / _STEPS_OF_SHORTEST))
    at = np.minimum(np.searchsorted(time, clock), time.size - 1)
    return clock, np.interp(clock, time[known], values[known]), at


_HUNTED_SHARE = 0.5  # of the stroke of an approach

_LASTS = 0.3  # of the time of an approach

_FINEST_SHARE = 1e-6  # of the range of the record: an exact encoder shows any drift

_UNEVEN = 1.5  # mean step over median step

_STEPS_OF_SHORTEST = 8


def _stays_slow(
    time: Floats,
    values: Floats,
    begin: int,
    first: int,
    last: int,
    *,
    noise: float,
    hunts: bool,
) -> bool:
    """Whether an interval stays near the end of its approach and never moves fast once slow.

    A channel that ``hunts`` only has to stay nearer to its level than to that it came from.

    The turn of a sine is also slow and near, but for less than a fifth of the time of its approach.
    """
    approach = find_approach(time, values, begin=begin, first=first, last=last, noise_range=noise)
    if approach is None:
        return False
    held = values[approach.end : last + 1]
    step = median_step(time)
    length = max(ceil(noise / (2 * SLOW_SHARE * approach.rate * step)), 1)
    if not hunts:
        least, greatest = _block_extremes(held, length)
        if least.size > 1:
            spread = np.maximum(greatest[1:], greatest[:-1]) - np.minimum(least[1:], least[:-1])
            slow = np.flatnonzero(spread <= 2 * SLOW_SHARE * approach.rate * length * step + noise)
            if slow.size == 0 or slow[-1] - slow[0] >= slow.size:
                return False
            held = held[: (int(slow[-1]) + 2) * length]  # the departure may be within the tolerance
    lasts = time[approach.end + held.size - 1] - time[approach.end]
    if lasts < _LASTS * approach.stroke / approach.rate:
        return False
    low, high = finite_extremes(held)
    share, own = (_HUNTED_SHARE, 0.0) if hunts else (NEAR_SHARE, noise)
    return high - low <= share * approach.stroke + own


_WINDOW, _WIDER = 64, 3.0  # samples; range of normal noise in a record over that in a window


def _dither_range(values: Floats) -> float:
    """Range that the noise of a channel driven by a controller may span, from its actual range.

    A servo valve that dithers faster than the log is sampled has the differences of large noise and
    a narrow range.  For normal noise, and for larger movements, this exceeds the range of noise.

    Examples
    --------
    >>> dither = 240 * np.sin(4.08 * np.arange(2000))
    >>> print(round(noise_range(dither)), round(_dither_range(dither)))
    3182 1440
    """
    windows = values[: values.size // _WINDOW * _WINDOW].reshape(-1, _WINDOW)
    windows = windows[np.isfinite(windows).all(axis=1)]
    if not windows.size:
        return np.inf
    _, quantum = estimate_noise(values)
    return max(_WIDER * float(np.median(np.ptp(windows, axis=1))), _QUANTA * quantum)


def _slow_noise_range(values: Floats, time: Floats, minimum_duration: float) -> float:
    """Greatest `noise_range` of every nth reading of a record of ramps and holds.

    Noise behind a filter, and mains hum at nearly a multiple of the sampling rate, are alike in
    neighbouring readings, whose differences hide them.  The seven readings of the longest
    difference lie within the shortest hold.

    Examples
    --------
    Hum of 1 N with a period of 33 readings:

    >>> hum = np.sin(0.19 * np.arange(4000))
    >>> time = 0.06 * np.arange(4000)
    >>> print(round(noise_range(hum), 3), round(_slow_noise_range(hum, time, 3.0), 1))
    0.0 2.8
    """
    spans = minimum_duration / (_ORDERS[-1] * median_step(time))
    fewest = _STRETCHES * _ORDERS[-1]
    ranges, step = [0.0], 2
    while step <= spans and values.size >= step * fewest:
        ranges.append(noise_range(values[::step]))
        step *= 2
    return max(ranges)


def _code_of_advance(values: Floats) -> float:
    """Step of a channel that stands between its codes more often than not; 0 for others.

    An encoder without noise has differences that are mostly zero: a hold would end where its
    controller moves by one code.  Codes are small beside the range; steps of weights are not.

    Examples
    --------
    >>> slow = np.round(0.1 * np.arange(100_000) / 5) * 0.002
    >>> print(round(_code_of_advance(slow), 4), _code_of_advance(0.1 * np.arange(2000)))
    0.002 0.0
    """
    steps = np.diff(_stretches(values), axis=1)
    moves = steps != 0
    alone = moves[:, 1:-1] & ~moves[:, :-2] & ~moves[:, 2:]
    if not alone.sum() > moves[:, 1:-1].sum() / 2:
        return 0.0
    code = float(np.median(np.abs(steps[:, 1:-1][alone])))
    low, high = finite_extremes(values)
    return code if code < _FINE_CODE * (high - low) else 0.0


_FINE_CODE = 1e-3  # of the range


def _tolerances(values: Floats, time: Floats, stated: float | None) -> tuple[float, float]:
    """Range allowed inside a standstill, and range of noise alone."""
    noise = max(noise_range(values, time), _QUANTA * _code_of_advance(values))
    return (noise, noise) if stated is None else (stated, min(noise, stated))


_BESIDE = 0.25  # of an interval, read on both sides of it

_HINGES = (1.0, 0.75, 0.5)  # of an interval: possible flat fractions if the channel stands there


def _misfits(time: Floats, values: Floats, half: float) -> list[float]:
    """Sums of squares about a parabola, and about levels with ramps of several shapes.

    ``time`` is counted from the middle of an interval of twice ``half``.
    """

    def about(*columns: Floats) -> float:
        design = np.column_stack([np.ones(time.size), *columns])
        left = values - design @ np.linalg.lstsq(design, values, rcond=None)[0]
        return float(left @ left)

    clock = time / half
    levels = []
    for hinge in _HINGES:
        before, after = np.maximum(-clock - hinge, 0), np.maximum(clock - hinge, 0)
        levels += [about(before, after), about(before**2, after**2)]
    return [about(clock, clock**2), *levels]


def _are_turns(
    time: Floats, values: Floats, first: Integers, last: Integers, *, tolerance: float
) -> Bools:
    """Mark intervals that are the rounded turn of a slow cycle, not a standstill of the channel.

    Notes
    -----
    With noise in the channel, the turn of a slow sine stays within the tolerance as long as a
    standstill might.  At a turn, and up to a quarter of the interval to either side, the channel
    is a parabola; at a standstill it is a level left by straight or rounded ramps.  Where the
    mean squares differ by less than a factor of eight, those of all such intervals at the same
    level decide, with ramps of one shape; one that is more than twice as long as most, as a hold
    before the cycles, does not count.

    Examples
    --------
    >>> time = np.arange(0, 300.0)
    >>> sine = -np.cos(2 * np.pi * time / 100)
    >>> first, last = np.array([97, 147]), np.array([103, 153])
    >>> print(_are_turns(time, sine, first, last, tolerance=0.1))
    [ True  True]
    >>> stand = np.interp(time, [0, 45, 55, 95, 105, 300], [-1, 1, 1, -1, -1, 1])
    >>> print(_are_turns(time, stand, first[:1] - 2, last[:1] + 2, tolerance=0.1))
    [False]
    """
    misfits = np.full((1 + 2 * len(_HINGES), first.size), np.nan)
    level, near = _interval_means(values, first, last), np.array([tolerance])
    for index, (one, end) in enumerate(zip(first.tolist(), last.tolist(), strict=True)):
        beside = max(ceil(_BESIDE * (end - one)), 1)
        if one < beside or end + beside >= values.size:
            continue
        # beyond the first reading on its way it may already be in another turn
        before, after = (
            min(int(_reach(values, edge[[index]], level[[index]], near, step)[0]) + 1, beside)
            for edge, step in ((first, -beside), (last, beside))
        )
        part = slice(one - before, end + after + 1)
        stride = max((part.stop - part.start) // _TURN_SAMPLES, 1)
        seconds, series = time[part][::stride], values[part][::stride]
        known = np.isfinite(series)
        if known.sum() < _FEWEST_OF_TURN:
            continue
        middle, half = (time[one] + time[end]) / 2, (time[end] - time[one]) / 2
        # where the ramps begin is a fourth constant of a standstill, their shape half of one
        free = known.sum() - np.r_[3, np.full(2 * len(_HINGES), 4.5)]
        of_both = np.array(_misfits(seconds[known] - middle, series[known], half))
        misfits[:, index] = np.maximum(of_both, _TINY) / free
    ratio = np.log2(misfits[0] / misfits[1:].min(axis=0))
    is_turn: Bools = ratio < 0
    unclear = np.flatnonzero(np.abs(ratio) < _UNCLEAR)  # judged with those like them
    duration = time[last[unclear]] - time[first[unclear]]
    is_long = duration > 2 * np.median(duration) if unclear.size else duration > 0
    by_level = np.lexsort((level[unclear], is_long))
    is_next = (np.diff(level[unclear][by_level]) > tolerance) | np.diff(is_long[by_level])
    alike = np.empty_like(unclear)
    alike[by_level] = np.concatenate([[0], np.cumsum(is_next)])[: unclear.size]
    parabola, *stands = (np.bincount(alike, weights=one[unclear]) for one in misfits)
    is_turn[unclear] = (parabola < np.min(stands, axis=0))[alike]
    return is_turn


_TURN_SAMPLES = 400

_FEWEST_OF_TURN = 6  # a parabola has three constants

_UNCLEAR = 3.0  # powers of two


def _stands(
    time: Floats,
    values: Floats,
    *,
    tolerance: float,
    noise: float,
    settings: PhaseSettings,
    is_held: bool,
    hunts: bool = False,
) -> tuple[Integers, Integers]:
    """First and last sample of every standstill; in a held record, from the end of its approach.

    Between cycles a standstill keeps the edges that follow from its noise: slow motion near it
    is part of the cycle.
    """
    duration = settings.minimum_duration
    if not is_held:
        first, last = _still_intervals(time, values, tolerance=tolerance, minimum_duration=duration)
        stays = ~_are_turns(time, values, first, last, tolerance=tolerance)
        more = _slowly_logged(time, values, tolerance=tolerance, minimum_duration=duration)
        ends = np.stack([first[stays], last[stays]])
        apart = ((more[1][:, None] < ends[0]) | (more[0][:, None] > ends[1])).all(axis=1)
        ends = np.concatenate([ends, more[:, apart]], axis=1)
        first, last = ends[:, np.argsort(ends[0], kind="stable")]
        return first, last
    first, last = _held_intervals(
        time, values, tolerance=tolerance, noise=noise, minimum_duration=duration, hunts=hunts
    )
    return _from_approaches(time, values, first, last, noise=noise)


def _slowly_logged(
    time: Floats, values: Floats, *, tolerance: float, minimum_duration: float
) -> Integers:
    """First and last samples of standstills in parts of a log that have fewer rows a second.

    Shape (2, n_standstills).  No step in them is longer than the shortest standstill, since the
    crosshead may have moved within a longer one.

    Examples
    --------
    A rest with one row a second before a ramp with twenty:

    >>> time = np.concatenate([np.arange(10.0), np.arange(10, 40, 0.05)])
    >>> place = np.maximum(time - 10, 0)
    >>> _slowly_logged(time, place, tolerance=0.01, minimum_duration=3.0).tolist()
    [[0], [10]]
    """
    none = np.empty((2, 0), dtype=np.intp)
    slow = [none[0]]
    usual = median_step(time)
    for part in sample_blocks(time.size, time, overlap=1):
        steps = np.diff(time[part])
        slow.append(part.start + np.flatnonzero((steps > 2 * usual) & (steps <= minimum_duration)))
    at = np.concatenate(slow)
    if not at.size:
        return none
    breaks = np.flatnonzero(np.diff(at) > 1)
    starts, stops = at[np.r_[0, breaks + 1]], at[np.r_[breaks, at.size - 1]] + 1
    found = [none]
    for begin, stop in zip(starts.tolist(), stops.tolist(), strict=True):
        if stop - begin < FEWEST_SAMPLES - 1:
            continue
        span = slice(begin, stop + 1)
        firsts, lasts = _still_intervals(
            time[span], values[span], tolerance=tolerance, minimum_duration=minimum_duration
        )
        found.append(begin + np.stack([firsts, lasts]))
    return np.concatenate(found, axis=1)


_SLACK_SHARE = 0.02


@dataclass(frozen=True)
@read_only_arrays
class Standstills:
    """Every interval in which the crosshead stands still, in order of time.

    Parameters
    ----------
    first, last : ndarray of int, shape (n_standstills,)
        First and last sample, both inside.
    start_time, end_time : ndarray, shape (n_standstills,)
        Elapsed time at them. [s]
    mean_position : ndarray, shape (n_standstills,)
        Mean crosshead position. [m]
    mean_tension : ndarray, shape (n_specimens, n_standstills)
        Mean tension over the interval. [N]
    is_rest : ndarray of bool, shape (n_standstills,)
        True where every specimen is slack.
    position_tolerance : float
        Range of position allowed inside a standstill of the crosshead. [m]
    slack_tension : float
        Tension at or below which a standstill is a rest. [N]
    tension_tolerance : float or None
        Range of tension allowed inside a hold, where holds are intervals of
        constant tension; None where they are standstills of the crosshead. [N]
    """

    first: Integers
    last: Integers
    start_time: Floats
    end_time: Floats
    mean_position: Floats
    mean_tension: Floats
    is_rest: Bools
    position_tolerance: float
    slack_tension: float
    tension_tolerance: float | None = None

    @property
    def n_standstills(self) -> int:
        """Number of intervals."""
        return int(self.first.shape[0])

    def covers(self, part: slice) -> Bools:
        """Mark the samples of a part of the record that lie inside a standstill."""
        is_still = np.zeros(part.stop - part.start, dtype=bool)
        here = slice(np.searchsorted(self.last, part.start), np.searchsorted(self.first, part.stop))
        for first, last in zip(self.first[here], self.last[here], strict=True):
            is_still[max(first - part.start, 0) : last + 1 - part.start] = True
        return is_still


def _slack_tension(tension: Floats, time: Floats) -> float:
    """Two hundredths of the greatest tension, or the noise about zero, of any specimen."""
    levels = [0.0]
    for one in tension:
        sampled = take_samples(one, np.arange(0, one.size, max(1, one.size // _STEPS_READ)))
        sampled = sampled[np.isfinite(sampled)]
        if sampled.size >= 8:
            levels += [_SLACK_SHARE * float(sampled.max()), noise_range(one, time) / 2]
    return max(levels)


def _describe_standstills(
    time: Floats,
    position: Floats,
    tension: Floats,
    first: Integers,
    last: Integers,
    *,
    position_tolerance: float,
    slack_tension: float,
    tension_tolerance: float | None = None,
) -> Standstills:
    """Means over given intervals, with a mark for rests.

    Examples
    --------
    >>> time, load = np.arange(4.0), np.array([[0.0, 0.0, 9.0, 11.0]])
    >>> found = _describe_standstills(
    ...     time, time, load, np.array([0, 2]), np.array([1, 3]),
    ...     position_tolerance=1.0, slack_tension=1.0)
    >>> print(found.mean_tension, found.is_rest)
    [[ 0. 10.]] [ True False]
    """
    mean_tension = np.array([_interval_means(one, first, last) for one in tension])
    return Standstills(
        first=first,
        last=last,
        start_time=take_samples(time, first),
        end_time=take_samples(time, last),
        mean_position=_interval_means(position, first, last),
        mean_tension=mean_tension.reshape(tension.shape[0], first.size),
        is_rest=(mean_tension <= slack_tension).all(axis=0).reshape(first.size),
        position_tolerance=float(position_tolerance),
        slack_tension=float(slack_tension),
        tension_tolerance=tension_tolerance,
    )


def level_of_standstill(
    position: Floats, standstills: Standstills, index: int
) -> tuple[float, float]:
    """Mean position of a standstill without the ramps at its ends, and its standard uncertainty.

    The latter is from the noise of the readings about a line and the correlation of neighbours.
    A drift beyond this counts as a uniform distribution.

    Examples
    --------
    A minute at rest, and three seconds of a slow ramp that noise hides:

    >>> position = np.r_[np.zeros(60), 0.01, 0.02, 0.03]
    >>> one = lambda value: np.array([value])
    >>> rest = Standstills(
    ...     one(0), one(62), one(0.0), one(62.0), one(0.0), np.array([[0.0]]), one(True), 0.05, 5.0)
    >>> level_of_standstill(position, rest, 0)
    (0.0, 0.0)
    """
    first, last = standstills.first[index : index + 1], standstills.last[index : index + 1]
    stride = max(int(last[0] + 1 - first[0]) // _LEVEL_SAMPLES, 1)
    readings = take_samples(position, np.arange(first[0], last[0] + 1, stride))
    level = float(np.nanmedian(readings))
    begin, end = _without_ramps(
        position, first.copy(), last.copy(), np.array([level]), standstills.position_tolerance
    )
    if begin[0] <= end[0]:  # otherwise a few readings that rise by chance: each half is a ramp
        level = float(_interval_means(position, begin, end)[0])
        readings = take_samples(position, np.arange(begin[0], end[0] + 1, stride))
    readings = readings[np.isfinite(readings)]
    place = np.linspace(-0.5, 0.5, readings.size)
    apart = readings - readings.mean()  # of a single one zero, although its place is not centred
    slope = float(place @ apart / max(place @ place, _TINY))
    left = apart - slope * place
    scatter = float(left @ left)
    alike = float(np.clip(left[1:] @ left[:-1] / max(scatter, _TINY**2), 0.0, 0.99))
    # a few readings scatter less than the channel by chance
    of_one = max(scatter / max(readings.size - 2, 1), estimate_noise(position)[0] ** 2)
    variance = of_one / readings.size * (1 + alike) / (1 - alike)
    drift = max(slope**2 - 12 * variance, 0.0)
    return level, float(np.sqrt(variance + drift / 12))


def find_standstills(
    time: ArrayLike,
    position: ArrayLike,
    tension: ArrayLike,
    *,
    settings: PhaseSettings,
    is_held: bool = False,
) -> Standstills:
    """Find every interval in which the crosshead stands still, and mark the rests.

    Notes
    -----
    *Tolerance.* If None, `noise_range` of position.  The crosshead stands where the range
    of position stays within it over every stretch of the shortest duration, and within
    twice that over the whole interval.  At the edges it comes and goes nearer to
    the mean than half the tolerance.

    *Duration.* At least ``minimum_duration`` and at least four samples, so that the two
    samples beside a peak of a slow log are not a hold.  A movement too slow to leave the
    tolerance within that time is distinguished from a hold by wider windows, and the turn of a
    slow cycle by its neighbourhood: from a standstill the crosshead gets four tolerances
    away within as long as it stood, before or after it, and its position there is a level, not
    a parabola.

    *Rests.* A standstill whose mean tension is at or below the slack tension for every
    specimen.  If None, the slack tension is the greater of 2 % of the greatest tension of the
    record and half the `noise_range` of tension, for the specimen where it is larger; a record
    that never goes slack has no rests.

    Missing samples inside a standstill do not end it.  The record is read in blocks of
    a quarter of the shortest standstill; edges are found to the sample.

    Examples
    --------
    One minute slack, a pull of 10 s, one minute at 1 m:

    >>> time = np.arange(0, 130.0)
    >>> position = np.interp(time, [0, 60, 70, 130], [0, 0, 1, 1])
    >>> found = find_standstills(time, position, [100 * position], settings=PhaseSettings())
    >>> print(found.start_time, found.end_time, found.is_rest)
    [ 0. 70.] [ 60. 129.] [ True False]
    """
    tension = np.atleast_2d(np.asarray(tension, dtype=np.float64))
    time, position, _ = as_same_shape(time=time, position=position, tension=tension[0])
    if time.size < FEWEST_SAMPLES:
        raise DataError(
            "the record is too short to stand still",
            found=f"{time.size} rows",
            needed=f"{FEWEST_SAMPLES} rows or more",
        )
    parts = sample_blocks(position.size, position)
    if not any(np.isfinite(position[part]).any() for part in parts):
        raise DataError(
            "no position of the record may be used: each is missing, stuck or a spike",
            found=f"0 positions in {time.size} rows",
            needed="a position channel that follows the crosshead",
        )
    tolerance, noise = _tolerances(position, time, settings.position_tolerance)
    slack = settings.slack_tension
    if slack is None:
        slack = _slack_tension(tension, time)

    first, last = _stands(
        time, position, tolerance=tolerance, noise=noise, settings=settings, is_held=is_held
    )
    return _describe_standstills(
        time, position, tension, first, last, position_tolerance=tolerance, slack_tension=slack
    )


def find_tension_stands(
    time: ArrayLike,
    position: ArrayLike,
    tension: ArrayLike,
    *,
    settings: PhaseSettings,
    is_held: bool = False,
) -> Standstills:
    """Find every hold at constant tension, and every rest.

    Notes
    -----
    *Holds* are intervals above the slack tension in which the tension of the machine stands still
    (`_still_intervals`): the mean over the specimens, which pull at one
    crosshead.  Tolerance, where not stated: its `noise_range`, or `_dither_range` if less; in a
    held record, `_slow_noise_range` instead of the former.
    *Rests* are those of `find_standstills`, since a slack specimen has the same tension at any
    position of the crosshead.  Where the two overlap, the rest is shortened.

    Examples
    --------
    A minute slack, a pull of 10 s, a minute at 100 N with creep of the crosshead:

    >>> time = np.arange(0, 130.0)
    >>> load = np.interp(time, [0, 60, 70, 130], [0, 0, 100, 100])
    >>> position = load / 100 + 0.1 * np.clip(time - 70, 0, None)
    >>> found = find_tension_stands(time, position, [load], settings=PhaseSettings())
    >>> print(found.start_time, found.end_time, found.is_rest)
    [ 0. 70.] [ 60. 129.] [ True False]
    """
    loads = np.atleast_2d(np.asarray(tension, dtype=np.float64))
    seconds, place, _ = as_same_shape(time=time, position=position, tension=loads[0])
    crosshead = find_standstills(seconds, place, loads, settings=settings)
    mean = mean_of_rows(loads)
    tolerance, noise = _tolerances(mean, seconds, settings.tension_tolerance)
    if settings.tension_tolerance is None:
        if is_held:
            noise = max(noise, _slow_noise_range(mean, seconds, settings.minimum_duration))
        tolerance = noise = min(noise, _dither_range(mean))
    first, last = _stands(
        seconds, mean, tolerance=tolerance, noise=noise, settings=settings, is_held=is_held,
        hunts=True,
    )  # fmt: skip
    limits = {
        "position_tolerance": crosshead.position_tolerance,
        "slack_tension": crosshead.slack_tension,
        "tension_tolerance": float(tolerance),
    }
    stands = _describe_standstills(seconds, place, loads, first, last, **limits)
    held, rest = ~stands.is_rest, crosshead.is_rest
    first = np.concatenate([stands.first[held], crosshead.first[rest]])
    last = np.concatenate([stands.last[held], crosshead.last[rest]])
    is_rest = np.repeat([False, True], [held.sum(), rest.sum()])
    order = np.argsort(first, kind="stable")
    first, last, is_rest = first[order], last[order], is_rest[order]
    before = is_rest[:-1]
    last[:-1][before] = np.minimum(last[:-1], first[1:] - 1)[before]
    first[1:][is_rest[1:]] = np.maximum(first[1:], last[:-1] + 1)[is_rest[1:]]
    left = first <= last
    return _describe_standstills(seconds, place, loads, first[left], last[left], **limits)
