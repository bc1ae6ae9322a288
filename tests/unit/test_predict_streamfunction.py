"""Steady waves by the stream function, against the equations that they have to meet."""

import numpy as np
import pytest

from reduction.prediction.stream_function import steady_wave
from reduction.prediction.wave_theory import airy_wave, stream_wave
from reduction.record.errors import DataError, FitError

GRAVITY = 9.80665


@pytest.mark.parametrize(
    ("height", "number", "rest"),
    [(0.45, 0.3, 5e-5), (0.3, 1.0, 1e-6), (0.2, 2.5, 1e-5), (0.04, 18.0, 1e-6)],
)
def test_the_surface_is_a_streamline_at_one_pressure_between_the_points_too(height, number, rest):
    """psi and (u^2 + w^2) / 2 + eta at 1,000 points; the solver holds them at its own few."""
    wave = steady_wave(height=height, first_number=number, frequency=None, current=0.0)
    order = np.arange(1, wave.surface.size + 1)
    phase = np.multiply.outer(np.linspace(0, np.pi, 1000), order)
    surface = 1 + np.cos(phase) @ wave.surface
    level, flat = np.multiply.outer(surface, order * number), order * number
    rising, falling = np.exp(level - flat), np.exp(-level - flat)
    scale = 1 + np.exp(-2 * flat)
    sinh, cosh = (rising - falling) / scale, (rising + falling) / scale
    stream = -wave.speed * surface + (sinh * np.cos(phase)) @ (wave.velocity / order) / number
    u = -wave.speed + (cosh * np.cos(phase)) @ wave.velocity
    w = (sinh * np.sin(phase)) @ wave.velocity
    assert np.ptp(stream) < rest
    assert np.ptp((u**2 + w**2) / 2 + surface) < 10 * rest
    assert surface[0] - surface[-1] == pytest.approx(height)


def test_a_low_wave_is_airys_over_a_current_and_over_deep_water():
    for depth, current in ((3.0, 0.6), (3.0, -0.4), (4000.0, 0.0)):
        sea = {"wave_height": 1e-4, "wave_period": 4.0, "water_depth": depth, "elevation": -0.5}
        own = stream_wave(**sea, current_velocity=current)
        airy = airy_wave(**sea, current_velocity=current)
        assert own.wave_number == pytest.approx(airy.wave_number, rel=1e-6)
        for name in ("horizontal_velocity", "vertical_acceleration"):
            assert getattr(own, name)[0] == pytest.approx(getattr(airy, name)[0], rel=1e-4)


def test_a_current_carries_the_whole_wave():
    """Seen from water that drifts with it, a wave of another period is the same wave."""
    still = stream_wave(wave_height=1.0, wave_period=5.0, water_depth=3.0, elevation=0.0)
    speed = still.angular_frequency / still.wave_number
    period = 2 * np.pi / (still.wave_number * (speed + 0.7))
    carried = stream_wave(
        wave_height=1.0, wave_period=period, water_depth=3.0, elevation=0.0, current_velocity=0.7
    )
    assert carried.wave_number == pytest.approx(still.wave_number, rel=1e-9)
    assert carried.horizontal_velocity[:5] == pytest.approx(still.horizontal_velocity[:5], rel=1e-7)
    assert carried.horizontal_acceleration[:5] == pytest.approx(
        still.horizontal_acceleration[:5], rel=1e-7
    )


def test_a_solitary_wave_has_its_speed():
    """Of height .3 d: c^2 = g d (1 + .3 - .3^2 / 20 - 3 / 70 .3^3), Fenton (1972)."""
    wave = stream_wave(wave_height=0.3, wave_period=12.0, water_depth=1.0, elevation=0.0)
    # between the crests the water is lower than on average, and drifts back
    signs = (-1.0) ** np.arange(1, wave.elevation.size + 1)
    rest, drift = 1 + signs @ wave.elevation, signs @ wave.horizontal_velocity
    height = 0.3 / rest
    theory = GRAVITY * rest * (1 + height - height**2 / 20 - 3 * height**3 / 70)
    speed = wave.angular_frequency / wave.wave_number - drift
    assert speed**2 == pytest.approx(theory, rel=1e-3)


def test_waves_that_break_or_are_too_long_are_refused():
    with pytest.raises(DataError, match="breaks before it is this high"):
        stream_wave(wave_height=5.0, wave_period=5.0, water_depth=6.0, elevation=0.0)
    with pytest.raises(FitError, match="do not change with the period"):
        stream_wave(wave_height=2.0, wave_period=400.0, water_depth=6.0, elevation=0.0)


def test_a_search_that_runs_off_ends_without_a_warning_of_the_arithmetic():
    """A wave of .87 of the depth: a step of Newton's method left surfaces without a number."""
    with np.errstate(all="raise"), pytest.raises(DataError, match="breaks before"):
        stream_wave(wave_height=3.5, wave_period=9.0, water_depth=4.0, elevation=0.0)
