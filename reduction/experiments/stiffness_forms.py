r"""Dynamic stiffness in the forms used by mooring codes.

**Dynamic stiffness of a rope in the forms used by mooring codes, from the same runs**:

.. math::

    K_r = \frac{EA}{MBL} = a + b\,L_m - c\,L_a - d\,\log_{10} T, \qquad
    EA_d = \alpha\, MBL + \beta\, T_m

with the mean load :math:`L_m` and the load amplitude :math:`L_a` in per cent of the rated
break strength MBL, the period :math:`T` in seconds and the mean tension :math:`T_m` in newtons.

References
----------
.. [1] C. M. Hurvich and C.-L. Tsai, "Regression and time series model selection in small samples,"
   Biometrika 76(2), 1989 (AICc).
.. [2] C. J. M. Del Vecchio, "Light Weight Materials for Deep Water Moorings," PhD thesis,
   University of Reading, 1992.
.. [3] MoorPy, "Variable rope stiffness behavior" (line library keys EAd_MBL and EAd_MBL_Lm);
   MoorDyn, line type with ``EA|alphaMBL|vbeta``.
.. [4] CG-D-39-80, eq. 5: the quadratic surface of the same runs.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import stdtrit

from reduction.experiments.designs import model_matrix, quadratic_exponents
from reduction.experiments.fit_results import FIT_REASONS, LeastSquares
from reduction.experiments.least_squares_fit import fit_least_squares, two_sided_p
from reduction.record.arrays import as_same_shape
from reduction.record.contributions import CONFIDENCE
from reduction.record.errors import DataError, SettingsError
from reduction.record.measurement import Floats, read_only_arrays

StiffnessFormName = Literal["del-vecchio", "mean-load"]

Texts = np.ndarray[tuple[int, ...], np.dtype[np.str_]]


@dataclass(frozen=True)
@read_only_arrays
class FormQuality:
    """Quality of fit of forms to the same runs; stiffness over break strength throughout.

    Parameters
    ----------
    forms : tuple of str, length n_forms
        ``del-vecchio``, ``mean-load``, ``quadratic``.
    n_coefficients : tuple of int, length n_forms
    sigma : ndarray, shape (..., n_forms)
        Standard deviation of a run about the form. [1]
    r2, adjusted_r2, predicted_r2 : ndarray, shape (..., n_forms)
        The last is from predictions of each run without itself. [1]
    prediction_sum_of_squares : ndarray, shape (..., n_forms)
        PRESS. [1]
    aicc : ndarray, shape (..., n_forms)
        Lowest is best; NaN where there are too few runs for it. [1]
    degrees_of_freedom : ndarray of int, shape (..., n_forms)
    reason : ndarray of str, shape (..., n_forms)
        Reason why a form has no number; else empty.
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
        The form in words for a table, with the meaning of the amplitude.
    coefficient_names : tuple of str, length n_coefficients
        a, b, c, d or alpha, beta.
    coefficient_units : tuple of str, length n_coefficients
    coefficient, coefficient_standard_uncertainty : ndarray, shape (..., n_coefficients)
        With the signs of the equation: c and d are subtracted. [``coefficient_units``]
    coefficient_low, coefficient_high : ndarray, shape (..., n_coefficients)
        Ends of the confidence interval. [``coefficient_units``]
    p_value : ndarray, shape (..., n_coefficients)
        For no effect, two-sided. [1]
    covariance : ndarray, shape (..., n_coefficients, n_coefficients)
        Covariance of the coefficients.
    stiffness_fitted, stiffness_residual : ndarray, shape (..., n_runs)
        Values of each run. [N]
    quality : FormQuality
        Quality of this form alone (n_forms is 1).
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


def _form_quality(
    forms: tuple[str, ...], fits: list[LeastSquares], shape: tuple[int, ...]
) -> FormQuality:
    """Scatter, r2 and AICc of several forms of the same responses.

    Notes
    -----
    Source of AICc: [1]_, as n log(RSS / n) + 2 k + 2 k (k + 1) / (n - k - 1), where k counts the
    coefficients and the scatter.

    Examples
    --------
    A mean of three runs has the scatter of a deviation and no r2:

    >>> from reduction.experiments.least_squares_fit import fit_least_squares
    >>> fit = fit_least_squares(np.ones((3, 1)), [[1.0, 2.0, 3.0]])
    >>> print(_form_quality(("mean",), [fit], ()).sigma)
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


LoadAmplitude = Literal["half-range", "full-range"]


def _checked_strength(rated_break_strength: float | None) -> float:
    """Return the break strength, or raise if there is none."""
    if rated_break_strength is None:
        raise SettingsError(
            "stiffness over break strength has no break strength",
            needed="the rated break strength of the line",
            hint="Give rated_break_strength of the specimen.",
        )
    if not rated_break_strength > 0 or not np.isfinite(rated_break_strength):
        raise SettingsError(
            "the rated break strength cannot be",
            found=f"{rated_break_strength:g}",
            needed="a finite number above zero",
        )
    return float(rated_break_strength)


def _above_zero(name: str, values: Floats) -> None:
    bad = np.flatnonzero(values <= 0)
    if bad.size:
        raise DataError(
            f"{bad.size} of {values.size} values of {name} are not above zero, "
            f"first at index {int(bad[0])}",
            found=f"{values[bad[0]]:g}",
            needed="levels above zero, or NaN where the run is missing",
        )


def _del_vecchio_matrix(
    mean: Floats, amplitude: Floats, frequency: Floats, strength: float, kind: LoadAmplitude
) -> Floats:
    """Columns of a, b, c, d: per cent of break strength, seconds."""
    if kind not in ("half-range", "full-range"):
        raise SettingsError(
            "the load amplitude is one of two things",
            found=kind,
            needed="half-range or full-range",
        )
    wide = 2.0 if kind == "full-range" else 1.0
    percent = 100 / strength
    # -log10(period) is log10(frequency); its sign and that of c are those of the equation
    columns = [np.ones_like(mean), percent * mean, -wide * percent * amplitude, np.log10(frequency)]
    matrix: Floats = np.column_stack(columns)
    return matrix


def _positive_levels(**named: ArrayLike) -> tuple[Floats, ...]:
    """Return levels as a series over the runs, all of them positive."""
    arrays = as_same_shape(**named)
    for name, values in zip(named, arrays, strict=True):
        _above_zero(name, values)
    return arrays


def _relative_stiffness(
    spring_constant: ArrayLike, strength: float, n_runs: int
) -> tuple[Floats, tuple[int, ...]]:
    """Stiffness over break strength as (n_responses, n_runs), and the shape before the runs."""
    stiffness = np.asarray(spring_constant, dtype=np.float64)
    return stiffness.reshape(-1, n_runs) / strength, stiffness.shape[:-1]


def _form(
    form: StiffnessFormName,
    equation: str,
    names: tuple[str, ...],
    units: tuple[str, ...],
    matrix: Floats,
    spring_constant: ArrayLike,
    mean: Floats,
    strength: float,
) -> StiffnessForm:
    relative, shape = _relative_stiffness(spring_constant, strength, matrix.shape[0])
    fit = fit_least_squares(matrix, relative)
    covariance = fit.covariance_factor[fit.pattern] * fit.sigma[:, None, None] ** 2
    uncertainty = np.sqrt(np.diagonal(covariance, axis1=1, axis2=2))
    freedom = np.where(fit.degrees_of_freedom > 0, fit.degrees_of_freedom, np.nan)[:, None]
    reach = stdtrit(freedom, (1 + CONFIDENCE) / 2) * uncertainty
    with np.errstate(divide="ignore", invalid="ignore"):
        p_value = two_sided_p(fit.coefficient / uncertainty, freedom)
    n = len(names)
    known = mean[np.isfinite(mean)] / strength
    return StiffnessForm(
        form=form,
        equation=equation,
        coefficient_names=names,
        coefficient_units=units,
        coefficient=fit.coefficient.reshape(*shape, n),
        coefficient_standard_uncertainty=uncertainty.reshape(*shape, n),
        coefficient_low=(fit.coefficient - reach).reshape(*shape, n),
        coefficient_high=(fit.coefficient + reach).reshape(*shape, n),
        p_value=p_value.reshape(*shape, n),
        covariance=covariance.reshape(*shape, n, n),
        stiffness_fitted=(fit.fitted * strength).reshape(*shape, mean.size),
        stiffness_residual=(fit.residual * strength).reshape(*shape, mean.size),
        quality=_form_quality((form,), [fit], shape),
        mean_load_range=(
            (float(known.min()), float(known.max())) if known.size else (float("nan"), float("nan"))
        ),
        rated_break_strength=strength,
        confidence=CONFIDENCE,
    )


def fit_del_vecchio_stiffness(
    spring_constant: ArrayLike,
    *,
    mean_tension: ArrayLike,
    tension_amplitude: ArrayLike,
    frequency: ArrayLike,
    rated_break_strength: float | None,
    load_amplitude: LoadAmplitude,
) -> StiffnessForm:
    r"""Coefficients of the form of Del Vecchio.

    .. math:: K_r = a + b\,L_m - c\,L_a - d\,\log_{10} T

    Notes
    -----
    Source: [2]_.  It was written for polyester, at loads and periods above those of [4]_:
    the coefficients hold for the runs from which they are fitted.  Papers print :math:`L_a` both as
    half and as full range; for that reason ``load_amplitude`` has no default.

    Examples
    --------
    Runs made from a = 18, b = 0.3, c = 0.2, d = 1:

    >>> f, mean, half = (np.array(x) for x in ([.1, .1, .05, .05, .2], [20., 40, 20, 40, 30],
    ...                                        [5., 10, 10, 5, 8]))
    >>> stiffness = 18 + 0.3 * mean - 0.2 * half - np.log10(1 / f)
    >>> form = fit_del_vecchio_stiffness(1e4 * stiffness, mean_tension=100 * mean,
    ...     tension_amplitude=100 * half, frequency=f, rated_break_strength=1e4,
    ...     load_amplitude="half-range")
    >>> print(form.coefficient.round(6))
    [18.   0.3  0.2  1. ]
    """
    strength = _checked_strength(rated_break_strength)
    mean, amplitude, rate = _positive_levels(
        mean_tension=mean_tension, tension_amplitude=tension_amplitude, frequency=frequency
    )
    return _form(
        "del-vecchio",
        f"EA/MBL = a + b Lm - c La - d log10(T); Lm, La in % of MBL, La is the "
        f"{load_amplitude.replace('-', ' ')}, T in s",
        ("a", "b", "c", "d"),
        ("1", "1/%", "1/%", "1"),
        _del_vecchio_matrix(mean, amplitude, rate, strength, load_amplitude),
        spring_constant,
        mean,
        strength,
    )


def fit_mean_load_stiffness(
    spring_constant: ArrayLike,
    *,
    mean_tension: ArrayLike,
    rated_break_strength: float | None,
) -> StiffnessForm:
    r"""Coefficients of the form used by MoorDyn and MoorPy.

    .. math:: EA_d = \alpha\, MBL + \beta\, T_m

    Notes
    -----
    Source: [3]_.  alpha is EAd_MBL and beta EAd_MBL_Lm of MoorPy; MoorDyn takes the product
    of alpha and MBL in newtons, and beta.  In MoorDyn alpha MBL is the stiffness at zero
    mean load and must exceed the static EA; a stiffness that rises steeply with the mean
    load gives an alpha near or below zero, and the form cannot be used in MoorDyn.
    The fit averages over amplitude and frequency as they occur in the runs.

    Examples
    --------
    The surface of 8-strand nylon in [4]_, Table 3, at the centre of frequency and amplitude
    (B1 + B3 -+ B6 in 1e4 lb per unit strain), break strength 5760 lb:

    >>> form = fit_mean_load_stiffness([1.667e4, 3.088e4, 4.511e4], mean_tension=[691.2, 1209.6,
    ...     1728.0], rated_break_strength=5760.0)
    >>> print(form.coefficient.round(2))
    [-0.4  27.43]
    """
    strength = _checked_strength(rated_break_strength)
    (mean,) = _positive_levels(mean_tension=mean_tension)
    return _form(
        "mean-load",
        "EA = alpha MBL + beta Tm; Tm is the mean tension",
        ("alpha", "beta"),
        ("1", "1"),
        np.column_stack([np.ones_like(mean), mean / strength]),
        spring_constant,
        mean,
        strength,
    )


FORMS = ("del-vecchio", "mean-load", "quadratic")


def compare_stiffness_forms(
    spring_constant: ArrayLike,
    *,
    mean_tension: ArrayLike,
    tension_amplitude: ArrayLike,
    frequency: ArrayLike,
    coded: ArrayLike,
    rated_break_strength: float | None,
) -> FormQuality:
    """Both forms compared with the quadratic surface of the same runs.

    Notes
    -----
    A run without one of its levels is left out of all three.  The meaning of the amplitude does not
    matter here: it scales only the coefficient c.  AICc [1]_ counts the scatter as
    a parameter: for fifteen runs the penalty is 110 for ten terms, 17 for four and
    8 for two, so that a form may win by it though its r2 is lower.

    Examples
    --------
    A stiffness that follows the mean load alone needs no more than that form:

    >>> from reduction.experiments.designs import box_behnken
    >>> coded = box_behnken(3).coded
    >>> mean, half, f = 1344 + 576 * coded[:, 1], 544 + 224 * coded[:, 2], 0.3 + 0.2 * coded[:, 0]
    >>> noise = 100 * np.random.default_rng(1).standard_normal(15)
    >>> quality = compare_stiffness_forms(5e3 + 20 * mean + noise, mean_tension=mean,
    ...     tension_amplitude=half, frequency=f, coded=coded, rated_break_strength=6400)
    >>> quality.forms[int(np.argmin(quality.aicc))]
    'mean-load'
    """
    strength = _checked_strength(rated_break_strength)
    mean, amplitude, rate = _positive_levels(
        mean_tension=mean_tension, tension_amplitude=tension_amplitude, frequency=frequency
    )
    levels = np.asarray(coded, dtype=np.float64)
    relative, shape = _relative_stiffness(spring_constant, strength, mean.size)
    first = _del_vecchio_matrix(mean, amplitude, rate, strength, "half-range")
    whole = np.isfinite(first).all(axis=1) & np.isfinite(levels).all(axis=1)
    surface = np.full((mean.size, quadratic_exponents(levels.shape[1]).shape[0]), np.nan)
    surface[whole] = model_matrix(levels[whole], quadratic_exponents(levels.shape[1]))
    known = np.where(whole, relative, np.nan)
    matrices = (first, first[:, :2], surface)
    return _form_quality(FORMS, [fit_least_squares(matrix, known) for matrix in matrices], shape)
