"""What a table needs beside the variables of an archive, made from them."""

from __future__ import annotations

import numpy as np
import xarray as xr

from reduction.tables.table import Variables
from reduction.vocabulary import BRANCH_NAMES


def edges_of_bins(archive: xr.Dataset) -> Variables:
    """Give each bin of strain its edges as columns."""
    edges = archive.variables["strain_bin_bounds"]
    return {"strain_bin_low": edges[:, 0], "strain_bin_high": edges[:, 1]}


def cycle_count(archive: xr.Dataset) -> Variables:
    """Count the cycles."""
    return {"n_cycles": xr.Variable((), archive.sizes.get("cycle", 0))}


def chords_of_branches(archive: xr.Dataset) -> Variables:
    """Give each branch a column of its own, so that a cycle stays one row."""
    if "chord_modulus" not in archive:
        return {}
    return {
        f"chord_modulus_{branch}{suffix}": archive.variables[f"chord_modulus{suffix}"][:, :, index]
        for index, branch in enumerate(BRANCH_NAMES)
        for suffix in ("", "_standard_uncertainty")
    }


def fit_of_parameters(archive: xr.Dataset) -> Variables:
    """Repeat what is said of a fit beside each of its parameters."""
    fit = archive.variables["elastomer_parameter_fit"].values - 1
    return {
        str(name): xr.Variable("elastomer_parameter", np.asarray(variable.values)[fit])
        for name, variable in archive.variables.items()
        if variable.dims == ("elastomer_fit",)
    }


def one_specimen(archive: xr.Dataset) -> Variables:
    """Leave out the axis of a specimen that is alone."""
    return {
        str(name): variable.isel(specimen=0)
        for name, variable in archive.variables.items()
        if "specimen" in variable.dims
    }
