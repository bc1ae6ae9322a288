"""What the samples of intervals come to, wherever these lie and however long they are."""

import numpy as np
import pytest

from reduction.record import samples as blocks
from reduction.record import samples as intervals
from reduction.record.samples import ColumnWriter, interval_labels, over_intervals


def on_disk(folder, series):
    writer = ColumnWriter(folder, series.dtype)
    writer.append(series)
    return writer.finish()


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
