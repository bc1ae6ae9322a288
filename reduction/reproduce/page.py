"""The page of reproduced numbers: every cell as printed, corrected, recomputed, and the verdict.

It opens from disk and fetches nothing; its style is that of the reports of campaigns.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib.resources import files

from jinja2 import Environment, StrictUndefined

from reduction import __version__
from reduction.published.cell import ReportId, printed_step
from reduction.reproduce.item import Item, Verdict
from reduction.reproduce.reports import (
    VERDICTS,
    Counts,
    TouchedErratum,
    counts_by_table,
    counts_of,
    touched_errata,
)

TITLES: Mapping[ReportId, str] = {
    "WHOI-2004-06": "W. Paul, Hose Elements for Buoy Moorings: Design, Fabrication, and Mechanical "
    "Properties, Woods Hole Oceanog. Inst., 2004",
    "Zhang-2015": "S. Zhang et al., Wave Loads Computation for Offshore Floating Hose Based on "
    "Partially Immersed Cylinder Model of Improved Morison Formula, Open Petroleum Eng. J., 2015",
    "WHOI-2005-10": "J. D. Irish, W. Paul and D. M. Wyman, The Determination of the Elastic "
    "Modulus of Rubber Mooring Tethers and their Use in Coastal Moorings, Woods Hole Oceanog. "
    "Inst., 2005",
    "CG-D-39-80": "K. R. Bitting, The Dynamic Behavior of Nylon and Polyester Line, U.S. Coast "
    "Guard R&D Center, 1980",
    "Wang-2022": "H. Wang et al., Prediction Method and Validation Study of Tensile Performance of "
    "Reinforced Armor Layer in Marine Flexible Pipe/Cables, J. Mar. Sci. Eng., 2022",
}
_WORDS: Mapping[Verdict, str] = {
    "reproduced": "comes back within the printed rounding",
    "erratum": "the page is wrong; the evidence has an id",
    "open": "the page is doubtful, and nothing says what is right",
    "not_testable": "nothing else in the report determines it",
    "unexplained": "does not come back, and nobody knows why",
}
_MORE_DIGITS, _MOST_DECIMALS = 2, 12
_LEAST_FIXED, _MOST_FIXED = 1e-4, 1e9


@dataclass(frozen=True)
class _Row:
    """One cell as it is shown."""

    item: Item
    corrected: str
    recomputed: str
    tolerance: str


@dataclass(frozen=True)
class _Table:
    title: str
    counts: Counts
    rows: tuple[_Row, ...]


@dataclass(frozen=True)
class _Report:
    id: ReportId
    title: str
    counts: Counts
    tables: tuple[_Table, ...]
    errata: tuple[TouchedErratum, ...]
    without_cell: tuple[str, ...]


def render_reproduction(reports: Mapping[ReportId, Sequence[Item]]) -> str:
    """Every item of the reports as a page that opens from disk.

    Parameters
    ----------
    reports : mapping of ReportId to sequence of Item
        As `reduction.reproduce.reports.reproduce` gives them.

    Returns
    -------
    html : str
        The page.
    """
    environment = Environment(
        autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    room = files("reduction.reproduce")
    template = environment.from_string((room / "templates" / "reproduce.html").read_text("utf-8"))
    shared = files("reduction.report") / "static" / "page.css"
    return template.render(
        reports=[_report(report, items) for report, items in reports.items()],
        total=counts_of(item for items in reports.values() for item in items),
        verdicts=VERDICTS,
        words=_WORDS,
        version=__version__,
        style=shared.read_text("utf-8") + (room / "static" / "reproduce.css").read_text("utf-8"),
        script=(room / "static" / "reproduce.js").read_text("utf-8"),
    )


def _report(report: ReportId, items: Sequence[Item]) -> _Report:
    rows: dict[str, list[_Row]] = {}
    for item in items:
        cell = item.cell
        corrected = "" if cell.corrected is None else f"{cell.corrected:.12g}"
        wide = item.tolerance > 0.501 * printed_step(cell.printed) > 0
        row = _Row(
            item,
            corrected,
            number_beside(item.recomputed, cell.printed),
            f"{item.tolerance:.2g}" if wide and item.verdict == "reproduced" else "",
        )
        rows.setdefault(cell.table, []).append(row)
    counts = counts_by_table(items)
    errata = touched_errata(report, items)
    return _Report(
        id=report,
        title=TITLES[report],
        counts=counts_of(items),
        tables=tuple(_Table(_title(name), counts[name], tuple(own)) for name, own in rows.items()),
        errata=tuple(errata),
        without_cell=tuple(one.erratum.id for one in errata if not one.items),
    )


def _title(table: str) -> str:
    """A table has a number on its page; equations, sections and parts have a name."""
    return table if table[0].islower() or table.startswith("App ") else f"Table {table}"


def number_beside(value: float, printed: str) -> str:
    """A recomputed number with two digits more than the printed one.

    Examples
    --------
    >>> number_beside(84.2132, "84.21"), number_beside(1020.0, "about 1,000")
    ('84.2132', '1,020.00')
    >>> number_beside(1.234567e-11, "1.2e-11"), number_beside(float("nan"), "12")
    ('1.23457e-11', '')
    """
    if not math.isfinite(value):
        return ""
    if value and not _LEAST_FIXED <= abs(value) < _MOST_FIXED:
        # round-off of a number that is nothing beside the printed digits
        step = printed_step(printed)
        return "0" if abs(value) < 1e-9 * step else f"{value:.6g}"
    step = printed_step(printed)
    if step == 0:
        return f"{value:.6g}"
    decimals = min(max(_MORE_DIGITS - round(math.log10(step)), 0), _MOST_DECIMALS)
    return f"{value:,.{decimals}f}"
