"""Short excursions: a channel leaves its course by a jump and comes back by one."""

from __future__ import annotations

import numpy as np

from reduction.record import Bools, Floats, Integers
from reduction.samples.blocks import take_samples

LONGEST = 10  # samples of an excursion
_NEIGHBOURS = 4  # steps on each side that tell the course
_JUMP_TO_STEPS = 5.0
_OFF_COURSE = 0.5  # of the jump, at least, at every sample between
_RETURN = 0.1  # of the jump: how near to its course the channel comes back
_SMALL_JUMP = 0.2  # of the largest nearby: the start of a ramp beside an excursion
_MOST_IN_A_ROW = 3  # more that follow each other closely are a signal
_SIGNAL_SHARE = 0.1  # of a series in excursions: they are its signal


def usual_step(values: Floats, first: Integers, last: Integers) -> Floats:
    """Third largest of the eight steps before the first and after the last step of a place.

    Another spike nearby makes two large steps, which are passed over.
    """
    around = np.arange(1, _NEIGHBOURS + 1)
    left = np.concatenate([first[:, np.newaxis] - around, last[:, np.newaxis] + around], axis=1)
    is_inside = (left >= 0) & (left < values.size - 1)
    left = np.where(is_inside, left, 0)
    change = np.abs(take_samples(values, left + 1) - take_samples(values, left))
    steps = np.where(is_inside, change, 0.0)
    usual: Floats = np.sort(np.nan_to_num(steps), axis=1)[:, -3]
    return usual


def find_excursions(values: Floats, jumps: Integers, *, limit: float) -> Integers:
    """Samples between a jump off the course of a series and the jump back to it.

    Parameters
    ----------
    values : ndarray, shape (n_samples,)
        A channel. [any]
    jumps : ndarray of int, shape (n_jumps,)
        Steps that may be jumps, in order, each by the sample before it. [1]
    limit : float
        Smallest jump. [as values]

    Returns
    -------
    off : ndarray of int, shape (n_off,)
        Samples of excursions of two to ten samples, whose jumps have opposite signs and are five
        times the usual step nearby.  Every sample between is off the line across by half
        the jump, and the channel comes back to its course, extrapolated from before and
        after, a turn within allowed for, within a tenth of the jump.

    Notes
    -----
    Levels that change there and back again and again are a signal: more than three
    excursions with ten samples or fewer between them are none, nor are two or three of which
    one is longer than what is between them, nor any where together they make more than a
    tenth of the series.
    """
    none = np.empty(0, dtype=np.intp)
    size = take_samples(values, jumps + 1) - take_samples(values, jumps)
    is_jump = np.abs(size) > np.fmax(limit, _JUMP_TO_STEPS * usual_step(values, jumps, jumps))
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
    """First jump and number of jumps of each row of jumps that are close to each other."""
    row_start = np.flatnonzero(np.diff(jumps, prepend=-np.inf) > LONGEST)
    return row_start, np.diff(row_start, append=jumps.size)


def _pairs(jumps: Integers) -> tuple[Integers, Integers]:
    """Jumps out and back, in turn, of each short row of jumps that are close to each other."""
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
    """Samples after each jump out up to the jump back, the last one repeated, ten a row."""
    rows = out[:, np.newaxis] + np.arange(1, LONGEST + 1)
    return np.asarray(np.minimum(rows, back[:, np.newaxis]))


def _returns(values: Floats, out: Integers, back: Integers, limit: float) -> Bools:
    """Whether what lies between two jumps is off the course, and the course goes on after it."""
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
        size > np.fmax(limit, _JUMP_TO_STEPS * usual_step(values, out, back))
    )
    is_back = (leaves * comes < 0) & (missed <= limit + _RETURN * size)
    return np.asarray(is_large & is_back & (off > _OFF_COURSE * size[:, np.newaxis]).all(axis=1))
