import numpy as np
import pytest

from reduction.prediction.hose_geometry import (
    NEUTRAL_ANGLE,
    cord_stretch_ratio,
    current_wrap_angle,
    hose_stretch_ratio,
    pick_up_stretch_ratio,
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
