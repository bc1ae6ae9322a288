"""Surfaces at named points stand in the archive as they are elsewhere."""

from dataclasses import replace

import numpy as np
import pytest
import statsmodels.api as sm
from experiments import ABOUT, FACTORS, HIGH, LOW, nothing_missed, surface_experiment
from scipy import stats

from reduction.archive.surfaces_dataset import point_values, surfaces_to_dataset
from reduction.archive.uncertainty_budget import all_budgets
from reduction.experiments.designs import box_behnken, model_matrix
from reduction.experiments.experiment import SharedSurfaces
from reduction.experiments.response_surfaces import fit_surfaces
from reduction.experiments.stationary_point import canonical_analysis
from reduction.experiments.surface_points import evaluate_surfaces
from reduction.lines.archive_source import _line_source_of_experiment
from reduction.lines.line_lookup import look_up
from reduction.quantities.names import RESPONSES
from reduction.record.contributions import Component, Contributions
from reduction.report.experiment_tables import _expanded_of_coefficients, _interval_of_surfaces
from reduction.report.product_views import ExperimentView

SHARED = surface_experiment()
# of scatter alone: nothing is known that the runs share
ONE = replace(SHARED, shared=None)
SHORT = replace(surface_experiment("short", seed=4, names=RESPONSES[:1], missing=(3,)), shared=None)
RANDOM = replace(
    surface_experiment(
        "random", seed=6, names=RESPONSES[:2], specimens=("a", "b", "c"), treatment="random"
    ),
    shared=None,
)


@pytest.fixture
def quadratic(monkeypatch):
    """The law is known to be quadratic; what it may miss is held in test_surface_discrepancy.py."""
    monkeypatch.setattr("reduction.uncertainty.surface_errors.discrepancy_of", nothing_missed)


@pytest.fixture(scope="module")
def dataset():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("reduction.uncertainty.surface_errors.discrepancy_of", nothing_missed)
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
    for what in (
        "point_value", "point_value_standard_uncertainty", "point_prediction_high",
    ):  # fmt: skip
        units = dataset[f"{base}_sigma"].attrs["units"]
        assert dataset[f"{name}_{what}"].attrs["units"] == units
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


def test_a_response_without_a_surface_has_no_points():
    response = np.array(ONE.runs.response)
    response[1, 2:] = np.nan
    runs = replace(ONE.runs, response=response)
    surfaces = fit_surfaces(
        runs.level, response, factor_names=FACTORS, response_names=ONE.response_names,
        low=LOW, high=HIGH, run_names=runs.names,
    )  # fmt: skip
    bare = replace(ONE, runs=runs, surfaces=surfaces)
    dataset = surfaces_to_dataset([bare], origin=ABOUT)
    for what in ("point_value", "point_simultaneous_high"):
        assert np.isnan(dataset[f"hysteresis_energy_{what}"].values).all()
        assert np.isfinite(dataset[f"apparent_spring_constant_{what}"].values).all()
    assert not dataset["hysteresis_energy_point_is_above_leverage"].values.any()


def under_a_cell(coefficient, *, freedom=np.inf):
    """The experiment with one error that adds this to the coefficients, and nothing else shared."""
    rows = np.zeros_like(SHARED.shared.coefficient)
    rows[0] = coefficient
    shared = SharedSurfaces(
        component=(Component("tension_gain", "load cell", degrees_of_freedom=freedom),),
        coefficient=rows,
        coefficient_engineering=rows @ SHARED.surfaces.engineering_matrix.T,
    )
    return replace(SHARED, shared=shared)


@pytest.mark.usefixtures("quadratic")
@pytest.mark.parametrize("freedom", [np.inf, 2.0])
def test_a_gain_of_all_runs_widens_every_interval_by_welch_and_satterthwaite(freedom):
    surfaces = ONE.surfaces
    found = point_values(
        surfaces, ONE.runs.coded_plan, under_a_cell(0.03 * surfaces.coefficient, freedom=freedom).shared
    )  # fmt: skip
    name = "apparent_spring_constant"
    plain = evaluate_surfaces(surfaces, found["point_coded_level"], units="coded", outside="flag")
    value = plain.value[0]
    gain, own = 0.03 * value, plain.fitted_standard_uncertainty[0]
    run = np.sqrt(own**2 + surfaces.sigma[0] ** 2)
    np.testing.assert_allclose(found[f"{name}_point_value_uncertainty_contribution"][0], gain)
    np.testing.assert_allclose(found[f"{name}_point_value_random_standard_uncertainty"], own)
    np.testing.assert_allclose(
        found[f"{name}_point_value_standard_uncertainty"], np.hypot(own, gain)
    )
    for kind, random in (("confidence", own), ("prediction", run), ("simultaneous", own)):
        u = np.hypot(random, gain)
        nu = u**4 / (random**4 / 5 + gain**4 / freedom)
        k = stats.t.ppf(0.975, nu)
        if kind == "simultaneous":
            k = np.sqrt(10 * stats.f.ppf(0.95, 10, nu))
        for end, sign in (("low", -1), ("high", 1)):
            np.testing.assert_allclose(
                found[f"{name}_point_{kind}_{end}"], value + sign * k * u, rtol=1e-9
            )


@pytest.mark.usefixtures("quadratic")
def test_a_point_of_a_logarithm_has_the_uncertainty_of_the_response():
    name, base = "log_hysteresis_energy", "hysteresis_energy"
    index = ONE.surfaces.response_names.index(name)
    rows = np.zeros_like(ONE.surfaces.coefficient)
    rows[index, 0] = 0.02  # two per cent of all
    result = under_a_cell(rows)
    dataset = surfaces_to_dataset([result], origin=ABOUT)
    value = dataset[f"{name}_point_value"].values[0]
    spread = dataset[f"{name}_point_value_standard_uncertainty"]
    scaled = evaluate_surfaces(
        ONE.surfaces, dataset["point_coded_level"].values[0], units="coded", outside="flag"
    ).fitted_standard_uncertainty[index]
    # a small change of a logarithm is that share of the response
    u = np.hypot(scaled, 0.02)
    np.testing.assert_allclose(spread.values[0], value * u, rtol=2e-3)
    assert spread.attrs["units"] == dataset[f"{base}_sigma"].attrs["units"]
    k = stats.t.ppf(0.975, u**4 / (scaled**4 / 5))
    np.testing.assert_allclose(
        dataset[f"{name}_point_confidence_high"].values[0], value * np.exp(k * u), rtol=1e-9
    )
    np.testing.assert_allclose(
        dataset[f"{name}_point_confidence_low"].values[0], value * np.exp(-k * u), rtol=1e-9
    )


def test_a_gain_moves_curvatures_by_its_share_and_no_stationary_point():
    result = under_a_cell(0.03 * ONE.surfaces.coefficient)
    dataset = surfaces_to_dataset([result], origin=ABOUT)
    name = "apparent_spring_constant"
    np.testing.assert_allclose(
        dataset[f"{name}_eigenvalue_uncertainty_contribution"].values[0, 0],
        0.03 * dataset[f"{name}_eigenvalue"].values[0],
    )
    np.testing.assert_allclose(
        dataset[f"{name}_stationary_point_uncertainty_contribution"].values[0, 0], 0.0, atol=1e-12
    )


def test_a_shared_error_moves_stationary_points_and_curvatures_as_a_surface_moved_by_it():
    step = 1e-5 * np.random.default_rng(5).normal(size=10) * ONE.surfaces.sigma[0]
    rows = np.zeros_like(ONE.surfaces.coefficient)
    rows[0] = step
    dataset = surfaces_to_dataset([under_a_cell(rows)], origin=ABOUT)
    there = [
        canonical_analysis(
            ONE.surfaces.coefficient[:1] + side * step, ONE.surfaces.exponents,
            covariance_factor=ONE.surfaces.covariance_factor[:1], pattern=np.array([0]),
            sigma=[0.0], low=LOW, high=HIGH,
        )
        for side in (1, -1)
    ]  # fmt: skip
    for what, field in (("stationary_point", "stationary_point"), ("eigenvalue", "eigenvalue")):
        moved = (getattr(there[0], field) - getattr(there[1], field))[0] / 2
        found = dataset[f"apparent_spring_constant_{what}_uncertainty_contribution"].values[0, 0]
        np.testing.assert_allclose(found, moved, rtol=1e-4, atol=1e-12)


def test_a_run_holds_what_it_shares_and_one_that_does_not_keep_it_says_so():
    name = "apparent_spring_constant"
    known = SHARED.runs.shared
    table = {one: np.array(row) for one, row in known.values.items()}
    table[name][:, 2] = np.nan
    runs = replace(SHARED.runs, shared=Contributions(known.component, table))
    dataset = surfaces_to_dataset([replace(SHARED, runs=runs)], origin=ABOUT)
    value = dataset[f"{name}_measured"].values[0]
    both = dataset[f"{name}_measured_standard_uncertainty"].values[0]
    # 0.2 % of its own, 1 % of gain
    np.testing.assert_allclose(np.delete(both / value, 2), np.hypot(0.002, 0.01))
    assert np.isnan(both[2])
    random = dataset[f"{name}_measured_random_standard_uncertainty"].values[0]
    np.testing.assert_allclose(random / value, 0.002)


@pytest.mark.parametrize("name", ["apparent_spring_constant", "log_hysteresis_energy"])
def test_point_look_up_page_and_budget_say_one_interval(name):
    """The middle of the plan, where a surface is its first coefficient."""
    dataset = surfaces_to_dataset([SHARED], origin=ABOUT)
    response = name.removeprefix("log_")
    at = at_points(dataset, name)
    view = ExperimentView("k", dataset, 0)
    index = view.surfaces.response_names.index(name)
    low, high = _interval_of_surfaces(view, view.surfaces, np.zeros((1, 3)))
    line = _line_source_of_experiment(dataset, "half-inch")
    centre = dict(zip(line.factor_names, (LOW + HIGH) / 2, strict=True))
    found = look_up(line, response, **centre)
    assert at["confidence_low"][0] == pytest.approx(float(found.surface_low), rel=1e-9)
    assert at["confidence_high"][0] == pytest.approx(float(found.surface_high), rel=1e-9)
    assert at["prediction_high"][0] == pytest.approx(float(found.high), rel=1e-9)
    assert low[index, 0] == pytest.approx(at["confidence_low"][0], rel=1e-9)
    assert high[index, 0] == pytest.approx(at["confidence_high"][0], rel=1e-9)
    (b1,) = [
        one for one in all_budgets(dataset, f"{name}_coefficient")
        if one.place == {"experiment": "half-inch", "term": "B1"}
    ]  # fmt: skip
    (point,) = [
        one for one in all_budgets(dataset, f"{name}_point_value") if one.place["point"] == "1"
    ]
    # runs a hundredth off the plan: the middle is a run, but for a trace of what a quadratic misses
    assert point.coverage_factor == pytest.approx(b1.coverage_factor, rel=1e-2)
    if name == response:
        half = point.expanded_uncertainty
        assert at["confidence_high"][0] - at["value"][0] == pytest.approx(half, rel=1e-9)
        assert half == pytest.approx(b1.expanded_uncertainty, rel=1e-2)
        coefficient = _expanded_of_coefficients(view, view.surfaces, index)
        assert coefficient.all.half[0] == pytest.approx(b1.expanded_uncertainty, rel=1e-9)
