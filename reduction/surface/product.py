"""What fitting of response surfaces hands on.

Axes: ``n_responses`` surfaces over the same ``n_runs`` runs, ``n_terms`` terms in the printed
order, ``n_factors`` factors.  Responses that miss the same runs share a *pattern*: leverage and
covariance factor belong to it, and ``pattern`` says which one a response has.  The unit of a
coefficient in coded units is that of its response.
"""

from __future__ import annotations

from dataclasses import dataclass

from numpy import int8
from numpy.typing import NDArray

from reduction.record import Bools, Floats, Integers, read_only_arrays
from reduction.surface.parts import Anova, BlockEffects, Canonical, Diagnostics, LackOfFit

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
        Levels that are -1 and +1. [SI unit of each factor]
    coded : ndarray, shape (n_runs, n_factors)
        As fitted. [1]
    exponents : ndarray of int, shape (n_terms, n_factors)
        Power of each factor in each term.
    term_names : tuple of str, length n_terms
        B1, B2, .. in printed order: mean, squares, linear terms, interactions.
    transform : tuple of str, length n_responses
        ``none``, ``log`` or ``box-cox``: everything below is of the transformed response.
    transform_exponent : ndarray, shape (n_responses,)
        Of Box and Cox; 1 for none, 0 for log. [1]
    transform_exponent_interval : ndarray, shape (n_responses, 2)
        By profile likelihood; NaN where the exponent was not found from the runs. [1]
    coefficient, coefficient_standard_uncertainty : ndarray, shape (n_responses, n_terms)
        Coded units. [unit of the response]
    t, p_value : ndarray, shape (n_responses, n_terms)
        Of no effect, two-sided, with ``term_degrees_of_freedom``. [1]
    term_degrees_of_freedom : ndarray, shape (n_responses, n_terms)
        Those of the error term of each coefficient. [1]
    error_term : tuple of str, length n_terms
        What each coefficient is judged by.
    coefficient_engineering, coefficient_engineering_standard_uncertainty : ndarray, \
shape (n_responses, n_terms)
        Of the factors in their own units. [unit of the response over that of the term]
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
        All terms but the mean at once, with n_terms - 1 and degrees_of_freedom. [1]
    printed_f : ndarray, shape (n_responses,)
        The statistic CG-D-39-80 prints, which counts the mean twice (10 and 4 for fifteen
        runs); for comparison alone. [1]
    fitted, residual : ndarray, shape (n_responses, n_runs)
        [unit of the response]
    anova, lack_of_fit, canonical, diagnostics, blocks
        The parts of their own; blocks is None where there is one.
    condition_number : float
        Of the model matrix over all runs that are used. [1]
    reason : ndarray of int8, shape (n_responses,)
        0, or a key of `FIT_REASONS`.
    notes : tuple of str
        What a reader of the numbers has to know.
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
    notes: tuple[str, ...] = ()

    @property
    def labels(self) -> tuple[str, ...]:
        """B1, B2, .. as printed, length n_terms."""
        return tuple(f"B{number + 1}" for number in range(len(self.term_names)))
