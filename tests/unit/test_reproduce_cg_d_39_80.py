"""Verdicts on CG-D-39-80: counts that follow from the page, and what a wrong digit does."""

import re
from collections import Counter
from dataclasses import replace

import pytest
from reproduced import whole

from reduction.published.cg_cells import Pages, number, rounding
from reduction.published.cg_d_39_80 import _item_of, _items_of
from reduction.published.printed_cells import cells_of, errata_of, number_of
from reduction.published.reproduced_item import agree, compared_item, judge, not_testable
from reduction.record.errors import DataError

REPORT = "CG-D-39-80"
CELLS = cells_of(REPORT)


def verdicts(chosen):
    return dict(Counter(item.verdict for item in whole()[REPORT] if chosen(item.cell)))


def item_at(table, row, column):
    (found,) = [item for item in whole()[REPORT] if item.cell.key == (table, row, column)]
    return found


def test_every_cell_has_one_verdict_and_none_is_unexplained():
    assert [item.cell for item in whole()[REPORT]] == list(CELLS)
    assert not [item.cell.key for item in whole()[REPORT] if item.verdict == "unexplained"]
    assert all(item.how for item in whole()[REPORT])


def test_every_erratum_is_met():
    named = {item.cell.erratum for item in whole()[REPORT]}
    assert {erratum.id for erratum in errata_of(REPORT)} <= named


def test_statistics_of_58_columns():
    # 54 follow from r2; of those two are cut off beside their other print, two prints of one
    # column differ, and one is the copy of another column
    assert verdicts(lambda cell: cell.column.endswith("F-stat")) == {
        "reproduced": 49, "open": 6, "erratum": 3,
    }  # fmt: skip
    assert verdicts(lambda cell: cell.column.endswith("F-crit")) == {"erratum": 58}
    # the four columns whose F does not follow, and the copy
    assert verdicts(lambda cell: cell.column.endswith(" r2")) == {
        "reproduced": 53, "open": 4, "erratum": 1,
    }  # fmt: skip


def test_coefficients_of_table_11():
    # copy of K_1 (10), the sign of one B6; the two plaited lines and the 1/2 in braid stand twice
    assert verdicts(lambda cell: cell.table == "11" and re.search(r" B\d+$", cell.column)) == {
        "erratum": 11, "open": 1, "reproduced": 29, "not_testable": 29,
    }  # fmt: skip


@pytest.mark.parametrize(
    ("table", "expected"),
    [
        ("1", {"reproduced": 23, "erratum": 1}),  # the second X_2
        ("2", {"reproduced": 12, "open": 1}),  # 7000 lb against 6400 lb
        # means, deviations and three of eight variabilities; samples and settings are not tested
        ("20", {"reproduced": 19, "erratum": 5, "not_testable": 11}),
        ("21", {"reproduced": 12, "erratum": 2}),
        ("A-2", {"reproduced": 1, "open": 2, "not_testable": 39}),
    ],
)
def test_counts_of_a_table(table, expected):
    assert verdicts(lambda cell: cell.table == table) == expected


def test_changes_and_f_tests():
    assert verdicts(lambda cell: cell.table == "10" and cell.column.endswith("change")) == {
        "reproduced": 5, "erratum": 4,
    }  # fmt: skip
    assert verdicts(lambda cell: cell.table in ("A-3", "A-4") and cell.column == "F") == {
        "reproduced": 8, "open": 3,
    }  # fmt: skip


@pytest.mark.parametrize(
    ("place", "recomputed", "verdict"),
    [
        # the equations at the centre point
        (("14", "nylon | double braid | 3/4 in | new", "dissipation_spring_constant B1"),
         4.878, "not_testable"),
        # tau of five years from K_ap and H: 1.773 s
        (("18", "nylon | 8-strand plaited | 1/2 in | 5 years", "relaxation_time B1"),
         1.773, "not_testable"),
        (("18", "nylon | 8-strand plaited | 1/2 in | 5 years", "relaxation_time F-stat"),
         5.005, "reproduced"),
        (("eq 4", "model", "constant in front of K_1"), 3.166, "erratum"),
        (("sec 3.2", "nylon | double braid | 3/4 in | new",
          "apparent_spring_constant at 4,000 and 1,600 lb"), 11.89, "erratum"),
        (("sec 3.2", "nylon | double braid | 1 1/4 in | new",
          "apparent_spring_constant at 4,000 and 1,600 lb"), 17.53, "reproduced"),
        (("sec 4.4.1", "nylon | double braid | 1/2 in | new",
          "apparent_spring_constant change over frequency"), 6.085, "reproduced"),
        # 30 % of 7878 lb; of the wet strength it would be 24.6
        (("sec 4.4.3", "nylon | 8-strand plaited | 1/2 in | new",
          "quasi_static_strain at 30 %RBS"), 25.68, "open"),
        (("A-4", "nylon | 8-strand plaited | 1/2 in | dry against wet, not cycled", "F"),
         47.86, "reproduced"),
        (("A-3", "nylon | 8-strand plaited | 1/2 in | wet, before against after cycling", "F"),
         24.73, "open"),
    ],
)  # fmt: skip
def test_recomputed_numbers(place, recomputed, verdict):
    item = item_at(*place)
    assert item.verdict == verdict
    assert item.recomputed == pytest.approx(recomputed, rel=5e-4)


def test_b6_of_the_energy_has_the_sign_that_the_equations_give():
    item = item_at("11", "nylon | double braid | 3/4 in | new", "hysteresis_energy B6")
    assert item.verdict == "erratum" and item.recomputed < 0


def other_leading_digit(text):
    """A printed number with another first digit."""
    return re.sub(r"[1-9]", lambda digit: str(int(digit[0]) % 9 + 1), text, count=1)


def test_a_wrong_digit_of_a_reproduced_number_is_noticed():
    """Every reproduced number in turn, its first digit one higher."""
    pages = Pages(CELLS)
    missed = []
    for item in whole()[REPORT]:
        value = number_of(item.cell.printed)
        if item.verdict != "reproduced" or not value or item.recomputed != item.recomputed:
            continue
        wrong = replace(item.cell, printed=other_leading_digit(item.cell.printed))
        pages.by_key[wrong.key] = wrong
        found = _item_of(wrong, pages)
        pages.by_key[wrong.key] = item.cell
        if found.verdict == "reproduced":
            missed.append((item.cell.key, item.cell.printed, wrong.printed))
    # rounding of what they follow from leaves these F their first digit at most
    assert [(key[0], key[2].rpartition(" ")[2], printed) for key, printed, _ in missed] == [
        ("5", "F-stat", "62.155"), ("A-4", "F", ".83"), ("A-4", "F", "42.75"), ("A-4", "F", ".003"),
    ]  # fmt: skip


NEXT_WORD = {
    "one": "two", "one-and-a-half": "twice", "two": "three", "twice": "three", "three": "four",
    "five": "six", "nine": "twelve", "twelve": "nine",
}  # fmt: skip


def test_a_wrong_number_in_words_is_noticed():
    pages = Pages(CELLS)
    changed = []
    for item in whole()[REPORT]:
        words = [NEXT_WORD.get(word, word) for word in item.cell.printed.split()]
        if item.verdict != "reproduced" or " ".join(words) == item.cell.printed:
            continue
        wrong = replace(item.cell, printed=" ".join(words))
        assert _item_of(wrong, pages).verdict == "unexplained", item.cell.key
        changed.append(item.cell.printed)
    assert sorted(changed) == [
        "five", "nine", "one", "one-and-a-half", "twelve", "twice", "twice", "two samples each",
    ]  # fmt: skip


def test_one_wrong_digit_is_unexplained_in_the_whole():
    row, column = "polyester | 8-strand plaited | 1/2 in | new", "apparent_spring_constant B1"
    cells = [
        replace(cell, printed="6.318") if cell.key == ("3", row, column) else cell for cell in CELLS
    ]
    wrong = [item.cell.key for item in _items_of(cells) if item.verdict == "unexplained"]
    # the other print and the number that the text repeats disagree with it now
    assert wrong == [("3", row, column), ("5", row, column), ("sec 4.4.1", row, column)]


def test_a_claim_that_fails_without_an_erratum_is_unexplained():
    cell = next(one for one in CELLS if not one.erratum)
    doubted = replace(cell, erratum="CG-1", confidence="open")
    assert agree(cell, False, "why").verdict == "unexplained"
    assert agree(cell, True, "why").verdict == "reproduced"
    assert agree(doubted, False, "why").verdict == "open"
    assert agree(replace(doubted, confidence="certain"), False, "why").verdict == "erratum"
    stands = replace(doubted, confidence="")
    assert agree(stands, False, "why").verdict == "unexplained"
    assert judge(stands, 1e9, "why").verdict == "unexplained"
    assert not_testable(stands, "why").verdict == "not_testable"
    assert compared_item(cell, 2.5, "why").recomputed == 2.5
    assert compared_item(cell, 2.5, "why").verdict == "not_testable"


def test_rounding_of_inputs_adds_up():
    # d(ab) = b da + a db
    assert rounding(lambda a, b: a * b, [3.0, 5.0], [0.5, 0.05]) == pytest.approx(2.5 + 0.15)


def test_places_without_a_number_are_refused():
    pages = Pages(CELLS)
    with pytest.raises(DataError, match="no such cell"):
        pages.cell("3", "hemp", "B1")
    with pytest.raises(DataError, match="a cell holds no number"):
        number(replace(CELLS[0], printed="n/a"))
