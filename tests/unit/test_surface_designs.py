"""Published designs: their moments, their counts, and what they refuse."""

from itertools import combinations

import numpy as np
import pytest
from refusals import refusals

from reduction.experiments.designs import (
    FIRST_ROWS,
    TRIPLES,
    FactorLevels,
    box_behnken,
    coded_from_engineering,
    engineering_from_coded,
    engineering_levels,
    engineering_matrix,
    gradient_matrix,
    model_matrix,
    plackett_burman,
    quadratic_exponents,
    term_kinds,
    term_names,
)
from reduction.record.errors import DataError, SettingsError

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


def test_more_factors_than_columns_are_refused():
    with pytest.raises(
        SettingsError, match="12 runs have no room .* found 12 factors; needed at most 11"
    ):
        plackett_burman(12, n_runs=12)
    with pytest.raises(SettingsError, match="24 runs have no room"):
        plackett_burman(24)


LOW, HIGH = [0.1, 768.0, 320.0], [0.5, 1920.0, 768.0]


def test_levels_of_the_plan_are_minus_one_nought_and_one():
    levels = [[0.1, 1344.0, 768.0], [0.3, 768.0, 544.0], [0.5, 1920.0, 320.0]]
    coded = coded_from_engineering(levels, low=LOW, high=HIGH)
    np.testing.assert_allclose(coded, [[-1, 0, 1], [0, -1, 0], [1, 1, -1]], atol=1e-15)
    back = engineering_from_coded(coded, low=LOW, high=HIGH)
    np.testing.assert_allclose(back, levels, rtol=1e-14)


@pytest.mark.parametrize("n_factors", [1, 2, 3, 5])
def test_both_equations_give_the_same_surface(n_factors):
    rng = np.random.default_rng(n_factors)
    exponents = quadratic_exponents(n_factors)
    low = rng.uniform(-5, 5, n_factors)
    high = low + rng.uniform(0.1, 9, n_factors)
    coefficient = rng.normal(size=len(exponents))
    coded = rng.uniform(-1.5, 1.5, (20, n_factors))
    levels = engineering_from_coded(coded, low=low, high=high)
    in_levels = engineering_matrix(exponents, low=low, high=high) @ coefficient
    np.testing.assert_allclose(
        model_matrix(levels, exponents) @ in_levels,
        model_matrix(coded, exponents) @ coefficient,
        rtol=1e-8,
        atol=1e-8,
    )


def test_covariance_is_carried_as_draws_of_the_coefficients_are():
    rng = np.random.default_rng(4)
    exponents = quadratic_exponents(2)
    matrix = engineering_matrix(exponents, low=[0.1, 1.0], high=[0.5, 3.0])
    root = rng.normal(size=(6, 6))
    draws = rng.normal(size=(200_000, 6)) @ root.T
    expected = np.cov(draws @ matrix.T, rowvar=False)
    found = matrix @ (root @ root.T) @ matrix.T
    np.testing.assert_allclose(np.diag(found), np.diag(expected), rtol=0.02)


# levels in SI, in break strength, in mean tension; what cannot be a level

CODED = np.array([[-1.0, -1.0], [0.0, 0.0], [1.0, 1.0]])


def loads(low, high, amplitude_low, amplitude_high, basis="rated_break_strength"):
    return (
        FactorLevels("mean_tension", low, high, "rated_break_strength"),
        FactorLevels("tension_amplitude", amplitude_low, amplitude_high, basis),
    )


def test_amplitude_as_a_fraction_of_the_mean_follows_the_mean_of_its_run():
    factors = loads(0.1, 0.3, 0.2, 0.6, basis="mean_tension")
    coded = [[-1.0, 1.0], [1.0, -1.0], [0.0, 0.0]]
    levels = engineering_levels(coded, factors, rated_break_strength=1000.0)
    np.testing.assert_allclose(levels, [[100, 60], [300, 60], [200, 80]])


def test_the_mean_may_stand_after_the_amplitude():
    mean, amplitude = loads(0.1, 0.3, 0.2, 0.6, basis="mean_tension")
    levels = engineering_levels([[1.0, -1.0]], (amplitude, mean), rated_break_strength=1000.0)
    np.testing.assert_allclose(levels, [[60, 100]])


def test_two_diameters_in_one_screening_each_have_their_break_strength():
    # CG-D-39-80, Table A-1: 15 to 50 % of break strength; A-3: 6920 and 17530 lb wet
    design = plackett_burman(2)
    strength = np.where(design.coded[:, 1] > 0, 17530.0, 6920.0)
    factors = (
        FactorLevels("mean_tension", 0.15, 0.50, "rated_break_strength"),
        FactorLevels("diameter", 0.5, 13 / 16),
    )
    levels = engineering_levels(design.coded, factors, rated_break_strength=strength)
    assert set(levels[:, 0].round(1)) == {1038.0, 3460.0, 2629.5, 8765.0}
    assert set(levels[:, 1]) == {0.5, 0.8125}


@pytest.mark.parametrize(
    ("low", "high"), [(0.5, 0.1), (0.1, 0.1), (float("nan"), 1), (0.1, float("inf"))]
)
def test_levels_that_do_not_rise_are_refused(low, high):
    with pytest.raises(SettingsError, match="levels of frequency do not rise; found"):
        FactorLevels("frequency", low, high)


@pytest.mark.parametrize("name", ["frequency", "mean_tension", "tension_amplitude"])
def test_a_level_at_zero_is_refused_where_it_cannot_be_run(name):
    with pytest.raises(SettingsError, match=f"a level of {name} is not above zero; found 0 and 1"):
        FactorLevels(name, 0.0, 1.0)


def test_a_temperature_below_zero_is_a_level():
    assert FactorLevels("temperature", -5.0, 20.0).low == -5


def test_a_fraction_above_the_whole_is_refused():
    with pytest.raises(
        SettingsError,
        match="more than the whole rated break strength; found 12 and 30; needed fractions",
    ):
        FactorLevels("mean_tension", 12, 30, "rated_break_strength")
    with pytest.raises(
        SettingsError, match=r"more than the whole mean tension.*go slack in every cycle"
    ):
        FactorLevels("tension_amplitude", 0.5, 1.2, "mean_tension")


def test_only_loads_are_fractions():
    with pytest.raises(
        SettingsError, match="frequency cannot be a fraction of the rated break strength"
    ):
        FactorLevels("frequency", 0.1, 0.5, "rated_break_strength")
    with pytest.raises(
        SettingsError, match="mean_tension cannot be a fraction of the mean tension"
    ):
        FactorLevels("mean_tension", 0.1, 0.5, "mean_tension")


@pytest.mark.parametrize("strength", [0.0, -5.0, float("nan")])
def test_break_strength_that_cannot_be_is_refused(strength):
    with pytest.raises(DataError, match="rated_break_strength are not"):
        engineering_levels(CODED, loads(0.1, 0.3, 0.05, 0.1), rated_break_strength=strength)


def test_break_strength_that_does_not_fit_the_runs_is_refused():
    with pytest.raises(
        DataError, match=r"does not fit the runs; found shape \(2,\); needed one value, or 3"
    ):
        engineering_levels(CODED, loads(0.1, 0.3, 0.05, 0.1), rated_break_strength=[1.0, 2.0])


def test_a_fraction_of_a_mean_that_is_not_a_factor_is_refused():
    amplitude = FactorLevels("tension_amplitude", 0.2, 0.6, "mean_tension")
    with pytest.raises(SettingsError, match="fraction of the mean tension, which is not a factor"):
        engineering_levels([[0.0]], (amplitude,))


def test_factors_that_do_not_fit_are_refused():
    factors = (FactorLevels("frequency", 0.1, 0.5),) * 2
    with pytest.raises(SettingsError, match="do not fit the design; found 2 factors; needed 3"):
        engineering_levels(box_behnken(3).coded, factors)
    with pytest.raises(SettingsError, match="a factor appears twice; found frequency"):
        engineering_levels(CODED, factors)


def test_coded_levels_that_are_no_table_are_refused():
    with pytest.raises(DataError, match=r"not a table of runs; found shape \(1,\)"):
        engineering_levels([0.0], (FactorLevels("frequency", 0.1, 0.5),))
    with pytest.raises(DataError, match="coded are not finite"):
        engineering_levels([[np.nan]], (FactorLevels("frequency", 0.1, 0.5),))


def test_terms_of_three_factors_stand_in_the_order_of_equation_5():
    names = term_names(quadratic_exponents(3), ["f", "Tm", "dT"])
    assert names == (
        "mean", "f^2", "Tm^2", "dT^2", "f", "Tm", "dT", "f*Tm", "f*dT", "Tm*dT",
    )  # fmt: skip


@pytest.mark.parametrize("n_factors", range(1, 8))
def test_there_are_as_many_terms_as_a_quadratic_has(n_factors):
    exponents = quadratic_exponents(n_factors)
    assert len(exponents) == (n_factors + 1) * (n_factors + 2) // 2
    assert len({tuple(row) for row in exponents}) == len(exponents)
    kinds = term_kinds(exponents)
    assert kinds.count("square") == kinds.count("linear") == n_factors


def test_model_matrix_is_the_equation_written_out():
    f, mean, swing = 0.3, -0.7, 0.9
    row = model_matrix([f, mean, swing], quadratic_exponents(3))
    written = [1, f**2, mean**2, swing**2, f, mean, swing, f * mean, f * swing, mean * swing]
    np.testing.assert_allclose(row, written, rtol=1e-15)


def test_gradient_matrix_is_the_difference_of_the_model_matrix():
    exponents, step = quadratic_exponents(3), 1e-6
    points = np.random.default_rng(2).uniform(-1, 1, (4, 3))
    found = gradient_matrix(points, exponents)
    for factor in range(3):
        move = step * np.eye(3)[factor]
        difference = model_matrix(points + move, exponents) - model_matrix(points - move, exponents)
        np.testing.assert_allclose(found[:, factor], difference / (2 * step), atol=1e-9)


@pytest.mark.parametrize("names", [["f"], ["f", "f"]])
def test_names_that_do_not_pair_up_are_refused(names):
    with pytest.raises(SettingsError, match="needed 2 different names"):
        term_names(quadratic_exponents(2), names)


REFUSED = {
    "a negative number of centres is refused": (
        lambda: box_behnken(3, n_centre=-1),
        SettingsError,
        "centre runs is negative; found -1",
    ),
    "no factors at all are refused": (
        lambda: plackett_burman(0),
        SettingsError,
        "a screening design needs factors; found 0",
    ),
    "another number of runs is refused": (
        lambda: plackett_burman(5, n_runs=16),
        SettingsError,
        "no Plackett-Burman design .* found 16; needed 12, 20 or 24",
    ),
    "a high level below its low one is refused": (
        lambda: coded_from_engineering([[0.0, 0.0]], low=[0.0, 1.0], high=[1.0, 1.0]),
        SettingsError,
        "high level of factor 2 does not lie above",
    ),
    "levels that do not pair up are refused": (
        lambda: engineering_from_coded([[0.0]], low=[0.0], high=[1.0, 2.0]),
        SettingsError,
        "low and high levels do not pair up",
    ),
    "break strength that is not given is asked for": (
        lambda: engineering_levels(CODED, loads(0.1, 0.3, 0.05, 0.1)),
        SettingsError,
        r"fraction of the rated break strength, which is not given; found mean_tension, "
        r"tension_amplitude; .*Give rated_break_strength",
    ),
    "no factor is refused": (
        lambda: quadratic_exponents(0),
        SettingsError,
        "a surface has no factor",
    ),
    "a term of third order is refused": (
        lambda: term_kinds(np.array([[2, 1]])),
        SettingsError,
        "above second order; found order 3",
    ),
    "points that are not finite are refused": (
        lambda: model_matrix([1.0, np.nan], quadratic_exponents(2)),
        DataError,
        "1 of 2 values of the levels are not finite",
    ),
}


test_refusals = refusals(REFUSED)
