"""Loops drawn: as they are, and less a straight line so that they open."""

import numpy as np
import pytest
import xarray as xr

from reduction.report.figures.cycle_figures import draw_loops
from reduction.report.test_view import TestView


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
