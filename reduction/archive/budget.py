"""The uncertainty budget of one number of an archive: which one is meant, and its parts."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from reduction.archive.freedom import random_freedom
from reduction.archive.shared import SHARED_OF_CHANNELS, components_of
from reduction.errors import ArchiveError, SettingsError
from reduction.moduli.interpolation import curve_at
from reduction.record import Floats
from reduction.uncertainty.budget import Budget, budget_of
from reduction.uncertainty.product import Component

__all__ = [
    "all_budgets",
    "budget_from_archive",
    "place_name",
    "quantities_with_budget",
]

_CONTRIBUTION = "_uncertainty_contribution"
_RANDOM = "_random_standard_uncertainty"
# what a user calls a dimension; no quantity has two of one name
_CALLED = {"branch_name": "branch", "strain_bin": "strain", "first_loading_strain_bin": "strain",
           "ratio_strain_bin": "strain"}  # fmt: skip
_ROUNDING = 1e-9
_ON_AN_AXIS = ("strain_bin", "first_loading_strain_bin", "ratio_strain_bin")


def quantities_with_budget(archive: xr.Dataset) -> tuple[str, ...]:
    """Names of the numbers that an archive keeps the shared errors of; channels are none."""
    return tuple(
        str(name).removesuffix(_CONTRIBUTION)
        for name in archive.variables
        if str(name).endswith(_CONTRIBUTION)
        and str(name).removesuffix(_CONTRIBUTION) not in SHARED_OF_CHANNELS
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
        Place along each dimension by label, number, or strain, between bins too; one with a
        single entry may be left out.

    Returns
    -------
    budget : Budget
        Of that number.

    Raises
    ------
    SettingsError
        If the quantity has no budget, or the place is not one number of it.
    ArchiveError
        If there is no number at that place, or it is not known how well it is known.
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
    asked = {dim: at.get(place_name(dim), at.get(dim)) for dim in dims}
    place = {dim: _place(archive, dim, text) for dim, text in asked.items()}
    on_axis = [text for dim, text in asked.items() if dim in _ON_AN_AXIS and text is not None]
    strain = float(on_axis[0]) if on_axis else None
    if not np.isfinite(_at(archive, variable, place, strain)):
        shown = {dim: _shown(_label(archive, dim, index)) for dim, index in place.items()}
        if strain is not None:
            shown |= {dim: f"{strain:.6g}" for dim in dims if dim in _ON_AN_AXIS}
        raise ArchiveError(
            f"there is no {name} there",
            found=", ".join(f"{place_name(dim)}={text}" for dim, text in shown.items()),
            needed=_where_known(archive, variable, place),
        )
    budget = _budget_at(archive, name, place, strain)
    if np.isnan(budget.standard_uncertainty):
        raise ArchiveError(
            f"the uncertainty of {name} there is not known",
            found="an error, or a scatter, of which it is not kept what it adds",
            hint="The notes of the archive say which; reduce what it was made from again.",
        )
    return budget


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


def _budget_at(
    archive: xr.Dataset, name: str, place: Mapping[str, int], strain: float | None = None
) -> Budget:
    """Budget of one number; with a strain it is read between bins, as a look-up reads it."""
    variable = archive[name]
    contribution = archive[f"{name}{_CONTRIBUTION}"]
    freedom = np.broadcast_to(random_freedom(archive, name), variable.shape)

    def read(values: xr.DataArray) -> Floats:
        return _at(archive, values, place, strain)

    components = components_of(archive, place.get("experiment"))
    rows = read(contribution)
    found: dict[Component, float] = {
        one: float(value)
        for one, value in zip(components, rows, strict=False)
        if one.source and value != 0
    }
    labels = {dim: str(_label(archive, dim, index)) for dim, index in place.items()}
    if strain is not None:
        labels |= {dim: f"{strain:.6g}" for dim in place if dim in _ON_AN_AXIS}
    few = read(xr.DataArray(1 / freedom, dims=variable.dims))
    return budget_of(
        name,
        str(variable.attrs.get("units", "")),
        float(read(variable)),
        found,
        random=float(read(archive[f"{name}{_RANDOM}"])),
        degrees_of_freedom=float(np.divide(1, few, out=np.array(np.inf), where=few > 0)),
        place=labels,
    )


def _at(
    archive: xr.Dataset, values: xr.DataArray, place: Mapping[str, int], strain: float | None
) -> Floats:
    """Values at a place, shape (n_components,) or (); between bins where a strain is given."""
    axis = next((dim for dim in place if dim in _ON_AN_AXIS), None)
    if strain is None or axis is None:
        return np.asarray(values.isel(place).values, dtype=np.float64)
    curves = values.isel({dim: index for dim, index in place.items() if dim != axis}).values
    bins = archive[axis].values
    spacing = float(np.min(np.diff(bins), initial=np.inf))
    flat = [
        curve_at(strain, bins, row, spacing=spacing if np.isfinite(spacing) else None)
        for row in curves.reshape(-1, bins.size)
    ]
    return np.array(flat).reshape(curves.shape[:-1])


def _where_known(archive: xr.Dataset, variable: xr.DataArray, place: Mapping[str, int]) -> str:
    """Places along the last dimension that have a number, the others as asked for."""
    dim = str(variable.dims[-1])
    row = variable.isel({one: at for one, at in place.items() if one != dim})
    known = np.flatnonzero(np.isfinite(row.values))
    if not known.size:
        return "another place: there is none at any " + place_name(dim)
    if dim in _ON_AN_AXIS:
        middle = archive[dim].values[known]
        ends = f"{middle[0]:.4g} to {middle[-1]:.4g}"
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
        return _nearest(archive, dim, float(text))
    if text not in labels:
        raise SettingsError(f"there is no {place_name(dim)} '{text}'", needed=shown)
    return labels.index(text)


def _nearest(archive: xr.Dataset, dim: str, strain: float) -> int:
    """Bin whose middle is nearest; nothing is read beyond the first and the last."""
    middle = np.asarray(archive[dim].values, dtype=np.float64)
    rounding = _ROUNDING * float(np.max(np.abs(middle)))
    if not middle.min() - rounding <= strain <= middle.max() + rounding:
        raise SettingsError(
            f"{place_name(dim)} has no bin at {strain:g}",
            needed=f"{middle.min():.4g} to {middle.max():.4g}",
        )
    return int(np.argmin(np.abs(middle - strain)))
