"""CG-D-39-80: cells by place, lines, levels of the factors.

The ranges that Tables 3-19 print in pounds are the levels times the strength.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

import numpy as np

from reduction.published.printed_cells import Cell, number_of, printed_step
from reduction.published.reproduced_item import ReproducedItem, judge, judge_repeat, measured_item
from reduction.record.errors import DataError
from reduction.record.measurement import Floats
from reduction.stages.three_parameter_line.slow_pull import slope_of_cubic

POLYNOMIAL_SCALES = np.array([1e4, 1.0, 1e-3, 1e-7])
"""Powers of ten of A, B, C, D in Tables 6 and 7, for pounds."""

CUBIC_SCALES = np.array([1e-4, 1e-4, 1e-8, 1e-12])
"""Powers of ten of A, B, C, D in Tables 8 and 9, for strain and pounds."""


def number(cell: Cell) -> float:
    """The number of a cell as printed."""
    found = number_of(cell.printed)
    if found is None:
        raise DataError("a cell holds no number", found=f"{'/'.join(cell.key)}: {cell.printed}")
    return found


class Pages:
    """The cells of a report by table, row and column."""

    def __init__(self, cells: Iterable[Cell]) -> None:
        self.by_key = {cell.key: cell for cell in cells}

    def cell(self, table: str, row: str, column: str) -> Cell:
        """One cell."""
        found = self.by_key.get((table, row, column))
        if found is None:
            raise DataError("no such cell", found=f"{table} / {row} / {column}")
        return found

    def printed(self, table: str, row: str, column: str) -> float:
        """Number of a cell as printed."""
        return number(self.cell(table, row, column))

    def value(self, table: str, row: str, column: str) -> float:
        """Number of a cell as corrected, or as printed where there is no correction."""
        cell = self.cell(table, row, column)
        return number(cell) if cell.corrected is None else cell.corrected

    def half(self, table: str, row: str, column: str) -> float:
        """Half the last digit of a cell."""
        return 0.5 * printed_step(self.cell(table, row, column).printed)

    def surface(self, table: str, row: str, quantity: str) -> Floats:
        """B1 .. B10, as corrected; an open coefficient as printed in this table."""
        return np.array([self.value(table, row, f"{quantity} B{i}") for i in range(1, 11)])

    def cubic(self, table: str, row: str) -> Floats:
        """A .. D of strain, in strain and pounds."""
        terms = [self.value(table, row, f"quasi_static_strain {term}") for term in "ABCD"]
        return np.asarray(np.array(terms) * CUBIC_SCALES, dtype=np.float64)

    def slope(self, table: str, row: str, tension: float) -> float:
        """K_0 [lb] as the slope of a load-strain cubic."""
        return float(slope_of_cubic(tension, self.cubic(table, row)))

    def polynomial(self, table: str, row: str, tension: float) -> float:
        """K_0 [lb] from the polynomial of Table 6 or 7."""
        terms = [self.value(table, row, f"quasi_static_spring_constant {term}") for term in "ABCD"]
        return float(tension ** np.arange(4) @ (np.array(terms) * POLYNOMIAL_SCALES))

    def strain(self, table: str, row: str, tension: float) -> float:
        """Strain at a tension [lb], from the cubic."""
        return float(tension ** np.arange(4) @ self.cubic(table, row))


Check = Callable[[Cell, Pages], ReproducedItem]
"""Check of one claim of the text against all cells."""


def always(why: str) -> Check:
    """The check of a claim that nothing in the report determines."""
    return lambda cell, pages: measured_item(cell, why)


def rounding(
    function: Callable[..., float], values: Sequence[float], halves: Sequence[float]
) -> float:
    """Effect of the rounding of its inputs on a result.

    Examples
    --------
    >>> round(rounding(lambda mean, deviation: deviation / mean, [100.0, 10.0], [0.5, 0.5]), 4)
    0.0055
    """
    centre = function(*values)
    total = 0.0
    for place, half in enumerate(halves):
        moved = []
        for sign in (-1, 1):
            inputs = list(values)
            inputs[place] += sign * half
            moved.append(abs(function(*inputs) - centre))
        total += max(moved)
    return total


K_AP, ENERGY, K_1, TIME = (
    "apparent_spring_constant", "hysteresis_energy", "dissipation_spring_constant",
    "relaxation_time",
)  # fmt: skip

STRENGTH, STRAIN_AT_FAILURE = "tensile_strength", "strain_at_failure"

NYLON_BRAID, NYLON_PLAITED, POLYESTER_BRAID, POLYESTER_PLAITED = (
    f"{material} | {construction} | 1/2 in"
    for material in ("nylon", "polyester")
    for construction in ("double braid", "8-strand plaited")
)

NYLON_BRAIDS = tuple(
    f"nylon | double braid | {size} in | new" for size in ("1/2", "3/4", "1", "1 1/4")
)

PLAITED = "nylon | 8-strand plaited"

SCREEN = f"screening | {PLAITED}"

CENTRE_LINES: dict[str, tuple[str, float, float]] = {
    f"{POLYESTER_PLAITED} | new": ("slope", 1386, 561),
    f"{POLYESTER_BRAID} | new": ("6", 1344, 544),
    f"{NYLON_PLAITED} | new": ("7", 1209.6, 489.6),
    NYLON_BRAIDS[0]: ("7", 1344, 544),
    NYLON_BRAIDS[1]: ("6", 4011, 1623.5),
    NYLON_BRAIDS[2]: ("6", 5376, 2520),
    NYLON_BRAIDS[3]: ("6", 5376, 2520),
}
"""Table of K_0, mean tension and amplitude at the centre [lb]; slope where K_0 has no row."""


def centre_stiffness(pages: Pages, row: str) -> float:
    """K_0 [lb] of a new line at the centre of its mean loads."""
    table, tension, _ = CENTRE_LINES[row]
    if table == "slope":
        return pages.slope("8", row, tension)
    return pages.polynomial(table, row, tension)


def levels_of(row: str) -> str:
    """Row of Table 1 with the levels of a line, in per cent of its strength."""
    large = "| 1 in" in row or "| 1 1/4 in" in row
    sizes = "1 in, 1 1/4 in" if large else "1/2 in, 3/4 in"
    return f"nylon | double braid | {sizes} | new"


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


def item_of_level(cell: Cell, pages: Pages) -> ReproducedItem:
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
        return judge_repeat(cell, found, f"Table {table}")
    strength = pages.value(strengths, line, "rated_break_strength")
    found = pages.value(table, line, f"{K_AP} {cell.column}")
    return judge(cell, 100 * found / strength, f"range of Table {table} over {strength:g} lb")


def _strength(cell: Cell, pages: Pages) -> ReproducedItem:
    """Strength from the upper mean load; where two strengths are printed, the other one."""
    line = cell.row.rpartition(" | ")[0]
    if cell.erratum == "CG-15":
        other = pages.printed("10", f"{line} | new", "tensile_strength mean")
        return judge_repeat(cell, other, "Table 10")
    percent = 22.0 if "| 1 in" in cell.row else 30.0
    key = ("3", f"{line} | new", f"{K_AP} mean_tension high")
    return judge(
        cell, 100 * pages.value(*key) / percent, f"upper mean load of Table 3 over {percent:g} %",
        tolerance=100 * pages.half(*key) / percent,
    )  # fmt: skip


def _screening(cell: Cell, pages: Pages) -> ReproducedItem:
    if cell.column in REPEATED:
        found = pages.printed("sec A-1", "screening", REPEATED[cell.column])
        return judge_repeat(cell, found, "the text of App. A")
    if cell.column not in SCREENING:
        return measured_item(cell, SETTING)
    extreme, other, sign = SCREENING[cell.column]
    total = pages.printed(*extreme) + sign * pages.printed("A-1", cell.row, other)
    return judge(cell, total, f"{extreme[2]}, {extreme[0]}, and the other load")
