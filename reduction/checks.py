"""Checks that physics functions share: finite, positive, increasing, same shape.

Each raises `DataError` with the count, the first index and the value there; a number that was
stated is refused with `SettingsError`.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import DataError, SettingsError
from reduction.record import Bools, Floats
from reduction.samples.search import any_sample


def _refuse(name: str, values: Floats, bad: Bools, what: str, needed: str) -> None:
    first = int(np.flatnonzero(bad.ravel())[0])
    raise DataError(
        f"{int(bad.sum())} of {bad.size} values of {name} are {what}, first at index {first}",
        found=f"{values.ravel()[first]:g}",
        needed=needed,
    )


def as_finite(name: str, values: ArrayLike) -> Floats:
    """Return the values as float64, or raise `DataError` where one is not finite."""
    array = np.asarray(values, dtype=np.float64)
    # a mask of all samples is made where one is wrong
    if array.ndim == 1 and not any_sample(
        lambda part: ~np.isfinite(array[part]), array.size, array
    ):
        return array
    bad = ~np.isfinite(array)
    if bad.any():
        _refuse(name, array, np.atleast_1d(bad), "not finite", "finite numbers")
    return array


def as_positive(name: str, values: ArrayLike) -> Floats:
    """Return the values as float64, or raise `DataError` where one is not above zero."""
    array = as_finite(name, values)
    bad = ~(array > 0)
    if bad.any():
        _refuse(name, array, np.atleast_1d(bad), "not positive", "numbers above zero")
    return array


def as_increasing(name: str, values: ArrayLike) -> Floats:
    """Return a one-dimensional series, or raise `DataError` where it does not increase."""
    array = as_finite(name, values)
    if array.ndim != 1:
        raise DataError(f"{name} is not a series", found=f"shape {array.shape}", needed="1-D")
    if any_sample(lambda part: array[1:][part] <= array[:-1][part], array.size - 1, array):
        bad = np.concatenate([[False], np.diff(array) <= 0])
        _refuse(name, array, bad, "not above the one before", "strictly increasing numbers")
    return array


def as_same_shape(**named: ArrayLike) -> tuple[Floats, ...]:
    """Return the arrays as float64, or raise `DataError` where their shapes differ."""
    arrays = {name: np.asarray(values, dtype=np.float64) for name, values in named.items()}
    shapes = {array.shape for array in arrays.values()}
    if len(shapes) > 1:
        found = ", ".join(f"{name} {array.shape}" for name, array in arrays.items())
        raise DataError("series do not pair up", found=found, needed="equal shapes")
    return tuple(arrays.values())


def as_spread(name: str, value: float) -> float:
    """Return a standard uncertainty, or raise `SettingsError` where it is negative or unknown."""
    if not (np.isfinite(value) and value >= 0):
        raise SettingsError(
            f"the standard uncertainty of {name} cannot be used",
            found=f"{value:g}",
            needed="zero or more",
        )
    return float(value)
