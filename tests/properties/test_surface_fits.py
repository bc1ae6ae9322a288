"""Laws of response surfaces: what a change of units, of order or of scale may not change."""

import numpy as np
from examples import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from reduction.experiments.designs import box_behnken
from reduction.experiments.response_surfaces import fit_surfaces

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
