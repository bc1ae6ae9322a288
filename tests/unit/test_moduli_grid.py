"""Strain grid: round bins, windows with enough samples, pooling, and what is refused."""

import dataclasses

import numpy as np
import pytest

from reduction.record.errors import DataError, SettingsError
from reduction.record.settings import ModulusSettings
from reduction.stages.moduli.tangent_window import choose_grid_and_window, round_number

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
