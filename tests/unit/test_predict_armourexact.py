"""Exact geometry of a wire on a rigid core, and the two laws of its moments."""

import numpy as np
import pytest

from reduction.prediction.armour import ArmourDesign, _predict_conjugate, _predict_exact

STRAIN = np.array([-0.3, 1e-9, 1e-3, 0.5])
DESIGN = ArmourDesign(np.radians([[20.0], [50.0], [80.0]]), 1.0, np.array([9.0, 19.0]), 1 / np.pi)
ANGLE = np.radians([20.0, 50.0, 80.0])[:, None, None]
RADIUS = np.array([10.0, 20.0])[None, :, None]


def test_helix_follows_a_core_that_neither_gives_nor_turns():
    wire = _predict_exact(DESIGN, STRAIN)
    now = wire.current_winding_angle
    along = (1 + wire.wire_strain) * np.cos(now) / np.cos(ANGLE)
    around = (1 + wire.wire_strain) * np.sin(now) / np.sin(ANGLE)
    assert along == pytest.approx(np.broadcast_to(1 + STRAIN, along.shape), rel=1e-12)
    assert around == pytest.approx(np.ones(around.shape), rel=1e-12)


def test_changes_are_differences_of_curvature_and_torsion():
    wire = _predict_exact(DESIGN, STRAIN[[0, 3]])
    now = wire.current_winding_angle
    curvature = (np.sin(now) ** 2 - np.sin(ANGLE) ** 2) / RADIUS
    torsion = (np.sin(2 * now) - np.sin(2 * ANGLE)) / (2 * RADIUS)
    assert wire.curvature_change == pytest.approx(curvature)
    assert wire.torsion_change == pytest.approx(torsion)


def test_conjugate_changes_are_counted_over_the_rest_length():
    wire = _predict_conjugate(DESIGN, STRAIN[[0, 3]])
    now, stretch = wire.current_winding_angle, 1 + wire.wire_strain
    curvature = stretch * (np.sin(now) ** 2 - np.sin(ANGLE) ** 2) / RADIUS
    torsion = (stretch * np.sin(2 * now) - np.sin(2 * ANGLE)) / (2 * RADIUS)
    assert wire.curvature_change == pytest.approx(curvature)
    assert wire.torsion_change == pytest.approx(torsion)


def test_a_strain_of_1e_9_loses_no_digits():
    wire = _predict_exact(DESIGN, STRAIN[[1]])
    sine, cosine = np.sin(ANGLE), np.cos(ANGLE)
    assert wire.wire_strain == pytest.approx(1e-9 * cosine**2 + 0 * RADIUS, rel=1e-8)
    assert wire.curvature_change == pytest.approx(-2e-9 * (sine * cosine) ** 2 / RADIUS, rel=1e-7)


@pytest.mark.parametrize("predict", [_predict_exact, _predict_conjugate])
def test_forces_are_in_balance(predict):
    """Equation 6: the first and the fourth line."""
    wire = predict(DESIGN, STRAIN)
    now = wire.current_winding_angle
    curvature, torsion = np.sin(now) ** 2 / RADIUS, np.sin(now) * np.cos(now) / RADIUS
    moments = wire.torsion_moment * curvature - wire.bending_moment * torsion
    assert wire.shear_force == pytest.approx(moments)
    radial = wire.axial_force * curvature - wire.shear_force * torsion
    assert wire.contact_line_load == pytest.approx(radial)


def test_conjugate_axial_force_has_the_eccentricity_of_a_curved_bar():
    wire = _predict_conjugate(DESIGN, STRAIN)
    rest = np.sin(ANGLE) ** 2 / RADIUS
    assert wire.axial_force == pytest.approx(wire.wire_strain - rest * wire.bending_moment)
