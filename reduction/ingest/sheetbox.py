"""How many cells the sheets of a workbook span, found without a cell being kept.

The parser of workbooks makes a full table of a sheet, from its first cell to its last, blank or
not: a cell far off from the others costs as much as all that could stand between.  Here the parts
of a workbook are looked at piece by piece, as they are unpacked.
"""

from __future__ import annotations

import re
import struct
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from reduction.record import Integers

__all__ = ["BinarySheet", "MarkupPart", "OldSheets", "OpenSheets", "PartLook"]

_BLANK = 40  # bytes that a place in the table of a sheet takes
_HELD = 100  # bytes more of one that holds something, until it is an array
_RESERVED = 24  # bytes set aside for each entry that a list says it has

_TAG = re.compile(rb"<(?:[^\s<>:/]+:)?(row|c|si)(?=[\s/>])")
_PLACE = re.compile(rb"""\sr\s*=\s*["']([A-Za-z0-9]*)""")
_COUNT = re.compile(rb"""[cC]ount\s*=\s*["']([0-9]+)["']""")
_LONGEST_TAG = 1 << 16
_LONGEST_PLACE = 16
_FAR = 1 << 40
_IS_BLANK = np.isin(np.arange(256), list(b" \t\r\n"))
_ENDS_NAME = _IS_BLANK | np.isin(np.arange(256), list(b"/>"))
_IS_QUOTE = np.isin(np.arange(256), list(b"\"'"))
_IS_DIGIT = np.isin(np.arange(256), list(b"0123456789"))
_IS_LETTER = np.isin(np.arange(256) & 0xDF, list(b"ABCDEFGHIJKLMNOPQRSTUVWXYZ"))
_Bytes = NDArray[np.uint8]


class PartLook(Protocol):
    """Looks at one part of a workbook as it is unpacked."""

    def add(self, data: bytes) -> None:
        """The bytes that follow."""

    def memory(self) -> int:
        """What the parser will take for what was seen so far. [byte]."""


@dataclass
class MarkupPart:
    """A part in XML: the cells of a sheet, or shared strings and styles."""

    _rest: bytes = b""
    _rows: int = 0
    _stated_rows: int = 0
    _last_row: int = 0
    _cells: int = 0
    _stated_cells: int = 0
    _last_column: int = 0
    _in_row: int = 0
    _most_in_row: int = 0
    _strings: int = 0
    _listed: int = 0

    def add(self, data: bytes) -> None:
        """The bytes that follow."""
        data = self._rest + data
        cut = data.rfind(b"<")  # a tag is looked at whole
        if cut < 0 or b">" in data[cut:]:
            cut = len(data)
        elif len(data) - cut > _LONGEST_TAG:
            self._listed = _FAR  # what stands in it could be hidden by where it is cut
        self._rest = data[cut:][
            :_LONGEST_TAG
        ]  # a part that ends inside a tag is refused by the parser
        if b"<" in data[:cut]:
            self._look(data[:cut])

    def memory(self) -> int:
        """What the parser will take for what was seen so far. [byte]."""
        n_rows, n_columns = self._last_row, self._last_column
        if self._rows > self._stated_rows:  # they follow those that say where they stand
            n_rows += self._rows
        if self._cells > self._stated_cells:
            n_columns += self._most_in_row
        box = n_rows * n_columns if self._cells else 0
        held = self._cells + self._strings
        return _BLANK * box + _HELD * held + _RESERVED * self._listed

    def _look(self, data: bytes) -> None:
        if b"ount" in data:
            self._listed = max([self._listed, *(int(n[:20]) for n in _COUNT.findall(data))])
        # the ends of what is looked for may stand behind the end
        array = np.frombuffer(data + bytes(_LONGEST_PLACE), dtype=np.uint8)
        rows, cells, n_strings = _tags(data, array)
        counts = np.diff(np.searchsorted(cells, rows), prepend=0, append=cells.size)
        self._most_in_row = max(self._most_in_row, self._in_row + int(counts[0]), int(counts.max()))
        self._in_row = int(counts[-1]) + (0 if rows.size else self._in_row)
        self._rows += rows.size
        self._cells += cells.size
        self._strings += n_strings
        row, column = _numbered(array, _places(data, array))
        self._stated_cells += int(np.count_nonzero(column))
        self._stated_rows += int(np.count_nonzero(column == 0))
        self._last_row = max(self._last_row, int(row.max(initial=0)))
        self._last_column = max(self._last_column, int(column.max(initial=0)))


def _tags(data: bytes, array: _Bytes) -> tuple[Integers, Integers, int]:
    """Where rows and cells begin, and how many strings do."""
    if any(mark in data for mark in (b":row", b":c", b":si")):  # names with a prefix
        found: dict[bytes, list[int]] = {b"row": [], b"c": [], b"si": []}
        for tag in _TAG.finditer(data):
            found[tag[1]].append(tag.start())
        return np.array(found[b"row"], np.int64), np.array(found[b"c"], np.int64), len(found[b"si"])
    begins = np.flatnonzero(array == ord("<"))
    rows, cells, strings = (_named(array, begins, name) for name in (b"row", b"c", b"si"))
    return rows, cells, strings.size


def _named(array: _Bytes, begins: Integers, name: bytes) -> Integers:
    for offset, letter in enumerate(name, start=1):
        begins = begins[array[begins + offset] == letter]
    kept: Integers = begins[_ENDS_NAME[array[begins + len(name) + 1]]]
    return kept


def _places(data: bytes, array: _Bytes) -> Integers:
    """Where the attributes ``r`` begin, by which rows and cells say where they stand."""
    equals = np.flatnonzero(array == ord("="))
    if equals.size and np.any(_IS_BLANK[array[equals - 1]] | _IS_BLANK[array[equals + 1]]):
        return np.array([place.start(1) for place in _PLACE.finditer(data)], dtype=np.int64)
    equals = equals[(equals > 1) & (array[equals - 1] == ord("r"))]
    places: Integers = equals[_IS_BLANK[array[equals - 2]] & _IS_QUOTE[array[equals + 1]]] + 2
    return places


def _numbered(array: _Bytes, places: Integers) -> tuple[Integers, Integers]:
    """Row and column from 1 of places such as ``XFD12``; 0 where one is not said.

    Examples
    --------
    >>> array = np.frombuffer(b"XFD12 7 aa1 Z" + bytes(16), dtype=np.uint8)
    >>> for numbers in _numbered(array, np.array([0, 6, 8, 12])):
    ...     print(numbers.tolist())
    [12, 7, 1, 0]
    [16384, 0, 27, 26]
    """
    row, column = np.zeros((2, places.size))  # as float64 they cannot overflow
    for offset in range(_LONGEST_PLACE):
        code = array[places + offset]
        is_letter, is_digit = _IS_LETTER[code], _IS_DIGIT[code]
        if not np.any(is_letter | is_digit):
            break
        column[is_letter] = 26 * column[is_letter] + (code[is_letter] & 0x1F)
        row[is_digit] = 10 * row[is_digit] + (code[is_digit] - ord("0"))
        places = np.where(is_letter | is_digit, places, array.size - _LONGEST_PLACE)
    return np.minimum(row, _FAR).astype(np.int64), np.minimum(column, _FAR).astype(np.int64)


_ODS_TAG = re.compile(rb"<(?:[^\s<>:/]+:)?(table-row|table-cell|covered-table-cell)([^<>]*)>")
_ODS_COLUMNS = re.compile(rb"""columns-repeated\s*=\s*["']([0-9]+)["']""")
_ODS_ROWS = re.compile(rb"""rows-repeated\s*=\s*["']([0-9]+)["']""")


@dataclass
class OpenSheets:
    """The content of an .ods workbook: cells and rows that say how often they repeat."""

    _rest: bytes = b""
    _row: int = 0
    _repeats: int = 1
    _column: int = 0
    _last_row: int = 0
    _last_column: int = 0

    def add(self, data: bytes) -> None:
        """The bytes that follow."""
        data = self._rest + data
        cut = data.rfind(b"<")
        if cut < 0 or b">" in data[cut:]:
            cut = len(data)
        self._rest = data[cut:][:_LONGEST_TAG]
        for tag in _ODS_TAG.finditer(data[:cut]):
            if tag[1] == b"table-row":
                self._row += self._repeats
                self._repeats, self._column = _stated(_ODS_ROWS, tag[2]), 0
                continue
            self._column += _stated(_ODS_COLUMNS, tag[2])
            if b"value-type" in tag[2] or not tag[2].endswith(b"/"):
                self._last_column = max(self._last_column, self._column)
                self._last_row = max(self._last_row, self._row + self._repeats)

    def memory(self) -> int:
        """What the parser will take for what was seen so far. [byte]."""
        return (_BLANK + _HELD) * self._last_row * self._last_column


def _stated(pattern: re.Pattern[bytes], attributes: bytes) -> int:
    found = pattern.search(attributes)
    return 1 if found is None else int(found[1][:20])


@dataclass
class _Box:
    """From the first place to the last that holds something, of what a parser keeps."""

    n_held: int = 0
    first_row: int = 1 << 62
    last_row: int = -1
    first_column: int = 1 << 62
    last_column: int = -1

    def add(self, row: int, first: int, last: int) -> None:
        self.n_held += 1
        self.first_row, self.last_row = min(self.first_row, row), max(self.last_row, row)
        self.first_column = min(self.first_column, first)
        self.last_column = max(self.last_column, last)

    def memory(self) -> int:
        if not self.n_held:
            return 0
        n_rows = self.last_row - self.first_row + 1
        n_columns = self.last_column - self.first_column + 1
        return _BLANK * n_rows * n_columns + _HELD * self.n_held


_BEGIN_CELLS = 0x91
_BINARY_ROW = 0
_LAST_BINARY_CELL = 11  # records 1 to 11 are cells, a column first in each


class BinarySheet:
    """A sheet of an .xlsb workbook: records, of which some are rows and cells."""

    def __init__(self) -> None:
        """Begin before the cells."""
        self._rest = b""
        self._is_in_cells = False
        self._row = 0
        self._box = _Box()

    def add(self, data: bytes) -> None:
        """The bytes that follow."""
        data = self._rest + data
        place = 0
        # the length of one record says where the next begins: a walk, and no array
        for kind, body, end in _binary_records(data):
            if kind == _BEGIN_CELLS:
                self._is_in_cells = True
            elif self._is_in_cells and kind == _BINARY_ROW and end - body >= 4:
                self._row = int.from_bytes(data[body : body + 4], "little")
            elif self._is_in_cells and kind <= _LAST_BINARY_CELL and end - body >= 4:
                column = int.from_bytes(data[body : body + 4], "little")
                self._box.add(self._row, column, column)
            place = end
        self._rest = data[place:][:_LONGEST_TAG]

    def memory(self) -> int:
        """What the parser will take for what was seen so far. [byte]."""
        return self._box.memory()


def _binary_records(data: bytes) -> Iterator[tuple[int, int, int]]:
    """Kind of each whole record, where its body begins, and where it ends."""
    place, size = 0, len(data)
    while place + 6 <= size:
        kind = data[place]
        place += 1
        if kind & 0x80:
            kind = kind & 0x7F | (data[place] & 0x7F) << 7
            place += 1
        length = 0
        for shift in (0, 7, 14, 21):
            byte = data[place]
            place += 1
            length |= (byte & 0x7F) << shift
            if not byte & 0x80:
                break
        if place + length > size:
            return
        yield kind, place, place + length
        place += length


# number, RK, shared string, text, error or truth, formula, blank (with their oldest forms)
_OLD_CELLS = frozenset(
    {0x0203, 0x027E, 0x00FD, 0x0204, 0x0205, 0x0006, 0x0201, 0x0001, 0x0002, 0x0003, 0x0004,
     0x0005, 0x0206, 0x0406, 0x00D6}
)  # fmt: skip
_OLD_SPANS = frozenset({0x00BD, 0x00BE})  # cells side by side: the last column ends the record
_OLD_BEGIN = (0x0809, 0x0409, 0x0209, 0x0009)


class OldSheets:
    """The stream of an .xls workbook, whole: all its sheets, one after the other."""

    def __init__(self) -> None:
        """Begin with no sheet."""
        self._largest = 0
        self._box = _Box()

    def add(self, data: bytes) -> None:
        """All of the stream."""
        place, size = 0, len(data)
        while place + 4 <= size:
            kind, length = struct.unpack_from("<HH", data, place)
            body, place = place + 4, place + 4 + length
            if kind in _OLD_BEGIN:
                self._largest = max(self._largest, self._box.memory())
                self._box = _Box()
            elif kind in _OLD_CELLS and body + 4 <= size:
                row, column = struct.unpack_from("<HH", data, body)
                self._box.add(row, column, column)
            elif kind in _OLD_SPANS and length >= 6 and place <= size:
                row, first = struct.unpack_from("<HH", data, body)
                last = struct.unpack_from("<H", data, place - 2)[0]
                self._box.add(row, first, max(first, last))

    def memory(self) -> int:
        """What the parser will take for the largest sheet. [byte]."""
        return max(self._largest, self._box.memory())
