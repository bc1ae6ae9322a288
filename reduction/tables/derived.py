"""What a table needs beside the variables of an archive, made from them."""

from __future__ import annotations

import numpy as np
import xarray as xr

from reduction.vocabulary import BRANCH_NAMES

__all__ = [
    "with_chords",
    "with_cycle_count",
    "with_edges",
    "with_fit_of_parameter",
    "with_its_one_specimen",
]


def with_edges(dataset: xr.Dataset) -> xr.Dataset:
    """Give each bin of strain its edges as columns."""
    edges = dataset["strain_bin_bounds"]
    return dataset.assign(strain_bin_low=edges[:, 0], strain_bin_high=edges[:, 1])


def with_cycle_count(dataset: xr.Dataset) -> xr.Dataset:
    """Count the cycles."""
    return dataset.assign(n_cycles=dataset.sizes.get("cycle", 0))


def with_chords(dataset: xr.Dataset) -> xr.Dataset:
    """Give each branch a column of its own, so that a cycle stays one row."""
    if "chord_modulus" not in dataset:
        return dataset
    return dataset.assign(
        {
            f"chord_modulus_{branch}{suffix}": dataset[f"chord_modulus{suffix}"][:, :, index]
            for index, branch in enumerate(BRANCH_NAMES)
            for suffix in ("", "_standard_uncertainty")
        }
    )


def with_fit_of_parameter(dataset: xr.Dataset) -> xr.Dataset:
    """Repeat what is said of a fit beside each of its parameters."""
    fit = dataset.variables["elastomer_parameter_fit"].values - 1
    of_fit = [
        name for name in dataset.variables if dataset.variables[name].dims == ("elastomer_fit",)
    ]
    return dataset.assign(
        {
            name: ("elastomer_parameter", np.asarray(dataset.variables[name].values)[fit])
            for name in of_fit
        }
    )


def with_its_one_specimen(dataset: xr.Dataset) -> xr.Dataset:
    """Leave out the axis of a specimen that is alone."""
    return dataset.isel(specimen=0)
