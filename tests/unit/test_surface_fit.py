import numpy as np
import pytest
import statsmodels.api as sm
from scipy import stats

from reduction.experiments.designs import box_behnken, model_matrix, quadratic_exponents, term_names
from reduction.experiments.fit_results import FIT_REASONS
from reduction.experiments.least_squares_fit import fit_least_squares, two_sided_p
from reduction.experiments.response_matrix import block_contrasts
from reduction.experiments.surface_statistics import regress_each
from reduction.record.errors import DataError

EXPONENTS = quadratic_exponents(3)
NAMES = term_names(EXPONENTS, ["f", "Tm", "dT"])
RUNS = box_behnken(3).coded
MATRIX = model_matrix(RUNS, EXPONENTS)


@pytest.fixture
def responses():
    return np.random.default_rng(8).normal(5.0, 1.0, (6, 15))


def gone(values, *places):
    values = values.copy()
    for row, runs in places:
        values[row, runs] = np.nan
    return values


def designs():
    """Columns, responses and blocks over which one fit of many and many of one are compared."""
    rng = np.random.default_rng(8)
    values = rng.normal(5.0, 1.0, (6, 60))
    met = RUNS + rng.uniform(-0.08, 0.08, RUNS.shape)
    several = np.repeat(np.arange(4), 15)
    lines = model_matrix(np.tile(met, (4, 1)), EXPONENTS)
    with_blocks = np.hstack([lines[:, :1], block_contrasts(several), lines[:, 1:]])
    yield "as planned", MATRIX, values[:, :15], None
    yield "as met", model_matrix(met, EXPONENTS), 1e6 * values[:, :15], None
    missing = gone(values[:, :15], (1, [3]), (4, [3]), (2, [0, 14]), (5, [12, 13, 14, 1, 2, 3]))
    yield "missing runs", MATRIX, missing, None
    yield "repeats", model_matrix(np.repeat(met, 2, axis=0), EXPONENTS), values[:, :30], None
    yield "saturated", MATRIX[[0, 1, 2, 4, 5, 7, 8, 10, 11, 12]], values[:, :10], None
    yield "blocks", with_blocks, values, several
    absent = gone(values, (0, several == 3), (1, several == 0), (2, several > 0), (3, [5, 40]))
    yield "blocks that miss", with_blocks, absent, several


@pytest.mark.parametrize(("matrix", "values", "block"), [
    pytest.param(*design, id=name) for name, *design in designs()
])  # fmt: skip
def test_one_fit_of_many_is_that_of_statsmodels_of_each(matrix, values, block):
    n_baseline = 1 if block is None else 4
    fit = fit_least_squares(matrix, values, n_baseline=n_baseline, block=block)
    each = regress_each(values, matrix, fit, n_baseline, block)
    assert sorted(each) == [row for row in range(6) if fit.reason[row] not in (1, 2)]
    for row, other in each.items():
        pattern = fit.pattern[row]
        stands = np.isfinite(fit.coefficient[row])
        factor = fit.covariance_factor[pattern][np.ix_(stands, stands)]
        mine = {
            "coefficient": fit.coefficient[row, stands],
            "covariance": factor,
            "fitted": fit.fitted[row, fit.is_used[pattern]],
            "residual": fit.residual[row, fit.is_used[pattern]],
            "leverage": fit.leverage[pattern, fit.is_used[pattern]],
        }
        theirs = {
            "coefficient": other.params, "covariance": other.normalized_cov_params,
            "fitted": other.fittedvalues, "residual": other.resid,
            "leverage": other.get_influence().hat_matrix_diag,
        }  # fmt: skip
        assert fit.degrees_of_freedom[row] == other.df_resid
        if other.df_resid:
            mine |= {"deviation": fit.sigma[row] * np.sqrt(np.diag(factor)),
                     "sum": fit.residual_sum_of_squares[row]}  # fmt: skip
            theirs |= {"deviation": other.bse, "sum": other.ssr}
        if np.isfinite(fit.prediction_sum_of_squares[row]):
            mine["press"] = fit.prediction_sum_of_squares[row]
            theirs["press"] = np.sum(other.get_influence().resid_press ** 2)
        for name, number in theirs.items():
            size = np.nanmax(values[row])
            least = 1e-13 * size if name in ("residual", "coefficient", "fitted") else 1e-14
            np.testing.assert_allclose(mine[name], number, rtol=1e-9, atol=least, err_msg=name)


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
