import numpy as np
import pytest

from reduction.experiments.designs import (
    gradient_matrix,
    model_matrix,
    quadratic_exponents,
    term_kinds,
    term_names,
)
from reduction.record.errors import DataError, SettingsError


def test_terms_of_three_factors_stand_in_the_order_of_equation_5():
    names = term_names(quadratic_exponents(3), ["f", "Tm", "dT"])
    assert names == (
        "mean", "f^2", "Tm^2", "dT^2", "f", "Tm", "dT", "f*Tm", "f*dT", "Tm*dT",
    )  # fmt: skip


@pytest.mark.parametrize("n_factors", range(1, 8))
def test_there_are_as_many_terms_as_a_quadratic_has(n_factors):
    exponents = quadratic_exponents(n_factors)
    assert len(exponents) == (n_factors + 1) * (n_factors + 2) // 2
    assert len({tuple(row) for row in exponents}) == len(exponents)
    kinds = term_kinds(exponents)
    assert kinds.count("square") == kinds.count("linear") == n_factors


def test_model_matrix_is_the_equation_written_out():
    f, mean, swing = 0.3, -0.7, 0.9
    row = model_matrix([f, mean, swing], quadratic_exponents(3))
    written = [1, f**2, mean**2, swing**2, f, mean, swing, f * mean, f * swing, mean * swing]
    np.testing.assert_allclose(row, written, rtol=1e-15)


def test_gradient_matrix_is_the_difference_of_the_model_matrix():
    exponents, step = quadratic_exponents(3), 1e-6
    points = np.random.default_rng(2).uniform(-1, 1, (4, 3))
    found = gradient_matrix(points, exponents)
    for factor in range(3):
        move = step * np.eye(3)[factor]
        difference = model_matrix(points + move, exponents) - model_matrix(points - move, exponents)
        np.testing.assert_allclose(found[:, factor], difference / (2 * step), atol=1e-9)


def test_no_factor_is_refused():
    with pytest.raises(SettingsError, match="a surface has no factor"):
        quadratic_exponents(0)


def test_a_term_of_third_order_is_refused():
    with pytest.raises(SettingsError, match="above second order; found order 3"):
        term_kinds(np.array([[2, 1]]))


@pytest.mark.parametrize("names", [["f"], ["f", "f"]])
def test_names_that_do_not_pair_up_are_refused(names):
    with pytest.raises(SettingsError, match="needed 2 different names"):
        term_names(quadratic_exponents(2), names)


def test_points_that_are_not_finite_are_refused():
    with pytest.raises(DataError, match="1 of 2 values of the levels are not finite"):
        model_matrix([1.0, np.nan], quadratic_exponents(2))
