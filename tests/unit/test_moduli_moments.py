"""Local regression from nine sums: exact on parabolas, equal to polyfit, honest about noise."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from scipy.special import stdtrit

from reduction.record.errors import DataError
from reduction.stages.moduli.local_regression import (
    CycleGroups,
    RunningStatistics,
    accumulate_moments,
    curve_at,
    fit_windows,
    select_cycles,
    sums_by_cell,
)
from reduction.stages.moduli.tangent_window import StrainGrid

GRID = StrainGrid(low=1.0, width=0.02, n_bins=25, half_window=3)


def fits_of(strain, tension, *, grid=GRID, curve=None, n_curves=1, minimum_count=4):
    curve = np.zeros(strain.size, dtype=np.int64) if curve is None else curve
    moments, _ = accumulate_moments(
        strain, tension, curve=curve, n_curves=n_curves, grid=grid, tension_reference=300.0
    )
    return fit_windows(moments, minimum_count=minimum_count)


def pooled_fits(strain, tension, *, grid, curve, n_curves):
    """Fits of all curves, each put on the mean curve."""
    moments, _ = accumulate_moments(
        strain, tension, curve=curve, n_curves=n_curves, grid=grid, tension_reference=300.0
    )
    return fit_windows(moments.pooled(1), minimum_count=4)


def tells_a_bend(strain, grid=GRID):
    """Whether the samples of each window leave of u**2, beside a line, 5 % of what even ones do."""
    shares = []
    for centre in grid.centres:
        u = (strain[np.abs(strain - centre) < grid.window / 2] - centre) / grid.window
        line = np.polynomial.Polynomial.fit(u, u**2, 1) if u.size > 1 else np.zeros_like
        shares.append(np.mean((u**2 - line(u)) ** 2) * 180 if u.size else 0.0)
    return np.array(shares) > 0.05


@given(seed=st.integers(0, 2**32 - 1), bend=st.floats(-1e4, 1e4))
@example(seed=12521, bend=1e4)  # a window of two clusters, which a straight line fits alone
def test_parabola_comes_back_at_the_bin_centres_where_samples_tell_its_bend(seed, bend):
    strain = 1 + 0.5 * np.random.default_rng(seed).random(150)
    fits = fits_of(strain, 300 + 500 * strain + bend * strain**2)
    known = np.isfinite(fits.slope[0]) & tells_a_bend(strain)
    centre = GRID.centres[known]
    scale = 500 + abs(bend)
    assert known.sum() > 10
    assert fits.slope[0, known] == pytest.approx(500 + 2 * bend * centre, abs=1e-9 * scale)
    value = 300 + 500 * centre + bend * centre**2
    assert fits.tension[0, known] == pytest.approx(value, abs=1e-9 * scale)


def test_a_line_is_fitted_where_no_bend_can_be_told():
    """Two clusters at the ends of a window: the chord between them, at its own mean."""
    strain = np.concatenate([np.linspace(1.031, 1.037, 4), np.linspace(1.143, 1.149, 4)])
    fits = fits_of(strain, 1000 * strain + 2000 * strain**2)
    (middle,) = np.flatnonzero(np.abs(GRID.centres - 1.09) < 1e-9)
    assert not tells_a_bend(strain)[middle]
    # about the centre the mean of the ends: 1000 + 2 * 2000 * 1.09; the level is the chord's
    assert fits.slope[0, middle] == pytest.approx(1000 + 4000 * 1.09)
    spread = np.mean((strain - 1.09) ** 2)
    level = 1000 * 1.09 + 2000 * (1.09**2 + spread)
    assert fits.tension[0, middle] == pytest.approx(level)


def test_fit_equals_polyfit_on_the_samples_of_the_window():
    rng = np.random.default_rng(1)
    strain = 1 + 0.5 * rng.random(400)
    tension = 100 * np.exp(strain) + rng.normal(0, 1, 400)
    fits = fits_of(strain, tension)
    for at in range(4, 21):
        low, high = GRID.bounds[at - 3, 0], GRID.bounds[at + 3, 1]
        inside = (strain >= low) & (strain < high)
        _, slope, level = np.polyfit(strain[inside] - GRID.centres[at], tension[inside], 2)
        assert fits.slope[0, at] == pytest.approx(slope, rel=1e-8)
        assert fits.tension[0, at] == pytest.approx(level, rel=1e-10)


@pytest.mark.parametrize("per_curve", [20, 60])  # 6 and 17 samples in a window
def test_stated_variances_are_those_of_many_noisy_branches(per_curve):
    rng = np.random.default_rng(2)
    n_curves = 2000
    strain = np.tile(np.linspace(1, 1.5, per_curve), n_curves)
    tension = 1000 * strain + rng.normal(0, 2.0, strain.size)
    fits = fits_of(
        strain, tension, curve=np.repeat(np.arange(n_curves), per_curve), n_curves=n_curves
    )
    for value, variance in (
        (fits.slope, fits.slope_variance),
        (fits.tension, fits.tension_variance),
    ):
        known = np.isfinite(value[0])
        stated = np.sqrt(variance[:, known].mean(axis=0))
        assert stated == pytest.approx(value[:, known].std(axis=0), rel=0.08)


def test_moments_of_two_pieces_add_up_to_those_of_the_whole():
    rng = np.random.default_rng(3)
    strain, tension = 1 + 0.5 * rng.random(200), rng.normal(300, 50, 200)

    def moments_of(part):
        return accumulate_moments(
            strain[part], tension[part], curve=np.zeros(strain[part].size, dtype=np.int64),
            n_curves=1, grid=GRID, tension_reference=300.0,
        )[0]  # fmt: skip

    together = moments_of(slice(0, 90)) + moments_of(slice(90, 200))
    assert together.sums == pytest.approx(moments_of(slice(0, 200)).sums, rel=1e-12)


def test_moments_of_two_references_are_refused():
    none = np.empty(0)
    both = [
        accumulate_moments(
            none, none, curve=none.astype(np.int64), n_curves=1, grid=GRID, tension_reference=level
        )[0]
        for level in (0.0, 1.0)
    ]
    with pytest.raises(DataError, match="moments of two grids do not add up"):
        both[0] + both[1]


def test_missing_samples_and_samples_of_no_curve_are_skipped():
    strain = np.linspace(1, 1.5, 300)
    tension = 1000 * strain
    spoiled_strain, spoiled_tension = strain.copy(), tension.copy()
    spoiled_strain[50:60] = np.nan
    spoiled_tension[100:110] = np.nan
    curve = np.zeros(300, dtype=np.int64)
    curve[200:205] = -1
    spoiled_tension[200:205] = 1e6
    fits = fits_of(spoiled_strain, spoiled_tension, curve=curve)
    known = np.isfinite(fits.slope)
    assert known.sum() >= 20
    assert fits.slope[known] == pytest.approx(1000)


def test_samples_off_the_grid_are_counted():
    strain = np.array([0.5, 1.1, 1.2, 9.0, np.nan])
    _, n_outside = accumulate_moments(
        strain, np.zeros(5), curve=np.zeros(5, dtype=np.int64), n_curves=1, grid=GRID,
        tension_reference=0.0,
    )  # fmt: skip
    assert n_outside == 2


def test_cluster_of_samples_has_no_slope():
    strain = np.full(50, 1.25) + np.random.default_rng(4).normal(0, 1e-4, 50)
    assert np.isnan(fits_of(strain, 1000 * strain).slope).all()


def test_two_clusters_give_a_straight_slope_between_them():
    strain = np.tile([1.20, 1.30], 20)
    fits = fits_of(strain, 1000 * strain)
    at = 12  # centre 1.25
    assert fits.slope[0, at] == pytest.approx(1000)


def test_fewer_samples_than_the_minimum_give_no_slope():
    strain = np.array([1.20, 1.23, 1.27, 1.30])
    assert np.isfinite(fits_of(strain, 1000 * strain, minimum_count=4).slope).any()
    assert np.isnan(fits_of(strain, 1000 * strain, minimum_count=5).slope).all()


def test_no_slope_is_given_where_a_window_hangs_over_the_end_of_a_branch():
    strain = np.linspace(1.0, 1.3, 300)
    known = np.isfinite(fits_of(strain, 1000 * strain).slope[0])
    last = GRID.centres[known][-1]
    assert 1.3 - last >= 0.24 * GRID.window


def test_two_samples_cannot_make_a_slope():
    strain = np.linspace(1, 1.5, 9)
    with pytest.raises(DataError, match=r"needs more samples; found minimum_count 2"):
        fits_of(strain, strain, minimum_count=2)


def test_the_levels_of_curves_of_few_samples_are_found_beside_their_slope():
    """A parabola, seven samples a curve at other strains each, on levels that fall: no residual."""
    n_curves, n_each = 12, 7
    places = (np.arange(n_each) + np.mod(0.37 * np.arange(n_curves)[:, None], 1)) / n_each
    strain = (1 + 0.5 * places).ravel()
    curve = np.repeat(np.arange(n_curves), n_each)
    tension = 1000 * strain + 400 * strain**2 - 3.0 * curve
    grid = StrainGrid(low=1.0, width=0.02, n_bins=25, half_window=7)
    fits = pooled_fits(strain, tension, grid=grid, curve=curve, n_curves=n_curves)
    known = np.isfinite(fits.slope[0])
    assert known.sum() > 15
    # across a bin tension rises by 35 N; of that, a few hundredths of a newton are taken for level
    assert fits.slope[0, known] == pytest.approx(1000 + 800 * grid.centres[known], rel=2e-3)
    assert np.sqrt(fits.slope_variance[0, known]).max() < 2.0


# groups of cycles: break-in apart, no short last group, and the cycles whose curves are kept


def test_a_cycle_is_a_group_where_none_are_pooled():
    groups = CycleGroups.of(5, 0, 1)
    assert list(groups.first) == [0, 1, 2, 3, 4]
    assert list(groups.of_cycle) == [-1, 0, 1, 2, 3, 4]
    assert not groups.is_break_in.any()


def test_last_group_takes_the_remainder():
    groups = CycleGroups.of(11, 0, 3)
    assert list(groups.first) == [0, 3, 6]
    assert np.bincount(groups.of_cycle[1:]).tolist() == [3, 3, 5]


def test_break_in_cycles_share_no_group_with_the_others():
    groups = CycleGroups.of(10, 4, 3)
    assert list(groups.first) == [0, 3, 4, 7]
    assert list(groups.is_break_in) == [True, True, False, False]


def test_fewer_cycles_than_a_group_wants_are_one_group():
    groups = CycleGroups.of(3, 1, 8)
    assert list(groups.first) == [0, 1]


def test_blocks_follow_each_other_and_hold_whole_groups(triangle):
    _, cycles = triangle(n_cycles=2000, per_cycle=100)
    groups = CycleGroups.of(2000, 0, 3)
    blocks = list(groups.blocks(cycles, 50))
    assert len(blocks) > 1
    assert blocks[0][0] == 0
    assert blocks[-1][1] == groups.first.size
    assert all(one[1] == other[0] for one, other in pairwise(blocks))
    for start, stop, samples in blocks:
        of_group = groups.of_cycle[cycles.cycle_number]
        inside = np.flatnonzero((of_group >= start) & (of_group < stop))
        assert samples.start <= inside[0]
        assert samples.stop > inside[-1]


def test_long_test_keeps_first_last_and_spaced_cycles():
    numbers = select_cycles(3000, longest=24)
    assert len(numbers) <= 24
    assert list(numbers[:3]) == [1, 2, 3]
    assert list(numbers[-3:]) == [2998, 2999, 3000]
    assert np.max(numbers[4:-3] / numbers[3:-4]) < 1.7


@pytest.mark.parametrize("n_cycles", [1, 24])
def test_short_test_keeps_every_cycle(n_cycles):
    assert list(select_cycles(n_cycles, longest=24)) == list(range(1, n_cycles + 1))


def test_selection_from_no_cycle_is_refused():
    with pytest.raises(DataError, match="no cycle to select; found 0"):
        select_cycles(0, longest=24)


# running statistics: blocks merge to what numpy says of the whole


def test_blocks_merge_to_the_statistics_of_the_whole():
    rng = np.random.default_rng(6)
    values = 1e4 + rng.normal(0, 1, (40, 2, 5))
    values[rng.random(values.shape) < 0.2] = np.nan
    parts = [
        RunningStatistics.of(block, np.ones_like(block), weight=np.ones(len(block)))
        for block in (values[:7], values[7:8], values[8:])
    ]
    merged = parts[0] + parts[1] + parts[2]
    assert merged.value() == pytest.approx(np.nanmean(values, axis=0), rel=1e-14)
    assert merged.scatter() == pytest.approx(np.nanstd(values, axis=0, ddof=1), rel=1e-9)
    assert merged.lowest() == pytest.approx(np.nanmin(values, axis=0))
    assert merged.highest() == pytest.approx(np.nanmax(values, axis=0))
    assert (merged.count == np.isfinite(values).sum(axis=0)).all()


def test_one_curve_keeps_the_uncertainty_it_came_with():
    one = RunningStatistics.of(np.array([[3.0]]), np.array([[4.0]]), weight=np.ones(1))
    assert one.standard_uncertainty() == 2.0
    assert np.isnan(one.scatter())


def test_nothing_seen_is_nan():
    none = RunningStatistics.of(np.full((3, 2), np.nan), np.ones((3, 2)), weight=np.ones(3))
    for value in (none.value(), none.lowest(), none.highest(), none.standard_uncertainty()):
        assert np.isnan(value).all()


def test_curve_of_pooled_cycles_counts_them_all():
    pooled = RunningStatistics.of(np.ones((2, 1)), np.ones((2, 1)), weight=np.array([5.0, 7.0]))
    assert pooled.count == 12
    assert pooled.n_curves == 2


def test_bends_of_blocks_are_those_of_the_whole():
    rng = np.random.default_rng(7)
    values = np.cumsum(rng.normal(0, 1, (12, 2, 3)), axis=0) + 0.01 * rng.normal(0, 1, (12, 2, 3))
    values[5, 0, 0] = np.nan
    whole = RunningStatistics.of(values, 0 * values, weight=np.ones(12))
    parts = [
        RunningStatistics.of(block, 0 * block, weight=np.ones(len(block)))
        for block in (values[:1], values[1:4], values[4:5], values[5:7], values[7:])
    ]
    merged = parts[0] + parts[1] + (parts[2] + parts[3]) + parts[4]
    for name in ("bends", "n_bends", "head", "tail"):
        assert getattr(merged, name) == pytest.approx(getattr(whole, name), nan_ok=True)
    assert merged.standard_uncertainty() == pytest.approx(whole.standard_uncertainty())


@pytest.mark.parametrize("cycles", [10, 50])
@pytest.mark.parametrize(
    "course",
    [
        lambda n: -0.12 * (1 - np.exp(-n / 3)),  # softens within some cycles
        lambda n: (1 + n) ** -0.05,  # by a power of their number
        lambda n: 0.1 * (1 - np.exp(-n / n[-1])),  # warms up and stiffens
        lambda n: 0 * n,
    ],
)
def test_a_mean_over_cycles_that_soften_is_as_well_known_as_they_are(course, cycles):
    rng = np.random.default_rng(3)
    level = 500 * (1 + course(np.arange(cycles)))
    values = level[:, None] + 0.5 * rng.normal(size=(cycles, 2000))
    found = RunningStatistics.of(values, np.full_like(values, 0.25), weight=np.ones(cycles))
    off = (found.value() - level.mean()) / found.standard_uncertainty()
    # the scatter about the mean is up to 48 times the noise; the first steps of a decay stay in
    assert 0.25 < np.sqrt(np.mean(off**2)) < 1.25
    assert np.mean(np.abs(off) < stdtrit(cycles - 1, 0.975)) > 0.94


@pytest.mark.parametrize("place", [0, 4, 9])
def test_one_cycle_that_is_unlike_the_others_is_no_trend(place):
    values = np.full(10, 100.0)
    values[place] = 90.0
    found = RunningStatistics.of(values, np.zeros(10), weight=np.ones(10))
    # the mean is off that of the others by 1
    assert 1.96 * found.standard_uncertainty() > 1.0


# sums by cell, against numpy's own count of bins


def test_sums_are_those_of_bincount_to_the_last_bit() -> None:
    rng = np.random.default_rng(5)
    cell, values = rng.integers(0, 300, 20_000), rng.normal(0, 1e3, 20_000)
    expected = np.bincount(cell, weights=values, minlength=301)
    assert np.array_equal(sums_by_cell(cell, 301) @ values, expected)


def test_no_samples_leave_every_cell_empty() -> None:
    empty = np.empty(0, dtype=np.int64)
    assert np.array_equal(sums_by_cell(empty, 4) @ np.empty(0), np.zeros(4))


def test_more_cells_than_32_bits_count_are_refused() -> None:
    with pytest.raises(ValueError, match="too many for one block"):
        sums_by_cell(np.zeros(1, dtype=np.int64), 1 << 31)


# curves between their bins


def test_curve_is_not_carried_over_a_gap_or_its_ends():
    x = np.arange(8.0)
    curve = np.where((x == 3) | (x == 4), np.nan, 10 * x)
    at = curve_at([-0.5, 0.0, 1.5, 2.5, 3.5, 5.0, 6.5, 7.1], x, curve, spacing=1.0)
    assert at == pytest.approx([np.nan, 0, 15, np.nan, np.nan, 50, 65, np.nan], nan_ok=True)
    assert np.isnan(curve_at([1.0], x, np.full(8, np.nan), spacing=1.0)).all()


def test_grids_that_differ_by_rounding_are_the_same():
    x = 0.1 * np.arange(1, 9)
    at = curve_at(x * (1 + 1e-15), x, np.arange(8.0), spacing=0.1)
    assert np.isfinite(at).all()


def test_curves_that_soften_are_put_on_the_mean_curve_in_proportion():
    """Each curve 1 % softer than the one before, and a modulus that steps: no residual beside it."""
    n_curves, n_each = 12, 40
    places = (np.arange(n_each) + np.mod(0.37 * np.arange(n_curves)[:, None], 1)) / n_each
    strain = (1 + 0.5 * places).ravel()
    curve = np.repeat(np.arange(n_curves), n_each)
    share = 1 - 0.01 * curve
    tension = share * (200 + 1000 * strain - 200 * np.maximum(strain - 1.25, 0))
    grid = StrainGrid(low=1.0, width=0.02, n_bins=25, half_window=2)
    fits = pooled_fits(strain, tension, grid=grid, curve=curve, n_curves=n_curves)
    beside = np.isfinite(fits.slope[0]) & (np.abs(grid.centres - 1.25) > 0.06)
    expected = np.where(grid.centres < 1.25, 1000, 800) * share.mean()
    assert fits.slope[0, beside] == pytest.approx(expected[beside], rel=1e-3)
    assert np.sqrt(fits.slope_variance[0, beside]).max() < 2.0


@pytest.mark.parametrize("n_left", [0, 3])
def test_a_curve_that_a_gap_has_emptied_is_not_put_on_the_range_of_those_that_soften(n_left):
    """Each curve 1 % softer than the one before; one has lost all, or all but three readings."""
    n_curves, n_each = 12, 40
    places = (np.arange(n_each) + np.mod(0.37 * np.arange(n_curves)[:, None], 1)) / n_each
    places[5] = 0.5 + 0.01 * places[5]
    curve = np.repeat(np.arange(n_curves), n_each)
    strain, share = (1 + 0.5 * places).ravel(), 1 - 0.01 * curve
    tension = share * (200 + 1000 * strain)
    curve[(curve == 5) & (np.arange(curve.size) % n_each >= n_left)] = -1
    grid = StrainGrid(low=1.0, width=0.02, n_bins=25, half_window=2)
    fits = pooled_fits(strain, tension, grid=grid, curve=curve, n_curves=n_curves)
    known = np.isfinite(fits.slope[0])
    assert known.sum() > 20
    assert fits.slope[0, known] == pytest.approx(1000 * share[curve >= 0].mean(), rel=2e-3)
    assert np.sqrt(fits.slope_variance[0, known]).max() < 2.0
