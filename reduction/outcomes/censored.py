r"""Maximum likelihood of a straight law with scatter, where some values are lower bounds.

.. math:: y = X b + \sigma\,\varepsilon

with normal or smallest-extreme-value scatter; a lognormal or Weibull life has y = ln N.
In :math:`\theta = 1/\sigma` and :math:`\gamma = b/\sigma` the log likelihood is concave, so that
Newton steps reach its one maximum from any start, and a quantile that is held fixed is a linear
condition, so that its profile is a problem of the same form.

References
----------
.. [1] R. J. Olsen, "Note on the Uniqueness of the Maximum Likelihood Estimator for the
   Tobit Model," Econometrica, vol. 46, no. 5, pp. 1211-1215, 1978.
.. [2] J. Burridge, "A Note on Maximum Likelihood Estimation for Regression Models Using
   Grouped Data," J. R. Stat. Soc. B, vol. 43, no. 1, pp. 41-45, 1981.
.. [3] W. Q. Meeker and L. A. Escobar, Statistical Methods for Reliability Data, Wiley, 1998.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, log, log1p, pi
from typing import Literal

import numpy as np
from scipy.special import log_ndtr, ndtri

from reduction.errors import DataError, FitError
from reduction.record import Bools, Floats

Scatter = Literal["normal", "smallest_extreme_value"]

_MOST_STEPS = 200
_DECREMENT = 1e-18  # of the log likelihood, below which a Newton step changes nothing
_LEAST_SCATTER = 1e-12  # over the greatest value
_HALF_LOG_2_PI = log(2 * pi) / 2


@dataclass(frozen=True)
class CensoredFit:
    """A maximum: coefficients b, scatter, and the covariance of (b, scatter)."""

    coefficient: Floats
    scale: float
    covariance: Floats
    log_likelihood: float


def scatter_quantile(share: float, *, scatter: Scatter) -> float:
    """Standard scatter below which a share of the specimens lies.

    Parameters
    ----------
    share : float
        Between 0 and 1. [1]
    scatter : str
        ``normal`` or ``smallest_extreme_value``.

    Returns
    -------
    quantile : float
        In units of the scale. [1]

    Raises
    ------
    DataError
        If the share is not between 0 and 1.

    Examples
    --------
    >>> print(round(scatter_quantile(0.5, scatter="smallest_extreme_value"), 4))
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
            # far below the mean the hazard is 0 and its difference to the density too
            hazard = np.exp(np.where(is_bound, density - log_survival, -inf))
        value = np.where(is_bound, log_survival, density)
        slope = np.where(is_bound, -hazard, -deviate)
        return value, slope, np.where(is_bound, -hazard * (hazard - deviate), -1.0)
    with np.errstate(over="ignore"):
        power = np.exp(deviate)
    return np.where(is_bound, -power, deviate - power), np.where(is_bound, 0.0, 1.0) - power, -power


def _check_maximum(response: Floats, design: Floats, is_bound: Bools) -> None:
    """Refuse what has no maximum: a coefficient, or the precision, that may grow for ever."""
    failed, columns = response[~is_bound], design[~is_bound]
    # numpy before 2.4 gives no rank to a matrix without rows or columns
    rank = np.linalg.matrix_rank(columns) if columns.size else 0
    if rank < design.shape[1]:
        raise FitError(
            "the failures leave a coefficient open",
            found=f"{failed.size} failures for {design.shape[1]} coefficients",
            needed="failures at more levels",
        )
    coefficient = np.linalg.lstsq(columns, failed)[0]
    on_the_law = np.abs(failed - columns @ coefficient).max(initial=0.0) < _LEAST_SCATTER
    # a lower bound above the law shows that there is scatter even so
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
) -> CensoredFit:
    """Fit response = design b + scale x (scatter - offset).

    Parameters
    ----------
    response : ndarray, shape (n,)
        Values, or their lower bounds; best near 0. [1]
    design : ndarray, shape (n, n_coefficients)
        Columns that the values follow; none is allowed. [1]
    is_bound : ndarray of bool, shape (n,)
        True for a lower bound. [1]
    scatter : str
        ``normal`` or ``smallest_extreme_value``.
    offset : float
        Added to every standard deviate: what a fixed quantile puts there. [1]

    Returns
    -------
    fit : CensoredFit
        At the maximum; the covariance is the inverse of the observed information. [1]

    Raises
    ------
    FitError
        If there is no maximum: the failures have no scatter, or leave a coefficient open.

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
        # the last part of the bound is rounding: at the maximum no step can gain
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
    return CensoredFit(
        coefficient=parameters[:last] / precision * size,
        scale=size / precision,
        covariance=covariance,
        log_likelihood=total - n_failed * log(size),
    )
