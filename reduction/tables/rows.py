"""Rows of a table out of one archive."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from reduction.record import Bools
from reduction.tables.column import Cell, cells_of
from reduction.tables.table import SYNTHETIC, TEST, Table

__all__ = ["table_rows"]


def table_rows(archive: xr.Dataset, table: Table) -> list[list[Cell]]:
    """Return the rows that an archive gives to a table; none where it lacks the subject.

    Parameters
    ----------
    archive : xarray.Dataset
        From `reduction.archive.open.open_archive`.
    table : Table
        What to lay out.

    Returns
    -------
    rows : list of list
        In the order of ``table.dims``, last dimension fastest.
    """
    needed = [name for name in table.needs if name in archive]
    if not needed or not set(table.dims) <= set(archive.sizes):
        return []
    dataset = table.prepare(archive)
    known = np.any([_is_known(_laid_out(dataset, name, table.dims)) for name in needed], axis=0)
    global_cells = {
        TEST.name: archive.attrs.get("test", ""),
        SYNTHETIC.name: archive.attrs.get("synthetic", "no"),
    }
    columns: list[list[Cell]] = []
    for column in table.columns:
        source = column.variable.name
        if column.name in global_cells:
            columns.append([global_cells[column.name]] * int(known.sum()))
        elif source in dataset.variables:
            values = _laid_out(dataset, source, table.dims)[known]
            columns.append(cells_of(values, column.variable))
        else:
            columns.append([None] * int(known.sum()))
    return [list(row) for row in zip(*columns, strict=True)]


def _laid_out(dataset: xr.Dataset, name: str, dims: tuple[str, ...]) -> NDArray[Any]:
    """Repeat a variable over the dimensions it lacks, and unroll it."""
    variable = dataset[name].variable
    values = variable.transpose(*(dim for dim in dims if dim in variable.dims)).values
    axes = tuple(slice(None) if dim in variable.dims else np.newaxis for dim in dims)
    return np.broadcast_to(values[axes], [dataset.sizes[dim] for dim in dims]).ravel()


def _is_known(values: NDArray[Any]) -> Bools:
    if values.dtype.kind == "f":
        return np.asarray(np.isfinite(values), dtype=bool)
    return np.ones(values.shape, dtype=bool)
