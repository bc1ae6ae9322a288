import numpy as np
import pytest

from reduction.experiments.designs import box_behnken, model_matrix, quadratic_exponents, term_names
from reduction.experiments.run_sheet import _find_confounded, covariance_factor, variance_factor
from reduction.record.errors import FitError

EXPONENTS = quadratic_exponents(3)
NAMES = term_names(EXPONENTS, ["f", "Tm", "dT"])
MATRIX = model_matrix(box_behnken(3).coded, EXPONENTS)


def test_the_design_of_the_report_has_the_variance_factors_of_its_algebra():
    factor = covariance_factor(MATRIX, names=NAMES)
    expected = [1 / 3, *[13 / 48] * 3, *[1 / 8] * 3, *[1 / 4] * 3]
    np.testing.assert_allclose(np.diag(factor), expected, rtol=1e-12)
    assert np.linalg.cond(MATRIX) == pytest.approx(4.24, abs=0.005)
    corner = variance_factor(model_matrix([[1.0, 1.0, 1.0]], EXPONENTS), factor)
    assert corner[0] == pytest.approx(1.396, abs=0.0005)
    assert variance_factor(MATRIX, factor).max() == pytest.approx(0.75, abs=1e-12)


def test_variance_factors_of_several_patterns_pair_up_with_their_responses():
    factors = np.stack([np.eye(2), 4 * np.eye(2)])
    rows = np.ones((3, 1, 2))
    found = variance_factor(rows, factors, pattern=np.array([1, 0, 1]))
    np.testing.assert_array_equal(found.ravel(), [8.0, 2.0, 8.0])


def test_fewer_runs_than_terms_are_refused():
    with pytest.raises(FitError, match="fewer runs than terms; found 9 runs; needed 10"):
        covariance_factor(MATRIX[:9], names=NAMES)


def test_a_singular_design_names_what_it_confounds():
    two_levels = np.sign(np.random.default_rng(0).normal(size=(20, 3)))
    with pytest.raises(FitError, match=r"cannot tell all terms apart; found f\^2 with mean; "):
        covariance_factor(model_matrix(two_levels, EXPONENTS), names=NAMES)


def test_a_column_of_noughts_is_named():
    assert _find_confounded([[1.0, 0.0], [1.0, 0.0]], ["mean", "f"]) == ("f is zero in every run",)
    with pytest.raises(FitError, match="f is zero in every run"):
        covariance_factor([[1.0, 0.0], [1.0, 0.0]], names=["mean", "f"])
