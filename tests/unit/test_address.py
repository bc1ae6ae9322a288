"""No password and no signature of an address is ever shown."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from reduction.record.errors import LogError, SettingsError
from reduction.record.plain_text import is_address, secrets_of, shown_address, without_secrets


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
