"""Meaning of each value, or each bit, of a flag."""

from __future__ import annotations

NO_YES = {"no": 0, "yes": 1}

QUALITY_MASKS = {
    "missing": 1,
    "gap": 2,
    "repeated_or_backward_time": 4,
    "saturated": 8,
    "stuck": 16,
    "spike": 32,
    "outside_verified_range": 64,
    "not_constant_rate": 128,
    "resampled": 256,
    "extrapolated": 512,
}

PHASE_VALUES = {"rest": 0, "approach": 1, "hold": 2, "cycling": 3}

BRANCH_VALUES = {"none": 0, "ascending": 1, "descending": 2}

LAG_REFUSALS = {
    "given": 0,
    "few_turns": 1,
    "few_samples_a_ramp": 2,
    "turns_not_sharp": 3,
    "early_as_damping_makes_it": 4,
}

LINE_REFUSALS = {
    "given": 0,
    "quasi_static_unknown": 1,
    "quasi_static_not_positive": 2,
    "reading_missing": 3,
    "reading_not_positive": 4,
    "loss_reaches_apparent": 5,
    "storage_not_above_quasi_static": 6,
}

LINE_METHODS = {"not_given": 0, "linear": 1, "monte_carlo": 2}

STEP_MASKS = {"length_and_elongation_disagree": 1, "creep": 2, "off_its_neighbours": 4}

HOSE_STATES = {"slack": 1, "broken": 2, "jammed": 4, "bore_too_small": 8}

STATIONARY_KINDS = {"none": 0, "minimum": 1, "maximum": 2, "saddle": 3}

NO_YES_NOT_ASKED = {"no": 0, "yes": 1, "not_asked": 2}

OUTCOME_QUANTITIES = {
    "tensile_strength": 0,
    "strain_at_failure": 1,
    "cycles_to_failure": 2,
    "abrasion_cycles": 3,
}

OUTCOME_PLACES = {"free": 0, "splice_toe": 1, "splice": 2, "thimble": 3, "grip": 4, "not_stated": 5}

OUTCOME_USES = {"value": 0, "lower_bound": 1, "excluded": 2}
