"""The columns of a binary file: what it says of them, and their values as float64."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from reduction.errors import LogError
from reduction.ingest.columns import (
    Wanted,
    check_lengths,
    check_unit,
    find_column,
    wanted_columns,
    without_marks,
)
from reduction.ingest.layout import CLOCK, Layout
from reduction.ingest.preamble import check_units
from reduction.record import Bools, Floats

__all__ = ["ColumnTable", "matrix_table", "read_columns", "to_floats"]

_EXACT = 2**53  # whole numbers beyond this have no float64 of their own
_KINDS = {
    "b": "true or false",
    "c": "complex numbers",
    "M": "dates",
    "m": "durations",
    "S": "text",
    "U": "text",
    "T": "text",
    "O": "text or objects",
    "V": "records",
}


@dataclass(frozen=True)
class ColumnTable:
    """The columns of a binary file, before any is read.

    Parameters
    ----------
    names, units : tuple of str
        As the file has them; empty text where it says nothing.
    load : callable
        Values of one column by its place from 0, shape (n_rows,).
    where : str
        What holds the columns, for messages: ``group 'log'``.
    in_order : bool
        Whether a column may be named by its number.
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    load: Callable[[int], NDArray[Any]]
    where: str = "the file"
    in_order: bool = True


def _refuse(
    path: Path, wanted: Wanted, values: Floats, bad: Bools, what: str, needed: str, hint: str | None
) -> None:
    first = int(np.flatnonzero(bad)[0])
    raise LogError(
        path,
        f"{int(bad.sum())} of {values.size} values are {what}, first value {first + 1}",
        channel=str(wanted.column),
        found=f"{values[first]:.17g}",
        needed=needed,
        hint=hint,
    )


def to_floats(path: Path, wanted: Wanted, values: NDArray[Any], layout: Layout) -> Floats:
    """A column of a binary file as float64, shape (n_rows,); declared missing marks are NaN.

    Raises
    ------
    LogError
        If the values are not real numbers, cannot be held exactly, are infinite, or are NaN
        where the layout does not declare ``NaN`` a missing mark.
    """
    kind = values.dtype.kind
    if wanted.unit == CLOCK or kind not in "fiu":
        raise LogError(
            path,
            "a column does not hold numbers",
            channel=str(wanted.column),
            found=f"{_KINDS.get(kind, 'something else')} ({values.dtype})",
            needed="elapsed time: a clock is read from text alone"
            if wanted.unit == CLOCK
            else f"real numbers in {wanted.unit}",
        )
    array = values.astype(np.float64)
    if kind in "iu":
        large = np.abs(array) > _EXACT
        if large.any():
            _refuse(
                path, wanted, array, large, "whole numbers too large to be held exactly",
                "numbers below 2**53",
                "Write time as elapsed time.",
            )  # fmt: skip
    missing = np.isnan(array)
    if missing.any() and not any(mark.lower() == "nan" for mark in layout.missing):
        _refuse(
            path, wanted, array, missing, "NaN", "a number",
            'Add "NaN" to the missing marks of the layout where it means missing.',
        )  # fmt: skip
    infinite = np.isinf(array)
    if infinite.any():
        _refuse(path, wanted, array, infinite, "infinite", "finite numbers", None)
    return without_marks(values, layout)


def matrix_table(
    path: Path,
    matrix: NDArray[Any],
    *,
    where: str,
    names: tuple[str, ...] | None = None,
    units: tuple[str, ...] | None = None,
) -> ColumnTable:
    """Columns of a matrix, shape (n_rows, n_columns), or of a table with named fields.

    Raises
    ------
    LogError
        If it has another number of dimensions, or of columns than it has names or units.
    """
    fields = matrix.dtype.names
    if fields is not None:
        matrix, n_columns = matrix.ravel(), len(fields)
    elif matrix.ndim == 2:
        n_columns = matrix.shape[1]
    else:
        raise LogError(
            path, f"{where} is not a matrix", found=f"shape {matrix.shape}",
            needed="rows and columns",
        )  # fmt: skip
    for what, texts in (("names", names), ("units", units)):
        if texts is not None and len(texts) != n_columns:
            raise LogError(
                path, f"{where} has another number of columns than of {what}",
                found=f"{n_columns} columns, {what} {', '.join(texts)}",
                needed=f"{n_columns} {what}",
            )  # fmt: skip
    return ColumnTable(
        names=names or fields or ("",) * n_columns,
        units=units or ("",) * n_columns,
        load=lambda place: matrix[fields[place]] if fields else matrix[:, place],
        where=where,
    )


def read_columns(
    path: Path, layout: Layout, table: ColumnTable, made: Mapping[str, Floats] | None = None
) -> tuple[dict[str, Floats], int]:
    """Declared columns of a binary file by channel key, and how many rows they have.

    ``made`` holds those that the reader makes from properties of the file.

    Raises
    ------
    LogError
        If a column is missing, stands in another unit, holds no numbers, or has another
        length than the rest.
    """
    columns = {}
    for wanted in wanted_columns(layout):
        if made is not None and wanted.key in made:
            columns[wanted.key] = made[wanted.key]
            continue
        place = find_column(path, wanted, table.names, where=table.where, in_order=table.in_order)
        if table.units[place]:
            check_unit(path, wanted, table.units[place])
        else:  # a name such as "Force (kN)" may state it
            check_units(path, [(wanted, place)], names=table.names, units=(), unit_row=None)
        columns[wanted.key] = to_floats(path, wanted, table.load(place), layout)
    return columns, check_lengths(path, columns)
