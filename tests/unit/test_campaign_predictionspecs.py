"""SPEC.toml of armour, wave load and assembly."""

import numpy as np
import pytest
from predicted_cases import ARMOUR, LEAST_ARMOUR, LEAST_WAVE, WAVE, changed

from reduction.campaign.assembly_spec import load_assembly_case
from reduction.campaign.prediction_specs import load_armour_case, load_wave_case
from reduction.record.errors import SettingsError


@pytest.fixture
def load(tmp_path):
    def loaded(text):
        path = tmp_path / "cable.toml"
        path.write_text(text, encoding="utf-8")
        return load_armour_case(path)

    return loaded


def test_an_armour_is_read_in_si_from_radii_or_diameters(load):
    case = load(ARMOUR)
    design = case.layers.design
    assert (case.name, case.layer_names) == ("cable", ("inner", "outer"))
    np.testing.assert_allclose(np.degrees(design.winding_angle), [20, 20])
    np.testing.assert_allclose(design.wire_radius, [2.5e-3, 2.5e-3])
    np.testing.assert_allclose(design.core_radius, [25e-3, 30e-3])
    np.testing.assert_allclose(design.n_wires, [30, 36])
    np.testing.assert_allclose(case.layers.yield_stress, [700e6, 700e6])
    assert case.layers.lay == ("right", "left")
    np.testing.assert_allclose(case.strain, [1e-3])


def test_what_is_not_said_is_steel_of_one_wire_and_no_yield(load):
    """The steel of Wang (2022), sec. 4: 210 GPa, 0.3."""
    case = load(LEAST_ARMOUR)
    design = case.layers.design
    assert design.elastic_modulus == pytest.approx([210e9])
    assert design.poisson_ratio == pytest.approx([0.3])
    assert design.n_wires == pytest.approx([1])
    assert np.isnan(case.layers.yield_stress).all()
    assert case.layer_names == ("layer 1",)
    assert case.layers.lay == ("right",)
    assert case.tolerance == pytest.approx(0.01)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('"20 deg"', '"95 deg"', "winding_angle .* found 95 deg; needed between 0 and 90"),
        ('"20 deg"', '"0 deg"', "winding_angle of 1 of 2 designs is not that of an armour; found 0"),
        ('"20 deg"', '"-20 deg"', "winding_angle of 1 of 2 designs is not that of an armour"),
        ('"20 deg"', '"90 deg"', "winding_angle of 1 of 2 designs is not that of an armour"),
        ('"20 deg"', '"20"', "armour.layers.inner.winding_angle: a value has no unit"),
        ('"2.5 mm"', '"-2.5 mm"', "wire_radius of 1 of 2 designs is not that of an armour; found -0.0025"),
        ('"5 mm"', '"-5 mm"', "wire_radius of 1 of 2 designs is not that of an armour; found -0.0025"),
        ('"25 mm"', '"-25 mm"', "core_radius of 1 of 2 designs is not that of an armour; found -0.025"),
        ('"60 mm"', '"-60 mm"', "core_radius of 1 of 2 designs is not that of an armour; found -0.03"),
        ('wire_radius = "2.5 mm"\n', "", "inner: state wire_radius or wire_diameter once; found neither"),
        ('core_radius = "25 mm"\n', "", "inner: state core_radius or core_diameter once; found neither"),
        (
            "n_wires = 30", 'n_wires = 30\ncore_diameter = "50 mm"',
            "state core_radius or core_diameter once; found both; needed core_radius or core_diameter",
        ),
        ("n_wires = 30", "n_wires = 40", "wires of layer 1 do not fit .* found 40 wires that over"),
        ("n_wires = 30", "n_wires = 0", "armour.layers.0.n_wires"),
        ("n_wires = 30", "n_wires = 2.5", "armour.layers.0.n_wires"),
        ('"60 mm"', '"52 mm"', "layer 2 lies inside layer 1; found core_radius 0.026 m; needed 0.03"),
        ("n_wires = 30", "n_wires = 30\npoisson_ratio = 0.7", "poisson_ratio of 1 of 2"),
        ("n_wires = 30", 'n_wires = 30\nelastic_modulus = "0 GPa"', "elastic_modulus of 1 of 2"),
        ("n_wires = 30", 'n_wires = 30\nelastic_modulus = "2 m"', "inner.elastic_modulus: unit 'm'"),
        ('"700 MPa"', '"-7 MPa"', "yield_stress of layer 1 is not above zero"),
        ('"700 MPa"', '"7 m"', "armour.layers.inner.yield_stress: unit 'm'"),
        ('lay = "left"', 'lay = "up"', "armour.layers.1.lay"),
        ('"0.1 %"', '"1 m"', "armour.axial_strain: unit 'm' is not a unit of strain"),
        ('"0.1 %"', '"?"', r"still '\?'\s+armour.axial_strain"),
        ("[armour]", "[armour]\ntolerance = 0", "armour.tolerance: is not positive; found 0"),
        ("[armour]", '[armour]\ntolerance = "-1 %"', "armour.tolerance: is not positive"),
        ('name = "inner"', 'nome = "inner"', "armour.layers.0.nome: is not a known key"),
        ('axial_strain = "0.1 %"\n', "", "armour.axial_strain: is required"),
        ("[armour]", "[armour", "the armour is not TOML"),
    ],
)  # fmt: skip
def test_what_no_cable_has_is_refused_with_its_place(load, tmp_path, old, new, message):
    with pytest.raises(SettingsError, match=message) as caught:
        load(changed(ARMOUR, old, new))
    assert str(caught.value).startswith(str(tmp_path / "cable.toml"))


def test_an_armour_has_a_layer(load):
    with pytest.raises(SettingsError, match="armour.layers"):
        load('[armour]\naxial_strain = "0.1 %"\nlayers = []\n')


def test_a_layer_without_a_name_is_told_by_its_number(load):
    with pytest.raises(SettingsError, match=r"armour.layers.1.winding_angle"):
        load(changed(LEAST_ARMOUR, '"45 deg"', '"45"'))


def test_a_file_that_is_not_there_says_what_is_needed(tmp_path):
    with pytest.raises(SettingsError, match=r"cannot be read; .* needed a SPEC.toml with \[armour"):
        load_armour_case(tmp_path / "none.toml")


@pytest.fixture
def load_of_waves(tmp_path):
    def loaded(text):
        path = tmp_path / "floating.toml"
        path.write_text(text, encoding="utf-8")
        return load_wave_case(path)

    return loaded


def test_a_wave_load_is_read_in_si(load_of_waves):
    case = load_of_waves(WAVE)
    given = {
        "outer_diameter": 0.114, "wall_thickness": 0.006, "wall_density": 1250.0,
        "content_density": 830.0, "water_density": 1025.0, "water_depth": 6.0,
        "wave_height": 1.25, "wave_period": 3.57, "wave_length": 20.0, "current_velocity": 0.5,
        "wind_velocity": 10.0, "hose_length": 100.0,
    }  # fmt: skip
    assert {name: case[name] for name in given} == pytest.approx(given)
    assert case["wave_theory"] == "airy"


def test_what_is_not_said_is_what_the_paper_takes(load_of_waves):
    """Eq. (12) of Zhang (2015): C_D 1.2, C_M 2.0; an empty hose, no current, no wind."""
    case = load_of_waves(LEAST_WAVE)
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


def test_times_are_two_periods_in_four_hundred_steps(load_of_waves):
    time = load_of_waves(LEAST_WAVE)["time"]
    assert time.size == 401
    assert time[-1] == pytest.approx(2 * 3.57)


def test_times_may_be_given_and_begin_at_zero(load_of_waves):
    text = LEAST_WAVE + 'duration = "10 s"\ntime_step = "0.1 s"\n'
    np.testing.assert_allclose(load_of_waves(text)["time"], np.arange(101) * 0.1)


def test_a_level_may_be_below_the_water_and_currents_may_oppose(load_of_waves):
    case = load_of_waves(
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
def test_what_no_sea_and_no_hose_has_is_refused_with_its_key(
    load_of_waves, tmp_path, old, new, message
):
    with pytest.raises(SettingsError, match=message) as caught:
        load_of_waves(changed(WAVE, old, new))
    assert str(caught.value).startswith(str(tmp_path / "floating.toml"))


def test_every_fault_is_told_at_once(load_of_waves):
    text = changed(changed(WAVE, '"airy"', '"linear"'), "[wave_load]", "[wave_load]\ndepth = 1")
    with pytest.raises(SettingsError, match="2 settings cannot be used") as caught:
        load_of_waves(text)
    assert "docs/predictions.md lists every key" in str(caught.value)


def test_a_file_that_is_not_there_says_what_is_needed_in_waves(tmp_path):
    with pytest.raises(SettingsError, match=r"cannot be read; .* needed a SPEC.toml with \[wave_l"):
        load_wave_case(tmp_path / "none.toml")


LBF = 4.4482216152605


def load_of_assemblies(tmp_path, text):
    path = tmp_path / "mooring.toml"
    path.write_text(text, encoding="utf-8")
    return load_assembly_case(path)


def test_every_key_comes_in_si(tmp_path):
    case = load_of_assemblies(
        tmp_path,
        """
[assembly]
free_lengths = ["8 m", "320 in"]
rated_break_strength = "800 lbf"
[assembly.curve]
source = ["a.nc", "b.nc"]
specimen = "new"
branch = "ascending"
precedence = ["static", "cyclic"]
[assembly.splices]
length = "120 cm"
strain = "40 %"
at_tension = "200 lbf"
exponent = 0.85
[[assembly.parts]]
name = "nylon"
length = "10 ft"
spring_constant = "20 kN"
[[assembly.parts]]
length = "1 m"
[[assembly.working]]
total_length = "20 m"
tension_amplitude = "50 lbf"
""",
    )
    assert case.name == "mooring" and case.n_tethers == 2
    assert case.free_lengths == pytest.approx((8.0, 8.128))
    assert np.isnan(case.tolerance)
    assert case.rated_break_strength == pytest.approx(800 * LBF)
    assert (case.sources, case.specimen, case.branch) == (("a.nc", "b.nc"), "new", "ascending")
    assert case.rule.precedence == ("static", "cyclic")
    assert (case.splices.length, case.splices.strain) == pytest.approx((1.2, 0.4))
    assert (case.splices.at_tension, case.splices.exponent) == pytest.approx((200 * LBF, 0.85))
    assert [part.name for part in case.parts] == ["nylon", "part 2"]
    assert case.parts[0].length_at(2e3) == pytest.approx(3.048 * 1.1)
    assert case.parts[1].length_at(2e3) == pytest.approx(1.0)
    (level,) = case.working
    assert (level.quantity, level.value) == ("total_length", 20.0)
    assert level.tension_amplitude == pytest.approx(50 * LBF)


def test_the_shortest_specification_leaves_the_rest_to_the_tests(tmp_path):
    case = load_of_assemblies(
        tmp_path, '[assembly]\nn_tethers = 3\n[assembly.curve]\nsource = "used"\n'
    )
    assert (case.n_tethers, case.free_lengths, case.splices) == (3, (), None)
    assert case.rule.precedence == ("cyclic", "static", "first-loading")
    assert case.working == () and np.isnan(case.rated_break_strength)


def test_more_tethers_than_a_bundle_has_are_refused(tmp_path):
    with pytest.raises(SettingsError, match="assembly.n_tethers.*less than or equal to 100"):
        load_of_assemblies(
            tmp_path, '[assembly]\nn_tethers = 1000\n[assembly.curve]\nsource = "used"\n'
        )


def test_tethers_that_are_alike_have_one_length_each(tmp_path):
    text = '[assembly]\nn_tethers = 3\nfree_length = "8 m"\n[assembly.curve]\nsource = "used"\n'
    assert load_of_assemblies(tmp_path, text).free_lengths == (8.0, 8.0, 8.0)
