"""Fields of delimited text to numbers: quickly where all is well, exactly where it is not.

The fast look lets arrow parse whole columns.  Only where that fails are the fields read
as text, column by column, so that the first offending field can be named by its row.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pyarrow as pa  # type: ignore[import-untyped]
import pyarrow.compute as pc  # type: ignore[import-untyped]
import pyarrow.csv as pa_csv  # type: ignore[import-untyped]

from reduction.errors import LogError
from reduction.ingest.clock import clock_to_seconds
from reduction.ingest.columns import Wanted, without_marks
from reduction.ingest.layout import CLOCK, Layout
from reduction.record import Floats, Integers

__all__ = ["TextRows", "count_lines", "line_starts", "read_fields", "split_line"]

_PIECE = 1 << 17  # stays in the cache
_WORKERS = 4
_NEWLINE = 10


@dataclass(frozen=True)
class TextRows:
    """Data rows of a text file, in UTF-8, without header and comments.

    Parameters
    ----------
    path : pathlib.Path
        For messages.
    text : memoryview
        The bytes, without line ends after the last row.
    first_row : int
        Editor's row of the first line.
    line_row : ndarray of int, shape (n_lines,), optional
        Editor's row of each line where they are not consecutive.
    quote : str
        Quote character, or empty text.
    """

    path: Path
    text: memoryview
    first_row: int
    line_row: Integers | None = None
    quote: str = '"'

    def row_of_line(self, line: int) -> int:
        """Editor's row of a line counted from 0."""
        return self.first_row + line if self.line_row is None else int(self.line_row[line])

    def rows(self, n_rows: int) -> Integers | None:
        """Editor's row of each data row, or None where they are consecutive.

        Raises
        ------
        LogError
            If a quoted field goes over the end of its line.
        """
        n_lines = count_lines(self.text)
        if n_lines == n_rows:
            return self.line_row
        starts = line_starts(self.text)
        body = np.frombuffer(self.text, np.uint8)[starts]
        filled = np.flatnonzero((body != _NEWLINE) & (body != ord("\r")))
        if filled.size != n_rows:
            lines = bytes(self.text).split(b"\n")
            mark = self.quote.encode()
            odd = (line for line, text in enumerate(lines) if mark and text.count(mark) % 2)
            raise LogError(
                self.path,
                "a quoted field goes over the end of its line",
                row=self.row_of_line(next(odd, 0)),
                found=f"{filled.size} lines that make {n_rows} rows",
                needed="one line a row",
                hint="Close the quote, or declare another quote character in the layout.",
            )
        return filled + self.first_row if self.line_row is None else self.line_row[filled]


def count_lines(text: memoryview) -> int:
    """Number of lines; the last one needs no line end."""
    bytes_ = np.frombuffer(text, np.uint8)
    pieces = (bytes_[start : start + _PIECE] for start in range(0, bytes_.size, _PIECE))
    return int(sum(np.count_nonzero(piece == _NEWLINE) for piece in pieces)) + 1


def line_starts(text: memoryview) -> Integers:
    """Place of the first byte of each line, shape (n_lines,)."""
    return np.concatenate([[0], np.flatnonzero(np.frombuffer(text, np.uint8) == _NEWLINE) + 1])


def split_line(line: str, layout: Layout) -> list[str]:
    """Fields of one line, without quotes and the blanks around them."""
    reader = csv.reader(
        [line],
        delimiter=layout.delimiter,
        quotechar=layout.quote or None,
        quoting=csv.QUOTE_MINIMAL if layout.quote else csv.QUOTE_NONE,
    )
    try:
        fields = next(reader, [])
    except csv.Error:  # a field longer than the csv module takes
        fields = line.split(layout.delimiter)
    return [field.strip() for field in fields]


def read_fields(
    rows: TextRows, layout: Layout, wanted: Sequence[tuple[Wanted, int]], n_fields: int
) -> tuple[dict[str, Floats], dict[str, tuple[str, ...]], TextRows]:
    """Declared columns of delimited rows: numbers, and the text of a clock.

    Parameters
    ----------
    rows : TextRows
        What to parse.
    layout : Layout
        Separators and missing marks.
    wanted : sequence of (Wanted, int)
        Each column with its place from 0.
    n_fields : int
        Fields in a row.

    Returns
    -------
    columns : dict of str to ndarray, shape (n_rows,)
        In the file's unit; declared missing marks are NaN.
    text : dict of str to tuple of str
        Clock text.
    rows : TextRows
        What was parsed: lines of blanks alone are empty in it.

    Raises
    ------
    LogError
        Naming row and channel of the first field that is neither a number nor a
        declared missing mark, or the first row with another number of fields.
    """
    clocks = [place for want, place in wanted if want.unit == CLOCK]
    has_thousands = bool(layout.thousands) and (
        re.search(re.escape(layout.thousands.encode()), rows.text) is not None
    )
    columns: dict[str, Floats] = {}
    text: dict[str, tuple[str, ...]] = {}
    try:
        table = _parse(rows, layout, n_fields, [place for _, place in wanted], clocks)
    except pa.ArrowInvalid:
        table, rows = None, _blank_to_empty(rows, layout)
    if table is None or has_thousands:
        table = _parse_as_text(rows, layout, n_fields, [place for _, place in wanted])
    with ThreadPoolExecutor(_WORKERS) as workers:  # fresh memory is slow to touch
        numbers = dict(
            zip(wanted, workers.map(lambda one: _filled(table, one[1]), wanted), strict=True)
        )
    for want, place in wanted:
        column = table.column(str(place))
        if want.unit == CLOCK:
            text[want.key] = tuple(field.strip() for field in column.to_pylist())
            columns[want.key] = clock_to_seconds(
                rows.path,
                text[want.key],
                channel=str(want.column),
                missing=layout.missing,
                row=rows.rows(len(column)),
                first_row=rows.first_row,
            )
            continue
        values = numbers[want, place]
        if values is None:
            if not pa.types.is_string(column.type):
                column = _parse_as_text(rows, layout, n_fields, [place]).column(str(place))
            values = _second_look(rows, layout, want, column)
        columns[want.key] = without_marks(values, layout)
    return columns, text, rows


def _filled(table: pa.Table, place: int) -> Floats | None:
    """Numbers of a parsed column, or None where it has to be looked at as text."""
    column = table.column(str(place))
    if pa.types.is_string(column.type):
        return None
    values = np.empty(len(column))
    start = 0
    for piece in column.chunks:
        part = values[start : start + len(piece)]
        part[:] = piece.to_numpy(zero_copy_only=False)
        # arrow takes the words nan and inf for numbers; a log may not
        if np.count_nonzero(np.isfinite(part)) != len(piece) - piece.null_count:
            return None
        start += len(piece)
    return values


def _parse(
    rows: TextRows, layout: Layout, n_fields: int, places: Sequence[int], as_text: Sequence[int]
) -> pa.Table:
    names = [str(place) for place in range(n_fields)]
    types = {str(place): pa.string() if place in as_text else pa.float64() for place in set(places)}
    return pa_csv.read_csv(
        pa.py_buffer(rows.text),
        read_options=pa_csv.ReadOptions(column_names=names),
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


def _parse_as_text(
    rows: TextRows, layout: Layout, n_fields: int, places: Sequence[int]
) -> pa.Table:
    try:
        return _parse(rows, layout, n_fields, places, places)
    except pa.ArrowInvalid as error:
        raise _ragged(rows, layout, n_fields, str(error)) from error


def _blank_to_empty(rows: TextRows, layout: Layout) -> TextRows:
    """Lines of blanks alone made empty, so that they are no rows; line numbers stay."""
    blank = rb"(?m)^[ \t]+(?=\r?$)" if layout.delimiter != "\t" else rb"(?m)^ +(?=\r?$)"
    text = re.sub(blank, b"", rows.text).rstrip(b"\r\n")
    return replace(rows, text=memoryview(text))


def _ragged(rows: TextRows, layout: Layout, n_fields: int, message: str) -> LogError:
    lines = bytes(rows.text).decode("utf-8").split("\n")
    for line, text in enumerate(lines):
        found = len(split_line(text, layout))
        if text.strip("\r") and found != n_fields:
            is_last = line == len(lines) - 1
            return LogError(
                rows.path,
                f"a row has {found} fields where the first has {n_fields}",
                row=rows.row_of_line(line),
                found=repr(text.strip()[:60]),
                needed=f"{n_fields} fields",
                hint="The log was cut off; remove its last line." if is_last else None,
            )
    return LogError(rows.path, "the rows cannot be told apart", found=message)


def _second_look(rows: TextRows, layout: Layout, want: Wanted, column: pa.ChunkedArray) -> Floats:
    """Numbers of a text column, or a `LogError` that names its first bad field."""
    trimmed = pc.utf8_trim_whitespace(column)
    is_missing = pc.is_in(trimmed, value_set=pa.array(layout.missing, pa.string()))
    point, mark = re.escape(layout.decimal), re.escape(layout.thousands)
    whole = rf"\d+|\d{{1,3}}(?:{mark}\d{{3}})+" if mark else r"\d+"
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
    row = rows.rows(len(column))
    sample = f"12{layout.decimal}5"
    raise LogError(
        rows.path,
        "a value is not a number",
        row=rows.first_row + bad if row is None else int(row[bad]),
        channel=str(want.column),
        found=repr(found) if found else "an empty field",
        needed=f"a decimal number such as {sample} in {want.unit}, or a declared missing mark",
        hint="Add it to the missing marks of the layout where it means missing.",
    )
