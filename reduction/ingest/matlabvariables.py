"""Variables of a MATLAB file of version 4 to 7, read by scipy one by one."""

from __future__ import annotations

import io
import warnings
import zlib
from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import scipy.io
from scipy.io.matlab import MatReadError, matfile_version

from reduction.errors import LogError
from reduction.ingest.limits import Watch
from reduction.ingest.matlabcheck import HEADER, StoredVariable, stored_variables
from reduction.ingest.matlabstored import equal_numbers, has_narrow_numbers

__all__ = ["OF_MATLAB_ALONE", "Variables", "no_array"]

OF_MATLAB_ALONE = (
    "A table or timetable can be read by MATLAB alone: save it as a struct of columns, "
    "table2struct(T, 'ToScalar', true)."
)
"""What to do about an object of one of MATLAB's own classes."""
_NOT_MATLAB = (
    MatReadError, ValueError, IndexError, OSError, TypeError, KeyError, EOFError, zlib.error,
    NotImplementedError, UnboundLocalError,
)  # fmt: skip


class Variables(Mapping[str, Any]):
    """Variables of a v4 to v7 file, each read when it is asked for."""

    def __init__(self, path: Path, watch: Watch) -> None:
        self.path, self.watch = path, watch
        try:
            version, _ = matfile_version(str(path), appendmat=False)
        except _NOT_MATLAB as error:
            raise LogError(
                path, "the file is not a MATLAB file that can be read", found=str(error)[:200],
                needed="a .mat file of version 4 to 7.3",
            ) from error  # fmt: skip
        self.is_old = version == 0
        held = stored_variables(path, version, watch)
        self.stored = {variable.name: variable for variable in held}
        self.twice = {name for name, count in Counter(v.name for v in held).items() if count > 1}
        self.names = list(self.stored)

    def __getitem__(self, name: str) -> Any:
        stored = self.stored[name]
        if name in self.twice:
            raise no_array(self.path, name, "two variables of that name")
        if stored.kind == "sparse":  # what class it comes as depends on the release of scipy
            raise no_array(self.path, name, "a sparse matrix")
        if stored.is_complex:  # the library would drop the imaginary part without a word
            raise no_array(self.path, name, "complex numbers")
        self.watch.check_unpacked(stored.memory, f"variable '{name}'")
        found = self._loaded(name, mat_dtype=True)  # which keeps true/false apart from numbers
        if has_narrow_numbers(found) and not equal_numbers(
            found, self._loaded(name, mat_dtype=False)
        ):
            raise LogError(
                self.path, f"variable '{name}' cannot be read",
                found="numbers that its class cannot hold", needed="an intact .mat file",
            )  # fmt: skip
        return found

    def _loaded(self, name: str, *, mat_dtype: bool) -> Any:
        stream: Any = io.BytesIO(self._bytes(self.stored[name]))
        try:
            with warnings.catch_warnings():
                # scipy goes on with numbers in a byte order that it does not know, and with texts
                # of numbers that are no letters
                warnings.simplefilter("error", UserWarning)
                warnings.simplefilter("error", RuntimeWarning)
                return scipy.io.loadmat(stream, mat_dtype=mat_dtype, variable_names=[name])[name]
        except (*_NOT_MATLAB, UserWarning, RuntimeWarning) as error:
            raise LogError(
                self.path, f"variable '{name}' cannot be read", found=str(error)[:200],
                needed="an intact .mat file", hint=OF_MATLAB_ALONE,
            ) from error  # fmt: skip

    def _bytes(self, stored: StoredVariable) -> bytes:
        """The variable as a file of its own: the library would look for it from the first on."""
        with self.path.open("rb") as stream:
            head = b"" if self.is_old else stream.read(HEADER)
            stream.seek(stored.begin)
            return head + stream.read(stored.end - stored.begin)

    def __iter__(self) -> Any:
        return iter(self.names)

    def __len__(self) -> int:
        return len(self.names)


def no_array(path: Path, name: str, found: str) -> LogError:
    """Error of a variable or field that is no array of numbers."""
    return LogError(
        path,
        f"'{name}' is not an array",
        found=found,
        needed="an array of numbers",
        hint=OF_MATLAB_ALONE,
    )
