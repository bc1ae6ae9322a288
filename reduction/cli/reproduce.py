"""Implements the command reproduce."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from rich.markup import escape

from reduction.archive.atomic_write import write_text_atomically
from reduction.cli.output import CommandOutput
from reduction.cli.printed_numbers import plain, table_of
from reduction.published.printed_cells import REPORTS, ReportId
from reduction.published.reproduce_page import (
    VERDICTS,
    Counts,
    counts_by_table,
    counts_of,
    csv_of,
    number_beside,
    render_reproduction,
    reproduce,
    touched_errata,
)
from reduction.published.reproduced_item import ReproducedItem
from reduction.record.errors import DataError, SettingsError

UNEXPLAINED = DataError.exit_status

_COLUMNS = (
    "cells: printed numbers of a table. derived: follows from theory or from other numbers, within "
    "its rounding; closed: linked to other cells by equations that would show one unit of its "
    "leading digit at three standard errors (power); repeated: printed twice with the same value, "
    "nothing was computed; erratum: wrong in the report, and the corrected number is reproduced; "
    "open: wrong or doubtful, and the report does not settle it; measured: nothing in the report "
    "can test it; unexplained: cannot be reproduced, and no erratum says why. For an "
    "erratum: right is the corrected text, sure how well it is proved, cells how many numbers it "
    "affects; `--erratum ID` shows its evidence\n"
)


def reproduce_reports(report: str | None, *, out: Path | None, output: CommandOutput) -> None:
    """Recompute and print counts, errata and open cells; if ``out``, write page and table."""
    reports = reproduce(None if report is None else _known(report))
    for one, items in reports.items():
        _show(one, items, output)
    output.say(_COLUMNS)
    if len(reports) > 1:
        _show_total(reports, output)
    if out is not None:
        page, table = out / "reproduce.html", out / "reproduce.csv"
        write_text_atomically(page, render_reproduction(reports))
        write_text_atomically(table, csv_of(item for items in reports.values() for item in items))
        output.say(f"page: {page}")
        output.say(f"table: {table}")
    output.answer(_document(reports) | {"out": None if out is None else str(out)})
    for items in reports.values():
        for item in items:
            if item.verdict == "unexplained":
                output.error(_unexplained(item))
                output.raise_status(UNEXPLAINED)


def reproduce_erratum(report: str | None, erratum: str, *, output: CommandOutput) -> None:
    """Print one known fault of a page: the correct value, the reason, and its cells."""
    reports = reproduce(None if report is None else _known(report))
    faults = [one for name, items in reports.items() for one in touched_errata(name, items)]
    found = [one for one in faults if one.erratum.id.lower() == erratum.lower()]
    if not found:
        kinds = dict.fromkeys(one.erratum.id.rpartition("-")[0] for one in faults)
        raise SettingsError(
            "there is no such erratum", found=repr(erratum),
            needed="one of " + ", ".join(f"{kind}-..." for kind in kinds),
            hint="`reduction reproduce` lists them.",
        )  # fmt: skip
    (one,) = found
    known = one.erratum
    for name in ("place", "printed", "corrected", "evidence", "confidence"):
        output.say(f"{name}: {getattr(known, name)}")
    cells = table_of("cell", "printed", "recomputed", "verdict", "how", texts=5)
    for item in one.items:
        printed = f"{item.cell.printed} {item.cell.unit}"
        again = number_beside(item.recomputed, item.cell.printed) or "-"
        cells.add_row(*map(escape, (_name(item), printed, again, item.verdict, item.how)))
    output.show(cells)
    output.answer({**vars(known), "items": [_described(item) for item in one.items]})


def _known(report: str) -> ReportId:
    for one in REPORTS:
        if one == report:
            return one
    raise SettingsError(
        "there is no such report", found=repr(report), needed="one of " + ", ".join(REPORTS)
    )


def _show(report: ReportId, items: Sequence[ReproducedItem], output: CommandOutput) -> None:
    table = _table(report)
    for name, counts in counts_by_table(items).items():
        table.add_row(escape(name), *_numbers(counts))
    table.add_row("all", *_numbers(counts_of(items)), style="bold")
    output.show(table)
    errata = table_of("erratum", "place", "printed", "right", "sure", "cells", texts=5)
    for one in touched_errata(report, items):
        known = one.erratum
        texts = (known.id, known.place, known.printed, known.corrected, known.confidence)
        errata.add_row(*map(escape, texts), f"{len(one.items)}")
    output.show(errata)
    open_cells = [item for item in items if item.verdict == "open"]
    if open_cells:
        cells = table_of("open cell", "quantity", "printed", "erratum", "what it may be", texts=5)
        for item in open_cells:
            cell = item.cell
            place, printed = f"{cell.table}: {cell.row}", f"{cell.printed} {cell.unit}"
            cells.add_row(
                *map(
                    escape,
                    (place, cell.column, printed, cell.erratum or "-", cell.note or item.how),
                )
            )
        output.show(cells)
    output.say("")


def _show_total(
    reports: Mapping[ReportId, Sequence[ReproducedItem]], output: CommandOutput
) -> None:
    table = _table("report")
    for report, items in reports.items():
        table.add_row(report, *_numbers(counts_of(items)))
    whole = [item for items in reports.values() for item in items]
    table.add_row("all", *_numbers(counts_of(whole)), style="bold")
    output.show(table)


def _table(heading: str) -> Any:
    return table_of(heading, "cells", *VERDICTS)


def _numbers(counts: Counts) -> list[str]:
    return [f"{number:,}" for number in counts.values()]


def _unexplained(item: ReproducedItem) -> str:
    cell = item.cell
    return (
        f"{cell.report}, table {cell.table}, {cell.row}, {cell.column}: printed number does not"
        f" come back; found {cell.printed} {cell.unit}; needed"
        f" {number_beside(item.recomputed, cell.printed) or 'a number'} ({item.how})."
    )


def _document(reports: Mapping[ReportId, Sequence[ReproducedItem]]) -> dict[str, Any]:
    """Output of ``--json``; numbers have the unit of the page, which is given with them."""
    return {
        "reports": {report: counts_of(items) for report, items in reports.items()},
        "items": [_described(item) for items in reports.values() for item in items],
        "errata": [
            {
                **vars(one.erratum),
                "cells": [_name(item) for item in one.items],
            }
            for report, items in reports.items()
            for one in touched_errata(report, items)
        ],
    }


def _name(item: ReproducedItem) -> str:
    return f"{item.cell.row} / {item.cell.column}"


def _described(item: ReproducedItem) -> dict[str, Any]:
    cell = item.cell
    return {
        "report": cell.report,
        "table": cell.table,
        "cell": _name(item),
        "printed": cell.printed,
        "unit": cell.unit,
        "corrected": cell.corrected,
        "recomputed": plain(item.recomputed),
        "tolerance": plain(item.tolerance),
        "verdict": item.verdict,
        "z": plain(item.z),
        "power": plain(item.power),
        "erratum": cell.erratum or None,
        "confidence": cell.confidence or None,
        "how": item.how,
        "note": cell.note or None,
        "page": cell.page,
    }
