"""HDF5 files that mean harm: each is a function that writes one, by what it does."""

import zlib

import h5py
import numpy as np

N = 30


def _columns(group, without=(), rows=N):
    for name, values in {
        "t": 0.1 * np.arange(rows),
        "x": 1.0 + 0.01 * np.arange(rows),
        "F": 5.0 + np.arange(rows),
    }.items():
        if name not in without:
            group[name] = values


def good(path):
    with h5py.File(path, "w") as file:
        _columns(file)
    return path


def shape_of_a_million_million_in_chunks(path):
    """A column of 10^12 values of which none is stored."""
    with h5py.File(path, "w") as file:
        _columns(file, ["F"])
        file.create_dataset("F", shape=(10**12,), dtype="f8", chunks=(1 << 20,))
    return path


def every_column_ten_to_the_nine(path):
    """Fill values alone; a file of two kilobytes."""
    with h5py.File(path, "w") as file:
        for name in ("t", "x", "F"):
            file.create_dataset(name, shape=(10**9,), dtype="f8", chunks=(1 << 20,), fillvalue=7.0)
    return path


def one_chunk_of_zeros(path, size=1 << 24):
    """A chunk of 128 MB of zeros, deflated, of a column of thirty values."""
    packed = zlib.compress(bytes(8 * size), 1)
    with h5py.File(path, "w") as file:
        _columns(file, ["F"])
        dataset = file.create_dataset(
            "F", shape=(N,), maxshape=(None,), dtype="f8", chunks=(size,), compression="gzip"
        )
        dataset.id.write_direct_chunk((0,), packed)
    return path


def columns_without_end(path, count=3_000):
    with h5py.File(path, "w") as file:
        _columns(file)
        for number in range(count):
            file[f"c{number}"] = [1.0, 2.0]
    return path


def groups_in_a_loop(path):
    with h5py.File(path, "w") as file:
        _columns(file)
        one = file.create_group("one")
        two = one.create_group("two")
        two["one"] = one
        two["root"] = file["/"]
    return path


def _secret(path):
    secret = path.with_name("secret.h5")
    with h5py.File(secret, "w") as file:
        file["F"] = np.full(N, 4711.0)
    return secret


def external_link_on_the_way(path):
    secret = _secret(path)
    with h5py.File(path, "w") as file:
        _columns(file)
        file["elsewhere"] = h5py.ExternalLink(str(secret), "/")
    return path


external_link_on_the_way.layout = 'group = "elsewhere"'


def filter_of_a_stranger(path):
    with h5py.File(path, "w") as file:
        _columns(file, ["F"])
        plist = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
        plist.set_chunk((N,))
        plist.set_filter(32768, h5py.h5z.FLAG_OPTIONAL, (1, 2))
        space = h5py.h5s.create_simple((N,))
        dataset = h5py.h5d.create(file.id, b"F", h5py.h5t.NATIVE_DOUBLE, space, dcpl=plist)
        dataset.write_direct_chunk((0,), b"\0" * 240)
    return path


def name_with_a_nul(path):
    """The name of a column is cut by a NUL in the file."""
    with h5py.File(path, "w") as file:
        _columns(file)
        file["Fxyzzy"] = np.zeros(N)
    data = path.read_bytes().replace(b"Fxyzzy", b"F\0yzzy")
    path.write_bytes(data)
    return path


def attribute_of_twenty_megabytes(path):
    with h5py.File(path, "w", libver="latest") as file:
        _columns(file)
        file.attrs["operator"] = "x" * 20_000_000
    return path


def unit_that_is_a_reference(path):
    with h5py.File(path, "w") as file:
        _columns(file)
        file["F"].attrs["units"] = file["t"].ref
    return path


HDF5 = {
    "log.h5": [
        good, shape_of_a_million_million_in_chunks, every_column_ten_to_the_nine,
        one_chunk_of_zeros, columns_without_end, groups_in_a_loop, external_link_on_the_way,
        filter_of_a_stranger, name_with_a_nul, attribute_of_twenty_megabytes,
        unit_that_is_a_reference,
    ],
}  # fmt: skip
