import math

import pytest
from export_lines import line

from reduction.errors import SettingsError
from reduction.export.product import SEA_WATER


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"name": "---"}, "has no name"),
        ({"curve": " "}, "has no curve"),
        ({"sources": ()}, "has no source"),
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
