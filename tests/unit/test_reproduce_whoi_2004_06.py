"""WHOI-2004-06 again: what comes back, what is wrong, and what cannot be known."""

from collections import Counter

import pytest

from reduction.published.printed_cells import table_of
from reduction.published.whoi_2004_06 import _equation_answers, items

ITEMS = items()
BY_KEY = {item.cell.key: item for item in ITEMS}


def counted(**where):
    return Counter(
        item.verdict
        for item in ITEMS
        if all(getattr(item.cell, name).startswith(text) for name, text in where.items())
    )


def test_nothing_is_unexplained_or_open():
    assert counted() == {"derived": 33, "erratum": 15, "measured": 21}


def test_misprints_of_the_equations():
    # (10) its number, (15) one of three powers, (20), (25) and both of (26)
    wrong = [item.cell.table for item in ITEMS if item.verdict == "erratum"]
    assert [table for table in wrong if table.startswith("eq")] == [
        "eq 10", "eq 15", "eq 20", "eq 25", "eq 26", "eq 26",
    ]  # fmt: skip
    assert counted(table="eq") == {"erratum": 6, "derived": 20}


@pytest.mark.parametrize(
    ("row", "percent", "cord"),
    [
        ("medium high stretching hose", "61.0 %", "3.30 %"),
        ("high stretching hose", "102.5 %", "5.65 %"),
    ],
)
def test_measured_stretches_are_possible_and_no_more(row, percent, cord):
    item = BY_KEY["sec 3.0", row, "maximum stretch"]
    assert item.verdict == "measured"
    assert percent in item.how and cord in item.how


def test_what_is_recomputed():
    fabric = "nylon tire cord fabric"
    right = {
        ("sec 1.1", fabric, "gap between cords over the cord diameter"): 0.3369,
        ("sec 1.2.1", "stretch hose", "neutral wrap angle"): 54.7356,
        ("footnote 1", fabric, "linear density"): 0.186667,
        ("sec 1.2.2", fabric, "breaking strength of the fabric"): 1020.0,
        ("sec 1.2.2", fabric, "number of plies"): 2.001,
    }
    for key, value in right.items():
        assert BY_KEY[key].recomputed == pytest.approx(value, rel=5e-4)


# equations of WHOI-2004-06: factors and powers are whole numbers, to the last bits

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
