"""A column of a binary file that grows by parts, each checked and made float64."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from reduction.errors import LogError
from reduction.ingest.columns import Wanted, without_marks
from reduction.ingest.layout import CLOCK, Layout
from reduction.record import Bools, Floats
from reduction.samples.scratch import ColumnWriter

_EXACT = 2**53  # whole numbers beyond this have no float64 of their own
_KINDS = {
    "b": "true or false",
    "c": "complex numbers",
    "M": "dates",
    "m": "durations",
    "S": "text",
    "U": "text",
    "T": "text",
    "O": "text or objects",
    "V": "records",
}
_LARGE = (
    "whole numbers too large to be held exactly", "numbers below 2**53",
    "Write time as elapsed time.",
)  # fmt: skip
_MISSING = (
    "NaN", "a number", 'Add "NaN" to the missing marks of the layout where it means missing.',
)  # fmt: skip
_INFINITE = ("infinite", "finite numbers", None)
_FAULTS = (_LARGE, _MISSING, _INFINITE)  # what is told first


class CheckedColumn:
    """A declared column, shape (n_rows,); declared missing marks are NaN.

    Parameters
    ----------
    path : pathlib.Path
        For messages.
    wanted : Wanted
        What it has to be.
    layout : Layout
        Missing marks.
    folder : pathlib.Path or None
        Where its scratch file lies; None keeps it in memory.
    """

    def __init__(self, path: Path, wanted: Wanted, layout: Layout, folder: Path | None) -> None:
        """Begin with no rows."""
        self._path, self._wanted, self._layout = path, wanted, layout
        self._writer = ColumnWriter(folder)
        self._nan_is_missing = any(mark.lower() == "nan" for mark in layout.missing)
        self._found: dict[tuple[str, str, str | None], tuple[int, int, float]] = {}

    def add(self, values: NDArray[Any]) -> None:
        """Add rows, shape (n_rows,).

        Raises
        ------
        LogError
            If the values are not real numbers.
        DataError
            If the disk is full.
        """
        kind = values.dtype.kind
        if self._wanted.unit == CLOCK or kind not in "fiu":
            raise LogError(
                self._path,
                "a column does not hold numbers",
                channel=str(self._wanted.column),
                found=f"{_KINDS.get(kind, 'something else')} ({values.dtype})",
                needed="elapsed time: a clock is read from text alone"
                if self._wanted.unit == CLOCK
                else f"real numbers in {self._wanted.unit}",
            )
        # damage makes NaNs that signal; a wider float may be infinite here, which is told
        with np.errstate(invalid="ignore", over="ignore"):
            array = values.astype(np.float64, copy=False)
            column = without_marks(values, self._layout)
        if kind in "iu":
            self._look(_LARGE, array, np.abs(array) > _EXACT)
        elif not np.all(np.isfinite(array)):
            if not self._nan_is_missing:
                self._look(_MISSING, array, np.isnan(array))
            self._look(_INFINITE, array, np.isinf(array))
            column = np.where(np.isnan(column), np.nan, column)
        self._writer.append(column)

    def finish(self) -> Floats:
        """The column.

        Raises
        ------
        LogError
            If values cannot be held exactly, are infinite, or are NaN where the layout does
            not declare ``NaN`` a missing mark.
        """
        for fault in _FAULTS:
            if fault in self._found:
                count, first, value = self._found[fault]
                what, needed, hint = fault
                raise LogError(
                    self._path,
                    f"{count} of {self._writer.size} values are {what}, first value {first + 1}",
                    channel=str(self._wanted.column),
                    found=f"{value:.17g}",
                    needed=needed,
                    hint=hint,
                )
        return self._writer.finish()

    def _look(self, fault: tuple[str, str, str | None], values: Floats, bad: Bools) -> None:
        """Count values of a fault, and keep the first of them."""
        places = np.flatnonzero(bad)
        if places.size:
            first = (0, self._writer.size + int(places[0]), float(values[places[0]]))
            count, place, value = self._found.get(fault, first)
            self._found[fault] = (count + places.size, place, value)
