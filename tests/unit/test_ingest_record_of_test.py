import hashlib

import numpy as np
import pytest

from reduction.readers.layout import Layout
from reduction.readers.read_log import read_record
from reduction.record.errors import LogError, SettingsError
from reduction.record.settings import QualitySettings

LAYOUT = Layout(
    format="delimited",
    channels={
        "time": {"column": "t", "unit": "s"},
        "crosshead_position": {"column": "x", "unit": "mm", "datum": "pin-to-pin"},
        "tension.1": {"column": "F", "unit": "kN"},
    },
)


@pytest.fixture
def pieces(tmp_path):
    for name, start in (("a.csv", 0), ("b.csv", 5)):
        rows = [f"{start + i},{100 + i % 3},{i}" for i in range(5)]
        (tmp_path / name).write_text("\n".join(["t,x,F", *rows]) + "\n")
    return tmp_path


def read(folder, *names, **settings):
    files = [(folder / name, LAYOUT, f"raw/{name}") for name in names]
    return read_record(
        files, test_id="T-1", specimens=["new"], quality=QualitySettings(), **settings
    )


def test_a_record_comes_with_the_hash_of_each_of_its_files(pieces):
    record, sources = read(pieces, "a.csv", "b.csv")
    assert [source.name for source in sources] == ["raw/a.csv", "raw/b.csv"]
    for source in sources:
        data = (pieces / source.name.split("/")[1]).read_bytes()
        assert (source.sha256, source.size) == (hashlib.sha256(data).hexdigest(), len(data))
    np.testing.assert_array_equal(record.time, np.arange(10.0))
    assert record.tension[0, 4] == 4000.0
    assert record.n_rows_read == 10


def test_a_fault_of_the_second_file_names_it(pieces):
    (pieces / "b.csv").write_text("t,x,F\n5,100,x\n")
    with pytest.raises(LogError, match=r"b\.csv:2 \[F\]: a value is not a number; found 'x'"):
        read(pieces, "a.csv", "b.csv")


def test_a_test_without_files_is_refused(pieces):
    with pytest.raises(SettingsError, match="test 'T-1' has no file"):
        read(pieces)
