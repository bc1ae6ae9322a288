"""Compound files: how .xls lies on the disk, read as far as the stream of the workbook.

What such a file says of its own size is compared with the file: the parser believes it.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from pathlib import Path

from reduction.errors import LogError

__all__ = ["COMPOUND", "workbook_stream"]

COMPOUND = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"
_END = 0xFFFFFFFE
_LAST_SECTOR = 0xFFFFFFF9
_HEADER = 512
_ENTRY = 128
_NAMES = ("Workbook", "Book")


@dataclass(frozen=True)
class _Header:
    """Where the tables of a compound file stand, and how many sectors each has."""

    sector: int
    n_tables: int
    directory: int
    least: int
    mini_table: int
    n_mini_tables: int
    more_tables: int
    n_more_tables: int


def workbook_stream(path: Path) -> bytes:
    """The stream of the workbook in a compound file; empty where there is none.

    Parameters
    ----------
    path : pathlib.Path
        The file.

    Returns
    -------
    stream : bytes
        No longer than the file.

    Raises
    ------
    LogError
        If the file says that it is larger than it is, or its sectors lead nowhere.

    Notes
    -----
    Layout: [MS-CFB], Compound File Binary File Format, sections 2.2 to 2.6.
    """
    data = path.read_bytes()
    try:
        return _stream(path, data)
    except (struct.error, IndexError) as error:
        raise _damaged(path, "it ends too soon") from error


def _stream(path: Path, data: bytes) -> bytes:
    header = _header(path, data)
    table = _table(path, data, header)
    directory = b"".join(_chain(path, data, header.sector, table, header.directory))
    entries = [directory[at : at + _ENTRY] for at in range(0, len(directory), _ENTRY)]
    root = b""
    for entry in entries:
        length, kind = struct.unpack_from("<HB", entry, 64)
        name = entry[: max(length - 2, 0)].decode("utf-16-le", errors="replace")
        start, size = struct.unpack_from("<II", entry, 116)
        if kind not in (2, 5):
            continue
        if size > len(data):
            raise _damaged(path, f"'{name}' of {size:,} bytes in a file of {len(data):,}")
        if kind == 5:
            root = entry
        elif name in _NAMES:
            if size >= header.least:
                found = b"".join(_chain(path, data, header.sector, table, start))
            else:
                found = _small(path, data, header, table, root, start)
            return found[:size]
    return b""


def _header(path: Path, data: bytes) -> _Header:
    shift, small_shift = struct.unpack_from("<HH", data, 30)
    if shift not in (9, 12) or small_shift != 6:
        raise _damaged(path, f"sectors of 2^{shift} and 2^{small_shift} bytes")
    n_tables, directory = struct.unpack_from("<II", data, 44)
    header = _Header(1 << shift, n_tables, directory, *struct.unpack_from("<IIIII", data, 56))
    n_sectors = len(data) >> shift
    for count in (header.n_tables, header.n_mini_tables, header.n_more_tables):
        if count > n_sectors:
            raise _damaged(path, f"a table of {count:,} sectors in a file of {n_sectors:,}")
    return header


def _table(path: Path, data: bytes, header: _Header) -> list[int]:
    """The sector that follows each."""
    places = list(struct.unpack_from("<109I", data, 76))
    more, n_seen = header.more_tables, 0
    per_sector = header.sector // 4
    while more <= _LAST_SECTOR:
        n_seen += 1
        if n_seen > header.n_more_tables:
            raise _damaged(path, "a table of tables without end")
        listed = struct.unpack_from(f"<{per_sector}I", data, _at(header.sector, more))
        places += listed[:-1]
        more = listed[-1]
    table: list[int] = []
    for place in places[: header.n_tables]:
        if place <= _LAST_SECTOR:
            table += struct.unpack_from(f"<{per_sector}I", data, _at(header.sector, place))
    return table


def _at(sector: int, place: int) -> int:
    return max(_HEADER, sector) + place * sector


def _chain(path: Path, data: bytes, sector: int, table: list[int], start: int) -> list[bytes]:
    """Sectors from one on, in their order."""
    parts: list[bytes] = []
    while start <= _LAST_SECTOR:
        if len(parts) > len(table):
            raise _damaged(path, "sectors that lead round in a circle")
        at = _at(sector, start)
        if at >= len(data):
            raise _damaged(path, f"sector {start:,}, which is behind its end")
        parts.append(data[at : at + sector])
        start = table[start]
    return parts


def _small(
    path: Path, data: bytes, header: _Header, table: list[int], root: bytes, start: int
) -> bytes:
    """A stream that is too short for sectors of its own."""
    held = b"".join(
        _chain(path, data, header.sector, table, struct.unpack_from("<I", root, 116)[0])
    )
    small = b"".join(_chain(path, data, header.sector, table, header.mini_table))
    follows = struct.unpack(f"<{len(small) // 4}I", small[: len(small) // 4 * 4])
    parts: list[bytes] = []
    while start <= _LAST_SECTOR:
        if len(parts) > len(follows):
            raise _damaged(path, "sectors that lead round in a circle")
        parts.append(held[64 * start : 64 * start + 64])
        start = follows[start]
    return b"".join(parts)


def _damaged(path: Path, found: str) -> LogError:
    return LogError(
        path,
        "the workbook is damaged",
        found=f"it states {found}",
        needed="an intact .xls workbook",
        hint="Open it in a spreadsheet program and save it as .xlsx.",
    )
