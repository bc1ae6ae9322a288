"""Trends over many cycles: thinned, said so, and no more worked out than is drawn."""

import tracemalloc

import numpy as np
import pytest
import xarray as xr

from reduction.report.figures.cycle_figures import draw_trends
from reduction.report.test_view import TestView

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
