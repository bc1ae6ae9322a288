"""Tables of the stiffness forms of mooring codes: their coefficients, and how well they fit."""

from __future__ import annotations

import numpy as np

from reduction.report.experimentview import ExperimentView, response_unit
from reduction.report.htmltable import (
    Cell,
    Table,
    count,
    factors_of,
    make_table,
    measured,
    number,
    probability,
    words,
)
from reduction.report.style import Shown
from reduction.report.uncertainty import (
    plus_minus,
)

__all__ = ["FORM_WORDS", "form_quality_table", "form_table"]

FORM_WORDS = {
    "del-vecchio": "Del Vecchio",
    "mean-load": "mean load",
    "quadratic": "quadratic surface",
}
"""Names of the forms of stiffness on the page."""


def form_table(view: ExperimentView) -> Table | None:
    """Return the coefficients of the stiffness forms with their intervals."""
    forms = _forms(view)
    names, units = (view.array_of_texts(f"stiffness_coefficient_{w}") for w in ("name", "unit"))
    spread = view.array("stiffness_coefficient_standard_uncertainty")
    rows = []
    for k, form in forms:
        for j in range(names.shape[1]):
            if not names[k, j]:
                continue
            low, high = (
                float(view.array(f"stiffness_coefficient_{e}")[k, j]) for e in ("low", "high")
            )
            rows.append(
                [
                    words(FORM_WORDS.get(form, form)),
                    words(str(names[k, j])),
                    measured(
                        float(view.array("stiffness_coefficient")[k, j]),
                        (high - low) / 2,
                        factor=(high - low) / 2 / spread[k, j],
                    ),
                    words(str(units[k, j])),
                    Cell(f"{low:.4g} to {high:.4g}", f"{low!r} {high!r}", is_number=True),
                    probability(float(view.array("stiffness_p_value")[k, j])),
                ]
            )
    if not rows:
        return None
    confidence = 100 * float(np.nanmax(view.array("stiffness_confidence")))
    return make_table(
        "Coefficients of the stiffness forms of mooring codes.",
        ("form", "coefficient", "value", "unit", f"{confidence:g} % interval", "p if nil [1]"),
        rows, synthetic=view.is_synthetic,
        remarks=[plus_minus(factors_of(rows), "scatter of the runs about the form",
                            left_out="that the form itself may be wrong: see its quality")],
    )  # fmt: skip


def form_quality_table(view: ExperimentView) -> Table | None:
    """Return how well each form fits the runs, beside the quadratic surface."""
    forms = _forms(view)
    if not forms:
        return None
    strength = np.nanmax(view.per_run("run_rated_break_strength"))
    unit = response_unit("apparent_spring_constant", view.units)
    of_strength = Shown(unit.unit, unit.factor * float(strength))
    columns = ("n_coefficients", "r2", "adjusted_r2", "predicted_r2", "sigma", "sigma", "aicc")
    rows = [
        [
            words(FORM_WORDS.get(form, form)),
            *(
                count(float(view.array(f"stiffness_{name}")[k]))
                if j == 0
                else number(
                    float(view.array(f"stiffness_{name}")[k]), of_strength if j == 5 else None
                )
                for j, name in enumerate(columns)
            ),
        ]
        for k, form in forms
    ]
    return make_table(
        "The forms against the quadratic surface of the same runs.",
        ("form", "coefficients [1]", "r² [1]", "adjusted r² [1]", "predicted r² [1]",
         "s over break strength [1]", unit.label("s"), "AICc [1]"),
        rows, synthetic=view.is_synthetic,
        remarks=["s: standard deviation of a run about the form. AICc: lower is better; one form"
                 " against another on the same runs, nothing by itself."],
    )  # fmt: skip


def _forms(view: ExperimentView) -> list[tuple[int, str]]:
    if (
        "stiffness_form" not in view.data
        or not np.isfinite(view.array("stiffness_n_coefficients")).any()
    ):
        return []
    return [(k, str(name)) for k, name in enumerate(view.data["stiffness_form"].values)]
