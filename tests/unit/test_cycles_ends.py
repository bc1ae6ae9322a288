"""Ends of a run: a wait is told from the turns of the run, whatever is missing in it."""

import numpy as np
import pytest
from located_cycles import cycles_of_log

from reduction.record.settings import CycleSettings, PhaseSettings
from reduction.stages.cycles.cycle_pairing import _without_stands
from reduction.stages.cycles.cycle_search import _steady_span, find_cycles
from reduction.stages.standstills import find_standstills

STROKES = [2.0, 4, 2, 4, 2]


def moved(values, nodes):
    return _without_stands(
        np.array(values), np.array(nodes), first=0, last=len(values) - 1, tolerance=0.1
    ).tolist()


@pytest.mark.parametrize(
    ("wait", "first"), [([2, 2, 2], 3), ([2, np.nan, 2], 3), ([2, 2, np.nan], 3)]
)
def test_missing_samples_of_a_wait_do_not_end_it(wait, first):
    nodes = [0, *range(first + 1, first + 5)]
    assert moved([*wait, *STROKES], nodes) == [first, *nodes[1:]]


def test_an_end_is_moved_to_a_sample_that_is_there():
    # as far before the end of the stand as the turns of the run lie, where nothing was read
    values = [2.0, 2, 2, 2, np.nan, 2, 4, 2, 2, 4, 2, 2, 4, 2, 2]
    assert moved(values, [0, 6, 7, 9, 10, 12, 13])[0] == 3


def test_a_wait_after_the_last_stroke_is_left_out_likewise():
    assert moved([*STROKES, 2, 2, 2], [0, 1, 2, 3, 7]) == [0, 1, 2, 3, 4]


def test_a_hold_of_every_valley_is_no_wait():
    values = [2.0, 2, 2, 2, 4] * 3 + [2, 2, 2, 2]
    nodes = [0, 4, 5, 9, 10, 14, 15]
    assert moved(values, nodes) == nodes


def test_two_extremes_have_no_turn_to_be_held_against():
    assert moved([2.0, 2, 2, 2, 4], [0, 4]) == [0, 4]


@pytest.mark.parametrize("seed", range(6))
def test_a_wait_that_flickers_between_two_codes_of_a_converter_is_no_part_of_a_cycle(seed):
    # the extreme is a reading one code below the wait, somewhere in it
    rng = np.random.default_rng(seed)
    time = np.arange(0, 80, 0.05)
    starts = rng.uniform(4.5, 8)
    phase = np.clip(time - starts, 0, 56.25) / 7.5
    position = 9.4973 - 0.7 * np.cos(2 * np.pi * phase) + rng.normal(0, 0.0004, time.size)
    position[time < 2] = np.linspace(10.2, 8.8023, int((time < 2).sum()))
    position = 0.0037 * np.round(position / 0.0037)
    tension = 100 * position[None]
    found = cycles_of_log(time, position, tension, settings=CycleSettings(waveform="sinusoidal"))
    assert np.diff(time[found.first]) == pytest.approx(7.5, abs=0.5)


def cycles_then_slack(shape, n_cycles, wait):
    """Reversals of the cycles found: a hold at the valley, cycles of 8 s, a wait, slack."""
    time = np.arange(0, 80 + 8 * n_cycles, 0.05)
    begins, ends = 40.0, 40.0 + 8 * n_cycles
    turns = np.clip(time - begins, 0, ends - begins) / 8
    rises = {
        "sinusoidal": (1 - np.cos(2 * np.pi * turns)) / 2,
        "triangular": np.abs(2 * (turns - np.round(turns))),
        "other": np.clip(1.4 * np.abs(2 * (turns - np.round(turns))), 0, 1),
    }[shape]
    approach = np.minimum(0.25 * (time - 15), 0).clip(-0.5)
    leave = -0.25 * np.maximum(time - ends - wait, 0)
    position = 3 + rises + approach + leave
    position = np.maximum(position, 2.5) + np.random.default_rng(1).normal(0, 0.001, time.size)
    tension = 200 * (position[None] - 2.5)
    stands = find_standstills(time, position, tension, settings=PhaseSettings())
    settings = CycleSettings(waveform=shape)
    found = find_cycles(time, position, tension, stands, settings=settings)
    return (time[found.last] - begins) / 8, position[found.last]


@pytest.mark.parametrize("shape", ["sinusoidal", "triangular", "other"])
@pytest.mark.parametrize("wait", [0.0, 1.0])
def test_a_last_cycle_after_which_the_drive_goes_to_slack_ends_at_its_valley(shape, wait):
    ends, valleys = cycles_then_slack(shape, 10, wait)
    np.testing.assert_allclose(ends[-2:], [9, 10], atol=0.05)
    np.testing.assert_allclose(valleys, 3, atol=0.03)


def test_a_sine_that_is_broken_off_before_the_drive_goes_to_slack_has_no_last_cycle():
    ends, _ = cycles_then_slack("sinusoidal", 9.75, 1.0)
    np.testing.assert_allclose(ends[-1], 9, atol=0.05)


@pytest.mark.parametrize(("bends", "n_cycles"), [(0.0, 10), (0.4, 9)])
def test_the_first_cycle_of_a_sine_joined_by_a_ramp_counts_if_its_rise_is_that_of_a_sine(
    bends, n_cycles
):
    # from slack through the valley without a stop; or the machine gains on the first rise
    step = np.arange(1000)
    sine = 2 - np.cos(2 * np.pi * step / 100)
    sine += bends * np.where(step < 50, np.sin(np.pi * step / 50), 0)
    position = np.concatenate([np.zeros(60), np.linspace(0, 1, 80)[:-1], sine])
    position += 1e-4 * np.random.default_rng(2).standard_normal(position.size)
    time, tension = 0.1 * np.arange(position.size), 100 * position[None]
    cycles = cycles_of_log(time, position, tension, settings=CycleSettings(waveform="sinusoidal"))
    assert cycles.n_cycles == n_cycles
    assert cycles.first[0] == pytest.approx(139 + 100 * (10 - n_cycles), abs=3)


@pytest.mark.parametrize("seed", range(12))
def test_a_first_cycle_behind_a_hold_is_as_high_as_the_others_in_noise(seed):
    # the hold ends some readings into the rise, which is 2 % short
    wave = 1 - np.cos(2 * np.pi * np.arange(3000) / 100)
    position = np.concatenate([np.zeros(400), wave, np.zeros(100)]) + 1.0
    position += 0.008 * np.random.default_rng(seed).standard_normal(position.size)
    time, tension = 0.1 * np.arange(position.size), 100 * position[None]
    cycles = cycles_of_log(time, position, tension, settings=CycleSettings(waveform="sinusoidal"))
    assert cycles.n_cycles == 30


@pytest.mark.parametrize(("n_cycles", "first"), [(7, 0), (8, 1)])
def test_a_start_is_told_from_the_others_where_five_remain_beside_the_three_it_may_take(
    n_cycles, first
):
    wave = np.append(np.tile([0.0, 100.0], n_cycles), 0.0)
    wave[1] = 90
    ends = np.arange(2 * n_cycles).reshape(n_cycles, 2)
    assert _steady_span(wave, ends, ends + 1) == slice(first, n_cycles)


@pytest.mark.parametrize(
    ("begins", "first"),
    [
        ([20, -28, 42, -47, 49.5], 2),  # grows from half cycle to half cycle, from 48 % on
        ([25, -25, 25, -50, 50], 0),  # a cycle of half the range, as a level has
        ([50, -50, 50, -50, 50], 0),
    ],
)
@pytest.mark.parametrize("is_reversed", [False, True])
def test_cycles_that_grow_to_the_amplitude_of_the_others_are_a_start(begins, first, is_reversed):
    wave = np.append(begins, np.tile([-50.0, 50.0], 12))
    # valley to peak to valley, here or in the mirror image of time
    wave = np.pad(-wave[::-1] if is_reversed else -wave, 1)
    ends = np.arange(1, wave.size - 2).reshape(-1, 2)
    n_cycles = len(ends)
    steady = slice(0, n_cycles - first) if is_reversed else slice(first, n_cycles)
    assert _steady_span(wave, ends, ends + 1) == steady


@pytest.mark.parametrize("lead", [0.0, 0.3])
def test_a_first_ramp_that_is_slower_all_the_way_begins_a_cycle(lead):
    # synthetic: at 40 % of the rate of the ramps after it, from below their valley
    lasts = [5.0, 25 * (1 + lead), *[10.0] * 19, 3.0]
    time = np.arange(0, sum(lasts), 0.2)
    levels = np.array([-lead, -lead, *[1.0, 0.0] * 10, 0.0])
    position = 0.2 * np.interp(time, np.cumsum([0.0, *lasts]), levels)
    tension = 500 + 3000 * position
    cycles = cycles_of_log(
        time, position, tension[None], settings=CycleSettings(waveform="triangular")
    )
    assert cycles.n_cycles == 10
