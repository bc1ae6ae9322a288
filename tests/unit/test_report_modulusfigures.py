"""The modulus of a test drawn: what is trusted, and what was trimmed away beside it."""

import numpy as np
import xarray as xr

from reduction.report.figures.modulus_figures import draw_moduli
from reduction.report.test_view import TestView

NAN = np.nan
TRIMMED = np.array([NAN, NAN, 2.0, 3.0, 4.0, NAN])
WHOLE = np.array([NAN, 1.5, 2.1, 3.0, 4.1, 9.0])


def make_view(trimmed=TRIMMED, whole=WHOLE, half=0.1):
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


def traces_of(view):
    (figure,) = draw_moduli(view)
    return {trace["name"]: trace for trace in figure.data}, figure


def test_what_was_trimmed_away_is_drawn_to_both_sides_and_joins_the_curve():
    traces, figure = traces_of(make_view())
    assert traces["ascending"]["y"] == [None, None, 2.0, 3.0, 4.0, None]
    assert traces["ascending, trimmed away"]["y"] == [None, 1.5, 2.1, None, 4.1, 9.0]
    assert traces["ascending, trimmed away"]["line"]["dash"] == "dot"
    assert "trimmed ends" in figure.caption


def test_where_nothing_was_trimmed_there_is_no_line_for_it():
    traces, _ = traces_of(make_view(whole=TRIMMED))
    assert [name for name in traces if "trimmed" in name] == []


def test_a_branch_without_a_trimmed_curve_is_drawn_as_trimmed_away():
    traces, _ = traces_of(make_view(trimmed=np.full(6, NAN)))
    assert "ascending" not in traces
    assert traces["ascending, trimmed away"]["y"] == [None, 1.5, 2.1, 3.0, 4.1, 9.0]


def test_the_axis_goes_by_what_is_trusted_not_by_what_was_trimmed():
    _, figure = traces_of(make_view())
    low, high = figure.layout["yaxis"]["range"]
    assert low == 0
    # above the trusted curve and its band, below the end that was trimmed away
    assert 4.1 < high < 6
