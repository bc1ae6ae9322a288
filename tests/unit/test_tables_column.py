"""Cells and headers of the tables."""

import numpy as np
import pytest
from table_cells import text_of_columns

from reduction.archive.csv_columns import (
    CsvColumn,
    _shown_values,
    csv_text,
    uncertainty_of,
)
from reduction.quantities.names import QUANTITIES, TEST_SCHEMA


def test_a_real_has_its_unit_in_the_header_and_a_label_or_count_has_none():
    assert (
        CsvColumn("segment_modulus", TEST_SCHEMA["segment_modulus"]).header
        == "segment_modulus [Pa]"
    )
    assert CsvColumn("segment", TEST_SCHEMA["segment"]).header == "segment"
    assert CsvColumn("strain_method", TEST_SCHEMA["strain_method"]).header == "strain_method"


def test_a_measured_column_is_followed_by_its_uncertainty():
    column = uncertainty_of(CsvColumn("segment_modulus", TEST_SCHEMA["segment_modulus"]))
    assert column.header == "segment_modulus_standard_uncertainty [Pa]"


def test_a_number_comes_back_from_its_digits_exactly():
    numbers = [0.1, 1 / 3, 1e-300, 123456789.123456789, -0.0]
    text = csv_text(["x [1]"], [[cell] for cell in numbers])
    assert [float(line) for line in text.split("\r\n")[1:-1]] == numbers


def test_what_is_not_known_is_an_empty_field():
    assert text_of_columns(np.array([1.5, np.nan]), ["a", "b"]) == "1.5,a\r\n,b\r\n"


def test_a_count_is_written_without_a_point():
    assert text_of_columns(np.array([3], dtype=np.int32)) == "3\r\n"


def test_flags_are_written_in_words():
    branches = _shown_values(np.array([1, 2, 7]), TEST_SCHEMA["branch"])
    assert list(branches) == ["ascending", "descending", "7"]
    flags = _shown_values(np.array([0, 33]), TEST_SCHEMA["quality_flag"])
    assert list(flags) == ["", "missing spike"]


def test_a_table_of_columns_is_that_of_its_rows():
    labels = ["=1+1", 'a "b", c', "d\ne", "f\rg", "", " h", "größe", "'i"]
    rows = [[label, 0.1 * place, None] for place, label in enumerate(labels)]
    text = text_of_columns(
        _shown_values(np.array(labels), QUANTITIES["test"]),
        np.array([row[1] for row in rows]),
        [None] * len(rows),
    )
    assert csv_text(["a", "b", "c"], rows) == f"a,b,c\r\n{text}"


@pytest.mark.parametrize("start", ["=", "+", "-", "@", "\t", "\r"])
def test_text_that_a_spreadsheet_would_run_is_escaped(start):
    text = csv_text(["note"], [[f"{start}cmd"], ["plain = text"]])
    assert f"'{start}cmd" in text
    assert "plain = text" in text
    assert "'plain" not in text


def test_a_negative_number_is_not_taken_for_a_formula():
    assert csv_text(["x"], [[-1.5]]) == "x\r\n-1.5\r\n"


def test_text_with_commas_quotes_and_line_ends_is_quoted():
    assert csv_text(["note"], [['a "b", c\nd']]) == 'note\r\n"a ""b"", c\nd"\r\n'


def test_a_label_says_why_it_has_no_uncertainty():
    assert CsvColumn("test", QUANTITIES["test"]).description == ["test", "", "test", "label"]
    assert CsvColumn("segment_modulus", TEST_SCHEMA["segment_modulus"]).description == [
        "segment_modulus [Pa]",
        "Pa",
        "modulus of the straight-line segment",
        "",
    ]
