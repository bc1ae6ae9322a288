"""The reproduced reports, and their page.

The page opens from disk and fetches nothing; its style is that of the reports of campaigns.
"""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from importlib.resources import files
from typing import get_args

from jinja2 import Environment, StrictUndefined

from reduction import __version__
from reduction.published import cg_d_39_80, wang_2022, whoi_2004_06, whoi_2005_10, zhang_2015
from reduction.published.printed_cells import REPORTS, Erratum, ReportId, errata_of, printed_step
from reduction.published.reproduced_item import ReproducedItem, Verdict

VERDICTS: tuple[Verdict, ...] = get_args(Verdict)

Counts = dict[str, int]
"""``cells``, then the number for each verdict."""

_ITEMS: Mapping[ReportId, Callable[[], list[ReproducedItem]]] = {
    "WHOI-2004-06": whoi_2004_06.items,
    "Zhang-2015": zhang_2015.items,
    "WHOI-2005-10": whoi_2005_10.items,
    "CG-D-39-80": cg_d_39_80.items,
    "Wang-2022": wang_2022.items,
}

_COLUMNS = (
    "report", "table", "row", "column", "printed", "unit", "corrected", "recomputed", "tolerance",
    "verdict", "z", "power", "erratum", "confidence", "how", "page", "note",
)  # fmt: skip


def reproduce(report: ReportId | None = None) -> dict[ReportId, list[ReproducedItem]]:
    """Recompute every printed number of a report, or of all.

    In the order of the tables.
    """
    return {one: _ITEMS[one]() for one in (REPORTS if report is None else (report,))}


def counts_of(items: Iterable[ReproducedItem]) -> Counts:
    """Number of cells, and number for each verdict."""
    counts = dict.fromkeys(("cells", *VERDICTS), 0)
    for item in items:
        counts["cells"] += 1
        counts[item.verdict] += 1
    return counts


def counts_by_table(items: Iterable[ReproducedItem]) -> dict[str, Counts]:
    """Counts of each table, in the order of the tables."""
    tables: dict[str, list[ReproducedItem]] = {}
    for item in items:
        tables.setdefault(item.cell.table, []).append(item)
    return {table: counts_of(own) for table, own in tables.items()}


@dataclass(frozen=True)
class _TouchedErratum:
    """An error of a report, and the items whose cells name it."""

    erratum: Erratum
    items: tuple[ReproducedItem, ...]


def touched_errata(report: ReportId, items: Iterable[ReproducedItem]) -> list[_TouchedErratum]:
    """Every known error of a report with its cells.

    In the order of their ids.
    """
    by_id: dict[str, list[ReproducedItem]] = {}
    for item in items:
        by_id.setdefault(item.cell.erratum, []).append(item)
    return [_TouchedErratum(one, tuple(by_id.get(one.id, ()))) for one in errata_of(report)]


def csv_of(items: Iterable[ReproducedItem]) -> str:
    """Items as a table, one line per cell.

    CSV; unknown values are empty.
    """
    text = io.StringIO()
    writer = csv.writer(text)
    writer.writerow(_COLUMNS)
    for item in items:
        own = {
            "recomputed": item.recomputed, "tolerance": item.tolerance, "verdict": item.verdict,
            "z": item.z, "power": item.power, "how": item.how,
        }  # fmt: skip
        values = (own[name] if name in own else getattr(item.cell, name) for name in _COLUMNS)
        writer.writerow(_written(value) for value in values)
    return text.getvalue()


def _written(value: object) -> str:
    if value is None or (isinstance(value, float) and not math.isfinite(value)):
        return ""
    return repr(float(value)) if isinstance(value, float) else str(value)


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
    "derived": "follows from theory or from other numbers, within the printed rounding",
    "closed": "linked to other cells by equations that would show one unit of its leading digit",
    "repeated": "printed twice with the same value; nothing was computed",
    "erratum": "wrong in the report; the evidence has an id",
    "open": "doubtful; the report does not settle it",
    "measured": "a measured value that nothing in the report can test",
    "unexplained": "cannot be reproduced; cause unknown",
}

_HELD = ("derived", "closed", "repeated")

_MORE_DIGITS, _MOST_DECIMALS = 2, 12

_LEAST_FIXED, _MOST_FIXED = 1e-4, 1e9


@dataclass(frozen=True)
class _Row:
    """One cell as shown."""

    item: ReproducedItem
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
    errata: tuple[_TouchedErratum, ...]
    without_cell: tuple[str, ...]


def render_reproduction(reports: Mapping[ReportId, Sequence[ReproducedItem]]) -> str:
    """Every item of the reports as a page that opens from disk."""
    environment = Environment(
        autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    room = files("reduction.published")
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


def _report(report: ReportId, items: Sequence[ReproducedItem]) -> _Report:
    rows: dict[str, list[_Row]] = {}
    for item in items:
        cell = item.cell
        corrected = "" if cell.corrected is None else f"{cell.corrected:.12g}"
        wide = item.tolerance > 0.501 * printed_step(cell.printed) > 0
        row = _Row(
            item,
            corrected,
            number_beside(item.recomputed, cell.printed),
            f"{item.tolerance:.2g}" if wide and item.verdict in _HELD else "",
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
    """Title of a table by its printed number; equations, sections and parts have a name."""
    return table if table[0].islower() or table.startswith("App ") else f"Table {table}"


def number_beside(value: float, printed: str) -> str:
    """A recomputed number with two more digits than the printed one.

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
        # a rounding error that is negligible relative to the printed digits
        step = printed_step(printed)
        return "0" if abs(value) < 1e-9 * step else f"{value:.6g}"
    step = printed_step(printed)
    if step == 0:
        return f"{value:.6g}"
    decimals = min(max(_MORE_DIGITS - round(math.log10(step)), 0), _MOST_DECIMALS)
    return f"{value:,.{decimals}f}"
