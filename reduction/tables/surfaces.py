"""Tables of response surfaces and screening: coefficients, quality, points, effects."""

from __future__ import annotations

from reduction.tables.ofexperiments import table_of_experiments

_ERRORS = (
    "uncertainty_source",
    "uncertainty_source_of",
    "uncertainty_source_number",
    "uncertainty_source_degrees_of_freedom",
)

SURFACE_TABLES = (
    table_of_experiments(
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
    table_of_experiments(
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
        table_of_experiments(
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
    table_of_experiments(
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
    table_of_experiments(
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
    table_of_experiments(
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
    table_of_experiments(
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
    table_of_experiments(
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
    table_of_experiments(
        "point_levels",
        ("experiment", "point", "factor"),
        ("point_name", "factor_name", "point_coded_level", "point_level", "factor_unit"),
        ("point_coded_level",),
    ),
    table_of_experiments(
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
    table_of_experiments(
        "blocks",
        ("experiment", "response", "block"),
        ("block_name", "unit", "response_block_effect"),
        ("response_block_effect",),
    ),
    table_of_experiments(
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
    table_of_experiments(
        "aliases",
        ("experiment", "interaction", "plan_column"),
        ("interaction_factor", "interaction_other_factor", "plan_column_name", "effect_alias"),
        ("effect_alias",),
    ),
)
