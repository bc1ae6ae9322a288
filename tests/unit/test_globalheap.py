"""Global heaps of HDF5 files, among them those along which HDF5 2.0.0 walks without end."""

import errno
import os
import struct

import h5py
import pytest

from reduction import globalheap as module
from reduction.archive.open import open_archive
from reduction.errors import ArchiveError, LogError
from reduction.ingest import hdf5file
from reduction.ingest.hdf5file import open_hdf5
from reduction.ingest.limits import Limits, Watch

TEXTS = ("s", "mm", "N")
# places from the beginning of the heap of objects 1 to 3, and of what is free
OBJECTS, FREE = (16, 40, 64), 88


@pytest.fixture
def good(tmp_path):
    path = tmp_path / "A.h5"
    with h5py.File(path, "w") as file:
        for text in TEXTS:
            file.create_dataset(f"as {text}", data=[1.0, 2.0]).attrs["units"] = text
    assert path.read_bytes().count(b"GCOL") == 1
    return path


def endless_heap(path, *rest, **options):
    with path.open("rb") as file:
        return module.endless_heap(file, *rest, **options)


def stated(path, place, size):
    data = bytearray(path.read_bytes())
    begin = data.find(b"GCOL")
    data[begin + place + 8 : begin + place + 16] = struct.pack("<Q", size)
    path.write_bytes(data)
    return begin


def test_a_good_file_has_none(good):
    assert endless_heap(good) is None


@pytest.mark.parametrize(
    ("place", "size"),
    # of these the library hangs with the second, third, fifth and sixth, and refuses the others
    [
        (OBJECTS[0], 2**64 - 32), (OBJECTS[0], 2**64 - 16), (OBJECTS[0], 0), (OBJECTS[1], 5000),
        (FREE, 8), (FREE, 0), (FREE, 2**64 - 24),
    ],
)  # fmt: skip
def test_a_size_that_leads_back_or_out_of_the_heap_is_told(place, size, good):
    begin = stated(good, place, size)
    assert endless_heap(good) == f"a global heap at byte {begin:,} that has no end"


def test_a_heap_is_found_wherever_a_block_of_the_file_ends(good, monkeypatch):
    begin = stated(good, FREE, 0)
    for block in range(begin - 1, begin + 10):
        monkeypatch.setattr(module, "_BLOCK", block)
        assert endless_heap(good) is not None


def test_bytes_that_the_library_does_not_look_at_hide_no_heap(good):
    begin = stated(good, FREE, 0)
    data = bytearray(good.read_bytes())
    data[begin + 5] = 1
    good.write_bytes(data)
    assert endless_heap(good) is not None


def test_heaps_that_lie_in_each_other_are_not_walked_again_and_again(good):
    """Each is the data of an object of those before it, and as long as they are from there on."""

    def made(n_heaps):
        n_bytes = 16 + 32 * n_heaps
        heaps = [b"GCOL\1\0\0\0" + struct.pack("<Q", n_bytes - at) for at in range(0, n_bytes, 32)]
        good.write_bytes((b"\1" + bytes(7) + struct.pack("<Q", 16)).join(heaps))
        assert good.stat().st_size == n_bytes
        return endless_heap(good)

    assert made(4) is None
    assert "that lie in each other" in made(100)


def test_a_log_with_millions_of_texts_is_looked_at_whole(tmp_path):
    path, asked = tmp_path / "A.h5", []
    with h5py.File(path, "w") as file:
        file["comment"] = [f"sample {number}" for number in range(20_000)]
    assert endless_heap(path, meanwhile=lambda: asked.append(1)) is None
    assert len(asked) >= 4
    with (
        pytest.raises(LogError, match="takes too long"),
        open_hdf5(path, Watch(path, Limits(time=0))),
    ):
        pass


def test_what_the_system_refuses_is_not_told_as_damage(good, monkeypatch):
    def refused(*_, **options):
        raise OSError(errno.EIO, os.strerror(errno.EIO))

    monkeypatch.setattr(hdf5file, "endless_heap", refused)
    with pytest.raises(OSError, match="Input/output error") as raised, open_hdf5(good):
        pass
    assert type(raised.value) is OSError


def test_a_heap_that_the_file_does_not_hold_is_left_to_the_library(good):
    stated(good, 0, 2**63)
    assert endless_heap(good) is None
    with h5py.File(good) as file, pytest.raises(OSError, match="EOA|heap"):
        file["as s"].attrs["units"]


def test_lengths_may_be_of_four_bytes(tmp_path):
    path = tmp_path / "A.h5"
    made = h5py.h5p.create(h5py.h5p.FILE_CREATE)
    made.set_sizes(4, 4)
    with h5py.File(h5py.h5f.create(bytes(path), fcpl=made)) as file:
        for text in TEXTS:
            file.create_dataset(text, data=[1.0]).attrs["units"] = text
    assert endless_heap(path, 4) is None
    data = bytearray(path.read_bytes())
    # twelve bytes of a header are padded to sixteen, and so is an object
    begin = data.find(b"GCOL")
    assert data[begin + 16 : begin + 18] == b"\1\0" and data[begin + 24 : begin + 28] == b"\1\0\0\0"
    data[begin + 28 : begin + 32] = b"\xff" * 4
    path.write_bytes(data)
    assert endless_heap(path, 4) is None and endless_heap(path, 8) is not None
    data[begin + 24 : begin + 28] = struct.pack("<I", 2**32 - 16)
    path.write_bytes(data)
    assert endless_heap(path, 4) is not None


def test_an_archive_with_such_a_heap_is_refused(good):
    stated(good, FREE, 0)
    with pytest.raises(ArchiveError, match="not made as an archive is; found a global heap"):
        open_archive(good)
