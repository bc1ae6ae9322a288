"""Drop-outs of the channel are told from reversals."""

import numpy as np
import pytest

from reduction.stages.cycles.reversals import drop_jumps, find_reversals


def stroke(n_cycles=6, half=50):
    return np.append(np.tile(np.r_[np.arange(half), np.arange(half, 0, -1)], n_cycles), 0) + 100.0


@pytest.mark.parametrize("level", [0.0, 130.0, 300.0])
@pytest.mark.parametrize("length", [1, 3, 8])
@pytest.mark.parametrize("at", [120, 145, 151, 170, 185, 203])
def test_a_drop_out_leaves_the_number_of_reversals(level, length, at):
    values = stroke()
    whole = find_reversals(values, band=10)
    values[at : at + length] = level
    kept, _ = drop_jumps(values, find_reversals(values, band=10))
    assert kept.size == whole.size
    steps = np.diff(values[kept])
    assert (steps[1:] * steps[:-1] < 0).all()


def test_where_a_jump_was_is_returned():
    values = stroke()
    values[120:122] = 0
    assert drop_jumps(values, find_reversals(values, band=10))[1].tolist() == [119]


def test_cycles_of_few_samples_are_no_jumps():
    values = np.tile([0.0, 1, 2, 1], 20)
    reversals = find_reversals(values, band=1)
    assert drop_jumps(values, reversals)[0].tolist() == reversals.tolist()


def test_a_square_wave_is_no_row_of_jumps_and_back():
    values = np.repeat(np.tile([0.0, 1.0], 10), 40)
    reversals = find_reversals(values, band=0.5)
    assert drop_jumps(values, reversals)[0].tolist() == reversals.tolist()


def test_fewer_than_four_reversals_are_returned_as_they_are():
    values = np.r_[np.arange(50.0), np.arange(50.0, 0, -1)]
    assert drop_jumps(values, np.array([0, 50, 99]))[0].tolist() == [0, 50, 99]


def test_a_preload_before_the_channel_is_set_to_zero_is_no_part_of_the_first_cycle():
    # synthetic: 8 samples of preload to 120, set back to 100 as the strokes begin
    values = np.concatenate([100 + 2.5 * np.arange(9.0), stroke()])
    reversals, jumps = drop_jumps(values, find_reversals(values, band=10))
    assert reversals.tolist() == (9 + find_reversals(stroke(), band=10)).tolist()
    assert jumps.tolist() == [8]
    # a drop-out at the same place comes back, and the first stroke goes on
    values = stroke()
    values[12:14] = 0
    assert drop_jumps(values, find_reversals(values, band=10))[0][0] == 0
