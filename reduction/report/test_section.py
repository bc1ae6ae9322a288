"""The section of one test."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from reduction.record.measurement import Floats
from reduction.report.answer_tables import answer_budgets, budget_sentences, budget_table
from reduction.report.campaign_summary import brief, grouped_notes
from reduction.report.figure_data import Figure, plain_numbers, script_json
from reduction.report.figures.budget_figures import draw_budgets
from reduction.report.figures.cycle_figures import draw_loops, draw_trends
from reduction.report.figures.hold_figures import draw_holds, draw_pull
from reduction.report.figures.modulus_figures import (
    draw_cycle_curves,
    draw_moduli,
    draw_mooney,
    draw_steps,
)
from reduction.report.figures.record_figures import draw_record, draw_splices, draw_tension_position
from reduction.report.test_tables import (
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
from reduction.report.test_view import TestView
from reduction.report.text_style import PageTable

MOST = 4000
"""Most cycles of a test that a reader can choose from; a page has to stay small."""

_DIGITS = 9


@dataclass(frozen=True)
class _CycleLinks:
    """Cycles of a test that can be chosen: their numbers, and from when to when each was."""

    count: int
    number: Floats
    start: Floats
    end: Floats

    def json(self) -> str:
        """The same for a script element; numbers are left out where all cycles are listed."""
        document: dict[str, object] = {
            "count": self.count,
            "start": plain_numbers(self.start, _DIGITS),
            "end": plain_numbers(self.end, _DIGITS),
        }
        if self.number.size < self.count:
            document["number"] = [int(one) for one in self.number]
        return script_json(document)


def _cycle_links(view: TestView) -> _CycleLinks | None:
    """Return the cycles of a test that a reader can choose; None where there are not two.

    Examples
    --------
    >>> import xarray as xr
    >>> data = xr.Dataset(
    ...     {
    ...         "cycle_start_time": ("cycle", [10.0, 12.0]),
    ...         "frequency": ("cycle", [0.5, 0.4]),
    ...     },
    ...     coords={"cycle": [1, 2]},
    ... )
    >>> _cycle_links(TestView("test-0", data)).json()
    '{"count":2,"start":[10.0,12.0],"end":[12.0,14.5]}'
    """
    cycle, start = view.array("cycle"), view.array("cycle_start_time")
    if cycle is None or start is None or cycle.size < 2:
        return None
    end = start + 1.0 / view.array_like("frequency", start)
    places = _listed(view, cycle)
    # one clock for all specimens, but of one that broke early the later cycles are not known
    start, end = (
        _first_known(values.reshape(-1, cycle.size)[:, places]) for values in (start, end)
    )
    return _CycleLinks(cycle.size, cycle[places], start, end)


def _listed(view: TestView, cycle: Floats) -> np.ndarray[tuple[int], np.dtype[np.intp]]:
    """Return the places of the cycles to list, rising."""
    if cycle.size <= MOST:
        return np.arange(cycle.size)
    drawn = view.array_like("selected_cycle", np.zeros(0))
    loops = view.stored_near(np.array([1.0, (cycle.size + 1) // 2, cycle.size]))
    wanted = np.searchsorted(cycle, np.concatenate([drawn[np.isfinite(drawn)], loops]))
    even = np.linspace(0, cycle.size - 1, MOST).round().astype(np.intp)
    return np.unique(np.concatenate([even, np.minimum(wanted, cycle.size - 1)]))


def _first_known(values: Floats) -> Floats:
    """Return of each column the first finite value; NaN where there is none."""
    row = np.argmax(np.isfinite(values), axis=0)
    return np.asarray(values[row, np.arange(values.shape[1])])


_BUDGETS = "Where the uncertainty comes from"

_LINES = ("raw_file", "raw_file_sha256", "raw_file_bytes")

_LONG = ("settings", "raw_metadata", "history")


@dataclass(frozen=True)
class Part:
    """One heading with sentences, figures and tables under it; what is folded opens by a click."""

    heading: str
    figures: tuple[Figure, ...] = ()
    tables: tuple[PageTable, ...] = ()
    sentences: tuple[str, ...] = ()
    refusals: tuple[str, ...] = ()
    folded: Part | None = None
    warnings: tuple[str, ...] = ()


@dataclass(frozen=True)
class TestSection:
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
    cycles: _CycleLinks | None = None


def make_part(
    heading: str,
    figures: Sequence[Figure] = (),
    tables: Sequence[PageTable | None] = (),
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


def make_section(view: TestView) -> TestSection:
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
    return TestSection(
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
        cycles=_cycle_links(view),
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
