"""A written archive against the schema, on the file as it lies on the disk.

What `reduction.quantities.names` and its like promise; CF is checked by an outside program.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import netCDF4
import numpy as np
from numpy.typing import NDArray

from reduction.archive.dataset_builder import SCHEMA_NAME, SCHEMA_VERSION
from reduction.archive.open import _schema_of_file
from reduction.quantities.row import GROUPS, Quantity

_BLOCK = 1 << 20  # values of a long variable that are read at a time
_CACHE = 1 << 19  # bytes of the largest chunk
_MOST_IN_ROOT = 40
_REQUIRED = ("title", "history", "raw_file_sha256", "settings", "software_version")


def check_archive(path: Path) -> list[str]:
    """Return what is wrong with an archive file, one sentence a finding.

    Parameters
    ----------
    path : pathlib.Path
        A netCDF file.

    Returns
    -------
    findings : list of str
        Empty where the file keeps every rule.
    """
    with netCDF4.Dataset(path) as file:
        found = list(_global_findings(file))
        for group in (file, *file.groups.values()):
            group.set_auto_maskandscale(False)
            found += _variable_findings(group, file)
        return found


def _global_findings(file: netCDF4.Dataset) -> Iterator[str]:
    if len(file.variables) > _MOST_IN_ROOT:
        yield f"the root has {len(file.variables)} variables"
    for name, group in file.groups.items():
        if getattr(group, "comment", "") != GROUPS.get(name) or group.groups:
            yield f"group {name} is not one of the schema"
    if getattr(file, "schema_name", None) != SCHEMA_NAME:
        yield f"schema_name is not {SCHEMA_NAME}"
    if getattr(file, "schema_version", None) != SCHEMA_VERSION:
        yield f"schema_version is not {SCHEMA_VERSION}"
    for name in _REQUIRED:
        if not getattr(file, name, ""):
            yield f"global attribute {name} is missing"
    for name, dimension in file.dimensions.items():
        if dimension.isunlimited():
            yield f"dimension {name} is unlimited"


def _variable_findings(group: netCDF4.Dataset, file: netCDF4.Dataset) -> Iterator[str]:
    schema = _schema_of_file(file.dimensions)
    own = "" if group is file else group.name
    for name, variable in group.variables.items():
        if name not in schema:
            yield f"{name} is not in the schema"
            continue
        row = schema[name]
        dims = (*row.dims, f"{name}_strlen") if row.is_text else row.dims
        if variable.dimensions != dims:
            yield f"{name} has dimensions {variable.dimensions}, not {dims}"
        is_axis = row.dims == (name,) or row.is_bounds
        if row.group != own and not is_axis:
            yield f"{name} is in group '{own}', not in '{row.group}'"
        yield from _type_findings(name, variable, row)
        if row.flags:
            listed = np.atleast_1d(
                variable.getncattr("flag_masks" if row.is_mask else "flag_values")
            )
            if any(_has_odd(part, listed, row) for part in _parts(variable)):
                yield f"{name} has values without a meaning"
        elif not row.is_bounds and not row.is_text and not getattr(variable, "units", ""):
            yield f"{name} has no units"
        if not row.is_bounds and not getattr(variable, "long_name", ""):
            yield f"{name} has no long_name"


def _type_findings(name: str, variable: netCDF4.Variable[Any], row: Quantity) -> Iterator[str]:
    if variable.dtype is str:
        yield f"{name} holds strings of variable length"
    elif row.is_text:
        if variable.dtype != np.dtype("S1"):
            yield f"{name} is not text"
        if getattr(variable, "_Encoding", "") != "utf-8":
            yield f"{name} does not say that it is utf-8"
    elif variable.dtype != np.dtype(row.dtype):
        yield f"{name} has type {variable.dtype}, not {row.dtype}"


def _parts(variable: netCDF4.Variable[Any]) -> Iterator[NDArray[Any]]:
    """Values of a variable, a long one by blocks of its last dimension."""
    if not variable.ndim:
        yield np.asarray(variable[...])
        return
    if variable.chunking() != "contiguous":
        variable.set_var_chunk_cache(_CACHE)  # each chunk is read once
    for start in range(0, variable.shape[-1], _BLOCK):
        yield np.asarray(variable[..., start : start + _BLOCK])


def _has_odd(stored: NDArray[Any], listed: NDArray[Any], row: Quantity) -> bool:
    if row.is_mask:
        allowed = np.bitwise_or.reduce(listed)
        return bool(np.bitwise_or.reduce(stored, axis=None) & ~allowed)
    return not np.isin(stored, listed).all()
