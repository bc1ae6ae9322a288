r"""Loops of tension against strain: one row of dynamic quantities per cycle and specimen.

Energy, fundamental and drift of the loops of tension against strain.

Area of a closed loop of tension against strain.

.. math:: H = \oint T \, d\varepsilon = \sum_i T_i \, \Delta\varepsilon_i

A polygon through N samples of an ellipse is too small by :math:`(2\pi/N)^2/6`: 4.5 %
at 12 samples a cycle.  Where strain and tension run smoothly (sinusoidal tests) the
differences of strain are taken to eighth order, which leaves 1e-5 at 12 samples.  Where
the crosshead turns sharply (triangular tests) the polygon is the better area: it follows
straight branches exactly, and only the two tips between samples are cut, while a high
order difference would ring at each turn.

Readings of a series: their noise, and those that are missing.

Cosine and sine of many angles, from a table of one turn.

Fundamental of a series over each cycle, at the frequency of the cycles around it.

.. math:: y(t) \approx \bar y + a \cos \omega t + b \sin \omega t

by least squares over the samples of the cycle, weighted by time.  Noise and sampling put a turn
a sample early or late, so that a cycle's own duration is no period; the mean over twenty is.

Drift of a series from cycle to cycle, apart from the cycles themselves.

One row of dynamic quantities per cycle and specimen.

Dynamic quantities of a cycle from sums over its samples, and how far noise moves them.

Three readings of the slope of a loop, and how far apart they lie.

A loop of loss angle :math:`\delta` has, by "the line drawn between the ends of the loop",

.. math::

    |K| \cos\delta \;\text{(strain extremes)}, \qquad |K| \;\text{(amplitudes)}, \qquad
    |K| / \cos\delta \;\text{(tension extremes)}

Closed loops: one row of dynamic quantities a cycle and specimen.

Storage and loss of a wave that is no sine, at equal phase of the channel that the machine moves.
With that channel as :math:`\cos\theta` of its half range,

.. math::

    E'' = \frac{1}{\pi \varepsilon_a} \oint T \, d\cos\theta
        = \frac{H}{\pi \varepsilon_a^2}, \qquad
    E' = \frac{1}{\pi \varepsilon_a} \oint T \, d\sin\theta

([4]_), into which no time enters: the loss of an elastic curve is zero, however long its strokes
last.  Of a sine they are those of the fundamental over time.  Of a triangle they are not: a linear
material of constant loss angle has two thirds of its loss in a sine, since ramps make its area.

References
----------
.. [1] M. Abramowitz and I. A. Stegun, "Handbook of Mathematical Functions," NBS, 1964, eqs.
   4.3.16 and 4.3.17 (sums of angles), 4.3.65 and 4.3.66 (series).
.. [2] CG-D-39-80, sec. 2.2: apparent spring constant (eq. 1) and hysteresis (eq. 4).
.. [3] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.2 and A-3 (slope of the line between
   the ends of the loop; which ends is not said).
.. [4] ISO 4664-1:2022, "Rubber, vulcanized or thermoplastic - Determination of dynamic properties -
   Part 1: General guidance," ISO, Geneva (loss from the area of the loop).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise

import numpy as np
import scipy
from numpy.typing import ArrayLike

from reduction.record.arrays import as_same_shape, run_blocks
from reduction.record.errors import DataError
from reduction.record.measurement import Bools, Floats, Integers, read_only_arrays
from reduction.record.samples import (
    empty_like,
    release_pages,
    rounding_left,
    step_of_codes,
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
from reduction.stages.cycles.periods import (
    is_alone,
    own_periods,
    periods_alone,
    spread_of_turns,
    time_of_sample,
    touching,
)
from reduction.stages.cycles.turns import (
    STEEP,
    Turn,
    energy_beside_polygon,
    has_corners,
    kind_of_turns,
    level_at_corner,
    level_beside_corner,
    level_of_turn,
    missed_by_extreme,
    noise_in_extreme,
    rests_at_turns,
)

_EIGHTH_ORDER = (4 / 5, -1 / 5, 4 / 105, -1 / 280)


def _sums_over_cycles(values: Floats, first: Integers, last: Integers) -> Floats:
    """Sum of a series over the samples from ``first`` up to, not with, ``last``.

    Examples
    --------
    >>> _sums_over_cycles(np.arange(6.0), np.array([0, 3]), np.array([3, 5]))
    array([3., 7.])
    >>> _sums_over_cycles(np.arange(6.0), np.array([0, 6]), np.array([3, 6]))
    array([3., 0.])
    """
    if first.size == 0:
        return np.empty(0)
    holds_some = last > first
    if not holds_some.all():  # of nothing reduceat gives the sample at its begin
        sums = np.zeros(first.size)
        sums[holds_some] = _sums_over_cycles(values, first[holds_some], last[holds_some])
        return sums
    # pairs (first, last): the even entries are the sums, the odd ones the gaps between cycles;
    # the last pair's end may be one past the series, which reduceat does not take
    pairs = np.column_stack([first, last]).ravel()
    stop = int(last[-1])
    return np.asarray(np.add.reduceat(values[:stop], pairs[:-1])[::2])


def _smooth_steps(strain: Floats, first: Integers, last: Integers, stride: int = 1) -> Floats:
    """Eighth-order change of strain per stride of samples at each sample, shape (n_samples,).

    Where the record ends within four strides of a cycle, that cycle is continued
    periodically, its drift added, so that a log of one cycle is as good as any.
    """
    reach = stride * len(_EIGHTH_ORDER)
    ahead, behind = strain[:0], strain[:0]
    if first[0] < reach:
        start, stop = first[0], last[0]
        places = np.arange(-reach, 0) + (stop - start)
        behind = strain[np.clip(places, 0, None)] - (strain[stop] - strain[start])
    if strain.size - 1 - last[-1] < reach:
        start, stop = first[-1], last[-1]
        places = np.arange(strain.size, strain.size + reach) - (stop - start)
        ahead = strain[np.clip(places, None, strain.size - 1)] + (strain[stop] - strain[start])
    padded = np.concatenate([behind, strain, ahead])
    change = np.zeros_like(strain)
    low = reach - behind.size
    high = strain.size - (reach - ahead.size)
    inner = change[low:high]
    for offset, weight in enumerate(_EIGHTH_ORDER, start=1):
        at = reach + stride * offset
        inner += weight * padded[at : at + inner.size]
        at = reach - stride * offset
        inner -= weight * padded[at : at + inner.size]
    return change


def _loop_energy(
    tension: ArrayLike,
    strain: ArrayLike,
    first: Integers,
    last: Integers,
    *,
    waveform: Waveform = "triangular",
) -> tuple[Floats, Floats]:
    """Energy lost in each cycle and unit length, and its sensitivity to noise.

    Notes
    -----
    An open loop is closed by the straight line from its last sample to its first; `_without_drift`
    then takes out what the line adds.
    Independent noise of tension and strain leaves the energy unbiased, since no
    product of a reading with itself enters.

    Examples
    --------
    An ellipse of 12 samples a cycle, strain amplitude 0.2, tension in quadrature
    50 N: the area is pi * 0.2 * 50 = 31.416 J/m; the polygon gives 30.0.

    >>> phase = 2 * np.pi * np.arange(37) / 12
    >>> strain, tension = 0.2 * np.sin(phase), 50 * np.cos(phase)
    >>> first, last = np.array([12]), np.array([24])
    >>> energy, _ = _loop_energy(tension, strain, first, last, waveform="sinusoidal")
    >>> print(energy.round(3))
    [31.416]
    >>> print(_loop_energy(tension, strain, first, last)[0].round(3))
    [30.]
    """
    force, stretch = as_same_shape(tension=tension, strain=strain)
    if stretch.ndim != 1 or stretch.size < 3:
        raise DataError(
            "a loop is too short", found=f"{stretch.size} samples", needed="three or more"
        )
    if first.size == 0:
        return np.empty(0), np.empty(0)
    # tension is counted from the closing line, so that an end of the loop, whose strain is
    # noisy, does not enter with the whole of the mean tension
    closing = (force[last] + force[first]) / 2
    if waveform == "sinusoidal":
        step = _smooth_steps(stretch, first, last)
        work = force * step
        # the ends of a cycle count half, as in any trapezoid
        energy = _sums_over_cycles(work, first, last) + (work[last] - work[first]) / 2
        travel = _sums_over_cycles(step, first, last) + (step[last] - step[first]) / 2
        energy -= closing * travel
    else:
        step = np.diff(stretch)
        work = force[1:] + force[:-1]
        work *= step
        energy = _sums_over_cycles(work, first, last) / 2
        energy -= closing * (stretch[last] - stretch[first])
    np.multiply(step, step, out=step)
    return energy, np.sqrt(_sums_over_cycles(step, first, last))


def _without_drift(
    energy: Floats,
    *,
    end_tension: ArrayLike,
    mean_tension: ArrayLike,
    tension_drift: ArrayLike,
    end_strain: ArrayLike,
    mean_strain: ArrayLike,
    strain_drift: ArrayLike,
) -> Floats:
    r"""Energy that the loop would lose if neither tension nor strain drifted over the cycle.

    .. math:: H = H_c + (T_e - \bar T) \, d_\varepsilon - (\varepsilon_e - \bar\varepsilon) \, d_T

    Notes
    -----
    A cycle begins at a reversal, so its closing line lies at an extreme: while a rope still
    creeps by d a cycle under a tension amplitude, that line adds the amplitude times d to
    the area, which in a narrow loop is several per cent.  Both series are taken as a steady
    cycle and a drift that is linear in time; with y = y_s + d t / P the work of the drift,
    integrated by parts, is the correction.  Means of cycles carry little noise, so it adds none
    to speak of.

    Examples
    --------
    The ellipse of 31.416 J/m whose strain grows by 0.01 a cycle, begun at its least tension:
    the closed loop has 50 N * 0.01 = 0.5 J/m too much.

    >>> turn = np.linspace(0, 1, 401)
    >>> tension = 1000 - 50 * np.cos(2 * np.pi * turn)
    >>> strain = 0.01 * turn - 0.2 * np.sin(2 * np.pi * turn)
    >>> closed, _ = _loop_energy(tension, strain, np.array([0]), np.array([400]))
    >>> steady = _without_drift(closed, end_tension=950.0, mean_tension=1000.0,
    ...     tension_drift=0.0, end_strain=0.005, mean_strain=0.005, strain_drift=0.01)
    >>> print(closed.round(2), steady.round(2))
    [31.91] [31.41]
    """
    force = np.subtract(end_tension, mean_tension)
    stretch = np.subtract(end_strain, mean_strain)
    return np.asarray(energy + force * strain_drift - stretch * tension_drift)


# a cycle that lacks a larger share of its readings gives no numbers
_MISSING_SHARE = 0.1

_NOISE_SAMPLES = 65_536


def reading_noise(values: Floats) -> float:
    r"""Standard deviation of one reading, from third differences.

    .. math:: \sigma = 1.4826 \, \mathrm{median} |\Delta^3 y| / \sqrt{20}

    Parameters
    ----------
    values : ndarray, shape (n_samples,)
        A series that is smooth but for noise; at most its first 65,536 samples
        are used, so that reading in pieces changes nothing. [any]

    Returns
    -------
    noise : float
        In the unit of the series; 0 where fewer than four readings are finite. [any]

    Raises
    ------
    TypeError
        If the series is not numeric.

    Notes
    -----
    A third difference of white noise has 1 + 9 + 9 + 1 = 20 times its variance.  The
    median makes the turns of a triangular test count for nothing.

    Examples
    --------
    >>> noise = np.random.default_rng(1).normal(0, 0.25, 10_000)
    >>> print(round(reading_noise(noise + np.arange(10_000) ** 2), 2))
    0.25
    """
    third = np.diff(values[:_NOISE_SAMPLES], n=3)
    third = third[np.isfinite(third)]
    if third.size == 0:
        return 0.0
    return float(1.4826 * np.median(np.abs(third)) / np.sqrt(20))


def _bridge_gaps(values: Floats, first: Integers, last: Integers) -> tuple[Floats, Bools]:
    """Series with missing readings bridged, and the cycles that lack too many of them.

    Notes
    -----
    Over a tenth of a cycle a straight line is off by up to 5 % of its amplitude at a turn.

    Examples
    --------
    >>> bridged, lacks = _bridge_gaps(np.array([0.0, np.nan, 2.0]), np.array([0]), np.array([2]))
    >>> print(bridged, lacks)
    [0. 1. 2.] [ True]
    """
    missing = np.isnan(values)
    if not missing.any():
        return values, np.zeros(first.size, dtype=bool)
    present = np.flatnonzero(~missing)
    lost = _sums_over_cycles(missing.astype(np.float64), first, last)
    too_many = lost > _MISSING_SHARE * (last - first)
    if present.size == 0:
        return np.zeros_like(values), np.ones(first.size, dtype=bool)
    bridged = values.copy()
    gaps = np.flatnonzero(missing)
    bridged[gaps] = np.interp(gaps, present, values[present])
    return bridged, too_many


_PLACES = 1 << 12  # a power of two, so that the turns come off an index bit by bit

_STEP = 2 * np.pi / _PLACES

_COSINE, _SINE = np.cos(_STEP * np.arange(_PLACES)), np.sin(_STEP * np.arange(_PLACES))


def _cosine_and_sine(phase: Floats) -> tuple[Floats, Floats]:
    """Cosine and sine of many angles, in half the time of `numpy.cos` and `numpy.sin` or less.

    Notes
    -----
    From the nearest of 4,096 tabulated angles by the sum of two angles ([1]_).  Over the rest, at
    most 8e-4, the next terms of both series, of fifth and sixth power, are below 1e-17.

    Examples
    --------
    >>> cosine, sine = _cosine_and_sine(np.array([0.0, np.pi / 6]))
    >>> print(cosine[0], sine[1].round(15))
    1.0 0.5
    """
    nearest = phase * (1 / _STEP)
    np.rint(nearest, out=nearest)
    with np.errstate(invalid="ignore"):  # NaN has no place, and its rest is NaN
        place = nearest.astype(np.intp)
    place &= _PLACES - 1
    nearest *= _STEP
    rest = np.subtract(phase, nearest, out=nearest)
    square = rest * rest
    less = square * (-1 / 24)  # one less the cosine of the rest
    less += 0.5
    less *= square
    square *= rest
    square *= 1 / 6
    rest -= square  # now its sine
    cosine, sine = _COSINE.take(place), _SINE.take(place)
    change = np.multiply(sine, rest, out=square)
    change += cosine * less
    rest *= cosine
    less *= sine
    rest -= less
    cosine -= change
    sine += rest
    return cosine, sine


_AROUND = 10  # cycles on either side whose durations make the period of one

_LEAST_DETERMINANT = 1e-9  # of the normal equations; 2 where samples are many and even


@dataclass(frozen=True)
@read_only_arrays
class _CycleBasis:
    """Cosine and sine of each sample's phase in its cycle, times its share of the cycle.

    ``share`` (twice the trapezoid's weight over the duration), ``cosine`` and ``sine`` have
    shape (n_samples,); ``end_share`` is the share of the last sample of each cycle,
    ``end_cosine`` and ``end_sine`` the same times those of its phase.  ``inverse``, shape
    (n_cycles, 3, 3), turns sums of a series over share, cosine and sine into its mean and
    its two amplitudes; ``turn_rate`` [rad s-1] is that of the phase; ``first`` and ``last``
    are the cycles they were made for.
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


def _cycle_basis(
    time: Floats, first: Integers, last: Integers, *, period: Floats | None = None
) -> _CycleBasis:
    """Basis of the fundamental, common to all specimens of a test.

    Examples
    --------
    >>> basis = _cycle_basis(np.arange(9.0), np.array([0]), np.array([8]))
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
    # an end of the cycle counts half; the other half belongs to the cycle that it touches
    weight[first] = time[first + 1] - time[first]
    # one value a sample from one value a cycle, with nothing between cycles
    gaps = np.diff(first, append=time.size) - (last - first)
    lengths = np.column_stack([last - first, gaps]).ravel()
    nothing = np.zeros(first.size)
    begin = int(first[0]) if first.size else time.size
    if period is None:
        period = _mean_period(time[first], first, last, last_turn=time[last])
    turn_rate = 2 * np.pi / period
    phase = time[begin:] - np.repeat(np.column_stack([time[first], nothing]).ravel(), lengths)
    phase *= np.repeat(np.column_stack([turn_rate, nothing]).ravel(), lengths)
    share, cosine, sine = np.zeros_like(time), np.zeros_like(time), np.zeros_like(time)
    rate = np.repeat(np.column_stack([1 / duration, nothing]).ravel(), lengths)
    np.multiply(rate, weight[begin:], out=share[begin:])
    bare = _cosine_and_sine(phase)
    np.multiply(bare[0], share[begin:], out=cosine[begin:])
    np.multiply(bare[1], share[begin:], out=sine[begin:])
    end_share = (time[last] - time[last - 1]) / duration
    end_phase = turn_rate * duration
    end = end_share * np.cos(end_phase), end_share * np.sin(end_phase)
    gram = np.empty((first.size, 3, 3))
    gram[:, 0, 0] = _sums_over_cycles(share, first, last) + end_share
    for row, (weighted, at_end) in enumerate(zip((cosine, sine), end, strict=True), start=1):
        gram[:, 0, row] = gram[:, row, 0] = _sums_over_cycles(weighted, first, last) + at_end
        products = weighted[begin:] * bare[0]
        gram[:, row, 1] = gram[:, 1, row] = _sums_over_cycles(
            products, first - begin, last - begin
        ) + at_end * np.cos(end_phase)
    gram[:, 2, 2] = gram[:, 0, 0] - gram[:, 1, 1]
    is_flat = ~(np.linalg.det(gram) > _LEAST_DETERMINANT)
    if is_flat.any():
        bad = int(np.flatnonzero(is_flat)[0])
        raise DataError(
            f"the samples of cycle {bad + 1} stand too close in time to have a fundamental",
            found=f"{last[bad] - first[bad] + 1} samples from {time[first[bad]]:g} s to "
            f"{time[last[bad]]:g} s",
            needed="samples that are spread over the cycle",
            hint="Check the time channel.",
        )
    return _CycleBasis(
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


def steady_cycles(*amplitudes: Floats) -> Bools:
    """Cycles but for the first and the last ones, each of another amplitude than its neighbour.

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
        # and the one beside them, which begins or ends at their level
        for part, first in (
            (kept, int(np.argmin(changes))),
            (kept[::-1], int(np.argmin(changes[::-1]))),
        ):
            part[: first + (first > 0)] = False
    return kept


_GROWING = 0.03  # of the amplitude, from one cycle to the next


def _mean_period(
    turns: Floats,
    first: Integers,
    last: Integers,
    *,
    last_turn: Floats,
    steady: Bools | None = None,
) -> Floats:
    """Mean duration of up to 21 cycles that touch, around each cycle; of steady ones if any are.

    Examples
    --------
    >>> first = np.array([0, 8, 17])
    >>> ends = np.array([8, 17, 24])
    >>> print(_mean_period(1.0 * first, first, ends, last_turn=1.0 * ends))
    [8. 8. 8.]
    """
    breaks = np.flatnonzero(last[:-1] != first[1:]) + 1
    place = np.arange(first.size)
    run = np.searchsorted(breaks, place, side="right")
    starts = np.concatenate([[0], breaks])
    stops = np.append(breaks, first.size) - 1
    if steady is not None:
        # a wave that grows turns early or late by its phase
        begin = np.maximum(place[np.argmax(steady)], starts)
        end = np.minimum(place[::-1][np.argmax(steady[::-1])], stops)
        starts, stops = np.where(begin <= end, (begin, end), (starts, stops))
    centre = np.clip(place, starts[run], stops[run])
    low = np.maximum(centre - _AROUND, starts[run])
    high = np.minimum(centre + _AROUND, stops[run])
    mean: Floats = (last_turn[high] - turns[low]) / (high - low + 1)
    return mean


def _phase_turns(cosine: Floats, sine: Floats, basis: _CycleBasis, time: Floats) -> Floats:
    """Time near the first sample of each cycle at which its fundamental turns.

    Examples
    --------
    >>> t = np.arange(14.0)
    >>> basis = _cycle_basis(t, np.array([0]), np.array([12]))
    >>> wave = -np.cos(2 * np.pi * (t - 0.4) / 12)
    >>> print(_phase_turns(*_fundamental(wave, basis)[:2], basis, t).round(3))
    [0.4]
    """
    past = np.arctan2(-sine, -cosine) / basis.turn_rate
    return time[basis.first] + np.where(np.isfinite(past), past, 0.0)


def _fundamental(values: Floats, basis: _CycleBasis) -> tuple[Floats, Floats, Floats]:
    """Cosine and sine amplitude of the fundamental in each cycle, and its mean.

    Notes
    -----
    A drift d over the cycle, linear in time, adds -d/pi to the sine: see `_mean_drift`.

    Examples
    --------
    >>> t = np.arange(13.0)
    >>> basis = _cycle_basis(t, np.array([0]), np.array([12]))
    >>> wave = 7 + 3 * np.cos(2 * np.pi * t / 12) - np.sin(2 * np.pi * t / 12)
    >>> print(*(part.round(12) for part in _fundamental(wave, basis)))
    [3.] [-1.] [7.]
    """
    first, last = basis.first, basis.last
    sums = np.stack(
        [
            _sums_over_cycles(values * weights, first, last) + values[last] * at_end
            for weights, at_end in (
                (basis.share, basis.end_share),
                (basis.cosine, basis.end_cosine),
                (basis.sine, basis.end_sine),
            )
        ],
        axis=-1,
    )
    mean, cosine, sine = np.einsum("cij,cj->ic", basis.inverse, sums)
    return cosine, sine, mean


def _part_means(values: Floats, basis: _CycleBasis, middles: Integers) -> Floats:
    """Mean over time of a series in the three parts of each cycle between its middles.

    Examples
    --------
    >>> from reduction.stages.cycles.loops import _cycle_basis
    >>> basis = _cycle_basis(np.arange(9.0), np.array([0]), np.array([8]))
    >>> print(_part_means(np.repeat([1.0, 3.0, 5.0], 3), basis, np.array([[3], [6]])).ravel())
    [1. 3. 5.]
    """
    first, last, share = basis.first, basis.last, basis.share
    weighted = values * share
    ends = (first, *middles, last)
    means = []
    for start, stop in pairwise(ends):
        total = _sums_over_cycles(weighted, start, stop)
        weight = _sums_over_cycles(share, start, stop)
        if stop is last:
            total += values[last] * basis.end_share
            weight += basis.end_share
        means.append(total / weight)
    return np.array(means)


def _are_parted(cycles: Cycles) -> bool:
    """Whether rests part most cycles from the next one."""
    follows = touching(cycles)
    return bool(2 * np.count_nonzero(follows) < follows.size - 1)


def _drift_between_rests(top: Floats, valley: Floats, ends: Floats, number: Integers) -> Floats:
    """Steady drift of a series over each cycle where a rest parts it from the next one.

    Of the middle between its turns, since a mean over the cycle holds more or less of its rests.
    The median of three steps beside it: a first cycle after a ramp says nothing of the others.
    Between two cycles lies at least the time of those that the machine counted and did not store.

    Examples
    --------
    Cycles of 6 s every 10 s, of which each lies 2 higher than the last:

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
    that of a period; the two together lie around the end of a cycle, and the change from one
    end to the other is the drift.  At such a middle the series is near its mean, so a sample
    more or less, as noise puts the turns, does not enter; in a mean from turn to turn it does,
    with the whole amplitude.  Beside a transient (the first cycle after a ramp, a change of
    amplitude) one of these changes says nothing of this cycle: the median of three neighbours
    is taken, and of two the lesser, or zero where they disagree in sign.

    Examples
    --------
    Means that grow by 2 a cycle, and a transient in the first cycle of four.

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
    # an end of a run has no change of its own: that of its neighbour is the best guess
    touches = np.isfinite(around_end)
    of_next = np.append(np.where(touches, drift[1:], np.nan), np.nan)
    of_last = np.append(np.nan, np.where(touches, drift[:-1], np.nan))
    own = np.where(np.isfinite(change), drift, np.nan)
    found = np.where(np.isfinite(own), own, np.where(np.isfinite(of_next), of_next, of_last))
    return np.nan_to_num(found, nan=0.0)


_OF_GAP = 8  # part of a cycle, from its first turn on


def _gap_of_first(
    tension: Floats, strain: Floats, cycles: Cycles, *, noises: tuple[float, float]
) -> Floats:
    """Creep over the first cycle of a run under a driven load; NaN for others or if unclear.

    From its first eighth to that of the next cycle, at the same tension: a turn found a sample off,
    or a valley that the machine misses, is no creep.  A cycle after a ramp or a hold creeps more
    than its neighbours.  A driven position leaves no gap: the area as logged is the work.

    Examples
    --------
    Cycles that end 0.2 higher than they begin, but the first, which ends 1 higher:

    >>> angle = 2 * np.pi * np.arange(161) / 40
    >>> tension = -np.cos(angle)
    >>> strain = tension + np.interp(np.arange(161), [0, 40, 160], [0, 1, 1.6])
    >>> first = np.arange(0, 160, 40)
    >>> ends = np.column_stack([first, first + 20])
    >>> cycles = Cycles(first, first + 40, ends, ends + 20, np.ones((4, 2)),
    ...     np.zeros(161, np.int32), np.zeros(161, np.int8), np.zeros(161, bool), 0.1)
    >>> print(_gap_of_first(tension, strain, cycles, noises=(1e-3, 1e-3)).round(1))
    [0.9 nan nan nan]
    """
    found = np.full(cycles.n_cycles, np.nan)
    follows = touching(cycles)
    length = cycles.last - cycles.first
    for place in np.flatnonzero(np.append(follows[1:], False) & ~follows).tolist():
        count = int(length[place : place + 2].min()) // _OF_GAP + 1
        load, stretch = (
            np.stack([series[at : at + count] for at in cycles.first[place : place + 2]])
            for series in (tension, strain)
        )
        apart = load - load.mean(axis=1, keepdims=True)
        square = np.sum(apart**2)
        slope = np.sum(apart * stretch) / square if square > 0 else 0.0
        creep = np.diff(stretch.mean(axis=1) - slope * load.mean(axis=1))[0]
        error = np.hypot(noises[1], slope * noises[0]) * np.sqrt(2 / count)
        found[place] = creep if np.abs(creep) > _CLEAR * error else np.nan
    return found


_OF_PERIOD = ("rise", "turn", "fall")

_LEAST_STEP = 1e-9  # of the half range


def _at_equal_phase(
    values: Floats,
    driven: Floats,
    time: Floats,
    branch_first: Integers,
    branch_last: Integers,
    levels: Floats,
) -> tuple[Floats, Floats, Floats]:
    r"""Integral of a series over the sine of the phase of another, the mean of that sine, and x_a.

    .. math:: \oint y \, d\sin\theta, \qquad \overline{\sin\theta}, \qquad
              \cos\theta = \frac{x - \bar x}{x_a}

    Notes
    -----
    Between samples of a branch the series is a straight line over the other, so that the turns,
    near which the phase runs fast, cost nothing; where noise sends the other backward it is a
    straight line over the sine.  ``levels`` are those of the other in the first valley, the peak
    and the last valley of each cycle: at noisy readings it would end short of its turns.

    Examples
    --------
    A straight line of slope 900 whose strokes last 60 and 5 samples, amplitude 0.2:

    >>> strain = np.r_[np.linspace(-0.2, 0.2, 61), np.linspace(0.2, -0.2, 6)[1:]]
    >>> work, *_ = _at_equal_phase(900 * strain, strain, np.arange(66.0),
    ...     np.array([[0, 60]]), np.array([[60, 65]]), np.array([[-0.2], [0.2], [-0.2]]))
    >>> print((work / (np.pi * 0.2)).round(6))
    [900.]
    """
    n_cycles = branch_first.shape[0]
    work, mean, used = np.zeros((3, n_cycles))
    for column, way in ((0, -1.0), (1, 1.0)):
        begin, end = branch_first[:, column], branch_last[:, column]
        low, high = levels[column : column + 2]
        length = end - begin + 1
        row = np.repeat(np.arange(n_cycles), length)
        at = np.arange(row.size) + np.repeat(begin - np.cumsum(length) + length, length)
        half, middle = way * (low - high) / 2, (high + low) / 2
        used += np.abs(half) / 2
        with np.errstate(divide="ignore", invalid="ignore"):
            level = (driven[at] - middle[row]) / half[row]
        level[at == begin[row]], level[at == end[row]] = way, -way
        # noise takes a rest beyond its level as often as below it: the sine there is of other sign
        mirror = np.where(np.abs(level) > 1, 2 * np.sign(level), 0.0)
        inside = np.clip(np.where(mirror == 0, level, mirror - level), -1, 1)
        sine = np.where(mirror == 0, way, -way) * np.sqrt(1 - inside**2)
        # integral of the level over the sine
        area = (way * np.arccos(inside) + sine * (level + mirror)) / 2
        step, rise = np.diff(level), np.diff(sine)
        with np.errstate(divide="ignore", invalid="ignore"):
            over = (np.diff(area) - level[:-1] * rise) / step
            share = np.where(-way * step > _LEAST_STEP, over, rise / 2)
        load, seconds = values[at], time[at]
        inside = row[1:] == row[:-1]
        for total, part in (
            (work, load[:-1] * rise + np.diff(load) * share),
            (mean, (sine[1:] + sine[:-1]) / 2 * np.diff(seconds)),
        ):
            total += np.bincount(row[:-1][inside], part[inside], n_cycles)
    with np.errstate(divide="ignore", invalid="ignore"):
        return work, mean / (time[branch_last[:, 1]] - time[branch_first[:, 0]]), used


MEASURED = (
    "peak", "valley", "high", "low", "energy", "strain_step_norm", "force_cosine", "force_sine",
    "force_mean", "strain_cosine", "strain_sine", "strain_mean", "force_end", "strain_end",
    "force_rise", "force_turn", "force_fall", "strain_rise", "strain_turn", "strain_fall",
    "phase_work", "phase_sine", "phase_half",
    "force_top", "force_begin", "force_end_turn", "force_missed",
    "strain_top", "strain_begin", "strain_end_turn", "strain_missed", "energy_missed",
)  # fmt: skip

"""What is summed over the samples of a cycle, in this order."""


@dataclass(frozen=True)
class _Shape:
    """Half the range of a wave and its middle, over the amplitude of its fundamental.

    ``missed`` is the range that half the range may still have, by how much it changed with the
    number of harmonics, up or down, and by their noise.
    """

    half: float = 1.0
    middle: float = 0.0
    missed: float = 0.0


_MOST_HARMONICS = 16

_FINEST = 1e-3  # of a cycle, between phases

_CYCLES_OF_SHAPE, _SAMPLES_OF_SHAPE = 100, 400  # that are looked at; of each of them

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

    ``turned`` [rad] is what its phase turns by over each cycle; ``rounding`` is the standard
    uncertainty that the steps of a converter leave in each reading.

    Notes
    -----
    The answer to a sine is none where the material bends or has a kink at its turns, and its
    extremes are those of the wave and not of the fundamental.  Noise does not lift a sum of
    harmonics as it lifts the greatest of many readings.

    Examples
    --------
    A sine whose turns a tenth of its third harmonic makes sharper:

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
    # cycles of another amplitude are not of one wave
    middle = np.median(amplitude[known]) if known.size else np.nan
    known = known[np.abs(amplitude[known] - middle) < _OF_ONE_WAVE * middle]
    if known.size > _FEWEST_INSIDE:
        known = known[1:-1]  # what stands beside cycles of another amplitude may hold part of them
    if not known.size:
        return _Shape()
    some = known[
        np.unique(np.linspace(0, known.size - 1, min(known.size, _CYCLES_OF_SHAPE)).astype(int))
    ]
    # a wave that grows within its cycle has harmonics of that, which lift its extremes
    before, after = np.diff(amplitude, prepend=np.nan), np.diff(amplitude, append=np.nan)
    lesser = np.where(np.abs(before) < np.abs(after), before, after)
    growth = np.where(before * after > 0, lesser / amplitude, 0.0)
    turns = np.broadcast_to(turned, amplitude.shape)
    phases, waves = [], []
    for one in some.tolist():
        first, last = int(cycles.first[one]), int(cycles.last[one])
        part = slice(first, last + 1, max((last - first) // _SAMPLES_OF_SHAPE, 1))
        phase = 2 * np.pi * (time[part] - time[part.start]) / period[one]
        place = phase / (2 * np.pi) - 0.5
        level = (values[part] - mean[one] - drift[one] * place) / (1 + growth[one] * place)
        usable = np.isfinite(level)
        phase += turns[one] * place - np.arctan2(sine[one], cosine[one])
        phases.append(phase[usable])
        waves.append(level[usable] / amplitude[one])
    # a log in step with its period reads the same few phases of every cycle
    read = np.concatenate(phases) / (2 * np.pi) % 1
    order = min(_MOST_HARMONICS, int(1 / max(step_that_fills(read), _FINEST) - 2) // 2)
    if order < 2:
        return _Shape()
    orders = np.arange(1, order + 1)

    def terms(phase: Floats) -> Floats:
        angle = np.multiply.outer(phase, orders)
        return np.column_stack([np.ones(phase.size), np.cos(angle), np.sin(angle)])

    design, wave = terms(np.concatenate(phases)), np.concatenate(waves)
    of_wave = np.linalg.lstsq(design, wave, rcond=None)[0]
    spread = float(np.std(wave - design @ of_wave)) * np.sqrt(2 / wave.size)
    # of readings at the same phases every cycle has the same error
    n_phases = min(wave.size, 1 / max(step_that_fills(read), _FINEST))
    per_harmonic = rounding / middle * np.sqrt(2 / n_phases)
    spread = float(np.hypot(spread, per_harmonic))
    size = np.hypot(of_wave[1 : order + 1], of_wave[order + 1 :])
    # the fundamental is that of each cycle; a harmonic within the noise is none, but for the third,
    # which every curve that bends has, and which moves both extremes apart
    is_kept = ((size > _ABOVE_NOISE * spread) & (orders > 1)) | (orders == 3)
    weights = np.concatenate([[0.0], of_wave[1:] * np.tile(is_kept, 2)])
    weights[1] = 1.0
    lacks = (
        period[some] - (take_samples(time, cycles.last) - take_samples(time, cycles.first))[some]
    )
    if np.median(lacks / period[some]) > _FINEST:
        # of a stored cycle that ends before it is whole, the harmonics are part of its fundamental
        weights[:2] = of_wave[:2]
    curve = terms(np.linspace(0, 2 * np.pi, 721))
    # the sums of de la Vallee Poussin, which hardly swing over where a wave falls at once, and keep
    # the lower half of the harmonics as they are
    faded = np.clip(2 - 2 * orders / np.arange(max(order // 2, 1) + 1, order + 2)[:, None], 0, 1)
    faded = np.vstack([np.ones(order), faded])
    sums = curve @ (np.column_stack([np.zeros(len(faded)), np.tile(faded, 2)]) * weights).T
    low, high = sums.min(axis=0), sums.max(axis=0)
    half = (high - low) / 2
    missed = 2 * float(np.abs(half[-1] - half).max())
    rounded = WITHIN_STEP * per_harmonic * np.sqrt(1 + np.count_nonzero(is_kept))
    by_noise = WITHIN_STEP * spread * np.sqrt(np.count_nonzero(is_kept & (orders % 2 == 1)))
    missed = float(np.linalg.norm([missed, rounded, by_noise]))
    return _Shape(half[-1], (high[-1] + low[-1]) / 2, missed)


_IRREGULAR = 0.03  # change of amplitude from one cycle to the next, median


def _change_of(amplitude: Floats) -> float:
    """Median change from one cycle to the next, over the median. [1]."""
    known = amplitude[np.isfinite(amplitude)]
    if known.size < _FEWEST_INSIDE:
        return 0.0
    return float(np.median(np.abs(np.diff(known))) / np.median(known))


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
    gap: Floats | None = None,
) -> tuple[dict[str, Floats], dict[str, Floats]]:
    """Quantities of each cycle of one specimen, and their standard uncertainties.

    Notes
    -----
    Source: [2]_, eq. 1 and 4, freed of drift.  Where the drift is more than the range of the
    cycle, what it is taken off is NaN.

    Examples
    --------
    Of a triangular cycle from 100 to 300 N and from 1 to 3 %, K_ap is 100 N over 1 %:

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
    peak, valley = row["peak"], row["valley"]
    force_cos, strain_cos = row["force_cosine"], row["strain_cosine"]
    follows = touching(cycles)
    is_parted = waveform != "sinusoidal" and _are_parted(cycles)
    # of a sine the mean is fitted beside it: what a cycle has of a sample more or less is not in it
    parts = ("mean",) * 3 if waveform == "sinusoidal" else _OF_PERIOD
    force_drift, strain_drift = (
        _drift_between_rests(row[f"{name}_top"], row[f"{name}_begin"], ends, cycles.number)
        if is_parted
        else _mean_drift(np.stack([row[f"{name}_{part}"] for part in parts]), ends)
        for name in ("force", "strain")
    )
    of_neighbours, is_own = strain_drift, np.zeros(n_samples.size, dtype=bool)
    if gap is not None and not is_parted:
        is_own = np.abs(gap) > np.abs(strain_drift)
        strain_drift = np.where(is_own, gap, strain_drift)
    # drift of more than the range is that of a jump among the neighbours: no steady cycle is left
    force_drift[np.abs(force_drift) > peak - valley] = np.nan
    for drift in (strain_drift, of_neighbours):
        drift[np.abs(drift) > row["high"] - row["low"]] = np.nan
    force_sin = row["force_sine"] + force_drift / np.pi
    strain_sin = row["strain_sine"] + strain_drift / np.pi
    if waveform == "sinusoidal":
        shapes = shapes or (_Shape(), _Shape())
        mean, mean_strain = row["force_mean"], row["strain_mean"]
        amplitude = np.hypot(force_cos, force_sin)
        strain_amplitude = np.hypot(strain_cos, strain_sin)
        of_force, of_strain = shapes
        row["force_missed"] = of_force.missed * amplitude
        row["strain_missed"] = of_strain.missed * strain_amplitude
        mean = mean + of_force.middle * amplitude
        mean_strain = mean_strain + of_strain.middle * strain_amplitude
        amplitude, strain_amplitude = amplitude * of_force.half, strain_amplitude * of_strain.half
        begin = mean_strain - strain_amplitude
        # cycles of many amplitudes have no wave in common: what their logged extremes say of K_ap
        if _change_of(amplitude if control == "load" else strain_amplitude) > _IRREGULAR:
            by_extremes = np.nanmean(peak - valley) / np.nanmean(row["high"] - row["low"])
            by_wave = np.nanmean(amplitude) / np.nanmean(strain_amplitude)
            of_shape = amplitude * (by_extremes / by_wave - 1)
            row["force_missed"] = np.hypot(row["force_missed"], of_shape)
    else:
        begin = row["strain_begin"]
        if is_parted:  # all of it may take place on one way between the turns
            for name, drift in (("force", force_drift), ("strain", strain_drift)):
                row[f"{name}_missed"] = np.hypot(
                    row[f"{name}_missed"], _EITHER_WAY * np.abs(drift) / 4
                )
        # a cycle that is stored without the next one may end before its valley
        ends_alone = np.append(cycles.first[1:] == cycles.last[:-1] + 1, False)
        turns = [row["force_top"], row["force_begin"], row["force_end_turn"]]
        peak, valley = np.max(turns, axis=0), np.min(turns, axis=0)
        (mean, amplitude), (mean_strain, strain_amplitude) = (
            _mean_and_amplitude(
                row[f"{name}_top"],
                row[f"{name}_begin"],
                row[f"{name}_end_turn"],
                drift,
                rise_share,
                follows & ~ends_alone,
            )
            for name, drift, rise_share in (
                ("force", force_drift, rise_shares[0]),
                # what a first cycle lets out beyond its neighbours is no part of its wave
                ("strain", of_neighbours, rise_shares[1]),
            )
        )
    energy = _without_drift(
        row["energy"],
        end_tension=row["force_end"],
        mean_tension=row["force_mean"],
        tension_drift=force_drift,
        end_strain=row["strain_end"],
        mean_strain=row["strain_mean"],
        strain_drift=strain_drift,
    )
    at_peaks = row["energy"] - energy
    at_peaks *= drift_at_peaks(energy, row["energy"], amplitude * strain_amplitude)
    energy -= at_peaks
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
        u_extreme = np.hypot(noise, row["force_missed"] / np.sqrt(12))
        if waveform == "sinusoidal":
            u_extreme = np.hypot(noise, _missed_turn(amplitude, n_samples))
            u_half, u_strain = np.sqrt(2 / n_samples) * noise, np.sqrt(2 / n_samples) * strain_noise
            storage, loss = over_time, lost_over_time
            u_storage = u_loss = u_apparent = u_over_time
        else:
            # of one cycle the turn lies anywhere between two samples
            u_half = np.hypot(noise / np.sqrt(2), row["force_missed"] / np.sqrt(12))
            u_strain = np.hypot(strain_noise / np.sqrt(2), row["strain_missed"] / np.sqrt(12))
            # a missed turn takes the same share off both amplitudes; only noise is left
            u_apparent = apparent * np.hypot(noise / amplitude, strain_noise / strain_amplitude)
            u_apparent /= np.sqrt(2)
            drift, own = (
                (strain_drift, amplitude) if control == "load" else (force_drift, strain_amplitude)
            )
            in_phase = (row["phase_work"] + drift * row["phase_sine"]) / (np.pi * row["phase_half"])
            quadrature = energy / (np.pi * own**2)
            if control == "load":
                # compliances, of which the modulus is the inverse
                in_phase, quadrature = (
                    one / (in_phase**2 + quadrature**2) for one in (in_phase, quadrature)
                )
            storage, loss = in_phase, quadrature
            u_storage = np.sqrt(2 / n_samples) * both / strain_amplitude
            u_loss = np.abs(loss) * np.hypot(
                u_energy / energy, np.sqrt(2) * strain_noise / strain_amplitude
            )
        factor = loss / storage
        # where in its cycle the drift takes place is not known
        not_placed = drift_not_placed(energy, row["energy"], amplitude * strain_amplitude)
        # of the creep behind a ramp the later cycles do not tell
        placed = np.where(is_own, 1 / PLACE_OF_DRIFT, not_placed)
        placed *= np.abs(row["energy"] - energy)
        per_energy = 1 / (np.pi * strain_amplitude**2)
        u_loss = np.hypot(u_loss, placed * per_energy)
        u_over_time_lost = np.hypot(u_over_time, placed * per_energy)
        values = {
            "mean_tension": mean,
            "tension_amplitude": amplitude,
            "mean_strain": mean_strain,
            "strain_amplitude": strain_amplitude,
            "peak_tension": peak,
            "valley_tension": valley,
            "apparent_spring_constant": apparent,
            "hysteresis_energy": energy,
            "storage_spring_constant": storage,
            "loss_spring_constant": loss,
            "loss_factor": factor,
            "fundamental_energy_share": share,
            "closed_loop_energy": row["energy"],
            "storage_over_time": over_time,
            "loss_over_time": lost_over_time,
            "tension_turn_missed": row["force_missed"],
            "strain_turn_missed": row["strain_missed"],
            "energy_turn_missed": row["energy_missed"],
            "foot_strain": begin,
        }
        uncertainty = {
            "mean_tension": u_half,
            "tension_amplitude": u_half,
            "mean_strain": u_strain,
            "strain_amplitude": u_strain,
            "peak_tension": u_extreme,
            "valley_tension": u_extreme,
            "apparent_spring_constant": u_apparent,
            "hysteresis_energy": np.hypot(u_energy, placed),
            "storage_spring_constant": u_storage,
            "loss_spring_constant": u_loss,
            "loss_factor": np.abs(factor) * np.hypot(u_loss / loss, u_storage / storage),
            "fundamental_energy_share": np.abs(share)
            * np.hypot(u_over_time / np.abs(lost_over_time), u_energy / np.abs(energy)),
            "closed_loop_energy": u_energy,
            "storage_over_time": u_over_time,
            "loss_over_time": u_over_time_lost,
            "foot_strain": np.sqrt(2) * u_strain,
        }
    return values, uncertainty


def _turn_over_cycle(phase: Floats, follows: Bools) -> Floats:
    """Change of a phase of cycles over each, from those beside it; 0 where a row is parted. [rad].

    Examples
    --------
    >>> _turn_over_cycle(np.array([0.5, 0.3, 0.2, 0.2, 0.1]), np.array([0, 1, 1, 0, 1]) > 0)
    array([-0.2 , -0.15, -0.1 , -0.1 , -0.1 ])
    """
    turns = np.angle(np.exp(1j * np.diff(phase)))
    steps = np.where(follows[1:], turns, np.nan)
    before, after = np.append(np.nan, steps), np.append(steps, np.nan)
    known = np.isfinite(before).astype(int) + np.isfinite(after)
    return np.asarray((np.nan_to_num(before) + np.nan_to_num(after)) / np.maximum(known, 1))


def _without_turning(
    cosine: Floats, sine: Floats, mean: Floats, turned: Floats
) -> tuple[Floats, Floats, Floats]:
    r"""Fundamental and mean in the middle of each cycle, of a wave whose phase turns in it.

    Of :math:`A \cos(\theta + \varphi + q\theta)` over :math:`-\pi \le \theta \le \pi`, least
    squares give :math:`1 + q/2` times its cosine, :math:`1 - q/2` times its sine, and a mean of
    :math:`-q A \cos\varphi`, to first order: ``turned`` [rad] is :math:`2 \pi q`.

    Examples
    --------
    A wave that lags 0.2 in the middle of its cycle, and 0.03 less at its end than at its begin:

    >>> t = np.arange(401.0)
    >>> wave = 7 - 3 * np.cos(2 * np.pi * t / 400 - 0.2 + 0.03 * (t / 400 - 0.5))
    >>> basis = _cycle_basis(t, np.array([0]), np.array([400]))
    >>> cosine, sine, mean = _without_turning(*_fundamental(wave, basis), np.array([0.03]))
    >>> print(np.hypot(cosine, sine).round(4), mean.round(4))
    [3.] [7.]
    """
    share = turned / (4 * np.pi)
    cosine, sine = cosine / (1 + share), sine / (1 - share)
    return cosine, sine, mean - 2 * share * cosine


def _mean_and_amplitude(
    top: Floats,
    begin: Floats,
    end: Floats,
    drift: Floats,
    rise_share: Floats | float,
    follows: Bools,
) -> tuple[Floats, Floats]:
    """Mean of peak and valley and half of what lies between, without a steady drift.

    Of the valleys on either side, at the time of the peak.  Where no cycle comes before, the first
    valley is that of an approach or a hold, and no line through both is a drift: the one farther
    from the peak is taken, and of the range what drifts on the way from it to the peak.

    Examples
    --------
    A range of 20 that grows by 2 a cycle, the first after a hold at its valley:

    >>> one = np.array([-1.0, 1.0]), np.array([1.0, 3.0])
    >>> _mean_and_amplitude(
    ...     np.array([20.0, 22.0]), *one, np.array([2.0, 2.0]), 0.5, np.array([False, True]))
    (array([ 9.5, 12. ]), array([10., 10.]))
    """
    # of a channel of the wrong sign the top is the lower one
    far = np.where(np.abs(top - begin) > np.abs(top - end), begin, end)
    foot = np.where(follows, (1 - rise_share) * begin + rise_share * end, far)
    way = np.where(far == begin, rise_share, 1 - rise_share)
    amplitude = np.abs(top - foot) / 2 - np.where(follows, 0.0, way * np.abs(drift) / 2)
    return (top + foot) / 2, np.where(np.isnan(drift), np.nan, amplitude)


def _missed_turn(amplitude: Floats | float, n_samples: Floats) -> Floats:
    """How far the logged extreme may lie below the turn between two samples.

    A branch at constant rate rises by four amplitudes over N per sample; the turn lies
    within half a sample of the logged extreme, evenly spread, so the loss is spread evenly
    over half a step: the root of its mean square is the step over the root of 12.
    """
    missed: Floats = 4 * amplitude / n_samples / np.sqrt(12)
    return missed


@dataclass(frozen=True)
@read_only_arrays
class _SlopeReadings:
    """Slope of each loop by three readings; every array has the shape of the loops."""

    amplitude_ratio: Floats
    between_strain_extremes: Floats
    between_tension_extremes: Floats
    relative_spread: Floats


def slope_readings(apparent_spring_constant: ArrayLike, loss_factor: ArrayLike) -> _SlopeReadings:
    r"""Slope of an elliptical loop by amplitudes and by the two pairs of its extremes.

    .. math:: |K| \cos\delta, \quad |K|, \quad |K| / \cos\delta, \qquad
              \cos\delta = (1 + \tan^2\delta)^{-1/2}

    Parameters
    ----------
    apparent_spring_constant : array_like, shape (...)
        Tension amplitude over strain amplitude, of each loop. [N]
    loss_factor : array_like, shape (...)
        Tangent of the loss angle, of each loop. [1]

    Returns
    -------
    readings : SlopeReadings
        The three slopes and their spread. [N], [1]

    Raises
    ------
    DataError
        If the shapes differ, or a loss factor is negative.

    Notes
    -----
    [3]_ reads K_ap from "the slope of the line drawn between the ends of the hysteresis
    loop", and eq. 1 there gives the modulus: the amplitude ratio, which is used here.  The
    others differ from it by 0.4 to 2.7 % at the loss angles of [3]_, 5.1 to 13.1 degrees.  A
    loop with pointed ends has its extremes of strain and tension at one point and all three
    readings are one: there the spread is that of the ellipse with the same loss angle.
    NaN in, NaN out.

    Examples
    --------
    >>> readings = slope_readings(100.0, np.tan(np.radians([5.0, 13.0])).max())
    >>> print(readings.between_strain_extremes.round(1), readings.between_tension_extremes.round(1))
    97.4 102.6
    >>> print(readings.relative_spread.round(3))
    0.052
    """
    slope, tangent = as_same_shape(
        apparent_spring_constant=apparent_spring_constant, loss_factor=loss_factor
    )
    bad = tangent < 0
    if bad.any():
        raise DataError(
            f"{int(bad.sum())} of {bad.size} loss factors are negative",
            found=f"{tangent[bad].flat[0]:g}",
            needed="tension that leads strain",
            hint="Check the signs of tension and position.",
        )
    secant = np.sqrt(1 + tangent**2)
    return _SlopeReadings(slope + 0.0, slope / secant, slope * secant, secant - 1 / secant)


# samples reduced at a time: near the cache, yet long enough for threads to pay
_BLOCK = 1 << 17

# samples beside a block that its differences of strain reach
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


def _extremes(values: Floats, first: Integers, last: Integers) -> tuple[Floats, Floats]:
    pairs = np.column_stack([first, last]).ravel()
    stop = int(last[-1])
    greatest = np.maximum.reduceat(values[:stop], pairs[:-1])[::2]
    least = np.minimum.reduceat(values[:stop], pairs[:-1])[::2]
    return np.maximum(greatest, values[last]), np.minimum(least, values[last])


def _readings_at_turns(
    series: Floats,
    time: Floats,
    branch_first: Integers,
    branch_last: Integers,
    *,
    ends: tuple[Integers, Integers],
    reach: tuple[int, int],
    turn: Turn,
    way: int,
    moved: Floats,
    answers: bool,
    sticks: bool,
    alone: bool,
) -> tuple[Floats, Floats, Floats, Floats]:
    """Greatest reading near each peak, least ones near both valleys, and what they miss.

    A turn between two samples lies above the readings, and below where the lines beside it cross,
    since no machine turns at once: half way, and half the range is missed by as much again.  Of a
    turn that is rounded over samples the readings miss less.  What answers a corner of the channel
    that ``moved`` it, if it ``answers``, turns where its approach meets that corner: it may relax
    before the next reading, or ``sticks`` there, as strain does under a driven load.  A series of
    way -1 falls where the driven channel rises.
    Between two cycles is a rest, unless they share a reading or are stored one below the other.
    One that is ``alone`` is followed by itself.
    """
    on_rise, on_fall = reach
    begin, peak, end = branch_first[:, 0], branch_last[:, 0], branch_last[:, 1]
    if alone:  # its valley is between its last reading and its first
        series, moved = (np.append(one, one[:_BEHIND_TURN]) for one in (series, moved))
    values = way * series
    is_stored_alone = ends[0][1:] == ends[1][:-1] + 1
    earliest = np.append(begin[:1], np.where(is_stored_alone, ends[0][1:], end[:-1]))
    latest = np.append(np.where(is_stored_alone, ends[1][:-1], begin[1:]), end[-1:])
    # what creeps while its channel is held at the peak is farthest where that leaves
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

    # what noise adds is that of both sides of a turn, also where one of them is a rest
    rest = 0 if turn == "sharp" else values.size
    top = extreme(np.maximum, peak - on_rise, after_peak)
    first = extreme(np.minimum, begin - rest, begin + on_rise)
    last = extreme(np.minimum, end - on_fall, end + rest)
    missed = np.zeros(top.size)
    if turn == "sharp":
        # what creeps while its channel rests is farthest after the turn that ends the cycle
        stop = np.minimum(end + on_rise, np.append(peak[1:], values.size - 1))
        goes_on = np.append(begin[1:] == end[:-1], False)  # and after the last one it unloads
        at_top = _places(values, peak - on_rise, after_peak)
        at_last = _places(-values, np.maximum(end - on_fall, peak), np.where(goes_on, stop, end))
        last = np.fmin(last, values[at_last])
        above = level_of_turn(values, peak, top, sign=1) - top
        below = last - level_of_turn(values, end, last, sign=-1)
        noise = _within_scatter(reading_noise(moved), moved[peak])
        own = _within_scatter(reading_noise(values), values[peak])
        # a machine may rest at one of its turns alone
        lowest = _places(-moved, np.maximum(end - on_fall, peak), stop)
        rests, rests_below = rests_at_turns(moved, peak), rests_at_turns(-moved, lowest)
        of_peak, of_valley = (
            np.abs(
                level_at_corner(
                    values,
                    moved,
                    at,
                    sign=sign,
                    noise=noise,
                    rests=rest,
                    own_noise=own,
                    steep=_SHOWN if sticks else STEEP,
                )
                - level
            )
            for at, sign, level, rest in ((at_top, 1, top, rests), (at_last, -1, last, rests_below))
        )
        # lines beside a rest cross above it, and of its readings noise makes one the greatest
        step = (top - last) / (end - peak)
        bow = np.zeros(top.size)
        if rests:  # or what seems one is a turn that a machine rounds over two readings or three
            above, bow = np.zeros(top.size), _bow(values, at_top)
            if not answers:
                top = _mean_of_rest(values, at_top, top, within=_OF_A_STEP * step)
        if rests_below:
            below, bow = np.zeros(top.size), bow + _bow(-values, at_last)
            if not answers:
                last = -_mean_of_rest(-values, at_last, -last, within=_OF_A_STEP * step)
        if answers:
            # what sticks behind a corner falls off slowly there under a load, and lines beside it
            # cross above the level to which the approach leads; a force falls off at once
            is_led = np.isfinite(of_peak), np.isfinite(of_valley)
            of_peak = np.where(is_led[0] & sticks, of_peak, np.fmax(of_peak, above))
            of_valley = np.where(is_led[1] & sticks, of_valley, np.fmax(of_valley, below))
            for level, at, sign, reading, is_rest in (
                (of_peak, peak, 1, top, rests), (of_valley, end, -1, last, rests_below)
            ):  # fmt: skip
                # of a series that stiffens all lines cross too low, or below its reading
                beyond = sign * (level_beside_corner(values, moved, at, sign=sign) - reading)
                if not is_rest and np.nanmedian(beyond) > _STIFFENS * np.nanmedian(level):
                    np.fmax(level, beyond, out=level)
            excess = np.maximum(of_peak - above, 0.0), np.maximum(of_valley - below, 0.0)
            above, below = of_peak, of_valley
            missed = (_EITHER - 1) * (excess[0] + excess[1]) / 2
            if sticks:  # steps of the driven channel move its corner, in step in all cycles alike
                grain = rounding_left(*_noise_and_step(moved, reading_noise(moved))[::-1])
                missed = np.hypot(
                    missed, _OF_CORNER * grain * (top - last) / np.abs(moved[peak] - moved[end])
                )
        else:
            # a machine that dwells is at the level of its corner, and misses nothing
            upper = _plateau(values, peak - on_rise, after_peak, top)
            lower = _plateau(-values, np.maximum(end - on_fall, peak), stop, -last)
            top, above = (top, above) if upper is None else (upper[0], 0 * above)
            if lower is not None:  # it is held at one level at both ends of a cycle
                first = np.append(-lower[0][0], -lower[0][:-1])
            last, below = (last, below) if lower is None else (-lower[0], 0 * below)
        # the readings of a rounded turn are the lower end of it, and not its middle
        missed = missed + (above + below) / 2 + bow
        top, last = top + above / 2, last - below / 2
    elif turn == "rounded":
        above = missed_by_extreme(values, peak, top, sign=1)
        below = missed_by_extreme(values, end, last, sign=-1)
        # the readings are the lower end of it, and not its middle
        missed = np.full(top.size, np.nanmedian(above + below))
    elif turn == "hidden":  # at most what lines of these ramps add where they cross half way
        wait = np.diff(time, append=time[-1])
        at_peak, at_end = (np.fmax(wait[at - 1], wait[at]) for at in (peak, end))
        beside = (at_peak + at_end) / 2
        missed = (top - (first + last) / 2) * beside / (time[end] - time[begin])
        # readings miss half of that where corners lie anywhere, nothing of a rounded turn or a rest
        if not rests_at_turns(moved, peak):
            top, first, last = top + missed / 4, first - missed / 4, last - missed / 4
        # noise hides the slow stroke of a saw alone: its readings are the lower end of what lies
        # within its step, which is greater where the series relaxes behind a fast stroke
        after = np.minimum(end + 1, values.size - 1)
        above = top - np.stack([values[peak - 1], values[peak + 1]])
        below = np.stack([values[end - 1], values[after]]) - last
        slow, fast = np.nanmedian(np.sort(above, axis=0) + np.sort(below, axis=0), axis=1)
        # of a driven channel with even strokes both are where its corners lie between readings
        strokes = np.median([peak - begin, end - peak], axis=1)
        may_fall = answers or strokes.max() > _UNEVEN * strokes.min()
        if may_fall and slow < _STEEP * reading_noise(values) < fast:
            missed = np.fmax(missed, slow)
    return way * top, way * first, way * last, missed


def _energy_beside_polygon(
    force: Floats, stretch: Floats, moved: Floats, begin: Integers, end: Integers
) -> tuple[Floats, Floats]:
    """What the polygon of the readings lacks of each loop, and how far that may be off."""

    def of_cycles(lacking: Floats) -> Floats:
        up_to = np.concatenate([[0.0], np.cumsum(lacking)])
        # what lies beside a valley is half of the cycle before it and half of the one after it
        beside = sum(lacking[np.maximum(at - 1, 0)] + lacking[at] for at in (begin, end))
        return np.asarray(up_to[np.maximum(end - 1, begin + 1)] - up_to[begin + 1] + beside / 2)

    at_corners, between = (
        of_cycles(one)
        for one in energy_beside_polygon(force, stretch, moved, noise=reading_noise(moved))
    )
    # half of it, as of the levels: no machine turns at once
    return at_corners / 2 + between, np.abs(at_corners / 2) + _OF_A_KINK * np.abs(between)


def _energy_by_chance(tension: Floats, strain: Floats, first: Integers, last: Integers) -> float:
    r"""How far kinks of tension between readings may put the energy of smooth steps off.

    .. math:: u = \max_r \frac{1}{r^2} \sqrt{\frac1r \sum_p (H_{rp} - \bar H_r)^2}

    Notes
    -----
    The sum of a kinked integrand is off by its second Bernoulli polynomial at the place of the
    kink between two readings, times the square of the interval.  So is the sum over every r-th
    reading from the p-th on, H_rp, of r times the interval: their scatter is r^2 times what is
    sought.  In a log that is no multiple of the wave the mean over cycles has none of it.

    Examples
    --------
    Dry friction of 10 N, 24 readings a cycle: 40.0 J/m.

    >>> turn = 2 * np.pi * (np.arange(24 * 6 + 1) + 0.3) / 24
    >>> drag = np.where(np.sin(turn) > 0, 10.0, -10.0)
    >>> first = 24 * np.arange(1, 5)
    >>> found, _ = _loop_energy(drag, -np.cos(turn), first, first + 24, waveform="sinusoidal")
    >>> print((found[0] - 40).round(2), round(_energy_by_chance(drag, -np.cos(turn), first,
    ...     first + 24), 2))
    0.06 0.1
    """
    first, last = first[:_MOST_FOLDED], last[:_MOST_FOLDED]
    part = slice(int(first[0]), int(last[-1]) + 1)
    own = first, last
    force, first, last = tension[part], first - part.start, last - part.start
    closing = (force[last] + force[first]) / 2
    place = np.arange(force.size)
    place -= first[np.searchsorted(first, place, side="right") - 1]
    found = 0.0
    for stride in range(2, 1 + min(4, int(np.median(last - first)) // 6)):
        energies = []
        # from the same readings, so that noise of strain meets changes of tension, not tension
        steps = _smooth_steps(strain, *own, stride)[part]
        for rest in range(stride):
            step = np.where(place % stride == rest, steps, 0.0)
            work, travel = (_sums_over_cycles(one, first, last) for one in (step * force, step))
            energies.append(np.nanmean(work - closing * travel))
        found = max(found, float(np.std(energies)) / stride**2)
    lengths = last - first
    if lengths.size and (lengths == lengths[0]).all():
        found = max(found, _energy_by_aliases(force, strain[part], first, int(lengths[0])))
    return found


def _energy_by_aliases(tension: Floats, strain: Floats, first: Integers, n_samples: int) -> float:
    r"""How far kinks of tension put the energy of a sine off whose log is in step with it.

    .. math:: u = \pi \hat\varepsilon \frac{C}{\sqrt 2}
        \sqrt{\frac1{(n - 1)^4} + \frac1{(n + 1)^4}}, \qquad
        C^2 = \overline{\lvert F_k \rvert^2 \Big/ \sum_{m} \frac1{(m n + k)^4}}

    Notes
    -----
    Of n readings a cycle the harmonics n - 1 and n + 1 count as the fundamental.  Those of a wave
    with kinks fall with the square of their number: what they are follows from the upper ones that
    the readings show, of the same parity: of the lower ones that which no elastic line has, as a
    line that bends has many of those, and of all but what a jump at the turns has, as by dry
    friction, since that cancels.  Sums over every other reading may agree by chance.

    Examples
    --------
    Slip at 10 N, read 12 and 1,200 times a cycle: energies, and what the first may be off.

    >>> def loop(per_cycle, first):
    ...     turn = 2 * np.pi * (np.arange(6 * per_cycle + 1) + 0.3) / per_cycle
    ...     return np.clip(30 * np.sin(turn - 0.4), -10, 10), -np.cos(turn), per_cycle * first
    >>> for per_cycle in (12, 1200):
    ...     force, strain, first = loop(per_cycle, np.arange(1, 5))
    ...     print(_loop_energy(force, strain, first, first + per_cycle,
    ...         waveform="sinusoidal")[0][0].round(1))
    36.3
    36.1
    >>> print(round(_energy_by_aliases(*loop(12, np.arange(1, 5)), 12), 1))
    1.0
    """
    harmonic = np.arange(2, (n_samples + 1) // 2)
    harmonic = harmonic[harmonic % 2 != n_samples % 2]
    if not harmonic.size:
        return 0.0
    cycle = first[:, None] + np.arange(n_samples)
    waves = [
        2 / n_samples * np.fft.rfft(np.nanmean(one[cycle], axis=0)) for one in (tension, strain)
    ]
    turned = np.angle(-waves[1][1])
    own = np.exp(-1j * harmonic * turned) * waves[0][harmonic]
    fold = np.arange(-20, 21)
    places = harmonic[:, None] + n_samples * fold
    per_kink = 1 / np.sqrt(((1.0 * places) ** -4).sum(axis=1))
    of_jump = 1j * (places % 2 / places * np.exp(1j * n_samples * turned * fold)).sum(axis=1)
    is_low = harmonic < n_samples / 3
    kinks, jump = (
        np.concatenate([(np.sqrt(2) * one.imag)[is_low], one.imag[~is_low], one.real[~is_low]])
        for one in (own * per_kink, of_jump * per_kink)
    )
    if kinks.size > 1 and jump @ jump > 0:
        kinks -= jump * (kinks @ jump) / (jump @ jump)
    square = 2 * np.sum(kinks**2) / max(kinks.size - 1, 1)
    beyond = (n_samples - 1.0) ** -4 + (n_samples + 1.0) ** -4
    energy = np.pi * np.abs(waves[1][1]) * np.sqrt(square * beyond / 2)
    return float(energy) if np.isfinite(energy) else 0.0


_MOST_FOLDED = 50  # cycles that say how far chance puts all of them off

_OF_A_KINK = 0.45
"""Of a third of D, standard deviation over all places of a kink between two readings: it is
D times the root of 16 / 720."""

_BEHIND_TURN = 5  # readings behind a turn, of which it is seen

_EITHER = 2**0.5
"""What relaxes at a corner is at one end of its range or at the other, and not between them: the
whole of half the range, where `Loops.shared_by_cycles` takes it over this."""

_SHOWN = 3.0  # noise of a reading of the load, by which its steps show a corner, also in a mean

_OF_CORNER = 10**0.5
"""Of both levels at which steps of two readings on either side let a corner lie, over the rounding
of a reading and the ratio of the channels: the root of 10 over twice the ramp, at either turn."""

_STIFFENS = 2.0  # times what lines show to lie beyond a reading, by which they are of no use

_ON_PLATEAU = 6.0  # noise of a reading below the greatest one, on a plateau of some tens

_FEWEST_ON_PLATEAU = 5

_BENT = 0.45  # noise, by which the middle of a dome or the beginning of a decay is above the whole

_PARTS = 5  # of a plateau: tension that relaxes at once is above its mean in the first or second

_LOW = 1.5  # noise below a plateau, where few of its readings lie, and those of ramps

_LEVEL, _CLEARLY = 0.25, 5.0  # noise and standard errors of the mean, within which it is level


def _noise_of_corners(noise: float, turns: Floats) -> float:
    """Noise of a driven channel over its range, where its corners are taken for it; else zero.

    What they make of the driven channel they make of the other one as well, which relaxes behind
    them, so that its extremes scatter and say nothing of its noise.  ``turns``: peaks, valleys.
    """
    if _within_scatter(noise, turns[0]) >= noise / 2:
        return 0.0
    return noise / float(np.nanmedian(np.abs(turns[0] - turns[1])))


_LIKE_CORNERS = 3.0

_FALLS = 0.8  # noise of a reading, from a turn to the reading beside it


def _within_scatter(noise: float, top: Floats) -> float:
    """Noise of a reading, no more than the scatter of the extremes from cycle to cycle allows.

    Third differences take the corners of a wave of some fifteen readings a cycle for noise.

    Examples
    --------
    >>> print(_within_scatter(2.0, np.full(9, 5.0)), _within_scatter(2.0, np.arange(4.0)))
    0.0 2.0
    """
    change = np.diff(top[np.isfinite(top)])
    if change.size < _FEWEST_ON_PLATEAU:
        return noise
    return min(noise, float(np.sqrt(np.mean(change**2) / 2)) / _LEAST_OF_GREATEST)


_EITHER_WAY = np.sqrt(
    8 / 3
)  # of a half range, evenly likely up to it, as `Loops` takes what is missed

_LEAST_OF_GREATEST = 0.2  # of the noise: half the scatter of the greatest of hundreds of readings


def _means_of_parts(values: Floats) -> Floats:
    """Mean of each of five consecutive parts, nearly equally long."""
    ends = np.arange(_PARTS + 1) * values.size // _PARTS
    return np.asarray(np.add.reduceat(values, ends[:-1]) / np.diff(ends))


def _plateau(
    values: Floats, low: Integers, high: Integers, top: Floats
) -> tuple[Floats, float, float] | None:
    """Mean of the readings of a plateau, of which noise makes the greatest one too great.

    With it, by how much the ends of the plateau lie above that mean at most and at least: a decay
    that noise hides has its extreme there.

    None where a window has no plateau: its middle lies no higher than its ends, as that of a dome
    does, and its beginning no higher than its end, as of what relaxes.  The middle half is taken,
    since ramps begin in the noise.
    """
    noise = _within_scatter(reading_noise(values), top)
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
        # readings of the ramps that lie within its noise are at its ends, and hide a decay
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
    # of a cycle that begins or ends in its plateau little of it is left
    return np.where(np.isfinite(level), level, top - np.nanmedian(top - level)), most, least


def _led_to_corner(
    values: Floats, driven: Floats, begin: Integers, end: Integers, level: Floats
) -> Floats | None:
    """Level to which each approach of a series leads where the driven channel comes to a rest.

    By a parabola over the last third of the way of the driven one to the ``level`` of its rest:
    what relaxes is farthest at that corner, and the mean of noisy corners is blunt.  NaN of a few
    readings.  None where the driven channel rounds its corners: there nothing leads to them.
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
    """Mean of the greatest reading of a rest and the next one; the former where it is alone."""
    beside = np.fmax(values[np.maximum(at - 1, 0)], values[np.minimum(at + 1, values.size - 1)])
    return np.where(greatest - beside < within, (greatest + beside) / 2, greatest)


_STEEP = 20.0  # noise of a reading, between the slow steps and the fast ones

_UNEVEN = 2.0  # times the faster stroke, which the slower one of a saw lasts

_OF_A_STEP = 0.05  # of the mean step of a branch

_CLEAR = 3.0  # noise of a reading, and standard errors, that show a ramp, a rounding or a creep


def _bow(values: Floats, at: Integers) -> Floats:
    """By how much a parabola through a greatest reading and those beside it lies above it."""
    before, beside, after = (values[np.clip(at + k, 0, values.size - 1)] for k in (-1, 0, 1))
    bend, slope = 2 * beside - before - after, (after - before) / 2
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(bend > 0, np.minimum(slope**2 / (2 * bend), bend / 8), 0.0)


def _farther(values: Floats, one: Integers, other: Integers) -> Integers:
    """Of two turns at either end of a rest, those at which a series is greater in the mean."""
    apart = take_samples(values, one) - take_samples(values, other)
    known = apart[np.isfinite(apart)]
    return other if known.size and known.mean() < 0 else one


def _places(values: Floats, low: Integers, high: Integers) -> Integers:
    """Sample of the greatest value in each of some windows."""
    known = np.where(np.isfinite(values), values, -np.inf)
    return np.array([
        start + int(np.argmax(known[start : stop + 1]))
        for start, stop in zip(np.maximum(low, 0).tolist(), high.tolist(), strict=True)
    ])  # fmt: skip


def _noise_and_step(values: Floats, noise: float) -> tuple[float, float]:
    r"""Noise of readings before they were rounded, and the step that they were rounded to.

    .. math:: \sigma^2 = s^2 - q^2 / 12

    The median of third differences is itself a number of steps where these are coarse: there it is
    their mean square that says what the noise is, unless the steps back contradict it: a slow ramp
    in coarse steps has third differences without any noise.  The step is zero where noise of more
    than a step leaves nothing of it.

    Examples
    --------
    >>> level = np.random.default_rng(1).normal(0, 1, 4000) + np.sin(np.arange(4000) / 300) * 100
    >>> rounded = 3 * np.round(level / 3)
    >>> print([round(one, 1) for one in _noise_and_step(rounded, reading_noise(rounded))])
    [1.0, 3.0]
    """
    step = step_of_codes(values)
    if not step or noise > _COARSE * step:
        return noise, 0.0
    codes = values[:_NOISE_SAMPLES] / step
    third = np.abs(np.diff(codes, n=3))
    third = third[np.isfinite(third) & (third < _FAR)]
    # the corners of a wave are no noise: without the greatest fifth, as of a normal distribution
    inner = np.sort(third)[: int(0.8 * third.size)]
    square = float(np.mean(inner**2)) / (20 * _OF_INNER) if inner.size else 0.0
    by_differences = float(np.sqrt(max(square - 1 / 12, 0.0)))
    return step * _noise_of_codes(codes, by_differences), step


def _noise_of_codes(codes: Floats, most: float) -> float:
    r"""Noise of a wave in codes of a converter, where its steps back contradict a greater one. [1].

    .. math:: b = \langle s\,\varphi(r / s) - r\,\Phi(-r / s) \rangle, \qquad s = \sqrt 2 \sigma

    with b the mean number of steps against the way of the wave from one reading to the next, and r
    what the wave goes in that time.  A distance holds as many edges of codes in the mean as it is
    steps long, so b is the mean of the way back; a ramp without noise goes back nowhere.  ``most``
    is the noise where as many are seen as it makes, within three standard deviations.

    Examples
    --------
    >>> ramp, noise = 0.12 * np.abs(np.arange(4000) % 400 - 200), np.random.default_rng(1)
    >>> print([round(_noise_of_codes(np.round(ramp + noise.normal(0, one, 4000)), 0.5), 1)
    ...     for one in (0.0, 0.2, 0.5)])
    [0.0, 0.2, 0.5]
    """
    steps, reach = np.diff(codes), 1
    # what the wave goes, by readings so far apart that their noise is little of it
    while True:
        rate = (codes[2 * reach :] - codes[: -2 * reach]) / (2 * reach)
        fastest = float(np.nanquantile(np.abs(rate), _FAST)) if np.isfinite(rate).any() else 0.0
        if 2 * reach * fastest >= _STEPS_APART or 8 * reach > codes.size:
            break
        reach *= 2
    own = steps[reach - 1 : reach - 1 + rate.size]
    used = (np.abs(rate) > fastest / 4) & (np.abs(own) < _FAR)
    way = np.abs(rate[used])
    back = float(np.maximum(-own[used] * np.sign(rate[used]), 0).sum())

    def expected(noise: float) -> float:
        above = way / (noise * 2**0.5)
        density = np.exp(-(above**2) / 2) / np.sqrt(2 * np.pi)
        return noise * 2**0.5 * float((density - above * scipy.special.ndtr(-above)).sum())

    least = 1e-3
    if most <= least or expected(most) - back <= _CLEAR * expected(most) ** 0.5:
        return most
    if expected(least) >= back:
        return 0.0
    return float(scipy.optimize.brentq(lambda noise: expected(noise) - back, least, most))


_FAST, _STEPS_APART = 0.9, 4.0  # share of readings at less than that rate; steps between two


def _codes_of_branches(values: Floats, cycles: Cycles, step: float) -> list[Floats]:
    """Readings of the rise and of the fall of some cycles, one row each, in steps of a converter.

    Noise puts a turn a reading early or late: each row begins where it is most like the others.
    """
    found = []
    for begin, end in zip(cycles.branch_first.T, cycles.branch_last.T, strict=True):
        n = int(np.median(end - begin)) + 1
        begin = begin[(begin > 0) & (begin + n < values.size)]
        begin = begin[: max(min(_CYCLES_OF_SHAPE, _BLOCK // n), 2)]
        if n < _FEWEST_ON_PLATEAU or not begin.size:
            continue
        places = begin[:, None, None] + np.array([-1, 0, 1])[:, None] + np.arange(n)
        codes = take_samples(values, places.ravel()).reshape(places.shape) / step
        codes = codes[np.isfinite(codes).all(axis=(1, 2))]
        if not codes.size:
            continue
        apart = np.abs(codes - np.median(codes[:, 1], axis=0)).sum(axis=2)
        found.append(codes[np.arange(len(codes)), apart.argmin(axis=1)])
    return found


def _scatter_over_cycles(values: Floats, cycles: Cycles, step: float) -> float:
    r"""Scatter of one place of the wave over the cycles, before it was rounded. [any].

    .. math:: \langle v \rangle \approx q \sigma / \sqrt{\pi}
              \quad (\sigma \ll q), \qquad \langle v \rangle \approx \sigma^2 + q^2 / 12

    of the variance v of its codes, over all levels that a reading may have between two codes.
    Noise makes it, or a log that is out of step with its wave, and either frees the mean of the
    steps; a log in step has none of it, though third differences take its steps for noise.

    Examples
    --------
    >>> first = np.arange(0, 1200, 40)
    >>> ends = np.column_stack([first, first + 20])
    >>> cycles = Cycles(first, first + 40, ends, ends + 20, np.ones((30, 2)),
    ...     np.zeros(1201), np.zeros(1201), np.zeros(1201), 0.1)
    >>> wave = 107.4 - 5.37 * np.abs(np.arange(1201) % 40 - 20)
    >>> noise = np.random.default_rng(1).normal(0, 1, 1201)
    >>> print([round(_scatter_over_cycles(np.round(wave + size * noise), cycles, 1.0), 1)
    ...     for size in (0.0, 0.2, 0.6)])
    [0.0, 0.2, 0.6]
    """
    codes = _codes_of_branches(values, cycles, step)
    if not codes:
        return np.inf
    square = float(np.mean(np.concatenate([np.var(one, axis=0) for one in codes])))
    linear = square * np.sqrt(np.pi)
    return step * float(linear if linear < _FEW_FLIP else np.sqrt(square - 1 / 12))


_FEW_FLIP = 0.3  # steps of scatter, where both lines meet


def _rounding_of_branches(values: Floats, cycles: Cycles, step: float) -> float:
    r"""Root mean square of the mean error that rounding leaves over a branch. [any].

    .. math:: u = q \sqrt{\langle (\tfrac1n \sum_k \{o + x_k\})^2 \rangle}

    with the distance {} of a number from the nearest whole one, readings x of the branch without
    rounding, by a cubic through their codes, and any level o.  Where a branch goes by a whole
    number of steps from one reading to the next, all its readings err alike.

    Examples
    --------
    Ramps of 20 readings, of 5 steps a reading and of 5.37, from a level that any cycle has:

    >>> first = np.arange(0, 200, 40)
    >>> ends = np.column_stack([first, first + 20])
    >>> cycles = Cycles(first, first + 40, ends, ends + 20, np.ones((5, 2)),
    ...     np.zeros(201), np.zeros(201), np.zeros(201), 0.1)
    >>> wave = 20.0 - np.abs(np.arange(201) % 40 - 20)
    >>> print(round(_rounding_of_branches(5 * wave, cycles, 1.0), 2),
    ...     round(_rounding_of_branches(np.round(5.37 * wave), cycles, 1.0), 2))
    0.29 0.01
    """
    errors = []
    for codes in _codes_of_branches(values, cycles, step):
        along = np.linspace(-1, 1, codes.shape[1])
        branch = np.polynomial.Polynomial.fit(along, codes.mean(axis=0), 3)(along)
        errors += [
            np.mean(np.round(level + branch) - level - branch)
            for level in np.linspace(0, 1, 16, endpoint=False)
        ]
    return step * float(np.sqrt(np.mean(np.square(errors)))) if errors else 0.0


def _energy_of_rounding(
    series: tuple[Floats, Floats],
    steps: Sequence[float],
    left: Sequence[float],
    cycles: Cycles,
    norm: Floats,
    ranges: Floats,
    *,
    waveform: Waveform,
) -> Floats:
    """Standard uncertainty of the energy of each cycle by the steps of both converters.

    Of every reading by itself, by the norm of the steps of strain, and of the branches together.
    """
    force, strain = ranges
    own = norm * np.hypot(left[0], left[1] * force / strain)
    if waveform == "sinusoidal":
        return np.asarray(own)
    of_branches = [
        # of both branches; what noise leaves of an error of one reading it leaves of their mean
        np.sqrt(2) * _rounding_of_branches(one, cycles, step) * rest * np.sqrt(12) / step * other
        if step
        else 0.0
        for one, step, rest, other in zip(series, steps, left, (strain, force), strict=True)
    ]
    return np.asarray(np.sqrt(own**2 + sum(one**2 for one in of_branches)))


_OF_GREATEST = 0.55  # of the noise: scatter of the greatest of some ten readings

_COARSE, _FAR = 1.5, 12.0  # steps of a converter

_OF_INNER = 0.4377  # of the mean square of normal values, that of the least four fifths of them

_OF_BOTH_ENDS = 2.0
"""Width that `Loops` takes over the root of 8, of two errors that leave half a range one over the
root of 2. [1]"""


def _without_noise(
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
    """Valleys of cycles that touch made one, and what noise adds to extremes taken off.

    ``measured`` has the rows of top, first and last valley, and of what a turn may miss, and is
    changed.  A channel that is held at its turns is at the mean of what it reads there, which is
    returned.  What answers one that ``rests``, by its readings and the rows of its levels, may be
    farthest at the corners of that.  What may be corners and no noise is not taken off: the truth
    is between both.
    """
    top, first, last, missed = measured
    touch = np.flatnonzero(touching(cycles))
    both = last[touch - 1]
    if turn == "sharp":
        both = np.where(np.isfinite(both), both, first[touch])
    else:  # a cycle that lacks readings has no valley, its neighbour has
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
            # what answers relaxes: its mean is the lower end of what noise hides
            part = 0.0 if rests is None else 0.5
            out = [part * max(one) for one in zip((upper[2], lower[2]), leads_to, strict=True)]
            top[:], last[:] = way * (upper[0] + out[0]), -way * (lower[0] + out[1])
            first[1:] = last[:-1]
            np.hypot(missed, _EITHER_WAY * above / 2, out=missed)
            return True
    noise = _within_scatter(noise, top)
    leaves, apart = cycles.branch_first[:, 1], cycles.first[1:] - cycles.last[:-1]
    foot = cycles.first[touch]
    if not touch.size:  # beside the first is an approach
        foot = _farther(-way * values, cycles.first, cycles.last)[1:]
    (of_peak, peak_falls), (of_valley, valley_falls) = (
        noise_in_extreme(values, turn, reach=reach + int(np.median(rest)), sign=sign, noise=noise)
        for turn, sign, rest in (
            (_farther(way * values, peak, leaves), way, leaves - peak),
            (foot, -way, np.zeros(1) if touch.size or not apart.size else apart),
        )
    )
    either = _EITHER_WAY * (of_peak + of_valley) / 2
    # what a corner may lose where the mean turn is smoothed
    of_smoothing = _EITHER_WAY * noise / 2
    if of_corners and 0 < noise < _LIKE_CORNERS * of_corners * np.nanmedian(np.abs(top - first)):
        np.hypot(missed, either, out=missed)
        return False
    top -= way * of_peak
    first += way * of_valley
    last += way * of_valley
    # the mean of noisy corners is blunt, and what it says of the noise too much
    dwells = float(np.median(cycles.branch_first[:, 1] - peak)) > 1
    blunt = may_dwell and (dwells or max(peak_falls, valley_falls) > _FALLS * noise)
    for lead, level, sign in zip(leads, (top, last), (way, -way), strict=True):
        ahead = None if lead is None else lead - sign * level
        # what creeps on in the rest is not farthest at its corner
        if ahead is not None and (more := float(np.nanmean(ahead))) > -2 * float(
            np.nanstd(ahead)
        ) / np.sqrt(np.isfinite(ahead).sum()):
            level += sign * np.where(np.isfinite(ahead), ahead, more)
            np.hypot(missed, more / 2, out=missed)  # a corner may be rounded within the noise
        else:
            np.hypot(missed, (either if blunt else of_smoothing) / np.sqrt(2), out=missed)
    return False


def _measure(
    time: Floats,
    tension: Floats,
    strain: Floats,
    basis: _CycleBasis,
    middles: Integers,
    branches: tuple[Integers, Integers],
    waveform: Waveform,
    control: Control,
    reach: tuple[int, int],
    turn: Turn,
    ways: tuple[int, int],
    alone: bool,
) -> Floats:
    """What only the samples tell, one row a quantity of `MEASURED`, one column a cycle."""
    first, last = basis.first, basis.last
    force, lost_force = _bridge_gaps(tension, first, last)
    stretch, lost_stretch = _bridge_gaps(strain, first, last)
    moved = force if control == "load" else stretch
    at_turns = (
        (np.zeros(first.size),) * 8
        if waveform == "sinusoidal"
        else tuple(
            one
            for series, way in zip((force, stretch), ways, strict=True)
            for one in _readings_at_turns(
                series,
                time,
                *branches,
                ends=(first, last),
                reach=reach,
                turn=turn,
                way=way,
                # of two the other one answers: strain follows the position that is driven
                moved=ways[moved is stretch] * moved,
                answers=(series is force) != (moved is force),
                sticks=moved is force,
                alone=alone,
            )
        )
    )
    if waveform == "sinusoidal":
        lacking = np.zeros(first.size)
        may_lack = np.full(first.size, _energy_by_chance(force, stretch, first, last))
    else:
        lacking, may_lack = _energy_beside_polygon(force, stretch, moved, first, last)
    energy, norm = _loop_energy(force, stretch, first, last, waveform=waveform)
    measured = np.array(
        [
            *_extremes(force, first, last),
            *_extremes(stretch, first, last),
            energy + lacking,
            norm,
            *_fundamental(force, basis),
            *_fundamental(stretch, basis),
            (force[first] + force[last]) / 2,
            (stretch[first] + stretch[last]) / 2,
            *_part_means(force, basis, middles),
            *_part_means(stretch, basis, middles),
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
    """Fill in what `_at_equal_phase` gives of some cycles, of ``measured`` as `_measure` has it."""
    low, high = int(cycles.first[block.start]), int(cycles.last[block.stop - 1]) + 1
    moved, answer = (
        _bridge_gaps(one[low:high], cycles.first[block] - low, cycles.last[block] - low)[0]
        for one in ((tension, strain) if control == "load" else (strain, tension))
    )
    # a rest is found some noise early, where its ramp still goes on
    begin, end = cycles.first[block] - low, cycles.last[block] - low
    peak, leaves = cycles.branch_last[block, 0] - low, cycles.branch_first[block, 1] - low
    into = np.minimum(leaves - peak, (peak - begin) // _WIDER) // 2
    found = _at_equal_phase(
        answer, moved, time[low:high], np.column_stack([begin, leaves - into]),
        np.column_stack([peak + into, end]), levels[:, block],
    )  # fmt: skip
    measured[_OF_PHASE : _OF_PHASE + len(found), block] = found


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
        What the machine moves. [-]
    driven : ndarray, shape (n_samples,), optional
        That channel; strain, or tension under load control, of the first specimen where it is left
        out. [m] or [N]

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
    tension than in strain, and the answer to a sine may have a kink there.  Peaks and valleys,
    and of other waves means and amplitudes, are of the logged extremes:
    noise makes a peak read high by about one to two standard deviations of a reading, and a
    slow log misses the turn by up to half a sample.  Uncertainties are of one cycle: the
    noise of a reading (`reading_noise`) carried through and, for extremes, the turn between
    two samples; nothing else.  K_ap
    by amplitudes is one of three readings of "slope of the loop"; for an ellipse it is
    hypot(K', K''), and K' itself is the slope of the regression of tension on strain.  An
    open loop is closed by a straight line and freed of its drift (`_without_drift`), and
    so are the amplitudes of other waves: half the range less a quarter of the drift.  A
    cycle that lacks up to a tenth of its readings has them bridged by straight lines; one
    that lacks more is NaN throughout.

    Examples
    --------
    A standard linear solid with K' = 900 N and K'' = 100 N at 0.1 Hz, strain 1 +- 0.2.

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
    period = _mean_period(begin, first, last, last_turn=end)
    moved = (tension if control == "load" else strain)[0] if driven is None else driven
    turn_spread: Floats | None = None
    if waveform == "sinusoidal" and np.all(period > 0):
        period, turn_spread = _sine_period(time, moved, cycles, period)
        duration = period
    elif waveform != "sinusoidal":
        duration, turn_spread = own_periods(
            time, moved, cycles, duration, noise=reading_noise(moved)
        )
    if waveform != "sinusoidal":
        cycles = _into_rests(cycles)
    measured = empty_like(tension, shape=(tension.shape[0], len(MEASURED), cycles.n_cycles))
    noises = [(reading_noise(force), reading_noise(stretch)) for force, stretch in
              zip(tension, strain, strict=True)]  # fmt: skip
    branches = np.median(cycles.branch_last - cycles.branch_first, axis=0)
    ways = [(_way(force, cycles), _way(stretch, cycles)) for force, stretch in
            zip(tension, strain, strict=True)]  # fmt: skip
    answer = int(control == "load")
    turns = _turns(
        (tension, strain)[answer], moved, cycles, waveform,
        [one[answer] for one in noises], [one[answer] for one in ways], sticks=control == "load",
    )  # fmt: skip
    # on a plateau the driven channel turns anywhere, and the other one at its beginning
    share = 1.0 if waveform == "other" else _REACH_OF_TURN
    # what creeps on behind a fast stroke turns well within the slow one
    on_rise, on_fall = (max(int(share * one), 1) for one in branches)
    # the middles of rise and fall, at least a sample apart and from either end
    middles = (cycles.branch_first + cycles.branch_last).T // 2
    middles[0] = np.clip(middles[0], cycles.first + 1, cycles.last - 2)
    middles[1] = np.clip(middles[1], middles[0] + 1, cycles.last - 1)
    ends = take_samples(time, np.stack([cycles.first, *middles, cycles.last]))

    def measure_block(block: slice) -> None:
        low = max(int(cycles.first[block.start]) - _REACH, 0)
        high = int(cycles.last[block.stop - 1]) + _REACH + 1
        basis = _cycle_basis(
            time[low:high], cycles.first[block] - low, cycles.last[block] - low,
            period=period[block],
        )  # fmt: skip
        for index, (force, stretch) in enumerate(zip(tension, strain, strict=True)):
            measured[index, :, block] = _measure(
                time[low:high], force[low:high], stretch[low:high], basis, middles[:, block] - low,
                (cycles.branch_first[block] - low, cycles.branch_last[block] - low),
                waveform, control, (on_rise, on_fall), turns[index], ways[index],
                is_alone(cycles, time.size),
            )  # fmt: skip

    samples = (time, tension, strain, measured)
    run_blocks(measure_block, cycles.blocks(_BLOCK), samples=samples, longest=cycles.longest)
    shape = (tension.shape[0], cycles.n_cycles)
    tables = {name: empty_like(tension, shape=shape) for name in _FIELDS}
    uncertainty = {
        name: empty_like(tension, shape=shape)
        for name in _FIELDS
        if name not in _WITHOUT_UNCERTAINTY
    }
    rise_shares = (_rise_share(time, cycles),) * 2
    for index, (force, stretch) in enumerate(zip(tension, strain, strict=True)):
        noise, strain_noise = noises[index]
        own_noise, steps = zip(
            _noise_and_step(force, noise), _noise_and_step(stretch, strain_noise), strict=True
        )
        scatter = [
            _scatter_over_cycles(one, cycles, step) if step else np.inf
            for one, step in zip((force, stretch), steps, strict=True)
        ]
        left = [rounding_left(step, one) for step, one in zip(steps, scatter, strict=True)]
        if any(steps):
            may_lack = measured[index, _OF_ENERGY]
            ranges = measured[index, _OF_EXTREMES[0]] - measured[index, _OF_EXTREMES[1]]
            np.hypot(
                may_lack,
                _energy_of_rounding(
                    (force, stretch), steps, left, cycles, measured[index, _OF_NORM], ranges,
                    waveform=waveform,
                ),
                out=may_lack,
            )  # fmt: skip
        if waveform != "sinusoidal":
            of_driven = _OF_TURNS + 4 * (1 - answer)
            of_corners = _noise_of_corners(
                noises[index][1 - answer], measured[index, of_driven : of_driven + 2]
            )
            tips = measured[index, of_driven + 3] / 2 if turns[index] == "sharp" else 0.0
            rests = None
            for channel in (1 - answer, answer):  # what answers is led by the rests of the other
                series, step, rows = (
                    (force, stretch)[channel],
                    steps[channel],
                    _OF_TURNS + 4 * channel,
                )
                own = own_noise[channel]
                # the step of a converter lifts no extreme, and moves it alike in all cycles; the
                # greatest of some ten noisy readings scatters, and the mean of many is free of it
                missed = measured[index, rows + 3]
                rounded = rounding_left(step, _OF_GREATEST * min(own, scatter[channel]))
                np.hypot(missed, _OF_BOTH_ENDS * rounded, out=missed)
                is_held = _without_noise(
                    measured[index, rows : rows + 4], series, cycles, reach=max(on_rise, on_fall),
                    turn=turns[index], noise=own, way=ways[index][channel],
                    may_dwell=waveform == "other", of_corners=of_corners, rests=rests,
                )  # fmt: skip
                rests = (series, measured[index, rows : rows + 4]) if is_held else None
            top, foot, end_turn = measured[index, of_driven : of_driven + 3]
            tips *= ways[index][1 - answer]
            levels = np.stack([foot + tips, top - tips, end_turn + tips])
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
            run_blocks(
                integrate_block, cycles.blocks(_BLOCK), samples=samples, longest=cycles.longest
            )
        shapes = None
        if waveform == "other":
            of_force, of_stretch = ways[index]
            rise_shares = (
                _rise_share(time, cycles, of_force * force),
                _rise_share(time, cycles, of_stretch * stretch),
            )
        if waveform == "sinusoidal":
            of_both, answering = (_OF_FORCE, _OF_STRAIN), control == "load"
            (force_cos, force_sin), (strain_cos, strain_sin) = (
                measured[index, rows[:2]] for rows in of_both
            )
            lead = np.angle((force_cos - 1j * force_sin) * (strain_cos + 1j * strain_sin))
            turned = _turn_over_cycle(-lead if control == "load" else lead, touching(cycles))
            fitted = of_both[answering][:3]
            cosine, sine, mean = measured[index, fitted]
            measured[index, fitted] = _without_turning(cosine, sine, mean, turned)
            shapes = (
                _shape_of_wave(
                    time, force, cycles, period, measured[index, _OF_FORCE], ends,
                    rounding=left[0], turned=0.0 if answering else turned,
                ),
                _shape_of_wave(
                    time, stretch, cycles, period, measured[index, _OF_STRAIN], ends,
                    rounding=left[1], turned=turned if answering else 0.0,
                ),
            )  # fmt: skip
        values, errors = _quantities_of_cycles(
            measured[index], cycles, ends, waveform=waveform, noise=noise,
            strain_noise=strain_noise, rise_shares=rise_shares, control=control,
            shapes=shapes,
            gap=_gap_of_first(force, stretch, cycles, noises=noises[index])
            if control == "load" else None,
        )  # fmt: skip
        for name, column in values.items():
            tables[name][index] = column
            release_pages(tables[name])
            if name in errors:
                uncertainty[name][index] = errors[name]
                release_pages(uncertainty[name])
        release_pages(measured)
    tables["cycle_start_time"][:] = begin
    tables["frequency"][:] = 1 / duration
    # a turn is known to one sample at each end of the cycle, evenly spread
    if turn_spread is None:
        turn_spread = time_of_sample(duration, cycles)
    uncertainty["frequency"][:] = turn_spread / duration**2 * np.sqrt(2)
    release_pages(*tables.values(), *uncertainty.values())
    return Loops(**tables, uncertainty=uncertainty)


def _into_rests(cycles: Cycles) -> Cycles:
    """Cycles that rests part, first and last as far inside these as noise may hide of their ramps.

    Within the tolerance of a rest the first readings of a ramp belong to it, many of one that
    begins slowly, and a loop without them is cut off at its ends.

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
    # no farther than the middle of a rest; before the first cycle and after the last may be a ramp
    room = np.minimum(reach, (cycles.first[1:] - cycles.last[:-1]) // 2)
    return replace(
        cycles, first=cycles.first - np.append(0, room), last=cycles.last + np.append(room, 0)
    )


_REACH_OF_TURN = 0.25  # of a branch, in which its extremes are sought

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


def _turns(
    answers: Floats,
    driven: Floats,
    cycles: Cycles,
    waveform: Waveform,
    noises: list[float],
    ways: list[int],
    *,
    sticks: bool,
) -> list[Turn]:
    """How the wave of each specimen turns; a sine has no corner, another wave what it shows.

    By the channel that answers the driven one: that is farthest at a corner of it.
    """
    peak = cycles.branch_last[:, 0]
    if waveform == "sinusoidal":
        return ["rounded"] * len(noises)
    if waveform == "other":
        begin, end = cycles.branch_first[:, 0], cycles.branch_last[:, 1]
        of_driven = _within_scatter(reading_noise(driven), take_samples(driven, peak))
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
    # strain that sticks behind a corner of the load seems rounded there
    return ["sharp" if one == kind or (sticks and one == "rounded") else "hidden" for one in found]


def _way(values: Floats, cycles: Cycles) -> int:
    """1 of a series that is greater at the peaks of the cycles than at their valleys, else -1."""
    ends = (take_samples(values, one) for one in (cycles.branch_last[:, 0], cycles.first))
    change = np.subtract(*ends)
    known = change[np.isfinite(change)]
    return -1 if known.size and np.median(known) < 0 else 1


def _rise_share(time: Floats, cycles: Cycles, series: Floats | None = None) -> Floats:
    """Share of the time of each cycle that its rise takes.

    Of a ``series`` that may rest at its turns, from its own extremes: what answers a machine that
    dwells is farthest where it begins to dwell, or ends, and the machine turns anywhere between.
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
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray((turn - start) / (stop - start))


_PASSES = 4  # each leaves a part in so many of the error as there are cycles


def _sine_period(
    time: Floats, driven: Floats, cycles: Cycles, period: Floats
) -> tuple[Floats, Floats]:
    """Period of the wave in each cycle, and the spread of one turn, by the driven channel's phase.

    Noise puts the turns of a log a sample early or late; the phase of a fundamental over a
    hundred samples is known to a hundredth of one.  The phase of the other channel moves with its
    loss angle, which settles over a test.
    """
    phased, amplitude = np.empty((2, cycles.n_cycles))
    blocks = cycles.blocks(_BLOCK)

    def find(block: slice) -> None:
        low, high = int(cycles.first[block.start]), int(cycles.last[block.stop - 1]) + 1
        first, last = cycles.first[block] - low, cycles.last[block] - low
        basis = _cycle_basis(time[low:high], first, last, period=period[block])
        level, _ = _bridge_gaps(driven[low:high], first, last)
        cosine, sine, _ = _fundamental(level, basis)
        amplitude[block] = np.hypot(cosine, sine)
        phased[block] = _phase_turns(cosine, sine, basis, time[low:high])

    run_blocks(find, blocks, samples=(time, driven), longest=cycles.longest)
    # a wrong period turns the phase about the middle of the cycle, which it leaves alone
    middle = (take_samples(time, cycles.first) + take_samples(time, cycles.last)) / 2
    # the last cycle of a run ends where it would go on, at the period of the others
    ends_run = np.append(cycles.last[:-1] != cycles.first[1:], True)
    found, turns = period, phased
    for _ in range(_PASSES):
        turns = middle - (middle - phased) * found / period
        last_turn = np.append(turns[1:], np.nan)
        last_turn[ends_run] = (turns + found)[ends_run]
        found = _mean_period(
            turns, cycles.first, cycles.last, last_turn=last_turn, steady=steady_cycles(amplitude)
        )
    # the phase of a fundamental is uncertain by the noise of all readings of its cycle
    rise = take_samples(driven, cycles.branch_last[:, 0])
    half = float(np.nanmedian(rise - take_samples(driven, cycles.branch_first[:, 0]))) / 2
    readings = float(np.median(cycles.last - cycles.first))
    of_noise = reading_noise(driven) * np.sqrt(2 / readings) / half / (2 * np.pi)
    least = abs(of_noise) * float(np.median(found)) if half else 0.0
    spread = np.full_like(
        found, max(least, spread_of_turns(turns, cycles.first, cycles.last, step=0.0))
    )
    alone, own, of_own = periods_alone(
        time, driven, cycles, is_sine=True, noise=reading_noise(driven)
    )
    found[alone], spread[alone] = own, np.fmax(of_own / np.sqrt(2), least)
    return found, spread
