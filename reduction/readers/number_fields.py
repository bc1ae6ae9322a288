"""Converts text fields to numbers, in parts for a long log."""

from __future__ import annotations

import re
from codecs import BOM_UTF8
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.csv as pa_csv

from reduction.quantities.units import Dimension, scale_to_si
from reduction.readers.columns import (
    DeclaredColumn,
    clock_to_seconds,
    plain_date,
    without_marks,
)
from reduction.readers.layout import CLOCK, Layout
from reduction.readers.text_rows import TextRows, count_lines, split_line
from reduction.record.errors import LogError, ReductionError, SettingsError
from reduction.record.measurement import Floats, Integers
from reduction.record.plain_text import cut
from reduction.record.samples import BLOCK, ColumnWriter

_BLOCK = 1 << 20  # bytes per block of the parser, at least one line


@dataclass(frozen=True)
class Fields:
    """Declared columns of delimited rows.

    Parameters
    ----------
    numbers : dict of str to list of ndarray
        Pieces by channel key, in the file's unit, in order; declared missing marks are NaN.
    clock : dict of str to list of str
        Text of the clock channels.
    n_rows : int
        Data rows.
    row : ndarray of int, shape (n_rows,), optional
        Editor's row of each data row if they are not consecutive lines.
    """

    numbers: dict[str, list[Floats]]
    clock: dict[str, list[str]]
    n_rows: int
    row: Integers | None


def read_fields(
    rows: TextRows, wanted: Sequence[tuple[DeclaredColumn, int]], n_fields: int
) -> Fields:
    """Declared columns of delimited rows: numbers, and the text of a clock."""
    try:
        return _read(rows, wanted, n_fields)
    except LogError as error:
        if error.row is not None:  # faults further up are reported first
            read_fields(rows.above(error.row), wanted, n_fields)
        raise


def _read(rows: TextRows, wanted: Sequence[tuple[DeclaredColumn, int]], n_fields: int) -> Fields:
    layout = rows.layout
    places = [place for _, place in wanted]
    clocks = [place for want, place in wanted if want.unit == CLOCK]
    has_thousands = _has_thousands(rows)
    if n_fields == 1 or has_thousands:  # a blank line would be a field, or lack one
        rows = _blank_to_empty(rows)
    table = None
    if not has_thousands:
        try:
            table = _parse(rows, n_fields, places, clocks)
        except pa.ArrowInvalid:
            rows = _blank_to_empty(rows)
    if not rows.text:
        return Fields({want.key: [] for want, _ in wanted}, {}, 0, None)
    if table is None:
        table = _parse_as_text(rows, n_fields, places)
    row = rows.rows(table.num_rows)
    numbers: dict[str, list[Floats]] = {}
    clock: dict[str, list[str]] = {}
    for want, place in wanted:
        column = table.column(str(place))
        if want.unit == CLOCK:
            order = layout.channels[want.key].date_order
            clock[want.key] = [plain_date(field.strip(), order) for field in column.to_pylist()]
            continue
        pieces = _numbers(column)
        if pieces is None:
            if not pa.types.is_string(column.type):
                column = _parse_as_text(rows, n_fields, [place]).column(str(place))
            pieces = [_second_look(rows, row, want, column)]
        numbers[want.key] = [without_marks(piece, layout) for piece in pieces]
    return Fields(numbers, clock, table.num_rows, row)


def _numbers(column: pa.ChunkedArray) -> list[Floats] | None:
    """Numbers of a parsed column in pieces, or None if it has to be examined as text."""
    if pa.types.is_string(column.type):
        return None
    pieces = []
    for chunk in column.chunks:
        piece = chunk.to_numpy(zero_copy_only=False)
        # arrow reads the words nan and inf as numbers, which are not allowed in a log
        if np.count_nonzero(np.isfinite(piece)) != len(chunk) - chunk.null_count:
            return None
        pieces.append(piece)
    return pieces


def _has_thousands(rows: TextRows) -> bool:
    layout = rows.layout
    mark = (layout.quote if layout.thousands == layout.delimiter else layout.thousands).encode()
    return bool(mark) and re.search(re.escape(mark), rows.text) is not None


def _parse(
    rows: TextRows, n_fields: int, places: Sequence[int], as_text: Sequence[int]
) -> pa.Table:
    layout = rows.layout
    names = [str(place) for place in range(n_fields)]
    types = {str(place): pa.string() if place in as_text else pa.float64() for place in set(places)}
    # a byte-order mark here is data, which arrow would drop at the start; a blank line is no row
    is_marked = bytes(rows.text[: len(BOM_UTF8)]) == BOM_UTF8
    return pa_csv.read_csv(
        pa.py_buffer(b"\n" + bytes(rows.text) if is_marked else rows.text),
        read_options=pa_csv.ReadOptions(
            column_names=names, block_size=max(_BLOCK, rows.longest_line + 2)
        ),
        parse_options=pa_csv.ParseOptions(
            delimiter=layout.delimiter, quote_char=layout.quote or False
        ),
        convert_options=pa_csv.ConvertOptions(
            include_columns=list(types),
            column_types=types,
            null_values=list(layout.missing),
            strings_can_be_null=False,
            decimal_point=layout.decimal,
        ),
        memory_pool=pa.system_memory_pool(),  # the others clear huge pages, which is slow
    )


def _parse_as_text(rows: TextRows, n_fields: int, places: Sequence[int]) -> pa.Table:
    try:
        return _parse(rows, n_fields, places, places)
    except pa.ArrowInvalid as error:
        raise _ragged(rows, n_fields, str(error)) from error


def _blank_to_empty(rows: TextRows) -> TextRows:
    """Lines of only blanks emptied, so that they are not rows; line numbers are kept."""
    blank = rb"(?m)^[ \t]+(?=\r?$)" if rows.layout.delimiter != "\t" else rb"(?m)^ +(?=\r?$)"
    text = re.sub(blank, b"", rows.text)
    filled = text.rstrip(b"\r\n")
    is_open = rows.is_open and filled == text
    return replace(rows, text=memoryview(filled), is_open=is_open, n_lines=None)


def _ragged(rows: TextRows, n_fields: int, message: str) -> LogError:
    """Error for the first row with another number of fields or an unclosed quote."""
    n_lines = count_lines(rows.text)
    for line, text in enumerate(rows.lines()):
        if error := rows.unclosed(line, text):
            return error
        found = len(split_line(text, rows.layout))
        if text.strip("\r") and found != n_fields:
            is_cut_off = rows.is_open and line == n_lines - 1
            hint = "The log was cut off; remove its last line." if is_cut_off else None
            first = text.partition(rows.layout.delimiter)[0].strip(' \t\r"')
            if first[:1].isalpha():
                hint = _table_ends_at(first)
            return LogError(
                rows.path,
                f"a row has {found} fields where the first has {n_fields}",
                row=rows.row_of_line(line),
                found=repr(text.strip()[:60]),
                needed=f"{n_fields} fields",
                hint=hint,
            )
    return rows.not_told_apart(message)


def _second_look(
    rows: TextRows, row: Integers | None, want: DeclaredColumn, column: pa.ChunkedArray
) -> Floats:
    """Numbers of a text column, or a `LogError` for its first bad field."""
    layout = rows.layout
    trimmed = pc.utf8_trim_whitespace(column)
    is_missing = pc.is_in(trimmed, value_set=pa.array(layout.missing, pa.string()))
    point, mark = re.escape(layout.decimal), re.escape(layout.thousands)
    # a group follows one to three digits that do not start with 0: 0,244 is a decimal comma
    whole = rf"\d+|[1-9]\d{{0,2}}(?:{mark}\d{{3}})+" if mark else r"\d+"
    number = rf"^[+-]?(?:(?:{whole})(?:{point}\d*)?|{point}\d+)(?:[eE][+-]?\d+)?$"
    is_number = pc.match_substring_regex(trimmed, number)
    bad = pc.index(pc.or_(is_missing, is_number), False).as_py()
    if bad < 0:
        plain = pc.replace_substring(trimmed, layout.thousands, "") if mark else trimmed
        plain = pc.replace_substring(plain, layout.decimal, ".")
        values = pc.if_else(is_missing, None, plain).cast(pa.float64()).to_numpy()
        infinite = np.flatnonzero(np.isinf(values))
        if not infinite.size:
            return np.asarray(values, dtype=np.float64)
        bad = int(infinite[0])
    found = trimmed[bad].as_py()
    sample = f"12{layout.decimal}5"
    at = rows.row_of_line(bad) if row is None else int(row[bad])
    raise LogError(
        rows.path,
        "a value is not a number",
        row=at,
        channel=str(want.column),
        found=repr(cut(found, 60)) if found else "an empty field",
        needed=f"a decimal number such as {sample} in {want.unit}, or a declared missing mark",
        hint=_what_to_set(found, want, layout),
    )


_DATE = re.compile(r"\d{1,4}[-./]\d{1,2}[-./]\d{1,4}([ T]|$)|\d{1,2}:\d{2}")

_COMMA = re.compile(r"[+-]?\d*,\d+([eE][+-]?\d+)?")

_GROUPS = {
    ",": re.compile(r"[+-]?[1-9]\d{0,2}(,\d{3})+(\.\d*)?"),
    ".": re.compile(r"[+-]?[1-9]\d{0,2}(\.\d{3})+(,\d*)?"),
}


_BY_BLANKS = re.compile(
    r"[+-]?[1-9]\d{0,2}(?P<mark>[ '\u00a0\u202f\u2019])\d{3}(?:(?P=mark)\d{3})*(?:[.,]\d*)?"
)


def _is_unit(text: str, dimension: Dimension) -> bool:
    """Whether a field is a unit that its column could have."""
    try:
        scale_to_si(text.strip("()[] "), dimension)
    except SettingsError:
        return False
    return bool(text.strip()) and not any(one.isdigit() for one in text)


def _what_to_set(found: str, want: DeclaredColumn, layout: Layout) -> str:
    """Layout setting that would make a non-numeric field valid."""
    parted = "," if layout.decimal == "." else "."
    is_parted = not layout.thousands and _GROUPS[parted].fullmatch(found) is not None
    has_comma = layout.decimal == "." and _COMMA.fullmatch(found) is not None
    if found.count(layout.decimal) > 1 and _GROUPS[layout.decimal].fullmatch(found):
        return (
            "It has two decimal marks: a program took that of the log for a mark between thousands,"
            " and wrote it elsewhere. No setting restores the number: export the log again."
        )
    if is_parted and has_comma:
        return 'Set thousands = "," if the comma separates groups, or decimal = "," if it does not.'
    if is_parted:
        return f'Set thousands = "{parted}" if it separates groups of three digits.'
    by_blanks = None if layout.thousands else _BY_BLANKS.fullmatch(found)
    if by_blanks:
        mark = by_blanks["mark"]
        written = mark if mark.isascii() else f"\\u{ord(mark):04x}"
        return f'Set thousands = "{written}" if it separates groups of three digits.'
    if has_comma:
        no_groups = ' and thousands = ""' if layout.thousands == "," else ""
        return f'Set decimal = ","{no_groups} if the comma is a decimal mark.'
    if want.key == "time" and _DATE.match(found):
        return (
            'Set unit = "clock" if it is a time of day (09:45:30); if it is a date, use another '
            "column for the time, or sample_interval."
        )
    if found == str(want.column).strip():
        return (
            "This row repeats the names: the logger wrote its header a second time, so it was"
            " restarted. Split the file into two logs, one from each header."
        )
    if layout.decimal == "," and re.fullmatch(r"[+-]?\d*\.\d+([eE][+-]?\d+)?", found):
        no_groups = ' and thousands = ""' if layout.thousands == "." else ""
        return f'Set decimal = "."{no_groups} if the point is a decimal mark.'
    if _is_unit(found, want.dimension):
        return (
            "Set has_unit_row = true if this is a row of units; preamble_rows = N skips rows "
            "above the names."
        )
    missing = "Add it to the missing marks of the layout if it means missing."
    if want.key == "time" and found[:1].isalpha():
        return f"{missing} {_table_ends_at(found)}"
    return missing


def _table_ends_at(text: str) -> str:
    """Advice for a line of words below the table."""
    return f'If the table ends above this line, set ends_at = "{cut(text, 30)}" in the layout.'


AT_A_TIME = 2
"""Number of parts whose numbers are read together. [1]."""

_WORKERS = 4


def in_order(
    workers: Executor, read: Callable[[TextRows], Fields], parts: Iterator[TextRows]
) -> Iterator[tuple[TextRows, Fields]]:
    """Parts with the results read from each, a few at a time."""
    waiting: deque[tuple[TextRows, Future[Fields]]] = deque()
    error: ReductionError | None = None
    is_done = False
    while waiting or not is_done:
        try:
            part = None if is_done else next(parts, None)
        except ReductionError as found:
            part, error = None, found
        is_done = part is None
        if part is not None:
            waiting.append((part, workers.submit(read, part)))
        while waiting and (is_done or len(waiting) >= AT_A_TIME):
            first, fields = waiting.popleft()
            yield first, fields.result()
    if error is not None:
        raise error


class GrowingLog:
    """Columns of a text log, in memory or, if a folder is given, in its scratch files.

    Parameters
    ----------
    wanted : sequence of Wanted
        The columns.
    folder : pathlib.Path or None
        Folder of the scratch files.  The text of a clock stays in memory.
    """

    def __init__(self, wanted: Sequence[DeclaredColumn], folder: Path | None) -> None:
        """Start with no rows."""
        self._wanted = wanted
        self._folder = folder
        self._columns = {want.key: ColumnWriter(folder) for want in wanted if want.unit != CLOCK}
        self._clock: dict[str, list[str]] = {want.key: [] for want in wanted if want.unit == CLOCK}
        self._row: ColumnWriter | None = None
        self.n_rows = 0
        self.first_row = 0

    def add(self, fields: Fields, first_row: int) -> None:
        """Append data rows; `first_row` is the editor's row of the first."""
        if not fields.n_rows:
            return
        row = fields.row
        first = first_row if row is None else int(row[0])
        last = first_row + fields.n_rows - 1 if row is None else int(row[-1])
        if not self.n_rows:
            self.first_row = first
        is_next = first == self.first_row + self.n_rows
        if self._row is None and not (is_next and last - first == fields.n_rows - 1):
            self._row = _counted(self._folder, self.first_row, self.n_rows)
        if self._row is not None:
            self._row.append(np.arange(first, last + 1) if row is None else row)
        with ThreadPoolExecutor(_WORKERS) as workers:  # first access to fresh memory is slow
            list(workers.map(self._append, fields.numbers, fields.numbers.values()))
        for key, texts in fields.clock.items():
            self._clock[key] += texts
        self.n_rows += fields.n_rows

    def finish(self, path: Path, layout: Layout) -> dict[str, Floats]:
        """All columns, shape (n_rows,); elapsed seconds for a clock."""
        self.row: Integers | None = None if self._row is None else self._row.finish()
        self.text = {key: tuple(texts) for key, texts in self._clock.items()}
        with ThreadPoolExecutor(_WORKERS) as workers:
            columns = dict(
                zip(
                    self._columns,
                    workers.map(ColumnWriter.finish, self._columns.values()),
                    strict=True,
                )
            )
        for want in self._wanted:
            if want.unit == CLOCK:
                columns[want.key] = clock_to_seconds(
                    path,
                    self.text[want.key],
                    channel=str(want.column),
                    missing=layout.missing,
                    row=self.row,
                    first_row=self.first_row,
                )
        return {want.key: columns[want.key] for want in self._wanted}

    def _append(self, key: str, pieces: Sequence[Floats]) -> None:
        for piece in pieces:
            self._columns[key].append(piece)


def _counted(folder: Path | None, first: int, size: int) -> ColumnWriter:
    """Row numbers so far, which were consecutive."""
    writer = ColumnWriter(folder, np.int64)
    for start in range(0, size, BLOCK):
        writer.append(np.arange(first + start, first + min(start + BLOCK, size)))
    return writer
