"""Drop, rate per decade, and tension at stated times."""

import numpy as np
import pytest
from refusals import refusals

from reduction.record.errors import DataError
from reduction.stages.holds.relaxation_numbers import (
    _tension_variation,
    creep_rate,
    end_mean,
    logarithmic_blocks,
    rate_per_decade,
    relaxation_drop,
    value_at_times,
)

TIME = np.arange(1.0, 1001.0)


def test_a_drop_from_nothing_is_nan():
    assert np.isnan(relaxation_drop(0.0, 1.0))


def test_a_logarithmic_relaxation_gives_its_rate():
    rate = rate_per_decade(logarithmic_blocks(TIME, 400 - 20 * np.log10(TIME)), ramp_duration=2.0)
    assert rate.value == pytest.approx(-20, rel=2e-3)
    assert rate.elapsed_low >= 6
    assert rate.elapsed_high > 950


def test_the_rate_after_a_long_ramp_is_that_after_a_step():
    # the mean of log10(time - s) over a ramp of 30 s, in closed form
    late, early = TIME[89:] + 15, TIME[89:] - 15
    logarithm = (late * np.log10(late) - early * np.log10(early)) / 30 - 1 / np.log(10)
    rate = rate_per_decade(logarithmic_blocks(TIME[89:], -20 * logarithm), ramp_duration=30.0)
    assert rate.value == pytest.approx(-20, rel=3e-4)


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


def test_a_value_between_two_readings_of_a_slow_log_has_the_noise_of_one():
    """At least that of a reading, 0.05; the bend that its neighbours show is noise of that size."""
    time = np.arange(0, 1000, 10.0)
    series = 100 + 0.05 * np.random.default_rng(5).standard_normal(time.size)
    _, spread = value_at_times(time, series, np.arange(15, 100, 10.0))
    assert 0.05 == pytest.approx(spread.min(), rel=0.2)
    assert np.median(spread) < 0.1


# block means that grow with time


def test_blocks_keep_the_sum_of_the_series():
    time = np.arange(1.0, 5001.0)
    values = np.random.default_rng(0).standard_normal(5000)
    blocks = logarithmic_blocks(time, values)
    assert blocks.count.sum() == 5000
    assert blocks.count @ blocks.value == pytest.approx(values.sum())
    assert np.all(np.diff(blocks.elapsed) > 0)


def test_a_night_becomes_a_few_hundred_blocks():
    time = np.arange(1, 1_000_001) * 0.05
    assert logarithmic_blocks(time, time).elapsed.size < 260


@pytest.mark.parametrize("relaxation_time", [1.0, 30.0, 1000.0])
def test_an_exponential_is_off_by_less_than_stated(relaxation_time):
    time = np.arange(0.01, 3000, 0.01)
    blocks = logarithmic_blocks(time, np.exp(-time / relaxation_time))
    error = blocks.value - np.exp(-blocks.elapsed / relaxation_time)
    assert np.abs(error).max() < 2e-4


def test_no_block_counts_for_more_than_sixty_four_samples():
    blocks = logarithmic_blocks(np.arange(1.0, 1e5), np.ones(99999))
    assert blocks.weight[0] == 1
    assert blocks.weight.max() < 64


# creep at constant tension

TIME_OF_CREEP = np.arange(1.0, 2001.0)
STRAIN = 1 + 0.03 * np.log10(TIME_OF_CREEP)


def test_a_logarithmic_creep_gives_its_rate_under_noisy_tension():
    tension = 400 + 3 * np.random.default_rng(0).standard_normal(TIME_OF_CREEP.size)
    # The first blocks hold one sample each: three standard deviations stay within 1 %.
    tension = np.clip(tension, 397, 403)
    assert creep_rate(TIME_OF_CREEP, STRAIN, tension, ramp_duration=2.0).value == pytest.approx(
        0.03, rel=1e-2
    )


def test_tension_that_is_not_constant_is_refused():
    with pytest.raises(
        DataError, match="tension is not constant: it deviates .* needed 1 % or less"
    ):
        creep_rate(TIME_OF_CREEP, STRAIN, 400 - 10 * np.log10(TIME_OF_CREEP), ramp_duration=2.0)


@pytest.mark.parametrize(("size", "lasts", "is_given"), [(0.05, 3.0, True), (0.05, 12.0, False)])
def test_a_load_that_overshoots_shortly_before_the_readings_that_count_gives_a_rate(
    size, lasts, is_given
):
    """Ramp of 6 s, readings count from 18 s on; a specimen whose creep is a logarithm of time."""
    over = TIME_OF_CREEP <= lasts
    # the response to the overshoot, which ends there
    after = np.maximum(TIME_OF_CREEP - lasts, 1e-3)
    strain = 0.03 * (
        (1 + size) * np.log10(TIME_OF_CREEP) - size * np.log10(np.where(over, 1, after))
    )
    tension = np.where(over, 400 * (1 + size), 400.0)
    if is_given:
        found = creep_rate(TIME_OF_CREEP, strain, tension, ramp_duration=6.0)
        assert found.value == pytest.approx(0.03, rel=5e-3)
        return
    with pytest.raises(DataError, match="tension is not constant"):
        creep_rate(TIME_OF_CREEP, strain, tension, ramp_duration=6.0)


REFUSED = {
    "drops pair up": (
        lambda: relaxation_drop([1.0, 2.0], [1.0]),
        DataError,
        "series do not pair up",
    ),
    "an end of one sample is refused": (
        lambda: end_mean([1.0, np.nan], n_samples=1),
        DataError,
        "no noise can be read",
    ),
    "values at times need finite values": (
        lambda: value_at_times([0.0, 1.0], [1.0, np.nan], [0.5]),
        DataError,
        "values are not finite",
    ),
    "time at zero is refused": (
        lambda: logarithmic_blocks([0.0, 1.0], [1.0, 1.0]),
        DataError,
        "time does not start above zero; found 0 s",
    ),
    "no samples are refused": (
        lambda: logarithmic_blocks([], []),
        DataError,
        "time does not start above zero; found no samples",
    ),
    "time that goes back is refused": (
        lambda: logarithmic_blocks([1.0, 3.0, 2.0], [1.0, 1.0, 1.0]),
        DataError,
        "not above the one before",
    ),
    "no tension is refused": (
        lambda: _tension_variation(TIME_OF_CREEP, np.zeros(TIME_OF_CREEP.size)),
        DataError,
        "creep under no tension; found 0 N",
    ),
    "a hold too short is refused": (
        lambda: creep_rate(TIME_OF_CREEP[:5], STRAIN[:5], np.full(5, 400.0), ramp_duration=2.0),
        DataError,
        "too short for a rate per decade",
    ),
}


test_refusals = refusals(REFUSED)
