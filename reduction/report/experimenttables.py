"""Tables of an experiment: its runs with what they warn of, and the effects of a screening."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from reduction.record import Floats
from reduction.report.experimentview import ExperimentView, in_words, response_unit
from reduction.report.htmltable import (
    NOT_GIVEN,
    Cell,
    Table,
    factors_of,
    make_table,
    measured,
    number,
    probability,
    words,
)
from reduction.report.style import Shown, shown
from reduction.report.surfacetables import NOT_OF_RUNS
from reduction.report.surfaceuncertainty import expanded_of_runs
from reduction.report.uncertainty import expand, plus_minus, plus_minus_of_tests
from reduction.report.view import TestView

__all__ = ["caution_table", "effect_table", "run_table"]

_SHARE = Shown("%RBS", 100.0)


def run_table(view: ExperimentView, tests: Mapping[str, TestView] | None = None) -> Table:
    """Return the runs as planned and as reached, with what each gave.

    Runs that are ``tests`` have the uncertainty that their archives know.
    """
    own = {} if tests is None else tests
    strength = view.per_run("run_rated_break_strength")
    is_share = bool(np.isfinite(strength).any())
    load = _SHARE if is_share else shown("tension", view.units)
    divisor = strength if is_share else np.ones(len(view.runs))
    level, plan = view.array("run_level"), view.array("run_plan")
    remarks = view.texts("run_remark")
    responses = [(name, response_unit(name, view.units)) for name in view.responses]
    spreads = {name: expanded_of_runs(view, name, own) for name in view.responses}
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
                        spreads[name].half[k],
                        unit,
                        factor=spreads[name].factor[k],
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
        remarks=[_about_runs(view, rows, own)],
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


def effect_table(view: ExperimentView, name: str) -> Table | None:
    """Return the effects of a screening on one response, the largest first."""
    effect = view.array(f"{name}_effect")
    if effect.size == 0:
        return None
    unit = response_unit(name, view.units)
    # without dummies the error is Lenth's, of a third as many degrees of freedom as effects
    freedom = effect.size - len(view.factors) or effect.size / 3
    spread = expand(view.scalar(f"{name}_effect_standard_uncertainty"), degrees_of_freedom=freedom)
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
                measured(float(effect[k]), float(spread.half), unit, factor=float(spread.factor)),
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
                 " interactions.", plus_minus(factors_of(rows), "effects of the dummies",
                                               left_out=NOT_OF_RUNS)],
    )  # fmt: skip


def _about_runs(
    view: ExperimentView, rows: Sequence[Sequence[Cell]], tests: Mapping[str, TestView]
) -> str:
    runs = [tests[name] for name in dict.fromkeys(view.texts("run_name")) if name in tests]
    held = "scatter between the cycles of the run"
    if runs:
        names = [f"test_{name}" for name in view.responses]
        return plus_minus_of_tests(factors_of(rows), runs, names, found_from=held)
    return plus_minus(
        factors_of(rows), held + (", and the K_0 of the slow pull" if _has_line(view) else "")
    )


def _fixed(value: float, factor: float, places: int) -> Cell:
    """Return a cell of a number to so many places; the archive's own value is beside it."""
    if not np.isfinite(value * factor):
        return Cell(NOT_GIVEN, is_number=True)
    text = f"{round(value * factor, places) + 0.0:,.{places}f}"
    return Cell(text, repr(float(value)), is_number=True)


def _coded(levels: Floats) -> str:
    return ", ".join("0" if level == 0 else f"{level:+g}" for level in levels)


def _has_line(view: ExperimentView) -> bool:
    return bool({"dissipation_spring_constant", "relaxation_time"} & set(view.responses))
