"""Elements of a MATLAB file of version 5 to 7, as they stand or inflated; no longer than stated."""

from __future__ import annotations

import zlib
from dataclasses import dataclass
from typing import BinaryIO

__all__ = ["Element", "FaultError", "Part", "Source"]

_BLOCK = 1 << 16


class FaultError(Exception):
    """What is wrong with the file."""


@dataclass
class Source:
    """Bytes of an element, as they stand or as they are inflated; no more than it states."""

    stream: BinaryIO
    left: int
    inflate: zlib._Decompress | None = None
    _ready: bytes = b""

    def read(self, size: int) -> bytes:
        """So many bytes."""
        if self.inflate is None:
            if size > self.left:
                raise FaultError(f"{size:,} bytes where {self.left:,} are left")
            data = self.stream.read(size)
            self.left -= len(data)
        else:
            while len(self._ready) < size and (more := self._inflated()):
                self._ready += more
            data, self._ready = self._ready[:size], self._ready[size:]
        if len(data) < size:
            raise FaultError(f"{size:,} bytes, of which {len(data):,} are there")
        return data

    def skip(self, size: int) -> None:
        """Pass over so many bytes."""
        if self.inflate is None:
            if size > self.left:
                raise FaultError(f"{size:,} bytes where {self.left:,} are left")
            self.stream.seek(size, 1)
            self.left -= size
            return
        while size > 0:
            step = min(size, _BLOCK)
            self.read(step)
            size -= step

    def _inflated(self) -> bytes:
        if self.inflate is None or self.inflate.eof:
            return b""
        packed = self.inflate.unconsumed_tail
        if not packed:
            packed = self.stream.read(min(self.left, _BLOCK))
            self.left -= len(packed)
        return self.inflate.decompress(packed, _BLOCK) if packed else b""


@dataclass(frozen=True)
class Element:
    """Kind and length of an element; the bytes of a short one stand in its head."""

    kind: int
    size: int
    short: bytes | None


class Part(Source):
    """A part of what another source gives."""

    def __init__(self, source: Source, size: int) -> None:
        """Begin where the other source stands."""
        super().__init__(source.stream, size)
        self._source = source

    def read(self, size: int) -> bytes:
        """So many bytes."""
        self._take(size)
        return self._source.read(size)

    def skip(self, size: int) -> None:
        """Pass over so many bytes."""
        self._take(size)
        self._source.skip(size)

    def _take(self, size: int) -> None:
        if size > self.left:
            raise FaultError(f"{size:,} bytes where {self.left:,} are left")
        self.left -= size
