"""Tables of the holds: what each gave, and why it gave no more."""

from __future__ import annotations

import numpy as np

from reduction.report.htmltable import Table, make_table, measured, number, words
from reduction.report.style import shown
from reduction.report.view import TestView

__all__ = ["hold_table", "prony_table"]


def hold_table(view: TestView) -> Table | None:
    """Return the holds, with the reason beside every number that is refused."""
    start = view.array("hold_start_time")
    if start is None:
        return None
    force, seconds = shown("tension", view.units), shown("time", view.units)
    percent = shown("strain", view.units)
    names = (
        "hold_duration", "hold_strain", "hold_initial_tension", "hold_final_tension",
        "relaxation_drop", "relaxation_rate_per_decade", "creep_rate_per_decade",
    )  # fmt: skip
    values = {name: view.array_like(name, start) for name in names}
    half = {
        name: view.array_like(f"{name}_standard_uncertainty", start)
        for name in names[4:]
    }  # fmt: skip
    refusals = view.texts("hold_refusal") or ("",) * start.size
    rows = [
        [
            words(f"{place + 1}"),
            words(view.texts("hold_specimen")[place]),
            words(view.texts("hold_kind")[place]),
            number(start[place], seconds, digits=6),
            number(values["hold_duration"][place], seconds),
            number(values["hold_strain"][place], percent),
            number(values["hold_initial_tension"][place], force),
            number(values["hold_final_tension"][place], force),
            *(measured(values[name][place], half[name][place], percent) for name in names[4:]),
            words(refusals[place]),
        ]
        for place in range(start.size)
    ]
    columns = (
        "hold", "specimen", "kind", seconds.label("starts at"), seconds.label("lasts"),
        percent.label("strain"), force.label("tension at its start"),
        force.label("tension at its end"), percent.label("drop ± standard uncertainty"),
        "tension lost per decade of time ± standard uncertainty [%]",
        "strain gained per decade of time ± standard uncertainty [points of strain %]",
        "refused, and why",
    )  # fmt: skip
    return make_table(
        "Holds: relaxation at constant length, creep at constant tension.", columns, rows,
        synthetic=view.is_synthetic, is_tall=len(rows) > 12,
    )  # fmt: skip


def prony_table(view: TestView) -> Table | None:
    """Return the Prony series of the holds that support one."""
    tension, times = view.array("prony_tension"), view.array("prony_time")
    if tension is None or times is None:
        return None
    force, seconds = shown("tension", view.units), shown("time", view.units)
    halves = (
        view.array_like("prony_tension_standard_uncertainty", tension),
        view.array_like("prony_time_standard_uncertainty", times),
    )
    end = view.array_like("long_time_tension", tension[:, 0])
    end_half = view.array_like("long_time_tension_standard_uncertainty", end)
    criteria = view.texts("hold_criterion") or ("",) * end.size
    rows = []
    for hold, term in zip(*np.nonzero(np.isfinite(tension)), strict=True):
        own = (hold, term)
        rows.append(
            [
                words(f"{hold + 1}"),
                words(view.texts("hold_specimen")[hold]),
                number(float(term + 1)),
                measured(tension[own], halves[0][own], force),
                measured(times[own], halves[1][own], seconds),
                measured(end[hold], end_half[hold], force),
                words(criteria[hold]),
            ]
        )
    columns = (
        "hold", "specimen", "term", force.label("tension of the term"),
        seconds.label("relaxation time"), force.label("tension it tends to"),
        "number of terms chosen by",
    )  # fmt: skip
    return make_table(
        "Prony series of the holds; ±: standard uncertainty.", columns, rows,
        synthetic=view.is_synthetic,
    ) if rows else None  # fmt: skip
