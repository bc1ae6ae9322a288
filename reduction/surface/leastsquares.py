"""Least squares of many responses on one matrix, as `reduction.surface.fit` hands it on.

Responses that miss the same runs share a *pattern*: leverage and covariance factor belong to
it, and ``pattern`` says which one a response has.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy import int8
from numpy.typing import NDArray

from reduction.record import Bools, Floats, Integers, read_only_arrays

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


@dataclass(frozen=True)
@read_only_arrays
class LeastSquares:
    """Batched least squares of many responses on one matrix; the baseline columns stand first.

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
        Row of the three above.
    fitted, residual : ndarray, shape (n_responses, n_runs)
        Residuals are NaN where a run is missing. [unit of the response]
    sequential_sum_of_squares : ndarray, shape (n_responses, n_columns)
        What each column takes away after those before it. [unit of the response, squared]
    residual_sum_of_squares, total_sum_of_squares : ndarray, shape (n_responses,)
        The total is about the baseline. [unit of the response, squared]
    prediction_sum_of_squares : ndarray, shape (n_responses,)
        PRESS: of each run predicted from the others; NaN where a run alone fixes a term.
        [unit of the response, squared]
    degrees_of_freedom : ndarray of int, shape (n_responses,)
        Runs less columns. [1]
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
    sequential_sum_of_squares: Floats
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
