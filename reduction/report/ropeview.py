"""The programme of one rope as the page reads it: its properties, and the tests they are from."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
import xarray as xr

from reduction.archive.shared import COMPONENT
from reduction.record import Floats
from reduction.report.uncertainty import Expanded, expand
from reduction.report.view import TestView
from reduction.units import UnitSystem

_ROUNDING = 1e-6


@dataclass(frozen=True)
class RopeView:
    """One rope on the page.

    Parameters
    ----------
    key : str
        Prefix of every anchor.
    specimen : str
        Its name.
    data : xarray.Dataset
        Its rows of the archive of properties, in memory.
    tests : tuple of TestView
        Steps of its programme in the order in which they were done.
    units : UnitSystem
        What a reader is shown.
    """

    key: str
    specimen: str
    data: xr.Dataset
    tests: tuple[TestView, ...]
    units: UnitSystem = "si"

    @property
    def is_synthetic(self) -> bool:
        """True where no specimen was ever pulled."""
        return self.attribute("synthetic").lower() == "yes"

    @property
    def names(self) -> list[str]:
        """Which property each row is."""
        return self.texts("property_name")

    def attribute(self, name: str) -> str:
        """Global attribute; empty where there is none."""
        return str(self.data.attrs.get(name, ""))

    def array(self, name: str) -> Floats:
        """Values of a variable, one a row."""
        return np.asarray(self.data.variables[name].values, dtype=np.float64)

    def texts(self, name: str) -> list[str]:
        """Texts of a variable, one a row."""
        return [str(value) for value in self.data.variables[name].values]

    def rows_of(self, name: str) -> list[int]:
        """Rows of one property that have a number."""
        stiffness, strain = self.array("property_stiffness"), self.array("property_strain")
        known = np.isfinite(stiffness) | np.isfinite(strain)
        return [row for row, one in enumerate(self.names) if one == name and known[row]]

    def entries(self, along: str, needed: str) -> Iterator[tuple[TestView, int]]:
        """Every test and place of this rope along ``specimen``, ``held_pair`` or ``hold``.

        Only where the test has ``needed``.
        """
        for view in self.tests:
            owners = view.texts(along if along == "specimen" else f"{along}_specimen")
            if needed in view.data:
                yield from (
                    (view, place) for place, own in enumerate(owners) if own == self.specimen
                )


def expanded_property(view: RopeView, name: str) -> Expanded:
    """Return the expanded uncertainty of a property in each row, of shared and random parts."""
    spread = view.array(f"{name}_standard_uncertainty")
    kept = f"{name}_random_standard_uncertainty"
    return expand(
        spread,
        random=view.array(kept) if kept in view.data else None,
        degrees_of_freedom=view.array(f"{name}_degrees_of_freedom"),
    )


def shared_by_properties(view: RopeView) -> set[str]:
    """Return the sources of the errors that the properties of a rope share with others."""
    if COMPONENT not in view.data:
        return set()
    sources = view.texts("uncertainty_source")
    reached = np.zeros(len(sources), dtype=bool)
    for name in ("stiffness", "stiffness_over_strength", "strain"):
        rows = view.array(f"property_{name}_uncertainty_contribution")
        # a zero that cancels in a difference leaves its rounding
        reached |= (np.abs(rows) > _ROUNDING * np.abs(view.array(f"property_{name}"))).any(axis=1)
    return {one for one, is_in in zip(sources, reached, strict=True) if is_in}


def view_ropes(
    archive: xr.Dataset, tests: Mapping[str, TestView], units: UnitSystem
) -> list[RopeView]:
    """Return the ropes of an archive of properties, which may then be closed."""
    data = archive.load()
    used = json.loads(str(data.attrs.get("settings", "{}"))).get("tests", {})
    owners = data["property_specimen"].values.astype(str)
    return [
        RopeView(
            f"rope-{index}",
            name,
            data.isel(property=np.flatnonzero(owners == name)),
            tuple(tests[test] for test in used.get(name, ()) if test in tests),
            units,
        )
        for index, name in enumerate(dict.fromkeys(owners.tolist()))
    ]
