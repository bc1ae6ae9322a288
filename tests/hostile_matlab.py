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


def _matrix(name, values, dims=None, kind=6, n_bytes=None, length=None, flags=0):
    """An array of doubles that may lie about its shape, its bytes, and its length."""
    data = np.asarray(values, dtype="<f8").tobytes()
    dims = (np.size(values), 1) if dims is None else dims
    body = _element(6, struct.pack("<II", kind | flags, 0))
    body += _element(5, struct.pack(f"<{len(dims)}i", *dims))
    body += _element(1, name)
    body += _element(9, data, n_bytes)
    return _element(14, body, length)


def _good_but_force():
    return b"".join(_matrix(name.encode(), _COLUMNS[name]) for name in ("t", "x"))


def _with(path, force):
    path.write_bytes(_HEADER + _good_but_force() + force)
    return path


def _compressed(size, head=b""):
    packer = zlib.compressobj(1)
    packed = packer.compress(head)
    zeros = bytes(_MEGA)
    for _ in range(size):
        packed += packer.compress(zeros)
    return packed + packer.flush()


def bomb(path, size=100):
    """A column of zeros that inflates to 100 MB."""
    n = size * _MEGA // 8
    head = _element(6, struct.pack("<II", 6, 0)) + _element(5, struct.pack("<ii", n, 1))
    head += _element(1, b"F") + struct.pack("<II", 9, 8 * n & 0xFFFFFFFF)
    head = struct.pack("<II", 14, (len(head) + 8 * n) & 0xFFFFFFFF) + head
    packed = _compressed(size, head)
    return _with(path, struct.pack("<II", 15, len(packed)) + packed)


def bomb_of_two_hundred_megabytes(path):
    return bomb(path, 200)


def bomb_of_blanks_behind_a_column(path, size=100):
    """A good column, and 100 MB behind it in the same deflated element."""
    packed = _compressed(size, _matrix(b"F", _COLUMNS["F"]))
    return _with(path, struct.pack("<II", 15, len(packed)) + packed)


def bomb_in_another_variable(path):
    """What is not asked for is not inflated."""
    n = 100 * _MEGA // 8
    head = _element(6, struct.pack("<II", 6, 0)) + _element(5, struct.pack("<ii", n, 1))
    head += _element(1, b"G") + struct.pack("<II", 9, 8 * n)
    packed = _compressed(100, struct.pack("<II", 14, len(head) + 8 * n) + head)
    return _with(path, struct.pack("<II", 15, len(packed)) + packed + _matrix(b"F", _COLUMNS["F"]))


def shape_of_two_thousand_million(path):
    return _with(path, _matrix(b"F", _COLUMNS["F"], dims=(2**31 - 1, 1)))


def shape_that_overflows(path):
    return _with(path, _matrix(b"F", _COLUMNS["F"], dims=(2**31 - 1, 2**31 - 1, 2**31 - 1)))


def shape_below_zero(path):
    return _with(path, _matrix(b"F", _COLUMNS["F"], dims=(-30, 1)))


def thousand_dimensions(path):
    return _with(path, _matrix(b"F", _COLUMNS["F"], dims=(1,) * 1000 + (N,)))


def element_longer_than_the_file(path):
    return _with(path, _matrix(b"F", _COLUMNS["F"], n_bytes=0xFFFFFFF0))


def element_of_three_gigabytes(path):
    return _with(path, _matrix(b"F", _COLUMNS["F"], n_bytes=3_000_000_000))


def matrix_longer_than_the_file(path):
    return _with(path, _matrix(b"F", _COLUMNS["F"], length=0xFFFFFFF0))


def matrix_shorter_than_it_is(path):
    return _with(path, _matrix(b"F", _COLUMNS["F"], length=64))


def matrix_of_no_length(path):
    """A reader that steps by what is stated stands still."""
    return _with(path, _matrix(b"F", _COLUMNS["F"], length=0))


def name_without_end(path):
    body = _element(6, struct.pack("<II", 6, 0)) + _element(5, struct.pack("<ii", N, 1))
    body += _element(1, b"F", 0xFFFFFFF0) + _element(9, _COLUMNS["F"].tobytes())
    return _with(path, _element(14, body))


def complex_numbers(path):
    scipy.io.savemat(path, _COLUMNS | {"F": _COLUMNS["F"] * 1j})
    return path


def nested_cells(path, depth=2000):
    """A cell in a cell in a cell; a reader that calls itself runs out of stack."""
    inner = _matrix(b"", [1.0])
    for _ in range(depth):
        body = _element(6, struct.pack("<II", 1, 0)) + _element(5, struct.pack("<ii", 1, 1))
        inner = _element(14, body + _element(1, b"") + inner)
    body = _element(6, struct.pack("<II", 1, 0)) + _element(5, struct.pack("<ii", 1, 1))
    return _with(path, _element(14, body + _element(1, b"F") + inner))


def cells_nested_a_hundred_thousand_times(path):
    tails, size = [], len(_matrix(b"", [1.0]))
    parts = [_matrix(b"", [1.0])]
    head = _element(6, struct.pack("<II", 1, 0)) + _element(5, struct.pack("<ii", 1, 1))
    head += _element(1, b"")
    for _ in range(100_000):
        parts.append(struct.pack("<II", 14, len(head) + size) + head)
        size += 8 + len(head)
    body = _element(6, struct.pack("<II", 1, 0)) + _element(5, struct.pack("<ii", 1, 1))
    body += _element(1, b"F") + b"".join(reversed(parts)) + b"".join(tails)
    return _with(path, _element(14, body))


def cells_that_claim_to_be_many(path):
    """A cell array of 2^31 cells of which none is there."""
    body = _element(6, struct.pack("<II", 1, 0)) + _element(5, struct.pack("<ii", 2**31 - 1, 1))
    return _with(path, _element(14, body + _element(1, b"F")))


def struct_that_claims_to_be_large(path):
    body = _element(6, struct.pack("<II", 2, 0)) + _element(5, struct.pack("<ii", 2**31 - 1, 1))
    body += _element(1, b"F") + struct.pack("<IHH", 5, 4, 0)[:0]
    body += struct.pack("<HHi", 5, 4, 32) + _element(1, b"a".ljust(32, b"\0"))
    return _with(path, _element(14, body))


def struct_of_structs(path):
    value = {"a": 1.0}
    for _ in range(25):
        value = {"a": value}
    scipy.io.savemat(path, _COLUMNS | {"F": value})
    return path


def text_for_numbers(path):
    scipy.io.savemat(path, _COLUMNS | {"F": np.array(["7 kN"] * N)})
    return path


def function_handle(path):
    """As MATLAB writes @(x) system('reboot')."""
    body = _element(6, struct.pack("<II", 16, 0)) + _element(5, struct.pack("<ii", 1, 1))
    body += _element(1, b"F") + _matrix(b"", [1.0])
    return _with(path, _element(14, body))


def opaque_object(path):
    body = _element(6, struct.pack("<II", 17, 0)) + _element(1, b"F") + _element(1, b"MCOS")
    body += _element(1, b"table") + _matrix(b"", [1.0])
    return _with(path, _element(14, body))


def java_object(path):
    """What a Java object is stored as: serialised, which nothing here may undo."""
    body = _element(6, struct.pack("<II", 17, 0)) + _element(1, b"F") + _element(1, b"java")
    body += _element(1, b"java.util.HashMap") + _matrix(b"", [1.0])
    return _with(path, _element(14, body))


def sparse(path):
    body = _element(6, struct.pack("<II", 5, 0xFFFFFFFF))
    body += _element(5, struct.pack("<ii", 2**31 - 1, 2**31 - 1)) + _element(1, b"F")
    body += _element(5, struct.pack("<i", 0)) + _element(5, struct.pack("<i", 0))
    body += _element(9, struct.pack("<d", 1.0))
    return _with(path, _element(14, body))


def _numbers_of_no_type(name):
    """A matrix whose numbers are of type 55156; scipy takes it for a place in a table of 40."""
    return _matrix(name, [1.0]).replace(struct.pack("<II", 9, 8), struct.pack("<II", 55156, 8))


def numbers_of_no_type(path):
    return _with(path, _numbers_of_no_type(b"F"))


def numbers_of_no_type_in_a_cell(path):
    body = _element(6, struct.pack("<II", 1, 0)) + _element(5, struct.pack("<ii", 1, 1))
    return _with(path, _element(14, body + _element(1, b"F") + _numbers_of_no_type(b"")))


def numbers_of_no_type_in_a_handle_in_a_cell(path):
    handle = _element(6, struct.pack("<II", 16, 0)) + _element(5, struct.pack("<ii", 1, 1))
    handle = _element(14, handle + _element(1, b"") + _numbers_of_no_type(b""))
    body = _element(6, struct.pack("<II", 1, 0)) + _element(5, struct.pack("<ii", 1, 1))
    return _with(path, _element(14, body + _element(1, b"F") + handle))


def imaginary_numbers_of_no_type_in_a_cell(path):
    inner = _element(6, struct.pack("<II", 6 | 0x0800, 0)) + _element(5, struct.pack("<ii", 1, 1))
    inner += _element(1, b"") + _element(9, struct.pack("<d", 1.0))
    inner = _element(14, inner + _element(55156, struct.pack("<d", 1.0)))
    body = _element(6, struct.pack("<II", 1, 0)) + _element(5, struct.pack("<ii", 1, 1))
    return _with(path, _element(14, body + _element(1, b"F") + inner))


def sparse_of_no_type_in_a_cell(path):
    inner = _element(6, struct.pack("<II", 5, 1)) + _element(5, struct.pack("<ii", 1, 1))
    inner += _element(1, b"") + _element(55156, struct.pack("<i", 0))
    inner += _element(5, struct.pack("<i", 0)) + _element(9, struct.pack("<d", 1.0))
    body = _element(6, struct.pack("<II", 1, 0)) + _element(5, struct.pack("<ii", 1, 1))
    return _with(path, _element(14, body + _element(1, b"F") + _element(14, inner)))


def variables_without_end(path, count=5_000):
    return _with(
        path,
        b"".join(_matrix(f"c{i}".encode(), [1.0, 2.0]) for i in range(count))
        + _matrix(b"F", _COLUMNS["F"]),
    )


def same_variable_twice(path):
    return _with(path, _matrix(b"F", _COLUMNS["F"]) + _matrix(b"F", -_COLUMNS["F"]))


def _v4(name, values, rows=None, columns=1, kind=0):
    rows = len(values) if rows is None else rows
    head = struct.pack("<iiiii", kind, rows, columns, 0, len(name) + 1)
    return head + name + b"\0" + np.asarray(values, dtype="<f8").tobytes()


def _v4_with(path, force):
    path.write_bytes(b"".join(_v4(n.encode(), _COLUMNS[n]) for n in ("t", "x")) + force)
    return path


def v4(path):
    return _v4_with(path, _v4(b"F", _COLUMNS["F"]))


def v4_of_two_thousand_million_rows(path):
    return _v4_with(path, _v4(b"F", _COLUMNS["F"], rows=2**31 - 1))


def v4_that_overflows(path):
    return _v4_with(path, _v4(b"F", _COLUMNS["F"], rows=2**31 - 1, columns=2**31 - 1))


def v4_of_rows_below_zero(path):
    return _v4_with(path, _v4(b"F", _COLUMNS["F"], rows=-30))


def v4_of_rows_that_lead_back(path):
    """The next variable is said to begin where this one does."""
    return _v4_with(path, _v4(b"F", [], rows=-1, columns=3)[: -0 or None])


def v4_of_a_name_without_end(path):
    force = bytearray(_v4(b"F", _COLUMNS["F"]))
    struct.pack_into("<i", force, 16, 2**31 - 1)
    return _v4_with(path, bytes(force))


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


def _force(file, values=None, kind="double", **storage):
    del file["F"]
    dataset = file.create_dataset("F", data=values, **storage)
    dataset.attrs["MATLAB_class"] = np.bytes_(kind)
    return dataset


def v73(path):
    return _v73(path, lambda file: None)


def v73_of_a_million_million(path):
    return _v73(path, lambda file: _force(file, shape=(1, 10**12), dtype="f8", chunks=(1, 1 << 20)))


def v73_of_two_thousand_million_characters(path):
    return _v73(
        path,
        lambda file: _force(
            file, kind="char", shape=(1, 2 * 10**9), dtype="u2", chunks=(1, 1 << 20)
        ),
    )


def v73_cells_that_refer_to_themselves(path):
    def write(file):
        dataset = _force(file, shape=(1, N), dtype=h5py.ref_dtype, kind="cell")
        dataset[...] = dataset.ref

    return _v73(path, write)


def v73_cells_that_refer_to_a_bomb(path):
    def write(file):
        text = file.create_dataset("#refs#/a", shape=(1, 10**10), dtype="u2", chunks=(1, 1 << 20))
        text.attrs["MATLAB_class"] = np.bytes_("char")
        dataset = _force(file, shape=(1, N), dtype=h5py.ref_dtype, kind="cell")
        dataset[...] = text.ref

    return _v73(path, write)


def v73_structs_in_a_loop(path):
    def write(file):
        group = file.create_group("s")
        group["s"] = group

    return _v73(path, write)


def v73_class_of_no_text(path):
    def write(file):
        file["F"].attrs["MATLAB_class"] = b"\xff\xfe"

    return _v73(path, write)


def v73_class_of_numbers(path):
    def write(file):
        file["F"].attrs["MATLAB_class"] = np.arange(1000)
        file["F"].attrs["MATLAB_empty"] = np.arange(3)

    return _v73(path, write)


def text_without_end_for_a_name(path):
    path.write_bytes(_HEADER + b"\xff" * 100_000)
    return path


def nothing_but_zeros(path):
    path.write_bytes(bytes(1000))
    return path


MATLAB = {
    "log.mat": [
        good, bomb, bomb_of_two_hundred_megabytes, bomb_of_blanks_behind_a_column,
        bomb_in_another_variable, shape_of_two_thousand_million, shape_that_overflows,
        shape_below_zero, thousand_dimensions, element_longer_than_the_file,
        element_of_three_gigabytes, matrix_longer_than_the_file, matrix_shorter_than_it_is,
        matrix_of_no_length, name_without_end, complex_numbers, nested_cells,
        cells_nested_a_hundred_thousand_times, cells_that_claim_to_be_many,
        struct_that_claims_to_be_large, struct_of_structs, text_for_numbers, function_handle,
        opaque_object, java_object, sparse, numbers_of_no_type, numbers_of_no_type_in_a_cell,
        numbers_of_no_type_in_a_handle_in_a_cell, imaginary_numbers_of_no_type_in_a_cell,
        sparse_of_no_type_in_a_cell, variables_without_end, same_variable_twice, v4,
        v4_of_two_thousand_million_rows, v4_that_overflows, v4_of_rows_below_zero,
        v4_of_rows_that_lead_back, v4_of_a_name_without_end, v4_sparse, v73,
        v73_of_a_million_million, v73_of_two_thousand_million_characters,
        v73_cells_that_refer_to_themselves, v73_cells_that_refer_to_a_bomb, v73_structs_in_a_loop,
        v73_class_of_no_text, v73_class_of_numbers, text_without_end_for_a_name, nothing_but_zeros,
    ],
}  # fmt: skip
