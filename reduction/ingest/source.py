"""Bytes of a raw file: whole, unchanged while read, and text where text is declared.

A reader works on one copy of the bytes, so that the hash of a product is the hash of
what was parsed.
"""

from __future__ import annotations

import codecs
import hashlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from reduction.errors import LogError, SettingsError
from reduction.provenance import Source

__all__ = ["decode", "hash_source", "read_bytes", "source_of", "unchanged"]

_BLOCK = 1 << 20
_UTF8_FAMILY = {"utf-8", "utf-8-sig", "ascii"}
# the longer mark first: a UTF-32 mark begins with the UTF-16 one
_MARKS = (
    (codecs.BOM_UTF8, "utf-8"),
    (codecs.BOM_UTF32_LE, "utf-32"),
    (codecs.BOM_UTF32_BE, "utf-32"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)


def hash_source(path: Path, name: str) -> Source:
    """Hash a file in pieces, so that its size does not matter.

    Raises
    ------
    LogError
        If the file cannot be opened or is empty.
    """
    digest, size = hashlib.sha256(), 0
    try:
        with path.open("rb") as stream:
            while block := stream.read(_BLOCK):
                digest.update(block)
                size += len(block)
    except OSError as error:
        raise _unreadable(path, error) from error
    _check_not_empty(path, size)
    return Source(name, digest.hexdigest(), size)


def source_of(data: bytes, name: str) -> Source:
    """Hash of bytes already read."""
    return Source(name, hashlib.sha256(data).hexdigest(), len(data))


def read_bytes(path: Path) -> bytes:
    """Read a file whole.

    Raises
    ------
    LogError
        If the file cannot be opened, is empty, or changes meanwhile.
    """
    with unchanged(path):
        try:
            data = path.read_bytes()
        except OSError as error:
            raise _unreadable(path, error) from error
    _check_not_empty(path, len(data))
    return data


@contextmanager
def unchanged(path: Path) -> Iterator[None]:
    """Raise `LogError` where a file changes inside the ``with`` block."""
    before = _state(path)
    yield
    after = _state(path)
    if after != before:
        verb = "shrank" if after[0] < before[0] else "grew" if after[0] > before[0] else "changed"
        raise LogError(
            path,
            f"the file {verb} while it was read",
            found=f"{before[0]} bytes, then {after[0]} bytes",
            needed="a file that nothing writes to",
            hint="Wait until the logger or the copy has ended.",
        )


def decode(path: Path, data: bytes, encoding: str) -> bytes:
    """Bytes of a text file as UTF-8 without a byte-order mark.

    Raises
    ------
    LogError
        If the file is binary, or is not in the declared encoding, with the row.
    SettingsError
        If there is no such encoding.
    """
    try:
        declared = codecs.lookup(encoding).name
    except LookupError as error:
        raise SettingsError(
            f"encoding '{encoding}' is not known",
            found=f"'{encoding}'",
            needed="a name such as utf-8, latin-1, cp1252 or utf-16",
        ) from error
    mark, marked = next(((m, e) for m, e in _MARKS if data.startswith(m)), (b"", ""))
    if marked and not (
        declared.startswith(marked) or (marked == "utf-8" and declared in _UTF8_FAMILY)
    ):
        raise LogError(
            path,
            "the file is not in the declared encoding",
            row=1,
            found=f"the byte-order mark of {marked}",
            needed=f"{encoding}, as the layout declares",
            hint=f'Declare encoding = "{marked}" in the layout.',
        )
    is_wide = declared.startswith(("utf-16", "utf-32"))
    if not is_wide and (nul := data.find(b"\0")) >= 0:
        raise LogError(
            path,
            "the file is binary, not text",
            row=_row_of(data, nul),
            found="a NUL byte",
            needed=f"text in {encoding}",
            hint="Declare the format of the file, or its encoding where it is UTF-16.",
        )
    if data.isascii() and not is_wide:
        return data
    body = data[len(mark) :] if marked == "utf-8" else data
    try:
        text = body.decode("utf-8" if marked == "utf-8" else declared)
    except UnicodeDecodeError as error:
        raise LogError(
            path,
            "the file is not in the declared encoding",
            row=None if is_wide else _row_of(body, error.start),
            found=f"byte 0x{body[error.start]:02x}",
            needed=f"text in {encoding}",
            hint='Declare the encoding that the machine wrote, often "latin-1" or "cp1252".',
        ) from error
    if declared in _UTF8_FAMILY:
        return body
    return text.removeprefix("\ufeff").encode("utf-8")


def _row_of(data: bytes, place: int) -> int:
    return data.count(b"\n", 0, place) + 1


def _state(path: Path) -> tuple[int, int]:
    try:
        status = path.stat()
    except OSError as error:
        raise _unreadable(path, error) from error
    return status.st_size, status.st_mtime_ns


def _unreadable(path: Path, error: OSError) -> LogError:
    return LogError(
        path,
        "the file cannot be read",
        found=error.strerror or type(error).__name__,
        needed="a file that this user may read",
    )


def _check_not_empty(path: Path, size: int) -> None:
    if size == 0:
        raise LogError(path, "the file is empty", found="0 bytes", needed="a log")
