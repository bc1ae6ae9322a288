"""Heaps of texts in HDF5 files, among them those along which HDF5 2.0.0 walks without end."""

import struct

import h5py
import pytest

from reduction import globalheap as module
from reduction.archive.open import open_archive
from reduction.errors import ArchiveError

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
    assert endless_heap(good) == f"a heap of texts at byte {begin:,} that has no end"


def test_a_heap_is_found_wherever_a_block_of_the_file_ends(good, monkeypatch):
    begin = stated(good, FREE, 0)
    for block in range(begin - 1, begin + 10):
        monkeypatch.setattr(module, "_BLOCK", block)
        assert endless_heap(good) is not None


def test_the_work_has_a_bound(good):
    assert endless_heap(good, most=4) is None
    assert endless_heap(good, most=3) == "more than 3 texts of any length"


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


def test_an_archive_with_such_a_heap_is_refused(good):
    stated(good, FREE, 0)
    with pytest.raises(ArchiveError, match="not made as an archive is; found a heap of texts"):
        open_archive(good)
