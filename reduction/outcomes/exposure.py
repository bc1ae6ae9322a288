r"""Strength against years in the field as a straight line.

References
----------
.. [1] CG-D-39-80, section 4.4.4 and Figure 15 (polyester double braid, 0 to 5 years),
   section 6.3.2 (one break after two years), Tables 10 and 21.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import fdtrc, stdtrit

from reduction.checks import as_finite, as_positive
from reduction.errors import DataError, FitError
from reduction.outcomes.product import ExposureTrend
from reduction.record import Bools, Floats


def fit_exposure_trend(
    exposure: ArrayLike,
    mean: ArrayLike,
    standard_deviation: ArrayLike | None = None,
    n: ArrayLike | None = None,
) -> ExposureTrend:
    """Straight line of strength against exposure, by least squares over the breaks.

    Parameters
    ----------
    exposure : array_like, shape (n_groups,)
        Time in the field, 0 for a new line; groups of one exposure are joined. [year]
    mean : array_like, shape (n_groups,)
        Mean strength of a group, or single breaks. [N]
    standard_deviation : array_like, shape (n_groups,), optional
        NaN where not known; not needed for single breaks. [N]
    n : array_like of int, shape (n_groups,), optional
        Breaks of a group; 1 where not given. [1]

    Returns
    -------
    trend : ExposureTrend
        With lack of fit against the scatter of breaks of one exposure.

    Raises
    ------
    DataError
        If the series do not pair up or a number cannot be.
    FitError
        If there are fewer than two exposures, or nothing is left to tell the scatter.

    Notes
    -----
    Groups given by mean, deviation and number give the line of their single breaks.
    A group of several breaks without a deviation counts for the line, and not for the
    scatter.  One deviation is taken for all exposures.

    Examples
    --------
    Figure 15 of [1]_, from Tables 10 and 21 and section 6.3.2 (n of the third is not printed;
    4 samples a line are stated), in lb and lb a year:

    >>> trend = fit_exposure_trend([0, 2, 3, 5], [6400, 4672, 4365, 3241],
    ...                           [473, np.nan, 321, np.nan], [16, 1, 4, 2])
    >>> print(round(trend.intercept), round(trend.slope), trend.degrees_of_freedom)
    6380 -655 20
    """
    years = as_finite("exposure", exposure)
    means = as_positive("mean", mean)
    size = np.ones(years.shape) if n is None else as_positive("n", n)
    deviation = (
        np.full(years.shape, np.nan)
        if standard_deviation is None
        else np.asarray(standard_deviation, dtype=np.float64)
    )
    if not years.shape == means.shape == size.shape == deviation.shape or years.ndim != 1:
        raise DataError(
            "exposures, means, deviations and numbers do not pair up",
            found=f"shapes {years.shape}, {means.shape}, {deviation.shape}, {size.shape}",
            needed="equal lengths",
        )
    if (years < 0).any():
        raise DataError("an exposure is below zero", found=f"{years.min():g}", needed="0 or more")
    levels, place = np.unique(years, return_inverse=True)
    if levels.size < 2:
        raise FitError("a line needs two exposures", found=f"{levels.size}", needed="2 or more")
    breaks = np.bincount(place, weights=size)
    level_mean = np.bincount(place, weights=size * means) / breaks
    is_known = (size > 1) & (deviation >= 0)
    # breaks of one exposure: within each group as given, and groups about their mean
    pure_square = float(
        np.sum(np.where(is_known, (size - 1) * deviation**2, 0.0))
        + np.sum(size * (means - level_mean[place]) ** 2)
    )
    pure = int(np.sum(np.where(is_known, size - 1, 0)) + years.size - levels.size)
    lack = levels.size - 2
    centre = float((breaks * levels).sum() / breaks.sum())
    about = levels - centre
    spread = float((breaks * about**2).sum())
    slope = float((breaks * about * level_mean).sum() / spread)
    middle = float((breaks * level_mean).sum() / breaks.sum())
    lack_square = float((breaks * (level_mean - middle - slope * about) ** 2).sum())
    free = pure + lack
    if free < 1:
        raise FitError(
            "two exposures with one break each leave no scatter", needed="three breaks or more"
        )
    variance = (pure_square + lack_square) / free
    fits = lack > 0 and pure > 0 and pure_square > 0
    ratio = (lack_square / lack) / (pure_square / pure) if fits else float("nan")
    # of (value at the centre, slope), carried to the value at no exposure
    shift = np.array([[1.0, -centre], [0.0, 1.0]])
    covariance = shift @ np.diag([variance / breaks.sum(), variance / spread]) @ shift.T
    return ExposureTrend(
        intercept=middle - slope * centre,
        slope=slope,
        covariance=covariance,
        residual_standard_deviation=float(np.sqrt(variance)),
        degrees_of_freedom=free,
        lack_of_fit_f=ratio,
        lack_of_fit_p_value=float(fdtrc(lack, pure, ratio)) if fits else float("nan"),
        lack_of_fit_degrees_of_freedom=(lack, pure),
        exposure_low=float(levels[0]),
        exposure_high=float(levels[-1]),
        n=int(breaks.sum()),
    )


def strength_after(
    trend: ExposureTrend,
    exposure: ArrayLike,
    *,
    confidence: float = 0.95,
    of_one_break: bool = False,
) -> tuple[Floats, Floats, Floats, Bools]:
    """Strength on the line with its interval.

    Parameters
    ----------
    trend : ExposureTrend
        As fitted.
    exposure : array_like
        Time in the field. [year]
    confidence : float
        Of the interval, two-sided. [1]
    of_one_break : bool
        True for the interval of one further break, False for that of the mean.

    Returns
    -------
    strength, low, high : ndarray
        The shape of ``exposure``. [N]
    is_inside : ndarray of bool
        False outside the exposures tested. [1]

    Raises
    ------
    DataError
        If an exposure is not finite.

    Examples
    --------
    >>> trend = fit_exposure_trend([0, 2, 3, 5], [6400, 4672, 4365, 3241],
    ...                           [473, np.nan, 321, np.nan], [16, 1, 4, 2])
    >>> strength, low, high, is_inside = strength_after(trend, [4.0, 8.0])
    >>> print(strength.round(), is_inside)
    [3758. 1137.] [ True False]
    """
    years = as_finite("exposure", exposure)
    strength = trend.intercept + trend.slope * years
    variance = (
        trend.covariance[0, 0]
        + 2 * years * trend.covariance[0, 1]
        + years**2 * trend.covariance[1, 1]
        + (trend.residual_standard_deviation**2 if of_one_break else 0.0)
    )
    half = stdtrit(trend.degrees_of_freedom, (1 + confidence) / 2) * np.sqrt(variance)
    is_inside = (years >= trend.exposure_low) & (years <= trend.exposure_high)
    return strength, strength - half, strength + half, np.asarray(is_inside)


def share_lost_per_year(
    trend: ExposureTrend, *, confidence: float = 0.95
) -> tuple[float, float, float]:
    r"""Share of the new strength that the line loses in a year, with Fieller's interval.

    Parameters
    ----------
    trend : ExposureTrend
        As fitted.
    confidence : float
        Of the interval, two-sided. [1]

    Returns
    -------
    share, low, high : float
        :math:`-\text{slope}/\text{intercept}`; the ends NaN where the new strength is not told
        apart from zero. [year-1]

    Raises
    ------
    FitError
        If the line has no strength at no exposure.

    Examples
    --------
    >>> trend = fit_exposure_trend([0, 2, 3, 5], [6400, 4672, 4365, 3241],
    ...                           [473, np.nan, 321, np.nan], [16, 1, 4, 2])
    >>> print(round(share_lost_per_year(trend)[0], 3))
    0.103
    """
    if trend.intercept <= 0:
        raise FitError("the line has no strength when new", found=f"{trend.intercept:g}")
    t = float(stdtrit(trend.degrees_of_freedom, (1 + confidence) / 2))
    (v_new, v_both), (_, v_slope) = trend.covariance
    lead = trend.intercept**2 - t**2 * v_new
    middle = -(trend.slope * trend.intercept - t**2 * v_both)
    last = trend.slope**2 - t**2 * v_slope
    share = -trend.slope / trend.intercept
    if lead <= 0:
        return share, float("nan"), float("nan")
    half = float(np.sqrt(middle**2 - lead * last))
    return share, float((middle - half) / lead), float((middle + half) / lead)
