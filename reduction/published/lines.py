"""The lines of CG-D-39-80 in SI, from the corrected cells.

What two tables print differently and nothing decides stays open; what the text has lost is
absent, with the reason.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import cache
from types import MappingProxyType

import numpy as np

from reduction.published.cell import Cell
from reduction.published.linecells import (
    ABSENT,
    BREAK,
    CRITICAL_F,
    EXPOSED,
    INCH,
    NOT_MEASURED,
    OF_SURFACE,
    POUND,
    RESPONSES,
    REST,
    SCALE_OF_CUBIC,
    STRAIN,
    LineCells,
    errata_of_cells,
    in_order,
    number_printed,
    number_used,
)
from reduction.published.lineproduct import (
    LevelBox,
    OpenTerm,
    PublishedCubic,
    PublishedLine,
    PublishedStrength,
    PublishedSurface,
    StatedStrength,
)
from reduction.published.read import cells_of


def _terms(
    cells: LineCells, tables: Sequence[str], row: str, quantity: str, names: Sequence[str],
    scale: Sequence[float],
) -> tuple[list[float], tuple[OpenTerm, ...], list[Cell]]:  # fmt: skip
    """Coefficients in SI, those that are open, and the cells."""
    values, opened, used = [], [], []
    for index, (name, factor) in enumerate(zip(names, scale, strict=True)):
        prints = cells.prints(tables, row, f"{quantity} {name}")
        used += prints
        values.append(number_used(prints[0]) * float(factor))
        if prints[0].confidence == "open":
            opened.append(
                OpenTerm(
                    term=name,
                    index=index,
                    values=tuple(number_printed(cell) * float(factor) for cell in prints),
                    tables=tuple(cell.table for cell in prints),
                    erratum=prints[0].erratum,
                    note=prints[0].note,
                )
            )
    return values, tuple(opened), used


def _surface(cells: LineCells, row: str, response: str) -> PublishedSurface | None:
    tables, scale = RESPONSES[response]
    printed = tuple(table for table in tables if cells.get(table, row, f"{response} B1"))
    if not printed:
        return None
    names = [f"B{i}" for i in range(1, 11)]
    values, opened, used = _terms(cells, printed, row, response, names, [scale] * 10)
    share = cells.prints(printed, row, f"{response} r2")
    statistic = cells.prints(printed, row, f"{response} F-stat")
    count = cells.prints(printed, row, f"{response} number of lines")
    lines = number_used(count[0]) if count else float("nan")
    found = statistic[0]
    return PublishedSurface(
        response=response,
        coefficient=np.array(values),
        open_terms=opened,
        boxes=_boxes(cells, row, response, printed),
        r2=number_used(share[0]),
        passes_f_test=(number_printed(found) if found.corrected is None else found.corrected)
        > CRITICAL_F,
        n_lines=None if np.isnan(lines) else int(lines),
        tables=printed,
        errata=in_order(
            {
                *errata_of_cells([*used, *share, *statistic, *count]),
                *errata_of_cells(_range_cells(cells, row, response, printed)),
                *OF_SURFACE.get((row, response), ()),
            }
        ),
    )


def _ends(cells: LineCells, table: str, row: str, what: str) -> list[Cell]:
    """Low and high level, of the line itself or of all its conditions."""
    whole = row.rpartition(" | ")[0] + " | all"
    found = [
        cells.get(table, one, f"{what} {end}") for end in ("low", "high") for one in (row, whole)
    ]
    return [cell for cell in found if cell is not None]


def _range_cells(cells: LineCells, row: str, response: str, tables: Sequence[str]) -> list[Cell]:
    return [
        cell
        for table in tables
        for what in ("mean_tension", "tension_amplitude")
        for cell in _ends(cells, table, row, f"{response} {what}")
    ]


def _boxes(
    cells: LineCells, row: str, response: str, tables: Sequence[str]
) -> tuple[LevelBox, ...]:
    """One box; of a new line with open levels both, the smaller strength first."""
    is_new = row.endswith("new")
    # levels are those of one programme, whatever the response
    places = [(table, response) for table in tables]
    if is_new:
        places += [(table, other) for other in RESPONSES for table in RESPONSES[other][0]]
    boxes: dict[float, LevelBox] = {}
    for table, name in places:
        ends = {
            what: [number_printed(cell) if cell.corrected is None else cell.corrected
                   for cell in _ends(cells, table, row, f"{name} {what}")]
            for what in ("mean_tension", "tension_amplitude")
        }  # fmt: skip
        if any(len(pair) != 2 for pair in ends.values()):
            continue
        mean, amplitude = ends["mean_tension"], ends["tension_amplitude"]
        boxes.setdefault(
            mean[1],
            LevelBox(
                frequency=(0.1, 0.5),
                mean_tension=(mean[0] * POUND, mean[1] * POUND),
                tension_amplitude=(amplitude[0] * POUND, amplitude[1] * POUND),
                rated_break_strength=_strength_of_level(row, mean[1]) * POUND,
                table=table,
            ),
        )
    return tuple(boxes[key] for key in sorted(boxes))


def _strength_of_level(row: str, mean_high: float) -> float:
    """Rated break strength [lb] from the upper mean load: 30 %, or 22 % of the two largest."""
    share = 0.22 if "| 1 in" in row or "| 1 1/4 in" in row else 0.30
    return round(mean_high / share, 1)


def _cubic(cells: LineCells, row: str, quantity: str) -> PublishedCubic | None:
    tables, scale = SCALE_OF_CUBIC[quantity]
    combined = row.rpartition(" | ")[0] + f" | {EXPOSED}"
    # K_0 of four and five years stands in one row
    place = combined if quantity == REST and not row.endswith("new") else row
    printed = tuple(table for table in tables if cells.get(table, place, f"{quantity} A"))
    if not printed:
        return None
    values, opened, used = _terms(cells, printed, place, quantity, "ABCD", scale)
    ranges = cells.prints(printed, place, f"{quantity} mean_tension high")
    # tables of new and of exposed lines have ranges of their own: both vouch for the smaller one
    known = [number_used(cell) for cell in ranges if not np.isnan(number_used(cell))]
    counts = cells.prints(printed, place, f"{quantity} number of samples")
    return PublishedCubic(
        quantity=quantity,
        coefficient=np.array(values),
        open_terms=opened,
        tension_high=min(known) * POUND if known else float("nan"),
        n_samples=int(number_used(counts[0])) if counts else None,
        tables=printed,
        errata=errata_of_cells([*used, *ranges]),
        note="of four and five years together" if place == combined else "",
    )


def _strength(cells: LineCells, row: str) -> PublishedStrength | None:
    kinds = ("mean", "standard deviation")
    columns = [f"{quantity} {kind}" for quantity in (BREAK, "strain_at_failure") for kind in kinds]
    found = [cells.get("10", row, column) for column in columns]
    count = cells.get("10", row, f"{BREAK} number of samples")
    if not any(found):
        return None
    mean, deviation, strain, strain_deviation = (number_used(cell) for cell in found)
    n_samples = number_used(count)
    return PublishedStrength(
        tensile_strength=mean * POUND,
        tensile_strength_standard_deviation=deviation * POUND,
        strain_at_failure=strain,
        strain_at_failure_standard_deviation=strain_deviation,
        n_samples=None if np.isnan(n_samples) else int(n_samples),
        table="10",
        errata=errata_of_cells([cell for cell in [*found, count] if cell is not None]),
    )


def _strengths_when_new(cells: LineCells, row: str) -> tuple[StatedStrength, ...]:
    """Rated and measured strengths of the new line, as the tables have them."""
    line = row.rpartition(" | ")[0]
    places = (
        ("1", f"{line} | new", "rated_break_strength", "rated"),
        ("2", f"{line} | all", "rated_break_strength", "rated"),
        ("10", f"{line} | new", f"{BREAK} mean", "measured, new"),
        ("21", f"{line} | new", f"{BREAK} mean", "measured, new"),
        ("sec 6.3.2", f"{line} | new", "rated_break_strength", "advertised"),
        ("A-3", f"{line} | dry, not cycled", f"{BREAK} mean", "measured, dry"),
        ("A-3", f"{line} | wet, before cycling", f"{BREAK} mean", "measured, wet"),
    )
    stated = []
    for table, place, column, what in places:
        cell = cells.get(table, place, column)
        if cell is not None:
            stated.append(StatedStrength(number_printed(cell) * POUND, table, what, cell.erratum))
    return tuple(stated)


def _line(cells: LineCells, row: str) -> PublishedLine:
    material, construction, size, condition = row.split(" | ")
    inches = float(sum(Fraction(part) for part in size.removesuffix(" in").split(" ")))
    surfaces = {name: _surface(cells, row, name) for name in RESPONSES}
    found = {name: surface for name, surface in surfaces.items() if surface is not None}
    cubics = {quantity: _cubic(cells, row, quantity) for quantity in SCALE_OF_CUBIC}
    strength, stated = _strength(cells, row), _strengths_when_new(cells, row)
    parts = {**surfaces, **cubics, BREAK: strength}
    rated = [box.rated_break_strength for surface in found.values() for box in surface.boxes[:1]]
    return PublishedLine(
        name="-".join(
            part.replace(" ", "-") for part in (material, construction, f"{inches:g}in", condition)
        ),
        material=material,
        construction=construction,
        diameter=inches * INCH,
        condition=condition,
        rated_break_strength=[*rated, *(one.value for one in stated), float("nan")][0],
        stated_strengths=stated,
        surfaces=MappingProxyType(found),
        stiffness=cubics[REST],
        load_strain=cubics[STRAIN],
        strength=strength,
        absent=MappingProxyType({
            name: ABSENT.get((row, name), NOT_MEASURED)
            for name, part in parts.items() if part is None
        }),
    )  # fmt: skip


@cache
def published_lines() -> tuple[PublishedLine, ...]:
    """Every line of CG-D-39-80 with a surface, a pull or a break.

    Returns
    -------
    lines : tuple of PublishedLine
        New lines first.

    Examples
    --------
    The surface of the polyester braid is that of Table 13, not its misprint in Table 11:

    >>> lines = {line.name: line for line in published_lines()}
    >>> surface = lines["polyester-double-braid-0.5in-new"].surfaces["hysteresis_energy"]
    >>> print(round(float(surface.coefficient[0]) / 4.4482216, 3), surface.errata[:1])
    1.2 ('CG-5',)
    """
    cells = LineCells(cells_of("CG-D-39-80"))
    return tuple(_line(cells, row) for row in cells.rows())
