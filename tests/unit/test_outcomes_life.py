"""Lives at one load: run-outs, few failures, what is refused."""

import math

import numpy as np
import pytest

from reduction.experiments.life_statistics import _runout_bound, fit_life, ratio_of_lives
from reduction.record.errors import DataError, FitError


def test_a_runout_counts_as_longer_than_a_failure_there():
    lives = [50e3, 80e3, 120e3, 200e3]
    stopped = fit_life(lives, [False] * 3 + [True])
    failed = fit_life(lives, [False] * 4)
    left_out = fit_life(lives[:3], [False] * 3)
    assert stopped.life > failed.life > left_out.life
    assert (stopped.n_failed, stopped.n_suspended) == (3, 1)


def test_a_smaller_share_fails_earlier():
    lives = [50e3, 80e3, 120e3, 200e3]
    tenth, half = (fit_life(lives, [False] * 4, failed_share=share) for share in (0.1, 0.5))
    assert tenth.life < half.life and tenth.log_scale == half.log_scale
    assert tenth.low / tenth.life < half.low / half.life


def test_runouts_alone_give_a_lower_bound_without_a_law():
    fit = fit_life([2e5, 2.1e5, 2.2e5, 2e5, 2e5, 2e5, 3e5], [True] * 7)
    assert math.isnan(fit.life) and fit.reason == 5
    assert (fit.low, fit.high) == (2e5, math.inf)


def test_bound_of_runouts_needs_the_more_the_smaller_the_share():
    # 0.9^36 is the first below 0.025
    assert math.isnan(_runout_bound([1e5] * 35, failed_share=0.1))
    assert _runout_bound([1e5] * 36, failed_share=0.1) == 1e5
    # six of seven passed 1.5: that is enough
    assert _runout_bound([1, 1.5, 2, 3, 4, 5, 6]) == 1.5


@pytest.mark.parametrize(
    ("lives", "suspended", "reason"),
    [([5e4, 9e4], [False, True], 6), ([5e4, 5e4, 4e4], [False, False, True], 7)],
)
def test_failures_that_tell_no_scatter_give_a_reason(lives, suspended, reason):
    fit = fit_life(lives, suspended)
    assert fit.reason == reason
    assert np.isnan([fit.life, fit.low, fit.high, fit.log_scale]).all()


def test_equal_failures_with_a_later_runout_have_a_median():
    fit = fit_life([5e4, 5e4, 9e4], [False, False, True])
    assert fit.reason == 0 and 5e4 < fit.life


def test_two_failures_bound_the_median_widely():
    fit = fit_life([5e4, 6e4], [False, False])
    assert 0 < fit.low < 2.5e4 and fit.high > 1e5


def test_a_life_of_nothing_is_refused():
    with pytest.raises(DataError, match="1 of 2 values of cycles are not positive"):
        fit_life([0.0, 1.0], [False, False])


def test_a_ratio_needs_a_failure_in_each_group():
    with pytest.raises(DataError, match="the reference group has no failure; needed one"):
        ratio_of_lives([1.0, 2.0], [True, False], [True, False])
    with pytest.raises(DataError, match="the other group has no failure; needed one"):
        ratio_of_lives([1.0, 2.0], [False, True], [True, False])


def test_a_ratio_of_lives_without_scatter_is_refused():
    with pytest.raises(FitError, match="the failures have no scatter about the law"):
        ratio_of_lives([1.0, 2.0], [False] * 2, [True, False])


def test_a_ratio_of_two_and_one_has_bounds_and_one_of_few_is_wide():
    ratio, low, high = ratio_of_lives([8.0, 9.0, 20.0], [False] * 3, [True, True, False])
    assert low < ratio < high and high / low > 10
