"""Strength of groups of breaks, against exposure, and after snap loading.

References
----------
.. [1] CG-D-39-80, Tables 10 and 21 (changes after exposure), Tables A-3 and A-4 (one-way F).
.. [2] E. C. Fieller, "Some Problems in Interval Estimation," J. R. Stat. Soc. B, vol. 16, no.
   2, pp. 175-185, 1954.
.. [3] CG-D-39-80, section 4.4.4 and Figure 15 (polyester double braid, 0 to 5 years), section
   6.3.2 (one break after two years), Tables 10 and 21.
.. [4] CG-D-39-80, Tables 10, 20 and 21 (mean, deviation, relative variability, number).
.. [5] CG-D-39-80, section 5 and Figure 19: nylon plaited 1/2 inch fails in fatigue where the
   peak load exceeds about 30 % of the rated break strength (between 27 and 35 %), and not by
   200,000 cycles below; with 3 % kept in the line, not even at 62 %.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import fdtrc, fdtri, stdtrit

from reduction.experiments.life_statistics import cutoff, fit_censored, load_levels, profile_bounds
from reduction.experiments.outcomes import (
    CensoredMean,
    ExposureTrend,
    GroupStatistics,
    OneWay,
    RatioOfMeans,
    SnapLevels,
    reason_codes,
)
from reduction.record.arrays import as_finite, as_positive
from reduction.record.contributions import CONFIDENCE
from reduction.record.errors import DataError, FitError
from reduction.record.measurement import Bools, Floats, Integers


def ratio_of_means(
    mean: ArrayLike,
    standard_deviation: ArrayLike,
    n: ArrayLike,
    *,
    reference_mean: ArrayLike,
    reference_standard_deviation: ArrayLike,
    reference_n: ArrayLike,
) -> RatioOfMeans:
    r"""Change of a mean against a reference mean, with its interval.

    .. math:: (m_1 - \rho\,m_0)^2 \le t^2_\nu\,(s_1^2/n_1 + \rho^2 s_0^2/n_0)

    Parameters
    ----------
    mean, standard_deviation : array_like
        Of the groups, in one unit; the deviation NaN where not known. [N, 1]
    n : array_like of int
        Number of values of each group. [1]
    reference_mean, reference_standard_deviation : array_like
        Of the reference, in the same unit. [N, 1]
    reference_n : array_like of int
        Number of values of the reference. [1]

    Returns
    -------
    ratio : RatioOfMeans
        With the broadcast shape of the arguments.

    Raises
    ------
    DataError
        If a mean or a number of values is not above zero.

    Notes
    -----
    Fieller's interval [2]_, with a separate deviation for each group and Welch's degrees of
    freedom at the estimated ratio.  The delta method is not used, since the reference mean is
    itself from a few breaks and the interval of a quotient is not symmetric; nor is a common
    deviation, since a worn line of half the strength does not scatter as a new one
    (Table 21 of [1]_: 473 and 321 lb, .014 and .045).  With only one value in a group
    its scatter is not known and there is no interval.  For generated groups an interval of
    95 % held the true change in 94 % with four breaks against sixteen, in 88 % with two: no
    interval from two breaks can be trusted.

    Examples
    --------
    Table 21 of [1]_ prints -32 and +54 %:

    >>> change = ratio_of_means([4365, 0.20], [321, 0.045], [4, 4], reference_mean=[6400, 0.13],
    ...     reference_standard_deviation=[473, 0.014], reference_n=[16, 16])
    >>> print((100 * change.change).round(1))
    [-31.8  53.8]
    """
    means, reference = as_positive("mean", mean), as_positive("reference_mean", reference_mean)
    as_positive("n", n), as_positive("reference_n", reference_n)
    m1, s1, n1, m0, s0, n0 = np.broadcast_arrays(
        means,
        np.asarray(standard_deviation, dtype=np.float64),
        np.asarray(n, dtype=np.float64),
        reference,
        np.asarray(reference_standard_deviation, dtype=np.float64),
        np.asarray(reference_n, dtype=np.float64),
    )
    has_both = (n1 > 1) & (n0 > 1) & (s1 >= 0) & (s0 >= 0)
    ratio = m1 / m0
    with np.errstate(invalid="ignore", divide="ignore"):
        v1 = np.where(has_both, s1**2 / n1, np.nan)
        v0 = np.where(has_both, s0**2 / n0, np.nan)
        variance = v1 + ratio**2 * v0
        freedom = variance**2 / (v1**2 / (n1 - 1) + ratio**4 * v0**2 / (n0 - 1))
        t = stdtrit(freedom, (1 + CONFIDENCE) / 2)
        # roots of the quadratic in rho; the leading term is positive for a closed interval
        lead = m0**2 - t**2 * v0
        root = t * np.sqrt(v0 * m1**2 + v1 * m0**2 - t**2 * v0 * v1)
        lead = np.where(lead > 0, lead, np.nan)
        low, high = (m0 * m1 - root) / lead - 1, (m0 * m1 + root) / lead - 1
    return RatioOfMeans(
        ratio=ratio,
        change=ratio - 1,
        low=low,
        high=high,
        standard_uncertainty=np.sqrt(variance) / m0,
        degrees_of_freedom=freedom,
        reason=reason_codes(
            ratio.shape,
            [
                (~has_both, 2),
                (has_both & (variance == 0), 4),
                (has_both & (variance > 0) & np.isnan(lead), 3),
            ],
        ),
    )


def one_way(mean: ArrayLike, standard_deviation: ArrayLike, n: ArrayLike) -> OneWay:
    r"""One-way F of groups from their means, deviations and numbers.

    .. math:: F = \frac{\sum n_i (m_i - m)^2 / (k - 1)}{\sum (n_i - 1) s_i^2 / (N - k)}

    Parameters
    ----------
    mean, standard_deviation : array_like, shape (..., n_groups)
        In one unit; the deviation of a group of one is not used. [N, 1]
    n : array_like of int, shape (..., n_groups)
        Number of values of each group. [1]

    Returns
    -------
    analysis : OneWay
        With the shape of the arguments without the last axis.

    Raises
    ------
    DataError
        If there are fewer than two groups, or a deviation of several values is missing.

    Notes
    -----
    F assumes one deviation for all groups.  Table A-4 of [1]_ compares deviations of 2.0 and 6.8
    %.

    Examples
    --------
    Table A-3 of [1]_, 1/2 inch, wet, before and after cycling, prints F = 29.24 and
    F(.05, 1, 13) = 4.67:

    >>> analysis = one_way([6920.0, 7640.0], [320.0, 180.0], [9, 6])
    >>> print(analysis.f_statistic.round(1), analysis.critical.round(2), analysis.within)
    24.7 4.67 13
    """
    m, s, size = np.broadcast_arrays(
        as_finite("mean", mean), np.asarray(standard_deviation, dtype=np.float64),
        as_positive("n", n),
    )  # fmt: skip
    k = m.shape[-1] if m.ndim else 0
    if k < 2:
        raise DataError("one group has nothing to be compared with", needed="two groups or more")
    several = size > 1
    if not np.all((s >= 0) | ~several):
        raise DataError(
            "a group of several values has no deviation", needed="deviations of 0 or more",
            hint="Leave the group out, or give its values.",
        )  # fmt: skip
    s = np.where(several, s, 0.0)
    total = size.sum(-1)
    within = (total - k).astype(np.intp)
    grand = (size * m).sum(-1) / total
    between_square = (size * (m - grand[..., None]) ** 2).sum(-1) / (k - 1)
    with np.errstate(invalid="ignore", divide="ignore"):
        pooled = ((size - 1) * s**2).sum(-1) / within
        statistic = np.where(pooled > 0, between_square / pooled, np.nan)
    return OneWay(
        f_statistic=statistic,
        between=np.full(within.shape, k - 1, dtype=np.intp),
        within=within,
        p_value=np.asarray(fdtrc(k - 1, within, statistic), dtype=np.float64),
        critical=np.asarray(fdtri(k - 1, within, CONFIDENCE), dtype=np.float64),
        reason=reason_codes(within.shape, [(~(pooled > 0), 4)]),
    )


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
        Time in the field, 0 for a new line; groups of equal exposure are joined. [year]
    mean : array_like, shape (n_groups,)
        Mean strength of a group, or single breaks. [N]
    standard_deviation : array_like, shape (n_groups,), optional
        NaN where not known; not needed for single breaks. [N]
    n : array_like of int, shape (n_groups,), optional
        Number of breaks of a group; 1 where not given. [1]

    Returns
    -------
    trend : ExposureTrend
        With lack of fit compared with the scatter of breaks of equal exposure.

    Raises
    ------
    DataError
        If a number is impossible.
    FitError
        If there are fewer than two exposures, or no information on the scatter.

    Notes
    -----
    Groups given by mean, deviation and number give the line of their single breaks.
    A group of several breaks without a deviation counts for the line, but not for the
    scatter.  One deviation is assumed for all exposures.

    Examples
    --------
    Figure 15 of [3]_, from Tables 10 and 21 and section 6.3.2 (n of the third is not printed;
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
    # from (value at the centre, slope) to the value at zero exposure
    shift = np.array([[1.0, -centre], [0.0, 1.0]])
    covariance = shift @ np.diag([variance / breaks.sum(), variance / spread]) @ shift.T
    return ExposureTrend(
        intercept=middle - slope * centre,
        slope=slope,
        covariance=covariance,
        residual_standard_deviation=float(np.sqrt(variance)),
        degrees_of_freedom=free,
        lack_of_fit_p_value=float(fdtrc(lack, pure, (lack_square / lack) / (pure_square / pure)))
        if fits
        else float("nan"),
        exposure_low=float(levels[0]),
        exposure_high=float(levels[-1]),
        n=int(breaks.sum()),
    )


def strength_after(
    trend: ExposureTrend,
    exposure: ArrayLike,
) -> tuple[Floats, Floats, Floats, Bools]:
    """Strength on the line with its interval.

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
    )
    half = stdtrit(trend.degrees_of_freedom, (1 + CONFIDENCE) / 2) * np.sqrt(variance)
    is_inside = (years >= trend.exposure_low) & (years <= trend.exposure_high)
    return strength, strength - half, strength + half, np.asarray(is_inside)


def share_lost_per_year(trend: ExposureTrend) -> tuple[float, float, float]:
    """Fraction of the new strength that the line loses in a year, with Fieller's interval.

    Examples
    --------
    >>> trend = fit_exposure_trend([0, 2, 3, 5], [6400, 4672, 4365, 3241],
    ...                           [473, np.nan, 321, np.nan], [16, 1, 4, 2])
    >>> print(round(share_lost_per_year(trend)[0], 3))
    0.103
    """
    if trend.intercept <= 0:
        raise FitError("the line has no strength when new", found=f"{trend.intercept:g}")
    t = float(stdtrit(trend.degrees_of_freedom, (1 + CONFIDENCE) / 2))
    (v_new, v_both), (_, v_slope) = trend.covariance
    lead = trend.intercept**2 - t**2 * v_new
    middle = -(trend.slope * trend.intercept - t**2 * v_both)
    last = trend.slope**2 - t**2 * v_slope
    share = -trend.slope / trend.intercept
    if lead <= 0:
        return share, float("nan"), float("nan")
    half = float(np.sqrt(middle**2 - lead * last))
    return share, float((middle - half) / lead), float((middle + half) / lead)


VALUE, LOWER_BOUND, EXCLUDED = 0, 1, 2
"""Use of a value: as the strength of the line, as a lower bound of it, or not."""


def _sums(group: Integers, weights: Floats, n_groups: int) -> Floats:
    return np.bincount(group, weights=weights, minlength=n_groups).astype(np.float64)


def _extreme(group: Integers, value: Floats, n_groups: int, which: np.ufunc) -> Floats:
    result = np.full(n_groups, np.inf if which is np.minimum else -np.inf)
    which.at(result, group, value)
    return np.where(np.isfinite(result), result, np.nan)


def group_statistics(
    value: ArrayLike, group: ArrayLike, use: ArrayLike, *, n_groups: int
) -> GroupStatistics:
    """Mean, deviation and number of each group; breaks in the termination separately.

    Notes
    -----
    The deviation is divided by n - 1.  A group of one has a mean and no deviation.  Relative
    variability in [4]_ is deviation over mean.

    Examples
    --------
    Two breaks in the line, and one in its splice:

    >>> statistics = group_statistics([6400.0, 6600.0, 5000.0], [0, 0, 0], [0, 0, 1], n_groups=1)
    >>> print(statistics.n, statistics.mean, statistics.standard_deviation.round(1))
    [2] [6500.] [141.4]
    >>> print(statistics.n_lower_bound, statistics.lower_bound_mean)
    [1] [5000.]
    """
    values = as_positive("value", value)
    groups, uses = np.asarray(group, dtype=np.intp), np.asarray(use, dtype=np.intp)
    if groups.size and not (0 <= groups.min() and groups.max() < n_groups):
        raise DataError(
            "a group has no place", found=f"{groups.min()} to {groups.max()}",
            needed=f"0 to {n_groups - 1}",
        )  # fmt: skip
    own, bound = uses == VALUE, uses == LOWER_BOUND
    n = np.bincount(groups[own], minlength=n_groups)
    n_bound = np.bincount(groups[bound], minlength=n_groups)
    with np.errstate(invalid="ignore", divide="ignore"):
        mean = _sums(groups[own], values[own], n_groups) / n
        about = (values[own] - mean[groups[own]]) ** 2
        deviation = np.sqrt(_sums(groups[own], about, n_groups) / np.where(n > 1, n - 1, np.nan))
        bound_mean = _sums(groups[bound], values[bound], n_groups) / n_bound
        return GroupStatistics(
            n=n,
            n_lower_bound=n_bound,
            n_excluded=np.bincount(groups[uses == EXCLUDED], minlength=n_groups),
            mean=mean,
            standard_deviation=deviation,
            minimum=_extreme(groups[own], values[own], n_groups, np.minimum),
            maximum=_extreme(groups[own], values[own], n_groups, np.maximum),
            relative_variability=deviation / mean,
            mean_standard_uncertainty=deviation / np.sqrt(n),
            lower_bound_mean=bound_mean,
            reason=reason_codes(n.shape, [(n < 2, 1)]),
        )


def censored_mean(value: ArrayLike, is_lower_bound: ArrayLike) -> CensoredMean:
    r"""Mean strength where a break in the splice counts as a lower bound.

    Notes
    -----
    Maximum likelihood of a normal strength, with the deviation times :math:`\sqrt{r/(r-1)}` for r
    breaks in the line: without lower bounds mean, deviation and interval are the usual
    ones.  The strengths of termination and line of one specimen are assumed independent.

    Examples
    --------
    >>> line = censored_mean([6400.0, 6600.0, 6300.0, 6500.0], [False, False, False, True])
    >>> print(round(line.mean), round(line.standard_deviation))
    6475 166
    """
    values = as_positive("value", value)
    bound = np.asarray(is_lower_bound, dtype=np.bool_)
    n_own = int((~bound).sum())
    own = values[~bound]
    unknown = CensoredMean(n=n_own, n_lower_bound=int(bound.sum()))
    if n_own < 2 or not np.ptp(own) > 0:
        return replace(unknown, reason=4 if n_own > 1 else 1)
    centre, ones = own.mean(), np.ones((values.size, 1))
    about = values - centre
    fit = fit_censored(about, ones, bound, scatter="normal")
    estimate = float(fit.coefficient[0])
    low, high = profile_bounds(
        lambda mean: (
            fit_censored(about - mean, ones[:, :0], bound, scatter="normal").log_likelihood
        ),
        estimate=estimate,
        maximum=fit.log_likelihood,
        step=float(np.sqrt(fit.covariance[0, 0])),
        drop=cutoff(n_failed=n_own, n_coefficients=1),
    )
    return replace(
        unknown,
        mean=float(centre + estimate),
        standard_deviation=fit.scale * float(np.sqrt(n_own / (n_own - 1))),
        low=float(centre + low),
        high=float(centre + high),
    )


def _threshold(
    load: Floats, failed: Integers, suspended: Integers
) -> tuple[float, float, tuple[str, ...]]:
    """Highest level with no failure at or below it, lowest with one, and contradictions."""
    has_failed = failed > 0
    high = float(load[has_failed][0]) if has_failed.any() else float("nan")
    below = ~has_failed & ~(load > high)
    low = float(load[below][-1]) if below.any() else float("nan")
    survived = (suspended > 0) & (load > high)
    if not survived.any():
        return low, high, ()
    note = (
        f"a line failed at {100 * high:.3g} % of its break strength, and one survived "
        f"{100 * load[survived][-1]:.3g} %: the threshold is no sharp load"
    )
    return low, high, (note,)


def summarise_snap_loading(
    peak_load_ratio: ArrayLike,
    minimum_load_ratio: ArrayLike,
    cycles: ArrayLike,
    is_suspended: ArrayLike,
) -> SnapLevels:
    """Effect of each level of peak load on lines that go slack, and onset of failures.

    Notes
    -----
    If m lines all survived, the fraction p that would have failed by then is bounded
    by :math:`(1 - p)^m = 1 - c` [-].  The three samples a level of [5]_ bound it by 63 % (95 %):
    its 30 % of break strength is where failures ceased to be seen, not a safe load.

    Examples
    --------
    >>> levels = summarise_snap_loading([0.35, 0.35, 0.35, 0.27, 0.27, 0.27], [0.0] * 6,
    ...     [90e3, 120e3, 150e3, 200e3, 200e3, 200e3], [False] * 3 + [True] * 3)
    >>> print(levels.threshold_low, round(levels.threshold_high, 2),
    ...     levels.failed_share_high[0].round(2))
    0.27 0.35 0.63
    """
    load, lives = as_positive("peak_load_ratio", peak_load_ratio), as_positive("cycles", cycles)
    least = np.asarray(minimum_load_ratio, dtype=np.float64)
    stopped: Bools = np.asarray(is_suspended, dtype=np.bool_)
    slack = least <= 0.0
    if not slack.any():
        raise DataError(
            "no test has a line that goes slack",
            found=f"least minimum load {100 * np.nanmin(least, initial=np.inf):.3g} %",
            needed="a minimum load of 0 % or less",
            hint="Use fit_load_life for lines that keep a tension.",
        )
    not_stated = int(np.isnan(least).sum())
    notes = (f"{not_stated} tests without a minimum load are left out",) if not_stated else ()
    load, lives, stopped = load[slack], lives[slack], stopped[slack]
    level = load_levels(load)
    n_levels = int(level.max()) + 1
    failed = np.bincount(level[~stopped], minlength=n_levels)
    suspended = np.bincount(level[stopped], minlength=n_levels)
    shortest, longest = np.full(n_levels, np.inf), np.zeros(n_levels)
    np.minimum.at(shortest, level, lives)
    np.maximum.at(longest, level, lives)
    mean_load = np.bincount(level, weights=load) / np.bincount(level)
    with np.errstate(invalid="ignore", divide="ignore"):
        mean_cycles = np.bincount(level[~stopped], lives[~stopped], n_levels) / failed
        share = 1 - (1 - CONFIDENCE) ** (1 / suspended)
    low, high, contradiction = _threshold(mean_load, failed, suspended)
    return SnapLevels(
        peak_load_ratio=mean_load,
        n_failed=failed,
        n_suspended=suspended,
        mean_cycles=mean_cycles,
        least_cycles=shortest,
        most_cycles=longest,
        failed_share_high=np.where(failed == 0, share, np.nan),
        threshold_low=low,
        threshold_high=high,
        notes=notes + contradiction,
    )
