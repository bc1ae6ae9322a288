"""A hose from its wanted stretch and load: what is asked for is what is found."""

import dataclasses
import re

import numpy as np
import pytest

from reduction.prediction.cord_curve import CordCurve
from reduction.prediction.hose_design import _design_angle, _design_diameters, _design_fabric
from reduction.prediction.hose_product import HoseDesign
from reduction.prediction.hose_tension import find_events
from reduction.record.errors import SettingsError

INCH, PSI = 0.0254, 6894.757
CORD = CordCurve(
    np.array([0.0, 0.02, 0.06, 0.10, 0.15, 0.22]), np.array([0.0, 7.0, 22.0, 45.0, 80.0, 133.0])
)
LIKE = HoseDesign(
    wrap_angle=np.radians(68.0),
    layer_diameter=(3.4 * INCH, 3.6 * INCH),
    inner_diameter=2.8 * INCH,
    outer_diameter=4.4 * INCH,
    cords_per_length=34 / INCH,
    cord_diameter=0.022 * INCH,
    rubber_modulus=200 * PSI,
    cord=CORD,
    working_share=0.3,
    cord_load_scale=0.9,
    cord_strain_scale=1.1,
    dead_length_share=0.07,
)
STRAIN = np.array([[0.15], [0.3], [0.5], [0.79], [1.3], [1.8]])
TENSION = np.array([10e3, 11e3, 12e3])
LAWS = ("neo-hookean", "linear", "linear-current", "hencky")


@pytest.mark.parametrize("law", LAWS)
def test_the_angle_gives_the_wanted_stretch(law):
    design = _design_angle(dataclasses.replace(LIKE, rubber_law=law), strain=STRAIN)
    assert find_events(design).working.strain == pytest.approx(STRAIN, rel=1e-12)
    assert design.cords_per_length == LIKE.cords_per_length


@pytest.mark.parametrize("law", LAWS)
def test_the_fabric_gives_stretch_and_load(law):
    design = _design_fabric(
        dataclasses.replace(LIKE, rubber_law=law), strain=STRAIN[:4], tension=TENSION
    )
    found = find_events(design).working
    assert design.shape == (4, 3)
    assert found.strain == pytest.approx(np.broadcast_to(STRAIN[:4], (4, 3)), rel=1e-10)
    assert found.tension == pytest.approx(np.broadcast_to(TENSION, (4, 3)), rel=1e-10)
    assert design.layer_diameter == LIKE.layer_diameter


@pytest.mark.parametrize("law", LAWS)
def test_the_diameters_give_stretch_and_load_within_the_same_wall(law):
    design = _design_diameters(
        dataclasses.replace(LIKE, rubber_law=law), strain=STRAIN, tension=TENSION
    )
    found = find_events(design).working
    assert found.strain == pytest.approx(np.broadcast_to(STRAIN, (6, 3)), rel=1e-10)
    assert found.tension == pytest.approx(np.broadcast_to(TENSION, (6, 3)), rel=1e-10)
    inner, outer = design.layer_diameter
    assert inner - design.inner_diameter == pytest.approx(0.6 * INCH)
    assert outer - inner == pytest.approx(0.2 * INCH)
    assert design.outer_diameter - outer == pytest.approx(0.8 * INCH)
    assert design.cords_per_length == LIKE.cords_per_length


def test_a_hose_is_designed_back_to_itself():
    events = find_events(LIKE).working
    for design in (
        _design_fabric(LIKE, strain=events.strain, tension=events.tension),
        _design_diameters(LIKE, strain=events.strain, tension=events.tension),
    ):
        assert design.wrap_angle == pytest.approx(LIKE.wrap_angle, rel=1e-12)
        assert design.cords_per_length == pytest.approx(LIKE.cords_per_length, rel=1e-10)
        assert design.wrap_diameter == pytest.approx(LIKE.wrap_diameter, rel=1e-10)
        assert design.outer_diameter == pytest.approx(LIKE.outer_diameter, rel=1e-10)


def test_a_list_of_hoses_that_it_is_like_goes_with_a_list_of_wishes():
    likes = dataclasses.replace(LIKE, rubber_modulus=np.array([1.0, 1.4, 2.0]) * 1e6)
    design = _design_fabric(likes, strain=[0.5, 0.79, 1.0], tension=[13e3, 13e3, 14e3])
    assert find_events(design).working.tension == pytest.approx([13e3, 13e3, 14e3], rel=1e-10)


def test_the_dead_length_costs_angle():
    # 79 % of the whole is 79/0.93 = 84.9 % of what stretches
    with_ends = _design_angle(LIKE, strain=0.79)
    without = _design_angle(dataclasses.replace(LIKE, dead_length_share=0.0), strain=0.79 / 0.93)
    assert with_ends.wrap_angle == pytest.approx(without.wrap_angle, rel=1e-12)


HARD = dataclasses.replace(LIKE, minimum_inner_diameter=2.0 * INCH)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: _design_angle(LIKE, strain=0.0), "wanted strain is none; found 0 in SI; needed above zero"),
        (lambda: _design_angle(LIKE, strain=[0.5, np.nan]), "wanted strain of 1 of 2 designs is none"),
        (lambda: _design_angle(LIKE, strain=[0.5, 0.02]), "wanted strain of 1 of 2 designs has no wrap angle; found 0.02 in SI; needed above 0.1"),
        (lambda: _design_fabric(LIKE, strain=0.5, tension=-1.0), "wanted tension is none"),
        (lambda: _design_fabric(LIKE, strain=1.3, tension=[2e3, 2e4]), "wanted tension of 1 of 2 designs is below that of the rubber alone; found 2000"),
        (lambda: _design_fabric(LIKE, strain=1.3, tension=1e5), "needs more cords than find room in two layers; found 100000"),
        (lambda: _design_diameters(LIKE, strain=1.3, tension=1e3), "leaves no bore within such a wall; found 1000"),
        (lambda: _design_diameters(LIKE, strain=1.3, tension=0.0), "wanted tension is none"),
        (lambda: _design_fabric(HARD, strain=1.3, tension=14e3), "wanted inner_diameter at the working load is below its limit; found 0.045"),
    ],
)  # fmt: skip
def test_what_cannot_be_built_is_refused(call, message):
    with pytest.raises(SettingsError, match=re.escape(message)):
        call()


@pytest.mark.parametrize(("design", "strain"), [(_design_fabric, 1.3), (_design_diameters, 1.3)])
def test_the_load_that_is_needed_is_the_one_that_will_do(design, strain):
    with pytest.raises(SettingsError) as refused:
        design(LIKE, strain=strain, tension=1e3)
    needed = float(re.search(r"above ([\d.e+]+) N", str(refused.value)).group(1))
    assert design(LIKE, strain=strain, tension=needed * 1.001).inner_diameter > 0
    with pytest.raises(SettingsError, match="wanted tension"):
        design(LIKE, strain=strain, tension=needed * 0.999)
