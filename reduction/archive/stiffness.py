"""The forms of dynamic stiffness that mooring codes take, one entry a form."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reduction.archive.values import Values, pad, texts
from reduction.surface.stiffness_product import FormQuality, StiffnessForm

_QUALITY = (
    "n_coefficients",
    "sigma",
    "degrees_of_freedom",
    "r2",
    "adjusted_r2",
    "predicted_r2",
    "prediction_sum_of_squares",
    "aicc",
)


_COLUMNS = {
    "stiffness_coefficient": "coefficient",
    "stiffness_coefficient_standard_uncertainty": "coefficient_standard_uncertainty",
    "stiffness_coefficient_low": "coefficient_low",
    "stiffness_coefficient_high": "coefficient_high",
    "stiffness_p_value": "p_value",
    "stiffness_fitted": "stiffness_fitted",
    "stiffness_residual": "stiffness_residual",
    "stiffness_confidence": "confidence",
    "stiffness_mean_load_range": "mean_load_range",
}
_LABELS = {
    "stiffness_coefficient_name": "coefficient_names",
    "stiffness_coefficient_unit": "coefficient_units",
}


def stiffness_values(forms: Sequence[StiffnessForm], quality: FormQuality) -> Values:
    """Return the forms of one response beside the quadratic surface of the same runs.

    Parameters
    ----------
    forms : sequence of StiffnessForm
        Of one response.
    quality : FormQuality
        Of those forms in their order, and of others after them.

    Returns
    -------
    values : dict of str to ndarray
        Names of `reduction.archive.surface_schema`, without the dimension ``experiment``; a
        form that has no coefficients of its own here has quality alone.
    """
    n_forms = len(quality.forms)
    size = max(len(form.coefficient_names) for form in forms)
    missing = [[np.nan]] * (n_forms - len(forms))
    values: Values = {
        "stiffness_form": texts(quality.forms),
        "stiffness_term": np.arange(1, size + 1),
        "stiffness_term_other": np.arange(1, size + 1),
        "stiffness_refusal": quality.reason,
    }
    values |= {f"stiffness_{name}": np.array(getattr(quality, name)) for name in _QUALITY}
    for name, field in _COLUMNS.items():
        values[name] = pad([*(np.ravel(getattr(form, field)) for form in forms), *missing])
    covariance = np.full((n_forms, size, size), np.nan)
    for table, form in zip(covariance, forms, strict=False):
        n = len(form.coefficient_names)
        table[:n, :n] = form.covariance
    values["stiffness_covariance"] = covariance
    for name, field in _LABELS.items():
        table = np.full((n_forms, size), "", dtype=object)
        for row, form in enumerate(forms):
            labels = getattr(form, field)
            table[row, : len(labels)] = labels
        values[name] = table.astype(np.str_)
    ends = values.pop("stiffness_mean_load_range")
    values |= {
        "stiffness_mean_load_low": ends[:, 0],
        "stiffness_mean_load_high": ends[:, 1],
        "stiffness_confidence": values["stiffness_confidence"][:, 0],
    }
    nothing = [""] * len(missing)
    return values | {"stiffness_equation": texts([*(form.equation for form in forms), *nothing])}
