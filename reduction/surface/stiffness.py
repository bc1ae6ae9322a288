r"""Dynamic stiffness of a rope in the forms that mooring codes take, from the same runs.

.. math::

    K_r = \frac{EA}{MBL} = a + b\,L_m - c\,L_a - d\,\log_{10} T, \qquad
    EA_d = \alpha\, MBL + \beta\, T_m

with the mean load :math:`L_m` and the load amplitude :math:`L_a` in per cent of the rated
break strength MBL, the period :math:`T` in seconds and the mean tension :math:`T_m` in newtons.

References
----------
.. [1] C. J. M. Del Vecchio, "Light Weight Materials for Deep Water Moorings," PhD thesis,
   University of Reading, 1992.
.. [2] MoorPy, "Variable rope stiffness behavior" (line library keys EAd_MBL and EAd_MBL_Lm);
   MoorDyn, line type with ``EA|alphaMBL|vbeta``.
.. [3] CG-D-39-80, eq. 5: the quadratic surface of the same runs.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import stdtrit

from reduction.errors import SettingsError
from reduction.record import Floats
from reduction.surface.fit import fit_least_squares, two_sided_p
from reduction.surface.stiffness_product import StiffnessForm, StiffnessFormName, form_quality
from reduction.surface.stiffness_runs import (
    LoadAmplitude,
    checked_strength,
    del_vecchio_matrix,
    positive_levels,
    relative_stiffness,
)


def _form(
    form: StiffnessFormName,
    equation: str,
    names: tuple[str, ...],
    units: tuple[str, ...],
    matrix: Floats,
    spring_constant: ArrayLike,
    mean: Floats,
    strength: float,
    confidence: float,
) -> StiffnessForm:
    if not 0 < confidence < 1:
        raise SettingsError(
            "the confidence is not a share", found=f"{confidence:g}", needed="between 0 and 1"
        )
    relative, shape = relative_stiffness(spring_constant, strength, matrix.shape[0])
    fit = fit_least_squares(matrix, relative)
    covariance = fit.covariance_factor[fit.pattern] * fit.sigma[:, None, None] ** 2
    uncertainty = np.sqrt(np.diagonal(covariance, axis1=1, axis2=2))
    freedom = np.where(fit.degrees_of_freedom > 0, fit.degrees_of_freedom, np.nan)[:, None]
    reach = stdtrit(freedom, (1 + confidence) / 2) * uncertainty
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
        quality=form_quality((form,), [fit], shape),
        mean_load_range=(
            (float(known.min()), float(known.max())) if known.size else (float("nan"), float("nan"))
        ),
        rated_break_strength=strength,
        confidence=confidence,
    )


def fit_del_vecchio_stiffness(
    spring_constant: ArrayLike,
    *,
    mean_tension: ArrayLike,
    tension_amplitude: ArrayLike,
    frequency: ArrayLike,
    rated_break_strength: float | None,
    load_amplitude: LoadAmplitude,
    confidence: float = 0.95,
) -> StiffnessForm:
    r"""Coefficients of the form of Del Vecchio.

    .. math:: K_r = a + b\,L_m - c\,L_a - d\,\log_{10} T

    Parameters
    ----------
    spring_constant : array_like, shape (..., n_runs)
        Apparent (dynamic) spring constant EA of each run; NaN where a run is missing. [N]
    mean_tension, tension_amplitude : array_like, shape (n_runs,)
        As achieved; the amplitude is half the range. [N]
    frequency : array_like, shape (n_runs,)
        Its inverse is the loading period. [Hz]
    rated_break_strength : float or None
        MBL; None is refused. [N]
    load_amplitude : str
        What :math:`L_a` is in the equation wanted: ``half-range`` (this amplitude) or
        ``full-range`` (twice it, half the coefficient c).
    confidence : float
        Of each interval alone. [1]

    Returns
    -------
    form : StiffnessForm
        a [1], b and c [1 over per cent of break strength], d [1 over a decade of period].

    Raises
    ------
    SettingsError
        If the break strength is missing or cannot be, or an option has another value.
    DataError
        If the levels are not above zero or the shapes do not fit.

    Notes
    -----
    Source: [1]_.  It was written for polyester, at loads and periods above those of [3]_:
    the coefficients hold for the runs they come from.  Papers print :math:`L_a` as half
    and as full range; ``load_amplitude`` has no default for that reason.

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
    strength = checked_strength(rated_break_strength)
    mean, amplitude, rate = positive_levels(
        mean_tension=mean_tension, tension_amplitude=tension_amplitude, frequency=frequency
    )
    return _form(
        "del-vecchio",
        f"EA/MBL = a + b Lm - c La - d log10(T); Lm, La in % of MBL, La is the "
        f"{load_amplitude.replace('-', ' ')}, T in s",
        ("a", "b", "c", "d"),
        ("1", "1/%", "1/%", "1"),
        del_vecchio_matrix(mean, amplitude, rate, strength, load_amplitude),
        spring_constant,
        mean,
        strength,
        confidence,
    )


def fit_mean_load_stiffness(
    spring_constant: ArrayLike,
    *,
    mean_tension: ArrayLike,
    rated_break_strength: float | None,
    confidence: float = 0.95,
) -> StiffnessForm:
    r"""Coefficients of the form that MoorDyn and MoorPy take.

    .. math:: EA_d = \alpha\, MBL + \beta\, T_m

    Parameters
    ----------
    spring_constant : array_like, shape (..., n_runs)
        Apparent (dynamic) spring constant EA of each run; NaN where a run is missing. [N]
    mean_tension : array_like, shape (n_runs,)
        As achieved. [N]
    rated_break_strength : float or None
        MBL; None is refused. [N]
    confidence : float
        Of each interval alone. [1]

    Returns
    -------
    form : StiffnessForm
        alpha and beta, both without unit.

    Raises
    ------
    SettingsError
        If the break strength is missing or cannot be, or the confidence is no share.
    DataError
        If the mean tensions are not above zero or the shapes do not fit.

    Notes
    -----
    Source: [2]_.  alpha is EAd_MBL and beta EAd_MBL_Lm of MoorPy; MoorDyn takes the product
    of alpha and MBL in newtons, and beta.  MoorDyn has alpha MBL as the stiffness at no
    mean load and wants it above the static EA; a stiffness that rises steeply with the mean
    load gives an alpha near or below zero, and then the form is not for MoorDyn.
    Amplitude and frequency are averaged over as the runs have them.

    Examples
    --------
    The surface of 8-strand nylon in [3]_, Table 3, at the centre of frequency and amplitude
    (B1 + B3 -+ B6 in 1e4 lb per unit strain), break strength 5760 lb.

    >>> form = fit_mean_load_stiffness([1.667e4, 3.088e4, 4.511e4], mean_tension=[691.2, 1209.6,
    ...     1728.0], rated_break_strength=5760.0)
    >>> print(form.coefficient.round(2))
    [-0.4  27.43]
    """
    strength = checked_strength(rated_break_strength)
    (mean,) = positive_levels(mean_tension=mean_tension)
    return _form(
        "mean-load",
        "EA = alpha MBL + beta Tm; Tm is the mean tension",
        ("alpha", "beta"),
        ("1", "1"),
        np.column_stack([np.ones_like(mean), mean / strength]),
        spring_constant,
        mean,
        strength,
        confidence,
    )
