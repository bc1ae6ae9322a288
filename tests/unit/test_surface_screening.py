"""Screening: effects, their error by dummies or Lenth, confounding."""

import numpy as np
import pytest
from scipy import stats

from reduction.experiments.designs import Design, plackett_burman
from reduction.experiments.screening import (
    _pseudo_standard_error,
    alias_matrix,
    screening_effects,
    screening_remarks,
)
from reduction.record.errors import DataError, SettingsError

FIVE = plackett_burman(5)
RNG = np.random.default_rng(11)


def made(effects, dummies, mean=10.0, design=FIVE):
    """Responses that have the given effects exactly."""
    columns = np.hstack([design.coded, design.dummy])
    return mean + columns @ np.concatenate([effects, dummies]) / 2


def test_effects_mean_and_error_come_back():
    effects, dummies = [3.0, -1.0, 0.5, 0.0, 2.0], [0.1, -0.2, 0.3, 0.1, -0.1, 0.2]
    found = screening_effects(FIVE, made(effects, dummies), names="fTADd")
    np.testing.assert_allclose(found.effect, effects, atol=1e-12)
    np.testing.assert_allclose(found.dummy_effect, dummies, atol=1e-12)
    assert found.mean == pytest.approx(10)
    assert found.effect_standard_error == pytest.approx(np.sqrt(0.2 / 6))
    assert found.minimum_significant_effect == pytest.approx(1.943 * np.sqrt(0.2 / 6), rel=5e-4)
    assert found.is_significant.tolist() == [True, True, True, False, True]
    assert (found.error_from, found.degrees_of_freedom) == ("dummy", 6.0)
    assert found.names == ("f", "T", "A", "D", "d") and found.reason == ""


def test_an_effect_is_the_mean_above_less_the_mean_below():
    response = RNG.standard_normal(12)
    high = FIVE.coded[:, 2] > 0
    expected = response[high].mean() - response[~high].mean()
    assert screening_effects(FIVE, response).effect[2] == pytest.approx(expected)


def test_p_values_are_students():
    found = screening_effects(FIVE, RNG.standard_normal(12))
    np.testing.assert_allclose(found.p_value, 2 * stats.t.sf(np.abs(found.t_value), 6), rtol=1e-10)
    np.testing.assert_array_equal(found.is_significant, found.p_value < 0.10)


def test_many_responses_are_each_as_alone_and_missing_runs_stay_theirs():
    responses = RNG.standard_normal((3, 4, 12))
    responses[1, 2, 5] = np.nan
    many = screening_effects(FIVE, responses)
    assert many.effect.shape == (3, 4, 5)
    alone = screening_effects(FIVE, responses[2, 1])
    np.testing.assert_allclose(many.effect[2, 1], alone.effect)
    np.testing.assert_allclose(
        many.minimum_significant_effect[2, 1], alone.minimum_significant_effect
    )
    assert np.isnan(many.effect[1, 2]).all() and not many.is_significant[1, 2].any()
    assert np.argwhere(many.reason != "").tolist() == [[1, 2]]
    assert "a run is missing" in str(many.reason[1, 2])
    assert np.isfinite(many.effect).sum() == 11 * 5


def test_a_response_that_stands_still_says_so():
    found = screening_effects(FIVE, np.full(12, 4.0))
    assert found.reason == "every run has the same response"
    assert not found.is_significant.any()


def test_noise_alone_is_significant_as_often_as_the_level_says():
    found = screening_effects(FIVE, RNG.standard_normal((20_000, 12)))
    share = found.is_significant.mean()
    assert share == pytest.approx(0.10, abs=0.005)
    together = (
        (np.abs(found.effect) > found.simultaneous_minimum_effect[:, None]).any(axis=1).mean()
    )
    # effects share one error, so the level of all together is met from below
    assert 0.05 < together <= 0.105


def test_lenths_error_of_effects_worked_by_hand():
    design = plackett_burman(11, n_runs=12)
    effects = np.array([1.0, -1, 2, 3, -3, 4, 50, 60, 2, -4, 1])
    found = screening_effects(design, made(effects, [], design=design))
    assert found.error_from == "lenth" and found.degrees_of_freedom == pytest.approx(11 / 3)
    # median of all eleven is 3: 4.5; nine are left, their median is 2
    assert found.effect_standard_error == pytest.approx(3.0)
    expected = stats.t.ppf(0.95, 11 / 3) * 3.0
    assert found.minimum_significant_effect == pytest.approx(expected)
    assert np.flatnonzero(found.is_significant).tolist() == [6, 7]


def test_lenths_error_of_nothing_is_nothing():
    design = plackett_burman(11, n_runs=12)
    found = screening_effects(design, np.stack([np.full(12, 3.0), np.arange(12.0)]))
    assert found.effect_standard_error[0] == 0
    assert found.reason.tolist() == ["every run has the same response", ""]


@pytest.mark.parametrize("n_runs", [12, 20, 24])
def test_an_interaction_moves_the_effects_by_its_aliases(n_runs):
    design = plackett_burman(6, n_runs=n_runs)
    pairs, alias = alias_matrix(design.coded)
    for column, (one, other) in enumerate(pairs):
        response = 0.5 * design.coded[:, one] * design.coded[:, other]  # an interaction of 1
        found = screening_effects(design, response)
        np.testing.assert_allclose(found.effect, alias[1:, column], atol=1e-12)


def test_runs_that_are_not_a_whole_design_are_refused():
    with pytest.raises(DataError, match="not balanced and orthogonal; found .*Add the runs"):
        screening_effects(Design("plackett-burman", FIVE.coded[:11], FIVE.dummy[:11]), np.zeros(11))


def test_names_that_do_not_fit_are_refused():
    with pytest.raises(SettingsError, match="names do not fit the factors; found a, b; needed 5"):
        screening_effects(FIVE, np.zeros(12), names="ab")


def test_the_error_of_effects_is_named_where_it_is_no_dummies_of_one_specimen():
    assert screening_remarks(8, has_blocks=False) == []
    lenth, blocks = map(str, screening_remarks(0, has_blocks=True))
    assert "Lenth" in lenth and "blocks" in blocks
    with pytest.raises(SettingsError, match="a number of columns; found -1"):
        screening_remarks(-1, has_blocks=False)


def test_lenths_estimate_leaves_out_effects_beyond_two_and_a_half_times_the_first():
    """Median 4, first estimate 6: of 16, 17 and 18 all are beyond 15; 1.5 medians of the rest."""
    effects = np.array([1.0, -2.0, 3.0, -4.0, 16.0, -17.0, 18.0])
    assert _pseudo_standard_error(effects) == pytest.approx(1.5 * 2.5)


# aliases of main effects and interactions


def test_in_twelve_runs_each_interaction_is_a_third_of_every_other_main_effect():
    pairs, alias = alias_matrix(plackett_burman(11, n_runs=12).coded)
    assert len(pairs) == 55 and alias.shape == (12, 55)
    np.testing.assert_allclose(alias[0], 0, atol=1e-12)
    for column, pair in enumerate(pairs):
        for factor in range(11):
            expected = 0 if factor in pair else 1 / 3
            assert abs(alias[1 + factor, column]) == pytest.approx(expected, abs=1e-12)


def test_factors_that_move_together_have_no_aliases():
    column = plackett_burman(1).coded
    with pytest.raises(DataError, match="cannot be told apart; found rank 2; needed 3"):
        alias_matrix(np.hstack([column, column]))


def test_what_is_not_of_two_levels_is_refused():
    with pytest.raises(DataError, match="not a table of two levels; found shape .* needed -1 and"):
        alias_matrix([[0.0, 1.0], [1.0, -1.0]])
