"""The section of one experiment: what was run, its surfaces, the line, forms, effects."""

from __future__ import annotations

from collections.abc import Mapping

from reduction.report.coefficientbudgets import (
    coefficient_budget_table,
    coefficient_budgets,
)
from reduction.report.experimenttables import (
    anova_table,
    caution_table,
    effect_table,
    form_quality_table,
    form_table,
    line_of_runs_table,
    quality_table,
    run_table,
    surface_coefficient_table,
)
from reduction.report.experimentview import ExperimentView, in_words
from reduction.report.experimentwords import (
    block_words,
    form_words,
    negative_words,
    quality_words,
    single_time_words,
    stationary_words,
)
from reduction.report.figures.budgets import draw_coefficient_budgets
from reduction.report.figures.cube import draw_cube
from reduction.report.figures.lines import draw_derived, draw_forms, draw_single_time
from reduction.report.figures.screening import confounding_words, draw_effects
from reduction.report.figures.surfacechecks import draw_checks, draw_pareto
from reduction.report.figures.surfaces import draw_contours, draw_surface
from reduction.report.section import Part, Section, make_part, provenance_of
from reduction.report.surfacegrid import make_planes, negative_inside
from reduction.report.view import TestView
from reduction.surface.leastsquares import FIT_REASONS
from reduction.surface.product import ResponseSurfaces


def make_experiment_section(view: ExperimentView, tests: Mapping[str, TestView]) -> Section:
    """Return the section of one experiment.

    Parameters
    ----------
    view : ExperimentView
        The experiment.
    tests : mapping of str to TestView
        The runs that were tests, by their names; what is not there is left out.
    """
    surfaces = view.surfaces
    parts = [
        make_part("What was run", (), [run_table(view, tests), caution_table(view)]),
        *(_surface_parts(view, surfaces, tests) if surfaces is not None else []),
        *_effect_parts(view),
        make_part(
            "The three-parameter line",
            [*draw_single_time(view, tests), *draw_derived(view)],
            [line_of_runs_table(view, tests)],
            single_time_words(view),
        ),
        make_part(
            "Stiffness as mooring codes ask for it", draw_forms(view),
            [form_table(view), form_quality_table(view)], form_words(view),
        ),
    ]  # fmt: skip
    kind = view.text("experiment_kind").replace("box-behnken", "Box-Behnken")
    kind = kind.replace("plackett-burman", "Plackett-Burman")
    of = ", ".join(in_words(name) for name in view.factors)
    notes = list(dict.fromkeys(row["note"] for row in view.own_rows("note")))
    provenance, documents = provenance_of(view.data.attrs)
    return Section(
        key=view.key,
        title=f"Experiment {view.name}",
        subtitle=f"{kind} design over {of}; {len(view.runs)} runs",
        parts=tuple(part for part in parts if part.figures or part.tables or part.sentences),
        notes=(("What a reader of the numbers has to know", notes),) if notes else (),
        provenance=provenance,
        documents=documents,
        noun="experiment",
    )


def _surface_parts(
    view: ExperimentView, surfaces: ResponseSurfaces, tests: Mapping[str, TestView]
) -> list[Part]:
    order = {
        name: int(test.attribute("test_order"))
        for name, test in tests.items()
        if test.attribute("test_order").isdigit()
    }
    planes = make_planes(view, surfaces)
    negative = negative_inside(surfaces)
    parts = [make_part("Quality of the surfaces", (), [quality_table(view, surfaces)])]
    for index, name in enumerate(surfaces.response_names):
        heading = in_words(name)
        if surfaces.reason[index] in _NO_SURFACE:
            reason = FIT_REASONS[int(surfaces.reason[index])]
            parts.append(make_part(_capital(heading), (), (), [f"No surface: {reason}."]))
            continue
        on_planes = []
        if planes is not None:
            on_planes = [
                *draw_surface(view, surfaces, index, planes),
                *draw_contours(view, surfaces, index, planes),
            ]
        budgets = coefficient_budgets(view, surfaces, index)
        shares = f"{heading}, shares of the variance"
        parts.append(
            make_part(
                _capital(heading),
                [
                    *on_planes,
                    *draw_cube(view, surfaces, index),
                    *draw_pareto(view, surfaces, index),
                ],
                (),
                [
                    quality_words(view, surfaces, index),
                    stationary_words(view, surfaces, index),
                    *block_words(view, surfaces, index),
                ],
                folded=make_part(
                    f"{_capital(heading)}: coefficients, analysis of variance, residuals",
                    [
                        *draw_coefficient_budgets(view, f"budget-{index}", shares, budgets),
                        *draw_checks(view, surfaces, index, order),
                    ],
                    [
                        surface_coefficient_table(view, surfaces, index),
                        coefficient_budget_table(view, name, budgets),
                        anova_table(view, surfaces, index),
                    ],
                ),
                warnings=negative_words(view, surfaces, name, negative),
            )
        )
    return parts


_NO_SURFACE = (1, 2, 6)


def _effect_parts(view: ExperimentView) -> list[Part]:
    if not view.is_screening:
        return []
    words = confounding_words(view)
    parts = []
    for name in view.responses:
        reason = view.text(f"{name}_effect_refusal")
        parts.append(
            make_part(
                f"Effects on the {in_words(name)}", draw_effects(view, name),
                [effect_table(view, name)], [f"No effects: {reason}."] if reason else words,
            )
        )  # fmt: skip
        words = []
    return parts


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]
