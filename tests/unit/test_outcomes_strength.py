"""Groups of breaks: mean, deviation, and what stands apart."""

import numpy as np
import pytest

from reduction.experiments.outcomes import REASONS
from reduction.experiments.strength_statistics import (
    EXCLUDED,
    LOWER_BOUND,
    VALUE,
    censored_mean,
    group_statistics,
)
from reduction.record.errors import DataError


def test_breaks_in_the_splice_do_not_touch_mean_or_deviation():
    values = [10.0, 12.0, 14.0, 3.0, 99.0]
    statistics = group_statistics(
        values, [0] * 5, [VALUE] * 3 + [LOWER_BOUND, EXCLUDED], n_groups=1
    )
    assert (statistics.n, statistics.n_lower_bound, statistics.n_excluded) == (3, 1, 1)
    assert statistics.mean == 12 and statistics.standard_deviation == 2
    assert (statistics.minimum, statistics.maximum) == (10, 14)
    assert statistics.mean_standard_uncertainty == pytest.approx(2 / np.sqrt(3))
    assert statistics.relative_variability == pytest.approx(1 / 6)
    assert statistics.lower_bound_mean == 3


def test_one_value_has_no_deviation_and_an_empty_group_no_mean():
    statistics = group_statistics([5.0, 7.0], [0, 2], [VALUE, LOWER_BOUND], n_groups=3)
    assert statistics.n.tolist() == [1, 0, 0]
    assert statistics.mean[0] == 5 and np.isnan(statistics.mean[1:]).all()
    assert np.isnan(statistics.standard_deviation).all() and np.isnan(statistics.minimum[1:]).all()
    assert {REASONS[int(code)] for code in statistics.reason} == {REASONS[1]}


def test_groups_are_kept_apart():
    rng = np.random.default_rng(10)
    value, group = rng.uniform(1, 2, 300), rng.integers(0, 4, 300)
    statistics = group_statistics(value, group, np.zeros(300, int), n_groups=4)
    for place in range(4):
        own = value[group == place]
        assert statistics.mean[place] == pytest.approx(own.mean())
        assert statistics.standard_deviation[place] == pytest.approx(own.std(ddof=1))
        assert statistics.maximum[place] == own.max()


def test_a_strength_of_nothing_is_refused():
    with pytest.raises(DataError, match="1 of 2 values of value are not positive"):
        group_statistics([1.0, 0.0], [0, 0], [0, 0], n_groups=1)


def test_a_group_without_a_place_is_refused():
    with pytest.raises(DataError, match="a group has no place; found 0 to 2; needed 0 to 1"):
        group_statistics([1.0, 2.0], [0, 2], [0, 0], n_groups=2)


def test_a_splice_break_above_the_mean_raises_it_and_one_far_below_does_not():
    plain = censored_mean([10.0, 11, 12], [False] * 3)
    assert censored_mean([10.0, 11, 12, 12], [False] * 3 + [True]).mean > plain.mean
    assert censored_mean([10.0, 11, 12, 2], [False] * 3 + [True]).mean == pytest.approx(plain.mean)


@pytest.mark.parametrize(
    ("values", "bounds", "reason"),
    [([5.0, 6], [True, True], 1), ([5.0, 6], [False, True], 1), ([5.0, 5], [False, False], 4)],
)
def test_breaks_that_tell_no_deviation_give_a_reason(values, bounds, reason):
    line = censored_mean(values, bounds)
    assert np.isnan([line.mean, line.standard_deviation, line.low, line.high]).all()
    assert line.reason == reason and line.n + line.n_lower_bound == 2
