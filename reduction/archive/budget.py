"""The uncertainty budget of one number of an archive: which one is meant, and its parts."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from reduction.archive.shared import components_of
from reduction.errors import ArchiveError, SettingsError
from reduction.record import Floats
from reduction.uncertainty.budget import Budget, budget_of
from reduction.uncertainty.product import Component

__all__ = [
    "all_budgets",
    "budget_from_archive",
    "degrees_of_freedom",
    "place_name",
    "quantities_with_budget",
]

_CONTRIBUTION = "_uncertainty_contribution"
_RANDOM = "_random_standard_uncertainty"
# what a user calls a dimension; no quantity has two of one name
_CALLED = {"branch_name": "branch", "strain_bin": "strain", "first_loading_strain_bin": "strain",
           "ratio_strain_bin": "strain"}  # fmt: skip
# one of them is a regression on samples, of which there are hundreds
_OF_SAMPLES = frozenset({
    "cycle", "selected_cycle", "hold", "held_pair", "slip", "step", "interval", "tension_grid",
    "break_share", "pull_term", "strain_level", "elastomer_parameter",
    "comparison_point",
})  # fmt: skip
_LINES = ("_per_decade", "_per_cycle", "_change", "_drift")
_ROUNDING = 1e-9
_ON_AN_AXIS = ("strain_bin", "first_loading_strain_bin", "ratio_strain_bin")


def quantities_with_budget(archive: xr.Dataset) -> tuple[str, ...]:
    """Names of what an archive keeps the shared errors of."""
    return tuple(
        str(name).removesuffix(_CONTRIBUTION)
        for name in archive.variables
        if str(name).endswith(_CONTRIBUTION)
    )


def place_name(dim: str) -> str:
    """What a dimension is called where a place along it is asked for: ``branch``, ``strain``."""
    return _CALLED.get(dim, dim)


def budget_from_archive(archive: xr.Dataset, quantity: str, at: Mapping[str, str]) -> Budget:
    """Read the budget of one number.

    Parameters
    ----------
    archive : xarray.Dataset
        Of a reduced test, or of experiments.
    quantity : str
        Of the vocabulary, as the archive names it; without ``test_`` the mean of the test is
        meant where the archive keeps only that.
    at : mapping of str to str
        Place along each dimension by label, number, or strain; one with a single entry may be
        left out.

    Returns
    -------
    budget : Budget
        Of that number.

    Raises
    ------
    SettingsError
        If the quantity has no budget, or the place is not one number of it.
    ArchiveError
        If there is no number at that place.
    """
    known = quantities_with_budget(archive)
    name = next((one for one in (quantity, f"test_{quantity}") if one in known), None)
    if name is None:
        why = "is not in this archive" if quantity not in archive else "has no shared part"
        raise SettingsError(
            f"{quantity} {why}", needed="one of " + (", ".join(known) or "none: no error is shared")
        )
    variable = archive[name]
    dims = [str(dim) for dim in variable.dims]
    strange = sorted(set(at) - set(dims) - {place_name(dim) for dim in dims})
    if strange:
        raise SettingsError(
            f"{name} does not vary with {', '.join(strange)}",
            needed="--at " + ", ".join(map(place_name, dims)),
        )
    place = {dim: _place(archive, dim, at.get(place_name(dim), at.get(dim))) for dim in dims}
    number = float(variable.isel(place))
    if not np.isfinite(number):
        raise ArchiveError(
            f"there is no {name} there",
            found=", ".join(
                f"{place_name(dim)}={_shown(_label(archive, dim, place[dim]))}" for dim in dims
            ),
            needed=_where_known(archive, variable, place),
        )
    return _budget_at(archive, name, place)


def all_budgets(archive: xr.Dataset, quantity: str) -> list[Budget]:
    """Read the budget of every number of a quantity.

    Parameters
    ----------
    archive : xarray.Dataset
        Of a reduced test, or of experiments.
    quantity : str
        As the archive names it.

    Returns
    -------
    budgets : list of Budget
        In the order of the archive; none where nothing is known of its shared errors.
    """
    if quantity not in quantities_with_budget(archive):
        return []
    variable = archive[quantity]
    dims = [str(dim) for dim in variable.dims]
    return [
        _budget_at(archive, quantity, dict(zip(dims, map(int, place), strict=True)))
        for place in np.argwhere(np.isfinite(variable.values))
    ]


def degrees_of_freedom(archive: xr.Dataset, name: str) -> Floats:
    """Degrees of freedom of the random part of a quantity.

    Parameters
    ----------
    archive : xarray.Dataset
        Of a reduced test, or of experiments.
    name : str
        As the archive names it.

    Returns
    -------
    freedom : ndarray, in the shape of the quantity or a single number
        Of the regression where it is a coefficient, infinite where it is one on samples; else
        cycles less one, or two for a line over them, of those that reach the number or of all
        after the break-in; at least 1. [1]
    """
    base = name.removesuffix("_engineering").removesuffix("_coefficient")
    terms = f"{base}_term_degrees_of_freedom"
    if terms in archive:
        return np.asarray(archive[terms].values, dtype=np.float64)
    if f"{name}_count" in archive:
        return np.maximum(np.asarray(archive[f"{name}_count"].values, dtype=np.float64) - 1, 1.0)
    if name in archive and _OF_SAMPLES & set(map(str, archive[name].dims)):
        return np.asarray(np.inf)
    settings = json.loads(str(archive.attrs.get("settings") or "{}"))
    break_in = settings.get("reduction", {}).get("cycles", {}).get("break_in_cycles", 0)
    fitted = 2.0 if name.endswith(_LINES) else 1.0
    return np.asarray(max(archive.sizes.get("cycle", 0) - break_in - fitted, 1.0))


def _budget_at(archive: xr.Dataset, name: str, place: Mapping[str, int]) -> Budget:
    variable = archive[name]
    rows = archive[f"{name}{_CONTRIBUTION}"].isel(place).values
    components = components_of(archive, place.get("experiment"))
    found: dict[Component, float] = {
        one: float(value) for one, value in zip(components, rows, strict=False) if value != 0
    }
    freedom = np.broadcast_to(degrees_of_freedom(archive, name), variable.shape)
    return budget_of(
        name,
        str(variable.attrs.get("units", "")),
        float(variable.isel(place)),
        found,
        random=float(archive[f"{name}{_RANDOM}"].isel(place)),
        degrees_of_freedom=float(freedom[tuple(place[str(dim)] for dim in variable.dims)]),
        place={dim: str(_label(archive, dim, index)) for dim, index in place.items()},
    )


def _where_known(archive: xr.Dataset, variable: xr.DataArray, place: Mapping[str, int]) -> str:
    """Places along the last dimension that have a number, the others as asked for."""
    dim = str(variable.dims[-1])
    row = variable.isel({one: at for one, at in place.items() if one != dim})
    known = np.flatnonzero(np.isfinite(row.values))
    if not known.size:
        return "another place: there is none at any " + place_name(dim)
    if dim in _ON_AN_AXIS:
        bounds = _bounds(archive, dim)
        ends = f"{bounds[known[0], 0]:.4g} to {bounds[known[-1], 1]:.4g}"
        return f"{place_name(dim)} {ends}"
    labels = [str(_label(archive, dim, int(index))) for index in known]
    return f"{place_name(dim)} " + ", ".join(labels[:12]) + (", ..." if len(labels) > 12 else "")


def _shown(label: Any) -> str:
    return f"{label:.6g}" if isinstance(label, float) else str(label)


def _label(archive: xr.Dataset, dim: str, index: int) -> Any:
    return archive[dim].values[index] if dim in archive.variables else index + 1


def _place(archive: xr.Dataset, dim: str, text: str | None) -> int:
    """Index along a dimension of what was asked for."""
    labels = [str(_label(archive, dim, index)) for index in range(archive.sizes[dim])]
    shown = ", ".join(labels[:12]) + (", ..." if len(labels) > 12 else "")
    if text is None:
        if len(labels) == 1:
            return 0
        raise SettingsError(
            f"which {place_name(dim)} is meant is not said",
            needed=f'--at "{place_name(dim)}=..." ({shown})',
        )
    if dim in _ON_AN_AXIS:
        return _bin(archive, dim, float(text))
    if text not in labels:
        raise SettingsError(f"there is no {place_name(dim)} '{text}'", needed=shown)
    return labels.index(text)


def _bounds(archive: xr.Dataset, dim: str) -> Floats:
    """Ends of bins; of a ratio, whose bins are those that two tests share, about their middles."""
    if f"{dim}_bounds" in archive:
        return np.asarray(archive[f"{dim}_bounds"].values)
    middle = archive[dim].values
    # a strain just between two of them is in one of them
    half = np.min(np.diff(middle), initial=np.inf) / 2 * (1 + _ROUNDING)
    return np.stack([middle - half, middle + half], axis=1)


def _bin(archive: xr.Dataset, dim: str, strain: float) -> int:
    bounds = _bounds(archive, dim)
    inside = np.flatnonzero((bounds[:, 0] <= strain) & (strain <= bounds[:, 1]))
    if inside.size == 0:
        raise SettingsError(
            f"{place_name(dim)} has no bin at {strain:g}",
            needed=f"{bounds.min():.4g} to {bounds.max():.4g}",
        )
    return int(inside[0])
