"""Cycles by the machine's counter, whatever is missing in them."""

import numpy as np
import pytest

from reduction.record.errors import DataError
from reduction.stages.cycles.cycle_search import _counted_cycles


def test_branches_lie_between_the_extremes_of_the_counted_samples():
    # the count changes before the valley, as the crosshead lags behind the command
    position = np.array([2.0, 1, 0, 1, 2, 3, 2, 1, 0.5, 1, 2, 3, 2, 1])
    counter = np.array([1, 1, 1, 1, 1, 1, 1, 2, 2, 2, 2, 2, 2, 2])
    first, last, begin, end, number = _counted_cycles(counter, position)
    assert (first.tolist(), last.tolist(), number.tolist()) == ([0, 7], [6, 13], [1, 2])
    assert begin.tolist() == [[2, 5], [8, 11]]
    assert end.tolist() == [[5, 6], [11, 13]]


def test_samples_before_the_first_count_are_outside():
    first, *_ = _counted_cycles(np.array([0, 0, 1, 1, 0]), np.arange(5.0))
    assert first.tolist() == [2]


def test_a_cycle_without_samples_has_branches_of_one_sample():
    position = np.array([0.0, 1, 0, np.nan, np.nan, np.nan])
    _, _, begin, end, _ = _counted_cycles(np.array([1, 1, 1, 2, 2, 2]), position)
    assert begin[1].tolist() == [3, 3] and end[1].tolist() == [3, 5]


def test_missing_samples_are_passed_over():
    position = np.array([np.nan, 0, 1, np.nan, 2, 1, np.nan])
    _, _, begin, end, _ = _counted_cycles(np.ones(7, dtype=int), position)
    assert begin.tolist() == [[1, 4]] and end.tolist() == [[4, 5]]


def test_a_count_that_runs_backward_is_refused():
    counter = np.array([0, 1, 1, 3, 3, 2, 2, 4, 3])
    with pytest.raises(DataError, match="counter runs backward 2 times; found 2 after 3"):
        _counted_cycles(counter, np.arange(9.0))


def test_a_count_may_begin_again_with_one_and_stand_at_zero_between():
    counter = np.array([1, 1, 1, 2, 2, 2, 0, 0, 1, 1, 1, -1])
    *_, number = _counted_cycles(counter, np.tile([0.0, 1, 0], 4))
    assert number.tolist() == [1, 2, 1]
