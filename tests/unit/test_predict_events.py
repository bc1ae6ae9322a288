from dataclasses import fields, replace

import numpy as np
import pytest

from reduction.prediction.cord_curve import CordCurve, cord_load
from reduction.prediction.hose_product import HoseDesign, HoseEvent, HoseEvents
from reduction.prediction.hose_tension import find_events, predict_hose

CORD = CordCurve(
    strain=np.array([0.0, 0.02, 0.06, 0.10, 0.15, 0.22]),
    load=np.array([0.0, 7.1, 22.2, 44.5, 80.1, 133.4]),
)
HOSE = HoseDesign(
    wrap_angle=np.radians(68.0),
    layer_diameter=(0.0813, 0.0965),
    inner_diameter=0.0635,
    outer_diameter=0.127,
    cords_per_length=34 / 0.0254,
    cord_diameter=0.000559,
    rubber_modulus=1.379e6,
    cord=CORD,
    cord_load_scale=0.9,
    cord_strain_scale=1.1,
    dead_length_share=0.08,
)
NAMES = [item.name for item in fields(HoseEvents)]
QUANTITIES = [item.name for item in fields(HoseEvent)]


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("angle", [50.0, 52.0, 60.0, 64.0, 68.0])
@pytest.mark.parametrize("law", ["neo-hookean", "linear", "linear-current", "hencky"])
def test_an_event_is_a_point_of_the_predicted_curve(name, angle, law):
    design = replace(HOSE, wrap_angle=np.radians(angle), rubber_law=law)
    event = getattr(find_events(design), name)
    curve = predict_hose(design, [float(event.strain)])
    for quantity in QUANTITIES[1:]:
        scale = {"tension": 1e4, "fill_pressure": 1e6, "cord_tension": 1e2, "cord_strain": 0.1}
        np.testing.assert_allclose(
            getattr(curve, quantity)[0],
            getattr(event, quantity),
            rtol=1e-9,
            atol=1e-9 * scale[quantity],
        )


def test_events_come_in_order_and_carry_their_cord_loads():
    found = find_events(HOSE)
    strains = [float(getattr(found, name).strain) for name in NAMES]
    assert np.all(np.diff(strains) > 0)
    assert found.pick_up.cord_strain == found.pick_up.cord_tension == 0
    assert found.pick_up.fill_pressure == 0 < found.pick_up.tension
    np.testing.assert_allclose(found.working.cord_tension, 0.9 * 133.4 / 3, rtol=1e-15)
    np.testing.assert_allclose(found.cord_break.cord_tension, 0.9 * 133.4, rtol=1e-15)
    np.testing.assert_allclose(found.cord_break.cord_strain, 1.1 * 0.22, rtol=1e-15)
    on_curve = cord_load(CORD, found.working.cord_strain / 1.1)
    np.testing.assert_allclose(on_curve, 133.4 / 3, rtol=1e-14)


def test_deepest_slack_is_the_least_cord_strain_of_the_curve():
    found = find_events(HOSE).deepest_slack
    strain = np.linspace(0, 0.9, 90_001)
    curve = predict_hose(HOSE, strain).cord_strain
    np.testing.assert_allclose(found.cord_strain, curve.min(), rtol=1e-8)
    np.testing.assert_allclose(found.strain, strain[curve.argmin()], atol=2e-5)


def test_dead_ends_shorten_every_stretch():
    dead, none = find_events(HOSE), find_events(replace(HOSE, dead_length_share=0.0))
    for name in NAMES:
        one, other = getattr(dead, name), getattr(none, name)
        np.testing.assert_allclose(one.strain, 0.92 * other.strain, rtol=1e-14)
        assert one.tension == other.tension


def test_below_the_neutral_angle_nothing_is_slack():
    found = find_events(replace(HOSE, wrap_angle=np.radians(50.0)))
    for event in (found.deepest_slack, found.pick_up):
        for quantity in QUANTITIES:
            assert getattr(event, quantity) == 0


def test_a_working_share_of_one_is_the_break():
    found = find_events(replace(HOSE, working_share=1.0))
    for quantity in QUANTITIES:
        assert getattr(found.working, quantity) == getattr(found.cord_break, quantity)


def test_events_have_the_shape_of_the_designs():
    design = replace(
        HOSE,
        wrap_angle=np.radians([[50.0], [68.0]]),
        cord_load_scale=np.array([0.9, 1.0, 1.1]),
    )
    found = find_events(design)
    for name in NAMES:
        for quantity in QUANTITIES:
            values = getattr(getattr(found, name), quantity)
            assert values.shape == (2, 3) and not values.flags.writeable
            assert np.all(np.isfinite(values))
    alone = find_events(replace(HOSE, cord_load_scale=1.1))
    np.testing.assert_allclose(found.working.tension[1, 2], alone.working.tension, rtol=1e-15)


def test_rubber_changes_the_safe_working_load_but_not_its_strain():
    soft, hard = (find_events(replace(HOSE, rubber_modulus=one)).working for one in (1e6, 2e6))
    assert soft.strain == hard.strain and soft.tension < hard.tension
