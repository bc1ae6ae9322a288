"""Change-in-length properties of the ropes of a campaign as a dataset that follows CF.

Along ``property``, one entry for each property, pair of tensions and specimen.  A stiffness and a
strain have names of their own; the one that an entry is not is NaN.  An entry without a number is
kept, and ``property_remark`` says why.  Where errors are shared, each is an entry along
``uncertainty_component``, and its signed contribution stands beside the random part.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import chain

import numpy as np
import xarray as xr

from reduction.archive.attributes import part_attributes
from reduction.archive.build import build_dataset
from reduction.archive.shared import COMPONENT, SHARED_ROWS, component_values
from reduction.archive.values import Values, numbers, texts
from reduction.archive.variable import Variable, companion, count, label, measured, stated
from reduction.errors import ArchiveError
from reduction.line.propertyproduct import ChangeInLength
from reduction.provenance import Origin
from reduction.record import Floats
from reduction.uncertainty.combine import combined_standard_uncertainty
from reduction.uncertainty.product import Component

_ALONG = ("property",)
_U = "_standard_uncertainty"
_OF_STEP = "as the step has it"
_MEASURED = ("property_stiffness", "property_stiffness_over_strength", "property_strain")

PROPERTY_SCHEMA: dict[str, Variable] = {
    row.name: row
    for row in chain(
        count("property", _ALONG),
        label("property_specimen", _ALONG),
        label("property_name", _ALONG),
        label("property_test", _ALONG),
        stated("property_low_tension", _ALONG, _OF_STEP),
        stated("property_high_tension", _ALONG, _OF_STEP),
        stated("property_reference_time", _ALONG, "setting"),
        *(measured(name, _ALONG) for name in _MEASURED),
        *(stated(f"{name}_degrees_of_freedom", _ALONG, "count") for name in _MEASURED),
        label("property_remark", _ALONG),
        # the axis of the shared errors, and what each of them is
        [row for row in SHARED_ROWS if row.dims == (COMPONENT,)],
        *(
            (
                companion(name, "_random_standard_uncertainty", _ALONG),
                companion(name, "_uncertainty_contribution", (COMPONENT, *_ALONG)),
            )
            for name in _MEASURED
        ),
    )
}
"""Every variable that an archive of change-in-length properties may have."""


def properties_to_dataset(
    found: Mapping[str, Sequence[ChangeInLength]],
    component: Mapping[tuple[str, str], Sequence[Component]],
    *,
    origin: Origin,
) -> xr.Dataset:
    """Bring properties into the form of the archive; no file is touched.

    Parameters
    ----------
    found : mapping of str to sequence of ChangeInLength
        By specimen; one or more.
    component : mapping of (specimen, step) to sequence of Component
        Shared errors that the contributions of the properties of a step are of.
    origin : Origin
        The campaign, and the archives of the tests that they are from.

    Returns
    -------
    dataset : xarray.Dataset
        Names, dimensions and attributes of `PROPERTY_SCHEMA`, encoding included. Equal inputs
        give equal datasets.

    Raises
    ------
    ArchiveError
        If there is no property, or an attribute has a name that the archive keeps.
    """
    listed = [(specimen, one) for specimen, own in found.items() for one in own]
    if not listed:
        raise ArchiveError("there are no properties to keep", needed="one or more")
    rows = [one for _, one in listed]
    is_stiffness = np.array([one.is_stiffness for one in rows])
    values: Values = {
        "property": np.arange(1, len(rows) + 1),
        "property_specimen": texts([specimen for specimen, _ in listed]),
        "property_name": texts([one.name for one in rows]),
        "property_test": texts([one.step for one in rows]),
        "property_low_tension": numbers([one.low_tension for one in rows]),
        "property_high_tension": numbers([one.high_tension for one in rows]),
        "property_reference_time": numbers([one.reference_time for one in rows]),
        "property_remark": texts([one.reason for one in rows]),
    }
    of_rows = [component.get((specimen, one.step), ()) for specimen, one in listed]
    axis = tuple(sorted({error for own in of_rows for error in own}))
    value = numbers([one.value for one in rows])
    random = numbers([one.random_standard_uncertainty for one in rows])
    over = numbers([one.over_strength for one in rows])
    of_value = _on_axis(axis, of_rows, [one.contribution for one in rows])
    parts = {
        "property_stiffness": (np.where(is_stiffness, value, np.nan), random, of_value),
        "property_stiffness_over_strength": (
            over,
            numbers([one.over_strength_random_standard_uncertainty for one in rows]),
            _on_axis(axis, of_rows, [one.over_strength_contribution for one in rows]),
        ),
        "property_strain": (np.where(is_stiffness, np.nan, value), random, of_value),
    }
    freedom = numbers([one.degrees_of_freedom for one in rows])
    for name, (number, spread, contribution) in parts.items():
        is_given = np.isfinite(number)
        own = np.where(is_given, contribution, np.nan)
        values[name] = number
        values[f"{name}{_U}"] = combined_standard_uncertainty(
            own, np.where(is_given, spread, np.nan)
        )
        values[f"{name}_degrees_of_freedom"] = np.where(is_given, freedom, np.nan)
        if axis:
            values[f"{name}_random{_U}"] = np.where(is_given, spread, np.nan)
            values[f"{name}_uncertainty_contribution"] = own
    if axis:
        values |= component_values(axis)
    return build_dataset(
        values,
        PROPERTY_SCHEMA,
        attributes=part_attributes("change_in_length", list(found), origin=origin),
    )


def _on_axis(
    axis: Sequence[Component],
    component: Sequence[Sequence[Component]],
    contribution: Sequence[Floats],
) -> Floats:
    """Contributions to each property on the errors of all, shape (n_components, n_properties)."""
    rows = np.zeros((len(axis), len(contribution)))
    for place, (own, amounts) in enumerate(zip(component, contribution, strict=True)):
        # one without a number has none
        if amounts.size:
            rows[[axis.index(one) for one in own], place] = amounts
    return rows
