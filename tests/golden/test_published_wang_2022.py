"""Wang (2022): the cells of the package against a second typing of the paper."""

from published_typings import cells_in_order, faults_of_the_data, typed_in_order

from reduction.published.printed_cells import errata_of, table_of

REPORT = "Wang-2022"


def test_both_typings_agree():
    assert cells_in_order(REPORT) == typed_in_order(REPORT)


def test_the_data_keep_their_rules():
    assert faults_of_the_data(REPORT) == {}


def test_the_steel():
    cells = table_of(REPORT, "1")
    assert [cell.value for cell in cells.values()] == [210_000.0, 0.3, 7800.0]


def test_errata_are_numbered_in_order():
    assert [one.id for one in errata_of(REPORT)] == [f"WA-{n}" for n in range(1, 17)]
