import math

import pytest
from export_lines import line

from reduction.lines.export_line import SEA_WATER
from reduction.record.errors import SettingsError


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
