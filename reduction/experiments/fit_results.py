"""Results of a fit of response surfaces.

**Structure of the results.** Axes: ``n_responses`` surfaces over the same
``n_runs`` runs, ``n_terms`` terms in the printed order, ``n_factors`` factors.  Responses that miss
the same runs share a *pattern*: leverage and covariance factor belong to it, and ``pattern`` gives
that of each response.  The unit of a coefficient in coded units is that of its response.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy import int8
from numpy.typing import NDArray

from reduction.experiments.response_transform import multipliers
from reduction.record.measurement import Bools, Floats, Integers, read_only_arrays
from reduction.record.notes import Note


@dataclass(frozen=True)
@read_only_arrays
class Anova:
    """Analysis of variance, sequential in the order of ``source``; the total is about the mean.

    Parameters
    ----------
    source : tuple of str, length n_sources
        ``blocks`` where there are several, ``first order``, ``interactions``, ``squares``,
        ``residuals``, ``lack of fit``, ``pure error``, ``total``.
    degrees_of_freedom : ndarray, shape (n_responses, n_sources)
        NaN where there is no surface. [1]
    sum_of_squares, mean_square : ndarray, shape (n_responses, n_sources)
        [unit of the response, squared]
    f, p_value : ndarray, shape (n_responses, n_sources)
        Tested against ``error_term``; NaN for residuals, pure error and total. [1]
    error_term : tuple of str, length n_sources
        Error term against which each source is tested; empty where it is not tested.
    """

    source: tuple[str, ...]
    degrees_of_freedom: Floats
    sum_of_squares: Floats
    mean_square: Floats
    f: Floats
    p_value: Floats
    error_term: tuple[str, ...]


@dataclass(frozen=True)
@read_only_arrays
class LackOfFit:
    """Scatter about the surface compared with scatter of repeated runs; arrays (n_responses,).

    Parameters
    ----------
    degrees_of_freedom, pure_error_degrees_of_freedom : ndarray of int
        [1]
    sum_of_squares, pure_error_sum_of_squares : ndarray
        [unit of the response, squared]
    f, p_value : ndarray
        [1]
    reason : ndarray of int8
        0, or a key of `reduction.experiments.fit_results.LACK_OF_FIT_REASONS`.
    cell : ndarray of int, shape (n_runs,)
        Runs with the same number count as repeats of each other; -1 for a run without levels.
    tolerance : float
        Largest difference of coded levels within a cell. [1]
    """

    degrees_of_freedom: Integers
    pure_error_degrees_of_freedom: Integers
    sum_of_squares: Floats
    pure_error_sum_of_squares: Floats
    f: Floats
    p_value: Floats
    reason: NDArray[int8]
    cell: Integers
    tolerance: float


@dataclass(frozen=True)
@read_only_arrays
class ScatterOfPulls:
    """Scatter of the means over the specimens of a pull, on the scale of single runs.

    Entries are those of responses, ``is_used`` where the pulls leave degrees of freedom.
    """

    is_used: Bools
    sigma: Floats
    degrees_of_freedom: Integers
    sum_of_squares: Floats
    lack: LackOfFit


@dataclass(frozen=True)
@read_only_arrays
class Canonical:
    """Stationary point and curvature of each surface.

    Parameters
    ----------
    stationary_point : ndarray, shape (n_responses, n_factors)
        Coded. [1]
    stationary_point_engineering : ndarray, shape (n_responses, n_factors)
        [SI unit of each factor]
    stationary_point_standard_uncertainty : ndarray, shape (n_responses, n_factors)
        Coded, first order in the coefficients: too small where an eigenvalue is not clearly
        different from zero. [1]
    stationary_value : ndarray, shape (n_responses,)
        Value of the surface there. [unit of the response]
    eigenvalue : ndarray, shape (n_responses, n_factors)
        In falling order. [unit of the response]
    eigenvalue_standard_uncertainty : ndarray, shape (n_responses, n_factors)
        To first order. [unit of the response]
    eigenvector : ndarray, shape (n_responses, n_factors, n_factors)
        Column j belongs to eigenvalue j; its largest component is positive. [1]
    kind : ndarray of int8, shape (n_responses,)
        Key of `reduction.experiments.fit_results.STATIONARY_KINDS`, only by the signs of the
        eigenvalues.
    is_inside : ndarray of bool, shape (n_responses,)
        True if the stationary point is between the low and high levels.
    reason : ndarray of int8, shape (n_responses,)
        0, or a key of `reduction.experiments.fit_results.STATIONARY_REASONS`.
    """

    stationary_point: Floats
    stationary_point_engineering: Floats
    stationary_point_standard_uncertainty: Floats
    stationary_value: Floats
    eigenvalue: Floats
    eigenvalue_standard_uncertainty: Floats
    eigenvector: Floats
    kind: NDArray[int8]
    is_inside: Bools
    reason: NDArray[int8]


@dataclass(frozen=True)
@read_only_arrays
class Diagnostics:
    """Diagnostics of the residual of each run; shape (n_responses, n_runs) unless stated.

    Parameters
    ----------
    leverage : ndarray
        Weight of a run's own value in its fitted one. [1]
    cooks_distance : ndarray
        Shift of the whole surface without the run. [1]
    studentized_residual : ndarray
        Residual over its own standard deviation. [1]
    deleted_residual : ndarray
        The same with the scatter estimated without the run: Student's t. [1]
    probability_plot_correlation : ndarray, shape (n_responses,)
        Correlation of the ordered studentized residuals with normal scores, squared. [1]
    """

    leverage: Floats
    cooks_distance: Floats
    studentized_residual: Floats
    deleted_residual: Floats
    probability_plot_correlation: Floats


@dataclass(frozen=True)
@read_only_arrays
class BlockEffects:
    """Several specimens in one surface.

    Parameters
    ----------
    names : tuple of str, length n_blocks
        In the order of their first run.
    index : ndarray of int, shape (n_runs,)
        Block of each run.
    treatment : str
        ``fixed`` or ``random``.
    effect : ndarray, shape (n_responses, n_blocks)
        Difference from the mean over the blocks; predicted (shrunk) if random; NaN for a block in
        which the response has no value. [unit of the response]
    standard_deviation : ndarray, shape (n_responses,)
        Between blocks, by REML; NaN where fixed. [unit of the response]
    at_boundary : ndarray of bool, shape (n_responses,)
        True if the scatter within blocks explains that between them; False if fixed.
    """

    names: tuple[str, ...]
    index: Integers
    treatment: str
    effect: Floats
    standard_deviation: Floats
    at_boundary: Bools


FIT_REASONS: dict[int, str] = {
    0: "",
    1: "fewer runs with a value than terms",
    2: "the runs with a value leave terms confounded",
    3: "as many runs as terms: nothing is left to judge the scatter by",
    4: "the response does not vary",
    5: "the residuals are rounding: the surface passes through every run",
    6: "the runs with a value do not outnumber the terms: no exponent can be found",
}
"""1, 2 and 6: no surface.  3: a surface without uncertainty.  4 and 5: without tests of it."""

NO_SURFACE = (1, 2, 6)
"""Keys of `FIT_REASONS` for which there is no surface."""


@dataclass(frozen=True)
@read_only_arrays
class LeastSquares:
    """Batched least squares of many responses on one matrix; the baseline columns come first.

    Parameters
    ----------
    coefficient : ndarray, shape (n_responses, n_columns)
        In the order of the columns. [unit of the response]
    covariance_factor : ndarray, shape (n_patterns, n_columns, n_columns)
        Covariance of the coefficients over the variance of a run. [1]
    leverage : ndarray, shape (n_patterns, n_runs)
        NaN where a run is not used. [1]
    is_used : ndarray of bool, shape (n_patterns, n_runs)
        Runs with a value.
    pattern : ndarray of int, shape (n_responses,)
        Row of the three above for each response.
    fitted, residual : ndarray, shape (n_responses, n_runs)
        Residuals are NaN where a run is missing. [unit of the response]
    residual_sum_of_squares, total_sum_of_squares : ndarray, shape (n_responses,)
        The total is about the baseline. [unit of the response, squared]
    prediction_sum_of_squares : ndarray, shape (n_responses,)
        PRESS: each run predicted from the others; NaN where a run alone determines a term.
        [unit of the response, squared]
    degrees_of_freedom : ndarray of int, shape (n_responses,)
        Number of runs less columns. [1]
    reason : ndarray of int8, shape (n_responses,)
        0, or a key of `FIT_REASONS`.
    """

    coefficient: Floats
    covariance_factor: Floats
    leverage: Floats
    is_used: Bools
    pattern: Integers
    fitted: Floats
    residual: Floats
    residual_sum_of_squares: Floats
    total_sum_of_squares: Floats
    prediction_sum_of_squares: Floats
    degrees_of_freedom: Integers
    reason: NDArray[int8]

    @property
    def sigma(self) -> Floats:
        """Standard deviation of a run about the surface, shape (n_responses,)."""
        df = self.degrees_of_freedom
        ratio = np.divide(
            self.residual_sum_of_squares, df, where=df > 0, out=np.full(df.shape, np.nan)
        )
        return np.asarray(np.sqrt(ratio))


LACK_OF_FIT_REASONS: dict[int, str] = {
    0: "",
    1: "no run is repeated",
    2: "no more different runs than terms",
    3: "the repeated runs agree to the last digit",
    4: "there is no surface, or its residuals are rounding",
}

STATIONARY_REASONS: dict[int, str] = {
    0: "",
    1: "there is no surface",
    2: "the surface has a direction without curvature",
}

STATIONARY_KINDS: dict[int, str] = {0: "", 1: "minimum", 2: "maximum", 3: "saddle"}


@dataclass(frozen=True)
@read_only_arrays
class ResponseSurfaces:
    """Quadratic surfaces of many responses over the same runs.

    Parameters
    ----------
    response_names : tuple of str, length n_responses
    factor_names : tuple of str, length n_factors
    run_names : tuple of str, length n_runs
    low, high : ndarray, shape (n_factors,)
        Levels coded -1 and +1. [SI unit of each factor]
    coded : ndarray, shape (n_runs, n_factors)
        Levels as fitted. [1]
    exponents : ndarray of int, shape (n_terms, n_factors)
        Power of each factor in each term.
    term_names : tuple of str, length n_terms
        B1, B2, .. in printed order: mean, squares, linear terms, interactions.
    transform : tuple of str, length n_responses
        ``none``, ``log``, ``box-cox`` or ``log-times-frequency`` (the logarithm of the product
        of the frequency and the response): everything below is for the transformed response.
    transform_exponent : ndarray, shape (n_responses,)
        Exponent of Box and Cox; 1 for none, 0 for a logarithm. [1]
    transform_exponent_interval : ndarray, shape (n_responses, 2)
        By profile likelihood; NaN where the exponent was not fitted to the runs. [1]
    coefficient, coefficient_standard_uncertainty : ndarray, shape (n_responses, n_terms)
        In coded units. [unit of the response]
    t, p_value : ndarray, shape (n_responses, n_terms)
        For no effect, two-sided, with ``term_degrees_of_freedom``. [1]
    term_degrees_of_freedom : ndarray, shape (n_responses, n_terms)
        Those of the error term of each coefficient. [1]
    error_term : tuple of str, length n_terms
        Error term by which each coefficient is judged.
    coefficient_engineering, coefficient_engineering_standard_uncertainty : ndarray, \
shape (n_responses, n_terms)
        For the factors in their own units. [unit of the response over that of the term]
    covariance_factor : ndarray, shape (n_patterns, n_terms, n_terms)
        Covariance of the coefficients over the variance ``sigma**2``. [1]
    engineering_matrix : ndarray, shape (n_terms, n_terms)
        From coded to engineering coefficients. [1 over the unit of the term]
    pattern : ndarray of int, shape (n_responses,)
        Row of covariance_factor and is_used.
    is_used : ndarray of bool, shape (n_patterns, n_runs)
        Runs with a value.
    sigma : ndarray, shape (n_responses,)
        Standard deviation of a run about the surface. [unit of the response]
    degrees_of_freedom : ndarray of int, shape (n_responses,)
        Of sigma. [1]
    r2, adjusted_r2, predicted_r2 : ndarray, shape (n_responses,)
        About the mean, or about the means of the blocks. [1]
    overall_f, overall_p_value : ndarray, shape (n_responses,)
        All terms except the mean together, with n_terms - 1 and degrees_of_freedom. [1]
    printed_f : ndarray, shape (n_responses,)
        The statistic printed in CG-D-39-80, which counts the mean twice (10 and 4 for fifteen
        runs); for comparison only. [1]
    fitted, residual : ndarray, shape (n_responses, n_runs)
        [unit of the response]
    anova, lack_of_fit, canonical, diagnostics, blocks
        Separate results; blocks is None if there is only one.
    condition_number : float
        Of the model matrix over all runs used. [1]
    reason : ndarray of int8, shape (n_responses,)
        0, or a key of `FIT_REASONS`.
    notes : tuple of Note
        Remarks for the reader of the numbers.
    """

    response_names: tuple[str, ...]
    factor_names: tuple[str, ...]
    run_names: tuple[str, ...]
    low: Floats
    high: Floats
    coded: Floats
    exponents: Integers
    term_names: tuple[str, ...]
    transform: tuple[str, ...]
    transform_exponent: Floats
    transform_exponent_interval: Floats
    coefficient: Floats
    coefficient_standard_uncertainty: Floats
    t: Floats
    p_value: Floats
    term_degrees_of_freedom: Floats
    error_term: tuple[str, ...]
    coefficient_engineering: Floats
    coefficient_engineering_standard_uncertainty: Floats
    covariance_factor: Floats
    engineering_matrix: Floats
    pattern: Integers
    is_used: Bools
    sigma: Floats
    degrees_of_freedom: Integers
    r2: Floats
    adjusted_r2: Floats
    predicted_r2: Floats
    overall_f: Floats
    overall_p_value: Floats
    printed_f: Floats
    fitted: Floats
    residual: Floats
    anova: Anova
    lack_of_fit: LackOfFit
    canonical: Canonical
    diagnostics: Diagnostics
    blocks: BlockEffects | None
    condition_number: float
    reason: NDArray[int8]
    notes: tuple[Note, ...] = ()

    @property
    def labels(self) -> tuple[str, ...]:
        """B1, B2, .. as printed, length n_terms."""
        return tuple(f"B{number + 1}" for number in range(len(self.term_names)))

    def multiplier(self, coded: Floats) -> Floats:
        """`multipliers` of the responses at points (n_points, n_factors); NaN where below zero."""
        found = multipliers(
            self.transform, coded, factor_names=self.factor_names, low=self.low, high=self.high
        )
        return np.where(found > 0, found, np.nan)
