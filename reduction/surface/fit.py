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

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import DataError
from reduction.record import Bools, Floats, Integers
from reduction.surface.leastsquares import LeastSquares
from reduction.surface.rows import block_contrasts, patterns_of, times
from reduction.surface.student import student_p
from reduction.surface.variance import is_singular

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
        if part.shape[0] < kept.size or is_singular(part):
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
