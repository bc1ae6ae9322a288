"""Airy and Stokes waves against the potential and the conditions that define them."""

import numpy as np
import pytest

from reduction.prediction.wave_theory import (
    STANDARD_GRAVITY,
    _wave_number,
    airy_wave,
    particle_motion,
    stokes_wave,
    wave_period_of,
)
from reduction.record.errors import DataError

SEA = {"wave_height": 1.25, "wave_period": 3.57, "water_depth": 3.0}
MAKERS = [airy_wave, stokes_wave]


def potential(x, z, t, *, height, period, depth, number, order):
    """Of the textbook, typed here again."""
    omega, a = 2 * np.pi / period, height / 2
    phase = number * x - omega * t
    phi = (
        a * omega / number * np.cosh(number * (z + depth)) / np.sinh(number * depth) * np.sin(phase)
    )
    if order == 2:
        size = 3 / 8 * omega * a**2 / np.sinh(number * depth) ** 4
        phi = phi + size * np.cosh(2 * number * (z + depth)) * np.sin(2 * phase)
    return phi


def slope(f, h=1e-3):
    return (f(-2 * h) - 8 * f(-h) + 8 * f(h) - f(2 * h)) / (12 * h)


@pytest.mark.parametrize(("make", "order"), [(airy_wave, 1), (stokes_wave, 2)])
@pytest.mark.parametrize("elevation", [-2.9, -1.0, -0.0381, 0.3])
def test_velocities_are_the_gradient_of_the_potential_and_accelerations_their_rate(
    make, order, elevation
):
    number = float(_wave_number(SEA["wave_period"], SEA["water_depth"]))
    wave = make(**SEA, elevation=elevation)
    given = {
        "height": 1.25, "period": 3.57, "depth": 3.0, "number": number, "order": order,
    }  # fmt: skip
    time, place = np.linspace(0.0, 4.0, 23), 1.7
    motion = particle_motion(wave, time, place)

    def along(t):
        return slope(lambda s: potential(place + s, elevation, t, **given))

    def upwards(t):
        return slope(lambda s: potential(place, elevation + s, t, **given))

    assert motion.horizontal_velocity == pytest.approx(along(time), abs=1e-10)
    assert motion.vertical_velocity == pytest.approx(upwards(time), abs=1e-10)
    assert motion.horizontal_acceleration == pytest.approx(
        slope(lambda s: along(time + s)), abs=1e-7
    )
    assert motion.vertical_acceleration == pytest.approx(
        slope(lambda s: upwards(time + s)), abs=1e-7
    )


@pytest.mark.parametrize("make", MAKERS)
def test_water_is_kept_and_does_not_turn(make):
    x, z, time = 2.3, -0.8, np.linspace(0.0, 3.57, 15)

    def motion(at_x, at_z):
        return particle_motion(make(**SEA, elevation=at_z), time, at_x)

    stretch = slope(lambda s: motion(x + s, z).horizontal_velocity)
    rise = slope(lambda s: motion(x, z + s).vertical_velocity)
    assert stretch + rise == pytest.approx(0.0, abs=1e-9)
    shear = slope(lambda s: motion(x, z + s).horizontal_velocity)
    tilt = slope(lambda s: motion(x + s, z).vertical_velocity)
    assert shear - tilt == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("make", MAKERS)
def test_nothing_goes_through_the_bed(make):
    wave = make(**SEA, elevation=-SEA["water_depth"])
    assert wave.vertical_velocity == pytest.approx(0.0, abs=1e-15)


@pytest.mark.parametrize(("make", "order"), [(airy_wave, 2), (stokes_wave, 3)])
def test_what_the_surface_conditions_leave_falls_with_the_order_after_the_theory(make, order):
    """Kinematic condition, and Bernoulli's with its constant, on the moving surface itself."""
    depth, period = 3.0, 3.0
    number = float(_wave_number(period, depth))
    omega = 2 * np.pi / period
    x = np.linspace(0.0, 2 * np.pi / number, 61)
    left = []
    for height in (0.04, 0.02, 0.01):
        sea = {"wave_height": height, "wave_period": period, "water_depth": depth}
        surface = np.array(
            [particle_motion(make(**sea, elevation=0.0), 0.0, p).elevation[0] for p in x]
        )
        waves = [make(**sea, elevation=float(z)) for z in np.clip(surface, None, surface.max())]
        states = [particle_motion(w, 0.0, p) for w, p in zip(waves, x, strict=True)]
        u = np.array([s.horizontal_velocity[0] for s in states])
        w = np.array([s.vertical_velocity[0] for s in states])
        n = np.arange(1, waves[0].elevation.size + 1)
        steep = -np.sin(np.outer(number * x, n)) @ (n * number * waves[0].elevation)
        # on a wave of permanent form d/dt is -c d/dx, and c u is -d(phi)/dt
        kinematic = w - (u - omega / number) * steep
        head = -omega / number * u + (u**2 + w**2) / 2 + STANDARD_GRAVITY * surface
        left.append((np.max(np.abs(kinematic)), np.ptp(head)))
    falls = np.log2(np.array(left[:-1]) / np.array(left[1:]))
    assert falls == pytest.approx(np.full((2, 2), float(order)), abs=0.1)


def test_over_deep_water_nothing_overflows_and_the_second_harmonic_moves_the_surface_alone():
    wave = stokes_wave(wave_height=0.2, wave_period=2.0, water_depth=1e4, elevation=-0.5)
    k = wave.wave_number
    assert wave.horizontal_velocity[0] == pytest.approx(np.pi * 0.1 * np.exp(-0.5 * k), rel=1e-12)
    assert wave.horizontal_velocity[1] == 0
    assert wave.elevation[1] == pytest.approx(k * 0.2**2 / 8, rel=1e-12)


def test_a_given_length_keeps_the_velocity_of_the_surface():
    # the surface rises with pi H / T whatever the length
    wave = airy_wave(**SEA, elevation=0.0, wave_number=2 * np.pi / 20)
    assert wave.vertical_velocity == pytest.approx([np.pi * 1.25 / 3.57], rel=1e-14)
    assert wave.vertical_acceleration == pytest.approx([-2 * np.pi**2 * 1.25 / 3.57**2], rel=1e-14)
    assert wave.wave_number == 2 * np.pi / 20


def test_over_a_current_the_motion_is_that_in_the_water_that_moves():
    current = 0.8
    over = stokes_wave(**SEA, elevation=-0.2, current_velocity=current)
    intrinsic = over.angular_frequency - over.wave_number * current
    still = stokes_wave(**{**SEA, "wave_period": 2 * np.pi / intrinsic}, elevation=-0.2)
    assert over.wave_number == pytest.approx(still.wave_number, rel=1e-13)
    assert over.angular_frequency == pytest.approx(2 * np.pi / 3.57)
    for name in (
        "elevation", "horizontal_velocity", "vertical_velocity",
        "horizontal_acceleration", "vertical_acceleration",
    ):  # fmt: skip
        assert getattr(over, name) == pytest.approx(getattr(still, name), rel=1e-12)


@pytest.mark.parametrize("make", MAKERS)
def test_motion_is_the_same_a_length_on_and_a_period_later(make):
    wave = make(**SEA, elevation=-0.1)
    time = np.linspace(0.0, 3.0, 11)
    length = 2 * np.pi / wave.wave_number
    here, there = particle_motion(wave, time), particle_motion(wave, time + 3.57, length)
    assert there.horizontal_velocity == pytest.approx(here.horizontal_velocity, abs=1e-12)
    assert there.elevation == pytest.approx(here.elevation, abs=1e-12)


@pytest.mark.parametrize("make", MAKERS)
@pytest.mark.parametrize("elevation", [-3.01, 2.0])
def test_a_place_in_the_bed_or_the_air_is_refused(make, elevation):
    with pytest.raises(DataError, match="the place is not in the water"):
        make(**SEA, elevation=elevation)


@pytest.mark.parametrize("make", MAKERS)
def test_a_wave_beyond_breaking_is_refused(make):
    with pytest.raises(DataError, match=r"breaks before it is this high; found 2\.4 m over 3 m"):
        make(**{**SEA, "wave_height": 2.4}, elevation=0.0)


@pytest.mark.parametrize("make", MAKERS)
def test_a_current_faster_than_a_given_wave_is_refused(make):
    with pytest.raises(DataError, match="the current is faster than the wave"):
        make(**SEA, elevation=0.0, wave_number=2 * np.pi / 20, current_velocity=5.7)


@pytest.mark.parametrize("make", MAKERS)
@pytest.mark.parametrize("name", ["wave_height", "wave_period", "water_depth", "wave_number"])
def test_sizes_are_positive(make, name):
    with pytest.raises(DataError, match=name):
        make(**{**SEA, "wave_number": 0.3, name: -1.0}, elevation=0.0)


def test_a_time_that_is_no_number_is_refused():
    with pytest.raises(DataError, match="time"):
        particle_motion(airy_wave(**SEA, elevation=0.0), [0.0, np.nan])


def test_period_of_the_wave_is_that_of_its_number():
    wave = airy_wave(**SEA, elevation=0.0)
    assert float(wave_period_of(wave.wave_number, 3.0)) == pytest.approx(3.57, rel=1e-13)
