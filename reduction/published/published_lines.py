"""Published lines and tethers in SI, as corrected.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from types import MappingProxyType
from typing import Literal, NamedTuple, cast

import numpy as np

from reduction.published.printed_cells import (
    Cell,
    ReportId,
    cells_of,
    errata_of,
    number_of,
    table_of,
)
from reduction.quantities.units import scale_to_si
from reduction.record.errors import DataError
from reduction.record.measurement import (
    Floats,
    Specimen,
    SpliceMarks,
    StepReadings,
    read_only_arrays,
)
from reduction.record.notes import note

POUND, INCH = scale_to_si("lbf", "force")[0], scale_to_si("in", "length")[0]

# tables of a response, that of new lines first, and the SI value of its printed unit
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

# erratum of a whole surface, not of one of its cells
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
    """Number as printed; NaN for words."""
    value = number_of(cell.printed)
    return float("nan") if value is None else value


def _number_used(cell: Cell | None) -> float:
    """Number as corrected; NaN where open or absent."""
    value = None if cell is None else cell.value
    return float("nan") if value is None else value


def _errata_of_cells(cells: Sequence[Cell]) -> tuple[str, ...]:
    """Ids of the errata of some cells, in their order."""
    return _in_order({cell.erratum for cell in cells if cell.erratum})


def _in_order(ids: Iterable[str]) -> tuple[str, ...]:
    """Ids ordered by number."""
    return tuple(sorted(ids, key=lambda one: int(one.partition("-")[2])))


@dataclass(frozen=True)
class _OpenTerm:
    """A coefficient whose right value is not known."""

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
    open_terms : tuple of _OpenTerm
        Possible values in place of NaN.
    boxes : tuple of _LevelBox
        One, or two where the levels are open, the better supported first.
    r2 : float
        NaN where open.
    passes_f_test : bool
        At 5 %, with 9 and 5 degrees of freedom.
    n_lines : int or None
        Number of tested lines; None where no table states it, or tables disagree.
    tables, errata : tuple of str
        Tables of the column, and errata that affect it.
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
    open_terms : tuple of _OpenTerm
        Possible values in place of NaN.
    tension_high : float
        End of the range of use, which begins at zero; the smaller where tables differ, NaN where
        open. [N]
    n_samples : int or None
        Number of pulls.
    tables, errata : tuple of str
        Tables of the cubic, and errata that affect it.
    note : str
        Lines of the row, where it covers several.
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
    """One stated strength; most lines have several, and they differ."""

    value: float
    table: str
    what: str
    erratum: str


@dataclass(frozen=True)
class _PublishedStrength:
    """Breaks of a line; NaN and None where not printed, or open."""

    tensile_strength: float
    strain_at_failure: float
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
        As worded in the tables: ``nylon``, ``8-strand plaited``, ``4 years``.
    diameter : float
        Nominal. [m]
    rated_break_strength : float
        Reference of the tested levels, or the measured strength for a line without them; where
        two are possible, the better supported one. [N]
    stated_strengths : tuple of _StatedStrength
        All strengths printed for the new line.
    surfaces : mapping of str to PublishedSurface
        Surfaces by response.
    stiffness : PublishedCubic or None
        K_0 against mean tension.
    load_strain : PublishedCubic or None
        Strain against tension, whose slope is 1/K_0.
    strength : PublishedStrength or None
        Results of breaks.
    absent : mapping of str to str
        Why a response, ``quasi_static_spring_constant``, ``quasi_static_strain`` or
        ``tensile_strength`` is missing.
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
        """Every erratum that affects a number of the line, in the order of the ids."""
        parts = [*self.surfaces.values(), self.stiffness, self.load_strain, self.strength]
        found = {one for part in parts if part is not None for one in part.errata}
        found |= {one.erratum for one in self.stated_strengths if one.erratum}
        return tuple(sorted(found, key=lambda one: int(one.partition("-")[2])))


def _terms(
    cells: _LineCells, tables: Sequence[str], row: str, quantity: str, names: Sequence[str],
    scale: Sequence[float],
) -> tuple[list[float], tuple[_OpenTerm, ...], list[Cell]]:  # fmt: skip
    """Coefficients in SI, open coefficients, and the cells."""
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
    """Low and high level, for the line itself or for all its conditions."""
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
    """One box; for a new line with open levels both, the smaller strength first."""
    is_new = row.endswith("new")
    # levels are those of one programme, independent of the response
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
    # K_0 of four and five years is in one row
    place = combined if quantity == REST and not row.endswith("new") else row
    printed = tuple(table for table in tables if cells.get(table, place, f"{quantity} A"))
    if not printed:
        return None
    values, opened, used = _terms(cells, printed, place, quantity, "ABCD", scale)
    ranges = cells.prints(printed, place, f"{quantity} mean_tension high")
    # tables of new and of exposed lines have separate ranges: both confirm the smaller one
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
    mean, _, strain, _ = (_number_used(cell) for cell in found)
    n_samples = _number_used(count)
    return _PublishedStrength(
        tensile_strength=mean * POUND,
        strain_at_failure=strain,
        n_samples=None if np.isnan(n_samples) else int(n_samples),
        table="10",
        errata=_errata_of_cells([cell for cell in [*found, count] if cell is not None]),
    )


def _strengths_when_new(cells: _LineCells, row: str) -> tuple[_StatedStrength, ...]:
    """Rated and measured strengths of the new line, as in the tables."""
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
    The surface of the polyester braid is that of Table 13, not the misprinted one in Table 11:

    >>> lines = {line.name: line for line in published_lines()}
    >>> surface = lines["polyester-double-braid-0.5in-new"].surfaces["hysteresis_energy"]
    >>> print(round(float(surface.coefficient[0]) / 4.4482216, 3), surface.errata[:1])
    1.2 ('CG-5',)
    """
    cells = _LineCells(cells_of("CG-D-39-80"))
    return tuple(_line(cells, row) for row in cells.rows())


_LARGEST_OF_ITS_OWN = 0.026

"""Lines above an inch were loaded in shares of the strength of the one-inch line. [m]"""

_SAME_STRENGTH = 1.0

"""Difference within which two strengths are equal. [N]"""


def _place(table: str) -> str:
    """Place of a printed number: ``Table 2``, ``sec. 6.3.2``."""
    return table.replace("sec ", "sec. ") if table.startswith("sec ") else f"Table {table}"


def strength_notes(line: PublishedLine) -> tuple[str, ...]:
    """Notes on the strength, where the tables do not agree."""
    found = sorted({round(one.value) for one in line.stated_strengths})
    if len(found) < 2:
        return ()
    listed = ", ".join(f"{one.value:.0f} N ({_place(one.table)})" for one in line.stated_strengths)
    return (
        f"the break strength is printed as {listed}; the tested levels are shares of "
        f"{line.rated_break_strength:.0f} N",
    )


def strength_of(line: PublishedLine) -> str:
    """Line whose strength is the reference of the levels: Table 1, footnote 3."""
    is_largest = line.construction == "double braid" and line.diameter > _LARGEST_OF_ITS_OWN
    return "the 1 in line" if is_largest else ""


def own_strength(line: PublishedLine) -> tuple[float, tuple[str, ...]]:
    """Residual strength of a line after years in the sea, with notes; NaN for a new line."""
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
    # its own value is preferred to that of another age
    broken.sort(key=lambda one: one.condition != line.condition)
    if not broken or broken[0].strength is None:
        return float("nan"), ("no break of a line in this condition is printed",)
    found, age = broken[0].strength, broken[0].condition
    whose = "this condition" if age == line.condition else f"{age} (none of {line.condition})"
    share = 100 * found.tensile_strength / line.rated_break_strength
    return found.tensile_strength, (
        f"lines in {whose} break at {found.tensile_strength:.0f} N ({_place(found.table)}), "
        f"{share:.0f} % of the strength that %RBS and the tested levels refer to; the rule is "
        "judged by it",
    )


def line_scatter(line: PublishedLine) -> float:
    """Standard deviation between lines over their mean, for K_ap: sec. 4.4.1."""
    row = "new" if line.condition == "new" else "field exposure"
    cell = table_of("CG-D-39-80", "sec 4.4.1")[row, "relative variability"]
    return scale_to_si("%", "strain")[0] * _number_used(cell)


def scatter_notes(line: PublishedLine) -> tuple[str, ...]:
    """Notes on the similarity of lines after years in the sea; none for a new line."""
    if line.condition == "new":
        return ()
    return (
        "exposed specimens scatter by about 50 %, new ones by 10 % (sec. 4.4.1): included only in "
        "the intervals of the kind and of another specimen, which only K_ap has",
    )


def level_notes(line: PublishedLine) -> tuple[str, ...]:
    """Note on an exposed line whose levels refer to another strength than those of the new line."""
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
    """Whether a line is plaited nylon after years in the sea."""
    return (line.material, line.construction) == ("nylon", "8-strand plaited") and (
        line.condition != "new"
    )


TetherName = Literal["new", "used"]

SegmentData = Literal["raw", "consolidated"]

_SEGMENT = re.compile(
    r"(T-\d)( after 3000 cycles)? rubber tether (new|used), (raw|consolidated) data, ascending, "
    r"segment (\d)"
)


class _SegmentName(NamedTuple):
    """Content of the heading of a row in Tables 5 and 6."""

    test: str
    condition: Literal["ten cycles", "after 3000 cycles"]
    tether: TetherName
    data: SegmentData
    number: int


@dataclass(frozen=True)
class TetherSegment:
    """One row of Tables 5 and 6: a straight piece of an ascending branch.

    Parameters
    ----------
    name : SegmentName
        Test, condition, tether, table, place counted from the lowest strain.
    strain_low, strain_high : float
        By a constant fraction, the method of the report; NaN where open. [1]
    tension_low, tension_high : float
        NaN where open. [N]
    modulus : float
        Ascending, as no descending modulus is tabulated, with the area at zero tension; NaN where
        open. By the strain of the report: in T-1 1.145 (new) and 1.163 (used) times that of the
        marks. [Pa]
    is_open : bool
        Whether a number of the row is open.
    errata : tuple of str
        Ids of errata that affect the row.
    notes : tuple of str
        Alternatives and other remarks.
    """

    name: _SegmentName
    strain_low: float
    strain_high: float
    tension_low: float
    tension_high: float
    modulus: float
    is_open: bool
    errata: tuple[str, ...]
    notes: tuple[str, ...]


@dataclass(frozen=True)
class _TetherTest:
    """One row of Table 1."""

    name: str
    target_strain_low: float
    target_strain_high: float
    n_cycles: int


@dataclass(frozen=True)
class PublishedTether:
    """Data of the report on one tether.

    Parameters
    ----------
    name : {"new", "used"}
    specimen : Specimen
        Diameter as corrected, hence area; stretched diameters; break strength of the text.
    printed_diameter : float
        From Table 2. [m]
    marks : SpliceMarks
        For test T-1, the only ones printed.
    tests : tuple of TetherTest
        In the order they were run.
    segments : tuple of TetherSegment
        Raw (Table 5), then consolidated (Table 6).
    errata : tuple of str
        Ids of errata that affect all of it.
    """

    name: TetherName
    specimen: Specimen
    printed_diameter: float
    marks: SpliceMarks
    tests: tuple[_TetherTest, ...]
    segments: tuple[TetherSegment, ...]
    errata: tuple[str, ...]


def _name_of_segment(row: str) -> _SegmentName:
    """Content of the heading of a row in Tables 5 and 6.

    Examples
    --------
    >>> _name_of_segment("T-1 rubber tether used, raw data, ascending, segment 1").tether
    'used'
    """
    found = _SEGMENT.fullmatch(row)
    if found is None:
        raise DataError("a row is not a segment", found=row, needed="a row of Tables 5 and 6")
    return _SegmentName(
        test=found[1],
        condition="after 3000 cycles" if found[2] else "ten cycles",
        tether=cast("TetherName", found[3]),
        data=cast("SegmentData", found[4]),
        number=int(found[5]),
    )


TETHER_REPORT: ReportId = "WHOI-2005-10"

_METHOD_ERRATUM = "WH5-34"

_INCH, _FOOT = (scale_to_si(unit, "length")[0] for unit in ("inch", "ft"))

_LBF = scale_to_si("lbf", "force")[0]

_PSI = scale_to_si("psi", "stress")[0]

_PER_CENT = scale_to_si("%", "strain")[0]

_TAPE_READING = 0.01 / np.sqrt(12)  # rectangular, one unit of the last printed digit; in feet


def published_tethers() -> tuple[PublishedTether, PublishedTether]:
    """The new and the used tether.

    Examples
    --------
    >>> new, used = published_tethers()
    >>> print([round(one.specimen.area / 0.0254**2, 3) for one in (new, used)])
    [0.849, 0.694]
    >>> (segment,) = [one for one in new.segments
    ...     if (one.name.test, one.name.data) == ("T-5", "consolidated")]
    >>> slope = (segment.tension_high - segment.tension_low) / (
    ...     segment.strain_high - segment.strain_low)
    >>> print(round(segment.modulus * new.specimen.area / slope, 3))
    0.999
    """
    return _tether("new"), _tether("used")


def published_static_test() -> StepReadings:
    """Table 4, with the corrected length at 1325.

    Examples
    --------
    >>> print(round(published_static_test().length.max() / 0.0254, 2))
    19.13
    """
    columns: dict[str, list[Cell]] = {}
    for (_, column), one in table_of(TETHER_REPORT, "4").items():
        columns.setdefault(column, []).append(one)
    clock = tuple(one.printed for one in columns["clock"])
    seconds = np.array([3600.0 * int(text[:2]) + 60.0 * int(text[2:]) for text in clock])
    in_si = {name: np.array([_number(one) for one in cells]) for name, cells in columns.items()}
    return StepReadings(
        clock=clock,
        time=seconds - seconds[0],
        tension=_LBF * in_si["tension"],
        length=_INCH * in_si["length"],
        eye_to_eye_length=_INCH * in_si["eye_to_eye_length"],
        printed_strain=_PER_CENT * in_si["strain"],
        notes=(
            note(
                "misprint-corrected",
                reading="1325",
                length="15.38 in",
                printed="16.38",
                erratum="WH5-13",
            ),
        ),
    )


def _number(cell: Cell) -> float:
    return float("nan") if cell.value is None else cell.value


def _tether(name: TetherName) -> PublishedTether:
    diameters = {
        column: one
        for (row, column), one in table_of(TETHER_REPORT, "2").items()
        if row.startswith(f"rubber tether {name},")
    }
    stretched = []
    for column, one in diameters.items():
        found = re.search(r"at (\d+) %", column)
        if found:
            stretched.append((_PER_CENT * float(found[1]), _INCH * _number(one)))
    diameter = diameters["diameter"]
    claims = table_of(TETHER_REPORT, "sec 2.3.2")
    breaks = claims["single tether", "rated_break_strength"]
    specimen = Specimen(
        name=name,
        kind="rubber tether",
        material="Natsyn rubber",
        condition=name,
        construction="solid round",
        diameter=(_INCH * _number(diameter),),
        stretched_diameters=tuple(stretched),
        rated_break_strength=_LBF * _number(breaks),
        rated_break_strength_source=f"{TETHER_REPORT} {breaks.page}: {breaks.note} 800 lbf",
        notes=(diameter.note,) if diameter.corrected is not None else (),
    )
    return PublishedTether(
        name=name,
        specimen=specimen,
        printed_diameter=_INCH * float(diameter.printed),
        marks=_marks(name),
        tests=_tests(),
        segments=tuple(_segments("5", name) + _segments("6", name)),
        errata=_faults([diameter.erratum, _METHOD_ERRATUM], keep=_METHOD_ERRATUM),
    )


def _faults(ids: list[str], *, keep: str = "") -> tuple[str, ...]:
    """Ids of errata in their order, without those that only confirm a number."""
    stands = {one.id for one in errata_of(TETHER_REPORT) if not one.confidence} - {keep}
    return tuple(one for one in dict.fromkeys(ids) if one and one not in stands)


def _marks(name: TetherName) -> SpliceMarks:
    table = table_of(TETHER_REPORT, "3")
    rows = [
        row for row, column in table
        if column == "near_toe" and row.startswith(f"T-1 rubber tether {name},")
    ]  # fmt: skip
    return SpliceMarks(
        specimen=name,
        test=("T-1",) * len(rows),
        hold=("slack", "min", "centre", "max"),
        near_toe=_FOOT * np.array([_number(table[row, "near_toe"]) for row in rows]),
        far_toe=_FOOT * np.array([_number(table[row, "far_toe"]) for row in rows]),
        far_thimble=_FOOT * np.array([_number(table[row, "far_thimble"]) for row in rows]),
        reading_uncertainty=float(_FOOT * _TAPE_READING),
    )


def _tests() -> tuple[_TetherTest, ...]:
    table = table_of(TETHER_REPORT, "1")
    tests = []
    for row in dict.fromkeys(row for row, _ in table):
        one = {column: _number(cell) for (at, column), cell in table.items() if at == row}
        held = one.get("target_strain", float("nan"))
        tests.append(
            _TetherTest(
                name=row.removeprefix("dynamic test ").partition(",")[0],
                target_strain_low=_PER_CENT * one.get("target_strain_low", held),
                target_strain_high=_PER_CENT * one.get("target_strain_high", held),
                n_cycles=int(one["n_cycles"]),
            )
        )
    return tuple(tests)


def _segments(table: str, tether: TetherName) -> list[TetherSegment]:
    rows: dict[str, dict[str, Cell]] = {}
    for one in cells_of(TETHER_REPORT):
        if one.table == table:
            rows.setdefault(one.row, {})[one.column] = one
    segments = []
    for row, cells in rows.items():
        name = _name_of_segment(row)
        if name.tether != tether:
            continue
        number = {column: _number(one) for column, one in cells.items()}
        segments.append(
            TetherSegment(
                name=name,
                strain_low=number["segment_strain_low"],
                strain_high=number["segment_strain_high"],
                tension_low=_LBF * number["segment_tension_low"],
                tension_high=_LBF * number["segment_tension_high"],
                modulus=_PSI * number["segment_modulus"],
                is_open=any(one.confidence == "open" for one in cells.values()),
                errata=_faults(
                    [*(one.erratum for one in cells.values()), _METHOD_ERRATUM],
                    keep=_METHOD_ERRATUM,
                ),
                notes=tuple(dict.fromkeys(one.note for one in cells.values() if one.note)),
            )
        )
    return segments
