"""Static against dynamic: slopes of stepwise tests beside the curves of cyclic ones.

Figure 35 of WHOI-2005-10 lays three cyclic tests and a static one over each other.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
import xarray as xr

from reduction.archive.schema import SCHEMA
from reduction.archive.shared import shared_contributions
from reduction.archive.variable import label, measured
from reduction.record import Floats
from reduction.tables.column import Cell, Column, uncertainty_of
from reduction.tables.envelope import Curve, on_grid, read_curve
from reduction.tables.table import SYNTHETIC, TEST
from reduction.uncertainty.combine import combined_standard_uncertainty
from reduction.uncertainty.product import Component
from reduction.uncertainty.ratio import ratio_contributions
from reduction.vocabulary import BRANCH_VALUES

_STATIC, _DYNAMIC = (Column(name, SCHEMA[name]) for name in ("interval_modulus", "tangent_modulus"))
STATIC_DYNAMIC_COLUMNS = (
    Column("static_test", label("static_test")[0]),
    Column("static_specimen", label("static_specimen")[0]),
    TEST,
    Column("specimen", SCHEMA["specimen"]),
    Column("branch", SCHEMA["branch_name"]),
    Column("interval_strain", SCHEMA["interval_strain"]),
    _STATIC,
    uncertainty_of(_STATIC),
    _DYNAMIC,
    uncertainty_of(_DYNAMIC),
    *(Column(row.name, row) for row in measured("static_dynamic_ratio", ("interval",))),
    SYNTHETIC,
)


@dataclass(frozen=True)
class Slope:
    """Slope between two readings of a stepwise test, at the strain in their middle.

    ``uncertainty`` holds both parts; ``shared`` what each error that samples share adds.
    """

    test: str
    specimen: str
    branch: str
    synthetic: str
    strain: float
    modulus: float
    uncertainty: float
    shared: Mapping[Component, float] = field(default_factory=dict)


def slopes_of(archive: xr.Dataset) -> Iterator[Slope]:
    """Give the slopes of an archive that have a number; none where the test is not stepwise."""
    if "interval_modulus" not in archive:
        return
    branches = {value: name for name, value in BRANCH_VALUES.items()}
    for index in map(
        int, np.flatnonzero(np.isfinite(archive.variables["interval_modulus"].values))
    ):
        yield Slope(
            test=archive.attrs["test"],
            specimen=str(archive.variables["specimen"].values[0]),
            branch=branches[int(archive.variables["interval_branch"].values[index])],
            synthetic=archive.attrs.get("synthetic", "no"),
            strain=float(archive.variables["interval_strain"].values[index]),
            modulus=float(archive.variables["interval_modulus"].values[index]),
            uncertainty=float(
                archive.variables["interval_modulus_standard_uncertainty"].values[index]
            ),
            shared=shared_contributions(archive, "interval_modulus", index),
        )


def static_dynamic_rows(slopes: Sequence[Slope], curves: Sequence[Curve]) -> list[list[Cell]]:
    """Set every static slope beside the dynamic curves of its branch, and give their ratio.

    Parameters
    ----------
    slopes : sequence of Slope
        Of all stepwise tests of a campaign.
    curves : sequence of Curve
        Of all cyclic tests of it.

    Returns
    -------
    rows : list of list
        In the order of `STATIC_DYNAMIC_COLUMNS`, by curve and then by rising strain;
        strains at which the curve has no modulus are left out.  What both moduli share (a
        load cell, a diameter) is in the ratio as far as it is not the same share of both; of
        archives that say nothing of it they count as independent.
    """
    rows: list[list[Cell]] = []
    for curve in curves:
        beside = sorted(
            (slope for slope in slopes if slope.branch == curve.branch),
            key=lambda slope: (slope.test, slope.specimen, slope.strain),
        )
        at = np.array([slope.strain for slope in beside])
        of_errors = curve.shared.values.get("tangent_modulus", np.empty((0, curve.strain.size)))
        dynamic = np.column_stack([*on_grid(curve, at), *read_curve(curve, at, of_errors)])
        rows += [
            _row(slope, curve, float(modulus), float(spread), shared)
            for slope, (modulus, spread, *shared) in zip(beside, dynamic, strict=True)
            if np.isfinite(modulus)
        ]
    return rows


def _row(
    slope: Slope, curve: Curve, modulus: float, spread: float, shared: Sequence[float]
) -> list[Cell]:
    ratio = slope.modulus / modulus
    of_curve = dict(zip(curve.shared.component, np.nan_to_num(shared), strict=True))
    component = sorted({*of_curve, *slope.shared})
    above, below = (
        np.array([known.get(one, 0.0) for one in component]) for known in (slope.shared, of_curve)
    )
    rows = ratio_contributions(
        ratio, numerator=slope.modulus, of_numerator=above, denominator=modulus,
        of_denominator=below,
    )  # fmt: skip
    random = np.hypot(
        _left(slope.uncertainty, above) / slope.modulus, _left(spread, below) / modulus
    )
    whole = float(combined_standard_uncertainty(rows, abs(ratio) * random))
    numbers = [slope.modulus, slope.uncertainty, modulus, spread, ratio, whole]
    return [
        slope.test,
        slope.specimen,
        curve.test,
        curve.specimen,
        slope.branch,
        slope.strain,
        *(value if np.isfinite(value) else None for value in numbers),
        "yes" if "yes" in (slope.synthetic, curve.synthetic) else "no",
    ]


def _left(whole: float, contribution: Floats) -> float:
    """Random part of a standard uncertainty: what is not shared."""
    return float(np.sqrt(max(whole**2 - float(contribution @ contribution), 0.0)))
