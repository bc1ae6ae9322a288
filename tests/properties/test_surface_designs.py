"""Laws of run sheets, screening and stiffness forms, over levels nobody chose."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from reduction.experiments.designs import (
    FactorLevels,
    box_behnken,
    coded_from_engineering,
    engineering_levels,
    plackett_burman,
)
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
