"""The strain model of a specimen, as its archive holds it."""

from __future__ import annotations

from typing import cast

import numpy as np
import xarray as xr

from reduction.archive.schema import COEFFICIENTS
from reduction.settings import StrainMethod
from reduction.strain.model import StrainModel


def strain_model_of(dataset: xr.Dataset, place: int) -> StrainModel | None:
    """Method and coefficients of one specimen's strain; marks and covariance stay in the file.

    Parameters
    ----------
    dataset : xarray.Dataset
        An archive of a reduced test.
    place : int
        Row of the specimen.

    Returns
    -------
    model : StrainModel or None
        None where the test has none, such as weights that were hung.
    """
    if "strain_method" not in dataset:
        return None

    def number(name: str) -> float:
        return float(dataset.variables[name].values[place]) if name in dataset else float("nan")

    known = {name: number(stored) for name, stored in COEFFICIENTS.items()}
    return StrainModel(
        specimen=str(dataset.variables["specimen"].values[place]),
        method=cast("StrainMethod", str(dataset.variables["strain_method"].values[place])),
        coefficients={name: value for name, value in known.items() if np.isfinite(value)},
        marks_from=str(dataset.variables["strain_marks_from"].values[place]),
        position_low=number("strain_position_low"),
        position_high=number("strain_position_high"),
        tension_low=number("strain_tension_low"),
        tension_high=number("strain_tension_high"),
    )
