"""Drift over the order of the runs, beside the terms of a surface."""

import numpy as np
import pytest
import statsmodels.api as sm

from reduction.experiments.designs import box_behnken, model_matrix, quadratic_exponents
from reduction.experiments.response_surfaces import fit_surfaces
from reduction.experiments.surface_warnings import drift_over_order

RNG = np.random.default_rng(1980)
CODED = box_behnken(3).coded
ORDER = RNG.permutation(15) + 1.0


def fitted(responses, coded=CODED, **options):
    return fit_surfaces(
        coded, responses, units="coded", factor_names=["f", "T", "a"],
        response_names=[f"y{i}" for i in range(len(responses))], low=[0] * 3, high=[1] * 3,
        **options,
    )  # fmt: skip


def test_slope_error_and_p_are_those_of_statsmodels():
    responses = RNG.normal(0, 1, (3, 15)) + 0.1 * ORDER
    found = drift_over_order(fitted(responses), ORDER)
    matrix = np.column_stack([model_matrix(CODED, quadratic_exponents(3)), ORDER])
    for index, values in enumerate(responses):
        other = sm.OLS(values, matrix).fit()
        assert found.slope[index] == pytest.approx(other.params[-1], rel=1e-9)
        assert found.standard_uncertainty[index] == pytest.approx(other.bse[-1], rel=1e-9)
        assert found.p_value[index] == pytest.approx(other.pvalues[-1], rel=1e-9)


def test_blocks_keep_means_of_their_own():
    coded, order = np.tile(CODED, (2, 1)), np.tile(ORDER, 2)
    step = np.repeat([0.0, 40.0], 15)
    responses = RNG.normal(0, 1e-3, (1, 30)) + step + 0.5 * order
    labels = ["a"] * 15 + ["b"] * 15
    names = [str(i) for i in range(30)]
    found = drift_over_order(fitted(responses, coded, blocks=labels, run_names=names), order)
    assert found.slope[0] == pytest.approx(0.5, abs=5e-4)


def test_a_false_alarm_is_as_rare_as_its_level():
    noise = RNG.normal(0, 1, (20_000, 15))
    p_value = drift_over_order(fitted(noise, with_tests=False), ORDER).p_value
    assert np.mean(p_value < 0.05) == pytest.approx(0.05, abs=0.006)


def test_an_order_that_is_a_factor_or_not_known_gives_nothing():
    responses = RNG.normal(0, 1, (1, 15))
    assert np.isnan(drift_over_order(fitted(responses), CODED[:, 0] * 5 + 6).p_value).all()
    assert np.isnan(drift_over_order(fitted(responses), np.full(15, np.nan))).all()


def test_a_run_without_a_place_is_left_out_of_the_drift_alone():
    responses = 0.3 * ORDER[None] + RNG.normal(0, 1e-6, 15)
    order = np.where(np.arange(15) == 4, np.nan, ORDER)
    assert drift_over_order(fitted(responses), order).slope[0] == pytest.approx(0.3, rel=1e-4)
