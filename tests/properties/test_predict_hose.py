"""Laws of a hose: virtual work, the membrane, and what no number of a design may change."""

from dataclasses import replace

import numpy as np
from examples import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from reduction.prediction.cord_curve import CordCurve, cord_load, cord_strain_at
from reduction.prediction.hose_geometry import (
    cord_stretch_ratio,
    hose_stretch_ratio,
    pick_up_stretch_ratio,
    wrap_angle_for,
)
from reduction.prediction.hose_product import HoseDesign
from reduction.prediction.hose_tension import find_events, hose_energy, predict_hose

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
