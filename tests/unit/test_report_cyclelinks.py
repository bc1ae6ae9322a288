"""The cycles that a reader can choose on the page, and the line that says what is in a test."""

import json
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from reduction.report.campaign_summary import brief
from reduction.report.test_section import MOST, _cycle_links
from reduction.report.test_view import TestView


def view_of(start, frequency, **more):
    start, frequency = np.atleast_2d(start), np.atleast_2d(frequency)
    dims = ("specimen", "cycle")
    return TestView(
        "test-0",
        xr.Dataset(
            {"cycle_start_time": (dims, start), "frequency": (dims, frequency), **more},
            coords={"cycle": np.arange(1, start.shape[1] + 1)},
        ),
    )


def test_a_cycle_lasts_from_its_start_for_one_period():
    found = _cycle_links(view_of([100.0, 110.0, 135.0], [0.1, 0.04, 0.2]))
    assert found.count == 3
    np.testing.assert_allclose(found.end - found.start, [10, 25, 5])


def test_a_cycle_that_one_specimen_did_not_see_is_timed_by_the_other():
    found = _cycle_links(view_of([[0.0, np.nan], [0.0, 4.0]], [[0.25, np.nan], [0.25, 0.25]]))
    np.testing.assert_array_equal(found.start, [0.0, 4.0])
    np.testing.assert_array_equal(found.end, [4.0, 8.0])


def test_a_cycle_whose_time_nobody_knows_has_none_on_the_page():
    found = _cycle_links(view_of([0.0, np.nan, 8.0], [0.25, 0.25, np.nan]))
    assert json.loads(found.json()) == {
        "count": 3, "start": [0.0, None, 8.0], "end": [4.0, None, None],
    }  # fmt: skip


@pytest.mark.parametrize("view", [
    view_of([1.0], [0.1]),
    TestView("test-0", xr.Dataset(coords={"cycle": [1, 2, 3]})),
    TestView("test-0", xr.Dataset()),
])  # fmt: skip
def test_without_two_cycles_or_their_times_there_is_nothing_to_choose(view):
    assert _cycle_links(view) is None


def test_of_very_many_cycles_the_first_the_last_and_those_with_a_curve_are_listed():
    n_cycles = 100_000
    drawn = [1.0, 54_321.0, 99_999.0]
    found = _cycle_links(
        view_of(10.0 * np.arange(n_cycles), np.full(n_cycles, 0.1), selected_cycle=("kept", drawn))
    )
    assert found.count == n_cycles
    assert MOST <= found.number.size <= MOST + 6
    assert {1, 54_321, 99_999, 50_000, n_cycles} <= set(found.number)
    assert np.diff(found.number).max() <= np.ceil(n_cycles / (MOST - 1))
    np.testing.assert_allclose(found.start, 10.0 * (found.number - 1))
    assert len(found.json()) < 150_000


def test_a_line_says_how_many_cycles_of_which_strain_and_what_is_doubted():
    view = view_of(
        [0.0, 1.0], [1.0, 1.0],
        mean_strain=(("specimen", "cycle"), [[1.0, 1.0]]),
        strain_amplitude=(("specimen", "cycle"), [[0.25, 0.25]]),
        note=("note", ["tests: a plain note"]), note_stage=("note", ["tests"]),
        note_code=("note", ["plain"]), note_severity=("note", ["note"]),
        note_effect=("note", [np.nan]),
    )  # fmt: skip
    assert brief(view) == "2 cycles, strain 75.0 to 125.0 %"
    doubted = replace(view, data=view.data.assign(note_severity=("note", ["warning"])))
    assert brief(doubted) == "2 cycles, strain 75.0 to 125.0 %, check"


def test_a_line_says_nothing_of_what_is_not_there():
    assert brief(TestView("test-0", xr.Dataset())) == ""
