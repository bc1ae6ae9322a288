import math

import numpy as np
import pytest
from export_lines import constant, growing, line, syrope

from reduction.errors import SettingsError
from reduction.export.product import SEA_WATER


def test_the_dashpot_of_a_mooring_code_gives_the_same_stiffness_at_every_frequency():
    part = constant()
    slow, fast = part.static_stiffness, part.fast_stiffness
    omega = np.logspace(-4, 3, 40)
    maxwell = slow + (fast - slow) / (1 - 1j / (omega * part.relaxation_time))
    spring = 1 / (1 / slow - 1 / fast)
    series = 1 / (1 / fast + 1 / (spring + 1j * omega * part.slow_dashpot_coefficient))
    np.testing.assert_allclose(series, maxwell, rtol=1e-12)
    assert part.relaxation_time == 3.0


def test_a_stiffness_that_grows_is_taken_at_its_mean_tension():
    assert growing().fast_stiffness == 3e4 + 10 * 2000


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"dashpot_coefficient": -1.0}, "not numbers of at least zero"),
        ({"dashpot_coefficient": math.nan}, "not numbers of at least zero"),
        ({"dynamic_stiffness_per_mean_tension": 5.0}, "has no mean tension"),
        ({"dynamic_stiffness": 2e4}, "not above the static one"),
        ({"static_stiffness": 0.0}, "not above the static one"),
    ],
)
def test_a_line_that_is_not_stiffer_when_fast_is_refused(changed, message):
    with pytest.raises(SettingsError, match=message):
        constant(**changed)


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"form": "CUBIC"}, "form of a Syrope working curve is not known"),
        ({"k1": 0.0}, "form LINEAR cannot have"),
        ({"form": "QUADRATIC", "k2": 1.5}, "form QUADRATIC cannot have"),
        ({"form": "EXP", "k1": 1.0, "k2": 1.0}, "form EXP cannot have"),
        ({"mean_tension": 4e6}, "do not fit its original working curve"),
        ({"greatest_mean_tension": 7e6}, "do not fit its original working curve"),
        ({"slow_damping": 0.0}, "stiffness and damping of a Syrope line"),
        ({"dynamic_stiffness": 5e7, "dynamic_stiffness_per_mean_tension": 0.0}, "stiffer than"),
    ],
)
def test_a_syrope_that_moordyn_would_not_survive_is_refused(changed, message):
    with pytest.raises(SettingsError, match=message):
        syrope(**changed)


def test_a_working_curve_ends_at_the_greatest_mean_tension_and_begins_at_its_share_of_strain():
    for form, k1, k2 in (("LINEAR", 0.2, 0), ("QUADRATIC", 0.2, 0.5), ("EXP", 0.2, 1.5)):
        at_top = syrope(form=form, k1=k1, k2=k2, mean_tension=3e6)
        assert at_top.initial_strain == pytest.approx(0.04)
        at_zero = syrope(form=form, k1=k1, k2=k2, mean_tension=1e-3)
        assert at_zero.initial_strain == pytest.approx(0.008, abs=1e-9)
    assert syrope(k1=1e8).initial_strain == pytest.approx(0.04 - 2e6 / 1e8)


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
