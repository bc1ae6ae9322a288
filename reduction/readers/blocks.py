"""Text in repeated blocks, as in MTS MPT/793 files: lines are sorted, then parsed together.

A block is a line that begins with the layout's ``block_marker``, a name row, a unit row if the
layout has one, and rows of fields down to the next block.  Blocks may differ in length, and a part
of the file may end inside one.  Every other line is metadata.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
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
from reduction.readers.number_fields import GrowingLog, read_fields
from reduction.readers.raw_log import RawLog, unchanged
from reduction.readers.text_rows import TextFile, TextRows, line_starts, open_text, split_line
from reduction.record.errors import LogError
from reduction.record.measurement import Bools, Integers
from reduction.record.notes import Note, note

_NEWLINE, _RETURN = b"\n\r"


@dataclass(frozen=True)
class _BlockLines:
    """Lines of a part, stored as byte positions."""

    data: bytes
    starts: Integers
    stops: Integers
    openers: Integers
    first_row: int
    is_open: bool

    def text(self, line: int) -> str:
        """One line."""
        return self.data[self.starts[line] : self.stops[line]].decode("utf-8").rstrip("\r\n")

    def filled(self) -> Bools:
        """Lines that are not empty, shape (n_lines,)."""
        first = np.frombuffer(self.data, np.uint8)[np.minimum(self.starts, len(self.data) - 1)]
        filled: Bools = (self.stops > self.starts) & (first != _NEWLINE) & (first != _RETURN)
        return filled

    def look_like_rows(self, delimiter: str, n_fields: Integers) -> Bools:
        """Lines with that many fields, shape (n_lines,), or that begin like a number."""
        codes = np.frombuffer(self.data, np.uint8)
        parts = np.flatnonzero(codes == ord(delimiter))
        n_parts = np.searchsorted(parts, self.stops) - np.searchsorted(parts, self.starts)
        first = codes[np.minimum(self.starts, codes.size - 1)]
        is_number = np.isin(first, np.frombuffer(b"0123456789+-.,", np.uint8))
        looks: Bools = (n_parts == n_fields - 1) | (is_number & (self.stops > self.starts))
        return looks


def _block_lines(file: TextFile, layout: Layout) -> Iterator[_BlockLines]:
    """Parts of a file; a header at the end of a part is carried over to the next."""
    held, row, is_open = b"", 0, False
    for part in file:
        row = row if held else part.first_row
        is_open = part.is_open
        lines = _to_lines(held + bytes(part.text), row, layout)
        n_lines = lines.starts.size
        for opener in lines.openers[::-1].tolist():
            if opener + _header_length(layout) < n_lines:
                break
            n_lines = opener
        held = b""
        if n_lines < lines.starts.size:
            held, row = lines.data[lines.starts[n_lines] :] + b"\n", row + n_lines
        if n_lines:
            yield _BlockLines(
                lines.data,
                lines.starts[:n_lines],
                lines.stops[:n_lines],
                lines.openers[lines.openers < n_lines],
                lines.first_row,
                is_open and not held,
            )
    if held:
        lines = _to_lines(held[:-1], row, layout)
        openers = lines.openers[lines.openers + _header_length(layout) < lines.starts.size]
        yield replace(lines, openers=openers, is_open=is_open)


def _header_length(layout: Layout) -> int:
    """Header lines below the line that opens a block."""
    return 1 + layout.has_unit_row


def _to_lines(data: bytes, first_row: int, layout: Layout) -> _BlockLines:
    starts = line_starts(memoryview(data))
    marker = layout.block_marker.encode("utf-8")
    found: list[int] = []
    if marker:
        first = np.frombuffer(data, np.uint8)[np.minimum(starts, len(data) - 1)]
        candidates = np.flatnonzero(first == marker[0]).tolist()
        found = [line for line in candidates if data.startswith(marker, int(starts[line]))]
    return _BlockLines(
        data=data,
        starts=starts,
        stops=np.append(starts[1:], len(data)),
        openers=np.array(found, dtype=np.int64),
        first_row=first_row,
        is_open=False,
    )


_MTS = "MTS793|"

_DECIMAL_FIELD = 5

_KEPT_LINES = 200


@dataclass
class _Kind:
    """Blocks with the same header."""

    n_fields: int
    first_row: int
    n_blocks: int = 0
    n_rows: int = 0


def read_blocks(
    path: Path,
    layout: Layout,
    *,
    name: str,
    parts: LogParts | None = None,
    watch: Watch | None = None,
) -> RawLog:
    """Read a log of repeated blocks."""
    watch = watch or Watch(path)
    with unchanged(path), open_text(path, layout.encoding, parts or LogParts(), watch) as file:
        blocks: _BlockReader | None = None
        for lines in _block_lines(file, layout):
            if blocks is None:
                blocks = _BlockReader(
                    path, _with_separators(path, lines, layout), file.folder, watch
                )
            blocks.take(lines)
        if blocks is None or not blocks.kinds:
            raise _no_block(path, layout)
        return blocks.finish(file, name)


class _BlockReader:
    """State of the reader between parts."""

    def __init__(self, path: Path, layout: Layout, folder: Path | None, watch: Watch) -> None:
        self.path, self.layout, self.folder, self.watch = path, layout, folder, watch
        self.kinds: dict[bytes, _Kind] = {}
        self.open: _Kind | None = None  # kind of the block that continues
        self.chosen: _Kind | None = None
        self.wanted: list[tuple[DeclaredColumn, int]] = []
        self.log: GrowingLog | None = None
        self.refusal: LogError | None = None
        self.openers: list[tuple[str, int]] = []
        self.metadata: dict[str, str] = {}
        self.n_loose = 0

    def take(self, lines: _BlockLines) -> None:
        """Sort the lines of the next part, and read its rows."""
        kinds = [self.open, *(self._opened(lines, line) for line in lines.openers.tolist())]
        self.open = kinds[-1]
        n_header = _header_length(self.layout)
        number = np.arange(lines.starts.size)
        block = np.searchsorted(lines.openers, number, side="right")
        is_below = number - np.append(-n_header - 1, lines.openers)[block] > n_header
        # rows of a kind that is not read must begin like a number
        n_fields = np.array(
            [kind.n_fields if kind and kind is self.chosen else 0 for kind in kinds]
        )
        is_row = is_below & np.array([kind is not None for kind in kinds])[block]
        is_row &= lines.look_like_rows(self.layout.delimiter, n_fields[block])
        self._keep_loose(lines, is_below & ~is_row)
        for kind, n_rows in zip(
            kinds, np.bincount(block[is_row], minlength=len(kinds)), strict=True
        ):
            if kind is not None:
                kind.n_rows += int(n_rows)
        used = is_row & np.array([kind is self.chosen for kind in kinds])[block]
        if self.chosen is None or self.log is None or not used.any():
            return
        kept = np.frombuffer(lines.data, np.uint8)[: lines.stops[-1]]
        kept = kept[np.repeat(used, lines.stops - lines.starts)]
        row = np.flatnonzero(used) + lines.first_row
        body = memoryview(kept.tobytes().rstrip(b"\r\n"))
        is_open = lines.is_open and bool(used[-1])
        rows = TextRows(
            self.path,
            self.layout,
            body,
            int(row[0]),
            row,
            is_open=is_open,
            longest_line=self.watch.limits.line_length,
        )
        self.log.add(read_fields(rows, self.wanted, self.chosen.n_fields), rows.first_row)

    def finish(self, file: TextFile, name: str) -> RawLog:
        """The log, after the last part."""
        if self.log is None:
            raise self.refusal or _no_block(self.path, self.layout)
        if not self.log.n_rows:
            raise LogError(
                self.path,
                "there are no data rows",
                found="headers only",
                needed="rows below a header",
            )
        for line, row in (self.openers[0], self.openers[-1]):
            keep_line(self.metadata, line, row, self.layout)
        columns = self.log.finish(self.path, self.layout)
        return RawLog(
            source=file.source(name),
            columns=columns,
            text=self.log.text,
            first_row=self.log.first_row,
            row=self.log.row,
            n_rows_read=check_lengths(self.path, columns),
            metadata=self.metadata,
            notes=tuple(self._notes()),
        )

    def _opened(self, lines: _BlockLines, opener: int) -> _Kind:
        """Kind of the block opened by a line, shared by all blocks with the same header."""
        last = opener + _header_length(self.layout)
        text = lines.data[lines.starts[opener + 1] : lines.stops[last]]
        header = text.replace(b"\r\n", b"\n").rstrip(b"\n")
        row = lines.first_row + opener
        if header not in self.kinds:
            names = split_line(lines.text(opener + 1), self.layout)
            self.watch.check_columns(len(names), row=row + 1)
            self.kinds[header] = _Kind(len(names), row)
            if self.chosen is None:
                self._choose(lines, opener, names, self.kinds[header])
        self.openers = [*self.openers[:1], (lines.text(opener), row)]
        kind = self.kinds[header]
        kind.n_blocks += 1
        return kind

    def _choose(self, lines: _BlockLines, opener: int, names: list[str], kind: _Kind) -> None:
        """Read blocks of this kind if it is the first with every declared column."""
        row = lines.first_row + opener
        try:
            wanted = [
                (want, find_column(self.path, want, names, where="the block", row=row + 1))
                for want in declared_columns(self.layout)
            ]
        except LogError as error:
            self.refusal = self.refusal or error
            return
        has_units = self.layout.has_unit_row
        units = split_line(lines.text(opener + 2), self.layout) if has_units else []
        unit_row = row + 2 if has_units else None
        check_units(self.path, wanted, names=names, units=units, unit_row=unit_row)
        self.chosen, self.wanted = kind, wanted
        self.log = GrowingLog([want for want, _ in wanted], self.folder)

    def _keep_loose(self, lines: _BlockLines, is_loose: Bools) -> None:
        """Keep the first lines between the rows as metadata."""
        for line in np.flatnonzero(is_loose & lines.filled()).tolist():
            if (text := lines.text(line)).strip():
                if self.n_loose < _KEPT_LINES:
                    keep_line(self.metadata, text, lines.first_row + line, self.layout)
                self.n_loose += 1

    def _notes(self) -> Iterator[Note]:
        chosen = [kind for kind in self.kinds.values() if kind is self.chosen]
        yield note("blocks-read", n_blocks=sum(kind.n_blocks for kind in chosen))
        if self.n_loose > _KEPT_LINES:
            yield note("lines-between-blocks-not-kept", n_lines=self.n_loose - _KEPT_LINES)
        for kind in self.kinds.values():
            if kind is not self.chosen:
                yield note(
                    "blocks-not-read",
                    n_blocks=kind.n_blocks,
                    n_rows=kind.n_rows,
                    row=kind.first_row,
                )


def _with_separators(path: Path, lines: _BlockLines, layout: Layout) -> Layout:
    """The layout with the decimal mark stated in the first line of an MTS file."""
    first = lines.text(0)
    if not first.startswith(_MTS):
        return layout
    fields = first.split("|")
    mark = fields[_DECIMAL_FIELD] if len(fields) > _DECIMAL_FIELD else ""
    if mark not in (".", ","):
        raise LogError(
            path,
            "the first line does not state a decimal mark",
            row=1,
            found=f"'{first}'",
            needed="MTS793|MPT|ENU|1|2|.|/|: ..., with the mark in the sixth field",
        )
    if "decimal" in layout.model_fields_set and layout.decimal != mark:
        raise LogError(
            path,
            "the file states another decimal mark than the layout",
            row=1,
            found=f"'{mark}'",
            needed=f"'{layout.decimal}', as the layout declares",
            hint="Leave decimal out of the layout: an MTS file states it itself.",
        )
    changes = {"decimal": mark}
    if layout.thousands == mark:
        changes["thousands"] = ""
    return layout.model_copy(update=changes)


def _no_block(path: Path, layout: Layout) -> LogError:
    return LogError(
        path,
        "there is no block of data",
        found=f"no line that begins with {layout.block_marker!r}",
        needed="a line that begins with block_marker",
        hint="Set block_marker to the words that open a block, such as Data Acquisition.",
    )
