r"""Statistics of one regression at a time: tests, variance, residuals, blocks.

Analysis of variance of response surfaces.  Sources are sequential: blocks, first order,
interactions, squares, as R's rsm prints them [3]_; in a design whose levels are met exactly the
order makes no difference.

Leverage, Cook's distance, studentized residuals, and how straight their probability plot is.

statsmodels takes half a second to import: it is imported where blocks count as random, so that
what has none does not wait for it.

References
----------
.. [1] R. D. Cook and S. Weisberg, Residuals and Influence in Regression. New York: Chapman and
   Hall, 1982.
.. [2] S. S. Shapiro and R. S. Francia, "An Approximate Analysis of Variance Test for
   Normality," J. Am. Stat. Assoc., vol. 67, pp. 215-216, 1972.
.. [3] R. V. Lenth, "Response-Surface Methods in R, Using rsm," J. Stat. Softw., vol. 32, no. 7,
   2009.
.. [4] H. D. Patterson and R. Thompson, "Recovery of Inter-block Information when Block Sizes
   are Unequal," Biometrika, vol. 58, pp. 545-554, 1971.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.special import fdtrc, ndtri, stdtr

from reduction.experiments.fit_results import Anova, Diagnostics, LackOfFit, LeastSquares
from reduction.experiments.least_squares_fit import FIXES_A_TERM
from reduction.experiments.response_matrix import block_contrasts
from reduction.record.measurement import Floats, Integers

_NO_RATIO, _ALL_BETWEEN = 1e-8, 1e6
"""Ratio of variances below which the search for it has come to nil, and the largest."""


@dataclass(frozen=True)
class Regression:
    """Least squares of one response; with a covariance of its runs, of both made independent."""

    basis: Floats
    """Orthogonal columns of the matrix, (n_runs, n_columns)."""
    effect: Floats
    """Of each of these columns, (n_columns,)."""
    coefficient: Floats
    covariance_factor: Floats
    residual: Floats
    """Of the runs as they are, (n_runs,)."""
    sum_of_squares: float
    degrees_of_freedom: int

    @property
    def variance(self) -> float:
        """Of the residuals."""
        return float(np.divide(self.sum_of_squares, self.degrees_of_freedom))

    @property
    def standard_uncertainty(self) -> Floats:
        """Of the coefficients."""
        return np.asarray(np.sqrt(np.diagonal(self.covariance_factor) * self.variance))

    @property
    def t(self) -> Floats:
        """Student's, of each coefficient."""
        return np.asarray(self.coefficient / self.standard_uncertainty)

    @property
    def p_value(self) -> Floats:
        """Of each coefficient."""
        return np.asarray(2 * stdtr(self.degrees_of_freedom, -np.abs(self.t)))

    def f_test(self, sum_of_squares: float, n_terms: int) -> tuple[float, float]:
        """F and p of what several terms explain."""
        f = sum_of_squares / n_terms / self.variance
        return f, float(fdtrc(n_terms, self.degrees_of_freedom, f))


Regressions = Mapping[int, Regression]
"""By the row of their response; there is none where there is no surface."""


def regress(response: Floats, matrix: Floats, covariance: Floats | None = None) -> Regression:
    """Least squares of one response, generalized where its runs share a covariance."""
    target, columns = response, matrix
    if covariance is not None:
        root = np.linalg.cholesky(covariance)
        target, columns = np.linalg.solve(root, response), np.linalg.solve(root, matrix)
    basis, triangle = np.linalg.qr(columns)
    effect = basis.T @ target
    coefficient, half = np.linalg.solve(triangle, effect), np.linalg.inv(triangle)
    left = target - basis @ effect
    return Regression(
        basis, effect, coefficient, half @ half.T, response - matrix @ coefficient,
        float(left @ left), len(matrix) - matrix.shape[1],
    )  # fmt: skip


def regress_each(
    values: Floats, matrix: Floats, fit: LeastSquares, n_baseline: int, block: Integers | None
) -> Regressions:
    """Regression of each response that has a surface, on the contrasts of its own blocks."""
    found = {}
    for row in np.flatnonzero(np.isin(fit.reason, (0, 3, 4, 5))).tolist():
        used = fit.is_used[fit.pattern[row]]
        part = matrix[used]
        if block is not None:
            part = np.hstack([part[:, :1], block_contrasts(block[used]), part[:, n_baseline:]])
        found[row] = regress(values[row, used], part)
    return found


def anova_table(
    regressions: Regressions, groups: Mapping[str, slice], fit: LeastSquares, lack: LackOfFit
) -> Anova:
    """Sums of squares by source, with F and p.

    Notes
    -----
    Sequential sums: each source after those above it, as tests of columns that are orthogonal.
    Every source is tested against the residuals, lack of fit against pure error.
    """
    n_groups = len(groups)
    table = np.full((4, fit.reason.size, n_groups + 4), np.nan)
    for row, result in regressions.items():
        n_columns = result.effect.size
        # behind the mean; a response may have fewer blocks
        edges = [1, *(part.stop - fit.coefficient.shape[1] + n_columns for part in groups.values())]
        for at, (start, stop) in enumerate(pairwise(edges)):
            explained = float(np.sum(result.effect[start:stop] ** 2))
            table[:2, row, at] = stop - start, explained
            if stop > start and fit.reason[row] == 0:
                table[2:, row, at] = result.f_test(explained, stop - start)
        table[:2, row, n_groups] = result.degrees_of_freedom, result.sum_of_squares
        table[:2, row, n_groups + 3] = table[:2, row, : n_groups + 1].sum(axis=1)
        table[:, row, n_groups + 1] = (
            lack.degrees_of_freedom[row], lack.sum_of_squares[row], lack.f[row], lack.p_value[row]
        )  # fmt: skip
        table[:2, row, n_groups + 2] = (
            lack.pure_error_degrees_of_freedom[row], lack.pure_error_sum_of_squares[row]
        )  # fmt: skip
    degrees, sums, f, p_value = table
    mean_square = np.divide(sums, degrees, out=np.full(sums.shape, np.nan), where=degrees > 0)
    source = (*groups, "residuals", "lack of fit", "pure error", "total")
    against = (*(["residuals"] * n_groups), "", "pure error", "", "")
    return Anova(source, degrees, sums, mean_square, f, p_value, against)


def diagnose(regressions: Regressions, fit: LeastSquares) -> Diagnostics:
    r"""Look at the residuals of every run of every surface.

    .. math::

        r_i = \frac{e_i}{s \sqrt{1 - h_i}}, \qquad
        t_i = r_i \sqrt{\frac{n - p - 1}{n - p - r_i^2}}, \qquad
        D_i = \frac{r_i^2}{p} \frac{h_i}{1 - h_i}

    Notes
    -----
    Source: [1]_; the correlation of [2]_ is with the scores of Blom.  Fifteen residuals of a
    surface of ten terms have five degrees of freedom among them and look more normal than the
    scatter is: a low correlation says something, a high one little.
    """
    leverage = fit.leverage[fit.pattern]
    found = np.full((3, *leverage.shape), np.nan)
    straightness = np.full(fit.reason.size, np.nan)
    for row, result in regressions.items():
        freedom = result.degrees_of_freedom
        used = np.isfinite(leverage[row])
        of_run = np.sum(result.basis**2, axis=1)
        own = leverage[row, used] < FIXES_A_TERM
        with np.errstate(divide="ignore", invalid="ignore"):
            inner = np.where(own, result.residual / np.sqrt(result.variance * (1 - of_run)), np.nan)
            distance = inner**2 / result.effect.size * of_run / (1 - of_run)
            without = freedom - inner**2
            outer = inner * np.sqrt((freedom - 1) / np.where(without > 1e-9 * freedom, without, 0))
        found[:, row, used] = distance, inner, outer if freedom > 1 else np.nan * outer
        ordered = np.sort(inner[own])
        if ordered.size > 2:
            score = ndtri((np.arange(1, ordered.size + 1) - 0.375) / (ordered.size + 0.25))
            straightness[row] = np.corrcoef(ordered, score)[0, 1] ** 2
    distance, inner, outer = found
    return Diagnostics(leverage, distance, inner, outer, straightness)


def term_tests(
    regressions: Regressions, fit: LeastSquares, column: Integers
) -> tuple[Floats, Floats, Floats, Floats]:
    """Student's t and p of each term at its column, F and p of all terms but the mean."""
    t, p_value = np.full((2, fit.reason.size, column.size), np.nan)
    overall_f, overall_p_value = np.full((2, fit.reason.size), np.nan)
    # from the end: a response may have fewer blocks
    place = np.where(column > 0, column - fit.coefficient.shape[1], 0)
    for row, result in regressions.items():
        t[row], p_value[row] = result.t[place], result.p_value[place]
        own = slice(1 - column.size, None)
        explained = result.coefficient[own] @ np.linalg.solve(
            result.covariance_factor[own, own], result.coefficient[own]
        )
        overall_f[row], overall_p_value[row] = result.f_test(float(explained), column.size - 1)
    return t, p_value, overall_f, overall_p_value


def ratio_of_variances(response: Floats, matrix: Floats, block: Integers) -> float:
    """Variance between blocks over that within, by restricted maximum likelihood [4]_."""
    from statsmodels.regression.mixed_linear_model import (  # type: ignore[import-untyped]
        MixedLM,
    )

    # warnings are of a variance that is nil, which is an answer
    with warnings.catch_warnings(), np.errstate(divide="ignore", invalid="ignore"):
        warnings.simplefilter("ignore")
        try:
            found = MixedLM(response, matrix, groups=block).fit(
                reml=True, method="powell", xtol=1e-12, ftol=1e-14
            )
            ratio = float(np.nan_to_num(found.cov_re[0, 0] / found.scale))
        except np.linalg.LinAlgError:
            ratio = _ALL_BETWEEN  # where runs of a block do not scatter
    return min(ratio, _ALL_BETWEEN) if ratio > _NO_RATIO else 0.0
