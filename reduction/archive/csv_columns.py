"""Writes the columns and rows of CSV tables block by block."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from functools import cached_property
from itertools import chain, pairwise
from math import prod
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pandas as pd
import xarray as xr
from numpy.typing import NDArray

from reduction.archive.atomic_write import append_atomically
from reduction.archive.campaign_products import outcomes_of_dataset
from reduction.experiments.outcome_groups import (
    EXPOSURE_COLUMNS,
    FATIGUE_COLUMNS,
    LOAD_LIFE_COLUMNS,
    STRENGTH_COLUMNS,
    OutcomeColumn,
    Row,
    exposure_rows,
    fatigue_rows,
    load_life_rows,
    strength_rows,
)
from reduction.quantities.names import (
    COMPARISON_SCHEMA,
    PREDICTION_SCHEMA,
    PROPERTY_SCHEMA,
    QUANTITIES,
    STEPWISE_SCHEMA,
    SURFACE_SCHEMA,
    TEST_SCHEMA,
    rows_of_response,
)
from reduction.quantities.row import TEXT, Quantity, schema_from
from reduction.quantities.table_columns import OF_TABLES
from reduction.record.measurement import Bools, Integers
from reduction.record.plain_text import safe_cell

Cell = str | int | float | None


@dataclass(frozen=True)
class CsvColumn:
    """A column: name, meaning, and the source variable of its values."""

    name: str
    variable: Quantity

    @property
    def header(self) -> str:
        """Column name with the unit, if it is a real number."""
        is_real = self.variable.dtype == "f8"
        return f"{self.name} [{self.variable.unit}]" if is_real else self.name

    @property
    def description(self) -> list[Cell]:
        """Header, unit, meaning, and reason for no uncertainty: a row of columns.csv."""
        row = self.variable
        unit = "" if row.is_text or row.flags else row.unit
        return [self.header, unit, row.long_name, row.no_uncertainty]


def uncertainty_of(column: CsvColumn) -> CsvColumn:
    """Return the uncertainty column of a measured one."""
    suffix = "_standard_uncertainty"
    return CsvColumn(f"{column.name}{suffix}", column.variable.companion(suffix))


def _shown_values(values: NDArray[Any], variable: Quantity) -> Sequence[Any] | NDArray[Any]:
    """Values of a column in table form: flags as their meanings, texts safe to open."""
    if variable.flags:
        return _each(values, lambda value: _flag_text(int(value), variable))
    if variable.dtype == TEXT:
        return _each(values, lambda value: safe_cell(str(value)))
    return values


def _each(values: NDArray[Any], worded: Callable[[Any], str]) -> list[str]:
    """Convert labels to text, each distinct one only once."""
    labels = values.tolist()
    words = {label: worded(label) for label in set(labels)}
    return [words[label] for label in labels]


def _flag_text(value: int, variable: Quantity) -> str:
    if variable.is_mask:
        return " ".join(name for name, bit in variable.flags.items() if value & bit)
    return next((name for name, number in variable.flags.items() if number == value), str(value))


def csv_text(header: Sequence[str], rows: Iterable[Sequence[Cell]]) -> str:
    """Return a table as CSV text; its texts are safe to open in a spreadsheet program."""
    return _text_of([[safe_cell(one) for one in header], *map(_safe, rows)])


def _safe(row: Sequence[Cell]) -> list[Cell]:
    """Return a row with its texts safe to open, and empty cells for missing numbers."""
    # only NaN differs from itself
    return [safe_cell(one) if isinstance(one, str) else None if one != one else one for one in row]


def _text_of(rows: Iterable[Sequence[Cell]]) -> str:
    text = io.StringIO(newline="")
    csv.writer(text, lineterminator="\r\n").writerows(rows)
    return text.getvalue()


def _cells(values: Sequence[Any] | NDArray[Any]) -> Sequence[Cell]:
    """Return a column as cells, empty for missing numbers."""
    if not isinstance(values, np.ndarray):
        return values
    cells: list[Cell] = values.tolist()
    if values.dtype.kind == "f" and np.isnan(values).any():
        return [None if one != one else one for one in cells]
    return cells


Product = Literal[
    "test", "stepwise test", "experiments", "predictions", "comparisons", "properties"
]

Variables = Mapping[str, xr.Variable]
"""Variables of an archive by name."""

TEST = CsvColumn("test", QUANTITIES["test"])

SYNTHETIC = CsvColumn("synthetic", QUANTITIES["synthetic"])

_SCHEMAS: dict[Product, Mapping[str, Quantity]] = {
    "test": TEST_SCHEMA | schema_from(OF_TABLES),
    "stepwise test": STEPWISE_SCHEMA | schema_from(OF_TABLES),
    "experiments": SURFACE_SCHEMA | schema_from(OF_TABLES, rows_of_response("response")),
    "predictions": PREDICTION_SCHEMA,
    "comparisons": COMPARISON_SCHEMA,
    "properties": PROPERTY_SCHEMA,
}


def _nothing(_: xr.Dataset) -> Variables:
    return {}


@dataclass(frozen=True)
class CsvTable:
    """Definition of one table: a row for each combination of the entries of ``dims``.

    Columns are the coordinates of the dimensions, the first ones, every number whose row names the
    table, and the last ones.  A measured one is followed by its uncertainty.

    Parameters
    ----------
    name : str
        File name without suffix.
    dims : tuple of str
        Dimensions, slowest first; a dimension with a coordinate gives a column.
    needs : tuple of str
        A row is written if one of these is known, or any number if none is listed.
    first, last : tuple of str
        Variables of the archive in order; ``column=variable`` renames one here.
    derive : callable
        Function from the archive to added or replaced variables for the table.
    product : str
        Type of product. A row of a test names the test; any other its experiment or hose.
    """

    name: str
    dims: tuple[str, ...]
    needs: tuple[str, ...]
    first: tuple[str, ...] = ()
    last: tuple[str, ...] = ()
    derive: Callable[[xr.Dataset], Variables] = _nothing
    product: Product = "test"

    @cached_property
    def own(self) -> list[str]:
        """Numbers whose rows name the table."""
        return [name for name, row in _SCHEMAS[self.product].items() if self.name in row.tables]

    @cached_property
    def columns(self) -> list[CsvColumn]:
        """All columns, with the test first and the synthetic-data mark last."""
        schema = _SCHEMAS[self.product]
        columns = [TEST] if self.product in ("test", "stepwise test") else []
        axes = (dim for dim in self.dims if dim in schema)
        for item in dict.fromkeys((*axes, *self.first, *self.own, *self.last)):
            name, _, source = item.partition("=")
            column = _column(name, schema[source or name])
            columns += [column, *_companions_of(column, is_of_runs=self.product == "experiments")]
        return [*columns, SYNTHETIC]


def _companions_of(column: CsvColumn, *, is_of_runs: bool) -> Iterator[CsvColumn]:
    """Yield the companions of a number; for a surface also the part not shared by its runs."""
    row = column.variable
    for suffix in row.companions:
        is_part = suffix in ("_random_standard_uncertainty", "_uncertainty_contribution")
        if not is_part or (is_of_runs and suffix.startswith("_random")):
            yield CsvColumn(f"{column.name}{suffix}", row.companion(suffix))


def _column(name: str, variable: Quantity) -> CsvColumn:
    # the axis is `branch_name`, because `branch` is a sample flag
    return CsvColumn("branch" if name == "branch_name" else name, variable)


BLOCK_ROWS = 1 << 12
"""Rows in a block: three megabytes of text for a table as wide as that of the cycles. [1]"""


def table_blocks(archive: xr.Dataset, table: CsvTable) -> Iterator[pd.DataFrame]:
    """Yield the rows of an archive for a table; none if it lacks the subject."""
    headers = [column.header for column in table.columns]
    for place, columns in column_blocks(archive, archive.variables, table):
        # columns absent from the archive are missing, as on reading its file
        known = [
            np.full(place.size, np.nan) if isinstance(one, list) and set(one) == {""} else one
            for one in columns
        ]
        yield pd.DataFrame(dict(zip(headers, known, strict=True)), index=place)


def column_blocks(
    archive: xr.Dataset,
    variables: Mapping[Any, xr.Variable],
    table: CsvTable,
    *,
    block_rows: int = BLOCK_ROWS,
) -> Iterator[tuple[Integers, list[Sequence[Any] | NDArray[Any]]]]:
    """Yield the places of the rows of a table, and their values by column."""
    needed = [name for name in table.needs or table.own if name in variables]
    sizes = {dim: archive.sizes.get(dim, -1) for dim in table.dims}
    if not needed or -1 in sizes.values():
        return
    derived = table.derive(archive)
    of_archive = {
        TEST.name: safe_cell(archive.attrs.get("test", "")),
        SYNTHETIC.name: archive.attrs.get("synthetic", "no"),
    }

    def variable_of(name: str) -> xr.Variable | None:
        return derived.get(name, variables.get(name))

    for block in _blocks(sizes, block_rows):
        known = np.any(
            [_is_known(_laid_out(derived.get(name, variables[name]), block)) for name in needed],
            axis=0,
        )
        n_rows = int(np.count_nonzero(known))
        if not n_rows:
            continue
        columns: list[Sequence[Any] | NDArray[Any]] = []
        for column in table.columns:
            own = None if column.name in of_archive else variable_of(column.variable.name)
            if own is None:
                columns.append([of_archive.get(column.name, "")] * n_rows)
                continue
            values = _laid_out(own, block)
            columns.append(
                _shown_values(values if n_rows == known.size else values[known], column.variable)
            )
        yield np.flatnonzero(known), columns


def _blocks(sizes: Mapping[str, int], most: int) -> Iterator[dict[str, range]]:
    """Split the combinations of dimension entries, the last fastest, into blocks."""
    shape = list(sizes.values())
    # complete along the last dimensions, one entry at a time along the first
    cut = next(axis for axis in range(len(shape)) if prod(shape[axis + 1 :]) <= most)
    step = max(1, most // max(1, prod(shape[cut + 1 :])))
    for outer in np.ndindex(*shape[:cut]):
        for start in range(0, shape[cut], step):
            part = range(start, min(start + step, shape[cut]))
            ranges = [*(range(at, at + 1) for at in outer), part, *map(range, shape[cut + 1 :])]
            yield dict(zip(sizes, ranges, strict=True))


def _laid_out(variable: xr.Variable, block: Mapping[str, range]) -> NDArray[Any]:
    """Broadcast a variable over the dimensions it lacks, and flatten it."""
    dims = variable.dims
    own = [dim for dim in block if dim in dims]
    if any(len(block[dim]) < variable.sizes[dim] for dim in own):
        variable = variable.isel({dim: slice(block[dim].start, block[dim].stop) for dim in own})
    values = np.asarray(variable.values)
    if dims == tuple(block):
        return values.ravel()
    values = values.transpose([dims.index(dim) for dim in own])
    axes = tuple(slice(None) if dim in own else np.newaxis for dim in block)
    return np.broadcast_to(values[axes], [len(entries) for entries in block.values()]).ravel()


def _is_known(values: NDArray[Any]) -> Bools:
    if values.dtype.kind == "f":
        return np.asarray(np.isfinite(values), dtype=bool)
    return np.ones(values.shape, dtype=bool)


@dataclass(frozen=True)
class GroupColumn:
    """A column of a table of outcomes."""

    column: OutcomeColumn

    @property
    def header(self) -> str:
        """Column name with the unit, if it is a real number."""
        unit = self.column.unit
        return f"{self.column.name} [{unit}]" if unit not in ("", "count") else self.column.name

    @property
    def description(self) -> list[Cell]:
        """Header, unit, meaning, and reason for no uncertainty: a row of columns.csv."""
        column = self.column
        unit = "1" if column.unit == "count" else column.unit
        return [self.header, unit, column.long_name, column.no_uncertainty]


_COLUMNS = {
    "strength": STRENGTH_COLUMNS,
    "exposure": EXPOSURE_COLUMNS,
    "fatigue": FATIGUE_COLUMNS,
    "load_life": LOAD_LIFE_COLUMNS,
}

OUTCOME_TABLES: dict[str, tuple[GroupColumn | CsvColumn, ...]] = {
    name: (*map(GroupColumn, columns), SYNTHETIC) for name, columns in _COLUMNS.items()
}
"""Columns of each table, with the synthetic-data mark last."""


def outcome_table_rows(archive: xr.Dataset) -> dict[str, list[list[Cell]]]:
    """Return the rows of every table of outcomes; empty if the outcomes lack its subject."""
    outcomes = outcomes_of_dataset(archive)
    synthetic = archive.attrs.get("synthetic", "no")
    rows: dict[str, list[Row]] = {
        "strength": strength_rows(outcomes),
        "exposure": exposure_rows(outcomes),
        "fatigue": fatigue_rows(outcomes),
        "load_life": load_life_rows(outcomes),
    }
    return {
        name: [[*map(_cell, row.values()), synthetic] for row in own] for name, own in rows.items()
    }


def _cell(value: float | str) -> Cell:
    return None if value != value else value  # only NaN differs from itself


_U = "_standard_uncertainty"

_ONE_READING = "there is one reading, and nothing is stated of it"

_OF_DESIGN = "nothing is stated of the numbers of the hose"

_OF_RUNS = "the runs leave no scatter to judge by"

_WHY = {
    "diameter": _ONE_READING,
    "area": _ONE_READING,
    "tension": "nothing is stated of it",
    "parameter_value": "the fit does not hold it: its interval is wider than its bounds",
    "event_strain": _OF_DESIGN,
    "event_tension": _OF_DESIGN,
    "event_fill_pressure": _OF_DESIGN,
    "response_coefficient": _OF_RUNS,
    "response_coefficient_engineering": _OF_RUNS,
    "property_stiffness": "property_remark says why",
    "property_stiffness_over_strength": "property_remark says why",
    "property_strain": "property_remark says why",
}

_UNKNOWN = "nothing is known of its scatter"


def _is_empty(values: Sequence[Any] | NDArray[Any]) -> Bools:
    """Find the empty cells of a column."""
    if isinstance(values, np.ndarray) and values.dtype.kind == "f":
        return np.asarray(np.isnan(values), dtype=bool)
    return np.array([one is None or one == "" or one != one for one in values], dtype=bool)


def column_descriptions(
    columns: Sequence[CsvColumn | GroupColumn], lonely: Collection[int] = ()
) -> Iterator[list[Cell]]:
    """Return the rows of columns.csv for one table."""
    quantities = dict(_uncertainties(columns))
    for place, column in enumerate(columns):
        *about, reason = column.description
        if place in lonely:
            reason = f"{reason}; empty where {_WHY.get(quantities[place], _UNKNOWN)}"
        yield [*about, reason]


def _uncertainties(columns: Sequence[CsvColumn | GroupColumn]) -> Iterator[tuple[int, str]]:
    """Indices of the uncertainty columns, with the quantity of each."""
    names = [column.header.partition(" [")[0] for column in columns]
    for place, (name, own) in enumerate(pairwise(names), start=1):
        if own == f"{name}{_U}":
            yield place, name


class TableFile:
    """A table built row by row; without rows no file is written.

    Parameters
    ----------
    path : pathlib.Path
        Path of the table.
    columns : sequence of Column or GroupColumn
        Its columns.
    whole : contextlib.ExitStack
        Exit stack that gives the file its final name.
    """

    def __init__(
        self, path: Path, columns: Sequence[CsvColumn | GroupColumn], whole: ExitStack
    ) -> None:
        """Start a table without rows."""
        self.path = path
        self.columns = columns
        self.lonely: set[int] = set()
        self._uncertainties = [place for place, _ in _uncertainties(columns)]
        self._whole = whole
        self._append: Callable[[str], None] | None = None

    @property
    def is_filled(self) -> bool:
        """Whether the table has a row."""
        return self._append is not None

    def add_columns(self, columns: Sequence[Sequence[Any] | NDArray[Any]]) -> None:
        """Add rows by columns, with texts already safe to open."""
        if not len(columns[0]):
            return
        rows: Iterable[Sequence[Cell]] = zip(*map(_cells, columns), strict=True)
        if self._append is None:
            self._append = self._whole.enter_context(append_atomically(self.path))
            rows = chain([[safe_cell(column.header) for column in self.columns]], rows)
        self._append(_text_of(rows))
        self.lonely |= {
            place
            for place in self._uncertainties
            if place not in self.lonely
            and (_is_empty(columns[place]) & ~_is_empty(columns[place - 1])).any()
        }

    def add_rows(self, rows: Sequence[Sequence[Cell]]) -> None:
        """Add rows of cells."""
        if rows:
            self.add_columns(list(zip(*map(_safe, rows), strict=True)))
