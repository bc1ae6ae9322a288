"""One column of a table, and how a value of it is written.

A header carries the unit, ``segment_modulus [Pa]``; labels, flags and counts have none.
Cells follow RFC 4180: a real is written with the shortest digits that give the same
number back, NaN as an empty cell, and text that a spreadsheet would take for a formula
has an apostrophe before it.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from reduction.archive.variable import TEXT, Variable
from reduction.tables.digits import number_texts
from reduction.visible import safe_cell

Cell = str | int | float | None
_Label = TypeVar("_Label", int, str)


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


def texts_of_columns(columns: Sequence[tuple[NDArray[Any], Variable]]) -> list[list[str]]:
    """Return columns of one length as fields, those of real numbers written in one go.

    Parameters
    ----------
    columns : sequence of ndarray, shape (n_rows,), and Variable
        Values, and what they are. [unit of each]

    Returns
    -------
    texts : list of list of str
        A field a row of each, as `texts_of` has it.
    """
    is_real = [
        values.dtype.kind == "f" and not variable.flags and variable.dtype != TEXT
        for values, variable in columns
    ]
    real = [values for (values, _), one in zip(columns, is_real, strict=True) if one]
    written = number_texts(np.concatenate(real)) if real else []
    numbers = (written[len(part) * at : len(part) * (at + 1)] for at, part in enumerate(real))
    return [
        next(numbers) if one else texts_of(values, variable)
        for (values, variable), one in zip(columns, is_real, strict=True)
    ]


def texts_of(values: NDArray[Any], variable: Variable) -> list[str]:
    """Return the values of a column as fields of a CSV file; flags as their meanings.

    Parameters
    ----------
    values : ndarray, shape (n_rows,)
        Of the variable. [its unit]
    variable : Variable
        What they are.

    Returns
    -------
    texts : list of str
        A field a row, quoted where it has to be.
    """
    if variable.flags:
        return _labels([int(value) for value in values], partial(_flag_text, variable=variable))
    if variable.dtype == TEXT:
        return _labels([str(value) for value in values], str)
    if values.dtype.kind == "f":
        return number_texts(values)
    return [repr(value) for value in values.tolist()]


def _labels(labels: Sequence[_Label], worded: Callable[[_Label], str]) -> list[str]:
    """Put labels, most of which repeat, in fields."""
    field = {label: csv_field(worded(label)) for label in set(labels)}
    return [field[label] for label in labels]


def _flag_text(value: int, variable: Variable) -> str:
    if variable.is_mask:
        return " ".join(name for name, bit in variable.flags.items() if value & bit)
    return next((name for name, number in variable.flags.items() if number == value), str(value))


def csv_field(cell: Cell) -> str:
    """Return a cell as a field of a CSV file, quoted where it has to be.

    Examples
    --------
    >>> print(csv_field(0.1), csv_field("=a, b"))
    0.1 "'=a, b"
    """
    line = io.StringIO()
    # a second field keeps an empty one from being quoted; ends of lines are, with this terminator
    csv.writer(line, lineterminator="\r\n").writerow([_written(cell), ""])
    return line.getvalue().removesuffix(",\r\n")


def csv_lines(columns: Iterable[Sequence[str]]) -> str:
    """Return columns of fields, two at least, as lines of a CSV file.

    Raises
    ------
    ValueError
        If the columns differ in length.
    """
    return "".join(f"{line}\r\n" for line in map(",".join, zip(*columns, strict=True)))


def csv_text(header: Sequence[str], rows: Iterable[Sequence[Cell]]) -> str:
    """Return a table as text of a CSV file."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\r\n")
    writer.writerow(map(safe_cell, header))
    writer.writerows([_written(cell) for cell in row] for row in rows)
    return text.getvalue()


def _written(cell: Cell) -> str:
    if cell is None:
        return ""
    if isinstance(cell, str):
        return safe_cell(cell)
    return repr(cell)
