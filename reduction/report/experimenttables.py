"""Tables of an experiment: its runs, the quality of its surfaces, coefficients, ANOVA, effects."""

from __future__ import annotations

import numpy as np

from reduction.record import Floats
from reduction.report.experimentview import ExperimentView, in_words, response_unit
from reduction.report.figures.surfacechecks import term_words
from reduction.report.htmltable import (
    NOT_GIVEN,
    Cell,
    Table,
    count,
    make_table,
    measured,
    number,
    number_text,
    probability,
    share_text,
    words,
)
from reduction.report.style import Shown, shown, superscript
from reduction.report.uncertainty import plus_minus
from reduction.surface.product import ResponseSurfaces

__all__ = [
    "anova_table", "caution_table", "coefficient_table", "effect_table", "quality_table",
    "run_table",
]  # fmt: skip

_OF_RUNS = "scatter of the runs about the surface"
_NOT_OF_RUNS = "what all runs share: calibration, gauge length, the one line that was tested"
_PRINTED = (
    "F as CG-D-39-80 prints it counts the mean among the terms and in the error (10 and 4 degrees"
    " of freedom for fifteen runs); it stands here to be compared with the report, no more."
)
_SHARE = Shown("%RBS", 100.0)
_LARGE = 1e9
"""From here on a column of squares has powers of ten in every row, not in some."""


def run_table(view: ExperimentView) -> Table:
    """Return the runs as planned and as reached, with what each gave."""
    strength = view.per_run("run_rated_break_strength")
    is_share = bool(np.isfinite(strength).any())
    load = _SHARE if is_share else shown("tension", view.units)
    divisor = strength if is_share else np.ones(len(view.runs))
    level, plan = view.array("run_level"), view.array("run_plan")
    remarks = view.texts("run_remark")
    responses = [(name, response_unit(name, view.units)) for name in view.responses]
    rows = []
    for k, run in enumerate(view.runs):
        rows.append(
            [
                words(run),
                words(_coded(plan[k, : len(view.factors)])),
                *(number(level[k, j], unit) for j, unit in enumerate(view.factor_units)),
                *(
                    _fixed(view.per_run(name)[k], load.factor / divisor[k], 1 if is_share else 0)
                    for name in ("run_peak_tension", "run_minimum_tension")
                ),
                *(
                    measured(
                        view.per_run(f"{name}_measured")[k],
                        view.per_run(f"{name}_measured_standard_uncertainty")[k],
                        unit,
                        is_short=True,
                    )
                    for name, unit in responses
                ),
                *([words(remarks[k])] if any(remarks) else []),
            ]
        )  # fmt: skip
    columns = (
        "run", "plan, coded",
        *(view.factor_label(place) for place in range(len(view.factors))),
        load.label("peak"), load.label("minimum"),
        *(unit.label(in_words(name)) for name, unit in responses),
        *(["remark"] if any(remarks) else []),
    )  # fmt: skip
    factors = ", ".join(in_words(name) for name in view.factors)
    return make_table(
        f"Runs as planned (coded {factors}) and as reached: means over the cycles of each run; peak"
        " and minimum are the greatest and least of its cycles.",
        columns, rows, synthetic=view.is_synthetic,
        remarks=[plus_minus("scatter between the cycles of the run"
                            + (", and the K_0 of the slow pull" if _has_line(view) else ""))],
        is_compact=True,
    )  # fmt: skip


def caution_table(view: ExperimentView) -> Table | None:
    """Return what the runs as reached warn of."""
    own = view.own_rows("caution")
    if not own:
        return None
    rows = [
        [
            words(row["caution_kind"].replace("-", " ")),
            words(row.get("caution_runs", "") or "all runs"),
            words(row["caution"]),
            words(row.get("caution_hint", "")),
        ]
        for row in own
    ]
    return make_table(
        "Cautions: what is wrong with the runs as they were made, before any number is read.",
        ("what", "runs", "what is so", "what can be done"), rows, synthetic=view.is_synthetic,
    )  # fmt: skip


def quality_table(view: ExperimentView, surfaces: ResponseSurfaces) -> Table:
    """Return how well the surface of each response fits."""
    lack = surfaces.lack_of_fit
    rows = []
    for k, name in enumerate(surfaces.response_names):
        unit = response_unit(name, view.units)
        freedom = f"{len(surfaces.term_names) - 1}, {surfaces.degrees_of_freedom[k]}"
        rows.append(
            [
                words(unit.label(in_words(name))),
                *(
                    Cell(share_text(float(one[k])), repr(float(one[k])), is_number=True)
                    for one in (surfaces.r2, surfaces.adjusted_r2, surfaces.predicted_r2)
                ),
                number(float(surfaces.sigma[k]), unit),
                number(float(surfaces.overall_f[k])),
                words(freedom),
                probability(float(surfaces.overall_p_value[k])),
                number(float(lack.f[k])),
                probability(float(lack.p_value[k])),
                number(float(surfaces.printed_f[k])),
            ]
        )
    remarks = [_PRINTED]
    columns: tuple[str, ...] = (
        "response", "r² [1]", "adjusted r² [1]", "predicted r² [1]",
        "standard deviation of a run, s [its unit]", "F of all terms [1]", "degrees of freedom",
        "p of F [1]", "F of lack of fit [1]", "p of lack of fit [1]",
        "F as CG-D-39-80 prints it [1]",
    )  # fmt: skip
    if not np.isfinite(surfaces.printed_f).any():
        columns, rows, remarks = columns[:-1], [row[:-1] for row in rows], []
    return make_table(
        "Quality of each surface. p: probability of such an F if the terms were nil, or if the"
        " surface fitted.",
        columns, rows, synthetic=view.is_synthetic, is_compact=True, remarks=remarks,
    )  # fmt: skip


def coefficient_table(view: ExperimentView, surfaces: ResponseSurfaces, index: int) -> Table:
    """Return the coefficients of a surface, coded and in the units of the factors."""
    name = surfaces.response_names[index]
    unit = response_unit(name, view.units)
    rows = []
    for k, label in enumerate(surfaces.labels):
        powers = surfaces.exponents[k]
        engineering = view.coefficient_unit(name, tuple(powers.tolist()))
        rows.append(
            [
                words(label),
                words(term_words(powers, view.factors)),
                measured(
                    float(surfaces.coefficient[index, k]),
                    float(surfaces.coefficient_standard_uncertainty[index, k]), unit,
                ),
                number(float(surfaces.t[index, k])),
                probability(float(surfaces.p_value[index, k])),
                _to_compute_with(
                    float(surfaces.coefficient_engineering[index, k]),
                    float(surfaces.coefficient_engineering_standard_uncertainty[index, k]),
                    engineering,
                ),
                words(superscript(engineering.unit)),
            ]
        )  # fmt: skip
    base = f"{in_words(name)}: coefficients of the surface"
    in_units = ", ".join(
        f"{in_words(factor)} in {one.unit}"
        for factor, one in zip(view.factors, view.factor_units, strict=True)
    )
    return make_table(
        f"{base[0].upper()}{base[1:]}, for coded levels and for levels in units.",
        ("", "term", unit.label("coefficient, coded"), "t [1]", "p [1]",
         "coefficient, in units", "its unit"),
        rows, synthetic=view.is_synthetic,
        remarks=[
            f"In units: {in_units}. Digits enough to compute with; the errors of coefficients in"
            " units go together, so that a value of the surface is far better known than the sum of"
            " theirs.",
            plus_minus(_OF_RUNS, left_out=_NOT_OF_RUNS),
        ],
    )  # fmt: skip


def anova_table(view: ExperimentView, surfaces: ResponseSurfaces, index: int) -> Table:
    """Return the analysis of variance of a surface."""
    anova, name = surfaces.anova, surfaces.response_names[index]
    unit = response_unit(name, view.units)
    square = Shown(_squared(unit.unit), unit.factor**2)
    is_large = bool(np.nanmax(anova.sum_of_squares[index]) * square.factor >= _LARGE)
    rows = [
        [
            words(source),
            count(float(anova.degrees_of_freedom[index, k])),
            *(
                Cell(f"{one[index, k] * square.factor:.3e}", repr(float(one[index, k])), True)
                if is_large
                else number(float(one[index, k]), square)
                for one in (anova.sum_of_squares, anova.mean_square)
            ),
            number(float(anova.f[index, k])),
            probability(float(anova.p_value[index, k])),
            words(anova.error_term[k]),
        ]
        for k, source in enumerate(anova.source)
    ]
    return make_table(
        f"{in_words(name).capitalize()}: analysis of variance, each source after those above it.",
        ("source", "degrees of freedom [1]", square.label("sum of squares"),
         square.label("mean square"), "F [1]", "p [1]", "tested against"),
        rows, synthetic=view.is_synthetic,
    )  # fmt: skip


def effect_table(view: ExperimentView, name: str) -> Table | None:
    """Return the effects of a screening on one response, the largest first."""
    effect = view.array(f"{name}_effect")
    if effect.size == 0:
        return None
    unit = response_unit(name, view.units)
    spread = view.scalar(f"{name}_effect_standard_uncertainty")
    t, p = view.array(f"{name}_effect_t"), view.array(f"{name}_effect_p_value")
    counts = view.array(f"{name}_effect_is_significant")
    columns = view.texts("plan_column_name")
    mean = view.scalar(f"{name}_mean")
    rows = []
    for k in np.argsort(-np.abs(effect), kind="stable"):
        is_factor = k < len(view.factors)
        rows.append(
            [
                words(in_words(columns[k])),
                measured(float(effect[k]), spread, unit),
                number(100 * float(effect[k] / mean), digits=3),
                number(float(t[k])),
                probability(float(p[k])),
                words("" if not is_factor else "yes" if counts[k] > 0 else "no"),
            ]
        )
    return make_table(
        f"{in_words(name).capitalize()}: effects, mean at the high level less that at the low one.",
        ("factor", unit.label("effect"), "share of the mean [%]", "t [1]", "p [1]", "significant"),
        rows, synthetic=view.is_synthetic,
        remarks=["A dummy is a column that no factor uses: what it shows is scatter and"
                 " interactions.", plus_minus("effects of the dummies", left_out=_NOT_OF_RUNS)],
    )  # fmt: skip


def _to_compute_with(value: float, spread: float, unit: Shown) -> Cell:
    """Return a coefficient of seven digits and its uncertainty of two."""
    if not np.isfinite(value):
        return Cell(NOT_GIVEN, is_number=True)
    half = f" ± {number_text(spread * unit.factor, 2)}" if np.isfinite(spread) else ""
    text = f"{number_text(value * unit.factor, 7)}{half}"
    return Cell(text, repr(value), is_number=True)


def _fixed(value: float, factor: float, places: int) -> Cell:
    """Return a cell of a number to so many places; the archive's own value is beside it."""
    if not np.isfinite(value * factor):
        return Cell(NOT_GIVEN, is_number=True)
    text = f"{round(value * factor, places) + 0.0:,.{places}f}"
    return Cell(text, repr(float(value)), is_number=True)


def _coded(levels: Floats) -> str:
    return ", ".join("0" if level == 0 else f"{level:+g}" for level in levels)


def _squared(unit: str) -> str:
    return unit if unit == "1" else f"({unit})²" if " " in unit or "/" in unit else f"{unit}²"


def _has_line(view: ExperimentView) -> bool:
    return bool({"dissipation_spring_constant", "relaxation_time"} & set(view.responses))
