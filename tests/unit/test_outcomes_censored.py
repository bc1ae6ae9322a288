"""The likelihood with lower bounds: where it has a maximum, and what it says where it has none."""

import numpy as np
import pytest

from reduction.experiments import life_statistics as censored
from reduction.experiments.life_statistics import _scatter_quantile, fit_censored
from reduction.record.errors import DataError, FitError

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
