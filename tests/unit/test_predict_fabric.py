"""Ribbons and cords."""

import re

import numpy as np
import pytest

from reduction.prediction.hose_geometry import number_of_cords, ribbon_width
from reduction.record.errors import DataError

ANGLE = np.radians([20.0, 50.0, 64.0, 68.0, 85.0])


def test_the_width_is_the_pitch_seen_across_the_cords():
    diameter = 0.0889
    pitch = np.pi * diameter / np.tan(ANGLE)
    assert ribbon_width(diameter, ANGLE) == pytest.approx(pitch * np.sin(ANGLE), rel=1e-14)


def test_both_layers_are_counted_and_each_adds_what_its_own_ribbon_holds():
    # 2 w n of the mean diameter is w1 n + w2 n
    each = sum(ribbon_width(one, ANGLE) * 1339.0 for one in (0.086, 0.0918))
    assert number_of_cords(0.0889, ANGLE, 1339.0) == pytest.approx(each, rel=1e-14)


def test_a_ribbon_as_wide_as_the_circumference_lies_along_the_hose():
    assert ribbon_width(0.1, 0.0) == pytest.approx(np.pi * 0.1)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: ribbon_width(0.1, np.radians(90)), "wrap_angle is not an angle of a ribbon; found 90"),
        (lambda: ribbon_width(0.1, -0.1), "needed from 0 to below 90 deg"),
        (lambda: ribbon_width(0.0, 1.0), "1 of 1 values of wrap_diameter are not positive"),
        (lambda: number_of_cords(0.1, 1.0, 0.0), "values of cords_per_length are not positive"),
    ],
)  # fmt: skip
def test_what_is_no_fabric_is_refused(call, message):
    with pytest.raises(DataError, match=re.escape(message)):
        call()
