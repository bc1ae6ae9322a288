r"""Analysis of variance of response surfaces, and lack of fit.

Sources are sequential: blocks, first order, interactions, squares, as R's rsm prints them; in
a design whose levels are met exactly the order makes no difference.

References
----------
.. [1] R. V. Lenth, "Response-Surface Methods in R, Using rsm," J. Stat. Softw., vol. 32, no. 7,
   2009.
.. [2] N. R. Draper and H. Smith, Applied Regression Analysis, 3rd ed. New York: Wiley, 1998,
   sec. 2.2 (lack of fit and pure error).
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import scipy
from numpy.typing import ArrayLike
from scipy.special import fdtrc

from reduction.errors import DataError, SettingsError
from reduction.record import Integers
from reduction.surface.leastsquares import LeastSquares
from reduction.surface.parts import Anova, LackOfFit
from reduction.surface.rows import times

_LEVEL_ROUNDING = 1e-9
"""Coded levels closer than this are one level: rounding of the change of units."""


def replicate_cells(coded: ArrayLike, *, tolerance: float = 0.1) -> Integers:
    """Group runs that count as repeats of each other.

    Parameters
    ----------
    coded : array_like, shape (n_runs, n_factors)
        Coded levels as achieved; a row that is NaN is a run without levels. [1]
    tolerance : float
        Largest difference of any two runs of a cell in any factor, on the scale where the
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
    Complete linkage: no chain of near runs joins two that are far apart.  The runs of a
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

    Parameters
    ----------
    fit : LeastSquares
        The surfaces.
    cell : ndarray of int, shape (n_runs,)
        As `replicate_cells` gives them. [1]
    baseline : array_like, shape (n_runs, n_baseline)
        Columns of the mean and of the blocks, which repeats do not have to share. [1]
    tolerance : float
        With which the cells were made, for the record. [1]

    Returns
    -------
    lack_of_fit : LackOfFit
        NaN and a reason where a test cannot be made.

    Raises
    ------
    DataError
        If the cells do not pair up with the runs.

    Notes
    -----
    Repeats whose levels differ are compared by their residuals, that is, after the surface has
    moved each to the same place; for exact repeats the surface drops out and the result is
    that of [2]_.  With blocks, what is left after an additive model of blocks and cells is
    pure error (as R's rsm): it holds the scatter of a block's answer to a run.

    Examples
    --------
    A mean of runs in two cells:

    >>> from reduction.surface.fit import fit_least_squares
    >>> fit = fit_least_squares(np.ones((4, 1)), [[1.0, 2.0, 6.0, 8.0]])
    >>> found = lack_of_fit(fit, np.array([0, 0, 1, 1]), baseline=np.ones((4, 1)))
    >>> print(found.f.round(3), found.p_value.round(4))
    [24.2] [0.0389]
    """
    columns = np.asarray(baseline, dtype=np.float64)
    if cell.shape != fit.is_used.shape[1:] or columns.shape[0] != cell.size:
        raise DataError(
            "the cells do not pair up with the runs",
            found=f"{cell.size} cells, {columns.shape[0]} rows of the baseline",
            needed=f"{fit.is_used.shape[1]} runs",
        )
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


def anova_table(
    fit: LeastSquares, groups: Mapping[str, slice], lack: LackOfFit, *, n_baseline: int = 1
) -> Anova:
    """Sums of squares by source, with F and p.

    Parameters
    ----------
    fit : LeastSquares
        The surfaces; its columns stand in the order of the sources.
    groups : mapping of str to slice
        Columns of each source, in order.
    lack : LackOfFit
        Of the same surfaces.
    n_baseline : int
        Columns that are not in total: one, the mean.

    Returns
    -------
    anova : Anova
        The groups, residuals, lack of fit, pure error, total about the mean.

    Raises
    ------
    SettingsError
        If the groups do not cover the columns in order.

    Notes
    -----
    Sequential sums: each source after those above it.  Every source is tested against the
    residuals, lack of fit against pure error.

    Examples
    --------
    Four runs on a line, two of them repeated:

    >>> from reduction.surface.fit import fit_least_squares
    >>> matrix = np.stack([np.ones(4), [-1.0, -1.0, 1.0, 1.0]], axis=1)
    >>> fit = fit_least_squares(matrix, [[1.0, 2.0, 6.0, 8.0]])
    >>> lack = lack_of_fit(fit, np.array([0, 0, 1, 1]), baseline=matrix[:, :1])
    >>> found = anova_table(fit, {"first order": slice(1, 2)}, lack)
    >>> print(found.source[0], found.f[0, 0].round(3), found.p_value[0, 0].round(4))
    first order 24.2 0.0389
    """
    edges = [(part.start, part.stop) for part in groups.values()]
    joined = [n_baseline, *[stop for _, stop in edges]]
    if [start for start, _ in edges] != joined[:-1] or joined[-1] != fit.coefficient.shape[1]:
        raise SettingsError(
            "the sources do not cover the columns in order",
            found=str(edges),
            needed=f"from {n_baseline} to {fit.coefficient.shape[1]} without a gap",
        )
    none = np.where(np.isin(fit.reason, (1, 2, 6)), np.nan, 1.0)
    # the column of a block that a response does without is NaN and no degree of freedom
    stands = np.isfinite(fit.sequential_sum_of_squares)
    squares = [
        none * np.sum(fit.sequential_sum_of_squares[:, part], axis=1, where=stands[:, part])
        for part in groups.values()
    ]
    degrees = [none * stands[:, part].sum(axis=1) for part in groups.values()]
    residual_df = none * fit.degrees_of_freedom
    unexplained = [lack.sum_of_squares, lack.pure_error_sum_of_squares]
    unexplained_df = [none * lack.degrees_of_freedom, none * lack.pure_error_degrees_of_freedom]
    left = fit.residual_sum_of_squares
    sums = np.stack([*squares, left, *unexplained, np.sum([*squares, left], axis=0)], axis=1)
    total_df = np.sum([*degrees, residual_df], axis=0)
    df = np.stack([*degrees, residual_df, *unexplained_df, total_df], axis=1)
    mean_square = np.divide(sums, df, out=np.full(sums.shape, np.nan), where=df > 0)
    n_groups = len(groups)
    f, p_value = np.full(sums.shape, np.nan), np.full(sums.shape, np.nan)
    tested = fit.reason == 0
    error = mean_square[tested, n_groups, None]
    f[tested, :n_groups] = mean_square[tested, :n_groups] / error
    p_value[:, :n_groups] = fdtrc(df[:, :n_groups], df[:, n_groups, None], f[:, :n_groups])
    f[:, n_groups + 1], p_value[:, n_groups + 1] = lack.f, lack.p_value
    source = (*groups, "residuals", "lack of fit", "pure error", "total")
    against = (*(["residuals"] * n_groups), "", "pure error", "", "")
    return Anova(source, df, sums, mean_square, f, p_value, against)
