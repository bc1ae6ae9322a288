"""Text in repeated blocks, as MTS MPT/793 writes it: the lines are sorted, then parsed once.

A block is a line that begins with the layout's ``block_marker``, a name row, a unit row
where the layout has one, and rows of fields down to the next block.  Blocks may differ
in length.  Every other line is metadata.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from reduction.errors import LogError
from reduction.ingest.columns import Wanted, check_lengths, find_column, wanted_columns
from reduction.ingest.encoding import decode
from reduction.ingest.fields import read_fields
from reduction.ingest.growing import GrowingLog
from reduction.ingest.layout import Layout
from reduction.ingest.preamble import check_units, keep_line
from reduction.ingest.rawlog import RawLog
from reduction.ingest.source import read_bytes, source_of
from reduction.ingest.textrows import TextRows, line_starts, split_line
from reduction.record import Bools, Integers

__all__ = ["read_blocks"]

_MTS = "MTS793|"
_DECIMAL_FIELD = 5
_KEPT_LINES = 200


@dataclass(frozen=True)
class _Lines:
    """Lines of a file, as places in its bytes; all arrays have shape (n_lines,)."""

    path: Path
    data: bytes
    starts: Integers
    stops: Integers

    def text(self, line: int) -> str:
        return self.data[self.starts[line] : self.stops[line]].decode("utf-8").rstrip("\r\n")


def read_blocks(path: Path, layout: Layout, *, name: str) -> RawLog:
    """Read a log of repeated blocks.

    Parameters
    ----------
    path : pathlib.Path
        The file.
    layout : Layout
        What it looks like; the decimal mark of an MTS file is the one that its first
        line states.
    name : str
        File name relative to the campaign folder.

    Returns
    -------
    log : RawLog
        Rows of all blocks that have the declared columns, one after another; lines
        between them as metadata; a note on every kind of block left out.

    Raises
    ------
    LogError
        If no block has the declared columns, or a row is not what the layout says.
    """
    raw = read_bytes(path)
    data = decode(path, raw, layout.encoding)
    starts = line_starts(memoryview(data))
    lines = _Lines(path, data, starts, np.append(starts[1:], len(data)))
    layout = _with_separators(lines, layout)
    openers = _openers(lines, layout)
    header = _header_text(lines, openers, layout)
    kinds = {text: index for index, text in enumerate(dict.fromkeys(header))}
    kind = np.array([kinds[text] for text in header])
    wanted_kind, wanted, names = _choose(lines, openers, kind, layout)

    in_block = np.searchsorted(openers, np.arange(starts.size), side="right") - 1
    offset = np.arange(starts.size) - openers[np.maximum(in_block, 0)]
    below = (in_block >= 0) & (offset > 1 + layout.has_unit_row)
    is_row = below & _looks_like_row(lines, len(names), layout)
    used = is_row & (kind[in_block] == wanted_kind)
    if not used.any():
        raise LogError(
            path, "there are no data rows", found="headers only", needed="rows below a header"
        )
    kept = np.frombuffer(data, np.uint8)[np.repeat(used, lines.stops - starts)].tobytes()
    line_row = np.flatnonzero(used) + 1
    body = memoryview(kept.rstrip(b"\r\n"))
    rows = TextRows(path, layout, body, int(line_row[0]), line_row)
    log = GrowingLog([want for want, _ in wanted], None)
    log.add(read_fields(rows, wanted, len(names)), rows.first_row)
    columns = log.finish(path, layout)

    metadata: dict[str, str] = {}
    loose = np.flatnonzero((in_block < 0) | (below & ~is_row))
    filled = [line for line in loose.tolist() if lines.text(line).strip()]
    for line in (*filled[:_KEPT_LINES], int(openers[0]), int(openers[-1])):
        keep_line(metadata, lines.text(line), line + 1, layout)
    notes = [f"{int(np.sum(kind == wanted_kind))} blocks of data"]
    if len(filled) > _KEPT_LINES:
        notes.append(f"{len(filled) - _KEPT_LINES} more lines between the blocks are not kept")
    for other in set(kinds.values()) - {wanted_kind}:
        blocks = kind == other
        notes.append(
            f"{int(blocks.sum())} blocks of another kind with "
            f"{int(np.sum(is_row & (kind[in_block] == other)))} rows are not read, "
            f"the first at row {openers[blocks][0] + 1}"
        )
    return RawLog(
        source=source_of(raw, name),
        columns=columns,
        text=log.text,
        first_row=log.first_row,
        row=log.row,
        n_rows_read=check_lengths(path, columns),
        metadata=metadata,
        notes=tuple(notes),
    )


def _with_separators(lines: _Lines, layout: Layout) -> Layout:
    """The layout with the decimal mark of an MTS file's first line."""
    first = lines.text(0)
    if not first.startswith(_MTS):
        return layout
    fields = first.split("|")
    mark = fields[_DECIMAL_FIELD] if len(fields) > _DECIMAL_FIELD else ""
    if mark not in (".", ","):
        raise LogError(
            lines.path,
            "the first line does not state a decimal mark",
            row=1,
            found=f"'{first}'",
            needed="MTS793|MPT|ENU|1|2|.|/|: and so on, the mark in the sixth place",
        )
    if "decimal" in layout.model_fields_set and layout.decimal != mark:
        raise LogError(
            lines.path,
            "the file states another decimal mark than the layout",
            row=1,
            found=f"'{mark}'",
            needed=f"'{layout.decimal}', as the layout declares",
            hint="Leave decimal out of the layout: an MTS file says it itself.",
        )
    changes = {"decimal": mark}
    if layout.thousands == mark:
        changes["thousands"] = ""
    return layout.model_copy(update=changes)


def _openers(lines: _Lines, layout: Layout) -> Integers:
    """Lines that open a block."""
    marker = layout.block_marker.encode("utf-8")
    first = np.frombuffer(lines.data, np.uint8)[np.minimum(lines.starts, len(lines.data) - 1)]
    candidates = np.flatnonzero(first == marker[0]) if marker else np.empty(0, dtype=np.int64)
    found = [line for line in candidates if lines.data.startswith(marker, int(lines.starts[line]))]
    last_header = 1 + layout.has_unit_row
    found = [line for line in found if line + last_header < lines.starts.size]
    if not found:
        raise LogError(
            lines.path,
            "there is no block of data",
            found=f"no line that begins with {layout.block_marker!r}",
            needed="a line that begins with block_marker",
            hint="Set block_marker to the words that open a block, such as Data Acquisition.",
        )
    return np.array(found, dtype=np.int64)


def _header_text(lines: _Lines, openers: Integers, layout: Layout) -> list[bytes]:
    """Name row and unit row of each block as one text, to tell kinds of blocks apart."""
    last = openers + 1 + layout.has_unit_row
    places = zip(lines.starts[openers + 1].tolist(), lines.stops[last].tolist(), strict=True)
    return [lines.data[start:stop] for start, stop in places]


def _choose(
    lines: _Lines, openers: Integers, kind: Integers, layout: Layout
) -> tuple[int, list[tuple[Wanted, int]], list[str]]:
    """First kind of block that has every declared column."""
    refusals = []
    for number in range(int(kind.max()) + 1):
        opener = int(openers[kind == number][0])
        names = split_line(lines.text(opener + 1), layout)
        try:
            wanted = [
                (want, find_column(lines.path, want, names, where="the block", row=opener + 2))
                for want in wanted_columns(layout)
            ]
        except LogError as error:
            refusals.append(error)
            continue
        units = split_line(lines.text(opener + 2), layout) if layout.has_unit_row else []
        unit_row = opener + 3 if layout.has_unit_row else None
        check_units(lines.path, wanted, names=names, units=units, unit_row=unit_row)
        return number, wanted, names
    raise refusals[0]


def _looks_like_row(lines: _Lines, n_fields: int, layout: Layout) -> Bools:
    """Lines that have a row's number of fields, or begin as a number does."""
    bytes_ = np.frombuffer(lines.data, np.uint8)
    parts = np.flatnonzero(bytes_ == ord(layout.delimiter))
    n_parts = np.searchsorted(parts, lines.stops) - np.searchsorted(parts, lines.starts)
    first = bytes_[np.minimum(lines.starts, bytes_.size - 1)]
    is_number = np.isin(first, np.frombuffer(b"0123456789+-.,", np.uint8))
    looks: Bools = (n_parts == n_fields - 1) | (is_number & (lines.stops > lines.starts))
    return looks
