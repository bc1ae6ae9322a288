"""The package's tables of printed numbers, read once."""

from __future__ import annotations

import csv
from functools import cache
from importlib.resources import files
from typing import cast, get_args

from reduction.errors import DataError
from reduction.published.cell import Cell, Confidence, Erratum, ReportId

REPORTS: tuple[ReportId, ...] = get_args(ReportId)
_HEADER = [
    "table", "row", "column", "printed", "unit", "corrected", "erratum", "confidence", "page",
    "note",
]  # fmt: skip


@cache
def cells_of(report: ReportId) -> tuple[Cell, ...]:
    """Every printed number of a report.

    Parameters
    ----------
    report : ReportId
        Which of the five.

    Returns
    -------
    cells : tuple of Cell
        In the order of the files, which are in the order of the tables.

    Raises
    ------
    DataError
        If the package's own data are not as they have to be.
    """
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
        raise DataError(f"a printed number of {report} stands twice", found=" / ".join(twice))
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
    """Every known fault of a report, in the order of its ids.

    Parameters
    ----------
    report : ReportId
        Which of the five.

    Returns
    -------
    errata : tuple of Erratum
        With the evidence.
    """
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
    """Cells of one table by row and column.

    Parameters
    ----------
    report : ReportId
        Which of the five.
    table : str
        As the page numbers it.

    Returns
    -------
    cells : dict of (row, column) to Cell

    Raises
    ------
    DataError
        If the report has no such table.
    """
    found = {(cell.row, cell.column): cell for cell in cells_of(report) if cell.table == table}
    if not found:
        known = sorted({cell.table for cell in cells_of(report)})
        raise DataError(f"{report} has no table {table}", needed="one of " + ", ".join(known))
    return found
