"""Airy and Stokes waves against the potential and the conditions that define them."""

import sys

import numpy as np
import pytest
from refusals import refusals
from scipy.optimize import brentq
from scipy.special import ellipe, ellipj, ellipk

from reduction.prediction import wave_theory as dispersion
from reduction.prediction.stream_function import steady_wave
from reduction.prediction.wave_theory import (
    GREATEST_URSELL_NUMBER,
    _group_velocity,
    _printed_theory,
    _refuse_breaking,
    _theory_by_depth,
    _wave_number,
    airy_wave,
    breaking_height,
    cnoidal_wave,
    cosine_series,
    describe_wave,
    high_stokes_wave,
    particle_motion,
    phase_derivative,
    regular_wave,
    root_phases,
    series_product,
    sine_series,
    stokes_wave,
    stream_wave,
    sum_at,
    wave_period_of,
)
from reduction.published.zhang_2015 import printed_airy_wave, printed_stokes_wave
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


# description of a wave: theory, limits, doubts

SHALLOW = {"wave_height": 1.25, "wave_period": 3.57, "water_depth": 3.0}


def test_the_second_printed_example_is_at_the_edge():
    wave = describe_wave(**SHALLOW, wave_length=20.0)
    assert wave.ursell_number == pytest.approx(18.5, abs=0.05)
    assert wave.height_to_depth == pytest.approx(0.417, abs=0.0005)
    assert wave.velocity_ratio == pytest.approx(0.26, abs=0.005)
    assert wave.elevation_ratio == pytest.approx(0.30, abs=0.005)
    assert wave.breaking_ratio == pytest.approx(0.0625 / 0.105, abs=0.005)
    assert wave.is_beyond_stokes and not wave.is_breaking
    assert any("Stokes' second order is at its limit" in str(one) for one in wave.reasons)
    # printed as 20 m; by the dispersion relation of its period and depth 16.31 m
    assert any("a wave of 3.57 s is 16.31 m long, not 20 m" in str(one) for one in wave.reasons)


@pytest.mark.parametrize(("depth", "period"), [(3.0, 3.57), (6.0, 3.57), (40.0, 5.0), (1.0, 2.0)])
def test_ratios_of_the_harmonics_are_those_of_the_wave_itself(depth, period):
    sea = {"wave_height": 0.1, "wave_period": period, "water_depth": depth}
    wave, found = stokes_wave(**sea, elevation=0.0), describe_wave(**sea)
    assert found.elevation_ratio == pytest.approx(wave.elevation[1] / wave.elevation[0], rel=1e-11)
    ratio = wave.horizontal_velocity[1] / wave.horizontal_velocity[0]
    assert found.velocity_ratio == pytest.approx(ratio, rel=1e-11)


def test_over_very_deep_water_the_ratios_go_on_smoothly():
    below, above = (
        describe_wave(
            wave_height=0.1, wave_period=2.0, water_depth=depth, wave_length=2 * np.pi
        ) for depth in (19.999, 20.001)
    )  # fmt: skip
    assert above.elevation_ratio == pytest.approx(below.elevation_ratio, rel=1e-12)
    # both are 1e-18 or so, and fall as exp(-2 kd)
    fall = above.velocity_ratio / below.velocity_ratio
    assert fall == pytest.approx(np.exp(-0.004), rel=1e-9)


def test_the_limit_of_ursell_is_the_secondary_crest_over_shallow_water():
    # a2/a1 = 1/4 there
    length, depth = 400.0, 1.0
    height = GREATEST_URSELL_NUMBER * depth**3 / length**2
    wave = describe_wave(
        wave_height=height, wave_period=100.0, water_depth=depth, wave_length=length
    )
    assert wave.elevation_ratio == pytest.approx(0.25, rel=1e-3)


def test_an_airy_wave_whose_second_harmonic_counts_says_so():
    steep = describe_wave(wave_height=1.25, wave_period=3.57, water_depth=6.0)
    assert steep.theory == "airy"
    # kH/8 (2 + 3 / sinh^2 kd) coth kd by hand: 12 %
    assert any("the second harmonic of the surface is 12 %" in str(one) for one in steep.reasons)
    flat = describe_wave(wave_height=0.2, wave_period=3.57, water_depth=6.0)
    assert flat.is_second_order_small and flat.reasons == ()
    assert flat.length_mismatch == 0


@pytest.mark.parametrize("length", [0.0, -20.0])
def test_a_length_that_no_wave_has_is_refused(length):
    with pytest.raises(DataError, match="values of wave_length are not positive"):
        describe_wave(wave_height=1.25, wave_period=3.57, water_depth=6.0, wave_length=length)


def test_a_breaking_wave_is_flagged():
    wave = describe_wave(wave_height=3.0, wave_period=3.57, water_depth=6.0)
    assert wave.is_breaking and wave.breaking_ratio > 1
    assert any(str(one).startswith("the wave breaks: 1.") for one in wave.reasons)


def test_a_wave_beyond_the_table_is_computed_by_name_alone():
    sea = {"wave_height": 0.2, "wave_period": 12.0, "water_depth": 1.5}
    wave = describe_wave(**sea)
    assert wave.theory == "beyond the table" and not wave.is_computed
    assert any("Table 1 names no theory" in str(one) for one in wave.reasons)
    with pytest.raises(DataError, match="the theory of this wave is not computed: beyond"):
        regular_wave(wave, **sea, elevation=0.0)
    assert regular_wave(wave, **sea, elevation=0.0, theory="airy").elevation.size == 1
    assert regular_wave(wave, **sea, elevation=0.0, theory="cnoidal").elevation.size > 5


def test_the_theory_of_the_description_is_the_one_computed():
    deep = {"wave_height": 1.0, "wave_period": 3.0, "water_depth": 6.0}
    assert regular_wave(describe_wave(**deep), **deep, elevation=-0.1).elevation.size == 1
    wave = regular_wave(
        describe_wave(**SHALLOW, wave_length=20.0), **SHALLOW, elevation=-0.1
    )  # fmt: skip
    assert wave.elevation.size == 2
    assert wave.wave_number == pytest.approx(2 * np.pi / 20)


@pytest.mark.parametrize("name", ["wave_height", "wave_period", "water_depth"])
def test_sizes_are_positive_in_wavetheory(name):
    with pytest.raises(DataError, match=name):
        describe_wave(**{**SHALLOW, name: 0.0})


# breaking height and its refusal


def test_steepness_limits_deep_water_and_depth_shallow_water():
    assert breaking_height(2 * np.pi / 10, 100.0) == pytest.approx(1.42)
    assert breaking_height(2 * np.pi / 400, 2.0) == pytest.approx(1.56)


def test_the_lower_limit_holds():
    depth = np.geomspace(0.1, 100, 50)
    number = 2 * np.pi / 20
    miche = 0.142 * 20 * np.tanh(number * depth)
    assert breaking_height(number, depth) == pytest.approx(np.minimum(miche, 0.78 * depth))


def test_a_wave_at_the_limit_passes_and_one_above_is_refused():
    greatest = float(breaking_height(0.3, 3.0))
    _refuse_breaking(wave_height=greatest, wave_number=0.3, water_depth=3.0)
    with pytest.raises(DataError, match="a wave 20.94 m long breaks before it is this high"):
        _refuse_breaking(wave_height=1.0001 * greatest, wave_number=0.3, water_depth=3.0)


# wave number from period and depth, with and without a current


def residual(number, period, depth, current=0.0):
    intrinsic = 2 * np.pi / period - number * current
    return intrinsic**2 / (STANDARD_GRAVITY * number * np.tanh(number * depth)) - 1


def test_the_root_is_exact_from_a_ripple_to_a_tide():
    period = np.geomspace(0.1, 1e5, 400)[:, None]
    depth = np.geomspace(0.01, 1e4, 300)
    number = _wave_number(period, depth)
    assert number.shape == (400, 300)
    assert np.max(np.abs(residual(number, period, depth))) < 1e-14


def test_limits_of_deep_and_shallow_water():
    deep, shallow = _wave_number(5.0, 1e4), _wave_number(1e4, 0.5)
    assert deep == pytest.approx((2 * np.pi / 5) ** 2 / STANDARD_GRAVITY, rel=1e-14)
    assert shallow == pytest.approx(2 * np.pi / 1e4 / np.sqrt(STANDARD_GRAVITY * 0.5), rel=1e-7)


@pytest.mark.parametrize("current", [-1.2, -0.5, 0.3, 2.0, 15.0])
def test_a_current_shifts_the_frequency(current):
    period = np.array([8.0, 12.0, 30.0])
    number = _wave_number(period, 10.0, current_velocity=current)
    assert np.max(np.abs(residual(number, period, 10.0, current))) < 1e-13
    # shorter against the current, longer with it, and energy still goes forward
    assert np.all((number > _wave_number(period, 10.0)) == (current < 0))
    assert np.all(_group_velocity(number, 10.0) + current > 0)


def test_no_current_is_the_limit_of_a_small_one():
    still = _wave_number(6.0, 4.0)
    for small in (1e-12, -1e-12):
        assert _wave_number(6.0, 4.0, current_velocity=small) == pytest.approx(
            float(still), rel=1e-11
        )


def test_over_deep_water_the_waves_end_at_a_quarter_of_their_speed():
    # U = -g / (4 omega): the closed form of blocking; length is then a quarter of the still one
    period = 4.0
    limit = STANDARD_GRAVITY * period / (8 * np.pi)
    number = _wave_number(period, 1e3, current_velocity=-limit * (1 - 1e-9))
    assert number / _wave_number(period, 1e3) == pytest.approx(4.0, rel=1e-3)
    with pytest.raises(DataError, match="the opposing current stops the wave"):
        _wave_number(period, 1e3, current_velocity=-limit * (1 + 1e-9))


def test_period_is_the_inverse():
    period = np.array([2.0, 3.57, 9.0])[:, None]
    depth, current = np.array([1.0, 6.0, 80.0]), 0.4
    number = _wave_number(period, depth, current_velocity=current)
    back = wave_period_of(number, depth, current_velocity=current)
    assert back == pytest.approx(np.broadcast_to(period, back.shape), rel=1e-13)


def test_group_velocity_is_the_derivative_of_the_frequency():
    number, depth = np.geomspace(1e-3, 5, 50), 7.0

    def frequency(k):
        return np.sqrt(STANDARD_GRAVITY * k * np.tanh(k * depth))

    step = 1e-4 * number
    slope = (frequency(number + step) - frequency(number - step)) / (2 * step)
    assert _group_velocity(number, depth) == pytest.approx(slope, rel=1e-7)
    assert np.isfinite(_group_velocity(1e4, 1e4))


@pytest.mark.parametrize(("period", "current"), [(5.0, 0.0), (5.0, 1.0)])
def test_a_search_that_does_not_end_says_so(monkeypatch, period, current):
    start = dispersion._still_water
    monkeypatch.setattr(dispersion, "_MOST_STEPS", 1)
    if current:

        def ended(frequency):
            monkeypatch.setattr(dispersion, "_MOST_STEPS", 100)
            root = start(frequency)
            monkeypatch.setattr(dispersion, "_MOST_STEPS", 1)
            return root

        monkeypatch.setattr(dispersion, "_still_water", ended)
    with pytest.raises(FitError, match="the wave number was not found"):
        _wave_number(period, 6.0, current_velocity=current)


@pytest.mark.parametrize("bad", [0.0, -1.0, np.nan, np.inf])
def test_periods_and_depths_are_positive_numbers(bad):
    with pytest.raises(DataError, match="wave_period"):
        _wave_number(bad, 3.0)
    with pytest.raises(DataError, match="water_depth"):
        _wave_number(3.0, [1.0, bad])
    with pytest.raises(DataError, match="wave_number"):
        wave_period_of(bad, 3.0)


# sums of harmonics and the phases of their roots

PHASE = np.linspace(-7.0, 7.0, 101)
COSINES, SINES = np.array([1.3, -0.4, 0.2]), np.array([0.7, 0.1, -0.5])


def test_sums_are_those_of_cosines_and_sines():
    n = np.arange(1, 4)
    assert sum_at(cosine_series(COSINES, 0.6), PHASE) == pytest.approx(
        0.6 + np.cos(np.outer(PHASE, n)) @ COSINES, abs=1e-14
    )
    assert sum_at(sine_series(SINES), PHASE) == pytest.approx(
        np.sin(np.outer(PHASE, n)) @ SINES, abs=1e-14
    )


def test_derivative_and_product():
    n = np.arange(1, 4)
    first, second = cosine_series(COSINES, 0.6), sine_series(SINES)
    assert sum_at(phase_derivative(first), PHASE) == pytest.approx(
        -np.sin(np.outer(PHASE, n)) @ (n * COSINES), abs=1e-14
    )
    assert sum_at(series_product(first, second), PHASE) == pytest.approx(
        sum_at(first, PHASE) * sum_at(second, PHASE), abs=1e-13
    )


def test_every_zero_is_among_the_roots():
    # sin 3x has six zeros a turn
    found = np.sort(np.mod(root_phases(sine_series(np.array([0.0, 0.0, 1.0]))) + 0.1, 2 * np.pi))
    assert found == pytest.approx(0.1 + np.pi / 3 * np.arange(6), abs=1e-13)


def test_many_sums_at_once_and_an_order_that_is_rounding():
    clean = np.stack([cosine_series(np.array([1.0, 0.0]), c) for c in (0.0, 0.5)])
    noisy = clean + 1e-17
    for coefficients in (clean, noisy):
        phases = root_phases(coefficients)
        assert phases.shape == (2, 2)
        assert np.sort(phases, axis=-1) == pytest.approx(
            np.array([[-1, 1], [-4 / 3, 4 / 3]]) * np.pi / 2, abs=1e-13
        )


def test_a_sum_that_is_zero_gives_a_phase_and_no_sums_none():
    assert root_phases(np.zeros((3, 5), dtype=complex)).shape == (3, 1)
    assert root_phases(np.zeros((0, 5), dtype=complex)).size == 0


# steady waves by the stream function, against the equations that they have to meet

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


# which theory the printed table names, and which is meant


@pytest.mark.parametrize(
    ("relative_depth", "theory"),
    [
        (0.5, "airy"), (0.2, "airy"), (0.199, "stokes"), (0.1, "stokes"),
        (0.099, "cnoidal"), (0.041, "cnoidal"),
        (0.04, "beyond the table"), (0.01, "beyond the table"),
    ],
)  # fmt: skip
def test_depth_names_the_theory(relative_depth, theory):
    assert _theory_by_depth(relative_depth) == theory


@pytest.mark.parametrize(
    ("relative_depth", "steepness", "theory"),
    [
        (0.3, 0.0625, "airy"), (0.3, 0.2, "airy"), (0.3, 0.201, "none"), (0.0999, 0.01, "cnoidal or solitary"), (0.15, 0.0625, "none"), (0.15, 0.2, "stokes"),
        (0.1, 0.2, "none"), (0.07, 0.01, "cnoidal or solitary"), (0.03, 0.01, "none"),
    ],
)  # fmt: skip
def test_the_letter_of_the_table(relative_depth, steepness, theory):
    assert _printed_theory(relative_depth, steepness) == theory


def test_no_wave_that_stands_is_in_the_printed_row_of_stokes():
    # 0.142 is the steepest wave on any depth, and the row begins at 0.2
    for relative_depth in (0.11, 0.13, 0.15, 0.17, 0.19):
        assert _printed_theory(relative_depth, 0.142) == "none"


def test_ratios_are_positive():
    with pytest.raises(DataError, match="relative_depth"):
        _theory_by_depth(0.0)
    with pytest.raises(DataError, match="steepness"):
        _printed_theory(0.3, -0.1)


# printed settings beside the theories of the package


def test_the_printed_stokes_wave_is_that_of_the_package_but_for_the_rounded_frequency():
    printed = printed_stokes_wave()
    wave = stokes_wave(
        wave_height=1.25, wave_period=3.57, water_depth=3.0, elevation=0.0,
        wave_number=2 * np.pi / 20,
    )  # fmt: skip
    for name in (
        "elevation", "horizontal_velocity", "vertical_velocity",
        "horizontal_acceleration", "vertical_acceleration",
    ):  # fmt: skip
        assert getattr(printed, name) == pytest.approx(getattr(wave, name), rel=1e-13)
    assert wave.angular_frequency == pytest.approx(1.76, abs=0.005)


REFUSED = {
    "a time that is no number is refused": (
        lambda: particle_motion(airy_wave(**SEA, elevation=0.0), [0.0, np.nan]),
        DataError,
        "time",
    ),
    "numbers are positive": (
        lambda: breaking_height(0.3, 0.0),
        DataError,
        "water_depth",
    ),
    "a blocked wave among others is named": (
        lambda: _wave_number(4.0, 10.0, current_velocity=[0.0, -9.0, 1.0]),
        DataError,
        "stops 1 of 3 waves, first at index 1; found a current of -9",
    ),
    "a length that the current carries back has no period": (
        lambda: wave_period_of(2 * np.pi / 5, 10.0, current_velocity=-2.0),
        DataError,
        "the opposing current stops",
    ),
    "shapes that are no sum are refused": (
        lambda: root_phases(np.ones(4, dtype=complex)),
        DataError,
        "the coefficients have no middle",
    ),
    "only two loads are printed": (
        lambda: printed_airy_wave("third"),
        SettingsError,
        "the paper has no such load; found 'third'",
    ),
}


test_refusals = refusals(REFUSED)
