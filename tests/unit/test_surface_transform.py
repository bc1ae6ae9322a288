import numpy as np
import pytest
from scipy import stats

from reduction.experiments.designs import box_behnken, model_matrix, quadratic_exponents
from reduction.experiments.fit_results import FIT_REASONS
from reduction.experiments.response_surfaces import fit_surfaces, scatter_by_scale
from reduction.experiments.response_transform import (
    back_transform,
    box_cox_exponent,
    retransformed_mean,
    transform,
)
from reduction.record.errors import DataError

RUNS = box_behnken(3).coded
MATRIX = model_matrix(RUNS, quadratic_exponents(3))


@pytest.mark.parametrize("power", [-1.5, -0.5, 0.0, 0.3, 1.0, 2.0])
def test_there_and_back_is_where_it_began(power):
    values = np.array([0.01, 0.7, 1.0, 3.0, 400.0])
    np.testing.assert_allclose(back_transform(transform(values, power), power), values, rtol=1e-9)


def test_beyond_the_end_of_the_scale_there_is_nought_or_no_bound():
    assert back_transform(-10.0, 0.5) == 0.0
    assert back_transform(10.0, -0.5) == np.inf
    assert np.isnan(back_transform(np.nan, 0.5))


@pytest.mark.parametrize("power", [0.0, 0.25, 0.5, -0.3])
def test_the_mean_is_that_of_many_draws(power):
    rng = np.random.default_rng(1)
    sigma = 0.1 if power == 0 else 0.03  # second order elsewhere
    draws = back_transform(2.0 + sigma * rng.normal(size=1_000_000), power)
    shift = retransformed_mean(2.0, power, sigma=sigma) / back_transform(2.0, power) - 1
    expected = draws.mean() / back_transform(2.0, power) - 1
    noise = draws.std() / draws.mean() / 1000
    assert shift == pytest.approx(expected, rel=0.02, abs=3 * noise)


def test_the_exponent_without_factors_is_that_of_scipy():
    values = np.random.default_rng(2).gamma(3.0, size=(5, 40))
    found = box_cox_exponent(np.ones((40, 1)), values)
    for row, sample in enumerate(values):
        _, best, interval = stats.boxcox(sample, alpha=0.05)
        assert found.exponent[row] == pytest.approx(best, abs=1e-5)
        assert found.low[row] == pytest.approx(interval[0], abs=1e-5)
        assert found.high[row] == pytest.approx(interval[1], abs=1e-5)


@pytest.mark.parametrize("power", [0.0, 0.5, 1.0])
def test_the_interval_holds_the_true_exponent_about_as_often_as_it_says(power):
    """Likelihood of 60 runs, 10 terms: a little short of 95 %, as the terms are not counted."""
    rng = np.random.default_rng(3)
    matrix = np.tile(MATRIX, (4, 1))
    unit = 10.0**power  # a hundred per cent of 10, transformed
    mean = transform(10.0, power) + unit * matrix[:, 1:] @ np.linspace(-0.1, 0.1, 9)
    values = back_transform(mean + unit * rng.normal(0, 0.15, (400, 60)), power)
    found = box_cox_exponent(matrix, values)
    held = (found.low <= power) & (power <= found.high)
    assert 0.85 <= held.mean() <= 0.99


def test_an_interval_that_reaches_the_end_of_the_search_is_open():
    values = 100 + 0.01 * np.random.default_rng(4).normal(size=(1, 15))
    found = box_cox_exponent(MATRIX, values)
    assert found.low[0] == -np.inf and found.high[0] == np.inf


def test_missing_runs_are_left_out_and_too_few_give_nothing():
    values = np.random.default_rng(5).gamma(5.0, size=(3, 15))
    values[1, 4], values[2, [0, 1, 5, 13, 14]] = np.nan, np.nan
    found = box_cox_exponent(MATRIX, values)
    has = np.isfinite(values[1])
    alone = box_cox_exponent(MATRIX[has], values[1:2, has])
    assert found.exponent[1] == pytest.approx(alone.exponent[0], abs=1e-9)
    assert np.isnan(found.exponent[2])


def test_a_surface_on_the_scale_of_its_response_shows_the_true_coefficients():
    truth = np.array([1.0, 0.2, -0.1, 0.0, -0.8, 0.5, 0.1, 0, 0, 0.2])
    rng = np.random.default_rng(6)
    values = np.exp(MATRIX @ truth + 0.01 * rng.normal(size=(2, 15)))
    found = fit_surfaces(
        RUNS, values, factor_names=["f", "T", "a"], response_names=["tau", "plain"],
        low=[-1] * 3, high=[1] * 3, transforms=["log", "none"],
    )  # fmt: skip
    np.testing.assert_allclose(found.coefficient[0], truth, atol=0.03)
    assert found.transform == ("log", "none")
    assert found.transform_exponent.tolist() == [0.0, 1.0]
    assert found.r2[0] > found.r2[1]


def test_the_exponent_found_is_the_one_that_was_used():
    rng = np.random.default_rng(7)
    values = (5 + MATRIX[:, 4:7] @ [1.0, 0.5, 0.2] + 0.05 * rng.normal(size=(2, 15))) ** 2
    found = fit_surfaces(
        RUNS, values, factor_names=["f", "T", "a"], response_names=["a", "b"],
        low=[-1] * 3, high=[1] * 3, transforms="box-cox",
    )  # fmt: skip
    power = found.transform_exponent
    low, high = found.transform_exponent_interval.T
    assert ((low < power) & (power < high)).all()
    np.testing.assert_allclose(
        found.fitted + found.residual, transform(values, power[:, None]), rtol=1e-10
    )


def test_a_response_without_an_exponent_has_no_surface_and_says_why():
    values = np.random.default_rng(8).gamma(5.0, size=(2, 15))
    values[0, [0, 1, 5, 13, 14]] = np.nan  # as many runs as terms
    found = fit_surfaces(
        RUNS, values, factor_names=["f", "T", "a"], response_names=["a", "b"],
        low=[-1] * 3, high=[1] * 3, transforms="box-cox",
    )  # fmt: skip
    assert FIT_REASONS[found.reason[0]].endswith("no exponent can be found")
    assert np.isnan(found.coefficient[0]).all() and np.isfinite(found.coefficient[1]).all()
    assert np.isnan(found.anova.degrees_of_freedom[0]).all()


def test_the_end_of_an_interval_may_lie_beyond_every_number():
    assert back_transform(1e4, 0.0) == np.inf
    assert back_transform(1e300, 0.01) == np.inf


def test_values_not_above_nought_are_refused():
    with pytest.raises(DataError, match="2 of 3 values are not above zero .* found -1"):
        transform([-1.0, 0.0, 1.0], 0.5)


def test_scatter_by_scale_is_the_ratio_of_two_regressions():
    """Box and Cox: residual scatter of the logarithm times the geometric mean, over that of y."""
    level = np.linspace(-1, 1, 12)
    runs = np.exp(level) * (1 + 0.02 * np.random.default_rng(4).normal(size=(2, 12)))
    runs[1] *= 1000  # in another unit: the ratio has none

    def fit(values, names, scales):
        return fit_surfaces(
            level[:, None], values, factor_names=["load"], response_names=names, units="coded",
            low=[-1.0], high=[1.0], transforms=scales,
        )  # fmt: skip

    ratio, p = scatter_by_scale(runs, fit)
    matrix = np.vander(level, 3)
    for row, values in enumerate(runs):
        ss = [np.linalg.lstsq(matrix, one, rcond=None)[1][0] for one in (np.log(values), values)]
        expected = stats.gmean(values) * np.sqrt(ss[0] / ss[1])
        assert ratio[row] == pytest.approx(expected, rel=1e-9)
        assert p[row] == pytest.approx(stats.f.sf(max(expected, 1 / expected) ** 2, 9, 9))
