"""Aliases of main effects and interactions."""

import numpy as np
import pytest

from reduction.experiments.designs import plackett_burman
from reduction.experiments.screening import alias_matrix
from reduction.record.errors import DataError

RNG = np.random.default_rng(12)


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
