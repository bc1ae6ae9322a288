"""The answer in short: the tangent modulus at round strains, one table a specimen."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reduction.moduli.interpolation import curve_at
from reduction.record import Floats
from reduction.report.htmltable import Cell, Table, factors_of, make_table, measured, words
from reduction.report.style import shown
from reduction.report.uncertainty import expanded_of, plus_minus_of_tests
from reduction.report.view import TestView, all_specimens, any_synthetic
from reduction.vocabulary import BRANCH_NAMES

__all__ = ["STEPS", "design_tables"]

STEPS = (0.25, 0.05, 0.01)
"""Strain from row to row: the first that a test of the campaign reaches; a rope is stiff. [1]"""


def design_tables(tests: Sequence[TestView]) -> list[Table]:
    """Return the modulus at round strains: rows strain, columns the tests that reach one.

    A value between two bins is on the straight line between them, and so is its
    uncertainty, which is then that of bins whose errors go together; nothing is
    extrapolated.
    """
    for step in STEPS:
        found = [_table(tests, specimen, step) for specimen in all_specimens(tests)]
        tables = [table for table in found if table is not None]
        if tables:
            return tables
    return []


def _table(tests: Sequence[TestView], specimen: str, step: float) -> Table | None:
    columns: dict[str, dict[int, Cell]] = {}
    for view in tests:
        cells = _cells(view, specimen, step)
        if cells:
            columns[view.id] = cells
    if not columns:
        return None
    unit = shown("stress", tests[0].units)
    levels = sorted({level for cells in columns.values() for level in cells})
    rows = [
        [
            words(f"{100 * step * level:g}"),
            *(cells.get(level, words("")) for cells in columns.values()),
        ]
        for level in levels
    ]
    return make_table(
        f"{specimen}: tangent modulus at stated strains, ascending / descending, mean over the"
        " cycles of each test; inside its tested range only.",
        ("strain [%]", *(unit.label(name) for name in columns)), rows,
        synthetic=any_synthetic(tests), is_compact=True,
        remarks=[
            plus_minus_of_tests(
                factors_of(rows), [view for view in tests if view.id in columns],
                ["tangent_modulus"],
            )
        ],
    )  # fmt: skip


def _cells(view: TestView, specimen: str, step: float) -> dict[int, Cell]:
    """Return a cell for each multiple of the step that a branch reaches."""
    bins, modulus = view.array("strain_bin"), view.array("tangent_modulus")
    if bins is None or modulus is None or bins.size == 0 or specimen not in view.specimens:
        return {}
    row = view.specimens.index(specimen)
    spread = expanded_of(view, "tangent_modulus", modulus)
    spacing = float(np.min(np.diff(bins))) if bins.size > 1 else 0.0
    levels = np.arange(np.floor(bins[0] / step), np.ceil(bins[-1] / step) + 1)

    def at_levels(curve: Floats) -> Floats:
        return curve_at(step * levels, bins, curve, spacing=spacing)

    unit = shown("stress", view.units)
    branches = view.texts("branch_name") or BRANCH_NAMES
    places = [branches.index(name) for name in BRANCH_NAMES]
    moduli, halves, factors = (
        np.stack([at_levels(curve[row, place]) for place in places])
        for curve in (modulus, spread.half, spread.factor)
    )
    found: dict[int, Cell] = {}
    for column in np.flatnonzero(np.isfinite(moduli).any(axis=0)):
        both = [
            measured(value, uncertainty, unit, factor=factor, is_short=True)
            for value, uncertainty, factor in zip(
                moduli[:, column], halves[:, column], factors[:, column], strict=True
            )
        ]
        found[int(levels[column])] = Cell(
            " /\n".join(cell.text for cell in both),
            " ".join(cell.value or "nan" for cell in both),
            is_number=True,
            factors=tuple(factor for cell in both for factor in cell.factors),
        )
    return found
