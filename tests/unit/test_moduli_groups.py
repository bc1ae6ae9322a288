"""Groups of cycles: break-in apart, no short last group, and the cycles whose curves are kept."""

from itertools import pairwise

import numpy as np
import pytest

from reduction.record.errors import DataError
from reduction.stages.moduli.local_regression import CycleGroups, select_cycles


def test_a_cycle_is_a_group_where_none_are_pooled():
    groups = CycleGroups.of(5, 0, 1)
    assert list(groups.first) == [0, 1, 2, 3, 4]
    assert list(groups.of_cycle) == [-1, 0, 1, 2, 3, 4]
    assert not groups.is_break_in.any()


def test_last_group_takes_the_remainder():
    groups = CycleGroups.of(11, 0, 3)
    assert list(groups.first) == [0, 3, 6]
    assert np.bincount(groups.of_cycle[1:]).tolist() == [3, 3, 5]


def test_break_in_cycles_share_no_group_with_the_others():
    groups = CycleGroups.of(10, 4, 3)
    assert list(groups.first) == [0, 3, 4, 7]
    assert list(groups.is_break_in) == [True, True, False, False]


def test_fewer_cycles_than_a_group_wants_are_one_group():
    groups = CycleGroups.of(3, 1, 8)
    assert list(groups.first) == [0, 1]


def test_blocks_follow_each_other_and_hold_whole_groups(triangle):
    _, cycles = triangle(n_cycles=2000, per_cycle=100)
    groups = CycleGroups.of(2000, 0, 3)
    blocks = list(groups.blocks(cycles, 50))
    assert len(blocks) > 1
    assert blocks[0][0] == 0
    assert blocks[-1][1] == groups.first.size
    assert all(one[1] == other[0] for one, other in pairwise(blocks))
    for start, stop, samples in blocks:
        of_group = groups.of_cycle[cycles.cycle_number]
        inside = np.flatnonzero((of_group >= start) & (of_group < stop))
        assert samples.start <= inside[0]
        assert samples.stop > inside[-1]


def test_long_test_keeps_first_last_and_spaced_cycles():
    numbers = select_cycles(3000, longest=24)
    assert len(numbers) <= 24
    assert list(numbers[:3]) == [1, 2, 3]
    assert list(numbers[-3:]) == [2998, 2999, 3000]
    assert np.max(numbers[4:-3] / numbers[3:-4]) < 1.7


@pytest.mark.parametrize("n_cycles", [1, 24])
def test_short_test_keeps_every_cycle(n_cycles):
    assert list(select_cycles(n_cycles, longest=24)) == list(range(1, n_cycles + 1))


def test_selection_from_no_cycle_is_refused():
    with pytest.raises(DataError, match="no cycle to select; found 0"):
        select_cycles(0, longest=24)
