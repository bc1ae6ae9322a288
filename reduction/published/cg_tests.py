"""CG-D-39-80, Tables 10, 20, 21 and A-2: strength, abrasion, screening.

Means and deviations are measured; changes and relative variabilities follow from them, and
bound them in turn.  The checks of Tables A-3 and A-4 are below.
"""

from __future__ import annotations

from math import gcd

from reduction.experiments.strength_statistics import one_way, ratio_of_means
from reduction.published.cg_cells import (
    PLAITED,
    SCREEN,
    STRAIN_AT_FAILURE,
    STRENGTH,
    Pages,
    number,
    rounding,
)
from reduction.published.printed_cells import Cell, printed_step
from reduction.published.reproduced_item import (
    ReproducedItem,
    judge,
    judge_repeat,
    measured_item,
)

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

# nine wet samples (sec. ); six of twelve runs per diameter, three per mean load
SAMPLES = {DRY: 13, WET: 9, UNCYCLED: 9, AFTER: 6, LOW: 3, HIGH: 3}


def _common_step(pages: Pages, kind: str) -> int:
    """Common divisor of the numbers in a column of Table A-3: ten pounds."""
    numbers = [
        int(number(cell)) for cell in pages.by_key.values()
        if cell.table == "A-3" and cell.column == f"{STRENGTH} {kind}"
    ]  # fmt: skip
    return gcd(*numbers)


def _item_of_f_test(cell: Cell, pages: Pages, groups: tuple[str, str]) -> ReproducedItem:
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
            steps = [_common_step(pages, column.partition(" ")[2]) for column in columns]
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


def _item_of_group(cell: Cell, pages: Pages) -> ReproducedItem:
    """Means and deviations of Tables A-3 and A-4."""
    line, _, condition = cell.row.rpartition(" | ")
    quantity, _, kind = cell.column.partition(" ")
    if condition == DRY:
        scale = 1.0 if quantity == STRENGTH else 100.0
        place = ("10", f"{line} | new", cell.column)
        step = float(_common_step(pages, kind)) if quantity == STRENGTH and kind != "mean" else 0.0
        return judge_repeat(
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
            return judge_repeat(cell, pages.printed(*key), "Table 8 prints it as a range")
        dry = pages.printed("A-3", f"{line} | {DRY}", f"{STRENGTH} mean")
        claim = ("sec A-4.6", f"{line} | wet", f"{STRENGTH} fall")
        return judge(
            cell, dry * (1 - pages.printed(*claim) / 100), "dry, less the 12 % of sec. A-4.6",
            tolerance=dry * pages.half(*claim) / 100,
        )  # fmt: skip
    return measured_item(cell, MEASURED)


def item_of_test(cell: Cell, pages: Pages) -> ReproducedItem:
    """Verdict on a cell of Tables 10, 20, 21, A-2, A-3 and A-4."""
    if cell.table == "10":
        return _of_table_10(cell, pages)
    if cell.table == "20":
        return _of_table_20(cell, pages)
    if cell.table == "21":
        return _of_table_21(cell, pages)
    if cell.table == "A-2":
        return _effect(cell, pages)
    pair = cell.row.rpartition(" | ")[2]
    if pair in GROUPS:
        return _item_of_f_test(cell, pages, GROUPS[pair])
    return _item_of_group(cell, pages)


def change_of_table_10(pages: Pages, row: str, quantity: str) -> float:
    """Percentage by which an exposed line differs from the new one."""
    new = row.rpartition(" | ")[0] + " | new"
    mean, reference = (pages.printed("10", one, f"{quantity} mean") for one in (row, new))
    nothing = float("nan")
    found = ratio_of_means(
        mean, nothing, 2, reference_mean=reference, reference_standard_deviation=nothing,
        reference_n=2,
    )  # fmt: skip
    return 100 * float(found.change)


def _of_table_10(cell: Cell, pages: Pages) -> ReproducedItem:
    quantity, _, kind = cell.column.partition(" ")
    if kind == "change":
        value = change_of_table_10(pages, cell.row, quantity)
        return judge(cell, value, "mean over the mean of the new line")
    repeated = _elsewhere(cell, pages)
    if repeated is not None:
        value, half, where = repeated
        # a mean from 30 % of it, a count from degrees of freedom
        is_computed = "over 30 %" in where or "degrees" in where
        return (judge if is_computed else judge_repeat)(cell, value, where, tolerance=half)
    if kind == "mean":
        return _mean_by_change(cell, pages, quantity)
    return measured_item(cell, MEASURED)


def _elsewhere(cell: Cell, pages: Pages) -> tuple[float, float, str] | None:
    """The same number in another place: value, half its last digit, place."""
    line, _, condition = cell.row.rpartition(" | ")
    kind = cell.column.partition(" ")[2]
    if line.startswith("polyester | double") and ("21", cell.row, cell.column) in pages.by_key:
        place = ("21", cell.row, cell.column)
        return pages.printed(*place), pages.half(*place), "Table 21"
    if line == f"{PLAITED} | 1/2 in" and condition == "new":
        return _dry(cell, pages)
    if (
        cell.column == f"{STRENGTH} mean"
        and line.startswith("polyester | 8")
        and condition == "new"
    ):
        place = ("8", cell.row, "quasi_static_strain mean_tension high")
        return pages.printed(*place), pages.half(*place), "Table 8 prints it as a range"
    if kind == "number of samples" and condition != "new":
        for table, what in (("13", "hysteresis_energy"), ("12", "hysteresis_energy"),
                            ("5", "apparent_spring_constant")):  # fmt: skip
            key = (table, cell.row, f"{what} number of lines")
            # a count that is open itself is no evidence
            if key in pages.by_key and pages.cell(*key).confidence != "open":
                return pages.printed(*key), 0.5, f"lines of Table {table}"
    return None


def _dry(cell: Cell, pages: Pages) -> tuple[float, float, str] | None:
    """New plaited nylon is the dry line of App. A."""
    quantity, _, kind = cell.column.partition(" ")
    dry = f"{PLAITED} | 1/2 in | {DRY}"
    if quantity == STRENGTH and kind == "mean":
        place = ("8", cell.row, "quasi_static_strain mean_tension high")
        return pages.printed(*place) / 0.30, pages.half(*place) / 0.30, "range of Table 8 over 30 %"
    if kind == "number of samples":
        pair = f"{PLAITED} | 1/2 in | {DRY} against {WET}"
        within = pages.value("A-3", pair, "degrees of freedom within")
        return within + 2 - SAMPLES[WET], 0.5, "degrees of freedom of Table A-3"
    if quantity == STRENGTH:
        half = 0.5 * _common_step(pages, kind)
        return pages.printed("A-3", dry, f"{STRENGTH} {kind}"), half, "Table A-3, in tens of pounds"
    place = ("A-4", dry, f"{STRAIN_AT_FAILURE} {kind}")
    return pages.printed(*place) / 100, pages.half(*place) / 100, "Table A-4"


def _mean_by_change(cell: Cell, pages: Pages, quantity: str) -> ReproducedItem:
    """A mean from the other mean and the change between them."""
    line = cell.row.rpartition(" | ")[0]
    new = f"{line} | new"
    pairs = [
        (key[1], found)
        for key, found in pages.by_key.items()
        if key[0] == cell.table and key[1].startswith(line) and key[2] == f"{quantity} change"
    ]
    own = [pair for pair in pairs if cell.row in (pair[0], new)]
    if not own:
        return measured_item(cell, MEASURED)
    row, change = own[0]
    column = f"{quantity} mean"
    percent = number(change) if change.corrected is None else change.corrected
    if cell.row == new:
        inputs = [pages.printed(cell.table, row, column), percent]
        halves = [pages.half(cell.table, row, column), 0.5]

        def mean(other: float, percent: float) -> float:
            return other / (1 + percent / 100)
    else:
        inputs = [pages.printed(cell.table, new, column), percent]
        halves = [pages.half(cell.table, new, column), 0.5]

        def mean(other: float, percent: float) -> float:
            return other * (1 + percent / 100)

    allowed = rounding(mean, inputs, halves) + 0.5 * printed_step(cell.printed)
    return judge(
        cell, mean(*inputs), "the other mean and the change, rounded to a per cent",
        tolerance=allowed,
    )  # fmt: skip


def _of_table_20(cell: Cell, pages: Pages) -> ReproducedItem:
    kind = cell.column.partition(" ")[2]
    if kind not in ("mean", "standard deviation", "relative variability"):
        return measured_item(cell, MEASURED if kind == "number of samples" else "a setting")
    return _variability(cell, pages, "abrasion_cycles", kind)


def _variability(cell: Cell, pages: Pages, quantity: str, kind: str) -> ReproducedItem:
    """Mean, deviation and relative variability determine each other."""
    mean, deviation, relative = (
        f"{quantity} mean", f"{quantity} standard deviation", f"{quantity} relative variability",
    )  # fmt: skip

    def value(column: str) -> float:
        return pages.value(cell.table, cell.row, column)

    def half(column: str) -> float:
        return pages.half(cell.table, cell.row, column)

    if kind == "relative variability":
        allowed = rounding(
            lambda d, m: d / m, [value(deviation), value(mean)], [half(deviation), half(mean)]
        )
        return judge(cell, value(deviation) / value(mean), "deviation over mean", tolerance=allowed)
    # the variability of one line is misprinted, with three digits instead of two
    share = 0.5 * printed_step(f"{value(relative):g}")
    if kind == "mean":
        inputs, halves = [value(deviation), value(relative)], [half(deviation), share]
        allowed = rounding(lambda d, v: d / v, inputs, halves)
        return judge(
            cell, inputs[0] / inputs[1], "deviation over relative variability", tolerance=allowed
        )
    inputs, halves = [value(mean), value(relative)], [half(mean), share]
    allowed = rounding(lambda m, v: m * v, inputs, halves)
    return judge(cell, inputs[0] * inputs[1], "mean times relative variability", tolerance=allowed)


def _of_table_21(cell: Cell, pages: Pages) -> ReproducedItem:
    quantity, _, kind = cell.column.partition(" ")
    if kind == "change":
        new = cell.row.rpartition(" | ")[0] + " | new"
        mean, reference = (pages.printed("21", row, f"{quantity} mean") for row in (cell.row, new))
        return judge(cell, 100 * (mean / reference - 1), "mean over the mean of the new line")
    key = ("10", cell.row, cell.column)
    if key in pages.by_key:
        return judge_repeat(cell, pages.printed(*key), "Table 10")
    if kind == "mean":
        return _mean_by_change(cell, pages, quantity)
    return _variability(cell, pages, quantity, kind)


def _effect(cell: Cell, pages: Pages) -> ReproducedItem:
    quantity, _, kind = cell.column.partition(" ")
    if (quantity, kind) == (STRENGTH, "effect of diameter"):
        rows = [f"{PLAITED} | {size} in | {AFTER}" for size in ("1/2", "13/16")]
        small, large = (pages.printed("A-3", row, f"{STRENGTH} mean") for row in rows)
        return judge(cell, (large - small) / 1000, "means of Table A-3 after cycling, in 1000 lb")
    if quantity != STRAIN_AT_FAILURE or kind not in (
        "effect of diameter",
        "effect of mean_tension",
    ):
        return measured_item(cell, "the runs of the screening are not printed")
    places = [
        ("A-4", f"{PLAITED} | {size} in | {load}", f"{STRAIN_AT_FAILURE} mean")
        for size in ("1/2", "13/16") for load in (LOW, HIGH)
    ]  # fmt: skip
    signs = (-1, -1, 1, 1) if kind == "effect of diameter" else (-1, 1, -1, 1)

    def effect(*means: float) -> float:
        return abs(sum(sign * mean for sign, mean in zip(signs, means, strict=True))) / 2

    means = [pages.printed(*place) for place in places]
    allowed = rounding(effect, means, [pages.half(*place) for place in places])
    return judge(
        cell, effect(*means), "the four means of Table A-4",
        tolerance=allowed + 0.5 * printed_step(cell.printed),
    )  # fmt: skip
