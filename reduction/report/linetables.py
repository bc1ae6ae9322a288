"""Tables of the three-parameter line: of a test, and of the runs of an experiment."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from reduction.line.product import REASONS
from reduction.report.experimentview import ExperimentView
from reduction.report.htmltable import (
    NOT_GIVEN,
    Cell,
    Table,
    factors_of,
    make_table,
    measured,
    number,
    within,
    words,
)
from reduction.report.style import Shown, shown
from reduction.report.uncertainty import (
    DRAWN,
    drawn_interval,
    expanded_of,
    plus_minus_of_tests,
    shared_sources,
)
from reduction.report.view import TestView

__all__ = ["line_of_runs_table", "line_table"]

_PARAMETERS = (
    ("test_quasi_static_spring_constant", "tension", "K_0, quasi-static spring constant"),
    ("test_dissipation_spring_constant", "tension", "K_1, dissipation spring constant"),
    ("test_relaxation_time", "time", "tau, relaxation time"),
    ("test_dashpot_coefficient", "dashpot", "C = K_1 tau, dashpot coefficient"),
)
_FROM = "scatter between cycles, and K_0 with the fit of its slow pull"
_CONDITIONING = (
    "Conditioning, K_0 / (E' - K_0): how many times a relative error of K_0 enters E' - K_0, on"
    " which K_1 and tau stand."
)
_REFUSED = "refused because"


def line_table(view: TestView) -> Table | None:
    """Return the parameters of the line of each specimen of a test."""
    if "test_relaxation_time" not in view.data:
        return None
    rows = [[words(name), *_line_cells(view, k)] for k, name in enumerate(view.specimens)]
    columns, rows = _without_refusals(["specimen", *_line_columns(view)], rows)
    return make_table(
        "The three-parameter line: a spring K_0 beside a spring K_1 in series with a dashpot.",
        columns, rows, synthetic=view.is_synthetic,
        remarks=[_CONDITIONING, *_about_line(rows, [view])],
    )  # fmt: skip


def line_of_runs_table(view: ExperimentView, tests: Mapping[str, TestView]) -> Table | None:
    """Return the parameters of the line of each run, and those derived from surfaces beside."""
    names, specimens = view.texts("run_name"), view.texts("run_specimen")
    force, time = shown("tension", view.units), shown("time", view.units)
    derived = (
        (view.per_run("derived_dissipation_spring_constant"), force),
        (view.per_run("derived_relaxation_time"), time),
    )
    rows, used = [], []
    for k, (run, specimen) in enumerate(zip(names, specimens, strict=True)):
        test = tests.get(run)
        if test is None or "test_relaxation_time" not in test.data:
            continue
        used.append(test)
        rows.append(
            [
                words(view.runs[k]),
                *_line_cells(test, test.specimens.index(specimen)),
                *(number(float(values[k]), unit) for values, unit in derived),
            ]
        )
    if not used:
        return None
    tail = [force.label("K_1 from surfaces"), time.label("tau from surfaces")]
    columns, rows = _without_refusals(["run", *_line_columns(used[0]), *tail], rows)
    return make_table(
        "The three-parameter line of each run; at the right K_1 and tau from surfaces of E' and E''"
        " at the same levels, which smooth over the runs.",
        columns, rows, synthetic=view.is_synthetic, is_compact=True,
        remarks=[_CONDITIONING, *_about_line(rows, used)],
    )  # fmt: skip


def _line_columns(view: TestView) -> tuple[str, ...]:
    units = [_unit(view, kind).label(text) for _, kind, text in _PARAMETERS]
    return (*units, "conditioning [1]", _REFUSED)


def _without_refusals(
    columns: list[str], rows: list[list[Cell]]
) -> tuple[list[str], list[list[Cell]]]:
    """Return the table without its column of refusals where nothing was refused."""
    place = columns.index(_REFUSED)
    if any(row[place].text != NOT_GIVEN for row in rows):
        return columns, rows
    return (
        [*columns[:place], *columns[place + 1 :]],
        [[*row[:place], *row[place + 1 :]] for row in rows],
    )


def _line_cells(view: TestView, place: int) -> list[Cell]:
    cells = []
    for name, kind, _ in _PARAMETERS:
        values = view.array_like(name, np.empty(len(view.specimens)))
        drawn = drawn_interval(view, name, place)
        if drawn is not None:
            cells.append(within(float(values[place]), *drawn, _unit(view, kind)))
            continue
        spread = expanded_of(view, name, values)
        cells.append(
            measured(
                float(values[place]),
                float(spread.half[place]),
                _unit(view, kind),
                factor=float(spread.factor[place]),
            )
        )
    conditioning = view.array_like("test_line_conditioning", np.empty(len(view.specimens)))
    codes = view.array("test_line_refusal")
    reason = "" if codes is None else REASONS.get(int(codes[place]), "")
    return [*cells, number(float(conditioning[place]), digits=3), words(reason)]


def _about_line(rows: Sequence[Sequence[Cell]], tests: Sequence[TestView]) -> list[str]:
    names = [name for name, *_ in _PARAMETERS]
    has_fit = "quasi_static_fit" in shared_sources(tests, names)
    said = plus_minus_of_tests(
        factors_of(rows), tests, names, found_from="scatter between cycles" if has_fit else _FROM
    )
    is_drawn = any(
        drawn_interval(test, name, place) is not None
        for test in tests
        for name in names
        for place in range(len(test.specimens))
    )
    return [said, *([DRAWN] if is_drawn else [])]


def _unit(view: TestView, kind: str) -> Shown:
    force, time = shown("tension", view.units), shown("time", view.units)
    dashpot = Shown(f"{force.unit} {time.unit}", force.factor * time.factor)
    return {"tension": force, "time": time, "dashpot": dashpot}[kind]
