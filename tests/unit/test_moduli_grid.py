"""Strain grid: round bins, windows with enough samples, pooling, and what is refused."""

import dataclasses

import numpy as np
import pytest

from reduction.record.errors import DataError, SettingsError
from reduction.record.settings import ModulusSettings
from reduction.stages.moduli.local_regression import accumulate_moments, fit_windows
from reduction.stages.moduli.tangent_window import (
    StrainGrid,
    adapt_window,
    choose_grid_and_window,
    round_number,
    window_blur,
)

AUTOMATIC = ModulusSettings()


@pytest.mark.parametrize(
    ("value", "nearest"),
    [(0.0119, 0.01), (0.0232, 0.02), (0.0325, 0.05), (0.0071, 0.01), (0.0070, 0.005), (1.0, 1.0)],
)
def test_bins_are_a_number_of_the_1_2_5_series(value, nearest):
    assert round_number(value) == nearest


def test_edges_are_multiples_of_the_width_and_hold_the_stroke(triangle):
    strain, cycles = triangle(low=0.773, high=1.248)
    grid = choose_grid_and_window(strain, cycles=cycles, settings=AUTOMATIC)
    assert grid.width == 0.01
    assert grid.bounds / grid.width == pytest.approx(np.rint(grid.bounds / grid.width), abs=1e-9)
    assert grid.bounds[0, 0] <= 0.773 - grid.width
    assert grid.bounds[-1, 1] >= 1.248 + grid.width
    assert grid.centres == pytest.approx(grid.bounds.mean(axis=1))


def test_dense_samples_take_a_window_of_five_bins(triangle):
    strain, cycles = triangle(per_cycle=400)
    grid = choose_grid_and_window(strain, cycles=cycles, settings=AUTOMATIC)
    assert (grid.width, grid.half_window, grid.cycles_pooled) == (0.01, 2, 1)


def test_window_widens_to_three_times_the_fewest_samples(triangle):
    strain, cycles = triangle(per_cycle=96)
    grid = choose_grid_and_window(strain, cycles=cycles, settings=AUTOMATIC)
    # 48 samples on 0.5 of strain: 12 of them take 0.125, the next odd number of bins is 13
    assert grid.window == pytest.approx(0.13)


def test_few_samples_a_branch_pool_cycles_in_windows_of_four_spacings(triangle):
    strain, cycles = triangle(n_cycles=50, per_cycle=20)
    grid = choose_grid_and_window(strain, cycles=cycles, settings=AUTOMATIC)
    assert grid.window == pytest.approx(0.21)  # spacing 0.05
    assert grid.cycles_pooled == 2  # 8 samples are twice the fewest; a window holds 4.2


def test_given_bins_and_window_are_used(triangle):
    strain, cycles = triangle()
    settings = ModulusSettings(strain_bin_width=0.02, window=0.1)
    grid = choose_grid_and_window(strain, cycles=cycles, settings=settings)
    assert (grid.width, grid.half_window) == (0.02, 2)


def test_given_window_alone_gets_bins_that_fit_it(triangle):
    strain, cycles = triangle()
    grid = choose_grid_and_window(strain, cycles=cycles, settings=ModulusSettings(window=0.02))
    assert grid.width == 0.005
    assert grid.window == pytest.approx(0.025)


def test_spike_inside_a_branch_does_not_stretch_the_grid(triangle):
    strain, cycles = triangle()
    spoiled = strain.copy()
    spoiled[17] = 40.0
    assert choose_grid_and_window(
        spoiled, cycles=cycles, settings=AUTOMATIC
    ) == choose_grid_and_window(strain, cycles=cycles, settings=AUTOMATIC)


def test_dead_specimen_does_not_take_the_other_along(triangle):
    strain, cycles = triangle()
    both = np.stack([strain, np.full_like(strain, np.nan)])
    assert choose_grid_and_window(
        both, cycles=cycles, settings=AUTOMATIC
    ) == choose_grid_and_window(strain, cycles=cycles, settings=AUTOMATIC)


def test_specimens_share_a_grid_that_holds_both(triangle):
    strain, cycles = triangle(low=1.0, high=1.5)
    grid = choose_grid_and_window(
        np.stack([strain, strain + 0.3]), cycles=cycles, settings=AUTOMATIC
    )
    assert grid.bounds[0, 0] < 1.0 < 1.8 < grid.bounds[-1, 1]


def without_cycles(cycles):
    nothing = np.empty(0, dtype=np.int64)
    pairs = nothing.reshape(0, 2)
    return dataclasses.replace(
        cycles, first=nothing, last=nothing, branch_first=pairs, branch_last=pairs
    )


def test_no_cycle_is_refused(triangle):
    strain, cycles = triangle()
    with pytest.raises(DataError, match="no cycle to make a strain grid from"):
        choose_grid_and_window(strain, cycles=without_cycles(cycles), settings=AUTOMATIC)


def test_no_strain_at_the_ends_of_branches_is_refused(triangle):
    strain, cycles = triangle()
    with pytest.raises(DataError, match="no branch has strain at both ends"):
        choose_grid_and_window(np.full_like(strain, np.nan), cycles=cycles, settings=AUTOMATIC)


def test_strain_that_stands_still_is_refused(triangle):
    strain, cycles = triangle()
    with pytest.raises(DataError, match=r"does not move.*stroke of 0"):
        choose_grid_and_window(np.ones_like(strain), cycles=cycles, settings=AUTOMATIC)


def test_bin_width_of_zero_is_refused(triangle):
    strain, cycles = triangle()
    with pytest.raises(SettingsError, match="strain_bin_width is not positive; found 0"):
        choose_grid_and_window(
            strain, cycles=cycles, settings=ModulusSettings(strain_bin_width=0.0)
        )


def test_window_of_a_bin_is_refused(triangle):
    strain, cycles = triangle()
    settings = ModulusSettings(strain_bin_width=0.02, window=0.02)
    with pytest.raises(SettingsError, match="window is not wider than a bin; found 0.02"):
        choose_grid_and_window(strain, cycles=cycles, settings=settings)


def test_grid_finer_than_a_curve_can_be_is_refused(triangle):
    strain, cycles = triangle()
    settings = ModulusSettings(strain_bin_width=1e-5, window=1e-3)
    with pytest.raises(DataError, match=r"too many bins; found 500\d\d bins"):
        choose_grid_and_window(strain, cycles=cycles, settings=settings)


# blur of a moving window: the derived bias, and the noise that taking it off costs


def slopes_of(strain, tension, half_window, n_curves=1):
    grid = StrainGrid(low=0.0, width=0.01, n_bins=100, half_window=half_window)
    moments, _ = accumulate_moments(
        strain.ravel(), tension.ravel(), n_curves=n_curves, grid=grid, tension_reference=0.0,
        curve=np.repeat(np.arange(n_curves), strain.size // n_curves),
    )  # fmt: skip
    return grid, fit_windows(moments, minimum_count=4).slope


@pytest.mark.parametrize("half_window", [2, 4, 8])
def test_window_slope_of_a_cubic_is_high_by_a_fortieth_of_its_bend(half_window):
    strain = (np.arange(100_000) + 0.5) / 100_000
    grid, slope = slopes_of(strain, 1000 * strain**3, half_window)
    inside = slice(2 * half_window + 2, 98 - 2 * half_window)
    excess = slope[0] - 3000 * grid.centres**2
    assert excess[inside] == pytest.approx(6000 * grid.window**2 / 40, rel=1e-3)
    blur, _ = window_blur(slope, half_window=half_window)
    assert blur[0][inside] == pytest.approx(excess[inside], rel=1e-3)


@pytest.mark.parametrize("half_window", [2, 6])
def test_stated_noise_gain_is_that_of_simulated_noise(half_window):
    n_curves = 300
    strain = np.tile((np.arange(2000) + 0.5) / 2000, (n_curves, 1))
    noise = np.random.default_rng(5).normal(0, 1, strain.shape)
    _, slope = slopes_of(strain, noise, half_window, n_curves)
    blur, gain = window_blur(slope, half_window=half_window)
    inside = slice(20, 80)
    measured = np.sqrt(np.mean((slope - blur)[:, inside] ** 2) / np.mean(slope[:, inside] ** 2))
    assert gain == pytest.approx(measured, rel=0.03)


def test_blur_near_an_end_or_a_gap_is_that_of_the_nearest_bin():
    slope = 3 * np.arange(40.0) ** 2
    slope[20] = np.nan
    blur, _ = window_blur(slope, half_window=2)
    assert blur == pytest.approx(np.full(40, blur[3]))


def test_curve_too_short_to_bend_has_no_blur():
    blur, _ = window_blur([1.0, 5.0, 2.0, 7.0], half_window=2)
    assert not blur.any()
    blur, _ = window_blur(np.full(40, np.nan), half_window=2)
    assert not blur.any()


def test_the_bend_of_a_curve_shorter_than_two_windows_is_known_of_all_of_it():
    centre, half_window = np.arange(-11.0, 12.0), 14  # eight readings of a branch, in step
    slope = np.full(40, np.nan)
    slope[8:31] = 3 * centre**2 + 29**2 / 40 * 6
    blur, _ = window_blur(slope, half_window=half_window)
    assert (slope - blur)[8:31] == pytest.approx(3 * centre**2)
    # and not where in it that is: more than it, and far less than all that the slope changes by
    known = slope[None]
    _, _, missed = adapt_window([known], [0 * known], [blur[None]], half_windows=[half_window])
    assert np.all(missed[0, 8:31] >= 2 * blur[8:31])
    level = 1000 + centre + 1e-3 * centre**2
    known[0, 8:31] = level
    blur, _ = window_blur(known, half_window=half_window)
    _, _, missed = adapt_window([known], [0 * known], [blur], half_windows=[half_window])
    assert np.all(missed[0, 8:31] < 0.1 * np.ptp(level))


def test_window_of_one_bin_is_refused():
    with pytest.raises(DataError, match="a window is a bin wide; found half_window 0"):
        window_blur([1.0, 2.0], half_window=0)


def test_a_jump_that_the_finest_window_is_too_noisy_to_show_is_carried_by_the_next_wider_one():
    """Lines fitted across a kink: the slope goes over as u (3 - u^2) / 4 of the jump, by hand."""
    jump, bins = 1.0, np.arange(61)
    true = np.where(bins > 30, jump, 0.0)
    half_windows = [12, 6, 2]
    slopes = [
        jump * (0.5 + u * (3 - u**2) / 4)[None]
        for half in half_windows
        for u in [np.clip((bins - 30.5) / half, -1, 1)]
    ]
    deviation = [np.full((1, 61), each) for each in (0.005, 0.02, 0.3)]
    change, noise, missed = adapt_window(
        slopes, deviation, [np.zeros((1, 61))] * 3, half_windows=half_windows
    )
    away = np.abs(slopes[0] + change - true)[0, 27:35]
    assert away.max() > 0.4 * jump
    assert (away < 1.96 * np.hypot(noise, missed)[0, 27:35]).all()


def test_the_bend_of_a_stiffening_curve_is_no_noise():
    """A modulus that grows fourfold, as of a hose, read by windows of 9, 5 and 3 bins."""
    place = np.linspace(0, 1, 25)
    curve = 1 + 6 * 0.1 * np.logaddexp(0, (place - 0.5) / 0.1)
    rng = np.random.default_rng(2)
    halves = [4, 2, 1]
    # white noise of the readings: the deviation of a slope goes with the width to the power -3/2
    deviations = [0.001 * (9 / (2 * half + 1)) ** 1.5 for half in halves]
    slopes = [(curve + rng.normal(0, u, 25))[None] for u in deviations]
    _, noise, _ = adapt_window(
        slopes, [np.full((1, 25), u) for u in deviations], [np.zeros((1, 25))] * 3,
        half_windows=halves,
    )  # fmt: skip
    assert np.all(noise < 4 * deviations[-1])


def test_chance_in_one_bin_takes_no_narrower_window():
    """A straight line of modulus 1, read by windows of 9 and 3 bins; the narrow ones scatter."""
    rng = np.random.default_rng(4)
    deviations = [0.004, 0.02]
    slopes = [1 + rng.normal(0, u, (1, 400)) for u in deviations]
    change, _, missed = adapt_window(
        slopes, [np.full((1, 400), u) for u in deviations], [np.zeros((1, 400))] * 2,
        half_windows=[4, 1],
    )  # fmt: skip
    error = np.abs(slopes[0] + change - 1)[0]
    # of 400 comparisons with two deviations 18 are beyond them by chance, few of them side by side
    assert np.count_nonzero(np.abs(slopes[0] - slopes[1]) > 2 * deviations[1]) > 10
    assert np.count_nonzero(change) <= 6
    assert np.mean(error < 1.96 * np.hypot(deviations[0], missed[0])) > 0.93


@pytest.mark.parametrize("shape", ["bend", "step"])
def test_what_one_width_may_miss_is_more_at_a_step_than_in_a_bend(shape):
    half, place = 4, np.arange(60.0)
    kernel = np.arange(-half, half + 1.0)
    kernel = (half + 0.5) ** 2 - kernel**2
    curve = np.where(place < 30, 3.0, 1.0) if shape == "step" else 1 + (place / 30) ** 2
    slope = np.full((1, 60), np.nan)
    slope[0, half:-half] = np.convolve(curve, kernel / kernel.sum(), "valid")
    blur, _ = window_blur(slope, half_window=half)
    _, _, missed = adapt_window([slope - blur], [0 * slope], [blur], half_windows=[half])
    error = np.abs(slope - blur - curve)[0]
    inside = slice(2 * half, -2 * half)
    assert np.all(error[inside] <= 2 * missed[0, inside] + 1e-12)
    if shape == "bend":
        assert np.all(missed[0, inside] <= 1.01 * np.abs(blur).max())


def test_the_blur_of_a_bend_that_grows_is_not_known_as_far_as_the_ends():
    # of E = x^3 a window of w bins reads x^3 + 3 w^2 / 20 x; nearer than step bins to an end the
    # blur is that of the nearest bin that has one, off by 3 w^2 / 20 a bin
    place, halves = np.arange(60.0), [5, 2]
    slopes = [(place**3 + 3 * (2 * half + 1) ** 2 / 20 * place)[None] for half in halves]
    blurs = [
        window_blur(slope, half_window=half)[0] for slope, half in zip(slopes, halves, strict=True)
    ]
    slopes = [slope - blur for slope, blur in zip(slopes, blurs, strict=True)]
    too_noisy = [0 * slopes[0], np.full_like(slopes[1], 1e4)]
    change, _, missed = adapt_window(slopes, too_noisy, blurs, half_windows=halves)
    error = np.abs(slopes[0] + change - place**3)[0]
    step = halves[0] + 1
    assert error[:step] == pytest.approx(3 * 11**2 / 20 * np.arange(step, 0, -1))
    assert np.all(error <= 2 * missed[0] + 1e-6)


def test_noise_of_the_only_window_is_no_bend_that_it_misses():
    # a straight modulus, of which a window misses nothing, with the noise of overlapping windows
    half, n_bins, n_curves, noise = 6, 60, 40, 1.0
    rng = np.random.default_rng(6)
    place = np.arange(-half, half + 1)
    kernel = place / np.sum(place**2)
    kernel *= noise / np.sqrt(np.sum(kernel**2))
    errors = rng.standard_normal((n_curves, n_bins + 2 * half))
    slope = 100 + np.arange(n_bins) + np.stack(
        [np.convolve(one, kernel[::-1], mode="valid") for one in errors]
    )  # fmt: skip
    blur, _ = window_blur(slope, half_window=half)
    deviation = np.full(slope.shape, noise)
    _, _, missed = adapt_window([slope], [deviation], [blur], half_windows=[half])
    inner = np.s_[:, 2 * half : -2 * half]
    # two and a half times the range of the bends that noise makes are twice the noise
    assert np.median(missed[inner]) < 0.6 * noise


def test_a_modulus_that_rises_and_falls_all_along_is_no_noise_of_the_narrow_window():
    """Ten cycles, read well; a wave of 12 bins that the wide window averages away."""
    x = np.arange(120)
    true = 3.0 + 0.3 * np.sin(2 * np.pi * x / 12)
    halves = [6, 3]
    slopes = [
        np.convolve(np.pad(true, half, mode="wrap"), np.ones(2 * half + 1), "valid")[None]
        / (2 * half + 1)
        for half in halves
    ]
    noise_of_residuals = [np.full((1, 120), 0.01)] * 2
    change, noise, missed = adapt_window(
        slopes, noise_of_residuals, [0 * slopes[0]] * 2, half_windows=halves, n_cycles=10
    )
    error = np.abs(slopes[0] + change - true)
    assert np.mean(error < 1.96 * np.hypot(noise, missed)) > 0.95
    assert error.mean() < 0.5 * np.abs(slopes[0] - true).mean()
