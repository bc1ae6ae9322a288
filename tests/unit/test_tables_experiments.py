"""Tables of experiments hold the numbers of the archive, each with its unit in the row."""

import numpy as np
import pytest
from experiments import ABOUT, UNITS, screening_experiment, surface_experiment
from table_cells import table_rows

from reduction.archive.csv_definitions import EXPERIMENT_TABLES
from reduction.archive.csv_tables import _by_response
from reduction.archive.surfaces_dataset import surfaces_to_dataset
from reduction.experiments.surface_points import evaluate_surfaces
from reduction.quantities.names import RESPONSE_PATTERNS, RESPONSES, SURFACE_NAMES, SURFACE_SCHEMA
from reduction.uncertainty.surface_errors import with_shared_at_points

ONE = surface_experiment()
TWO = surface_experiment("two lines", seed=4, names=RESPONSES[:2], specimens=("a", "b"))
SCREENING = screening_experiment(missing=())
BROKEN = screening_experiment("broken", missing=(4,))
BY_NAME = {table.name: table for table in EXPERIMENT_TABLES}


@pytest.fixture(scope="module")
def dataset():
    return _by_response(surfaces_to_dataset([ONE, TWO, SCREENING, BROKEN], origin=ABOUT))


def rows_of(dataset, name):
    columns = [column.name for column in BY_NAME[name].columns]
    return [dict(zip(columns, row, strict=True)) for row in table_rows(dataset, BY_NAME[name])]


def test_a_coefficient_has_its_term_and_its_units_in_its_row(dataset):
    rows = [
        row
        for row in rows_of(dataset, "surfaces")
        if (row["experiment"], row["response"]) == ("half-inch", "hysteresis_energy")
    ]
    assert [row["term"] for row in rows] == [f"B{n}" for n in range(1, 11)]
    surfaces = ONE.surfaces
    assert [row["term_name"] for row in rows] == list(surfaces.term_names)
    assert [row["response_coefficient"] for row in rows] == surfaces.coefficient[1].tolist()
    assert [row["response_p_value"] for row in rows] == surfaces.p_value[1].tolist()
    assert (
        rows[7]["response_coefficient_engineering_standard_uncertainty"]
        == surfaces.coefficient_engineering_standard_uncertainty[1, 7]
    )
    assert {row["unit"] for row in rows} == {"J m-1"}
    assert [row["coefficient_engineering_unit"] for row in rows] == [
        "J m-1", "J m-1 Hz-2", "J m-1 N-2", "J m-1 N-2", "J m-1 Hz-1", "J m-1 N-1", "J m-1 N-1",
        "J m-1 Hz-1 N-1", "J m-1 Hz-1 N-1", "J m-1 N-2",
    ]  # fmt: skip
    assert {row["synthetic"] for row in rows} == {"yes"}


def test_units_of_a_response_and_of_its_factors_are_one_unit(dataset):
    rows = [row for row in rows_of(dataset, "surfaces") if row["experiment"] == "half-inch"]
    assert [row["coefficient_engineering_unit"] for row in rows[5:10]] == [
        "1", "1", "Hz-1", "Hz-1", "N-1",
    ]  # fmt: skip


def test_a_transformed_response_has_no_unit(dataset):
    rows = rows_of(dataset, "surfaces")
    bent = [row for row in rows if row["response"] == "log_hysteresis_energy"]
    assert len(bent) == 20
    assert {row["unit"] for row in bent} == {"1"}
    assert bent[1]["coefficient_engineering_unit"] == "Hz-2"


def test_a_run_shows_plan_levels_responses_and_residuals(dataset):
    run = rows_of(dataset, "runs")[1]
    assert (run["run_name"], run["run_specimen"]) == ("R02", "line")
    assert run["run_mean_tension"] == ONE.runs.mean_tension[1]
    assert run["relaxation_time_measured"] == ONE.runs.response[3, 1]
    # the scatter of the run, and the gain of the load cell that it shares
    assert run["relaxation_time_measured_standard_uncertainty"] == pytest.approx(
        np.hypot(ONE.runs.response_standard_uncertainty[3, 1], 0.01 * ONE.runs.response[3, 1])
    )
    responses = [row for row in rows_of(dataset, "run_responses") if row["run_name"] == "R02"]
    time = next(row for row in responses if row["response"] == "relaxation_time")
    assert (
        time["response_measured_random_standard_uncertainty"]
        == ONE.runs.response_standard_uncertainty[3, 1]
    )
    levels = rows_of(dataset, "run_levels")[3:6]
    assert [row["run_level"] for row in levels] == ONE.runs.level[1].tolist()
    assert [row["run_plan"] for row in levels] == [1, -1, 0]
    assert [row["factor_unit"] for row in levels] == list(UNITS)
    residuals = rows_of(dataset, "run_responses")
    assert residuals[1]["response_fitted"] == ONE.surfaces.fitted[0, 1]
    assert residuals[1]["response_leverage"] == ONE.surfaces.diagnostics.leverage[0, 1]


def test_a_shorter_experiment_adds_no_empty_rows(dataset):
    assert [row["experiment"] for row in rows_of(dataset, "runs")] == (
        ["half-inch"] * 15 + ["two lines"] * 30 + ["screening"] * 12 + ["broken"] * 12
    )
    for name, count in (("factors", 3 + 3 + 5 + 5), ("run_levels", 45 + 90 + 60 + 60)):
        assert len(rows_of(dataset, name)) == count
    for table in EXPERIMENT_TABLES:
        for row in table_rows(dataset, table):
            assert row[0]


def test_sums_of_squares_stand_beside_their_source(dataset):
    rows = [row for row in rows_of(dataset, "anova") if row["experiment"] == "two lines"]
    assert [row["anova_source"] for row in rows[:8]] == list(TWO.surfaces.anova.source)
    assert rows[0]["anova_source"] == "blocks"
    assert rows[5]["response_anova_sum_of_squares"] == TWO.surfaces.anova.sum_of_squares[0, 5]
    assert [row["anova_error_term"] for row in rows[:6]] == [
        "residuals", "residuals", "residuals", "residuals", "", "pure error",
    ]  # fmt: skip
    header = [column.header for column in BY_NAME["anova"].columns]
    assert "response_anova_sum_of_squares [unit2]" in header


def test_the_statistic_of_the_report_stands_beside_the_correct_one(dataset):
    row = rows_of(dataset, "surface_quality")[0]
    # R-squared alone gives both: 9 and 5 against 10 and 4 degrees of freedom
    odds = row["response_r2"] / (1 - row["response_r2"])
    assert row["response_overall_f"] == pytest.approx(odds * 5 / 9, rel=1e-9)
    assert row["response_printed_f"] == pytest.approx(odds * 4 / 10, rel=1e-9)
    assert row["response_stationary_kind"] in ("minimum", "maximum", "saddle")


def test_an_eigenvector_has_a_row_a_factor(dataset):
    rows = rows_of(dataset, "eigenvalues")[:9]
    canonical = ONE.surfaces.canonical
    assert [row["response_eigenvector"] for row in rows] == canonical.eigenvector[
        0
    ].T.ravel().tolist()
    assert [row["response_eigenvalue"] for row in rows[::3]] == canonical.eigenvalue[0].tolist()


def test_a_surface_has_a_row_a_point_with_three_intervals(dataset):
    rows = [row for row in rows_of(dataset, "surface_points") if row["experiment"] == "half-inch"]
    assert len(rows) == 21 * len(ONE.surfaces.response_names)
    at = evaluate_surfaces(ONE.surfaces, np.zeros((1, 3)), units="coded")
    wanted = with_shared_at_points(ONE.surfaces, at, ONE.shared.coefficient, [np.inf])
    for row in rows[::21]:
        assert (row["point_name"], row["point_kind"]) == ("(0, 0, 0)", "centre")
        place = ONE.surfaces.response_names.index(row["response"])
        assert row["response_point_value"] == at.value[place, 0]
        for kind in ("confidence", "prediction", "simultaneous"):
            ends = [row[f"response_point_{kind}_{end}"] for end in ("low", "high")]
            assert ends == pytest.approx(getattr(wanted, f"{kind}_interval")[place, 0], rel=1e-12)
        assert row["interval_confidence"] == 0.95
        both = row["response_point_value_standard_uncertainty"]
        assert both > row["response_point_value_random_standard_uncertainty"] > 0
    units = {row["response"]: row["response_unit"] for row in rows}
    assert units["hysteresis_energy"] == units["log_hysteresis_energy"] == "J m-1"
    assert {row["response_point_is_above_leverage"] for row in rows} == {"no", "yes"}
    header = [column.header for column in BY_NAME["surface_points"].columns]
    assert "response_point_value [response_unit]" in header


def test_a_point_shows_its_levels(dataset):
    rows = rows_of(dataset, "point_levels")
    assert len(rows) == 2 * 21 * 3
    assert [row["point_level"] for row in rows[:3]] == pytest.approx([0.3, 5950, 2125])
    assert [row["point_coded_level"] for row in rows[60:63]] == [1, 1, 1]
    assert [row["factor_unit"] for row in rows[:3]] == list(UNITS)


def test_an_interaction_has_a_row_a_column(dataset):
    rows = [row for row in rows_of(dataset, "aliases") if row["experiment"] == "screening"]
    assert len(rows) == 10 * 11
    assert [rows[2][name] for name in (
        "interaction_factor", "interaction_other_factor", "plan_column_name",
    )] == ["frequency", "mean_tension", "tension_amplitude"]  # fmt: skip
    assert abs(rows[2]["effect_alias"]) == pytest.approx(1 / 3)
    assert rows[0]["effect_alias"] == pytest.approx(0, abs=1e-12)


def test_dummies_have_effects_and_no_test(dataset):
    rows = [row for row in rows_of(dataset, "screening") if row["experiment"] == "screening"][:11]
    assert [row["plan_column_name"] for row in rows][4:7] == ["duration", "dummy 1", "dummy 2"]
    assert [row["response_effect"] for row in rows] == [
        *SCREENING.screening.effect[0], *SCREENING.screening.dummy_effect[0],
    ]  # fmt: skip
    assert all(row["response_effect_t"] is None for row in rows[5:])
    assert {row["response_effect_standard_uncertainty"] for row in rows} == {
        SCREENING.screening.effect_standard_error[0]
    }


def test_a_screening_that_misses_a_run_says_why_it_has_no_effects(dataset):
    rows = [row for row in rows_of(dataset, "screening") if row["experiment"] == "broken"]
    assert len(rows) == 2 * 11
    assert {row["response_effect"] for row in rows} == {None}
    assert rows[0]["response_effect_refusal"].startswith("a run is missing")


def test_forms_of_mooring_codes_stand_beside_the_quadratic_surface(dataset):
    forms = [row for row in rows_of(dataset, "stiffness_forms") if row["experiment"] == "half-inch"]
    assert [row["stiffness_form"] for row in forms] == ["del-vecchio", "mean-load", "quadratic"]
    assert [row["stiffness_aicc"] for row in forms][:2] == ONE.form_quality.aicc.tolist()[:2]
    rows = [
        row
        for row in rows_of(dataset, "stiffness_coefficients")
        if row["experiment"] == "half-inch"
    ]
    assert [(row["stiffness_coefficient_name"], row["stiffness_coefficient_unit"]) for row in rows] == [
        ("a", "1"), ("b", "1/%"), ("c", "1/%"), ("d", "1"), ("alpha", "1"), ("beta", "1"),
    ]  # fmt: skip
    assert [row["stiffness_coefficient"] for row in rows] == [
        *ONE.stiffness_forms[0].coefficient, *ONE.stiffness_forms[1].coefficient,
    ]  # fmt: skip


def test_cautions_name_their_runs(dataset):
    rows = rows_of(dataset, "cautions")
    assert [(row["experiment"], row["caution_runs"]) for row in rows[:2]] == [
        ("half-inch", "R02"), ("half-inch", ""),
    ]  # fmt: skip


def test_a_check_of_a_single_time_is_one_row(dataset):
    (row,) = rows_of(dataset, "single_time")
    assert row["single_time_exponent"] == ONE.single_time.exponent
    assert row["single_time_verdict"]


def test_an_archive_without_surfaces_fills_only_what_it_has():
    dataset = _by_response(surfaces_to_dataset([SCREENING], origin=ABOUT))
    filled = {table.name for table in EXPERIMENT_TABLES if table_rows(dataset, table)}
    assert filled == {
        "experiments", "factors", "runs", "run_levels", "run_responses", "screening", "aliases",
    }  # fmt: skip


def test_every_number_of_an_archive_of_experiments_is_in_a_table():
    sources = {column.variable.name for table in EXPERIMENT_TABLES for column in table.columns}
    of_responses = {
        pattern.name.replace("<response>", name)
        for pattern in RESPONSE_PATTERNS
        for name in SURFACE_NAMES
    }
    of_responses |= {
        f"{name}_{of}_uncertainty_contribution"
        for name in SURFACE_NAMES
        for of in (
            "coefficient",
            "coefficient_engineering",
            "point_value",
            "stationary_point",
            "eigenvalue",
        )
    }
    missing = set(SURFACE_SCHEMA) - sources - of_responses
    assert {name for name in missing if not name.endswith("_standard_uncertainty")} == {
        # axes, and what is written out as text or as a unit
        "term_exponent", "term_other", "term_unit_engineering", "stiffness_term_other",
        # in the archive alone
        "stiffness_covariance",
    }  # fmt: skip
    whats = {pattern.name.replace("<response>", "response") for pattern in RESPONSE_PATTERNS}
    assert whats - sources == {"response_covariance_factor"}
