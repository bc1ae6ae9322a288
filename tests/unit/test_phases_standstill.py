"""Standstills: holds and rests, whatever the rate, and no turn of a cycle among them."""

import numpy as np
import pytest
from scipy.signal import lfilter

from reduction.record.errors import DataError
from reduction.record.settings import PhaseSettings
from reduction.stages.standstills import (
    Standstills,
    _block_extremes,
    _still_blocks,
    estimate_noise,
    find_standstills,
    find_tension_stands,
    level_of_standstill,
    median_step,
    noise_range,
)

TEST = [(0, 3), (20, 3), (40, 4), (100, 4), (110, 5), (290, 5), (300, 4), (310, 4)]


TEST += [(310 + 5 * i, 4 + i % 2) for i in range(1, 21)] + [(430, 3), (500, 3)]


START, END = [0, 40, 110, 300, 430], [20, 100, 290, 310, 500]


def pull(points, *, rate=10.0, noise=0.002, quantum=0.0):
    knots = np.array(points, dtype=float)
    time = np.arange(0, knots[-1, 0] + 0.5 / rate, 1 / rate)
    position = np.interp(time, *knots.T)
    position += np.random.default_rng(4).normal(0, noise, time.size)
    if quantum:
        position = np.round(position / quantum) * quantum
    return time, position, np.stack([100 * (position - 3), 80 * (position - 3)])


def find(time, position, tension, **settings):
    return find_standstills(time, position, tension, settings=PhaseSettings(**settings))


@pytest.mark.parametrize("rate", [1.0, 4.0, 10.0, 100.0, 1000.0])
def test_holds_and_rests_of_a_test_are_found_at_any_rate(rate):
    found = find(*pull(TEST, rate=rate))
    # an edge is sought where the move leaves the noise: a tenth of a second at 0.1 m/s
    assert found.start_time == pytest.approx(START, abs=0.3 + 1 / rate)
    assert found.end_time == pytest.approx(END, abs=0.3 + 1 / rate)
    assert found.is_rest.tolist() == [True, False, False, False, True]
    assert found.mean_position == pytest.approx([3, 4, 5, 4, 3], abs=0.002)
    assert found.mean_tension[1] == pytest.approx([0, 80, 160, 80, 0], abs=0.3)


def test_quantised_and_noisy_position_is_held_still():
    found = find(*pull(TEST, noise=0.0012, quantum=0.0037))
    assert found.start_time == pytest.approx(START, abs=0.2)
    assert found.end_time == pytest.approx(END, abs=0.2)


def test_positions_without_noise_give_exact_edges():
    found = find(*pull(TEST, noise=0.0))
    assert found.start_time == pytest.approx(START, abs=1e-9)
    assert found.end_time == pytest.approx(END, abs=1e-9)


def test_missing_samples_do_not_end_a_hold_and_are_no_edge_of_it():
    time, position, tension = pull(TEST)
    gone = (
        ((time > 60) & (time < 70)) | ((time > 99.5) & (time < 100.05)) | (np.abs(time - 200) < 1)
    )
    position[gone] = np.nan
    tension[:, gone] = np.nan
    found = find(time, position, tension)
    assert found.n_standstills == 5
    assert np.isfinite(position[found.first]).all() and np.isfinite(position[found.last]).all()
    assert found.mean_tension[0] == pytest.approx([0, 100, 200, 100, 0], abs=0.3)


def test_a_block_without_positions_is_bridged():
    time, position, tension = pull(TEST)
    position[(time > 150) & (time < 250)] = np.nan
    found = find(time, position, tension)
    assert found.end_time == pytest.approx(END, abs=0.3)


def test_a_record_that_is_one_hold_only_is_one_standstill_and_no_rest():
    time = 60.0 * np.arange(1440)
    position = np.round((6.6 + np.random.default_rng(0).normal(0, 0.0012, 1440)) / 0.0037) * 0.0037
    found = find(time, position, [60 - 2 * np.log10(1 + time)])
    assert (found.first, found.last) == ([0], [1439])
    assert not found.is_rest.any()


def test_peaks_of_19_samples_a_cycle_at_1_hz_are_no_holds():
    time = np.arange(600.0)
    for position in (np.abs((2 * time / 19) % 2 - 1), np.sin(2 * np.pi * time / 19)):
        found = find(time, position, [100 * position + 200])
        assert found.n_standstills == 0


def test_turns_of_a_cycle_slower_than_the_noise_are_no_holds():
    # 0.2 mm/s in noise of 4 mm: three seconds at the turn are well inside the noise
    time = np.arange(0, 4000, 0.05)
    position = 2 * np.abs((time / 1000) % 2 - 1)
    position += np.random.default_rng(0).normal(0, 0.004, time.size)
    assert find(time, position, [100 * position + 50]).n_standstills == 0


def test_a_hold_in_a_slow_test_is_told_from_the_slow_movement():
    found = find(*pull([(0, 3), (500, 4), (700, 4), (1200, 3)], noise=0.001))
    assert found.n_standstills == 1
    assert (found.start_time[0], found.end_time[0]) == (
        pytest.approx(500, abs=5),
        pytest.approx(700, abs=5),
    )


def test_shorter_stops_than_the_minimum_are_left_out():
    points = [(0, 3), (10, 4), (12, 4), (20, 5), (24, 5), (30, 6)]
    assert find(*pull(points)).start_time == pytest.approx([20], abs=0.3)
    assert find(*pull(points), minimum_duration=1.5).start_time == pytest.approx([10, 20], abs=0.3)


def test_two_holds_a_small_step_apart_are_two():
    found = find(*pull([(0, 4), (30, 4), (30.1, 4.1), (60, 4.1)]))
    assert found.mean_position == pytest.approx([4, 4.1], abs=0.002)


def test_a_stated_tolerance_and_slack_tension_are_used_and_kept():
    found = find(*pull(TEST), position_tolerance=0.05, slack_tension=110.0)
    assert (found.position_tolerance, found.slack_tension) == (0.05, 110.0)
    assert found.is_rest.tolist() == [True, True, False, True, True]


def test_slack_is_two_hundredths_of_the_greatest_tension():
    found = find(*pull(TEST, noise=0.0))
    assert found.slack_tension == pytest.approx(0.02 * 200)


def test_a_rest_is_a_rest_of_every_specimen():
    time, position, tension = pull(TEST)
    tension[1] += 50
    assert not find(time, position, tension).is_rest.any()


def test_noise_about_zero_is_slack():
    time = np.arange(0, 100, 0.1)
    noise = np.random.default_rng(3).normal(0, 1.0, (2, time.size))
    assert find(time, np.full(time.size, 3.0), noise).is_rest.tolist() == [True]


def test_product_is_read_only():
    with pytest.raises(ValueError, match="read-only"):
        find(*pull(TEST)).first[0] = 1


def test_a_moving_crosshead_has_no_standstill():
    found = find(*pull([(0, 3), (100, 10)]))
    assert found.n_standstills == 0
    assert found.mean_tension.shape == (2, 0)
    assert found.is_rest.shape == (0,)


def test_too_short_a_record_is_refused():
    with pytest.raises(DataError, match="too short to stand still; found 3 rows; needed 4"):
        find([0.0, 1, 2], [1.0, 1, 1], [[0.0, 0, 0]])
    with pytest.raises(
        DataError, match="no position of the record may be used.* 0 positions in 9 rows"
    ):
        find(np.arange(9.0), np.full(9, np.nan), [np.zeros(9)])


def test_time_that_stands_is_refused():
    with pytest.raises(DataError, match="time does not advance"):
        find(np.zeros(20), np.ones(20), [np.ones(20)])
    with pytest.raises(DataError, match="time does not advance"):
        median_step(np.array([3.0]))


def test_series_that_do_not_pair_up_are_refused():
    with pytest.raises(DataError, match="do not pair up"):
        find(np.arange(9.0), np.ones(8), [np.ones(9)])


@pytest.mark.parametrize("period", [33.0, 50.0, 100.0, 200.0])
def test_the_rounded_turns_of_a_slow_noisy_sine_are_no_holds(period):
    time = np.arange(0.0, 20.25 * period, period / 100)
    noise = np.random.default_rng(3).normal(0, 0.003, time.size)
    position = -np.cos(2 * np.pi * time / period) + noise
    found = find_standstills(
        time,
        position,
        [100 * position + 120],
        settings=PhaseSettings(minimum_duration=0.02 * period),
    )
    assert found.n_standstills <= 2  # of 41 turns


@pytest.mark.parametrize("share", [0.05, 0.1, 0.2])
def test_rests_at_the_turns_of_a_slow_noisy_trapezoid_are_holds(share):
    corners = np.cumsum([0.0, *np.tile([0.5 - share, share], 40)])
    levels = np.tile([-1.0, 1.0, 1.0, -1.0], 21)[: corners.size]
    time = np.arange(0.0, 100 * corners[-1])
    noise = np.random.default_rng(3).normal(0, 0.003, time.size)
    position = np.interp(time, 100 * corners, levels) + noise
    found = find_standstills(
        time, position, [100 * position + 120], settings=PhaseSettings(minimum_duration=3.0)
    )
    assert found.n_standstills >= 39  # of 40 rests


def test_a_rest_that_is_logged_more_slowly_than_the_cycles_is_found():
    """A row a second at rest, twenty in the cycles; a gap between two of them is no rest."""
    rest, cycles = np.arange(12.0), np.arange(12, 40, 0.05)
    time = np.concatenate([rest, cycles, [41.0, 42, 43, 44, 45], cycles + 100])
    position = 2 - np.cos(2 * np.pi * (time - 12) / 4)
    position[time < 12], position[(time > 40) & (time < 100)] = 0.0, 1.0
    position += 1e-5 * np.random.default_rng(0).standard_normal(time.size)
    found = find_standstills(time, position, [100 * position], settings=PhaseSettings())
    assert found.start_time.tolist() == [0, 41]
    assert found.end_time.tolist() == [11, 45]
    assert found.is_rest.tolist() == [True, False]


def test_a_hold_of_an_encoder_without_noise_does_not_end_where_the_servo_moves_by_codes():
    """Ramp of 1.2 mm in 300 s, hold of 120 s; codes of 1/4800 mm, printed to five decimals."""
    time = np.arange(0.0, 420.0, 0.01)
    code = 1 / 4800
    hunts = time % 4.8 > 2.9
    moved = np.where(time < 304, 1, np.where(time > 336, -1, np.where(hunts, 1, -2)))
    millimetres = np.where(time < 300, 0.004 * time, 1.2 + (moved + 0.01) * code)
    position = np.round(code * np.floor(millimetres / code), 5) / 1000
    tension = np.interp(time, [0, 300], [0, 30]) * np.exp(-np.maximum(time - 300, 0) / 1000)
    stand = find_standstills(time, position, [tension], settings=PhaseSettings(), is_held=True)
    assert stand.first.size == 1
    assert abs(stand.start_time[0] - 300) < 0.5
    assert stand.end_time[0] == time[-1]


# noise and quantum are told from movement

TIME = np.arange(20_000)


@pytest.fixture
def noise():
    return np.random.default_rng(7).normal(0, 0.01, TIME.size)


@pytest.mark.parametrize(
    "movement",
    [
        0 * TIME,
        0.3 * TIME,
        np.abs((TIME / 100) % 2 - 1),
        np.sin(2 * np.pi * TIME / 19),
        np.where(TIME < 9_000, 0.0, np.sin(2 * np.pi * TIME / 400)),
    ],
    ids=["standing", "ramp", "triangle of 200 samples", "sine of 19 samples", "hold, then sine"],
)
def test_noise_is_found_under_any_movement(noise, movement):
    found, quantum = estimate_noise(movement + noise)
    assert found == pytest.approx(0.01, rel=0.08)
    assert quantum == 0


def test_triangle_of_20_samples_without_noise_has_neither_noise_nor_quantum():
    assert estimate_noise(np.abs((np.arange(4000) / 10) % 2 - 1)) == (
        pytest.approx(0, abs=1e-12),
        0,
    )


def test_quantum_of_a_12_bit_channel_is_found():
    step = 50 / 4096
    level = 12.26 + np.random.default_rng(1).normal(0, 0.004, 5000)
    noise, quantum = estimate_noise(np.round(level / step) * step)
    assert quantum == pytest.approx(step, rel=1e-9)
    # below a quantum of noise the differences of a held level may be mostly zero
    assert noise < step


def test_scale_and_level_carry_through(noise):
    one, _ = estimate_noise(noise)
    assert estimate_noise(1000 * noise + 5e4)[0] == pytest.approx(1000 * one, rel=1e-9)


def test_missing_samples_are_left_out(noise):
    noise[::7] = np.nan
    assert estimate_noise(noise)[0] == pytest.approx(0.01, rel=0.1)


def test_eight_samples_are_needed():
    with pytest.raises(DataError, match="too few samples to tell noise .* found 3 finite samples"):
        estimate_noise([1.0, 2.0, np.nan, 3.0])
    with pytest.raises(DataError, match="found 0 finite samples"):
        estimate_noise(np.full(100, np.nan))


def test_noise_range_covers_a_long_hold():
    level = np.random.default_rng(2).normal(0, 1.0, 1_000_000)
    assert noise_range(level) > np.ptp(level)


def test_noise_range_covers_a_quantised_hold():
    level = np.round(np.random.default_rng(1).normal(0, 0.3, 100_000))
    assert noise_range(level) >= np.ptp(level)


@pytest.mark.parametrize("level", [0.0, 1e-3, 2e5])
def test_noise_range_of_a_constant_is_not_zero(level):
    assert 0 < noise_range(np.full(100, level)) <= max(1e-9 * level, 1e-12)


def test_rare_flicker_of_a_hold_is_found_in_a_record_that_mostly_moves():
    # ramps of ten codes a sample, then a level that reads one code more in 1 of 40 samples
    step = 40 / 4096
    ramps = 10 * np.abs((np.arange(4000) % 100) - 50)
    level = 250 + (np.arange(400) % 40 == 7)
    readings = np.round(step * np.concatenate([ramps, level]), 5)  # five decimals, as printed
    assert noise_range(readings) == pytest.approx(3 * step, rel=2e-3)


@pytest.mark.parametrize(("per_cycle", "dwell"), [(11, 0.25), (12, 0.2), (12.3, 0.2), (13, 0.25)])
def test_ramps_and_rests_of_a_dozen_readings_a_cycle_are_no_noise(per_cycle, dwell):
    # most differences have a corner: their median is a tenth of the stroke
    turn = (np.arange(200) + 0.3) / per_cycle
    wave = np.interp(turn % 1, [0, 0.5 - dwell, 0.5, 1 - dwell, 1], [0, 1, 1, 0, 0])
    noise = np.random.default_rng(1).normal(0, 1e-3, turn.size)
    assert 8e-3 < noise_range(2 * wave + noise) < 0.06
    # what is all noise keeps its twelve deviations
    assert noise_range(noise) == pytest.approx(12e-3, rel=0.2)


# blocks of samples and the runs of them that stand still


def test_extremes_are_those_of_whole_and_broken_blocks():
    position = np.random.default_rng(0).normal(size=1003)
    least, greatest = _block_extremes(position, 10)
    rows = [position[i : i + 10] for i in range(0, 1003, 10)]
    assert least.tolist() == [row.min() for row in rows]
    assert greatest.tolist() == [row.max() for row in rows]


def test_missing_samples_are_left_out_of_a_block():
    position = np.array([np.nan, 2.0, 1.0, 3.0, np.nan, np.nan])
    least, greatest = _block_extremes(position, 2)
    assert (least.tolist(), greatest.tolist()) == ([2, 1, np.inf], [2, 3, -np.inf])


def test_a_length_of_zero_is_refused():
    with pytest.raises(ZeroDivisionError):
        _block_extremes(np.ones(3), 0)


def test_a_slow_ramp_is_no_standstill_and_a_hold_in_it_is_one():
    level = np.concatenate([np.linspace(0, 4, 100), np.full(40, 4.0), np.linspace(4, 0, 100)])
    # four blocks of the ramp keep within the tolerance, 28 do not
    first, last = _still_blocks(level, level + 0.1, window=4, tolerance=0.3)
    assert first.size == 1
    assert (first[0], last[0]) == (pytest.approx(100, abs=5), pytest.approx(139, abs=5))


@pytest.mark.parametrize("rest", [10.0, 15.0, 20.0])
def test_a_rest_before_a_pull_that_is_slow_for_its_noise_is_found(rest):
    # one metre in ten minutes: 1.7 mm a second, with a noise of 1.2 mm
    time, position, tension = pull([(0, 3), (rest, 3), (rest + 600, 4)], rate=2.0, noise=0.0012)
    found = find(time, position, tension)
    assert found.is_rest.tolist() == [True]
    assert found.start_time[0] == 0
    assert found.end_time[0] == pytest.approx(rest, abs=2)
    assert found.mean_position[0] == pytest.approx(3, abs=0.0012)


def test_the_turn_of_a_slow_cycle_is_no_standstill():
    level = np.abs(np.arange(800) % 200 - 100.0) / 25
    first, _ = _still_blocks(level, level + 0.1, window=4, tolerance=0.4)
    assert first.size == 0


def test_nothing_moves_and_all_is_one_standstill():
    first, last = _still_blocks(np.zeros(9), np.full(9, 0.2), window=3, tolerance=0.3)
    assert (first.tolist(), last.tolist()) == ([0], [8])


def test_fewer_blocks_than_a_window_hold_no_standstill():
    first, _ = _still_blocks(np.zeros(2), np.zeros(2), window=3, tolerance=0.3)
    assert first.size == 0


def test_a_long_standstill_soon_after_a_short_one_leaves_both():
    """Looked at as long before it as it lasted, the long one goes back beyond the short one."""
    time = np.arange(0, 600, 0.1)
    position = np.interp(time, [0, 50, 60, 90, 300, 600], [0, 5, 5, 8, 8, 30])
    least, greatest = _block_extremes(position, 10)
    first, last = _still_blocks(least, greatest, window=3, tolerance=0.01)
    np.testing.assert_array_equal(first, [50, 90])
    np.testing.assert_array_equal(last, [59, 299])


def test_steps_of_time_that_alternate_are_no_noise():
    # the least and the greatest reading of every 0.5 s of a sine of 20 s after a rest of 10 s
    every = np.arange(0, 210, 0.02)
    stroke = 1 - np.cos(2 * np.pi * np.clip(every - 10, 0, None) / 20)
    noisy = stroke + np.random.default_rng(4).normal(0, 0.002, every.size)
    blocks = noisy[: noisy.size // 25 * 25].reshape(-1, 25)
    kept = np.sort([blocks.argmin(axis=1), blocks.argmax(axis=1)], axis=0)
    kept = (kept + 25 * np.arange(len(blocks))).T.ravel()
    found = find_standstills(every[kept], noisy[kept], [noisy[kept]], settings=PhaseSettings())
    assert found.start_time.tolist() == [every[kept[0]]]
    assert found.end_time[0] == pytest.approx(10, abs=1)


# holds at constant tension: the crosshead creeps in them and is no guide to where they are

LOAD = [(0, 0), (20, 0), (40, 300), (640, 300), (650, 500), (950, 500), (960, 0), (1000, 0)]
START_OF_HELD, END_OF_HELD = [0, 40, 650, 960], [20, 640, 950, 1000]


def creep(points=LOAD, *, rate=5.0, noise=0.3, wander=0.0):
    """Tension as told, position that creeps 4 cm a decade under it."""
    knots = np.array(points, dtype=float)
    time = np.arange(0, knots[-1, 0] + 0.5 / rate, 1 / rate)
    load = np.interp(time, *knots.T)
    creeping = np.where(load > 0, 0.04 * np.log10(1 + np.clip(time - 40, 0, None)), 0)
    random = np.random.default_rng(1)
    position = 3 + load / 300 + creeping + wander * (load == 0) * time
    position += random.normal(0, 0.0005, time.size)
    return time, position, load + random.normal(0, noise, time.size)


def find_of_held(time, position, *tension, **settings):
    return find_tension_stands(time, position, tension, settings=PhaseSettings(**settings))


def test_holds_of_a_creeping_specimen_are_where_its_tension_stands():
    time, position, tension = creep()
    found = find_of_held(time, position, tension)
    # the crosshead needs 0.2 s, the load 0.3 s to leave the noise
    assert found.start_time == pytest.approx(START_OF_HELD, abs=0.5)
    assert found.end_time == pytest.approx(END_OF_HELD, abs=0.5)
    assert found.is_rest.tolist() == [True, False, False, True]
    assert found.mean_tension[0] == pytest.approx([0, 300, 500, 0], abs=0.2)
    assert found.tension_tolerance == pytest.approx(12 * 0.3, rel=0.1)
    by_position = find_standstills(time, position, [tension], settings=PhaseSettings())
    assert by_position.tension_tolerance is None
    assert not np.any(np.abs(by_position.start_time - 40) < 1)


def test_a_load_without_noise_whose_mean_is_rounded_is_a_hold():
    time, position, tension = creep(noise=0.0)
    found = find_of_held(time, position, 0.3 / 0.7 * tension)
    assert found.tension_tolerance == 0.0
    assert found.start_time == pytest.approx(START_OF_HELD, abs=0.5)


def test_the_mean_of_the_specimens_is_what_stands_still():
    time, position, tension = creep(noise=0.1)
    # one sheds to the other what it loses, as two on one crosshead under load control do
    shift = 30 * np.clip((time - 40) / 600, 0, 1) * (tension > 10)
    found = find_of_held(time, position, tension + shift, tension - shift)
    assert found.end_time[1] == pytest.approx(640, abs=0.5)
    assert found.mean_tension[:, 1] == pytest.approx([315, 285], abs=0.5)


def test_a_crosshead_that_wanders_under_a_slack_specimen_is_not_at_rest():
    found = find_of_held(*creep(wander=0.01))
    assert not found.is_rest.any()
    assert found.start_time == pytest.approx(START_OF_HELD[1:3], abs=0.5)


def test_a_stated_tolerance_holds_what_a_hunting_controller_breaks():
    time, position, tension = creep(noise=0.05)
    hunting = tension + 4 * np.sin(2 * np.pi * time / 9) * (tension > 10)
    assert find_of_held(time, position, hunting).is_rest.all()
    found = find_of_held(time, position, hunting, tension_tolerance=12.0)
    assert found.tension_tolerance == 12.0
    assert found.start_time[1:3] == pytest.approx(START_OF_HELD[1:3], abs=0.5)


@pytest.mark.parametrize("share", [0.001, 0.003])
def test_a_controller_that_hunts_slowly_does_not_break_a_creep_hold(share):
    steps = [300, 330, 360]
    knots = np.concatenate([[(40 + 310 * k, load), (340 + 310 * k, load)] for k, load in
                            enumerate(steps)])  # fmt: skip
    time, position, tension = creep([(0, 0), (20, 0), *knots, (970, 0), (1000, 0)], noise=0.05)
    random = np.random.default_rng(4)
    hunting = np.interp(time, 7 * np.arange(150), random.normal(0, share, 150))
    found = find_tension_stands(
        time, position, tension * (1 + hunting), settings=PhaseSettings(), is_held=True
    )
    assert found.is_rest.tolist() == [True, False, False, False, True]
    assert found.start_time[1:4] == pytest.approx([40, 350, 660], abs=1)
    assert found.end_time[1:4] == pytest.approx([340, 650, 960], abs=1)


def test_missing_tension_does_not_end_a_hold():
    time, position, tension = creep()
    tension[(time > 200) & (time < 230)] = np.nan
    assert find_of_held(time, position, tension).end_time == pytest.approx(END_OF_HELD, abs=0.5)


def test_a_rest_that_meets_a_hold_ends_before_it():
    time = np.arange(0, 60, 0.1)
    # stands for a minute while the load goes from just below the slack tension to just above
    load = np.where(time < 30, 4.0, 6.0)
    found = find_of_held(time, np.ones(time.size), load, slack_tension=5.0)
    assert found.is_rest.tolist() == [True, False]
    assert found.last[0] == found.first[1] - 1


def test_holds_of_a_valve_that_dithers_faster_than_the_log_are_all_found():
    """Six steps of 120 N of 480 N, held for 600 s; a dither of 2.4 N is read near every half turn.

    Its differences are those of noise of 32 N from end to end in twelve deviations, a quarter of a
    step, though it spans 4.8 N.
    """
    levels = [120, 240, 360, 240, 360, 480, 0]
    knots, now = [(0.0, 0.0), (10.0, 0.0)], 10.0
    for level in levels:
        knots += [(now + 20, level), (now + 620, level)]
        now += 620
    time = np.arange(0, now, 0.5)
    tension = np.interp(time, *np.array(knots).T)
    position = 3 + tension / 300 + 0.002 * np.log1p(time)
    tension += (tension > 0) * 2.4 * np.sin(2.2 * time / 0.5)
    tension += np.random.default_rng(6).normal(0, 0.25, time.size)
    found = find_of_held(time, position, tension)
    held = ~found.is_rest
    assert found.mean_tension[0, held] == pytest.approx(levels[:-1], abs=1)
    assert found.start_time[held] == pytest.approx(30 + 620 * np.arange(6), abs=3)
    assert found.tension_tolerance < 20


@pytest.mark.parametrize(("readings", "noise"), [(30, 0.005), (35, 0.003), (45, 0.002)])
def test_turns_of_coarse_noisy_sines_are_no_holds_and_dwells_of_four_readings_are(readings, noise):
    """Synthetic: eight cycles behind a hold, 800 to 3,200 N, with noise as a share of the range."""
    clock = np.arange(8 * readings) / readings % 1
    dwell = 4 / readings
    rounded = (1 - np.cos(2 * np.pi * clock)) / 2
    corners = [0, dwell / 2, 0.5 - dwell / 2, 0.5 + dwell / 2, 1 - dwell / 2, 1]
    dwelling = np.interp(clock, corners, [0, 0, 1, 1, 0, 0])
    rng = np.random.default_rng(3)
    kept = {"rounded": 0, "dwelling": 0}
    for _ in range(8):
        for name, wave in (("rounded", rounded), ("dwelling", dwelling)):
            shape = np.concatenate([np.linspace(-1 / 3, 0, 40), np.zeros(60), wave, np.zeros(100)])
            load = 800 + 2400 * (shape + noise * rng.standard_normal(shape.size))
            time = np.arange(shape.size, dtype=float)
            found = find_tension_stands(time, 0.1 + 0.1 * shape, [load], settings=PhaseSettings())
            ends = time[101], time[-102]
            kept[name] += int(((found.start_time > ends[0]) & (found.end_time < ends[1])).sum())
    assert kept["rounded"] <= 2
    assert kept["dwelling"] >= 118  # of 15 in each of eight logs


@pytest.mark.parametrize("second", [0.0, 0.03, 0.06])
def test_a_hold_before_noisy_cycles_does_not_make_holds_of_their_valleys(second):
    """Synthetic: 160 readings per cycle, a second harmonic, and noise of 1 % of the range."""
    clock = np.arange(8 * 160) / 160
    wave = (1 - np.cos(2 * np.pi * clock)) / 2 + second * (np.cos(4 * np.pi * clock) - 1)
    shape = np.concatenate([np.linspace(-0.3, 0, 30), np.zeros(50), wave, np.zeros(60)])
    time, rng, found = np.arange(shape.size, dtype=float), np.random.default_rng(1), 0
    for _ in range(6):
        load = 800 + 2000 * (shape + 0.01 * rng.standard_normal(shape.size))
        stands = find_tension_stands(time, 0.1 + 0.1 * shape, [load], settings=PhaseSettings())
        found += int(((stands.start_time > 112) & (stands.end_time < time[-93])).sum())
    assert found <= 6  # of 90 turns


def test_a_hold_between_fast_cycles_is_none_of_their_turns():
    """Synthetic: 44 s at the mean of sines of 5 s; cycles lie within a quarter of it beside it."""
    time, found = np.arange(0, 144, 0.25), 0
    turn = np.where(time < 50, time, np.clip(time - 94, 0, None)) / 5
    for seed in range(20):
        noise = np.random.default_rng(seed).normal(0, 1.0, time.size)
        load = 60 + 40 * np.sin(2 * np.pi * turn) + noise
        stands = find_tension_stands(time, load / 100, [load], settings=PhaseSettings())
        found += int(np.any((np.abs(stands.start_time - 50) < 1) & (stands.end_time > 93)))
    assert found >= 19


@pytest.mark.parametrize("noise", [0.003, 0.01])
def test_straight_ramps_of_ten_minutes_in_noise_have_no_holds(noise):
    """Synthetic: ten cycles of 20 to 100 N, a reading a second, with noise as a share of 100 N."""
    time = np.arange(6000.0)
    wave = 60 + 40 * np.interp(time / 600 % 1, [0, 0.5, 1], [-1, 1, -1])
    found = 0
    for seed in range(10):
        load = wave + np.random.default_rng(seed).normal(0, 100 * noise, time.size)
        stands = find_tension_stands(time, load / 100, [load], settings=PhaseSettings())
        found += int(np.sum((stands.start_time > 300) & (stands.end_time < 5700)))
    assert found <= 1


@pytest.mark.parametrize("interval", [0.1, 0.5])
def test_a_drift_of_a_hold_does_not_part_it_where_the_next_ramp_leaves(interval):
    """Synthetic: three steps of 1 m in 20 s, each held for 1,000 s with a drift of 5 mm."""
    time = np.arange(0, 3080, interval)
    knots = [0, 20]
    place = [0.0, 0.0]
    for step in range(3):
        knots += [knots[-1] + 20, knots[-1] + 1020]
        place += [1.005 * step + 1, 1.005 * (step + 1)]
    position = np.interp(time, knots, place)
    position += np.random.default_rng(2).normal(0, 1e-5, time.size)
    found = find_standstills(
        time, position, [100 * position], settings=PhaseSettings(), is_held=True
    )
    assert found.start_time == pytest.approx([0, 40, 1060, 2080], abs=2 * interval)
    assert found.end_time == pytest.approx([20, 1040, 2060, 3080], abs=2 * interval)


@pytest.mark.parametrize("missing", [0.1, 0.4])
def test_holds_between_fast_ramps_stand_where_readings_are_missing(missing):
    """Synthetic: dwells of 22 s after ramps of 80 mm in 5 s, noise of 0.01 mm."""
    time, found = np.arange(0, 275, 0.5), 0
    knots = np.cumsum(np.r_[0, np.tile([5.0, 22.0], 10), 5])
    place = np.r_[0.02, np.repeat(np.tile([0.1, 0.02], 5), 2), 0.1]
    for seed in range(10):
        random = np.random.default_rng(seed)
        position = np.interp(time, knots, place) + random.normal(0, 1e-5, time.size)
        position[random.random(time.size) < missing] = np.nan
        found += find(time, position, 1e3 * position[None]).start_time.size
    assert found == 100


def test_a_coarse_encoder_with_missing_readings_is_not_without_noise():
    """Synthetic: steps of 0.1 mm, noise of 0.02 mm, ramps of 0.8 mm/s; readings on one code."""
    time = np.arange(0, 520, 0.1)
    random = np.random.default_rng(0)
    knots = [0, 100, 120, 220, 240, 340, 360, 460]
    position = np.interp(time, knots, [0.02, 0.1, 0.1, 0.02, 0.02, 0.1, 0.1, 0.02])
    position = np.round((position + random.normal(0, 2e-5, time.size)) / 1e-4) * 1e-4
    position[random.random(time.size) < 0.4] = np.nan
    found = find(time, position, 1e3 * position[None])
    assert found.start_time == pytest.approx([100, 220, 340, 460], abs=1)


def test_four_readings_at_rest_that_rise_by_chance_have_a_level():
    """Each half of the rest lies off its middle as the beginning of a ramp does."""
    position = 0.05 + np.array([-2e-6, 0, 2e-6, 3e-6, 1e-3, 2e-3, 3e-3, 4e-3])
    first, last, rest = np.array([0]), np.array([3]), np.array([True])
    stand = Standstills(
        first, last, 1.0 * first, 1.0 * last, np.array([0.05]), np.zeros((1, 1)), rest,
        position_tolerance=1.5e-5, slack_tension=5.0,
    )  # fmt: skip
    assert level_of_standstill(position, stand, 0)[0] == pytest.approx(0.05, abs=3e-6)


def test_a_rest_of_which_one_reading_is_no_ramp_is_known_as_well_as_that():
    position = 5 + np.array([-6e-6, -3e-6, 0, 3e-6, 6e-6, 1e-3, 2e-3, 3e-3, 4e-3])
    first, last, rest = np.array([0]), np.array([4]), np.array([True])
    stand = Standstills(
        first, last, 1.0 * first, 1.0 * last, np.array([5.0]), np.zeros((1, 1)), rest,
        position_tolerance=1.5e-5, slack_tension=5.0,
    )  # fmt: skip
    level, spread = level_of_standstill(position, stand, 0)
    assert level == pytest.approx(5, abs=3e-6)
    assert spread < 1e-5


@pytest.mark.parametrize("source", ["filter", "hum"])
def test_noise_alike_in_neighbouring_readings_does_not_cut_a_creep_hold(source):
    """Synthetic: 240 N held for 700 s; differences of neighbours hide most of this noise of 2 N."""
    time = np.arange(0, 710.0, 0.0606)
    white = np.random.default_rng(3).normal(0, 1, time.size)
    if source == "filter":
        noise = lfilter([1.0], [1.0, -0.8], white)
    else:  # 50.03 Hz, aliased to a period of 31 readings
        noise = 2 * np.sqrt(2) * np.sin(2 * np.pi * 50.03 * time) + 0.5 * white
    load = np.interp(time, [4, 9], [0, 240]) + noise
    place = np.interp(time, [4, 9], [0, 1]) + 0.01 * np.log1p(np.maximum(time - 9, 0))
    found = find_tension_stands(time, place, [load], settings=PhaseSettings(), is_held=True)
    held = ~found.is_rest
    assert found.start_time[held] == pytest.approx([9], abs=0.2)
    assert found.end_time[held] == pytest.approx([710], abs=0.2)
