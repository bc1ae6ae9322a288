"""The lines of CG-D-39-80 in SI, as corrected.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from types import MappingProxyType

import numpy as np

from reduction.published.printed_cells import Cell, cells_of, number_of, table_of
from reduction.quantities.units import scale_to_si
from reduction.record.measurement import Floats, read_only_arrays

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


class _LineCells:
    """Cells by table, row and column."""

    def __init__(self, cells: Sequence[Cell]) -> None:
        self.by_key = {cell.key: cell for cell in cells}

    def get(self, table: str, row: str, column: str) -> Cell | None:
        """One cell, where there is one."""
        return self.by_key.get((table, row, column))

    def prints(self, tables: Sequence[str], row: str, column: str) -> list[Cell]:
        """The same number in several tables."""
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


def _number_printed(cell: Cell) -> float:
    """As printed; NaN of words."""
    value = number_of(cell.printed)
    return float("nan") if value is None else value


def _number_used(cell: Cell | None) -> float:
    """As corrected; NaN where open or absent."""
    value = None if cell is None else cell.value
    return float("nan") if value is None else value


def _errata_of_cells(cells: Sequence[Cell]) -> tuple[str, ...]:
    """Ids that touch some cells, in their order."""
    return _in_order({cell.erratum for cell in cells if cell.erratum})


def _in_order(ids: Iterable[str]) -> tuple[str, ...]:
    """Ids by their number."""
    return tuple(sorted(ids, key=lambda one: int(one.partition("-")[2])))


@dataclass(frozen=True)
class _OpenTerm:
    """A coefficient of which nothing says what is right."""

    term: str
    index: int
    values: tuple[float, ...]
    tables: tuple[str, ...]
    erratum: str
    note: str


@dataclass(frozen=True)
class _LevelBox:
    """Levels at -1 and +1: the range of use, and the scale of the coded coefficients."""

    frequency: tuple[float, float]
    mean_tension: tuple[float, float]
    tension_amplitude: tuple[float, float]
    rated_break_strength: float
    table: str


@dataclass(frozen=True)
@read_only_arrays
class PublishedSurface:
    """Response surface of a line: eq. 5 of [1]_ in coded factors.

    Parameters
    ----------
    response : str
        Name in the vocabulary.
    coefficient : ndarray, shape (10,)
        B1 .. B10: mean, squares, linear, interactions of frequency, mean tension and tension
        amplitude; NaN where open. [N], of relaxation time [s]
    open_terms : tuple of OpenTerm
        What stands in the place of NaN.
    boxes : tuple of LevelBox
        One; two where the levels are open, the better supported first.
    r2 : float
        NaN where open.
    passes_f_test : bool
        At 5 %, with 9 and 5 degrees of freedom.
    n_lines : int or None
        Lines tested; None where no table says, or tables disagree.
    tables, errata : tuple of str
        Where the column is printed, and what touches it.
    """

    response: str
    coefficient: Floats
    open_terms: tuple[_OpenTerm, ...]
    boxes: tuple[_LevelBox, ...]
    r2: float
    passes_f_test: bool
    n_lines: int | None
    tables: tuple[str, ...]
    errata: tuple[str, ...]


@dataclass(frozen=True)
@read_only_arrays
class PublishedCubic:
    """Cubic of tension: K_0, or strain.

    Parameters
    ----------
    quantity : str
        ``quasi_static_spring_constant`` or ``quasi_static_strain``.
    coefficient : ndarray, shape (4,)
        A, B, C, D; NaN where open. [N N-k] or [N-k]
    open_terms : tuple of OpenTerm
        What stands in the place of NaN.
    tension_high : float
        End of the range of use, which begins at zero; the smaller where tables differ, NaN where
        open. [N]
    n_samples : int or None
        Pulls.
    tables, errata : tuple of str
        Where it is printed, and what touches it.
    note : str
        Of which lines, where the row is of several.
    """

    quantity: str
    coefficient: Floats
    open_terms: tuple[_OpenTerm, ...]
    tension_high: float
    n_samples: int | None
    tables: tuple[str, ...]
    errata: tuple[str, ...]
    note: str


@dataclass(frozen=True)
class _StatedStrength:
    """One statement of a strength; there are several for most lines, and they differ."""

    value: float
    table: str
    what: str
    erratum: str


@dataclass(frozen=True)
class _PublishedStrength:
    """Breaks of a line; NaN and None where not printed, or open."""

    tensile_strength: float
    tensile_strength_standard_deviation: float
    strain_at_failure: float
    strain_at_failure_standard_deviation: float
    n_samples: int | None
    table: str
    errata: tuple[str, ...]


@dataclass(frozen=True)
class PublishedLine:
    """One line in one condition.

    Parameters
    ----------
    name : str
        ``nylon-double-braid-0.5in-new``.
    material, construction, condition : str
        In the words of the tables: ``nylon``, ``8-strand plaited``, ``4 years``.
    diameter : float
        Nominal. [m]
    rated_break_strength : float
        That the tested levels are shares of, or, for a line without, the measured one; of the
        better supported two where that is open. [N]
    stated_strengths : tuple of StatedStrength
        Everything that is printed as strength of the new line.
    surfaces : mapping of str to PublishedSurface
        By response.
    stiffness : PublishedCubic or None
        K_0 against mean tension.
    load_strain : PublishedCubic or None
        Strain against tension, whose slope is 1/K_0.
    strength : PublishedStrength or None
        Breaks.
    absent : mapping of str to str
        Why a response, ``quasi_static_spring_constant``, ``quasi_static_strain`` or
        ``tensile_strength`` is not there.
    """

    name: str
    material: str
    construction: str
    diameter: float
    condition: str
    rated_break_strength: float
    stated_strengths: tuple[_StatedStrength, ...]
    surfaces: Mapping[str, PublishedSurface]
    stiffness: PublishedCubic | None
    load_strain: PublishedCubic | None
    strength: _PublishedStrength | None
    absent: Mapping[str, str]

    @property
    def errata(self) -> tuple[str, ...]:
        """Everything that touches a number of the line, in the order of the ids."""
        parts = [*self.surfaces.values(), self.stiffness, self.load_strain, self.strength]
        found = {one for part in parts if part is not None for one in part.errata}
        found |= {one.erratum for one in self.stated_strengths if one.erratum}
        return tuple(sorted(found, key=lambda one: int(one.partition("-")[2])))


def _terms(
    cells: _LineCells, tables: Sequence[str], row: str, quantity: str, names: Sequence[str],
    scale: Sequence[float],
) -> tuple[list[float], tuple[_OpenTerm, ...], list[Cell]]:  # fmt: skip
    """Coefficients in SI, those that are open, and the cells."""
    values, opened, used = [], [], []
    for index, (name, factor) in enumerate(zip(names, scale, strict=True)):
        prints = cells.prints(tables, row, f"{quantity} {name}")
        used += prints
        values.append(_number_used(prints[0]) * float(factor))
        if prints[0].confidence == "open":
            opened.append(
                _OpenTerm(
                    term=name,
                    index=index,
                    values=tuple(_number_printed(cell) * float(factor) for cell in prints),
                    tables=tuple(cell.table for cell in prints),
                    erratum=prints[0].erratum,
                    note=prints[0].note,
                )
            )
    return values, tuple(opened), used


def _surface(cells: _LineCells, row: str, response: str) -> PublishedSurface | None:
    tables, scale = RESPONSES[response]
    printed = tuple(table for table in tables if cells.get(table, row, f"{response} B1"))
    if not printed:
        return None
    names = [f"B{i}" for i in range(1, 11)]
    values, opened, used = _terms(cells, printed, row, response, names, [scale] * 10)
    share = cells.prints(printed, row, f"{response} r2")
    statistic = cells.prints(printed, row, f"{response} F-stat")
    count = cells.prints(printed, row, f"{response} number of lines")
    lines = _number_used(count[0]) if count else float("nan")
    found = statistic[0]
    return PublishedSurface(
        response=response,
        coefficient=np.array(values),
        open_terms=opened,
        boxes=_boxes(cells, row, response, printed),
        r2=_number_used(share[0]),
        passes_f_test=(_number_printed(found) if found.corrected is None else found.corrected)
        > CRITICAL_F,
        n_lines=None if np.isnan(lines) else int(lines),
        tables=printed,
        errata=_in_order(
            {
                *_errata_of_cells([*used, *share, *statistic, *count]),
                *_errata_of_cells(_range_cells(cells, row, response, printed)),
                *OF_SURFACE.get((row, response), ()),
            }
        ),
    )


def _ends(cells: _LineCells, table: str, row: str, what: str) -> list[Cell]:
    """Low and high level, of the line itself or of all its conditions."""
    whole = row.rpartition(" | ")[0] + " | all"
    found = [
        cells.get(table, one, f"{what} {end}") for end in ("low", "high") for one in (row, whole)
    ]
    return [cell for cell in found if cell is not None]


def _range_cells(cells: _LineCells, row: str, response: str, tables: Sequence[str]) -> list[Cell]:
    return [
        cell
        for table in tables
        for what in ("mean_tension", "tension_amplitude")
        for cell in _ends(cells, table, row, f"{response} {what}")
    ]


def _boxes(
    cells: _LineCells, row: str, response: str, tables: Sequence[str]
) -> tuple[_LevelBox, ...]:
    """One box; of a new line with open levels both, the smaller strength first."""
    is_new = row.endswith("new")
    # levels are those of one programme, whatever the response
    places = [(table, response) for table in tables]
    if is_new:
        places += [(table, other) for other in RESPONSES for table in RESPONSES[other][0]]
    boxes: dict[float, _LevelBox] = {}
    for table, name in places:
        ends = {
            what: [_number_printed(cell) if cell.corrected is None else cell.corrected
                   for cell in _ends(cells, table, row, f"{name} {what}")]
            for what in ("mean_tension", "tension_amplitude")
        }  # fmt: skip
        if any(len(pair) != 2 for pair in ends.values()):
            continue
        mean, amplitude = ends["mean_tension"], ends["tension_amplitude"]
        boxes.setdefault(
            mean[1],
            _LevelBox(
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


def _cubic(cells: _LineCells, row: str, quantity: str) -> PublishedCubic | None:
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
    known = [_number_used(cell) for cell in ranges if not np.isnan(_number_used(cell))]
    counts = cells.prints(printed, place, f"{quantity} number of samples")
    return PublishedCubic(
        quantity=quantity,
        coefficient=np.array(values),
        open_terms=opened,
        tension_high=min(known) * POUND if known else float("nan"),
        n_samples=int(_number_used(counts[0])) if counts else None,
        tables=printed,
        errata=_errata_of_cells([*used, *ranges]),
        note="of four and five years together" if place == combined else "",
    )


def _strength(cells: _LineCells, row: str) -> _PublishedStrength | None:
    kinds = ("mean", "standard deviation")
    columns = [f"{quantity} {kind}" for quantity in (BREAK, "strain_at_failure") for kind in kinds]
    found = [cells.get("10", row, column) for column in columns]
    count = cells.get("10", row, f"{BREAK} number of samples")
    if not any(found):
        return None
    mean, deviation, strain, strain_deviation = (_number_used(cell) for cell in found)
    n_samples = _number_used(count)
    return _PublishedStrength(
        tensile_strength=mean * POUND,
        tensile_strength_standard_deviation=deviation * POUND,
        strain_at_failure=strain,
        strain_at_failure_standard_deviation=strain_deviation,
        n_samples=None if np.isnan(n_samples) else int(n_samples),
        table="10",
        errata=_errata_of_cells([cell for cell in [*found, count] if cell is not None]),
    )


def _strengths_when_new(cells: _LineCells, row: str) -> tuple[_StatedStrength, ...]:
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
            stated.append(_StatedStrength(_number_printed(cell) * POUND, table, what, cell.erratum))
    return tuple(stated)


def _line(cells: _LineCells, row: str) -> PublishedLine:
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

    Examples
    --------
    The surface of the polyester braid is that of Table 13, not its misprint in Table 11:

    >>> lines = {line.name: line for line in published_lines()}
    >>> surface = lines["polyester-double-braid-0.5in-new"].surfaces["hysteresis_energy"]
    >>> print(round(float(surface.coefficient[0]) / 4.4482216, 3), surface.errata[:1])
    1.2 ('CG-5',)
    """
    cells = _LineCells(cells_of("CG-D-39-80"))
    return tuple(_line(cells, row) for row in cells.rows())


_LARGEST_OF_ITS_OWN = 0.026
"""Lines above an inch were loaded in shares of the strength of the one of an inch. [m]"""

_SAME_STRENGTH = 1.0
"""Difference of two strengths that are one. [N]"""


def strength_notes(line: PublishedLine) -> tuple[str, ...]:
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
    return scale_to_si("%", "strain")[0] * _number_used(cell)


def scatter_notes(line: PublishedLine) -> tuple[str, ...]:
    """How alike lines are after years in the sea; nothing of a new one."""
    if line.condition == "new":
        return ()
    return (
        "exposed lines differ among each other by about half, new ones by a tenth (sec. 4.4.1): "
        "that is in no interval but those of the kind and of another line, which K_ap has",
    )


def level_notes(line: PublishedLine) -> tuple[str, ...]:
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
