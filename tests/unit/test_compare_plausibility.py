import numpy as np
import pytest
from measured_hoses import Truth

from reduction.prediction.comparison_error import plausibility_of_working_strain
from reduction.record.errors import DataError


def test_the_two_reported_hoses_are_bands_and_no_targets():
    inside = plausibility_of_working_strain(np.radians(64), 0.95)
    assert "is inside the band of the hose reported at 64 deg: 70 to 113 %" in inside
    assert "about 79 % at its 115,000th cycle (dynamic, where this is static)" in inside
    assert "above the band" in plausibility_of_working_strain(np.radians(64), 1.2)
    assert "below the band" in plausibility_of_working_strain(np.radians(68), 1.0)
    high = plausibility_of_working_strain(np.radians(68), 1.46, loading="dynamic")
    assert "is inside" in high and "where this is dynamic" in high


def test_another_angle_has_no_band_and_one_nearby_a_moved_one():
    assert plausibility_of_working_strain(np.radians(60), 0.9) == ""
    # half a degree up, 4.3 points of stretch more
    note = plausibility_of_working_strain(np.radians(64.5), 0.79)
    assert "(moved by +0.5 deg)" in note and "75 to 118 %" in note


def test_static_stretch_in_the_band_is_that_of_equation_eight():
    # cord strain 9.5 %, bisection on lambda_c
    for angle, points in ((64, 104.6), (68, 146.1)):
        hose, low, high = Truth(wrap_angle=np.radians(angle)), 1.5, 3.0
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (middle, high) if hose.cord_stretch(middle) < 1.095 else (low, middle)
        assert 100 * (low - 1) == pytest.approx(points, abs=0.05)


def test_plausibility_needs_numbers_above_zero():
    with pytest.raises(DataError, match="working_strain cannot be compared; found 0"):
        plausibility_of_working_strain(1.1, 0.0)
    with pytest.raises(DataError, match="wrap_angle cannot be compared; found nan"):
        plausibility_of_working_strain(np.nan, 1.0)
