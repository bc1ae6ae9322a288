"""Missing time stamps of a log, bridged between those that are there."""

from __future__ import annotations

import numpy as np

from reduction.record import Bools, Floats
from reduction.samples.blocks import copied, sample_blocks, take_samples

_STEPS_READ = 100_001


def bridge_stamps(time: Floats, missing: Bools) -> Floats:
    """Time without missing stamps: even steps between neighbours, the median step at the ends.

    Parameters
    ----------
    time : ndarray, shape (n_samples,)
        Elapsed time; NaN where missing, at least one stamp there. [s]
    missing : ndarray of bool, shape (n_samples,)
        Where it is NaN. [1]

    Returns
    -------
    bridged : ndarray, shape (n_samples,)
        The stamps that are there as they are. [s]
    """
    lost = np.concatenate(
        [part.start + np.flatnonzero(missing[part]) for part in sample_blocks(time.size, missing)]
    )
    if not lost.size:
        return time
    # rows before and after each run of lost ones; -1 and n_samples at the ends of the record
    is_first = np.diff(lost, prepend=-2) > 1
    run = np.cumsum(is_first) - 1
    before = lost[is_first] - 1
    after = lost[np.append(is_first[1:], True)] + 1
    known = before >= 0, after < time.size
    left = take_samples(time, np.where(known[0], before, after))
    right = take_samples(time, np.where(known[1], after, before))
    step = np.where(known[0] & known[1], (right - left) / (after - before), _step(time))
    # before the first stamp rows count back from it
    start = np.where(known[0], left, right - (after - before) * step)
    bridged = copied(time)
    bridged[lost] = start[run] + (lost - before[run]) * step[run]
    return bridged


def _step(time: Floats) -> float:
    """Median step of time, 0 where no two stamps follow each other."""
    first = np.arange(0, time.size - 1, max(1, time.size // _STEPS_READ))
    steps = take_samples(time, first + 1) - take_samples(time, first)
    steps = steps[np.isfinite(steps)]
    return float(np.median(steps)) if steps.size else 0.0
