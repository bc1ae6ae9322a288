"""Levels of a series at the turns of its cycles: peaks and valleys without noise or missed tips.

A turn lies between two readings, or on a rest of many; a reading beside it is neither.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from reduction.record.measurement import Floats, Integers
from reduction.record.samples import rounding_left, take_samples
from reduction.record.settings import Waveform
from reduction.stages.cycles.cycle_product import Cycles
from reduction.stages.cycles.periods import counted_on_flanks, gaps_that_move, touching
from reduction.stages.cycles.reading_noise import noise_and_step, reading_noise, within_scatter
from reduction.stages.cycles.turns import (
    STEEP,
    Turn,
    has_corners,
    kind_of_turns,
    level_at_corner,
    level_beside_corner,
    level_of_turn,
    missed_by_extreme,
    noise_in_extreme,
    rests_at_turns,
)


def extremes_of_cycles(values: Floats, first: Integers, last: Integers) -> tuple[Floats, Floats]:
    """Greatest and least reading of each cycle, including its last one."""
    pairs = np.column_stack([first, last]).ravel()
    stop = int(last[-1])
    greatest = np.maximum.reduceat(values[:stop], pairs[:-1])[::2]
    least = np.minimum.reduceat(values[:stop], pairs[:-1])[::2]
    return np.maximum(greatest, values[last]), np.minimum(least, values[last])


def peaks_and_valleys(
    series: Floats,
    time: Floats,
    branch_first: Integers,
    branch_last: Integers,
    *,
    ends: tuple[Integers, Integers],
    reach: tuple[Integers, Integers],
    turn: Turn,
    way: int,
    moved: Floats,
    answers: bool,
    sticks: bool,
    alone: bool,
) -> tuple[Floats, Floats, Floats, Floats]:
    """Greatest reading near each peak, least ones near both valleys, and the possible error.

    A turn between two samples lies above the readings, and below the crossing of the lines beside
    it, since no machine turns at once: the midpoint is taken, with half the range as possible
    error.  At a turn that is rounded over samples the readings miss less.  A series that
    ``answers`` the channel ``moved`` turns where its approach meets the corner of that channel: it
    may relax before the next reading, or stay there (``sticks``), as strain does under a driven
    load.  A series of way -1 falls where the driven channel rises.
    There is a rest between two cycles, unless they share a reading or are stored one below the
    other.  A cycle that is ``alone`` is followed by itself.
    """
    on_rise, on_fall = reach
    begin, peak, end = branch_first[:, 0], branch_last[:, 0], branch_last[:, 1]
    if alone:  # the valley is between the last reading and the first
        series, moved = (np.append(one, one[:_BEHIND_TURN]) for one in (series, moved))
    values = way * series
    is_stored_alone = ends[0][1:] == ends[1][:-1] + 1
    earliest = np.append(begin[:1], np.where(is_stored_alone, ends[0][1:], end[:-1]))
    latest = np.append(np.where(is_stored_alone, ends[1][:-1], begin[1:]), end[-1:])
    # creep while the channel is held at the peak is greatest where it leaves
    after_peak = np.minimum(branch_first[:, 1] + on_fall, end)

    def extreme(of: np.ufunc, low: Integers, high: Integers) -> Floats:
        # within the cycle, and the rests before and after it
        low = np.maximum(low, earliest)
        high = np.minimum(high, latest)
        stop = int(end[-1])
        # the last window goes to the end of the series, unless another one begins at its end
        pairs = np.column_stack([low, high]).ravel()[: None if high[-1] < stop else -1]
        found = of.reduceat(values[:stop], np.minimum(pairs, stop - 1))[::2]
        return np.asarray(of(found, values[high]))

    # noise acts on both sides of a turn, even where one of them is a rest
    before = np.full(begin.size, 0 if turn == "sharp" else values.size)
    after = before.copy()
    if turn != "sharp":
        moves = gaps_that_move(moved, begin, peak, end)
        after[moves] = before[moves + 1] = 0
    top = extreme(np.maximum, peak - on_rise, after_peak)
    first = extreme(np.minimum, begin - before, begin + on_rise)
    last = extreme(np.minimum, end - on_fall, end + after)
    levels = top, first, last
    turns = _Turns(begin, peak, end, after_peak, reach)
    if turn == "sharp":
        top, first, last, missed = _at_sharp_turns(values, moved, turns, levels, answers, sticks)
    elif turn == "hidden":
        top, first, last, missed = _at_hidden_turns(values, time, moved, turns, levels, answers)
    else:
        above = missed_by_extreme(values, peak, top, sign=1)
        below = missed_by_extreme(values, end, last, sign=-1)
        # the readings are its lower bound, not its middle
        missed = np.nan_to_num(above + below, nan=float(np.nanmedian(above + below)))
    return way * top, way * first, way * last, missed


class _Turns(NamedTuple):
    """Samples of the turns of cycles, and the reach of their extremes on the rise and the fall."""

    begin: Integers
    peak: Integers
    end: Integers
    after_peak: Integers
    reach: tuple[Integers, Integers]


def _at_sharp_turns(
    values: Floats,
    moved: Floats,
    turns: _Turns,
    levels: tuple[Floats, Floats, Floats],
    answers: bool,
    sticks: bool,
) -> tuple[Floats, Floats, Floats, Floats]:
    """Levels of turns without a rounding: top, first and last valley, and the possible error."""
    begin, peak, end, after_peak, (on_rise, on_fall) = turns
    top, first, last = levels
    # creep while the channel rests is greatest after the turn that ends the cycle
    stop = np.minimum(end + on_rise, np.append(peak[1:], values.size - 1))
    goes_on = np.append(begin[1:] == end[:-1], False)  # after the last one the machine unloads
    at_top = _places(values, peak - on_rise, after_peak)
    at_last = _places(-values, np.maximum(end - on_fall, peak), np.where(goes_on, stop, end))
    last = np.fmin(last, values[at_last])
    above = level_of_turn(values, peak, top, sign=1) - top
    below = last - level_of_turn(values, end, last, sign=-1)
    # a machine may rest at only one of its turns
    lowest = _places(-moved, np.maximum(end - on_fall, peak), stop)
    rests = rests_at_turns(moved, peak), rests_at_turns(-moved, lowest)
    readings = top, last
    # lines beside a rest cross above it, and noise makes one of its readings the greatest
    step = (top - last) / (end - peak)
    bow = np.zeros(top.size)
    if rests[0]:  # or an apparent rest, a turn that a machine rounds over two or three readings
        above, bow = np.zeros(top.size), _bow(values, at_top)
        if not answers:
            top = _mean_of_rest(values, at_top, top, within=_OF_A_STEP * step)
    if rests[1]:
        below, bow = np.zeros(top.size), bow + _bow(-values, at_last)
        if not answers:
            last = -_mean_of_rest(-values, at_last, -last, within=_OF_A_STEP * step)
    missed = np.zeros(top.size)
    if answers:
        above, below, missed = _above_answers(
            values, moved, turns, (at_top, at_last), rests, readings, (above, below), sticks
        )
    else:
        # a machine that dwells is at the level of its corner, without error
        upper = _plateau(values, peak - on_rise, after_peak, top)
        lower = _plateau(-values, np.maximum(end - on_fall, peak), stop, -last)
        top, above = (top, above) if upper is None else (upper[0], 0 * above)
        if lower is not None:  # noise lowers the readings of both ends of the first cycle alike
            first = np.append(first[0] - last[0] - lower[0][0], -lower[0][:-1])
        last, below = (last, below) if lower is None else (-lower[0], 0 * below)
    # the readings of a rounded turn are its lower bound, not its middle
    missed = missed + (above + below) / 2 + bow
    if end.size > 1 and end[-1] == values.size - 1:
        # no way up shows what the readings of the last valley miss
        missed[-1] = missed[-2:].max()
    return top + above / 2, first, last - below / 2, missed


def _above_answers(
    values: Floats,
    moved: Floats,
    turns: _Turns,
    places: tuple[Integers, Integers],
    rests: tuple[bool, bool],
    readings: tuple[Floats, Floats],
    lines: tuple[Floats, Floats],
    sticks: bool,
) -> tuple[Floats, Floats, Floats]:
    """Height of sharp turns above the extremes of a series that answers, and its possible error.

    ``lines``: heights at which the lines beside a turn cross.
    """
    noise = within_scatter(reading_noise(moved), moved[turns.peak])
    own = within_scatter(reading_noise(values), values[turns.peak])
    heights = []
    for at, place, sign, is_rest, reading, crossing in zip(
        places, (turns.peak, turns.end), (1, -1), rests, readings, lines, strict=True
    ):
        led = level_at_corner(
            values,
            moved,
            at,
            sign=sign,
            noise=noise,
            rests=is_rest,
            own_noise=own,
            steep=_SHOWN if sticks else STEEP,
        )
        height = np.abs(led - reading)
        # a series that sticks at a corner falls off slowly under a load, and lines beside it
        # cross above the level of the approach; a force falls off at once
        height = np.where(np.isfinite(height) & sticks, height, np.fmax(height, crossing))
        # for a series that stiffens all lines cross too low, or below its reading
        beyond = sign * (level_beside_corner(values, moved, place, sign=sign) - reading)
        if not is_rest and np.nanmedian(beyond) > _STIFFENS * np.nanmedian(height):
            height = np.fmax(height, beyond)
        heights.append(height)
    excess = [np.maximum(one - line, 0.0) for one, line in zip(heights, lines, strict=True)]
    missed = (_EITHER - 1) * (excess[0] + excess[1]) / 2
    if sticks:  # steps of the driven channel shift its corner, in step alike in all cycles
        grain = rounding_left(*noise_and_step(moved, reading_noise(moved))[::-1])
        stroke = np.abs(moved[turns.peak] - moved[turns.end])
        missed = np.hypot(missed, _OF_CORNER * grain * (readings[0] - readings[1]) / stroke)
    return heights[0], heights[1], missed


def _at_hidden_turns(
    values: Floats,
    time: Floats,
    moved: Floats,
    turns: _Turns,
    levels: tuple[Floats, Floats, Floats],
    answers: bool,
) -> tuple[Floats, Floats, Floats, Floats]:
    """Levels of turns between readings: at most the rise of the ramps to a crossing half way."""
    begin, peak, end, _, _ = turns
    top, first, last = levels
    wait = np.diff(time, append=time[-1])
    at_peak, at_end = (np.fmax(wait[at - 1], wait[at]) for at in (peak, end))
    # what follows a cycle that is stored without the next one is a gap
    at_end = np.where(np.append(end[:-1] == begin[1:], False), at_end, wait[end - 1])
    beside = (at_peak + at_end) / 2
    missed = (top - (first + last) / 2) * beside / (time[end] - time[begin])
    # readings miss half of that if corners lie anywhere, nothing at a rounded turn or a rest
    if not rests_at_turns(moved, peak):
        top, first, last = top + missed / 4, first - missed / 4, last - missed / 4
    # noise hides only the slow stroke of a saw: its readings are the lower bound of the range
    # within its step, which is larger where the series relaxes after a fast stroke
    after = np.minimum(end + 1, values.size - 1)
    above = top - np.stack([values[peak - 1], values[peak + 1]])
    below = np.stack([values[end - 1], values[after]]) - last
    slow, fast = np.nanmedian(np.sort(above, axis=0) + np.sort(below, axis=0), axis=1)
    # in a driven channel with even strokes both follow from corners between readings
    strokes = np.median([peak - begin, end - peak], axis=1)
    may_fall = answers or strokes.max() > _UNEVEN * strokes.min()
    if may_fall and slow < _STEEP * reading_noise(values) < fast:
        missed = np.fmax(missed, slow)
    return top, first, last, missed


_BEHIND_TURN = 5  # readings after a turn, needed to detect it


_EITHER = 2**0.5
"""An error by relaxation at a corner is at one end of its range or the other, not between: the
whole of half the range, where `Loops.shared_by_cycles` divides it by this."""


_SHOWN = 3.0  # times the noise of a reading of the load: such steps show a corner, even in a mean


_OF_CORNER = 10**0.5
"""Range of a corner's level by steps of two readings on either side, over the rounding
of a reading and the ratio of the channels: the root of 10 over twice the ramp, at either turn."""


_STIFFENS = 2.0  # times the height of the lines' crossing above a reading: then they are of no use


_ON_PLATEAU = 6.0  # noise of a reading below the greatest one, on a plateau of some tens


_FEWEST_ON_PLATEAU = 5


_BENT = 0.45  # noise: height of the middle of a dome, or the start of a decay, above the whole


_PARTS = 5  # of a plateau: tension that relaxes at once is above its mean in the first or second


_LOW = 1.5  # times the noise below a plateau: few of its readings are there, and those of ramps


_LEVEL, _CLEARLY = 0.25, 5.0  # times the noise, and standard errors of the mean, within which level


def noise_of_corners(noise: float, turns: Floats) -> float:
    """Noise of a driven channel over its range if its corners are mistaken for noise; else zero.

    Corners have the same effect on the other channel, which relaxes after them, so that its
    extremes scatter without showing its noise.  ``turns``: peaks, valleys.
    """
    if within_scatter(noise, turns[0]) >= noise / 2:
        return 0.0
    return noise / float(np.nanmedian(np.abs(turns[0] - turns[1])))


_LIKE_CORNERS = 3.0


_FALLS = 0.8  # noise of a reading, from a turn to the reading beside it


EITHER_WAY = np.sqrt(
    8 / 3
)  # of a half range, evenly likely up to it, as `Loops` takes what is missed


def _means_of_parts(values: Floats) -> Floats:
    """Mean of each of five consecutive parts, nearly equally long."""
    ends = np.arange(_PARTS + 1) * values.size // _PARTS
    return np.asarray(np.add.reduceat(values, ends[:-1]) / np.diff(ends))


def _plateau(
    values: Floats, low: Integers, high: Integers, top: Floats
) -> tuple[Floats, float, float] | None:
    """Mean of the readings of a plateau, whose greatest reading is too great by noise.

    Also returns the greatest and least height of the ends of the plateau above that mean: a decay
    hidden by noise has its extreme there.

    None where a window has no plateau.  On a plateau the middle is not higher than the ends, as it
    is on a dome, nor the beginning higher than the end, as in relaxation.  The middle half is used,
    since ramps begin within the noise.
    """
    noise = within_scatter(reading_noise(values), top)
    level = np.full(top.shape, np.nan)
    bent, decays = [], []
    for row, (start, stop) in enumerate(
        zip(np.maximum(low, 0).tolist(), high.tolist(), strict=True)
    ):
        if not np.isfinite(top[row]):
            continue
        window = values[start : stop + 1]
        on = window[np.abs(window - top[row]) <= _ON_PLATEAU * noise]
        if on.size < _FEWEST_ON_PLATEAU:
            continue
        quarter, half = on.size // 4, on.size // 2
        middle = np.median(on)
        halves = np.median(on[quarter : on.size - quarter]), np.median(on[:half])
        bent.append(np.append(_means_of_parts(on), halves) - middle)
        level[row] = np.mean(on[quarter : on.size - quarter])
        # readings of the ramps within its noise are at its ends, and hide a decay
        inside = np.flatnonzero(on >= middle - _LOW * noise)
        inner = on[inside[0] : inside[-1] + 1]
        decays.append(
            _means_of_parts(inner) - middle if inner.size >= _PARTS else bent[-1][:_PARTS]
        )
    if 2 * len(bent) < top.size:
        return None
    mean, spread = np.mean(bent, axis=0), np.std(bent, axis=0) / np.sqrt(len(bent))
    clearly = mean > np.maximum(_CLEARLY * spread, _LEVEL * noise)
    if mean[_PARTS:].max() > _BENT * noise or clearly.any():
        return None
    mean, spread = np.mean(decays, axis=0), np.std(decays, axis=0) / np.sqrt(len(decays))
    ends = 1.5 * mean[[0, -1]] - 0.5 * mean[[1, -2]]
    most, least = (max(float((ends + way * spread[[0, -1]]).max()), 0.0) for way in (1, -1))
    # if a cycle begins or ends in its plateau, little of it is left
    return np.where(np.isfinite(level), level, top - np.nanmedian(top - level)), most, least


def _led_to_corner(
    values: Floats, driven: Floats, begin: Integers, end: Integers, level: Floats
) -> Floats | None:
    """Level of a series extrapolated along each approach to the rest of the driven channel.

    A parabola is fitted over the last third of the way of the driven channel to the ``level`` of
    its rest: a relaxing series is farthest at that corner, and the mean of noisy corners is blunt.
    NaN for few readings.  None where the driven channel rounds its corners and gives no level.
    """
    found, rounded = np.full(begin.size, np.nan), []
    clear = _CLEAR * reading_noise(driven)
    for row, (start, stop) in enumerate(zip(begin.tolist(), end.tolist(), strict=True)):
        left, answer = level[row] - driven[start : stop + 1], values[start : stop + 1]
        left *= np.sign(left[0])
        if not (left[0] > 3 * clear and np.isfinite(left + answer).all()):
            continue
        low = left.size - int(np.argmax(left[::-1] > left[0] / 3))
        high = low + int(np.argmax(np.append(left[low:], 0.0) < clear))
        if high - low < _FEWEST_OF_APPROACH:
            continue
        found[row] = np.polyfit(left[low:high], answer[low:high], 2)[-1]
        # the readings beside a corner lie on the line of the approach so far, or on the rest
        near = high - (high - low) // 4 - 1
        line = np.polyfit(np.arange(low, near), left[low:near], 1)
        if line[0] < 0:  # and not one code of a converter
            stop = min(-line[1] / line[0] + high - near, left.size)
            beside = np.arange(near, max(stop, high), dtype=int)
            rounded.append(np.mean(left[beside] - np.fmax(np.polyval(line, beside), 0.0)))
    if len(rounded) < _FEWEST_TURNS:
        return None
    spread = float(np.std(rounded)) / np.sqrt(len(rounded))
    return found if abs(np.mean(rounded)) < _CLEAR * spread else None


_FEWEST_OF_APPROACH = 6  # readings


_FEWEST_TURNS = 5


def _mean_of_rest(values: Floats, at: Integers, greatest: Floats, *, within: Floats) -> Floats:
    """Mean of the greatest reading of a rest and the next one, or the greatest one if alone."""
    beside = np.fmax(values[np.maximum(at - 1, 0)], values[np.minimum(at + 1, values.size - 1)])
    return np.where(greatest - beside < within, (greatest + beside) / 2, greatest)


_STEEP = 20.0  # noise of a reading, between the slow steps and the fast ones


_UNEVEN = 2.0  # duration of the slower stroke of a saw over that of the faster one


_OF_A_STEP = 0.05  # of the mean step of a branch


_CLEAR = 3.0  # noise of a reading, and standard errors: limit for a ramp, a rounding or a creep


def _bow(values: Floats, at: Integers) -> Floats:
    """Height above the greatest reading of a parabola through it and its neighbours."""
    before, beside, after = (values[np.clip(at + k, 0, values.size - 1)] for k in (-1, 0, 1))
    bend, slope = 2 * beside - before - after, (after - before) / 2
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(bend > 0, np.minimum(slope**2 / (2 * bend), bend / 8), 0.0)


def _farther(values: Floats, one: Integers, other: Integers) -> Integers:
    """Turns at that end of each rest at which a series is greater on average."""
    apart = take_samples(values, one) - take_samples(values, other)
    known = apart[np.isfinite(apart)]
    return other if known.size and known.mean() < 0 else one


def _places(values: Floats, low: Integers, high: Integers) -> Integers:
    """Sample of the greatest value in each window."""
    known = np.where(np.isfinite(values), values, -np.inf)
    return np.array([
        start + int(np.argmax(known[start : stop + 1]))
        for start, stop in zip(np.maximum(low, 0).tolist(), high.tolist(), strict=True)
    ])  # fmt: skip


def take_noise_off_levels(
    measured: Floats,
    values: Floats,
    cycles: Cycles,
    *,
    reach: int,
    turn: Turn,
    noise: float,
    way: int,
    may_dwell: bool,
    of_corners: float,
    rests: tuple[Floats, Floats] | None,
) -> bool:
    """Merge the valleys of touching cycles, and subtract the effect of noise from extremes.

    ``measured`` has the rows of top, first and last valley, and of the possible error of a turn,
    and is changed.  A channel that is held at its turns is at the mean of its readings there; the
    return value says so.  A series that responds to one that ``rests``, given by its readings and
    the rows of its levels, may be farthest at the corners of that.  Where corners may be mistaken
    for noise nothing is subtracted: the truth lies between.
    """
    top, first, last, missed = measured
    touch = np.flatnonzero(touching(cycles))
    both = last[touch - 1]
    if turn == "sharp":
        both = np.where(np.isfinite(both), both, first[touch])
    else:  # a cycle that lacks readings has no valley, but its neighbour has
        both = way * np.fmin(way * first[touch], way * both)
    first[touch] = both
    last[touch - 1] = np.where(np.isfinite(last[touch - 1]), both, np.nan)
    if turn == "sharp":
        return False
    peak = cycles.branch_last[:, 0]
    leads: list[Floats | None] = [None, None]
    if rests is not None:
        driven, (at_top, _, at_end, _) = rests
        (begin, leaves), end = cycles.branch_first.T, cycles.branch_last[:, 1]
        leads = [
            _led_to_corner(way * values, driven, begin, (peak + leaves) // 2, at_top),
            _led_to_corner(-way * values, driven, leaves, end, at_end),
        ]
    if may_dwell:
        begin, end = cycles.branch_first[:, 0], cycles.branch_last[:, 1]
        after = np.append(peak[1:], values.size - 1)
        upper = _plateau(way * values, begin, end, way * top)
        lower = _plateau(-way * values, peak, after, -way * last)
        if upper is not None and lower is not None:
            leads_to = [
                0.0 if lead is None else float(np.nanmean(lead - one[0]))
                for lead, one in zip(leads, (upper, lower), strict=True)
            ]
            above = sum(max(one) for one in zip((upper[1], lower[1]), leads_to, strict=True))
            # a responding series relaxes: its mean is the lower end of the range hidden by noise
            part = 0.0 if rests is None else 0.5
            out = [part * max(one) for one in zip((upper[2], lower[2]), leads_to, strict=True)]
            top[:], last[:] = way * (upper[0] + out[0]), -way * (lower[0] + out[1])
            first[1:] = last[:-1]
            np.hypot(missed, EITHER_WAY * above / 2, out=missed)
            return True
    noise = within_scatter(noise, top)
    leaves, apart = cycles.branch_first[:, 1], cycles.first[1:] - cycles.last[:-1]
    foot = cycles.first[touch]
    if not touch.size:  # the first one has an approach beside it
        foot = _farther(-way * values, cycles.first, cycles.last)[1:]
    (of_peak, peak_falls), (of_valley, valley_falls) = (
        noise_in_extreme(values, turn, reach=reach + int(np.median(rest)), sign=sign, noise=noise)
        for turn, sign, rest in (
            (_farther(way * values, peak, leaves), way, leaves - peak),
            (foot, -way, np.zeros(1) if touch.size or not apart.size else apart),
        )
    )
    either = EITHER_WAY * (of_peak + of_valley) / 2
    # possible loss of a corner where the mean turn is smoothed
    of_smoothing = EITHER_WAY * noise / 2
    if of_corners and 0 < noise < _LIKE_CORNERS * of_corners * np.nanmedian(np.abs(top - first)):
        np.hypot(missed, either, out=missed)
        return False
    top -= way * of_peak
    first += way * of_valley
    last += way * of_valley
    # the mean of noisy corners is blunt, and overstates the effect of noise
    dwells = float(np.median(cycles.branch_first[:, 1] - peak)) > 1
    blunt = may_dwell and (dwells or max(peak_falls, valley_falls) > _FALLS * noise)
    for lead, level, sign in zip(leads, (top, last), (way, -way), strict=True):
        ahead = None if lead is None else lead - sign * level
        # a series that creeps on in the rest is not farthest at its corner
        if ahead is not None and (more := float(np.nanmean(ahead))) > -2 * float(
            np.nanstd(ahead)
        ) / np.sqrt(np.isfinite(ahead).sum()):
            level += sign * np.where(np.isfinite(ahead), ahead, more)
            np.hypot(missed, more / 2, out=missed)  # a corner may be rounded within the noise
        else:
            np.hypot(missed, (either if blunt else of_smoothing) / np.sqrt(2), out=missed)
    return False


def turns_of_wave(
    answers: Floats,
    driven: Floats,
    cycles: Cycles,
    waveform: Waveform,
    noises: list[float],
    ways: list[int],
    *,
    sticks: bool,
) -> list[Turn]:
    """Kind of turn of each specimen; a sine has no corner, another wave by its record.

    Judged by the channel that responds to the driven one, since it is farthest at a corner of it.
    """
    peak = cycles.branch_last[:, 0]
    if waveform == "sinusoidal":
        return ["rounded"] * len(noises)
    if waveform == "other":
        begin, end = cycles.branch_first[:, 0], cycles.branch_last[:, 1]
        of_driven = within_scatter(reading_noise(driven), take_samples(driven, peak))
        rests = rests_at_turns(driven, peak)
        return [
            "sharp"
            if has_corners(
                driven, _places(way * answer, begin, end), sign=1, noise=of_driven, rests=rests
            )
            else "rounded"
            for answer, way in zip(answers, ways, strict=True)
        ]
    kind = kind_of_turns(driven, peak, noise=reading_noise(driven))
    if kind != "sharp":
        return [kind] * len(noises)
    found = [
        kind_of_turns(way * answer, peak, noise=own, in_doubt=kind)
        for answer, own, way in zip(answers, noises, ways, strict=True)
    ]
    # strain that sticks at a corner of the load appears rounded there
    return ["sharp" if one == kind or (sticks and one == "rounded") else "hidden" for one in found]


def way_of_series(values: Floats, cycles: Cycles) -> int:
    """1 for a series that is greater at the peaks of the cycles than at their valleys, else -1."""
    ends = (take_samples(values, one) for one in (cycles.branch_last[:, 0], cycles.first))
    change = np.subtract(*ends)
    known = change[np.isfinite(change)]
    return -1 if known.size and np.median(known) < 0 else 1


def share_of_rise(time: Floats, cycles: Cycles, series: Floats | None = None) -> Floats:
    """Fraction of the time of each cycle taken by its rise.

    For a ``series`` that may rest at its turns, from its own extremes: the response to a machine
    that dwells is farthest where the dwell begins or ends; the machine turns anywhere between.
    """
    begin, peak, end = (
        cycles.branch_first[:, 0], cycles.branch_last[:, 0], cycles.branch_last[:, 1]
    )  # fmt: skip
    if series is not None:
        follows = touching(cycles)
        top = _places(series, begin, end)
        begin = _places(-series, np.where(follows, np.roll(peak, 1), begin), peak)
        end = np.where(np.roll(follows, -1), np.roll(begin, -1), _places(-series, peak, end))
        peak = top
    start, turn, stop = (take_samples(time, one) for one in (begin, peak, end))
    rise, period = turn - start, stop - start
    on_rise, on_fall = counted_on_flanks(cycles)
    if (on_rise | on_fall).any():  # one of their strokes is in two parts
        whole = take_samples(time, cycles.last) - take_samples(time, cycles.first)
        rise = np.where(on_rise, whole - (stop - turn), rise)
        period = np.where(on_rise | on_fall, whole, period)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(rise / period)
