"""Where the uncertainty of the answers comes from: a bar a number, a piece of it a source."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reduction.report.answers import AnswerBudget
from reduction.report.figure import Figure, Trace, make_figure, named_axis, plain_numbers
from reduction.report.sources import bar_look, is_hatched, source_words
from reduction.report.view import TestView

__all__ = ["draw_budgets"]

_HATCHED = " Hatched: of the same thing as the plain bar of that colour."
_PER_BAR, _AROUND = 34, 110
"""Height of a bar with its words, and of title and axis. [px]"""


def draw_budgets(view: TestView, answers: Sequence[AnswerBudget]) -> list[Figure]:
    """Draw the shares of the sources in the variance of each answer, one figure a specimen."""
    found = []
    for index, specimen in enumerate(view.specimens):
        own = [one for one in answers if one.specimen == specimen]
        if not own:
            continue
        sources = AnswerBudget.sources_of(own)
        names = [f"{one.words}\n{one.text}" for one in own]
        found.append(
            make_figure(
                f"{view.key}-budget-{index}", f"{view.id}: shares of the variance, {specimen}",
                "Share of each source in the variance of a number, which stands with its expanded"
                f" uncertainty.{_HATCHED if any(map(is_hatched, sources)) else ''}",
                _bars(own, sources), synthetic=view.is_synthetic, spoken=_spoken(own),
                height=_AROUND + _PER_BAR * len(own),
                barmode="stack", bargap=0.25, legend={"traceorder": "normal"},
                xaxis={"title": {"text": "share of the variance [%]"}, "range": [0, 100]},
                yaxis={**named_axis("number [its unit]", names), "autorange": "reversed"},
            )
        )  # fmt: skip
    return found


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
