"""Outcomes against published examples, other programs, and lives of which the law is known."""

import numpy as np
import pytest
from scipy import optimize, stats
from scipy.stats import CensoredData
from statsmodels.regression.linear_model import WLS
from statsmodels.stats.oneway import anova_oneway

from reduction.experiments.life_statistics import (
    fit_life,
    fit_load_life,
    life_at_load,
    ratio_of_lives,
)
from reduction.experiments.strength_statistics import (
    censored_mean,
    fit_exposure_trend,
    one_way,
    ratio_of_means,
)

# NIST/SEMATECH e-Handbook, 8.4.1.3: hours, ten of twenty suspended at 500
NIST_HOURS = np.array([54, 187, 216, 240, 244, 335, 361, 373, 375, 386] + [500] * 10, float)
NIST_SUSPENDED = np.arange(20) >= 10
# Crawford (1970), in Schmee and Hahn (1979): motorettes at four temperatures, hours
MOTOR_TEMPERATURE = np.repeat([150.0, 170.0, 190.0, 220.0], 10)
MOTOR_HOURS = np.array(
    [8064] * 10
    + [1764, 2772, 3444, 3542, 3780, 4860, 5196, 5448, 5448, 5448]
    + [408, 408, 1344, 1344, 1440, 1680, 1680, 1680, 1680, 1680]
    + [408, 408, 504, 504, 504, 528, 528, 528, 528, 528],
    float,
)
MOTOR_SUSPENDED = np.array([1] * 10 + [0] * 7 + [1] * 3 + ([0] * 5 + [1] * 5) * 2, bool)


def test_nist_weibull_with_suspended_units():
    fit = fit_life(NIST_HOURS, NIST_SUSPENDED)
    assert np.exp(fit.log_location) == pytest.approx(606.5280, rel=2e-6)
    assert 1 / fit.log_scale == pytest.approx(1.7208, abs=5e-5)
    assert fit.log_likelihood == pytest.approx(-75.135, abs=5e-4)
    assert 4 - 2 * fit.log_likelihood == pytest.approx(154.27, abs=5e-3)


def test_nist_lognormal_with_suspended_units():
    fit = fit_life(NIST_HOURS, NIST_SUSPENDED, distribution="lognormal")
    assert 4 - 2 * fit.log_likelihood == pytest.approx(154.39, abs=5e-3)


def test_motorettes_lognormal():
    # Aitkin (1981), in Wei and Tanner, J. Am. Stat. Assoc. 85 (1990): log10 of hours against
    # 1000 / (T + 273.2): -6.02, 4.31, sigma^2 .067
    inverse = 1000 / (MOTOR_TEMPERATURE + 273.2)
    fit = fit_load_life(10 * np.exp(-inverse), MOTOR_HOURS, MOTOR_SUSPENDED)
    slope = fit.exponent / np.log(10)
    at_zero = fit.log_life / np.log(10) + slope * np.log(fit.reference_load_ratio / 10)
    assert slope == pytest.approx(4.31, abs=0.005)
    assert at_zero == pytest.approx(-6.02, abs=0.005)
    assert (fit.log_scale / np.log(10)) ** 2 == pytest.approx(0.067, abs=5e-4)


def test_motorettes_weibull():
    # Venables and Ripley, Modern Applied Statistics with S (2002), section 13.2: survreg gives
    # 16.31852 (.62296), -.04531 (.00319), log scale -1.09564 (.21480), log likelihood -147.4
    fit = fit_load_life(
        np.exp(MOTOR_TEMPERATURE / 100), MOTOR_HOURS, MOTOR_SUSPENDED, distribution="weibull"
    )
    spread = np.sqrt(np.diag(fit.covariance))
    assert fit.exponent / 100 == pytest.approx(0.04531, abs=5e-6)
    assert spread[1] / 100 == pytest.approx(0.00319, abs=5e-6)
    assert np.log(fit.log_scale) == pytest.approx(-1.09564, abs=5e-6)
    assert spread[2] / fit.log_scale == pytest.approx(0.21480, abs=5e-6)
    assert fit.log_likelihood == pytest.approx(-147.4, abs=0.05)
    median = np.log(-np.log(0.5))
    at_zero = fit.log_life - median * fit.log_scale
    at_zero += fit.exponent * np.log(fit.reference_load_ratio)
    assert at_zero == pytest.approx(16.31852, abs=5e-6)
    # predict(..., data.frame(temp = 130), se.fit = TRUE): 33813 +- 7506, of the location
    share = 1 - np.exp(-1)
    life, *_ = life_at_load(fit, np.exp(1.3), failed_share=share)
    assert float(life) == pytest.approx(33813, abs=0.5)


@pytest.mark.parametrize("distribution", ["weibull", "lognormal"])
def test_lives_agree_with_scipy_censored_data(distribution):
    rng = np.random.default_rng(39)
    for n in (4, 9, 30):
        lives = 1e5 * rng.weibull(1.3, n)
        stop = np.quantile(lives, 0.7)
        suspended = lives > stop
        observed = np.minimum(lives, stop)
        data = CensoredData.right_censored(observed, suspended)
        fit = fit_life(observed, suspended, distribution=distribution)
        law = stats.weibull_min if distribution == "weibull" else stats.lognorm
        shape, _, scale = law.fit(data, floc=0)
        expected = (1 / fit.log_scale if distribution == "weibull" else fit.log_scale,
                    np.exp(fit.log_location))  # fmt: skip
        assert (shape, scale) == pytest.approx(expected, rel=2e-4)  # as far as its simplex goes
        assert fit.life == pytest.approx(law.ppf(0.5, shape, scale=scale), rel=2e-4)


def test_bounds_are_those_of_a_likelihood_searched_by_brute_force():
    # the law written another way, profiled with a general minimiser
    fit = fit_life(NIST_HOURS, NIST_SUSPENDED, failed_share=0.1)
    drop = 10 * np.log1p(stats.t.ppf(0.975, 9) ** 2 / 9)

    def held(life):
        def minus(log_shape):
            shape = np.exp(log_shape)
            scale = life / (-np.log(0.9)) ** (1 / shape)
            law = stats.weibull_min(shape, scale=scale)
            return -(law.logpdf(NIST_HOURS[:10]).sum() + law.logsf(NIST_HOURS[10:]).sum())

        return -optimize.minimize_scalar(minus, bounds=(-3, 3), method="bounded").fun

    for bound in (fit.low, fit.high):
        assert 2 * (fit.log_likelihood - held(bound)) == pytest.approx(drop, rel=1e-5)


def test_information_is_that_of_finite_differences():
    fit = fit_life(NIST_HOURS, NIST_SUSPENDED)

    def minus(location, scale):
        deviate = (np.log(NIST_HOURS) - location) / scale
        return -np.sum(np.where(NIST_SUSPENDED, 0, deviate - np.log(scale)) - np.exp(deviate))

    point, step = np.array([fit.log_location, fit.log_scale]), 1e-4
    units = step * np.eye(2)
    hessian = [
        [
            (minus(*(point + a + b)) - minus(*(point + a - b)) - minus(*(point - a + b))
             + minus(*(point - a - b))) / (4 * step**2)
            for b in units
        ]
        for a in units
    ]  # fmt: skip
    spread = np.sqrt(np.diag(np.linalg.inv(hessian)))
    assert (fit.log_location_uncertainty, fit.log_scale_uncertainty) == pytest.approx(
        tuple(spread), rel=1e-5
    )


def test_complete_lognormal_lives_have_students_interval():
    lives = np.array([12e3, 31e3, 18e3, 25e3])
    fit = fit_life(lives, np.zeros(4, bool), distribution="lognormal")
    logs = np.log(lives)
    low, high = stats.t.interval(0.95, 3, logs.mean(), stats.sem(logs))
    assert (fit.low, fit.high) == pytest.approx((np.exp(low), np.exp(high)), rel=1e-8)


def test_complete_groups_have_students_interval_of_their_ratio():
    first, second = np.array([7e3, 9e3, 8e3]), np.array([29e3, 39e3, 41e3, 33e3])
    ratio, low, high = ratio_of_lives(
        np.concatenate([first, second]), [False] * 7, [True] * 3 + [False] * 4
    )
    expected = stats.ttest_ind(np.log(second), np.log(first)).confidence_interval()
    assert (low, high) == pytest.approx((np.exp(expected.low), np.exp(expected.high)), rel=1e-8)
    assert ratio == pytest.approx(stats.gmean(second) / stats.gmean(first))


def test_complete_strengths_have_their_usual_mean_deviation_and_interval():
    values = np.array([28.1, 29.4, 27.7, 30.2, 28.8]) * 1e3
    line = censored_mean(values, np.zeros(5, bool))
    low, high = stats.t.interval(0.95, 4, values.mean(), stats.sem(values))
    assert line.mean == pytest.approx(values.mean())
    assert line.standard_deviation == pytest.approx(values.std(ddof=1))
    assert (line.low, line.high) == pytest.approx((low, high))


def test_strengths_with_splice_breaks_agree_with_scipy_censored_data():
    values = np.array([28.1, 29.4, 27.7, 30.2, 28.8, 29.9])
    bound = np.array([False, False, False, True, True, False])
    line = censored_mean(values, bound)
    mean, scale = stats.norm.fit(CensoredData.right_censored(values, bound))
    assert line.mean == pytest.approx(mean, rel=1e-5)
    assert line.standard_deviation == pytest.approx(scale * np.sqrt(4 / 3), rel=1e-3)


def of_values(groups):
    """One-way F from the values themselves."""
    deviations = [np.std(group, ddof=1) for group in groups]
    return one_way([np.mean(group) for group in groups], deviations, [len(one) for one in groups])


def test_one_way_f_agrees_with_statsmodels():
    rng = np.random.default_rng(1951)
    groups = [rng.normal(5, s, n) for s, n in ((1, 4), (2, 7), (0.5, 9))]
    analysis = of_values(groups)
    equal = anova_oneway(groups, use_var="equal")
    assert float(analysis.f_statistic) == pytest.approx(equal.statistic)
    assert float(analysis.p_value) == pytest.approx(equal.pvalue)


def test_exposure_line_agrees_with_statsmodels():
    years = np.array([0.0, 0, 0, 2, 3, 3, 5, 5])
    strength = np.array([6300.0, 6500, 6450, 4672, 4400, 4300, 3200, 3280])
    line = fit_exposure_trend(years, strength)
    other = WLS(strength, np.column_stack([np.ones(8), years])).fit()
    assert (line.intercept, line.slope) == pytest.approx(tuple(other.params))
    np.testing.assert_allclose(line.covariance, other.cov_params(), rtol=1e-9)
    by_level = WLS(strength, np.equal.outer(years, np.unique(years)).astype(float)).fit()
    _, p, _ = by_level.compare_f_test(other)
    assert line.lack_of_fit_p_value == pytest.approx(p)


@pytest.mark.parametrize(("n", "n0", "least"), [(4, 16, 0.925), (5, 10, 0.93), (13, 20, 0.94)])
def test_interval_of_a_change_holds_the_true_change(n, n0, least):
    rng = np.random.default_rng(n)
    worn, new = rng.normal(3241, 300, (20000, n)), rng.normal(6400, 473, (20000, n0))
    result = ratio_of_means(
        worn.mean(1), worn.std(1, ddof=1), n, reference_mean=new.mean(1),
        reference_standard_deviation=new.std(1, ddof=1), reference_n=n0,
    )  # fmt: skip
    true = 3241 / 6400 - 1
    assert least < np.mean((result.low <= true) & (true <= result.high)) < 0.96


@pytest.mark.parametrize(
    ("n", "stop", "distribution"),
    [
        (5, 1.2, "weibull"),
        *(
            pytest.param(n, stop, distribution, marks=pytest.mark.nightly)
            for n, stop, distribution in (
                (3, np.inf, "weibull"),
                (3, np.inf, "lognormal"),
                (5, 1.2, "lognormal"),
                (12, 1.0, "weibull"),
                (12, 1.0, "lognormal"),
            )
        ),
    ],
)
def test_bounds_of_the_median_hold_it(distribution, n, stop):
    rng = np.random.default_rng(n)
    hits = []
    for _ in range(150):
        lives = (
            (rng.weibull(1.5, n) / np.log(2) ** (1 / 1.5))
            if distribution == "weibull"
            else np.exp(0.6 * rng.normal(size=n))
        )
        suspended = lives > stop
        fit = fit_life(1e4 * np.where(suspended, stop, lives) if n > 3 else 1e4 * lives, suspended,
                       distribution=distribution)  # fmt: skip
        if fit.reason == 0:
            hits.append(fit.low <= 1e4 <= fit.high)
    # 150 draws at 95 %: four deviations are 7 points; with run-outs the bounds are a little wide
    assert len(hits) > 120 and np.mean(hits) > 0.88


def test_a_generated_line_of_life_against_load_comes_back():
    rng = np.random.default_rng(30)
    hits, biased, exponents = [], [], []
    for _ in range(200):
        load = np.repeat([0.35, 0.45, 0.55, 0.70], 4)
        lives = np.exp(np.log(400) - 6.0 * np.log(load) + 0.5 * rng.normal(size=16))
        suspended = lives > 2e5
        fit = fit_load_life(load, np.minimum(lives, 2e5), suspended)
        _, low, high, _ = life_at_load(fit, 0.35)
        true = 400 * 0.35**-6.0
        hits.append(low <= true <= high)
        exponents.append(fit.exponent)
        kept = np.polyfit(np.log(load[~suspended]), np.log(lives[~suspended]), 1)
        biased.append(-kept[0])
    assert 0.90 < np.mean(hits) <= 1
    assert np.mean(exponents) == pytest.approx(6.0, abs=0.1)
    # leaving the run-outs out makes the line too flat: the mistake that this avoids
    assert np.mean(biased) < 5.6
