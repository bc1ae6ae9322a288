"""Reads the declared columns of Parquet files with pyarrow."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow
import pyarrow.parquet
from numpy.typing import NDArray

from reduction.readers.columns import ColumnTable, read_columns
from reduction.readers.layout import Layout, LogParts, Watch, short_metadata
from reduction.readers.raw_log import RawLog, hash_source
from reduction.record.errors import LogError

_UNIT_KEYS = (b"units", b"unit")

_BUFFER = 1 << 20  # bytes

_MACHINERY = (b"ARROW:schema", b"pandas")  # for programs, not for users


def open_parquet(path: Path) -> pyarrow.parquet.ParquetFile:
    """Open a Parquet file; `LogError` for any other file."""
    try:
        # otherwise each column of a row group is read whole
        return pyarrow.parquet.ParquetFile(path, buffer_size=_BUFFER, pre_buffer=False)
    except (pyarrow.ArrowException, OSError) as error:
        raise LogError(
            path, "the file is not Parquet", found=str(error)[:200], needed="a .parquet file"
        ) from error


def parquet_table(
    path: Path, file: pyarrow.parquet.ParquetFile, watch: Watch | None = None
) -> ColumnTable:
    """Top-level columns of a Parquet file; a null is read as NaN."""
    watch = watch or Watch(path)
    schema = file.schema_arrow
    watch.check_columns(len(schema))

    def unit(place: int) -> str:
        metadata = schema.field(place).metadata or {}
        return next(
            (metadata[key].decode(errors="replace") for key in _UNIT_KEYS if key in metadata), ""
        )

    def load(place: int, n_rows: int) -> Iterator[NDArray[Any]]:
        name = schema.names[place]
        before = schema.names[:place].count(name)  # a duplicate name is read twice
        try:
            # other types are refused unread: one stored text may stand for a million rows
            if not file.metadata.num_rows or not _is_number(schema.types[place]):
                yield _values(pyarrow.array([], schema.types[place]))
            for batch in file.iter_batches(batch_size=n_rows, columns=[name]):
                yield _values(batch.column(before))
        except (pyarrow.ArrowException, OSError) as error:
            raise LogError(
                path, "a column cannot be read", channel=name, found=str(error)[:200]
            ) from error

    return ColumnTable(
        tuple(schema.names),
        tuple(unit(place) for place in range(len(schema))),
        load,
        n_rows=file.metadata.num_rows,
        sizes=(file.metadata.num_rows,) * len(schema),
    )


def _is_number(kind: pyarrow.DataType) -> bool:
    types = pyarrow.types
    return bool(types.is_integer(kind) or types.is_floating(kind) or types.is_boolean(kind))


def _values(column: pyarrow.Array) -> NDArray[Any]:
    """Values of a column with NaN for null."""
    if column.null_count and pyarrow.types.is_boolean(column.type):
        column = column.fill_null(False)
    if column.null_count and pyarrow.types.is_integer(column.type):
        try:
            column = column.cast(pyarrow.float64())
        except pyarrow.ArrowInvalid:  # reported: a number that float64 cannot hold
            column = column.fill_null(0)
    return np.asarray(column.to_numpy(zero_copy_only=False))


def read_parquet(
    path: Path,
    layout: Layout,
    *,
    name: str,
    parts: LogParts | None = None,
    watch: Watch | None = None,
) -> RawLog:
    """Read the declared columns; a field's ``unit`` or ``units`` is checked."""
    source = hash_source(path, name)
    with open_parquet(path) as file:
        columns, n_rows = read_columns(
            path, layout, parquet_table(path, file, watch), parts=parts, watch=watch
        )
        metadata, notes = short_metadata(
            {
                key.decode(errors="replace"): value.decode(errors="replace")
                for key, value in (file.metadata.metadata or {}).items()
                if key not in _MACHINERY
            }
        )
    return RawLog(
        source=source,
        columns=columns,
        first_row=0,
        n_rows_read=n_rows,
        metadata=metadata,
        notes=notes,
    )
