"""CG-D-39-80, claims of the text on designs, levels and machines: mostly printed twice."""

from __future__ import annotations

from scipy.special import fdtr

from reduction.published.cell import Cell
from reduction.reproduce.cg_cells import Check, Pages, always, number
from reduction.reproduce.cg_lines import K_AP, NYLON_BRAIDS, PLAITED, SCREEN, levels_of
from reduction.reproduce.item import Item, agree, judge, not_testable
from reduction.reproduce.wording import judge_word
from reduction.surface.coding import coded_from_engineering
from reduction.surface.designs import box_behnken, plackett_burman

SETTING = "a setting of the tests"
PRINTED_IN = {"sec 4.3": "sec 4.4.2", "sec 4.4.2": "sec 4.3", "sec 6.3.1": "App G",
              "App G": "sec 6.3.1"}  # fmt: skip
"""Where a setting stands again."""


def _design(cell: Cell, pages: Pages) -> Item:
    if cell.row == "screening":
        return judge_word(cell, plackett_burman(5).n_runs, "Plackett-Burman of five factors")
    full = cell.column == "runs of a full factorial"
    design = box_behnken(3)
    return judge(
        cell, 3.0**design.n_factors if full else float(design.n_runs), "three factors, three levels"
    )


def _exposed_samples(cell: Cell, pages: Pages) -> Item:
    counts = {
        pages.printed("4", f"{PLAITED} | 1/2 in | {years}", f"{K_AP} number of lines")
        for years in ("4 years", "5 years")
    }
    return judge_word(cell, max(counts), "greater count of Table 4")


def _samples(cell: Cell, pages: Pages) -> Item:
    if cell.table == "sec 4.4.1":
        return _exposed_samples(cell, pages)
    if cell.table == "sec A-2.1":
        within = pages.value(
            "A-3", f"{PLAITED} | 13/16 in | wet, before against after cycling",
            "degrees of freedom within",
        )  # fmt: skip
        return judge_word(
            cell, within + 2 - 6, "degrees of freedom of Table A-3, six after cycling"
        )
    if cell.table == "sec 6.2.2":
        return not_testable(cell, "measured")
    counts = [
        number(found) for key, found in pages.by_key.items()
        if key[0] in ("4", "5", "12", "13") and key[1].endswith("new")
        and key[2].endswith("number of lines")
    ]  # fmt: skip
    return judge_word(cell, min(counts), "least count of Tables 4, 5, 12 and 13: three or four")


def _levels(cell: Cell, pages: Pages) -> Item:
    """Levels of the screening stand in Table A-1, those of the design in Table 1."""
    if cell.row == "screening":
        column = "duration high" if cell.column == "cycles" else cell.column
        return judge(cell, pages.printed("A-1", SCREEN, column), "Table A-1")
    if cell.row == "design":
        return judge(cell, pages.printed("1", levels_of(NYLON_BRAIDS[0]), cell.column), "Table 1")
    return not_testable(cell, SETTING)


def _never_slack(cell: Cell, pages: Pages) -> Item:
    return judge(cell, pages.printed("A-1", SCREEN, "duration high"), "Table A-1")


def _period(cell: Cell, pages: Pages) -> Item:
    """The reciprocal of the other end of the frequencies, in words."""
    other = "high" if cell.column.endswith("low") else "low"
    period = 1 / pages.printed("A-1", SCREEN, f"frequency {other}")
    return judge_word(cell, period, "reciprocal of a frequency of Table A-1")


def _confidence(cell: Cell, pages: Pages) -> Item:
    critical = pages.printed("3", NYLON_BRAIDS[0], f"{K_AP} F-crit")
    return judge(
        cell, 100 * float(fdtr(4, 10, critical)),
        f"{critical:g} of the tables with 4 and 10 degrees of freedom, which are transposed",
    )  # fmt: skip


def _printed_again(cell: Cell, pages: Pages) -> Item:
    table = PRINTED_IN[cell.table]
    row, column = {
        "weight of the sinker": ("field mooring", "weight of a sinker"),
        "weight of a sinker": ("field abrasion", "weight of the sinker"),
    }.get(cell.column, (cell.row, cell.column))
    return judge(cell, pages.printed(table, row, column), f"printed in {table} too")


def _synthetic_line(cell: Cell, pages: Pages) -> Item:
    table = "App H" if cell.table == "App G" else "App G"
    return judge(cell, pages.printed(table, cell.row, cell.column), f"printed in {table} too")


def _scope(cell: Cell, pages: Pages) -> Item:
    if cell.table == "App G":
        return not_testable(cell, "the depth of the field exposure is not printed")
    length, low, high = (
        pages.printed(cell.table, cell.row, column)
        for column in ("length of samples", "water_depth low", "water_depth high")
    )
    return judge(
        cell, 2 * length / (low + high),
        f"{length:g} ft of line on the middle of {low:g} to {high:g} ft",
    )  # fmt: skip


def _example(cell: Cell, pages: Pages) -> Item:
    """The middle level of App. C is halfway between the others."""
    low, centre, high = (
        pages.printed("App C", "example", f"mean_tension {level}")
        for level in ("low", "centre", "high")
    )
    found = {"low": 2 * centre - high, "centre": (low + high) / 2, "high": 2 * centre - low}
    return judge(cell, found[cell.column.split(" ")[-1]], "the other two levels")


def _mean_tension(cell: Cell, pages: Pages) -> Item:
    return (_example if cell.table == "App C" else _levels)(cell, pages)


def _coded(cell: Cell, pages: Pages) -> Item:
    level = float(cell.column.split(" ")[-2])
    low, high = (
        pages.printed("App C", "example", f"mean_tension {end}") for end in ("low", "high")
    )
    coded = float(coded_from_engineering([level], low=[low], high=[high])[0])
    printed = {"-\\frac{1}{2}": -0.5, "+1/2": 0.5}[cell.printed]
    return agree(cell, coded == printed, f"App. C with the levels {low:g} and {high:g} lb")


def _stroke(cell: Cell, pages: Pages) -> Item:
    feet = cell.column != "stroke"
    other = pages.printed(
        "App B", "machine", "stroke" if feet else "stroke of the tensile cylinder"
    )
    return judge(cell, other / 12 if feet else other * 12, "the other statement of App. B")


def _hysteresis_figure(cell: Cell, pages: Pages) -> Item:
    return judge(cell, 16.0, "list of figures: hysteresis is 16, snap loads are 19")


CLAIMS_OF_SETTINGS: dict[str, Check] = {
    "runs": _design,
    "runs of a full factorial": _design,
    "number of samples": _samples,
    "frequency low": _levels,
    "frequency high": _levels,
    "mean_tension low": _mean_tension,
    "mean_tension centre": _mean_tension,
    "mean_tension high": _mean_tension,
    "tension_amplitude low": _levels,
    "tension_amplitude high": _levels,
    "diameter low": _levels,
    "diameter high": _levels,
    "cycles": _levels,
    "cycles survived when never slack": _never_slack,
    "period low": _period,
    "period high": _period,
    "confidence of a fit": _confidence,
    "rate of the slow pull": _printed_again,
    "time before the slow pull": _printed_again,
    "weight of the sinker": _printed_again,
    "weight of a sinker": _printed_again,
    "synthetic line": _synthetic_line,
    "scope": _scope,
    "coded level of 300 lb": _coded,
    "coded level of 500 lb": _coded,
    "stroke": _stroke,
    "stroke of the tensile cylinder": _stroke,
    "figure of hysteresis": _hysteresis_figure,
    "table of the screening design": always("Table 1 is of the nylon braids; see its erratum"),
    "section of the tensile strengths": always("there is no section 4.6; see its erratum"),
}
"""By the column of the claim."""
