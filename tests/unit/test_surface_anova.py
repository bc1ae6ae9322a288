import numpy as np
import pandas as pd
import pytest
import statsmodels.api as sm
from scipy import stats
from statsmodels.formula.api import ols
from statsmodels.stats.anova import anova_lm

from reduction.experiments.designs import box_behnken, model_matrix, quadratic_exponents
from reduction.experiments.fit_results import LACK_OF_FIT_REASONS
from reduction.experiments.least_squares_fit import (
    fit_least_squares,
    lack_of_fit,
    replicate_cells,
)
from reduction.experiments.surface_statistics import anova_table, regress_each
from reduction.record.errors import SettingsError

EXPONENTS = quadratic_exponents(3)
RUNS = box_behnken(3).coded
MATRIX = model_matrix(RUNS, EXPONENTS)
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
