"""Fits of response surfaces of many responses over one set of runs.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.3, App. C.
.. [2] R. V. Lenth, "Response-Surface Methods in R, Using rsm," J. Stat. Softw., vol. 32, no. 7,
   2009.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import replace
from math import comb
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import fdtrc

from reduction.experiments.block_effects import (
    block_columns,
    deviations,
    fixed_estimates,
    judged_by_pulls,
    scatter_of_pulls,
    with_blocks,
)
from reduction.experiments.designs import (
    coded_from_engineering,
    model_matrix,
    quadratic_exponents,
    term_kinds,
    term_names,
)
from reduction.experiments.fit_results import (
    FIT_REASONS,
    NO_SURFACE,
    BlockEffects,
    LackOfFit,
    LeastSquares,
    ResponseSurfaces,
    ScatterOfPulls,
)
from reduction.experiments.least_squares_fit import (
    fit_least_squares,
    lack_of_fit,
    replicate_cells,
    statistics_from_r2,
)
from reduction.experiments.response_matrix import times
from reduction.experiments.response_transform import (
    Transform,
    box_cox_exponent,
    multipliers,
    transform,
)
from reduction.experiments.run_sheet import covariance_factor
from reduction.experiments.stationary_point import canonical_analysis
from reduction.experiments.surface_statistics import (
    anova_table,
    diagnose,
    regress_each,
    term_tests,
)
from reduction.record.errors import DataError, SettingsError
from reduction.record.measurement import Bools, Floats, Integers
from reduction.record.notes import Note, note

_STILL = 1e-6
"""Coded range below which a factor counts as constant."""


def _coded_levels(
    levels: ArrayLike,
    *,
    low: ArrayLike,
    high: ArrayLike,
    units: Literal["engineering", "coded"],
    factor_names: Sequence[str],
) -> Floats:
    """Levels as achieved, coded, shape (n_runs, n_factors); NaN rows are runs not done. [1]."""
    found = np.array(levels, dtype=np.float64)
    if found.ndim != 2 or found.shape[1] != len(factor_names) or np.shape(low) != found.shape[1:]:
        raise SettingsError(
            "the levels do not pair up with the factors",
            found=f"levels {found.shape}, {len(factor_names)} names, low {np.shape(low)}",
            needed="one column, one name, one low and one high level per factor",
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
    """Refuse names that do not pair up or are repeated."""
    if len(set(names)) < len(names):
        twice = sorted(name for name, count_of in Counter(names).items() if count_of > 1)
        raise SettingsError(
            f"a {what} is named twice",
            found=", ".join(twice),
            needed=f"a name of its own for every {what}",
            hint=f"A {what} entered twice is to be left out once.",
        )
    if len(names) != count:
        raise SettingsError(
            f"the names of the {what}s do not pair up with the {what}s",
            found=f"{len(names)} names",
            needed=f"{count}",
        )


def _require_motion(coded: Floats, factor_names: Sequence[str]) -> None:
    """Refuse runs in which a factor is constant."""
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


_STRAY = 0.1
"""Coded distance beyond the levels of the plan, or short of them, that is noted."""

_ALONE = 0.99
"""Leverage from which a run has hardly any residual."""

_ILL = 30.0
"""Condition number of columns of the model matrix above which terms are nearly collinear."""


def _remarks(
    *,
    coded: Floats,
    responses: Floats,
    fit: LeastSquares,
    lack: LackOfFit,
    blocks: BlockEffects | None,
    judged: ScatterOfPulls | None,
    factor_names: Sequence[str],
    run_names: Sequence[str],
    response_names: Sequence[str],
    condition: float,
) -> tuple[Note, ...]:
    """Notes of the surfaces, the shortest list that is complete."""
    used = np.asarray(np.isfinite(responses).any(axis=0))
    notes = [
        *_missing(responses, used, run_names, response_names),
        *_reasons(fit, response_names),
        *_repeats(coded, responses, used, lack, run_names),
        *_levels(coded[used], factor_names),
        *_alone(fit, run_names),
    ]
    if condition > _ILL:
        notes.append(note("terms-lean", condition=condition))
    if blocks is not None:
        n_specimens = len(blocks.names)
        notes.append(
            note(f"blocks-{blocks.treatment}", n_specimens=n_specimens, freedom=n_specimens - 1)
        )
    if judged is not None and judged.is_used.any():
        freedom = int(judged.degrees_of_freedom[judged.is_used].min())
        notes.append(note("specimens-pulled-together", freedom=freedom))
    return tuple(notes)


def _listed(names: Sequence[str], chosen: Bools) -> str:
    found = [name for name, taken in zip(names, chosen, strict=True) if taken]
    return ", ".join(found[:5]) + (f" and {len(found) - 5} more" if len(found) > 5 else "")


def _missing(
    responses: Floats, used: Bools, run_names: Sequence[str], response_names: Sequence[str]
) -> list[Note]:
    notes = []
    if not used.all():
        notes.append(note("runs-without-value", runs=_listed(run_names, ~used)))
    short = np.asarray(np.isnan(responses[:, used]).any(axis=1))
    if short.any():
        notes.append(note("responses-miss-runs", responses=_listed(response_names, short)))
    return notes


def _reasons(fit: LeastSquares, response_names: Sequence[str]) -> list[Note]:
    return [
        note(
            "surface-not-fitted" if code in NO_SURFACE else "surface-not-judged",
            responses=_listed(response_names, fit.reason == code),
            reason=text,
        )
        for code, text in FIT_REASONS.items()
        if code and (fit.reason == code).any()
    ]


def _repeats(
    coded: Floats, responses: Floats, used: Bools, lack: LackOfFit, run_names: Sequence[str]
) -> list[Note]:
    notes = []
    # a run entered twice looks like this, and makes pure error too small; -0 is 0, and NaN is NaN
    numbers = np.column_stack([coded, responses.T]) + 0.0
    numbers[np.isnan(numbers)] = np.nan
    alike: dict[bytes, list[int]] = {}
    for run in np.flatnonzero(used & np.isfinite(coded).all(axis=1)).tolist():
        alike.setdefault(numbers[run].tobytes(), []).append(run)
    twins = [runs for runs in alike.values() if len(runs) > 1]
    if twins:
        pair = {"first": run_names[twins[0][0]], "second": run_names[twins[0][1]]}
        n_pairs = sum(comb(len(runs), 2) for runs in twins)
        notes.append(note("runs-alike", **pair, n_pairs=n_pairs))
    runs_of_cell = np.argsort(lack.cell, kind="stable")
    runs_of_cell = runs_of_cell[used[runs_of_cell]]
    begin = np.flatnonzero(np.diff(lack.cell[runs_of_cell], prepend=-2))
    of_cells = coded[runs_of_cell]
    spread = 0.0
    if begin.size:
        ranges = np.maximum.reduceat(of_cells, begin) - np.minimum.reduceat(of_cells, begin)
        spread = float(ranges.max())
    if spread > 1e-9:
        notes.append(note("repeats-differ", spread=spread, tolerance=lack.tolerance))
    return notes


def _levels(coded: Floats, factor_names: Sequence[str]) -> list[Note]:
    notes = []
    bounds = zip(factor_names, coded.min(axis=0), coded.max(axis=0), strict=True)
    for name, low, high in bounds:
        beyond = max(-1 - low, high - 1)
        short = max(low + 1, 1 - high)
        if beyond > _STRAY or short > _STRAY:
            how = "go beyond" if beyond > _STRAY else "fall short of"
            ends = {"low": float(low), "high": float(high)}
            notes.append(note("levels-off-range", factor=name, how=how, **ends))
    return notes


def _alone(fit: LeastSquares, run_names: Sequence[str]) -> list[Note]:
    alone = np.any(np.nan_to_num(fit.leverage) > _ALONE, axis=0)
    # without degrees of freedom this applies to every run, and the reason says so
    alone &= bool((fit.degrees_of_freedom > 0).any())
    if not alone.any():
        return []
    return [note("runs-fix-terms", runs=_listed(run_names, alone))]


_SEQUENCE = {"linear": "first order", "interaction": "interactions", "square": "squares"}
"""Order of the sources in the analysis of variance, as in R's rsm."""


MOST_RUNS = 2000
"""For one experiment: memory and time grow with their square; these take 350 MB and 3 s."""


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
    blocks: Sequence[str] | None = None,
    block_treatment: Literal["fixed", "random"] = "fixed",
    pulls: Sequence[str] | None = None,
    transforms: Transform | Sequence[Transform] = "none",
    replicate_tolerance: float = 0.1,
    with_tests: bool = True,
) -> ResponseSurfaces:
    """Fit the quadratic surface of every response over the runs as they were done.

    Parameters
    ----------
    levels : array_like, shape (n_runs, n_factors)
        Levels that each run achieved; a row of NaN for a run not done. [SI unit of each
        factor, or 1 where coded]
    responses : array_like, shape (n_responses, n_runs)
        NaN where a run gave no value. [unit of the response]
    factor_names : sequence of str, length n_factors
        In the order of the columns of ``levels``.
    response_names : sequence of str, length n_responses
        In the order of the rows of ``responses``.
    low, high : array_like, shape (n_factors,)
        Levels of the plan coded -1 and +1. [SI unit of each factor]
    units : {'engineering', 'coded'}
        Units of ``levels``.
    run_names : sequence of str, length n_runs, optional
        By default 1, 2, ...
    blocks : sequence of str, length n_runs, optional
        Specimen of each run, if there are several.
    block_treatment : {'fixed', 'random'}
        The effects apply to these specimens, or to random draws of their kind.
    pulls : sequence of str, length n_runs, optional
        Pull of each run, equal for specimens that were pulled together; the surfaces are then
        judged by the scatter of the pulls.
    transforms : {'none', 'log', 'box-cox', 'log-times-frequency'} or one a response
        Scale on which each response is fitted; the last one needs a factor called ``frequency``.
    replicate_tolerance : float
        Runs count as repeats where no coded level differs by more. [1]
    with_tests : bool
        Without them, t and p of terms and surfaces, analysis of variance and examined residuals
        are NaN, and thousands of responses are fitted in the time of some tens.

    Returns
    -------
    surfaces : ResponseSurfaces
        One surface per response; NaN and a reason where its runs do not support one.

    Raises
    ------
    SettingsError
        If names or transforms do not pair up, a run is named twice, a high level is not
        above its low one, or a frequency to multiply by is missing or not above zero.
    DataError
        If a run has a value but no levels, a level or response is infinite, a factor is
        constant, there is one block, a response to be transformed is not above zero, or there are
        more than `MOST_RUNS` runs.
    FitError
        If there are fewer runs than terms, or the runs leave terms confounded.

    Notes
    -----
    Source: [1]_, eq. 5, with 9 and 5 degrees of freedom where its F statistic has 10 and 4
    (`statistics_from_r2`).  Numbers agree with R's lm and rsm [2]_; with blocks r2 is about
    their means, where R's is about the grand mean.  Levels are used as they were achieved, not as
    planned, so that fifteen runs are seldom orthogonal.  Responses are fitted separately: K_1 and
    tau of runs with E' and E'' are better derived from surfaces of those two, which stay positive
    and smooth.

    Examples
    --------
    One factor, six runs; squares precede linear terms:

    >>> found = fit_surfaces([[-1.0], [-1.0], [0.0], [0.0], [1.0], [1.0]],
    ...     [[1.0, 2.0, 4.0, 5.0, 3.0, 4.0]], factor_names=["frequency"],
    ...     response_names=["stiffness"], low=[0.1], high=[0.5], units="coded")
    >>> found.term_names
    ('mean', 'frequency^2', 'frequency')
    >>> print(found.coefficient, found.sigma.round(4))
    [[ 4.5 -2.   1. ]] [0.7071]
    """
    coded = _coded_levels(levels, low=low, high=high, units=units, factor_names=factor_names)
    measured = np.array(responses, dtype=np.float64)
    n_runs, n_factors = coded.shape
    if n_runs > MOST_RUNS:
        raise DataError(
            "there are too many runs for a surface",
            found=f"{n_runs:,}",
            needed=f"{MOST_RUNS:,} or fewer: all runs are compared with all others",
            hint="Give one row per run, the mean of its cycles, not one row per sample.",
        )
    runs = tuple(run_names or (str(number + 1) for number in range(n_runs)))
    _require_names(runs, n_runs, "run")
    _require_names(tuple(response_names), measured.shape[0] if measured.ndim else 0, "response")
    exponents = quadratic_exponents(n_factors)
    terms, kinds = term_names(exponents, factor_names), term_kinds(exponents)

    baseline = np.ones((n_runs, 1))
    grouping = None
    if blocks is not None:
        _require_names(tuple(str(row) for row in range(len(blocks))), n_runs, "block")
        grouping = block_columns(blocks)
        baseline = np.hstack([baseline, grouping[2]])
    known = np.isfinite(coded).all(axis=1)
    surface = np.full((n_runs, len(terms)), np.nan)
    surface[known] = model_matrix(coded[known], exponents)
    column, groups = _columns(kinds, n_baseline=baseline.shape[1])
    matrix = np.hstack([baseline, surface[:, np.argsort(column)[1:]]])
    used = known & np.isfinite(measured).any(axis=0)
    _require_motion(coded[used], factor_names)
    own = [f"block {number + 1}" for number in range(baseline.shape[1] - 1)]
    ordered = [terms[0], *own, *(terms[index] for index in np.argsort(column)[1:])]
    covariance_factor(matrix[used], names=ordered)  # refuses runs that do not support the terms
    condition = float(np.linalg.cond(matrix[used]))

    scale, power, interval = _scales(transforms, matrix, measured)
    values = measured.copy()
    if set(scale) != {"none"}:
        bent = np.array([kind != "none" for kind in scale])
        factor = multipliers(scale, coded, factor_names=factor_names, low=low, high=high)
        if np.any(factor <= 0):
            raise SettingsError(
                "a response is to be multiplied by a frequency that is not above zero",
                found=f"{np.nanmin(factor):g}",
                needed="levels of the frequency in Hz, with its low and its high one stated",
            )
        values[bent] = transform((factor * measured)[bent], power[bent, None])
    index = None if grouping is None else grouping[1]
    fit = fit_least_squares(matrix, values, n_baseline=baseline.shape[1], block=index)
    fit = replace(fit, reason=np.where(np.isnan(power), np.int8(6), fit.reason))
    cell = replicate_cells(coded, tolerance=replicate_tolerance)
    lack = lack_of_fit(fit, cell, baseline=baseline, tolerance=replicate_tolerance)
    judged = None
    if grouping is not None and pulls is not None:
        judged = scatter_of_pulls(fit, surface, coded, pulls, lack)
    if judged is not None:
        lack = judged.lack
    regressions = regress_each(values, matrix, fit, baseline.shape[1], index) if with_tests else {}
    tested = {row: result for row, result in regressions.items() if fit.reason[row] == 0}
    t, p_value, overall_f, overall_p_value = term_tests(tested, fit, column)
    found = fixed_estimates(fit, column, t, p_value)
    effects = None
    if grouping is not None:
        found, effects = with_blocks(
            found, fit, surface, values, grouping[0], grouping[1], block_treatment
        )
    freedom = fit.degrees_of_freedom
    if judged is not None:
        found = judged_by_pulls(found, judged, fit.sigma, block_treatment)
        of_pulls = np.where(judged.is_used, judged.degrees_of_freedom, freedom)
        overall_f = np.where(judged.is_used, overall_f * (fit.sigma / judged.sigma) ** 2, overall_f)
        overall_p_value = np.where(
            judged.is_used, fdtrc(len(terms) - 1, of_pulls, overall_f), overall_p_value
        )
        freedom = of_pulls if block_treatment == "fixed" else freedom
    deviation, engineering_deviation, to_engineering = deviations(found, exponents, low, high)
    r2, adjusted, predicted = _shares(fit, baseline.shape[1])
    printed = statistics_from_r2(
        np.where(fit.reason == 0, r2, np.nan),
        n_runs=fit.degrees_of_freedom + len(terms),
        n_terms=len(terms),
    ).printed_f
    return ResponseSurfaces(
        response_names=tuple(response_names),
        factor_names=tuple(factor_names),
        run_names=runs,
        low=np.array(low, dtype=np.float64),
        high=np.array(high, dtype=np.float64),
        coded=coded,
        exponents=exponents,
        term_names=terms,
        transform=scale,
        transform_exponent=power,
        transform_exponent_interval=interval,
        coefficient=found.coefficient,
        coefficient_standard_uncertainty=deviation,
        t=found.t,
        p_value=found.p_value,
        term_degrees_of_freedom=found.degrees_of_freedom,
        error_term=found.error_term,
        coefficient_engineering=times(found.coefficient, to_engineering.T),
        coefficient_engineering_standard_uncertainty=engineering_deviation,
        covariance_factor=found.covariance_factor,
        engineering_matrix=to_engineering,
        pattern=found.pattern,
        is_used=fit.is_used if found.pattern is fit.pattern else fit.is_used[fit.pattern],
        sigma=found.sigma,
        degrees_of_freedom=freedom,
        r2=r2,
        adjusted_r2=adjusted,
        predicted_r2=predicted,
        overall_f=overall_f,
        overall_p_value=overall_p_value,
        # the report had one specimen per surface, or their mean
        printed_f=printed if effects is None else np.full(len(r2), np.nan),
        fitted=fit.fitted,
        residual=fit.residual,
        anova=anova_table(regressions, groups, fit, lack, judged),
        lack_of_fit=lack,
        canonical=canonical_analysis(
            found.coefficient,
            exponents,
            covariance_factor=found.covariance_factor,
            pattern=found.pattern,
            sigma=found.sigma,
            low=low,
            high=high,
        ),
        diagnostics=diagnose(tested, fit),
        blocks=effects,
        condition_number=condition,
        reason=fit.reason,
        notes=_remarks(
            coded=coded,
            responses=measured,
            fit=fit,
            lack=lack,
            blocks=effects,
            judged=judged,
            factor_names=factor_names,
            run_names=runs,
            response_names=response_names,
            condition=condition,
        ),
    )


def _columns(kinds: tuple[str, ...], *, n_baseline: int) -> tuple[Integers, dict[str, slice]]:
    """Column of each printed term, after the baseline, and the columns of each source."""
    column = np.zeros(len(kinds), dtype=np.intp)
    groups = {"blocks": slice(1, n_baseline)} if n_baseline > 1 else {}
    start = n_baseline
    for kind, source in _SEQUENCE.items():
        members = [index for index, found in enumerate(kinds) if found == kind]
        column[members] = np.arange(start, start + len(members))
        if members:
            groups[source] = slice(start, start + len(members))
        start += len(members)
    return column, groups


def _scales(
    transforms: Transform | Sequence[Transform], matrix: Floats, measured: Floats
) -> tuple[tuple[str, ...], Floats, Floats]:
    """Scale of each response, its exponent, and the interval of a fitted exponent."""
    count = measured.shape[0]
    scale = (transforms,) * count if isinstance(transforms, str) else tuple(transforms)
    strange = sorted(set(scale) - set(get_args(Transform)))
    if len(scale) != count or strange:
        raise SettingsError(
            "the transforms do not pair up with the responses",
            found=", ".join(strange) or f"{len(scale)} transforms, {count} responses",
            needed="none, log, box-cox or log-times-frequency, one for all or one per response",
        )
    power = np.array([0.0 if kind.startswith("log") else 1.0 for kind in scale])
    interval = np.full((count, 2), np.nan)
    sought = np.flatnonzero([kind == "box-cox" for kind in scale])
    if sought.size:
        found = box_cox_exponent(matrix, measured[sought])
        power[sought] = found.exponent
        interval[sought] = np.stack([found.low, found.high], axis=1)
    return scale, power, interval


def _shares(fit: LeastSquares, n_baseline: int) -> tuple[Floats, Floats, Floats]:
    """r2, adjusted r2, predicted r2 of each response, about the baseline."""
    total = np.where(fit.reason == 4, np.nan, fit.total_sum_of_squares)
    df = fit.degrees_of_freedom
    total_df = df + fit.coefficient.shape[1] - n_baseline
    left = fit.residual_sum_of_squares / total
    ratio = np.divide(total_df, df, out=np.full(df.shape, np.nan), where=df > 0)
    return 1 - left, 1 - left * ratio, 1 - fit.prediction_sum_of_squares / total


OBJECTS = 0.05
"""Probability of a ratio of variances at which the runs reject a scale."""


def scatter_by_scale(
    response: Floats, fit: Callable[[Floats, list[str], list[Transform]], ResponseSurfaces]
) -> tuple[Floats, Floats]:
    """Scatter of the logarithm of each response over that of the response as measured.

    Parameters
    ----------
    response : ndarray, shape (n_responses, n_runs)
        Above zero; NaN where not known. [any]
    fit : callable
        Fits responses of these runs, given with names and transforms.

    Returns
    -------
    ratio : ndarray, shape (n_responses,)
        Standard deviation about the surface of the logarithm, times the geometric mean of the runs,
        over that about the surface as measured (Box and Cox). [1]
    p : ndarray, shape (n_responses,)
        Probability that a ratio of two variances of equal degrees of freedom is as far from 1, to
        this side; 1 without a surface. [1]

    Raises
    ------
    FitError
        If the runs do not determine a surface.

    Examples
    --------
    An exponential over one factor, with a little scatter:

    >>> level = np.linspace(-1, 1, 9)[:, None]
    >>> scatter = np.array([[1.01, 0.99, 1.0, 1.01, 0.99, 1.0, 0.99, 1.01, 1.0]])
    >>> ratio, p = scatter_by_scale(
    ...     np.exp(3 * level.T) * scatter,
    ...     lambda values, names, scales: fit_surfaces(
    ...         level, values, factor_names=["load"], response_names=names, units="coded",
    ...         low=[-1.0], high=[1.0], transforms=scales,
    ...     ),
    ... )
    >>> print(bool(ratio[0] < 0.1), bool(p[0] < 0.001))
    True True
    """
    count = response.shape[0]
    as_measured: Transform = "none"
    bent: Transform = "log"
    both = [*(as_measured for _ in range(count)), *(bent for _ in range(count))]
    names = [f"{scale} {row}" for scale in (as_measured, bent) for row in range(count)]
    trial = fit(np.concatenate([response, response]), names, both)
    mean = np.exp(np.nanmean(np.log(response), axis=1))
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = mean * trial.sigma[count:] / trial.sigma[:count]
    freedom = np.maximum(trial.degrees_of_freedom[:count], 1)
    p = fdtrc(freedom, freedom, np.maximum(ratio, 1 / ratio) ** 2)
    usable = (trial.reason[:count] == 0) & (trial.reason[count:] == 0)
    return ratio, np.where(usable, p, 1.0)
