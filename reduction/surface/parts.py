"""Parts of what fitting of response surfaces hands on; axes as in `reduction.surface.product`."""

from __future__ import annotations

from dataclasses import dataclass

from numpy import int8
from numpy.typing import NDArray

from reduction.record import Bools, Floats, Integers, read_only_arrays


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
        Against ``error_term``; NaN for residuals, pure error and total. [1]
    error_term : tuple of str, length n_sources
        What each source is tested against, empty where it is not tested.
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
    """Scatter about the surface against scatter of repeated runs; arrays (n_responses,).

    Parameters
    ----------
    degrees_of_freedom, pure_error_degrees_of_freedom : ndarray of int
        [1]
    sum_of_squares, pure_error_sum_of_squares : ndarray
        [unit of the response, squared]
    f, p_value : ndarray
        [1]
    reason : ndarray of int8
        0, or a key of `reduction.surface.product.LACK_OF_FIT_REASONS`.
    cell : ndarray of int, shape (n_runs,)
        Runs with one number count as repeats of each other; -1 where a run has no levels.
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
class Canonical:
    """Stationary point and curvature of each surface.

    Parameters
    ----------
    stationary_point : ndarray, shape (n_responses, n_factors)
        Coded. [1]
    stationary_point_engineering : ndarray, shape (n_responses, n_factors)
        [SI unit of each factor]
    stationary_point_standard_uncertainty : ndarray, shape (n_responses, n_factors)
        Coded, first order in the coefficients: too small where an eigenvalue is not clear of
        zero. [1]
    stationary_value : ndarray, shape (n_responses,)
        Of the surface there. [unit of the response]
    eigenvalue : ndarray, shape (n_responses, n_factors)
        Falling. [unit of the response]
    eigenvalue_standard_uncertainty : ndarray, shape (n_responses, n_factors)
        First order. [unit of the response]
    eigenvector : ndarray, shape (n_responses, n_factors, n_factors)
        Column j belongs to eigenvalue j; its largest component is positive. [1]
    kind : ndarray of int8, shape (n_responses,)
        Key of `reduction.surface.product.STATIONARY_KINDS`, by the signs of the eigenvalues alone.
    is_inside : ndarray of bool, shape (n_responses,)
        The stationary point lies between the low and high levels.
    reason : ndarray of int8, shape (n_responses,)
        0, or a key of `reduction.surface.product.STATIONARY_REASONS`.
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
    """Residuals of each run, looked at; shape (n_responses, n_runs) unless said.

    Parameters
    ----------
    leverage : ndarray
        Share of a run's own value in its fitted one. [1]
    cooks_distance : ndarray
        Shift of the whole surface if the run were left out. [1]
    studentized_residual : ndarray
        Residual over its own standard deviation. [1]
    deleted_residual : ndarray
        The same with the scatter found without the run: Student's t. [1]
    probability_plot_correlation : ndarray, shape (n_responses,)
        Of the ordered studentized residuals with normal scores, squared. [1]
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
        Above the mean over the blocks; predicted (shrunk) where random; NaN for a block in
        which the response has no value. [unit of the response]
    standard_deviation : ndarray, shape (n_responses,)
        Between blocks, by REML; NaN where fixed. [unit of the response]
    at_boundary : ndarray of bool, shape (n_responses,)
        The scatter between blocks is no larger than that within explains; False where fixed.
    """

    names: tuple[str, ...]
    index: Integers
    treatment: str
    effect: Floats
    standard_deviation: Floats
    at_boundary: Bools
