"""Which tables of experiments there are; one of several responses has the unit in the row."""

from __future__ import annotations

from reduction.tables.ofexperiments import RUN, table_of_experiments
from reduction.tables.stiffness import STIFFNESS_TABLES
from reduction.tables.surfaces import SURFACE_TABLES
from reduction.vocabulary import RESPONSES

EXPERIMENT_TABLES = (
    table_of_experiments(
        "experiments",
        ("experiment",),
        (
            "experiment_kind",
            "block_treatment",
            "replicate_tolerance",
            "condition_number",
            "effect_error_from",
            "effect_degrees_of_freedom",
            "effect_significance",
        ),
        ("experiment_kind",),
    ),
    table_of_experiments(
        "factors",
        ("experiment", "factor"),
        ("factor_name", "factor_low", "factor_high", "factor_unit"),
        ("factor_low",),
    ),
    table_of_experiments(
        "runs",
        ("experiment", "run"),
        (
            *RUN,
            "run_block",
            "run_frequency",
            "run_mean_tension",
            "run_tension_amplitude",
            "run_peak_tension",
            "run_minimum_tension",
            "run_rated_break_strength",
            *(f"{name}_measured" for name in RESPONSES),
            "derived_dissipation_spring_constant",
            "derived_relaxation_time",
            "run_cell",
            "run_remark",
        ),
        ("run_is_there",),
    ),
    table_of_experiments(
        "run_levels",
        ("experiment", "run", "factor"),
        (*RUN, "factor_name", "run_plan", "run_coded_level", "run_level", "factor_unit"),
        ("run_plan",),
    ),
    table_of_experiments(
        "run_responses",
        ("experiment", "response", "run"),
        (
            *RUN,
            "unit",
            "response_measured",
            "response_measured_random_standard_uncertainty",
            "response_fitted",
            "response_residual",
            "response_leverage",
            "response_studentized_residual",
            "response_deleted_residual",
            "response_cooks_distance",
        ),
        ("response_measured", "response_fitted"),
    ),
    *SURFACE_TABLES,
    *STIFFNESS_TABLES,
    table_of_experiments(
        "cautions",
        ("caution",),
        ("experiment=caution_experiment", "caution_kind", "caution_hint", "caution_runs"),
        ("caution",),
    ),
    table_of_experiments(
        "experiment_notes",
        ("note",),
        ("experiment=note_experiment", "note_stage"),
        ("note",),
    ),
)
