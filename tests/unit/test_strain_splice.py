"""Unit tests of reduction.stages.strain.strain_model."""

import numpy as np
import pytest

from reduction.record.errors import DataError
from reduction.stages.strain.strain_model import free_length_fraction, free_length_strain


def test_strain_is_zero_at_the_relaxed_length():
    got = free_length_strain(10.0, free_fraction=0.8, relaxed_free_length=8.0)
    assert got == pytest.approx(0.0, abs=1e-15)


def test_nan_in_nan_out():
    got = free_length_strain([10.0, np.nan], free_fraction=0.8, relaxed_free_length=8.0)
    assert np.isnan(got).tolist() == [False, True]


def test_the_mean_is_of_shares_and_not_of_lengths():
    # (1/2 + 3/4) / 2, not (1 + 3) / (2 + 4)
    assert free_length_fraction([1.0, 3.0], [2.0, 4.0]) == 0.625


def test_free_longer_than_total_is_refused_with_index_and_values():
    with pytest.raises(
        DataError, match=r"1 of 2 .* index 1; found free_length 12, total_length 11"
    ):
        free_length_fraction([8.0, 12.0], [10.0, 11.0])


@pytest.mark.parametrize(("free", "total"), [([], []), ([1.0], [2.0, 3.0]), (1.0, 2.0)])
def test_marks_that_do_not_pair_up_are_refused(free, total):
    with pytest.raises(DataError, match="splice marks do not pair up"):
        free_length_fraction(free, total)


@pytest.mark.parametrize("share", [0.0, 1.0, -0.2, np.nan])
def test_a_share_that_is_none_is_refused(share):
    with pytest.raises(DataError, match="free_fraction is out of range"):
        free_length_strain(10.0, free_fraction=share, relaxed_free_length=8.0)


def test_a_relaxed_length_of_zero_is_refused():
    with pytest.raises(DataError, match="relaxed_free_length is not positive"):
        free_length_strain(10.0, free_fraction=0.8, relaxed_free_length=0.0)
