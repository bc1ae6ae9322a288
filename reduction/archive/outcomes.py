"""Outcomes without a log as a dataset that follows CF, and back.

Along ``outcome``, one entry a row of the table of results.  A value stands under the name of its
quantity, with its unit; it is NaN under the names of the others.  What no row says is absent.
``outcome_use`` is what statistics make of the value: a break in the termination and a test that
was stopped are lower bounds.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain
from typing import Any, get_args

import numpy as np
import xarray as xr

from reduction.archive.attributes import part_attributes
from reduction.archive.build import build_dataset
from reduction.archive.reasons import NO_YES, STATED
from reduction.archive.values import Values, numbers, texts
from reduction.archive.variable import Variable, count, flag, label, stated
from reduction.errors import ArchiveError
from reduction.outcomes.product import Outcome, OutcomeQuantity, Place
from reduction.provenance import Origin

_ALONG = ("outcome",)
_QUANTITIES: tuple[OutcomeQuantity, ...] = get_args(OutcomeQuantity)
_PLACES: tuple[Place, ...] = get_args(Place)
_USES = {"value": 0, "lower_bound": 1, "excluded": 2}
_TEXTS = ("test", "specimen", "line", "material", "construction", "condition", "mode", "note")
_NUMBERS = (
    "diameter", "exposure", "minimum_load", "peak_load", "minimum_load_ratio", "peak_load_ratio",
)  # fmt: skip
_COMPANIONS = ("outcome_use",)

OUTCOME_SCHEMA: dict[str, Variable] = {
    row.name: row
    for row in chain(
        count("outcome_row", _ALONG),
        flag("outcome_quantity", _ALONG, {name: code for code, name in enumerate(_QUANTITIES)}),
        *(stated(name, _ALONG, STATED, ancillary=_COMPANIONS) for name in _QUANTITIES),
        flag("outcome_use", _ALONG, _USES),
        *(label(f"outcome_{name}", _ALONG) for name in _TEXTS),
        *(stated(f"outcome_{name}", _ALONG, STATED) for name in _NUMBERS),
        flag("outcome_place", _ALONG, {name: code for code, name in enumerate(_PLACES)}),
        flag("outcome_is_valid", _ALONG, NO_YES),
        flag("outcome_is_suspended", _ALONG, NO_YES),
    )
}
"""Every variable that an archive of outcomes may have."""


def outcomes_to_dataset(outcomes: Sequence[Outcome], *, origin: Origin) -> xr.Dataset:
    """Bring outcomes into the form of the archive; no file is touched.

    Parameters
    ----------
    outcomes : sequence of Outcome
        One or more, in the order of the table of results.
    origin : Origin
        The campaign, and the table of results as the only source.

    Returns
    -------
    dataset : xarray.Dataset
        Names, dimensions and attributes of `OUTCOME_SCHEMA`, encoding included. Equal inputs
        give equal datasets.

    Raises
    ------
    ArchiveError
        If there is no outcome, or an attribute has a name that the archive keeps.
    """
    if not outcomes:
        raise ArchiveError("there are no outcomes to keep", needed="one or more")
    values: Values = {
        "outcome_row": np.array([one.row for one in outcomes]),
        "outcome_quantity": np.array([_QUANTITIES.index(one.quantity) for one in outcomes]),
        "outcome_use": np.array([_USES[one.use] for one in outcomes]),
        "outcome_place": np.array([_PLACES.index(one.place) for one in outcomes]),
        "outcome_is_valid": np.array([one.is_valid for one in outcomes]),
        "outcome_is_suspended": np.array([one.is_suspended for one in outcomes]),
    }
    for quantity in _QUANTITIES:
        own = [one.value if one.quantity == quantity else None for one in outcomes]
        values[quantity] = numbers(own)
    for name in _TEXTS:
        values[f"outcome_{name}"] = texts([getattr(one, name) for one in outcomes])
    for name in _NUMBERS:
        values[f"outcome_{name}"] = numbers([getattr(one, name) for one in outcomes])
    return build_dataset(
        {name: array for name, array in values.items() if _says_something(array)},
        OUTCOME_SCHEMA,
        attributes=part_attributes("outcomes", origin=origin),
    )


def _says_something(array: np.ndarray[Any, np.dtype[Any]]) -> bool:
    if array.dtype.kind == "U":
        return any(array)
    return array.dtype.kind != "f" or bool(np.isfinite(array).any())


def outcomes_of_dataset(dataset: xr.Dataset) -> tuple[Outcome, ...]:
    """Return the outcomes that an archive holds, as they were.

    Parameters
    ----------
    dataset : xarray.Dataset
        From `reduction.archive.open.open_archive`.

    Returns
    -------
    outcomes : tuple of Outcome
        In the order of the table of results.

    Raises
    ------
    ArchiveError
        If it is no archive of outcomes.
    """
    if "outcome" not in dataset.sizes:
        raise ArchiveError(
            "the archive holds no outcomes", found=", ".join(map(str, dataset.sizes))
        )
    size = dataset.sizes["outcome"]

    def column(name: str, missing: object) -> list[Any]:
        # tolist gives numbers of Python, which print and compare as those that were read
        return dataset.variables[name].values.tolist() if name in dataset else [missing] * size

    quantity = [_QUANTITIES[code] for code in column("outcome_quantity", 0)]
    by_quantity = {name: column(name, np.nan) for name in _QUANTITIES}
    kept: dict[str, list[Any]] = {name: column(f"outcome_{name}", "") for name in _TEXTS}
    kept |= {name: column(f"outcome_{name}", np.nan) for name in _NUMBERS}
    kept |= {
        "quantity": quantity,
        "value": [by_quantity[name][place] for place, name in enumerate(quantity)],
        "place": [_PLACES[code] for code in column("outcome_place", 0)],
        "is_valid": [bool(value) for value in column("outcome_is_valid", 1)],
        "is_suspended": [bool(value) for value in column("outcome_is_suspended", 0)],
        "row": column("outcome_row", 0),
    }
    return tuple(
        Outcome(**dict(zip(kept, row, strict=True))) for row in zip(*kept.values(), strict=True)
    )
