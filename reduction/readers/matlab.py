"""MATLAB logs: v4 to v7 by scipy, v7.3 as HDF5.

Columns are variables, fields of one struct (``group``; ``run.log`` is a nested struct) or columns
of a matrix.  Objects of MATLAB's own classes (table, timetable, string, function handles) are
refused, because only MATLAB can read them.
"""

from __future__ import annotations

import io
import struct
import warnings
import zlib
from collections import Counter
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from itertools import zip_longest
from pathlib import Path
from typing import Any, BinaryIO

import h5py
import numpy as np
import scipy.io
import scipy.sparse
from numpy.typing import NDArray
from scipy.io.matlab import (
    MatlabFunction,
    MatlabObject,
    MatlabOpaque,
    MatReadError,
    matfile_version,
)

from reduction.readers.columns import ColumnTable, matrix_table, read_columns
from reduction.readers.hdf5 import find_member, open_hdf5, plain_attribute, read_data_set
from reduction.readers.layout import Layout, Watch
from reduction.readers.raw_log import RawLog, hash_source
from reduction.record.errors import LogError


def _has_narrow_numbers(value: Any) -> bool:
    """Whether any number in it, at any depth, has a type too narrow for the stored values.

    Examples
    --------
    >>> _has_narrow_numbers(np.array([1.5])), _has_narrow_numbers(np.array([1], dtype=np.int8))
    (False, True)
    """
    return any(numbers.dtype != np.float64 for numbers in _numbers(value))


def _equal_numbers(value: Any, stored: Any) -> bool:
    """Whether all numbers in two values are equal, whatever their types.

    Examples
    --------
    >>> _equal_numbers(np.array([2], dtype=np.int8), np.array([2.96]))
    False
    """
    return all(
        one is not None and other is not None and np.array_equal(one, other, equal_nan=True)
        for one, other in zip_longest(_numbers(value), _numbers(stored))
    )


def _numbers(value: Any) -> Iterator[NDArray[Any]]:
    """Numeric arrays in cells and structs, one after another."""
    waiting = [value]
    while waiting:
        found = waiting.pop()
        if not isinstance(found, np.ndarray):
            continue
        if found.dtype.names:
            waiting.extend(found[name] for name in found.dtype.names)
        elif found.dtype.kind == "O":
            waiting.extend(found.ravel().tolist())
        elif found.dtype.kind in "biufc":
            yield found


OF_MATLAB_ALONE = (
    "Only MATLAB can read a table or timetable: save it as a struct of columns, "
    "table2struct(T, 'ToScalar', true)."
)
"""Advice for an object of one of MATLAB's own classes."""

_COMPLEX = "complex numbers"

_HEADER = 128  # bytes before the first variable of a file of version 5

_LONGEST_HEAD = 1 << 16  # maximum bytes of a variable before its values

_NOT_MATLAB = (
    MatReadError, ValueError, IndexError, OSError, TypeError, KeyError, EOFError, zlib.error,
    NotImplementedError, UnboundLocalError, struct.error,
    ArithmeticError, AttributeError, SystemError,  # unknown numeric type
)  # fmt: skip


class _Variables(Mapping[str, Any]):
    """Variables of a v4 to v7 file, each read on request."""

    def __init__(self, path: Path, watch: Watch) -> None:
        self.path, self.watch = path, watch
        try:
            version, _ = matfile_version(str(path), appendmat=False)
            with _strictly(), path.open("rb") as stream:
                found = [*_stored(stream, watch)] if version else _old(stream)
        except LogError:
            raise
        except (*_NOT_MATLAB, UserWarning, RuntimeWarning) as error:
            raise LogError(
                path, "the file is not a MATLAB file that can be read", found=str(error)[:200],
                needed="a .mat file of version 4 to 7.3 that is whole",
            ) from error  # fmt: skip
        self.places = dict(found)
        self.twice = {name for name, n in Counter(name for name, _ in found).items() if n > 1}

    def __getitem__(self, name: str) -> Any:
        place = self.places[name]
        if name in self.twice:
            raise _no_array(self.path, name, "two variables of that name")
        self.watch.check_time()
        found = self._loaded(name, place, mat_dtype=True)  # tells logical values from numbers
        if scipy.sparse.issparse(found):
            raise _no_array(self.path, name, "a sparse matrix")
        if np.iscomplexobj(found):
            raise _no_array(self.path, name, _COMPLEX)
        if _has_narrow_numbers(found) and not _equal_numbers(
            found, self._loaded(name, place, mat_dtype=False)
        ):
            raise LogError(
                self.path, f"variable '{name}' cannot be read",
                found="numbers that its class cannot hold", needed="an intact .mat file",
            )  # fmt: skip
        return found

    def _loaded(self, name: str, place: tuple[int, int] | None, *, mat_dtype: bool) -> Any:
        try:
            with _strictly(), self.path.open("rb") as stream:
                # the library would search from the first variable on
                file: Any = stream if place is None else _alone(stream, *place)
                return scipy.io.loadmat(file, mat_dtype=mat_dtype, variable_names=[name])[name]
        except np.exceptions.ComplexWarning:  # the imaginary part would be dropped
            raise _no_array(self.path, name, _COMPLEX) from None
        except (*_NOT_MATLAB, UserWarning, RuntimeWarning) as error:
            raise LogError(
                self.path, f"variable '{name}' cannot be read", found=str(error)[:200],
                needed="an intact .mat file", hint=OF_MATLAB_ALONE,
            ) from error  # fmt: skip

    def __iter__(self) -> Any:
        return iter(self.places)

    def __len__(self) -> int:
        return len(self.places)


@contextmanager
def _strictly() -> Iterator[None]:
    """Refuse input that scipy would accept: an unknown byte order, invalid text."""
    with warnings.catch_warnings():
        warnings.simplefilter("error", UserWarning)
        warnings.simplefilter("error", RuntimeWarning)
        yield


def _old(stream: Any) -> list[tuple[str, None]]:
    """Variables of a version 4 file."""
    return [(name, None) for name, _, _ in scipy.io.whosmat(stream)]


def _stored(stream: BinaryIO, watch: Watch) -> Iterator[tuple[str, tuple[int, int]]]:
    """Variables of a version 5 to 7 file, each with its start and length in bytes."""
    order = "<" if stream.read(_HEADER)[126:] == b"IM" else ">"
    begin, size, count = _HEADER, stream.seek(0, io.SEEK_END), 0
    while begin < size:
        watch.check_time()
        watch.check_columns(count := count + 1)
        stream.seek(begin)
        length = 8 + struct.unpack(f"{order}4xI", stream.read(8))[0]
        # an object of one of MATLAB's own classes has no shape, and the library fails on it
        with suppress(TypeError):
            for name, _, _ in scipy.io.whosmat(_alone(stream, begin, min(length, _LONGEST_HEAD))):
                if not name.startswith("_"):  # no variable: what such objects keep in the file
                    yield name, (begin, length)
        begin += length


def _alone(stream: BinaryIO, begin: int, length: int) -> Any:
    """One variable as a separate file."""
    stream.seek(0)
    head = stream.read(_HEADER)
    stream.seek(begin)
    return io.BytesIO(head + stream.read(length))


def _no_array(path: Path, name: str, found: str) -> LogError:
    """Error for a variable or field that is not a numeric array."""
    return LogError(
        path,
        f"'{name}' is not an array",
        found=found,
        needed="an array of numbers",
        hint=OF_MATLAB_ALONE,
    )


_LETTER = 60  # bytes per character while a text is assembled

_OWN_CLASSES = (MatlabOpaque, MatlabFunction, MatlabObject)


class _Struct(Mapping[str, Any]):
    """Members of a v7.3 file or one of its structs, in the shapes of older versions."""

    def __init__(self, path: Path, group: h5py.Group, watch: Watch) -> None:
        self.path, self.group, self.watch = path, group, watch
        watch.check_columns(len(group))
        # MATLAB's internal members have names that no variable can have
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
        values = read_data_set(self.path, dataset, self.watch).T  # MATLAB is column-major
        if kind == "char" and values.dtype.kind == "u":
            return np.array(["".join(chr(code) for code in row) for row in values.tolist()])
        if kind == "logical":
            return values.astype(bool)
        if kind == "cell":
            return self._cells(values)
        return values

    def _cells(self, references: NDArray[Any]) -> NDArray[Any]:
        """Text cells; a reference is followed only to characters in this file."""
        self.watch.check_columns(references.size)
        cells = np.empty(references.size, dtype=object)
        length = 0
        for place, reference in enumerate(references.ravel(order="F")):
            target = self.group.file[reference] if reference else None
            if not isinstance(target, h5py.Dataset) or target.dtype != np.uint16:
                raise LogError(
                    self.path, "a cell does not hold text", found=str(target), needed="text"
                )
            # every reference may point to the same long text
            length += _LETTER * (target.size or 0)
            self.watch.check_unpacked(length, f"'{target.name}'")
            cells[place] = self._values(target)
        return cells

    def __iter__(self) -> Any:
        return iter(self.names)

    def __len__(self) -> int:
        return len(self.names)


def struct_fields(value: Any) -> Mapping[str, Any] | None:
    """Fields of a scalar struct, or None for any other value."""
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
    """Address of a v7.3 struct in its file, to detect one that contains itself."""
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
    """Variables of a MATLAB file of any version; `LogError` for any other file."""
    watch = watch or Watch(path)
    if h5py.is_hdf5(path):
        with open_hdf5(path) as file:
            yield _Struct(path, file, watch)
    else:
        yield _Variables(path, watch)


def read_matlab(path: Path, layout: Layout, *, name: str, watch: Watch | None = None) -> RawLog:
    """Read the declared columns from a struct, a matrix, or the file's variables."""
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
