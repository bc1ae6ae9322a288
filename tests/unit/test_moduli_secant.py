"""Secant and chord modulus."""

import dataclasses
from dataclasses import fields, replace

import numpy as np
import pytest
from refusals import refusals

from reduction.record.errors import DataError
from reduction.record.settings import CycleSettings, PhaseSettings
from reduction.stages.cycles.cycle_product import Loops, turns_alike
from reduction.stages.cycles.cycle_search import find_cycles
from reduction.stages.cycles.loops import close_loops
from reduction.stages.moduli.modulus_product import ModulusCurves
from reduction.stages.moduli.secant_modulus import (
    _change_of_ends,
    _secant_modulus,
    chord_modulus,
    compare_curves,
    compare_cycles,
    end_moduli,
    fit_peak_trend,
    late_change,
    slip_of_turns,
    slope_per_decade,
    summarise_amplitude,
)
from reduction.stages.standstills import find_standstills


def test_secant_of_a_straight_line_is_its_slope():
    strain = np.array([0.5, 1.0, 2.0])
    assert _secant_modulus(strain, 300 * strain, area=5e-4) == pytest.approx(6e5)


def test_secant_at_zero_or_negative_strain_is_nan():
    assert np.isnan(_secant_modulus([0.0, -0.1, np.nan], [1.0, 1.0, 1.0], area=1.0)).all()


def test_chord_does_not_ask_which_point_comes_first():
    one = chord_modulus(1.0, 2.0, 100.0, 300.0, area=1e-3)
    assert one == chord_modulus(2.0, 1.0, 300.0, 100.0, area=1e-3) == pytest.approx(2e5)


@pytest.mark.parametrize("area", [0.0, -1.0])
def test_area_that_is_not_positive_is_refused(area):
    with pytest.raises(DataError, match="area are not positive"):
        _secant_modulus(1.0, 1.0, area=area)
    with pytest.raises(DataError, match="area are not positive"):
        chord_modulus(0.0, 1.0, 0.0, 1.0, area=area)


# amplitude summary: means over the cycles after break-in, with type A uncertainty

AREA = np.array([5e-4, 4e-4])


def loops_of(values, uncertainty=None):
    fields = {name: values.copy() for name in Loops.__dataclass_fields__ if name != "uncertainty"}
    fields |= dict.fromkeys(
        ("tension_turn_missed", "strain_turn_missed", "energy_turn_missed"), 0 * values
    )
    return Loops(**fields, uncertainty=uncertainty or {})


def test_mean_and_uncertainty_are_those_of_the_cycles_after_break_in():
    rng = np.random.default_rng(15)
    values = 100 + rng.standard_normal((2, 9))
    values[1, 4] = np.nan
    summary = summarise_amplitude(loops_of(values), area=AREA, break_in_cycles=2)
    for row in range(2):
        kept = values[row, 2:][np.isfinite(values[row, 2:])]
        assert summary.loss_factor[row] == pytest.approx(kept.mean())
        assert summary.uncertainty["loss_factor"][row] == pytest.approx(
            kept.std(ddof=1) / np.sqrt(kept.size)
        )
        assert summary.dynamic_modulus[row] == pytest.approx(kept.mean() / AREA[row])
        assert summary.uncertainty["dynamic_modulus"][row] == pytest.approx(
            summary.uncertainty["loss_factor"][row] / AREA[row]
        )


def test_one_cycle_keeps_its_own_uncertainty():
    one = np.full((2, 1), 7.0)
    summary = summarise_amplitude(loops_of(one, {"frequency": one / 10}), area=AREA)
    assert summary.uncertainty["frequency"] == pytest.approx([0.7, 0.7])
    assert np.isnan(summary.uncertainty["loss_factor"]).all()


def test_specimen_without_cycles_is_nan():
    values = np.array([[1.0, 2.0], [np.nan, np.nan]])
    summary = summarise_amplitude(loops_of(values), area=AREA)
    assert summary.frequency[0] == pytest.approx(2 / (1 / 1.0 + 1 / 2.0))  # cycles over their time
    assert np.isnan(summary.frequency[1])


@pytest.mark.parametrize("lag", [0.1, 0.2, 0.4])
def test_a_corner_that_both_channels_miss_is_not_in_the_spring_constant(lag):
    """Corners anywhere between two readings, tension logged late by a lag drawn for each test."""
    rng = np.random.default_rng(22)
    place = rng.random(200_000)
    width = 0.02  # a corner half way between two readings, over the amplitude

    def missed(at):
        return 2 * width * np.abs((at + 0.5) % 1 - 0.5)

    error = missed(place + rng.normal(0, lag, place.size)) - missed(place)
    values = np.full((1, 2), 100.0)
    turns = dict.fromkeys(("tension_turn_missed", "strain_turn_missed"), width * values)
    loops = replace(loops_of(values), **turns)
    summary = summarise_amplitude(loops, area=[1e-4], turns_alike=turns_alike(np.array([lag]), 1.0))
    assert summary.uncertainty["apparent_spring_constant"] == pytest.approx(
        [100 * error.std()], rel=0.01
    )
    # of a lag that is not stated nothing is alike, and the amplitudes have it whatever the lag is
    apart = summarise_amplitude(loops, area=[1e-4])
    assert apart.uncertainty["apparent_spring_constant"] == pytest.approx([100 * width / 2])
    for name in ("tension_amplitude", "strain_amplitude"):
        assert summary.uncertainty[name] == apart.uncertainty[name]


@pytest.mark.parametrize("readings", [50.0, 50.05, 50.3])
def test_corners_at_many_places_between_readings_miss_alike_in_both_channels(readings):
    """Of ten cycles, tension logged late by half an interval, as a standard deviation."""
    rng = np.random.default_rng(23)
    place = rng.random((50_000, 1)) + readings * np.arange(10)
    late = rng.normal(0, 0.5, (50_000, 1))
    both = [2 * np.abs((at + 0.5) % 1 - 0.5).mean(axis=1) for at in (place + late, place)]
    alike = turns_alike(np.array([0.5]), 1.0, period=readings, n_cycles=10)
    assert np.sqrt((1 - alike) / 4) == pytest.approx([(both[0] - both[1]).std()], rel=0.02)


def test_only_as_much_is_alike_as_both_channels_miss():
    values = np.full((1, 2), 100.0)
    loops = replace(loops_of(values), tension_turn_missed=3 * values, strain_turn_missed=values)
    summary = summarise_amplitude(loops, area=[1e-4], turns_alike=np.array([1.0]))
    # 3 and 1 of the amplitude: 9 + 1 - 2
    assert summary.uncertainty["apparent_spring_constant"] == pytest.approx([100.0])


def test_readings_of_the_slope_of_the_loop_spread_with_the_loss_angle():
    # at 13 degrees 1/cos - cos = 0.0519; its slope on tan by a difference
    tangent = np.tan(np.radians(13.0))
    fields = {name: np.full((2, 3), 50.0) for name in Loops.__dataclass_fields__}
    fields["loss_factor"] = np.array([[tangent - 1e-3, tangent, tangent + 1e-3], [-0.1] * 3])
    summary = summarise_amplitude(Loops(**{**fields, "uncertainty": {}}), area=AREA)
    assert summary.slope_reading_spread[0] == pytest.approx(0.0519, abs=5e-5)

    def spread(angle):
        return 1 / np.cos(angle) - np.cos(angle)

    step = 1e-6
    slope = (spread(np.arctan(tangent + step)) - spread(np.arctan(tangent - step))) / (2 * step)
    expected = slope * summary.uncertainty["loss_factor"][0]
    assert summary.uncertainty["slope_reading_spread"][0] == pytest.approx(expected, rel=1e-4)
    # tension behind strain: no ellipse to read slopes from
    assert np.isnan(summary.slope_reading_spread[1])


def test_a_test_that_softens_has_the_mean_of_its_cycles_and_no_trend_in_its_interval():
    """Stiffness that falls by a tenth; each cycle is known to a thousandth."""
    cycle = np.arange(20.0)
    values = 1000 * (0.9 + 0.1 * np.exp(-cycle / 4))[None]
    own = {"apparent_spring_constant": np.full((1, 20), 1.0)}
    summary = summarise_amplitude(loops_of(values, own), area=[5e-4])
    assert summary.apparent_spring_constant[0] == pytest.approx(values.mean())
    # by the sum of the geometric series the last half lies 9.1 below the mean
    assert late_change(values[0]) == pytest.approx(
        5 * np.exp(-0.25 * 10) * (1 - np.exp(-2.5)) / (1 - np.exp(-0.25)) * 2
        - 5 * (1 - np.exp(-5)) / (1 - np.exp(-0.25))
    )
    # a thousandth over the root of twenty, and what the first steps bend by
    assert 0.22 < summary.uncertainty["apparent_spring_constant"][0] < 1.0


# comparisons: ratio and interval, grids that differ, cycles

NAMES = {"numerator_name": "new", "denominator_name": "used"}
FIRST = {"numerator_specimen": 0, "denominator_specimen": 0}


def curves_of(x, modulus, *, relative=0.01, count=10, **fields):
    modulus = np.broadcast_to(np.asarray(modulus, dtype=float), (1, 2, x.size)).copy()
    width = x[1] - x[0]
    blank = dict.fromkeys(ModulusCurves.__dataclass_fields__, np.zeros_like(modulus))
    return ModulusCurves(
        **blank
        | {
            "strain_bin": x,
            "strain_bin_bounds": np.column_stack([x - width / 2, x + width / 2]),
            "tangent_modulus": modulus,
            "tangent_modulus_standard_uncertainty": relative * modulus,
            "tangent_modulus_count": np.full(modulus.shape, count),
        }
        | fields
    )


FINE, COARSE = 0.105 + 0.01 * np.arange(40), 0.11 + 0.02 * np.arange(20)


def test_ratio_stands_on_the_coarser_grid():
    fine, coarse = curves_of(FINE, 2e6 * (1 + FINE)), curves_of(COARSE, 1e6 * (1 + COARSE))
    ratio = compare_curves(fine, coarse, **FIRST, **NAMES)
    assert ratio.strain_bin == pytest.approx(COARSE)
    assert ratio.ratio == pytest.approx(np.full((2, 20), 2.0))
    assert (ratio.numerator, ratio.denominator) == ("new", "used")
    inverse = compare_curves(coarse, fine, **FIRST, **NAMES)
    assert inverse.ratio == pytest.approx(1 / ratio.ratio)


def test_interval_holds_the_ratio_as_often_as_it_says():
    rng = np.random.default_rng(14)
    sides = []
    for level in (1.2e6, 1.0e6):
        cycles = level * (1 + 0.02 * rng.standard_normal((6, 2, 4000)))
        uncertainty = cycles.std(axis=0, ddof=1) / np.sqrt(6)
        x = 0.01 * np.arange(4000)
        sides.append(
            curves_of(
                x, cycles.mean(axis=0)[None], count=6,
                tangent_modulus_standard_uncertainty=uncertainty[None],
            )
        )  # fmt: skip
    ratio = compare_curves(*sides, **FIRST, **NAMES)
    covered = (ratio.ratio_low <= 1.2) & (ratio.ratio_high >= 1.2)
    assert covered.mean() == pytest.approx(0.95, abs=0.015)
    assert ratio.is_different.all()


def test_equal_curves_are_not_different():
    curves = curves_of(FINE, 1e6)
    ratio = compare_curves(curves, curves, **FIRST, **NAMES)
    assert not ratio.is_different.any()
    assert ratio.notes == ()


def test_curves_without_a_common_strain_give_a_note_and_no_ratio():
    ratio = compare_curves(curves_of(FINE, 1e6), curves_of(FINE + 5, 1e6), **FIRST, **NAMES)
    assert np.isnan(ratio.ratio).all()
    assert not ratio.is_different.any()
    assert "new and used have no common strain range" in tuple(map(str, ratio.notes))


def test_ratio_of_curves_without_scatter_has_no_interval():
    curves = curves_of(FINE, 1e6, relative=np.nan, count=1)
    ratio = compare_curves(curves, curves, **FIRST, **NAMES)
    assert ratio.ratio == pytest.approx(1)
    assert np.isnan(ratio.ratio_low).all()
    assert not ratio.is_different.any()


def by_cycle_curves():
    by_cycle = np.array([4.0, 3.0, 2.0, 2.0])[None, :, None, None] * np.full((1, 4, 2, 40), 1e6)
    return curves_of(
        FINE, 1e6, selected_cycle=np.array([1, 2, 2999, 3000]), tangent_modulus_by_cycle=by_cycle,
        tangent_modulus_by_cycle_standard_uncertainty=0.1 * by_cycle,
    )  # fmt: skip


def test_last_cycles_are_set_beside_the_first():
    ratio = compare_cycles(
        by_cycle_curves(), specimen=0, numerator_cycles=[2999, 3000], denominator_cycles=[1, 2]
    )
    assert ratio.ratio == pytest.approx(np.full((2, 40), 2 / 3.5))
    relative = np.hypot(0.1 / np.sqrt(2), 0.1 * np.hypot(4, 3) / 7)
    assert ratio.ratio_standard_uncertainty / ratio.ratio == pytest.approx(
        np.full((2, 40), relative)
    )
    assert ratio.ratio_high == pytest.approx(ratio.ratio * (1 + 1.959964 * relative))
    assert ratio.numerator == "cycles 2999, 3000"


@pytest.mark.parametrize("chosen", [[], [1, 500]])
def test_cycle_whose_curve_was_not_kept_is_refused(chosen):
    with pytest.raises(DataError, match="no curve of its own; found .*; needed cycles among 1, 2"):
        compare_cycles(
            by_cycle_curves(), specimen=0, numerator_cycles=chosen, denominator_cycles=[1]
        )


# secant and chord modulus of each cycle, with the noise that one or two readings carry


def law(strain):
    return 200 * strain + 30 * strain**3


def both(strain):
    return np.stack([strain, strain]), np.stack([law(strain), 2 * law(strain)])


def test_secant_is_stress_over_strain_at_the_peak_and_chord_the_slope_between_ends(triangle):
    strain, cycles = triangle(n_cycles=4, per_cycle=100)
    low, high = strain.min(), strain.max()
    found = end_moduli(*both(strain), area=AREA, cycles=cycles)
    factor = np.array([1, 2]) / AREA
    assert found.secant_modulus == pytest.approx(
        np.outer(factor, np.full(4, law(high) / high)), rel=1e-9
    )
    chord = (law(high) - law(low)) / (high - low)
    assert found.chord_modulus.shape == (2, 4, 2)
    assert found.chord_modulus[1] == pytest.approx(np.full((4, 2), factor[1] * chord), rel=1e-9)


def test_uncertainties_are_the_scatter_that_noise_of_both_channels_gives(triangle):
    strain, cycles = triangle(n_cycles=600, per_cycle=100)
    random = np.random.default_rng(3)
    tension = 300 * strain + random.normal(0, 1.5, strain.size)
    noisy = strain + random.normal(0, 0.002, strain.size)
    found = end_moduli(noisy[None], tension[None], area=AREA[:1], cycles=cycles)
    for name in ("secant_modulus", "chord_modulus"):
        values = getattr(found, name)[0]
        stated = getattr(found, f"{name}_standard_uncertainty")[0]
        assert values.std(axis=0) == pytest.approx(np.median(stated, axis=0), rel=0.1)


def test_a_missing_reading_or_a_branch_without_stroke_has_no_number(triangle):
    strain, cycles = triangle(n_cycles=3, per_cycle=50)
    strains, tensions = both(strain)
    tensions[0, cycles.branch_last[1, 0]] = np.nan
    still = cycles.branch_last.copy()
    still[2] = cycles.branch_first[2]
    found = end_moduli(
        strains, tensions, area=AREA, cycles=dataclasses.replace(cycles, branch_last=still)
    )
    assert np.isnan(found.secant_modulus).tolist() == [[False, True, False], [False] * 3]
    assert np.isnan(found.chord_modulus[0, 1]).all()
    assert np.isnan(found.chord_modulus[:, 2]).all()
    assert np.isfinite(found.chord_modulus[1, :2]).all()


def test_a_secant_from_no_strain_is_not_given(triangle):
    strain, cycles = triangle(n_cycles=2, per_cycle=50)
    found = end_moduli(strain[None] - strain.max(), law(strain)[None], area=AREA[:1], cycles=cycles)
    assert np.isnan(found.secant_modulus).all()
    assert np.isnan(found.secant_modulus_standard_uncertainty).all()
    assert np.isfinite(found.chord_modulus).all()


def test_an_area_that_is_not_positive_is_refused(triangle):
    strain, cycles = triangle(n_cycles=2, per_cycle=50)
    with pytest.raises(DataError, match="area"):
        end_moduli(*both(strain), area=[5e-4, 0.0], cycles=cycles)


# trends against the logarithm of cycle number


def loops_of_trend(values, spring=None):
    names = [item.name for item in fields(Loops) if item.name != "uncertainty"]
    loops = Loops(**{name: np.array(values) for name in names}, uncertainty={})
    return loops if spring is None else replace(loops, apparent_spring_constant=np.array(spring))


def test_a_logarithmic_decay_gives_its_slope_whatever_the_break_in():
    number = np.arange(1, 201)
    peak = (700 - 30 * np.log10(number))[None]
    for break_in in (0, 20):
        trend = fit_peak_trend(loops_of_trend(peak), area=[1.0], break_in_cycles=break_in)
        np.testing.assert_allclose(trend.peak_tension_per_decade, -30, rtol=1e-9)


def test_the_dynamic_modulus_is_spring_constant_over_area():
    number = np.arange(1, 51)
    spring = (400 + 5 * np.log10(number))[None]
    trend = fit_peak_trend(loops_of_trend(np.ones((1, 50)), spring), area=[5e-4])
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
    change = fit_peak_trend(loops_of_trend(peak), area=[1.0]).peak_tension_change
    assert change == pytest.approx(650 / 700 - 1)


def test_a_zero_that_moves_over_the_cycles_is_in_the_interval_of_the_trend():
    """Synthetic: 700 N lose 20 N per decade; the zero falls evenly by 4 N over 100 cycles."""
    number = np.arange(1.0, 101.0)
    still = 700 - 20 * np.log10(number)
    moving = still - 4 * (number - 1) / 99
    true = fit_peak_trend(loops_of_trend(still[None]), area=[1.0])
    found = fit_peak_trend(loops_of_trend(moving[None]), area=[1.0], of_zero=[4 / 3**0.5])
    for name in ("peak_tension_change", "peak_tension_per_decade"):
        off = abs(getattr(found, name) - getattr(true, name))
        spread = getattr(found, f"{name}_standard_uncertainty")
        assert 0.5 * spread < off < 1.96 * spread


def _trend_of_ramps(readings, n_cycles, *, start=0.0, slips=True):
    """Trend of a spring that does not change, logged ``readings`` times per cycle (synthetic)."""
    step = 0.1
    period = step * readings
    time = np.arange(0, n_cycles * period, step)
    strain = 0.2 + 0.1 * np.abs(2 * ((time + start * step) / period % 1) - 1)
    load = 1e4 * strain**2
    stands = find_standstills(time, strain, load[None], settings=PhaseSettings())
    cycles = find_cycles(time, strain, load[None], stands, settings=CycleSettings())
    loops = close_loops(time, load[None], strain[None], cycles, driven=strain)
    share = slip_of_turns(loops.frequency, step, cycles.n_cycles)
    return fit_peak_trend(loops, area=[1e-4], of_turns=share if slips else 0.0)


@pytest.mark.parametrize("readings", [29, 30])
def test_turns_that_slip_between_the_readings_are_in_the_interval_of_a_trend(readings):
    """Synthetic: a spring that does not change, whose turns pass half a reading in 45 cycles."""
    for slip in (0.5, 0.0):
        trend = _trend_of_ramps(readings + slip / 45, 45)
        for name in ("peak_tension_change", "mean_strain_drift", "mean_strain_per_decade"):
            value, spread = (float(getattr(trend, f"{name}{u}")[0]) for u in UNCERTAIN)
            assert abs(value) <= 2.5 * spread + 1e-9
            # a log in step with the machine misses the same of every turn
            assert slip or spread < 1e-4


@pytest.mark.parametrize("readings", [16.37, 23.31])
def test_turns_that_are_anywhere_between_the_readings_are_no_drift(readings):
    """Synthetic: the ends of 80 cycles far out of step miss as much of their turns as each other."""
    for start in np.arange(0, 1, 0.1):
        of_steps, trend = (
            _trend_of_ramps(readings, 80, start=start, slips=slips) for slips in (False, True)
        )
        for name in ("peak_tension_change", "mean_strain_drift"):
            value, spread = (float(getattr(trend, f"{name}{u}")[0]) for u in UNCERTAIN)
            assert abs(value) <= 2.5 * spread + 1e-9
            assert spread < 2 * float(getattr(of_steps, f"{name}{UNCERTAIN[1]}")[0])


UNCERTAIN = "", "_standard_uncertainty"


def test_change_is_last_over_first():
    peak = np.array([[100.0, 98, 97, 96, 95]])
    assert fit_peak_trend(loops_of_trend(peak), area=[1.0]).peak_tension_change == pytest.approx(
        -0.05
    )


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
    trend = fit_peak_trend(loops_of_trend(peak), area=[1.0], break_in_cycles=50)
    np.testing.assert_allclose(trend.peak_tension_per_decade, -30, rtol=1e-9)


def test_a_specimen_without_diameter_has_no_modulus():
    trend = fit_peak_trend(loops_of_trend(np.ones((1, 20))), area=[np.nan])
    assert np.isnan(trend.dynamic_modulus_per_decade).all()


REFUSED = {
    "chord of one strain is refused": (
        lambda: chord_modulus([1.0, 1.0], [2.0, 1.0], [0.0, 0.0], [1.0, 1.0], area=1.0),
        DataError,
        "chord needs two strains; found 1 of 2 pairs",
    ),
    "break in of every cycle is refused": (
        lambda: summarise_amplitude(loops_of(np.ones((2, 3))), area=AREA, break_in_cycles=3),
        DataError,
        "no cycle is left after break-in; found 3 cycles",
    ),
    "a negative area is refused": (
        lambda: fit_peak_trend(loops_of_trend(np.ones((1, 20))), area=[-1.0]),
        DataError,
        "area are not positive",
    ),
    "cycles count from one": (
        lambda: slope_per_decade([[1.0, 2.0, 3.0]], number=[0, 1, 2]),
        DataError,
        "cycles count from 1; found 0",
    ),
}


test_refusals = refusals(REFUSED)
