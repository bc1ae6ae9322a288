"""Figures of long tests: specimens stay apart where their cycles do not, slips are named."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from long_records import long_test

from reduction.archive.test_dataset import to_dataset
from reduction.report.figures.cycle_figures import draw_trends
from reduction.report.figures.record_figures import draw_record
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
