"""Every printed number of WHOI-2005-10 again.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic
   Modulus of Rubber Mooring Tethers and their Use in Coastal Moorings," Woods
   Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from collections.abc import Sequence

from reduction.published.cell import Cell
from reduction.published.read import cells_of
from reduction.published.tethers import TETHER_REPORT
from reduction.reproduce.item import Item, not_testable
from reduction.reproduce.tether_claims import items_of_claims
from reduction.reproduce.tether_marks import items_of_diameters, items_of_marks, items_of_weights
from reduction.reproduce.tether_moduli import areas_of_tables, items_of_segments
from reduction.reproduce.tether_programme import (
    item_of_programme,
    item_printed_twice,
    items_of_plan,
)

_TEXT = "a statement, not a number that others give; see its erratum"
_OF_THE_FIELD = "from use at sea, or a pull without record"
_OF_OTHERS = "of another component or test, with no numbers of it here"
_A_CONDITION = "condition of a deployment"
_A_FIGURE = "read from a figure, which the text lacks"
_A_RUN = "of WHOI Cable runs, whose inputs are not printed"
_WHY_BY_PLACE = {
    "sec 2.1": _OF_OTHERS,
    "sec 2.2": _OF_OTHERS,
    "sec 2.3": _OF_THE_FIELD,
    "sec 2.3.1": _OF_THE_FIELD,
    "sec 2.3.2": _A_CONDITION,
    "sec 2.3.3": _OF_THE_FIELD,
    "sec 2.3.4": _OF_THE_FIELD,
    "sec 2.3.5": _A_RUN,
    "sec 4.1": _A_FIGURE,
}
_WHY_BY_ROW = {
    "T-6 new tether when first stretched": "Figure 24; relaxation of 18.75 % to the next number",
    "T-6 new tether after the hold": "Figure 24; relaxation of 18.75 % from the number before",
    "overnight hold": "of a hold whose record is not printed",
    "scaled position in Figure 24": "scale of a figure: on the 33.62, 36.00 and 38.37 ft that the "
    "marks of T-1 give for 225, 250 and 275 % it reads 69, 88 and 107, so the position is in feet",
    "stretch at which splices slip": _OF_THE_FIELD,
    "tethers at sea": "from use at sea; a wave every 5.2 s",
}


def items() -> list[Item]:
    """Every cell of the report, with its verdict.

    Returns
    -------
    items : list of Item
        In the order of `cells_of`.
    """
    return items_of(cells_of(TETHER_REPORT))


def items_of(cells: Sequence[Cell]) -> list[Item]:
    """Every cell, with its verdict.

    Parameters
    ----------
    cells : sequence of Cell
        The whole report, as printed and as corrected.

    Returns
    -------
    items : list of Item
        In the order of the cells.
    """
    book = {cell.key: cell for cell in cells}
    table = {number: [cell for cell in cells if cell.table == number] for number in "123456"}
    found = [
        *items_of_plan(table["1"], book),
        *items_of_diameters(table["2"], areas_of_tables(table["5"], table["6"])),
        *items_of_marks(table["3"]),
        *items_of_weights(table["4"]),
        *items_of_segments(table["5"]),
        *items_of_segments(table["6"]),
        *items_of_claims(book),
    ]
    by_key = {item.cell.key: item for item in found}
    return [
        by_key.get(cell.key)
        or item_of_programme(cell, table["1"])
        or item_printed_twice(cell, book)
        or not_testable(cell, _why_not(cell))
        for cell in cells
    ]


def _why_not(cell: Cell) -> str:
    if cell.row in _WHY_BY_ROW:
        return _WHY_BY_ROW[cell.row]
    if cell.unit == "":
        return _TEXT
    return _WHY_BY_PLACE.get(cell.table, _TEXT)
