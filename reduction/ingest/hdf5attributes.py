"""Attributes in an HDF5 file: units and other texts, their type looked at before they are read."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import h5py  # type: ignore[import-untyped]
import numpy as np
from numpy.typing import NDArray

from reduction.errors import LogError

_UNIT_KEYS = ("units", "unit", "Units", "Unit")
_LONGEST_UNIT = 200
_PLAIN_CLASSES = (h5py.h5t.INTEGER, h5py.h5t.FLOAT, h5py.h5t.STRING, h5py.h5t.ENUM)
_LARGEST = 1 << 20  # bytes; texts of any length stand elsewhere


def is_plain_attribute(item: h5py.Group | h5py.Dataset, name: str) -> bool:
    """Whether an attribute that is there is of numbers or texts, as long as a file has them.

    Of others, rows of any length above all, the library takes what a damaged file states at its
    word, and the process may end.
    """
    found = item.attrs.get_id(name)
    if found.get_type().get_class() not in _PLAIN_CLASSES or found.get_storage_size() > _LARGEST:
        return False
    try:
        np.dtype(found.dtype)
    except (TypeError, ValueError):  # letters of no encoding, a float with more bits than numpy has
        return False
    return True


def plain_attribute(path: Path, item: h5py.Group | h5py.Dataset, name: str) -> NDArray[Any] | None:
    """Value of an attribute, None where it is not there; `LogError` where it is not a plain one."""
    if name not in item.attrs:
        return None
    if not is_plain_attribute(item, name):
        raise LogError(
            path, f"the attribute '{name}' of '{item.name}' cannot be read",
            found="a type that is neither number nor text", needed="an intact file",
        )  # fmt: skip
    return np.asarray(item.attrs[name])


def unit_attribute(path: Path, dataset: h5py.Dataset) -> str:
    """Unit that a data set states; empty text where it states none."""
    for key in _UNIT_KEYS:
        found = plain_attribute(path, dataset, key)
        if found is not None:
            text = "".join(
                v.decode(errors="replace") if isinstance(v, bytes) else str(v)
                for v in found.ravel()[:1].tolist()
            )
            return text[:_LONGEST_UNIT]  # longer than any: refused as another unit
    return ""
