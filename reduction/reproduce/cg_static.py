"""CG-D-39-80, Tables 6-9 and D-1: K_0 polynomials, load-strain cubics, K_0 against rate.

New half-inch lines stand in two tables each.  A polynomial of K_0 is of the same pulls as a
cubic of strain, and was fitted apart from it: the slope of the cubic stands beside it.
"""

from __future__ import annotations

import numpy as np

from reduction.line.pull import fit_pull
from reduction.line.quasistatic import spring_constant_ratio
from reduction.published.cell import Cell
from reduction.reproduce.cg_cells import POLYNOMIAL_SCALES, Pages, number
from reduction.reproduce.cg_lines import CENTRE_LINES, levels_of
from reduction.reproduce.item import Item, agree, beside, judge, not_testable
from reduction.reproduce.wording import judge_as

REST, STRAIN = "quasi_static_spring_constant", "quasi_static_strain"
RANGE = "mean_tension high"
FITTED = "a fit to pulls that are not printed"
EXPOSED_YEARS = "5 years"


def item_of_static(cell: Cell, pages: Pages) -> Item:
    """Verdict on a cell of Tables 6-9 and D-1."""
    if cell.table == "D-1":
        return _rate(cell, pages)
    term = cell.column.partition(" ")[2]
    if cell.row == "every line":
        return _head(cell, pages, term)
    if term == RANGE:
        return _range(cell, pages)
    if term == "number of samples":
        return _count(cell, pages)
    twin = _twin(cell, pages)
    if twin is not None:
        return judge(cell, twin[0], twin[1])
    if cell.table in ("6", "7"):
        return _coefficient_of_stiffness(cell, pages, term)
    if cell.erratum == "CG-10":
        return beside(
            cell, _curvature_of_strain(cell, pages), f"{FITTED}; C that meets K_0 of Table 7"
        )
    return not_testable(cell, FITTED)


def _twin(cell: Cell, pages: Pages) -> tuple[float, str] | None:
    """The number of the other table, corrected where that is wrong on its own account."""
    table = {"6": "7", "7": "6", "8": "9", "9": "8"}[cell.table]
    other = pages.by_key.get((table, cell.row, cell.column))
    if other is None or (other.erratum and other.erratum != cell.erratum):
        return None
    if other.corrected is None:
        return number(other), f"Table {table}"
    if cell.erratum == "CG-9" and cell.table == "6":
        # C of Table 7 has lost its sign, for reasons of its own
        return other.corrected, f"Table {table}, C with its sign"
    return None


def _slopes(cell: Cell, pages: Pages, tension: float) -> float | None:
    """K_0 [lb] by the cubic of the same line, where one is printed."""
    table = "8" if cell.row.endswith("new") else "9"
    row = cell.row.replace("field exposure", EXPOSED_YEARS)
    if (table, row, f"{STRAIN} A") not in pages.by_key:
        return None
    return pages.slope(table, row, tension)


def _coefficient_of_stiffness(cell: Cell, pages: Pages, term: str) -> Item:
    """Beside a coefficient: what it has to be for the others to meet the slope at mid range."""
    tension = 0.7 * pages.value(cell.table, cell.row, f"{REST} {RANGE}")
    slope = _slopes(cell, pages, tension)
    if slope is None:
        return not_testable(cell, FITTED)
    power = "ABCD".index(term)
    others = pages.polynomial(cell.table, cell.row, tension)
    scale = tension**power * POLYNOMIAL_SCALES[power]
    own = pages.value(cell.table, cell.row, cell.column)
    return beside(
        cell, own + (slope - others) / scale,
        f"{FITTED}; beside it what meets the slope of the cubic at {tension:.0f} lb",
    )  # fmt: skip


def _curvature_of_strain(cell: Cell, pages: Pages) -> float:
    """C [1e-8/lb2] with which the slope of the cubic meets K_0 at the centre of the levels."""
    tension = 1470.0
    rest = pages.polynomial("7", cell.row.replace(EXPOSED_YEARS, "field exposure"), tension)
    _, linear, _, cubic = pages.cubic("9", cell.row)
    return float((1 / rest - linear - 3 * cubic * tension**2) / (2 * tension) * 1e8)


def _head(cell: Cell, pages: Pages, term: str) -> Item:
    """The form of the polynomial: powers of T, and the power of ten in front."""
    row, tension = "nylon | double braid | 1/2 in | new", 1344.0
    if term == "power of ten":
        ratio = pages.slope("8", row, tension) / (pages.polynomial("7", row, tension) / 1e4)
        base, _, exponent = cell.printed.partition("^")
        how = "K_0 of Table 8 over the polynomial, as a power of ten"
        text = exponent.strip("{}") if base == "10" else ""
        return judge_as(cell, text, round(np.log10(ratio)), how)
    expected = "ABCD".index(term[-1])
    if cell.printed == "T_m":
        return agree(cell, expected == 1, "Table 7 meets the slopes of Table 8")
    return judge(cell, float(expected), "Table 7, which meets the slopes of Table 8")


def _range(cell: Cell, pages: Pages) -> Item:
    if cell.erratum == "CG-12":
        off = ", ".join(f"{100 * one:.0f}" for one in _departures(cell.row, pages))
        return not_testable(cell, f"{off} % off the slope of Table 8 at the three levels")
    if cell.erratum == "CG-13":
        return _range_of_strength(cell, pages)
    years = cell.row.replace("field exposure", EXPOSED_YEARS)
    exposure = cell.row.replace(EXPOSED_YEARS, "field exposure")
    table = {"6": "8", "8": "6", "7": "9", "9": "7"}[cell.table]
    quantity = REST if table in ("6", "7") else STRAIN
    other = pages.by_key.get(
        (table, exposure if quantity == REST else years, f"{quantity} {RANGE}")
    )
    if other is not None and (not other.erratum or other.erratum == cell.erratum):
        return judge(cell, number(other), f"Table {table}")
    strength = pages.by_key.get(("1", cell.row, "rated_break_strength"))
    if strength is None:
        return not_testable(cell, "a range that no other table prints")
    return judge(cell, 0.30 * number(strength), "30 % of the rated break strength of Table 1")


def _levels(row: str, pages: Pages) -> list[float]:
    """Low, centre and high mean load [lb] of the design of a new line."""
    centre = CENTRE_LINES[row][1]
    shares = [
        pages.value("1", levels_of(row), f"mean_tension {end}") for end in ("low", "centre", "high")
    ]
    return [centre * share / shares[1] for share in shares]


def _departures(row: str, pages: Pages) -> list[float]:
    """Distance of the polynomial from the slope of the cubic at each level, as a share."""
    table = CENTRE_LINES[row][0]
    return [
        abs(pages.polynomial(table, row, tension) / pages.slope("8", row, tension) - 1)
        for tension in _levels(row, pages)
    ]


def _range_of_strength(cell: Cell, pages: Pages) -> Item:
    """Two rows print a break strength where the others have 30 % of it."""
    if cell.row.startswith("polyester"):
        strength = pages.printed("10", cell.row, "tensile_strength mean")
        return judge(cell, 0.30 * strength, "30 % of the strength of Table 10")
    wet = cell.row.replace("new", "wet, before cycling")
    strength = pages.printed("A-3", wet, "tensile_strength mean")
    return judge(cell, 0.30 * strength, "30 % of the strength of Table A-3")


def _count(cell: Cell, pages: Pages) -> Item:
    table, quantity = ("8", STRAIN) if cell.table == "6" else ("6", REST)
    other = pages.by_key.get((table, cell.row, f"{quantity} number of samples"))
    if other is not None:
        return judge(cell, number(other), f"Table {table}")
    if "13/16" in cell.row:
        return judge(cell, 9.0, "nine of each diameter, sec. A-2.1")
    return not_testable(cell, "a count that no other table prints")


def _rate(cell: Cell, pages: Pages) -> Item:
    if cell.column != REST:
        return not_testable(cell, "a setting of the test")
    load = np.linspace(0, 2000, 100)
    slowest = "24 h after the dynamic test, slow"
    pulls = [
        fit_pull(np.arange(100.0), load / (1e4 * pages.printed("D-1", row, REST)), load)
        for row in (cell.row, slowest)
    ]
    ratio = float(spring_constant_ratio(pulls[0], pulls[1], 1000.0)[0])
    return not_testable(cell, f"measured; {ratio:.2f} times the slow pull after 24 h")
