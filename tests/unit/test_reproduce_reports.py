"""All reports again: the counts, the errata with their cells, the table of items."""

import csv
import io
from dataclasses import replace

import pytest
from reproduced import whole

from reduction.published.printed_cells import REPORTS, cells_of, errata_of
from reduction.published.reproduce_page import (
    VERDICTS,
    counts_by_table,
    counts_of,
    csv_of,
    reproduce,
    touched_errata,
)
from reduction.published.reproduced_item import ReproducedItem


def test_all_five_reports_are_there_with_every_cell():
    assert tuple(whole()) == REPORTS
    for report, items in whole().items():
        assert {item.cell for item in items} == set(cells_of(report))
        assert len(items) == len(cells_of(report))


def test_one_report_alone():
    (found,) = reproduce("Wang-2022").items()
    assert found[0] == "Wang-2022"
    assert [(one.cell, one.verdict) for one in found[1]] == [
        (one.cell, one.verdict) for one in whole()["Wang-2022"]
    ]


@pytest.mark.parametrize("report", REPORTS)
def test_no_cell_is_unexplained(report):
    assert [one.cell.key for one in whole()[report] if one.verdict == "unexplained"] == []


@pytest.mark.parametrize("report", REPORTS)
def test_counts_add_up(report):
    counts = counts_of(whole()[report])
    assert list(counts) == ["cells", *VERDICTS]
    assert counts["cells"] == len(cells_of(report)) == sum(counts[one] for one in VERDICTS)
    tables = counts_by_table(whole()[report])
    assert {name: sum(one[name] for one in tables.values()) for name in counts} == counts


@pytest.mark.parametrize("report", REPORTS)
def test_touched_errata_hold_every_cell_that_names_them(report):
    found = touched_errata(report, whole()[report])
    assert [one.erratum for one in found] == list(errata_of(report))
    named = [item for item in whole()[report] if item.cell.erratum]
    assert sum(len(one.items) for one in found) == len(named)
    assert all(item.cell.erratum == one.erratum.id for one in found for item in one.items)


@pytest.mark.parametrize("report", REPORTS)
def test_a_wrong_cell_says_which_erratum_and_each_item_says_how(report):
    for item in whole()[report]:
        assert item.how
        assert item.cell.erratum or item.verdict != "erratum"


def test_the_table_of_items_gives_every_number_back():
    items = [item for one in whole().values() for item in one]
    rows = list(csv.DictReader(io.StringIO(csv_of(items))))
    assert len(rows) == len(items)
    for row, item in zip(rows, items, strict=True):
        assert row["printed"] == item.cell.printed and row["verdict"] == item.verdict
        assert (row["recomputed"] == "") == (item.recomputed != item.recomputed)
        if row["recomputed"]:
            assert float(row["recomputed"]) == item.recomputed
        corrected = item.cell.corrected
        assert row["corrected"] == ("" if corrected is None else repr(corrected))


def test_the_table_keeps_commas_and_lines_within_a_cell():
    cell = replace(cells_of("Wang-2022")[0], note='two, "three"\nfour')
    (row,) = csv.DictReader(
        io.StringIO(csv_of([ReproducedItem(cell, float("inf"), "open", "so, so")]))
    )
    assert (row["note"], row["how"], row["recomputed"]) == ('two, "three"\nfour', "so, so", "")
