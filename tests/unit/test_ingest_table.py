from pathlib import Path

import numpy as np
import pytest

from reduction.readers.columns import (
    ColumnTable,
    DeclaredColumn,
    _CheckedColumn,
    matrix_table,
    read_columns,
    row_parts,
)
from reduction.readers.layout import Layout, LogParts
from reduction.record.errors import LogError

PATH = Path("log.h5")
TIME = DeclaredColumn("time", "t", "s", "time")


def layout(**settings):
    channels = {
        "time": {"column": "t", "unit": "s"},
        "tension": {"1": {"column": "F", "unit": "kN"}},
    }
    return Layout.model_validate({"format": "hdf5", "channels": channels, **settings})


def in_parts(values):
    """A loader of columns that are all of the same length or shorter."""

    def load(place, n_rows):
        return (values[place][part] for part in row_parts(len(values[place]), n_rows))

    return load


def table(**columns):
    values = [np.asarray(column) for column in columns.values()]
    n_rows = max(column.size for column in values)
    return ColumnTable(tuple(columns), ("",) * len(columns), in_parts(values), n_rows)


def to_floats(path, wanted, values, layout):
    """A column of one part."""
    column = _CheckedColumn(path, wanted, layout, None)
    column.add(values)
    return column.finish()


@pytest.mark.parametrize("kind", ["f2", "f4", "f8", "i1", "u2", "i4", "i8", ">f8", ">i4"])
def test_every_kind_of_real_number_becomes_float64(kind):
    values = to_floats(PATH, TIME, np.array([0, 1, 2], dtype=kind), layout())
    assert values.dtype == np.float64
    assert values.tolist() == [0.0, 1.0, 2.0]


@pytest.mark.parametrize(
    ("values", "found"),
    [
        (np.array([True, False]), r"true or false \(bool\)"),
        (np.array(["1", "2"]), "text"),
        (np.array([b"1"]), "text"),
        (np.array(["2020-01-01"], dtype="M8[s]"), "dates"),
        (np.array([1], dtype="m8[s]"), "durations"),
        (np.array([1j]), "complex numbers"),
        (np.array([None]), "text or objects"),
        (np.zeros(2, dtype=[("a", "f8")]), "records"),
    ],
)
def test_what_is_no_real_number_is_refused(values, found):
    with pytest.raises(LogError, match=rf"\[t\]: a column does not hold numbers; found {found}"):
        to_floats(PATH, TIME, values, layout())


def test_a_clock_is_refused_in_a_binary_file():
    with pytest.raises(LogError, match="a clock is read from text alone"):
        to_floats(PATH, DeclaredColumn("time", "t", "clock", "time"), np.array([945.0]), layout())


def test_whole_numbers_that_float64_cannot_hold_are_refused():
    with pytest.raises(LogError, match="1 of 2 values are whole numbers too large.*first value 2"):
        to_floats(PATH, TIME, np.array([0, 2**60]), layout())


def test_nan_is_missing_by_default_and_refused_where_it_is_not_declared():
    values = np.array([0.0, np.nan, 2.0])
    assert np.isnan(to_floats(PATH, TIME, values, layout())).tolist() == [False, True, False]
    with pytest.raises(LogError, match="1 of 3 values are NaN, first value 2"):
        to_floats(PATH, TIME, values, layout(missing=[""]))


def test_infinite_values_are_refused():
    with pytest.raises(LogError, match="1 of 2 values are infinite.*found inf"):
        to_floats(PATH, TIME, np.array([0.0, np.inf]), layout())


def test_declared_columns_are_read_and_counted():
    columns, n_rows = read_columns(PATH, layout(), table(F=np.ones(3), t=np.arange(3), x=["a"]))
    assert n_rows == 3
    assert list(columns) == ["time", "tension.1"]
    assert columns["time"].tolist() == [0, 1, 2]


def test_columns_that_the_reader_makes_are_not_looked_up():
    made = {"time": lambda n_rows: iter([np.arange(2.0)])}
    columns, _ = read_columns(PATH, layout(), table(F=np.ones(2)), made)
    assert columns["time"].tolist() == [0, 1]


def test_stated_units_are_checked():
    stated = ColumnTable(("t", "F"), ("s", "N"), in_parts([np.ones(2)] * 2))
    with pytest.raises(LogError, match=r"\[F\]: the unit in the file is not the declared one"):
        read_columns(PATH, layout(), stated)


def test_a_matrix_has_numbered_columns_or_named_ones():
    matrix = np.arange(6.0).reshape(3, 2)
    plain = matrix_table(PATH, matrix, where="'M'")
    assert plain.names == ("", "")
    assert [part.tolist() for part in plain.load(1, 2)] == [[1, 3], [5]]
    assert matrix_table(PATH, matrix, where="'M'", names=("t", "F")).names == ("t", "F")


def test_a_table_of_records_has_the_names_of_its_fields():
    records = np.zeros(3, dtype=[("t", "f8"), ("F", "i2")])
    records["F"] = [1, 2, 3]
    made = matrix_table(PATH, records, where="'M'")
    assert made.names == ("t", "F")
    assert [part.tolist() for part in made.load(1, 3)] == [[1, 2, 3]]


@pytest.mark.parametrize("what", ["names", "units"])
def test_a_matrix_with_another_number_of_names_or_units_is_refused(what):
    with pytest.raises(LogError, match=f"the number of columns of .* is not its number of {what}"):
        matrix_table(PATH, np.zeros((3, 2)), where="'M'", **{what: ("a", "b", "c")})


@pytest.mark.parametrize("shape", [(3,), (2, 2, 2)])
def test_what_has_no_rows_and_columns_is_no_matrix(shape):
    with pytest.raises(LogError, match="'M' is not a matrix"):
        matrix_table(PATH, np.zeros(shape), where="'M'")


def test_rows_that_the_file_keeps_together_are_read_once_for_all_columns():
    asked = []

    class Rows:
        shape, dtype, n_together = (10, 2), np.dtype(float), 4

        def __getitem__(self, rows):
            asked.append((rows.start, rows.stop))
            return np.arange(20.0).reshape(10, 2)[rows]

    made = matrix_table(PATH, Rows(), where="'M'", names=("t", "F"))
    parts = LogParts(in_memory=0, n_bytes=80)
    columns, _ = read_columns(PATH, layout(), made, parts=parts)
    assert asked == [(0, 4), (4, 8), (8, 10)]
    assert columns["tension.1"].tolist() == list(range(1, 20, 2))


@pytest.mark.parametrize("n_bytes", [1, 16, 40, 1000])
def test_a_fault_is_told_alike_in_parts_of_any_length(n_bytes):
    values = np.array([0.0, np.inf, 2.0, np.nan, np.nan, 5.0])
    with pytest.raises(LogError, match=r"\[F\]: 2 of 6 values are NaN, first value 4; found nan"):
        read_columns(
            PATH,
            layout(missing=[""]),
            table(t=np.arange(6), F=values),
            parts=LogParts(in_memory=0, n_bytes=n_bytes),
        )
