"""Secant and chord modulus."""

import numpy as np
import pytest

from reduction.record.errors import DataError
from reduction.stages.moduli.secant_modulus import _secant_modulus, chord_modulus


def test_secant_of_a_straight_line_is_its_slope():
    strain = np.array([0.5, 1.0, 2.0])
    assert _secant_modulus(strain, 300 * strain, area=5e-4) == pytest.approx(6e5)


def test_secant_at_zero_or_negative_strain_is_nan():
    assert np.isnan(_secant_modulus([0.0, -0.1, np.nan], [1.0, 1.0, 1.0], area=1.0)).all()


def test_chord_does_not_ask_which_point_comes_first():
    one = chord_modulus(1.0, 2.0, 100.0, 300.0, area=1e-3)
    assert one == chord_modulus(2.0, 1.0, 300.0, 100.0, area=1e-3) == pytest.approx(2e5)


def test_chord_of_one_strain_is_refused():
    with pytest.raises(DataError, match="chord needs two strains; found 1 of 2 pairs"):
        chord_modulus([1.0, 1.0], [2.0, 1.0], [0.0, 0.0], [1.0, 1.0], area=1.0)


@pytest.mark.parametrize("area", [0.0, -1.0])
def test_area_that_is_not_positive_is_refused(area):
    with pytest.raises(DataError, match="area are not positive"):
        _secant_modulus(1.0, 1.0, area=area)
    with pytest.raises(DataError, match="area are not positive"):
        chord_modulus(0.0, 1.0, 0.0, 1.0, area=area)
