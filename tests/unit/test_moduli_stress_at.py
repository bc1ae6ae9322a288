"""Stress at stated elongations."""

import numpy as np
import pytest

from reduction.errors import DataError
from reduction.moduli.stress_at import stress_at_strain

X = 0.05 + 0.1 * np.arange(15)


def test_stress_is_read_between_bins():
    tension = np.stack([300 * X, 200 * X])
    stress = stress_at_strain(X, tension, area=[5e-4, 4e-4], levels=(0.5, 1.0))
    assert stress == pytest.approx(np.array([[3e5, 6e5], [2.5e5, 5e5]]))


def test_level_that_is_not_reached_or_lies_in_a_gap_is_nan():
    tension = 300 * X
    tension[(X > 0.4) & (X < 0.6)] = np.nan
    stress = stress_at_strain(X, tension[None], area=[5e-4], levels=(0.0, 0.5, 1.0, 2.0))
    assert np.isfinite(stress).tolist() == [[False, False, True, False]]


def test_branches_keep_their_axis():
    tension = np.stack([300 * X, 250 * X])[None]
    stress = stress_at_strain(X, tension, area=[5e-4], levels=(1.0,))
    assert stress == pytest.approx(np.array([[[6e5], [5e5]]]))


def test_arrays_that_do_not_pair_up_are_refused():
    with pytest.raises(DataError, match=r"do not pair up; found strain \(15,\), tension \(1, 4\)"):
        stress_at_strain(X, np.ones((1, 4)), area=[1.0], levels=(1.0,))
