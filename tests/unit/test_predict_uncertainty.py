"""Uncertainty of a hose prediction, against sampled hoses."""

import dataclasses
import re

import numpy as np
import pytest

from reduction.prediction.cord_curve import CordCurve
from reduction.prediction.hose_product import HoseDesign
from reduction.prediction.hose_sensitivity import hose_sensitivity
from reduction.prediction.hose_tension import find_events, predict_hose
from reduction.prediction.hose_uncertainty import PICK_UP, propagate_hose, with_pick_up
from reduction.record.errors import SettingsError

INCH, PSI = 0.0254, 6894.757
CORD = CordCurve(
    np.array([0.0, 0.02, 0.06, 0.10, 0.15, 0.22]), np.array([0.0, 7.0, 22.0, 45.0, 80.0, 133.0])
)
DESIGN = HoseDesign(
    wrap_angle=np.radians(68.0),
    layer_diameter=(3.4 * INCH, 3.6 * INCH),
    inner_diameter=2.5 * INCH,
    outer_diameter=5.0 * INCH,
    cords_per_length=34 / INCH,
    cord_diameter=0.022 * INCH,
    rubber_modulus=200 * PSI,
    cord=CORD,
    dead_length_share=0.05,
)
KNOWN = {
    "wrap_angle": np.radians(0.2),
    "layer_diameter": 0.02 * INCH,
    "inner_diameter": 0.01 * INCH,
    "outer_diameter": 0.03 * INCH,
    "cords_per_length": 0.5 / INCH,
    "rubber_modulus": 10 * PSI,
    "cord_load_scale": 0.03,
    "cord_strain_scale": 0.02,
    "dead_length_share": 0.005,
}
N_HOSES = 20_000
SAMPLING = 4 / np.sqrt(2 * N_HOSES)  # four standard errors of a standard deviation: 2 %
BENT = 0.03  # what the second order of the curve adds, at two tenths of a degree


@pytest.fixture(scope="module")
def hoses():
    rng = np.random.default_rng(20040601)
    drawn = {name: spread * rng.standard_normal(N_HOSES) for name, spread in KNOWN.items()}
    shift = drawn.pop("layer_diameter")
    moved = {name: getattr(DESIGN, name) + by for name, by in drawn.items()}
    return dataclasses.replace(
        DESIGN, layer_diameter=tuple(one + shift for one in DESIGN.layer_diameter), **moved
    )


def test_the_curve_away_from_its_kinks_is_as_uncertain_as_sampled_hoses(hoses):
    strain = np.array([0.2, 0.6, 0.85, 1.2, 1.3, 1.4, 1.6])
    found = propagate_hose(DESIGN, strain, KNOWN)
    sampled = predict_hose(hoses, strain)
    for name in ("tension", "fill_pressure"):
        linear = getattr(found, f"{name}_standard_uncertainty")
        assert linear == pytest.approx(getattr(sampled, name).std(axis=0), rel=SAMPLING + BENT)


@pytest.mark.parametrize("event", ["deepest_slack", "pick_up", "working", "cord_break"])
@pytest.mark.parametrize("quantity", ["strain", "tension", "fill_pressure"])
def test_the_events_are_as_uncertain_as_those_of_sampled_hoses(hoses, event, quantity):
    found = getattr(propagate_hose(DESIGN, [0.5], KNOWN), event)
    sampled = getattr(getattr(find_events(hoses), event), quantity).std()
    linear = getattr(found, f"{quantity}_standard_uncertainty")
    assert linear == pytest.approx(sampled, rel=SAMPLING + 0.005)


def test_at_the_kink_it_is_not():
    known = {"wrap_angle": np.radians(0.5)}
    width = float(propagate_hose(DESIGN, [0.5], known).pick_up.strain_standard_uncertainty)
    at = float(find_events(DESIGN).pick_up.strain) + width * np.array([-2.1, -1.9, 0, 1.9, 2.1])
    found = propagate_hose(DESIGN, at, known)
    rng = np.random.default_rng(3)
    angles = DESIGN.wrap_angle + known["wrap_angle"] * rng.standard_normal(N_HOSES)
    sampled = predict_hose(dataclasses.replace(DESIGN, wrap_angle=angles), at).tension.std(axis=0)
    # on the slack side the angle moves nothing at first order
    assert found.tension_standard_uncertainty[1] == pytest.approx(0, abs=1e-9)
    assert sampled[2] > 100


def test_slack_cords_may_bear_what_sampled_hoses_bear():
    """Load and pressure by the energy of cords and rubber, written out here; cords of a power law.

    The pressure was 0 +- 0 up to the strain of pick-up, where half of the hoses have one.
    """
    strain = np.linspace(0, 0.22, 45)
    cord = CordCurve(strain, 2500 * strain**1.5)
    design = dataclasses.replace(DESIGN, cord=cord, layer_diameter=(3.5 * INCH, 3.5 * INCH))
    known = {"wrap_angle": np.radians(0.5), "cord_strain_scale": 0.0, "dead_length_share": 0.003}
    at = float(find_events(design).pick_up.strain)
    width = float(propagate_hose(design, [0.5], known).pick_up.strain_standard_uncertainty)
    where = at + width * np.array([-2.0, -1.0, -0.5, -0.01])
    found = with_pick_up(design, propagate_hose(design, where, known))
    rng = np.random.default_rng(8)
    angle, share = (
        centre + spread * rng.standard_normal((N_HOSES, 1))
        for centre, spread in ((DESIGN.wrap_angle, np.radians(0.5)), (0.05, 0.003))
    )
    stretch = 1 + where / (1 - share)
    cord_stretch = np.sqrt((stretch * np.cos(angle)) ** 2 + np.sin(angle) ** 2 / stretch)
    load = 2500 * np.maximum(cord_stretch - 1, 0) ** 1.5
    around = 2 * np.pi * 3.5 * INCH * 34 / INCH  # both layers; cords times length over length
    # T = dW/dl of W = around * W_cord(l_c)
    cords = around * load * (stretch * np.cos(angle) ** 2 - np.sin(angle) ** 2 / (2 * stretch**2))
    cords /= cord_stretch
    # p dV = dW at constant length of the whole: n P sin^2 over the radius, both layers
    pressure = 2 * 2 * load * (34 / INCH) * np.sin(angle) ** 2 / (stretch * cord_stretch)
    pressure /= 3.5 * INCH
    place = found.source.index(PICK_UP)
    for own, true in (
        (found.tension_contribution[place], cords),
        (found.fill_pressure_standard_uncertainty, pressure),
    ):
        # the strain of pick-up is no straight line of the angle either
        assert own == pytest.approx(np.sqrt(np.mean(true**2, axis=0)), rel=0.2)
    above = with_pick_up(design, propagate_hose(design, [at + 0.1], known))
    assert above.tension_contribution[-1] == 0


def test_beyond_the_break_it_is_nan():
    at = float(find_events(DESIGN).cord_break.strain) + np.array([-1e-3, 1e-3])
    found = propagate_hose(DESIGN, at, KNOWN)
    assert np.isnan(found.tension_standard_uncertainty).tolist() == [False, True]
    assert np.isnan(found.tension_contribution[:, 1]).all()


def test_contributions_are_signed_and_in_the_order_of_the_parameters():
    found = propagate_hose(DESIGN, [1.3], {"rubber_modulus": 10 * PSI, "wrap_angle": 0.003})
    assert found.source == ("wrap_angle", "rubber_modulus")
    assert np.sign(found.tension_contribution[:, 0]).tolist() == [-1, 1]
    slopes = hose_sensitivity(DESIGN, [1.3])
    assert found.tension_contribution[0] == pytest.approx(0.003 * slopes.tension[0])
    assert found.tension_standard_uncertainty == pytest.approx(
        np.hypot(*found.tension_contribution)
    )


def test_many_hoses_at_once_and_nothing_uncertain():
    many = dataclasses.replace(DESIGN, wrap_angle=np.radians([[60.0], [64.0]]))
    found = propagate_hose(many, [0.1, 0.2, 0.3], {"wrap_angle": 0.01})
    assert found.tension_contribution.shape == (1, 2, 1, 3)
    assert found.working.strain_standard_uncertainty.shape == (2, 1)
    known = propagate_hose(DESIGN, [0.1, 0.2], {})
    assert known.source == () and known.tension_contribution.shape == (0, 2)
    assert known.tension_standard_uncertainty.tolist() == [0, 0]
    same = propagate_hose(DESIGN, [0.1, 0.2], {"wrap_angle": 0.0})
    assert same.tension_standard_uncertainty.tolist() == [0, 0]


def test_a_hose_whose_cords_bear_from_the_start_has_no_kink_at_rest():
    flat = dataclasses.replace(DESIGN, wrap_angle=np.radians(50.0))
    found = propagate_hose(flat, [0.0, 0.001], KNOWN)
    assert found.tension_standard_uncertainty[0] == 0


@pytest.mark.parametrize(
    ("error", "known", "message"),
    [
        (SettingsError, {"cord_diameter": 1e-5}, "standard_uncertainty.cord_diameter is not a number of a hose; found cord_diameter; needed one of wrap_angle, layer_diameter"),
        (SettingsError, {"wrap_angle": -0.1}, "standard_uncertainty.wrap_angle is not an uncertainty; found -0.1 in SI; needed zero or more"),
        (SettingsError, {"wrap_angle": np.nan}, "found nan in SI"),
    ],
)  # fmt: skip
def test_an_uncertainty_that_is_none_is_refused(error, known, message):
    with pytest.raises(error, match=re.escape(message)):
        propagate_hose(DESIGN, [0.5], known)
