"""Spreadsheet logs: .xlsx, .xlsm, .xlsb, .xls and .ods.

Sheets are given by name or by number from 1; rows count as in the sheet.
"""

from __future__ import annotations

import io
import math
import re
import struct
import zipfile
import zlib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from xml.parsers import expat

import fastexcel
import numpy as np
import python_calamine

from reduction.readers.columns import (
    DeclaredColumn,
    check_lengths,
    check_units,
    clock_to_seconds,
    declared_columns,
    find_column,
    plain_date,
    without_marks,
)
from reduction.readers.layout import CLOCK, Layout, Watch
from reduction.readers.raw_log import RawLog, hash_source
from reduction.record.errors import LogError
from reduction.record.measurement import Bools, Floats
from reduction.record.notes import note

_SUFFIXES = (".xml", ".rels")


def _is_markup(name: str) -> bool:
    """Whether a part of a workbook has to be XML.

    Examples
    --------
    >>> _is_markup("xl/worksheets/sheet1.xml"), _is_markup("xl/media/image1.png")
    (True, False)
    """
    return name.lower().endswith(_SUFFIXES)


class _CheckedMarkup:
    """Parses a part as it is unpacked; stores nothing and fetches nothing external."""

    def __init__(self, path: Path, name: str) -> None:
        """Start before the first byte."""
        self._path, self._name = path, name
        self._parser = expat.ParserCreate()
        self._parser.StartDoctypeDeclHandler = self._refuse

    def add(self, data: bytes) -> None:
        """Parse the next bytes."""
        self._parse(data, False)

    def finish(self) -> None:
        """Finish after the last byte."""
        self._parse(b"", True)

    def _parse(self, data: bytes, is_last: bool) -> None:
        try:
            self._parser.Parse(data, is_last)
        except (expat.ExpatError, LookupError) as error:  # unknown encoding
            raise LogError(
                self._path, "the workbook is damaged", found=f"{self._name}: {error}",
                needed="well-formed XML", hint="Save it again with the program that wrote it.",
            ) from error  # fmt: skip

    def _refuse(self, *_declared: object) -> None:
        raise LogError(
            self._path, f"'{self._name}' declares a document type",
            needed="a workbook without entities",
        )  # fmt: skip


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


class _parsed:  # noqa: N801 - read as a word of the ``with`` statement
    """Convert any error of the workbook parser to a `LogError`."""

    def __init__(self, path: Path, problem: str, *, needed: str | None = None) -> None:
        """Store the text of the error."""
        self._path, self._problem, self._needed = path, problem, needed

    def __enter__(self) -> None:
        """Enter the block."""

    def __exit__(
        self, _: type[BaseException] | None, error: BaseException | None, __: object
    ) -> None:
        """Convert the error, if there is one."""
        faults = (python_calamine.CalamineError, fastexcel.FastExcelError, OSError)
        if error is not None and (
            isinstance(error, faults) or type(error).__name__ == "PanicException"
        ):
            found = _first_line(error)
            raise LogError(self._path, self._problem, found=found, needed=self._needed) from error


def _first_line(error: BaseException) -> str:
    return (str(error).splitlines() or [type(error).__name__])[0]


@dataclass
class _SheetCells:
    """Declared columns of a sheet, their blank cells, and the text of a clock."""

    values: list[Floats] = field(default_factory=list)
    blanks: list[Bools] = field(default_factory=list)
    text: dict[str, tuple[str, ...]] = field(default_factory=dict)
    below: list[list[Any]] = field(default_factory=list)
    """Rows below the end of the table, if one is stated."""


def _fast_columns(
    workbook: fastexcel.ExcelReader,
    sheet: int,
    first: int,
    places: Sequence[int],
    wanted: Sequence[DeclaredColumn],
    layout: Layout,
) -> _SheetCells | None:
    """Columns that contain only numbers and blanks (NaN); None if any contains more."""
    if layout.ends_at or any(want.unit == CLOCK for want in wanted):
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
    except fastexcel.FastExcelError:  # the exact path finds the cause
        return None
    if errors is not None or not {str(kind) for kind in batch.schema.types} <= {"double", "int64"}:
        return None
    columns = [column.to_numpy(zero_copy_only=False) for column in batch.columns]
    values = [np.array(columns[order.index(place)], dtype=np.float64) for place in places]
    if any(np.isinf(column).any() for column in values):
        return None
    return _SheetCells(
        [without_marks(column, layout) for column in values],
        [np.isnan(column) for column in values],
    )


def _error_cells(
    workbook: fastexcel.ExcelReader, sheet: int, first: int
) -> dict[tuple[int, int], str]:
    """Spreadsheet errors by row and column from 0; they are blanks in the exact path."""
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


def _end_of_table(rows: Sequence[Sequence[Any]], layout: Layout) -> int:
    """Row index at which the table ends; past the last row if no end is stated or found."""
    firsts = (next((cell for cell in row if cell != ""), None) for row in rows)
    ends = (
        place
        for place, cell in enumerate(firsts)
        if layout.ends_at and isinstance(cell, str) and cell.strip().startswith(layout.ends_at)
    )
    return next(ends, len(rows))


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
    wanted: Sequence[DeclaredColumn],
    layout: Layout,
) -> _SheetCells:
    """Columns cell by cell; `LogError` at the first cell not a number or missing mark."""
    with _parsed(path, f"sheet {sheet + 1} cannot be read"):
        rows = (
            python_calamine.CalamineWorkbook.from_filelike(io.BytesIO(path.read_bytes()))
            .get_sheet_by_index(sheet)
            .to_python(skip_empty_area=False)[first:]
        )
        end = _end_of_table(rows, layout)
        columns: list[list[Any]] = [[row[place] for row in rows[:end]] for place in places]
        if any("" in cells for cells in columns):  # an error value looks blank here
            errors = _error_cells(workbook, sheet, first)
            for (row, place), mark in errors.items():
                if row - first >= end:
                    continue
                for index in (i for i, wanted_place in enumerate(places) if wanted_place == place):
                    columns[index][row - first] = mark
    found = _SheetCells(below=rows[end:])
    for cells, want in zip(columns, wanted, strict=True):
        odd = [
            index for index, cell in enumerate(cells) if type(cell) is not float or math.isinf(cell)
        ]
        blank = np.zeros(len(cells), dtype=bool)
        blank[[i for i in odd if isinstance(cells[i], str) and not cells[i].strip()]] = True
        found.blanks.append(blank)
        if want.unit == CLOCK:
            order = layout.channels[want.key].date_order
            found.text[want.key] = tuple(plain_date(_clock_text(cell), order) for cell in cells)
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


def _number(path: Path, cell: object, want: DeclaredColumn, layout: Layout, *, row: int) -> float:
    """A non-float cell: an integer, or NaN for a blank or a missing mark."""
    if type(cell) is int:  # a bool is not a number
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
        hint="Make the cell a number, or add its text to the missing marks; where the table ends"
        " above it, set ends_at in the layout.",
    )


def _read_cells(
    path: Path,
    workbook: fastexcel.ExcelReader,
    sheet: int,
    first: int,
    places: Sequence[int],
    wanted: Sequence[DeclaredColumn],
    layout: Layout,
) -> _SheetCells:
    """Declared columns of a sheet below its header; blanks and missing marks are NaN."""
    cells = _fast_columns(workbook, sheet, first, places, wanted, layout)
    if cells is None:
        cells = _exact_columns(path, workbook, sheet, first, places, wanted, layout)
    return cells


_BLOCK = 1 << 20  # bytes

_NOT_ZIP = (
    zipfile.BadZipFile, zlib.error, OSError, EOFError, NotImplementedError, RuntimeError,
    struct.error, ValueError,
)  # fmt: skip


def open_workbook(path: Path, watch: Watch) -> fastexcel.ExcelReader:
    """Open a workbook after checking it for damage."""
    if zipfile.is_zipfile(path):
        _check_integrity(path, watch)
    with _parsed(
        path,
        "the file is not a spreadsheet that can be read",
        needed="an .xlsx, .xls or .ods workbook without a password",
    ):
        # by its contents: from a path, a workbook with the ending of another kind is refused
        return fastexcel.read_excel(path.read_bytes())


def _check_integrity(path: Path, watch: Watch) -> None:
    """Unpack every part once, because the parser checks neither checksums nor markup."""
    try:
        with zipfile.ZipFile(path) as archive:
            parts = archive.infolist()
            watch.check_unpacked(sum(part.file_size for part in parts), "the workbook")
            for part in parts:
                markup = _CheckedMarkup(path, part.filename) if _is_markup(part.filename) else None
                with archive.open(part) as stream:
                    while block := stream.read(_BLOCK):
                        watch.check_time()
                        if markup is not None:
                            markup.add(block)
                if markup is not None:
                    markup.finish()
    except LogError:
        raise
    except _NOT_ZIP as error:
        raise LogError(
            path, "the workbook is damaged", found=str(error), needed="an intact workbook",
            hint="Open it in a spreadsheet program and save it again, or get the file again.",
        ) from error  # fmt: skip


def _find_sheet(path: Path, sheet_names: Sequence[str], sheet: str | int) -> int:
    """Index (from 0) of a sheet given by name or by number from 1."""
    if isinstance(sheet, int) and 1 <= sheet <= len(sheet_names):
        return sheet - 1
    if sheet in sheet_names:
        return sheet_names.index(str(sheet))
    raise LogError(
        path,
        f"there is no sheet {sheet!r}",
        found=", ".join(repr(name) for name in sheet_names) or "no sheets",
        needed=f"one of these names, or a number from 1 to {len(sheet_names)}",
    )


def read_rows(
    path: Path, workbook: fastexcel.ExcelReader, sheet: int, n_rows: int
) -> list[list[str]]:
    """First rows of a sheet as text, from row 1 and column A; blank cells are ''."""
    with _parsed(path, f"sheet {sheet + 1} cannot be read"):
        top = workbook.load_sheet(
            sheet, header_row=None, skip_rows=0, n_rows=n_rows, dtypes="string"
        )
    columns = [column or [] for column in top.to_arrow().to_pydict().values()]
    first = min((info.absolute_index for info in top.selected_columns), default=0)
    return [
        [""] * first + ["" if cell is None else str(cell) for cell in row]
        for row in zip(*columns, strict=True)
    ]


def _head(
    path: Path, workbook: fastexcel.ExcelReader, sheet: int, layout: Layout
) -> tuple[list[list[str]], list[str], list[str]]:
    """Preamble rows, column names and units of a sheet."""
    n_rows = layout.preamble_rows + layout.has_name_row + layout.has_unit_row
    rows = read_rows(path, workbook, sheet, n_rows + 1)
    if len(rows) <= n_rows:
        raise LogError(
            path,
            f"sheet '{workbook.sheet_names[sheet]}' has no data rows",
            found=f"{len(rows)} rows",
            needed=f"more than the {n_rows} rows of its head",
        )
    units = rows[n_rows - 1] if layout.has_unit_row else [""] * len(rows[0])
    names = rows[layout.preamble_rows] if layout.has_name_row else [""] * len(rows[0])
    return rows[: layout.preamble_rows], names, units


def _metadata(sheet_name: str, rows: Iterable[tuple[int, Sequence[Any]]]) -> dict[str, str]:
    """Rows outside the table, keyed by the first of two cells, otherwise by row number."""
    metadata = {"sheet": sheet_name}
    for row, cells in rows:
        texts = [text for cell in cells if (text := str(cell).strip())]
        key, value = f"row {row}", " ".join(texts)
        if len(texts) > 1:
            key, value = texts[0].rstrip(": "), " ".join(texts[1:])
        if texts:
            metadata[f"{key} (row {row})" if key in metadata else key] = value
    return metadata


def read_spreadsheet(
    path: Path, layout: Layout, *, name: str, watch: Watch | None = None
) -> RawLog:
    """Read the declared columns of one sheet."""
    watch = watch or Watch(path)
    source = hash_source(path, name)
    workbook = open_workbook(path, watch)
    sheet = _find_sheet(path, workbook.sheet_names, layout.sheet)
    sheet_name = workbook.sheet_names[sheet]
    preamble, names, units = _head(path, workbook, sheet, layout)
    watch.check_columns(len(names))
    watch.check_time()
    first = layout.preamble_rows + layout.has_name_row + layout.has_unit_row
    wanted = declared_columns(layout)
    places = [
        find_column(
            path,
            want,
            names,
            where=f"sheet '{sheet_name}'",
            row=layout.preamble_rows + 1 if layout.has_name_row else None,
        )
        for want in wanted
    ]
    check_units(
        path,
        list(zip(wanted, places, strict=True)),
        names=names,
        units=units,
        unit_row=first if layout.has_unit_row else None,
    )
    cells = _read_cells(path, workbook, sheet, first, places, wanted, layout)
    all_blank = np.logical_and.reduce(cells.blanks)
    n_rows = all_blank.size - int(np.argmin(all_blank[::-1])) if not all_blank.all() else 0
    for want, blank in zip(wanted, cells.blanks, strict=True):
        if blank[:n_rows].any() and "" not in layout.missing:
            raise LogError(
                path,
                f"{int(blank[:n_rows].sum())} cells are blank, this is the first",
                row=first + int(np.argmax(blank)) + 1,
                channel=str(want.column),
                found="a blank cell",
                needed=f"a number in {want.unit}",
                hint='Add "" to the missing marks of the layout where a blank means missing.',
            )
    columns = {want.key: column[:n_rows] for want, column in zip(wanted, cells.values, strict=True)}
    left_out = all_blank.size - n_rows
    return RawLog(
        source=source,
        columns=columns,
        first_row=first + 1,
        n_rows_read=check_lengths(path, columns),
        text={key: texts[:n_rows] for key, texts in cells.text.items()},
        metadata=_metadata(
            sheet_name,
            [*enumerate(preamble, 1), *enumerate(cells.below, first + 1 + len(cells.values[0]))],
        ),
        notes=(note("blank-rows", n_rows=left_out),) if left_out else (),
    )
