"""What a campaign stated of its instruments, as the archive of a test keeps it in its settings."""

from __future__ import annotations

import json
from dataclasses import fields

import xarray as xr

from reduction.errors import ArchiveError
from reduction.uncertainty.stated import StatedErrors

_ONE_CELL = "has_one_load_cell"


def stated_errors_of(archive: xr.Dataset) -> StatedErrors:
    """Standard uncertainties with which a test was reduced.

    Parameters
    ----------
    archive : xarray.Dataset
        Of a reduced test.

    Returns
    -------
    errors : StatedErrors
        Zero where nothing was stated.

    Raises
    ------
    ArchiveError
        If what stands there is no statement.

    Notes
    -----
    A key that this version does not know is of a later one, and none of its errors.
    """
    settings = json.loads(str(archive.attrs.get("settings") or "{}"))
    kept = settings.get("uncertainty") or {}
    one_cell = kept.get(_ONE_CELL, False)
    if not isinstance(one_cell, bool):
        raise _fault(_ONE_CELL, one_cell, "true or false")
    known: dict[str, float] = {}
    for name in (item.name for item in fields(StatedErrors) if item.name != _ONE_CELL):
        value = kept.get(name, 0.0)
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise _fault(name, value, "a number in SI")
        known[name] = float(value)
    return StatedErrors(has_one_load_cell=one_cell, **known)


def _fault(name: str, value: object, needed: str) -> ArchiveError:
    return ArchiveError(
        f"the settings of the archive state no standard uncertainty as {name}",
        found=repr(value),
        needed=needed,
    )
