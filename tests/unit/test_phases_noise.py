"""Noise and quantum are told from movement."""

import numpy as np
import pytest

from reduction.record.errors import DataError
from reduction.stages.standstills import estimate_noise, noise_range

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
