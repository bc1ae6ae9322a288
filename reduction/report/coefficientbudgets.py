"""Where the uncertainty of the coefficients of a surface comes from.

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 7.2.7 (what a report of uncertainty holds).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from reduction.archive.budget import all_budgets
from reduction.report.answers import AnswerBudget
from reduction.report.experimentview import ExperimentView, in_words, response_unit
from reduction.report.figures.surfacechecks import term_words
from reduction.report.htmltable import Cell, Table, make_table, number, words
from reduction.report.sources import source_meanings, source_words
from reduction.report.uncertainty import factor_words
from reduction.surface.product import ResponseSurfaces
from reduction.uncertainty.budget import RANDOM, Budget, BudgetRow

_RUN_TO_RUN, _REGRESSION = "run_to_run", "regression"


def coefficient_budgets(
    view: ExperimentView, surfaces: ResponseSurfaces, index: int
) -> list[AnswerBudget]:
    """Return the budget of each coded coefficient of a surface: what runs share, and what not.

    Of the scatter about the surface the part that runs at one point of the plan have among each
    other is from run to run; the rest is what the surface misses, and so of the regression.

    Parameters
    ----------
    view : ExperimentView
        Whose archive keeps what the runs share; one that keeps nothing has no budget to show.
    surfaces : ResponseSurfaces
        Of it.
    index : int
        Of the surface.
    """
    name = surfaces.response_names[index]
    unit = response_unit(name, view.units)
    share = _share_of_repeats(surfaces, index)
    labels = {label: place for place, label in enumerate(surfaces.labels)}
    found = []
    for one in all_budgets(view.data, f"{name}_coefficient"):
        if one.place["experiment"] != view.name or not one.standard_uncertainty > 0:
            continue
        place = labels[one.place["term"]]
        powers = surfaces.exponents[place]
        found.append(
            AnswerBudget(
                f"{one.place['term']}, {term_words(powers, view.factors)}", "", unit,
                _apart(one, share),
            )
        )  # fmt: skip
    return found


def _share_of_repeats(surfaces: ResponseSurfaces, index: int) -> float:
    """Share of the variance about a surface that repeated runs have; NaN where there are none."""
    anova = surfaces.anova
    row = anova.source.index("pure error")
    freedom = float(anova.degrees_of_freedom[index, row])
    variance = float(surfaces.sigma[index]) ** 2
    if not (freedom > 0 and variance > 0):
        return float("nan")
    return float(min(anova.sum_of_squares[index, row] / freedom / variance, 1.0))


def _apart(budget: Budget, share: float) -> Budget:
    """Budget with the scatter about the surface in two parts; in one where runs have no twin."""
    parts = {_REGRESSION: 1.0} if np.isnan(share) else {
        _RUN_TO_RUN: share, _REGRESSION: 1 - share,
    }  # fmt: skip
    rows = []
    for one in budget.rows:
        if one.source != RANDOM:
            rows.append(one)
            continue
        rows += [
            BudgetRow(source, "", one.contribution * np.sqrt(part), one.share * part)
            for source, part in parts.items()
        ]
    return replace(budget, rows=tuple(sorted(rows, key=lambda row: -row.share)))


def coefficient_budget_table(
    view: ExperimentView, name: str, answers: Sequence[AnswerBudget]
) -> Table | None:
    """Return the numbers of the bars: value, uncertainty, factor, and the share of each source."""
    if not answers:
        return None
    sources = AnswerBudget.sources_of(answers)
    rows = [
        [
            words(one.words),
            one.cell,
            number(one.budget.coverage_factor, digits=3),
            *(_percent(one.share(source)) for source in sources),
        ]
        for one in answers
    ]
    factors = factor_words(k for one in answers for k in one.cell.factors)
    return make_table(
        f"{in_words(name).capitalize()}: share of each source in the variance of the coefficients.",
        ("coefficient, coded", answers[0].unit.label("value"), "k [1]",
         *(f"{source_words(one)} [%]" for one in sources)),
        rows, synthetic=view.is_synthetic, is_compact=True,
        remarks=[f"±: expanded uncertainty, 95 % ({factors}).", source_meanings(sources)],
    )  # fmt: skip


def _percent(value: float) -> Cell:
    return Cell(f"{100 * value:.1f}", repr(value), is_number=True)
