"""Tests of ropes on the page: a slow pull, the line of each test, and no word of rubber."""

import re
from dataclasses import replace

import numpy as np
import plotly.graph_objects as go
import pytest
from experiment_views import view_of
from experiments import ABOUT, screening_experiment, surface_experiment

from reduction.archive.open import open_archive
from reduction.archive.surfaces_dataset import surfaces_to_dataset
from reduction.archive.write import write_archive
from reduction.report.campaign_page import write_report
from reduction.report.campaign_summary import SummaryFinding, find_faults, test_table
from reduction.report.experiment_tables import form_quality_table, form_table, line_of_runs_table
from reduction.report.figures.hold_figures import draw_pull
from reduction.report.test_section import (
    _line_table,
    _pull_share_table,
    _pull_table,
    _summary_table,
    segment_table,
)
from reduction.report.test_view import TestView

test_table.__test__ = False


@pytest.fixture
def view(write, rich_test):
    with open_archive(write(rich_test)) as data:
        yield TestView("test-0", data.load())


def texts(table):
    return {row[0].text: [cell.text for cell in row[1:]] for row in table.rows}


def as_rope(view):
    kinds = ("specimen", np.array(["rope"] * len(view.specimens)))
    return replace(view, data=view.data.assign(specimen_kind=kinds))


def test_a_slow_pull_has_its_curve_its_slope_and_its_conditions(view):
    curve, slope = draw_pull(view)
    for figure in (curve, slope):
        go.Figure({"data": figure.data, "layout": figure.layout})
    assert any("range of use" in trace["name"] for trace in curve.data)
    rows = texts(_pull_table(view))
    assert rows["waiting time before the pull [h]"] == ["24.00"]
    assert rows["tension at the length reading [N]"] == ["5.000"]
    # the pull is strain over tension of 1 in 40 000, over 0 to 2000 N
    assert float(rows["strain, coefficient of T [N⁻¹]"][0].split()[0]) == pytest.approx(
        1 / 4e4, rel=0.02
    )
    assert [
        float(one) for one in re.findall(r"[\d.]+", rows["range of use [N]"][0].replace(",", ""))
    ] == (pytest.approx([0, 2000], abs=40))


def test_a_pull_shown_in_pounds_has_coefficients_of_pounds(view):
    rows = texts(_pull_table(replace(view, units="us")))
    slope = float(rows["strain, coefficient of T [lbf⁻¹]"][0].split()[0])
    assert slope == pytest.approx(4.4482216152605 / 4e4, rel=0.02)


def test_strain_stands_at_round_shares_of_the_break_strength_within_the_range(view):
    table = _pull_share_table(view)
    # of 3558 N the range ends at 2000 N, 56 %
    assert [row[0].text for row in table.rows] == ["5", "10", "15", "20", "25", "30", "40", "50"]
    at = {row[0].text: 100 * float(row[1].value) for row in table.rows}
    assert at["20"] == pytest.approx(100 * 0.2 * 3558 / 4e4, rel=0.01)


def test_the_line_of_a_test_has_each_parameter_and_why_one_is_refused(view):
    table = _line_table(view)
    assert table.columns[-1] == "refused because"
    assert "the storage spring constant does not exceed the quasi-static one" in [
        row[-1].text for row in table.rows
    ]
    given = view.data.assign(
        test_line_refusal=("specimen", np.zeros(len(view.specimens), dtype=np.int8))
    )
    assert "refused because" not in _line_table(replace(view, data=given)).columns
    assert _line_table(replace(view, data=view.data.drop_vars("test_relaxation_time"))) is None


def test_the_line_of_runs_has_k1_and_tau_from_surfaces_beside(view):
    experiment = view_of(surface_experiment())
    specimen = experiment.texts("run_specimen")[0]
    test = replace(view, data=view.data.assign_coords(specimen=[specimen, "used"]))
    table = line_of_runs_table(experiment, {"R02": test})
    assert [row[0].text for row in table.rows] == ["R02"]
    assert table.columns[-2:] == ("K_1 from surfaces [N]", "tau from surfaces [s]")
    assert float(table.rows[0][-1].value) == pytest.approx(1 + 1 / 14)
    assert line_of_runs_table(experiment, {}) is None


def test_forms_have_intervals_and_their_scatter_in_newton():
    experiment = view_of(surface_experiment(), screening_experiment())
    table = form_table(experiment)
    assert [row[1].text for row in table.rows] == ["a", "b", "c", "d", "alpha", "beta"]
    for row in table.rows:
        low, high = (float(end) for end in row[4].value.split())
        assert low < float(row[2].value) < high
    quality = form_quality_table(experiment)
    assert [row[1].text for row in quality.rows] == ["4", "2", "10"]
    sigma, in_newton = (float(cell.text.replace(",", "")) for cell in quality.rows[0][5:7])
    assert in_newton == pytest.approx(28470.0 * sigma, rel=1e-3)
    nothing = view_of(surface_experiment(), screening_experiment(), index=1)
    assert form_table(nothing) is None
    assert form_quality_table(nothing) is None


def test_no_table_of_a_rope_speaks_of_rubber(view):
    assert "rubber" in segment_table([view]).caption
    assert "rubber" not in segment_table([as_rope(view)]).caption


def test_ropes_are_listed_by_the_tension_of_their_cycles(view):
    assert "target strain [%]" in test_table([view], []).columns
    rope = as_rope(view)
    table = test_table([rope], [])
    (place,) = [k for k, name in enumerate(table.columns) if name.startswith("tension range")]
    low = np.nanmean(rope.array("mean_tension") - rope.array("tension_amplitude"))
    assert float(table.rows[0][place].value.split()[0]) == pytest.approx(low)


def test_a_pull_is_listed_by_how_far_it_went(view):
    rope = as_rope(view)
    bare = rope.data.drop_vars(["mean_tension", "tension_amplitude", "mean_strain", "strain"])
    peaks = {"pull_peak_tension": 4.7e5, "pull_peak_strain": 0.358}
    bare = bare.assign({name: ("specimen", np.full(bare.sizes["specimen"], peak))
                        for name, peak in peaks.items()})  # fmt: skip
    (row,) = test_table([replace(rope, data=bare)], []).rows
    assert [cell.text for cell in row[3:5]] == ["to 470,000", "to 35.8"]


def test_a_table_of_means_without_a_mean_is_not_shown(view):
    data = view.data[["slack_strain_at_unloading", "specimen"]].copy()
    data["slack_strain_at_unloading"][:] = np.nan
    assert _summary_table(replace(view, data=data)) is None


def test_what_is_no_tests_fault_stands_among_those_as_serious():
    other = SummaryFinding("warning", ("experiment",), "slack")
    assert find_faults([], [], {"a.nc": "broken"}, [other])[-1] == other


def test_findings_of_one_matter_are_one_item_that_names_the_tests():
    """Three notes on one slack line took three of the five places on the screen."""
    others = [
        SummaryFinding("warning", ("experiment",), "run R05 reaches zero", topic=("slack", 3)),
        SummaryFinding("warning", ("R07",), "the mean drifts"),
        SummaryFinding("warning", ("R05",), "R05 goes slack", topic=("slack", 0)),
    ]
    one, two = find_faults([], [], {}, others)
    assert (one.tests, one.text) == (("R05", "experiment"), "R05 goes slack. Run R05 reaches zero")
    assert two == others[1]


@pytest.fixture
def page(tmp_path):
    def make(*results, **attributes):
        data = surfaces_to_dataset(results, origin=replace(ABOUT, **attributes))
        write_archive(data, tmp_path / "surfaces.nc")
        return write_report(tmp_path, tmp_path / "out").read_text(encoding="utf-8")

    return make


def test_experiments_alone_are_a_page(page):
    html = page(surface_experiment("half <inch>"), screening_experiment())
    assert "half &lt;inch&gt;" in html
    assert "half <inch>" not in html
    headings = re.findall(r'<h2 id="([^"]+)"', html)
    assert headings == ["answer", "wrong", "experiment-0", "experiment-1"]
    assert "SYNTHETIC DATA" in html
    assert "All notes on this experiment" in html


def test_experiments_stand_before_the_tests(page, write, rich_test):
    write(rich_test)
    headings = re.findall(r'<h2 id="([^"]+)"', page(surface_experiment()))
    assert headings.index("experiment-0") < headings.index("comparisons") < headings.index("test-0")


def test_an_archive_of_experiments_that_cannot_be_read_is_a_failure_and_the_page_stands(
    tmp_path, write, rich_test
):
    write(rich_test)
    (tmp_path / "surfaces.nc").write_bytes(b"no archive")
    html = write_report(tmp_path, tmp_path / "out").read_text(encoding="utf-8")
    assert "surfaces.nc" in html
    assert "This file cannot be shown" in html
