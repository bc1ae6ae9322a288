"""CG-D-39-80, claims of the text on K_0 and strain, held against Tables 6-9."""

from __future__ import annotations

import numpy as np

from reduction.published.cell import Cell
from reduction.reproduce.cg_cells import Check, Pages
from reduction.reproduce.cg_lines import (
    NYLON_BRAID,
    NYLON_BRAIDS,
    NYLON_PLAITED,
    POLYESTER_BRAID,
    POLYESTER_PLAITED,
)  # fmt: skip
from reduction.reproduce.item import Item, agree, judge
from reduction.reproduce.wording import judge_word

STRENGTH = {
    NYLON_BRAID: ("2", f"{NYLON_BRAID} | all", "rated_break_strength"),
    NYLON_PLAITED: ("10", f"{NYLON_PLAITED} | new", "tensile_strength mean"),
    POLYESTER_BRAID: ("10", f"{POLYESTER_BRAID} | new", "tensile_strength mean"),
    POLYESTER_PLAITED: ("10", f"{POLYESTER_PLAITED} | new", "tensile_strength mean"),
}


def _sizes_at(pages: Pages, tension: float) -> str:
    found = {row: pages.polynomial("7" if row == NYLON_BRAIDS[0] else "6", row, tension)
             for row in NYLON_BRAIDS}  # fmt: skip
    return min(found, key=lambda row: found[row])


def _least_stiffness(cell: Cell, pages: Pages) -> Item:
    tension = float(cell.column.split(" ")[-2])
    row = _sizes_at(pages, tension)
    return agree(
        cell, f"| {cell.printed.removesuffix('-inch')} in " in row,
        f"K_0 of Tables 6 and 7 at {tension:g} lb is least for {row}",
    )  # fmt: skip


def _rest_with_exposure(cell: Cell, pages: Pages) -> Item:
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


def _rest_of_polyester(cell: Cell, pages: Pages) -> Item:
    if cell.column.endswith("low loads"):
        ratio = pages.polynomial("7", cell.row, 840.0) / pages.polynomial(
            "7", f"{POLYESTER_BRAID} | new", 840.0
        )
        return agree(
            cell,
            ratio < 0.5,
            f"read as below half; K_0 at 840 lb is {ratio:.2f} times that of new line",
        )
    # of both prints of the new cubic, since it is open which one is right
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
    return 100 * pages.strain("8", f"{line} | new", 0.3 * pages.printed(*STRENGTH[line]))


def _strain(cell: Cell, pages: Pages) -> Item:
    line = cell.row.rpartition(" | ")[0]
    strength = pages.printed(*STRENGTH[line])
    return judge(
        cell, _strain_at_share(pages, line),
        f"Table 8 at 30 % of {strength:g} lb, Table {STRENGTH[line][0]}",
    )  # fmt: skip


def _strain_of_materials(cell: Cell, pages: Pages) -> Item:
    ratios = sorted([
        _strain_at_share(pages, NYLON_PLAITED) / _strain_at_share(pages, POLYESTER_PLAITED),
        _strain_at_share(pages, NYLON_BRAID) / _strain_at_share(pages, POLYESTER_BRAID),
    ])  # fmt: skip
    return judge(
        cell,
        ratios[cell.column.endswith("high")],
        "Table 8 at 30 % of the strength, plaited and braid",
    )


def _strain_of_sizes(cell: Cell, pages: Pages) -> Item:
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


def _rest(cell: Cell, pages: Pages) -> Item:
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
"""By the column of the claim."""
