"""Zhang (2015): the cells of the package against a second typing of the paper."""

import csv
from pathlib import Path

from published_typings import cells_in_order, faults_of_the_data, typed_in_order

from reduction.published.printed_cells import cells_of, errata_of

REPORT = "Zhang-2015"
TABLE_7 = Path(__file__).parent / "zhang_2015_table_7.csv"
OF_COLUMN = {
    "classic": "load F0",
    "": "load F1",
    "difference": "difference F2",
    "percent": "ratio P",
}


def test_both_typings_agree():
    assert cells_in_order(REPORT) == typed_in_order(REPORT)


def test_the_data_keep_their_rules():
    assert faults_of_the_data(REPORT) == {}


def test_table_7_cell_by_cell_against_a_third_typing():
    cells = {cell.key: cell.printed for cell in cells_of(REPORT) if cell.table == "7"}
    with TABLE_7.open(encoding="utf-8") as lines:
        for row in csv.DictReader(line for line in lines if not line.startswith("#")):
            place = f"{row.pop('theory')} theory, t = {row.pop('time')} s"
            for name, text in row.items():
                direction, _, rest = name.partition("_")
                assert cells.pop(("7", place, f"{direction} {OF_COLUMN[rest]}")) == text
    assert cells == {}


def test_corrected_ratios_and_differences_follow_from_the_corrected_loads():
    cells = {(c.row, c.column): c for c in cells_of(REPORT) if c.table == "7"}
    rows = {row for row, _ in cells if row.startswith("Airy")}
    for row in rows:
        classic, improved, difference, ratio = (
            cells[row, f"vertical {name}"].value
            for name in ("load F0", "load F1", "difference F2", "ratio P")
        )
        assert abs(classic - improved - difference) <= 0.015 + 1e-9
        rounding = 0.005 + 100 * 0.005 * (1 + abs(improved / classic)) / abs(classic)
        assert abs(100 * (classic - improved) / classic - ratio) <= rounding


def test_what_is_open_has_no_value():
    found = {(c.table, c.column) for c in cells_of(REPORT) if c.confidence == "open"}
    assert found == {("1", "steepness H/L, from"), ("4", "wave_period T")}
    assert all(c.value is None for c in cells_of(REPORT) if c.confidence == "open")


def test_errata_are_numbered_in_order():
    assert [one.id for one in errata_of(REPORT)] == [f"ZH-{n}" for n in range(1, 12)]
