r"""Fundamental of a series over each cycle, at the frequency of the cycles around it.

.. math:: y(t) \approx \bar y + a \cos \omega t + b \sin \omega t

by least squares over the samples of the cycle, weighted by time.  Noise and sampling shift a turn
by a sample, so that the duration of one cycle is not a period; the mean over twenty is.

References
----------
.. [1] M. Abramowitz and I. A. Stegun, "Handbook of Mathematical Functions," NBS, 1964, eqs.
   4.3.16 and 4.3.17 (sums of angles), 4.3.65 and 4.3.66 (series).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from reduction.record.arrays import run_blocks
from reduction.record.errors import DataError
from reduction.record.measurement import Bools, Floats, Integers, read_only_arrays
from reduction.record.samples import take_samples
from reduction.stages.cycles.cycle_product import Cycles
from reduction.stages.cycles.periods import periods_alone, spread_of_turns
from reduction.stages.cycles.reading_noise import reading_noise


def sums_over_cycles(values: Floats, first: Integers, last: Integers) -> Floats:
    """Sum of a series over the samples from ``first`` up to but excluding ``last``.

    Examples
    --------
    >>> sums_over_cycles(np.arange(6.0), np.array([0, 3]), np.array([3, 5]))
    array([3., 7.])
    >>> sums_over_cycles(np.arange(6.0), np.array([0, 6]), np.array([3, 6]))
    array([3., 0.])
    """
    if first.size == 0:
        return np.empty(0)
    holds_some = last > first
    if not holds_some.all():  # for an empty range reduceat gives the sample at its beginning
        sums = np.zeros(first.size)
        sums[holds_some] = sums_over_cycles(values, first[holds_some], last[holds_some])
        return sums
    # pairs (first, last): the even entries are the sums, the odd ones the gaps between cycles;
    # the last pair's end may be one past the series, which reduceat does not accept
    pairs = np.column_stack([first, last]).ravel()
    stop = int(last[-1])
    return np.asarray(np.add.reduceat(values[:stop], pairs[:-1])[::2])


# a cycle that lacks a larger fraction of its readings gives no results
_MISSING_SHARE = 0.1


def bridge_gaps(
    values: Floats, first: Integers, last: Integers, *, is_smooth: bool = False
) -> tuple[Floats, Bools]:
    """Series with missing readings bridged, and the cycles that lack too many of them.

    Notes
    -----
    Over a tenth of a cycle a straight line is wrong by up to 20 % of its amplitude at the corner of
    two ramps: there the lines through the readings on either side meet (`_on_corners`).  For a
    series that ``is_smooth`` a cubic is used, through the readings beside the gap and those
    one length of the gap away from them: for a sine its error there is 0.4 %.

    Examples
    --------
    >>> bridged, lacks = bridge_gaps(np.array([0.0, np.nan, 2.0]), np.array([0]), np.array([2]))
    >>> print(bridged, lacks)
    [0. 1. 2.] [ True]

    The crest of a sine of 16 readings:

    >>> wave = np.cos(2 * np.pi * np.arange(-8, 9) / 16)
    >>> gap = np.where(np.arange(17) == 8, np.nan, wave)
    >>> for smooth in (False, True):
    ...     print(bridge_gaps(gap, np.array([0]), np.array([16]), is_smooth=smooth)[0][8].round(3))
    0.924
    0.996
    """
    missing = np.isnan(values)
    if not missing.any():
        return values, np.zeros(first.size, dtype=bool)
    present = np.flatnonzero(~missing)
    lost = sums_over_cycles(missing.astype(np.float64), first, last)
    too_many = lost > _MISSING_SHARE * (last - first)
    if present.size == 0:
        return np.zeros_like(values), np.ones(first.size, dtype=bool)
    bridged = values.copy()
    gaps = np.flatnonzero(missing)
    bridged[gaps] = np.interp(gaps, present, values[present])
    after = np.searchsorted(present, gaps)
    inside = (after > 0) & (after < present.size)
    gaps, after = gaps[inside], after[inside]
    length = present[after] - present[after - 1] - 1
    beside = np.stack([length, 0 * length], axis=1)
    places = np.hstack([after[:, None] - 1 - beside, after[:, None] + beside[:, ::-1]])
    known = (places[:, 0] >= 0) & (places[:, 3] < present.size)
    gaps, nodes = gaps[known], present[places[known]]
    if is_smooth:
        bridged[gaps] = sum(
            values[nodes[:, one]]
            * np.prod(
                [
                    (gaps - nodes[:, other]) / (nodes[:, one] - nodes[:, other])
                    for other in range(4)
                    if other != one
                ],
                axis=0,
            )
            for one in range(4)
        )
    else:
        bridged[gaps] = _on_corners(values, gaps, nodes, bridged[gaps])
    return bridged, too_many


def _on_corners(values: Floats, gaps: Integers, nodes: Integers, on_chords: Floats) -> Floats:
    """Readings of gaps on the lines through two readings on either side, where these meet inside.

    Elsewhere, and where the series bends before or behind the gap as it does in it, on the chord.
    """
    outer = np.clip(2 * nodes[:, [0, 3]] - nodes[:, [1, 2]], 0, values.size - 1)
    times = np.column_stack([outer[:, 0], nodes, outer[:, 1]])
    with np.errstate(divide="ignore", invalid="ignore"):  # at the ends of the series
        slopes = np.diff(values[times], axis=1) / np.diff(times, axis=1)
    earlier, arrives, chord, leaves, later = slopes.T
    bend = arrives - leaves
    is_corner = np.abs(bend) > np.maximum(np.abs(arrives), np.abs(leaves))
    is_corner &= np.fmax(np.abs(arrives - earlier), np.abs(leaves - later)) < np.abs(bend) / 8
    is_corner &= (arrives - chord) * (chord - leaves) > 0
    on_lines = np.stack(
        [
            values[nodes[:, 1]] + arrives * (gaps - nodes[:, 1]),
            values[nodes[:, 2]] - leaves * (nodes[:, 2] - gaps),
        ]
    )
    corner = np.where(bend > 0, on_lines.min(axis=0), on_lines.max(axis=0))
    return np.asarray(np.where(is_corner, corner, on_chords))


_PLACES = 1 << 12  # a power of two, so that whole turns are removed from an index by a bit mask


_STEP = 2 * np.pi / _PLACES


_COSINE, _SINE = np.cos(_STEP * np.arange(_PLACES)), np.sin(_STEP * np.arange(_PLACES))


def _cosine_and_sine(phase: Floats) -> tuple[Floats, Floats]:
    """Cosine and sine of many angles, in half the time of `numpy.cos` and `numpy.sin` or less.

    Notes
    -----
    From the nearest of 4,096 tabulated angles by the sum of two angles ([1]_).  For the remainder,
    at most 8e-4, the omitted terms of both series, of fifth and sixth power, are below 1e-17.

    Examples
    --------
    >>> cosine, sine = _cosine_and_sine(np.array([0.0, np.pi / 6]))
    >>> print(cosine[0], sine[1].round(15))
    1.0 0.5
    """
    nearest = phase * (1 / _STEP)
    np.rint(nearest, out=nearest)
    with np.errstate(invalid="ignore"):  # NaN has no place, and its remainder is NaN
        place = nearest.astype(np.intp)
    place &= _PLACES - 1
    nearest *= _STEP
    rest = np.subtract(phase, nearest, out=nearest)
    square = rest * rest
    less = square * (-1 / 24)  # one less the cosine of the remainder
    less += 0.5
    less *= square
    square *= rest
    square *= 1 / 6
    rest -= square  # now the sine of the remainder
    cosine, sine = _COSINE.take(place), _SINE.take(place)
    change = np.multiply(sine, rest, out=square)
    change += cosine * less
    rest *= cosine
    less *= sine
    rest -= less
    cosine -= change
    sine += rest
    return cosine, sine


_AROUND = 10  # cycles on either side whose durations give the period of one


_LEAST_DETERMINANT = 1e-9  # of the normal equations; 2 where samples are many and even

_LEAST_SHARE = 1e-12  # of the last reading of a cycle


@dataclass(frozen=True)
@read_only_arrays
class CycleBasis:
    """Cosine and sine of each sample's phase in its cycle, times its share of the cycle.

    ``share`` (twice the trapezoid's weight over the duration), ``cosine`` and ``sine`` have
    shape (n_samples,); ``end_share`` is the share of the last sample of each cycle,
    ``end_cosine`` and ``end_sine`` the same times those of its phase.  ``inverse``, shape
    (n_cycles, 3, 3), converts sums of a series over share, cosine and sine to its mean and
    its two amplitudes; ``turn_rate`` [rad s-1] is that of the phase; ``first`` and ``last``
    are the cycles to which they belong.
    """

    share: Floats
    cosine: Floats
    sine: Floats
    end_share: Floats
    end_cosine: Floats
    end_sine: Floats
    inverse: Floats
    turn_rate: Floats
    first: Integers
    last: Integers


def cycle_basis(
    time: Floats, first: Integers, last: Integers, *, period: Floats | None = None
) -> CycleBasis:
    """Basis of the fundamental, common to all specimens of a test.

    Examples
    --------
    >>> basis = cycle_basis(np.arange(9.0), np.array([0]), np.array([8]))
    >>> bool(abs(basis.sine[:8].sum()) < 1e-15)
    True
    """
    duration = time[last] - time[first]
    if not np.all(duration > 0):
        bad = int(np.flatnonzero(~(duration > 0))[0])
        raise DataError(
            f"cycle {bad + 1} takes no time",
            found=f"{duration[bad]:g} s from its first to its last sample",
            needed="a time channel that rises over the cycle",
        )
    weight = np.zeros_like(time)
    np.subtract(time[2:], time[:-2], out=weight[1:-1])
    # an end of the cycle counts half; the other half belongs to the adjoining cycle
    weight[first] = time[first + 1] - time[first]
    # one value per sample from one value per cycle, with nothing between cycles
    gaps = np.diff(first, append=time.size) - (last - first)
    lengths = np.column_stack([last - first, gaps]).ravel()
    nothing = np.zeros(first.size)
    begin = int(first[0]) if first.size else time.size
    if period is None:
        period = mean_period(time[first], first, last, last_turn=time[last])
    turn_rate = 2 * np.pi / period
    phase = time[begin:] - np.repeat(np.column_stack([time[first], nothing]).ravel(), lengths)
    phase *= np.repeat(np.column_stack([turn_rate, nothing]).ravel(), lengths)
    share, cosine, sine = np.zeros_like(time), np.zeros_like(time), np.zeros_like(time)
    rate = np.repeat(np.column_stack([1 / duration, nothing]).ravel(), lengths)
    np.multiply(rate, weight[begin:], out=share[begin:])
    bare = _cosine_and_sine(phase)
    np.multiply(bare[0], share[begin:], out=cosine[begin:])
    np.multiply(bare[1], share[begin:], out=sine[begin:])
    # none of two readings at one time, but their phase is kept in it
    end_share = np.maximum((time[last] - time[last - 1]) / duration, _LEAST_SHARE)
    end_phase = turn_rate * duration
    end = end_share * np.cos(end_phase), end_share * np.sin(end_phase)
    gram = np.empty((first.size, 3, 3))
    gram[:, 0, 0] = sums_over_cycles(share, first, last) + end_share
    for row, (weighted, at_end) in enumerate(zip((cosine, sine), end, strict=True), start=1):
        gram[:, 0, row] = gram[:, row, 0] = sums_over_cycles(weighted, first, last) + at_end
        products = weighted[begin:] * bare[0]
        gram[:, row, 1] = gram[:, 1, row] = sums_over_cycles(
            products, first - begin, last - begin
        ) + at_end * np.cos(end_phase)
    gram[:, 2, 2] = gram[:, 0, 0] - gram[:, 1, 1]
    is_flat = ~(np.linalg.det(gram) > _LEAST_DETERMINANT)
    if is_flat.any():
        bad = int(np.flatnonzero(is_flat)[0])
        raise DataError(
            f"the samples of cycle {bad + 1} are too close in time to have a fundamental",
            found=f"{last[bad] - first[bad] + 1} samples from {time[first[bad]]:g} s to "
            f"{time[last[bad]]:g} s",
            needed="samples that are spread over the cycle",
            hint="Check the time channel.",
        )
    return CycleBasis(
        share,
        cosine,
        sine,
        end_share,
        *end,
        np.linalg.inv(gram).astype(np.float64),
        turn_rate,
        first,
        last,
    )


_ONE_SIDED = np.sqrt(5 / 2)


def steady_cycles(*amplitudes: Floats) -> Bools:
    """Cycles without those at both ends whose amplitude still differs from that of the next one.

    Examples
    --------
    >>> print(steady_cycles(np.array([0.4, 0.6, 0.8, 1.0, 1.0, 1.01, 1.0, 0.7])).astype(int))
    [0 0 0 0 1 1 0 0]
    """
    kept = np.ones(amplitudes[0].size, dtype=bool)
    for amplitude in amplitudes:
        if not np.isfinite(amplitude).any():
            continue
        with np.errstate(invalid="ignore"):
            changes = np.abs(np.diff(amplitude)) > _GROWING * np.nanmedian(amplitude)
        if changes.all():
            continue
        # and the adjoining one, which begins or ends at their level
        for part, first in (
            (kept, int(np.argmin(changes))),
            (kept[::-1], int(np.argmin(changes[::-1]))),
        ):
            part[: first + (first > 0)] = False
    return kept


_STEADY = 3  # cycles after the first: the turn at the end of a last one is not read


_GROWING = 0.03  # of the amplitude, from one cycle to the next


def mean_period(
    turns: Floats,
    first: Integers,
    last: Integers,
    *,
    last_turn: Floats,
    steady: Bools | None = None,
) -> Floats:
    """Mean duration of up to 21 touching cycles around each cycle; of steady ones if any.

    Examples
    --------
    >>> first = np.array([0, 8, 17])
    >>> ends = np.array([8, 17, 24])
    >>> print(mean_period(1.0 * first, first, ends, last_turn=1.0 * ends))
    [8. 8. 8.]
    """
    breaks = np.flatnonzero(last[:-1] != first[1:]) + 1
    place = np.arange(first.size)
    run = np.searchsorted(breaks, place, side="right")
    starts = np.concatenate([[0], breaks])
    stops = np.append(breaks, first.size) - 1
    if steady is not None:
        # in a growing wave the turns are early or late, depending on its phase
        begin = np.maximum(place[np.argmax(steady)], starts)
        end = np.minimum(place[::-1][np.argmax(steady[::-1])], stops)
        starts, stops = np.where(end - begin >= _STEADY, (begin, end), (starts, stops))
    centre = np.clip(place, starts[run], stops[run])
    low = np.maximum(centre - _AROUND, starts[run])
    high = np.minimum(centre + _AROUND, stops[run])
    mean: Floats = (last_turn[high] - turns[low]) / (high - low + 1)
    return mean


def _phase_turns(cosine: Floats, sine: Floats, basis: CycleBasis, time: Floats) -> Floats:
    """Time near the first sample of each cycle at which its fundamental turns.

    Examples
    --------
    >>> t = np.arange(14.0)
    >>> basis = cycle_basis(t, np.array([0]), np.array([12]))
    >>> wave = -np.cos(2 * np.pi * (t - 0.4) / 12)
    >>> print(_phase_turns(*fundamental(wave, basis)[:2], basis, t).round(3))
    [0.4]
    """
    past = np.arctan2(-sine, -cosine) / basis.turn_rate
    return time[basis.first] + np.where(np.isfinite(past), past, 0.0)


def fundamental(values: Floats, basis: CycleBasis) -> tuple[Floats, Floats, Floats]:
    r"""Cosine and sine amplitude of the fundamental in each cycle, and its mean.

    Notes
    -----
    A drift d over the cycle, linear in time, adds -d/pi to the sine: see `_mean_drift`.  Readings
    that span :math:`\delta` periods too much add :math:`\delta` times the other harmonics at the
    turn to the mean, and twice as much to the cosine, to first order.

    Examples
    --------
    >>> t = np.arange(13.0)
    >>> basis = cycle_basis(t, np.array([0]), np.array([12]))
    >>> wave = 7 + 3 * np.cos(2 * np.pi * t / 12) - np.sin(2 * np.pi * t / 12)
    >>> print(*(part.round(12) for part in fundamental(wave, basis)))
    [3.] [-1.] [7.]
    """
    first, last = basis.first, basis.last
    sums = np.stack(
        [
            sums_over_cycles(values * weights, first, last) + values[last] * at_end
            for weights, at_end in (
                (basis.share, basis.end_share),
                (basis.cosine, basis.end_cosine),
                (basis.sine, basis.end_sine),
            )
        ],
        axis=-1,
    )
    mean, cosine, sine = np.einsum("cij,cj->ic", basis.inverse, sums)
    # the readings of a cycle span a little more or less than a period: where the wave is no
    # sine, its excess over the fundamental there counts for as much
    end_cosine, end_sine = basis.end_cosine / basis.end_share, basis.end_sine / basis.end_share
    beyond = np.arctan2(end_sine, end_cosine) / (2 * np.pi)
    excess = values[first] + values[last] - 2 * mean - cosine * (1 + end_cosine) - sine * end_sine
    excess *= np.where(np.abs(beyond) < _BEYOND_PERIOD, beyond, 0.0) / 2
    return cosine - 2 * excess, sine, mean - excess


def part_means(values: Floats, basis: CycleBasis, middles: Integers) -> Floats:
    """Mean over time of a series in the three parts of each cycle between its middles.

    Examples
    --------
    >>> from reduction.stages.cycles.fundamental import cycle_basis
    >>> basis = cycle_basis(np.arange(9.0), np.array([0]), np.array([8]))
    >>> print(part_means(np.repeat([1.0, 3.0, 5.0], 3), basis, np.array([[3], [6]])).ravel())
    [1. 3. 5.]
    """
    first, last, share = basis.first, basis.last, basis.share
    weighted = values * share
    ends = (first, *middles, last)
    means = []
    for start, stop in pairwise(ends):
        total = sums_over_cycles(weighted, start, stop)
        weight = sums_over_cycles(share, start, stop)
        if stop is last:
            total += values[last] * basis.end_share
            weight += basis.end_share
        means.append(total / weight)
    return np.array(means)


def turn_over_cycle(phase: Floats, follows: Bools) -> Floats:
    """Change of phase over each cycle, from the adjoining ones; 0 where a row is broken. [rad].

    The phase of a first cycle has the transient behind its ramp: the step from it to the next one
    counts where it is less than thrice the step after it, as of a loss angle that settles.

    Examples
    --------
    >>> turn_over_cycle(np.array([0.5, 0.3, 0.2, 0.9, 0.2, 0.1]), np.array([0, 1, 1, 0, 1, 1]) > 0)
    array([-0.2 , -0.15, -0.1 ,  0.  , -0.1 , -0.1 ])
    """
    turns = np.angle(np.exp(1j * np.diff(phase)))
    steps = np.where(follows[1:], turns, np.nan)
    next_ones = np.abs(np.append(steps[1:], np.nan))
    is_transient = ~follows[:-1] & ~(np.abs(steps) < _OF_SETTLING_PHASE * next_ones)
    steps[is_transient] = np.nan
    before, after = np.append(np.nan, steps), np.append(steps, np.nan)
    known = np.isfinite(before).astype(int) + np.isfinite(after)
    return np.asarray((np.nan_to_num(before) + np.nan_to_num(after)) / np.maximum(known, 1))


def without_turning(
    cosine: Floats, sine: Floats, mean: Floats, turned: Floats
) -> tuple[Floats, Floats, Floats]:
    r"""Fundamental and mean in the middle of each cycle, for a wave whose phase changes in it.

    For :math:`A \cos(\theta + \varphi + q\theta)` over :math:`-\pi \le \theta \le \pi`, least
    squares give :math:`1 + q/2` times its cosine, :math:`1 - q/2` times its sine, and a mean of
    :math:`-q A \cos\varphi`, to first order: ``turned`` [rad] is :math:`2 \pi q`.

    Examples
    --------
    A wave that lags 0.2 in the middle of its cycle, and 0.03 less at its end than at its beginning:

    >>> t = np.arange(401.0)
    >>> wave = 7 - 3 * np.cos(2 * np.pi * t / 400 - 0.2 + 0.03 * (t / 400 - 0.5))
    >>> basis = cycle_basis(t, np.array([0]), np.array([400]))
    >>> cosine, sine, mean = without_turning(*fundamental(wave, basis), np.array([0.03]))
    >>> print(np.hypot(cosine, sine).round(3), mean.round(3))
    [3.] [7.]
    """
    share = turned / (4 * np.pi)
    cosine, sine = cosine / (1 + share), sine / (1 - share)
    return cosine, sine, mean - 2 * share * cosine


_BEYOND_PERIOD = 0.15  # of a period: a cycle of seven readings


_OF_SETTLING_PHASE = 3.0  # greatest step of the phase over the next one


_FITS = 2

_FAR_PERIOD = 2e-3  # relative; its square is a part of a million of the period

_PASSES = 12  # each divides the error by the number of cycles of a run, which may be two


def sine_period(
    time: Floats, driven: Floats, cycles: Cycles, period: Floats
) -> tuple[Floats, Floats, Floats]:
    """Period about each cycle, its own period, and the spread of a turn, by the driven phase.

    The first is a mean over neighbours, at which fundamentals are fitted; the second is
    from one phase to the next, so that the own periods of a test add up to its duration.
    Noise shifts the turns of a log by a sample; the phase of a fundamental over a
    hundred samples is known to a hundredth of one.  The phase of the other channel changes with its
    loss angle, which settles over a test.
    """
    phased, amplitude = np.empty((2, cycles.n_cycles))
    blocks = cycles.blocks()
    # the last cycle of a run is taken to end at the period of the others
    follows = cycles.last[:-1] == cycles.first[1:]
    ends_run = np.append(~follows, True)
    middle = (take_samples(time, cycles.first) + take_samples(time, cycles.last)) / 2

    def find(block: slice) -> None:
        low, high = int(cycles.first[block.start]), int(cycles.last[block.stop - 1]) + 1
        first, last = cycles.first[block] - low, cycles.last[block] - low
        basis = cycle_basis(time[low:high], first, last, period=period[block])
        level, _ = bridge_gaps(driven[low:high], first, last, is_smooth=True)
        cosine, sine, _ = fundamental(level, basis)
        amplitude[block] = np.hypot(cosine, sine)
        phased[block] = _phase_turns(cosine, sine, basis, time[low:high])

    for _ in range(_FITS):
        run_blocks(find, blocks, samples=(time, driven), longest=cycles.longest)
        # a wave that grows by g within a cycle seems to turn g / (4 pi) early
        grows = np.nan_to_num(turn_over_cycle(np.log(amplitude), np.append(False, follows)))
        phased += grows / (4 * np.pi) * period / (2 * np.pi)
        # a wrong period rotates the phase about the middle of the cycle, where it has no effect
        found, turns = period, phased
        for _ in range(_PASSES):
            turns = middle - (middle - phased) * found / period
            last_turn = np.append(turns[1:], np.nan)
            last_turn[ends_run] = (turns + found)[ends_run]
            found = mean_period(
                turns, cycles.first, cycles.last, last_turn=last_turn,
                steady=steady_cycles(amplitude),
            )  # fmt: skip
        # so it does to first order: a run that ends a reading early is fitted again
        off = np.abs(found[ends_run] / period[ends_run] - 1)
        if ends_run.sum() == 1 or not (off > _FAR_PERIOD).any():
            break
        period = found
    # the phase of a fundamental is uncertain by the noise of all readings of its cycle
    rise = take_samples(driven, cycles.branch_last[:, 0])
    half = float(np.nanmedian(rise - take_samples(driven, cycles.branch_first[:, 0]))) / 2
    readings = float(np.median(cycles.last - cycles.first))
    of_noise = reading_noise(driven) * np.sqrt(2 / readings) / half / (2 * np.pi)
    least = abs(of_noise) * float(np.median(found)) if half else 0.0
    spread = np.full_like(
        found, max(least, spread_of_turns(turns, cycles.first, cycles.last, step=0.0))
    )
    spread = np.hypot(spread, grows**2 / (8 * np.pi**2) * found)  # what the first order leaves
    alone, own, of_own = periods_alone(
        time, driven, cycles, is_sine=True, noise=reading_noise(driven)
    )
    found[alone], spread[alone] = own, np.fmax(of_own / np.sqrt(2), least)
    # the phase of a cycle is that of its middle: its own period is the mean of the two beside it
    step = np.where(follows, np.diff(turns), np.nan)
    before, after = np.append(np.nan, step), np.append(step, np.nan)
    beside = np.where(np.isnan(after), before, after), np.where(np.isnan(before), after, before)
    by_phase = np.isfinite(beside[0])
    by_phase[alone] = False
    # what a cycle has beside it on one side only counts one and a half times in a sum
    spread[by_phase & (np.isnan(before) | np.isnan(after))] *= _ONE_SIDED
    return found, np.where(by_phase, (beside[0] + beside[1]) / 2, found), spread
