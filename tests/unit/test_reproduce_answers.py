"""Answers become items: one for every cell, and none without a cell."""

import math
from dataclasses import replace

import pytest
from misprinted import misprint

from reduction.published.printed_cells import cells_of
from reduction.published.reproduced_item import Answer, item_of, items_from
from reduction.record.errors import DataError

CELL = cells_of("Wang-2022")[0]


def item(printed, answer, **other):
    cell = replace(CELL, printed=printed, **other)
    return item_of(cell, {cell.key: answer})


@pytest.mark.parametrize(
    ("printed", "value", "verdict"),
    [
        ("2.50", 2.5049, "derived"),
        ("2.50", 2.5051, "unexplained"),
        ("-1/2", -0.5 + 1e-12, "derived"),
        ("1/2", 0.5001, "unexplained"),
        ("about 30 lbs", 30.4, "derived"),
    ],
)
def test_half_of_the_last_printed_digit_and_a_fraction_is_exact(printed, value, verdict):
    assert item(printed, Answer(value, "so")).verdict == verdict


def test_a_tolerance_of_the_inputs_is_kept():
    assert item("9000", Answer(9003.2, "so", tolerance=4.8)).verdict == "derived"
    assert item("9000", Answer(9005.2, "so", tolerance=4.8)).verdict == "unexplained"


@pytest.mark.parametrize(
    ("bound", "value", "verdict"),
    [
        ("below", 0.05, "derived"),
        ("below", 2.6, "unexplained"),
        ("above", 2.6, "derived"),
        ("above", 1.4, "unexplained"),
    ],
)
def test_a_limit_holds_or_not(bound, value, verdict):
    assert item("less than 2%", Answer(value, "so", bound=bound)).verdict == verdict


def test_words_are_judged_by_the_digits_of_what_is_right():
    answer = Answer(0.34202, "sine")
    wrong = {"corrected": 0.342, "erratum": "X-1", "confidence": "certain"}
    assert item("fr", answer, **wrong).verdict == "erratum"
    assert item("fr", answer, **wrong | {"corrected": 0.343}).verdict == "unexplained"
    assert item("fr", answer).verdict == "unexplained"


def test_words_that_mean_a_number():
    assert item("the same", Answer(1 + 1e-13, "so", meaning=1.0)).verdict == "derived"
    assert item("the same", Answer(0.9, "so", meaning=1.0)).verdict == "unexplained"


def test_a_reason_is_not_a_number():
    found = item("7800", "a property of the steel")
    assert found.verdict == "measured" and math.isnan(found.recomputed)
    assert found.how == "a property of the steel"


def test_every_cell_needs_an_answer_and_every_answer_a_cell():
    whole = {cell.key: "so" for cell in cells_of("Wang-2022")}
    assert len(items_from("Wang-2022", whole)) == len(whole)
    with pytest.raises(DataError, match=r"has no such cell; found 1 / steel / colour"):
        items_from("Wang-2022", whole | {("1", "steel", "colour"): "so"})
    first = next(iter(whole))
    del whole[first]
    with pytest.raises(DataError, match="nothing is said of a cell of Wang-2022; found 1 / steel"):
        items_from("Wang-2022", whole)


def test_misprints_change_one_digit():
    assert [misprint(text) for text in ("0.09", "-1/2", "about 30", "1,000", "0°")] == [
        "0.08", "-2/2", "about 40", "2,000", "7°",
    ]  # fmt: skip
