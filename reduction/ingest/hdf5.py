"""HDF5: a group with one data set a column, or a matrix or table as one data set.

The attribute ``units`` (or ``unit``) of a data set is checked.  Everything is read from
the one file that was hashed: links, virtual data sets and external storage, which take
values from elsewhere, are refused.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import h5py  # type: ignore[import-untyped]
import numpy as np
from numpy.typing import NDArray

from reduction.errors import LogError
from reduction.ingest.layout import Layout
from reduction.ingest.parts import Parts
from reduction.ingest.rawlog import RawLog
from reduction.ingest.source import hash_source
from reduction.ingest.table import ColumnTable, matrix_table, read_columns, row_parts

__all__ = [
    "find_member",
    "hdf5_table",
    "open_hdf5",
    "read_data_set",
    "read_hdf5",
    "read_series",
    "read_texts",
    "unit_attribute",
]

_UNIT_KEYS = ("units", "unit", "Units", "Unit")
_PACKED = ("scale_factor", "add_offset")


@contextmanager
def open_hdf5(path: Path) -> Iterator[h5py.File]:
    """Open an HDF5 file; `LogError` where the file is none."""
    try:
        file = h5py.File(path, "r", locking=False)
    except OSError as error:
        raise LogError(
            path, "the file is not HDF5", found=str(error)[:200], needed="an HDF5 file"
        ) from error
    with file:
        try:
            yield file
        except (OSError, RuntimeError, KeyError) as error:  # what h5py makes of damage
            raise LogError(
                path, "the file is damaged", found=str(error)[:200], needed="an intact file"
            ) from error


def _members(group: h5py.Group) -> list[str]:
    """Names that a group holds itself."""
    return [name for name in group if isinstance(group.get(name, getlink=True), h5py.HardLink)]


def find_member(path: Path, group: h5py.Group, name: str) -> h5py.Group | h5py.Dataset:
    """Group or data set by its path below a group, never by way of a link."""
    for part in (part for part in name.split("/") if part):
        if not isinstance(group, h5py.Group) or part not in group.keys():
            held = _members(group) if isinstance(group, h5py.Group) else []
            raise LogError(
                path,
                f"'{name}' is not in the file",
                found=f"in '{group.name}': " + (", ".join(repr(key) for key in held) or "nothing"),
                needed=f"'{part}'",
            )
        if not isinstance(group.get(part, getlink=True), h5py.HardLink):
            raise LogError(
                path,
                f"'{name}' is a link",
                found=repr(group.get(part, getlink=True)),
                needed="a data set or group of this file itself",
                hint="Give the place that the link points to, or copy the data into one file.",
            )
        group = group[part]
    return group


def unit_attribute(dataset: h5py.Dataset) -> str:
    """Unit that a data set states; empty text where it states none."""
    for key in _UNIT_KEYS:
        if key in dataset.attrs:
            value = np.asarray(dataset.attrs[key]).ravel()[:1].tolist()
            return "".join(
                v.decode(errors="replace") if isinstance(v, bytes) else str(v) for v in value
            )
    return ""


def read_data_set(path: Path, dataset: h5py.Group | h5py.Dataset) -> NDArray[Any]:
    """All values of a data set that stands in this file as it is meant to be read."""
    return _values(path, _plain(path, dataset), ())


def _plain(path: Path, dataset: h5py.Group | h5py.Dataset) -> h5py.Dataset:
    """The data set, where it is one whose values can be read as they are."""
    problem = None
    if not isinstance(dataset, h5py.Dataset):
        problem, found = "is a group, not a data set", "a group"
    elif dataset.shape is None or dataset.shape == ():
        problem, found = "is a single value, not a series", f"shape {dataset.shape}"
    elif dataset.is_virtual or dataset.external:
        problem, found = "keeps its values in other files", "external storage"
    elif any(key in dataset.attrs for key in _PACKED):
        problem, found = "is packed", ", ".join(key for key in _PACKED if key in dataset.attrs)
    if problem is not None:
        raise LogError(
            path,
            f"'{dataset.name}' {problem}",
            found=found,
            needed="a data set with the plain values in this file",
        )
    return dataset


def _values(path: Path, dataset: h5py.Dataset, selection: Any) -> NDArray[Any]:
    try:
        return np.asarray(dataset[selection])
    except (OSError, ValueError, TypeError) as error:
        raise LogError(
            path, f"'{dataset.name}' cannot be read", found=str(error)[:200],
            needed="an intact data set, compressed by a filter that h5py has",
        ) from error  # fmt: skip


def read_series(path: Path, dataset: h5py.Group | h5py.Dataset) -> NDArray[Any]:
    """Values of a data set of one dimension, shape (n_rows,); a single row or column counts."""
    return np.concatenate(list(_series_parts(path, dataset, sys.maxsize)))


def _series_parts(
    path: Path, dataset: h5py.Group | h5py.Dataset, n_rows: int
) -> Iterator[NDArray[Any]]:
    """Values of such a data set in parts, each of whole chunks of the file."""
    dataset = _plain(path, dataset)
    if sum(size != 1 for size in dataset.shape) > 1:
        raise LogError(
            path,
            f"'{dataset.name}' is not one column",
            found=f"shape {dataset.shape}",
            needed="one dimension",
            hint="Name it as the matrix of the layout where it holds many columns.",
        )
    axis = int(np.argmax(dataset.shape))
    for part in row_parts(dataset.shape[axis], n_rows, _chunk_length(dataset, axis)):
        yield _values(path, dataset, (slice(None),) * axis + (part,)).ravel()


def _chunk_length(dataset: h5py.Dataset, axis: int) -> int:
    """Rows that the file keeps together."""
    return int(dataset.chunks[axis]) if dataset.chunks else 1


@dataclass(frozen=True)
class _DataSet:
    """A data set whose rows are read when they are asked for."""

    path: Path
    dataset: h5py.Dataset

    @property
    def shape(self) -> tuple[int, ...]:
        return tuple(self.dataset.shape)

    @property
    def dtype(self) -> np.dtype[Any]:
        found: np.dtype[Any] = self.dataset.dtype
        return found

    def __getitem__(self, rows: slice, /) -> NDArray[Any]:
        return _values(self.path, self.dataset, rows)


def read_texts(path: Path, dataset: h5py.Group | h5py.Dataset) -> tuple[str, ...]:
    """Texts of a data set of strings."""
    values = read_series(path, dataset)
    if values.dtype.kind not in "OSUT" or not all(
        isinstance(value, (str, bytes)) for value in values.tolist()
    ):
        raise LogError(
            path, f"'{dataset.name}' does not hold text", found=str(values.dtype),
            needed="one text a column",
        )  # fmt: skip
    return tuple(
        value.decode(errors="replace") if isinstance(value, bytes) else value
        for value in values.tolist()
    )


def hdf5_table(path: Path, file: h5py.File, layout: Layout) -> ColumnTable:
    """Columns of the group or matrix that a layout names."""
    group = find_member(path, file, layout.group)
    if layout.matrix:
        names, units = (
            read_texts(path, find_member(path, group, entry)) if entry else None
            for entry in (layout.matrix_names, layout.matrix_units)
        )
        dataset = _plain(path, find_member(path, group, layout.matrix))
        return matrix_table(
            path,
            _DataSet(path, dataset),
            where=f"'{layout.matrix}'",
            names=names,
            units=units,
            n_together=_chunk_length(dataset, 0),
        )
    if not isinstance(group, h5py.Group):
        raise LogError(
            path, f"'{layout.group}' is not a group", found="a data set",
            needed="a group, or the data set as the matrix of the layout",
        )  # fmt: skip
    members = [name for name in _members(group) if isinstance(group[name], h5py.Dataset)]
    return ColumnTable(
        names=tuple(members),
        units=tuple(unit_attribute(group[name]) for name in members),
        load=lambda place, n_rows: _series_parts(path, group[members[place]], n_rows),
        n_rows=max((group[name].size or 0 for name in members), default=0),
        where=f"group '{group.name}'",
        in_order=False,
    )


def _attributes(group: h5py.Group | h5py.Dataset) -> dict[str, str]:
    """Attributes that are one text or number, as text."""
    texts = {}
    for key, value in group.attrs.items():
        if isinstance(value, (str, bytes, np.generic)) and not isinstance(value, np.void):
            texts[key] = value.decode(errors="replace") if isinstance(value, bytes) else str(value)
    return texts


def read_hdf5(path: Path, layout: Layout, *, name: str, parts: Parts | None = None) -> RawLog:
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
    source = hash_source(path, name)
    with open_hdf5(path) as file:
        columns, n_rows = read_columns(path, layout, hdf5_table(path, file, layout), parts=parts)
        metadata = _attributes(file) | _attributes(find_member(path, file, layout.group))
    return RawLog(
        source=source, columns=columns, first_row=0, n_rows_read=n_rows, metadata=metadata
    )
