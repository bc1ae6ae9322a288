"""Text of a raw file as UTF-8, in the encoding that its layout declares."""

from __future__ import annotations

import codecs
from dataclasses import dataclass
from pathlib import Path

from reduction.errors import LogError, SettingsError

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
# of host names, of escapes in source code, and of nothing: no machine writes a log in them
_NO_TEXT = {"idna", "punycode", "unicode-escape", "raw-unicode-escape", "undefined"}
_SAMPLE = "0,1\n"


@dataclass(frozen=True)
class TextEncoding:
    """How the bytes of a file are text.

    Parameters
    ----------
    path : pathlib.Path
        For messages.
    declared : str
        As the layout spells it.
    codec : str
        What the text is in: UTF-8 where its byte-order mark says so.
    mark : bytes
        Byte-order mark of UTF-8 that the file begins with.
    """

    path: Path
    declared: str
    codec: str
    mark: bytes

    @property
    def keeps_ascii(self) -> bool:
        """Whether ASCII bytes are ASCII characters, so that lines end in bytes as in text."""
        try:
            return _ASCII.decode(self.codec) == _ASCII.decode("ascii")
        except UnicodeDecodeError:
            return False

    def to_utf8(self, data: bytes | bytearray | memoryview, *, is_first: bool) -> memoryview:
        """Whole lines below the mark as UTF-8; `UnicodeDecodeError` where they are none."""
        text = str(data, self.codec)
        if self.codec in _UTF8_FAMILY:
            return memoryview(data)
        return memoryview((text.removeprefix(_CHARACTER_MARK) if is_first else text).encode())

    def binary(self, row: int) -> LogError:
        """Error of a file with a NUL byte in it."""
        return LogError(
            self.path,
            "the file is binary, not text",
            row=row,
            found="a NUL byte",
            needed=f"text in {self.declared}",
            hint="Declare the format of the file, or its encoding where it is UTF-16.",
        )

    def other(self, error: UnicodeDecodeError, row: int | None) -> LogError:
        """Error of bytes that are no text in the declared encoding."""
        return LogError(
            self.path,
            "the file is not in the declared encoding",
            row=row,
            found=f"byte 0x{error.object[error.start]:02x}",
            needed=f"text in {self.declared}",
            hint='Declare the encoding that the machine wrote, often "latin-1" or "cp1252".',
        )


def find_encoding(path: Path, head: bytes, declared: str) -> TextEncoding:
    """Compare the declared encoding with the first bytes of a file.

    Raises
    ------
    LogError
        If the file begins with the byte-order mark of another encoding.
    SettingsError
        If there is no such encoding.
    """
    try:
        codec = codecs.lookup(declared).name
        is_text = codec not in _NO_TEXT and _SAMPLE.encode(declared).decode(declared) == _SAMPLE
    except (LookupError, ValueError):  # not known, or of no text; a NUL byte in the name
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
        return TextEncoding(path, declared, marked, mark)
    if not marked and codec in ("utf-16", "utf-32"):
        codec += "-le"  # as most machines write
    return TextEncoding(path, declared, codec, b"")


def decode(path: Path, data: bytes, encoding: str) -> bytes:
    """Bytes of a whole text file as UTF-8 without a byte-order mark.

    Raises
    ------
    LogError
        If the file is binary, or is not in the declared encoding, with the row.
    SettingsError
        If there is no such encoding.
    """
    found = find_encoding(path, data[:4], encoding)
    keeps_ascii = found.keeps_ascii
    if keeps_ascii and (nul := data.find(b"\0")) >= 0:
        raise found.binary(row_of(data, nul))
    if keeps_ascii and data.isascii():
        return data
    try:
        return bytes(found.to_utf8(data[len(found.mark) :], is_first=True))
    except UnicodeDecodeError as error:
        place = len(found.mark) + error.start
        raise found.other(error, row_of(data, place) if keeps_ascii else None) from error


def row_of(data: bytes | bytearray, place: int) -> int:
    """Row from 1 of a byte: lines end in a line feed, a carriage return, or both."""
    returns = data.count(b"\r", 0, place) - data.count(b"\r\n", 0, place)
    return data.count(b"\n", 0, place) + returns + 1
