"""MATLAB files: v4 to v7 by scipy, v7.3 as the HDF5 that it is.

Columns are variables, or fields of one struct (``group``; ``run.log`` is a struct in a
struct), or columns of a matrix.  Objects of MATLAB's own classes (table, timetable,
string, function handles) are refused: only MATLAB can read them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import h5py  # type: ignore[import-untyped]
import numpy as np
from numpy.typing import NDArray
from scipy.io.matlab import MatlabFunction, MatlabObject, MatlabOpaque

from reduction.errors import LogError
from reduction.ingest.hdf5attributes import plain_attribute
from reduction.ingest.hdf5file import find_member, open_hdf5, read_data_set
from reduction.ingest.layout import Layout
from reduction.ingest.limits import Watch
from reduction.ingest.matlabvariables import OF_MATLAB_ALONE, Variables, no_array
from reduction.ingest.rawlog import RawLog
from reduction.ingest.source import hash_source
from reduction.ingest.table import ColumnTable, matrix_table, read_columns

_LETTER = 60  # bytes of a character while a text is put together
_OWN_CLASSES = (MatlabOpaque, MatlabFunction, MatlabObject)


class _Struct(Mapping[str, Any]):
    """Members of a v7.3 file or of one of its structs, in the shapes of the older versions."""

    def __init__(self, path: Path, group: h5py.Group, watch: Watch) -> None:
        self.path, self.group, self.watch = path, group, watch
        watch.check_columns(len(group))
        # what MATLAB keeps for itself has names that no variable can have
        self.names = [name for name in group if not name.startswith("#")]

    def __getitem__(self, name: str) -> Any:
        if name not in self.names:
            raise KeyError(name)
        member = find_member(self.path, self.group, name)
        if isinstance(member, h5py.Group):
            return _Struct(self.path, member, self.watch)
        return self._values(member)

    def _values(self, dataset: h5py.Dataset) -> NDArray[Any]:
        stated = plain_attribute(self.path, dataset, "MATLAB_class")
        kind = "" if stated is None else stated.tobytes().rstrip(b"\0").decode(errors="replace")
        is_empty = plain_attribute(self.path, dataset, "MATLAB_empty")
        if is_empty is not None and np.any(is_empty):
            return np.zeros((0, 0))
        if kind == "char":
            self.watch.check_unpacked(_LETTER * (dataset.size or 0), f"'{dataset.name}'")
        values = read_data_set(self.path, dataset, self.watch).T  # MATLAB counts columns first
        if kind == "char" and values.dtype.kind == "u":
            return np.array(["".join(chr(code) for code in row) for row in values.tolist()])
        if kind == "logical":
            return values.astype(bool)
        if kind == "cell":
            return self._cells(values)
        return values

    def _cells(self, references: NDArray[Any]) -> NDArray[Any]:
        """Cells that hold text; a reference is followed to characters of this file alone."""
        self.watch.check_columns(references.size)
        cells = np.empty(references.size, dtype=object)
        length = 0
        for place, reference in enumerate(references.ravel(order="F")):
            target = self.group.file[reference] if reference else None
            if not isinstance(target, h5py.Dataset) or target.dtype != np.uint16:
                raise LogError(
                    self.path, "a cell does not hold text", found=str(target), needed="text"
                )
            # every one may refer to the same long text
            length += _LETTER * (target.size or 0)
            self.watch.check_unpacked(length, f"'{target.name}'")
            cells[place] = self._values(target)
        return cells

    def __iter__(self) -> Any:
        return iter(self.names)

    def __len__(self) -> int:
        return len(self.names)


def struct_fields(value: Any) -> Mapping[str, Any] | None:
    """Fields of a scalar struct, or None where the value is none."""
    if isinstance(value, _Struct):
        return value
    if (
        isinstance(value, np.ndarray)
        and not isinstance(value, _OWN_CLASSES)
        and value.dtype.names
        and value.size == 1
    ):
        record = value.ravel()[0]
        return {name: record[name] for name in value.dtype.names}
    return None


def struct_place(fields: Mapping[str, Any]) -> int | None:
    """Where a struct of version 7.3 stands in its file: by it one that holds itself is known."""
    if not isinstance(fields, _Struct):
        return None
    place: int = h5py.h5o.get_info(fields.group.id).addr
    return place


def _member(path: Path, scope: Mapping[str, Any], name: str) -> Any:
    for part in (part for part in name.split(".") if part):
        if part not in scope:
            raise LogError(
                path, f"'{name}' is not in the file",
                found=", ".join(repr(key) for key in scope) or "nothing", needed=f"'{part}'",
                hint=OF_MATLAB_ALONE,
            )  # fmt: skip
        value = scope[part]
        scope = struct_fields(value) or {}
    return value


def _scope(path: Path, scope: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    if not name:
        return scope
    value = _member(path, scope, name)
    fields = struct_fields(value)
    if fields is None:
        raise LogError(
            path, f"'{name}' is not a struct", found=f"{type(value).__name__} {np.shape(value)}",
            needed="one struct whose fields are the columns", hint=OF_MATLAB_ALONE,
        )  # fmt: skip
    return fields


def _array(path: Path, name: str, value: Any) -> NDArray[Any]:
    if not isinstance(value, np.ndarray) or isinstance(value, _OWN_CLASSES):
        raise no_array(path, name, type(value).__name__)
    return value


def _series(path: Path, name: str, value: Any) -> NDArray[Any]:
    values = _array(path, name, value)
    if sum(size != 1 for size in values.shape) > 1 and values.size:
        raise LogError(
            path, f"'{name}' is not one column", found=f"shape {values.shape}",
            needed="one row or one column",
            hint="Name it as the matrix of the layout where it holds many columns.",
        )  # fmt: skip
    return values.ravel()


def read_cell_texts(path: Path, name: str, value: Any) -> tuple[str, ...]:
    """Texts of a cell array or of a character matrix."""
    array = _array(path, name, value)
    if array.dtype.kind not in "OU":
        raise _no_text(path, name, array)
    cells = array.ravel(order="F").tolist()
    texts = [
        "".join(cell.ravel().tolist())
        if isinstance(cell, np.ndarray) and cell.dtype.kind == "U"
        else cell
        for cell in cells
    ]
    if not all(isinstance(text, str) for text in texts):
        raise _no_text(path, name, array)
    return tuple(text.strip() for text in texts)


def _no_text(path: Path, name: str, array: NDArray[Any]) -> LogError:
    return LogError(
        path, f"'{name}' does not hold text", found=str(array.dtype),
        needed="a cell array of text, or a character matrix",
    )  # fmt: skip


def matlab_table(path: Path, scope: Mapping[str, Any], layout: Layout) -> ColumnTable:
    """Columns of the struct, matrix or variables that a layout names."""
    scope = _scope(path, scope, layout.group)
    if layout.matrix:
        names, units = (
            read_cell_texts(path, entry, _member(path, scope, entry)) if entry else None
            for entry in (layout.matrix_names, layout.matrix_units)
        )
        matrix = _array(path, layout.matrix, _member(path, scope, layout.matrix))
        return matrix_table(path, matrix, where=f"'{layout.matrix}'", names=names, units=units)
    names_here = tuple(scope)
    return ColumnTable(
        names=names_here,
        units=("",) * len(names_here),
        load=lambda place, _: iter([_series(path, names_here[place], scope[names_here[place]])]),
        where=f"struct '{layout.group}'" if layout.group else "the file",
        in_order=bool(layout.group),
    )


@contextmanager
def open_matlab(path: Path, watch: Watch | None = None) -> Iterator[Mapping[str, Any]]:
    """Variables of a MATLAB file of any version; `LogError` where the file is none."""
    watch = watch or Watch(path)
    if h5py.is_hdf5(path):
        with open_hdf5(path) as file:
            yield _Struct(path, file, watch)
    else:
        yield Variables(path, watch)


def read_matlab(path: Path, layout: Layout, *, name: str, watch: Watch | None = None) -> RawLog:
    """Read the declared columns of one struct, of one matrix, or of the file's variables.

    Parameters
    ----------
    path : pathlib.Path
        The file.
    layout : Layout
        ``group``, or ``matrix`` with ``matrix_names`` and ``matrix_units`` (inside the
        group), ``missing`` and the channels.
    name : str
        Name of the file for the product.
    watch : Watch, optional
        Holds it against its limits.

    Returns
    -------
    log : RawLog
        With the header text of the file as metadata.

    Raises
    ------
    LogError
        If the file, a variable or a column cannot be used.
    """
    source = hash_source(path, name)
    with open_matlab(path, watch) as scope:
        columns, n_rows = read_columns(path, layout, matlab_table(path, scope, layout), watch=watch)
    with path.open("rb") as stream:
        header = stream.read(116)
    return RawLog(
        source=source,
        columns=columns,
        first_row=0,
        n_rows_read=n_rows,
        metadata={"header": header.decode("ascii", errors="replace").strip()}
        if header.startswith(b"MATLAB")
        else {},
    )
