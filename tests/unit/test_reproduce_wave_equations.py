"""Equations of Zhang (2015): factors and powers are whole numbers, to the last bits."""

import pytest

from reduction.published.printed_cells import table_of
from reduction.published.zhang_2015 import _equation_answers

ANSWERS = _equation_answers()
SPEED = ("eq 14", "wave number k", "divisor of 2 pi")


@pytest.mark.parametrize(
    "key", [key for key in ANSWERS if key != SPEED], ids=lambda key: " ".join(key)
)
def test_answers_are_exact(key):
    cell = table_of("Zhang-2015", key[0])[key[1:]]
    assert ANSWERS[key].value == pytest.approx(cell.value, rel=1e-12)


def test_the_wave_number_is_that_of_the_length():
    # 5.6 m/s over 3.57 s; a period in its place would be off by 16 m
    assert ANSWERS[SPEED].value == pytest.approx(19.992, abs=1e-9)
    assert ANSWERS[SPEED].tolerance == pytest.approx(0.1785, abs=1e-4)
