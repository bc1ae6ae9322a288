"""Rubber tethers of WHOI-2005-10 in SI, as corrected: specimens, marks, test plan, segments."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Literal, NamedTuple, cast

import numpy as np

from reduction.published.printed_cells import Cell, ReportId, cells_of, errata_of, table_of
from reduction.quantities.units import scale_to_si
from reduction.record.errors import DataError
from reduction.record.measurement import Specimen, SpliceMarks, StepReadings
from reduction.record.notes import note
from reduction.record.settings import StrainMethod

TetherName = Literal["new", "used"]

SegmentData = Literal["raw", "consolidated"]

_SEGMENT = re.compile(
    r"(T-\d)( after 3000 cycles)? rubber tether (new|used), (raw|consolidated) data, ascending, "
    r"segment (\d)"
)


class _SegmentName(NamedTuple):
    """What the heading of a row of Tables 5 and 6 says."""

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
        Test, condition, tether, which of the two tables, place from the lowest strain.
    branch : str
        ``ascending``: no descending modulus is tabulated.
    strain_low, strain_high : float
        By ``strain_method``; NaN where open. [1]
    tension_low, tension_high : float
        NaN where open. [N]
    modulus : float
        On the area at zero tension; NaN where open. [Pa]
    strain_method : StrainMethod
        Of the report; in T-1 it gives moduli 1.145 (new) and 1.163 (used) times those of the
        marks.
    is_open : bool
        Whether a number of the row is open.
    errata : tuple of str
        Ids of what touches the row.
    notes : tuple of str
        Alternatives, and what else to know.
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
    branch: Literal["ascending"] = "ascending"
    strain_method: StrainMethod = "constant-fraction"


@dataclass(frozen=True)
class _TetherTest:
    """One row of Table 1."""

    name: str
    target_strain_low: float
    target_strain_high: float
    n_cycles: int


@dataclass(frozen=True)
class PublishedTether:
    """What the report holds of one tether.

    Parameters
    ----------
    name : {"new", "used"}
    specimen : Specimen
        Diameter as corrected, hence area; stretched diameters; break strength of the text.
    printed_diameter : float
        Of Table 2. [m]
    marks : SpliceMarks
        Of test T-1, the only ones printed.
    tests : tuple of TetherTest
        In the order they were run.
    segments : tuple of TetherSegment
        Raw (Table 5), then consolidated (Table 6).
    errata : tuple of str
        Ids of what touches all of it.
    """

    name: TetherName
    specimen: Specimen
    printed_diameter: float
    marks: SpliceMarks
    tests: tuple[_TetherTest, ...]
    segments: tuple[TetherSegment, ...]
    errata: tuple[str, ...]

    def segments_of(
        self, test: str, *, data: SegmentData, condition: str = "ten cycles"
    ) -> tuple[TetherSegment, ...]:
        """Segments of one test, in rising strain."""
        found = tuple(
            one
            for one in self.segments
            if (one.name.test, one.name.data, one.name.condition) == (test, data, condition)
        )
        if not found:
            tests = dict.fromkeys(f"{one.name.test} {one.name.condition}" for one in self.segments)
            raise DataError(
                f"no {data} segments of tether {self.name} are printed for {test} {condition}",
                needed="one of " + ", ".join(tests),
            )
        return found


def _name_of_segment(row: str) -> _SegmentName:
    """What the heading of a row of Tables 5 and 6 says.

    Examples
    --------
    >>> _name_of_segment("T-1 rubber tether used, raw data, ascending, segment 1").tether
    'used'
    """
    found = _SEGMENT.fullmatch(row)
    if found is None:
        raise DataError("a row is no segment", found=row, needed="a row of Tables 5 and 6")
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
    >>> (segment,) = new.segments_of("T-5", data="consolidated")
    >>> slope = (segment.tension_high - segment.tension_low) / (
    ...     segment.strain_high - segment.strain_low)
    >>> print(round(segment.modulus * new.specimen.area / slope, 3))
    0.999
    """
    return _tether("new"), _tether("used")


def published_static_test() -> StepReadings:
    """Table 4, with the length at 1325 as corrected.

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
    """Ids of errata in their order, without those that only say that a number stands."""
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
