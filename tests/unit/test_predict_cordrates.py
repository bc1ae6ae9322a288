import numpy as np
import pytest

from reduction.prediction.hose_geometry import hose_stretch_ratio
from reduction.prediction.hose_sensitivity import (
    _stretch_ratio_per_angle,
    _stretch_ratio_per_cord_stretch,
)
from reduction.record.errors import SettingsError


def test_sensitivities_are_the_differences_of_the_inverse():
    angle, cord, step = np.radians(np.array([40.0, 64.0, 68.0])), 1.095, 1e-6
    for found, plus, minus in (
        (_stretch_ratio_per_angle(cord, angle), (cord, angle + step), (cord, angle - step)),
        (_stretch_ratio_per_cord_stretch(cord, angle), (cord + step, angle), (cord - step, angle)),
    ):
        difference = (hose_stretch_ratio(*plus) - hose_stretch_ratio(*minus)) / (2 * step)
        np.testing.assert_allclose(found, difference, rtol=1e-8)


@pytest.mark.parametrize("function", [_stretch_ratio_per_angle, _stretch_ratio_per_cord_stretch])
def test_an_angle_that_is_none_of_a_helix_is_refused(function):
    with pytest.raises(SettingsError, match="wrap_angle is not an angle of a helix; found 90 deg"):
        function(1.1, np.radians(90.0))
