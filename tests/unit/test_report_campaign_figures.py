"""Figures over many tests: each test and each specimen can be told apart and is named."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from reduction.archive.open import open_archive
from reduction.report.figures.campaign_figures import (
    draw_all_moduli,
    draw_parts,
    draw_ratios,
    draw_specimens_together,
    draw_static_dynamic,
)
from reduction.report.figures.cycle_figures import draw_amplitude_pairs
from reduction.report.test_view import TestView


@pytest.fixture(scope="module")
def forty(archives):
    """One rich test under forty names, and a stepwise one."""
    views = {}
    for path in archives:
        with open_archive(path) as data:
            views[path.stem] = TestView("test", data).without_samples()
    rich = views["T-1"]
    return [
        *(replace(rich, data=rich.data.assign_attrs(test=f"T-{k}")) for k in range(1, 41)),
        views["static"],
    ]


def entries(figure):
    return [trace["name"] for trace in figure.data if trace.get("showlegend", True)]


def looks(figure):
    """What a reader can tell traces by, of each trace with a marker and a place."""
    return {
        (trace["marker"]["color"], trace["marker"]["symbol"], trace["name"], trace.get("text"))
        for trace in figure.data
        if "marker" in trace and trace["x"] != [None]
    }


@pytest.mark.parametrize("draw", [draw_all_moduli, draw_ratios, draw_static_dynamic])
@pytest.mark.slow
def test_forty_tests_have_forty_looks_and_a_legend_entry_each(forty, draw):
    figures = draw(forty)
    assert figures
    for figure in figures:
        by_test = {}
        for tint, symbol, name, _ in looks(figure):
            by_test.setdefault(name.split(",")[0], set()).add((tint, symbol.split("-open")[0]))
        ids = {f"T-{k}" for k in range(1, 41)}
        assert ids <= set(by_test)
        assert all(len(by_test[one]) == 1 for one in ids)
        assert len(set.union(*(by_test[one] for one in ids))) == 40
        assert ids <= {name.split(",")[0] for name in entries(figure)}


def test_the_amplitude_figures_name_each_test_and_each_specimen_once(forty):
    figures = draw_amplitude_pairs(forty)
    assert figures
    for figure in figures:
        assert sorted(entries(figure)) == sorted([f"T-{k}" for k in range(1, 41)] + ["new", "used"])
        assert len({look[:2] for look in looks(figure)}) == 80


def test_a_test_of_the_second_specimen_alone_has_a_legend_entry(forty):
    only = forty[0].data.isel(specimen=[1])
    tests = [forty[1], replace(forty[0], data=only)]
    figures = draw_amplitude_pairs(tests)
    assert figures
    for figure in figures:
        assert set(entries(figure)) == {"T-1", "T-2", "new", "used"}


def test_a_test_without_an_ascending_branch_has_a_legend_entry(forty):
    modulus = forty[0].data["tangent_modulus"].copy()
    modulus[:, 0] = np.nan
    tests = [forty[1], replace(forty[0], data=forty[0].data.assign(tangent_modulus=modulus))]
    figures = draw_all_moduli(tests)
    assert figures
    for figure in figures:
        assert "T-1, descending" not in entries(figure)
        assert {"T-1", "T-2"} <= set(entries(figure))


def test_a_part_keeps_the_look_that_it_has_in_the_other_figures(forty):
    parts = [replace(view, data=view.data.assign_attrs(part_of="T-1")) for view in forty[8:10]]
    tests = [*forty[:8], *parts]
    figures = draw_all_moduli(tests)
    assert figures
    for whole, own in zip(figures, draw_parts(tests), strict=True):
        assert looks(own)
        assert looks(own) <= looks(whole)


# all tests of a campaign in one figure: a colour a specimen, the envelope of its cycles, bands

S, B = "specimen", ("specimen", "branch_name", "strain_bin")
NAN = np.nan


def make_view(test, bins, level, *, kind="cyclic", part_of="", specimens=("new", "used")):
    """Ascending at ``level`` MPa, descending at 0.9 of it, the second specimen at twice it.

    Cycles scatter by 0.05 MPa to either side, and the standard uncertainty is 0.01 MPa.
    """
    bins = np.asarray(bins, dtype=np.float64)
    modulus = level * np.array([[[1.0], [0.9]], [[2.0], [1.8]]]) * np.ones(bins.size) * 1e6
    modulus = modulus[: len(specimens)]
    data = {
        "tangent_modulus": (B, modulus),
        "tangent_modulus_standard_uncertainty": (B, np.full(modulus.shape, 1e4)),
        "tangent_modulus_count": (B, np.full(modulus.shape, 1000)),
        "tangent_modulus_minimum": (B, modulus - 5e4),
        "tangent_modulus_maximum": (B, modulus + 5e4),
    }
    own = {S: list(specimens), "branch_name": ["ascending", "descending"], "strain_bin": bins}
    about = {"test": test, "test_kind": kind, "part_of": part_of}
    return TestView(test, xr.Dataset(data, own, about))


def heights(trace, x):
    """Least and greatest of a band, or of a line, where it passes a place."""
    near = [y for at, y in zip(trace["x"], trace["y"], strict=True)
            if at is not None and abs(at - x) < 0.2]  # fmt: skip
    return min(near), max(near)


def test_the_envelope_of_a_specimen_holds_both_branches_of_all_its_tests():
    views = [make_view("T-1", [0.9, 1.1], 1.0), make_view("T-2", [0.5, 1.5], 2.0)]
    (figure,) = draw_specimens_together(views)
    traces = {trace["name"]: trace for trace in figure.data if trace.get("showlegend", True)}
    assert set(traces) == {"new: envelope", "used: envelope", "new", "used"}
    # at 100 % both: 0.9 * 1 - 0.05 to 2 + 0.05 MPa; at 60 % the second test alone
    assert heights(traces["new: envelope"], 100) == pytest.approx((0.85, 2.05))
    assert heights(traces["new: envelope"], 60) == pytest.approx((1.75, 2.05))
    assert heights(traces["used: envelope"], 100) == pytest.approx((1.75, 4.05))


def test_a_specimen_has_one_colour_and_one_entry_in_the_legend():
    views = [make_view("T-1", [0.9, 1.1], 1.0), make_view("T-2", [0.5, 1.5], 2.0)]
    (figure,) = draw_specimens_together(views)
    curves = [trace for trace in figure.data if "fill" not in trace]
    assert len(curves) == 8
    assert {(trace["name"], trace["line"]["color"]) for trace in curves} == {
        ("new", "#0072B2"), ("used", "#D55E00"),
    }  # fmt: skip
    assert [trace["showlegend"] for trace in curves].count(True) == 2
    assert {trace["marker"]["symbol"] for trace in curves} == {"circle", "square"}
    assert {trace["line"]["dash"] for trace in curves} == {"solid", "dash"}


def test_each_test_is_named_once_above_the_highest_of_its_curves():
    views = [make_view("T-1", [0.9, 1.1], 1.0), make_view("<b>", [0.5, 1.5], 2.0)]
    (figure,) = draw_specimens_together(views)
    labels = [(one["text"], one["x"], one["y"]) for one in figure.layout["annotations"]]
    # the second specimen is twice as stiff
    assert labels == [("T-1", 110.0, 2.0), ("&lt;b&gt;", 150.0, 4.0)]


def test_labels_of_many_tests_would_cover_the_curves():
    views = [make_view(f"T-{k}", [0.9, 1.1], 1.0 + k) for k in range(11)]
    (figure,) = draw_specimens_together(views)
    assert figure.layout["annotations"] == []
    assert "T-10, ascending" in {trace.get("text") for trace in figure.data}


def test_long_tests_and_parts_of_them_are_left_out_and_named():
    views = [
        make_view("T-1", [0.9, 1.1], 1.0),
        make_view("T-4-long", [0.9, 1.1], 3.0, kind="fatigue"),
        make_view("T-4-start", [0.9, 1.1], 3.0, part_of="T-4-long"),
    ]
    (figure,) = draw_specimens_together(views)
    assert "Not shown: T-4-long, T-4-start." in figure.caption
    assert max(y for trace in figure.data for y in trace["y"] if y is not None) < 2.1
    (alone,) = draw_specimens_together(views[1:])
    assert "Not in it" not in alone.caption


def test_one_test_of_one_specimen_has_nothing_beside_it():
    assert draw_specimens_together([make_view("T-1", [0.9, 1.1], 1.0, specimens=("new",))]) == []


def test_static_moduli_have_bars_over_the_curves():
    static = xr.Dataset(
        {
            "interval_modulus": ("interval", [1e6, np.nan, 2e6]),
            "interval_modulus_standard_uncertainty": ("interval", [1e5, np.nan, np.nan]),
            "interval_strain": ("interval", [0.9, 1.0, 1.1]),
            "interval_branch": ("interval", [1, 1, 1]),
        },
        {S: ["new"]}, {"test": "weights"},
    )  # fmt: skip
    dynamic = make_view("T-1", [0.9, 1.1], 1.0)
    figures = draw_static_dynamic([dynamic, TestView("static", static)])
    points = figures[0].data[-1]
    assert points["y"] == [1.0, 2.0]
    # none where none is known
    assert points["error_y"]["array"] == pytest.approx([0.196, 0.0], abs=1e-3)
    assert "bars, ±: expanded uncertainty, 95 %" in figures[0].caption


def test_without_a_curve_there_is_no_figure():
    empty = make_view("T-1", [0.9, 1.1], NAN)
    assert draw_specimens_together([]) == []
    assert draw_specimens_together([empty]) == []
    assert draw_all_moduli([empty]) == []


def test_every_curve_of_a_campaign_has_its_band_and_the_caption_says_what_it_is():
    views = [make_view("T-1", [0.9, 1.1], 1.0), make_view("T-2", [0.9, 1.1], 2.0)]
    figures = draw_all_moduli(views)
    assert [figure.title for figure in figures] == ["All tests: modulus, new",
                                                    "All tests: modulus, used"]  # fmt: skip
    bands = {trace["name"]: trace for trace in figures[0].data if "fill" in trace}
    assert set(bands) == {"T-1: ±", "T-1, descending: ±", "T-2: ±", "T-2, descending: ±"}
    assert heights(bands["T-1: ±"], 90) == pytest.approx((1 - 0.0196, 1 + 0.0196), abs=2e-4)
    assert "Band, ±: expanded uncertainty, 95 % (k = 1.96)" in figures[0].caption


def test_a_band_of_one_bin_does_not_set_the_axis():
    view = make_view("T-1", np.linspace(0.5, 1.5, 101), 1.0)
    spread = view.data["tangent_modulus_standard_uncertainty"].copy()
    spread[..., 0] = 1e7
    wide = TestView("k", view.data.assign(tangent_modulus_standard_uncertainty=spread))
    low, high = draw_all_moduli([wide])[0].layout["yaxis"]["range"]
    assert low == 0
    assert 1.0 < high < 1.2


def test_parts_of_a_long_test_have_bands_too():
    views = [make_view(f"L-{part}", [0.9, 1.1], 1.0, part_of="L") for part in ("start", "end")]
    figures = draw_parts(views)
    assert [figure.title for figure in figures] == ["L: its parts, new", "L: its parts, used"]
    assert sum("fill" in trace for trace in figures[0].data) == 4
    assert "Band, ±" in figures[0].caption


def with_ratio(view, numerator, denominator):
    ratio = np.array([[[1.1, 1.2], [0.9, 0.8]]])
    dims = ("comparison", "branch_name", "ratio_strain_bin")
    return TestView(
        view.key,
        view.data.assign(
            modulus_ratio=(dims, ratio),
            modulus_ratio_low=(dims, ratio - 0.05),
            modulus_ratio_high=(dims, ratio + 0.05),
            ratio_numerator=("comparison", [numerator]),
            ratio_denominator=("comparison", [denominator]),
        ).assign_coords(ratio_strain_bin=[0.9, 1.1]),
    )


def test_a_ratio_that_one_test_has_is_one_figure_of_both_branches():
    view = make_view("T-4-long", [0.9, 1.1], 1.0)
    view = with_ratio(view, "new, cycles 2997, 2999", "new, cycles 1, 3")
    (figure,) = draw_ratios([view, make_view("T-1", [0.9, 1.1], 1.0)])
    assert figure.title == "T-4-long: modulus, end over start, new"
    curves = {trace["name"]: trace for trace in figure.data if "fill" not in trace}
    assert curves["ascending"]["y"] == [1.1, 1.2]
    assert curves["descending"]["y"] == [0.9, 0.8]
    assert curves["ascending"]["line"]["color"] != curves["descending"]["line"]["color"]
    assert "new, cycles 2997, 2999 over that of new, cycles 1, 3" in figure.caption


def test_a_ratio_that_many_tests_have_is_a_figure_a_branch():
    views = [with_ratio(make_view(f"T-{k}", [0.9, 1.1], 1.0), "used", "new") for k in (1, 2)]
    figures = draw_ratios(views)
    assert [figure.title for figure in figures] == [
        "Modulus, used over new, ascending", "Modulus, used over new, descending",
    ]  # fmt: skip
    assert {trace["name"] for trace in figures[0].data} == {"T-1", "T-2"}
