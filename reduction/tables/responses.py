"""An archive of experiments laid out for tables: what is said of a response, by response.

In the archive each response has variables of its own, since their units differ; a table has
one column, ``response_coefficient [unit]``, and the unit in the row.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from reduction.archive.variable import SUFFIXES
from reduction.units import combined_unit
from reduction.vocabulary import QUANTITIES, RESPONSE_PATTERNS, SURFACE_NAMES


def by_response(archive: xr.Dataset) -> xr.Dataset:
    """Set the responses side by side along a dimension ``response``.

    Parameters
    ----------
    archive : xarray.Dataset
        Of experiments.

    Returns
    -------
    dataset : xarray.Dataset
        What the archive has, and ``response_<what>`` of every response; numbers are NaN
        where an experiment lacks it.  ``run_is_there`` and ``effect_is_there`` are 1 where a
        row of a table belongs, NaN where an experiment is shorter than another, and the plan
        of the runs has its factors alone.
    """
    names = [
        name
        for name in SURFACE_NAMES
        if f"{name}_measured" in archive or f"{name}_transform" in archive
    ]
    units = [QUANTITIES[f"{name}_sigma"].unit for name in names]
    own_units = [QUANTITIES[f"{name}_point_value"].unit for name in names]
    stacked: dict[str, xr.Variable] = {
        "response": xr.Variable("response", np.array(names, dtype=np.str_)),
        "unit": xr.Variable("response", np.array(units, dtype=np.str_)),
        "response_unit": xr.Variable("response", np.array(own_units, dtype=np.str_)),
    }
    for pattern in RESPONSE_PATTERNS:
        what = pattern.name.removeprefix("<response>")
        for own in (what, *(f"{what}{suffix}" for suffix in SUFFIXES)):
            variable = _stacked(archive, names, own)
            if variable is not None:
                stacked[f"response{own}"] = variable
    dataset = archive.assign(stacked)
    if "term_unit_engineering" in archive:
        of_term = archive.variables["term_unit_engineering"].values
        # the unit of a term stands there as what is multiplied, not as what is divided by
        full = [
            [[combined_unit(unit, [str(own)], [-1]) for own in row] for unit in units]
            for row in of_term
        ]
        dims = ("experiment", "response", "term")
        dataset["coefficient_engineering_unit"] = (dims, np.array(full, dtype=np.str_))
    dataset["run_is_there"] = (
        ("experiment", "run"),
        _marked(archive.variables["run_name"].values != ""),
    )
    dataset["run_plan"] = (
        ("experiment", "run", "factor"),
        archive.variables["run_plan"].values[:, :, : archive.sizes["factor"]],
    )
    if "response_effect" in dataset:
        is_column = archive.variables["plan_column_name"].values[:, None, :] != ""
        known = np.isfinite(dataset.variables["response_effect"].values)
        if "response_effect_refusal" in dataset:
            is_refused = dataset.variables["response_effect_refusal"].values != ""
            known |= is_refused[:, :, None] & is_column
        dims = ("experiment", "response", "plan_column")
        dataset["effect_is_there"] = (dims, _marked(known))
    return dataset


def _stacked(archive: xr.Dataset, names: Sequence[str], what: str) -> xr.Variable | None:
    """Set one quantity of every response behind the experiments; None where none has it."""
    given = {name: archive[f"{name}{what}"] for name in names if f"{name}{what}" in archive}
    if not given:
        return None
    first = next(iter(given.values()))
    fill = {"U": "", "f": np.nan}.get(first.dtype.kind, 0)
    missing: NDArray[Any] = np.full(first.shape, fill, dtype=first.dtype)
    rows = [given[name].values if name in given else missing for name in names]
    experiment, *rest = first.dims
    return xr.Variable((experiment, "response", *rest), np.stack(rows, axis=1))


def _marked(present: NDArray[Any]) -> NDArray[Any]:
    return np.where(present, 1.0, np.nan)
