"""The cells of a table that a person or a spreadsheet wrote, by column, with their places."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path

import numpy as np

from reduction.campaign.toml_file import in_toml, listed, read_small_text, split_row, split_rows
from reduction.record.errors import LogError
from reduction.record.measurement import Floats
from reduction.record.plain_text import cut

CODED = "coded"
"""In the place of a unit: the column holds coded levels."""

_HEADER = re.compile(r"^(.*?)\s*(?:\[([^\]]*)\])?$")

_MISSING = {"", "nan", "na", "n/a"}

_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")


@dataclass(frozen=True)
class CellColumn:
    """One column: its header, the name and the unit in it, and its cells."""

    header: str
    name: str
    unit: str
    cells: tuple[str, ...]


@dataclass(frozen=True)
class CellSheet:
    """The cells of a file, by column."""

    path: Path
    row: tuple[int, ...]
    columns: tuple[CellColumn, ...]
    first: int

    def fault(self, problem: str, *, header: str | None = None, needed: str) -> LogError:
        """An error of the header line."""
        return LogError(
            self.path, problem, row=self.first, channel=header,
            found=", ".join(column.header for column in self.columns), needed=needed,
        )  # fmt: skip

    def named(self, name: str) -> list[CellColumn]:
        """Columns of a name, whatever their unit."""
        return [column for column in self.columns if column.name == name]

    def one(self, name: str, what: str) -> CellColumn:
        """The column of a name; with a unit before coded, since a plan is only the plan."""
        found = self.named(name)
        reached = [column for column in found if column.unit != CODED] or found
        if len(reached) == 1:
            return reached[0]
        if reached:
            raise self.fault(f"two columns hold {name}", needed="one")
        near = get_close_matches(name, [column.name for column in self.columns], n=1)
        raise self.fault(
            f"{what} '{name}' has no column", needed=f"a column {name}" + (
                f"; is it {near[0]}?" if near else ""
            ),
        )  # fmt: skip

    def numbers(self, column: CellColumn) -> Floats:
        """Numbers of a column, NaN where a cell is empty."""
        values = np.full(len(column.cells), math.nan)
        for place, (row, cell) in enumerate(zip(self.row, column.cells, strict=True)):
            if cell.lower() in _MISSING:
                continue
            if not _NUMBER.fullmatch(cell):
                raise LogError(
                    self.path, "a value is not a number", row=row, channel=column.header,
                    found=repr(cell), needed="a number with a decimal point, without its unit; "
                    "an empty cell where there is none",
                )  # fmt: skip
            values[place] = float(cell)
            if not math.isfinite(values[place]):
                raise LogError(
                    self.path, "a value is not finite", row=row,
                    channel=column.header, found=repr(cut(cell, 60)), needed="a finite number",
                )  # fmt: skip
        return values


def _text(path: Path) -> str:
    try:
        return read_small_text(path)
    except UnicodeDecodeError as error:
        raise LogError(path, "the table of runs is not UTF-8 text", found=str(error)) from error
    except OSError as error:
        raise LogError(
            path, "the table of runs cannot be read", found=error.strerror or str(error)
        ) from error


def _cells(path: Path, row: int, line: str, delimiter: str) -> list[str]:
    cells = split_row(line, delimiter)
    if cells is None:
        raise LogError(
            path, "a row of the table of runs cannot be parted into cells", row=row,
            found=repr(cut(line, 60)), needed="one line a row, every quote closed in it",
        )  # fmt: skip
    return [cell.strip() for cell in cells]


def read_cells(path: Path) -> CellSheet:
    """Cells of the table; lines that are empty or begin with # are not of it."""
    lines = [
        (row, line)
        for row, line in enumerate(split_rows(_text(path)), start=1)
        if line.strip(" ,;\t") and not line.lstrip().startswith("#")
    ]
    if not lines:
        raise LogError(path, "the table of runs is empty", needed="a header and one row a run")
    delimiter = max(",;\t", key=lines[0][1].count)
    table = [(row, _cells(path, row, line, delimiter)) for row, line in lines]
    (first, header), *rows = table
    if not all(header) or len(set(header)) < len(header):
        raise LogError(
            path, "the header of the runs cannot be used", row=first, found=", ".join(header),
            needed="a name for every column, each once",
        )  # fmt: skip
    if all(_NUMBER.fullmatch(cell) for cell in header):
        raise LogError(
            path, "the table of runs has no header", row=first, found=", ".join(header),
            needed="the names of factors and responses in the first row",
        )  # fmt: skip
    for row, cells in rows:
        if len(cells) != len(header):
            raise LogError(
                path, "a row has another number of cells than the header", row=row,
                found=str(len(cells)), needed=str(len(header)),
            )  # fmt: skip
    if not rows:
        raise LogError(path, "the table of runs has no rows", needed="one row a run")
    cells_by_column = zip(*(cells for _, cells in rows), strict=True)
    columns = []
    for name, column in zip(header, cells_by_column, strict=True):
        match = _HEADER.match(name)
        stem, unit = (match[1], match[2] or "") if match else (name, "")
        columns.append(CellColumn(name, stem, unit.strip(), tuple(column)))
    questions = [
        f"{path}:{row} [{column.header}]"
        for column in columns
        for (row, _), cell in zip(rows, column.cells, strict=True)
        if cell == "?"
    ]
    if questions:
        count = f"{len(questions)} values are" if len(questions) > 1 else "1 value is"
        raise in_toml(path, listed(f"{count} still '?', first {questions[0]}", questions))
    return CellSheet(path, tuple(row for row, _ in rows), tuple(columns), first)
