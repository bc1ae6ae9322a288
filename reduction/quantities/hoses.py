"""Numbers of hoses: predictions, and measured curves against them."""

from __future__ import annotations

from reduction.quantities.axes import AXES
from reduction.quantities.flags import HOSE_STATES, NO_YES, NO_YES_NOT_ASKED
from reduction.quantities.row import (
    BOUND,
    CRITERION,
    PART,
    SETTING,
    SPREAD,
    STATISTIC,
    Quantity,
    again,
    along,
    count,
    flag,
    label,
    mask,
    measured,
    stated,
)
from reduction.quantities.samples_and_cycles import OF_RECORD

_COMPARISON = ("comparison",)

_CORD = ("hose", "cord_point")

_CORD_LAYER = ("hose", "cord_layer")

_CURVE = ("comparison", "curve")

_CYCLE_COMPARED = ("comparison", "comparison_cycle")

_EVENT = ("comparison", "hose_event")

_FITTED = ("comparison", "parameter")

_FITTED_PAIR = ("comparison", "parameter", "parameter_other")

_HOSE = ("hose",)

_HOSE_EVENT = ("hose", "hose_event")

_HOSE_POINT = ("hose", "hose_point")

_LAYER = ("hose", "hose_layer")

_NOTE = ("note",)

_POINT = ("comparison", "comparison_point")

_POINT_OF_CURVE = ("comparison", "curve", "comparison_point")

_AXES = {row.name: row for row in AXES}

_RECORD = {row.name: row for row in OF_RECORD}


OF_PREDICTIONS: tuple[Quantity, ...] = (
    *along(
        _HOSE,
        label("hose", "hose that is predicted"),
    ),
    *along(
        ("hose_event",),
        label("hose_event", "what happens to the cords"),
    ),
    *along(
        ("uncertainty_source",),
        again(_AXES["uncertainty_source"]),
    ),
    *along(
        ("cord_layer",),
        label("cord_layer", "cord layer"),
    ),
    *along(
        ("hose_point",),
        count("hose_point", "number of the strain in the table of the hose"),
    ),
    *along(
        ("cord_point",),
        count("cord_point", "number of the measured point of the cord"),
    ),
    *along(
        ("hose_layer",),
        count("hose_layer", "number of the layer that carries no load"),
    ),
    *along(
        _HOSE_POINT,
        again(
            _RECORD["strain"],
            "given: the strain at which the hose is predicted",
            tables=("predictions",),
        ),
        stated(
            "free_strain",
            "1",
            "nominal strain of the part of the hose that stretches",
            "follows from strain and wrap angle alone",
            tables=("predictions",),
            source="000 eps_h",
        ),
        again(_RECORD["tension"], tables=("predictions",)),
        measured(
            "fill_pressure",
            "Pa",
            "pressure in the bore above that outside",
            tables=("predictions",),
            source="000 p_h, eq 24",
        ),
        mask(
            "hose_state",
            "what is to be said of the hose at that strain",
            HOSE_STATES,
            tables=("predictions",),
        ),
    ),
    *along(
        _HOSE_EVENT,
        measured("event_strain", "1", "strain of the hose at the event", tables=("hose_events",)),
        measured("event_tension", "N", "tension of the hose at the event", tables=("hose_events",)),
        measured(
            "event_fill_pressure", "Pa", "fill pressure at the event", tables=("hose_events",)
        ),
        stated(
            "event_cord_tension",
            "N",
            "tension of one cord at the event",
            "not carried through: see the tension",
            tables=("hose_events",),
        ),
        stated(
            "event_cord_strain",
            "1",
            "strain of a cord at the event",
            "not carried through: see the tension",
            tables=("hose_events",),
        ),
    ),
    *along(
        _HOSE,
        measured(
            "wrap_angle",
            "rad",
            "wrap angle of the cords at rest, from the hose axis",
            tables=("hoses",),
            source="000 alpha_0",
        ),
        measured("inner_diameter", "m", "inner diameter of the hose at rest", tables=("hoses",)),
        measured("outer_diameter", "m", "outer diameter of the hose at rest", tables=("hoses",)),
        measured(
            "cords_per_length",
            "m-1",
            "cords per length of fabric, across them",
            tables=("hoses",),
            source="000 n_c",
        ),
        stated(
            "cord_diameter",
            "m",
            "diameter of a cord",
            "limits the spacing alone",
            tables=("hoses",),
        ),
        measured(
            "rubber_modulus",
            "Pa",
            "Young's modulus of the rubber at small strain",
            tables=("hoses",),
            source="000 E_r",
        ),
        label("rubber_law", "how the rubber wall carries tension", tables=("hoses",)),
        stated(
            "working_share",
            "1",
            "share of the break load of a cord at the safe working load",
            SETTING,
            tables=("hoses",),
        ),
        measured("cord_load_scale", "1", "factor on the load of the cord curve", tables=("hoses",)),
        measured(
            "cord_strain_scale", "1", "factor on the strain of the cord curve", tables=("hoses",)
        ),
        measured(
            "dead_length_share",
            "1",
            "share of the relaxed length that does not stretch",
            tables=("hoses",),
        ),
        stated(
            "minimum_inner_diameter",
            "m",
            "smallest bore that is allowed",
            SETTING,
            tables=("hoses",),
        ),
        stated(
            "number_of_cords",
            "1",
            "cords in the section of the hose, both layers",
            "follows from strain and wrap angle alone",
            tables=("hoses",),
            source="000 N, eq 11",
        ),
        group="design",
    ),
    *along(
        _CORD_LAYER,
        measured(
            "layer_diameter",
            "m",
            "mean diameter of the cord layer at rest",
            tables=("cord_layers",),
            source="000 d_w0",
        ),
        stated(
            "ribbon_width",
            "m",
            "width to which the ribbon of a cord layer is cut",
            "follows from strain and wrap angle alone",
            tables=("cord_layers",),
            source="000 w_c, eq 10",
        ),
        group="design",
    ),
    *along(
        _CORD,
        stated(
            "cord_curve_strain",
            "1",
            "strain of a measured point of the cord",
            "see cord_strain_scale and cord_load_scale",
        ),
        stated(
            "cord_curve_load",
            "N",
            "load of a measured point of the cord",
            "see cord_strain_scale and cord_load_scale",
        ),
        group="cords",
    ),
    *along(
        _HOSE_POINT,
        stated(
            "cord_tension",
            "N",
            "tension of one cord",
            "not carried through: see the tension",
            tables=("predictions",),
            source="000 P_c",
        ),
        stated(
            "cord_strain",
            "1",
            "strain of a cord along its helix, below zero where it is slack",
            "not carried through: see the tension",
            tables=("predictions",),
            source="000 eps_c, eq 8",
        ),
        stated(
            "cord_share",
            "1",
            "share of the net tension that the cords carry, the end cap taken off",
            "not carried through: see the tension",
            tables=("predictions",),
        ),
        stated(
            "rubber_share",
            "1",
            "share of the net tension that the rubber carries",
            "not carried through: see the tension",
            tables=("predictions",),
        ),
        stated(
            "end_cap_load",
            "N",
            "axial load that the fill pressure takes off that of the cords",
            "not carried through: see the tension",
            tables=("predictions",),
            source="000 p_h A_b",
        ),
        stated(
            "current_wrap_angle",
            "rad",
            "angle of the cords from the axis of the stretched hose",
            "follows from strain and wrap angle alone",
            tables=("predictions",),
            source="000 eq 7",
        ),
        stated(
            "cord_spacing",
            "m",
            "distance between centres of neighbouring cords",
            "follows from strain and wrap angle alone",
            tables=("predictions",),
            source="000 c, eq 23",
        ),
        stated(
            "current_inner_diameter",
            "m",
            "bore of the stretched hose",
            "follows from strain and wrap angle alone",
            tables=("predictions",),
        ),
        group="cords",
    ),
    *along(
        _LAYER,
        label("hose_layer_name", "layer that carries no load", tables=("hose_layers",)),
        stated(
            "hose_layer_wrap_angle",
            "rad",
            "wrap angle of the layer at rest, from the hose axis",
            SETTING,
            tables=("hose_layers",),
        ),
        stated(
            "hose_layer_strain_limit",
            "1",
            "greatest tensile strain that the layer bears",
            SETTING,
            tables=("hose_layers",),
        ),
        stated(
            "hose_layer_compression_limit",
            "1",
            "greatest compressive strain that the layer bears",
            SETTING,
            tables=("hose_layers",),
        ),
        stated(
            "hose_layer_least_strain",
            "1",
            "least strain of the layer up to the working load",
            "not carried through: see the tension",
            tables=("hose_layers",),
        ),
        stated(
            "hose_layer_greatest_strain",
            "1",
            "greatest strain of the layer up to the working load",
            "not carried through: see the tension",
            tables=("hose_layers",),
        ),
        stated(
            "hose_layer_break_strain",
            "1",
            "greatest strain of the layer up to the break of the cords",
            "not carried through: see the tension",
            tables=("hose_layers",),
        ),
        stated(
            "hose_layer_least_angle",
            "rad",
            "smallest angle at which the layer is not stretched beyond its limit",
            "not carried through: see the tension",
            tables=("hose_layers",),
        ),
        stated(
            "hose_layer_greatest_angle",
            "rad",
            "greatest angle at which the layer is not compressed beyond its limit",
            "not carried through: see the tension",
            tables=("hose_layers",),
        ),
        group="layers",
    ),
    *along(
        ("hose", "uncertainty_source", "hose_point"),
        stated(
            "tension_contribution",
            "N",
            "change of tension for a standard uncertainty of the source",
            PART,
        ),
        stated(
            "fill_pressure_contribution",
            "Pa",
            "change of fill pressure for a standard uncertainty of the source",
            PART,
        ),
        group="uncertainty",
    ),
    *along(
        _NOTE,
        label("note_hose", "hose that the note is of"),
        group="notes",
    ),
)

_PREDICTED = {row.name: row for row in OF_PREDICTIONS}

OF_COMPARISONS: tuple[Quantity, ...] = (
    *along(
        _COMPARISON,
        label("comparison", "comparison of a test with a predicted hose"),
        label("comparison_test", "test that is compared", tables=("comparisons",)),
        label("comparison_specimen", "specimen of the test", tables=("comparisons",)),
        label("comparison_hose", "hose that is predicted", tables=("comparisons",)),
        label(
            "comparison_loading",
            "how the test was pulled: static or dynamic",
            tables=("comparisons",),
        ),
        label("judged_curve", "curve that the prediction is judged by", tables=("comparisons",)),
        label("verdict", "what the comparison says, in words", tables=("comparisons",)),
        flag(
            "agrees",
            "whether the largest ratio is below the coverage factor",
            NO_YES,
            tables=("comparisons",),
        ),
        flag(
            "is_informative",
            "whether the uncertainty is small enough to mean anything",
            NO_YES,
            tables=("comparisons",),
        ),
    ),
    *along(
        ("curve",),
        label("curve", "curve of the test: a branch, or half way between both"),
    ),
    *along(
        ("hose_event",),
        again(_PREDICTED["hose_event"]),
    ),
    *along(
        ("comparison_point",),
        count("comparison_point", "number of the strain of the comparison"),
    ),
    *along(
        ("comparison_cycle",),
        count("comparison_cycle", "number of the row of cycles"),
    ),
    *along(
        ("parameter",),
        count("parameter", "number of the fitted number"),
    ),
    *along(
        ("parameter_other",),
        count("parameter_other", "number of the fitted number, second axis"),
    ),
    *along(
        _POINT,
        again(_RECORD["strain"], "given: the strain at which both are compared"),
        measured("predicted_tension", "N", "tension by the prediction at the same strain"),
        stated(
            "validation_uncertainty",
            "N",
            "standard uncertainty of the difference, that of test and of prediction together",
            "is an uncertainty",
        ),
    ),
    *along(
        _POINT_OF_CURVE,
        measured(
            "measured_tension",
            "N",
            "tension of the test, mean over the cycles",
            shares_errors=True,
            tables=("comparison_points",),
        ),
        stated(
            "tension_difference",
            "N",
            "predicted less measured tension",
            "see validation_uncertainty",
            tables=("comparison_points",),
        ),
    ),
    *along(
        _CURVE,
        stated(
            "tension_bias",
            "N",
            "mean of predicted less measured tension over strain",
            "see validation_uncertainty",
            tables=("comparison_curves",),
            page=("compared curves", "bias"),
        ),
        stated(
            "tension_rms",
            "N",
            "root mean square of predicted less measured tension",
            SPREAD,
            tables=("comparison_curves",),
            page=("compared curves", "RMS"),
        ),
        stated(
            "tension_relative_rms",
            "1",
            "that root mean square over the root mean square of the measured tension",
            SPREAD,
            tables=("comparison_curves",),
            page=("compared curves", "relative RMS"),
            percent=True,
        ),
        stated(
            "worst_tension_difference",
            "N",
            "greatest difference, predicted less measured",
            "see validation_uncertainty",
            tables=("comparison_curves",),
            page=("compared curves", "greatest difference"),
        ),
        stated(
            "worst_strain",
            "1",
            "strain of the greatest difference",
            "see validation_uncertainty",
            tables=("comparison_curves",),
            page=("compared curves", "at strain"),
            percent=True,
        ),
    ),
    *along(
        _EVENT,
        again(
            _PREDICTED["event_strain"],
            "see event_strain_difference",
            tables=("comparison_events",),
            page=("compared events", "predicted strain"),
            percent=True,
        ),
        again(
            _PREDICTED["event_tension"],
            "see event_tension_difference",
            tables=("comparison_events",),
            page=("compared events", "predicted tension"),
        ),
        stated(
            "event_measured_tension",
            "N",
            "measured tension at the strain of the event",
            "see event_tension_difference",
            tables=("comparison_events",),
            page=("compared events", "measured there"),
        ),
        measured(
            "event_tension_difference",
            "N",
            "predicted less measured tension at the event",
            tables=("comparison_events",),
            page=("compared events", "difference of tension"),
        ),
        stated(
            "event_measured_strain",
            "1",
            "strain at which the tension of the event was measured",
            "see event_strain_difference",
            tables=("comparison_events",),
            page=("compared events", "strain of that tension"),
            percent=True,
        ),
        measured(
            "event_strain_difference",
            "1",
            "predicted less measured strain at that tension",
            tables=("comparison_events",),
            page=("compared events", "difference of strain"),
            percent=True,
        ),
        group="events",
    ),
    *along(
        _COMPARISON,
        measured(
            "measured_pick_up_strain",
            "1",
            "strain at which the measured curve itself bends upward",
            tables=("comparisons",),
        ),
        group="events",
    ),
    *along(
        _COMPARISON,
        stated(
            "energy_strain_low",
            "1",
            "lower end of the strains of the energies",
            BOUND,
            tables=("comparisons",),
        ),
        stated(
            "energy_strain_high",
            "1",
            "upper end of the strains of the energies",
            BOUND,
            tables=("comparisons",),
        ),
        stated(
            "measured_energy",
            "J m-1",
            "energy under the ascending branch of the test",
            "not carried through",
            tables=("comparisons",),
            page=("compared energies", "measured, ascending"),
        ),
        stated(
            "predicted_energy",
            "J m-1",
            "energy under the prediction between the same strains",
            "not carried through",
            tables=("comparisons",),
            page=("compared energies", "predicted"),
        ),
        stated(
            "energy_difference",
            "J m-1",
            "predicted less measured energy",
            "not carried through",
            tables=("comparisons",),
            page=("compared energies", "difference"),
        ),
        stated(
            "energy_difference_share",
            "1",
            "predicted less measured energy, over the measured energy",
            "not carried through",
            tables=("comparisons",),
            page=("compared energies", "difference over measured"),
            percent=True,
        ),
        stated(
            "loop_energy",
            "J m-1",
            "energy between the branches; the prediction has no loop",
            "not carried through",
            tables=("comparisons",),
            page=("compared energies", "loop"),
        ),
        stated(
            "loop_energy_share",
            "1",
            "that energy over the energy under the ascending branch",
            "not carried through",
            tables=("comparisons",),
            page=("compared energies", "loop over measured"),
            percent=True,
        ),
        group="energy",
    ),
    *along(
        _COMPARISON,
        stated(
            "largest_ratio",
            "1",
            "largest difference over its standard uncertainty",
            STATISTIC,
            tables=("comparisons",),
        ),
        stated(
            "largest_ratio_strain",
            "1",
            "strain of the largest ratio",
            STATISTIC,
            tables=("comparisons",),
        ),
        stated(
            "coverage_factor",
            "1",
            "what the largest ratio stays below in 95 % of cases if the prediction is right",
            STATISTIC,
            tables=("comparisons",),
        ),
        stated(
            "chi_square",
            "1",
            "differences of all strains over their covariance",
            STATISTIC,
            tables=("comparisons",),
        ),
        stated(
            "chi_square_freedom", "1", "rank of that covariance", STATISTIC, tables=("comparisons",)
        ),
        stated(
            "chi_square_probability",
            "1",
            "probability of such a sum if the prediction is right",
            STATISTIC,
            tables=("comparisons",),
        ),
        stated(
            "uncertainty_share",
            "1",
            "median of coverage factor times uncertainty over tension",
            STATISTIC,
            tables=("comparisons",),
        ),
        group="statistics",
    ),
    *along(
        _CYCLE_COMPARED,
        count(
            "comparison_cycle_number",
            "first cycle of the row; 0 where there is none",
            tables=("comparison_cycles",),
        ),
        stated(
            "cycle_bias",
            "N",
            "mean of predicted less measured tension of the cycle",
            "see validation_uncertainty",
            tables=("comparison_cycles",),
        ),
        stated(
            "cycle_rms",
            "N",
            "root mean square of predicted less measured tension of the cycle",
            SPREAD,
            tables=("comparison_cycles",),
        ),
        group="cycles",
    ),
    *along(
        _COMPARISON,
        measured(
            "bias_per_decade",
            "N",
            "change of the bias over a decade of cycles",
            tables=("comparisons",),
        ),
        group="cycles",
    ),
    *along(
        _POINT,
        stated(
            "calibrated_tension",
            "N",
            "tension by the prediction with the fitted numbers",
            "see the fitted numbers",
        ),
        group="fit",
    ),
    *along(
        _FITTED,
        label("parameter_name", "number of the hose that is fitted", tables=("calibrations",)),
        label("parameter_unit", "unit of the fitted number", tables=("calibrations",)),
        stated(
            "parameter_start",
            "1",
            "before the fit, as a number of the unit",
            SETTING,
            tables=("calibrations",),
        ),
        measured(
            "parameter_value", "1", "fitted, as a number of the unit", tables=("calibrations",)
        ),
        stated(
            "parameter_low", "1", "lower end of the 95 % interval", BOUND, tables=("calibrations",)
        ),
        stated(
            "parameter_high", "1", "upper end of the 95 % interval", BOUND, tables=("calibrations",)
        ),
        stated(
            "parameter_lower_bound",
            "1",
            "least value that the fit may take",
            BOUND,
            tables=("calibrations",),
        ),
        stated(
            "parameter_upper_bound",
            "1",
            "greatest value that the fit may take",
            BOUND,
            tables=("calibrations",),
        ),
        flag(
            "parameter_is_at_bound",
            "whether the fit was stopped there",
            NO_YES,
            tables=("calibrations",),
        ),
        group="fit",
    ),
    *along(
        _FITTED_PAIR,
        stated(
            "parameter_correlation",
            "1",
            "correlation of two fitted numbers",
            PART,
            tables=("calibration_correlations",),
        ),
        group="fit",
    ),
    *along(
        _COMPARISON,
        flag(
            "is_identified",
            "whether the curve tells the fitted numbers apart",
            NO_YES_NOT_ASKED,
            tables=("comparisons",),
        ),
        label(
            "identifiability", "which fitted numbers trade against which", tables=("comparisons",)
        ),
        stated(
            "collinearity",
            "1",
            "1 over the least singular value of scaled sensitivities",
            CRITERION,
            tables=("comparisons",),
        ),
        stated(
            "calibrated_bias",
            "N",
            "bias with the fitted numbers",
            "see validation_uncertainty",
            tables=("comparisons",),
            page=("calibrated curve", "bias"),
        ),
        stated(
            "calibrated_rms",
            "N",
            "root mean square difference with the fitted numbers",
            SPREAD,
            tables=("comparisons",),
            page=("calibrated curve", "RMS"),
        ),
        stated(
            "calibrated_relative_rms",
            "1",
            "relative root mean square with the fitted numbers",
            SPREAD,
            tables=("comparisons",),
            page=("calibrated curve", "relative RMS"),
            percent=True,
        ),
        stated(
            "least_change",
            "1",
            "change of the curve along the direction that it sees least",
            CRITERION,
        ),
        stated("needed_change", "1", "change below which that direction is not seen", CRITERION),
        stated(
            "model_error",
            "N",
            "scatter to be added for the residuals to be explained",
            SPREAD,
            tables=("comparisons",),
        ),
        stated(
            "effective_points",
            "1",
            "number of strains whose residuals do not go together",
            CRITERION,
            tables=("comparisons",),
        ),
        group="fit",
    ),
    *along(
        _NOTE,
        label("note_comparison", "comparison that the note is of"),
        group="notes",
    ),
)
