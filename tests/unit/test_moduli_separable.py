"""Variable projection and its uncertainties."""

import numpy as np
import pytest
from scipy.optimize import curve_fit

from reduction.errors import DataError, FitError
from reduction.moduli.separable import fit_separable, lag_one_inflation

X = np.linspace(0, 10, 80)


def decay(rates):
    return np.column_stack([np.ones_like(X), np.exp(-np.outer(X, rates))])


def test_exact_data_give_their_parameters_back():
    fit = fit_separable(decay, 2 + 5 * np.exp(-0.7 * X), starts=[[2.0]])
    np.testing.assert_allclose([*fit.amplitude, *fit.shape], [2, 5, 0.7], rtol=1e-9)


def test_uncertainties_agree_with_another_fitter():
    values = 2 + 5 * np.exp(-0.7 * X) + 0.1 * np.random.default_rng(0).standard_normal(X.size)
    fit = fit_separable(decay, values, starts=[[2.0]])
    found, covariance = curve_fit(lambda x, a, b, c: a + b * np.exp(-c * x), X, values, [1, 1, 1])
    np.testing.assert_allclose([*fit.amplitude, *fit.shape], found, rtol=1e-6)
    np.testing.assert_allclose(fit.covariance, covariance, rtol=1e-4)


def test_weights_count_as_repeated_samples():
    values = 2 + 5 * np.exp(-0.7 * X) + 0.1 * np.random.default_rng(1).standard_normal(X.size)
    weights = np.where(X < 5, 2.0, 1.0)
    rows = np.repeat(np.arange(X.size), weights.astype(int))
    weighted = fit_separable(decay, values, starts=[[1.0]], weights=weights)
    repeated = fit_separable(lambda rates: decay(rates)[rows], values[rows], starts=[[1.0]])
    np.testing.assert_allclose(weighted.shape, repeated.shape, rtol=1e-8)
    np.testing.assert_allclose(weighted.amplitude, repeated.amplitude, rtol=1e-8)


def test_the_best_of_the_starts_counts():
    values = 3 * np.exp(-0.2 * X) + 4 * np.exp(-2.0 * X)
    one = fit_separable(
        lambda rates: np.exp(-np.outer(X, rates)), values, starts=[[0.1, 0.11], [0.1, 3.0]]
    )
    np.testing.assert_allclose(np.sort(one.shape), [0.2, 2.0], rtol=1e-6)


def test_parameters_that_cannot_be_told_apart_are_refused():
    with pytest.raises(FitError, match="cannot be told apart.*needed below 1e12"):
        fit_separable(
            lambda rate: np.column_stack([np.exp(-X * rate), 2 * np.exp(-X * rate)]),
            np.exp(-X),
            starts=[[0.9]],
        )


def test_a_parameter_without_effect_is_refused():
    with pytest.raises(FitError, match="no effect on the model; found parameter 1 of 2"):
        fit_separable(lambda shape: np.ones((X.size, 1)) + 0 * shape, X, starts=[[1.0]])


def test_too_few_samples_are_refused():
    with pytest.raises(DataError, match="too few samples for the fit; found 3 samples"):
        fit_separable(
            lambda rate: np.column_stack([np.ones(3), np.exp(-np.arange(3) * rate)]),
            [1.0, 2.0, 3.0],
            starts=[[1.0]],
        )


def test_a_model_that_is_never_finite_is_refused():
    with pytest.raises(FitError, match="no start of the fit converges; found 1 starts"):
        fit_separable(
            lambda shape: np.full((X.size, 1), np.nan) * shape, np.ones(X.size), starts=[[1.0]]
        )


def test_a_missing_value_is_refused():
    with pytest.raises(DataError, match="values are not finite|of values are not finite"):
        fit_separable(decay, np.full(X.size, np.nan), starts=[[1.0]])


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
