"""Ribbons, cords and dead ends."""

import re

import numpy as np
import pytest

from reduction.errors import DataError
from reduction.predict.cordrates import stretch_ratio_per_angle
from reduction.predict.fabric import (
    angle_per_relative_width,
    dead_length_share_of,
    number_of_cords,
    ribbon_angle,
    ribbon_width,
)

ANGLE = np.radians([20.0, 50.0, 64.0, 68.0, 85.0])


def test_the_width_is_the_pitch_seen_across_the_cords():
    diameter = 0.0889
    pitch = np.pi * diameter / np.tan(ANGLE)
    assert ribbon_width(diameter, ANGLE) == pytest.approx(pitch * np.sin(ANGLE), rel=1e-14)


def test_the_angle_of_a_ribbon_is_the_one_it_was_cut_for():
    assert ribbon_angle(0.09, ribbon_width(0.09, ANGLE)) == pytest.approx(ANGLE, rel=1e-13)


def test_a_ribbon_wider_than_the_circumference_has_no_angle():
    assert np.isnan(ribbon_angle(0.1, [0.32, 0.31])).tolist() == [True, False]


def test_both_layers_are_counted_and_each_adds_what_its_own_ribbon_holds():
    # 2 w n of the mean diameter is w1 n + w2 n
    each = sum(ribbon_width(one, ANGLE) * 1339.0 for one in (0.086, 0.0918))
    assert number_of_cords(0.0889, ANGLE, 1339.0) == pytest.approx(each, rel=1e-14)


def test_the_slope_of_the_angle_is_that_of_a_ribbon_on_a_larger_diameter():
    width, step = ribbon_width(0.1, ANGLE), 1e-6
    turned = ribbon_angle(0.1 * (1 + step), width) - ribbon_angle(0.1 * (1 - step), width)
    assert turned / (2 * step) == pytest.approx(angle_per_relative_width(ANGLE), rel=1e-7)


def test_one_per_cent_of_diameter_with_its_ribbon_is_points_of_stretch():
    # cot a, in degrees, times the slope of the stretch over the angle at 9.5 % of cord strain
    angle = np.radians([64.0, 68.0])
    points = 0.01 * angle_per_relative_width(angle) * 100 * stretch_ratio_per_angle(1.095, angle)
    by_hand = 0.01 * np.degrees(1 / np.tan(angle)) * np.array([8.6, 12.5])
    assert points == pytest.approx(by_hand, rel=0.01)
    assert points == pytest.approx([2.4, 2.9], abs=0.05)


def test_one_ribbon_on_two_diameters_makes_two_angles_that_pick_up_apart():
    angles = np.degrees(ribbon_angle([3.4, 3.6], ribbon_width(3.4, np.radians(64))))
    # arccos(3.4/3.6 cos 64)
    assert angles == pytest.approx([64.0, 65.54], abs=0.005)


def test_dead_ends_add_up_and_take_many_hoses_at_once():
    assert dead_length_share_of([2.0, 4.0], [[0.1, 0.1], [0.3, 0.1]]) == pytest.approx([0.2, 0.05])
    assert dead_length_share_of(2.0, [0.0, 0.5]) == pytest.approx(0.25)


def test_a_ribbon_as_wide_as_the_circumference_lies_along_the_hose():
    assert ribbon_width(0.1, 0.0) == pytest.approx(np.pi * 0.1)
    assert ribbon_angle(1.0, np.pi) == 0


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: ribbon_width(0.1, np.radians(90)), "wrap_angle is no angle of a ribbon; found 90"),
        (lambda: ribbon_width(0.1, -0.1), "needed from 0 to below 90 deg"),
        (lambda: ribbon_width(0.0, 1.0), "1 of 1 values of wrap_diameter are not positive"),
        (lambda: ribbon_angle(0.1, -0.1), "values of width are not positive"),
        (lambda: angle_per_relative_width(np.nan), "values of wrap_angle are not finite"),
        (lambda: number_of_cords(0.1, 1.0, 0.0), "values of cords_per_length are not positive"),
        (lambda: dead_length_share_of(0.0, [0.1]), "values of length are not positive"),
        (lambda: dead_length_share_of(1.0, [0.6, 0.4]), "do not leave a free length; found ends of 1"),
        (lambda: dead_length_share_of(1.0, [-0.1, 0.4]), "ends of zero or more"),
        (lambda: dead_length_share_of(1.0, 0.1), "dead_lengths has no axis of ends"),
    ],
)  # fmt: skip
def test_what_is_no_fabric_is_refused(call, message):
    with pytest.raises(DataError, match=re.escape(message)):
        call()
