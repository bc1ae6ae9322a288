"""Levels, speeds and shapes that a log shows, for comparison with the stated ones.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.2 (frequency, mean load, load amplitude).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reduction.record.arrays import evenly_spread, finite_median
from reduction.record.measurement import Bools, Floats, Integers, read_only_arrays
from reduction.record.samples import (
    finite_extremes,
    first_sample,
    last_sample,
    sample_blocks,
    take_samples,
)
from reduction.stages.cycles.cycle_product import Cycles
from reduction.stages.cycles.loop_sense import waveform_of_log
from reduction.stages.cycles.reversals import find_reversals
from reduction.stages.load_at_slack import stands_at_slack_length
from reduction.stages.standstills import Standstills

_MOST_CYCLES = 40  # that are examined, spread over the test

_NEXT = 2.0  # of a cycle: the next one begins within this if all are logged

_MOST_POINTS = 4000  # of a record without cycles


@dataclass(frozen=True)
@read_only_arrays
class TestLevels:
    """Levels of one test; arrays by specimen, NaN where the log does not show them.

    Parameters
    ----------
    frequency : float
        Number of cycles over their time. [Hz]
    speed : float
        Speed of the crosshead on the way out. [m s-1]
    slack_position : float
        Position of the crosshead at its first slack rest. [m]
    waveform : str
        Shape of the driven channel: ``triangular``, ``sinusoidal``, ``other`` where it is far
        from both, empty where it may be one of them.
    mean_tension, tension_amplitude : ndarray, shape (n_specimens,)
        Medians over the cycles. [N]
    lead : ndarray, shape (n_specimens,)
        Time by which tension leads position, at equal strain: zero for any elastic curve. [s]
    strain_per_length : ndarray, shape (n_specimens,)
        Range of the measured strain over that of position; negative where one falls
        while the other rises. [m-1]
    slack_strain : ndarray, shape (n_specimens,)
        Measured strain at the first slack rest. [1]
    final_share : ndarray, shape (n_specimens,)
        Tension at the end of the record, still stretched, over the greatest. [1]
    n_strokes : int
        Number of consecutive rises and falls of position by more than a quarter of its range,
        less the holds where these take most of the time: a line pulled from hold to hold does not
        cycle, one that dwells at its turns does.
    ends_in_pull : bool
        Whether the last rise of position leads to a quarter more tension than any before it: the
        cycles before it were bedding-in.
    is_copy : ndarray of bool, shape (n_specimens,)
        Mask of specimens whose tension equals that of an earlier one in every reading.
    load_step : ndarray, shape (n_specimens,)
        Step in which tension was logged, if there are few of them in its range. [N]
    like_means : ndarray, shape (n_specimens, 3)
        Mean tension of the first, middle and last of the cycles between equal positions; NaN where
        they are few, or where a slack rest after them shows the zero of the load. [N]
    mean_ramps : ndarray, shape (n_specimens, 3)
        Mean tension of the first and the last cycle by the straight line through all, if the
        means follow the line and the machine allows it: it drives the load, or the
        middle of its stroke moves in the same way. Also the growth of half the range of tension
        over the same cycles. NaN elsewhere. [N]
    valley_position : float
        Median over the cycles, if most have the same; NaN for a log of several levels. [m]
    valley_tension, valley_strain : ndarray, shape (n_specimens,)
        Tension and measured strain there. [N] and [1]
    stood_tension : ndarray, shape (2,)
        Mean tension of the specimens when the crosshead came to stand, and in the longest hold at
        constant tension, if it stood from then to that hold while the tension changed; else NaN.
        [N]
    """

    __test__ = False  # a test of a tether, not of this software

    frequency: float
    speed: float
    slack_position: float
    waveform: str
    mean_tension: Floats
    tension_amplitude: Floats
    lead: Floats
    strain_per_length: Floats
    slack_strain: Floats
    final_share: Floats
    n_strokes: int
    ends_in_pull: bool
    is_copy: Bools
    load_step: Floats
    like_means: Floats
    mean_ramps: Floats
    valley_position: float
    valley_tension: Floats
    valley_strain: Floats
    stood_tension: Floats


def levels_of_test(
    time: Floats,
    position: Floats,
    tension: Floats,
    measured_strain: Floats | None,
    standstills: Standstills,
    cycles: Cycles | None,
    *,
    control: str,
) -> TestLevels:
    """Levels of a test from its record and its cycles.

    Parameters
    ----------
    time, position : ndarray, shape (n_samples,)
        [s], [m]
    tension : ndarray, shape (n_specimens, n_samples)
        [N]
    measured_strain : ndarray, shape (n_specimens, n_samples), or None
        [1]
    standstills : Standstills
        Standstills of the record.
    cycles : Cycles or None
        Cycles of the record, if there are any.
    control : str
        ``position`` or ``load``, the channel that the machine drives.

    Returns
    -------
    levels : TestLevels
        Levels as found; nothing is compared here.

    Notes
    -----
    Levels are those of [1]_, medians over some forty cycles, so that a long log takes no longer.

    Examples
    --------
    A stroke of 2 m in 20 s, with a tension of 100 N/m:

    >>> from reduction.record.settings import PhaseSettings
    >>> from reduction.stages.standstills import find_standstills
    >>> time = np.arange(0, 60, 0.5)
    >>> position = np.interp(time, [20, 40, 60], [0, 2, 2])
    >>> stands = find_standstills(time, position, [100 * position], settings=PhaseSettings())
    >>> found = levels_of_test(
    ...     time, position, 100 * position[None], None, stands, None, control="position")
    >>> print(round(found.speed, 3), found.final_share)
    0.1 [1.]
    """
    n_specimens = tension.shape[0]
    nothing = np.full(n_specimens, np.nan)
    mean, amplitude, lead = nothing.copy(), nothing.copy(), nothing.copy()
    frequency = speed = np.nan
    waveform = ""
    like_means, mean_ramps = np.full((2, n_specimens, 3), np.nan)
    valley_position, valley_tension, valley_strain = np.nan, nothing, nothing
    if cycles is not None and cycles.n_cycles:
        some = evenly_spread(np.arange(cycles.n_cycles), _MOST_CYCLES)
        frequency = 1 / _period(take_samples(time, cycles.first), take_samples(time, cycles.last))
        peak, valley = cycles.branch_last[some, 0], cycles.branch_first[some, 0]
        rise = take_samples(position, peak) - take_samples(position, valley)
        # a cycle that a machine counted without a stroke reaches its peak in zero time
        with np.errstate(divide="ignore", invalid="ignore"):
            rates = np.abs(rise) / (take_samples(time, peak) - take_samples(time, valley))
        speed = finite_median(rates)
        for index, load in enumerate(tension):
            rows = [_of_cycle(time, position, load, int(cycles.first[one]), int(cycles.last[one]))
                    for one in some]  # fmt: skip
            known = np.array([row for row in rows if np.isfinite(row).all()])
            if known.size:
                mean[index], amplitude[index], lead[index] = np.median(known, axis=0)
        lowest = take_samples(position, valley)
        alike = np.abs(lowest - np.median(lowest)) <= _LIKE_VALLEY * np.median(np.abs(rise))
        if alike.mean() > _MOST_ALIKE:
            valley_position = float(np.median(lowest))
            valley_tension = np.median(take_samples(tension, valley), axis=-1)
            if measured_strain is not None:
                valley_strain = np.median(take_samples(measured_strain, valley), axis=-1)
        middles = (lowest + take_samples(position, peak)) / 2
        if control == "position" and not _rests_after(standstills, int(cycles.last[-1])):
            like = _alike(middles, rise)
            like_means = np.array([_three_means(load, cycles, some[like]) for load in tension])
        mean_ramps = np.array([
            _mean_ramp(load, cycles, some, None if control == "load" else middles)
            for load in tension
        ])  # fmt: skip
        waveform = _waveform(time, tension if control == "load" else position[None], cycles)
    else:
        speed = _speed(time, position)
    rests = np.flatnonzero(standstills.is_rest)
    turns = _turns(position, least=5 * standstills.position_tolerance)
    return TestLevels(
        frequency=frequency,
        speed=speed,
        slack_position=float(standstills.mean_position[rests[0]]) if rests.size else np.nan,
        waveform=waveform,
        mean_tension=mean,
        tension_amplitude=amplitude,
        lead=lead,
        strain_per_length=_strain_per_length(position, measured_strain, n_specimens),
        slack_strain=nothing if measured_strain is None or not rests.size else np.array([
            finite_median(one[standstills.first[rests[0]] : standstills.last[rests[0]] + 1])
            for one in measured_strain
        ]),
        final_share=_final_share(position, tension),
        n_strokes=_n_strokes(time, turns, standstills),
        ends_in_pull=_ends_in_pull(position, tension, turns),
        is_copy=np.array([
            any(_is_copy(tension[index], tension[before]) for before in range(index))
            for index in range(n_specimens)
        ], dtype=np.bool_),
        load_step=np.array([_load_step(load) for load in tension]),
        like_means=like_means,
        mean_ramps=mean_ramps,
        valley_position=valley_position,
        valley_tension=valley_tension,
        valley_strain=valley_strain,
        stood_tension=_stood_tension(position, tension, standstills),
    )  # fmt: skip


_OF_HOLD = 0.02  # of the tension of the hold: a controller comes to its load within this

_SEEN = 4.0  # times the tolerance of position, within which the stop is found


def _stood_tension(position: Floats, tension: Floats, standstills: Standstills) -> Floats:
    """Tension at the stop of the crosshead and in the hold, where only the position was held."""
    nothing = np.full(2, np.nan)
    if standstills.tension_tolerance is None or standstills.is_rest.all():
        return nothing
    samples = standstills.last - standstills.first
    hold = int(np.argmax(np.where(standstills.is_rest, -1, samples)))
    place, tolerance = standstills.mean_position[hold], standstills.position_tolerance
    before = int(standstills.first[hold])
    moved = last_sample(
        lambda part: np.abs(position[part] - place) > tolerance, 0, before, position
    )
    stopped = 0 if moved is None else moved + 1
    at_stop = tension[:, stopped : stopped + 4]
    # where the load comes to its level first, a specimen that creeps moves the crosshead on
    if stopped == before or not np.isfinite(at_stop).any():
        return nothing
    pair = np.array([np.nanmean(at_stop), np.nanmean(standstills.mean_tension[:, hold])])
    change = abs(pair[1] - pair[0])
    # what the crosshead moved before it stopped, to change the load by as much
    loads = pair[0] - change
    less = last_sample(lambda part: tension[:, part].mean(axis=0) < loads, 0, stopped, tension)
    is_seen = less is not None and abs(position[less] - place) > _SEEN * tolerance
    return pair if is_seen and change > _OF_HOLD * pair[1] else nothing


def _is_copy(one: Floats, other: Floats) -> bool:
    """Whether two series have equal samples; most differ in the first block."""
    return all(
        np.array_equal(one[part], other[part], equal_nan=True)
        for part in sample_blocks(one.size, one, other)
    )


_LIKE_POSITION = 0.02  # of the stroke

_LIKE_VALLEY, _MOST_ALIKE = 0.1, 0.75  # of the stroke; of the cycles

_FEWEST_LIKE = 8  # cycles, not counting the first


def _rests_after(standstills: Standstills, last: int) -> bool:
    """Whether the record is slack, or no longer than at slack, after its cycles."""
    slack = stands_at_slack_length(standstills, standstills.is_rest)
    return bool((slack & (standstills.first >= last)).any())


def _period(begin: Floats, end: Floats) -> float:
    """Median time of a cycle, including the dwell at the valley between two cycles.

    Where only some cycles are logged, or only one, that of the cycle itself.

    Examples
    --------
    >>> print(_period(np.array([0.0, 10.0, 20.0]), np.array([8.0, 18.0, 28.0])))
    10.0
    """
    own = float(np.median(end - begin))
    between = np.diff(begin)
    whole = between[between < _NEXT * own]
    return float(np.median(whole)) if 2 * whole.size > between.size else own


def _alike(middle: Floats, stroke: Floats) -> Bools:
    """Mask of cycles between the most common positions."""
    usual = np.nanmedian(stroke)
    near = np.maximum(np.abs(middle - np.nanmedian(middle)), np.abs(stroke - usual))
    return np.asarray(near <= _LIKE_POSITION * abs(usual))


def _three_means(load: Floats, cycles: Cycles, some: Integers) -> Floats:
    """Mean tension of the first, middle and last quarter of some cycles without the first one."""
    some = some[1:]
    if some.size < _FEWEST_LIKE - 1:
        return np.full(3, np.nan)
    means = np.array(
        [finite_median(load[cycles.first[one] : cycles.last[one] + 1]) for one in some]
    )
    n, part = means.size, max(means.size // 4, 1)
    middle = (n - part) // 2
    return np.array([
        means[:part].mean(), means[middle : middle + part].mean(), means[-part:].mean()
    ])  # fmt: skip


_ON_LINE = 0.98  # of the variance of the means: steps between levels are farther from a line


def _mean_ramp(
    load: Floats, cycles: Cycles, some: Integers, middles: Floats | None
) -> tuple[float, float, float]:
    """Mean tension of the first and last cycle, if it ramps in a way that no specimen causes.

    Also the growth of half the range of the cycles between them.
    """
    loads = [load[cycles.first[one] : cycles.last[one] + 1] for one in some]
    means = np.array([finite_median(one) for one in loads])
    rows = np.stack([means] if middles is None else [means, middles])
    if means.size < _FEWEST_LIKE or not np.isfinite(rows).all() or not np.ptp(rows, axis=1).all():
        return (np.nan,) * 3
    along = np.corrcoef(some, rows)[0, 1:]
    if (along**2 < _ON_LINE).any() or np.ptp(np.sign(along)):
        return (np.nan,) * 3
    slope, start = np.polyfit(some, means, 1)
    halves = [np.subtract(*finite_extremes(one)[::-1]) / 2 for one in loads]
    grows = np.polyfit(some, halves, 1)[0] * (some[-1] - some[0])
    return float(start + slope * some[0]), float(start + slope * some[-1]), float(grows)


def _of_cycle(
    time: Floats, position: Floats, load: Floats, first: int, last: int
) -> tuple[float, float, float]:
    """Mean and amplitude of tension, and its lead over position."""
    at = slice(first, last + 1)
    t, x, force = time[at], position[at], load[at]
    known = np.isfinite(x) & np.isfinite(force)
    if known.sum() < 4 or not t[known][-1] > t[known][0]:  # rows of a log may be repeated
        return (np.nan,) * 3
    t, x, force = t[known], x[known], force[known]
    low, high = float(force.min()), float(force.max())
    # the loop due to a delay, in any wave and for any elastic curve, has an area of the delay times
    # the integral of both rates. The fundamental over time has a phase if a curve is pulled
    # and released at two speeds
    period = float(t[-1] - t[0])
    x, force = (one - np.interp(t, t[[0, -1]], one[[0, -1]]) for one in (x, force))
    moved, steps = np.diff(x), np.diff(t)
    area = float(np.sum((force[1:] + force[:-1]) / 2 * moved))
    rates = float(np.sum((np.diff(force) * moved)[steps > 0] / steps[steps > 0]))
    lead = float(np.arctan2(2 * np.pi / period * area, rates) / (2 * np.pi) * period)
    return (low + high) / 2, (high - low) / 2, lead


def _waveform(time: Floats, driven: Floats, cycles: Cycles) -> str:
    """Waveform of the driven channels, if all are alike."""
    found = {waveform_of_log(time, one, cycles) for one in driven}
    return found.pop() if len(found) == 1 else ""


def _some(n_samples: int) -> slice:
    """Samples spread over a record."""
    return slice(None, None, max(1, n_samples // _MOST_POINTS))


_FEWEST_POINTS = 4  # on the way out; a log that begins at its greatest length has none


def _speed(time: Floats, position: Floats) -> float:
    """Median speed of the crosshead on the way out. [m s-1].

    The way back is not part of a pull, and may be at any rate.
    """
    some = _some(time.size)
    t, x = time[some], position[some]
    known = np.isfinite(t) & np.isfinite(x)
    t, x = t[known], x[known]
    out = int(np.argmax(x)) + 1 if x.size else 0
    if out > _FEWEST_POINTS:
        t, x = t[:out], x[:out]
    with np.errstate(divide="ignore", invalid="ignore"):
        rate = np.abs(np.diff(x) / np.diff(t))
    rate = rate[np.isfinite(rate)]
    moving = rate[rate > 0.2 * np.quantile(rate, 0.98)] if rate.size else rate
    return float(np.median(moving)) if moving.size else np.nan


_FEWEST_STEPS, _MOST_STEPS = 5, 50  # over the range of tension

_WHOLE = 0.05  # of a step: distance of a level from a multiple of it that is allowed


def _load_step(load: Floats) -> float:
    """Step of a tension that has few levels, all multiples of it; else NaN. [N]."""
    levels = np.unique(load[_some(load.size)])
    levels = levels[np.isfinite(levels)]
    if not _FEWEST_STEPS <= levels.size <= _MOST_STEPS + 1 or load.size < 4 * levels.size:
        return np.nan
    steps = np.diff(levels)
    multiple = steps / steps.min()
    is_whole = (np.abs(multiple - np.round(multiple)) < _WHOLE).all()
    return (
        float(steps.min())
        if is_whole and np.ptp(levels) < 1.5 * _MOST_STEPS * steps.min()
        else np.nan
    )


def _strain_per_length(position: Floats, strain: Floats | None, n_specimens: int) -> Floats:
    """Slope of measured strain over position. [m-1]."""
    found = np.full(n_specimens, np.nan)
    some = _some(position.size)
    if strain is None:
        return found
    for index, stretch in enumerate(strain):
        x, y = position[some], stretch[some]
        known = np.isfinite(x) & np.isfinite(y)
        if known.sum() > 10 and np.ptp(x[known]) > 0:
            found[index] = np.polyfit(x[known], y[known], 1)[0]
    return found


def _turns(position: Floats, *, least: float) -> Integers:
    """Samples at which rises and falls of a quarter of the range end, of some spread over it."""
    some = np.arange(*_some(position.size).indices(position.size))
    known = some[np.isfinite(position[some])]
    if not known.size:
        return known
    stroke = position[known]
    return known[find_reversals(stroke, band=max(np.ptp(stroke) / 4, least))]


_MOSTLY_HELD = 0.5  # of the time between the first and the last turn


def _n_strokes(time: Floats, turns: Integers, standstills: Standstills) -> int:
    """Rises and falls between turns, less the holds where these take most of the time."""
    if turns.size < 2:
        return 0
    start, end = float(time[turns[0]]), float(time[turns[-1]])
    is_between = (standstills.start_time < end) & (standstills.end_time > start)
    held = float((standstills.end_time - standstills.start_time)[is_between].sum())
    n_holds = int((~standstills.is_rest).sum()) if held > _MOSTLY_HELD * (end - start) else 0
    return max(turns.size - 1 - n_holds, 0)


_MORE_IN_PULL = 1.25


def _ends_in_pull(position: Floats, tension: Floats, turns: Integers) -> bool:
    """Whether the last rise leads to much more tension than all before it."""
    if turns.size < 2:
        return False
    last = turns[-2] if position[turns[-1]] > position[turns[-2]] else turns[max(turns.size - 3, 0)]
    greatest = [
        (finite_extremes(load[:last])[1], finite_extremes(load[last:])[1]) for load in tension
    ]
    return all(after > _MORE_IN_PULL * before for before, after in greatest)


def _position_at(position: Floats, load: Floats, level: float) -> float:
    """Position at which a load first reaches a level."""
    place = first_sample(lambda part: load[part] >= level, 0, load.size, load)
    return np.nan if place is None else float(position[place])


_RISE = np.array([0.1, 0.5])  # of the greatest load: a pull has not yielded between these

_UNLOADED = 0.5  # of the stretch to the greatest load


def _final_share(position: Floats, tension: Floats) -> Floats:
    """Tension of the last twentieth over the greatest, if the crosshead stays out; else NaN.

    It does not if it returns by half of the elastic stretch to that load: a specimen that yields
    stays long when it is unloaded.
    """
    n_last = max(position.size // 20, 1)
    low, high = finite_extremes(position)
    lowest = finite_extremes(position[-n_last:])[0]
    if not low < low + 0.7 * (high - low) < lowest <= high:
        return np.full(tension.shape[0], np.nan)
    greatest = np.array([finite_extremes(one)[1] for one in tension])
    found = np.full(tension.shape[0], np.nan)
    for index, load in enumerate(tension[:, -n_last:]):
        known = load[np.isfinite(load)]
        if known.size and greatest[index] > 0:
            found[index] = float(np.median(known)) / greatest[index]
            foot, middle = (
                _position_at(position, tension[index], one) for one in _RISE * greatest[index]
            )
            elastic = (middle - foot) / (_RISE[1] - _RISE[0])
            if high - lowest > _UNLOADED * elastic > 0:
                found[index] = np.nan
    return found
