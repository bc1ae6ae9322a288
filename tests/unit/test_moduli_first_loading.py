"""First loading: the rise alone, gaps at holds, no reloading, no spikes."""

import numpy as np
import pytest
import scipy.signal

from reduction.record.errors import DataError
from reduction.record.settings import ModulusSettings
from reduction.stages.moduli.first_loading import first_loading_curves
from reduction.stages.standstills import Standstills

AREA = 5e-4
SETTINGS = ModulusSettings()


def rise_with_a_hold():
    """Up to 1.2, a hold in which 10 % of tension goes, stiff recovery, up to 2, then cycles."""
    up, hold, on = np.linspace(0, 1.2, 600), np.full(300, 1.2), np.linspace(1.2, 2.0, 400)
    cycling = 1.6 + 0.4 * np.cos(np.linspace(0, 20 * np.pi, 2000))
    strain = np.concatenate([up, hold, on, cycling])
    tension = 300 * strain
    tension[600:900] -= np.linspace(0, 36, 300)
    tension[900:1300] -= 36 * np.exp(-(on - 1.2) / 0.02)
    tension[1300:] -= 20
    where = slice(600, 899)
    standstills = Standstills(
        first=np.array([where.start]), last=np.array([where.stop]), start_time=np.zeros(1),
        end_time=np.ones(1), mean_position=np.ones(1), mean_tension=np.ones((1, 1)),
        is_rest=np.zeros(1, dtype=bool), position_tolerance=0.0, slack_tension=0.0,
    )  # fmt: skip
    return strain, tension, standstills


def curves_of(strain, tension, standstills=None, settings=SETTINGS):
    return first_loading_curves(
        np.atleast_2d(strain), np.atleast_2d(tension), area=[AREA], settings=settings,
        standstills=standstills,
    )  # fmt: skip


def test_window_does_not_reach_over_a_hold():
    strain, tension, standstills = rise_with_a_hold()
    curves = curves_of(strain, tension, standstills)
    modulus = curves.tangent_modulus[0, 0] * AREA
    near = np.abs(curves.strain_bin - 1.2) < curves.window / 8
    assert np.isnan(modulus[near]).all()
    before = np.isfinite(modulus) & (curves.strain_bin < 1.2)
    assert modulus[before] == pytest.approx(300)
    recovered = np.isfinite(modulus) & (curves.strain_bin > 1.4)
    assert modulus[recovered] == pytest.approx(300, rel=1e-2)
    assert curves.strain_bin[np.isfinite(modulus)][-1] > 1.9
    assert np.isnan(curves.tangent_modulus[0, 1]).all()


def test_tension_stands_beside_the_modulus():
    strain, tension, standstills = rise_with_a_hold()
    curves = curves_of(strain, tension, standstills)
    at = np.argmin(np.abs(curves.strain_bin - 0.6))
    assert curves.branch_tension[0, 0, at] == pytest.approx(300 * curves.strain_bin[at])


def test_reloading_below_the_greatest_strain_is_left_out():
    up, back = np.linspace(0, 1, 500), np.linspace(1, 0.4, 300)
    strain = np.concatenate([up, back, back[::-1], np.linspace(1, 2, 500)])
    tension = 300 * strain
    tension[501:1099] -= 50  # softened on the way back and up again
    curves = curves_of(strain, tension)
    modulus = curves.tangent_modulus[0, 0]
    assert modulus[np.isfinite(modulus)] * AREA == pytest.approx(300, rel=1e-6)


def test_single_spike_is_not_the_greatest_strain():
    strain, tension, standstills = rise_with_a_hold()
    spiked = strain.copy()
    spiked[200] = 30.0
    spiked[2500] = 25.0
    curves = curves_of(spiked, tension, standstills)
    assert curves.strain_bin[-1] < 2.1
    plain = curves_of(strain, tension, standstills)
    middle = np.argmin(np.abs(curves.strain_bin - 1.7))
    assert curves.tangent_modulus[0, 0, middle] == pytest.approx(
        plain.tangent_modulus[0, 0, middle], rel=1e-3
    )


def test_missing_samples_are_skipped():
    strain, tension, standstills = rise_with_a_hold()
    strain, tension = strain.copy(), tension.copy()
    strain[100:110] = np.nan
    tension[300:305] = np.nan
    modulus = curves_of(strain, tension, standstills).tangent_modulus[0, 0]
    at = np.isfinite(modulus)[: modulus.size // 3]
    assert at.sum() > 10


def test_record_that_does_not_rise_has_no_first_loading():
    assert curves_of(np.linspace(2, 1, 100), np.linspace(600, 300, 100)) is None
    assert curves_of(np.full(100, np.nan), np.ones(100)) is None
    assert curves_of(np.full(100, 1.0), np.ones(100)) is None


def test_given_bins_and_window_are_used():
    strain, tension, standstills = rise_with_a_hold()
    settings = ModulusSettings(strain_bin_width=0.05, window=0.15)
    curves = curves_of(strain, tension, standstills, settings)
    assert curves.window == pytest.approx(0.15)


def test_series_that_do_not_pair_up_are_refused():
    with pytest.raises(DataError, match="strain, tension and area do not pair up"):
        curves_of(np.ones((2, 5)), np.ones((2, 5)))


def noise_of(kind, rng, n):
    """White, or of a first-order filter that leaves neighbours correlated by .87."""
    white = rng.standard_normal(n)
    if kind == "white":
        return white
    return scipy.signal.lfilter([np.sqrt(1 - 0.87**2)], [1, -0.87], white)


# neighbours correlated by .87 leave a slope sqrt(1.87 / .13) times as uncertain as white noise
@pytest.mark.parametrize(("kind", "widest"), [("white", 1.5), ("filtered", 1.5 * 3.8)])
def test_a_break_behind_it_widens_no_interval_of_the_rise(kind, widest):
    # synthetic: a coupon that yields, and at .85 of the stretch parts within a two-hundredth of it
    strain, rng = np.linspace(0, 0.1, 4000), np.random.default_rng(7)
    load = 6000 * np.tanh(strain / 0.01) + 8000 * strain
    parts = strain > 0.085
    load[parts] = 6680 * np.exp(-(strain[parts] - 0.085) / 5e-4)
    deviations, spreads = [], []
    for _ in range(6):
        measured = load + 3 * noise_of(kind, rng, strain.size)
        found = first_loading_curves(
            strain[None], measured[None], area=[1.0], settings=ModulusSettings()
        )
        at = found.strain_bin
        before = (at > 0.002) & (at < 0.08)
        true = 6e5 / np.cosh(at[before] / 0.01) ** 2 + 8000
        spread = found.tangent_modulus_standard_uncertainty[0, 0, before]
        deviations.append((found.tangent_modulus[0, 0, before] - true) / spread)
        spreads.append(spread)
    assert np.mean(np.abs(deviations) < 1.96) > 0.92
    # of a straight line through a window of 100 readings of 3 N: 3 sqrt(12 / 100) / .0025
    assert np.median(spreads) < widest * 3 * np.sqrt(12 / 100) / 0.0025


def test_noise_of_strain_does_not_pull_in_the_ends_of_a_rise():
    """A rise of 4,000 samples and cycles, linear: its chord is its stiffness, 1 % noise or not."""
    away = []
    for seed in range(8):
        noise = np.random.default_rng(seed)
        turns = 0.6 + 0.4 * np.cos(np.linspace(0, 6 * np.pi, 6000))
        true = np.concatenate([np.linspace(0, 1, 4000), turns])
        strain = true + 0.01 * noise.normal(size=true.size)
        curves = curves_of(strain, 300 * true)
        load = curves.branch_tension[0, 0]
        known = np.flatnonzero(np.isfinite(load) & (curves.strain_bin < 1))[[0, -1]]
        gain = np.diff(curves.strain_bin[known])[0]
        spread = np.hypot(*curves.branch_tension_standard_uncertainty[0, 0, known])
        away.append((np.diff(load[known])[0] - 300 * gain) / spread)
    # 10.8 with the curve of single samples
    assert np.sqrt(np.mean(np.square(away))) < 1.7
    assert abs(np.mean(away)) < 1.0


def test_a_knee_at_the_begin_says_nothing_of_the_scatter_behind_it():
    """A metal bar, 200 and 15 kN, noise of 1 N: windows of eight samples behind the knee."""
    strain = np.linspace(0, 0.03, 300)
    load = np.where(strain < 0.002, 2e5 * strain, 400 + 1.5e4 * (strain - 0.002))
    share = []
    for seed in range(12):
        tension = load + np.random.default_rng(seed).normal(0, 1.0, strain.size)
        curves = first_loading_curves(
            strain[None], tension[None], area=[1.0], settings=ModulusSettings()
        )
        inside = (curves.strain_bin > 0.012) & (curves.strain_bin < 0.028)
        off = curves.tangent_modulus[0, 0, inside] - 1.5e4
        share.append(off / curves.tangent_modulus_standard_uncertainty[0, 0, inside])
    # 0.5 where the residuals of the knee count for all windows
    assert 0.8 < np.sqrt(np.nanmean(np.square(share))) < 1.25


def test_errors_that_last_as_long_as_a_window_are_in_the_uncertainty():
    """A screw whose pitch is a thirtieth of the pull, and white noise a tenth of its error."""
    noise = np.random.default_rng(4)
    stretch = np.linspace(0.0, 0.05, 2000)
    read = stretch + 3e-5 * np.sin(2 * np.pi * 30 * stretch / 0.05)
    load = 1000 * (stretch + 2 * stretch**2) + noise.normal(0, 3e-3, stretch.size)
    curves = first_loading_curves(
        read[None], load[None], area=[1e-4], settings=ModulusSettings(minimum_count=4)
    )
    expected = 1e7 * (1 + 4 * curves.strain_bin)
    off = (curves.tangent_modulus - expected)[0, 0]
    off /= curves.tangent_modulus_standard_uncertainty[0, 0]
    known = np.isfinite(off)
    assert known.sum() > 180
    assert np.sqrt(np.mean(off[known] ** 2)) < 1.5


def test_few_readings_have_the_scatter_of_those_around_them():
    """A stiff start with much scatter, many readings, and windows of five readings at last."""
    noise = np.random.default_rng(5)
    parts = (0.0, 0.01, 1500), (0.01, 0.06, 300), (0.06, 0.1, 80)
    strain = np.concatenate([np.linspace(*part)[1:] for part in parts])
    load = np.where(strain < 0.01, 1e6 * strain, 1e4 + 4e4 * (strain - 0.01))
    load += noise.normal(0, np.where(strain < 0.01, 400.0, 20.0))
    curves = first_loading_curves(strain[None], load[None], area=[1.0], settings=SETTINGS)
    later = (curves.strain_bin > 0.07) & (curves.strain_bin < 0.09)
    off = curves.tangent_modulus[0, 0, later] - 4e4
    spread = curves.tangent_modulus_standard_uncertainty[0, 0, later]
    assert 0.5 < np.sqrt(np.mean((off / spread) ** 2)) < 1.5
