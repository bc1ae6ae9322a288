r"""Relaxation of tension at constant length: drop, rate per decade, tension at stated times.

The specimen relaxes during the ramp, too.  Rates therefore count time from the centre of
the ramp (`reduction.holds.ramp`) and leave out the first three ramp times.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_finite, as_increasing, as_same_shape
from reduction.cycles.readings import reading_noise
from reduction.errors import DataError
from reduction.holds.blocks import Blocks
from reduction.moduli.noise import sample_noise
from reduction.moduli.separable import lag_one_inflation
from reduction.record import Floats
from reduction.samples.blocks import sample_blocks
from reduction.samples.columns import chosen, mean_of, median_step_reaches
from reduction.samples.scratch import let_go

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
    (series,) = chosen(lambda part: np.isfinite(whole[part]), whole)
    noise, quantum = sample_noise(series)
    count = max(1, min(n_samples, series.size))
    stretch = series[-count:] if at_end else series[:count]
    variance = noise**2 / count + (quantum**2 / 12 if noise < quantum / 2 else 0.0)
    return mean_of(stretch), float(np.sqrt(variance))


def rate_per_decade(blocks: Blocks, *, ramp_duration: float) -> Rate:
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
    >>> from reduction.holds.blocks import logarithmic_blocks
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

    Parameters
    ----------
    elapsed : array_like, shape (n_samples,)
        Time, increasing. [s]
    values : array_like, shape (n_samples,)
        Series. [any unit]
    times : array_like, shape (n_times,)
        Where it is wanted. [s]

    Returns
    -------
    at_times, standard_uncertainty : ndarray, shape (n_times,)
        The value, and that of the line by the noise of the samples (type A); NaN where
        the series does not reach from before to after the time, or has a gap of
        more than a fifth of the time there. [unit of the series]

    Raises
    ------
    DataError
        If the time does not increase or a value is not finite.

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
        let_go(time, series)
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
