"""First yield of the wires."""

import numpy as np
import pytest

from reduction.prediction.armour import (
    ArmourDesign,
    _wire_stress,
    _yield_strain,
    layer_strength,
    predict_armour,
)
from reduction.record.errors import FitError, SettingsError

DESIGN = ArmourDesign(np.radians([20.0, 50.0, 80.0]), 2.5e-3, 25e-3, 210e9)


def test_stresses_of_one_point_add_up():
    wire = predict_armour(DESIGN, [-1e-3, 1e-3])
    normal = np.abs(wire.axial_stress) + np.abs(wire.bending_stress)
    assert _wire_stress(wire) == pytest.approx(np.sqrt(normal**2 + 3 * wire.torsion_stress**2))


def test_bending_and_torsion_bring_yield_forward():
    """Of the axial stress alone it is at (1 + eps)^2 = ((1 + zeta)^2 - sin^2) / cos^2."""
    sine, cosine = np.sin(DESIGN.winding_angle), np.cos(DESIGN.winding_angle)
    axial = np.sqrt((1 + 800 / 210e3) ** 2 - sine**2) / cosine - 1
    strain = _yield_strain(DESIGN, 800e6)
    assert np.all(strain < axial) and np.all(strain > 0.5 * axial)


def test_yield_stresses_broadcast_with_designs():
    limit = np.array([[400e6], [800e6]])
    strain = _yield_strain(DESIGN, limit)
    assert strain.shape == (2, 3)
    assert strain[1, 2] == pytest.approx(
        float(_yield_strain(ArmourDesign(np.radians(80.0), 2.5e-3, 25e-3, 210e9), 800e6)),
        rel=1e-9,
    )


def test_strength_is_the_axial_component():
    assert layer_strength(
        ArmourDesign(np.radians(60.0), 1.0, 9.0, 1.0, n_wires=4), 1 / np.pi
    ) == pytest.approx(2.0)


@pytest.mark.parametrize("stress", [0.0, -1.0, np.nan, np.inf])
def test_a_yield_stress_has_to_be_above_zero(stress):
    with pytest.raises(SettingsError, match="yield_stress is not above zero"):
        _yield_strain(DESIGN, stress)


def test_a_yield_strain_that_is_lost_in_rounding_is_not_found():
    with pytest.raises(FitError, match="the strain at which the wires yield is not found"):
        _yield_strain(DESIGN, 1.0)
