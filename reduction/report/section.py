"""The section of one test: its parts in reading order, each with figures and tables."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from reduction.report.answers import (
    answer_budgets,
    budget_sentences,
    budget_table,
)
from reduction.report.cyclelinks import CycleLinks, cycle_links
from reduction.report.figure import Figure
from reduction.report.figures.budgets import draw_budgets
from reduction.report.figures.elastomers import draw_mooney
from reduction.report.figures.holds import draw_holds
from reduction.report.figures.loops import draw_loops
from reduction.report.figures.moduli import draw_cycle_curves, draw_moduli
from reduction.report.figures.pull import draw_pull
from reduction.report.figures.record import draw_record, draw_tension_position
from reduction.report.figures.splices import draw_splices
from reduction.report.figures.stepwise import draw_steps
from reduction.report.figures.trends import draw_trends
from reduction.report.htmltable import Table
from reduction.report.summary import brief, grouped_notes
from reduction.report.testtables import (
    coefficient_table,
    elastomer_table,
    flag_table,
    history_table,
    hold_table,
    identity_table,
    interval_table,
    line_table,
    mark_table,
    prony_table,
    pull_share_table,
    pull_table,
    refusals,
    segment_table,
    slip_table,
    slope_sentences,
    step_table,
    stress_table,
    summary_table,
)
from reduction.report.view import TestView

_BUDGETS = "Where the uncertainty comes from"
_LINES = ("raw_file", "raw_file_sha256", "raw_file_bytes")
_LONG = ("settings", "raw_metadata", "history")


@dataclass(frozen=True)
class Part:
    """One heading with sentences, figures and tables under it; what is folded opens by a click."""

    heading: str
    figures: tuple[Figure, ...] = ()
    tables: tuple[Table, ...] = ()
    sentences: tuple[str, ...] = ()
    refusals: tuple[str, ...] = ()
    folded: Part | None = None
    warnings: tuple[str, ...] = ()


@dataclass(frozen=True)
class Section:
    """One test, or what ``noun`` says: its parts, its notes, and where its numbers come from.

    ``subtitle`` is what is seen of a section while it is folded; ``cycles`` are those that a
    reader can choose in its figures.
    """

    key: str
    title: str
    subtitle: str
    parts: tuple[Part, ...]
    notes: tuple[tuple[str, list[str]], ...]
    provenance: tuple[tuple[str, str], ...]
    documents: tuple[tuple[str, str], ...] = field(default=())
    noun: str = "test"
    cycles: CycleLinks | None = None


def make_part(
    heading: str,
    figures: Sequence[Figure] = (),
    tables: Sequence[Table | None] = (),
    sentences: Sequence[str] = (),
    refusals: Sequence[str] = (),
    folded: Part | None = None,
    warnings: Sequence[str] = (),
) -> Part:
    """Return a part; tables that a test does not give are left out."""
    given = tuple(table for table in tables if table is not None)
    return Part(
        heading, tuple(figures), given, tuple(sentences), tuple(refusals), folded, tuple(warnings)
    )


def make_section(view: TestView) -> Section:
    """Return the section of one test; parts with nothing in them are left out."""
    parts = [
        make_part("Stepwise readings", draw_steps(view), [step_table(view), interval_table(view)]),
        make_part("Slow pull", draw_pull(view), [pull_table(view), pull_share_table(view)]),
        make_part("Modulus against strain", draw_moduli(view), [segment_table([view])]),
        make_part(
            "Record",
            [*draw_record(view), *draw_tension_position(view)],
            [flag_table(view)],
        ),
        make_part("Loops", draw_loops(view)),
        make_part(
            "Cycle by cycle", [*draw_trends(view), *draw_cycle_curves(view)],
            [summary_table(view), slip_table(view), identity_table(view)],
        ),
        make_part("Three-parameter line", (), [line_table(view)]),
        _budget_part(view),
        make_part(
            "Holds", draw_holds(view), [hold_table(view), prony_table(view)],
            refusals=refusals(view),
        ),
        make_part(
            "Strain and splices" if view.is_rubber else "Strain", draw_splices(view),
            [coefficient_table(view), mark_table(view)], slope_sentences(view),
        ),
        make_part("First loading", draw_mooney(view), [stress_table(view), elastomer_table(view)]),
        make_part("History of the specimens", (), [history_table(view)]),
    ]  # fmt: skip
    provenance, documents = provenance_of(view.data.attrs)
    return Section(
        key=view.key,
        title=view.id,
        subtitle="; ".join(
            part
            for part in (view.kind, f"specimens: {', '.join(view.specimens)}", brief(view))
            if part
        ),
        parts=tuple(part for part in parts if part.figures or part.tables or part.sentences),
        notes=tuple(grouped_notes(view)),
        provenance=provenance,
        documents=documents,
        cycles=cycle_links(view),
    )


def _budget_part(view: TestView) -> Part:
    """Where the uncertainty of the answers comes from; the numbers of the bars are folded."""
    answers = answer_budgets(view)
    if not answers:
        return make_part(_BUDGETS)
    return make_part(
        _BUDGETS, draw_budgets(view, answers), (), budget_sentences(view, answers),
        folded=make_part("The same in numbers", (), [budget_table(view, answers)]),
    )  # fmt: skip


def provenance_of(
    attributes: Mapping[Any, Any],
) -> tuple[tuple[tuple[str, str], ...], tuple[tuple[str, str], ...]]:
    """Return the lines that say where numbers come from, and the long documents."""
    given = {str(name): str(value) for name, value in attributes.items()}
    known = {*_LINES, *_LONG, "test", "title", "id"}
    lines = [(name, given.get(name, "")) for name in _LINES]
    lines += [
        (name, " ".join(text.splitlines())) for name, text in given.items() if name not in known
    ]
    documents = [(name, _readable(given.get(name, ""))) for name in _LONG]
    return (
        tuple((name, text) for name, text in lines if text),
        tuple((name, text) for name, text in documents if text),
    )


def _readable(text: str) -> str:
    """Return JSON with line ends; other text as it is."""
    try:
        return json.dumps(json.loads(text), indent=1, ensure_ascii=False)
    except json.JSONDecodeError:
        return text
