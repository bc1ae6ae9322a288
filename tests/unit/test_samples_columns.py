"""Columns made of columns: the same wherever they lie and whatever the length of the blocks."""

import numpy as np
import pytest

from reduction.record import samples as blocks
from reduction.record import samples as scratch
from reduction.record.samples import (
    ColumnWriter,
    _is_on_disk,
    mean_of,
    median_step_reaches,
    select_samples,
    shifted,
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
