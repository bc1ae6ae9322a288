"""Tables of the holds: what each gave, and why it gave no more."""

from __future__ import annotations

import numpy as np

from reduction.report.htmltable import Table, count, factors_of, make_table, measured, words
from reduction.report.style import shown
from reduction.report.uncertainty import expanded_of, plus_minus_of_tests
from reduction.report.view import TestView

__all__ = ["hold_table", "prony_table", "refusals"]

_OF_HOLDS = "noise, regression"


def hold_table(view: TestView) -> Table | None:
    """Return the holds; a column that no hold fills is left out."""
    start = view.array("hold_start_time")
    if start is None:
        return None
    force, seconds = shown("tension", view.units), shown("time", view.units)
    percent = shown("strain", view.units)
    quantities = (
        ("hold_start_time", seconds, "starts at"),
        ("hold_duration", seconds, "lasts"),
        ("hold_strain", percent, "strain"),
        ("hold_initial_tension", force, "tension at its start"),
        ("hold_final_tension", force, "tension at its end"),
        ("relaxation_drop", percent, "tension lost"),
        ("relaxation_rate_per_decade", percent, "tension lost per decade of time"),
        ("creep_rate_per_decade", percent, "strain gained per decade of time"),
    )
    columns = ["hold", "specimen", "kind"]
    rows = [
        [words(f"{hold}"), words(specimen), words(kind)]
        for hold, specimen, kind in zip(
            view.hold_numbers, view.texts("hold_specimen"), view.texts("hold_kind"), strict=True
        )
    ]
    for name, unit, label in quantities:
        values = view.array_like(name, start)
        spread = expanded_of(view, name, start)
        if np.isfinite(values).any():
            columns.append(unit.label(label))
            for row, value, half, factor in zip(
                rows, values, spread.half, spread.factor, strict=True
            ):
                row.append(measured(value, half, unit, factor=factor))
    return make_table(
        "Holds: relaxation at constant length, creep at constant tension.", columns, rows,
        synthetic=view.is_synthetic, is_tall=len(rows) > 12,
        remarks=[
            plus_minus_of_tests(
                factors_of(rows), [view], [name for name, *_ in quantities], found_from=_OF_HOLDS
            )
        ],
    )  # fmt: skip


def refusals(view: TestView) -> list[str]:
    """Return the numbers that a hold does not support, each with its reason."""
    return _of_holds(view, "hold_refusal")


def _of_holds(view: TestView, name: str) -> list[str]:
    """Return the texts of the holds that have one, each with its hold and specimen."""
    owners = view.texts("hold_specimen")
    return [
        f"hold {number}, {owner}: {text}"
        for number, owner, text in zip(
            view.hold_numbers, owners, view.texts(name) or ("",) * len(owners), strict=True
        )
        if text
    ]


def prony_table(view: TestView) -> Table | None:
    """Return the Prony series of the holds that support one."""
    tension, times = view.array("prony_tension"), view.array("prony_time")
    if tension is None or times is None:
        return None
    force, seconds = shown("tension", view.units), shown("time", view.units)
    end = view.array_like("long_time_tension", tension[:, 0])
    of_tension, of_time, of_end = (
        expanded_of(view, name, values)
        for name, values in (
            ("prony_tension", tension), ("prony_time", times), ("long_time_tension", end),
        )
    )  # fmt: skip
    rows = []
    for hold, term in zip(*np.nonzero(np.isfinite(tension)), strict=True):
        own = (hold, term)
        rows.append(
            [
                words(f"{view.hold_numbers[hold]}"),
                words(view.texts("hold_specimen")[hold]),
                count(float(term + 1)),
                measured(tension[own], of_tension.half[own], force, factor=of_tension.factor[own]),
                measured(times[own], of_time.half[own], seconds, factor=of_time.factor[own]),
                measured(end[hold], of_end.half[hold], force, factor=of_end.factor[hold]),
            ]
        )
    columns = (
        "hold", "specimen", "term", force.label("tension of the term"),
        seconds.label("relaxation time"), force.label("tension it tends to"),
    )  # fmt: skip
    return make_table(
        "Prony series of the holds.", columns, rows,
        synthetic=view.is_synthetic,
        remarks=[
            *(f"Number of terms, {text}." for text in _of_holds(view, "hold_criterion")),
            plus_minus_of_tests(
                factors_of(rows), [view], ["prony_tension", "prony_time", "long_time_tension"],
                found_from=_OF_HOLDS,
            ),
        ],
    ) if rows else None  # fmt: skip
