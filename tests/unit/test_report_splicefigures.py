"""The splice correction drawn: marks, the method on them, and what it misses."""

import numpy as np
import pytest
import xarray as xr

from reduction.report.figures.record_figures import draw_splices
from reduction.report.test_view import TestView

FREE, SPLICES, COMPLIANCE, EXPONENT = 2.5, 1.2, 2e-3, 0.8
TENSION = np.array([0.0, 200.0, 400.0, 800.0])
STRAIN = np.array([0.0, 0.5, 1.0, 1.5])
MISSED = np.array([0.001, -0.002, 0.0, 0.003])
RATIO = 0.15
S, C, M = "specimen", "coefficient_name", "mark"


def splices_at(tension):
    return SPLICES * (1 + COMPLIANCE * np.asarray(tension) ** EXPONENT)


def make_view(units="si", *, method="tension-driven", deviation=0.0):
    """A tether whose marks lie on the law but for what each misses in strain."""
    values = {
        "relaxed_free_length": FREE, "relaxed_splice_length": SPLICES,
        "splice_compliance": COMPLIANCE, "splice_exponent": EXPONENT,
    }  # fmt: skip
    if method == "marks":
        values = {"relaxed_free_length": FREE, "free_length_intercept": -0.4,
                  "free_length_slope": 0.8}  # fmt: skip
        position = np.array([3.625, 5.2, 6.75, 8.3])
    elif method == "mixed":
        values |= {"splice_offset": 0.0, "splice_strain_ratio": RATIO, "splice_limit": 0.0,
                   "splice_strain_curvature": 0.0, "splice_strain_cubic": 0.0,
                   "splice_saturation": 0.0}  # fmt: skip
        position = FREE * (1 + STRAIN) + splices_at(TENSION) + SPLICES * RATIO * STRAIN
    else:
        position = FREE * (1 + STRAIN) + splices_at(TENSION)
    names = list(values)
    spread = dict.fromkeys(names, 0.0) | {"relaxed_splice_length": deviation}
    size = len(names)
    data = {
        "strain_method": (S, [method]),
        **{name: (S, [value]) for name, value in values.items()},
        **{f"{name}_standard_uncertainty": (S, [spread[name]]) for name in names},
        "strain_coefficient_correlation": ((S, C, f"{C}_other"), [np.eye(size)]),
        "mark_specimen": (M, ["new", "new", "other", "new"]),
        "mark_test": (M, ["T-1", "T-2", "T-2", "T-2"]),
        "mark_hold": (M, ["slack", "<b>", "max", "max"]),
        "mark_position": (M, position),
        "mark_tension": (M, TENSION),
        "mark_strain": (M, STRAIN - MISSED),
        "mark_strain_residual": (M, MISSED),
        "tension": ((S, "sample"), [[0.0, 900.0, 100.0]]),
        "crosshead_position": ("sample", [3.7, 8.5, 4.0]),
    }
    own = {S: ["new"], C: names, f"{C}_other": names}
    return TestView("test-0", xr.Dataset(data, own, {"test": "T-1"}), units)


def traces_of(figure, axis_name):
    return {trace["name"]: trace for trace in figure.data if trace.get("yaxis", "y") == axis_name}


def test_the_line_is_the_splice_law_and_the_marks_stand_where_the_tape_put_them():
    (figure,) = draw_splices(make_view())
    upper = traces_of(figure, "y2")
    line = upper["tension-driven"]
    assert line["y"] == pytest.approx(splices_at(line["x"]), rel=1e-5)
    # a mark whose strain the method reads high by 0.002 has its splices longer by that much
    assert upper["marks of this test"]["y"] == pytest.approx([SPLICES + FREE * 0.001], abs=1e-5)
    others = upper["marks of other tests"]
    expected = splices_at([200.0, 800.0]) + FREE * np.array([-0.002, 0.003])
    assert others["x"] == [200.0, 800.0]
    assert others["y"] == pytest.approx(expected, abs=1e-5)
    assert others["text"] == ["T-2, &lt;b&gt;", "T-2, max"]


def test_what_the_method_misses_stands_below_in_points_of_strain():
    (figure,) = draw_splices(make_view())
    lower = traces_of(figure, "y")
    assert lower["marks of this test"]["y"] == pytest.approx([0.1])
    assert lower["marks of other tests"]["y"] == pytest.approx([-0.2, 0.3])
    assert figure.layout["yaxis"]["title"]["text"] == "method less marks [%]"


def test_the_bands_are_95_percent_of_the_coefficients():
    (figure,) = draw_splices(make_view(deviation=0.01))
    upper, lower = traces_of(figure, "y2"), traces_of(figure, "y")
    # s = s0 (1 + c F^n): at slack all of the deviation of s0
    above_slack = upper["of the method"]["y"][0] - SPLICES
    assert above_slack == pytest.approx(1.959964 * 0.01, rel=1e-4)
    assert max(y for y in lower["95 %"]["y"] if y is not None) == pytest.approx(
        100 * 1.959964 * 0.01 / FREE * splices_at(800.0) / SPLICES, rel=1e-4
    )
    assert "k = 1.96" in figure.caption


def test_the_end_of_the_test_is_marked_in_the_units_of_the_page():
    (figure,) = draw_splices(make_view("us"))
    (end,) = figure.layout["shapes"]
    assert end["x0"] == pytest.approx(900 / 4.4482216, rel=1e-5)
    assert figure.layout["xaxis"]["title"]["text"] == "tension at the marks [lbf]"
    assert figure.layout["yaxis2"]["title"]["text"] == "both splices [ft]"


def test_a_method_that_knows_no_tension_is_drawn_against_position():
    (figure,) = draw_splices(make_view(method="marks"))
    assert figure.layout["xaxis"]["title"]["text"] == "crosshead position at the marks [m]"
    line = traces_of(figure, "y2")["marks"]
    position = np.array(line["x"])
    assert line["y"] == pytest.approx(position - (-0.4 + 0.8 * position), abs=1e-4)
    assert figure.layout["shapes"][0]["x0"] == 8.5


def test_a_method_by_tension_and_strain_is_drawn_at_the_tensions_of_the_marks():
    # against position alone the law had the position for a tension: far below every mark
    (figure,) = draw_splices(make_view(method="mixed"))
    assert figure.layout["xaxis"]["title"]["text"] == "crosshead position at the marks [m]"
    line = traces_of(figure, "y2")["mixed"]
    own = [0, 1, 3]
    expected = splices_at(TENSION[own]) + SPLICES * RATIO * STRAIN[own]
    assert line["x"] == pytest.approx(FREE * (1 + STRAIN[own]) + expected, rel=1e-5)
    assert line["y"] == pytest.approx(expected, rel=1e-5)


def test_without_marks_or_without_a_length_of_the_splices_there_is_no_figure():
    view = make_view()
    assert draw_splices(TestView("k", view.data.drop_dims("mark"))) == []
    assert draw_splices(TestView("k", view.data.drop_vars("relaxed_free_length"))) == []
    assert draw_splices(TestView("k", view.data.assign(mark_specimen=(M, 4 * ["other"])))) == []


def test_a_test_without_a_record_has_no_end_to_mark():
    view = make_view()
    (figure,) = draw_splices(TestView("k", view.data.drop_dims("sample")))
    assert figure.layout["shapes"] == []
    assert figure.has_data
