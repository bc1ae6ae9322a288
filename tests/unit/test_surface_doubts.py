"""Doubts of fitted surfaces: below zero where no run is, drift over the runs."""

import numpy as np
import pytest

from reduction.experiments.designs import box_behnken
from reduction.experiments.response_surfaces import _levels, fit_surfaces
from reduction.experiments.surface_warnings import (
    drift_over_order,
    drifting_responses,
    negative_surfaces,
)

CODED = box_behnken(3).coded


def fitted(values, transforms="none"):
    return fit_surfaces(
        CODED, np.atleast_2d(values), units="coded", factor_names=["f", "T", "a"],
        response_names=["energy"], low=[0] * 3, high=[1] * 3, transforms=transforms,
    )  # fmt: skip


def test_a_surface_that_falls_below_zero_in_a_corner_is_named_and_its_logarithm_is_not():
    # a plane of 2.1 less the sum of the factors: 0.1 at the least run, -0.9 in the corner
    plane = 2.1 - CODED.sum(axis=1)
    (words,) = map(str, negative_surfaces(fitted(plane)))
    assert words.startswith("the surface of energy falls below zero")
    assert negative_surfaces(fitted(plane + 1)) == ()
    assert negative_surfaces(fitted(plane, transforms="log")) == ()


def test_a_surface_that_dips_below_zero_between_two_levels_is_named():
    # 50, 2 and 1 along f: 2 - 24.5 f + 23.5 f^2 is -4.4 at its least, at f of 0.52
    time = 2 - 24.5 * CODED[:, 0] + 23.5 * CODED[:, 0] ** 2
    (words,) = map(str, negative_surfaces(fitted(time)))
    assert words.startswith("the surface of energy falls below zero")


def test_a_surface_with_its_logarithm_beside_it_is_not_named():
    plane = 2.1 - CODED.sum(axis=1)
    both = fit_surfaces(
        CODED, [plane, plane], units="coded", factor_names=["f", "T", "a"],
        response_names=["energy", "log_energy"], low=[0] * 3, high=[1] * 3,
        transforms=["none", "log"],
    )  # fmt: skip
    assert negative_surfaces(both) == ()


def test_a_response_whose_name_ends_another_one_is_named_all_the_same():
    plane = 2.1 - CODED.sum(axis=1)
    both = fit_surfaces(
        CODED, [plane, plane + 1], units="coded", factor_names=["f", "T", "a"],
        response_names=["energy", "hysteresis_energy"], low=[0] * 3, high=[1] * 3,
    )  # fmt: skip
    (words,) = map(str, negative_surfaces(both))
    assert words.startswith("the surface of energy falls below zero")


def test_runs_below_zero_are_no_doubt_of_their_surface():
    assert negative_surfaces(fitted(1 - CODED.sum(axis=1))) == ()


def test_a_drift_is_named_with_its_slope_and_its_absence_is_silent():
    rng = np.random.default_rng(4)
    order = rng.permutation(15)
    noise = rng.normal(0, 0.01, 15)
    still, moving = fitted(3 + noise), fitted(3 + noise + 0.5 * order)
    (words,) = map(str, drifting_responses(moving, drift_over_order(moving, order)))
    assert float(words.partition("change by ")[2].split()[0]) == pytest.approx(0.5, abs=0.01)
    assert drifting_responses(still, drift_over_order(still, order)) == ()


def test_one_experiment_of_twenty_is_named_though_nothing_drifts():
    """Four responses of each experiment, one of them with its logarithm beside it."""
    rng = np.random.default_rng(12)
    n_experiments, named = 400, 0
    for _ in range(n_experiments):
        values = 10 + rng.normal(size=(4, 15))
        surfaces = fit_surfaces(
            CODED, values[[0, 1, 2, 3, 3]], units="coded", factor_names=["f", "T", "a"],
            response_names=["apparent_spring_constant", "dissipation_spring_constant",
                            "relaxation_time", "hysteresis_energy", "log_hysteresis_energy"],
            low=[0] * 3, high=[1] * 3, transforms=["none"] * 4 + ["log"], with_tests=False,
        )  # fmt: skip
        drift = drift_over_order(surfaces, rng.permutation(15))
        named += bool(drifting_responses(surfaces, drift))
    # one in twenty +- 0.011
    assert 0.02 < named / n_experiments < 0.085


@pytest.mark.parametrize(("ends", "how"), [
    ((-1.2, 1.0), "go beyond"), ((-0.8, 1.0), "fall short of"), ((-1.05, 0.95), None),
])  # fmt: skip
def test_levels_off_the_range_by_more_than_a_twentieth_of_it_are_told(ends, how):
    """Coded levels of -1 to 1: a tenth of that scale is a twentieth of the range."""
    found = _levels(np.array(ends)[:, None], ["load"])
    assert [one.numbers["how"] for one in found] == ([how] if how else [])
