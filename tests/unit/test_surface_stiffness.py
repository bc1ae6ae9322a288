"""Forms of dynamic stiffness: truth comes back, against statsmodels, beside the surface."""

import numpy as np
import pytest
import statsmodels.api as sm

from reduction.experiments.designs import box_behnken
from reduction.experiments.stiffness_forms import (
    compare_stiffness_forms,
    fit_del_vecchio_stiffness,
    fit_mean_load_stiffness,
)
from reduction.record.errors import DataError, SettingsError

STRENGTH = 28_470.0  # 6400 lbf
CODED = box_behnken(3).coded
FREQUENCY = 0.3 + 0.2 * CODED[:, 0]
MEAN = STRENGTH * (0.21 + 0.09 * CODED[:, 1])
HALF = STRENGTH * (0.085 + 0.035 * CODED[:, 2])
LEVELS = {"mean_tension": MEAN, "tension_amplitude": HALF, "frequency": FREQUENCY}
TRUTH = np.array([12.0, 0.45, 0.30, 1.5])


def stiffness(noise=0.0, n=(), seed=3):
    period = 1 / FREQUENCY
    a, b, c, d = TRUTH
    relative = a + b * 100 * MEAN / STRENGTH - c * 100 * HALF / STRENGTH - d * np.log10(period)
    return STRENGTH * (relative + noise * np.random.default_rng(seed).standard_normal((*n, 15)))


def del_vecchio(values, load_amplitude="half-range", **options):
    return fit_del_vecchio_stiffness(
        values, **LEVELS, rated_break_strength=STRENGTH, load_amplitude=load_amplitude, **options
    )


def test_the_four_coefficients_come_back_with_the_signs_of_the_equation():
    form = del_vecchio(stiffness(noise=1e-9))
    np.testing.assert_allclose(form.coefficient, TRUTH, rtol=1e-6)
    assert form.coefficient_names == ("a", "b", "c", "d")


def test_the_full_range_halves_c_and_nothing_else():
    values = stiffness(noise=0.3)
    half, full = del_vecchio(values), del_vecchio(values, "full-range")
    ratio = full.coefficient / half.coefficient
    np.testing.assert_allclose(ratio, [1, 1, 0.5, 1])
    uncertainty = full.coefficient_standard_uncertainty / half.coefficient_standard_uncertainty
    np.testing.assert_allclose(uncertainty, [1, 1, 0.5, 1])
    assert "half range" in half.equation and "full range" in full.equation
    np.testing.assert_allclose(full.quality.sigma, half.quality.sigma)


def test_every_statistic_is_that_of_statsmodels():
    values = stiffness(noise=0.4)
    form = del_vecchio(values)
    percent = 100 / STRENGTH
    matrix = np.column_stack([np.ones(15), percent * MEAN, percent * HALF, np.log10(1 / FREQUENCY)])
    reference = sm.OLS(values / STRENGTH, matrix).fit()
    sign = np.array([1, 1, -1, -1])
    np.testing.assert_allclose(form.coefficient, sign * reference.params, rtol=1e-9)
    np.testing.assert_allclose(form.coefficient_standard_uncertainty, reference.bse, rtol=1e-9)
    np.testing.assert_allclose(form.p_value, reference.pvalues, rtol=1e-8)
    interval = np.sort(sign[:, None] * reference.conf_int(0.05), axis=1)
    np.testing.assert_allclose(form.coefficient_low, interval[:, 0], rtol=1e-9)
    np.testing.assert_allclose(form.coefficient_high, interval[:, 1], rtol=1e-9)
    np.testing.assert_allclose(
        form.covariance, np.outer(sign, sign) * reference.cov_params(), atol=1e-12
    )
    np.testing.assert_allclose(form.stiffness_fitted, reference.fittedvalues * STRENGTH)
    np.testing.assert_allclose(form.stiffness_residual, values - form.stiffness_fitted, atol=1e-6)
    quality = form.quality
    assert quality.r2[0] == pytest.approx(reference.rsquared)
    assert quality.adjusted_r2[0] == pytest.approx(reference.rsquared_adj)
    assert quality.sigma[0] == pytest.approx(np.sqrt(reference.mse_resid))
    press = np.sum(reference.get_influence().resid_press ** 2)
    assert quality.prediction_sum_of_squares[0] == pytest.approx(press)
    assert quality.predicted_r2[0] == pytest.approx(1 - press / reference.centered_tss)
    # AICc with the scatter counted, less the constant n (1 + log 2 pi) of the full likelihood
    k, n = 5, 15
    full = 2 * k - 2 * reference.llf + 2 * k * (k + 1) / (n - k - 1)
    assert quality.aicc[0] == pytest.approx(full - n * (1 + np.log(2 * np.pi)))


def test_intervals_hold_the_truth_as_often_as_they_say():
    form = del_vecchio(stiffness(noise=0.5, n=(4000,)))
    inside = (form.coefficient_low <= TRUTH) & (TRUTH <= form.coefficient_high)
    np.testing.assert_allclose(inside.mean(axis=0), 0.95, atol=0.012)


def test_alpha_and_beta_come_back():
    values = 9.0 * STRENGTH + 21.0 * MEAN
    form = fit_mean_load_stiffness(values, mean_tension=MEAN, rated_break_strength=STRENGTH)
    np.testing.assert_allclose(form.coefficient, [9, 21], rtol=1e-10)
    assert form.coefficient_names == ("alpha", "beta")
    assert form.mean_load_range == pytest.approx((0.12, 0.30))


def test_alpha_and_beta_do_not_depend_on_the_unit_of_force():
    values = stiffness(noise=0.3)
    one = fit_mean_load_stiffness(values, mean_tension=MEAN, rated_break_strength=STRENGTH)
    other = fit_mean_load_stiffness(
        1e-3 * values, mean_tension=1e-3 * MEAN, rated_break_strength=1e-3 * STRENGTH
    )
    np.testing.assert_allclose(one.coefficient, other.coefficient)


def test_many_ropes_are_each_as_alone_and_a_missing_run_stays_theirs():
    values = stiffness(noise=0.3, n=(2, 3))
    values[1, 2, 4] = np.nan
    many, alone = del_vecchio(values), del_vecchio(values[0, 1])
    assert many.coefficient.shape == (2, 3, 4) and many.covariance.shape == (2, 3, 4, 4)
    np.testing.assert_allclose(many.coefficient[0, 1], alone.coefficient)
    assert many.quality.degrees_of_freedom[..., 0].tolist() == [[11, 11, 11], [11, 11, 10]]
    left = np.delete(values[1, 2], 4)
    short = fit_del_vecchio_stiffness(
        left,
        **{name: np.delete(level, 4) for name, level in LEVELS.items()},
        rated_break_strength=STRENGTH,
        load_amplitude="half-range",
    )
    np.testing.assert_allclose(many.coefficient[1, 2], short.coefficient)


def test_one_frequency_alone_has_no_d_and_says_why():
    form = fit_del_vecchio_stiffness(
        stiffness(noise=0.3),
        mean_tension=MEAN,
        tension_amplitude=HALF,
        frequency=np.full(15, 0.3),
        rated_break_strength=STRENGTH,
        load_amplitude="half-range",
    )
    assert np.isnan(form.coefficient).all()
    assert form.quality.reason.tolist() == ["the runs with a value leave terms confounded"]


def test_the_comparison_is_that_of_each_form_alone():
    values = stiffness(noise=0.4)
    quality = compare_stiffness_forms(values, **LEVELS, coded=CODED, rated_break_strength=STRENGTH)
    assert quality.forms == ("del-vecchio", "mean-load", "quadratic")
    assert quality.n_coefficients == (4, 2, 10)
    assert quality.degrees_of_freedom.tolist() == [11, 13, 5]
    alone = del_vecchio(values).quality
    mean_load = fit_mean_load_stiffness(values, mean_tension=MEAN, rated_break_strength=STRENGTH)
    for place, one in enumerate((alone, mean_load.quality)):
        for name in ("sigma", "r2", "adjusted_r2", "predicted_r2", "aicc"):
            assert getattr(quality, name)[place] == pytest.approx(getattr(one, name)[0])


def test_the_quadratic_of_the_comparison_is_that_of_statsmodels():
    values = stiffness(noise=0.4)
    quality = compare_stiffness_forms(values, **LEVELS, coded=CODED, rated_break_strength=STRENGTH)
    x, y, z = CODED.T
    matrix = np.column_stack([np.ones(15), x, y, z, x * x, y * y, z * z, x * y, x * z, y * z])
    reference = sm.OLS(values / STRENGTH, matrix).fit()
    assert quality.r2[2] == pytest.approx(reference.rsquared)
    assert quality.adjusted_r2[2] == pytest.approx(reference.rsquared_adj)
    assert quality.sigma[2] == pytest.approx(np.sqrt(reference.mse_resid))
    press = np.sum(reference.get_influence().resid_press ** 2)
    assert quality.prediction_sum_of_squares[2] == pytest.approx(press)


def test_the_form_that_made_the_runs_wins_by_aicc_and_by_prediction():
    quality = compare_stiffness_forms(
        stiffness(noise=0.4, n=(200,)), **LEVELS, coded=CODED, rated_break_strength=STRENGTH
    )
    assert np.mean(np.argmin(quality.aicc, axis=-1) == 0) > 0.9
    assert np.argmax(np.median(quality.predicted_r2, axis=0)) == 0
    # r2 alone always prefers the ten terms
    assert np.all(np.argmax(quality.r2, axis=-1) == 2)


def test_a_run_without_a_level_is_left_out_of_all_three():
    coded, frequency = CODED.copy(), FREQUENCY.copy()
    coded[0, 0] = frequency[12] = np.nan
    quality = compare_stiffness_forms(
        stiffness(noise=0.4),
        mean_tension=MEAN,
        tension_amplitude=HALF,
        frequency=frequency,
        coded=coded,
        rated_break_strength=STRENGTH,
    )
    assert (quality.degrees_of_freedom + np.array(quality.n_coefficients)).tolist() == [13, 13, 13]
    # 13 runs less ten terms, a scatter and one: the last AICc there is
    assert np.isfinite(quality.aicc).all()


def test_a_saturated_surface_has_no_scatter_and_says_why():
    keep = [0, 1, 2, 4, 5, 7, 8, 10, 11, 12]
    quality = compare_stiffness_forms(
        stiffness(noise=0.4)[keep],
        **{name: level[keep] for name, level in LEVELS.items()},
        coded=CODED[keep],
        rated_break_strength=STRENGTH,
    )
    assert np.isnan(quality.sigma[2]) and np.isnan(quality.aicc[2])
    assert quality.reason[2] and not quality.reason[0]


def test_break_strength_is_asked_for():
    with pytest.raises(
        SettingsError, match="no break strength; needed .*Give rated_break_strength"
    ):
        fit_mean_load_stiffness(stiffness(), mean_tension=MEAN, rated_break_strength=None)
    with pytest.raises(SettingsError, match="break strength cannot be; found -1"):
        fit_mean_load_stiffness(stiffness(), mean_tension=MEAN, rated_break_strength=-1.0)


def test_an_option_that_is_neither_is_refused():
    with pytest.raises(SettingsError, match="one of two things; found range; needed half-range or"):
        del_vecchio(stiffness(), "range")


def test_levels_that_cannot_be_are_refused():
    with pytest.raises(
        DataError, match="values of mean_tension are not above zero, first at index 0"
    ):
        fit_mean_load_stiffness(stiffness(), mean_tension=-MEAN, rated_break_strength=STRENGTH)
    with pytest.raises(DataError, match="series do not pair up"):
        fit_del_vecchio_stiffness(
            stiffness(),
            mean_tension=MEAN[:3],
            tension_amplitude=HALF,
            frequency=FREQUENCY,
            rated_break_strength=STRENGTH,
            load_amplitude="half-range",
        )


def test_runs_that_are_all_missing_say_so():
    nothing = np.full(15, np.nan)
    form = fit_mean_load_stiffness(nothing, mean_tension=nothing, rated_break_strength=STRENGTH)
    assert np.isnan(form.coefficient).all() and np.isnan(form.mean_load_range).all()
    assert form.quality.reason.tolist() == ["fewer runs with a value than terms"]
