"""Block means that grow with time."""

import numpy as np
import pytest

from reduction.record.errors import DataError
from reduction.stages.holds.relaxation_numbers import logarithmic_blocks


def test_blocks_keep_the_sum_of_the_series():
    time = np.arange(1.0, 5001.0)
    values = np.random.default_rng(0).standard_normal(5000)
    blocks = logarithmic_blocks(time, values)
    assert blocks.count.sum() == 5000
    assert blocks.count @ blocks.value == pytest.approx(values.sum())
    assert np.all(np.diff(blocks.elapsed) > 0)


def test_a_night_becomes_a_few_hundred_blocks():
    time = np.arange(1, 1_000_001) * 0.05
    assert logarithmic_blocks(time, time).elapsed.size < 260


@pytest.mark.parametrize("relaxation_time", [1.0, 30.0, 1000.0])
def test_an_exponential_is_off_by_less_than_stated(relaxation_time):
    time = np.arange(0.01, 3000, 0.01)
    blocks = logarithmic_blocks(time, np.exp(-time / relaxation_time))
    error = blocks.value - np.exp(-blocks.elapsed / relaxation_time)
    assert np.abs(error).max() < 2e-4


def test_no_block_counts_for_more_than_sixty_four_samples():
    blocks = logarithmic_blocks(np.arange(1.0, 1e5), np.ones(99999))
    assert blocks.weight[0] == 1
    assert blocks.weight.max() < 64


def test_time_at_zero_is_refused():
    with pytest.raises(DataError, match="time does not start above zero; found 0 s"):
        logarithmic_blocks([0.0, 1.0], [1.0, 1.0])


def test_no_samples_are_refused():
    with pytest.raises(DataError, match="time does not start above zero; found no samples"):
        logarithmic_blocks([], [])


def test_time_that_goes_back_is_refused():
    with pytest.raises(DataError, match="not above the one before"):
        logarithmic_blocks([1.0, 3.0, 2.0], [1.0, 1.0, 1.0])
