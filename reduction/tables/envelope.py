"""Least and greatest tangent modulus over all tests of a campaign (WHOI-2005-10, Figure 31)."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np
import xarray as xr

from reduction.archive.schema import SCHEMA
from reduction.archive.shared import components_of
from reduction.archive.stored import stored
from reduction.archive.variable import count, label, measured
from reduction.moduli.interpolation import curve_at
from reduction.record import Floats
from reduction.tables.column import Cell, Column
from reduction.tables.table import SYNTHETIC
from reduction.uncertainty.product import Contributions

_BIN = ("specimen", "branch_name", "strain_bin")
ENVELOPE_COLUMNS = (
    Column("specimen", SCHEMA["specimen"]),
    Column("branch", SCHEMA["branch_name"]),
    Column("strain_bin", SCHEMA["strain_bin"]),
    *(Column(row.name, row) for row in measured("envelope_minimum", _BIN)),
    Column("envelope_minimum_test", label("envelope_minimum_test")[0]),
    *(Column(row.name, row) for row in measured("envelope_maximum", _BIN)),
    Column("envelope_maximum_test", label("envelope_maximum_test")[0]),
    Column("n_tests", count("n_tests", ())[0]),
    SYNTHETIC,
)


@dataclass(frozen=True)
class Curve:
    """Mean tangent modulus of one test, specimen and branch; arrays (n_bins,).

    ``uncertainty`` holds both parts; ``shared`` what each error that samples share adds to
    ``tangent_modulus``, (n_components, n_bins).
    """

    test: str
    specimen: str
    branch: str
    synthetic: str
    strain: Floats
    width: float
    modulus: Floats
    uncertainty: Floats
    shared: Contributions = field(default_factory=lambda: Contributions(()))


def curves_of(archive: xr.Dataset) -> Iterator[Curve]:
    """Give the curves of an archive; none where the test has no cycles."""
    if "tangent_modulus" not in archive:
        return
    edges = archive.variables["strain_bin_bounds"].values
    rows = stored(archive, "tangent_modulus_uncertainty_contribution")
    component = () if rows is None else tuple(components_of(archive))
    for row, specimen in enumerate(archive.variables["specimen"].values):
        for column, branch in enumerate(archive.variables["branch_name"].values):
            yield Curve(
                test=archive.attrs["test"],
                specimen=str(specimen),
                branch=str(branch),
                synthetic=archive.attrs.get("synthetic", "no"),
                strain=archive.variables["strain_bin"].values,
                width=float(np.max(edges[:, 1] - edges[:, 0])),
                modulus=archive.variables["tangent_modulus"].values[row, column],
                uncertainty=archive.variables["tangent_modulus_standard_uncertainty"].values[
                    row, column
                ],
                shared=Contributions(component)
                if rows is None
                else Contributions(component, {"tangent_modulus": rows.values[:, row, column]}),
            )


def on_grid(curve: Curve, grid: Floats) -> tuple[Floats, Floats]:
    """Bring a curve onto a strain grid by straight lines between neighbouring bins.

    Parameters
    ----------
    curve : Curve
        One test, specimen and branch.
    grid : ndarray, shape (n_grid,)
        Strain. [1]

    Returns
    -------
    modulus, uncertainty : ndarray, shape (n_grid,)
        NaN outside the curve and across a gap in it: nothing is extrapolated. [Pa]
    """
    modulus, uncertainty = read_curve(curve, grid, np.stack([curve.modulus, curve.uncertainty]))
    return modulus, uncertainty


def read_curve(curve: Curve, grid: Floats, values: Floats) -> Floats:
    """Values at the bins of a curve, (n, n_bins), on a strain grid, (n, n_grid); as `on_grid`."""
    known = np.isfinite(curve.modulus)
    strain = curve.strain[known]
    if strain.size == 0:
        return np.full((values.shape[0], grid.size), np.nan)
    found = [curve_at(grid, strain, row[known], spacing=curve.width) for row in values]
    return np.array(found).reshape(len(values), grid.size)


def envelope_rows(curves: Sequence[Curve]) -> list[list[Cell]]:
    """Return the envelope of each specimen and branch on one strain grid.

    The grid is that of the test with the widest bins, carried on to both sides, so that
    no curve is shown finer than it is.

    Parameters
    ----------
    curves : sequence of Curve
        Of all tests of a campaign.

    Returns
    -------
    rows : list of list
        In the order of `ENVELOPE_COLUMNS`; strains at which no test has a modulus are
        left out.
    """
    if not curves:
        return []
    widest = max(curves, key=lambda curve: curve.width)
    low = min(float(curve.strain[0]) for curve in curves)
    high = max(float(curve.strain[-1]) for curve in curves)
    origin = float(widest.strain[0])
    steps = np.arange(
        np.floor((low - origin) / widest.width + 0.01),
        np.ceil((high - origin) / widest.width - 0.01) + 1,
    )
    # sixteenth digits that differ from test to test say nothing
    grid = np.round(origin + widest.width * steps, 12)
    groups: dict[tuple[str, str], list[Curve]] = defaultdict(list)
    for curve in curves:
        groups[curve.specimen, curve.branch].append(curve)
    return [
        row
        for (specimen, branch), group in groups.items()
        for row in _group_rows(specimen, branch, group, grid)
    ]


def _group_rows(
    specimen: str, branch: str, group: Sequence[Curve], grid: Floats
) -> Iterator[list[Cell]]:
    pairs = [on_grid(curve, grid) for curve in group]
    modulus = np.array([pair[0] for pair in pairs])
    uncertainty = np.array([pair[1] for pair in pairs])
    synthetic = "yes" if any(curve.synthetic == "yes" for curve in group) else "no"
    for column in np.flatnonzero(np.isfinite(modulus).any(axis=0)):
        at = modulus[:, column]
        cells: list[Cell] = [specimen, branch, float(grid[column])]
        for extreme in (int(np.nanargmin(at)), int(np.nanargmax(at))):
            spread = float(uncertainty[extreme, column])
            cells += [
                float(at[extreme]),
                spread if np.isfinite(spread) else None,
                group[extreme].test,
            ]
        yield [*cells, int(np.isfinite(at).sum()), synthetic]
