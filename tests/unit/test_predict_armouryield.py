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
    assert _wire_stress(wire, criterion="axial") == pytest.approx(np.abs(wire.axial_stress))
    assert _wire_stress(wire, criterion="normal") == pytest.approx(normal)
    assert _wire_stress(wire) == pytest.approx(np.sqrt(normal**2 + 3 * wire.torsion_stress**2))


def test_axial_yield_has_a_closed_form():
    """(1 + eps)^2 = ((1 + zeta)^2 - sin^2) / cos^2."""
    strain = _yield_strain(DESIGN, 800e6, criterion="axial", theory="exact")
    sine, cosine = np.sin(DESIGN.winding_angle), np.cos(DESIGN.winding_angle)
    stretch = np.sqrt((1 + 800 / 210e3) ** 2 - sine**2) / cosine
    assert strain == pytest.approx(stretch - 1, rel=1e-9)


def test_bending_and_torsion_bring_yield_forward():
    axial, normal, all_of_it = (
        _yield_strain(DESIGN, 800e6, criterion=one) for one in ("axial", "normal", "von-mises")
    )
    assert np.all(all_of_it < normal)
    assert np.all(normal < axial)


@pytest.mark.parametrize("theory", ["exact", "conjugate"])
def test_yield_stresses_broadcast_with_designs(theory):
    limit = np.array([[400e6], [800e6]])
    strain = _yield_strain(DESIGN, limit, theory=theory)
    assert strain.shape == (2, 3)
    assert strain[1, 2] == pytest.approx(
        float(
            _yield_strain(
                ArmourDesign(np.radians(80.0), 2.5e-3, 25e-3, 210e9), 800e6, theory=theory
            )
        ),
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


def test_unknown_criterion_and_theory_are_refused():
    with pytest.raises(SettingsError, match="yield criterion is not known; found 'tresca'"):
        _yield_strain(DESIGN, 800e6, criterion="tresca")
    with pytest.raises(SettingsError, match="no yield by this theory; found 'large'"):
        _yield_strain(DESIGN, 800e6, theory="large")


def test_a_yield_strain_that_is_lost_in_rounding_is_not_found():
    with pytest.raises(FitError, match="the strain at which the wires yield is not found"):
        _yield_strain(DESIGN, 1.0)
