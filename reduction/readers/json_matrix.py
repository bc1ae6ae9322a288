"""JSON: a matrix of rows, with unit strings beside it."""

from __future__ import annotations

import json
import math
from functools import partial
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np

from reduction.readers.columns import check_unit, declared_columns, matrix_table, read_columns
from reduction.readers.layout import Layout, Watch
from reduction.readers.raw_log import RawLog, read_bytes, source_of
from reduction.readers.text_rows import decode
from reduction.record.errors import LogError
from reduction.record.measurement import Floats

_VALUE, _LIST = 40, 90  # bytes that a number and a list take in memory

_MOST_DIGITS = 300  # of whole numbers that are finite as float64


def read_json(path: Path, layout: Layout, *, name: str, watch: Watch | None = None) -> RawLog:
    """Read a JSON log: the matrix under the layout's ``matrix`` key, one list a row."""
    watch = watch or Watch(path)
    raw, content = json_content(path, watch, layout.encoding)
    rows = _entry(path, content, layout.matrix, "matrix")
    table = matrix_table(
        path,
        _to_matrix(path, rows, layout),
        where=f"'{layout.matrix}'",
        names=_texts(path, content, layout.matrix_names, "matrix_names"),
        units=_texts(path, content, layout.matrix_units, "matrix_units"),
    )
    for wanted in declared_columns(layout):
        channel = layout.channels.get(wanted.key)
        if channel is not None and channel.unit_key:
            stated = _entry(path, content, channel.unit_key, f"unit_key of {wanted.key}")
            check_unit(path, wanted, str(stated))
    columns, n_rows = read_columns(path, layout, table, watch=watch)
    plain = {key: value for key, value in content.items() if not isinstance(value, (list, dict))}
    return RawLog(
        source=source_of(raw, name),
        columns=columns,
        first_row=0,
        n_rows_read=n_rows,
        metadata={key: str(value) for key, value in plain.items()},
    )


def _whole(digits: str) -> int | float:
    """A whole number; one that float64 cannot hold is infinite, which is refused as such."""
    return int(digits) if len(digits) < _MOST_DIGITS else float(digits)


def _once(path: Path, pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """An object, of which no key stands twice: the first would be lost without a word."""
    content = dict(pairs)
    if len(content) < len(pairs):
        names = [key for key, _ in pairs]
        twice = next(key for key in names if names.count(key) > 1)
        raise LogError(path, f"the key '{twice}' appears twice in an object", needed="it once")
    return content


def json_content(path: Path, watch: Watch, encoding: str = "utf-8") -> tuple[bytes, Any]:
    """Bytes of a JSON file, and what they say."""
    watch.check_unpacked(path.stat().st_size)
    raw = read_bytes(path)
    n_lists = raw.count(b"[") + raw.count(b"{")
    watch.check_unpacked(2 * len(raw) + _VALUE * raw.count(b",") + _LIST * n_lists)
    try:
        # the words NaN and Infinity are not JSON; here they are text like any other mark
        text = decode(path, raw, encoding)
        return raw, json.loads(
            text, parse_constant=str, parse_int=_whole, object_pairs_hook=partial(_once, path)
        )
    except json.JSONDecodeError as error:
        raise LogError(
            path, "the file is not JSON", row=error.lineno, found=error.msg, needed="a JSON object"
        ) from error
    except RecursionError as error:
        raise LogError(
            path, "the file is nested too deeply", found=str(error), needed="a list of rows"
        ) from error


def _entry(path: Path, content: Any, key: str, setting: str) -> Any:
    if not isinstance(content, dict) or key not in content:
        there = ", ".join(repr(k) for k in content) if isinstance(content, dict) else "no object"
        raise LogError(
            path,
            f"there is no key '{key}'",
            found=there,
            needed=f"the key that the layout gives as {setting}",
        )
    return content[key]


def _texts(path: Path, content: Any, key: str, setting: str) -> tuple[str, ...] | None:
    if not key:
        return None
    entry = _entry(path, content, key, setting)
    if not isinstance(entry, list) or not all(isinstance(text, str) for text in entry):
        raise LogError(
            path, f"'{key}' is not a list of texts", found=type(entry).__name__, needed="texts"
        )
    return tuple(entry)


def _to_matrix(path: Path, rows: Any, layout: Layout) -> Floats:
    """Rows of numbers, shape (n_rows, n_columns); null and missing marks are NaN."""
    if not isinstance(rows, list) or not all(isinstance(row, list) for row in rows):
        raise LogError(
            path,
            f"'{layout.matrix}' is not a matrix",
            found=type(rows).__name__,
            needed="a list of rows, each a list of numbers",
        )
    if not rows:
        raise LogError(
            path, "there are no data rows", found=f"'{layout.matrix}' is empty", needed="rows"
        )
    widths = [len(row) for row in rows]
    if len(set(widths)) > 1:
        bad = next(index for index, width in enumerate(widths) if width != widths[0])
        raise LogError(
            path,
            f"row {bad + 1} of '{layout.matrix}' has {widths[bad]} values, the first {widths[0]}",
            needed=f"{widths[0]} values",
        )
    if not set(map(type, chain.from_iterable(rows))) <= {float, int}:
        rows = [
            [_number(path, value, index, layout) for value in row] for index, row in enumerate(rows)
        ]
    return np.array(rows, dtype=np.float64)


def _number(path: Path, value: object, index: int, layout: Layout) -> float:
    mark = "" if value is None else value
    if isinstance(mark, str) and mark in layout.missing:
        return math.nan
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return float(value)
    raise LogError(
        path,
        f"a value in row {index + 1} of '{layout.matrix}' is not a number",
        found=repr(value),
        needed="a number or a declared missing mark",
    )
