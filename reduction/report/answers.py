"""The answers of a test with the budget of their uncertainty, as the page shows them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from reduction.archive.budget import all_budgets
from reduction.report.htmltable import Cell, Table, make_table, measured, number, within, words
from reduction.report.instruments import instrument_sentences
from reduction.report.sources import in_order, source_meanings, source_words
from reduction.report.style import Kind, Shown, shown
from reduction.report.uncertainty import DRAWN, drawn_interval, factor_words
from reduction.report.view import TestView
from reduction.uncertainty.budget import Budget

_ANSWERS: tuple[tuple[str, str, Kind], ...] = (
    ("segment_modulus", "", "stress"),
    ("test_apparent_spring_constant", "K_ap", "tension"),
    ("test_hysteresis_energy", "H", "energy"),
    ("test_dissipation_spring_constant", "K_1", "tension"),
    ("test_relaxation_time", "tau", "time"),
    ("interval_modulus", "", "stress"),
)
_NAMES = " K_ap: apparent spring constant. H: hysteresis energy."
_LINE_NAMES = " K_1, tau: dissipation spring constant and relaxation time of the line."
_SMALL = 0.005


@dataclass(frozen=True)
class AnswerBudget:
    """One answer of a test: what it is, of which specimen, in which unit, and its budget.

    ``drawn`` is its interval where that was found by Monte Carlo; the shares are of first order.
    """

    words: str
    specimen: str
    unit: Shown
    budget: Budget
    drawn: tuple[float, float] | None = None

    @staticmethod
    def sources_of(answers: Sequence[AnswerBudget]) -> list[str]:
        """Every source that has a part in any of the answers, in fixed order."""
        return in_order({row.source for one in answers for row in one.budget.rows if row.share > 0})

    @property
    def cell(self) -> Cell:
        """Value and expanded uncertainty, without the unit."""
        one = self.budget
        if self.drawn is not None:
            return within(one.value, *self.drawn, self.unit)
        return measured(one.value, one.expanded_uncertainty, self.unit, factor=one.coverage_factor)

    @property
    def text(self) -> str:
        """Value, expanded uncertainty and unit; a plain number has none."""
        unit = "" if self.unit.unit == "1" else f" {self.unit.unit}"
        return f"{self.cell.text}{unit}"

    def share(self, source: str) -> float:
        """Share of a source in the variance; several errors of one source together. [1]."""
        return float(sum(row.share for row in self.budget.rows if row.source == source))

    def in_words(self) -> str:
        """Sources with their shares, largest first; what is below half a percent is left out."""
        shares = {name: self.share(name) for name in self.sources_of([self])}
        ordered = sorted(shares, key=lambda name: -shares[name])
        return ", ".join(
            f"{source_words(name)} {100 * shares[name]:.0f} %"
            for name in ordered
            if shares[name] >= _SMALL
        )


def answer_budgets(view: TestView) -> list[AnswerBudget]:
    """Return the budgets of the answers of a test: segments, K_ap, H, K_1, tau; of weights slopes.

    Parameters
    ----------
    view : TestView
        Of a reduced test; one that keeps no shared errors has no budget to show.

    Returns
    -------
    answers : list of AnswerBudget
        By quantity, in the order of the archive.
    """
    names = view.data["specimen"].values if "specimen" in view.data else ()
    places = {str(name): place for place, name in enumerate(names)}
    found = []
    for name, text, kind in _ANSWERS:
        for one in all_budgets(view.data, name):
            if not (np.isfinite(one.standard_uncertainty) and one.standard_uncertainty > 0):
                continue
            # a test with weights has one specimen
            place = places[one.place["specimen"]] if "specimen" in one.place else 0
            found.append(
                AnswerBudget(
                    text or _words_of(view, one),
                    view.specimens[place],
                    shown(kind, view.units),
                    one,
                    drawn_interval(view, name, place),
                )
            )
    return found


def _words_of(view: TestView, one: Budget) -> str:
    """Which segment it is, or between which readings."""
    if "segment" in one.place:
        return f"segment {one.place['segment']}, {one.place['branch_name']}"
    after = int(one.place["interval"])
    clock = view.texts("clock")
    return f"{clock[after - 1]} to {clock[after]}" if all(clock) else f"interval {after}"


def budget_table(view: TestView, answers: Sequence[AnswerBudget]) -> Table | None:
    """Return the numbers of the bars: value, uncertainty, factor, and the share of each source."""
    if not answers:
        return None
    sources = AnswerBudget.sources_of(answers)
    rows = [
        [
            words(f"{one.words}, {one.specimen}"),
            one.cell,
            words(one.unit.unit),
            number(float("nan") if one.drawn else one.budget.coverage_factor, digits=3),
            *(_share(one.share(source)) for source in sources),
        ]
        for one in answers
    ]
    has_line = any(one.words == "tau" for one in answers)
    names = _NAMES if any(one.words in ("K_ap", "H") for one in answers) else ""
    factors = factor_words(k for one in answers for k in one.cell.factors)
    return make_table(
        "Share of each source in the variance of the answers.",
        ("number", "value", "unit", "k [1]", *(f"{source_words(one)} [%]" for one in sources)),
        rows, synthetic=view.is_synthetic, is_compact=True,
        remarks=[
            f"±: expanded uncertainty, 95 % ({factors}).{names}{_LINE_NAMES if has_line else ''}",
            *([f"{DRAWN} Shares are of first order."] if any(one.drawn for one in answers) else []),
            source_meanings(sources),
        ],
    )  # fmt: skip


def _share(value: float) -> Cell:
    return Cell(f"{100 * value:.1f}", repr(value), is_number=True)


def budget_sentences(view: TestView, answers: Sequence[AnswerBudget]) -> list[str]:
    """Say where nothing is stated of the instruments: a bar without them is not all there is."""
    return instrument_sentences([view]) if answers else []
