"""The two kinds of file hold the same log: v5 written by scipy, v7.3 by hand as MATLAB does."""

import h5py
import numpy as np
import pytest
import scipy.io
from binary_layouts import layout_of
from hostile_matlab import opaque_object

from reduction.readers.layout import Layout
from reduction.readers.matlab import open_matlab, read_matlab
from reduction.record.errors import LogError

TIME, LOAD = [0.0, 0.5, 1.0], [1.0, 2.0, 3.0]
HEADER = b"MATLAB 7.3 MAT-file, Platform: GLNXA64"


layout = layout_of("matlab")


class V73:
    """Writes arrays as MATLAB does: axes reversed, text as codes, cells as references."""

    def __init__(self, file):
        self.file, self.count = file, 0

    def put(self, group, name, value):
        kind = "double"
        if isinstance(value, dict):
            made = group.create_group(name)
            for key, entry in value.items():
                self.put(made, key, entry)
            kind = "struct"
        elif isinstance(value, str):
            made = group.create_dataset(name, data=np.array([[ord(c)] for c in value], dtype="u2"))
            kind = "char"
        elif isinstance(value, tuple):
            references = np.empty((1, len(value)), dtype=object)
            for place, entry in enumerate(value):
                self.count += 1
                refs = self.file.require_group("#refs#")
                references[0, place] = self.put(refs, f"r{self.count}", entry).ref
            made = group.create_dataset(name, data=references, dtype=h5py.ref_dtype)
            kind = "cell"
        else:
            values = np.atleast_2d(value)
            if values.dtype == bool:
                values, kind = values.astype("u1"), "logical"
            if values.size == 0:
                values = np.array(values.shape, dtype="u8")
            made = group.create_dataset(name, data=values.T)
            if np.asarray(value).size == 0:
                made.attrs["MATLAB_empty"] = np.uint8(1)
        made.attrs["MATLAB_class"] = np.bytes_(kind)
        return made


def as_v5(value):
    if isinstance(value, dict):
        return {key: as_v5(entry) for key, entry in value.items()}
    return np.array(value, dtype=object) if isinstance(value, tuple) else value


@pytest.fixture(params=["v5", "v7.3"])
def write(request, tmp_path):
    def write(**variables):
        path = tmp_path / "log.mat"
        if request.param == "v5":
            scipy.io.savemat(path, as_v5(variables), oned_as="column", do_compression=True)
            return path
        with h5py.File(path, "w", userblock_size=512) as file:
            writer = V73(file)
            for name, value in variables.items():
                writer.put(file, name, value)
        with path.open("r+b") as stream:
            stream.write(HEADER.ljust(124) + b"\x00\x02IM")
        return path

    return write


def read(path, **settings):
    return read_matlab(path, layout(**settings), name="log.mat")


def column(values):
    return np.array(values)[:, None]


def test_variables_are_columns(write):
    log = read(write(t=column(TIME), F=np.array(LOAD)[None, :], other=np.zeros((2, 2))))
    assert log.columns["time"].tolist() == TIME
    assert log.columns["tension.1"].tolist() == LOAD
    assert log.metadata["header"].startswith("MATLAB")
    assert (log.first_row, log.n_rows_read) == (0, 3)


def test_fields_of_a_struct_are_columns(write):
    path = write(log={"t": column(TIME), "F": column(LOAD)})
    assert read(path, group="log").columns["tension.1"].tolist() == LOAD


def test_a_struct_in_a_struct_is_reached_by_dots(write):
    path = write(run={"log": {"t": column(TIME), "F": column(LOAD)}})
    assert read(path, group="run.log").columns["tension.1"].tolist() == LOAD


def test_columns_of_a_matrix_go_by_number_or_by_the_names_beside_it(write):
    path = write(M=np.column_stack([TIME, LOAD]), names=("t", "F"), units=("s", "N"))
    numbers = {"time": {"column": 1, "unit": "s"}, "tension": {"1": {"column": 2, "unit": "kN"}}}
    assert read(path, matrix="M", channels=numbers).columns["tension.1"].tolist() == LOAD
    assert read(path, matrix="M", matrix_names="names").columns["tension.1"].tolist() == LOAD
    with pytest.raises(LogError, match=r"\[F\]: the unit in the file is not the declared one"):
        read(path, matrix="M", matrix_names="names", matrix_units="units")


def test_the_rows_of_a_wide_matrix_are_the_columns(write):
    """As the block To File of Simulink writes it: a row per signal, the first one the time."""
    path = write(train=np.stack([np.arange(50) / 10, np.arange(50.0) ** 2]))
    channels = {"time": {"column": 1, "unit": "s"}, "tension": {"1": {"column": 2, "unit": "N"}}}
    log = read(path, matrix="train", channels=channels)
    assert (log.n_rows_read, log.columns["time"][-1], log.columns["tension.1"][-1]) == (
        50,
        4.9,
        2401,
    )


def test_a_missing_column_lists_what_there_is(write):
    with pytest.raises(LogError, match=r"'F' is not in the file; found .*'load'"):
        read(write(t=column(TIME), load=column(LOAD)))


def test_a_missing_struct_lists_what_there_is(write):
    with pytest.raises(LogError, match=r"'run' is not in the file; found 't'"):
        read(write(t=column(TIME)), group="run")


def test_a_variable_that_is_no_struct_is_refused(write):
    with pytest.raises(LogError, match="'t' is not a struct"):
        read(write(t=column(TIME)), group="t")


def test_columns_of_two_lengths_are_two_time_bases(write):
    with pytest.raises(LogError, match=r"two time bases; found time 3 values, tension\.1 2 values"):
        read(write(t=column(TIME), F=column(LOAD[:2])))


def test_a_matrix_is_not_one_column(write):
    with pytest.raises(LogError, match="'F' is not one column"):
        read(write(t=column(TIME), F=np.zeros((3, 2))))


@pytest.mark.parametrize("value", ["text", np.array([[True, False, True]]), ("a", "b", "c")])
def test_what_is_no_number_is_an_error(write, value):
    with pytest.raises(LogError, match=r"\[F\]: a column does not hold numbers"):
        read(write(t=column(TIME), F=value))


def test_a_struct_is_no_column(write):
    with pytest.raises(LogError, match=r"not an array|does not hold numbers"):
        read(write(t=column(TIME), F={"a": column(LOAD)}))


def test_empty_variables_are_no_data(write):
    with pytest.raises(LogError, match="there are no data rows"):
        read(write(t=np.zeros((0, 0)), F=np.zeros((0, 0))))


def test_names_that_are_no_text_are_an_error(write):
    with pytest.raises(LogError, match=r"does not hold text"):
        read(write(M=np.zeros((3, 2)), names=np.zeros((1, 2))), matrix="M", matrix_names="names")


def test_cells_that_are_no_text_are_an_error(write):
    path = write(M=np.zeros((3, 2)), names=(np.ones((1, 1)), "b"))
    with pytest.raises(LogError, match="does not hold text"):
        read(path, matrix="M", matrix_names="names")


def test_names_may_be_a_character_matrix(tmp_path):
    path = tmp_path / "log.mat"
    names = np.array(["t   ", "load"])
    scipy.io.savemat(path, {"M": np.column_stack([TIME, LOAD]), "names": names})
    channels = {"tension": {"1": {"column": "load", "unit": "kN"}}}
    log = read(path, matrix="M", matrix_names="names", channels=channels)
    assert log.columns["tension.1"].tolist() == LOAD


def test_version_4_is_read(tmp_path):
    scipy.io.savemat(tmp_path / "log.mat", {"t": TIME, "F": LOAD}, format="4")
    log = read(tmp_path / "log.mat")
    assert log.columns["tension.1"].tolist() == LOAD
    assert log.metadata == {}


def test_an_array_of_structs_is_refused(tmp_path):
    structs = np.array([(1.0, 2.0), (3.0, 4.0)], dtype=[("t", "O"), ("F", "O")])
    scipy.io.savemat(tmp_path / "log.mat", {"log": structs})
    with pytest.raises(LogError, match="'log' is not a struct"):
        read(tmp_path / "log.mat", group="log")


def test_a_sparse_matrix_is_refused(tmp_path):
    sparse = scipy.sparse.eye(3).tocsc()
    scipy.io.savemat(tmp_path / "log.mat", {"t": TIME, "F": sparse})
    with pytest.raises(LogError, match="'F' is not an array; found a sparse matrix"):
        read(tmp_path / "log.mat")


def test_a_damaged_variable_is_an_error(tmp_path):
    path = tmp_path / "log.mat"
    values = np.random.default_rng(1).random(500)
    scipy.io.savemat(path, {"t": values, "F": values})
    content = path.read_bytes()
    path.write_bytes(content[: len(content) - 1000])
    with pytest.raises(
        LogError, match=r"not a MATLAB file that can be read|variable .* cannot be read"
    ):
        read(path)


@pytest.mark.parametrize(
    "content", [b"garbage" * 50, b"MATLAB 5.0 MAT-file".ljust(124) + b"\xff" * 300]
)
def test_a_file_that_is_no_matlab_file_is_an_error(tmp_path, content):
    (tmp_path / "log.mat").write_bytes(content)
    with pytest.raises(LogError, match="not a MATLAB file that can be read"):
        read(tmp_path / "log.mat")


def test_an_old_file_in_a_byte_order_of_its_own_day_is_refused(tmp_path):
    path = tmp_path / "log.mat"
    scipy.io.savemat(path, {"t": np.array([TIME]).T, "F": np.array([LOAD]).T}, format="4")
    data = path.read_bytes()
    # the thousands of the first number say how numbers are written: 4 is a Cray
    path.write_bytes((4000).to_bytes(4, "little") + data[4:])
    with pytest.raises(
        LogError,
        match="not a MATLAB file that can be read; .*We do not support byte ordering 'Cray'",
    ):
        read_matlab(path, layout(), name="log.mat")


def test_an_object_of_one_of_matlabs_own_classes_hides_no_variable_beside_it(tmp_path):
    path = tmp_path / "log.mat"
    opaque_object(path)
    channels = {
        "time": {"column": "t", "unit": "s"},
        "crosshead_position": {"column": "x", "unit": "m", "datum": "pin-to-pin"},
    }
    found = read_matlab(path, Layout(format="matlab", channels=channels), name="log.mat")
    np.testing.assert_array_equal(found.columns["time"], 0.1 * np.arange(30))


def test_a_variable_is_found_among_many(tmp_path):
    path = tmp_path / "log.mat"
    held = {f"v{place}": np.full((5, 1), float(place)) for place in range(40)}
    scipy.io.savemat(path, held, do_compression=True)
    with open_matlab(path) as scope:
        assert list(scope) == list(held)
        np.testing.assert_array_equal(scope["v27"], held["v27"])
