"""Change-in-length properties of the ropes of a campaign as a dataset that follows CF.

Along ``property``, one entry for each property, pair of tensions and specimen.  A stiffness and a
strain have names of their own; the one that an entry is not is NaN.  An entry without a number is
kept, and ``property_remark`` says why.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import chain

import numpy as np
import xarray as xr

from reduction.archive.attributes import part_attributes
from reduction.archive.build import build_dataset
from reduction.archive.values import Values, numbers, texts
from reduction.archive.variable import Variable, count, label, measured, stated
from reduction.errors import ArchiveError
from reduction.line.propertyproduct import ChangeInLength
from reduction.provenance import Origin

__all__ = ["PROPERTY_SCHEMA", "properties_to_dataset"]

_ALONG = ("property",)
_U = "_standard_uncertainty"
_OF_STEP = "as the step has it"

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
        measured("property_stiffness", _ALONG),
        measured("property_stiffness_over_strength", _ALONG),
        measured("property_strain", _ALONG),
        label("property_remark", _ALONG),
    )
}
"""Every variable that an archive of change-in-length properties may have."""


def properties_to_dataset(
    found: Mapping[str, Sequence[ChangeInLength]], *, origin: Origin
) -> xr.Dataset:
    """Bring properties into the form of the archive; no file is touched.

    Parameters
    ----------
    found : mapping of str to sequence of ChangeInLength
        By specimen; one or more.
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
    value = numbers([one.value for one in rows])
    spread = numbers([one.standard_uncertainty for one in rows])
    values: Values = {
        "property": np.arange(1, len(rows) + 1),
        "property_specimen": texts([specimen for specimen, _ in listed]),
        "property_name": texts([one.name for one in rows]),
        "property_test": texts([one.step for one in rows]),
        "property_low_tension": numbers([one.low_tension for one in rows]),
        "property_high_tension": numbers([one.high_tension for one in rows]),
        "property_reference_time": numbers([one.reference_time for one in rows]),
        "property_stiffness": np.where(is_stiffness, value, np.nan),
        f"property_stiffness{_U}": np.where(is_stiffness, spread, np.nan),
        "property_stiffness_over_strength": numbers([one.over_strength for one in rows]),
        f"property_stiffness_over_strength{_U}": numbers(
            [one.over_strength_standard_uncertainty for one in rows]
        ),
        "property_strain": np.where(is_stiffness, np.nan, value),
        f"property_strain{_U}": np.where(is_stiffness, np.nan, spread),
        "property_remark": texts([one.reason for one in rows]),
    }
    return build_dataset(
        values,
        PROPERTY_SCHEMA,
        attributes=part_attributes("change_in_length", list(found), origin=origin),
    )
