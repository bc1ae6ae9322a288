"""The motion that leads to a standstill: where it began, how fast it came, where it ends.

A servo reaches its target in two steps: it approaches and then it settles.  The noise of the
record does not show where one becomes the other; an approach ends where it is slow and near,
compared with itself.

References
----------
.. [1] ASTM E328-13, "Standard Test Methods for Stress Relaxation for Materials and Structures,"
   ASTM International, 2013 (zero time: when the constraint is first obtained).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reduction.record.arrays import finite_median
from reduction.record.measurement import Bools, Floats
from reduction.record.samples import BLOCK, finite_extremes, last_sample, release_pages

NEAR_SHARE = 0.02
"""Distance from a standstill within which settling is looked for, as a share of the stroke to it.
[1]"""

OVERRUN_SHARE = 0.1
"""Distance beyond a standstill from which a channel that has overshot settles back, as a share of
the stroke to it. [1]"""

SLOW_SHARE = 0.1
"""Rate at which an approach ends, as a share of its mean rate. [1]"""

_LONGEST_CHORD = 0.2  # of the time of the approach: a longer chord hides the rate in noise

_LEVEL_SAMPLES, _LEVEL_SAMPLES_MOST = 8, 1024

_RESOLVED = 4.0  # noise ranges


@dataclass(frozen=True)
class Motion:
    """The last motion of a record: its first sample, or one before it, and how far it came.

    ``reach`` is its greatest distance from the last sample; times ``sign`` it is positive in
    the direction from which the channel came.  ``turned`` is true where it begins with a turn.
    """

    first: int
    sign: float
    reach: float
    turned: bool


def last_motion(place: Floats, band: float) -> Motion | None:
    """The last motion, searched backwards from the last sample; None without motion.

    Examples
    --------
    >>> last_motion(np.array([5.0, 0.0, 1.0, 2.0]), 0.1)
    Motion(first=1, sign=-1.0, reach=2.0, turned=True)
    """
    end = place[-1]
    distant = last_sample(lambda part: np.abs(place[part] - end) > band, 0, place.size, place)
    if distant is None:
        return None
    sign, reach = float(np.sign(place[distant] - end)), -np.inf
    for stop in range(place.size, 0, -BLOCK):
        back = sign * (place[max(stop - BLOCK, 0) : stop] - end)[::-1]
        # a missing sample is no turn
        reached = np.fmax(np.fmax.accumulate(back), reach)
        release_pages(place)
        turned = np.flatnonzero(reached - back > band)
        if turned.size:
            at = int(turned[0])
            return Motion(stop - at, sign, float(reached[at]), turned=True)
        reach = float(reached[-1])
    return Motion(0, sign, reach, turned=False)


@dataclass(frozen=True)
class _Approach:
    """An approach to a standstill.

    Parameters
    ----------
    end : int
        Its last sample, which is the first sample of the standstill.
    stroke : float
        Distance from its far end to the standstill. [unit of the channel]
    rate : float
        Mean rate, positive. [unit of the channel / s]
    """

    end: int
    stroke: float
    rate: float


def find_approach(
    time: Floats, values: Floats, *, begin: int, first: int, last: int, noise_range: float
) -> _Approach | None:
    """Where a channel that comes to a standstill ends its approach and begins to settle.

    Parameters
    ----------
    time, values : ndarray, shape (n_samples,)
        Record, NaN where a sample is missing. [s], [any unit]
    begin : int
        First sample after the previous standstill. [1]
    first, last : int
        Samples in which the channel certainly stands. [1]
    noise_range : float
        Range of the channel due to noise alone. [unit of the channel]

    Returns
    -------
    approach : _Approach or None
        None where noise hides it or the record does not show it.

    Notes
    -----
    The time of a relaxation counts from when the constraint is first obtained ([1]_).  The
    approach ends at the first sample from which the channel stays within 2 % of the stroke of
    the standstill (10 % beyond it) and moves, over the next chord, at less than a tenth of the
    mean rate of the approach.  The chord is the shortest over which noise cannot move that far.
    A sharp end, found up to a fifth of a chord too early, is put where the lines before and
    after it meet.  After an overshoot the approach ends where the channel turns.

    Examples
    --------
    A pull of 15 s to one centimetre short of 1 m, which then takes some seconds:

    >>> time = np.arange(0.0, 60.0, 0.5)
    >>> place = np.where(time < 15, 0.066 * time, 1 - 0.01 * np.exp(-(time - 15) / 3))
    >>> found = find_approach(time, place, begin=0, first=60, last=119, noise_range=1e-6)
    >>> print(time[found.end], round(found.stroke, 2), round(found.rate, 3))
    15.0 1.0 0.066
    """
    level = _early_level(values[first : last + 1])
    before = values[begin : first + 1]
    low, high = finite_extremes(before)
    extent = max(high - level, level - low)
    if not extent > _RESOLVED * noise_range:
        return None
    motion = None
    for share in (NEAR_SHARE, OVERRUN_SHARE):  # a small last motion settles back from the approach
        if motion is None or motion.reach < OVERRUN_SHARE * extent:
            band = max(share * extent, noise_range)
            motion = last_motion(np.append(before, level), band) or motion
    if motion is None:
        return None
    start = begin + motion.first
    near = max(NEAR_SHARE * motion.reach, noise_range / 2)

    def distance(part: slice) -> Floats:
        return np.asarray(motion.sign * (values[part] - level))

    far = last_sample(lambda part: distance(part) >= motion.reach - near, start, first + 1, values)
    over = max(OVERRUN_SHARE * motion.reach, near)

    def is_away(part: slice) -> Bools:
        left = distance(part)
        return np.asarray((left > near) | (left < -over))

    away = last_sample(is_away, start, first + 1, values)
    if far is None or away is None:
        return None
    (travelled,) = distance(slice(far, far + 1)) - distance(slice(away, away + 1))
    duration = time[away] - time[far]
    if not (travelled > 0 and duration > 0):  # the ramp is one step of the log
        step = min(away + 1, first)
        travelled, duration = motion.reach, time[step] - time[far]
        if not duration > 0:
            return None
    rate = float(travelled / duration)
    chord = min(noise_range / (2 * SLOW_SHARE * rate), _LONGEST_CHORD * motion.reach / rate)
    # far within one step of the log, two adjacent rows: an encoder does not move either
    chord = max(chord, float(np.median(np.diff(time[far : first + 1]))) / 2)
    # longest time that the rest within the near band can take at more than the slow rate
    latest = min(time[first] + near / (SLOW_SHARE * rate) + chord, time[last])
    stop = int(np.searchsorted(time[: last + 1], latest + chord, side="right")) + 1
    known = away + 1 + np.flatnonzero(np.isfinite(values[away + 1 : min(stop, last) + 1]))
    if known.size < 2:
        return _Approach(min(away + 1, first), motion.reach, rate)
    seconds, left = time[known], motion.sign * (values[known] - level)
    ahead = np.maximum(np.searchsorted(seconds, seconds + chord), np.arange(known.size) + 1)
    ahead = np.minimum(ahead, known.size - 1)
    passed = seconds[ahead] - seconds
    slow = left - left[ahead] < SLOW_SHARE * rate * passed
    slow &= (passed > 0) & (seconds <= latest)
    end = int(known[np.argmax(slow)]) if slow.any() else first
    end = _at_corner(time, values, end, start, last, chord, rate)
    end = _after_cut_step(motion.sign * values[: last + 1], end, noise_range)
    return _Approach(end, motion.reach, rate)


def _at_corner(
    time: Floats, values: Floats, end: int, start: int, last: int, chord: float, rate: float
) -> int:
    """First sample after the point where the lines of a chord before and after the end meet.

    Noise makes the end early, by the share of a chord that the slow rate is of the last rate,
    or twice that; an end farther off is left as it is.
    """
    low, high = np.searchsorted(time[: last + 1], [time[end] - 0.8 * chord, time[end] + 2 * chord])
    low, high = max(int(low), start), min(int(high), last + 1)
    seconds, place = time[low:high] - time[end], values[low:high]
    known = np.isfinite(place)
    rising = known & (seconds <= 0)
    if np.count_nonzero(rising) < _FEWEST_ON_LINE or not np.ptp(seconds[rising]) > 0:
        return end
    slope, level = np.polyfit(seconds[rising], place[rising], 1)
    early = chord * min(2 * SLOW_SHARE * rate / max(abs(slope), SLOW_SHARE * rate), 1.0)
    standing = known & (seconds >= early)
    if np.count_nonzero(standing) < _FEWEST_ON_LINE or not np.ptp(seconds[standing]) > 0:
        return end
    later_slope, later_level = np.polyfit(seconds[standing], place[standing], 1)
    if slope == later_slope:
        return end
    meets = float(np.clip((later_level - level) / (slope - later_slope), 0.0, early))
    corner = int(np.searchsorted(time[: last + 1], time[end] + meets))
    return min(max(corner, end), last)


def _after_cut_step(left: Floats, end: int, noise_range: float) -> int:
    """One sample later, where the channel moves on by more than noise and then stops at once.

    Where a ramp stops between two samples, the part of a step left may be so small that it passes
    for slow.  Settling continues for longer than one step, or after a step that was cut.
    """
    steps = -np.diff(left[max(end - 2, 0) : end + 1])
    if steps.size == 2 and steps[1] < _WHOLE * steps[0] - noise_range:
        return end
    later = left[end + 1 : end + 1 + _LEVEL_SAMPLES]
    if later.size < _LEVEL_SAMPLES or not np.isfinite(later).all():
        return end
    ahead = float(left[end] - np.median(later))
    unknown = _FROM_NOISE * noise_range
    stands = abs(later[0] - np.median(later[1:])) < max(SLOW_SHARE * ahead, unknown)
    return end + 1 if ahead > unknown and stands else end


_WHOLE = 0.8  # share of the previous step: a shorter one was cut off by the end of the ramp

_FROM_NOISE = 0.25  # of its range: three of its deviations

_FEWEST_ON_LINE = 4


def _early_level(held: Floats) -> float:
    """Median of the first tenth of a standstill, which may begin with the end of its approach."""
    n_early = max(held.size // 10, min(held.size, _LEVEL_SAMPLES))
    early = held[: n_early : max(n_early // _LEVEL_SAMPLES_MOST, 1)]
    return finite_median(early)


def corner_in_noise(
    time: Floats, values: Floats, *, begin: int, first: int, last: int, noise_range: float
) -> int | None:
    """First sample of a standstill behind a ramp that noise hides; None if the ramp goes on.

    Parameters
    ----------
    time, values : ndarray, shape (n_samples,)
        Record, NaN where a sample is missing. [s], [any unit]
    begin : int
        Sample of the previous standstill, or the first of the record. [1]
    first, last : int
        First and last sample that noise does not tell from the standstill. [1]
    noise_range : float
        Range of the channel due to noise alone. [unit of the channel]

    Returns
    -------
    corner : int or None
        ``first`` where the channel does not come from another level, or from far beyond noise. [1]

    Notes
    -----
    A line and a level that meet at a corner are fitted by least squares to the second half of the
    ramp and as much time behind it as the whole ramp takes.  If one line through all of them fits
    as well, an interval that is shorter than the ramp is part of it.

    Examples
    --------
    A ramp of 20 s to 100 N with a noise of 5 N stands from 20 s on, and not in the middle:

    >>> time = np.arange(0.0, 60.0, 0.5)
    >>> load = np.minimum(5 * time, 100) + np.random.default_rng(0).normal(0, 5, time.size)
    >>> one = corner_in_noise(time, load, begin=0, first=30, last=119, noise_range=60.0)
    >>> print(float(time[one]))
    20.5
    >>> print(corner_in_noise(time, load, begin=0, first=20, last=28, noise_range=60.0))
    None
    """
    arrives = values[begin : last + 1]
    level = _early_level(arrives[first - begin :])
    from_level = arrives[np.isfinite(arrives)][:3].mean()
    sign = np.sign(level - from_level)
    if not _FROM_NOISE * noise_range < abs(level - from_level) <= 2 * _RESOLVED * noise_range:
        return first
    halfway = (level + from_level) / 2
    below = last_sample(lambda part: sign * (values[part] - halfway) < 0, begin, first + 1, values)
    stop = min(2 * first - begin, last) + 1
    start = begin if below is None or stop - below <= 2 * _FEWEST_ON_LINE else below + 1
    known = start + np.flatnonzero(np.isfinite(values[start:stop]))
    known = known[np.diff(time[known], prepend=-np.inf) > 0]
    known = known[:: max(known.size // _LEVEL_SAMPLES_MOST, 1)]
    if known.size < 2 * _FEWEST_ON_LINE:
        return first
    seconds, place = (one[known] - one[known].mean() for one in (time, values))
    # sums over the ramp before a corner at each reading; at the last one it is one line through all
    count, since = np.arange(1.0, known.size + 1), np.cumsum(seconds)
    ramp = since - count * seconds
    square = np.cumsum(seconds**2) - seconds * (since + ramp)
    product = np.cumsum(seconds * place) - seconds * np.cumsum(place)
    left = (place @ place - product[2:] ** 2 / (square - ramp**2 / known.size)[2:]).clip(0)
    best = int(np.argmin(left[:-2]))
    if (left[-1] - left[best]) * (known.size - 3) > _CORNER * left[best]:
        return int(known[best + 2])
    seen = np.count_nonzero(np.isfinite(values[start:first]))
    return first if last - first > 2 * seen else None


_CORNER = 12.0  # F of one more constant: 0.1 % of straight ramps of a hundred readings exceed it
