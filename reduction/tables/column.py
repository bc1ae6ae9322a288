"""One column of a table, and how a value of it is written.

A header carries the unit, ``segment_modulus [Pa]``; labels, flags and counts have none.
Cells follow RFC 4180: a real is written with the shortest digits that give the same
number back, NaN as an empty cell, and text that a spreadsheet would take for a formula
has an apostrophe before it.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from reduction.archive.variable import TEXT, Variable

__all__ = ["Cell", "Column", "cells_of", "csv_text", "uncertainty_of"]

Cell = str | int | float | None
_FORMULA = ("=", "+", "-", "@", "\t", "\r")


@dataclass(frozen=True)
class Column:
    """A column: name, what it holds, and the variable that its values come from."""

    name: str
    variable: Variable

    @property
    def header(self) -> str:
        """Name with the unit where it is a real number."""
        is_real = self.variable.dtype == "f8"
        return f"{self.name} [{self.variable.unit}]" if is_real else self.name

    @property
    def description(self) -> list[Cell]:
        """Header, unit, meaning, and why there is no uncertainty: a row of columns.csv."""
        row = self.variable
        unit = "" if row.is_text or row.flags else row.unit
        return [self.header, unit, row.long_name, row.no_uncertainty]


def uncertainty_of(column: Column) -> Column:
    """Return the column that stands beside a measured one."""
    name = f"{column.name}_standard_uncertainty"
    source = f"{column.variable.name}_standard_uncertainty"
    return Column(
        name, Variable(source, column.variable.dims, "f8", no_uncertainty="is an uncertainty")
    )


def cells_of(values: NDArray[Any], variable: Variable) -> list[Cell]:
    """Return the values of a column as cells; flags as their meanings."""
    if variable.flags:
        return [_flag_text(int(value), variable) for value in values]
    if variable.dtype == TEXT:
        return [str(value) for value in values]
    cells: list[Cell] = np.asarray(values).tolist()
    return [None if cell != cell else cell for cell in cells]  # NaN alone is not itself


def _flag_text(value: int, variable: Variable) -> str:
    if variable.is_mask:
        return " ".join(name for name, bit in variable.flags.items() if value & bit)
    return next((name for name, number in variable.flags.items() if number == value), str(value))


def csv_text(header: Sequence[str], rows: Iterable[Sequence[Cell]]) -> str:
    """Return a table as text of a CSV file."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\r\n")
    writer.writerow(header)
    writer.writerows([_written(cell) for cell in row] for row in rows)
    return text.getvalue()


def _written(cell: Cell) -> str:
    if cell is None:
        return ""
    if isinstance(cell, str):
        return f"'{cell}" if cell.startswith(_FORMULA) else cell
    return repr(cell)
