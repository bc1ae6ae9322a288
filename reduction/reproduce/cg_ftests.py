"""CG-D-39-80, Tables A-3 and A-4: means of groups and the one-way F between them."""

from __future__ import annotations

from math import gcd

from reduction.outcomes.compare import one_way
from reduction.published.cell import Cell, printed_step
from reduction.reproduce.cg_cells import Pages, number, rounding
from reduction.reproduce.cg_lines import PLAITED, SCREEN, STRAIN_AT_FAILURE, STRENGTH
from reduction.reproduce.item import Item, judge, not_testable

MEASURED = "measured"
DRY, WET, AFTER = "dry, not cycled", "wet, before cycling", "wet, after cycling"
LOW, HIGH, UNCYCLED = (
    "wet, cycled, low mean load", "wet, cycled, high mean load", "wet, not cycled",
)  # fmt: skip
GROUPS = {
    f"{DRY} against {WET}": (DRY, WET),
    "wet, before against after cycling": (WET, AFTER),
    f"{DRY} against {AFTER}": (DRY, AFTER),
    "low mean load against not cycled": (LOW, UNCYCLED),
    "high mean load against not cycled": (HIGH, UNCYCLED),
    "low against high mean load": (LOW, HIGH),
    "dry against wet, not cycled": (DRY, UNCYCLED),
}
# nine wet samples (sec. ); six of twelve runs a diameter, three a mean load
SAMPLES = {DRY: 13, WET: 9, UNCYCLED: 9, AFTER: 6, LOW: 3, HIGH: 3}


def common_step(pages: Pages, kind: str) -> int:
    """What every number of a column of Table A-3 is a multiple of: ten pounds."""
    numbers = [
        int(number(cell)) for cell in pages.by_key.values()
        if cell.table == "A-3" and cell.column == f"{STRENGTH} {kind}"
    ]  # fmt: skip
    return gcd(*numbers)


def item_of_f_test(cell: Cell, pages: Pages, groups: tuple[str, str]) -> Item:
    """Verdict on F, its degrees of freedom or its critical value."""
    line = cell.row.rpartition(" | ")[0]
    quantity = STRENGTH if cell.table == "A-3" else STRAIN_AT_FAILURE
    columns = (f"{quantity} mean", f"{quantity} standard deviation")
    places = [(cell.table, f"{line} | {group}", column) for column in columns for group in groups]
    counts = [SAMPLES[group] for group in groups]

    def statistic(first: float, second: float, s_first: float, s_second: float) -> float:
        return float(one_way([first, second], [s_first, s_second], counts).f_statistic)

    inputs = [pages.printed(*place) for place in places]
    analysis = one_way(inputs[:2], inputs[2:], counts)
    counted = f"{counts[0]} and {counts[1]} samples"
    if cell.column == "F":
        halves = [pages.half(*place) for place in places]
        if cell.table == "A-3":
            steps = [common_step(pages, column.partition(" ")[2]) for column in columns]
            halves = [0.5 * step for step in steps for _ in groups]
        allowed = rounding(statistic, inputs, halves) + 0.5 * printed_step(cell.printed)
        return judge(
            cell, statistic(*inputs), f"means and deviations of {counted}", tolerance=allowed
        )
    found = {
        "degrees of freedom between": float(analysis.between),
        "degrees of freedom within": float(analysis.within),
        "critical F": float(analysis.critical),
    }
    return judge(cell, found[cell.column], counted)


def item_of_group(cell: Cell, pages: Pages) -> Item:
    """Means and deviations of Tables A-3 and A-4."""
    line, _, condition = cell.row.rpartition(" | ")
    quantity, _, kind = cell.column.partition(" ")
    if condition == DRY:
        scale = 1.0 if quantity == STRENGTH else 100.0
        place = ("10", f"{line} | new", cell.column)
        step = float(common_step(pages, kind)) if quantity == STRENGTH and kind != "mean" else 0.0
        return judge(
            cell, scale * pages.value(*place), "Table 10",
            tolerance=max(scale * pages.half(*place), 0.5 * step),
        )  # fmt: skip
    if cell.table == "A-3" and kind == "mean":
        if condition == AFTER:
            effect = ("A-2", SCREEN, f"{STRENGTH} effect of diameter")
            other, sign = ("13/16", -1) if "| 1/2 in" in cell.row else ("1/2", 1)
            mean = pages.printed("A-3", f"{PLAITED} | {other} in | {AFTER}", f"{STRENGTH} mean")
            return judge(
                cell, mean + sign * 1000 * pages.printed(*effect),
                "the other diameter and the effect of Table A-2",
                tolerance=1000 * pages.half(*effect),
            )  # fmt: skip
        if "13/16" in cell.row:
            key = ("8", cell.row.replace(condition, "new"), "quasi_static_strain mean_tension high")
            return judge(cell, pages.printed(*key), "Table 8 prints it as a range")
        dry = pages.printed("A-3", f"{line} | {DRY}", f"{STRENGTH} mean")
        claim = ("sec A-4.6", f"{line} | wet", f"{STRENGTH} fall")
        return judge(
            cell, dry * (1 - pages.printed(*claim) / 100), "dry, less the 12 % of sec. A-4.6",
            tolerance=dry * pages.half(*claim) / 100,
        )  # fmt: skip
    return not_testable(cell, MEASURED)
