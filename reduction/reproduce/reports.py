"""All five reports again: items, counts, and errata with the cells that they touch."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import get_args

from reduction.published.cell import Erratum, ReportId
from reduction.published.read import REPORTS, errata_of
from reduction.reproduce import cg_d_39_80, wang_2022, whoi_2004_06, whoi_2005_10, zhang_2015
from reduction.reproduce.item import Item, Verdict

VERDICTS: tuple[Verdict, ...] = get_args(Verdict)

Counts = dict[str, int]
"""``cells``, then one number a verdict."""

_ITEMS: Mapping[ReportId, Callable[[], list[Item]]] = {
    "WHOI-2004-06": whoi_2004_06.items,
    "Zhang-2015": zhang_2015.items,
    "WHOI-2005-10": whoi_2005_10.items,
    "CG-D-39-80": cg_d_39_80.items,
    "Wang-2022": wang_2022.items,
}
_COLUMNS = (
    "report", "table", "row", "column", "printed", "unit", "corrected", "recomputed", "tolerance",
    "verdict", "erratum", "confidence", "how", "page", "note",
)  # fmt: skip


def reproduce(report: ReportId | None = None) -> dict[ReportId, list[Item]]:
    """Recompute every printed number of a report, or of all.

    Parameters
    ----------
    report : ReportId, optional
        Which of the five; all where nothing is said.

    Returns
    -------
    items : dict of ReportId to list of Item
        In the order of the tables.
    """
    return {one: _ITEMS[one]() for one in (REPORTS if report is None else (report,))}


def counts_of(items: Iterable[Item]) -> Counts:
    """How many cells there are, and how many of each verdict.

    Parameters
    ----------
    items : iterable of Item
        Of a table, a report or all.

    Returns
    -------
    counts : dict of str to int
        ``cells``, then each of `VERDICTS`.
    """
    counts = dict.fromkeys(("cells", *VERDICTS), 0)
    for item in items:
        counts["cells"] += 1
        counts[item.verdict] += 1
    return counts


def counts_by_table(items: Iterable[Item]) -> dict[str, Counts]:
    """Counts of each table, in the order in which the tables come.

    Parameters
    ----------
    items : iterable of Item
        Of one report.

    Returns
    -------
    counts : dict of str to dict of str to int
        By table, or section of a claim.
    """
    tables: dict[str, list[Item]] = {}
    for item in items:
        tables.setdefault(item.cell.table, []).append(item)
    return {table: counts_of(own) for table, own in tables.items()}


@dataclass(frozen=True)
class TouchedErratum:
    """A fault of a page, and the items whose cells name it."""

    erratum: Erratum
    items: tuple[Item, ...]


def touched_errata(report: ReportId, items: Iterable[Item]) -> list[TouchedErratum]:
    """Every known fault of a report with its cells.

    Parameters
    ----------
    report : ReportId
        Which of the five.
    items : iterable of Item
        Of this report.

    Returns
    -------
    errata : list of TouchedErratum
        In the order of their ids.
    """
    by_id: dict[str, list[Item]] = {}
    for item in items:
        by_id.setdefault(item.cell.erratum, []).append(item)
    return [TouchedErratum(one, tuple(by_id.get(one.id, ()))) for one in errata_of(report)]


def csv_of(items: Iterable[Item]) -> str:
    """Items as a table, a line a cell.

    Parameters
    ----------
    items : iterable of Item
        Of one report or of several.

    Returns
    -------
    text : str
        CSV; what is not known is empty.
    """
    text = io.StringIO()
    writer = csv.writer(text)
    writer.writerow(_COLUMNS)
    for item in items:
        own = {
            "recomputed": item.recomputed, "tolerance": item.tolerance, "verdict": item.verdict,
            "how": item.how,
        }  # fmt: skip
        values = (own[name] if name in own else getattr(item.cell, name) for name in _COLUMNS)
        writer.writerow(_written(value) for value in values)
    return text.getvalue()


def _written(value: object) -> str:
    if value is None or (isinstance(value, float) and not math.isfinite(value)):
        return ""
    return repr(float(value)) if isinstance(value, float) else str(value)
