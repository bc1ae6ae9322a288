"""What the longest stages gave for arguments that a change did not touch."""

from __future__ import annotations

import hashlib
import pickle
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import fields, is_dataclass
from typing import Any, ParamSpec, TypeVar

import numpy as np

__all__ = ["Memory"]

Given = ParamSpec("Given")
Result = TypeVar("Result")
_MOST_BYTES = 64_000_000
"""Arguments together that are still looked at: of longer ones that would take its own time."""


class Memory:
    """Calls functions of the pipeline, and gives again what equal arguments gave before.

    Results are frozen, so that nobody changes one that is given twice.  A function that raises
    is called again.

    Parameters
    ----------
    most : int
        How many results are kept.
    """

    def __init__(self, most: int = 48) -> None:
        self._most = most
        self._kept: OrderedDict[bytes, Any] = OrderedDict()

    def __call__(
        self, function: Callable[Given, Result], *arguments: Given.args, **named: Given.kwargs
    ) -> Result:
        """Result of a function, as if it were called."""
        if _n_bytes((arguments, named)) > _MOST_BYTES:
            return function(*arguments, **named)
        # nothing is read from it: equal bytes are equal arguments
        said = pickle.dumps((function.__module__, function.__qualname__, arguments, named))
        key = hashlib.sha256(said).digest()
        if key not in self._kept:
            self._kept[key] = function(*arguments, **named)
        self._kept.move_to_end(key)
        while len(self._kept) > self._most:
            self._kept.popitem(last=False)
        result: Result = self._kept[key]
        return result


def _n_bytes(value: Any) -> int:
    """Size of the arrays of an argument."""
    if isinstance(value, np.ndarray):
        return value.nbytes
    if isinstance(value, dict):
        return sum(map(_n_bytes, value.values()))
    if isinstance(value, list | tuple):
        return sum(map(_n_bytes, value))
    if is_dataclass(value):
        return sum(_n_bytes(getattr(value, item.name)) for item in fields(value))
    return 0
