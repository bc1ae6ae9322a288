"""Cells of WHOI-2005-10 by row."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from reduction.published.cell import Cell, number_of


def number_in_use(cell: Cell) -> float:
    """Number of a cell as corrected, or as printed where it is open; NaN where there is none.

    An open number has no other to be held against than those beside it on the page.
    """
    value = number_of(cell.printed) if cell.value is None else cell.value
    return float("nan") if value is None else value


@dataclass(frozen=True)
class Row:
    """One row of a table; indexed by column it gives the number in use."""

    name: str
    cells: dict[str, Cell]

    def __getitem__(self, column: str) -> float:
        """Number of one column."""
        return number_in_use(self.cells[column])

    @property
    def tether(self) -> str:
        """Which of the two."""
        return "new" if "tether new" in self.name else "used"

    @property
    def branch(self) -> str:
        """Of the static test."""
        return "descending" if "descending" in self.name else "ascending"


def rows_of(cells: Sequence[Cell]) -> list[Row]:
    """Rows of one table, in the order of the page.

    Parameters
    ----------
    cells : sequence of Cell
        Of one table.

    Returns
    -------
    rows : list of Row
    """
    rows: dict[str, dict[str, Cell]] = {}
    for cell in cells:
        rows.setdefault(cell.row, {})[cell.column] = cell
    return [Row(name, columns) for name, columns in rows.items()]
