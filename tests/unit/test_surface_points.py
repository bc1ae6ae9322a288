"""Points of a plan: the centre, what was run, and the corners, none of them twice."""

import numpy as np
import pytest
import statsmodels.api as sm
from scipy import stats

from reduction.experiments.designs import box_behnken, model_matrix, quadratic_exponents
from reduction.experiments.response_matrix import highest_of_each
from reduction.experiments.response_surfaces import fit_surfaces
from reduction.experiments.surface_points import (
    _levels_tested,
    evaluate_surfaces,
    greatest_leverage,
    is_within_levels,
    plan_points,
)
from reduction.record.errors import DataError


def test_three_factors_have_a_centre_twelve_edges_and_eight_corners():
    found = plan_points(box_behnken(3).coded)
    assert found.kind == ("centre", *["edge midpoint"] * 12, *["corner"] * 8)
    np.testing.assert_array_equal(found.coded[0], 0)
    np.testing.assert_array_equal(found.coded[1:13], box_behnken(3).coded[:12])
    assert set(np.sum(found.coded[1:13] ** 2, axis=1)) == {2}
    assert set(np.sum(found.coded[13:] ** 2, axis=1)) == {3}
    assert found.name[0] == "(0, 0, 0)"
    assert found.name[-1] == "(+1, +1, +1)"


@pytest.mark.parametrize(("factors", "edges"), [(4, 24), (5, 40), (6, 48), (7, 56)])
def test_more_factors_have_the_runs_of_their_design_and_all_corners(factors, edges):
    found = plan_points(box_behnken(factors).coded)
    assert len(found.name) == len(set(found.name)) == 1 + edges + 2**factors
    assert found.kind.count("design point") == edges
    assert found.kind.count("corner") == 2**factors


def test_a_centre_that_was_not_planned_and_a_corner_that_was_stand_once():
    found = plan_points([[1, 1], [-1, 0], [-0.0, 0.5], [0, -1], [1, 1]])
    assert found.name == (
        "(0, 0)", "(-1, 0)", "(0, +0.5)", "(0, -1)", "(-1, -1)", "(-1, +1)", "(+1, -1)", "(+1, +1)",
    )  # fmt: skip
    assert found.kind[1:4] == ("edge midpoint", "design point", "edge midpoint")


def test_the_middle_of_a_face_is_named():
    assert plan_points([[0, 0, -1]]).kind[1] == "face centre"


def test_one_factor_has_a_centre_and_two_ends():
    assert plan_points([[-1], [0], [1]]).kind == ("centre", "corner", "corner")


RUNS = box_behnken(3).coded
EXPONENTS = quadratic_exponents(3)
MATRIX = model_matrix(RUNS, EXPONENTS)
LOW, HIGH = np.array([0.1, 768.0, 320.0]), np.array([0.5, 1920.0, 768.0])


def surfaces(responses, runs=RUNS, **settings):
    values = np.atleast_2d(responses)
    return fit_surfaces(
        runs,
        values,
        factor_names=["frequency", "mean_tension", "tension_amplitude"],
        response_names=[f"y{number}" for number in range(len(values))],
        low=LOW,
        high=HIGH,
        units="coded",
        **settings,
    )


@pytest.fixture
def responses():
    found = np.random.default_rng(4).normal(10, 1, (3, 15))
    found[1, 12] = np.nan
    return found


def test_intervals_are_those_of_statsmodels(responses):
    points = np.random.default_rng(5).uniform(-1, 1, (7, 3))
    found = evaluate_surfaces(surfaces(responses), points, units="coded")
    for row, response in enumerate(responses):
        has = np.isfinite(response)
        other = sm.OLS(response[has], MATRIX[has]).fit()
        frame = other.get_prediction(model_matrix(points, EXPONENTS)).summary_frame(alpha=0.05)
        np.testing.assert_allclose(found.value[row], frame["mean"], rtol=1e-9)
        np.testing.assert_allclose(
            found.fitted_standard_uncertainty[row], frame["mean_se"], rtol=1e-9
        )
        np.testing.assert_allclose(
            found.confidence_interval[row], frame[["mean_ci_lower", "mean_ci_upper"]], rtol=1e-8
        )
        np.testing.assert_allclose(
            found.prediction_interval[row], frame[["obs_ci_lower", "obs_ci_upper"]], rtol=1e-8
        )


def test_simultaneous_intervals_hold_the_whole_surface_as_often_as_they_say():
    rng = np.random.default_rng(6)
    truth = np.arange(1.0, 11.0)
    grid = np.stack(np.meshgrid(*[np.linspace(-1, 1, 7)] * 3), axis=-1).reshape(-1, 3)
    found = evaluate_surfaces(
        surfaces(MATRIX @ truth + rng.normal(size=(1500, 15)), with_tests=False),
        grid,
        units="coded",
    )
    true = model_matrix(grid, EXPONENTS) @ truth

    def held(interval):
        inside = (interval[..., 0] <= true) & (true <= interval[..., 1])
        return inside.all(axis=1).mean()

    assert held(found.simultaneous_interval) >= 0.95
    assert held(found.confidence_interval) < 0.8
    half = np.diff(found.simultaneous_interval, axis=2)[..., 0] / 2
    scheffe = np.sqrt(10 * stats.f.isf(0.05, 10, 5))
    np.testing.assert_allclose(half / found.fitted_standard_uncertainty, scheffe, rtol=1e-9)


def test_corners_of_the_cube_are_inside_and_beyond_what_the_runs_say(responses):
    corners = np.array([[1.0, 1, 1], [1, -1, 1], [0, 1, 1], [0, 0, 0]])
    found = evaluate_surfaces(surfaces(responses[0]), corners, units="coded")
    assert found.is_inside.all()
    assert found.above_leverage[0].tolist() == [True, True, False, False]
    np.testing.assert_allclose(found.variance_factor[0], [1.396, 1.396, 0.75, 1 / 3], atol=5e-4)


def test_points_in_units_and_coded_ones_agree(responses):
    model = surfaces(responses)
    in_units = evaluate_surfaces(model, [[0.2, 1200.0, 600.0]])
    coded = evaluate_surfaces(model, in_units.coded, units="coded")
    np.testing.assert_allclose(in_units.value, coded.value, rtol=1e-12)
    np.testing.assert_allclose(coded.engineering, [[0.2, 1200.0, 600.0]], rtol=1e-12)


def test_the_ends_of_the_range_are_inside_after_the_change_of_units(responses):
    found = evaluate_surfaces(surfaces(responses), [LOW, HIGH])
    assert found.is_inside.all()


def test_a_point_outside_is_refused_with_its_range(responses):
    with pytest.raises(DataError, match=r"1 of 2 points lie outside .* first point 2; found "
                       r"mean_tension = 2000; needed 768 to 1920"):  # fmt: skip
        evaluate_surfaces(surfaces(responses), [[0.2, 1000.0, 500.0], [0.2, 2000.0, 500.0]])


def test_a_point_outside_is_flagged_where_that_is_asked_for(responses):
    found = evaluate_surfaces(surfaces(responses), [[0.2, 2000.0, 500.0]], outside="flag")
    assert found.is_inside.tolist() == [False]
    assert not found.above_leverage.any()
    assert np.isfinite(found.value).all()


def test_values_of_a_logarithm_are_medians_above_nought_with_their_means():
    rng = np.random.default_rng(9)
    log_truth = np.array([0.0, 0.1, 0.2, 0.0, -1.0, 2.0, 0.1, 0, 0, 0.3])
    drawn = np.exp(MATRIX @ log_truth + rng.normal(0, 0.3, (4000, 15)))
    model = surfaces(drawn, transforms="log", with_tests=False)
    found = evaluate_surfaces(model, [[0.0, 0.0, 0.0], [1.0, -1.0, 0.0]], units="coded")
    assert (found.value > 0).all() and (found.confidence_interval > 0).all()
    true = model_matrix([[0.0, 0, 0], [1.0, -1, 0]], EXPONENTS) @ log_truth
    np.testing.assert_allclose(np.median(found.value, axis=0), np.exp(true), rtol=0.02)
    ratio = found.mean_value / found.value
    np.testing.assert_allclose(ratio, np.exp(model.sigma**2 / 2)[:, None] * np.ones(2), rtol=1e-12)
    inside = (found.prediction_interval[..., 0] < np.exp(true + 0.3)) & (
        np.exp(true + 0.3) < found.prediction_interval[..., 1]
    )
    assert inside.mean() > 0.9
    assert "medians" in found.notes[0]


def test_a_response_without_a_surface_stays_without_values(responses):
    responses[0, :7] = np.nan
    responses[2] = MATRIX @ np.ones(10)
    found = evaluate_surfaces(surfaces(responses), [[0.0, 0.5, 0.5]], units="coded")
    assert np.isnan(found.value[0]).all() and np.isnan(found.confidence_interval[0]).all()
    assert np.isfinite(found.value[2]).all() and np.isnan(found.confidence_interval[2]).all()
    assert not found.above_leverage[0].any()


def test_another_specimen_scatters_as_specimens_do():
    rng = np.random.default_rng(13)
    runs, names = np.tile(RUNS, (6, 1)), np.repeat(list("ABCDEF"), 15)
    level = rng.normal(0, 2.0, 6)[np.repeat(np.arange(6), 15)]
    values = 50 + 3 * runs[:, 0] + level + rng.normal(0, 0.1, 90)
    centre = np.zeros((1, 3))
    random = surfaces(values, runs, blocks=names, block_treatment="random")
    found = evaluate_surfaces(random, centre, units="coded")
    half = np.diff(found.prediction_interval[0, 0])[0] / 2
    between = random.blocks.standard_deviation[0]
    assert found.degrees_of_freedom[0] == 5
    assert half == pytest.approx(stats.t.ppf(0.975, 5) * between * np.sqrt(1 + 1 / 6), rel=0.01)
    fixed = evaluate_surfaces(surfaces(values, runs, blocks=names), centre, units="coded")
    assert np.diff(fixed.prediction_interval[0, 0])[0] / 2 < 0.3
    assert "not of another specimen" in fixed.notes[0]


# what counts as tested: levels that runs came near, and what the runs say between them

PLAN = box_behnken(3).coded
REACHED = PLAN * (1 - 1e-3 * np.random.default_rng(3).random(PLAN.shape))


def surfaces_of_tested(coded, other=None):
    return fit_surfaces(
        coded, [np.arange(15.0) ** 2, *([] if other is None else [other])],
        factor_names=["frequency", "mean_tension", "tension_amplitude"],
        response_names=["apparent_spring_constant", "hysteresis_energy"][: 1 + (other is not None)],
        low=[0.1, 768.0, 320.0],
        high=[0.5, 1920.0, 768.0], units="coded",
    )  # fmt: skip


def test_a_run_that_went_elsewhere_leaves_its_plan_untested():
    reached = np.array([[0.9, 0.0], [0.6, -1.0]])
    plan = np.array([[1.0, 0.0], [1.0, -1.0]])
    assert _levels_tested(reached, plan).tolist() == [*reached.tolist(), [1.0, 0.0]]
    assert _levels_tested(reached, np.full((2, 2), np.nan)).tolist() == reached.tolist()


def test_levels_of_the_plan_that_were_nearly_reached_are_not_above_the_leverage_of_the_runs():
    found = surfaces_of_tested(REACHED)
    ends = PLAN[:12]
    alone = evaluate_surfaces(found, ends, units="coded")
    beside = evaluate_surfaces(found, ends, units="coded", plan=PLAN)
    assert alone.above_leverage.any() and not beside.above_leverage.any()
    corner = evaluate_surfaces(found, [[1.0, 1.0, 1.0]], units="coded", plan=PLAN)
    assert corner.above_leverage.all()


def test_the_greatest_leverage_of_a_box_behnken_plan_is_three_quarters():
    # of an edge, against 1/3 of the centre
    assert greatest_leverage(surfaces_of_tested(PLAN)) == pytest.approx(0.75)
    assert greatest_leverage(surfaces_of_tested(PLAN), PLAN) == pytest.approx(0.75)


def test_a_response_without_runs_has_no_greatest_leverage():
    greatest = greatest_leverage(surfaces_of_tested(PLAN, np.full(15, np.nan)))
    assert greatest[0] == pytest.approx(0.75) and np.isnan(greatest[1])


def test_a_plan_of_more_rows_than_runs_is_read_from_its_first():
    longer = np.vstack([PLAN, np.full((3, 3), np.nan)])
    assert greatest_leverage(surfaces_of_tested(REACHED), longer) == pytest.approx(
        greatest_leverage(surfaces_of_tested(REACHED), PLAN)
    )


def test_points_at_the_ends_of_the_levels_are_within_and_nan_is_not():
    points = [[1.0, -1.0], [1.0 + 1e-6, 0.0], [np.nan, 0.0]]
    assert is_within_levels(points).tolist() == [True, False, False]
    assert is_within_levels(points, allowed=[1e-3, 0.0]).tolist() == [True, True, False]


def test_the_top_of_each_curve_is_found_between_places_of_the_grid():
    top = np.array([-1.234, 0.05, 1.9])
    place, height = highest_of_each(lambda x: 3 - (x - top) ** 2, np.linspace(-2, 2, 9), 3)
    np.testing.assert_allclose(place, top, atol=1e-7)
    np.testing.assert_allclose(height[1], 3 - (np.linspace(-2, 2, 9) - 0.05) ** 2)


def test_a_curve_that_only_rises_has_its_top_at_the_end_of_the_grid():
    place, _ = highest_of_each(lambda x: x, np.linspace(0, 1, 5), 1)
    np.testing.assert_allclose(place, [1.0], atol=1e-10)
