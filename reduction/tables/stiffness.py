"""Tables of the stiffness forms of mooring codes, and of one relaxation time for all runs."""

from __future__ import annotations

from reduction.tables.ofexperiments import RUN, table_of_experiments

STIFFNESS_TABLES = (
    table_of_experiments(
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
    table_of_experiments(
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
    table_of_experiments(
        "stiffness_runs",
        ("experiment", "stiffness_form", "run"),
        (*RUN, "stiffness_fitted", "stiffness_residual"),
        ("stiffness_fitted",),
    ),
    table_of_experiments(
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
