"""Waves against raschii (Apache-2.0): Stokes after Fenton 1985, and the numerical stream function.

raschii measures z from the bed.  Its Stokes wave of second order has the velocities and the surface
of that theory, and with them the celerity of the next order; so comparisons are at time 0.
"""

import numpy as np
import pytest
from csvrows import csv_rows
from measured_logs import LOGS
from raschii import AiryWave, FentonWave, StokesWave, check_breaking_criteria

from reduction.prediction.wave_theory import (
    _wave_number,
    airy_wave,
    breaking_height,
    cnoidal_wave,
    high_stokes_wave,
    particle_motion,
    stokes_wave,
    wave_period_of,
)

GRAVITY = 9.81
KINEMATICS = LOGS / "waves" / "raschii_kinematics_t0.csv"
CASES = [
    (2.0, 20.0, 60.0),
    (1.25, 6.0, 20.0),
    (1.25, 3.0, 20.0),
    (0.1, 0.8, 2.0),
    (0.5, 40.0, 15.0),
]
MAKERS = {"Airy": (AiryWave, {}, airy_wave), "Stokes": (StokesWave, {"N": 2}, stokes_wave)}


def ours(make, height, depth, length, elevation):
    number = 2 * np.pi / length
    return make(
        wave_height=height,
        wave_period=float(wave_period_of(number, depth, gravity=GRAVITY)),
        water_depth=depth,
        elevation=elevation,
        gravity=GRAVITY,
    )


@pytest.mark.parametrize("theory", MAKERS)
@pytest.mark.parametrize(("height", "depth", "length"), CASES)
def test_velocities_and_surface_are_those_of_raschii(theory, height, depth, length):
    their, options, make = MAKERS[theory]
    wave = their(height, depth, length, g=GRAVITY, **options)
    x = np.linspace(0.0, length, 41)
    for elevation in (-depth, -0.7 * depth, -0.5 * height):
        mine = ours(make, height, depth, length, elevation)
        motion = [particle_motion(mine, 0.0, position) for position in x]
        theirs = wave.velocity(x, np.full_like(x, depth + elevation), 0.0, all_points_wet=True)
        for column, name in enumerate(("horizontal_velocity", "vertical_velocity")):
            found = [float(getattr(one, name)[0]) for one in motion]
            assert found == pytest.approx(theirs[:, column], abs=1e-12)
        surface = [float(one.elevation[0]) for one in motion]
        assert surface == pytest.approx(wave.surface_elevation(x, 0.0, False), abs=1e-12)


@pytest.mark.parametrize(("height", "depth", "length"), CASES)
def test_periods_are_those_of_raschii_to_first_order(height, depth, length):
    wave = AiryWave(height, depth, length, g=GRAVITY)
    assert float(wave_period_of(2 * np.pi / length, depth, gravity=GRAVITY)) == pytest.approx(
        wave.period, rel=1e-13
    )
    back = _wave_number(wave.period, depth, gravity=GRAVITY)
    assert 2 * np.pi / float(back) == pytest.approx(length, rel=1e-13)


def test_celerity_of_a_steep_wave_is_above_the_linear_one_by_the_third_order():
    # c2 / c0 = eps^2 (8 + cosh 4kd) / (16 sinh^4 kd) + ..., which the package leaves out
    for height, depth, length in CASES[:4]:
        wave = StokesWave(height, depth, length, N=2, g=GRAVITY)
        linear = float(wave_period_of(2 * np.pi / length, depth, gravity=GRAVITY))
        excess = linear / wave.period - 1
        q = 2 * np.pi / length * depth
        eps = np.pi * height / length
        expected = eps**2 * (8 + np.cosh(4 * q)) / (16 * np.sinh(q) ** 4)
        assert excess == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize(("make", "order"), [(airy_wave, 2), (stokes_wave, 3)])
@pytest.mark.parametrize(("depth", "length"), [(20.0, 60.0), (6.0, 20.0)])
def test_error_against_the_stream_function_falls_with_the_order_of_the_theory(
    make, order, depth, length
):
    x = np.linspace(0.0, length, 33)
    heights = length * np.array([0.01, 0.005, 0.0025])
    elevation = -0.15 * depth
    errors = []
    for height in heights:
        exact = FentonWave(float(height), depth, length, N=15, g=GRAVITY)
        theirs = exact.velocity(x, np.full_like(x, depth + elevation), 0.0, all_points_wet=True)
        mine = ours(make, float(height), depth, length, elevation)
        found = np.array(
            [particle_motion(mine, 0.0, position).horizontal_velocity[0] for position in x]
        )
        errors.append(np.max(np.abs(found - theirs[:, 0])))
    falls = np.log2(np.array(errors[:-1]) / errors[1:])
    # what is left of the next order halves with the height
    assert falls[-1] == pytest.approx(order, abs=0.1)


@pytest.mark.parametrize("order", [3, 5])
def test_error_of_high_orders_falls_with_the_order_of_the_theory(order):
    errors, depth, length = [], 6.0, 20.0
    for height in (1.0, 0.5):
        exact = FentonWave(height, depth, length, N=15, g=GRAVITY)
        mine = high_stokes_wave(
            order=order, wave_height=height, wave_period=exact.period, water_depth=depth,
            elevation=-1.0, gravity=GRAVITY,
        )  # fmt: skip
        crest = float(np.ravel(exact.velocity(0.0, depth - 1.0, 0.0, all_points_wet=True))[0])
        errors.append(
            [
                abs(mine.horizontal_velocity.sum() / crest - 1),
                abs(2 * np.pi / mine.wave_number / length - 1),
            ]
        )
    falls = np.log2(np.divide(*errors))
    # over the velocity, which goes with the height; lengths are right to even orders
    assert falls == pytest.approx([order, order + 1], abs=0.7)


def test_error_of_a_cnoidal_wave_falls_with_the_height_at_one_ursell_number():
    errors, depth = [], 10.0
    for share in (0.1, 0.05):
        length = depth * np.sqrt(40 / share)
        exact = FentonWave(share * depth, depth, length, N=15, g=GRAVITY)
        mine = cnoidal_wave(
            wave_height=share * depth, wave_period=exact.period, water_depth=depth, elevation=0.0,
            gravity=GRAVITY,
        )  # fmt: skip
        crest = float(np.ravel(exact.surface_elevation(0.0, 0.0, False))[0])
        errors.append(abs(mine.elevation.sum() / crest - 1))
    assert errors[0] < 0.02
    assert np.log2(errors[0] / errors[1]) == pytest.approx(1, abs=0.3)


@pytest.mark.parametrize("depth", [6.0, 3.0])
def test_the_limit_of_miche_is_that_of_raschii(depth):
    limit = float(breaking_height(2 * np.pi / 20, depth))
    assert not check_breaking_criteria(0.999 * limit, depth, 20.0)[0]
    assert check_breaking_criteria(1.001 * limit, depth, 20.0)[0]


@pytest.mark.skipif(not KINEMATICS.exists(), reason="computed waves are not part of the project")
@pytest.mark.parametrize("theory", MAKERS)
def test_stored_kinematics_of_raschii_come_back(theory):
    rows = [row for row in csv_rows(KINEMATICS) if row["model"] == theory]
    assert len(rows) > 100
    n_wet = 0
    for row in rows:
        place = {name: float(value) for name, value in row.items() if name != "model"}
        height, depth, length = place["height_m"], place["depth_m"], place["length_m"]
        mine = ours(
            MAKERS[theory][2], height, depth, length, min(place["z_from_bed_m"] - depth, height / 2)
        )
        motion = particle_motion(mine, 0.0, place["x_m"])
        assert depth + float(motion.elevation[0]) == pytest.approx(
            place["eta_from_bed_m"], abs=1e-12
        )
        if place["z_from_bed_m"] > place["eta_from_bed_m"]:
            continue
        n_wet += 1
        assert float(motion.horizontal_velocity[0]) == pytest.approx(place["u_m_per_s"], abs=1e-12)
        assert float(motion.vertical_velocity[0]) == pytest.approx(place["w_m_per_s"], abs=1e-12)
    assert n_wet > 100


@pytest.mark.skipif(not KINEMATICS.exists(), reason="computed waves are not part of the project")
def test_stokes_is_nearer_to_the_stream_function_than_airy():
    rows = [row for row in csv_rows(KINEMATICS) if row["model"] == "Fenton"]
    misses = {airy_wave: [], stokes_wave: []}
    for row in rows:
        place = {name: float(value) for name, value in row.items() if name != "model"}
        if place["z_from_bed_m"] > place["eta_from_bed_m"]:
            continue
        case = place["height_m"], place["depth_m"], place["length_m"]
        for make, found in misses.items():
            motion = particle_motion(
                ours(make, *case, place["z_from_bed_m"] - case[1]), 0.0, place["x_m"]
            )
            scale = np.pi * case[0] / place["T_s"]
            found.append((float(motion.horizontal_velocity[0]) - place["u_m_per_s"]) / scale)
    rms = {make: float(np.sqrt(np.mean(np.square(found)))) for make, found in misses.items()}
    assert rms[stokes_wave] < rms[airy_wave] < 0.1
