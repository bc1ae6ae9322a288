r"""Mean strength of groups of breaks; breaks in the termination apart, or as lower bounds.

References
----------
.. [1] CG-D-39-80, Tables 10, 20 and 21 (mean, deviation, relative variability, number).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_positive
from reduction.errors import DataError
from reduction.outcomes.censored import fit_censored
from reduction.outcomes.product import CensoredMean, GroupStatistics, reason_codes
from reduction.outcomes.profile import cutoff, profile_bounds
from reduction.record import Floats, Integers

VALUE, LOWER_BOUND, EXCLUDED = 0, 1, 2
"""What a value says of the line: itself, that it is at least this, nothing."""


def _sums(group: Integers, weights: Floats, n_groups: int) -> Floats:
    return np.bincount(group, weights=weights, minlength=n_groups).astype(np.float64)


def _extreme(group: Integers, value: Floats, n_groups: int, which: np.ufunc) -> Floats:
    result = np.full(n_groups, np.inf if which is np.minimum else -np.inf)
    which.at(result, group, value)
    return np.where(np.isfinite(result), result, np.nan)


def group_statistics(
    value: ArrayLike, group: ArrayLike, use: ArrayLike, *, n_groups: int
) -> GroupStatistics:
    """Mean, deviation and number of each group; breaks in the termination apart.

    Parameters
    ----------
    value : array_like, shape (n,)
        Outcomes of one quantity, in SI. [N, 1]
    group : array_like of int, shape (n,)
        Of which group, from 0. [1]
    use : array_like of int, shape (n,)
        `VALUE`, `LOWER_BOUND` (a break in the splice: the line holds at least this) or
        `EXCLUDED`. [1]
    n_groups : int
        Number of groups. [1]

    Returns
    -------
    statistics : GroupStatistics
        One entry a group; only values enter mean and deviation.

    Raises
    ------
    DataError
        If a value is not finite and above zero, or the series do not pair up.

    Notes
    -----
    The deviation has n - 1 below it.  A group of one has a mean and no deviation.  Relative
    variability is what [1]_ calls deviation over mean.

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
    if not values.shape == groups.shape == uses.shape or values.ndim != 1:
        raise DataError(
            "value, group and use do not pair up",
            found=f"shapes {values.shape}, {groups.shape}, {uses.shape}",
            needed="equal lengths",
        )
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


def censored_mean(
    value: ArrayLike, is_lower_bound: ArrayLike, *, confidence: float = 0.95
) -> CensoredMean:
    r"""Mean strength where a break in the splice counts as a lower bound.

    Parameters
    ----------
    value : array_like, shape (n,)
        Strengths. [N]
    is_lower_bound : array_like of bool, shape (n,)
        True where the termination broke and the line held at least this. [1]
    confidence : float
        Of the interval of the mean, two-sided. [1]

    Returns
    -------
    censored : CensoredMean
        NaN with a reason where the breaks in the line do not tell mean and deviation.

    Raises
    ------
    DataError
        If a value is not above zero, or the series do not pair up.

    Notes
    -----
    Maximum likelihood of a normal strength, the deviation times :math:`\sqrt{r/(r-1)}` with r
    breaks in the line: without lower bounds mean, deviation and interval are the usual
    ones.  It takes the strength of termination and line of one specimen as independent.

    Examples
    --------
    >>> line = censored_mean([6400.0, 6600.0, 6300.0, 6500.0], [False, False, False, True])
    >>> print(round(line.mean), round(line.standard_deviation))
    6475 166
    """
    values = as_positive("value", value)
    bound = np.asarray(is_lower_bound, dtype=np.bool_)
    if values.shape != bound.shape or values.ndim != 1:
        raise DataError(
            "values and bounds do not pair up", found=f"{values.shape} and {bound.shape}",
            needed="equal lengths",
        )  # fmt: skip
    n_own = int((~bound).sum())
    own = values[~bound]
    unknown = CensoredMean(confidence=confidence, n=n_own, n_lower_bound=int(bound.sum()))
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
        drop=cutoff(confidence, n_failed=n_own, n_coefficients=1),
    )
    return replace(
        unknown,
        mean=float(centre + estimate),
        standard_deviation=fit.scale * float(np.sqrt(n_own / (n_own - 1))),
        low=float(centre + low),
        high=float(centre + high),
    )
