"""Extremes of a load between any samples."""

import numpy as np
import pytest

from reduction.prediction.wave_load import (
    ImmersedSection,
    _find_extremes,
    _load_range,
    immerse_hose,
    wave_load,
)
from reduction.prediction.wave_theory import airy_wave, cosine_series, sine_series, stokes_wave
from reduction.record.errors import DataError

HOSE = ImmersedSection(np.array(0.114), np.array(0.0091), np.array(0.0951))
SEA = {"wave_height": 1.25, "wave_period": 3.57, "elevation": -0.038}
NAMES = ("horizontal", "vertical", "horizontal_classic", "vertical_classic")
U, A = np.array([1.0]), np.array([1.0])


def linear_range(drag, inertia):
    return _load_range(
        cosine_series(U), sine_series(A), drag=drag, inertia=inertia,
        wave_number=1.0, angular_frequency=1.0,
    )  # fmt: skip


def test_closed_form_of_the_linear_wave():
    # a cos|cos| + b sin: a + b^2 / (4 a) where b < 2 a, and b beyond, where drag is nothing
    drag = np.concatenate([[0.0, 0.0, 1.0], np.geomspace(1e-18, 1e18, 145)])
    inertia = np.concatenate([[0.0, 1.7, 0.0], np.ones(145)])
    expected = inertia.copy()
    led = inertia < 2 * drag
    expected[led] = drag[led] + inertia[led] ** 2 / (4 * drag[led])
    found = linear_range(drag, inertia)
    assert found.maximum == pytest.approx(expected, rel=1e-14)
    assert found.minimum == pytest.approx(-expected, rel=1e-14)
    assert found.greatest == pytest.approx(expected, rel=1e-14)


def test_times_of_the_closed_form():
    # the phase falls with time: sin(phase) = b / 2a comes before the crest
    found = linear_range(1.0, 0.5)
    assert float(found.time_of_maximum) == pytest.approx(2 * np.pi - np.arcsin(0.25), abs=1e-13)
    assert float(found.time_of_minimum) == pytest.approx(np.pi - np.arcsin(0.25), abs=1e-13)


@pytest.mark.parametrize("current", [0.0, 0.3, -0.7, -3.0])
@pytest.mark.parametrize("make", [airy_wave, stokes_wave])
@pytest.mark.parametrize("depth", [3.0, 6.0, 500.0])
def test_no_sample_goes_beyond_and_the_time_is_right(make, depth, current):
    wave = make(**SEA, water_depth=depth)
    setting = {"current_velocity": current, "position": 1.3}
    extremes = _find_extremes(wave, HOSE, **setting)
    sweep = wave_load(wave, HOSE, np.linspace(0.0, 3.57, 20_001), **setting)
    for name in NAMES:
        found, series = getattr(extremes, name), getattr(sweep, name)
        scale = float(found.greatest)
        assert series.max() <= float(found.maximum) + 1e-12 * scale
        assert series.min() >= float(found.minimum) - 1e-12 * scale
        assert series.max() == pytest.approx(float(found.maximum), abs=1e-6 * scale)
        assert series.min() == pytest.approx(float(found.minimum), abs=1e-6 * scale)
        for time, value in (
            (found.time_of_maximum, found.maximum), (found.time_of_minimum, found.minimum),
        ):  # fmt: skip
            assert 0 <= float(time) <= 3.57
            there = getattr(wave_load(wave, HOSE, float(time), **setting), name)
            assert there == pytest.approx([float(value)], rel=1e-12)


def test_the_load_is_flat_where_it_is_extreme():
    wave = stokes_wave(**SEA, water_depth=3.0)
    extremes = _find_extremes(wave, HOSE)
    step = 1e-5
    for name in NAMES:
        found = getattr(extremes, name)
        time = float(found.time_of_maximum)
        beside = getattr(wave_load(wave, HOSE, time + step * np.array([-1.0, 0.0, 1.0])), name)
        slope = (beside[2] - beside[0]) / (2 * step)
        curvature = (beside[2] - 2 * beside[1] + beside[0]) / step**2
        # by one Newton step the time would not move
        assert abs(slope / curvature) < 1e-8


def test_many_hoses_at_once():
    hoses = immerse_hose(
        outer_diameter=[[0.1], [0.6]], wall_thickness=0.006, wall_density=1250.0,
        content_density=[0.0, 400.0, 800.0], water_density=1025.0,
    )  # fmt: skip
    wave = stokes_wave(**SEA, water_depth=4.0)
    many = _find_extremes(wave, hoses, current_velocity=0.2)
    assert many.vertical.maximum.shape == (2, 3)
    for place in np.ndindex(2, 3):
        one = ImmersedSection(
            hoses.outer_diameter[place],
            hoses.submerged_section_area[place],
            hoses.immersion_depth[place],
        )
        alone = _find_extremes(wave, one, current_velocity=0.2)
        for name in NAMES:
            assert getattr(many, name).maximum[place] == pytest.approx(
                float(getattr(alone, name).maximum), rel=1e-12
            )


def test_numbers_that_are_none_are_refused():
    wave = airy_wave(**SEA, water_depth=3.0)
    with pytest.raises(DataError, match="current_velocity"):
        _find_extremes(wave, HOSE, current_velocity=np.nan)
    with pytest.raises(DataError, match="position"):
        _find_extremes(wave, HOSE, position=np.inf)
    with pytest.raises(DataError, match="drag"):
        linear_range(np.nan, 1.0)
