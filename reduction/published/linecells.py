"""Cells of CG-D-39-80 by line: tables of each response, units, and what the text has lost."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from reduction.published.cell import Cell, number_of
from reduction.units import scale_to_si

POUND, INCH = scale_to_si("lbf", "force")[0], scale_to_si("in", "length")[0]
# tables of a response, the one of new lines first, and the SI value of its printed unit
RESPONSES = {
    "apparent_spring_constant": (("3", "4", "5"), 1e4 * POUND),
    "hysteresis_energy": (("11", "12", "13"), POUND),
    "dissipation_spring_constant": (("14", "15", "16"), 1e4 * POUND),
    "relaxation_time": (("17", "18", "19"), 1.0),
}
REST, STRAIN, BREAK = "quasi_static_spring_constant", "quasi_static_strain", "tensile_strength"
POWERS = np.arange(4)
SCALE_OF_CUBIC = {
    REST: (("6", "7"), np.array([1e4, 1.0, 1e-3, 1e-7]) * POUND ** (1.0 - POWERS)),
    STRAIN: (("8", "9"), np.array([1e-4, 1e-4, 1e-8, 1e-12]) * POUND ** (0.0 - POWERS)),
}
EXPOSED = "field exposure"
CRITICAL_F = 3.436
# of a whole surface, not of one of its cells
OF_SURFACE = {("nylon | double braid | 1 1/4 in | new", "dissipation_spring_constant"): ("CG-17",)}
NOT_MEASURED = "not printed for this line"
ABSENT = {
    ("nylon | double braid | 1/2 in | 5 years", "apparent_spring_constant"):
        "the column of Table 4 is lost in the text; it says about twice the new line (CG-22)",
    ("nylon | double braid | 1/2 in | 5 years", "dissipation_spring_constant"):
        "the column of Table 15 is lost in the text (CG-23)",
    ("nylon | 8-strand plaited | 1/2 in | 5 years", "dissipation_spring_constant"):
        "the column of Table 15 is lost in the text (CG-23)",
    ("nylon | 8-strand plaited | 1/2 in | 4 years", "dissipation_spring_constant"):
        "the column of Table 15 is lost in the text (CG-23)",
    ("polyester | 8-strand plaited | 1/2 in | new", REST):
        "Tables 6 and 7 have no such row; the slope of the cubic takes its place (CG-13)",
    ("polyester | 8-strand plaited | 1/2 in | 4 years", REST):
        "Table 7 has no such row; the slope of the cubic takes its place (CG-13)",
    ("polyester | double braid | 1/2 in | 4 years", STRAIN): "Table 9: not available",
}  # fmt: skip


class LineCells:
    """Cells by table, row and column."""

    def __init__(self, cells: Sequence[Cell]) -> None:
        self.by_key = {cell.key: cell for cell in cells}

    def get(self, table: str, row: str, column: str) -> Cell | None:
        """One cell, where there is one."""
        return self.by_key.get((table, row, column))

    def prints(self, tables: Sequence[str], row: str, column: str) -> list[Cell]:
        """The same number in several tables."""
        found = [self.get(table, row, column) for table in tables]
        return [cell for cell in found if cell is not None]

    def rows(self) -> tuple[str, ...]:
        """Lines with a surface, a cubic or a break, in the order of the tables."""
        tables = {"3", "4", "5", "8", "9", "10", "12", "13", "18", "19"}
        rows = (cell.row for cell in self.by_key.values() if cell.table in tables)
        dropped = (EXPOSED, "all")
        return tuple(
            dict.fromkeys(
                row for row in rows if row.count(" | ") == 3 and not row.endswith(dropped)
            )
        )


def number_printed(cell: Cell) -> float:
    """As printed; NaN of words."""
    value = number_of(cell.printed)
    return float("nan") if value is None else value


def number_used(cell: Cell | None) -> float:
    """As corrected; NaN where open or absent."""
    value = None if cell is None else cell.value
    return float("nan") if value is None else value


def errata_of_cells(cells: Sequence[Cell]) -> tuple[str, ...]:
    """Ids that touch some cells, in their order."""
    return in_order({cell.erratum for cell in cells if cell.erratum})


def in_order(ids: Iterable[str]) -> tuple[str, ...]:
    """Ids by their number."""
    return tuple(sorted(ids, key=lambda one: int(one.partition("-")[2])))
