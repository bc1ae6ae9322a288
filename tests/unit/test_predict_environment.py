"""Wind, current and wave on a length of hose."""

import numpy as np
import pytest

from reduction.prediction.wave_load import (
    ImmersedSection,
    _anchor_force,
    _current_load,
    _wind_load,
    wave_load,
)
from reduction.prediction.wave_theory import airy_wave
from reduction.record.errors import DataError

HOSE = ImmersedSection(np.array(0.114), np.array(0.0091), np.array(0.0951))
WAVE = airy_wave(wave_height=1.25, wave_period=3.57, water_depth=6.0, elevation=-0.038)
TIME = np.linspace(0.0, 3.57, 50_001)


def sweep(current=0.0):
    return wave_load(WAVE, HOSE, TIME, current_velocity=current).horizontal


def test_wind_and_current_are_drag_on_their_own_part_of_the_hose():
    wind = _wind_load(HOSE, wind_velocity=-12.0, wind_drag_coefficient=1.1, air_density=1.25)
    assert float(wind) == pytest.approx(-0.5 * 1.25 * 1.1 * (0.114 - 0.0951) * 144)
    current = _current_load(HOSE, current_velocity=-0.8, drag_coefficient=0.9, water_density=1000.0)
    assert float(current) == pytest.approx(-0.5 * 1000 * 0.9 * 0.0951 * 0.64)


@pytest.mark.parametrize(
    ("current", "wind"), [(0.5, 10.0), (-0.5, -10.0), (0.4, -30.0), (0.0, 0.0)]
)
def test_force_against_a_sweep(current, wind):
    force = _anchor_force(
        WAVE, HOSE, hose_length=50.0, current_velocity=current, wind_velocity=wind
    )
    air = 0.5 * 1.225 * 1.2 * (0.114 - 0.0951) * wind * abs(wind)
    water = 0.5 * 1025 * 1.2 * 0.0951 * current * abs(current)

    def larger(steady, series):
        ends = steady + np.array([series.max(), series.min()])
        return ends[np.argmax(np.abs(ends).round(6))]

    assert float(force.wind) == pytest.approx(50 * air)
    assert float(force.current) == pytest.approx(50 * water)
    separate, combined = larger(air + water, sweep()), larger(air, sweep(current))
    assert float(force.separate) == pytest.approx(50 * separate, rel=1e-7)
    assert float(force.combined) == pytest.approx(50 * combined, rel=1e-7)
    assert float(force.wave) == pytest.approx(50 * (separate - air - water), rel=1e-7)
    assert float(force.difference) == pytest.approx(1 - separate / combined, abs=1e-6)


def test_the_sum_is_too_low_with_a_following_current_by_the_cross_term():
    force = _anchor_force(WAVE, HOSE, hose_length=1.0, current_velocity=0.5)
    assert float(force.combined) > 1.3 * float(force.separate)
    # with drag alone the cross term is 2 u U
    drag = _anchor_force(
        WAVE, HOSE, hose_length=1.0, current_velocity=0.5, inertia_coefficient=1e-9
    )
    u = float(WAVE.horizontal_velocity[0])
    cross = 0.5 * 1025 * 1.2 * 0.0951 * 2 * u * 0.5
    assert float(drag.combined - drag.separate) == pytest.approx(cross, rel=1e-9)


def test_without_wind_and_current_both_are_the_wave():
    force = _anchor_force(WAVE, HOSE, hose_length=3.0)
    assert float(force.combined) == pytest.approx(float(force.wave), rel=1e-15)
    assert float(force.difference) == 0


def test_many_hoses_at_once():
    many = ImmersedSection(
        np.array([0.114, 0.2]), np.array([0.0091, 0.02]), np.array([0.0951, 0.12])
    )
    force = _anchor_force(WAVE, many, hose_length=10.0, current_velocity=0.2, wind_velocity=5.0)
    assert force.combined.shape == force.difference.shape == force.wind.shape == (2,)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"hose_length": 0.0}, "hose_length"),
        ({"wind_velocity": np.nan}, "wind_velocity"),
        ({"wind_drag_coefficient": np.inf}, "wind_drag_coefficient"),
        ({"air_density": 0.0}, "air_density"),
        ({"current_velocity": np.nan}, "current_velocity"),
    ],
)
def test_numbers_that_are_none_are_refused(change, message):
    with pytest.raises(DataError, match=message):
        _anchor_force(WAVE, HOSE, **{"hose_length": 1.0, **change})
