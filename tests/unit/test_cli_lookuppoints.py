"""Points of a look-up: grids over a box, a branch, and what two boxes have in common."""

import numpy as np
import pytest

from reduction.cli.lookup import LookupRequest, _points_of
from reduction.lines.lookup_product import LineCurve, LineSource
from reduction.record.errors import DataError, SettingsError


def curve(branch, low, high):
    ends = np.array([low, high])
    return LineCurve("tangent_modulus", "strain", low, high, at=ends, value=ends, branch=branch)


def tether(name, *curves, strength=1000.0):
    return LineSource(name, "made", "rubber", "", "", 0.02, strength, curves=curves)


ONE = tether("one", curve("ascending", 0.5, 2.0), curve("descending", 0.2, 1.0))
OTHER = tether("other", curve("ascending", 1.0, 3.0), strength=500.0)


@pytest.mark.parametrize(
    ("branch", "expected"),
    [("ascending", [0.5, 1.25, 2.0]), ("descending", [0.2, 0.6, 1.0])],
)
def test_a_grid_is_over_the_range_of_its_branch(branch, expected):
    wanted = LookupRequest("tangent_modulus", {}, branch=branch, grid=True)
    (points,), left_out = _points_of(wanted, ONE)
    assert points["strain"].tolist() == pytest.approx(expected)
    assert not left_out


def test_a_grid_of_two_lines_is_over_what_both_have():
    wanted = LookupRequest("tangent_modulus", {}, branch="ascending", grid=True)
    points, _ = _points_of(wanted, ONE, OTHER)
    assert [one["strain"].tolist() for one in points] == [[1.0, 1.5, 2.0]] * 2


def test_what_is_given_is_no_grid_and_shares_are_of_each_line():
    wanted = LookupRequest("strain", {"tension": "10 %MBL"})
    points, _ = _points_of(wanted, ONE, OTHER)
    assert [one["tension"].tolist() for one in points] == [[100.0], [50.0]]
    with pytest.raises(SettingsError, match="several values of a level need a table"):
        _points_of(LookupRequest("strain", {"tension": "10 N,20 N"}), ONE)
    unknown = tether("bare", strength=float("nan"))
    with pytest.raises(SettingsError, match="--tension: "):
        _points_of(wanted, ONE, unknown)


def test_combinations_that_would_push_a_line_are_left_out():
    levels = {"mean_tension": "100 N,200 N", "tension_amplitude": "50 N,150 N"}
    (points,), left_out = _points_of(LookupRequest("relaxation_time", levels, grid=True), ONE)
    assert left_out
    assert points["mean_tension"].tolist() == [100.0, 200.0, 200.0]
    # what one line stands the other may not: 30 % of 500 N about 100 N
    shares = {"mean_tension": "100 N", "tension_amplitude": "9 %RBS,20 %RBS,30 %RBS"}
    points, left_out = _points_of(LookupRequest("relaxation_time", shares, grid=True), ONE, OTHER)
    assert [one["tension_amplitude"].tolist() for one in points] == [[90.0], [45.0]]
    assert left_out


def test_a_grid_without_any_point_is_refused():
    levels = {"mean_tension": "100 N", "tension_amplitude": "200 N,300 N"}
    with pytest.raises(
        DataError,
        match="every combination has an amplitude above its mean tension; found 2 combinations",
    ):
        _points_of(LookupRequest("relaxation_time", levels, grid=True), ONE)


def test_a_grid_that_no_table_can_hold_is_refused_before_it_is_made():
    values = ",".join(f"{one} N" for one in range(1, 1002))
    levels = {"mean_tension": values, "tension_amplitude": values}
    with pytest.raises(SettingsError, match="too many points for a table; found 1,002,001"):
        _points_of(LookupRequest("relaxation_time", levels, grid=True), ONE)


def test_a_grid_of_the_one_branch_that_is_known_needs_no_branch():
    (points,), _ = _points_of(LookupRequest("tangent_modulus", {}, grid=True), OTHER)
    assert points["strain"].tolist() == [1.0, 2.0, 3.0]
    (points,), _ = _points_of(LookupRequest("tangent_modulus", {}, grid=True), ONE)
    assert points == {}
