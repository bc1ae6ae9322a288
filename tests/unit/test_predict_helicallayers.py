"""Layers that are to carry no load: their strain on the way, and the angles that spare them."""

import re

import numpy as np
import pytest

from reduction.prediction.hose_geometry import (
    NEUTRAL_ANGLE,
    greatest_layer_angle,
    layer_range,
    least_layer_angle,
)
from reduction.record.errors import DataError, SettingsError


def layer_strain(angle, strain, dead=0.0):
    """By the two sides of a rolled-out turn: length stretched, circumference by the root."""
    free = 1 + strain / (1 - dead)
    return np.hypot(free * np.cos(angle), np.sin(angle) / np.sqrt(free)) - 1


@pytest.mark.parametrize("dead", [0.0, 0.08])
def test_least_and_greatest_are_those_of_a_fine_search(dead):
    angle = np.radians(np.linspace(3, 89, 60))[:, None]
    end = np.array([0.0, 0.02, 0.3, 0.79, 1.46, 2.1])
    found = layer_range(angle, end, dead_length_share=dead)
    walk = np.linspace(0, 1, 20001)
    for place, last in enumerate(end):
        strains = layer_strain(angle, walk * last, dead)
        assert found.least_strain[:, place] == pytest.approx(strains.min(axis=1), abs=2e-8)
        assert found.greatest_strain[:, place] == pytest.approx(strains.max(axis=1), abs=1e-12)


def test_a_layer_goes_into_compression_above_the_neutral_angle_only():
    angle = NEUTRAL_ANGLE + np.array([-0.01, -1e-4, 1e-4, 0.01])
    assert (layer_range(angle, 1.0).least_strain < 0).tolist() == [False, False, True, True]


def test_at_the_least_angle_the_limit_is_just_reached():
    end = np.array([[0.3], [0.79], [1.46], [2.1]])
    limit = np.array([0.0, 0.01, 0.04, 0.2])
    angle = least_layer_angle(end, strain_limit=limit, dead_length_share=0.05)
    found = layer_range(angle, end, dead_length_share=0.05)
    assert found.greatest_strain == pytest.approx(np.broadcast_to(limit, angle.shape), abs=1e-13)
    flatter = layer_range(angle - 1e-3, end, dead_length_share=0.05)
    assert np.all(flatter.greatest_strain > limit)


def test_a_layer_that_bears_the_stretch_of_the_hose_may_lie_along_it():
    assert least_layer_angle([0.0, 0.1], strain_limit=0.1).tolist() == [0.0, 0.0]


def test_without_stretch_the_least_angle_is_that_whose_cords_pick_up_there():
    # pick-up of the two hoses of the report, from tan^2 a = l^2 + l
    assert np.degrees(least_layer_angle([0.6104, 1.0251])) == pytest.approx([64, 68], abs=1e-3)


@pytest.mark.parametrize("end", [0.02, 0.3, 1.46, 2.1])
@pytest.mark.parametrize("limit", [1e-4, 0.01, 0.05, 0.1])
def test_at_the_greatest_angle_the_compression_is_just_reached(end, limit):
    angle = greatest_layer_angle(end, compression_limit=limit, dead_length_share=0.05)
    found = layer_range(min(angle, np.radians(89.99)), end, dead_length_share=0.05)
    if angle < np.pi / 2:
        assert found.least_strain == pytest.approx(-limit, abs=1e-12)
        steeper = layer_range(angle + 1e-4, end, dead_length_share=0.05)
        assert steeper.least_strain < -limit
    else:
        assert found.least_strain > -limit


def test_a_layer_that_bears_no_compression_lies_at_the_neutral_angle():
    assert greatest_layer_angle(1.46, compression_limit=0.0) == pytest.approx(
        NEUTRAL_ANGLE, abs=1e-7
    )
    assert greatest_layer_angle(0.0, compression_limit=0.0) == np.pi / 2


def test_there_is_no_angle_for_a_conductor_that_bears_little_either_way_in_a_hose_that_works_far():
    ends = np.array([0.3, 0.79, 1.46])
    low = least_layer_angle(ends, strain_limit=0.02)
    high = greatest_layer_angle(ends, compression_limit=0.02)
    assert (low <= high).tolist() == [True, False, False]


@pytest.mark.parametrize(
    ("error", "call", "message"),
    [
        (SettingsError, lambda: layer_range(np.pi / 2, 1.0), "wrap_angle is not an angle of a helix; found 90 deg"),
        (DataError, lambda: layer_range(1.0, -0.1), "hose_strain is negative; found -0.1"),
        (DataError, lambda: layer_range(1.0, np.nan), "values of hose_strain are not finite"),
        (DataError, lambda: least_layer_angle(1.0, strain_limit=-0.1), "strain_limit is negative or missing"),
        (DataError, lambda: least_layer_angle(1.0, strain_limit=np.nan), "strain_limit is negative or missing"),
        (DataError, lambda: least_layer_angle(1.0, dead_length_share=1.0), "dead_length_share is not a share"),
        (DataError, lambda: greatest_layer_angle(1.0, compression_limit=1.0), "compression_limit leaves no length; found 1; needed below 1"),
    ],
)  # fmt: skip
def test_what_is_no_layer_is_refused(error, call, message):
    with pytest.raises(error, match=re.escape(message)):
        call()
