"""Values of a line type for a mooring code."""

import math

import numpy as np
import pytest
from export_lines import line

from reduction.lines.export_line import (
    LIFT,
    SEA_WATER,
    Hydrodynamics,
    curve_from_zero,
    guards_of,
    range_of,
    thin_curve,
)
from reduction.record.errors import DataError, SettingsError


def test_chords_of_a_parabola_have_the_error_of_even_steps():
    """T = 100 e + 10 e^2 over n even steps: the chord is off by 10 h^2 / 4."""
    strain = np.linspace(0, 1, 5000)
    found = thin_curve(strain, 100 * strain + 10 * strain**2, most=30)
    assert found.strain.size == 30
    assert found.error == pytest.approx(2.5 / 29**2, rel=0.01)
    assert found.share == found.error / 110


def test_small_tensions_are_as_close_as_great_ones():
    """A line that locks up: 60 N where it works, 320 kN where it breaks."""
    strain = np.linspace(0, 1.2, 5000)
    tension = 300 * strain + 2e6 * np.maximum(strain - 0.8, 0) ** 2
    found = thin_curve(strain, tension, most=30)
    assert np.interp(0.2, found.strain, found.tension) == pytest.approx(60, rel=0.011)
    # no tension above a thousandth of the greatest is off by more than a hundredth
    off = np.abs(np.interp(strain, found.strain, found.tension) - tension)
    counted = tension > 1e-3 * tension[-1]
    assert (off[counted] / tension[counted]).max() <= found.local <= 0.01
    # and the top is as close as ever: 28 even steps of the parabola would be off by 102 N
    assert found.error < 2.5 * 2e6 * (0.4 / 28) ** 2 / 4


def test_where_few_points_cannot_hold_a_hundredth_both_errors_are_stated():
    strain = np.linspace(0, 1, 5000)
    found = thin_curve(strain, 100 * strain**3, most=5)
    off = np.abs(np.interp(strain, found.strain, found.tension) - 100 * strain**3)
    assert found.local == pytest.approx((off / np.maximum(100 * strain**3, 0.1)).max(), rel=1e-6)
    assert found.local > 0.01
    assert found.error == pytest.approx(off.max(), rel=1e-6)


def test_a_curve_with_few_points_is_kept():
    found = thin_curve([0, 0.1, 0.3], [0, 5, 9], most=30)
    np.testing.assert_array_equal(found.strain, [0, 0.1, 0.3])
    assert found.error == 0
    assert found.words == ""


def test_corners_are_found():
    strain = np.linspace(0, 1, 1001)
    tension = np.where(strain < 0.4, strain, 0.4 + 30 * (strain - 0.4))
    found = thin_curve(strain, tension, most=3)
    np.testing.assert_allclose(found.strain, [0, 0.4, 1])
    assert found.error < 1e-9


def test_slack_is_told_from_what_was_not_measured():
    strain, tension, words = curve_from_zero([0.1, 0.2, 0.5], [0.0, 0.0, 8.0])
    np.testing.assert_allclose(strain, [0, 0.2, 0.5])
    np.testing.assert_allclose(tension, [0, LIFT * 8 * 0.4, 8 * (1 + LIFT)])
    assert words.startswith("slack from zero to strain 0.2")
    assert "straight line" in curve_from_zero([0.1, 0.2], [1.0, 2.0])[2]


def test_negative_tension_before_the_line_comes_taut_is_left_out():
    strain, tension, _ = curve_from_zero([-0.1, 0.0, 0.2], [-3.0, 0.0, 8.0])
    np.testing.assert_array_equal(strain, [0, 0.2])
    np.testing.assert_array_equal(tension, [0, 8])


@pytest.mark.parametrize(
    ("strain", "tension", "message"),
    [
        ([0.1], [1.0], "fewer than two points"),
        ([0.1, 0.2], [1.0], "fewer than two points"),
        ([0.1, np.nan], [1.0, 2.0], "not numbers"),
        ([0.0, 0.2, 0.1], [0.0, 2.0, 1.0], "a loop cannot be exported"),
        ([0.0, 0.1, 0.2], [0.0, 2.0, 1.0], "reverses at 1 of 2 steps"),
        ([0.0, 0.2], [5.0, 8.0], "tension at zero strain"),
        ([0.1, 0.2], [0.0, 0.0], "ends at zero tension"),
    ],
)
def test_a_curve_that_no_code_can_take_is_refused(strain, tension, message):
    with pytest.raises(DataError, match=message):
        curve_from_zero(strain, tension)


def test_the_straight_start_is_said_not_to_be_measured():
    assert range_of(line()) == (
        "tested from strain 0.1 to 1.4; the start, a straight line from zero to strain 0.1, was NOT "
        "measured on this curve"
    )
    assert range_of(line(tested=(0.0, 1.4))) == "tested from strain 0 to 1.4"
    assert range_of(line(tested=(math.nan, math.nan))) == "nothing was tested"
    assert range_of(line(tested=(0.2, 1.3), turns=(0.1, 1.4))) == (
        "tested from strain 0.1 to 1.4 (both branches from 0.2 to 1.3); the start, a straight line"
        " from zero to strain 0.1, was NOT measured on this curve"
    )


def test_a_line_that_floats_or_is_heavier_than_a_rod_of_its_fibre_is_doubtful():
    # 26 mm displace 0.544 kg/m
    assert SEA_WATER * np.pi / 4 * 0.026**2 == pytest.approx(0.5442, abs=5e-5)
    (text,) = (one for one in guards_of(line(linear_density=0.5)) if one.startswith("DOUBTFUL"))
    assert "floats: 0.5 kg/m displaces 0.5442 kg/m" in text
    assert not any(one.startswith("DOUBTFUL") for one in guards_of(line()))
    # who states a wet mass below zero has a line that floats
    floating = guards_of(line(linear_density=0.5, wet_linear_density=-0.04))
    assert not any("floats" in one for one in floating)
    # a solid line whose masses and diameter are rounded, and one whose masses are of another
    assert not any("DOUBTFUL" in one for one in guards_of(line(wet_linear_density=0.054)))
    assert "disagree" in guards_of(line(wet_linear_density=0.03))[-1]
    # a rod of nylon of 26 mm has 1140 * 5.309e-4 m2 = 0.605 kg/m
    heavy = guards_of(line(linear_density=0.61, material="nylon"))
    assert "disagree" in heavy[-1]
    assert "disagree" not in guards_of(line(linear_density=0.6, material="nylon"))[-1]
    # 0.36 of it is 0.218 kg/m
    assert "far below" in guards_of(line(linear_density=0.21, material="nylon"))[-1]
    assert "disagree" not in guards_of(line(linear_density=0.22, material="nylon"))[-1]


def test_without_mass_or_diameter_the_range_alone_is_said():
    assert len(guards_of(line(linear_density=math.nan))) == 1
    assert len(guards_of(line(diameter=math.nan))) == 1


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"name": "---"}, "has no name"),
        ({"curve": " "}, "has no curve"),
        ({"sources": ()}, "has no source"),
        ({"wet_linear_density": 0.6}, "is not lighter in water than in air"),
        ({"wet_linear_density": 0.7}, "0.7 kg/m in water, 0.6 kg/m in air"),
    ],
)
def test_a_line_says_what_it_is_and_where_it_is_from(changed, message):
    with pytest.raises(SettingsError, match=message):
        line(**changed)


def test_a_name_becomes_one_word():
    assert line(name='1/2" rope, new -- wet').identifier == "1_2_rope_new_-_wet"


def test_dry_and_wet_mass_give_the_diameter_that_displaces_as_much():
    displaced = SEA_WATER * math.pi / 4 * 0.02**2
    found, words = line(wet_linear_density=0.6 - displaced).volume_diameter
    assert found == pytest.approx(0.02)
    assert "dry and wet mass" in words
    assert line().volume_diameter[0] == 0.026


def test_what_a_format_needs_and_nobody_stated_is_named_with_its_option():
    with pytest.raises(SettingsError, match=r"linear density of new tether.*--linear-density"):
        line(linear_density=math.nan).needed("linear_density")


def test_a_rope_without_wet_mass_displaces_the_volume_of_its_fibre():
    # 6.5 lb of nylon in 100 ft of 1/2 in: 0.0967 kg/m
    found, words = line(diameter=0.0127, linear_density=0.0967, material="Nylon").volume_diameter
    assert math.pi / 4 * found**2 == pytest.approx(0.0967 / 1140)
    assert "1140 kg/m3 (Bigon and Regazzoni" in words
    assert "nominal 12.7 mm" in words
    # a stated wet mass goes before it, and of rubber no density is known
    wet = 0.0967 - SEA_WATER * math.pi / 4 * 0.011**2
    one = line(linear_density=0.0967, wet_linear_density=wet, material="nylon")
    assert one.volume_diameter[0] == pytest.approx(0.011)
    assert line(material="rubber").volume_diameter[0] == 0.026
    assert line(diameter=math.nan, material="polyester").volume_diameter[1].endswith("is stated")


def test_a_name_is_written_without_accents_and_refused_where_no_sign_is_left():
    assert line(name="tr\u00e9s souple").identifier == "tres_souple"
    named = line(name="\u7d22 \u4e00")
    assert named.name == "\u7d22 \u4e00"
    with pytest.raises(SettingsError, match="no character that a mooring code accepts"):
        assert named.identifier


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"rated_break_strength": 80.0}, "above the break strength of 80 N"),  # kN
        ({"rated_break_strength": 800.0}, ""),  # the curve goes to 900 N: ropes exceed their rating
        ({"hydrodynamics": Hydrodynamics(0.02, 1.6, 1.0, 0.0, "stated")}, "transverse one first"),
        ({"hydrodynamics": Hydrodynamics(2.4, 1.15, 1.0, 0.0, "a chain")}, ""),
    ],
)
def test_a_strength_below_the_curve_and_drag_the_wrong_way_round_are_doubtful(changed, said):
    made = line(**changed)
    assert float(made.tension.max()) == pytest.approx(900 * (1.5 - 0.45 * 1.5**2 + 0.16 * 1.5**3))
    doubts = [one for one in guards_of(made) if one.startswith("DOUBTFUL")]
    assert len(doubts) == bool(said) and all(said in one for one in doubts)
