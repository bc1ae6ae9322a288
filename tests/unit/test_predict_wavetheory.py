"""Description of a wave: theory, limits, doubts."""

import numpy as np
import pytest

from reduction.prediction.wave_theory import (
    GREATEST_URSELL_NUMBER,
    describe_wave,
    regular_wave,
    stokes_wave,
)
from reduction.record.errors import DataError

SHALLOW = {"wave_height": 1.25, "wave_period": 3.57, "water_depth": 3.0}


def test_the_second_printed_example_is_at_the_edge():
    wave = describe_wave(**SHALLOW, wave_length=20.0)
    assert wave.ursell_number == pytest.approx(18.5, abs=0.05)
    assert wave.height_to_depth == pytest.approx(0.417, abs=0.0005)
    assert wave.velocity_ratio == pytest.approx(0.26, abs=0.005)
    assert wave.elevation_ratio == pytest.approx(0.30, abs=0.005)
    assert wave.breaking_ratio == pytest.approx(0.0625 / 0.105, abs=0.005)
    assert wave.is_beyond_stokes and not wave.is_breaking
    assert any("Stokes' second order is at its end" in one for one in wave.reasons)
    assert any("the given length is +22.7 % off" in one for one in wave.reasons)


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
    assert any("the second harmonic of the surface is 12 %" in one for one in steep.reasons)
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
    assert any(one.startswith("the wave breaks: 1.") for one in wave.reasons)


def test_a_wave_beyond_the_table_is_computed_by_name_alone():
    sea = {"wave_height": 0.2, "wave_period": 12.0, "water_depth": 1.5}
    wave = describe_wave(**sea)
    assert wave.theory == "beyond the table" and not wave.is_computed
    assert any("Table 1 names no theory" in one for one in wave.reasons)
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
def test_sizes_are_positive(name):
    with pytest.raises(DataError, match=name):
        describe_wave(**{**SHALLOW, name: 0.0})
