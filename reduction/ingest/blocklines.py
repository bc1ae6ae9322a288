"""Lines of a text in repeated blocks, part by part, never cut within the header of a block."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from reduction.ingest.layout import Layout
from reduction.ingest.textparts import TextFile
from reduction.ingest.textrows import line_starts
from reduction.record import Bools, Integers

_NEWLINE, _RETURN = b"\n\r"


@dataclass(frozen=True)
class BlockLines:
    """Lines of a part as places in its bytes.

    Parameters
    ----------
    data : bytes
        In UTF-8.
    starts, stops : ndarray of int, shape (n_lines,)
        Place of the first byte of each line, and of that after its line end.
    openers : ndarray of int, shape (n_blocks,)
        Lines that open a block; its header is here too.
    first_row : int
        Editor's row of the first line.
    is_open : bool
        Whether the file ends with the last line, without a line end.
    """

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
        """Lines that have so many fields, shape (n_lines,), or begin as a number does."""
        codes = np.frombuffer(self.data, np.uint8)
        parts = np.flatnonzero(codes == ord(delimiter))
        n_parts = np.searchsorted(parts, self.stops) - np.searchsorted(parts, self.starts)
        first = codes[np.minimum(self.starts, codes.size - 1)]
        is_number = np.isin(first, np.frombuffer(b"0123456789+-.,", np.uint8))
        looks: Bools = (n_parts == n_fields - 1) | (is_number & (self.stops > self.starts))
        return looks


def block_lines(file: TextFile, layout: Layout) -> Iterator[BlockLines]:
    """Parts of a file; one that ends in a header leaves it to the next."""
    held, row, is_open = b"", 0, False
    for part in file:
        row = row if held else part.first_row
        is_open = part.is_open
        lines = _to_lines(held + bytes(part.text), row, layout)
        n_lines = lines.starts.size
        for opener in lines.openers[::-1].tolist():
            if opener + header_length(layout) < n_lines:
                break
            n_lines = opener
        held = b""
        if n_lines < lines.starts.size:
            held, row = lines.data[lines.starts[n_lines] :] + b"\n", row + n_lines
        if n_lines:
            yield BlockLines(
                lines.data,
                lines.starts[:n_lines],
                lines.stops[:n_lines],
                lines.openers[lines.openers < n_lines],
                lines.first_row,
                is_open and not held,
            )
    if held:
        lines = _to_lines(held[:-1], row, layout)
        openers = lines.openers[lines.openers + header_length(layout) < lines.starts.size]
        yield replace(lines, openers=openers, is_open=is_open)


def header_length(layout: Layout) -> int:
    """Lines of a header below the one that opens the block."""
    return 1 + layout.has_unit_row


def _to_lines(data: bytes, first_row: int, layout: Layout) -> BlockLines:
    starts = line_starts(memoryview(data))
    marker = layout.block_marker.encode("utf-8")
    found: list[int] = []
    if marker:
        first = np.frombuffer(data, np.uint8)[np.minimum(starts, len(data) - 1)]
        candidates = np.flatnonzero(first == marker[0]).tolist()
        found = [line for line in candidates if data.startswith(marker, int(starts[line]))]
    return BlockLines(
        data=data,
        starts=starts,
        stops=np.append(starts[1:], len(data)),
        openers=np.array(found, dtype=np.int64),
        first_row=first_row,
        is_open=False,
    )
