"""Cells of a sheet to numbers: quickly where all is well, exactly where it is not.

A cell is a number, a declared missing mark, or an error.  The fast look takes columns
that hold nothing but numbers and blanks straight from arrow.  Every other column is read
cell by cell, because arrow would be given 1 for ``TRUE`` and 12 for the text ``12``.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import fastexcel
import numpy as np
import python_calamine

from reduction.errors import LogError
from reduction.ingest.clock import clock_to_seconds
from reduction.ingest.columns import Wanted, without_marks
from reduction.ingest.layout import CLOCK, Layout
from reduction.record import Bools, Floats

_ERROR_CELL = re.compile(r"Error\((\w+)\)")
_ERROR_MARKS = {
    "NA": "#N/A",
    "Div0": "#DIV/0!",
    "Name": "#NAME?",
    "Null": "#NULL!",
    "Num": "#NUM!",
    "Ref": "#REF!",
    "Value": "#VALUE!",
    "GettingData": "#GETTING_DATA",
}


class parsed:  # noqa: N801 - read as a word of the ``with`` statement
    """Make a `LogError` of whatever the parser of workbooks ends with.

    Where one of its own checks fails it ends with a class that no ``except Exception`` catches.
    """

    def __init__(self, path: Path, problem: str, *, needed: str | None = None) -> None:
        """Remember what is said then."""
        self._path, self._problem, self._needed = path, problem, needed

    def __enter__(self) -> None:
        """Begin to parse."""

    def __exit__(
        self, _: type[BaseException] | None, error: BaseException | None, __: object
    ) -> None:
        """Tell how it ended."""
        faults = (python_calamine.CalamineError, fastexcel.FastExcelError, OSError)
        if error is not None and (
            isinstance(error, faults) or type(error).__name__ == "PanicException"
        ):
            found = _first_line(error)
            raise LogError(self._path, self._problem, found=found, needed=self._needed) from error


def _first_line(error: BaseException) -> str:
    return (str(error).splitlines() or [type(error).__name__])[0]


@dataclass
class SheetCells:
    """Declared columns of a sheet, where they are blank, and the text of a clock."""

    values: list[Floats] = field(default_factory=list)
    blanks: list[Bools] = field(default_factory=list)
    text: dict[str, tuple[str, ...]] = field(default_factory=dict)


def _fast_columns(
    workbook: fastexcel.ExcelReader,
    sheet: int,
    first: int,
    places: Sequence[int],
    wanted: Sequence[Wanted],
    layout: Layout,
) -> SheetCells | None:
    """Columns that hold numbers and blanks (NaN) alone; None where one holds more."""
    if any(want.unit == CLOCK for want in wanted):
        return None
    order = sorted(set(places))
    try:
        batch, errors = workbook.load_sheet(
            sheet,
            header_row=None,
            skip_rows=first,
            use_columns=order,
            schema_sample_rows=None,
            dtype_coercion="strict",
        ).to_arrow_with_errors()
    except fastexcel.FastExcelError:  # the exact look finds out what is wrong
        return None
    if errors is not None or not {str(kind) for kind in batch.schema.types} <= {"double", "int64"}:
        return None
    columns = [column.to_numpy(zero_copy_only=False) for column in batch.columns]
    values = [np.array(columns[order.index(place)], dtype=np.float64) for place in places]
    if any(np.isinf(column).any() for column in values):
        return None
    return SheetCells(
        [without_marks(column, layout) for column in values],
        [np.isnan(column) for column in values],
    )


def _error_cells(
    workbook: fastexcel.ExcelReader, sheet: int, first: int
) -> dict[tuple[int, int], str]:
    """Spreadsheet errors by row and column from 0; the exact path sees them as blanks."""
    _, errors = workbook.load_sheet(
        sheet, header_row=None, skip_rows=first, dtypes="float"
    ).to_arrow_with_errors()
    found = {}
    for error in errors.errors if errors is not None else []:
        match = _ERROR_CELL.search(error.detail)
        if match is not None:
            row, column = error.position
            found[row, column] = _ERROR_MARKS.get(match[1], f"#{match[1]}")
    return found


def _clock_text(cell: object) -> str:
    """Time of day as text; 945 is 09:45."""
    if isinstance(cell, float) and cell.is_integer():
        return f"{cell:04.0f}"
    return cell.strip() if isinstance(cell, str) else str(cell)


def _exact_columns(
    path: Path,
    workbook: fastexcel.ExcelReader,
    sheet: int,
    first: int,
    places: Sequence[int],
    wanted: Sequence[Wanted],
    layout: Layout,
) -> SheetCells:
    """Columns cell by cell; `LogError` at the first that is neither number nor missing mark."""
    with parsed(path, f"sheet {sheet + 1} cannot be read"):
        rows = (
            python_calamine.CalamineWorkbook.from_path(path)
            .get_sheet_by_index(sheet)
            .to_python(skip_empty_area=False)[first:]
        )
        columns: list[list[Any]] = [[row[place] for row in rows] for place in places]
        if any("" in cells for cells in columns):  # an error value looks blank here
            errors = _error_cells(workbook, sheet, first)
            for (row, place), mark in errors.items():
                for index in (i for i, wanted_place in enumerate(places) if wanted_place == place):
                    columns[index][row - first] = mark
    found = SheetCells()
    for cells, want in zip(columns, wanted, strict=True):
        odd = [
            index for index, cell in enumerate(cells) if type(cell) is not float or math.isinf(cell)
        ]
        blank = np.zeros(len(cells), dtype=bool)
        blank[[i for i in odd if isinstance(cells[i], str) and not cells[i].strip()]] = True
        found.blanks.append(blank)
        if want.unit == CLOCK:
            found.text[want.key] = tuple(_clock_text(cell) for cell in cells)
            found.values.append(
                clock_to_seconds(
                    path,
                    found.text[want.key],
                    channel=str(want.column),
                    missing=("", *layout.missing),
                    row=None,
                    first_row=first + 1,
                )
            )
            continue
        for index in odd:
            cells[index] = _number(path, cells[index], want, layout, row=first + index + 1)
        found.values.append(without_marks(np.array(cells, dtype=np.float64), layout))
    return found


def _number(path: Path, cell: object, want: Wanted, layout: Layout, *, row: int) -> float:
    """A cell that is no float: a whole number, or NaN for a blank or a missing mark."""
    if type(cell) is int:  # a bool is no number
        return float(cell)
    if isinstance(cell, str) and (not cell.strip() or cell.strip() in layout.missing):
        return math.nan
    raise LogError(
        path,
        "a cell does not hold a number",
        row=row,
        channel=str(want.column),
        found=f"the text {cell!r}" if isinstance(cell, str) else f"{type(cell).__name__} {cell}",
        needed=f"a number in {want.unit}",
        hint="Make the cell a number, or add its text to the missing marks.",
    )


def read_cells(
    path: Path,
    workbook: fastexcel.ExcelReader,
    sheet: int,
    first: int,
    places: Sequence[int],
    wanted: Sequence[Wanted],
    layout: Layout,
) -> SheetCells:
    """Declared columns of a sheet below its first rows; blanks and missing marks are NaN.

    Raises
    ------
    LogError
        With row and column of the first cell that is neither a number nor a missing mark.
    """
    cells = _fast_columns(workbook, sheet, first, places, wanted, layout)
    if cells is None:
        cells = _exact_columns(path, workbook, sheet, first, places, wanted, layout)
    return cells
