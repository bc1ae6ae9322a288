"""Tables of a campaign, made from its archives alone."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import xarray as xr

from reduction.archive.open import Opener, reading
from reduction.archive.variable import label
from reduction.archive.whole import take_away
from reduction.tables.column import Column
from reduction.tables.comparisons import COMPARISON_TABLES
from reduction.tables.definitions import TABLES
from reduction.tables.envelope import ENVELOPE_COLUMNS, Curve, curves_of, envelope_rows
from reduction.tables.experiments import EXPERIMENT_TABLES
from reduction.tables.file import TableFile
from reduction.tables.holes import column_descriptions
from reduction.tables.outcomes import OUTCOME_TABLES, GroupColumn, outcome_table_rows
from reduction.tables.predictions import PREDICTION_TABLES
from reduction.tables.properties import PROPERTY_TABLES
from reduction.tables.responses import by_response
from reduction.tables.rows import table_blocks
from reduction.tables.static_dynamic import (
    STATIC_DYNAMIC_COLUMNS,
    Slope,
    slopes_of,
    static_dynamic_rows,
)
from reduction.tables.table import Table

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
    opener: Opener = reading,
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
    opener : Opener
        How archives are opened.

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
    columns |= OUTCOME_TABLES | {"columns": _ABOUT}
    with ExitStack() as whole:
        files = {
            name: TableFile(folder / f"{name}.csv", listed, whole)
            for name, listed in columns.items()
        }
        _add_tests(files, archives, opener)
        _add_experiments(files, surfaces, opener)
        _add_outcomes(files, outcomes, opener)
        _add_as_it_is(files, predictions, PREDICTION_TABLES, opener)
        _add_as_it_is(files, comparisons, COMPARISON_TABLES, opener)
        _add_as_it_is(files, change_in_length, PROPERTY_TABLES, opener)
        filled = [name for name in columns if files[name].is_filled] + ["columns"]
        files["columns"].add_rows(
            [
                [f"{name}.csv", *described]
                for name in filled
                for described in column_descriptions(columns[name], files[name].lonely)
            ]
        )
    for name in columns:
        if name not in filled:
            take_away(files[name].path)
    return [files[name].path for name in filled]


def _place(attributes: dict[str, Any]) -> _Place:
    """Place in the history, tests without one last; then the name, T-2 before T-10."""
    name = re.split(r"(\d+)", attributes["test"])
    digits = [(int(part), "") if part.isdigit() else (-1, part) for part in name]
    return float(attributes.get("test_order", "inf")), digits


def _add_tests(files: Mapping[str, TableFile], archives: Sequence[Path], opener: Opener) -> None:
    places: dict[Path, _Place] = {}
    for path in archives:
        with opener(path) as archive:
            places[path] = _place(archive.attrs)
    curves: list[Curve] = []
    slopes: list[Slope] = []
    for path in sorted(archives, key=places.__getitem__):
        with opener(path) as archive:
            for table in TABLES:
                _add(files[table.name], archive, table)
            curves += curves_of(archive)
            slopes += slopes_of(archive)
    files["envelope"].add_rows(envelope_rows(curves))
    files["static_dynamic"].add_rows(static_dynamic_rows(slopes, curves))


def _add_experiments(files: Mapping[str, TableFile], surfaces: Path | None, opener: Opener) -> None:
    if surfaces is None:
        return
    with opener(surfaces) as archive:
        dataset = by_response(archive)
        for table in EXPERIMENT_TABLES:
            _add(files[table.name], dataset, table)


def _add_as_it_is(
    files: Mapping[str, TableFile], path: Path | None, tables: Sequence[Table], opener: Opener
) -> None:
    if path is None:
        return
    with opener(path) as archive:
        for table in tables:
            _add(files[table.name], archive, table)


def _add_outcomes(files: Mapping[str, TableFile], outcomes: Path | None, opener: Opener) -> None:
    if outcomes is None:
        return
    with opener(outcomes) as archive:
        for name, rows in outcome_table_rows(archive).items():
            files[name].add_rows(rows)


def _add(file: TableFile, archive: xr.Dataset, table: Table) -> None:
    for fields in table_blocks(archive, table):
        file.add(fields)
