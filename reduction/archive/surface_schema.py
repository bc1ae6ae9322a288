"""Every variable that an archive of experiments may have.

What an experiment says of a response is named ``<response>_<what>``: the unit is that of the
response, which differs.  A file has those of its own experiments; where two of them differ in
length the shorter one ends in NaN, empty text or 0.  Dimensions:

=================================  ========================================================
dimension                          one entry for
=================================  ========================================================
``experiment``                     each experiment; text coordinate
``term``, ``term_other``           each coefficient, B1, B2, .. as printed; text coordinates
``factor``                         each factor, from 1; ``factor_name``, ``factor_unit``
``run``                            each run and specimen, from 1; ``run_name``
``plan_column``                    each factor, then each dummy column of a screening
``interaction``                    each two factors of a screening, from 1
``point``                          centre, points of the plan, corners; ``point_name``
``ridge_direction``                the way up and the way down; text coordinate
``ridge_radius``                   each coded distance from the centre
``direction``                      each principal direction, curvature falling
``anova_row``                      each source of variation; ``anova_source``
``block``                          each block; ``block_name``
``stiffness_form``                 each form of dynamic stiffness; text coordinate
``stiffness_term``                 each coefficient of a form, and ``stiffness_term_other``
``note``, ``caution``              each note and caution of any experiment
=================================  ========================================================

Levels of factors stand as numbers beside ``factor_unit``.  The covariance of two coefficients
is ``<response>_covariance_factor`` times the square of ``<response>_sigma``.  A surface is
evaluated from the file by `reduction.archive.surface_read.surfaces_of`.  At points and along
ridges the numbers of a transformed response are brought back to its own unit.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain

from reduction.archive.reasons import (
    BOUND,
    CHECK,
    CRITERION,
    NO_YES,
    OF_UNCERTAINTY,
    PART,
    SETTING,
    SPREAD,
    STATED,
    STATISTIC,
)
from reduction.archive.shared import COMPONENT, FREEDOM
from reduction.archive.variable import Variable, companion, count, flag, label, measured, stated
from reduction.surface.product import STATIONARY_KINDS
from reduction.vocabulary import RESPONSES, SURFACE_NAMES

__all__ = ["STATIONARY_FLAGS", "SURFACE_SCHEMA", "rows_of_response"]

STATIONARY_FLAGS = {name or "none": code for code, name in STATIONARY_KINDS.items()}

_E = ("experiment",)
_T = ("experiment", "term")
_F = ("experiment", "factor")
_R = ("experiment", "run")
_A = ("experiment", "anova_row")
_P = ("experiment", "plan_column")
_S = ("experiment", "stiffness_form")
_C = ("experiment", "stiffness_form", "stiffness_term")
_X = ("experiment", "point")
_D = ("experiment", "ridge_direction", "ridge_radius")
_U = ("experiment", COMPONENT)

_COUNT = "count"
_LEVELS = "a property of the levels"
_PLAN = "as planned"
_BASIS = "a direction: see the covariance of the coefficients"
_OF_RUN = "its uncertainty stands in the archive of the run"
_NOT_EVALUATED = "not evaluated by this version"
_FROM_SURFACE = "from the surface: see its covariance"


def rows_of_response(name: str, *, is_transformed: bool) -> Iterator[Variable]:
    """Give the variables of one response; what is measured is not transformed.

    Parameters
    ----------
    name : str
        One of `reduction.vocabulary.SURFACE_NAMES`, or ``response``.
    is_transformed : bool
        True for a surface of a transform: runs and effects are of the response itself.

    Yields
    ------
    row : Variable
    """
    yield from chain(
        *(
            chain(
                measured(of, _T),
                [
                    companion(of, "_random_standard_uncertainty", _T),
                    companion(of, "_uncertainty_contribution", (*_U, "term")),
                ],
            )
            for of in (f"{name}_coefficient", f"{name}_coefficient_engineering")
        ),
        stated(f"{name}_t", _T, STATISTIC),
        stated(f"{name}_p_value", _T, STATISTIC),
        stated(f"{name}_term_degrees_of_freedom", _T, _COUNT),
        stated(f"{name}_covariance_factor", (*_T, "term_other"), PART),
        label(f"{name}_transform", _E),
        stated(f"{name}_transform_exponent", _E, "see the ends of its interval"),
        stated(f"{name}_transform_exponent_low", _E, BOUND),
        stated(f"{name}_transform_exponent_high", _E, BOUND),
        stated(f"{name}_n_runs", _E, _COUNT),
        label(f"{name}_refusal", _E),
        stated(f"{name}_sigma", _E, SPREAD),
        stated(f"{name}_degrees_of_freedom", _E, _COUNT),
        *(
            stated(f"{name}_{what}", _E, CRITERION)
            for what in ("r2", "adjusted_r2", "predicted_r2", "probability_plot_correlation")
        ),
        *(
            stated(f"{name}_{what}", _E, STATISTIC)
            for what in (
                "overall_f",
                "overall_p_value",
                "printed_f",
                "lack_of_fit_f",
                "lack_of_fit_p_value",
            )
        ),
        label(f"{name}_lack_of_fit_refusal", _E),
        *(
            stated(f"{name}_anova_{what}", _A, why)
            for what, why in (
                ("degrees_of_freedom", _COUNT),
                ("sum_of_squares", SPREAD),
                ("mean_square", SPREAD),
                ("f", STATISTIC),
                ("p_value", STATISTIC),
            )
        ),
        measured(f"{name}_stationary_point", _F),
        stated(f"{name}_stationary_point_engineering", _F, "see the coded one"),
        flag(f"{name}_stationary_point_is_inside", _E, NO_YES),
        stated(f"{name}_stationary_value", _E, _FROM_SURFACE),
        flag(f"{name}_stationary_kind", _E, STATIONARY_FLAGS),
        label(f"{name}_stationary_refusal", _E),
        measured(f"{name}_eigenvalue", ("experiment", "direction")),
        stated(f"{name}_eigenvector", ("experiment", "direction", "factor"), _BASIS),
        stated(f"{name}_fitted", _R, _FROM_SURFACE),
        stated(f"{name}_residual", _R, CHECK),
        *(
            stated(f"{name}_{what}", _R, "says how much a run counts")
            for what in ("leverage", "cooks_distance")
        ),
        *(
            stated(f"{name}_{what}", _R, CHECK)
            for what in ("studentized_residual", "deleted_residual")
        ),
        measured(f"{name}_reduced_coefficient", _T),
        stated(f"{name}_reduced_coefficient_engineering", _T, "see the coded one"),
        flag(f"{name}_reduced_is_kept", _T, NO_YES),
        stated(f"{name}_reduced_sigma", _E, SPREAD),
        stated(f"{name}_reduced_aicc", _E, CRITERION),
        stated(f"{name}_full_aicc", _E, CRITERION),
        stated(f"{name}_block_effect", ("experiment", "block"), _NOT_EVALUATED),
        stated(f"{name}_block_standard_deviation", _E, SPREAD),
        flag(f"{name}_block_at_boundary", _E, NO_YES),
        stated(f"{name}_point_value", _X, "see its intervals")
        if is_transformed
        else measured(f"{name}_point_value", _X),
        *(
            stated(f"{name}_point_{kind}_{end}", _X, BOUND)
            for kind in ("confidence", "prediction", "simultaneous")
            for end in ("low", "high")
        ),
        stated(f"{name}_point_mean_value", _X, "see the intervals of the value"),
        stated(f"{name}_point_variance_factor", _X, _LEVELS),
        flag(f"{name}_point_is_above_leverage", _X, NO_YES),
        stated(f"{name}_ridge_coded_level", (*_D, "factor"), _NOT_EVALUATED),
        stated(f"{name}_ridge_level", (*_D, "factor"), _NOT_EVALUATED),
        # the runs chose the point, so that only what holds everywhere at once holds there
        stated(f"{name}_ridge_value", _D, "see its simultaneous interval"),
        stated(f"{name}_ridge_simultaneous_low", _D, BOUND),
        stated(f"{name}_ridge_simultaneous_high", _D, BOUND),
    )
    if is_transformed:
        return
    yield from chain(
        measured(f"{name}_measured", _R),
        measured(f"{name}_effect", _P, uncertainty_dims=_E),
        stated(f"{name}_effect_t", _P, STATISTIC),
        stated(f"{name}_effect_p_value", _P, STATISTIC),
        flag(f"{name}_effect_is_significant", _P, NO_YES),
        label(f"{name}_effect_refusal", _E),
        stated(f"{name}_effect_size", _P, "that of the effect"),
        stated(f"{name}_effect_half_normal_quantile", _P, "a property of the order"),
        stated(f"{name}_mean", _E, _NOT_EVALUATED),
        stated(f"{name}_minimum_significant_effect", _E, BOUND),
        stated(f"{name}_simultaneous_minimum_effect", _E, BOUND),
    )


_ROWS = chain(
    # experiments and their axes
    label("experiment", _E),
    label("experiment_kind", _E),
    count("factor", ("factor",)),
    count(COMPONENT, (COMPONENT,)),
    label("uncertainty_source", _U),
    label("uncertainty_source_of", _U),
    count("uncertainty_source_number", _U),
    stated(FREEDOM, _U, OF_UNCERTAINTY),
    label("factor_name", _F),
    label("factor_unit", _F),
    stated("factor_low", _F, _PLAN),
    stated("factor_high", _F, _PLAN),
    label("term", ("term",)),
    label("term_other", ("term_other",)),
    label("term_name", _T),
    label("term_unit_engineering", _T),
    label("term_error", _T),
    stated("term_exponent", (*_T, "factor"), "exact"),
    count("direction", ("direction",)),
    label("anova_source", _A),
    label("anova_error_term", _A),
    label("block_name", ("experiment", "block")),
    label("block_treatment", _E),
    stated("replicate_tolerance", _E, SETTING),
    stated("condition_number", _E, _LEVELS),
    count("plan_column", ("plan_column",)),
    label("plan_column_name", _P),
    label("effect_error_from", _E),
    stated("effect_degrees_of_freedom", _E, _COUNT),
    stated("effect_significance", _E, SETTING),
    count("interaction", ("interaction",)),
    label("interaction_factor", ("experiment", "interaction")),
    label("interaction_other_factor", ("experiment", "interaction")),
    stated("effect_alias", ("experiment", "interaction", "plan_column"), _LEVELS),
    # where surfaces are evaluated
    count("point", ("point",)),
    label("point_name", _X),
    label("point_kind", _X),
    stated("point_coded_level", (*_X, "factor"), _PLAN),
    stated("point_level", (*_X, "factor"), _PLAN),
    label("ridge_direction", ("ridge_direction",)),
    stated("ridge_radius", ("ridge_radius",), "exact"),
    stated("interval_confidence", _E, SETTING),
    # runs
    count("run", ("run",)),
    label("run_name", _R),
    label("run_specimen", _R),
    label("run_block", _R),
    label("run_remark", _R),
    stated("run_plan", (*_R, "plan_column"), _PLAN),
    stated("run_level", (*_R, "factor"), _OF_RUN),
    stated("run_coded_level", (*_R, "factor"), _OF_RUN),
    *(
        stated(f"run_{name}", _R, _OF_RUN)
        for name in (
            "frequency",
            "mean_tension",
            "tension_amplitude",
            "peak_tension",
            "minimum_tension",
        )
    ),
    stated("run_rated_break_strength", _R, STATED),
    count("run_cell", _R),
    stated("derived_dissipation_spring_constant", _R, _NOT_EVALUATED),
    stated("derived_relaxation_time", _R, _NOT_EVALUATED),
    # forms of mooring codes
    label("stiffness_form", ("stiffness_form",)),
    count("stiffness_term", ("stiffness_term",)),
    count("stiffness_term_other", ("stiffness_term_other",)),
    label("stiffness_equation", _S),
    label("stiffness_coefficient_name", _C),
    label("stiffness_coefficient_unit", _C),
    measured("stiffness_coefficient", _C),
    stated("stiffness_coefficient_low", _C, BOUND),
    stated("stiffness_coefficient_high", _C, BOUND),
    stated("stiffness_p_value", _C, STATISTIC),
    stated("stiffness_covariance", (*_C, "stiffness_term_other"), PART),
    stated("stiffness_confidence", _S, SETTING),
    stated("stiffness_mean_load_low", _S, BOUND),
    stated("stiffness_mean_load_high", _S, BOUND),
    stated("stiffness_n_coefficients", _S, _COUNT),
    stated("stiffness_sigma", _S, SPREAD),
    stated("stiffness_degrees_of_freedom", _S, _COUNT),
    *(
        stated(f"stiffness_{name}", _S, CRITERION)
        for name in (
            "r2",
            "adjusted_r2",
            "predicted_r2",
            "prediction_sum_of_squares",
            "aicc",
        )
    ),
    label("stiffness_refusal", _S),
    stated("stiffness_fitted", (*_S, "run"), _FROM_SURFACE),
    stated("stiffness_residual", (*_S, "run"), CHECK),
    # whether one relaxation time holds over frequency
    measured("single_time_exponent", _E),
    stated("single_time_exponent_low", _E, BOUND),
    stated("single_time_exponent_high", _E, BOUND),
    stated("single_time_p_value_one_time", _E, STATISTIC),
    stated("single_time_p_value_inverse_frequency", _E, STATISTIC),
    stated("single_time_ratio", _E, "see the ends of its interval"),
    stated("single_time_ratio_low", _E, BOUND),
    stated("single_time_ratio_high", _E, BOUND),
    stated("single_time_frequency_ratio", _E, _OF_RUN),
    stated("single_time_degrees_of_freedom", _E, _COUNT),
    stated("single_time_loss_exponent", _E, "see the ends of its interval"),
    stated("single_time_loss_exponent_low", _E, BOUND),
    stated("single_time_loss_exponent_high", _E, BOUND),
    label("single_time_verdict", _E),
    stated("single_time_confidence", _E, SETTING),
    stated("single_time_tolerance", _E, SETTING),
    # responses
    chain.from_iterable(
        rows_of_response(name, is_transformed=name not in RESPONSES) for name in SURFACE_NAMES
    ),
    # what a reader of the numbers has to know
    label("note", ("note",)),
    label("note_stage", ("note",)),
    label("note_experiment", ("note",)),
    label("caution", ("caution",)),
    label("caution_kind", ("caution",)),
    label("caution_hint", ("caution",)),
    label("caution_runs", ("caution",)),
    label("caution_experiment", ("caution",)),
)
SURFACE_SCHEMA: dict[str, Variable] = {row.name: row for row in _ROWS}
