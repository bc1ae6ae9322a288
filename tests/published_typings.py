"""Second typings of printed numbers: one line a table, its numbers in the order of the page."""

import csv
from pathlib import Path

from reduction.published.read import cells_of, errata_of

ROOM = Path(__file__).parent / "golden" / "published"


def typed_in_order(report):
    """Printed texts of each table, typed a second time."""
    with (ROOM / report / "in_order.csv").open(encoding="utf-8") as lines:
        rows = list(csv.reader(lines))[1:]
    return {table: printed for table, *printed in rows}


def cells_in_order(report):
    """Printed texts of each table of the package."""
    tables = {}
    for cell in cells_of(report):
        tables.setdefault(cell.table, []).append(cell.printed)
    return tables


def faults_of_the_data(report):
    """What every table of printed numbers has to keep, and does not."""
    cells, errata = cells_of(report), errata_of(report)
    known = {one.id for one in errata}
    used = {cell.erratum for cell in cells}
    rules = {
        "an erratum that nobody knows": [
            c.key for c in cells if c.erratum and c.erratum not in known
        ],
        "an erratum without a cell": sorted(known - used),
        "corrected without an erratum": [
            c.key for c in cells if c.corrected is not None and not c.erratum
        ],
        "open without a note": [c.key for c in cells if c.confidence == "open" and not c.note],
        "open and corrected": [
            c.key for c in cells if c.confidence == "open" and c.corrected is not None
        ],
        "corrected, and nobody knows how sure": [
            c.key for c in cells if c.corrected is not None and not c.confidence
        ],
        "an erratum of two ids": sorted(known) if len(known) < len(errata) else [],
        "an erratum without evidence": [e.id for e in errata if not (e.evidence and e.confidence)],
        "a cell without its place": [c.key for c in cells if not (c.page and c.unit)],
    }
    return {rule: found for rule, found in rules.items() if found}
