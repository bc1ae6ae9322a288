import numpy as np
import pytest
from predicted_cases import LEAST_WAVE, WAVE, changed

from reduction.campaign.wave_spec import load_wave_case
from reduction.record.errors import SettingsError


@pytest.fixture
def load(tmp_path):
    def loaded(text):
        path = tmp_path / "floating.toml"
        path.write_text(text, encoding="utf-8")
        return load_wave_case(path)

    return loaded


def test_a_wave_load_is_read_in_si(load):
    case = load(WAVE)
    given = {
        "outer_diameter": 0.114, "wall_thickness": 0.006, "wall_density": 1250.0,
        "content_density": 830.0, "water_density": 1025.0, "water_depth": 6.0,
        "wave_height": 1.25, "wave_period": 3.57, "wave_length": 20.0, "current_velocity": 0.5,
        "wind_velocity": 10.0, "hose_length": 100.0,
    }  # fmt: skip
    assert {name: case[name] for name in given} == pytest.approx(given)
    assert case["wave_theory"] == "airy"


def test_what_is_not_said_is_what_the_paper_takes(load):
    """Eq. (12) of Zhang (2015): C_D 1.2, C_M 2.0; an empty hose, no current, no wind."""
    case = load(LEAST_WAVE)
    assert (case["drag_coefficient"], case["inertia_coefficient"]) == (1.2, 2.0)
    assert case["wind_drag_coefficient"] == 1.2
    assert (case["content_density"], case["water_density"], case["air_density"]) == (
        0.0,
        1025.0,
        1.225,
    )
    assert (case["current_velocity"], case["wind_velocity"], case["hose_length"]) == (0.0, 0.0, 1.0)
    assert case["wave_length"] is None and case["elevation"] is None
    assert (case["wave_theory"], case["vertical_width"]) == ("auto", "submerged")


def test_times_are_two_periods_in_four_hundred_steps(load):
    time = load(LEAST_WAVE)["time"]
    assert time.size == 401
    assert time[-1] == pytest.approx(2 * 3.57)


def test_times_may_be_given_and_begin_at_zero(load):
    text = LEAST_WAVE + 'duration = "10 s"\ntime_step = "0.1 s"\n'
    np.testing.assert_allclose(load(text)["time"], np.arange(101) * 0.1)


def test_a_level_may_be_below_the_water_and_currents_may_oppose(load):
    case = load(
        LEAST_WAVE + 'elevation = "-38 mm"\ncurrent_velocity = "-1 kn"\nwind_velocity = "-5 m/s"\n'
    )
    assert case["elevation"] == pytest.approx(-0.038)
    assert case["current_velocity"] == pytest.approx(-1852 / 3600)
    assert case["wind_velocity"] == -5


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        *(
            (f"{name} = ", f'{name} = "-1 {unit}"\n# ', f"wave_load.{name}: is not positive")
            for name, unit in (
                ("outer_diameter", "mm"), ("wall_thickness", "mm"), ("wall_density", "kg/m^3"),
                ("water_density", "kg/m^3"), ("water_depth", "m"), ("wave_height", "m"),
                ("wave_period", "s"), ("wave_length", "m"), ("hose_length", "m"),
            )
        ),
        ('"20 m"', '"0 m"', "wave_load.wave_length: is not positive; found 0 in SI"),
        ('"0.83 g/cm^3"', '"-1 g/cm^3"', "content_density: is negative; found -1000 in SI; needed z"),
        ("[wave_load]", '[wave_load]\nair_density = "0 kg/m^3"', "air_density: is not positive"),
        ("[wave_load]", "[wave_load]\ndrag_coefficient = 0", "drag_coefficient: is not positive"),
        ("[wave_load]", "[wave_load]\ninertia_coefficient = -1", "inertia_coefficient: is not pos"),
        ("[wave_load]", "[wave_load]\nwind_drag_coefficient = nan", "wind_drag_coefficient: a value is not finite"),
        ('"6 m"', '"6"', "wave_load.water_depth: a value has no unit"),
        ('"6 m"', '"6 kg"', "wave_load.water_depth: unit 'kg' is not a unit of length"),
        ('"3.57 s"', '"3.57 m"', "wave_load.wave_period: unit 'm' is not a unit of time"),
        ('"1.25 g/cm^3"', '"1.25 g"', "wave_load.wall_density: unit 'g' is not a unit of density"),
        ('"10 m/s"', '"10 s"', "wave_load.wind_velocity: unit 's' is not a unit of velocity"),
        ('"6 m"', '"?"', r"1 value is still '\?'\s+wave_load.water_depth"),
        ('"airy"', '"linear"', "'wave_load.wave_theory'"),
        ("[wave_load]", '[wave_load]\nvertical_width = "all"', "'wave_load.vertical_width'"),
        ("[wave_load]", "[wave_load]\ndepth = 1", "wave_load.depth: is not a known key"),
        ("[wave_load]", "[wave]", "wave_load: is required"),
        ("[wave_load]", '[wave_load]\nduration = "0 s"', "no time series .* found 0 s in steps"),
        ("[wave_load]", '[wave_load]\ntime_step = "-1 s"', "no time series .* in steps of -1 s"),
        ("[wave_load]", '[wave_load]\nduration = "1e9 s"', "at most 1000000 steps"),
        ("[wave_load]", "[wave_load", "the wave load is not TOML"),
        ('wave_height = "1.25 m"\n', "", "wave_load.wave_height: is required"),
    ],
)  # fmt: skip
def test_what_no_sea_and_no_hose_has_is_refused_with_its_key(load, tmp_path, old, new, message):
    with pytest.raises(SettingsError, match=message) as caught:
        load(changed(WAVE, old, new))
    assert str(caught.value).startswith(str(tmp_path / "floating.toml"))


def test_every_fault_is_told_at_once(load):
    text = changed(changed(WAVE, '"airy"', '"linear"'), "[wave_load]", "[wave_load]\ndepth = 1")
    with pytest.raises(SettingsError, match="2 settings cannot be used") as caught:
        load(text)
    assert "docs/predictions.md lists every key" in str(caught.value)


def test_a_file_that_is_not_there_says_what_is_needed(tmp_path):
    with pytest.raises(SettingsError, match=r"cannot be read; .* needed a SPEC.toml with \[wave_l"):
        load_wave_case(tmp_path / "none.toml")
