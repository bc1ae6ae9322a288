r"""Life against peak load; run-outs and suspended tests as lower bounds.

References
----------
.. [1] CG-D-39-80, section 5 and Figure 19 (snap loading).
.. [2] W. Q. Meeker and L. A. Escobar, Statistical Methods for Reliability Data, Wiley,
   1998, ch. 17.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import chdtrc, stdtrit

from reduction.checks import as_positive
from reduction.errors import DataError, FitError
from reduction.outcomes.censored import Scatter, fit_censored, scatter_quantile
from reduction.outcomes.life import SCATTER_OF, as_log_lives
from reduction.outcomes.life_product import LifeDistribution, LoadLife
from reduction.record import Bools, Floats, Integers

LEVEL_WIDTH = 0.01
"""Peak loads no further apart, in rated break strengths, are one level: a machine does not
reach the same load twice."""


def load_levels(peak_load_ratio: ArrayLike) -> Integers:
    """Level of each test, by peak loads that lie together.

    Parameters
    ----------
    peak_load_ratio : array_like, shape (n,)
        Peak load over the rated break strength. [1]

    Returns
    -------
    level : ndarray of int, shape (n,)
        From 0 for the lowest; a gap of more than `LEVEL_WIDTH` parts two levels. [1]

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
    # a thousandth more, so that 0.30 and 0.31 are together whatever their last bit
    level[order] = np.cumsum(np.diff(load[order], prepend=load[order][:1]) > 1.001 * LEVEL_WIDTH)
    return level


def _log_likelihood_of_levels(
    about: Floats, load: Floats, suspended: Bools, scatter: Scatter
) -> tuple[float, int]:
    """Greatest log likelihood with a median of each level, and how many levels there are.

    A level without failure takes a median as high as it likes, and adds nothing.
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

    Parameters
    ----------
    peak_load_ratio : array_like, shape (n,)
        Peak load S over the rated break strength. [1]
    cycles : array_like, shape (n,)
        To failure, or to the end of a test that was stopped. [1]
    is_suspended : array_like of bool, shape (n,)
        True for a run-out or a suspended test. [1]
    distribution : str
        ``lognormal`` or ``weibull``, with one scatter of ln N at all loads.

    Returns
    -------
    fit : LoadLife
        S_0 is the geometric mean of the loads of the failures.

    Raises
    ------
    DataError
        If the series do not pair up or a number is not above zero.
    FitError
        If there are failures at fewer than two loads, or these do not scatter.

    Notes
    -----
    The mean of the failures alone, which Figure 19 of [1]_ joins, is too short wherever
    a test was stopped.  A line in logarithms has no fatigue limit; the lack of fit says
    whether medians of their own fit the levels better (twice the gain in log
    likelihood, taken as chi square).

    Examples
    --------
    An exact slope with a scatter of a tenth:

    >>> load = np.repeat([0.4, 0.5, 0.7], 2)
    >>> fit = fit_load_life(load, 1000 * load**-6.0 * np.tile([0.9, 1 / 0.9], 3), [False] * 6)
    >>> print(round(fit.exponent, 6), round(fit.log_scale, 4))
    6.0 0.1054
    """
    logs, suspended = as_log_lives(cycles, is_suspended)
    load = as_positive("peak_load_ratio", peak_load_ratio)
    if load.shape != logs.shape:
        raise DataError(
            "loads and cycles do not pair up", found=f"shapes {load.shape} and {logs.shape}",
            needed="equal lengths",
        )  # fmt: skip
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
    median = scatter_quantile(0.5, scatter=scatter)
    # of (location, exponent, scale) to (median, exponent, scale)
    to_median = np.array([[1.0, 0.0, median], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    chi_square = p_value = float("nan")
    n_levels = int(level.max()) + 1
    n_failed = int((~suspended).sum())
    if n_levels > 2 and n_failed > n_failed_levels:
        best, n_levels = _log_likelihood_of_levels(about, load, suspended, scatter)
        chi_square = max(2 * (best - fit.log_likelihood), 0.0)
        p_value = float(chdtrc(n_levels - 2, chi_square))
    return LoadLife(
        distribution=distribution,
        reference_load_ratio=reference,
        log_life=centre + float(fit.coefficient[0]) + median * fit.scale,
        exponent=float(fit.coefficient[1]),
        log_scale=fit.scale,
        covariance=to_median @ fit.covariance @ to_median.T,
        log_likelihood=fit.log_likelihood - float(logs[~suspended].sum()),
        lack_of_fit_chi_square=chi_square,
        lack_of_fit_p_value=p_value,
        lack_of_fit_degrees_of_freedom=n_levels - 2,
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
    confidence: float = 0.95,
) -> tuple[Floats, Floats, Floats, Bools]:
    """Life at a peak load, with its bounds.

    Parameters
    ----------
    fit : LoadLife
        As fitted.
    peak_load_ratio : array_like
        Over the rated break strength. [1]
    failed_share : float
        The life is that by which this share has failed. [1]
    confidence : float
        Of the bounds, two-sided. [1]

    Returns
    -------
    life, low, high : ndarray
        The shape of ``peak_load_ratio``. [1]
    is_inside : ndarray of bool
        False outside the loads tested. [1]

    Raises
    ------
    DataError
        If a load or a share cannot be.

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
    beyond = scatter_quantile(failed_share, scatter=scatter) - scatter_quantile(
        0.5, scatter=scatter
    )
    slope = -np.log(load / fit.reference_load_ratio)
    row = np.stack([np.ones_like(slope), slope, np.full_like(slope, beyond)], axis=-1)
    middle = row @ np.array([fit.log_life, fit.exponent, fit.log_scale])
    variance = np.einsum("...i,ij,...j->...", row, fit.covariance, row)
    free = fit.n_failed - 2
    t = stdtrit(free, (1 + confidence) / 2) if free > 0 else np.nan
    half = t * np.sqrt(variance)
    is_inside = (load >= fit.load_ratio_low) & (load <= fit.load_ratio_high)
    with np.errstate(over="ignore"):
        return np.exp(middle), np.exp(middle - half), np.exp(middle + half), np.asarray(is_inside)
