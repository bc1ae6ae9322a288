"""Drop, rate per decade, and tension at stated times."""

import numpy as np
import pytest

from reduction.record.errors import DataError
from reduction.stages.holds.relaxation_numbers import (
    end_mean,
    logarithmic_blocks,
    rate_per_decade,
    relaxation_drop,
    value_at_times,
)

TIME = np.arange(1.0, 1001.0)


def test_a_drop_from_nothing_is_nan():
    assert np.isnan(relaxation_drop(0.0, 1.0))


def test_drops_pair_up():
    with pytest.raises(DataError, match="series do not pair up"):
        relaxation_drop([1.0, 2.0], [1.0])


def test_a_logarithmic_relaxation_gives_its_rate():
    rate = rate_per_decade(logarithmic_blocks(TIME, 400 - 20 * np.log10(TIME)), ramp_duration=2.0)
    assert rate.value == pytest.approx(-20, rel=2e-3)
    assert rate.elapsed_low >= 6
    assert rate.elapsed_high > 950


def test_the_stated_uncertainty_is_the_scatter_of_repeated_holds():
    rng = np.random.default_rng(0)
    rates = [
        rate_per_decade(
            logarithmic_blocks(TIME, 400 - 20 * np.log10(TIME) + rng.standard_normal(TIME.size)),
            ramp_duration=2.0,
        )
        for _ in range(300)
    ]
    found = np.array([rate.value for rate in rates])
    assert found.mean() == pytest.approx(-20, abs=0.1)
    stated = np.mean([rate.standard_uncertainty for rate in rates])
    assert 0.9 < stated / found.std() < 1.35


def test_curvature_widens_the_uncertainty():
    straight = rate_per_decade(logarithmic_blocks(TIME, -20 * np.log10(TIME)), ramp_duration=2.0)
    bent = rate_per_decade(logarithmic_blocks(TIME, 50 * np.exp(-TIME / 300)), ramp_duration=2.0)
    assert bent.standard_uncertainty > 20 * straight.standard_uncertainty


@pytest.mark.parametrize(("ramp_duration", "last"), [(200.0, 1000), (2.0, 15)])
def test_a_hold_too_short_for_a_rate_is_refused(ramp_duration, last):
    blocks = logarithmic_blocks(TIME[:last], TIME[:last])
    with pytest.raises(
        DataError, match="too short for a rate per decade: .* decades of time remain; needed 0.5"
    ):
        rate_per_decade(blocks, ramp_duration=ramp_duration)


def test_the_mean_of_an_end_has_the_uncertainty_of_its_noise():
    rng = np.random.default_rng(1)
    series = rng.standard_normal(400)
    _, uncertainty = end_mean(series, n_samples=100)
    assert uncertainty == pytest.approx(0.1, rel=0.1)


def test_a_series_quieter_than_its_digitizer_keeps_the_digitizer():
    series = np.zeros(400)
    series[200:] = 1.0  # one step of the digitizer
    mean, uncertainty = end_mean(series, n_samples=100)
    assert mean == 1.0
    assert uncertainty == pytest.approx(1 / np.sqrt(12), rel=0.01)


def test_missing_samples_are_left_out_of_an_end():
    mean, _ = end_mean([9.0, 2.0, 4.0, np.nan], n_samples=2)
    assert mean == 3.0


def test_an_end_of_one_sample_is_refused():
    with pytest.raises(DataError, match="no noise can be read"):
        end_mean([1.0, np.nan], n_samples=1)


def test_values_at_times_are_free_of_noise_where_samples_are_many():
    rng = np.random.default_rng(2)
    time = np.arange(0, 700, 0.01)
    series = 400 - 10 * np.log1p(time) + rng.standard_normal(time.size)
    found, _ = value_at_times(time, series, [60.0, 600.0])
    np.testing.assert_allclose(found, 400 - 10 * np.log1p([60.0, 600.0]), atol=0.2)


def test_values_beyond_the_series_and_in_gaps_are_nan():
    time = np.array([0.0, 1.0, 2.0, 3.0, 100.0, 101.0])
    found, _ = value_at_times(time, time, [0.0, 1.0, 50.0, 101.0, 102.0])
    np.testing.assert_allclose(found, [0, 1, np.nan, 101, np.nan])


def test_values_at_times_need_finite_values():
    with pytest.raises(DataError, match="values are not finite"):
        value_at_times([0.0, 1.0], [1.0, np.nan], [0.5])


def test_a_value_between_two_readings_of_a_slow_log_has_the_noise_of_one():
    """At least that of a reading, 0.05; the bend that its neighbours show is noise of that size."""
    time = np.arange(0, 1000, 10.0)
    series = 100 + 0.05 * np.random.default_rng(5).standard_normal(time.size)
    _, spread = value_at_times(time, series, np.arange(15, 100, 10.0))
    assert 0.05 == pytest.approx(spread.min(), rel=0.2)
    assert np.median(spread) < 0.1
