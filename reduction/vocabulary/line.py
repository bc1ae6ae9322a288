"""Quantities of line: the three-parameter model, slow pulls, rope programmes."""

from __future__ import annotations

from reduction.vocabulary.row import Quantity

OF_LINE = (
    # the three-parameter line, of each cycle and from the means over the cycles of a test
    Quantity("dashpot_coefficient", "N s", "dashpot coefficient, K_1 times tau", "003 N"),
    Quantity("line_refusal", "1", "why a cycle has no K_1 and tau"),
    Quantity(
        "test_quasi_static_spring_constant",
        "N",
        "slope of the slow pull at the mean tension of the test",
    ),
    Quantity(
        "test_dissipation_spring_constant",
        "N",
        "dissipation spring constant from the means over the cycles of the test",
    ),
    Quantity(
        "test_relaxation_time", "s", "relaxation time from the means over the cycles of the test"
    ),
    Quantity(
        "test_dashpot_coefficient",
        "N s",
        "dashpot coefficient from the means over the cycles of the test",
    ),
    Quantity(
        "test_line_conditioning",
        "1",
        "relative error of K_1's excess over K_0 for a relative error of K_0: K_0 / (E' - K_0)",
    ),
    Quantity("test_line_refusal", "1", "why the test has no K_1 and tau"),
    Quantity(
        "test_dissipation_spring_constant_low",
        "N",
        "lower end of the 95 % interval of the dissipation spring constant of the test",
    ),
    Quantity(
        "test_dissipation_spring_constant_high",
        "N",
        "upper end of the 95 % interval of the dissipation spring constant of the test",
    ),
    Quantity(
        "test_relaxation_time_low",
        "s",
        "lower end of the 95 % interval of the relaxation time of the test",
    ),
    Quantity(
        "test_relaxation_time_high",
        "s",
        "upper end of the 95 % interval of the relaxation time of the test",
    ),
    Quantity(
        "test_dashpot_coefficient_low",
        "N s",
        "lower end of the 95 % interval of the dashpot coefficient of the test",
    ),
    Quantity(
        "test_dashpot_coefficient_high",
        "N s",
        "upper end of the 95 % interval of the dashpot coefficient of the test",
    ),
    Quantity(
        "test_line_uncertainty_method", "1", "how the uncertainty of K_1 and tau was propagated"
    ),
    Quantity(
        "test_line_without_solution_share",
        "1",
        "share of Monte Carlo draws of loop and slow pull that have no K_1 and tau",
    ),
    # the slow pull
    Quantity("tension_grid", "N", "tension at which the slow pull is given"),
    Quantity("quasi_static_strain", "1", "strain of the slow pull, by the cubic"),
    Quantity("pull_term", "1", "power of tension in the load-strain cubic"),
    Quantity(
        "pull_strain_coefficient",
        "1",
        "coefficient of the load-strain cubic, tension as a number of newtons",
        "003 Tables 8, 9",
    ),
    Quantity(
        "pull_spring_constant_coefficient",
        "N",
        "coefficient of K_0 as a cubic of tension as a number of newtons",
        "003 Tables 6, 7",
    ),
    Quantity("pull_tension_low", "N", "lower end of the range of use of the slow pull"),
    Quantity("pull_tension_high", "N", "upper end of the range of use of the slow pull"),
    Quantity("pull_strain_rate", "s-1", "mean strain rate of the slow pull"),
    Quantity("pull_waiting_time", "s", "time between the last dynamic test and the slow pull"),
    Quantity("pull_waiting", "", "time before the slow pull in the laboratory's words"),
    Quantity("pull_residual", "1", "standard deviation of strain about the load-strain cubic"),
    Quantity("pull_reference_tension", "N", "tension at which the reference length was read"),
    Quantity("break_share", "1", "share of the rated break strength"),
    Quantity(
        "strain_at_break_share", "1", "strain of the slow pull at a share of the break strength"
    ),
    # steps of a rope laboratory's programme; over the strength: over the rated break strength
    Quantity("programme_step", "", "what the step of a rope programme gives"),
    Quantity("bedding_cycles", "1", "cycles of the bedding-in"),
    Quantity("bedding_first_stiffness", "N", "apparent spring constant of the first cycle"),
    Quantity("bedding_last_stiffness", "N", "apparent spring constant of the last cycle"),
    Quantity(
        "bedding_first_stiffness_over_strength",
        "1",
        "apparent spring constant of the first cycle over the rated break strength",
    ),
    Quantity(
        "bedding_last_stiffness_over_strength",
        "1",
        "apparent spring constant of the last cycle over the rated break strength",
    ),
    Quantity("bedding_stiffening", "1", "last over first apparent spring constant"),
    Quantity(
        "bedding_permanent_strain",
        "1",
        "strain by which the foot of the loop moved from the first to the last cycle, at one "
        "tension",
    ),
    Quantity("dynamic_cycles", "1", "cycles in the dynamic stiffness, the last ones of the step"),
    Quantity(
        "dynamic_stiffness",
        "N",
        "apparent spring constant, mean over the last cycles of the step",
    ),
    Quantity(
        "dynamic_stiffness_over_strength", "1", "dynamic stiffness over the rated break strength"
    ),
    Quantity(
        "dynamic_stiffness_drift", "N", "change of the dynamic stiffness a cycle, same cycles"
    ),
    Quantity("dynamic_frequency", "Hz", "cycle frequency of the dynamic stiffness"),
    Quantity("dynamic_mean_tension", "N", "mean tension of the dynamic stiffness"),
    Quantity("dynamic_tension_amplitude", "N", "tension amplitude of the dynamic stiffness"),
    Quantity(
        "dynamic_mean_tension_over_strength",
        "1",
        "mean tension of the dynamic stiffness over the rated break strength",
    ),
    Quantity(
        "dynamic_tension_amplitude_over_strength",
        "1",
        "tension amplitude of the dynamic stiffness over the rated break strength",
    ),
    Quantity("held_pair", "1", "number of a pair of holds, each specimen counted"),
    Quantity("held_pair_specimen", "", "specimen of the pair of holds"),
    Quantity("held_pair_low_hold", "1", "number of the lower hold in the test"),
    Quantity("held_pair_high_hold", "1", "number of the higher hold in the test"),
    Quantity("held_pair_low_tension", "N", "tension at the end of the lower hold"),
    Quantity("held_pair_high_tension", "N", "tension at the end of the higher hold"),
    Quantity("held_pair_point", "1", "number of a point of stiffness against time"),
    Quantity("static_reference_time", "s", "time after loading at which static_stiffness stands"),
    Quantity(
        "static_stiffness",
        "N",
        "force over strain between the two holds at the reference time, by the line",
    ),
    Quantity(
        "static_stiffness_over_strength", "1", "static stiffness over the rated break strength"
    ),
    Quantity(
        "static_stiffness_per_decade", "N", "change of the static stiffness in a tenfold time"
    ),
    Quantity(
        "static_stiffness_per_decade_over_strength",
        "1",
        "change of the static stiffness in a tenfold time over the rated break strength",
    ),
    Quantity("static_refusal", "", "why the pair of holds gives no static stiffness"),
    Quantity("static_elapsed_time", "s", "time since the centre of the ramp to the higher hold"),
    Quantity(
        "static_stiffness_at_time", "N", "force over strain between the two holds at that time"
    ),
    Quantity("creep_tension_over_strength", "1", "held tension over the rated break strength"),
    Quantity(
        "creep_compliance_per_decade",
        "1",
        "strain gained per decade of time, over the held tension as a share of the rated break "
        "strength",
    ),
    # change-in-length properties of a rope, over the steps of its programme
    Quantity("property", "1", "number of a change-in-length property, in the campaign"),
    Quantity("property_specimen", "", "rope that has the property"),
    Quantity("property_name", "", "which of the six change-in-length properties"),
    Quantity("property_test", "", "test or step that the property is from"),
    Quantity("property_low_tension", "N", "tension from which the property is; that of a hold"),
    Quantity("property_high_tension", "N", "tension up to which the property is; that of a hold"),
    Quantity(
        "property_reference_time", "s", "time after loading at, or from, which the property counts"
    ),
    Quantity("property_stiffness", "N", "force over strain: original, static, dynamic stiffness"),
    Quantity(
        "property_stiffness_over_strength",
        "1",
        "original, static or dynamic stiffness over the rated break strength",
    ),
    Quantity("property_strain", "1", "construction, polymer or working strain"),
    *(
        Quantity(
            f"property_{name}_degrees_of_freedom",
            "1",
            "degrees of freedom of the random part; infinite where it is of many samples",
        )
        for name in ("stiffness", "stiffness_over_strength", "strain")
    ),
    Quantity("property_remark", "", "why the property has no number, or what is not in it"),
    Quantity("cycles_are_run_out", "1", "whether the specimen had not failed after the cycles"),
    Quantity("failure_peak_tension", "N", "greatest tension of a cycle, mean until failure"),
    Quantity("failure_valley_tension", "N", "least tension of a cycle, mean until failure"),
    Quantity(
        "failure_peak_tension_over_strength",
        "1",
        "greatest tension of a cycle, mean until failure, over the rated break strength",
    ),
    Quantity("failure_judged_by", "", "what says that the specimen failed or not"),
    Quantity("pull_is_break", "1", "whether the specimen broke in the pull"),
    Quantity("pull_peak_tension", "N", "greatest tension of the pull"),
    Quantity(
        "pull_peak_tension_over_strength",
        "1",
        "greatest tension of the pull over the rated break strength",
    ),
    Quantity("pull_peak_strain", "1", "strain at the greatest tension of the pull"),
    Quantity("peak_tension_per_decade", "N", "change of peak tension per decade of cycles"),
    Quantity("dynamic_modulus_per_decade", "Pa", "change of dynamic modulus per decade of cycles"),
    Quantity(
        "peak_tension_change",
        "1",
        "mean peak tension of the last tenth of the cycles over the first, minus 1",
    ),
)
