"""Where a published number stands on its page, and what is known against the page."""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import cache

from reduction.lookup.product import LineSource
from reduction.published.cell import ReportId
from reduction.published.lines import published_lines
from reduction.published.read import REPORTS, cells_of, errata_of

_LINES: ReportId = "CG-D-39-80"
_TETHER = re.compile(r"WHOI-2005-10, Table (\d+)")


def printed_at(line: LineSource) -> dict[str, str]:
    """Report, table and page of each quantity of a published line, in words.

    Examples
    --------
    >>> from reduction.published.linesource import published_sources
    >>> line = published_sources()["nylon-double-braid-0.5in-new"]
    >>> printed_at(line)["relaxation_time"]
    'CG-D-39-80, Table 17 (page 48), Table 18 (page 49)'
    """
    tether = _TETHER.match(line.source)
    if tether is not None:
        return dict.fromkeys(line.quantities, _words("WHOI-2005-10", (tether[1],)))
    found: dict[str, str] = {}
    for one in published_lines():
        if one.name != line.name:
            continue
        found = {name: _words(_LINES, part.tables) for name, part in one.surfaces.items()}
        for cubic in (one.load_strain, one.stiffness):
            if cubic is not None:
                name = "strain" if cubic.quantity == "quasi_static_strain" else cubic.quantity
                found[name] = _words(_LINES, cubic.tables)
    return {name: text for name, text in found.items() if name in line.quantities}


def _words(report: ReportId, tables: Iterable[str]) -> str:
    parts = [f"Table {table} ({_pages(report, table)})" for table in tables]
    return f"{report}, {', '.join(parts)}"


@cache
def _pages(report: ReportId, table: str) -> str:
    found = dict.fromkeys(cell.page for cell in cells_of(report) if cell.table == table)
    return f"page{'s' if len(found) > 1 else ''} {', '.join(found)}"


def errata_told(lines: Iterable[LineSource]) -> dict[str, list[str]]:
    """Place, print and correction, and evidence of every erratum that touches a line, by its id."""
    touching: set[str] = set()
    for line in lines:
        touching.update(*(one.errata for one in line.surfaces.values()))
        touching.update(*(one.errata for one in line.curves))
    return {
        one.id: [
            f"{one.report}, {one.place}",
            f"printed {one.printed}; corrected {one.corrected or 'nothing'}"
            + (f" ({one.confidence})" if one.confidence not in ("", one.corrected) else ""),
            one.evidence,
        ]
        for report in REPORTS
        for one in errata_of(report)
        if one.id in touching
    }
