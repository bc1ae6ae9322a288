"""CG-D-39-80: claims of the text."""

from __future__ import annotations

import numpy as np
from scipy.special import fdtr, fdtri

from reduction.experiments.designs import (
    box_behnken,
    coded_from_engineering,
    model_matrix,
    plackett_burman,
    quadratic_exponents,
)
from reduction.experiments.life_statistics import ratio_of_lives, ratio_to_published_life
from reduction.experiments.strength_statistics import fit_exposure_trend
from reduction.published.cg_cells import (
    CENTRE_LINES,  # fmt: skip
    ENERGY,  # fmt: skip
    K_1,  # fmt: skip
    K_AP,
    NYLON_BRAID,  # fmt: skip
    NYLON_BRAIDS,
    NYLON_PLAITED,  # fmt: skip
    PLAITED,
    POLYESTER_BRAID,  # fmt: skip
    POLYESTER_PLAITED,  # fmt: skip
    SCREEN,
    STRAIN_AT_FAILURE,  # fmt: skip
    STRENGTH,  # fmt: skip
    TIME,  # fmt: skip
    Check,
    Pages,
    always,
    centre_stiffness,  # fmt: skip
    levels_of,
    number,
)
from reduction.published.cg_surfaces import change_of_mean
from reduction.published.cg_tests import change_of_table_10
from reduction.published.printed_cells import Cell
from reduction.published.reproduced_item import (
    ReproducedItem,
    agree,
    compared_item,
    judge,
    judge_repeat,
    judge_round,
    judge_word,
    measured_item,
)
from reduction.stages.three_parameter_line.line_model import apparent_spring_constant

SETTING = "a setting of the tests"

PRINTED_IN = {"sec 4.3": "sec 4.4.2", "sec 4.4.2": "sec 4.3", "sec 6.3.1": "App G",
              "App G": "sec 6.3.1"}  # fmt: skip
"""Place where a setting is printed again."""


def _design(cell: Cell, pages: Pages) -> ReproducedItem:
    if cell.row == "screening":
        return judge_word(cell, plackett_burman(5).n_runs, "Plackett-Burman of five factors")
    full = cell.column == "runs of a full factorial"
    design = box_behnken(3)
    return judge(
        cell, 3.0**design.n_factors if full else float(design.n_runs), "three factors, three levels"
    )


def _exposed_samples(cell: Cell, pages: Pages) -> ReproducedItem:
    counts = {
        pages.printed("4", f"{PLAITED} | 1/2 in | {years}", f"{K_AP} number of lines")
        for years in ("4 years", "5 years")
    }
    return judge_word(cell, max(counts), "greater count of Table 4")


def _samples(cell: Cell, pages: Pages) -> ReproducedItem:
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
        return measured_item(cell, "measured")
    counts = [
        number(found) for key, found in pages.by_key.items()
        if key[0] in ("4", "5", "12", "13") and key[1].endswith("new")
        and key[2].endswith("number of lines")
    ]  # fmt: skip
    return judge_word(cell, min(counts), "least count of Tables 4, 5, 12 and 13: three or four")


def _levels(cell: Cell, pages: Pages) -> ReproducedItem:
    """Levels of the screening are in Table A-1, those of the design in Table 1."""
    if cell.row == "screening":
        column = "duration high" if cell.column == "cycles" else cell.column
        return judge_repeat(cell, pages.printed("A-1", SCREEN, column), "Table A-1")
    if cell.row == "design":
        found = pages.printed("1", levels_of(NYLON_BRAIDS[0]), cell.column)
        return judge_repeat(cell, found, "Table 1")
    return measured_item(cell, SETTING)


def _never_slack(cell: Cell, pages: Pages) -> ReproducedItem:
    return judge_repeat(cell, pages.printed("A-1", SCREEN, "duration high"), "Table A-1")


def _period(cell: Cell, pages: Pages) -> ReproducedItem:
    """The reciprocal of the other end of the frequency range, in words."""
    other = "high" if cell.column.endswith("low") else "low"
    period = 1 / pages.printed("A-1", SCREEN, f"frequency {other}")
    return judge_word(cell, period, "reciprocal of a frequency of Table A-1")


def _confidence(cell: Cell, pages: Pages) -> ReproducedItem:
    critical = pages.printed("3", NYLON_BRAIDS[0], f"{K_AP} F-crit")
    return judge(
        cell, 100 * float(fdtr(4, 10, critical)),
        f"{critical:g} of the tables with 4 and 10 degrees of freedom, which are transposed",
    )  # fmt: skip


def _printed_again(cell: Cell, pages: Pages) -> ReproducedItem:
    table = PRINTED_IN[cell.table]
    row, column = {
        "weight of the sinker": ("field mooring", "weight of a sinker"),
        "weight of a sinker": ("field abrasion", "weight of the sinker"),
    }.get(cell.column, (cell.row, cell.column))
    return judge_repeat(cell, pages.printed(table, row, column), f"printed in {table} too")


def _synthetic_line(cell: Cell, pages: Pages) -> ReproducedItem:
    table = "App H" if cell.table == "App G" else "App G"
    found = pages.printed(table, cell.row, cell.column)
    return judge_repeat(cell, found, f"printed in {table} too")


def _scope(cell: Cell, pages: Pages) -> ReproducedItem:
    if cell.table == "App G":
        return measured_item(cell, "the depth of the field exposure is not printed")
    length, low, high = (
        pages.printed(cell.table, cell.row, column)
        for column in ("length of samples", "water_depth low", "water_depth high")
    )
    return judge(
        cell, 2 * length / (low + high),
        f"{length:g} ft of line on the middle of {low:g} to {high:g} ft",
    )  # fmt: skip


def _example(cell: Cell, pages: Pages) -> ReproducedItem:
    """The middle level of App. C is halfway between the others."""
    low, centre, high = (
        pages.printed("App C", "example", f"mean_tension {level}")
        for level in ("low", "centre", "high")
    )
    found = {"low": 2 * centre - high, "centre": (low + high) / 2, "high": 2 * centre - low}
    return judge(cell, found[cell.column.split(" ")[-1]], "the other two levels")


def _mean_tension(cell: Cell, pages: Pages) -> ReproducedItem:
    return (_example if cell.table == "App C" else _levels)(cell, pages)


def _coded(cell: Cell, pages: Pages) -> ReproducedItem:
    level = float(cell.column.split(" ")[-2])
    low, high = (
        pages.printed("App C", "example", f"mean_tension {end}") for end in ("low", "high")
    )
    coded = float(coded_from_engineering([level], low=[low], high=[high])[0])
    printed = {"-\\frac{1}{2}": -0.5, "+1/2": 0.5}[cell.printed]
    return agree(cell, coded == printed, f"App. C with the levels {low:g} and {high:g} lb")


def _stroke(cell: Cell, pages: Pages) -> ReproducedItem:
    feet = cell.column != "stroke"
    other = pages.printed(
        "App B", "machine", "stroke" if feet else "stroke of the tensile cylinder"
    )
    return judge(cell, other / 12 if feet else other * 12, "the other statement of App. B")


def _hysteresis_figure(cell: Cell, pages: Pages) -> ReproducedItem:
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
"""Checks by the column of the claim."""

STRENGTH_OF_SPEED = {
    NYLON_BRAID: ("2", f"{NYLON_BRAID} | all", "rated_break_strength"),
    NYLON_PLAITED: ("10", f"{NYLON_PLAITED} | new", "tensile_strength mean"),
    POLYESTER_BRAID: ("10", f"{POLYESTER_BRAID} | new", "tensile_strength mean"),
    POLYESTER_PLAITED: ("10", f"{POLYESTER_PLAITED} | new", "tensile_strength mean"),
}


def _sizes_at(pages: Pages, tension: float) -> str:
    found = {row: pages.polynomial("7" if row == NYLON_BRAIDS[0] else "6", row, tension)
             for row in NYLON_BRAIDS}  # fmt: skip
    return min(found, key=lambda row: found[row])


def _least_stiffness(cell: Cell, pages: Pages) -> ReproducedItem:
    tension = float(cell.column.split(" ")[-2])
    row = _sizes_at(pages, tension)
    return agree(
        cell, f"| {cell.printed.removesuffix('-inch')} in " in row,
        f"K_0 of Tables 6 and 7 at {tension:g} lb is least for {row}",
    )  # fmt: skip


def _rest_with_exposure(cell: Cell, pages: Pages) -> ReproducedItem:
    ratios = []
    for line, tensions in (
        (NYLON_BRAID, (768.0, 1344.0, 1920.0)),
        (NYLON_PLAITED, (691.2, 1209.6, 1728.0)),
    ):
        for tension in tensions:
            new = pages.polynomial("7", f"{line} | new", tension)
            ratios.append(pages.slope("9", f"{line} | 5 years", tension) / new)
    return agree(
        cell, min(ratios) > 1,
        "K_0 exposed over new at the levels, braid and plaited: "
        + ", ".join(f"{ratio:.2f}" for ratio in ratios),
    )  # fmt: skip


def _rest_of_polyester(cell: Cell, pages: Pages) -> ReproducedItem:
    if cell.column.endswith("low loads"):
        ratio = pages.polynomial("7", cell.row, 840.0) / pages.polynomial(
            "7", f"{POLYESTER_BRAID} | new", 840.0
        )
        return agree(
            cell,
            ratio < 0.5,
            f"read as below half; K_0 at 840 lb is {ratio:.2f} times that of new line",
        )
    # with both prints of the new cubic, since it is open which one is right
    ratios = {
        table: sorted(
            pages.slope("9", cell.row, load)
            / pages.slope(table, f"{POLYESTER_PLAITED} | new", load)
            for load in (792.0, 1386.0, 1980.0)
        )
        for table in ("8", "9")
    }
    return agree(
        cell, all(three[1] > 1 for three in ratios.values()),
        "read as at most levels; slope of Table 9 over that of new line at three levels: "
        + "; ".join(
            f"{', '.join(f'{one:.2f}' for one in three)} (Table {table})"
            for table, three in ratios.items()
        ),
    )  # fmt: skip


def _strain_at_share(pages: Pages, line: str) -> float:
    return 100 * pages.strain("8", f"{line} | new", 0.3 * pages.printed(*STRENGTH_OF_SPEED[line]))


def _strain(cell: Cell, pages: Pages) -> ReproducedItem:
    line = cell.row.rpartition(" | ")[0]
    strength = pages.printed(*STRENGTH_OF_SPEED[line])
    return judge(
        cell, _strain_at_share(pages, line),
        f"Table 8 at 30 % of {strength:g} lb, Table {STRENGTH_OF_SPEED[line][0]}",
    )  # fmt: skip


def _strain_of_materials(cell: Cell, pages: Pages) -> ReproducedItem:
    ratios = sorted([
        _strain_at_share(pages, NYLON_PLAITED) / _strain_at_share(pages, POLYESTER_PLAITED),
        _strain_at_share(pages, NYLON_BRAID) / _strain_at_share(pages, POLYESTER_BRAID),
    ])  # fmt: skip
    return judge(
        cell,
        ratios[cell.column.endswith("high")],
        "Table 8 at 30 % of the strength, plaited and braid",
    )


def _strain_of_sizes(cell: Cell, pages: Pages) -> ReproducedItem:
    ratios = []
    for share in (0.10, 0.15, 0.20, 0.25):
        small, large = (
            pages.strain("8", row, share * pages.value("1", row, "rated_break_strength"))
            for row in (NYLON_BRAIDS[0], NYLON_BRAIDS[2])
        )
        ratios.append(large / small)
    return judge_word(
        cell, max(ratios, key=lambda ratio: abs(ratio - np.mean(ratios))),
        "farthest of Table 8 at 10 to 25 % of the strength: "
        + ", ".join(f"{one:.2f}" for one in ratios),
    )  # fmt: skip


def _rest(cell: Cell, pages: Pages) -> ReproducedItem:
    one = cell.row == f"{POLYESTER_PLAITED} | 4 years"
    return _rest_of_polyester(cell, pages) if one else _rest_with_exposure(cell, pages)


CLAIMS_OF_PULLS: dict[str, Check] = {
    "diameter of least K_0 at 1000 lb": _least_stiffness,
    "diameter of least K_0 at 2000 lb": _least_stiffness,
    "quasi_static_spring_constant": _rest,
    "quasi_static_spring_constant at low loads": _rest_of_polyester,
    "quasi_static_strain ratio": _strain_of_sizes,
    "quasi_static_strain ratio low": _strain_of_materials,
    "quasi_static_strain ratio high": _strain_of_materials,
    "quasi_static_strain at 30 %RBS": _strain,
}
"""Checks by the column of the claim."""

CYCLES = "abrasion_cycles"

FIGURE_19 = "Figure 19 is not in the text"


def _changes(pages: Pages, quantity: str) -> list[float]:
    return [
        change_of_table_10(pages, row, quantity)
        for table, row, column in pages.by_key
        if table == "10" and column == f"{quantity} change"
    ]


def _half(cell: Cell, pages: Pages) -> ReproducedItem:
    """About 50 % for every line: the line that differs most from it."""
    quantity = cell.column.partition(" ")[0]
    sizes = [abs(change) for change in _changes(pages, quantity)]
    farthest = max(sizes, key=lambda size: abs(size - number(cell)))
    return judge_round(cell, farthest, "the line of Table 10 that is farthest from it")


def strength_over_years(pages: Pages) -> tuple[list[float], ...]:
    """Braided polyester: years in the sea, mean strength, deviation (NaN for one) and samples."""
    mean, deviation = f"{STRENGTH} mean", f"{STRENGTH} standard deviation"
    new, later = (f"{POLYESTER_BRAID} | {age}" for age in ("new", "3 years"))
    strengths = [
        pages.value("10", new, mean),
        pages.value("sec 6.3.2", f"{POLYESTER_BRAID} | 2 years", STRENGTH),
        pages.value("21", later, mean),
        pages.value("10", f"{POLYESTER_BRAID} | 5 years", mean),
    ]
    scatter = [
        pages.value("10", new, deviation),
        np.nan,
        pages.value("21", later, deviation),
        np.nan,
    ]
    return [0.0, 2.0, 3.0, 5.0], strengths, scatter, [16.0, 1.0, 4.0, 2.0]


def _linear(cell: Cell, pages: Pages) -> ReproducedItem:
    line = fit_exposure_trend(*strength_over_years(pages))
    return agree(
        cell, line.lack_of_fit_p_value > 0.05,
        f"{line.slope:.0f} lb a year from {line.intercept:.0f} lb; lack of fit p = "
        f"{line.lack_of_fit_p_value:.2f} (Tables 10, 21, sec. 6.3.2; four samples after 3 years)",
    )  # fmt: skip


def _wet(cell: Cell, pages: Pages) -> ReproducedItem:
    dry, wet = (
        pages.printed("A-3", f"{PLAITED} | 1/2 in | {state}", f"{STRENGTH} mean")
        for state in ("dry, not cycled", "wet, before cycling")
    )
    return judge(cell, 100 * (1 - wet / dry), "Table A-3")


def _repeated(cell: Cell, pages: Pages) -> ReproducedItem:
    """Numbers of Tables 10 and 21 that the text repeats."""
    if cell.column.endswith("change"):
        return judge_repeat(cell, abs(pages.printed("21", cell.row, cell.column)), "Table 21")
    return judge_repeat(cell, pages.printed("10", cell.row, cell.column), "Table 10")


def _screened(cell: Cell, pages: Pages) -> ReproducedItem:
    """Peak and valley of the screening, from its levels."""
    high = pages.printed("A-1", SCREEN, "tension_amplitude high")
    if not cell.column.startswith("least"):
        peak = pages.printed("A-1", SCREEN, "mean_tension high") + high
        # called approximate there, and only there
        held = judge_round if cell.table == "sec 3.4" else judge
        return held(cell, peak, "mean load and amplitude of Table A-1")
    least = pages.printed("A-1", SCREEN, "mean_tension low") - high
    return judge(cell, least, "mean load less amplitude of Table A-1")


def _significant(cell: Cell, pages: Pages) -> ReproducedItem:
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


def _over_polypropylene(cell: Cell, pages: Pages) -> ReproducedItem:
    material = cell.row.partition(" ")[0]
    ratios = [
        pages.value("20", f"{material} | {how} | 1/2 in | new", f"{CYCLES} mean")
        / pages.value("20", f"polypropylene | {how} | 1/2 in | new", f"{CYCLES} mean")
        for how in ("8-strand plaited", "3-strand twisted")
    ]
    # plaited line agrees with the claim; a claim on the material must hold for twisted line too
    return judge_word(
        cell, ratios[1],
        "twisted line of Table 20; plaited and twisted are "
        + " and ".join(f"{ratio:.2f}" for ratio in ratios),
    )  # fmt: skip


def _over_polyester(cell: Cell, pages: Pages) -> ReproducedItem:
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


def _jacket(cell: Cell, pages: Pages) -> ReproducedItem:
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
        f"{middle.__name__} of three lives over the mode:"
        f" {', '.join(f'{one:.1f}' for one in of_mode)}; medians of the lives of the text"
        f" {medians:.1f}; over the mean life of Table 20 {lives.mean() / mean:.1f}, medians"
        f" {ratio:.1f} ({low:.1f} to {high:.1f})",
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
"""Checks by the column of the claim."""

CLAIMS_OF_TESTS |= {
    f"{quantity} significant factors": _significant
    for quantity in (
        "apparent_spring_constant", "quasi_static_spring_constant", "dissipation_spring_constant",
        "relaxation_time", "hysteresis_energy", STRENGTH, STRAIN_AT_FAILURE,
    )
}  # fmt: skip

COLUMN_LOST = "the column of the five-year line is lost in the text"


def _stiffness_ratio(cell: Cell, pages: Pages) -> ReproducedItem:
    if cell.table.startswith("sec A"):
        return measured_item(cell, "the stiffness of the screening is not printed")
    ratios = sorted(
        1e4 * pages.value("3", row, f"{K_AP} B1") / centre_stiffness(pages, row)
        for row in CENTRE_LINES
    )
    extreme = ratios[0] if cell.column.endswith("low") else ratios[-1]
    return judge(
        cell, extreme, "least and greatest of seven lines at the centre, Tables 3, 6, 7 and 8"
    )


def _change(cell: Cell, pages: Pages) -> ReproducedItem:
    quantity = cell.column.partition(" ")[0]
    if cell.column.endswith((" low", " high")):
        row, table = (
            (f"{POLYESTER_BRAID} | 5 years", "5")
            if cell.column.endswith("low")
            else (f"{POLYESTER_PLAITED} | 4 years", "5")
        )
    else:
        row = cell.row
        table = ("4" if row.startswith("nylon") else "5") if quantity == K_AP else (
            "12" if row.startswith("nylon") else "13")  # fmt: skip
    found = change_of_mean(pages, table, row, quantity)
    if found is None:
        return measured_item(cell, COLUMN_LOST)
    held = judge_round if (cell.table, cell.row) in APPROXIMATE else judge
    return held(cell, found[0], f"Table {table}, {found[1]}")


APPROXIMATE = {
    (section, f"{POLYESTER_PLAITED} | 4 years") for section in ("sec 4.4.1", "sec 4.4.8")
}
"""Changes of K_ap that the text gives as approximate."""


def _figure_4(cell: Cell, pages: Pages) -> ReproducedItem:
    """At the lowest level of frequency; the figure does not state its own."""
    ends = np.array([
        [pages.value("3", cell.row if what != "frequency" else "every line", f"{K_AP} {what} {end}")
         for what in ("frequency", "mean_tension", "tension_amplitude")] for end in ("low", "high")
    ])  # fmt: skip
    coded = coded_from_engineering([ends[0, 0], 4000.0, 1600.0], low=ends[0], high=ends[1])
    value = float(model_matrix(coded, quadratic_exponents(3)) @ pages.surface("3", cell.row, K_AP))
    return judge(cell, value, "Table 3 at 0.1 Hz; the frequency of the figure is not stated")


def _over_factor(pages: Pages, row: str, factor: int) -> tuple[float, float, float]:
    """Least, greatest and centre K_ap along one factor, the others at their centres."""
    coded = np.zeros((201, 3))
    coded[:, factor] = np.linspace(-1, 1, 201)
    found = model_matrix(coded, quadratic_exponents(3)) @ pages.surface("3", row, K_AP)
    return float(found.min()), float(found.max()), float(found[100])


def _over_frequency(cell: Cell, pages: Pages) -> ReproducedItem:
    least, greatest, centre = _over_factor(pages, cell.row, 0)
    return judge(
        cell, 100 * (greatest - least) / centre, "Table 3, greatest less least, at centre loads"
    )


def _over_mean_load(cell: Cell, pages: Pages) -> ReproducedItem:
    changes = []
    for row in (NYLON_BRAIDS[0], NYLON_BRAIDS[2]):
        least, greatest, _ = _over_factor(pages, row, 1)
        changes.append(100 * (greatest / least - 1))
    return judge_round(
        cell, float(np.mean(changes)), "Table 3, mean of the two lines that the text names"
    )


def _mean_of_centre(cell: Cell, pages: Pages) -> ReproducedItem:
    return judge_repeat(cell, pages.value("3", cell.row, cell.column), "Table 3")


def _mean_ratio(pages: Pages, over: str, under: str) -> float:
    return pages.value("3", f"{over} | new", f"{K_AP} B1") / pages.value(
        "3", f"{under} | new", f"{K_AP} B1"
    )


def _stiffer(cell: Cell, pages: Pages) -> ReproducedItem:
    if cell.row.startswith("polyester over nylon"):
        ratio = _mean_ratio(pages, POLYESTER_PLAITED, NYLON_PLAITED)
        return judge_word(cell, ratio, "B1 of Table 3")
    ratios = [
        _mean_ratio(pages, POLYESTER_BRAID, POLYESTER_PLAITED),
        _mean_ratio(pages, NYLON_BRAID, NYLON_PLAITED),
    ]
    return agree(
        cell, min(ratios) > 1, "B1 of Table 3: " + ", ".join(f"{one:.2f}" for one in ratios)
    )


def _stiffness_of_materials(cell: Cell, pages: Pages) -> ReproducedItem:
    ratios = sorted(
        [
            _mean_ratio(pages, POLYESTER_PLAITED, NYLON_PLAITED),
            _mean_ratio(pages, POLYESTER_BRAID, NYLON_BRAID),
        ]
    )
    return judge(cell, ratios[cell.column.endswith("high")], "B1 of Table 3, plaited and braid")


def _limit(cell: Cell, pages: Pages) -> ReproducedItem:
    """Eqs. 2 and 3 from eq. 1, with the values of a line."""
    line = {"quasi_static_spring_constant": 2.0, "dissipation_spring_constant": 4.0,
            "relaxation_time": 1.0}  # fmt: skip
    high = cell.column.endswith("high frequency")
    found = float(apparent_spring_constant(**line, frequency=1e6 if high else 0.0))
    return agree(cell, abs(found - (6.0 if high else 2.0)) < 1e-9, "eq. 1 at the limit")


def _constant(cell: Cell, pages: Pages) -> ReproducedItem:
    """Factor of K_1 in eq. 4, from the seven centre points."""
    found = []
    for row, (_, _, amplitude) in CENTRE_LINES.items():
        rest, spring = centre_stiffness(pages, row), 1e4 * pages.value("14", row, f"{K_1} B1")
        turn = 2 * np.pi * 0.3 * pages.value("17", row, f"{TIME} B1")
        form = spring * amplitude**2 * turn / (rest**2 + (rest + spring) ** 2 * turn**2)
        found.append(pages.value("11", row, f"{ENERGY} B1") / form)
    mean = float(np.exp(np.mean(np.log(found))))
    return compared_item(cell, mean, "geometric mean at the seven centre points")


def _little_effect_on_energy(cell: Cell, pages: Pages) -> ReproducedItem:
    shares = []
    for row in CENTRE_LINES:
        mean, square, _, _, slope = pages.surface("11", row, ENERGY)[:5]
        shares.append(max(abs(square), abs(slope)) / mean)
    return agree(
        cell, max(shares) < 0.2,
        "read as below 20 %; greater of B2 and B5 over B1, Table 11: "
        + ", ".join(f"{100 * s:.0f} %" for s in shares),
    )  # fmt: skip


def _little_effect_on_spring(cell: Cell, pages: Pages) -> ReproducedItem:
    shares = []
    for row in CENTRE_LINES:
        terms = pages.surface("14", row, K_1)
        shares.append(max(abs(terms[4]), abs(terms[6])) / abs(terms[5]))
    return agree(
        cell, max(shares) < 1 / 3,
        "read as below a third; greater of B5 and B7 over B6, Table 14: "
        + ", ".join(f"{100 * s:.0f} %" for s in shares),
    )  # fmt: skip


def _spring_with_exposure(cell: Cell, pages: Pages) -> ReproducedItem:
    new, old = (
        pages.value("16", f"{POLYESTER_BRAID} | {when}", f"{K_1} B1") for when in ("new", "5 years")
    )
    return agree(cell, old > new, f"Table 16: {old:g} and {new:g}, the one pair that is left")


def _times(cell: Cell, pages: Pages) -> ReproducedItem:
    time = {row: pages.value("17", row, f"{TIME} B1") for row in CENTRE_LINES}
    nylon = [value for row, value in time.items() if row.startswith("nylon")]
    polyester = [value for row, value in time.items() if row.startswith("polyester")]
    shown = "Table 17: " + ", ".join(f"{value:g}" for value in time.values()) + " s"
    if cell.row.startswith("nylon"):
        return agree(
            cell, max(nylon) / min(nylon) < 1.5, f"read as within half as much again; {shown}"
        )
    return agree(cell, min(polyester) > max(nylon), shown)


def _fails(cell: Cell, pages: Pages) -> ReproducedItem:
    r2 = pages.value("17", cell.row, f"{TIME} r2")
    f = (r2 / 9) / ((1 - r2) / 5)
    return agree(cell, f < float(fdtri(9, 5, 0.95)), f"F with 9 and 5 degrees of freedom: {f:.2f}")


CLAIMS_OF_STIFFNESS: dict[str, Check] = {
    f"{K_AP} at high frequency": _limit,
    f"{K_AP} at low frequency": _limit,
    "constant in front of K_1": _constant,
    "power of K_0 in the denominator": always("a sum of K_0 and a square of K_0 + K_1 has no unit"),
    "tension under the integral": always("the mean load over a closed loop has no integral"),
    "angular frequency": always("2 pi f gives K_ap of the centre points, f does not"),
    "factors": always("App. C: the coefficients belong to coded levels"),
    "apparent over quasi-static spring constant low": _stiffness_ratio,
    "apparent over quasi-static spring constant high": _stiffness_ratio,
    f"{K_AP} change": _change,
    f"{K_AP} change low": _change,
    f"{K_AP} change high": _change,
    f"{ENERGY} change": _change,
    f"{K_AP} at 4,000 and 1,600 lb": _figure_4,
    f"{K_AP} change over frequency": _over_frequency,
    f"{K_AP} change over mean_tension": _over_mean_load,
    f"{K_AP} B1": _mean_of_centre,
    f"{K_AP} ratio": _stiffer,
    f"{K_AP} ratio low": _stiffness_of_materials,
    f"{K_AP} ratio high": _stiffness_of_materials,
    f"effect of frequency on {ENERGY}": _little_effect_on_energy,
    f"effect of frequency and tension_amplitude on {K_1}": _little_effect_on_spring,
    K_1: _spring_with_exposure,
    TIME: _times,
    f"{TIME} passes the F test": _fails,
}
"""Checks by the column of the claim."""
