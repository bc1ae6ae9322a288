"""Breaking height and its refusal."""

import numpy as np
import pytest

from reduction.prediction.wave_theory import _refuse_breaking, breaking_height
from reduction.record.errors import DataError


def test_steepness_limits_deep_water_and_depth_shallow_water():
    assert breaking_height(2 * np.pi / 10, 100.0) == pytest.approx(1.42)
    assert breaking_height(2 * np.pi / 400, 2.0) == pytest.approx(1.56)


def test_the_lower_limit_holds():
    depth = np.geomspace(0.1, 100, 50)
    number = 2 * np.pi / 20
    miche = 0.142 * 20 * np.tanh(number * depth)
    assert breaking_height(number, depth) == pytest.approx(np.minimum(miche, 0.78 * depth))


def test_a_wave_at_the_limit_passes_and_one_above_is_refused():
    greatest = float(breaking_height(0.3, 3.0))
    _refuse_breaking(wave_height=greatest, wave_number=0.3, water_depth=3.0)
    with pytest.raises(DataError, match="a wave 20.94 m long breaks before it is this high"):
        _refuse_breaking(wave_height=1.0001 * greatest, wave_number=0.3, water_depth=3.0)


def test_numbers_are_positive():
    with pytest.raises(DataError, match="water_depth"):
        breaking_height(0.3, 0.0)
