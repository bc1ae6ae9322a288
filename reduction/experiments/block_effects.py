r"""Several specimens in one surface: fixed blocks, or draws from a population (REML).

.. math::

    y = X\beta + Zu + e, \qquad u \sim N(0, \sigma_u^2 I), \quad e \sim N(0, \sigma^2 I), \qquad
    V = \sigma^2 (I + \gamma Z Z^T)

Fixed blocks describe these specimens; random blocks predict the next specimen of the line, with
the scatter between specimens included in the uncertainty of the mean.

References
----------
.. [1] H. D. Patterson and R. Thompson, "Recovery of Inter-block Information when Block Sizes
   are Unequal," Biometrika, vol. 58, pp. 545-554, 1971.
.. [2] J. C. Pinheiro and D. M. Bates, Mixed-Effects Models in S and S-PLUS. New York: Springer,
   2000, sec. 2.4 (degrees of freedom of the levels of grouping).
.. [3] G. E. P. Box, J. S. Hunter, and W. G. Hunter, Statistics for Experimenters, 2nd ed.
   Hoboken, NJ: Wiley, 2005, ch. 9 (split plots).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from reduction.experiments.designs import engineering_matrix
from reduction.experiments.fit_results import (
    BlockEffects,
    LackOfFit,
    LeastSquares,
    ScatterOfPulls,
)
from reduction.experiments.least_squares_fit import (
    fit_least_squares,
    lack_of_fit,
    replicate_cells,
    two_sided_p,
)
from reduction.experiments.response_matrix import block_contrasts
from reduction.experiments.run_sheet import is_singular, variance_factor
from reduction.experiments.surface_statistics import ratio_of_variances, regress
from reduction.record.errors import DataError
from reduction.record.measurement import Bools, Floats, Integers, read_only_arrays

_SINGULAR = 1e-9


@dataclass(frozen=True)
@read_only_arrays
class _RandomIntercept:
    """Surfaces with one random level per block."""

    coefficient: Floats
    covariance_factor: Floats
    sigma: Floats
    standard_deviation: Floats
    effect: Floats
    degrees_of_freedom: Floats
    t: Floats
    is_between: Bools
    at_boundary: Bools


def block_columns(labels: Sequence[str]) -> tuple[tuple[str, ...], Integers, Floats]:
    """Columns for fixed blocks that keep the mean equal to the mean over the blocks.

    Parameters
    ----------
    labels : sequence of str, length n_runs
        Block of each run.

    Returns
    -------
    names : tuple of str, length n_blocks
        In the order of their first run.
    index : ndarray of int, shape (n_runs,)
        Block of each run. [1]
    columns : ndarray, shape (n_runs, n_blocks - 1)
        1 in a block, -1 in the last one: effects add up to zero. [1]

    Raises
    ------
    DataError
        If there are fewer than two blocks.

    Notes
    -----
    Each block has the same weight in the mean, whatever its number of runs.

    Examples
    --------
    >>> names, index, columns = block_columns(["line 2", "line 1", "line 2"])
    >>> print(names, index, columns.ravel())
    ('line 2', 'line 1') [0 1 0] [ 1. -1.  1.]
    """
    names = tuple(dict.fromkeys(labels))
    if len(names) < 2:
        raise DataError(
            "there is one block and nothing to compare it with",
            found=", ".join(names) or "no run",
            needed="two blocks or more",
            hint="Leave the blocks out.",
        )
    index = np.array([names.index(label) for label in labels])
    return names, index, block_contrasts(index)


def _fit_random_intercept(
    matrix: ArrayLike, responses: ArrayLike, *, block: Integers
) -> _RandomIntercept:
    """Restricted maximum likelihood for surfaces with one random level per block.

    Notes
    -----
    Source: [1]_.  The ratio of the two variances maximises the restricted likelihood, and may be
    zero; the surface is the generalized least squares fit with that ratio.  Degrees of freedom
    as in [2]_.  A block's own response to a factor (its slope) is not modelled: it is in sigma.

    Examples
    --------
    Two blocks of two runs, balanced: the variance between blocks equals that of the analysis of
    variance, (MS_between - MS_within) / 2 = (16 - 1) / 2.

    >>> fit = _fit_random_intercept(np.ones((4, 1)), [[1.0, 1.0 + 2**0.5, 5.0, 5.0 + 2**0.5]],
    ...     block=np.array([0, 0, 1, 1]))
    >>> print((fit.standard_deviation**2).round(5), (fit.sigma**2).round(5))
    [7.5] [1.]
    """
    columns, values = np.asarray(matrix, dtype=np.float64), np.asarray(responses, dtype=np.float64)
    n_blocks, n_columns = int(block.max()) + 1, columns.shape[1]
    member = (block[:, None] == np.arange(n_blocks)).astype(np.float64)
    shape = (values.shape[0], n_columns)
    coefficient, t, freedom = np.full((3, *shape), np.nan)
    factor = np.full((*shape, n_columns), np.nan)
    ratio, sigma = np.full((2, shape[0]), np.nan)
    effect = np.full((shape[0], n_blocks), np.nan)
    known = np.isfinite(columns).all(axis=1)
    is_between = _is_between(columns[known], member[known])
    for row, used in enumerate(np.isfinite(values)):
        part, of_block, response = columns[used], member[used], values[row, used]
        if len(part) <= n_columns or is_singular(part):
            continue
        rank = np.linalg.matrix_rank(np.hstack([part, of_block]))
        # levels that the terms absorb have no scatter of their own
        ratio[row] = ratio_of_variances(response, part, block[used]) if rank > n_columns else 0.0
        found = regress(response, part, np.eye(len(part)) + ratio[row] * of_block @ of_block.T)
        coefficient[row], factor[row] = found.params, found.normalized_cov_params
        sigma[row] = np.sqrt(found.scale)
        with np.errstate(divide="ignore", invalid="ignore"):
            t[row] = found.tvalues
        count = of_block.sum(axis=0)
        level = ratio[row] / (1 + ratio[row] * count) * (found.resid @ of_block)
        effect[row] = np.where(count > 0, level, np.nan)
        between = int((count > 0).sum()) - int(is_between.sum())
        freedom[row] = np.where(is_between, between, len(part) - rank)
    freedom[freedom <= 0] = np.nan
    return _RandomIntercept(
        coefficient, factor, sigma, np.sqrt(ratio) * sigma, effect, freedom, t, is_between,
        ratio == 0,
    )  # fmt: skip


def _is_between(columns: Floats, member: Floats) -> Bools:
    """Columns that are constant inside every block."""
    mean = (member.T @ columns) / np.maximum(member.sum(axis=0), 1)[:, None]
    return np.asarray(np.abs(columns - member @ mean).max(axis=0) < _SINGULAR)


@dataclass(frozen=True)
class _Estimates:
    """Coefficients in printed order and what they are judged by."""

    coefficient: Floats
    covariance_factor: Floats
    pattern: Integers
    sigma: Floats
    degrees_of_freedom: Floats
    t: Floats
    p_value: Floats
    error_term: tuple[str, ...]


def fixed_estimates(fit: LeastSquares, column: Integers, t: Floats, p_value: Floats) -> _Estimates:
    """Least squares estimates in printed order."""
    freedom = np.where(fit.degrees_of_freedom > 0, fit.degrees_of_freedom, np.nan)
    return _Estimates(
        fit.coefficient[:, column],
        fit.covariance_factor[:, column[:, None], column],
        fit.pattern,
        fit.sigma,
        np.repeat(freedom[:, None], column.size, axis=1),
        t,
        p_value,
        ("residuals",) * column.size,
    )


def with_blocks(
    fixed: _Estimates,
    fit: LeastSquares,
    surface: Floats,
    values: Floats,
    names: tuple[str, ...],
    index: Integers,
    treatment: Literal["fixed", "random"],
) -> tuple[_Estimates, BlockEffects]:
    """Estimates for the chosen treatment of the blocks, and the blocks' own levels."""
    n_responses = len(values)
    if treatment == "fixed":
        # level of each block's runs above the surface, also where a response lacks a block
        above = values - fixed.coefficient @ np.nan_to_num(surface).T
        member = (index == np.arange(len(names))[:, None]) & np.isfinite(values)[:, None]
        count = member.sum(axis=2)
        level = np.where(member, above[:, None], 0.0).sum(axis=2)
        effect = np.divide(level, count, out=np.full(level.shape, np.nan), where=count > 0)
        none, inside = np.full(n_responses, np.nan), np.zeros(n_responses, dtype=bool)
        return fixed, BlockEffects(names, index, treatment, effect, none, inside)
    mixed = _fit_random_intercept(surface, values, block=index)
    t = np.where(fit.reason[:, None] == 0, mixed.t, np.nan)
    terms = tuple("blocks" if between else "residuals" for between in mixed.is_between)
    estimates = _Estimates(
        mixed.coefficient,
        mixed.covariance_factor,
        np.arange(n_responses),
        mixed.sigma,
        mixed.degrees_of_freedom,
        t,
        two_sided_p(t, mixed.degrees_of_freedom),
        terms,
    )
    effects = BlockEffects(
        names,
        index,
        treatment,
        mixed.effect,
        mixed.standard_deviation,
        mixed.at_boundary,
    )
    return estimates, effects


def scatter_of_pulls(
    fit: LeastSquares,
    surface: Floats,
    coded: Floats,
    pulls: Sequence[str],
    lack: LackOfFit,
) -> ScatterOfPulls | None:
    r"""Scatter by which surfaces are judged whose specimens were pulled together.

    .. math:: s^2 = \frac{1}{n - p} \sum_i m_i \bar e_i^2

    Returns
    -------
    scatter : ScatterOfPulls or None
        None where every run is a pull of its own.

    Notes
    -----
    An error of a pull (its lag, frequency, temperature) is common to its m specimens.  The
    specimens are then not m independent runs: the mean of a pull is one, as the whole plot of a
    split-plot experiment [3]_.  Lack of fit is that of the means, against repeated pulls.
    """
    names, place = np.unique(np.asarray(pulls), return_inverse=True)
    if names.size == len(pulls):
        return None
    member = (place == np.arange(names.size)[:, None]).astype(np.float64)
    has_levels = np.isfinite(coded).all(axis=1)
    known = np.isfinite(fit.residual)

    def mean(of_rows: Floats, taken: Bools) -> Floats:
        count = taken @ member.T
        total = np.where(taken, of_rows, 0.0) @ member.T
        return np.asarray(
            np.divide(total, count, out=np.full(count.shape, np.nan), where=count > 0)
        )

    at, columns = (
        mean(one.T, np.broadcast_to(has_levels, one.T.shape)).T for one in (coded, surface)
    )
    of_pull = mean(fit.residual, known)
    means = fit_least_squares(columns, of_pull)
    squares = np.nansum((known @ member.T) * of_pull**2, axis=1)
    of_means = lack_of_fit(
        means, replicate_cells(at, tolerance=lack.tolerance),
        baseline=np.ones((names.size, 1)), tolerance=lack.tolerance,
    )  # fmt: skip
    freedom = means.degrees_of_freedom
    is_used = (freedom > 0) & (fit.reason == 0)
    with np.errstate(divide="ignore", invalid="ignore"):
        scale = squares / means.residual_sum_of_squares
        sigma = np.sqrt(squares / freedom)
    return ScatterOfPulls(
        is_used=is_used,
        sigma=np.where(is_used, sigma, np.nan),
        degrees_of_freedom=freedom,
        sum_of_squares=squares,
        lack=replace(
            of_means,
            sum_of_squares=scale * of_means.sum_of_squares,
            pure_error_sum_of_squares=scale * of_means.pure_error_sum_of_squares,
            cell=lack.cell,
        ),
    )


def judged_by_pulls(
    found: _Estimates, scatter: ScatterOfPulls, sigma: Floats, treatment: Literal["fixed", "random"]
) -> _Estimates:
    """Estimates with the scatter of the pulls in place of that of the runs, ``sigma``.

    Terms that random blocks judge (the mean) keep the scatter between them.
    """
    used = scatter.is_used
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.where(used, scatter.sigma / sigma, 1.0)
    within = np.array([one != "blocks" for one in found.error_term])
    of_term = np.where(within, ratio[:, None], 1.0)
    is_judged = used[:, None] & within
    freedom = np.where(is_judged, scatter.degrees_of_freedom[:, None], found.degrees_of_freedom)
    t = found.t / of_term
    p_value = np.where(is_judged, two_sided_p(t, freedom), found.p_value)
    judged = replace(found, degrees_of_freedom=freedom, t=t, p_value=p_value)
    if treatment == "fixed":
        return replace(judged, sigma=found.sigma * ratio)
    factor = found.covariance_factor * of_term[:, :, None] * of_term[:, None, :]
    return replace(judged, covariance_factor=factor)


def deviations(
    found: _Estimates, exponents: Integers, low: ArrayLike, high: ArrayLike
) -> tuple[Floats, Floats, Floats]:
    """Standard uncertainties of coded and engineering coefficients, and the matrix between them."""
    factor = found.covariance_factor
    to_engineering = engineering_matrix(exponents, low=low, high=high)
    rows = np.broadcast_to(to_engineering, factor.shape)
    engineering = variance_factor(rows, factor, pattern=np.arange(len(factor)))
    coded = np.einsum("ptt->pt", factor)
    sigma = found.sigma[:, None]
    return (
        np.sqrt(coded)[found.pattern] * sigma,
        np.sqrt(engineering)[found.pattern] * sigma,
        to_engineering,
    )
