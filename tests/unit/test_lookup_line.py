from dataclasses import replace

import numpy as np
import pytest

from reduction.cli.lookup import _shown_levels
from reduction.experiments.designs import box_behnken, model_matrix, quadratic_exponents
from reduction.lines.line_consistency import consistency_warnings
from reduction.lines.line_lookup import cycle_loads, look_up, sigma_from_r2
from reduction.lines.line_surface import evaluate_surface
from reduction.lines.lookup_product import LEVEL_DIMENSIONS, LineCurve, LineSource, LineSurface
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
