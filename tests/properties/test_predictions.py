"""Laws of predicted hoses, armour and waves."""

from dataclasses import replace

import numpy as np
import pytest
from examples import examples
from hypothesis import assume, given, settings
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
from reduction.prediction.cord_curve import CordCurve, cord_load, cord_strain_at
from reduction.prediction.hose_geometry import (
    cord_stretch_ratio,
    hose_stretch_ratio,
    pick_up_stretch_ratio,
    wrap_angle_for,
)
from reduction.prediction.hose_product import HoseDesign
from reduction.prediction.hose_tension import find_events, hose_energy, predict_hose
from reduction.prediction.wave_load import (
    ImmersedSection,
    _find_extremes,
    _immersion_depth_of,
    wave_load,
)
from reduction.prediction.wave_theory import (
    STANDARD_GRAVITY,
    _group_velocity,
    _wave_number,
    airy_wave,
    breaking_height,
    describe_wave,
    particle_motion,
    stokes_wave,
    wave_period_of,
)
from reduction.record.errors import DataError

LAWS = st.sampled_from(["neo-hookean", "linear", "linear-current", "hencky"])
SEEDS = st.integers(0, 2**32 - 1)


def drawn_curve(rng):
    """Cords that soften, stiffen and have a toe: steps of strain and load a factor of 5 apart."""
    n_steps = int(rng.integers(1, 8))
    strain = np.cumsum(rng.uniform(0.2, 1, n_steps))
    load = np.cumsum(rng.uniform(0.2, 1, n_steps))
    return CordCurve(
        strain=np.concatenate([[0.0], strain / strain[-1] * rng.uniform(0.05, 0.3)]),
        load=np.concatenate([[0.0], load / load[-1] * rng.uniform(50, 500)]),
    )


def drawn_design(rng, law="neo-hookean", *, degrees=(20, 78), equal=False):
    bore = rng.uniform(0.02, 0.1)
    first = bore * rng.uniform(1.05, 1.5)
    second = first if equal else first * rng.uniform(1, 1.3)
    return HoseDesign(
        wrap_angle=np.radians(rng.uniform(*degrees)),
        layer_diameter=(first, second),
        inner_diameter=bore,
        outer_diameter=second * rng.uniform(1.05, 1.6),
        cords_per_length=rng.uniform(500, 2000),
        cord_diameter=rng.uniform(2e-4, 1e-3),
        rubber_modulus=10 ** rng.uniform(5, 7),
        cord=drawn_curve(rng),
        rubber_law=law,
        cord_load_scale=rng.uniform(0.5, 2),
        cord_strain_scale=rng.uniform(0.7, 1.4),
        dead_length_share=rng.uniform(0, 0.3),
    )


@settings(max_examples=examples(150), deadline=None)
@given(seed=SEEDS, law=LAWS)
def test_tension_is_the_derivative_of_the_energy(seed, law):
    rng = np.random.default_rng(seed)
    design = drawn_design(rng, law)
    share, step = design.dead_length_share, 2e-5
    break_at = float(find_events(design).cord_break.strain)
    strain = np.sort(rng.uniform(0.02, 0.98, 50)) * break_at
    # six points are exact for a polynomial of the sixth degree; the energy is smooth but at the
    # pick-up and at the points of the curve, and none of those may be inside
    offset = step * np.array([-3, -2, -1, 1, 2, 3])
    stretch = 1 + strain / (1 - share) + offset[:, None]
    on_curve = cord_stretch_ratio(stretch, design.wrap_angle) - 1
    knots = design.cord.strain * design.cord_strain_scale
    is_smooth = np.all(np.diff(np.searchsorted(knots, on_curve), axis=0) == 0, axis=0)
    energy = hose_energy(design, stretch.ravel()).reshape(stretch.shape)
    slope = (np.array([-1, 9, -45, 45, -9, 1]) / (60 * step)) @ energy
    tension = predict_hose(design, strain).tension
    np.testing.assert_allclose(tension[is_smooth], slope[is_smooth], rtol=1e-8)


@settings(max_examples=examples(60), deadline=None)
@given(seed=SEEDS)
def test_the_pressure_is_that_of_the_membrane(seed):
    # cords as a membrane of N threads at the current angle on the current diameter
    rng = np.random.default_rng(seed)
    design = drawn_design(rng, equal=True)
    strain = np.linspace(0.01, 0.999, 40) * float(find_events(design).cord_break.strain)
    found = predict_hose(design, strain)
    diameter = design.layer_diameter[0] / np.sqrt(1 + found.free_strain)
    angle = found.current_wrap_angle
    number = 2 * np.pi * design.layer_diameter[0] * np.cos(design.wrap_angle)
    number *= design.cords_per_length
    membrane = 2 * number * found.cord_tension * np.sin(angle) * np.tan(angle)
    np.testing.assert_allclose(found.fill_pressure, membrane / (np.pi * diameter**2), rtol=1e-12)
    # and the cords along the axis, less the pressure on the area inside them
    axial = number * found.cord_tension * np.cos(angle)
    np.testing.assert_allclose(
        found.tension * found.cord_share,
        axial - found.fill_pressure * np.pi * diameter**2 / 4,
        rtol=1e-9,
        atol=1e-9 * float(np.max(found.tension)),
    )


@settings(max_examples=examples(60), deadline=None)
@given(seed=SEEDS)
def test_two_layers_bear_as_one_at_their_mean_diameter(seed):
    rng = np.random.default_rng(seed)
    design = drawn_design(rng)
    middle = float(design.wrap_diameter)
    strain = np.linspace(0, 0.999, 40) * float(find_events(design).cord_break.strain)
    one = predict_hose(replace(design, layer_diameter=(middle, middle)), strain)
    two = predict_hose(design, strain)
    np.testing.assert_allclose(two.tension, one.tension, rtol=1e-12, atol=1e-9)
    np.testing.assert_allclose(two.end_cap_load, one.end_cap_load, rtol=1e-12)
    # the mean of the inverse diameters is above the inverse of their mean
    assert np.all(two.fill_pressure >= one.fill_pressure * (1 - 1e-14))


@settings(max_examples=examples(60), deadline=None)
@given(seed=SEEDS, length=st.floats(1e-3, 1e3), force=st.floats(1e-3, 1e3))
def test_units_of_length_and_force_do_not_matter(seed, length, force):
    rng = np.random.default_rng(seed)
    design = drawn_design(rng)
    other = replace(
        design,
        layer_diameter=tuple(length * one for one in design.layer_diameter),
        inner_diameter=length * design.inner_diameter,
        outer_diameter=length * design.outer_diameter,
        cords_per_length=design.cords_per_length / length,
        cord_diameter=length * design.cord_diameter,
        rubber_modulus=design.rubber_modulus * force / length**2,
        cord_load_scale=design.cord_load_scale * force,
    )
    strain = np.linspace(0, 0.99, 20) * float(find_events(design).cord_break.strain)
    one, two = predict_hose(design, strain), predict_hose(other, strain)
    np.testing.assert_allclose(two.tension, force * one.tension, rtol=1e-11)
    np.testing.assert_allclose(two.fill_pressure, force / length**2 * one.fill_pressure, rtol=1e-11)
    np.testing.assert_allclose(two.cord_share, one.cord_share, rtol=1e-11)
    np.testing.assert_allclose(two.cord_spacing, length * one.cord_spacing, rtol=1e-11)


@settings(max_examples=examples(60), deadline=None)
@given(seed=SEEDS, law=LAWS)
def test_shares_add_up_and_flags_say_where_numbers_are(seed, law):
    rng = np.random.default_rng(seed)
    design = drawn_design(rng, law)
    found = predict_hose(design, np.linspace(0, 4, 200))
    loads = [found.tension, found.fill_pressure, found.cord_tension, found.end_cap_load]
    for values in (*loads, found.cord_share, found.rubber_share):
        np.testing.assert_array_equal(np.isnan(values), found.is_broken)
    borne = ~found.is_broken
    assert np.all(found.cord_share[borne] + found.rubber_share[borne] == 1)
    assert np.all((found.cord_share[borne] >= 0) & (found.cord_share[borne] <= 1))
    np.testing.assert_array_equal(found.is_slack, found.cord_strain <= 0)
    np.testing.assert_array_equal(found.is_slack[borne], found.cord_tension[borne] == 0)
    assert not np.any(found.is_slack & found.is_broken)


@settings(max_examples=examples(150), deadline=None)
@given(
    degrees=st.floats(1, 89),
    strain=st.floats(0, 1),
    core=st.sampled_from(["isochoric", "rigid"]),
)
def test_the_closed_inverse_of_the_kinematics(degrees, strain, core):
    angle = np.radians(degrees)
    stretch = hose_stretch_ratio(1 + strain, angle, core=core)
    residual = cord_stretch_ratio(stretch, angle, core=core) / (1 + strain) - 1
    assert abs(residual) < 1e-14
    if core == "isochoric":
        assert stretch >= pick_up_stretch_ratio(angle) * (1 - 1e-12)
    if stretch > 1.001:
        back = wrap_angle_for(stretch, 1 + strain, core=core)
        if np.isfinite(back):  # at almost no angle, or almost 90 deg, rounding may leave none
            np.testing.assert_allclose(
                cord_stretch_ratio(stretch, back, core=core), 1 + strain, rtol=1e-12
            )


@settings(max_examples=examples(150), deadline=None)
@given(seed=SEEDS)
def test_the_inverse_of_a_cord_curve(seed):
    rng = np.random.default_rng(seed)
    curve = drawn_curve(rng)
    load = np.sort(curve.break_load * np.concatenate([rng.uniform(0, 1, 100), [0.0, 1.0, 1e-9]]))
    strain = cord_strain_at(curve, load)
    assert np.all(np.diff(strain) >= 0)
    np.testing.assert_allclose(cord_load(curve, strain), load, rtol=2e-14)


# laws of wires on a rigid core, over random designs

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
def test_tension_is_the_derivative_of_the_energy_in_armour(design, strain):
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
    assert layer.torque_per_strain**2 <= layer.tension_per_strain * layer.torque_per_twist


@given(designs, st.floats(1e-4, 5e-3))
def test_stress_at_the_yield_strain_is_the_yield_stress(design, share):
    limit = share * design.elastic_modulus
    strain = _yield_strain(design, limit)
    wire = predict_armour(design, strain, theory="conjugate")
    assert _wire_stress(wire)[0] == pytest.approx(limit, rel=1e-9)


# laws of waves, of floating and of Morison's load, over random cases

periods, depths = st.floats(0.3, 60.0), st.floats(0.05, 5e3)
shares = st.floats(0.02, 0.95)


@given(periods, depths, st.floats(-0.99, 30.0))
def test_a_wave_number_fits_its_period_over_any_current_that_lets_it_through(period, depth, share):
    still = float(_wave_number(period, depth))
    current = share * float(_group_velocity(still, depth))
    try:
        number = float(_wave_number(period, depth, current_velocity=current))
    except DataError:
        # half the group velocity stops a wave over deep water, all of it over shallow water
        assert share < -0.499
        return
    intrinsic = 2 * np.pi / period - number * current
    assert intrinsic > 0
    assert intrinsic**2 == pytest.approx(
        STANDARD_GRAVITY * number * np.tanh(number * depth), rel=1e-11
    )
    assert (number > still) == (current < 0) or abs(number / still - 1) < 1e-12
    assume(share > -0.4)
    back = wave_period_of(number, depth, current_velocity=current)
    assert float(back) == pytest.approx(period, rel=1e-11)


@given(st.floats(0.0, 1.0), st.floats(0.01, 10.0))
def test_the_depth_of_a_segment_gives_its_area(share, diameter):
    area = share * np.pi * diameter**2 / 4
    depth = float(_immersion_depth_of(area, diameter))
    assert 0 <= depth <= diameter
    r = diameter / 2
    half_angle = 2 * np.arctan2(np.sqrt(depth), np.sqrt(diameter - depth))
    chord = np.sqrt(depth * (diameter - depth))
    assert half_angle * r**2 - (r - depth) * chord == pytest.approx(area, abs=1e-14 * r**2)
    # the rest is the segment of the other side
    rest = float(_immersion_depth_of(np.pi * diameter**2 / 4 - area, diameter))
    assert depth + rest == pytest.approx(diameter, rel=1e-9)


@given(
    periods, depths, shares, st.floats(-0.9, 0.9), st.sampled_from([airy_wave, stokes_wave]),
    st.floats(-3.0, 3.0), st.floats(0.05, 2.0),
)  # fmt: skip
def test_no_sample_of_a_load_goes_beyond_its_extremes(
    period, depth, share, place, make, current, diameter
):
    number = float(_wave_number(period, depth))
    height = share * float(breaking_height(number, depth))
    wave = make(
        wave_height=height, wave_period=period, water_depth=depth,
        elevation=max(place * height / 2, -depth),
    )  # fmt: skip
    hose = ImmersedSection(
        np.array(diameter), np.array(0.6 * np.pi * diameter**2 / 4), np.array(0.6 * diameter)
    )
    extremes = _find_extremes(wave, hose, current_velocity=current)
    load = wave_load(wave, hose, np.linspace(0.0, period, 2001), current_velocity=current)
    for name in ("horizontal", "vertical", "horizontal_classic", "vertical_classic"):
        found, series = getattr(extremes, name), getattr(load, name)
        scale = float(found.greatest)
        assert series.max() <= float(found.maximum) + 1e-11 * scale
        assert series.min() >= float(found.minimum) - 1e-11 * scale
        assert np.ptp(series) >= float(found.maximum - found.minimum) * (1 - 1e-3)


@given(periods, depths, shares, st.sampled_from([airy_wave, stokes_wave]))
def test_a_crest_to_trough_is_the_height_and_time_turned_back_turns_the_vertical(
    period, depth, share, make
):
    number = float(_wave_number(period, depth))
    height = share * float(breaking_height(number, depth))
    wave = make(wave_height=height, wave_period=period, water_depth=depth, elevation=0.0)
    motion = particle_motion(wave, [0.0, period / 2, 0.3 * period, -0.3 * period])
    assert motion.elevation[0] - motion.elevation[1] == pytest.approx(height, rel=1e-9)
    assert motion.horizontal_velocity[2] == pytest.approx(motion.horizontal_velocity[3], rel=1e-6)
    assert motion.vertical_velocity[2] == pytest.approx(-motion.vertical_velocity[3], rel=1e-6)


@given(periods, depths, st.floats(0.01, 3.0))
def test_a_description_flags_exactly_what_a_prediction_refuses(period, depth, share):
    assume(abs(share - 1) > 1e-9)
    number = float(_wave_number(period, depth))
    height = share * float(breaking_height(number, depth))
    sea = {"wave_height": height, "wave_period": period, "water_depth": depth}
    described = describe_wave(**sea)
    assert described.is_breaking == (share > 1)
    if described.is_breaking:
        with pytest.raises(DataError, match="breaks before it is this high"):
            airy_wave(**sea, elevation=-depth)
    else:
        airy_wave(**sea, elevation=-depth)
