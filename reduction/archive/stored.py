"""A variable of an archive that may not be there."""

from __future__ import annotations

import xarray as xr


def stored(dataset: xr.Dataset, name: str) -> xr.Variable | None:
    """Give a variable of an archive, or nothing.

    Parameters
    ----------
    dataset : xarray.Dataset
        An open archive.
    name : str
        Of the variable.

    Returns
    -------
    variable : xarray.Variable or None
        As it lies there, without coordinates; not read yet.

    Notes
    -----
    ``Dataset.get`` gathers the coordinates of what it gives, and compares a name that is missing
    with all others for an error message that nobody sees; where an archive has hundreds of either,
    that took a third of a report's time.

    Examples
    --------
    >>> stored(xr.Dataset({"strain": 1.5}), "tension") is None
    True
    """
    return dataset.variables[name] if name in dataset else None
