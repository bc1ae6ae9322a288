"""Tests with a slack line: the threshold is that of the data."""

import math

import pytest

from reduction.experiments.strength_statistics import summarise_snap_loading
from reduction.record.errors import DataError

PEAK = [0.7, 0.7, 0.5, 0.5, 0.3, 0.3, 0.3]
LIVES = [4e3, 6e3, 4e4, 6e4, 2e5, 2e5, 2e5]
STOPPED = [False] * 4 + [True] * 3


def summarise(peak=PEAK, least=None, lives=LIVES, stopped=STOPPED, **options):
    return summarise_snap_loading(peak, least or [0.0] * len(peak), lives, stopped, **options)


def test_threshold_lies_between_the_levels_that_survived_and_failed():
    levels = summarise()
    assert levels.peak_load_ratio.tolist() == pytest.approx([0.3, 0.5, 0.7])
    assert (levels.threshold_low, levels.threshold_high) == pytest.approx((0.3, 0.5))
    assert levels.n_failed.tolist() == [0, 2, 2] and levels.n_suspended.tolist() == [3, 0, 0]
    assert levels.mean_cycles.tolist()[1:] == [5e4, 5e3] and math.isnan(levels.mean_cycles[0])
    assert levels.least_cycles.tolist() == [2e5, 4e4, 4e3]
    assert levels.most_cycles.tolist() == [2e5, 6e4, 6e3]
    assert levels.notes == ()


def test_three_survivors_leave_room_for_many_failures():
    # the upper bound of Clopper and Pearson for 0 of 3, one-sided
    assert summarise().failed_share_high[0] == pytest.approx(1 - 0.05 ** (1 / 3))
    assert math.isnan(summarise().failed_share_high[1])


def test_lines_that_keep_a_tension_are_counted_apart():
    levels = summarise(least=[0.03, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    assert levels.n_failed.tolist() == [0, 2, 1]


def test_a_minimum_load_that_is_not_stated_is_no_snap_load():
    levels = summarise(least=[math.nan] + [0.0] * 6)
    assert levels.n_failed.tolist() == [0, 2, 1]
    assert levels.notes == ("1 tests without a minimum load are left out",)


def test_a_survivor_above_a_failure_is_told():
    levels = summarise(stopped=[True, False, *STOPPED[2:]])
    assert levels.notes == (
        "a line failed at 50 % of its break strength, and one survived 70 %: the threshold is no "
        "sharp load",
    )


def test_without_failures_or_without_survivors_one_end_is_open():
    levels = summarise(stopped=[True] * 7)
    assert levels.threshold_low == pytest.approx(0.7) and math.isnan(levels.threshold_high)
    levels = summarise(stopped=[False] * 7)
    assert math.isnan(levels.threshold_low) and levels.threshold_high == pytest.approx(0.3)


def test_lines_that_all_keep_a_tension_are_refused():
    with pytest.raises(DataError, match="no test has a line that goes slack; found least minimum"):
        summarise(least=[0.03] * 7)
