"""Wave number from period and depth, with and without a current."""

import numpy as np
import pytest

from reduction.prediction import wave_theory as dispersion
from reduction.prediction.wave_theory import (
    STANDARD_GRAVITY,
    _group_velocity,
    _wave_number,
    wave_period_of,
)
from reduction.record.errors import DataError, FitError


def residual(number, period, depth, current=0.0):
    intrinsic = 2 * np.pi / period - number * current
    return intrinsic**2 / (STANDARD_GRAVITY * number * np.tanh(number * depth)) - 1


def test_the_root_is_exact_from_a_ripple_to_a_tide():
    period = np.geomspace(0.1, 1e5, 400)[:, None]
    depth = np.geomspace(0.01, 1e4, 300)
    number = _wave_number(period, depth)
    assert number.shape == (400, 300)
    assert np.max(np.abs(residual(number, period, depth))) < 1e-14


def test_limits_of_deep_and_shallow_water():
    deep, shallow = _wave_number(5.0, 1e4), _wave_number(1e4, 0.5)
    assert deep == pytest.approx((2 * np.pi / 5) ** 2 / STANDARD_GRAVITY, rel=1e-14)
    assert shallow == pytest.approx(2 * np.pi / 1e4 / np.sqrt(STANDARD_GRAVITY * 0.5), rel=1e-7)


@pytest.mark.parametrize("current", [-1.2, -0.5, 0.3, 2.0, 15.0])
def test_a_current_shifts_the_frequency(current):
    period = np.array([8.0, 12.0, 30.0])
    number = _wave_number(period, 10.0, current_velocity=current)
    assert np.max(np.abs(residual(number, period, 10.0, current))) < 1e-13
    # shorter against the current, longer with it, and energy still goes forward
    assert np.all((number > _wave_number(period, 10.0)) == (current < 0))
    assert np.all(_group_velocity(number, 10.0) + current > 0)


def test_no_current_is_the_limit_of_a_small_one():
    still = _wave_number(6.0, 4.0)
    for small in (1e-12, -1e-12):
        assert _wave_number(6.0, 4.0, current_velocity=small) == pytest.approx(
            float(still), rel=1e-11
        )


def test_over_deep_water_the_waves_end_at_a_quarter_of_their_speed():
    # U = -g / (4 omega): the closed form of blocking; length is then a quarter of the still one
    period = 4.0
    limit = STANDARD_GRAVITY * period / (8 * np.pi)
    number = _wave_number(period, 1e3, current_velocity=-limit * (1 - 1e-9))
    assert number / _wave_number(period, 1e3) == pytest.approx(4.0, rel=1e-3)
    with pytest.raises(DataError, match="the opposing current stops the wave"):
        _wave_number(period, 1e3, current_velocity=-limit * (1 + 1e-9))


def test_a_blocked_wave_among_others_is_named():
    with pytest.raises(
        DataError, match="stops 1 of 3 waves, first at index 1; found a current of -9"
    ):
        _wave_number(4.0, 10.0, current_velocity=[0.0, -9.0, 1.0])


def test_period_is_the_inverse():
    period = np.array([2.0, 3.57, 9.0])[:, None]
    depth, current = np.array([1.0, 6.0, 80.0]), 0.4
    number = _wave_number(period, depth, current_velocity=current)
    back = wave_period_of(number, depth, current_velocity=current)
    assert back == pytest.approx(np.broadcast_to(period, back.shape), rel=1e-13)


def test_a_length_that_the_current_carries_back_has_no_period():
    with pytest.raises(DataError, match="the opposing current stops"):
        wave_period_of(2 * np.pi / 5, 10.0, current_velocity=-2.0)


def test_group_velocity_is_the_derivative_of_the_frequency():
    number, depth = np.geomspace(1e-3, 5, 50), 7.0

    def frequency(k):
        return np.sqrt(STANDARD_GRAVITY * k * np.tanh(k * depth))

    step = 1e-4 * number
    slope = (frequency(number + step) - frequency(number - step)) / (2 * step)
    assert _group_velocity(number, depth) == pytest.approx(slope, rel=1e-7)
    assert np.isfinite(_group_velocity(1e4, 1e4))


@pytest.mark.parametrize(("period", "current"), [(5.0, 0.0), (5.0, 1.0)])
def test_a_search_that_does_not_end_says_so(monkeypatch, period, current):
    start = dispersion._still_water
    monkeypatch.setattr(dispersion, "_MOST_STEPS", 1)
    if current:

        def ended(frequency):
            monkeypatch.setattr(dispersion, "_MOST_STEPS", 100)
            root = start(frequency)
            monkeypatch.setattr(dispersion, "_MOST_STEPS", 1)
            return root

        monkeypatch.setattr(dispersion, "_still_water", ended)
    with pytest.raises(FitError, match="the wave number was not found"):
        _wave_number(period, 6.0, current_velocity=current)


@pytest.mark.parametrize("bad", [0.0, -1.0, np.nan, np.inf])
def test_periods_and_depths_are_positive_numbers(bad):
    with pytest.raises(DataError, match="wave_period"):
        _wave_number(bad, 3.0)
    with pytest.raises(DataError, match="water_depth"):
        _wave_number(3.0, [1.0, bad])
    with pytest.raises(DataError, match="wave_number"):
        wave_period_of(bad, 3.0)
