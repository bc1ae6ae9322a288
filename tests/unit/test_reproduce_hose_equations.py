"""Equations of WHOI-2004-06: factors and powers are whole numbers, to the last bits."""

import pytest

from reduction.published.printed_cells import table_of
from reduction.published.whoi_2004_06 import _equation_answers

ANSWERS = _equation_answers()
REPORT = "WHOI-2004-06"


@pytest.mark.parametrize("key", ANSWERS, ids=lambda key: " ".join(key))
def test_answers_are_exact(key):
    cell = table_of(REPORT, key[0])[key[1:]]
    within = 1e-2 if key[0] == "sec 1.2.1" else 2e-8
    assert ANSWERS[key].value == pytest.approx(cell.value, abs=within)


@pytest.mark.parametrize(
    ("table", "column", "right"),
    [
        ("eq 20", "exponent of cord stretch ratio", 0.0),
        ("eq 25", "power of wrap diameter and spacing in the divisor", 1.0),
        ("eq 26", "over Ar Er at rest", 0.0),
        ("eq 26", "area over that inside the cords, pi dw^2 / 4 of the stretched hose", 1.0),
        ("eq 10", "equation number", 9.0),
    ],
)
def test_what_is_right_where_the_page_is_wrong(table, column, right):
    (answer,) = [one for key, one in ANSWERS.items() if key[0] == table and key[2] == column]
    assert answer.value == pytest.approx(right, abs=1e-9)


def test_the_stated_bore_would_be_another_area():
    # 2.5 in at rest, its volume kept, over 3.5 in between the cords
    (answer,) = [one for key, one in ANSWERS.items() if key[1] == "end cap"]
    assert abs(answer.value - (2.5 / 3.5) ** 2) > 0.4
