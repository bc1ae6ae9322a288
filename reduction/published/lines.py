"""The lines of CG-D-39-80 in SI, from the corrected cells.

What two tables print differently and nothing decides stays open; what the text has lost is
absent, with the reason.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from functools import cache
from types import MappingProxyType

import numpy as np

from reduction.published.cell import Cell, number_of
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
from reduction.units import scale_to_si

__all__ = ["published_lines"]

POUND, INCH = scale_to_si("lbf", "force")[0], scale_to_si("in", "length")[0]
# tables of a response, the one of new lines first, and the SI value of its printed unit
RESPONSES = {
    "apparent_spring_constant": (("3", "4", "5"), 1e4 * POUND),
    "hysteresis_energy": (("11", "12", "13"), POUND),
    "dissipation_spring_constant": (("14", "15", "16"), 1e4 * POUND),
    "relaxation_time": (("17", "18", "19"), 1.0),
}
REST, STRAIN, BREAK = "quasi_static_spring_constant", "quasi_static_strain", "tensile_strength"
POWERS = np.arange(4)
SCALE_OF_CUBIC = {
    REST: (("6", "7"), np.array([1e4, 1.0, 1e-3, 1e-7]) * POUND ** (1.0 - POWERS)),
    STRAIN: (("8", "9"), np.array([1e-4, 1e-4, 1e-8, 1e-12]) * POUND ** (0.0 - POWERS)),
}
EXPOSED = "field exposure"
CRITICAL_F = 3.436
# of a whole surface, not of one of its cells
OF_SURFACE = {("nylon | double braid | 1 1/4 in | new", "dissipation_spring_constant"): ("CG-17",)}
NOT_MEASURED = "not printed for this line"
ABSENT = {
    ("nylon | double braid | 1/2 in | 5 years", "apparent_spring_constant"):
        "the column of Table 4 is lost in the text; it says about twice the new line (CG-22)",
    ("nylon | double braid | 1/2 in | 5 years", "dissipation_spring_constant"):
        "the column of Table 15 is lost in the text (CG-23)",
    ("nylon | 8-strand plaited | 1/2 in | 5 years", "dissipation_spring_constant"):
        "the column of Table 15 is lost in the text (CG-23)",
    ("nylon | 8-strand plaited | 1/2 in | 4 years", "dissipation_spring_constant"):
        "the column of Table 15 is lost in the text (CG-23)",
    ("polyester | 8-strand plaited | 1/2 in | new", REST):
        "Tables 6 and 7 have no such row; the slope of the cubic takes its place (CG-13)",
    ("polyester | 8-strand plaited | 1/2 in | 4 years", REST):
        "Table 7 has no such row; the slope of the cubic takes its place (CG-13)",
    ("polyester | double braid | 1/2 in | 4 years", STRAIN): "Table 9: not available",
}  # fmt: skip


class _Cells:
    """Cells by table, row and column."""

    def __init__(self, cells: Sequence[Cell]) -> None:
        self.by_key = {cell.key: cell for cell in cells}

    def get(self, table: str, row: str, column: str) -> Cell | None:
        return self.by_key.get((table, row, column))

    def prints(self, tables: Sequence[str], row: str, column: str) -> list[Cell]:
        found = [self.get(table, row, column) for table in tables]
        return [cell for cell in found if cell is not None]

    def rows(self) -> tuple[str, ...]:
        """Lines with a surface, a cubic or a break, in the order of the tables."""
        tables = {"3", "4", "5", "8", "9", "10", "12", "13", "18", "19"}
        rows = (cell.row for cell in self.by_key.values() if cell.table in tables)
        dropped = (EXPOSED, "all")
        return tuple(
            dict.fromkeys(
                row for row in rows if row.count(" | ") == 3 and not row.endswith(dropped)
            )
        )


def _number(cell: Cell) -> float:
    value = number_of(cell.printed)
    return float("nan") if value is None else value


def _value(cell: Cell | None) -> float:
    """As corrected; NaN where open or absent."""
    value = None if cell is None else cell.value
    return float("nan") if value is None else value


def _errata(cells: Sequence[Cell]) -> tuple[str, ...]:
    return _ordered({cell.erratum for cell in cells if cell.erratum})


def _ordered(ids: Iterable[str]) -> tuple[str, ...]:
    return tuple(sorted(ids, key=lambda one: int(one.partition("-")[2])))


def _terms(
    cells: _Cells, tables: Sequence[str], row: str, quantity: str, names: Sequence[str],
    scale: Sequence[float],
) -> tuple[list[float], tuple[OpenTerm, ...], list[Cell]]:  # fmt: skip
    """Coefficients in SI, those that are open, and the cells."""
    values, opened, used = [], [], []
    for index, (name, factor) in enumerate(zip(names, scale, strict=True)):
        prints = cells.prints(tables, row, f"{quantity} {name}")
        used += prints
        values.append(_value(prints[0]) * float(factor))
        if prints[0].confidence == "open":
            opened.append(
                OpenTerm(
                    term=name,
                    index=index,
                    values=tuple(_number(cell) * float(factor) for cell in prints),
                    tables=tuple(cell.table for cell in prints),
                    erratum=prints[0].erratum,
                    note=prints[0].note,
                )
            )
    return values, tuple(opened), used


def _surface(cells: _Cells, row: str, response: str) -> PublishedSurface | None:
    tables, scale = RESPONSES[response]
    printed = tuple(table for table in tables if cells.get(table, row, f"{response} B1"))
    if not printed:
        return None
    names = [f"B{i}" for i in range(1, 11)]
    values, opened, used = _terms(cells, printed, row, response, names, [scale] * 10)
    share = cells.prints(printed, row, f"{response} r2")
    statistic = cells.prints(printed, row, f"{response} F-stat")
    count = cells.prints(printed, row, f"{response} number of lines")
    lines = _value(count[0]) if count else float("nan")
    found = statistic[0]
    return PublishedSurface(
        response=response,
        coefficient=np.array(values),
        open_terms=opened,
        boxes=_boxes(cells, row, response, printed),
        r2=_value(share[0]),
        passes_f_test=(_number(found) if found.corrected is None else found.corrected) > CRITICAL_F,
        n_lines=None if np.isnan(lines) else int(lines),
        tables=printed,
        errata=_ordered(
            {
                *_errata([*used, *share, *statistic, *count]),
                *_errata(_range_cells(cells, row, response, printed)),
                *OF_SURFACE.get((row, response), ()),
            }
        ),
    )


def _ends(cells: _Cells, table: str, row: str, what: str) -> list[Cell]:
    """Low and high level, of the line itself or of all its conditions."""
    whole = row.rpartition(" | ")[0] + " | all"
    found = [
        cells.get(table, one, f"{what} {end}") for end in ("low", "high") for one in (row, whole)
    ]
    return [cell for cell in found if cell is not None]


def _range_cells(cells: _Cells, row: str, response: str, tables: Sequence[str]) -> list[Cell]:
    return [
        cell
        for table in tables
        for what in ("mean_tension", "tension_amplitude")
        for cell in _ends(cells, table, row, f"{response} {what}")
    ]


def _boxes(cells: _Cells, row: str, response: str, tables: Sequence[str]) -> tuple[LevelBox, ...]:
    """One box; of a new line with open levels both, the smaller strength first."""
    is_new = row.endswith("new")
    # levels are those of one programme, whatever the response
    places = [(table, response) for table in tables]
    if is_new:
        places += [(table, other) for other in RESPONSES for table in RESPONSES[other][0]]
    boxes: dict[float, LevelBox] = {}
    for table, name in places:
        ends = {
            what: [_number(cell) if cell.corrected is None else cell.corrected
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


def _cubic(cells: _Cells, row: str, quantity: str) -> PublishedCubic | None:
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
    known = [_value(cell) for cell in ranges if not np.isnan(_value(cell))]
    counts = cells.prints(printed, place, f"{quantity} number of samples")
    return PublishedCubic(
        quantity=quantity,
        coefficient=np.array(values),
        open_terms=opened,
        tension_high=min(known) * POUND if known else float("nan"),
        n_samples=int(_value(counts[0])) if counts else None,
        tables=printed,
        errata=_errata([*used, *ranges]),
        note="of four and five years together" if place == combined else "",
    )


def _strength(cells: _Cells, row: str) -> PublishedStrength | None:
    kinds = ("mean", "standard deviation")
    columns = [f"{quantity} {kind}" for quantity in (BREAK, "strain_at_failure") for kind in kinds]
    found = [cells.get("10", row, column) for column in columns]
    count = cells.get("10", row, f"{BREAK} number of samples")
    if not any(found):
        return None
    mean, deviation, strain, strain_deviation = (_value(cell) for cell in found)
    n_samples = _value(count)
    return PublishedStrength(
        tensile_strength=mean * POUND,
        tensile_strength_standard_deviation=deviation * POUND,
        strain_at_failure=strain,
        strain_at_failure_standard_deviation=strain_deviation,
        n_samples=None if np.isnan(n_samples) else int(n_samples),
        table="10",
        errata=_errata([cell for cell in [*found, count] if cell is not None]),
    )


def _stated(cells: _Cells, row: str) -> tuple[StatedStrength, ...]:
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
            stated.append(StatedStrength(_number(cell) * POUND, table, what, cell.erratum))
    return tuple(stated)


def _line(cells: _Cells, row: str) -> PublishedLine:
    material, construction, size, condition = row.split(" | ")
    inches = float(sum(Fraction(part) for part in size.removesuffix(" in").split(" ")))
    surfaces = {name: _surface(cells, row, name) for name in RESPONSES}
    found = {name: surface for name, surface in surfaces.items() if surface is not None}
    cubics = {quantity: _cubic(cells, row, quantity) for quantity in SCALE_OF_CUBIC}
    strength, stated = _strength(cells, row), _stated(cells, row)
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
    cells = _Cells(cells_of("CG-D-39-80"))
    return tuple(_line(cells, row) for row in cells.rows())
