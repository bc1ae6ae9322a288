"""Figures over many tests: each test and each specimen can be told apart and is named."""

from dataclasses import replace

import numpy as np
import pytest

from reduction.archive.open import open_archive
from reduction.report.figures.campaign_figures import (
    draw_all_moduli,
    draw_parts,
    draw_ratios,
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
