import numpy as np
import pytest
from scipy import stats

from reduction.experiments.designs import box_behnken, model_matrix, quadratic_exponents
from reduction.experiments.least_squares_fit import fit_least_squares, statistics_from_r2
from reduction.record.errors import SettingsError

MATRIX = model_matrix(box_behnken(3).coded, quadratic_exponents(3))


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
    fit = fit_least_squares(MATRIX, responses)
    r2 = 1 - fit.residual_sum_of_squares / fit.total_sum_of_squares
    assert r2.mean() == pytest.approx(9 / 14, abs=0.003)
    rejected = statistics_from_r2(r2, n_runs=15, n_terms=10).p_value < 0.05
    assert rejected.mean() == pytest.approx(0.05, abs=0.005)


def test_the_mean_alone_has_no_statistics():
    with pytest.raises(SettingsError, match="the mean alone has no F"):
        statistics_from_r2(0.9, n_runs=15, n_terms=1)
