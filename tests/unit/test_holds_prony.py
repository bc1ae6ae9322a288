"""Prony series: truth comes back, and what is not there is not reported."""

import numpy as np
import pytest
from refusals import refusals

from reduction.record.errors import DataError, FitError
from reduction.record.settings import HoldSettings, PhaseSettings
from reduction.stages.holds.prony_series import (
    _exponentials,
    _ramp_factor,
    fit_prony,
    prony_tension,
)
from reduction.stages.holds.relaxation_and_creep import reduce_holds
from reduction.stages.holds.relaxation_numbers import logarithmic_blocks
from reduction.stages.standstills import find_standstills

RAMP = 4.0
TERMS = {
    1: ([60.0], [30.0]),
    2: ([40.0, 35.0], [5.0, 70.0]),
    3: ([30.0, 25.0, 20.0], [2.0, 20.0, 150.0]),
}


def hold(n_terms, *, duration=600.0, step=0.1, noise=0.3, seed=0):
    tension, times = TERMS[n_terms]
    elapsed = np.arange(step, duration, step)
    series = prony_tension(
        elapsed,
        tension=tension,
        relaxation_time=times,
        long_time_tension=325.0,
        ramp_duration=RAMP,
    )
    return elapsed, series + noise * np.random.default_rng(seed).standard_normal(elapsed.size)


def fit(elapsed, series, **options):
    blocks = logarithmic_blocks(elapsed, series)
    return fit_prony(
        blocks.elapsed, blocks.value, weights=blocks.weight, ramp_duration=RAMP,
        time_variance=blocks.time_variance, **options,
    )  # fmt: skip


@pytest.mark.parametrize("n_terms", [1, 2, 3])
def test_terms_times_and_their_number_come_back(n_terms):
    found = fit(*hold(n_terms))
    tension, times = TERMS[n_terms]
    assert found.time.size == n_terms
    assert np.all(np.abs(found.time - times) < 4 * found.time_standard_uncertainty)
    assert np.all(np.abs(found.tension - tension) < 4 * found.tension_standard_uncertainty)
    assert np.all(found.time_standard_uncertainty < 0.2 * found.time)
    assert abs(found.long_time_tension - 325) < 4 * found.long_time_tension_standard_uncertainty
    assert found.criterion.startswith(f"{n_terms} of up to 3 terms")


@pytest.mark.parametrize("ramp", [8.0, 15.0])
def test_a_term_that_a_long_ramp_leaves_a_fraction_of_does_not_cost_the_series(ramp):
    """Synthetic: the ramp leaves a fifth, or a tenth, of a term of 1.5 s."""
    size, times = np.array([20.0, 16.0, 13.0]), np.array([1.5, 20.0, 250.0])
    elapsed = np.arange(0.1, 600.0, 0.1)
    series = prony_tension(
        elapsed, tension=size, relaxation_time=times, long_time_tension=325.0, ramp_duration=ramp
    )
    off = []
    for seed in range(12):
        noise = 0.4 * np.random.default_rng(seed).standard_normal(elapsed.size)
        blocks = logarithmic_blocks(elapsed, series + noise)
        found = fit_prony(blocks.elapsed, blocks.value, weights=blocks.weight, ramp_duration=ramp)
        off.append((found.tension - size) / found.tension_standard_uncertainty)
    assert 0.5 < np.sqrt(np.mean(np.square(off))) < 1.5


def test_stated_uncertainties_are_the_scatter_of_repeated_holds():
    fits = [fit(*hold(2, seed=seed), maximum_terms=2) for seed in range(60)]
    for name in ("tension", "time"):
        found = np.array([getattr(one, name) for one in fits])
        stated = np.mean([getattr(one, f"{name}_standard_uncertainty") for one in fits], axis=0)
        ratio = stated / found.std(axis=0)
        assert np.all((ratio > 0.7) & (ratio < 1.5))


def test_a_scaled_tension_scales_terms_and_leaves_times():
    elapsed, series = hold(2)
    one, ten = fit(elapsed, series), fit(elapsed, 10 * series)
    np.testing.assert_allclose(ten.tension, 10 * one.tension, rtol=1e-6)
    np.testing.assert_allclose(ten.time, one.time, rtol=1e-6)


def test_a_noise_free_hold_does_not_grow_terms():
    assert fit(*hold(1, noise=0.0)).time.size == 1


def test_a_term_beyond_the_hold_is_named_extrapolated():
    elapsed = np.arange(0.1, 200, 0.1)
    series = 325 + 75 * np.exp(-elapsed / 300)
    noise = 0.1 * np.random.default_rng(1).standard_normal(elapsed.size)
    assert "extrapolated" in fit(elapsed, series + noise).criterion


def test_a_straight_fall_has_no_series():
    elapsed = np.arange(0.1, 60, 0.1)
    noise = 0.1 * np.random.default_rng(2).standard_normal(elapsed.size)
    with pytest.raises(FitError, match="the record supports no Prony series; found .*1 term: "):
        fit(elapsed, 400 - 0.2 * elapsed + noise)


def test_a_rise_has_no_series():
    elapsed = np.arange(0.1, 60, 0.1)
    noise = 0.1 * np.random.default_rng(3).standard_normal(elapsed.size)
    with pytest.raises(FitError, match="the record supports no Prony series"):
        fit(elapsed, 400 - 30 * np.exp(-elapsed / 10) + noise)


def test_a_short_series_is_refused_where_the_record_shows_that_it_is_wrong():
    # One term is determined, but the second one, far longer than the hold, is there as well.
    elapsed = np.arange(0.05, 100, 0.05)
    series = 300 + 60 * np.exp(-elapsed / 8) + 90 * np.exp(-elapsed / 900)
    noise = 0.05 * np.random.default_rng(4).standard_normal(elapsed.size)
    with pytest.raises(
        FitError, match="the record supports 1 term, which fits poorly|no Prony series"
    ):
        fit(elapsed, series + noise)


@pytest.mark.parametrize("duration", [45.0, 120.0, 400.0])
def test_the_long_time_tension_carries_what_a_hold_is_too_short_to_show(duration):
    # two terms fit each hold; a third is still relaxing at the end of it
    time = np.geomspace(0.1, duration, 200)
    load = 325 + 40 * np.exp(-time / 2) + 35 * np.exp(-time / 25) + 60 * np.exp(-time / 300)
    load += 0.05 * np.random.default_rng(3).standard_normal(time.size)
    found = fit_prony(time, load, maximum_terms=2 if duration < 100 else 3)
    spread = found.long_time_tension_standard_uncertainty
    assert abs(found.long_time_tension - 325) < 2 * spread
    falls = 60 * duration / 300 * np.exp(-duration / 300) * np.log(10)
    assert spread > 0.3 * falls


def test_the_long_time_tension_of_a_hold_that_has_come_to_rest_is_as_sure_as_its_noise():
    time = np.geomspace(0.1, 600, 200)
    load = 325 + 75 * np.exp(-time / 40)
    load += 0.3 * np.random.default_rng(0).standard_normal(time.size)
    assert fit_prony(time, load).long_time_tension_standard_uncertainty < 0.1


# prony series and the finite ramp


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


REFUSED = {
    "no terms are refused": (
        lambda: fit_prony([1.0, 2.0], [1.0, 1.0], maximum_terms=0),
        DataError,
        "a series needs a term; found 0",
    ),
    "series that do not pair up are refused": (
        lambda: fit_prony([1.0, 2.0], [1.0]),
        DataError,
        "series do not pair up",
    ),
    "a negative ramp is refused": (
        lambda: _ramp_factor([1.0], ramp_duration=-1.0),
        DataError,
        "negative duration; found -1 s",
    ),
    "a time of zero is refused": (
        lambda: prony_tension([0.0], tension=[1.0], relaxation_time=[0.0], long_time_tension=0.0),
        DataError,
        "relaxation_time are not positive",
    ),
}


test_refusals = refusals(REFUSED)


@pytest.mark.parametrize("noise", [1e-5, 1e-3])
def test_terms_of_a_quiet_log_that_is_slow_beside_its_ramp(noise):
    """Synthetic: a ramp of 2 s read each half second, noise as a share of the tension lost."""
    off = []
    for seed in range(16):
        rng = np.random.default_rng(seed)
        time = np.arange(0, 800, 0.5) + rng.uniform(0, 0.5)
        size, times = rng.uniform(30, 80, 2), np.array([4.0, 60.0]) * rng.uniform(0.8, 1.25, 2)
        since = time - 22
        after = prony_tension(
            np.maximum(since, 0), tension=size, relaxation_time=times, long_time_tension=300.0,
            ramp_duration=2.0,
        )  # fmt: skip
        ramp = np.clip(since + 2, 0, 2)[:, None]
        during = 150 * ramp[:, 0] + (1 - np.exp(-ramp / times)) @ (size * times / 2)
        load = np.where(since > 0, after, during)
        load += rng.normal(0, noise * size.sum(), time.size)
        place = ramp[:, 0] / 2
        stands = find_standstills(time, place, [load], settings=PhaseSettings(), is_held=True)
        found = reduce_holds(
            time, place, [load], [place], stands, specimens=("synthetic",), settings=HoldSettings()
        )[-1]
        off += [
            (found.prony_tension - size) / found.prony_tension_standard_uncertainty,
            (found.prony_time - times) / found.prony_time_standard_uncertainty,
        ]
    assert np.sqrt(np.mean(np.square(off))) < 1.3
