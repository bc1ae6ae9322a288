"""Noise and digitizer step of a series."""

import numpy as np
import pytest

from reduction.record.errors import DataError
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
