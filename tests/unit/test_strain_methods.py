"""Unit tests of reduction.stages.strain.strain_model and tensiondriven: limit cases of each formula, and what it refuses."""

import numpy as np
import pytest

from reduction.record.errors import DataError
from reduction.stages.strain.strain_model import (
    _gauge_length_strain,
    _marked_line_strain,
    _splice_ratio_strain,
    _tension_driven_strain,
    splice_strain,
)

LENGTHS = {"relaxed_free_length": 2.5, "relaxed_splice_length": 1.2}
LAW = {"splice_compliance": 0.0012, "splice_exponent": 0.85}


def test_a_line_through_the_origin_with_unit_slope_takes_the_whole_length_as_free():
    strain = _marked_line_strain(
        [2.0, 3.0], free_length_intercept=0.0, free_length_slope=1.0, relaxed_free_length=2.0
    )
    np.testing.assert_allclose(strain, [0.0, 0.5])


def test_a_splice_ratio_of_one_is_the_strain_of_the_whole_length():
    strain = _splice_ratio_strain([3.7, 7.4], **LENGTHS, splice_strain_ratio=1.0)
    np.testing.assert_allclose(strain, [0.0, 1.0], atol=1e-15)


def test_a_splice_ratio_of_zero_charges_all_travel_to_the_free_length():
    strain = _splice_ratio_strain([3.7, 3.7 + 2.5], **LENGTHS, splice_strain_ratio=0.0)
    np.testing.assert_allclose(strain, [0.0, 1.0], atol=1e-15)


def test_a_ratio_that_leaves_no_length_is_refused():
    with pytest.raises(DataError, match="splice_strain_ratio"):
        _splice_ratio_strain([4.0], **LENGTHS, splice_strain_ratio=-3.0)


def test_splice_strain_is_the_power_law():
    force = np.array([1.0, 50.0, 1800.0])
    np.testing.assert_allclose(splice_strain(force, **LAW), 0.0012 * force**0.85, rtol=1e-13)


def test_slack_and_noise_below_it_give_no_splice_strain():
    strain = splice_strain([0.0, -3.0], **LAW)
    assert np.all(strain >= 0)
    assert np.all(strain < 1e-100)


def test_splice_strain_leaves_its_input_alone():
    force = np.array([10.0, 20.0])
    splice_strain(force, **LAW)
    assert force.tolist() == [10.0, 20.0]


@pytest.mark.parametrize("name", list(LAW))
def test_a_law_without_strength_is_refused(name):
    with pytest.raises(DataError, match=name):
        splice_strain([1.0], **{**LAW, name: 0.0})


def test_tension_driven_strain_inverts_the_geometry_of_rubber_and_splice():
    strain, force = np.array([0.0, 0.8, 1.6, 2.6]), np.array([0.0, 350.0, 800.0, 1700.0])
    position = 2.5 * (1 + strain) + 1.2 * (1 + 0.0012 * force**0.85)
    found = _tension_driven_strain(position, force, **LENGTHS, **LAW)
    np.testing.assert_allclose(found, strain, atol=1e-13)


def test_one_position_at_two_tensions_has_two_strains():
    relaxed, first_pull = _tension_driven_strain([8.0, 8.0], [300.0, 500.0], **LENGTHS, **LAW)
    assert relaxed > first_pull


@pytest.mark.parametrize(("position", "force"), [(np.nan, 100.0), (5.0, np.nan)])
def test_missing_position_or_tension_is_missing_strain(position, force):
    found = _tension_driven_strain([5.0, position], [100.0, force], **LENGTHS, **LAW)
    assert np.isnan(found).tolist() == [False, True]


def test_series_that_do_not_pair_up_are_refused():
    with pytest.raises(DataError, match="series do not pair up"):
        _tension_driven_strain([5.0, 6.0], [100.0], **LENGTHS, **LAW)


@pytest.mark.parametrize("name", list(LENGTHS))
def test_a_relaxed_length_of_zero_is_refused(name):
    lengths = {**LENGTHS, name: 0.0}
    with pytest.raises(DataError, match=name):
        _tension_driven_strain([5.0], [100.0], **lengths, **LAW)
    with pytest.raises(DataError, match=name):
        _splice_ratio_strain([5.0], **lengths, splice_strain_ratio=0.2)


def test_a_line_on_no_length_is_refused():
    with pytest.raises(DataError, match="relaxed_free_length"):
        _marked_line_strain(
            [5.0], free_length_intercept=0.0, free_length_slope=1.0, relaxed_free_length=-1.0
        )


def test_a_displacement_over_a_gauge_length():
    strain = _gauge_length_strain([0.0, 0.025, np.nan], reference_position=0.0, gauge_length=0.05)
    np.testing.assert_allclose(strain, [0.0, 0.5, np.nan])


def test_gauge_length_needs_a_length_and_a_reference():
    with pytest.raises(DataError, match="gauge_length"):
        _gauge_length_strain([1.0], reference_position=0.0, gauge_length=0.0)
    with pytest.raises(DataError, match="reference_position"):
        _gauge_length_strain([1.0], reference_position=np.nan, gauge_length=1.0)
