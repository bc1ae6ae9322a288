"""What the variables of a MATLAB file of version 4 to 7 take in memory, before any is read.

The elements of the file are walked by the lengths that they state, and each length is held against
what is there: the library believes them, and calls itself for each level of cells in cells.
"""

from __future__ import annotations

import math
import struct
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO, Literal

from reduction.errors import LogError
from reduction.ingest.limits import Watch
from reduction.ingest.matlabelements import Element, FaultError, Part, Source

__all__ = ["HEADER", "StoredVariable", "stored_variables"]

HEADER = 128
"""Bytes before the first variable of a file of version 5. [1]."""

_MATRIX, _COMPRESSED = 14, 15
_TYPES = frozenset({1, 2, 3, 4, 5, 6, 7, 9, 12, 13, 16, 17, 18})
_HEAD = 8
_CELL, _STRUCT, _OBJECT, _CHAR, _SPARSE, _LAST_NUMBER = 1, 2, 3, 4, 5, 15
_IS_COMPLEX = 0x0800
_DEEPEST = 40
_MOST_DIMENSIONS = 32
_LONGEST_NAME = 1 << 16
_ENTRY = 200  # bytes of a cell or field in memory
_V4_HEAD = 20
_V4_SIZES = (8, 4, 4, 2, 2, 1)
_V4_LAST = 5000
Kind = Literal["numbers", "text", "cell", "struct", "sparse", "other"]


@dataclass(frozen=True)
class StoredVariable:
    """Where a variable stands in the file, and what reading it takes.

    ``begin`` and ``end`` are bytes from the start of the file. [1]
    ``memory`` is what it takes when it is read. [byte]
    """

    name: str
    begin: int
    end: int
    kind: Kind
    is_complex: bool
    memory: int


@dataclass(frozen=True)
class _Look:
    """What a matrix says of itself."""

    name: str
    kind: Kind
    is_complex: bool
    memory: int


class _Walk:
    """The elements of one file of version 5."""

    def __init__(self, watch: Watch, order: str) -> None:
        """Begin with nothing seen."""
        self._watch, self._order = watch, order

    def head(self, source: Source) -> Element:
        """Read the head of an element."""
        first, size = struct.unpack(f"{self._order}II", data := source.read(8))
        if first >> 16:  # length and kind share the first word
            first, size = first & 0xFFFF, first >> 16
            if size > 4:
                raise FaultError(f"a short element of {size} bytes")
            return Element(first, size, data[4:])
        return Element(first, size, None)

    def body(self, source: Source, most: int) -> bytes:
        """Read a whole element, which may have so many bytes."""
        head = self.head(source)
        if head.short is not None:
            return head.short[: head.size]
        if head.size > most:
            raise FaultError(f"{head.size:,} bytes where {most:,} would do")
        data = source.read(head.size)
        source.read(-head.size % 8)
        return data

    def matrix(self, source: Source, depth: int = 0) -> _Look:
        """Look at a matrix behind its head; at its cells and fields too, where there are any."""
        if depth > _DEEPEST:
            raise FaultError(f"cells in cells, more than {_DEEPEST} deep")
        self._watch.check_time()
        flags = struct.unpack(f"{self._order}II", self.body(source, 8))[0]
        kind, is_complex = flags & 0xFF, bool(flags & _IS_COMPLEX)
        if kind not in range(_CELL, _LAST_NUMBER + 1):
            name = self.body(source, _LONGEST_NAME).decode("latin1")
            if depth:
                self._anything(source, depth)
            return _Look(name, "other", False, 0)
        sides = self.body(source, 4 * _MOST_DIMENSIONS)
        shape = struct.unpack(f"{self._order}{len(sides) // 4}i", sides)
        if min(shape, default=0) < 0:
            raise FaultError(f"shape {shape}")
        name, count = self.body(source, _LONGEST_NAME).decode("latin1"), math.prod(shape)
        if kind in (_CELL, _STRUCT, _OBJECT):
            n_fields = 1 if kind == _CELL else self._fields(source, is_object=kind == _OBJECT)
            memory = _ENTRY * count * n_fields
            self._watch.check_unpacked(memory, f"variable '{name}'")
            memory += self._inside(source, count * n_fields, depth)
            return _Look(name, "cell" if kind == _CELL else "struct", False, memory)
        if kind == _SPARSE:
            if depth:
                self._numbers(source, 4 if is_complex else 3)
            return _Look(name, "sparse", is_complex, 0)
        # a variable that is complex is refused before it is read
        stored = self._numbers(source, 2 if is_complex and depth else 1)
        memory = 3 * stored + 16 * count * (2 if is_complex else 1)
        return _Look(name, "text" if kind == _CHAR else "numbers", is_complex, memory)

    def _numbers(self, source: Source, count: int) -> int:
        """Bytes of the first of so many elements, each of a type that there is.

        The library takes the type for a place in a table, and reads beyond its end.
        """
        sizes: list[int] = []
        for number in range(count):
            head = self.head(source)
            if head.kind not in _TYPES:
                raise FaultError(f"numbers of type {head.kind}, which there is not")
            sizes.append(head.size)
            if number + 1 < count and head.short is None:
                source.skip(head.size + -head.size % 8)
        return sizes[0]

    def _anything(self, source: Source, depth: int) -> None:
        """What stands in a handle of a function or an object, in any order."""
        while source.left >= _HEAD:
            head = self.head(source)
            if head.kind == _MATRIX and head.short is None:
                inner = Part(source, head.size)
                if head.size:
                    self.matrix(inner, depth + 1)
                inner.skip(inner.left)
            elif head.kind not in _TYPES:
                raise FaultError(f"an element of kind {head.kind} in an object")
            elif head.short is None:
                source.skip(min(head.size + -head.size % 8, source.left))

    def _fields(self, source: Source, *, is_object: bool) -> int:
        if is_object:
            self.body(source, _LONGEST_NAME)
        length = self.body(source, 4)
        size = struct.unpack(f"{self._order}i", length)[0] if len(length) == 4 else 0
        names = self.body(source, 1 << 24)
        return len(names) // size if size > 0 else 0

    def _inside(self, source: Source, count: int, depth: int) -> int:
        """What so many cells take."""
        memory = 0
        for _ in range(count):
            head = self.head(source)
            if head.kind != _MATRIX or head.short is not None:
                raise FaultError(f"an element of kind {head.kind} for a cell")
            if not head.size:
                continue
            inner = Part(source, head.size)
            memory += self.matrix(inner, depth + 1).memory
            self._watch.check_unpacked(memory, "a variable")
            inner.skip(inner.left)
        return memory


def stored_variables(path: Path, version: int, watch: Watch) -> tuple[StoredVariable, ...]:
    """Walk a file of version 4 to 7; no values are read.

    Parameters
    ----------
    path : pathlib.Path
        The file.
    version : int
        0 for version 4, 1 for 5 to 7, as `scipy.io.matlab.matfile_version` counts.
    watch : Watch
        Holds it against its limits.

    Returns
    -------
    variables : tuple of StoredVariable
        In the order of the file.

    Raises
    ------
    LogError
        If the elements are not as long as they say, or cells stand in cells without end.
    """
    variables: list[StoredVariable] = []
    with path.open("rb") as stream:
        size = path.stat().st_size
        found = _old(stream, size) if version == 0 else _new(stream, size, watch)
        try:
            for variable in found:
                variables.append(variable)
                watch.check_columns(len(variables))
                watch.check_time()
        except (FaultError, struct.error, zlib.error) as error:
            raise LogError(
                path,
                "the file is not a MATLAB file that can be read",
                found=f"{error}"[:200],
                needed="a .mat file of version 4 to 7.3 that is whole",
            ) from error
    return tuple(variables)


def _new(stream: BinaryIO, size: int, watch: Watch) -> Iterator[StoredVariable]:
    head = stream.read(HEADER)
    order = "<" if head[126:128] == b"IM" else ">"
    walk, begin = _Walk(watch, order), HEADER
    while begin < size:
        stream.seek(begin)
        source = Source(stream, size - begin)
        element = walk.head(source)
        if element.short is not None or not element.size:
            raise FaultError("an element of no length for a variable")
        end = begin + 8 + element.size
        if end > size:
            raise FaultError(
                f"a variable of {element.size:,} bytes where {size - begin - 8:,} are left"
            )
        source = Source(stream, element.size)
        if element.kind == _COMPRESSED:
            source.inflate = zlib.decompressobj()
            element = walk.head(source)
        if element.kind != _MATRIX:
            raise FaultError(f"an element of kind {element.kind} for a variable")
        look = walk.matrix(source)
        if look.name:  # else what MATLAB keeps for its functions
            yield StoredVariable(look.name, begin, end, look.kind, look.is_complex, look.memory)
        begin = end


def _old(stream: BinaryIO, size: int) -> Iterator[StoredVariable]:
    """Variables of version 4: five numbers, the name, the values."""
    begin = 0
    while begin < size:
        stream.seek(begin)
        head = stream.read(_V4_HEAD)
        if len(head) < _V4_HEAD:
            raise FaultError("a variable that ends inside its head")
        order = "<" if 0 <= struct.unpack("<i", head[:4])[0] <= _V4_LAST else ">"
        kind, n_rows, n_columns, is_complex, length = struct.unpack(f"{order}iiiii", head)
        size_place, meaning = kind % 100 // 10, kind % 10
        if kind // 1000 not in (0, 1):
            raise FaultError("numbers in a byte order of its day, as of a VAX or a Cray")
        if min(n_rows, n_columns, length) < 0 or size_place >= len(_V4_SIZES):
            raise FaultError(f"a variable of kind {kind}, {n_rows} rows and {n_columns} columns")
        n_bytes = n_rows * n_columns * _V4_SIZES[size_place] * (2 if is_complex else 1)
        end = begin + _V4_HEAD + length + n_bytes
        if end > size:
            raise FaultError(
                f"a variable of {n_rows:,} rows and {n_columns:,} columns in {size - begin:,} bytes"
            )
        name = stream.read(length).split(b"\0")[0].decode("latin1")
        found: Kind = "sparse" if meaning == 2 else "text" if meaning == 1 else "numbers"
        yield StoredVariable(
            name, begin, end, found, bool(is_complex), 2 * n_bytes + 16 * n_rows * n_columns
        )
        begin = end
