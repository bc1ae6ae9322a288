"""Which tables of comparisons there are."""

from __future__ import annotations

from reduction.archive.shared import COMPONENT
from reduction.tables.shared import ERROR
from reduction.tables.table import Table


def _table(
    name: str, dims: tuple[str, ...], variables: tuple[str, ...], needs: tuple[str, ...]
) -> Table:
    return Table(name, dims, variables, needs, product="comparisons")


_OF = ("comparison_test", "comparison_specimen", "comparison_hose", "comparison_loading")

COMPARISON_TABLES = (
    _table(
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
    _table(
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
    _table(
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
    _table(
        "shared_errors_comparisons",
        ("comparison", "curve", "comparison_point", COMPONENT),
        (
            "strain",
            *ERROR,
            "measured_tension_uncertainty_contribution",
        ),
        ("measured_tension_uncertainty_contribution",),
    ),
    _table(
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
    _table(
        "comparison_cycles",
        ("comparison", "comparison_cycle"),
        ("comparison_cycle_number", "cycle_bias", "cycle_rms"),
        ("cycle_bias",),
    ),
    _table(
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
    _table(
        "calibration_correlations",
        ("comparison", "parameter", "parameter_other"),
        ("parameter_name", "parameter_correlation"),
        ("parameter_correlation",),
    ),
)
