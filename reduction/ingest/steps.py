"""Steps of a channel that stay, while the channel beside it goes on as before.

A specimen that is stretched at once answers at once: position and tension step together.  One
that steps alone is a slip, a break, a zero that was set again or, from there on, another unit.
"""

from __future__ import annotations

import numpy as np

from reduction.ingest.excursions import usual_step
from reduction.ingest.quality import sampled_windows
from reduction.record import Bools, Floats, Integers
from reduction.samples.blocks import sample_blocks, take_samples

_NEIGHBOURS = 4  # samples on each side that tell the level there
_STEP_TO_STEPS = 5.0
_SHARE_OF_RANGE = 0.05
_STAYS = 0.5  # of the step, at least, is left of it between the levels on its sides
_OUTER = (0.01, 0.99)


def find_lone_steps(
    values: Floats, beside: Floats, *, noise: float, noise_beside: Floats, factor: float
) -> Integers:
    """Steps of a channel that stay, at which no channel beside it steps.

    Parameters
    ----------
    values : ndarray, shape (n_samples,)
        A channel; NaN where it is flagged. [any]
    beside : ndarray, shape (n_beside, n_samples)
        Those that would step with it. [any]
    noise : float
        From `reduction.ingest.quality.noise_of`. [as values]
    noise_beside : ndarray, shape (n_beside,)
        Likewise. [as beside]
    factor : float
        ``spike_factor`` of the settings. [1]

    Returns
    -------
    step : ndarray of int, shape (n_steps,)
        The sample before each step, which is larger than ``factor`` times the noise, than five
        times the usual step nearby and than a twentieth of the range of the channel. [1]

    Examples
    --------
    >>> time = np.arange(200.0)
    >>> tension = np.sin(time / 10) + np.where(time > 120, 3.0, 0.0)
    >>> position = np.sin(time / 10)[np.newaxis]
    >>> given = {"noise": 0.01, "noise_beside": np.array([0.01]), "factor": 12.0}
    >>> find_lone_steps(tension, position, **given)
    array([120])
    >>> find_lone_steps(tension, tension[np.newaxis], **given).size
    0
    """
    seen = sampled_windows(values)
    low, high = np.quantile(seen[np.isfinite(seen)], _OUTER) if np.isfinite(seen).any() else (0, 0)
    limit = max(factor * noise, _SHARE_OF_RANGE * float(high - low))
    found = []
    for part in sample_blocks(values.size, values, overlap=1):
        some = _candidates(np.abs(np.diff(values[part])), limit) + part.start
        found.append(some[_stands_out(values, some, limit)])
    step: Integers = np.concatenate(found)
    change = take_samples(values, step + 1) - take_samples(values, step)
    step = step[_level_change(values, step) * np.sign(change) > _STAYS * np.abs(change)]
    for channel, its_noise in zip(beside, noise_beside, strict=True):
        step = step[~_stands_out(channel, step, factor * float(its_noise))]
    return step


def _candidates(step: Floats, limit: float) -> Integers:
    """Steps that are five times the least of three beside them: few, also of coarse samples."""
    is_large = step > limit
    if step.size > 3 and is_large.any():
        # what the third largest of eight is not below; missing neighbours say nothing
        near = np.fmin(np.fmin(step[:-3], step[1:-2]), step[3:])
        is_large[2:-1] &= ~(step[2:-1] <= _STEP_TO_STEPS * near)
    return np.flatnonzero(is_large)


def _stands_out(values: Floats, step: Integers, limit: float) -> Bools:
    change = np.abs(take_samples(values, step + 1) - take_samples(values, step))
    return np.asarray(change > np.fmax(limit, _STEP_TO_STEPS * usual_step(values, step, step)))


def _level_change(values: Floats, step: Integers) -> Floats:
    """Median of the samples after a step less that of those before it."""
    after = step[:, np.newaxis] + np.arange(1, _NEIGHBOURS + 1)
    before = after - _NEIGHBOURS
    last = values.size - 1
    levels = [np.nanmedian(take_samples(values, np.clip(rows, 0, last)), axis=1)
              for rows in (after, before)]  # fmt: skip
    return np.asarray(levels[0] - levels[1], dtype=np.float64)
