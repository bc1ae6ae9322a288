"""Tables of strength, of exposure, of fatigue and of life against load.

Their columns are those of `reduction.outcomes.columns`: what stands in them belongs to a group of
outcomes, and not to a variable of the archive, which holds the outcomes themselves.
"""

from __future__ import annotations

from dataclasses import dataclass

import xarray as xr

from reduction.archive.outcomes import outcomes_of_dataset
from reduction.outcomes.columns import (
    EXPOSURE_COLUMNS,
    FATIGUE_COLUMNS,
    LOAD_LIFE_COLUMNS,
    STRENGTH_COLUMNS,
    OutcomeColumn,
)
from reduction.outcomes.life_rows import fatigue_rows, load_life_rows
from reduction.outcomes.row import Row
from reduction.outcomes.rows import exposure_rows, strength_rows
from reduction.tables.column import Cell, Column
from reduction.tables.table import SYNTHETIC


@dataclass(frozen=True)
class GroupColumn:
    """A column of a table of outcomes."""

    column: OutcomeColumn

    @property
    def header(self) -> str:
        """Name with the unit where it is a real number."""
        unit = self.column.unit
        return f"{self.column.name} [{unit}]" if unit not in ("", "count") else self.column.name

    @property
    def description(self) -> list[Cell]:
        """Header, unit, meaning, and why there is no uncertainty: a row of columns.csv."""
        column = self.column
        unit = "1" if column.unit == "count" else column.unit
        return [self.header, unit, column.long_name, column.no_uncertainty]


_COLUMNS = {
    "strength": STRENGTH_COLUMNS,
    "exposure": EXPOSURE_COLUMNS,
    "fatigue": FATIGUE_COLUMNS,
    "load_life": LOAD_LIFE_COLUMNS,
}
OUTCOME_TABLES: dict[str, tuple[GroupColumn | Column, ...]] = {
    name: (*map(GroupColumn, columns), SYNTHETIC) for name, columns in _COLUMNS.items()
}
"""Columns of each table, the word on synthetic data last."""


def outcome_table_rows(archive: xr.Dataset) -> dict[str, list[list[Cell]]]:
    """Return the rows of every table of outcomes; none where the outcomes do not give it.

    Parameters
    ----------
    archive : xarray.Dataset
        Of outcomes, from `reduction.archive.open.open_archive`.

    Returns
    -------
    rows : dict of str to list of list
        By table, in the order of `OUTCOME_TABLES`.
    """
    outcomes = outcomes_of_dataset(archive)
    synthetic = archive.attrs.get("synthetic", "no")
    rows: dict[str, list[Row]] = {
        "strength": strength_rows(outcomes),
        "exposure": exposure_rows(outcomes),
        "fatigue": fatigue_rows(outcomes),
        "load_life": load_life_rows(outcomes),
    }
    return {
        name: [[*map(_cell, row.values()), synthetic] for row in own] for name, own in rows.items()
    }


def _cell(value: float | str) -> Cell:
    return None if value != value else value  # NaN alone is not itself
