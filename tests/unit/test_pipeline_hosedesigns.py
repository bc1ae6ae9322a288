import numpy as np
import pytest

from reduction.prediction.cord_curve import CordCurve
from reduction.prediction.hose_design import design_hoses
from reduction.prediction.hose_prediction import HosePlan, HoseTarget
from reduction.prediction.hose_product import HoseDesign

LIKE = HosePlan(
    "like",
    HoseDesign(
        np.radians(68.0), (0.086, 0.092), 0.0635, 0.127, 1340.0, 0.00056, 1.379e6,
        CordCurve(np.array([0.0, 0.1, 0.25]), np.array([0.0, 44.5, 133.5])),
        dead_length_share=0.05,
    ),
)  # fmt: skip


def tension_of(design, strain):
    """Load of cords at 10 % strain and 44.5 N each, and of neo-Hookean rubber, by virtual work."""
    stretch = 1 + strain / 0.95
    cosine2 = np.cos(design.wrap_angle) ** 2
    cords = np.pi * sum(design.layer_diameter) * design.cords_per_length * 44.5 / 1.1
    area = np.pi / 4 * (design.outer_diameter**2 - design.inner_diameter**2)
    rubber = area * design.rubber_modulus / 3 * (stretch - stretch**-2)
    return cords * (stretch * cosine2 - (1 - cosine2) / (2 * stretch**2)) + rubber


def test_every_way_gives_the_wanted_stretch_and_load():
    angle, fabric, diameters = design_hoses(LIKE, HoseTarget(1.2, 18e3))
    assert (angle.varied, fabric.varied) == ("wrap angle", "wrap angle and fabric")
    for one in (angle, fabric, diameters):
        stretch, cosine2 = 1 + 1.2 / 0.95, np.cos(one.design.wrap_angle) ** 2
        cord2 = stretch**2 * cosine2 + (1 - cosine2) / stretch
        # a third of 133.5 N is the second point of the cord curve
        assert np.sqrt(cord2) == pytest.approx(1.1, abs=1e-12)
        assert one.events.working.strain == pytest.approx(1.2, abs=1e-12)
        assert one.events.working.tension == pytest.approx(tension_of(one.design, 1.2), rel=1e-12)
    for one in (fabric, diameters):
        assert tension_of(one.design, 1.2) == pytest.approx(18e3, rel=1e-12)
    assert fabric.design.layer_diameter == LIKE.design.layer_diameter
    assert diameters.design.cords_per_length == LIKE.design.cords_per_length


def test_ribbons_are_as_wide_as_a_turn_of_the_new_angle():
    one = design_hoses(LIKE, HoseTarget(1.2, None))[0]
    turns = np.pi * np.array([0.086, 0.092]) * np.cos(one.design.wrap_angle)
    assert one.ribbon_width == pytest.approx(turns, rel=1e-12)


def test_without_a_load_the_angle_alone_is_asked_for():
    assert [one.varied for one in design_hoses(LIKE, HoseTarget(1.2, None))] == ["wrap angle"]


def test_a_load_that_no_fabric_gives_is_refused_and_the_other_ways_stand():
    angle, fabric, diameters = design_hoses(LIKE, HoseTarget(1.2, 2e3))
    assert angle.design is not None
    assert fabric.design is None
    assert "below that of the rubber alone" in fabric.refusal
    assert (diameters.design is None) == bool(diameters.refusal)


def test_a_stretch_that_no_angle_gives_is_refused():
    (only,) = design_hoses(LIKE, HoseTarget(0.05, None))
    assert only.design is None
    assert "has no wrap angle" in only.refusal
