"""A wave load from the file's numbers on, against formulas written out here."""

import re

import numpy as np
import pytest
from predicted_cases import LEAST_WAVE, WAVE, predicted_wave

from reduction.record.errors import DataError, FitError

DIAMETER, DENSITY, DRAG, INERTIA = 0.114, 1025.0, 1.2, 2.0
HEIGHT, PERIOD, LENGTH, DEPTH, CURRENT = 1.25, 3.57, 20.0, 6.0, 0.5
STILL = {"current_velocity": 0.0, "wave_length": None}


@pytest.fixture
def predict(tmp_path):
    def predicted(text=WAVE, **changes):
        return predicted_wave(tmp_path / "w.toml", text, **changes)

    return predicted


def submerged():
    """Weight of wall and content over that of the water, and the depth of such a segment."""
    bore = DIAMETER - 0.012
    wall = np.pi / 4 * (DIAMETER**2 - bore**2)
    area = (1250 * wall + 830 * np.pi / 4 * bore**2) / DENSITY
    depths = np.linspace(0, DIAMETER, 200_001)
    radius, below = DIAMETER / 2, DIAMETER / 2 - depths
    segments = radius**2 * np.arccos(below / radius) - below * np.sqrt(
        np.maximum(radius**2 - below**2, 0)
    )
    return area, float(np.interp(area, segments, depths))


def airy(time, elevation):
    """Velocities of a linear wave, and accelerations as the drifting water has them."""
    k, omega = 2 * np.pi / LENGTH, 2 * np.pi / PERIOD
    seen = omega - k * CURRENT  # by one who drifts with the current
    size = seen * HEIGHT / 2 / np.sinh(k * DEPTH)
    level = k * (elevation + DEPTH)
    phase = -omega * time
    across = size * np.cosh(level) * np.array([np.cos(phase), seen * np.sin(phase)])
    upward = size * np.sinh(level) * np.array([np.sin(phase), -seen * np.cos(phase)])
    return across, upward


def morison(velocity, acceleration, *, width, area):
    drag = DRAG * DENSITY / 2 * width * velocity * np.abs(velocity)
    return drag + INERTIA * DENSITY * area * acceleration


def test_the_hose_floats_as_deep_as_it_is_heavy(predict):
    """Zhang (2015), eq. (11): 95.1 mm and 0.0091 m2."""
    section = predict().load.section
    area, depth = submerged()
    assert float(section.submerged_section_area) == pytest.approx(area, rel=1e-12)
    assert float(section.immersion_depth) == pytest.approx(depth, abs=1e-8)
    assert float(section.immersion_depth) == pytest.approx(0.0951, abs=0.5e-4)
    assert float(section.submerged_section_area) == pytest.approx(0.0091, abs=0.5e-4)


def test_loads_over_time_are_those_of_the_formula(predict):
    found = predict()
    area, depth = submerged()
    across, upward = airy(found.load.time, DIAMETER / 2 - depth)
    whole = np.pi / 4 * DIAMETER**2
    expected = {
        "horizontal": morison(across[0] + CURRENT, across[1], width=depth, area=area),
        "horizontal_classic": morison(across[0] + CURRENT, across[1], width=DIAMETER, area=whole),
        "vertical": morison(upward[0], upward[1], width=DIAMETER, area=area),
        "vertical_classic": morison(upward[0], upward[1], width=DIAMETER, area=whole),
    }
    for name, load in expected.items():
        np.testing.assert_allclose(getattr(found.load, name), load, rtol=1e-6, atol=1e-5)


def test_extremes_are_those_of_a_fine_search(predict):
    found = predict()
    area, depth = submerged()
    time = np.linspace(0, PERIOD, 400_001)
    across, _ = airy(time, DIAMETER / 2 - depth)
    load = morison(across[0] + CURRENT, across[1], width=depth, area=area)
    own = found.extremes.horizontal
    assert float(own.maximum) == pytest.approx(load.max(), rel=1e-7)
    assert float(own.minimum) == pytest.approx(load.min(), rel=1e-7)
    assert float(own.time_of_maximum) == pytest.approx(time[load.argmax()], abs=1e-4)


def test_the_wave_that_computed_the_load_goes_with_it(predict):
    found = predict()
    assert found.wave.elevation == pytest.approx([HEIGHT / 2])
    assert 2 * np.pi / found.wave.angular_frequency == pytest.approx(PERIOD)
    assert 2 * np.pi / found.wave.wave_number == pytest.approx(LENGTH)
    assert (found.drag_coefficient, found.inertia_coefficient) == (DRAG, INERTIA)
    assert (found.current_velocity, found.wind_velocity, found.hose_length) == (0.5, 10, 100)


def test_the_water_is_taken_at_the_centre_of_the_hose_unless_said(predict):
    _, depth = submerged()
    assert predict().elevation == pytest.approx(DIAMETER / 2 - depth, abs=1e-8)
    assert predict(elevation=-0.5).elevation == -0.5


def test_wind_blows_on_what_stands_out_and_current_on_what_is_under(predict):
    anchor = predict().anchor
    _, depth = submerged()
    assert float(anchor.wind) == pytest.approx(100 * 1.225 / 2 * 1.2 * (DIAMETER - depth) * 10**2)
    assert float(anchor.current) == pytest.approx(100 * DENSITY / 2 * 1.2 * depth * CURRENT**2)
    assert float(anchor.separate) == pytest.approx(
        float(anchor.wind) + float(anchor.current) + float(anchor.wave)
    )
    assert float(anchor.combined) > float(anchor.separate)


def test_the_theory_is_the_stream_function_unless_another_is_asked_for(predict):
    found = predict(LEAST_WAVE)
    assert (found.used, found.theory.theory) == ("stream function", "airy")
    assert found.theory.wave_length == pytest.approx(2 * np.pi / found.wave.wave_number)
    assert found.notes == ()
    found = predict(LEAST_WAVE, wave_theory="stokes")
    assert (found.used, found.theory.theory) == ("stokes", "airy")
    assert found.wave.elevation.size == 2
    said = "computed by stokes, as stated; Zhang (2015) takes airy at this depth"
    assert said in map(str, found.notes)


@pytest.mark.parametrize(
    ("theory", "sea"),
    [
        # 0.6 of breaking at depths of 0.07, 0.11, 0.19 and 0.3 wave lengths: all had status ok
        ("cnoidal", {"water_depth": 6.0, "wave_height": 2.81, "wave_period": 11.52}),
        ("stokes", {"water_depth": 6.0, "wave_height": 2.78, "wave_period": 7.64}),
        ("stokes", {"water_depth": 6.0, "wave_height": 2.23, "wave_period": 4.93}),
        ("airy", {"water_depth": 6.0, "wave_height": 1.63, "wave_period": 3.66}),
    ],
)
def test_a_theory_whose_load_is_wrong_says_by_how_much(predict, theory, sea):
    """Against loads of raschii's stream function, written out here."""
    fenton = pytest.importorskip("raschii").FentonWave
    found = predict(WAVE, **STILL, **sea, wave_theory=theory)
    height, period, depth = (sea[k] for k in ("wave_height", "wave_period", "water_depth"))
    own = predict(WAVE, **STILL, **sea, wave_theory="auto")
    wave = fenton(height, depth, own.theory.wave_length, N=15, g=9.80665)
    assert wave.period == pytest.approx(period, rel=1e-4)
    # the speed of a steady wave is at x - c t: derivatives over time are - c d/dx
    place = np.linspace(0, wave.length, 2001)
    level = np.full(place.size, depth + found.elevation)
    u, w = wave.velocity(place, level, 0.0, all_points_wet=True).T
    area, h = submerged()
    rates = (-wave.c * np.gradient(one, place, edge_order=2) for one in (u, w))
    true = [
        np.max(np.abs(morison(one, rate, width=width, area=area)))
        for one, rate, width in zip((u, w), rates, (h, DIAMETER), strict=True)
    ]
    for name, right in zip(("horizontal", "vertical"), true, strict=True):
        assert float(getattr(own.extremes, name).greatest) == pytest.approx(right, rel=2e-3)
        off = 100 * (float(getattr(found.extremes, name).greatest) / right - 1)
        said = re.search(rf"{name} load is (\d+) % too (low|high)", warnings_of(found)[-1])
        if abs(off) > 5.5:
            assert said is not None
            assert float(said[1]) == pytest.approx(abs(off), abs=1.0)
            assert said[2] == ("low" if off < 0 else "high")
    assert own.notes == ()


def test_shallow_water_and_steep_waves_have_their_theories(predict):
    shallow = {"water_depth": 1.0, "wave_height": 0.2, "wave_period": 6.0, "wave_length": None}
    found = predict(LEAST_WAVE, **shallow, wave_theory="cnoidal")
    assert found.used == found.theory.theory == "cnoidal"
    length = 2 * np.pi / found.wave.wave_number
    said = f"the wave by cnoidal is {length:.4g} m long, because it is high"
    assert said in map(str, found.notes)
    # c^2 < g (d + H), the solitary wave; longer than the linear wave
    assert (
        found.theory.wave_length < 2 * np.pi / found.wave.wave_number < 6 * np.sqrt(9.80665 * 1.2)
    )
    load = found.load.horizontal
    assert float(found.extremes.horizontal.maximum) == pytest.approx(load.max(), rel=1e-3)
    found = predict(LEAST_WAVE, wave_theory="stokes 5")
    assert (found.used, found.wave.elevation.size) == ("stokes 5", 5)
    steep = {"water_depth": 3.0, "wave_length": None, "wave_theory": "stokes 5"}
    assert list(map(str, predict(LEAST_WAVE, **steep).notes)) == [
        "the wave by stokes 5 is 17.42 m long, because it is high",
        "computed by stokes 5, as stated; Zhang (2015) takes stokes at this depth",
    ]


def test_extremes_of_a_wave_of_many_harmonics_are_those_of_a_fine_search(predict):
    sea = {"water_depth": 1.5, "wave_height": 0.4, "wave_period": 10.0, "wave_theory": "cnoidal"}
    found = predict(LEAST_WAVE, **sea, time=np.linspace(0.0, 10.0, 20_001))
    assert found.wave.elevation.size > 20
    for name in ("horizontal", "vertical"):
        own, load = getattr(found.extremes, name), getattr(found.load, name)
        assert float(own.maximum) == pytest.approx(load.max(), rel=1e-5)
        assert float(own.minimum) == pytest.approx(load.min(), rel=1e-5)


def test_a_length_that_is_not_that_of_the_period_is_told(predict):
    assert any("stated wave length" in str(note) for note in predict().notes)
    assert not any("stated wave length" in str(note) for note in predict(wave_length=None).notes)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"wall_density": 2500.0}, "the hose is heavier than water"),
        ({"wall_thickness": 0.06}, "the wall is thicker than half the hose"),
        ({"wave_height": 4.0}, "breaks before it is this high; found 4 m over 6 m"),
        ({"current_velocity": -20.0}, "the opposing current stops the wave"),
        ({"elevation": -7.0}, "the place is not in the water"),
        (
            {"water_depth": 0.5, "wave_height": 0.1, "wave_length": None, "wave_period": 200.0,
             "wave_theory": "auto"},
            "no steady wave of this height was found; .* Give a lower wave or a shorter period",
        ),
    ],
)  # fmt: skip
def test_what_cannot_be_computed_is_refused(predict, changes, message):
    with pytest.raises((DataError, FitError), match=message):
        predict(**changes)


def test_a_hose_as_wide_as_a_fifth_of_the_wave_is_told_to_scatter_it(predict):
    wide = predict(
        LEAST_WAVE, outer_diameter=4.5, wall_thickness=0.1, water_depth=20.0, elevation=0.0
    )
    # over deep water, by Stokes' third order, L = g T^2 / 2 pi (1 + (k H / 2)^2)
    length = 9.80665 * PERIOD**2 / (2 * np.pi)
    length *= 1 + (np.pi * HEIGHT / length) ** 2
    assert any(
        f"{100 * 4.5 / length:.0f} % of the wave length" in note for note in warnings_of(wide)
    )
    assert warnings_of(predict(LEAST_WAVE)) == []


def test_a_wave_below_the_centre_of_a_light_hose_moves_it_as_at_its_crest(predict):
    """Deep water: of a load that is mostly inertia the maximum is C_M rho S a omega^2 exp(k a)."""
    rate, height = 2 * np.pi / 5, 0.3
    found = predict(
        **STILL, outer_diameter=0.6, wall_thickness=0.05, wall_density=500.0, content_density=0.0,
        water_depth=200.0, wave_height=height, wave_period=5.0, wave_theory="airy",
    )  # fmt: skip
    area = np.pi * (0.3**2 - 0.25**2) * 500 / 1025
    inertia = 2 * 1025 * area * rate**2 * height / 2 * np.exp(rate**2 / 9.80665 * height / 2)
    assert found.elevation == height / 2
    assert float(found.extremes.horizontal.maximum) == pytest.approx(inertia, rel=1e-6)


def test_far_below_the_surface_a_theory_has_no_error(predict):
    deep = {"water_depth": 2500.0, "wave_height": 0.0023, "wave_period": 2.6, "elevation": -1500.0}
    found = predict(LEAST_WAVE, **deep, wave_theory="stokes")
    assert float(found.extremes.horizontal.greatest) == 0
    assert warnings_of(found) == []


def warnings_of(found):
    return [str(one) for one in found.notes if one.severity == "warning"]
