r"""Response surfaces of many responses over one set of runs, in one call.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.3, App. C.
.. [2] R. H. Myers and D. C. Montgomery, Response Surface Methodology, 2nd ed. New York: Wiley,
   2002, example 7.5, p. 347.
.. [3] R. V. Lenth, "Response-Surface Methods in R, Using rsm," J. Stat. Softw., vol. 32, no. 7,
   2009.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import DataError, SettingsError
from reduction.record import Floats, Integers
from reduction.surface.anova import (
    anova_table,
    lack_of_fit,
    replicate_cells,
    statistics_from_r2,
)
from reduction.surface.canonical import canonical_analysis
from reduction.surface.coding import coded_from_engineering, engineering_matrix
from reduction.surface.diagnostics import diagnose
from reduction.surface.fit import (
    covariance_factor,
    fit_least_squares,
    two_sided_p,
    variance_factor,
)
from reduction.surface.product import LeastSquares, ResponseSurfaces
from reduction.surface.terms import model_matrix, quadratic_exponents, term_kinds, term_names

__all__ = ["fit_surfaces"]

_STILL = 1e-6
"""Coded range below which a factor does not move."""
_SEQUENCE = {"linear": "first order", "interaction": "interactions", "square": "squares"}
"""Order of the sources in the analysis of variance, that of R's rsm."""


def fit_surfaces(
    levels: ArrayLike,
    responses: ArrayLike,
    *,
    factor_names: Sequence[str],
    response_names: Sequence[str],
    low: ArrayLike,
    high: ArrayLike,
    units: Literal["engineering", "coded"] = "engineering",
    run_names: Sequence[str] | None = None,
    replicate_tolerance: float = 0.1,
) -> ResponseSurfaces:
    """Fit the quadratic surface of every response over the runs as they were done.

    Parameters
    ----------
    levels : array_like, shape (n_runs, n_factors)
        Levels each run achieved; a row of NaN for a run that was not done. [SI unit of each
        factor, or 1 where coded]
    responses : array_like, shape (n_responses, n_runs)
        NaN where a run gave no value. [unit of the response]
    factor_names : sequence of str, length n_factors
        In the order of the columns of ``levels``.
    response_names : sequence of str, length n_responses
        In the order of the rows of ``responses``.
    low, high : array_like, shape (n_factors,)
        Levels of the plan that are -1 and +1. [SI unit of each factor]
    units : {'engineering', 'coded'}
        Of ``levels``.
    run_names : sequence of str, length n_runs, optional
        1, 2, .. where not given.
    replicate_tolerance : float
        Runs count as repeats where no coded level differs by more. [1]

    Returns
    -------
    surfaces : ResponseSurfaces
        One surface a response; NaN and a reason where its runs do not carry one.

    Raises
    ------
    SettingsError
        If names do not pair up, a run is named twice, or a high level is not above its low one.
    DataError
        If a run has a value and no levels, a level or response is infinite, or a factor never
        moves.
    FitError
        If there are fewer runs than terms, or the runs leave terms confounded.

    Notes
    -----
    Source: [1]_, eq. 5, with 9 and 5 degrees of freedom where its F statistic has 10 and 4
    (`statistics_from_r2`).  Numbers are those of R's lm and rsm [3]_.  The coded plan is only
    the plan: levels are used as they were met, so that fifteen runs are seldom orthogonal.

    Examples
    --------
    Example 7.5 of [2]_ with two of its three factors left out: squares before linear terms.

    >>> found = fit_surfaces([[-1.0], [-1.0], [0.0], [0.0], [1.0], [1.0]],
    ...     [[1.0, 2.0, 4.0, 5.0, 3.0, 4.0]], factor_names=["frequency"],
    ...     response_names=["stiffness"], low=[0.1], high=[0.5], units="coded")
    >>> found.term_names
    ('mean', 'frequency^2', 'frequency')
    >>> print(found.coefficient, found.sigma.round(4))
    [[ 4.5 -2.   1. ]] [0.7071]
    """
    values = np.asarray(responses, dtype=np.float64)
    coded = _coded_levels(levels, low=low, high=high, units=units, factor_names=factor_names)
    n_runs, n_factors = coded.shape
    names = tuple(run_names or (str(number + 1) for number in range(n_runs)))
    _require_names(names, n_runs, "run")
    _require_names(tuple(response_names), values.shape[0] if values.ndim else 0, "response")

    exponents = quadratic_exponents(n_factors)
    terms, kinds = term_names(exponents, factor_names), term_kinds(exponents)
    known = np.isfinite(coded).all(axis=1)
    matrix = np.full((n_runs, len(terms)), np.nan)
    matrix[known] = model_matrix(coded[known], exponents)
    column, groups = _columns(kinds, n_baseline=1)
    used = known & np.isfinite(values).any(axis=0)
    _require_motion(coded[used], factor_names)
    covariance_factor(matrix[used], names=terms)  # refuses runs that do not carry the terms

    fit = fit_least_squares(matrix[:, np.argsort(column)], values)
    coefficient = fit.coefficient[:, column]
    factor = fit.covariance_factor[:, column[:, None], column]
    one_each = np.arange(len(factor))
    deviation = np.sqrt(np.einsum("ptt->pt", factor))[fit.pattern] * fit.sigma[:, None]
    to_engineering = engineering_matrix(exponents, low=low, high=high)
    engineering_rows = np.broadcast_to(to_engineering, factor.shape)
    engineering_factor = variance_factor(engineering_rows, factor, pattern=one_each)

    judged = (fit.reason == 0)[:, None] & (deviation > 0)
    t = np.divide(coefficient, deviation, out=np.full(deviation.shape, np.nan), where=judged)
    freedom = np.where(fit.degrees_of_freedom > 0, fit.degrees_of_freedom, np.nan)
    term_freedom = np.broadcast_to(freedom[:, None], t.shape).copy()
    r2, adjusted, predicted = _shares(fit)
    overall = statistics_from_r2(
        np.where(fit.reason == 0, r2, np.nan),
        n_runs=fit.degrees_of_freedom + len(terms),
        n_terms=len(terms),
    )
    cell = replicate_cells(coded, tolerance=replicate_tolerance)
    lack = lack_of_fit(fit, cell, baseline=np.ones((n_runs, 1)), tolerance=replicate_tolerance)
    return ResponseSurfaces(
        response_names=tuple(response_names),
        factor_names=tuple(factor_names),
        run_names=names,
        low=np.array(low, dtype=np.float64),
        high=np.array(high, dtype=np.float64),
        coded=coded,
        exponents=exponents,
        term_names=terms,
        transform=("none",) * values.shape[0],
        transform_exponent=np.ones(values.shape[0]),
        transform_exponent_interval=np.full((values.shape[0], 2), np.nan),
        coefficient=coefficient,
        coefficient_standard_uncertainty=deviation,
        t=t,
        p_value=two_sided_p(t, term_freedom),
        term_degrees_of_freedom=term_freedom,
        error_term=("residuals",) * len(terms),
        coefficient_engineering=coefficient @ to_engineering.T,
        coefficient_engineering_standard_uncertainty=np.sqrt(engineering_factor)[fit.pattern]
        * fit.sigma[:, None],
        covariance_factor=factor,
        engineering_matrix=to_engineering,
        pattern=fit.pattern,
        is_used=fit.is_used,
        sigma=fit.sigma,
        degrees_of_freedom=fit.degrees_of_freedom,
        r2=r2,
        adjusted_r2=adjusted,
        predicted_r2=predicted,
        overall_f=overall.f,
        overall_p_value=overall.p_value,
        printed_f=overall.printed_f,
        fitted=fit.fitted,
        residual=fit.residual,
        anova=anova_table(fit, groups, lack),
        lack_of_fit=lack,
        canonical=canonical_analysis(
            coefficient,
            exponents,
            covariance_factor=factor,
            pattern=fit.pattern,
            sigma=fit.sigma,
            low=low,
            high=high,
        ),
        diagnostics=diagnose(fit),
        blocks=None,
        condition_number=float(np.linalg.cond(matrix[used])),
        reason=fit.reason,
        notes=(),
    )


def _coded_levels(
    levels: ArrayLike,
    *,
    low: ArrayLike,
    high: ArrayLike,
    units: Literal["engineering", "coded"],
    factor_names: Sequence[str],
) -> Floats:
    found = np.array(levels, dtype=np.float64)
    if found.ndim != 2 or found.shape[1] != len(factor_names) or np.shape(low) != found.shape[1:]:
        raise SettingsError(
            "the levels do not pair up with the factors",
            found=f"levels {found.shape}, {len(factor_names)} names, low {np.shape(low)}",
            needed="one column, one name, one low and one high level a factor",
        )
    if np.isinf(found).any():
        raise DataError(
            "a level is infinite",
            found=f"run {int(np.flatnonzero(np.isinf(found).any(axis=1))[0]) + 1}",
            needed="numbers, or NaN for a run that was not done",
        )
    in_coded = coded_from_engineering(found, low=low, high=high)
    return found if units == "coded" else in_coded


def _require_names(names: tuple[str, ...], count: int, what: str) -> None:
    twice = sorted({name for name in names if names.count(name) > 1}) if len(names) < 1000 else []
    if len(names) != count or len(set(names)) != len(names):
        raise SettingsError(
            f"the names of the {what}s do not pair up with the {what}s",
            found=f"{', '.join(twice)} more than once" if twice else f"{len(names)} names",
            needed=f"{count} different names",
            hint=f"A {what} entered twice is to be left out once.",
        )


def _require_motion(coded: Floats, factor_names: Sequence[str]) -> None:
    if len(coded) == 0:
        raise DataError("no run has a value", needed="runs with levels and responses")
    still = np.flatnonzero(np.ptp(coded, axis=0) < _STILL)
    if still.size:
        first = int(still[0])
        raise DataError(
            f"{factor_names[first]} never moves",
            found=f"{coded[0, first]:g} (coded) in all {len(coded)} runs",
            needed="at least three levels",
            hint="Leave the factor out, or add the runs that move it.",
        )


def _columns(kinds: tuple[str, ...], *, n_baseline: int) -> tuple[Integers, dict[str, slice]]:
    """Column of each printed term, behind the baseline, in the order of the sources."""
    column = np.zeros(len(kinds), dtype=np.intp)
    groups: dict[str, slice] = {}
    start = n_baseline
    for kind, source in _SEQUENCE.items():
        members = [index for index, found in enumerate(kinds) if found == kind]
        column[members] = np.arange(start, start + len(members))
        if members:
            groups[source] = slice(start, start + len(members))
        start += len(members)
    return column, groups


def _shares(fit: LeastSquares) -> tuple[Floats, Floats, Floats]:
    """r2, adjusted r2, predicted r2 of each response."""
    total = np.where(fit.reason == 4, np.nan, fit.total_sum_of_squares)
    df, total_df = fit.degrees_of_freedom, fit.degrees_of_freedom + fit.coefficient.shape[1] - 1
    left = fit.residual_sum_of_squares / total
    ratio = np.divide(total_df, df, out=np.full(df.shape, np.nan), where=df > 0)
    return 1 - left, 1 - left * ratio, 1 - fit.prediction_sum_of_squares / total
