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

from itertools import chain

from reduction.archive.reasons import (
    BOUND,
    CHECK,
    CRITERION,
    OF_UNCERTAINTY,
    PART,
    SETTING,
    SPREAD,
    STATISTIC,
    STRENGTH,
)
from reduction.archive.shared import COMPONENT, FREEDOM
from reduction.archive.surface_rows import (
    COUNT,
    FROM_SURFACE,
    LEVELS,
    NOT_EVALUATED,
    rows_of_response,
)
from reduction.archive.variable import Variable, count, label, measured, stated
from reduction.vocabulary import RESPONSES, SURFACE_NAMES

_E = ("experiment",)
_T = ("experiment", "term")
_F = ("experiment", "factor")
_R = ("experiment", "run")
_A = ("experiment", "anova_row")
_P = ("experiment", "plan_column")
_S = ("experiment", "stiffness_form")
_C = ("experiment", "stiffness_form", "stiffness_term")
_X = ("experiment", "point")
_U = ("experiment", COMPONENT)

_PLAN = "as planned"
_OF_RUN = "its uncertainty stands in the archive of the run"

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
    stated("condition_number", _E, LEVELS),
    count("plan_column", ("plan_column",)),
    label("plan_column_name", _P),
    label("effect_error_from", _E),
    stated("effect_degrees_of_freedom", _E, COUNT),
    stated("effect_significance", _E, SETTING),
    count("interaction", ("interaction",)),
    label("interaction_factor", ("experiment", "interaction")),
    label("interaction_other_factor", ("experiment", "interaction")),
    stated("effect_alias", ("experiment", "interaction", "plan_column"), LEVELS),
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
    stated("run_rated_break_strength", _R, STRENGTH),
    count("run_cell", _R),
    stated("derived_dissipation_spring_constant", _R, NOT_EVALUATED),
    stated("derived_relaxation_time", _R, NOT_EVALUATED),
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
    stated("stiffness_n_coefficients", _S, COUNT),
    stated("stiffness_sigma", _S, SPREAD),
    stated("stiffness_degrees_of_freedom", _S, COUNT),
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
    stated("stiffness_fitted", (*_S, "run"), FROM_SURFACE),
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
    stated("single_time_degrees_of_freedom", _E, COUNT),
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
