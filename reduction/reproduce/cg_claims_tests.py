"""CG-D-39-80, claims of the text on strength, snap loads, abrasion and the screening."""

from __future__ import annotations

import numpy as np

from reduction.outcomes.abrasion import ratio_to_published_life
from reduction.outcomes.exposure import fit_exposure_trend
from reduction.outcomes.life import ratio_of_lives
from reduction.published.cell import Cell
from reduction.reproduce.cg_cells import Check, Pages, always, number
from reduction.reproduce.cg_lines import (
    PLAITED,
    POLYESTER_BRAID,
    SCREEN,
    STRAIN_AT_FAILURE,
    STRENGTH,
)  # fmt: skip
from reduction.reproduce.cg_tests import change_of_table_10
from reduction.reproduce.item import Item, agree, judge
from reduction.reproduce.wording import judge_round, judge_word

CYCLES = "abrasion_cycles"
FIGURE_19 = "Figure 19 is not in the text"


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
    return judge_round(cell, farthest, "the line of Table 10 that is farthest from it")


def _linear(cell: Cell, pages: Pages) -> Item:
    line = fit_exposure_trend(
        [0, 2, 3, 5],
        [
            pages.value("10", f"{POLYESTER_BRAID} | new", f"{STRENGTH} mean"),
            pages.value("sec 6.3.2", f"{POLYESTER_BRAID} | 2 years", STRENGTH),
            pages.value("21", f"{POLYESTER_BRAID} | 3 years", f"{STRENGTH} mean"),
            pages.value("10", f"{POLYESTER_BRAID} | 5 years", f"{STRENGTH} mean"),
        ],
        [
            pages.value("10", f"{POLYESTER_BRAID} | new", f"{STRENGTH} standard deviation"),
            np.nan,
            pages.value("21", f"{POLYESTER_BRAID} | 3 years", f"{STRENGTH} standard deviation"),
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
    if not cell.column.startswith("least"):
        peak = pages.printed("A-1", SCREEN, "mean_tension high") + high
        # said to be approximate there, and there alone
        held = judge_round if cell.table == "sec 3.4" else judge
        return held(cell, peak, "mean load and amplitude of Table A-1")
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
    # plaited line is as claimed; a claim on the material has to hold of twisted line too
    return judge_word(
        cell, ratios[1],
        "twisted line of Table 20; plaited and twisted are "
        + " and ".join(f"{ratio:.2f}" for ratio in ratios),
    )  # fmt: skip


def _over_polyester(cell: Cell, pages: Pages) -> Item:
    ratios = [
        pages.value("20", f"nylon | {how} | 1/2 in | new", f"{CYCLES} mean")
        / pages.value("20", f"polyester | {how} | 1/2 in | new", f"{CYCLES} mean")
        for how in ("double braid", "8-strand plaited", "3-strand twisted")
    ]
    return judge_word(
        cell, ratios[0],
        "braid of Table 20, which is farthest from 1.5; braid, plaited and twisted are "
        + ", ".join(f"{ratio:.2f}" for ratio in ratios),
        step=0.5,
    )  # fmt: skip


def _jacket(cell: Cell, pages: Pages) -> Item:
    section, jacketed = "sec 6.2.2", f"{POLYESTER_BRAID} | jacketed"
    lives = np.array([
        pages.value(section, jacketed, f"{CYCLES} {one}") for one in ("first", "second", "third")
    ])  # fmt: skip
    plain = np.array([
        pages.value(section, f"{POLYESTER_BRAID} | new", f"{CYCLES} {one}")
        for one in ("least", "mode", "greatest")
    ])  # fmt: skip
    of_mode = lives / plain[1]
    kind = ("mean", "standard deviation", "number of samples")
    mean, deviation, count = (
        pages.value("20", f"{POLYESTER_BRAID} | new", f"{CYCLES} {one}") for one in kind
    )
    ratio, low, high = ratio_to_published_life(
        lives, [False] * 3, reference_mean=mean, reference_standard_deviation=deviation,
        reference_n=int(count),
    )  # fmt: skip
    medians, *_ = ratio_of_lives(
        np.concatenate([lives, plain]), [False] * 6, [False] * 3 + [True] * 3
    )
    middle = np.mean if cell.column.endswith("low") else np.median
    return judge(
        cell, float(middle(of_mode)),
        f"{middle.__name__} of three lives over the mode: "
        f"{', '.join(f'{one:.1f}' for one in of_mode)}; medians of the lives of the text "
        f"{medians:.1f}; over the mean life of Table 20 {lives.mean() / mean:.1f}, medians "
        f"{ratio:.1f} ({low:.1f} to {high:.1f})",
    )  # fmt: skip


CLAIMS_OF_TESTS: dict[str, Check] = {
    f"{STRENGTH} against years": _linear,
    f"{STRENGTH} mean": _repeated,
    f"{STRENGTH} change": _repeated,
    f"{STRAIN_AT_FAILURE} change": _repeated,
    f"{STRAIN_AT_FAILURE} rise": _half,
    f"{STRENGTH} fall": lambda cell, pages: (_wet if cell.table == "sec A-4.6" else _half)(
        cell, pages
    ),
    "greatest load when never slack": _screened,
    "least load when never slack": _screened,
    "greatest load when slack": always(FIGURE_19),
    "load survived when slack": always(FIGURE_19),
    "load of the guideline when slack": always(FIGURE_19),
    "load of the guideline when never slack": _screened,
    "cycles survived when slack": always(FIGURE_19),
    "load without failure when slack": always(FIGURE_19),
    "load with failure when slack": always(FIGURE_19),
    f"{CYCLES} ratio low": _jacket,
    f"{CYCLES} ratio high": _jacket,
    f"{CYCLES} ratio": lambda cell, pages: (
        _over_polyester if cell.row.endswith("polyester") else _over_polypropylene
    )(cell, pages),
    "relative variability": always("deviations of the stiffness are not printed"),
    "K_1 over K_0 low": always("the runs of the screening are not printed"),
    "K_1 over K_0 high": always("the runs of the screening are not printed"),
    "relaxation_time mean": always("the runs of the screening are not printed"),
    "H over greatest H": always("the runs of the screening are not printed"),
}
"""By the column of the claim."""
CLAIMS_OF_TESTS |= {
    f"{quantity} significant factors": _significant
    for quantity in (
        "apparent_spring_constant", "quasi_static_spring_constant", "dissipation_spring_constant",
        "relaxation_time", "hysteresis_energy", STRENGTH, STRAIN_AT_FAILURE,
    )
}  # fmt: skip
