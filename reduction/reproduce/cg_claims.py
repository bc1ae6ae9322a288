"""CG-D-39-80, claims of the text on stiffness, strain and loss, held against its tables."""

from __future__ import annotations

import numpy as np
from scipy.special import fdtri

from reduction.line.model import apparent_spring_constant
from reduction.published.cell import Cell
from reduction.reproduce.cg_cells import Check, Pages, always
from reduction.reproduce.cg_lines import (
    CENTRE_LINES,
    ENERGY,
    K_1,
    K_AP,
    NYLON_BRAID,
    NYLON_BRAIDS,
    NYLON_PLAITED,
    POLYESTER_BRAID,
    POLYESTER_PLAITED,
    TIME,
    centre_stiffness,
)  # fmt: skip
from reduction.reproduce.cg_surfaces import change_of_mean
from reduction.reproduce.item import Item, agree, beside, judge, not_testable
from reduction.reproduce.wording import judge_round, judge_word
from reduction.surface.coding import coded_from_engineering
from reduction.surface.terms import model_matrix, quadratic_exponents

COLUMN_LOST = "the column of the five-year line is lost in the text"


def _ratios(pages: Pages) -> dict[str, float]:
    """K_ap over K_0 at the centre points."""
    return {
        row: 1e4 * pages.value("3", row, f"{K_AP} B1") / centre_stiffness(pages, row)
        for row in CENTRE_LINES
    }


def _stiffness_ratio(cell: Cell, pages: Pages) -> Item:
    if cell.table.startswith("sec A"):
        return not_testable(cell, "the stiffness of the screening is not printed")
    ratios = sorted(_ratios(pages).values())
    extreme = ratios[0] if cell.column.endswith("low") else ratios[-1]
    return judge(
        cell, extreme, "least and greatest of seven lines at the centre, Tables 3, 6, 7 and 8"
    )


def _change(cell: Cell, pages: Pages) -> Item:
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
        return not_testable(cell, COLUMN_LOST)
    return judge(cell, found[0], f"Table {table}, {found[1]}")


def _figure_4(cell: Cell, pages: Pages) -> Item:
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


def _over_frequency(cell: Cell, pages: Pages) -> Item:
    least, greatest, centre = _over_factor(pages, cell.row, 0)
    return judge(
        cell, 100 * (greatest - least) / centre, "Table 3, greatest less least, at centre loads"
    )


def _over_mean_load(cell: Cell, pages: Pages) -> Item:
    changes = []
    for row in (NYLON_BRAIDS[0], NYLON_BRAIDS[2]):
        least, greatest, _ = _over_factor(pages, row, 1)
        changes.append(100 * (greatest / least - 1))
    return judge_round(
        cell, float(np.mean(changes)), "Table 3, mean of the two lines that the text names"
    )


def _mean_of_centre(cell: Cell, pages: Pages) -> Item:
    return judge(cell, pages.value("3", cell.row, cell.column), "Table 3")


def _mean_ratio(pages: Pages, over: str, under: str) -> float:
    return pages.value("3", f"{over} | new", f"{K_AP} B1") / pages.value(
        "3", f"{under} | new", f"{K_AP} B1"
    )


def _stiffer(cell: Cell, pages: Pages) -> Item:
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


def _stiffness_of_materials(cell: Cell, pages: Pages) -> Item:
    ratios = sorted(
        [
            _mean_ratio(pages, POLYESTER_PLAITED, NYLON_PLAITED),
            _mean_ratio(pages, POLYESTER_BRAID, NYLON_BRAID),
        ]
    )
    return judge(cell, ratios[cell.column.endswith("high")], "B1 of Table 3, plaited and braid")


def _limit(cell: Cell, pages: Pages) -> Item:
    """Eqs. 2 and 3 from eq. 1, with the numbers of a line."""
    line = {"quasi_static_spring_constant": 2.0, "dissipation_spring_constant": 4.0,
            "relaxation_time": 1.0}  # fmt: skip
    high = cell.column.endswith("high frequency")
    found = float(apparent_spring_constant(**line, frequency=1e6 if high else 0.0))
    return agree(cell, abs(found - (6.0 if high else 2.0)) < 1e-9, "eq. 1 at the limit")


def _constant(cell: Cell, pages: Pages) -> Item:
    """What multiplies K_1 in eq. 4, from the seven centre points."""
    found = []
    for row, (_, _, amplitude) in CENTRE_LINES.items():
        rest, spring = centre_stiffness(pages, row), 1e4 * pages.value("14", row, f"{K_1} B1")
        turn = 2 * np.pi * 0.3 * pages.value("17", row, f"{TIME} B1")
        form = spring * amplitude**2 * turn / (rest**2 + (rest + spring) ** 2 * turn**2)
        found.append(pages.value("11", row, f"{ENERGY} B1") / form)
    mean = float(np.exp(np.mean(np.log(found))))
    return beside(cell, mean, "geometric mean at the seven centre points")


def _little_effect_on_energy(cell: Cell, pages: Pages) -> Item:
    shares = []
    for row in CENTRE_LINES:
        mean, square, _, _, slope = pages.surface("11", row, ENERGY)[:5]
        shares.append(max(abs(square), abs(slope)) / mean)
    return agree(
        cell, max(shares) < 0.2,
        "read as below 20 %; greater of B2 and B5 over B1, Table 11: "
        + ", ".join(f"{100 * s:.0f} %" for s in shares),
    )  # fmt: skip


def _little_effect_on_spring(cell: Cell, pages: Pages) -> Item:
    shares = []
    for row in CENTRE_LINES:
        terms = pages.surface("14", row, K_1)
        shares.append(max(abs(terms[4]), abs(terms[6])) / abs(terms[5]))
    return agree(
        cell, max(shares) < 1 / 3,
        "read as below a third; greater of B5 and B7 over B6, Table 14: "
        + ", ".join(f"{100 * s:.0f} %" for s in shares),
    )  # fmt: skip


def _spring_with_exposure(cell: Cell, pages: Pages) -> Item:
    new, old = (
        pages.value("16", f"{POLYESTER_BRAID} | {when}", f"{K_1} B1") for when in ("new", "5 years")
    )
    return agree(cell, old > new, f"Table 16: {old:g} and {new:g}, the one pair that is left")


def _times(cell: Cell, pages: Pages) -> Item:
    time = {row: pages.value("17", row, f"{TIME} B1") for row in CENTRE_LINES}
    nylon = [value for row, value in time.items() if row.startswith("nylon")]
    polyester = [value for row, value in time.items() if row.startswith("polyester")]
    shown = "Table 17: " + ", ".join(f"{value:g}" for value in time.values()) + " s"
    if cell.row.startswith("nylon"):
        return agree(
            cell, max(nylon) / min(nylon) < 1.5, f"read as within half as much again; {shown}"
        )
    return agree(cell, min(polyester) > max(nylon), shown)


def _fails(cell: Cell, pages: Pages) -> Item:
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
"""By the column of the claim."""
