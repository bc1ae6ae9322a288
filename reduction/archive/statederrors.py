"""What a campaign stated of its instruments, as the archive of a test keeps it in its settings."""

from __future__ import annotations

import json
from dataclasses import fields

import xarray as xr

from reduction.errors import ArchiveError
from reduction.uncertainty.stated import StatedErrors

__all__ = ["says_what_is_shared", "stated_errors_of"]

_ONE_CELL = "has_one_load_cell"


def stated_errors_of(archive: xr.Dataset) -> StatedErrors | None:
    """Standard uncertainties with which a test was reduced.

    Parameters
    ----------
    archive : xarray.Dataset
        Of a reduced test.

    Returns
    -------
    errors : StatedErrors or None
        Zero where nothing was stated; None where the archive is older than such statements.

    Raises
    ------
    ArchiveError
        If what stands there is no statement.

    Notes
    -----
    A key that this version does not know is of a later one, and none of its errors.
    """
    settings = json.loads(str(archive.attrs.get("settings") or "{}"))
    kept = settings.get("uncertainty")
    if kept is None:
        return None
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


def says_what_is_shared(archive: xr.Dataset) -> bool:
    """Whether an archive of a test says what its numbers share with others, be it nothing.

    Archives of earlier versions do not; one without contributions of which something is stated, or
    that does not say what is stated, is such a one.
    """
    if any(str(name).endswith("_uncertainty_contribution") for name in archive.variables):
        return True
    settings = json.loads(str(archive.attrs.get("settings") or "{}"))
    stated = settings.get("uncertainty")
    return stated is not None and not any(stated.values())


def _fault(name: str, value: object, needed: str) -> ArchiveError:
    return ArchiveError(
        f"the settings of the archive state no standard uncertainty as {name}",
        found=repr(value),
        needed=needed,
    )
