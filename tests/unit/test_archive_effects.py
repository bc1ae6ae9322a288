"""Effects and aliases of a screening stand in the archive, each in its own place."""

import numpy as np
import pytest
from experiments import ABOUT, screening_experiment

from reduction.archive.surfaces_dataset import alias_values, effect_values, surfaces_to_dataset
from reduction.experiments.designs import plackett_burman
from reduction.experiments.screening import alias_matrix, screening_effects

SCREENING = screening_experiment()
BROKEN = screening_experiment("broken", missing=(4,))


@pytest.fixture(scope="module")
def dataset():
    return surfaces_to_dataset([SCREENING, BROKEN], origin=ABOUT)


def test_an_interaction_stands_in_every_other_column_with_a_third(dataset):
    """Of twelve runs, dummies included: nil in its own two factors."""
    alias = dataset["effect_alias"].values[0]
    one, other = (
        dataset[f"interaction{which}_factor"].values[0].tolist() for which in ("", "_other")
    )
    columns = dataset["plan_column_name"].values[0].tolist()
    assert alias.shape == (10, 11)
    assert list(zip(one, other, strict=True))[:2] == [
        ("frequency", "mean_tension"), ("frequency", "tension_amplitude"),
    ]  # fmt: skip
    for row, pair in zip(alias, zip(one, other, strict=True), strict=True):
        for share, column in zip(row, columns, strict=True):
            expected = 0 if column in pair else 1 / 3
            assert abs(share) == pytest.approx(expected, abs=1e-12)


def test_aliases_of_the_factors_are_those_of_alias_matrix(dataset):
    pairs, alias = alias_matrix(plackett_burman(5).coded)
    assert len(pairs) == 10
    np.testing.assert_allclose(dataset["effect_alias"].values[0, :, :5].T, alias[1:], atol=1e-12)


def test_a_response_of_one_interaction_alone_gives_effects_of_its_aliases():
    """The effect of a product of two columns, times its size, is what each column shows."""
    plan = plackett_burman(4)
    columns = np.hstack([plan.coded, plan.dummy])
    found = effect_values(
        screening_effects(plan, [5 + 3 * columns[:, 1] * columns[:, 3]]), ["loss_factor"]
    )
    names = alias_values(columns, "abcd")
    row = list(
        zip(names["interaction_factor"], names["interaction_other_factor"], strict=True)
    ).index(("b", "d"))
    np.testing.assert_allclose(
        found["loss_factor_effect"], 2 * 3 * names["effect_alias"][row], atol=1e-12
    )


def test_a_half_fraction_hides_a_factor_in_an_interaction_whole():
    """Resolution III: c = ab."""
    plan = np.array([[-1, -1, 1], [1, -1, -1], [-1, 1, -1], [1, 1, 1.0]])
    found = alias_values(plan, "abc")
    np.testing.assert_allclose(found["effect_alias"], [[0, 0, 1], [0, 1, 0], [1, 0, 0]], atol=1e-12)
    assert found["interaction"].tolist() == [1, 2, 3]


def test_one_factor_has_no_interaction():
    assert alias_values(np.array([[-1.0, -1, 1], [1, -1, -1], [-1, 1, -1], [1, 1, 1]]), "a") == {}


def test_a_screening_that_misses_a_run_has_its_aliases_and_no_points(dataset):
    assert np.isnan(dataset["hysteresis_energy_effect"].values[1]).all()
    np.testing.assert_array_equal(
        dataset["effect_alias"].values[1], dataset["effect_alias"].values[0]
    )
