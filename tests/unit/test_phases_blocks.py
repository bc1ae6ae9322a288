"""Blocks of samples and the runs of them that stand still."""

import numpy as np
import pytest

from reduction.stages.standstills import _block_extremes, _still_blocks


def test_extremes_are_those_of_whole_and_broken_blocks():
    position = np.random.default_rng(0).normal(size=1003)
    least, greatest = _block_extremes(position, 10)
    rows = [position[i : i + 10] for i in range(0, 1003, 10)]
    assert least.tolist() == [row.min() for row in rows]
    assert greatest.tolist() == [row.max() for row in rows]


def test_missing_samples_are_left_out_of_a_block():
    position = np.array([np.nan, 2.0, 1.0, 3.0, np.nan, np.nan])
    least, greatest = _block_extremes(position, 2)
    assert (least.tolist(), greatest.tolist()) == ([2, 1, np.inf], [2, 3, -np.inf])


def test_a_length_of_zero_is_refused():
    with pytest.raises(ZeroDivisionError):
        _block_extremes(np.ones(3), 0)


def test_a_slow_ramp_is_no_standstill_and_a_hold_in_it_is_one():
    level = np.concatenate([np.linspace(0, 4, 100), np.full(40, 4.0), np.linspace(4, 0, 100)])
    # four blocks of the ramp keep within the tolerance, 28 do not
    first, last = _still_blocks(level, level + 0.1, window=4, tolerance=0.3)
    assert first.size == 1
    assert (first[0], last[0]) == (pytest.approx(100, abs=5), pytest.approx(139, abs=5))


def test_the_turn_of_a_slow_cycle_is_no_standstill():
    level = np.abs(np.arange(800) % 200 - 100.0) / 25
    first, _ = _still_blocks(level, level + 0.1, window=4, tolerance=0.4)
    assert first.size == 0


def test_nothing_moves_and_all_is_one_standstill():
    first, last = _still_blocks(np.zeros(9), np.full(9, 0.2), window=3, tolerance=0.3)
    assert (first.tolist(), last.tolist()) == ([0], [8])


def test_fewer_blocks_than_a_window_hold_no_standstill():
    first, _ = _still_blocks(np.zeros(2), np.zeros(2), window=3, tolerance=0.3)
    assert first.size == 0


def test_a_long_standstill_soon_after_a_short_one_leaves_both():
    """Looked at as long before it as it lasted, the long one goes back beyond the short one."""
    time = np.arange(0, 600, 0.1)
    position = np.interp(time, [0, 50, 60, 90, 300, 600], [0, 5, 5, 8, 8, 30])
    least, greatest = _block_extremes(position, 10)
    first, last = _still_blocks(least, greatest, window=3, tolerance=0.01)
    np.testing.assert_array_equal(first, [50, 90])
    np.testing.assert_array_equal(last, [59, 299])
