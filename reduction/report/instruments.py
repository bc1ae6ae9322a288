"""What is stated of the instruments, as the archives of the tests keep it in their settings."""

from __future__ import annotations

from collections.abc import Sequence

from reduction.archive.statederrors import stated_errors_of
from reduction.report.htmltable import Table, make_table, number, words
from reduction.report.style import Shown, shown
from reduction.report.view import TestView, any_synthetic
from reduction.uncertainty.stated import StatedErrors
from reduction.units import UnitSystem

NOTHING_STATED = (
    "No error of the instruments is stated: the uncertainty holds scatter and tape readings alone."
)
_PERCENT = Shown("%", 100.0)


def instrument_table(tests: Sequence[TestView], units: UnitSystem) -> Table | None:
    """Return what is stated, a column for each statement; None where nothing is.

    Tests of one campaign are usually reduced with one statement.
    """
    statements: dict[StatedErrors, list[TestView]] = {}
    for view in tests:
        if is_stated(view):
            statements.setdefault(stated_errors_of(view.data), []).append(view)
    if not statements:
        return None
    rows = [
        [words(unit.label(text)),
         *(number(getattr(one, key), unit, digits=3) for one in statements)]
        for key, text, unit in _rows(units)
        if any(getattr(one, key) for one in statements)
    ]  # fmt: skip
    is_one = len(statements) == 1 and len(next(iter(statements.values()))) == len(tests)
    columns = (
        ["standard uncertainty"]
        if is_one
        else [", ".join(view.id for view in views) for views in statements.values()]
    )
    without = [view.id for view in tests if not is_stated(view)]
    has_one_cell = any(one.has_one_load_cell for one in statements)
    remarks = [
        "Standard uncertainties (k = 1), as computed from what campaign.toml states; what has no"
        " row counts as known.",
        *(["All tension channels share the errors of one load cell."] if has_one_cell else []),
        *([f"Nothing is stated of {', '.join(without)}."] if without else []),
    ]
    return make_table(
        "What is stated of the instruments.", ("error, with its unit", *columns), rows,
        synthetic=any_synthetic(tests), remarks=remarks,
    )  # fmt: skip


def instrument_sentences(tests: Sequence[TestView]) -> list[str]:
    """Return the sentence that nothing is stated, where that is so of all tests."""
    return [NOTHING_STATED] if tests and not any(is_stated(view) for view in tests) else []


def is_stated(view: TestView) -> bool:
    """Return whether the archive states any error of the instruments."""
    return stated_errors_of(view.data).has_any


def _rows(units: UnitSystem) -> tuple[tuple[str, str, Shown], ...]:
    force, length = shown("tension", units), shown("length", units)
    small, time = shown("small length", units), Shown("ms", 1e3)
    return (
        ("tension_gain", "gain of tension", _PERCENT),
        ("tension_offset", "zero of tension", force),
        ("tension_reading", "one reading of tension", force),
        ("position_gain", "gain of position", _PERCENT),
        ("position_offset", "zero of position", length),
        ("position_reading", "one reading of position", length),
        ("lag", "lag between the channels", time),
        ("diameter", "mean diameter", small),
        ("strain_gain", "strain, by its method", _PERCENT),
        ("rated_break_strength", "rated break strength", _PERCENT),
        ("stiffness", "stiffness, for the temperature of the test", _PERCENT),
    )
