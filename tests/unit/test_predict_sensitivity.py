"""Derivatives of a hose prediction against differences of the prediction itself."""

import dataclasses

import numpy as np
import pytest

from reduction.prediction.cord_curve import CordCurve
from reduction.prediction.hose_geometry import hose_stretch_ratio
from reduction.prediction.hose_product import HOSE_PARAMETERS, HoseDesign
from reduction.prediction.hose_sensitivity import (
    _stretch_ratio_per_angle,
    _stretch_ratio_per_cord_stretch,
    hose_sensitivity,
)
from reduction.prediction.hose_tension import find_events, predict_hose
from reduction.record.errors import DataError, SettingsError

LAWS = ("neo-hookean", "linear", "linear-current", "hencky")
EVENTS = ("deepest_slack", "pick_up", "working", "cord_break")
CORD = CordCurve(
    np.array([0.0, 0.02, 0.06, 0.10, 0.15, 0.22]), np.array([0.0, 7.0, 22.0, 45.0, 80.0, 133.0])
)
STRAIN = np.linspace(0.013, 2.2, 61)


def hoses(law="neo-hookean", n=12):
    """Of all kinds, below and above the neutral angle."""
    rng = np.random.default_rng(7)
    bore = rng.uniform(0.03, 0.08, n)
    first = bore + rng.uniform(0.004, 0.02, n)
    second = first + rng.uniform(0.0, 0.01, n)
    return HoseDesign(
        wrap_angle=np.radians(np.linspace(35, 75, n)),
        layer_diameter=(first, second),
        inner_diameter=bore,
        outer_diameter=second + rng.uniform(0.004, 0.03, n),
        cords_per_length=rng.uniform(600, 1500, n),
        cord_diameter=0.0005,
        rubber_modulus=rng.uniform(5e5, 3e6, n),
        cord=CORD,
        rubber_law=law,
        cord_load_scale=rng.uniform(0.8, 1.2, n),
        cord_strain_scale=rng.uniform(0.8, 1.2, n),
        dead_length_share=rng.uniform(0.0, 0.2, n),
    )


def moved(design, name, step):
    if name == "layer_diameter":
        both = tuple(np.asarray(one) + step for one in design.layer_diameter)
        return dataclasses.replace(design, layer_diameter=both)
    return dataclasses.replace(design, **{name: np.asarray(getattr(design, name)) + step})


def step_of(design, name):
    value = design.wrap_diameter if name == "layer_diameter" else getattr(design, name)
    return 1e-6 * max(float(np.max(np.asarray(value))), 1e-3)


def difference(call, design, name):
    step = step_of(design, name)
    return (call(moved(design, name, step)) - call(moved(design, name, -step))) / (2 * step)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("name", HOSE_PARAMETERS)
@pytest.mark.parametrize("quantity", ["tension", "fill_pressure"])
def test_the_curve_moves_as_a_difference_of_two_predictions_says(law, name, quantity):
    design = hoses(law)
    expected = difference(lambda one: getattr(predict_hose(one, STRAIN), quantity), design, name)
    found = getattr(hose_sensitivity(design, STRAIN), quantity)[HOSE_PARAMETERS.index(name)]
    assert found.shape == (12, 61)
    # rows of a quantity that a number does not move are zero; others scale with the largest
    scale = np.nanmax(np.abs(found)) or np.nanmax(predict_hose(design, STRAIN).fill_pressure)
    apart = np.isfinite(found) & np.isfinite(expected)
    assert apart.sum() > 300
    assert np.max(np.abs(found - expected)[apart]) < 2e-8 * scale


def test_nothing_moves_where_the_cords_are_broken():
    design = hoses()
    broken = predict_hose(design, STRAIN).is_broken
    found = hose_sensitivity(design, STRAIN)
    for table in (found.tension, found.fill_pressure):
        assert np.array_equal(np.isnan(table), np.broadcast_to(broken, table.shape))


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("event", EVENTS)
@pytest.mark.parametrize("quantity", ["strain", "tension", "fill_pressure"])
def test_events_move_as_a_difference_of_two_says(law, event, quantity):
    design = hoses(law)
    table = getattr(getattr(hose_sensitivity(design, STRAIN), event), quantity)
    values = getattr(getattr(find_events(design), event), quantity)
    for name, found in zip(HOSE_PARAMETERS, table, strict=True):
        expected = difference(
            lambda one: getattr(getattr(find_events(one), event), quantity), design, name
        )
        scale = max(np.max(np.abs(values)), 1e-12) / (1e3 * step_of(design, name))
        assert np.max(np.abs(found - expected)) < 1e-7 * max(np.max(np.abs(found)), scale), name


def test_the_slope_of_the_tension_is_that_of_the_curve_and_of_the_events():
    design, step = hoses(), 1e-6
    found = hose_sensitivity(design, STRAIN).stiffness
    ahead, behind = (predict_hose(design, STRAIN + side).tension for side in (step, -step))
    apart = np.isfinite(ahead)
    assert found[apart] == pytest.approx((ahead - behind)[apart] / (2 * step), rel=2e-6)
    events = find_events(design)
    for place in range(12):
        one = dataclasses.replace(design, **{
            name: np.asarray(getattr(design, name))[place]
            for name in ("wrap_angle", "inner_diameter", "outer_diameter", "cords_per_length",
                         "rubber_modulus", "cord_load_scale", "cord_strain_scale", "dead_length_share")
        }, layer_diameter=tuple(each[place] for each in design.layer_diameter))  # fmt: skip
        at = [events.working.strain[place]]
        assert hose_sensitivity(one, at).stiffness == pytest.approx(
            hose_sensitivity(design, at).working.stiffness[place], rel=1e-9
        )


def test_what_does_not_move_the_stretch_at_the_working_load():
    found = hose_sensitivity(hoses(), STRAIN)
    for name in (
        "layer_diameter", "inner_diameter", "outer_diameter", "cords_per_length",
        "rubber_modulus", "cord_load_scale",
    ):  # fmt: skip
        row = HOSE_PARAMETERS.index(name)
        for event in (found.pick_up, found.working, found.cord_break):
            assert np.all(event.strain[row] == 0), name
        assert np.all(found.working.tension[row] != 0), name


def test_below_the_neutral_angle_pick_up_stays_at_rest():
    design = hoses()
    found = hose_sensitivity(design, STRAIN).pick_up.strain[0]
    assert np.array_equal(found > 0, np.degrees(design.wrap_angle) > 54.7356)


def test_one_hose_has_no_axis_of_designs():
    design = HoseDesign(np.radians(64.0), (0.09, 0.09), 0.06, 0.13, 1300.0, 5e-4, 1.4e6, CORD)
    found = hose_sensitivity(design, [0.5, 0.6])
    assert found.tension.shape == (9, 2) and found.stiffness.shape == (2,)
    assert found.working.tension.shape == (9,) and found.working.stiffness.shape == ()
    assert not found.tension.flags.writeable


@pytest.mark.parametrize("strain", [[np.nan], [-1.0]])
def test_a_strain_that_is_none_is_refused(strain):
    design = HoseDesign(np.radians(64.0), (0.09, 0.09), 0.06, 0.13, 1300.0, 5e-4, 1.4e6, CORD)
    with pytest.raises(DataError, match=r"strain.*not finite|stretch_ratio are not positive"):
        hose_sensitivity(design, strain)


@pytest.mark.parametrize("event", EVENTS)
def test_the_stiffness_at_an_event_is_the_slope_of_the_tension_below_it(event):
    """Of the strain of the whole length, of which the dead ends have no part."""
    design = dataclasses.replace(hoses(), wrap_angle=np.radians(np.linspace(57, 75, 12)))
    at, step = getattr(find_events(design), event).strain, 1e-5
    one, two, three = (
        np.diagonal(predict_hose(design, at - count * step).tension) for count in (1, 2, 3)
    )
    slope = (5 * one - 8 * two + 3 * three) / (2 * step)  # second order, from the side of slack
    found = getattr(hose_sensitivity(design, STRAIN), event).stiffness
    np.testing.assert_allclose(found, slope, rtol=1e-4)


def test_sensitivities_are_the_differences_of_the_inverse():
    angle, cord, step = np.radians(np.array([40.0, 64.0, 68.0])), 1.095, 1e-6
    for found, plus, minus in (
        (_stretch_ratio_per_angle(cord, angle), (cord, angle + step), (cord, angle - step)),
        (_stretch_ratio_per_cord_stretch(cord, angle), (cord + step, angle), (cord - step, angle)),
    ):
        difference = (hose_stretch_ratio(*plus) - hose_stretch_ratio(*minus)) / (2 * step)
        np.testing.assert_allclose(found, difference, rtol=1e-8)


@pytest.mark.parametrize("function", [_stretch_ratio_per_angle, _stretch_ratio_per_cord_stretch])
def test_an_angle_that_is_none_of_a_helix_is_refused(function):
    with pytest.raises(SettingsError, match="wrap_angle is not an angle of a helix; found 90 deg"):
        function(1.1, np.radians(90.0))
