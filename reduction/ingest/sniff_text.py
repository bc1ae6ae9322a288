"""Look at the start of a text log: encoding, separators, comment mark and header rows."""

from __future__ import annotations

import codecs
import csv
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from reduction.errors import LogError
from reduction.ingest.layout import Format
from reduction.ingest.sniff_channels import SeenColumn
from reduction.ingest.sniff_table import TableShape, is_number, look_at_table, seen_columns

_HEAD = 1 << 18
_LINES = 20_000  # that are looked at
_DELIMITERS = ("\t", ";", ",", "|", " ")
_COMMENTS = ("#", "%", "//", "!", "*")
_MTS = "MTS793|"
_LEAST_SHARE = (0.5, 0.8)  # of the fields are numbers; more where blanks part them
_THOUSANDS = {
    ".": re.compile(r"[+-]?\d{1,3}(,\d{3})+(\.\d*)?"),
    ",": re.compile(r"[+-]?\d{1,3}(\.\d{3})+(,\d*)?"),
}
_MARKED = (
    (codecs.BOM_UTF8, "utf-8"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)


@dataclass(frozen=True)
class SeenText:
    """A text log: its columns, the layout settings that read it, and remarks."""

    format: Format
    columns: list[SeenColumn]
    settings: dict[str, object]
    remarks: tuple[str, ...]


def _decode(path: Path, head: bytes) -> tuple[str, str, str]:
    """Text, encoding, and how sure that is."""
    for mark, encoding in _MARKED:
        if head.startswith(mark):
            text = head.decode(encoding, errors="ignore").removeprefix("\ufeff")
            return text, encoding, f"sure: encoding {encoding}, by the byte-order mark"
    if b"\0" in head:
        raise LogError(
            path, "the file is of no known format", found="binary content",
            needed="text, .xlsx, .xls, .ods, TDMS, MATLAB, HDF5, Parquet or JSON",
        )  # fmt: skip
    decoder = codecs.getincrementaldecoder("utf-8")()
    try:
        text = decoder.decode(head)
    except UnicodeDecodeError:
        text = head.decode("latin-1")
        return text, "latin-1", "guess: encoding latin-1, because it is not UTF-8"
    return text, "utf-8", "sure: encoding utf-8" + (" (plain ASCII)" if head.isascii() else "")


def _split(lines: Sequence[str], delimiter: str) -> list[list[str]]:
    if delimiter == " ":
        return [re.split(r"[ \t]+", line.strip()) for line in lines]
    short = ("" if len(line) > csv.field_size_limit() else line for line in lines)
    return [
        [text.strip() for text in next(csv.reader([line], delimiter=delimiter), [])]
        for line in short
    ]


def _comment(lines: Sequence[str]) -> str:
    """Mark at the start of the first filled line, where it is a usual one."""
    first = next((line for line in lines if line.strip()), "")
    return next((mark for mark in _COMMENTS if first.startswith(mark)), "")


def _without_comments(lines: Sequence[str], comment: str) -> list[str]:
    return ["" if comment and line.startswith(comment) else line for line in lines]


def _best_table(lines: Sequence[str]) -> tuple[str, str, TableShape] | None:
    """Delimiter, decimal mark and table that make the most of the fields numbers."""
    best, best_score = None, (0.0, 0)
    for delimiter in _DELIMITERS:
        rows = _split(lines, delimiter)
        for decimal in ".,":
            table = look_at_table(rows, decimal) if decimal != delimiter else None
            if table is None:
                continue
            fields = [text for row in table.rows for text in row if text]
            numbers = sum(is_number(text, decimal) for text in fields)
            score = (round(numbers / len(fields), 2), numbers)
            if score > best_score and score[0] > _LEAST_SHARE[delimiter == " "]:
                best, best_score = (delimiter, decimal, table), score
    return best


def _number_settings(
    table: TableShape, delimiter: str, decimal: str
) -> tuple[dict[str, object], list[str]]:
    """Thousands mark and missing marks, and how sure the decimal mark is."""
    fields = [text for row in table.rows for text in row if text]
    remarks = []
    marked = [text for text in fields if decimal in text and is_number(text, decimal)]
    if not marked:
        remarks.append(f"guess: decimal mark '{decimal}', because no number has one")
    elif decimal == "," and all(re.fullmatch(r"[+-]?\d{1,3},\d{3}", text) for text in marked):
        remarks.append("guess: decimal mark ',': every number could also have it for thousands")
    else:
        remarks.append(f"sure: decimal mark '{decimal}'")
    settings: dict[str, object] = {}
    odd: list[str] = []
    is_parted = False
    for place in range(table.n_fields):
        texts = [row[place] for row in table.rows if row[place]]
        strange = [text for text in texts if not is_number(text, decimal)]
        parted = [text for text in strange if _THOUSANDS[decimal].fullmatch(text)]
        if 2 * (len(strange) - len(parted)) < len(texts):
            odd += strange
            is_parted |= bool(parted)
    if is_parted:
        settings["thousands"] = "," if decimal == "." else "."
        remarks.append(f"guess: thousands mark '{settings['thousands']}'")
    marks = list(dict.fromkeys(text for text in odd if not _THOUSANDS[decimal].fullmatch(text)))
    marks = [mark for mark in marks if mark not in ("NaN", "nan")]
    if marks:
        settings["missing"] = ["", "NaN", "nan", *marks]
        shown = ", ".join(repr(mark) for mark in marks)
        remarks.append(f"guess: {shown} stands for a missing value")
    if not any(row[-1] for row in table.rows) and not table.names[-1]:
        remarks.append(f"sure: each row ends with a delimiter {delimiter!r}")
    return settings, remarks


def look_at_text(path: Path) -> SeenText:
    """Shape of the table in a text file, from its first 256 kB.

    Raises
    ------
    LogError
        If the file is binary, or no table of numbers stands at its start.
    """
    with path.open("rb") as stream:
        head = stream.read(_HEAD)
        is_whole = not stream.read(1)
    text, encoding, remark = _decode(path, head)
    lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    lines = (lines if is_whole else lines[:-1])[:_LINES]
    comment = _comment(lines)
    found = _best_table(_without_comments(lines, comment))
    if found is None:
        raise LogError(
            path, "no table of numbers stands at the start of the file",
            found=f"{len(lines)} lines", needed="rows of two or more numbers",
        )  # fmt: skip
    delimiter, decimal, table = found
    settings: dict[str, object] = {"delimiter": delimiter, "decimal": decimal, "encoding": encoding}
    remarks = [remark, f"sure: delimiter {delimiter!r}, {table.n_fields} fields a row"]
    more, more_remarks = _number_settings(table, delimiter, decimal)
    remarks += more_remarks
    columns = seen_columns(table, decimal, str(more.get("thousands", "")))
    if comment:
        settings["comment"] = comment
        remarks.append(f"guess: lines that begin with '{comment}' are comments")
        if table.name_row is None:
            columns, named = _named_by_comment(lines[: table.start], comment, delimiter, columns)
            remarks += named
    if lines[0].startswith(_MTS):
        opener = next(i for i in range((table.name_row or table.start) - 1, -1, -1) if lines[i])
        settings = {
            "delimiter": delimiter,
            "encoding": encoding,
            "block_marker": lines[opener].split(delimiter)[0],
        }
        remarks.append("sure: repeated blocks of MTS 793; its first line states the decimal mark")
        remarks.append(f"guess: a block opens at '{settings['block_marker']}' (row {opener + 1})")
    else:
        top = table.start if table.name_row is None else table.name_row
        if any(line.strip() for line in _without_comments(lines[:top], comment)):
            settings["preamble_rows"] = top
            remarks.append(f"sure: the table begins below row {top}")
    settings |= more
    settings["has_name_row"] = table.name_row is not None
    settings["has_unit_row"] = table.unit_row is not None
    if table.name_row is None:
        remarks.append("guess: there is no row of names; columns are numbers")
    else:
        remarks.append(f"guess: names stand in row {table.name_row + 1}")
    if table.unit_row is not None:
        remarks.append(f"guess: units stand in row {table.unit_row + 1}")
    is_blocks = "block_marker" in settings
    return SeenText("blocks" if is_blocks else "delimited", columns, settings, tuple(remarks))


def _named_by_comment(
    above: Sequence[str], comment: str, delimiter: str, columns: list[SeenColumn]
) -> tuple[list[SeenColumn], list[str]]:
    """Names from the last comment line, where it has as many as there are columns."""
    last = next((line for line in reversed(above) if line.startswith(comment)), "")
    names = _split([last.removeprefix(comment)], delimiter)[0]
    if len(names) != len(columns) or not all(names):
        return columns, []
    named = [
        replace(column, name=name, is_named=False)
        for column, name in zip(columns, names, strict=True)
    ]
    return named, ["guess: the names of the columns stand in the last comment line"]
