import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from binary_layouts import layout_of

from reduction.readers.parquet import read_parquet
from reduction.record.errors import LogError

layout = layout_of("parquet")


def read(tmp_path, columns, units=None, metadata=None, **settings):
    arrays = {name: pa.array(values) for name, values in columns.items()}
    units = units or {}
    fields = [
        pa.field(name, array.type, metadata={"unit": units[name]} if name in units else None)
        for name, array in arrays.items()
    ]
    schema = pa.schema(fields, metadata=metadata)
    pq.write_table(pa.table(list(arrays.values()), schema=schema), tmp_path / "log.parquet")
    return read_parquet(tmp_path / "log.parquet", layout(**settings), name="log.parquet")


TIME = [0.0, 0.5, 1.0]


def test_declared_columns_are_read_with_the_metadata_of_the_file(tmp_path):
    columns = {"t": TIME, "F": [1, 2, 3], "remark": ["a", None, "b"]}
    log = read(tmp_path, columns, {"F": "kN"}, {"operator": "KH"})
    assert log.columns["tension.1"].tolist() == [1, 2, 3]
    assert log.columns["tension.1"].dtype == np.float64
    assert log.metadata == {"operator": "KH"}
    assert (log.first_row, log.n_rows_read) == (0, 3)


def test_a_null_is_missing(tmp_path):
    log = read(tmp_path, {"t": TIME, "F": [1, None, 3]})
    assert log.missing("tension.1").tolist() == [False, True, False]


def test_columns_may_be_given_by_number_where_a_name_stands_twice(tmp_path):
    table = pa.Table.from_arrays([pa.array(TIME), pa.array([1.0, 2, 3])], names=["t", "t"])
    pq.write_table(table, tmp_path / "log.parquet")
    channels = {"time": {"column": 1, "unit": "s"}, "tension": {"1": {"column": 2, "unit": "kN"}}}
    log = read_parquet(tmp_path / "log.parquet", layout(channels=channels), name="x")
    assert log.columns["tension.1"].tolist() == [1, 2, 3]
    with pytest.raises(LogError, match="column 't' appears 2 times in the file"):
        read_parquet(tmp_path / "log.parquet", layout(), name="x")


def test_a_name_with_a_dot_is_one_column(tmp_path):
    channels = {"time": {"column": "t.s", "unit": "s"}}
    assert read(tmp_path, {"t.s": TIME, "t": TIME}, channels=channels).n_rows_read == 3


def test_a_unit_that_disagrees_is_an_error(tmp_path):
    with pytest.raises(LogError, match=r"\[F\]: the unit in the file is not the declared one"):
        read(tmp_path, {"t": TIME, "F": TIME}, {"F": "N"})


def test_a_unit_in_the_name_that_disagrees_is_an_error(tmp_path):
    channels = {"tension": {"1": {"column": "F (N)", "unit": "kN"}}}
    with pytest.raises(LogError, match="the unit in the column's name is not the declared one"):
        read(tmp_path, {"F (N)": TIME}, channels=channels)


def test_a_missing_column_lists_what_there_is(tmp_path):
    with pytest.raises(LogError, match="column 'F' is not in the file; found 't', 'load'"):
        read(tmp_path, {"t": TIME, "load": TIME})


@pytest.mark.parametrize(
    "values",
    [
        ["1", "2", "3"],
        [True, False, None],
        pa.array([1, 2, 3], pa.timestamp("ms")),
        [[1.0], [2.0], [3.0]],
        [None, None, None],
    ],
)
def test_what_is_no_number_is_an_error(tmp_path, values):
    with pytest.raises(LogError, match=r"\[F\]: a column does not hold numbers"):
        read(tmp_path, {"t": TIME, "F": values})


def test_whole_numbers_that_float64_cannot_hold_are_refused(tmp_path):
    with pytest.raises(LogError, match="too large"):
        read(tmp_path, {"t": TIME, "F": [1, 2, 2**60 + 1]})
    with pytest.raises(LogError, match=r"\[F\]: 1 of 3 values are whole .* too large.* value 3"):
        read(tmp_path, {"t": TIME, "F": [1, None, 2**60 + 1]})


def test_a_table_without_rows_is_an_error(tmp_path):
    empty = pa.array([], pa.float64())
    with pytest.raises(LogError, match="there are no data rows"):
        read(tmp_path, {"t": empty, "F": empty})


def test_a_damaged_column_is_an_error(tmp_path):
    values = np.random.default_rng(1).random(5000)
    pq.write_table(pa.table({"t": values, "F": values}), tmp_path / "log.parquet")
    content = bytearray((tmp_path / "log.parquet").read_bytes())
    content[4:2000] = b"\xff" * 1996
    (tmp_path / "log.parquet").write_bytes(content)
    with pytest.raises(LogError, match=r"\[t\]: a column cannot be read"):
        read_parquet(tmp_path / "log.parquet", layout(), name="x")


@pytest.mark.parametrize("content", [b"garbage" * 50, b"PAR1" + b"\xff" * 100 + b"PAR1"])
def test_a_file_that_is_no_parquet_is_an_error(tmp_path, content):
    (tmp_path / "log.parquet").write_bytes(content)
    with pytest.raises(LogError, match="the file is not Parquet"):
        read_parquet(tmp_path / "log.parquet", layout(), name="x")
