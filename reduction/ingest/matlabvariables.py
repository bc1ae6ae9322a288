"""Variables of a MATLAB file of version 4 to 7, read by scipy one by one."""

from __future__ import annotations

import io
import struct
import warnings
import zlib
from collections import Counter
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
import scipy.io
import scipy.sparse
from scipy.io.matlab import MatReadError, matfile_version

from reduction.errors import LogError
from reduction.ingest.limits import Watch
from reduction.ingest.matlabstored import equal_numbers, has_narrow_numbers

OF_MATLAB_ALONE = (
    "A table or timetable can be read by MATLAB alone: save it as a struct of columns, "
    "table2struct(T, 'ToScalar', true)."
)
"""What to do about an object of one of MATLAB's own classes."""
_COMPLEX = "complex numbers"
_HEADER = 128  # bytes before the first variable of a file of version 5
_LONGEST_HEAD = 1 << 16  # bytes of a variable before its values
_NOT_MATLAB = (
    MatReadError, ValueError, IndexError, OSError, TypeError, KeyError, EOFError, zlib.error,
    NotImplementedError, UnboundLocalError, struct.error,
    ArithmeticError, AttributeError, SystemError,  # numbers of a type that there is not
)  # fmt: skip


class Variables(Mapping[str, Any]):
    """Variables of a v4 to v7 file, each read when it is asked for."""

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
            raise no_array(self.path, name, "two variables of that name")
        self.watch.check_time()
        found = self._loaded(name, place, mat_dtype=True)  # true/false apart from numbers
        if scipy.sparse.issparse(found):
            raise no_array(self.path, name, "a sparse matrix")
        if np.iscomplexobj(found):
            raise no_array(self.path, name, _COMPLEX)
        if has_narrow_numbers(found) and not equal_numbers(
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
                # the library would look for it from the first on
                file: Any = stream if place is None else _alone(stream, *place)
                return scipy.io.loadmat(file, mat_dtype=mat_dtype, variable_names=[name])[name]
        except np.exceptions.ComplexWarning:  # of the imaginary part, which would be dropped
            raise no_array(self.path, name, _COMPLEX) from None
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
    """Refuse what scipy goes on with: an unknown order of bytes, texts of no letters."""
    with warnings.catch_warnings():
        warnings.simplefilter("error", UserWarning)
        warnings.simplefilter("error", RuntimeWarning)
        yield


def _old(stream: Any) -> list[tuple[str, None]]:
    """Variables of a file of version 4."""
    return [(name, None) for name, _, _ in scipy.io.whosmat(stream)]


def _stored(stream: BinaryIO, watch: Watch) -> Iterator[tuple[str, tuple[int, int]]]:
    """Variables of a file of version 5 to 7: where each begins, and how many bytes it has."""
    order = "<" if stream.read(_HEADER)[126:] == b"IM" else ">"
    begin, size, count = _HEADER, stream.seek(0, io.SEEK_END), 0
    while begin < size:
        watch.check_time()
        watch.check_columns(count := count + 1)
        stream.seek(begin)
        length = 8 + struct.unpack(f"{order}4xI", stream.read(8))[0]
        # an object of one of MATLAB's own classes has no shape, and the library fails at it
        with suppress(TypeError):
            for name, _, _ in scipy.io.whosmat(_alone(stream, begin, min(length, _LONGEST_HEAD))):
                yield name, (begin, length)
        begin += length


def _alone(stream: BinaryIO, begin: int, length: int) -> Any:
    """One variable as a file of its own."""
    stream.seek(0)
    head = stream.read(_HEADER)
    stream.seek(begin)
    return io.BytesIO(head + stream.read(length))


def no_array(path: Path, name: str, found: str) -> LogError:
    """Error of a variable or field that is no array of numbers."""
    return LogError(
        path,
        f"'{name}' is not an array",
        found=found,
        needed="an array of numbers",
        hint=OF_MATLAB_ALONE,
    )
