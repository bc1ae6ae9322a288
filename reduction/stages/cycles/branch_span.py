"""Part of a branch at constant rate, or by share of its stroke, without the turns."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from math import ceil, hypot, sqrt

import numpy as np

from reduction.record.errors import SettingsError
from reduction.record.measurement import Bools, Floats
from reduction.record.notes import Note, note
from reduction.record.samples import (
    take_samples,
)
from reduction.record.settings import CycleSettings
from reduction.stages.cycles.reversals import Indices
from reduction.stages.standstills import estimate_noise, median_step

_RATE_NOISE = 0.01

_WIDEST = 4  # a window is at most this part of a branch

_RATES_READ = 33

_CELLS = 1 << 18  # samples searched in one step, so that they stay in the cache

_FIRST_STEPS = 8

_FEWEST = 8

_STROKE_END = 0.05


def _rate(time: Floats, values: Floats, begin: Indices, end: Indices) -> Floats:
    """Rate between two samples; NaN where time does not advance."""
    elapsed = take_samples(time, end) - take_samples(time, begin)
    travel = take_samples(values, end) - take_samples(values, begin)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(travel / np.where(elapsed == 0, np.nan, elapsed))


def _steps_until(
    start: Indices, direction: int, reach: Indices, passes: Callable[[Indices, Indices], Bools]
) -> Indices:
    """Number of samples from each start to the first that passes, -1 if none within reach does.

    ``passes`` takes samples, shape (n_rows, n_steps), and the rows of ``start`` they belong to.
    Ends of branches are short, so all branches are searched at once, a few steps at a time.
    """
    found = np.full(start.size, -1, dtype=np.intp)
    for row in range(0, start.size, _CELLS // _FIRST_STEPS):
        rows = np.arange(row, min(row + _CELLS // _FIRST_STEPS, start.size))
        rows = rows[reach[rows] >= 0]
        begin, count = 0, _FIRST_STEPS
        while rows.size:
            steps = np.minimum(np.arange(begin, begin + count), reach[rows, None])
            hits = passes(start[rows, None] + direction * steps, rows)
            is_hit = hits.any(axis=1)
            found[rows[is_hit]] = begin + hits[is_hit].argmax(axis=1)
            begin += count
            rows = rows[~is_hit & (reach[rows] >= begin)]
            count = max(_FIRST_STEPS, min(2 * count, _CELLS // max(rows.size, 1)))
    return found


def _constant_rate_span(
    time: Floats,
    values: Floats,
    branch_first: Indices,
    branch_last: Indices,
    *,
    noise: float,
    trim_threshold: float,
) -> tuple[Indices, Indices, Floats]:
    r"""First and last sample of the trimmed part of each branch, and the plateau rate.

    Notes
    -----
    The rate is taken between two samples a window apart, both inside the branch.  The
    window has as many samples as reduce the noise of the rate to 1 % of it,
    :math:`\sqrt 2 / 0.01` times the noise of a sample and of its time stamp over the
    travel and the time of a step, at most a quarter of the branch.  The trimmed
    part runs from the beginning of the first window to the end of the last
    window whose rate is at least ``trim_threshold`` times the plateau: a window that
    begins in the turn of the machine is slow as a whole.  A missing sample gives no rate.

    Examples
    --------
    One slow sample at each end:

    >>> values = np.array([0.0, 0.2, 1.2, 2.2, 3.2, 4.2, 5.2, 5.4])
    >>> _constant_rate_span(
    ...     np.arange(8.0), values, np.array([0]), np.array([7]), noise=0.0, trim_threshold=0.97)
    (array([1]), array([6]), array([1.]))
    """
    if not 0 < trim_threshold <= 1:
        raise SettingsError(
            "cycles.trim_threshold is not a share",
            found=f"{trim_threshold:g}",
            needed="above 0 and at most 1",
        )
    plateau, sign, width = _plateau(time, values, branch_first, branch_last, noise)
    reach = branch_last - branch_first - width
    least = trim_threshold * plateau

    def passes(samples: Indices, rows: Indices, direction: int) -> Bools:
        other = samples + direction * width[rows, None]
        rate = sign[rows, None] * _rate(time, values, samples, other)
        return np.asarray(rate >= least[rows, None])

    searched = np.where(plateau > 0, reach, -1)
    head = _steps_until(branch_first, 1, searched, partial(passes, direction=1))
    tail = _steps_until(branch_last, -1, searched, partial(passes, direction=-1))
    first = branch_first + np.maximum(head, 0)
    last = np.where(head >= 0, branch_last - tail, branch_first - 1)
    return first, last, plateau


def _plateau_rates(
    time: Floats, values: Floats, branch_first: Indices, branch_last: Indices, *, noise: float
) -> Floats:
    """Plateau rate of each branch, without its ends: parameters as in `_constant_rate_span`.

    Examples
    --------
    >>> values = np.array([0.0, 0.2, 1.2, 2.2, 3.2, 4.2, 5.2, 5.4])
    >>> _plateau_rates(np.arange(8.0), values, np.array([0]), np.array([7]), noise=0.0)
    array([1.])
    """
    return _plateau(time, values, branch_first, branch_last, noise)[0]


def _plateau(
    time: Floats, values: Floats, branch_first: Indices, branch_last: Indices, noise: float
) -> tuple[Floats, Floats, Indices]:
    """Plateau rate, direction and steps of a window of each branch."""
    n_steps = branch_last - branch_first
    travel = take_samples(values, branch_last) - take_samples(values, branch_first)
    sign = np.sign(travel)
    width = _window(time, travel, n_steps, noise)
    reach = n_steps - width  # last start of a window, from the first sample

    plateau = np.full(n_steps.size, np.nan)
    n_read = min(_RATES_READ, int(reach.max(initial=0)) + 1)
    places = np.linspace(0, 1, n_read)
    rows_read = max(_CELLS // n_read, 1)
    for begin in range(0, n_steps.size, rows_read):
        part = slice(begin, begin + rows_read)
        steps = np.maximum(reach[part], 0)[:, None] * places
        at = branch_first[part, None] + steps.astype(np.intp)
        end = np.minimum(at + width[part, None], branch_last[part, None])
        plateau[part] = _median(sign[part, None] * _rate(time, values, at, end))
    return plateau, sign, width


def _window(time: Floats, travel: Floats, n_steps: Indices, noise: float) -> Indices:
    """Steps between the two samples of a rate."""
    known = np.isfinite(travel) & (n_steps > 0)
    step_travel = float(np.median(np.abs(travel[known]) / n_steps[known])) if known.any() else 0.0
    step_time = median_step(time)
    time_noise = estimate_noise(time)[0] if time.size >= _FEWEST else 0.0
    share = 0.0
    if step_travel > 0:
        share = hypot(noise / step_travel, time_noise / step_time)
    wanted = ceil(sqrt(2) * share / _RATE_NOISE - 1e-6)
    return np.clip(np.minimum(wanted, n_steps // _WIDEST), 1, None)


def _median(rates: Floats) -> Floats:
    """Median of each row without missing values; NaN where all are missing."""
    missing = np.isnan(rates)
    if not missing.any():
        ordered, middle = np.sort(rates, axis=1), rates.shape[1] // 2  # faster than np.median
        return np.asarray((ordered[:, middle] + ordered[:, ~middle]) / 2)
    median = np.full(rates.shape[0], np.nan)
    known = ~missing.all(axis=1)
    median[known] = np.nanmedian(rates[known], axis=1)
    return median


def _stroke_span(
    values: Floats, branch_first: Indices, branch_last: Indices
) -> tuple[Indices, Indices]:
    """First and last sample of the middle 90 % of the stroke of each branch.

    Notes
    -----
    For waveforms without a plateau.  Five hundredths of the stroke are left out at each
    end, where a sine has 44 % of its greatest rate.

    Examples
    --------
    >>> values = np.sin(np.linspace(-np.pi / 2, np.pi / 2, 21))
    >>> _stroke_span(values, np.array([0]), np.array([20]))
    (array([3]), array([17]))
    """
    begin, end = take_samples(values, branch_first), take_samples(values, branch_last)
    stroke = end - begin
    low, high = begin + _STROKE_END * stroke, end - _STROKE_END * stroke
    sign = np.sign(stroke)

    def passes(samples: Indices, rows: Indices) -> Bools:
        level, up = take_samples(values, samples), sign[rows, None]
        is_in = (up * (level - low[rows, None]) >= 0) & (up * (high[rows, None] - level) >= 0)
        return np.asarray(is_in)

    reach = np.where(sign == 0, -1, branch_last - branch_first)
    head = _steps_until(branch_first, 1, reach, passes)
    tail = _steps_until(branch_last, -1, reach, passes)
    first = branch_first + np.maximum(head, 0)
    return first, np.where(head >= 0, branch_last - tail, branch_first - 1)


def trimmed_branches(
    time: Floats,
    values: Floats,
    branch_first: Indices,
    branch_last: Indices,
    settings: CycleSettings,
) -> tuple[Indices, Indices, Floats, list[Note]]:
    """First and last samples of each branch without its turns, its rate, and notes."""
    noise = estimate_noise(values)[0]
    if settings.waveform != "triangular":
        first, last = _stroke_span(values, branch_first, branch_last)
        # a wave that stops at its turns has a ramp only within the stroke
        ends = (first, last) if settings.waveform == "other" else (branch_first, branch_last)
        return (
            first,
            last,
            _plateau_rates(time, values, *ends, noise=noise),
            [note("no-plateau", waveform=settings.waveform)],
        )
    first, last, rate = _constant_rate_span(
        time,
        values,
        branch_first,
        branch_last,
        noise=noise,
        trim_threshold=settings.trim_threshold,
    )
    bare = int(np.sum(last < first))
    return (
        first,
        last,
        rate,
        [
            note(
                "branches-without-constant-rate",
                n_bare=bare,
                n_branches=first.size,
                time=float(time[branch_first[np.argmax(last < first)]]),
            )
        ]
        if bare
        else [],
    )
