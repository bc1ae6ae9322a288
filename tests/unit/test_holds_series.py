"""Prony series and the finite ramp."""

import numpy as np
import pytest

from reduction.record.errors import DataError
from reduction.stages.holds.prony_series import _exponentials, _ramp_factor, prony_tension


@pytest.mark.parametrize("ramp_duration", [0.5, 4.0, 40.0])
def test_the_ramp_factor_is_the_superposition_of_small_steps(ramp_duration):
    times = np.array([1.0, 10.0, 300.0])
    started = (np.arange(20000) + 0.5) / 20000 * ramp_duration
    expected = np.exp(-(ramp_duration - started)[:, None] / times).mean(axis=0)
    np.testing.assert_allclose(
        _ramp_factor(times, ramp_duration=ramp_duration), expected, rtol=1e-6
    )


def test_counted_from_its_start_the_factor_takes_its_usual_form():
    ratio = 4.0 / np.array([2.0, 50.0])
    found = _ramp_factor([2.0, 50.0], ramp_duration=4.0) * np.exp(ratio)
    np.testing.assert_allclose(found, np.expm1(ratio) / ratio)


def test_a_step_leaves_every_term_whole():
    np.testing.assert_allclose(_ramp_factor([1.0, 5.0], ramp_duration=0.0), 1.0, rtol=1e-12)
    np.testing.assert_allclose(_ramp_factor([5.0], ramp_duration=5e-324), 1.0, rtol=1e-12)


def test_a_series_begins_at_the_sum_and_ends_at_its_long_time_tension():
    tension = prony_tension(
        [0.0, 1e9], tension=[30.0, 45.0], relaxation_time=[2.0, 50.0], long_time_tension=325.0
    )
    np.testing.assert_allclose(tension, [400, 325])


def test_columns_are_one_at_time_zero():
    np.testing.assert_array_equal(_exponentials(np.zeros(3), np.array([1.0, 2.0])), 1.0)


def test_a_negative_ramp_is_refused():
    with pytest.raises(DataError, match="negative duration; found -1 s"):
        _ramp_factor([1.0], ramp_duration=-1.0)


def test_a_time_of_zero_is_refused():
    with pytest.raises(DataError, match="relaxation_time are not positive"):
        prony_tension([0.0], tension=[1.0], relaxation_time=[0.0], long_time_tension=0.0)
