"""Stiffness of a layer against strain and twist."""

import numpy as np
import pytest

from reduction.prediction.armour import ArmourDesign, _layer_stiffness


def test_all_but_straight_wires_are_rods():
    """E A, nothing between, and G J: n = 3, E A = 1, E I = 1/4, nu = 0.25."""
    layer = _layer_stiffness(ArmourDesign(1e-8, 1.0, 9.0, 1 / np.pi, 0.25, n_wires=3))
    assert layer.tension_per_strain == pytest.approx(3.0)
    assert layer.torque_per_strain == pytest.approx(0.0, abs=1e-6)
    assert layer.torque_per_twist == pytest.approx(3 / 5)
    assert layer.free_tension_per_strain == pytest.approx(3.0)


def test_wires_that_cannot_bend_or_twist_give_a_cable_that_turns_freely_nothing():
    thin = ArmourDesign(np.radians([20.0, 45.0, 70.0]), 1e-6, 1.0, 1e12 / np.pi)
    layer = _layer_stiffness(thin)
    sine, cosine = np.sin(thin.winding_angle), np.cos(thin.winding_angle)
    assert layer.tension_per_strain == pytest.approx(cosine**3)
    assert layer.torque_per_strain == pytest.approx(sine * cosine**2, rel=3e-6)
    assert layer.torque_per_twist == pytest.approx(sine**2 * cosine, rel=3e-6)
    assert layer.free_tension_per_strain == pytest.approx(0.0, abs=1e-9)
