"""Uncertainty of a curve of an archive in two parts: its own, and what it shares with others."""

from __future__ import annotations

import numpy as np
import xarray as xr

from reduction.archive.shared import components_of
from reduction.archive.stored import stored
from reduction.record import Floats
from reduction.uncertainty.product import Contributions

_ROWS = "_uncertainty_contribution"


def parts_of(
    dataset: xr.Dataset, name: str, specimen: int | None = None, *, of: str
) -> tuple[Floats, Contributions | None]:
    """Both parts of the uncertainty of one curve of an archive.

    Parameters
    ----------
    dataset : xarray.Dataset
        An archive of a reduced test.
    name : str
        Of the curve.
    specimen : int, optional
        Its place, where the curve has one a specimen.
    of : str
        What the contributions are called.

    Returns
    -------
    random : ndarray, shape (...)
        Standard uncertainty of the curve by itself; all of it, where the archive keeps the shared
        part not apart. [unit of the curve]
    shared : Contributions or None
        Errors that touch it; None where the archive keeps none apart. [unit of the curve]
    """
    rows = stored(dataset, f"{name}{_ROWS}")
    whole = f"{name}_standard_uncertainty"
    own = np.asarray(
        dataset[whole if rows is None else f"{name}_random_standard_uncertainty"].values
    )
    random = own if specimen is None else own[specimen]
    if rows is None:
        return random, None
    table = np.array(rows.values if specimen is None else rows.values[:, specimen])
    # an archive names the errors of all its specimens and quantities
    touched = np.nan_to_num(table).any(axis=tuple(range(1, table.ndim)))
    component = tuple(
        one for one, kept in zip(components_of(dataset), touched, strict=True) if kept
    )
    return random, Contributions(component, {of: table[touched]})
