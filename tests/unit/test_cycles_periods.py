"""Periods from flank to flank where rests part some cycles and not others."""

from types import SimpleNamespace

import numpy as np
import pytest
from located_cycles import cycles_of_log

from reduction.pipeline.reduce_test import _with_waveform_of_log
from reduction.record.settings import CycleSettings, ReductionSettings
from reduction.stages.cycles.cycle_product import Cycles
from reduction.stages.cycles.loops import close_loops
from reduction.stages.cycles.periods import change_of_period, own_periods, periods_alone


def periods_of(wave, begin, peak, end):
    """Periods of cycles between these samples of a wave read once a second."""
    cycles = Cycles(
        begin, end, np.stack([begin, peak], axis=1), np.stack([peak, end], axis=1),
        np.ones((begin.size, 2)), *np.zeros((3, wave.size)), 0.1,
    )  # fmt: skip
    time = np.arange(wave.size) * 1.0
    return own_periods(time, wave, cycles, time[end] - time[begin], noise=1e-6)[0]


def test_a_dwell_that_is_a_rest_behind_some_cycles_alone_is_part_of_all_periods():
    # ramps of 80 readings, dwells of 16 at both ends; a quarter of those below were found as rests
    per, n_cycles, step = 192.3, 12, 0.2
    turn = np.arange(int(per * (n_cycles + 0.2))) / per
    ramp, dwell = 80 / per, 0.5 - 80 / per
    wave = np.interp(turn % 1, [0, ramp, ramp + dwell, 2 * ramp + dwell, 1], [0, 1, 1, 0, 0])
    begin = np.ceil(per * np.arange(n_cycles)).astype(int)
    begin[1::2] -= 9  # somewhere in the dwell before it
    end = np.append(begin[1:], begin[-1] + 2 * 80 + 16)
    rests = np.array([2, 5, 6])
    begin[rests + 1] = np.ceil(per * (rests + 1))
    end[rests] = np.floor(per * (rests + 1)) - 16
    peak = np.ceil(per * (np.arange(n_cycles) + ramp + dwell / 2)).astype(int)
    cycles = Cycles(
        begin, end, np.stack([begin, peak], axis=1), np.stack([peak, end], axis=1),
        np.ones((n_cycles, 2)), *np.zeros((3, turn.size)), 0.1,
    )  # fmt: skip
    time = step * np.arange(turn.size)
    period, _ = own_periods(time, wave, cycles, time[end] - time[begin], noise=1e-6)
    assert period[:-1] == pytest.approx(np.full(n_cycles - 1, per * step), rel=1e-3)


def test_rests_that_differ_by_one_reading_are_parts_of_all_periods():
    """Nearly square waves of 23.13 readings, whose rests at the valley have 4 or 5 of them."""
    per, n_cycles = 23.13, 40
    turn = np.arange(int(per * n_cycles)) / per
    wave = np.interp(turn % 1, [0, 0.1, 0.45, 0.55, 1], [0, 1, 1, 0, 0])
    begin = np.ceil(per * np.arange(n_cycles)).astype(int)[:-1]
    end = np.append(begin[1:], int(per * (n_cycles - 1))) - 4 - np.arange(n_cycles - 1) % 2
    peak = np.ceil(per * (np.arange(n_cycles - 1) + 0.3)).astype(int)
    period = periods_of(wave, begin, peak, end)
    # from turn to turn, half of them lasted 18 to 19 readings
    assert period[:-1] == pytest.approx(np.full(n_cycles - 2, per), abs=0.2)


@pytest.mark.parametrize("per", [33.3, 40.3, 52.7])
def test_what_a_curved_flank_misses_does_not_add_up_over_the_periods(per):
    """Pulses of a sine for 60 % of the time: their flanks bend about half way up."""
    n_cycles = 400
    turn = np.arange(int(per * n_cycles)) / per
    wave = np.where(turn % 1 < 0.6, -np.cos(2 * np.pi * (turn % 1) / 0.6), -1.0)
    begin = np.ceil(per * np.arange(n_cycles)).astype(int)
    begin, end = begin[:-1], begin[1:]
    peak = np.rint(per * (np.arange(n_cycles - 1) + 0.3)).astype(int)
    period = periods_of(wave, begin, peak, end)
    assert period[:-1].mean() == pytest.approx(per, abs=4e-4)


def test_a_cycle_that_was_not_counted_is_no_part_of_a_period():
    """Of three cycles, the one in the middle is missing: the others have their own periods."""
    turn = np.arange(3 * 20 + 1) / 20
    wave = 1 - np.abs(2 * (turn % 1) - 1)
    begin = np.array([0, 40])
    pair = np.stack([begin, begin + 10], axis=1)
    cycles = Cycles(begin, begin + 20, pair, pair + 10, np.ones((2, 2)),
                    *np.zeros((3, turn.size)), 0.1)  # fmt: skip
    time = np.arange(turn.size) * 1.0
    period, _ = own_periods(time, wave, cycles, np.full(2, 20.0), noise=1e-6)
    assert period == pytest.approx([20, 20])


SINES = CycleSettings(waveform="sinusoidal")


def cycles_of(time, wave):
    return cycles_of_log(time, wave, wave[None], settings=SINES)


def sweep(share, *, n_cycles=60, step=0.2, seed=0, noise=1e-3):
    """A sine of 10 s at first, every cycle longer than the first by so much of it than the last."""
    turns = np.arange(0, 10 * (n_cycles + share * n_cycles**2 / 2), step)
    cycle = (np.sqrt(1 + 2 * share * turns / 10) - 1) / share if share else turns / 10
    wave = -np.cos(2 * np.pi * cycle)
    return turns, wave + noise * np.random.default_rng(seed).standard_normal(turns.size)


@pytest.mark.parametrize("seed", range(3))
def test_cycles_stored_alone_with_readings_before_and_behind_their_valleys(seed):
    # every tenth cycle of 5 s, from 0.1 s before its first valley to 0.1 s behind its last, of a
    # linear material whose mean tension relaxes as the inverse of time
    rng = np.random.default_rng(seed)
    time = np.arange(0, 300, 0.025) + 0.006
    time = time[np.abs(time % 50 - 27.5) < 2.6]
    phase = 2 * np.pi * time / 5
    storage, loss, half, rest = 8000.0, 200.0, 0.12, 900.0 / time
    strain = 0.3 - half * np.cos(phase) + 1e-5 * rng.standard_normal(time.size)
    tension = 2000 + rest - half * (storage * np.cos(phase) - loss * np.sin(phase))
    tension += 0.5 * rng.standard_normal(time.size)
    cycles = cycles_of(time, strain)
    assert cycles.n_cycles == 6
    # a sine stands within its noise for some readings about its valley
    assert np.abs((time[cycles.first] + 2.5) % 5 - 2.5).max() < 0.06
    loops = close_loops(time, tension[None], strain[None], cycles, waveform="sinusoidal")
    # by the turns, 0.1 to 0.2 s too long: 2 to 4 %
    error = loops.frequency[0] - 0.2
    assert np.abs(error).max() < 4e-5
    assert (np.abs(error) < 4 * loops.uncertainty["frequency"][0]).all()
    assert loops.apparent_spring_constant[0] == pytest.approx(
        np.full(6, np.hypot(storage, loss)), rel=2e-3
    )
    # with the work of the drift, which is half the stroke times the drift, up to 8 % too much
    error = loops.hysteresis_energy[0] - np.pi * loss * half**2
    assert (np.abs(error) < 3.5 * loops.uncertainty["hysteresis_energy"][0]).all()


@pytest.mark.parametrize("share", [0.003, 0.02, -0.005])
def test_a_period_that_changes_is_found_with_its_change(share):
    time, wave = sweep(share)
    found = change_of_period(time, wave, cycles_of(time, wave))
    # the period of the n-th cycle is 1 + share n of the first
    low, high = sorted([share, share / (1 + 60 * share)])
    assert low < found < high


@pytest.mark.parametrize("step", [0.1, 0.8])
@pytest.mark.parametrize("noise", [1e-4, 0.02])
def test_noise_sampling_and_one_cycle_that_waits_are_no_change_of_period(step, noise):
    for n_cycles in (5, 12, 200):
        time, wave = sweep(0.0, n_cycles=n_cycles, step=step, noise=noise)
        assert change_of_period(time, wave, cycles_of(time, wave)) == 0
    late = np.where(time > 800, time - 1.5, np.minimum(time, 798.5))
    wave = np.interp(late, time, wave)
    assert change_of_period(time, wave, cycles_of(time, wave)) == 0


@pytest.mark.parametrize("seed", range(8))
def test_noise_of_more_than_a_step_at_the_middle_of_a_rise_is_no_change_of_period(seed):
    time = np.arange(0, 20, 0.01)
    noise = 0.0105 * np.random.default_rng(seed).normal(size=time.size)
    wave = -np.cos(0.4 * np.pi * time)
    assert change_of_period(time, wave + noise, cycles_of(time, wave)) == 0


def test_amplitudes_of_a_sweep_are_those_of_its_cycles():
    time, wave = sweep(-0.01, step=0.1)
    cycles = cycles_of(time, wave)
    located = SimpleNamespace(
        cycles=cycles, record=SimpleNamespace(time=time), position=wave, tension=wave[None]
    )
    stated = ReductionSettings(cycles=SINES)
    settings, (told,) = _with_waveform_of_log(stated, located)
    assert told.code == "period-changes"
    loops = close_loops(
        time, 100 * wave[None], wave[None], cycles, waveform=settings.cycles.waveform
    )
    assert loops.strain_amplitude[0, :-1] == pytest.approx(1, abs=0.01)
    steady = located.__dict__ | {"position": sweep(0.0, step=0.1)[1][: time.size]}
    steady["cycles"] = cycles_of(time, steady["position"])
    assert _with_waveform_of_log(stated, SimpleNamespace(**steady)) == (stated, ())


def test_each_cycle_of_a_log_with_three_speeds_has_its_own_period():
    # ramps of 36, 18 and 12 s in turn, as a machine with three speeds makes them
    own = np.tile([36.0, 18.0, 12.0], 4)
    valley = np.append(0, np.cumsum(own))
    turns = np.sort(np.concatenate([valley, valley[:-1] + own / 2]))
    time = np.arange(0, valley[-1], 0.05)
    wave = np.interp(time, turns, np.arange(turns.size) % 2)
    begin = np.searchsorted(time, valley[:-1])
    end, peak = np.append(begin[1:], time.size - 1), np.searchsorted(time, valley[:-1] + own / 2)
    cycles = Cycles(
        begin, end, np.stack([begin, peak], axis=1), np.stack([peak, end], axis=1),
        np.ones((own.size, 2)), *np.zeros((3, time.size)), 0.1,
    )  # fmt: skip
    period, spread = own_periods(time, wave, cycles, time[end] - time[begin], noise=1e-6)
    assert np.abs(period - own).max() < 0.1
    assert np.all((spread > 0.005) & (spread < 0.05))


@pytest.mark.parametrize("creep", [0.0, 0.03])
@pytest.mark.parametrize("is_sine", [False, True])
def test_the_count_of_cycles_stored_one_by_one_shows_their_period(is_sine, creep):
    """Both ends of each are stored; what creeps in a cycle is not a part of the next one."""
    number = np.array([20, 30, 40, 90, 100, 200])
    turn = np.concatenate([one + np.arange(51) / 50 for one in number])
    wave = 1 - np.cos(2 * np.pi * turn) + 0.2 * np.sin(4 * np.pi * turn) + creep * (turn % 1)
    first = np.arange(6) * 51
    last = first + 50
    peak = first + np.array([int(wave[one : one + 51].argmax()) for one in first])
    begin, end = np.column_stack([first, peak]), np.column_stack([peak, last])
    none = np.zeros(turn.size, np.int32)
    cycles = Cycles(
        first, last, begin, end, np.ones((6, 2)), none, none.astype(np.int8), none.astype(bool),
        0.1, counted_by="machine counter", count=number,
    )  # fmt: skip
    place, period, spread = periods_alone(turn / 2, wave, cycles, is_sine=is_sine, noise=0.0)
    np.testing.assert_array_equal(place, np.arange(6))
    np.testing.assert_allclose(period, 0.5, rtol=1e-9)
    assert (spread <= 0.01 / np.sqrt(12) / 9).all()
