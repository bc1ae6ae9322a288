"""Laws of waves, of floating and of Morison's load, over random cases."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from reduction.prediction.wave_load import (
    ImmersedSection,
    _find_extremes,
    _immersion_depth_of,
    wave_load,
)
from reduction.prediction.wave_theory import (
    STANDARD_GRAVITY,
    _group_velocity,
    _wave_number,
    airy_wave,
    breaking_height,
    describe_wave,
    particle_motion,
    stokes_wave,
    wave_period_of,
)
from reduction.record.errors import DataError

periods, depths = st.floats(0.3, 60.0), st.floats(0.05, 5e3)
shares = st.floats(0.02, 0.95)


@given(periods, depths, st.floats(-0.99, 30.0))
def test_a_wave_number_fits_its_period_over_any_current_that_lets_it_through(period, depth, share):
    still = float(_wave_number(period, depth))
    current = share * float(_group_velocity(still, depth))
    try:
        number = float(_wave_number(period, depth, current_velocity=current))
    except DataError:
        # half the group velocity stops a wave over deep water, all of it over shallow water
        assert share < -0.499
        return
    intrinsic = 2 * np.pi / period - number * current
    assert intrinsic > 0
    assert intrinsic**2 == pytest.approx(
        STANDARD_GRAVITY * number * np.tanh(number * depth), rel=1e-11
    )
    assert (number > still) == (current < 0) or abs(number / still - 1) < 1e-12
    assume(share > -0.4)
    back = wave_period_of(number, depth, current_velocity=current)
    assert float(back) == pytest.approx(period, rel=1e-11)


@given(st.floats(0.0, 1.0), st.floats(0.01, 10.0))
def test_the_depth_of_a_segment_gives_its_area(share, diameter):
    area = share * np.pi * diameter**2 / 4
    depth = float(_immersion_depth_of(area, diameter))
    assert 0 <= depth <= diameter
    r = diameter / 2
    half_angle = 2 * np.arctan2(np.sqrt(depth), np.sqrt(diameter - depth))
    chord = np.sqrt(depth * (diameter - depth))
    assert half_angle * r**2 - (r - depth) * chord == pytest.approx(area, abs=1e-14 * r**2)
    # the rest is the segment of the other side
    rest = float(_immersion_depth_of(np.pi * diameter**2 / 4 - area, diameter))
    assert depth + rest == pytest.approx(diameter, rel=1e-9)


@given(
    periods, depths, shares, st.floats(-0.9, 0.9), st.sampled_from([airy_wave, stokes_wave]),
    st.floats(-3.0, 3.0), st.floats(0.05, 2.0),
)  # fmt: skip
def test_no_sample_of_a_load_goes_beyond_its_extremes(
    period, depth, share, place, make, current, diameter
):
    number = float(_wave_number(period, depth))
    height = share * float(breaking_height(number, depth))
    wave = make(
        wave_height=height, wave_period=period, water_depth=depth,
        elevation=max(place * height / 2, -depth),
    )  # fmt: skip
    hose = ImmersedSection(
        np.array(diameter), np.array(0.6 * np.pi * diameter**2 / 4), np.array(0.6 * diameter)
    )
    extremes = _find_extremes(wave, hose, current_velocity=current)
    load = wave_load(wave, hose, np.linspace(0.0, period, 2001), current_velocity=current)
    for name in ("horizontal", "vertical", "horizontal_classic", "vertical_classic"):
        found, series = getattr(extremes, name), getattr(load, name)
        scale = float(found.greatest)
        assert series.max() <= float(found.maximum) + 1e-11 * scale
        assert series.min() >= float(found.minimum) - 1e-11 * scale
        assert np.ptp(series) >= float(found.maximum - found.minimum) * (1 - 1e-3)


@given(periods, depths, shares, st.sampled_from([airy_wave, stokes_wave]))
def test_a_crest_to_trough_is_the_height_and_time_turned_back_turns_the_vertical(
    period, depth, share, make
):
    number = float(_wave_number(period, depth))
    height = share * float(breaking_height(number, depth))
    wave = make(wave_height=height, wave_period=period, water_depth=depth, elevation=0.0)
    motion = particle_motion(wave, [0.0, period / 2, 0.3 * period, -0.3 * period])
    assert motion.elevation[0] - motion.elevation[1] == pytest.approx(height, rel=1e-9)
    assert motion.horizontal_velocity[2] == pytest.approx(motion.horizontal_velocity[3], rel=1e-6)
    assert motion.vertical_velocity[2] == pytest.approx(-motion.vertical_velocity[3], rel=1e-6)


@given(periods, depths, st.floats(0.01, 3.0))
def test_a_description_flags_exactly_what_a_prediction_refuses(period, depth, share):
    assume(abs(share - 1) > 1e-9)
    number = float(_wave_number(period, depth))
    height = share * float(breaking_height(number, depth))
    sea = {"wave_height": height, "wave_period": period, "water_depth": depth}
    described = describe_wave(**sea)
    assert described.is_breaking == (share > 1)
    if described.is_breaking:
        with pytest.raises(DataError, match="breaks before it is this high"):
            airy_wave(**sea, elevation=-depth)
    else:
        airy_wave(**sea, elevation=-depth)
