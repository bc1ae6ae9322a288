"""Whether numbers of a MATLAB file, once they have the class it states, are those it stores."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import zip_longest
from typing import Any

import numpy as np
from numpy.typing import NDArray


def has_narrow_numbers(value: Any) -> bool:
    """Whether numbers in it, at any depth, are of a class that does not hold every stored one.

    Parameters
    ----------
    value : Any
        A variable as `scipy.io.loadmat` gives it.

    Returns
    -------
    is_narrow : bool
        Of other classes than double: numbers stored as doubles lose their fractions in a class of
        whole numbers, and no word is said.

    Examples
    --------
    >>> has_narrow_numbers(np.array([1.5])), has_narrow_numbers(np.array([1], dtype=np.int8))
    (False, True)
    """
    return any(numbers.dtype != np.float64 for numbers in _numbers(value))


def equal_numbers(value: Any, stored: Any) -> bool:
    """Whether all numbers in two values are the same, whatever their types.

    Parameters
    ----------
    value, stored : Any
        A variable as `scipy.io.loadmat` gives it, by its class and as it is stored.

    Returns
    -------
    are_equal : bool
        NaN counts as NaN.

    Examples
    --------
    >>> equal_numbers(np.array([2], dtype=np.int8), np.array([2.96]))
    False
    """
    return all(
        one is not None and other is not None and np.array_equal(one, other, equal_nan=True)
        for one, other in zip_longest(_numbers(value), _numbers(stored))
    )


def _numbers(value: Any) -> Iterator[NDArray[Any]]:
    """Arrays of numbers in cells and structs, one after the other."""
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
