"""HDF5 logs.

The attribute ``units`` (or ``unit``) of a data set is checked.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from reduction.readers.columns import ColumnTable, is_wide, matrix_table, read_columns, row_parts
from reduction.readers.layout import Layout, LogParts, Watch, short_metadata
from reduction.readers.raw_log import RawLog, hash_source
from reduction.record.errors import LogError

_UNIT_KEYS = ("units", "unit", "Units", "Unit")

_LONGEST_UNIT = 200

_PLAIN_CLASSES = (h5py.h5t.INTEGER, h5py.h5t.FLOAT, h5py.h5t.STRING, h5py.h5t.ENUM)

_LARGEST = 1 << 20  # bytes; texts of any length are stored elsewhere


def _is_plain_attribute(item: h5py.Group | h5py.Dataset, name: str) -> bool:
    """Whether an existing attribute holds numbers or text of acceptable length."""
    found = item.attrs.get_id(name)
    if found.get_type().get_class() not in _PLAIN_CLASSES or found.get_storage_size() > _LARGEST:
        return False
    try:
        np.dtype(found.dtype)
    except (TypeError, ValueError):  # invalid text, or a float wider than numpy supports
        return False
    return True


def plain_attribute(path: Path, item: h5py.Group | h5py.Dataset, name: str) -> NDArray[Any] | None:
    """Value of an attribute, None if absent; `LogError` if it is not a plain one."""
    if name not in item.attrs:
        return None
    if not _is_plain_attribute(item, name):
        raise LogError(
            path, f"the attribute '{name}' of '{item.name}' cannot be read",
            found="a type that is neither number nor text", needed="an intact file",
        )  # fmt: skip
    return np.asarray(item.attrs[name])


def _unit_attribute(path: Path, dataset: h5py.Dataset) -> str:
    """Unit stated by a data set; empty text if it states none."""
    for key in _UNIT_KEYS:
        found = plain_attribute(path, dataset, key)
        if found is not None:
            text = "".join(
                v.decode(errors="replace") if isinstance(v, bytes) else str(v)
                for v in found.ravel()[:1].tolist()
            )
            return text[:_LONGEST_UNIT]  # longer than any unit, so refused as a mismatch
    return ""


_PACKED = ("scale_factor", "add_offset")

_SHOWN = 40


@contextmanager
def open_hdf5(path: Path) -> Iterator[h5py.File]:
    """Open an HDF5 file as a context manager."""
    try:
        file = h5py.File(path, "r", locking=False)
    except OSError as error:
        raise LogError(
            path, "the file is not HDF5", found=str(error)[:200], needed="an HDF5 file"
        ) from error
    with file:
        try:
            yield file
        except (OSError, RuntimeError, KeyError, UnicodeDecodeError) as error:  # damage
            raise LogError(
                path, "the file is damaged", found=str(error)[:200], needed="an intact file"
            ) from error


def _names_in(group: h5py.Group) -> Iterator[str]:
    """Names directly inside a group."""
    return (name for name in group if isinstance(group.get(name, getlink=True), h5py.HardLink))


def find_member(path: Path, group: h5py.Group, name: str) -> h5py.Group | h5py.Dataset:
    """Group or data set by its path below a group, without following links."""
    for part in (part for part in name.split("/") if part):
        if not isinstance(group, h5py.Group) or part not in group.keys():
            held = list(islice(_names_in(group), _SHOWN)) if isinstance(group, h5py.Group) else []
            more = ", ..." if len(held) == _SHOWN else ""
            listed = ", ".join(repr(key) for key in held) or "nothing"
            raise LogError(
                path,
                f"'{name}' is not in the file",
                found=f"in '{group.name}': {listed}{more}",
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


def read_data_set(path: Path, dataset: h5py.Group | h5py.Dataset, watch: Watch) -> NDArray[Any]:
    """All values of a data set stored in this file in a readable form."""
    found = _plain(path, dataset)
    return _values(path, found, (), found.size, watch)


def _plain(path: Path, dataset: h5py.Group | h5py.Dataset) -> h5py.Dataset:
    """The data set, if its values can be read as they are."""
    problem: str | None = None
    found: str | None
    if not isinstance(dataset, h5py.Dataset):
        problem, found = "is a group, not a data set", "a group"
    elif (found := _no_type(dataset)) is not None:
        problem = "has values of a type that cannot be read"
    elif dataset.shape is None or dataset.shape == ():
        problem, found = "is a single value, not a series", f"shape {dataset.shape}"
    elif dataset.is_virtual or dataset.external:
        problem, found = "stores its values in other files", "external storage"
    elif any(key in dataset.attrs for key in _PACKED):
        problem, found = "is packed", ", ".join(key for key in _PACKED if key in dataset.attrs)
    elif (found := _not_written(dataset)) is not None:
        problem = "has values that were never written"
    if problem is not None:
        raise LogError(
            path,
            f"'{dataset.name}' {problem}",
            found=found,
            needed="a data set with the plain values in this file",
        )
    return dataset


def _no_type(dataset: h5py.Dataset) -> str | None:
    """Library message on a type that has no numpy equivalent."""
    try:
        np.dtype(dataset.dtype)
    except (TypeError, ValueError) as error:
        return str(error)[:200]
    return None


def _not_written(dataset: h5py.Dataset) -> str | None:
    """Share of a data set written in the file, if not all of it is."""
    if not dataset.size:
        return None
    if dataset.chunks is None:
        is_there = dataset.id.get_storage_size() > 0
        return None if is_there else f"shape {dataset.shape}, and no values"
    sides = zip(dataset.shape, dataset.chunks, strict=True)
    n_needed = math.prod(-(-side // chunk) for side, chunk in sides)
    # an empty one is recognised by its size, which is faster than counting the chunks
    n_stored = dataset.id.get_num_chunks() if dataset.id.get_storage_size() else 0
    if n_stored >= n_needed:
        return None
    return f"shape {dataset.shape}, {n_stored} of its {n_needed} chunks"


def _values(
    path: Path, dataset: h5py.Dataset, selection: Any, n_values: int, watch: Watch
) -> NDArray[Any]:
    """Selected values of a data set, `n_values` in number, within the size limit."""
    each = dataset.dtype.itemsize
    watch.check_unpacked(n_values * each, f"'{dataset.name}'")
    if dataset.chunks is not None:
        watch.check_unpacked(math.prod(dataset.chunks) * each, f"a chunk of '{dataset.name}'")
    try:
        return np.asarray(dataset[selection])
    except (OSError, ValueError, TypeError) as error:
        raise LogError(
            path, f"'{dataset.name}' cannot be read", found=str(error)[:200],
            needed="an intact data set, compressed by a filter that h5py has",
        ) from error  # fmt: skip


def _column(path: Path, dataset: h5py.Group | h5py.Dataset) -> tuple[h5py.Dataset, int]:
    """A one-dimensional data set and its axis; a single row or column qualifies."""
    dataset = _plain(path, dataset)
    if sum(size != 1 for size in dataset.shape) > 1:
        raise LogError(
            path,
            f"'{dataset.name}' is not one column",
            found=f"shape {dataset.shape}",
            needed="one dimension",
            hint="Name it as the matrix of the layout where it holds many columns.",
        )
    return dataset, int(np.argmax(dataset.shape))


def _series_parts(
    path: Path, dataset: h5py.Group | h5py.Dataset, n_rows: int, watch: Watch
) -> Iterator[NDArray[Any]]:
    """Values of such a data set in parts, each of whole chunks of the file."""
    dataset, axis = _column(path, dataset)
    if dataset.dtype.kind not in "biufc":
        # refused by its type; reading texts of any length could repeat one text many times
        yield np.empty(0, dtype=dataset.dtype)
    for part in row_parts(dataset.shape[axis], n_rows, _chunk_length(dataset, axis)):
        selection = (slice(None),) * axis + (part,)
        yield _values(path, dataset, selection, part.stop - part.start, watch).ravel()


def _chunk_length(dataset: h5py.Dataset, axis: int) -> int:
    """Rows stored together in the file."""
    return int(dataset.chunks[axis]) if dataset.chunks else 1


@dataclass(frozen=True)
class _DataSet:
    """A data set whose rows are read on request."""

    path: Path
    dataset: h5py.Dataset
    watch: Watch
    is_turned: bool = False

    @property
    def shape(self) -> tuple[int, ...]:
        return tuple(self.dataset.shape)[:: -1 if self.is_turned else 1]

    @property
    def n_together(self) -> int:
        """Rows stored together in the file."""
        return _chunk_length(self.dataset, int(self.is_turned))

    @property
    def T(self) -> _DataSet:  # noqa: N802 (as in numpy)
        return replace(self, is_turned=not self.is_turned)

    @property
    def ndim(self) -> int:
        return len(self.dataset.shape)

    @property
    def size(self) -> int:
        return int(self.dataset.size)

    @property
    def dtype(self) -> np.dtype[Any]:
        found: np.dtype[Any] = self.dataset.dtype
        return found

    def __getitem__(self, rows: slice, /) -> NDArray[Any]:
        start, stop, _ = rows.indices(self.shape[0])
        n_values = max(stop - start, 0) * math.prod(self.shape[1:])
        selection = (slice(None), rows) if self.is_turned else rows
        values = _values(self.path, self.dataset, selection, n_values, self.watch)
        return values.T if self.is_turned else values


def data_set(path: Path, dataset: h5py.Group | h5py.Dataset, watch: Watch) -> _DataSet:
    """A data set stored in this file, before any of it is read."""
    return _DataSet(path, _plain(path, dataset), watch)


def read_texts(path: Path, dataset: h5py.Group | h5py.Dataset, watch: Watch) -> tuple[str, ...]:
    """Texts of a data set of strings, limited to the maximum number of columns."""
    dataset, axis = _column(path, dataset)
    texts: list[str] = []
    length = 0
    if dataset.dtype.kind in "OSUT":
        watch.check_columns(dataset.size)
        if dataset.dtype.kind == "O" and h5py.check_string_dtype(dataset.dtype) is None:
            raise _no_text(path, dataset)  # unbounded row length
        # one by one, as each of them may be the same long text
        for part in row_parts(dataset.shape[axis], 1):
            for value in _values(path, dataset, (slice(None),) * axis + (part,), 1, watch).ravel():
                text = value.decode(errors="replace") if isinstance(value, bytes) else value
                if not isinstance(text, str):
                    raise _no_text(path, dataset)
                length += len(text)
                watch.check_unpacked(length, f"'{dataset.name}'")
                texts.append(text)
        return tuple(texts)
    raise _no_text(path, dataset)


def _no_text(path: Path, dataset: h5py.Dataset) -> LogError:
    return LogError(
        path, f"'{dataset.name}' does not hold text", found=str(dataset.dtype),
        needed="one text a column",
    )  # fmt: skip


def _hdf5_table(path: Path, file: h5py.File, layout: Layout, watch: Watch) -> ColumnTable:
    """Columns of the group or matrix named by a layout."""
    group = find_member(path, file, layout.group)
    if layout.matrix:
        names, units = (
            read_texts(path, find_member(path, group, entry), watch) if entry else None
            for entry in (layout.matrix_names, layout.matrix_units)
        )
        matrix = data_set(path, find_member(path, group, layout.matrix), watch)
        if matrix.ndim == 2 and not is_wide(matrix):
            watch.check_columns(matrix.shape[1])
        return matrix_table(path, matrix, where=f"'{layout.matrix}'", names=names, units=units)
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
        name: member for name in _names_in(group) if isinstance(member := group[name], h5py.Dataset)
    }
    sets = list(members.values())
    return ColumnTable(
        names=tuple(members),
        units=tuple(_unit_attribute(path, member) for member in sets),
        load=lambda place, n_rows: _series_parts(path, sets[place], n_rows, watch),
        n_rows=max((member.size or 0 for member in sets), default=0),
        where=f"group '{group.name}'",
        in_order=False,
        sizes=tuple(member.size or 0 for member in sets),
    )


def _attributes(group: h5py.Group | h5py.Dataset) -> dict[str, str]:
    """Attributes with a single text or number, as text."""
    texts = {}
    for key in group.attrs:
        if group.attrs.get_id(key).shape != () or not _is_plain_attribute(group, key):
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
    parts: LogParts | None = None,
    watch: Watch | None = None,
) -> RawLog:
    """Read the declared columns of one group, or of one matrix."""
    watch = watch or Watch(path)
    source = hash_source(path, name)
    with open_hdf5(path) as file:
        columns, n_rows = read_columns(
            path, layout, _hdf5_table(path, file, layout, watch), parts=parts, watch=watch
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
