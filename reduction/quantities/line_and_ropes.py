"""Numbers of the three-parameter line, of holds, and of rope programmes."""

from __future__ import annotations

from reduction.quantities.flags import LINE_METHODS, LINE_REFUSALS, NO_YES
from reduction.quantities.row import (
    AXIS,
    BOUND,
    CHECK,
    CLOCK,
    COUNT,
    PART,
    SETTING,
    SPREAD,
    STATED,
    Quantity,
    along,
    count,
    flag,
    label,
    measured,
    stated,
)

_CYCLE = ("specimen", "cycle")

_HOLD = ("hold",)

_HOLD_TIME = ("hold", "hold_time")

_PAIR = ("held_pair",)

_PAIR_POINT = ("held_pair", "held_pair_point")

_PRONY = ("hold", "prony_term")

_PROPERTY = ("property",)

_PULL_TERM = ("specimen", "pull_term")

_SPECIMEN = ("specimen",)

_TENSION = ("specimen", "tension_grid")


OF_LINE: tuple[Quantity, ...] = (
    *along(
        _HOLD,
        count("hold", "row of the holds, each specimen counted"),
    ),
    *along(
        ("prony_term",),
        count("prony_term", "number of the Prony term"),
    ),
    *along(
        ("hold_time",),
        stated("hold_time", "s", "time after the end of the ramp", SETTING),
    ),
    *along(
        _CYCLE,
        measured(
            "dissipation_spring_constant",
            "N",
            "dissipation spring constant",
            tables=("cycles",),
            source="003 K1",
        ),
        measured(
            "relaxation_time",
            "s",
            "relaxation time of the three-parameter line",
            tables=("cycles",),
            source="003 tau",
        ),
        measured(
            "dashpot_coefficient",
            "N s",
            "dashpot coefficient, K_1 times tau",
            tables=("cycles",),
            source="003 N",
        ),
        flag("line_refusal", "why a cycle has no K_1 and tau", LINE_REFUSALS, tables=("cycles",)),
        group="line",
    ),
    *along(
        _SPECIMEN,
        measured(
            "test_quasi_static_spring_constant",
            "N",
            "slope of the slow pull at the mean tension of the test",
            shares_errors=True,
            tables=("line",),
            page=("line", "K_0, quasi-static spring constant"),
        ),
        measured(
            "test_dissipation_spring_constant",
            "N",
            "dissipation spring constant from the means over the cycles of the test",
            shares_errors=True,
            tables=("line",),
            page=("line", "K_1, dissipation spring constant"),
        ),
        measured(
            "test_relaxation_time",
            "s",
            "relaxation time from the means over the cycles of the test",
            shares_errors=True,
            tables=("line",),
            page=("line", "tau, relaxation time"),
        ),
        measured(
            "test_dashpot_coefficient",
            "N s",
            "dashpot coefficient from the means over the cycles of the test",
            shares_errors=True,
            tables=("line",),
            page=("line", "C = K_1 tau, dashpot coefficient"),
        ),
        stated(
            "test_line_conditioning",
            "1",
            "relative error of K_1's excess over K_0 for a relative error of K_0: K_0 / (E' - K_0)",
            "a sensitivity",
            tables=("line",),
        ),
        flag(
            "test_line_refusal", "why the test has no K_1 and tau", LINE_REFUSALS, tables=("line",)
        ),
        flag(
            "test_line_uncertainty_method",
            "how the uncertainty of K_1 and tau was propagated",
            LINE_METHODS,
            tables=("line",),
        ),
        stated(
            "test_line_without_solution_share",
            "1",
            "share of Monte Carlo draws of loop and slow pull that have no K_1 and tau",
            PART,
            tables=("line",),
        ),
        stated(
            "test_dissipation_spring_constant_low",
            "N",
            "lower end of the 95 % interval of the dissipation spring constant of the test",
            BOUND,
            tables=("line",),
        ),
        stated(
            "test_dissipation_spring_constant_high",
            "N",
            "upper end of the 95 % interval of the dissipation spring constant of the test",
            BOUND,
            tables=("line",),
        ),
        stated(
            "test_relaxation_time_low",
            "s",
            "lower end of the 95 % interval of the relaxation time of the test",
            BOUND,
            tables=("line",),
        ),
        stated(
            "test_relaxation_time_high",
            "s",
            "upper end of the 95 % interval of the relaxation time of the test",
            BOUND,
            tables=("line",),
        ),
        stated(
            "test_dashpot_coefficient_low",
            "N s",
            "lower end of the 95 % interval of the dashpot coefficient of the test",
            BOUND,
            tables=("line",),
        ),
        stated(
            "test_dashpot_coefficient_high",
            "N s",
            "upper end of the 95 % interval of the dashpot coefficient of the test",
            BOUND,
            tables=("line",),
        ),
        stated("pull_tension_low", "N", "lower end of the range of use of the slow pull", BOUND),
        stated("pull_tension_high", "N", "upper end of the range of use of the slow pull", BOUND),
        stated(
            "pull_strain_rate",
            "s-1",
            "mean strain rate of the slow pull",
            "what the machine did; no number is made from it",
        ),
        stated(
            "pull_waiting_time", "s", "time between the last dynamic test and the slow pull", STATED
        ),
        label("pull_waiting", "time before the slow pull in the laboratory's words"),
        stated(
            "pull_residual", "1", "standard deviation of strain about the load-strain cubic", SPREAD
        ),
        stated(
            "pull_reference_tension", "N", "tension at which the reference length was read", STATED
        ),
        group="line",
    ),
    *along(
        ("tension_grid",),
        stated("tension_grid", "N", "tension at which the slow pull is given", AXIS),
        group="line",
    ),
    *along(
        _TENSION,
        measured(
            "quasi_static_spring_constant",
            "N",
            "slope of the slow pull",
            shares_errors=True,
            tables=("slow_pull",),
            source="003 K0",
        ),
        measured(
            "quasi_static_strain",
            "1",
            "strain of the slow pull, by the cubic",
            shares_errors=True,
            tables=("slow_pull",),
        ),
        group="line",
    ),
    *along(
        ("pull_term",),
        count("pull_term", "power of tension in the load-strain cubic"),
        group="line",
    ),
    *along(
        _PULL_TERM,
        measured(
            "pull_strain_coefficient",
            "1",
            "coefficient of the load-strain cubic, tension as a number of newtons",
            shares_errors=True,
            tables=("slow_pull_cubic",),
            source="003 Tables 8, 9",
        ),
        stated(
            "pull_spring_constant_coefficient",
            "N",
            "coefficient of K_0 as a cubic of tension as a number of newtons",
            "a re-expression of the load-strain cubic",
            tables=("slow_pull_cubic",),
            source="003 Tables 6, 7",
        ),
        group="line",
    ),
    *along(
        ("break_share",),
        stated("break_share", "1", "share of the rated break strength", SETTING),
        group="line",
    ),
    *along(
        ("specimen", "break_share"),
        measured(
            "strain_at_break_share",
            "1",
            "strain of the slow pull at a share of the break strength",
            shares_errors=True,
            tables=("strain_at_break_share",),
        ),
        group="line",
    ),
    *along(
        _HOLD,
        count(
            "hold_number",
            "number of the hold in the test, by time, one for all specimens",
            tables=("relaxation", "creep"),
        ),
        label("hold_specimen", "specimen of the hold"),
        label("hold_kind", "relaxation or creep", tables=("relaxation",)),
        stated(
            "hold_start_time",
            "s",
            "elapsed time at the start of the hold",
            CLOCK,
            tables=("relaxation",),
            page=("holds", "starts at"),
        ),
        stated(
            "hold_duration",
            "s",
            "length of the hold",
            CLOCK,
            tables=("relaxation", "creep"),
            page=("holds", "lasts"),
        ),
        stated(
            "hold_ramp_centre_time",
            "s",
            "when the ramp to the hold acts as a step: zero of the time of its rate per decade",
            CLOCK,
            tables=("relaxation", "creep"),
        ),
        stated(
            "hold_ramp_end_time",
            "s",
            "when the ramp to the hold ends, between two samples",
            CLOCK,
            tables=("relaxation", "creep"),
        ),
        stated(
            "hold_ramp_duration",
            "s",
            "duration of the constant-rate ramp that stands for the one to the hold",
            CLOCK,
            tables=("relaxation",),
        ),
        stated(
            "hold_logged_peak_tension",
            "N",
            "greatest reading of tension beside the end of the ramp",
            CHECK,
            tables=("relaxation",),
            page=("holds", "peak of the log"),
        ),
        stated(
            "hold_ramp_end_tension",
            "N",
            "tension of the Prony series at the end of the ramp",
            CHECK,
            tables=("relaxation",),
            page=("holds", "Prony series at the end of the ramp"),
        ),
        measured(
            "hold_strain",
            "1",
            "mean strain in the hold",
            shares_errors=True,
            tables=("relaxation",),
            page=("holds", "strain"),
            percent=True,
        ),
        measured(
            "hold_initial_tension",
            "N",
            "tension at the start of the hold",
            shares_errors=True,
            tables=("relaxation", "creep"),
            page=("holds", "tension at its start"),
        ),
        measured(
            "hold_final_tension",
            "N",
            "tension at the end of the hold",
            shares_errors=True,
            tables=("relaxation", "creep"),
            page=("holds", "tension at its end"),
        ),
        measured(
            "relaxation_drop",
            "1",
            "share of tension lost over the hold",
            shares_errors=True,
            tables=("relaxation",),
            page=("holds", "tension lost"),
            percent=True,
        ),
        measured(
            "relaxation_rate_per_decade",
            "1",
            "share of tension lost per decade of time",
            shares_errors=True,
            tables=("relaxation",),
            page=("holds", "tension lost per decade of time"),
            percent=True,
        ),
        measured(
            "creep_rate_per_decade",
            "1",
            "strain gained per decade of time",
            shares_errors=True,
            tables=("relaxation", "creep"),
            page=("holds", "strain gained per decade of time"),
            percent=True,
        ),
        measured(
            "long_time_tension",
            "N",
            "tension the Prony series tends to",
            shares_errors=True,
            tables=("relaxation",),
        ),
        label("hold_criterion", "how the number of Prony terms was chosen", tables=("relaxation",)),
        label(
            "hold_refusal", "numbers of the hold that are refused, and why", tables=("relaxation",)
        ),
        group="holds",
    ),
    *along(
        _HOLD_TIME,
        measured(
            "tension_at_time",
            "N",
            "tension at a stated time after the ramp",
            shares_errors=True,
            tables=("relaxation_times",),
        ),
        measured(
            "strain_at_time",
            "1",
            "strain at a stated time after the ramp",
            shares_errors=True,
            tables=("relaxation_times",),
        ),
        group="holds",
    ),
    *along(
        _PRONY,
        measured(
            "prony_tension", "N", "tension of a Prony term", shares_errors=True, tables=("prony",)
        ),
        measured("prony_time", "s", "relaxation time of a Prony term", tables=("prony",)),
        group="holds",
    ),
)

OF_PROGRAMME: tuple[Quantity, ...] = (
    *along(
        (),
        label("programme_step", "what the step of a rope programme gives"),
        group="programme",
    ),
    *along(
        _SPECIMEN,
        count("bedding_cycles", "cycles of the bedding-in", tables=("rope_programme",)),
        measured(
            "bedding_first_stiffness",
            "N",
            "apparent spring constant of the first cycle",
            shares_errors=True,
            tables=("rope_programme",),
        ),
        measured(
            "bedding_first_stiffness_over_strength",
            "1",
            "apparent spring constant of the first cycle over the rated break strength",
            shares_errors=True,
            tables=("rope_programme",),
        ),
        measured(
            "bedding_last_stiffness",
            "N",
            "apparent spring constant of the last cycle",
            shares_errors=True,
            tables=("rope_programme",),
        ),
        measured(
            "bedding_last_stiffness_over_strength",
            "1",
            "apparent spring constant of the last cycle over the rated break strength",
            shares_errors=True,
            tables=("rope_programme",),
        ),
        measured(
            "bedding_stiffening",
            "1",
            "last over first apparent spring constant",
            shares_errors=True,
            tables=("rope_programme",),
        ),
        measured(
            "bedding_permanent_strain",
            "1",
            "strain by which the foot of the loop moved from the first to the last cycle, at "
            "one tension",
            shares_errors=True,
            tables=("rope_programme",),
        ),
        count(
            "dynamic_cycles",
            "cycles in the dynamic stiffness, the last ones of the step",
            tables=("rope_programme",),
        ),
        measured(
            "dynamic_frequency",
            "Hz",
            "cycle frequency of the dynamic stiffness",
            tables=("rope_programme",),
        ),
        measured(
            "dynamic_mean_tension",
            "N",
            "mean tension of the dynamic stiffness",
            shares_errors=True,
            tables=("rope_programme",),
        ),
        measured(
            "dynamic_mean_tension_over_strength",
            "1",
            "mean tension of the dynamic stiffness over the rated break strength",
            shares_errors=True,
            tables=("rope_programme",),
        ),
        measured(
            "dynamic_tension_amplitude",
            "N",
            "tension amplitude of the dynamic stiffness",
            shares_errors=True,
            tables=("rope_programme",),
        ),
        measured(
            "dynamic_tension_amplitude_over_strength",
            "1",
            "tension amplitude of the dynamic stiffness over the rated break strength",
            shares_errors=True,
            tables=("rope_programme",),
        ),
        measured(
            "dynamic_stiffness",
            "N",
            "apparent spring constant, mean over the last cycles of the step",
            shares_errors=True,
            tables=("rope_programme",),
        ),
        measured(
            "dynamic_stiffness_over_strength",
            "1",
            "dynamic stiffness over the rated break strength",
            shares_errors=True,
            tables=("rope_programme",),
        ),
        measured(
            "dynamic_stiffness_drift",
            "N",
            "change of the dynamic stiffness a cycle, same cycles",
            shares_errors=True,
            tables=("rope_programme",),
        ),
        count(
            "cycles_to_failure",
            "cycles to failure, or to the end",
            tables=("rope_programme",),
            source="003 Figure 19",
        ),
        flag(
            "cycles_are_run_out",
            "whether the specimen had not failed after the cycles",
            NO_YES,
            tables=("rope_programme",),
        ),
        stated(
            "failure_peak_tension",
            "N",
            "greatest tension of a cycle, mean until failure",
            "mean over the cycles; each cycle has an uncertainty",
            tables=("rope_programme",),
        ),
        stated(
            "failure_peak_tension_over_strength",
            "1",
            "greatest tension of a cycle, mean until failure, over the rated break strength",
            "mean over the cycles; each cycle has an uncertainty",
            tables=("rope_programme",),
        ),
        stated(
            "failure_valley_tension",
            "N",
            "least tension of a cycle, mean until failure",
            "mean over the cycles; each cycle has an uncertainty",
            tables=("rope_programme",),
        ),
        label(
            "failure_judged_by",
            "what says that the specimen failed or not",
            tables=("rope_programme",),
        ),
        measured(
            "tensile_strength",
            "N",
            "tensile strength",
            shares_errors=True,
            tables=("rope_programme", "tensile"),
            source="003 Tables 10, 21",
        ),
        measured(
            "strain_at_failure",
            "1",
            "strain at failure",
            shares_errors=True,
            tables=("rope_programme", "tensile"),
            source="003 Table 21",
        ),
        flag(
            "pull_is_break",
            "whether the specimen broke in the pull",
            NO_YES,
            tables=("rope_programme", "tensile"),
        ),
        measured(
            "pull_peak_tension",
            "N",
            "greatest tension of the pull",
            shares_errors=True,
            tables=("rope_programme", "tensile"),
        ),
        measured(
            "pull_peak_tension_over_strength",
            "1",
            "greatest tension of the pull over the rated break strength",
            shares_errors=True,
            tables=("rope_programme", "tensile"),
        ),
        measured(
            "pull_peak_strain",
            "1",
            "strain at the greatest tension of the pull",
            shares_errors=True,
            tables=("rope_programme", "tensile"),
        ),
        group="programme",
    ),
    *along(
        _PAIR,
        count("held_pair", "number of a pair of holds, each specimen counted"),
        label("held_pair_specimen", "specimen of the pair of holds"),
        count(
            "held_pair_low_hold",
            "number of the lower hold in the test",
            tables=("static_stiffness",),
        ),
        count(
            "held_pair_high_hold",
            "number of the higher hold in the test",
            tables=("static_stiffness",),
        ),
        measured(
            "held_pair_low_tension",
            "N",
            "tension at the end of the lower hold",
            shares_errors=True,
            tables=("static_stiffness",),
        ),
        measured(
            "held_pair_high_tension",
            "N",
            "tension at the end of the higher hold",
            shares_errors=True,
            tables=("static_stiffness",),
        ),
        stated(
            "static_reference_time",
            "s",
            "time after loading at which static_stiffness stands",
            SETTING,
            tables=("static_stiffness",),
        ),
        measured(
            "static_stiffness",
            "N",
            "force over strain between the two holds at the reference time, by the line",
            shares_errors=True,
            tables=("static_stiffness",),
        ),
        measured(
            "static_stiffness_over_strength",
            "1",
            "static stiffness over the rated break strength",
            shares_errors=True,
            tables=("static_stiffness",),
        ),
        measured(
            "static_stiffness_per_decade",
            "N",
            "change of the static stiffness in a tenfold time",
            shares_errors=True,
            tables=("static_stiffness",),
        ),
        measured(
            "static_stiffness_per_decade_over_strength",
            "1",
            "change of the static stiffness in a tenfold time over the rated break strength",
            shares_errors=True,
            tables=("static_stiffness",),
        ),
        label(
            "static_refusal",
            "why the pair of holds gives no static stiffness",
            tables=("static_stiffness",),
        ),
        group="programme",
    ),
    *along(
        ("held_pair_point",),
        count("held_pair_point", "number of a point of stiffness against time"),
        group="programme",
    ),
    *along(
        _PAIR_POINT,
        stated(
            "static_elapsed_time",
            "s",
            "time since the centre of the ramp to the higher hold",
            CLOCK,
            tables=("static_stiffness_times",),
        ),
        stated(
            "static_stiffness_at_time",
            "N",
            "force over strain between the two holds at that time",
            "mean of readings: static_stiffness has their scatter",
            tables=("static_stiffness_times",),
        ),
        group="programme",
    ),
    *along(
        _HOLD,
        measured(
            "creep_tension_over_strength",
            "1",
            "held tension over the rated break strength",
            shares_errors=True,
            tables=("creep",),
        ),
        measured(
            "creep_compliance_per_decade",
            "1",
            "strain gained per decade of time, over the held tension as a share of the rated "
            "break strength",
            shares_errors=True,
            tables=("creep",),
        ),
        group="programme",
    ),
)

OF_PROPERTIES: tuple[Quantity, ...] = (
    *along(
        _PROPERTY,
        count("property", "number of a change-in-length property, in the campaign"),
        label("property_specimen", "rope that has the property"),
        label(
            "property_name",
            "which of the six change-in-length properties",
            tables=("change_in_length",),
        ),
        label(
            "property_test", "test or step that the property is from", tables=("change_in_length",)
        ),
        stated(
            "property_low_tension",
            "N",
            "tension from which the property is; that of a hold",
            "as the step has it",
            tables=("change_in_length",),
        ),
        stated(
            "property_high_tension",
            "N",
            "tension up to which the property is; that of a hold",
            "as the step has it",
            tables=("change_in_length",),
        ),
        stated(
            "property_reference_time",
            "s",
            "time after loading at, or from, which the property counts",
            SETTING,
            tables=("change_in_length",),
        ),
        measured(
            "property_stiffness",
            "N",
            "force over strain: original, static, dynamic stiffness",
            shares_errors=True,
            tables=("change_in_length",),
        ),
        measured(
            "property_stiffness_over_strength",
            "1",
            "original, static or dynamic stiffness over the rated break strength",
            shares_errors=True,
            tables=("change_in_length",),
        ),
        measured(
            "property_strain",
            "1",
            "construction, polymer or working strain",
            shares_errors=True,
            tables=("change_in_length",),
        ),
        stated(
            "property_stiffness_degrees_of_freedom",
            "1",
            "degrees of freedom of the random part; infinite where it is of many samples",
            COUNT,
        ),
        stated(
            "property_stiffness_over_strength_degrees_of_freedom",
            "1",
            "degrees of freedom of the random part; infinite where it is of many samples",
            COUNT,
        ),
        stated(
            "property_strain_degrees_of_freedom",
            "1",
            "degrees of freedom of the random part; infinite where it is of many samples",
            COUNT,
        ),
        label(
            "property_remark",
            "why the property has no number, or what is not in it",
            tables=("change_in_length",),
        ),
    ),
)
