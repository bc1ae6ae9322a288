"""The uncertainty budget of one number of an archive: which one is meant, and its parts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from reduction.archive.budgetplaces import (
    ON_AN_AXIS,
    find_place,
    label_of,
    place_name,
    read_at,
    where_known,
    words_of,
)
from reduction.archive.freedom import random_freedom
from reduction.archive.shared import SHARED_OF_CHANNELS, components_of
from reduction.errors import ArchiveError, SettingsError
from reduction.record import Floats
from reduction.uncertainty.budget import Budget, budget_of
from reduction.uncertainty.product import Component

_CONTRIBUTION = "_uncertainty_contribution"
_RANDOM = "_random_standard_uncertainty"
_U = "_standard_uncertainty"
_NAMES = ("{}", "test_{}", "{}_coefficient")
# where the archive says why there is no number
_REASONS = {"property": "property_remark", "hold": "hold_refusal", "held_pair": "static_refusal"}


def quantities_with_budget(archive: xr.Dataset) -> tuple[str, ...]:
    """Names of the numbers that an archive keeps the shared errors of; channels are none."""
    return tuple(
        str(name).removesuffix(_CONTRIBUTION)
        for name in archive.variables
        if str(name).endswith(_CONTRIBUTION)
        and str(name).removesuffix(_CONTRIBUTION) not in SHARED_OF_CHANNELS
    )


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
    name = next((one for pattern in _NAMES if (one := pattern.format(quantity)) in known), None)
    if name is None:
        raise _no_budget(archive, quantity, known)
    variable = archive.variables[name]
    dims = [str(dim) for dim in variable.dims]
    strange = sorted(set(at) - set(dims) - {place_name(dim) for dim in dims})
    if strange:
        raise SettingsError(
            f"{name} does not vary with {', '.join(strange)}",
            needed="--at " + ", ".join(map(place_name, dims)),
        )
    asked = {dim: at.get(place_name(dim), at.get(dim)) for dim in dims}
    place: dict[str, int] = {}
    for dim, text in asked.items():
        place[dim] = find_place(archive, dim, text, place)
    on_axis = [text for dim, text in asked.items() if dim in ON_AN_AXIS and text is not None]
    strain = float(on_axis[0]) if on_axis else None
    if not np.isfinite(read_at(archive, variable, place, strain)):
        shown = _labels(archive, place, strain)
        raise ArchiveError(
            f"there is no {name} there",
            found=", ".join(f"{place_name(dim)}={text}" for dim, text in shown.items()),
            needed=where_known(archive, variable, place),
            hint=_why_there_is_none(archive, place),
        )
    budget = _budget_at(archive, name, place, strain)
    if np.isnan(budget.standard_uncertainty):
        raise ArchiveError(
            f"the uncertainty of {name} there is not known",
            found="an error, or a scatter, of which it is not kept what it adds",
            hint=_why_there_is_none(archive, place)
            or "The notes of the archive say which; reduce what it was made from again.",
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
    variable = archive.variables[quantity]
    dims = [str(dim) for dim in variable.dims]
    return [
        _budget_at(archive, quantity, dict(zip(dims, map(int, place), strict=True)))
        for place in np.argwhere(np.isfinite(variable.values))
    ]


def _budget_at(
    archive: xr.Dataset, name: str, place: Mapping[str, int], strain: float | None = None
) -> Budget:
    """Budget of one number; with a strain it is read between bins, as a look-up reads it."""
    variable = archive.variables[name]
    contribution = archive.variables[f"{name}{_CONTRIBUTION}"]
    freedom = np.broadcast_to(random_freedom(archive, name), variable.shape)

    def read(values: xr.Variable) -> Floats:
        return read_at(archive, values, place, strain)

    components = components_of(archive, place.get("experiment"))
    rows = read(contribution)
    found: dict[Component, float] = {
        one: float(value)
        for one, value in zip(components, rows, strict=False)
        if one.source and value != 0
    }
    few = read(xr.Variable(variable.dims, 1 / freedom))
    return budget_of(
        name,
        str(variable.attrs.get("units", "")),
        float(read(variable)),
        found,
        random=float(read(archive.variables[f"{name}{_RANDOM}"])),
        degrees_of_freedom=float(np.divide(1, few, out=np.array(np.inf), where=few > 0)),
        place=_labels(archive, place, strain),
        words={dim: words_of(archive, dim, index, place, strain) for dim, index in place.items()},
    )


def _labels(archive: xr.Dataset, place: Mapping[str, int], on_axis: float | None) -> dict[str, str]:
    """Label of each place; a strain or a tension as it was asked for."""
    found = {}
    for dim, index in place.items():
        label = label_of(archive, dim, index)
        if on_axis is not None and dim in ON_AN_AXIS:
            label = float(on_axis)
        found[dim] = f"{label:.6g}" if isinstance(label, float) else str(label)
    return found


def _why_there_is_none(archive: xr.Dataset, place: Mapping[str, int]) -> str:
    """What the archive itself says of a number that is missing, or not known; else nothing."""
    said = [
        str(archive.variables[name].values[place[dim]])
        for dim, name in _REASONS.items()
        if dim in place and name in archive
    ]
    told = "; ".join(filter(None, said))
    return f"The archive says: {told}." if told else ""


def _no_budget(archive: xr.Dataset, quantity: str, known: Sequence[str]) -> SettingsError:
    """Why a quantity has no budget: not there, or not shared."""
    of_archive = next(
        (one for pattern in _NAMES if (one := pattern.format(quantity)) in archive), None
    )
    why = "is not in this archive" if of_archive is None else "has no shared part"
    return SettingsError(
        f"{quantity} {why}", needed="one of " + (", ".join(known) or "none: no error is shared")
    )
