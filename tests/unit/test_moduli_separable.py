"""Variable projection and its uncertainties."""

import numpy as np
import pytest
from scipy.optimize import curve_fit, least_squares

from reduction.record.errors import DataError, FitError
from reduction.stages.moduli.least_squares import fit_separable, lag_one_inflation

X = np.linspace(0, 10, 80)


def decay(rates, x=X):
    """Exponentials, and how they change with their rates; one set of rates a row."""
    columns = np.exp(-x[:, None] * rates[:, None, :])
    return columns, -x[:, None] * columns


def level_and_decay(rates, x=X):
    columns, slopes = decay(rates, x)
    return np.concatenate([np.ones((len(rates), x.size, 1)), columns], axis=2), slopes


def peaks(centres):
    """Two peaks of Cauchy: a model that is no sum of exponentials."""
    off = X[:, None] - centres[:, None, :]
    columns = 1 / (1 + off**2)
    return columns, 2 * off * columns**2


def test_exact_data_give_their_parameters_back():
    fit = fit_separable(level_and_decay, 2 + 5 * np.exp(-0.7 * X), starts=[[2.0]])
    np.testing.assert_allclose([*fit.amplitude, *fit.shape], [2, 5, 0.7], rtol=1e-9)


def test_uncertainties_agree_with_another_fitter():
    values = 2 + 5 * np.exp(-0.7 * X) + 0.1 * np.random.default_rng(0).standard_normal(X.size)
    fit = fit_separable(level_and_decay, values, starts=[[2.0]])
    found, covariance = curve_fit(lambda x, a, b, c: a + b * np.exp(-c * x), X, values, [1, 1, 1])
    np.testing.assert_allclose([*fit.amplitude, *fit.shape], found, rtol=1e-6)
    np.testing.assert_allclose(fit.covariance, covariance, rtol=1e-4)


MODELS = {
    "two decays": (decay, [0.3, 2.0], [4.0, 3.0], [[0.1, 0.9], [0.5, 3.0]]),
    "level and two decays": (level_and_decay, [0.4, 3.0], [1.0, 4.0, 5.0], [[0.2, 1.0]]),
    "two peaks": (peaks, [3.0, 6.5], [2.0, -1.0], [[2.0, 7.0], [4.0, 6.0]]),
}


@pytest.mark.parametrize("noise", [0.0, 0.02, 0.3])
@pytest.mark.parametrize("model", MODELS)
def test_the_minimum_is_that_of_a_trust_region_over_all_parameters(model, noise):
    basis, shape, amplitude, starts = MODELS[model]
    truth = np.concatenate([amplitude, shape])
    n_amplitudes = len(amplitude)

    def curve(parameters):
        columns, _ = basis(parameters[None, n_amplitudes:])
        return columns[0] @ parameters[:n_amplitudes]

    values = curve(truth) + noise * np.random.default_rng(5).standard_normal(X.size)
    weights = 1 + X / 10
    fit = fit_separable(basis, values, starts=starts, weights=weights)
    other = least_squares(
        lambda parameters: np.sqrt(weights) * (values - curve(parameters)),
        truth,
        jac="3-point",
        x_scale="jac",
        xtol=1e-15,
        ftol=1e-15,
        gtol=1e-15,
    )
    order = np.argsort(fit.shape)
    level = n_amplitudes - order.size
    found = [*fit.amplitude[:level], *fit.amplitude[level:][order], *fit.shape[order]]
    assert fit.residual_sum_of_squares <= 2 * other.cost * (1 + 1e-12) + 1e-20
    np.testing.assert_allclose(found, other.x, rtol=1e-6)


def test_weights_count_as_repeated_samples():
    values = 2 + 5 * np.exp(-0.7 * X) + 0.1 * np.random.default_rng(1).standard_normal(X.size)
    weights = np.where(X < 5, 2.0, 1.0)
    rows = np.repeat(np.arange(X.size), weights.astype(int))
    weighted = fit_separable(level_and_decay, values, starts=[[1.0]], weights=weights)
    repeated = fit_separable(
        lambda rates: level_and_decay(rates, X[rows]), values[rows], starts=[[1.0]]
    )
    np.testing.assert_allclose(weighted.shape, repeated.shape, rtol=1e-8)
    np.testing.assert_allclose(weighted.amplitude, repeated.amplitude, rtol=1e-8)


def test_the_best_of_the_starts_counts():
    values = 3 * np.exp(-0.2 * X) + 4 * np.exp(-2.0 * X)
    one = fit_separable(decay, values, starts=[[0.1, 0.11], [0.1, 3.0]])
    np.testing.assert_allclose(np.sort(one.shape), [0.2, 2.0], rtol=1e-6)


def test_a_start_at_which_the_model_overflows_is_left_out():
    values = 2 + 5 * np.exp(-0.7 * X)
    fit = fit_separable(level_and_decay, values, starts=[[-1e6], [2.0]])
    np.testing.assert_allclose(fit.shape, [0.7], rtol=1e-9)


def test_the_order_and_number_of_starts_do_not_move_the_answer():
    values = 3 * np.exp(-0.2 * X) + 4 * np.exp(-2.0 * X)
    values = values + 0.05 * np.random.default_rng(3).standard_normal(X.size)
    one = fit_separable(decay, values, starts=[[0.1, 3.0]])
    several = fit_separable(decay, values, starts=[[0.3, 1.0], [3.0, 0.1], [0.1, 3.0]])
    np.testing.assert_allclose(np.sort(several.shape), np.sort(one.shape), rtol=1e-12)


def test_of_two_fits_as_good_the_smaller_shapes_are_taken():
    def alike(shapes):
        # the shapes 1 + s and 1 - s give one curve
        aside = shapes[:, None, :] - 1
        return X[:, None] ** 2 + aside**2, 2 * aside + np.zeros((X.size, 1))

    values = 2 * (X**2 + 9)
    values = values + 0.1 * np.random.default_rng(4).standard_normal(X.size)
    for starts in ([[3.0], [-1.0]], [[-1.0], [3.0]]):
        fit = fit_separable(alike, values, starts=starts)
        np.testing.assert_allclose(fit.shape, [-2.0], rtol=0.01)


def test_parameters_that_cannot_be_told_apart_are_refused():
    def twice_the_same(rates):
        columns, slopes = decay(rates)
        return np.concatenate(
            [2 * np.ones_like(columns), np.ones_like(columns), columns], 2
        ), slopes

    with pytest.raises(FitError, match="cannot be told apart.*needed below 1e12"):
        fit_separable(twice_the_same, 1 + np.exp(-X), starts=[[0.9]])


def test_a_parameter_without_effect_is_refused():
    def level(shapes):
        ones = np.ones((len(shapes), X.size, 1))
        return ones, 0 * ones

    with pytest.raises(FitError, match="no effect on the model; found parameter 1 of 2"):
        fit_separable(level, X, starts=[[1.0]])


def test_too_few_samples_are_refused():
    with pytest.raises(DataError, match="too few samples for the fit; found 3 samples"):
        fit_separable(
            lambda rates: level_and_decay(rates, np.arange(3.0)), [1.0, 2.0, 3.0], starts=[[1.0]]
        )


def test_a_model_that_is_never_finite_is_refused():
    def never(shapes):
        nothing = np.full((len(shapes), X.size, 1), np.nan)
        return nothing, nothing

    with pytest.raises(FitError, match="no start of the fit converges; found 1 starts"):
        fit_separable(never, np.ones(X.size), starts=[[1.0]])


def test_a_missing_value_is_refused():
    with pytest.raises(DataError, match="values are not finite|of values are not finite"):
        fit_separable(level_and_decay, np.full(X.size, np.nan), starts=[[1.0]])


@pytest.mark.parametrize("memory", [0.0, 0.5, 0.8])
def test_inflation_is_that_of_autoregressive_noise(memory):
    rng = np.random.default_rng(2)
    noise = np.zeros(20000)
    for index in range(1, noise.size):
        noise[index] = memory * noise[index - 1] + rng.standard_normal()
    expected = (1 + memory) / (1 - memory)
    assert lag_one_inflation(noise) == pytest.approx(expected, rel=0.1)


def test_inflation_of_nothing_is_one():
    assert lag_one_inflation(np.zeros(10)) == 1.0
    assert lag_one_inflation([1.0]) == 1.0


def test_inflation_needs_finite_residuals():
    with pytest.raises(DataError, match="residual are not finite"):
        lag_one_inflation([1.0, np.nan])
