"""The CSV tables of a campaign: which variables stand in which table."""

from __future__ import annotations

import numpy as np
import xarray as xr

from reduction.archive.csv_columns import CsvTable, Variables
from reduction.archive.schema import COEFFICIENTS, SCHEMA
from reduction.archive.shared_errors import COMPONENT, SHARED, SHARED_OF_STEPS
from reduction.archive.variables import SUFFIXES
from reduction.quantities.names import BRANCH_NAMES, RESPONSES
from reduction.record.measurement import Integers

ERROR = (
    "uncertainty_source", "uncertainty_source_of", "uncertainty_source_number",
    "uncertainty_source_degrees_of_freedom",
)  # fmt: skip
"""Columns that say which error a row is of."""

_FILES = {
    ("specimen",): "shared_errors",
    ("specimen", "branch_name", "segment"): "shared_errors_segments",
    ("specimen", "branch_name", "strain_bin"): "shared_errors_curves",
    ("specimen", "branch_name", "first_loading_strain_bin"): "shared_errors_first_loading",
    ("specimen", "strain_level"): "shared_errors_stress",
    ("specimen", "tension_grid"): "shared_errors_slow_pull",
    ("specimen", "break_share"): "shared_errors_break_share",
    ("specimen", "pull_term"): "shared_errors_cubic",
    ("hold",): "shared_errors_holds",
    ("hold", "hold_time"): "shared_errors_hold_times",
    ("hold", "prony_term"): "shared_errors_prony",
    ("held_pair",): "shared_errors_static_stiffness",
    ("interval",): "shared_errors_stepwise",
    ("step",): "shared_errors_weights",
    ("slip",): "shared_errors_slips",
    ("elastomer_parameter",): "shared_errors_elastomer",
    ("comparison", "branch_name", "ratio_strain_bin"): "shared_errors_ratios",
}

# whose they are, where a row of the table itself would not say
_LABELS_OF = {
    ("hold",): ("specimen=hold_specimen", "hold_number"),
    ("hold", "hold_time"): ("specimen=hold_specimen", "hold_number"),
    ("hold", "prony_term"): ("specimen=hold_specimen", "hold_number"),
    ("held_pair",): ("specimen=held_pair_specimen",),
    ("slip",): ("specimen=slip_specimen", "slip_cycle"),
    ("step",): ("clock",),
    ("elastomer_parameter",): ("elastomer_parameter_fit", "elastomer_parameter_name"),
    ("comparison", "branch_name", "ratio_strain_bin"): ("ratio_numerator", "ratio_denominator"),
}


def _shared_table(name: str, dims: tuple[str, ...]) -> CsvTable:
    rows = tuple(
        f"{quantity}_uncertainty_contribution"
        for quantity, own in (SHARED | SHARED_OF_STEPS).items()
        if own == dims
    )
    return CsvTable(
        name, (*dims, COMPONENT), (*_LABELS_OF.get(dims, ()), *ERROR, *rows), rows,
        product="stepwise test" if "step" in dims else "test",
    )  # fmt: skip


SHARED_TABLES = tuple(_shared_table(name, dims) for dims, name in _FILES.items())


def _edges_of_bins(archive: xr.Dataset) -> Variables:
    """Give each bin of strain its edges as columns."""
    edges = archive.variables["strain_bin_bounds"]
    return {"strain_bin_low": edges[:, 0], "strain_bin_high": edges[:, 1]}


def _cycle_count(archive: xr.Dataset) -> Variables:
    """Count the cycles."""
    return {"n_cycles": xr.Variable((), archive.sizes.get("cycle", 0))}


def _chords_of_branches(archive: xr.Dataset) -> Variables:
    """Give each branch a column of its own, so that a cycle stays one row."""
    if "chord_modulus" not in archive:
        return {}
    return {
        f"chord_modulus_{branch}{suffix}": archive.variables[f"chord_modulus{suffix}"][:, :, index]
        for index, branch in enumerate(BRANCH_NAMES)
        for suffix in ("", "_standard_uncertainty")
    }


def _fit_of_parameters(archive: xr.Dataset) -> Variables:
    """Repeat what is said of a fit beside each of its parameters."""
    fit = archive.variables["elastomer_parameter_fit"].values - 1
    return {
        str(name): xr.Variable("elastomer_parameter", np.asarray(variable.values)[fit])
        for name, variable in archive.variables.items()
        if variable.dims == ("elastomer_fit",)
    }


def _one_specimen(archive: xr.Dataset) -> Variables:
    """Leave out the axis of a specimen that is alone."""
    return {
        str(name): variable.isel(specimen=0)
        for name, variable in archive.variables.items()
        if "specimen" in variable.dims
    }


_IDENTITY = ("stroke_mean_modulus_difference", "tension_loss_modulus", "identity_residual")

_TREND = ("peak_tension_per_decade", "dynamic_modulus_per_decade", "peak_tension_change")

CHANGE_TABLES = (
    CsvTable(
        "channel_lag",
        ("specimen",),
        ("channel_lag", "channel_lag_turns", "channel_lag_refusal"),
        ("channel_lag_refusal",),
    ),
    CsvTable(
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
    CsvTable("identity", ("specimen", "cycle"), _IDENTITY, _IDENTITY),
    CsvTable(
        "mean_identity",
        ("specimen",),
        ("mean_identity_residual", "n_cycles"),
        ("mean_identity_residual",),
        _cycle_count,
    ),
    CsvTable(
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
    CsvTable(
        "trend",
        ("specimen",),
        (*_TREND, "n_slips", "creep_per_cycle"),
        (*_TREND, "n_slips"),
    ),
)


def _comparison_table(
    name: str, dims: tuple[str, ...], variables: tuple[str, ...], needs: tuple[str, ...]
) -> CsvTable:
    return CsvTable(name, dims, variables, needs, product="comparisons")


_OF = ("comparison_test", "comparison_specimen", "comparison_hose", "comparison_loading")

COMPARISON_TABLES = (
    _comparison_table(
        "comparisons",
        ("comparison",),
        (
            *_OF,
            "judged_curve",
            "verdict",
            "agrees",
            "is_informative",
            "largest_ratio",
            "largest_ratio_strain",
            "coverage_factor",
            "chi_square",
            "chi_square_freedom",
            "chi_square_probability",
            "uncertainty_share",
            "measured_pick_up_strain",
            "energy_strain_low",
            "energy_strain_high",
            "measured_energy",
            "predicted_energy",
            "energy_difference",
            "loop_energy",
            "loop_energy_share",
            "bias_per_decade",
            "is_identified",
            "identifiability",
            "collinearity",
            "calibrated_bias",
            "calibrated_rms",
            "calibrated_relative_rms",
            "model_error",
            "effective_points",
        ),
        ("largest_ratio", "verdict"),
    ),
    _comparison_table(
        "comparison_curves",
        ("comparison", "curve"),
        (
            "tension_bias",
            "tension_rms",
            "tension_relative_rms",
            "worst_strain",
            "worst_tension_difference",
        ),
        ("tension_rms",),
    ),
    _comparison_table(
        "comparison_points",
        ("comparison", "curve", "comparison_point"),
        (
            "strain",
            "measured_tension",
            "predicted_tension",
            "tension_difference",
            "validation_uncertainty",
            "calibrated_tension",
        ),
        ("measured_tension",),
    ),
    _comparison_table(
        "shared_errors_comparisons",
        ("comparison", "curve", "comparison_point", COMPONENT),
        (
            "strain",
            *ERROR,
            "measured_tension_uncertainty_contribution",
        ),
        ("measured_tension_uncertainty_contribution",),
    ),
    _comparison_table(
        "comparison_events",
        ("comparison", "hose_event"),
        (
            "event_strain",
            "event_tension",
            "event_measured_tension",
            "event_tension_difference",
            "event_measured_strain",
            "event_strain_difference",
        ),
        ("event_strain",),
    ),
    _comparison_table(
        "comparison_cycles",
        ("comparison", "comparison_cycle"),
        ("comparison_cycle_number", "cycle_bias", "cycle_rms"),
        ("cycle_bias",),
    ),
    _comparison_table(
        "calibrations",
        ("comparison", "parameter"),
        (
            "parameter_name",
            "parameter_unit",
            "parameter_start",
            "parameter_value",
            "parameter_low",
            "parameter_high",
            "parameter_lower_bound",
            "parameter_upper_bound",
            "parameter_is_at_bound",
        ),
        ("parameter_value",),
    ),
    _comparison_table(
        "calibration_correlations",
        ("comparison", "parameter", "parameter_other"),
        ("parameter_name", "parameter_correlation"),
        ("parameter_correlation",),
    ),
)

_PER_CYCLE = tuple(
    name
    for name, row in SCHEMA.items()
    if row.dims == ("specimen", "cycle") and not name.endswith(tuple(SUFFIXES))
)

CURVE_TABLES = (
    CsvTable(
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
        _cycle_count,
    ),
    CsvTable(
        "cycles",
        ("specimen", "cycle"),
        (*_PER_CYCLE, *(f"chord_modulus_{branch}" for branch in BRANCH_NAMES)),
        _PER_CYCLE,
        _chords_of_branches,
    ),
    CsvTable(
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
            "branch_tension_count",
        ),
        ("tangent_modulus", "tangent_modulus_untrimmed"),
        _edges_of_bins,
    ),
    CsvTable(
        "first_loading",
        ("specimen", "branch_name", "first_loading_strain_bin"),
        ("tangent_modulus_first_loading", "branch_tension_first_loading"),
        ("tangent_modulus_first_loading",),
    ),
)

HOLD_TABLES = (
    CsvTable(
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
    CsvTable(
        "relaxation_times",
        ("hold", "hold_time"),
        ("specimen=hold_specimen", "hold_number", "hold_kind", "tension_at_time", "strain_at_time"),
        ("tension_at_time", "strain_at_time"),
    ),
    CsvTable(
        "prony",
        ("hold", "prony_term"),
        ("specimen=hold_specimen", "hold_number", "hold_kind", "prony_tension", "prony_time"),
        ("prony_tension",),
    ),
)

RUN = ("run_name", "run_specimen")
"""Columns that say which run a row is of."""


def _table_of_experiments(
    name: str, dims: tuple[str, ...], variables: tuple[str, ...], needs: tuple[str, ...]
) -> CsvTable:
    """Return a table of a product of experiments."""
    return CsvTable(name, dims, variables, needs, product="experiments")


def _prediction_table(
    name: str, dims: tuple[str, ...], variables: tuple[str, ...], needs: tuple[str, ...]
) -> CsvTable:
    return CsvTable(name, dims, variables, needs, product="predictions")


PREDICTION_TABLES = (
    _prediction_table(
        "predictions",
        ("hose", "hose_point"),
        (
            "strain",
            "free_strain",
            "tension",
            "fill_pressure",
            "cord_tension",
            "cord_strain",
            "cord_share",
            "rubber_share",
            "end_cap_load",
            "current_wrap_angle",
            "cord_spacing",
            "current_inner_diameter",
            "hose_state",
        ),
        ("strain",),
    ),
    _prediction_table(
        "hose_events",
        ("hose", "hose_event"),
        (
            "event_strain",
            "event_tension",
            "event_fill_pressure",
            "event_cord_tension",
            "event_cord_strain",
        ),
        ("event_strain",),
    ),
    _prediction_table(
        "hoses",
        ("hose",),
        (
            "wrap_angle",
            "inner_diameter",
            "outer_diameter",
            "cords_per_length",
            "cord_diameter",
            "rubber_modulus",
            "rubber_law",
            "working_share",
            "cord_load_scale",
            "cord_strain_scale",
            "dead_length_share",
            "minimum_inner_diameter",
            "number_of_cords",
        ),
        ("wrap_angle",),
    ),
    _prediction_table(
        "cord_layers",
        ("hose", "cord_layer"),
        ("layer_diameter", "ribbon_width"),
        ("layer_diameter",),
    ),
    _prediction_table(
        "hose_layers",
        ("hose", "hose_layer"),
        (
            "hose_layer_name",
            "hose_layer_wrap_angle",
            "hose_layer_strain_limit",
            "hose_layer_compression_limit",
            "hose_layer_least_strain",
            "hose_layer_greatest_strain",
            "hose_layer_break_strain",
            "hose_layer_least_angle",
            "hose_layer_greatest_angle",
        ),
        ("hose_layer_wrap_angle",),
    ),
)

_BEDDING = (
    "bedding_cycles",
    "bedding_first_stiffness",
    "bedding_first_stiffness_over_strength",
    "bedding_last_stiffness",
    "bedding_last_stiffness_over_strength",
    "bedding_stiffening",
    "bedding_permanent_strain",
)

_DYNAMIC = (
    "dynamic_cycles",
    "dynamic_frequency",
    "dynamic_mean_tension",
    "dynamic_mean_tension_over_strength",
    "dynamic_tension_amplitude",
    "dynamic_tension_amplitude_over_strength",
    "dynamic_stiffness",
    "dynamic_stiffness_over_strength",
    "dynamic_stiffness_drift",
)

_STATIC = (
    "held_pair_low_tension",
    "held_pair_high_tension",
    "static_reference_time",
    "static_stiffness",
    "static_stiffness_over_strength",
    "static_stiffness_per_decade",
    "static_stiffness_per_decade_over_strength",
)

_CREEP = (
    "creep_rate_per_decade",
    "creep_tension_over_strength",
    "creep_compliance_per_decade",
)

_LASTED = (
    "cycles_to_failure",
    "cycles_are_run_out",
    "failure_peak_tension",
    "failure_peak_tension_over_strength",
    "failure_valley_tension",
    "failure_judged_by",
    "earlier_cycles",
)

_PULLED = (
    "tensile_strength",
    "strain_at_failure",
    "pull_is_break",
    "pull_peak_tension",
    "pull_peak_tension_over_strength",
    "pull_peak_strain",
)


def _one_a_specimen(archive: xr.Dataset) -> Variables:
    """Give a step one static stiffness and one creep: of its last pair, its longest hold."""
    if "programme_step" not in archive:
        return {}
    found: dict[str, xr.Variable] = {}
    names = archive.variables["specimen"].values.tolist()
    if "static_stiffness" in archive:
        given = np.isfinite(archive.variables["static_stiffness"].values).astype(np.float64)
        last = _chosen(archive.variables["held_pair_specimen"].values.tolist(), names, given)
        found |= _along_specimen(archive, _STATIC, "held_pair", last)
    if "hold_specimen" in archive:
        longest = _chosen(
            archive.variables["hold_specimen"].values.tolist(),
            names,
            archive.variables["hold_duration"].values,
        )
        found |= _along_specimen(archive, _CREEP, "hold", longest)
    return found


def _chosen(of_row: list[str], names: list[str], rank: np.ndarray) -> Integers:
    """Row of the highest rank of each specimen, the last of those alike; -1 where it has none."""
    found = [
        max((rank[row], row) for row, own in enumerate(of_row) if own == name)[1]
        if name in of_row
        else -1
        for name in names
    ]
    return np.array(found)


def _along_specimen(
    archive: xr.Dataset, names: tuple[str, ...], dim: str, rows: Integers
) -> dict[str, xr.Variable]:
    every = [f"{name}{suffix}" for name in names for suffix in ("", "_standard_uncertainty")]
    return {
        name: xr.Variable(
            "specimen", np.where(rows >= 0, archive.variables[name].values[rows], np.nan)
        )
        for name in every
        if name in archive and archive.variables[name].dims == (dim,)
    }


ROPE_TABLES = (
    CsvTable(
        "rope_programme",
        ("specimen",),
        ("programme_step", *_BEDDING, *_DYNAMIC, *_STATIC, *_CREEP, *_LASTED, *_PULLED),
        ("programme_step",),
        _one_a_specimen,
    ),
    CsvTable(
        "static_stiffness",
        ("held_pair",),
        (
            "specimen=held_pair_specimen",
            "held_pair_low_hold",
            "held_pair_high_hold",
            *_STATIC,
            "static_refusal",
        ),
        ("held_pair",),
    ),
    CsvTable(
        "static_stiffness_times",
        ("held_pair", "held_pair_point"),
        ("specimen=held_pair_specimen", "static_elapsed_time", "static_stiffness_at_time"),
        ("static_stiffness_at_time",),
    ),
    CsvTable(
        "creep",
        ("hold",),
        (
            "specimen=hold_specimen",
            "hold_number",
            "hold_duration",
            "hold_ramp_centre_time",
            "hold_initial_tension",
            "hold_final_tension",
            *_CREEP,
        ),
        ("creep_tension_over_strength",),
    ),
    CsvTable("tensile", ("specimen",), _PULLED, ("pull_peak_tension",)),
)

_CONTRIBUTIONS = tuple(
    f"property_{name}_uncertainty_contribution"
    for name in ("stiffness", "stiffness_over_strength", "strain")
)

PROPERTY_TABLES = (
    CsvTable(
        "change_in_length",
        ("property",),
        (
            "specimen=property_specimen",
            "property_name",
            "property_test",
            "property_low_tension",
            "property_high_tension",
            "property_reference_time",
            "property_stiffness",
            "property_stiffness_over_strength",
            "property_strain",
            "property_remark",
        ),
        ("property",),
        product="properties",
    ),
    CsvTable(
        "shared_errors_change_in_length",
        ("property", COMPONENT),
        (
            "specimen=property_specimen",
            "property_name",
            "property_test",
            *ERROR,
            *_CONTRIBUTIONS,
        ),
        _CONTRIBUTIONS,
        product="properties",
    ),
)

RECORD_TABLES = (
    CsvTable(
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
    CsvTable(
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
    CsvTable("notes", ("note",), ("note_stage", "note_code", "note_severity"), ("note",)),
    CsvTable(
        "rows",
        ("channel", "quality_mask"),
        ("n_rows_read", "n_rows_kept", "n_rows_stored", "n_flagged"),
        ("n_flagged",),
    ),
)

SPLICE_TABLES = (
    CsvTable(
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
    CsvTable(
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
)

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

LINE_TABLES = (
    CsvTable("amplitude", ("specimen",), _AMPLITUDE, _AMPLITUDE),
    CsvTable(
        "line",
        ("specimen",),
        ("test_frequency", "test_mean_tension", "test_tension_amplitude", *_LINE),
        ("test_line_refusal",),
    ),
    CsvTable(
        "slow_pull",
        ("specimen", "tension_grid"),
        ("quasi_static_spring_constant", "quasi_static_strain"),
        ("quasi_static_spring_constant", "quasi_static_strain"),
    ),
    CsvTable(
        "slow_pull_cubic",
        ("specimen", "pull_term"),
        ("pull_strain_coefficient", "pull_spring_constant_coefficient", *_PULL),
        ("pull_strain_coefficient",),
    ),
    CsvTable(
        "strain_at_break_share",
        ("specimen", "break_share"),
        ("strain_at_break_share",),
        ("strain_at_break_share",),
    ),
)

RUBBER_TABLES = (
    CsvTable(
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
        _fit_of_parameters,
    ),
    CsvTable(
        "stress_at_strain",
        ("specimen", "strain_level"),
        ("stress_at_strain",),
        ("stress_at_strain",),
    ),
    CsvTable(
        "slack_strain_at_unloading",
        ("specimen",),
        ("slack_strain_at_unloading",),
        ("slack_strain_at_unloading",),
    ),
    CsvTable(
        "comparison",
        ("comparison", "branch_name", "ratio_strain_bin"),
        (
            "ratio_numerator",
            "ratio_denominator",
            "modulus_ratio",
            "modulus_ratio_low",
            "modulus_ratio_high",
            "modulus_ratio_is_different",
            "modulus_ratio_degrees_of_freedom",
        ),
        ("modulus_ratio",),
    ),
)
"""Of tests with a machine."""

STEPWISE_TABLES = (
    CsvTable(
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
        _one_specimen,
        product="stepwise test",
    ),
    CsvTable(
        "stepwise_moduli",
        ("interval",),
        ("specimen", "interval_branch", "interval_strain", "interval_modulus"),
        ("interval_modulus",),
        _one_specimen,
        product="stepwise test",
    ),
)
"""Of tests with weights that were hung by hand."""

STIFFNESS_TABLES = (
    _table_of_experiments(
        "stiffness_forms",
        ("experiment", "stiffness_form"),
        (
            "stiffness_equation",
            "stiffness_n_coefficients",
            "stiffness_mean_load_low",
            "stiffness_mean_load_high",
            "stiffness_confidence",
            "stiffness_sigma",
            "stiffness_degrees_of_freedom",
            "stiffness_r2",
            "stiffness_adjusted_r2",
            "stiffness_predicted_r2",
            "stiffness_prediction_sum_of_squares",
            "stiffness_aicc",
            "stiffness_refusal",
        ),
        ("stiffness_n_coefficients",),
    ),
    _table_of_experiments(
        "stiffness_coefficients",
        ("experiment", "stiffness_form", "stiffness_term"),
        (
            "stiffness_coefficient_name",
            "stiffness_coefficient_unit",
            "stiffness_coefficient",
            "stiffness_coefficient_low",
            "stiffness_coefficient_high",
            "stiffness_p_value",
        ),
        ("stiffness_coefficient",),
    ),
    _table_of_experiments(
        "stiffness_runs",
        ("experiment", "stiffness_form", "run"),
        (*RUN, "stiffness_fitted", "stiffness_residual"),
        ("stiffness_fitted",),
    ),
    _table_of_experiments(
        "single_time",
        ("experiment",),
        (
            "single_time_exponent",
            "single_time_exponent_low",
            "single_time_exponent_high",
            "single_time_p_value_one_time",
            "single_time_p_value_inverse_frequency",
            "single_time_degrees_of_freedom",
            "single_time_frequency_ratio",
            "single_time_ratio",
            "single_time_ratio_low",
            "single_time_ratio_high",
            "single_time_loss_exponent",
            "single_time_loss_exponent_low",
            "single_time_loss_exponent_high",
            "single_time_confidence",
            "single_time_tolerance",
            "single_time_verdict",
        ),
        ("single_time_degrees_of_freedom",),
    ),
)

_ERRORS = (
    "uncertainty_source",
    "uncertainty_source_of",
    "uncertainty_source_number",
    "uncertainty_source_degrees_of_freedom",
)

SURFACE_TABLES = (
    _table_of_experiments(
        "surfaces",
        ("experiment", "response", "term"),
        (
            "term_name",
            "unit",
            "response_coefficient",
            "response_coefficient_random_standard_uncertainty",
            "response_t",
            "response_p_value",
            "response_term_degrees_of_freedom",
            "term_error",
            "response_coefficient_engineering",
            "coefficient_engineering_unit",
            "response_reduced_is_kept",
            "response_reduced_coefficient",
            "response_reduced_coefficient_engineering",
        ),
        ("response_coefficient",),
    ),
    _table_of_experiments(
        "shared_errors_surfaces",
        ("experiment", "response", "uncertainty_component", "term"),
        (
            *_ERRORS,
            "term_name",
            "unit",
            "response_coefficient_uncertainty_contribution",
            "response_coefficient_engineering_uncertainty_contribution",
            "coefficient_engineering_unit",
        ),
        ("response_coefficient_uncertainty_contribution",),
    ),
    *(
        _table_of_experiments(
            f"shared_errors_{table}",
            ("experiment", "response", "uncertainty_component", dim),
            (*_ERRORS, *about, f"response_{name}_uncertainty_contribution"),
            (f"response_{name}_uncertainty_contribution",),
        )
        for table, dim, name, about in (
            ("surface_points", "point", "point_value", ("point_name", "response_unit")),
            ("stationary_points", "factor", "stationary_point", ("factor_name",)),
            ("eigenvalues", "direction", "eigenvalue", ("unit",)),
        )
    ),
    _table_of_experiments(
        "surface_quality",
        ("experiment", "response"),
        (
            "unit",
            "response_transform",
            "response_transform_exponent",
            "response_transform_exponent_low",
            "response_transform_exponent_high",
            "response_n_runs",
            "response_refusal",
            "response_sigma",
            "response_degrees_of_freedom",
            "response_r2",
            "response_adjusted_r2",
            "response_predicted_r2",
            "response_full_aicc",
            "response_reduced_aicc",
            "response_reduced_sigma",
            "response_overall_f",
            "response_overall_p_value",
            "response_printed_f",
            "response_lack_of_fit_f",
            "response_lack_of_fit_p_value",
            "response_lack_of_fit_refusal",
            "response_probability_plot_correlation",
            "response_stationary_kind",
            "response_stationary_value",
            "response_stationary_point_is_inside",
            "response_stationary_refusal",
            "response_block_standard_deviation",
            "response_block_at_boundary",
        ),
        ("response_n_runs",),
    ),
    _table_of_experiments(
        "anova",
        ("experiment", "response", "anova_row"),
        (
            "anova_source",
            "unit",
            "response_anova_degrees_of_freedom",
            "response_anova_sum_of_squares",
            "response_anova_mean_square",
            "response_anova_f",
            "response_anova_p_value",
            "anova_error_term",
        ),
        ("response_anova_degrees_of_freedom",),
    ),
    _table_of_experiments(
        "stationary_points",
        ("experiment", "response", "factor"),
        (
            "factor_name",
            "response_stationary_point",
            "response_stationary_point_random_standard_uncertainty",
            "response_stationary_point_engineering",
            "factor_unit",
        ),
        ("response_stationary_point",),
    ),
    _table_of_experiments(
        "eigenvalues",
        ("experiment", "response", "direction", "factor"),
        (
            "unit",
            "response_eigenvalue",
            "response_eigenvalue_random_standard_uncertainty",
            "factor_name",
            "response_eigenvector",
        ),
        ("response_eigenvector",),
    ),
    _table_of_experiments(
        "surface_points",
        ("experiment", "response", "point"),
        (
            "point_name",
            "point_kind",
            "response_unit",
            "response_point_value",
            "response_point_value_random_standard_uncertainty",
            "response_point_mean_value",
            *(
                f"response_point_{kind}_{end}"
                for kind in ("confidence", "prediction", "simultaneous")
                for end in ("low", "high")
            ),
            "interval_confidence",
            "response_point_variance_factor",
            "response_point_is_above_leverage",
        ),
        ("response_point_value",),
    ),
    _table_of_experiments(
        "point_levels",
        ("experiment", "point", "factor"),
        ("point_name", "factor_name", "point_coded_level", "point_level", "factor_unit"),
        ("point_coded_level",),
    ),
    _table_of_experiments(
        "ridge",
        ("experiment", "response", "ridge_direction", "ridge_radius", "factor"),
        (
            "factor_name",
            "response_ridge_coded_level",
            "response_ridge_level",
            "factor_unit",
            "response_unit",
            "response_ridge_value",
            "response_ridge_simultaneous_low",
            "response_ridge_simultaneous_high",
            "interval_confidence",
        ),
        ("response_ridge_coded_level",),
    ),
    _table_of_experiments(
        "blocks",
        ("experiment", "response", "block"),
        ("block_name", "unit", "response_block_effect"),
        ("response_block_effect",),
    ),
    _table_of_experiments(
        "screening",
        ("experiment", "response", "plan_column"),
        (
            "plan_column_name",
            "unit",
            "response_effect",
            "response_effect_t",
            "response_effect_p_value",
            "response_effect_is_significant",
            "response_minimum_significant_effect",
            "response_simultaneous_minimum_effect",
            "response_mean",
            "response_effect_refusal",
            "response_effect_size",
            "response_effect_half_normal_quantile",
        ),
        ("effect_is_there",),
    ),
    _table_of_experiments(
        "aliases",
        ("experiment", "interaction", "plan_column"),
        ("interaction_factor", "interaction_other_factor", "plan_column_name", "effect_alias"),
        ("effect_alias",),
    ),
)

EXPERIMENT_TABLES = (
    _table_of_experiments(
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
    _table_of_experiments(
        "factors",
        ("experiment", "factor"),
        ("factor_name", "factor_low", "factor_high", "factor_unit"),
        ("factor_low",),
    ),
    _table_of_experiments(
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
    _table_of_experiments(
        "run_levels",
        ("experiment", "run", "factor"),
        (*RUN, "factor_name", "run_plan", "run_coded_level", "run_level", "factor_unit"),
        ("run_plan",),
    ),
    _table_of_experiments(
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
    _table_of_experiments(
        "cautions",
        ("caution",),
        ("experiment=caution_experiment", "caution_kind", "caution_hint", "caution_runs"),
        ("caution",),
    ),
    _table_of_experiments(
        "experiment_notes",
        ("note",),
        ("experiment=note_experiment", "note_stage", "note_code", "note_severity"),
        ("note",),
    ),
)

TABLES = (
    *CURVE_TABLES,
    *HOLD_TABLES,
    *SPLICE_TABLES,
    *LINE_TABLES,
    *ROPE_TABLES,
    *SHARED_TABLES,
    *CHANGE_TABLES,
    *RUBBER_TABLES,
    *STEPWISE_TABLES,
    *RECORD_TABLES,
)
