"""Opening an archive: only a file that this version understands."""

from __future__ import annotations

from pathlib import Path

import xarray as xr

from reduction.archive.schema import SCHEMA_VERSION
from reduction.errors import ArchiveError

__all__ = ["open_archive"]


def open_archive(path: Path) -> xr.Dataset:
    """Open an archive; values are read from the disk when they are asked for.

    Parameters
    ----------
    path : pathlib.Path
        A file that `write_archive` wrote.

    Returns
    -------
    dataset : xarray.Dataset
        Text decoded, elapsed time as numbers. To be closed, or used with ``with``.

    Raises
    ------
    ArchiveError
        If there is no such file, it is not netCDF, or it has another schema.
    """
    if not path.is_file():
        raise ArchiveError(f"there is no archive {path}", hint="Run the campaign first.")
    try:
        dataset = xr.open_dataset(
            path, engine="netcdf4", decode_times=False, decode_timedelta=False
        )
    except (OSError, RuntimeError, ValueError) as error:
        raise ArchiveError(
            f"{path} is not a netCDF file",
            found=str(error).splitlines()[0],
            needed="an archive of a reduced test",
        ) from error
    found = dataset.attrs.get("schema_version")
    if found != SCHEMA_VERSION:
        dataset.close()
        raise ArchiveError(
            f"{path} has another schema",
            found="none" if found is None else f"version {found}",
            needed=f"version {SCHEMA_VERSION}",
            hint="Reduce the test again with this version.",
        )
    return dataset
