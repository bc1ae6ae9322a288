"""Numbers as a reader sees them, and as the archive has them."""

import numpy as np
import pytest

from reduction.report.text_style import (
    NOT_GIVEN,
    Shown,
    count,
    make_table,
    measured,
    number,
    span,
    with_interval,
    words,
)

MPA = Shown("MPa", 1e-6)


@pytest.mark.parametrize(
    ("value", "uncertainty", "text"),
    [
        (1.23456e6, 1.2e4, "1.235 ± 0.012"),
        (1.23456e6, 9.96e4, "1.235 ± 0.100"),
        (1234.5e6, 12e6, "1,234 ± 12"),
        (1.0e6, 0.0, "1.000"),
        (1.0e6, float("nan"), "1.000"),
        (float("nan"), 1.0, NOT_GIVEN),
        (-3.0e5, 2.0e3, "-0.3000 ± 0.0020"),
        (1.0e6, 1e-6, "1 ± 1e-12"),
        (-1.0e2, 5.0e4, "0.000 ± 0.050"),
        (2.6e-11, 3.0e-11, "0"),
        (1.5e-7, 2.5e-6, "1.5e-13 ± 2.5e-12"),
    ],
)
def test_a_value_ends_where_its_uncertainty_does(value, uncertainty, text):
    assert measured(value, uncertainty, MPA).text == text


def test_the_value_of_the_archive_stands_beside_what_is_shown():
    assert float(measured(1234567.891, 1e4, MPA).value) == 1234567.891
    assert float(number(1234567.891, MPA).value) == 1234567.891


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (12.0, "12.00"),
        (123456.0, "123,456"),
        (1e-7, "1.000e-07"),
        (2e12, "2.000e+12"),
        (2.6e-17, "0"),
        (-2.2e-14, "0"),
    ],
)
def test_numbers_are_written_out_where_they_can_be_read(value, text):
    assert number(value).text == text


def test_counts_have_no_decimals():
    assert (count(2998.0).text, count(2998.0).value) == ("2,998", "2998")
    assert count(float("nan")).text == NOT_GIVEN


def test_a_range_has_both_ends_to_the_same_place():
    assert span(0.806, 0.9437, Shown("%", 100.0), places=1).text == "80.6 to 94.4"
    assert span(-1e-9, 0.5, Shown("%", 100.0), places=1).text == "0.0 to 50.0"
    assert span(np.nan, 1.0, MPA, places=1).text == NOT_GIVEN


def test_numbers_stand_in_a_column_of_their_own_and_nothing_is_a_dash():
    rows = [[words("a"), number(1.0)]]
    assert make_table("Caption.", ("a", "b"), rows).number_columns == (False, True)
    assert words("").text == NOT_GIVEN


def test_what_is_missing_stands_flush_right_in_a_column_of_numbers():
    rows = [[words("a"), number(1.0), words("")], [words(""), words(""), words("b")]]
    table = make_table("Caption.", ("name", "value", "remark"), rows)
    assert [cell.is_number for cell in table.rows[1]] == [False, True, False]
    assert not table.rows[0][2].is_number


def test_digits_before_the_point_of_which_nothing_is_known_are_zeros():
    assert measured(50052.3, 376.4).text == "50,050 ± 380"
    assert measured(-16897.0, 1152.0).text == "-16,900 ± 1,200"
    assert measured(299.6, 37.0, is_short=True).text == "300 ± 40"
    assert measured(40.0, 5000.0).text == "0 ± 5,000"


def test_a_value_and_its_interval_have_the_same_places():
    shown = [cell.text for cell in with_interval(4.9996, 4.633, 5.3663, Shown("s", 1.0))]
    assert shown == ["5.00", "4.63 to 5.37"]
    value, interval = with_interval(2.0, float("nan"), 3.0, Shown("s", 1.0))
    assert (value.text, interval.text) == ("2.000", NOT_GIVEN)


def test_ends_of_a_narrow_range_are_told_apart():
    percent = Shown("%", 100.0)
    assert span(0.75, 1.25, percent, places=0).text == "75 to 125"
    assert span(0.0757, 0.0984, percent, places=0).text == "7.6 to 9.8"
    # cycles of a wire rope
    assert span(0.00213, 0.00387, percent, places=0).text == "0.21 to 0.39"
    assert span(0.5, 0.5, percent, places=1).text == "50.0 to 50.0"
