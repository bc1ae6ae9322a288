from dataclasses import replace

import numpy as np
import pytest
from export_sources import LEVELS, source

from reduction.lines.export_line import curve_from_zero, siblings_of
from reduction.lines.export_sources import line_from_lookup
from reduction.lines.lookup_product import LineCurve, LineSource
from reduction.record.errors import DataError, SettingsError


def test_strain_over_tension_becomes_tension_over_strain():
    found = line_from_lookup(source())
    np.testing.assert_allclose(
        found.strain, 1e-4 * found.tension - 1e-8 * found.tension**2, atol=1e-15
    )
    assert found.tested == pytest.approx((0.0, 0.24))
    assert found.viscoelasticity is None
    assert found.linear_density == 0.1
    assert "errata that apply to the curve: CG-8" in found.sources
    assert found.notes == ("wet",)


def test_static_and_dynamic_stiffness_are_k_0_and_k_0_with_k_1():
    part = line_from_lookup(source(growth=0.0), levels=LEVELS).viscoelasticity
    assert (part.static_stiffness, part.fast_stiffness) == pytest.approx((2e4, 5e4))
    assert part.dashpot_coefficient == pytest.approx(9e4)
    assert part.dynamic_stiffness_per_mean_tension == 0


def test_growth_with_the_mean_tension_is_its_slope_and_the_value_at_the_mean_is_kept():
    found = line_from_lookup(source(), levels=LEVELS)
    part = found.viscoelasticity
    # 5000 N from 2000 to 3000 N of mean
    assert part.dynamic_stiffness_per_mean_tension == pytest.approx(5.0)
    assert part.dynamic_stiffness == pytest.approx(5e4 - 5 * 2000)
    assert part.fast_stiffness == pytest.approx(5e4)
    assert any("growth of the dynamic stiffness" in text for text in found.notes)
    assert any("errata CG-14" in text for text in found.sources)


def test_what_is_stated_is_taken_and_said():
    found = line_from_lookup(source(), linear_density=0.2, diameter=None)
    assert found.linear_density == 0.2
    assert found.diameter == 0.0127
    assert "linear density: stated at the export" in found.sources


def test_points_of_tension_over_strain_by_branch():
    at = np.array([0.5, 1.0, 2.0])
    curves = tuple(
        LineCurve("tension", "strain", 0.5, 2.0, at=at, value=scale * at, branch=branch)
        for branch, scale in (("ascending", 3.0), ("descending", 2.0))
    )
    found = line_from_lookup(source(curves=curves), branch="descending")
    np.testing.assert_array_equal(found.tension, [1.0, 2.0, 4.0])
    assert found.curve.startswith("tension over strain, descending branch")
    with pytest.raises(SettingsError, match="differs by branch"):
        line_from_lookup(source(curves=curves))


def test_outside_the_box_is_refused_or_flagged():
    levels = LEVELS | {"mean_tension": 3500.0}
    with pytest.raises(DataError, match="outside the tested range"):
        line_from_lookup(source(), levels=levels)
    found = line_from_lookup(source(), levels=levels, extrapolate="flag")
    assert any("OUTSIDE the tested range" in text for text in found.sources)


@pytest.mark.parametrize(
    ("curve", "message"),
    [
        (LineCurve("strain", "tension", 0.0, 1e4, coefficient=np.array([0, 1e-4, -1e-8])), "rise"),
        (
            LineCurve(
                "tension", "strain", 0.1, 1.0, at=np.array([0.1, 1.0]), value=np.array([5.0, 4.0])
            ),
            "rise",
        ),
        (LineCurve("strain", "tension", 0.0, 1e4, coefficient=np.array([0, np.nan])), "open"),
    ],
)
def test_a_curve_that_falls_or_is_open_is_refused(curve, message):
    with pytest.raises(DataError, match=message):
        line_from_lookup(source(curves=(curve,)))


def test_what_was_not_measured_is_named():
    with pytest.raises(SettingsError, match="no curve of tension and strain: the pull is lost"):
        line_from_lookup(source(curves=(), absent={"strain": "the pull is lost"}))
    with pytest.raises(SettingsError, match="need a mean tension"):
        line_from_lookup(source(), levels={"frequency": 0.3})


def test_the_last_of_a_cubic_that_turns_back_is_cut_and_told():
    turning = LineCurve("strain", "tension", 0.0, 5200.0, coefficient=np.array([0, 1e-4, -1e-8]))
    found = line_from_lookup(source(curves=(turning,)))
    assert found.tension[-1] == pytest.approx(5000, rel=0.006)
    assert found.tested[1] == found.strain[-1]
    assert "where the polynomial turns back" in found.notes[-1]


def test_a_constant_below_zero_costs_the_first_points():
    low = LineCurve("strain", "tension", 0.0, 4000.0, coefficient=np.array([-0.002, 1e-4]))
    found = line_from_lookup(source(curves=(low,)))
    assert found.strain[0] >= 0
    assert "has strain below zero up to 20 N" in found.notes[-1]
    assert found.tested[0] == found.strain[0]


def test_a_joint_that_stands_twice_is_one_point_and_one_branch_need_not_be_asked_for():
    twice = LineCurve(
        "branch_tension", "strain", 0.5, 2.0, at=np.array([0.5, 1.0, 1.0, 2.0]),
        value=np.array([3.0, 5.0, 5.0, 9.0]), branch="ascending",
    )  # fmt: skip
    found = line_from_lookup(source(curves=(twice,)))
    np.testing.assert_array_equal(found.strain, [0.5, 1.0, 2.0])
    assert "ascending branch" in found.curve
    with pytest.raises(SettingsError, match="differs by branch"):
        line_from_lookup(source(curves=(twice,)), branch="descending")


@pytest.mark.parametrize(("constant", "join", "doubt"), [(0.004, 40.0, False), (0.04, 200.0, True)])
def test_the_constant_of_a_regression_is_no_slack(constant, join, doubt):
    """Strain of A + 1e-4 T: twice A at A / 1e-4 N, or a twentieth of 4,000 N before that."""
    pull = LineCurve("strain", "tension", 0.0, 4000.0, coefficient=np.array([constant, 1e-4]))
    found = line_from_lookup(source(curves=(pull,)))
    assert found.tension[0] == pytest.approx(join)
    assert found.strain[0] == pytest.approx(constant + 1e-4 * join)
    assert found.tested == pytest.approx((constant + 1e-4 * join, constant + 0.4))
    (said,) = (note for note in found.notes if "constant of the fit" in note)
    assert said.startswith("DOUBTFUL") == doubt
    assert f"{100 * constant:.2g} m in 100 m" in said
    at, load, _ = curve_from_zero(found.strain, found.tension)
    assert load[1] > 0
    assert at[1] == found.strain[0]


def test_a_slack_that_was_measured_stays():
    slack = LineCurve(
        "tension", "strain", 0.0, 1.0, at=np.array([0.1, 0.2, 1.0]), value=np.array([0.0, 3.0, 9.0])
    )
    found = line_from_lookup(source(curves=(slack,)))
    np.testing.assert_array_equal(found.strain, [0.1, 0.2, 1.0])


def test_the_curve_ends_where_its_slope_is_not_trusted():
    pull = LineCurve("strain", "tension", 0.0, 4000.0, coefficient=np.array([0, 1e-4, -1e-8]))
    rest = LineCurve(
        "quasi_static_spring_constant", "mean_tension", 0.0, 2500.0,
        coefficient=pull.coefficient, is_inverse_slope=True, range_note="trusted to 2500 N",
    )  # fmt: skip
    found = line_from_lookup(source(curves=(pull, rest)))
    assert found.tension[-1] == pytest.approx(2500.0)
    assert found.tested[1] == pytest.approx(1e-4 * 2500 - 1e-8 * 2500**2)
    assert "trusted to 2500 N" in found.notes


def test_the_strength_is_that_of_the_line_as_it_is():
    assert line_from_lookup(source()).rated_break_strength == 28e3
    old = replace(source(), tensile_strength=12e3)
    found = line_from_lookup(old)
    assert found.rated_break_strength == 12e3
    assert "rated when new 28000 N" in found.notes[-1]
    assert line_from_lookup(old, rated_break_strength=9e3).rated_break_strength == 9e3
    other = line_from_lookup(replace(source(), strength_of="the 1 in line"))
    assert np.isnan(other.rated_break_strength)
    assert "of the 1 in line" in other.notes[-1]


def tether(name, at, value, **changed):
    curve = LineCurve(
        "branch_tension", "strain", at[0], at[-1], at=np.array(at), value=np.array(value),
        branch="ascending",
    )  # fmt: skip
    one = LineSource(name, "a report", "rubber", "tether", "new", 0.026, 3e3, curves=(curve,))
    return replace(one, kind="rubber tether", **changed)


def test_the_straight_start_is_held_against_other_tests_of_the_tether():
    """From 0 0 to 552 N at 1.72 it has 192.6 N at 0.6, where another test has 276 N: 30 % less."""
    line = tether("T-5", [1.72, 2.19], [552.0, 800.0])
    others = [
        line,
        tether("T-2", [0.6, 1.2, 1.8], [276.0, 565.0, 600.0]),
        tether("T-3", [1.0, 1.7], [321.0, 546.0]),
        tether("T-4", [1.8, 2.0], [560.0, 700.0]),
        tether("U-2", [0.6, 1.2], [100.0, 200.0], condition="used"),
    ]
    siblings = siblings_of(line, others)
    assert [one.name for one in siblings] == ["T-2", "T-3", "T-4"]
    notes = line_from_lookup(line, siblings=siblings).notes
    assert len(notes) == 2
    # 552 / 1.72 * 1.2 is 385 N
    assert notes[0].startswith("DOUBTFUL: the straight start is off by -32 percent at strain 1.2")
    assert "T-2 has 565 N" in notes[0]
    assert notes[1].startswith("the straight start is off by -0 percent")
    assert siblings_of(source(), others) == ()
