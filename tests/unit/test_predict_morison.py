"""Morison's equation, classic and improved."""

import numpy as np
import pytest

from reduction.prediction.wave_load import ImmersedSection, immerse_hose, load_factors, wave_load
from reduction.prediction.wave_theory import particle_motion, stokes_wave
from reduction.record.errors import DataError

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
