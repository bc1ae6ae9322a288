"""Values by name on their way into an archive, and the few forms they are brought into."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from reduction.record import Floats

Values = dict[str, NDArray[Any]]
"""Name of the schema to array; dimensions and attributes are the schema's business."""


def texts(items: Sequence[str]) -> NDArray[np.str_]:
    """Return labels as an array; an empty sequence stays an array of text."""
    return np.array(list(items), dtype=np.str_)


def numbers(items: Sequence[float | None]) -> Floats:
    """Return numbers as float64, NaN for None."""
    return np.array([np.nan if item is None else item for item in items], dtype=np.float64)


def pad(rows: Sequence[ArrayLike]) -> Floats:
    """Put ragged rows under each other, NaN where a row is shorter.

    >>> pad([[1.0], [2.0, 3.0]])
    array([[ 1., nan],
           [ 2.,  3.]])
    """
    arrays = [np.atleast_1d(np.asarray(row, dtype=np.float64)) for row in rows]
    table = np.full((len(arrays), max((row.size for row in arrays), default=0)), np.nan)
    for line, row in zip(table, arrays, strict=True):
        line[: row.size] = row
    return table


def pad_texts(rows: Sequence[Sequence[str]]) -> NDArray[np.str_]:
    """Put ragged rows of labels under each other, "" where a row is shorter.

    >>> pad_texts([["a"], ["b", "c"]]).tolist()
    [['a', ''], ['b', 'c']]
    """
    length = max((len(row) for row in rows), default=0)
    return np.array([[*row, *[""] * (length - len(row))] for row in rows], dtype=np.str_)
