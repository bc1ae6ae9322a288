import h5py
import numpy as np
import pytest
from binary_layouts import layout_of

from reduction.readers.columns import matrix_table
from reduction.readers.hdf5 import data_set, open_hdf5, read_hdf5
from reduction.readers.layout import Watch
from reduction.record.errors import LogError

layout = layout_of("hdf5")


@pytest.fixture
def path(tmp_path):
    """A log of three rows in a group, as a matrix, and as a table of records."""
    path = tmp_path / "log.h5"
    with h5py.File(path, "w") as file:
        file.attrs["operator"] = "KH"
        file.attrs["table"] = np.zeros(3)
        group = file.create_group("run/1")
        group.attrs["rate"] = 10
        group.attrs["machine"] = np.bytes_("MTS")
        group["t"] = np.arange(3) * 0.5
        group["F"] = np.array([[1, 2, 3]], dtype=np.int16)
        group["F"].attrs["units"] = "kN"
        group["M"] = np.arange(6.0).reshape(3, 2)
        group["names"] = ["t", "F"]
        group["units"] = np.array([b"s", b"N"])
        records = np.zeros(3, dtype=[("t", "f8"), ("F", "f4")])
        records["F"] = [4, 5, 6]
        group["records"] = records
    return path


def add(path, name, values, **attributes):
    with h5py.File(path, "a") as file:
        group = file["run/1"]
        group.pop(name, None)
        group[name] = values
        group[name].attrs.update(attributes)


def read(path, **settings):
    return read_hdf5(path, layout(**{"group": "run/1", **settings}), name="log.h5")


def test_data_sets_of_a_group_are_columns(path):
    log = read(path)
    assert log.columns["time"].tolist() == [0, 0.5, 1]
    assert log.columns["tension.1"].tolist() == [1, 2, 3]
    assert log.metadata == {"operator": "KH", "rate": "10", "machine": "MTS"}
    assert (log.first_row, log.n_rows_read) == (0, 3)


def test_columns_of_a_matrix_go_by_number_or_by_the_names_beside_it(path):
    numbers = {"time": {"column": 1, "unit": "s"}, "tension": {"1": {"column": 2, "unit": "kN"}}}
    assert read(path, matrix="M", channels=numbers).columns["tension.1"].tolist() == [1, 3, 5]
    assert read(path, matrix="M", matrix_names="names").columns["time"].tolist() == [0, 2, 4]


def test_the_rows_of_a_wide_matrix_are_read_in_parts_of_whole_chunks(path):
    with h5py.File(path, "a") as file:
        values = np.stack([np.arange(20.0), np.arange(20.0) ** 2])
        file["run/1"].create_dataset("W", data=values, chunks=(2, 8))
    with open_hdf5(path) as file:
        matrix = data_set(path, file["run/1/W"], Watch(path))
        table = matrix_table(path, matrix, where="'W'")
        parts = [part.tolist() for part in table.load(1, 9)]
    assert [len(part) for part in parts] == [8, 8, 4]
    assert sum(parts, []) == [float(i) ** 2 for i in range(20)]  # noqa: RUF017


def test_units_beside_a_matrix_are_checked(path):
    with pytest.raises(LogError, match=r"\[F\]: the unit in the file is not the declared one"):
        read(path, matrix="M", matrix_names="names", matrix_units="units")


def test_a_table_of_records_is_a_matrix_with_names(path):
    assert read(path, matrix="records").columns["tension.1"].tolist() == [4, 5, 6]


@pytest.mark.parametrize("unit", ["N", np.bytes_("N"), np.array(["N"], dtype=object)])
def test_a_unit_attribute_that_disagrees_is_an_error(path, unit):
    with h5py.File(path, "a") as file:
        file["run/1/F"].attrs["units"] = unit
    with pytest.raises(LogError, match=r"\[F\]: the unit in the file is not the declared one"):
        read(path)


def test_a_missing_column_lists_what_there_is(path):
    channels = {"time": {"column": "clock", "unit": "s"}}
    with pytest.raises(LogError, match=r"'clock' is not in group '/run/1'; found 'F', 'M'"):
        read(path, channels=channels)


def test_a_column_by_number_is_refused_in_a_group(path):
    with pytest.raises(LogError, match="needed a name"):
        read(path, channels={"time": {"column": 1, "unit": "s"}})


def test_a_missing_group_says_how_far_the_path_goes(path):
    with pytest.raises(LogError, match=r"'run/2' is not in the file; found in '/run': '1'"):
        read(path, group="run/2")
    with pytest.raises(LogError, match="'run/1/t/x' is not in the file"):
        read(path, group="run/1/t/x")


def test_a_group_is_not_a_column_and_a_column_is_not_a_group(path):
    with pytest.raises(LogError, match="'/run/1/t' is a group, not|'run/1/t' is not a group"):
        read(path, group="run/1/t")
    with pytest.raises(LogError, match="'/run/1' is a group, not a data set"):
        read(path, group="", matrix="run/1")


def test_columns_of_two_lengths_are_two_time_bases(path):
    add(path, "F", np.arange(4.0))
    with pytest.raises(LogError, match=r"two time bases; found time 3 values, tension\.1 4 values"):
        read(path)


def test_a_column_of_two_dimensions_is_an_error(path):
    add(path, "F", np.zeros((3, 2)))
    with pytest.raises(LogError, match=r"'/run/1/F' is not one column; found shape \(3, 2\)"):
        read(path)


@pytest.mark.parametrize("value", [1.0, h5py.Empty("f8")])
def test_a_single_value_is_an_error(path, value):
    add(path, "F", value)
    with pytest.raises(LogError, match="is a single value, not a series"):
        read(path)


@pytest.mark.parametrize("values", [["1", "2", "3"], np.array([True, False, True])])
def test_what_is_no_number_is_an_error(path, values):
    add(path, "F", values)
    with pytest.raises(LogError, match=r"\[F\]: a column does not hold numbers"):
        read(path)


def test_names_that_are_no_text_are_an_error(path):
    with pytest.raises(LogError, match="'/run/1/t' does not hold text"):
        read(path, matrix="M", matrix_names="t")


def test_packed_values_are_refused(path):
    add(path, "F", np.array([1, 2, 3], dtype=np.int16), scale_factor=0.1)
    with pytest.raises(LogError, match="'/run/1/F' is packed; found scale_factor"):
        read(path)


def test_an_empty_series_is_an_error(path):
    for name in "tF":
        add(path, name, np.zeros(0))
    with pytest.raises(LogError, match="there are no data rows"):
        read(path)


def test_nothing_is_read_from_another_file(path, tmp_path):
    other = tmp_path / "other.h5"
    with h5py.File(other, "w") as file:
        file["F"] = np.arange(3.0)
    for link in (h5py.ExternalLink("other.h5", "/F"), h5py.SoftLink("/run/1/t")):
        with h5py.File(path, "a") as file:
            del file["run/1/F"]
            file["run/1/F"] = link
        # a link is no column of the file, and is refused by name
        with pytest.raises(LogError, match="'F' is not in group"):
            read(path)
        with pytest.raises(LogError, match="'F' is a link"):
            read(path, matrix="F")


def test_virtual_and_external_storage_are_refused(path, tmp_path):
    virtual = h5py.VirtualLayout(shape=(3,), dtype="f8")
    virtual[:] = h5py.VirtualSource("other.h5", "F", shape=(3,))
    with h5py.File(path, "a") as file:
        del file["run/1/F"]
        file["run/1"].create_virtual_dataset("F", virtual)
        raw = [(str(tmp_path / "raw.bin"), 0, 24)]
        file["run/1"].create_dataset("G", shape=(3,), dtype="f8", external=raw)
    with pytest.raises(LogError, match="'/run/1/F' stores its values in other files"):
        read(path)
    with pytest.raises(LogError, match="'/run/1/G' stores its values in other files"):
        read(path, channels={"time": {"column": "G", "unit": "s"}})


def test_damaged_values_are_an_error(path):
    values = np.array([1.25, -7.5, 3.0])
    with h5py.File(path, "a") as file:
        del file["run/1/F"]
        file["run/1"].create_dataset("F", data=values, fletcher32=True, chunks=(3,))
    content = path.read_bytes()
    assert content.count(values.tobytes()) == 1
    path.write_bytes(content.replace(values.tobytes(), b"\xff" * 24))
    with pytest.raises(LogError, match="'/run/1/F' cannot be read"):
        read(path)


def test_a_damaged_file_is_an_error(path):
    content = bytearray(path.read_bytes())
    for place in range(200, len(content)):
        if content[place : place + 4] in (b"TREE", b"HEAP", b"SNOD"):
            content[place : place + 4] = b"\0\0\0\0"
    path.write_bytes(content)
    with pytest.raises(LogError, match="the file is damaged"):
        read(path)


@pytest.mark.parametrize("content", [b"garbage" * 50, b"\x89HDF\r\n\x1a\n" + b"\xff" * 100])
def test_a_file_that_is_no_hdf5_is_an_error(tmp_path, content):
    (tmp_path / "log.h5").write_bytes(content)
    with pytest.raises(LogError, match="the file is not HDF5"):
        read_hdf5(tmp_path / "log.h5", layout(), name="log.h5")
