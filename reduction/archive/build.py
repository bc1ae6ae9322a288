"""Arrays by name become a flat dataset that follows CF: dimensions, attributes, encoding."""

from __future__ import annotations

import zlib
from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from reduction.archive.values import Values
from reduction.archive.variable import Variable
from reduction.errors import ArchiveError
from reduction.samples.scratch import let_go

_COMPRESSED_FROM = 4096  # values; below it a chunk and its index cost more than they save
_TRIED = 16384  # values by which it is told how the others compress
_CHUNK = 65536  # values; half a megabyte, which a cycle of a long record costs to read


def build_dataset(
    values: Values, schema: Mapping[str, Variable], *, attributes: Mapping[str, str]
) -> xr.Dataset:
    """Bring arrays into the form of the archive, in the order of the schema.

    Parameters
    ----------
    values : dict of str to ndarray
        By name; one without an entry is left out.
    schema : mapping of str to Variable
        Every name there may be.
    attributes : mapping of str to str
        Global attributes.

    Returns
    -------
    dataset : xarray.Dataset
        Encoding included.

    Raises
    ------
    ArchiveError
        If an array does not have the dimensions of its name, or a name is unknown.
    """
    unknown = sorted(set(values) - set(schema))
    if unknown:
        raise ArchiveError("values without a place in the schema", found=", ".join(unknown))
    # zero-length dimensions turn unlimited in a file, so what is empty is left out
    present = {name: values[name] for name in schema if name in values and values[name].size}
    sizes = _sizes(present, schema)
    auxiliary = next((schema["time"].dims[0] for name in present if name == "time"), "")
    variables = {
        name: _variable(array, schema[name], present, auxiliary) for name, array in present.items()
    }
    coordinates = {name for name in variables if name == "time" or name in sizes}
    return xr.Dataset(
        data_vars={name: one for name, one in variables.items() if name not in coordinates},
        coords={name: one for name, one in variables.items() if name in coordinates},
        attrs=dict(attributes),
    )


def _sizes(values: Values, schema: Mapping[str, Variable]) -> dict[str, int]:
    """Length of every dimension; refuse an array that does not fit the others."""
    sizes: dict[str, int] = {}
    for name, array in values.items():
        dims = schema[name].dims
        fits = array.ndim == len(dims) and all(
            sizes.setdefault(dim, length) == length
            for dim, length in zip(dims, array.shape, strict=True)
        )
        if not fits:
            needed = ", ".join(f"{dim} {sizes.get(dim, '?')}" for dim in dims)
            raise ArchiveError(
                f"{name} does not fit its dimensions",
                found=f"shape {array.shape}",
                needed=needed or "a scalar",
            )
    return sizes


def _variable(array: NDArray[Any], row: Variable, present: Values, auxiliary: str) -> xr.Variable:
    made = xr.Variable(
        row.dims,
        array if row.is_text else array.astype(row.dtype, copy=False),
        attrs=_attributes(row, present),
        encoding=_encoding(array, row, auxiliary),
    )
    let_go(array)
    return made


def _attributes(row: Variable, present: Values) -> dict[str, Any]:
    if row.is_bounds:
        return {}
    attributes: dict[str, Any] = {"long_name": row.long_name}
    if row.standard_name is not None:
        attributes["standard_name"] = row.standard_name
    if row.flags:
        kind = "flag_masks" if row.is_mask else "flag_values"
        attributes[kind] = np.array(list(row.flags.values()), dtype=row.dtype)
        attributes["flag_meanings"] = " ".join(row.flags)
    elif not row.is_text:
        attributes["units"] = row.unit
    companions = [name for name in row.ancillary if name in present]
    if companions:
        attributes["ancillary_variables"] = " ".join(companions)
    if row.bounds in present:
        attributes["bounds"] = row.bounds
    return attributes


def _encoding(array: NDArray[Any], row: Variable, auxiliary: str) -> dict[str, Any]:
    # labels are not listed: they have the names of their dimensions, by which a reader finds
    # them, and CF advises against listing an array that shares the name of its dimension
    is_beside = auxiliary and auxiliary in row.dims and row.name != "time"
    listed = {"coordinates": "time"} if is_beside else {}
    if row.is_text:
        return {"dtype": "S1", "char_dim_name": f"{row.name}_strlen"} | listed
    is_coordinate = row.is_bounds or row.name == "time" or row.dims == (row.name,)
    has_gaps = row.dtype == "f8" and not is_coordinate
    encoding: dict[str, Any] = {"dtype": row.dtype, "_FillValue": np.nan if has_gaps else None}
    encoding |= listed
    if array.size >= _COMPRESSED_FROM:
        encoding |= {
            "zlib": True,
            "complevel": 1,
            "shuffle": _is_smaller_shuffled(array),
            "chunksizes": _chunk_sizes(array.shape),
        }
    return encoding


def _is_smaller_shuffled(array: NDArray[Any]) -> bool:
    """Whether like bytes of its numbers together compress to less than the numbers as they are.

    They do where every number is another.  What a converter of 12 or 16 bits gave is made of few
    numbers that come again as a whole, which takes half the room and half the time.
    """
    if array.size < _CHUNK:
        return True
    quarter = array.size // 4  # within the first of two specimens
    tried = array.reshape(-1)[quarter : quarter + _TRIED]
    octets = np.frombuffer(tried.tobytes(), dtype=np.uint8).reshape(tried.size, tried.itemsize)
    shuffled, plain = (len(zlib.compress(one.tobytes(), 1)) for one in (octets.T, octets))
    return shuffled <= plain


def _chunk_sizes(shape: tuple[int, ...]) -> tuple[int, ...]:
    """Chunk of `_CHUNK` values at most: the last dimension first, then as much of those before.

    By the last dimension alone a table of many cycles and two branches would be of chunks of
    two values.
    """
    sizes: list[int] = []
    left = _CHUNK
    for length in reversed(shape):
        sizes.append(min(length, left))
        left //= sizes[-1]
    return tuple(reversed(sizes))
