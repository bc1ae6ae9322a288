"""Delimited text: a preamble, a name row, a unit row, and rows of fields."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

import numpy as np

from reduction.readers.columns import (
    DeclaredColumn,
    check_lengths,
    check_units,
    declared_columns,
    find_column,
    keep_line,
)
from reduction.readers.layout import Layout, LogParts, Watch
from reduction.readers.number_fields import AT_A_TIME, Fields, GrowingLog, in_order, read_fields
from reduction.readers.raw_log import RawLog, unchanged
from reduction.readers.text_rows import (
    TextFile,
    TextRows,
    count_lines,
    line_starts,
    open_text,
    split_line,
    without_outer_quotes,
)
from reduction.record.errors import LogError
from reduction.record.notes import note

_LINE = 1 << 12  # bytes; most header lines are shorter

_KEPT_LINES = 1000


@dataclass
class _Head:
    """Contents of the file above the data rows."""

    names: list[str] = field(default_factory=list)
    name_row: int | None = None
    units: list[str] = field(default_factory=list)
    unit_row: int | None = None
    metadata: dict[str, str] = field(default_factory=dict)
    n_loose: int = 0
    """Lines that are not data, including those not kept."""
    last_row: int = 0
    """Editor's row of the last line that is not blank."""
    first_line: str = ""
    """Text of the first data row."""
    first_row: int = 0
    """Editor's row of the first data row; 0 until found."""
    n_fields: int = 0
    """Number of fields in the first data row."""
    has_comments: bool = False
    """Whether rows may end with a text in a last column that most rows lack."""
    is_over: bool = False
    wanted: list[tuple[DeclaredColumn, int]] = field(default_factory=list)
    """Each declared column with its index."""

    def keep(self, line: str, row: int, layout: Layout) -> None:
        """Keep a line that is not data, up to a limit."""
        self.n_loose += 1
        if self.n_loose <= _KEPT_LINES:
            keep_line(self.metadata, line, row, layout)


def read_delimited(
    path: Path,
    layout: Layout,
    *,
    name: str,
    parts: LogParts | None = None,
    watch: Watch | None = None,
) -> RawLog:
    """Read a delimited text log."""
    head, watch = _Head(), watch or Watch(path)
    log: GrowingLog | None = None
    with (
        unchanged(path),
        open_text(path, layout.encoding, parts or LogParts(), watch) as file,
        ThreadPoolExecutor(AT_A_TIME) as workers,
    ):
        data_rows = _data_rows(path, file, head, layout, watch)
        for rows, fields in in_order(workers, partial(_fields, head), data_rows):
            log = log or GrowingLog([want for want, _ in head.wanted], file.folder)
            log.add(fields, rows.first_row)
        if log is None:
            raise _no_rows(path, head)
        columns = log.finish(path, layout)
        source = file.source(name)
    left_out = head.n_loose - _KEPT_LINES
    return RawLog(
        source=source,
        columns=columns,
        text=log.text,
        first_row=log.first_row,
        row=log.row,
        n_rows_read=check_lengths(path, columns),
        metadata=head.metadata,
        notes=(note("lines-not-kept", n_lines=left_out),) if left_out > 0 else (),
    )


def _data_rows(
    path: Path, file: TextFile, head: _Head, layout: Layout, watch: Watch
) -> Iterator[TextRows]:
    """Data rows of each part, after the head has been read."""
    for part in file:
        text, row = _tidy(part.text, layout), part.first_row
        if head.is_over:
            _keep_lines(head, text, row, layout)
            continue
        below = row + (part.n_lines if text is part.text else count_lines(text))
        if not head.first_row:
            begin = _read_head(head, text, row, layout)
            if begin is None:
                continue
            text, row = _without_texts(text[begin:], head.first_row, head, layout), head.first_row
            head.n_fields = _count_fields(path, head, layout)
            watch.check_columns(head.n_fields, row=head.first_row)
            head.wanted = _find_columns(path, head, layout)
        else:
            text = _without_texts(text, row, head, layout)
        end = _end_of_table(text, layout)
        if end is not None:
            head.is_over = True
            _keep_lines(head, text[end:], row + bytes(text[:end]).count(b"\n"), layout)
            text = memoryview(bytes(text[:end]).rstrip(b"\r\n"))
            if not text:
                continue
            below = row + count_lines(text)
        is_open = part.is_open and below == part.first_row + part.n_lines
        rows = TextRows(
            path,
            layout,
            text,
            row,
            is_open=is_open,
            n_lines=below - row,
            longest_line=file.longest_line,
        )
        yield _without_comments(rows, head)


def _end_of_table(text: memoryview, layout: Layout) -> int | None:
    """Index of the line at which the table ends, if an end is stated and found."""
    if not layout.ends_at:
        return None
    found = re.search(rb"(?m)^[ \t\"]*" + re.escape(layout.ends_at.encode()), text)
    return None if found is None else found.start()


def _keep_lines(head: _Head, text: memoryview, first_row: int, layout: Layout) -> None:
    """Keep the lines below the table."""
    for row, (_, line) in enumerate(_lines(text), first_row):
        if line.strip():
            head.keep(line, row, layout)


def _fields(head: _Head, rows: TextRows) -> Fields:
    return read_fields(rows, head.wanted, head.n_fields)


def _tidy(text: memoryview, layout: Layout) -> memoryview:
    """Rows without quotes around the whole of each; single blanks between fields parted by them.

    Blanks before a quoted field (`"Time", "Load (N)"`) are left out: after them a quote does not
    open a field.
    """
    if layout.quote:
        text = without_outer_quotes(text, layout.quote)
    if layout.delimiter != " ":
        mark, quote = layout.delimiter.encode(), layout.quote.encode()
        blanks = re.compile(b"%b +%b" % (re.escape(mark), re.escape(quote)))
        is_found = layout.quote and blanks.search(text)
        return memoryview(blanks.sub(mark + quote, text)) if is_found else text
    single = re.sub(rb"[ \t]+", b" ", text)
    return memoryview(re.sub(rb"(?m)^ | (?=\r?$)", b"", single).rstrip(b"\r\n"))


def _read_head(head: _Head, text: memoryview, first_row: int, layout: Layout) -> int | None:
    """Read lines above the data; index of the first data row, None if not reached."""
    for row, (place, line) in enumerate(_lines(text), first_row):
        if line.strip():
            head.last_row = row
        if row <= layout.preamble_rows or (layout.comment and line.startswith(layout.comment)):
            head.keep(line, row, layout)
        elif not line.strip():
            continue
        elif layout.has_name_row and not head.names:
            names = split_line(line, layout)
            head.names, head.name_row = without_comment_name(names), row
            head.has_comments = len(head.names) < len(names)
        elif layout.has_unit_row and not head.units:
            head.units, head.unit_row = split_line(line, layout), row
        else:
            head.first_line, head.first_row = line, row
            return place
    return None


_OF_TEXTS = ("Comment", "Events")
"""Last column of LabVIEW and of TracerDAQ, which most rows lack."""


def without_comment_name(names: Sequence[str]) -> list[str]:
    """Column names without a last one that most rows lack."""
    return list(names[:-1] if names and names[-1].strip() in _OF_TEXTS else names)


def _without_texts(text: memoryview, first_row: int, head: _Head, layout: Layout) -> memoryview:
    """Rows without the texts in a last column that most rows lack, kept as metadata."""
    if not head.has_comments:
        return text
    mark = re.escape(layout.delimiter.encode())
    row = rb"(?m)^((?:[^%b\r\n]*%b){%d}[^%b\r\n]*)%b([^%b\r\n]+)"
    pattern = re.compile(row % (mark, mark, len(head.names) - 1, mark, mark, mark))
    texts = list(pattern.finditer(text))
    if not texts:
        return text
    starts = line_starts(text)
    for match in texts:
        line = first_row + int(np.searchsorted(starts, match.start()))
        head.keep(match[2].decode("utf-8"), line, layout)
    shorter = memoryview(pattern.sub(rb"\1", bytes(text)))
    head.first_line = bytes(shorter[:_LINE]).partition(b"\n")[0].decode("utf-8", "ignore")
    return shorter


def _lines(text: memoryview) -> Iterator[tuple[int, str]]:
    """Lines with their positions, generated on demand."""
    place, length = 0, _LINE
    while place < len(text):
        line, end, _ = bytes(text[place : place + length]).partition(b"\n")
        if not end and place + length < len(text):
            length *= 2
            continue
        yield place, line.decode("utf-8").strip("\r")
        place, length = place + len(line) + 1, _LINE


def _no_rows(path: Path, head: _Head) -> LogError:
    row = head.last_row
    return LogError(
        path,
        "there are no data rows",
        row=row or None,
        found=f"{row} lines above them" if row > 1 else "one line above them",
        needed="at least one row below the header",
        hint="Check preamble_rows, has_name_row and has_unit_row of the layout.",
    )


def _count_fields(path: Path, head: _Head, layout: Layout) -> int:
    """Number of fields in a data row; the name row may differ only by trailing delimiters."""
    first = split_line(head.first_line, layout)
    n_names, n_fields = len(head.names), len(first)
    if n_names and (any(first[n_names:]) or any(head.names[n_fields:])):
        raise LogError(
            path,
            f"the first data row has {n_fields} fields, the name row has {n_names}",
            row=head.first_row,
            found=f"'{head.first_line.strip()[:60]}'",
            needed=f"{n_names} fields separated by {layout.delimiter!r}",
            hint="Check delimiter, decimal and preamble_rows of the layout.",
        )
    return n_fields


def _find_columns(path: Path, head: _Head, layout: Layout) -> list[tuple[DeclaredColumn, int]]:
    """Each declared column with its index, after a check of its name and unit."""
    names = head.names or [""] * head.n_fields
    wanted = [
        (want, find_column(path, want, names[: head.n_fields], row=head.name_row))
        for want in declared_columns(layout)
    ]
    check_units(path, wanted, names=names, units=head.units, unit_row=head.unit_row)
    return wanted


def _without_comments(rows: TextRows, head: _Head) -> TextRows:
    """Rows without the comment lines between them, which are kept as metadata."""
    comment = rows.layout.comment.encode()
    if not comment or comment not in bytes(rows.text):
        return rows
    starts = line_starts(rows.text)
    lengths = np.diff(starts, append=len(rows.text))
    is_comment = np.zeros(starts.size, dtype=bool)
    for match in re.finditer(rb"(?m)^" + re.escape(comment) + rb".*", rows.text):
        line = int(np.searchsorted(starts, match.start()))
        is_comment[line] = True
        text = match[0].decode("utf-8").rstrip("\r")
        head.keep(text, rows.row_of_line(line), rows.layout)
    kept = np.frombuffer(rows.text, np.uint8)[np.repeat(~is_comment, lengths)]
    return TextRows(
        rows.path,
        rows.layout,
        memoryview(kept.tobytes().rstrip(b"\r\n")),
        rows.first_row,
        np.flatnonzero(~is_comment) + rows.first_row,
        is_open=rows.is_open and not is_comment[-1],
    )
