"""JSON and JSON Lines: rows, records or columns, with unit strings beside them."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator
from functools import partial
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np

from reduction.readers.columns import (
    ColumnTable,
    check_unit,
    declared_columns,
    matrix_table,
    read_columns,
)
from reduction.readers.layout import Layout, Watch
from reduction.readers.raw_log import RawLog, read_bytes, source_of
from reduction.readers.text_rows import decode
from reduction.record.errors import LogError
from reduction.record.measurement import Floats

_VALUE, _LIST = 40, 90  # bytes of a number and a list in memory

_MOST_DIGITS = 300  # of integers that are finite in float64


def read_json(path: Path, layout: Layout, *, name: str, watch: Watch | None = None) -> RawLog:
    """Read a JSON log: a matrix, records or an object of columns, at the place in the layout."""
    watch = watch or Watch(path)
    raw, content = json_content(path, watch, layout.encoding)
    setting = "matrix" if layout.matrix else "group"
    place = layout.matrix or layout.group
    table = _json_table(path, _entry(path, content, place, setting), place, content, layout)
    for wanted in declared_columns(layout):
        channel = layout.channels.get(wanted.key)
        if channel is not None and channel.unit_key:
            stated = _entry(path, content, channel.unit_key, f"unit_key of {wanted.key}")
            check_unit(path, wanted, str(stated))
    columns, n_rows = read_columns(path, layout, table, watch=watch)
    plain = content if isinstance(content, dict) else {}
    return RawLog(
        source=source_of(raw, name),
        columns=columns,
        first_row=0,
        n_rows_read=n_rows,
        metadata={
            key: str(value) for key, value in plain.items() if not isinstance(value, (list, dict))
        },
    )


def _json_table(path: Path, rows: Any, place: str, content: Any, layout: Layout) -> ColumnTable:
    """Columns of the value at one place of a JSON log; numbers are checked on loading."""
    where = f"'{place}'" if place else "the file"
    if isinstance(rows, dict) or (isinstance(rows, list) and rows and isinstance(rows[0], dict)):
        if layout.matrix_names or layout.matrix_units:
            raise LogError(
                path, f"the columns of {where} have names of their own",
                found="matrix_names or matrix_units in the layout", needed="neither of them",
            )  # fmt: skip
        if isinstance(rows, dict):
            return _object_table(path, rows, where, layout)
        return _record_table(path, rows, where, layout)
    return matrix_table(
        path,
        _to_matrix(path, rows, where, layout),
        where=where,
        names=_texts(path, content, layout.matrix_names, "matrix_names"),
        units=_texts(path, content, layout.matrix_units, "matrix_units"),
    )


def _object_table(path: Path, columns: dict[str, Any], where: str, layout: Layout) -> ColumnTable:
    """An object of columns: one list of numbers per name; other values are not columns."""
    lists = {key: value for key, value in columns.items() if isinstance(value, list)}
    if not lists:
        raise LogError(
            path, f"{where} holds no columns", found=_keys(columns),
            needed="an object of lists of numbers, or a layout that says where it is",
            hint='Give its place as group = "test.data", or that of a list of rows as matrix.',
        )  # fmt: skip
    names = tuple(lists)

    def load(place: int, n_rows: int) -> Iterator[Floats]:
        yield _numbers(path, lists[names[place]], f"'{names[place]}'", layout)

    return ColumnTable(
        names=names, units=("",) * len(names), load=load, where=where, in_order=False,
        sizes=tuple(map(len, lists.values())),
    )  # fmt: skip


def _record_table(path: Path, records: list[Any], where: str, layout: Layout) -> ColumnTable:
    """Records: one object per row; a key absent from a row is missing there."""
    for index, record in enumerate(records):
        if not isinstance(record, dict):
            raise LogError(
                path, f"row {index + 1} of {where} is not an object", found=type(record).__name__,
                needed="an object in every row, as in the first",
            )  # fmt: skip
    names = tuple(dict.fromkeys(chain.from_iterable(records)))

    def load(place: int, n_rows: int) -> Iterator[Floats]:
        values = [record.get(names[place]) for record in records]
        yield _numbers(path, values, f"'{names[place]}'", layout)

    return ColumnTable(
        names=names, units=("",) * len(names), load=load, where=where, in_order=False,
        sizes=(len(records),) * len(names),
    )  # fmt: skip


def _numbers(path: Path, values: list[Any], where: str, layout: Layout) -> Floats:
    """One column as numbers; null and missing marks are NaN."""
    if not set(map(type, values)) <= {float, int}:
        values = [_number(path, value, index, where, layout) for index, value in enumerate(values)]
    return np.array(values, dtype=np.float64)


def _whole(digits: str) -> int | float:
    """An integer; one beyond float64 becomes infinite, which is refused later."""
    return int(digits) if len(digits) < _MOST_DIGITS else float(digits)


def _once(path: Path, pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """An object with duplicate keys refused: the first would be lost silently."""
    content = dict(pairs)
    if len(content) < len(pairs):
        names = [key for key, _ in pairs]
        twice = next(key for key in names if names.count(key) > 1)
        raise LogError(path, f"the key '{twice}' appears twice in an object", needed="it once")
    return content


def json_content(path: Path, watch: Watch, encoding: str = "utf-8") -> tuple[bytes, Any]:
    """Bytes of a JSON file and its content; for JSON Lines, a list with one value per line."""
    watch.check_unpacked(path.stat().st_size)
    raw = read_bytes(path)
    n_lists = raw.count(b"[") + raw.count(b"{")
    watch.check_unpacked(2 * len(raw) + _VALUE * raw.count(b",") + _LIST * n_lists)
    # the words NaN and Infinity are not JSON; they are kept as text, like any missing mark
    load = partial(
        json.loads, parse_constant=str, parse_int=_whole, object_pairs_hook=partial(_once, path)
    )
    text = decode(path, raw, encoding)
    try:
        try:
            return raw, load(text)
        except json.JSONDecodeError as error:
            if not error.msg.startswith(_MORE):
                raise _not_json(path, error, error.lineno) from error
        return raw, _lines(path, text, load)
    except RecursionError as error:
        raise LogError(
            path, "the file is nested too deeply", found=str(error), needed="a list of rows"
        ) from error


_MORE = "Extra data"  # decoder message when a value ends before the file does


def _lines(path: Path, text: bytes, load: Callable[[bytes], Any]) -> list[Any]:
    """Content of each line of JSON Lines; blank lines are skipped."""
    values = []
    for row, line in enumerate(text.split(b"\n"), 1):
        if line.strip():
            try:
                values.append(load(line))
            except json.JSONDecodeError as error:
                raise _not_json(path, error, row) from error
    return values


def _not_json(path: Path, error: json.JSONDecodeError, row: int) -> LogError:
    return LogError(
        path, "the file is not JSON", row=row, found=error.msg,
        needed="JSON, or JSON Lines with one value a line",
    )  # fmt: skip


def _keys(content: Any) -> str:
    return ", ".join(repr(key) for key in content) if isinstance(content, dict) else "no object"


def _entry(path: Path, content: Any, key: str, setting: str) -> Any:
    """Value at a place: a key, or nested keys from the outermost in, separated by points."""
    found, rest = content, key
    while rest:
        if isinstance(found, dict) and rest in found:
            return found[rest]  # a key may itself contain a point
        name, _, rest = rest.partition(".")
        if isinstance(found, dict) and name in found:
            found = found[name]
        elif isinstance(found, list) and name.isdecimal() and int(name) < len(found):
            found = found[int(name)]
        else:
            raise LogError(
                path,
                f"there is no key '{key}'",
                found=_keys(found),
                needed=f"the key that the layout gives as {setting}, or the keys down to it,"
                " separated by dots",
            )
    return found


def _texts(path: Path, content: Any, key: str, setting: str) -> tuple[str, ...] | None:
    if not key:
        return None
    entry = _entry(path, content, key, setting)
    if not isinstance(entry, list) or not all(isinstance(text, str) for text in entry):
        raise LogError(
            path, f"'{key}' is not a list of texts", found=type(entry).__name__, needed="texts"
        )
    return tuple(entry)


def _to_matrix(path: Path, rows: Any, where: str, layout: Layout) -> Floats:
    """Rows of numbers, shape (n_rows, n_columns); null and missing marks are NaN."""
    if not isinstance(rows, list) or not all(isinstance(row, list) for row in rows):
        raise LogError(
            path,
            f"{where} is not a matrix",
            found=type(rows).__name__,
            needed="a list of rows, each a list of numbers or an object, or an object of columns",
        )
    if not rows:
        raise LogError(path, "there are no data rows", found=f"{where} is empty", needed="rows")
    widths = [len(row) for row in rows]
    if len(set(widths)) > 1:
        bad = next(index for index, width in enumerate(widths) if width != widths[0])
        raise LogError(
            path,
            f"row {bad + 1} of {where} has {widths[bad]} values, the first {widths[0]}",
            needed=f"{widths[0]} values",
        )
    if not set(map(type, chain.from_iterable(rows))) <= {float, int}:
        rows = [
            [_number(path, value, index, where, layout) for value in row]
            for index, row in enumerate(rows)
        ]
    return np.array(rows, dtype=np.float64)


def _number(path: Path, value: object, index: int, where: str, layout: Layout) -> float:
    mark = "" if value is None else value
    if isinstance(mark, str) and mark in layout.missing:
        return math.nan
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return float(value)
    raise LogError(
        path,
        f"a value in row {index + 1} of {where} is not a number",
        found=repr(value),
        needed="a number or a declared missing mark",
    )
