"""Noise of the readings of a channel, and how much of it the steps of its converter leave.

Third differences of a smooth series show its noise, but those of a coarse converter show its
steps; noise is then read from the codes, and from the cycles, which repeat.

References
----------
.. [1] P. Hall, J. W. Kay and D. M. Titterington, "Asymptotically optimal difference-based
   estimation of variance in nonparametric regression," Biometrika 77(3), 1990.
.. [2] P. J. Rousseeuw and C. Croux, "Alternatives to the median absolute deviation," J. Am. Stat.
   Assoc. 88(424), 1993 (1.4826).
"""

from __future__ import annotations

from math import comb

import numpy as np
import scipy

from reduction.record.arrays import noise_of_differences
from reduction.record.measurement import Floats
from reduction.record.samples import step_of_codes, take_samples
from reduction.stages.cycles.cycle_product import Cycles

_NOISE_SAMPLES = 65_536

_FEWEST = 5  # turns, or readings of a branch, needed for a scatter

_MOST_CYCLES, _MOST_READINGS = 100, 1 << 17  # examined for it

_CLEAR = 3.0  # standard errors, between the codes that noise fills and those that it leaves empty


def reading_noise(values: Floats) -> float:
    r"""Standard deviation of one reading, from third differences, or fifth or seventh.

    .. math:: \sigma_k = 1.4826 \, \mathrm{median} |\Delta^k y| / \sqrt{\binom{2k}{k}}

    Parameters
    ----------
    values : ndarray, shape (n_samples,)
        A series that is smooth apart from noise; at most its first 65,536 samples
        are used, so that reading in pieces gives the same result. [any]

    Returns
    -------
    noise : float
        In the unit of the series; 0 where fewer than four readings are finite. [any]

    Notes
    -----
    A third difference of white noise has 1 + 9 + 9 + 1 = 20 times its variance ([1]_).  With
    the median ([2]_) the turns of a triangular test have no effect.  A sine of 24 readings has
    third differences as of noise of 0.4 % of its amplitude, and fifth ones of 0.008 %: the higher
    order counts where it shows less than half as much, which noise does not.

    Examples
    --------
    >>> noise = np.random.default_rng(1).normal(0, 0.25, 10_000)
    >>> print(round(reading_noise(noise + np.arange(10_000) ** 2), 2))
    0.25
    """
    level = values[:_NOISE_SAMPLES]
    found = noise_of_differences(np.diff(level, n=3), comb(6, 3))
    for order in (5, 7):
        higher = np.diff(level, n=order)
        if np.count_nonzero(np.isfinite(higher)) < _FEWEST_DIFFERENCES:
            break
        by_higher = noise_of_differences(higher, comb(2 * order, order))
        if not by_higher < found / 2:
            break
        found = by_higher
    return found


_FEWEST_DIFFERENCES = 48  # of a higher order: with fewer, those of noise may differ by half


def noise_beside_sine(values: Floats, readings: float) -> float:
    r"""Standard deviation of one reading of a sine with few readings a cycle.

    .. math:: \Delta \prod_{h=1}^{3} (y_{k+1} - 2 \cos(2 \pi h / n) \, y_k + y_{k-1})

    Differences of six readings a cycle are a tenth of the amplitude and more; this difference has
    neither the sine nor its second and third harmonic.

    Examples
    --------
    >>> turn, noise = np.arange(900) / 6.13, np.random.default_rng(1).normal(0, 0.01, 900)
    >>> wave = 5 - np.cos(2 * np.pi * turn) + 0.1 * np.cos(4 * np.pi * turn) + noise
    >>> print(round(reading_noise(wave), 2), round(noise_beside_sine(wave, 6.13), 3))
    0.08 0.01
    """
    usual = reading_noise(values)
    weights = np.array([1.0, -1.0])
    for harmonic in (1, 2, 3):
        weights = np.convolve(weights, [1.0, -2 * np.cos(2 * np.pi * harmonic / readings), 1.0])
    left = np.convolve(values[:_NOISE_SAMPLES], weights, mode="valid")
    if not np.isfinite(left).any():
        return usual
    return min(usual, noise_of_differences(left, float(np.sum(weights**2))))


FEW_READINGS = 24
"""Of a cycle of a sine: with fewer, differences of its harmonics are as large as noise. [1]"""


def within_scatter(noise: float, top: Floats) -> float:
    """Noise of a reading, limited to what the scatter of extremes from cycle to cycle allows.

    With about fifteen readings a cycle, third differences take the corners of a wave for noise.

    Examples
    --------
    >>> print(within_scatter(2.0, np.full(9, 5.0)), within_scatter(2.0, np.arange(4.0)))
    0.0 2.0
    """
    change = np.diff(top[np.isfinite(top)])
    if change.size < _FEWEST:
        return noise
    return min(noise, float(np.sqrt(np.mean(change**2) / 2)) / _LEAST_OF_GREATEST)


_LEAST_OF_GREATEST = 0.2  # of the noise: half the scatter of the greatest of hundreds of readings


def vibration_beside_wave(time: Floats, values: Floats, cycles: Cycles) -> tuple[float, float]:
    r"""Frequency and amplitude of an oscillation that is no part of the wave; zeros without one.

    Parameters
    ----------
    time, values : ndarray, shape (n_samples,)
        Time, and a channel. [s], [any]
    cycles : Cycles
        From `reduction.stages.cycles.cycle_search`.

    Returns
    -------
    frequency, amplitude : float
        [Hz], [any]

    Notes
    -----
    Mains hum is such an oscillation.  It is a line in the spectrum of third differences over the
    first cycles, of 30 times the power of any harmonic of the wave, and of the noise, within two to
    twelve times the frequency of the wave on both sides.  Those below the twentieth are not read.

    Examples
    --------
    >>> from reduction.record.settings import CycleSettings, PhaseSettings
    >>> from reduction.stages.cycles.cycle_search import (find_cycles)
    >>> from reduction.stages.standstills import find_standstills
    >>> time = np.arange(0, 50, 0.005)
    >>> wave = 100 * np.abs((time / 2.5) % 2 - 1) + np.random.default_rng(1).normal(0, 0.1, 10_000)
    >>> stands = find_standstills(time, wave, wave[None], settings=PhaseSettings())
    >>> cycles = find_cycles(time, wave, wave[None], stands, settings=CycleSettings())
    >>> print(*(round(one, 1) for one in vibration_beside_wave(time, wave, cycles)))
    0 0
    >>> hum = 2 * np.sin(2 * np.pi * 50.01 * time)
    >>> print(*(round(one, 1) for one in vibration_beside_wave(time, wave + hum, cycles)))
    50.0 2.0
    """
    per_cycle = float(np.median(cycles.last - cycles.first))
    parted = np.flatnonzero(cycles.first[1:] != cycles.last[:-1])
    begin = int(cycles.first[0])
    stop = int(cycles.last[parted[0] if parted.size else -1])
    part = slice(begin, min(stop, begin + _NOISE_SAMPLES) + 1)
    n_cycles = (part.stop - part.start) / per_cycle
    if per_cycle < _LEAST_PER_CYCLE or n_cycles < _LEAST_CYCLES:
        return 0, 0
    steps, level = np.diff(time[part]), np.array(values[part])
    known = np.isfinite(level)
    if not known.mean() > _KNOWN or np.ptp(steps) > _UNEVEN * np.median(steps):
        return 0, 0
    level = np.interp(np.arange(level.size), np.flatnonzero(known), level[known])
    third = np.diff(level, n=3)
    window = np.hanning(third.size)
    cycles_a_step = np.arange(third.size // 2 + 1) / third.size
    with np.errstate(divide="ignore", invalid="ignore"):
        amplitude = 2 * np.abs(np.fft.rfft(third * window)) / window.sum()
        amplitude /= np.abs(2 * np.sin(np.pi * cycles_a_step)) ** 3
    power = amplitude**2
    power[: int(_OF_WAVE * n_cycles)] = 0.0  # the wave
    wide, middle = round(10 * n_cycles), round(7 * n_cycles)
    highest = scipy.ndimage.maximum_filter1d(power, wide, mode="constant")
    padded = np.pad(highest, middle)
    beside = np.maximum(padded[: power.size], padded[2 * middle :])
    first = int((_OF_WAVE + 12) * n_cycles)
    with np.errstate(divide="ignore", invalid="ignore"):
        above = np.nan_to_num(power[first:] / beside[first:], posinf=0.0)
    if not above.size or not above.max() > _ABOVE_ALL:
        return 0, 0
    found = first + int(np.argmax(above))
    return float(cycles_a_step[found] / np.median(steps)), float(amplitude[found])


_LEAST_PER_CYCLE, _LEAST_CYCLES = 160, 4

_OF_WAVE = 20  # harmonics

_KNOWN, _UNEVEN = 0.99, 0.1  # share of readings, and spread of the steps of time over one

_ABOVE_ALL = 30.0  # powers of the greatest line beside it


def noise_and_step(values: Floats, noise: float) -> tuple[float, float]:
    r"""Noise of readings before they were rounded, and the step to which they were rounded.

    .. math:: \sigma^2 = s^2 - q^2 / 12

    Where the steps are coarse, the median of third differences is itself a number of steps; their
    mean square then gives the noise, unless the backward steps contradict it: a slow ramp in
    coarse steps has third differences without any noise.  The step is zero where noise of more
    than a step hides it.

    Examples
    --------
    >>> level = np.random.default_rng(1).normal(0, 1, 4000) + np.sin(np.arange(4000) / 300) * 100
    >>> rounded = 3 * np.round(level / 3)
    >>> print([round(one, 1) for one in noise_and_step(rounded, reading_noise(rounded))])
    [1.0, 3.0]
    """
    step = step_of_codes(values)
    if not step or noise > _COARSE * step:
        return noise, 0.0
    codes = values[:_NOISE_SAMPLES] / step
    third = np.abs(np.diff(codes, n=3))
    third = third[np.isfinite(third) & (third < _FAR)]
    # the corners of a wave are not noise: leave out the greatest fifth, as for a normal
    # distribution
    inner = np.sort(third)[: int(0.8 * third.size)]
    square = float(np.mean(inner**2)) / (20 * _OF_INNER) if inner.size else 0.0
    by_differences = float(np.sqrt(max(square - 1 / 12, 0.0)))
    return step * _noise_of_codes(codes, by_differences), step


def _noise_of_codes(codes: Floats, most: float) -> float:
    r"""Noise of a wave in converter codes, where its backward steps contradict a greater one. [1].

    .. math:: b = \langle s\,\varphi(r / s) - r\,\Phi(-r / s) \rangle, \qquad s = \sqrt 2 \sigma

    with b the mean number of steps against the direction of the wave from one reading to the next,
    and r how far the wave moves in that time.  On average a distance holds as many code edges as
    it is steps long, so b is the mean backward distance; a ramp without noise never goes back.
    ``most`` is returned where the count fits that noise within three standard deviations.

    Examples
    --------
    >>> ramp, noise = 0.12 * np.abs(np.arange(4000) % 400 - 200), np.random.default_rng(1)
    >>> print([round(_noise_of_codes(np.round(ramp + noise.normal(0, one, 4000)), 0.5), 1)
    ...     for one in (0.0, 0.2, 0.5)])
    [0.0, 0.2, 0.5]
    """
    steps, reach = np.diff(codes), 1
    # motion of the wave, from readings so far apart that their noise is a small part of it
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


_FAST, _STEPS_APART = 0.9, 4.0  # share of readings below that rate; steps between two readings


def _codes_of_branches(values: Floats, cycles: Cycles, step: float) -> list[Floats]:
    """Readings of the rises and falls of some cycles, one row each, in converter steps.

    Noise makes a turn a reading early or late: each row begins where it is most like the others.
    """
    found = []
    for begin, end in zip(cycles.branch_first.T, cycles.branch_last.T, strict=True):
        n = int(np.median(end - begin)) + 1
        begin = begin[(begin > 0) & (begin + n < values.size)]
        begin = begin[: max(min(_MOST_CYCLES, _MOST_READINGS // n), 2)]
        if n < _FEWEST or not begin.size:
            continue
        places = begin[:, None, None] + np.array([-1, 0, 1])[:, None] + np.arange(n)
        codes = take_samples(values, places.ravel()).reshape(places.shape) / step
        codes = codes[np.isfinite(codes).all(axis=(1, 2))]
        if not codes.size:
            continue
        apart = np.abs(codes - np.median(codes[:, 1], axis=0)).sum(axis=2)
        found.append(codes[np.arange(len(codes)), apart.argmin(axis=1)])
    return found


def scatter_over_cycles(values: Floats, cycles: Cycles, step: float) -> float:
    r"""Scatter over the cycles of one place of the wave, before rounding. [any].

    .. math:: \langle v \rangle \approx q \sigma / \sqrt{\pi}
              \quad (\sigma \ll q), \qquad \langle v \rangle \approx \sigma^2 + q^2 / 12

    averaging the variance v of its codes over all levels that a reading may have between codes.
    Noise or a log out of step with its wave causes it, and either frees the mean from the steps;
    a log in step has none, though third differences take its steps for noise.

    Examples
    --------
    >>> first = np.arange(0, 1200, 40)
    >>> ends = np.column_stack([first, first + 20])
    >>> cycles = Cycles(first, first + 40, ends, ends + 20, np.ones((30, 2)),
    ...     np.zeros(1201), np.zeros(1201), np.zeros(1201), 0.1)
    >>> wave = 107.4 - 5.37 * np.abs(np.arange(1201) % 40 - 20)
    >>> noise = np.random.default_rng(1).normal(0, 1, 1201)
    >>> for size in (0.0, 0.2, 0.6):
    ...     print(f"{scatter_over_cycles(np.round(wave + size * noise), cycles, 1.0):.2f}")
    0.00
    0.20
    0.59
    """
    codes = _codes_of_branches(values, cycles, step)
    if not codes:
        return np.inf
    square = float(np.mean(np.concatenate([np.var(one, axis=0) for one in codes])))
    linear = square * np.sqrt(np.pi)
    return step * float(linear if linear < _FEW_FLIP else np.sqrt(square - 1 / 12))


_FEW_FLIP = 0.3  # steps of scatter, where the two lines meet


def rounding_of_branches(values: Floats, cycles: Cycles, step: float) -> float:
    r"""Root mean square of the mean error over a branch that rounding leaves. [any].

    .. math:: u = q \sqrt{\langle (\tfrac1n \sum_k \{o + x_k\})^2 \rangle}

    with {} the distance of a number from the nearest whole one, x the readings of the branch
    without rounding, from a cubic through their codes, and o any level.  Where a branch moves by a
    whole number of steps from one reading to the next, all its readings have the same error.

    Examples
    --------
    Ramps of 20 readings, of 5 and of 5.37 steps a reading, from a level that any cycle has:

    >>> first = np.arange(0, 200, 40)
    >>> ends = np.column_stack([first, first + 20])
    >>> cycles = Cycles(first, first + 40, ends, ends + 20, np.ones((5, 2)),
    ...     np.zeros(201), np.zeros(201), np.zeros(201), 0.1)
    >>> wave = 20.0 - np.abs(np.arange(201) % 40 - 20)
    >>> print(round(rounding_of_branches(5 * wave, cycles, 1.0), 2),
    ...     round(rounding_of_branches(np.round(5.37 * wave), cycles, 1.0), 2))
    0.29 0.02
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


_COARSE, _FAR = 1.5, 12.0  # steps of a converter


_OF_INNER = 0.4377  # mean square of the least four fifths of normal values, as a share of the whole
