"""None"""

from dataclasses import fields, replace

import numpy as np
import pytest
from refusals import refusals
from scipy.integrate import quad

from reduction.prediction import hose_tension as hose
from reduction.prediction.cord_curve import CordCurve, cord_load
from reduction.prediction.hose_product import HoseDesign, HoseEvent, HoseEvents, HosePrediction
from reduction.prediction.hose_tension import (
    find_events,
    hose_energy,
    predict_hose,
    predict_two_layers,
    torque_balanced_angle,
)
from reduction.prediction.rubber_wall import rubber_energy, rubber_stiffness, rubber_tension
from reduction.record import arrays as workers
from reduction.record.errors import DataError, SettingsError

CORD = CordCurve(
    strain=np.array([0.0, 0.02, 0.06, 0.10, 0.15, 0.22]),
    load=np.array([0.0, 7.1, 22.2, 44.5, 80.1, 133.4]),
)
GUMBY = HoseDesign(
    wrap_angle=np.radians(68.0),
    layer_diameter=(0.0889, 0.0889),
    inner_diameter=0.0635,
    outer_diameter=0.127,
    cords_per_length=34 / 0.0254,
    cord_diameter=0.000559,
    rubber_modulus=1.379e6,
    cord=CORD,
)
AREA = np.pi / 4 * (0.127**2 - 0.0635**2)
ARRAYS = [item.name for item in fields(HosePrediction)]
LOADS = ("tension", "fill_pressure", "cord_tension", "cord_share", "rubber_share", "end_cap_load")


def several(count=7, **numbers):
    rng = np.random.default_rng(5)
    return replace(
        GUMBY,
        wrap_angle=np.radians(rng.uniform(45, 72, count)),
        layer_diameter=(rng.uniform(0.07, 0.08, count), rng.uniform(0.08, 0.09, count)),
        dead_length_share=rng.uniform(0, 0.1, count),
        cord_strain_scale=rng.uniform(0.9, 1.1, count),
        **numbers,
    )


def test_slack_cords_leave_the_load_to_the_rubber():
    found = predict_hose(GUMBY, np.linspace(0, 1.025, 60))
    assert np.all(found.is_slack) and not np.any(found.is_broken)
    for name in ("cord_tension", "fill_pressure", "end_cap_load", "cord_share"):
        assert np.all(getattr(found, name) == 0)
    assert np.all(found.rubber_share == 1)
    rubber = rubber_tension(1 + found.strain, area=AREA, modulus=1.379e6, law="neo-hookean")
    np.testing.assert_allclose(found.tension, rubber, rtol=1e-12, atol=1e-9)
    assert np.all(found.cord_strain[1:] < 0)


def test_a_hose_at_rest_bears_nothing_and_has_shares_all_the_same():
    found = predict_hose(GUMBY, [0.0])
    assert found.tension == found.cord_strain == found.cord_share == 0
    assert not np.signbit(found.cord_strain) and found.rubber_share == 1 and found.is_slack
    np.testing.assert_allclose(found.current_wrap_angle, np.radians(68.0), rtol=1e-14)
    np.testing.assert_allclose(found.cord_spacing, 0.0254 / 34, rtol=1e-14)


def test_a_wall_without_rubber_leaves_the_load_to_the_cords():
    found = predict_hose(replace(GUMBY, rubber_modulus=0.0), [0.5, 1.5])
    np.testing.assert_array_equal(found.cord_share, [0, 1])
    np.testing.assert_array_equal(found.rubber_share, [1, 0])


def test_beyond_the_break_of_the_cords_there_is_no_load_but_a_geometry():
    found = predict_hose(GUMBY, [1.9, 1.95])
    np.testing.assert_array_equal(found.is_broken, [False, True])
    for name in LOADS:
        assert np.all(np.isfinite(getattr(found, name)) == [True, False]), name
    for name in ("cord_strain", "cord_spacing", "current_inner_diameter", "current_wrap_angle"):
        assert np.all(np.isfinite(getattr(found, name))), name


def test_a_predicted_hose_is_what_virtual_work_written_by_hand_gives():
    # one point, 68 deg at +150 %: numbers in inches and pounds, worked with a pocket calculator's
    # operations from equations (8), (10), (11), (24), (26)
    cosine2, sine2, stretch = 0.14033009, 0.85966991, 2.5
    cord_stretch = (stretch**2 * cosine2 + sine2 / stretch) ** 0.5
    line = CordCurve(strain=np.array([0.0, 0.22]), load=np.array([0.0, 22.0]))
    load = 100 * (cord_stretch - 1)
    pressure = 4 * load * sine2 / (stretch * cord_stretch * 3.5 / 34)
    number = 2 * 3.14159265 * 3.5 * 0.37460659 * 34
    cords = number * 0.37460659 * load * stretch / cord_stretch
    end_cap = pressure * 3.14159265 * 3.5**2 / (4 * stretch)
    rubber = 3.14159265 / 4 * (5**2 - 2.5**2) * 200 / 3 * (stretch - stretch**-2)
    # the same hose with an inch and a pound as units of length and force
    design = replace(
        GUMBY,
        layer_diameter=(3.5, 3.5),
        inner_diameter=2.5,
        outer_diameter=5.0,
        cords_per_length=34.0,
        cord_diameter=0.022,
        rubber_modulus=200.0,
        cord=line,
    )
    found = predict_hose(design, [1.5])
    np.testing.assert_allclose(found.cord_tension, load, rtol=1e-6)
    np.testing.assert_allclose(found.fill_pressure, pressure, rtol=1e-6)
    np.testing.assert_allclose(found.end_cap_load, end_cap, rtol=1e-6)
    np.testing.assert_allclose(found.tension, cords - end_cap + rubber, rtol=1e-6)
    np.testing.assert_allclose(found.cord_share, 1 - rubber / found.tension, rtol=1e-6)


STIFFNESS = 600.0  # of a straight cord curve: N per strain


def two_layers(inner=68.0, outer=66.0):
    design = replace(
        GUMBY, wrap_angle=np.radians(inner), layer_diameter=(0.084, 0.093), dead_length_share=0.05,
        cord=CordCurve(strain=np.array([0.0, 0.5]), load=np.array([0.0, 0.5 * STIFFNESS])),
    )  # fmt: skip
    return design, np.radians(outer)


def energy_of_layers(design, outer, stretch, twist, widening=(0.0, 0.0)):
    """Of tense cords per relaxed length: a helix of this pitch on a cylinder of this radius.

    ``twist`` is the turn per relaxed length, ``widening`` what each radius is beyond that of
    constant volume; complex numbers give derivatives to the last digit.
    """
    energy = []
    for hand, at, diameter, wider in zip(
        (1, -1), (design.wrap_angle, outer), design.layer_diameter, widening, strict=True
    ):
        radius = diameter / 2 / np.sqrt(stretch) + wider
        turn = np.tan(at) / (diameter / 2) + hand * twist
        length = np.sqrt(stretch**2 + (radius * turn) ** 2)  # relaxed: 1 / cos
        number = np.pi * diameter * np.cos(at) * design.cords_per_length
        strain = length * np.cos(at) - 1
        energy.append(number / np.cos(at) * STIFFNESS / 2 * strain**2)
    return energy


@pytest.mark.parametrize(("inner", "outer"), [(68.0, 68.0), (68.0, 66.0), (60.0, 63.0), (40.0, 44)])
def test_two_layers_are_the_derivatives_of_their_energy(inner, outer):
    design, other = two_layers(inner, outer)
    step = 1e-30
    strain = np.array({68.0: [1.25, 1.4], 60.0: [0.7, 0.9], 40.0: [0.05, 0.15]}[inner])
    stretch = 1 + strain / 0.95
    found = predict_two_layers(design, other, strain)

    def rate(**changed):
        at = {"stretch": stretch, "twist": 0.0} | changed
        return [one.imag / step for one in energy_of_layers(design, other, **at)]

    np.testing.assert_allclose(found.torque, sum(rate(twist=1j * step)), rtol=1e-10)
    rubber = rubber_tension(stretch, area=AREA, modulus=1.379e6, law="neo-hookean")
    pull = sum(rate(stretch=stretch + 1j * step)) + rubber
    np.testing.assert_allclose(found.tension, pull, rtol=1e-10)
    # a layer that gets wider pushes water over its wall, 2 pi r per length of the hose
    wall = [np.pi * one * np.sqrt(stretch) for one in design.layer_diameter]
    squeeze = rate(widening=(1j * step, 1j * step))
    pressure = sum(one / area for one, area in zip(squeeze, wall, strict=True))
    np.testing.assert_allclose(found.fill_pressure, pressure, rtol=1e-10)


def test_an_outer_layer_of_the_balanced_angle_leaves_no_torque():
    design, _ = two_layers()
    balanced = torque_balanced_angle(design, 1.4)
    assert balanced > design.wrap_angle  # the wider layer is wound more steeply
    stretch = 1 + 1.4 / 0.95
    twist = [one.imag / 1e-30 for one in energy_of_layers(design, balanced, stretch, 1e-30j)]
    assert sum(twist) == pytest.approx(0.0, abs=1e-8 * twist[0])
    alike = replace(design, layer_diameter=(0.0889, 0.0889))
    assert torque_balanced_angle(alike, 1.4) == pytest.approx(alike.wrap_angle, rel=1e-12)
    assert predict_two_layers(alike, alike.wrap_angle, [1.4]).torque == pytest.approx(0, abs=1e-10)
    for strain in (0.4, 0.6, 0.97, 1.3):  # whatever rounding leaves at one angle
        other = replace(alike, wrap_angle=np.radians(55.0))
        assert torque_balanced_angle(other, strain) == pytest.approx(np.radians(55.0), rel=1e-12)
    assert np.isnan(torque_balanced_angle(design, 0.5))  # all cords are slack
    assert np.isnan(torque_balanced_angle(design, 3.5))  # broken


def test_dead_ends_stretch_the_axis_and_nothing_else():
    strain = np.linspace(0, 1.7, 50)
    whole = predict_hose(replace(GUMBY, dead_length_share=0.1), 0.9 * strain)
    free = predict_hose(GUMBY, strain)
    np.testing.assert_allclose(whole.free_strain, strain, rtol=1e-14)
    np.testing.assert_allclose(whole.tension, free.tension, rtol=1e-10, atol=1e-9)
    np.testing.assert_allclose(whole.current_inner_diameter, free.current_inner_diameter)


def test_the_scales_stretch_the_axes_of_the_cord_curve():
    scaled = replace(
        GUMBY,
        cord=CordCurve(strain=1.2 * CORD.strain, load=0.7 * CORD.load),
    )
    by_scale = replace(GUMBY, cord_strain_scale=1.2, cord_load_scale=0.7)
    strain = np.linspace(0, 2.2, 80)
    one, other = predict_hose(scaled, strain), predict_hose(by_scale, strain)
    np.testing.assert_allclose(one.tension, other.tension, rtol=1e-10, atol=1e-9)
    np.testing.assert_array_equal(one.is_broken, other.is_broken)
    assert np.any(one.is_broken)
    stretch = 1 + strain
    np.testing.assert_allclose(
        hose_energy(scaled, stretch), hose_energy(by_scale, stretch), rtol=1e-12, atol=1e-9
    )


def test_tight_cords_touch_where_the_spacing_says():
    # at 30 deg the spacing falls with stretch; a steeper layer opens
    design = replace(GUMBY, wrap_angle=np.radians(30.0), cord_diameter=0.00074)
    found = predict_hose(design, np.linspace(0, 0.2, 41))
    assert not found.is_jammed[0] and found.is_jammed[-1]
    np.testing.assert_array_equal(found.is_jammed, found.cord_spacing < 0.00074)
    # width of the fabric between cords times cord length is area on the wall, which goes with
    # the root of the stretch: c lambda_c = c0 sqrt(lambda_h)
    np.testing.assert_allclose(
        found.cord_spacing * (1 + found.cord_strain),
        0.0254 / 34 * np.sqrt(1 + found.strain),
        rtol=1e-12,
    )


def test_the_bore_keeps_its_volume_and_has_a_limit():
    found = predict_hose(replace(GUMBY, minimum_inner_diameter=0.05), [0.0, 0.5, 1.0])
    volume = found.current_inner_diameter**2 * (1 + found.strain)
    np.testing.assert_allclose(volume, 0.0635**2, rtol=1e-14)
    np.testing.assert_array_equal(found.is_bore_too_small, [False, False, True])


@pytest.mark.parametrize("law", ["neo-hookean", "linear", "linear-current", "hencky"])
def test_the_law_of_the_rubber_is_that_of_the_design(law):
    found = predict_hose(replace(GUMBY, rubber_law=law), [0.8])
    rubber = rubber_tension(1.8, area=AREA, modulus=1.379e6, law=law)
    np.testing.assert_allclose(found.tension, rubber, rtol=1e-12)


def test_many_hoses_are_each_what_they_are_alone():
    designs, strain = several(), np.linspace(0, 1.5, 33)
    together = predict_hose(designs, strain)
    for row in range(7):
        alone = replace(
            designs,
            wrap_angle=designs.wrap_angle[row],
            layer_diameter=tuple(one[row] for one in designs.layer_diameter),
            dead_length_share=designs.dead_length_share[row],
            cord_strain_scale=designs.cord_strain_scale[row],
        )
        for name in ARRAYS[1:]:
            one = getattr(predict_hose(alone, strain), name)
            assert one.shape == (33,)
            np.testing.assert_array_equal(getattr(together, name)[row], one, err_msg=name)
        np.testing.assert_array_equal(
            hose_energy(designs, 1 + strain)[row], hose_energy(alone, 1 + strain)
        )


def test_numbers_of_designs_broadcast_to_a_grid():
    grid = replace(
        GUMBY,
        wrap_angle=np.radians([[64.0], [68.0]]),
        rubber_modulus=np.array([1e6, 1.2e6, 1.4e6]),
    )
    found = predict_hose(grid, [0.1, 0.2, 0.3, 0.4])
    assert found.tension.shape == found.is_slack.shape == (2, 3, 4)
    assert hose_energy(grid, [1.1, 1.2]).shape == (2, 3, 2)
    np.testing.assert_allclose(found.tension[:, 2], 1.4 * found.tension[:, 0], rtol=1e-12)


@pytest.mark.parametrize("block", [1, 50, 1000])
@pytest.mark.parametrize("n_processors", [1, 3])
def test_neither_blocks_nor_processors_change_a_bit(monkeypatch, block, n_processors):
    designs, strain = several(11), np.linspace(0, 1.9, 123)
    whole = predict_hose(designs, strain)
    monkeypatch.setattr(hose, "BLOCK", block)
    monkeypatch.setattr(workers, "_n_processors", lambda: n_processors)
    parts = predict_hose(designs, strain)
    for name in ARRAYS:
        np.testing.assert_array_equal(getattr(parts, name), getattr(whole, name), err_msg=name)


def test_no_strains_and_no_hoses_give_no_answers():
    assert predict_hose(GUMBY, []).tension.shape == (0,)
    nobody = replace(GUMBY, wrap_angle=np.empty(0))
    assert predict_hose(nobody, [0.1, 0.2]).tension.shape == (0, 2)


def test_the_arrays_of_a_prediction_cannot_be_written_on():
    strain = np.array([0.1, 0.2])
    found = predict_hose(GUMBY, strain)
    for name in ARRAYS:
        assert not getattr(found, name).flags.writeable
    strain[0] = 0.15  # the caller's own stays the caller's
    assert found.strain[0] == 0.1


def test_the_order_of_the_strains_does_not_matter():
    strain = np.array([1.5, 0.2, 1.9, 0.0])
    shuffled, sorted_ = predict_hose(GUMBY, strain), predict_hose(GUMBY, np.sort(strain))
    np.testing.assert_array_equal(shuffled.tension[np.argsort(strain)], sorted_.tension)


def test_the_net_tension_of_steep_hoses_rises_all_the_way():
    # up to the break, for the angles between the two hoses of the report and beyond
    for angle in range(60, 73):
        design = replace(GUMBY, wrap_angle=np.radians(angle))
        end = float(find_events(design).cord_break.strain)
        tension = predict_hose(design, np.linspace(0, end * (1 - 1e-12), 500)).tension
        assert np.all(np.diff(tension) > 0), angle


HOSE = replace(
    GUMBY,
    layer_diameter=(0.0813, 0.0965),
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


STRETCH = np.array([1.001, 1.2, 1.7, 2.46, 3.5])
# written out once more, for a wall with A E = 1
LAWS = {
    "neo-hookean": lambda x: (x - 1 / x**2) / 3,
    "linear": lambda x: x - 1,
    "linear-current": lambda x: (x - 1) / x,
    "hencky": lambda x: np.log(x) / x,
}
EVERY_LAW = pytest.mark.parametrize("law", LAWS)


@EVERY_LAW
def test_the_tension_is_the_law(law):
    found = rubber_tension(STRETCH, area=2e-3, modulus=1.4e6, law=law)
    np.testing.assert_allclose(found, 2800 * LAWS[law](STRETCH), rtol=1e-12)


@EVERY_LAW
def test_a_wall_at_rest_bears_and_holds_nothing_and_has_its_modulus(law):
    wall = {"area": 2e-3, "modulus": 1.4e6, "law": law}
    assert rubber_tension(1.0, **wall) == 0
    assert rubber_energy(1.0, **wall) == 0
    np.testing.assert_allclose(rubber_stiffness(1.0, **wall), 2800, rtol=1e-15)


@EVERY_LAW
def test_the_energy_is_the_integral_of_the_law(law):
    areas = [quad(LAWS[law], 1, one, epsabs=0, epsrel=1e-12)[0] for one in STRETCH]
    found = rubber_energy(STRETCH, area=1.0, modulus=1.0, law=law)
    np.testing.assert_allclose(found, areas, rtol=1e-10)


@EVERY_LAW
def test_the_stiffness_is_the_slope_of_the_law(law):
    slope = (LAWS[law](STRETCH + 1e-6) - LAWS[law](STRETCH - 1e-6)) / 2e-6
    found = rubber_stiffness(STRETCH, area=1.0, modulus=1.0, law=law)
    np.testing.assert_allclose(found, slope, rtol=1e-7, atol=1e-9)


@EVERY_LAW
def test_compression_gives_a_negative_load(law):
    assert rubber_tension(0.9, area=1.0, modulus=1.0, law=law) < 0


def test_the_hencky_load_falls_beyond_e():
    wall = {"area": 1.0, "modulus": 1.0, "law": "hencky"}
    at_e, beyond = rubber_tension([np.e, 3.5], **wall)
    assert at_e > beyond and rubber_stiffness(3.5, **wall) < 0


@EVERY_LAW
@pytest.mark.parametrize("function", [rubber_tension, rubber_energy, rubber_stiffness])
def test_walls_and_stretches_broadcast(law, function):
    found = function(STRETCH, area=[[1.0], [2.0]], modulus=3.0, law=law)
    assert found.shape == (2, 5)
    np.testing.assert_allclose(found[1], 2 * found[0], rtol=1e-15)


@pytest.mark.parametrize("function", [rubber_tension, rubber_energy, rubber_stiffness])
def test_an_unknown_law_and_a_stretch_ratio_of_zero_are_refused(function):
    with pytest.raises(SettingsError, match="unknown law of rubber; found ogden; needed neo-hook"):
        function(1.5, area=1.0, modulus=1.0, law="ogden")
    with pytest.raises(DataError, match="stretch_ratio are not positive"):
        function([1.0, 0.0], area=1.0, modulus=1.0, law="linear")


REFUSED = {
    "compression is refused": (
        lambda: predict_hose(GUMBY, [-0.2, -0.1, 0.1]),
        DataError,
        r"2 of 3 strains are below zero; found -0\.2; needed zero",
    ),
    "a strain that is no number is refused": (
        lambda: predict_hose(GUMBY, [0.1, np.nan]),
        DataError,
        "1 of 2 values of strain are not finite",
    ),
    "energy at no stretch ratio is refused": (
        lambda: hose_energy(GUMBY, [0.0]),
        DataError,
        "stretch_ratio are not positive",
    ),
}


test_refusals = refusals(REFUSED)
