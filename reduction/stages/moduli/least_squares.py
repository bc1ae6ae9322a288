r"""Least squares for models that are linear in all but a few parameters.

The linear parameters are solved for internally (variable projection, [1]_), so that the search is
only over the few others, from all starts at once:

.. math::

    r(\theta) = y - \Phi(\theta) \Phi^+(\theta) y, \qquad
    J_j = -(I - \Phi \Phi^+) \, \frac{\partial \Phi}{\partial \theta_j} \, a,
    \qquad a = \Phi^+ y

The Jacobian is Kaufman's ([2]_): it omits a term whose product with r is zero, so that the
gradient is exact.  Steps over all parameters together refine the result to its last digits and
give the covariance.  Checked on NIST StRD problems (see Notes of `fit_separable`).

References
----------
.. [1] G. H. Golub and V. Pereyra, "The differentiation of pseudo-inverses and nonlinear least
   squares problems whose variables separate," SIAM J. Numer. Anal. 10(2), 1973.
.. [2] L. Kaufman, "A variable projection method for solving separable nonlinear least squares
   problems," BIT 15, 1975.
.. [3] NIST/ITL Statistical Reference Datasets, Nonlinear Regression: MGH17, BoxBOD, Misra1a.
.. [4] H. B. Nielsen, "Damping Parameter in Marquardt's Method," IMM-REP-1999-05, Tech. Univ. of
   Denmark, 1999.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from reduction.record.arrays import as_finite
from reduction.record.errors import DataError, FitError
from reduction.record.measurement import Bools, Floats, read_only_arrays

Basis = Callable[[Floats], tuple[Floats, Floats]]
"""From shapes to columns, and the derivative of each of the last columns by its own shape."""

NEAR = 1e-7
"""Relative step of the shapes at which the search ends."""

ALIKE = 1e-9
"""Relative difference of sums of squares below which they count as equal."""

_ENOUGH = 1e-11
"""Fraction of the sum of squares: the search ends if an undamped step should gain less."""

_DEPENDENT = 1e-9
"""Part of a unit column left by those before it, below which it may depend on them."""

FIRST_DAMPING = 1e-3

LAST_DAMPING = 1e12

_DIGITS = float(np.finfo(np.float64).eps)

SEARCH_STEPS = 200

POLISHING_STEPS = 30


@dataclass(frozen=True)
@read_only_arrays
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

    @property
    def residual_sum_of_squares(self) -> float:
        """Weighted sum of squared residuals."""
        return float(self.residual @ self.residual)

    @property
    def standard_uncertainty(self) -> Floats:
        """Standard uncertainties of the amplitudes, then of the shapes."""
        return np.asarray(np.sqrt(np.diag(self.covariance)), dtype=np.float64)


def lag_one_inflation(residual: ArrayLike) -> float:
    """Factor by which correlated residuals increase every variance of a fit.

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
    Assumes first-order autoregressive noise; the correlation is limited to 0.95.  A model that
    does not fit also leaves correlated residuals, so lack of fit widens the uncertainty.

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
    """Inverse normal matrix by QR on scaled columns, which preserves the digits."""
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
    parameters: Floats, evaluate: Callable[[Floats], tuple[Floats, Floats]]
) -> tuple[Floats, Floats, Floats]:
    """Gauss-Newton steps while they get shorter; parameters, with residuals and Jacobian there.

    A trust region stops where the sum of squares no longer changes, at half the digits of
    the parameters; these steps follow its gradient to the last digits, so that the result
    does not depend on the path of the search.
    """
    residual, jacobian = evaluate(parameters)
    scale = np.linalg.norm(jacobian, axis=0)
    shortest = 0.0 if np.any(scale == 0) else np.inf
    for _ in range(POLISHING_STEPS):
        step = -_solve(jacobian, residual)
        length = float(np.linalg.norm(step * scale))
        trial, bent = evaluate(parameters + step)
        # Not where the search only got stuck: there a step may lead anywhere.
        if not (length < shortest and trial @ trial <= (residual @ residual) * (1 + 1e-9)):
            break
        parameters, shortest, residual, jacobian = parameters + step, length, trial, bent
    return parameters, residual, jacobian


class _Projected(NamedTuple):
    """Residuals at each set of shapes, with the amplitudes solved for."""

    squares: Floats
    """Sum of squared residuals; infinite where the model is not finite. (n_sets,)"""
    gradient: Floats
    """Half the derivative of the sum. (n_sets, n_shapes)"""
    normal: Floats
    """Products of the columns of the Jacobian. (n_sets, n_shapes, n_shapes)"""


def _projected(columns: Floats, slopes: Floats, target: Floats) -> _Projected:
    """Amplitudes by least squares, of least norm where columns are dependent."""
    scale = np.sqrt(np.einsum("snc,snc->sc", columns, columns))
    finite: Bools = np.isfinite(scale).all(axis=1) & np.isfinite(slopes).all(axis=(1, 2))
    if not finite.all():
        columns = np.where(finite[:, None, None], columns, 0.0)
        slopes = np.where(finite[:, None, None], slopes, 0.0)
        scale = np.where(finite[:, None], scale, 0.0)
    scale[scale == 0] = 1.0
    base, triangle = np.linalg.qr(columns / scale[:, None, :])
    pivot = np.abs(np.diagonal(triangle, axis1=1, axis2=2))
    if pivot.min() > _DEPENDENT:
        share = target @ base
        amplitude = np.linalg.solve(triangle, share[..., None])[..., 0] / scale
    else:
        left, size, right = np.linalg.svd(triangle)
        least = _DIGITS * target.size * size[:, 0]
        counts = np.greater(size, least[:, None])
        base = base @ (left * counts[:, None, :])
        share = target @ base
        part = np.where(counts, share / np.where(counts, size, 1.0), 0.0)
        amplitude = (part[:, None, :] @ right)[:, 0] / scale
    residual = target - (base @ share[..., None])[..., 0]
    jacobian = slopes * -amplitude[:, None, -slopes.shape[2] :]
    jacobian -= base @ (base.swapaxes(1, 2) @ jacobian)
    across = jacobian.swapaxes(1, 2)
    return _Projected(
        squares=np.where(finite, (residual * residual).sum(axis=1), np.inf),
        gradient=(across @ residual[..., None])[..., 0],
        normal=across @ jacobian,
    )


def _damped_step(at: _Projected, damping: Floats) -> tuple[Floats, Floats]:
    """Step of Levenberg and Marquardt from each set of shapes, and its predicted gain."""
    curvature = np.diagonal(at.normal, axis1=1, axis2=2)
    scale = np.sqrt(np.where(curvature > 0, curvature, 1.0))
    even = at.normal / (scale[:, :, None] * scale[:, None, :])
    slope = at.gradient / scale
    damped = even + damping[:, None, None] * np.eye(scale.shape[1])
    step = -np.linalg.solve(damped, slope[..., None])[..., 0]
    gain = np.sum(step * (damping[:, None] * step - slope), axis=1)
    return step / scale, gain


def _search(basis: Basis, target: Floats, starts: Floats) -> tuple[Floats, Floats]:
    """End point of the search from each start, and the sum of squares there.

    Levenberg and Marquardt; each start has its own damping, adapted to how well the last
    step was predicted ([4]_).
    """
    shapes = starts.copy()
    found = _projected(*basis(shapes), target)
    damping, growth = np.full(len(shapes), FIRST_DAMPING), np.full(len(shapes), 2.0)
    searching = np.isfinite(found.squares)
    for _ in range(SEARCH_STEPS):
        at = np.flatnonzero(searching)
        if at.size == 0:
            break
        here = _Projected(*(part[at] for part in found))
        step, expected = _damped_step(here, damping[at])
        there = _projected(*basis(shapes[at] + step), target)
        gain = here.squares - there.squares
        better = gain > 0
        length = np.sqrt((step * step).sum(axis=1))
        # the step is below the required precision, or the gain below that of the sum
        ends = length <= NEAR * (NEAR + np.sqrt((shapes[at] ** 2).sum(axis=1)))
        ends |= expected <= _DIGITS * here.squares
        # later steps over all parameters find the remaining reduction of the sum
        ends |= (expected <= _ENOUGH * here.squares) & (damping[at] < 1.0)
        moved = at[better]
        shapes[moved] += step[better]
        for old, new in zip(found, there, strict=True):
            old[moved] = new[better]
        foreseen = np.minimum(np.maximum(gain[better] / expected[better], 0.0), 1.0)
        damping[moved] *= np.maximum(1 / 3, 1 - (2 * foreseen - 1) ** 3)
        growth[moved] = 2.0
        stayed = at[~better]
        damping[stayed] *= growth[stayed]
        growth[stayed] *= 2.0
        searching[at] = ~ends & (damping[at] < LAST_DAMPING)
    return shapes, found.squares


# A search may stray to where the model overflows, which its values show.
@np.errstate(over="ignore", invalid="ignore", divide="ignore")
def fit_separable(
    basis: Basis,
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
        From shapes, ndarray (n_sets, n_shapes), to columns, ndarray (n_sets, n_samples,
        n_amplitudes), and slopes, ndarray (n_sets, n_samples, n_shapes). Each shape enters one
        column, and these columns stand last, in the order of the shapes; the slope is the
        derivative of the column by its shape. [1]
    values : array_like, shape (n_samples,)
        Values to fit. [any unit]
    starts : array_like, shape (n_starts, n_shapes)
        Starting shapes; the best result is used, or of several equally good ones that with the
        smallest shapes. [any unit]
    weights : array_like, shape (n_samples,), optional
        Inverse relative variances; equal by default. [1]

    Returns
    -------
    fit : SeparableFit
        Parameters, covariance, residuals. [units of the model]

    Raises
    ------
    DataError
        If a value is not finite, or there are not more samples than parameters.
    FitError
        If the model is not finite at any start, a parameter has no effect, or parameters cannot
        be distinguished.

    Notes
    -----
    Variable projection [1]_ with the Jacobian of [2]_ to a relative step of 1e-10, from all starts
    at once; then Gauss-Newton steps over all parameters of the best.  MGH17, BoxBOD and Misra1a of
    [3]_: certified parameters and standard deviations to 9 digits or more.

    Examples
    --------
    >>> x = np.linspace(0, 4, 30)[:, None]
    >>> def decay(rates):
    ...     columns = np.exp(-x * rates[:, None, :])
    ...     return columns, -x * columns
    >>> fit = fit_separable(decay, 3 * np.exp(-0.5 * x[:, 0]), starts=[[1.0]])
    >>> print(fit.amplitude.round(6), fit.shape.round(6))
    [3.] [0.5]
    """
    target = as_finite("values", values)
    root = np.sqrt(np.ones_like(target) if weights is None else as_finite("weights", weights))
    target = target * root
    first_shapes = np.atleast_2d(as_finite("starts", starts))

    def weighted(shapes: Floats) -> tuple[Floats, Floats]:
        columns, slopes = basis(shapes)
        return columns * root[:, None], slopes * root[:, None]

    n_amplitudes = weighted(first_shapes[:1])[0].shape[2]
    n_shapes = first_shapes.shape[1]
    n_parameters = n_amplitudes + n_shapes
    if target.size <= n_parameters:
        raise DataError(
            "too few samples for the fit",
            found=f"{target.size} samples",
            needed=f"more than {n_parameters}",
        )

    def together(parameters: Floats) -> tuple[Floats, Floats]:
        columns, slopes = weighted(parameters[None, n_amplitudes:])
        amplitude = parameters[:n_amplitudes]
        bent = slopes[0] * amplitude[n_amplitudes - n_shapes :]
        return target - columns[0] @ amplitude, -np.concatenate([columns[0], bent], axis=1)

    shapes, squares = _search(weighted, target, first_shapes)
    if not np.isfinite(squares).any():
        raise FitError("no start of the fit converges", found=f"{len(first_shapes)} starts")
    alike = shapes[squares <= squares.min() * (1 + ALIKE)]
    best: Floats = alike[int(np.argmin(np.sum(alike**2, axis=1)))]
    amplitude = _solve(weighted(best[None])[0][0], target)
    found, residual, jacobian = _polished(np.concatenate([amplitude, best]), together)
    freedom = target.size - n_parameters
    return SeparableFit(
        amplitude=found[:n_amplitudes],
        shape=found[n_amplitudes:],
        covariance=_covariance(jacobian, found, float(residual @ residual) / freedom),
        residual=residual,
    )
