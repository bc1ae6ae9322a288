"""Find a table of numbers among rows of fields, and the rows of names and units above it."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from reduction.ingest.sniff_channels import SeenColumn, is_unit

_ROWS = 400
_RUN = 3  # rows in a row that make a table
_NUMBER = {
    mark: re.compile(rf"[+-]?(\d+({re.escape(mark)}\d*)?|{re.escape(mark)}\d+)([eE][+-]?\d+)?")
    for mark in ".,"
}


@dataclass(frozen=True)
class TableShape:
    """Where a table stands in rows of fields; rows count from 0."""

    start: int
    """First data row."""
    n_fields: int
    name_row: int | None
    unit_row: int | None
    names: tuple[str, ...]
    units: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    """Fields of some data rows."""


def is_number(text: str, decimal: str) -> bool:
    """Whether a field is a number with this decimal mark and no thousands mark."""
    return _NUMBER[decimal].fullmatch(text) is not None


def look_at_table(rows: Sequence[Sequence[str]], decimal: str) -> TableShape | None:
    """Header and data of rows of fields; None where no table of numbers is among them."""
    counts = [sum(is_number(text, decimal) for text in row) for row in rows]
    data = [
        len(row) > 1 and 2 * count >= sum(map(bool, row)) > 0
        for row, count in zip(rows, counts, strict=True)
    ]
    sizes = Counter(len(row) for row, is_data in zip(rows, data, strict=True) if is_data)
    if not sizes:
        return None
    n_fields = sizes.most_common(1)[0][0]
    data = [is_data and len(row) == n_fields for row, is_data in zip(rows, data, strict=True)]
    usual = np.median([count for count, is_data in zip(counts, data, strict=True) if is_data])
    # a line of the preamble with a number in it has fewer numbers than a row of the table
    good = [is_data and 2 * count > usual for count, is_data in zip(counts, data, strict=True)]
    run = max(2, min(_RUN, sum(good)))
    start = next((i for i in range(len(rows)) if sum(good[i : i + run]) == run), None)
    if start is None:
        return None
    above = [i for i in range(start) if any(rows[i])]
    name_row, unit_row = None, None
    if above and _is_header(rows[above[-1]], n_fields):
        name_row = above[-1]
        if (
            len(above) > 1
            and _is_unit_row(rows[name_row])
            and _is_header(rows[above[-2]], n_fields)
        ):
            name_row, unit_row = above[-2], name_row
    names = rows[name_row] if name_row is not None else ()
    units = rows[unit_row] if unit_row is not None else ()
    pad = ("",) * n_fields
    return TableShape(
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
    )


def _is_header(fields: Sequence[str], n_fields: int) -> bool:
    """Whether fields can be names or units of the columns: as many but for trailing blanks."""
    return 1 < len(fields) and not any(fields[n_fields:]) and sum(map(bool, fields)) * 2 > n_fields


def _is_unit_row(fields: Sequence[str]) -> bool:
    filled = [text.strip("()[] ") for text in fields if text.strip("()[] -")]
    known = sum(is_unit(text) for text in filled)
    return bool(filled) and 2 * known >= len(filled)


def seen_columns(table: TableShape, decimal: str, thousands: str = "") -> list[SeenColumn]:
    """Columns of a table with the values of its rows."""
    columns = []
    for place in range(table.n_fields):
        texts = tuple(row[place] for row in table.rows)
        plain = [text.replace(thousands, "") if thousands else text for text in texts]
        values = [
            float(text.replace(decimal, ".")) if is_number(text, decimal) else math.nan
            for text in plain
        ]
        columns.append(
            SeenColumn(place + 1, table.names[place], table.units[place], np.array(values), texts)
        )
    if columns and not columns[-1].name and not any(columns[-1].texts):
        columns.pop()  # a delimiter at the end of each line
    return columns
