"""Duration of cycles, and its uncertainty.

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 4.3.7 (a value known to lie between limits).
"""

from __future__ import annotations

from functools import partial

import numpy as np
from scipy.ndimage import median_filter

from reduction.record.arrays import evenly_spread
from reduction.record.measurement import Bools, Floats, Integers
from reduction.record.samples import take_samples
from reduction.stages.cycles.cycle_product import Cycles
from reduction.stages.cycles.reading_noise import reading_noise

_FLANK = 8  # divisor of a branch: part on either side of its middle that gives its speed

_READINGS = 9  # of a flank, averaged to reduce noise

_STEEP = 0.25  # of the mean speed of a branch

_BEYOND_NOISE = 6

_IRREGULAR = 0.5  # of the branches have another amplitude than the one before

_OF_SECOND = 6 * 0.4549  # variance of a second difference, and the median of chi-square


def touching(cycles: Cycles) -> Bools:
    """Mark cycles that begin where the one before them ends.

    Examples
    --------
    >>> first, pair = np.array([0, 20, 50]), np.array([[0, 10], [20, 30], [50, 60]])
    >>> cycles = Cycles(first, first + 20, pair, pair + 10, np.ones((3, 2)), np.zeros(71),
    ...     np.zeros(71), np.zeros(71), 0.1)
    >>> print(touching(cycles))
    [False  True False]
    """
    return np.concatenate([[False], cycles.last[:-1] == cycles.first[1:]])


_OF_CYCLE = 0.5  # of its range: what a machine at rest does not move

_OF_GAP = 17  # readings of a gap


def gaps_that_move(driven: Floats, begin: Integers, peak: Integers, end: Integers) -> Integers:
    """Cycles followed by more than a rest: by one that is left out, or by a ramp.

    Examples
    --------
    >>> driven = np.array([0.0, 2, 0, 0, 0, 2, 0, 3, -4, 2, -4, -8, -8, -6, -8])
    >>> begin, peak = np.array([0, 4, 8, 12]), np.array([1, 5, 9, 13])
    >>> gaps_that_move(driven, begin, peak, peak + 1)
    array([1, 2])
    """
    gaps = np.flatnonzero(begin[1:] > end[:-1])
    first, length = end[gaps], begin[gaps + 1] - end[gaps]
    foot = take_samples(driven, first)
    highest, lowest = foot, foot
    for share in np.linspace(0, 1, _OF_GAP):
        level = take_samples(driven, first + np.rint(share * length).astype(first.dtype))
        highest, lowest = np.fmax(highest, level), np.fmin(lowest, level)
    own = np.abs(take_samples(driven, peak[gaps]) - foot)
    moving: Integers = gaps[highest - lowest > _OF_CYCLE * own]
    return moving


def counted_on_flanks(cycles: Cycles) -> tuple[Bools, Bools]:
    """Mark cycles that the machine counts from a point on their rise, or on their fall, on.

    Whether the only valley of the cycle is the one after its peak, or the one before it.

    Examples
    --------
    A cycle of 40 samples counted from the middle of its rise on:

    >>> first, pair = np.array([0]), np.array([[0, 10]])
    >>> cycles = Cycles(first, first + 40, pair, pair + [10, 20], np.ones((1, 2)), np.zeros(41),
    ...     np.zeros(41), np.zeros(41), 0.1, counted_by="machine counter")
    >>> print(*counted_on_flanks(cycles))
    [ True] [False]
    """
    if cycles.counted_by != "machine counter":
        return (np.zeros(cycles.n_cycles, dtype=bool),) * 2
    follows = touching(cycles)
    # of cycles that touch, the valley that two have in common may be found in either
    is_shared = follows | np.append(follows[1:], False)
    beside = np.where(is_shared, (cycles.last - cycles.first) // _SHARED_VALLEY, 0)
    on_rise = cycles.branch_last[:, 1] < cycles.last - beside
    return on_rise, ~on_rise & (cycles.branch_first[:, 0] > cycles.first + beside)


_SHARED_VALLEY = 12  # parts of a cycle


def spread_of_turns(turn: Floats, first: Integers, last: Integers, *, step: float) -> float:
    r"""Standard uncertainty of the time of one turn, from the scatter of the durations.

    .. math:: u^2 = \overline{(\Delta^2 t)^2} / 6

    Parameters
    ----------
    turn : ndarray, shape (n_cycles,)
        Beginning of each cycle. [s]
    first, last : ndarray of int, shape (n_cycles,)
        First and last samples: second differences are those of cycles that touch. [1]
    step : float
        Resolution of a turn: time between samples if a turn is a sample. [s]

    Returns
    -------
    spread : float
        At least that of the resolution, the step over the root of 12. [s]

    Notes
    -----
    Second differences exclude a period that changes slowly, and one error is in three of
    them with the weights 1, -2, 1.  Source of the resolution: [1]_.

    Examples
    --------
    >>> turns = np.arange(4000.0) + np.random.default_rng(1).normal(0, 0.02, 4000)
    >>> place = np.arange(4000)
    >>> print(round(spread_of_turns(turns, place, place + 1, step=0.0), 3))
    0.02
    """
    least = step / np.sqrt(12)
    touch = last[:-1] == first[1:]
    second = np.diff(turn, n=2)[touch[:-1] & touch[1:]]
    if second.size == 0:
        return float(least)
    return float(np.hypot(least, np.sqrt(np.mean(second**2) / 6)))


def time_of_sample(duration: Floats, cycles: Cycles) -> Floats:
    r"""Standard uncertainty of a time that is known to one sample, uniformly distributed.

    .. math:: u(t) = \Delta t / \sqrt{12}

    Parameters
    ----------
    duration : ndarray, shape (n_cycles,)
        Duration of each cycle. [s]
    cycles : Cycles
        Cycles whose samples are counted.

    Returns
    -------
    spread : ndarray, shape (n_cycles,)
        [s]

    Notes
    -----
    Source: [1]_.

    Examples
    --------
    >>> one, pair = np.array([0]), np.array([[0, 10]])
    >>> cycles = Cycles(one, one + 20, pair, pair + 10, np.ones((1, 2)), np.zeros(21), np.zeros(21),
    ...     np.zeros(21), 0.1)
    >>> print(time_of_sample(np.array([20.0]), cycles).round(4))
    [0.2887]
    """
    return np.asarray(duration / (cycles.last - cycles.first) / np.sqrt(12))


def is_alone(cycles: Cycles, n_samples: int) -> bool:
    """Whether a log is one cycle that a machine stored, without a reading before or after."""
    is_whole = cycles.first[0] == 0 and cycles.last[-1] == n_samples - 1
    return bool(cycles.n_cycles == 1 and is_whole and cycles.counted_by == "machine counter")


def periods_alone(
    time: Floats, driven: Floats, cycles: Cycles, *, is_sine: bool, noise: float
) -> tuple[Integers, Floats, Floats]:
    r"""Period, and spread of one end, of each cycle that is followed by a gap of the log.

    .. math:: x(t) = c + a \cos \omega t + b \sin \omega t

    Parameters
    ----------
    time, driven : ndarray, shape (n_samples,)
        Time, and the channel that the machine moves. [s], [m] or [N]
    cycles : Cycles
        From `reduction.stages.cycles.cycle_search`.
    is_sine : bool
        Whether the wave is a sine: its period is fitted, with its phase. [-]
    noise : float
        Standard deviation of one reading of the driven channel. [m] or [N]

    Returns
    -------
    place : ndarray of int, shape (n_alone,)
        Cycles that do not adjoin another. [1]
    period, spread : ndarray, shape (n_alone,)
        [s]

    Notes
    -----
    The last reading of a stored cycle is up to a sample before its end, the first up to one
    after its beginning.  The levels of ramps show the difference d of the two distances: their sum
    is between d and two samples less d.  A machine that counts its cycles, and has run on from one
    that is stored to the next, shows the period by their number and their time.

    Examples
    --------
    Ten seconds of 0.1 Hz, with the last reading at 9.5 s:

    >>> time = np.append(np.arange(20) * 0.5, 200.0)
    >>> one, pair = np.array([0]), np.array([[0, 10]])
    >>> cycles = Cycles(one, one + 19, pair, np.array([[10, 19]]), np.ones((1, 2)), np.zeros(21),
    ...     np.zeros(21), np.zeros(21), 0.1)
    >>> wave = -np.cos(0.2 * np.pi * time)
    >>> print(periods_alone(time, wave, cycles, is_sine=True, noise=0.0)[1].round(6))
    [10.]
    >>> ramps = 5 - np.abs(time % 10 - 5)
    >>> print(periods_alone(time, ramps, cycles, is_sine=False, noise=0.0)[1].round(6))
    [10.]
    """
    touch = touching(cycles)
    after = np.minimum(cycles.last + 1, time.size - 1)
    steps = (take_samples(time, cycles.last) - take_samples(time, cycles.first)) / (
        cycles.last - cycles.first
    )
    is_cut = take_samples(time, after) - take_samples(time, cycles.last) > _GAP * steps
    if is_sine:  # readings behind its end tell nothing that the fit does not
        begins_next = np.append(cycles.first[1:], cycles.last[-1])
        wait = take_samples(time, begins_next) - take_samples(time, cycles.last)
        is_cut |= wait > _GAP * steps * np.fmax(begins_next - cycles.last, 1)
    # so is the last of them, and one that is a whole log
    is_last = after == cycles.last
    is_last[-1:] |= is_sine
    is_cut |= is_last & (is_cut.any() | is_alone(cycles, time.size))
    place = np.flatnonzero(~touch & ~np.append(touch[1:], False) & is_cut)
    period, spread = np.empty((2, place.size))
    counted, n_counted = _periods_by_count(time, cycles)
    for row, one in enumerate(place.tolist()):
        begin, peak, end = cycles.first[one], cycles.branch_last[one, 0], cycles.last[one]
        at, level = time[begin : end + 1] - time[begin], driven[begin : end + 1]
        known = np.isfinite(level)
        duration, step = at[-1], steps[one]
        if -step / 2 < counted[one] - duration < _OF_STEPS * step:
            period[row], spread[row] = counted[one], step / np.sqrt(12) / n_counted[one]
            continue
        if is_sine:
            period[row], spread[row] = _fitted_period(at[known], level[known], duration)
            if abs(period[row] - duration - step / 2) < _OF_STEPS * step:
                continue
        back = level[-1] - level[0]  # remainder of the fall, or of the next rise
        # the reading at the peak may be half a sample from it
        (near, stop) = (peak + 1, end) if back > 0 else (peak - 1, begin)
        with np.errstate(divide="ignore", invalid="ignore"):
            speed = (driven[near] - driven[stop]) / abs(time[stop] - time[near])
            extra = min(abs(back) / speed, step) if speed > 0 else 0.0
        period[row] = duration + step
        spread[row] = np.hypot((step - extra) / np.sqrt(3), noise / speed if speed > 0 else step)
    return place, period, spread


def _periods_by_count(time: Floats, cycles: Cycles) -> tuple[Floats, Integers]:
    """Time from each cycle to the next one stored, over their distance in the machine's count."""
    if cycles.count is None or not cycles.is_count_sure or cycles.n_cycles < 2:
        return np.full(cycles.n_cycles, np.nan), np.ones(cycles.n_cycles, dtype=np.intp)
    begins, n_between = take_samples(time, cycles.first), np.diff(cycles.count)
    # the last one has the period of the one before it
    pairs = np.append(np.arange(n_between.size), n_between.size - 1)
    return (np.diff(begins) / n_between)[pairs], n_between[pairs]


def _fitted_period(at: Floats, level: Floats, period: float) -> tuple[float, float]:
    """Period of a sine near a given one, and its standard uncertainty from the residuals."""
    own = np.inf
    for _ in range(_FITS):
        phase = 2 * np.pi * at / period
        terms = np.column_stack([np.ones(at.size), np.cos(phase), np.sin(phase)])
        _, cosine, sine = np.linalg.lstsq(terms, level)[0]
        of_rate = at * (sine * terms[:, 1] - cosine * terms[:, 2])
        terms = np.column_stack([terms, of_rate])
        found, *_ = np.linalg.lstsq(terms, level)
        left = level - terms @ found
        # residuals of a wave that is not a pure sine are correlated over a large part of the cycle
        alike = max(at.size / _PARTS, 1.0)
        variance = float(left @ left) / max(at.size - 4, 1) * alike
        own = np.sqrt(variance * np.linalg.pinv(terms.T @ terms)[3, 3])
        own *= period**2 / (2 * np.pi)
        period = 2 * np.pi / (2 * np.pi / period + found[3])
    return float(period), float(own)


_GAP = 3.0  # steps between readings of a cycle: a longer wait is a gap of the log

_OF_STEPS = 2.0  # from the middle of the sample with which a stored cycle ends

_FITS = 4

_PARTS = 8  # of a cycle: residuals of a fit have one sign over such a part


def own_periods(
    time: Floats, driven: Floats, cycles: Cycles, duration: Floats, *, noise: float
) -> tuple[Floats, Floats]:
    r"""Period of each cycle from flank to flank, and the spread of one time.

    .. math:: P = t_{k+1} - t_k, \qquad u(t) = \sigma / |\dot x|

    Parameters
    ----------
    time, driven : ndarray, shape (n_samples,)
        Time, and the channel that the machine moves. [s], [m] or [N]
    cycles : Cycles
        From `reduction.stages.cycles.cycle_search`.
    duration : ndarray, shape (n_cycles,)
        From turn to turn, used where the flanks are unusable. [s]
    noise : float
        Standard deviation of one reading of the driven channel. [m] or [N]

    Returns
    -------
    period, spread : ndarray, shape (n_cycles,)
        With the standard uncertainty of the time at one of its ends. [s]

    Notes
    -----
    A turn is known to a sample, and noise shifts it ([1]_); the middle of a flank passes a
    level within the noise over its speed.  The period of a cycle is the mean of the time from its
    rise to the next one and of that to its fall from the one before; for the last of a row the
    latter only.  Beside a cycle that is longer or shorter by a quarter it is the time from turn to
    turn.

    Examples
    --------
    Ramps of 10.4 samples; from turn to turn 21 or 20, from flank to flank 20.8:

    >>> time = np.arange(110.0)
    >>> wave = 1 - np.abs((2 * time / 20.8) % 2 - 1)
    >>> valley, peak = np.array([0, 21, 42, 62, 83]), np.array([10, 31, 52, 73])
    >>> cycles = Cycles(valley[:-1], valley[1:], np.stack([valley[:-1], peak], axis=1),
    ...     np.stack([peak, valley[1:]], axis=1), np.ones((4, 2)), np.zeros(110), np.zeros(110),
    ...     np.zeros(110), 0.1)
    >>> period, _ = own_periods(time, wave, cycles, np.diff(valley) * 1.0, noise=0.0)
    >>> print(period.round(6))
    [20.8 20.8 20.8 20.8]
    """
    period, spread = np.array(duration), time_of_sample(duration, cycles)
    alone, *of_alone = periods_alone(time, driven, cycles, is_sine=False, noise=noise)
    period[alone], spread[alone] = of_alone
    follows = _follow(time, driven, cycles, duration)
    if follows.any() and not follows[1:].all():
        follows[1:] |= _last_as_long(time, driven, cycles)
    touch = np.flatnonzero(follows)
    if not touch.size:
        return period, spread
    # a rest before the next cycle is part of the wave
    begins = take_samples(time, cycles.first)
    duration = np.append(np.where(follows[1:], np.diff(begins), duration[:-1]), duration[-1:])
    period[touch - 1] = duration[touch - 1]
    flanks = partial(_flank_to_flank, time, driven, noise)

    def between(column: int) -> tuple[Floats, Floats, Bools]:
        """From each flank to that of the cycle before."""
        begin, end = cycles.branch_first[:, column], cycles.branch_last[:, column]
        found, own, usable = flanks((begin + end) // 2, begin, end, touch)
        if not usable.all():  # where a wave dwells, the middle of a branch may not be on a flank
            found, own, usable = flanks(_half_way(driven, begin, end), begin, end, touch)
        return found, own, usable

    (rise, of_rise, has_rise), (fall, own, has_fall) = between(0), between(1)
    period[touch[has_fall]], spread[touch[has_fall]] = fall[has_fall], own[has_fall]
    of_fall = spread.copy()
    # a channel that creeps passes a level earlier on the way up and later on the way down
    both = has_rise & has_fall
    period[touch[has_rise] - 1], spread[touch[has_rise] - 1] = rise[has_rise], of_rise[has_rise]
    period[touch[both] - 1] = (rise[both] + fall[both]) / 2
    spread[touch[both] - 1] = np.hypot(of_rise[both], own[both]) / 2
    # where the flanks change, the errors of both remain in a sum of periods
    last = np.setdiff1d(touch, touch - 1)
    spread[last] = np.hypot(spread[last - 1], np.sqrt(2) * of_fall[last])
    second = np.diff(period[touch - 1])
    jitter = np.sqrt(np.median(second**2) / _OF_SECOND) if second.size else 0.0
    of_jitter = np.full(spread.shape, jitter)
    of_jitter[last] *= _OF_LAST
    # a flank beside a cycle of another speed belongs to that one
    on_flanks = _of_other_speeds(period)
    on_flanks[1:] |= on_flanks[:-1].copy()  # the last of a row has one flank of its own
    other = on_flanks & _of_other_speeds(duration)
    period[other], of_jitter[other] = duration[other], 0.0
    spread[other] = time_of_sample(duration, cycles)[other]
    return period, np.maximum(spread, of_jitter)


def _of_other_speeds(period: Floats) -> Bools:
    """Cycles that last clearly longer or shorter than one beside them."""
    least = np.minimum(period[1:], period[:-1])
    apart: Bools = np.abs(np.diff(period)) > _OTHER_SPEED * least
    found: Bools = np.append(False, apart) | np.append(apart, False)
    return found


_OTHER_SPEED = 0.25  # of the shorter period, as between levels of a log

_OF_LAST = np.sqrt(5)  # ratio of a sum that ends with its fall only to one with both flanks

_ALIKE = 0.02  # of a cycle with its rest: spread of rests that are a part of the wave

_ONE_MORE = 1.1  # readings, of a log whose steps are not quite equal


def _last_as_long(time: Floats, driven: Floats, cycles: Cycles) -> Bools:
    """Mark cycles that last, from rise to rise, as long as those that touch the next one.

    A dwell near the shortest standstill counts as a rest after some cycles, as part of others.
    """
    begin, end = cycles.branch_first[:, 0], cycles.branch_last[:, 0]
    step = np.diff(take_samples(time, _half_way(driven, begin, end)))
    touch = touching(cycles)[1:]
    if not touch.any():
        return touch
    usual = float(np.median(step[touch]))
    return np.asarray(np.abs(step - usual) <= _ALIKE * usual)


def _follow(time: Floats, driven: Floats, cycles: Cycles, duration: Floats) -> Bools:
    """Mark cycles that touch the one before, or follow a rest that all of them have."""
    rest = take_samples(time, cycles.first[1:]) - take_samples(time, cycles.last[:-1])
    usual = float(np.median(rest)) if rest.size else 0.0
    step = float(np.median(duration / (cycles.last - cycles.first)))
    # of equal rests, some have a reading more than others
    spread = max(_ALIKE * (usual + float(np.median(duration))), _ONE_MORE * step)
    alike = np.abs(rest - usual) <= spread
    # a wait without readings is a gap of the log, which may contain other cycles
    alike &= rest / np.maximum(cycles.first[1:] - cycles.last[:-1], 1) <= _GAP * step
    begin, peak, end = cycles.branch_first[:, 0], cycles.branch_last[:, 0], cycles.branch_last[:, 1]
    alike[gaps_that_move(driven, begin, peak, end)] = False
    return np.asarray(touching(cycles) | np.concatenate([[False], alike]))


def _flank_to_flank(
    time: Floats,
    driven: Floats,
    noise: float,
    middle: Integers,
    begin: Integers,
    end: Integers,
    touch: Integers,
) -> tuple[Floats, Floats, Bools]:
    """Time between the flanks of touching branches, spread of one time, and whether usable.

    Both flanks are taken at one level, about the middle of each; each at its own half way if the
    ends of most differ by more than the error of a corner, as when amplitudes change.
    The mean of readings about the middle lies on the flank, with less noise and rounding.
    """
    reach = np.maximum((end - begin) // _FLANK, 1)
    low, high = np.maximum(middle - reach, begin), np.minimum(middle + reach, end)
    share = np.linspace(0, 1, _READINGS)[:, None]
    about = np.rint(low + share * (high - low)).astype(middle.dtype)
    readings = take_samples(driven, about)
    known = np.isfinite(readings)
    n_known = np.maximum(known.sum(axis=0), 1)
    at, level = (
        np.where(known, one, 0.0).sum(axis=0) / n_known
        for one in (take_samples(time, about), readings)
    )
    n_apart = np.minimum(n_known, high - low + 1)[touch]
    rise = take_samples(driven, high) - take_samples(driven, low)
    ends = take_samples(driven, np.stack([begin, end]))
    whole = ends[1] - ends[0]
    half_way = ends.mean(axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        speed = rise / (take_samples(time, high) - take_samples(time, low))
        steep = speed * (take_samples(time, end) - take_samples(time, begin)) / whole > _STEEP
        apart = level[touch] - level[touch - 1]
        alike = np.abs(apart) < _STEEP * np.abs(whole[touch])
        # one level for cycles alike: of a level for each pair, what a flank bends would add up
        per_reading = np.abs(rise / (high - low))
        usual = median_filter(level, _LEVELS_ALIKE, mode="nearest")
        usual = np.clip(usual, level - per_reading / 2, level + per_reading / 2)
        common = (usual[touch] + usual[touch - 1]) / 2
        step = per_reading[touch]
        missed = step + _BEYOND_NOISE * noise
        is_other = np.abs(ends[:, touch] - ends[:, touch - 1]).max(axis=0) > missed
        at_one_level, at_half_way = (
            np.subtract(*(at[one] + shift / speed[one] for one, shift in (
                (touch, later), (touch - 1, earlier))))
            for later, earlier in (
                tuple(common - level[one] for one in (touch, touch - 1)),
                tuple(half_way[one] - level[one] for one in (touch, touch - 1)),
            )
        )  # fmt: skip
        # a corner has an error of up to half a step, so half way has up to a quarter
        of_step = step / 4 / np.sqrt(3) / np.abs(speed[touch])
        # a single odd end, as beside a hold, may come from a machine that rounds the others
        of_way = np.abs(at_one_level - at_half_way) / np.sqrt(12)
        is_irregular = is_other.mean() > _IRREGULAR
        found = at_half_way if is_irregular else at_one_level
        beside = of_step if is_irregular else np.where(is_other, of_way, 0.0)
        own = np.hypot(noise / np.sqrt(n_apart) / np.abs(speed[touch]), beside)
    return found, own, steep[touch] & steep[touch - 1] & alike & (found > 0)


_LEVELS_ALIKE = 11  # cycles, over which a slow change of level is none


def _half_way(driven: Floats, begin: Integers, end: Integers) -> Integers:
    """First sample of each branch that is half way from its beginning to its end."""
    found = begin.copy()
    for row, (first, last) in enumerate(zip(begin.tolist(), end.tolist(), strict=True)):
        branch = driven[first : last + 1] - (driven[first] + driven[last]) / 2
        found[row] += int(np.argmax(branch * np.sign(branch[-1]) >= 0))
    return found


_REACH = 10  # cycles to either side, over which the period of a sine is taken as constant

_STEADY = 1e-3  # of the period, from one cycle to the next

_PLACES = 40  # that are examined, spread over the test

_ODD = 0.05  # of the places


def change_of_period(time: Floats, driven: Floats, cycles: Cycles) -> float:
    r"""Relative change of the period from one cycle to the next, where it persists.

    The median of the changes above a thousandth and above the sampling, as in a frequency sweep;
    0 where these, with one sign, are less than a twentieth of the places examined.

    Notes
    -----
    For times :math:`t` at which a rise is half way up, ten cycles before a cycle and ten after
    it (fewer in a short test): :math:`t_{k+m} - 2 t_k + t_{k-m} = m^2 \dot P`.  Each is known to
    a sample, and to the noise of a reading over the speed of the rise.

    Examples
    --------
    >>> from reduction.record.settings import CycleSettings, PhaseSettings
    >>> from reduction.stages.cycles.cycle_search import (find_cycles)
    >>> from reduction.stages.standstills import find_standstills
    >>> time = np.arange(0, 400, 0.1)
    >>> def changes(wave):
    ...     stands = find_standstills(time, wave, wave[None], settings=PhaseSettings())
    ...     cycles = find_cycles(time, wave, wave[None], stands, settings=CycleSettings())
    ...     return round(change_of_period(time, wave, cycles), 3)
    >>> print(changes(np.cos(time)), changes(np.cos(500 * np.expm1(time / 500))))
    0.0 -0.008
    """
    reach = min(_REACH, (cycles.n_cycles - 1) // 2)
    if reach < 1:
        return 0.0
    parted = np.cumsum(~touching(cycles))
    middle = np.arange(reach, cycles.n_cycles - reach)
    middle = middle[parted[middle + reach] == parted[middle - reach]]
    if not middle.size:
        return 0.0
    rows = evenly_spread(middle, _PLACES) + reach * np.array([[-1], [0], [1]])
    rise = (cycles.branch_first[:, 0], cycles.branch_last[:, 0])
    at = _half_way(driven, *(one[rows.ravel()] for one in rise)).reshape(rows.shape)
    before, half_way, after = take_samples(time, at)
    period = (after - before) / (2 * reach)
    change = (after - 2 * half_way + before) / (reach**2 * period)
    step = (take_samples(time, at) - take_samples(time, np.maximum(at - 1, 0))).max(axis=0)
    begin, end = (one[rows[1]] for one in rise)
    with np.errstate(divide="ignore", invalid="ignore"):
        speed = np.subtract(*(take_samples(driven, one) for one in (end, begin)))
        speed /= np.subtract(*(take_samples(time, one) for one in (end, begin)))
        spread = 2 * step + _BEYOND_NOISE * reading_noise(driven) / np.abs(speed)
    goes_on = np.abs(change) > _STEADY + spread / (reach**2 * period)
    # a cycle with a wait is met from before and from behind, with opposite signs
    share = abs(np.sum(np.sign(change[goes_on]))) / goes_on.size
    return float(np.median(change[goes_on])) if share > _ODD else 0.0
