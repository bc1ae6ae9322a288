from itertools import combinations

import numpy as np
import pytest
import statsmodels.api as sm

from reduction.experiments.designs import box_behnken, model_matrix, quadratic_exponents
from reduction.experiments.response_surfaces import fit_surfaces
from reduction.experiments.term_selection import reduce_terms
from reduction.record.errors import SettingsError

RUNS = box_behnken(3).coded
MATRIX = model_matrix(RUNS, quadratic_exponents(3))


def surfaces(responses, runs=RUNS, **settings):
    n_factors = runs.shape[1]
    return fit_surfaces(
        runs,
        np.atleast_2d(responses),
        factor_names=[f"x{number}" for number in range(n_factors)],
        response_names=[f"y{number}" for number in range(len(np.atleast_2d(responses)))],
        low=[-1] * n_factors,
        high=[1] * n_factors,
        **settings,
    )


def criterion(fit, n_runs):
    """AICc with the variance among the parameters, less the constant of the normal density."""
    count = len(fit.params) + 1
    akaike = n_runs * np.log(fit.ssr / n_runs) + 2 * count
    return akaike + 2 * count * (count + 1) / (n_runs - count - 1)


def test_the_best_of_all_subsets_is_that_of_a_search_with_statsmodels():
    rng = np.random.default_rng(2)
    response = 5 + 2 * RUNS[:, 0] + 1.5 * RUNS[:, 1] * RUNS[:, 2] + rng.normal(0, 0.5, 15)
    best, kept = np.inf, ()
    for count in range(10):
        for chosen in combinations(range(1, 10), count):
            parents = {1: {4}, 2: {5}, 3: {6}, 7: {4, 5}, 8: {4, 6}, 9: {5, 6}}
            if any(not parents.get(term, set()) <= set(chosen) for term in chosen):
                continue
            value = criterion(sm.OLS(response, MATRIX[:, [0, *chosen]]).fit(), 15)
            if value < best:
                best, kept = value, (0, *chosen)
    found = reduce_terms(surfaces(response))
    assert np.flatnonzero(found.is_kept[0]).tolist() == sorted(kept)
    assert found.criterion[0] == pytest.approx(best, rel=1e-9)
    other = sm.OLS(response, MATRIX[:, sorted(kept)]).fit()
    inside = found.is_kept[0]
    np.testing.assert_allclose(found.coefficient[0, inside], other.params, rtol=1e-9)
    np.testing.assert_allclose(
        found.coefficient_standard_uncertainty[0, inside], other.bse, rtol=1e-9
    )
    np.testing.assert_allclose(found.p_value[0, inside], other.pvalues, rtol=1e-7)
    assert found.sigma[0] ** 2 == pytest.approx(other.scale, rel=1e-9)
    assert (found.coefficient[0, ~inside] == 0).all()


def test_the_full_surface_stays_what_it_was():
    full = surfaces(np.random.default_rng(3).normal(size=(2, 15)))
    before = full.coefficient.copy()
    reduced = reduce_terms(full)
    np.testing.assert_array_equal(full.coefficient, before)
    assert (reduced.criterion <= reduced.full_criterion).all()
    assert "too low" in str(reduced.notes[0])


def test_missing_runs_and_missing_surfaces_are_kept_apart():
    responses = np.random.default_rng(4).normal(size=(3, 15)) + 8 * RUNS[:, 1]
    responses[1, 14], responses[2, :8] = np.nan, np.nan
    found = reduce_terms(surfaces(responses))
    alone = reduce_terms(surfaces(responses[1, :14], RUNS[:14]))
    np.testing.assert_array_equal(found.is_kept[1], alone.is_kept[0])
    np.testing.assert_allclose(found.coefficient[1], alone.coefficient[0], rtol=1e-9, atol=1e-12)
    assert not found.is_kept[2].any() and np.isnan(found.coefficient[2]).all()


def test_fixed_blocks_stay_in_every_subset():
    rng = np.random.default_rng(5)
    runs, names = np.tile(RUNS, (2, 1)), ["A"] * 15 + ["B"] * 15
    response = 3 * runs[:, 0] + np.repeat([0, 50], 15) + rng.normal(0, 0.1, 30)
    found = reduce_terms(surfaces(response, runs, blocks=names))
    assert found.is_kept[0, 4] and found.sigma[0] < 0.2
    assert found.coefficient[0, 0] == pytest.approx(25, abs=0.2)


def test_random_blocks_are_refused():
    names = ["A"] * 15 + ["B"] * 15
    full = surfaces(
        np.random.default_rng(6).normal(size=30),
        np.tile(RUNS, (2, 1)),
        blocks=names,
        block_treatment="random",
    )
    with pytest.raises(SettingsError, match="terms cannot be chosen with random blocks"):
        reduce_terms(full)


def test_too_many_subsets_are_refused():
    runs = box_behnken(6).coded
    full = surfaces(np.random.default_rng(7).normal(size=len(runs)), runs)
    with pytest.raises(SettingsError, match="too many subsets of terms"):
        reduce_terms(full)
