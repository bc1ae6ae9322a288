"""Least squares for models that are linear in all but a few parameters.

The linear parameters are solved for inside (variable projection), so the search runs
over the few others alone; a last search over all parameters together gives the
covariance.  Checked on NIST StRD problems (see Notes of `fit_separable`).

References
----------
.. [1] G. H. Golub and V. Pereyra, "The differentiation of pseudo-inverses and nonlinear
   least squares problems whose variables separate," SIAM J. Numer. Anal. 10(2), 1973.
.. [2] NIST/ITL Statistical Reference Datasets, Nonlinear Regression:
   MGH17, BoxBOD, Misra1a.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import least_squares

from reduction.checks import as_finite
from reduction.errors import DataError, FitError
from reduction.record import Floats, freeze_arrays

__all__ = ["SeparableFit", "fit_separable", "lag_one_inflation"]

TIGHT = 1e-15
NEAR = 1e-8
COMPLEX_STEP = 1e-30
POLISHING_STEPS = 30


@dataclass(frozen=True)
class SeparableFit:
    """A model ``basis(shape) @ amplitude`` fitted to values.

    Parameters
    ----------
    amplitude, shape : ndarray, shape (n_amplitudes,), (n_shapes,)
        Linear and non-linear parameters.
    covariance : ndarray, shape (n_amplitudes + n_shapes,) * 2
        Amplitudes first; residual variance times the inverse normal matrix.
    residual : ndarray, shape (n_samples,)
        Values minus model, times the square root of the weight.
    """

    amplitude: Floats
    shape: Floats
    covariance: Floats
    residual: Floats

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        freeze_arrays(self)

    @property
    def residual_sum_of_squares(self) -> float:
        """Weighted sum of squared residuals."""
        return float(self.residual @ self.residual)

    @property
    def standard_uncertainty(self) -> Floats:
        """Of the amplitudes, then of the shapes."""
        return np.asarray(np.sqrt(np.diag(self.covariance)), dtype=np.float64)


def lag_one_inflation(residual: ArrayLike) -> float:
    """Factor by which correlated residuals make every variance of a fit larger.

    .. math:: (1 + r_1) / (1 - r_1)

    with :math:`r_1` the correlation of neighbouring residuals, at least 0.

    Parameters
    ----------
    residual : array_like, shape (n_samples,)
        Residuals in order of the abscissa. [any unit]

    Returns
    -------
    inflation : float
        1 for white noise. [1]

    Raises
    ------
    DataError
        If a residual is not finite.

    Notes
    -----
    First-order autoregressive noise; the correlation is held below 0.95.  A model that
    does not fit leaves correlated residuals too, so lack of fit widens the uncertainty.

    Examples
    --------
    >>> lag_one_inflation([1.0, -1.0, 1.0, -1.0])
    1.0
    """
    series = as_finite("residual", residual)
    # sums, not dot products, whose last digits depend on the number of threads
    power = float((series * series).sum())
    if series.size < 3 or power == 0:
        return 1.0
    lag_one = min(0.95, max(0.0, float((series[1:] * series[:-1]).sum()) / power))
    return (1 + lag_one) / (1 - lag_one)


def _solve(columns: Floats, target: Floats) -> Floats:
    scale = np.linalg.norm(columns, axis=0)
    scale = np.where(scale > 0, scale, 1.0)
    solution: Floats = np.linalg.lstsq(columns / scale, target)[0] / scale
    return solution


def _covariance(jacobian: Floats, parameters: Floats, variance: float) -> Floats:
    """Inverse normal matrix by QR on scaled columns, which keeps the digits."""
    scale = np.linalg.norm(jacobian, axis=0)
    effect = scale * np.abs(parameters)
    idle = effect <= 1e-12 * effect.max()
    if np.any(idle):
        raise FitError(
            "a parameter of the fit has no effect on the model",
            found=f"parameter {int(np.flatnonzero(idle)[0])} of {scale.size}",
            needed="starts nearer to the answer, or a smaller model",
        )
    triangle = np.linalg.qr(jacobian / scale, mode="r")
    if np.linalg.cond(triangle) > 1e12:
        raise FitError(
            "the parameters of the fit cannot be told apart",
            found=f"condition {np.linalg.cond(triangle):.1e}",
            needed="below 1e12",
        )
    half = np.linalg.inv(triangle)
    covariance: Floats = variance * (half @ half.T) / np.outer(scale, scale)
    return covariance


def _polished(
    parameters: Floats, residual: Callable[[Floats], Floats], jacobian: Callable[[Floats], Floats]
) -> Floats:
    """Gauss-Newton steps while they get shorter.

    A trust region stops where the sum of squares no longer changes, at half the digits of
    the parameters; these steps follow its gradient to the last ones, so that the answer
    does not depend on the way that led there.
    """
    scale = np.linalg.norm(jacobian(parameters), axis=0)
    if np.any(scale == 0):
        return parameters
    shortest, left = np.inf, residual(parameters)
    for _ in range(POLISHING_STEPS):
        step = -_solve(jacobian(parameters), left)
        length = float(np.linalg.norm(step * scale))
        trial = residual(parameters + step)
        # Not where the search had only run aground: there a step leads anywhere.
        if not (length < shortest and trial @ trial <= (left @ left) * (1 + 1e-9)):
            break
        parameters, shortest, left = parameters + step, length, trial
    return parameters


# A search may stray to where the model overflows; its values tell it so.
@np.errstate(over="ignore", invalid="ignore")
def fit_separable(
    basis: Callable[[Floats], Floats],
    values: ArrayLike,
    *,
    starts: ArrayLike,
    weights: ArrayLike | None = None,
) -> SeparableFit:
    r"""Least-squares fit of ``basis(shape) @ amplitude`` to the values.

    .. math:: \min_{a, \theta} \sum_i w_i (y_i - \sum_k a_k \phi_k(x_i; \theta))^2

    Parameters
    ----------
    basis : callable
        From shapes, ndarray (n_shapes,), to columns, ndarray (n_samples, n_amplitudes). It
        is also called with complex shapes, for derivatives without truncation error. [1]
    values : array_like, shape (n_samples,)
        What is fitted. [any unit]
    starts : array_like, shape (n_starts, n_shapes)
        Shapes to start from; the best result counts. [any unit]
    weights : array_like, shape (n_samples,), optional
        Inverse relative variances; equal where not given. [1]

    Returns
    -------
    fit : SeparableFit
        Parameters, covariance, residuals. [units of the model]

    Raises
    ------
    DataError
        If a value is not finite, or there are not more samples than parameters.
    FitError
        If no start converges, or parameters cannot be told apart.

    Notes
    -----
    Variable projection [1]_ to a tolerance of 1e-8, then all parameters together to 1e-15,
    both by a trust region; the Jacobian of the latter is exact (complex step).  MGH17, BoxBOD
    and Misra1a of [2]_: certified parameters and standard deviations to 9 digits or more.

    Examples
    --------
    >>> x = np.linspace(0, 4, 30)
    >>> fit = fit_separable(
    ...     lambda rate: np.exp(-np.outer(x, rate)), 3 * np.exp(-0.5 * x), starts=[[1.0]]
    ... )
    >>> print(fit.amplitude.round(6), fit.shape.round(6))
    [3.] [0.5]
    """
    target = as_finite("values", values)
    root = np.sqrt(np.ones_like(target) if weights is None else as_finite("weights", weights))
    target = target * root
    first_shapes = np.atleast_2d(as_finite("starts", starts))
    n_amplitudes = basis(first_shapes[0]).shape[1]
    n_parameters = n_amplitudes + first_shapes.shape[1]
    if target.size <= n_parameters:
        raise DataError(
            "too few samples for the fit",
            found=f"{target.size} samples",
            needed=f"more than {n_parameters}",
        )

    def weighted(shape: Floats) -> Floats:
        columns: Floats = basis(shape) * root[:, None]
        return columns

    def jacobian(parameters: Floats) -> Floats:
        amplitude, shape = parameters[:n_amplitudes], parameters[n_amplitudes:]
        aside = shape + COMPLEX_STEP * 1j * np.eye(shape.size)
        slopes = [np.imag(weighted(row)) @ amplitude / COMPLEX_STEP for row in aside]
        return -np.column_stack([weighted(shape), *slopes])

    def projected(shape: Floats) -> Floats:
        columns = weighted(shape)
        if not np.isfinite(columns).all():
            return np.full_like(target, 1e100)
        return target - columns @ _solve(columns, target)

    def together(parameters: Floats) -> Floats:
        return target - weighted(parameters[n_amplitudes:]) @ parameters[:n_amplitudes]

    best: Floats | None = None
    lowest = np.inf
    for start in first_shapes:
        inner = least_squares(projected, start, x_scale="jac", xtol=NEAR, ftol=NEAR, gtol=NEAR)
        if inner.cost < lowest and np.isfinite(weighted(inner.x)).all():
            best, lowest = np.asarray(inner.x, dtype=np.float64), float(inner.cost)
    if best is None:
        raise FitError("no start of the fit converges", found=f"{len(first_shapes)} starts")
    outer = least_squares(
        together,
        np.concatenate([_solve(weighted(best), target), best]),
        jac=jacobian,
        x_scale="jac",
        xtol=TIGHT,
        ftol=TIGHT,
        gtol=TIGHT,
    )
    found = _polished(np.asarray(outer.x, dtype=np.float64), together, jacobian)
    residual = together(found)
    freedom = target.size - n_parameters
    return SeparableFit(
        amplitude=found[:n_amplitudes],
        shape=found[n_amplitudes:],
        covariance=_covariance(jacobian(found), found, float(residual @ residual) / freedom),
        residual=residual,
    )
