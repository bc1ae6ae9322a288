"""A reduced test as one flat dataset that follows CF, and every part of it by name."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from reduction.archive.attributes import global_attributes
from reduction.archive.curves import (
    curve_values,
    elastomer_values,
    first_loading_values,
    ratio_values,
    segment_values,
    stress_at_strain_values,
)
from reduction.archive.holds import hold_values, standstill_values
from reduction.archive.line import line_values, pull_values
from reduction.archive.notes import note_values
from reduction.archive.per_cycle import (
    amplitude_values,
    cycle_values,
    end_modulus_values,
    identity_values,
    loop_values,
    slip_values,
    trend_values,
)
from reduction.archive.samples import row_account, sample_values
from reduction.archive.schema import schema_of
from reduction.archive.specimens import history_values, specimen_values, strain_model_values
from reduction.archive.steps import stepwise_values
from reduction.archive.values import Values
from reduction.archive.variable import Variable
from reduction.errors import ArchiveError
from reduction.product import ReducedTest

__all__ = ["to_dataset"]

_COMPRESSED_FROM = 4096  # values; below it a chunk and its index cost more than they save
_CHUNK = 65536


def to_dataset(test: ReducedTest, *, version: str, command: str) -> xr.Dataset:
    """Bring a reduced test into the form of the archive; no file is touched.

    Parameters
    ----------
    test : ReducedTest
        All that one log gave.
    version : str
        Version of this software.
    command : str
        What the user asked for, without paths, jobs and scheduler.

    Returns
    -------
    dataset : xarray.Dataset
        Names, dimensions and attributes of `reduction.archive.schema`, encoding
        included. Equal inputs give equal datasets.

    Raises
    ------
    ArchiveError
        If an array does not have the dimensions of its name, or a name is unknown.
    """
    schema = schema_of(is_stepwise=test.stepwise is not None)
    values = _all_values(test)
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
        attrs=global_attributes(test, version=version, command=command),
    )


def _all_values(test: ReducedTest) -> Values:
    names = tuple(one.name for one in test.specimens)
    values = specimen_values(test.specimens) | note_values(test)
    if test.stepwise is not None:
        values |= stepwise_values(test.stepwise)
    elif test.record is not None:
        values |= row_account(test.record) | sample_values(test, test.record)
    if test.history is not None:
        values |= history_values(test.history)
    if test.strain_models:
        values |= strain_model_values(test.strain_models)
    if test.standstills is not None:
        values |= standstill_values(test.standstills)
    if test.cycles is not None:
        values |= cycle_values(test.cycles, control=test.description.control)
    if test.loops is not None:
        values |= loop_values(test.loops)
    if test.end_moduli is not None:
        values |= end_modulus_values(test.end_moduli)
    if test.identity is not None:
        values |= identity_values(test.identity)
    if test.amplitude is not None:
        values |= amplitude_values(test.amplitude)
    if test.line is not None and test.line_of_test is not None:
        values |= line_values(test.line, test.line_of_test, test.quasi_static_standard_uncertainty)
    if any(test.pulls):
        values |= pull_values(test.pulls, test.specimens)
    if test.trend is not None:
        values |= trend_values(test.trend)
    if test.slips is not None:
        values |= slip_values(test.slips, specimens=names)
    if test.curves is not None:
        values |= curve_values(test.curves)
    if test.first_loading is not None:
        values |= first_loading_values(test.first_loading)
    if test.segments is not None:
        values |= segment_values(test.segments)
    if test.ratios:
        values |= ratio_values(test.ratios)
    if test.elastomers:
        values |= elastomer_values(test.elastomers)
    if test.holds:
        values |= hold_values(test.holds)
    stress, spread = test.stress_at_strain, test.stress_at_strain_standard_uncertainty
    if stress is not None and spread is not None:
        values |= stress_at_strain_values(stress, spread, test.stress_at_strain_levels)
    for name in ("slack_strain_at_unloading", "slack_strain_at_unloading_standard_uncertainty"):
        if getattr(test, name) is not None:
            values[name] = getattr(test, name)
    return values


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
    return xr.Variable(
        row.dims,
        array if row.is_text else array.astype(row.dtype, copy=False),
        attrs=_attributes(row, present),
        encoding=_encoding(array, row, auxiliary),
    )


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
    if row.is_text:
        return {"dtype": "S1", "char_dim_name": f"{row.name}_strlen"}
    is_coordinate = row.is_bounds or row.name == "time" or row.dims == (row.name,)
    has_gaps = row.dtype == "f8" and not is_coordinate
    encoding: dict[str, Any] = {"dtype": row.dtype, "_FillValue": np.nan if has_gaps else None}
    # labels are not listed: they have the names of their dimensions, by which a reader finds
    # them, and CF advises against listing an array that shares the name of its dimension
    if auxiliary and auxiliary in row.dims and row.name != "time":
        encoding["coordinates"] = "time"
    if array.size >= _COMPRESSED_FROM:
        rows = (1,) * (array.ndim - 1)
        encoding |= {
            "zlib": True,
            "complevel": 1,
            "shuffle": True,
            "chunksizes": (*rows, min(array.shape[-1], _CHUNK)),
        }
    return encoding
