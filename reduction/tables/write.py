"""Tables of a campaign, made from its archives alone."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from reduction.archive.open import open_archive
from reduction.archive.statederrors import says_what_is_shared
from reduction.archive.variable import label
from reduction.archive.write import write_whole
from reduction.tables.column import Cell, Column, csv_text
from reduction.tables.comparisons import COMPARISON_TABLES
from reduction.tables.definitions import TABLES
from reduction.tables.envelope import ENVELOPE_COLUMNS, Curve, curves_of, envelope_rows
from reduction.tables.experiments import EXPERIMENT_TABLES
from reduction.tables.holes import column_descriptions
from reduction.tables.outcomes import OUTCOME_TABLES, GroupColumn, outcome_table_rows
from reduction.tables.predictions import PREDICTION_TABLES
from reduction.tables.properties import PROPERTY_TABLES
from reduction.tables.responses import by_response
from reduction.tables.rows import table_rows
from reduction.tables.silent import as_silent, quantities_kept
from reduction.tables.static_dynamic import (
    STATIC_DYNAMIC_COLUMNS,
    Slope,
    slopes_of,
    static_dynamic_rows,
)
from reduction.tables.table import Table

__all__ = ["write_tables"]

_Place = tuple[float, list[tuple[int, str]]]
_ALL = (
    *TABLES, *PROPERTY_TABLES, *EXPERIMENT_TABLES, *PREDICTION_TABLES, *COMPARISON_TABLES,
)  # fmt: skip
_ABOUT = tuple(
    Column(name, label(name)[0])
    for name in ("table", "column", "unit", "meaning", "no_uncertainty")
)


def write_tables(
    archives: Sequence[Path],
    folder: Path,
    *,
    surfaces: Path | None = None,
    outcomes: Path | None = None,
    predictions: Path | None = None,
    comparisons: Path | None = None,
    change_in_length: Path | None = None,
) -> list[Path]:
    """Write every table that the archives fill, and columns.csv, which explains them.

    Parameters
    ----------
    archives : sequence of pathlib.Path
        Archives of one campaign; the rows stand in the order of the tests' places in
        the specimens' history, then of their names.
    folder : pathlib.Path
        Where the tables go.
    surfaces : pathlib.Path, optional
        Archive of the campaign's experiments, where it has any.
    outcomes : pathlib.Path, optional
        Archive of the campaign's outcomes without a log, where it has any.
    predictions : pathlib.Path, optional
        Archive of the campaign's predicted hoses, where it has any.
    comparisons : pathlib.Path, optional
        Archive of the campaign's comparisons, where it has any.
    change_in_length : pathlib.Path, optional
        Archive of the properties of the campaign's ropes, where it has any.

    Returns
    -------
    paths : list of pathlib.Path
        The files, in a fixed order. A table without rows is not written; one that an
        earlier run wrote and this one does not fill is removed once all is written.

    Raises
    ------
    ArchiveError
        If an archive cannot be opened or a table cannot be written.
    """
    columns: dict[str, Sequence[Column | GroupColumn]] = {
        table.name: table.columns for table in _ALL
    }
    columns |= {"envelope": ENVELOPE_COLUMNS, "static_dynamic": STATIC_DYNAMIC_COLUMNS}
    columns |= OUTCOME_TABLES
    of_tests, silent = _all_rows(archives)
    rows = of_tests | _experiment_rows(surfaces) | _outcome_rows(outcomes)
    rows |= _rows_as_they_are(predictions, PREDICTION_TABLES)
    rows |= _rows_as_they_are(comparisons, COMPARISON_TABLES)
    rows |= _rows_as_they_are(change_in_length, PROPERTY_TABLES)
    filled = [name for name in columns if rows[name]]
    rows["columns"] = [
        [f"{name}.csv", *described]
        for name, listed in [*((name, columns[name]) for name in filled), ("columns", _ABOUT)]
        for described in column_descriptions(listed, rows.get(name, ()), silent)
    ]
    columns["columns"] = _ABOUT
    paths = []
    for name in [*filled, "columns"]:
        path = folder / f"{name}.csv"
        write_whole(path, csv_text([column.header for column in columns[name]], rows[name]))
        paths.append(path)
    for name in columns:
        if folder / f"{name}.csv" not in paths:
            (folder / f"{name}.csv").unlink(missing_ok=True)
    return paths


def _place(attributes: dict[str, Any]) -> _Place:
    """Place in the history, tests without one last; then the name, T-2 before T-10."""
    name = re.split(r"(\d+)", attributes["test"])
    digits = [(int(part), "") if part.isdigit() else (-1, part) for part in name]
    return float(attributes.get("test_order", "inf")), digits


def _all_rows(archives: Sequence[Path]) -> tuple[dict[str, list[list[Cell]]], set[str]]:
    """Rows of every table of tests, and what some have no uncertainty of for being silent."""
    kept, says = set[str](), set[bool]()
    for path in archives:
        with open_archive(path) as archive:
            kept |= quantities_kept(archive)
            says.add(says_what_is_shared(archive))
    tests: list[tuple[_Place, dict[str, list[list[Cell]]], list[Curve], list[Slope]]] = []
    for path in archives:
        with open_archive(path) as whole:
            archive = as_silent(whole, kept)
            of_test = {table.name: table_rows(archive, table) for table in TABLES}
            curves, slopes = list(curves_of(archive)), list(slopes_of(archive))
            tests.append((_place(archive.attrs), of_test, curves, slopes))
    tests.sort(key=lambda entry: entry[0])
    rows = {
        table.name: [row for _, of_test, *_ in tests for row in of_test[table.name]]
        for table in TABLES
    }
    curves = [curve for _, _, own, _ in tests for curve in own]
    slopes = [slope for *_, own in tests for slope in own]
    rows |= {
        "envelope": envelope_rows(curves),
        "static_dynamic": static_dynamic_rows(slopes, curves),
    }
    return rows, kept if False in says else set()


def _experiment_rows(surfaces: Path | None) -> dict[str, list[list[Cell]]]:
    if surfaces is None:
        return {table.name: [] for table in EXPERIMENT_TABLES}
    with open_archive(surfaces) as archive:
        dataset = by_response(archive)
        return {table.name: table_rows(dataset, table) for table in EXPERIMENT_TABLES}


def _rows_as_they_are(path: Path | None, tables: Sequence[Table]) -> dict[str, list[list[Cell]]]:
    if path is None:
        return {table.name: [] for table in tables}
    with open_archive(path) as archive:
        return {table.name: table_rows(archive, table) for table in tables}


def _outcome_rows(outcomes: Path | None) -> dict[str, list[list[Cell]]]:
    if outcomes is None:
        return {name: [] for name in OUTCOME_TABLES}
    with open_archive(outcomes) as archive:
        return outcome_table_rows(archive)
