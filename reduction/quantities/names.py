"""The names: one row a quantity, the same in code, netCDF, tables and documents.

A name that is not here may not be a variable of a product or a column of a
table (a test reads this package).  Symbols stand only beside their source.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass


@dataclass(frozen=True)
class _Quantity:
    """One quantity: code name, SI unit, what it means, and its symbol in the source."""

    name: str
    unit: str
    long_name: str
    symbol: str = ""
    standard_name: str | None = None


OF_REDUCED = (
    # per sample; no standard name for time: the table's wants an epoch, a test has none
    _Quantity("time", "s", "elapsed time"),
    _Quantity("crosshead_position", "m", "crosshead position, thimble to thimble", "002 sec 3.2"),
    _Quantity("crosshead_displacement", "m", "crosshead displacement from the reference length"),
    _Quantity("tension", "N", "tension", "002, 003 T"),
    _Quantity("strain", "1", "nominal strain of the splice-free length", "002 eps"),
    _Quantity("nominal_stress", "Pa", "tension over the area at zero tension", "002 eq 2"),
    _Quantity("phase", "1", "phase of the test"),
    _Quantity("cycle_number", "1", "cycle number, 0 outside cycles"),
    _Quantity("branch", "1", "branch of the cycle"),
    _Quantity("quality_flag", "1", "quality of tension", standard_name="quality_flag"),
    _Quantity(
        "crosshead_position_quality_flag",
        "1",
        "quality of time and crosshead position",
        standard_name="quality_flag",
    ),
    _Quantity("measured_strain", "1", "nominal strain by an extensometer"),
    _Quantity("machine_cycle_number", "1", "cycle number by the machine's own counter"),
    _Quantity("sample_index", "1", "index of the sample in the record, from 0"),
    # the clocks of the channels
    _Quantity(
        "channel_lag",
        "s",
        "least time by which tension was logged later than position, by the turns",
    ),
    _Quantity("channel_lag_turns", "1", "turns of the wave in the lag of the channels"),
    _Quantity("channel_lag_refusal", "1", "why the turns of the wave tell no lag of the channels"),
    # per cycle
    _Quantity("cycle", "1", "cycle number"),
    _Quantity(
        "cycle_first_sample", "1", "index in the record of the first sample of the cycle, from 0"
    ),
    _Quantity(
        "cycle_last_sample", "1", "index in the record of the last sample of the cycle, from 0"
    ),
    _Quantity(
        "branch_first_sample", "1", "index in the record of the first sample of the branch, from 0"
    ),
    _Quantity(
        "branch_last_sample", "1", "index in the record of the last sample of the branch, from 0"
    ),
    _Quantity("crosshead_rate", "m s-1", "crosshead rate on the plateau of the branch"),
    _Quantity("tension_rate", "N s-1", "tension rate on the plateau of the branch"),
    _Quantity("position_band", "m", "smallest range of position that makes a reversal"),
    _Quantity("tension_band", "N", "smallest range of tension that makes a reversal"),
    _Quantity("cycles_counted_by", "", "how the cycles were counted"),
    _Quantity("frequency", "Hz", "cycle frequency", "003 f"),
    _Quantity("cycle_start_time", "s", "elapsed time at the start of the cycle"),
    _Quantity("mean_tension", "N", "mean of peak and valley tension", "003 T_m"),
    _Quantity("tension_amplitude", "N", "tension amplitude, half the range", "003 dT"),
    _Quantity("mean_strain", "1", "mean of greatest and least strain of the cycle"),
    _Quantity("strain_amplitude", "1", "strain amplitude, half the range"),
    _Quantity("peak_tension", "N", "greatest tension of the cycle"),
    _Quantity("valley_tension", "N", "least tension of the cycle"),
    _Quantity(
        "apparent_spring_constant", "N", "tension amplitude over strain amplitude", "003 K_ap, eq 1"
    ),
    _Quantity(
        "hysteresis_energy", "J m-1", "closed-loop area, tension against strain", "003 H, eq 4"
    ),
    _Quantity("loss_factor", "1", "loss over storage spring constant"),
    _Quantity("storage_spring_constant", "N", "in-phase part of the fundamental, force per strain"),
    _Quantity("loss_spring_constant", "N", "quadrature part of the fundamental, force per strain"),
    _Quantity(
        "fundamental_energy_share", "1", "share of the loop energy that the fundamental carries"
    ),
    _Quantity("dynamic_modulus", "Pa", "apparent spring constant over area at zero tension"),
    _Quantity("secant_modulus", "Pa", "stress over strain", "002 eq 1"),
    _Quantity("chord_modulus", "Pa", "end-to-end slope of a branch"),
    _Quantity("chord_modulus_ascending", "Pa", "end-to-end slope of the ascending branch"),
    _Quantity("chord_modulus_descending", "Pa", "end-to-end slope of the descending branch"),
    _Quantity(
        "stroke_mean_modulus_difference",
        "Pa",
        "ascending minus descending stroke-mean tangent modulus",
    ),
    _Quantity(
        "tension_loss_modulus", "Pa", "tension lost over the cycle, over area and strain stroke"
    ),
    _Quantity(
        "identity_residual", "1", "closed-cycle identity residual over the stroke-mean modulus"
    ),
    _Quantity(
        "mean_identity_residual",
        "1",
        "closed-cycle identity residual over the stroke-mean modulus, mean over the cycles",
    ),
    _Quantity("dissipation_spring_constant", "N", "dissipation spring constant", "003 K1"),
    _Quantity("relaxation_time", "s", "relaxation time of the three-parameter line", "003 tau"),
    _Quantity("quasi_static_spring_constant", "N", "slope of the slow pull", "003 K0"),
    # mean over the cycles of a test after break-in
    _Quantity("test_frequency", "Hz", "cycle frequency, mean over the test"),
    _Quantity("test_mean_strain", "1", "mean strain of the cycles, mean over the test"),
    _Quantity("test_strain_amplitude", "1", "strain amplitude, mean over the test"),
    _Quantity("test_mean_tension", "N", "mean tension of the cycles, mean over the test"),
    _Quantity("test_tension_amplitude", "N", "tension amplitude, mean over the test"),
    _Quantity("test_apparent_spring_constant", "N", "apparent spring constant, mean over the test"),
    _Quantity("test_dynamic_modulus", "Pa", "dynamic modulus, mean over the test"),
    _Quantity(
        "test_hysteresis_energy", "J m-1", "hysteresis energy of a cycle, mean over the test"
    ),
    _Quantity("test_storage_spring_constant", "N", "storage spring constant, mean over the test"),
    _Quantity("test_loss_spring_constant", "N", "loss spring constant, mean over the test"),
    _Quantity("test_loss_factor", "1", "loss factor, mean over the test"),
    _Quantity(
        "test_slope_reading_spread",
        "1",
        "slope of the loop between tension extremes less that between strain extremes, over K_ap",
    ),
    # per strain bin
    _Quantity("strain_bin", "1", "centre of the strain bin"),
    _Quantity("strain_bin_bounds", "1", "edges of the strain bin"),
    _Quantity("strain_window", "1", "width of the regression window of the tangent modulus"),
    _Quantity("branch_name", "", "branch of the cycle"),
    _Quantity("selected_cycle", "1", "number of a cycle whose curves are kept"),
    _Quantity("first_loading_strain_bin", "1", "centre of the strain bin of the first loading"),
    _Quantity(
        "first_loading_strain_bin_bounds", "1", "edges of the strain bin of the first loading"
    ),
    _Quantity("branch_tension_first_loading", "N", "tension of the first loading in the bin"),
    _Quantity("ratio_strain_bin", "1", "centre of the strain bin of the modulus ratio"),
    _Quantity(
        "modulus_ratio",
        "1",
        "tangent modulus of one specimen, or of some cycles, over that of another",
    ),
    _Quantity("modulus_ratio_low", "1", "lower end of the 95 % interval of the modulus ratio"),
    _Quantity("modulus_ratio_high", "1", "upper end of the 95 % interval of the modulus ratio"),
    _Quantity(
        "modulus_ratio_degrees_of_freedom",
        "1",
        "degrees of freedom of the random part of the modulus ratio",
    ),
    _Quantity("modulus_ratio_is_different", "1", "whether the interval leaves out 1"),
    _Quantity("ratio_numerator", "", "specimen or cycles above the line of the modulus ratio"),
    _Quantity("ratio_denominator", "", "specimen below the line of the modulus ratio"),
    _Quantity(
        "tangent_modulus",
        "Pa",
        "tangent modulus, trimmed branches, mean over the cycles",
        "002 eq 2",
    ),
    _Quantity("tangent_modulus_untrimmed", "Pa", "tangent modulus, whole branches"),
    _Quantity(
        "tangent_modulus_first_loading", "Pa", "tangent modulus of the first loading of the record"
    ),
    _Quantity("tangent_modulus_by_cycle", "Pa", "tangent modulus of one cycle, trimmed branches"),
    _Quantity("branch_tension", "N", "mean tension of the branch in the bin"),
    # segments
    _Quantity("segment", "1", "number of the segment, from the lowest strain"),
    _Quantity("segment_criterion", "", "how the number of segments was chosen"),
    _Quantity("segment_modulus", "Pa", "slope of a piecewise-linear segment", "002 Tables 5, 6"),
    _Quantity("segment_strain_low", "1", "lower strain end of the segment"),
    _Quantity("segment_strain_high", "1", "upper strain end of the segment"),
    _Quantity("segment_tension_low", "N", "tension at the lower end of the segment"),
    _Quantity("segment_tension_high", "N", "tension at the upper end of the segment"),
    _Quantity("segment_misfit", "N", "rms distance of the mean branch from the segment"),
    _Quantity("strain_level", "1", "stated elongation"),
    _Quantity("stress_at_strain", "Pa", "nominal stress of the first loading at an elongation"),
    # elastomer laws
    _Quantity("elastomer_specimen", "", "specimen of the elastomer fit"),
    _Quantity("elastomer_law", "", "hyperelastic law"),
    _Quantity("elastomer_rms_stress", "Pa", "root mean square residual of the elastomer fit"),
    _Quantity("elastomer_strain_low", "1", "lower end of the strain range of the fit"),
    _Quantity("elastomer_strain_high", "1", "upper end of the strain range of the fit"),
    _Quantity("elastomer_is_stable", "1", "whether the fitted law is stable over its range"),
    _Quantity("elastomer_aicc", "1", "corrected Akaike criterion of the fit, lower is better"),
    _Quantity("elastomer_parameter_fit", "1", "number of the fit that the parameter belongs to"),
    _Quantity("elastomer_parameter_name", "", "name of the parameter of the law"),
    _Quantity("elastomer_modulus", "Pa", "parameter of the law that is a modulus"),
    _Quantity("elastomer_exponent", "1", "parameter of the law that is an exponent"),
)

OF_LINE = (
    # the three-parameter line, of each cycle and from the means over the cycles of a test
    _Quantity("dashpot_coefficient", "N s", "dashpot coefficient, K_1 times tau", "003 N"),
    _Quantity("line_refusal", "1", "why a cycle has no K_1 and tau"),
    _Quantity(
        "test_quasi_static_spring_constant",
        "N",
        "slope of the slow pull at the mean tension of the test",
    ),
    _Quantity(
        "test_dissipation_spring_constant",
        "N",
        "dissipation spring constant from the means over the cycles of the test",
    ),
    _Quantity(
        "test_relaxation_time", "s", "relaxation time from the means over the cycles of the test"
    ),
    _Quantity(
        "test_dashpot_coefficient",
        "N s",
        "dashpot coefficient from the means over the cycles of the test",
    ),
    _Quantity(
        "test_line_conditioning",
        "1",
        "relative error of K_1's excess over K_0 for a relative error of K_0: K_0 / (E' - K_0)",
    ),
    _Quantity("test_line_refusal", "1", "why the test has no K_1 and tau"),
    _Quantity(
        "test_dissipation_spring_constant_low",
        "N",
        "lower end of the 95 % interval of the dissipation spring constant of the test",
    ),
    _Quantity(
        "test_dissipation_spring_constant_high",
        "N",
        "upper end of the 95 % interval of the dissipation spring constant of the test",
    ),
    _Quantity(
        "test_relaxation_time_low",
        "s",
        "lower end of the 95 % interval of the relaxation time of the test",
    ),
    _Quantity(
        "test_relaxation_time_high",
        "s",
        "upper end of the 95 % interval of the relaxation time of the test",
    ),
    _Quantity(
        "test_dashpot_coefficient_low",
        "N s",
        "lower end of the 95 % interval of the dashpot coefficient of the test",
    ),
    _Quantity(
        "test_dashpot_coefficient_high",
        "N s",
        "upper end of the 95 % interval of the dashpot coefficient of the test",
    ),
    _Quantity(
        "test_line_uncertainty_method", "1", "how the uncertainty of K_1 and tau was propagated"
    ),
    _Quantity(
        "test_line_without_solution_share",
        "1",
        "share of Monte Carlo draws of loop and slow pull that have no K_1 and tau",
    ),
    # the slow pull
    _Quantity("tension_grid", "N", "tension at which the slow pull is given"),
    _Quantity("quasi_static_strain", "1", "strain of the slow pull, by the cubic"),
    _Quantity("pull_term", "1", "power of tension in the load-strain cubic"),
    _Quantity(
        "pull_strain_coefficient",
        "1",
        "coefficient of the load-strain cubic, tension as a number of newtons",
        "003 Tables 8, 9",
    ),
    _Quantity(
        "pull_spring_constant_coefficient",
        "N",
        "coefficient of K_0 as a cubic of tension as a number of newtons",
        "003 Tables 6, 7",
    ),
    _Quantity("pull_tension_low", "N", "lower end of the range of use of the slow pull"),
    _Quantity("pull_tension_high", "N", "upper end of the range of use of the slow pull"),
    _Quantity("pull_strain_rate", "s-1", "mean strain rate of the slow pull"),
    _Quantity("pull_waiting_time", "s", "time between the last dynamic test and the slow pull"),
    _Quantity("pull_waiting", "", "time before the slow pull in the laboratory's words"),
    _Quantity("pull_residual", "1", "standard deviation of strain about the load-strain cubic"),
    _Quantity("pull_reference_tension", "N", "tension at which the reference length was read"),
    _Quantity("break_share", "1", "share of the rated break strength"),
    _Quantity(
        "strain_at_break_share", "1", "strain of the slow pull at a share of the break strength"
    ),
    # steps of a rope laboratory's programme; over the strength: over the rated break strength
    _Quantity("programme_step", "", "what the step of a rope programme gives"),
    _Quantity("bedding_cycles", "1", "cycles of the bedding-in"),
    _Quantity("bedding_first_stiffness", "N", "apparent spring constant of the first cycle"),
    _Quantity("bedding_last_stiffness", "N", "apparent spring constant of the last cycle"),
    _Quantity(
        "bedding_first_stiffness_over_strength",
        "1",
        "apparent spring constant of the first cycle over the rated break strength",
    ),
    _Quantity(
        "bedding_last_stiffness_over_strength",
        "1",
        "apparent spring constant of the last cycle over the rated break strength",
    ),
    _Quantity("bedding_stiffening", "1", "last over first apparent spring constant"),
    _Quantity(
        "bedding_permanent_strain",
        "1",
        "strain by which the foot of the loop moved from the first to the last cycle, at one "
        "tension",
    ),
    _Quantity("dynamic_cycles", "1", "cycles in the dynamic stiffness, the last ones of the step"),
    _Quantity(
        "dynamic_stiffness",
        "N",
        "apparent spring constant, mean over the last cycles of the step",
    ),
    _Quantity(
        "dynamic_stiffness_over_strength", "1", "dynamic stiffness over the rated break strength"
    ),
    _Quantity(
        "dynamic_stiffness_drift", "N", "change of the dynamic stiffness a cycle, same cycles"
    ),
    _Quantity("dynamic_frequency", "Hz", "cycle frequency of the dynamic stiffness"),
    _Quantity("dynamic_mean_tension", "N", "mean tension of the dynamic stiffness"),
    _Quantity("dynamic_tension_amplitude", "N", "tension amplitude of the dynamic stiffness"),
    _Quantity(
        "dynamic_mean_tension_over_strength",
        "1",
        "mean tension of the dynamic stiffness over the rated break strength",
    ),
    _Quantity(
        "dynamic_tension_amplitude_over_strength",
        "1",
        "tension amplitude of the dynamic stiffness over the rated break strength",
    ),
    _Quantity("held_pair", "1", "number of a pair of holds, each specimen counted"),
    _Quantity("held_pair_specimen", "", "specimen of the pair of holds"),
    _Quantity("held_pair_low_hold", "1", "number of the lower hold in the test"),
    _Quantity("held_pair_high_hold", "1", "number of the higher hold in the test"),
    _Quantity("held_pair_low_tension", "N", "tension at the end of the lower hold"),
    _Quantity("held_pair_high_tension", "N", "tension at the end of the higher hold"),
    _Quantity("held_pair_point", "1", "number of a point of stiffness against time"),
    _Quantity("static_reference_time", "s", "time after loading at which static_stiffness stands"),
    _Quantity(
        "static_stiffness",
        "N",
        "force over strain between the two holds at the reference time, by the line",
    ),
    _Quantity(
        "static_stiffness_over_strength", "1", "static stiffness over the rated break strength"
    ),
    _Quantity(
        "static_stiffness_per_decade", "N", "change of the static stiffness in a tenfold time"
    ),
    _Quantity(
        "static_stiffness_per_decade_over_strength",
        "1",
        "change of the static stiffness in a tenfold time over the rated break strength",
    ),
    _Quantity("static_refusal", "", "why the pair of holds gives no static stiffness"),
    _Quantity("static_elapsed_time", "s", "time since the centre of the ramp to the higher hold"),
    _Quantity(
        "static_stiffness_at_time", "N", "force over strain between the two holds at that time"
    ),
    _Quantity("creep_tension_over_strength", "1", "held tension over the rated break strength"),
    _Quantity(
        "creep_compliance_per_decade",
        "1",
        "strain gained per decade of time, over the held tension as a share of the rated break "
        "strength",
    ),
    # change-in-length properties of a rope, over the steps of its programme
    _Quantity("property", "1", "number of a change-in-length property, in the campaign"),
    _Quantity("property_specimen", "", "rope that has the property"),
    _Quantity("property_name", "", "which of the six change-in-length properties"),
    _Quantity("property_test", "", "test or step that the property is from"),
    _Quantity("property_low_tension", "N", "tension from which the property is; that of a hold"),
    _Quantity("property_high_tension", "N", "tension up to which the property is; that of a hold"),
    _Quantity(
        "property_reference_time", "s", "time after loading at, or from, which the property counts"
    ),
    _Quantity("property_stiffness", "N", "force over strain: original, static, dynamic stiffness"),
    _Quantity(
        "property_stiffness_over_strength",
        "1",
        "original, static or dynamic stiffness over the rated break strength",
    ),
    _Quantity("property_strain", "1", "construction, polymer or working strain"),
    *(
        _Quantity(
            f"property_{name}_degrees_of_freedom",
            "1",
            "degrees of freedom of the random part; infinite where it is of many samples",
        )
        for name in ("stiffness", "stiffness_over_strength", "strain")
    ),
    _Quantity("property_remark", "", "why the property has no number, or what is not in it"),
    _Quantity("cycles_are_run_out", "1", "whether the specimen had not failed after the cycles"),
    _Quantity("failure_peak_tension", "N", "greatest tension of a cycle, mean until failure"),
    _Quantity("failure_valley_tension", "N", "least tension of a cycle, mean until failure"),
    _Quantity(
        "failure_peak_tension_over_strength",
        "1",
        "greatest tension of a cycle, mean until failure, over the rated break strength",
    ),
    _Quantity("failure_judged_by", "", "what says that the specimen failed or not"),
    _Quantity("pull_is_break", "1", "whether the specimen broke in the pull"),
    _Quantity("pull_peak_tension", "N", "greatest tension of the pull"),
    _Quantity(
        "pull_peak_tension_over_strength",
        "1",
        "greatest tension of the pull over the rated break strength",
    ),
    _Quantity("pull_peak_strain", "1", "strain at the greatest tension of the pull"),
    _Quantity("peak_tension_per_decade", "N", "change of peak tension per decade of cycles"),
    _Quantity("dynamic_modulus_per_decade", "Pa", "change of dynamic modulus per decade of cycles"),
    _Quantity(
        "peak_tension_change",
        "1",
        "mean peak tension of the last tenth of the cycles over the first, minus 1",
    ),
)

OF_SPECIMENS = (
    # splices and specimens
    _Quantity("free_length", "m", "splice toe to splice toe"),
    _Quantity(
        "relaxed_free_length", "m", "splice toe to splice toe at zero tension", "002 Table 3"
    ),
    _Quantity("relaxed_splice_length", "m", "both splices together at zero tension"),
    _Quantity("splice_strain", "1", "nominal strain of both splices together"),
    _Quantity("mark_specimen", "", "specimen whose splice marks were read"),
    _Quantity("mark_test", "", "test in which the splice marks were read"),
    _Quantity("mark_hold", "", "hold in which the splice marks were read"),
    _Quantity("mark_position", "m", "far thimble from the near thimble at the marks"),
    _Quantity("mark_strain", "1", "strain of the free length read at the marks"),
    _Quantity("mark_tension", "N", "mean tension while the marks were read"),
    _Quantity("mark_strain_residual", "1", "strain by the method minus strain at the marks"),
    _Quantity(
        "strain_slope_ratio", "1", "strain slope of constant-fraction over that of the method"
    ),
    _Quantity("strain_method", "", "how crosshead position becomes strain"),
    _Quantity("strain_marks_from", "", "where the splice marks of the strain method come from"),
    _Quantity("strain_position_low", "m", "lower end of the marked range of position"),
    _Quantity("strain_position_high", "m", "upper end of the marked range of position"),
    _Quantity("strain_tension_low", "N", "lower end of the tension range of the marks"),
    _Quantity("strain_tension_high", "N", "upper end of the tension range of the marks"),
    _Quantity("uncertainty_component", "1", "number of an error that the test shares"),
    _Quantity("uncertainty_source", "", "what the shared error is"),
    _Quantity("uncertainty_source_of", "", "instrument, specimen or model that the error is of"),
    _Quantity("uncertainty_source_number", "1", "place among independent errors of one source"),
    _Quantity(
        "uncertainty_source_degrees_of_freedom",
        "1",
        "degrees of freedom of the standard uncertainty of a shared error; infinite where stated",
    ),
    _Quantity("coefficient_name", "", "coefficient of the strain method"),
    _Quantity("coefficient_name_other", "", "coefficient of the strain method, second axis"),
    _Quantity("strain_coefficient_correlation", "1", "correlation of two strain coefficients"),
    _Quantity("splice_compliance", "1", "strain of the splices at a tension of 1 N, c of c F**n"),
    _Quantity("splice_exponent", "1", "exponent n of tension in the splice strain c F**n"),
    _Quantity("splice_strain_ratio", "1", "splice strain over strain of the free length"),
    _Quantity("free_length_intercept", "m", "free length of the fitted line at position zero"),
    _Quantity("free_length_slope", "1", "free length gained over position gained, fitted line"),
    _Quantity("free_fraction", "1", "share of the free length in the whole length"),
    _Quantity("reference_position", "m", "crosshead position at zero strain"),
    _Quantity("strain_gauge_length", "m", "gauge length by which displacement becomes strain"),
    _Quantity("specimen", "", "specimen"),
    _Quantity("specimen_kind", "", "kind of specimen"),
    _Quantity("specimen_material", "", "material of the specimen"),
    _Quantity("specimen_construction", "", "how the specimen is built"),
    _Quantity("specimen_condition", "", "condition of the specimen before the test"),
    _Quantity("diameter_reading", "m", "diameter reading before stretch"),
    _Quantity("stretched_diameter", "m", "diameter reading on the stretched specimen"),
    _Quantity("stretched_diameter_strain", "1", "strain at which a stretched diameter was read"),
    _Quantity("rated_break_strength_source", "", "where the rated break strength is stated"),
    _Quantity("declared_gauge_length", "m", "gauge length at zero tension as declared"),
    _Quantity("area", "m2", "cross-sectional area at zero tension"),
    _Quantity("diameter", "m", "mean diameter before stretch"),
    _Quantity("rated_break_strength", "N", "rated break strength", "003 Table 2"),
    _Quantity("linear_density", "kg m-1", "mass a length in air"),
    _Quantity("wet_linear_density", "kg m-1", "mass a length less that of the displaced water"),
    _Quantity("earlier_maximum_strain", "1", "greatest strain in the specimen's earlier tests"),
    _Quantity("earlier_maximum_tension", "N", "greatest tension in the specimen's earlier tests"),
    _Quantity("earlier_cycles", "1", "cycles of the specimen before this test"),
    _Quantity("earlier_flex_cycles", "1", "cycles of flexing of the specimen before this test"),
    _Quantity("earlier_tests", "", "the specimen's earlier tests, oldest first"),
    _Quantity(
        "permanent_set",
        "1",
        "growth of the slack free length since the specimen's first test, over it",
    ),
    _Quantity(
        "slack_strain_at_unloading", "1", "strain where the specimen goes slack on unloading"
    ),
    # standstills
    _Quantity("standstill_start_time", "s", "elapsed time at the start of the standstill"),
    _Quantity("standstill_end_time", "s", "elapsed time at the end of the standstill"),
    _Quantity("standstill_position", "m", "mean crosshead position of the standstill"),
    _Quantity("standstill_tension", "N", "mean tension of the standstill"),
    _Quantity("standstill_is_rest", "1", "whether every specimen is slack"),
    _Quantity("standstill_position_tolerance", "m", "range of position allowed in a standstill"),
    _Quantity(
        "hold_tension_tolerance", "N", "range of tension allowed in a hold at constant tension"
    ),
    _Quantity("slack_tension", "N", "tension at or below which a standstill is a rest"),
    # holds
    _Quantity("hold", "1", "row of the holds, each specimen counted"),
    _Quantity("hold_number", "1", "number of the hold in the test, by time, one for all specimens"),
    _Quantity("hold_specimen", "", "specimen of the hold"),
    _Quantity("hold_kind", "", "relaxation or creep"),
    _Quantity("hold_criterion", "", "how the number of Prony terms was chosen"),
    _Quantity("hold_refusal", "", "numbers of the hold that are refused, and why"),
    _Quantity("hold_time", "s", "time after the end of the ramp"),
    _Quantity("tension_at_time", "N", "tension at a stated time after the ramp"),
    _Quantity("strain_at_time", "1", "strain at a stated time after the ramp"),
    _Quantity("prony_term", "1", "number of the Prony term"),
    _Quantity("hold_start_time", "s", "elapsed time at the start of the hold"),
    _Quantity("hold_duration", "s", "length of the hold"),
    _Quantity(
        "hold_ramp_centre_time",
        "s",
        "when the ramp to the hold acts as a step: zero of the time of its rate per decade",
    ),
    _Quantity("hold_strain", "1", "mean strain in the hold"),
    _Quantity("hold_initial_tension", "N", "tension at the start of the hold"),
    _Quantity("hold_final_tension", "N", "tension at the end of the hold"),
    _Quantity("relaxation_drop", "1", "share of tension lost over the hold"),
    _Quantity("relaxation_rate_per_decade", "1", "share of tension lost per decade of time"),
    _Quantity("creep_rate_per_decade", "1", "strain gained per decade of time"),
    _Quantity("prony_tension", "N", "tension of a Prony term"),
    _Quantity("prony_time", "s", "relaxation time of a Prony term"),
    _Quantity("long_time_tension", "N", "tension the Prony series tends to"),
    # steps
    _Quantity("gauge_length", "m", "distance between the gauge marks at the step", "002 Table 4"),
    _Quantity("relaxed_gauge_length", "m", "gauge length at zero tension, as recovered"),
    _Quantity("clock", "", "clock time of the reading, as printed"),
    _Quantity("printed_strain", "1", "elongation as recorded"),
    _Quantity("step_flag", "1", "quality of the reading"),
    _Quantity("interval_strain", "1", "strain in the middle of two readings"),
    _Quantity("interval_modulus", "Pa", "slope of stress on strain between two readings"),
    _Quantity("interval_branch", "1", "branch between two readings"),
    _Quantity("eye_to_eye_length", "m", "eye-to-eye length", "002 Table 4"),
    # slips
    _Quantity("slip_specimen", "", "specimen that stepped"),
    _Quantity("slip_cycle", "1", "first cycle after a step"),
    _Quantity("slip_cycle_low", "1", "first cycle in which the step may lie"),
    _Quantity("slip_cycle_high", "1", "last cycle in which the step may lie"),
    _Quantity("n_slips", "1", "number of steps found"),
    _Quantity("creep_per_cycle", "N", "steady drift of peak tension per cycle, steps taken out"),
    _Quantity("slip_tension_step", "N", "step of the tension level at the top of the loop"),
    _Quantity("slip_length", "m", "splice length let out by the step, a lower bound"),
    # what is known about the record
    _Quantity("note", "", "quality note"),
    _Quantity("note_stage", "", "stage that gave the note"),
    _Quantity("note_code", "", "what the note is of, the same in every version"),
    _Quantity("note_severity", "", "warning, refusal or note: how serious the note is"),
    _Quantity("channel", "", "channel of the log"),
    _Quantity("quality_mask", "", "mask of the quality flag"),
    _Quantity("n_rows_read", "1", "data rows in the raw files"),
    _Quantity("n_rows_kept", "1", "rows kept"),
    _Quantity("n_rows_stored", "1", "rows whose samples are stored"),
    _Quantity("n_flagged", "1", "rows flagged"),
)

OF_OUTCOMES = (
    # outcomes without a log, one row each
    _Quantity("outcome_row", "1", "line of the table of results, its header being 1"),
    _Quantity("outcome_quantity", "1", "what the outcome is a value of"),
    _Quantity("tensile_strength", "N", "tensile strength", "003 Tables 10, 21"),
    _Quantity("strain_at_failure", "1", "strain at failure", "003 Table 21"),
    _Quantity("cycles_to_failure", "1", "cycles to failure, or to the end", "003 Figure 19"),
    _Quantity(
        "abrasion_cycles", "1", "cycles of abrasion to failure, or to the end", "003 Table 20"
    ),
    _Quantity(
        "outcome_use", "1", "what the value says of the line: itself, at least this, nothing"
    ),
    _Quantity("outcome_test", "", "test or break that gave the outcome"),
    _Quantity("outcome_specimen", "", "specimen of the outcome"),
    _Quantity("outcome_line", "", "line, in the laboratory's words"),
    _Quantity("outcome_material", "", "material of the line"),
    _Quantity("outcome_construction", "", "how the line is built"),
    _Quantity("outcome_condition", "", "condition of the line"),
    _Quantity("outcome_diameter", "m", "nominal diameter of the line"),
    _Quantity("outcome_exposure", "Julian_year", "time of the line in the field"),
    _Quantity("outcome_minimum_load", "N", "least load of each cycle"),
    _Quantity("outcome_peak_load", "N", "greatest load of each cycle"),
    _Quantity("outcome_minimum_load_ratio", "1", "least load over the rated break strength"),
    _Quantity("outcome_peak_load_ratio", "1", "greatest load over the rated break strength"),
    _Quantity("outcome_mode", "", "how it failed, in the laboratory's words"),
    _Quantity("outcome_place", "1", "where it failed"),
    _Quantity("outcome_is_valid", "1", "the laboratory's word on the value"),
    _Quantity("outcome_is_suspended", "1", "whether the test was stopped before failure"),
    _Quantity("outcome_note", "", "the laboratory's note"),
    # columns that tables have beside the variables of the archives
    _Quantity("test", "", "test"),
    _Quantity("synthetic", "", "whether the data are synthetic, not measured"),
    _Quantity("n_cycles", "1", "number of whole cycles of the test"),
    _Quantity("strain_bin_low", "1", "lower edge of the strain bin"),
    _Quantity("strain_bin_high", "1", "upper edge of the strain bin"),
    _Quantity("envelope_minimum", "Pa", "least tangent modulus of the tests of the campaign"),
    _Quantity("envelope_minimum_test", "", "test with the least tangent modulus"),
    _Quantity("envelope_maximum", "Pa", "greatest tangent modulus of the tests of the campaign"),
    _Quantity("envelope_maximum_test", "", "test with the greatest tangent modulus"),
    _Quantity("static_test", "", "stepwise test"),
    _Quantity("static_specimen", "", "specimen of the stepwise test"),
    _Quantity(
        "static_dynamic_ratio",
        "1",
        "static interval modulus over dynamic tangent modulus, at one strain and branch",
    ),
    _Quantity("n_tests", "1", "number of tests with a tangent modulus at this strain"),
    _Quantity("table", "", "file in which the column stands"),
    _Quantity("column", "", "column"),
    _Quantity("unit", "", "unit of the column, or of the response in a row"),
    _Quantity("meaning", "", "what the column holds"),
    _Quantity("no_uncertainty", "", "why the column has no standard uncertainty beside it"),
)

OF_COMPARISONS = (
    _Quantity("comparison", "", "comparison of a test with a predicted hose"),
    _Quantity("comparison_test", "", "test that is compared"),
    _Quantity("comparison_specimen", "", "specimen of the test"),
    _Quantity("comparison_hose", "", "hose that is predicted"),
    _Quantity("comparison_loading", "", "how the test was pulled: static or dynamic"),
    _Quantity("judged_curve", "", "curve that the prediction is judged by"),
    _Quantity("comparison_point", "1", "number of the strain of the comparison"),
    _Quantity("curve", "", "curve of the test: a branch, or half way between both"),
    _Quantity("measured_tension", "N", "tension of the test, mean over the cycles"),
    _Quantity("predicted_tension", "N", "tension by the prediction at the same strain"),
    _Quantity("calibrated_tension", "N", "tension by the prediction with the fitted numbers"),
    _Quantity("tension_difference", "N", "predicted less measured tension"),
    _Quantity(
        "validation_uncertainty",
        "N",
        "standard uncertainty of the difference, that of test and of prediction together",
    ),
    _Quantity("tension_bias", "N", "mean of predicted less measured tension over strain"),
    _Quantity("tension_rms", "N", "root mean square of predicted less measured tension"),
    _Quantity(
        "tension_relative_rms",
        "1",
        "that root mean square over the root mean square of the measured tension",
    ),
    _Quantity("worst_strain", "1", "strain of the greatest difference"),
    _Quantity("worst_tension_difference", "N", "greatest difference, predicted less measured"),
    _Quantity(
        "coverage_factor",
        "1",
        "what the largest ratio stays below in 95 % of cases if the prediction is right",
    ),
    _Quantity("largest_ratio", "1", "largest difference over its standard uncertainty"),
    _Quantity("largest_ratio_strain", "1", "strain of the largest ratio"),
    _Quantity("chi_square", "1", "differences of all strains over their covariance"),
    _Quantity("chi_square_freedom", "1", "rank of that covariance"),
    _Quantity(
        "chi_square_probability", "1", "probability of such a sum if the prediction is right"
    ),
    _Quantity("uncertainty_share", "1", "median of coverage factor times uncertainty over tension"),
    _Quantity("agrees", "1", "whether the largest ratio is below the coverage factor"),
    _Quantity("is_informative", "1", "whether the uncertainty is small enough to mean anything"),
    _Quantity("verdict", "", "what the comparison says, in words"),
    _Quantity("event_measured_tension", "N", "measured tension at the strain of the event"),
    _Quantity("event_tension_difference", "N", "predicted less measured tension at the event"),
    _Quantity(
        "event_measured_strain", "1", "strain at which the tension of the event was measured"
    ),
    _Quantity("event_strain_difference", "1", "predicted less measured strain at that tension"),
    _Quantity(
        "measured_pick_up_strain", "1", "strain at which the measured curve itself bends upward"
    ),
    _Quantity("energy_strain_low", "1", "lower end of the strains of the energies"),
    _Quantity("energy_strain_high", "1", "upper end of the strains of the energies"),
    _Quantity("measured_energy", "J m-1", "energy under the ascending branch of the test"),
    _Quantity("predicted_energy", "J m-1", "energy under the prediction between the same strains"),
    _Quantity("energy_difference", "J m-1", "predicted less measured energy"),
    _Quantity("loop_energy", "J m-1", "energy between the branches; the prediction has no loop"),
    _Quantity("loop_energy_share", "1", "that energy over the energy under the ascending branch"),
    _Quantity("comparison_cycle", "1", "number of the row of cycles"),
    _Quantity("comparison_cycle_number", "1", "first cycle of the row; 0 where there is none"),
    _Quantity("cycle_bias", "N", "mean of predicted less measured tension of the cycle"),
    _Quantity("cycle_rms", "N", "root mean square of predicted less measured tension of the cycle"),
    _Quantity("bias_per_decade", "N", "change of the bias over a decade of cycles"),
    _Quantity("parameter", "1", "number of the fitted number"),
    _Quantity("parameter_other", "1", "number of the fitted number, second axis"),
    _Quantity("parameter_name", "", "number of the hose that is fitted"),
    _Quantity("parameter_unit", "", "unit of the fitted number"),
    _Quantity("parameter_start", "1", "before the fit, as a number of the unit"),
    _Quantity("parameter_value", "1", "fitted, as a number of the unit"),
    _Quantity("parameter_low", "1", "lower end of the 95 % interval"),
    _Quantity("parameter_high", "1", "upper end of the 95 % interval"),
    _Quantity("parameter_lower_bound", "1", "least value that the fit may take"),
    _Quantity("parameter_upper_bound", "1", "greatest value that the fit may take"),
    _Quantity("parameter_is_at_bound", "1", "whether the fit was stopped there"),
    _Quantity("parameter_correlation", "1", "correlation of two fitted numbers"),
    _Quantity("calibrated_bias", "N", "bias with the fitted numbers"),
    _Quantity("calibrated_rms", "N", "root mean square difference with the fitted numbers"),
    _Quantity("calibrated_relative_rms", "1", "relative root mean square with the fitted numbers"),
    _Quantity("is_identified", "1", "whether the curve tells the fitted numbers apart"),
    _Quantity("identifiability", "", "which fitted numbers trade against which"),
    _Quantity("collinearity", "1", "1 over the least singular value of scaled sensitivities"),
    _Quantity("least_change", "1", "change of the curve along the direction that it sees least"),
    _Quantity("needed_change", "1", "change below which that direction is not seen"),
    _Quantity("model_error", "N", "scatter to be added for the residuals to be explained"),
    _Quantity("effective_points", "1", "number of strains whose residuals do not go together"),
    _Quantity("note_comparison", "", "comparison that the note is of"),
)

OF_PREDICTIONS = (
    _Quantity("hose", "", "hose that is predicted"),
    _Quantity("hose_point", "1", "number of the strain in the table of the hose"),
    _Quantity(
        "free_strain", "1", "nominal strain of the part of the hose that stretches", "000 eps_h"
    ),
    _Quantity("fill_pressure", "Pa", "pressure in the bore above that outside", "000 p_h, eq 24"),
    _Quantity("cord_tension", "N", "tension of one cord", "000 P_c"),
    _Quantity(
        "cord_strain",
        "1",
        "strain of a cord along its helix, below zero where it is slack",
        "000 eps_c, eq 8",
    ),
    _Quantity(
        "cord_share", "1", "share of the net tension that the cords carry, the end cap taken off"
    ),
    _Quantity("rubber_share", "1", "share of the net tension that the rubber carries"),
    _Quantity(
        "end_cap_load",
        "N",
        "axial load that the fill pressure takes off that of the cords",
        "000 p_h A_b",
    ),
    _Quantity(
        "current_wrap_angle",
        "rad",
        "angle of the cords from the axis of the stretched hose",
        "000 eq 7",
    ),
    _Quantity(
        "cord_spacing", "m", "distance between centres of neighbouring cords", "000 c, eq 23"
    ),
    _Quantity("current_inner_diameter", "m", "bore of the stretched hose"),
    _Quantity("hose_state", "1", "what is to be said of the hose at that strain"),
    _Quantity("hose_event", "", "what happens to the cords"),
    _Quantity("event_strain", "1", "strain of the hose at the event"),
    _Quantity("event_tension", "N", "tension of the hose at the event"),
    _Quantity("event_fill_pressure", "Pa", "fill pressure at the event"),
    _Quantity("event_cord_tension", "N", "tension of one cord at the event"),
    _Quantity("event_cord_strain", "1", "strain of a cord at the event"),
    _Quantity("uncertainty_source", "", "number of the design that is uncertain"),
    _Quantity(
        "tension_contribution", "N", "change of tension for a standard uncertainty of the source"
    ),
    _Quantity(
        "fill_pressure_contribution",
        "Pa",
        "change of fill pressure for a standard uncertainty of the source",
    ),
    _Quantity(
        "wrap_angle", "rad", "wrap angle of the cords at rest, from the hose axis", "000 alpha_0"
    ),
    _Quantity("cord_layer", "", "cord layer"),
    _Quantity("layer_diameter", "m", "mean diameter of the cord layer at rest", "000 d_w0"),
    _Quantity("inner_diameter", "m", "inner diameter of the hose at rest"),
    _Quantity("outer_diameter", "m", "outer diameter of the hose at rest"),
    _Quantity("cords_per_length", "m-1", "cords per length of fabric, across them", "000 n_c"),
    _Quantity("cord_diameter", "m", "diameter of a cord"),
    _Quantity("rubber_modulus", "Pa", "Young's modulus of the rubber at small strain", "000 E_r"),
    _Quantity("rubber_law", "", "how the rubber wall carries tension"),
    _Quantity("working_share", "1", "share of the break load of a cord at the safe working load"),
    _Quantity("cord_load_scale", "1", "factor on the load of the cord curve"),
    _Quantity("cord_strain_scale", "1", "factor on the strain of the cord curve"),
    _Quantity("dead_length_share", "1", "share of the relaxed length that does not stretch"),
    _Quantity("minimum_inner_diameter", "m", "smallest bore that is allowed"),
    _Quantity(
        "ribbon_width", "m", "width to which the ribbon of a cord layer is cut", "000 w_c, eq 10"
    ),
    _Quantity(
        "number_of_cords", "1", "cords in the section of the hose, both layers", "000 N, eq 11"
    ),
    _Quantity("cord_point", "1", "number of the measured point of the cord"),
    _Quantity("cord_curve_strain", "1", "strain of a measured point of the cord"),
    _Quantity("cord_curve_load", "N", "load of a measured point of the cord"),
    _Quantity("hose_layer", "1", "number of the layer that carries no load"),
    _Quantity("hose_layer_name", "", "layer that carries no load"),
    _Quantity(
        "hose_layer_wrap_angle", "rad", "wrap angle of the layer at rest, from the hose axis"
    ),
    _Quantity("hose_layer_strain_limit", "1", "greatest tensile strain that the layer bears"),
    _Quantity(
        "hose_layer_compression_limit", "1", "greatest compressive strain that the layer bears"
    ),
    _Quantity("hose_layer_least_strain", "1", "least strain of the layer up to the working load"),
    _Quantity(
        "hose_layer_greatest_strain", "1", "greatest strain of the layer up to the working load"
    ),
    _Quantity(
        "hose_layer_break_strain", "1", "greatest strain of the layer up to the break of the cords"
    ),
    _Quantity(
        "hose_layer_least_angle",
        "rad",
        "smallest angle at which the layer is not stretched beyond its limit",
    ),
    _Quantity(
        "hose_layer_greatest_angle",
        "rad",
        "greatest angle at which the layer is not compressed beyond its limit",
    ),
    _Quantity("note_hose", "", "hose that the note is of"),
)

RESPONSES = (
    "apparent_spring_constant",
    "hysteresis_energy",
    "dissipation_spring_constant",
    "relaxation_time",
    "storage_spring_constant",
    "loss_spring_constant",
    "loss_factor",
    "dashpot_coefficient",
)
"""What a response surface can be of."""

SCALES = {"log_": "logarithm of {}", "box_cox_": "Box-Cox transform of {}"}

SURFACE_NAMES = (*RESPONSES, *(f"{scale}{name}" for scale in SCALES for name in RESPONSES))
"""Names of surfaces: of a response, or of its transform, which has no unit."""

RESPONSE_PATTERNS = (
    _Quantity("<response>_coefficient", "<unit>", "coefficient, coded units", "003 Tables 3-5"),
    _Quantity(
        "<response>_coefficient_engineering",
        "<unit>",
        "coefficient of the factors as numbers of their SI units",
    ),
    _Quantity("<response>_t", "1", "Student's t of the coefficient"),
    _Quantity("<response>_p_value", "1", "probability of the coefficient if it were nil"),
    _Quantity("<response>_term_degrees_of_freedom", "1", "degrees of freedom of the coefficient"),
    _Quantity(
        "<response>_covariance_factor", "1", "covariance of two coded coefficients over sigma**2"
    ),
    _Quantity(
        "<response>_reduced_coefficient",
        "<unit>",
        "coefficient, coded units, of the terms that AICc keeps; 0 where it does not",
    ),
    _Quantity(
        "<response>_reduced_coefficient_standard_uncertainty",
        "<unit>",
        "standard uncertainty (k=1) of that coefficient by the scatter of the runs alone, without "
        "what they share",
    ),
    _Quantity(
        "<response>_reduced_coefficient_engineering",
        "<unit>",
        "coefficient, of the kept terms, of the factors as numbers of their SI units",
    ),
    _Quantity("<response>_reduced_is_kept", "1", "whether AICc keeps the term"),
    _Quantity(
        "<response>_reduced_sigma", "<unit>", "standard deviation of a run about the kept terms"
    ),
    _Quantity("<response>_reduced_aicc", "1", "corrected Akaike criterion of the kept terms"),
    _Quantity("<response>_full_aicc", "1", "corrected Akaike criterion of all terms"),
    _Quantity("<response>_transform", "", "scale the surface was fitted on"),
    _Quantity("<response>_transform_exponent", "1", "exponent of Box and Cox; 1 none, 0 logarithm"),
    _Quantity(
        "<response>_transform_exponent_low", "1", "lower end of the interval of the exponent"
    ),
    _Quantity(
        "<response>_transform_exponent_high", "1", "upper end of the interval of the exponent"
    ),
    _Quantity("<response>_n_runs", "1", "number of runs with a value"),
    _Quantity("<response>_refusal", "", "what the surface does not give, and why"),
    _Quantity("<response>_sigma", "<unit>", "standard deviation of a run about the surface"),
    _Quantity("<response>_degrees_of_freedom", "1", "degrees of freedom of sigma"),
    _Quantity("<response>_r2", "1", "share of the variation that the surface explains"),
    _Quantity("<response>_adjusted_r2", "1", "r2 adjusted for the number of terms"),
    _Quantity("<response>_predicted_r2", "1", "r2 of runs predicted each without itself"),
    _Quantity("<response>_overall_f", "1", "F of all terms but the mean"),
    _Quantity("<response>_overall_p_value", "1", "probability of the overall F if there were none"),
    _Quantity(
        "<response>_printed_f",
        "1",
        "F as CG-D-39-80 prints it, which counts the mean twice; for comparison",
        "003 F-ratio, Tables 3-5",
    ),
    _Quantity("<response>_lack_of_fit_f", "1", "F of lack of fit against pure error"),
    _Quantity("<response>_lack_of_fit_p_value", "1", "probability of that F if the surface fits"),
    _Quantity("<response>_lack_of_fit_refusal", "", "why lack of fit is not tested"),
    _Quantity(
        "<response>_probability_plot_correlation",
        "1",
        "squared correlation of residuals with normal scores",
    ),
    _Quantity(
        "<response>_stationary_point", "1", "coded level of the factor where the slope is nil"
    ),
    _Quantity(
        "<response>_stationary_point_engineering",
        "1",
        "level where the slope is nil, as a number of the unit of the factor",
    ),
    _Quantity("<response>_stationary_point_is_inside", "1", "whether it lies within the levels"),
    _Quantity(
        "<response>_stationary_value", "<unit>", "value of the surface where its slope is nil"
    ),
    _Quantity("<response>_stationary_kind", "1", "minimum, maximum or saddle"),
    _Quantity("<response>_stationary_refusal", "", "why there is no stationary point"),
    _Quantity("<response>_eigenvalue", "<unit>", "curvature along a principal direction"),
    _Quantity("<response>_eigenvector", "1", "share of the factor in a principal direction"),
    _Quantity("<response>_measured", "<unit>", "mean over the cycles of the run"),
    _Quantity("<response>_fitted", "<unit>", "value of the surface at the run"),
    _Quantity("<response>_residual", "<unit>", "value of the run less that of the surface"),
    _Quantity("<response>_leverage", "1", "share of the run's own value in its fitted one"),
    _Quantity("<response>_cooks_distance", "1", "shift of the surface if the run were left out"),
    _Quantity("<response>_studentized_residual", "1", "residual over its own standard deviation"),
    _Quantity("<response>_deleted_residual", "1", "the same, with the scatter of the other runs"),
    _Quantity("<response>_anova_degrees_of_freedom", "1", "degrees of freedom of the source"),
    _Quantity("<response>_anova_sum_of_squares", "<unit squared>", "sum of squares of the source"),
    _Quantity("<response>_anova_mean_square", "<unit squared>", "mean square of the source"),
    _Quantity("<response>_anova_f", "1", "F of the source against its error term"),
    _Quantity("<response>_anova_p_value", "1", "probability of that F if the source were nil"),
    _Quantity("<response>_block_effect", "<unit>", "block above the mean over the blocks"),
    _Quantity("<response>_block_standard_deviation", "<unit>", "standard deviation between blocks"),
    _Quantity("<response>_block_at_boundary", "1", "whether the blocks differ no more than runs"),
    _Quantity("<response>_effect", "<unit>", "mean at the high level less that at the low one"),
    _Quantity(
        "<response>_effect_standard_uncertainty",
        "<unit>",
        "standard uncertainty (k=1) of an effect by the scatter of the runs alone, without what "
        "they share",
    ),
    _Quantity("<response>_effect_t", "1", "Student's t of the effect"),
    _Quantity("<response>_effect_p_value", "1", "probability of the effect if it were nil"),
    _Quantity("<response>_effect_is_significant", "1", "whether the effect is above the minimum"),
    _Quantity("<response>_effect_refusal", "", "why the response has no effects"),
    _Quantity("<response>_effect_size", "<unit>", "size of the effect, without its sign"),
    _Quantity(
        "<response>_effect_half_normal_quantile",
        "1",
        "quantile of the size among all columns, were they noise alone",
    ),
    _Quantity("<response>_mean", "<unit>", "mean over the runs"),
    _Quantity("<response>_minimum_significant_effect", "<unit>", "least significant effect"),
    _Quantity(
        "<response>_simultaneous_minimum_effect", "<unit>", "least effect, all of them together"
    ),
    _Quantity(
        "<response>_point_value",
        "<response unit>",
        "value of the surface at the point; the median where it is transformed",
    ),
    _Quantity("<response>_point_mean_value", "<response unit>", "mean response at the point"),
    _Quantity("<response>_point_variance_factor", "1", "variance of the surface over sigma**2"),
    _Quantity(
        "<response>_point_is_above_leverage",
        "1",
        "whether the runs say less at the point than at the worst of them",
    ),
    _Quantity(
        "<response>_point_confidence_low",
        "<response unit>",
        "lower end of the interval of the surface at this point alone",
    ),
    _Quantity(
        "<response>_point_confidence_high",
        "<response unit>",
        "upper end of the interval of the surface at this point alone",
    ),
    _Quantity(
        "<response>_point_prediction_low",
        "<response unit>",
        "lower end of the interval of one more run there",
    ),
    _Quantity(
        "<response>_point_prediction_high",
        "<response unit>",
        "upper end of the interval of one more run there",
    ),
    _Quantity(
        "<response>_point_simultaneous_low",
        "<response unit>",
        "lower end of the interval of the surface, everywhere at once",
    ),
    _Quantity(
        "<response>_point_simultaneous_high",
        "<response unit>",
        "upper end of the interval of the surface, everywhere at once",
    ),
    _Quantity(
        "<response>_ridge_coded_level",
        "1",
        "coded level of the factor where the surface is highest, or lowest, at that distance",
    ),
    _Quantity("<response>_ridge_level", "1", "that level as a number of the unit of the factor"),
    _Quantity(
        "<response>_ridge_value",
        "<response unit>",
        "highest, or lowest, value of the surface at that distance",
    ),
    _Quantity(
        "<response>_ridge_simultaneous_low",
        "<response unit>",
        "lower end of the interval of the surface, everywhere at once",
    ),
    _Quantity(
        "<response>_ridge_simultaneous_high",
        "<response unit>",
        "upper end of the interval of the surface, everywhere at once",
    ),
)

OF_EXPERIMENTS = (
    # experiments; numbers of factors stand beside the unit of the factor, which differs
    _Quantity("experiment", "", "experiment"),
    _Quantity("experiment_kind", "", "kind of design"),
    _Quantity("factor", "1", "number of the factor"),
    _Quantity("factor_name", "", "factor"),
    _Quantity("factor_unit", "", "SI unit of the factor"),
    _Quantity("factor_low", "1", "level that is -1, as a number of the unit of the factor"),
    _Quantity("factor_high", "1", "level that is +1, as a number of the unit of the factor"),
    _Quantity("run", "1", "number of the run, in the order of the campaign"),
    _Quantity("run_name", "", "test or step that was the run"),
    _Quantity("run_specimen", "", "specimen of the run"),
    _Quantity("run_block", "", "block of the run"),
    _Quantity("run_remark", "", "why a run has no number"),
    _Quantity("run_plan", "1", "coded level of the column in the run, as planned"),
    _Quantity("run_level", "1", "level in the run as reached, as a number of the factor's unit"),
    _Quantity("run_coded_level", "1", "coded level in the run, as reached"),
    _Quantity("run_frequency", "Hz", "cycle frequency, mean over the run"),
    _Quantity("run_mean_tension", "N", "mean tension, mean over the run"),
    _Quantity("run_tension_amplitude", "N", "tension amplitude, mean over the run"),
    _Quantity("run_peak_tension", "N", "greatest tension of the run's cycles"),
    _Quantity("run_minimum_tension", "N", "least tension of the run's cycles"),
    _Quantity("run_rated_break_strength", "N", "rated break strength of the run's specimen"),
    _Quantity("run_cell", "1", "runs with one number count as repeats; 0 where it has no levels"),
    _Quantity(
        "derived_dissipation_spring_constant",
        "N",
        "dissipation spring constant from the surfaces of the storage and loss spring constants",
    ),
    _Quantity(
        "derived_relaxation_time",
        "s",
        "relaxation time from the surfaces of the storage and loss spring constants",
    ),
    _Quantity("plan_column", "1", "number of the column of the plan"),
    _Quantity("plan_column_name", "", "factor of the column, or dummy"),
    _Quantity("term", "", "coefficient as printed", "003 B1..B10, eq 5"),
    _Quantity("term_other", "", "coefficient as printed, second axis"),
    _Quantity("term_name", "", "term of the surface"),
    _Quantity("term_unit_engineering", "", "unit by which that of the response is multiplied"),
    _Quantity("term_exponent", "1", "power of the factor in the term"),
    _Quantity("term_error", "", "what the coefficient is judged by"),
    _Quantity("direction", "1", "number of the principal direction, curvature falling"),
    _Quantity("anova_source", "", "source of variation"),
    _Quantity("anova_error_term", "", "what the source is tested against"),
    _Quantity("block_name", "", "block"),
    _Quantity("block_treatment", "", "whether the blocks are fixed or random"),
    _Quantity("replicate_tolerance", "1", "largest difference of coded levels between repeats"),
    _Quantity("condition_number", "1", "condition number of the model matrix"),
    _Quantity("effect_error_from", "", "what the error of the effects is from: dummy or lenth"),
    _Quantity("effect_degrees_of_freedom", "1", "degrees of freedom of the error of the effects"),
    _Quantity("effect_significance", "1", "level of the least significant effect, two-sided"),
    _Quantity("interaction", "1", "number of the two-factor interaction"),
    _Quantity("interaction_factor", "", "one factor of the interaction"),
    _Quantity("interaction_other_factor", "", "the other factor of the interaction"),
    _Quantity(
        "effect_alias", "1", "share of the interaction that stands in the effect of the column"
    ),
    _Quantity("point", "1", "number of the point: centre, points of the plan, corners"),
    _Quantity("point_name", "", "coded levels of the point"),
    _Quantity("point_kind", "", "where in the cube of the levels the point lies"),
    _Quantity("point_coded_level", "1", "coded level of the factor at the point"),
    _Quantity("point_level", "1", "level at the point, as a number of the unit of the factor"),
    _Quantity("ridge_direction", "", "the way up from the centre, or down"),
    _Quantity("ridge_radius", "1", "coded distance from the centre"),
    _Quantity("interval_confidence", "1", "confidence of the intervals at points and along ridges"),
    _Quantity("response", "", "response, or its transform"),
    _Quantity("response_unit", "", "unit of the response itself, before any transform"),
    _Quantity("coefficient_engineering_unit", "", "unit of the coefficient in engineering units"),
    # forms of mooring codes
    _Quantity("stiffness_form", "", "form of dynamic stiffness"),
    _Quantity("stiffness_equation", "", "equation of the form"),
    _Quantity("stiffness_term", "1", "number of the coefficient of the form"),
    _Quantity("stiffness_term_other", "1", "number of the coefficient of the form, second axis"),
    _Quantity("stiffness_coefficient_name", "", "coefficient of the form"),
    _Quantity("stiffness_coefficient_unit", "", "unit of the coefficient of the form"),
    _Quantity("stiffness_coefficient", "1", "coefficient of the form, as a number of its unit"),
    _Quantity(
        "stiffness_coefficient_standard_uncertainty",
        "1",
        "standard uncertainty (k=1) of that coefficient by the scatter of the runs alone, without "
        "what they share",
    ),
    _Quantity(
        "stiffness_coefficient_low",
        "1",
        "lower end of the interval of the coefficient, by the scatter of the runs alone",
    ),
    _Quantity(
        "stiffness_coefficient_high",
        "1",
        "upper end of the interval of the coefficient, by the scatter of the runs alone",
    ),
    _Quantity("stiffness_p_value", "1", "probability of the coefficient if it were nil"),
    _Quantity("stiffness_covariance", "1", "covariance of two coefficients of the form"),
    _Quantity("stiffness_confidence", "1", "confidence of the intervals of the coefficients"),
    _Quantity("stiffness_mean_load_low", "1", "lowest mean tension over the break strength"),
    _Quantity("stiffness_mean_load_high", "1", "highest mean tension over the break strength"),
    _Quantity("stiffness_n_coefficients", "1", "number of coefficients of the form"),
    _Quantity("stiffness_sigma", "1", "standard deviation about the form, over break strength"),
    _Quantity("stiffness_degrees_of_freedom", "1", "degrees of freedom of the form"),
    _Quantity("stiffness_r2", "1", "share of the variation that the form explains"),
    _Quantity("stiffness_adjusted_r2", "1", "adjusted r2 of the form"),
    _Quantity("stiffness_predicted_r2", "1", "r2 of runs predicted each without itself"),
    _Quantity("stiffness_prediction_sum_of_squares", "1", "PRESS of the form, over break strength"),
    _Quantity("stiffness_aicc", "1", "corrected Akaike criterion of the form, lower is better"),
    _Quantity("stiffness_refusal", "", "why the form has no number"),
    _Quantity("stiffness_fitted", "N", "apparent spring constant by the form"),
    _Quantity("stiffness_residual", "N", "apparent spring constant less that by the form"),
    # whether one relaxation time holds over frequency
    _Quantity("single_time_exponent", "1", "n of relaxation time ~ frequency**-n"),
    _Quantity(
        "single_time_exponent_standard_uncertainty",
        "1",
        "standard uncertainty (k=1) of n by the scatter of the runs alone, without what they share",
    ),
    _Quantity(
        "single_time_exponent_low",
        "1",
        "lower end of the interval of n, by the scatter of the runs alone",
    ),
    _Quantity(
        "single_time_exponent_high",
        "1",
        "upper end of the interval of n, by the scatter of the runs alone",
    ),
    _Quantity("single_time_p_value_one_time", "1", "probability of such an n if it were 0"),
    _Quantity(
        "single_time_p_value_inverse_frequency", "1", "probability of such an n if it were 1"
    ),
    _Quantity(
        "single_time_ratio", "1", "relaxation time at the lowest over that at the highest frequency"
    ),
    _Quantity("single_time_ratio_low", "1", "lower end of the interval of the ratio of times"),
    _Quantity("single_time_ratio_high", "1", "upper end of the interval of the ratio of times"),
    _Quantity("single_time_frequency_ratio", "1", "highest over lowest frequency"),
    _Quantity("single_time_degrees_of_freedom", "1", "degrees of freedom of the exponent"),
    _Quantity("single_time_loss_exponent", "1", "m of loss factor ~ frequency**m"),
    _Quantity("single_time_loss_exponent_low", "1", "lower end of the interval of m"),
    _Quantity("single_time_loss_exponent_high", "1", "upper end of the interval of m"),
    _Quantity("single_time_verdict", "", "whether one relaxation time holds over frequency"),
    _Quantity("single_time_confidence", "1", "confidence of the intervals of the exponents"),
    _Quantity("single_time_tolerance", "1", "by which an exponent may miss 0 or 1"),
    _Quantity("note_experiment", "", "experiment that the note is of"),
    _Quantity("caution", "", "what to know of the runs as reached"),
    _Quantity("caution_kind", "", "kind of caution"),
    _Quantity("caution_hint", "", "what can be done about it"),
    _Quantity("caution_runs", "", "runs that the caution is of; empty: the experiment"),
    _Quantity("caution_experiment", "", "experiment that the caution is of"),
)

OF_CATALOGUE = (
    _Quantity("campaign", "", "campaign"),
    _Quantity("archive", "", "archive that the row is from, below the folder of the products"),
    _Quantity("test_kind", "", "kind of test, or which archive of a whole campaign"),
    _Quantity("control", "", "what the machine controlled"),
    _Quantity("waveform", "", "shape of the controlled wave"),
    _Quantity("medium", "", "what the specimen was tested in"),
    _Quantity("least_strain", "1", "least strain of the samples and cycles kept of the test"),
    _Quantity("greatest_strain", "1", "greatest strain of the samples and cycles kept of the test"),
    # rows that an archive numbers by their place alone
    _Quantity("anova_row", "1", "row of the analysis of variance, from 1"),
    _Quantity("elastomer_fit", "1", "fit of a law of rubber, from 1"),
    _Quantity("elastomer_parameter", "1", "parameter of a law of rubber, from 1"),
    _Quantity("exposure_group", "1", "group of specimens of one exposure, from 1"),
    _Quantity("interval", "1", "interval between two steps, from 1"),
    _Quantity("loading", "1", "loading to the break, from 1"),
    _Quantity("mark", "1", "reading of the splice marks, from 1"),
    _Quantity("outcome", "1", "outcome of a specimen, from 1"),
    _Quantity("reading", "1", "reading of the diameter, from 1"),
    _Quantity("slip", "1", "step of a splice, from 1"),
    _Quantity("standstill", "1", "rest or hold of the crosshead, from 1"),
    _Quantity("step", "1", "step of a stepwise test, from 1"),
    _Quantity("stretched_reading", "1", "reading of the diameter when stretched, from 1"),
)

PHASE_VALUES = {"rest": 0, "approach": 1, "hold": 2, "cycling": 3}

BRANCH_VALUES = {"none": 0, "ascending": 1, "descending": 2}

BRANCH_NAMES = ("ascending", "descending")

SINGLE_QUANTITIES = {
    row.name: row
    for row in (
        *OF_REDUCED, *OF_LINE, *OF_SPECIMENS, *OF_OUTCOMES, *OF_EXPERIMENTS, *OF_PREDICTIONS,
        *OF_COMPARISONS, *OF_CATALOGUE,
    )
}  # fmt: skip
"""Names that stand for themselves."""


def _squared(unit: str) -> str:
    """Unit of a square: ``J m-1`` to ``J2 m-2``."""
    return re.sub(r"([A-Za-z]+)(-?\d+)?", lambda found: f"{found[1]}{2 * int(found[2] or 1)}", unit)


def _of_responses() -> Iterator[_Quantity]:
    """Every pattern for every surface and for a column of several."""
    for name in (*SURFACE_NAMES, "response"):
        base = next((name.removeprefix(one) for one in SCALES if name.startswith(one)), "")
        # a surface of a transform is evaluated in the unit of the response itself
        own = "response_unit" if name == "response" else SINGLE_QUANTITIES[base or name].unit
        unit = "1" if base else "unit" if name == "response" else own
        words = own_words = (base or name).replace("_", " ")
        if base:
            words = SCALES[name.removesuffix(base)].format(own_words)
            own_words = f"{own_words}, by the {words}"
        units = {"<unit>": unit, "<unit squared>": _squared(unit), "<response unit>": own}
        for pattern in RESPONSE_PATTERNS:
            of = own_words if pattern.unit == "<response unit>" else words
            yield _Quantity(
                pattern.name.replace("<response>", name),
                units.get(pattern.unit, pattern.unit),
                f"{of}: {pattern.long_name}",
            )


QUANTITIES = SINGLE_QUANTITIES | {row.name: row for row in _of_responses()}
"""Every name that may stand in a product or a table."""


def quantity(name: str) -> _Quantity:
    """Return the row of a name; `KeyError` where the vocabulary lacks it."""
    return QUANTITIES[name]
