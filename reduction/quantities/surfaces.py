"""Numbers of experiments: designs, runs, response surfaces, screening, forms of stiffness."""

from __future__ import annotations

from reduction.quantities.axes import AXES
from reduction.quantities.flags import NO_YES, STATIONARY_KINDS
from reduction.quantities.row import (
    BOUND,
    CHECK,
    COMPONENT,
    COUNT,
    CRITERION,
    PART,
    SETTING,
    SPREAD,
    STATISTIC,
    STRENGTH,
    Quantity,
    again,
    along,
    count,
    flag,
    label,
    measured,
    stated,
)

_ANOVA = ("experiment", "anova_row")

_CAUTION = ("caution",)

_COLUMN = ("experiment", "plan_column")

_DIRECTION = ("experiment", "direction")

_EXPERIMENT = ("experiment",)

_FACTOR = ("experiment", "factor")

_FORM = ("experiment", "stiffness_form")

_FORM_TERM = ("experiment", "stiffness_form", "stiffness_term")

_NOTE = ("note",)

_RIDGE = ("experiment", "ridge_direction", "ridge_radius")

_RUN = ("experiment", "run")

_SHARED_ERROR = ("experiment", COMPONENT)

_SURFACE_POINT = ("experiment", "point")

_TERM = ("experiment", "term")

_AXES = {row.name: row for row in AXES}


OF_EXPERIMENTS: tuple[Quantity, ...] = (
    *along(
        _EXPERIMENT,
        label("experiment", "experiment"),
        label("experiment_kind", "kind of design", tables=("experiments",)),
    ),
    *along(
        ("factor",),
        count("factor", "number of the factor"),
    ),
    *along(
        _FACTOR,
        label("factor_name", "factor", tables=("factors",)),
        stated(
            "factor_low",
            "1",
            "level that is -1, as a number of the unit of the factor",
            "as planned",
            tables=("factors",),
        ),
        stated(
            "factor_high",
            "1",
            "level that is +1, as a number of the unit of the factor",
            "as planned",
            tables=("factors",),
        ),
        label("factor_unit", "SI unit of the factor", tables=("factors",)),
    ),
    *along(
        ("term",),
        label("term", "coefficient as printed", source="003 B1..B10, eq 5"),
    ),
    *along(
        _TERM,
        label("term_name", "term of the surface"),
        label("term_unit_engineering", "unit by which that of the response is multiplied"),
    ),
    *along(
        ("term_other",),
        label("term_other", "coefficient as printed, second axis"),
        group="coefficients",
    ),
    *along(
        _TERM,
        label("term_error", "what the coefficient is judged by"),
        group="coefficients",
    ),
    *along(
        ("experiment", "term", "factor"),
        stated("term_exponent", "1", "power of the factor in the term", "exact"),
        group="coefficients",
    ),
    *along(
        _EXPERIMENT,
        stated(
            "replicate_tolerance",
            "1",
            "largest difference of coded levels between repeats",
            SETTING,
            tables=("experiments",),
        ),
        stated(
            "condition_number",
            "1",
            "condition number of the model matrix",
            "a property of the levels",
            tables=("experiments",),
        ),
        group="quality",
    ),
    *along(
        _ANOVA,
        label("anova_source", "source of variation"),
        label("anova_error_term", "what the source is tested against"),
        group="anova",
    ),
    *along(
        ("direction",),
        count("direction", "number of the principal direction, curvature falling"),
        group="stationary_point",
    ),
    *along(
        ("run",),
        count("run", "number of the run, in the order of the campaign"),
        group="runs",
    ),
    *along(
        _RUN,
        label("run_name", "test or step that was the run", tables=("runs",)),
        label("run_specimen", "specimen of the run", tables=("runs",)),
        label("run_block", "block of the run", tables=("runs",)),
        stated(
            "run_frequency",
            "Hz",
            "cycle frequency, mean over the run",
            "its uncertainty stands in the archive of the run",
            tables=("runs",),
        ),
        stated(
            "run_mean_tension",
            "N",
            "mean tension, mean over the run",
            "its uncertainty stands in the archive of the run",
            tables=("runs",),
        ),
        stated(
            "run_tension_amplitude",
            "N",
            "tension amplitude, mean over the run",
            "its uncertainty stands in the archive of the run",
            tables=("runs",),
        ),
        stated(
            "run_peak_tension",
            "N",
            "greatest tension of the run's cycles",
            "its uncertainty stands in the archive of the run",
            tables=("runs",),
        ),
        stated(
            "run_minimum_tension",
            "N",
            "least tension of the run's cycles",
            "its uncertainty stands in the archive of the run",
            tables=("runs",),
        ),
        stated(
            "run_rated_break_strength",
            "N",
            "rated break strength of the run's specimen",
            STRENGTH,
            tables=("runs",),
        ),
        stated(
            "derived_dissipation_spring_constant",
            "N",
            "dissipation spring constant from the surfaces of the storage and loss spring "
            "constants",
            "not evaluated by this version",
            tables=("runs",),
        ),
        stated(
            "derived_relaxation_time",
            "s",
            "relaxation time from the surfaces of the storage and loss spring constants",
            "not evaluated by this version",
            tables=("runs",),
        ),
        count(
            "run_cell",
            "runs with one number count as repeats; 0 where it has no levels",
            tables=("runs",),
        ),
        label("run_remark", "why a run has no number", tables=("runs",)),
        group="runs",
    ),
    *along(
        ("experiment", "run", "plan_column"),
        stated("run_plan", "1", "coded level of the column in the run, as planned", "as planned"),
        group="runs",
    ),
    *along(
        ("experiment", "run", "factor"),
        stated(
            "run_coded_level",
            "1",
            "coded level in the run, as reached",
            "its uncertainty stands in the archive of the run",
            tables=("run_levels",),
        ),
        stated(
            "run_level",
            "1",
            "level in the run as reached, as a number of the factor's unit",
            "its uncertainty stands in the archive of the run",
            tables=("run_levels",),
        ),
        group="runs",
    ),
    *along(
        ("point",),
        count("point", "number of the point: centre, points of the plan, corners"),
        group="points",
    ),
    *along(
        _SURFACE_POINT,
        label("point_name", "coded levels of the point"),
        label("point_kind", "where in the cube of the levels the point lies"),
        group="points",
    ),
    *along(
        ("experiment", "point", "factor"),
        stated(
            "point_coded_level",
            "1",
            "coded level of the factor at the point",
            "as planned",
            tables=("point_levels",),
        ),
        stated(
            "point_level",
            "1",
            "level at the point, as a number of the unit of the factor",
            "as planned",
            tables=("point_levels",),
        ),
        group="points",
    ),
    *along(
        ("ridge_direction",),
        label("ridge_direction", "the way up from the centre, or down"),
        group="points",
    ),
    *along(
        ("ridge_radius",),
        stated("ridge_radius", "1", "coded distance from the centre", "exact"),
        group="points",
    ),
    *along(
        _EXPERIMENT,
        stated(
            "interval_confidence",
            "1",
            "confidence of the intervals at points and along ridges",
            SETTING,
        ),
        group="points",
    ),
    *along(
        ("experiment", "block"),
        label("block_name", "block"),
        group="blocks",
    ),
    *along(
        _EXPERIMENT,
        label("block_treatment", "whether the blocks are fixed or random", tables=("experiments",)),
        group="blocks",
    ),
    *along(
        ("plan_column",),
        count("plan_column", "number of the column of the plan"),
        group="screening",
    ),
    *along(
        _COLUMN,
        label("plan_column_name", "factor of the column, or dummy"),
        group="screening",
    ),
    *along(
        _EXPERIMENT,
        label(
            "effect_error_from",
            "what the error of the effects is from: dummy or lenth",
            tables=("experiments",),
        ),
        stated(
            "effect_degrees_of_freedom",
            "1",
            "degrees of freedom of the error of the effects",
            COUNT,
            tables=("experiments",),
        ),
        stated(
            "effect_significance",
            "1",
            "level of the least significant effect, two-sided",
            SETTING,
            tables=("experiments",),
        ),
        group="screening",
    ),
    *along(
        ("interaction",),
        count("interaction", "number of the two-factor interaction"),
        group="screening",
    ),
    *along(
        ("experiment", "interaction"),
        label("interaction_factor", "one factor of the interaction"),
        label("interaction_other_factor", "the other factor of the interaction"),
        group="screening",
    ),
    *along(
        ("experiment", "interaction", "plan_column"),
        stated(
            "effect_alias",
            "1",
            "share of the interaction that stands in the effect of the column",
            "a property of the levels",
            tables=("aliases",),
        ),
        group="screening",
    ),
    *along(
        ("stiffness_form",),
        label("stiffness_form", "form of dynamic stiffness"),
        group="stiffness",
    ),
    *along(
        ("stiffness_term",),
        count("stiffness_term", "number of the coefficient of the form"),
        group="stiffness",
    ),
    *along(
        ("stiffness_term_other",),
        count("stiffness_term_other", "number of the coefficient of the form, second axis"),
        group="stiffness",
    ),
    *along(
        _FORM,
        label("stiffness_equation", "equation of the form", tables=("stiffness_forms",)),
        stated(
            "stiffness_n_coefficients",
            "1",
            "number of coefficients of the form",
            COUNT,
            tables=("stiffness_forms",),
        ),
        stated(
            "stiffness_mean_load_low",
            "1",
            "lowest mean tension over the break strength",
            BOUND,
            tables=("stiffness_forms",),
        ),
        stated(
            "stiffness_mean_load_high",
            "1",
            "highest mean tension over the break strength",
            BOUND,
            tables=("stiffness_forms",),
        ),
        stated(
            "stiffness_confidence",
            "1",
            "confidence of the intervals of the coefficients",
            SETTING,
            tables=("stiffness_forms",),
        ),
        stated(
            "stiffness_sigma",
            "1",
            "standard deviation about the form, over break strength",
            SPREAD,
            tables=("stiffness_forms",),
        ),
        stated(
            "stiffness_degrees_of_freedom",
            "1",
            "degrees of freedom of the form",
            COUNT,
            tables=("stiffness_forms",),
        ),
        stated(
            "stiffness_r2",
            "1",
            "share of the variation that the form explains",
            CRITERION,
            tables=("stiffness_forms",),
        ),
        stated(
            "stiffness_adjusted_r2",
            "1",
            "adjusted r2 of the form",
            CRITERION,
            tables=("stiffness_forms",),
        ),
        stated(
            "stiffness_predicted_r2",
            "1",
            "r2 of runs predicted each without itself",
            CRITERION,
            tables=("stiffness_forms",),
        ),
        stated(
            "stiffness_prediction_sum_of_squares",
            "1",
            "PRESS of the form, over break strength",
            CRITERION,
            tables=("stiffness_forms",),
        ),
        stated(
            "stiffness_aicc",
            "1",
            "corrected Akaike criterion of the form, lower is better",
            CRITERION,
            tables=("stiffness_forms",),
        ),
        label("stiffness_refusal", "why the form has no number", tables=("stiffness_forms",)),
        group="stiffness",
    ),
    *along(
        _FORM_TERM,
        label(
            "stiffness_coefficient_name",
            "coefficient of the form",
            tables=("stiffness_coefficients",),
        ),
        label(
            "stiffness_coefficient_unit",
            "unit of the coefficient of the form",
            tables=("stiffness_coefficients",),
        ),
        measured(
            "stiffness_coefficient",
            "1",
            "coefficient of the form, as a number of its unit",
            uncertainty_is=(
                "standard uncertainty (k=1) of that coefficient by the scatter of the runs alone, "
                "without what they share"
            ),
            tables=("stiffness_coefficients",),
        ),
        stated(
            "stiffness_coefficient_low",
            "1",
            "lower end of the interval of the coefficient, by the scatter of the runs alone",
            BOUND,
            tables=("stiffness_coefficients",),
        ),
        stated(
            "stiffness_coefficient_high",
            "1",
            "upper end of the interval of the coefficient, by the scatter of the runs alone",
            BOUND,
            tables=("stiffness_coefficients",),
        ),
        stated(
            "stiffness_p_value",
            "1",
            "probability of the coefficient if it were nil",
            STATISTIC,
            tables=("stiffness_coefficients",),
        ),
        group="stiffness",
    ),
    *along(
        ("experiment", "stiffness_form", "stiffness_term", "stiffness_term_other"),
        stated("stiffness_covariance", "1", "covariance of two coefficients of the form", PART),
        group="stiffness",
    ),
    *along(
        ("experiment", "stiffness_form", "run"),
        stated(
            "stiffness_fitted",
            "N",
            "apparent spring constant by the form",
            "from the surface: see its covariance",
            tables=("stiffness_runs",),
        ),
        stated(
            "stiffness_residual",
            "N",
            "apparent spring constant less that by the form",
            CHECK,
            tables=("stiffness_runs",),
        ),
        group="stiffness",
    ),
    *along(
        _EXPERIMENT,
        measured(
            "single_time_exponent",
            "1",
            "n of relaxation time ~ frequency**-n",
            uncertainty_is=(
                "standard uncertainty (k=1) of n by the scatter of the runs alone, without what "
                "they share"
            ),
            tables=("single_time",),
        ),
        stated(
            "single_time_exponent_low",
            "1",
            "lower end of the interval of n, by the scatter of the runs alone",
            BOUND,
            tables=("single_time",),
        ),
        stated(
            "single_time_exponent_high",
            "1",
            "upper end of the interval of n, by the scatter of the runs alone",
            BOUND,
            tables=("single_time",),
        ),
        stated(
            "single_time_p_value_one_time",
            "1",
            "probability of such an n if it were 0",
            STATISTIC,
            tables=("single_time",),
        ),
        stated(
            "single_time_p_value_inverse_frequency",
            "1",
            "probability of such an n if it were 1",
            STATISTIC,
            tables=("single_time",),
        ),
        stated(
            "single_time_degrees_of_freedom",
            "1",
            "degrees of freedom of the exponent",
            COUNT,
            tables=("single_time",),
        ),
        stated(
            "single_time_frequency_ratio",
            "1",
            "highest over lowest frequency",
            "its uncertainty stands in the archive of the run",
            tables=("single_time",),
        ),
        stated(
            "single_time_ratio",
            "1",
            "relaxation time at the lowest over that at the highest frequency",
            "see the ends of its interval",
            tables=("single_time",),
        ),
        stated(
            "single_time_ratio_low",
            "1",
            "lower end of the interval of the ratio of times",
            BOUND,
            tables=("single_time",),
        ),
        stated(
            "single_time_ratio_high",
            "1",
            "upper end of the interval of the ratio of times",
            BOUND,
            tables=("single_time",),
        ),
        stated(
            "single_time_loss_exponent",
            "1",
            "m of loss factor ~ frequency**m",
            "see the ends of its interval",
            tables=("single_time",),
        ),
        stated(
            "single_time_loss_exponent_low",
            "1",
            "lower end of the interval of m",
            BOUND,
            tables=("single_time",),
        ),
        stated(
            "single_time_loss_exponent_high",
            "1",
            "upper end of the interval of m",
            BOUND,
            tables=("single_time",),
        ),
        stated(
            "single_time_confidence",
            "1",
            "confidence of the intervals of the exponents",
            SETTING,
            tables=("single_time",),
        ),
        stated(
            "single_time_tolerance",
            "1",
            "by which an exponent may miss 0 or 1",
            SETTING,
            tables=("single_time",),
        ),
        label(
            "single_time_verdict",
            "whether one relaxation time holds over frequency",
            tables=("single_time",),
        ),
        group="single_time",
    ),
    *along(
        _SHARED_ERROR,
        again(_AXES["uncertainty_source"]),
        again(_AXES["uncertainty_source_of"]),
        again(_AXES["uncertainty_source_number"]),
        again(_AXES["uncertainty_source_degrees_of_freedom"]),
        group="uncertainty",
    ),
    *along(
        _NOTE,
        label("note_experiment", "experiment that the note is of"),
        group="notes",
    ),
    *along(
        _CAUTION,
        label("caution", "what to know of the runs as reached"),
        label("caution_kind", "kind of caution", tables=("cautions",)),
        label("caution_hint", "what can be done about it", tables=("cautions",)),
        label(
            "caution_runs",
            "runs that the caution is of; empty: the experiment",
            tables=("cautions",),
        ),
        label("caution_experiment", "experiment that the caution is of"),
        group="notes",
    ),
)

OF_EVERY_SURFACE: tuple[Quantity, ...] = (
    *along(
        _TERM,
        measured(
            "<response>_coefficient",
            "<unit>",
            "coefficient, coded units",
            shares_errors=True,
            tables=("surfaces",),
            source="003 Tables 3-5",
        ),
        stated(
            "<response>_p_value",
            "1",
            "probability of the coefficient if it were nil",
            STATISTIC,
            tables=("surfaces",),
        ),
    ),
    *along(
        _TERM,
        stated(
            "<response>_t", "1", "Student's t of the coefficient", STATISTIC, tables=("surfaces",)
        ),
        stated(
            "<response>_term_degrees_of_freedom",
            "1",
            "degrees of freedom of the coefficient",
            COUNT,
            tables=("surfaces",),
        ),
        measured(
            "<response>_coefficient_engineering",
            "<unit>",
            "coefficient of the factors as numbers of their SI units",
            shares_errors=True,
            tables=("surfaces",),
        ),
        flag(
            "<response>_reduced_is_kept",
            "whether AICc keeps the term",
            NO_YES,
            tables=("surfaces",),
        ),
        measured(
            "<response>_reduced_coefficient",
            "<unit>",
            "coefficient, coded units, of the terms that AICc keeps; 0 where it does not",
            uncertainty_is=(
                "standard uncertainty (k=1) of that coefficient by the scatter of the runs alone, "
                "without what they share"
            ),
            tables=("surfaces",),
        ),
        stated(
            "<response>_reduced_coefficient_engineering",
            "<unit>",
            "coefficient, of the kept terms, of the factors as numbers of their SI units",
            "see the coded one",
            tables=("surfaces",),
        ),
        group="coefficients",
    ),
    *along(
        ("experiment", "term", "term_other"),
        stated(
            "<response>_covariance_factor",
            "1",
            "covariance of two coded coefficients over sigma**2",
            PART,
        ),
        group="coefficients",
    ),
    *along(
        _EXPERIMENT,
        stated(
            "<response>_full_aicc",
            "1",
            "corrected Akaike criterion of all terms",
            CRITERION,
            tables=("surface_quality",),
        ),
        stated(
            "<response>_reduced_aicc",
            "1",
            "corrected Akaike criterion of the kept terms",
            CRITERION,
            tables=("surface_quality",),
        ),
        stated(
            "<response>_reduced_sigma",
            "<unit>",
            "standard deviation of a run about the kept terms",
            SPREAD,
            tables=("surface_quality",),
        ),
        group="coefficients",
    ),
    *along(
        _EXPERIMENT,
        label(
            "<response>_transform", "scale the surface was fitted on", tables=("surface_quality",)
        ),
        stated(
            "<response>_transform_exponent",
            "1",
            "exponent of Box and Cox; 1 none, 0 logarithm",
            "see the ends of its interval",
            tables=("surface_quality",),
        ),
        stated(
            "<response>_transform_exponent_low",
            "1",
            "lower end of the interval of the exponent",
            BOUND,
            tables=("surface_quality",),
        ),
        stated(
            "<response>_transform_exponent_high",
            "1",
            "upper end of the interval of the exponent",
            BOUND,
            tables=("surface_quality",),
        ),
        stated(
            "<response>_n_runs",
            "1",
            "number of runs with a value",
            COUNT,
            tables=("surface_quality",),
        ),
        label(
            "<response>_refusal",
            "what the surface does not give, and why",
            tables=("surface_quality",),
        ),
        stated(
            "<response>_sigma",
            "<unit>",
            "standard deviation of a run about the surface",
            SPREAD,
            tables=("surface_quality",),
        ),
        stated(
            "<response>_degrees_of_freedom",
            "1",
            "degrees of freedom of sigma",
            COUNT,
            tables=("surface_quality",),
        ),
        stated(
            "<response>_r2",
            "1",
            "share of the variation that the surface explains; with blocks, of that within them",
            CRITERION,
            tables=("surface_quality",),
        ),
        stated(
            "<response>_adjusted_r2",
            "1",
            "r2 adjusted for the number of terms; with blocks, within them",
            CRITERION,
            tables=("surface_quality",),
        ),
        stated(
            "<response>_predicted_r2",
            "1",
            "r2 of runs predicted each without itself; with blocks, within them",
            CRITERION,
            tables=("surface_quality",),
        ),
        stated(
            "<response>_overall_f",
            "1",
            "F of all terms but the mean",
            STATISTIC,
            tables=("surface_quality",),
        ),
        stated(
            "<response>_overall_p_value",
            "1",
            "probability of the overall F if there were none",
            STATISTIC,
            tables=("surface_quality",),
        ),
        stated(
            "<response>_printed_f",
            "1",
            "F as CG-D-39-80 prints it, which counts the mean twice; for comparison",
            STATISTIC,
            tables=("surface_quality",),
            source="003 F-ratio, Tables 3-5",
        ),
        stated(
            "<response>_lack_of_fit_f",
            "1",
            "F of lack of fit against pure error",
            STATISTIC,
            tables=("surface_quality",),
        ),
        stated(
            "<response>_lack_of_fit_p_value",
            "1",
            "probability of that F if the surface fits",
            STATISTIC,
            tables=("surface_quality",),
        ),
        label(
            "<response>_lack_of_fit_refusal",
            "why lack of fit is not tested",
            tables=("surface_quality",),
        ),
        stated(
            "<response>_probability_plot_correlation",
            "1",
            "squared correlation of residuals with normal scores",
            CRITERION,
            tables=("surface_quality",),
        ),
        group="quality",
    ),
    *along(
        _ANOVA,
        stated(
            "<response>_anova_degrees_of_freedom",
            "1",
            "degrees of freedom of the source",
            COUNT,
            tables=("anova",),
        ),
        stated(
            "<response>_anova_sum_of_squares",
            "<unit squared>",
            "sum of squares of the source",
            SPREAD,
            tables=("anova",),
        ),
        stated(
            "<response>_anova_mean_square",
            "<unit squared>",
            "mean square of the source",
            SPREAD,
            tables=("anova",),
        ),
        stated(
            "<response>_anova_f",
            "1",
            "F of the source against its error term",
            STATISTIC,
            tables=("anova",),
        ),
        stated(
            "<response>_anova_p_value",
            "1",
            "probability of that F if the source were nil",
            STATISTIC,
            tables=("anova",),
        ),
        group="anova",
    ),
    *along(
        _FACTOR,
        measured(
            "<response>_stationary_point",
            "1",
            "coded level of the factor where the slope is nil",
            shares_errors=True,
            tables=("stationary_points",),
        ),
        stated(
            "<response>_stationary_point_engineering",
            "1",
            "level where the slope is nil, as a number of the unit of the factor",
            "see the coded one",
            tables=("stationary_points",),
        ),
        group="stationary_point",
    ),
    *along(
        _EXPERIMENT,
        flag(
            "<response>_stationary_kind",
            "minimum, maximum or saddle",
            STATIONARY_KINDS,
            tables=("surface_quality",),
        ),
        stated(
            "<response>_stationary_value",
            "<unit>",
            "value of the surface where its slope is nil",
            "from the surface: see its covariance",
            tables=("surface_quality",),
        ),
        flag(
            "<response>_stationary_point_is_inside",
            "whether it lies within the levels",
            NO_YES,
            tables=("surface_quality",),
        ),
        label(
            "<response>_stationary_refusal",
            "why there is no stationary point",
            tables=("surface_quality",),
        ),
        group="stationary_point",
    ),
    *along(
        _DIRECTION,
        measured(
            "<response>_eigenvalue",
            "<unit>",
            "curvature along a principal direction",
            shares_errors=True,
        ),
        group="stationary_point",
    ),
    *along(
        ("experiment", "direction", "factor"),
        stated(
            "<response>_eigenvector",
            "1",
            "share of the factor in a principal direction",
            "a direction: see the covariance of the coefficients",
            tables=("eigenvalues",),
        ),
        group="stationary_point",
    ),
    *along(
        _RUN,
        stated(
            "<response>_fitted",
            "<unit>",
            "value of the surface at the run",
            "from the surface: see its covariance",
            tables=("run_responses",),
        ),
        stated(
            "<response>_residual",
            "<unit>",
            "value of the run less that of the surface",
            CHECK,
            tables=("run_responses",),
        ),
        stated(
            "<response>_leverage",
            "1",
            "share of the run's own value in its fitted one",
            "says how much a run counts",
            tables=("run_responses",),
        ),
        stated(
            "<response>_studentized_residual",
            "1",
            "residual over its own standard deviation",
            CHECK,
            tables=("run_responses",),
        ),
        stated(
            "<response>_deleted_residual",
            "1",
            "the same, with the scatter of the other runs",
            CHECK,
            tables=("run_responses",),
        ),
        stated(
            "<response>_cooks_distance",
            "1",
            "shift of the surface if the run were left out",
            "says how much a run counts",
            tables=("run_responses",),
        ),
        group="runs",
    ),
    *along(
        _SURFACE_POINT,
        measured(
            "<response>_point_value",
            "<response unit>",
            "value of the surface at the point; the median where it is transformed",
            shares_errors=True,
            tables=("surface_points",),
        ),
        stated(
            "<response>_point_discrepancy",
            "<response unit>",
            "standard uncertainty of what a quadratic may miss at the point; in that of the value",
            SPREAD,
            tables=("surface_points",),
        ),
        stated(
            "<response>_point_value_degrees_of_freedom",
            "1",
            "of the random part of the uncertainty of the value: scatter and discrepancy",
            COUNT,
            tables=("surface_points",),
        ),
        stated(
            "<response>_point_mean_value",
            "<response unit>",
            "mean response at the point",
            "see the intervals of the value",
            tables=("surface_points",),
        ),
        stated(
            "<response>_point_confidence_low",
            "<response unit>",
            "lower end of the interval of the surface at this point alone",
            BOUND,
            tables=("surface_points",),
        ),
        stated(
            "<response>_point_confidence_high",
            "<response unit>",
            "upper end of the interval of the surface at this point alone",
            BOUND,
            tables=("surface_points",),
        ),
        stated(
            "<response>_point_prediction_low",
            "<response unit>",
            "lower end of the interval of one more run there",
            BOUND,
            tables=("surface_points",),
        ),
        stated(
            "<response>_point_prediction_high",
            "<response unit>",
            "upper end of the interval of one more run there",
            BOUND,
            tables=("surface_points",),
        ),
        stated(
            "<response>_point_simultaneous_low",
            "<response unit>",
            "lower end of the interval of the surface, everywhere at once",
            BOUND,
            tables=("surface_points",),
        ),
        stated(
            "<response>_point_simultaneous_high",
            "<response unit>",
            "upper end of the interval of the surface, everywhere at once",
            BOUND,
            tables=("surface_points",),
        ),
        stated(
            "<response>_point_variance_factor",
            "1",
            "variance of the surface over sigma**2",
            "a property of the levels",
            tables=("surface_points",),
        ),
        flag(
            "<response>_point_is_above_leverage",
            "whether the runs say less at the point than at the worst of them",
            NO_YES,
            tables=("surface_points",),
        ),
        group="points",
    ),
    *along(
        ("experiment", "ridge_direction", "ridge_radius", "factor"),
        stated(
            "<response>_ridge_coded_level",
            "1",
            "coded level of the factor where the surface is highest, or lowest, at that distance",
            "not evaluated by this version",
            tables=("ridge",),
        ),
        stated(
            "<response>_ridge_level",
            "1",
            "that level as a number of the unit of the factor",
            "not evaluated by this version",
            tables=("ridge",),
        ),
        group="points",
    ),
    *along(
        _RIDGE,
        stated(
            "<response>_ridge_value",
            "<response unit>",
            "highest, or lowest, value of the surface at that distance",
            "see its simultaneous interval",
        ),
        stated(
            "<response>_ridge_simultaneous_low",
            "<response unit>",
            "lower end of the interval of the surface, everywhere at once",
            BOUND,
        ),
        stated(
            "<response>_ridge_simultaneous_high",
            "<response unit>",
            "upper end of the interval of the surface, everywhere at once",
            BOUND,
        ),
        group="points",
    ),
    *along(
        ("experiment", "block"),
        stated(
            "<response>_block_effect",
            "<unit>",
            "block above the mean over the blocks",
            "not evaluated by this version",
            tables=("blocks",),
        ),
        group="blocks",
    ),
    *along(
        _EXPERIMENT,
        stated(
            "<response>_block_standard_deviation",
            "<unit>",
            "standard deviation between blocks",
            SPREAD,
            tables=("surface_quality",),
        ),
        flag(
            "<response>_block_at_boundary",
            "whether the blocks differ no more than runs",
            NO_YES,
            tables=("surface_quality",),
        ),
        group="blocks",
    ),
)

OF_RESPONSES: tuple[Quantity, ...] = (
    *along(
        _RUN,
        measured(
            "<response>_measured",
            "<unit>",
            "mean over the cycles of the run",
            "_random_standard_uncertainty",
            tables=("run_responses",),
        ),
        group="runs",
    ),
    *along(
        _COLUMN,
        measured(
            "<response>_effect",
            "<unit>",
            "mean at the high level less that at the low one",
            uncertainty_dims=_EXPERIMENT,
            uncertainty_is=(
                "standard uncertainty (k=1) of an effect by the scatter of the runs alone, without "
                "what they share"
            ),
            tables=("screening",),
        ),
        stated(
            "<response>_effect_t",
            "1",
            "Student's t of the effect",
            STATISTIC,
            tables=("screening",),
        ),
        stated(
            "<response>_effect_p_value",
            "1",
            "probability of the effect if it were nil",
            STATISTIC,
            tables=("screening",),
        ),
        flag(
            "<response>_effect_is_significant",
            "whether the effect is above the minimum",
            NO_YES,
            tables=("screening",),
        ),
        stated(
            "<response>_effect_size",
            "<unit>",
            "size of the effect, without its sign",
            "that of the effect",
            tables=("screening",),
        ),
        stated(
            "<response>_effect_half_normal_quantile",
            "1",
            "quantile of the size among all columns, were they noise alone",
            "a property of the order",
            tables=("screening",),
        ),
        group="screening",
    ),
    *along(
        _EXPERIMENT,
        label("<response>_effect_refusal", "why the response has no effects"),
        stated("<response>_mean", "<unit>", "mean over the runs", "not evaluated by this version"),
        stated(
            "<response>_minimum_significant_effect", "<unit>", "least significant effect", BOUND
        ),
        stated(
            "<response>_simultaneous_minimum_effect",
            "<unit>",
            "least effect, all of them together",
            BOUND,
        ),
        group="screening",
    ),
)
