"""Figures of an experiment: each is one that plotly takes, synthetic where the data are."""

import json
from dataclasses import replace

import numpy as np
import plotly.graph_objects as go
import pytest
from experiment_views import law_experiment, view_of
from experiments import screening_experiment, surface_experiment

from reduction.experiments.response_surfaces import fit_surfaces
from reduction.experiments.surface_points import extremes_in_box
from reduction.report.campaign_sections import _make_experiment_section
from reduction.report.experiment_tables import negative_inside
from reduction.report.figures.experiment_figures import (
    HELD,
    _runs_on_plane,
    draw_checks,
    draw_contours,
    draw_effects,
    draw_forms,
    draw_single_time,
    draw_surface,
    make_planes,
)
from reduction.stages.three_parameter_line.line_model import check_single_time

EVERYTHING = (
    surface_experiment(),
    surface_experiment("blocks", seed=9, specimens=("a", "b"), treatment="random", missing=(2,)),
    screening_experiment(),
)


def law(frequency, mean, amplitude):
    return 1000 + 50 * frequency + 200 * mean - 30 * amplitude + 40 * mean**2


def figures_of(parts):
    for part in parts:
        yield from part.figures
        if part.folded is not None:
            yield from part.folded.figures


@pytest.fixture(scope="module")
def lawful():
    return view_of(law_experiment({"apparent_spring_constant": law}, noise=1e-6))


@pytest.mark.parametrize(
    ("units", "index"),
    [
        *(("si", index) for index in range(3)),
        ("us", 0),
        *(pytest.param("us", index, marks=pytest.mark.nightly) for index in (1, 2)),
    ],
)
@pytest.mark.slow
def test_every_figure_is_one_that_plotly_takes_and_says_it_is_synthetic(index, units):
    view = view_of(*EVERYTHING, index=index, units=units)
    figures = list(figures_of(_make_experiment_section(view, {}).parts))
    assert len(figures) >= 2
    assert len({figure.key for figure in figures}) == len(figures)
    for figure in figures:
        document = json.loads(figure.json())
        go.Figure(document)
        assert figure.has_data, figure.key
        assert figure.layout["title"]["subtitle"]["text"] == "SYNTHETIC DATA"
        assert figure.label.startswith("Synthetic data. ")
        assert all("name" in trace and "y" in trace for trace in figure.data), figure.key


def test_data_that_are_measured_are_not_called_synthetic():
    view = view_of(surface_experiment(), synthetic="no")
    section = _make_experiment_section(view, {})
    tables = [table for part in section.parts for table in part.tables]
    assert not any(figure.synthetic for figure in figures_of(section.parts))
    assert not any("SYNTHETIC" in table.caption for table in tables)


def test_the_surface_in_space_has_its_runs_with_their_distances(lawful):
    (figure,) = draw_surface(lawful, lawful.surfaces, 0, make_planes(lawful, lawful.surfaces))
    surface, stems, runs = figure.data
    assert np.shape(surface["z"]) == (31, 31)
    assert len(runs["z"]) == 7
    assert stems["z"][0] == pytest.approx(runs["z"][0])
    assert stems["z"][2] is None
    assert "mean tension [N]" in figure.label


def test_contours_share_a_scale_and_veil_where_the_runs_say_less(lawful):
    figures = draw_contours(lawful, lawful.surfaces, 0, make_planes(lawful, lawful.surfaces))
    assert len({(f.data[0]["zmin"], f.data[0]["zmax"]) for f in figures}) == 1
    veiled = ["runs say little" in [trace["name"] for trace in f.data] for f in figures]
    assert veiled == [True, False, True]
    assert ["Grey" in f.caption for f in figures] == veiled
    # the runs of the centre have one label, at one place, and each is named to the pointer
    labels = [one["text"] for one in figures[1].layout["annotations"]]
    assert [text for text in labels if "," in text] == ["R13, R14, R15"]
    assert {"R13", "R14", "R15"} <= set(figures[1].data[-1]["text"])
    assert all("bgcolor" in one for one in figures[1].layout["annotations"])
    assert all(figure.title.startswith(f"{lawful.name}: ") for figure in figures)


def test_residuals_stand_in_the_order_in_which_the_tests_were_made(lawful):
    backward = {name: 15 - k for k, name in enumerate(lawful.runs)}
    for order, first in ((backward, 15), ({}, 1)):
        figure = next(
            one for one in draw_checks(lawful, lawful.surfaces, 0, order) if "order" in one.key
        )
        assert figure.data[1]["x"][0] == first
        assert ("in the order the tests were made" in figure.caption) == bool(order)


def test_a_response_without_a_surface_has_a_reason_and_no_figure():
    result = law_experiment({"apparent_spring_constant": law, "relaxation_time": law})
    runs = result.runs
    few = runs.response.copy()
    few[1, 5:] = np.nan
    surfaces = fit_surfaces(
        runs.level, few, factor_names=result.factor_names, response_names=result.response_names,
        low=result.low, high=result.high, run_names=runs.names,
    )  # fmt: skip
    view = view_of(
        replace(result, runs=replace(runs, response=few), surfaces=surfaces, shared=None)
    )
    (part,) = [
        p for p in _make_experiment_section(view, {}).parts if p.heading == "Relaxation time"
    ]
    assert part.figures == ()
    assert part.sentences == ("No surface: fewer runs with a value than terms.",)


def test_lines_of_one_time_and_of_inverse_frequency_cross_in_the_middle_of_the_runs():
    plain = surface_experiment()
    time = 2 + np.zeros(15)
    runs = replace(plain.runs, response=np.vstack([
        time if name == "relaxation_time" else row
        for name, row in zip(plain.response_names, plain.runs.response, strict=True)
    ]))  # fmt: skip
    noise = 1 + 1e-3 * np.cos(np.arange(15))
    check = check_single_time(runs.frequency, time * noise, 1 / time)
    (figure,) = draw_single_time(view_of(replace(plain, runs=runs, single_time=check)), {})
    level, falling = figure.data[:2]
    assert level["y"] == pytest.approx([2, 2])
    ratio = falling["x"][1] / falling["x"][0]
    assert falling["y"][0] / falling["y"][1] == pytest.approx(ratio, rel=1e-4)
    assert figure.layout["xaxis"]["type"] == figure.layout["yaxis"]["type"] == "log"


def test_forms_stand_beside_the_quadratic_surface():
    view = view_of(surface_experiment())
    against, missed = draw_forms(view)
    names = [trace["name"] for trace in against.data[1:]]
    assert names == ["Del Vecchio", "mean load", "quadratic surface"]
    quadratic = view.array("apparent_spring_constant_residual")
    assert missed.data[-1]["y"] == pytest.approx(quadratic, rel=1e-4, abs=1e-6 * quadratic.max())
    nothing = view_of(screening_experiment())
    assert draw_forms(nothing) == draw_single_time(nothing, {}) == []


def test_effects_have_the_least_that_counts():
    view = view_of(screening_experiment())
    (bars,) = draw_effects(view, "apparent_spring_constant")
    least = view.scalar("apparent_spring_constant_minimum_significant_effect")
    line = next(trace for trace in bars.data if trace["name"].startswith("least at"))
    assert line["x"] == pytest.approx([least, least], rel=1e-5)
    assert line["name"] == "least at 90 %"


# planes of a surface: the values of the law, and where the runs say less than at the worst


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
