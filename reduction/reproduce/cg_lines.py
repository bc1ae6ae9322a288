"""Names of CG-D-39-80's lines, quantities and conditions, and the centre of their experiments."""

from __future__ import annotations

from reduction.reproduce.cg_cells import Pages

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
    """Row of Table 1 that has the levels of a line, in per cent of its strength."""
    large = "| 1 in" in row or "| 1 1/4 in" in row
    sizes = "1 in, 1 1/4 in" if large else "1/2 in, 3/4 in"
    return f"nylon | double braid | {sizes} | new"
