"""Tables of rubber: laws of elastomers, stress at a strain, slack, ratios, weights hung by hand."""

from __future__ import annotations

from reduction.tables.derived import fit_of_parameters, one_specimen
from reduction.tables.table import Table

RUBBER_TABLES = (
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
        fit_of_parameters,
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
            "modulus_ratio_degrees_of_freedom",
        ),
        ("modulus_ratio",),
    ),
)
"""Of tests with a machine."""

STEPWISE_TABLES = (
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
        one_specimen,
        product="stepwise test",
    ),
    Table(
        "stepwise_moduli",
        ("interval",),
        ("specimen", "interval_branch", "interval_strain", "interval_modulus"),
        ("interval_modulus",),
        one_specimen,
        product="stepwise test",
    ),
)
"""Of tests with weights that were hung by hand."""
