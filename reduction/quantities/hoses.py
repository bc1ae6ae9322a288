"""Quantities of hoses: predictions, and measured curves compared with them."""

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
        label("hose", "predicted hose"),
    ),
    *along(
        ("hose_event",),
        label("hose_event", "event in the cords"),
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
        count("hose_point", "number of the strain point in the hose table"),
    ),
    *along(
        ("cord_point",),
        count("cord_point", "number of the measured point of the cord curve"),
    ),
    *along(
        ("hose_layer",),
        count("hose_layer", "number of the non-load-bearing layer"),
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
            "nominal strain of the stretching part of the hose",
            "follows from strain and wrap angle",
            tables=("predictions",),
            source="000 eps_h",
        ),
        again(_RECORD["tension"], tables=("predictions",)),
        again(_RECORD["fill_pressure"], tables=("predictions",)),
        mask(
            "hose_state",
            "state of the hose at this strain",
            HOSE_STATES,
            tables=("predictions",),
        ),
    ),
    *along(
        _HOSE_EVENT,
        measured("event_strain", "1", "hose strain at the event", tables=("hose_events",)),
        measured("event_tension", "N", "hose tension at the event", tables=("hose_events",)),
        measured(
            "event_fill_pressure", "Pa", "fill pressure at the event", tables=("hose_events",)
        ),
        stated(
            "event_cord_tension",
            "N",
            "tension in one cord at the event",
            "no separate estimate: see tension",
            tables=("hose_events",),
        ),
        stated(
            "event_cord_strain",
            "1",
            "strain of a cord at the event",
            "no separate estimate: see tension",
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
            "cords per length of fabric, measured across the cords",
            tables=("hoses",),
            source="000 n_c",
        ),
        stated(
            "cord_diameter",
            "m",
            "cord diameter",
            "only limits the cord spacing",
            tables=("hoses",),
        ),
        measured(
            "rubber_modulus",
            "Pa",
            "Young's modulus of the rubber at small strain",
            tables=("hoses",),
            source="000 E_r",
        ),
        label("rubber_law", "stress-strain law of the rubber wall", tables=("hoses",)),
        stated(
            "working_share",
            "1",
            "safe working load of a cord as a fraction of its break load",
            SETTING,
            tables=("hoses",),
        ),
        measured("cord_load_scale", "1", "scale factor of the cord load", tables=("hoses",)),
        measured(
            "cord_strain_scale",
            "1",
            "scale factor of the cord strain",
            tables=("hoses",),
        ),
        measured(
            "dead_length_share",
            "1",
            "fraction of the relaxed length that does not stretch",
            tables=("hoses",),
        ),
        stated(
            "minimum_inner_diameter",
            "m",
            "minimum allowed bore",
            SETTING,
            tables=("hoses",),
        ),
        stated(
            "number_of_cords",
            "1",
            "number of cords in the hose cross-section, both layers",
            "follows from strain and wrap angle",
            tables=("hoses",),
            source="000 N, eq 11",
        ),
        stated(
            "working_torque",
            "N m",
            "torque that holds the hose from turning at the working load, positive as the inner "
            "cord layer would turn it",
            "follows from strain and wrap angle",
            tables=("hoses",),
        ),
        stated(
            "balanced_wrap_angle",
            "rad",
            "wrap angle of an outer cord layer that leaves no torque at the working load",
            "follows from strain and wrap angle",
            tables=("hoses",),
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
            "width to which the cord ribbon of a layer is cut",
            "follows from strain and wrap angle",
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
            "strain of a measured point of the cord curve",
            "see cord_strain_scale and cord_load_scale",
        ),
        stated(
            "cord_curve_load",
            "N",
            "load of a measured point of the cord curve",
            "see cord_strain_scale and cord_load_scale",
        ),
        group="cords",
    ),
    *along(
        _HOSE_POINT,
        stated(
            "cord_tension",
            "N",
            "tension in one cord",
            "no separate estimate: see tension",
            tables=("predictions",),
            source="000 P_c",
        ),
        stated(
            "cord_strain",
            "1",
            "strain of a cord along its helix; negative when slack",
            "no separate estimate: see tension",
            tables=("predictions",),
            source="000 eps_c, eq 8",
        ),
        stated(
            "cord_share",
            "1",
            "fraction of the net tension carried by the cords, end-cap load deducted",
            "no separate estimate: see tension",
            tables=("predictions",),
        ),
        stated(
            "rubber_share",
            "1",
            "fraction of the net tension carried by the rubber",
            "no separate estimate: see tension",
            tables=("predictions",),
        ),
        stated(
            "end_cap_load",
            "N",
            "axial end-cap load of the fill pressure, which reduces the cord load",
            "no separate estimate: see tension",
            tables=("predictions",),
            source="000 p_h A_b",
        ),
        stated(
            "current_wrap_angle",
            "rad",
            "wrap angle from the axis of the stretched hose",
            "follows from strain and wrap angle",
            tables=("predictions",),
            source="000 eq 7",
        ),
        stated(
            "cord_spacing",
            "m",
            "centre-to-centre spacing of neighbouring cords",
            "follows from strain and wrap angle",
            tables=("predictions",),
            source="000 c, eq 23",
        ),
        stated(
            "current_inner_diameter",
            "m",
            "bore of the stretched hose",
            "follows from strain and wrap angle",
            tables=("predictions",),
        ),
        group="cords",
    ),
    *along(
        _LAYER,
        label("hose_layer_name", "non-load-bearing layer", tables=("hose_layers",)),
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
            "maximum tensile strain that the layer withstands",
            SETTING,
            tables=("hose_layers",),
        ),
        stated(
            "hose_layer_compression_limit",
            "1",
            "maximum compressive strain that the layer withstands",
            SETTING,
            tables=("hose_layers",),
        ),
        stated(
            "hose_layer_least_strain",
            "1",
            "minimum strain of the layer up to the working load",
            "no separate estimate: see tension",
            tables=("hose_layers",),
        ),
        stated(
            "hose_layer_greatest_strain",
            "1",
            "maximum strain of the layer up to the working load",
            "no separate estimate: see tension",
            tables=("hose_layers",),
        ),
        stated(
            "hose_layer_break_strain",
            "1",
            "maximum strain of the layer up to break of the cords",
            "no separate estimate: see tension",
            tables=("hose_layers",),
        ),
        stated(
            "hose_layer_least_angle",
            "rad",
            "smallest wrap angle that keeps the layer within its tensile limit",
            "no separate estimate: see tension",
            tables=("hose_layers",),
        ),
        stated(
            "hose_layer_greatest_angle",
            "rad",
            "largest wrap angle that keeps the layer within its compressive limit",
            "no separate estimate: see tension",
            tables=("hose_layers",),
        ),
        group="layers",
    ),
    *along(
        ("hose", "uncertainty_source", "hose_point"),
        stated(
            "tension_contribution",
            "N",
            "change in tension per standard uncertainty of the source",
            PART,
        ),
        stated(
            "fill_pressure_contribution",
            "Pa",
            "change in fill pressure per standard uncertainty of the source",
            PART,
        ),
        group="uncertainty",
    ),
    *along(
        _NOTE,
        label("note_hose", "hose to which the note applies"),
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
            "loading of the test: static or dynamic",
            tables=("comparisons",),
        ),
        label("judged_curve", "measured curve used for the comparison", tables=("comparisons",)),
        label("verdict", "verdict of the comparison", tables=("comparisons",)),
        flag(
            "agrees",
            "whether the largest ratio is below the coverage factor",
            NO_YES,
            tables=("comparisons",),
        ),
        flag(
            "is_informative",
            "whether the uncertainty is small enough for a meaningful verdict",
            NO_YES,
            tables=("comparisons",),
        ),
    ),
    *along(
        ("curve",),
        label("curve", "measured curve: a branch, or the midline of both branches"),
    ),
    *along(
        ("hose_event",),
        again(_PREDICTED["hose_event"]),
    ),
    *along(
        ("comparison_point",),
        count("comparison_point", "number of the strain point in the comparison"),
    ),
    *along(
        ("comparison_cycle",),
        count("comparison_cycle", "number of the group of cycles"),
    ),
    *along(
        ("parameter",),
        count("parameter", "number of the fitted parameter"),
    ),
    *along(
        ("parameter_other",),
        count("parameter_other", "number of the fitted parameter (second axis)"),
    ),
    *along(
        _POINT,
        again(_RECORD["strain"], "given: the strain at which both are compared"),
        measured("predicted_tension", "N", "predicted tension at the same strain"),
        stated(
            "validation_uncertainty",
            "N",
            "combined standard uncertainty of the difference (test and prediction)",
            "is an uncertainty",
        ),
    ),
    *along(
        _POINT,
        measured(
            "measured_fill_pressure",
            "Pa",
            "measured fill pressure of the judged curve, mean over the cycles",
            tables=("comparison_pressures",),
        ),
        measured(
            "predicted_fill_pressure",
            "Pa",
            "predicted fill pressure at the same strain",
            tables=("comparison_pressures",),
        ),
        stated(
            "fill_pressure_validation_uncertainty",
            "Pa",
            "combined standard uncertainty of the difference in fill pressure",
            "is an uncertainty",
            tables=("comparison_pressures",),
        ),
        group="fill_pressure",
    ),
    *along(
        _COMPARISON,
        label(
            "fill_pressure_verdict",
            "verdict of the comparison of fill pressures",
            tables=("comparisons",),
        ),
        stated(
            "fill_pressure_bias",
            "Pa",
            "mean over strain of predicted minus measured fill pressure",
            "see fill_pressure_validation_uncertainty",
            tables=("comparisons",),
        ),
        stated(
            "fill_pressure_rms",
            "Pa",
            "root mean square of predicted minus measured fill pressure",
            SPREAD,
            tables=("comparisons",),
        ),
        group="fill_pressure",
    ),
    *along(
        _FITTED,
        measured(
            "fill_pressure_parameter_value",
            "1",
            "value fitted to the fill pressure instead, in the parameter's unit",
            tables=("calibrations",),
        ),
        group="fill_pressure",
    ),
    *along(
        _POINT_OF_CURVE,
        measured(
            "measured_tension",
            "N",
            "measured tension, mean over the cycles",
            shares_errors=True,
            tables=("comparison_points",),
        ),
        stated(
            "tension_difference",
            "N",
            "predicted minus measured tension",
            "see validation_uncertainty",
            tables=("comparison_points",),
        ),
    ),
    *along(
        _CURVE,
        stated(
            "tension_bias",
            "N",
            "mean over strain of predicted minus measured tension",
            "see validation_uncertainty",
            tables=("comparison_curves",),
            page=("compared curves", "bias"),
        ),
        stated(
            "tension_rms",
            "N",
            "root mean square of predicted minus measured tension",
            SPREAD,
            tables=("comparison_curves",),
            page=("compared curves", "RMS"),
        ),
        stated(
            "tension_relative_rms",
            "1",
            "root-mean-square difference divided by root-mean-square measured tension",
            SPREAD,
            tables=("comparison_curves",),
            page=("compared curves", "relative RMS"),
            percent=True,
        ),
        stated(
            "worst_tension_difference",
            "N",
            "largest difference, predicted minus measured tension",
            "see validation_uncertainty",
            tables=("comparison_curves",),
            page=("compared curves", "largest difference"),
        ),
        stated(
            "worst_strain",
            "1",
            "strain at the largest difference",
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
            "predicted minus measured tension at the event",
            tables=("comparison_events",),
            page=("compared events", "tension difference"),
        ),
        stated(
            "event_measured_strain",
            "1",
            "strain at which the event tension was measured",
            "see event_strain_difference",
            tables=("comparison_events",),
            page=("compared events", "strain at that tension"),
            percent=True,
        ),
        measured(
            "event_strain_difference",
            "1",
            "predicted minus measured strain at the event tension",
            tables=("comparison_events",),
            page=("compared events", "strain difference"),
            percent=True,
        ),
        group="events",
    ),
    *along(
        _COMPARISON,
        measured(
            "measured_pick_up_strain",
            "1",
            "strain at which the measured curve bends upwards",
            tables=("comparisons",),
        ),
        group="events",
    ),
    *along(
        _COMPARISON,
        stated(
            "energy_strain_low",
            "1",
            "lower limit of the strain range of the energies",
            BOUND,
            tables=("comparisons",),
        ),
        stated(
            "energy_strain_high",
            "1",
            "upper limit of the strain range of the energies",
            BOUND,
            tables=("comparisons",),
        ),
        stated(
            "measured_energy",
            "J m-1",
            "energy under the ascending branch of the test",
            "not propagated",
            tables=("comparisons",),
            page=("compared energies", "measured, ascending"),
        ),
        stated(
            "predicted_energy",
            "J m-1",
            "energy under the predicted curve over the same strain range",
            "not propagated",
            tables=("comparisons",),
            page=("compared energies", "predicted"),
        ),
        stated(
            "energy_difference",
            "J m-1",
            "predicted minus measured energy",
            "not propagated",
            tables=("comparisons",),
            page=("compared energies", "difference"),
        ),
        stated(
            "energy_difference_share",
            "1",
            "energy difference divided by the measured energy",
            "not propagated",
            tables=("comparisons",),
            page=("compared energies", "difference / measured"),
            percent=True,
        ),
        stated(
            "loop_energy",
            "J m-1",
            "hysteresis loop energy of the test; the prediction has no loop",
            "not propagated",
            tables=("comparisons",),
            page=("compared energies", "loop"),
        ),
        stated(
            "loop_energy_share",
            "1",
            "loop energy divided by the energy under the ascending branch",
            "not propagated",
            tables=("comparisons",),
            page=("compared energies", "loop / measured"),
            percent=True,
        ),
        group="energy",
    ),
    *along(
        _COMPARISON,
        stated(
            "largest_ratio",
            "1",
            "largest difference divided by its standard uncertainty",
            STATISTIC,
            tables=("comparisons",),
        ),
        stated(
            "largest_ratio_strain",
            "1",
            "strain at the largest ratio",
            STATISTIC,
            tables=("comparisons",),
        ),
        stated(
            "coverage_factor",
            "1",
            "95 % quantile of the largest ratio if the prediction is right",
            STATISTIC,
            tables=("comparisons",),
        ),
        stated(
            "chi_square",
            "1",
            "chi-square of the differences, with their full covariance",
            STATISTIC,
            tables=("comparisons",),
        ),
        stated(
            "chi_square_freedom",
            "1",
            "degrees of freedom of chi-square (rank of the covariance)",
            STATISTIC,
            tables=("comparisons",),
        ),
        stated(
            "chi_square_probability",
            "1",
            "probability of a larger chi-square if the prediction is right",
            STATISTIC,
            tables=("comparisons",),
        ),
        stated(
            "uncertainty_share",
            "1",
            "median of expanded uncertainty divided by tension",
            STATISTIC,
            tables=("comparisons",),
        ),
        group="statistics",
    ),
    *along(
        _CYCLE_COMPARED,
        count(
            "comparison_cycle_number",
            "first cycle of the group; 0 if none",
            tables=("comparison_cycles",),
        ),
        stated(
            "cycle_bias",
            "N",
            "mean of predicted minus measured tension over the cycle",
            "see validation_uncertainty",
            tables=("comparison_cycles",),
        ),
        stated(
            "cycle_rms",
            "N",
            "root mean square of predicted minus measured tension over the cycle",
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
            "change in bias per decade of cycles",
            tables=("comparisons",),
        ),
        group="cycles",
    ),
    *along(
        _POINT,
        stated(
            "calibrated_tension",
            "N",
            "predicted tension with the fitted parameters",
            "see the fitted numbers",
        ),
        group="fit",
    ),
    *along(
        _FITTED,
        label("parameter_name", "fitted parameter of the hose", tables=("calibrations",)),
        label("parameter_unit", "unit of the fitted parameter", tables=("calibrations",)),
        stated(
            "parameter_start",
            "1",
            "value before the fit, in the parameter's unit",
            SETTING,
            tables=("calibrations",),
        ),
        measured(
            "parameter_value",
            "1",
            "fitted value, in the parameter's unit",
            tables=("calibrations",),
        ),
        stated(
            "parameter_low",
            "1",
            "lower limit of the 95 % interval",
            BOUND,
            tables=("calibrations",),
        ),
        stated(
            "parameter_high",
            "1",
            "upper limit of the 95 % interval",
            BOUND,
            tables=("calibrations",),
        ),
        stated(
            "parameter_lower_bound",
            "1",
            "lower bound of the fit",
            BOUND,
            tables=("calibrations",),
        ),
        stated(
            "parameter_upper_bound",
            "1",
            "upper bound of the fit",
            BOUND,
            tables=("calibrations",),
        ),
        flag(
            "parameter_is_at_bound",
            "whether the fit stopped at a bound",
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
            "correlation between two fitted parameters",
            PART,
            tables=("calibration_correlations",),
        ),
        group="fit",
    ),
    *along(
        _COMPARISON,
        flag(
            "is_identified",
            "whether the curve determines all fitted parameters",
            NO_YES_NOT_ASKED,
            tables=("comparisons",),
        ),
        label(
            "identifiability",
            "fitted parameters that the curve cannot separate",
            tables=("comparisons",),
        ),
        stated(
            "collinearity",
            "1",
            "collinearity index: inverse of the smallest singular value of the "
            "scaled sensitivities",
            CRITERION,
            tables=("comparisons",),
        ),
        stated(
            "calibrated_bias",
            "N",
            "bias with the fitted parameters",
            "see validation_uncertainty",
            tables=("comparisons",),
            page=("calibrated curve", "bias"),
        ),
        stated(
            "calibrated_rms",
            "N",
            "root-mean-square difference with the fitted parameters",
            SPREAD,
            tables=("comparisons",),
            page=("calibrated curve", "RMS"),
        ),
        stated(
            "calibrated_relative_rms",
            "1",
            "relative root-mean-square difference with the fitted parameters",
            SPREAD,
            tables=("comparisons",),
            page=("calibrated curve", "relative RMS"),
            percent=True,
        ),
        stated(
            "least_change",
            "1",
            "change in the curve along the least visible parameter direction",
            CRITERION,
        ),
        stated(
            "needed_change", "1", "smallest change in the curve that counts as visible", CRITERION
        ),
        stated(
            "model_error",
            "N",
            "added scatter needed to explain the residuals",
            SPREAD,
            tables=("comparisons",),
        ),
        stated(
            "effective_points",
            "1",
            "number of independent residuals",
            CRITERION,
            tables=("comparisons",),
        ),
        group="fit",
    ),
    *along(
        _NOTE,
        label("note_comparison", "comparison to which the note applies"),
        group="notes",
    ),
)
