"""None"""

import numpy as np
import pandas as pd
import pytest
import statsmodels.api as sm
from scipy import stats
from statsmodels.formula.api import ols
from statsmodels.stats.anova import anova_lm

from reduction.experiments.designs import box_behnken, model_matrix, quadratic_exponents
from reduction.experiments.fit_results import (
    FIT_REASONS,
    LACK_OF_FIT_REASONS,
    STATIONARY_KINDS,
    STATIONARY_REASONS,
)
from reduction.experiments.least_squares_fit import (
    fit_least_squares,
    lack_of_fit,
    replicate_cells,
    statistics_from_r2,
    two_sided_p,
)
from reduction.experiments.response_matrix import block_contrasts
from reduction.experiments.stationary_point import _curvature, canonical_analysis
from reduction.experiments.surface_statistics import anova_table, diagnose, regress_each
from reduction.record.errors import DataError, SettingsError

EXPONENTS = quadratic_exponents(3)
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


MEAN = np.ones((15, 1))


def fitted(responses, runs=RUNS):
    return fit_least_squares(model_matrix(runs, EXPONENTS), np.atleast_2d(responses))


def test_sequential_sums_are_those_of_statsmodels_for_levels_as_met():
    rng = np.random.default_rng(6)
    runs = RUNS + rng.normal(0, 0.05, RUNS.shape)
    response = rng.normal(size=15) + runs[:, 0]
    matrix = model_matrix(runs, EXPONENTS)[:, [0, 4, 5, 6, 7, 8, 9, 1, 2, 3]]
    fit = fit_least_squares(matrix, [response])
    data = pd.DataFrame({"y": response, "a": runs[:, 0], "b": runs[:, 1], "c": runs[:, 2]})
    other = anova_lm(
        ols("y ~ a + b + c + a:b + a:c + b:c + I(a**2) + I(b**2) + I(c**2)", data).fit(), typ=1
    )
    groups = {"first order": slice(1, 4), "interactions": slice(4, 7), "squares": slice(7, 10)}
    lack = lack_of_fit(fit, replicate_cells(runs, tolerance=0.3), baseline=MEAN)
    table = anova_table(regress_each(response[None], matrix, fit, 1, None), groups, fit, lack)
    each = other["sum_sq"].to_numpy()[:-1].reshape(3, 3).sum(axis=1)
    np.testing.assert_allclose(table.sum_of_squares[0, :3], each, rtol=1e-9)
    f = each / 3 / other.loc["Residual", "mean_sq"]
    np.testing.assert_allclose(table.f[0, :3], f, rtol=1e-9)
    np.testing.assert_allclose(table.p_value[0, :3], stats.f.sf(f, 3, 5), rtol=1e-9)
    assert table.source[-1] == "total"
    assert table.sum_of_squares[0, -1] == pytest.approx(np.sum((response - response.mean()) ** 2))
    assert table.degrees_of_freedom[0].tolist() == [3, 3, 3, 5, 3, 2, 14]
    assert table.sum_of_squares[0, 4] + table.sum_of_squares[0, 5] == pytest.approx(
        table.sum_of_squares[0, 3]
    )


def test_near_repeats_are_one_cell_and_chains_of_them_are_not():
    chain = np.stack([np.arange(5) * 0.08, np.zeros(5)], axis=1)
    cell = replicate_cells(chain, tolerance=0.1)
    for number in np.unique(cell):
        assert np.ptp(chain[cell == number, 0]) <= 0.1 + 1e-9
    assert len(np.unique(cell)) >= 3


def test_exact_repeats_are_found_without_tolerance_after_a_change_of_units():
    levels = 0.1 + 0.2 * (RUNS + 1)
    coded = (levels - 0.3) / 0.2
    assert len(np.unique(replicate_cells(coded, tolerance=0.0))) == 13


def test_a_single_run_is_its_own_cell():
    assert replicate_cells([[np.nan], [1.0]]).tolist() == [-1, 0]


@pytest.mark.parametrize("tolerance", [-0.1, 0.5])
def test_a_tolerance_out_of_range_is_refused(tolerance):
    with pytest.raises(SettingsError, match="tolerance of repeated runs is out of range"):
        replicate_cells(RUNS, tolerance=tolerance)


def test_near_repeats_reject_as_often_as_the_level_says():
    """A true quadratic, levels met within 0.03 and scatter alone: 5 % false alarms."""
    rng = np.random.default_rng(11)
    runs = RUNS + rng.uniform(-0.03, 0.03, RUNS.shape)
    truth = model_matrix(runs, EXPONENTS) @ np.array([9, 1, -2, 1, 2, 4, 1, 1, 0, 1.0])
    fit = fitted(truth + rng.normal(0, 0.3, (20_000, 15)), runs)
    lack = lack_of_fit(fit, replicate_cells(runs), baseline=MEAN)
    assert not lack.reason.any()
    assert np.mean(lack.p_value < 0.05) == pytest.approx(0.05, abs=0.006)


def test_steep_surfaces_over_near_repeats_do_not_pass_for_pure_error():
    """The slope makes the raw repeats differ 30 times more than the scatter does."""
    rng = np.random.default_rng(12)
    runs = RUNS.copy()
    runs[12:, 0] = [-0.05, 0.0, 0.05]
    noise = rng.normal(0, 0.05, (4000, 15))
    fit = fitted(30 * runs[:, 0] + noise, runs)
    lack = lack_of_fit(fit, replicate_cells(runs), baseline=MEAN)
    mean_square = np.mean(lack.pure_error_sum_of_squares / lack.pure_error_degrees_of_freedom)
    assert mean_square == pytest.approx(0.05**2, rel=0.05)


def test_the_lack_of_fit_of_exact_repeats_is_that_of_two_models_of_statsmodels():
    rng = np.random.default_rng(4)
    values, cell = rng.normal(size=(2, 15)) + RUNS[:, 0] ** 3, replicate_cells(RUNS)
    fit = fit_least_squares(MATRIX[:, :7], values)
    lack = lack_of_fit(fit, cell, baseline=MEAN)
    for row, response in enumerate(values):
        of_cells = sm.OLS(response, (cell[:, None] == np.arange(13)).astype(float)).fit()
        f, p_value, degrees = of_cells.compare_f_test(sm.OLS(response, MATRIX[:, :7]).fit())
        assert lack.degrees_of_freedom[row] == degrees
        assert lack.f[row] == pytest.approx(f, rel=1e-9)
        assert lack.p_value[row] == pytest.approx(p_value, rel=1e-9)


def test_each_lack_of_fit_that_cannot_be_tested_says_why():
    rng = np.random.default_rng(1)
    responses = rng.normal(size=(5, 15))
    responses[0, 13:] = np.nan  # one centre run left
    responses[1, 12:] = 2.0  # centres agree
    responses[2] = MATRIX @ np.ones(10)
    responses[3, :6] = np.nan
    fit = fitted(responses)
    lack = lack_of_fit(fit, replicate_cells(RUNS), baseline=MEAN)
    texts = [LACK_OF_FIT_REASONS[code] for code in lack.reason]
    assert texts == [
        "no run is repeated",
        "the repeated runs agree to the last digit",
        "there is no surface, or its residuals are rounding",
        "there is no surface, or its residuals are rounding",
        "",
    ]
    assert np.isfinite(lack.f).tolist() == [False] * 4 + [True]


def test_runs_no_more_different_than_terms_cannot_lack_fit():
    matrix = model_matrix([[-1.0], [0.0], [0.0], [1.0]], quadratic_exponents(1))
    fit = fit_least_squares(matrix, [[1.0, 2.0, 2.5, 4.0]])
    lack = lack_of_fit(fit, np.array([0, 1, 1, 2]), baseline=np.ones((4, 1)))
    assert LACK_OF_FIT_REASONS[lack.reason[0]] == "no more different runs than terms"


MATRIX_OF_OVERALL = model_matrix(box_behnken(3).coded, quadratic_exponents(3))


def test_statistics_are_those_of_f():
    found = statistics_from_r2(0.95, n_runs=15, n_terms=10)
    assert found.f == pytest.approx((0.95 / 9) / (0.05 / 5), rel=1e-12)
    assert found.p_value == pytest.approx(stats.f.sf(found.f, 9, 5), rel=1e-10)
    assert found.critical == pytest.approx(4.772, abs=5e-4)
    assert found.printed_f / found.f == pytest.approx(18 / 25, rel=1e-12)
    assert found.printed_critical == pytest.approx(stats.f.isf(0.05, 4, 10), rel=1e-10)


def test_fourteen_runs_have_nine_and_four_degrees_of_freedom():
    found = statistics_from_r2([0.95, 0.95, 0.95], n_runs=[14, 11, 10], n_terms=10)
    np.testing.assert_allclose(found.critical[:2], stats.f.isf(0.05, 9, [4, 1]), rtol=1e-10)
    assert np.isfinite(found.printed_f).tolist() == [True, False, False]
    assert np.isfinite(found.f).tolist() == [True, True, False]


def test_noise_alone_has_the_r2_of_its_degrees_of_freedom():
    """Nine terms of fourteen degrees of freedom: mean r2 is 9/14, .643."""
    responses = np.random.default_rng(3).normal(size=(20_000, 15))
    fit = fit_least_squares(MATRIX_OF_OVERALL, responses)
    r2 = 1 - fit.residual_sum_of_squares / fit.total_sum_of_squares
    assert r2.mean() == pytest.approx(9 / 14, abs=0.003)
    rejected = statistics_from_r2(r2, n_runs=15, n_terms=10).p_value < 0.05
    assert rejected.mean() == pytest.approx(0.05, abs=0.005)


def test_the_mean_alone_has_no_statistics():
    with pytest.raises(SettingsError, match="the mean alone has no F"):
        statistics_from_r2(0.9, n_runs=15, n_terms=1)


MATRIX_OF_DIAGNOSTICS = model_matrix(RUNS, quadratic_exponents(3))


def diagnosed(matrix, responses):
    fit, values = fit_least_squares(matrix, responses), np.asarray(responses, dtype=float)
    regressions = regress_each(values, matrix, fit, 1, None)
    return diagnose({row: one for row, one in regressions.items() if not fit.reason[row]}, fit)


def test_residuals_are_those_of_statsmodels():
    responses = np.random.default_rng(5).normal(size=(3, 15))
    responses[1, 13] = np.nan
    found = diagnosed(MATRIX_OF_DIAGNOSTICS, responses)
    for row, response in enumerate(responses):
        has = np.isfinite(response)
        other = sm.OLS(response[has], MATRIX_OF_DIAGNOSTICS[has]).fit().get_influence()
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
    found = diagnosed(MATRIX_OF_DIAGNOSTICS, np.random.default_rng(9).normal(size=(2, 15)))
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
    fit = fit_least_squares(MATRIX_OF_DIAGNOSTICS, responses)
    opposite = (RUNS == [-1, 0, -1]).all(axis=1)
    assert fit.leverage[0, opposite] == pytest.approx(1.0)
    assert np.isnan(
        diagnosed(MATRIX_OF_DIAGNOSTICS, responses).studentized_residual[0, opposite]
    ).all()
    assert np.isnan(fit.prediction_sum_of_squares[0])


def test_residuals_of_rounding_are_not_looked_at():
    found = diagnosed(MATRIX_OF_DIAGNOSTICS, [MATRIX_OF_DIAGNOSTICS @ np.ones(10)])
    assert np.isnan(found.cooks_distance).all()
    assert np.isnan(found.probability_plot_correlation).all()


def test_one_degree_of_freedom_leaves_no_deleted_residual():
    found = diagnosed(np.ones((2, 1)), [[1.0, 3.0]])
    assert np.isnan(found.deleted_residual).all()
    assert np.isfinite(found.studentized_residual).all()


# Treb: B1 .. B10 of the published data by least squares
TREB = np.array([90, -9.375, -1.375, -3.375, 19.75, 19.75, -11.5, -6.25, 4.75, 6.75])
BOX = {"low": [0.0, 0.0, 0.0], "high": [1.0, 1.0, 1.0]}


def analysed(coefficient, sigma=0.0, factor=None):
    values = np.atleast_2d(coefficient)
    return canonical_analysis(
        values,
        EXPONENTS,
        covariance_factor=np.eye(10)[None] if factor is None else factor,
        pattern=np.zeros(len(values), dtype=int),
        sigma=np.full(len(values), sigma),
        **BOX,
    )


def test_the_surface_is_level_at_its_stationary_point_and_turns_by_its_eigenvalues():
    found = analysed(TREB)
    point, value = found.stationary_point[0], found.stationary_value[0]
    for eigenvalue, vector in zip(found.eigenvalue[0], found.eigenvector[0].T, strict=True):
        for step in (0.5, -0.5):
            height = model_matrix(point + step * vector, EXPONENTS) @ TREB
            assert height == pytest.approx(value + eigenvalue * step**2, rel=1e-12)


def test_a_bowl_a_dome_and_a_saddle_are_told_apart():
    bowl = np.array([0, 1, 2, 3, 1, 1, 1, 0, 0, 0.0])
    saddle = np.array([0, 1, -2, 3, 1, 1, 1, 0, 0, 0.0])
    found = analysed([bowl, -bowl, saddle])
    assert [STATIONARY_KINDS[kind] for kind in found.kind] == ["minimum", "maximum", "saddle"]
    assert (np.diff(found.eigenvalue, axis=1) < 0).all()
    assert found.is_inside.tolist() == [True, True, True]


def test_a_plane_and_a_missing_surface_have_no_stationary_point_and_say_so():
    plane = np.array([1, 0, 0, 0, 1, 1, 1, 0, 0, 0.0])
    trough = np.array([1, 1, 0, 0, 1, 1, 1, 0, 0, 0.0])
    found = analysed([plane, trough, np.full(10, np.nan), TREB])
    texts = [STATIONARY_REASONS[code] for code in found.reason]
    assert texts == ["the surface has a direction without curvature"] * 2 + [
        "there is no surface", "",
    ]  # fmt: skip
    assert np.isnan(found.stationary_point[:3]).all()
    assert found.kind[:3].tolist() == [0, 0, 0]
    np.testing.assert_allclose(found.eigenvalue[1], [1, 0, 0], atol=1e-15)


def test_uncertainties_are_those_of_repeated_experiments():
    """First-order uncertainties against 100,000 draws of the coefficients."""
    rng = np.random.default_rng(0)
    root = 0.02 * rng.normal(size=(10, 10))
    factor = (root @ root.T)[None]
    draws = TREB + rng.normal(size=(100_000, 10)) @ root.T
    spread = analysed(draws)
    found = analysed(TREB, sigma=1.0, factor=factor)
    np.testing.assert_allclose(
        found.stationary_point_standard_uncertainty[0],
        spread.stationary_point.std(axis=0),
        rtol=0.03,
    )
    np.testing.assert_allclose(
        found.eigenvalue_standard_uncertainty[0], spread.eigenvalue.std(axis=0), rtol=0.03
    )


def test_curvature_gives_the_surface_back():
    slope, form = _curvature([TREB], EXPONENTS)
    point = np.array([0.3, -0.6, 0.9])
    height = TREB[0] + point @ slope[0] + point @ form[0] @ point
    assert height == pytest.approx(model_matrix(point, EXPONENTS) @ TREB, rel=1e-14)
