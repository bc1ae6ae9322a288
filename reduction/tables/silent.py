"""Tests that do not keep what they share, in tables beside others that do."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import xarray as xr

from reduction.archive.statederrors import says_what_is_shared

__all__ = ["as_silent", "quantities_kept"]

_ROWS = "_uncertainty_contribution"
_U = "_standard_uncertainty"
_OF_TEST = "test_"
_ALIKE = {"tangent_modulus_by_cycle": "tangent_modulus"}
"""Curves of one cycle, which share what their mean does."""


def quantities_kept(archive: xr.Dataset) -> set[str]:
    """Quantities of which an archive keeps what they share, those of its cycles among them."""
    kept = {
        str(name).removesuffix(_ROWS) for name in archive.variables if str(name).endswith(_ROWS)
    }
    return kept | {name.removeprefix(_OF_TEST) for name in kept}


def as_silent(archive: xr.Dataset, kept: Iterable[str]) -> xr.Dataset:
    """Return an archive without the uncertainties that would make it count as exact.

    Parameters
    ----------
    archive : xarray.Dataset
        Of a reduced test.
    kept : iterable of str
        What the other archives keep the shared errors of.

    Returns
    -------
    archive : xarray.Dataset
        As it is, where it says what it shares; else without the standard uncertainties of those
        quantities, which are of scatter alone.
    """
    if says_what_is_shared(archive):
        return archive
    known = set(kept)
    names = known | {one for one, mean in _ALIKE.items() if mean in known}
    uncertain = [f"{name}{_U}" for name in names if f"{name}{_U}" in archive]
    return archive.assign({name: _without_numbers(archive[name]) for name in uncertain})


def _without_numbers(found: xr.DataArray) -> xr.DataArray:
    """NaN in the shape of a variable, which is not read, and takes no memory."""
    return found.copy(data=np.broadcast_to(np.float64(np.nan), found.shape))
