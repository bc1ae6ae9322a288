import numpy as np
import pytest
import statsmodels.api as sm
from scipy import stats

from reduction.experiments.designs import box_behnken, model_matrix, quadratic_exponents
from reduction.experiments.least_squares_fit import fit_least_squares
from reduction.experiments.surface_statistics import diagnose, regress_each

RUNS = box_behnken(3).coded
MATRIX = model_matrix(RUNS, quadratic_exponents(3))


def diagnosed(matrix, responses):
    fit, values = fit_least_squares(matrix, responses), np.asarray(responses, dtype=float)
    regressions = regress_each(values, matrix, fit, 1, None)
    return diagnose({row: one for row, one in regressions.items() if not fit.reason[row]}, fit)


def test_residuals_are_those_of_statsmodels():
    responses = np.random.default_rng(5).normal(size=(3, 15))
    responses[1, 13] = np.nan
    found = diagnosed(MATRIX, responses)
    for row, response in enumerate(responses):
        has = np.isfinite(response)
        other = sm.OLS(response[has], MATRIX[has]).fit().get_influence()
        with np.errstate(divide="ignore", invalid="ignore"):
            pairs = [
                (found.leverage, other.hat_matrix_diag),
                (found.cooks_distance, other.cooks_distance[0]),
                (found.studentized_residual, other.resid_studentized_internal),
                (found.deleted_residual, other.resid_studentized_external),
            ]
        for mine, theirs in pairs:
            np.testing.assert_allclose(mine[row, has], theirs, rtol=1e-7, atol=1e-10)
            assert np.isnan(mine[row, ~has]).all()


def test_straightness_is_that_of_the_probability_plot():
    """Scores of Blom, by scipy's own inverse normal."""
    found = diagnosed(MATRIX, np.random.default_rng(9).normal(size=(2, 15)))
    scores = stats.norm.ppf((np.arange(1, 16) - 0.375) / 15.25)
    for row in range(2):
        ordered = np.sort(found.studentized_residual[row])
        expected = np.corrcoef(ordered, scores)[0, 1] ** 2
        assert found.probability_plot_correlation[row] == pytest.approx(expected, rel=1e-12)


def test_an_outlier_bends_the_probability_plot():
    matrix = np.ones((30, 1))
    even = stats.norm.ppf((np.arange(30) + 0.5) / 30)
    bent = even.copy()
    bent[-1] = 12.0
    found = diagnosed(matrix, [even, bent])
    assert found.probability_plot_correlation[0] > 0.98
    assert found.probability_plot_correlation[1] < 0.7


def test_a_run_that_fixes_a_term_alone_has_no_residual_to_look_at():
    matrix = model_matrix([[0.0], [0.0], [0.0], [1.0]], quadratic_exponents(1))[:, [0, 2]]
    found = diagnosed(matrix, [[1.0, 2.0, 4.0, 9.0]])
    assert found.leverage[0, 3] == pytest.approx(1.0)
    assert np.isnan(found.studentized_residual[0, 3])
    assert np.isfinite(found.studentized_residual[0, :3]).all()


def test_without_one_edge_run_the_opposite_one_fixes_a_term_alone():
    """Run (+1, 0, +1) gone: (-1, 0, -1) is left with the interaction and the sum of the squares."""
    responses = np.random.default_rng(5).normal(size=(1, 15))
    responses[0, (RUNS == [1, 0, 1]).all(axis=1)] = np.nan
    fit = fit_least_squares(MATRIX, responses)
    opposite = (RUNS == [-1, 0, -1]).all(axis=1)
    assert fit.leverage[0, opposite] == pytest.approx(1.0)
    assert np.isnan(diagnosed(MATRIX, responses).studentized_residual[0, opposite]).all()
    assert np.isnan(fit.prediction_sum_of_squares[0])


def test_residuals_of_rounding_are_not_looked_at():
    found = diagnosed(MATRIX, [MATRIX @ np.ones(10)])
    assert np.isnan(found.cooks_distance).all()
    assert np.isnan(found.probability_plot_correlation).all()


def test_one_degree_of_freedom_leaves_no_deleted_residual():
    found = diagnosed(np.ones((2, 1)), [[1.0, 3.0]])
    assert np.isnan(found.deleted_residual).all()
    assert np.isfinite(found.studentized_residual).all()
