"""Where the uncertainty of the answers comes from: a bar a number, a piece of it a source."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reduction.report.answer_tables import AnswerBudget
from reduction.report.figure_data import Figure, Trace, make_figure, named_axis, plain_numbers
from reduction.report.product_views import ExperimentView
from reduction.report.test_view import TestView
from reduction.report.text_style import bar_look, is_hatched, source_words

_HATCHED = " Hatched: another error of the same instrument as the plain bar of that colour."

_PER_LINE, _AROUND = 17, 110
"""Height of a line of the words of a bar, and of title and axis. [px]"""


def draw_budgets(view: TestView, answers: Sequence[AnswerBudget]) -> list[Figure]:
    """Draw the shares of the sources in the variance of each answer, one figure a specimen."""
    found = []
    for index, specimen in enumerate(view.specimens):
        own = [one for one in answers if one.specimen == specimen]
        if own:
            title = f"{view.id}: shares of the variance, {specimen}"
            found.append(_figure(f"{view.key}-budget-{index}", title, own, view.is_synthetic))
    return found


def draw_coefficient_budgets(
    view: ExperimentView, key: str, title: str, answers: Sequence[AnswerBudget]
) -> list[Figure]:
    """Draw the shares of the sources in the variance of the coefficients of a surface."""
    if not answers:
        return []
    return [_figure(f"{view.key}-{key}", f"{view.name}: {title}", answers, view.is_synthetic)]


def _figure(key: str, title: str, own: Sequence[AnswerBudget], synthetic: bool) -> Figure:
    sources = AnswerBudget.sources_of(own)
    # short lines: what they are wide, the bars are short of on a narrow screen
    names = [f"{one.words}\n{one.text}".replace(" by ", "\nby ") for one in own]
    lines = max(name.count("\n") + 1 for name in names)
    return make_figure(
        key, title,
        "Share of each source in the variance of a number, given with its expanded"
        f" uncertainty.{_HATCHED if any(map(is_hatched, sources)) else ''}",
        _bars(own, sources), synthetic=synthetic, spoken=_spoken(own),
        height=_AROUND + _PER_LINE * lines * len(own),
        barmode="stack", bargap=0.25, legend={"traceorder": "normal"},
        xaxis={"title": {"text": "share [%]"}, "range": [0, 100]},
        yaxis={**named_axis("number [its unit]", names), "autorange": "reversed"},
    )  # fmt: skip


def _bars(answers: Sequence[AnswerBudget], sources: Sequence[str]) -> list[Trace]:
    places = list(range(len(answers)))
    return [
        {
            "type": "bar", "orientation": "h", "name": source_words(source), "y": places,
            "x": plain_numbers(np.array([100 * one.share(source) for one in answers]), 4),
            "marker": bar_look(source), "hovertemplate": "%{x:.1f} %",
        }
        for source in sources
    ]  # fmt: skip


def _spoken(answers: Sequence[AnswerBudget]) -> str:
    """Say what a reader of the bars sees: the sources of each number, largest first."""
    return " ".join(f"{one.words}: {one.in_words()}." for one in answers)
