"""Peak tension and dynamic modulus against the logarithm of cycle number.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
.. [2] A. N. Gent, "Relaxation processes in vulcanized rubber. I," J. Appl. Polym. Sci.
   6(22), 1962 (straight lines against the logarithm of time).
.. [3] J. von Neumann, R. H. Kent, H. R. Bellinson and B. I. Hart, "The mean square successive
   difference," Ann. Math. Stat. 12(2), 1941.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_positive
from reduction.cycles.product import Loops
from reduction.errors import DataError
from reduction.moduli.product import PeakTrend
from reduction.moduli.separable import lag_one_inflation
from reduction.record import Floats

FEWEST_CYCLES = 3


def slope_per_decade(values: ArrayLike, *, first_cycle: int = 1) -> tuple[Floats, Floats]:
    r"""Slope of per-cycle values against log10 of the cycle number.

    Parameters
    ----------
    values : array_like, shape (n_series, n_cycles)
        One value a cycle; NaN is left out. [any unit]
    first_cycle : int, optional
        Number of the first cycle. [1]

    Returns
    -------
    slope : ndarray, shape (n_series,)
        Change per tenfold cycle number; NaN where fewer than three cycles are known.
        [unit of the series]
    slope_standard_uncertainty : ndarray, shape (n_series,)
        From the scatter about the line, widened by the correlation of neighbouring cycles,
        so that curvature counts too (type A). [unit of the series]

    Raises
    ------
    DataError
        If the first cycle number is below 1.

    Notes
    -----
    Every cycle counts alike in the logarithm: a cycle is weighted by the inverse of its
    number, so that the last decade of a long test, which holds nine tenths of the cycles,
    does not decide alone.

    Examples
    --------
    >>> slope, _ = slope_per_decade([700 - 20 * np.log10(np.arange(1, 101))])
    >>> print(slope.round(6))
    [-20.]
    """
    if first_cycle < 1:
        raise DataError("cycles count from 1", found=str(first_cycle))
    series = np.atleast_2d(np.asarray(values, dtype=np.float64))
    number = np.arange(first_cycle, first_cycle + series.shape[1], dtype=np.float64)
    slope, uncertainty = np.full((2, series.shape[0]), np.nan)
    for row, one in enumerate(series):
        known = np.isfinite(one)
        if known.sum() < FEWEST_CYCLES:
            continue
        x, y = np.log10(number[known]), one[known]
        share = 1 / number[known]
        share /= share.sum()
        # sums, not dot products: those start threads of their own and depend on their number
        x = x - (share * x).sum()
        y = y - (share * y).sum()
        power = (share * x * x).sum()
        slope[row] = (share * x * y).sum() / power
        residual = y - slope[row] * x
        # Sandwich form: weights even out the decades, they do not claim different noise.
        freedom = y.size - 2
        variance = (residual**2).sum() / freedom * ((share * x) ** 2).sum() / power**2
        uncertainty[row] = np.sqrt(variance * lag_one_inflation(residual))
    return slope, uncertainty


def cycles_at_an_end(n_cycles: int) -> int:
    """Return how many cycles at each end of a test are compared: a tenth, from one to ten.

    Parameters
    ----------
    n_cycles : int
        Of the test. [1]

    Returns
    -------
    n_ends : int
        At each end. [1]

    Raises
    ------
    DataError
        Never by itself.

    Examples
    --------
    >>> [cycles_at_an_end(number) for number in (5, 30, 3000)]
    [1, 3, 10]
    """
    return min(max(n_cycles // 10, 1), 10)


def change_of_ends(values: ArrayLike) -> tuple[Floats, Floats]:
    r"""Mean of the last tenth of the cycles over that of the first, minus one.

    Parameters
    ----------
    values : array_like, shape (n_series, n_cycles)
        One value a cycle. [any unit]

    Returns
    -------
    change : ndarray, shape (n_series,)
        Of up to a tenth of the cycles at each end, at least one and at most ten; NaN where one
        of them is missing. [1]
    change_standard_uncertainty : ndarray, shape (n_series,)
        From the scatter of neighbouring cycles (type A); NaN where fewer than two pairs of
        neighbours are known. [1]

    Raises
    ------
    ValueError
        If the values are not numbers in rows of one length.

    Notes
    -----
    .. math:: s^2 = \overline{(y_{i+1} - y_i)^2} / 2

    is the variance of a cycle that a slow trend does not enter [3]_; a fast one at the start of a
    test does, and the uncertainty is then too large rather than too small.

    Examples
    --------
    Ten cycles that lose 5 %, and whose neighbours differ by 1 N:

    >>> change, uncertainty = change_of_ends([[100, 98, 97, 96, 96, 95, 96, 95, 96, 95]])
    >>> print(change.round(3), uncertainty.round(3))
    [-0.05] [0.011]
    """
    series = np.atleast_2d(np.asarray(values, dtype=np.float64))
    n_ends = cycles_at_an_end(series.shape[1])
    steps = np.diff(series, axis=1)
    pairs = np.isfinite(steps).sum(axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        first, last = series[:, :n_ends].mean(axis=1), series[:, -n_ends:].mean(axis=1)
        variance = np.nansum(steps**2, axis=1) / np.where(pairs < FEWEST_CYCLES - 1, np.nan, pairs)
        scatter = np.sqrt(variance / 2 / n_ends)
        return last / first - 1, scatter / np.abs(first) * np.hypot(1.0, last / first)


def fit_peak_trend(loops: Loops, *, area: ArrayLike, break_in_cycles: int = 0) -> PeakTrend:
    """Decay of the peak and change of the dynamic modulus over the cycles of a test.

    Parameters
    ----------
    loops : Loops
        Table of loops.
    area : array_like, shape (n_specimens,)
        Cross-section at zero tension; NaN where no diameter is known. [m2]
    break_in_cycles : int, optional
        Cycles left out of the slopes at the start. [1]

    Returns
    -------
    trend : PeakTrend
        Slopes per decade of cycles with standard uncertainties (type A), and peak of the
        last cycle over the first, minus one. [N], [Pa], [1]

    Raises
    ------
    DataError
        If an area is not positive, or their number does not fit the loops.

    Notes
    -----
    Source: [1]_, sec. 4.1 ("the maximum peak can be seen to still decreasing with time");
    the straight line in the logarithm is [2]_.  The dynamic modulus is the apparent spring
    constant over the area.  The change from first to last cycle is that of `change_of_ends`,
    and counts from the first cycle whatever the break-in.

    Examples
    --------
    >>> peak = 700 - 20 * np.log10(np.arange(1.0, 11.0))[None]
    >>> loops = Loops(*[peak] * 14, uncertainty={})
    >>> trend = fit_peak_trend(loops, area=[5e-4])
    >>> print(trend.peak_tension_per_decade.round(3), trend.peak_tension_change.round(4))
    [-20.] [-0.0286]
    """
    peaks = np.atleast_2d(loops.peak_tension)
    areas = np.atleast_1d(np.asarray(area, dtype=np.float64))
    if areas.shape != peaks.shape[:1]:
        raise DataError(
            "areas do not fit the loops", found=f"{areas.size} areas", needed=f"{peaks.shape[0]}"
        )
    as_positive("area", areas[np.isfinite(areas)])
    start = min(break_in_cycles, max(0, peaks.shape[1] - FEWEST_CYCLES))
    peak_slope, peak_uncertainty = slope_per_decade(peaks[:, start:], first_cycle=start + 1)
    modulus = np.atleast_2d(loops.apparent_spring_constant) / areas[:, None]
    modulus_slope, modulus_uncertainty = slope_per_decade(modulus[:, start:], first_cycle=start + 1)
    change, change_uncertainty = change_of_ends(peaks)
    return PeakTrend(
        peak_tension_per_decade=peak_slope,
        peak_tension_per_decade_standard_uncertainty=peak_uncertainty,
        dynamic_modulus_per_decade=modulus_slope,
        dynamic_modulus_per_decade_standard_uncertainty=modulus_uncertainty,
        peak_tension_change=change,
        peak_tension_change_standard_uncertainty=change_uncertainty,
    )
