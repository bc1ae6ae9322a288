"""Parquet, read by pyarrow, the declared columns alone."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pyarrow  # type: ignore[import-untyped]
import pyarrow.parquet  # type: ignore[import-untyped]
from numpy.typing import NDArray

from reduction.errors import LogError
from reduction.ingest.layout import Layout
from reduction.ingest.rawlog import RawLog
from reduction.ingest.source import hash_source
from reduction.ingest.table import ColumnTable, read_columns

__all__ = ["open_parquet", "parquet_table", "read_parquet"]

_UNIT_KEYS = (b"units", b"unit")
_MACHINERY = (b"ARROW:schema", b"pandas")  # for programs, not for a reader


def open_parquet(path: Path) -> pyarrow.parquet.ParquetFile:
    """Open a Parquet file; `LogError` where the file is none."""
    try:
        return pyarrow.parquet.ParquetFile(path)
    except (pyarrow.ArrowException, OSError) as error:
        raise LogError(
            path, "the file is not Parquet", found=str(error)[:200], needed="a .parquet file"
        ) from error


def parquet_table(path: Path, file: pyarrow.parquet.ParquetFile) -> ColumnTable:
    """Top-level columns of a Parquet file; a null is read as NaN."""
    schema = file.schema_arrow

    def unit(place: int) -> str:
        metadata = schema.field(place).metadata or {}
        return next((metadata[key].decode() for key in _UNIT_KEYS if key in metadata), "")

    def load(place: int) -> NDArray[Any]:
        name = schema.names[place]
        try:
            # a name that stands twice reads as many columns
            column = file.read(columns=[name]).column(schema.names[:place].count(name))
            if pyarrow.types.is_integer(column.type) and column.null_count:
                column = column.cast(pyarrow.float64())  # refuses what float64 cannot hold
        except (pyarrow.ArrowException, OSError) as error:
            raise LogError(
                path, "a column cannot be read", channel=name, found=str(error)[:200]
            ) from error
        return np.asarray(column.to_numpy())

    return ColumnTable(
        tuple(schema.names), tuple(unit(place) for place in range(len(schema))), load
    )


def read_parquet(path: Path, layout: Layout, *, name: str) -> RawLog:
    """Read the declared columns; a field's ``unit`` or ``units`` is checked.

    Parameters
    ----------
    path : pathlib.Path
        The file.
    layout : Layout
        ``missing`` and the channels.
    name : str
        Name of the file for the product.

    Returns
    -------
    log : RawLog
        With the key-value metadata of the file.

    Raises
    ------
    LogError
        If the file or a column cannot be used.
    """
    source = hash_source(path, name)
    with open_parquet(path) as file:
        columns, n_rows = read_columns(path, layout, parquet_table(path, file))
        properties = file.metadata.metadata or {}
    return RawLog(
        source=source,
        columns=columns,
        first_row=0,
        n_rows_read=n_rows,
        metadata={
            key.decode(errors="replace"): value.decode(errors="replace")
            for key, value in properties.items()
            if key not in _MACHINERY
        },
    )
