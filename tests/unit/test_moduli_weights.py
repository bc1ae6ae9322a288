"""Unit tests of reduction.stages.moduli.stepwise_test."""

import numpy as np
import pytest

from reduction.record.errors import DataError
from reduction.stages.moduli.stepwise_test import (
    _find_inconsistent_readings,
    _interval_slopes,
    _recover_gauge_length,
    _step_branches,
)

STRAIN = np.array([0.2, 0.5, 0.9, 1.3, 1.7])


def test_gauge_length_of_exact_readings_is_exact():
    gauge, uncertainty = _recover_gauge_length(0.15 * (1 + STRAIN), STRAIN)
    assert gauge == pytest.approx(0.15)
    assert uncertainty == pytest.approx(0.0, abs=1e-12)


def test_one_misread_row_moves_neither_gauge_length_nor_its_uncertainty():
    length = 0.15 * (1 + STRAIN)
    length[2] *= 1.2
    gauge, uncertainty = _recover_gauge_length(length, STRAIN)
    assert gauge == pytest.approx(0.15)
    assert uncertainty == pytest.approx(0.0, abs=1e-12)


def test_rows_without_a_recorded_elongation_are_left_out():
    printed = np.where(STRAIN > 1, np.nan, STRAIN)
    assert _recover_gauge_length(0.15 * (1 + STRAIN), printed)[0] == pytest.approx(0.15)


def test_the_uncertainty_of_a_gauge_length_is_that_of_the_median():
    rng = np.random.default_rng(6)
    strain = np.linspace(0.1, 2.0, 40)
    found = np.array(
        [
            _recover_gauge_length((0.15 + rng.normal(0, 0.001, 40)) * (1 + strain), strain)
            for _ in range(400)
        ]
    )
    assert np.median(found[:, 1]) == pytest.approx(found[:, 0].std(), rel=0.15)


def test_no_recorded_elongation_is_refused():
    with pytest.raises(DataError, match="no reading has a recorded elongation"):
        _recover_gauge_length([0.2], [np.nan])


def test_an_impossible_reading_is_refused():
    with pytest.raises(DataError, match="values of length are not positive"):
        _recover_gauge_length([-0.2], [0.1])
    with pytest.raises(DataError, match=r"1 \+ printed_strain"):
        _recover_gauge_length([0.2], [-1.0])


def test_rows_within_the_last_digit_agree_however_exact_the_others():
    length = 0.15 * (1 + STRAIN)
    length[3] += 0.15 * 0.009
    assert not _find_inconsistent_readings(length, STRAIN, gauge_length=0.15).any()
    length[3] += 0.15 * 0.002
    bad = _find_inconsistent_readings(length, STRAIN, gauge_length=0.15)
    assert bad.tolist() == [False, False, False, True, False]


def test_rows_that_scatter_set_their_own_limit():
    miss = np.array([0.02, -0.02, 0.02, -0.02, 0.09])
    assert not _find_inconsistent_readings(1 + STRAIN + miss, STRAIN, gauge_length=1.0).any()


def test_what_was_not_recorded_cannot_disagree():
    assert not _find_inconsistent_readings([0.2, 0.3], [np.nan, np.nan], gauge_length=0.15).any()


def test_disagreement_needs_a_gauge_length():
    with pytest.raises(DataError, match="gauge_length are not positive"):
        _find_inconsistent_readings([0.2], [0.1], gauge_length=0.0)


@pytest.mark.parametrize(
    ("weights", "branch"),
    [
        ([1, 2, 3, 2, 1], [1, 1, 1, 2, 2]),
        ([3, 2, 1], [2, 2, 2]),
        ([1, 1, 2, 2, 1, 1], [1, 1, 1, 1, 2, 2]),
        ([2, 2, 1], [2, 2, 2]),
        ([1, 2, 1, 2], [1, 1, 2, 1]),
    ],
)
def test_branches_follow_the_weights(weights, branch):
    assert _step_branches(weights).tolist() == branch


@pytest.mark.parametrize("weights", [[5.0, 5.0], [5.0]])
def test_weights_that_never_change_have_no_branch(weights):
    with pytest.raises(DataError, match="never change"):
        _step_branches(weights)


def test_slope_and_uncertainty_of_an_interval():
    middle, modulus, uncertainty = _interval_slopes(
        [100.0, 160.0], [0.5, 0.8], area=2.0, tension_uncertainty=3.0, strain_uncertainty=0.003
    )
    assert middle.tolist() == pytest.approx([0.65])
    assert modulus.tolist() == pytest.approx([100.0])
    # sqrt 2 times 5 % of tension and 1 % of strain, added in quadrature
    assert uncertainty.tolist() == pytest.approx([100.0 * np.sqrt(2 * (0.05**2 + 0.01**2))])


def test_no_change_of_strain_has_no_slope():
    _, modulus, uncertainty = _interval_slopes([1.0, 2.0, 3.0], [0.1, 0.1, 0.2], area=1.0)
    assert np.isnan(modulus).tolist() == [True, False]
    assert np.isnan(uncertainty).tolist() == [True, False]


def test_slopes_need_an_area_and_equal_series():
    with pytest.raises(DataError, match="area are not positive"):
        _interval_slopes([1.0, 2.0], [0.1, 0.2], area=0.0)
    with pytest.raises(DataError, match="series do not pair up"):
        _interval_slopes([1.0, 2.0], [0.1], area=1.0)
