"""CG-D-39-80: the F statistics of Table 3, typed from the page, and its design.

Numbers in the report carry three decimals of r2 and up to five digits of F.
"""

import numpy as np
import pytest
from scipy import stats

from reduction.experiments.designs import (
    box_behnken,
    coded_from_engineering,
    model_matrix,
    quadratic_exponents,
    term_names,
)
from reduction.experiments.least_squares_fit import statistics_from_r2
from reduction.experiments.run_sheet import covariance_factor, variance_factor

# Table 3, K_ap of seven new lines: r2, F-STAT as printed
TABLE_3 = (
    ("0.985", "26.98"),
    ("0.977", "17.248"),
    ("0.998", "161.33"),
    ("0.999", "582.04"),
    ("0.995", "80.2"),
    ("0.993", "55.41"),
    ("0.983", "23.248"),
)
CRITICAL_AS_PRINTED = 3.48


@pytest.mark.parametrize(("r2", "printed"), TABLE_3)
def test_table_3_counts_the_mean_twice(r2, printed):
    half = 0.0005
    low, high = statistics_from_r2(
        np.array([float(r2) - half, float(r2) + half]), n_runs=15, n_terms=10
    ).printed_f
    digit = 0.5 * 10 ** -len(printed.partition(".")[2])
    assert low - digit <= float(printed) <= high + digit


def test_the_critical_value_is_that_of_degrees_of_freedom_transposed():
    found = statistics_from_r2(0.9, n_runs=15, n_terms=10)
    assert found.printed_critical == pytest.approx(CRITICAL_AS_PRINTED, abs=0.005)
    assert stats.f.isf(0.05, 10, 4) == pytest.approx(5.964, abs=5e-4)


def test_the_two_errors_nearly_cancel():
    """4.772 on the scale of the printed statistic is 3.436; r2 has to exceed 0.8957."""
    found = statistics_from_r2(0.8957, n_runs=15, n_terms=10)
    assert found.critical * 18 / 25 == pytest.approx(3.436, abs=5e-4)
    assert found.f == pytest.approx(found.critical, rel=1e-3)


def test_variance_factors_of_the_fifteen_runs():
    exponents = quadratic_exponents(3)
    matrix = model_matrix(box_behnken(3).coded, exponents)
    factor = covariance_factor(matrix, names=term_names(exponents, ["f", "Tm", "dT"]))
    expected = [0.3333, *[0.2708] * 3, *[0.125] * 3, *[0.25] * 3]
    np.testing.assert_allclose(np.diag(factor), expected, atol=5e-5)
    assert np.linalg.cond(matrix) == pytest.approx(4.24, abs=0.005)
    assert variance_factor(matrix, factor).max() == pytest.approx(0.75)
    corner = variance_factor(model_matrix([[1.0, 1.0, -1.0]], exponents), factor)[0]
    assert corner == pytest.approx(1.396, abs=5e-4)


def test_levels_of_table_2_are_coded_as_appendix_c_says():
    """Nylon double braid, 1/2 in: 768, 1344, 1920 lb mean load; 320, 544, 768 lb amplitude."""
    coded = coded_from_engineering(
        [[768.0, 768.0], [1344.0, 544.0], [1920.0, 320.0]], low=[768.0, 320.0], high=[1920.0, 768.0]
    )
    np.testing.assert_allclose(coded, [[-1, 1], [0, 0], [1, -1]], atol=1e-15)
