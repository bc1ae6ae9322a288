"""Tables for a pipe: every row one line, every column where a program finds it."""

import pytest

from reduction.cli.output import NOTHING, plain_table


def test_columns_stand_at_the_same_places_in_every_line():
    text = plain_table(
        ["name", "load [N]"],
        [["a", "a longer name"], ["1.5", "-1.25e+05"]],
        is_number=[False, True],
    )
    assert text.splitlines() == [
        "name            load [N]",
        "a                    1.5",
        "a longer name  -1.25e+05",
    ]


@pytest.mark.parametrize("cell", ["two  spaces", "two\nlines", "a\ttab", "\x0b", "", "   "])
def test_no_cell_looks_like_the_space_between_two(cell):
    text = plain_table(["a", "b", "c"], [["x"], [cell], ["y"]], is_number=[False] * 3)
    for line in text.splitlines():
        assert len([one for one in line.split("  ") if one.strip()]) == 3


def test_an_empty_cell_has_a_mark():
    assert plain_table(["a", "b"], [["x"], [""]], is_number=[False, False]).split()[-1] == NOTHING


def test_letters_that_are_two_columns_wide_count_as_two():
    rows = plain_table(
        ["a", "b"], [["張力", "ab"], ["1", "2"]], is_number=[False, False]
    ).splitlines()
    assert rows[1] == "張力  1" and rows[2] == "ab    2"


def test_nothing_is_cut_however_long():
    long = "word " * 500
    text = plain_table(["a", "b"], [["x"], [long]], is_number=[False, False])
    assert long.strip() in text and len(text.splitlines()) == 2
