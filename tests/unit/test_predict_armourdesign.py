"""An armour design refuses what is not an armour."""

import numpy as np
import pytest

from reduction.prediction.armour import ArmourDesign, predict_armour
from reduction.record.errors import SettingsError

GOOD = {
    "winding_angle": 0.5,
    "wire_radius": 2.5e-3,
    "core_radius": 25e-3,
    "elastic_modulus": 210e9,
}


@pytest.mark.parametrize(
    ("name", "value", "needed"),
    [
        ("winding_angle", 0.0, "between 0 and 90 deg"),
        ("winding_angle", 1.6, "between 0 and 90 deg"),
        ("winding_angle", -0.3, "between 0 and 90 deg"),
        ("winding_angle", float("nan"), "between 0 and 90 deg"),
        ("wire_radius", -2.5e-3, "above zero"),
        ("core_radius", 0.0, "above zero"),
        ("elastic_modulus", float("inf"), "above zero"),
        ("poisson_ratio", 0.5, "between -1 and 0.5"),
        ("poisson_ratio", -1.0, "between -1 and 0.5"),
        ("n_wires", 0, "a whole number"),
        ("n_wires", 2.5, "a whole number"),
    ],
)
def test_a_number_outside_its_range_is_refused(name, value, needed):
    with pytest.raises(
        SettingsError, match=f"{name} is not that of an armour; found .*; needed {needed}"
    ):
        ArmourDesign(**GOOD | {name: value})


def test_one_bad_design_of_many_is_counted():
    with pytest.raises(
        SettingsError, match="wire_radius of 1 of 3 designs is not that of an armour; found -1"
    ):
        ArmourDesign(**GOOD | {"wire_radius": np.array([1.0, -1.0, 2.0])})


def test_stiffnesses_of_a_round_wire():
    design = ArmourDesign(**GOOD, poisson_ratio=0.3)
    area = np.pi * 2.5e-3**2
    assert design.helix_radius == pytest.approx(27.5e-3)
    assert design.axial_stiffness == pytest.approx(210e9 * area)
    assert design.bending_stiffness == pytest.approx(210e9 * np.pi * 2.5e-3**4 / 4)
    shear_modulus = 210e9 / 2.6
    assert design.torsion_stiffness == pytest.approx(shear_modulus * np.pi * 2.5e-3**4 / 2)


def test_numbers_broadcast_to_designs_and_arrays_are_read_only():
    design = ArmourDesign(
        **GOOD | {"winding_angle": np.array([[0.3], [0.6]]), "core_radius": np.full(4, 25e-3)}
    )
    assert design.shape == (2, 4)
    response = predict_armour(design, [1e-3, 2e-3, 3e-3])
    assert response.axial_force.shape == response.torsion_moment.shape == (2, 4, 3)
    assert response.wire_strain.shape == (2, 4, 3)
    with pytest.raises(ValueError, match="read-only"):
        response.axial_force[0, 0, 0] = 0
