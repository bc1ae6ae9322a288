"""CG-D-39-80, claims of the text on strength, snap loads, abrasion, screening and machines."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from reduction.outcomes.abrasion import ratio_to_published_life
from reduction.outcomes.exposure import fit_exposure_line
from reduction.outcomes.life import ratio_of_lives
from reduction.published.cell import Cell
from reduction.reproduce.cg_cells import Pages, agree, number
from reduction.reproduce.cg_claims import step_of_round_number
from reduction.reproduce.cg_tests import change_of_table_10
from reduction.reproduce.item import Item, judge, not_testable
from reduction.surface.coding import coded_from_engineering
from reduction.surface.designs import box_behnken, plackett_burman

__all__ = ["CLAIMS_OF_TESTS"]

STRENGTH, STRAIN, CYCLES = "tensile_strength", "strain_at_failure", "abrasion_cycles"
BRAID = "polyester | double braid | 1/2 in"
PLAITED = "nylon | 8-strand plaited"
SCREEN = f"screening | {PLAITED}"
FIGURE_19 = "Figure 19 is not in the text"
SETTING = "a setting of the tests"

Check = Callable[[Cell, Pages], Item]


def _always(why: str) -> Check:
    return lambda cell, pages: not_testable(cell, why)


def _changes(pages: Pages, quantity: str) -> list[float]:
    return [
        change_of_table_10(pages, row, quantity)
        for table, row, column in pages.by_key
        if table == "10" and column == f"{quantity} change"
    ]


def _half(cell: Cell, pages: Pages) -> Item:
    """About 50 % for every line: the one that is farthest from it."""
    quantity = cell.column.partition(" ")[0]
    sizes = [abs(change) for change in _changes(pages, quantity)]
    farthest = max(sizes, key=lambda size: abs(size - number(cell)))
    return judge(
        cell, farthest, "the line of Table 10 that is farthest from it",
        tolerance=0.5 * step_of_round_number(number(cell)),
    )  # fmt: skip


def _linear(cell: Cell, pages: Pages) -> Item:
    line = fit_exposure_line(
        [0, 2, 3, 5],
        [
            pages.value("10", f"{BRAID} | new", f"{STRENGTH} mean"),
            pages.value("sec 6.3.2", f"{BRAID} | 2 years", STRENGTH),
            pages.value("21", f"{BRAID} | 3 years", f"{STRENGTH} mean"),
            pages.value("10", f"{BRAID} | 5 years", f"{STRENGTH} mean"),
        ],
        [
            pages.value("10", f"{BRAID} | new", f"{STRENGTH} standard deviation"),
            np.nan,
            pages.value("21", f"{BRAID} | 3 years", f"{STRENGTH} standard deviation"),
            np.nan,
        ],
        [16, 1, 4, 2],
    )
    return agree(
        cell, line.lack_of_fit_p_value > 0.05,
        f"{line.slope:.0f} lb a year from {line.intercept:.0f} lb; lack of fit p = "
        f"{line.lack_of_fit_p_value:.2f} (Tables 10, 21, sec. 6.3.2; four samples after 3 years)",
    )  # fmt: skip


def _wet(cell: Cell, pages: Pages) -> Item:
    dry, wet = (
        pages.printed("A-3", f"{PLAITED} | 1/2 in | {state}", f"{STRENGTH} mean")
        for state in ("dry, not cycled", "wet, before cycling")
    )
    return judge(cell, 100 * (1 - wet / dry), "Table A-3")


def _repeated(cell: Cell, pages: Pages) -> Item:
    """Numbers of Tables 10 and 21 that the text repeats."""
    if cell.column.endswith("change"):
        return judge(cell, abs(pages.printed("21", cell.row, cell.column)), "Table 21")
    return judge(cell, pages.printed("10", cell.row, cell.column), "Table 10")


def _screened(cell: Cell, pages: Pages) -> Item:
    """Peak and valley of the screening, from its levels."""
    high = pages.printed("A-1", SCREEN, "tension_amplitude high")
    if cell.column.startswith("greatest"):
        peak = pages.printed("A-1", SCREEN, "mean_tension high") + high
        value = number(cell)
        step = step_of_round_number(value) if cell.table == "sec 3.4" else 1.0
        return judge(cell, peak, "mean load and amplitude of Table A-1", tolerance=0.5 * step)
    least = pages.printed("A-1", SCREEN, "mean_tension low") - high
    return judge(cell, least, "mean load less amplitude of Table A-1")


def _significant(cell: Cell, pages: Pages) -> Item:
    quantity = cell.column.partition(" ")[0]
    smallest = pages.value("A-2", SCREEN, f"{quantity} smallest significant effect")
    factors = ("frequency", "mean_tension", "tension_amplitude", "duration", "diameter")
    found = [
        factor for factor in factors
        if pages.value("A-2", SCREEN, f"{quantity} effect of {factor}") > smallest
    ]  # fmt: skip
    named = [] if cell.printed == "no factor" else cell.printed.split(", ")
    said = set(named) <= set(found)
    return agree(
        cell, said and bool(found) == bool(named), "Table A-2: " + (", ".join(found) or "none")
    )


def _over_polypropylene(cell: Cell, pages: Pages) -> Item:
    material = cell.row.partition(" ")[0]
    ratios = [
        pages.value("20", f"{material} | {how} | 1/2 in | new", f"{CYCLES} mean")
        / pages.value("20", f"polypropylene | {how} | 1/2 in | new", f"{CYCLES} mean")
        for how in ("8-strand plaited", "3-strand twisted")
    ]
    claimed = {"three": 3, "two": 2}[cell.printed]
    return agree(
        cell, all(round(ratio) == claimed for ratio in ratios),
        "plaited and twisted of Table 20: " + ", ".join(f"{ratio:.2f}" for ratio in ratios),
    )  # fmt: skip


def _over_polyester(cell: Cell, pages: Pages) -> Item:
    ratios = [
        pages.value("20", f"nylon | {how} | 1/2 in | new", f"{CYCLES} mean")
        / pages.value("20", f"polyester | {how} | 1/2 in | new", f"{CYCLES} mean")
        for how in ("double braid", "8-strand plaited", "3-strand twisted")
    ]
    # said in halves: 1.25 to 1.75
    return agree(
        cell, all(round(2 * ratio) == 3 for ratio in ratios),
        "braid, plaited and twisted of Table 20: " + ", ".join(f"{ratio:.2f}" for ratio in ratios),
    )  # fmt: skip


def _jacket(cell: Cell, pages: Pages) -> Item:
    section, jacketed = "sec 6.2.2", f"{BRAID} | jacketed"
    lives = np.array([
        pages.value(section, jacketed, f"{CYCLES} {one}") for one in ("first", "second", "third")
    ])  # fmt: skip
    plain = np.array([
        pages.value(section, f"{BRAID} | new", f"{CYCLES} {one}")
        for one in ("least", "mode", "greatest")
    ])  # fmt: skip
    of_mode = lives / plain[1]
    kind = ("mean", "standard deviation", "number of samples")
    mean, deviation, count = (
        pages.value("20", f"{BRAID} | new", f"{CYCLES} {one}") for one in kind
    )
    ratio, low, high = ratio_to_published_life(
        lives, [False] * 3, reference_mean=mean, reference_standard_deviation=deviation,
        reference_n=int(count),
    )  # fmt: skip
    medians, *_ = ratio_of_lives(
        np.concatenate([lives, plain]), [False] * 6, [False] * 3 + [True] * 3
    )
    return agree(
        cell, 5 <= float(of_mode.mean()) <= 6,
        f"three lives over the mode: {', '.join(f'{one:.1f}' for one in of_mode)}, mean "
        f"{of_mode.mean():.1f}; medians of the lives of the text {medians:.1f}; over the mean life "
        f"of Table 20 {lives.mean() / mean:.1f}, medians {ratio:.1f} ({low:.1f} to {high:.1f})",
    )  # fmt: skip


def _design(cell: Cell, pages: Pages) -> Item:
    if cell.row == "screening":
        runs = plackett_burman(5).n_runs
        return agree(
            cell, runs == 12 and cell.printed == "twelve", "Plackett-Burman of five factors"
        )
    full = cell.column == "runs of a full factorial"
    design = box_behnken(3)
    return judge(
        cell, 3.0**design.n_factors if full else float(design.n_runs), "three factors, three levels"
    )


def _two_samples(cell: Cell, pages: Pages) -> Item:
    counts = {
        pages.printed(
            "4", f"{PLAITED} | 1/2 in | {years}", "apparent_spring_constant number of lines"
        )
        for years in ("4 years", "5 years")
    }
    return agree(cell, counts == {2.0}, "Table 4")


def _samples(cell: Cell, pages: Pages) -> Item:
    if cell.table == "sec A-2.1":
        within = pages.value(
            "A-3", f"{PLAITED} | 13/16 in | wet, before against after cycling",
            "degrees of freedom within",
        )  # fmt: skip
        return agree(
            cell, within + 2 - 6 == 9, "degrees of freedom of Table A-3, six after cycling"
        )
    if cell.table == "sec 6.2.2":
        return not_testable(cell, "measured")
    counts = [
        number(found) for key, found in pages.by_key.items()
        if key[0] in ("4", "5", "12", "13") and key[1].endswith("new")
        and key[2].endswith("number of lines")
    ]  # fmt: skip
    return agree(cell, set(counts) == {4.0}, "Tables 4, 5, 12 and 13 count three or four")


def _levels(cell: Cell, pages: Pages) -> Item:
    if cell.column.startswith("frequency ") and cell.row == "screening":
        return judge(cell, pages.printed("A-1", SCREEN, cell.column), "Table A-1")
    if cell.column == "cycles" and cell.row == "screening":
        return judge(cell, pages.printed("A-1", SCREEN, "duration high"), "Table A-1")
    return not_testable(cell, SETTING)


def _coded(cell: Cell, pages: Pages) -> Item:
    level = float(cell.column.split(" ")[-2])
    coded = float(coded_from_engineering([level], low=[200.0], high=[600.0])[0])
    printed = {"-\\frac{1}{2}": -0.5, "+1/2": 0.5}[cell.printed]
    return agree(cell, coded == printed, "App. C with the levels 200 and 600 lb")


def _stroke(cell: Cell, pages: Pages) -> Item:
    feet = cell.column != "stroke"
    other = pages.printed(
        "App B", "machine", "stroke" if feet else "stroke of the tensile cylinder"
    )
    return judge(cell, other / 12 if feet else other * 12, "the other statement of App. B")


def _hysteresis_figure(cell: Cell, pages: Pages) -> Item:
    return judge(cell, 16.0, "list of figures: hysteresis is 16, snap loads are 19")


CLAIMS_OF_TESTS: dict[str, Check] = {
    f"{STRENGTH} against years": _linear,
    f"{STRENGTH} mean": _repeated,
    f"{STRENGTH} change": _repeated,
    f"{STRAIN} change": _repeated,
    f"{STRAIN} rise": _half,
    f"{STRENGTH} fall": lambda cell, pages: (_wet if cell.table == "sec A-4.6" else _half)(
        cell, pages
    ),
    "greatest load when never slack": _screened,
    "least load when never slack": _screened,
    "greatest load when slack": _always(FIGURE_19),
    "cycles survived when slack": _always(FIGURE_19),
    "load without failure when slack": _always(FIGURE_19),
    "load with failure when slack": _always(FIGURE_19),
    f"{CYCLES} ratio low": _jacket,
    f"{CYCLES} ratio high": _jacket,
    f"{CYCLES} ratio": lambda cell, pages: (
        _over_polyester if cell.row.endswith("polyester") else _over_polypropylene
    )(cell, pages),
    "runs": _design,
    "runs of a full factorial": _design,
    "number of samples": lambda cell, pages: (
        _two_samples if cell.printed == "two samples each" else _samples
    )(cell, pages),
    "frequency low": _levels,
    "frequency high": _levels,
    "cycles": _levels,
    "coded level of 300 lb": _coded,
    "coded level of 500 lb": _coded,
    "stroke": _stroke,
    "stroke of the tensile cylinder": _stroke,
    "figure of hysteresis": _hysteresis_figure,
    "relative variability": _always("deviations of the stiffness are not printed"),
    "K_1 over K_0 low": _always("the runs of the screening are not printed"),
    "K_1 over K_0 high": _always("the runs of the screening are not printed"),
    "relaxation_time mean": _always("the runs of the screening are not printed"),
    "H over greatest H": _always("the runs of the screening are not printed"),
}
"""By the column of the claim."""
CLAIMS_OF_TESTS |= {
    f"{quantity} significant factors": _significant
    for quantity in (
        "apparent_spring_constant", "quasi_static_spring_constant", "dissipation_spring_constant",
        "relaxation_time", "hysteresis_energy", STRENGTH, STRAIN,
    )
}  # fmt: skip
