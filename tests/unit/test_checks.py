"""Checks name the count, the first index and the value."""

import numpy as np
import pytest

from reduction.record.arrays import as_finite, as_increasing, as_positive, as_same_shape, as_spread
from reduction.record.errors import DataError, SettingsError


def test_finite_refuses_with_count_and_first_index():
    with pytest.raises(DataError, match="2 of 4 values of strain are not finite, first at index 1"):
        as_finite("strain", [1.0, np.nan, np.inf, 2.0])
    assert as_finite("strain", 3).dtype == np.float64


def test_positive_refuses_zero():
    with pytest.raises(DataError, match="1 of 2 values of area are not positive.*found 0"):
        as_positive("area", [1.0, 0.0])


def test_increasing_refuses_a_plateau_and_a_matrix():
    with pytest.raises(DataError, match="first at index 2; found 2"):
        as_increasing("time", [1.0, 2.0, 2.0])
    with pytest.raises(DataError, match="time is not a series"):
        as_increasing("time", np.ones((2, 2)))


def test_shapes_must_pair_up():
    with pytest.raises(DataError, match=r"found a \(2,\), b \(3,\)"):
        as_same_shape(a=[1, 2], b=[1, 2, 3])


@pytest.mark.parametrize("value", [-0.1, np.nan, np.inf])
def test_a_standard_uncertainty_is_zero_or_more(value):
    with pytest.raises(SettingsError, match="standard uncertainty of bore cannot be used; found"):
        as_spread("bore", value)
    assert as_spread("bore", 0.0) == 0.0
