"""What a workbook takes in memory, found before its parser, which nothing can stop, sees it.

Every part is unpacked once, piece by piece, and none is kept: its checksum is compared, its bytes
and cells are counted.
"""

from __future__ import annotations

import struct
import zipfile
import zlib
from pathlib import Path

from reduction.errors import LogError
from reduction.ingest.compound import COMPOUND, workbook_stream
from reduction.ingest.limits import Watch
from reduction.ingest.markup import SoundMarkup, is_markup
from reduction.ingest.sheetbox import BinarySheet, MarkupPart, OldSheets, OpenSheets, PartLook

__all__ = ["check_workbook"]

_BLOCK = 1 << 20
_LISTED = 16  # bytes in memory for each that the list of the parts has
_END_OF_LIST = b"PK\x05\x06"
_LONGEST_END = 22 + 0xFFFF
_NOT_ZIP = (
    zipfile.BadZipFile, zlib.error, OSError, EOFError, NotImplementedError, RuntimeError,
    struct.error, UnicodeDecodeError, ValueError,
)  # fmt: skip


def check_workbook(path: Path, watch: Watch) -> None:
    """Refuse a workbook that is damaged, or would take more memory than it may.

    Parameters
    ----------
    path : pathlib.Path
        The workbook; what is neither zipped nor a compound file is left to the parser.
    watch : Watch
        Holds it against its limits.

    Raises
    ------
    LogError
        If checksums do not agree, parts overlap or are not as long as stated, the file states more
        than it holds, or what it unpacks to is beyond a limit.
    """
    with path.open("rb") as stream:
        is_compound = stream.read(len(COMPOUND)) == COMPOUND
    if is_compound:
        watch.check_unpacked(2 * path.stat().st_size, "the workbook")
        sheets = OldSheets()
        sheets.add(workbook_stream(path))
        _check_memory(path, watch, sheets, "a sheet")
    elif zipfile.is_zipfile(path):
        _check_zipped(path, watch)


def _check_zipped(path: Path, watch: Watch) -> None:
    watch.check_unpacked(_LISTED * _length_of_list(path), "the list of the parts of the workbook")
    try:
        with zipfile.ZipFile(path) as archive:
            members = archive.infolist()
            _check_places(path, members)
            watch.check_unpacked(sum(member.file_size for member in members), "the workbook")
            is_binary = any(member.filename == "xl/workbook.bin" for member in members)
            for member in members:
                _look_at(path, archive, member, watch, is_binary)
    except _NOT_ZIP as error:
        if isinstance(error, LogError):
            raise
        raise _damaged(path, str(error)) from error


def _length_of_list(path: Path) -> int:
    """Bytes of the list of parts as the end of the file states them; of all where it is long."""
    size = path.stat().st_size
    with path.open("rb") as stream:
        stream.seek(max(size - _LONGEST_END, 0))
        end = stream.read()
    at = end.rfind(_END_OF_LIST)
    stated: int = struct.unpack_from("<I", end, at + 12)[0] if 0 <= at <= len(end) - 22 else size
    return min(stated, size)


def _check_places(path: Path, members: list[zipfile.ZipInfo]) -> None:
    """Parts that share bytes unpack to many times the file."""
    end = 0
    for member in sorted(members, key=lambda one: one.header_offset):
        if member.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
            raise _damaged(path, f"'{member.filename}' is packed in a way that no workbook is")
        if member.header_offset < end:
            raise _damaged(path, f"'{member.filename}' lies inside the part before it")
        end = member.header_offset + 30 + len(member.orig_filename) + member.compress_size


def _look_at(
    path: Path,
    archive: zipfile.ZipFile,
    member: zipfile.ZipInfo,
    watch: Watch,
    is_binary: bool,
) -> None:
    """Unpack one part, piece by piece."""
    looks: list[PartLook] = [MarkupPart()]
    if member.filename == "content.xml":
        looks.append(OpenSheets())
    if is_binary and member.filename.endswith(".bin"):
        looks.append(BinarySheet())
    markup = SoundMarkup(path, member.filename) if is_markup(member.filename) else None
    size = 0
    with archive.open(member) as stream:
        while block := stream.read(_BLOCK):
            size += len(block)
            if markup is not None:
                markup.add(block)
            for look in looks:
                look.add(block)
                _check_memory(path, watch, look, f"'{member.filename}'")
            watch.check_time()
    if markup is not None:
        markup.finish()
    if size != member.file_size:
        raise _damaged(
            path, f"'{member.filename}' of {size:,} bytes, where {member.file_size:,} are stated"
        )


def _check_memory(path: Path, watch: Watch, look: PartLook, what: str) -> None:
    try:
        watch.check_unpacked(look.memory(), f"{what} of the workbook")
    except LogError as error:
        raise LogError(
            path,
            error.problem,
            found=error.found,
            needed=error.needed,
            hint="A cell far off from the others costs as much as all between: delete it. "
            + (error.hint or ""),
        ) from error


def _damaged(path: Path, found: str) -> LogError:
    return LogError(
        path,
        "the workbook is damaged",
        found=found,
        needed="an intact workbook",
        hint="Open it in a spreadsheet program and save it again, or get the file again.",
    )
