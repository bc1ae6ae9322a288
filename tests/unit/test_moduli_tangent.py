"""Tangent curves: known laws come back; trend, break-in, gaps, blocks and pooling do no harm."""

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest

from reduction.record.errors import DataError
from reduction.record.settings import ModulusSettings
from reduction.stages.cycles.cycle_product import Cycles
from reduction.stages.moduli import local_regression as groups
from reduction.stages.moduli import tangent_modulus as specimencurves
from reduction.stages.moduli.tangent_modulus import tangent_curves
from reduction.stages.moduli.tangent_window import choose_grid_and_window
from reduction.uncertainty.errors_of_curves import _window_blur

AREA = 5e-4
SETTINGS = ModulusSettings()


def law(strain):
    """Tension [N] of a stiffening tether; its slope is `law_slope`."""
    return 200 * strain + 60 * strain**3


def law_slope(strain):
    return 200 + 180 * strain**2


def curves_of(strain, tension, cycles, *, area=(AREA,), **keywords):
    return tangent_curves(
        np.atleast_2d(strain),
        np.atleast_2d(tension),
        area=area,
        cycles=cycles,
        **{"settings": SETTINGS} | keywords,
    )


def worst(curves, expected):
    """Largest relative difference of the mean curve from an expected slope [N]."""
    return np.nanmax(np.abs(curves.tangent_modulus[0] * AREA / expected - 1))


@pytest.mark.parametrize("per_cycle", [40, 100, 101, 400])
@pytest.mark.parametrize("begins", ["valley", "peak"])
def test_cubic_law_comes_back(triangle, per_cycle, begins):
    strain, cycles = triangle(per_cycle=per_cycle, begins=begins)
    curves = curves_of(strain, law(strain), cycles)
    # nowhere is more left than the blur W2 E'' / 40 of the window, which is taken off
    blur = 360 * curves.window**2 / 40 / law_slope(1.0)
    assert worst(curves, law_slope(curves.strain_bin)) < blur
    known = np.isfinite(curves.branch_tension[0])
    expected = np.broadcast_to(law(curves.strain_bin), known.shape)
    assert curves.branch_tension[0][known] == pytest.approx(expected[known], rel=1e-4)
    assert (curves.tangent_modulus_count[0, :, 26] == 10).all()


def slow_sine(per_cycle, n_cycles=30):
    """Strain 1 +- 0.25 of some readings a cycle, in step with the cycles or not, and its cycles."""
    turn = np.arange(int(per_cycle * n_cycles) + 1) / per_cycle
    strain = 1 - 0.25 * np.cos(2 * np.pi * turn)
    valley = np.round(np.arange(n_cycles + 1) * per_cycle).astype(int)
    valley[-1] = min(valley[-1], strain.size - 1)
    peak = np.round((np.arange(n_cycles) + 0.5) * per_cycle).astype(int)
    first = np.column_stack([valley[:-1], peak])
    branch = np.zeros(strain.size, np.int8)
    number = np.zeros(strain.size, np.int32)
    for cycle, (low, top, end) in enumerate(zip(valley[:-1], peak, valley[1:], strict=True)):
        branch[low:top], branch[top:end] = 1, 2
        number[low:end] = cycle + 1
    return strain, Cycles(
        valley[:-1], valley[1:], first, np.column_stack([peak, valley[1:]]),
        np.ones((n_cycles, 2)), number, branch, (branch > 0) & (np.abs(strain - 1) < 0.225), 0.1,
    )  # fmt: skip


@pytest.mark.parametrize("per_cycle", [12, 12.4, 13.37, 15.3, 17.4])
@pytest.mark.parametrize("power", [3, 5])
def test_a_slow_sine_has_the_modulus_of_its_law_or_says_what_its_window_misses(per_cycle, power):
    strain, cycles = slow_sine(per_cycle)
    noise = np.random.default_rng(2).normal(0, 0.3, strain.size)
    curves = curves_of(strain, 200 * strain + 60 * strain**power + noise, cycles)
    true = (200 + 60 * power * curves.strain_bin ** (power - 1)) / AREA
    spread = np.hypot(
        curves.tangent_modulus_standard_uncertainty, curves.tangent_modulus_window_uncertainty
    )
    away = np.abs(curves.tangent_modulus - true) / spread
    known = np.isfinite(away)
    assert known[0].any(axis=1).all()
    assert np.mean(away[known] > 2) < 0.1
    # in step with the cycles no more is read of a branch than six strains
    assert np.nanmedian(spread / true) < (0.5 if per_cycle == 12 else 0.15)


@pytest.mark.parametrize(("per_cycle", "bend", "least"), [(17.3, 0.4, 5e-3), (20.21, 0.25, 4e-3)])
def test_a_slow_log_out_of_step_has_the_slope_that_all_its_cycles_show(per_cycle, bend, least):
    """A curve that softens by e in ``bend``, on levels that fall: one cycle reads it unevenly."""
    strain, cycles = slow_sine(per_cycle)
    noise = np.random.default_rng(2).normal(0, 0.02, strain.size)
    tension = 300 * (1 - np.exp((0.7 - strain) / bend)) - 0.3 * cycles.cycle_number + noise
    curves = curves_of(strain, tension, cycles)
    true = 300 / bend * np.exp((0.7 - curves.strain_bin) / bend)
    error = curves.tangent_modulus * AREA / true - 1
    assert np.sqrt(np.nanmean(error**2)) < least


def test_branches_are_kept_apart(triangle):
    strain, cycles = triangle(per_cycle=200)
    down = cycles.branch == 2
    tension = np.where(down, 500 + 300 * (strain - 1.5), 500 + 200 * (strain - 1.5))
    curves = curves_of(strain, tension, cycles, settings=ModulusSettings(window=0.05))
    for branch, slope in ((0, 200), (1, 300)):
        modulus = curves.tangent_modulus[0, branch]
        assert modulus[np.isfinite(modulus)] * AREA == pytest.approx(slope)


def test_tension_lost_from_cycle_to_cycle_does_not_enter_a_slope(triangle):
    strain, cycles = triangle(n_cycles=12, per_cycle=20)  # so few samples that cycles are pooled
    tension = law(strain) - 0.2 * cycles.cycle_number
    curves = curves_of(strain, tension, cycles)
    assert any("pools 2 consecutive cycles (6 curves)" in line for line in curves.made)
    assert worst(curves, law_slope(curves.strain_bin)) < 0.02


def test_uncertainty_covers_the_truth_as_often_as_it_says(triangle):
    rng = np.random.default_rng(7)
    strain, cycles = triangle(n_cycles=10, per_cycle=100)
    specimens = 40
    strain = np.tile(strain, (specimens, 1))
    tension = law(strain) + rng.normal(0, 1.2, strain.shape)
    curves = curves_of(strain, tension, cycles, area=np.full(specimens, AREA))
    error = curves.tangent_modulus * AREA - law_slope(curves.strain_bin)
    ratio = error / (curves.tangent_modulus_standard_uncertainty * AREA)
    # Student's t of 9 degrees of freedom leaves 2.3 % beyond 2.76, and one half within 0.70
    assert np.nanmean(np.abs(ratio) < 0.703) == pytest.approx(0.5, abs=0.06)
    assert np.nanmean(np.abs(ratio) > 2.76) < 0.04


def test_uncertainty_of_one_cycle_is_that_of_its_regression(triangle):
    rng = np.random.default_rng(8)
    strain, cycles = triangle(n_cycles=1, per_cycle=100)
    strain = np.tile(strain, (200, 1))
    tension = law(strain) + rng.normal(0, 1.2, strain.shape)
    curves = curves_of(strain, tension, cycles, area=np.full(200, AREA))
    assert np.isnan(curves.tangent_modulus_scatter).all()
    known = np.isfinite(curves.tangent_modulus).all(axis=0)
    measured = curves.tangent_modulus.std(axis=0)[known]
    stated = np.sqrt((curves.tangent_modulus_standard_uncertainty**2).mean(axis=0))[known]
    # what narrower windows show beyond their noise may be a bend, and is stated; here it is chance
    assert 0.9 < np.median(stated / measured) < 1.15


def test_break_in_cycles_are_left_out_of_the_mean_and_kept_by_cycle(triangle):
    strain, cycles = triangle(n_cycles=6, per_cycle=200)
    stiffer = np.where(cycles.cycle_number <= 2, 3.0, 1.0)
    curves = curves_of(strain, stiffer * 200 * strain, cycles, break_in_cycles=2)
    known = np.isfinite(curves.tangent_modulus[0])
    assert curves.tangent_modulus[0][known] * AREA == pytest.approx(200)
    assert curves.tangent_modulus_maximum[0][known] * AREA == pytest.approx(200)
    assert (curves.tangent_modulus_count[0, :, known.shape[1] // 2] == 4).all()
    first = curves.tangent_modulus_by_cycle[0, 0]
    assert first[np.isfinite(first)] * AREA == pytest.approx(600)
    assert any("first 2 cycles" in note for note in map(str, curves.notes))


def test_envelope_and_scatter_are_those_of_the_cycles(triangle):
    strain, cycles = triangle(n_cycles=5, per_cycle=200)
    factor = np.array(
        [0.0, 100.0, 400.0, 200.0, 500.0, 300.0]
    )  # a jump at each valley, in the ends alone
    tension = factor[cycles.cycle_number] * strain
    curves = curves_of(strain, tension, cycles)
    middle = curves.tangent_modulus.shape[-1] // 2
    assert curves.tangent_modulus_minimum[0, :, middle] * AREA == pytest.approx(100)
    assert curves.tangent_modulus_maximum[0, :, middle] * AREA == pytest.approx(500)
    assert curves.tangent_modulus_scatter[0, :, middle] * AREA == pytest.approx(np.sqrt(25000))
    uncertainty = curves.tangent_modulus_standard_uncertainty[0, :, middle] * AREA
    assert uncertainty == pytest.approx(np.sqrt(25000 / 5), rel=0.3)
    assert curves.tangent_modulus_by_cycle[0, :, 0, middle] * AREA == pytest.approx(
        [100, 400, 200, 500, 300]
    )


def test_a_modulus_that_rises_from_cycle_to_cycle_is_no_scatter(triangle):
    strain, cycles = triangle(n_cycles=8, per_cycle=200)
    noise = 0.01 * np.random.default_rng(5).normal(size=strain.shape)
    curves = curves_of(strain, (200.0 + 5.0 * cycles.cycle_number) * strain + noise, cycles)
    middle = curves.tangent_modulus.shape[-1] // 2
    # eight cycles, 5 apart: s is 5 sqrt(6)
    assert curves.tangent_modulus_scatter[0, :, middle] * AREA == pytest.approx(12.2, rel=0.02)
    off = curves.tangent_modulus[0, :, middle] * AREA - 222.5
    uncertainty = curves.tangent_modulus_standard_uncertainty[0, :, middle] * AREA
    assert (np.abs(off) < 3 * uncertainty).all() and (uncertainty < 0.5).all()


def test_trimmed_ends_are_in_the_untrimmed_curve_alone(triangle):
    strain, cycles = triangle(per_cycle=400, trimmed=20)
    # the ends are twice as stiff, as after a reversal
    tension = np.interp(strain, [1.0, 1.05, 1.45, 1.5], [200.0, 220.0, 300.0, 320.0])
    curves = curves_of(strain, tension, cycles)
    trimmed, whole = curves.tangent_modulus[0], curves.tangent_modulus_untrimmed[0]
    assert trimmed[np.isfinite(trimmed)] * AREA == pytest.approx(200, rel=1e-6)
    assert np.nanmax(whole) * AREA == pytest.approx(400, rel=0.1)
    assert np.isfinite(whole).sum() > np.isfinite(trimmed).sum()


def test_what_a_window_over_the_end_of_a_branch_smears_is_carried(triangle):
    strain, cycles = triangle(per_cycle=400, trimmed=20)
    # six times as stiff within less than a window of either end
    knots = [1.0, 1.02, 1.48, 1.5]
    tension = np.interp(strain, knots, [200.0, 224.0, 316.0, 340.0])
    curves = curves_of(strain, tension, cycles)
    whole = curves.tangent_modulus_untrimmed[0] * AREA
    carried = _window_blur(curves, 0) * AREA
    truth = np.where(np.abs(curves.strain_bin - 1.25) < 0.23, 200.0, 1200.0)
    off = np.abs(whole - truth)
    assert np.nanmax(off) > 100
    known = np.isfinite(whole)
    assert np.mean((off < 2 * carried + 1)[known]) > 0.95
    assert (carried[:, np.abs(curves.strain_bin - 1.25) < 0.1] == 0).all()


def test_where_nothing_is_trimmed_both_curves_are_as_uncertain(triangle):
    strain, cycles = triangle(n_cycles=12, per_cycle=80, trimmed=4)
    noise = np.random.default_rng(11).normal(0, 0.5, strain.size)
    # beside the kink narrower windows are taken, which hold more noise
    kinked = np.interp(strain, [1.0, 1.25, 1.5], [200.0, 220.0, 320.0])
    curves = curves_of(strain, kinked + noise, cycles)
    trimmed, whole = (
        curves.tangent_modulus_standard_uncertainty[0],
        curves.tangent_modulus_untrimmed_standard_uncertainty[0],
    )
    same = curves.tangent_modulus[0] == curves.tangent_modulus_untrimmed[0]
    assert same.sum() > 10
    np.testing.assert_array_equal(trimmed[same], whole[same])


def test_test_without_a_constant_rate_still_has_an_untrimmed_curve(triangle):
    strain, cycles = triangle(per_cycle=200)
    never = dataclasses.replace(cycles, is_in_trimmed_branch=np.zeros(strain.size, dtype=bool))
    curves = curves_of(strain, law(strain), never)
    assert np.isnan(curves.tangent_modulus).all()
    ratio = curves.tangent_modulus_untrimmed[0] * AREA / law_slope(curves.strain_bin)
    assert np.nanmax(np.abs(ratio - 1)) < 0.002
    assert any("no tangent modulus" in note for note in map(str, curves.notes))


def test_missing_samples_leave_a_smaller_count_and_no_bias(triangle):
    strain, cycles = triangle(per_cycle=400)
    tension = law(strain)
    tension[330:370] = np.nan  # in the descending branch of the first cycle
    curves = curves_of(strain, tension, cycles)
    assert curves.tangent_modulus_count[0, 1].min(where=curves.tangent_modulus_count[0, 1] > 0,
                                                  initial=10) == 9  # fmt: skip
    assert worst(curves, law_slope(curves.strain_bin)) < 2e-4


def test_a_hole_in_one_cycle_moves_the_mean_curve_there_and_no_further():
    # levels beside each other and a jump of the one that has the hole, within it: by steps alone
    # the mean of the bins behind it would lie a twelfth of the jump too low
    values = np.tile(100.0 + np.arange(20.0), (12, 2, 1)) + np.arange(12.0)[:, None, None]
    values[0, :, 8:] += 60.0
    whole = values.mean(axis=0)
    values[0, :, 8] = np.nan
    means = specimencurves._CycleMeans.of(values, np.ones_like(values), weight=np.ones(12))
    found = means.value()
    assert np.delete(found, 8, axis=1) == pytest.approx(np.delete(whole, 8, axis=1))
    # between two bins that all reach the steps of the others are laid on both
    assert found[:, 8] == pytest.approx((whole[:, 7] + whole[:, 9]) / 2)
    # at an end the steps of the others go on
    values[0, :, 15:] = np.nan
    means = specimencurves._CycleMeans.of(values, np.ones_like(values), weight=np.ones(12))
    assert means.value()[:, 15:] == pytest.approx(whole[:, 15:])


def test_dead_specimen_is_nan_with_a_note_and_leaves_the_other_alone(triangle):
    strain, cycles = triangle()
    both = np.stack([law(strain), np.full_like(strain, np.nan)])
    curves = curves_of(np.stack([strain, strain]), both, cycles, area=(AREA, AREA))
    assert np.isnan(curves.tangent_modulus[1]).all()
    assert worst(curves, law_slope(curves.strain_bin)) < 1e-3
    assert any(
        "specimen 2 of the record has no tangent modulus" in n for n in map(str, curves.notes)
    )


def test_samples_off_the_grid_are_counted_in_a_note(triangle):
    strain, cycles = triangle()
    strain = strain.copy()
    strain[17] = 40.0
    curves = curves_of(strain, law(np.minimum(strain, 2)), cycles)
    assert any(note.startswith("1 samples lie outside") for note in map(str, curves.notes))


def test_size_of_a_block_changes_nothing(triangle, monkeypatch):
    rng = np.random.default_rng(9)
    strain, cycles = triangle(n_cycles=60, per_cycle=60)
    tension = law(strain) + rng.normal(0, 1, strain.shape)
    whole = curves_of(strain, tension, cycles)
    monkeypatch.setattr(groups, "_BLOCK_SAMPLES", 100)
    pieces = curves_of(strain, tension, cycles)
    for item in dataclasses.fields(whole):
        one, other = getattr(whole, item.name), getattr(pieces, item.name)
        if isinstance(one, np.ndarray):
            assert one == pytest.approx(other, rel=1e-9, nan_ok=True), item.name


def test_a_cycle_longer_than_a_part_is_summed_part_by_part(triangle, monkeypatch):
    strain, cycles = triangle(n_cycles=3, per_cycle=400)
    noisy = law(strain) + np.random.default_rng(8).normal(0, 0.5, strain.size)
    strain = np.where(np.arange(strain.size) == 100, np.nan, strain)
    whole = curves_of(strain, noisy, cycles)
    monkeypatch.setattr(specimencurves, "_PART", 37)
    parted = curves_of(strain, noisy, cycles)
    for name in ("tangent_modulus", "tangent_modulus_standard_uncertainty"):
        np.testing.assert_allclose(getattr(parted, name), getattr(whole, name), rtol=1e-9)
    np.testing.assert_array_equal(parted.tangent_modulus_count, whole.tangent_modulus_count)


def test_grid_of_the_whole_record_can_be_given(triangle):
    strain, cycles = triangle()
    grid = choose_grid_and_window(strain, cycles=cycles, settings=ModulusSettings(window=0.2))
    curves = curves_of(strain, law(strain), cycles, grid=grid)
    assert curves.window == pytest.approx(grid.window)


def test_long_test_keeps_the_curves_of_selected_cycles(triangle):
    strain, cycles = triangle(n_cycles=40, per_cycle=100)
    curves = curves_of(strain, law(strain), cycles)
    assert curves.tangent_modulus_by_cycle.shape[1] == curves.selected_cycle.size <= 24
    assert list(curves.selected_cycle[[0, -1]]) == [1, 40]


def test_break_in_of_every_cycle_is_refused(triangle):
    strain, cycles = triangle(n_cycles=3)
    with pytest.raises(DataError, match="no cycle is left after break-in; found 3 cycles, 3 of"):
        curves_of(strain, law(strain), cycles, break_in_cycles=3)


def test_the_tension_of_a_log_in_step_with_its_cycles_is_no_surer_than_its_windows():
    # ten readings a branch, the same in all cycles, of a hose whose cords pick up: no scatter
    strain, cycles = slow_sine(20)

    def hose(strain):
        return 2000 * strain + 30_000 * 0.04 * np.logaddexp(0, (strain - 1.05) / 0.04)

    curves = curves_of(strain, hose(strain), cycles)
    known = np.isfinite(curves.branch_tension[0])
    error = (curves.branch_tension[0] - hose(curves.strain_bin))[known]
    stated = curves.branch_tension_standard_uncertainty[0][known]
    assert np.abs(error).max() > 10
    assert np.sqrt(np.mean((error / stated) ** 2)) < 1.5


@pytest.mark.parametrize(("n_short", "is_told"), [(4, False), (5, True)])
def test_bins_that_few_cycles_reach_are_told_above_a_tenth_of_all(n_short, is_told):
    reached = np.arange(40) >= n_short
    trimmed = SimpleNamespace(
        is_reached=lambda: reached, level=SimpleNamespace(n_curves=np.ones(40, dtype=int))
    )
    found = specimencurves._notes(0, [SimpleNamespace(trimmed=trimmed, n_outside=0)])
    assert [one.code for one in found] == ["bins-of-some-cycles"] * is_told
