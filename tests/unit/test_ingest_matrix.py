import json

import numpy as np
import pytest

from reduction.readers.json_matrix import read_json
from reduction.readers.layout import Layout
from reduction.record.errors import LogError

CHANNELS = {
    "time": {"column": 1, "unit": "s"},
    "crosshead_position": {
        "column": 2, "unit": "in", "datum": "displacement", "unit_key": "displacement units",
    },
    "tension.1": {"column": 3, "unit": "lbf"},
}  # fmt: skip
NAMED = {"time": {"column": "t", "unit": "s"}, "tension.1": {"column": "F", "unit": "N"},
         "temperature.1": {"column": "x", "unit": "degC"}}  # fmt: skip
UNITS = {"displacement units": "inch", "sampling freq": 1024}


@pytest.fixture
def read(tmp_path):
    def read_content(content, channels=None, **settings):
        path = tmp_path / "log.json"
        path.write_text(content if isinstance(content, str) else json.dumps(content))
        layout = Layout(
            format="json", channels=channels or CHANNELS, **{"matrix": "data"} | settings
        )
        return read_json(path, layout, name="log.json")

    return read_content


def test_columns_are_numbers_of_the_matrix(read):
    log = read({"data": [[0, 1.5, 2], [1, 2.5, 3]], **UNITS})
    assert log.columns["crosshead_position"].tolist() == [1.5, 2.5]
    assert (log.n_rows_read, log.first_row) == (2, 0)
    assert log.metadata == {"displacement units": "inch", "sampling freq": "1024"}


def test_columns_have_names_where_the_file_gives_them(read):
    channels = {"tension.1": {"column": "force", "unit": "lbf"}}
    content = {"data": [[0, 1]], "columns": ["time", "force"], "units": ["s", "lb"]}
    log = read(content, channels, matrix_names="columns", matrix_units="units")
    assert log.columns["tension.1"].tolist() == [1.0]


def test_the_rows_of_a_wide_matrix_are_the_columns(read):
    log = read({"data": [list(range(20)), [0.5] * 20, list(range(3, 23))], **UNITS})
    assert (log.n_rows_read, log.columns["tension.1"][-1]) == (20, 22)


def test_null_and_declared_words_are_missing(read):
    log = read('{"data": [[0, 1, null], [1, NaN, 3], [2, "--", 4]], "displacement units": "in"}',
               missing=("", "NaN", "--"))  # fmt: skip
    np.testing.assert_equal(log.columns["tension.1"], [np.nan, 3.0, 4.0])
    np.testing.assert_equal(log.columns["crosshead_position"], [1.0, np.nan, np.nan])


@pytest.mark.parametrize("value", ["Infinity", '"ovrflw"', "true", "[1]"])
def test_a_value_that_is_no_number_names_its_row(read, value):
    with pytest.raises(LogError, match="a value in row 2 of 'data' is not a number"):
        read(f'{{"data": [[0, 1, 2], [1, 2, {value}]], "displacement units": "in"}}')


def test_a_unit_that_contradicts_the_layout_is_refused(read):
    with pytest.raises(LogError, match=r"the unit in the file is not the declared one; found 'mm'"):
        read({"data": [[0, 1, 2]], "displacement units": "mm"})


def test_a_key_that_is_not_there_lists_what_is(read):
    with pytest.raises(LogError, match="there is no key 'data'; found 'rows'; needed .* as matrix"):
        read({"rows": []})
    with pytest.raises(
        LogError, match="no key 'displacement units'.*unit_key of crosshead_position"
    ):
        read({"data": [[0, 1, 2]]})
    with pytest.raises(LogError, match="there is no key 'data'; found no object"):
        read([1, 2])


def test_names_that_are_no_texts_are_refused(read):
    with pytest.raises(LogError, match="'columns' is not a list of texts; found dict"):
        read({"data": [[0, 1, 2]], "columns": {}, **UNITS}, matrix_names="columns")


def test_rows_of_unequal_length_are_refused(read):
    with pytest.raises(LogError, match="row 2 of 'data' has 2 values, the first 3"):
        read({"data": [[0, 1, 2], [1, 2]], **UNITS})


def test_what_is_no_matrix_is_refused(read):
    with pytest.raises(LogError, match="'data' is not a matrix; found str"):
        read({"data": "none", **UNITS})
    with pytest.raises(LogError, match="'data' holds no columns"):
        read({"data": {}, **UNITS})


def test_a_matrix_without_rows_is_refused(read):
    with pytest.raises(LogError, match="there are no data rows"):
        read({"data": [], **UNITS})


def test_what_is_no_json_names_the_row(read):
    with pytest.raises(LogError, match=r"log\.json:2: the file is not JSON"):
        read('{"data":\n oops}')


@pytest.mark.parametrize("digits", [310, 5000])
def test_a_whole_number_beyond_every_float_is_infinite(read, digits):
    with pytest.raises(LogError, match="1 of 2 values are infinite, first value 2"):
        read(f'{{"data": [[0, 1, 2], [1, 2, {"9" * digits}]], "displacement units": "in"}}')


def test_a_file_that_is_nested_without_end_is_refused(read):
    with pytest.raises(LogError, match="the file is nested too deeply"):
        read("[" * 100_000)


def test_a_key_that_stands_twice_is_refused(read):
    with pytest.raises(LogError, match="the key 'data' appears twice in an object"):
        read('{"data": [[0, 1, 2]], "displacement units": "in", "data": [[0, 1, 3]]}')


def test_json_of_columns_records_and_lines_refuses_what_has_no_number(read):
    with pytest.raises(LogError, match=r"there is no key 'a\.b'.*separated by dots"):
        read({"a": {"c": [1, 2]}}, matrix="", group="a.b")
    with pytest.raises(LogError, match="a value in row 2 of 'x' is not a number; found 'up'"):
        read([{"t": 0, "x": 1, "F": 2}, {"t": 1, "x": "up", "F": 2}], matrix="",
             channels=NAMED)  # fmt: skip
    with pytest.raises(LogError, match="row 2 of the file is not an object; found list"):
        read([{"t": 0, "x": 1, "F": 2}, [1, 1, 2]], matrix="", channels=NAMED)
    with pytest.raises(LogError, match=r"log\.json:2: the file is not JSON"):
        read('{"t": 0, "x": 1, "F": 2}\n{"t": oops}\n', matrix="", channels=NAMED)
