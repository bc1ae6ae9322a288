"""Which tables of tests there are, and which variables of an archive each one lays out in rows."""

from __future__ import annotations

from reduction.archive.schema import COEFFICIENTS, SCHEMA
from reduction.archive.variable import SUFFIXES
from reduction.tables.derived import (
    with_chords,
    with_cycle_count,
    with_edges,
    with_fit_of_parameter,
    with_its_one_specimen,
)
from reduction.tables.programme import ROPE_TABLES
from reduction.tables.shared import SHARED_TABLES
from reduction.tables.table import Table
from reduction.vocabulary import BRANCH_NAMES

__all__ = ["TABLES"]


_PER_CYCLE = tuple(
    name
    for name, row in SCHEMA.items()
    if row.dims == ("specimen", "cycle") and not name.endswith(tuple(SUFFIXES))
)
_IDENTITY = ("stroke_mean_modulus_difference", "tension_loss_modulus", "identity_residual")
_TREND = ("peak_tension_per_decade", "dynamic_modulus_per_decade", "peak_tension_change")
_LINE = (
    "test_quasi_static_spring_constant",
    "test_dissipation_spring_constant",
    "test_relaxation_time",
    "test_dashpot_coefficient",
    "test_line_conditioning",
    "test_line_refusal",
    "test_line_uncertainty_method",
    "test_line_without_solution_share",
    *(
        f"test_{name}_{end}"
        for name in ("dissipation_spring_constant", "relaxation_time", "dashpot_coefficient")
        for end in ("low", "high")
    ),
)
_AMPLITUDE = tuple(
    name
    for name in SCHEMA
    if name.startswith("test_") and name not in _LINE and not name.endswith(tuple(SUFFIXES))
)
_PULL = (
    "pull_tension_low",
    "pull_tension_high",
    "pull_strain_rate",
    "pull_waiting_time",
    "pull_waiting",
    "pull_residual",
    "pull_reference_tension",
)

TABLES = (
    Table(
        "moduli",
        ("specimen", "branch_name", "segment"),
        (
            "segment_tension_low",
            "segment_tension_high",
            "segment_strain_low",
            "segment_strain_high",
            "segment_modulus",
            "segment_misfit",
            "n_cycles",
            "strain_method",
            "segment_criterion",
        ),
        ("segment_modulus",),
        with_cycle_count,
    ),
    Table(
        "cycles",
        ("specimen", "cycle"),
        (*_PER_CYCLE, *(f"chord_modulus_{branch}" for branch in BRANCH_NAMES)),
        _PER_CYCLE,
        with_chords,
    ),
    Table(
        "tangent_modulus",
        ("specimen", "branch_name", "strain_bin"),
        (
            "strain_bin_low",
            "strain_bin_high",
            "tangent_modulus",
            "tangent_modulus_count",
            "tangent_modulus_minimum",
            "tangent_modulus_maximum",
            "tangent_modulus_scatter",
            "tangent_modulus_untrimmed",
            "branch_tension",
        ),
        ("tangent_modulus", "tangent_modulus_untrimmed"),
        with_edges,
    ),
    Table(
        "first_loading",
        ("specimen", "branch_name", "first_loading_strain_bin"),
        ("tangent_modulus_first_loading", "branch_tension_first_loading"),
        ("tangent_modulus_first_loading",),
    ),
    Table(
        "relaxation",
        ("hold",),
        (
            "specimen=hold_specimen",
            "hold_number",
            "hold_kind",
            "hold_start_time",
            "hold_duration",
            "hold_ramp_centre_time",
            "hold_strain",
            "hold_initial_tension",
            "hold_final_tension",
            "relaxation_drop",
            "relaxation_rate_per_decade",
            "creep_rate_per_decade",
            "long_time_tension",
            "hold_criterion",
            "hold_refusal",
        ),
        ("hold",),
    ),
    Table(
        "relaxation_times",
        ("hold", "hold_time"),
        ("specimen=hold_specimen", "hold_number", "hold_kind", "tension_at_time", "strain_at_time"),
        ("tension_at_time", "strain_at_time"),
    ),
    Table(
        "prony",
        ("hold", "prony_term"),
        ("specimen=hold_specimen", "hold_number", "hold_kind", "prony_tension", "prony_time"),
        ("prony_tension",),
    ),
    Table(
        "splice",
        ("mark",),
        (
            "specimen=mark_specimen",
            "mark_test",
            "mark_hold",
            "mark_position",
            "mark_strain",
            "mark_tension",
            "mark_strain_residual",
        ),
        ("mark_test",),
    ),
    Table(
        "splice_coefficients",
        ("specimen",),
        (
            "strain_method",
            "strain_marks_from",
            "strain_position_low",
            "strain_position_high",
            "strain_tension_low",
            "strain_tension_high",
            "strain_slope_ratio",
            *COEFFICIENTS.values(),
        ),
        ("strain_method",),
    ),
    Table("amplitude", ("specimen",), _AMPLITUDE, _AMPLITUDE),
    Table(
        "line",
        ("specimen",),
        ("test_frequency", "test_mean_tension", "test_tension_amplitude", *_LINE),
        ("test_line_refusal",),
    ),
    Table(
        "slow_pull",
        ("specimen", "tension_grid"),
        ("quasi_static_spring_constant", "quasi_static_strain"),
        ("quasi_static_spring_constant", "quasi_static_strain"),
    ),
    Table(
        "slow_pull_cubic",
        ("specimen", "pull_term"),
        ("pull_strain_coefficient", "pull_spring_constant_coefficient", *_PULL),
        ("pull_strain_coefficient",),
    ),
    Table(
        "strain_at_break_share",
        ("specimen", "break_share"),
        ("strain_at_break_share",),
        ("strain_at_break_share",),
    ),
    *ROPE_TABLES,
    *SHARED_TABLES,
    Table(
        "channel_lag",
        ("specimen",),
        ("channel_lag", "channel_lag_turns", "channel_lag_refusal"),
        ("channel_lag_refusal",),
    ),
    Table(
        "slips",
        ("slip",),
        (
            "specimen=slip_specimen",
            "slip_cycle",
            "slip_cycle_low",
            "slip_cycle_high",
            "slip_tension_step",
            "slip_length",
        ),
        ("slip_cycle",),
    ),
    Table("identity", ("specimen", "cycle"), _IDENTITY, _IDENTITY),
    Table(
        "mean_identity",
        ("specimen",),
        ("mean_identity_residual", "n_cycles"),
        ("mean_identity_residual",),
        with_cycle_count,
    ),
    Table(
        "history",
        ("specimen",),
        (
            "earlier_tests",
            "earlier_maximum_strain",
            "earlier_maximum_tension",
            "earlier_cycles",
            "earlier_flex_cycles",
            "permanent_set",
        ),
        ("earlier_tests",),
    ),
    Table(
        "trend",
        ("specimen",),
        (*_TREND, "n_slips", "creep_per_cycle"),
        (*_TREND, "n_slips"),
    ),
    Table(
        "elastomer",
        ("elastomer_parameter",),
        (
            "specimen=elastomer_specimen",
            "elastomer_law",
            "elastomer_parameter_name",
            "elastomer_modulus",
            "elastomer_exponent",
            "elastomer_rms_stress",
            "elastomer_strain_low",
            "elastomer_strain_high",
            "elastomer_is_stable",
            "elastomer_aicc",
        ),
        ("elastomer_parameter_name",),
        with_fit_of_parameter,
    ),
    Table(
        "stress_at_strain",
        ("specimen", "strain_level"),
        ("stress_at_strain",),
        ("stress_at_strain",),
    ),
    Table(
        "slack_strain_at_unloading",
        ("specimen",),
        ("slack_strain_at_unloading",),
        ("slack_strain_at_unloading",),
    ),
    Table(
        "comparison",
        ("comparison", "branch_name", "ratio_strain_bin"),
        (
            "ratio_numerator",
            "ratio_denominator",
            "modulus_ratio",
            "modulus_ratio_low",
            "modulus_ratio_high",
            "modulus_ratio_is_different",
        ),
        ("modulus_ratio",),
    ),
    Table(
        "stepwise",
        ("step",),
        (
            "specimen",
            "clock",
            "time",
            "tension",
            "gauge_length",
            "eye_to_eye_length",
            "printed_strain",
            "strain",
            "branch",
            "step_flag",
            "secant_modulus",
            "relaxed_gauge_length",
        ),
        ("clock",),
        with_its_one_specimen,
        product="stepwise test",
    ),
    Table(
        "stepwise_moduli",
        ("interval",),
        ("specimen", "interval_branch", "interval_strain", "interval_modulus"),
        ("interval_modulus",),
        with_its_one_specimen,
        product="stepwise test",
    ),
    Table(
        "specimens",
        ("specimen",),
        (
            "specimen_kind",
            "specimen_material",
            "specimen_construction",
            "specimen_condition",
            "diameter",
            "area",
            "rated_break_strength",
            "rated_break_strength_source",
            "linear_density",
            "wet_linear_density",
            "declared_gauge_length",
        ),
        ("specimen_kind",),
    ),
    Table(
        "standstills",
        ("standstill", "specimen"),
        (
            "standstill_start_time",
            "standstill_end_time",
            "standstill_position",
            "standstill_tension",
            "standstill_is_rest",
        ),
        ("standstill_start_time",),
    ),
    Table("notes", ("note",), ("note_stage",), ("note",)),
    Table(
        "rows",
        ("channel", "quality_mask"),
        ("n_rows_read", "n_rows_kept", "n_flagged"),
        ("n_flagged",),
    ),
)
