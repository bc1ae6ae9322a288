"""MATLAB files: v4 to v7 by scipy, v7.3 as the HDF5 that it is.

Columns are variables, or fields of one struct (``group``; ``run.log`` is a struct in a
struct), or columns of a matrix.  Objects of MATLAB's own classes (table, timetable,
string, function handles) are refused: only MATLAB can read them.
"""

from __future__ import annotations

import zlib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import h5py  # type: ignore[import-untyped]
import numpy as np
import scipy.io
from numpy.typing import NDArray
from scipy.io.matlab import MatlabFunction, MatlabObject, MatlabOpaque, MatReadError

from reduction.errors import LogError
from reduction.ingest.hdf5 import find_member, open_hdf5, read_data_set
from reduction.ingest.layout import Layout
from reduction.ingest.rawlog import RawLog
from reduction.ingest.source import hash_source
from reduction.ingest.table import ColumnTable, matrix_table, read_columns

__all__ = ["matlab_table", "open_matlab", "read_cell_texts", "read_matlab", "struct_fields"]

_NOT_MATLAB = (
    MatReadError, ValueError, IndexError, OSError, TypeError, KeyError, EOFError, zlib.error,
    NotImplementedError, UnboundLocalError,
)  # fmt: skip
_OWN_CLASSES = (MatlabOpaque, MatlabFunction, MatlabObject)
_HINT = (
    "A table or timetable can be read by MATLAB alone: save it as a struct of columns, "
    "table2struct(T, 'ToScalar', true)."
)


class _Variables(Mapping[str, Any]):
    """Variables of a v4 to v7 file, each read when it is asked for."""

    def __init__(self, path: Path) -> None:
        self.path = path
        try:
            held = scipy.io.whosmat(str(path), appendmat=False)
        except _NOT_MATLAB as error:
            raise LogError(
                path, "the file is not a MATLAB file that can be read", found=str(error)[:200],
                needed="a .mat file of version 4 to 7.3",
            ) from error  # fmt: skip
        self.names = [name for name, _, _ in held]
        self.sparse = {name for name, _, kind in held if kind == "sparse"}

    def __getitem__(self, name: str) -> Any:
        if name not in self.names:
            raise KeyError(name)
        if name in self.sparse:  # not read: what class it comes as depends on the release of scipy
            raise _no_array(self.path, name, "a sparse matrix")
        try:
            # mat_dtype keeps true/false apart from numbers
            return scipy.io.loadmat(
                str(self.path), appendmat=False, mat_dtype=True, variable_names=[name]
            )[name]
        except _NOT_MATLAB as error:
            raise LogError(
                self.path, f"variable '{name}' cannot be read", found=str(error)[:200],
                needed="an intact .mat file", hint=_HINT,
            ) from error  # fmt: skip

    def __iter__(self) -> Any:
        return iter(self.names)

    def __len__(self) -> int:
        return len(self.names)


class _Struct(Mapping[str, Any]):
    """Members of a v7.3 file or of one of its structs, in the shapes of the older versions."""

    def __init__(self, path: Path, group: h5py.Group) -> None:
        self.path, self.group = path, group
        # what MATLAB keeps for itself has names that no variable can have
        self.names = [name for name in group if not name.startswith("#")]

    def __getitem__(self, name: str) -> Any:
        if name not in self.names:
            raise KeyError(name)
        member = find_member(self.path, self.group, name)
        if isinstance(member, h5py.Group):
            return _Struct(self.path, member)
        return self._values(member)

    def _values(self, dataset: h5py.Dataset) -> NDArray[Any]:
        kind = np.asarray(dataset.attrs.get("MATLAB_class", b"")).tobytes().rstrip(b"\0").decode()
        if dataset.attrs.get("MATLAB_empty", 0):
            return np.zeros((0, 0))
        values = read_data_set(self.path, dataset).T  # MATLAB counts columns first
        if kind == "char" and values.dtype.kind == "u":
            return np.array(["".join(chr(code) for code in row) for row in values.tolist()])
        if kind == "logical":
            return values.astype(bool)
        if kind == "cell":
            return self._cells(values)
        return values

    def _cells(self, references: NDArray[Any]) -> NDArray[Any]:
        """Cells that hold text; a reference is followed to characters of this file alone."""
        cells = np.empty(references.size, dtype=object)
        for place, reference in enumerate(references.ravel(order="F")):
            target = self.group.file[reference] if reference else None
            if not isinstance(target, h5py.Dataset) or target.dtype != np.uint16:
                raise LogError(
                    self.path, "a cell does not hold text", found=str(target), needed="text"
                )
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


def _member(path: Path, scope: Mapping[str, Any], name: str) -> Any:
    for part in (part for part in name.split(".") if part):
        if part not in scope:
            raise LogError(
                path, f"'{name}' is not in the file",
                found=", ".join(repr(key) for key in scope) or "nothing", needed=f"'{part}'",
                hint=_HINT,
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
            needed="one struct whose fields are the columns", hint=_HINT,
        )  # fmt: skip
    return fields


def _no_array(path: Path, name: str, found: str) -> LogError:
    return LogError(
        path, f"'{name}' is not an array", found=found, needed="an array of numbers", hint=_HINT
    )


def _array(path: Path, name: str, value: Any) -> NDArray[Any]:
    if not isinstance(value, np.ndarray) or isinstance(value, _OWN_CLASSES):
        raise _no_array(path, name, type(value).__name__)
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
    cells = _array(path, name, value).ravel(order="F").tolist()
    texts = [
        "".join(cell.ravel().tolist())
        if isinstance(cell, np.ndarray) and cell.dtype.kind == "U"
        else cell
        for cell in cells
    ]
    if not all(isinstance(text, str) for text in texts):
        raise LogError(
            path, f"'{name}' does not hold text", found=str(value.dtype),
            needed="a cell array of text, or a character matrix",
        )  # fmt: skip
    return tuple(text.strip() for text in texts)


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
def open_matlab(path: Path) -> Iterator[Mapping[str, Any]]:
    """Variables of a MATLAB file of any version; `LogError` where the file is none."""
    if h5py.is_hdf5(path):
        with open_hdf5(path) as file:
            yield _Struct(path, file)
    else:
        yield _Variables(path)


def read_matlab(path: Path, layout: Layout, *, name: str) -> RawLog:
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
    with open_matlab(path) as scope:
        columns, n_rows = read_columns(path, layout, matlab_table(path, scope, layout))
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
