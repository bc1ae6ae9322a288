"""The modulus at round strains: read between bins, from one test alone, never beyond it."""

import numpy as np
import pytest
import xarray as xr

from reduction.report.test_section import design_tables
from reduction.report.test_view import TestView
from reduction.report.text_style import NOT_GIVEN


def make_view(test, bins, ascending, descending, *, units="si", specimen="new", half=0.01e6):
    """A test of one specimen; moduli in MPa, the standard uncertainty of every bin the same.

    Ten cycles reach every bin: what is shown is 2.262 times as much.
    """
    modulus = 1e6 * np.array([[ascending, descending]], dtype=np.float64)
    dims = ("specimen", "branch_name", "strain_bin")
    data = xr.Dataset(
        {
            "tangent_modulus": (dims, modulus),
            "tangent_modulus_standard_uncertainty": (dims, np.full(modulus.shape, half)),
            "tangent_modulus_count": (dims, np.full(modulus.shape, 10)),
        },
        coords={
            "specimen": [specimen],
            "branch_name": ["ascending", "descending"],
            "strain_bin": np.asarray(bins, dtype=np.float64),
        },
        attrs={"test": test},
    )
    return TestView(test, data, units)


def cells(table):
    return [[cell.text for cell in row] for row in table.rows]


def test_a_value_between_two_bins_is_on_the_straight_line_between_them():
    # 100 % is three quarters of the way from 0.97 to 1.01
    bins = [0.89, 0.93, 0.97, 1.01]
    (table,) = design_tables([make_view("T-1", bins, [1, 1, 1, 1.4], [2, 2, 2, 2.8])])
    assert table.columns == ("strain [%]", "T-1 [MPa]")
    assert cells(table) == [["100", "1.30 ± 0.02 /\n2.60 ± 0.02"]]
    assert [float(one) for one in table.rows[0][1].value.split()] == pytest.approx([1.3e6, 2.6e6])


def test_nothing_is_extrapolated_and_no_gap_is_bridged():
    bins = np.arange(0.76, 1.265, 0.02)
    rising = np.linspace(1, 2, bins.size)
    gap = np.where(np.abs(bins - 1.0) < 0.03, np.nan, rising)
    (table,) = design_tables([make_view("T-1", bins, gap, rising)])
    # 75 % is below the first bin; 125 % lies between the last two; 100 % is in the gap of one
    assert [row[0] for row in cells(table)] == ["100", "125"]
    assert cells(table)[0][1].startswith(f"{NOT_GIVEN} /\n1.4")
    assert table.rows[0][1].value.startswith("nan ")


def test_a_test_that_reaches_no_round_strain_has_no_column_and_a_strain_not_reached_a_dash():
    low = make_view("T-1", [0.74, 0.76], [1, 1], [1, 1])
    high = make_view("T-3", [1.49, 1.51], [3, 3], [3, 3])
    between = make_view("T-2", [1.10, 1.12], [2, 2], [2, 2])
    (table,) = design_tables([low, between, high])
    assert table.columns == ("strain [%]", "T-1 [MPa]", "T-3 [MPa]")
    assert [row[0] for row in cells(table)] == ["75", "150"]
    assert [row[2].text for row in table.rows] == [NOT_GIVEN, "3.00 ± 0.02 /\n3.00 ± 0.02"]
    assert table.rows[0][2].is_number


def test_each_specimen_has_a_table_and_each_table_says_what_the_plus_minus_is():
    views = [
        make_view("T-1", [0.74, 0.76], [1, 1], [1, 1]),
        make_view("T-2", [0.74, 0.76], [1, 1], [1, 1], specimen="used"),
    ]
    tables = design_tables(views)
    assert [table.caption.split(":")[0] for table in tables] == ["new", "used"]
    for table in tables:
        assert table.remarks == (
            "±: expanded uncertainty, 95 % (k = 2.26): scatter between cycles, noise, regression. No"
            " instrument errors are stated: the uncertainty includes only scatter.",
        )


def test_in_us_units_the_modulus_is_in_psi():
    (table,) = design_tables(
        [make_view("T-1", [0.74, 0.76], [1, 1], [1, 1], units="us", half=np.nan)]
    )
    # 1 MPa is 145.04 psi
    assert table.columns[1] == "T-1 [psi]"
    assert cells(table) == [["75", "145.0 /\n145.0"]]


def test_a_stiff_specimen_is_read_at_finer_strains():
    bins = np.arange(0.0005, 0.025, 0.001)
    (table,) = design_tables([make_view("rope", bins, 100 + bins, 100 + bins)])
    assert [row[0] for row in cells(table)] == ["1", "2"]


def test_a_test_of_one_bin_is_read_at_that_bin_alone():
    (table,) = design_tables([make_view("T-1", [1.0], [2.0], [3.0])])
    assert cells(table) == [["100", "2.00 ± 0.02 /\n3.00 ± 0.02"]]
    assert not design_tables([make_view("T-1", [1.004], [2.0], [3.0])])


def test_without_a_modulus_there_is_no_table():
    assert design_tables([]) == []
    assert design_tables([make_view("T-1", [], [], [])]) == []
