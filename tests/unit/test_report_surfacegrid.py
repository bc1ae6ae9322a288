"""Planes of a surface: the values of the law, and where the runs say less than at the worst."""

import numpy as np
import pytest
from experiment_views import law_experiment, view_of
from experiments import surface_experiment

from reduction.experiments.surface_points import extremes_in_box
from reduction.report.experiment_tables import negative_inside
from reduction.report.figures.experiment_figures import HELD, _runs_on_plane, make_planes


def law(frequency, mean, amplitude):
    return 1000 + 50 * frequency + 200 * mean - 30 * amplitude + 40 * mean**2


@pytest.fixture(scope="module")
def view():
    return view_of(law_experiment({"apparent_spring_constant": law}, noise=1e-9))


def test_a_plane_has_the_values_of_the_law(view):
    planes = make_planes(view, view.surfaces)
    assert [view.factors[k] for k in planes.across] == ["mean_tension", "tension_amplitude"]
    assert view.factors[planes.held] == "frequency"
    x, y = np.meshgrid(planes.coded, planes.coded)
    for place, level in enumerate(HELD):
        assert planes.value[0, place] == pytest.approx(law(level, x, y), rel=1e-6)


def test_corners_of_the_cube_are_thin_and_no_point_of_the_middle_plane_is(view):
    # three factors in fifteen runs: leverage 1.396 in a corner against 0.75 of the worst run
    planes = make_planes(view, view.surfaces)
    ratio = planes.leverage_ratio[0]
    assert ratio[0, 0, 0] == pytest.approx(1.396 / 0.75, abs=1e-3)
    assert ratio[1].max() == pytest.approx(1.0)
    assert ratio[2].max() == pytest.approx(ratio[0].max())


def test_four_runs_stand_on_each_outer_plane_and_seven_on_the_middle_one(view):
    planes = make_planes(view, view.surfaces)
    assert [int(_runs_on_plane(view, planes, level).sum()) for level in HELD] == [4, 7, 4]


def test_the_extremes_of_a_surface_are_those_of_the_law_within_the_levels(view):
    least, greatest, place = extremes_in_box(view.surfaces)
    # the slope in the mean tension, 200 + 80 x, has no zero between -1 and 1
    assert least[0] == pytest.approx(law(-1, -1, 1), rel=1e-6)
    assert greatest[0] == pytest.approx(law(1, 1, -1), rel=1e-6)
    assert place[0].tolist() == [-1, -1, 1]


def test_a_response_that_cannot_be_negative_is_named_and_its_logarithm_is_not():
    laws = {
        "hysteresis_energy": lambda f, m, a: np.exp(2.5 * a - 2 * m - f),
        "apparent_spring_constant": law,
    }
    found = law_experiment(laws, transforms=[("hysteresis_energy", "log")])
    assert found.surfaces.response_names[-1] == "log_hysteresis_energy"
    assert set(negative_inside(found.surfaces)) == {"hysteresis_energy"}


def test_an_experiment_of_two_factors_has_no_planes():
    view = view_of(surface_experiment())
    pair = type(view)("experiment-0", view.data.isel(factor=slice(2)), 0)
    assert make_planes(pair, view.surfaces) is None
