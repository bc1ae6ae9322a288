"""Standstills: holds and rests, whatever the rate, and no turn of a cycle among them."""

import numpy as np
import pytest

from reduction.record.errors import DataError
from reduction.record.settings import PhaseSettings
from reduction.stages.standstills import find_standstills, median_step

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
