"""Defines the CSV tables of a campaign: dimensions of the rows, first and last columns.

The columns between are the numbers whose rows in `reduction.quantities` name the table.
"""

from __future__ import annotations

import numpy as np
import xarray as xr

from reduction.archive.csv_columns import CsvTable, Variables
from reduction.archive.shared_errors import SHARED, SHARED_OF_STEPS
from reduction.quantities.names import BRANCH_NAMES, RESPONSES
from reduction.quantities.row import COMPONENT
from reduction.record.measurement import Integers

ERROR = (
    "uncertainty_source", "uncertainty_source_of", "uncertainty_source_number",
    "uncertainty_source_degrees_of_freedom",
)  # fmt: skip
"""Columns that identify the error in a row."""

# tables for curves, with a row per error and grid place, are only in the archives
_FILES = {
    ("specimen",): "shared_errors",
    ("specimen", "branch_name", "segment"): "shared_errors_segments",
    ("specimen", "strain_level"): "shared_errors_stress",
    ("specimen", "break_share"): "shared_errors_break_share",
    ("specimen", "pull_term"): "shared_errors_cubic",
    ("hold",): "shared_errors_holds",
    ("hold", "prony_term"): "shared_errors_prony",
    ("held_pair",): "shared_errors_static_stiffness",
    ("interval",): "shared_errors_stepwise",
    ("step",): "shared_errors_weights",
    ("slip",): "shared_errors_slips",
    ("elastomer_parameter",): "shared_errors_elastomer",
}

# owner of each row, if the table itself does not show it
_LABELS_OF = {
    ("hold",): ("specimen=hold_specimen", "hold_number"),
    ("hold", "prony_term"): ("specimen=hold_specimen", "hold_number"),
    ("held_pair",): ("specimen=held_pair_specimen",),
    ("slip",): ("specimen=slip_specimen", "slip_cycle"),
    ("step",): ("clock",),
    ("elastomer_parameter",): ("elastomer_parameter_fit", "elastomer_parameter_name"),
}


def _shared_table(name: str, dims: tuple[str, ...]) -> CsvTable:
    rows = tuple(
        f"{quantity}_uncertainty_contribution"
        for quantity, own in (SHARED | SHARED_OF_STEPS).items()
        if own == dims
    )
    return CsvTable(
        name, (*dims, COMPONENT), rows, first=(*_LABELS_OF.get(dims, ()), *ERROR, *rows),
        product="stepwise test" if "step" in dims else "test",
    )  # fmt: skip


SHARED_TABLES = tuple(_shared_table(name, dims) for dims, name in _FILES.items())


def _edges_of_bins(archive: xr.Dataset) -> Variables:
    """Add the edges of each strain bin as columns."""
    edges = archive.variables["strain_bin_bounds"]
    return {"strain_bin_low": edges[:, 0], "strain_bin_high": edges[:, 1]}


def _cycle_count(archive: xr.Dataset) -> Variables:
    """Count the cycles."""
    return {"n_cycles": xr.Variable((), np.asarray(archive.sizes.get("cycle", 0)), fastpath=True)}


def _chords_of_branches(archive: xr.Dataset) -> Variables:
    """Give each branch its own column, so that a cycle has one row."""
    if "chord_modulus" not in archive:
        return {}
    return {
        f"chord_modulus_{branch}{suffix}": archive.variables[f"chord_modulus{suffix}"][:, :, index]
        for index, branch in enumerate(BRANCH_NAMES)
        for suffix in ("", "_standard_uncertainty")
    }


def _fit_of_parameters(archive: xr.Dataset) -> Variables:
    """Repeat the results of a fit beside each of its parameters."""
    fit = archive.variables["elastomer_parameter_fit"].values - 1
    return {
        str(name): xr.Variable(("elastomer_parameter",), variable.values[fit], fastpath=True)
        for name, variable in archive.variables.items()
        if variable.dims == ("elastomer_fit",)
    }


def _one_specimen(archive: xr.Dataset) -> Variables:
    """Drop the axis of a single specimen."""
    return {
        str(name): xr.Variable(
            [dim for dim in variable.dims if dim != "specimen"],
            np.asarray(variable.values.take(0, axis=variable.dims.index("specimen"))),
            fastpath=True,
        )
        for name, variable in archive.variables.items()
        if "specimen" in variable.dims
    }


_OF_PAIR = (
    "held_pair_low_tension", "held_pair_high_tension", "static_reference_time",
    "static_stiffness", "static_stiffness_over_strength", "static_stiffness_per_decade",
    "static_stiffness_per_decade_over_strength",
)  # fmt: skip

_OF_HOLD = ("creep_rate_per_decade", "creep_tension_over_strength", "creep_compliance_per_decade")


def _one_a_specimen(archive: xr.Dataset) -> Variables:
    """Give a step one static stiffness and one creep: from its last pair and its longest hold."""
    if "programme_step" not in archive:
        return {}
    found: dict[str, xr.Variable] = {}
    names = archive.variables["specimen"].values.tolist()
    if "static_stiffness" in archive:
        given = np.isfinite(archive.variables["static_stiffness"].values).astype(np.float64)
        last = _chosen(archive.variables["held_pair_specimen"].values.tolist(), names, given)
        found |= _along_specimen(archive, _OF_PAIR, "held_pair", last)
    if "hold_specimen" in archive:
        longest = _chosen(
            archive.variables["hold_specimen"].values.tolist(),
            names,
            archive.variables["hold_duration"].values,
        )
        found |= _along_specimen(archive, _OF_HOLD, "hold", longest)
    return found


def _chosen(of_row: list[str], names: list[str], rank: np.ndarray) -> Integers:
    """Row with the highest rank for each specimen, the last of equal ones; -1 without one."""
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
            ("specimen",),
            np.where(rows >= 0, archive.variables[name].values[rows], np.nan),
            fastpath=True,
        )
        for name in every
        if name in archive and archive.variables[name].dims == (dim,)
    }


TABLES = (
    CsvTable(
        "moduli",
        ("specimen", "branch_name", "segment"),
        ("segment_modulus",),
        last=("n_cycles", "strain_method", "segment_criterion"),
        derive=_cycle_count,
    ),
    CsvTable("cycles", ("specimen", "cycle"), (), derive=_chords_of_branches),
    CsvTable(
        "tangent_modulus",
        ("specimen", "branch_name", "strain_bin"),
        ("tangent_modulus", "tangent_modulus_untrimmed"),
        first=("strain_bin_low", "strain_bin_high"),
        derive=_edges_of_bins,
    ),
    CsvTable(
        "first_loading",
        ("specimen", "branch_name", "first_loading_strain_bin"),
        ("tangent_modulus_first_loading",),
    ),
    CsvTable("relaxation", ("hold",), ("hold",), first=("specimen=hold_specimen",)),
    CsvTable(
        "relaxation_times",
        ("hold", "hold_time"),
        ("tension_at_time", "strain_at_time"),
        first=("specimen=hold_specimen", "hold_number", "hold_kind"),
    ),
    CsvTable(
        "prony",
        ("hold", "prony_term"),
        ("prony_tension",),
        first=("specimen=hold_specimen", "hold_number", "hold_kind"),
    ),
    CsvTable("splice", ("mark",), ("mark_test",), first=("specimen=mark_specimen",)),
    CsvTable("splice_coefficients", ("specimen",), ("strain_method",)),
    CsvTable("amplitude", ("specimen",), ()),
    CsvTable("line", ("specimen",), ("test_line_refusal",)),
    CsvTable(
        "slow_pull",
        ("specimen", "tension_grid"),
        ("quasi_static_spring_constant", "quasi_static_strain"),
    ),
    CsvTable(
        "slow_pull_cubic",
        ("specimen", "pull_term"),
        ("pull_strain_coefficient",),
        last=(
            "pull_tension_low",
            "pull_tension_high",
            "pull_strain_rate",
            "pull_waiting_time",
            "pull_waiting",
            "pull_residual",
            "pull_reference_tension",
        ),
    ),
    CsvTable("strain_at_break_share", ("specimen", "break_share"), ("strain_at_break_share",)),
    CsvTable(
        "rope_programme",
        ("specimen",),
        ("programme_step",),
        first=("programme_step",),
        last=(*_OF_PAIR, *_OF_HOLD),
        derive=_one_a_specimen,
    ),
    CsvTable(
        "static_stiffness", ("held_pair",), ("held_pair",), first=("specimen=held_pair_specimen",)
    ),
    CsvTable(
        "static_stiffness_times",
        ("held_pair", "held_pair_point"),
        ("static_stiffness_at_time",),
        first=("specimen=held_pair_specimen",),
    ),
    CsvTable(
        "creep", ("hold",), ("creep_tension_over_strength",), first=("specimen=hold_specimen",)
    ),
    CsvTable("tensile", ("specimen",), ("pull_peak_tension",)),
    *SHARED_TABLES,
    CsvTable("channel_lag", ("specimen",), ("channel_lag_refusal",)),
    CsvTable("slips", ("slip",), ("slip_cycle",), first=("specimen=slip_specimen",)),
    CsvTable(
        "identity",
        ("specimen", "cycle"),
        ("stroke_mean_modulus_difference", "tension_loss_modulus", "identity_residual"),
    ),
    CsvTable(
        "mean_identity",
        ("specimen",),
        ("mean_identity_residual",),
        last=("n_cycles",),
        derive=_cycle_count,
    ),
    CsvTable("history", ("specimen",), ("earlier_tests",)),
    CsvTable(
        "trend",
        ("specimen",),
        (
            "peak_tension_per_decade",
            "dynamic_modulus_per_decade",
            "mean_strain_per_decade",
            "mean_strain_drift",
            "alignment_strain",
            "peak_tension_change",
            "n_slips",
        ),
    ),
    CsvTable(
        "elastomer",
        ("elastomer_parameter",),
        ("elastomer_parameter_name",),
        first=("specimen=elastomer_specimen", "elastomer_law"),
        last=(
            "elastomer_rms_stress",
            "elastomer_strain_low",
            "elastomer_strain_high",
            "elastomer_is_stable",
            "elastomer_aicc",
        ),
        derive=_fit_of_parameters,
    ),
    CsvTable("stress_at_strain", ("specimen", "strain_level"), ("stress_at_strain",)),
    CsvTable("slack_strain_at_unloading", ("specimen",), ("slack_strain_at_unloading",)),
    CsvTable(
        "comparison",
        ("comparison", "branch_name", "ratio_strain_bin"),
        ("modulus_ratio",),
        first=("ratio_numerator", "ratio_denominator"),
    ),
    CsvTable(
        "stepwise",
        ("step",),
        ("clock",),
        first=("specimen",),
        last=("relaxed_gauge_length",),
        derive=_one_specimen,
        product="stepwise test",
    ),
    CsvTable(
        "stepwise_moduli",
        ("interval",),
        ("interval_modulus",),
        first=("specimen",),
        derive=_one_specimen,
        product="stepwise test",
    ),
    CsvTable("specimens", ("specimen",), ("specimen_kind",)),
    CsvTable("standstills", ("standstill", "specimen"), ("standstill_start_time",)),
    CsvTable("notes", ("note",), ("note",)),
    CsvTable(
        "rows",
        ("channel", "quality_mask"),
        ("n_flagged",),
        first=("n_rows_read", "n_rows_kept", "n_rows_stored"),
    ),
)
"""Tables of tests."""

_RUN = ("run_name", "run_specimen")

EXPERIMENT_TABLES = (
    CsvTable("experiments", ("experiment",), ("experiment_kind",), product="experiments"),
    CsvTable("factors", ("experiment", "factor"), ("factor_low",), product="experiments"),
    CsvTable(
        "runs",
        ("experiment", "run"),
        ("run_is_there",),
        last=tuple(f"{name}_measured" for name in RESPONSES),
        product="experiments",
    ),
    CsvTable(
        "run_levels",
        ("experiment", "run", "factor"),
        ("run_plan",),
        first=(*_RUN, "factor_name", "run_plan"),
        last=("factor_unit",),
        product="experiments",
    ),
    CsvTable(
        "run_responses",
        ("experiment", "response", "run"),
        ("response_measured", "response_fitted"),
        first=(*_RUN, "unit"),
        product="experiments",
    ),
    CsvTable(
        "surfaces",
        ("experiment", "response", "term"),
        ("response_coefficient",),
        first=("term_name", "unit"),
        last=("term_error", "coefficient_engineering_unit"),
        product="experiments",
    ),
    CsvTable(
        "surface_quality",
        ("experiment", "response"),
        ("response_n_runs",),
        first=("unit",),
        product="experiments",
    ),
    CsvTable(
        "anova",
        ("experiment", "response", "anova_row"),
        ("response_anova_degrees_of_freedom",),
        first=("anova_source", "unit"),
        last=("anova_error_term",),
        product="experiments",
    ),
    CsvTable(
        "stationary_points",
        ("experiment", "response", "factor"),
        ("response_stationary_point",),
        first=("factor_name",),
        last=("factor_unit",),
        product="experiments",
    ),
    CsvTable(
        "eigenvalues",
        ("experiment", "response", "direction", "factor"),
        ("response_eigenvector",),
        first=("unit", "response_eigenvalue", "factor_name"),
        product="experiments",
    ),
    CsvTable(
        "surface_points",
        ("experiment", "response", "point"),
        ("response_point_value",),
        first=("point_name", "point_kind", "response_unit"),
        last=("interval_confidence",),
        product="experiments",
    ),
    CsvTable(
        "point_levels",
        ("experiment", "point", "factor"),
        ("point_coded_level",),
        first=("point_name", "factor_name"),
        last=("factor_unit",),
        product="experiments",
    ),
    CsvTable(
        "blocks",
        ("experiment", "response", "block"),
        ("response_block_effect",),
        first=("block_name", "unit"),
        product="experiments",
    ),
    CsvTable(
        "screening",
        ("experiment", "response", "plan_column"),
        ("effect_is_there",),
        first=("plan_column_name", "unit"),
        last=(
            "response_minimum_significant_effect",
            "response_simultaneous_minimum_effect",
            "response_mean",
            "response_effect_refusal",
        ),
        product="experiments",
    ),
    CsvTable(
        "aliases",
        ("experiment", "interaction", "plan_column"),
        ("effect_alias",),
        first=("interaction_factor", "interaction_other_factor", "plan_column_name"),
        product="experiments",
    ),
    CsvTable(
        "stiffness_forms",
        ("experiment", "stiffness_form"),
        ("stiffness_n_coefficients",),
        product="experiments",
    ),
    CsvTable(
        "stiffness_coefficients",
        ("experiment", "stiffness_form", "stiffness_term"),
        ("stiffness_coefficient",),
        product="experiments",
    ),
    CsvTable(
        "stiffness_runs",
        ("experiment", "stiffness_form", "run"),
        ("stiffness_fitted",),
        first=_RUN,
        product="experiments",
    ),
    CsvTable(
        "single_time", ("experiment",), ("single_time_degrees_of_freedom",), product="experiments"
    ),
    CsvTable(
        "cautions",
        ("caution",),
        ("caution",),
        first=("experiment=caution_experiment",),
        product="experiments",
    ),
    CsvTable(
        "experiment_notes",
        ("note",),
        ("note",),
        first=("experiment=note_experiment",),
        product="experiments",
    ),
    *(
        CsvTable(
            f"shared_errors_{table}",
            ("experiment", "response", COMPONENT, dim),
            (f"response_{name}_uncertainty_contribution",),
            first=(*ERROR, *about, f"response_{name}_uncertainty_contribution"),
            product="experiments",
        )
        for table, dim, name, about in (
            ("surface_points", "point", "point_value", ("point_name", "response_unit")),
            ("stationary_points", "factor", "stationary_point", ("factor_name",)),
            ("eigenvalues", "direction", "eigenvalue", ("unit",)),
        )
    ),
    CsvTable(
        "shared_errors_surfaces",
        ("experiment", "response", COMPONENT, "term"),
        ("response_coefficient_uncertainty_contribution",),
        first=(
            *ERROR,
            "term_name",
            "unit",
            "response_coefficient_uncertainty_contribution",
            "response_coefficient_engineering_uncertainty_contribution",
            "coefficient_engineering_unit",
        ),
        product="experiments",
    ),
)

PREDICTION_TABLES = (
    CsvTable("predictions", ("hose", "hose_point"), ("strain",), product="predictions"),
    CsvTable("hose_events", ("hose", "hose_event"), ("event_strain",), product="predictions"),
    CsvTable("hoses", ("hose",), ("wrap_angle",), product="predictions"),
    CsvTable("cord_layers", ("hose", "cord_layer"), ("layer_diameter",), product="predictions"),
    CsvTable(
        "hose_layers", ("hose", "hose_layer"), ("hose_layer_wrap_angle",), product="predictions"
    ),
)

COMPARISON_TABLES = (
    CsvTable("comparisons", ("comparison",), ("largest_ratio", "verdict"), product="comparisons"),
    CsvTable("comparison_curves", ("comparison", "curve"), ("tension_rms",), product="comparisons"),
    CsvTable(
        "comparison_points",
        ("comparison", "curve", "comparison_point"),
        ("measured_tension",),
        first=("strain",),
        last=("predicted_tension", "validation_uncertainty", "calibrated_tension"),
        product="comparisons",
    ),
    CsvTable(
        "comparison_pressures",
        ("comparison", "comparison_point"),
        ("measured_fill_pressure",),
        first=("strain",),
        product="comparisons",
    ),
    CsvTable(
        "comparison_events", ("comparison", "hose_event"), ("event_strain",), product="comparisons"
    ),
    CsvTable(
        "comparison_cycles",
        ("comparison", "comparison_cycle"),
        ("cycle_bias",),
        product="comparisons",
    ),
    CsvTable(
        "calibrations", ("comparison", "parameter"), ("parameter_value",), product="comparisons"
    ),
    CsvTable(
        "calibration_correlations",
        ("comparison", "parameter", "parameter_other"),
        ("parameter_correlation",),
        first=("parameter_name",),
        product="comparisons",
    ),
    CsvTable(
        "shared_errors_comparisons",
        ("comparison", "curve", "comparison_point", COMPONENT),
        ("measured_tension_uncertainty_contribution",),
        first=("strain", *ERROR, "measured_tension_uncertainty_contribution"),
        product="comparisons",
    ),
)

_CONTRIBUTIONS = tuple(
    f"property_{name}_uncertainty_contribution"
    for name in ("stiffness", "stiffness_over_strength", "strain")
)

PROPERTY_TABLES = (
    CsvTable(
        "change_in_length",
        ("property",),
        ("property",),
        first=("specimen=property_specimen",),
        product="properties",
    ),
    CsvTable(
        "shared_errors_change_in_length",
        ("property", COMPONENT),
        _CONTRIBUTIONS,
        first=(
            "specimen=property_specimen",
            "property_name",
            "property_test",
            *ERROR,
            *_CONTRIBUTIONS,
        ),
        product="properties",
    ),
)
