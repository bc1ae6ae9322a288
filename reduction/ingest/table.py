"""The columns of a binary file: what it says of them, and their values part by part."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from reduction.errors import LogError
from reduction.ingest.checked import CheckedColumn
from reduction.ingest.columns import (
    Wanted,
    check_lengths,
    check_unit,
    find_column,
    wanted_columns,
)
from reduction.ingest.layout import Layout
from reduction.ingest.limits import Watch
from reduction.ingest.parts import Parts
from reduction.ingest.preamble import check_units
from reduction.record import Floats
from reduction.samples.scratch import ColumnWriter, check_room

_PART = 16 << 20  # bytes of a matrix that are read at a time


@dataclass(frozen=True)
class ColumnTable:
    """The columns of a binary file, before any is read.

    Parameters
    ----------
    names, units : tuple of str
        As the file has them; empty text where it says nothing.
    load : callable
        Values of one column by its place from 0, in parts of so many rows where the file
        can be read so; one part at least.
    n_rows : int
        Of the longest column that is read in parts; 0 where the columns are read whole.
    where : str
        What holds the columns, for messages: ``group 'log'``.
    in_order : bool
        Whether a column may be named by its number.
    sizes : tuple of int
        Values of each column, where the file states them; empty where only reading tells.
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    load: Callable[[int, int], Iterator[NDArray[Any]]]
    n_rows: int = 0
    where: str = "the file"
    in_order: bool = True
    sizes: tuple[int, ...] = ()


class Matrix(Protocol):
    """An array, or a data set that is read when it is asked for rows."""

    @property
    def shape(self) -> tuple[int, ...]:
        """Rows and columns."""

    @property
    def dtype(self) -> np.dtype[Any]:
        """With fields where the columns have names."""

    def __getitem__(self, rows: slice, /) -> NDArray[Any]:
        """Some rows."""


def matrix_table(
    path: Path,
    matrix: Matrix,
    *,
    where: str,
    names: tuple[str, ...] | None = None,
    units: tuple[str, ...] | None = None,
    n_together: int = 1,
) -> ColumnTable:
    """Columns of a matrix, shape (n_rows, n_columns), or of a table with named fields.

    Parameters
    ----------
    path : pathlib.Path
        For messages.
    matrix : Matrix
        The values.
    where : str
        What holds them, for messages.
    names, units : tuple of str, optional
        Of the columns.
    n_together : int
        Rows that the file keeps in one piece.

    Returns
    -------
    table : ColumnTable
        Parts of its columns come from the same rows, which are read once.

    Raises
    ------
    LogError
        If it has another number of dimensions, or of columns than it has names or units.
    """
    fields = matrix.dtype.names
    if fields is not None:
        if len(matrix.shape) != 1:
            matrix = matrix[:].ravel()
        n_columns = len(fields)
    elif len(matrix.shape) == 2:
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
    total = matrix.shape[0]
    held: list[tuple[slice, NDArray[Any]]] = []  # rows that the columns before have read

    row_size = max(matrix.dtype.itemsize * (1 if fields else n_columns), 1)

    def load(place: int, n_rows: int) -> Iterator[NDArray[Any]]:
        n_rows = max(min(n_rows, _PART // row_size), 1)  # all columns are read, few may be wanted
        for part in row_parts(total, n_rows, n_together):
            if not held or held[0][0] != part:
                held[:] = [(part, matrix[part])]
            rows = held[0][1]
            yield rows[fields[place]] if fields else rows[:, place]

    return ColumnTable(
        names=names or fields or ("",) * n_columns,
        units=units or ("",) * n_columns,
        load=load,
        n_rows=total,
        where=where,
        sizes=(total,) * n_columns,
    )


def row_parts(total: int, n_rows: int, n_together: int = 1) -> Iterator[slice]:
    """Slices of so many rows, of whole pieces where the file keeps rows together; one at least.

    Examples
    --------
    >>> [(part.start, part.stop) for part in row_parts(10, 5, n_together=4)]
    [(0, 4), (4, 8), (8, 10)]
    """
    step = max(n_rows // n_together, 1) * n_together
    for start in range(0, max(total, 1), step):
        yield slice(start, min(start + step, total))


def read_columns(
    path: Path,
    layout: Layout,
    table: ColumnTable,
    made: Mapping[str, Callable[[int], Iterator[Floats]]] | None = None,
    *,
    parts: Parts | None = None,
    watch: Watch | None = None,
) -> tuple[dict[str, Floats], int]:
    """Declared columns of a binary file by channel key, and how many rows they have.

    ``made`` holds those that the reader makes from properties of the file, in parts of so many
    rows.  The watch is asked for the time between the parts.

    Raises
    ------
    LogError
        If a column is missing, stands in another unit, holds no numbers, or has another
        length than the rest.
    DataError
        If the disk is full.
    """
    made, parts, watch = made or {}, parts or Parts(), watch or Watch(path)
    watch.check_columns(len(table.names))
    wanted = wanted_columns(layout)
    places = {}
    for want in wanted:
        if want.key not in made:
            places[want.key] = _place(path, want, table)
    n_bytes = 8 * table.n_rows * len(wanted)
    folder = parts.folder_of(n_bytes)
    if folder is not None:
        stated = (
            [table.sizes[place] for place in places.values()] if table.sizes else [table.n_rows]
        )
        check_room(folder, 8 * sum(stated))
    n_rows = max(parts.length_of(n_bytes) // (8 * max(len(wanted), 1)), 1)
    checked = {
        want.key: CheckedColumn(path, want, layout, folder) for want in wanted if want.key in places
    }
    writers = {key: ColumnWriter(folder) for key in made}
    coming = [
        *((column.add, table.load(places[key], n_rows)) for key, column in checked.items()),
        *((writer.append, made[key](n_rows)) for key, writer in writers.items()),
    ]
    while coming:  # side by side: columns of a matrix come from the same rows
        watch.check_time()
        going = []
        for add, values in coming:
            if (part := next(values, None)) is not None:
                add(part)
                going.append((add, values))
        coming = going
    columns = {
        want.key: (checked[want.key] if want.key in checked else writers[want.key]).finish()
        for want in wanted
    }
    return columns, check_lengths(path, columns)


def _place(path: Path, wanted: Wanted, table: ColumnTable) -> int:
    """Place of a declared column, whose unit is the declared one."""
    place = find_column(path, wanted, table.names, where=table.where, in_order=table.in_order)
    if table.units[place]:
        check_unit(path, wanted, table.units[place])
    else:  # a name such as "Force (kN)" may state it
        check_units(path, [(wanted, place)], names=table.names, units=(), unit_row=None)
    return place
