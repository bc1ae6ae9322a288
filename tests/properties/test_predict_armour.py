"""Laws of wires on a rigid core, over random designs."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from wire_energy import wire_energy

from reduction.prediction.armour import (
    ARMOUR_THEORIES,
    ArmourDesign,
    _layer_stiffness,
    _wire_stress,
    _yield_strain,
    predict_armour,
)

designs = st.builds(
    ArmourDesign,
    winding_angle=st.floats(0.05, 1.52),
    wire_radius=st.floats(0.5e-3, 5e-3),
    core_radius=st.floats(6e-3, 0.3),
    elastic_modulus=st.floats(1e9, 2.1e11),
    poisson_ratio=st.floats(-0.5, 0.49),
    n_wires=st.integers(1, 60),
)
strains = st.floats(1e-5, 0.3)


@given(designs, strains)
def test_tension_is_the_derivative_of_the_energy(design, strain):
    step = 1e-4 * strain
    around = strain + step * np.array([-2.0, -1.0, 0.0, 1.0, 2.0])
    wire = predict_armour(design, around, theory="conjugate")
    energy = wire_energy(design, wire)
    slope = (energy[0] - 8 * energy[1] + 8 * energy[3] - energy[4]) / (12 * step)
    assert wire.tension[2] == pytest.approx(slope, rel=1e-8)


def rod_energy(design, strain, twist, radius_ratio):
    """Of the rod whose energy is W, for a core that stretches, turns and gives."""
    angle, rest = design.winding_angle, float(design.helix_radius)
    radius = radius_ratio * rest
    around = radius_ratio * (np.sin(angle) + rest * twist * np.cos(angle))
    along = (1 + strain) * np.cos(angle)
    stretch = np.hypot(around, along)
    bending = around**2 / (stretch * radius) - stretch * np.sin(angle) ** 2 / rest
    torsion = around * along / (stretch * radius) - np.sin(angle) * np.cos(angle) / rest
    twice = (
        design.axial_stiffness * (stretch - 1) ** 2
        + design.bending_stiffness * bending**2
        + design.torsion_stiffness * torsion**2
    )
    return twice / (2 * np.cos(angle))


@given(designs, st.floats(1e-3, 0.1))
def test_torque_and_contact_load_are_derivatives_of_the_energy(design, strain):
    wire = predict_armour(design, strain, theory="conjugate")
    twist = 1e-5 / float(design.helix_radius)
    torque = (rod_energy(design, strain, twist, 1) - rod_energy(design, strain, -twist, 1)) / (
        2 * twist
    )
    size = float(design.helix_radius) * abs(wire.axial_force[0])
    assert wire.torque[0] == pytest.approx(torque, rel=1e-5, abs=1e-6 * size)
    step = 1e-6
    outwards = (
        rod_energy(design, strain, 0, 1 + step) - rod_energy(design, strain, 0, 1 - step)
    ) / (2 * step * float(design.helix_radius))
    per_length = (1 + wire.wire_strain[0]) / np.cos(design.winding_angle)
    computed = wire.contact_line_load[0] * per_length
    size = abs(wire.axial_force[0]) * np.sin(design.winding_angle) / float(design.helix_radius)
    assert computed == pytest.approx(outwards, rel=1e-4, abs=1e-4 * size)


@given(designs, st.sampled_from(ARMOUR_THEORIES))
def test_forces_of_a_small_strain_are_proportional_to_it(design, theory):
    wire = predict_armour(design, [1e-7, 2e-7], theory=theory)
    for name in ("axial_force", "shear_force", "bending_moment", "tension"):
        one, two = getattr(wire, name)
        assert two == pytest.approx(2 * one, rel=2e-4)


@given(designs)
def test_exact_and_intermediate_meet_at_small_strain(design):
    exact, linear = (predict_armour(design, 1e-8, theory=one) for one in ("exact", "intermediate"))
    for name in ("axial_force", "shear_force", "bending_moment", "tension"):
        assert getattr(exact, name) == pytest.approx(getattr(linear, name), rel=1e-6)


@given(designs)
def test_stiffness_is_that_of_the_conjugate_rod(design):
    layer = _layer_stiffness(design)
    wire = predict_armour(design, 1e-8, theory="conjugate")
    assert design.n_wires * wire.tension[0] == pytest.approx(
        1e-8 * layer.tension_per_strain, rel=1e-6
    )
    assert design.n_wires * wire.torque[0] == pytest.approx(
        1e-8 * layer.torque_per_strain, rel=1e-6, abs=1e-14 * float(layer.torque_per_twist)
    )
    assert 0 <= layer.free_tension_per_strain <= layer.tension_per_strain


@given(designs, st.floats(1e-4, 5e-3))
def test_stress_at_the_yield_strain_is_the_yield_stress(design, share):
    limit = share * design.elastic_modulus
    strain = _yield_strain(design, limit)
    wire = predict_armour(design, strain, theory="conjugate")
    assert _wire_stress(wire)[0] == pytest.approx(limit, rel=1e-9)
