r"""Cycles to failure: life, fatigue and abrasion, with run-outs as lower bounds.

**Maximum likelihood of a linear law with scatter, where some values are lower bounds**:

.. math:: y = X b + \sigma\,\varepsilon

with normal or smallest-extreme-value scatter; a lognormal or Weibull life has y = ln N.
In :math:`\theta = 1/\sigma` and :math:`\gamma = b/\sigma` the log likelihood is concave, so that
Newton steps reach its only maximum from any start.  A quantile that is held fixed is a linear
condition, so that its profile is a problem of the same form.

**Cycles to wear through: relative life of a jacket, a material or a construction.** Mean,
deviation and relative variability of a group, and ratios of the means of two, are those of
`reduction.experiments.strength_statistics`.

References
----------
.. [5] CG-D-39-80, section 5 (snap loading), section 6.2.2 (abrasion).
.. [6] NIST/SEMATECH e-Handbook of Statistical Methods, section 8.4.1.3.
.. [7] CG-D-39-80, section 5 and Figure 19 (snap loading).
.. [9] CG-D-39-80, section 6.2.2 and Table 20.
.. [10] G. Y. Zou and A. Donner, "Construction of Confidence Limits about Effect Measures: A
   General Approach," Stat. Med., vol. 27, no. 10, pp. 1693-1702, 2008.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import exp, inf, log, log1p, pi, sqrt
from typing import Literal

import numpy as np
import scipy
from numpy.typing import ArrayLike
from scipy.special import chdtrc, log_ndtr, ndtri, stdtrit

from reduction.experiments.outcomes import LifeDistribution, LifeFit, LoadLife
from reduction.record.arrays import as_positive
from reduction.record.contributions import CONFIDENCE
from reduction.record.errors import DataError, FitError
from reduction.record.measurement import Bools, Floats, Integers

_MOST_DOUBLINGS = 60


def cutoff(*, n_failed: int, n_coefficients: int) -> float:
    r"""Drop of twice the log likelihood at the ends of an interval.

    Notes
    -----
    .. math:: d = r \ln\bigl(1 + t^2_{r - p}/(r - p)\bigr)

    With normal scatter and no lower bound this makes the profile interval the exact one
    of Student; with many failures it is the usual chi square.  Chi square alone is too
    small for the three to five specimens of a load level.

    Examples
    --------
    Three failures, then many (chi square: 3.841):

    >>> print(round(cutoff(n_failed=3, n_coefficients=1), 2))
    6.98
    >>> print(round(cutoff(n_failed=100_000, n_coefficients=1), 3))
    3.842
    """
    free = n_failed - n_coefficients
    if free < 1:
        return float("nan")
    quantile = float(stdtrit(free, (1 + CONFIDENCE) / 2))
    return n_failed * log1p(quantile**2 / free)


def profile_bounds(
    log_likelihood: Callable[[float], float],
    *,
    estimate: float,
    maximum: float,
    step: float,
    drop: float,
) -> tuple[float, float]:
    """Values on both sides where twice the profile log likelihood has dropped by ``drop``.

    Examples
    --------
    >>> print(profile_bounds(lambda value: -value**2 / 2, estimate=0.0, maximum=0.0, step=1.0,
    ...                      drop=4.0))
    (-2.0, 2.0)
    """
    if drop != drop:
        return float("nan"), float("nan")

    def excess(value: float) -> float:
        return 2 * (maximum - log_likelihood(value)) - drop

    def side(sign: int) -> float:
        near, width = estimate, step
        for _ in range(_MOST_DOUBLINGS):
            far = estimate + sign * width
            if excess(far) >= 0:
                return float(
                    scipy.optimize.brentq(excess, near, far, xtol=1e-12 * step, rtol=1e-12)
                )
            near, width = far, 2 * width
        return sign * inf

    return side(-1), side(1)


Scatter = Literal["normal", "smallest_extreme_value"]

_MOST_STEPS = 200

_DECREMENT = 1e-18  # of the log likelihood: below this a Newton step changes nothing

_LEAST_SCATTER = 1e-12  # over the greatest value

_HALF_LOG_2_PI = log(2 * pi) / 2


@dataclass(frozen=True)
class _CensoredFit:
    """A maximum: coefficients b, scatter, and the covariance of (b, scatter)."""

    coefficient: Floats
    scale: float
    covariance: Floats
    log_likelihood: float


def _scatter_quantile(share: float, *, scatter: Scatter) -> float:
    """Standard scatter below which a given fraction of the specimens lies.

    Examples
    --------
    >>> print(round(_scatter_quantile(0.5, scatter="smallest_extreme_value"), 4))
    -0.3665
    """
    if not 0 < share < 1:
        raise DataError("a share is not between 0 and 1", found=f"{share:g}", needed="0 to 1")
    return float(ndtri(share)) if scatter == "normal" else log(-log1p(-share))


def _terms(deviate: Floats, is_bound: Bools, scatter: Scatter) -> tuple[Floats, Floats, Floats]:
    """Log likelihood of each standard deviate, its slope and its curvature."""
    if scatter == "normal":
        log_survival = log_ndtr(-deviate)
        density = -(deviate**2) / 2 - _HALF_LOG_2_PI
        with np.errstate(over="ignore", invalid="ignore"):
            # far below the mean the hazard is 0, and so is its difference from the density
            hazard = np.exp(np.where(is_bound, density - log_survival, -inf))
        value = np.where(is_bound, log_survival, density)
        slope = np.where(is_bound, -hazard, -deviate)
        return value, slope, np.where(is_bound, -hazard * (hazard - deviate), -1.0)
    with np.errstate(over="ignore"):
        power = np.exp(deviate)
    return np.where(is_bound, -power, deviate - power), np.where(is_bound, 0.0, 1.0) - power, -power


def _check_maximum(response: Floats, design: Floats, is_bound: Bools) -> None:
    """Refuse data without a maximum: a coefficient or precision that may grow without bound."""
    failed, columns = response[~is_bound], design[~is_bound]
    # numpy before 2.4 gives no rank for a matrix without rows or columns
    rank = np.linalg.matrix_rank(columns) if columns.size else 0
    if rank < design.shape[1]:
        raise FitError(
            "the failures leave a coefficient open",
            found=f"{failed.size} failures for {design.shape[1]} coefficients",
            needed="failures at more levels",
        )
    coefficient = np.linalg.lstsq(columns, failed)[0]
    on_the_law = np.abs(failed - columns @ coefficient).max(initial=0.0) < _LEAST_SCATTER
    # a lower bound above the law is evidence of scatter nevertheless
    if on_the_law and not (response - design @ coefficient)[is_bound].max(initial=0.0) > 0:
        raise FitError(
            "the failures have no scatter about the law",
            found=f"{failed.size} failures",
            needed="more failures than coefficients, not all equal",
        )


def fit_censored(
    response: Floats,
    design: Floats,
    is_bound: Bools,
    *,
    scatter: Scatter,
    offset: float = 0.0,
) -> _CensoredFit:
    """Fit response = design b + scale x (scatter - offset).

    Examples
    --------
    Without lower bounds this is the mean and the root mean square about it:

    >>> fit = fit_censored(np.array([1.0, 2.0, 6.0]), np.ones((3, 1)), np.zeros(3, dtype=bool),
    ...                    scatter="normal")
    >>> print(fit.coefficient.round(6), round(fit.scale**2, 6))
    [3.] 4.666667
    """
    size = float(np.abs(response).max()) or 1.0
    _check_maximum(response / size, design, is_bound)
    matrix = np.column_stack([-design, response / size])
    n_failed = int((~is_bound).sum())
    last = design.shape[1]

    def evaluate(parameters: Floats) -> tuple[float, Floats, Floats]:
        if parameters[last] <= 0:
            return -inf, parameters, matrix
        value, slope, curvature = _terms(matrix @ parameters + offset, is_bound, scatter)
        total = float(value.sum()) + n_failed * log(parameters[last])
        if not np.isfinite(total):
            return -inf, parameters, matrix
        gradient = matrix.T @ slope
        hessian = (matrix * curvature[:, None]).T @ matrix
        gradient[last] += n_failed / parameters[last]
        hessian[last, last] -= n_failed / parameters[last] ** 2
        return total, gradient, hessian

    parameters = np.zeros(last + 1)
    parameters[last] = 1.0
    total, gradient, hessian = evaluate(parameters)
    for _ in range(_MOST_STEPS):
        step = np.linalg.solve(-hessian, gradient)
        decrement = float(gradient @ step)
        if decrement < _DECREMENT * (1 + abs(total)):
            break
        share = 1.0
        trial = evaluate(parameters + step)
        # the last part of the bound is for rounding: at the maximum no step can gain
        while trial[0] < total + 1e-4 * share * decrement - 1e-13 * (1 + abs(total)):
            share /= 2
            trial = evaluate(parameters + share * step)
        parameters = parameters + share * step
        total, gradient, hessian = trial
    else:
        raise FitError("the likelihood is not at its maximum", found=f"{_MOST_STEPS} steps")
    precision = float(parameters[last])
    # (b, scale) = (gamma, 1) / theta
    change = np.eye(last + 1) / precision
    change[:last, last] = -parameters[:last] / precision**2
    change[last, last] = -1 / precision**2
    units = np.ones(last + 1) * size
    covariance = change @ np.linalg.inv(-hessian) @ change.T * np.outer(units, units)
    return _CensoredFit(
        coefficient=parameters[:last] / precision * size,
        scale=size / precision,
        covariance=covariance,
        log_likelihood=total - n_failed * log(size),
    )


SCATTER_OF: dict[LifeDistribution, Scatter] = {
    "lognormal": "normal",
    "weibull": "smallest_extreme_value",
}
"""Scatter of ln N."""


def _as_log_lives(cycles: ArrayLike, is_suspended: ArrayLike) -> tuple[Floats, Bools]:
    """Logarithm of lives, with a mark for lower bounds.

    Examples
    --------
    >>> print(_as_log_lives([1.0], [True]))
    (array([0.]), array([ True]))
    """
    lives = as_positive("cycles", cycles)
    suspended = np.asarray(is_suspended, dtype=np.bool_)
    return np.log(lives), suspended


def _runout_bound(cycles: ArrayLike, *, failed_share: float = 0.5) -> float:
    """Life that the specimens reach where none has failed: a lower bound without any law.

    Notes
    -----
    If a fraction ``failed_share`` q of all specimens failed before N, m of them would all pass N
    with a chance of at most (1 - q)^m.  The bound is the greatest N that enough tests passed.
    Three run-outs, as in [5]_ at its lowest load, bound the median with only 87.5 %.

    Examples
    --------
    >>> print(_runout_bound([200_000] * 3), _runout_bound([200_000] * 6))
    nan 200000.0
    """
    lives = np.sort(as_positive("cycles", cycles))[::-1]
    _scatter_quantile(failed_share, scatter="normal")  # refuses an invalid fraction
    enough = int(np.ceil(np.log((1 - CONFIDENCE) / 2) / np.log1p(-failed_share) - 1e-12))
    return float(lives[enough - 1]) if lives.size >= enough else float("nan")


def fit_life(
    cycles: ArrayLike,
    is_suspended: ArrayLike,
    *,
    distribution: LifeDistribution = "weibull",
    failed_share: float = 0.5,
) -> LifeFit:
    """Life of specimens that were tested under equal conditions, by maximum likelihood.

    Notes
    -----
    The bounds are those of the profile likelihood, with the drop of `cutoff`: exact
    for a lognormal law without run-outs.  For generated lives, bounds of 95 % held the true
    median in 95 % of groups of three failures, and in 97 to 98 % of groups with run-outs.

    Examples
    --------
    Ten failures and ten suspended at 500 hours; [6]_ prints 606.528, 1.7208 and -75.135:

    >>> hours = [54, 187, 216, 240, 244, 335, 361, 373, 375, 386] + 10 * [500]
    >>> fit = fit_life(hours, [False] * 10 + [True] * 10)
    >>> print(round(np.exp(fit.log_location), 2), round(1 / fit.log_scale, 4))
    606.53 1.7208
    >>> print(round(fit.log_likelihood, 3), round(fit.life))
    -75.135 490
    """
    logs, suspended = _as_log_lives(cycles, is_suspended)
    scatter = SCATTER_OF[distribution]
    quantile = _scatter_quantile(failed_share, scatter=scatter)
    failed = logs[~suspended]
    unknown = LifeFit(distribution, failed_share, failed.size, int(suspended.sum()))
    if failed.size == 0:
        low = _runout_bound(cycles, failed_share=failed_share)
        return replace(unknown, low=low, high=inf, reason=5)
    if failed.size == 1:
        return replace(unknown, reason=6)
    # a later run-out is evidence of scatter even where the failures have none
    if not np.ptp(failed) > 0 and not (logs[suspended] > failed[0]).any():
        return replace(unknown, reason=7)
    centre = float(logs.mean())
    about, ones = logs - centre, np.ones((logs.size, 1))
    fit = fit_censored(about, ones, suspended, scatter=scatter)
    location = float(fit.coefficient[0])
    gradient = np.array([1.0, quantile])
    spread_of_life = float(np.sqrt(gradient @ fit.covariance @ gradient))
    low, high = profile_bounds(
        lambda held: (
            fit_censored(
                about - held, ones[:, :0], suspended, scatter=scatter, offset=quantile
            ).log_likelihood
        ),
        estimate=location + quantile * fit.scale,
        maximum=fit.log_likelihood,
        step=spread_of_life,
        drop=cutoff(n_failed=failed.size, n_coefficients=1),
    )
    with np.errstate(over="ignore"):
        life, low, high = np.exp(centre + np.array([location + quantile * fit.scale, low, high]))
    spread = np.sqrt(np.diag(fit.covariance))
    return replace(
        unknown,
        life=float(life),
        life_standard_uncertainty=float(life) * spread_of_life,
        low=float(low),
        high=float(high),
        log_location=centre + location,
        log_scale=fit.scale,
        log_location_uncertainty=float(spread[0]),
        log_scale_uncertainty=float(spread[1]),
        log_likelihood=fit.log_likelihood - float(failed.sum()),
    )


def ratio_of_lives(
    cycles: ArrayLike,
    is_suspended: ArrayLike,
    is_reference: ArrayLike,
    *,
    distribution: LifeDistribution = "lognormal",
) -> tuple[float, float, float]:
    """Ratio of the life of one group to that of a reference group, run-outs included.

    Examples
    --------
    Lives twice as long, specimen by specimen:

    >>> lives = [8e3, 9e3, 16e3, 18e3]
    >>> ratio, _, _ = ratio_of_lives(lives, [False] * 4, [True, True, False, False])
    >>> print(round(ratio, 6))
    2.0
    """
    logs, suspended = _as_log_lives(cycles, is_suspended)
    reference = np.asarray(is_reference, dtype=np.bool_)
    for group, which in ((reference, "the reference group"), (~reference, "the other group")):
        if not (group & ~suspended).any():
            raise DataError(f"{which} has no failure", needed="one failure or more in each group")
    scatter = SCATTER_OF[distribution]
    about, ones = logs - logs.mean(), np.ones((logs.size, 1))
    other = np.where(reference, 0.0, 1.0)
    fit = fit_censored(about, np.column_stack([ones, other]), suspended, scatter=scatter)
    estimate = float(fit.coefficient[1])
    low, high = profile_bounds(
        lambda held: (
            fit_censored(about - held * other, ones, suspended, scatter=scatter).log_likelihood
        ),
        estimate=estimate,
        maximum=fit.log_likelihood,
        step=float(np.sqrt(fit.covariance[1, 1])),
        drop=cutoff(n_failed=int((~suspended).sum()), n_coefficients=2),
    )
    return exp(estimate), exp(low), exp(high)


LEVEL_WIDTH = 0.01
"""Peak loads within this distance, in rated break strengths, are one level: a machine does not
reach exactly the same load twice."""


def load_levels(peak_load_ratio: ArrayLike) -> Integers:
    """Level of each test, by grouping of close peak loads.

    Parameters
    ----------
    peak_load_ratio : array_like, shape (n,)
        Peak load over the rated break strength. [1]

    Returns
    -------
    level : ndarray of int, shape (n,)
        From 0 for the lowest; a gap of more than `LEVEL_WIDTH` separates two levels. [1]

    Raises
    ------
    DataError
        If a load is not above zero.

    Examples
    --------
    >>> print(load_levels([0.302, 0.45, 0.298, 0.451]))
    [0 1 0 1]
    """
    load = as_positive("peak_load_ratio", peak_load_ratio)
    order = np.argsort(load, kind="stable")
    level = np.empty(load.size, dtype=np.intp)
    # a thousandth more, so that 0.30 and 0.31 are grouped whatever their last bit
    level[order] = np.cumsum(np.diff(load[order], prepend=load[order][:1]) > 1.001 * LEVEL_WIDTH)
    return level


def _log_likelihood_of_levels(
    about: Floats, load: Floats, suspended: Bools, scatter: Scatter
) -> tuple[float, int]:
    """Greatest log likelihood with a median for each level, and the number of levels.

    The median of a level without failure is unbounded, and the level adds nothing.
    """
    place = load_levels(load)
    n_levels = int(place.max()) + 1
    has_failure = np.bincount(place[~suspended], minlength=n_levels) > 0
    kept = has_failure[place]
    design = np.equal.outer(place[kept], np.flatnonzero(has_failure)).astype(np.float64)
    fit = fit_censored(about[kept], design, suspended[kept], scatter=scatter)
    return fit.log_likelihood, n_levels


def fit_load_life(
    peak_load_ratio: ArrayLike,
    cycles: ArrayLike,
    is_suspended: ArrayLike,
    *,
    distribution: LifeDistribution = "lognormal",
) -> LoadLife:
    r"""Life against peak load, run-outs as lower bounds, by maximum likelihood.

    .. math:: \ln N = \ln N_0 - m \ln(S / S_0) + \sigma\,\varepsilon

    Notes
    -----
    The mean of the failures alone, as joined in Figure 19 of [7]_, is too low wherever
    a test was stopped.  A line in logarithms has no fatigue limit; the lack of fit shows
    whether separate medians fit the levels better (twice the gain in log
    likelihood, taken as chi square).

    Examples
    --------
    An exact slope with a scatter of a tenth:

    >>> load = np.repeat([0.4, 0.5, 0.7], 2)
    >>> fit = fit_load_life(load, 1000 * load**-6.0 * np.tile([0.9, 1 / 0.9], 3), [False] * 6)
    >>> print(round(fit.exponent, 6), round(fit.log_scale, 4))
    6.0 0.1054
    """
    logs, suspended = _as_log_lives(cycles, is_suspended)
    load = as_positive("peak_load_ratio", peak_load_ratio)
    level = load_levels(load)
    n_failed_levels = np.unique(level[~suspended]).size
    if n_failed_levels < 2:
        raise FitError(
            "the slope of life against load needs failures at two loads",
            found=f"failures at {n_failed_levels}",
            needed="2 or more",
            hint="Use fit_life for one load.",
        )
    scatter = SCATTER_OF[distribution]
    reference = float(np.exp(np.log(load[~suspended]).mean()))
    centre = float(logs.mean())
    about = logs - centre
    design = np.column_stack([np.ones(load.size), -np.log(load / reference)])
    fit = fit_censored(about, design, suspended, scatter=scatter)
    median = _scatter_quantile(0.5, scatter=scatter)
    # from (location, exponent, scale) to (median, exponent, scale)
    to_median = np.array([[1.0, 0.0, median], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    p_value = float("nan")
    n_levels = int(level.max()) + 1
    n_failed = int((~suspended).sum())
    if n_levels > 2 and n_failed > n_failed_levels:
        best, n_levels = _log_likelihood_of_levels(about, load, suspended, scatter)
        p_value = float(chdtrc(n_levels - 2, max(2 * (best - fit.log_likelihood), 0.0)))
    return LoadLife(
        distribution=distribution,
        reference_load_ratio=reference,
        log_life=centre + float(fit.coefficient[0]) + median * fit.scale,
        exponent=float(fit.coefficient[1]),
        log_scale=fit.scale,
        covariance=to_median @ fit.covariance @ to_median.T,
        log_likelihood=fit.log_likelihood - float(logs[~suspended].sum()),
        lack_of_fit_p_value=p_value,
        load_ratio_low=float(load.min()),
        load_ratio_high=float(load.max()),
        n_failed=n_failed,
        n_suspended=int(suspended.sum()),
    )


def life_at_load(
    fit: LoadLife,
    peak_load_ratio: ArrayLike,
    *,
    failed_share: float = 0.5,
) -> tuple[Floats, Floats, Floats, Bools]:
    """Life at a peak load, with its bounds.

    Notes
    -----
    Bounds from the observed information in ln N, with Student's t of the failures less two.

    Examples
    --------
    >>> load = np.repeat([0.4, 0.5, 0.7], 2)
    >>> fit = fit_load_life(load, 1000 * load**-6.0 * np.tile([0.9, 1 / 0.9], 3), [False] * 6)
    >>> print(life_at_load(fit, 0.5)[0].round(3), life_at_load(fit, 0.3)[3])
    64000.0 False
    """
    load = as_positive("peak_load_ratio", peak_load_ratio)
    scatter = SCATTER_OF[fit.distribution]
    beyond = _scatter_quantile(failed_share, scatter=scatter) - _scatter_quantile(
        0.5, scatter=scatter
    )
    slope = -np.log(load / fit.reference_load_ratio)
    row = np.stack([np.ones_like(slope), slope, np.full_like(slope, beyond)], axis=-1)
    middle = row @ np.array([fit.log_life, fit.exponent, fit.log_scale])
    variance = np.einsum("...i,ij,...j->...", row, fit.covariance, row)
    free = fit.n_failed - 2
    t = stdtrit(free, (1 + CONFIDENCE) / 2) if free > 0 else np.nan
    half = t * np.sqrt(variance)
    is_inside = (load >= fit.load_ratio_low) & (load <= fit.load_ratio_high)
    with np.errstate(over="ignore"):
        return np.exp(middle), np.exp(middle - half), np.exp(middle + half), np.asarray(is_inside)


def ratio_to_published_life(
    cycles: ArrayLike,
    is_suspended: ArrayLike,
    *,
    reference_mean: float,
    reference_standard_deviation: float,
    reference_n: int,
) -> tuple[float, float, float]:
    r"""Median life over that of a group with only mean, deviation and number printed.

    Notes
    -----
    The reference has :math:`s_{\ln}^2 = \ln(1 + s^2/m^2)` and the median
    :math:`m \exp(-s_{\ln}^2/2)`.  The bounds of the two medians, by profile and by Student, are
    combined as in [10]_.  In [9]_ the tests of jacketed line were stopped after 13
    samples since lives rose from test to test; three lives are printed, and the ratio
    of "5 to 6" is that of these three to the mode: a ratio to the first, shortest lives.

    Examples
    --------
    The three printed lives over those of 38 samples without a jacket:

    >>> ratio, low, high = ratio_to_published_life([29e3, 39e3, 41e3], [False] * 3,
    ...     reference_mean=8134, reference_standard_deviation=1963, reference_n=38)
    >>> print(round(ratio, 2), round(low, 1), round(high, 1))
    4.54 2.8 7.3
    """
    numbers = (reference_mean, reference_standard_deviation, reference_n - 1)
    if not all(number > 0 for number in numbers):
        raise DataError(
            "a reference life cannot be used",
            found=f"mean {reference_mean:g}, deviation {reference_standard_deviation:g}, "
            f"n {reference_n}",
            needed="mean and deviation above zero, n of 2 or more",
        )
    fit = fit_life(cycles, is_suspended, distribution="lognormal")
    spread = log1p((reference_standard_deviation / reference_mean) ** 2)
    reference = log(reference_mean) - spread / 2
    half = float(stdtrit(reference_n - 1, (1 + CONFIDENCE) / 2)) * sqrt(spread / reference_n)
    if not fit.life > 0:
        return float("nan"), float("nan"), float("nan")
    own = log(fit.life)
    below = sqrt((own - log(fit.low)) ** 2 + half**2)
    above = sqrt((log(fit.high) - own) ** 2 + half**2)
    return exp(own - reference), exp(own - reference - below), exp(own - reference + above)
