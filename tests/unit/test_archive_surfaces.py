"""Experiments become one dataset with the names, dimensions and units of its schema."""

from dataclasses import replace

import netCDF4
import numpy as np
import pytest
import xarray as xr
from archive_check import check_archive
from experiments import ABOUT, STRENGTH, screening_experiment, surface_experiment

from reduction.archive.open import open_archive
from reduction.archive.surfaces_dataset import surfaces_to_dataset
from reduction.archive.write import write_archive
from reduction.quantities.names import RESPONSES, SURFACE_SCHEMA
from reduction.record.errors import ArchiveError
from reduction.record.notes import Note

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
