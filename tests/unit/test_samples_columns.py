"""Columns made of columns: the same wherever they lie and whatever the length of the blocks."""

import errno
import os
from io import FileIO
from pathlib import Path

import numpy as np
import pytest

from reduction.record import samples as blocks
from reduction.record import samples as intervals
from reduction.record import samples as scratch
from reduction.record.errors import DataError
from reduction.record.samples import (
    ColumnWriter,
    _is_on_disk,
    empty_like,
    interval_labels,
    mean_of,
    median_step_reaches,
    over_intervals,
    scratch_folder,
    select_samples,
    shifted,
    trim_heap_after,
)


@pytest.fixture(params=[1, 2, 7, 1 << 16], ids="blocks of {}".format)
def _short_blocks(monkeypatch, request):
    monkeypatch.setitem(blocks.sample_blocks.__kwdefaults__, "size", request.param)


def on_disk(folder, series):
    writer = ColumnWriter(folder, series.dtype)
    writer.append(series)
    return writer.finish()


@pytest.mark.usefixtures("_short_blocks")
def test_chosen_samples_are_those_of_a_mask_and_lie_beside_the_series(tmp_path, monkeypatch):
    monkeypatch.setattr(scratch, "_ON_DISK_FROM", 1)
    rng = np.random.default_rng(2)
    for n_samples in (1, 2, 13, 50):
        whole = np.arange(n_samples), rng.normal(size=n_samples)
        for mask in (rng.random(n_samples) < 0.5, np.zeros(n_samples, bool)):
            expected = [one[mask] for one in whole]
            for series in (whole, [on_disk(tmp_path, one) for one in whole]):
                found = select_samples(mask.__getitem__, *series)
                for one, wanted, source in zip(found, expected, series, strict=True):
                    np.testing.assert_array_equal(one, wanted)
                    assert one.dtype == wanted.dtype
                    if wanted.size not in (0, n_samples):
                        assert _is_on_disk(one) == _is_on_disk(source)


def test_where_all_samples_are_chosen_nothing_is_copied():
    one, other = np.arange(3), np.arange(3.0)
    found = select_samples(lambda part: one[part] >= 0, one, other)
    assert found[0] is one
    assert found[1] is other


def test_series_of_unequal_length_have_no_samples_in_common():
    mask = np.array([True, False, True])
    with pytest.raises(IndexError, match="boolean index did not match"):
        select_samples(mask.__getitem__, np.arange(3), np.arange(2))


@pytest.mark.usefixtures("_short_blocks")
def test_a_series_is_shifted_and_has_a_mean(tmp_path):
    series = np.arange(40.0)
    for values in (series, on_disk(tmp_path, series)):
        np.testing.assert_array_equal(shifted(values, 2.0), series - 2)
        assert mean_of(values) == 19.5


@pytest.mark.usefixtures("_short_blocks")
def test_a_median_step_is_compared_as_if_it_were_known():
    rng = np.random.default_rng(4)
    for n_steps in (1, 2, 3, 4, 9, 30):
        for _ in range(20):
            steps = rng.integers(1, 5, n_steps) / 4  # ties, and sums are exact
            series = np.concatenate([[0.0], np.cumsum(steps)])
            median = np.median(np.diff(series))
            for factor in (1.0, 1.5, 3.0):
                for value in (*factor * np.unique(steps), factor * median, factor * median + 0.1):
                    expected = bool(factor * median >= value)
                    assert median_step_reaches(series, factor, value) is expected


def test_one_sample_has_no_median_step():
    with pytest.raises(ZeroDivisionError, match="division by zero"):
        median_step_reaches(np.zeros(1), 1.0, 0.0)


# what the samples of intervals come to, wherever these lie and however long they are


@pytest.mark.parametrize("block", [1, 2, 7, 1 << 16])
@pytest.mark.parametrize("operation", [np.add, np.minimum, np.fmax])
def test_intervals_in_any_order_come_to_what_each_comes_to_alone(
    tmp_path, monkeypatch, operation, block
):
    monkeypatch.setattr(intervals, "BLOCK", block)
    rng = np.random.default_rng(3)
    for n_samples in (1, 2, 40, 300):
        series = rng.integers(0, 100, n_samples).astype(np.float64)  # sums are exact
        first = rng.integers(0, n_samples, 50)
        stop = first + 1 + rng.integers(0, n_samples - first)
        alone = [operation.reduce(series[a:b]) for a, b in zip(first, stop, strict=True)]
        for values in (series, on_disk(tmp_path, series)):
            np.testing.assert_array_equal(over_intervals(operation, values, first, stop), alone)


def test_no_intervals_come_to_nothing():
    none = np.empty(0, dtype=np.int64)
    assert over_intervals(np.add, np.arange(3.0), none, none).size == 0
    assert interval_labels(np.zeros(2), none, none, none).tolist() == [0, 0]


def test_a_long_interval_is_let_go_as_it_is_passed(tmp_path, monkeypatch):
    passed = []
    monkeypatch.setattr(intervals, "BLOCK", 10)
    monkeypatch.setattr(blocks, "_SPAN", 40)
    monkeypatch.setattr(blocks, "release_pages", lambda *series: passed.append(len(series)))
    series = on_disk(tmp_path, np.arange(100.0))
    found = over_intervals(np.add, series, np.array([5]), np.array([95]))
    assert found.tolist() == [series[5:95].sum()]
    assert passed == [1] * 6  # behind every second block of 10, behind the last, and at the end


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
