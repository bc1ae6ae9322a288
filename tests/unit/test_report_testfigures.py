"""Figures of one test: record, loops, trends, moduli, splices."""

import tracemalloc
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from long_records import long_test

from reduction.archive.test_dataset import to_dataset
from reduction.report.figures.cycle_figures import draw_loops, draw_trends
from reduction.report.figures.modulus_figures import draw_moduli
from reduction.report.figures.record_figures import draw_record, draw_splices
from reduction.report.test_view import TestView


def whole_view(n_cycles):
    test = long_test(n_cycles)
    with_loops = to_dataset(test, version="1", command="run")
    return TestView("test-0", with_loops.assign_coords(cycle=np.arange(1, n_cycles + 1)))


def test_many_cycles_are_filled_between_their_extremes_so_that_no_specimen_hides_another():
    view = whole_view(400)
    (figure,) = draw_record(view)
    for index, name in enumerate(("one", "two")):
        (trace,) = (one for one in figure.data if one["name"] == f"tension, {name}")
        assert trace["fill"] == "toself"
        assert trace["fillcolor"].endswith("0.3)")
        heights = [y for y in trace["y"] if y is not None]
        tension = view.data["tension"].values[index]
        assert min(heights) == pytest.approx(tension.min(), rel=1e-5)
        assert max(heights) == pytest.approx(tension.max(), rel=1e-5)
    assert "Too many cycles to show individually" in figure.caption


def test_a_spike_in_a_long_record_is_at_its_place():
    view = whole_view(400)
    tension = view.data["tension"].copy()
    tension[0, 4321] = 5000.0
    (figure,) = draw_record(replace(view, data=view.data.assign(tension=tension)))
    (trace,) = (one for one in figure.data if one["name"] == "tension, one")
    heights = np.array([np.nan if y is None else y for y in trace["y"]])
    place = trace["x"][int(np.nanargmax(heights))]
    assert np.nanmax(heights) == 5000.0
    assert place == pytest.approx(432.1, abs=float(view.data["time"][-1]) / 250)


def test_the_edges_do_not_follow_single_cycles():
    view = whole_view(400)
    wave = np.sin(2 * np.pi * np.arange(view.data.sizes["sample"]) / 20)
    tension = view.data["tension"].copy(data=np.stack([wave, wave]))
    (figure,) = draw_record(replace(view, data=view.data.assign(tension=tension)))
    (trace,) = (one for one in figure.data if one["name"] == "tension, one")
    heights = np.array([y for y in trace["y"] if y is not None])
    assert np.abs(heights).min() > 0.95


@pytest.mark.parametrize("n_cycles", [20, 300])
def test_cycles_that_can_be_told_apart_are_a_line(n_cycles):
    (figure,) = draw_record(whole_view(n_cycles))
    assert not any("fill" in trace for trace in figure.data)
    assert "told apart" not in figure.caption


def slipped(n_cycles, cycles):
    data = xr.Dataset(
        {
            "peak_tension": (("specimen", "cycle"), np.ones((2, n_cycles))),
            "slip_cycle": ("slip", cycles),
            "slip_specimen": ("slip", ["one", "<b>"][: len(cycles)]),
        },
        coords={"specimen": ["one", "<b>"], "cycle": np.arange(1, n_cycles + 1)},
        attrs={"test": "T-1"},
    )
    return TestView("test-0", data)


def test_steps_of_a_splice_are_named_above_the_axes_and_not_on_the_curve():
    (figure,) = draw_trends(slipped(1000, [100, 130]))
    top = figure.layout["yaxis"]["domain"][1]
    labels = figure.layout["annotations"]
    assert [one["text"] for one in labels] == ["one 100", "&lt;b&gt; 130"]
    assert all(one["y"] > top for one in labels)
    # one above the other, since 100 and 130 are close on a logarithmic axis
    assert labels[0]["y"] != labels[1]["y"]
    assert [one["x"] for one in labels] == pytest.approx([2.0, np.log10(130)])
    assert all(shape["y1"] == top for shape in figure.layout["shapes"])


def test_without_a_step_the_axes_have_all_the_room():
    (figure,) = draw_trends(slipped(20, []))
    assert "domain" not in figure.layout["yaxis"]


# loops drawn: as they are, and less a straight line so that they open


def make_view(opening=0.02, *, n_cycles=3, strain=None):
    """Cycles on a straight line of 1 MPa, ``opening`` MPa below it half-way down."""
    up = np.linspace(0.5, 1.5, 51) if strain is None else strain
    there = np.concatenate([up, up[::-1]])
    lag = np.concatenate([np.zeros(up.size), opening * np.sin(np.pi * np.linspace(0, 1, up.size))])
    shape = ("specimen", "sample")
    data = {
        "strain": (shape, np.tile(there, n_cycles)[None]),
        "nominal_stress": (shape, 1e6 * np.tile(0.3 + there - lag, n_cycles)[None]),
        "tension": (shape, np.tile(there, n_cycles)[None]),
        "cycle_number": ("sample", np.repeat(np.arange(1, n_cycles + 1), there.size)),
        "branch": ("sample", np.tile(np.repeat([1, 2], up.size), n_cycles)),
    }
    own = {"specimen": ["new"], "cycle": np.arange(1, n_cycles + 1)}
    return TestView("test-0", xr.Dataset(data, own, {"test": "T-1"}))


def panel(figure, axis_name):
    return {trace["name"]: trace for trace in figure.data if trace["yaxis"] == axis_name}


def test_below_stands_what_is_left_of_a_loop_without_its_straight_line():
    (figure,) = draw_loops(make_view())
    above, below = panel(figure, "y2"), panel(figure, "y")
    assert set(above) == set(below)
    assert above["cycle 1, ascending"]["y"][0] == pytest.approx(0.8)
    assert below["cycle 1, ascending"]["y"] == pytest.approx([0.0] * 51, abs=1e-9)
    assert min(below["cycle 3, descending"]["y"]) == pytest.approx(-0.02, rel=1e-3)
    assert max(below["cycle 3, descending"]["y"]) == pytest.approx(0.0, abs=1e-9)


def test_a_cycle_stands_in_the_legend_once_and_says_its_number_in_both_panels():
    (figure,) = draw_loops(make_view())
    assert [trace["name"] for trace in figure.data if trace["showlegend"]] == [
        "cycle 1, ascending", "cycle 1, descending", "cycle 2, ascending", "cycle 2, descending",
        "cycle 3, ascending", "cycle 3, descending",
    ]  # fmt: skip
    for axis_name in ("y", "y2"):
        numbers = [trace["meta"]["cycle"] for trace in panel(figure, axis_name).values()]
        assert numbers == [1, 1, 2, 2, 3, 3]
    assert figure.layout["yaxis"]["title"]["text"] == "less the chord [MPa]"


def test_a_branch_of_one_strain_has_a_level_line():
    (figure,) = draw_loops(make_view(strain=np.full(5, 1.0)))
    below = panel(figure, "y")["cycle 1, ascending"]["y"]
    assert below == pytest.approx([0.0] * 5, abs=1e-9)


# trends over many cycles: thinned, said so, and no more worked out than is drawn

NAMES = ("peak_tension", "valley_tension", "hysteresis_energy", "mean_strain")
SPIKE = 1234


def view_of(n_cycles):
    """A synthetic test of one specimen; one cycle stands out."""
    rng = np.random.default_rng(8)
    values = {name: 100 + rng.random((1, n_cycles)) for name in NAMES}
    values["hysteresis_energy"][0, SPIKE] = 500.0
    uncertain = {f"{name}_standard_uncertainty": 0.01 * values[name] for name in NAMES}
    data = xr.Dataset(
        {name: (("specimen", "cycle"), found) for name, found in (values | uncertain).items()},
        coords={"specimen": ["new"], "cycle": np.arange(1, n_cycles + 1)},
        attrs={"test": "T-1", "synthetic": "yes"},
    )
    return TestView("test-0", data.assign(tension=(("specimen", "sample"), np.zeros((1, 5)))))


def test_a_caption_says_that_not_all_cycles_are_drawn_where_they_are_not():
    captions = [figure.caption for figure in draw_trends(view_of(5000))]
    assert all("only the minima and maxima of short intervals" in one for one in captions)
    assert not any("only the minima" in one.caption for one in draw_trends(view_of(2000)))


def test_a_cycle_that_stands_out_is_drawn_with_its_own_uncertainty():
    (energy,) = (one for one in draw_trends(view_of(5000)) if one.key.endswith("energy"))
    band, line = energy.data
    assert len(line["x"]) <= 2000
    assert line["y"][line["x"].index(SPIKE + 1)] == 500.0
    high = band["y"][band["x"].index(SPIKE + 1)]
    assert high == pytest.approx(500 + 1.96 * 5, rel=1e-5)


def test_only_uncertainties_that_are_drawn_are_expanded():
    view = view_of(200_000)
    draw_trends(view)  # what stays is made before it is measured
    tracemalloc.start()
    draw_trends(view)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 10 * view.data["cycle"].size * 8


def test_a_test_among_others_keeps_of_its_cycles_what_they_reach_together():
    kept = view_of(10_000).without_samples()
    assert {"mean_strain", "cycle", "specimen"} == set(map(str, kept.data.variables))
    assert kept.n_cycles == 10_000


# the splice correction drawn: marks, the method on them, and what it misses

FREE, SPLICES, COMPLIANCE, EXPONENT = 2.5, 1.2, 2e-3, 0.8
TENSION = np.array([0.0, 200.0, 400.0, 800.0])
STRAIN = np.array([0.0, 0.5, 1.0, 1.5])
MISSED = np.array([0.001, -0.002, 0.0, 0.003])
RATIO = 0.15
S, C, M = "specimen", "coefficient_name", "mark"


def splices_at(tension):
    return SPLICES * (1 + COMPLIANCE * np.asarray(tension) ** EXPONENT)


def make_view_of_splices(units="si", *, method="tension-driven", deviation=0.0):
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
    (figure,) = draw_splices(make_view_of_splices())
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
    (figure,) = draw_splices(make_view_of_splices())
    lower = traces_of(figure, "y")
    assert lower["marks of this test"]["y"] == pytest.approx([0.1])
    assert lower["marks of other tests"]["y"] == pytest.approx([-0.2, 0.3])
    assert figure.layout["yaxis"]["title"]["text"] == "method less marks [%]"


def test_the_bands_are_95_percent_of_the_coefficients():
    (figure,) = draw_splices(make_view_of_splices(deviation=0.01))
    upper, lower = traces_of(figure, "y2"), traces_of(figure, "y")
    # s = s0 (1 + c F^n): at slack all of the deviation of s0
    above_slack = upper["of the method"]["y"][0] - SPLICES
    assert above_slack == pytest.approx(1.959964 * 0.01, rel=1e-4)
    assert max(y for y in lower["95 %"]["y"] if y is not None) == pytest.approx(
        100 * 1.959964 * 0.01 / FREE * splices_at(800.0) / SPLICES, rel=1e-4
    )
    assert "k = 1.96" in figure.caption


def test_the_end_of_the_test_is_marked_in_the_units_of_the_page():
    (figure,) = draw_splices(make_view_of_splices("us"))
    (end,) = figure.layout["shapes"]
    assert end["x0"] == pytest.approx(900 / 4.4482216, rel=1e-5)
    assert figure.layout["xaxis"]["title"]["text"] == "tension at the marks [lbf]"
    assert figure.layout["yaxis2"]["title"]["text"] == "both splices [ft]"


def test_a_method_that_knows_no_tension_is_drawn_against_position():
    (figure,) = draw_splices(make_view_of_splices(method="marks"))
    assert figure.layout["xaxis"]["title"]["text"] == "crosshead position at the marks [m]"
    line = traces_of(figure, "y2")["marks"]
    position = np.array(line["x"])
    assert line["y"] == pytest.approx(position - (-0.4 + 0.8 * position), abs=1e-4)
    assert figure.layout["shapes"][0]["x0"] == 8.5


def test_a_method_by_tension_and_strain_is_drawn_at_the_tensions_of_the_marks():
    # against position alone the law had the position for a tension: far below every mark
    (figure,) = draw_splices(make_view_of_splices(method="mixed"))
    assert figure.layout["xaxis"]["title"]["text"] == "crosshead position at the marks [m]"
    line = traces_of(figure, "y2")["mixed"]
    own = [0, 1, 3]
    expected = splices_at(TENSION[own]) + SPLICES * RATIO * STRAIN[own]
    assert line["x"] == pytest.approx(FREE * (1 + STRAIN[own]) + expected, rel=1e-5)
    assert line["y"] == pytest.approx(expected, rel=1e-5)


def test_without_marks_or_without_a_length_of_the_splices_there_is_no_figure():
    view = make_view_of_splices()
    assert draw_splices(TestView("k", view.data.drop_dims("mark"))) == []
    assert draw_splices(TestView("k", view.data.drop_vars("relaxed_free_length"))) == []
    assert draw_splices(TestView("k", view.data.assign(mark_specimen=(M, 4 * ["other"])))) == []


def test_a_test_without_a_record_has_no_end_to_mark():
    view = make_view_of_splices()
    (figure,) = draw_splices(TestView("k", view.data.drop_dims("sample")))
    assert figure.layout["shapes"] == []
    assert figure.has_data


# the modulus of a test drawn: what is trusted, and what was trimmed away beside it

NAN = np.nan
TRIMMED = np.array([NAN, NAN, 2.0, 3.0, 4.0, NAN])
WHOLE = np.array([NAN, 1.5, 2.1, 3.0, 4.1, 9.0])


def make_view_of_moduli(trimmed=TRIMMED, whole=WHOLE, half=0.1):
    dims = ("specimen", "branch_name", "strain_bin")
    both = np.stack([trimmed, np.full(6, NAN)])[None] * 1e6
    data = {
        "tangent_modulus": (dims, both),
        "tangent_modulus_untrimmed": (dims, np.stack([whole, np.full(6, NAN)])[None] * 1e6),
        "tangent_modulus_standard_uncertainty": (
            dims,
            half * 1e6 / 1.959964 * np.isfinite(both),
        ),
    }
    own = {
        "specimen": ["new"], "branch_name": ["ascending", "descending"],
        "strain_bin": 0.1 * np.arange(1, 7),
    }  # fmt: skip
    return TestView("test-0", xr.Dataset(data, own, {"test": "T-1"}))


def traces_of_moduli(view):
    (figure,) = draw_moduli(view)
    return {trace["name"]: trace for trace in figure.data}, figure


def test_what_was_trimmed_away_is_drawn_to_both_sides_and_joins_the_curve():
    traces, figure = traces_of_moduli(make_view_of_moduli())
    assert traces["ascending"]["y"] == [None, None, 2.0, 3.0, 4.0, None]
    assert traces["ascending, trimmed away"]["y"] == [None, 1.5, 2.1, None, 4.1, 9.0]
    assert traces["ascending, trimmed away"]["line"]["dash"] == "dot"
    assert "trimmed ends" in figure.caption


def test_where_nothing_was_trimmed_there_is_no_line_for_it():
    traces, _ = traces_of_moduli(make_view_of_moduli(whole=TRIMMED))
    assert [name for name in traces if "trimmed" in name] == []


def test_a_branch_without_a_trimmed_curve_is_drawn_as_trimmed_away():
    traces, _ = traces_of_moduli(make_view_of_moduli(trimmed=np.full(6, NAN)))
    assert "ascending" not in traces
    assert traces["ascending, trimmed away"]["y"] == [None, 1.5, 2.1, 3.0, 4.1, 9.0]


def test_the_axis_goes_by_what_is_trusted_not_by_what_was_trimmed():
    _, figure = traces_of_moduli(make_view_of_moduli())
    low, high = figure.layout["yaxis"]["range"]
    assert low == 0
    # above the trusted curve and its band, below the end that was trimmed away
    assert 4.1 < high < 6
