"""Second typings of printed numbers.

``in_order.csv``: one line a table, its numbers in the order of the page. ``claims.csv``: one line a
claim of the text, its number in the words around it, and the cell of the package that it is; years
of exposure, loads at which a curve is entered and what was seen on one sample are no claims.
"""

import csv
from pathlib import Path

from csvrows import csv_rows

from reduction.published.printed_cells import cells_of, errata_of, number_of

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


IN_WORDS = {
    "one": 1, "two": 2, "twice": 2, "three": 3, "four": 4, "five": 5, "six": 6, "nine": 9,
    "twelve": 12, "two samples each": 2, r"-\frac{1}{2}": -0.5,
}  # fmt: skip
WORDS_OF_THE_PAGE = {
    "no factor": "none",
    "mean_tension": "mean load",
    "diameter": "line diameter",
    "mean_tension, diameter": "mean load and diameter",
    "mean_tension, tension_amplitude, diameter": "mean load, load amplitude, and line diameter",
    "approximately doubled": "doubled",
    "½ million": "½",
}


def said(text):
    """Number of a printed text, in digits or in words; the text where there is none."""
    plain = WORDS_OF_THE_PAGE.get(text, text).lower().removesuffix(" feet").removesuffix("-inch")
    number = IN_WORDS.get(plain, number_of(plain))
    return plain if number is None else number


def claims_typed(report):
    """Rows of the second typing of the claims of the text."""
    return csv_rows(ROOM / report / "claims.csv")


def faults_of_the_claims(report, of_text):
    """Claims typed once only, and claims whose two typings differ.

    ``of_text`` says which tables are sections of the text.
    """
    printed = {cell.key: cell.printed for cell in cells_of(report) if of_text(cell.table)}
    rows = claims_typed(report)
    again = {(row["table"], row["row"], row["column"]): row["printed"] for row in rows}
    found = {
        "typed twice in the second typing": len(rows) - len(again),
        "in the package alone": sorted(printed.keys() - again.keys()),
        "in the second typing alone": sorted(again.keys() - printed.keys()),
        "other words around it": [
            row["quote"] for row in rows
            if not all(part in row["quote"] for part in _parts(row["printed"]))
        ],
        "different": [
            (key, printed[key], text) for key, text in again.items()
            if key in printed and said(printed[key]) != said(text)
        ],
    }  # fmt: skip
    return {fault: cells for fault, cells in found.items() if cells}


def _parts(text):
    """A list of symbols stands in the page with others between them."""
    return text.split(", ") if text.startswith("f, ") else [text]
