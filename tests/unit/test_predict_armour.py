"""Armour: theories of one wire against equations written out by hand, layers on each other, yield."""

import numpy as np
import pytest
from refusals import refusals

from reduction.prediction.armour import (
    ARMOUR_QUANTITIES,
    ARMOUR_THEORIES,
    ArmourDesign,
    ArmourLayers,
    _angles_of_use,
    _cable_stiffness,
    _cable_strength,
    _layer_stiffness,
    _predict_conjugate,
    _predict_exact,
    _predict_intermediate,
    _predict_large,
    _predict_layers,
    _predict_small,
    _thinning_loss,
    _wire_gap,
    _wire_stress,
    _yield_strain,
    layer_strength,
    predict_armour,
    theory_errors,
)
from reduction.record.errors import DataError, FitError, SettingsError

DESIGN = ArmourDesign(np.radians(35.0), 2.5e-3, 25e-3, 210e9)


@pytest.mark.parametrize("strain", [-1.0, np.nan, np.inf])
def test_strain_below_minus_one_or_not_finite_is_refused(strain):
    with pytest.raises(SettingsError, match="1 of 2 strains are none of a cable, first at index 1"):
        predict_armour(DESIGN, [0.0, strain])


@pytest.mark.parametrize("theory", ARMOUR_THEORIES)
def test_nothing_is_loaded_without_strain(theory):
    wire = predict_armour(DESIGN, 0.0, theory=theory)
    for name in ("axial_force", "shear_force", "bending_moment", "torsion_moment", "tension"):
        assert abs(getattr(wire, name)[0]) < 1e-6
    assert not wire.is_lifted[0]


def test_strains_of_the_caller_stay_writeable():
    strain = np.array([1e-3, 2e-3])
    predict_armour(DESIGN, strain)
    strain[0] = 0.0


@pytest.mark.parametrize("theory", ["small", "intermediate", "exact", "conjugate"])
def test_compression_lifts_the_wires_off(theory):
    wire = predict_armour(DESIGN, [-1e-3, 1e-3], theory=theory)
    assert wire.is_lifted.tolist() == [True, False]
    assert wire.contact_line_load[1] > 0


# theories of small, intermediate and large angles against equations written out by hand

STRAIN = np.array([1e-3])


def unit(degrees, poisson_ratio=0.0):
    """Wire of unit stiffness E A, radius of the helix 10 times that of the wire."""
    return ArmourDesign(np.radians(degrees), 1.0, 9.0, 1 / np.pi, poisson_ratio)


def test_intermediate_angles_at_30_degrees():
    """sin = 1/2, cos^2 = 3/4, E I = 1/4, r = 10."""
    wire = _predict_intermediate(unit(30.0), STRAIN)
    root = np.sqrt(3.0)
    assert wire.wire_strain == pytest.approx(0.75e-3)
    assert wire.angle_change == pytest.approx(-root / 4 * 1e-3)
    assert wire.curvature_change == pytest.approx(-2 * 3 / 16 * 1e-4)
    assert wire.torsion_change == pytest.approx(root / 4 * (1 / 4 - 3 / 4) * 1e-4)
    assert wire.bending_moment == pytest.approx(-3 / 32 * 1e-4)
    assert wire.torsion_moment == pytest.approx(-root / 32 * 1e-4)
    # N' = E I eps s^3 c / r^2 without Poisson's ratio
    assert wire.shear_force == pytest.approx(0.25 * root / 16 * 1e-5)


def test_small_angles_differ_from_intermediate_by_the_second_order():
    for strain in (1e-3, 1e-4):
        small, linear = (
            one(unit(20.0), np.array([strain])) for one in (_predict_small, _predict_intermediate)
        )
        assert small.angle_change / linear.angle_change - 1 == pytest.approx(0.0, abs=strain)
        assert small.angle_change / linear.angle_change - 1 != pytest.approx(0.0, abs=strain / 10)


def test_small_angles_have_no_answer_where_the_cosine_passes_one():
    wire = _predict_small(unit(5.0), np.array([1e-3, 0.9]))
    assert np.isnan(wire.angle_change).tolist() == [False, True]
    assert np.isnan(wire.bending_moment).tolist() == [False, True]
    assert np.isfinite(wire.axial_force).all()


def test_spring_is_that_of_a_close_coil():
    """f = G J eps / (r^2 tan): G J = 1/4, r = 10, tan 45 = 1."""
    spring = _predict_large(unit(45.0), STRAIN)
    assert spring.tension == pytest.approx(0.25e-5)
    assert spring.torsion_moment == pytest.approx(0.25e-4 / np.sqrt(2))
    assert spring.bending_moment == pytest.approx(-0.25e-4 / np.sqrt(2))
    assert np.isnan(spring.current_winding_angle).all()
    assert not spring.is_lifted.any()


def test_spring_and_conjugate_rod_have_one_torsion_towards_90_degrees():
    spring = _predict_large(unit(89.0, 0.3), STRAIN)
    rod = _predict_intermediate(unit(89.0, 0.3), STRAIN)
    assert spring.torsion_moment == pytest.approx(rod.torsion_moment, rel=2e-3)


# an armour design refuses what is not an armour

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


# errors of the theories and the angles at which they hold

DEGREES = np.arange(5.0, 86.0)
DESIGN_OF_ERRORS = ArmourDesign(np.radians(DEGREES), 2.5e-3, 25e-3, 210e9)


def test_errors_are_relative_to_the_reference():
    errors = theory_errors(DESIGN_OF_ERRORS, [1e-3, 2e-3])
    assert errors.shape == (3, 4, 81, 2)
    exact = predict_armour(DESIGN_OF_ERRORS, [1e-3, 2e-3])
    linear = predict_armour(DESIGN_OF_ERRORS, [1e-3, 2e-3], theory="intermediate")
    expected = linear.shear_force / exact.shear_force - 1
    place = ARMOUR_QUANTITIES.index("shear_force")
    assert errors[1, place] == pytest.approx(expected, abs=1e-14)


def test_error_of_the_torsion_moment_has_no_pole_at_45_degrees():
    errors = theory_errors(DESIGN_OF_ERRORS, 1e-3)
    assert np.max(np.abs(errors[1, 3])) < 1.1e-3
    exact = predict_armour(DESIGN_OF_ERRORS, 1e-3).torsion_moment
    assert np.min(np.abs(exact[DEGREES == 45.0])) < 2e-3 * np.max(np.abs(exact))


def test_errors_of_the_first_order_theories_grow_with_the_strain():
    error = theory_errors(DESIGN_OF_ERRORS, [1e-4, 1e-3])[:2, 0, 1:]
    assert error[..., 1] / error[..., 0] == pytest.approx(10.0, rel=0.01)


def test_without_strain_there_is_no_error():
    assert np.isnan(theory_errors(DESIGN_OF_ERRORS, 0.0)).all()


def test_moments_of_the_report_leave_out_torsion_that_a_rod_with_energy_has():
    """Linear: H over GJ is s^3 c, not s c (s^2 - c^2); 77 deg is where they part by 5 %."""
    found = theory_errors(DESIGN_OF_ERRORS, 1e-6, reference="conjugate")[1, :, :, 0]
    is_within = np.abs(found[ARMOUR_QUANTITIES.index("torsion_moment")]) <= 0.05
    sine, cosine = np.sin(np.radians(DEGREES)), np.cos(np.radians(DEGREES))
    error = sine * cosine**3 / np.hypot(2 * (sine * cosine) ** 2, sine**3 * cosine)
    assert is_within.tolist() == (error <= 0.05).tolist()
    assert 77 in DEGREES[is_within] and 76 not in DEGREES[is_within]


def test_statement_gives_every_run_of_angles():
    use = _angles_of_use(DESIGN_OF_ERRORS, 1e-3, tolerance=0.02)
    assert len(use.statement) == 12
    assert use.statement[4] == "intermediate angles: axial_force within 2 % of exact at 5-85 deg"
    assert use.statement[8] == "large angles: axial_force within 2 % of exact nowhere"
    assert use.statement[9] == "large angles: shear_force within 2 % of exact at 82-85 deg"
    assert use.statement[10] == "large angles: bending_moment within 2 % of exact at 47 deg"
    assert np.degrees(use.least_angle[2]) == pytest.approx([np.nan, 82, 47, 85], nan_ok=True)
    assert np.degrees(use.greatest_angle[2]) == pytest.approx([np.nan, 85, 47, 85], nan_ok=True)


def test_thinning_is_the_first_order_of_a_helix_that_sinks():
    """(1 + zeta)^2 = (1 + eps)^2 cos^2 + (1 - nu zeta R2 / r)^2 sin^2, solved for small eps."""
    loss, strain = _thinning_loss(DESIGN_OF_ERRORS), 1e-7
    sine2, cosine2 = np.sin(np.radians(DEGREES)) ** 2, np.cos(np.radians(DEGREES)) ** 2
    wire_strain = (1 - loss) * strain * cosine2
    left = 2 * wire_strain
    right = 2 * strain * cosine2 - 2 * 0.3 / 11 * wire_strain * sine2
    assert left == pytest.approx(right, rel=1e-12)


def test_bad_settings_are_refused():
    with pytest.raises(SettingsError, match="no theory is held against this; found 'small'"):
        theory_errors(DESIGN_OF_ERRORS, 1e-3, reference="small")
    with pytest.raises(SettingsError, match="tolerance is not above zero"):
        _angles_of_use(DESIGN_OF_ERRORS, 1e-3, tolerance=0.0)
    falling = ArmourDesign(np.radians([50.0, 20.0]), 2.5e-3, 25e-3, 210e9)
    with pytest.raises(DataError, match="winding_angle are not above the one before"):
        _angles_of_use(falling, 1e-3, tolerance=0.02)


# exact geometry of a wire on a rigid core, and the two laws of its moments

STRAIN_OF_EXACT = np.array([-0.3, 1e-9, 1e-3, 0.5])
DESIGN_OF_EXACT = ArmourDesign(
    np.radians([[20.0], [50.0], [80.0]]), 1.0, np.array([9.0, 19.0]), 1 / np.pi
)
ANGLE = np.radians([20.0, 50.0, 80.0])[:, None, None]
RADIUS = np.array([10.0, 20.0])[None, :, None]


def test_helix_follows_a_core_that_neither_gives_nor_turns():
    wire = _predict_exact(DESIGN_OF_EXACT, STRAIN_OF_EXACT)
    now = wire.current_winding_angle
    along = (1 + wire.wire_strain) * np.cos(now) / np.cos(ANGLE)
    around = (1 + wire.wire_strain) * np.sin(now) / np.sin(ANGLE)
    assert along == pytest.approx(np.broadcast_to(1 + STRAIN_OF_EXACT, along.shape), rel=1e-12)
    assert around == pytest.approx(np.ones(around.shape), rel=1e-12)


def test_changes_are_differences_of_curvature_and_torsion():
    wire = _predict_exact(DESIGN_OF_EXACT, STRAIN_OF_EXACT[[0, 3]])
    now = wire.current_winding_angle
    curvature = (np.sin(now) ** 2 - np.sin(ANGLE) ** 2) / RADIUS
    torsion = (np.sin(2 * now) - np.sin(2 * ANGLE)) / (2 * RADIUS)
    assert wire.curvature_change == pytest.approx(curvature)
    assert wire.torsion_change == pytest.approx(torsion)


def test_conjugate_changes_are_counted_over_the_rest_length():
    wire = _predict_conjugate(DESIGN_OF_EXACT, STRAIN_OF_EXACT[[0, 3]])
    now, stretch = wire.current_winding_angle, 1 + wire.wire_strain
    curvature = stretch * (np.sin(now) ** 2 - np.sin(ANGLE) ** 2) / RADIUS
    torsion = (stretch * np.sin(2 * now) - np.sin(2 * ANGLE)) / (2 * RADIUS)
    assert wire.curvature_change == pytest.approx(curvature)
    assert wire.torsion_change == pytest.approx(torsion)


def test_a_strain_of_1e_9_loses_no_digits():
    wire = _predict_exact(DESIGN_OF_EXACT, STRAIN_OF_EXACT[[1]])
    sine, cosine = np.sin(ANGLE), np.cos(ANGLE)
    assert wire.wire_strain == pytest.approx(1e-9 * cosine**2 + 0 * RADIUS, rel=1e-8)
    assert wire.curvature_change == pytest.approx(-2e-9 * (sine * cosine) ** 2 / RADIUS, rel=1e-7)


@pytest.mark.parametrize("predict", [_predict_exact, _predict_conjugate])
def test_forces_are_in_balance(predict):
    """Equation 6: the first and the fourth line."""
    wire = predict(DESIGN_OF_EXACT, STRAIN_OF_EXACT)
    now = wire.current_winding_angle
    curvature, torsion = np.sin(now) ** 2 / RADIUS, np.sin(now) * np.cos(now) / RADIUS
    moments = wire.torsion_moment * curvature - wire.bending_moment * torsion
    assert wire.shear_force == pytest.approx(moments)
    radial = wire.axial_force * curvature - wire.shear_force * torsion
    assert wire.contact_line_load == pytest.approx(radial)


def test_conjugate_axial_force_has_the_eccentricity_of_a_curved_bar():
    wire = _predict_conjugate(DESIGN_OF_EXACT, STRAIN_OF_EXACT)
    rest = np.sin(ANGLE) ** 2 / RADIUS
    assert wire.axial_force == pytest.approx(wire.wire_strain - rest * wire.bending_moment)


# layers of armour on each other

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


# room of the wires beside each other


def layer(degrees, n_wires, wire_radius=1.0, core_radius=9.0):
    return ArmourDesign(np.radians(degrees), wire_radius, core_radius, 1.0, n_wires=n_wires)


def distance(degrees, n_wires, radius):
    """Least distance of two neighbouring centre lines, by looking at very many places."""
    place = np.linspace(0, min(2 * np.pi / n_wires, np.pi), 2_000_001)
    cotangent = 1 / np.tan(np.radians(degrees))
    square = 2 * (1 - np.cos(place)) + (cotangent * (2 * np.pi / n_wires - place)) ** 2
    return radius * np.sqrt(np.min(square))


@pytest.mark.parametrize("degrees", [1.0, 20.0, 45.0, 80.0, 89.5])
@pytest.mark.parametrize("n_wires", [1, 2, 3, 12, 60])
def test_gap_is_that_of_the_nearest_points(degrees, n_wires):
    expected = distance(degrees, n_wires, 10.0) - 2.0
    assert _wire_gap(layer(degrees, n_wires)) == pytest.approx(expected, abs=1e-6)


def test_gap_of_straight_wires_is_a_chord():
    gap = _wire_gap(layer(1e-6, np.array([3, 10, 31, 32])))
    chord = 20 * np.sin(np.pi / np.array([3, 10, 31, 32])) - 2
    assert gap == pytest.approx(chord, abs=1e-9)
    assert (gap > 0).tolist() == [True, True, True, False]


def test_a_full_circumference_does_not_fit_since_the_cylinder_is_round():
    full = layer(np.degrees(np.arccos(12 / (10 * np.pi))), 12)
    assert _wire_gap(full) < 0


# stiffness of a layer against strain and twist


def test_all_but_straight_wires_are_rods():
    """E A, nothing between, and G J: n = 3, E A = 1, E I = 1/4, nu = 0.25."""
    layer = _layer_stiffness(ArmourDesign(1e-8, 1.0, 9.0, 1 / np.pi, 0.25, n_wires=3))
    assert layer.tension_per_strain == pytest.approx(3.0)
    assert layer.torque_per_strain == pytest.approx(0.0, abs=1e-6)
    assert layer.torque_per_twist == pytest.approx(3 / 5)


def test_wires_that_cannot_bend_or_twist_give_a_cable_that_turns_freely_nothing():
    thin = ArmourDesign(np.radians([20.0, 45.0, 70.0]), 1e-6, 1.0, 1e12 / np.pi)
    layer = _layer_stiffness(thin)
    sine, cosine = np.sin(thin.winding_angle), np.cos(thin.winding_angle)
    assert layer.tension_per_strain == pytest.approx(cosine**3)
    assert layer.torque_per_strain == pytest.approx(sine * cosine**2, rel=3e-6)
    assert layer.torque_per_twist == pytest.approx(sine**2 * cosine, rel=3e-6)
    lost = layer.torque_per_strain**2 / layer.torque_per_twist
    assert lost == pytest.approx(layer.tension_per_strain, abs=1e-9)


# first yield of the wires

DESIGN_OF_YIELD = ArmourDesign(np.radians([20.0, 50.0, 80.0]), 2.5e-3, 25e-3, 210e9)


def test_stresses_of_one_point_add_up():
    wire = predict_armour(DESIGN_OF_YIELD, [-1e-3, 1e-3])
    normal = np.abs(wire.axial_stress) + np.abs(wire.bending_stress)
    assert _wire_stress(wire) == pytest.approx(np.sqrt(normal**2 + 3 * wire.torsion_stress**2))


def test_bending_and_torsion_bring_yield_forward():
    """Of the axial stress alone it is at (1 + eps)^2 = ((1 + zeta)^2 - sin^2) / cos^2."""
    sine, cosine = np.sin(DESIGN_OF_YIELD.winding_angle), np.cos(DESIGN_OF_YIELD.winding_angle)
    axial = np.sqrt((1 + 800 / 210e3) ** 2 - sine**2) / cosine - 1
    strain = _yield_strain(DESIGN_OF_YIELD, 800e6)
    assert np.all(strain < axial) and np.all(strain > 0.5 * axial)


def test_yield_stresses_broadcast_with_designs():
    limit = np.array([[400e6], [800e6]])
    strain = _yield_strain(DESIGN_OF_YIELD, limit)
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
        _yield_strain(DESIGN_OF_YIELD, stress)


REFUSED = {
    "an unknown theory is refused": (
        lambda: predict_armour(DESIGN, 1e-3, theory="knapp"),
        SettingsError,
        "theory of the armour is not known; found 'knapp'",
    ),
    "one bad design of many is counted": (
        lambda: ArmourDesign(**GOOD | {"wire_radius": np.array([1.0, -1.0, 2.0])}),
        SettingsError,
        "wire_radius of 1 of 3 designs is not that of an armour; found -1",
    ),
    "a yield strain that is lost in rounding is not found": (
        lambda: _yield_strain(DESIGN_OF_YIELD, 1.0),
        FitError,
        "the strain at which the wires yield is not found",
    ),
}


test_refusals = refusals(REFUSED)
