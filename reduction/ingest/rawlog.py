"""A log as it was read: declared channels in the file's own units, nothing interpreted."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from reduction.provenance import Source
from reduction.record import Bools, Floats, Integers


@dataclass(frozen=True)
class RawLog:
    """What a reader returns.

    Parameters
    ----------
    source : Source
        Name, hash and size of the file.
    columns : dict of str to ndarray, shape (n_rows,)
        By channel key (``time``, ``tension.1``; own time stamps as ``tension.1.time``),
        in the file's unit; a declared missing mark is NaN.  Nothing else may be NaN.
    text : dict of str to tuple of str
        Channels that are text by nature (the clock of a stepwise test).
    first_row : int
        Row of the first data row, as an editor counts; 0 for formats without rows.
    row : ndarray of int, shape (n_rows,), optional
        Editor's row of each data row where the rows are not consecutive.
    n_rows_read : int
        Data rows seen; equal to the length of the columns.
    metadata : dict of str to str
        Preamble and comment lines, file properties; as printed.
    notes : tuple of str
        What the reader wants a person to know.
    """

    source: Source
    columns: dict[str, Floats]
    first_row: int
    n_rows_read: int
    text: dict[str, tuple[str, ...]] = field(default_factory=dict)
    row: Integers | None = None
    metadata: dict[str, str] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    def missing(self, name: str) -> Bools:
        """Where a channel holds a declared missing mark, shape (n_rows,)."""
        return np.isnan(self.columns[name])
