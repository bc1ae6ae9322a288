"""Relaxation at constant length and creep at constant tension, a hold and a specimen at a time.

The start and end of each hold are found in `reduction.stages.standstills`.  This module takes the
ramp before a hold and the samples of one specimen, tests whether they support a result, and
computes drop, rate per decade and tension at stated times, or strain gained.

To first order a ramp acts as a step at the centre of the tension that it adds, whatever
the law of relaxation; the remaining error falls with the square of ramp time over elapsed time.
The specimen also relaxes during the ramp: rates count time from its centre and leave out the
first three ramp times.

A night of samples is reduced to a few hundred means over blocks that grow with time.

References
----------
.. [1] L. J. Zapas and J. C. Phillips, "Simple shearing flows in polyisobutylene solutions," J.
   Res. Natl. Bur. Stand. 75A(1), 1971 (half of the ramp time as the zero of time).
.. [2] J. D. Ferry, "Viscoelastic Properties of Polymers," 3rd ed., Wiley, 1980, ch. 3.
.. [3] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole,
   MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from reduction.record.arrays import as_finite, as_increasing, as_same_shape
from reduction.record.errors import DataError, FitError
from reduction.record.measurement import Bools, Floats, Integers, read_only_arrays
from reduction.record.notes import Note, note
from reduction.record.samples import (
    BLOCK,
    empty_like,
    finite_extremes,
    last_sample,
    mean_of,
    median_step_reaches,
    release_pages,
    rounding_left,
    sample_blocks,
    select_samples,
    shifted,
    step_of_codes,
)
from reduction.record.settings import HoldSettings
from reduction.stages.approach import find_approach, last_motion
from reduction.stages.cycles.reading_noise import reading_noise
from reduction.stages.holds.prony_series import (
    LARGEST_SHARE,
    PronyFit,
    fit_prony,
    prony_tension,
    terms_by_shape_of_ramp,
)
from reduction.stages.holds.ramp_end import (
    FEWEST_STEPS,
    MOTION_KNOWN_TO,
    at_length_of_ramp_end,
    level_at_end,
    ramp_end_time,
    time_to_stop,
)
from reduction.stages.moduli.least_squares import lag_one_inflation
from reduction.stages.moduli.splice_slip import find_steps, sample_noise
from reduction.stages.standstills import Standstills

_EMPTY = np.empty(0)


@dataclass(frozen=True)
class _Ramp:
    """The ramp that led to a hold."""

    start_time: float
    end_time: float
    centre_time: float
    duration: float
    stiffness: float
    end_uncertainty: float = 0.0
    # tension above its value at the start, at even times up to the end; empty if none is added [N]
    added: Floats = field(default_factory=lambda: _EMPTY)

    @property
    def length(self) -> float:
        """Duration from its first sample to its end. [s]."""
        return self.end_time - self.start_time


def _find_ramp(
    time: ArrayLike, position: ArrayLike, tension: ArrayLike, *, band: float
) -> _Ramp | None:
    r"""Last monotonic motion of a record that ends where a hold begins.

    .. math:: t_c = t_1 - \int_{t_0}^{t_1} \frac{T - T_0}{T_1 - T_0} dt

    is the centre of the tension that the ramp adds; the spread is its second moment.

    Notes
    -----
    The half-ramp rule ([1]_) is the case of tension that rises evenly.  A tension that
    stiffens with stretch has a later centre.  Where the ramp does not add
    tension (unloading), the centre of position is taken.  Both moments are integrals of
    the record, not of its differences, so noise hardly affects them.  The ramp begins at
    the last sample within ``band`` of its far end, which is late by the time that the
    crosshead takes to cross the band.  It ends between two samples (`ramp_end_time`).

    Examples
    --------
    >>> t = np.arange(0.0, 5.0)
    >>> ramp = _find_ramp(t, [0.0, 0.0, 1.0, 2.0, 3.0], [0.0, 0.0, 10.0, 20.0, 30.0], band=0.1)
    >>> ramp.start_time, ramp.centre_time, ramp.duration, round(ramp.stiffness, 6)
    (1.0, 2.5, 3.0, 10.0)
    >>> _find_ramp(t, [0.0, 0.0, 1.0, 1.0, 1.0], [9.0, 9.0, 9.0, 9.0, 9.0], band=2.0) is None
    True
    """
    seconds = as_increasing("time", time)
    seconds, place, load = as_same_shape(time=seconds, position=position, tension=tension)
    way = last_motion(place, band)
    if way is None:
        return None
    # The last sample within the band of the far end: a standstill there is not part of the ramp.
    first = last_sample(
        lambda part: way.sign * (place[part] - place[-1]) >= way.reach - band,
        way.first, place.size, place,
    )  # fmt: skip
    seconds, place, load = seconds[first:], place[first:], load[first:]
    end = float(seconds[-1])
    adds = load if load[-1] > load[0] else place
    lowest, rise = float(adds[0]), float(adds[-1] - adds[0])
    if rise == 0:  # a log too coarse for the motion: it came back to the reading that it left
        return None
    if adds is load:
        # a machine that rings as it stops may read far below what the ramp has added
        highest = float(np.max(load[-1 - _SAMPLES_BESIDE :])) - lowest
        rise = highest if highest - rise > _RINGS * highest else rise
    before = square = 0.0
    for part in sample_blocks(seconds.size, seconds, adds, overlap=1):
        added, left = (adds[part] - lowest) / rise, end - seconds[part]
        before += float(np.trapezoid(added, seconds[part]))
        # Exact where both factors are straight between samples: a ramp may have few of them.
        middle = (left[1:] + left[:-1]) * (added[1:] + added[:-1]) / 2
        both = left[1:] * added[1:] + left[:-1] * added[:-1] + 2 * middle
        square += float(np.diff(seconds[part]) @ both) / 3
    centre = end - before
    spread = max(0.0, square - before**2)
    ended, end_uncertainty = ramp_end_time(seconds, place, band=band)
    return _Ramp(
        start_time=float(seconds[0]),
        end_time=ended,
        centre_time=min(end, max(float(seconds[0]), centre)),
        duration=min(end - float(seconds[0]), float(np.sqrt(12 * spread))),
        stiffness=_upper_slope(place, load),
        end_uncertainty=end_uncertainty,
        added=np.interp(np.linspace(seconds[0], ended, _TIMES_OF_RAMP), seconds, load - lowest)
        if adds is load
        else _EMPTY,
    )


_TIMES_OF_RAMP = 65

_RINGS = 0.02  # of the tension that a ramp adds


def _begins_inside(position: ArrayLike, *, band: float) -> bool:
    """Whether a series shows where its last motion began, so that earlier samples do not matter.

    Examples
    --------
    >>> _begins_inside([0.0, 1.0, 2.0], band=0.1), _begins_inside([5.0, 0.0, 1.0, 2.0], band=0.1)
    (False, True)
    """
    way = last_motion(np.asarray(position, dtype=np.float64), band)
    return way is not None and way.turned


def _upper_slope(place: Floats, load: Floats) -> float:
    """Slope of tension on position over the last half of a stroke; NaN where it has none."""
    half = 0.5 * abs(place[-1] - place[0])
    x, y = select_samples(lambda part: np.abs(place[part] - place[-1]) <= half, place, load)
    middle, level = mean_of(x), mean_of(y)
    square = product = 0.0
    for part in sample_blocks(x.size, x, y):
        off = x[part] - middle
        square += float(off @ off)
        product += float(off @ (y[part] - level))
    low, high = finite_extremes(x)
    return product / square if high > low else float("nan")


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
        Mean strain [1]; tension at the start and at the end of the hold, each from a
        line through a short stretch that ``made`` names. [N]
    relaxation_drop, relaxation_drop_standard_uncertainty : float
        Fraction of the initial tension lost over the hold. [1]
    rate_per_decade, rate_per_decade_standard_uncertainty : float
        Fraction of tension (relaxation) or strain (creep) per decade of time. [1]
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
        Further remarks on the result.
    made : tuple of str
        History: samples used at each end, treatment of the finite ramp.
    ramp_centre_time : float
        Time at which the ramp acts as a step: zero of time for the rate per decade; NaN where the
        record does not show the ramp. [s]
    ramp_end_time, ramp_duration : float
        End of the ramp, between two samples; duration of the equivalent constant-rate ramp used
        for the Prony terms. [s]
    logged_peak_tension, ramp_end_tension : float
        Greatest logged tension near the end of the ramp; tension of the Prony series at the end
        of the ramp. [N]
    hold_strain_standard_uncertainty : float
        Type A, of the mean, as are the next ones. [1]
    hold_initial_tension_standard_uncertainty, hold_final_tension_standard_uncertainty : float
        [N]
    tension_at_time_standard_uncertainty, strain_at_time_standard_uncertainty : ndarray
        Shape (n_times,), or empty. [N], [1]
    is_unloading : bool
        Whether tension fell on the ramp that led to the hold.
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
    ramp_end_time: float = float("nan")
    ramp_duration: float = float("nan")
    logged_peak_tension: float = float("nan")
    ramp_end_tension: float = float("nan")
    hold_strain_standard_uncertainty: float = float("nan")
    hold_initial_tension_standard_uncertainty: float = float("nan")
    hold_final_tension_standard_uncertainty: float = float("nan")
    tension_at_time_standard_uncertainty: Floats = field(default_factory=lambda: np.empty(0))
    strain_at_time_standard_uncertainty: Floats = field(default_factory=lambda: np.empty(0))
    is_unloading: bool = False

    @property
    def refused(self) -> str:
        """Numbers that it does not give, each with the reason; empty where it gives all."""
        return "; ".join(str(one) for one in self.refusals)


def hold_numbers(holds: Sequence[HoldResult]) -> Integers:
    """Number of each hold in its test, by time from 1; shared by all specimens in the machine.

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
    This numbering is not from the report: [1]_ does not number its holds.

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
        must not outweigh all others.
        """
        return self.count / (1 + (self.count - 1) / LARGEST_WEIGHT)


def logarithmic_blocks(
    elapsed: ArrayLike, values: ArrayLike, *, per_decade: int = BLOCKS_PER_DECADE
) -> _LogBlocks:
    """Means over blocks of equal length in the logarithm of time.

    Notes
    -----
    At 40 blocks a decade a block spans 6 % of its time: an exponential that decays within
    a block is wrong by at most 2e-4 of its size.

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
        here = np.minimum(number[first], last)  # rounding of the logarithm may exceed the last one
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
class _Rate:
    """Slope of a series against the decimal logarithm of time."""

    value: float
    standard_uncertainty: float
    elapsed_low: float
    elapsed_high: float


def _relaxation_drop(initial_tension: ArrayLike, final_tension: ArrayLike) -> Floats:
    """Fraction of tension lost over a hold.

    Notes
    -----
    Source: [3]_, sec. 4.1 and Figure 24, which print it as "creep".  NaN where the
    initial tension is not positive.

    Examples
    --------
    WHOI-2005-10: new tether in T-6, 400 lbf falls to 325 lbf in three minutes at 275 %.

    >>> print(_relaxation_drop(400.0, 325.0))
    0.1875
    """
    initial, final = as_same_shape(initial_tension=initial_tension, final_tension=final_tension)
    drop: Floats = 1 - final / np.where(initial > 0, initial, np.nan)
    return drop


def end_mean(values: ArrayLike, *, n_samples: int, at_end: bool) -> tuple[float, float]:
    """Mean of a short stretch at one end of a series, with its standard uncertainty.

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


def _rate_per_decade(blocks: _LogBlocks, *, ramp_duration: float) -> _Rate:
    r"""Change of a series per decade of time, by regression on block means.

    Notes
    -----
    After three ramp times the finite ramp changes the rate of a logarithmic relaxation by less
    than half a percent (:math:`1/24 \cdot 1/9`).

    Examples
    --------
    >>> from reduction.stages.holds.relaxation_and_creep import logarithmic_blocks
    >>> t = np.arange(1.0, 1001.0)
    >>> rate = _rate_per_decade(logarithmic_blocks(t, 400 - 20 * np.log10(t)), ramp_duration=2.0)
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
    x = np.log10(elapsed)
    share = weight / weight.sum()
    x = x - share @ x
    y = value - share @ value
    power = float(share @ (x * x))
    slope = float(share @ (x * y)) / power
    residual = np.sqrt(share) * (y - slope * x)
    variance = float(residual @ residual) / (x.size - 2) * lag_one_inflation(residual) / power
    return _Rate(slope, float(np.sqrt(variance)), float(elapsed[0]), float(elapsed[-1]))


def _value_at_times(
    elapsed: ArrayLike, values: ArrayLike, times: ArrayLike, *, begin_uncertainty: float = 0.0
) -> tuple[Floats, Floats]:
    """Series at stated times, each from a parabola through the samples within a tenth of it.

    The parabola is over the logarithm of time, on which a relaxation bends least.  The uncertainty
    holds the change of the series within the uncertainty of its start [s], and the step of the
    converter.  Between two readings of a slow log, a series of one curvature lies between their
    chord and the extrapolated chord behind them.

    Examples
    --------
    >>> value, spread = _value_at_times([0.0, 1.0, 2.0, 3.0], [8.0, 6.0, 4.0, 2.0], [1.5, 5.0])
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
        found[index], slope, own = _on_curve(
            time[first:last], series[first:last], wanted, noise=noise,
            # the curvature of a power of time exceeds the noise of the mean of thousands of
            # readings
            n_terms=3 if last - first >= _FEWEST_OF_BEND else 2,
        )  # fmt: skip
        spread[index] = np.sqrt(own**2 + rounding**2 + (slope * begin_uncertainty) ** 2)
        release_pages(time, series)
    return found, spread


_FEWEST_OF_BEND = 12  # samples from which on a parabola is no worse than the error it corrects


def _on_curve(
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


def _tension_variation(time: ArrayLike, tension: ArrayLike) -> float:
    """Largest departure of tension from its mean over a hold, as a fraction of the mean.

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


def _creep_rate(
    time: ArrayLike, strain: ArrayLike, tension: ArrayLike, *, ramp_duration: float
) -> _Rate:
    """Strain gained per decade of time at constant tension.

    Notes
    -----
    A specimen held at constant length by a moving tension does not creep; it relaxes.

    Examples
    --------
    >>> t = np.arange(1.0, 1001.0)
    >>> rate = _creep_rate(t, 1 + 0.02 * np.log10(t), np.full(1000, 400.0), ramp_duration=2.0)
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
    return _rate_per_decade(logarithmic_blocks(seconds, stretch), ramp_duration=ramp_duration)


SIGNIFICANT = 3.0

FEWEST_SAMPLES = 20

FINAL_SHARE = 0.05

STEP_BLOCKS = 4096

STEP_FALSE_ALARM = 1e-3


@dataclass(frozen=True)
class Hold:
    """One specimen in one hold: finite samples in order, and the ramp before them.

    Parameters
    ----------
    time, position, tension, strain : ndarray, shape (n_samples,)
        Samples of the hold. [s], [m], [N], [1]
    start_time : float
        End of the approach to the hold. [s]
    ramp : Ramp or None
        None where the record does not show it.
    position_tolerance : float
        Range of position allowed inside the standstill. [m]
    slack_tension : float
        Tension at or below which the specimen is slack. [N]
    logged_peak, ramp_peak, earlier_peak : float
        Greatest reading of tension near the end of the ramp; the greatest of these before the
        ramp ends; the greatest in the last half of the ramp, before these.  NaN where the ramp
        does not add tension. [N]
    ramp_leads_to, ramp_leads_to_within : float
        Tension, extrapolated from the last readings of the ramp to the length where it
        ends, and its noise; NaN where it is not known. [N]
    n_logged : int
        Number of samples in the log, including those that are left out. [1]
    on_tension : bool
        Whether the machine controls the tension, so that the length responds.
    refusals, notes : list of Note
        Filled as the hold is reduced; so is ``made``, the history.
    """

    time: Floats
    position: Floats
    tension: Floats
    strain: Floats
    start_time: float
    ramp: _Ramp | None
    position_tolerance: float
    slack_tension: float = 0.0
    logged_peak: float = float("nan")
    ramp_peak: float = float("nan")
    earlier_peak: float = float("nan")
    ramp_leads_to: float = float("nan")
    ramp_leads_to_within: float = float("nan")
    n_logged: int = 0
    on_tension: bool = False
    refusals: list[Note] = field(default_factory=list)
    notes: list[Note] = field(default_factory=list)
    made: list[str] = field(default_factory=list)

    @property
    def duration(self) -> float:
        """Time from the first to the last sample. [s]."""
        return float(self.time[-1] - self.time[0]) if self.time.size else 0.0

    @cached_property
    def tension_noise(self) -> float:
        """Standard deviation of one reading of tension, its quantum included. [N]."""
        return _noise_of(self.tension)

    @cached_property
    def tension_step(self) -> float:
        """Step of the converter of tension; 0 where noise spreads readings over codes. [N]."""
        return _step_of(self.tension)

    @cached_property
    def motion(self) -> _Motion:
        """Motion of the crosshead since the end of the ramp, in blocks of the logarithm of time."""
        return _motion_of(self)

    @property
    def strain_uncertainty(self) -> float:
        """Type A uncertainty of its mean strain; NaN with fewer than two readings. [1]."""
        (known,) = select_samples(lambda part: np.isfinite(self.strain[part]), self.strain)
        if known.size < 2:
            return float("nan")
        return end_mean(known, n_samples=known.size, at_end=True)[1]

    @property
    def ramp_end_time(self) -> float:
        """End of the ramp, or the first sample where none is known. [s]."""
        return float(self.time[0]) if self.ramp is None else self.ramp.end_time

    @property
    def since_centre(self) -> Floats:
        """Time from the centre of the ramp, or from the first sample where none is known. [s]."""
        centre = self.time[0] if self.ramp is None else self.ramp.centre_time
        return shifted(self.time, float(centre))

    @property
    def ramp_is_within_steps(self) -> bool:
        """Whether the ramp takes at most two steps of the log: each is cut short."""
        if self.ramp is None or self.time.size < 2:
            return False
        step = float(self.time[1] - self.time[0])
        return self.ramp.length <= (FEWEST_STEPS - 1) * (1 + 1e-6) * step

    @property
    def ramp_duration(self) -> float:
        """Duration of the equivalent constant-rate ramp; 0 where none is known. [s]."""
        return 0.0 if self.ramp is None else self.ramp.duration


@dataclass(frozen=True)
class _LateLoad:
    """Tension that goes on rising while the crosshead stands.

    ``rise`` above the end of the ramp, ``peak`` that it reaches [N], ``delay`` of the peak [s].
    """

    rise: float
    peak: float
    delay: float


@dataclass(frozen=True)
class _Ends:
    """Tension at both ends of a hold, and the share lost."""

    initial: float
    final: float
    drop: float
    drop_uncertainty: float
    initial_uncertainty: float
    final_uncertainty: float
    n_initial: int = 0
    n_final: int = 0
    late: _LateLoad | None = None


def _hold_ends(hold: Hold) -> _Ends:
    """Tension at the end of the ramp and at the end of a hold.

    Notes
    -----
    The tension at the end of the ramp is that of a line through as many samples as follow one
    (`level_at_end`).  The end of the ramp is known to a step of the log or to the noise of
    position; the rate of the tension converts this into tension.  A higher peak in the log near
    it means that the tension may be as high.  The line is no shorter than a twentieth of the ramp:
    anything that relaxes faster has done so within it, and machines ring.  Where the last readings
    of the ramp lead to a higher tension than that line, the specimen may have relaxed between two
    readings, and the tension lies between both.  The tension at the end of the hold is from a line
    over the logarithm of time through the last 5 % of the samples, at least three: their mean would
    be the tension in the middle of them.

    Examples
    --------
    WHOI-2005-10, sec. 4.1: 400 lbf falls to 325 lbf in three minutes.

    >>> t = np.linspace(0, 180, 361)
    >>> load = np.interp(t, [0, 120, 180], [400, 325, 325])
    >>> hold = Hold(t, 0 * t, load, 2.75 + 0 * t, 0.0, None, 0.01)
    >>> round(_hold_ends(hold).drop, 4)
    0.1875
    """
    n_final = max(3, int(FINAL_SHARE * hold.time.size))
    final, u_final = _at_last(hold, n_final)
    first = level_at_end(
        shifted(hold.time, hold.ramp_end_time),
        hold.tension,
        noise=reading_noise(hold.tension),
        shortest=0.0 if hold.ramp is None else min(_BESIDE * hold.ramp.length, _RINGING),
        step=hold.tension_step,
    )
    u_initial = first.standard_uncertainty
    if hold.ramp is not None:
        # falling tension is uncertain through the time, rising tension through the position
        u_initial = float(np.hypot(u_initial, first.slope * hold.ramp.end_uncertainty))
        if np.isfinite(hold.ramp.stiffness):
            u_initial = float(
                np.hypot(u_initial, hold.ramp.stiffness * reading_noise(hold.position))
            )
    if hold.ramp_is_within_steps:
        u_initial = float(np.hypot(u_initial, _lost_in_a_decade(hold) / np.sqrt(3)))
    late = _late_load(hold, first.value)
    if late is not None:
        u_initial = float(np.hypot(u_initial, _LATE_MISSES * late.rise))
    above = hold.logged_peak - SIGNIFICANT * hold.tension_noise - first.value
    # the tension did not settle at once: it lies somewhere between the two
    if SIGNIFICANT * u_initial < above < LARGEST_DISAGREEMENT * first.value:
        u_initial = float(np.hypot(u_initial, above / np.sqrt(3)))
    led_to = hold.ramp_leads_to - first.value
    # the ramp says nothing about a piece that has broken
    if SIGNIFICANT * hold.tension_noise < led_to < first.value:
        u_initial = float(np.hypot(u_initial, led_to / np.sqrt(3)))
    initial = first.value
    if late is None and initial > hold.logged_peak + SIGNIFICANT * hold.tension_noise:
        initial, u_initial = _with_ramp(hold, initial, u_initial)
    return _ends_of(initial, u_initial, final, u_final, first.n_samples, n_final, late)


def _ends_of(
    initial: float,
    u_initial: float,
    final: float,
    u_final: float,
    n_initial: int,
    n_final: int,
    late: _LateLoad | None = None,
) -> _Ends:
    """Both end tensions, and the loss between them with its uncertainty."""
    drop = float(_relaxation_drop(initial, final))
    uncertainty = float(np.hypot(u_final, (1 - drop) * u_initial) / initial)
    known = uncertainty if drop == drop else np.nan
    return _Ends(initial, final, drop, known, u_initial, u_final, n_initial, n_final, late)


def _with_ramp(hold: Hold, initial: float, uncertainty: float) -> tuple[float, float]:
    """Tension at the end of a ramp, from the hold extrapolated back and the ramp extrapolated on.

    A line through a few noisy readings of a fast relaxation may exceed everything logged.
    Where the ramp leads to less, within the uncertainty of both, they are weighted by variance.
    """
    ahead, own = hold.ramp_leads_to, hold.ramp_leads_to_within
    if not SIGNIFICANT * float(np.hypot(own, uncertainty)) > initial - ahead > 0:
        return initial, uncertainty
    weight = uncertainty**2 / (own**2 + uncertainty**2)
    both = float(np.hypot(weight * own, (1 - weight) * uncertainty))
    return initial + weight * (ahead - initial), both


def _lost_in_a_decade(hold: Hold) -> float:
    """Tension lost while the time since the ramp grows tenfold, from the first step on.

    A ramp within a step or two of the log may have ended anywhere in the last step.  Relaxation
    before the first reading is not in the log; it may equal that of the decade after it.
    """
    since = shifted(hold.time, hold.ramp_end_time)
    begin = int(np.searchsorted(since, 0.0, side="right"))
    stop = int(np.searchsorted(since, 10 * since[min(begin, since.size - 1)], side="right"))
    if stop - begin < FEWEST_SAMPLES // 4:
        return 0.0
    part = slice(begin, stop)
    _, rate, _ = _on_curve(since[part], hold.tension[part], float(since[begin]), noise=0.0)
    return float(abs(rate) * since[begin] * np.log(10))


def _at_last(hold: Hold, n_samples: int) -> tuple[float, float]:
    """Tension at the last sample, from a line over the logarithm of time through the last ones."""
    series = hold.tension[-n_samples:]
    mean, spread = end_mean(hold.tension, n_samples=n_samples, at_end=True)
    since = hold.time[-n_samples:] - hold.ramp_end_time
    if since.size < 3 or not since[0] > 0:
        return mean, spread
    value, _, own = _on_curve(since, series, float(since[-1]), noise=reading_noise(hold.tension))
    return value, float(np.hypot(spread, own))


def _late_load(hold: Hold, initial: float) -> _LateLoad | None:
    """Rise of the load after the end of its ramp, within one ramp time; None where there is none.

    A specimen at constant length relaxes.  The load is late if it rises by more than the remaining
    motion of the crosshead explains, and by more than a ramp adds within the uncertainty of its
    end.  Means over a tenth of a decade are used, so that noise is not taken for a rise.
    """
    if hold.ramp is None or hold.on_tension or not np.isfinite(hold.logged_peak):
        return None
    since = shifted(hold.time, hold.ramp_end_time)
    begin, stop = np.searchsorted(since, [0.0, hold.ramp.length], side="right")
    if stop - begin < _SAMPLES_BESIDE:
        return None
    blocks = logarithmic_blocks(since[begin:stop], hold.tension[begin:stop], per_decade=10)
    motion = hold.motion
    value = blocks.value
    if motion.greatest and np.isfinite(hold.ramp.stiffness):
        distance = np.interp(blocks.elapsed, motion.time - hold.ramp_end_time, motion.distance)
        value = value - hold.ramp.stiffness * distance
    at = int(np.argmax(value))
    rise = float(value[at]) - initial
    end_known_to = initial * hold.ramp.end_uncertainty / hold.ramp.length
    # both levels may be rounded by half a step of the converter, away from each other
    told = SIGNIFICANT * float(np.hypot(hold.tension_noise, end_known_to)) + hold.tension_step
    # a maximum in the first block is no rise: a line through a fast relaxation ends below it
    if at == 0 or not rise > max(told, _LATE_LEAST * initial):
        return None
    return _LateLoad(rise, float(blocks.value[at]), float(blocks.elapsed[at]))


def _past_jerk(hold: Hold, ends: _Ends) -> tuple[Hold, _Ends]:
    """The hold after the swing of a crosshead that stops with a jerk, and its ends.

    Mass between specimen and load cell keeps moving when the crosshead stops: the load dips below
    its value on the ramp, comes back and swings.  A load that lags was never higher before.  The
    tension at the end of the ramp is extrapolated from the ramp; its uncertainty is the difference
    from the tension that the hold after the swing leads back to.

    Examples
    --------
    >>> t = np.linspace(0, 100, 2001)
    >>> ramp = _Ramp(-10.0, 0.0, -5.0, 10.0, 0.01, 600.0)
    >>> load = 300 * (t + 1) ** -0.05 - 50 * np.exp(-t / 0.3) * np.cos(2 * np.pi * t / 0.8)
    >>> hold = Hold(t, 0 * t, load, 0 * t, 0.0, ramp, 0.01, logged_peak=314, ramp_peak=299)
    >>> swinging = _ends_of(260, 2, 238, 0.1, 10, 100, _LateLoad(54, 314, 0.4))
    >>> kept, ends = _past_jerk(hold, swinging)
    >>> print(kept.time[0], ends.initial, abs(ends.initial - 300) < 2 * ends.initial_uncertainty)
    1.6 299 True
    """
    late = ends.late
    if late is None:
        return hold, ends
    above = hold.ramp_peak - ends.initial
    begin = int(np.searchsorted(shifted(hold.time, hold.ramp_end_time), _SWINGS * late.delay))
    if not above > SIGNIFICANT * hold.tension_noise + late.rise / 4:
        return hold, ends
    if not begin < hold.time.size // 2:
        return hold, ends
    kept = replace(
        hold,
        **{name: getattr(hold, name)[begin:] for name in ("time", "position", "tension", "strain")},
        logged_peak=np.nan,
        ramp_leads_to=np.nan,
    )
    after = _hold_ends(kept)
    # an extrapolation of readings a moment apart is worthless
    is_led = 1 <= hold.ramp_leads_to / hold.ramp_peak < 1 + LARGEST_DISAGREEMENT
    initial = hold.ramp_leads_to if is_led else hold.ramp_peak
    unsure = np.hypot(after.initial_uncertainty, (initial - after.initial) / np.sqrt(3))
    hold.notes.append(
        note(
            "hold-begins-with-jerk",
            before=initial,
            lowest=float(hold.tension[:begin].min()),
            settled=_SWINGS * late.delay,
            after=after.initial,
        )
    )
    at_end = after.final, after.final_uncertainty
    counts = after.n_initial, after.n_final
    return kept, _ends_of(initial, float(unsure), *at_end, *counts, after.late)


_SWINGS = 4.0  # times from the stop to the first peak after it: two swings

_LATE_LEAST = 0.003  # of the tension: a ramp rounds its corner

_LATE_MOST = 0.02  # of the tension: above this the end of the ramp is not in the log

_LATE_MISSES = 2.0  # times the rise in the log: the specimen relaxes while the load rises


def _noise_of(series: Floats) -> float:
    """Standard deviation of one reading, its quantum included."""
    return float(np.hypot(reading_noise(series), _step_of(series) / np.sqrt(12)))


def _step_of(series: Floats) -> float:
    """Step of a converter, where readings have less noise than half of it; else 0."""
    quantum = sample_noise(series)[1]
    return quantum if reading_noise(series) < quantum / 2 else 0.0


@dataclass(frozen=True)
class _Motion:
    """Motion of the crosshead after the end of its ramp.

    ``time`` and ``distance``, shape (n_blocks,), are block means [s], [m]; ``greatest`` the
    greatest of them, signed, zero where none differs significantly from noise; ``known_to`` the
    standard uncertainty of the position that they count from, zero where noise explains it [m].
    """

    time: Floats
    distance: Floats
    greatest: float
    known_to: float


def _motion_of(hold: Hold) -> _Motion:
    """Motion of the crosshead since the end of the ramp, on blocks in the logarithm of time."""
    # from few readings the noise is known to a few over the root of their number
    noise = _noise_of(hold.position) * (1 + 3 / np.sqrt(hold.position.size))
    since = shifted(hold.time, hold.ramp_end_time)
    begin = level_at_end(since, hold.position, noise=noise, step=_step_of(hold.position))
    later = int(np.searchsorted(since, 0.0, side="right"))
    if since.size - later < 2:
        return _Motion(np.empty(0), np.empty(0), 0.0, 0.0)
    blocks = logarithmic_blocks(since[later:], hold.position[later:], per_decade=10)
    quantum = sample_noise(hold.position)[1]
    # for a crosshead that stands, the initial position is known to its noise
    own = min(begin.standard_uncertainty, _NOISE_OF_BEGIN * noise)
    spread = np.hypot(
        np.hypot(noise / np.sqrt(blocks.count), own),
        quantum / np.sqrt(12) if noise < quantum / 2 else 0.0,
    )
    distance = blocks.value - begin.value
    told = np.where(np.abs(distance) > _MOTION_TOLD * spread, distance, 0.0)
    return _Motion(
        blocks.elapsed + hold.ramp_end_time, distance, float(told[np.argmax(np.abs(told))]),
        begin.standard_uncertainty if begin.standard_uncertainty > own else 0.0,
    )  # fmt: skip


_NOISE_OF_BEGIN = 3.0  # at most, for a line through three readings

_MOTION_TOLD = 5.0  # standard uncertainties: some fifty blocks are tested

_MOTION_WORTH = 0.005  # of the tension lost: less changes no number

_MOTION_LARGE = 0.1  # of the tension lost: less is a machine that settles after its ramp


def _at_one_length(hold: Hold, ends: _Ends) -> tuple[Hold, float]:
    """The hold corrected to the length at the end of its ramp, and the uncertainty left. [N]."""
    motion = hold.motion
    stiffness = np.nan if hold.ramp is None else hold.ramp.stiffness
    worth = stiffness * motion.greatest
    # a crosshead that settles between two readings
    of_begin = float(np.nan_to_num(abs(stiffness) * motion.known_to))
    if not abs(worth) > _MOTION_WORTH * abs(ends.initial - ends.final):
        return hold, of_begin
    distance = np.interp(hold.time, motion.time, motion.distance)
    lost = min(max(ends.drop, 0.0), 1.0)
    share = abs(worth) / abs(ends.initial - ends.final)
    found = note("hold-settles", motion=motion.greatest, worth=worth, share=share)
    # the intervals cover half of it
    hold.notes.append(replace(found, severity="note") if share < _MOTION_LARGE else found)
    kept = at_length_of_ramp_end(hold.tension, distance, stiffness=stiffness, lost_share=lost)
    return replace(hold, tension=kept), float(np.hypot(MOTION_KNOWN_TO * abs(worth), of_begin))


def _step_reason(hold: Hold, ends: _Ends) -> Note | None:
    """Name a step of tension inside the hold that is large enough to change a number.

    A crosshead that moves by one code of its encoder makes a step that the interval covers.
    """
    if hold.time.size < FEWEST_SAMPLES or not median_step_reaches(
        hold.time, 3, _longest_step(hold.time)
    ):
        return None
    # where a log thins out, the change per sample changes, which is not a step
    early, late = np.diff(hold.time[:9]), np.diff(hold.time[-9:])
    if not 1 / 3 < np.median(early) / np.median(late) < 3:
        return None
    size = -(-hold.time.size // STEP_BLOCKS)
    whole = hold.time.size // size * size
    if whole < 24 * size:
        return None
    parts = sample_blocks(whole, hold.tension, size=size * max(1, BLOCK // size))
    series = np.concatenate([hold.tension[part].reshape(-1, size).mean(axis=1) for part in parts])
    steps = find_steps(series, false_alarm=STEP_FALSE_ALARM, quantum=hold.tension_step)
    if not steps:
        return None
    largest = max(steps, key=lambda step: abs(step.size))
    lost = abs(ends.initial - ends.final)
    of_drop = np.nan_to_num(ends.drop_uncertainty * abs(ends.initial))
    if abs(largest.size) < max(_MOTION_WORTH * lost, of_drop / 2):
        return None
    when = hold.time[largest.onset * size] - hold.start_time
    return note("hold-tension-steps", step=float(largest.size), time=float(when))


def _longest_step(time: Floats) -> float:
    return max(
        float(np.diff(time[part]).max(initial=0.0))
        for part in sample_blocks(time.size, time, overlap=1)
    )


def _motion_reason(hold: Hold, ends: _Ends) -> Note | None:
    """Name a motion of the crosshead that is too uncertain to be corrected.

    Its error may be a tenth of the drop; without a ramp its effect on tension is unknown.
    """
    motion = hold.motion.greatest
    if hold.ramp is None or not np.isfinite(hold.ramp.stiffness):
        moved, worth = abs(motion) > 0.5 * hold.position_tolerance, float("nan")
    else:
        worth = abs(hold.ramp.stiffness * motion)
        moved = MOTION_KNOWN_TO * worth > max(
            0.1 * abs(ends.initial - ends.final),
            SIGNIFICANT * ends.drop_uncertainty * ends.initial,
        )
    return note("hold-crosshead-moves", motion=motion, worth=worth) if moved else None


def _start_reason(hold: Hold, ends: _Ends) -> Note | None:
    """Name a logged peak before the end of the ramp that exceeds the tension found there.

    A peak near the end is covered by the uncertainty of that tension, unless this is too small.
    """
    noise = hold.tension_noise
    spread = np.hypot(ends.initial_uncertainty, START_KNOWN_TO * ends.initial)
    limits = {
        hold.logged_peak: (1 + LARGEST_DISAGREEMENT) * ends.initial,
        hold.earlier_peak: ends.initial + SIGNIFICANT * float(np.hypot(spread, noise)),
    }
    above = [peak for peak, limit in limits.items() if peak > limit]
    if not above:
        return None
    return note("hold-start-contradicted", peak=max(above), initial=ends.initial)


def _late_reason(ends: _Ends) -> Note | None:
    """Name a load that rises after its ramp by too much for the tension at its end to be known."""
    if ends.late is None or not ends.late.rise > _LATE_MOST * ends.initial:
        return None
    return _late_note(ends.late, is_refused=True)


def _late_note(late: _LateLoad, *, is_refused: bool) -> Note:
    return note(
        "hold-load-late",
        rise=late.rise, peak=late.peak, delay=late.delay, is_refused=is_refused,
    )  # fmt: skip


LARGEST_DISAGREEMENT = 0.1
"""Fraction by which a log may peak above the tension that its hold leads back to. [1]"""

START_KNOWN_TO = 0.005
"""Standard uncertainty of a tension at the end of a ramp beyond its noise, as a fraction: the ramp
rounds its corner. [1]"""


def _reasons_against(hold: Hold, ends: _Ends, settings: HoldSettings) -> list[Note]:
    """All reasons against relaxation numbers from a hold.

    Notes
    -----
    Too short; too few samples; a load that comes late; a slack specimen; tension that rises by
    more than three standard uncertainties; a crosshead whose motion, by the stiffness of the ramp,
    leaves an uncertainty above a tenth of the drop; a log that peaks
    above the tension found at the end of the ramp; a step of tension that relaxation does not
    explain (`find_steps`, false alarm 0.1 %), above 0.5 % of the loss and half the
    standard uncertainty of the drop.

    Examples
    --------
    >>> t = np.linspace(0, 10, 101)
    >>> hold = Hold(t, 0 * t, 400 - t, 1 + 0 * t, 0.0, None, 0.01)
    >>> [one.code for one in _reasons_against(hold, _hold_ends(hold), HoldSettings())]
    ['hold-too-short']
    """
    reasons = []
    if hold.duration < settings.minimum_duration:
        reasons.append(
            note("hold-too-short", duration=hold.duration, needed=settings.minimum_duration)
        )
    if hold.time.size < FEWEST_SAMPLES:
        reasons.append(
            note("hold-too-few-samples", n_samples=hold.time.size, needed=FEWEST_SAMPLES)
        )
    late = _late_reason(ends)
    if late is not None:  # the end of the ramp is not in the log: the other tests say nothing
        return [*reasons, late]
    if not ends.final > hold.slack_tension or not ends.drop_uncertainty < 1 / SIGNIFICANT:
        reasons.append(note("hold-slack", tension=ends.final, slack_tension=hold.slack_tension))
    elif ends.drop < -SIGNIFICANT * ends.drop_uncertainty:
        reasons.append(note("hold-tension-rises", rise=-ends.drop))
    found = _motion_reason(hold, ends), _start_reason(hold, ends), _step_reason(hold, ends)
    reasons += [reason for reason in found if reason]
    return reasons


_LOOKED_BACK = 1 << 16

"""Samples before a hold in which its ramp is first looked for: many cycles may lie between two
holds."""


def _finite_times(part: slice, time: Floats, *series: Floats) -> Floats:
    """Times of the samples of a part, -inf where one of their values is not finite."""
    finite = np.isfinite(time[part])
    for one in series:
        finite &= np.isfinite(one[part])
    return np.where(finite, time[part], -np.inf)


def _is_finite_and_later(time: Floats, *series: Floats, after: float = -np.inf) -> Bools:
    """Mark samples with finite values and a time later than all before."""
    is_finite_and_later, latest = empty_like(time, dtype=bool), after
    for part in sample_blocks(time.size, time, *series, is_finite_and_later):
        known = _finite_times(part, time, *series)
        reached = np.maximum.accumulate(np.concatenate([[latest], known]))
        np.greater(known, reached[:-1], out=is_finite_and_later[part])
        latest = float(reached[-1])
    return is_finite_and_later


def _latest(time: Floats, *series: Floats) -> float:
    """Latest time of samples whose values are finite."""
    latest = -np.inf
    for part in sample_blocks(time.size, time, *series):
        latest = _finite_times(part, time, *series).max(initial=latest)
    return float(latest)


def _ramp_before(time: Floats, moved: Floats, answer: Floats, *, band: float) -> _Ramp | None:
    """The ramp that ends with the last sample, found in as many samples as show where it began."""
    n_looked = 0
    while n_looked < time.size:
        n_looked = min(max(2 * n_looked, _LOOKED_BACK), time.size)
        start = time.size - n_looked
        whole = time, moved, answer
        looked = [one[start:] for one in whole]
        is_finite_and_later = _is_finite_and_later(
            *looked, after=_latest(*(one[:start] for one in whole))
        )
        before = select_samples(is_finite_and_later.__getitem__, *looked)
        if before[0].size > 2 and _begins_inside(before[1], band=band):
            break
    return _find_ramp(*before, band=band) if before[0].size > 2 else None


_SETTLES = 0.5  # of the way between two holds: a shorter last motion is a controller that settles

_SETTLING_RAMPS = 3.0  # ramp times: no controller takes longer to settle, so the machine cycled


def _without_settling(
    ramp: _Ramp,
    time: Floats,
    moved: Floats,
    answer: Floats,
    *,
    band: float,
    left: float,
    level: float,
) -> _Ramp:
    """The ramp that first reached the level of a hold, where the controller overshot it."""
    begins = moved[np.searchsorted(time, ramp.start_time)]
    if not abs(level - begins) < _SETTLES * abs(level - left):
        return ramp
    sign = np.sign(level - left)
    reached = np.fmin(np.fmax.accumulate(sign * moved), sign * level)
    found = _ramp_before(time, sign * reached, answer, band=band)
    at_level = time[np.argmax(reached)]
    if found is None or time[-1] - at_level > _SETTLING_RAMPS * (at_level - found.start_time):
        return ramp
    return found


def _with_time_to_stop(
    ramp: _Ramp, time: Floats, position: Floats, first: int, held_at: float
) -> _Ramp:
    """A ramp that may have ended at any time while its crosshead came to rest."""
    own = slice(int(np.searchsorted(time[: first + 1], ramp.start_time)), first + 1)
    known = np.flatnonzero(_is_finite_and_later(time[own], position[own])) + own.start
    left = time_to_stop(time[known], position[known], held_at=held_at)
    return replace(ramp, end_uncertainty=float(np.hypot(ramp.end_uncertainty, left / 3**0.5)))


def select_hold(
    time: Floats,
    position: Floats,
    tension: Floats,
    strain: Floats,
    standstills: Standstills,
    index: int,
) -> Hold:
    """Take the samples of one specimen in one standstill, and the ramp that led to it.

    Notes
    -----
    The ramp is searched from the middle of the standstill before, or the start of the record.

    Examples
    --------
    A rise of 5 m in 5 s; one sample of the hold is missing.

    >>> t = np.arange(0.0, 40.0)
    >>> x = np.clip(t - 10, 0, 5)
    >>> stand = Standstills(
    ...     first=np.array([15]), last=np.array([39]), start_time=np.array([15.0]),
    ...     end_time=np.array([39.0]), mean_position=np.array([5.0]),
    ...     mean_tension=np.array([[400.0]]), is_rest=np.array([False]),
    ...     position_tolerance=0.05, slack_tension=5.0)
    >>> hold = select_hold(t, x, np.where(t == 20, np.nan, 80 * x), x / 2, stand, 0)
    >>> print(hold.time.size, hold.duration, round(hold.ramp.duration))
    24 24.0 5
    """
    first, last = int(standstills.first[index]), int(standstills.last[index])
    # the first samples of the standstill before may lie below it, where a ramp ended between two
    begin = int(standstills.first[index - 1] + standstills.last[index - 1]) // 2 if index else 0
    # under load control the machine moves the tension, and the length responds
    moved, answer, band = position, tension, standstills.position_tolerance
    if standstills.tension_tolerance is not None:
        moved, answer, band = tension, position, standstills.tension_tolerance
    else:  # the edge of a standstill is where noise hides the rest of the approach
        after = int(standstills.last[index - 1]) + 1 if index else 0
        approach = find_approach(
            time, position, begin=after, first=first, last=last, noise_range=band
        )
        first = first if approach is None else approach.end
    inside = slice(first, last + 1)
    held = [one[inside] for one in (time, position, tension, strain)]
    seconds, place, load, stretch = select_samples(
        _is_finite_and_later(*held[:3]).__getitem__, *held
    )
    if standstills.tension_tolerance is None and last + 1 < time.size:
        n_held = _before_way_out(seconds, load)
        last -= seconds.size - n_held
        seconds, place, load, stretch = (one[:n_held] for one in (seconds, place, load, stretch))
    ramp = _ramp_before(*(one[begin : first + 1] for one in (time, moved, answer)), band=band)
    if ramp is not None and moved is tension and place.size:
        left = moved[begin : int(standstills.last[index - 1]) + 1 if index else begin + 1]
        ramp = _without_settling(
            ramp, *(one[begin : first + 1] for one in (time, moved, answer)), band=band,
            left=float(np.median(left[-_LOOKED_BACK:])), level=float(np.median(load)),
        )  # fmt: skip
    earlier, on_ramp, peak = (
        (np.nan,) * 3 if ramp is None else _logged_peaks(time, tension, ramp, first, last)
    )
    leads_to = within = np.nan
    if ramp is not None and standstills.tension_tolerance is None and place.size:
        ramp = _with_time_to_stop(ramp, time, position, first, float(np.median(place)))
        leads_to, within = _ramp_leads_to(time, position, tension, ramp, first, float(place[0]))
    return Hold(
        time=seconds,
        position=place,
        tension=load,
        strain=stretch,
        start_time=float(time[first]),
        ramp=ramp,
        position_tolerance=standstills.position_tolerance,
        slack_tension=standstills.slack_tension,
        logged_peak=peak,
        ramp_peak=on_ramp,
        earlier_peak=earlier,
        ramp_leads_to=leads_to,
        ramp_leads_to_within=within,
        n_logged=last + 1 - first,
        on_tension=standstills.tension_tolerance is not None,
    )


def _before_way_out(time: Floats, tension: Floats) -> int:
    """How many samples of a hold come before the tension leaves with the crosshead.

    Noise of the position hides the start of the next ramp.  Where the last reading deviates by
    more than the noise from the line over the logarithm of time through those before, the hold ends
    with the last reading that is within the noise, or on the other side.  A longer deviation is the
    specimen's own.

    Examples
    --------
    >>> time = np.arange(200.0)
    >>> tension = 400 - 10 * np.log(1 + time) + 0.1 * np.cos(2 * time)
    >>> tension[-2:] -= 5, 30
    >>> print(_before_way_out(time, tension))
    198
    """
    on_line = min(max(time.size // 5, _FEWEST_ON_LINE), _MOST_ON_LINE)
    tested = on_line // 4
    begin = time.size - on_line - tested
    if begin <= 0:
        return time.size
    clock, series = np.log(time[begin:] - time[0]), tension[begin:]
    line = np.polyfit(clock[:on_line], series[:on_line], 1)
    off = series - np.polyval(line, clock)
    noise = max(float(np.std(off[:on_line])), _noise_of(series[:on_line]))
    if not abs(off[-1]) > max(_LEAVES * noise, _ROUNDED * abs(series[0])):
        return time.size
    back = off[: -tested - 1 : -1] * np.sign(off[-1]) <= noise
    return time.size - int(np.argmax(back))


_FEWEST_ON_LINE, _MOST_ON_LINE = 32, 1 << 14

_LEAVES = 4.0  # standard deviations

_ROUNDED = 1e-9


def _ramp_leads_to(
    time: Floats, position: Floats, tension: Floats, ramp: _Ramp, first: int, held_at: float
) -> tuple[float, float]:
    """Tension extrapolated from the last readings of a ramp to its end, and the noise of it."""
    begin = int(np.searchsorted(time[: first + 1], ramp.start_time))
    end = int(np.searchsorted(time[: first + 1], ramp.end_time))
    known = np.flatnonzero(np.isfinite(position[begin:end] + tension[begin:end])) + begin
    if known.size < _FEWEST_ON_RAMP:
        return float("nan"), float("nan")
    load, place = tension[known[-_FEWEST_ON_RAMP:]], position[known[-_FEWEST_ON_RAMP:]]
    # readings no farther apart than their noise cannot be extrapolated
    noise = reading_noise(position[first : first + known.size])
    if not np.abs(np.diff(place)).min() > SIGNIFICANT * noise:
        return float("nan"), float("nan")
    earlier, slope = np.diff(load) / np.diff(place)
    ahead = held_at - place[-1]
    # where the curvature exceeds noise, the line lies below the curve
    bend = (slope - earlier) / (place[-1] - place[0])
    if abs(bend) * (place[-1] - place[-2]) ** 2 < _BENDS * reading_noise(tension[begin:end]):
        bend = 0.0
    leads_to = float(load[-1] + slope * ahead + bend * ahead * (held_at - place[-2]))
    # noise of a line through two readings; the extrapolation may curve, and be cut short
    reach = ahead / (place[-1] - place[-2])
    noise = reading_noise(tension[first : first + known.size]) * float(np.hypot(1 + reach, reach))
    return leads_to, float(np.hypot(noise, (leads_to - load[-1]) / np.sqrt(3)))


_BENDS = 3.0  # noise of a reading

_FEWEST_ON_RAMP = 3  # readings; the first may lie before the ramp


def _logged_peaks(
    time: Floats, tension: Floats, ramp: _Ramp, first: int, last: int
) -> tuple[float, float, float]:
    """Greatest reading of tension long before the end of a ramp, just before it, and beside it.

    Beside means within a twentieth of the ramp or five samples; NaN where it adds no tension.
    """
    beside = _BESIDE * ramp.length
    clock = time[: last + 1]
    begin, centre, low, end, high = np.searchsorted(
        clock,
        [ramp.start_time, ramp.centre_time, ramp.end_time - beside, ramp.end_time,
         ramp.end_time + beside],
    )  # fmt: skip
    low = max(min(int(low), first - _SAMPLES_BESIDE), int(begin))
    high = min(max(int(high), first + _SAMPLES_BESIDE), last) + 1
    before, on_ramp, near = (
        one[np.isfinite(one)]
        for one in (tension[int(centre) : low], tension[low : int(end)], tension[low:high])
    )
    if not near.size or not near[-1] > tension[begin]:
        return (float("nan"),) * 3
    return _greatest(before), _greatest(on_ramp), _greatest(near)


def _greatest(values: Floats) -> float:
    """Greatest value, or NaN if there is none."""
    return float(np.max(values)) if values.size else float("nan")


_BESIDE, _SAMPLES_BESIDE = 0.05, 5

_RINGING = 2.0  # longest time over which a machine rings; rubber relaxes within seconds too. [s]


def _rate(hold: Hold, ends: _Ends, *, known_to: float) -> _Rate | None:
    """Fraction of tension lost per decade, or None with a refusal.

    The tension due to a motion relaxes as the rest does, but is subtracted unrelaxed.  The rate is
    uncertain by that fraction, twice the uncertainty of the motion.
    """
    if hold.ramp is None:
        hold.refusals.append(note("rate-without-ramp"))
        return None
    since = hold.since_centre
    later = int(np.searchsorted(since, 0.0, side="right"))
    blocks = logarithmic_blocks(since[later:], hold.tension[later:])
    blocks = replace(blocks, value=blocks.value / ends.initial)
    try:
        slope = _rate_per_decade(blocks, ramp_duration=hold.ramp_duration)
    except DataError as error:
        hold.refusals.append(note("no-rate", reason=error.problem))
        return None
    if -slope.value < SIGNIFICANT * slope.standard_uncertainty:
        hold.refusals.append(
            note("rate-not-told-from-zero", loss=-slope.value, spread=slope.standard_uncertainty)
        )
        return None
    spread = float(np.hypot(slope.standard_uncertainty, slope.value * 2 * known_to / ends.initial))
    return _Rate(-slope.value, spread, slope.elapsed_low, slope.elapsed_high)


def _prony(hold: Hold, ends: _Ends, settings: HoldSettings, *, known_to: float) -> PronyFit | None:
    """Prony series, or None with a refusal."""
    if ends.drop < SIGNIFICANT * ends.drop_uncertainty:
        hold.refusals.append(
            note("drop-not-told-from-zero", drop=ends.drop, spread=ends.drop_uncertainty)
        )
        return None
    ramp_end = _equivalent_end(hold)
    later = int(np.searchsorted(hold.time, ramp_end, side="right"))
    blocks = logarithmic_blocks(shifted(hold.time[later:], ramp_end), hold.tension[later:])
    try:
        fit = fit_prony(
            blocks.elapsed,
            blocks.value,
            ramp_duration=hold.ramp_duration,
            maximum_terms=settings.maximum_terms,
            weights=blocks.weight,
            known_to=known_to,
        )
    except FitError as error:
        hold.refusals.append(note("no-prony-series", reason=error.problem, found=error.found))
        return None
    modelled = _at_ramp_end(hold, fit)
    spread = float(np.hypot(ends.initial_uncertainty, START_KNOWN_TO * ends.initial))
    if abs(modelled - ends.initial) > SIGNIFICANT * spread:
        hold.refusals.append(
            note("prony-misses-ramp-end", modelled=modelled, initial=ends.initial, spread=spread)
        )
        return None
    return fit


def _at_ramp_end(hold: Hold, fit: PronyFit) -> float:
    """Tension of a series at the end of the ramp. [N]."""
    (modelled,) = prony_tension(
        [hold.ramp_end_time - _equivalent_end(hold)],
        tension=fit.tension,
        relaxation_time=fit.time,
        long_time_tension=fit.long_time_tension,
        ramp_duration=hold.ramp_duration,
    )
    return float(modelled)


def _equivalent_end(hold: Hold) -> float:
    """End of the constant-rate ramp of the same centre and spread: half its duration later."""
    if hold.ramp is None:
        return float(hold.time[0])
    return max(hold.ramp_end_time, hold.ramp.centre_time + hold.ramp.duration / 2)


def _creep(hold: Hold) -> _Rate | None:
    """Strain per decade, or None with a refusal."""
    if hold.ramp is None:
        hold.refusals.append(note("rate-without-ramp"))
        return None
    since, strain = hold.since_centre, hold.strain
    series = select_samples(
        lambda part: (since[part] > 0) & np.isfinite(strain[part]), since, strain, hold.tension
    )
    try:
        return _creep_rate(*series, ramp_duration=hold.ramp_duration)
    except DataError as error:
        hold.refusals.append(note("no-rate", reason=error.problem))
        return None


def _describe(hold: Hold, rate: _Rate | None, *, follows_hold: bool) -> None:
    """Say how the ramp was treated and what was left out."""
    if hold.ramp is not None:
        added = "length" if hold.on_tension else "tension"
        use = "counts" if hold.on_tension else "enters the Prony terms"
        hold.made.append(
            f"ramp of {hold.ramp.end_time - hold.ramp.start_time:.3g} s; it acts as a step "
            f"{hold.ramp.end_time - hold.ramp.centre_time:.3g} s before the hold (centre of the "
            f"{added} it adds) and {use} as {hold.ramp.duration:.3g} s at constant rate"
        )
    if rate is not None:
        hold.made.append(
            f"rate per decade from {rate.elapsed_low:.3g} to {rate.elapsed_high:.3g} s after "
            "the centre of the ramp"
        )
    left_out = hold.n_logged - hold.time.size
    if left_out > 0:
        hold.notes.append(
            note("hold-samples-left-out", n_left_out=left_out, n_samples=hold.n_logged)
        )
    if follows_hold:
        hold.made.append("relaxation from an earlier hold continues during this one")


def _with_delay(
    hold: Hold, found: tuple[Floats, Floats], times: Floats, delay: float
) -> tuple[Floats, Floats]:
    """Tension at stated times, with its loss during the possible delay of the load.

    No value is given before that: the load has not arrived yet.
    """
    value, spread = (np.where(times > delay, one, np.nan) for one in found)
    later, _ = _value_at_times(shifted(hold.time, hold.ramp_end_time), hold.tension, times + delay)
    lost = np.nan_to_num(value - later) / np.sqrt(3)
    return value, np.hypot(spread, lost)


def _with_motion(read: _Ends, kept: _Ends, unknown: float) -> _Ends:
    """Ends as they are read, with the drop at constant length and its uncertainty."""
    known_to = max(kept.drop_uncertainty, read.drop_uncertainty)
    spread = float(np.hypot(known_to, unknown / read.initial))
    return replace(read, drop=kept.drop, drop_uncertainty=spread)


def _less_known(fit: PronyFit, unknown: float) -> PronyFit:
    """A series widened by the uncertainty of a motion during the hold, in all its tensions.

    The motion goes on within the times of the terms, so it is divided among them by their size.
    """
    share = fit.tension / fit.tension.sum()
    return replace(
        fit,
        tension_standard_uncertainty=np.hypot(fit.tension_standard_uncertainty, share * unknown),
        long_time_tension_standard_uncertainty=float(
            np.hypot(fit.long_time_tension_standard_uncertainty, unknown)
        ),
    )


def _with_shape_of_ramp(fit: PronyFit, hold: Hold) -> PronyFit | None:
    """A series with the uncertainty of its terms by the shape of the ramp, or a refusal.

    The equivalent constant-rate ramp has the centre and the spread of the logged tension,
    which relaxed during the ramp.
    """
    ramp = hold.ramp
    if ramp is None or not ramp.added.size:
        return fit
    since_end = _equivalent_end(hold) - ramp.end_time
    own = terms_by_shape_of_ramp(
        ramp.added, ramp.length, fit.tension, fit.time, fit.long_time_tension,
        ramp_duration=hold.ramp_duration, since_end=since_end,
    )  # fmt: skip
    off = np.abs(own - fit.tension)
    if np.any(off > LARGEST_SHARE * fit.tension):
        found = (
            f"a term changes by {float((off / fit.tension).max()):.0%} with the shape of its ramp"
        )
        reason = "the ramp is not of constant rate"
        hold.refusals.append(note("no-prony-series", reason=reason, found=found))
        return None
    spread = np.hypot(fit.tension_standard_uncertainty, off)
    return replace(fit, tension_standard_uncertainty=spread)


def _result(
    hold: Hold,
    *,
    name: str,
    kind: str,
    settings: HoldSettings,
    follows_hold: bool,
) -> HoldResult:
    """Reduce one hold of one specimen."""
    times = np.array(settings.times, dtype=np.float64)
    nothing = np.full(times.size, np.nan)
    drop = _Rate(np.nan, np.nan, np.nan, np.nan)
    rate: _Rate | None = None
    prony: PronyFit | None = None
    modelled = np.nan
    tension_at = strain_at = (nothing, nothing)
    ends = _Ends(*(np.nan,) * 6)
    times_known, known = select_samples(
        lambda part: np.isfinite(hold.strain[part]), hold.time, hold.strain
    )
    if hold.time.size < 3:
        hold.refusals.append(note("hold-empty", n_samples=hold.time.size))
    else:
        ends = _hold_ends(hold)
        if kind == "relaxation":
            hold, ends = _past_jerk(hold, ends)
        hold.made.append(
            f"initial tension is that of a line through the first {ends.n_initial} samples at the "
            f"end of the ramp, final tension that of a line over the logarithm of time through the "
            f"last {ends.n_final} of {hold.time.size}"
        )
        unsure = 0.0 if hold.ramp is None else hold.ramp.end_uncertainty
        tension_at = _value_at_times(
            shifted(hold.time, hold.ramp_end_time), hold.tension, times, begin_uncertainty=unsure
        )
        if known.size > 1:
            strain_at = _value_at_times(
                shifted(times_known, hold.ramp_end_time), known, times, begin_uncertainty=unsure
            )
        reasons = _reasons_against(hold, ends, settings) if kind == "relaxation" else []
        if kind == "relaxation" and not reasons and hold.ramp_is_within_steps:
            hold.notes.append(note("hold-ramp-within-steps"))
        hold.refusals.extend(reasons)
        late = ends.late
        if kind == "relaxation" and late is not None:
            hold = replace(hold, logged_peak=max(hold.logged_peak, late.peak))
            tension_at = _with_delay(hold, tension_at, times, late.delay)
            if _late_reason(ends) is not None:
                ends = replace(ends, initial=np.nan, initial_uncertainty=np.nan)
            else:
                hold.notes.append(_late_note(late, is_refused=False))
        if kind == "creep":
            rate = _creep(hold)
        elif not reasons:
            kept, unknown = _at_one_length(hold, ends)
            ends = _with_motion(ends, ends if kept is hold else _hold_ends(kept), unknown)
            drop = _Rate(ends.drop, ends.drop_uncertainty, np.nan, np.nan)
            rate = _rate(kept, ends, known_to=unknown)
            prony = _prony(kept, ends, settings, known_to=unknown)
            if prony is not None:
                modelled = _at_ramp_end(kept, prony)
                prony = _with_shape_of_ramp(_less_known(prony, unknown), kept)
            if prony is None:
                modelled = np.nan
    _describe(hold, rate, follows_hold=follows_hold)
    shown = rate or _Rate(np.nan, np.nan, np.nan, np.nan)
    return HoldResult(
        specimen=name,
        kind=kind,
        hold_start_time=hold.start_time,
        hold_duration=hold.duration,
        hold_strain=mean_of(known) if known.size else np.nan,
        hold_initial_tension=ends.initial,
        hold_final_tension=ends.final,
        relaxation_drop=drop.value,
        relaxation_drop_standard_uncertainty=drop.standard_uncertainty,
        rate_per_decade=shown.value,
        rate_per_decade_standard_uncertainty=shown.standard_uncertainty,
        times=times,
        tension_at_time=tension_at[0],
        strain_at_time=strain_at[0],
        prony_tension=_EMPTY if prony is None else prony.tension,
        prony_tension_standard_uncertainty=(
            _EMPTY if prony is None else prony.tension_standard_uncertainty
        ),
        prony_time=_EMPTY if prony is None else prony.time,
        prony_time_standard_uncertainty=(
            _EMPTY if prony is None else prony.time_standard_uncertainty
        ),
        long_time_tension=np.nan if prony is None else prony.long_time_tension,
        long_time_tension_standard_uncertainty=(
            np.nan if prony is None else prony.long_time_tension_standard_uncertainty
        ),
        criterion="" if prony is None else prony.criterion,
        refusals=tuple(hold.refusals),
        notes=tuple(hold.notes),
        made=tuple(hold.made),
        ramp_centre_time=np.nan if hold.ramp is None else hold.ramp.centre_time,
        ramp_end_time=np.nan if hold.ramp is None else hold.ramp.end_time,
        ramp_duration=np.nan if hold.ramp is None else hold.ramp.duration,
        logged_peak_tension=hold.logged_peak,
        ramp_end_tension=modelled,
        hold_strain_standard_uncertainty=hold.strain_uncertainty,
        hold_initial_tension_standard_uncertainty=ends.initial_uncertainty,
        hold_final_tension_standard_uncertainty=ends.final_uncertainty,
        tension_at_time_standard_uncertainty=tension_at[1],
        strain_at_time_standard_uncertainty=strain_at[1],
        is_unloading=hold.ramp is not None and not hold.ramp.added.size,
    )


def reduce_holds(
    time: ArrayLike,
    position: ArrayLike,
    tension: ArrayLike,
    strain: ArrayLike,
    standstills: Standstills,
    *,
    specimens: tuple[str, ...],
    settings: HoldSettings,
    kind: Literal["relaxation", "creep"] = "relaxation",
) -> tuple[HoldResult, ...]:
    """Relaxation or creep of every specimen in every hold; rests are left out.

    Parameters
    ----------
    time : array_like, shape (n_samples,)
        Elapsed time; samples that do not come later than all before are left out. [s]
    position : array_like, shape (n_samples,)
        Crosshead position. [m]
    tension : array_like, shape (n_specimens, n_samples)
        Tension; NaN is left out, so samples flagged as spikes are passed as NaN. [N]
    strain : array_like, shape (n_specimens, n_samples)
        Strain of the free length. [1]
    standstills : Standstills
        Intervals in which the crosshead (for creep: the tension) stands still; where it has a
        ``tension_tolerance`` the ramps are those of the tension.
    specimens : tuple of str, length n_specimens
        Names, in the order of the rows.
    settings : HoldSettings
        Shortest duration, number of Prony terms, times.
    kind : str, optional
        ``relaxation`` at constant length or ``creep`` at constant tension.

    Returns
    -------
    results : tuple of HoldResult
        By hold, then by specimen; NaN where refused, with the reason in ``refusals``.

    Raises
    ------
    DataError
        If time and position differ in length.

    Notes
    -----
    Source: WHOI-2005-10, sec. 4.1 and Figure 24 ([3]_), which calls relaxation "creep".
    The zero of time for rates is the centre of the added tension or, where the
    machine controls the tension, of the added length; for
    ``times`` it is the first sample of the hold.  The Prony terms are corrected for the
    ramp exactly if it has a constant rate.  Uncertainties are type A.  Cost grows
    with the samples of the holds: series are fitted on 40 block means a decade of time.

    Examples
    --------
    >>> t = np.arange(0.0, 200.0, 0.5)
    >>> x = np.clip(t - 10, 0, 5)
    >>> load = np.where(t < 15, 80 * x, 325 + 75 * np.exp(-(t - 15) / 40))
    >>> stand = Standstills(
    ...     first=np.array([30]), last=np.array([399]), start_time=np.array([15.0]),
    ...     end_time=np.array([199.5]), mean_position=np.array([5.0]),
    ...     mean_tension=np.array([[340.0]]), is_rest=np.array([False]),
    ...     position_tolerance=0.05, slack_tension=5.0)
    >>> hold, = reduce_holds(
    ...     t, x, [load], [x / 2], stand, specimens=("new",), settings=HoldSettings())
    >>> print(round(hold.long_time_tension), hold.prony_time.round())
    325 [40.]
    """
    seconds, place = np.asarray(time, dtype=np.float64), np.asarray(position, dtype=np.float64)
    loads, stretches = np.atleast_2d(tension), np.atleast_2d(strain)
    results = []
    for index in np.flatnonzero(~standstills.is_rest):
        earlier = bool(index) and not standstills.is_rest[index - 1]
        for name, load, stretch in zip(specimens, loads, stretches, strict=True):
            hold = select_hold(seconds, place, load, stretch, standstills, int(index))
            results.append(
                _result(
                    hold,
                    name=name,
                    kind=kind,
                    settings=settings,
                    follows_hold=earlier,
                )
            )
    return tuple(results)
