r"""Loops of tension against strain: one row of dynamic quantities per cycle and specimen.

Quantities that need the samples of a cycle (its energy, fundamental, levels at its turns) are
measured in blocks of whole cycles.  All other quantities, the correction of drift from cycle to
cycle, and the effect of noise and missed turns follow from these alone.

References
----------
.. [1] CG-D-39-80, sec. 2.2: apparent spring constant (eq. 1) and hysteresis (eq. 4).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import NamedTuple

import numpy as np

from reduction.record.arrays import evenly_spread, run_blocks
from reduction.record.measurement import Bools, Floats, Integers
from reduction.record.samples import (
    empty_like,
    release_pages,
    rounding_left,
    step_that_fills,
    take_samples,
)
from reduction.record.settings import Control, Waveform
from reduction.stages.cycles.cycle_product import (
    PLACE_OF_DRIFT,
    WITHIN_STEP,
    Cycles,
    Loops,
    drift_at_peaks,
    drift_not_placed,
)
from reduction.stages.cycles.fundamental import (
    CycleBasis,
    bridge_gaps,
    cycle_basis,
    fundamental,
    mean_period,
    part_means,
    sine_period,
    turn_over_cycle,
    without_turning,
)
from reduction.stages.cycles.loop_energy import (
    energy_by_chance,
    energy_of_cycles_missed_by_polygon,
    energy_of_rounding,
    loop_energy,
    without_drift,
    work_at_equal_phase,
)
from reduction.stages.cycles.peaks_and_valleys import (
    EITHER_WAY,
    extremes_of_cycles,
    noise_of_corners,
    peaks_and_valleys,
    share_of_rise,
    take_noise_off_levels,
    turns_of_wave,
    way_of_series,
)
from reduction.stages.cycles.periods import (
    counted_on_flanks,
    is_alone,
    own_periods,
    time_of_sample,
    touching,
)
from reduction.stages.cycles.reading_noise import (
    FEW_READINGS,
    noise_and_step,
    noise_beside_sine,
    reading_noise,
    scatter_over_cycles,
)
from reduction.stages.cycles.turns import Turn


def _are_parted(cycles: Cycles) -> bool:
    """Whether rests separate most cycles from the next one."""
    follows = touching(cycles)
    return bool(2 * np.count_nonzero(follows) < follows.size - 1)


def _drift_between_rests(top: Floats, valley: Floats, ends: Floats, number: Integers) -> Floats:
    """Steady drift of a series over each cycle where a rest separates it from the next one.

    The drift is that of the middle between turns, since a mean over the cycle may hold more or less
    of its rests.  The median of three steps is taken: a first cycle after a ramp is not typical.
    Cycles that the machine counted but did not store add their time between two cycles.

    Examples
    --------
    Cycles of 6 s every 10 s, each 2 higher than the last:

    >>> ends = np.array([[0.0], [1], [5], [6]]) + np.arange(0, 40, 10)
    >>> top, valley = 9 + 2 * np.arange(4.0), 2 * np.arange(4.0)
    >>> print(_drift_between_rests(top, valley, ends, np.arange(4)))
    [1.2 1.2 1.2 1.2]
    >>> print(_drift_between_rests(top, valley, ends, 100 * np.arange(4)))
    [0.02 0.02 0.02 0.02]
    """
    middle, duration = (top + valley) / 2, ends[3] - ends[0]
    if middle.size < 2:
        return np.zeros(middle.size)
    apart = np.fmax(np.diff(ends[0]), np.diff(number) * duration[:-1])
    steps = np.diff(middle) / apart
    beside = np.clip(np.arange(middle.size) - 1, 0, max(steps.size - 3, 0))
    rate = np.median([steps[np.minimum(beside + one, steps.size - 1)] for one in range(3)], axis=0)
    return np.asarray(np.nan_to_num(rate * duration, nan=0.0))


def _mean_drift(means: Floats, ends: Floats) -> Floats:
    """Steady drift of a series over each cycle, from its means across the ends of cycles.

    Notes
    -----
    A mean from the middle of one rise to the middle of the next, or from fall to fall, is
    that of a period.  The average of the two is centred on the end of a cycle, and the change from
    one end to the next is the drift.  At such a middle the series is near its mean, so one sample
    more or less, as noise shifts the turns, has no effect; in a mean from turn to turn it counts
    with the whole amplitude.  Near a transient (the first cycle after a ramp, a change of
    amplitude) one of these changes is not typical of this cycle: the median of three neighbours
    is taken, and of two the lesser, or zero where they disagree in sign.

    Examples
    --------
    Means that grow by 2 a cycle, and a transient in the first cycle of four:

    >>> ends = np.array([[0.0], [2], [6], [8]]) + np.arange(0, 32, 8)
    >>> print(_mean_drift(np.tile(2 * np.arange(4.0), (3, 1)), ends))
    [2. 2. 2. 2.]
    >>> print(_mean_drift(np.array([[9.0, 5, 5, 5], [6, 5, 5, 5], [5, 5, 5, 5]]), ends))
    [0. 0. 0. 0.]
    """
    n_cycles = means.shape[1]
    if n_cycles < 3:
        return np.zeros(n_cycles)
    times = np.diff(ends, axis=0)
    low, mid, high = means * times
    from_rise = mid[:-1] + high[:-1] + low[1:]
    from_fall = high[:-1] + low[1:] + mid[1:]
    around_end = from_rise / (times[1, :-1] + times[2, :-1] + times[0, 1:])
    around_end += from_fall / (times[2, :-1] + times[0, 1:] + times[1, 1:])
    around_end /= 2
    around_end[ends[3, :-1] != ends[0, 1:]] = np.nan
    change = np.full(n_cycles, np.nan)
    change[1:-1] = np.diff(around_end)
    beside = np.stack([np.append(np.nan, change[:-1]), change, np.append(change[1:], np.nan)])
    n_known = np.isfinite(beside).sum(axis=0)
    drift = np.where(n_known == 3, np.median(beside, axis=0), change)
    two = n_known == 2
    pair = np.sort(beside[:, two], axis=0)[:2]  # NaN is sorted last
    lesser = np.where(np.abs(pair[0]) < np.abs(pair[1]), pair[0], pair[1])
    drift[two] = np.where(pair[0] * pair[1] > 0, lesser, 0.0)
    # an end of a run has no change of its own: that of its neighbour is the best estimate
    touches = np.isfinite(around_end)
    of_next = np.append(np.where(touches, drift[1:], np.nan), np.nan)
    of_last = np.append(np.nan, np.where(touches, drift[:-1], np.nan))
    own = np.where(np.isfinite(change), drift, np.nan)
    found = np.where(np.isfinite(own), own, np.where(np.isfinite(of_next), of_next, of_last))
    return np.nan_to_num(found, nan=0.0)


def _own_drift(
    driven: Floats,
    answer: Floats,
    cycles: Cycles,
    of_neighbours: Floats,
    of_driven: Floats,
    *,
    noises: tuple[float, float],
) -> tuple[Floats, Bools, Floats]:
    """Drift of the answering channel over each cycle, whether it is its own, and what it may miss.

    After a ramp or a hold the first cycles creep or relax more than later ones.  Their drift is
    measured from the first eighth of a cycle to that of the next one, at the same level of the
    driven channel, so that a turn found one sample off, or a valley that the machine misses, does
    not count as drift.  Of later ones it is the lesser of the changes at their valleys and at the
    peaks beside theirs: where the amplitude or the loss angle settles, these move towards each
    other.  A run of up to three cycles has no later ones: the drift of its last cycle is that of
    its fall from the one before, which friction left in the ramp does not change, and of a single
    cycle that from its first valley to its last.  Where a later cycle shows a drift that is not
    clear, the neighbours' is kept, and the difference is what it may miss.

    Examples
    --------
    Cycles that end 0.2 higher than they begin, except the first, which ends 1 higher:

    >>> angle = 2 * np.pi * np.arange(161) / 40
    >>> tension = -np.cos(angle)
    >>> strain = tension + np.interp(np.arange(161), [0, 40, 160], [0, 1, 1.6])
    >>> first = np.arange(0, 160, 40)
    >>> ends = np.column_stack([first, first + 20])
    >>> cycles = Cycles(first, first + 40, ends, ends + 20, np.ones((4, 2)),
    ...     np.zeros(161, np.int32), np.zeros(161, np.int8), np.zeros(161, bool), 0.1)
    >>> drift, own, _ = _own_drift(tension, strain, cycles, np.full(4, 0.2), np.zeros(4),
    ...     noises=(2e-2, 2e-2))
    >>> print(drift[[0, 3]].round(2), own[[0, 3]])
    [0.95 0.2 ] [ True False]
    """
    drifts, is_own = of_neighbours.copy(), np.zeros(cycles.n_cycles, dtype=bool)
    missed = np.zeros(cycles.n_cycles)
    begins = np.flatnonzero(~touching(cycles))
    for start, stop in zip(begins.tolist(), [*begins[1:].tolist(), cycles.n_cycles], strict=True):
        # one or two cycles that are stored alone show no drift of their means, however many are
        is_alone = stop - start <= _ALONE
        is_short = cycles.n_cycles <= _SHORT_RUN or is_alone
        if is_short:
            drifts[start:stop] = 0.0
        for place in range(start, min(start + _SHORT_RUN, stop if is_short else stop - 1)):
            is_last, is_later = place == stop - 1, place > start
            if is_last and not is_later:
                drift, slope, spread = _from_valley_to_valley(driven, answer, cycles, place)
            else:
                drift, slope, spread = _from_turn_to_turn(
                    driven, answer, cycles, place, of_driven[place],
                    is_first=not is_later, is_last=is_last,
                )  # fmt: skip
            error = np.hypot(noises[1], slope * noises[0]) * spread
            # curvature with readings elsewhere in the cycle, and what settles in the fall alone
            share = float(cycles.last[place] - cycles.first[place]) ** -2.0
            share = _OF_SETTLING if is_last and is_later else share
            error = np.hypot(
                error, share * np.ptp(answer[cycles.first[place] : cycles.last[place] + 1])
            )
            beyond = np.abs(drift) - np.abs(drifts[place])
            is_own[place] = beyond > 0 and _CLEAR_DRIFT * error < (
                beyond if is_later else np.abs(drift)
            )
            if is_own[place]:
                drifts[place] = drift
            elif is_later:
                missed[place] = np.nan_to_num(np.abs(drift - drifts[place]))
            elif is_alone:
                missed[place] = np.abs(drift) if np.isfinite(drift) else error
            if not is_own[place] and not is_short:
                break
    return drifts, is_own, missed


def _from_turn_to_turn(
    driven: Floats,
    answer: Floats,
    cycles: Cycles,
    place: int,
    of_driven: float,
    *,
    is_first: bool,
    is_last: bool,
) -> tuple[float, float, float]:
    """Drift over one cycle by eighths of cycles beside its turns; else as `_from_valley_to_valley`.

    Beside its valleys, of the first cycle of a run on their rises alone, of the last one on their
    falls alone; of others also at the peaks of the cycles before and after it.
    """
    near = slice(place - is_last, place + 2 - is_last)
    length = int((cycles.last - cycles.first)[near].min())
    ahead = 1 if is_last else length // _OF_GAP + 1
    behind = 0 if is_first else length // _OF_GAP
    rises = np.stack([cycles.first, cycles.branch_last[:, 0]])
    falls = np.stack([cycles.branch_first[:, 1], cycles.last])
    if is_first or is_last:
        # the first valley may be anywhere in the rest before the cycles, the last one in that
        # behind them; else the other one is moved, into the record
        beside = rises if is_first else falls
        places = beside[0 if is_first else 1, near].astype(np.float64)
        apart = np.diff(_middles(driven, beside[:, near])) - np.diff(places)
        late, early = np.append(-apart, apart).clip(0)
        places += [late, early] if is_first else [-early, -late]
        turns = [(places, 1)]
    else:
        before = slice(place - 1, place + 1)
        middles = _middles(driven, falls[:, before]) + _middles(driven, rises[:, near])
        valleys = cycles.first[place] + np.array([0.0, np.diff(middles)[0] / 2])
        ends = slice(place - 1, place + 2, 2)
        middles = _middles(driven, rises[:, ends]) + _middles(driven, falls[:, ends])
        peaks = rises[1, place - 1] + np.array([0.0, np.diff(middles)[0] / 2])
        turns = [(valleys, 1), (peaks, 2)]
    found, slopes = [], []
    for at, n_cycles in turns:
        level, other = (
            _readings_at(series, at[:, None] + np.arange(-behind, ahead))
            for series in (driven, answer)
        )
        slopes.append(_slope(level - level.mean(axis=1, keepdims=True), other))
        missed, drift = (float(np.diff(one.mean(axis=1))[0]) for one in (level, other))
        by_driven = slopes[-1] * (missed - n_cycles * of_driven)
        found.append(_at_one_level(drift, by_driven, most=_OF_DRIVEN) / n_cycles)
    # of what dies away, the peaks before have more; what settles moves the two apart
    lesser = min(found, key=abs) if min(found) * max(found) > 0 or len(found) == 1 else 0.0
    lesser = lesser if np.isfinite(found).all() else np.nan
    return lesser, slopes[0], float(np.sqrt(2 / (ahead + behind)))


def _middles(series: Floats, branches: Integers) -> Floats:
    """Where each of two branches, from turn to turn, passes the middle of both. [samples].

    Between two readings: one sample more or less, where noise decides which reading is the first
    beyond it, would shift the series by most of what it moves beside its turns.  NaN where a
    branch does not pass it.
    """
    level = series[branches].mean()
    places = []
    for begin, end in branches.T.tolist():
        apart = series[begin : end + 1] - level
        passed = np.flatnonzero(apart[1:] * apart[0] <= 0)
        if not passed.size:
            return np.full(2, np.nan)
        after = int(passed[0]) + 1
        places.append(begin + after - apart[after] / (apart[after] - apart[after - 1]))
    return np.array(places)


def _readings_at(series: Floats, places: Floats) -> Floats:
    """A series at places between its readings, of which the first lies within it; NaN for NaN."""
    if not np.isfinite(places).all():
        return np.full(places.shape, np.nan)
    low, high = max(int(places.min()), 0), int(np.ceil(places.max())) + 1
    return np.interp(places, np.arange(low, low + series[low:high].size), series[low:high])


def _slope(apart: Floats, other: Floats) -> float:
    """Of a series over another one, of which the mean is taken off."""
    square = float(np.sum(apart**2))
    return float(np.sum(apart * other)) / square if square > 0 else 0.0


def _at_one_level(drift: float, of_driven: float, *, most: float) -> float:
    """Without what the driven channel misses; NaN where most of it is a drift of that channel."""
    found = drift - of_driven
    return found if np.abs(of_driven) < most * np.abs(found) else np.nan


def _from_valley_to_valley(
    driven: Floats, answer: Floats, cycles: Cycles, place: int
) -> tuple[float, float, float]:
    """Drift over one cycle by its own readings, slope of answer over driven, noise of the drift.

    Going forward from one valley and back from the next, rise and fall differ by a part that is
    odd in time; the rest at the valley is the drift.  If the peak has as much of it, it is
    friction, and the drift is NaN.
    """
    begin, peak, end = cycles.first[place], cycles.branch_last[place, 0], cycles.last[place]
    count = max(int(min(peak - begin, end - peak)) // _OF_CLOSING, _FEWEST_INSIDE)
    away = np.arange(count)
    odd = np.linalg.pinv((away[:, None] / count) ** [0, 1, 3])[0]
    level, other, by_friction = (
        float(odd @ (series[np.clip(before - away, 0, None)] - series[after + away]))
        for series, before, after in (
            (driven, end, begin), (answer, end, begin), (answer, peak, peak),
        )
    )  # fmt: skip
    # of a bent curve the slope beside the valleys counts
    beside = np.concatenate([begin + away, end - away])
    moved = driven[beside]
    slope = _slope(moved - moved.mean(), answer[beside])
    drift = _at_one_level(other, slope * level, most=_OF_DRIVEN / 2)
    drift = drift if np.abs(by_friction) < _OF_DRIFT * np.abs(other) else np.nan
    return drift, slope, np.sqrt(2) * float(np.linalg.norm(odd))


_CLEAR_DRIFT = 3.0  # of its standard uncertainty

_SHORT_RUN = 3  # cycles

_ALONE = 2  # cycles of a run among others: a drift of means needs three

_OF_GAP = 8  # part of a cycle, from its first turn on

_OF_CLOSING = 2  # part of a branch, beside its turns

_OF_DRIFT, _OF_DRIVEN = 0.6, 0.5  # greatest share due to friction, or to the driven channel

_OF_SETTLING = 0.003  # of the range


_OF_PERIOD = ("rise", "turn", "fall")


MEASURED = (
    "peak", "valley", "high", "low", "energy", "strain_step_norm", "force_cosine", "force_sine",
    "force_mean", "strain_cosine", "strain_sine", "strain_mean", "force_end", "strain_end",
    "force_rise", "force_turn", "force_fall", "strain_rise", "strain_turn", "strain_fall",
    "phase_work", "phase_sine", "phase_half",
    "force_top", "force_begin", "force_end_turn", "force_missed",
    "strain_top", "strain_begin", "strain_end_turn", "strain_missed", "energy_missed",
)  # fmt: skip
"""Sums over the samples of a cycle, in this order."""


@dataclass(frozen=True)
class _Shape:
    """Half range and middle of a wave, relative to the amplitude of its fundamental.

    One of each for every cycle where the wave changes from cycle to cycle.  ``missed`` is the width
    of the interval of the half range, from its change with the number of harmonics, up or down, and
    from their noise.
    """

    half: Floats | float = 1.0
    middle: Floats | float = 0.0
    missed: Floats | float = 0.0


_MOST_HARMONICS = 16


_MOST_OF_SHAPE = 0.06  # of an amplitude: what its harmonics add to the half range of a sine


_FINEST = 1e-3  # of a cycle, between phases


_CYCLES_OF_SHAPE, _SAMPLES_OF_SHAPE = 100, 400  # greatest number of cycles; samples of each


_FEWEST_INSIDE = 4


_OF_ONE_WAVE = 0.05  # of an amplitude


_ABOVE_NOISE = 4.0  # standard uncertainties of a harmonic


_OF_PARTS = ("cosine", "sine", "mean", "rise", "turn", "fall")


def _shape_of_wave(
    time: Floats,
    values: Floats,
    cycles: Cycles,
    period: Floats,
    parts: Floats,
    ends: Floats,
    *,
    turned: Floats | float = 0.0,
    rounding: float = 0.0,
) -> _Shape:
    """Shape of a wave by its harmonics, over some of its cycles together.

    ``turned`` [rad] is the change of its phase over each cycle; ``rounding`` is the standard
    uncertainty of each reading due to the steps of a converter.

    Notes
    -----
    The response to a sine is not a sine where the material is nonlinear or has a kink at its turns,
    and its extremes are those of the wave, not of the fundamental.  Noise does not raise a sum of
    harmonics as it raises the greatest of many readings.

    Examples
    --------
    A sine with turns sharpened by a third harmonic of a tenth:

    >>> t = np.arange(0, 100.5, 0.5)
    >>> wave = -np.cos(0.2 * np.pi * t) - 0.1 * np.cos(0.6 * np.pi * t)
    >>> first = np.arange(0, 200, 20)
    >>> pair = np.stack([first, first + 10], axis=1)
    >>> cycles = Cycles(first, first + 20, pair, pair + 10, np.ones((10, 2)), np.zeros(201),
    ...     np.zeros(201), np.zeros(201), 0.1)
    >>> parts = np.zeros((6, 10))
    >>> parts[0] = -1
    >>> middles = np.stack([first + place for place in (0, 5, 15, 20)]) * 0.5
    >>> shape = _shape_of_wave(t, wave, cycles, np.full(10, 10.0), parts, middles)
    >>> print(round(shape.half, 6), abs(round(shape.middle, 6)))
    1.1 0.0
    """
    cosine, sine, mean = parts[:3]
    drift = _mean_drift(parts[3:], ends)
    sine = sine + drift / np.pi
    amplitude = np.hypot(cosine, sine)
    known = np.flatnonzero(np.isfinite(amplitude + mean) & (amplitude > 0))
    # cycles of another amplitude belong to another wave, as the first one behind a ramp may
    usual = np.median(amplitude[known[known.size > 1 :]]) if known.size else np.nan
    known = known[np.abs(amplitude[known] - usual) < _OF_ONE_WAVE * usual]
    if known.size > _FEWEST_INSIDE:
        known = known[1:-1]  # neighbours of cycles of another amplitude may hold part of them
    elif known.size > 1:
        known = known[1:]  # drift after a ramp dies away within the cycle, unlike harmonics
    if not known.size:
        return _Shape()
    some = evenly_spread(known, _CYCLES_OF_SHAPE)
    # growth of a wave within its cycle adds harmonics, which raise its extremes
    before, after = np.diff(amplitude, prepend=np.nan), np.diff(amplitude, append=np.nan)
    lesser = np.where(np.abs(before) < np.abs(after), before, after)
    growth = np.where(before * after > 0, lesser / amplitude, 0.0)
    turns = np.broadcast_to(turned, amplitude.shape)

    def wave_of(one: int) -> tuple[Floats, Floats]:
        first, last = int(cycles.first[one]), int(cycles.last[one])
        part = slice(first, last + 1, max((last - first) // _SAMPLES_OF_SHAPE, 1))
        phase = 2 * np.pi * (time[part] - time[part.start]) / period[one]
        place = phase / (2 * np.pi) - 0.5
        level = (values[part] - mean[one] - drift[one] * place) / (1 + growth[one] * place)
        usable = np.isfinite(level)
        phase += turns[one] * place - np.arctan2(sine[one], cosine[one])
        return phase[usable], level[usable] / amplitude[one]

    phases, waves = zip(*map(wave_of, some.tolist()), strict=True)
    # a log synchronous with the period reads the same few phases of every cycle
    read = np.concatenate(phases) / (2 * np.pi) % 1
    order = min(_MOST_HARMONICS, int(1 / max(step_that_fills(read), _FINEST) - 2) // 2)
    if order < 2:
        return _Shape(missed=2 * _MOST_OF_SHAPE)
    orders = np.arange(1, order + 1)

    def terms(phase: Floats) -> Floats:
        angle = np.multiply.outer(phase, orders)
        return np.column_stack([np.ones(phase.size), np.cos(angle), np.sin(angle)])

    design, wave = terms(np.concatenate(phases)), np.concatenate(waves)
    of_wave = np.linalg.lstsq(design, wave, rcond=None)[0]
    spread = float(np.std(wave - design @ of_wave)) * np.sqrt(2 / wave.size)
    # with readings at the same phases, every cycle has the same error
    n_phases = min(wave.size, 1 / max(step_that_fills(read), _FINEST))
    per_harmonic = rounding / usual * np.sqrt(2 / n_phases)
    spread = float(np.hypot(spread, per_harmonic))
    size = np.hypot(of_wave[1 : order + 1], of_wave[order + 1 :])
    # each cycle has its own fundamental; harmonics within the noise are dropped, except the third,
    # which every curve that bends has, and which moves both extremes apart
    is_kept = ((size > _ABOVE_NOISE * spread) & (orders > 1)) | (orders == 3)
    weights = np.concatenate([[0.0], of_wave[1:] * np.tile(is_kept, 2)])
    weights[1] = 1.0
    lacks = (
        period[some] - (take_samples(time, cycles.last) - take_samples(time, cycles.first))[some]
    )
    if np.median(lacks / period[some]) > _FINEST:
        # if stored cycles end before they are complete, the harmonics alter their fundamental
        weights[:2] = of_wave[:2]
    curve = terms(np.linspace(0, 2 * np.pi, 721))
    # the sums of de la Vallee Poussin, which hardly overshoot where a wave falls at once, and keep
    # the lower half of the harmonics unchanged
    faded = np.clip(2 - 2 * orders / np.arange(max(order // 2, 1) + 1, order + 2)[:, None], 0, 1)
    faded = np.vstack([np.ones(order), faded])
    sums = curve @ (np.column_stack([np.zeros(len(faded)), np.tile(faded, 2)]) * weights).T
    half, middle, by_number = _half_range(sums)
    rounded = WITHIN_STEP * per_harmonic * np.sqrt(1 + np.count_nonzero(is_kept))
    by_noise = WITHIN_STEP * spread * np.sqrt(np.count_nonzero(is_kept & (orders % 2 == 1)))
    # a third harmonic that the readings do not show may be as large as the second
    not_shown = 2 * float(size[1]) if order == 2 else 0.0
    missed = float(np.linalg.norm([by_number, rounded, by_noise, not_shown]))
    rest = wave - of_wave[0] - design @ (np.append(0.0, np.tile(faded[-1], 2)) * weights)
    bins, of_bins = _beside_harmonics(read, rest, n_phases, rounding / usual, sums[:, -1])
    beside = np.zeros((bins.shape[0], 1))
    if of_bins and by_number > max(_NOT_SETTLED, of_bins):
        of_readings = _half_range(sums[:, -1:] + bins)
        # bins of half the width would change it as much again
        may_miss = float(np.hypot(2 * of_readings[2], of_bins))
        if may_miss < missed or abs(of_readings[0] - half) > missed / 2:
            half, middle, missed = *of_readings[:2], may_miss
            beside = bins[:, -1:]
    common = _Shape(half, middle, missed)
    # the shape may change with the specimen; growth between neighbours alters it as well
    step = np.fmax(np.abs(before), np.abs(after)) / amplitude
    some = evenly_spread(np.flatnonzero(step < _OF_ONE_WAVE)[1:-1], _CYCLES_OF_SHAPE)
    if not some.size:
        return common
    phases, waves = zip(*map(wave_of, some.tolist()), strict=True)
    own, error = _own_harmonics(phases, waves, of_wave, rounding=rounding / usual)
    if not own.size:
        return common
    of_cycle = np.repeat(weights[:, None], some.size, axis=1)
    changing = np.arange(2, own.shape[0] // 2 + 2)
    of_cycle[np.concatenate([changing, order + changing])] += own
    sums = curve @ (np.append(0.0, np.tile(faded[-1], 2))[:, None] * of_cycle) + beside
    low, high = sums.min(axis=0), sums.max(axis=0)
    number = np.arange(cycles.n_cycles)
    return _Shape(
        np.interp(number, some, (high - low) / 2),
        np.interp(number, some, (high + low) / 2),
        float(np.hypot(missed, WITHIN_STEP * error * np.sqrt(changing.size))),
    )


def _own_harmonics(
    phases: Sequence[Floats], waves: Sequence[Floats], of_wave: Floats, *, rounding: float
) -> tuple[Floats, float]:
    """Harmonics of each cycle beyond those of all, from the second on, and their uncertainty.

    Cosines, then sines, by cycle; as many as its readings show well.  None where the cycles are
    alike but for noise.

    Examples
    --------
    >>> phase = [np.linspace(0, 2 * np.pi, 20)] * 4
    >>> waves = [-np.cos(phase[0]) + size * np.cos(2 * phase[0]) for size in (0.1, 0.2, 0.2, 0.3)]
    >>> own, error = _own_harmonics(phase, waves, np.array([0, -1, 0.2, 0, 0, 0, 0]), rounding=0.0)
    >>> print(own[0].round(3) + 0.0, error < 1e-9)
    [-0.1  0.   0.   0.1] True
    """
    order = of_wave.size // 2
    highest = min(order, min(one.size for one in phases) // _READINGS_OF_ONE)
    none = np.empty((0, len(phases)))
    if highest < 2:
        return none, 0.0
    fitted = np.arange(1, highest + 1)
    own, variance = np.empty((2 * highest - 2, len(phases))), np.empty(len(phases))
    for index, (phase, wave) in enumerate(zip(phases, waves, strict=True)):
        angle = np.multiply.outer(phase, np.arange(1, order + 1))
        terms = np.column_stack([np.ones(phase.size), np.cos(angle), np.sin(angle)])
        design = terms[:, np.concatenate([[0], fitted, order + fitted])]
        left = wave - terms @ of_wave
        fit = np.linalg.lstsq(design, left, rcond=None)[0]
        own[:, index] = np.delete(fit, [0, 1, highest + 1])
        noise = float(np.sum((left - design @ fit) ** 2)) / (phase.size - fit.size)
        variance[index] = (noise + rounding**2) * 2 / phase.size
    error = float(np.sqrt(variance.mean()))
    return (none, 0.0) if np.mean(own**2) < (_ABOVE_NOISE * error) ** 2 else (own, error)


_READINGS_OF_ONE = 8  # of a cycle, for each of its own harmonics


def _half_range(curves: Floats) -> tuple[float, float, float]:
    """Half range and middle of the last of some curves, and twice how far the others differ."""
    low, high = curves.min(axis=0), curves.max(axis=0)
    half = (high - low) / 2
    missed = 2 * float(np.abs(half[-1] - half).max())
    return float(half[-1]), float(high[-1] + low[-1]) / 2, missed


_NOT_SETTLED = 0.01  # of an amplitude: what more harmonics change

_OF_BIN = 4  # readings

_MOST_BINS = 360

_SHOWN = 5.0  # standard errors of the mean of a bin


def _beside_harmonics(
    place: Floats, rest: Floats, n_phases: float, rounding: float, harmonics: Floats
) -> tuple[Floats, float]:
    """Means of readings less their harmonics in bins of a cycle, and the width of what they hide.

    A load that turns at once, as of friction, is not a sum of few harmonics: they overshoot beside
    the turn, where the readings are.  Two columns over the places of `_shape_of_wave`, of bins of
    twice the width and of single ones, with chords in place of the sum of ``harmonics`` between the
    few phases of a synchronous log; zero, with no width, where no bin differs from the harmonics by
    more than chance.
    """
    curve, width = np.zeros((721, 2)), 0.0
    n_bins = int(min(rest.size // _OF_BIN, _MOST_BINS, n_phases)) // 2 * 2
    for column, n in enumerate((n_bins // 2, n_bins)):
        if n < _MOST_HARMONICS:
            return np.zeros((721, 2)), 0.0
        number = np.minimum((place * n).astype(int), n - 1)
        count = np.maximum(np.bincount(number, minlength=n), 1)
        mean = np.bincount(number, rest, n) / count
        scatter = np.bincount(number, (rest - mean[number]) ** 2, n) / np.maximum(count - 1, 1)
        error = np.sqrt(np.median(scatter) / count + rounding**2)
        is_shown = np.abs(mean) > _SHOWN * error
        # what a bin does not show may be anything up to that
        width = WITHIN_STEP * _SHOWN / np.sqrt(3) * float(np.median(error)) * is_shown.any()
        # where few phases are read, those of a bin are not about its middle
        filled = np.unique(number)
        at = (np.bincount(number, place, n) / count)[filled]
        shown = np.where(is_shown, mean, 0.0)[filled]
        places = np.linspace(0, 1, harmonics.size)
        if n_phases < _MOST_BINS and is_shown.any():
            shown += np.interp(at, places, harmonics)
            curve[:, column] = np.interp(places, at, shown, period=1) - harmonics
        else:
            curve[:, column] = np.interp(places, at, shown, period=1)
    return curve, width


_IRREGULAR = 0.03  # median change of amplitude from one cycle to the next


def _change_of(amplitude: Floats) -> float:
    """Median change from one cycle to the next, over the median. [1]."""
    known = amplitude[np.isfinite(amplitude)]
    if known.size < _FEWEST_INSIDE:
        return 0.0
    return float(np.median(np.abs(np.diff(known))) / np.median(known))


class _Drifts(NamedTuple):
    """Drift of both channels over each cycle, NaN where it exceeds the range of the cycle.

    After a ramp, the channel that answers may drift more in a cycle than in those beside it
    (``of_neighbours``).  Where this drift is found (``is_own``), ``on_fall`` is its part on the way
    down, NaN elsewhere, ``in_phase`` the part of its transient in phase with the wave, and
    ``of_ramp`` what it may add to the range.  ``may_miss`` is a drift that is not clear of noise,
    or that no later cycle shows.
    """

    tension: Floats
    strain: Floats
    of_neighbours: Floats
    is_own: Bools
    may_miss: Floats
    on_fall: Floats
    of_ramp: Floats
    in_phase: Floats


def _drifts_of_cycles(
    row: Mapping[str, Floats],
    cycles: Cycles,
    ends: Floats,
    *,
    waveform: Waveform,
    is_load: bool,
    rise_shares: tuple[Floats | float, Floats | float],
    own_drift: Callable[[Floats, Floats], tuple[Floats, Bools, Floats]] | None,
) -> _Drifts:
    """Drift of tension and of strain over each cycle; ``row`` has the quantities of `MEASURED`."""
    is_parted = waveform != "sinusoidal" and _are_parted(cycles)
    on_rise, _ = counted_on_flanks(cycles)
    # the mean of a sine is fitted along with it, so one sample more or less does not change it
    parts = ("mean",) * 3 if waveform == "sinusoidal" else _OF_PERIOD
    tension, strain = (
        _drift_between_rests(
            row[f"{name}_top"],
            np.where(on_rise, row[f"{name}_end_turn"], row[f"{name}_begin"]),
            ends,
            cycles.number,
        )
        if is_parted
        else _mean_drift(np.stack([row[f"{name}_{part}"] for part in parts]), ends)
        for name in ("force", "strain")
    )
    of_neighbours = strain if is_load else tension
    own, may_miss = of_neighbours, np.zeros(cycles.n_cycles)
    is_own = np.zeros(cycles.n_cycles, bool)
    if own_drift is not None and not is_parted:
        own, is_own, may_miss = own_drift(of_neighbours, tension if is_load else strain)
    elif is_parted and cycles.n_cycles > 1 and not on_rise[0]:
        # the ramp before the first cycle is not before those that are stored later
        name = "strain" if is_load else "force"
        change = abs(row[f"{name}_end_turn"][0] - row[f"{name}_begin"][0])
        may_miss[0] = np.nan_to_num(max(change - abs(own[0]), 0.0))
    # the last cycle of a run has the drift of the one before, which may die away
    follows = touching(cycles)
    ends_run = np.flatnonzero(follows[1:] & follows[:-1] & ~np.append(follows[2:], False)) + 1
    may_miss[ends_run] += np.abs(of_neighbours[ends_run - 1] - of_neighbours[ends_run - 2])
    # of the drift after a ramp, the fall has at most its part of the drift of this cycle, and at
    # least that part of the drift of the next one
    falls = 1 - rise_shares[int(is_load)]
    on_fall = np.where(is_own, falls * (own + of_neighbours) / 2, np.nan)
    share = 1 / np.pi if waveform == "sinusoidal" else falls / 2
    beyond = np.where(is_own, own - of_neighbours, 0.0)
    of_ramp = share * np.where(is_own, np.abs(beyond), may_miss)
    # a transient that dies away within the first cycle has up to 1/pi of it in phase with the wave
    in_phase = np.where(touching(cycles), 0.0, beyond) / (2 * np.pi)
    if is_load:
        strain = own
    else:
        tension = own
    # drift above the range comes from a jump among the neighbours: no steady cycle is left
    ranges = row["peak"] - row["valley"], row["high"] - row["low"]
    tension, strain, of_neighbours = (
        np.where(np.abs(drift) > size, np.nan, drift)
        for drift, size in (
            (tension, ranges[0]), (strain, ranges[1]), (of_neighbours, ranges[int(is_load)])
        )
    )  # fmt: skip
    return _Drifts(tension, strain, of_neighbours, is_own, may_miss, on_fall, of_ramp, in_phase)


def _fundamentals(
    row: Mapping[str, Floats], drifts: _Drifts, is_load: bool
) -> tuple[tuple[Floats, Floats], tuple[Floats, Floats]]:
    """Cosine and sine of tension and of strain, without their drift."""
    force, strain = (
        [row[f"{name}_cosine"], row[f"{name}_sine"] + drift / np.pi]
        for name, drift in (("force", drifts.tension), ("strain", drifts.strain))
    )
    answer = strain if is_load else force
    answer[0] = answer[0] + drifts.in_phase
    return (force[0], force[1]), (strain[0], strain[1])


class _Levels(NamedTuple):
    """Levels of one channel in each cycle, and the width of the error of its range."""

    mean: Floats
    amplitude: Floats
    peak: Floats
    valley: Floats
    missed: Floats


def _levels_of_sine(
    row: Mapping[str, Floats],
    fundamentals: tuple[tuple[Floats, Floats], tuple[Floats, Floats]],
    shapes: tuple[_Shape, _Shape],
    is_load: bool,
) -> tuple[_Levels, _Levels]:
    """Levels of tension and of strain of a sinusoidal wave, by its fundamental and its shape."""
    levels = []
    for name, (cosine, sine), shape in zip(("force", "strain"), fundamentals, shapes, strict=True):
        half = np.hypot(cosine, sine)
        mean, amplitude = row[f"{name}_mean"] + shape.middle * half, half * shape.half
        levels.append(
            _Levels(mean, amplitude, mean + amplitude, mean - amplitude, shape.missed * half)
        )
    tension, strain = levels
    # cycles of many amplitudes have no wave in common: K_ap by their logged extremes
    if _change_of(tension.amplitude if is_load else strain.amplitude) > _IRREGULAR:
        by_extremes = np.nanmean(row["peak"] - row["valley"]) / np.nanmean(row["high"] - row["low"])
        by_wave = np.nanmean(tension.amplitude) / np.nanmean(strain.amplitude)
        of_shape = tension.amplitude * (by_extremes / by_wave - 1)
        tension = tension._replace(missed=np.hypot(tension.missed, of_shape))
    return tension._replace(peak=row["peak"], valley=row["valley"]), strain


_GROWS = 0.01  # of the range of a cycle

_BEFORE_LAST = 3  # drifts from valley to valley


def _levels_of_ramps(
    row: Mapping[str, Floats],
    drifts: _Drifts,
    cycles: Cycles,
    is_load: bool,
    rise_shares: tuple[Floats | float, Floats | float],
    may_dwell: bool,
) -> tuple[_Levels, _Levels]:
    """Levels of tension and of strain of waves that are not sines, by their turns."""
    follows, is_parted = touching(cycles), _are_parted(cycles)
    # a cycle stored without the next one may end before its valley
    ends_alone = np.append(cycles.first[1:] == cycles.last[:-1] + 1, False)
    is_apart = ~(follows | np.append(follows[1:], False))
    on_rise, on_fall = counted_on_flanks(cycles)
    is_by_fall, levels = np.isfinite(drifts.on_fall), []
    # where the strokes of a machine grow, its valleys do not drift as its means do
    driven, of_driven = ("force", drifts.tension) if is_load else ("strain", drifts.strain)
    foot = row[f"{driven}_end_turn"]
    of_feet = np.append(np.where(follows[1:], np.diff(foot), np.nan), np.nan)
    grows = ~follows & (np.abs(of_feet - of_driven) > _GROWS * np.abs(row[f"{driven}_top"] - foot))
    early = 0.0
    if follows[-2:].all() and cycles.last[-1] == cycles.branch.size - 1:
        # the log may end before its last valley, by a part of a reading for both channels
        step = (row[f"{driven}_top"] - foot)[-1] / (cycles.last - cycles.branch_last[:, 0])[-1]
        early = np.clip((foot[-1] - foot[-2] - of_feet[-3]) / step, 0.0, 1.0)
    # to the next level only after a cycle between two valleys alike
    own = np.abs(foot - row[f"{driven}_begin"])
    beyond = ~(on_rise | on_fall) & (own < np.abs(of_feet))
    of_growth = np.divide(own, np.abs(of_feet), out=np.ones_like(foot), where=beyond)
    for place, (name, drift) in enumerate((("force", drifts.tension), ("strain", drifts.strain))):
        answers = place == int(is_load)
        top, begin, end = (row[f"{name}_{turn}"] for turn in ("top", "begin", "end_turn"))
        if early:
            step = (top[-1] - end[-1]) / (cycles.last[-1] - cycles.branch_last[-1, 0])
            end = np.append(end[:-1], end[-1] - early * step)
        elif may_dwell and is_load and answers and follows[-1]:
            # creep in the dwell after the last valley is not part of it, as of the others
            side = np.sign(top[-1] - end[-1])
            # where strokes grow, valleys do not drift as means do
            of_valleys = np.diff(end[:-1])[follows[1:-1]][-_BEFORE_LAST:]
            as_before = begin[-1] + (np.median(of_valleys) if of_valleys.size else drift[-1])
            end = np.append(end[:-1], side * np.fmin(side * end[-1], side * as_before))
        missed = row[f"{name}_missed"]
        if is_parted:  # the drift may all take place on one way between the turns
            missed = np.hypot(missed, EITHER_WAY * np.abs(drift) / 4)
        # the drift of a first cycle beyond its neighbours is not part of its wave
        drift = drifts.of_neighbours if answers else drift
        drift = np.where(grows, of_growth * np.append(np.diff(end), np.nan), drift)
        mean, amplitude = _mean_and_amplitude(
            top,
            begin,
            end,
            drift,
            rise_shares[place],
            follows & ~ends_alone,
            (on_rise & is_apart, on_fall & is_apart),
            # both on the same way: a log that ends before its last valley is short of it in both
            np.where(
                is_by_fall, drifts.on_fall if answers else (1 - rise_shares[place]) * drift, np.nan
            ),
        )
        turns = top, begin, end
        levels.append(
            _Levels(mean, amplitude, np.max(turns, axis=0), np.min(turns, axis=0), missed)
        )
    tension, strain = levels
    return tension, strain._replace(valley=row["strain_begin"])


def _energy_of_cycles(
    row: Mapping[str, Floats], drifts: _Drifts, follows: Bools, size: Floats, is_load: bool
) -> tuple[Floats, Floats, Floats]:
    """Energy of loops without their drift, its part at the peaks, and its standard uncertainty.

    ``size``: product of both amplitudes.
    """
    energy = without_drift(
        row["energy"],
        end_tension=row["force_end"],
        mean_tension=row["force_mean"],
        tension_drift=drifts.tension,
        end_strain=row["strain_end"],
        mean_strain=row["strain_mean"],
        strain_drift=drifts.strain,
    )
    of_drift, is_own = row["energy"] - energy, drifts.is_own
    at_peaks = of_drift * drift_at_peaks(energy, row["energy"], size)
    # beyond its neighbours, a first cycle under a driven position loses tension by relaxation,
    # which is no loss of the loop, or by friction that the ramp left on the loading side, which is:
    # the middle is wrong by at most half of it
    beyond = np.zeros(energy.size)
    if not is_load and is_own.any():
        first = is_own & ~follows
        beyond[first] = np.clip(1 - drifts.of_neighbours[first] / drifts.tension[first], 0, 1)
        at_peaks = np.where(is_own, -beyond * of_drift / 2, at_peaks)
    energy = energy - at_peaks
    with np.errstate(divide="ignore", invalid="ignore"):
        # the part of the cycle in which the drift takes place is not known
        not_placed = drift_not_placed(energy, row["energy"], size)
    # later cycles give no information on the creep after a ramp
    placed = np.where(is_own & is_load, 1 / PLACE_OF_DRIFT, not_placed)
    placed *= np.abs(row["energy"] - energy)
    placed = np.hypot((1 - beyond) * placed, beyond * np.abs(of_drift) / np.sqrt(12))
    of_driven = "force" if is_load else "strain"
    arm = row[f"{of_driven}_end"] - row[f"{of_driven}_mean"]
    return energy, at_peaks, np.hypot(placed, arm * drifts.may_miss)


def _quantities_of_cycles(
    measured: Floats,
    cycles: Cycles,
    ends: Floats,
    *,
    waveform: Waveform,
    noise: float,
    strain_noise: float,
    rise_shares: tuple[Floats | float, Floats | float] = (0.5, 0.5),
    control: Control = "position",
    shapes: tuple[_Shape, _Shape] | None = None,
    own_drift: Callable[[Floats, Floats], tuple[Floats, Bools, Floats]] | None = None,
) -> tuple[dict[str, Floats], dict[str, Floats]]:
    """Quantities of each cycle of one specimen, and their standard uncertainties.

    Notes
    -----
    Source: [1]_, eq. 1 and 4, corrected for drift.  Where the drift exceeds the range of the
    cycle, the corrected quantities are NaN.

    Examples
    --------
    For a triangular cycle from 100 to 300 N and from 1 to 3 %, K_ap is 100 N over 1 %:

    >>> known = {"peak": 300.0, "valley": 100.0, "high": 0.03, "low": 0.01,
    ...     "force_missed": 0.0, "force_top": 300.0, "force_begin": 100.0, "force_end_turn": 100.0,
    ...     "strain_top": 0.03, "strain_begin": 0.01, "strain_end_turn": 0.01}
    >>> measured = np.array([[known.get(name, 0.0)] for name in MEASURED])
    >>> one, pair = np.array([0]), np.array([[0, 50]])
    >>> cycles = Cycles(
    ...     one, one + 100, pair, pair + 50, np.ones((1, 2)), np.zeros(101, np.int32),
    ...     np.zeros(101, np.int8), np.zeros(101, bool), 0.1,
    ... )
    >>> values, _ = _quantities_of_cycles(
    ...     measured, cycles, np.array([[0.0], [2.5], [7.5], [10.0]]),
    ...     waveform="triangular", noise=1.0, strain_noise=0.0,
    ... )
    >>> values["apparent_spring_constant"].round(6), values["mean_tension"]
    (array([10000.]), array([200.]))
    """
    row = dict(zip(MEASURED, measured, strict=True))
    n_samples = (cycles.last - cycles.first).astype(np.float64)
    is_load = control == "load"
    drifts = _drifts_of_cycles(
        row, cycles, ends, waveform=waveform, is_load=is_load, rise_shares=rise_shares,
        own_drift=own_drift,
    )  # fmt: skip
    fundamentals = _fundamentals(row, drifts, is_load)
    (force_cos, force_sin), (strain_cos, strain_sin) = fundamentals
    if waveform == "sinusoidal":
        tension, strain = _levels_of_sine(
            row, fundamentals, shapes or (_Shape(), _Shape()), is_load
        )
    else:
        tension, strain = _levels_of_ramps(
            row, drifts, cycles, is_load, rise_shares, waveform == "other"
        )
    amplitude, strain_amplitude = tension.amplitude, strain.amplitude
    energy, at_peaks, u_placed = _energy_of_cycles(
        row, drifts, touching(cycles), amplitude * strain_amplitude, is_load
    )
    with np.errstate(divide="ignore", invalid="ignore"):
        # a series a cos + b sin is the real part of (a - ib) exp(i omega t)
        square = strain_cos**2 + strain_sin**2
        over_time = (force_cos * strain_cos + force_sin * strain_sin) / square
        lost_over_time = (
            force_cos * strain_sin - force_sin * strain_cos - at_peaks / np.pi
        ) / square
        apparent = amplitude / strain_amplitude
        share = np.pi * square * lost_over_time / energy
        both = np.hypot(noise, apparent * strain_noise)
        u_over_time = np.sqrt(2 / n_samples) * both / np.sqrt(square)
        u_energy = row["strain_step_norm"] * both
        # noise hides what one corner misses, not what most of them do
        lost, lost_strain = (
            np.fmax(one.missed, np.median(np.nan_to_num(one.missed)) / 2) / np.sqrt(12)
            for one in (tension, strain)
        )
        u_extreme = np.hypot(noise, lost)
        if waveform == "sinusoidal":
            u_extreme = np.hypot(noise, _missed_turn(amplitude, n_samples))
            u_half, u_strain = np.sqrt(2 / n_samples) * noise, np.sqrt(2 / n_samples) * strain_noise
            # readings that span a little more or less than a period, and a drift that changes
            # within it, leave some of the drift in phase with the wave
            drift, own = (
                (drifts.strain, strain_amplitude) if is_load else (drifts.tension, amplitude)
            )
            left = np.hypot(drift / (np.sqrt(12) * n_samples), _change_beside(drift) / 2 / np.pi**2)
            if is_load:
                u_strain = np.hypot(u_strain, left)
            else:
                u_half = np.hypot(u_half, left)
            u_over_time = np.hypot(u_over_time, apparent * left / own)
            storage, loss = over_time, lost_over_time
            u_storage = u_loss = u_apparent = u_over_time
        else:
            # in a single cycle the turn lies anywhere between two samples
            u_half = np.hypot(noise / np.sqrt(2), lost)
            u_strain = np.hypot(strain_noise / np.sqrt(2), lost_strain)
            # a corner that both channels miss by the same fraction cancels in their ratio
            apart = (tension.missed / amplitude) ** 2 - (strain.missed / strain_amplitude) ** 2
            by_noise = np.hypot(noise / amplitude, strain_noise / strain_amplitude)
            u_apparent = apparent * np.sqrt(by_noise**2 / 2 + np.abs(apart) / 12)
            u_energy = np.hypot(u_energy, row["energy_missed"] / np.sqrt(12))
            drift, own = (
                (drifts.strain, amplitude) if is_load else (drifts.tension, strain_amplitude)
            )
            in_phase = (row["phase_work"] + drift * row["phase_sine"]) / (np.pi * row["phase_half"])
            quadrature = energy / (np.pi * own**2)
            if is_load:
                # these are compliances; the modulus is their inverse
                in_phase, quadrature = (
                    one / (in_phase**2 + quadrature**2) for one in (in_phase, quadrature)
                )
            storage, loss = in_phase, quadrature
            u_storage = np.sqrt(2 / n_samples) * both / strain_amplitude
            u_loss = np.abs(loss) * np.hypot(
                u_energy / energy, np.sqrt(2) * strain_noise / strain_amplitude
            )
        u_ramp, u_foot = drifts.of_ramp / np.sqrt(12), np.sqrt(2) * u_strain
        # a transient that dies away within its cycle has a fundamental in phase as well
        by_ramp = u_ramp / (strain_amplitude if is_load else amplitude)
        u_storage = np.hypot(u_storage, storage * by_ramp)
        u_over_time = np.hypot(u_over_time, over_time * by_ramp)
        u_apparent = np.hypot(u_apparent, apparent * by_ramp)
        if is_load:
            u_strain = np.hypot(u_strain, u_ramp)
        else:
            u_half = np.hypot(u_half, u_ramp)
        if waveform == "sinusoidal":  # the foot is the mean less the amplitude
            u_foot = np.sqrt(2) * u_strain
        factor = loss / storage
        per_energy = 1 / (np.pi * strain_amplitude**2)
        u_loss = np.hypot(u_loss, u_placed * per_energy)
        u_over_time_lost = np.hypot(u_over_time, u_placed * per_energy)
        values = {
            "mean_tension": tension.mean,
            "tension_amplitude": amplitude,
            "mean_strain": strain.mean,
            "strain_amplitude": strain_amplitude,
            "peak_tension": tension.peak,
            "valley_tension": tension.valley,
            "apparent_spring_constant": apparent,
            "hysteresis_energy": energy,
            "storage_spring_constant": storage,
            "loss_spring_constant": loss,
            "loss_factor": factor,
            "fundamental_energy_share": share,
            "closed_loop_energy": row["energy"],
            "storage_over_time": over_time,
            "loss_over_time": lost_over_time,
            "tension_turn_missed": np.hypot(tension.missed, 0.0 if is_load else drifts.of_ramp),
            "strain_turn_missed": np.hypot(strain.missed, drifts.of_ramp if is_load else 0.0),
            "energy_turn_missed": row["energy_missed"],
            "foot_strain": strain.valley,
        }
        uncertainty = {
            "mean_tension": u_half,
            "tension_amplitude": u_half,
            "mean_strain": u_strain,
            "strain_amplitude": u_strain,
            "peak_tension": u_extreme,
            "valley_tension": u_extreme,
            "apparent_spring_constant": u_apparent,
            "hysteresis_energy": np.hypot(u_energy, u_placed),
            "storage_spring_constant": u_storage,
            "loss_spring_constant": u_loss,
            "loss_factor": np.abs(factor) * np.hypot(u_loss / loss, u_storage / storage),
            "fundamental_energy_share": np.abs(share)
            * np.hypot(u_over_time / np.abs(lost_over_time), u_energy / np.abs(energy)),
            "closed_loop_energy": u_energy,
            "storage_over_time": u_over_time,
            "loss_over_time": u_over_time_lost,
            "foot_strain": u_foot,
        }
    return values, uncertainty


def _mean_and_amplitude(
    top: Floats,
    begin: Floats,
    end: Floats,
    drift: Floats,
    rise_share: Floats | float,
    follows: Bools,
    counted_on: tuple[Bools, Bools],
    on_fall: Floats,
) -> tuple[Floats, Floats]:
    """Mean of peak and valley, and half their difference, without a steady drift.

    The valley is interpolated between those on either side, at the time of the peak.  Where no
    cycle comes before, the first valley is that of an approach or a hold, and a line through both
    is not a drift.  The one farther from the peak is taken, and the range is corrected for the
    drift on the way from it to the peak; a cycle that is counted from a flank on has one valley
    (`counted_on_flanks`).  Where the cycle drifts more than its neighbours, the
    range is that of the way down, with the drift ``on_fall``; NaN elsewhere.

    Examples
    --------
    A range of 20 that grows by 2 a cycle, the first after a hold at its valley:

    >>> one, none = (np.array([-1.0, 1.0]), np.array([1.0, 3.0])), np.full(2, np.nan)
    >>> whole = (np.zeros(2, dtype=bool),) * 2
    >>> _mean_and_amplitude(np.array([20.0, 22.0]), *one, np.array([2.0, 2.0]), 0.5,
    ...     np.array([False, True]), whole, none)
    (array([ 9.5, 12. ]), array([10., 10.]))
    """
    # in a channel of the wrong sign the top is the lower one
    on_rise, is_before = counted_on
    is_whole = ~(on_rise | is_before)
    is_before = is_before | (is_whole & ~(np.abs(top - begin) < np.abs(top - end)))
    far = np.where(is_before, begin, end)
    foot = np.where(follows, (1 - rise_share) * begin + rise_share * end, far)
    way = np.where(is_before, rise_share, 1 - rise_share)
    amplitude = np.abs(top - foot) / 2 - np.where(follows, 0.0, way * np.abs(drift) / 2)
    of_one_valley = np.abs(top - far - np.where(is_before, way, -way) * drift) / 2
    amplitude = np.where(is_whole | follows, amplitude, of_one_valley)
    amplitude = np.where(np.isfinite(on_fall), np.abs(top - end + on_fall) / 2, amplitude)
    return (top + foot) / 2, np.where(np.isnan(drift), np.nan, amplitude)


def _change_beside(values: Floats) -> Floats:
    """Greater change of each value to its neighbours.

    Examples
    --------
    >>> _change_beside(np.array([3.0, 1.0, 0.5]))
    array([2. , 2. , 0.5])
    """
    steps = np.abs(np.diff(values))
    return np.asarray(np.fmax(np.append(0.0, steps), np.append(steps, 0.0)))


def _missed_turn(amplitude: Floats | float, n_samples: Floats) -> Floats:
    """Standard deviation of the distance of the logged extreme from the turn between samples.

    A branch at constant rate rises by four amplitudes over N per sample.  The turn lies
    within half a sample of the logged extreme, uniformly distributed, so the loss is uniform
    over half a step: its root mean square is the step over the root of 12.
    """
    missed: Floats = 4 * amplitude / n_samples / np.sqrt(12)
    return missed


# samples beyond a block that its differences of strain need
_REACH = 4


_FIELDS = (
    "frequency", "cycle_start_time", "mean_tension", "tension_amplitude", "mean_strain",
    "strain_amplitude", "peak_tension", "valley_tension", "apparent_spring_constant",
    "hysteresis_energy", "storage_spring_constant", "loss_spring_constant", "loss_factor",
    "fundamental_energy_share", "closed_loop_energy", "storage_over_time", "loss_over_time",
    "tension_turn_missed", "strain_turn_missed", "energy_turn_missed", "foot_strain",
)  # fmt: skip


_WITHOUT_UNCERTAINTY = (
    "cycle_start_time", "tension_turn_missed", "strain_turn_missed", "energy_turn_missed",
)  # fmt: skip


_OF_GREATEST = 0.55  # of the noise: scatter of the greatest of about ten readings


_OF_BOTH_ENDS = 2.0
"""Width that `Loops` divides by the root of 8, of two errors that make that of half a range one
over the root of 2. [1]"""


def _measure(
    time: Floats,
    tension: Floats,
    strain: Floats,
    basis: CycleBasis,
    middles: Integers,
    branches: tuple[Integers, Integers],
    waveform: Waveform,
    control: Control,
    reach: tuple[Integers, Integers],
    turn: Turn,
    ways: tuple[int, int],
    alone: bool,
) -> Floats:
    """Quantities that need the samples: one row a quantity of `MEASURED`, one column a cycle."""
    first, last = basis.first, basis.last
    is_smooth = waveform == "sinusoidal"
    force, lost_force = bridge_gaps(tension, first, last, is_smooth=is_smooth)
    stretch, lost_stretch = bridge_gaps(strain, first, last, is_smooth=is_smooth)
    moved = force if control == "load" else stretch
    at_turns = (
        (np.zeros(first.size),) * 8
        if waveform == "sinusoidal"
        else tuple(
            one
            for series, way in zip((force, stretch), ways, strict=True)
            for one in peaks_and_valleys(
                series,
                time,
                *branches,
                ends=(first, last),
                reach=reach,
                turn=turn,
                way=way,
                # the other one of the two responds: strain follows the position that is driven
                moved=ways[moved is stretch] * moved,
                answers=(series is force) != (moved is force),
                sticks=moved is force,
                alone=alone,
            )
        )
    )
    if waveform == "sinusoidal":
        lacking = np.zeros(first.size)
        may_lack = np.full(first.size, energy_by_chance(force, stretch, first, last))
    else:
        lacking, may_lack = energy_of_cycles_missed_by_polygon(force, stretch, moved, first, last)
    energy, norm = loop_energy(force, stretch, first, last, waveform=waveform)
    measured = np.array(
        [
            *extremes_of_cycles(force, first, last),
            *extremes_of_cycles(stretch, first, last),
            energy + lacking,
            norm,
            *fundamental(force, basis),
            *fundamental(stretch, basis),
            (force[first] + force[last]) / 2,
            (stretch[first] + stretch[last]) / 2,
            *part_means(force, basis, middles),
            *part_means(stretch, basis, middles),
            *np.zeros((3, first.size)),
            *at_turns,
            may_lack,
        ]
    )
    measured[:, lost_force | lost_stretch] = np.nan
    return measured


_WIDER = 4  # parts of a rise, in half of which noise may hide where its rest begins


def _integrate_over_phase(
    measured: Floats,
    levels: Floats,
    time: Floats,
    tension: Floats,
    strain: Floats,
    cycles: Cycles,
    control: Control,
    block: slice,
) -> None:
    """Fill the rows of `work_at_equal_phase` for some cycles; ``measured`` is from `_measure`."""
    low, high = int(cycles.first[block.start]), int(cycles.last[block.stop - 1]) + 1
    moved, answer = (
        bridge_gaps(one[low:high], cycles.first[block] - low, cycles.last[block] - low)[0]
        for one in ((tension, strain) if control == "load" else (strain, tension))
    )
    # noise makes a rest begin early, while its ramp still goes on
    begin, end = cycles.first[block] - low, cycles.last[block] - low
    peak, leaves = cycles.branch_last[block, 0] - low, cycles.branch_first[block, 1] - low
    into = np.minimum(leaves - peak, (peak - begin) // _WIDER) // 2
    found = np.array(
        work_at_equal_phase(
            answer, moved, time[low:high], np.column_stack([begin, leaves - into]),
            np.column_stack([peak + into, end]), levels[:, block],
        )
    )  # fmt: skip
    on_rise, on_fall = (one[block] for one in counted_on_flanks(cycles))
    on_flank = np.flatnonzero(on_rise | on_fall)
    if on_flank.size:
        feet = cycles.branch_first[block, 0], cycles.branch_last[block, 1]
        valley = np.where(on_rise, feet[1], feet[0]) - low
        found[:, on_flank] = _work_from_valley(
            answer, moved, begin[on_flank], end[on_flank], valley[on_flank],
            np.column_stack([peak, leaves])[on_flank], levels[:, block][:, on_flank],
        )  # fmt: skip
    measured[_OF_PHASE : _OF_PHASE + len(found), block] = found


def _work_from_valley(
    values: Floats,
    driven: Floats,
    first: Integers,
    last: Integers,
    valley: Integers,
    peak: Integers,
    levels: Floats,
) -> Floats:
    """Rows of `work_at_equal_phase` for cycles that are stored from a flank on.

    Notes
    -----
    The readings before the valley follow the last one, as in the next cycle, which is not stored.
    The mean of the sine removes a steady drift of the series from its integral: it is the integral
    of a drift of one over the cycle, with its step back where the cycle is joined.

    Examples
    --------
    A straight line of slope 900, amplitude 0.2, whose cycle is stored from the middle of its rise:

    >>> strain = 0.2 * np.sin(2 * np.pi * np.arange(80) / 80)
    >>> one = np.array([0])
    >>> work, sine, half = _work_from_valley(900 * strain, strain, one, one + 79, one + 60,
    ...     np.array([[20, 20]]), np.array([[-0.2], [0.2], [-0.2]]))
    >>> print((work / (np.pi * half)).round(3), abs(sine.round(1)))
    [900.] [1.]
    """
    length = last - first + 1
    begin = np.cumsum(length + 1) - length - 1
    place = np.arange(length.sum() + length.size) - np.repeat(begin, length + 1)

    def along(of_cycle: Integers) -> Integers:
        return np.repeat(of_cycle, length + 1)

    within = (place + along(valley - first)) % along(length)
    at = along(first) + within
    peaks = begin[:, None] + (peak - valley[:, None]) % length[:, None]
    feet = np.where(np.abs(levels[1] - levels[0]) > np.abs(levels[1] - levels[2]), *levels[[0, 2]])
    work, steady = (
        work_at_equal_phase(
            series, driven[at], np.arange(at.size, dtype=np.float64),
            np.column_stack([begin, peaks[:, 1]]), np.column_stack([peaks[:, 0], begin + length]),
            np.stack([feet, levels[1], feet]),
        )
        for series in (values[at], within / (along(length) - 1))
    )  # fmt: skip
    return np.stack([work[0], -steady[0], work[2]])


class _Reading(NamedTuple):
    """Errors of a reading of one channel: its noise, its step, and what is left of the step.

    ``scatter`` is that over the cycles at equal phases; infinite where a channel has no step.
    """

    noise: float
    step: float
    scatter: float
    rounding: float


def _reading_of(series: Floats, cycles: Cycles, noise: float) -> _Reading:
    own, step = noise_and_step(series, noise)
    scatter = scatter_over_cycles(series, cycles, step) if step else np.inf
    return _Reading(own, step, scatter, rounding_left(step, scatter))


def _levels_at_turns(
    measured: Floats,
    both: tuple[Floats, Floats],
    cycles: Cycles,
    readings: Sequence[_Reading],
    *,
    turn: Turn,
    ways: tuple[int, int],
    answer: int,
    reach: int,
    noise_of_driven: float,
    may_dwell: bool,
) -> Floats:
    """Take noise and steps off the turns of both channels; levels of the driven one, (3, n_cycles).

    ``measured`` is from `_measure`, and is changed.  The first and last level are those of the
    valleys, the second that of the peak, without the tips that readings miss at sharp turns.
    """
    of_driven = _OF_TURNS + 4 * (1 - answer)
    of_corners = noise_of_corners(noise_of_driven, measured[of_driven : of_driven + 2])
    tips = measured[of_driven + 3] / 2 if turn == "sharp" else 0.0
    rests = None
    for channel in (1 - answer, answer):  # the response uses the rests of the driven one
        series, reading, rows = both[channel], readings[channel], _OF_TURNS + 4 * channel
        # the step of a converter does not raise an extreme, and shifts it alike in all
        # cycles; the greatest of about ten noisy readings scatters, which removes this
        # error from the mean of many
        missed = measured[rows + 3]
        rounded = rounding_left(reading.step, _OF_GREATEST * min(reading.noise, reading.scatter))
        np.hypot(missed, _OF_BOTH_ENDS * rounded, out=missed)
        is_held = take_noise_off_levels(
            measured[rows : rows + 4], series, cycles, reach=reach,
            turn=turn, noise=reading.noise, way=ways[channel],
            may_dwell=may_dwell, of_corners=of_corners, rests=rests,
        )  # fmt: skip
        rests = (series, measured[rows : rows + 4]) if is_held else None
    top, foot, end_turn = measured[of_driven : of_driven + 3]
    tips *= ways[1 - answer]
    return np.stack([foot + tips, top - tips, end_turn + tips])


def _shapes_of_waves(
    measured: Floats,
    time: Floats,
    both: tuple[Floats, Floats],
    cycles: Cycles,
    period: Floats,
    ends: Floats,
    rounding: Sequence[float],
    answer: int,
) -> tuple[_Shape, _Shape]:
    """Shapes of the waves of tension and strain, whose phase may turn over a cycle.

    ``measured`` is from `_measure`; the fundamental of the channel that answers is changed to one
    that does not turn.
    """
    rows = _OF_FORCE, _OF_STRAIN
    (force_cos, force_sin), (strain_cos, strain_sin) = (measured[one[:2]] for one in rows)
    lead = np.angle((force_cos - 1j * force_sin) * (strain_cos + 1j * strain_sin))
    turned = turn_over_cycle(-lead if answer == 1 else lead, touching(cycles))
    fitted = rows[answer][:3]
    cosine, sine, mean = measured[fitted]
    measured[fitted] = without_turning(cosine, sine, mean, turned)
    of_force, of_strain = (
        _shape_of_wave(
            time, both[one], cycles, period, measured[rows[one]], ends,
            rounding=rounding[one], turned=turned if one == answer else 0.0,
        )
        for one in (0, 1)
    )  # fmt: skip
    return of_force, of_strain


def close_loops(
    time: Floats,
    tension: Floats,
    strain: Floats,
    cycles: Cycles,
    *,
    waveform: Waveform = "triangular",
    control: Control = "position",
    driven: Floats | None = None,
) -> Loops:
    r"""Dynamic quantities of each cycle and specimen.

    .. math:: K_{ap} = \frac{T_{max} - T_{min}}{\varepsilon_{max} - \varepsilon_{min}}, \qquad
              H = \oint T d\varepsilon, \qquad K' + i K'' = \hat T / \hat\varepsilon

    Parameters
    ----------
    time : ndarray, shape (n_samples,)
        Elapsed time. [s]
    tension : ndarray, shape (n_specimens, n_samples)
        NaN where missing. [N]
    strain : ndarray, shape (n_specimens, n_samples)
        Nominal strain of the free length. [1]
    cycles : Cycles
        From `reduction.stages.cycles.cycle_search`.
    waveform : {"triangular", "sinusoidal", "other"}
        How the control channel moves; see `reduction.stages.cycles.loops`. [-]
    control : {"position", "load"}
        Channel that the machine drives. [-]
    driven : ndarray, shape (n_samples,), optional
        The driven channel; by default strain of the first specimen, or its tension under load
        control. [m] or [N]

    Returns
    -------
    loops : Loops
        One row a cycle; amplitudes are half ranges.

    Raises
    ------
    DataError
        If a cycle takes no time.

    Notes
    -----
    Means and amplitudes of a sinusoidal test are those of the extremes of its wave, by its
    harmonics (`_shape_of_wave`): the turn of a slow log lies between two samples, earlier in
    tension than in strain, and the response to a sine may have a kink there.  Peaks and valleys,
    and means and amplitudes of other waves, are those of the logged extremes: the expected excess
    of the noise there is subtracted (`take_noise_off_levels`), and a slow log misses the turn by up
    to half a sample.  Uncertainties are those of one cycle: the
    propagated noise of a reading (`reading_noise`) and, for extremes, the turn between
    two samples; nothing else.  K_ap
    by amplitudes is one of three meanings of "slope of the loop"; for an ellipse it is
    hypot(K', K''), and K' itself is the slope of the regression of tension on strain.  An
    open loop is closed by a straight line and corrected for its drift (`without_drift`), as
    are the amplitudes of other waves: half the range less a quarter of the drift.  In a
    cycle that lacks up to a tenth of its readings, these are bridged (`bridge_gaps`); a cycle
    that lacks more is NaN throughout.

    Examples
    --------
    A standard linear solid with K' = 900 N and K'' = 100 N at 0.1 Hz, strain 1 +- 0.2:

    >>> t = np.arange(0, 30.01, 0.1)
    >>> strain = 1 - 0.2 * np.cos(0.2 * np.pi * t)
    >>> tension = 1000 - 0.2 * (900 * np.cos(0.2 * np.pi * t) - 100 * np.sin(0.2 * np.pi * t))
    >>> first, last = np.array([0, 100]), np.array([100, 200])
    >>> ends = np.column_stack([first, first + 50])
    >>> cycles = Cycles(
    ...     first, last, ends, ends + 50, np.ones((2, 2)), np.zeros(301, np.int32),
    ...     np.zeros(301, np.int8), np.zeros(301, bool), 0.1,
    ... )
    >>> loops = close_loops(t, tension[None], strain[None], cycles, waveform="sinusoidal")
    >>> print(loops.storage_spring_constant.round(2), loops.loss_spring_constant.round(2))
    [[900. 900.]] [[100. 100.]]
    >>> print(loops.hysteresis_energy.round(3), round(np.pi * 100 * 0.2**2, 3))
    [[12.566 12.566]] 12.566
    """
    first, last = cycles.first, cycles.last
    begin, end = take_samples(time, first), take_samples(time, last)
    duration = end - begin
    period = mean_period(begin, first, last, last_turn=end)
    moved = (tension if control == "load" else strain)[0] if driven is None else driven
    turn_spread: Floats | None = None
    if waveform == "sinusoidal" and np.all(period > 0):
        period, duration, turn_spread = sine_period(time, moved, cycles, period)
    elif waveform != "sinusoidal":
        duration, turn_spread = own_periods(
            time, moved, cycles, duration, noise=reading_noise(moved)
        )
    if waveform != "sinusoidal":
        cycles = _into_rests(cycles)
    measured = empty_like(tension, shape=(tension.shape[0], len(MEASURED), cycles.n_cycles))
    of_reading, is_coarse = reading_noise, False
    if waveform == "sinusoidal" and np.all(end > begin):
        per_cycle = float(np.median(period * (last - first) / (end - begin)))
        # in step with the sine, the same harmonics are missing in all cycles
        in_step = abs(per_cycle - np.rint(per_cycle)) * cycles.n_cycles < 1
        is_coarse = bool(per_cycle < FEW_READINGS and not in_step)
        of_reading = partial(noise_beside_sine, readings=per_cycle) if is_coarse else reading_noise
    noises = [(of_reading(force), of_reading(stretch)) for force, stretch in
              zip(tension, strain, strict=True)]  # fmt: skip
    branches = cycles.branch_last - cycles.branch_first
    ways = [(way_of_series(force, cycles), way_of_series(stretch, cycles)) for force, stretch in
            zip(tension, strain, strict=True)]  # fmt: skip
    answer = int(control == "load")
    turns = turns_of_wave(
        (tension, strain)[answer], moved, cycles, waveform,
        [one[answer] for one in noises], [one[answer] for one in ways], sticks=control == "load",
    )  # fmt: skip
    # on a plateau the driven channel turns anywhere, the other one at its beginning
    share = 1.0 if waveform == "other" else _REACH_OF_TURN
    # creep after a fast stroke turns well within the slow one
    usual = np.median(branches, axis=0)
    # a slow cycle of a sweep of frequency is searched as far as it is long
    reach = np.maximum(share * np.maximum(branches, usual), 1).astype(np.int64).T
    # the middles of rise and fall, at least a sample apart and away from either end
    middles = (cycles.branch_first + cycles.branch_last).T // 2
    middles[0] = np.clip(middles[0], cycles.first + 1, cycles.last - 2)
    middles[1] = np.clip(middles[1], middles[0] + 1, cycles.last - 1)
    ends = take_samples(time, np.stack([cycles.first, *middles, cycles.last]))

    def measure_block(block: slice) -> None:
        low = max(int(cycles.first[block.start]) - _REACH, 0)
        high = int(cycles.last[block.stop - 1]) + _REACH + 1
        basis = cycle_basis(
            time[low:high], cycles.first[block] - low, cycles.last[block] - low,
            period=period[block],
        )  # fmt: skip
        for index, (force, stretch) in enumerate(zip(tension, strain, strict=True)):
            measured[index, :, block] = _measure(
                time[low:high], force[low:high], stretch[low:high], basis, middles[:, block] - low,
                (cycles.branch_first[block] - low, cycles.branch_last[block] - low),
                waveform, control, (reach[0, block], reach[1, block]), turns[index], ways[index],
                is_alone(cycles, time.size),
            )  # fmt: skip

    samples = (time, tension, strain, measured)
    run_blocks(measure_block, cycles.blocks(), samples=samples, longest=cycles.longest)
    shape = (tension.shape[0], cycles.n_cycles)
    tables = {name: empty_like(tension, shape=shape) for name in _FIELDS}
    uncertainty = {
        name: empty_like(tension, shape=shape)
        for name in _FIELDS
        if name not in _WITHOUT_UNCERTAINTY
    }
    rise_shares = (share_of_rise(time, cycles),) * 2
    for index, (force, stretch) in enumerate(zip(tension, strain, strict=True)):
        both = force, stretch
        readings = [
            _reading_of(series, cycles, noise)
            for series, noise in zip(both, noises[index], strict=True)
        ]
        steps, left = [one.step for one in readings], [one.rounding for one in readings]
        if any(steps):
            may_lack = measured[index, _OF_ENERGY]
            ranges = measured[index, _OF_EXTREMES[0]] - measured[index, _OF_EXTREMES[1]]
            of_steps = energy_of_rounding(
                both, steps, left, cycles, measured[index, _OF_NORM], ranges, waveform=waveform
            )
            np.hypot(may_lack, of_steps, out=may_lack)
        shapes = None
        if waveform == "sinusoidal":
            shapes = _shapes_of_waves(
                measured[index], time, both, cycles, period, ends, left, answer
            )
        else:
            levels = _levels_at_turns(
                measured[index], both, cycles, readings,
                turn=turns[index], ways=ways[index], answer=answer,
                reach=max(int(share * usual.max()), 1),
                noise_of_driven=noises[index][1 - answer], may_dwell=waveform == "other",
            )  # fmt: skip
            integrate_block = partial(
                _integrate_over_phase,
                measured[index],
                levels,
                time,
                force,
                stretch,
                cycles,
                control,
            )
            run_blocks(integrate_block, cycles.blocks(), samples=samples, longest=cycles.longest)
        if waveform == "other":
            of_force, of_stretch = ways[index]
            rise_shares = (
                share_of_rise(time, cycles, of_force * force),
                share_of_rise(time, cycles, of_stretch * stretch),
            )
        noise, strain_noise = noises[index]
        values, errors = _quantities_of_cycles(
            measured[index], cycles, ends, waveform=waveform, noise=noise,
            strain_noise=strain_noise, rise_shares=rise_shares, control=control,
            shapes=shapes,
            own_drift=partial(
                _own_drift, both[1 - answer], both[answer], cycles,
                noises=(noises[index][1 - answer], noises[index][answer]),
            ),
        )  # fmt: skip
        for name, column in values.items():
            tables[name][index] = column
            release_pages(tables[name])
            if name in errors:
                uncertainty[name][index] = errors[name]
                release_pages(uncertainty[name])
        release_pages(measured)
    if is_coarse:  # harmonics that few readings take for one another scatter as the phase does
        for energy, own in zip(
            tables["hysteresis_energy"], uncertainty["hysteresis_energy"], strict=True
        ):
            own[:] = np.fmax(own, _scatter_about_line(energy))
    tables["cycle_start_time"][:] = begin
    tables["frequency"][:] = 1 / duration
    # a turn is known to one sample at each end of the cycle, uniformly distributed
    if turn_spread is None:
        turn_spread = time_of_sample(duration, cycles)
    uncertainty["frequency"][:] = turn_spread / duration**2 * np.sqrt(2)
    release_pages(*tables.values(), *uncertainty.values())
    return Loops(**tables, uncertainty=uncertainty)


def _scatter_about_line(values: Floats) -> float:
    """Standard deviation of a series about its straight line; 0 where it is short."""
    known = np.flatnonzero(np.isfinite(values))
    if known.size < _FEWEST_OF_SCATTER:
        return 0.0
    left = values[known] - np.polyval(np.polyfit(known, values[known], 1), known)
    return float(np.sqrt(np.sum(left**2) / (known.size - 2)))


_FEWEST_OF_SCATTER = 6


def _into_rests(cycles: Cycles) -> Cycles:
    """Cycles separated by rests, extended into these as far as noise may hide their ramps.

    The first readings of a ramp lie within the tolerance of a rest and are counted to it, many
    where it begins slowly; without them a loop is cut off at its ends.

    Examples
    --------
    Ramps of 100 readings between rests, found 3 readings late and early:

    >>> ends = np.array([[53, 200], [353, 500], [653, 800]])
    >>> to = np.array([[150, 297], [450, 597], [750, 897]])
    >>> cycles = Cycles(ends[:, 0], to[:, 1], ends, to, np.ones((3, 2)), np.zeros(900),
    ...     np.zeros(900), np.zeros(900), 0.1)
    >>> found = _into_rests(cycles)
    >>> print(found.first, found.last)
    [ 53 340 640] [310 610 897]
    """
    if not _are_parted(cycles):
        return cycles
    ramp = int(np.median(cycles.branch_last - cycles.branch_first, axis=0).min())
    reach = 1 + ramp // _WIDER // 2
    # at most to the middle of a rest; before the first cycle and after the last may be a ramp
    room = np.minimum(reach, (cycles.first[1:] - cycles.last[:-1]) // 2)
    return replace(
        cycles, first=cycles.first - np.append(0, room), last=cycles.last + np.append(room, 0)
    )


_REACH_OF_TURN = 0.25  # of a branch, in which its extremes are searched


_OF_PHASE, _OF_TURNS, _OF_ENERGY, _OF_NORM = (
    MEASURED.index(name)
    for name in ("phase_work", "force_top", "energy_missed", "strain_step_norm")
)


_OF_EXTREMES = [
    [MEASURED.index(one) for one in pair] for pair in (("peak", "high"), ("valley", "low"))
]


_OF_FORCE, _OF_STRAIN = (
    [MEASURED.index(f"{name}_{part}") for part in _OF_PARTS] for name in ("force", "strain")
)
