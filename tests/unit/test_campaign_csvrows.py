"""What every small table beside campaign.toml has in common: how it is opened."""

import pytest

from reduction.campaign.toml_file import read_csv_rows
from reduction.record.errors import LogError, SettingsError


def in_settings(path, problem, *, row=None, **kwargs):
    return SettingsError(f"{path}:{row}: {problem}", **kwargs)


def test_rows_keep_their_line_and_empty_ones_are_left_out(tmp_path):
    path = tmp_path / "t.csv"
    path.write_bytes(b"\xef\xbb\xbf a , b\r\n1,2\r\n,\r\n3,\r\n")
    header, rows = read_csv_rows(path, "the table")
    assert header == ["a", "b"]
    assert list(rows) == [(2, ["1", "2"]), (4, ["3", ""])]


def test_a_file_without_a_line_has_no_header(tmp_path):
    (tmp_path / "t.csv").write_text("")
    header, rows = read_csv_rows(tmp_path / "t.csv", "the table")
    assert header == []
    assert list(rows) == []


def test_a_header_can_be_refused_before_a_row_is(tmp_path):
    (tmp_path / "t.csv").write_text("a,b\n1\n")
    header, rows = read_csv_rows(tmp_path / "t.csv", "the table", fault=in_settings)
    assert header == ["a", "b"]
    with pytest.raises(
        SettingsError, match=r"t.csv:2: the number of cells in a row .*found 1; needed 2"
    ):
        next(rows)


def test_a_file_that_is_no_text_or_is_not_there_is_told(tmp_path):
    (tmp_path / "t.csv").write_bytes(b"a\xff,b\n")
    with pytest.raises(LogError, match="the table is not UTF-8 text"):
        read_csv_rows(tmp_path / "t.csv", "the table")
    with pytest.raises(LogError, match="the table cannot be read; found No such file"):
        read_csv_rows(tmp_path / "none.csv", "the table")
