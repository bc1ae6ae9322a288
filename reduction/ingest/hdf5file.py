"""What stands in an HDF5 file: members, data sets, texts, looked at before values are read.

Everything is read from the one file that was hashed: links, virtual data sets and external
storage, which take values from elsewhere, are refused.  So are values that were never written: the
library would make them up, any number of them.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Any

import h5py  # type: ignore[import-untyped]
import numpy as np
from numpy.typing import NDArray

from reduction.errors import LogError
from reduction.ingest.limits import Watch
from reduction.ingest.table import row_parts

_PACKED = ("scale_factor", "add_offset")
_SHOWN = 40


@contextmanager
def open_hdf5(path: Path) -> Iterator[h5py.File]:
    """Open an HDF5 file for a block.

    Raises
    ------
    LogError
        If the file is none, or is damaged.
    """
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


def names_in(group: h5py.Group) -> Iterator[str]:
    """Names that a group holds itself."""
    return (name for name in group if isinstance(group.get(name, getlink=True), h5py.HardLink))


def find_member(path: Path, group: h5py.Group, name: str) -> h5py.Group | h5py.Dataset:
    """Group or data set by its path below a group, never by way of a link."""
    for part in (part for part in name.split("/") if part):
        if not isinstance(group, h5py.Group) or part not in group.keys():
            held = list(islice(names_in(group), _SHOWN)) if isinstance(group, h5py.Group) else []
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


def read_data_set(
    path: Path, dataset: h5py.Group | h5py.Dataset, watch: Watch | None = None
) -> NDArray[Any]:
    """All values of a data set that stands in this file as it is meant to be read."""
    found = _plain(path, dataset)
    return _values(path, found, (), found.size, watch or Watch(path))


def _plain(path: Path, dataset: h5py.Group | h5py.Dataset) -> h5py.Dataset:
    """The data set, where it is one whose values can be read as they are."""
    problem: str | None = None
    found: str | None
    if not isinstance(dataset, h5py.Dataset):
        problem, found = "is a group, not a data set", "a group"
    elif (found := _no_type(dataset)) is not None:
        problem = "has values of a type that is none"
    elif dataset.shape is None or dataset.shape == ():
        problem, found = "is a single value, not a series", f"shape {dataset.shape}"
    elif dataset.is_virtual or dataset.external:
        problem, found = "keeps its values in other files", "external storage"
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
    """What the library says of a type that it cannot give as one of numpy."""
    try:
        np.dtype(dataset.dtype)
    except (TypeError, ValueError) as error:
        return str(error)[:200]
    return None


def _not_written(dataset: h5py.Dataset) -> str | None:
    """How much of a data set the file holds, where that is not all."""
    if not dataset.size:
        return None
    if dataset.chunks is None:
        is_there = dataset.id.get_storage_size() > 0
        return None if is_there else f"shape {dataset.shape}, and no values"
    sides = zip(dataset.shape, dataset.chunks, strict=True)
    n_needed = math.prod(-(-side // chunk) for side, chunk in sides)
    # an empty one is told by its size, which is quicker than a count of what is there
    n_stored = dataset.id.get_num_chunks() if dataset.id.get_storage_size() else 0
    if n_stored >= n_needed:
        return None
    return f"shape {dataset.shape}, {n_stored} of its {n_needed} chunks"


def _values(
    path: Path, dataset: h5py.Dataset, selection: Any, n_values: int, watch: Watch
) -> NDArray[Any]:
    """Some values of a data set, as many as stated."""
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
    """A data set of one dimension, and its axis; a single row or column counts."""
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


def series_parts(
    path: Path, dataset: h5py.Group | h5py.Dataset, n_rows: int, watch: Watch
) -> Iterator[NDArray[Any]]:
    """Values of such a data set in parts, each of whole chunks of the file."""
    dataset, axis = _column(path, dataset)
    if dataset.dtype.kind not in "biufc":
        # refused by its kind; texts of any length, read first, could be one text many times
        yield np.empty(0, dtype=dataset.dtype)
    for part in row_parts(dataset.shape[axis], n_rows, chunk_length(dataset, axis)):
        selection = (slice(None),) * axis + (part,)
        yield _values(path, dataset, selection, part.stop - part.start, watch).ravel()


def chunk_length(dataset: h5py.Dataset, axis: int) -> int:
    """Rows that the file keeps together."""
    return int(dataset.chunks[axis]) if dataset.chunks else 1


@dataclass(frozen=True)
class _DataSet:
    """A data set whose rows are read when they are asked for."""

    path: Path
    dataset: h5py.Dataset
    watch: Watch

    @property
    def shape(self) -> tuple[int, ...]:
        return tuple(self.dataset.shape)

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
        return _values(self.path, self.dataset, rows, n_values, self.watch)


def data_set(path: Path, dataset: h5py.Group | h5py.Dataset, watch: Watch) -> _DataSet:
    """A data set that stands in this file, before any of it is read.

    Raises
    ------
    LogError
        If it is none, or its values do not all stand in this file as they are.
    """
    return _DataSet(path, _plain(path, dataset), watch)


def read_texts(
    path: Path, dataset: h5py.Group | h5py.Dataset, watch: Watch | None = None
) -> tuple[str, ...]:
    """Texts of a data set of strings, no more than a file may have columns."""
    watch = watch or Watch(path)
    dataset, axis = _column(path, dataset)
    texts: list[str] = []
    length = 0
    if dataset.dtype.kind in "OSUT":
        watch.check_columns(dataset.size)
        if dataset.dtype.kind == "O" and h5py.check_string_dtype(dataset.dtype) is None:
            raise _no_text(path, dataset)  # rows of any length, for which there is no bound
        # one by one: each of them may be the same long text
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
