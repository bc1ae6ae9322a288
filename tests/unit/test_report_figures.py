"""Figures of the reports: printed points on corrected curves, every figure in the table, files."""

import csv
import re
import sys

import numpy as np
import pytest
from typer.testing import CliRunner

from reduction.cli.main import app
from reduction.lines.lookup_product import LineCurve, LineSource
from reduction.lines.report_figures import _DRAWN, figure_in_numbers, figure_rows
from reduction.pages.report_figure_files import write_figure
from reduction.published.printed_cells import REPORTS, errata_of
from reduction.record.errors import DataError

ROWS = {(row.report, row.figure): row for row in figure_rows()}
POUND = 4.4482216152605
KNOWN = {one.id: one for report in REPORTS for one in errata_of(report)}
# Table 20 has means of breaks; nothing predicts them
WITHOUT_CURVE = {("CG-D-39-80", "23")}


def drawn(report, figure, own=()):
    return figure_in_numbers(ROWS[report, figure], own)


def test_the_table_has_every_numbered_figure_once_and_a_recipe_for_each_drawn_one():
    assert len(ROWS) == len(figure_rows())
    assert {key for key, row in ROWS.items() if row.is_drawn} == set(_DRAWN)
    assert all(
        row.shows and row.from_or_why_not and row.drawn in ("yes", "no") for row in ROWS.values()
    )
    numbers = {report: set() for report in REPORTS}
    for report, figure in ROWS:
        numbers[report].add(figure.partition("(")[0])
    # lists of illustrations, and the appendices of the rope report
    for report, last in (("CG-D-39-80", 29), ("WHOI-2005-10", 35), ("WHOI-2004-06", 19),
                         ("Zhang-2015", 9), ("Wang-2022", 12)):  # fmt: skip
        assert {str(number) for number in range(1, last + 1)} <= numbers[report]
    assert {"A-1", "A-2", "A-3", "B-1", "E-1", "F-1", "G-1", "G-2", "G-3", "H-1"} <= numbers[
        "CG-D-39-80"
    ]
    told = {
        one
        for row in ROWS.values()
        for one in re.findall(r"\b(?:CG|WH\d|ZH|WA)-\d+\b", row.from_or_why_not)
    }
    assert told <= KNOWN.keys() | {"CG-D"}


def not_explained(figure):
    """Printed points off the curve by more than their reading error, without an erratum."""
    found = []
    for series in figure.series:
        if series.form != "points":
            continue
        points = zip(series.x, series.y, series.computed, series.half, series.errata, strict=True)
        for x, y, computed, half, errata in points:
            is_known = all(KNOWN[one].confidence for one in errata.split()) and errata
            if not (abs(y - computed) <= half or is_known):
                found.append((series.name, x, y, computed))
    return found


def off_the_curves(figure):
    """Values beside points through which no curve of the figure passes."""
    curves = [one for one in figure.series if one.form == "curve"]
    found = []
    for series in figure.series:
        if series.form != "points":
            continue
        for x, computed, half, errata in zip(
            series.x, series.computed, series.half, series.errata, strict=True
        ):
            at = np.array([value_at(one, keep, x) for one in curves for keep in runs_of(one.x)])
            span = max(
                np.ptp(one.y[np.isfinite(one.y)]) for one in curves if np.isfinite(one.y).any()
            )
            if not errata and not np.nanmin(np.abs(at - computed)) <= half + 1e-3 * span:
                found.append((series.name, x, computed))
    return found


def value_at(curve, keep, x):
    """Value of a piece of a curve; NaN beyond its ends."""
    at = curve.x[keep]
    is_inside = at[0] - 1e-9 <= x <= at[-1] + 1e-9 * abs(at[-1])
    return np.interp(x, at, curve.y[keep]) if is_inside else np.nan


def runs_of(x):
    """Places of the pieces of a curve between gaps."""
    return [run[np.isfinite(x[run])] for run in np.split(np.arange(x.size), np.flatnonzero(np.isnan(x)))
            if np.isfinite(x[run]).sum() > 1]  # fmt: skip


def test_printed_points_lie_on_the_curve_within_their_reading_error_or_have_an_erratum():
    n_points, wrong = 0, []
    for key in _DRAWN:
        figure = drawn(*key)
        n_points += sum(one.x.size for one in figure.series if one.form == "points")
        if key not in WITHOUT_CURVE:
            wrong += [(key, one) for one in (*not_explained(figure), *off_the_curves(figure))]
    assert not wrong
    assert n_points > 250


def test_a_point_that_was_typed_wrong_is_found():
    figure = drawn("Zhang-2015", "4")
    curve, points = figure.series[:2]
    points.y.setflags(write=True)
    points.y[3] += 0.05
    assert [one[:2] for one in not_explained(figure)] == [(points.name, points.x[3])]
    curve.y.setflags(write=True)
    curve.y[:] += 1.0
    assert len(off_the_curves(figure)) == points.x.size


def test_the_corners_of_the_cube_are_sums_of_the_printed_coefficients():
    (cube,) = drawn("CG-D-39-80", "6").series
    # B1, f2, T2, dT2, f, T, dT, fT, fdT, TdT of Table 3
    of_table = [3.088, -0.111, 0.001, -0.104, -0.019, 1.422, -0.274, 0.131, -0.060, 0.047]
    for f, tension, amplitude, value in zip(cube.w, cube.x, cube.y, cube.z, strict=True):
        i, j, k = (1 if at > middle else -1
                   for at, middle in ((f, 0.3), (tension / POUND, 1200), (amplitude / POUND, 480)))  # fmt: skip
        terms = [1, 1, 1, 1, i, j, k, i * j, i * k, j * k]
        assert value == pytest.approx(1e4 * POUND * np.dot(of_table, terms), rel=1e-6)


def test_hysteresis_is_a_tenth_of_its_maximum_where_the_line_is():
    for energy, _, line in np.array(drawn("CG-D-39-80", "A-1").series).reshape(2, 3):
        assert energy.y.max() == pytest.approx(1, abs=1e-3)
        assert np.interp(line.x[0], energy.x, energy.y) == pytest.approx(0.1, abs=1e-3)


def test_axial_tension_is_that_of_a_squared_cosine():
    # E A times the strain along the wire: 210 GPa, 2.5 mm, a thousandth
    (wire,) = drawn("Wang-2022", "7(a)").series
    force = 210e9 * np.pi * 2.5e-3**2 * 1e-3 * np.cos(wire.x) ** 2
    assert wire.y == pytest.approx(force, rel=1e-3)


def test_the_static_test_has_a_curve_of_the_weights_put_on_and_one_of_those_taken_off():
    # Table 4: 51 and 74 lb at 9.31 and 11.38 in, and at 11.68 and (151 %) 15.38 in; 9.31 in is 52 %
    up, down = drawn("WHOI-2005-10", "35").series[-2:]
    assert (up.name, down.name) == ("static test, 1997, up", "static test, 1997, down")
    per_inch = 23 * POUND * (9.31 / 1.52) / (np.pi / 4 * 0.0254**2)
    assert up.y[0] == pytest.approx(per_inch / (11.38 - 9.31), rel=0.01)
    assert down.y[-1] == pytest.approx(per_inch / (15.38 - 11.68), rel=0.01)


def test_a_legend_says_where_printed_points_have_no_curve_and_names_each_erratum_once(tmp_path):
    svg, *_ = write_figure(drawn("WHOI-2005-10", "23"), tmp_path, "us").paths
    text = svg.read_text(encoding="utf-8")
    assert "T-6 used, Table 5 (no curve)" in text
    assert "T-5 used, Table 5 (no curve)" not in text
    assert "printed, WH5-6, WH5-5<" in text


def own_line(notes=()):
    curve = LineCurve(
        "quasi_static_spring_constant", "mean_tension", 0.0, 9e3, coefficient=np.array([5e4, 2.0])
    )
    return LineSource(
        "mine", "own/Q1", "nylon", "braid", "new", 0.0127, 3e4, curves=(curve,), notes=notes
    )


def test_lines_that_differ_by_colour_alone_have_dashes_that_tell_them_apart_in_grey(tmp_path):
    svg, *_ = write_figure(drawn("CG-D-39-80", "8"), tmp_path, "us").paths
    # K_0 of four diameters: one solid line and three patterns of dashes
    patterns = re.findall(r"stroke-dasharray: ([\d., ]+)", svg.read_text(encoding="utf-8"))
    assert len(set(patterns)) == 3


def test_an_own_line_is_drawn_where_it_has_the_quantity_and_synthetic_data_say_so(tmp_path):
    figure = drawn("CG-D-39-80", "8", [own_line(("synthetic data",))])
    (own,) = (one for one in figure.series if one.is_own)
    assert own.y[[0, -1]] == pytest.approx([5e4, 6.8e4])
    assert not any(one.is_own for one in drawn("CG-D-39-80", "12", [own_line()]).series)
    svg, _, table = write_figure(figure, tmp_path, "us").paths
    assert "SYNTHETIC DATA" in svg.read_text(encoding="utf-8")
    rows = [
        row
        for row in csv.DictReader(table.read_text(encoding="utf-8").splitlines())
        if row["own"] != "no"
    ]
    assert {row["own"] for row in rows} == {"yes, synthetic"}
    assert float(rows[-1]["K_0 [lbf]"]) == pytest.approx(6.8e4 / POUND)


@pytest.mark.parametrize(
    ("report", "figure"), [("CG-D-39-80", "4"), ("CG-D-39-80", "6"), ("CG-D-39-80", "7"), ("CG-D-39-80", "23")]
)  # fmt: skip
def test_a_figure_is_written_as_svg_png_and_csv(report, figure, tmp_path):
    svg, png, table = write_figure(drawn(report, figure), tmp_path, "us").paths
    assert svg.read_text(encoding="utf-8").rstrip().endswith("</svg>")
    assert png.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
    rows = list(csv.DictReader(table.read_text(encoding="utf-8").splitlines()))
    size = sum(one.x.size for one in drawn(report, figure).series)
    assert len(rows) == size
    if figure == "4":
        assert [(row["K_ap [lbf]"], row["erratum"]) for row in rows[-3:]] == [
            ("110000.0", "CG-62"), ("120000.0", "CG-62"), ("175000.0", ""),
        ]  # fmt: skip


def run(*words):
    return CliRunner().invoke(app, ["figures", *map(str, words)])


def test_a_page_has_the_drawn_figures_of_a_report_and_the_reasons_of_the_others(tmp_path):
    done = run("Wang-2022", "--out", tmp_path)
    assert done.exit_code == 0, done.output
    page = (tmp_path / "Wang-2022" / "index.html").read_text(encoding="utf-8")
    for row in (row for row in ROWS.values() if row.report == "Wang-2022"):
        assert row.from_or_why_not in page
    assert page.count("<img ") == 2
    assert "://" not in re.sub(r"data:[^\"]*", "", page)
    assert "winding angle [deg]" in page
    assert "figure-9a.svg" in done.output


def test_a_figure_that_cannot_be_drawn_says_why(tmp_path):
    with pytest.raises(
        DataError, match="Figure 34 of WHOI-2005-10 is not drawn; found noisy curves"
    ):
        drawn("WHOI-2005-10", "34")
    assert run("WHOI-2005-10", "--figure", "34", "--out", tmp_path).exit_code == 4
    for words in (
        ("WHOI",),
        ("--figure", "99"),
        ("--figure", "8", "--campaign", tmp_path / "none"),
    ):
        assert run(*words, "--out", tmp_path).exit_code == 2
    assert not list(tmp_path.iterdir())


def test_without_matplotlib_the_command_says_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    done = run("Wang-2022", "--out", tmp_path)
    assert done.exit_code == 2
    assert 'pip install "mooring-reduction[figures]"' in done.output
