"""What is known against a sample: masks of one series, found in few passes.

Everything here takes and returns arrays; a mask is True where a sample is flagged.  A
clean record costs little more than reading it once: each test first asks a cheap
question that clean data answers with no.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

import numpy as np

from reduction.ingest.excursions import find_excursions, usual_step
from reduction.record import Bools, Floats, Integers, Quality, Record
from reduction.samples.blocks import sample_blocks, take_samples
from reduction.samples.scratch import zeros_like

_WINDOWS, _WINDOW = 64, 1024
_NEIGHBOURS = 4
_SPIKE_TO_NEIGHBOURS = 3.0
_MAD_TO_SIGMA = 1.4826
_SECOND_DIFFERENCE = np.sqrt(6.0)  # sd of x[i-1] - 2 x[i] + x[i+1] over that of x
_STEP = np.sqrt(12.0)  # one step of a quantised value over its standard deviation


@dataclass(frozen=True)
class Timing:
    """Faults of a time axis.

    Parameters
    ----------
    step : float
        Median time step. [s]
    gap, backward : ndarray of bool, shape (n_samples,)
        First sample after a gap; samples not later than one before them.
    n_uneven : int
        Steps, gaps apart, that differ from the median by more than the tolerance.
    shortest, longest : float
        Of the steps that are neither gaps nor backward. [s]
    """

    step: float
    gap: Bools
    backward: Bools
    n_uneven: int
    shortest: float
    longest: float


@dataclass(frozen=True)
class RowAccount:
    """Every row of a record accounted for.

    Parameters
    ----------
    n_read, n_kept : int
        Rows in the files, rows in the record.
    n_flagged : dict of str to dict of str to int
        By channel (``crosshead_position``, ``tension of NAME``) and mask; masks that
        flag nothing are left out.
    """

    n_read: int
    n_kept: int
    n_flagged: dict[str, dict[str, int]]


def account_rows(record: Record) -> RowAccount:
    """Rows read, kept, and flagged by mask and channel."""
    channels = {"crosshead_position": record.crosshead_position_quality_flag}
    for name, flags in zip(record.specimens, record.quality_flag, strict=True):
        channels[f"tension of {name}"] = flags
    n_flagged = {}
    for channel, flags in channels.items():
        found: Counter[int] = Counter()
        for part in sample_blocks(flags.size, flags):
            flagged = flags[part][flags[part] != 0]
            values, counts = np.unique(flagged, return_counts=True)
            found.update(dict(zip(values.tolist(), counts.tolist(), strict=True)))
        of_mask = {
            mask.name.lower(): sum(count for value, count in found.items() if value & mask)
            for mask in Quality
            if mask.name is not None
        }
        n_flagged[channel] = {name: count for name, count in of_mask.items() if count}
    return RowAccount(record.n_rows_read, record.n_samples, n_flagged)


def find_missing(values: Floats) -> Bools:
    """Where a value is NaN, shape (n_samples,)."""
    missing = zeros_like(values, dtype=bool)
    for part in sample_blocks(values.size, values, missing):
        if not np.isfinite(values[part].sum()):
            np.isnan(values[part], out=missing[part])
    return missing


def find_outside_range(values: Floats, low: float, high: float) -> Bools:
    """Where a value lies outside the range a load cell is verified for, shape (n_samples,)."""
    outside = zeros_like(values, dtype=bool)
    for part in sample_blocks(values.size, values, outside):
        block = values[part]
        outside[part] = (block < low) | (block > high)
    return outside


def sampled_windows(values: Floats) -> Floats:
    """Windows spread evenly over a series, one a row; a short series is one window."""
    if values.size <= _WINDOWS * _WINDOW:
        return values[np.newaxis]
    starts = np.linspace(0, values.size - _WINDOW, _WINDOWS).astype(np.int64)
    windows: Floats = take_samples(values, starts[:, np.newaxis] + np.arange(_WINDOW))
    return windows


def time_faults(time: Floats, *, gap_factor: float, rate_tolerance: float) -> Timing:
    """Gaps, backward or repeated time, and steps that differ from the median.

    A gap is a step ``gap_factor`` times as long as the median of the record and of the
    steps around it, so that a slow part of a log is not a row of gaps.

    Parameters
    ----------
    time : ndarray, shape (n_samples,)
        Elapsed time; NaN where missing. [s]
    gap_factor : float
        As in `reduction.settings.QualitySettings`. [1]
    rate_tolerance : float
        Likewise. [1]

    Returns
    -------
    timing : Timing
        Masks and steps.
    """
    n_samples = time.size
    gap, backward = zeros_like(time, dtype=bool), zeros_like(time, dtype=bool)
    steps = np.diff(sampled_windows(time), axis=1).ravel()
    steps = steps[steps > 0]
    if not steps.size:
        backward[1:] = True
        return Timing(np.nan, gap, backward, 0, np.nan, np.nan)
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
        ahead = piece[1:] - reached[1:-1]  # of all before it: a slip back makes no gap after it
        long = np.flatnonzero(ahead > gap_factor * step)
        stands_out = ahead[long] > gap_factor * _usual_time_step(time, long + part.start)
        gap[1 + part.start + long[stands_out]] = True
        usual = ahead[(ahead > 0) & ~gap[part][1:]]
        if usual.size:
            n_uneven += int(np.count_nonzero((usual < low) | (usual > high)))
            shortest, longest = min(shortest, usual.min()), max(longest, usual.max())
    return Timing(step, gap, backward, n_uneven, float(shortest), float(longest))


def _usual_time_step(time: Floats, place: Integers) -> Floats:
    """Median of the steps forward around each step; 0 where there are none."""
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


def noise_of(values: Floats) -> tuple[float, float]:
    """Standard deviation of a series about its own course, and the step it is printed in.

    From second differences in windows over the series (median absolute deviation), so
    that ramps, reversals and holds do not count; never below what the step makes.

    Parameters
    ----------
    values : ndarray, shape (n_samples,)
        A channel. [any]

    Returns
    -------
    noise : float
        Standard deviation of one sample. [as values]
    step : float
        Smallest change between neighbours; 0 for a constant series. [as values]
    """
    windows = sampled_windows(values)
    changes = np.abs(np.diff(windows, axis=1))
    changes = changes[changes > 0]
    step = float(changes.min()) if changes.size else 0.0
    second = np.abs(np.diff(windows, n=2, axis=1))
    second = second[np.isfinite(second)]
    spread = float(np.median(second)) if second.size else 0.0
    return max(_MAD_TO_SIGMA * spread / _SECOND_DIFFERENCE, step / _STEP), step


def find_spikes(values: Floats, *, noise: float, factor: float) -> Bools:
    """Samples off the course of their neighbours: single ones, and excursions of up to ten.

    A sample is off by ``factor`` times the noise and by three times the usual step
    nearby, so that a reversal, the start of a ramp, a step and a rough stretch are none;
    for excursions of several samples see `reduction.ingest.excursions`.

    Parameters
    ----------
    values : ndarray, shape (n_samples,)
        A channel. [any]
    noise : float
        From `noise_of`. [as values]
    factor : float
        ``spike_factor`` of the settings. [1]

    Returns
    -------
    is_spike : ndarray of bool, shape (n_samples,)
        True at the samples that are off.
    """
    is_spike = zeros_like(values, dtype=bool)
    limit = factor * noise
    if limit <= 0:
        return is_spike
    jumps = []
    for part in sample_blocks(values.size, values, overlap=3):
        step = np.diff(values[part])
        bend = step[1:] - step[:-1]
        # a jump bends the course at both its ends, against each other; a spike is two jumps
        product = bend[:-1] * bend[1:]
        jumps.append(np.flatnonzero(product < -(limit**2)) + 1 + part.start)
    jump = np.unique(np.concatenate(jumps))
    if not jump.size:
        return is_spike
    place = np.unique(np.concatenate([jump, jump + 1]))
    before, here, after = (take_samples(values, place + step) for step in (-1, 0, 1))
    off = np.minimum(np.abs(here - before), np.abs(here - after))
    opposite = (here - before) * (after - here) < -(limit**2)
    nearby = np.fmax(np.abs(after - before), usual_step(values, place - 1, place))
    single = place[opposite & (off > limit) & (off > _SPIKE_TO_NEIGHBOURS * nearby)]
    is_spike[single] = True
    of_single = is_spike[jump] | is_spike[jump + 1]
    is_spike[find_excursions(values, jump[~of_single], limit=limit)] = True
    return is_spike
