"""Writing an archive: checked before it gets its name, so that a bad file is never seen."""

from __future__ import annotations

from pathlib import Path

import xarray as xr

from reduction.archive.check import check_archive
from reduction.archive.whole import whole_file
from reduction.errors import ArchiveError

__all__ = ["write_archive"]


def write_archive(dataset: xr.Dataset, path: Path) -> None:
    """Write a dataset of `reduction.archive.dataset.to_dataset` as one netCDF file.

    Parameters
    ----------
    dataset : xarray.Dataset
        With encoding.
    path : pathlib.Path
        The file; one that is there is replaced at the very end, or kept.

    Raises
    ------
    ArchiveError
        If the disk refuses, or the file that was written breaks a rule of CF.
    """
    try:
        with whole_file(path) as part:
            dataset.to_netcdf(part, format="NETCDF4", engine="netcdf4")
            findings = check_archive(part)
            if findings:
                raise ArchiveError(
                    f"{path.name} does not follow CF and is not kept",
                    found="; ".join(findings[:5]),
                    needed="no finding",
                    n_findings=len(findings),
                )
    except ArchiveError:
        raise
    except (OSError, RuntimeError, ValueError) as error:
        # the netCDF library reports a full disk as RuntimeError
        raise ArchiveError(
            f"{path.name} cannot be written",
            found=str(error),
            hint="What was there before is kept. Check the folder and the space on the disk.",
        ) from error
