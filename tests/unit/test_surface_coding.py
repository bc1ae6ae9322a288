import numpy as np
import pytest

from reduction.experiments.designs import (
    coded_from_engineering,
    engineering_from_coded,
    engineering_matrix,
    model_matrix,
    quadratic_exponents,
)
from reduction.record.errors import SettingsError

LOW, HIGH = [0.1, 768.0, 320.0], [0.5, 1920.0, 768.0]


def test_levels_of_the_plan_are_minus_one_nought_and_one():
    levels = [[0.1, 1344.0, 768.0], [0.3, 768.0, 544.0], [0.5, 1920.0, 320.0]]
    coded = coded_from_engineering(levels, low=LOW, high=HIGH)
    np.testing.assert_allclose(coded, [[-1, 0, 1], [0, -1, 0], [1, 1, -1]], atol=1e-15)
    back = engineering_from_coded(coded, low=LOW, high=HIGH)
    np.testing.assert_allclose(back, levels, rtol=1e-14)


@pytest.mark.parametrize("n_factors", [1, 2, 3, 5])
def test_both_equations_give_the_same_surface(n_factors):
    rng = np.random.default_rng(n_factors)
    exponents = quadratic_exponents(n_factors)
    low = rng.uniform(-5, 5, n_factors)
    high = low + rng.uniform(0.1, 9, n_factors)
    coefficient = rng.normal(size=len(exponents))
    coded = rng.uniform(-1.5, 1.5, (20, n_factors))
    levels = engineering_from_coded(coded, low=low, high=high)
    in_levels = engineering_matrix(exponents, low=low, high=high) @ coefficient
    np.testing.assert_allclose(
        model_matrix(levels, exponents) @ in_levels,
        model_matrix(coded, exponents) @ coefficient,
        rtol=1e-8,
        atol=1e-8,
    )


def test_covariance_is_carried_as_draws_of_the_coefficients_are():
    rng = np.random.default_rng(4)
    exponents = quadratic_exponents(2)
    matrix = engineering_matrix(exponents, low=[0.1, 1.0], high=[0.5, 3.0])
    root = rng.normal(size=(6, 6))
    draws = rng.normal(size=(200_000, 6)) @ root.T
    expected = np.cov(draws @ matrix.T, rowvar=False)
    found = matrix @ (root @ root.T) @ matrix.T
    np.testing.assert_allclose(np.diag(found), np.diag(expected), rtol=0.02)


def test_a_high_level_below_its_low_one_is_refused():
    with pytest.raises(SettingsError, match="high level of factor 2 does not lie above"):
        coded_from_engineering([[0.0, 0.0]], low=[0.0, 1.0], high=[1.0, 1.0])


def test_levels_that_do_not_pair_up_are_refused():
    with pytest.raises(SettingsError, match="low and high levels do not pair up"):
        engineering_from_coded([[0.0]], low=[0.0], high=[1.0, 2.0])
