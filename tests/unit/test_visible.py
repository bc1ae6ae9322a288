"""Texts of strangers: shown without steering a terminal, written without being a formula."""

import tomllib
from unicodedata import category

import pytest
from hypothesis import given
from hypothesis import strategies as st

from reduction.record.errors import LogError, SettingsError
from reduction.record.plain_text import bare_cell, cut, safe_cell, toml_comment, toml_text, visible


@given(st.text())
def test_nothing_visible_steers_a_terminal(text):
    shown = visible(text)
    barred = ("Cc", "Cf", "Cs", "Zl", "Zp")
    assert not [sign for sign in set(shown) - set("\n\t") if category(sign) in barred]


def test_letters_of_every_script_stay_as_they_are():
    text = "Kraft [kN], 張力, натяжение, ε"
    assert visible(text) == text


@given(st.text())
def test_a_cell_that_is_written_is_read_back(text):
    assert bare_cell(safe_cell(text)) == text


@given(st.sampled_from("=+-@\t\r"), st.text(min_size=1))
def test_no_text_is_a_formula(sign, rest):
    cell = safe_cell(sign + rest)
    try:
        float(sign + rest)
    except ValueError:
        assert cell == f"'{sign}{rest}"


@pytest.mark.parametrize("number", ["-1.5", "+2", "-1e-3", "-.5", "-inf", "nan", "-"])
def test_numbers_stay_numbers(number):
    assert safe_cell(number) == number


@given(st.text(st.characters(exclude_categories=["Cs"])))
def test_a_text_in_toml_is_itself(text):
    written = toml_text(text)
    assert written.isprintable()
    assert tomllib.loads(f"x = {written}") == {"x": text}


@given(st.text(st.characters(exclude_categories=["Cs"])))
def test_a_comment_stays_on_its_line(text):
    assert tomllib.loads(f"# {toml_comment(text)}\nx = 1\n") == {"x": 1}


def test_a_message_is_cut_and_its_place_is_one_line():
    error = LogError("a\nb\x1b[2J.csv", "x" * 5000, found="\x9b31m" + "y" * 5000)
    said = str(error)
    assert said.startswith(r"a\nb\x1b[2J.csv: xxx")
    assert "... (3000 more); found \\x9b31myyy" in said
    assert len(said) < 4200


def test_a_list_of_faults_keeps_its_lines():
    assert str(SettingsError("two\n  one\n  other")) == "two\n  one\n  other"


def test_a_text_is_cut_where_it_is_asked():
    assert cut("abcdef", 3) == "abc... (3 more)"
    assert cut("abc", 3) == "abc"
