"""Quantities of experiments: designs, runs, response surfaces, screening, forms of stiffness."""

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


_RUN = ("experiment", "run")

_SHARED_ERROR = ("experiment", COMPONENT)

_SURFACE_POINT = ("experiment", "point")

_TERM = ("experiment", "term")

_AXES = {row.name: row for row in AXES}


OF_EXPERIMENTS: tuple[Quantity, ...] = (
    *along(
        _EXPERIMENT,
        label("experiment", "experiment"),
        label("experiment_kind", "experimental design", tables=("experiments",)),
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
            "level at coded -1, in the unit of the factor",
            "planned value",
            tables=("factors",),
        ),
        stated(
            "factor_high",
            "1",
            "level at coded +1, in the unit of the factor",
            "planned value",
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
        label(
            "term_unit_engineering",
            "unit factor of the engineering coefficient, multiplied by the unit of the response",
        ),
    ),
    *along(
        ("term_other",),
        label("term_other", "coefficient as printed (second axis)"),
        group="coefficients",
    ),
    *along(
        _TERM,
        label("term_error", "error term against which the coefficient is tested"),
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
            "largest difference in coded levels between repeats",
            SETTING,
            tables=("experiments",),
        ),
        stated(
            "condition_number",
            "1",
            "condition number of the model matrix",
            "follows from the levels alone",
            tables=("experiments",),
        ),
        group="quality",
    ),
    *along(
        _ANOVA,
        label("anova_source", "source of variation"),
        label("anova_error_term", "error term against which the source is tested"),
        group="anova",
    ),
    *along(
        ("direction",),
        count("direction", "number of the principal direction, in order of falling curvature"),
        group="stationary_point",
    ),
    *along(
        ("run",),
        count("run", "number of the run, in campaign order"),
        group="runs",
    ),
    *along(
        _RUN,
        label("run_name", "test or step of the run", tables=("runs",)),
        label("run_specimen", "specimen of the run", tables=("runs",)),
        label("run_block", "block of the run", tables=("runs",)),
        stated(
            "run_frequency",
            "Hz",
            "cycle frequency, mean over the run",
            "see the archive of the run",
            tables=("runs",),
        ),
        stated(
            "run_mean_tension",
            "N",
            "mean tension, mean over the run",
            "see the archive of the run",
            tables=("runs",),
        ),
        stated(
            "run_tension_amplitude",
            "N",
            "tension amplitude, mean over the run",
            "see the archive of the run",
            tables=("runs",),
        ),
        stated(
            "run_peak_tension",
            "N",
            "peak tension of the run",
            "see the archive of the run",
            tables=("runs",),
        ),
        stated(
            "run_minimum_tension",
            "N",
            "minimum tension of the run",
            "see the archive of the run",
            tables=("runs",),
        ),
        stated(
            "run_rated_break_strength",
            "N",
            "rated break strength of the specimen of the run",
            STRENGTH,
            tables=("runs",),
        ),
        stated(
            "derived_dissipation_spring_constant",
            "N",
            "dissipation spring constant from the surfaces of storage and loss spring constant",
            "not evaluated by this version",
            tables=("runs",),
        ),
        stated(
            "derived_relaxation_time",
            "s",
            "relaxation time from the surfaces of storage and loss spring constant",
            "not evaluated by this version",
            tables=("runs",),
        ),
        count(
            "run_cell",
            "number of the group of repeats; 0 for a run without levels",
            tables=("runs",),
        ),
        label("run_remark", "why a run has no value", tables=("runs",)),
        group="runs",
    ),
    *along(
        ("experiment", "run", "plan_column"),
        stated("run_plan", "1", "planned coded level of the column in the run", "planned value"),
        group="runs",
    ),
    *along(
        ("experiment", "run", "factor"),
        stated(
            "run_coded_level",
            "1",
            "coded level reached in the run",
            "see the archive of the run",
            tables=("run_levels",),
        ),
        stated(
            "run_level",
            "1",
            "level reached in the run, in the unit of the factor",
            "see the archive of the run",
            tables=("run_levels",),
        ),
        group="runs",
    ),
    *along(
        ("point",),
        count("point", "number of the point: centre, design points, corners"),
        group="points",
    ),
    *along(
        _SURFACE_POINT,
        label("point_name", "coded levels of the point"),
        label("point_kind", "location of the point in the cube of levels"),
        group="points",
    ),
    *along(
        ("experiment", "point", "factor"),
        stated(
            "point_coded_level",
            "1",
            "coded level of the factor at the point",
            "planned value",
            tables=("point_levels",),
        ),
        stated(
            "point_level",
            "1",
            "level at the point, in the unit of the factor",
            "planned value",
            tables=("point_levels",),
        ),
        group="points",
    ),
    *along(
        _EXPERIMENT,
        stated(
            "interval_confidence",
            "1",
            "confidence level of the intervals at points",
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
        count("plan_column", "number of the column in the plan"),
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
            "error estimate of the effects: dummy columns or Lenth",
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
            "two-sided significance level of the minimum significant effect",
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
            "fraction of the interaction aliased with the effect of the column",
            "follows from the levels alone",
            tables=("aliases",),
        ),
        group="screening",
    ),
    *along(
        ("stiffness_form",),
        label("stiffness_form", "form of the dynamic stiffness equation"),
        group="stiffness",
    ),
    *along(
        ("stiffness_term",),
        count("stiffness_term", "number of the coefficient of the form"),
        group="stiffness",
    ),
    *along(
        ("stiffness_term_other",),
        count("stiffness_term_other", "number of the coefficient of the form (second axis)"),
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
            "lowest mean tension divided by the break strength",
            BOUND,
            tables=("stiffness_forms",),
        ),
        stated(
            "stiffness_mean_load_high",
            "1",
            "highest mean tension divided by the break strength",
            BOUND,
            tables=("stiffness_forms",),
        ),
        stated(
            "stiffness_confidence",
            "1",
            "confidence level of the intervals of the coefficients",
            SETTING,
            tables=("stiffness_forms",),
        ),
        stated(
            "stiffness_sigma",
            "1",
            "standard deviation about the form, divided by the break strength",
            SPREAD,
            tables=("stiffness_forms",),
        ),
        stated(
            "stiffness_degrees_of_freedom",
            "1",
            "residual degrees of freedom of the form",
            COUNT,
            tables=("stiffness_forms",),
        ),
        stated(
            "stiffness_r2",
            "1",
            "R-squared of the form",
            CRITERION,
            tables=("stiffness_forms",),
        ),
        stated(
            "stiffness_adjusted_r2",
            "1",
            "adjusted R-squared of the form",
            CRITERION,
            tables=("stiffness_forms",),
        ),
        stated(
            "stiffness_predicted_r2",
            "1",
            "leave-one-out predicted R-squared of the form",
            CRITERION,
            tables=("stiffness_forms",),
        ),
        stated(
            "stiffness_prediction_sum_of_squares",
            "1",
            "PRESS of the form, divided by the squared break strength",
            CRITERION,
            tables=("stiffness_forms",),
        ),
        stated(
            "stiffness_aicc",
            "1",
            "corrected Akaike criterion of the form (lower is better)",
            CRITERION,
            tables=("stiffness_forms",),
        ),
        label("stiffness_refusal", "why the form is not given", tables=("stiffness_forms",)),
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
            "coefficient of the form, in its unit",
            uncertainty_is=(
                "standard uncertainty (k=1) of the coefficient, from run scatter "
                "alone, without shared errors"
            ),
            tables=("stiffness_coefficients",),
        ),
        stated(
            "stiffness_coefficient_low",
            "1",
            "lower limit of the coefficient, from the scatter of the runs alone",
            BOUND,
            tables=("stiffness_coefficients",),
        ),
        stated(
            "stiffness_coefficient_high",
            "1",
            "upper limit of the coefficient, from the scatter of the runs alone",
            BOUND,
            tables=("stiffness_coefficients",),
        ),
        stated(
            "stiffness_p_value",
            "1",
            "p-value of the coefficient",
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
            "apparent spring constant fitted by the form",
            "from the surface: see its covariance",
            tables=("stiffness_runs",),
        ),
        stated(
            "stiffness_residual",
            "N",
            "measured minus fitted apparent spring constant",
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
                "standard uncertainty (k=1) of n, from run scatter alone, without shared errors"
            ),
            tables=("single_time",),
        ),
        stated(
            "single_time_exponent_low",
            "1",
            "lower limit of n, from the scatter of the runs alone",
            BOUND,
            tables=("single_time",),
        ),
        stated(
            "single_time_exponent_high",
            "1",
            "upper limit of n, from the scatter of the runs alone",
            BOUND,
            tables=("single_time",),
        ),
        stated(
            "single_time_p_value_one_time",
            "1",
            "p-value of the hypothesis n = 0",
            STATISTIC,
            tables=("single_time",),
        ),
        stated(
            "single_time_p_value_inverse_frequency",
            "1",
            "p-value of the hypothesis n = 1",
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
            "ratio of highest to lowest frequency",
            "see the archive of the run",
            tables=("single_time",),
        ),
        stated(
            "single_time_ratio",
            "1",
            "ratio of relaxation times, lowest to highest frequency",
            "see its interval",
            tables=("single_time",),
        ),
        stated(
            "single_time_ratio_low",
            "1",
            "lower limit of the ratio of relaxation times",
            BOUND,
            tables=("single_time",),
        ),
        stated(
            "single_time_ratio_high",
            "1",
            "upper limit of the ratio of relaxation times",
            BOUND,
            tables=("single_time",),
        ),
        stated(
            "single_time_loss_exponent",
            "1",
            "m of loss factor ~ frequency**m",
            "see its interval",
            tables=("single_time",),
        ),
        stated(
            "single_time_loss_exponent_low",
            "1",
            "lower limit of m",
            BOUND,
            tables=("single_time",),
        ),
        stated(
            "single_time_loss_exponent_high",
            "1",
            "upper limit of m",
            BOUND,
            tables=("single_time",),
        ),
        stated(
            "single_time_confidence",
            "1",
            "confidence level of the intervals of the exponents",
            SETTING,
            tables=("single_time",),
        ),
        stated(
            "single_time_tolerance",
            "1",
            "allowed deviation of an exponent from 0 or 1",
            SETTING,
            tables=("single_time",),
        ),
        label(
            "single_time_verdict",
            "whether a single relaxation time fits all frequencies",
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
        label("note_experiment", "experiment to which the note applies"),
        group="notes",
    ),
    *along(
        _CAUTION,
        label("caution", "caution about the runs as reached"),
        label("caution_kind", "kind of caution", tables=("cautions",)),
        label("caution_hint", "suggested remedy", tables=("cautions",)),
        label(
            "caution_runs",
            "runs to which the caution applies; empty for the whole experiment",
            tables=("cautions",),
        ),
        label("caution_experiment", "experiment to which the caution applies"),
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
            "p-value of the coefficient",
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
            "coefficient, factors in SI units",
            shares_errors=True,
            tables=("surfaces",),
        ),
        group="coefficients",
    ),
    *along(
        ("experiment", "term", "term_other"),
        stated(
            "<response>_covariance_factor",
            "1",
            "covariance of two coded coefficients divided by sigma**2",
            PART,
        ),
        group="coefficients",
    ),
    *along(
        _EXPERIMENT,
        label(
            "<response>_transform",
            "scale on which the surface was fitted",
            tables=("surface_quality",),
        ),
        stated(
            "<response>_transform_exponent",
            "1",
            "Box-Cox exponent: 1 no transform, 0 logarithm",
            "see its interval",
            tables=("surface_quality",),
        ),
        stated(
            "<response>_transform_exponent_low",
            "1",
            "lower limit of the Box-Cox exponent",
            BOUND,
            tables=("surface_quality",),
        ),
        stated(
            "<response>_transform_exponent_high",
            "1",
            "upper limit of the Box-Cox exponent",
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
            "results of the surface that are not given, and why",
            tables=("surface_quality",),
        ),
        stated(
            "<response>_sigma",
            "<unit>",
            "residual standard deviation of a run about the surface",
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
            "R-squared; with blocks, within blocks",
            CRITERION,
            tables=("surface_quality",),
        ),
        stated(
            "<response>_adjusted_r2",
            "1",
            "adjusted R-squared; with blocks, within blocks",
            CRITERION,
            tables=("surface_quality",),
        ),
        stated(
            "<response>_predicted_r2",
            "1",
            "leave-one-out predicted R-squared; with blocks, within blocks",
            CRITERION,
            tables=("surface_quality",),
        ),
        stated(
            "<response>_overall_f",
            "1",
            "F of all terms except the mean",
            STATISTIC,
            tables=("surface_quality",),
        ),
        stated(
            "<response>_overall_p_value",
            "1",
            "p-value of the overall F",
            STATISTIC,
            tables=("surface_quality",),
        ),
        stated(
            "<response>_printed_f",
            "1",
            "F as printed in CG-D-39-80, which counts the mean twice; for comparison",
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
            "p-value of the lack-of-fit F",
            STATISTIC,
            tables=("surface_quality",),
        ),
        label(
            "<response>_lack_of_fit_refusal",
            "why there is no lack-of-fit test",
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
            "p-value of the F of the source",
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
            "coded level of the factor at the stationary point",
            shares_errors=True,
            tables=("stationary_points",),
        ),
        stated(
            "<response>_stationary_point_engineering",
            "1",
            "level at the stationary point, in the unit of the factor",
            "see the coded coefficient",
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
            "value of the surface at the stationary point",
            "from the surface: see its covariance",
            tables=("surface_quality",),
        ),
        flag(
            "<response>_stationary_point_is_inside",
            "whether the stationary point lies within the tested levels",
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
            "component of the factor in a principal direction",
            "see the covariance of the coefficients",
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
            "measured minus fitted value of the run",
            CHECK,
            tables=("run_responses",),
        ),
        stated(
            "<response>_leverage",
            "1",
            "leverage of the run",
            "a measure of influence",
            tables=("run_responses",),
        ),
        stated(
            "<response>_studentized_residual",
            "1",
            "internally studentized residual",
            CHECK,
            tables=("run_responses",),
        ),
        stated(
            "<response>_deleted_residual",
            "1",
            "externally studentized (deleted) residual",
            CHECK,
            tables=("run_responses",),
        ),
        stated(
            "<response>_cooks_distance",
            "1",
            "Cook's distance of the run",
            "a measure of influence",
            tables=("run_responses",),
        ),
        group="runs",
    ),
    *along(
        _SURFACE_POINT,
        measured(
            "<response>_point_value",
            "<response unit>",
            "value of the surface at the point; the median if transformed",
            shares_errors=True,
            tables=("surface_points",),
        ),
        stated(
            "<response>_point_discrepancy",
            "<response unit>",
            "standard uncertainty of the lack of fit of a quadratic at the point; "
            "included in that of the value",
            SPREAD,
            tables=("surface_points",),
        ),
        stated(
            "<response>_point_value_degrees_of_freedom",
            "1",
            "degrees of freedom of the random part of the uncertainty of the "
            "value: scatter and lack of fit",
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
            "lower limit of the interval of the surface at this single point",
            BOUND,
            tables=("surface_points",),
        ),
        stated(
            "<response>_point_confidence_high",
            "<response unit>",
            "upper limit of the interval of the surface at this single point",
            BOUND,
            tables=("surface_points",),
        ),
        stated(
            "<response>_point_prediction_low",
            "<response unit>",
            "lower limit of the prediction interval of one more run",
            BOUND,
            tables=("surface_points",),
        ),
        stated(
            "<response>_point_prediction_high",
            "<response unit>",
            "upper limit of the prediction interval of one more run",
            BOUND,
            tables=("surface_points",),
        ),
        stated(
            "<response>_point_simultaneous_low",
            "<response unit>",
            "lower limit of the simultaneous interval of the surface",
            BOUND,
            tables=("surface_points",),
        ),
        stated(
            "<response>_point_simultaneous_high",
            "<response unit>",
            "upper limit of the simultaneous interval of the surface",
            BOUND,
            tables=("surface_points",),
        ),
        stated(
            "<response>_point_variance_factor",
            "1",
            "variance of the surface divided by sigma**2",
            "follows from the levels alone",
            tables=("surface_points",),
        ),
        flag(
            "<response>_point_is_above_leverage",
            "whether the variance factor at the point exceeds that of every run",
            NO_YES,
            tables=("surface_points",),
        ),
        group="points",
    ),
    *along(
        ("experiment", "block"),
        stated(
            "<response>_block_effect",
            "<unit>",
            "block mean minus the mean over all blocks",
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
            "whether the estimated block variance is zero",
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
            "mean at the high level minus mean at the low level",
            uncertainty_dims=_EXPERIMENT,
            uncertainty_is=(
                "standard uncertainty (k=1) of an effect, from run scatter alone, without "
                "shared errors"
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
            "p-value of the effect",
            STATISTIC,
            tables=("screening",),
        ),
        flag(
            "<response>_effect_is_significant",
            "whether the effect exceeds the minimum significant effect",
            NO_YES,
            tables=("screening",),
        ),
        group="screening",
    ),
    *along(
        _EXPERIMENT,
        label("<response>_effect_refusal", "why the response has no effects"),
        stated("<response>_mean", "<unit>", "mean over the runs", "not evaluated by this version"),
        stated(
            "<response>_minimum_significant_effect", "<unit>", "minimum significant effect", BOUND
        ),
        stated(
            "<response>_simultaneous_minimum_effect",
            "<unit>",
            "minimum significant effect, all effects together",
            BOUND,
        ),
        group="screening",
    ),
)
