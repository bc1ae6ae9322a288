"""Lives at one load: run-outs, few failures, what is refused."""

import math

import numpy as np
import pytest
from refusals import refusals
from scipy import stats

from reduction.experiments import life_statistics as censored
from reduction.experiments.life_statistics import (
    _runout_bound,
    _scatter_quantile,
    cutoff,
    fit_censored,
    fit_life,
    fit_load_life,
    life_at_load,
    load_levels,
    profile_bounds,
    ratio_of_lives,
    ratio_to_published_life,
)
from reduction.experiments.outcome_groups import fatigue_rows
from reduction.experiments.outcomes import Outcome
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


def test_a_ratio_needs_a_failure_in_each_group():
    with pytest.raises(DataError, match="the reference group has no failure; needed one"):
        ratio_of_lives([1.0, 2.0], [True, False], [True, False])
    with pytest.raises(DataError, match="the other group has no failure; needed one"):
        ratio_of_lives([1.0, 2.0], [False, True], [True, False])


def test_a_ratio_of_two_and_one_has_bounds_and_one_of_few_is_wide():
    ratio, low, high = ratio_of_lives([8.0, 9.0, 20.0], [False] * 3, [True, True, False])
    assert low < ratio < high and high / low > 10


# the likelihood with lower bounds: where it has a maximum, and what it says where it has none

ONES = np.ones((4, 1))
NONE = np.zeros(4, dtype=bool)


def test_values_far_apart_from_the_start_are_found():
    values = 1e6 * np.array([1.0, 1.1, 0.9, 1.2])
    fit = fit_censored(values, ONES, NONE, scatter="normal")
    assert fit.coefficient[0] == pytest.approx(values.mean())
    assert fit.scale == pytest.approx(values.std())


def test_covariance_of_complete_normal_values_is_the_known_one():
    values = np.array([-1.0, 0.5, 2.0, -1.5])
    fit = fit_censored(values, ONES, NONE, scatter="normal")
    variance = values.var()
    np.testing.assert_allclose(fit.covariance, np.diag([variance / 4, variance / 8]), atol=1e-12)


def test_many_lower_bounds_and_two_failures_still_have_a_maximum():
    values = np.concatenate([[0.0, 0.1], np.full(500, 0.2)])
    bound = np.arange(502) > 1
    for scatter in ("normal", "smallest_extreme_value"):
        fit = fit_censored(values, np.ones((502, 1)), bound, scatter=scatter)
        assert fit.coefficient[0] > 0.2 and np.isfinite(fit.covariance).all()


def test_a_lower_bound_far_below_says_nothing():
    values = np.array([1.0, 2.0, 4.0, -1e4])
    with_it = fit_censored(values, ONES, np.array([0, 0, 0, 1], bool), scatter="normal")
    without = fit_censored(values[:3], ONES[:3], NONE[:3], scatter="normal")
    assert with_it.coefficient[0] == pytest.approx(without.coefficient[0])


def test_equal_failures_are_refused():
    with pytest.raises(FitError, match="the failures have no scatter about the law"):
        fit_censored(np.array([1.0, 1.0, 1.0, 0.5]), ONES, np.arange(4) == 3, scatter="normal")


def test_failures_on_a_line_are_refused():
    design = np.column_stack([np.ones(2), [0.0, 1.0]])
    with pytest.raises(FitError, match="the failures have no scatter about the law"):
        fit_censored(np.array([1.0, 2.0]), design, NONE[:2], scatter="normal")


def test_two_columns_alike_are_refused():
    with pytest.raises(FitError, match="the failures leave a coefficient open; found 4 failures"):
        fit_censored(np.arange(4.0), np.ones((4, 2)), NONE, scatter="smallest_extreme_value")


def test_a_column_that_lower_bounds_alone_have_is_refused():
    # the bounds would like it to grow for ever
    design = np.column_stack([np.ones(4), [0.0, 0.0, 0.0, 1.0]])
    with pytest.raises(FitError, match="the failures leave a coefficient open; found 3 failures"):
        fit_censored(np.array([0.0, 1.0, 2.0, 1.0]), design, np.arange(4) == 3, scatter="normal")


@pytest.mark.parametrize("share", [0.0, 1.0, -0.1, float("nan")])
def test_a_share_outside_its_range_is_refused(share):
    with pytest.raises(DataError, match="a share is not between 0 and 1; found"):
        _scatter_quantile(share, scatter="normal")


def test_median_of_the_normal_scatter_is_zero():
    assert _scatter_quantile(0.5, scatter="normal") == 0


def test_a_search_that_is_cut_short_is_no_answer(monkeypatch):
    monkeypatch.setattr(censored, "_MOST_STEPS", 2)
    with pytest.raises(FitError, match="the likelihood is not at its maximum; found 2 steps"):
        fit_censored(np.array([0.0, 1.0, 5.0, 2.0]), ONES, NONE, scatter="normal")


def test_equal_failures_with_a_bound_beyond_them_scatter():
    fit = fit_censored(np.array([1.0, 1.0, 1.0, 1.5]), ONES, np.arange(4) == 3, scatter="normal")
    assert fit.coefficient[0] > 1 and fit.scale > 0


# A life over one of which mean and deviation are printed

REFERENCE = {"reference_mean": 8134, "reference_standard_deviation": 1963, "reference_n": 38}


def test_the_ratio_is_that_of_medians():
    ratio, *_ = ratio_to_published_life([29e3, 39e3, 41e3], [False] * 3, **REFERENCE)
    median = 8134 / np.sqrt(1 + (1963 / 8134) ** 2)
    assert ratio == pytest.approx((29e3 * 39e3 * 41e3) ** (1 / 3) / median)


def test_one_failure_gives_no_ratio():
    ratios = ratio_to_published_life([29e3, 39e3], [False, True], **REFERENCE)
    assert all(map(math.isnan, ratios))


@pytest.mark.parametrize("name", REFERENCE)
def test_a_reference_without_scatter_or_mean_is_refused(name):
    with pytest.raises(DataError, match="a reference life cannot be used; found mean"):
        ratio_to_published_life([29e3, 39e3], [False] * 2, **(REFERENCE | {name: 0}))


# life against load: levels, run-outs, and what cannot be fitted

LOAD = np.repeat([0.3, 0.4, 0.5, 0.7], 3)
LIVES = 500 * LOAD**-5.0 * np.tile([0.7, 1.0, 1.4], 4)
NONE_OF_FATIGUE = np.zeros(12, dtype=bool)


def test_complete_lives_give_the_line_of_least_squares():
    fit = fit_load_life(LOAD, LIVES, NONE_OF_FATIGUE)
    slope, _ = np.polyfit(np.log(LOAD), np.log(LIVES), 1)
    assert fit.exponent == pytest.approx(-slope)
    assert fit.reference_load_ratio == pytest.approx(np.exp(np.log(LOAD).mean()))
    assert fit.log_life == pytest.approx(np.log(LIVES).mean())
    # one shape at all loads, so medians of their own gain nothing
    assert fit.lack_of_fit_p_value == pytest.approx(1.0)


def test_a_limit_below_which_nothing_fails_is_no_line():
    lives = np.where(LOAD < 0.35, 1e7, LIVES)
    fit = fit_load_life(LOAD, lives, LOAD < 0.35)
    assert fit.lack_of_fit_p_value < 0.01
    assert (fit.n_failed, fit.n_suspended) == (9, 3)
    assert (fit.load_ratio_low, fit.load_ratio_high) == (0.3, 0.7)


def test_runouts_make_the_line_steeper_than_failures_there():
    lives = np.where(LOAD < 0.35, 2e5, LIVES)
    assert (
        fit_load_life(LOAD, lives, LOAD < 0.35).exponent
        > fit_load_life(LOAD, lives, NONE_OF_FATIGUE).exponent
    )


def test_bounds_are_narrowest_amid_the_loads_and_a_load_outside_is_told():
    fit = fit_load_life(LOAD, LIVES, NONE_OF_FATIGUE)
    life, low, high, inside = life_at_load(fit, [0.2, fit.reference_load_ratio, 0.9])
    assert inside.tolist() == [False, True, False]
    width = np.log(high / low)
    assert width[1] < width.min(initial=9, where=[True, False, True])
    assert (np.diff(life) < 0).all()


def test_a_tenth_fails_before_half_does():
    for distribution in ("lognormal", "weibull"):
        fit = fit_load_life(LOAD, LIVES, NONE_OF_FATIGUE, distribution=distribution)
        assert life_at_load(fit, 0.5, failed_share=0.1)[0] < life_at_load(fit, 0.5)[0]


def test_two_failures_and_a_runout_give_a_line_without_bounds():
    fit = fit_load_life([0.5, 0.7, 0.3], [3e4, 4e3, 2e6], [False, False, True])
    _, low, high, _ = life_at_load(fit, 0.5)
    assert math.isnan(low) and math.isnan(high)


def test_loads_that_a_machine_does_not_repeat_are_one_level():
    assert load_levels([0.305, 0.30, 0.31, 0.33]).tolist() == [0, 0, 0, 1]


def test_abrasion_is_compared_with_new_polypropylene_of_the_same_make():
    """CG-D-39-80, sec. 6.2: nylon three times, polyester twice, jacketed five to six times."""
    lives = np.array([2.6e3, 3.1e3, 3.4e3, 4.0e3])

    def abraded(material, times, *, construction="8-strand plaited", condition="new"):
        return [
            Outcome(
                "abrasion_cycles", times * life, material=material, construction=construction,
                diameter=0.0127, condition=condition,
            )
            for life in lives
        ]  # fmt: skip

    outcomes = [
        *abraded("polypropylene", 1.0), *abraded("nylon", 3.0), *abraded("polyester", 2.0),
        *abraded("polyester", 11.0, condition="jacketed"),
        *abraded("polyester", 2.0, construction="3-strand twisted"),
        *abraded("polypropylene", 0.5, condition="worn"),
    ]  # fmt: skip
    rows = [
        {key: row[f"relative_abrasion_resistance{key}"] for key in ("", "_low", "_high")}
        for row in fatigue_rows(outcomes)
    ]
    found = [row[""] for row in rows]
    expected = [np.nan, 3.0, 2.0, 11.0, np.nan, 0.5]
    np.testing.assert_allclose(found, expected, rtol=1e-6)
    assert all(row["_low"] < row[""] < row["_high"] for row in rows if row[""] > 0)
    of_fatigue = [Outcome("cycles_to_failure", life, material="nylon") for life in lives]
    assert np.isnan(fatigue_rows(of_fatigue)[0]["relative_abrasion_resistance"])


# ends of an interval on a profile


def test_few_failures_need_a_larger_drop_than_chi_square():
    drops = [cutoff(n_failed=n, n_coefficients=1) for n in (2, 3, 5, 20)]
    assert drops == sorted(drops, reverse=True)
    assert drops[-1] > stats.chi2.ppf(0.95, 1)


def test_no_failure_to_spare_gives_no_drop_and_no_bounds():
    assert math.isnan(cutoff(n_failed=2, n_coefficients=2))
    bounds = profile_bounds(lambda v: -(v**2), estimate=0, maximum=0, step=1, drop=math.nan)
    assert all(map(math.isnan, bounds))


def test_a_side_that_never_drops_is_open():
    low, high = profile_bounds(
        lambda value: -math.exp(-value), estimate=0, maximum=-1.0, step=0.5, drop=2.0
    )
    assert high == math.inf
    assert low == pytest.approx(-math.log(2))


REFUSED = {
    "a life of nothing is refused": (
        lambda: fit_life([0.0, 1.0], [False, False]),
        DataError,
        "1 of 2 values of cycles are not positive",
    ),
    "a ratio of lives without scatter is refused": (
        lambda: ratio_of_lives([1.0, 2.0], [False] * 2, [True, False]),
        FitError,
        "the failures have no scatter about the law",
    ),
    "failures at one load are refused": (
        lambda: fit_load_life([0.3, 0.5, 0.502], [2e5, 3e4, 4e4], [True, False, False]),
        FitError,
        "needs failures at two loads; found failures at 1; needed 2",
    ),
    "failures that lie on a line are refused": (
        lambda: fit_load_life([0.3, 0.5], [2e5, 3e4], [False, False]),
        FitError,
        "the failures have no scatter about the law",
    ),
    "a load of nothing is refused": (
        lambda: load_levels([0.0]),
        DataError,
        "values of peak_load_ratio are not positive",
    ),
}


test_refusals = refusals(REFUSED)
