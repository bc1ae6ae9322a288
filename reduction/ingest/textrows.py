"""Rows of delimited text as lines: where they begin, and the row that an editor counts."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from reduction.errors import LogError
from reduction.ingest.layout import Layout
from reduction.record import Integers

_PIECE = 1 << 17  # stays in the cache
_NEWLINE, _RETURN = b"\n\r"
_SHOWN = 60  # characters of a line in a message


@dataclass(frozen=True)
class TextRows:
    """Data rows of a text file or of a part of it, in UTF-8, without header and comments.

    Parameters
    ----------
    path : pathlib.Path
        For messages.
    layout : Layout
        Separators and quotes.
    text : memoryview
        The bytes, without line ends after the last row.
    first_row : int
        Editor's row of the first line.
    line_row : ndarray of int, shape (n_lines,), optional
        Editor's row of each line where they are not consecutive.
    is_open : bool
        Whether the file ends with the last line, without a line end.
    n_lines : int, optional
        Lines where they have been counted.
    longest_line : int
        Bytes that no line has more of. [1]
    """

    path: Path
    layout: Layout
    text: memoryview
    first_row: int
    line_row: Integers | None = None
    is_open: bool = False
    n_lines: int | None = None
    longest_line: int = 1_000_000

    def row_of_line(self, line: int) -> int:
        """Editor's row of a line counted from 0."""
        return self.first_row + line if self.line_row is None else int(self.line_row[line])

    def above(self, row: int) -> TextRows:
        """Lines above an editor's row."""
        starts = line_starts(self.text)
        lines = row - self.first_row
        if self.line_row is not None:
            lines = int(np.searchsorted(self.line_row, row))
        stop = int(starts[lines]) if lines < starts.size else len(self.text)
        text = bytes(self.text[:stop]).rstrip(b"\r\n")
        return replace(self, text=memoryview(text), is_open=False, n_lines=None)

    def rows(self, n_rows: int) -> Integers | None:
        """Editor's row of each of so many data rows, or None where they are those of the lines.

        Raises
        ------
        LogError
            If a quoted field goes over the end of its line.
        """
        n_lines = count_lines(self.text) if self.n_lines is None else self.n_lines
        row = None if self.line_row is None else self.line_row[:n_lines]
        if n_lines != n_rows:
            codes = np.frombuffer(self.text, np.uint8)[line_starts(self.text)]
            filled = np.flatnonzero((codes != _NEWLINE) & (codes != _RETURN))
            if filled.size != n_rows:
                errors = (self.unclosed(*line) for line in enumerate(self.lines()))
                raise next((error for error in errors if error), None) or self.not_told_apart(
                    f"{filled.size} lines that make {n_rows} rows"
                )
            row = self.first_row + filled if row is None else row[filled]
        last = bytes(self.text[-self.longest_line - 1 :]).rpartition(b"\n")[2]
        if error := self.unclosed(n_lines - 1, last.decode("utf-8", "replace")):
            raise error
        return row

    def lines(self) -> Iterator[str]:
        """The lines one by one, for the way to an error."""
        return (line.decode("utf-8") for line in bytes(self.text).split(b"\n"))

    def not_told_apart(self, found: str) -> LogError:
        """Error of rows of which the parser makes something else."""
        return LogError(self.path, "the rows cannot be told apart", found=found)

    def unclosed(self, line: int, text: str) -> LogError | None:
        """Error of a line, counted from 0, whose last quoted field is not closed in it."""
        if not self.layout.quote or self.layout.quote not in text:
            return None
        reader = csv.reader([text + "\n", text], **_dialect(self.layout))
        try:
            is_closed = len(list(reader)) > 1
        except csv.Error:  # a field longer than the csv module takes
            is_closed = True
        if is_closed:
            return None
        return LogError(
            self.path,
            "a quoted field goes over the end of its line",
            row=self.row_of_line(line),
            found=repr(text.strip()[:_SHOWN]),
            needed="one line a row",
            hint="Close the quote, or declare another quote character in the layout.",
        )


def count_lines(text: memoryview) -> int:
    """Number of lines; the last one needs no line end."""
    codes = np.frombuffer(text, np.uint8)
    pieces = (codes[start : start + _PIECE] for start in range(0, codes.size, _PIECE))
    return int(sum(np.count_nonzero(piece == _NEWLINE) for piece in pieces)) + 1


def line_starts(text: memoryview) -> Integers:
    """Place of the first byte of each line, shape (n_lines,)."""
    return np.concatenate([[0], np.flatnonzero(np.frombuffer(text, np.uint8) == _NEWLINE) + 1])


def split_line(line: str, layout: Layout) -> list[str]:
    """Fields of one line, without quotes and the blanks around them."""
    try:
        fields = next(csv.reader([line], **_dialect(layout)), [])
    except csv.Error:  # a field longer than the csv module takes
        fields = line.split(layout.delimiter)
    return [field.strip() for field in fields]


def _dialect(layout: Layout) -> dict[str, Any]:
    return {
        "delimiter": layout.delimiter,
        "quotechar": layout.quote or None,
        "quoting": csv.QUOTE_MINIMAL if layout.quote else csv.QUOTE_NONE,
    }
