"""Texts of strangers: shown without steering a terminal, written without being a formula."""

import tomllib
from unicodedata import category

import pytest
from hypothesis import given
from hypothesis import strategies as st

from reduction.record.errors import LogError, SettingsError
from reduction.record.plain_text import (
    bare_cell,
    cut,
    is_address,
    safe_cell,
    secrets_of,
    shown_address,
    toml_comment,
    toml_text,
    visible,
    without_secrets,
)


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


# no password and no signature of an address is ever shown


@pytest.mark.parametrize(
    ("address", "shown"),
    [
        ("s3://bucket/raw/T-1.csv", "s3://bucket/raw/T-1.csv"),
        ("https://host/T.csv?X-Amz-Signature=abc&x=1", "https://host/T.csv"),
        ("https://host/T.csv#part", "https://host/T.csv"),
        ("https://ann:secret@host/T.csv", "https://host/T.csv"),
        ("https://ann@host:8080/T.csv", "https://host:8080/T.csv"),
        ("https://ann:se@cret@host/T.csv", "https://host/T.csv"),
        ("s3://KEY:ab/cd@bucket/T.csv", "s3://bucket/T.csv"),
        ("s3://KEY:ab", "s3://..."),
        ("http://[::1]:8080/T.csv", "http://[::1]:8080/T.csv"),
        ("http://host:8080/a@b.csv", "http://host:8080/a@b.csv"),
        ("https://host", "https://host"),
    ],
)
def test_an_address_is_shown_without_what_is_secret(address, shown):
    assert shown_address(address) == shown
    assert without_secrets(f"found '{address}', needed more") == f"found '{shown}', needed more"


def test_every_address_of_a_text_is_cleaned_and_a_chained_one_too():
    text = "a https://u:p@h/x?sig=1 and simplecache::s3://k:s@b/y; C:/raw/T.csv?"
    assert without_secrets(text) == "a https://h/x and simplecache::s3://b/y; C:/raw/T.csv?"


@given(
    # a slash is written %2F, and so is a @; of a key that is pasted as it is one of them is told
    st.text("abcXYZ019:@-_.~", max_size=20) | st.text("abcXYZ019:/-_.~", max_size=20),
    st.text("abcXYZ019%+-_.~/", min_size=1, max_size=20),
)
def test_no_user_password_or_value_of_a_query_is_left(password, signature):
    address = f"https://Q:Q{password}Q@host/T.csv?sig=Q{signature}Q"
    assert "Q" not in shown_address(address)
    assert "Q" not in without_secrets(f"{address}: no")


def test_the_secrets_of_an_address_are_its_pieces():
    assert secrets_of("s3://bucket/T.csv") == ()
    found = secrets_of("https://ann:se@cret@host/T.csv?sig=abcdef&se=2026-01-01")
    assert set(found) == {"se@cret", "sig=abcdef&se=2026-01-01", "abcdef", "2026-01-01"}


def test_what_is_no_address_stays_as_it_is():
    assert not is_address("raw/T-1.csv") and not is_address("C:\\raw\\T-1.csv")
    assert is_address("memory://raw/T-1.csv")
    assert without_secrets("a@b:c?d#e") == "a@b:c?d#e"


def test_no_message_of_this_package_shows_a_password():
    address = "https://ann:secret@host/T.csv?sig=abc"
    error = SettingsError(f"{address}: no", found=repr(address), needed=address, hint=address)
    assert str(error) == (
        "https://host/T.csv: no; found 'https://host/T.csv'; needed https://host/T.csv. "
        "https://host/T.csv"
    )
    assert str(LogError(address, "a gap")) == "https://host/T.csv: a gap"


def test_a_stop_behind_an_address_is_of_the_sentence():
    assert (
        without_secrets("see https://h/x?a=1: no, https://h/y.")
        == "see https://h/x: no, https://h/y."
    )
