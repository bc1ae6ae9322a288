"""Wave load on a floating hose."""

from decimal import Decimal, localcontext

import numpy as np
import pytest

from reduction.prediction import wave_load as immersion
from reduction.prediction.wave_load import (
    CODE_OF_HYDROLOGY,
    GREATEST_DIAMETER_TO_LENGTH,
    PUBLISHED_COEFFICIENTS,
    ImmersedSection,
    _anchor_force,
    _current_load,
    _drag_to_inertia,
    _find_extremes,
    _flow_regime,
    _immersion_depth_of,
    _keulegan_carpenter_number,
    _load_difference,
    _load_range,
    _reynolds_number,
    _wind_load,
    immerse_hose,
    load_factors,
    wave_load,
)
from reduction.prediction.wave_theory import (
    airy_wave,
    cosine_series,
    particle_motion,
    sine_series,
    stokes_wave,
)
from reduction.record.errors import DataError, FitError

D, H_IN, S1 = 0.114, 0.0951, 0.0091
HOSE = ImmersedSection(np.array(D), np.array(S1), np.array(H_IN))
WHOLE = ImmersedSection(np.array(D), np.array(np.pi * D**2 / 4), np.array(D))
WAVE = stokes_wave(wave_height=1.0, wave_period=4.0, water_depth=5.0, elevation=-0.04)
TIME = np.linspace(0.0, 9.0, 77)
LOADS = ("horizontal", "vertical")


def test_both_forms_term_by_term():
    load = wave_load(
        WAVE, HOSE, TIME, drag_coefficient=1.1, inertia_coefficient=1.8, water_density=1020.0,
        current_velocity=0.3, position=2.0,
    )  # fmt: skip
    motion = particle_motion(WAVE, TIME, 2.0)
    u, w = motion.horizontal_velocity + 0.3, motion.vertical_velocity
    drag = 0.5 * 1.1 * 1020
    ax, az = motion.horizontal_acceleration, motion.vertical_acceleration
    whole = 1.8 * 1020 * np.pi * D**2 / 4
    assert load.horizontal == pytest.approx(drag * H_IN * u * abs(u) + 1.8 * 1020 * S1 * ax)
    assert load.vertical == pytest.approx(drag * D * w * abs(w) + 1.8 * 1020 * S1 * az)
    assert load.horizontal_classic == pytest.approx(drag * D * u * abs(u) + whole * ax)
    assert load.vertical_classic == pytest.approx(drag * D * w * abs(w) + whole * az)
    assert load.horizontal_drag == pytest.approx(drag * H_IN * u * abs(u))
    assert load.vertical_drag == pytest.approx(drag * D * w * abs(w))
    assert load.time == pytest.approx(TIME)
    assert load.section is HOSE


def test_a_hose_wholly_under_water_has_the_classic_load():
    load = wave_load(WAVE, WHOLE, TIME)
    for name in LOADS:
        assert getattr(load, name) == pytest.approx(getattr(load, f"{name}_classic"), abs=1e-12)


def test_the_width_of_the_vertical_drag():
    printed = load_factors(HOSE, vertical_width="immersion depth")
    met = load_factors(HOSE)
    assert printed.vertical_drag == pytest.approx(float(printed.horizontal_drag))
    assert float(printed.vertical_drag / met.vertical_drag) == pytest.approx(H_IN / D)
    assert met.vertical_drag == pytest.approx(float(met.classic_drag))
    # less than half under water: the chord, wider than the depth
    high = ImmersedSection(np.array(D), np.array(0.002), np.array(0.03))
    ratio = load_factors(high).vertical_drag / load_factors(high).horizontal_drag
    assert float(ratio) == pytest.approx(2 * np.sqrt(0.03 * (D - 0.03)) / 0.03)


def test_loads_of_many_hoses_have_an_axis_of_time_behind_them():
    hoses = immerse_hose(
        outer_diameter=[[0.1], [0.2]], wall_thickness=0.006, wall_density=1250.0,
        content_density=[0.0, 400.0, 800.0], water_density=1025.0,
    )  # fmt: skip
    load = wave_load(WAVE, hoses, TIME)
    assert load.horizontal.shape == load.vertical_classic.shape == (2, 3, 77)
    one = ImmersedSection(
        hoses.outer_diameter[1, 2], hoses.submerged_section_area[1, 2], hoses.immersion_depth[1, 2]
    )
    assert load.vertical[1, 2] == pytest.approx(wave_load(WAVE, one, TIME).vertical)


def test_wave_and_current_are_one_flow():
    together = wave_load(WAVE, HOSE, [0.0], current_velocity=0.5)
    wave, steady = wave_load(WAVE, HOSE, [0.0]), wave_load(WAVE, HOSE, [0.0], current_velocity=0.0)
    u = float(particle_motion(WAVE, [0.0]).horizontal_velocity[0])
    factor = float(load_factors(HOSE).horizontal_drag)
    added = together.horizontal_drag - wave.horizontal_drag
    assert added == pytest.approx([factor * (2 * u * 0.5 + 0.25)])
    assert steady.horizontal == pytest.approx(wave.horizontal)
    assert together.vertical == pytest.approx(wave.vertical)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"water_density": 0.0}, "water_density"),
        ({"inertia_coefficient": -1.0}, "inertia_coefficient"),
        ({"drag_coefficient": np.nan}, "drag_coefficient"),
        ({"current_velocity": np.inf}, "current_velocity"),
    ],
)
def test_numbers_that_are_none_are_refused(change, message):
    with pytest.raises(DataError, match=message):
        wave_load(WAVE, HOSE, TIME, **change)


def test_results_are_read_only():
    load = wave_load(WAVE, HOSE, TIME)
    with pytest.raises(ValueError, match="read-only"):
        load.horizontal[0] = 0.0


# published coefficients, typed again, and the numbers by which they are chosen

SEA = {"wave_height": 1.25, "wave_period": 3.57, "water_depth": 3.0, "elevation": -0.038}
TABLE_2 = [
    ((1.0, 1.0), 0.95, "Wiegel"), ((1.0, 1.4), 2.0, "Agerschou"),
    ((1.34, 1.34), 1.6, "Keulegan"), ((0.8, 1.0), 2.0, "Agerschou"),
]  # fmt: skip


def test_table_2_and_the_code_are_typed_alike():
    found = [(one.drag_coefficient, one.inertia_coefficient) for one in PUBLISHED_COEFFICIENTS]
    assert found == [row[:2] for row in TABLE_2]
    for one, row in zip(PUBLISHED_COEFFICIENTS, TABLE_2, strict=True):
        assert row[2] in one.source
    assert (CODE_OF_HYDROLOGY.drag_coefficient, CODE_OF_HYDROLOGY.inertia_coefficient) == (
        (1.2, 1.2), 2.0,
    )  # fmt: skip


def test_drag_over_inertia_is_that_of_the_two_terms():
    speed, period, diameter, density = 1.3, 4.0, 0.2, 1025.0
    drag = 0.5 * 1.2 * density * diameter * speed**2
    inertia = 2.0 * density * np.pi * diameter**2 / 4 * speed * 2 * np.pi / period
    number = _keulegan_carpenter_number(speed, period, diameter)
    assert number == pytest.approx(1.3 * 4 / 0.2)
    assert _drag_to_inertia(number) == pytest.approx(drag / inertia, rel=1e-13)


def test_reynolds_number_takes_the_magnitude():
    assert _reynolds_number(-1.0, 0.1) == pytest.approx(0.1 / 1.1892e-6)


@pytest.mark.parametrize("make", [airy_wave, stokes_wave])
@pytest.mark.parametrize("current", [0.0, 0.4, -0.9])
def test_greatest_velocity_is_that_of_a_fine_sweep(make, current):
    wave = make(**SEA)
    regime = _flow_regime(wave, [0.114, 0.3], current_velocity=current)
    sweep = particle_motion(wave, np.linspace(0.0, 3.57, 200_001)).horizontal_velocity + current
    assert regime.greatest_velocity == pytest.approx(np.max(np.abs(sweep)), rel=1e-9)
    assert regime.keulegan_carpenter_number == pytest.approx(
        regime.greatest_velocity * 3.57 / np.array([0.114, 0.3])
    )
    assert regime.diameter_to_length == pytest.approx(
        np.array([0.114, 0.3]) * wave.wave_number / (2 * np.pi)
    )
    assert np.all(regime.diameter_to_length < GREATEST_DIAMETER_TO_LENGTH)
    assert GREATEST_DIAMETER_TO_LENGTH == 0.2


def test_numbers_that_are_none_are_refused_in_coefficients():
    with pytest.raises(DataError, match="greatest_velocity"):
        _keulegan_carpenter_number(np.nan, 3.0, 0.1)
    with pytest.raises(DataError, match="outer_diameter"):
        _reynolds_number(1.0, 0.0)
    with pytest.raises(DataError, match="inertia_coefficient"):
        _drag_to_inertia(10.0, inertia_coefficient=0.0)


# difference of two loads, where it means something

HOSE_OF_DIFFERENCE = ImmersedSection(np.array(0.114), np.array(0.0091), np.array(0.0951))
WAVE_OF_DIFFERENCE = stokes_wave(
    wave_height=1.25, wave_period=3.57, water_depth=3.0, elevation=-0.038
)
EXTREMES = _find_extremes(WAVE_OF_DIFFERENCE, HOSE_OF_DIFFERENCE)


def test_extremes_are_cut_by_what_lies_between_the_cuts_of_drag_and_inertia():
    found = _load_difference(EXTREMES)
    drag, inertia = 1 - 0.0951 / 0.114, 1 - 0.0091 / (np.pi * 0.114**2 / 4)
    for name in ("horizontal_of_maximum", "horizontal_of_minimum"):
        assert inertia < float(getattr(found, name)) < drag
    # upwards the width is that of the whole hose: the inertia alone is cut
    assert 0 < float(found.vertical_of_maximum) < inertia
    by_hand = 1 - EXTREMES.vertical.minimum / EXTREMES.vertical_classic.minimum
    assert float(found.vertical_of_minimum) == pytest.approx(float(by_hand))


# wind, current and wave on a length of hose

HOSE_OF_ENVIRONMENT = ImmersedSection(np.array(0.114), np.array(0.0091), np.array(0.0951))
WAVE_OF_ENVIRONMENT = airy_wave(
    wave_height=1.25, wave_period=3.57, water_depth=6.0, elevation=-0.038
)
TIME_OF_ENVIRONMENT = np.linspace(0.0, 3.57, 50_001)


def sweep(current=0.0):
    return wave_load(
        WAVE_OF_ENVIRONMENT, HOSE_OF_ENVIRONMENT, TIME_OF_ENVIRONMENT, current_velocity=current
    ).horizontal


def test_wind_and_current_are_drag_on_their_own_part_of_the_hose():
    wind = _wind_load(
        HOSE_OF_ENVIRONMENT, wind_velocity=-12.0, wind_drag_coefficient=1.1, air_density=1.25
    )
    assert float(wind) == pytest.approx(-0.5 * 1.25 * 1.1 * (0.114 - 0.0951) * 144)
    current = _current_load(
        HOSE_OF_ENVIRONMENT, current_velocity=-0.8, drag_coefficient=0.9, water_density=1000.0
    )
    assert float(current) == pytest.approx(-0.5 * 1000 * 0.9 * 0.0951 * 0.64)


@pytest.mark.parametrize(
    ("current", "wind"), [(0.5, 10.0), (-0.5, -10.0), (0.4, -30.0), (0.0, 0.0)]
)
def test_force_against_a_sweep(current, wind):
    force = _anchor_force(
        WAVE_OF_ENVIRONMENT,
        HOSE_OF_ENVIRONMENT,
        hose_length=50.0,
        current_velocity=current,
        wind_velocity=wind,
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
    force = _anchor_force(
        WAVE_OF_ENVIRONMENT, HOSE_OF_ENVIRONMENT, hose_length=1.0, current_velocity=0.5
    )
    assert float(force.combined) > 1.3 * float(force.separate)
    # with drag alone the cross term is 2 u U
    drag = _anchor_force(
        WAVE_OF_ENVIRONMENT,
        HOSE_OF_ENVIRONMENT,
        hose_length=1.0,
        current_velocity=0.5,
        inertia_coefficient=1e-9,
    )
    u = float(WAVE_OF_ENVIRONMENT.horizontal_velocity[0])
    cross = 0.5 * 1025 * 1.2 * 0.0951 * 2 * u * 0.5
    assert float(drag.combined - drag.separate) == pytest.approx(cross, rel=1e-9)


def test_without_wind_and_current_both_are_the_wave():
    force = _anchor_force(WAVE_OF_ENVIRONMENT, HOSE_OF_ENVIRONMENT, hose_length=3.0)
    assert float(force.combined) == pytest.approx(float(force.wave), rel=1e-15)
    assert float(force.difference) == 0


def test_many_hoses_at_once():
    many = ImmersedSection(
        np.array([0.114, 0.2]), np.array([0.0091, 0.02]), np.array([0.0951, 0.12])
    )
    force = _anchor_force(
        WAVE_OF_ENVIRONMENT, many, hose_length=10.0, current_velocity=0.2, wind_velocity=5.0
    )
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
def test_numbers_that_are_none_are_refused_in_environment(change, message):
    with pytest.raises(DataError, match=message):
        _anchor_force(WAVE_OF_ENVIRONMENT, HOSE_OF_ENVIRONMENT, **{"hose_length": 1.0, **change})


# extremes of a load between any samples

HOSE_OF_EXTREMES = ImmersedSection(np.array(0.114), np.array(0.0091), np.array(0.0951))
SEA_OF_EXTREMES = {"wave_height": 1.25, "wave_period": 3.57, "elevation": -0.038}
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
    wave = make(**SEA_OF_EXTREMES, water_depth=depth)
    setting = {"current_velocity": current, "position": 1.3}
    extremes = _find_extremes(wave, HOSE_OF_EXTREMES, **setting)
    sweep = wave_load(wave, HOSE_OF_EXTREMES, np.linspace(0.0, 3.57, 20_001), **setting)
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
            there = getattr(wave_load(wave, HOSE_OF_EXTREMES, float(time), **setting), name)
            assert there == pytest.approx([float(value)], rel=1e-12)


def test_the_load_is_flat_where_it_is_extreme():
    wave = stokes_wave(**SEA_OF_EXTREMES, water_depth=3.0)
    extremes = _find_extremes(wave, HOSE_OF_EXTREMES)
    step = 1e-5
    for name in NAMES:
        found = getattr(extremes, name)
        time = float(found.time_of_maximum)
        beside = getattr(
            wave_load(wave, HOSE_OF_EXTREMES, time + step * np.array([-1.0, 0.0, 1.0])), name
        )
        slope = (beside[2] - beside[0]) / (2 * step)
        curvature = (beside[2] - 2 * beside[1] + beside[0]) / step**2
        # by one Newton step the time would not move
        assert abs(slope / curvature) < 1e-8


def test_many_hoses_at_once_in_extremes():
    hoses = immerse_hose(
        outer_diameter=[[0.1], [0.6]], wall_thickness=0.006, wall_density=1250.0,
        content_density=[0.0, 400.0, 800.0], water_density=1025.0,
    )  # fmt: skip
    wave = stokes_wave(**SEA_OF_EXTREMES, water_depth=4.0)
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


def test_numbers_that_are_none_are_refused_in_extremes():
    wave = airy_wave(**SEA_OF_EXTREMES, water_depth=3.0)
    with pytest.raises(DataError, match="current_velocity"):
        _find_extremes(wave, HOSE_OF_EXTREMES, current_velocity=np.nan)
    with pytest.raises(DataError, match="position"):
        _find_extremes(wave, HOSE_OF_EXTREMES, position=np.inf)
    with pytest.raises(DataError, match="drag"):
        linear_range(np.nan, 1.0)


# floating depth of a hose from its weight

HOSE_OF_IMMERSION = {
    "outer_diameter": 0.114, "wall_thickness": 0.006, "wall_density": 1250.0,
    "content_density": 830.0, "water_density": 1025.0,
}  # fmt: skip


def segment(depth, diameter):
    """Area below a chord, eq. (8) of the paper as printed."""
    r = diameter / 2
    return (np.pi - np.arccos((depth - r) / r)) * r**2 + (depth - r) * np.sqrt(
        r**2 - (depth - r) ** 2
    )


def test_printed_hose():
    hose = immerse_hose(**HOSE_OF_IMMERSION)
    # 0.0090994 m2, 95.124 mm, 0.83442, S1/S0 0.89148: worked out beside the paper
    assert float(hose.submerged_section_area) == pytest.approx(0.0090994, abs=5e-8)
    assert 1000 * float(hose.immersion_depth) == pytest.approx(95.124, abs=0.0005)
    assert float(hose.submerged_share) == pytest.approx(0.89148, abs=5e-6)
    assert 1 - float(hose.immersion_depth) / 0.114 == pytest.approx(0.1656, abs=5e-5)
    assert float(hose.section_area) == pytest.approx(np.pi * 0.114**2 / 4)
    assert 1000 * float(hose.centre_elevation) == pytest.approx(-38.1, abs=0.05)
    assert float(hose.emergent_height + hose.immersion_depth) == pytest.approx(0.114)


def test_weight_is_carried():
    for content in (0.0, 400.0, 830.0):
        hose = immerse_hose(**{**HOSE_OF_IMMERSION, "content_density": content})
        wall = np.pi * (0.057**2 - 0.051**2) * 1250.0
        weight = wall + np.pi * 0.051**2 * content
        assert 1025.0 * segment(float(hose.immersion_depth), 0.114) == pytest.approx(
            weight, rel=1e-12
        )


def test_an_empty_hose_floats_high_and_meets_the_water_with_its_chord():
    hose = immerse_hose(**{**HOSE_OF_IMMERSION, "content_density": 0.0})
    depth = float(hose.immersion_depth)
    assert depth < 0.057 and float(hose.centre_elevation) > 0
    half = np.sqrt(0.057**2 - (0.057 - depth) ** 2)
    assert float(hose.submerged_width) == pytest.approx(2 * half, rel=1e-12)
    assert float(immerse_hose(**HOSE_OF_IMMERSION).submerged_width) == 0.114


def sine(angle):
    """Of a Decimal, by its series."""
    term, total, n = angle, angle, 1
    while abs(term) > Decimal(10) ** -58:
        term *= -angle * angle / ((2 * n) * (2 * n + 1))
        total, n = total + term, n + 1
    return total


def test_depth_is_exact_to_the_last_digits_over_twenty_decades_of_area():
    angles = np.concatenate([np.geomspace(1e-6, 1.0, 60), np.linspace(1.0, 6.2, 60)])
    with localcontext() as digits:
        digits.prec = 60
        area, depth = [], []
        for one in map(Decimal, map(float, angles)):
            area.append(float((one - sine(one)) / 8))
            depth.append(float(sine(one / 4) ** 2))
    assert _immersion_depth_of(area, 1.0) == pytest.approx(depth, rel=2e-15)


def test_ends_and_middle():
    area = np.pi / 4 * np.array([0.0, 0.5, 1.0])
    assert _immersion_depth_of(area, 1.0) == pytest.approx([0.0, 0.5, 1.0], abs=1e-15)
    neutral = immerse_hose(
        **{**HOSE_OF_IMMERSION, "wall_density": 1025.0, "content_density": 1025.0}
    )
    assert float(neutral.immersion_depth) == pytest.approx(0.114)
    assert float(neutral.submerged_width) == pytest.approx(0.114)


def test_a_rod_has_no_bore():
    rod = immerse_hose(**{**HOSE_OF_IMMERSION, "wall_thickness": 0.057, "wall_density": 600.0})
    assert float(rod.submerged_share) == pytest.approx(600 / 1025)


def test_many_hoses_at_once_in_immersion():
    thickness = np.linspace(0.002, 0.015, 7)[:, None]
    content = np.array([0.0, 500.0, 830.0])
    many = immerse_hose(
        **{**HOSE_OF_IMMERSION, "wall_thickness": thickness, "content_density": content}
    )
    assert many.immersion_depth.shape == (7, 3)
    one = immerse_hose(
        **{**HOSE_OF_IMMERSION, "wall_thickness": float(thickness[4, 0]), "content_density": 500.0}
    )
    assert many.immersion_depth[4, 1] == pytest.approx(float(one.immersion_depth), rel=1e-14)
    with pytest.raises(ValueError, match="read-only"):
        many.immersion_depth[0, 0] = 1.0


def test_a_hose_heavier_than_water_is_refused_with_the_densities():
    with pytest.raises(
        DataError,
        match=r"1 of 2 hoses are heavier than water, first at index 1; found 1049\.9 kg/m3 with a "
        r"wall of 1250 and a content of 1000 kg/m3; needed at most 1025 kg/m3",
    ):
        immerse_hose(**{**HOSE_OF_IMMERSION, "content_density": [830.0, 1000.0]})


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"outer_diameter": -0.1}, "outer_diameter"),
        ({"wall_thickness": 0.0}, "wall_thickness"),
        ({"wall_density": np.nan}, "wall_density"),
        ({"water_density": 0.0}, "water_density"),
        ({"content_density": -1.0}, "content_density is below zero"),
        ({"wall_thickness": 0.06}, "the wall is thicker than half the hose"),
    ],
)
def test_no_hose(change, message):
    with pytest.raises(DataError, match=message):
        immerse_hose(**{**HOSE_OF_IMMERSION, **change})


@pytest.mark.parametrize("area", [-1e-6, 0.8])
def test_no_segment(area):
    with pytest.raises(DataError, match="no segment of the circle is this large"):
        _immersion_depth_of(area, 1.0)


def test_a_search_that_does_not_end_says_so(monkeypatch):
    monkeypatch.setattr(immersion, "_MOST_STEPS", 1)
    with pytest.raises(FitError, match="the immersion depth was not found"):
        _immersion_depth_of(0.1, 1.0)


def test_a_section_by_hand_is_read_only():
    section = ImmersedSection(np.array([0.1]), np.array([0.005]), np.array([0.06]))
    assert not section.immersion_depth.flags.writeable
