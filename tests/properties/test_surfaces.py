"""Laws of designs and fitted surfaces."""

import numpy as np
from examples import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from reduction.experiments.designs import (
    FactorLevels,
    box_behnken,
    coded_from_engineering,
    engineering_levels,
    plackett_burman,
)
from reduction.experiments.response_surfaces import fit_surfaces
from reduction.experiments.run_sheet import find_cautions, make_run_sheet
from reduction.experiments.screening import screening_effects

SHARES = st.tuples(st.floats(0.01, 0.45), st.floats(0.02, 0.5)).map(lambda p: (p[0], p[0] + p[1]))
STRENGTH = st.floats(1e2, 1e7)


def factors(mean, amplitude, basis):
    return (
        FactorLevels("frequency", 0.1, 0.5),
        FactorLevels("mean_tension", *mean, "rated_break_strength"),
        FactorLevels("tension_amplitude", *amplitude, basis),
    )


@given(SHARES, SHARES, STRENGTH, st.sampled_from(["together", "spread"]))
def test_a_sheet_is_the_design_and_its_loads_rise(mean, amplitude, strength, repeats):
    levels = factors(mean, amplitude, "rated_break_strength")
    design = box_behnken(3)
    sheet = make_run_sheet(design, levels, rated_break_strength=strength, repeats=repeats)
    assert sorted(sheet.run) == list(range(1, 16))
    np.testing.assert_array_equal(sheet.coded, design.coded[sheet.run - 1])
    first = np.unique(sheet.coded, axis=0, return_index=True)[1]
    rise = np.diff(sheet.peak_tension[np.sort(first)])
    assert np.all(rise >= -1e-8 * sheet.peak_tension.max())
    slack = {run for c in find_cautions(sheet) if c.kind == "slack" for run in c.runs}
    below = set(sheet.run[sheet.minimum_tension < -1e-8 * strength].tolist())
    clear = set(sheet.run[sheet.minimum_tension > 1e-8 * strength].tolist())
    assert below <= slack and not clear & slack


@given(SHARES, st.tuples(st.floats(0.05, 0.4), st.floats(0.45, 0.99)), STRENGTH)
def test_a_fraction_of_the_mean_is_never_slack(mean, amplitude, strength):
    sheet = make_run_sheet(
        box_behnken(3), factors(mean, amplitude, "mean_tension"), rated_break_strength=strength
    )
    assert not any(caution.kind == "slack" for caution in find_cautions(sheet))
    assert np.all(sheet.minimum_tension > 0)


@given(SHARES, SHARES, STRENGTH, st.integers(3, 7))
def test_levels_and_coding_are_inverse(mean, amplitude, strength, n_factors):
    rest = tuple(FactorLevels(f"factor {i}", float(i), float(i + 2)) for i in range(n_factors - 3))
    levels = factors(mean, amplitude, "rated_break_strength") + rest
    coded = box_behnken(n_factors).coded
    scale = np.array([strength if level.basis != "absolute" else 1.0 for level in levels])
    back = coded_from_engineering(
        engineering_levels(coded, levels, rated_break_strength=strength),
        low=scale * [level.low for level in levels],
        high=scale * [level.high for level in levels],
    )
    np.testing.assert_allclose(back, coded, atol=1e-9)


@given(
    st.lists(st.floats(-100, 100), min_size=12, max_size=12),
    st.floats(-50, 50),
    st.floats(0.01, 100),
    st.integers(1, 11),
)
def test_effects_do_not_see_a_shift_and_scale_with_the_unit(response, shift, scale, n_factors):
    design = plackett_burman(n_factors, n_runs=12)
    one = screening_effects(design, response)
    other = screening_effects(design, scale * (np.array(response) + shift))
    np.testing.assert_allclose(other.effect, scale * one.effect, atol=1e-9 * scale)
    np.testing.assert_allclose(
        other.effect_standard_error, scale * one.effect_standard_error, atol=1e-9 * scale
    )


@given(st.lists(st.floats(-100, 100), min_size=12, max_size=12))
def test_effects_carry_the_whole_sum_of_squares(response):
    # eleven orthogonal columns: sum of (y - mean)^2 is 3 times the sum of squared effects
    found = screening_effects(plackett_burman(5), response)
    total = np.sum((np.array(response) - np.mean(response)) ** 2)
    carried = 3 * (np.sum(found.effect**2) + np.sum(found.dummy_effect**2))
    np.testing.assert_allclose(carried, total, rtol=1e-9, atol=1e-9)


# laws of response surfaces: what a change of units, of order or of scale may not change

RUNS = box_behnken(3).coded
NAMES = ["frequency", "mean_tension", "tension_amplitude"]
SEEDS = st.integers(0, 2**32 - 1)


def fit(runs, values, low=(-1, -1, -1), high=(1, 1, 1), units="coded", names=NAMES):
    return fit_surfaces(
        runs,
        values[None],
        factor_names=names,
        response_names=["y"],
        low=low,
        high=high,
        units=units,
    )


def drawn(seed):
    rng = np.random.default_rng(seed)
    runs = RUNS + rng.uniform(-0.1, 0.1, RUNS.shape)
    return rng, runs, rng.normal(10, 2, 15)


@settings(max_examples=examples(40), deadline=None)
@given(seed=SEEDS, shift=st.floats(-1e3, 1e3), scale=st.floats(1e-4, 1e6))
def test_a_change_of_units_of_the_response_scales_the_surface(seed, shift, scale):
    _, runs, values = drawn(seed)
    one, other = fit(runs, values), fit(runs, shift * scale + scale * values)
    np.testing.assert_allclose(
        other.coefficient[:, 1:], scale * one.coefficient[:, 1:], rtol=1e-6, atol=1e-7 * scale
    )
    np.testing.assert_allclose(other.t[:, 1:], one.t[:, 1:], rtol=1e-6, atol=1e-7)
    np.testing.assert_allclose(other.r2, one.r2, rtol=1e-8)
    np.testing.assert_allclose(
        other.canonical.stationary_point, one.canonical.stationary_point, rtol=1e-4, atol=1e-5
    )


@settings(max_examples=examples(40), deadline=None)
@given(seed=SEEDS)
def test_a_change_of_units_of_the_factors_changes_the_engineering_equation_alone(seed):
    rng, runs, values = drawn(seed)
    low = rng.uniform(-3, 3, 3)
    high = low + rng.uniform(0.1, 50, 3)
    in_units = fit((low + high) / 2 + runs * (high - low) / 2, values, low, high, "engineering")
    coded = fit(runs, values)
    np.testing.assert_allclose(in_units.coefficient, coded.coefficient, rtol=1e-7, atol=1e-7)
    np.testing.assert_allclose(in_units.p_value, coded.p_value, rtol=1e-6, atol=1e-9)


@settings(max_examples=examples(40), deadline=None)
@given(seed=SEEDS)
def test_the_order_of_the_runs_does_not_count(seed):
    rng, runs, values = drawn(seed)
    order = rng.permutation(15)
    one, other = fit(runs, values), fit(runs[order], values[order])
    np.testing.assert_allclose(other.coefficient, one.coefficient, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(other.residual[:, :], one.residual[:, order], atol=1e-9)
    np.testing.assert_allclose(other.lack_of_fit.f, one.lack_of_fit.f, rtol=1e-8)
    np.testing.assert_allclose(other.predicted_r2, one.predicted_r2, rtol=1e-8)


@settings(max_examples=examples(40), deadline=None)
@given(seed=SEEDS)
def test_the_order_of_the_factors_does_not_count(seed):
    rng, runs, values = drawn(seed)
    order = rng.permutation(3)
    one = fit(runs, values)
    other = fit(runs[:, order], values, names=[NAMES[index] for index in order])
    by_name = dict(zip(map(key, other.term_names), other.coefficient[0], strict=True))
    for name, value in zip(one.term_names, one.coefficient[0], strict=True):
        np.testing.assert_allclose(by_name[key(name)], value, rtol=1e-8, atol=1e-9)
    np.testing.assert_allclose(
        other.canonical.eigenvalue, one.canonical.eigenvalue, rtol=1e-7, atol=1e-8
    )


def key(name):
    return "*".join(sorted(name.split("*")))


@settings(max_examples=examples(40), deadline=None)
@given(seed=SEEDS)
def test_sums_of_squares_add_up_and_r2_is_the_kindest_of_the_three(seed):
    _, runs, values = drawn(seed)
    found = fit(runs, values)
    sums = dict(zip(found.anova.source, found.anova.sum_of_squares[0], strict=True))
    parts = sum(sums[name] for name in ("first order", "interactions", "squares", "residuals"))
    np.testing.assert_allclose(parts, sums["total"], rtol=1e-10)
    np.testing.assert_allclose(
        sums["lack of fit"] + sums["pure error"], sums["residuals"], rtol=1e-9
    )
    assert max(found.predicted_r2[0], found.adjusted_r2[0]) <= found.r2[0]
    np.testing.assert_allclose(found.diagnostics.leverage.sum(), 10, rtol=1e-10)
