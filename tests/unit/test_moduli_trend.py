"""Trends against the logarithm of cycle number."""

from dataclasses import fields, replace

import numpy as np
import pytest

from reduction.record.errors import DataError
from reduction.stages.cycles.cycle_product import Loops
from reduction.stages.moduli.secant_modulus import _change_of_ends, fit_peak_trend, slope_per_decade


def loops_of(values, spring=None):
    names = [item.name for item in fields(Loops) if item.name != "uncertainty"]
    loops = Loops(**{name: np.array(values) for name in names}, uncertainty={})
    return loops if spring is None else replace(loops, apparent_spring_constant=np.array(spring))


def test_a_logarithmic_decay_gives_its_slope_whatever_the_break_in():
    number = np.arange(1, 201)
    peak = (700 - 30 * np.log10(number))[None]
    for break_in in (0, 20):
        trend = fit_peak_trend(loops_of(peak), area=[1.0], break_in_cycles=break_in)
        np.testing.assert_allclose(trend.peak_tension_per_decade, -30, rtol=1e-9)


def test_the_dynamic_modulus_is_spring_constant_over_area():
    number = np.arange(1, 51)
    spring = (400 + 5 * np.log10(number))[None]
    trend = fit_peak_trend(loops_of(np.ones((1, 50)), spring), area=[5e-4])
    np.testing.assert_allclose(trend.dynamic_modulus_per_decade, 5 / 5e-4, rtol=1e-9)


def test_the_stated_uncertainty_is_the_scatter_of_repeated_series():
    rng = np.random.default_rng(0)
    series = -20 * np.log10(np.arange(1, 101)) + rng.standard_normal((400, 100))
    slope, uncertainty = slope_per_decade(series)
    assert slope.mean() == pytest.approx(-20, abs=0.1)
    # Residual correlation is read from each series, so the mean lies a little above.
    assert 0.95 < uncertainty.mean() / slope.std() < 1.35


def test_change_takes_at_most_ten_cycles_at_each_end():
    peak = np.where(np.arange(2000) < 10, 700.0, 650.0)[None]
    change = fit_peak_trend(loops_of(peak), area=[1.0]).peak_tension_change
    assert change == pytest.approx(650 / 700 - 1)


def test_change_is_last_over_first():
    peak = np.array([[100.0, 98, 97, 96, 95]])
    assert fit_peak_trend(loops_of(peak), area=[1.0]).peak_tension_change == pytest.approx(-0.05)


@pytest.mark.parametrize("n_cycles", [10, 200])
def test_the_uncertainty_of_the_change_is_the_scatter_of_repeated_tests(n_cycles):
    rng = np.random.default_rng(4)
    decay = 700 - 20 * np.log10(10 + np.arange(n_cycles))
    change, uncertainty = _change_of_ends(decay + 3 * rng.standard_normal((3000, n_cycles)))
    ends = 1 if n_cycles == 10 else 10
    expected = decay[-ends:].mean() / decay[:ends].mean() - 1
    assert change.mean() == pytest.approx(expected, abs=3e-4)
    rms = np.sqrt(np.mean(uncertainty**2))
    assert rms == pytest.approx(change.std(), rel=0.06)


def test_two_cycles_have_a_change_and_no_scatter():
    change, uncertainty = _change_of_ends([[100.0, 95.0], [100.0, np.nan]])
    assert change[0] == pytest.approx(-0.05)
    assert np.isnan(change[1])
    assert np.isnan(uncertainty).all()


def test_a_missing_cycle_in_the_middle_leaves_its_neighbours_out_of_the_scatter():
    _, whole = _change_of_ends([[100.0, 101, 100, 101, 100]])
    _, holed = _change_of_ends([[100.0, 101, np.nan, 101, 100]])
    assert holed == pytest.approx(whole)


def test_missing_cycles_are_left_out_and_too_few_give_nan():
    peak = np.stack([700 - 30 * np.log10(np.arange(1.0, 51)), np.full(50, np.nan)])
    peak[0, [3, 17]] = np.nan
    slope, uncertainty = slope_per_decade(peak)
    assert slope[0] == pytest.approx(-30)
    assert np.isnan([slope[1], uncertainty[1]]).all()


def test_a_break_in_longer_than_the_test_leaves_three_cycles():
    peak = (700 - 30 * np.log10(np.arange(1, 11)))[None]
    trend = fit_peak_trend(loops_of(peak), area=[1.0], break_in_cycles=50)
    np.testing.assert_allclose(trend.peak_tension_per_decade, -30, rtol=1e-9)


def test_a_specimen_without_diameter_has_no_modulus():
    trend = fit_peak_trend(loops_of(np.ones((1, 20))), area=[np.nan])
    assert np.isnan(trend.dynamic_modulus_per_decade).all()


def test_a_negative_area_is_refused():
    with pytest.raises(DataError, match="area are not positive"):
        fit_peak_trend(loops_of(np.ones((1, 20))), area=[-1.0])


def test_cycles_count_from_one():
    with pytest.raises(DataError, match="cycles count from 1; found 0"):
        slope_per_decade([[1.0, 2.0, 3.0]], number=[0, 1, 2])
