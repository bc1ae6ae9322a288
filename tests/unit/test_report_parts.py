"""A record of which some cycles are stored: nothing is drawn across the others."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from long_records import cycles_of, long_test

from reduction.archive.test_dataset import kept_samples, stored_cycles, to_dataset
from reduction.record.settings import ModulusSettings, ReductionSettings, _ArchiveSettings
from reduction.report.figure_data import with_gaps
from reduction.report.figures.cycle_figures import draw_loops
from reduction.report.figures.record_figures import draw_record, draw_tension_position
from reduction.report.test_view import TestView


def view_of(test, samples="selected", longest=10**6):
    chosen = ReductionSettings(
        archive=_ArchiveSettings(samples, longest), modulus=ModulusSettings(selected_cycles=8)
    )
    kept = kept_samples(test, chosen)
    return TestView("test-0", to_dataset(test, version="1", command="run", kept=kept))


def lines(figure):
    for trace in figure.data:
        if trace["mode"] == "lines":
            yield from pairwise(zip(trace["x"], trace["y"], strict=True))


def test_a_line_of_the_record_never_joins_samples_between_which_cycles_are_left_out():
    test = long_test()
    view = view_of(test)
    (figure,) = draw_record(view)
    joined = [
        (round(10 * one[0]), round(10 * other[0]))
        for one, other in lines(figure)
        if None not in (*one, *other)
    ]
    assert len(joined) > 1000
    is_left = np.ones(test.record.n_samples, dtype=bool)
    is_left[view.data["sample_index"]] = False
    assert not any(is_left[one : other + 1].any() for one, other in joined)
    assert "of the 2,451 samples 614 are stored; the line is broken" in figure.caption.lower()


@pytest.mark.parametrize("n_cycles", [100, 2_000, pytest.param(20_000, marks=pytest.mark.nightly)])
def test_tension_against_position_is_drawn_piece_by_piece(n_cycles):
    cycles = cycles_of(n_cycles, rest=4)
    test = long_test(cycles=cycles)
    # six digits of a position are drawn: here they are its place in the record
    places = 100_000.0 + np.arange(test.record.n_samples)
    test = replace(test, record=replace(test.record, crosshead_position=places))
    (figure,) = draw_tension_position(view_of(test))
    joined = [
        (one[0] - 100_000, other[0] - 100_000)
        for one, other in lines(figure)
        if None not in (*one, *other)
    ]
    assert len(joined) > 100
    crossed = [
        np.flatnonzero((cycles.first >= one) & (cycles.last <= other)) + 1 for one, other in joined
    ]
    assert set(np.concatenate(crossed)) <= set(stored_cycles(view_of(test).data))


def test_a_line_is_broken_where_one_cycle_alone_is_left_out():
    # its first sample is the last of the cycle before it, and its last the first of the next one
    test = long_test(9)
    view = view_of(test)
    assert stored_cycles(view.data).tolist() == [1, 2, 3, 5, 7, 8, 9]
    jump, other = np.flatnonzero(np.diff(view.pieces))
    index = view.data["sample_index"].values
    assert index[jump] == test.cycles.first[3] and index[jump + 1] == test.cycles.last[3]
    assert index[other] == test.cycles.first[5] and index[other + 1] == test.cycles.last[5]


def test_loops_are_those_of_the_nearest_cycles_that_are_stored():
    test = long_test()
    for figure in draw_loops(view_of(test)):
        assert {trace["legendgroup"] for trace in figure.data} == {
            "cycle 1", "cycle 32", "cycle 100",
        }  # fmt: skip
        assert "of those whose samples are stored" in figure.caption
    for figure in draw_loops(view_of(test, "all")):
        assert {trace["legendgroup"] for trace in figure.data} == {
            "cycle 1", "cycle 50", "cycle 100",
        }  # fmt: skip
        assert "stored" not in figure.caption


def test_a_thinned_stretch_is_one_line():
    view = view_of(long_test(n_samples=50_000), longest=4000)
    assert not view.is_whole
    assert not view.pieces.any()


def test_series_of_one_piece_are_drawn_as_they_are():
    values = np.arange(4.0)
    (found,) = with_gaps(np.zeros(4, dtype=int), values)
    np.testing.assert_array_equal(found, values)
