"""Curves of a reduced test as they are looked up: moduli and tensions over strain, slow pulls."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from reduction.archive.freedom import random_freedom
from reduction.archive.shared import components_of
from reduction.archive.stored import stored
from reduction.lookup.line import Branch
from reduction.lookup.product import LineCurve
from reduction.record import Bools

_OVER_STRAIN = ("tangent_modulus", "branch_tension")
_OVER_TENSION = {
    "quasi_static_spring_constant": ("quasi_static_spring_constant", "mean_tension"),
    "quasi_static_strain": ("strain", "tension"),
}
_Parts = dict[str, Any]  # fields of `LineCurve` that say how well it is known
CURVES = (*_OVER_STRAIN, *_OVER_TENSION)
"""Variables of a reduced test that are looked up as curves."""


def curves_of_specimen(dataset: xr.Dataset, place: int) -> tuple[LineCurve, ...]:
    """Curves of one specimen of a reduced test.

    Parameters
    ----------
    dataset : xarray.Dataset
        An archive of a reduced test.
    place : int
        Of the specimen.

    Returns
    -------
    curves : tuple of LineCurve
        None where the test has none.
    """
    return (
        *(
            curve
            for name in _OVER_STRAIN
            if name in dataset
            for curve in _branches(dataset, name, place)
        ),
        *_of_pull(dataset, place),
    )


def _branches(dataset: xr.Dataset, name: str, place: int) -> list[LineCurve]:
    strain = dataset.variables["strain_bin"].values
    curves = []
    branches: tuple[Branch, Branch] = ("ascending", "descending")
    for index, branch in enumerate(branches):
        value = dataset.variables[name].values[place, index]
        seen = np.isfinite(value)
        if seen.sum() < 2:
            continue
        at = strain[seen]
        # bins without a cycle between two that have one are not known
        missing = np.flatnonzero(np.diff(np.flatnonzero(seen)) > 1)
        curves.append(
            LineCurve(
                quantity=name,
                variable="strain",
                low=float(at[0]),
                high=float(at[-1]),
                at=np.array(at),
                value=np.array(value[seen]),
                **_uncertainty(dataset, name, (place, index), seen),
                spread_of="the mean over the cycles of this one test",
                gaps=np.stack([at[missing], at[missing + 1]], axis=1),
                branch=branch,
                notes=(f"gaps between bins, where nothing was measured: {missing.size}",)
                if missing.size
                else (),
            )
        )
    return curves


def _uncertainty(dataset: xr.Dataset, name: str, place: tuple[int, ...], seen: Bools) -> _Parts:
    """Uncertainty of a curve where it was seen, by its parts; nothing where it has none."""
    if f"{name}_standard_uncertainty" not in dataset:
        return {}
    spread = np.asarray(
        dataset.variables[f"{name}_standard_uncertainty"].values[place], dtype=np.float64
    )
    freedom = np.broadcast_to(random_freedom(dataset, name), dataset.variables[name].shape)[place]
    found: _Parts = {
        "standard_uncertainty": spread[seen],
        "degrees_of_freedom": np.array(freedom[seen]),
    }
    own_rows = stored(dataset, f"{name}_uncertainty_contribution")
    if own_rows is None:
        return found
    rows = np.nan_to_num(np.moveaxis(own_rows.values, 0, -1)[place].T)[:, seen]
    touched = np.flatnonzero(rows.any(axis=1))
    component = components_of(dataset)
    return found | {
        "component": tuple(component[row] for row in touched),
        "contribution": rows[touched],
    }


def _of_pull(dataset: xr.Dataset, place: int) -> list[LineCurve]:
    """K_0 and strain of a slow pull, by its cubic, over its range of use."""
    if "pull_strain_coefficient" not in dataset:
        return []
    coefficient = np.array(dataset.variables["pull_strain_coefficient"].values[place])
    if not np.isfinite(coefficient).all():
        return []
    everywhere = np.ones(dataset.sizes["tension_grid"], dtype=bool)
    return [
        LineCurve(
            quantity=name,
            variable=variable,
            low=float(dataset.variables["pull_tension_low"].values[place]),
            high=float(dataset.variables["pull_tension_high"].values[place]),
            coefficient=coefficient,
            is_inverse_slope=name != "strain",
            at=np.array(dataset.variables["tension_grid"].values),
            **_uncertainty(dataset, stored, (place,), everywhere),
            spread_of="the curve of this one pull",
        )
        for stored, (name, variable) in _OVER_TENSION.items()
    ]
