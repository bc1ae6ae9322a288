"""Cycles by the machine's counter, whatever is missing in them."""

from functools import partial

import numpy as np
import pytest

from reduction.record.errors import DataError
from reduction.record.settings import CycleSettings, PhaseSettings
from reduction.stages.cycles import cycle_search
from reduction.stages.cycles.levels import find_levels
from reduction.stages.cycles.loop_sense import unlike_neighbours
from reduction.stages.cycles.loops import close_loops
from reduction.stages.cycles.machine_counter import counted_cycles, counter_notes
from reduction.stages.moduli.loop_balance import check_identity
from reduction.stages.standstills import find_standstills


def counted(counter, values):
    return counted_cycles(np.arange(float(values.size)), values, counter)


def test_branches_lie_between_the_extremes_of_the_counted_samples():
    # the count changes before the valley, as the crosshead lags behind the command
    position = np.array([2.0, 1, 0, 1, 2, 3, 2, 1, 0.5, 1, 2, 3, 2, 1])
    counter = np.array([1, 1, 1, 1, 1, 1, 1, 2, 2, 2, 2, 2, 2, 2])
    first, last, begin, end, number = counted(counter, position)
    assert (first.tolist(), last.tolist(), number.tolist()) == ([0, 7], [7, 13], [1, 2])
    assert begin.tolist() == [[2, 5], [8, 11]]
    assert end.tolist() == [[5, 7], [11, 13]]


def test_a_cycle_ends_with_its_count_where_the_log_has_a_gap():
    time = np.array([0.0, 1, 2, 3, 50, 51, 52, 53])
    counter = np.array([1, 1, 1, 1, 20, 20, 20, 20])
    first, last, *_ = counted_cycles(time, np.tile([0.0, 2, 1, 0.1], 2), counter)
    assert (first.tolist(), last.tolist()) == ([0, 4], [3, 7])


@pytest.mark.parametrize("late", [-3, 0, 3, 25, 50, 75])
def test_a_cycle_is_a_period_wherever_in_it_the_machine_counts(late):
    """Twelve cycles of 100 readings from valley to valley, after a ramp from slack."""
    step = np.arange(1200)
    approach = np.concatenate([np.zeros(300), np.linspace(0, 1, 100)])
    position = np.concatenate([approach, 2 - np.cos(2 * np.pi * step / 100)])
    position += 1e-4 * np.random.default_rng(0).standard_normal(position.size)
    counter = np.concatenate([np.zeros(400, dtype=int), (step - late) // 100 + 4])
    time = 0.1 * np.arange(position.size)
    tension = [100 * position]
    cycles = cycle_search.find_cycles(
        time, position, tension,
        find_standstills(time, position, tension, settings=PhaseSettings()),
        settings=CycleSettings(waveform="sinusoidal"), cycle_counter=counter,
    )  # fmt: skip
    assert 11 <= cycles.n_cycles <= 12
    span = cycles.last - cycles.first
    assert np.abs(span[:-1] - 100).max() <= 3
    assert np.abs(span[1:-1].mean() - 100) < 0.5
    # the valley of each is at a multiple of 100 readings; a count that is late begins in it
    nearest = np.round((cycles.first - 400) / 100).astype(int)
    assert (cycles.number - nearest).tolist() == [4 - (late >= 50)] * cycles.n_cycles
    assert "counter-differs" not in [one.code for one in cycles.notes]


@pytest.mark.parametrize("wraps_at", [5, 11])
def test_the_way_down_after_the_last_count_of_a_counter_that_wraps_is_no_cycle(wraps_at):
    """Eleven cycles of 100 readings, counted at the valleys; the last count of 5 begins with 1."""
    step = np.arange(1125)
    position = np.concatenate([
        np.linspace(0, 2, 200), 2 + np.sin(2 * np.pi * step / 100), np.linspace(3, 0, 200)
    ])  # fmt: skip
    n_valleys = np.clip((np.arange(position.size) - 175) // 100, 0, 11)
    counter = np.where(n_valleys > 0, (n_valleys - 1) % wraps_at + 1, 0)
    time = 0.1 * np.arange(position.size)
    tension = [100 * position]
    cycles = cycle_search.find_cycles(
        time, position, tension,
        find_standstills(time, position, tension, settings=PhaseSettings()),
        settings=CycleSettings(waveform="sinusoidal"), cycle_counter=counter,
    )  # fmt: skip
    stroke = position[cycles.branch_first[:, 1]] - position[cycles.branch_last[:, 1]]
    np.testing.assert_allclose(stroke, 2.0, rtol=0.01)
    assert "counter-skips" not in [one.code for one in cycles.notes]


def test_numbers_go_on_over_gaps_of_the_log_that_hold_cycles():
    """Five cycles each from the 1st, 100th and 1000th on, at 1 Hz, none counted by the machine."""
    begin = np.array([1, 100, 1000])
    time = (begin[:, None] - 1 + np.arange(0, 5, 0.02)).ravel()
    position = 2 - np.cos(2 * np.pi * time)
    standing = find_standstills(time, position, [100 * position], settings=PhaseSettings())
    find = partial(
        cycle_search.find_cycles, time, position, [100 * position], standing,
        settings=CycleSettings(waveform="sinusoidal"),
    )  # fmt: skip
    cycles = find()
    assert cycles.number[0] == 1 and not cycles.is_count_sure
    assert np.abs(cycles.number - (np.round(time[cycles.first]) + 1)).max() <= 1
    counted = find(cycle_counter=(time + 1).astype(int))
    assert counted.is_count_sure
    assert counted.number.tolist() == (np.round(time[counted.first]) + 1).tolist()


def test_samples_before_the_first_count_are_outside():
    first, *_ = counted(np.array([0, 0, 1, 1, 0]), np.arange(5.0))
    assert first.tolist() == [2]


def test_a_cycle_without_samples_has_branches_of_one_sample():
    position = np.array([0.0, 1, 0, np.nan, np.nan, np.nan])
    _, _, begin, end, _ = counted(np.array([1, 1, 1, 2, 2, 2]), position)
    assert begin[1].tolist() == [3, 3] and end[1].tolist() == [3, 5]


def test_missing_samples_are_passed_over():
    position = np.array([np.nan, 0, 1, np.nan, 2, 1, np.nan])
    _, _, begin, end, _ = counted(np.ones(7, dtype=int), position)
    assert begin.tolist() == [[1, 4]] and end.tolist() == [[4, 5]]


def test_a_count_that_runs_backward_is_refused():
    counter = np.array([0, 1, 1, 3, 3, 2, 2, 4, 3])
    with pytest.raises(DataError, match="counter runs backward 2 times; found 2 after 3"):
        counted(counter, np.arange(9.0))


def test_a_count_may_begin_again_with_one_and_stand_at_zero_between():
    counter = np.array([1, 1, 1, 2, 2, 2, 0, 0, 1, 1, 1, -1])
    *_, number = counted(counter, np.tile([0.0, 1, 0], 4))
    assert number.tolist() == [1, 2, 1]


def stored_cycles(number, begins, *, per_cycle=64):
    """Sine under load with creep, of which the machine stores the cycles of these numbers alone.

    Amplitudes 500 N and 0.01, strain late by 0.05 rad: K_ap 50 kN, H = pi 500 N 0.01 sin(0.05).
    """
    phase = (number[:, None] - 1 + begins + np.arange(per_cycle) / per_cycle).ravel()
    random = np.random.default_rng(2)
    tension = 1000 - 500 * np.cos(2 * np.pi * phase) + 0.3 * random.standard_normal(phase.size)
    strain = 0.05 - 0.01 * np.cos(2 * np.pi * phase - 0.05) + 0.02 * np.log10(1 + phase)
    strain += 3e-6 * random.standard_normal(phase.size)
    return phase, tension, strain, np.repeat(number, per_cycle)


@pytest.mark.parametrize("is_rows", [False, True])
@pytest.mark.parametrize("begins", [0, 0.25, 0.9])
def test_cycles_stored_one_in_hundreds_are_not_mixed(begins, is_rows):
    """Wherever the count changes, and whether or not the time shows what was not stored."""
    number = np.concatenate([np.arange(1, 31), np.arange(500, 20001, 500)])
    phase, tension, strain, counter = stored_cycles(number, begins)
    time = np.arange(phase.size) / 64 if is_rows else phase
    stands = find_standstills(time, strain, [tension], settings=PhaseSettings())
    cycles = cycle_search.find_cycles(
        time, strain, [tension], stands, cycle_counter=counter,
        settings=CycleSettings(waveform="sinusoidal", control="load"),
    )  # fmt: skip
    loops = close_loops(
        time, tension[None], strain[None], cycles, waveform="sinusoidal", control="load"
    )
    alone = cycles.number > 500
    assert cycles.number[alone].tolist() == number[number > 500].tolist()
    true_energy = np.pi * 500 * 0.01 * np.sin(0.05)
    assert np.abs(loops.hysteresis_energy[0, alone] / true_energy - 1).max() < 0.01
    assert np.abs(loops.apparent_spring_constant[0, alone] / 5e4 - 1).max() < 1e-3


@pytest.mark.parametrize("control", ["load", "position"])
@pytest.mark.parametrize("begins", [0, 0.1, 0.25, 0.75, 0.9])
def test_stiffness_of_cycles_stored_alone_is_theirs_wherever_the_count_changes(begins, control):
    """A line of 50 kN whose strain lags by 0.03 rad, and which creeps, or relaxes, in each cycle."""
    number = np.concatenate([np.arange(1, 11), np.arange(13, 60, 3)])
    phase = (number[:, None] - 1 + begins + np.arange(72) / 72).ravel()
    creep = 4e-4 * phase * (control == "load")
    strain = 0.1 + creep - 0.08 * np.cos(2 * np.pi * phase - 0.03)
    tension = 5000 - 4000 * np.cos(2 * np.pi * phase) - 10 * phase * (control == "position")
    time = np.arange(phase.size) * 0.005
    stands = find_standstills(time, strain, [tension], settings=PhaseSettings())
    cycles = cycle_search.find_cycles(
        time, strain, [tension], stands, cycle_counter=np.repeat(number, 72),
        settings=CycleSettings(control=control),
    )  # fmt: skip
    loops = close_loops(
        time, tension[None], strain[None], cycles, waveform="other", control=control
    )
    assert unlike_neighbours(time, strain, cycles, stands) == 0
    assert not find_levels(time, tension if control == "load" else strain, cycles)
    balance = check_identity(
        strain[None], tension[None], area=[1e-4], cycles=cycles, control=control
    )
    assert not balance.notes
    alone = cycles.number > 10
    assert loops.apparent_spring_constant[0, alone] == pytest.approx(5e4, rel=1.5e-3)
    assert loops.storage_spring_constant[0, alone] == pytest.approx(5e4 * np.cos(0.03), rel=2e-3)
    assert loops.loss_factor[0, alone] == pytest.approx(np.tan(0.03), rel=0.04)


def test_blocks_of_cycles_are_not_mixed_where_the_count_skips():
    """Five cycles in a thousand: the one across a skip is made of two that are not neighbours."""
    number = (np.arange(0, 10000, 1000)[:, None] + np.arange(1, 6)).ravel()
    phase, tension, strain, counter = stored_cycles(number, 0.5)
    time = np.arange(phase.size) / 64
    stands = find_standstills(time, strain, [tension], settings=PhaseSettings())
    cycles = cycle_search.find_cycles(
        time, strain, [tension], stands, cycle_counter=counter,
        settings=CycleSettings(waveform="other", control="load"),
    )  # fmt: skip
    assert cycles.n_cycles == 40  # from valley to valley, four in each block
    skips = np.flatnonzero(np.diff(counter) > 1)
    for after in skips:
        assert not ((cycles.first <= after) & (after < cycles.last)).any()


def test_single_cycles_stored_from_peak_to_peak_are_left_out_with_a_reason():
    number = np.concatenate([np.arange(1, 31), np.arange(500, 20001, 500)])
    _, tension, strain, counter = stored_cycles(number, 0.5)
    time = np.arange(tension.size) / 64
    stands = find_standstills(time, strain, [tension], settings=PhaseSettings())
    cycles = cycle_search.find_cycles(
        time, strain, [tension], stands, cycle_counter=counter,
        settings=CycleSettings(waveform="sinusoidal", control="load"),
    )  # fmt: skip
    assert cycles.number.max() <= 30
    assert "stored-from-peak" in [one.code for one in cycles.notes]


@pytest.mark.parametrize(("number", "n_reversals", "differs"), [
    (range(1, 11), 8, False), (range(1, 11), 7, True),  # one count is cut off at each end
    ([*range(1, 6), *range(11, 16)], 6, False), ([*range(1, 6), *range(11, 16)], 5, True),
])  # fmt: skip
def test_each_part_of_a_log_may_lack_a_cycle_at_both_of_its_ends(number, n_reversals, differs):
    wave = np.append(np.tile([0.0, 1.0], 10), 0.0)
    ends = np.arange(20).reshape(10, 2)
    found = counter_notes(wave, ends, ends + 1, np.array(number), n_reversals, 0.1)
    assert ("counter-differs" in [one.code for one in found]) is differs


def test_a_count_that_changes_on_the_rise_begins_there():
    phase = np.arange(80)
    counter = 1 + phase // 40
    first, last, *_ = counted(counter, np.sin(2 * np.pi * phase / 40))
    assert (first.tolist(), last.tolist()) == ([0, 40], [40, 79])


def test_noise_on_the_rise_makes_no_valley_of_its_first_readings():
    """With 2,000 readings per cycle, noise of 0.25 % of the range puts the lowest a few on."""
    turn = np.arange(24_000) / 2000
    wave = -np.cos(2 * np.pi * turn) + np.random.default_rng(0).normal(0, 0.005, turn.size)
    first, *_ = counted(np.floor(turn - 0.25) + 2, wave)
    assert np.diff(first)[1:].tolist() == [2000] * (first.size - 2)
