"""A table as it is written: block by block, under its name when all of it is there."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import ExitStack
from pathlib import Path

from reduction.archive.write import appended_whole
from reduction.tables.column import Cell, Column, csv_field, csv_lines, csv_text
from reduction.tables.holes import lonely_numbers
from reduction.tables.outcomes import GroupColumn


class TableFile:
    """A table that grows by rows; without rows there is no file.

    Parameters
    ----------
    path : pathlib.Path
        Of the table.
    columns : sequence of Column or GroupColumn
        Of it.
    whole : contextlib.ExitStack
        At whose end the file gets its name.
    """

    def __init__(
        self, path: Path, columns: Sequence[Column | GroupColumn], whole: ExitStack
    ) -> None:
        """Begin a table without rows."""
        self.path = path
        self.columns = columns
        self.lonely: set[int] = set()
        self._whole = whole
        self._append: Callable[[str], None] | None = None

    @property
    def is_filled(self) -> bool:
        """Whether the table has a row."""
        return self._append is not None

    def add(self, fields: Sequence[Sequence[str]]) -> None:
        """Add rows, given as columns of fields of `reduction.tables.column.texts_of`.

        Raises
        ------
        ArchiveError
            If the disk refuses.
        """
        if not fields or not fields[0]:
            return
        if self._append is None:
            self._append = self._whole.enter_context(appended_whole(self.path))
            self._append(csv_text([column.header for column in self.columns], ()))
        self._append(csv_lines(fields))
        self.lonely |= lonely_numbers(self.columns, fields)

    def add_rows(self, rows: Sequence[Sequence[Cell]]) -> None:
        """Add rows of cells.

        Raises
        ------
        ArchiveError
            If the disk refuses.
        """
        self.add([[csv_field(cell) for cell in column] for column in zip(*rows, strict=True)])
