"""HDF5: a group with one data set a column, or a matrix or table as one data set.

The attribute ``units`` (or ``unit``) of a data set is checked.
"""

from __future__ import annotations

from pathlib import Path

import h5py  # type: ignore[import-untyped]
import numpy as np

from reduction.errors import LogError
from reduction.ingest.hdf5attributes import is_plain_attribute, unit_attribute
from reduction.ingest.hdf5file import (
    chunk_length,
    data_set,
    find_member,
    names_in,
    open_hdf5,
    read_texts,
    series_parts,
)
from reduction.ingest.layout import Layout
from reduction.ingest.limits import Watch
from reduction.ingest.metadata import short_metadata
from reduction.ingest.parts import Parts
from reduction.ingest.rawlog import RawLog
from reduction.ingest.source import hash_source
from reduction.ingest.table import ColumnTable, matrix_table, read_columns


def hdf5_table(
    path: Path, file: h5py.File, layout: Layout, watch: Watch | None = None
) -> ColumnTable:
    """Columns of the group or matrix that a layout names."""
    watch = watch or Watch(path)
    group = find_member(path, file, layout.group)
    if layout.matrix:
        names, units = (
            read_texts(path, find_member(path, group, entry), watch) if entry else None
            for entry in (layout.matrix_names, layout.matrix_units)
        )
        matrix = data_set(path, find_member(path, group, layout.matrix), watch)
        if matrix.ndim == 2:
            watch.check_columns(matrix.shape[1])
        return matrix_table(
            path,
            matrix,
            where=f"'{layout.matrix}'",
            names=names,
            units=units,
            n_together=chunk_length(matrix.dataset, 0),
        )
    if not isinstance(group, h5py.Group):
        raise LogError(
            path, f"'{layout.group}' is not a group", found="a data set",
            needed="a group, or the data set as the matrix of the layout",
        )  # fmt: skip
    return group_table(path, group, watch)


def group_table(path: Path, group: h5py.Group, watch: Watch) -> ColumnTable:
    """Columns of a group: its data sets."""
    watch.check_columns(len(group))
    members = {
        name: member for name in names_in(group) if isinstance(member := group[name], h5py.Dataset)
    }
    sets = list(members.values())
    return ColumnTable(
        names=tuple(members),
        units=tuple(unit_attribute(path, member) for member in sets),
        load=lambda place, n_rows: series_parts(path, sets[place], n_rows, watch),
        n_rows=max((member.size or 0 for member in sets), default=0),
        where=f"group '{group.name}'",
        in_order=False,
        sizes=tuple(member.size or 0 for member in sets),
    )


def _attributes(group: h5py.Group | h5py.Dataset) -> dict[str, str]:
    """Attributes that are one text or number, as text."""
    texts = {}
    for key in group.attrs:
        if group.attrs.get_id(key).shape != () or not is_plain_attribute(group, key):
            continue
        value = group.attrs[key]
        if isinstance(value, (str, bytes, np.generic)) and not isinstance(value, np.void):
            texts[key] = value.decode(errors="replace") if isinstance(value, bytes) else str(value)
    return texts


def read_hdf5(
    path: Path,
    layout: Layout,
    *,
    name: str,
    parts: Parts | None = None,
    watch: Watch | None = None,
) -> RawLog:
    """Read the declared columns of one group, or of one matrix.

    Parameters
    ----------
    path : pathlib.Path
        The file.
    layout : Layout
        ``group``, or ``matrix`` with ``matrix_names`` and ``matrix_units`` (paths below the
        group), ``missing`` and the channels.
    name : str
        Name of the file for the product.
    parts : Parts, optional
        How much of it is read at a time.
    watch : Watch, optional
        Holds it against its limits.

    Returns
    -------
    log : RawLog
        With the attributes of file and group as metadata.

    Raises
    ------
    LogError
        If the file, a data set or a column cannot be used.
    DataError
        If the disk is full.
    """
    watch = watch or Watch(path)
    source = hash_source(path, name)
    with open_hdf5(path) as file:
        columns, n_rows = read_columns(
            path, layout, hdf5_table(path, file, layout, watch), parts=parts, watch=watch
        )
        metadata, notes = short_metadata(
            _attributes(file) | _attributes(find_member(path, file, layout.group))
        )
    return RawLog(
        source=source,
        columns=columns,
        first_row=0,
        n_rows_read=n_rows,
        metadata=metadata,
        notes=notes,
    )
