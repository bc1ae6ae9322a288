"""Every variable that an archive of comparisons may have.

=========================  ===========================================================
dimension                  one entry for
=========================  ===========================================================
``comparison``             each comparison; text coordinate
``comparison_point``       each strain of the measured curve, from 1
``curve``                  ascending and descending branch, midline; text coordinate
``hose_event``             pick-up, working load, break of the cords; text coordinate
``comparison_cycle``       each cycle, or row of pooled cycles, from 1
``parameter``              each fitted number of the hose, from 1; ``parameter_name``
``uncertainty_component``  each error that all samples of a test share, from 1
``note``                   each note of any comparison
=========================  ===========================================================

Every difference is predicted less measured.  Fitted numbers stand as numbers beside
``parameter_unit``.  A comparison that has fewer entries than another ends in NaN, empty text
or 0.
"""

from __future__ import annotations

from itertools import chain

from reduction.archive.reasons import (
    BOUND,
    CRITERION,
    NO_YES,
    OF_UNCERTAINTY,
    PART,
    SETTING,
    SPREAD,
    STATISTIC,
)
from reduction.archive.shared import COMPONENT, FREEDOM
from reduction.archive.variable import Variable, companion, count, flag, label, measured, stated

_C = ("comparison",)
_P = ("comparison", "comparison_point")
_V = ("comparison", "curve")
_T = ("comparison", "curve", "comparison_point")
_E = ("comparison", "hose_event")
_K = ("comparison", "comparison_cycle")
_N = ("comparison", "parameter")

_GIVEN = "given: the strain at which both are compared"
_DIFFERENCE = "see validation_uncertainty"
_IS = "is an uncertainty"
_NOT_CARRIED = "not carried through"

COMPARISON_SCHEMA: dict[str, Variable] = {
    row.name: row
    for row in chain(
        label("comparison", _C),
        label("curve", ("curve",)),
        label("hose_event", ("hose_event",)),
        count("comparison_point", ("comparison_point",)),
        count("comparison_cycle", ("comparison_cycle",)),
        count("parameter", ("parameter",)),
        count("parameter_other", ("parameter_other",)),
        *(
            label(name, _C)
            for name in (
                "comparison_test",
                "comparison_specimen",
                "comparison_hose",
                "comparison_loading",
                "judged_curve",
            )
        ),
        stated("strain", _P, _GIVEN),
        count(COMPONENT, (COMPONENT,)),
        label("uncertainty_source", (COMPONENT,)),
        label("uncertainty_source_of", (COMPONENT,)),
        count("uncertainty_source_number", (COMPONENT,)),
        stated(FREEDOM, (COMPONENT,), OF_UNCERTAINTY),
        measured("measured_tension", _T),
        [
            companion("measured_tension", "_random_standard_uncertainty", _T),
            companion("measured_tension", "_uncertainty_contribution", (COMPONENT, *_T)),
        ],
        measured("predicted_tension", _P),
        stated("calibrated_tension", _P, "see the fitted numbers"),
        stated("tension_difference", _T, _DIFFERENCE),
        stated("validation_uncertainty", _P, _IS),
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
        *(
            stated(name, _C, STATISTIC)
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
        flag("agrees", _C, NO_YES),
        flag("is_informative", _C, NO_YES),
        label("verdict", _C),
        stated("event_strain", _E, "see event_strain_difference"),
        stated("event_tension", _E, "see event_tension_difference"),
        stated("event_measured_tension", _E, "see event_tension_difference"),
        measured("event_tension_difference", _E),
        stated("event_measured_strain", _E, "see event_strain_difference"),
        measured("event_strain_difference", _E),
        measured("measured_pick_up_strain", _C),
        *(
            stated(name, _C, why)
            for name, why in (
                ("energy_strain_low", BOUND),
                ("energy_strain_high", BOUND),
                ("measured_energy", _NOT_CARRIED),
                ("predicted_energy", _NOT_CARRIED),
                ("energy_difference", _NOT_CARRIED),
                ("loop_energy", _NOT_CARRIED),
                ("loop_energy_share", _NOT_CARRIED),
            )
        ),
        count("comparison_cycle_number", _K),
        stated("cycle_bias", _K, _DIFFERENCE),
        stated("cycle_rms", _K, SPREAD),
        measured("bias_per_decade", _C),
        label("parameter_name", _N),
        label("parameter_unit", _N),
        stated("parameter_start", _N, SETTING),
        measured("parameter_value", _N),
        *(
            stated(f"parameter_{name}", _N, BOUND)
            for name in ("low", "high", "lower_bound", "upper_bound")
        ),
        flag("parameter_is_at_bound", _N, NO_YES),
        stated("parameter_correlation", (*_N, "parameter_other"), PART),
        stated("calibrated_bias", _C, _DIFFERENCE),
        stated("calibrated_rms", _C, SPREAD),
        stated("calibrated_relative_rms", _C, SPREAD),
        flag("is_identified", _C, NO_YES | {"not_asked": 2}),
        label("identifiability", _C),
        *(
            stated(name, _C, CRITERION)
            for name in ("collinearity", "least_change", "needed_change", "effective_points")
        ),
        stated("model_error", _C, SPREAD),
        label("note_comparison", ("note",)),
        label("note", ("note",)),
    )
}
"""Every variable that an archive of comparisons may have."""
