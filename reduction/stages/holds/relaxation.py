"""Relaxation at constant length and creep at constant tension.

What the hold stage hands on: one row a hold and specimen.

Means over blocks that grow with time: a night of samples becomes a few hundred numbers.

Relaxation of tension at constant length: drop, rate per decade, tension at stated times.

The specimen relaxes during the ramp, too.  Rates therefore count time from the centre of
the ramp (`reduction.stages.holds.hold_start`) and leave out the first three ramp times.

Creep: strain gained at constant tension.

References
----------
.. [1] J. D. Ferry, "Viscoelastic Properties of Polymers," 3rd ed., Wiley, 1980, ch. 3.
.. [2] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole,
   MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from reduction.record.arrays import as_finite, as_increasing, as_same_shape
from reduction.record.errors import DataError
from reduction.record.measurement import Floats, Integers, read_only_arrays
from reduction.record.notes import Note
from reduction.record.samples import (
    mean_of,
    median_step_reaches,
    release_pages,
    sample_blocks,
    select_samples,
)
from reduction.stages.cycles.loop_energy import reading_noise
from reduction.stages.moduli.least_squares import lag_one_inflation
from reduction.stages.moduli.splice_slip import sample_noise


@dataclass(frozen=True)
@read_only_arrays
class HoldResult:
    """Relaxation (constant length) or creep (constant tension) of one specimen in one hold.

    A number that the record does not support is NaN, and ``refusals`` says why.

    Parameters
    ----------
    specimen : str
        Which specimen.
    kind : str
        ``relaxation`` or ``creep``.
    hold_start_time, hold_duration : float
        [s]
    hold_strain, hold_initial_tension, hold_final_tension : float
        Mean strain [1]; tension at the start and at the end of the hold, each the
        mean of a short stretch that ``made`` names. [N]
    relaxation_drop, relaxation_drop_standard_uncertainty : float
        Share of the initial tension lost over the hold. [1]
    rate_per_decade, rate_per_decade_standard_uncertainty : float
        Share of tension (relaxation) or strain (creep) per decade of time. [1]
    times : ndarray, shape (n_times,)
        Times after the end of the ramp. [s]
    tension_at_time, strain_at_time : ndarray, shape (n_times,)
        NaN where the hold is shorter. [N], [1]
    prony_tension, prony_time : ndarray, shape (n_terms,)
        Terms of the series; empty where refused. [N], [s]
    prony_tension_standard_uncertainty, prony_time_standard_uncertainty : ndarray, shape (n_terms,)
    long_time_tension, long_time_tension_standard_uncertainty : float
        [N]
    criterion : str
        How the number of terms was chosen.
    refusals : tuple of Note
        Numbers that are missing, each with its reason.
    notes : tuple of Note
        What else there is to know.
    made : tuple of str
        Samples of the ends, how the finite ramp was treated: lines of the history.
    ramp_centre_time : float
        When the ramp acts as a step: zero of the time of the rate per decade; NaN where the
        record does not show the ramp. [s]
    hold_strain_standard_uncertainty : float
        Of the mean (type A), as the next ones. [1]
    hold_initial_tension_standard_uncertainty, hold_final_tension_standard_uncertainty : float
        [N]
    tension_at_time_standard_uncertainty, strain_at_time_standard_uncertainty : ndarray
        Shape (n_times,), or empty. [N], [1]
    """

    specimen: str
    kind: str
    hold_start_time: float
    hold_duration: float
    hold_strain: float
    hold_initial_tension: float
    hold_final_tension: float
    relaxation_drop: float
    relaxation_drop_standard_uncertainty: float
    rate_per_decade: float
    rate_per_decade_standard_uncertainty: float
    times: Floats
    tension_at_time: Floats
    strain_at_time: Floats
    prony_tension: Floats
    prony_tension_standard_uncertainty: Floats
    prony_time: Floats
    prony_time_standard_uncertainty: Floats
    long_time_tension: float
    long_time_tension_standard_uncertainty: float
    criterion: str = ""
    refusals: tuple[Note, ...] = field(default=())
    notes: tuple[Note, ...] = field(default=())
    made: tuple[str, ...] = field(default=())
    ramp_centre_time: float = float("nan")
    hold_strain_standard_uncertainty: float = float("nan")
    hold_initial_tension_standard_uncertainty: float = float("nan")
    hold_final_tension_standard_uncertainty: float = float("nan")
    tension_at_time_standard_uncertainty: Floats = field(default_factory=lambda: np.empty(0))
    strain_at_time_standard_uncertainty: Floats = field(default_factory=lambda: np.empty(0))

    @property
    def refused(self) -> str:
        """Which numbers it does not give, and why; empty where it gives all."""
        return "; ".join(str(one).removeprefix("refused: ") for one in self.refusals)


def hold_numbers(holds: Sequence[HoldResult]) -> Integers:
    """Number of each hold in its test, by time from 1; one for all specimens that stand.

    Parameters
    ----------
    holds : sequence of HoldResult
        Of one test.

    Returns
    -------
    numbers : ndarray of int, shape (n_holds,)
        Equal where the holds begin together. [1]

    Raises
    ------
    AttributeError
        If an entry is no hold.

    Notes
    -----
    Nothing is computed from a report here ([1]_ does not number its holds).

    Examples
    --------
    >>> hold_numbers([]).size
    0

    References
    ----------
    .. [1] WHOI-2005-10, sec. 4.1.
    """
    if not holds:
        return np.empty(0, dtype=np.int64)
    _, place = np.unique([hold.hold_start_time for hold in holds], return_inverse=True)
    return np.asarray(place + 1)


BLOCKS_PER_DECADE = 40

LARGEST_WEIGHT = 64.0


@dataclass(frozen=True)
@read_only_arrays
class _LogBlocks:
    """Block means of a series, shape (n_blocks,) each."""

    elapsed: Floats
    value: Floats
    count: Floats

    @property
    def weight(self) -> Floats:
        """Relative inverse variance: the count, of which at most 64 are taken as independent.

        Slow drift of a transducer does not average out, so a block of a million samples
        may not outweigh all others.
        """
        return self.count / (1 + (self.count - 1) / LARGEST_WEIGHT)


def logarithmic_blocks(
    elapsed: ArrayLike, values: ArrayLike, *, per_decade: int = BLOCKS_PER_DECADE
) -> _LogBlocks:
    """Means over blocks of equal length in the logarithm of time.

    Parameters
    ----------
    elapsed : array_like, shape (n_samples,)
        Time, increasing and positive. [s]
    values : array_like, shape (n_samples,)
        Series. [any unit]
    per_decade : int, optional
        Blocks per decade of time. [1]

    Returns
    -------
    blocks : Blocks
        Blocks that hold a sample, in order. [s], [unit of the series]

    Raises
    ------
    DataError
        If the time does not increase from above zero, or the series do not pair up.

    Notes
    -----
    At 40 blocks a decade a block spans 6 % of its time: an exponential that decays within
    it is off by at most 2e-4 of its size.

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
    sums = np.zeros((3, last + 1))
    for part in sample_blocks(time.size, time, series):
        number = np.floor(np.log10(time[part] / begin) * per_decade).astype(np.intp)
        first = np.flatnonzero(np.diff(number, prepend=-1))
        here = np.minimum(number[first], last)  # rounding of a logarithm may pass the last one
        count = np.diff(first, append=number.size)
        np.add.at(sums[0], here, np.add.reduceat(time[part], first))
        np.add.at(sums[1], here, np.add.reduceat(series[part], first))
        np.add.at(sums[2], here, count)
    elapsed_sum, value_sum, count = sums[:, sums[2] > 0]
    return _LogBlocks(elapsed_sum / count, value_sum / count, count)


RAMP_TIMES_LEFT_OUT = 3.0

FEWEST_BLOCKS = 8

SHORTEST_SPAN = 0.5


@dataclass(frozen=True)
class Rate:
    """Slope of a series against the decimal logarithm of time.

    Parameters
    ----------
    value, standard_uncertainty : float
        Change per decade of time. [unit of the series]
    elapsed_low, elapsed_high : float
        Range of time from the centre of the ramp. [s]
    """

    value: float
    standard_uncertainty: float
    elapsed_low: float
    elapsed_high: float


def relaxation_drop(initial_tension: ArrayLike, final_tension: ArrayLike) -> Floats:
    """Share of tension lost over a hold.

    Parameters
    ----------
    initial_tension, final_tension : array_like, shape (...)
        Tension at the start and at the end of the hold. [N]

    Returns
    -------
    drop : ndarray, shape (...)
        Positive for a loss. [1]

    Raises
    ------
    DataError
        If the shapes differ.

    Notes
    -----
    Source: [2]_, sec. 4.1 and Figure 24, which print it as "creep".  NaN where the
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


def end_mean(values: ArrayLike, *, n_samples: int, at_end: bool) -> tuple[float, float]:
    """Mean of a short stretch at one end of a series, with its standard uncertainty.

    Parameters
    ----------
    values : array_like, shape (n,)
        Series; NaN is left out. [any unit]
    n_samples : int
        Length of the stretch. [1]
    at_end : bool
        Take the last samples, not the first. [1]

    Returns
    -------
    mean : float
        Mean of the stretch. [unit of the series]
    standard_uncertainty : float
        Noise over the root of the count; where the noise is below half the step of the
        digitizer, that step over the root of 12 as well (type A). [unit of the series]

    Raises
    ------
    DataError
        If fewer than two values are finite.

    Examples
    --------
    >>> mean, _ = end_mean([5.0, 5.0, 4.0, 3.0, 3.0], n_samples=2, at_end=True)
    >>> mean
    3.0
    """
    whole = np.asarray(values, dtype=np.float64)
    (series,) = select_samples(lambda part: np.isfinite(whole[part]), whole)
    noise, quantum = sample_noise(series)
    count = max(1, min(n_samples, series.size))
    stretch = series[-count:] if at_end else series[:count]
    variance = noise**2 / count + (quantum**2 / 12 if noise < quantum / 2 else 0.0)
    return mean_of(stretch), float(np.sqrt(variance))


def rate_per_decade(blocks: _LogBlocks, *, ramp_duration: float) -> Rate:
    r"""Change of a series per decade of time, by regression on block means.

    Parameters
    ----------
    blocks : Blocks
        Means against the time from the centre of the ramp. [s], [unit of the series]
    ramp_duration : float
        Duration of the equivalent ramp; the first three of them are left out. [s]

    Returns
    -------
    rate : Rate
        Slope against log10(time); the uncertainty is type A, from the scatter of the block
        means about the line, widened by their correlation, so it holds curvature too.
        [unit of the series]

    Raises
    ------
    DataError
        If what is left spans less than half a decade or fewer than eight blocks.

    Notes
    -----
    After three ramp times what the finite ramp does to a logarithmic relaxation is below
    half a percent of its rate (:math:`1/24 \cdot 1/9`).

    Examples
    --------
    >>> from reduction.stages.holds.relaxation import logarithmic_blocks
    >>> t = np.arange(1.0, 1001.0)
    >>> rate = rate_per_decade(logarithmic_blocks(t, 400 - 20 * np.log10(t)), ramp_duration=2.0)
    >>> print(round(rate.value, 1))
    -20.0
    """
    kept = blocks.elapsed >= RAMP_TIMES_LEFT_OUT * ramp_duration
    elapsed, value, weight = blocks.elapsed[kept], blocks.value[kept], blocks.weight[kept]
    span = float(np.log10(elapsed[-1] / elapsed[0])) if elapsed.size else 0.0
    if elapsed.size < FEWEST_BLOCKS or span < SHORTEST_SPAN:
        raise DataError(
            f"the hold is too short for a rate per decade: {span:.2f} decades and {elapsed.size} "
            f"blocks after {RAMP_TIMES_LEFT_OUT:g} ramp times of {ramp_duration:.3g} s",
            needed=f"{SHORTEST_SPAN:g} decades and {FEWEST_BLOCKS} blocks",
        )
    x = np.log10(elapsed)
    share = weight / weight.sum()
    x = x - share @ x
    y = value - share @ value
    power = float(share @ (x * x))
    slope = float(share @ (x * y)) / power
    residual = np.sqrt(share) * (y - slope * x)
    variance = float(residual @ residual) / (x.size - 2) * lag_one_inflation(residual) / power
    return Rate(slope, float(np.sqrt(variance)), float(elapsed[0]), float(elapsed[-1]))


def value_at_times(
    elapsed: ArrayLike, values: ArrayLike, times: ArrayLike
) -> tuple[Floats, Floats]:
    """Series at stated times, each from a line through the samples within a tenth of it.

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
    for index, wanted in enumerate(np.asarray(times, dtype=np.float64)):
        after = int(np.searchsorted(time, wanted))
        if after == time.size or (after == 0 and time[0] != wanted):
            continue
        first, last = np.searchsorted(time, [0.9 * wanted, 1.1 * wanted])
        if last - first < 4:
            # Too few samples for a line of their own: the two beside the time.
            gap = float(time[after] - time[after - 1]) if after else 0.0
            if gap <= 0.2 * wanted or median_step_reaches(time, 1.5, gap):
                beside = slice(max(after - 1, 0), after + 1)
                found[index] = np.interp(wanted, time[beside], series[beside])
                spread[index] = noise
            continue
        found[index], spread[index] = _on_line(
            time[first:last], series[first:last], wanted, noise=noise
        )
        release_pages(time, series)
    return found, spread


def _on_line(time: Floats, series: Floats, wanted: float, *, noise: float) -> tuple[float, float]:
    """Value of the regression of a series at a time, and its standard uncertainty."""
    count = time.size
    mean, square, product = mean_of(time) - wanted, 0.0, 0.0
    for part in sample_blocks(count, time, series):
        off = (time[part] - wanted) - mean
        square += float(off @ off)
        product += float(off @ series[part])
    value = mean_of(series) - product / square * mean
    return value, noise * float(np.sqrt(1 / count + mean**2 / square))


TENSION_TOLERANCE = 0.01


def _tension_variation(time: ArrayLike, tension: ArrayLike) -> float:
    """Largest departure of tension from its mean over a hold, as a share of the mean.

    Examples
    --------
    >>> print(_tension_variation([1.0, 10.0, 100.0], [100.0, 102.0, 98.0]))
    0.02
    """
    blocks = logarithmic_blocks(time, tension, per_decade=20)
    mean = float(np.mean(blocks.value))
    if mean <= 0:
        raise DataError("creep under no tension", found=f"{mean:.3g} N", needed="tension above 0")
    return float(np.max(np.abs(blocks.value - mean))) / mean


def creep_rate(
    time: ArrayLike, strain: ArrayLike, tension: ArrayLike, *, ramp_duration: float
) -> Rate:
    """Strain gained per decade of time at constant tension.

    Notes
    -----
    A specimen held at constant length by a moving tension does not creep; it relaxes.

    Examples
    --------
    >>> t = np.arange(1.0, 1001.0)
    >>> rate = creep_rate(t, 1 + 0.02 * np.log10(t), np.full(1000, 400.0), ramp_duration=2.0)
    >>> print(round(rate.value, 4))
    0.02
    """
    seconds = as_increasing("time", time)
    seconds, stretch, load = as_same_shape(time=seconds, strain=strain, tension=tension)
    variation = _tension_variation(seconds, load)
    if variation > TENSION_TOLERANCE:
        raise DataError(
            f"tension is not constant: it strays {variation:.1%} from its mean",
            needed=f"{TENSION_TOLERANCE:.0%} or less",
        )
    return rate_per_decade(logarithmic_blocks(seconds, stretch), ramp_duration=ramp_duration)
