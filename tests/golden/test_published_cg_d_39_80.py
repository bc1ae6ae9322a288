"""CG-D-39-80: the cells of the package against a second typing of the tables.

The files beside this one hold each table as printed, in wide form; what the second typing does
not hold, and why the two may differ, stands here.
"""

import csv
from fractions import Fraction
from pathlib import Path

from published_typings import faults_of_the_claims

from reduction.published.printed_cells import cells_of, errata_of, number_of

ROOM = Path(__file__).parent / "published" / "CG-D-39-80"
CELLS = {cell.key: cell for cell in cells_of("CG-D-39-80")}
# files whose columns belong to the quantity of the row
OF_QUANTITY = {
    "03_19_surfaces.csv", "06_07_quasi_static.csv", "08_09_strain.csv", "10_21_strength.csv",
    "a-2_screening.csv", "01_02_levels.csv",
}  # fmt: skip
# a second typing that put right the ranges it typed
RANGES = {
    f"{what} {end}" for what in ("mean_tension", "tension_amplitude") for end in ("low", "high")
}
# Table 16 prints one pair of ranges and not which line it is of; the second typing has it for
# all three columns, the package for the braid, whose levels it is
ONE_RANGE = "polyester | 8-strand plaited | 1/2 in | new"
# counts and words that only the package has: settings, symbols, heads, relative variability
ONLY_HERE = {
    "symbol", "unit", "power of ten", "number of lines", "change", "relative variability",
    "number of samples",
}  # fmt: skip


def column_of(file, row, name):
    quantity = row.get("quantity") or row.get("factor") or ""
    if file == "a-2_screening.csv" and name != "smallest significant effect":
        return f"{quantity} effect of {name}"
    if file == "20_abrasion.csv":
        return f"abrasion_cycles {name}"
    return f"{quantity} {name}" if file in OF_QUANTITY else name


def second_typing():
    for path in sorted(set(ROOM.glob("*.csv")) - {ROOM / "claims.csv"}):
        with path.open(encoding="utf-8") as lines:
            for row in csv.DictReader(lines):
                for name, text in row.items():
                    if name in ("table", "row", "quantity", "factor") or not text:
                        continue
                    yield path.name, row, name, text


def cell_of(row, column):
    """The cell, or that of all conditions of the line: a range is printed once for several."""
    key = (row["table"], row["row"], column)
    whole = (row["table"], row["row"].rpartition(" | ")[0] + " | all", column)
    return CELLS.get(key) or CELLS.get(whole)


TYPED = list(second_typing())


def test_every_number_of_the_second_typing_is_the_printed_one():
    different = []
    for file, row, name, text in TYPED:
        if name in RANGES and row["table"] == "16" and row["row"] == ONE_RANGE:
            continue
        if file == "10_21_strength.csv" and name == "number of samples":
            # one cell of the plaited polyester line is absent in the text
            if (row["row"], row["quantity"]) == (
                "polyester | 8-strand plaited | 1/2 in | 4 years", "tensile_strength",
            ):  # fmt: skip
                continue
        cell = cell_of(row, column_of(file, row, name))
        assert cell is not None, (file, row["table"], row["row"], name)
        corrected = name in RANGES and file == "03_19_surfaces.csv"
        printed = cell.corrected if corrected and cell.corrected is not None else None
        typed = float(Fraction(text)) if "/" in text else float(text)
        if "/" in cell.printed:
            assert cell.printed == text
        elif (number_of(cell.printed) if printed is None else printed) != typed:
            different.append((cell.key, cell.printed, text))
    assert different == []


def test_every_number_of_the_tables_is_typed_twice():
    seen = set()
    for file, row, name, _ in TYPED:
        cell = cell_of(row, column_of(file, row, name))
        if cell is not None:
            seen.add(cell.key)
    once = [
        cell for key, cell in CELLS.items()
        if key not in seen and not cell.table.startswith(("sec", "eq", "App", "abstract"))
    ]  # fmt: skip
    # frequencies are one pair a table; heads are words; the rest is counted here
    counted = {}
    for cell in once:
        kind = next((word for word in ONLY_HERE if cell.column.endswith(word)), None)
        if " frequency " in cell.column:
            kind = "frequency of a table"
        elif "power of mean_tension" in cell.column or cell.column.startswith("head"):
            kind = "head"
        elif cell.column.endswith((" low", " high")) and cell.table == "15":
            kind = "range without a column"
        elif cell.column.startswith("abrasion "):
            kind = "setting"
        counted[kind] = counted.get(kind, 0) + 1
    assert counted == {
        "symbol": 3, "frequency of a table": 24, "unit": 2, "power of ten": 2, "head": 8,
        "change": 4, "relative variability": 4, "setting": 3, "range without a column": 4,
    }  # fmt: skip


def test_claims_are_those_of_a_second_typing():
    of_text = ("sec", "eq", "App", "abstract")
    assert faults_of_the_claims("CG-D-39-80", lambda table: table.startswith(of_text)) == {}


def test_a_doubted_cell_says_why():
    known = {erratum.id for erratum in errata_of("CG-D-39-80")}
    for cell in CELLS.values():
        assert not cell.erratum or cell.erratum in known, cell
        sure = cell.erratum and cell.confidence in ("certain", "high")
        assert cell.corrected is None or sure, cell
        says = cell.note and cell.erratum and cell.corrected is None
        assert cell.confidence != "open" or says, cell
        assert not cell.confidence or cell.erratum, cell


def test_every_erratum_has_evidence_and_a_cell():
    errata = errata_of("CG-D-39-80")
    used = {cell.erratum for cell in CELLS.values()}
    assert [erratum.id for erratum in errata] == [f"CG-{i}" for i in range(1, len(errata) + 1)]
    assert all(one.evidence and one.place and one.corrected and one.confidence for one in errata)
    assert {one.id for one in errata} <= used
