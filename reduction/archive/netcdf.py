"""A dataset as a netCDF file: everything is defined first, then written, long series by blocks.

What `xarray.Dataset.to_netcdf` writes is the same to a reader.  It defines and writes one variable
after the other, which takes three times as long for an archive of hundreds of short ones, and hands
a series over whole.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import netCDF4
import numpy as np
import xarray as xr
from numpy.typing import NDArray

from reduction.samples.blocks import sample_blocks
from reduction.samples.scratch import let_go

_BLOCK = 1 << 20  # values of the last dimension at a time: whole chunks
_CACHE = 1 << 19  # bytes of the largest chunk: each is written once


def write_netcdf(dataset: xr.Dataset, path: Path) -> None:
    """Write a dataset of `reduction.archive.build.build_dataset`.

    Parameters
    ----------
    dataset : xarray.Dataset
        With encoding.
    path : pathlib.Path
        The file; one that is there is replaced.

    Raises
    ------
    OSError, RuntimeError
        If the disk refuses; the library says it in one of these ways.
    """
    with netCDF4.Dataset(path, "w", format="NETCDF4") as file:
        file.setncatts(dataset.attrs)
        for name, size in dataset.sizes.items():
            file.createDimension(str(name), size)
        todo = [
            (_defined(file, str(name), variable), variable.values)
            for name, variable in dataset.variables.items()
        ]
        for place, values in todo:
            if values.dtype.kind == "U":
                place[...] = _characters(values)
            else:
                for part in _parts(values):
                    place[part] = values[part]
                let_go(values)


def _defined(file: netCDF4.Dataset, name: str, variable: xr.Variable) -> netCDF4.Variable[Any]:
    """Define a variable as its encoding says."""
    encoding, dims = variable.encoding, tuple(str(dim) for dim in variable.dims)
    attributes = dict(variable.attrs)
    kind: Any = variable.dtype
    if variable.dtype.kind == "U":
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
    # with the sum of each chunk the library refuses values that are not as they were written; a
    # short variable would take several times its size in chunks
    place = file.createVariable(
        name, kind, dims, fill_value=encoding.get("_FillValue"), fletcher32=bool(options), **options
    )
    if options:
        place.set_var_chunk_cache(_CACHE)
    place.set_auto_maskandscale(False)
    place.set_auto_chartostring(False)
    place.setncatts(attributes)
    return place


def _characters(values: NDArray[np.str_]) -> NDArray[np.bytes_]:
    """Text as bytes of UTF-8 along one more dimension."""
    encoded = np.char.encode(values, "utf-8")
    letters = encoded.astype(f"S{max(encoded.dtype.itemsize, 1)}")
    return np.ascontiguousarray(letters).view("S1").reshape(*values.shape, letters.dtype.itemsize)


def _parts(values: NDArray[Any]) -> Iterator[tuple[Any, ...]]:
    """Blocks of a series, or all of what is short."""
    if not values.ndim or values.shape[-1] <= _BLOCK:
        yield (...,)
        return
    for part in sample_blocks(values.shape[-1], values, size=_BLOCK):
        yield (..., part)
