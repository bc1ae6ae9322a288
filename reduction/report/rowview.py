"""One row of an archive that holds several things of one kind, cut to its own length."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np
import xarray as xr

from reduction.notes import Severity, severity_of
from reduction.record import Floats
from reduction.units import UnitSystem


@dataclass(frozen=True)
class RowView:
    """One thing on the page: a hose, a comparison, an experiment.

    Parameters
    ----------
    key : str
        Prefix of every anchor; made by the page, not from a name.
    data : xarray.Dataset
        The archive, in memory, strings decoded.
    index : int
        Which row of it.
    units : UnitSystem
        What a reader is shown.
    """

    ENDS_AT: ClassVar[Mapping[str, str]] = {}
    """By dimension that the rows share, the variable whose last value is the end of a row."""

    key: str
    data: xr.Dataset
    index: int
    units: UnitSystem = "si"

    @property
    def is_synthetic(self) -> bool:
        """True where the campaign says that its numbers are made up."""
        return self.attribute("synthetic").lower() == "yes"

    def attribute(self, name: str) -> str:
        """Global attribute as text; empty where there is none."""
        return str(self.data.attrs.get(name, ""))

    @cached_property
    def sizes(self) -> dict[str, int]:
        """Own length of the dimensions that rows share."""
        found = {}
        for dim, name in self.ENDS_AT.items():
            if name in self.data:
                values = self.data.variables[name].values[self.index]
                is_own = np.isfinite(values) if values.dtype.kind == "f" else values.astype(object)
                found[dim] = int(np.count_nonzero(is_own.astype(bool)))
        return found

    def array(self, name: str) -> Floats:
        """Values of a variable of this row; of no length where there is none."""
        if name not in self.data:
            return np.full(0, np.nan)
        variable = self.data[name]
        cut = tuple(slice(self.sizes.get(str(dim))) for dim in variable.dims[1:])
        return np.asarray(variable.values[self.index], dtype=np.float64)[cut]

    def array_like(self, name: str, other: Floats) -> Floats:
        """Values of a variable, or NaN in the shape of another."""
        found = self.array(name)
        return found if found.shape == other.shape else np.full(other.shape, np.nan)

    def scalar(self, name: str) -> float:
        """A number of this row; NaN where there is none."""
        found = self.array(name)
        return float(found) if found.ndim == 0 else float("nan")

    def text(self, name: str) -> str:
        """Value of a text variable without further dimensions; "" where there is none."""
        return str(self.data.variables[name].values[self.index]) if name in self.data else ""

    def notes_of(self, owner: str, name: str, *, stage: str) -> dict[str, Severity]:
        """Notes whose ``owner`` is the name, with how serious each is at the stage."""
        if "note" not in self.data:
            return {}
        pairs = zip(
            self.data[owner].values.astype(str),
            self.data.variables["note"].values.astype(str),
            strict=True,
        )
        return {str(note): severity_of(stage, note) for own, note in pairs if own == name}
