"""Layers of armour on each other."""

import numpy as np
import pytest

from reduction.prediction.armour import (
    ArmourDesign,
    ArmourLayers,
    _cable_stiffness,
    _cable_strength,
    _layer_stiffness,
    _predict_layers,
    predict_armour,
)
from reduction.record.errors import SettingsError

STEEL = 800e6


def cable(degrees=(24.0, 20.0), core=(25e-3, 30e-3), n_wires=(30, 36), lay=("right", "left")):
    design = ArmourDesign(
        np.radians(degrees), 2.5e-3, np.array(core), 210e9, n_wires=np.array(n_wires)
    )
    return ArmourLayers(design, lay, np.full(len(lay), STEEL))


def test_layers_add_up():
    layers = cable()
    whole = _predict_layers(layers, [1e-3, 2e-3])
    wire = predict_armour(layers.design, [1e-3, 2e-3], theory="conjugate")
    assert whole.tension == pytest.approx(30 * wire.tension[0] + 36 * wire.tension[1])
    assert whole.torque == pytest.approx(30 * wire.torque[0] - 36 * wire.torque[1])
    assert whole.layer_tension.shape == (2, 2)
    small = _predict_layers(layers, 1e-9)
    held, free = _cable_stiffness(layers)
    assert small.tension[0] / 1e-9 == pytest.approx(held, rel=1e-6)
    assert free < held


def test_two_hands_of_one_layer_balance_and_one_hand_does_not():
    layers = cable((20.0, 20.0 * 25 / 30), n_wires=(10, 10))
    assert 0 < _predict_layers(layers, 1e-3).torque_imbalance[0] < 1
    alone = ArmourLayers(
        ArmourDesign(np.radians([20.0]), 2.5e-3, 25e-3, 210e9), ("left",), np.array([STEEL])
    )
    assert _predict_layers(alone, [0.0, 1e-3]).torque_imbalance == pytest.approx(
        [np.nan, 1.0], nan_ok=True
    )
    assert _predict_layers(alone, 1e-3).torque[0] < 0


def test_balanced_layers_lose_nothing_when_free_to_turn():
    """Torque per strain of the outer layer made that of the inner one by its number of wires."""
    inner, outer = (
        _layer_stiffness(ArmourDesign(np.radians(20.0), 2.5e-3, core, 210e9))
        for core in (25e-3, 30e-3)
    )
    ratio = float(inner.torque_per_strain / outer.torque_per_strain)
    held, free = _cable_stiffness(cable((20.0, 20.0), n_wires=(32, 27)))
    assert ratio == pytest.approx(27 / 32, rel=0.01)
    assert free == pytest.approx(held, rel=1e-5)


def test_outer_layers_squeeze_the_core_too():
    whole = _predict_layers(cable(), 1e-3)
    assert whole.core_pressure[1] == pytest.approx(whole.layer_pressure[1])
    carried = whole.layer_pressure[1] * 30 / 25  # same force, smaller surface
    assert whole.core_pressure[0] == pytest.approx(whole.layer_pressure[0] + carried)


def test_pressure_of_thin_wires_is_that_of_a_membrane():
    """n T sin^2 / r over the spacing 2 pi r cos."""
    design = ArmourDesign(np.radians([40.0]), 1e-6, 1.0, 210e9, n_wires=100)
    layers = ArmourLayers(design, ("right",), np.array([STEEL]))
    whole = _predict_layers(layers, 1e-4)
    now = whole.wire.current_winding_angle[0, 0]
    expected = 100 * whole.wire.axial_force[0, 0] * np.sin(now) ** 2 / (2 * np.pi * np.cos(now))
    assert whole.layer_pressure[0, 0] == pytest.approx(expected, rel=1e-5)


def test_yielding_is_flagged_and_an_unknown_yield_stress_is_not():
    layers = cable()
    strength = _cable_strength(layers)
    at = strength.strain * np.array([0.999, 1.001])
    flags = _predict_layers(layers, at).is_yielding
    assert flags[strength.governing_layer].tolist() == [False, True]
    bare = ArmourLayers(layers.design, layers.lay, np.array([np.nan, STEEL]))
    assert not _predict_layers(bare, 0.5).is_yielding[0].any()
    with pytest.raises(SettingsError, match="layer 1 has no yield stress"):
        _cable_strength(bare)


def test_the_less_steep_layer_governs_and_the_cable_is_weaker_than_its_sum():
    strength = _cable_strength(cable((35.0, 20.0), n_wires=(26, 36)))
    assert strength.governing_layer == 1
    assert strength.strain == strength.layer_yield_strain[1] < strength.layer_yield_strain[0]
    assert strength.tension < strength.layer_strength.sum()


@pytest.mark.parametrize(
    ("numbers", "message"),
    [
        ({"core": (25e-3, 29e-3)}, "layer 2 lies inside layer 1; found core_radius 0.029 m"),
        ({"n_wires": (31, 41)}, "the wires of layer 2 do not fit on its core; found 41 wires"),
        ({"lay": ("right", "up")}, "the hand of a layer is not known; found 'up'"),
        ({"lay": ("right", "left", "left")}, "the armour does not pair up with the layers"),
    ],
)
def test_layers_that_cannot_be_are_refused(numbers, message):
    with pytest.raises(SettingsError, match=message):
        cable(**numbers)


def test_yield_stresses_are_one_a_layer_and_above_zero():
    design = cable().design
    with pytest.raises(SettingsError, match="yield_stress does not pair up"):
        ArmourLayers(design, ("right", "left"), np.array([STEEL]))
    with pytest.raises(SettingsError, match="yield_stress of layer 2 is not above zero"):
        ArmourLayers(design, ("right", "left"), np.array([STEEL, -1.0]))
