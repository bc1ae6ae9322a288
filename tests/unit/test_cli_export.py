"""Cases of export and look-up that need no command."""

from dataclasses import replace

import numpy as np
import pytest
from export_lines import constant, line

from reduction.cli.export import _stated_hydrodynamics, _with_syrope
from reduction.cli.lookup import LookupRequest, _points_of
from reduction.lines.export_dynamics import Viscoelasticity
from reduction.lines.export_line import CYLINDER
from reduction.lines.lookup_product import LineCurve, LineSource
from reduction.record.errors import DataError, SettingsError


def test_both_stand_in_place_of_the_assumed_cylinder():
    found = _stated_hydrodynamics("1.6, 0.02", "0.9,0.1", "towed in 2019")["hydrodynamics"]
    assert (found.normal_drag, found.axial_drag) == (1.6, 0.02)
    assert (found.normal_added_mass, found.axial_added_mass) == (0.9, 0.1)
    assert found.source == "stated at the export, towed in 2019"
    assert "assumed" not in found.source


def test_what_is_not_stated_stays_assumed_and_says_so():
    drag = _stated_hydrodynamics("1.6, 0.02", None, "towed")["hydrodynamics"]
    assert drag.normal_added_mass == CYLINDER.normal_added_mass
    assert drag.source.startswith("drag stated at the export, towed; added mass assumed, not")
    mass = _stated_hydrodynamics(None, "0.9, 0", None)["hydrodynamics"]
    assert mass.normal_drag == CYLINDER.normal_drag
    assert mass.source.startswith("drag assumed, not measured")
    assert mass.source.endswith("added mass stated at the export, without a source")
    assert _stated_hydrodynamics(None, None, None) == {}


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (("1.6", None, None), "--drag is not a pair of coefficients; found '1.6'"),
        ((None, "1,0,0", None), "--added-mass is not a pair"),
        (("1.6, -0.1", None, None), "--drag is negative; found '1.6, -0.1'"),
        (("1.6, 0.1 m", None, None), "--drag: .*needed two numbers"),
        (("a, b", None, None), "--drag: "),
        ((None, None, "a book"), "without coefficients; found --hydrodynamics-source a book"),
    ],
)
def test_what_is_no_pair_of_coefficients_is_refused(given, message):
    with pytest.raises(SettingsError, match=message):
        _stated_hydrodynamics(*given)


# 900 N at most: the fast spring has 2,000 N and 1 N more for each N of mean
PART = Viscoelasticity(
    static_stiffness=500.0, dynamic_stiffness=2000.0, dashpot_coefficient=900.0,
    dynamic_stiffness_per_mean_tension=1.0, mean_tension=300.0,
)  # fmt: skip


def test_working_curves_are_stated_and_the_rest_is_of_the_three_parameters():
    one = line(viscoelasticity=PART, linear_density=0.5)
    assert _with_syrope(one, None, None, form="table") is one
    made = _with_syrope(one, "quadratic, 0.2, 0.5", "400 N", form="syrope")
    found = made.syrope
    assert (found.form, found.k1, found.k2) == ("QUADRATIC", 0.2, 0.5)
    assert (found.mean_tension, found.greatest_mean_tension) == (300.0, 400.0)
    # EA_d 2,300 N of 500 N static: N (2300 / 1800)^2
    assert found.slow_damping == pytest.approx(900 * (2300 / 1800) ** 2)
    # a tenth of critical for segments of 2 m
    assert found.fast_damping == pytest.approx(0.2 * np.sqrt(2300 * 0.5))
    assert "stated at the export" in made.sources[-1]
    assert _with_syrope(one, "LINEAR, 0.2", "400 N", form="syrope").syrope.k2 == 0
    own = replace(one, rated_break_strength=1000.0)
    share = _with_syrope(own, "LINEAR, 0.2", "40 %RBS", form="syrope").syrope
    assert share.greatest_mean_tension == 400.0


@pytest.mark.parametrize(
    ("curve", "tension", "form", "message"),
    [
        ("LINEAR, 0.2", None, "syrope", "only partly stated"),
        (None, "400 N", "syrope", "only partly stated"),
        ("LINEAR, 0.2", "400 N", None, "only to a Syrope line"),
        ("LINEAR", "400 N", "syrope", "--working-curve is not understood"),
        ("LINEAR, 1, 2, 3", "400 N", "syrope", "--working-curve is not understood"),
        ("LINEAR, much", "400 N", "syrope", "--working-curve: "),
        ("CUBIC, 0.2", "400 N", "syrope", "form of a Syrope working curve is not known"),
        ("LINEAR, 0.2", "200 N", "syrope", "do not fit its original working curve"),
    ],
)
def test_what_does_not_make_a_syrope_is_refused(curve, tension, form, message):
    with pytest.raises(SettingsError, match=message):
        _with_syrope(line(viscoelasticity=PART), curve, tension, form=form)


def test_a_line_without_dynamics_or_mass_is_refused():
    with pytest.raises(SettingsError, match="needs the dynamics"):
        _with_syrope(line(), "LINEAR, 0.2", "400 N", form="syrope")
    with pytest.raises(SettingsError, match="linear density"):
        _with_syrope(
            line(viscoelasticity=constant(mean_tension=300.0), linear_density=np.nan),
            "LINEAR, 0.2", "400 N", form="syrope",
        )  # fmt: skip


# points of a look-up: grids over a box, a branch, and what two boxes have in common


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
