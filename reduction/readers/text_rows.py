"""Splits text files into parts of whole lines, and provides their rows.

A fault in the text is reported after the lines above it have been handed on, so that the first
error of a file does not depend on the length of the parts.
"""

from __future__ import annotations

import codecs
import csv
import os
import re
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing, contextmanager
from dataclasses import dataclass, replace
from functools import partial
from io import BufferedReader
from pathlib import Path
from typing import Any

import numpy as np

from reduction.readers.layout import Layout, LogParts, Watch
from reduction.readers.raw_log import RunningHash, check_not_empty, unreadable
from reduction.record.errors import LogError, SettingsError
from reduction.record.measurement import Integers, Source

_UTF8_FAMILY = {"utf-8", "utf-8-sig", "ascii"}

# the longer mark first: a UTF-32 mark begins with the UTF-16 one
_MARKS = (
    (codecs.BOM_UTF8, "utf-8"),
    (codecs.BOM_UTF32_LE, "utf-32"),
    (codecs.BOM_UTF32_BE, "utf-32"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)

_ASCII = bytes(range(128))

_CHARACTER_MARK = "\ufeff"

# for host names, source-code escapes or nothing at all: no machine writes logs in them
_NO_TEXT = {"idna", "punycode", "unicode-escape", "raw-unicode-escape", "undefined"}

_SAMPLE = "0,1\n"


@dataclass(frozen=True)
class _TextEncoding:
    """Text encoding of a file."""

    path: Path
    declared: str
    codec: str
    mark: bytes

    @property
    def keeps_ascii(self) -> bool:
        """Whether ASCII bytes are ASCII characters, so that line ends can be found in bytes."""
        try:
            return _ASCII.decode(self.codec) == _ASCII.decode("ascii")
        except UnicodeDecodeError:
            return False

    def to_utf8(self, data: bytes | bytearray | memoryview, *, is_first: bool) -> memoryview:
        """Whole lines after the byte-order mark as UTF-8; `UnicodeDecodeError` if invalid."""
        text = str(data, self.codec)
        if self.codec in _UTF8_FAMILY:
            return memoryview(data)
        return memoryview((text.removeprefix(_CHARACTER_MARK) if is_first else text).encode())

    def binary(self, row: int) -> LogError:
        """Error for a file with a NUL byte in it."""
        return LogError(
            self.path,
            "the file is binary, not text",
            row=row,
            found="a NUL byte",
            needed=f"text in {self.declared}",
            hint="Declare the format of the file, or its encoding where it is UTF-16.",
        )

    def other(self, error: UnicodeDecodeError, row: int | None) -> LogError:
        """Error for bytes that are invalid in the declared encoding."""
        return LogError(
            self.path,
            "the file is not in the declared encoding",
            row=row,
            found=f"byte 0x{error.object[error.start]:02x}",
            needed=f"text in {self.declared}",
            hint='Declare the encoding that the machine wrote, often "latin-1" or "cp1252".',
        )


def _find_encoding(path: Path, head: bytes, declared: str) -> _TextEncoding:
    """Compare the declared encoding with the first bytes of a file."""
    try:
        codec = codecs.lookup(declared).name
        is_text = codec not in _NO_TEXT and _SAMPLE.encode(declared).decode(declared) == _SAMPLE
    except (LookupError, ValueError):  # unknown or not a text encoding; a NUL byte in the name
        is_text = False
    if not is_text:
        raise SettingsError(
            "an encoding is not known",
            found=repr(declared),
            needed="a name such as utf-8, latin-1, cp1252 or utf-16",
        )
    mark, marked = next(((m, e) for m, e in _MARKS if head.startswith(m)), (b"", ""))
    if marked and not (codec.startswith(marked) or (marked == "utf-8" and codec in _UTF8_FAMILY)):
        raise LogError(
            path,
            "the file is not in the declared encoding",
            row=1,
            found=f"the byte-order mark of {marked}",
            needed=f"{declared}, as the layout declares",
            hint=f'Declare encoding = "{marked}" in the layout.',
        )
    if marked == "utf-8":
        return _TextEncoding(path, declared, marked, mark)
    if not marked and codec in ("utf-16", "utf-32"):
        codec += "-le"  # as on most machines
    return _TextEncoding(path, declared, codec, b"")


def decode(path: Path, data: bytes, encoding: str) -> bytes:
    """Bytes of a whole text file as UTF-8 without a byte-order mark."""
    found = _find_encoding(path, data[:4], encoding)
    keeps_ascii = found.keeps_ascii
    if keeps_ascii and (nul := data.find(b"\0")) >= 0:
        raise found.binary(_row_of(data, nul))
    if keeps_ascii and data.isascii():
        return data
    try:
        return bytes(found.to_utf8(data[len(found.mark) :], is_first=True))
    except UnicodeDecodeError as error:
        place = len(found.mark) + error.start
        raise found.other(error, _row_of(data, place) if keeps_ascii else None) from error


def _row_of(data: bytes | bytearray, place: int) -> int:
    """Row (from 1) of a byte; lines end in a line feed, a carriage return, or both."""
    returns = data.count(b"\r", 0, place) - data.count(b"\r\n", 0, place)
    return data.count(b"\n", 0, place) + returns + 1


_PIECE = 1 << 17  # fits in the cache

_NEWLINE, _RETURN = b"\n\r"

_SHOWN = 60  # characters of a line shown in a message


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
        Bytes without line ends after the last row.
    first_row : int
        Editor's row of the first line.
    line_row : ndarray of int, shape (n_lines,), optional
        Editor's row of each line if they are not consecutive.
    is_open : bool
        Whether the file ends with the last line, without a line end.
    n_lines : int, optional
        Number of lines, if they have been counted.
    longest_line : int
        Upper limit for the bytes of a line. [1]
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
        """Editor's row of each of `n_rows` data rows; None if they are those of the lines."""
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
        """The lines one by one, to locate an error."""
        return (line.decode("utf-8") for line in bytes(self.text).split(b"\n"))

    def not_told_apart(self, found: str) -> LogError:
        """Error for rows that the parser misreads."""
        return LogError(self.path, "the rows cannot be told apart", found=found)

    def unclosed(self, line: int, text: str) -> LogError | None:
        """Error for a line, counted from 0, whose last quoted field is not closed."""
        if not self.layout.quote or self.layout.quote not in text:
            return None
        reader = csv.reader([text + "\n", text], **_dialect(self.layout))
        try:
            is_closed = len(list(reader)) > 1
        except csv.Error:  # the field is longer than the csv module accepts
            is_closed = True
        if is_closed:
            return None
        return LogError(
            self.path,
            "a quoted field continues beyond its line",
            row=self.row_of_line(line),
            found=repr(text.strip()[:_SHOWN]),
            needed="one line a row",
            hint="Close the quote, or declare another quote character in the layout.",
        )


def count_lines(text: memoryview) -> int:
    """Number of lines; the last one may lack a line end."""
    codes = np.frombuffer(text, np.uint8)
    pieces = (codes[start : start + _PIECE] for start in range(0, codes.size, _PIECE))
    return int(sum(np.count_nonzero(piece == _NEWLINE) for piece in pieces)) + 1


def line_starts(text: memoryview) -> Integers:
    """Index of the first byte of each line, shape (n_lines,)."""
    return np.concatenate([[0], np.flatnonzero(np.frombuffer(text, np.uint8) == _NEWLINE) + 1])


def split_line(line: str, layout: Layout) -> list[str]:
    """Fields of one line, without quotes and surrounding blanks."""
    try:
        fields = next(csv.reader([line], **_dialect(layout)), [])
    except csv.Error:  # the field is longer than the csv module accepts
        fields = line.split(layout.delimiter)
    return [field.strip() for field in fields]


def without_outer_quotes(text: memoryview, quote: str) -> memoryview:
    r"""Rows of which a spreadsheet made one quoted field each, as it saves what it did not split.

    Examples
    --------
    >>> rows = memoryview(b'"time,""load, N"",cycle"\n"0.1,2.5,1"')
    >>> print(bytes(without_outer_quotes(rows, '"')).decode())
    time,"load, N",cycle
    0.1,2.5,1
    >>> bytes(without_outer_quotes(memoryview(b'"0,1","2,5"'), '"'))
    b'"0,1","2,5"'
    """
    mark = re.escape(quote.encode())
    row = re.compile(rb"(?m)^%b((?:(?!%b)[^\n]|%b%b)*)%b(?=\r?$)" % ((mark,) * 5))
    last = bytes(text[-_LOOK:]).rpartition(b"\n")[2]
    if row.fullmatch(last.rstrip(b"\r")) is None:
        return text
    doubled = 2 * quote.encode()
    return memoryview(row.sub(lambda one: one[1].replace(doubled, quote.encode()), bytes(text)))


def _dialect(layout: Layout) -> dict[str, Any]:
    return {
        "delimiter": layout.delimiter,
        "quotechar": layout.quote or None,
        "quoting": csv.QUOTE_MINIMAL if layout.quote else csv.QUOTE_NONE,
    }


_LOOK = 1 << 16  # bytes examined to recognise a binary file

_MARK = 4  # length of the longest byte-order mark in bytes

_FILE_END = b"\n\r\x1a"  # DOS ends a file with the last one

_Fault = tuple[int, Callable[[int], LogError]]  # lines above it, and the error for its row


@dataclass(frozen=True)
class _TextPart:
    """Whole lines of a file."""

    text: memoryview
    first_row: int
    n_lines: int
    is_open: bool


class TextFile:
    """A text file read once from beginning to end; see `open_text`."""

    def __init__(
        self, path: Path, stream: BufferedReader, encoding: str, parts: LogParts, watch: Watch
    ) -> None:
        """Examine the beginning of the file."""
        size = os.fstat(stream.fileno()).st_size
        check_not_empty(path, size)
        try:
            head = stream.read(_LOOK)
            self._encoding = _find_encoding(path, head[:_MARK], encoding)
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
            raise self._encoding.binary(_row_of(head, nul))
        self._decoder = codecs.getincrementaldecoder(self._encoding.codec)()
        self._is_at_start = True
        self._worker = ThreadPoolExecutor(1)
        self._hash = RunningHash()
        self._hash.add(memoryview(self._encoding.mark))

    def __iter__(self) -> Iterator[_TextPart]:
        """Parts in order; the next one is read while the caller processes this one."""
        parts = self._parts()
        coming = self._worker.submit(next, parts, None)
        while (part := coming.result()) is not None:
            coming = self._worker.submit(next, parts, None)
            self._watch.check_time()
            yield part

    def source(self, name: str) -> Source:
        """Name, hash and size of the file, after all of it has been read."""
        return self._hash.source(name)

    def close(self) -> None:
        """Stop reading and hashing."""
        # not at the end of a forgotten iterator, which can come in any thread at any time
        self._worker.shutdown()
        self._hash.close()

    def _parts(self) -> Iterator[_TextPart]:
        """Parts of whole lines; an incomplete line is carried over to the next part."""
        rest, row, is_last = b"", 1, False
        while not is_last:
            data, fault = self._read(rest)
            if fault is None and _unfinished(data) > 2 * self.longest_line:
                fault = _row_of(data, len(data)) - 1, self._watch.long_line
            is_last = fault is None and self._left == 0
            stop, begin = (_end(data, len(data)), len(data)) if is_last else _cut(data)
            rest = bytes(memoryview(data)[begin:])
            text, found = self._checked(data, stop)
            n_lines = count_lines(text) if text else 0
            if n_lines:
                is_open = is_last and bytes(data[stop : stop + 1]) not in (b"\n", b"\r")
                yield _TextPart(text, row, n_lines, is_open)
            if found is not None or fault is not None:
                above, error = found or fault or (0, self._watch.long_line)
                raise error(row + above)
            row += n_lines

    def _read(self, rest: bytes) -> tuple[bytearray, _Fault | None]:
        """Carried-over and new bytes; UTF-8 if line ends cannot be found in bytes."""
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
        return data, None if wrong is None else (_row_of(data, len(data)) - 1, wrong)

    def _checked(self, data: bytearray, stop: int) -> tuple[memoryview, _Fault | None]:
        """Lines as UTF-8 with uniform line ends: all, or those above the first fault."""
        text, fault = memoryview(data)[:stop], None
        if self._keeps_ascii and stop:
            if (nul := data.find(b"\0", 0, stop)) >= 0:
                text, fault = _above(text, nul), (_row_of(data, nul) - 1, self._encoding.binary)
            if not data.isascii():
                at_start, self._is_at_start = self._is_at_start, False
                try:
                    text = self._encoding.to_utf8(text, is_first=at_start)
                except UnicodeDecodeError as error:
                    text = _above(text, error.start)
                    text = self._encoding.to_utf8(text, is_first=at_start)
                    fault = _row_of(data, error.start) - 1, partial(self._encoding.other, error)
            self._is_at_start = False
        if data.find(b"\r", 0, stop) >= 0 and _has_lone_return(text):
            text = memoryview(bytes(text).replace(b"\r\n", b"\n").replace(b"\r", b"\n"))
        if (long := _long_line(text, self.longest_line)) is not None:
            text, fault = _above(text, long), (count_lines(text[:long]) - 1, self._watch.long_line)
        return text, fault


@contextmanager
def open_text(
    path: Path, encoding: str, parts: LogParts, watch: Watch | None = None
) -> Iterator[TextFile]:
    """Open a text file for reading in parts."""
    try:
        stream = path.open("rb")
    except OSError as error:
        raise unreadable(path, error) from error
    with stream, closing(TextFile(path, stream, encoding, parts, watch or Watch(path))) as file:
        yield file


def _end(data: bytearray, stop: int) -> int:
    """Index after the last byte that is not part of a line end or end-of-file mark."""
    while stop and data[stop - 1] in _FILE_END:
        stop -= 1
    return stop


def _cut(data: bytearray) -> tuple[int, int]:
    """End of the last complete non-blank line, and start of the next line."""
    stop = _last_line_end(data, len(data))
    while stop >= 0:
        end = _end(data, stop)
        if data.find(b"\x1a", end, stop) < 0:
            return (end, end + 1 + (data[end : end + 2] == b"\r\n")) if end else (0, 0)
        stop = _last_line_end(data, end)
    return 0, 0


def _last_line_end(data: bytearray, stop: int) -> int:
    """Index of the last line end before a byte; -1 if there is none."""
    feed = data.rfind(b"\n", 0, stop)
    return max(feed, data.rfind(b"\r", feed + 1, min(stop, len(data) - 1)))


def _unfinished(data: bytearray) -> int:
    """Number of bytes after the last line end."""
    feed = data.rfind(b"\n")
    return len(data) - 1 - max(feed, data.rfind(b"\r", feed + 1))


def _above(text: memoryview, place: int) -> memoryview:
    """Lines above the one with a byte, without line ends after the last."""
    lines = bytes(text[:place])
    return memoryview(lines[: max(lines.rfind(b"\n"), lines.rfind(b"\r"), 0)].rstrip(b"\r\n"))


def _has_lone_return(text: memoryview) -> bool:
    """Whether a carriage return has no line feed after it; the text does not end in one."""
    codes = np.frombuffer(text, np.uint8)
    pieces = (codes[start : start + _PIECE + 1] for start in range(0, codes.size, _PIECE))
    return any(np.any((piece[:-1] == _RETURN) & (piece[1:] != _NEWLINE)) for piece in pieces)


def _long_line(text: memoryview, longest: int) -> int | None:
    """Index of the first line that is too long; None if there is none."""
    codes = np.frombuffer(text, np.uint8)
    window = longest // 2  # a line that is too long covers a whole window
    starts = range(0, codes.size - window, window)
    if all(np.any(codes[start : start + min(_PIECE, window)] == _NEWLINE) for start in starts):
        return None
    lines = line_starts(text)
    long = np.flatnonzero(np.diff(lines, append=codes.size) > longest)
    return int(lines[long[0]]) if long.size else None
