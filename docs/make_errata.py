"""Write docs/errata.md from the printed numbers again: ``python docs/make_errata.py``."""

from __future__ import annotations

import re
from pathlib import Path

from reduction.published.printed_cells import ReportId
from reduction.published.reproduce_page import (
    TITLES,
    _TouchedErratum,
    number_beside,
    reproduce,
    touched_errata,
)
from reduction.published.reproduced_item import ReproducedItem

__all__ = ["errata"]

_HEAD = """\
# Errata of the reports

<!-- Written by docs/make_errata.py from reduction/published/data/; change it there. -->

Faults of the five reports on which this package rests, each with its evidence and with every
printed number that it touches, recomputed from other numbers of the page or from theory. A page
that prints a wrong number may still hold a right conclusion.

*Sure*: **certain**, where the page's own numbers leave no other reading; **high**, where one
reading is far the likeliest; **open**, where the page is wrong or doubtful and nothing says what
is right; no word, where the printed number stands and its meaning is at fault. In the tables
*computed* is in the printed unit, and empty where the fault is one of words or nothing can be
computed.

## How to cite

An id names one fault for good: it is not given to another one. Link to `errata.md#` and the id in
small letters, as `errata.md#cg-39`. In print: authors and title as in `CITATION.cff`, the version,
and the id, as "mooring-reduction 1.0.0, erratum CG-39". `reduction reproduce --erratum CG-39`
prints one entry, `reduction reproduce --json` all of them.
"""


def _plain(text: str) -> str:
    """Words of a page as Markdown that shows them as they are."""
    return re.sub(r"([\\`*_\[\]<>|$#~^])", r"\\\1", " ".join(text.split()))


def _row(item: ReproducedItem) -> str:
    cell = item.cell
    is_table = not cell.table.startswith(("sec", "eq", "abstract", "footnote"))
    unit = "" if cell.unit == "1" else cell.unit
    shown = (
        f"Table {cell.table}" if is_table else cell.table,
        f"{cell.row}: {cell.column}",
        f"{cell.printed} {unit}",
        number_beside(item.recomputed, cell.printed),
        item.verdict.replace("_", " "),
        item.how,
    )
    return f"| {' | '.join(map(_plain, shown))} |"


def _entry(one: _TouchedErratum) -> list[str]:
    fault = one.erratum
    lines = [f"### {fault.id}", "", f"{_plain(fault.place)}.", ""]
    lines += [f"- Printed: {_plain(fault.printed)}", f"- Right: {_plain(fault.corrected)}"]
    if fault.confidence:
        lines.append(f"- Sure: {fault.confidence}")
    lines += [f"- Evidence: {_plain(fault.evidence)}", ""]
    if one.items:
        lines += [
            "| place | cell | printed | computed | verdict | from |",
            "|---|---|---|---|---|---|",
        ]
        lines += [*map(_row, one.items), ""]
    return lines


def _section(report: ReportId, items: list[ReproducedItem]) -> list[str]:
    found = touched_errata(report, items)
    links = ", ".join(f"[{one.erratum.id}](#{one.erratum.id.lower()})" for one in found)
    lines = [
        f"## {report}",
        "",
        f"{_plain(TITLES[report])}.",
        "",
        f"{len(found)} entries: {links}.",
        "",
    ]
    for one in found:
        lines += _entry(one)
    return lines


def errata() -> str:
    """Text of docs/errata.md."""
    lines = [line for report, items in reproduce().items() for line in _section(report, items)]
    return f"{_HEAD}\n" + "\n".join(lines).rstrip() + "\n"


if __name__ == "__main__":
    Path(__file__).with_name("errata.md").write_text(errata(), encoding="utf-8", newline="\n")
