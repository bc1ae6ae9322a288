import numpy as np
import pytest
from predicted_cases import ARMOUR, LEAST_ARMOUR, changed

from reduction.campaign.armour_spec import load_armour_case
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
