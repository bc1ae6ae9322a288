"""Printed numbers: one cell, and the tables of them."""

from __future__ import annotations

import csv
import re
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Literal, cast, get_args

from reduction.record.errors import DataError

ReportId = Literal["WHOI-2004-06", "Zhang-2015", "WHOI-2005-10", "CG-D-39-80", "Wang-2022"]

Confidence = Literal["", "certain", "high", "open"]
"""Confidence of a correction; open: the page is wrong or doubtful, the right value not known."""

_NUMBER = re.compile(r"[-+]?(?:\d[\d,]*\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")

_FRACTION = re.compile(r"([-+]?)(?:(\d+) )?(\d+)/([1-9]\d*)(?![/\d])")


@dataclass(frozen=True)
class Cell:
    """One printed number.

    Parameters
    ----------
    report : str
        One of the five.
    table : str
        ``3``, ``A-2``, or the section of a claim of the text, ``sec 4.4.1``.
    row, column : str
        Line or specimen, and quantity.
    printed : str
        The text as printed.
    unit : str
        As printed.
    corrected : float or None
        Value in the printed unit where the page is wrong; None where it is right, or open.
    erratum : str
        Id of `Erratum`; empty where no error is known.
    confidence : str
        Confidence of the correction.
    page : str
        Page or section.
    note : str
        Other remarks.
    """

    report: ReportId
    table: str
    row: str
    column: str
    printed: str
    unit: str
    corrected: float | None
    erratum: str
    confidence: Confidence
    page: str
    note: str

    @property
    def key(self) -> tuple[str, str, str]:
        """Place in the report."""
        return self.table, self.row, self.column

    @property
    def value(self) -> float | None:
        """Value to use: corrected, or as printed; None for text and open cells."""
        if self.corrected is not None:
            return self.corrected
        return None if self.confidence == "open" else number_of(self.printed)


@dataclass(frozen=True)
class Erratum:
    """An error of a page: the printed text, the right one, and the reason."""

    id: str
    report: ReportId
    place: str
    printed: str
    corrected: str
    evidence: str
    confidence: Confidence


def number_of(text: str) -> float | None:
    """The number in a printed text; None where there is none.

    Examples
    --------
    >>> number_of("1,725"), number_of("-.188"), number_of("about 30"), number_of("n/a")
    (1725.0, -0.188, 30.0, None)
    >>> number_of("-3/2"), number_of("1 1/4 in")
    (-1.5, 1.25)
    """
    found = _NUMBER.search(text)
    if found is None:
        return None
    fraction = _FRACTION.match(text, found.start())
    if fraction is not None:
        sign, whole, over, under = fraction.groups()
        return (-1 if sign == "-" else 1) * (int(whole or 0) + int(over) / int(under))
    return float(found[0].replace(",", ""))


def printed_step(text: str) -> float:
    """One unit of the last printed digit; 0 where there is no number, and for a fraction.

    Examples
    --------
    >>> printed_step("6.317"), printed_step("1,725"), printed_step(".07"), printed_step("3.26e-11")
    (0.001, 1.0, 0.01, 1e-13)
    """
    found = _NUMBER.search(text)
    if found is None or _FRACTION.match(text, found.start()):
        return 0.0
    mantissa, _, power = found[0].lower().replace(",", "").partition("e")
    decimals = len(mantissa.partition(".")[2])
    return float(f"1e{int(power or 0) - decimals}")


REPORTS: tuple[ReportId, ...] = get_args(ReportId)

_HEADER = [
    "table", "row", "column", "printed", "unit", "corrected", "erratum", "confidence", "page",
    "note",
]  # fmt: skip


@cache
def cells_of(report: ReportId) -> tuple[Cell, ...]:
    """Every printed number of a report."""
    room = files("reduction.published") / "data" / report
    cells: list[Cell] = []
    for entry in sorted(room.iterdir(), key=lambda one: one.name):
        if entry.name in ("errata.csv", "claims.csv") or not entry.name.endswith(".csv"):
            continue
        cells += _read(report, entry.name, entry.read_text(encoding="utf-8"))
    claims = room / "claims.csv"
    if claims.is_file():
        cells += _read(report, "claims.csv", claims.read_text(encoding="utf-8"))
    keys = [cell.key for cell in cells]
    if len(set(keys)) < len(keys):
        twice = next(key for key in keys if keys.count(key) > 1)
        raise DataError(f"a printed number of {report} appears twice", found=" / ".join(twice))
    return tuple(cells)


def _read(report: ReportId, name: str, text: str) -> list[Cell]:
    rows = csv.reader(text.splitlines())
    header = next(rows, [])
    if header != _HEADER:
        raise DataError(
            f"{report}/{name} has another header", found=", ".join(header),
            needed=", ".join(_HEADER),
        )  # fmt: skip
    cells = []
    for row in rows:
        table, line, column, printed, unit, corrected, erratum, confidence, page, note = row
        cells.append(
            Cell(
                report=report,
                table=table,
                row=line,
                column=column,
                printed=printed,
                unit=unit,
                corrected=float(corrected) if corrected else None,
                erratum=erratum,
                confidence=_confidence(confidence, f"{report}/{name}: {line}, {column}"),
                page=page,
                note=note,
            )
        )
    return cells


@cache
def errata_of(report: ReportId) -> tuple[Erratum, ...]:
    """Every known error of a report, in the order of its ids."""
    text = (files("reduction.published") / "data" / report / "errata.csv").read_text("utf-8")
    return tuple(
        Erratum(
            id=row["id"],
            report=report,
            place=row["place"],
            printed=row["printed"],
            corrected=row["corrected"],
            evidence=row["evidence"],
            confidence=_confidence(row["confidence"], f"{report}/errata.csv: {row['id']}"),
        )
        for row in csv.DictReader(text.splitlines())
    )


def _confidence(text: str, place: str) -> Confidence:
    for known in get_args(Confidence):
        if text == known:
            return cast("Confidence", known)
    raise DataError(f"{place} has no such confidence", found=f"'{text}'")


def table_of(report: ReportId, table: str) -> dict[tuple[str, str], Cell]:
    """Cells of one table by row and column."""
    found = {(cell.row, cell.column): cell for cell in cells_of(report) if cell.table == table}
    if not found:
        known = sorted({cell.table for cell in cells_of(report)})
        raise DataError(f"{report} has no table {table}", needed="one of " + ", ".join(known))
    return found
