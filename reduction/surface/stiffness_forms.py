"""Forms of the dynamic stiffness of a rope beside the quadratic surface of the same runs.

References
----------
.. [1] C. J. M. Del Vecchio, "Light Weight Materials for Deep Water Moorings," PhD thesis,
   University of Reading, 1992.
.. [2] CG-D-39-80, eq. 5: the quadratic surface of the same runs.
.. [3] C. M. Hurvich and C.-L. Tsai, "Regression and time series model selection in small
   samples," Biometrika 76(2), 1989 (AICc).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import DataError
from reduction.surface.fit import fit_least_squares
from reduction.surface.stiffness_product import (
    FormQuality,
    form_quality,
)
from reduction.surface.stiffness_runs import (
    checked_strength,
    del_vecchio_matrix,
    positive_levels,
    relative_stiffness,
)
from reduction.surface.terms import model_matrix, quadratic_exponents

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
    """Both forms beside the quadratic surface of the same runs.

    Parameters
    ----------
    spring_constant : array_like, shape (..., n_runs)
        Apparent (dynamic) spring constant EA of each run; NaN where a run is missing. [N]
    mean_tension, tension_amplitude : array_like, shape (n_runs,)
        As achieved; the amplitude is half the range. [N]
    frequency : array_like, shape (n_runs,)
        [Hz]
    coded : array_like, shape (n_runs, n_factors)
        Factors of the surface in coded units. [1]
    rated_break_strength : float or None
        MBL; None is refused. [N]

    Returns
    -------
    quality : FormQuality
        ``del-vecchio``, ``mean-load`` and ``quadratic``, all of EA / MBL.

    Raises
    ------
    SettingsError
        If the break strength is missing or cannot be.
    DataError
        If the levels are not above zero or the shapes do not fit.

    Notes
    -----
    A run without one of its levels is left out of all three.  What the amplitude is makes
    no difference here: it scales the coefficient c alone.  AICc [3]_ counts the scatter as
    a parameter: on fifteen runs ten terms pay 110 for their number, four pay 17 and two
    8, so that a form may win by it though its r2 is less.

    Examples
    --------
    A stiffness that follows the mean load alone needs no more than that form.

    >>> from reduction.surface.designs import box_behnken
    >>> coded = box_behnken(3).coded
    >>> mean, half, f = 1344 + 576 * coded[:, 1], 544 + 224 * coded[:, 2], 0.3 + 0.2 * coded[:, 0]
    >>> noise = 100 * np.random.default_rng(1).standard_normal(15)
    >>> quality = compare_stiffness_forms(5e3 + 20 * mean + noise, mean_tension=mean,
    ...     tension_amplitude=half, frequency=f, coded=coded, rated_break_strength=6400)
    >>> quality.forms[int(np.argmin(quality.aicc))]
    'mean-load'
    """
    strength = checked_strength(rated_break_strength)
    mean, amplitude, rate = positive_levels(
        mean_tension=mean_tension, tension_amplitude=tension_amplitude, frequency=frequency
    )
    levels = np.asarray(coded, dtype=np.float64)
    if levels.ndim != 2 or levels.shape[0] != mean.size:
        raise DataError(
            "the coded levels do not fit the runs",
            found=f"shape {levels.shape}",
            needed=f"{mean.size} rows, one column a factor",
        )
    relative, shape = relative_stiffness(spring_constant, strength, mean.size)
    first = del_vecchio_matrix(mean, amplitude, rate, strength, "half-range")
    whole = np.isfinite(first).all(axis=1) & np.isfinite(levels).all(axis=1)
    surface = np.full((mean.size, quadratic_exponents(levels.shape[1]).shape[0]), np.nan)
    surface[whole] = model_matrix(levels[whole], quadratic_exponents(levels.shape[1]))
    known = np.where(whole, relative, np.nan)
    matrices = (first, first[:, :2], surface)
    return form_quality(FORMS, [fit_least_squares(matrix, known) for matrix in matrices], shape)
