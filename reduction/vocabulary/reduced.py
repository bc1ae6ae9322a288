"""Quantities of a reduced test: samples, cycles, line, curves, specimens."""

from __future__ import annotations

from reduction.vocabulary.row import Quantity

OF_REDUCED = (
    # per sample; no standard name for time: the table's wants an epoch, a test has none
    Quantity("time", "s", "elapsed time"),
    Quantity("crosshead_position", "m", "crosshead position, thimble to thimble", "002 sec 3.2"),
    Quantity("crosshead_displacement", "m", "crosshead displacement from the reference length"),
    Quantity("tension", "N", "tension", "002, 003 T"),
    Quantity("strain", "1", "nominal strain of the splice-free length", "002 eps"),
    Quantity("nominal_stress", "Pa", "tension over the area at zero tension", "002 eq 2"),
    Quantity("phase", "1", "phase of the test"),
    Quantity("cycle_number", "1", "cycle number, 0 outside cycles"),
    Quantity("branch", "1", "branch of the cycle"),
    Quantity("quality_flag", "1", "quality of tension", standard_name="quality_flag"),
    Quantity(
        "crosshead_position_quality_flag",
        "1",
        "quality of time and crosshead position",
        standard_name="quality_flag",
    ),
    Quantity("measured_strain", "1", "nominal strain by an extensometer"),
    Quantity("machine_cycle_number", "1", "cycle number by the machine's own counter"),
    Quantity("sample_index", "1", "index of the sample in the record, from 0"),
    # the clocks of the channels
    Quantity(
        "channel_lag",
        "s",
        "least time by which tension was logged later than position, by the turns",
    ),
    Quantity("channel_lag_turns", "1", "turns of the wave in the lag of the channels"),
    Quantity("channel_lag_refusal", "1", "why the turns of the wave tell no lag of the channels"),
    # per cycle
    Quantity("cycle", "1", "cycle number"),
    Quantity(
        "cycle_first_sample", "1", "index in the record of the first sample of the cycle, from 0"
    ),
    Quantity(
        "cycle_last_sample", "1", "index in the record of the last sample of the cycle, from 0"
    ),
    Quantity(
        "branch_first_sample", "1", "index in the record of the first sample of the branch, from 0"
    ),
    Quantity(
        "branch_last_sample", "1", "index in the record of the last sample of the branch, from 0"
    ),
    Quantity("crosshead_rate", "m s-1", "crosshead rate on the plateau of the branch"),
    Quantity("tension_rate", "N s-1", "tension rate on the plateau of the branch"),
    Quantity("position_band", "m", "smallest range of position that makes a reversal"),
    Quantity("tension_band", "N", "smallest range of tension that makes a reversal"),
    Quantity("cycles_counted_by", "", "how the cycles were counted"),
    Quantity("frequency", "Hz", "cycle frequency", "003 f"),
    Quantity("cycle_start_time", "s", "elapsed time at the start of the cycle"),
    Quantity("mean_tension", "N", "mean of peak and valley tension", "003 T_m"),
    Quantity("tension_amplitude", "N", "tension amplitude, half the range", "003 dT"),
    Quantity("mean_strain", "1", "mean of greatest and least strain of the cycle"),
    Quantity("strain_amplitude", "1", "strain amplitude, half the range"),
    Quantity("peak_tension", "N", "greatest tension of the cycle"),
    Quantity("valley_tension", "N", "least tension of the cycle"),
    Quantity(
        "apparent_spring_constant", "N", "tension amplitude over strain amplitude", "003 K_ap, eq 1"
    ),
    Quantity(
        "hysteresis_energy", "J m-1", "closed-loop area, tension against strain", "003 H, eq 4"
    ),
    Quantity("loss_factor", "1", "loss over storage spring constant"),
    Quantity("storage_spring_constant", "N", "in-phase part of the fundamental, force per strain"),
    Quantity("loss_spring_constant", "N", "quadrature part of the fundamental, force per strain"),
    Quantity(
        "fundamental_energy_share", "1", "share of the loop energy that the fundamental carries"
    ),
    Quantity("dynamic_modulus", "Pa", "apparent spring constant over area at zero tension"),
    Quantity("secant_modulus", "Pa", "stress over strain", "002 eq 1"),
    Quantity("chord_modulus", "Pa", "end-to-end slope of a branch"),
    Quantity("chord_modulus_ascending", "Pa", "end-to-end slope of the ascending branch"),
    Quantity("chord_modulus_descending", "Pa", "end-to-end slope of the descending branch"),
    Quantity(
        "stroke_mean_modulus_difference",
        "Pa",
        "ascending minus descending stroke-mean tangent modulus",
    ),
    Quantity(
        "tension_loss_modulus", "Pa", "tension lost over the cycle, over area and strain stroke"
    ),
    Quantity(
        "identity_residual", "1", "closed-cycle identity residual over the stroke-mean modulus"
    ),
    Quantity(
        "mean_identity_residual",
        "1",
        "closed-cycle identity residual over the stroke-mean modulus, mean over the cycles",
    ),
    Quantity("dissipation_spring_constant", "N", "dissipation spring constant", "003 K1"),
    Quantity("relaxation_time", "s", "relaxation time of the three-parameter line", "003 tau"),
    Quantity("quasi_static_spring_constant", "N", "slope of the slow pull", "003 K0"),
    # mean over the cycles of a test after break-in
    Quantity("test_frequency", "Hz", "cycle frequency, mean over the test"),
    Quantity("test_mean_strain", "1", "mean strain of the cycles, mean over the test"),
    Quantity("test_strain_amplitude", "1", "strain amplitude, mean over the test"),
    Quantity("test_mean_tension", "N", "mean tension of the cycles, mean over the test"),
    Quantity("test_tension_amplitude", "N", "tension amplitude, mean over the test"),
    Quantity("test_apparent_spring_constant", "N", "apparent spring constant, mean over the test"),
    Quantity("test_dynamic_modulus", "Pa", "dynamic modulus, mean over the test"),
    Quantity("test_hysteresis_energy", "J m-1", "hysteresis energy of a cycle, mean over the test"),
    Quantity("test_storage_spring_constant", "N", "storage spring constant, mean over the test"),
    Quantity("test_loss_spring_constant", "N", "loss spring constant, mean over the test"),
    Quantity("test_loss_factor", "1", "loss factor, mean over the test"),
    Quantity(
        "test_slope_reading_spread",
        "1",
        "slope of the loop between tension extremes less that between strain extremes, over K_ap",
    ),
    # per strain bin
    Quantity("strain_bin", "1", "centre of the strain bin"),
    Quantity("strain_bin_bounds", "1", "edges of the strain bin"),
    Quantity("strain_window", "1", "width of the regression window of the tangent modulus"),
    Quantity("branch_name", "", "branch of the cycle"),
    Quantity("selected_cycle", "1", "number of a cycle whose curves are kept"),
    Quantity("first_loading_strain_bin", "1", "centre of the strain bin of the first loading"),
    Quantity(
        "first_loading_strain_bin_bounds", "1", "edges of the strain bin of the first loading"
    ),
    Quantity("branch_tension_first_loading", "N", "tension of the first loading in the bin"),
    Quantity("ratio_strain_bin", "1", "centre of the strain bin of the modulus ratio"),
    Quantity(
        "modulus_ratio",
        "1",
        "tangent modulus of one specimen, or of some cycles, over that of another",
    ),
    Quantity("modulus_ratio_low", "1", "lower end of the 95 % interval of the modulus ratio"),
    Quantity("modulus_ratio_high", "1", "upper end of the 95 % interval of the modulus ratio"),
    Quantity(
        "modulus_ratio_degrees_of_freedom",
        "1",
        "degrees of freedom of the random part of the modulus ratio",
    ),
    Quantity("modulus_ratio_is_different", "1", "whether the interval leaves out 1"),
    Quantity("ratio_numerator", "", "specimen or cycles above the line of the modulus ratio"),
    Quantity("ratio_denominator", "", "specimen below the line of the modulus ratio"),
    Quantity(
        "tangent_modulus",
        "Pa",
        "tangent modulus, trimmed branches, mean over the cycles",
        "002 eq 2",
    ),
    Quantity("tangent_modulus_untrimmed", "Pa", "tangent modulus, whole branches"),
    Quantity(
        "tangent_modulus_first_loading", "Pa", "tangent modulus of the first loading of the record"
    ),
    Quantity("tangent_modulus_by_cycle", "Pa", "tangent modulus of one cycle, trimmed branches"),
    Quantity("branch_tension", "N", "mean tension of the branch in the bin"),
    # segments
    Quantity("segment", "1", "number of the segment, from the lowest strain"),
    Quantity("segment_criterion", "", "how the number of segments was chosen"),
    Quantity("segment_modulus", "Pa", "slope of a piecewise-linear segment", "002 Tables 5, 6"),
    Quantity("segment_strain_low", "1", "lower strain end of the segment"),
    Quantity("segment_strain_high", "1", "upper strain end of the segment"),
    Quantity("segment_tension_low", "N", "tension at the lower end of the segment"),
    Quantity("segment_tension_high", "N", "tension at the upper end of the segment"),
    Quantity("segment_misfit", "N", "rms distance of the mean branch from the segment"),
    Quantity("strain_level", "1", "stated elongation"),
    Quantity("stress_at_strain", "Pa", "nominal stress of the first loading at an elongation"),
    # elastomer laws
    Quantity("elastomer_specimen", "", "specimen of the elastomer fit"),
    Quantity("elastomer_law", "", "hyperelastic law"),
    Quantity("elastomer_rms_stress", "Pa", "root mean square residual of the elastomer fit"),
    Quantity("elastomer_strain_low", "1", "lower end of the strain range of the fit"),
    Quantity("elastomer_strain_high", "1", "upper end of the strain range of the fit"),
    Quantity("elastomer_is_stable", "1", "whether the fitted law is stable over its range"),
    Quantity("elastomer_aicc", "1", "corrected Akaike criterion of the fit, lower is better"),
    Quantity("elastomer_parameter_fit", "1", "number of the fit that the parameter belongs to"),
    Quantity("elastomer_parameter_name", "", "name of the parameter of the law"),
    Quantity("elastomer_modulus", "Pa", "parameter of the law that is a modulus"),
    Quantity("elastomer_exponent", "1", "parameter of the law that is an exponent"),
)
