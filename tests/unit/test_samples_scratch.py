import errno
import os
from io import FileIO
from pathlib import Path

import numpy as np
import pytest

from reduction.record import samples as scratch
from reduction.record.errors import DataError
from reduction.record.samples import (
    ColumnWriter,
    _is_on_disk,
    empty_like,
    scratch_folder,
    trim_heap_after,
)


@pytest.mark.parametrize("kind", [np.float64, np.int64, np.uint16])
@pytest.mark.parametrize("sizes", [[], [0], [3], [1, 0, 4], [70_000, 5]])
def test_a_column_is_the_same_in_memory_and_on_disk(tmp_path, kind, sizes):
    rng = np.random.default_rng(1)
    parts = [rng.integers(0, 1000, size).astype(kind) for size in sizes]
    expected = np.concatenate([np.empty(0, kind), *parts])
    for folder in (None, tmp_path):
        writer = ColumnWriter(folder, kind)
        for part in parts:
            writer.append(part)
        assert writer.size == expected.size
        column = writer.finish()
        np.testing.assert_array_equal(column, expected)
        assert (column.dtype, _is_on_disk(column)) == (kind, bool(folder and expected.size))
    assert list(tmp_path.iterdir()) == []


def test_a_column_can_be_written_to_although_its_part_could_not():
    part = np.ones(3)
    part.flags.writeable = False
    writer = ColumnWriter(None)
    writer.append(part)
    assert writer.finish().flags.writeable


def test_parts_of_another_kind_or_order_are_made_the_column_s(tmp_path):
    writer = ColumnWriter(tmp_path)
    writer.append(np.arange(6, dtype=np.int16)[::2])
    writer.append(np.array([7.0], dtype=">f8"))
    assert writer.finish().tolist() == [0, 2, 4, 7]


def test_a_disk_that_fills_takes_what_it_can(tmp_path, monkeypatch):
    class Slow(FileIO):
        def write(self, data):
            return super().write(data[:5])

    monkeypatch.setattr(scratch, "_scratch_file", lambda folder: Slow(folder / "x", "w+"))
    writer = ColumnWriter(tmp_path)
    writer.append(np.arange(4.0))
    assert writer.finish().tolist() == [0, 1, 2, 3]


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no device that is always full")
def test_a_full_disk_is_told_with_what_to_do(tmp_path, monkeypatch):
    monkeypatch.setattr(scratch, "_scratch_file", lambda _: FileIO("/dev/full", "w"))
    with pytest.raises(
        DataError,
        match=r"scratch files of a long log do not fit on the disk; found no room for 8 MB in "
        r".*: No space left on device; needed about 60 bytes a row and specimen\. Set TMPDIR",
    ):
        ColumnWriter(tmp_path).append(np.zeros(1_000_000))


def test_a_disk_without_the_room_of_an_array_is_told(tmp_path, monkeypatch):
    def full(*_):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    writer = ColumnWriter(tmp_path)
    writer.append(np.zeros(1 << 18))
    column = writer.finish()
    monkeypatch.setattr(os, "posix_fallocate", full)
    with pytest.raises(DataError, match="no room for 2 MB .*No space left on device"):
        empty_like(column)


@pytest.mark.parametrize("stated", ["here", "not-there"])
def test_the_folder_that_is_stated_is_the_one_whatever_it_is(tmp_path, monkeypatch, stated):
    monkeypatch.setenv("TMPDIR", str(tmp_path / stated))
    assert scratch_folder() == tmp_path / stated
    monkeypatch.setenv("TMPDIR", "")
    assert scratch_folder() != tmp_path / stated


def test_a_limit_on_address_space_is_told(tmp_path, monkeypatch):
    def refused(*_):
        raise OSError(errno.ENOMEM, os.strerror(errno.ENOMEM))

    monkeypatch.setattr(scratch, "_ScratchMap", refused)
    writer = ColumnWriter(tmp_path)
    writer.append(np.zeros(1 << 18))
    with pytest.raises(DataError, match=r"cannot be mapped; found 2 MB: .*; needed .* ulimit -v"):
        writer.finish()


def test_a_folder_that_is_not_there_is_told(tmp_path):
    with pytest.raises(DataError, match="no scratch file can be made for a long log; found .*no"):
        ColumnWriter(tmp_path / "no")


def test_what_stages_of_a_long_series_have_freed_is_given_back(tmp_path, monkeypatch):
    asked = []
    monkeypatch.setattr(scratch, "_MALLOC_TRIM", asked.append)
    writer = ColumnWriter(tmp_path)
    writer.append(np.zeros(3))
    long = np.empty(scratch._LONG, dtype=bool)
    trim_heap_after(np.zeros(3), long[1:])
    assert asked == []
    for arrays in ([long], [np.zeros(3), long], [writer.finish()]):
        trim_heap_after(*arrays)
    assert asked == [0, 0, 0]


def test_no_system_but_one_is_asked_to_give_back(monkeypatch):
    monkeypatch.setattr(scratch, "_MALLOC_TRIM", None)
    trim_heap_after(np.empty(scratch._LONG, dtype=bool))
