"""CG-D-39-80, nylon and polyester line: recomputation of every printed number."""

from __future__ import annotations

from collections.abc import Sequence

from reduction.published.cg_cells import Pages, item_of_level
from reduction.published.cg_claims import (
    CLAIMS_OF_PULLS,
    CLAIMS_OF_SETTINGS,
    CLAIMS_OF_STIFFNESS,
    CLAIMS_OF_TESTS,
)
from reduction.published.cg_surfaces import TABLES_OF, item_of_static, item_of_surface
from reduction.published.cg_tests import item_of_test
from reduction.published.printed_cells import Cell, cells_of
from reduction.published.reproduced_item import ReproducedItem, measured_item

SURFACES = {table for tables in TABLES_OF.values() for table in tables}

OF_TABLE = {
    **dict.fromkeys(("1", "2", "A-1"), item_of_level),
    **dict.fromkeys(SURFACES, item_of_surface),
    **dict.fromkeys(("6", "7", "8", "9", "D-1"), item_of_static),
    **dict.fromkeys(("10", "20", "21", "A-2", "A-3", "A-4"), item_of_test),
}

CLAIMS = CLAIMS_OF_STIFFNESS | CLAIMS_OF_PULLS | CLAIMS_OF_TESTS | CLAIMS_OF_SETTINGS

PRINTED_ONCE = "measured, or a setting that is printed once"


def items() -> list[ReproducedItem]:
    """Verdicts on every cell of the report, in the order of its cells."""
    return _items_of(cells_of("CG-D-39-80"))


def _items_of(cells: Sequence[Cell]) -> list[ReproducedItem]:
    """Verdicts on given cells, not necessarily those of the package."""
    pages = Pages(cells)
    return [_item_of(cell, pages) for cell in cells]


def _item_of(cell: Cell, pages: Pages) -> ReproducedItem:
    """Verdict on one cell among the others of the report."""
    of_table = OF_TABLE.get(cell.table)
    if of_table is not None:
        return of_table(cell, pages)
    claim = CLAIMS.get(cell.column)
    return measured_item(cell, PRINTED_ONCE) if claim is None else claim(cell, pages)
