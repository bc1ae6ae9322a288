r"""Energy, fundamental and drift of the loops of tension against strain.

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

References
----------
.. [4] M. Abramowitz and I. A. Stegun, "Handbook of Mathematical Functions," NBS, 1964, eqs.
   4.3.16 and 4.3.17 (sums of angles), 4.3.65 and 4.3.66 (series).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from reduction.record.arrays import as_same_shape
from reduction.record.errors import DataError
from reduction.record.measurement import Bools, Floats, Integers, read_only_arrays

_EIGHTH_ORDER = (4 / 5, -1 / 5, 4 / 105, -1 / 280)


def _sums_over_cycles(values: Floats, first: Integers, last: Integers) -> Floats:
    """Sum of a series over the samples from ``first`` up to, not with, ``last``.

    Examples
    --------
    >>> _sums_over_cycles(np.arange(6.0), np.array([0, 3]), np.array([3, 5]))
    array([3., 7.])
    """
    if first.size == 0:
        return np.empty(0)
    # pairs (first, last): the even entries are the sums, the odd ones the gaps between cycles;
    # the last pair's end may be one past the series, which reduceat does not take
    pairs = np.column_stack([first, last]).ravel()
    stop = int(last[-1])
    sums: Floats = np.add.reduceat(values[:stop], pairs[:-1])[::2]
    return sums


def _smooth_steps(strain: Floats, first: Integers, last: Integers) -> Floats:
    """Eighth-order change of strain per sample at each sample, shape (n_samples,).

    Where the record ends within four samples of a cycle, that cycle is continued
    periodically, its drift added, so that a log of one cycle is as good as any.
    """
    reach = len(_EIGHTH_ORDER)
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
        at = reach + offset
        inner += weight * padded[at : at + inner.size]
        at = reach - offset
        inner -= weight * padded[at : at + inner.size]
    return change


def loop_energy(
    tension: ArrayLike,
    strain: ArrayLike,
    first: Integers,
    last: Integers,
    *,
    waveform: Literal["triangular", "sinusoidal", "other"] = "triangular",
) -> tuple[Floats, Floats]:
    """Energy lost in each cycle and unit length, and its sensitivity to noise.

    Notes
    -----
    An open loop is closed by the straight line from its last sample to its first; `without_drift`
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
    >>> energy, _ = loop_energy(tension, strain, first, last, waveform="sinusoidal")
    >>> print(energy.round(3))
    [31.416]
    >>> print(loop_energy(tension, strain, first, last)[0].round(3))
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


def without_drift(
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

    Parameters
    ----------
    energy : ndarray, shape (n_cycles,)
        Of the loop closed by a straight line, from `loop_energy`. [J m-1]
    end_tension : array_like, shape (n_cycles,)
        Mean of the first and the last sample of the cycle. [N]
    mean_tension : array_like, shape (n_cycles,)
        Mean over time. [N]
    tension_drift : array_like, shape (n_cycles,)
        Change over the cycle, from `reduction.stages.cycles.loop_energy.mean_drift`. [N]
    end_strain, mean_strain, strain_drift : array_like, shape (n_cycles,)
        The same of strain. [1]

    Returns
    -------
    energy : ndarray, shape (n_cycles,)
        Of the steady loop. [J m-1]

    Raises
    ------
    ValueError
        If the arrays do not broadcast.

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
    >>> closed, _ = loop_energy(tension, strain, np.array([0]), np.array([400]))
    >>> steady = without_drift(closed, end_tension=950.0, mean_tension=1000.0,
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


def bridge_gaps(values: Floats, first: Integers, last: Integers) -> tuple[Floats, Bools]:
    """Series with missing readings bridged, and the cycles that lack too many of them.

    Notes
    -----
    Over a tenth of a cycle a straight line is off by up to 5 % of its amplitude at a turn.

    Examples
    --------
    >>> bridged, lacks = bridge_gaps(np.array([0.0, np.nan, 2.0]), np.array([0]), np.array([2]))
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
    From the nearest of 4,096 tabulated angles by the sum of two angles ([4]_).  Over the rest, at
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
class CycleBasis:
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
    # an end of the cycle counts half; the other half belongs to the cycle that it touches
    weight[first] = time[first + 1] - time[first]
    # one value a sample from one value a cycle, with nothing between cycles
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


def mean_period(turns: Floats, first: Integers, last: Integers, *, last_turn: Floats) -> Floats:
    """Mean duration of up to 21 cycles that touch, around each cycle.

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
    low = np.maximum(place - _AROUND, starts[run])
    high = np.minimum(place + _AROUND, stops[run])
    mean: Floats = (last_turn[high] - turns[low]) / (high - low + 1)
    return mean


def phase_turns(cosine: Floats, sine: Floats, basis: CycleBasis, time: Floats) -> Floats:
    """Time near the first sample of each cycle at which its fundamental turns.

    Examples
    --------
    >>> t = np.arange(14.0)
    >>> basis = cycle_basis(t, np.array([0]), np.array([12]))
    >>> wave = -np.cos(2 * np.pi * (t - 0.4) / 12)
    >>> print(phase_turns(*fundamental(wave, basis)[:2], basis, t).round(3))
    [0.4]
    """
    past = np.arctan2(-sine, -cosine) / basis.turn_rate
    return time[basis.first] + np.where(np.isfinite(past), past, 0.0)


def fundamental(values: Floats, basis: CycleBasis) -> tuple[Floats, Floats, Floats]:
    """Cosine and sine amplitude of the fundamental in each cycle, and its mean.

    Notes
    -----
    A drift d over the cycle, linear in time, adds -d/pi to the sine: see `mean_drift`.

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


def part_means(values: Floats, basis: CycleBasis, middles: Integers) -> Floats:
    """Mean over time of a series in the three parts of each cycle between its middles.

    Examples
    --------
    >>> from reduction.stages.cycles.loop_energy import cycle_basis
    >>> basis = cycle_basis(np.arange(9.0), np.array([0]), np.array([8]))
    >>> print(part_means(np.repeat([1.0, 3.0, 5.0], 3), basis, np.array([[3], [6]])).ravel())
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


def mean_drift(means: Floats, ends: Floats) -> Floats:
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
    >>> print(mean_drift(np.tile(2 * np.arange(4.0), (3, 1)), ends))
    [2. 2. 2. 2.]
    >>> print(mean_drift(np.array([[9.0, 5, 5, 5], [6, 5, 5, 5], [5, 5, 5, 5]]), ends))
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
