"""Delimited text: a preamble, a name row, a unit row, and rows of fields."""

from __future__ import annotations

import re
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from reduction.errors import LogError
from reduction.ingest.columns import check_lengths, find_column, wanted_columns
from reduction.ingest.fields import TextRows, line_starts, read_fields, split_line
from reduction.ingest.layout import Layout
from reduction.ingest.preamble import check_units, keep_line
from reduction.ingest.rawlog import RawLog
from reduction.ingest.source import decode, read_bytes, source_of

__all__ = ["read_delimited"]

_PIECE = 1 << 17  # stays in the cache
_LINE_ENDS = (b"\n", b"\r", b"\x1a")  # the last one is what DOS ends a file with


@dataclass
class _Head:
    """What stands above the data rows."""

    names: list[str] = field(default_factory=list)
    name_row: int | None = None
    units: list[str] = field(default_factory=list)
    unit_row: int | None = None
    metadata: dict[str, str] = field(default_factory=dict)
    first_line: str = ""
    """First data row."""
    start: int = 0
    """Place of its first byte."""
    first_row: int = 0
    """Its editor's row."""


def read_delimited(path: Path, layout: Layout, *, name: str) -> RawLog:
    """Read a delimited text log.

    Parameters
    ----------
    path : pathlib.Path
        The file.
    layout : Layout
        What it looks like.
    name : str
        File name relative to the campaign folder.

    Returns
    -------
    log : RawLog
        Declared columns; preamble and comment lines as metadata.

    Raises
    ------
    LogError
        If the file is not what the layout says, naming row and channel.
    """
    raw = read_bytes(path)
    with ThreadPoolExecutor(1) as worker:  # hashing needs no interpreter lock
        source = worker.submit(source_of, raw, name)
        data = _tidy(decode(path, raw, layout.encoding), layout)
        head = _read_head(path, data, layout)
        rows = _data_rows(path, data, head, layout)
        n_fields = _count_fields(path, head, layout)
        wanted = []
        names = head.names or [""] * n_fields
        for want in wanted_columns(layout):
            place = find_column(path, want, names[:n_fields], row=head.name_row)
            wanted.append((want, place))
        check_units(path, wanted, names=names, units=head.units, unit_row=head.unit_row)
        columns, text, rows = read_fields(rows, layout, wanted, n_fields)
        n_rows = check_lengths(path, columns)
        row = rows.rows(n_rows)
    return RawLog(
        source=source.result(),
        columns=columns,
        text=text,
        first_row=head.first_row if row is None else int(row[0]),
        row=row,
        n_rows_read=n_rows,
        metadata=head.metadata,
    )


def _tidy(data: bytes, layout: Layout) -> bytes:
    """One kind of line end, and one blank between fields where blanks part them."""
    if b"\r" in data and _has_lone_return(data):
        data = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    if layout.delimiter == " ":
        data = re.sub(rb"[ \t]+", b" ", data)
        data = re.sub(rb"(?m)^ | (?=\r?$)", b"", data)
    return data


def _has_lone_return(data: bytes) -> bool:
    """Whether a carriage return stands without a line feed after it."""
    codes = np.frombuffer(data + b"\0", np.uint8)
    pieces = (codes[start : start + _PIECE + 1] for start in range(0, len(data), _PIECE))
    return any(np.any((piece[:-1] == ord("\r")) & (piece[1:] != ord("\n"))) for piece in pieces)


def _read_head(path: Path, data: bytes, layout: Layout) -> _Head:
    head = _Head()
    place, row = 0, 0
    while place < len(data):
        start, row = place, row + 1
        end = data.find(b"\n", start)
        place = len(data) if end < 0 else end + 1
        line = data[start:place].decode("utf-8").strip("\r\n")
        if row <= layout.preamble_rows or (layout.comment and line.startswith(layout.comment)):
            keep_line(head.metadata, line, row, layout)
        elif not line.strip():
            continue
        elif layout.has_name_row and not head.names:
            head.names, head.name_row = split_line(line, layout), row
        elif layout.has_unit_row and not head.units:
            head.units, head.unit_row = split_line(line, layout), row
        else:
            head.first_line, head.start, head.first_row = line, start, row
            return head
    raise LogError(
        path,
        "there are no data rows",
        row=row,
        found=f"{row} lines above them" if row > 1 else "one line above them",
        needed="at least one row below the header",
        hint="Check preamble_rows, has_name_row and has_unit_row of the layout.",
    )


def _count_fields(path: Path, head: _Head, layout: Layout) -> int:
    """Fields in a data row; the name row may differ by trailing delimiters only."""
    first = split_line(head.first_line, layout)
    n_names, n_fields = len(head.names), len(first)
    if n_names and (any(first[n_names:]) or any(head.names[n_fields:])):
        raise LogError(
            path,
            f"the first data row has {n_fields} fields, the name row has {n_names}",
            row=head.first_row,
            found=f"'{head.first_line.strip()[:60]}'",
            needed=f"{n_names} fields parted by {layout.delimiter!r}",
            hint="Check delimiter, decimal and preamble_rows of the layout.",
        )
    return n_fields


def _data_rows(path: Path, data: bytes, head: _Head, layout: Layout) -> TextRows:
    end = len(data)
    while data[end - 1 : end] in _LINE_ENDS:
        end -= 1
    text = memoryview(data)[head.start : end]
    comment = layout.comment.encode()
    if not comment or data.find(comment, head.start) < 0:
        return TextRows(path, text, head.first_row, quote=layout.quote)
    starts = line_starts(text)
    lengths = np.diff(starts, append=len(text))
    is_comment = np.zeros(starts.size, dtype=bool)
    for match in re.finditer(rb"(?m)^" + re.escape(comment) + rb".*", text):
        line = int(np.searchsorted(starts, match.start()))
        is_comment[line] = True
        keep_line(
            head.metadata, match[0].decode("utf-8").rstrip("\r"), head.first_row + line, layout
        )
    kept = np.frombuffer(text, np.uint8)[np.repeat(~is_comment, lengths)]
    line_row = np.flatnonzero(~is_comment) + head.first_row
    body = memoryview(kept.tobytes().rstrip(b"\r\n"))
    return TextRows(path, body, head.first_row, line_row, layout.quote)
