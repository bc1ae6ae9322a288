"""Cells of a table that a person wrote: what is read, and what is refused with its place."""

import numpy as np
import pytest

from reduction.campaign.experiment_plans import _read_cells
from reduction.record.errors import LogError, SettingsError


@pytest.fixture
def read(tmp_path):
    def read_text(text):
        path = tmp_path / "runs.csv"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return _read_cells(path)

    return read_text


@pytest.mark.parametrize("delimiter", [",", ";", "\t"])
def test_names_units_rows_and_numbers_with_any_delimiter(read, delimiter):
    text = "\ufeff# of the laboratory\n\nx [Hz],y\n0.1,1e3\n# again\n,\n-.5,\n".replace(
        ",", delimiter
    )
    sheet = read(text)
    assert [(column.name, column.unit) for column in sheet.columns] == [("x", "Hz"), ("y", "")]
    assert sheet.first == 3 and sheet.row == (4, 7)
    np.testing.assert_array_equal(sheet.numbers(sheet.columns[0]), [0.1, -0.5])
    np.testing.assert_array_equal(sheet.numbers(sheet.columns[1]), [1e3, np.nan])


def test_a_reached_level_goes_before_a_coded_one(read):
    sheet = read("x [coded],x [Hz]\n1,0.5\n")
    assert sheet.one("x", "factor").unit == "Hz"
    assert read("x [coded]\n1\n").one("x", "factor").unit == "coded"


@pytest.mark.parametrize(
    ("text", "place", "problem"),
    [
        (b"x,y\n\xb5,1\n", "runs.csv", "the table of runs is not UTF-8 text"),
        ("\n# nothing\n", "runs.csv", "the table of runs is empty"),
        ("x,x\n1,2\n", "runs.csv:1", "the header of the runs cannot be used"),
        ("x,,y\n1,2,3\n", "runs.csv:1", "the header of the runs cannot be used"),
        ("1,2\n3,4\n", "runs.csv:1", "the table of runs has no header"),
        ("x,y\n1\n", "runs.csv:2", "the number of cells in a row differs from the header"),
        ("x,y\n", "runs.csv", "the table of runs has no rows"),
    ],
)
def test_a_table_that_cannot_be_read_is_refused(read, text, place, problem):
    with pytest.raises(LogError, match=problem) as refused:
        read(text)
    assert refused.value.where().endswith(place)


def test_a_file_that_is_not_there_is_refused(tmp_path):
    with pytest.raises(LogError, match="the table of runs cannot be read"):
        _read_cells(tmp_path / "no.csv")


def test_open_values_are_named_together(read):
    with pytest.raises(SettingsError, match=r"2 values are still '\?'") as refused:
        read("x,y\n?,1\n1, ? \n")
    assert "runs.csv:2 [x]" in str(refused.value) and "runs.csv:3 [y]" in str(refused.value)


@pytest.mark.parametrize("cell", ["1,5", "0x10", "1 lbf", "inf", "--1", "1_000"])
def test_what_is_no_number_is_refused_with_row_and_column(read, cell):
    sheet = read(f'x;y\n1;2\n1;"{cell}"\n')
    with pytest.raises(LogError, match="a value is not a number") as refused:
        sheet.numbers(sheet.columns[1])
    assert refused.value.where().endswith("runs.csv:3 [y]")


def test_a_column_that_is_missing_or_there_twice_is_refused(read):
    sheet = read("x [Hz],x [1/s],frequenzy\n1,2,3\n")
    with pytest.raises(LogError, match="two columns contain x"):
        sheet.one("x", "factor")
    with pytest.raises(LogError, match="factor 'frequency' has no column") as refused:
        sheet.one("frequency", "factor")
    assert "is it frequenzy?" in str(refused.value)
