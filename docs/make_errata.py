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

Errors in the five source reports, each with its evidence and with every printed number that it
affects, recomputed from other numbers of the report or from theory. A page with a wrong number may
still have a right conclusion.

*Sure*: **certain**, if the numbers of the report allow no other reading; **high**, if one reading
is by far the most likely; **open**, if the page is wrong or doubtful and the report does not settle
it; no entry, if the printed number is right but its description is wrong. In the tables,
*computed* is in the unit of the printed cell (in brackets if the cell has no number), and empty if
the error is in words or nothing can be computed; *from* says how it was computed. The verdicts are
explained in [printed numbers](printed-numbers.md).

## How to cite

An id is permanent and never reused. Link to `errata.md#` and the id in lower case, such as
`errata.md#cg-39`. In print: authors and title as in `CITATION.cff`, the version,
and the id, as "mooring-reduction 1.0.0, erratum CG-39". `reduction reproduce --erratum CG-39`
prints one entry, `reduction reproduce --json` all of them.
"""


def _plain(text: str) -> str:
    """Words of a page as Markdown that shows them as they are."""
    return re.sub(r"([\\`*_\[\]<>|$#~^])", r"\\\1", " ".join(text.split()))


def _with_unit(printed: str, unit: str) -> str:
    """A printed cell and its unit, unless the cell has it already; in brackets after words."""
    if unit in {"", "1"} or re.search(rf"(?<![A-Za-z]){re.escape(unit)}[a-z]*$", printed):
        return printed
    return f"{printed} {unit}" if re.search("[0-9]", printed) else f"{printed} [{unit}]"


def _row(item: ReproducedItem) -> str:
    cell = item.cell
    is_table = not cell.table.startswith(("sec", "eq", "abstract", "footnote"))
    shown = (
        f"Table {cell.table}" if is_table else cell.table,
        f"{cell.row}: {cell.column}",
        _with_unit(cell.printed, cell.unit),
        number_beside(item.recomputed, cell.printed),
        item.verdict.replace("_", " "),
        item.how,
    )
    return f"| {' | '.join(map(_plain, shown))} |"


def _entry(one: _TouchedErratum) -> list[str]:
    fault = one.erratum
    lines = [f"### {fault.id}", "", f"{_plain(fault.place).rstrip('.')}.", ""]
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
