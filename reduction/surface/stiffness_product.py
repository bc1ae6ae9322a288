"""What the forms of dynamic stiffness hand on, and how well each fits.

References
----------
.. [1] C. M. Hurvich and C.-L. Tsai, "Regression and time series model selection in small
   samples," Biometrika 76(2), 1989.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from reduction.record import Floats, read_only_arrays
from reduction.surface.leastsquares import FIT_REASONS, LeastSquares

StiffnessFormName = Literal["del-vecchio", "mean-load"]
Texts = np.ndarray[tuple[int, ...], np.dtype[np.str_]]


@dataclass(frozen=True)
@read_only_arrays
class FormQuality:
    """How well forms fit the same runs; stiffness over break strength throughout.

    Parameters
    ----------
    forms : tuple of str, length n_forms
        ``del-vecchio``, ``mean-load``, ``quadratic``.
    n_coefficients : tuple of int, length n_forms
    sigma : ndarray, shape (..., n_forms)
        Standard deviation of a run about the form. [1]
    r2, adjusted_r2, predicted_r2 : ndarray, shape (..., n_forms)
        The last from the runs predicted each without itself. [1]
    prediction_sum_of_squares : ndarray, shape (..., n_forms)
        PRESS. [1]
    aicc : ndarray, shape (..., n_forms)
        Lowest is best; NaN where the runs are too few for it. [1]
    degrees_of_freedom : ndarray of int, shape (..., n_forms)
    reason : ndarray of str, shape (..., n_forms)
        Why a form has no number; empty where it has.
    """

    forms: tuple[str, ...]
    n_coefficients: tuple[int, ...]
    sigma: Floats
    r2: Floats
    adjusted_r2: Floats
    predicted_r2: Floats
    prediction_sum_of_squares: Floats
    aicc: Floats
    degrees_of_freedom: np.ndarray[tuple[int, ...], np.dtype[np.int64]]
    reason: Texts


@dataclass(frozen=True)
@read_only_arrays
class StiffnessForm:
    """One form with its coefficients and their uncertainty (type A).

    Parameters
    ----------
    form : str
        ``del-vecchio`` or ``mean-load``.
    equation : str
        The form in words a table can carry, with what the amplitude is.
    coefficient_names : tuple of str, length n_coefficients
        a, b, c, d or alpha, beta.
    coefficient_units : tuple of str, length n_coefficients
    coefficient, coefficient_standard_uncertainty : ndarray, shape (..., n_coefficients)
        With the signs of the equation: c and d are taken away. [``coefficient_units``]
    coefficient_low, coefficient_high : ndarray, shape (..., n_coefficients)
        Ends of the confidence interval. [``coefficient_units``]
    p_value : ndarray, shape (..., n_coefficients)
        Of no effect, two-sided. [1]
    covariance : ndarray, shape (..., n_coefficients, n_coefficients)
        Of the coefficients.
    stiffness_fitted, stiffness_residual : ndarray, shape (..., n_runs)
        Of each run. [N]
    quality : FormQuality
        Of this form alone (n_forms is 1).
    mean_load_range : tuple of (float, float)
        Lowest and highest mean tension over the break strength: the range of use. [1]
    rated_break_strength : float
        [N]
    confidence : float
        [1]
    """

    form: StiffnessFormName
    equation: str
    coefficient_names: tuple[str, ...]
    coefficient_units: tuple[str, ...]
    coefficient: Floats
    coefficient_standard_uncertainty: Floats
    coefficient_low: Floats
    coefficient_high: Floats
    p_value: Floats
    covariance: Floats
    stiffness_fitted: Floats
    stiffness_residual: Floats
    quality: FormQuality
    mean_load_range: tuple[float, float]
    rated_break_strength: float
    confidence: float


def form_quality(
    forms: tuple[str, ...], fits: list[LeastSquares], shape: tuple[int, ...]
) -> FormQuality:
    """Scatter, r2 and AICc of several forms of the same responses.

    Parameters
    ----------
    forms : tuple of str, length n_forms
    fits : list of LeastSquares, length n_forms
        Over the same runs.
    shape : tuple of int
        Of the responses, before the runs.

    Returns
    -------
    quality : FormQuality
        NaN and a reason where a form has no scatter to judge it by.

    Raises
    ------
    ValueError
        If the fits are not of as many responses as the shape says.

    Notes
    -----
    Source of AICc: [1]_, as n log(RSS / n) + 2 k + 2 k (k + 1) / (n - k - 1), k the
    coefficients and the scatter.

    Examples
    --------
    A mean of three runs has the scatter of a deviation and no r2.

    >>> from reduction.surface.fit import fit_least_squares
    >>> fit = fit_least_squares(np.ones((3, 1)), [[1.0, 2.0, 3.0]])
    >>> print(form_quality(("mean",), [fit], ()).sigma)
    [1.]
    """
    n_coefficients = tuple(fit.coefficient.shape[1] for fit in fits)
    residual = np.stack([fit.residual_sum_of_squares for fit in fits], axis=-1)
    total = np.stack([fit.total_sum_of_squares for fit in fits], axis=-1)
    press = np.stack([fit.prediction_sum_of_squares for fit in fits], axis=-1)
    freedom = np.stack([fit.degrees_of_freedom for fit in fits], axis=-1).astype(np.int64)
    runs = freedom + np.array(n_coefficients)
    counted = np.array(n_coefficients) + 1  # the scatter is a parameter too
    with np.errstate(divide="ignore", invalid="ignore"):
        r2 = 1 - residual / total
        adjusted = 1 - (residual / freedom) / (total / (runs - 1))
        spare = runs - counted - 1
        aicc = np.where(
            spare > 0,
            runs * np.log(residual / runs) + 2 * counted + 2 * counted * (counted + 1) / spare,
            np.nan,
        )
        predicted = 1 - press / total
    text = np.array([FIT_REASONS[code] for code in sorted(FIT_REASONS)])
    reason = text[np.stack([fit.reason for fit in fits], axis=-1)]

    def shaped(values: Floats) -> Floats:
        known = np.where(freedom > 0, values, np.nan)
        return known.reshape(*shape, len(fits))

    return FormQuality(
        forms=forms,
        n_coefficients=n_coefficients,
        sigma=shaped(np.stack([fit.sigma for fit in fits], axis=-1)),
        r2=shaped(r2),
        adjusted_r2=shaped(adjusted),
        predicted_r2=shaped(predicted),
        prediction_sum_of_squares=shaped(press),
        aicc=shaped(aicc),
        degrees_of_freedom=freedom.reshape(*shape, len(fits)),
        reason=reason.reshape(*shape, len(fits)),
    )
