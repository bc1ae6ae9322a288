"""Airy and Stokes waves against the potential and the conditions that define them."""

import sys

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import ellipe, ellipj, ellipk

from reduction.prediction.wave_theory import (
    _wave_number,
    airy_wave,
    cnoidal_wave,
    high_stokes_wave,
    particle_motion,
    stokes_wave,
    wave_period_of,
)
from reduction.record.errors import DataError, FitError, SettingsError
from reduction.record.measurement import STANDARD_GRAVITY

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


LONG = {"wave_height": 0.4, "water_depth": 1.5}


def surface(wave, phase):
    orders = np.arange(1, wave.elevation.size + 1)
    return np.cos(np.outer(phase, orders)) @ wave.elevation


@pytest.mark.parametrize("period", [3.0, 6.0, 12.0])
def test_a_cnoidal_surface_is_that_of_jacobi(period):
    wave = cnoidal_wave(**LONG, wave_period=period, elevation=0.0)
    length = 2 * np.pi / wave.wave_number
    ursell = 0.4 * length**2 / 1.5**3
    m = brentq(lambda m: m * ellipk(m) ** 2 - 3 * ursell / 16, 1e-9, 1 - 1e-15, xtol=1e-16)
    phase = np.linspace(0, np.pi, 40)
    cn = ellipj(phase * ellipk(m) / np.pi, m)[1]
    mean = (ellipe(m) / ellipk(m) - (1 - m)) / m
    assert surface(wave, phase) == pytest.approx(0.4 * (cn**2 - mean), abs=1e-7)


@pytest.mark.parametrize("period", [3.0, 6.0, 20.0])
def test_a_cnoidal_wave_solves_the_equation_of_boussinesq(period):
    """(c^2 - g d) eta = 3 g eta^2 / 2 + g d^3 eta'' / 3 + a constant, in the frame of the wave."""
    wave = cnoidal_wave(**LONG, wave_period=period, elevation=0.0)
    g, d, phase = STANDARD_GRAVITY, 1.5, np.linspace(0, np.pi, 40)
    orders = np.arange(1, wave.elevation.size + 1)
    eta = surface(wave, phase)
    curvature = np.cos(np.outer(phase, orders)) @ (
        -((orders * wave.wave_number) ** 2) * wave.elevation
    )
    speed = wave.angular_frequency / wave.wave_number
    left_over = (speed**2 - g * d) * eta - 1.5 * g * eta**2 - g * d**3 / 3 * curvature
    assert left_over == pytest.approx(left_over[0], abs=1e-5 * g * 0.4**2)
    assert wave.horizontal_velocity == pytest.approx(speed / d * wave.elevation, rel=1e-12)


def test_the_solitary_wave_is_the_limit_of_a_long_period():
    wave = cnoidal_wave(**LONG, wave_period=30.0, elevation=0.0)
    speed = wave.angular_frequency / wave.wave_number
    decay = np.sqrt(3 * 0.4 / (4 * 1.5**3))
    # over the level of the trough, where the water lies still
    still = 2 * 0.4 / (decay * 2 * np.pi / wave.wave_number)
    x = np.linspace(0, 15, 40)
    closed = 0.4 / np.cosh(decay * x) ** 2
    assert surface(wave, wave.wave_number * x) + still == pytest.approx(closed, abs=2e-7)
    # in water as deep as that the mean level is above it
    assert speed**2 == pytest.approx(STANDARD_GRAVITY * (1.5 + 0.4 - 3 * still), rel=1e-6)


def test_a_low_cnoidal_wave_is_the_linear_long_wave():
    low = {"wave_height": 1e-6, "wave_period": 12.0, "water_depth": 1.5}
    wave, airy = cnoidal_wave(**low, elevation=-0.5), airy_wave(**low, elevation=-0.5)
    square = (wave.angular_frequency / wave.wave_number) ** 2 / (STANDARD_GRAVITY * 1.5)
    kd = wave.wave_number * 1.5
    # tanh(kd) / kd = 1 - (kd)^2 / 3 + ...
    assert square == pytest.approx(1 - kd**2 / 3, abs=1e-6)
    assert wave.elevation[0] == pytest.approx(0.5e-6, rel=1e-6)
    for name in ("horizontal_velocity", "vertical_velocity", "horizontal_acceleration"):
        assert getattr(wave, name)[0] == pytest.approx(getattr(airy, name)[0], rel=kd**2)


def test_a_cnoidal_wave_keeps_its_water():
    def motion(x, z):
        return particle_motion(
            cnoidal_wave(**LONG, wave_period=6.0, elevation=z), np.linspace(0, 6, 15), x
        )

    stretch = slope(lambda s: motion(2.3 + s, -0.8).horizontal_velocity)
    rise = slope(lambda s: motion(2.3, -0.8 + s).vertical_velocity)
    assert stretch + rise == pytest.approx(0.0, abs=1e-8)
    # the surface of a long wave rises with the water below it; 0 at the bed
    assert motion(2.3, -1.5).vertical_velocity == pytest.approx(0.0, abs=1e-12)


def test_the_coefficients_of_stokes_are_those_that_fenton_prints():
    """Fenton (1985), Table 2, at kd = 0.753982."""
    number, height, depth, gravity = 0.753982 / 3.0, 0.3, 3.0, 9.81
    wave = high_stokes_wave(
        order=5, wave_height=height, wave_period=3.57, water_depth=depth, elevation=0.0,
        wave_number=number, gravity=gravity,
    )  # fmt: skip
    eps = number * height / 2
    b = {22: 2.502414, 31: -5.731666, 42: -32.407508, 44: 14.033758, 53: -103.445042, 55: 37.200027}
    assert number * wave.elevation == pytest.approx(
        [
            eps + eps**3 * b[31] - eps**5 * (b[53] + b[55]), eps**2 * b[22] + eps**4 * b[42],
            -(eps**3) * b[31] + eps**5 * b[53], eps**4 * b[44], eps**5 * b[55],
        ], rel=1e-5,
    )  # fmt: skip
    a11, a22, a31, a33, a42 = 1.208490, 0.799840, -9.105340, 0.368275, -12.196150
    a44, a51, a53, a55 = 0.058723, 108.467921, -6.941756, -0.074979
    potential = [
        eps * a11 + eps**3 * a31 + eps**5 * a51, eps**2 * a22 + eps**4 * a42,
        eps**3 * a33 + eps**5 * a53, eps**4 * a44, eps**5 * a55,
    ]  # fmt: skip
    orders = np.arange(1, 6)
    speed = 0.798448 + eps**2 * 1.940215 - eps**4 * 12.970403  # of the wave, over sqrt(g/k)
    scale = 0.798448 / speed * 2 * np.pi / 3.57 / number
    along = scale * orders * potential * np.cosh(orders * number * depth)
    upwards = scale * orders * potential * np.sinh(orders * number * depth)
    assert wave.horizontal_velocity == pytest.approx(along, rel=2e-5)
    assert wave.vertical_velocity == pytest.approx(upwards, rel=2e-5)


def test_waves_that_a_theory_of_height_does_not_have(monkeypatch):
    sea = {"wave_height": 0.4, "water_depth": 1.5, "elevation": 0.0}
    with pytest.raises(DataError, match="too long for Stokes"):
        high_stokes_wave(order=5, wave_period=10.0, **sea)
    with pytest.raises((DataError, FitError), match=r"too short|no length of this theory"):
        cnoidal_wave(wave_period=1.0, **sea | {"wave_height": 0.1})
    with pytest.raises(DataError, match="crests are so far apart"):
        cnoidal_wave(wave_period=400.0, **sea)
    with pytest.raises(DataError, match="crests are so far apart"):
        cnoidal_wave(wave_period=43.3, **sea | {"wave_height": 0.058}, wave_number=2 * np.pi / 2e4)
    monkeypatch.setitem(sys.modules, "raschii", None)
    with pytest.raises(SettingsError, match=r"mooring-reduction\[waves\]"):
        high_stokes_wave(order=5, wave_period=4.0, **sea)
