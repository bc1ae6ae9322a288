"""Writes archives: a netCDF file is written completely or not at all."""

from __future__ import annotations

import hashlib
from collections.abc import Hashable, Iterator
from pathlib import Path
from typing import Any

import netCDF4
import numpy as np
import xarray as xr
from numpy.typing import NDArray

from reduction.archive.atomic_write import atomic_file, not_written
from reduction.quantities.row import GROUPS
from reduction.record.errors import ArchiveError
from reduction.record.samples import release_pages, sample_blocks

_BLOCK = 1 << 20  # values along the last dimension written together: whole chunks

_CACHE = 1 << 19  # bytes of the largest chunk: each is written once


def _write_netcdf(dataset: xr.Dataset, path: Path) -> str:
    """Write a dataset from `build_dataset`, and return the checksum of its values."""
    with netCDF4.Dataset(path, "w", format="NETCDF4") as file:
        file.setncatts(dataset.attrs)
        for name, size in dataset.sizes.items():
            file.createDimension(str(name), size)
        placed = sorted(_placed(dataset), key=lambda one: one[0])
        for group in dict.fromkeys(group for group, _ in placed if group):
            file.createGroup(group).setncattr("comment", GROUPS[group])
        todo = [
            (
                _defined(file[group] if group else file, name, dataset.variables[name]),
                dataset.variables[name].values,
            )
            for group, name in placed
        ]
        written = hashlib.sha256()
        for place, values in todo:
            letters = _characters(values) if values.dtype.kind in "UO" else values
            written.update(place.name.encode())
            for part in _parts(letters.shape, letters):
                place[part] = letters[part]
                written.update(letters[part].tobytes())
            release_pages(values)
        file.setncattr("values_sha256", written.hexdigest())
    return written.hexdigest()


def _placed(dataset: xr.Dataset) -> Iterator[tuple[str, str]]:
    """Group and name of each variable; a group has the coordinates missing from the root."""
    groups_of: dict[Hashable, dict[str, None]] = {}
    for variable in dataset.variables.values():
        for dim in variable.dims:
            if (
                variable.dims != (dim,)
                or dim not in dataset.variables
                or (dataset.variables[dim] is not variable)
            ):
                groups_of.setdefault(dim, {})[variable.encoding.get("group", "")] = None
    axes = {name for name, one in dataset.variables.items() if one.dims == (name,)}
    edges = {dataset.variables[axis].attrs.get("bounds"): axis for axis in axes}
    for name, variable in dataset.variables.items():
        axis = name if name in axes else edges.get(name)
        groups = groups_of.get(axis, {}) if axis is not None else {}
        if not groups or "" in groups:
            groups = {"" if groups else variable.encoding.get("group", ""): None}
        for group in groups:
            yield group, str(name)


def values_sha256(path: Path) -> str:
    """Checksum of the names and values of all variables currently in a file."""
    found = hashlib.sha256()
    with netCDF4.Dataset(path) as file:
        for group in (file, *file.groups.values()):
            group.set_auto_maskandscale(False)
            group.set_auto_chartostring(False)
            for name, variable in group.variables.items():
                found.update(name.encode())
                for part in _parts(variable.shape):
                    found.update(np.asarray(variable[part]).tobytes())
    return found.hexdigest()


def _defined(file: netCDF4.Dataset, name: str, variable: xr.Variable) -> netCDF4.Variable[Any]:
    """Define a variable according to its encoding."""
    encoding, dims = variable.encoding, tuple(str(dim) for dim in variable.dims)
    attributes = dict(variable.attrs)
    kind: Any = variable.dtype
    if variable.dtype.kind in "UO":  # labels of a dimension are objects
        length = f"{name}_strlen"
        file.createDimension(length, _characters(variable.values).shape[-1])
        kind, dims = "S1", (*dims, length)
        attributes["_Encoding"] = "utf-8"
    if "coordinates" in encoding:
        attributes["coordinates"] = encoding["coordinates"]
    options = {
        key: encoding[key]
        for key in ("zlib", "complevel", "shuffle", "chunksizes")
        if key in encoding
    }
    # with a checksum per chunk the library refuses corrupted values; a short variable would take
    # several times its size in chunks
    place = file.createVariable(
        name, kind, dims, fill_value=encoding.get("_FillValue"), fletcher32=bool(options), **options
    )
    if options:
        place.set_var_chunk_cache(_CACHE)
    place.set_auto_maskandscale(False)
    place.set_auto_chartostring(False)
    place.setncatts(attributes)
    return place


def _characters(values: NDArray[Any]) -> NDArray[np.bytes_]:
    """Text as UTF-8 bytes along an additional dimension."""
    encoded = np.char.encode(values.astype(np.str_, copy=False), "utf-8")
    letters = encoded.astype(f"S{max(encoded.dtype.itemsize, 1)}")
    return np.ascontiguousarray(letters).view("S1").reshape(*values.shape, letters.dtype.itemsize)


def _parts(shape: tuple[int, ...], *arrays: NDArray[Any]) -> Iterator[tuple[Any, ...]]:
    """Blocks of each series in order, or the whole array if it is short."""
    if not shape or shape[-1] <= _BLOCK:
        yield (...,)
        return
    for row in np.ndindex(shape[:-1]):
        for part in sample_blocks(shape[-1], *arrays, size=_BLOCK):
            yield (*row, part)


def write_archive(dataset: xr.Dataset, path: Path) -> xr.Dataset:
    """Write a dataset from `reduction.archive.test_dataset.to_dataset` as one netCDF file.

    Returns it with the attribute added in writing: the checksum of its values.
    """
    try:
        with atomic_file(path) as part:
            written = _write_netcdf(dataset, part)
        return dataset.assign_attrs(values_sha256=written)
    except ArchiveError:
        raise
    except (OSError, RuntimeError) as error:
        raise not_written(path, error) from error
