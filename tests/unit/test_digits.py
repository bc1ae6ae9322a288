"""Numbers without a power of ten, which end where their uncertainty does."""

import re

import numpy as np
import pytest

from reduction.cli.printed_numbers import as_given, short, within
from reduction.cli.usage import grouped
from reduction.quantities.digits import fixed_number, places_of, places_within, plain_number

RNG = np.random.default_rng(31)


def test_no_number_between_a_thousandth_and_ten_millions_has_a_power_of_ten():
    for value in 10 ** RNG.uniform(-3, np.log10(9_999_400), 2000) * RNG.choice([-1, 1], 2000):
        text = plain_number(value, 5)
        assert re.fullmatch(r"-?\d+(\.\d+)?", text), text
        assert float(text) == pytest.approx(value, rel=5.1e-5)


@pytest.mark.parametrize(
    ("value", "digits", "text"),
    [
        (280991.3, 5, "280990"),
        (123455.0, 5, "123460"),  # a half to the even digit, as the format has it
        (6361.4, 3, "6360"),
        (99999.7, 5, "100000"),
        (9_999_960.0, 5, "1e+07"),
        (-975440.0, 5, "-975440"),
        (0.000123, 2, "0.00012"),
        (0.0, 5, "0"),
        (1.25e-8, 3, "1.25e-08"),
    ],
)
def test_digits_that_a_number_has_not_are_zeros(value, digits, text):
    assert plain_number(value, digits) == text


@pytest.mark.parametrize(
    ("value", "places", "text"),
    [
        (250.0, -2, "200"),
        (350.0, -2, "400"),
        (-49.0, -2, "0"),
        (1234567.0, -3, "1,235,000"),
        (2.675, 2, "2.67"),  # the number that is stored is just below
    ],
)
def test_a_place_before_the_point_is_rounded_as_one_behind_it(value, places, text):
    assert fixed_number(value, places) == text


@pytest.mark.parametrize(("value", "place"), [(999.9999999999999, 0), (1000.0, -1), (0.0, 0)])
def test_the_place_of_a_digit_is_right_beside_a_power_of_ten(value, place):
    assert places_of(value, 3) == place


@pytest.mark.parametrize(
    ("value", "halves", "text"),
    [
        (280991.3, (2100.0,), "281000"),
        (280991.3, (9000.0, 2100.0), "281000"),
        (280991.3, (np.nan, np.nan), "280990"),
        (280991.3, (0.0,), "280990"),
        (0.0123456, (0.00021,), "0.01235"),
        (3.21, (500.0,), "3.2"),
        (-3.0, (5000.0,), "-3.0"),
        (1.5, (1e-12,), "1.500000"),
        (2.80991e7, (2.1e5,), "28100000"),
        (2.80991e12, (2.1e5,), "2.8099e+12"),
        (np.nan, (1.0,), "-"),
    ],
)
def test_a_value_ends_where_the_narrowest_of_its_intervals_does(value, halves, text):
    assert within(value, *halves) == text


def test_a_value_and_its_rounding_are_apart_by_a_twentieth_of_the_half_width_at_most():
    values, halves = 10 ** RNG.uniform(-2, 6, 1000), 10 ** RNG.uniform(-3, 6, 1000)
    for value, half in zip(values, halves, strict=True):
        places = places_within(value, half)
        assert abs(round(value, places) - value) <= max(0.05 * half, 5e-7 * value) * (1 + 1e-9)


def test_a_level_keeps_what_was_typed_before_the_point():
    assert (as_given(123456.7), as_given(29892.34), as_given(2e8)) == ("123457", "29892", "2e+08")


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("99999", "99999"),
        ("-123456.5", "-123 456.5"),
        ("98000 to 1283100", "98000 to 1 283 100"),
        ("0.0001234567", "0.0001234567"),
        ("1.234567e+08", "1.234567e+08"),
        ("T-123456", "T-123456"),
        ("2026-11-22 123456", "2026-11-22 123456"),
        ("-", "-"),
    ],
)
def test_thousands_are_parted_in_numbers_alone(text, shown):
    assert grouped(text) == shown


def test_what_is_not_finite_is_a_dash():
    assert (short(np.nan), within(np.inf, 1.0)) == ("-", "-")
