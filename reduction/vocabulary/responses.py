"""Names of what an experiment says of a response.

``<response>`` is one of `SURFACE_NAMES`, or ``response`` in a table whose rows differ in unit.
"""

from __future__ import annotations

from reduction.vocabulary.row import Quantity

RESPONSES = (
    "apparent_spring_constant",
    "hysteresis_energy",
    "dissipation_spring_constant",
    "relaxation_time",
    "storage_spring_constant",
    "loss_spring_constant",
    "loss_factor",
    "dashpot_coefficient",
)
"""What a response surface can be of."""

SCALES = {"log_": "logarithm of {}", "box_cox_": "Box-Cox transform of {}"}
SURFACE_NAMES = (*RESPONSES, *(f"{scale}{name}" for scale in SCALES for name in RESPONSES))
"""Names of surfaces: of a response, or of its transform, which has no unit."""

RESPONSE_PATTERNS = (
    Quantity("<response>_coefficient", "<unit>", "coefficient, coded units", "003 Tables 3-5"),
    Quantity(
        "<response>_coefficient_engineering",
        "<unit>",
        "coefficient of the factors as numbers of their SI units",
    ),
    Quantity("<response>_t", "1", "Student's t of the coefficient"),
    Quantity("<response>_p_value", "1", "probability of the coefficient if it were nil"),
    Quantity("<response>_term_degrees_of_freedom", "1", "degrees of freedom of the coefficient"),
    Quantity(
        "<response>_covariance_factor", "1", "covariance of two coded coefficients over sigma**2"
    ),
    Quantity(
        "<response>_reduced_coefficient",
        "<unit>",
        "coefficient, coded units, of the terms that AICc keeps; 0 where it does not",
    ),
    Quantity(
        "<response>_reduced_coefficient_standard_uncertainty",
        "<unit>",
        "standard uncertainty (k=1) of that coefficient by the scatter of the runs alone, without "
        "what they share",
    ),
    Quantity(
        "<response>_reduced_coefficient_engineering",
        "<unit>",
        "coefficient, of the kept terms, of the factors as numbers of their SI units",
    ),
    Quantity("<response>_reduced_is_kept", "1", "whether AICc keeps the term"),
    Quantity(
        "<response>_reduced_sigma", "<unit>", "standard deviation of a run about the kept terms"
    ),
    Quantity("<response>_reduced_aicc", "1", "corrected Akaike criterion of the kept terms"),
    Quantity("<response>_full_aicc", "1", "corrected Akaike criterion of all terms"),
    Quantity("<response>_transform", "", "scale the surface was fitted on"),
    Quantity("<response>_transform_exponent", "1", "exponent of Box and Cox; 1 none, 0 logarithm"),
    Quantity("<response>_transform_exponent_low", "1", "lower end of the interval of the exponent"),
    Quantity(
        "<response>_transform_exponent_high", "1", "upper end of the interval of the exponent"
    ),
    Quantity("<response>_n_runs", "1", "number of runs with a value"),
    Quantity("<response>_refusal", "", "what the surface does not give, and why"),
    Quantity("<response>_sigma", "<unit>", "standard deviation of a run about the surface"),
    Quantity("<response>_degrees_of_freedom", "1", "degrees of freedom of sigma"),
    Quantity("<response>_r2", "1", "share of the variation that the surface explains"),
    Quantity("<response>_adjusted_r2", "1", "r2 adjusted for the number of terms"),
    Quantity("<response>_predicted_r2", "1", "r2 of runs predicted each without itself"),
    Quantity("<response>_overall_f", "1", "F of all terms but the mean"),
    Quantity("<response>_overall_p_value", "1", "probability of the overall F if there were none"),
    Quantity(
        "<response>_printed_f",
        "1",
        "F as CG-D-39-80 prints it, which counts the mean twice; for comparison",
        "003 F-ratio, Tables 3-5",
    ),
    Quantity("<response>_lack_of_fit_f", "1", "F of lack of fit against pure error"),
    Quantity("<response>_lack_of_fit_p_value", "1", "probability of that F if the surface fits"),
    Quantity("<response>_lack_of_fit_refusal", "", "why lack of fit is not tested"),
    Quantity(
        "<response>_probability_plot_correlation",
        "1",
        "squared correlation of residuals with normal scores",
    ),
    Quantity(
        "<response>_stationary_point", "1", "coded level of the factor where the slope is nil"
    ),
    Quantity(
        "<response>_stationary_point_engineering",
        "1",
        "level where the slope is nil, as a number of the unit of the factor",
    ),
    Quantity("<response>_stationary_point_is_inside", "1", "whether it lies within the levels"),
    Quantity(
        "<response>_stationary_value", "<unit>", "value of the surface where its slope is nil"
    ),
    Quantity("<response>_stationary_kind", "1", "minimum, maximum or saddle"),
    Quantity("<response>_stationary_refusal", "", "why there is no stationary point"),
    Quantity("<response>_eigenvalue", "<unit>", "curvature along a principal direction"),
    Quantity("<response>_eigenvector", "1", "share of the factor in a principal direction"),
    Quantity("<response>_measured", "<unit>", "mean over the cycles of the run"),
    Quantity("<response>_fitted", "<unit>", "value of the surface at the run"),
    Quantity("<response>_residual", "<unit>", "value of the run less that of the surface"),
    Quantity("<response>_leverage", "1", "share of the run's own value in its fitted one"),
    Quantity("<response>_cooks_distance", "1", "shift of the surface if the run were left out"),
    Quantity("<response>_studentized_residual", "1", "residual over its own standard deviation"),
    Quantity("<response>_deleted_residual", "1", "the same, with the scatter of the other runs"),
    Quantity("<response>_anova_degrees_of_freedom", "1", "degrees of freedom of the source"),
    Quantity("<response>_anova_sum_of_squares", "<unit squared>", "sum of squares of the source"),
    Quantity("<response>_anova_mean_square", "<unit squared>", "mean square of the source"),
    Quantity("<response>_anova_f", "1", "F of the source against its error term"),
    Quantity("<response>_anova_p_value", "1", "probability of that F if the source were nil"),
    Quantity("<response>_block_effect", "<unit>", "block above the mean over the blocks"),
    Quantity("<response>_block_standard_deviation", "<unit>", "standard deviation between blocks"),
    Quantity("<response>_block_at_boundary", "1", "whether the blocks differ no more than runs"),
    Quantity("<response>_effect", "<unit>", "mean at the high level less that at the low one"),
    Quantity(
        "<response>_effect_standard_uncertainty",
        "<unit>",
        "standard uncertainty (k=1) of an effect by the scatter of the runs alone, without what "
        "they share",
    ),
    Quantity("<response>_effect_t", "1", "Student's t of the effect"),
    Quantity("<response>_effect_p_value", "1", "probability of the effect if it were nil"),
    Quantity("<response>_effect_is_significant", "1", "whether the effect is above the minimum"),
    Quantity("<response>_effect_refusal", "", "why the response has no effects"),
    Quantity("<response>_effect_size", "<unit>", "size of the effect, without its sign"),
    Quantity(
        "<response>_effect_half_normal_quantile",
        "1",
        "quantile of the size among all columns, were they noise alone",
    ),
    Quantity("<response>_mean", "<unit>", "mean over the runs"),
    Quantity("<response>_minimum_significant_effect", "<unit>", "least significant effect"),
    Quantity(
        "<response>_simultaneous_minimum_effect", "<unit>", "least effect, all of them together"
    ),
    Quantity(
        "<response>_point_value",
        "<response unit>",
        "value of the surface at the point; the median where it is transformed",
    ),
    Quantity("<response>_point_mean_value", "<response unit>", "mean response at the point"),
    Quantity("<response>_point_variance_factor", "1", "variance of the surface over sigma**2"),
    Quantity(
        "<response>_point_is_above_leverage",
        "1",
        "whether the runs say less at the point than at the worst of them",
    ),
    Quantity(
        "<response>_point_confidence_low",
        "<response unit>",
        "lower end of the interval of the surface at this point alone",
    ),
    Quantity(
        "<response>_point_confidence_high",
        "<response unit>",
        "upper end of the interval of the surface at this point alone",
    ),
    Quantity(
        "<response>_point_prediction_low",
        "<response unit>",
        "lower end of the interval of one more run there",
    ),
    Quantity(
        "<response>_point_prediction_high",
        "<response unit>",
        "upper end of the interval of one more run there",
    ),
    Quantity(
        "<response>_point_simultaneous_low",
        "<response unit>",
        "lower end of the interval of the surface, everywhere at once",
    ),
    Quantity(
        "<response>_point_simultaneous_high",
        "<response unit>",
        "upper end of the interval of the surface, everywhere at once",
    ),
    Quantity(
        "<response>_ridge_coded_level",
        "1",
        "coded level of the factor where the surface is highest, or lowest, at that distance",
    ),
    Quantity("<response>_ridge_level", "1", "that level as a number of the unit of the factor"),
    Quantity(
        "<response>_ridge_value",
        "<response unit>",
        "highest, or lowest, value of the surface at that distance",
    ),
    Quantity(
        "<response>_ridge_simultaneous_low",
        "<response unit>",
        "lower end of the interval of the surface, everywhere at once",
    ),
    Quantity(
        "<response>_ridge_simultaneous_high",
        "<response unit>",
        "upper end of the interval of the surface, everywhere at once",
    ),
)
