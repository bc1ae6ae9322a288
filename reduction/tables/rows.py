"""Rows of a table out of one archive, block by block."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import prod
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from reduction.record import Bools
from reduction.tables.column import csv_field, texts_of_columns
from reduction.tables.table import SYNTHETIC, TEST, Table

BLOCK_ROWS = 1 << 12
"""Rows of a block: three megabytes of text where a table is as wide as that of the cycles. [1]"""


def table_blocks(
    archive: xr.Dataset, table: Table, *, block_rows: int = BLOCK_ROWS
) -> Iterator[list[list[str]]]:
    """Give the rows that an archive gives to a table; none where it lacks the subject.

    Parameters
    ----------
    archive : xarray.Dataset
        From `reduction.archive.open.open_archive`; of what is as long as the table no more than a
        block is read at a time.
    table : Table
        What to lay out.
    block_rows : int
        Most rows of a block. [1]

    Yields
    ------
    fields : list of list of str
        Rows of a block by column, each field as it stands in a CSV file; rows in the order of
        ``table.dims``, last dimension fastest.
    """
    needed = [name for name in table.needs if name in archive]
    if not needed or not set(table.dims) <= set(archive.sizes):
        return
    variables = {str(name): variable for name, variable in archive.variables.items()}
    variables |= table.derive(archive)
    sizes = {dim: archive.sizes[dim] for dim in table.dims}
    global_fields = {
        TEST.name: csv_field(archive.attrs.get("test", "")),
        SYNTHETIC.name: csv_field(archive.attrs.get("synthetic", "no")),
    }
    columns = table.columns
    for block in _blocks(sizes, block_rows):
        laid_out = [_laid_out(variables[name], block) for name in needed]
        known = np.any([_is_known(values) for values in laid_out], axis=0)
        n_rows = int(known.sum())
        if not n_rows:
            continue
        values = {
            place: (_laid_out(variables[column.variable.name], block)[known], column.variable)
            for place, column in enumerate(columns)
            if column.name not in global_fields and column.variable.name in variables
        }
        texts = dict(zip(values, texts_of_columns(list(values.values())), strict=True))
        yield [
            texts[place] if place in texts else [global_fields.get(column.name, "")] * n_rows
            for place, column in enumerate(columns)
        ]


def _blocks(sizes: Mapping[str, int], most: int) -> Iterator[dict[str, range]]:
    """Cut the combinations of entries of dimensions, the last fastest, in blocks."""
    shape = list(sizes.values())
    # whole along the last dimensions, one entry at a time along the first
    cut = next(axis for axis in range(len(shape)) if prod(shape[axis + 1 :]) <= most)
    step = max(1, most // max(1, prod(shape[cut + 1 :])))
    for outer in np.ndindex(*shape[:cut]):
        for start in range(0, shape[cut], step):
            part = range(start, min(start + step, shape[cut]))
            ranges = [*(range(at, at + 1) for at in outer), part, *map(range, shape[cut + 1 :])]
            yield dict(zip(sizes, ranges, strict=True))


def _laid_out(variable: xr.Variable, block: Mapping[str, range]) -> NDArray[Any]:
    """Repeat a variable over the dimensions it lacks, and unroll it."""
    dims = variable.dims
    own = [dim for dim in block if dim in dims]
    if any(len(block[dim]) < variable.sizes[dim] for dim in own):
        variable = variable.isel({dim: slice(block[dim].start, block[dim].stop) for dim in own})
    values = np.asarray(variable.values)
    if dims == tuple(block):
        return values.ravel()
    values = values.transpose([dims.index(dim) for dim in own])
    axes = tuple(slice(None) if dim in own else np.newaxis for dim in block)
    return np.broadcast_to(values[axes], [len(entries) for entries in block.values()]).ravel()


def _is_known(values: NDArray[Any]) -> Bools:
    if values.dtype.kind == "f":
        return np.asarray(np.isfinite(values), dtype=bool)
    return np.ones(values.shape, dtype=bool)
