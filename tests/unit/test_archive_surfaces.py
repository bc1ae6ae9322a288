"""Experiments become one dataset with the names, dimensions and units of its schema."""

from dataclasses import fields, is_dataclass, replace

import netCDF4
import numpy as np
import pytest
import statsmodels.api as sm
import xarray as xr
from archive_check import check_archive
from experiments import (
    ABOUT,
    FACTORS,
    HIGH,
    LOW,
    STRENGTH,
    nothing_missed,
    screening_experiment,
    surface_experiment,
)
from scipy import stats

from reduction.archive.open import open_archive
from reduction.archive.surfaces_dataset import (
    alias_values,
    effect_values,
    point_values,
    surface_names,
    surfaces_of,
    surfaces_to_dataset,
)
from reduction.archive.uncertainty_budget import all_budgets
from reduction.archive.write import write_archive
from reduction.experiments.designs import box_behnken, model_matrix, plackett_burman
from reduction.experiments.experiment import SharedSurfaces
from reduction.experiments.response_surfaces import fit_surfaces
from reduction.experiments.screening import alias_matrix, screening_effects
from reduction.experiments.stationary_point import canonical_analysis
from reduction.experiments.surface_points import evaluate_surfaces
from reduction.lines.archive_source import _line_source_of_experiment
from reduction.lines.line_lookup import look_up
from reduction.quantities.names import RESPONSES, SURFACE_SCHEMA
from reduction.record.contributions import Component, Contributions
from reduction.record.errors import ArchiveError
from reduction.record.notes import Note
from reduction.report.experiment_tables import _expanded_of_coefficients, _interval_of_surfaces
from reduction.report.product_views import ExperimentView

ONE = surface_experiment()
SHORT = surface_experiment("short", seed=4, names=RESPONSES[:1], missing=(3,))
LINES = surface_experiment("lines", seed=5, names=RESPONSES[:2], specimens=("a", "b"))
SCREENING = screening_experiment()


def build(*results):
    return surfaces_to_dataset(results, origin=ABOUT)


@pytest.fixture(scope="module")
def dataset():
    return build(ONE, SHORT, LINES, SCREENING)


@pytest.fixture
def path(dataset, tmp_path):
    write_archive(dataset, tmp_path / "surfaces.nc")
    return tmp_path / "surfaces.nc"


def test_it_comes_back_from_the_disk_as_it_was(dataset, path):
    assert check_archive(path) == []
    with open_archive(path) as back:
        assert len(back.attrs.pop("values_sha256")) == 64  # of the file
        xr.testing.assert_identical(dataset, back.load())


def test_two_writes_of_one_result_are_the_same_bytes(dataset, path, tmp_path):
    write_archive(build(ONE, SHORT, LINES, SCREENING), tmp_path / "again.nc")
    assert (tmp_path / "again.nc").read_bytes() == path.read_bytes()


@pytest.mark.parametrize(
    ("name", "dims", "units"),
    [
        ("apparent_spring_constant_coefficient", ("experiment", "term"), "N"),
        (
            "apparent_spring_constant_coefficient_standard_uncertainty",
            ("experiment", "term"),
            "N",
        ),
        ("apparent_spring_constant_p_value", ("experiment", "term"), "1"),
        ("hysteresis_energy_coefficient_engineering", ("experiment", "term"), "J m-1"),
        ("hysteresis_energy_covariance_factor", ("experiment", "term", "term_other"), "1"),
        ("hysteresis_energy_anova_sum_of_squares", ("experiment", "anova_row"), "J2 m-2"),
        ("relaxation_time_sigma", ("experiment",), "s"),
        ("dashpot_coefficient_residual", ("experiment", "run"), "N s"),
        ("log_hysteresis_energy_coefficient", ("experiment", "term"), "1"),
        ("box_cox_dissipation_spring_constant_sigma", ("experiment",), "1"),
        ("loss_factor_stationary_point", ("experiment", "factor"), "1"),
        ("storage_spring_constant_eigenvalue", ("experiment", "direction"), "N"),
        ("hysteresis_energy_effect", ("experiment", "plan_column"), "J m-1"),
        ("hysteresis_energy_effect_standard_uncertainty", ("experiment",), "J m-1"),
        ("run_mean_tension", ("experiment", "run"), "N"),
        ("stiffness_fitted", ("experiment", "stiffness_form", "run"), "N"),
    ],
)
def test_names_dimensions_and_units(dataset, name, dims, units):
    assert dataset[name].dims == dims
    assert dataset[name].attrs["units"] == units
    assert dataset[name].attrs["long_name"]


def test_coefficients_stand_in_printed_order_with_their_terms(dataset):
    assert dataset["term"].values.tolist() == [f"B{n}" for n in range(1, 11)]
    assert dataset["term_name"].values[0].tolist() == list(ONE.surfaces.term_names)
    np.testing.assert_array_equal(
        dataset["loss_factor_coefficient"].values[0],
        ONE.surfaces.coefficient[RESPONSES.index("loss_factor")],
    )
    assert dataset["term_unit_engineering"].values[0].tolist()[:5] == [
        "1", "Hz-2", "N-2", "N-2", "Hz-1",
    ]  # fmt: skip


def test_the_engineering_coefficients_are_those_of_numbers_in_si(dataset):
    """At a run's own levels the engineering equation gives what was fitted to it."""
    level = dataset["run_level"].values[0, :15, :3]
    power = dataset["term_exponent"].values[0, :, :3]
    terms = np.prod(level[:, None, :] ** power, axis=-1)
    for name in ("apparent_spring_constant", "log_hysteresis_energy"):
        value = terms @ dataset[f"{name}_coefficient_engineering"].values[0]
        np.testing.assert_allclose(value, dataset[f"{name}_fitted"].values[0, :15], rtol=1e-9)


def test_what_the_runs_share_stands_beside_their_scatter(dataset):
    """A load cell 1 % too high: K_ap, and the levels at which it is said to hold."""
    name = "apparent_spring_constant_coefficient"
    assert dataset["uncertainty_source"].values[0].tolist() == ["tension_gain"]
    (shared,) = dataset[f"{name}_uncertainty_contribution"].values[0]
    random = dataset[f"{name}_random_standard_uncertainty"].values[0]
    both = dataset[f"{name}_standard_uncertainty"].values[0]
    np.testing.assert_allclose(both, np.hypot(shared, random), rtol=1e-12)
    # in engineering units a tension that reads 1 % high has a slope 1 % low, and so a level:
    # what stands with neither tension is 1 % high, with one tension as it was, with two 1 % low
    coefficient = dataset[f"{name}_engineering"].values[0]
    (found,) = dataset[f"{name}_engineering_uncertainty_contribution"].values[0]
    tensions = dataset["term_exponent"].values[0, :, 1:3].sum(axis=1)
    np.testing.assert_allclose(
        found, 0.01 * (1 - tensions) * coefficient, atol=2e-4 * abs(coefficient).max()
    )


def test_the_covariance_carries_over_to_engineering_units(dataset):
    """As a fit to the levels themselves has it."""
    level = dataset["run_level"].values[0, :15, :3]
    power = dataset["term_exponent"].values[0, :, :3]
    terms = np.prod((level[:, None, :] / level.max(axis=0)) ** power, axis=-1)
    scale = np.prod(level.max(axis=0) ** power, axis=-1)
    sigma = float(dataset["loss_factor_sigma"].values[0])
    expected = np.sqrt(np.diag(np.linalg.inv(terms.T @ terms))) * sigma / scale
    found = dataset["loss_factor_coefficient_engineering_random_standard_uncertainty"].values[0]
    np.testing.assert_allclose(found, expected, rtol=1e-6)


def test_what_an_experiment_lacks_is_nan_empty_or_nil(dataset):
    assert np.isnan(dataset["loss_factor_coefficient"].values[1:]).all()
    assert set(dataset["loss_factor_transform"].values[1:].tolist()) == {""}
    assert dataset["run_name"].values[0, 15:].tolist() == [""] * 15
    assert np.isnan(dataset["run_level"].values[0, :15, 3:]).all()
    assert dataset["run_cell"].values[3].tolist() == [0] * 30
    assert np.isnan(dataset["apparent_spring_constant_effect"].values[:3]).all()


def test_a_missing_run_keeps_its_place_its_plan_and_its_reason(dataset):
    assert dataset["run_name"].values[1, 3] == "R04"
    assert dataset["run_remark"].values[1, 3] == "its test gave no results"
    np.testing.assert_array_equal(dataset["run_plan"].values[1, 3, :3], [1, 1, 0])
    for name in ("run_level", "run_mean_tension", "apparent_spring_constant_measured"):
        assert np.isnan(dataset[name].values[1, 3]).all()
    assert dataset["run_rated_break_strength"].values[1, 3] == STRENGTH
    assert dataset["apparent_spring_constant_n_runs"].values.tolist()[:3] == [15, 14, 30]


def test_repeats_share_a_number(dataset):
    cell = dataset["run_cell"].values[0, :15]
    assert len(set(cell[12:])) == 1
    assert len(set(cell)) == 13


def test_specimens_stand_as_blocks(dataset):
    assert dataset["block_name"].values[2].tolist() == ["a", "b"]
    assert dataset["run_block"].values[2, :4].tolist() == ["a", "b", "a", "b"]
    assert dataset["block_treatment"].values.tolist() == ["", "", "fixed", ""]


def test_the_covariance_of_a_form_ends_where_its_coefficients_do(dataset):
    covariance = dataset["stiffness_covariance"].values[0]
    np.testing.assert_array_equal(covariance[0], ONE.stiffness_forms[0].covariance)
    np.testing.assert_array_equal(covariance[1, :2, :2], ONE.stiffness_forms[1].covariance)
    assert np.isnan(covariance[1, 2:]).all()
    assert np.isnan(covariance[2]).all()


def test_notes_say_of_what_they_are_and_none_stands_twice(dataset):
    rows = list(
        zip(*(dataset[f"note{part}"].values for part in ("_experiment", "_stage", "")), strict=True)
    )
    assert len(rows) == len(set(rows))
    assert ("half-inch", "experiment", "=a note that looks like a formula") in rows
    of_surfaces = [text for name, stage, text in rows if (name, stage) == ("lines", "surfaces")]
    assert of_surfaces == list(map(str, LINES.surfaces.notes))


def test_cautions_give_the_names_of_the_runs_that_they_count(dataset):
    assert dataset["caution_kind"].values[:2].tolist() == ["slack", "no-repeats"]
    assert dataset["caution_runs"].values[:2].tolist() == ["R02", ""]
    place = dataset["caution_experiment"].values.tolist().index("lines")
    # a run is one run however many specimens are pulled in it
    assert dataset["caution_runs"].values[place] == "R02"


def test_provenance_is_complete(dataset):
    found = dataset.attrs
    assert found["Conventions"] == "CF-1.11 ACDD-1.3"
    assert found["title"] == "Nylon line (synthetic data)"
    assert found["synthetic"] == "yes"
    assert found["id"] == "nylon/surfaces"
    assert found["campaign"] == "nylon"
    assert found["raw_file"] == "R01.nc\nR02.nc"
    assert found["raw_file_sha256"].split() == ["ab" * 32, "cd" * 32]
    assert found["history"] == "reduction 1.2.3 surface: fitted 4 responses over 15 runs"
    assert found["settings"] == "{}"
    assert found["summary"].startswith("Response surfaces and effects of experiment half-inch and ")
    assert "test" not in found


def test_an_experiment_that_gave_no_surface_keeps_its_runs():
    bare = replace(
        SHORT,
        surfaces=None,
        stiffness_forms=(),
        form_quality=None,
        notes=(Note("fixture", "refusal", text="refused"),),
    )
    dataset = build(bare)
    assert not [name for name in dataset.variables if "coefficient" in name]
    assert dataset["run_name"].values[0, 0] == "R01"
    assert dataset["note"].values.tolist() == ["refused"]


def test_a_response_without_a_name_is_refused():
    strange = replace(SHORT, response_names=("colour",))
    with pytest.raises(ArchiveError, match="has no name in the archive; found colour"):
        build(strange)


def test_the_own_check_knows_the_names_of_experiments(path):
    with netCDF4.Dataset(path, "a") as file:
        file.createVariable("tension", "f8", ("run",))
        file["stationary_point/apparent_spring_constant_stationary_kind"][0] = 9
    assert check_archive(path) == [
        "tension is not in the schema",
        "apparent_spring_constant_stationary_kind has values without a meaning",
    ]


def test_a_number_has_an_uncertainty_or_a_reason_for_none():
    for name, row in SURFACE_SCHEMA.items():
        assert row.has_uncertainty != bool(row.no_uncertainty), name
        assert row.is_text == (row.unit == ""), name
        assert set(row.ancillary) <= set(SURFACE_SCHEMA), name


def test_the_examples_fill_every_variable_of_a_response(dataset):
    missing = {
        name
        for name in set(SURFACE_SCHEMA) - set(dataset.variables)
        if name.startswith(("apparent_spring_constant", "log_hysteresis_energy"))
        or not any(response in name for response in RESPONSES)
    }
    # where nothing was refused no text is kept, and all errors of the example are stated ones
    few = "uncertainty_source_degrees_of_freedom"
    assert all(name.endswith("_refusal") or name == few for name in missing)


# effects and aliases of a screening stand in the archive, each in its own place

BROKEN = screening_experiment("broken", missing=(4,))


@pytest.fixture(scope="module")
def dataset_of_effects():
    return surfaces_to_dataset([SCREENING, BROKEN], origin=ABOUT)


def test_an_interaction_stands_in_every_other_column_with_a_third(dataset_of_effects):
    """Of twelve runs, dummies included: nil in its own two factors."""
    alias = dataset_of_effects["effect_alias"].values[0]
    one, other = (
        dataset_of_effects[f"interaction{which}_factor"].values[0].tolist()
        for which in ("", "_other")
    )
    columns = dataset_of_effects["plan_column_name"].values[0].tolist()
    assert alias.shape == (10, 11)
    assert list(zip(one, other, strict=True))[:2] == [
        ("frequency", "mean_tension"), ("frequency", "tension_amplitude"),
    ]  # fmt: skip
    for row, pair in zip(alias, zip(one, other, strict=True), strict=True):
        for share, column in zip(row, columns, strict=True):
            expected = 0 if column in pair else 1 / 3
            assert abs(share) == pytest.approx(expected, abs=1e-12)


def test_aliases_of_the_factors_are_those_of_alias_matrix(dataset_of_effects):
    pairs, alias = alias_matrix(plackett_burman(5).coded)
    assert len(pairs) == 10
    np.testing.assert_allclose(
        dataset_of_effects["effect_alias"].values[0, :, :5].T, alias[1:], atol=1e-12
    )


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


def test_a_screening_that_misses_a_run_has_its_aliases_and_no_points(dataset_of_effects):
    assert np.isnan(dataset_of_effects["hysteresis_energy_effect"].values[1]).all()
    np.testing.assert_array_equal(
        dataset_of_effects["effect_alias"].values[1], dataset_of_effects["effect_alias"].values[0]
    )


# surfaces come out of their archive as they went in, and are evaluated from the file alone

RESULTS = (
    surface_experiment(),
    surface_experiment("short", seed=4, names=RESPONSES[:2], missing=(3,)),
    surface_experiment("blocks", seed=5, names=RESPONSES[:1], specimens=("a", "b")),
    surface_experiment("random", seed=6, names=RESPONSES[:2], specimens=("a", "b", "c"),
                       treatment="random", missing=(0, 1)),
    screening_experiment(),
)  # fmt: skip
SURFACES = [result for result in RESULTS if result.surfaces is not None]


@pytest.fixture(scope="module")
def archive(tmp_path_factory):
    path = tmp_path_factory.mktemp("surfaces") / "surfaces.nc"
    write_archive(surfaces_to_dataset(RESULTS, origin=ABOUT), path)
    with open_archive(path) as dataset:
        yield dataset


def of_responses(thing, index, count, name=""):
    """One response of every array that has them on its first axis."""
    if is_dataclass(thing):
        return {
            item.name: of_responses(getattr(thing, item.name), index, count, item.name)
            for item in fields(thing)
        }
    if name in ("low", "high", "coded", "exponents", "engineering_matrix", "cell", "index"):
        return thing
    if isinstance(thing, np.ndarray):
        return thing[index]
    if name == "notes":  # a file has the sentence, not the numbers in it
        return [(one.code, one.severity, str(one)) for one in thing]
    return thing[index] if name in ("response_names", "transform") else thing


def assert_same(found, wanted, where=""):
    for name, one in wanted.items():
        other = found[name]
        if isinstance(one, dict):
            assert_same(other, one, f"{where}{name}.")
        elif isinstance(one, np.ndarray | np.generic):
            np.testing.assert_array_equal(other, one, err_msg=f"{where}{name}")
        else:
            assert other == one, f"{where}{name}"


def with_own_patterns(surfaces):
    """The same surfaces with a pattern each, as a file has them."""
    return replace(
        surfaces,
        covariance_factor=surfaces.covariance_factor[surfaces.pattern],
        is_used=surfaces.is_used[surfaces.pattern],
        pattern=np.arange(len(surfaces.pattern)),
    )


@pytest.mark.parametrize("result", SURFACES, ids=lambda result: result.name)
def test_every_field_of_every_surface_comes_back_to_the_last_bit(archive, result):
    names = surface_names(archive, result.name)
    assert set(names) == set(result.surfaces.response_names)
    found, wanted = surfaces_of(archive, result.name), with_own_patterns(result.surfaces)
    assert found.response_names == names
    for row, name in enumerate(names):
        place = wanted.response_names.index(name)
        of_file = of_responses(found, row, len(names))
        of_file["pattern"] = place
        assert_same(of_file, of_responses(wanted, place, len(names)))


@pytest.mark.parametrize("result", SURFACES, ids=lambda result: result.name)
def test_a_surface_is_evaluated_from_the_file_alone(archive, result):
    rng = np.random.default_rng(8)
    points = rng.uniform(LOW, HIGH, (20, 3))
    wanted = evaluate_surfaces(result.surfaces, points)
    from_file = surfaces_of(archive, result.name)
    found = evaluate_surfaces(from_file, points)
    for row, name in enumerate(result.surfaces.response_names):
        place = from_file.response_names.index(name)
        for field in (
            "value", "mean_value", "variance_factor", "confidence_interval",
            "prediction_interval", "simultaneous_interval", "above_leverage",
        ):  # fmt: skip
            np.testing.assert_allclose(
                getattr(found, field)[place], getattr(wanted, field)[row], rtol=1e-12, err_msg=field
            )


def test_the_covariance_in_the_file_gives_the_uncertainty_in_the_file(archive):
    for name in surface_names(archive, "half-inch"):
        factor, sigma, deviation = (
            archive[f"{name}_{what}"].values[0]
            for what in ("covariance_factor", "sigma", "coefficient_random_standard_uncertainty")
        )
        np.testing.assert_allclose(np.sqrt(np.diag(factor)) * sigma, deviation, rtol=1e-12)


def test_a_screening_has_no_surface(archive):
    assert surface_names(archive, "screening") == ()
    with pytest.raises(ArchiveError, match="'screening' has no surface"):
        surfaces_of(archive, "screening")


def test_an_experiment_that_is_not_there_is_refused(archive, archives):
    with pytest.raises(ArchiveError, match=r"no such experiment; found one-inch; needed half-inch"):
        surfaces_of(archive, "one-inch")
    with (
        open_archive(archives[0]) as test,
        pytest.raises(ArchiveError, match=r"needed an archive of experiments"),
    ):
        surface_names(test, "half-inch")


def test_a_response_that_cannot_be_fitted_comes_back_with_its_reason():
    result = SURFACES[0]
    response = np.array(result.runs.response)
    response[1, 2:] = np.nan
    response[2] = 5.0
    runs = replace(result.runs, response=response)
    surfaces = fit_surfaces(
        runs.level, response, factor_names=FACTORS, response_names=result.response_names,
        low=LOW, high=HIGH, run_names=runs.names,
    )  # fmt: skip
    assert surfaces.reason.tolist()[:3] == [0, 1, 4]
    about = replace(result, runs=runs, surfaces=surfaces, shared=None)
    found = surfaces_of(surfaces_to_dataset([about], origin=ABOUT), result.name)
    np.testing.assert_array_equal(found.reason, surfaces.reason)
    np.testing.assert_array_equal(found.is_used, surfaces.is_used[surfaces.pattern])
    np.testing.assert_array_equal(found.coefficient, surfaces.coefficient)


# surfaces at named points stand in the archive as they are elsewhere

SHARED = surface_experiment()
# of scatter alone: nothing is known that the runs share
ONE_OF_POINTS = replace(SHARED, shared=None)
SHORT_OF_POINTS = replace(
    surface_experiment("short", seed=4, names=RESPONSES[:1], missing=(3,)), shared=None
)
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
def dataset_of_points():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("reduction.uncertainty.surface_errors.discrepancy_of", nothing_missed)
        return surfaces_to_dataset([ONE_OF_POINTS, SHORT_OF_POINTS, RANDOM], origin=ABOUT)


def at_points(dataset_of_points, name, row=0):
    return {
        what: dataset_of_points[f"{name}_point_{what}"].values[row]
        for what in (
            "value", "mean_value", "confidence_low", "confidence_high", "prediction_low",
            "prediction_high", "simultaneous_low", "simultaneous_high", "variance_factor",
            "is_above_leverage",
        )
    }  # fmt: skip


@pytest.mark.parametrize("row", [0, 1])
def test_points_and_intervals_are_those_of_statsmodels(dataset_of_points, row):
    result = (ONE_OF_POINTS, SHORT_OF_POINTS)[row]
    surfaces, response = result.surfaces, result.runs.response[0]
    has = np.isfinite(response)
    coded = dataset_of_points["point_coded_level"].values[row]
    terms = model_matrix(coded, surfaces.exponents)
    runs = model_matrix(surfaces.coded[has], surfaces.exponents)
    other = sm.OLS(response[has], runs).fit()
    frame = other.get_prediction(terms).summary_frame(alpha=0.05)
    found = at_points(dataset_of_points, "apparent_spring_constant", row)
    for name, column in (
        ("value", "mean"),
        ("mean_value", "mean"),
        ("confidence_low", "mean_ci_lower"),
        ("confidence_high", "mean_ci_upper"),
        ("prediction_low", "obs_ci_lower"),
        ("prediction_high", "obs_ci_upper"),
    ):
        np.testing.assert_allclose(found[name], frame[column], rtol=1e-8, err_msg=name)
    spread = dataset_of_points["apparent_spring_constant_point_value_standard_uncertainty"].values[
        row
    ]
    np.testing.assert_allclose(spread, frame["mean_se"], rtol=1e-8)
    reach = np.sqrt(10 * stats.f.ppf(0.95, 10, has.sum() - 10))
    np.testing.assert_allclose(
        found["simultaneous_high"] - found["value"], reach * spread, rtol=1e-7
    )
    np.testing.assert_allclose(
        found["value"] - found["simultaneous_low"], reach * spread, rtol=1e-7
    )
    assert dataset_of_points["interval_confidence"].values[row] == 0.95


def test_the_cube_of_three_factors_has_21_points_in_engineering_units(dataset_of_points):
    assert dataset_of_points["point"].values.tolist() == list(range(1, 22))
    assert dataset_of_points["point_name"].values[0, [0, 1, 13]].tolist() == [
        "(0, 0, 0)", "(-1, -1, 0)", "(-1, -1, -1)",
    ]  # fmt: skip
    assert dataset_of_points["point_kind"].values[0, [0, 1, 13]].tolist() == [
        "centre", "edge midpoint", "corner",
    ]  # fmt: skip
    np.testing.assert_allclose(dataset_of_points["point_level"].values[0, 0], [0.3, 5950, 2125])
    np.testing.assert_allclose(dataset_of_points["point_level"].values[0, 13], LOW)
    np.testing.assert_allclose(dataset_of_points["point_level"].values[0, 20], HIGH)


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
def test_a_transformed_response_comes_back_to_its_own_unit(dataset_of_points, name):
    base = name.removeprefix("log_").removeprefix("box_cox_")
    index = ONE_OF_POINTS.surfaces.response_names.index(name)
    coded = dataset_of_points["point_coded_level"].values[0]
    fitted = (
        model_matrix(coded, ONE_OF_POINTS.surfaces.exponents)
        @ ONE_OF_POINTS.surfaces.coefficient[index]
    )
    power = ONE_OF_POINTS.surfaces.transform_exponent[index]
    expected = np.exp(fitted) if name.startswith("log_") else (1 + power * fitted) ** (1 / power)
    found = at_points(dataset_of_points, name)
    np.testing.assert_allclose(found["value"], expected, rtol=1e-9)
    assert (found["confidence_low"] < expected).all()
    assert (found["confidence_high"] > expected).all()
    for what in (
        "point_value", "point_value_standard_uncertainty", "point_prediction_high",
    ):  # fmt: skip
        units = dataset_of_points[f"{base}_sigma"].attrs["units"]
        assert dataset_of_points[f"{name}_{what}"].attrs["units"] == units
    words = dataset_of_points[f"{name}_point_value"].attrs["long_name"]
    assert words.startswith(f"{base.replace('_', ' ')}, by the ")


@pytest.mark.parametrize("row", [0, 1, 2])
def test_every_surface_is_that_of_evaluate_surfaces(dataset_of_points, row):
    result = (ONE_OF_POINTS, SHORT_OF_POINTS, RANDOM)[row]
    coded = dataset_of_points["point_coded_level"].values[row]
    wanted = evaluate_surfaces(result.surfaces, coded, units="coded")
    for index, name in enumerate(result.surfaces.response_names):
        found = at_points(dataset_of_points, name, row)
        np.testing.assert_array_equal(found["value"], wanted.value[index])
        np.testing.assert_array_equal(found["mean_value"], wanted.mean_value[index])
        np.testing.assert_array_equal(found["variance_factor"], wanted.variance_factor[index])
        np.testing.assert_array_equal(found["is_above_leverage"], wanted.above_leverage[index])
        for kind in ("confidence", "prediction", "simultaneous"):
            ends = np.stack([found[f"{kind}_low"], found[f"{kind}_high"]], axis=-1)
            np.testing.assert_array_equal(ends, getattr(wanted, f"{kind}_interval")[index])


def test_points_of_random_specimens_foresee_another_specimen(dataset_of_points):
    found = at_points(dataset_of_points, "apparent_spring_constant", 2)
    spread = dataset_of_points["apparent_spring_constant_point_value_standard_uncertainty"].values[
        2
    ]
    half = (found["prediction_high"] - found["prediction_low"]) / 2
    own = (found["confidence_high"] - found["confidence_low"]) / 2
    blocks = RANDOM.surfaces.blocks.standard_deviation[0]
    sigma = RANDOM.surfaces.sigma[0]
    np.testing.assert_allclose(
        half / own, np.sqrt(sigma**2 + blocks**2 + spread**2) / spread, rtol=1e-9
    )


def test_a_response_without_a_surface_has_no_points():
    response = np.array(ONE_OF_POINTS.runs.response)
    response[1, 2:] = np.nan
    runs = replace(ONE_OF_POINTS.runs, response=response)
    surfaces = fit_surfaces(
        runs.level, response, factor_names=FACTORS, response_names=ONE_OF_POINTS.response_names,
        low=LOW, high=HIGH, run_names=runs.names,
    )  # fmt: skip
    bare = replace(ONE_OF_POINTS, runs=runs, surfaces=surfaces)
    dataset_of_points = surfaces_to_dataset([bare], origin=ABOUT)
    for what in ("point_value", "point_simultaneous_high"):
        assert np.isnan(dataset_of_points[f"hysteresis_energy_{what}"].values).all()
        assert np.isfinite(dataset_of_points[f"apparent_spring_constant_{what}"].values).all()
    assert not dataset_of_points["hysteresis_energy_point_is_above_leverage"].values.any()


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
    surfaces = ONE_OF_POINTS.surfaces
    found = point_values(
        surfaces, ONE_OF_POINTS.runs.coded_plan, under_a_cell(0.03 * surfaces.coefficient, freedom=freedom).shared
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
    index = ONE_OF_POINTS.surfaces.response_names.index(name)
    rows = np.zeros_like(ONE_OF_POINTS.surfaces.coefficient)
    rows[index, 0] = 0.02  # two per cent of all
    result = under_a_cell(rows)
    dataset_of_points = surfaces_to_dataset([result], origin=ABOUT)
    value = dataset_of_points[f"{name}_point_value"].values[0]
    spread = dataset_of_points[f"{name}_point_value_standard_uncertainty"]
    scaled = evaluate_surfaces(
        ONE_OF_POINTS.surfaces,
        dataset_of_points["point_coded_level"].values[0],
        units="coded",
        outside="flag",
    ).fitted_standard_uncertainty[index]
    # a small change of a logarithm is that share of the response
    u = np.hypot(scaled, 0.02)
    np.testing.assert_allclose(spread.values[0], value * u, rtol=2e-3)
    assert spread.attrs["units"] == dataset_of_points[f"{base}_sigma"].attrs["units"]
    k = stats.t.ppf(0.975, u**4 / (scaled**4 / 5))
    np.testing.assert_allclose(
        dataset_of_points[f"{name}_point_confidence_high"].values[0],
        value * np.exp(k * u),
        rtol=1e-9,
    )
    np.testing.assert_allclose(
        dataset_of_points[f"{name}_point_confidence_low"].values[0],
        value * np.exp(-k * u),
        rtol=1e-9,
    )


def test_a_gain_moves_curvatures_by_its_share_and_no_stationary_point():
    result = under_a_cell(0.03 * ONE_OF_POINTS.surfaces.coefficient)
    dataset_of_points = surfaces_to_dataset([result], origin=ABOUT)
    name = "apparent_spring_constant"
    np.testing.assert_allclose(
        dataset_of_points[f"{name}_eigenvalue_uncertainty_contribution"].values[0, 0],
        0.03 * dataset_of_points[f"{name}_eigenvalue"].values[0],
    )
    np.testing.assert_allclose(
        dataset_of_points[f"{name}_stationary_point_uncertainty_contribution"].values[0, 0],
        0.0,
        atol=1e-12,
    )


def test_a_shared_error_moves_stationary_points_and_curvatures_as_a_surface_moved_by_it():
    step = 1e-5 * np.random.default_rng(5).normal(size=10) * ONE_OF_POINTS.surfaces.sigma[0]
    rows = np.zeros_like(ONE_OF_POINTS.surfaces.coefficient)
    rows[0] = step
    dataset_of_points = surfaces_to_dataset([under_a_cell(rows)], origin=ABOUT)
    there = [
        canonical_analysis(
            ONE_OF_POINTS.surfaces.coefficient[:1] + side * step, ONE_OF_POINTS.surfaces.exponents,
            covariance_factor=ONE_OF_POINTS.surfaces.covariance_factor[:1], pattern=np.array([0]),
            sigma=[0.0], low=LOW, high=HIGH,
        )
        for side in (1, -1)
    ]  # fmt: skip
    for what, field in (("stationary_point", "stationary_point"), ("eigenvalue", "eigenvalue")):
        moved = (getattr(there[0], field) - getattr(there[1], field))[0] / 2
        found = dataset_of_points[
            f"apparent_spring_constant_{what}_uncertainty_contribution"
        ].values[0, 0]
        np.testing.assert_allclose(found, moved, rtol=1e-4, atol=1e-12)


def test_a_run_holds_what_it_shares_and_one_that_does_not_keep_it_says_so():
    name = "apparent_spring_constant"
    known = SHARED.runs.shared
    table = {one: np.array(row) for one, row in known.values.items()}
    table[name][:, 2] = np.nan
    runs = replace(SHARED.runs, shared=Contributions(known.component, table))
    dataset_of_points = surfaces_to_dataset([replace(SHARED, runs=runs)], origin=ABOUT)
    value = dataset_of_points[f"{name}_measured"].values[0]
    both = dataset_of_points[f"{name}_measured_standard_uncertainty"].values[0]
    # 0.2 % of its own, 1 % of gain
    np.testing.assert_allclose(np.delete(both / value, 2), np.hypot(0.002, 0.01))
    assert np.isnan(both[2])
    random = dataset_of_points[f"{name}_measured_random_standard_uncertainty"].values[0]
    np.testing.assert_allclose(random / value, 0.002)


@pytest.mark.parametrize("name", ["apparent_spring_constant", "log_hysteresis_energy"])
def test_point_look_up_page_and_budget_say_one_interval(name):
    """The middle of the plan, where a surface is its first coefficient."""
    dataset_of_points = surfaces_to_dataset([SHARED], origin=ABOUT)
    response = name.removeprefix("log_")
    at = at_points(dataset_of_points, name)
    view = ExperimentView("k", dataset_of_points, 0)
    index = view.surfaces.response_names.index(name)
    low, high = _interval_of_surfaces(view, view.surfaces, np.zeros((1, 3)))
    line = _line_source_of_experiment(dataset_of_points, "half-inch")
    centre = dict(zip(line.factor_names, (LOW + HIGH) / 2, strict=True))
    found = look_up(line, response, **centre)
    assert at["confidence_low"][0] == pytest.approx(float(found.surface_low), rel=1e-9)
    assert at["confidence_high"][0] == pytest.approx(float(found.surface_high), rel=1e-9)
    assert at["prediction_high"][0] == pytest.approx(float(found.high), rel=1e-9)
    assert low[index, 0] == pytest.approx(at["confidence_low"][0], rel=1e-9)
    assert high[index, 0] == pytest.approx(at["confidence_high"][0], rel=1e-9)
    (b1,) = [
        one for one in all_budgets(dataset_of_points, f"{name}_coefficient")
        if one.place == {"experiment": "half-inch", "term": "B1"}
    ]  # fmt: skip
    (point,) = [
        one
        for one in all_budgets(dataset_of_points, f"{name}_point_value")
        if one.place["point"] == "1"
    ]
    # runs a hundredth off the plan: the middle is a run, but for a trace of what a quadratic misses
    assert point.coverage_factor == pytest.approx(b1.coverage_factor, rel=1e-2)
    if name == response:
        half = point.expanded_uncertainty
        assert at["confidence_high"][0] - at["value"][0] == pytest.approx(half, rel=1e-9)
        assert half == pytest.approx(b1.expanded_uncertainty, rel=1e-2)
        coefficient = _expanded_of_coefficients(view, view.surfaces, index)
        assert coefficient.all.half[0] == pytest.approx(b1.expanded_uncertainty, rel=1e-9)
