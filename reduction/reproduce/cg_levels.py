"""CG-D-39-80, Tables 1, 2 and A-1: levels of the factors and rated break strengths.

The ranges that Tables 3-19 print in pounds are the levels times the strength.
"""

from __future__ import annotations

from reduction.published.cell import Cell
from reduction.reproduce.cg_cells import Pages
from reduction.reproduce.cg_lines import K_AP
from reduction.reproduce.item import Item, judge, not_testable

SETTING = "a setting that is printed once"
BRAID = "nylon | double braid"
# a line with these levels, the table of its range, the row of its strength
OF_LEVELS = {
    f"{BRAID} | {sizes} in | new": ("3", f"{BRAID} | {size} in | new", "1")
    for sizes, size in (("1/2 in, 3/4", "3/4"), ("1 in, 1 1/4", "1"))
} | {
    "nylon, polyester | 8-strand plaited, double braid | 1/2 in | 4 years, 5 years": (
        "4", "nylon | 8-strand plaited | 1/2 in | all", "2",
    ),
}  # fmt: skip
OF_LINE = "nylon | 8-strand plaited | 1/2 in | new"
VALLEY = ("sec A-1", OF_LINE, "least load when never slack")
PEAK = ("sec 5.1", OF_LINE, "greatest load when never slack")
# a load of the text, the other load of Table A-1, and its sign in the sum
SCREENING = {
    "mean_tension low": (VALLEY, "tension_amplitude high", 1),
    "mean_tension high": (PEAK, "tension_amplitude high", -1),
    "tension_amplitude high": (PEAK, "mean_tension high", -1),
}
REPEATED = {
    "frequency low": "frequency low", "frequency high": "frequency high", "duration high": "cycles",
}  # fmt: skip


def item_of_level(cell: Cell, pages: Pages) -> Item:
    """Verdict on a cell of Tables 1, 2 and A-1."""
    if cell.table == "A-1":
        return _screening(cell, pages)
    if cell.column == "rated_break_strength":
        return _strength(cell, pages)
    if cell.row == "every line":
        place = ("frequency", "mean_tension", "tension_amplitude").index(cell.column.split(" ")[0])
        return judge(cell, place + 1.0, "order of the factors in eqs. 5 and 5a")
    factor, _, end = cell.column.partition(" ")
    if end == "centre":
        ends = (pages.value(cell.table, cell.row, f"{factor} {one}") for one in ("low", "high"))
        return judge(cell, sum(ends) / 2, "half way between the ends")
    table, line, strengths = OF_LEVELS[cell.row]
    if factor == "frequency":
        found = pages.value(table, "every line", f"{K_AP} frequency {end}")
        return judge(cell, found, f"Table {table}")
    strength = pages.value(strengths, line, "rated_break_strength")
    found = pages.value(table, line, f"{K_AP} {cell.column}")
    return judge(cell, 100 * found / strength, f"range of Table {table} over {strength:g} lb")


def _strength(cell: Cell, pages: Pages) -> Item:
    """From the upper mean load; where two strengths are printed, the other one."""
    line = cell.row.rpartition(" | ")[0]
    if cell.erratum == "CG-15":
        other = pages.printed("10", f"{line} | new", "tensile_strength mean")
        return judge(cell, other, "Table 10")
    percent = 22.0 if "| 1 in" in cell.row else 30.0
    key = ("3", f"{line} | new", f"{K_AP} mean_tension high")
    return judge(
        cell, 100 * pages.value(*key) / percent, f"upper mean load of Table 3 over {percent:g} %",
        tolerance=100 * pages.half(*key) / percent,
    )  # fmt: skip


def _screening(cell: Cell, pages: Pages) -> Item:
    if cell.column in REPEATED:
        found = pages.printed("sec A-1", "screening", REPEATED[cell.column])
        return judge(cell, found, "the text of App. A")
    if cell.column not in SCREENING:
        return not_testable(cell, SETTING)
    extreme, other, sign = SCREENING[cell.column]
    total = pages.printed(*extreme) + sign * pages.printed("A-1", cell.row, other)
    return judge(cell, total, f"{extreme[2]}, {extreme[0]}, and the other load")
