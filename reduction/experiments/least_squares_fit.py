r"""Least squares of many responses at once, F of a printed r2, and lack of fit.

**Least squares of one or ten thousand responses on one matrix, by one orthogonal factorisation**:

.. math::

    X = QR, \qquad b = R^{-1} Q^T y, \qquad \operatorname{cov} b = s^2 (R^T R)^{-1}, \qquad
    s^2 = \frac{\lVert y - Q Q^T y \rVert^2}{n - p}

Responses that miss the same runs are solved together; the loop is over the patterns of
missing runs, not over responses.

**F statistic of a whole surface from its r2: the correct one, and the one the report prints.** As
printed, [2]_ computes :math:`F = (r^2 / 10) / ((1 - r^2) / 4)` for fifteen runs and ten terms,
which counts the mean twice, and compares it with 3.48, which is the 5 % point for 4 and 10 degrees
of freedom, transposed.  As computed, r2 is about the mean: 9 and 5.  The two errors nearly cancel
(3.48 against 3.44 on the printed scale).

References
----------
.. [1] N. R. Draper and H. Smith, Applied Regression Analysis, 3rd ed. New York: Wiley, 1998,
   sec. 2.2 (lack of fit and pure error).
.. [2] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.3, Tables 3-5 and 11-19.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy
from numpy.typing import ArrayLike
from scipy.special import fdtrc, fdtri, stdtr

from reduction.experiments.fit_results import LackOfFit, LeastSquares
from reduction.experiments.response_matrix import block_contrasts, patterns_of, times
from reduction.experiments.run_sheet import is_singular
from reduction.record.contributions import CONFIDENCE
from reduction.record.errors import DataError, SettingsError
from reduction.record.measurement import Bools, Floats, Integers

_ROUNDING = 1e-12
"""Residuals smaller than this fraction of the response are rounding errors."""

_HUGE = 1e150
"""Larger numbers cannot be squared."""

FIXES_A_TERM = 1 - 1e-9
"""Leverage from which a run determines its own fit and has no residual to examine."""


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
        NaN where t or the degrees of freedom are missing or zero. [1]

    Notes
    -----
    The tail below -``|t|`` keeps its digits where p is small; one less a distribution function does
    not.

    Examples
    --------
    2.571 is the 5 % point for 5 degrees of freedom:

    >>> print(two_sided_p(2.570582, 5).round(4))
    0.05
    """
    nu = np.asarray(degrees_of_freedom, dtype=np.float64)
    return np.asarray(2 * stdtr(np.where(nu > 0, nu, np.nan), -np.abs(t)))


def fit_least_squares(
    matrix: ArrayLike,
    responses: ArrayLike,
    *,
    n_baseline: int = 1,
    block: Integers | None = None,
) -> LeastSquares:
    """Fit every response to the columns of a matrix, with the inputs for tests of the fit.

    Parameters
    ----------
    matrix : array_like, shape (n_runs, n_columns)
        Model matrix, baseline columns (the mean, blocks) first; sums of squares are
        sequential in its order. A row that is NaN is a run without levels. [1]
    responses : array_like, shape (n_responses, n_runs)
        NaN where a run is missing. [unit of the response]
    n_baseline : int
        Number of columns about which r2 is taken.
    block : ndarray of int, shape (n_runs,), optional
        Block of each run, from 0, where the baseline after the mean holds its contrasts. [1]

    Returns
    -------
    fit : LeastSquares
        NaN and a reason for a response whose runs do not support the columns.

    Raises
    ------
    DataError
        If the shapes do not pair up, a response is infinite, or a run has a value but no
        levels.

    Notes
    -----
    A response that misses runs is fitted to those it has, with its own leverage, covariance and
    degrees of freedom.  Where it misses a whole block, its mean is that over the
    remaining blocks, and the columns of missing blocks have no coefficient.  Residuals
    below 1e-12 of the response are rounding errors.

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
        # the level of a missing run without its block is unknown
        out["fitted"][rows] = (
            times(coefficient, columns.T)
            if whole
            else _spread(known - residual, np.flatnonzero(used), used.size)
        )
        out["residual"][rows] = _spread(residual, np.flatnonzero(used), used.size)
        remainder = np.sum(residual**2, axis=1)
        total = remainder + np.sum(projection[:, n_fixed:] ** 2, axis=1)
        out["residual_sum_of_squares"][rows] = remainder
        out["total_sum_of_squares"][rows] = total
        out["prediction_sum_of_squares"][rows] = np.sum(
            (residual / np.where(leverage < FIXES_A_TERM, 1 - leverage, np.nan)) ** 2, axis=1
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
    """Matrix of the runs used, place of its columns, and number of its baseline columns."""
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


class _OverallF(NamedTuple):
    """Statistics of one r2: the correct test, and the one the report printed.

    ``critical`` and ``printed_critical`` are on the scale of their own statistic.
    """

    f: Floats
    p_value: Floats
    critical: Floats
    printed_f: Floats
    printed_critical: Floats


def statistics_from_r2(r2: ArrayLike, *, n_runs: ArrayLike, n_terms: int) -> _OverallF:
    r"""Overall F of a surface from its r2, and the statistic printed in CG-D-39-80.

    .. math::

        F = \frac{r^2 / (p - 1)}{(1 - r^2) / (n - p)}, \qquad
        F_{printed} = \frac{r^2 / p}{(1 - r^2) / (n - p - 1)}

    Parameters
    ----------
    r2 : array_like, shape (...)
        About the mean. [1]
    n_runs : array_like, shape (...)
        Number of runs fitted. [1]
    n_terms : int
        Including the mean; at least two.

    Returns
    -------
    statistics : OverallF
        f, p_value, critical; printed_f and printed_critical, which is the critical value as
        looked up in the report, with its degrees of freedom transposed.

    Raises
    ------
    SettingsError
        If there are fewer than two terms.

    Notes
    -----
    Source: [2]_, Tables 3-5 and 11-19: 54 of 58 printed statistics follow from the printed r2
    and 10 and 4 degrees of freedom within its rounding, 3 from 9 and 5.  The text "if F-Stat >
    F-Crit the data fits equation 5 with 95 % confidence" does not state the result of the test,
    which is that not all slopes are zero.  NaN where no degree of freedom is left.

    Examples
    --------
    Polyester, new, K_ap: 26.98 is printed for r2 = 0.985, which may be 0.9845 to 0.9855:

    >>> print(statistics_from_r2([0.9845, 0.9855], n_runs=15, n_terms=10).printed_f.round(2))
    [25.41 27.19]

    >>> found = statistics_from_r2(0.985, n_runs=15, n_terms=10)
    >>> print(found.printed_f.round(2), found.printed_critical.round(2))
    26.27 3.48
    >>> print(found.f.round(2), found.critical.round(2), found.p_value.round(4))
    36.48 4.77 0.0005
    """
    if n_terms < 2:
        raise SettingsError("a surface of the mean alone has no F", needed="two or more terms")
    share = np.asarray(r2, dtype=np.float64)
    runs = np.asarray(n_runs, dtype=np.float64)
    above, below = n_terms - 1.0, _positive_or_nan(runs - n_terms)
    printed_below = _positive_or_nan(runs - n_terms - 1)
    # critical values are slow to compute, and there are few different numbers of runs
    different, which = np.unique(runs, return_inverse=True)
    right = fdtri(above, _positive_or_nan(different - n_terms), CONFIDENCE)
    transposed = fdtri(_positive_or_nan(different - n_terms - 1), n_terms, CONFIDENCE)
    none_left = np.where(share >= 1, np.inf, np.nan)
    odds = np.divide(share, 1 - share, out=none_left, where=share < 1)
    f = odds * below / above
    return _OverallF(
        f,
        np.asarray(fdtrc(above, below, f), dtype=np.float64),
        np.asarray(right[which.reshape(runs.shape)]),
        odds * printed_below / n_terms,
        np.asarray(transposed[which.reshape(runs.shape)]),
    )


def _positive_or_nan(values: Floats) -> Floats:
    return np.where(values > 0, values, np.nan)


_LEVEL_ROUNDING = 1e-9
"""Coded levels closer than this are equal apart from rounding in the change of units."""


def replicate_cells(coded: ArrayLike, *, tolerance: float = 0.1) -> Integers:
    """Group runs that count as repeats of each other.

    Parameters
    ----------
    coded : array_like, shape (n_runs, n_factors)
        Coded levels as achieved; a row that is NaN is a run without levels. [1]
    tolerance : float
        Largest difference of any two runs of a cell in any factor, on the scale on which the
        range of a factor is 2. [1]

    Returns
    -------
    cell : ndarray of int, shape (n_runs,)
        Numbered from 0 in the order of their first run; -1 for a run without levels. [1]

    Raises
    ------
    SettingsError
        If the tolerance is negative or reaches half the step of a design.

    Notes
    -----
    Complete linkage: no chain of close runs joins two that are far apart.  The runs of a
    Box-Behnken design are 1 apart.

    Examples
    --------
    >>> print(replicate_cells([[0.0, 1.0], [0.02, -0.01], [-0.03, 0.0], [np.nan, 0.0]]))
    [ 0  1  1 -1]
    """
    if not 0 <= tolerance < 0.5:
        raise SettingsError(
            "the tolerance of repeated runs is out of range",
            found=f"{tolerance:g}",
            needed="0 or more, below 0.5 in coded units",
        )
    levels = np.asarray(coded, dtype=np.float64)
    cell = np.full(levels.shape[0], -1)
    known = np.flatnonzero(np.isfinite(levels).all(axis=1))
    if known.size < 2:
        cell[known] = 0
        return cell
    tree = scipy.cluster.hierarchy.linkage(levels[known], method="complete", metric="chebyshev")
    label = scipy.cluster.hierarchy.fcluster(
        tree, tolerance + _LEVEL_ROUNDING, criterion="distance"
    )
    _, first, number = np.unique(label, return_index=True, return_inverse=True)
    cell[known] = np.argsort(np.argsort(first))[number]
    return cell


def lack_of_fit(
    fit: LeastSquares, cell: Integers, *, baseline: ArrayLike, tolerance: float = 0.1
) -> LackOfFit:
    r"""Test whether runs scatter more about the surface than repeats do among themselves.

    .. math::

        SS_{pure} = \sum_i (e_i - \bar e_{cell(i)})^2, \qquad
        SS_{lack} = \sum_i e_i^2 - SS_{pure}, \qquad
        F = \frac{SS_{lack} / (m - p)}{SS_{pure} / (n - m)}

    Notes
    -----
    Repeats whose levels differ are compared by their residuals, that is, after the surface has
    moved each to the same place; for exact repeats the surface drops out and the result is
    that of [1]_.  With blocks, pure error is the residual of an additive model of blocks and
    cells (as in R's rsm): it includes the scatter in the response of a block to a run.

    Examples
    --------
    A mean of runs in two cells:

    >>> from reduction.experiments.least_squares_fit import fit_least_squares
    >>> fit = fit_least_squares(np.ones((4, 1)), [[1.0, 2.0, 6.0, 8.0]])
    >>> found = lack_of_fit(fit, np.array([0, 0, 1, 1]), baseline=np.ones((4, 1)))
    >>> print(found.f.round(3), found.p_value.round(4))
    [24.2] [0.0389]
    """
    columns = np.asarray(baseline, dtype=np.float64)
    n_responses = fit.reason.size
    pure_df = np.zeros(n_responses, dtype=np.intp)
    pure = np.full(n_responses, np.nan)
    indicator = (cell[:, None] == np.unique(cell[cell >= 0])).astype(np.float64)
    for index, used in enumerate(fit.is_used):
        rows = slice(None) if len(fit.is_used) == 1 else np.flatnonzero(fit.pattern == index)
        left, values, _ = np.linalg.svd(np.hstack([indicator, columns])[used], full_matrices=False)
        basis = left[:, values > 1e-9 * values[0]] if values.size else left
        pure_df[rows] = int(used.sum()) - basis.shape[1]
        residual = fit.residual[rows][:, used]
        left_over = residual - times(times(residual, basis), basis.T)
        pure[rows] = np.sum(left_over**2, axis=1)
    lack_df = fit.degrees_of_freedom - pure_df
    lack = fit.residual_sum_of_squares - pure
    scale = np.maximum(fit.total_sum_of_squares, fit.residual_sum_of_squares)
    reason = np.select(
        [fit.reason > 0, pure_df <= 0, lack_df <= 0, pure <= 1e-24 * scale], [4, 1, 2, 3], 0
    ).astype(np.int8)
    tested = reason == 0
    f = np.full(n_responses, np.nan)
    f[tested] = (lack[tested] / lack_df[tested]) / (pure[tested] / pure_df[tested])
    p_value = np.asarray(fdtrc(np.maximum(lack_df, 1), np.maximum(pure_df, 1), f), dtype=np.float64)
    return LackOfFit(lack_df, pure_df, lack, pure, f, p_value, reason, cell, tolerance)
