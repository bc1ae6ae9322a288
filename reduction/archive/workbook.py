"""Writes tables as sheets of a spreadsheet workbook."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from importlib import import_module
from pathlib import Path
from typing import Any

from reduction.archive.atomic_write import atomic_file
from reduction.record.errors import ArchiveError, SettingsError
from reduction.record.plain_text import bare_cell, safe_cell

Cell = str | float | bool | None

_LONGEST_NAME = 31
_MOST_ROWS = 1_048_576
_WIDEST = 40

# fixed, so that equal tables give equal files
_MADE = datetime(2000, 1, 1, tzinfo=UTC).replace(tzinfo=None)


@dataclass(frozen=True)
class Sheet:
    """A sheet: its name, column headings with units, and rows."""

    name: str
    headings: Sequence[str]
    rows: Sequence[Sequence[Cell]]


def write_workbook(path: Path, sheets: Iterable[Sheet]) -> None:
    """Write sheets as an xlsx file, completely or not at all.

    Text stays text: nothing becomes a formula, a link or a number, and text that begins with ``=``,
    ``+``, ``-`` or ``@`` stays so when the cell is edited.
    """
    try:
        library = import_module("xlsxwriter")
    except ImportError:
        raise SettingsError(
            "xlsx is written by XlsxWriter, which is not installed", found="no module xlsxwriter",
            needed='pip install "mooring-reduction[xlsx]"', hint="csv needs nothing.",
        ) from None  # fmt: skip
    taken: set[str] = set()
    try:
        with atomic_file(path) as part:
            book = library.Workbook(str(part), {"in_memory": True})
            book.set_properties({"created": _MADE})
            bold = book.add_format({"bold": True, "text_wrap": True, "valign": "top"})
            quoted = book.add_format({"quote_prefix": True})
            for sheet in sheets:
                if len(sheet.rows) >= _MOST_ROWS:
                    raise ArchiveError(
                        f"{sheet.name} has more rows than a sheet", found=f"{len(sheet.rows):,}",
                        needed=f"at most {_MOST_ROWS - 1:,}",
                    )  # fmt: skip
                _fill(book.add_worksheet(_name(sheet.name, taken)), sheet, bold, quoted)
            book.close()
    except OSError as error:
        raise ArchiveError(
            f"{path} cannot be written", found=error.strerror or str(error)
        ) from error


def _name(wanted: str, taken: set[str]) -> str:
    """A valid sheet name, different from the others.

    Examples
    --------
    >>> taken = set()
    >>> [_name(one, taken) for one in ("a/b", "A:b", "shared_errors_change_in_length_of_a_rope")]
    ['a_b', 'A_b 2', 'shared_errors_change_in_length_']
    """
    plain = re.sub(r"[\[\]:*?/\\']", "_", wanted)[:_LONGEST_NAME] or "table"
    name, number = plain, 1
    while name.lower() in taken:
        number += 1
        ending = f" {number}"
        name = plain[: _LONGEST_NAME - len(ending)] + ending
    taken.add(name.lower())
    return name


def _fill(page: Any, sheet: Sheet, bold: Any, quoted: Any) -> None:
    widths = [min(len(one), _WIDEST) for one in sheet.headings]
    for column, heading in enumerate(sheet.headings):
        page.write_string(0, column, heading, bold)
    for row, cells in enumerate(sheet.rows, start=1):
        for column, cell in enumerate(cells):
            if isinstance(cell, bool):
                page.write_boolean(row, column, cell)
            elif isinstance(cell, str):
                if cell:
                    is_formula = safe_cell(cell) != cell
                    page.write_string(row, column, cell, quoted if is_formula else None)
                    widths[column] = min(max(widths[column], len(cell)), _WIDEST)
            elif cell is not None and math.isfinite(cell):
                page.write_number(row, column, cell)
    page.freeze_panes(1, 0)
    for column, width in enumerate(widths):
        page.set_column(column, column, max(width, 8) + 1)


COLUMNS = "columns.csv"
"""Table of the tables: every column with its unit and meaning."""


def sheets_of_tables(folder: Path) -> list[Sheet]:
    """Sheets of the answer tables of a campaign: overview, all columns, and each table.

    Numbers are numeric; labels stay text, even if they look like a number.
    """
    paths = sorted(folder.glob("*.csv"))
    if not any(one.name == COLUMNS for one in paths):
        raise SettingsError(
            "there are no tables of a campaign", found=str(folder), needed=COLUMNS,
            hint="`reduction run` writes them.",
        )  # fmt: skip
    head, *about = _read(folder / COLUMNS)
    of = {name: place for place, name in enumerate(head)}
    labels = {
        (row[of["table"]], row[of["column"]])
        for row in about
        if row[of["no_uncertainty"]] == "label"
    }
    sheets, taken = [], {"contents", "columns"}
    contents: list[Sequence[Cell]] = []
    for path in (one for one in paths if one.name != COLUMNS):
        headings, *rows = _read(path)
        names = [re.sub(r" \[[^\]]*\]$", "", one) for one in headings]
        is_text = [(path.name, name) in labels for name in names]
        cells = [
            [cell if text else _cell(cell) for cell, text in zip(row, is_text, strict=True)]
            for row in rows
        ]
        name = _name(path.stem, taken)
        sheets.append(Sheet(name, headings, cells))
        contents.append([path.name, name, float(len(rows))])
    return [
        Sheet("contents", ("table", "sheet", "rows"), contents),
        Sheet("columns", head, about),
        *sheets,
    ]


def _read(path: Path) -> list[list[str]]:
    with path.open(newline="", encoding="utf-8") as file:
        return [[bare_cell(cell) for cell in row] for row in csv.reader(file)]


def _cell(text: str) -> Cell:
    """The cell as a number if its text is one.

    Examples
    --------
    >>> [_cell(one) for one in ("1.5e3", "yes", "", "nan")]
    [1500.0, 'yes', '', 'nan']
    """
    try:
        value = float(text)
    except ValueError:
        return text
    return value if math.isfinite(value) else text
