"""What CG-D-39-80 says of the strength of a line, of its scatter, and what of it is open.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, Tables 1, 2, 10, sec. 4.4.1, 4.4.4.
"""

from __future__ import annotations

import numpy as np

from reduction.published.linecells import number_used
from reduction.published.lineproduct import PublishedLine
from reduction.published.lines import published_lines
from reduction.published.read import table_of
from reduction.units import scale_to_si

_LARGEST_OF_ITS_OWN = 0.026
"""Lines above an inch were loaded in shares of the strength of the one of an inch. [m]"""
_SAME_STRENGTH = 1.0
"""Difference of two strengths that are one. [N]"""


def strengths_told(line: PublishedLine) -> tuple[str, ...]:
    """What is said of the strength, where the tables do not agree."""
    found = sorted({round(one.value) for one in line.stated_strengths})
    if len(found) < 2:
        return ()
    listed = ", ".join(f"{one.value:.0f} N (Table {one.table})" for one in line.stated_strengths)
    return (
        f"the break strength is printed as {listed}; the tested levels are shares of "
        f"{line.rated_break_strength:.0f} N",
    )


def strength_of(line: PublishedLine) -> str:
    """Whose strength the levels are shares of: Table 1, footnote 3."""
    is_largest = line.construction == "double braid" and line.diameter > _LARGEST_OF_ITS_OWN
    return "the 1 in line" if is_largest else ""


def own_strength(line: PublishedLine) -> tuple[float, tuple[str, ...]]:
    """What a line has left after years in the sea, and what is said of it; NaN of a new one."""
    if strength_of(line):
        return float("nan"), (
            f"the break strength is that of {strength_of(line)} (Table 1, footnote 3), of which "
            "the tested levels are shares; its own is not printed",
        )
    if line.condition == "new":
        return float("nan"), ()
    broken = [
        one
        for one in published_lines()
        if (one.material, one.construction, one.diameter)
        == (line.material, line.construction, line.diameter)
        and one.condition != "new"
        and one.strength is not None
        and np.isfinite(one.strength.tensile_strength)
    ]
    # its own before that of another age
    broken.sort(key=lambda one: one.condition != line.condition)
    if not broken or broken[0].strength is None:
        return float("nan"), ("no break of a line in this condition is printed",)
    found, age = broken[0].strength, broken[0].condition
    whose = "this condition" if age == line.condition else f"{age} (none of {line.condition})"
    share = 100 * found.tensile_strength / line.rated_break_strength
    return found.tensile_strength, (
        f"lines in {whose} break at {found.tensile_strength:.0f} N (Table {found.table}), "
        f"{share:.0f} % of the strength that %RBS and the tested levels refer to; the rule is "
        "judged by it",
    )


def line_scatter(line: PublishedLine) -> float:
    """Standard deviation between lines over their mean, of K_ap: sec. 4.4.1."""
    row = "new" if line.condition == "new" else "field exposure"
    cell = table_of("CG-D-39-80", "sec 4.4.1")[row, "relative variability"]
    return scale_to_si("%", "strain")[0] * number_used(cell)


def scatter_told(line: PublishedLine) -> tuple[str, ...]:
    """How alike lines are after years in the sea; nothing of a new one."""
    if line.condition == "new":
        return ()
    return (
        "exposed lines differ among each other by about half, new ones by a tenth (sec. 4.4.1): "
        "that is in no interval but those of the kind and of another line, which K_ap has",
    )


def levels_told(line: PublishedLine) -> tuple[str, ...]:
    """Of an exposed line whose levels are shares of another strength than those of the new one."""
    for new in published_lines():
        if line.condition == "new" or new.name != line.name.replace(
            line.condition.replace(" ", "-"), "new"
        ):
            continue
        if abs(new.rated_break_strength - line.rated_break_strength) > _SAME_STRENGTH:
            return (
                f"the tested levels are shares of {line.rated_break_strength:.0f} N, those of the "
                f"new line of {new.rated_break_strength:.0f} N: one %RBS is two tensions",
            )
    return ()


def is_documentation(line: PublishedLine) -> bool:
    """Plaited nylon after years in the sea."""
    return (line.material, line.construction) == ("nylon", "8-strand plaited") and (
        line.condition != "new"
    )
