"""An armour from the file's numbers on, against first-order formulas written out here."""

import numpy as np
import pytest
from predicted_cases import ARMOUR, LEAST_ARMOUR, changed, predicted_armour

from reduction.prediction.armour import wound_at_all_angles
from reduction.record.errors import SettingsError

ANGLE, MODULUS, WIRE, STRAIN = np.radians(20.0), 210e9, 2.5e-3, 1e-3
HELIX = np.array([27.5e-3, 32.5e-3])
COUNT = np.array([30, 36])


@pytest.fixture
def predict(tmp_path):
    def predicted(text=ARMOUR):
        return predicted_armour(tmp_path / "cable.toml", text)

    return predicted


def test_every_theory_gives_one_wire_of_each_layer(predict):
    found = predict()
    assert [*found.responses] == ["small", "intermediate", "large", "exact", "conjugate"]
    for response in found.responses.values():
        assert response.axial_force.shape == (2, 1)


def test_the_stress_is_that_of_the_squared_cosine(predict):
    """Wang (2022), sec. 4: 185.43 MPa at 20 degrees and 0.1 %."""
    found = predict()
    stress = MODULUS * STRAIN * np.cos(ANGLE) ** 2
    assert stress == pytest.approx(185.43e6, abs=0.5e4)
    for theory in ("small", "intermediate"):
        np.testing.assert_allclose(found.responses[theory].axial_stress, stress, rtol=1e-9)
    np.testing.assert_allclose(found.responses["exact"].axial_stress, stress, rtol=1e-3)


def test_layers_carry_what_their_wires_do_along_the_axis(predict):
    """n E A strain cos3, and r sin cos2 of it as torque; bending and torsion add thousandths."""
    together = predict().together
    each = COUNT * MODULUS * np.pi * WIRE**2 * STRAIN
    along = each * np.cos(ANGLE) ** 3
    np.testing.assert_allclose(together.layer_tension[:, 0], along, rtol=2e-3)
    assert together.tension[0] == pytest.approx(along.sum(), rel=2e-3)
    torque = np.array([1, -1]) * each * HELIX * np.sin(ANGLE) * np.cos(ANGLE) ** 2
    np.testing.assert_allclose(together.layer_torque[:, 0], torque, rtol=5e-3)
    left = abs(torque.sum()) / np.abs(torque).sum()
    assert together.torque_imbalance[0] == pytest.approx(left, abs=1e-3)


def test_the_inner_core_bears_both_layers(predict):
    """A wire of tension T in a helix presses T sin2 / r on each length of itself."""
    together = predict().together
    press = MODULUS * np.pi * WIRE**2 * STRAIN * np.cos(ANGLE) ** 2 * np.sin(ANGLE) ** 2 / HELIX
    ring = COUNT * press / (2 * np.pi * np.cos(ANGLE))
    np.testing.assert_allclose(together.layer_pressure[:, 0], ring / [25e-3, 30e-3], rtol=5e-3)
    np.testing.assert_allclose(
        together.core_pressure[:, 0], [ring.sum() / 25e-3, ring[1] / 30e-3], rtol=5e-3
    )


def test_a_wire_that_thins_sinks_to_the_core_and_is_strained_less(predict):
    """It comes closer to the axis by nu R2 of its strain, which shortens the helix."""
    shorter = 0.3 * WIRE / HELIX * np.sin(ANGLE) ** 2
    np.testing.assert_allclose(predict().thinning_loss, shorter / (1 + shorter))


def test_the_wires_of_a_layer_leave_room(predict):
    assert (predict().gap > 0).all()


def test_a_cable_that_may_turn_is_softer_and_yields_before_its_axial_stress_does(predict):
    found = predict()
    held, free = found.axial_stiffness
    assert found.together.tension[0] == pytest.approx(held * STRAIN, rel=2e-3)
    assert free < held
    axial_alone = 700e6 / (MODULUS * np.cos(ANGLE) ** 2)
    assert 0.95 * axial_alone < found.strength.strain < axial_alone
    # less curved, the outer wires bend less
    assert found.layer_names[found.strength.governing_layer] == "inner"


def test_without_every_yield_stress_there_is_no_first_yield(predict):
    assert predict(changed(ARMOUR, 'yield_stress = "700 MPa"', "")).strength is None


def test_layers_that_do_not_balance_are_told(predict):
    (note,) = map(str, predict().notes)
    assert note.startswith("the layers do not balance: 17 % of their torque is left")
    alike = changed(ARMOUR, "n_wires = 36", "n_wires = 25")
    assert predict(alike).notes == ()


def test_wires_that_yield_or_leave_the_core_are_told(predict):
    doubts = warnings_of(predict(changed(ARMOUR, '"0.1 %"', '"0.5 %"')))
    assert doubts == [
        f"{name}: the wires yield; all loads beyond that are too high"
        for name in ("inner", "outer")
    ]
    pushed = warnings_of(predict(changed(ARMOUR, '"0.1 %"', '"-0.1 %"')))
    assert pushed[0] == "inner: the wires leave the core: none of these theories holds"


def warnings_of(found):
    return [str(one) for one in found.notes if one.severity == "warning"]


def test_where_each_theory_holds_is_looked_for_at_every_half_degree(predict):
    found = predict(changed(ARMOUR, "[armour]", '[armour]\ntolerance = "0.5 %"'))
    assert found.tolerance == pytest.approx(0.005)
    assert len(found.use) == 2
    np.testing.assert_allclose(np.degrees(found.use[0].winding_angle), np.arange(5, 85.5, 0.5))
    within = np.abs(found.errors) <= 0.005
    # at the layer's own angle, which is among them
    place = np.flatnonzero(np.isclose(np.degrees(found.use[0].winding_angle), 20))[0]
    np.testing.assert_array_equal(found.use[0].is_within[..., place], within[..., 0, 0])


def test_a_wire_of_a_layer_may_be_wound_at_any_angle(predict):
    design = wound_at_all_angles(predict().layers.design, 1)
    assert design.shape == (161,)
    assert (design.core_radius, design.wire_radius) == pytest.approx((30e-3, 2.5e-3))
    assert design.n_wires == 1


def test_a_single_layer_is_all_of_one_hand(predict):
    found = predict(LEAST_ARMOUR)
    assert found.together.torque_imbalance[0] == pytest.approx(1)
    assert "100 % of their torque" in str(found.notes[-1])


def test_a_strain_that_no_cable_has_is_refused(predict):
    with pytest.raises(SettingsError, match="the strain is not that of a cable.*found -1"):
        predict(changed(ARMOUR, '"0.1 %"', '"-100 %"'))
