"""Every variable an archive may have: one table, and nothing else is written.

Which variables a file has depends on what the test gave; a part that a test does not
give is absent, not filled.  Dimensions:

=============================  ============================================================
dimension                      one entry for
=============================  ============================================================
``specimen``                   each specimen; text coordinate ``specimen``
``sample``                     each row of the log, or each stored one; coordinate ``time``
``standstill``                 each rest and each hold
``cycle``                      each whole cycle; coordinate ``cycle`` (1, 2, ...)
``branch_name``                ascending, descending; text coordinate ``branch_name``
``strain_bin``                 each strain bin; ``strain_bin`` with ``strain_bin_bounds``
``first_loading_strain_bin``   the same for the first loading of the record
``comparison``                 each ratio of moduli: two specimens, last cycles over first
``ratio_strain_bin``           the same for the ratios
``selected_cycle``             each cycle whose own curve is kept
``segment``                    each piecewise-linear segment, from the lowest strain
``strain_level``               each stated elongation
``coefficient_name``           each coefficient of the strain methods in the file
``mark``                       each reading of the splice marks (``mark_specimen``, ...)
``reading``                    each diameter reading, ``stretched_reading`` when stretched
``tension_grid``               each tension at which a slow pull is given
``pull_term``                  each power of tension in its load-strain cubic
``break_share``                each share of the break strength at which its strain is given
``held_pair``                  each hold after a lower one (``held_pair_specimen``, ...)
``held_pair_point``            each point of its stiffness against time
``slip``                       each step of a splice (``slip_specimen``, ...)
``hold``                       each hold and specimen (``hold_specimen``, ...)
``hold_time``, ``prony_term``  each stated time after the ramp; each term of a Prony series
``elastomer_fit``              each law and specimen
``elastomer_parameter``        each parameter; ``elastomer_parameter_fit`` counts fits from 1
``step``, ``interval``         each reading of a stepwise test; between two readings
``uncertainty_component``      each error that the test shares (``uncertainty_source``, ...)
``channel``, ``quality_mask``  each channel of the log; each mask of the quality flags
``note``                       each quality note (``note``, ``note_stage``)
``bound``                      lower and upper edge of a cell
=============================  ============================================================

``crosshead_position`` and ``tension`` are as they were logged (in SI, sign and zero
applied): a sample with a flag keeps its number, and the flag beside it says what is known
against it.  ``strain`` and ``nominal_stress``, and all that follows from them, rest on usable
samples alone and are NaN where a sample is missing, saturated, stuck or a spike.

Of a long record a part is stored: ``sample_index`` then says which row of the record (those that
are kept) each sample is.  ``cycle_first_sample`` and its like count in the record, whatever is
stored of it.

A stepwise test has ``time``, ``tension``, ``strain``, ``branch`` and ``secant_modulus``
along ``step`` and no ``sample``.  The coefficients of the strain methods are variables of
their own along ``specimen`` (``relaxed_free_length``, ``splice_exponent``, ...), each with its
standard uncertainty; ``strain_coefficient_correlation`` completes their covariance.

References
----------
.. [1] CF Conventions 1.11, Eaton et al., 2023.
"""

from __future__ import annotations

from itertools import chain

from reduction.archive.curves import CURVE_ROWS, ELASTOMER_ROWS
from reduction.archive.holds import HOLD_ROWS
from reduction.archive.lag import LAG_ROWS
from reduction.archive.line import LINE_ROWS
from reduction.archive.programme import ROPE_ROWS
from reduction.archive.reasons import (
    AXIS,
    BOUND,
    CHECK,
    CLOCK,
    MOVEMENT,
    NO_YES,
    OF_MARKS,
    PART,
    READING,
    SEE_PER_DECADE,
    SETTING,
    STATED,
    STRENGTH,
    TWO_METHODS,
    WHERE_IT_STOOD,
)
from reduction.archive.shared import SHARED_ROWS
from reduction.archive.stepwise import STEP_ROWS, STEPWISE
from reduction.archive.variable import Variable, count, flag, label, mask, measured, stated
from reduction.record import Quality
from reduction.vocabulary import BRANCH_VALUES, PHASE_VALUES

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

_ROWS = chain(
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
    label("coefficient_name", ("coefficient_name",)),
    label("coefficient_name_other", ("coefficient_name_other",)),
    label("channel", ("channel",)),
    label("quality_mask", ("quality_mask",)),
    # specimens
    label("specimen_kind", _S),
    label("specimen_material", _S),
    label("specimen_construction", _S),
    label("specimen_condition", _S),
    measured("diameter", _S),
    stated("diameter_reading", ("specimen", "reading"), STATED),
    stated("stretched_diameter", ("specimen", "stretched_reading"), STATED),
    stated("stretched_diameter_strain", ("specimen", "stretched_reading"), STATED),
    measured("area", _S),
    stated("rated_break_strength", _S, STRENGTH),
    label("rated_break_strength_source", _S),
    stated("linear_density", _S, STATED),
    stated("wet_linear_density", _S, STATED),
    stated("declared_gauge_length", _S, STATED),
    label("earlier_tests", _S),
    stated("earlier_maximum_strain", _S, "bound: greatest value seen"),
    stated("earlier_maximum_tension", _S, "bound: greatest value seen"),
    stated("earlier_cycles", _S, "count"),
    stated("earlier_flex_cycles", _S, "count"),
    measured("permanent_set", _S),
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
    count("machine_cycle_number", ("sample",)),
    count("sample_index", ("sample",)),
    flag("branch", ("sample",), BRANCH_VALUES),
    # standstills
    stated("standstill_start_time", ("standstill",), CLOCK),
    stated("standstill_end_time", ("standstill",), CLOCK),
    stated("standstill_position", ("standstill",), WHERE_IT_STOOD),
    stated("standstill_tension", ("specimen", "standstill"), WHERE_IT_STOOD),
    flag("standstill_is_rest", ("standstill",), NO_YES),
    stated("standstill_position_tolerance", (), SETTING),
    stated("hold_tension_tolerance", (), SETTING),
    stated("slack_tension", (), SETTING),
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
    LINE_ROWS,
    ROPE_ROWS,
    CURVE_ROWS,
    # slips
    count("n_slips", _S),
    label("slip_specimen", ("slip",)),
    count("slip_cycle", ("slip",)),
    count("slip_cycle_low", ("slip",)),
    count("slip_cycle_high", ("slip",)),
    measured("slip_tension_step", ("slip",)),
    measured("slip_length", ("slip",)),
    stated("creep_per_cycle", _S, SEE_PER_DECADE),
    ELASTOMER_ROWS,
    HOLD_ROWS,
    STEP_ROWS,
    LAG_ROWS,
    SHARED_ROWS,
    # the record and what is known about it
    count("n_rows_read", ()),
    count("n_rows_kept", ()),
    count("n_rows_stored", ()),
    count("n_flagged", ("channel", "quality_mask")),
    label("note", ("note",)),
    label("note_stage", ("note",)),
)
SCHEMA: dict[str, Variable] = {row.name: row for row in _ROWS}


def schema_of(*, is_stepwise: bool) -> dict[str, Variable]:
    """Return the variables of a record, or of a stepwise test."""
    if not is_stepwise:
        return SCHEMA
    return SCHEMA | STEPWISE
