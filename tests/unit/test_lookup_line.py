"""None"""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from scipy import stats

from reduction.cli.lookup import _shown_levels
from reduction.experiments.designs import box_behnken, model_matrix, quadratic_exponents
from reduction.lines.archive_source import _is_of_mean
from reduction.lines.line_consistency import consistency_warnings
from reduction.lines.line_curve import (
    interval_between_lines,
    own_half_width,
    shared_half_width,
    shared_of,
)
from reduction.lines.line_lookup import _loads_of_line, cycle_loads, look_up, sigma_from_r2
from reduction.lines.line_search import compare_values
from reduction.lines.line_surface import evaluate_surface
from reduction.lines.lookup_product import (
    LEVEL_DIMENSIONS,
    OF_MEAN,
    LineCurve,
    LineSource,
    LineSurface,
)
from reduction.lines.published_source import published_sources
from reduction.record.contributions import Component
from reduction.record.errors import DataError, SettingsError

LOW, HIGH = np.array([0.1, 100.0, 50.0]), np.array([0.5, 300.0, 150.0])
B = np.array([1e4, 100.0, -200.0, 50.0, 300.0, 2000.0, -400.0, 20.0, -10.0, 60.0])
EXPONENTS = quadratic_exponents(3)
DESIGN = box_behnken(3).coded
INVERSE = np.linalg.inv(model_matrix(DESIGN, EXPONENTS).T @ model_matrix(DESIGN, EXPONENTS))
SURFACE = LineSurface(
    "apparent_spring_constant", B, EXPONENTS, LOW, HIGH, INVERSE, 150.0, 5.0, 0.75,
    errata=("X-1",), notes=("r2 is 0.98",),
)  # fmt: skip
LINE = LineSource(
    "rope", "a report", "nylon", "braid", "new", 0.0127, 1000.0,
    factor_names=("frequency", "mean_tension", "tension_amplitude"),
    surfaces={"apparent_spring_constant": SURFACE},
    curves=(
        LineCurve("strain", "tension", 0.0, 400.0, coefficient=np.array([0.0, 1e-3])),
        LineCurve(
            "tangent_modulus", "strain", 0.5, 2.0, at=np.array([0.5, 2.0]),
            value=np.array([1e6, 4e6]), branch="ascending",
        ),
        LineCurve(
            "tangent_modulus", "strain", 0.5, 2.0, at=np.array([0.5, 2.0]),
            value=np.array([0.5e6, 5e6]), branch="descending",
        ),
    ),
    absent={"relaxation_time": "the column is lost"},
)  # fmt: skip
CENTRE = {"frequency": 0.3, "mean_tension": 200.0, "tension_amplitude": 100.0}


def test_the_centre_is_the_first_coefficient_and_a_face_adds_the_square_and_the_slope():
    assert look_up(LINE, "apparent_spring_constant", **CENTRE).value == 1e4
    face = look_up(LINE, "apparent_spring_constant", **(CENTRE | {"frequency": 0.5}))
    assert face.value == pytest.approx(1e4 + 100 + 300)


def test_a_surface_over_strain_is_looked_up_at_strains():
    # of a tether in position control; a slow pull says nothing at a strain
    low, high = np.array([0.1, 0.8, 0.1]), np.array([0.5, 1.4, 0.3])
    surfaces = {
        name: replace(SURFACE, quantity=name, low=low, high=high)
        for name in ("apparent_spring_constant", "hysteresis_energy")
    }
    tether = replace(
        LINE, surfaces=surfaces, factor_names=("frequency", "mean_strain", "strain_amplitude"),
        slow_pulls={"slow pull Q": LINE.curves[0]},
    )  # fmt: skip
    assert set(tether.factor_names) <= LEVEL_DIMENSIONS.keys()
    at = {"frequency": 0.3, "mean_strain": 1.1, "strain_amplitude": 0.2}
    found = look_up(tether, "apparent_spring_constant", **at)
    assert found.value == 1e4
    assert consistency_warnings(tether, "apparent_spring_constant", at) == ()
    heads, (cells,) = _shown_levels(
        {name: np.array([one]) for name, one in at.items()}, 1.0, 1, "si"
    )
    assert [one.split("[")[1] for one in heads] == ["Hz]", "%]", "%]"]
    assert cells[1:] == ["110", "20"]
    with pytest.raises(DataError, match="mean_strain 150 %, tested 80 to 140 %"):
        look_up(tether, "apparent_spring_constant", **(at | {"mean_strain": 1.5}))


def test_intervals_are_those_of_student_with_a_third_of_the_variance_at_the_centre():
    found = look_up(LINE, "apparent_spring_constant", **CENTRE)
    t = 2.570582  # 95 %, two-sided, 5 degrees of freedom
    assert found.surface_high - found.value == pytest.approx(t * 150 / np.sqrt(3), rel=1e-6)
    assert found.high - found.value == pytest.approx(t * 150 * np.sqrt(4 / 3), rel=1e-6)


def test_corners_of_the_cube_are_inside_and_untested():
    corner = {"frequency": 0.5, "mean_tension": 300.0, "tension_amplitude": 150.0}
    found = look_up(LINE, "apparent_spring_constant", **corner)
    assert found.is_inside
    assert found.is_untested
    edge = look_up(LINE, "apparent_spring_constant", **(corner | {"frequency": 0.3}))
    assert not edge.is_untested


def test_outside_is_refused_with_the_range_and_given_with_a_flag():
    beyond = CENTRE | {"mean_tension": 350.0}
    with pytest.raises(DataError, match="mean_tension 350 N, tested 100 to 300 N"):
        look_up(LINE, "apparent_spring_constant", **beyond)
    found = look_up(LINE, "apparent_spring_constant", extrapolate="flag", **beyond)
    assert not found.is_inside
    assert found.value == pytest.approx(1e4 + 1.5 * 2000 - 1.5**2 * 200)


def test_points_are_broadcast_and_loads_come_with_them():
    found = look_up(
        LINE, "apparent_spring_constant", frequency=[[0.1], [0.5]], mean_tension=[150.0, 250.0],
        tension_amplitude=100.0,
    )  # fmt: skip
    assert found.value.shape == (2, 2)
    assert found.peak_tension.tolist() == [[250, 350], [250, 350]]
    assert found.minimum_share[0].tolist() == [0.05, 0.15]
    assert found.errata == ("X-1",)


def test_a_line_that_would_be_pushed_is_refused():
    with pytest.raises(DataError, match="goes slack, .* found 120 N about 100 N"):
        look_up(
            LINE, "apparent_spring_constant", frequency=0.3, mean_tension=100.0,
            tension_amplitude=120.0,
        )  # fmt: skip
    with pytest.raises(DataError, match="an amplitude is negative"):
        cycle_loads(1.0, -1.0, rated_break_strength=1.0)


def test_the_rule_is_60_percent_where_loaded_and_30_where_slack():
    loaded = cycle_loads([500.0, 350.0], [90.0, 260.0], rated_break_strength=1000.0)
    assert loaded.is_above_rule.tolist() == [False, True]
    slack = cycle_loads([140.0, 160.0], [140.0, 160.0], rated_break_strength=1000.0)
    assert slack.is_slack.all()
    assert slack.is_above_rule.tolist() == [False, True]
    unknown = cycle_loads(500.0, 100.0, rated_break_strength=np.nan)
    assert np.isnan(unknown.peak_share)
    assert not unknown.is_above_rule


def test_curves_are_by_their_variable_and_branch():
    assert look_up(LINE, "strain", tension=200.0).value == pytest.approx(0.2)
    assert look_up(LINE, "tangent_modulus", strain=1.25, branch="ascending").value == 2.5e6
    with pytest.raises(SettingsError, match="differs by branch; .* ascending or descending"):
        look_up(LINE, "tangent_modulus", strain=1.25)
    with pytest.raises(DataError, match=r"found strain 2.5; needed 0.5 to 2\. "):
        look_up(LINE, "tangent_modulus", strain=2.5, branch="ascending")
    # beyond points there is nothing to go on with
    outside = look_up(LINE, "tangent_modulus", strain=2.5, branch="ascending", extrapolate="flag")
    assert np.isnan(outside.value)


@pytest.mark.parametrize(
    ("quantity", "levels", "message"),
    [
        ("relaxation_time", CENTRE, "has no relaxation_time: the column is lost"),
        ("loss_factor", CENTRE, "has no loss_factor; needed one of apparent_spring"),
        ("apparent_spring_constant", {"frequency": 0.3}, "needs another variable; found frequency"),
        ("apparent_spring_constant", CENTRE | {"strain": 1.0}, "does not vary with strain"),
        ("strain", {"tension": np.nan}, "tension is not finite"),
    ],
)
def test_what_cannot_be_looked_up_is_told(quantity, levels, message):
    with pytest.raises(SettingsError, match=message):
        look_up(LINE, quantity, **levels)


def test_sigma_of_a_published_surface_follows_from_its_r2():
    rng = np.random.default_rng(5)
    matrix = model_matrix(DESIGN, EXPONENTS)
    runs = matrix @ B + rng.normal(0, 150.0, len(DESIGN))
    fitted, *_ = np.linalg.lstsq(matrix, runs, rcond=None)
    residual = runs - matrix @ fitted
    r2 = 1 - residual @ residual / np.sum((runs - runs.mean()) ** 2)
    assert sigma_from_r2(fitted, r2) == pytest.approx(np.sqrt(residual @ residual / 5), rel=1e-9)
    assert np.isnan(sigma_from_r2(B, 1.0))


def test_a_logarithm_is_brought_back():
    surface = LineSurface(
        "hysteresis_energy", np.log(B[:1]), EXPONENTS[:1], LOW, HIGH, np.eye(1) / 15, 0.1, 14.0,
        0.1, exponent=0.0,
    )  # fmt: skip
    found = evaluate_surface(surface, [[0.3, 200.0, 100.0]])
    assert found.value == pytest.approx(1e4)
    assert found.high / found.value == pytest.approx(found.value / found.low)


def test_points_of_another_number_of_factors_are_refused():
    with pytest.raises(DataError, match="do not pair up with the factors"):
        evaluate_surface(SURFACE, [[0.3, 200.0]])
    with pytest.raises(DataError, match="low does not fit the surface"):
        LineSurface("x", B, EXPONENTS, LOW[:2], HIGH, INVERSE, 1.0, 5.0, 0.75)


def test_the_intervals_say_of_what_they_are():
    surface = look_up(LINE, "apparent_spring_constant", **CENTRE)
    assert surface.interval_of == "one more run of the same specimens"
    assert surface.surface_interval_of == "the surface of these specimens"
    assert np.isnan(surface.line_low)
    curve = look_up(LINE, "strain", tension=200.0)
    assert (curve.interval_of, curve.surface_interval_of) == ("", "")
    assert np.isnan(curve.low)


def test_a_curve_of_one_test_has_students_interval_of_its_cycles_and_no_other():
    measured = LineCurve(
        "tangent_modulus", "strain", 0.0, 2.0, at=np.array([0.0, 1.0, 2.0]),
        value=np.array([1e6, 2e6, 3e6]), standard_uncertainty=np.full(3, 1e4),
        degrees_of_freedom=np.full(3, 5.0), spread_of="the mean over the cycles of this one test",
    )  # fmt: skip
    found = look_up(replace(LINE, curves=(measured,)), "tangent_modulus", strain=1.5)
    assert found.surface_high - found.value == pytest.approx(2.570582 * 1e4, rel=1e-6)
    assert np.isnan(found.high)
    assert np.isnan(found.line_high)
    assert found.surface_interval_of == "the mean over the cycles of this one test"
    assert any("scatter between specimens is not included" in note for note in found.notes)


def test_what_lies_between_two_measured_bins_is_outside():
    measured = LineCurve(
        "strain", "tension", 0.0, 400.0, at=np.array([0.0, 100.0, 300.0, 400.0]),
        value=np.array([0.0, 0.1, 0.3, 0.4]), gaps=np.array([[100.0, 300.0]]),
    )  # fmt: skip
    line = replace(LINE, curves=(measured,))
    assert look_up(line, "strain", tension=[100.0, 300.0, 350.0]).is_inside.all()
    with pytest.raises(DataError, match="needed 0 to 400 N, nothing between 100 and 300"):
        look_up(line, "strain", tension=[50.0, 200.0])
    flagged = look_up(line, "strain", tension=200.0, extrapolate="flag")
    assert not flagged.is_inside
    assert flagged.value == pytest.approx(0.2)


def test_where_two_pieces_meet_both_values_are_told():
    pieces = LineCurve(
        "tangent_modulus", "strain", 0.0, 2.0, at=np.array([0.0, 1.0, 1.0, 2.0]),
        value=np.array([1e6, 1e6, 2e6, 2e6]), branch="ascending",
    )  # fmt: skip
    line = replace(LINE, curves=(pieces,))
    # one branch alone is known: it need not be asked for, and the value says which
    found = look_up(line, "tangent_modulus", strain=1.0)
    assert found.branch == "ascending"
    assert "at strain 1 two pieces meet: 1000000 Pa below, 2000000 above" in found.notes
    assert not any(
        "two pieces" in one for one in look_up(line, "tangent_modulus", strain=0.9).notes
    )


def test_both_choices_of_the_levels_are_in_the_intervals():
    other = (np.array([0.1, 110.0, 50.0]), np.array([0.5, 330.0, 150.0]))
    open_levels = replace(SURFACE, alternative_boxes=(other,))
    line = replace(LINE, surfaces={"apparent_spring_constant": open_levels})
    found = look_up(line, "apparent_spring_constant", **CENTRE)
    one, two = (
        evaluate_surface(replace(SURFACE, low=low, high=high), [[0.3, 200.0, 100.0]])
        for low, high in ((LOW, HIGH), other)
    )
    assert found.value == one.value
    # 200 N is the centre of the one box, and (200 - 220)/110 of the other
    coded = -20 / 110
    assert two.value == pytest.approx(1e4 + 2000 * coded - 200 * coded**2)
    assert found.low == min(one.low, two.low)
    assert found.high == max(one.high, two.high)
    assert found.surface_low == two.surface_low


def test_a_level_within_the_rounding_of_its_print_is_inside():
    rounded = replace(SURFACE, rounding=np.array([0.0, 0.5, 0.5]))
    line = replace(LINE, surfaces={"apparent_spring_constant": rounded})
    at = CENTRE | {"mean_tension": [99.5, 300.5], "tension_amplitude": 90.0}
    assert look_up(line, "apparent_spring_constant", **at).is_inside.all()
    with pytest.raises(DataError, match="mean_tension 300.6 N, tested 100 to 300 N"):
        look_up(line, "apparent_spring_constant", **(CENTRE | {"mean_tension": 300.6}))
    with pytest.raises(DataError, match="rounding does not fit the surface"):
        replace(SURFACE, rounding=np.zeros(2))


@pytest.mark.parametrize(
    ("quantity", "levels", "message"),
    [
        ("apparent_spring_constant", CENTRE | {"frequency": "0.3"}, "frequency is not a real number"),
        ("apparent_spring_constant", CENTRE | {"frequency": 0.3 + 1j}, "frequency is not a real nu"),
        ("apparent_spring_constant", CENTRE | {"frequency": [[1.0], [1, 2]]}, "not a real number"),
        ("apparent_spring_constant", CENTRE | {"frequency": -0.3}, "not positive; found -0.3 Hz"),
        ("apparent_spring_constant", CENTRE | {"frequency": 0.0}, "a frequency is not positive"),
        (
            "apparent_spring_constant", CENTRE | {"frequency": [0.1, 0.2], "mean_tension": [1.0] * 3},
            "levels do not pair up; found frequency of shape",
        ),
        ("apparent_spring_constant", CENTRE | {"branch": "ascending"}, "does not differ by branch"),
        ("strain", {"tension": 1.0, "branch": "ascending"}, "does not differ by branch; found asc"),
        ("strain", {"tension": 1.0, "mean_tension": 2.0}, "does not vary with mean_tension"),
        ("strain", {"tension": 1.0, "frequency": 3.0}, "does not vary with frequency"),
    ],
)  # fmt: skip
def test_levels_that_say_nothing_of_the_quantity_are_refused(quantity, levels, message):
    with pytest.raises(SettingsError, match=message):
        look_up(LINE, quantity, extrapolate="flag", **levels)


def test_a_damping_has_no_branch():
    parts = {
        name: replace(SURFACE, quantity=name)
        for name in ("dissipation_spring_constant", "relaxation_time")
    }
    line = replace(LINE, surfaces=parts)
    with pytest.raises(SettingsError, match="dashpot_coefficient of rope does not differ by br"):
        look_up(line, "dashpot_coefficient", branch="ascending", **CENTRE)


# ends of a cycle with every look-up, the rule of ropes, and the tether that must not go slack

LBF = 4.4482216152605
POINTS = np.array([0.2, 1.0, 2.0])


def curve(quantity, value, branch):
    return LineCurve(quantity, "strain", 0.2, 2.0, at=POINTS, value=np.array(value), branch=branch)


SURFACE_OF_LOADS = LineSurface(
    "apparent_spring_constant", np.array([1e3]), np.array([[0, 0, 0]]), np.array([0.1, 10.0, 5.0]),
    np.array([0.5, 100.0, 100.0]), np.eye(1) / 15, 0.1, 14.0, 1.0,
)  # fmt: skip
TETHER = LineSource(
    "made tether", "synthetic", "Natsyn rubber (synthetic)", "", "new", 0.026, 1000.0,
    factor_names=("frequency", "mean_tension", "tension_amplitude"),
    surfaces={"apparent_spring_constant": SURFACE_OF_LOADS},
    curves=(
        curve("tangent_modulus", [1e6, 1e6, 3e6], "ascending"),
        curve("branch_tension", [100.0, 500.0, 800.0], "ascending"),
        curve("tangent_modulus", [1e6, 1e6, 3e6], "descending"),
        curve("branch_tension", [0.0, 300.0, 800.0], "descending"),
    ),
    kind="rubber tether",
)  # fmt: skip
ROPE = LineSource(
    "made rope", "synthetic", "nylon", "", "new", 0.026, 1000.0, curves=TETHER.curves[2:],
    kind="rope",
)  # fmt: skip


def test_a_modulus_comes_with_the_tension_of_its_own_branch():
    found = look_up(TETHER, "tangent_modulus", strain=[1.0, 1.5], branch="ascending")
    assert found.peak_tension.tolist() == [500.0, 650.0]
    assert found.minimum_share.tolist() == [0.5, 0.65]
    other = look_up(TETHER, "tangent_modulus", strain=1.0, branch="descending")
    assert other.peak_share == 0.3
    assert (found.branch, other.branch) == ("ascending", "descending")


def test_one_tension_alone_is_both_ends():
    line = published_sources()["nylon-double-braid-0.5in-new"]
    found = look_up(line, "quasi_static_spring_constant", mean_tension=0.21 * 6400 * LBF)
    assert found.peak_share == pytest.approx(0.21)
    assert found.minimum_share == pytest.approx(0.21)
    assert look_up(line, "strain", tension=640 * LBF).peak_share == pytest.approx(0.1)


def test_a_tether_that_reaches_zero_tension_is_refused():
    with pytest.raises(DataError, match="made tether goes slack at 1 of 2 points"):
        look_up(TETHER, "tangent_modulus", strain=[0.2, 1.0], branch="descending")
    cycle = {"frequency": 0.3, "mean_tension": 50.0}
    assert look_up(TETHER, "apparent_spring_constant", tension_amplitude=49.0, **cycle).value == 1e3
    with pytest.raises(DataError, match="minimum tension of zero, peak 100 N"):
        look_up(TETHER, "apparent_spring_constant", tension_amplitude=50.0, **cycle)
    with pytest.raises(DataError, match="above their mean tension"):
        look_up(TETHER, "apparent_spring_constant", tension_amplitude=51.0, **cycle)


def test_a_rope_may_go_slack_and_has_the_rule_for_it():
    found = look_up(ROPE, "tangent_modulus", strain=0.2, branch="descending")
    assert found.peak_tension == 0
    loads = _loads_of_line(
        ROPE, {"mean_tension": np.array([150.0, 180.0]), "tension_amplitude": np.array(150.0)}, (2,)
    )
    # 300 N of 1,000 N from zero is allowed; 330 N from 30 N is always loaded
    assert loads.is_slack.tolist() == [True, False]
    assert not loads.is_above_rule.any()
    above = {"mean_tension": np.array(151.0), "tension_amplitude": np.array(151.0)}
    assert _loads_of_line(ROPE, above, ()).is_above_rule


def test_the_rule_of_fibres_is_not_that_of_rubber():
    assert "60 %" in ROPE.rule
    assert TETHER.rule == "a rubber tether must not go slack (WHOI-2005-10, sec. 2.3.2)"
    # 80 % of the break strength
    found = look_up(TETHER, "branch_tension", strain=2.0, branch="ascending")
    assert found.peak_share == 0.8
    assert not found.is_above_rule


def test_what_is_a_tether_is_said_by_its_kind_else_by_its_material():
    def line(material, kind):
        return LineSource("a", "s", material, "", "", 0.02, 1.0, kind=kind)

    assert line("Natsyn Rubber", "").is_tether
    assert line("", "rubber tether").is_tether
    assert not line("nylon", "").is_tether
    # the cords of a hose carry when it is stretched, and a hose lies slack on the water
    assert not line("rubber", "stretch hose").is_tether


def test_noise_below_zero_is_zero_and_beyond_the_points_nothing_is_known():
    noisy = LineSource(
        "made rope", "synthetic", "nylon", "", "", 0.02, 1000.0,
        curves=(curve("branch_tension", [-2.0, 300.0, 800.0], "ascending"),),
    )  # fmt: skip
    found = look_up(
        noisy, "branch_tension", strain=[0.2, 1.0, 3.0], branch="ascending", extrapolate="flag"
    )
    assert found.value[0] == -2
    assert found.peak_tension[:2].tolist() == [0.0, 300.0]
    assert np.isnan(found.peak_tension[2])
    assert np.isnan(found.peak_share[2])
    assert not found.is_above_rule[2]


def test_a_tether_beyond_its_points_is_not_known_to_be_slack():
    found = look_up(
        TETHER, "tangent_modulus", strain=[1.0, 2.5], branch="ascending", extrapolate="flag"
    )
    assert found.is_inside.tolist() == [True, False]
    assert found.peak_tension[0] == 500
    assert np.isnan(found.peak_tension[1])


def test_a_negative_tension_is_refused():
    line = published_sources()["nylon-double-braid-0.5in-new"]
    with pytest.raises(DataError, match="mean_tension is negative; found -5 N"):
        look_up(line, "quasi_static_spring_constant", mean_tension=-5.0, extrapolate="flag")


def test_published_tethers_have_their_share_of_the_break_strength():
    # WHOI-2005-10, Table 6, T-2 new: 62 lb at 60 % and 127 lb at 120 %, of 800 lb
    found = look_up(
        published_sources()["rubber-tether-new-T-2"], "tangent_modulus", strain=[0.6, 0.9],
        branch="ascending",
    )  # fmt: skip
    assert found.peak_share == pytest.approx([62 / 800, (62 + 127) / 2 / 800])


def test_between_slack_and_three_percent_nothing_was_tested_and_the_lower_share_holds():
    # sec. 5.0: 62 % with a minimum of 3 % did no harm, above 30 % from zero it did
    mean = np.array([290.0, 290.0, 310.0, 120.0])
    amplitude = np.array([290.0, 289.99, 280.0, 120.0])
    found = look_up(
        replace(ROPE, surfaces={"apparent_spring_constant": SURFACE_OF_LOADS}, factor_names=TETHER.factor_names),
        "apparent_spring_constant", extrapolate="flag", frequency=0.3, mean_tension=mean,
        tension_amplitude=amplitude,
    )  # fmt: skip
    assert found.is_slack.tolist() == [True, False, False, True]
    # 580 N from 0 and from 0.01 N; 590 N from 30 N; 240 N from 0 is allowed, and is a snap load
    assert found.is_above_rule.tolist() == [True, True, False, False]
    assert any("snap load" in note for note in found.notes)


def test_an_old_line_is_judged_by_the_strength_it_has():
    # Table 10: polyester braid of five years breaks at 3,241 lb; its levels are shares of 7,000 lb
    line = published_sources()["polyester-double-braid-0.5in-5-years"]
    found = look_up(
        line, "apparent_spring_constant", frequency=0.3, mean_tension=2100 * LBF,
        tension_amplitude=840 * LBF,
    )  # fmt: skip
    assert found.peak_share == pytest.approx(0.42)
    assert found.own_peak_share == pytest.approx(2940 / 3241)
    assert found.own_minimum_share == pytest.approx(1260 / 3241)
    assert found.is_above_rule
    at = {"mean_tension": 1200 * LBF, "tension_amplitude": 744 * LBF}
    # 1,944 lb is 59.98 % of 3,241 lb
    assert not look_up(line, "apparent_spring_constant", frequency=0.3, **at).is_above_rule
    new = published_sources()["polyester-double-braid-0.5in-new"]
    same = look_up(new, "apparent_spring_constant", frequency=0.3, **at)
    assert same.own_peak_share == same.peak_share


def test_the_rule_of_nylon_is_taken_over_and_says_so():
    lines = published_sources()
    assert "taken over" not in lines["nylon-double-braid-0.5in-new"].rule
    assert "taken over for polyester" in lines["polyester-double-braid-0.5in-new"].rule
    hose = replace(lines["polyester-double-braid-0.5in-new"], kind="stretch hose")
    assert "taken over for a specimen of the kind stretch hose" in hose.rule


def test_a_surface_over_the_share_of_the_mean_is_asked_with_a_load():
    # K = 2000 + 500 x over amplitudes of 20 to 40 % of the mean: 35 % of 1 kN is x = 0.5
    surface = LineSurface(
        "apparent_spring_constant", np.array([2000.0, 500.0]), np.array([[0, 0], [0, 1]]),
        np.array([500.0, 0.2]), np.array([1500.0, 0.4]), np.eye(2) / 15, 1.0, 13.0, 1.0,
    )  # fmt: skip
    line = replace(
        ROPE, factor_names=("mean_tension", OF_MEAN), curves=(),
        surfaces={"apparent_spring_constant": surface},
    )  # fmt: skip
    found = look_up(line, "apparent_spring_constant", mean_tension=1000.0, tension_amplitude=350.0)
    assert float(found.value) == pytest.approx(2250)
    assert float(found.peak_share) == pytest.approx(1.35)
    with pytest.raises(DataError, match="tension_amplitude_over_mean 80 %, tested 20 to 40 %"):
        look_up(line, "apparent_spring_constant", mean_tension=1000.0, tension_amplitude=800.0)


def test_amplitudes_of_runs_that_are_shares_of_their_mean_are_known_as_such():
    mean, share = np.array([[1000.0, 2000.0, np.nan]]), np.array([[0.2, 0.4, 0.3]])
    runs = {"run_mean_tension": ("e", "r"), "run_tension_amplitude": ("e", "r")}
    for of, is_share in ((mean, True), (np.full((1, 3), 5000.0), False)):
        stored = xr.Dataset(
            {"run_level": (("e", "r", "f"), share[..., None])}
            | {name: (dims, value) for (name, dims), value in zip(
                runs.items(), (mean, share * of), strict=True)}
        )  # fmt: skip
        assert _is_of_mean(stored, 0, 0, "tension_amplitude") is is_share
        assert not _is_of_mean(stored, 0, 0, "mean_tension")


# what look-ups of two quantities share is put together by its sign before it is squared

DESIGN_OF_PARTS = model_matrix(box_behnken(3).coded, EXPONENTS)
INVERSE_OF_PARTS = np.linalg.inv(DESIGN_OF_PARTS.T @ DESIGN_OF_PARTS)
CELL, CLOCK = Component("tension_gain", "cell"), Component("lag", "clock")
AT = {"frequency": [0.2, 0.4], "mean_tension": 150.0, "tension_amplitude": 70.0}


def surface(quantity, coefficient, rows, component, *, sigma=0.0, exponent=1.0):
    return LineSurface(
        quantity, coefficient, EXPONENTS, LOW, HIGH, INVERSE_OF_PARTS, sigma, 5.0, 0.75, exponent,
        component=component, contribution=rows,
    )  # fmt: skip


def line(*surfaces):
    return LineSource(
        "rope", "a report", "nylon", "braid", "new", 0.0127, 1000.0,
        factor_names=("frequency", "mean_tension", "tension_amplitude"),
        surfaces={one.quantity: one for one in surfaces},
    )  # fmt: skip


NAME = "apparent_spring_constant"


def test_a_gain_of_all_runs_is_that_share_of_the_value_at_every_point():
    found = look_up(line(surface(NAME, B, -0.02 * B[None], (CELL,))), NAME, **AT)
    assert found.component == (CELL,)
    assert found.contribution == pytest.approx(-0.02 * found.value[None])
    assert found.surface_high - found.value == pytest.approx(1.95996 * 0.02 * found.value, rel=1e-5)
    # nothing scatters here: all of it is shared
    assert own_half_width(found, "surface_high") == pytest.approx(0.0, abs=1e-3)


def test_on_a_logarithm_it_is_the_same_share():
    logs = np.append(np.log(1e4), np.full(9, 0.1))
    rows = np.append(np.log1p(0.02), np.zeros(9))[None]
    found = look_up(line(surface(NAME, logs, rows, (CELL,), exponent=0.0)), NAME, **AT)
    # half of 1.02 less 1/1.02: to the second order of the gain
    assert found.contribution == pytest.approx(0.02 * found.value[None], rel=0.011)


def test_what_is_of_a_value_alone_is_the_interval_without_it():
    found = look_up(line(surface(NAME, B, 0.02 * B[None], (CELL,), sigma=150.0)), NAME, **AT)
    alone = look_up(line(surface(NAME, B, np.empty((0, 10)), (), sigma=150.0)), NAME, **AT)
    for end in ("high", "surface_high"):
        expected = getattr(alone, end) - alone.value
        assert own_half_width(found, end) == pytest.approx(expected)
    assert own_half_width(alone, "low") == pytest.approx(alone.value - alone.low)
    assert shared_half_width(found.contribution) == pytest.approx(1.96 * 0.02 * found.value)
    # far outside, the limits of a logarithm overflow: no end, and no parts
    end, parts = np.full(found.value.shape, np.inf), np.full(found.value.shape, np.nan)
    far = replace(found, high=end, run_standard_uncertainty=parts)
    np.testing.assert_array_equal(own_half_width(far, "high"), end)
    assert own_half_width(far, "low") == pytest.approx(found.value - found.low)


def test_a_surface_beside_a_load_cell_has_the_factor_of_all_its_degrees_of_freedom():
    """As large a part of five degrees of freedom as of a load cell: 20 of them, 2.086."""
    # in the middle of the design a third of the variance of a run
    random = 150.0 / np.sqrt(3)
    row = np.append(random, np.zeros(9))[None]
    found = look_up(
        line(surface(NAME, B, row, (CELL,), sigma=150.0)), NAME,
        frequency=0.3, mean_tension=200.0, tension_amplitude=100.0,
    )  # fmt: skip
    half = 2.0859634 * np.sqrt(2) * random
    assert found.surface_high - found.value == pytest.approx(half, rel=1e-7)
    assert found.value - found.surface_low == pytest.approx(half, rel=1e-7)
    # of a run four times the variance: (4 + 1)^2 / (16 / 5) = 7.8125, 2.3161 by the t table between
    t = stats.t.ppf(0.975, 7.8125)
    assert found.high - found.value == pytest.approx(t * np.sqrt(5) * random, rel=1e-9)


def test_a_reading_of_two_degrees_of_freedom_takes_them_into_a_surface():
    diameter = Component("diameter", "line", degrees_of_freedom=2.0)
    found = look_up(line(surface(NAME, B, 0.02 * B[None], (diameter,))), NAME, **AT)
    # Student's t of two
    half = 4.30265 * 0.02 * found.value
    assert found.surface_high - found.value == pytest.approx(half, rel=1e-5)


def test_two_surfaces_under_one_cell_differ_by_what_is_of_each_alone():
    """The load cell falls out; five degrees of freedom each are ten."""
    row = np.append(500.0, np.zeros(9))[None]
    one = look_up(line(surface(NAME, B, row, (CELL,), sigma=150.0)), NAME, **AT)
    found = compare_values(one, one)
    h = np.asarray(
        evaluate_surface(
            surface(NAME, B, row, (CELL,), sigma=150.0), [[0.2, 150.0, 70.0], [0.4, 150.0, 70.0]]
        ).leverage
    )
    assert found.surface_high == pytest.approx(2.2281389 * 150 * np.sqrt(2 * h), rel=1e-6)
    assert found.high == pytest.approx(2.2281389 * 150 * np.sqrt(2 * (1 + h)), rel=1e-6)


def test_what_k_1_gains_and_tau_loses_leaves_their_product():
    spring = surface("dissipation_spring_constant", B, np.stack([0.02 * B, 0.05 * B]), (CELL, CLOCK))  # fmt: skip
    tau = np.append(1.5, np.zeros(9))
    one = line(spring, surface("relaxation_time", tau, -0.05 * tau[None], (CLOCK,)))
    found = look_up(one, "dashpot_coefficient", **AT)
    # the lag moves K_1 up and tau down by 5 %: only the gain is left
    rows = dict(zip(found.component, found.contribution, strict=True))
    assert rows[CELL] == pytest.approx(0.02 * found.value)
    assert rows[CLOCK] == pytest.approx(0.0, abs=1e-9)
    assert found.surface_high - found.value == pytest.approx(1.96 * 0.02 * found.value, rel=1e-4)
    together = shared_of({name: look_up(one, name, **AT) for name in one.surfaces})
    assert together.component == tuple(sorted((CELL, CLOCK)))
    place = together.component.index(CELL)
    assert together.values["relaxation_time"][place].tolist() == [0.0, 0.0]


def test_contributions_without_their_errors_are_refused():
    with pytest.raises(DataError, match="do not pair up.*found 1 rows; needed 0"):
        surface(NAME, B, B[None], ())
    assert replace(surface(NAME, B, B[None], (CELL,)), sigma=1.0).component == (CELL,)


# intervals of the kind and of another specimen: by hand, and against lines that were drawn

K_AP = "apparent_spring_constant"
T_5 = 2.570582  # 95 %, two-sided, 5 degrees of freedom


def at_centre(name):
    line = published_sources()[name]
    surface = line.surfaces[K_AP]
    middle = (surface.low + surface.high) / 2
    return look_up(line, K_AP, **dict(zip(line.factor_names, middle, strict=True)))


@pytest.mark.parametrize(
    ("name", "share", "n_lines"),
    # sec. 4.4.1; lines of Tables 3 and 5
    [
        ("nylon-double-braid-0.5in-new", 0.1, 3),
        ("polyester-double-braid-0.5in-5-years", 0.5, 2),
        # not printed: two, the fewest of any
        ("nylon-double-braid-1in-new", 0.1, 2),
    ],
)
def test_another_line_is_as_far_as_the_report_says(name, share, n_lines):
    found = at_centre(name)
    own = np.log(1 + share**2)
    run = (found.high - found.value) / found.value
    another = np.sqrt(T_5**2 * own * (1 + 1 / n_lines) + run**2)
    assert np.log(found.line_high / found.value) == pytest.approx(another, rel=1e-6)
    of_mean = (found.surface_high - found.value) / found.value
    kind = np.sqrt(T_5**2 * own / n_lines + of_mean**2)
    assert np.log(found.kind_high / found.value) == pytest.approx(kind, rel=1e-6)
    assert 0 < found.line_low < found.low < found.value < found.high < found.line_high
    assert found.line_low < found.kind_low < found.kind_high < found.line_high
    assert found.interval_of == "one more run of the same specimens"
    assert any(
        f"by about {100 * share:.0f} % (CG-D-39-80, sec. 4.4.1): " in one for one in found.notes
    )


def test_the_scatter_between_lines_is_that_of_one_quantity():
    line = published_sources()["nylon-double-braid-0.5in-new"]
    levels = {"frequency": 0.3, "mean_tension": 1344 * LBF, "tension_amplitude": 544 * LBF}
    found = look_up(line, "hysteresis_energy", **levels)
    assert np.isnan(found.line_high)
    assert np.isnan(found.kind_low)
    assert np.isfinite(found.high)
    assert any("scatter between specimens is not included" in one for one in found.notes)


def test_ninety_five_of_a_hundred_lines_that_were_drawn_are_inside():
    """The scatter is known: very many degrees of freedom; lines of a factor, normal in its log."""
    rng = np.random.default_rng(3)
    size, n_lines, share = 20_000, 3, 0.5
    sigma = np.sqrt(np.log(1 + share**2))
    tested = np.exp(rng.normal(0, sigma, (size, n_lines)).mean(axis=1))
    another = np.exp(rng.normal(0, sigma, size))
    ends = [
        interval_between_lines(
            tested, tested, tested, line_scatter=share, n_lines=n_lines, degrees_of_freedom=1e9,
            is_another=is_another,
        )
        for is_another in (True, False)
    ]  # fmt: skip
    covered = [
        np.mean((low < x) & (x < high)) for (low, high), x in zip(ends, (another, 1.0), strict=True)
    ]
    assert covered == pytest.approx([0.95, 0.95], abs=3 * np.sqrt(0.05 * 0.95 / size))


def test_what_is_not_above_zero_has_no_share():
    value = np.array([-1.0, 0.0, 1.0])
    low, high = interval_between_lines(
        value, value - 0.1, value + 0.1, line_scatter=0.1, n_lines=2, degrees_of_freedom=5,
        is_another=True,
    )  # fmt: skip
    assert np.isnan(low[:2]).all()
    assert np.isfinite(high).tolist() == [False, False, True]


def test_it_is_never_narrower_than_what_it_is_made_from():
    # exp(-0.9) is 0.41: the lower limit of one more run is farther out
    value, low, high = np.array([1.0]), np.array([0.1]), np.array([1.9])
    found = interval_between_lines(
        value, low, high, line_scatter=0.1, n_lines=3, degrees_of_freedom=5, is_another=True
    )
    assert found[0] == low
    assert found[1] > high
