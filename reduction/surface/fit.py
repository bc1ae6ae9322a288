r"""Least squares of one response or ten thousand on one matrix, by one orthogonal factorisation.

.. math::

    X = QR, \qquad b = R^{-1} Q^T y, \qquad \operatorname{cov} b = s^2 (R^T R)^{-1}, \qquad
    s^2 = \frac{\lVert y - Q Q^T y \rVert^2}{n - p}

Responses that miss the same runs are solved together; there is a loop over the patterns of
missing runs and none over responses.

References
----------
.. [1] N. R. Draper and H. Smith, Applied Regression Analysis, 3rd ed. New York: Wiley, 1998.
.. [2] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.3.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import DataError, FitError
from reduction.record import Bools, Floats, Integers
from reduction.surface.product import LeastSquares
from reduction.surface.rows import block_contrasts, patterns_of, times
from reduction.surface.student import student_p

__all__ = [
    "covariance_factor",
    "find_confounded",
    "fit_least_squares",
    "two_sided_p",
    "variance_factor",
]

_SINGULAR = 1e-9
"""Smallest over largest singular value, columns of equal length, below which terms are one."""
_ROUNDING = 1e-12
"""Residuals smaller than this share of the response are rounding of the arithmetic."""
_HUGE = 1e150
"""Numbers beyond it cannot be squared."""
_FIXES_A_TERM = 1 - 1e-9
"""Leverage from which a run is fitted by itself alone."""


def two_sided_p(t: ArrayLike, degrees_of_freedom: ArrayLike) -> Floats:
    r"""Probability of a larger Student's t of either sign.

    .. math:: p = I_{\nu / (\nu + t^2)}(\nu / 2, 1 / 2)

    Parameters
    ----------
    t : array_like, shape (...)
        Statistic. [1]
    degrees_of_freedom : array_like, shape (...)
        :math:`\nu`. [1]

    Returns
    -------
    p_value : ndarray, shape (...)
        NaN where t or the degrees of freedom are missing or none. [1]

    Raises
    ------
    TypeError
        If an input is not numeric.

    Notes
    -----
    The incomplete beta function keeps its digits where p is small; 1 less a
    distribution function does not.

    Examples
    --------
    2.571 is the 5 % point for 5 degrees of freedom.

    >>> print(two_sided_p(2.570582, 5).round(4))
    0.05
    """
    statistic, nu = np.broadcast_arrays(
        np.asarray(t, dtype=np.float64), np.asarray(degrees_of_freedom, dtype=np.float64)
    )
    if nu.size and (nu == nu.flat[0]).all() and nu.flat[0] > 0:
        return student_p(statistic.ravel(), float(nu.flat[0])).reshape(statistic.shape)
    p_value = np.full(statistic.shape, np.nan)
    for value in np.unique(nu[nu > 0]):
        p_value[nu == value] = student_p(statistic[nu == value], float(value))
    return p_value


def find_confounded(matrix: ArrayLike, names: Sequence[str]) -> tuple[str, ...]:
    """Say which columns are sums of the columns before them.

    Parameters
    ----------
    matrix : array_like, shape (n_runs, n_columns)
        Model matrix. [1]
    names : sequence of str, length n_columns
        Of the columns.

    Returns
    -------
    confounded : tuple of str
        One text for each column without information of its own; empty for a sound matrix.

    Raises
    ------
    DataError
        If the names do not pair up with the columns.

    Examples
    --------
    Two levels do not tell a square from the mean.

    >>> levels = np.array([-1.0, 1.0, -1.0, 1.0])
    >>> find_confounded(np.stack([np.ones(4), levels**2, levels], axis=1), ["mean", "f^2", "f"])
    ('f^2 with mean',)
    """
    columns = np.asarray(matrix, dtype=np.float64)
    if columns.ndim != 2 or columns.shape[1] != len(names):
        raise DataError(
            "the names do not pair up with the columns",
            found=f"{len(names)} names, shape {columns.shape}",
            needed="one name a column",
        )
    size = np.linalg.norm(columns, axis=0)
    unit = columns / np.where(size > 0, size, 1.0)
    kept: list[int] = []
    found: list[str] = []
    for index, name in enumerate(names):
        if size[index] == 0:
            found.append(f"{name} is zero in every run")
            continue
        share, *_ = np.linalg.lstsq(unit[:, kept], unit[:, index], rcond=None)
        left = unit[:, index] - unit[:, kept] @ share
        if np.linalg.norm(left) > _SINGULAR * len(names):
            kept.append(index)
        else:
            partners = [names[at] for at, part in zip(kept, share, strict=True) if abs(part) > 1e-6]
            found.append(f"{name} with {', '.join(partners)}")
    return tuple(found)


def covariance_factor(matrix: ArrayLike, *, names: Sequence[str]) -> Floats:
    r"""Covariance of the coefficients over the variance of a run, from the design alone.

    .. math:: C = (X^T X)^{-1}

    Parameters
    ----------
    matrix : array_like, shape (n_runs, n_columns)
        Model matrix. [1]
    names : sequence of str, length n_columns
        Of the columns, for the message.

    Returns
    -------
    covariance_factor : ndarray, shape (n_columns, n_columns)
        Symmetric. [1]

    Raises
    ------
    FitError
        If there are fewer runs than terms, or terms are confounded: their names.

    Notes
    -----
    For the fifteen runs of [2]_: mean 1/3, squares 13/48, linear terms 1/8, interactions 1/4.

    Examples
    --------
    A mean of three runs:

    >>> print(covariance_factor(np.ones((3, 1)), names=["mean"]).round(4))
    [[0.3333]]
    """
    columns = np.asarray(matrix, dtype=np.float64)
    n_runs, n_columns = columns.shape
    if n_runs < n_columns:
        raise FitError(
            "there are fewer runs than terms",
            found=f"{n_runs} runs",
            needed=f"{n_columns} for {n_columns} terms, and more to judge the scatter",
            hint="Add runs, or fit fewer factors.",
            n_runs=n_runs,
            n_terms=n_columns,
        )
    if _is_singular(columns):
        found = find_confounded(columns, names)
        raise FitError(
            "the runs cannot tell all terms apart",
            found="; ".join(found),
            needed="runs that move every factor over three levels, and pairs of them together",
            hint="Add the runs that are missing from the design.",
            n_confounded=len(found),
        )
    inverse = np.linalg.inv(np.linalg.qr(columns)[1])
    return np.asarray(inverse @ inverse.T)


def variance_factor(
    matrix: ArrayLike, factor: ArrayLike, *, pattern: Integers | None = None
) -> Floats:
    r"""Variance of the surface at points over the variance of a run.

    .. math:: h(x) = x^T C x

    Parameters
    ----------
    matrix : array_like, shape (..., n_points, n_terms)
        Terms at the points; the leading axis is that of the responses, or there is none. [1]
    factor : array_like, shape (n_terms, n_terms) or (n_patterns, n_terms, n_terms)
        Covariance of the coefficients over the variance of a run. [1]
    pattern : ndarray of int, shape (n_responses,), optional
        Which ``factor`` each response has, where there are several. [1]

    Returns
    -------
    variance_factor : ndarray, shape (..., n_points)
        Leverage where the point is a run. [1]

    Raises
    ------
    ValueError
        If the shapes do not pair up.

    Examples
    --------
    >>> print(variance_factor([[1.0]], [[1 / 3]]).round(3))
    [0.333]
    """
    terms, factors = np.asarray(matrix, dtype=np.float64), np.asarray(factor, dtype=np.float64)
    if factors.ndim == 3:
        factors = factors[0] if len(factors) == 1 or pattern is None else factors[pattern]
    if factors.ndim == 2:
        weighed = times(terms.reshape(-1, len(factors)), factors).reshape(terms.shape)
    else:
        weighed = terms @ factors
    return np.asarray(np.sum(weighed * terms, axis=-1))


def fit_least_squares(
    matrix: ArrayLike,
    responses: ArrayLike,
    *,
    n_baseline: int = 1,
    block: Integers | None = None,
) -> LeastSquares:
    """Fit every response to the columns of a matrix, with what tests of it need.

    Parameters
    ----------
    matrix : array_like, shape (n_runs, n_columns)
        Model matrix, baseline columns (the mean, blocks) first; sums of squares are
        sequential in its order. A row that is NaN is a run without levels. [1]
    responses : array_like, shape (n_responses, n_runs)
        NaN where a run is missing. [unit of the response]
    n_baseline : int
        Columns about which r2 is taken.
    block : ndarray of int, shape (n_runs,), optional
        Block of each run, from 0, where the baseline behind the mean are its contrasts. [1]

    Returns
    -------
    fit : LeastSquares
        NaN and a reason for a response whose runs do not carry the columns.

    Raises
    ------
    DataError
        If the shapes do not pair up, a response is infinite, or a run has a value and no
        levels.

    Notes
    -----
    A response that misses runs is fitted to those it has, and has leverage, covariance and
    degrees of freedom of its own.  Where it misses a whole block, its mean is that over the
    blocks it has, and the columns of blocks it does without have no coefficient.  Residuals
    below 1e-12 of the response are rounding.

    Examples
    --------
    Three values about a mean, one of two responses with a run missing:

    >>> fit = fit_least_squares(np.ones((3, 1)), [[1.0, 2.0, 3.0], [1.0, np.nan, 2.0]])
    >>> print(fit.coefficient.ravel(), fit.sigma.round(4))
    [2.  1.5] [1.     0.7071]
    """
    columns, values = _checked(matrix, responses)
    is_used, pattern = patterns_of(np.isfinite(values))
    n_columns, n_patterns = columns.shape[1], is_used.shape[0]
    out = {
        name: np.full(shape, np.nan)
        for name, shape in (
            ("coefficient", (values.shape[0], n_columns)),
            ("covariance_factor", (n_patterns, n_columns, n_columns)),
            ("leverage", is_used.shape),
            ("fitted", values.shape),
            ("residual", values.shape),
            ("sequential_sum_of_squares", (values.shape[0], n_columns)),
            ("residual_sum_of_squares", values.shape[:1]),
            ("total_sum_of_squares", values.shape[:1]),
            ("prediction_sum_of_squares", values.shape[:1]),
        )
    }
    reason = np.zeros(values.shape[0], dtype=np.int8)
    degrees = np.zeros(values.shape[0], dtype=np.intp)
    for index in range(n_patterns):
        rows = slice(None) if n_patterns == 1 else np.flatnonzero(pattern == index)
        used = is_used[index]
        part, kept, n_fixed = _present(columns, used, n_baseline, block)
        degrees[rows] = part.shape[0] - kept.size
        if part.shape[0] < kept.size or _is_singular(part):
            reason[rows] = 1 if part.shape[0] < kept.size else 2
            continue
        whole = kept.size == n_columns
        basis, upper = np.linalg.qr(part)
        inverse = np.linalg.inv(upper)
        known = values[rows][:, used]
        projection = times(known, basis)
        residual = known - times(projection, basis.T)
        leverage = np.sum(basis**2, axis=1)
        coefficient = times(projection, inverse.T)
        out["coefficient"][rows] = _spread(coefficient, kept, n_columns)
        out["covariance_factor"][index][np.ix_(kept, kept)] = inverse @ inverse.T
        out["leverage"][index, used] = leverage
        # without its block a run that is missing has no level
        out["fitted"][rows] = (
            times(coefficient, columns.T)
            if whole
            else _spread(known - residual, np.flatnonzero(used), used.size)
        )
        out["residual"][rows] = _spread(residual, np.flatnonzero(used), used.size)
        out["sequential_sum_of_squares"][rows] = _spread(projection**2, kept, n_columns)
        remainder = np.sum(residual**2, axis=1)
        total = remainder + np.sum(projection[:, n_fixed:] ** 2, axis=1)
        out["residual_sum_of_squares"][rows] = remainder
        out["total_sum_of_squares"][rows] = total
        out["prediction_sum_of_squares"][rows] = np.sum(
            (residual / np.where(leverage < _FIXES_A_TERM, 1 - leverage, np.nan)) ** 2, axis=1
        )
        rounding = (_ROUNDING * np.max(np.abs(known), axis=1)) ** 2 * known.shape[1]
        reason[rows] = np.select(
            [part.shape[0] == kept.size, total <= rounding, remainder <= rounding], [3, 4, 5], 0
        )
    return LeastSquares(
        **out, is_used=is_used, pattern=pattern, degrees_of_freedom=degrees, reason=reason
    )


def _checked(matrix: ArrayLike, responses: ArrayLike) -> tuple[Floats, Floats]:
    columns = np.asarray(matrix, dtype=np.float64)
    values = np.asarray(responses, dtype=np.float64)
    if columns.ndim != 2 or values.ndim != 2 or values.shape[1:] != columns.shape[:1]:
        raise DataError(
            "the responses do not pair up with the runs",
            found=f"matrix {columns.shape}, responses {values.shape}",
            needed="(n_runs, n_columns) and (n_responses, n_runs)",
        )
    if values.shape[0] == 0:
        raise DataError("there is no response to fit", needed="at least one")
    huge = np.abs(values) > _HUGE
    if huge.any():
        raise DataError(
            "a response is infinite, or its square is",
            found=f"{int(huge.sum())} values, first {values[huge][0]:g}",
            needed="numbers, or NaN where a run is missing",
        )
    without = ~np.isfinite(columns).all(axis=1)
    valued = without & np.isfinite(values).any(axis=0)
    if valued.any():
        raise DataError(
            "a run has a response and no levels",
            found=f"run {int(np.flatnonzero(valued)[0]) + 1}",
            needed="finite levels for every run that has a value",
        )
    return columns, values


def _is_singular(columns: Floats) -> bool:
    size = np.linalg.norm(columns, axis=0)
    if not size.all():
        return True
    values = np.linalg.svd(columns / size, compute_uv=False)
    return bool(values[-1] < _SINGULAR * values[0])


def _present(
    columns: Floats, used: Bools, n_baseline: int, block: Integers | None
) -> tuple[Floats, Integers, int]:
    """Matrix of the runs used, place of its columns, and columns of its baseline."""
    part, places = columns[used], np.arange(columns.shape[1])
    if block is None or np.unique(block[used]).size in (0, n_baseline):
        return part, places, n_baseline
    contrasts = block_contrasts(block[used])
    n_fixed = 1 + contrasts.shape[1]
    part = np.hstack([part[:, :1], contrasts, part[:, n_baseline:]])
    return part, np.concatenate([places[:n_fixed], places[n_baseline:]]), n_fixed


def _spread(values: Floats, places: Integers, count: int) -> Floats:
    """Columns at their places among all, NaN elsewhere."""
    if places.size == count:
        return values
    wide = np.full((values.shape[0], count), np.nan)
    wide[:, places] = values
    return wide
