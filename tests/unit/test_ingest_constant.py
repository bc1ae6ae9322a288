import tracemalloc

import numpy as np
import pytest
from scipy.signal import lfilter

from reduction.readers import sample_flags as constant
from reduction.readers.sample_flags import (
    _constant_runs,
    _find_end_of_position,
    _find_saturated,
    _find_stuck,
    _find_stuck_position,
    _moves,
)

RANDOM = np.random.default_rng(20051010)
TIME = np.arange(0, 200, 0.1)


def triangle(low, high, period=20.0):
    return high - (high - low) * np.abs((TIME / period) % 1 - 0.5) * 2


def quantised(values, step):
    return np.round(values / step) * step


POSITION = quantised(triangle(19.37, 24.12) + RANDOM.normal(0, 0.004, TIME.size), 0.0122)


def loops(mask):
    return [
        (int(run[0]), int(run[-1]) + 1)
        for run in np.split(
            np.flatnonzero(mask), np.flatnonzero(np.diff(np.flatnonzero(mask)) > 1) + 1
        )
        if run.size
    ]


def brute(values, minimum):
    edges = np.flatnonzero(np.diff(values) != 0) + 1
    starts, stops = np.r_[0, edges], np.r_[edges, values.size]
    keep = stops - starts >= minimum
    return list(zip(starts[keep].tolist(), stops[keep].tolist(), strict=True))


@pytest.mark.parametrize("minimum", [2, 3, 5, 50])
@pytest.mark.parametrize("seed", range(5))
def test_runs_are_those_that_a_plain_search_finds(minimum, seed):
    source = np.random.default_rng(seed)
    values = np.repeat(source.integers(0, 3, 300), source.integers(1, 120, 300)).astype(float)
    runs = _constant_runs(values, minimum)
    assert list(zip(runs.start.tolist(), runs.stop.tolist(), strict=True)) == brute(values, minimum)
    assert runs.mask(values).sum() == sum(stop - start for start, stop in brute(values, minimum))


def test_a_series_shorter_than_a_run_has_none():
    assert _constant_runs(np.ones(10), 50).start.size == 0
    assert not _constant_runs(np.ones(10), 50).mask(np.ones(10)).any()


def test_a_noisy_hold_does_not_move_and_a_ramp_does():
    position = np.concatenate([np.full(500, 20.0), np.linspace(20, 25, 500)])
    position += RANDOM.normal(0, 0.004, 1000)
    load = np.repeat(np.arange(10.0), 100)
    assert _moves(position, _constant_runs(load, 50)).tolist() == [False] * 5 + [True] * 5


def test_a_channel_that_repeats_a_value_while_the_crosshead_moves_is_stuck():
    load = triangle(50, 120) + RANDOM.normal(0, 0.3, TIME.size)
    load[730:830] = load[730]
    assert loops(_find_stuck(load, POSITION, samples=50)) == [(730, 830)]


def test_readings_written_with_three_digits_are_not_stuck():
    """A slow pull to 1800 N at 100 Hz: steps of 1 N, above 1000 N of 10 N."""
    position = np.linspace(0, 600, 60_000)
    load = 1800 * (position / 600) ** 0.8
    written = np.array([float(f"{one:.3g}") for one in load])
    stuck = _find_stuck(written, position, samples=50)
    assert not stuck[written > 1100].any() and not stuck[written < 900].any()


def test_a_hold_is_not_stuck_however_even_its_load():
    position = np.concatenate([POSITION[:300], np.full(1000, POSITION[300]), POSITION[300:1000]])
    load = np.concatenate(
        [triangle(50, 120)[:300], np.full(1000, 80.0), triangle(50, 120)[300:1000]]
    )
    assert not _find_stuck(load, position, samples=50).any()


def test_a_slack_specimen_that_reads_zero_while_the_crosshead_moves_is_not_stuck():
    load = np.maximum(triangle(-100, 120), 0.0)
    assert (load == 0).sum() > 500
    assert not _find_stuck(load, POSITION, samples=50).any()
    assert not _find_saturated(load, POSITION).any()


def test_a_load_that_falls_to_zero_at_once_is_stuck():
    load = np.maximum(triangle(-100, 120), 0.0)
    load[1065:1130] = 0.0  # at 43 N, a cable comes loose
    assert loops(_find_stuck(load, POSITION, samples=50)) == [(1065, 1130)]


def test_a_dead_channel_is_stuck_throughout():
    assert _find_stuck(np.zeros(TIME.size), POSITION, samples=50).all()


def test_a_clipped_channel_is_saturated_at_each_peak():
    load = np.minimum(quantised(triangle(50, 120), 0.244), 100.04)
    found = _find_saturated(load, POSITION)
    assert np.array_equal(found, load == load.max())
    assert found.sum() > 500


@pytest.mark.parametrize("clip", [104.0, 110.0, 113.0])
def test_a_slow_log_of_a_fine_channel_is_saturated_at_short_peaks(clip):
    # 24 readings a cycle from 50 to 120 N, with noise of 0.3 N written to 0.01 N
    time = np.arange(600) * 10 / 12.03
    load = 85 + 70 * (0.5 - np.abs((time / 20) % 1 - 0.5)) * 2 - 35
    load = np.round(load + np.random.default_rng(4).normal(0, 0.3, time.size), 2)
    place = 2 + (load - 50) / 100
    assert not _find_saturated(load, place).any()
    found = _find_saturated(np.minimum(load, clip), place)
    assert np.array_equal(found, load >= clip)


@pytest.mark.parametrize("shape", ["triangle", "sine"])
def test_a_coarse_channel_is_saturated_at_two_readings_of_many_peaks(shape):
    """Clipped at 97 % of its range, written to 2 N with noise of 3 N: 4 readings of 200 a cycle."""
    phase = np.arange(3000) / 200.3 % 1
    wave = 2 * np.abs(phase - 0.5) if shape == "triangle" else 0.5 + 0.5 * np.cos(2 * np.pi * phase)
    load = 1000 + 4000 * wave + np.random.default_rng(5).normal(0, 3, phase.size)
    place = 2 + 0.02 * wave
    assert not _find_saturated(quantised(load, 2.0), place).any()
    read = quantised(np.minimum(load, 4880), 2.0)
    found = _find_saturated(read, place)
    assert found.sum() > 50
    assert np.array_equal(found, read == 4880)


def test_a_log_of_few_readings_a_cycle_is_saturated():
    """24 readings a cycle in step, hundreds of newtons apart, written to .5 N."""
    phase = np.arange(600) / 24 % 1
    load = 1000 + 8000 * np.abs(phase - 0.5) + np.random.default_rng(6).normal(0, 0.75, 600)
    place = 2 + 0.04 * np.abs(phase - 0.5)
    assert not _find_saturated(quantised(load, 0.5), place).any()
    assert _find_saturated(quantised(np.minimum(load, 4600), 0.5), place).sum() >= 50


def ends(kind, *, clip=None, relaxes=0.0, is_late=False):
    """Position written to 10 um, and load, of cycles of 10 s; with dwells of 2 s or without."""
    time = np.arange(0, 150, 0.05)
    phase = time / 10 % 1
    rise = {"triangle": 0.5, "dwell": 0.3}[kind]
    wave = np.clip(np.minimum(phase / rise, (0.5 + rise - phase) / rise), 0, 1)
    spring = lfilter([1, -1], [1, -np.exp(-0.05 / 3)], wave)
    load = 1000 + 4000 * lfilter([0.05], [1, -0.95], wave) if is_late else 1000 + 4000 * wave
    load = load + relaxes * 4000 * spring + np.random.default_rng(7).normal(0, 3, time.size)
    position = 2.08 + 0.04 * wave
    return quantised(position if clip is None else np.minimum(position, clip), 1e-5), load


def test_a_position_that_ends_before_the_load_does_is_found():
    position, load = ends("triangle", clip=2.118)
    found = _find_end_of_position(position, load)
    assert np.array_equal(found, position == position.max())
    assert found.sum() > 100


@pytest.mark.parametrize("relaxes", [0.0, 0.1])
@pytest.mark.parametrize("is_late", [False, True])
@pytest.mark.parametrize("kind", ["triangle", "dwell"])
def test_a_position_that_turns_or_dwells_has_not_ended(kind, is_late, relaxes):
    assert not _find_end_of_position(*ends(kind, is_late=is_late, relaxes=relaxes)).any()


def test_two_readings_beside_the_peak_of_a_wave_in_step_are_not_saturated():
    phase = 2 * np.pi * (np.arange(600) + 0.5) / 24
    load = np.round(85 + 35 * np.cos(phase), 2)
    assert not _find_saturated(load, 2 + 0.3 * np.cos(phase - 0.1)).any()


def test_a_channel_clipped_in_compression_is_saturated():
    load = np.maximum(triangle(-120, 120), -100.0)
    whole = slice(50, -50)  # at the ends a trough is cut in half
    assert np.array_equal(_find_saturated(load, POSITION)[whole], (load == -100.0)[whole])


@pytest.mark.parametrize("step", [0.244, 1.0, 3.0])
@pytest.mark.parametrize("shape", ["triangle", "sine"])
def test_quantised_peaks_are_not_saturated(shape, step):
    wave = triangle(50, 120) if shape == "triangle" else 85 + 35 * np.sin(2 * np.pi * TIME / 20)
    assert not _find_saturated(quantised(wave, step), POSITION).any()
    assert not _find_stuck(quantised(wave, step), POSITION, samples=50).any()


def test_a_hold_at_the_greatest_load_is_not_saturated():
    ramp = np.linspace(20, 25, 100)
    position = np.concatenate([ramp, np.full(500, 25.0), ramp[::-1]])
    load = np.concatenate([np.linspace(0, 400, 100), np.full(500, 400.0), np.linspace(380, 0, 100)])
    assert not _find_saturated(load, position).any()


def test_a_position_that_stands_still_while_the_load_cycles_is_stuck():
    load = np.vstack([triangle(50, 120), triangle(60, 130)]) + RANDOM.normal(0, 0.3, (2, TIME.size))
    position = POSITION.copy()
    position[700:1130] = position[700]
    assert loops(_find_stuck_position(position, load, samples=50)) == [(700, 1130)]


def test_a_load_that_was_logged_late_makes_no_stuck_crosshead():
    # an exact encoder, and a load that is the mean of the last five readings of a fast ramp
    position = np.clip(np.arange(600.0) - 100, 0, 3)
    load = np.convolve(10 * position, np.full(5, 0.2))[np.newaxis, :600]
    assert not _find_stuck_position(position, load, samples=50).any()


def test_relaxation_in_a_hold_does_not_make_position_stuck():
    time = np.arange(0, 3600, 1.0)
    load = (400 - 20 * np.log1p(time) + RANDOM.normal(0, 0.25, time.size))[np.newaxis]
    assert not _find_stuck_position(np.full(time.size, 38.37), load, samples=50).any()
    overnight = quantised(68 + RANDOM.normal(0, 0.25, time.size), 0.244)[np.newaxis]
    assert not _find_stuck_position(np.full(time.size, 21.75), overnight, samples=50).any()


def test_missing_loads_do_not_upset_the_search():
    load = triangle(50, 120)
    load[730:830] = load[730]
    load[5] = np.nan
    assert loops(_find_stuck(load, POSITION, samples=50)) == [(730, 830)]
    assert not _find_saturated(load, POSITION).any()
    assert not _find_stuck_position(POSITION, load[np.newaxis], samples=50).any()


@pytest.mark.parametrize("n_together", [1, 3, 1 << 10])
@pytest.mark.parametrize("minimum", [2, 7, 50])
def test_runs_are_those_told_value_by_value(monkeypatch, n_together, minimum):
    monkeypatch.setattr(constant, "_EDGES", n_together)
    random = np.random.default_rng(4)
    values = np.repeat(random.integers(0, 3, 400), random.integers(1, 90, 400)).astype(float)
    values[random.integers(0, values.size, 20)] = np.nan
    edges = np.flatnonzero(np.diff(values, prepend=np.nan, append=np.nan) != 0)
    long = np.diff(edges) >= minimum
    runs = _constant_runs(values, minimum)
    np.testing.assert_array_equal(runs.start, edges[:-1][long])
    np.testing.assert_array_equal(runs.stop, edges[1:][long])


def test_very_many_runs_take_no_memory_for_each():
    values = np.repeat(np.arange(20_000.0) % 7, 60)
    tracemalloc.start()
    runs = _constant_runs(values, 50)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert runs.start.size == 20_000
    assert peak < values.nbytes


@pytest.mark.parametrize("turn", [0.0, 0.7, 1.4])
def test_a_code_that_ends_a_ramp_and_lasts_is_neither_stuck_nor_saturated(turn):
    """A load of 120 N that relaxes by 1 N a second, in codes of 3 N read fifty times a second."""
    time = np.arange(0, 60, 0.02)
    position = 20 + np.clip(time - 10, 0, 12)
    load = 10 * np.clip(time - 10, 0, 12) + turn - np.clip(time - 22, 0, None)
    read = quantised(load, 3.0)
    assert not _find_stuck(read, position, samples=50).any()
    assert not _find_saturated(read, position).any()
    # one that stays for as long as the ramp adds three codes has not read it
    read[900:1000] = read[900]
    assert _find_stuck(read, position, samples=50)[900:1000].all()
