"""MATLAB files that mean harm: each is a function that writes one, by what it does."""

import struct
import zlib

import h5py
import numpy as np
import scipy.io

N = 30
_MEGA = 1 << 20
_HEADER = b"MATLAB 5.0 MAT-file".ljust(116) + b"\0" * 8 + b"\x00\x01IM"
_COLUMNS = {"t": 0.1 * np.arange(N), "x": 1.0 + 0.01 * np.arange(N), "F": 5.0 + np.arange(N)}


def good(path):
    scipy.io.savemat(path, _COLUMNS)
    return path


def _element(kind, data, n_bytes=None):
    n_bytes = len(data) if n_bytes is None else n_bytes
    return struct.pack("<II", kind, n_bytes) + data + b"\0" * (-len(data) % 8)


def _matrix(name, values, dims=None, n_bytes=None, length=None):
    """An array of doubles that may lie about its shape, its bytes, and its length."""
    data = np.asarray(values, dtype="<f8").tobytes()
    dims = (np.size(values), 1) if dims is None else dims
    body = _element(6, struct.pack("<II", 6, 0))
    body += _element(5, struct.pack(f"<{len(dims)}i", *dims))
    body += _element(1, name)
    body += _element(9, data, n_bytes)
    return _element(14, body, length)


def _with(path, force):
    others = b"".join(_matrix(name.encode(), _COLUMNS[name]) for name in ("t", "x"))
    path.write_bytes(_HEADER + others + force)
    return path


def _zeros(name):
    """A column of zeros that inflates to 100 MB."""
    n = 100 * _MEGA // 8
    head = _element(6, struct.pack("<II", 6, 0)) + _element(5, struct.pack("<ii", n, 1))
    head += _element(1, name) + struct.pack("<II", 9, 8 * n)
    packed = zlib.compress(struct.pack("<II", 14, len(head) + 8 * n) + head + bytes(8 * n), 1)
    return struct.pack("<II", 15, len(packed)) + packed


def bomb(path):
    return _with(path, _zeros(b"F"))


def bomb_in_another_variable(path):
    """What is not asked for is not inflated."""
    return _with(path, _zeros(b"G") + _matrix(b"F", _COLUMNS["F"]))


def shape_below_zero(path):
    return _with(path, _matrix(b"F", _COLUMNS["F"], dims=(-30, 1)))


def element_longer_than_the_file(path):
    return _with(path, _matrix(b"F", _COLUMNS["F"], n_bytes=0xFFFFFFF0))


def matrix_of_no_length(path):
    """A reader that steps by what is stated stands still."""
    return _with(path, _matrix(b"F", _COLUMNS["F"], length=0))


def complex_numbers(path):
    scipy.io.savemat(path, _COLUMNS | {"F": _COLUMNS["F"] * 1j})
    return path


def cells_nested_a_hundred_thousand_times(path):
    parts = [_matrix(b"", [1.0])]
    size = len(parts[0])
    head = _element(6, struct.pack("<II", 1, 0)) + _element(5, struct.pack("<ii", 1, 1))
    head += _element(1, b"")
    for _ in range(100_000):
        parts.append(struct.pack("<II", 14, len(head) + size) + head)
        size += 8 + len(head)
    body = _element(6, struct.pack("<II", 1, 0)) + _element(5, struct.pack("<ii", 1, 1))
    body += _element(1, b"F") + b"".join(reversed(parts))
    return _with(path, _element(14, body))


def opaque_object(path):
    body = _element(6, struct.pack("<II", 17, 0)) + _element(1, b"F") + _element(1, b"MCOS")
    body += _element(1, b"table") + _matrix(b"", [1.0])
    return _with(path, _element(14, body))


def numbers_of_no_type_in_a_cell(path):
    """Numbers of type 55156, which scipy takes for a place in a table of 40."""
    inner = _matrix(b"", [1.0]).replace(struct.pack("<II", 9, 8), struct.pack("<II", 55156, 8))
    body = _element(6, struct.pack("<II", 1, 0)) + _element(5, struct.pack("<ii", 1, 1))
    return _with(path, _element(14, body + _element(1, b"F") + inner))


def same_variable_twice(path):
    return _with(path, _matrix(b"F", _COLUMNS["F"]) + _matrix(b"F", -_COLUMNS["F"]))


def _v4(name, values, rows=None, columns=1, kind=0):
    rows = len(values) if rows is None else rows
    head = struct.pack("<iiiii", kind, rows, columns, 0, len(name) + 1)
    return head + name + b"\0" + np.asarray(values, dtype="<f8").tobytes()


def _v4_with(path, force):
    path.write_bytes(b"".join(_v4(n.encode(), _COLUMNS[n]) for n in ("t", "x")) + force)
    return path


def v4_of_two_thousand_million_rows(path):
    return _v4_with(path, _v4(b"F", _COLUMNS["F"], rows=2**31 - 1))


def v4_sparse(path):
    values = np.array([[2.0**31, 2.0**31, 0.0]]).ravel()
    return _v4_with(path, _v4(b"F", values, rows=1, columns=3, kind=2))


def _v73(path, write):
    with h5py.File(path, "w", userblock_size=512) as file:
        for name, values in _COLUMNS.items():
            file[name] = values.reshape(1, -1)
            file[name].attrs["MATLAB_class"] = np.bytes_("double")
        write(file)
    head = b"MATLAB 7.3 MAT-file".ljust(124) + b"\x00\x02IM"
    with path.open("rb+") as stream:
        stream.write(head)
    return path


def _force(file, kind="double", **storage):
    del file["F"]
    dataset = file.create_dataset("F", **storage)
    dataset.attrs["MATLAB_class"] = np.bytes_(kind)
    return dataset


def v73_of_a_million_million(path):
    return _v73(path, lambda file: _force(file, shape=(1, 10**12), dtype="f8", chunks=(1, 1 << 20)))


def v73_cells_that_refer_to_themselves(path):
    def write(file):
        dataset = _force(file, shape=(1, N), dtype=h5py.ref_dtype, kind="cell")
        dataset[...] = dataset.ref

    return _v73(path, write)


def v73_class_of_no_text(path):
    def write(file):
        file["F"].attrs["MATLAB_class"] = b"\xff\xfe"

    return _v73(path, write)


MATLAB = {
    "log.mat": [
        good, bomb, bomb_in_another_variable, shape_below_zero,
        element_longer_than_the_file, matrix_of_no_length, complex_numbers,
        cells_nested_a_hundred_thousand_times, opaque_object, numbers_of_no_type_in_a_cell,
        same_variable_twice, v4_of_two_thousand_million_rows, v4_sparse,
        v73_of_a_million_million, v73_cells_that_refer_to_themselves, v73_class_of_no_text,
    ],
}  # fmt: skip
