import numpy as np
import pytest
import statsmodels.api as sm
from scipy import stats

from reduction.experiments.designs import box_behnken, model_matrix, quadratic_exponents, term_names
from reduction.experiments.fit_results import FIT_REASONS
from reduction.experiments.least_squares_fit import fit_least_squares, two_sided_p
from reduction.record.errors import DataError

EXPONENTS = quadratic_exponents(3)
NAMES = term_names(EXPONENTS, ["f", "Tm", "dT"])
RUNS = box_behnken(3).coded
MATRIX = model_matrix(RUNS, EXPONENTS)


@pytest.fixture
def responses():
    return np.random.default_rng(8).normal(5.0, 1.0, (6, 15))


def test_a_fit_is_that_of_statsmodels(responses):
    fit = fit_least_squares(MATRIX, responses)
    for row, response in enumerate(responses):
        other = sm.OLS(response, MATRIX).fit()
        np.testing.assert_allclose(fit.coefficient[row], other.params, rtol=1e-10)
        deviation = fit.sigma[row] * np.sqrt(np.diag(fit.covariance_factor[0]))
        np.testing.assert_allclose(deviation, other.bse, rtol=1e-10)
        np.testing.assert_allclose(fit.residual[row], other.resid, atol=1e-12)
        np.testing.assert_allclose(1 - fit.residual_sum_of_squares[row]
                                   / fit.total_sum_of_squares[row], other.rsquared, rtol=1e-10)  # fmt: skip
        influence = other.get_influence()
        np.testing.assert_allclose(fit.leverage[0], influence.hat_matrix_diag, rtol=1e-10)
        np.testing.assert_allclose(
            fit.prediction_sum_of_squares[row], np.sum(influence.resid_press**2), rtol=1e-10
        )


def test_responses_with_missing_runs_are_fitted_to_the_runs_they_have(responses):
    responses[1, 3] = responses[4, 3] = responses[2, [0, 14]] = np.nan
    fit = fit_least_squares(MATRIX, responses)
    assert len(fit.is_used) == 3
    for row, response in enumerate(responses):
        has = np.isfinite(response)
        other = sm.OLS(response[has], MATRIX[has]).fit()
        np.testing.assert_allclose(fit.coefficient[row], other.params, rtol=1e-9)
        np.testing.assert_allclose(fit.sigma[row] ** 2, other.scale, rtol=1e-9)
        factor = fit.covariance_factor[fit.pattern[row]]
        np.testing.assert_allclose(factor, other.normalized_cov_params, atol=1e-12)
        assert fit.degrees_of_freedom[row] == other.df_resid
        assert np.isnan(fit.residual[row, ~has]).all()
        assert np.isfinite(fit.fitted[row]).all()
    assert not fit.reason.any()


def test_a_run_without_levels_is_left_out_where_it_has_no_value(responses):
    matrix = MATRIX.copy()
    matrix[5] = np.nan
    responses[:, 5] = np.nan
    fit = fit_least_squares(matrix, responses)
    rest = np.delete(np.arange(15), 5)
    other = fit_least_squares(MATRIX[rest], responses[:, rest])
    np.testing.assert_allclose(fit.coefficient, other.coefficient, rtol=1e-12)
    assert np.isnan(fit.fitted[:, 5]).all()


def test_each_response_that_cannot_be_fitted_says_why(responses):
    responses[0, :6] = np.nan  # nine runs
    responses[1, [0, 1, 2, 3]] = np.nan  # no run moves f and Tm together
    responses[2, 12:] = np.nan  # without a centre the squares add up to the mean
    responses[3] = 4.0
    responses[4] = MATRIX @ np.arange(1.0, 11.0)
    fit = fit_least_squares(MATRIX, responses)
    texts = [FIT_REASONS[code] for code in fit.reason]
    assert texts[0] == "fewer runs with a value than terms"
    assert texts[1] == "the runs with a value leave terms confounded"
    assert texts[2] == "the runs with a value leave terms confounded"
    assert texts[3] == "the response does not vary"
    assert texts[4].startswith("the residuals are rounding")
    assert texts[5] == ""
    assert np.isnan(fit.coefficient[:3]).all()
    np.testing.assert_allclose(fit.coefficient[4], np.arange(1.0, 11.0), rtol=1e-12)


def test_as_many_runs_as_terms_give_a_surface_without_scatter():
    matrix = model_matrix([[-1.0], [0.0], [1.0]], quadratic_exponents(1))
    fit = fit_least_squares(matrix, [[1.0, 2.0, 5.0]])
    np.testing.assert_allclose(fit.coefficient, [[2.0, 1.0, 2.0]], atol=1e-14)
    assert FIT_REASONS[fit.reason[0]].startswith("as many runs as terms")
    assert np.isnan(fit.sigma[0])


def test_the_first_coefficient_is_the_mean_of_the_centre_runs(responses):
    fit = fit_least_squares(MATRIX, responses)
    np.testing.assert_allclose(fit.coefficient[:, 0], responses[:, 12:].mean(axis=1), rtol=1e-12)


@pytest.mark.parametrize("df", [1, 2, 3, 5, 8, 47, 60, 61, 300, 2.5])
def test_p_is_that_of_student(df):
    t = np.concatenate([[0.0], np.logspace(-3, 4, 200), -np.logspace(-3, 4, 50)])
    np.testing.assert_allclose(two_sided_p(t, df), 2 * stats.t.sf(np.abs(t), df), rtol=1e-9)


def test_p_of_many_degrees_of_freedom_at_once_is_that_of_each():
    t, df = np.array([1.0, 2.0, np.nan, 3.0, np.inf]), np.array([5, 4, 5, 0, 5])
    found = two_sided_p(t, df)
    expected = [2 * stats.t.sf(1, 5), 2 * stats.t.sf(2, 4), np.nan, np.nan, 0.0]
    np.testing.assert_allclose(found, expected, rtol=1e-12)


@pytest.mark.parametrize(
    ("responses", "message"),
    [
        (np.zeros((2, 14)), "the responses do not pair up with the runs"),
        (np.zeros((0, 15)), "there is no response to fit"),
        (np.full((1, 15), np.inf), "a response is infinite, or its square is; found 15 values"),
    ],
)
def test_responses_that_cannot_be_used_are_refused(responses, message):
    with pytest.raises(DataError, match=message):
        fit_least_squares(MATRIX, responses)


def test_a_value_without_levels_is_refused(responses):
    matrix = MATRIX.copy()
    matrix[2] = np.nan
    with pytest.raises(DataError, match="a run has a response and no levels; found run 3"):
        fit_least_squares(matrix, responses)
