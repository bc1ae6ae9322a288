"""Every variable that an archive may have.

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
evaluated from the file by `reduction.archive.surfaces_dataset.surfaces_of`.  At points and along
ridges the numbers of a transformed response are brought back to its own unit.

References
----------
.. [1] CF Conventions 1.11, Eaton et al., 2023.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain

from reduction.archive.shared_errors import COMPONENT, FREEDOM, SHARED_ROWS
from reduction.archive.test_variables import (
    CURVE_ROWS,
    ELASTOMER_ROWS,
    HOLD_ROWS,
    LAG_ROWS,
    LINE_ROWS,
    ROPE_ROWS,
    STEP_ROWS,
    STEPWISE,
)
from reduction.archive.variables import (
    AXIS,
    BOUND,
    CHECK,
    CLOCK,
    CRITERION,
    MOVEMENT,
    NO_YES,
    NOTE_ROWS,
    OF_MARKS,
    OF_UNCERTAINTY,
    PART,
    READING,
    SEE_PER_DECADE,
    SETTING,
    SPREAD,
    STATED,
    STATISTIC,
    STRENGTH,
    TWO_METHODS,
    WHERE_IT_STOOD,
    Variable,
    companion,
    count,
    flag,
    in_group,
    label,
    mask,
    measured,
    schema_from,
    stated,
)
from reduction.experiments.fit_results import STATIONARY_KINDS
from reduction.quantities.names import BRANCH_VALUES, PHASE_VALUES, RESPONSES, SURFACE_NAMES
from reduction.record.measurement import Quality

QUALITY_MASKS = {(mask_.name or "").lower(): int(mask_) for mask_ in Quality}

COEFFICIENTS = {
    "relaxed_free_length": "relaxed_free_length",
    "relaxed_splice_length": "relaxed_splice_length",
    "splice_compliance": "splice_compliance",
    "splice_exponent": "splice_exponent",
    "splice_strain_ratio": "splice_strain_ratio",
    "free_length_intercept": "free_length_intercept",
    "free_length_slope": "free_length_slope",
    "free_fraction": "free_fraction",
    "reference_position": "reference_position",
    "gauge_length": "strain_gauge_length",
}
"""Coefficient of a strain method to its name here, along ``specimen``.

They differ where the name has another meaning in a product.
"""

_S = ("specimen",)

_C = ("specimen", "cycle")

_CB = ("cycle", "branch_name")

_CE = ("specimen", "cycle", "branch_name")

_TEST_ROWS = chain(
    # coordinates
    label("specimen", _S),
    label("branch_name", ("branch_name",)),
    stated("time", ("sample",), CLOCK),
    count("cycle", ("cycle",)),
    count("selected_cycle", ("selected_cycle",)),
    count("segment", ("segment",)),
    count("hold", ("hold",)),
    count("prony_term", ("prony_term",)),
    stated("hold_time", ("hold_time",), SETTING),
    stated("strain_level", ("strain_level",), SETTING),
    stated("strain_bin", ("strain_bin",), AXIS, bounds="strain_bin_bounds"),
    stated("strain_bin_bounds", ("strain_bin", "bound"), BOUND),
    stated(
        "first_loading_strain_bin",
        ("first_loading_strain_bin",),
        AXIS,
        bounds="first_loading_strain_bin_bounds",
    ),
    stated("first_loading_strain_bin_bounds", ("first_loading_strain_bin", "bound"), BOUND),
    stated("ratio_strain_bin", ("ratio_strain_bin",), AXIS),
    in_group(
        "splice",
        label("coefficient_name", ("coefficient_name",)),
        label("coefficient_name_other", ("coefficient_name_other",)),
    ),
    in_group(
        "record",
        label("channel", ("channel",)),
        label("quality_mask", ("quality_mask",)),
    ),
    # specimens
    label("specimen_kind", _S),
    label("specimen_material", _S),
    label("specimen_construction", _S),
    label("specimen_condition", _S),
    measured("diameter", _S),
    measured("area", _S),
    stated("rated_break_strength", _S, STRENGTH),
    in_group(
        "specimens",
        label("rated_break_strength_source", _S),
        stated("diameter_reading", ("specimen", "reading"), STATED),
        stated("stretched_diameter", ("specimen", "stretched_reading"), STATED),
        stated("stretched_diameter_strain", ("specimen", "stretched_reading"), STATED),
        stated("linear_density", _S, STATED),
        stated("wet_linear_density", _S, STATED),
        stated("declared_gauge_length", _S, STATED),
        label("earlier_tests", _S),
        stated("earlier_maximum_strain", _S, "bound: greatest value seen"),
        stated("earlier_maximum_tension", _S, "bound: greatest value seen"),
        stated("earlier_cycles", _S, "count"),
        stated("earlier_flex_cycles", _S, "count"),
        measured("permanent_set", _S),
    ),
    # samples
    measured(
        "crosshead_position",
        ("sample",),
        uncertainty_dims=(),
        ancillary=("crosshead_position_quality_flag",),
    ),
    measured(
        "crosshead_displacement",
        ("sample",),
        uncertainty_dims=(),
        ancillary=("crosshead_position_quality_flag",),
    ),
    mask("crosshead_position_quality_flag", ("sample",), QUALITY_MASKS),
    measured("tension", ("specimen", "sample"), uncertainty_dims=_S, ancillary=("quality_flag",)),
    mask("quality_flag", ("specimen", "sample"), QUALITY_MASKS),
    measured("strain", ("specimen", "sample"), uncertainty_dims=_S, ancillary=("quality_flag",)),
    stated("measured_strain", ("specimen", "sample"), READING),
    measured(
        "nominal_stress", ("specimen", "sample"), uncertainty_dims=_S, ancillary=("quality_flag",)
    ),
    flag("phase", ("sample",), PHASE_VALUES),
    count("cycle_number", ("sample",)),
    flag("branch", ("sample",), BRANCH_VALUES),
    in_group(
        "record",
        count("machine_cycle_number", ("sample",)),
        count("sample_index", ("sample",)),
        # standstills
        stated("standstill_start_time", ("standstill",), CLOCK),
        stated("standstill_end_time", ("standstill",), CLOCK),
        stated("standstill_position", ("standstill",), WHERE_IT_STOOD),
        stated("standstill_tension", ("specimen", "standstill"), WHERE_IT_STOOD),
        flag("standstill_is_rest", ("standstill",), NO_YES),
        stated("standstill_position_tolerance", (), SETTING),
        stated("hold_tension_tolerance", (), SETTING),
        stated("slack_tension", (), SETTING),
    ),
    in_group(
        "splice",
        # strain methods
        label("strain_method", _S),
        label("strain_marks_from", _S),
        chain.from_iterable(measured(name, _S) for name in COEFFICIENTS.values()),
        stated(
            "strain_coefficient_correlation",
            ("specimen", "coefficient_name", "coefficient_name_other"),
            PART,
        ),
        stated("strain_position_low", _S, BOUND),
        stated("strain_position_high", _S, BOUND),
        stated("strain_tension_low", _S, BOUND),
        stated("strain_tension_high", _S, BOUND),
        stated("strain_slope_ratio", _S, TWO_METHODS),
        label("mark_specimen", ("mark",)),
        label("mark_test", ("mark",)),
        label("mark_hold", ("mark",)),
        stated("mark_position", ("mark",), OF_MARKS),
        stated("mark_strain", ("mark",), OF_MARKS),
        stated("mark_tension", ("mark",), OF_MARKS),
        stated("mark_strain_residual", ("mark",), CHECK),
    ),
    in_group(
        "cycles",
        # cycles
        label("cycles_counted_by"),
        stated("position_band", (), SETTING),
        stated("tension_band", (), SETTING),
        count("cycle_first_sample", ("cycle",)),
        count("cycle_last_sample", ("cycle",)),
        count("branch_first_sample", _CB),
        count("branch_last_sample", _CB),
        stated("crosshead_rate", _CB, MOVEMENT),
        stated("tension_rate", _CB, MOVEMENT),
        stated("cycle_start_time", _C, CLOCK),
        chain.from_iterable(
            measured(name, _C)
            for name in (
                "frequency",
                "mean_tension",
                "tension_amplitude",
                "mean_strain",
                "strain_amplitude",
                "peak_tension",
                "valley_tension",
                "apparent_spring_constant",
                "hysteresis_energy",
                "storage_spring_constant",
                "loss_spring_constant",
                "loss_factor",
                "fundamental_energy_share",
            )
        ),
        measured("secant_modulus", _C),
        measured("chord_modulus", _CE),
        stated("stroke_mean_modulus_difference", _C, "one side of a check"),
        stated("tension_loss_modulus", _C, "one side of a check"),
        stated("identity_residual", _C, CHECK),
        measured("mean_identity_residual", _S),
        chain.from_iterable(
            measured(name, _S)
            for name in (
                "test_frequency",
                "test_mean_strain",
                "test_strain_amplitude",
                "test_mean_tension",
                "test_tension_amplitude",
                "test_apparent_spring_constant",
                "test_dynamic_modulus",
                "test_hysteresis_energy",
                "test_storage_spring_constant",
                "test_loss_spring_constant",
                "test_loss_factor",
                "test_slope_reading_spread",
                "peak_tension_per_decade",
                "dynamic_modulus_per_decade",
                "peak_tension_change",
            )
        ),
    ),
    LINE_ROWS,
    ROPE_ROWS,
    CURVE_ROWS,
    in_group(
        "cycles",
        # slips
        count("n_slips", _S),
        label("slip_specimen", ("slip",)),
        count("slip_cycle", ("slip",)),
        count("slip_cycle_low", ("slip",)),
        count("slip_cycle_high", ("slip",)),
        measured("slip_tension_step", ("slip",)),
        measured("slip_length", ("slip",)),
        stated("creep_per_cycle", _S, SEE_PER_DECADE),
    ),
    ELASTOMER_ROWS,
    HOLD_ROWS,
    STEP_ROWS,
    LAG_ROWS,
    SHARED_ROWS,
    in_group(
        "record",
        # the record and what is known about it
        count("n_rows_read", ()),
        count("n_rows_kept", ()),
        count("n_rows_stored", ()),
        count("n_flagged", ("channel", "quality_mask")),
    ),
    NOTE_ROWS,
)

SCHEMA: dict[str, Variable] = schema_from(_TEST_ROWS)


def schema_of(*, is_stepwise: bool) -> dict[str, Variable]:
    """Return the variables of a record, or of a stepwise test."""
    if not is_stepwise:
        return SCHEMA
    return SCHEMA | STEPWISE


_COMPARISON = ("comparison",)

_COMPARED_POINT = ("comparison", "comparison_point")

_V = ("comparison", "curve")

_COMPARED_CURVE = ("comparison", "curve", "comparison_point")

_COMPARED_EVENT = ("comparison", "hose_event")

_K = ("comparison", "comparison_cycle")

_FITTED_NUMBER = ("comparison", "parameter")

_GIVEN_COMPARED = "given: the strain at which both are compared"

_DIFFERENCE = "see validation_uncertainty"

_IS = "is an uncertainty"

_ERROR_NOT_CARRIED = "not carried through"

COMPARISON_SCHEMA: dict[str, Variable] = schema_from(
    chain(
        label("comparison", _COMPARISON),
        label("curve", ("curve",)),
        label("hose_event", ("hose_event",)),
        count("comparison_point", ("comparison_point",)),
        count("comparison_cycle", ("comparison_cycle",)),
        count("parameter", ("parameter",)),
        count("parameter_other", ("parameter_other",)),
        *(
            label(name, _COMPARISON)
            for name in (
                "comparison_test",
                "comparison_specimen",
                "comparison_hose",
                "comparison_loading",
                "judged_curve",
            )
        ),
        stated("strain", _COMPARED_POINT, _GIVEN_COMPARED),
        in_group(
            "uncertainty",
            count(COMPONENT, (COMPONENT,)),
            label("uncertainty_source", (COMPONENT,)),
            label("uncertainty_source_of", (COMPONENT,)),
            count("uncertainty_source_number", (COMPONENT,)),
            stated(FREEDOM, (COMPONENT,), OF_UNCERTAINTY),
        ),
        measured("measured_tension", _COMPARED_CURVE),
        [
            companion("measured_tension", "_random_standard_uncertainty", _COMPARED_CURVE),
            companion(
                "measured_tension", "_uncertainty_contribution", (COMPONENT, *_COMPARED_CURVE)
            ),
        ],
        measured("predicted_tension", _COMPARED_POINT),
        in_group(
            "fit",
            stated("calibrated_tension", _COMPARED_POINT, "see the fitted numbers"),
        ),
        stated("tension_difference", _COMPARED_CURVE, _DIFFERENCE),
        stated("validation_uncertainty", _COMPARED_POINT, _IS),
        *(
            stated(name, _V, why)
            for name, why in (
                ("tension_bias", _DIFFERENCE),
                ("tension_rms", SPREAD),
                ("tension_relative_rms", SPREAD),
                ("worst_strain", _DIFFERENCE),
                ("worst_tension_difference", _DIFFERENCE),
            )
        ),
        in_group(
            "statistics",
            *(
                stated(name, _COMPARISON, STATISTIC)
                for name in (
                    "coverage_factor",
                    "largest_ratio",
                    "largest_ratio_strain",
                    "chi_square",
                    "chi_square_freedom",
                    "chi_square_probability",
                    "uncertainty_share",
                )
            ),
        ),
        flag("agrees", _COMPARISON, NO_YES),
        flag("is_informative", _COMPARISON, NO_YES),
        label("verdict", _COMPARISON),
        in_group(
            "events",
            stated("event_strain", _COMPARED_EVENT, "see event_strain_difference"),
            stated("event_tension", _COMPARED_EVENT, "see event_tension_difference"),
            stated("event_measured_tension", _COMPARED_EVENT, "see event_tension_difference"),
            measured("event_tension_difference", _COMPARED_EVENT),
            stated("event_measured_strain", _COMPARED_EVENT, "see event_strain_difference"),
            measured("event_strain_difference", _COMPARED_EVENT),
            measured("measured_pick_up_strain", _COMPARISON),
        ),
        in_group(
            "energy",
            *(
                stated(name, _COMPARISON, why)
                for name, why in (
                    ("energy_strain_low", BOUND),
                    ("energy_strain_high", BOUND),
                    ("measured_energy", _ERROR_NOT_CARRIED),
                    ("predicted_energy", _ERROR_NOT_CARRIED),
                    ("energy_difference", _ERROR_NOT_CARRIED),
                    ("loop_energy", _ERROR_NOT_CARRIED),
                    ("loop_energy_share", _ERROR_NOT_CARRIED),
                )
            ),
        ),
        in_group(
            "cycles",
            count("comparison_cycle_number", _K),
            stated("cycle_bias", _K, _DIFFERENCE),
            stated("cycle_rms", _K, SPREAD),
            measured("bias_per_decade", _COMPARISON),
        ),
        in_group(
            "fit",
            label("parameter_name", _FITTED_NUMBER),
            label("parameter_unit", _FITTED_NUMBER),
            stated("parameter_start", _FITTED_NUMBER, SETTING),
            measured("parameter_value", _FITTED_NUMBER),
            *(
                stated(f"parameter_{name}", _FITTED_NUMBER, BOUND)
                for name in ("low", "high", "lower_bound", "upper_bound")
            ),
            flag("parameter_is_at_bound", _FITTED_NUMBER, NO_YES),
            stated("parameter_correlation", (*_FITTED_NUMBER, "parameter_other"), PART),
            stated("calibrated_bias", _COMPARISON, _DIFFERENCE),
            stated("calibrated_rms", _COMPARISON, SPREAD),
            stated("calibrated_relative_rms", _COMPARISON, SPREAD),
            flag("is_identified", _COMPARISON, NO_YES | {"not_asked": 2}),
            label("identifiability", _COMPARISON),
            *(
                stated(name, _COMPARISON, CRITERION)
                for name in ("collinearity", "least_change", "needed_change", "effective_points")
            ),
            stated("model_error", _COMPARISON, SPREAD),
        ),
        in_group("notes", label("note_comparison", ("note",))),
        NOTE_ROWS,
    )
)
"""Every variable that an archive of comparisons may have."""

HOSE_STATES = {"slack": 1, "broken": 2, "jammed": 4, "bore_too_small": 8}
"""Masks: cords carry nothing, are broken, touch; the bore is below its limit."""

_H = ("hose",)

_HOSE_POINT = ("hose", "hose_point")

_HOSE_EVENT = ("hose", "hose_event")

_SOURCE = ("hose", "uncertainty_source", "hose_point")

_L = ("hose", "cord_layer")

_CORD = ("hose", "cord_point")

_LAYER = ("hose", "hose_layer")

_GIVEN_PREDICTED = "given: the strain at which the hose is predicted"

_GEOMETRY = "follows from strain and wrap angle alone"

_CURVE = "see cord_strain_scale and cord_load_scale"

_TENSION_CARRIES = "not carried through: see the tension"

PREDICTION_SCHEMA: dict[str, Variable] = schema_from(
    chain(
        label("hose", _H),
        label("hose_event", ("hose_event",)),
        label("uncertainty_source", ("uncertainty_source",)),
        label("cord_layer", ("cord_layer",)),
        count("hose_point", ("hose_point",)),
        count("cord_point", ("cord_point",)),
        count("hose_layer", ("hose_layer",)),
        in_group(
            "design",
            *(
                measured(name, _H)
                for name in (
                    "wrap_angle",
                    "inner_diameter",
                    "outer_diameter",
                    "cords_per_length",
                    "rubber_modulus",
                    "cord_load_scale",
                    "cord_strain_scale",
                    "dead_length_share",
                )
            ),
            measured("layer_diameter", _L),
            stated("cord_diameter", _H, "limits the spacing alone"),
            label("rubber_law", _H),
            stated("working_share", _H, SETTING),
            stated("minimum_inner_diameter", _H, SETTING),
            stated("ribbon_width", _L, _GEOMETRY),
            stated("number_of_cords", _H, _GEOMETRY),
        ),
        in_group(
            "cords",
            stated("cord_curve_strain", _CORD, _CURVE),
            stated("cord_curve_load", _CORD, _CURVE),
        ),
        stated("strain", _HOSE_POINT, _GIVEN_PREDICTED),
        stated("free_strain", _HOSE_POINT, _GEOMETRY),
        measured("tension", _HOSE_POINT),
        measured("fill_pressure", _HOSE_POINT),
        in_group(
            "cords",
            *(
                stated(name, _HOSE_POINT, _TENSION_CARRIES)
                for name in (
                    "cord_tension",
                    "cord_strain",
                    "cord_share",
                    "rubber_share",
                    "end_cap_load",
                )
            ),
            *(
                stated(name, _HOSE_POINT, _GEOMETRY)
                for name in ("current_wrap_angle", "cord_spacing", "current_inner_diameter")
            ),
        ),
        mask("hose_state", _HOSE_POINT, HOSE_STATES),
        in_group(
            "uncertainty",
            stated("tension_contribution", _SOURCE, PART),
            stated("fill_pressure_contribution", _SOURCE, PART),
        ),
        measured("event_strain", _HOSE_EVENT),
        measured("event_tension", _HOSE_EVENT),
        measured("event_fill_pressure", _HOSE_EVENT),
        stated("event_cord_tension", _HOSE_EVENT, _TENSION_CARRIES),
        stated("event_cord_strain", _HOSE_EVENT, _TENSION_CARRIES),
        in_group(
            "layers",
            label("hose_layer_name", _LAYER),
            *(
                stated(f"hose_layer_{name}", _LAYER, why)
                for name, why in (
                    ("wrap_angle", SETTING),
                    ("strain_limit", SETTING),
                    ("compression_limit", SETTING),
                    ("least_strain", _TENSION_CARRIES),
                    ("greatest_strain", _TENSION_CARRIES),
                    ("break_strain", _TENSION_CARRIES),
                    ("least_angle", _TENSION_CARRIES),
                    ("greatest_angle", _TENSION_CARRIES),
                )
            ),
        ),
        in_group("notes", label("note_hose", ("note",))),
        NOTE_ROWS,
    )
)
"""Every variable that an archive of predictions may have."""

_STATIONARY_FLAGS = {name or "none": code for code, name in STATIONARY_KINDS.items()}

COUNT = "count"

LEVELS = "a property of the levels"

NOT_EVALUATED = "not evaluated by this version"

FROM_SURFACE = "from the surface: see its covariance"
"""Why a variable has no uncertainty beside it, of a response and of its experiment."""

_BASIS = "a direction: see the covariance of the coefficients"

_OF_EXPERIMENT = ("experiment",)

_OF_TERM = ("experiment", "term")

_F = ("experiment", "factor")

_R = ("experiment", "run")

_A = ("experiment", "anova_row")

_OF_PLAN = ("experiment", "plan_column")

_X = ("experiment", "point")

_D = ("experiment", "ridge_direction", "ridge_radius")

_U = ("experiment", COMPONENT)


def rows_of_response(name: str, *, is_transformed: bool) -> Iterator[Variable]:
    """Give the variables of one response; what is measured is not transformed."""
    own = "coefficients" if is_transformed else ""
    yield from chain(
        in_group(
            own,
            _of_both_parts(f"{name}_coefficient", _OF_TERM),
        ),
        in_group("coefficients", _of_both_parts(f"{name}_coefficient_engineering", _OF_TERM)),
        in_group("coefficients", stated(f"{name}_t", _OF_TERM, STATISTIC)),
        in_group(
            own,
            stated(f"{name}_p_value", _OF_TERM, STATISTIC),
        ),
        in_group(
            "coefficients",
            stated(f"{name}_term_degrees_of_freedom", _OF_TERM, COUNT),
            stated(f"{name}_covariance_factor", (*_OF_TERM, "term_other"), PART),
        ),
        in_group(
            "quality",
            label(f"{name}_transform", _OF_EXPERIMENT),
            stated(f"{name}_transform_exponent", _OF_EXPERIMENT, "see the ends of its interval"),
            stated(f"{name}_transform_exponent_low", _OF_EXPERIMENT, BOUND),
            stated(f"{name}_transform_exponent_high", _OF_EXPERIMENT, BOUND),
            stated(f"{name}_n_runs", _OF_EXPERIMENT, COUNT),
            label(f"{name}_refusal", _OF_EXPERIMENT),
            stated(f"{name}_sigma", _OF_EXPERIMENT, SPREAD),
            stated(f"{name}_degrees_of_freedom", _OF_EXPERIMENT, COUNT),
            *(
                stated(f"{name}_{what}", _OF_EXPERIMENT, CRITERION)
                for what in ("r2", "adjusted_r2", "predicted_r2", "probability_plot_correlation")
            ),
            *(
                stated(f"{name}_{what}", _OF_EXPERIMENT, STATISTIC)
                for what in (
                    "overall_f",
                    "overall_p_value",
                    "printed_f",
                    "lack_of_fit_f",
                    "lack_of_fit_p_value",
                )
            ),
            label(f"{name}_lack_of_fit_refusal", _OF_EXPERIMENT),
        ),
        in_group(
            "anova",
            *(
                stated(f"{name}_anova_{what}", _A, why)
                for what, why in (
                    ("degrees_of_freedom", COUNT),
                    ("sum_of_squares", SPREAD),
                    ("mean_square", SPREAD),
                    ("f", STATISTIC),
                    ("p_value", STATISTIC),
                )
            ),
        ),
        in_group(
            "stationary_point",
            _of_both_parts(f"{name}_stationary_point", _F),
            stated(f"{name}_stationary_point_engineering", _F, "see the coded one"),
            flag(f"{name}_stationary_point_is_inside", _OF_EXPERIMENT, NO_YES),
            stated(f"{name}_stationary_value", _OF_EXPERIMENT, FROM_SURFACE),
            flag(f"{name}_stationary_kind", _OF_EXPERIMENT, _STATIONARY_FLAGS),
            label(f"{name}_stationary_refusal", _OF_EXPERIMENT),
            _of_both_parts(f"{name}_eigenvalue", ("experiment", "direction")),
            stated(f"{name}_eigenvector", ("experiment", "direction", "factor"), _BASIS),
        ),
        in_group(
            "runs",
            stated(f"{name}_fitted", _R, FROM_SURFACE),
            stated(f"{name}_residual", _R, CHECK),
            *(
                stated(f"{name}_{what}", _R, "says how much a run counts")
                for what in ("leverage", "cooks_distance")
            ),
            *(
                stated(f"{name}_{what}", _R, CHECK)
                for what in ("studentized_residual", "deleted_residual")
            ),
        ),
        in_group(
            "coefficients",
            measured(f"{name}_reduced_coefficient", _OF_TERM),
            stated(f"{name}_reduced_coefficient_engineering", _OF_TERM, "see the coded one"),
            flag(f"{name}_reduced_is_kept", _OF_TERM, NO_YES),
            stated(f"{name}_reduced_sigma", _OF_EXPERIMENT, SPREAD),
            stated(f"{name}_reduced_aicc", _OF_EXPERIMENT, CRITERION),
            stated(f"{name}_full_aicc", _OF_EXPERIMENT, CRITERION),
        ),
        in_group(
            "blocks",
            stated(f"{name}_block_effect", ("experiment", "block"), NOT_EVALUATED),
            stated(f"{name}_block_standard_deviation", _OF_EXPERIMENT, SPREAD),
            flag(f"{name}_block_at_boundary", _OF_EXPERIMENT, NO_YES),
        ),
        in_group(
            "points",
            _of_both_parts(f"{name}_point_value", _X),
            *(
                stated(f"{name}_point_{kind}_{end}", _X, BOUND)
                for kind in ("confidence", "prediction", "simultaneous")
                for end in ("low", "high")
            ),
            stated(f"{name}_point_mean_value", _X, "see the intervals of the value"),
            stated(f"{name}_point_variance_factor", _X, LEVELS),
            flag(f"{name}_point_is_above_leverage", _X, NO_YES),
            stated(f"{name}_ridge_coded_level", (*_D, "factor"), NOT_EVALUATED),
            stated(f"{name}_ridge_level", (*_D, "factor"), NOT_EVALUATED),
            # the runs chose the point, so that only what holds everywhere at once holds there
            stated(f"{name}_ridge_value", _D, "see its simultaneous interval"),
            stated(f"{name}_ridge_simultaneous_low", _D, BOUND),
            stated(f"{name}_ridge_simultaneous_high", _D, BOUND),
        ),
    )
    if is_transformed:
        return
    yield from chain(
        in_group(
            "runs",
            measured(f"{name}_measured", _R),
            [companion(f"{name}_measured", "_random_standard_uncertainty", _R)],
        ),
        in_group(
            "screening",
            measured(f"{name}_effect", _OF_PLAN, uncertainty_dims=_OF_EXPERIMENT),
            stated(f"{name}_effect_t", _OF_PLAN, STATISTIC),
            stated(f"{name}_effect_p_value", _OF_PLAN, STATISTIC),
            flag(f"{name}_effect_is_significant", _OF_PLAN, NO_YES),
            label(f"{name}_effect_refusal", _OF_EXPERIMENT),
            stated(f"{name}_effect_size", _OF_PLAN, "that of the effect"),
            stated(f"{name}_effect_half_normal_quantile", _OF_PLAN, "a property of the order"),
            stated(f"{name}_mean", _OF_EXPERIMENT, NOT_EVALUATED),
            stated(f"{name}_minimum_significant_effect", _OF_EXPERIMENT, BOUND),
            stated(f"{name}_simultaneous_minimum_effect", _OF_EXPERIMENT, BOUND),
        ),
    )


def _of_both_parts(name: str, dims: tuple[str, ...]) -> list[Variable]:
    """A number with what the runs share and what not, in its uncertainty and apart."""
    return [
        *measured(name, dims),
        companion(name, "_random_standard_uncertainty", dims),
        companion(name, "_uncertainty_contribution", (*_U, *dims[1:])),
    ]


_STIFFNESS_FORM = ("experiment", "stiffness_form")

_STIFFNESS_TERM = ("experiment", "stiffness_form", "stiffness_term")

_PLAN = "as planned"

_OF_RUN = "its uncertainty stands in the archive of the run"

_EXPERIMENT_ROWS = chain(
    # experiments and their axes
    label("experiment", _OF_EXPERIMENT),
    label("experiment_kind", _OF_EXPERIMENT),
    count("factor", ("factor",)),
    in_group(
        "uncertainty",
        count(COMPONENT, (COMPONENT,)),
        label("uncertainty_source", _U),
        label("uncertainty_source_of", _U),
        count("uncertainty_source_number", _U),
        stated(FREEDOM, _U, OF_UNCERTAINTY),
    ),
    label("factor_name", _F),
    label("factor_unit", _F),
    stated("factor_low", _F, _PLAN),
    stated("factor_high", _F, _PLAN),
    label("term", ("term",)),
    in_group(
        "coefficients",
        label("term_other", ("term_other",)),
    ),
    label("term_name", _OF_TERM),
    label("term_unit_engineering", _OF_TERM),
    in_group(
        "coefficients",
        label("term_error", _OF_TERM),
        stated("term_exponent", (*_OF_TERM, "factor"), "exact"),
    ),
    in_group(
        "stationary_point",
        count("direction", ("direction",)),
    ),
    in_group(
        "anova",
        label("anova_source", _A),
        label("anova_error_term", _A),
    ),
    in_group(
        "blocks",
        label("block_name", ("experiment", "block")),
        label("block_treatment", _OF_EXPERIMENT),
    ),
    in_group(
        "quality",
        stated("replicate_tolerance", _OF_EXPERIMENT, SETTING),
        stated("condition_number", _OF_EXPERIMENT, LEVELS),
    ),
    in_group(
        "screening",
        count("plan_column", ("plan_column",)),
        label("plan_column_name", _OF_PLAN),
        label("effect_error_from", _OF_EXPERIMENT),
        stated("effect_degrees_of_freedom", _OF_EXPERIMENT, COUNT),
        stated("effect_significance", _OF_EXPERIMENT, SETTING),
        count("interaction", ("interaction",)),
        label("interaction_factor", ("experiment", "interaction")),
        label("interaction_other_factor", ("experiment", "interaction")),
        stated("effect_alias", ("experiment", "interaction", "plan_column"), LEVELS),
    ),
    in_group(
        "points",
        # where surfaces are evaluated
        count("point", ("point",)),
        label("point_name", _X),
        label("point_kind", _X),
        stated("point_coded_level", (*_X, "factor"), _PLAN),
        stated("point_level", (*_X, "factor"), _PLAN),
        label("ridge_direction", ("ridge_direction",)),
        stated("ridge_radius", ("ridge_radius",), "exact"),
        stated("interval_confidence", _OF_EXPERIMENT, SETTING),
    ),
    in_group(
        "runs",
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
    ),
    in_group(
        "stiffness",
        # forms of mooring codes
        label("stiffness_form", ("stiffness_form",)),
        count("stiffness_term", ("stiffness_term",)),
        count("stiffness_term_other", ("stiffness_term_other",)),
        label("stiffness_equation", _STIFFNESS_FORM),
        label("stiffness_coefficient_name", _STIFFNESS_TERM),
        label("stiffness_coefficient_unit", _STIFFNESS_TERM),
        measured("stiffness_coefficient", _STIFFNESS_TERM),
        stated("stiffness_coefficient_low", _STIFFNESS_TERM, BOUND),
        stated("stiffness_coefficient_high", _STIFFNESS_TERM, BOUND),
        stated("stiffness_p_value", _STIFFNESS_TERM, STATISTIC),
        stated("stiffness_covariance", (*_STIFFNESS_TERM, "stiffness_term_other"), PART),
        stated("stiffness_confidence", _STIFFNESS_FORM, SETTING),
        stated("stiffness_mean_load_low", _STIFFNESS_FORM, BOUND),
        stated("stiffness_mean_load_high", _STIFFNESS_FORM, BOUND),
        stated("stiffness_n_coefficients", _STIFFNESS_FORM, COUNT),
        stated("stiffness_sigma", _STIFFNESS_FORM, SPREAD),
        stated("stiffness_degrees_of_freedom", _STIFFNESS_FORM, COUNT),
        *(
            stated(f"stiffness_{name}", _STIFFNESS_FORM, CRITERION)
            for name in (
                "r2",
                "adjusted_r2",
                "predicted_r2",
                "prediction_sum_of_squares",
                "aicc",
            )
        ),
        label("stiffness_refusal", _STIFFNESS_FORM),
        stated("stiffness_fitted", (*_STIFFNESS_FORM, "run"), FROM_SURFACE),
        stated("stiffness_residual", (*_STIFFNESS_FORM, "run"), CHECK),
    ),
    in_group(
        "single_time",
        # whether one relaxation time holds over frequency
        measured("single_time_exponent", _OF_EXPERIMENT),
        stated("single_time_exponent_low", _OF_EXPERIMENT, BOUND),
        stated("single_time_exponent_high", _OF_EXPERIMENT, BOUND),
        stated("single_time_p_value_one_time", _OF_EXPERIMENT, STATISTIC),
        stated("single_time_p_value_inverse_frequency", _OF_EXPERIMENT, STATISTIC),
        stated("single_time_ratio", _OF_EXPERIMENT, "see the ends of its interval"),
        stated("single_time_ratio_low", _OF_EXPERIMENT, BOUND),
        stated("single_time_ratio_high", _OF_EXPERIMENT, BOUND),
        stated("single_time_frequency_ratio", _OF_EXPERIMENT, _OF_RUN),
        stated("single_time_degrees_of_freedom", _OF_EXPERIMENT, COUNT),
        stated("single_time_loss_exponent", _OF_EXPERIMENT, "see the ends of its interval"),
        stated("single_time_loss_exponent_low", _OF_EXPERIMENT, BOUND),
        stated("single_time_loss_exponent_high", _OF_EXPERIMENT, BOUND),
        label("single_time_verdict", _OF_EXPERIMENT),
        stated("single_time_confidence", _OF_EXPERIMENT, SETTING),
        stated("single_time_tolerance", _OF_EXPERIMENT, SETTING),
    ),
    # responses
    chain.from_iterable(
        rows_of_response(name, is_transformed=name not in RESPONSES) for name in SURFACE_NAMES
    ),
    # what a reader of the numbers has to know
    NOTE_ROWS,
    in_group(
        "notes",
        label("note_experiment", ("note",)),
        label("caution", ("caution",)),
        label("caution_kind", ("caution",)),
        label("caution_hint", ("caution",)),
        label("caution_runs", ("caution",)),
        label("caution_experiment", ("caution",)),
    ),
)

SURFACE_SCHEMA: dict[str, Variable] = schema_from(_EXPERIMENT_ROWS)
