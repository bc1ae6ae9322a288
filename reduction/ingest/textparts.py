"""Text files in parts of whole lines, as UTF-8, so that a log of any length can be read.

What is wrong with the text is told when the lines above it have been handed on: the first
error of a file is the same in parts of any length.
"""

from __future__ import annotations

import codecs
import os
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing, contextmanager
from dataclasses import dataclass
from functools import partial
from io import BufferedReader
from pathlib import Path

import numpy as np

from reduction.errors import LogError
from reduction.ingest.encoding import find_encoding, row_of
from reduction.ingest.limits import Watch
from reduction.ingest.parts import Parts
from reduction.ingest.source import RunningHash, check_not_empty, unreadable
from reduction.ingest.textrows import count_lines, line_starts
from reduction.provenance import Source

_PIECE = 1 << 17  # stays in the cache
_LOOK = 1 << 16  # bytes in which a binary file shows itself
_MARK = 4  # bytes of the longest byte-order mark
_NEWLINE, _RETURN = b"\n\r"
_FILE_END = b"\n\r\x1a"  # the last one is what DOS ends a file with

_Fault = tuple[int, Callable[[int], LogError]]  # lines above it, and the error of its row


@dataclass(frozen=True)
class TextPart:
    """Whole lines of a file.

    Parameters
    ----------
    text : memoryview
        In UTF-8, from the first line to the end of the last one, which is not blank.
    first_row : int
        Editor's row of the first line.
    n_lines : int
        Lines, blank ones included.
    is_open : bool
        Whether the file ends with the last line, without a line end.
    """

    text: memoryview
    first_row: int
    n_lines: int
    is_open: bool


class TextFile:
    """A text file that is read once, from its beginning to its end; see `open_text`."""

    def __init__(
        self, path: Path, stream: BufferedReader, encoding: str, parts: Parts, watch: Watch
    ) -> None:
        """Look at the beginning of the file."""
        size = os.fstat(stream.fileno()).st_size
        check_not_empty(path, size)
        try:
            head = stream.read(_LOOK)
            self._encoding = find_encoding(path, head[:_MARK], encoding)
            stream.seek(len(self._encoding.mark))
        except OSError as error:
            raise unreadable(path, error) from error
        self.folder = parts.folder_of(size)
        self._path, self._stream, self._watch = path, stream, watch
        self.longest_line = watch.limits.line_length
        self._n_bytes = max(parts.length_of(size), _MARK)
        self._left = size - len(self._encoding.mark)
        self._keeps_ascii = self._encoding.keeps_ascii
        if self._keeps_ascii and (nul := head.find(b"\0")) >= 0:
            raise self._encoding.binary(row_of(head, nul))
        self._decoder = codecs.getincrementaldecoder(self._encoding.codec)()
        self._is_at_start = True
        self._worker = ThreadPoolExecutor(1)
        self._hash = RunningHash()
        self._hash.add(memoryview(self._encoding.mark))

    def __iter__(self) -> Iterator[TextPart]:
        """Parts in order; the next one is read while the caller works on this one."""
        parts = self._parts()
        coming = self._worker.submit(next, parts, None)
        while (part := coming.result()) is not None:
            coming = self._worker.submit(next, parts, None)
            self._watch.check_time()
            yield part

    def source(self, name: str) -> Source:
        """Name, hash and size of the file, once all of it has been read."""
        return self._hash.source(name)

    def close(self) -> None:
        """End the reading and the hashing."""
        # here, not where a forgotten iterator ends: that may be any thread at any time
        self._worker.shutdown()
        self._hash.close()

    def _parts(self) -> Iterator[TextPart]:
        """Lines in parts; what is not whole yet goes over to the next one."""
        rest, row, is_last = b"", 1, False
        while not is_last:
            data, fault = self._read(rest)
            if fault is None and _unfinished(data) > 2 * self.longest_line:
                fault = row_of(data, len(data)) - 1, self._watch.long_line
            is_last = fault is None and self._left == 0
            stop, begin = (_end(data, len(data)), len(data)) if is_last else _cut(data)
            rest = bytes(memoryview(data)[begin:])
            text, found = self._checked(data, stop)
            n_lines = count_lines(text) if text else 0
            if n_lines:
                is_open = is_last and bytes(data[stop : stop + 1]) not in (b"\n", b"\r")
                yield TextPart(text, row, n_lines, is_open)
            if found is not None or fault is not None:
                above, error = found or fault or (0, self._watch.long_line)
                raise error(row + above)
            row += n_lines

    def _read(self, rest: bytes) -> tuple[bytearray, _Fault | None]:
        """What went over and the next bytes; as UTF-8 where lines cannot be told in bytes."""
        n_next = min(self._n_bytes, self._left)
        kept = rest if self._keeps_ascii else b""
        data = bytearray(len(kept) + n_next)
        data[: len(kept)] = kept
        space = memoryview(data)[len(kept) :]
        try:
            n_read = self._stream.readinto(space)
        except OSError as error:
            raise unreadable(self._path, error) from error
        self._hash.add(space[:n_read])
        self._left = self._left - n_read if n_read == n_next else 0  # 0: the file shrank
        if not self._keeps_ascii:
            return self._converted(rest, bytes(space[:n_read]))
        return (data if n_read == n_next else data[: len(kept) + n_read]), None

    def _converted(self, rest: bytes, new: bytes) -> tuple[bytearray, _Fault | None]:
        wrong = None
        try:
            text = self._decoder.decode(new, self._left == 0)
        except UnicodeDecodeError as error:
            wrong = partial(self._encoding.other, error)
            pending = len(self._decoder.getstate()[0])
            text = self._decoder.decode(new[: max(error.start - pending, 0)])
        if self._is_at_start and text:
            text, self._is_at_start = text.removeprefix("\ufeff"), False
        data = bytearray(rest + text.encode())
        return data, None if wrong is None else (row_of(data, len(data)) - 1, wrong)

    def _checked(self, data: bytearray, stop: int) -> tuple[memoryview, _Fault | None]:
        """Lines as UTF-8, with one kind of line end: all, or those above the first fault."""
        text, fault = memoryview(data)[:stop], None
        if self._keeps_ascii and stop:
            if (nul := data.find(b"\0", 0, stop)) >= 0:
                text, fault = _above(text, nul), (row_of(data, nul) - 1, self._encoding.binary)
            if not data.isascii():
                at_start, self._is_at_start = self._is_at_start, False
                try:
                    text = self._encoding.to_utf8(text, is_first=at_start)
                except UnicodeDecodeError as error:
                    text = _above(text, error.start)
                    text = self._encoding.to_utf8(text, is_first=at_start)
                    fault = row_of(data, error.start) - 1, partial(self._encoding.other, error)
            self._is_at_start = False
        if data.find(b"\r", 0, stop) >= 0 and _has_lone_return(text):
            text = memoryview(bytes(text).replace(b"\r\n", b"\n").replace(b"\r", b"\n"))
        if (long := _long_line(text, self.longest_line)) is not None:
            text, fault = _above(text, long), (count_lines(text[:long]) - 1, self._watch.long_line)
        return text, fault


@contextmanager
def open_text(
    path: Path, encoding: str, parts: Parts, watch: Watch | None = None
) -> Iterator[TextFile]:
    """Open a text file to be read in parts.

    Raises
    ------
    LogError
        If the file cannot be opened, is empty or binary, is not in the declared encoding, or
        has a line that is longer than the limits of the watch allow.
    SettingsError
        If there is no such encoding.
    """
    try:
        stream = path.open("rb")
    except OSError as error:
        raise unreadable(path, error) from error
    with stream, closing(TextFile(path, stream, encoding, parts, watch or Watch(path))) as file:
        yield file


def _end(data: bytearray, stop: int) -> int:
    """Place after the last byte that is more than the end of a line or of a file."""
    while stop and data[stop - 1] in _FILE_END:
        stop -= 1
    return stop


def _cut(data: bytearray) -> tuple[int, int]:
    """Where the last whole line that is not blank ends, and where the next one begins.

    What may be the end of the file, blank lines and the mark of DOS, is left to the next
    part, as is a carriage return at the end: its line feed may follow.
    """
    stop = _last_line_end(data, len(data))
    while stop >= 0:
        end = _end(data, stop)
        if data.find(b"\x1a", end, stop) < 0:
            return (end, end + 1 + (data[end : end + 2] == b"\r\n")) if end else (0, 0)
        stop = _last_line_end(data, end)
    return 0, 0


def _last_line_end(data: bytearray, stop: int) -> int:
    """Place of the last line end before a byte, -1 where there is none."""
    feed = data.rfind(b"\n", 0, stop)
    return max(feed, data.rfind(b"\r", feed + 1, min(stop, len(data) - 1)))


def _unfinished(data: bytearray) -> int:
    """Bytes after the last line end."""
    feed = data.rfind(b"\n")
    return len(data) - 1 - max(feed, data.rfind(b"\r", feed + 1))


def _above(text: memoryview, place: int) -> memoryview:
    """Lines above the one of a byte, without line ends after the last."""
    lines = bytes(text[:place])
    return memoryview(lines[: max(lines.rfind(b"\n"), lines.rfind(b"\r"), 0)].rstrip(b"\r\n"))


def _has_lone_return(text: memoryview) -> bool:
    """Whether a carriage return stands without a line feed after it; none is at the end."""
    codes = np.frombuffer(text, np.uint8)
    pieces = (codes[start : start + _PIECE + 1] for start in range(0, codes.size, _PIECE))
    return any(np.any((piece[:-1] == _RETURN) & (piece[1:] != _NEWLINE)) for piece in pieces)


def _long_line(text: memoryview, longest: int) -> int | None:
    """Place of the first line that is too long, None where there is none."""
    codes = np.frombuffer(text, np.uint8)
    window = longest // 2  # a line that is too long covers one of them
    starts = range(0, codes.size - window, window)
    if all(np.any(codes[start : start + min(_PIECE, window)] == _NEWLINE) for start in starts):
        return None
    lines = line_starts(text)
    long = np.flatnonzero(np.diff(lines, append=codes.size) > longest)
    return int(lines[long[0]]) if long.size else None
