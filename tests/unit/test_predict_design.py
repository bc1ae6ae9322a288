"""A hose as a whole: its design, its numbers for the designer."""

import dataclasses
import re

import numpy as np
import pytest
from predicted_hoses import (
    AT_WORK,
    LAYERS,
    UNCERTAIN,
    pick_up_strain,
    plan,
    predicted,
    rubber_tension,
    stretch_at,
    working_tension,
)

from reduction.prediction.cord_curve import CordCurve
from reduction.prediction.hose_design import (
    _design_angle,
    _design_diameters,
    _design_fabric,
    design_hoses,
)
from reduction.prediction.hose_prediction import (
    HelicalLayer,
    HosePlan,
    HoseTarget,
    predict_from_plan,
)
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


LIKE_OF_HOSEDESIGNS = HosePlan(
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
    angle, fabric, diameters = design_hoses(LIKE_OF_HOSEDESIGNS, HoseTarget(1.2, 18e3))
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
    assert fabric.design.layer_diameter == LIKE_OF_HOSEDESIGNS.design.layer_diameter
    assert diameters.design.cords_per_length == LIKE_OF_HOSEDESIGNS.design.cords_per_length


def test_ribbons_are_as_wide_as_a_turn_of_the_new_angle():
    one = design_hoses(LIKE_OF_HOSEDESIGNS, HoseTarget(1.2, None))[0]
    turns = np.pi * np.array([0.086, 0.092]) * np.cos(one.design.wrap_angle)
    assert one.ribbon_width == pytest.approx(turns, rel=1e-12)


def test_without_a_load_the_angle_alone_is_asked_for():
    assert [one.varied for one in design_hoses(LIKE_OF_HOSEDESIGNS, HoseTarget(1.2, None))] == [
        "wrap angle"
    ]


def test_a_load_that_no_fabric_gives_is_refused_and_the_other_ways_stand():
    angle, fabric, diameters = design_hoses(LIKE_OF_HOSEDESIGNS, HoseTarget(1.2, 2e3))
    assert angle.design is not None
    assert fabric.design is None
    assert "below that of the rubber alone" in fabric.refusal
    assert (diameters.design is None) == bool(diameters.refusal)


def test_a_stretch_that_no_angle_gives_is_refused():
    (only,) = design_hoses(LIKE_OF_HOSEDESIGNS, HoseTarget(0.05, None))
    assert only.design is None
    assert "has no wrap angle" in only.refusal


# A hose from its plan: how far it is predicted, what its layers bear, what is said of it

BREAK = 0.22


"""Cord strain of the last measured point."""


def said(hose, start):
    return [note for note in map(str, hose.notes) if note.startswith(start)]


def idle(degrees, strain_limit=np.nan, compression_limit=np.nan):
    """A hose with one layer that carries no load."""
    return predicted(
        layers=[HelicalLayer("K", np.radians(degrees), strain_limit, compression_limit)]
    )


def layer_strain(stretch, degrees):
    """Eq. (8) of WHOI-2004-06 for the layer: L2 cos2 + sin2 / L."""
    cos2 = np.cos(np.radians(degrees)) ** 2
    return np.sqrt(stretch**2 * cos2 + (1 - cos2) / stretch) - 1


def test_strains_are_whole_steps_up_to_the_break_and_the_break_itself():
    strain = predicted(strain_step=0.1).prediction.strain
    last = stretch_at(68, BREAK) - 1
    assert strain[:-1] == pytest.approx(np.arange(strain.size - 1) * 0.1)
    assert strain[-1] == pytest.approx(last, rel=1e-12)
    assert last - strain[-2] < 0.1


def test_the_break_itself_carries_load():
    hose = predicted()
    assert np.isfinite(hose.prediction.tension).all()
    assert not hose.prediction.is_broken.any()
    assert hose.prediction.tension[-1] == pytest.approx(float(hose.events.cord_break.tension))


def test_a_stated_end_is_met_in_whole_steps():
    hose = predicted(greatest_strain=0.6, strain_step=0.2)
    assert hose.prediction.strain == pytest.approx([0, 0.2, 0.4, 0.6])
    assert predicted(greatest_strain=0.5, strain_step=0.2).prediction.strain[-1] == 0.4


def test_an_end_beyond_the_break_is_told_and_has_no_load():
    hose = predicted(greatest_strain=2.4, strain_step=0.1)
    (note,) = said(hose, "the cords are broken from")
    first = hose.prediction.strain[hose.prediction.strain > stretch_at(68, BREAK) - 1][0]
    assert note == f"the cords are broken from {100 * first:.1f} % strain on: no load given"
    assert np.isnan(hose.prediction.tension[-1])


@pytest.mark.parametrize("options", [{"strain_step": 1e-6}, {"greatest_strain": 500.0}])
def test_steps_without_end_are_refused(options):
    with pytest.raises(SettingsError, match="hose 'gumby' has no end of strains") as caught:
        predict_from_plan(plan(**options))
    assert "at most 20000" in str(caught.value) and "Make strain_step larger" in str(caught.value)


def test_dead_length_takes_its_share_of_every_strain():
    hose = predicted(dead_length_share=0.04, layers=())
    assert float(hose.events.pick_up.strain) == pytest.approx(0.96 * pick_up_strain(68))
    assert hose.prediction.free_strain == pytest.approx(hose.prediction.strain / 0.96)


def test_ribbons_and_cords_are_those_of_the_fabric():
    hose = predicted()
    width = np.pi * np.array([3.4, 3.6]) * 0.0254 * np.cos(np.radians(68))
    assert hose.ribbon_width == pytest.approx(tuple(width))
    # WHOI-2004-06, sec. 1.2.2: 280 cords at 68 degrees, 3.5 in and 34 an inch
    assert hose.number_of_cords == pytest.approx(280.1, abs=0.05)


def test_layers_of_one_diameter_have_no_torque():
    """-1.35e-15 N m was shown for the example of the documentation."""
    assert predicted(layer_diameter=(0.0889, 0.0889)).working_torque == 0.0


def test_a_layer_is_followed_to_the_working_load_and_to_the_break():
    (one,) = idle(66).layers
    way = np.linspace(1, stretch_at(68, AT_WORK), 100_001)
    assert one.least_strain == pytest.approx(layer_strain(way, 66).min(), abs=1e-9)
    assert one.greatest_strain == pytest.approx(layer_strain(way[-1], 66))
    assert one.break_strain == pytest.approx(layer_strain(stretch_at(68, BREAK), 66))
    assert np.isnan([one.least_angle, one.greatest_angle]).all()


def test_a_layer_within_its_limits_or_without_any_is_not_spoken_of():
    assert said(idle(66), "layer") == said(idle(78, 0.01, 0.3), "layer") == []


def test_a_layer_stretched_too_far_is_told_the_angle_that_it_needs():
    hose = idle(66, strain_limit=0.02)
    (note,) = said(hose, "layer K")
    needed = np.degrees(hose.layers[0].least_angle)
    assert layer_strain(stretch_at(68, AT_WORK), needed) == pytest.approx(0.02)
    strain = 100 * layer_strain(stretch_at(68, AT_WORK), 66)
    assert note == (
        f"layer K is stretched by {strain:.1f} % at the working load, above its limit of 2 %: "
        f"use a wrap angle of {needed:.1f} degrees or more"
    )


def test_a_layer_compressed_too_far_is_told_the_angle_that_it_may_have():
    hose = idle(78, compression_limit=0.05)
    (note,) = said(hose, "layer K")
    allowed = np.degrees(hose.layers[0].greatest_angle)
    way = np.linspace(1, stretch_at(68, AT_WORK), 100_001)
    assert layer_strain(way, allowed).min() == pytest.approx(-0.05, abs=1e-9)
    assert note.startswith(f"layer K is compressed by {-100 * layer_strain(way, 78).min():.1f} %")
    assert note.endswith(
        f"above its limit of 5 %: use a wrap angle of {allowed:.1f} degrees or less"
    )


def test_limits_that_no_angle_meets_together_are_told():
    hose = predicted(layers=LAYERS)
    assert said(hose, "layer Kevlar: no wrap angle") == [
        "layer Kevlar: no wrap angle keeps it within both limits up to the working load"
    ]


def test_a_hose_below_the_neutral_angle_has_no_slack_zone():
    (note,) = said(predicted(degrees=50.0, layers=()), "at 50.00 degrees")
    assert note.endswith("there is no slack zone: the cords carry load from the start")
    assert not said(predicted(), "at ")


def test_cords_that_touch_and_a_narrow_bore_are_told_with_their_range():
    hose = predicted(cord_diameter=0.00075, minimum_inner_diameter=0.05, layers=())
    (touch,) = said(hose, "neighbouring cords touch")
    (bore,) = said(hose, "the bore is below its limit")
    at = hose.prediction.strain[hose.prediction.cord_spacing < 0.00075]
    assert touch == (
        f"neighbouring cords touch from {100 * at[0]:.1f} to {100 * at[-1]:.1f} % strain: "
        "the prediction is not valid there"
    )
    # constant volume: 63.5 mm over the root of the stretch is 50 mm at (63.5/50)**2
    first = hose.prediction.strain[hose.prediction.strain > (63.5 / 50) ** 2 - 1][0]
    assert f"from {100 * first:.1f} to " in bore


def test_cords_that_touch_at_rest_and_again_near_the_end_are_told_apart():
    # spacing goes with the root of the stretch over that of the cord: it rises, then falls
    hose = predicted(degrees=43.0, cord_diameter=1.005 * 0.0254 / 34, layers=(), strain_step=0.01)
    strain = hose.prediction.strain
    spacing = np.sqrt(1 + strain) / (1 + layer_strain(1 + strain, 43))
    touch = np.flatnonzero(spacing < 1.005)
    gap = int(np.flatnonzero(np.diff(touch) > 1)[0])
    ends = [strain[touch[k]] for k in (0, gap, gap + 1, -1)]
    (note,) = said(hose, "neighbouring cords touch")
    assert note.startswith(
        "neighbouring cords touch from {:.1f} to {:.1f} and from {:.1f} to {:.1f} % strain".format(
            *(100 * end for end in ends)
        )
    )


def test_without_a_stated_uncertainty_none_is_given():
    hose = predicted(uncertain={}, layers=())
    assert tuple(map(str, hose.notes)) == (
        "no uncertainty is stated for the hose: the prediction has none",
    )
    assert hose.uncertainty.source == ()


def test_a_safe_working_load_that_is_little_known_is_told_with_its_share():
    hose = predicted(uncertain={"rubber_modulus": 0.5 * 200 * 6894.757293168}, layers=())
    (note,) = said(hose, "the safe working load is uncertain by")
    rubber = 1 - hose_cord_load(68) / working_tension(68)
    assert note.endswith(f" by {50 * rubber:.0f} % (k = 1)")
    assert not said(predicted(uncertain=UNCERTAIN), "the safe working load")


def hose_cord_load(degrees):
    """Load of the cords less the end cap at the working load."""
    return working_tension(degrees) - rubber_tension(stretch_at(degrees, AT_WORK))
