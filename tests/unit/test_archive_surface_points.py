"""Surfaces at named points and along their ridges stand in the archive as they are elsewhere."""

from dataclasses import replace

import numpy as np
import pytest
import statsmodels.api as sm
from experiments import ABOUT, FACTORS, HIGH, LOW, surface_experiment
from scipy import stats

from reduction.archive.surface_points import point_values, ridge_values
from reduction.archive.surfaces import surfaces_to_dataset
from reduction.surface.bands import evaluate_surfaces
from reduction.surface.canonical import ridge_path
from reduction.surface.designs import box_behnken
from reduction.surface.surfaces import fit_surfaces
from reduction.surface.terms import model_matrix
from reduction.vocabulary import RESPONSES

ONE = surface_experiment()
SHORT = surface_experiment("short", seed=4, names=RESPONSES[:1], missing=(3,))
RANDOM = surface_experiment(
    "random", seed=6, names=RESPONSES[:2], specimens=("a", "b", "c"), treatment="random"
)


@pytest.fixture(scope="module")
def dataset():
    return surfaces_to_dataset([ONE, SHORT, RANDOM], origin=ABOUT)


def at_points(dataset, name, row=0):
    return {
        what: dataset[f"{name}_point_{what}"].values[row]
        for what in (
            "value", "mean_value", "confidence_low", "confidence_high", "prediction_low",
            "prediction_high", "simultaneous_low", "simultaneous_high", "variance_factor",
            "is_above_leverage",
        )
    }  # fmt: skip


@pytest.mark.parametrize("row", [0, 1])
def test_points_and_intervals_are_those_of_statsmodels(dataset, row):
    result = (ONE, SHORT)[row]
    surfaces, response = result.surfaces, result.runs.response[0]
    has = np.isfinite(response)
    coded = dataset["point_coded_level"].values[row]
    terms = model_matrix(coded, surfaces.exponents)
    runs = model_matrix(surfaces.coded[has], surfaces.exponents)
    other = sm.OLS(response[has], runs).fit()
    frame = other.get_prediction(terms).summary_frame(alpha=0.05)
    found = at_points(dataset, "apparent_spring_constant", row)
    for name, column in (
        ("value", "mean"),
        ("mean_value", "mean"),
        ("confidence_low", "mean_ci_lower"),
        ("confidence_high", "mean_ci_upper"),
        ("prediction_low", "obs_ci_lower"),
        ("prediction_high", "obs_ci_upper"),
    ):
        np.testing.assert_allclose(found[name], frame[column], rtol=1e-8, err_msg=name)
    spread = dataset["apparent_spring_constant_point_value_standard_uncertainty"].values[row]
    np.testing.assert_allclose(spread, frame["mean_se"], rtol=1e-8)
    reach = np.sqrt(10 * stats.f.ppf(0.95, 10, has.sum() - 10))
    np.testing.assert_allclose(
        found["simultaneous_high"] - found["value"], reach * spread, rtol=1e-7
    )
    np.testing.assert_allclose(
        found["value"] - found["simultaneous_low"], reach * spread, rtol=1e-7
    )
    assert dataset["interval_confidence"].values[row] == 0.95


def test_the_cube_of_three_factors_has_21_points_in_engineering_units(dataset):
    assert dataset["point"].values.tolist() == list(range(1, 22))
    assert dataset["point_name"].values[0, [0, 1, 13]].tolist() == [
        "(0, 0, 0)", "(-1, -1, 0)", "(-1, -1, -1)",
    ]  # fmt: skip
    assert dataset["point_kind"].values[0, [0, 1, 13]].tolist() == [
        "centre", "edge midpoint", "corner",
    ]  # fmt: skip
    np.testing.assert_allclose(dataset["point_level"].values[0, 0], [0.3, 5950, 2125])
    np.testing.assert_allclose(dataset["point_level"].values[0, 13], LOW)
    np.testing.assert_allclose(dataset["point_level"].values[0, 20], HIGH)


def test_the_corners_of_a_design_as_planned_are_where_the_runs_say_little():
    """1.396 at the corner of fifteen runs against 0.75 at their edges, 1/3 in the middle."""
    plan = box_behnken(3).coded
    surfaces = fit_surfaces(
        plan, [np.random.default_rng(2).normal(10, 1, 15)], factor_names=FACTORS,
        response_names=["loss_factor"], low=LOW, high=HIGH, units="coded",
    )  # fmt: skip
    found = point_values(surfaces, plan)
    factor = found["loss_factor_point_variance_factor"]
    assert factor[0] == pytest.approx(1 / 3)
    np.testing.assert_allclose(factor[1:13], 0.75)
    np.testing.assert_allclose(factor[13:], 1.396, atol=5e-4)
    assert found["loss_factor_point_is_above_leverage"].tolist() == [False] * 13 + [True] * 8


def test_a_surface_of_four_factors_has_the_runs_of_its_plan_and_sixteen_corners():
    plan = box_behnken(4).coded
    surfaces = fit_surfaces(
        plan, [1 + plan @ [1.0, 2.0, 3.0, 4.0]], factor_names="abcd",
        response_names=["loss_factor"], low=[-1.0] * 4, high=[1.0] * 4, units="coded",
    )  # fmt: skip
    found = point_values(surfaces, plan)
    assert found["loss_factor_point_value"].shape == (1 + 24 + 16,)
    np.testing.assert_allclose(
        found["loss_factor_point_value"], 1 + found["point_coded_level"] @ [1, 2, 3, 4], atol=1e-9
    )


@pytest.mark.parametrize("name", ["log_hysteresis_energy", "box_cox_dissipation_spring_constant"])
def test_a_transformed_response_comes_back_to_its_own_unit(dataset, name):
    base = name.removeprefix("log_").removeprefix("box_cox_")
    index = ONE.surfaces.response_names.index(name)
    coded = dataset["point_coded_level"].values[0]
    fitted = model_matrix(coded, ONE.surfaces.exponents) @ ONE.surfaces.coefficient[index]
    power = ONE.surfaces.transform_exponent[index]
    expected = np.exp(fitted) if name.startswith("log_") else (1 + power * fitted) ** (1 / power)
    found = at_points(dataset, name)
    np.testing.assert_allclose(found["value"], expected, rtol=1e-9)
    assert (found["confidence_low"] < expected).all()
    assert (found["confidence_high"] > expected).all()
    for what in ("point_value", "point_prediction_high", "ridge_value", "ridge_simultaneous_low"):
        units = dataset[f"{base}_sigma"].attrs["units"]
        assert dataset[f"{name}_{what}"].attrs["units"] == units
    assert f"{name}_point_value_standard_uncertainty" not in dataset
    words = dataset[f"{name}_point_value"].attrs["long_name"]
    assert words.startswith(f"{base.replace('_', ' ')}, by the ")


@pytest.mark.parametrize("row", [0, 1, 2])
def test_every_surface_is_that_of_evaluate_surfaces(dataset, row):
    result = (ONE, SHORT, RANDOM)[row]
    coded = dataset["point_coded_level"].values[row]
    wanted = evaluate_surfaces(result.surfaces, coded, units="coded")
    for index, name in enumerate(result.surfaces.response_names):
        found = at_points(dataset, name, row)
        np.testing.assert_array_equal(found["value"], wanted.value[index])
        np.testing.assert_array_equal(found["mean_value"], wanted.mean_value[index])
        np.testing.assert_array_equal(found["variance_factor"], wanted.variance_factor[index])
        np.testing.assert_array_equal(found["is_above_leverage"], wanted.above_leverage[index])
        for kind in ("confidence", "prediction", "simultaneous"):
            ends = np.stack([found[f"{kind}_low"], found[f"{kind}_high"]], axis=-1)
            np.testing.assert_array_equal(ends, getattr(wanted, f"{kind}_interval")[index])


def test_points_of_random_specimens_foresee_another_specimen(dataset):
    found = at_points(dataset, "apparent_spring_constant", 2)
    spread = dataset["apparent_spring_constant_point_value_standard_uncertainty"].values[2]
    half = (found["prediction_high"] - found["prediction_low"]) / 2
    own = (found["confidence_high"] - found["confidence_low"]) / 2
    blocks = RANDOM.surfaces.blocks.standard_deviation[0]
    sigma = RANDOM.surfaces.sigma[0]
    np.testing.assert_allclose(
        half / own, np.sqrt(sigma**2 + blocks**2 + spread**2) / spread, rtol=1e-9
    )


@pytest.mark.parametrize("direction", [0, 1])
def test_a_ridge_is_the_best_of_many_points_at_its_distance(dataset, direction):
    name = "apparent_spring_constant"
    radius = dataset["ridge_radius"].values
    np.testing.assert_allclose(radius, np.arange(11) / 10)
    assert dataset["ridge_direction"].values.tolist() == ["ascent", "descent"]
    coded = dataset[f"{name}_ridge_coded_level"].values[0, direction]
    value = dataset[f"{name}_ridge_value"].values[0, direction]
    np.testing.assert_allclose(np.linalg.norm(coded, axis=1), radius, atol=1e-9)
    rng = np.random.default_rng(1)
    ball = rng.standard_normal((20_000, 3))
    ball /= np.linalg.norm(ball, axis=1)[:, None]
    sign = (1, -1)[direction]
    for far, at, best in zip(radius[1:], coded[1:], value[1:], strict=True):
        terms = model_matrix(np.vstack([at, far * ball]), ONE.surfaces.exponents)
        there, *others = sign * (terms @ ONE.surfaces.coefficient[0])
        assert sign * best == pytest.approx(there, rel=1e-12)
        # twenty thousand points lie 0.01 apart: none is better, one is nearly as good
        assert max(others) <= there + 1e-9 * abs(there)
        assert max(others) == pytest.approx(there, rel=1e-3)


def test_a_ridge_of_a_plane_is_straight_in_both_directions():
    plan = box_behnken(3).coded
    surfaces = fit_surfaces(
        plan, [7 + plan @ [2.0, 3.0, 6.0]], factor_names=FACTORS,
        response_names=["loss_factor"], low=LOW, high=HIGH, units="coded",
    )  # fmt: skip
    found = ridge_values(surfaces)
    far = np.arange(11) / 10
    np.testing.assert_allclose(
        found["loss_factor_ridge_value"], [7 + 7 * far, 7 - 7 * far], atol=1e-8
    )
    np.testing.assert_allclose(
        found["loss_factor_ridge_coded_level"][1, -1], -np.array([2, 3, 6]) / 7, atol=1e-8
    )
    np.testing.assert_allclose(
        found["loss_factor_ridge_level"][0, -1],
        (HIGH + LOW) / 2 + (HIGH - LOW) / 2 * np.array([2, 3, 6]) / 7,
        rtol=1e-8,
    )


@pytest.mark.parametrize("row", [0, 1, 2])
def test_every_ridge_is_that_of_ridge_path_with_the_intervals_of_its_own_surface(dataset, row):
    result = (ONE, SHORT, RANDOM)[row]
    surfaces = result.surfaces
    for step, direction in enumerate(("ascent", "descent")):
        path = ridge_path(
            surfaces.coefficient, surfaces.exponents, radius=np.linspace(0, 1, 11), low=LOW,
            high=HIGH, direction=direction,
        )  # fmt: skip
        for index, name in enumerate(surfaces.response_names):
            there = {
                what: dataset[f"{name}_ridge_{what}"].values[row, step]
                for what in (
                    "coded_level",
                    "level",
                    "value",
                    "simultaneous_high",
                    "simultaneous_low",
                )
            }
            np.testing.assert_array_equal(there["coded_level"], path.coded[index])
            np.testing.assert_array_equal(there["level"], path.engineering[index])
            at = evaluate_surfaces(surfaces, path.coded[index], units="coded")
            np.testing.assert_array_equal(there["value"], at.value[index])
            np.testing.assert_array_equal(
                there["simultaneous_high"], at.simultaneous_interval[index, :, 1]
            )
            np.testing.assert_array_equal(
                there["simultaneous_low"], at.simultaneous_interval[index, :, 0]
            )


def test_a_response_without_a_surface_has_neither_points_nor_a_ridge():
    response = np.array(ONE.runs.response)
    response[1, 2:] = np.nan
    runs = replace(ONE.runs, response=response)
    surfaces = fit_surfaces(
        runs.level, response, factor_names=FACTORS, response_names=ONE.response_names,
        low=LOW, high=HIGH, run_names=runs.names,
    )  # fmt: skip
    bare = replace(ONE, runs=runs, surfaces=surfaces, reduced=None)
    dataset = surfaces_to_dataset([bare], origin=ABOUT)
    for what in ("point_value", "point_simultaneous_high", "ridge_value", "ridge_coded_level"):
        assert np.isnan(dataset[f"hysteresis_energy_{what}"].values).all()
        assert np.isfinite(dataset[f"apparent_spring_constant_{what}"].values).all()
    assert not dataset["hysteresis_energy_point_is_above_leverage"].values.any()
