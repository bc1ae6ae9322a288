"""About, below, over and in words: how near a number is meant to be, and which it is."""

import pytest

from reduction.published.printed_cells import Cell
from reduction.published.reproduced_item import (
    judge_as,
    judge_limit,
    judge_round,
    judge_word,
    last_counted_place,
)


def cell(printed, **known):
    plain = {
        "report": "WHOI-2005-10", "table": "sec 6.0", "row": "a", "column": "b", "unit": "psi",
        "corrected": None, "erratum": "", "confidence": "", "page": "", "note": "",
    }  # fmt: skip
    return Cell(printed=printed, **(plain | known))


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("350", 10),
        ("500", 100),
        ("123", 1),
        ("10,000", 10_000),
        ("1.50", 0.1),
        ("0", 0),
        ("n/a", 0),
    ],
)
def test_last_digit_that_is_not_zero(text, place):
    assert last_counted_place(text) == pytest.approx(place)


@pytest.mark.parametrize(("value", "verdict"), [(115, "derived"), (116, "unexplained")])
def test_a_round_number_covers_half_its_last_counted_digit(value, verdict):
    item = judge_round(cell("110"), value, "from a table")
    assert item.verdict == verdict and item.how == "from a table; round to 10"


def test_a_limit_holds_on_its_own_side_only():
    assert judge_limit(cell("below 100"), 48.0, "x", is_upper=True).verdict == "derived"
    assert judge_limit(cell("below 100"), 120.0, "x", is_upper=True).verdict == "unexplained"
    assert judge_limit(cell("over 200"), 212.0, "x", is_upper=False).verdict == "derived"
    assert judge_limit(cell("over 200"), 180.0, "x", is_upper=False).verdict == "unexplained"


def test_a_limit_that_is_known_to_be_wrong_is_an_erratum():
    wrong = cell("less than 200", corrected=212.0, erratum="WH5-18", confidence="certain")
    assert judge_limit(wrong, 212.0, "x", is_upper=True).verdict == "erratum"
    assert judge_limit(wrong, 230.0, "x", is_upper=True).verdict == "unexplained"


def test_a_text_without_a_number_is_no_limit():
    assert judge_limit(cell("near zero"), 52.0, "x", is_upper=True).verdict == "unexplained"


@pytest.mark.parametrize(
    ("words", "value", "step", "verdict"),
    [
        ("twice", 2.05, 1.0, "derived"),
        ("twice", 2.51, 1.0, "unexplained"),
        ("two samples each", 2.0, 1.0, "derived"),
        ("Three minutes", 3.0, 1.0, "derived"),
        ("one-and-a-half", 1.67, 0.5, "derived"),
        ("one-and-a-half", 1.76, 0.5, "unexplained"),
        ("twice", 1.67, 0.5, "unexplained"),
        ("stiffer", 2.0, 1.0, "unexplained"),
    ],
)
def test_a_number_in_words_is_held_in_the_steps_in_which_it_is_said(words, value, step, verdict):
    item = judge_word(cell(words), value, "from a table", step=step)
    assert (item.verdict, item.recomputed, item.cell.printed) == (verdict, value, words)


def test_another_writing_of_a_number_is_judged_by_its_own_digits():
    power = cell("10^{-4}", corrected=4.0, erratum="CG-7", confidence="certain")
    assert judge_as(power, "-4", -4.0, "x").verdict == "derived"
    assert judge_as(power, "-4", 4.0, "x").verdict == "erratum"
    assert judge_as(power, "-4", 3.0, "x").verdict == "unexplained"
    assert judge_as(power, "-4", 4.0, "x").cell is power
