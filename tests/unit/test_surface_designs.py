"""Published designs: their moments, their counts, and what they refuse."""

from itertools import combinations

import numpy as np
import pytest

from reduction.experiments.designs import FIRST_ROWS, TRIPLES, box_behnken, plackett_burman
from reduction.record.errors import SettingsError

FACTORS = [3, 4, 5, 6, 7]


@pytest.mark.parametrize(
    ("n_factors", "n_runs"), list(zip(FACTORS, [15, 27, 46, 54, 62], strict=True))
)
def test_box_behnken_has_the_published_number_of_runs(n_factors, n_runs):
    assert box_behnken(n_factors).coded.shape == (n_runs, n_factors)


def test_three_factors_stand_in_the_order_of_a_published_example():
    # Lawson's Treb experiment: pairs (1, 2), (1, 3), (2, 3), first factor fastest, centres last
    edges = [(-1, -1), (1, -1), (-1, 1), (1, 1)]
    expected = [(a, b, 0) for a, b in edges]
    expected += [(a, 0, b) for a, b in edges] + [(0, a, b) for a, b in edges] + [(0, 0, 0)] * 3
    np.testing.assert_array_equal(box_behnken(3).coded, expected)


@pytest.mark.parametrize("n_factors", FACTORS)
def test_every_edge_run_is_there_once_and_lies_on_the_cube(n_factors):
    design = box_behnken(n_factors)
    edges = design.coded[np.any(design.coded != 0, axis=1)]
    assert np.unique(edges, axis=0).shape == edges.shape
    moved = np.abs(edges).sum(axis=1)
    assert set(moved) == ({2.0} if n_factors < 6 else {3.0})


@pytest.mark.parametrize("n_factors", FACTORS)
def test_odd_moments_vanish_and_factors_are_alike(n_factors):
    coded = box_behnken(n_factors).coded
    np.testing.assert_array_equal(coded.sum(axis=0), 0)
    second = coded.T @ coded
    np.testing.assert_array_equal(second, np.diag(np.full(n_factors, second[0, 0])))
    pairs = np.column_stack(
        [coded[:, i] * coded[:, j] for i, j in combinations(range(n_factors), 2)]
    )
    np.testing.assert_array_equal(coded.T @ pairs, 0)


# Box and Behnken: rotatable where the pure fourth moment is three times the mixed one.
@pytest.mark.parametrize(
    ("n_factors", "rotatable"), list(zip(FACTORS, [False, True, False, False, True], strict=True))
)
def test_only_four_and_seven_factors_are_rotatable(n_factors, rotatable):
    squares = box_behnken(n_factors).coded ** 2
    fourth = squares.T @ squares
    mixed = fourth[~np.eye(n_factors, dtype=bool)]
    assert bool(np.all(fourth[0, 0] == 3 * mixed)) is rotatable


def test_triples_of_seven_factors_are_a_balanced_incomplete_block_design():
    together = np.zeros((7, 7), dtype=int)
    for triple in TRIPLES[7]:
        for first, second in combinations(triple, 2):
            together[first - 1, second - 1] += 1
    assert np.all(together + together.T + np.eye(7, dtype=int) == 1)


def test_triples_of_six_factors_use_each_three_times_and_each_pair_at_least_once():
    used = np.bincount(np.ravel(TRIPLES[6]))[1:]
    assert used.tolist() == [3] * 6
    pairs = {frozenset(pair) for triple in TRIPLES[6] for pair in combinations(triple, 2)}
    assert len(pairs) == 15


@pytest.mark.parametrize("n_centre", [0, 1, 5])
def test_centres_are_as_many_as_asked_for(n_centre):
    design = box_behnken(3, n_centre=n_centre)
    assert np.all(design.coded == 0, axis=1).sum() == n_centre and design.n_runs == 12 + n_centre


@pytest.mark.parametrize("n_factors", [2, 8])
def test_a_number_of_factors_without_a_published_design_is_refused(n_factors):
    with pytest.raises(
        SettingsError, match=f"no Box-Behnken design .* found {n_factors}; needed 3 to 7"
    ):
        box_behnken(n_factors)


def test_a_negative_number_of_centres_is_refused():
    with pytest.raises(SettingsError, match="centre runs is negative; found -1"):
        box_behnken(3, n_centre=-1)


@pytest.mark.parametrize("n_runs", [12, 20, 24])
def test_plackett_burman_is_orthogonal_and_balanced(n_runs):
    columns = plackett_burman(n_runs - 1, n_runs=n_runs).coded
    np.testing.assert_array_equal(columns.T @ columns, n_runs * np.eye(n_runs - 1))
    np.testing.assert_array_equal(columns.sum(axis=0), 0)
    # rows too: a Hadamard matrix with a column of ones
    np.testing.assert_array_equal(columns @ columns.T + 1, n_runs * np.eye(n_runs))


@pytest.mark.parametrize("n_runs", [12, 20, 24])
def test_the_first_run_is_the_published_row_and_the_last_is_all_low(n_runs):
    columns = plackett_burman(n_runs - 1, n_runs=n_runs).coded
    assert "".join("+" if x > 0 else "-" for x in columns[0]) == FIRST_ROWS[n_runs]
    assert np.all(columns[-1] == -1)
    np.testing.assert_array_equal(columns[1], np.roll(columns[0], 1))


@pytest.mark.parametrize(
    ("n_factors", "n_runs", "n_dummy"),
    [(5, 12, 6), (10, 12, 1), (11, 20, 8), (18, 20, 1), (19, 24, 4), (23, 24, 0)],
)
def test_the_fewest_runs_that_leave_a_dummy_are_taken(n_factors, n_runs, n_dummy):
    design = plackett_burman(n_factors)
    assert design.coded.shape == (n_runs, n_factors)
    assert design.dummy.shape == (n_runs, n_dummy)


def test_no_factors_at_all_are_refused():
    with pytest.raises(SettingsError, match="a screening design needs factors; found 0"):
        plackett_burman(0)


def test_more_factors_than_columns_are_refused():
    with pytest.raises(
        SettingsError, match="12 runs have no room .* found 12 factors; needed at most 11"
    ):
        plackett_burman(12, n_runs=12)
    with pytest.raises(SettingsError, match="24 runs have no room"):
        plackett_burman(24)


def test_another_number_of_runs_is_refused():
    with pytest.raises(
        SettingsError, match="no Plackett-Burman design .* found 16; needed 12, 20 or 24"
    ):
        plackett_burman(5, n_runs=16)
