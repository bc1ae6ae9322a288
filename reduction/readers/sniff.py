"""Looks at an unknown log and proposes a layout.

The proposal is text, never a `Layout`: unknown values are ``?``, and a layout with a ``?`` does not
load.
"""

from __future__ import annotations

import codecs
import csv
import math
import re
import zipfile
from collections import Counter, deque
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from reduction.readers.bounded_reader import bounded
from reduction.readers.channel_names import (
    FOREIGN_WORDS,
    SeenColumn,
    is_unit,
    propose_channels_table,
)
from reduction.readers.columns import CLOCK_TEXT, ColumnTable, is_wide, matrix_table, plain_date
from reduction.readers.delimited import without_comment_name
from reduction.readers.hdf5 import data_set, group_table, open_hdf5, read_texts
from reduction.readers.json_matrix import json_content
from reduction.readers.layout import UNKNOWN, Format, Layout, Watch
from reduction.readers.matlab import (
    OF_MATLAB_ALONE,
    matlab_table,
    open_matlab,
    read_cell_texts,
    struct_fields,
    struct_place,
)
from reduction.readers.parquet import open_parquet, parquet_table
from reduction.readers.raw_log import check_not_empty, unchanged, unreadable
from reduction.readers.spreadsheet import open_workbook, read_rows
from reduction.readers.tdms import WAVEFORM_COLUMN, open_tdms, tdms_table
from reduction.readers.text_rows import without_outer_quotes
from reduction.record.errors import LogError
from reduction.record.measurement import Bools
from reduction.record.plain_text import toml_text
from reduction.record.settings import Limits


@dataclass(frozen=True)
class _SeenTable:
    """A possible log table: its columns, the layout settings that read it, and remarks."""

    format: Format
    columns: list[SeenColumn]
    settings: dict[str, object] = field(default_factory=dict)
    remarks: tuple[str, ...] = ()
    preamble: tuple[str, ...] = ()
    is_cut: bool = False
    """Whether only the beginning of the file was looked at."""


_ROWS = 4000

_NEARLY = 0.9  # of the rows: a table with fewer is seen as a whole

_RUN = 3  # minimum number of consecutive rows in a table

_PART_OF = 8  # a part of a table is longer than its longest part divided by this

_FILLED = 0.5  # of the rows: a column with fewer values need not have a name

_NUMBER = {
    mark: re.compile(rf"[+-]?(\d+({re.escape(mark)}\d*)?|{re.escape(mark)}\d+)([eE][+-]?\d+)?")
    for mark in ".,"
}


@dataclass(frozen=True)
class _TableShape:
    """Position of a table in rows of fields; rows count from 0."""

    start: int
    """First data row."""
    n_fields: int
    name_row: int | None
    unit_row: int | None
    names: tuple[str, ...]
    units: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    """Fields of some data rows."""
    above: tuple[str, ...]
    """Lines above the names."""


def _is_number(text: str, decimal: str) -> bool:
    """Whether a field is a number with this decimal mark and no thousands mark."""
    return _NUMBER[decimal].fullmatch(text) is not None


_DATE = re.compile(r"\d{1,4}[-./]\d{1,2}[-./]\d{2,4}")


def _is_time(text: str) -> bool:
    """Whether a field is a clock time, a date, or both."""
    is_clock = ":" in text and CLOCK_TEXT.fullmatch(plain_date(text, "day first")) is not None
    return is_clock or _DATE.fullmatch(text) is not None


def _look_at_table(
    rows: Sequence[Sequence[str]], decimal: str, *, has_labels: bool = False
) -> _TableShape | None:
    """Header and data in rows of fields; None if they contain no table of numbers."""
    rows = _without_texts(rows)
    counted = _without_labels(rows, decimal) if has_labels else rows
    counts = [sum(_is_number(text, decimal) or _is_time(text) for text in row) for row in counted]
    data = [
        len(row) > 1 and 2 * count >= sum(map(bool, row)) > 0
        for row, count in zip(counted, counts, strict=True)
    ]
    sizes = Counter(len(row) for row, is_data in zip(rows, data, strict=True) if is_data)
    if not sizes:
        return None
    n_fields = sizes.most_common(1)[0][0]
    data = [is_data and len(row) == n_fields for row, is_data in zip(rows, data, strict=True)]
    usual = np.median([count for count, is_data in zip(counts, data, strict=True) if is_data])
    # a preamble line with a number in it has fewer numbers than a row of the table
    good = [is_data and 2 * count > usual for count, is_data in zip(counts, data, strict=True)]
    run = max(2, min(_RUN, sum(good)))
    # not those of an author's own numbers, which stand beside a few rows of a log, without a name
    numbers = [[*map(bool, row)] for row, is_data in zip(rows, data, strict=True) if is_data]
    filled = np.mean(numbers, axis=0) > _FILLED
    is_named = filled if filled.any() else np.ones(n_fields, np.bool_)
    start = _first_row(rows, good, run, is_named)
    if start is None:
        return None
    above = [i for i in range(start) if any(rows[i])]
    name_row, unit_row = None, None
    if above and _is_header(rows[above[-1]], is_named):
        name_row = above[-1]
        if (
            len(above) > 1
            and _is_unit_row(rows[name_row])
            and _is_header(rows[above[-2]], is_named)
        ):
            name_row, unit_row = above[-2], name_row
    names = rows[name_row] if name_row is not None else ()
    units = rows[unit_row] if unit_row is not None else _labelled_units(rows[:start])
    pad = ("",) * n_fields
    return _TableShape(
        start=start,
        n_fields=n_fields,
        name_row=name_row,
        unit_row=unit_row,
        names=(*names, *pad)[:n_fields],
        units=(*units, *pad)[:n_fields],
        rows=tuple(
            tuple(row)
            for row, is_data in zip(rows[start : start + _ROWS], data[start:], strict=False)
            if is_data
        ),
        above=tuple(" ".join(filter(None, rows[i])) for i in above if i != name_row)[:_HEADER],
    )


def _first_row(
    rows: Sequence[Sequence[str]], good: Sequence[bool], run: int, is_named: Bools
) -> int | None:
    """First row of the table: below the results of the test, which are a short table above it.

    A spreadsheet that saves a log gives both as many fields.
    """
    starts: list[int] = []
    sizes: list[int] = []
    headed = False
    for row, is_good in enumerate(good):
        if is_good and (headed or not starts) and sum(good[row : row + run]) == run:
            starts.append(row)
            sizes.append(0)
        if is_good and starts:
            sizes[-1] += 1
        headed = not is_good and any(rows[row]) and _is_header(rows[row], is_named)
    long = [
        start for start, size in zip(starts, sizes, strict=True) if size > max(sizes) / _PART_OF
    ]
    return long[0] if long else None


def _without_texts(rows: Sequence[Sequence[str]]) -> Sequence[Sequence[str]]:
    """Rows without the texts that a logger writes into a last column of some of them."""
    head = next((i for i, row in enumerate(rows) if without_comment_name(row) != list(row)), None)
    if head is None:
        return rows
    n_names = len(rows[head])
    below = [row[:-1] if len(row) == n_names and row[-1] else row for row in rows[head + 1 :]]
    return [*rows[: head + 1], *below]


def _without_labels(rows: Sequence[Sequence[str]], decimal: str) -> Sequence[Sequence[str]]:
    """Rows without the texts of columns that are numbers in less than half of them."""
    n_fields = Counter(map(len, rows)).most_common(1)[0][0]
    whole = [row for row in rows if len(row) == n_fields]
    kept = [
        2 * sum(_is_number(text, decimal) or _is_time(text) for text in column) >= len(whole)
        for column in zip(*whole, strict=True)
    ]
    return [
        [text if keep else "" for text, keep in zip(row, kept, strict=True)]
        if len(row) == n_fields
        else row
        for row in rows
    ]


def _labelled_units(above: Sequence[Sequence[str]]) -> Sequence[str]:
    """Units in a preamble line that is labelled as units: ``Y_Unit_Label  mm  N``."""
    if any(UNSCALED.search(" ".join(fields)) for fields in above):
        return ()  # they are the units after a factor that the log only states
    for label, *units in filter(None, above):
        if re.search(r"unit|einheit", label.lower()) and _is_unit_row(units):
            return ["", *units]
    return ()


UNSCALED = re.compile(
    r"\bin (raw )?(volts|counts)\b|\bunits? ?/ ?(v|volts?|counts?)\b", re.IGNORECASE
)
"""A preamble line of a table of readings that still need a factor."""


def _is_header(fields: Sequence[str], is_named: Bools) -> bool:
    """Whether the fields can be names or units: of most columns, and of none beyond them."""
    beyond = without_comment_name(fields)[is_named.size :]
    names = np.zeros(is_named.size, np.bool_)
    names[: len(fields)] = [*map(bool, fields[: is_named.size])]
    return 1 < len(fields) and not any(beyond) and 2 * (names & is_named).sum() > is_named.sum()


def _is_unit_row(fields: Sequence[str]) -> bool:
    filled = [text.strip("()[] ") for text in fields if text.strip("()[] -")]
    known = sum(is_unit(text) for text in filled)
    return bool(filled) and 2 * known >= len(filled)


def _seen_columns(table: _TableShape, decimal: str, thousands: str = "") -> list[SeenColumn]:
    """Columns of a table with the values of its rows."""
    columns = []
    for place in range(table.n_fields):
        texts = tuple(row[place] for row in table.rows)
        plain = [text.replace(thousands, "") if thousands else text for text in texts]
        values = [
            float(text.replace(decimal, ".")) if _is_number(text, decimal) else math.nan
            for text in plain
        ]
        columns.append(
            SeenColumn(place + 1, table.names[place], table.units[place], np.array(values), texts)
        )
    if columns and not columns[-1].name and not any(columns[-1].texts):
        columns.pop()  # a delimiter at the end of each line
    return columns


_HEAD = 1 << 18

_TAIL = 1 << 14

_LINES = 20_000  # lines examined

_DELIMITERS = ("\t", ";", ",", "|", " ")

_COMMENTS = ("#", "%", "//", "!", "*")

_MTS = "MTS793|"

_LEAST_SHARE = (0.5, 0.8)  # minimum share of numeric fields; higher if blanks separate them

_THOUSANDS = {
    decimal: re.compile(
        rf"[+-]?[1-9]\d{{0,2}}(?P<mark>[{parted} '\u00a0\u202f\u2019])\d{{3}}"
        rf"(?:(?P=mark)\d{{3}})*(?:{re.escape(decimal)}\d*)?"
    )
    for decimal, parted in ((".", ","), (",", "."))
}

_MARKED = (
    (codecs.BOM_UTF8, "utf-8"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)


def _decode(path: Path, head: bytes) -> tuple[str, str, str]:
    """Text, encoding, and the confidence in that encoding."""
    for mark, encoding in _MARKED:
        if head.startswith(mark):
            text = head.decode(encoding, errors="ignore").removeprefix("\ufeff")
            return text, encoding, f"sure: encoding {encoding}, by the byte-order mark"
    if b"\0" in head:
        for place, encoding in ((1, "utf-16-le"), (0, "utf-16-be")):
            # digits and separators, which make up a table, have a zero byte beside them
            if 2 * head[place::2].count(0) > len(head) / 2 and not head[1 - place :: 2].count(0):
                text = head.decode(encoding, errors="ignore")
                return text, encoding, f"guess: encoding {encoding}, by its zero bytes"
        raise LogError(
            path, "the file is of no known format", found="binary content",
            needed="text, .xlsx, .xls, .ods, TDMS, MATLAB, HDF5, Parquet or JSON",
        )  # fmt: skip
    plain = _decoded(head, "utf-8")
    if plain is not None:
        return plain, "utf-8", "sure: encoding utf-8" + (" (plain ASCII)" if head.isascii() else "")
    read = {name: _decoded(head, name) for name in _ENCODINGS}
    texts = {name: text for name, text in read.items() if text is not None}
    words = {name: _n_foreign(text) for name, text in texts.items()}
    best = max(words, key=lambda name: words[name])
    if words[best]:
        return texts[best], best, f"guess: encoding {best}, because it gives words that logs use"
    return texts["latin-1"], "latin-1", "guess: encoding latin-1, because it is not UTF-8"


_ENCODINGS = ("latin-1", "cp1252", "gb18030", "cp932", "euc_kr", "big5", "cp1251", "cp1250")


def _decoded(head: bytes, encoding: str) -> str | None:
    """Text of the first bytes of a file; None if they are invalid in this encoding."""
    try:
        return codecs.getincrementaldecoder(encoding)().decode(head)
    except UnicodeDecodeError:
        return None


def _n_foreign(text: str) -> int:
    """Number of non-ASCII letters that occur in the words of logs."""
    found = FOREIGN_WORDS.findall("\n".join(text.split("\n", _HEADER)[:_HEADER]))
    return sum(not letter.isascii() for word in found for letter in word)


_HEADER = 200  # lines searched for the words of a header


def _split(lines: Sequence[str], delimiter: str) -> list[list[str]]:
    if delimiter == " ":
        return [re.split(r"[ \t]+", line.strip()) for line in lines]
    short = ("" if len(line) > csv.field_size_limit() else line for line in lines)
    return [
        [
            text.strip()
            for text in next(csv.reader([line], delimiter=delimiter, skipinitialspace=True), [])
        ]
        for line in short
    ]


def _comment(lines: Sequence[str]) -> str:
    """Comment mark at the start of the first non-empty line, if it is a usual one."""
    first = next((line for line in lines if line.strip()), "")
    return next((mark for mark in _COMMENTS if first.startswith(mark)), "")


def _without_comments(lines: Sequence[str], comment: str) -> list[str]:
    return ["" if comment and line.startswith(comment) else line for line in lines]


def _best_table(lines: Sequence[str]) -> tuple[str, str, _TableShape] | None:
    """Delimiter, decimal mark and table that turn the most fields into numbers."""
    # all delimiters are tried on the beginning of a long table only
    found = _best_of(lines[:_FEW_LINES], _DELIMITERS)
    if found is not None and 2 * len(found[2].rows) > _FEW_LINES:
        return _best_of(lines, found[:1])
    # a data base exports names of specimen, material and cycle in every row
    return _best_of(lines, _DELIMITERS) or _best_of(lines, _DELIMITERS[:-1], has_labels=True)


_FEW_LINES = 1000

_LABELLED = 50  # rows: fewer, with more texts than numbers, are a list of specimens


def _best_of(
    lines: Sequence[str], delimiters: Sequence[str], *, has_labels: bool = False
) -> tuple[str, str, _TableShape] | None:
    """The best table for the given delimiters."""
    best, best_score = None, (0.0, 0.0, 0.0)
    for delimiter in delimiters:
        rows = _split(lines, delimiter)
        for decimal in ".,":
            is_apart = decimal != delimiter or any('"' in line for line in lines[-_RUN:])
            table = _look_at_table(rows, decimal, has_labels=has_labels) if is_apart else None
            if table is None or (has_labels and len(table.rows) < _LABELLED):
                continue
            counted = _without_labels(table.rows, decimal) if has_labels else table.rows
            # a date that a blank parts from its time is one field with it
            parted = delimiter == " "
            fields = [
                text
                for row in counted
                for text in row
                if text and not (parted and _DATE.fullmatch(text))
            ]
            if has_labels and len(fields) < 2 * len(counted):
                continue
            numbers = sum(_is_number(text, decimal) or _is_time(text) for text in fields)
            share = numbers / max(len(fields), 1)
            score = round(share, 2), round(math.log(max(numbers, 1)), 1), share
            if score > best_score and score[0] > _LEAST_SHARE[delimiter == " "]:
                best, best_score = (delimiter, decimal, table), score
    return best


_NAMED_MARK = {"\u00a0": "a no-break space", "\u202f": "a narrow no-break space"}


def _number_settings(
    table: _TableShape, delimiter: str, decimal: str
) -> tuple[dict[str, object], list[str]]:
    """Thousands mark and missing marks, and the confidence in the decimal mark."""
    fields = [text for row in table.rows for text in row if text]
    remarks = []
    marked = [text for text in fields if decimal in text and _is_number(text, decimal)]
    if not marked:
        remarks.append(f"guess: decimal mark '{decimal}', because no number has one")
    elif decimal == "," and all(re.fullmatch(r"[+-]?\d{1,3},\d{3}", text) for text in marked):
        remarks.append("guess: decimal mark ',': every number could also have it for thousands")
    else:
        remarks.append(f"sure: decimal mark '{decimal}'")
    settings: dict[str, object] = {}
    odd: list[str] = []
    found: Counter[str] = Counter()
    for place in range(table.n_fields):
        texts = [row[place] for row in table.rows if row[place]]
        strange = [text for text in texts if not _is_number(text, decimal)]
        parted = [one["mark"] for one in map(_THOUSANDS[decimal].fullmatch, strange) if one]
        if 2 * (len(strange) - len(parted)) < len(texts):
            odd += strange
            found.update(parted)
    if found:
        mark = found.most_common(1)[0][0]
        settings["thousands"] = mark
        remarks.append(f"guess: thousands mark {_NAMED_MARK.get(mark, repr(mark))}")
    marks = list(dict.fromkeys(text for text in odd if not _THOUSANDS[decimal].fullmatch(text)))
    marks = [mark for mark in marks if mark not in ("NaN", "nan")]
    if marks:
        settings["missing"] = ["", "NaN", "nan", *marks]
        shown = ", ".join(repr(mark) for mark in marks)
        remarks.append(f"guess: {shown} stands for a missing value")
    if not any(row[-1] for row in table.rows) and not table.names[-1]:
        remarks.append(f"sure: each row ends with a delimiter {delimiter!r}")
    return settings, remarks


def _number_rows(
    lines: Sequence[str], table: _TableShape, delimiter: str, decimal: str
) -> list[tuple[str, ...]]:
    """Rows at the end of a long log that have numbers alone: time may pass 1,000 there first."""

    def is_plain(text: str) -> bool:
        is_known = not text or _is_number(text, decimal) or _is_time(text)
        return is_known or _THOUSANDS[decimal].fullmatch(text) is not None

    rows = _split(lines, delimiter)
    return [tuple(row) for row in rows if len(row) == table.n_fields and all(map(is_plain, row))]


def _look_at_text(path: Path) -> _SeenTable:
    """Find the table in a text file from its first 256 kB, and thousands marks also in its end."""
    with path.open("rb") as stream:
        head = stream.read(_HEAD)
        is_whole = not stream.read(1)
        stream.seek(-min(_TAIL, stream.seek(0, 2)), 2)
        tail = stream.read()
    text, encoding, remark = _decode(path, head)
    lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    lines = (lines if is_whole else lines[:-1])[:_LINES]
    rows = memoryview("\n".join(lines).rstrip("\n").encode())
    lines = str(without_outer_quotes(rows, '"'), "utf-8").split("\n")
    comment = _comment(lines)
    found = _best_table(_without_comments(lines, comment))
    if found is None:
        raise LogError(
            path, "no table of numbers at the start of the file",
            found=f"{len(lines)} lines", needed="rows of two or more numbers",
        )  # fmt: skip
    delimiter, decimal, table = found
    settings: dict[str, object] = {"delimiter": delimiter, "decimal": decimal, "encoding": encoding}
    remarks = [remark, f"sure: delimiter {delimiter!r}, {table.n_fields} fields a row"]
    end = [] if is_whole else tail.decode(encoding, errors="ignore").splitlines()[1:]
    more, more_remarks = _number_settings(
        replace(table, rows=(*table.rows, *_number_rows(end, table, delimiter, decimal))),
        delimiter, decimal,
    )  # fmt: skip
    remarks += more_remarks
    columns = _seen_columns(table, decimal, str(more.get("thousands", "")))
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
        remarks.append(f"guess: column names are in row {table.name_row + 1}")
    if table.unit_row is not None:
        remarks.append(f"guess: units are in row {table.unit_row + 1}")
    is_blocks = "block_marker" in settings
    return _SeenTable(
        "blocks" if is_blocks else "delimited", columns, settings, tuple(remarks),
        preamble=tuple(filter(None, map(_tidy, lines[: table.start])))[:_HEADER],
        is_cut=not is_whole,
    )  # fmt: skip


def _tidy(line: str) -> str:
    """A preamble line without quotes and tabs, for display."""
    return " ".join(re.sub(r'["\t;]+', " ", line).strip(" ,").split())[:_LONGEST_LINE]


_LONGEST_LINE = 100


def _named_by_comment(
    above: Sequence[str], comment: str, delimiter: str, columns: list[SeenColumn]
) -> tuple[list[SeenColumn], list[str]]:
    """Names from the last comment line, if it has one per column."""
    last = next((line for line in reversed(above) if line.startswith(comment)), "")
    names = _split([last.removeprefix(comment)], delimiter)[0]
    if len(names) != len(columns) or not all(names):
        return columns, []
    named = [
        replace(column, name=name, is_named=False)
        for column, name in zip(columns, names, strict=True)
    ]
    return named, ["guess: the names of the columns stand in the last comment line"]


_LONGEST_NAME = 1000

_PART = 1 << 20  # rows loaded at a time

Candidate = tuple[dict[str, object], ColumnTable]
"""Layout settings and the table they read."""


def _table_sheets(path: Path, watch: Watch) -> list[tuple[str, _TableShape]]:
    """Sheets of a workbook that contain a table of at least two rows of numbers."""
    workbook = open_workbook(path, watch)
    found = []
    for place, name in enumerate(workbook.sheet_names):
        table = _look_at_table(read_rows(path, workbook, place, _ROWS), ".")
        if table is not None:
            found.append((name, table))
    return found


def _look_at_sheet(path: Path, sheet: str | None, watch: Watch) -> _SeenTable:
    """One sheet of a workbook, or the sheet with the longest table."""
    found = _table_sheets(path, watch)
    chosen = [entry for entry in found if sheet in (None, entry[0])]
    if not chosen:
        raise LogError(
            path, "no sheet holds a table of numbers",
            found=", ".join(repr(name) for name, _ in found) or "no such sheet",
            needed=repr(sheet) if sheet else "rows of two or more numbers",
        )  # fmt: skip
    name, table = max(chosen, key=lambda entry: len(entry[1].rows))
    remarks = [f"guess: the log is on sheet '{name}'"] if sheet is None else []
    if sheet is None and len(found) > 1:
        others = ", ".join(repr(other) for other, _ in found if other != name)
        remarks.append(f"sure: there are also tables on {others}")
    settings: dict[str, object] = {"sheet": name}
    top = table.start if table.name_row is None else table.name_row
    if top:
        settings["preamble_rows"] = top
        remarks.append(f"sure: the table begins below row {top}")
    settings["has_name_row"] = table.name_row is not None
    settings["has_unit_row"] = table.unit_row is not None
    return _SeenTable(
        "spreadsheet", _seen_columns(table, "."), settings, tuple(remarks), preamble=table.above
    )


def _seen(table: ColumnTable) -> list[SeenColumn]:
    """Numeric columns of the most common length."""
    columns, sizes = [], []
    for place, (name, unit) in enumerate(zip(table.names, table.units, strict=True)):
        if len(name) > _LONGEST_NAME:  # no layout would write it
            continue
        try:
            parts = table.load(place, _ROWS if table.sizes else _PART)
            values = next(parts)
            size = values.size
            # where the file states the length, the rest is not read
            size = table.sizes[place] if table.sizes else size + sum(part.size for part in parts)
        except LogError:  # not a series: no column
            continue
        if values.ndim == 1 and size > 1 and values.dtype.kind in "fiu":
            first = values[:_ROWS].astype(np.float64)
            columns.append(SeenColumn(place + 1, name, unit, first, is_named=bool(name)))
            sizes.append(size)
    if not sizes:
        return []
    length = Counter(sizes).most_common(1)[0][0]
    return [column for column, size in zip(columns, sizes, strict=True) if size == length]


def _named_matrix(
    path: Path, key: str, matrix: Any, texts: Mapping[str, Sequence[str]], group: str = ""
) -> tuple[dict[str, object], ColumnTable]:
    """A matrix and the text lists beside it that may be its names and units."""
    settings: dict[str, object] = {"group": group} if group else {}
    settings["matrix"] = key
    given: dict[str, tuple[str, ...]] = {}
    for name, entries in texts.items():
        if matrix.ndim == 2 and len(entries) == matrix.shape[0 if is_wide(matrix) else 1]:
            filled = [text for text in entries if text]
            kind = "units" if 2 * sum(map(is_unit, filled)) >= len(filled) else "names"
            if kind not in given:
                given[kind] = tuple(entries)
                settings[f"matrix_{kind}"] = name
    return settings, matrix_table(
        path, matrix, where=key, names=given.get("names"), units=given.get("units")
    )


def _is_matrix(values: Any) -> bool:
    return bool(values.dtype.names and values.size > 1) or (
        values.ndim == 2 and min(values.shape) > 1 and values.dtype.kind in "fiu"
    )


def _hdf5_candidates(path: Path, file: h5py.File, watch: Watch) -> Iterator[Candidate]:
    """Groups and matrices of a file; a group with two paths is examined once."""
    waiting: deque[h5py.Group] = deque([file])
    seen = set()
    while waiting:
        watch.check_time()
        group = waiting.popleft()
        address = h5py.h5o.get_info(group.id).addr
        if address in seen:
            continue
        seen.add(address)
        place = (group.name or "").strip("/")
        settings = {"group": place} if place else {}
        yield settings, group_table(path, group, watch)
        texts, matrices = {}, {}
        for name in group:
            if not isinstance(group.get(name, getlink=True), h5py.HardLink):
                continue
            member = group[name]
            if isinstance(member, h5py.Group):
                waiting.append(member)
                continue
            try:
                values = data_set(path, member, watch)
                if _is_matrix(values):
                    matrices[name] = values
                elif values.dtype.kind in "OSUT":
                    texts[name] = read_texts(path, member, watch)
            except LogError:  # neither a matrix nor texts
                continue
        for name, values in matrices.items():
            yield _named_matrix(path, name, values, texts, place)


def _matlab_candidates(
    path: Path, scope: Mapping[str, Any], group: str, seen: set[int], watch: Watch
) -> Iterator[Candidate]:
    watch.check_time()
    yield (
        {"group": group} if group else {},
        matlab_table(path, scope, Layout(format="matlab", channels={})),
    )
    texts, matrices = {}, {}
    for name in scope:
        try:
            value = scope[name]
            fields = struct_fields(value)
            if fields is not None:
                inside = f"{group}.{name}".strip(".")
                place = struct_place(fields)
                if place not in seen:  # a struct of version 7.3 may hold itself
                    seen |= set() if place is None else {place}
                    yield from _matlab_candidates(path, fields, inside, seen, watch)
            elif isinstance(value, np.ndarray) and _is_matrix(value) and not value.dtype.names:
                matrices[name] = value
            else:
                texts[name] = read_cell_texts(path, name, value)
        except LogError:  # neither a struct, a matrix nor texts
            continue
    for name, values in matrices.items():
        yield _named_matrix(path, name, values, texts, group)


def _tdms_candidates(path: Path, file: Any, watch: Watch) -> Iterator[Candidate]:
    groups = file.groups()
    for group in groups:
        settings = {"group": group.name} if len(groups) > 1 else {}
        yield settings, tdms_table(path, file, group, watch)


def _look_at_binary(path: Path, kind: Format, watch: Watch) -> _SeenTable:
    """The largest table of a TDMS, MATLAB, HDF5 or Parquet file."""
    with ExitStack() as stack:
        candidates: Iterator[Candidate]
        if kind == "tdms":
            file = stack.enter_context(open_tdms(path))
            candidates = _tdms_candidates(path, file, watch)
        elif kind == "hdf5":
            hdf5 = stack.enter_context(open_hdf5(path))
            candidates = _hdf5_candidates(path, hdf5, watch)
        elif kind == "matlab":
            variables = stack.enter_context(open_matlab(path, watch))
            candidates = _matlab_candidates(path, variables, "", set(), watch)
        else:
            parquet = stack.enter_context(open_parquet(path))
            candidates = iter([({}, parquet_table(path, parquet, watch))])
        best: tuple[dict[str, object], list[SeenColumn]] = ({}, [])
        count, is_turned = 0, False
        for settings, table in candidates:
            columns = _seen(table)
            count += len(columns) > 1
            if sum(c.values.size for c in columns) > sum(c.values.size for c in best[1]):
                best, is_turned = (settings, columns), table.is_turned
        settings, columns = best
        if kind == "tdms" and columns:
            columns = columns + _waveform(file, settings, columns)
    remarks = [f"sure: {len(columns)} columns of numbers of one length"]
    if is_turned:
        remarks.append("guess: the rows of the matrix are the columns, because it has fewer rows")
    if count > 1:
        remarks.append(f"guess: the largest of {count} tables of the file is the log")
    return _SeenTable(kind, columns, settings, tuple(remarks))


def _waveform(
    file: Any, settings: Mapping[str, object], columns: list[SeenColumn]
) -> list[SeenColumn]:
    """Time from the waveform properties, as an extra column if the channels have them."""
    group = file[settings["group"]] if "group" in settings else file.groups()[0]
    if all(channel.properties.get(WAVEFORM_COLUMN, 0) for channel in group.channels()):
        return [SeenColumn(len(columns) + 1, WAVEFORM_COLUMN, "s", np.arange(2.0))]
    return []


def _look_at_json(path: Path, watch: Watch) -> _SeenTable:
    """The largest table of a JSON file, at any level."""
    _, content = json_content(path, watch)
    best: tuple[int, str, Any] | None = None
    waiting: deque[tuple[tuple[str, ...], Any]] = deque([((), content)])
    while waiting:
        keys, value = waiting.popleft()
        size = _n_values(value)
        if size and (best is None or size > best[0]) and not any("." in key for key in keys[1:]):
            best = size, ".".join(keys), value
        if isinstance(value, dict) and len(keys) < _DEEPEST:
            waiting += [((*keys, key), entry) for key, entry in value.items()]
    if best is None:
        raise LogError(
            path, "no key holds a matrix of numbers",
            found=", ".join(map(repr, content)) if isinstance(content, dict) else "a list",
            needed="a list of rows, of records, or an object of columns",
        )  # fmt: skip
    _, place, rows = best
    texts = {
        key: value
        for key, value in (content.items() if isinstance(content, dict) else ())
        if isinstance(value, list) and value and all(isinstance(entry, str) for entry in value)
    }
    settings: dict[str, object] = {"matrix": place} if place else {}
    if isinstance(rows, dict):
        settings = {"group": place} if place else {}
        columns = _columns_of(rows)
        remark = "sure: the columns are in an object"
    elif isinstance(rows[0], dict):
        names = list(dict.fromkeys(key for row in rows[:_ROWS] for key in row))
        columns = _columns_of({name: [row.get(name) for row in rows[:_ROWS]] for name in names})
        remark = "sure: the rows are records"
    else:
        shown = [row for row in rows[:_ROWS] if isinstance(row, list) and len(row) == len(rows[0])]
        matrix = np.array([[_value(x) for x in row] for row in shown], dtype=np.float64)
        settings, table = _named_matrix(path, place, matrix, texts)
        settings = {key: value for key, value in settings.items() if value}
        columns = _seen(table)
        remark = f"sure: '{place}' is a matrix of {len(table.names)} columns"
        if table.is_turned:
            remark += " (its rows, because it has fewer rows)"
    stated = {
        name: value
        for name, value in (content.items() if isinstance(content, dict) else ())
        if isinstance(value, str) and is_unit(value)
    }
    of_time = [value for name, value in stated.items() if "time" in name.lower()]
    if columns and len(of_time) == 1 and not columns[0].name:
        columns[0] = replace(columns[0], unit=of_time[0])
    remarks = [f"{remark}{f' at {place!r}' if place else ''}"]
    remarks += [
        f"sure: the file states {name!r} as {value!r}; give it as unit_key of its channel"
        for name, value in stated.items()
    ]
    return _SeenTable("json", columns, settings, tuple(remarks))


_DEEPEST = 8  # maximum depth of keys above a table


def _n_values(value: Any) -> int:
    """Number of values in a JSON table (matrix, records or columns); 0 for anything else."""
    if isinstance(value, dict):
        lists = [entry for entry in value.values() if _is_list_of(entry, (int, float))]
        n_rows, n_columns = Counter(map(len, lists)).most_common(1)[0] if lists else (0, 0)
        return n_rows * n_columns if n_rows > 1 and n_columns > 1 else 0
    if _is_list_of(value, list):
        return sum(isinstance(entry, (int, float)) for entry in value[0]) * len(value)
    if _is_list_of(value, dict):
        n_columns = sum(isinstance(entry, (int, float)) for entry in value[0].values())
        return n_columns * len(value) if n_columns > 1 else 0
    return 0


def _is_list_of(value: Any, kind: type | tuple[type, ...]) -> bool:
    return isinstance(value, list) and bool(value) and isinstance(value[0], kind)


def _value(entry: Any) -> float:
    return float(entry) if isinstance(entry, (int, float)) else math.nan


def _columns_of(columns: Mapping[str, Any]) -> list[SeenColumn]:
    """Lists of numbers that have the most common length."""
    lists = {key: entry for key, entry in columns.items() if isinstance(entry, list)}
    length = Counter(map(len, lists.values())).most_common(1)[0][0]
    seen: list[SeenColumn] = []
    for key, entry in lists.items():
        values = np.array([_value(x) for x in entry[:_ROWS]])
        if len(entry) == length and len(key) <= _LONGEST_NAME and np.isfinite(values).any():
            seen.append(SeenColumn(len(seen) + 1, key, "", values))
    return seen


_LIMITS = Limits(time=60.0)

_MAGIC: tuple[tuple[bytes, Format], ...] = (
    (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", "spreadsheet"),
    (b"TDSm", "tdms"),
    (b"PAR1", "parquet"),
    (b"MATLAB", "matlab"),
    (b"\x89HDF\r\n\x1a\n", "hdf5"),
)


@dataclass(frozen=True)
class SniffedLayout:
    """Proposed layout of a log.

    Parameters
    ----------
    toml : str
        ``[layouts.NAME]`` for campaign.toml.
    remarks : tuple of str
        Reasons; each begins with ``sure:``, ``guess:`` or ``unknown:``.
    keys : tuple of str
        Channels found.
    preamble : tuple of str
        Lines above the table.
    kind : str
        Kind of the test, if the position shows one that does not cycle.
    """

    toml: str
    remarks: tuple[str, ...]
    keys: tuple[str, ...]
    preamble: tuple[str, ...] = ()
    kind: str = ""

    @property
    def settings(self) -> str:
        """Layout settings of the log format: equal for logs of the same form.

        Comments and values that depend on the start of each log are left out.
        """
        lines = [line.split("  # ")[0] for line in self.toml.split("\n") if line[:1] != "#"]
        return re.sub(r", (sign|datum|reference_length|zero) = .*?(?=,| \})", "", "\n".join(lines))


def format_of(path: Path) -> Format:
    """Format of a file from its first bytes; text that is not JSON is ``delimited``."""
    try:
        with path.open("rb") as stream:
            head = stream.read(16)
    except OSError as error:
        raise unreadable(path, error) from error
    for magic, name in _MAGIC:
        if head.startswith(magic):
            return name
    if zipfile.is_zipfile(path):
        return "spreadsheet"
    # a bracket opens JSON or a preamble section such as [Header]
    text = head.removeprefix(b"\xef\xbb\xbf").lstrip()
    return "json" if re.match(rb"\{|\[\s*[\[{\"\d-]", text) else "delimited"


def _look(path: Path, sheet: str | None, watch: Watch) -> _SeenTable:
    kind = format_of(path)
    if kind == "spreadsheet":
        return bounded(_look_at_sheet, path, sheet, watch=watch)
    if kind == "json":
        return _look_at_json(path, watch)
    if kind != "delimited":
        return bounded(_look_at_binary, path, kind, watch=watch)
    text = _look_at_text(path)
    return text


def sheets_with_tables(path: Path) -> dict[str, int]:
    """Sheets of a workbook that contain a table of numbers, and its rows as far as it is seen."""
    found = bounded(_table_sheets, path, watch=Watch(path, _LIMITS))
    return {name: len(table.rows) for name, table in found}


_RATES = re.compile(
    r"sampl|scan|\bHz\b|messrate|abtast|échantillon|muestreo|campion|bemonster|дискретизац|"
    r"采样|サンプリング|샘플|delta_x",
    re.IGNORECASE,
)
"""Preamble words that state the time between rows."""

_OWN_NUMBER = re.compile(r"(?<![A-Za-z_])\d")  # and not a channel: AI0

_MOST_SAID = 3


def sniff_layout(path: Path, *, name: str = "log", sheet: str | None = None) -> SniffedLayout:
    """Propose a layout for a log."""
    watch = Watch(path, _LIMITS)
    with unchanged(path) as n_bytes:
        watch.check_size(n_bytes)
        check_not_empty(path, n_bytes)
        seen = _look(path, sheet, watch)
    if not seen.columns:
        raise LogError(
            path, "no columns of numbers are found", needed="a log",
            hint=OF_MATLAB_ALONE if seen.format == "matlab" else None,
        )  # fmt: skip
    proposal = propose_channels_table(seen.columns)
    lines = [f"[layouts.{name}]", f'format = "{seen.format}"']
    lines += [f"{key} = {toml_text(value)}" for key, value in seen.settings.items()]
    remarks = [*seen.remarks, *proposal.remarks]
    if "time" not in proposal.keys:
        lines.append(f'sample_interval = "{UNKNOWN}"  # or a time channel below')
        remarks.append("unknown: the time between rows, because no column looks like time")
        said = [line for line in seen.preamble if _RATES.search(line) and _OWN_NUMBER.search(line)]
        remarks += [f"unknown: the log says about it: {line}" for line in said[:_MOST_SAID]]
    lines += [f"[layouts.{name}.channels]", *proposal.lines, ""]
    # what follows the first rows may be another kind of test
    is_whole = not seen.is_cut and seen.columns[0].values.size < _NEARLY * _ROWS
    kind = proposal.kind if is_whole else ""
    return SniffedLayout("\n".join(lines), tuple(remarks), proposal.keys, seen.preamble, kind)


def unknown_layout() -> SniffedLayout:
    """Propose a layout for a file without a recognised table: every line is a question."""
    proposal = propose_channels_table([])
    lines = ["[layouts.log]", f'format = "{UNKNOWN}"', "[layouts.log.channels]", *proposal.lines]
    remark = "unknown: no table of numbers was found; docs/layouts.md lists the formats"
    return SniffedLayout("\n".join([*lines, ""]), (remark,), ())
