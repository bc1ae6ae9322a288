"""None"""

import re

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

from reduction.prediction.cord_curve import (
    CordCurve,
    cord_energy,
    cord_load,
    cord_stiffness,
    cord_strain_at,
    pieces_of,
)
from reduction.prediction.hose_geometry import (
    NEUTRAL_ANGLE,
    cord_strain_chart,
    cord_stretch_ratio,
    current_wrap_angle,
    greatest_layer_angle,
    hose_stretch_ratio,
    layer_range,
    least_layer_angle,
    number_of_cords,
    pick_up_stretch_ratio,
    ribbon_width,
    slackest_stretch_ratio,
    wrap_angle_for,
)
from reduction.record.errors import DataError, SettingsError

ANGLES = np.radians(np.arange(5.0, 86.0, 1.0))
CORES = ("isochoric", "rigid")


@pytest.mark.parametrize("core", CORES)
def test_the_length_of_a_helix_is_that_of_its_polygon(core):
    # one turn of a helix as a line through many points, before and after the cylinder stretches
    angle, stretch, radius = np.radians(64.0), 1.7, 0.04
    turn = np.linspace(0, 2 * np.pi, 100_001)

    def line_of(length, around):
        points = np.stack([around * np.cos(turn), around * np.sin(turn), length * turn / 2 / np.pi])
        return points, np.linalg.norm(np.diff(points, axis=1), axis=0).sum()

    pitch = 2 * np.pi * radius / np.tan(angle)
    thinner = radius / np.sqrt(stretch) if core == "isochoric" else radius
    _, rest = line_of(pitch, radius)
    points, stretched = line_of(pitch * stretch, thinner)
    found = cord_stretch_ratio(stretch, angle, core=core)
    np.testing.assert_allclose(found, stretched / rest, rtol=1e-8)
    along = points[2, 1] / np.linalg.norm(points[:, 1] - points[:, 0])
    np.testing.assert_allclose(
        current_wrap_angle(stretch, angle, core=core), np.arccos(along), rtol=1e-6
    )


@pytest.mark.parametrize("core", CORES)
def test_nothing_happens_at_rest(core):
    np.testing.assert_allclose(cord_stretch_ratio(1.0, ANGLES, core=core), 1.0, rtol=1e-15)
    np.testing.assert_allclose(current_wrap_angle(1.0, ANGLES, core=core), ANGLES, rtol=1e-14)


@pytest.mark.parametrize("core", CORES)
def test_the_closed_inverse_leaves_no_residual(core):
    cord = np.linspace(1.0, 2.0, 501)[:, None]
    stretch = hose_stretch_ratio(cord, ANGLES, core=core)
    assert np.all(stretch >= 1 - 1e-15)
    residual = cord_stretch_ratio(stretch, ANGLES, core=core) / cord - 1
    assert np.max(np.abs(residual)) < 1e-14


def test_the_inverse_is_on_the_branch_where_stretch_lengthens_the_cord():
    angle = np.radians(68.0)
    cord = cord_stretch_ratio(np.array([1.2, 1.9]), angle)
    found = hose_stretch_ratio(cord, angle)
    assert found[0] > slackest_stretch_ratio(angle) > 1.2
    np.testing.assert_allclose(found[1], 1.9, rtol=1e-14)


@pytest.mark.parametrize("core", CORES)
def test_a_helix_shorter_than_it_can_be_has_no_stretch(core):
    assert np.isnan(hose_stretch_ratio(0.5, np.radians(68.0), core=core))


def test_the_shortest_helix_of_all_is_found():
    slackest = slackest_stretch_ratio(ANGLES[ANGLES > NEUTRAL_ANGLE])
    angle = ANGLES[ANGLES > NEUTRAL_ANGLE]
    shortest = cord_stretch_ratio(slackest, angle)
    # a double root: the stretch is known to the root of the rounding
    np.testing.assert_allclose(hose_stretch_ratio(shortest, angle), slackest, rtol=1e-7)
    for step in (-1e-3, 1e-3):
        assert np.all(cord_stretch_ratio(slackest + step, angle) > shortest)


def test_at_deepest_slack_the_angle_is_the_neutral_one():
    angle = ANGLES[ANGLES > NEUTRAL_ANGLE]
    current = current_wrap_angle(slackest_stretch_ratio(angle), angle)
    np.testing.assert_allclose(np.degrees(current), 54.73561031724535, rtol=1e-14)


def test_the_cord_is_at_length_again_at_pick_up():
    angle = ANGLES[ANGLES > NEUTRAL_ANGLE]
    pick_up = pick_up_stretch_ratio(angle)
    assert np.all(pick_up > slackest_stretch_ratio(angle))
    np.testing.assert_allclose(cord_stretch_ratio(pick_up, angle), 1.0, rtol=1e-14)
    np.testing.assert_allclose(hose_stretch_ratio(1.0, angle), pick_up, rtol=1e-12)


def test_below_the_neutral_angle_cords_bear_from_the_start():
    angle = ANGLES[ANGLES < NEUTRAL_ANGLE]
    assert np.all(pick_up_stretch_ratio(angle) == 1)
    assert np.all(slackest_stretch_ratio(angle) == 1)
    assert np.all(cord_stretch_ratio(1.001, angle) > 1)


@pytest.mark.parametrize("core", CORES)
def test_the_angle_for_two_stretches_comes_back(core):
    stretch = np.array([1.01, 1.3, 2.4])[:, None]
    cord = cord_stretch_ratio(stretch, ANGLES, core=core)
    found = wrap_angle_for(stretch, cord, core=core)
    np.testing.assert_allclose(found, np.broadcast_to(ANGLES, (3, 81)), rtol=1e-11)


def test_two_stretches_that_no_angle_joins_have_none():
    # beyond the hose itself, thinner than the wall, and a hose at rest
    found = wrap_angle_for(np.array([1.5, 1.5, 1.0]), np.array([1.6, 0.5, 1.0]))
    assert np.all(np.isnan(found))


@pytest.mark.parametrize("angle", [0.0, 90.0, -10.0, np.nan])
@pytest.mark.parametrize("function", [pick_up_stretch_ratio, slackest_stretch_ratio])
def test_an_angle_that_is_none_of_a_helix_is_refused(function, angle):
    with pytest.raises(SettingsError, match=r"wrap_angle is not an angle of a helix; found .* deg"):
        function(np.radians([45.0, angle]))


@pytest.mark.parametrize("bad", [0.0, -1.0, np.nan])
def test_a_stretch_ratio_that_is_not_positive_is_refused(bad):
    for call in (
        lambda: cord_stretch_ratio(bad, 1.0),
        lambda: current_wrap_angle(bad, 1.0),
        lambda: hose_stretch_ratio(bad, 1.0),
        lambda: wrap_angle_for(bad, 1.0),
        lambda: wrap_angle_for(1.5, bad),
    ):
        with pytest.raises(DataError, match="stretch_ratio"):
            call()


def test_an_unknown_core_is_refused():
    for call in (
        lambda: cord_stretch_ratio(1.5, 1.0, core="soft"),
        lambda: hose_stretch_ratio(1.5, 1.0, core="soft"),
    ):
        with pytest.raises(SettingsError, match="unknown core; found soft; needed isochoric or"):
            call()


# charts to choose a wrap angle by

ANGLE = np.radians([40.0, 54.0, 60.0, 64.0, 68.0, 72.0])


@pytest.mark.parametrize("dead", [0.0, 0.1])
def test_the_way_back_is_on_the_curves(dead):
    walk = np.linspace(0, 3, 60001)
    chart = cord_strain_chart(ANGLE, walk, dead_length_share=dead)
    assert chart.cord_strain.shape == (6, 60001)
    for angle, back in zip(ANGLE, chart.pick_up_strain, strict=True):
        again = cord_strain_chart([angle], [back], dead_length_share=dead)
        assert again.cord_strain == pytest.approx(0, abs=1e-14)


def test_no_cord_is_slack_at_or_below_the_neutral_angle():
    angle = np.append(ANGLE, NEUTRAL_ANGLE)
    chart = cord_strain_chart(angle, np.linspace(0, 1, 11))
    assert np.all((chart.pick_up_strain > 0) == (angle > NEUTRAL_ANGLE))


def test_a_hose_that_is_dead_throughout_is_refused():
    with pytest.raises(DataError, match="dead_length_share is not a share; found 1"):
        cord_strain_chart([1.0], [0.1], dead_length_share=1.0)


# ribbons and cords

ANGLE_OF_FABRIC = np.radians([20.0, 50.0, 64.0, 68.0, 85.0])


def test_the_width_is_the_pitch_seen_across_the_cords():
    diameter = 0.0889
    pitch = np.pi * diameter / np.tan(ANGLE_OF_FABRIC)
    assert ribbon_width(diameter, ANGLE_OF_FABRIC) == pytest.approx(
        pitch * np.sin(ANGLE_OF_FABRIC), rel=1e-14
    )


def test_both_layers_are_counted_and_each_adds_what_its_own_ribbon_holds():
    # 2 w n of the mean diameter is w1 n + w2 n
    each = sum(ribbon_width(one, ANGLE_OF_FABRIC) * 1339.0 for one in (0.086, 0.0918))
    assert number_of_cords(0.0889, ANGLE_OF_FABRIC, 1339.0) == pytest.approx(each, rel=1e-14)


def test_a_ribbon_as_wide_as_the_circumference_lies_along_the_hose():
    assert ribbon_width(0.1, 0.0) == pytest.approx(np.pi * 0.1)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: ribbon_width(0.1, np.radians(90)), "wrap_angle is not an angle of a ribbon; found 90"),
        (lambda: ribbon_width(0.1, -0.1), "needed from 0 to below 90 deg"),
        (lambda: ribbon_width(0.0, 1.0), "1 of 1 values of wrap_diameter are not positive"),
        (lambda: number_of_cords(0.1, 1.0, 0.0), "values of cords_per_length are not positive"),
    ],
)  # fmt: skip
def test_what_is_no_fabric_is_refused(call, message):
    with pytest.raises(DataError, match=re.escape(message)):
        call()


# layers that are to carry no load: their strain on the way, and the angles that spare them


def layer_strain(angle, strain, dead=0.0):
    """By the two sides of a rolled-out turn: length stretched, circumference by the root."""
    free = 1 + strain / (1 - dead)
    return np.hypot(free * np.cos(angle), np.sin(angle) / np.sqrt(free)) - 1


@pytest.mark.parametrize("dead", [0.0, 0.08])
def test_least_and_greatest_are_those_of_a_fine_search(dead):
    angle = np.radians(np.linspace(3, 89, 60))[:, None]
    end = np.array([0.0, 0.02, 0.3, 0.79, 1.46, 2.1])
    found = layer_range(angle, end, dead_length_share=dead)
    walk = np.linspace(0, 1, 20001)
    for place, last in enumerate(end):
        strains = layer_strain(angle, walk * last, dead)
        assert found.least_strain[:, place] == pytest.approx(strains.min(axis=1), abs=2e-8)
        assert found.greatest_strain[:, place] == pytest.approx(strains.max(axis=1), abs=1e-12)


def test_a_layer_goes_into_compression_above_the_neutral_angle_only():
    angle = NEUTRAL_ANGLE + np.array([-0.01, -1e-4, 1e-4, 0.01])
    assert (layer_range(angle, 1.0).least_strain < 0).tolist() == [False, False, True, True]


def test_at_the_least_angle_the_limit_is_just_reached():
    end = np.array([[0.3], [0.79], [1.46], [2.1]])
    limit = np.array([0.0, 0.01, 0.04, 0.2])
    angle = least_layer_angle(end, strain_limit=limit, dead_length_share=0.05)
    found = layer_range(angle, end, dead_length_share=0.05)
    assert found.greatest_strain == pytest.approx(np.broadcast_to(limit, angle.shape), abs=1e-13)
    flatter = layer_range(angle - 1e-3, end, dead_length_share=0.05)
    assert np.all(flatter.greatest_strain > limit)


def test_a_layer_that_bears_the_stretch_of_the_hose_may_lie_along_it():
    assert least_layer_angle([0.0, 0.1], strain_limit=0.1).tolist() == [0.0, 0.0]


def test_without_stretch_the_least_angle_is_that_whose_cords_pick_up_there():
    # pick-up of the two hoses of the report, from tan^2 a = l^2 + l
    assert np.degrees(least_layer_angle([0.6104, 1.0251])) == pytest.approx([64, 68], abs=1e-3)


@pytest.mark.parametrize("end", [0.02, 0.3, 1.46, 2.1])
@pytest.mark.parametrize("limit", [1e-4, 0.01, 0.05, 0.1])
def test_at_the_greatest_angle_the_compression_is_just_reached(end, limit):
    angle = greatest_layer_angle(end, compression_limit=limit, dead_length_share=0.05)
    found = layer_range(min(angle, np.radians(89.99)), end, dead_length_share=0.05)
    if angle < np.pi / 2:
        assert found.least_strain == pytest.approx(-limit, abs=1e-12)
        steeper = layer_range(angle + 1e-4, end, dead_length_share=0.05)
        assert steeper.least_strain < -limit
    else:
        assert found.least_strain > -limit


def test_a_layer_that_bears_no_compression_lies_at_the_neutral_angle():
    assert greatest_layer_angle(1.46, compression_limit=0.0) == pytest.approx(
        NEUTRAL_ANGLE, abs=1e-7
    )
    assert greatest_layer_angle(0.0, compression_limit=0.0) == np.pi / 2


def test_there_is_no_angle_for_a_conductor_that_bears_little_either_way_in_a_hose_that_works_far():
    ends = np.array([0.3, 0.79, 1.46])
    low = least_layer_angle(ends, strain_limit=0.02)
    high = greatest_layer_angle(ends, compression_limit=0.02)
    assert (low <= high).tolist() == [True, False, False]


@pytest.mark.parametrize(
    ("error", "call", "message"),
    [
        (SettingsError, lambda: layer_range(np.pi / 2, 1.0), "wrap_angle is not an angle of a helix; found 90 deg"),
        (DataError, lambda: layer_range(1.0, -0.1), "hose_strain is negative; found -0.1"),
        (DataError, lambda: layer_range(1.0, np.nan), "values of hose_strain are not finite"),
        (DataError, lambda: least_layer_angle(1.0, strain_limit=-0.1), "strain_limit is negative or missing"),
        (DataError, lambda: least_layer_angle(1.0, strain_limit=np.nan), "strain_limit is negative or missing"),
        (DataError, lambda: least_layer_angle(1.0, dead_length_share=1.0), "dead_length_share is not a share"),
        (DataError, lambda: greatest_layer_angle(1.0, compression_limit=1.0), "compression_limit leaves no length; found 1; needed below 1"),
    ],
)  # fmt: skip
def test_what_is_no_layer_is_refused(error, call, message):
    with pytest.raises(error, match=re.escape(message)):
        call()


CORD = CordCurve(
    strain=np.array([0.0, 0.02, 0.06, 0.10, 0.15, 0.22]),
    load=np.array([0.0, 7.1, 22.2, 44.5, 80.1, 133.4]),
)
# so soft at the start that a monotone cubic begins with no slope
TOE = CordCurve(strain=np.array([0.0, 0.1, 0.2]), load=np.array([0.0, 1.0, 100.0]))
MANY = CordCurve(strain=np.linspace(0, 0.2, 60), load=700 * np.linspace(0, 0.2, 60) ** 1.5)
CURVES = pytest.mark.parametrize("curve", [CORD, TOE, MANY], ids=["nylon", "toe", "many"])


@CURVES
def test_the_load_goes_through_every_point(curve):
    np.testing.assert_allclose(cord_load(curve, curve.strain), curve.load, rtol=1e-14)


@CURVES
def test_the_load_between_points_is_the_monotone_cubic(curve):
    strain = np.linspace(1e-9, curve.break_strain, 1001)
    theirs = PchipInterpolator(curve.strain, curve.load)
    np.testing.assert_allclose(cord_load(curve, strain), theirs(strain), rtol=1e-13)
    assert np.all(np.diff(cord_load(curve, strain)) > 0)


def test_two_points_make_a_straight_line():
    line = CordCurve(strain=np.array([0.0, 0.25]), load=np.array([0.0, 50.0]))
    np.testing.assert_allclose(cord_load(line, [0.05, 0.2]), [10.0, 40.0], rtol=1e-14)


@CURVES
@pytest.mark.parametrize("quantity", [cord_load, cord_stiffness, cord_energy])
def test_a_slack_cord_has_nothing_and_a_broken_one_no_number(curve, quantity):
    strain = np.array([-0.5, -1e-12, 0.0, curve.break_strain * (1 + 1e-9), 1.0, np.nan])
    np.testing.assert_array_equal(quantity(curve, strain), [0, 0, 0, np.nan, np.nan, np.nan])
    assert np.isfinite(quantity(curve, curve.break_strain))


@CURVES
def test_stiffness_is_the_slope_and_energy_the_integral_of_the_load(curve):
    strain = np.linspace(0.003, 0.997, 40) * curve.break_strain
    step = 1e-6 * curve.break_strain
    slope = (cord_load(curve, strain + step) - cord_load(curve, strain - step)) / (2 * step)
    np.testing.assert_allclose(cord_stiffness(curve, strain), slope, rtol=1e-6)
    # two Gauss points a piece are exact for a cubic
    width, middle = np.diff(curve.strain) / 2, (curve.strain[1:] + curve.strain[:-1]) / 2
    areas = [cord_load(curve, middle + side * width / 3**0.5) for side in (-1, 1)]
    held = np.cumsum(width * sum(areas))
    np.testing.assert_allclose(cord_energy(curve, curve.strain[1:]), held, rtol=1e-12)
    half = width[0] / 2
    first = half * sum(cord_load(curve, half + side * half / 3**0.5) for side in (-1, 1))
    np.testing.assert_allclose(cord_energy(curve, width[0]), first, rtol=1e-12)


@CURVES
def test_the_inverse_gives_the_strain_back(curve):
    strain = np.concatenate([10.0 ** np.linspace(-9, -2, 200), np.linspace(0.01, 1, 500)])
    strain *= curve.break_strain
    load = cord_load(curve, strain)
    # one rounding of the load moves the strain by so much, and no more is lost
    rounding = load / (strain * cord_stiffness(curve, strain))
    error = np.abs(cord_strain_at(curve, load) / strain - 1)
    assert np.max(error / (1 + rounding)) < 1e-15
    assert np.max(error) < 1e-14


@CURVES
def test_the_inverse_is_exact_at_the_points(curve):
    np.testing.assert_array_equal(cord_strain_at(curve, curve.load), curve.strain)


def test_loads_no_cord_bears_have_no_strain():
    found = cord_strain_at(CORD, np.array([-1.0, 133.5, np.inf, np.nan, 0.0]))
    np.testing.assert_array_equal(found, [np.nan, np.nan, np.nan, np.nan, 0.0])


def test_the_smallest_loads_on_a_toe_are_found():
    load = 10.0 ** np.linspace(-300, 1, 200)
    np.testing.assert_allclose(cord_load(TOE, cord_strain_at(TOE, load)), load, rtol=1e-14)


def test_shapes_are_kept_and_the_strains_given_are_not_written_on():
    strain = np.full((2, 3), 0.05)
    assert cord_load(CORD, strain).shape == cord_strain_at(CORD, strain).shape == (2, 3)
    assert cord_load(CORD, 0.05).shape == cord_strain_at(CORD, 0.05).shape == ()
    assert np.all(strain == 0.05)


def test_pieces_are_slack_one_between_two_points_each_and_broken():
    pieces = pieces_of(CORD)
    assert pieces.coefficient.shape == (4, 7)
    assert np.all(pieces.coefficient[:, 0] == 0) and np.all(np.isnan(pieces.coefficient[:, -1]))
    assert pieces_of(CORD, order=1).coefficient.shape == (3, 7)
    assert pieces_of(CORD, order=-1).coefficient.shape == (5, 7)
