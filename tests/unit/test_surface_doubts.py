"""Doubts of fitted surfaces: below zero where no run is, drift over the runs."""

import re

import numpy as np
import pytest
import statsmodels.api as sm

from reduction.experiments.designs import box_behnken, model_matrix, quadratic_exponents
from reduction.experiments.response_surfaces import _levels, fit_surfaces
from reduction.experiments.surface_warnings import (
    drift_over_order,
    drifting_responses,
    negative_surfaces,
    outlying_runs,
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


# drift over the order of the runs, beside the terms of a surface

RNG = np.random.default_rng(1980)
ORDER = RNG.permutation(15) + 1.0


def fitted_of_drift(responses, coded=CODED, **options):
    return fit_surfaces(
        coded, responses, units="coded", factor_names=["f", "T", "a"],
        response_names=[f"y{i}" for i in range(len(responses))], low=[0] * 3, high=[1] * 3,
        **options,
    )  # fmt: skip


def test_slope_error_and_p_are_those_of_statsmodels():
    responses = RNG.normal(0, 1, (3, 15)) + 0.1 * ORDER
    found = drift_over_order(fitted_of_drift(responses), ORDER)
    matrix = np.column_stack([model_matrix(CODED, quadratic_exponents(3)), ORDER])
    for index, values in enumerate(responses):
        other = sm.OLS(values, matrix).fit()
        assert found.slope[index] == pytest.approx(other.params[-1], rel=1e-9)
        assert found.standard_uncertainty[index] == pytest.approx(other.bse[-1], rel=1e-9)
        assert found.p_value[index] == pytest.approx(other.pvalues[-1], rel=1e-9)


def test_blocks_keep_means_of_their_own():
    coded, order = np.tile(CODED, (2, 1)), np.tile(ORDER, 2)
    step = np.repeat([0.0, 40.0], 15)
    responses = RNG.normal(0, 1e-3, (1, 30)) + step + 0.5 * order
    labels = ["a"] * 15 + ["b"] * 15
    names = [str(i) for i in range(30)]
    found = drift_over_order(
        fitted_of_drift(responses, coded, blocks=labels, run_names=names), order
    )
    assert found.slope[0] == pytest.approx(0.5, abs=5e-4)


def test_a_false_alarm_is_as_rare_as_its_level():
    noise = RNG.normal(0, 1, (20_000, 15))
    p_value = drift_over_order(fitted_of_drift(noise, with_tests=False), ORDER).p_value
    assert np.mean(p_value < 0.05) == pytest.approx(0.05, abs=0.006)


def test_an_order_that_is_a_factor_or_not_known_gives_nothing():
    responses = RNG.normal(0, 1, (1, 15))
    assert np.isnan(drift_over_order(fitted_of_drift(responses), CODED[:, 0] * 5 + 6).p_value).all()
    assert np.isnan(drift_over_order(fitted_of_drift(responses), np.full(15, np.nan))).all()


def test_a_run_without_a_place_is_left_out_of_the_drift_alone():
    responses = 0.3 * ORDER[None] + RNG.normal(0, 1e-6, 15)
    order = np.where(np.arange(15) == 4, np.nan, ORDER)
    assert drift_over_order(fitted_of_drift(responses), order).slope[0] == pytest.approx(
        0.3, rel=1e-4
    )


# A run far off the surface of all others is named, and sound runs are not

RNG_OF_OUTLIERS = np.random.default_rng(13)
LOW, HIGH = np.array([0.1, 15.0, 4.0]), np.array([0.5, 40.0, 12.0])


def fitted_of_outliers(runs, transform="none", name="K"):
    return fit_surfaces(
        CODED, [runs], factor_names=["f", "m", "a"], response_names=[name], low=LOW, high=HIGH,
        run_names=[f"R{run}" for run in range(1, 16)], units="coded", transforms=transform,
    )  # fmt: skip


def stiffness(scatter):
    """A power law of frequency, mean load and amplitude [kN]."""
    levels = (LOW + HIGH) / 2 + CODED * (HIGH - LOW) / 2
    law = 1200 * np.prod((levels / [0.3, 27.5, 8.0]) ** [0.05, 0.45, -0.12], axis=1)
    return law * (1 + scatter * RNG_OF_OUTLIERS.normal(size=15))


@pytest.mark.parametrize("transform", ["none", "log"])
def test_a_centre_run_with_a_wrong_load_is_named_with_what_it_is_off(transform):
    runs = stiffness(0.003)
    runs[13] *= 0.8
    (stray,) = outlying_runs(fitted_of_outliers(runs, transform))
    said = r"run R14 \(-(20|21) %\) is off the surface of the other runs in K \(p "
    assert re.match(said, str(stray))
    assert stray.severity == "warning" and "which of" not in str(stray)


def test_of_two_runs_opposite_through_the_centre_the_residuals_do_not_tell_which():
    """R5 is (-1, 0, -1) and R8 is (1, 0, 1); the others know of their difference alone."""
    runs = stiffness(0.0005)
    runs[4] *= 1.2
    (stray,) = outlying_runs(fitted_of_outliers(runs))
    assert str(stray).startswith("run R5 (+20 %) or R8 (-17 %) is off the surface of the other")
    assert str(stray).endswith("the residuals do not show which of the 2 is wrong")


def test_sound_runs_are_not_named():
    """Of a law that is no quadratic, with scatter of 3 % and with next to none."""
    for scatter in [0.03] * 40 + [1e-4] * 40:
        assert outlying_runs(fitted_of_outliers(stiffness(scatter))) == ()


def test_drift_is_given_as_a_share_of_the_response():
    order = np.random.default_rng(1).permutation(15)
    surfaces = fitted_of_outliers(stiffness(1e-5) * (1 + 0.004 * order))
    (drift,) = drifting_responses(surfaces, drift_over_order(surfaces, order))
    assert ", +0.4" in str(drift) and "% of the response (p" in str(drift)
