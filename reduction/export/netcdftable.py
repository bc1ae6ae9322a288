"""Curves and look-up tables as netCDF."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from reduction import __version__
from reduction.archive.shared import COMPONENT
from reduction.archive.whole import whole_file
from reduction.errors import ArchiveError
from reduction.export.table import CONTRIBUTION, SIGNED, ValueTable
from reduction.vocabulary import quantity


def write_netcdf(table: ValueTable, path: Path) -> None:
    """Write a table as a netCDF file, SI, with its sources as attributes.

    Parameters
    ----------
    table : ValueTable
        What is written.
    path : pathlib.Path
        The file; it appears whole or not at all.

    Raises
    ------
    ArchiveError
        If the disk refuses.
    """
    variables: dict[str, Any] = {}
    for column in table.columns:
        is_flag = column.values.dtype == np.bool_
        values = column.values.astype(np.int8) if is_flag else column.values
        about: dict[str, object] = {"long_name": column.meaning}
        if is_flag:
            about |= {"flag_values": np.array([0, 1], np.int8), "flag_meanings": "no yes"}
        elif column.values.dtype.kind != "U":
            about["units"] = column.unit
        variables[column.name] = (("point",), values, about)
    variables |= _contribution_variables(table)
    dataset = xr.Dataset(
        variables,
        attrs={
            "Conventions": "CF-1.11 ACDD-1.3",
            "title": table.title,
            "source": "; ".join(table.sources),
            "comment": "; ".join(table.notes) or "none",
            "synthetic": "yes" if table.is_synthetic else "no",
            "history": f"reduction {__version__} export",
            "software_version": __version__,
        },
    )
    encoding = {
        name: {"_FillValue": np.nan if array.dtype == np.float64 else None}
        for name, array in dataset.variables.items()
        if array.dtype.kind != "U"
    }
    try:
        with whole_file(path) as part:
            dataset.to_netcdf(part, format="NETCDF4", engine="netcdf4", encoding=encoding)
    except ArchiveError:
        raise
    except (OSError, RuntimeError) as error:
        raise ArchiveError(
            f"{path} cannot be written", found=getattr(error, "strerror", None) or str(error)
        ) from error


def _contribution_variables(table: ValueTable) -> dict[str, Any]:
    """Signed contributions to the tension along the errors, by the names of the archives."""
    if not table.component:
        return {}
    named = {
        "uncertainty_source": np.array([one.source for one in table.component]),
        "uncertainty_source_of": np.array([one.of for one in table.component]),
        "uncertainty_source_number": np.array([one.number for one in table.component]),
    }
    about = {name: {"long_name": quantity(name).long_name} for name in named}
    return {name: ((COMPONENT,), values, about[name]) for name, values in named.items()} | {
        CONTRIBUTION: (
            (COMPONENT, "point"), table.contribution, {"long_name": SIGNED, "units": "N"},
        )
    }  # fmt: skip
