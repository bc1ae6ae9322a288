r"""Statistics of one regression at a time, by statsmodels: tests, variance, residuals, blocks.

Analysis of variance of response surfaces.  Sources are sequential: blocks, first order,
interactions, squares, as R's rsm prints them [3]_; in a design whose levels are met exactly the
order does not matter.

Leverage, Cook's distance, studentized residuals, and how straight their probability plot is.

statsmodels takes half a second to import: it is imported when the first regression is fitted,
so that a reduction without fits does not wait for it.

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
from itertools import pairwise
from typing import Any

import numpy as np
from scipy.special import fdtrc, ndtri

from reduction.experiments.fit_results import (
    Anova,
    Diagnostics,
    LackOfFit,
    LeastSquares,
    ScatterOfPulls,
)
from reduction.experiments.least_squares_fit import FIXES_A_TERM
from reduction.experiments.response_matrix import block_contrasts
from reduction.record.measurement import Floats, Integers

_NO_RATIO, _ALL_BETWEEN = 1e-8, 1e6
"""Ratio of variances below which the search counts as having reached zero, and the largest."""

Regressions = Mapping[int, Any]
"""Results of statsmodels by row of the response; none where there is no surface."""


def regress(response: Floats, matrix: Floats, covariance: Floats | None = None) -> Any:
    """Least squares of one response, generalized where its runs share a covariance."""
    from statsmodels.regression.linear_model import GLS, OLS

    model = OLS(response, matrix) if covariance is None else GLS(response, matrix, covariance)
    return model.fit()


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
    regressions: Regressions,
    groups: Mapping[str, slice],
    fit: LeastSquares,
    lack: LackOfFit,
    judged: ScatterOfPulls | None = None,
) -> Anova:
    """Sums of squares by source, with F and p.

    Notes
    -----
    Sequential sums: each source after those above it, like tests of orthogonal columns.
    Every source is tested against the residuals, and lack of fit against pure error.  Where
    specimens were pulled together, the residuals are those of the means of the pulls, and blocks
    are tested against the differences within pulls.
    """
    n_groups = len(groups)
    table = np.full((4, fit.reason.size, n_groups + 4), np.nan)
    for row, result in regressions.items():
        orthogonal = regress(result.model.endog, np.linalg.qr(result.model.exog)[0])
        n_columns = orthogonal.params.size
        # after the mean; a response may have fewer blocks
        edges = [1, *(part.stop - fit.coefficient.shape[1] + n_columns for part in groups.values())]
        for at, (start, stop) in enumerate(pairwise(edges)):
            table[:2, row, at] = stop - start, np.sum(orthogonal.params[start:stop] ** 2)
            if stop > start and fit.reason[row] == 0:
                test = orthogonal.f_test(np.eye(n_columns)[start:stop])
                table[2:, row, at] = test.fvalue, test.pvalue
        table[:2, row, n_groups] = result.df_resid, result.ssr
        table[:2, row, n_groups + 3] = table[:2, row, : n_groups + 1].sum(axis=1)
        table[:, row, n_groups + 1] = (
            lack.degrees_of_freedom[row], lack.sum_of_squares[row], lack.f[row], lack.p_value[row]
        )  # fmt: skip
        table[:2, row, n_groups + 2] = (
            lack.pure_error_degrees_of_freedom[row], lack.pure_error_sum_of_squares[row]
        )  # fmt: skip
    source = (*groups, "residuals", "lack of fit", "pure error", "total")
    against = (*(["residuals"] * n_groups), "", "pure error", "", "")
    if judged is not None:
        table = _between_pulls(table, list(groups), judged)
        source = (*source[:-1], "within pulls", "total")
        against = tuple("within pulls" if one == "blocks" else "residuals" for one in groups)
        against = (*against, "", "pure error", "", "", "")
    degrees, sums, f, p_value = table
    mean_square = np.divide(sums, degrees, out=np.full(sums.shape, np.nan), where=degrees > 0)
    return Anova(source, degrees, sums, mean_square, f, p_value, against)


def _between_pulls(table: Floats, groups: list[str], judged: ScatterOfPulls) -> Floats:
    """Analysis of variance whose residuals are those of pulls, with a row within them."""
    n_groups = len(groups)
    within = table[:, :, n_groups].copy()
    within[2:] = np.nan
    within[0] -= judged.degrees_of_freedom
    within[1] -= judged.sum_of_squares
    # a response whose pulls cannot be judged keeps the residuals of its runs
    within[:, ~judged.is_used] = np.nan
    table[0, judged.is_used, n_groups] = judged.degrees_of_freedom[judged.is_used]
    table[1, judged.is_used, n_groups] = judged.sum_of_squares[judged.is_used]
    with np.errstate(divide="ignore", invalid="ignore"):
        for at, name in enumerate(groups):
            df, error = within[:2] if name == "blocks" else table[:2, :, n_groups]
            f = table[1, :, at] / table[0, :, at] / (error / df)
            used = judged.is_used & np.isfinite(table[2, :, at]) & (df > 0)
            table[2, used, at] = f[used]
            table[3, used, at] = fdtrc(table[0, used, at], df[used], f[used])
    return np.insert(table, table.shape[2] - 1, within, axis=2)


def diagnose(regressions: Regressions, fit: LeastSquares) -> Diagnostics:
    r"""Examine the residuals of every run of every surface.

    .. math::

        r_i = \frac{e_i}{s \sqrt{1 - h_i}}, \qquad
        t_i = r_i \sqrt{\frac{n - p - 1}{n - p - r_i^2}}, \qquad
        D_i = \frac{r_i^2}{p} \frac{h_i}{1 - h_i}

    Notes
    -----
    Source: [1]_; the correlation of [2]_ uses Blom's scores.  Fifteen residuals of a surface
    of ten terms have five degrees of freedom between them and look more normal than the
    scatter is: a low correlation means something, a high one little.
    """
    leverage = fit.leverage[fit.pattern]
    found = np.full((3, *leverage.shape), np.nan)
    straightness = np.full(fit.reason.size, np.nan)
    for row, result in regressions.items():
        influence, freedom = result.get_influence(), result.df_resid
        used = np.isfinite(leverage[row])
        own = leverage[row, used] < FIXES_A_TERM
        with np.errstate(divide="ignore", invalid="ignore"):
            inner = np.where(own, influence.resid_studentized_internal, np.nan)
            distance = np.where(own, influence.cooks_distance[0], np.nan)
            # statsmodels refits without each run, which fails without a run that fixes a term
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
    """Student's t and p of each term at its column; F and p of all terms but the mean."""
    t, p_value = np.full((2, fit.reason.size, column.size), np.nan)
    overall_f, overall_p_value = np.full((2, fit.reason.size), np.nan)
    # counted from the end: a response may have fewer blocks
    place = np.where(column > 0, column - fit.coefficient.shape[1], 0)
    for row, result in regressions.items():
        t[row], p_value[row] = result.tvalues[place], result.pvalues[place]
        overall = result.f_test(np.eye(result.params.size)[1 - column.size :])
        overall_f[row], overall_p_value[row] = overall.fvalue, overall.pvalue
    return t, p_value, overall_f, overall_p_value


def ratio_of_variances(response: Floats, matrix: Floats, block: Integers) -> float:
    """Variance between blocks over that within, by restricted maximum likelihood [4]_."""
    from statsmodels.regression.mixed_linear_model import MixedLM

    # the warnings concern a variance of zero, which is a valid answer
    with warnings.catch_warnings(), np.errstate(divide="ignore", invalid="ignore"):
        warnings.simplefilter("ignore")
        try:
            found = MixedLM(response, matrix, groups=block).fit(
                reml=True, method="powell", xtol=1e-12, ftol=1e-14
            )
            ratio = float(np.nan_to_num(found.cov_re[0, 0] / found.scale))
        except np.linalg.LinAlgError:
            ratio = _ALL_BETWEEN  # where the runs of a block do not scatter
    return min(ratio, _ALL_BETWEEN) if ratio > _NO_RATIO else 0.0
