"""Steps are found, dated, and not invented."""

import numpy as np
import pytest
from scipy.signal import lfilter

from reduction.record.errors import DataError
from reduction.stages.moduli import splice_slip
from reduction.stages.moduli.splice_slip import _ramp_of, find_steps

NOISE = 0.3


def background(rng, n_samples):
    """Creep, drift and softening of random size."""
    count = np.arange(1.0, n_samples + 1)
    return (
        rng.uniform(-3, 3) * np.log(count)
        - rng.uniform(0, 10) * np.exp(-(count - 1) / rng.uniform(2, 40))
        + rng.uniform(-0.002, 0.002) * count
    )


def white(rng, n_samples):
    return rng.standard_normal(n_samples)


def heavy_tailed(rng, n_samples):
    return rng.standard_t(4, n_samples)


def correlated(rng, n_samples):
    return lfilter([1], [1, -0.5], rng.standard_normal(n_samples))


@pytest.mark.parametrize(
    "noise",
    [
        white,
        pytest.param(heavy_tailed, marks=pytest.mark.nightly),
        pytest.param(correlated, marks=pytest.mark.nightly),
    ],
)
def test_a_series_without_steps_shows_none_more_often_than_stated(noise):
    rng = np.random.default_rng(11)
    alarms = sum(
        bool(find_steps(background(rng, 120) + NOISE * noise(rng, 120), false_alarm=0.01))
        for _ in range(300)
    )
    # 300 series at 1 % give 3 on average; 9 or more have a chance below 0.4 %.
    assert alarms < 9


@pytest.mark.parametrize("quantum", [0.5, 1.0, 3.0])
def test_a_rounded_drift_is_not_a_row_of_steps(quantum):
    rng = np.random.default_rng(3)
    for _ in range(5):
        series = background(rng, 400) + NOISE * white(rng, 400)
        assert find_steps(np.round(series / quantum) * quantum, false_alarm=1e-3) == ()


@pytest.mark.parametrize("decay", [2.0, 6.0, 20.0, 60.0])
def test_softening_of_the_first_cycles_is_not_a_step(decay):
    rng = np.random.default_rng(4)
    count = np.arange(800.0)
    series = 40 * np.exp(-count / decay) - 25 * np.exp(-count / 1.5) - 2 * np.log1p(count)
    assert find_steps(series + 0.1 * white(rng, 800), false_alarm=1e-3) == ()


@pytest.mark.parametrize("power", [-0.3, 0.3, 0.5])
def test_creep_by_a_power_law_is_not_a_step(power):
    rng = np.random.default_rng(5)
    series = 20 * np.arange(1.0, 1201.0) ** power
    assert find_steps(series + 0.1 * white(rng, 1200), false_alarm=1e-3) == ()


def test_a_change_of_slope_is_not_a_step():
    rng = np.random.default_rng(6)
    count = np.arange(1000.0)
    series = -0.02 * np.maximum(0, count - 500)
    assert find_steps(series + 0.05 * white(rng, 1000), false_alarm=1e-3) == ()


@pytest.mark.parametrize("extent", [1, 5, 20])
@pytest.mark.parametrize("size", [-1.5, 1.5])
def test_a_step_is_dated_and_sized(extent, size):
    rng = np.random.default_rng(7)
    for onset in (100, 333, 500):
        series = background(rng, 600) + size * _ramp_of(600, onset=onset, extent=extent)
        steps = find_steps(series + NOISE * white(rng, 600), false_alarm=1e-3)
        assert len(steps) == 1
        assert abs(steps[0].onset - onset) <= max(3, extent // 2)
        assert abs(steps[0].size - size) < 5 * steps[0].size_standard_uncertainty
        assert steps[0].onset_low <= steps[0].onset <= steps[0].onset_high
        assert steps[0].end <= steps[0].end_high


@pytest.mark.nightly
def test_the_stated_range_of_an_onset_holds_it_nineteen_times_of_twenty():
    rng = np.random.default_rng(15)
    step = -0.7 * _ramp_of(300, onset=150, extent=1)
    found = [find_steps(step + NOISE * white(rng, 300), false_alarm=1e-3) for _ in range(120)]
    ranges = np.array([(one[0].onset_low, one[0].onset_high) for one in found if len(one) == 1])
    assert len(ranges) > 50
    holds = (ranges[:, 0] <= 150) & (ranges[:, 1] >= 150)
    assert 0.9 <= holds.mean() <= 1


def test_several_steps_come_in_order():
    rng = np.random.default_rng(8)
    onsets = [120, 260, 700]
    series = background(rng, 1000) + NOISE * white(rng, 1000)
    for onset in onsets:
        series = series - 2 * _ramp_of(1000, onset=onset, extent=4)
    found = [step.onset for step in find_steps(series, false_alarm=1e-3)]
    np.testing.assert_allclose(found, onsets, atol=4)


def test_the_recovery_after_a_step_is_not_a_step():
    rng = np.random.default_rng(9)
    count = np.arange(600.0)
    lag = np.clip(count - 300, 0, None)
    series = -3 * (count >= 300) + 1.2 * (1 - np.exp(-lag / 12)) * (count >= 300)
    steps = find_steps(series + 0.1 * white(rng, 600), false_alarm=1e-3)
    assert [step.size < 0 for step in steps] == [True]


@pytest.mark.parametrize(("back", "found"), [(1.2, [-1]), (2.0, [-1, 1])])
def test_a_change_back_by_more_than_half_is_a_step_of_its_own(back, found):
    rng = np.random.default_rng(9)
    series = -3 * _ramp_of(600, onset=300, extent=1) + back * _ramp_of(600, onset=330, extent=1)
    steps = find_steps(series + 0.1 * white(rng, 600), false_alarm=1e-3)
    assert [np.sign(step.size) for step in steps] == found


def test_a_single_wild_sample_is_not_a_step():
    rng = np.random.default_rng(10)
    series = NOISE * white(rng, 300)
    series[150] += 40
    assert find_steps(series, false_alarm=1e-3) == ()


def test_an_uneven_step_is_one_step():
    rng = np.random.default_rng(12)
    series = -2 * _ramp_of(500, onset=200, extent=6) - 1.5 * _ramp_of(500, onset=206, extent=20)
    steps = find_steps(series + 0.05 * white(rng, 500), false_alarm=1e-3)
    assert len(steps) == 1
    assert steps[0].onset == pytest.approx(200, abs=6)
    assert steps[0].size == pytest.approx(-3.5, abs=0.2)


def test_a_constant_series_has_no_step():
    assert find_steps(np.ones(100), false_alarm=1e-3) == ()


def test_a_series_too_short_is_refused():
    with pytest.raises(DataError, match="too short for steps; found 10 samples; needed 24"):
        find_steps(np.zeros(10), false_alarm=1e-3)


def test_a_rate_that_is_no_chance_is_refused():
    with pytest.raises(DataError, match="false-alarm rate is not a chance; found 2"):
        find_steps(np.zeros(100), false_alarm=2.0)


def test_a_missing_value_is_refused():
    with pytest.raises(DataError, match="1 of 100 values of values are not finite"):
        find_steps(np.where(np.arange(100) == 5, np.nan, 0.0), false_alarm=1e-3)


def test_a_step_without_extent_is_refused():
    with pytest.raises(DataError, match="a step has no extent; found 0"):
        _ramp_of(10, onset=3, extent=0)


def test_the_background_of_a_series_is_factored_once_and_leaves_a_ramp_in():
    count = np.arange(1.0, 2001)
    series = 5000 - 300 * np.log10(count)
    splice_slip._background.cache_clear()
    find_steps(5 * np.round(series / 5), false_alarm=1e-3)
    assert splice_slip._background.cache_info().misses == 1
    # of a logarithm, a line, a softening and a step nothing is left but the step
    ramp = 1.0 * (count > 1200)
    left = splice_slip._without_background(
        series - 0.01 * count + 40 * np.exp(-(count - 1) / 8) - 7 * ramp, ramp[None]
    )
    np.testing.assert_allclose(left, -7 * ramp, atol=1e-6)
