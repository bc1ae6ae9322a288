"""Points of a plan: the centre, what was run, and the corners, none of them twice."""

import numpy as np
import pytest

from reduction.experiments.designs import box_behnken
from reduction.experiments.surface_points import plan_points


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
