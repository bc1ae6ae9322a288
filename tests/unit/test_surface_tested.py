"""What counts as tested: levels that runs came near, and what the runs say between them."""

import numpy as np
import pytest

from reduction.experiments.designs import box_behnken
from reduction.experiments.response_surfaces import fit_surfaces
from reduction.experiments.surface_points import (
    _levels_tested,
    evaluate_surfaces,
    greatest_leverage,
    is_within_levels,
)

PLAN = box_behnken(3).coded
REACHED = PLAN * (1 - 1e-3 * np.random.default_rng(3).random(PLAN.shape))


def surfaces(coded, other=None):
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
    found = surfaces(REACHED)
    ends = PLAN[:12]
    alone = evaluate_surfaces(found, ends, units="coded")
    beside = evaluate_surfaces(found, ends, units="coded", plan=PLAN)
    assert alone.above_leverage.any() and not beside.above_leverage.any()
    corner = evaluate_surfaces(found, [[1.0, 1.0, 1.0]], units="coded", plan=PLAN)
    assert corner.above_leverage.all()


def test_the_greatest_leverage_of_a_box_behnken_plan_is_three_quarters():
    # of an edge, against 1/3 of the centre
    assert greatest_leverage(surfaces(PLAN)) == pytest.approx(0.75)
    assert greatest_leverage(surfaces(PLAN), PLAN) == pytest.approx(0.75)


def test_a_response_without_runs_has_no_greatest_leverage():
    greatest = greatest_leverage(surfaces(PLAN, np.full(15, np.nan)))
    assert greatest[0] == pytest.approx(0.75) and np.isnan(greatest[1])


def test_a_plan_of_more_rows_than_runs_is_read_from_its_first():
    longer = np.vstack([PLAN, np.full((3, 3), np.nan)])
    assert greatest_leverage(surfaces(REACHED), longer) == pytest.approx(
        greatest_leverage(surfaces(REACHED), PLAN)
    )


def test_points_at_the_ends_of_the_levels_are_within_and_nan_is_not():
    points = [[1.0, -1.0], [1.0 + 1e-6, 0.0], [np.nan, 0.0]]
    assert is_within_levels(points).tolist() == [True, False, False]
    assert is_within_levels(points, allowed=[1e-3, 0.0]).tolist() == [True, True, False]
