"""Noise and digitizer step of a series."""

import numpy as np
import pytest

from reduction.record.errors import DataError
from reduction.stages.cycles.reading_noise import noise_and_step, reading_noise
from reduction.stages.moduli.splice_slip import sample_noise


def test_noise_of_a_white_series_is_its_standard_deviation():
    noise, _ = sample_noise(2 * np.random.default_rng(0).standard_normal(40000))
    assert noise == pytest.approx(2, rel=0.02)


def test_the_step_of_the_digitizer_is_found():
    series = np.round(np.random.default_rng(1).standard_normal(500) / 0.25) * 0.25
    assert sample_noise(series)[1] == pytest.approx(0.25)


def test_a_constant_series_has_neither():
    assert sample_noise(np.full(10, 5.0)) == (0.0, 0.0)


def test_one_sample_has_no_noise_to_read():
    with pytest.raises(DataError, match="no noise can be read from one sample"):
        sample_noise([1.0])


@pytest.mark.parametrize("noise", [0.45, 0.6])
def test_rounding_is_no_part_of_the_noise_beneath_it(noise):
    """Rounding to a step adds a twelfth of its square: 0.6 steps would be read as 0.67."""
    rows = np.arange(6000)
    wave = 7.37 * np.abs((rows + 0.3) % 400 - 200)
    codes = np.round(wave + noise * np.random.default_rng(3).standard_normal(rows.size))
    found, step = noise_and_step(0.25 * codes, reading_noise(0.25 * codes))
    assert step == 0.25
    assert found == pytest.approx(0.25 * noise, rel=0.08)
