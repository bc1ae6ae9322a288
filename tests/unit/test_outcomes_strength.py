"""Groups of breaks: mean, deviation, and what stands apart."""

import math

import numpy as np
import pytest
from refusals import refusals

from reduction.experiments.outcomes import REASONS
from reduction.experiments.strength_statistics import (
    EXCLUDED,
    LOWER_BOUND,
    VALUE,
    censored_mean,
    fit_exposure_trend,
    group_statistics,
    one_way,
    ratio_of_means,
    share_lost_per_year,
    summarise_snap_loading,
)
from reduction.record.errors import DataError, FitError


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


# ratios of means and one-way F where groups are small, equal or empty


def ratio(mean=50.0, deviation=2.0, n=5, reference=(100.0, 4.0, 10), **options):
    return ratio_of_means(
        mean, deviation, n, reference_mean=reference[0],
        reference_standard_deviation=reference[1], reference_n=reference[2], **options,
    )  # fmt: skip


def test_interval_ends_solve_the_equation_of_fieller():
    from scipy import stats

    change = ratio()
    t = stats.t.ppf(0.975, change.degrees_of_freedom)
    for end in (1 + change.low, 1 + change.high):
        assert (50 - end * 100) ** 2 == pytest.approx(t**2 * (4 / 5 + end**2 * 16 / 10))


def test_a_mean_well_known_has_the_interval_of_first_order():
    change = ratio(deviation=0.01, reference=(100.0, 0.01, 10))
    from scipy import stats

    half = stats.t.ppf(0.975, change.degrees_of_freedom) * change.standard_uncertainty
    assert change.high - change.low == pytest.approx(2 * half, rel=1e-6)


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        ({"n": 1}, 2),
        ({"deviation": float("nan")}, 2),
        ({"reference": (100.0, 4.0, 1)}, 2),
        ({"deviation": 0.0, "reference": (100.0, 0.0, 10)}, 4),
        ({"reference": (100.0, 90.0, 3)}, 3),
    ],
)
def test_an_interval_that_cannot_be_given_has_a_reason(arguments, reason):
    change = ratio(**arguments)
    assert change.reason == reason
    assert np.isnan(change.low) and np.isnan(change.high)
    assert change.change == -0.5


def test_ten_thousand_changes_at_once():
    change = ratio(mean=np.linspace(40, 60, 10_000))
    assert change.low.shape == (10_000,)
    assert (change.low < change.change).all() and (np.diff(change.high) > 0).all()


def test_a_group_of_one_counts_between_and_not_within():
    analysis = one_way([1.0, 2.0, 3.0], [np.nan, 0.5, 0.5], [1, 4, 4])
    assert analysis.within == 6
    # means 1, 2 and 3 of 1, 4 and 4 values about 21/9, within-group variance 1/4
    between = ((1 - 21 / 9) ** 2 + 4 * (2 - 21 / 9) ** 2 + 4 * (3 - 21 / 9) ** 2) / 2
    assert analysis.f_statistic == pytest.approx(between / 0.25)


def test_groups_without_scatter_have_a_reason_and_no_f():
    analysis = one_way([1.0, 2.0], [0.0, 0.0], [3, 3])
    assert np.isnan(analysis.f_statistic) and analysis.reason == 4
    analysis = one_way([1.0, 2.0], [np.nan, np.nan], [1, 1])
    assert np.isnan(analysis.p_value) and analysis.within == 0


def test_many_tables_at_once():
    analysis = one_way([[1.0, 2.0], [1.0, 1.0]], [[1.0, 1.0]] * 2, [[5, 5]] * 2)
    assert analysis.f_statistic.tolist() == pytest.approx([2.5, 0.0])


# the line of strength over years


def test_groups_give_the_line_of_their_breaks():
    rng = np.random.default_rng(15)
    years = np.repeat([0.0, 2, 3, 5], [16, 1, 4, 2])
    strength = 6400 - 650 * years + rng.normal(0, 300, years.size)
    one_by_one = fit_exposure_trend(years, strength)
    levels, size = np.unique(years, return_counts=True)
    own = [strength[years == level] for level in levels]
    in_groups = fit_exposure_trend(
        levels,
        [v.mean() for v in own],
        [v.std(ddof=1) if v.size > 1 else np.nan for v in own],
        size,
    )
    assert in_groups.n == one_by_one.n == 23
    assert in_groups.degrees_of_freedom == one_by_one.degrees_of_freedom == 21
    for name in ("intercept", "slope", "residual_standard_deviation", "lack_of_fit_p_value"):
        assert getattr(in_groups, name) == pytest.approx(getattr(one_by_one, name))
    np.testing.assert_allclose(in_groups.covariance, one_by_one.covariance)


def test_a_group_without_deviation_counts_for_the_line_alone():
    line = fit_exposure_trend([0, 3, 5], [6400, 4365, 3241], [473, 321, np.nan], [16, 4, 2])
    assert line.degrees_of_freedom == 19 and line.n == 22


def test_two_exposures_have_no_lack_of_fit():
    line = fit_exposure_trend([0, 0, 5, 5], [64.0, 66, 31, 33])
    assert math.isnan(line.lack_of_fit_p_value)
    assert line.slope == pytest.approx(-6.6)


def test_a_curve_is_not_a_line():
    years = np.repeat([0.0, 1, 2, 3, 4], 3)
    noise = np.tile([-0.1, 0.0, 0.1], 5)
    line = fit_exposure_trend(years, 10 * np.exp(-years) + 5 + noise)
    assert line.lack_of_fit_p_value < 1e-6


def test_share_lost_is_that_of_the_line_and_inside_its_interval():
    line = fit_exposure_trend([0, 0, 5, 5], [99.0, 101, 49, 51])
    share, low, high = share_lost_per_year(line)
    assert share == pytest.approx(0.1)
    assert low < share < high


def test_share_lost_of_an_unknown_new_strength_has_no_interval():
    line = fit_exposure_trend([4.0, 4.5, 5], [9.0, 2.0, 6.0])
    share, low, high = share_lost_per_year(line)
    assert math.isfinite(share) and math.isnan(low) and math.isnan(high)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (([-1, 1], [5.0, 4.0]), "an exposure is below zero; found -1; needed 0 or more"),
        (([0, 1], [5.0, -4.0]), "values of mean are not positive"),
    ],
)
def test_numbers_that_cannot_be_are_refused(arguments, message):
    with pytest.raises(DataError, match=message):
        fit_exposure_trend(*arguments)


def test_too_little_for_a_line_is_refused():
    with pytest.raises(FitError, match="a line needs two exposures; found 1; needed 2 or more"):
        fit_exposure_trend([3, 3], [5.0, 4.0])
    with pytest.raises(FitError, match="two exposures with one break each leave no scatter"):
        fit_exposure_trend([0, 3], [5.0, 4.0])


def test_a_line_without_new_strength_has_no_share():
    line = fit_exposure_trend([4.0, 4.5, 5], [0.1, 2.0, 6.0])
    with pytest.raises(FitError, match="the line has no strength when new; found"):
        share_lost_per_year(line)


# tests with a slack line: the threshold is that of the data

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


REFUSED = {
    "a strength of nothing is refused": (
        lambda: group_statistics([1.0, 0.0], [0, 0], [0, 0], n_groups=1),
        DataError,
        "1 of 2 values of value are not positive",
    ),
    "a group without a place is refused": (
        lambda: group_statistics([1.0, 2.0], [0, 2], [0, 0], n_groups=2),
        DataError,
        "a group has no place; found 0 to 2; needed 0 to 1",
    ),
    "a mean of nothing is refused": (
        lambda: ratio(reference=(0.0, 1.0, 3)),
        DataError,
        "values of reference_mean are not positive",
    ),
    "one group is refused": (
        lambda: one_way([1.0], [1.0], [3]),
        DataError,
        "one group has nothing to be compared with; needed two",
    ),
    "a deviation that is missing is refused": (
        lambda: one_way([1.0, 2.0], [1.0, np.nan], [3, 3]),
        DataError,
        "a group of several values has no deviation; needed",
    ),
    "lines that all keep a tension are refused": (
        lambda: summarise(least=[0.03] * 7),
        DataError,
        "no test has a line that goes slack; found least minimum",
    ),
}


test_refusals = refusals(REFUSED)
