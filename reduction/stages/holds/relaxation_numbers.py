"""Drop, rate per decade, creep rate and values at stated times, of one series over time.

A night of samples is reduced to a few hundred means over blocks that grow with time.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole,
   MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from reduction.record.arrays import as_finite, as_increasing, as_same_shape
from reduction.record.errors import DataError
from reduction.record.measurement import Floats, read_only_arrays
from reduction.record.samples import (
    mean_of,
    median_step_reaches,
    release_pages,
    rounding_left,
    sample_blocks,
    select_samples,
    step_of_codes,
)
from reduction.stages.cycles.reading_noise import reading_noise
from reduction.stages.holds.ramp_end import MOTION_KNOWN_TO
from reduction.stages.moduli.least_squares import lag_one_inflation
from reduction.stages.moduli.splice_slip import sample_noise

BLOCKS_PER_DECADE = 40

LARGEST_WEIGHT = 64.0


@dataclass(frozen=True)
@read_only_arrays
class _LogBlocks:
    """Block means of a series, shape (n_blocks,) each; ``time_variance`` is that in a block."""

    elapsed: Floats
    value: Floats
    count: Floats
    time_variance: Floats

    @property
    def weight(self) -> Floats:
        """Relative inverse variance: the count, of which at most 64 are taken as independent.

        Slow drift of a transducer does not average out, so a block of a million samples
        must not outweigh all others.
        """
        return self.count / (1 + (self.count - 1) / LARGEST_WEIGHT)


def logarithmic_blocks(
    elapsed: ArrayLike, values: ArrayLike, *, per_decade: int = BLOCKS_PER_DECADE
) -> _LogBlocks:
    """Means over blocks of equal length in the logarithm of time.

    Notes
    -----
    At 40 blocks a decade a block spans 6 % of its time: the mean of an exponential that decays
    within a block exceeds that at the mean time by up to 2e-4 of its size.

    Examples
    --------
    >>> blocks = logarithmic_blocks(np.arange(1.0, 1001.0), np.ones(1000))
    >>> bool(blocks.count.sum() == 1000), blocks.elapsed.size < 121
    (True, True)
    """
    time = as_increasing("elapsed", elapsed)
    time, series = as_same_shape(elapsed=time, values=values)
    if time.size == 0 or time[0] <= 0:
        raise DataError(
            "time does not start above zero",
            found="no samples" if time.size == 0 else f"{time[0]:g} s",
            needed="a positive time",
        )
    begin = time[0]
    last = int(np.log10(time[-1] / begin) * per_decade)
    sums = np.zeros((4, last + 1))
    for part in sample_blocks(time.size, time, series):
        number = np.floor(np.log10(time[part] / begin) * per_decade).astype(np.intp)
        first = np.flatnonzero(np.diff(number, prepend=-1))
        here = np.minimum(number[first], last)  # rounding of the logarithm may exceed the last one
        count = np.diff(first, append=number.size)
        np.add.at(sums[0], here, np.add.reduceat(time[part], first))
        np.add.at(sums[1], here, np.add.reduceat(series[part], first))
        np.add.at(sums[2], here, count)
        np.add.at(sums[3], here, np.add.reduceat(time[part] ** 2, first))
    elapsed_sum, value_sum, count, square_sum = sums[:, sums[2] > 0]
    mean = elapsed_sum / count
    variance = np.maximum(square_sum / count - mean**2, 0.0)
    return _LogBlocks(mean, value_sum / count, count, variance)


RAMP_TIMES_LEFT_OUT = 3.0

FEWEST_BLOCKS = 8

SHORTEST_SPAN = 0.5


@dataclass(frozen=True)
class Rate:
    """Slope of a series against the decimal logarithm of time."""

    value: float
    standard_uncertainty: float
    elapsed_low: float
    elapsed_high: float


def relaxation_drop(initial_tension: ArrayLike, final_tension: ArrayLike) -> Floats:
    """Fraction of tension lost over a hold.

    Notes
    -----
    Source: [1]_, sec. 4.1 and Figure 24, which print it as "creep".  NaN where the
    initial tension is not positive.

    Examples
    --------
    WHOI-2005-10: new tether in T-6, 400 lbf falls to 325 lbf in three minutes at 275 %.

    >>> print(relaxation_drop(400.0, 325.0))
    0.1875
    """
    initial, final = as_same_shape(initial_tension=initial_tension, final_tension=final_tension)
    drop: Floats = 1 - final / np.where(initial > 0, initial, np.nan)
    return drop


def end_mean(values: ArrayLike, *, n_samples: int) -> tuple[float, float]:
    """Mean of the last samples of a series, with its standard uncertainty.

    Examples
    --------
    >>> mean, _ = end_mean([5.0, 5.0, 4.0, 3.0, 3.0], n_samples=2)
    >>> mean
    3.0
    """
    whole = np.asarray(values, dtype=np.float64)
    (series,) = select_samples(lambda part: np.isfinite(whole[part]), whole)
    noise, quantum = sample_noise(series)
    count = max(1, min(n_samples, series.size))
    variance = noise**2 / count + (quantum**2 / 12 if noise < quantum / 2 else 0.0)
    return mean_of(series[-count:]), float(np.sqrt(variance))


def at_last(since: Floats, values: Floats) -> tuple[float, float, int]:
    """Value at the last reading, its standard uncertainty, and how many readings it is from.

    From a line over the logarithm of time through the last 5 %: their mean is that in the middle of
    them.
    """
    n_samples = max(3, int(_FINAL_SHARE * values.size))
    mean, spread = end_mean(values, n_samples=n_samples)
    last = since[-n_samples:]
    if last.size < 3 or not last[0] > 0:
        return mean, spread, n_samples
    noise = reading_noise(values)
    value, _, own = on_curve(last, values[-n_samples:], float(last[-1]), noise=noise)
    return value, float(np.hypot(spread, own)), n_samples


_FINAL_SHARE = 0.05


def rate_per_decade(
    blocks: _LogBlocks, *, ramp_duration: float, centre_known_to: float = 0.0
) -> Rate:
    r"""Change of a series per decade of time, by regression on block means.

    Notes
    -----
    The logarithm of time is its mean over the ramp, :math:`\ln t - (t_r / t)^2 / 24` at the time
    :math:`t` since its centre. ``centre_known_to`` is the standard uncertainty of the centre [s].

    Examples
    --------
    >>> from reduction.stages.holds.relaxation_and_creep import logarithmic_blocks
    >>> t = np.arange(1.0, 1001.0)
    >>> rate = rate_per_decade(logarithmic_blocks(t, 400 - 20 * np.log10(t)), ramp_duration=2.0)
    >>> print(round(rate.value, 1))
    -20.0
    """
    kept = blocks.elapsed >= RAMP_TIMES_LEFT_OUT * ramp_duration
    elapsed, value, weight = blocks.elapsed[kept], blocks.value[kept], blocks.weight[kept]
    span = float(np.log10(elapsed[-1] / elapsed[0])) if elapsed.size else 0.0
    if elapsed.size < FEWEST_BLOCKS or span < SHORTEST_SPAN:
        is_short = span < SHORTEST_SPAN
        raise DataError(
            f"the hold is too short for a rate per decade: after {RAMP_TIMES_LEFT_OUT:g} ramp times"
            f" ({RAMP_TIMES_LEFT_OUT:g} x {ramp_duration:.3g} s)"
            + (
                f" {span:.2f} decades of time remain; needed {SHORTEST_SPAN:g}"
                if is_short
                else f" {elapsed.size} means over equal steps of log time remain; needed"
                f" {FEWEST_BLOCKS}"
            )
        )
    x = np.log10(elapsed) - (ramp_duration / elapsed) ** 2 / (24 * np.log(10))
    share = weight / weight.sum()
    x = x - share @ x
    y = value - share @ value
    power = float(share @ (x * x))
    slope = float(share @ (x * y)) / power
    residual = np.sqrt(share) * (y - slope * x)
    variance = float(residual @ residual) / (x.size - 2) * lag_one_inflation(residual) / power
    # a centre that is late by one second moves every x by 1 / (t ln 10)
    of_centre = slope * centre_known_to * float(share @ (x / elapsed)) / (power * np.log(10))
    known_to = float(np.hypot(np.sqrt(variance), of_centre))
    return Rate(slope, known_to, float(elapsed[0]), float(elapsed[-1]))


def value_at_times(
    elapsed: ArrayLike, values: ArrayLike, times: ArrayLike, *, begin_uncertainty: float = 0.0
) -> tuple[Floats, Floats]:
    """Series at stated times, each from a parabola through the samples within a tenth of it.

    The parabola is over the logarithm of time, on which a relaxation bends least.  The uncertainty
    holds the change of the series within the uncertainty of its start [s], and the step of the
    converter.  Between two readings of a slow log, a series of one curvature lies between their
    chord and the extrapolated chord behind them.

    Examples
    --------
    >>> value, spread = value_at_times([0.0, 1.0, 2.0, 3.0], [8.0, 6.0, 4.0, 2.0], [1.5, 5.0])
    >>> print(value, spread)
    [ 5. nan] [ 0. nan]
    """
    time = as_increasing("elapsed", elapsed)
    time, series = as_same_shape(elapsed=time, values=as_finite("values", values))
    found, spread = np.full((2, *np.shape(times)), np.nan)
    noise = reading_noise(series)
    rounding = rounding_left(step_of_codes(series), noise)
    for index, wanted in enumerate(np.asarray(times, dtype=np.float64)):
        after = int(np.searchsorted(time, wanted))
        if after == time.size or (after == 0 and time[0] != wanted):
            continue
        first, last = np.searchsorted(time, [0.9 * wanted, 1.1 * wanted])
        slope = 0.0
        if last - first < 4:
            # Too few samples for a line of their own: the two beside the time.
            gap = float(time[after] - time[after - 1]) if after else 0.0
            if gap <= 0.2 * wanted or median_step_reaches(time, 1.5, gap):
                beside = slice(max(after - 1, 0), after + 1)
                found[index] = np.interp(wanted, time[beside], series[beside])
                slope = float(np.ptp(series[beside])) / gap if gap else 0.0
                bend = 0.0
                if 0 < after < time.size - 1:
                    behind = (series[after + 1] - series[after]) / (time[after + 1] - time[after])
                    drawn_on = series[after] - behind * (time[after] - wanted)
                    bend = abs(float(found[index] - drawn_on)) / np.sqrt(3)
                of_begin = slope * begin_uncertainty
                spread[index] = np.sqrt(noise**2 + rounding**2 + of_begin**2 + bend**2)
            continue
        found[index], slope, own = on_curve(
            time[first:last], series[first:last], wanted, noise=noise,
            # the curvature of a power of time exceeds the noise of the mean of thousands of
            # readings
            n_terms=3 if last - first >= _FEWEST_OF_BEND else 2,
        )  # fmt: skip
        spread[index] = np.sqrt(own**2 + rounding**2 + (slope * begin_uncertainty) ** 2)
        release_pages(time, series)
    return found, spread


_FEWEST_OF_BEND = 12  # samples from which on a parabola is no worse than the error it corrects


def on_curve(
    time: Floats, series: Floats, wanted: float, *, noise: float, n_terms: int = 2
) -> tuple[float, float, float]:
    """Value and rate of the regression of a series at a time, and the noise of the value.

    The regression is over the logarithm of time: a line for two terms, a parabola for three.
    """
    level = mean_of(series)
    power, product = np.zeros((n_terms, n_terms)), np.zeros(n_terms)
    for part in sample_blocks(time.size, time, series):
        rows = np.vander(np.log(time[part] / wanted), n_terms, increasing=True)
        power += rows.T @ rows
        product += rows.T @ (series[part] - level)
    size = np.sqrt(np.diag(power))
    inverse = np.linalg.pinv(power / np.outer(size, size), hermitian=True) / np.outer(size, size)
    terms = inverse @ product
    own = noise * float(np.sqrt(max(inverse[0, 0], 0.0)))
    return level + float(terms[0]), float(terms[1]) / wanted, own


TENSION_TOLERANCE = 0.01


def _tension_variation(time: ArrayLike, tension: ArrayLike, *, settled: float = 0.0) -> float:
    """Largest departure of tension from its mean over a hold, as a fraction of the mean.

    Before ``settled``, from which on readings count, a load may swing as it arrives: the mean of
    its departure over that time counts, since a specimen forgets it as it forgets the ramp.

    Examples
    --------
    >>> print(_tension_variation([1.0, 10.0, 100.0], [100.0, 102.0, 98.0]))
    0.02
    >>> t = np.arange(1.0, 1000.0)
    >>> swings = np.where(t < 2, 104.0, 100.0)
    >>> for settled in (0.0, 20.0):
    ...     print(_tension_variation(t, swings, settled=settled) > 0.01)
    True
    False
    """
    blocks = logarithmic_blocks(time, tension, per_decade=20)
    is_later = blocks.elapsed >= settled
    later = blocks.value[is_later] if is_later.any() else blocks.value
    mean = float(np.mean(later))
    if mean <= 0:
        raise DataError("creep under no tension", found=f"{mean:.3g} N", needed="tension above 0")
    departure = float(np.max(np.abs(later - mean)))
    if later.size < blocks.value.size:
        early = np.abs(blocks.value[~is_later] - mean)
        lasts = np.diff(blocks.elapsed[~is_later], prepend=0.0)
        departure = max(departure, float(early @ lasts) / settled)
    return departure / mean


def creep_rate(
    time: ArrayLike,
    strain: ArrayLike,
    tension: ArrayLike,
    *,
    ramp_duration: float,
    compliance: float = float("nan"),
    centre_known_to: float = 0.0,
) -> Rate:
    """Strain gained per decade of time at constant tension.

    Notes
    -----
    A specimen held at constant length by a moving tension does not creep; it relaxes.

    Where strain follows a tension that hunts or drifts, so that strain less tension times the
    ``compliance`` of the ramp [1/N] lies closer to a line, its rate is given.  The correction is
    known to half of itself either way.

    Examples
    --------
    >>> t = np.arange(1.0, 1001.0)
    >>> rate = creep_rate(t, 1 + 0.02 * np.log10(t), np.full(1000, 400.0), ramp_duration=2.0)
    >>> print(round(rate.value, 4))
    0.02
    """
    seconds = as_increasing("time", time)
    seconds, stretch, load = as_same_shape(time=seconds, strain=strain, tension=tension)
    settled = RAMP_TIMES_LEFT_OUT * ramp_duration
    variation = _tension_variation(seconds, load, settled=settled)
    if variation > TENSION_TOLERANCE:
        raise DataError(
            f"tension is not constant: it deviates by {100 * variation:.1f} % from its mean",
            needed=f"{100 * TENSION_TOLERANCE:.0f} % or less",
        )
    blocks = logarithmic_blocks(seconds, stretch)
    of_ramp = {"ramp_duration": ramp_duration, "centre_known_to": centre_known_to}
    rate = rate_per_decade(blocks, **of_ramp)
    if not np.isfinite(compliance):
        return rate
    less = blocks.value - compliance * logarithmic_blocks(seconds, load).value
    steady = rate_per_decade(replace(blocks, value=less), **of_ramp)
    if steady.standard_uncertainty > rate.standard_uncertainty:
        return rate
    left = MOTION_KNOWN_TO * abs(steady.value - rate.value)
    return replace(steady, standard_uncertainty=float(np.hypot(steady.standard_uncertainty, left)))
