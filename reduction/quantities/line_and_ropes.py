"""Quantities of the three-parameter line, of holds, and of rope programmes."""

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
        count("hold", "row of the table of holds, one per specimen"),
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
            "slope of the slow pull at the mean tension of the test, or chord of bent loops",
            shares_errors=True,
            tables=("line",),
            page=("line", "K_0, quasi-static spring constant"),
        ),
        measured(
            "test_dissipation_spring_constant",
            "N",
            "dissipation spring constant, from cycle means of the test",
            shares_errors=True,
            tables=("line",),
            page=("line", "K_1, dissipation spring constant"),
        ),
        measured(
            "test_relaxation_time",
            "s",
            "relaxation time, from cycle means of the test",
            shares_errors=True,
            tables=("line",),
            page=("line", "tau, relaxation time"),
        ),
        measured(
            "test_dashpot_coefficient",
            "N s",
            "dashpot coefficient, from cycle means of the test",
            shares_errors=True,
            tables=("line",),
            page=("line", "C = K_1 tau, dashpot coefficient"),
        ),
        stated(
            "test_line_conditioning",
            "1",
            "sensitivity of K_1 to K_0: relative change of E' - K_0 per relative "
            "change of K_0, K_0 / (E' - K_0)",
            "a sensitivity",
            tables=("line",),
        ),
        flag(
            "test_line_refusal", "why the test has no K_1 and tau", LINE_REFUSALS, tables=("line",)
        ),
        flag(
            "test_line_uncertainty_method",
            "method that propagated the uncertainty of K_1 and tau",
            LINE_METHODS,
            tables=("line",),
        ),
        stated(
            "test_line_without_solution_share",
            "1",
            "fraction of Monte Carlo draws without K_1 and tau",
            PART,
            tables=("line",),
        ),
        stated(
            "test_dissipation_spring_constant_low",
            "N",
            "lower limit of the 95 % interval of the test's dissipation spring constant",
            BOUND,
            tables=("line",),
        ),
        stated(
            "test_dissipation_spring_constant_high",
            "N",
            "upper limit of the 95 % interval of the test's dissipation spring constant",
            BOUND,
            tables=("line",),
        ),
        stated(
            "test_relaxation_time_low",
            "s",
            "lower limit of the 95 % interval of the test's relaxation time",
            BOUND,
            tables=("line",),
        ),
        stated(
            "test_relaxation_time_high",
            "s",
            "upper limit of the 95 % interval of the test's relaxation time",
            BOUND,
            tables=("line",),
        ),
        stated(
            "test_dashpot_coefficient_low",
            "N s",
            "lower limit of the 95 % interval of the test's dashpot coefficient",
            BOUND,
            tables=("line",),
        ),
        stated(
            "test_dashpot_coefficient_high",
            "N s",
            "upper limit of the 95 % interval of the test's dashpot coefficient",
            BOUND,
            tables=("line",),
        ),
        stated(
            "pull_tension_low",
            "N",
            "lower limit of the usable tension range of the slow pull",
            BOUND,
        ),
        stated(
            "pull_tension_high",
            "N",
            "upper limit of the usable tension range of the slow pull",
            BOUND,
        ),
        stated(
            "pull_strain_rate",
            "s-1",
            "mean strain rate of the slow pull",
            "machine setting as reached; not used in any result",
        ),
        stated(
            "pull_waiting_time", "s", "time between the last dynamic test and the slow pull", STATED
        ),
        label("pull_waiting", "time before the slow pull, as stated by the laboratory"),
        stated(
            "pull_residual",
            "1",
            "standard deviation of strain about the cubic load-strain fit",
            SPREAD,
        ),
        stated(
            "pull_reference_tension", "N", "tension at which the reference length was read", STATED
        ),
        group="line",
    ),
    *along(
        ("tension_grid",),
        stated("tension_grid", "N", "tension at which slow-pull values are given", AXIS),
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
            "strain of the slow pull, from the cubic fit",
            shares_errors=True,
            tables=("slow_pull",),
        ),
        group="line",
    ),
    *along(
        ("pull_term",),
        count("pull_term", "power of tension in the cubic load-strain fit"),
        group="line",
    ),
    *along(
        _PULL_TERM,
        measured(
            "pull_strain_coefficient",
            "1",
            "coefficient of the cubic load-strain fit, tension in newtons",
            shares_errors=True,
            tables=("slow_pull_cubic",),
            source="003 Tables 8, 9",
        ),
        stated(
            "pull_spring_constant_coefficient",
            "N",
            "coefficient of K_0 as a cubic in tension, tension in newtons",
            "derived from the cubic load-strain fit",
            tables=("slow_pull_cubic",),
            source="003 Tables 6, 7",
        ),
        group="line",
    ),
    *along(
        ("break_share",),
        stated("break_share", "1", "fraction of the rated break strength", SETTING),
        group="line",
    ),
    *along(
        ("specimen", "break_share"),
        measured(
            "strain_at_break_share",
            "1",
            "strain of the slow pull at a fraction of the break strength",
            shares_errors=True,
            tables=("strain_at_break_share",),
        ),
        group="line",
    ),
    *along(
        _HOLD,
        count(
            "hold_number",
            "number of the hold in the test, in time order, the same for all specimens",
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
            page=("holds", "start"),
        ),
        stated(
            "hold_duration",
            "s",
            "duration of the hold",
            CLOCK,
            tables=("relaxation", "creep"),
            page=("holds", "duration"),
        ),
        stated(
            "hold_ramp_centre_time",
            "s",
            "effective step time of the ramp, from which the rate per decade counts",
            CLOCK,
            tables=("relaxation", "creep"),
        ),
        stated(
            "hold_ramp_end_time",
            "s",
            "end of the ramp, interpolated between samples",
            CLOCK,
            tables=("relaxation", "creep"),
        ),
        stated(
            "hold_ramp_duration",
            "s",
            "duration of the equivalent constant-rate ramp",
            CLOCK,
            tables=("relaxation",),
        ),
        stated(
            "hold_logged_peak_tension",
            "N",
            "maximum logged tension near the end of the ramp",
            CHECK,
            tables=("relaxation",),
            page=("holds", "logged peak"),
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
            "mean strain during the hold",
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
            page=("holds", "tension at start"),
        ),
        measured(
            "hold_final_tension",
            "N",
            "tension at the end of the hold",
            shares_errors=True,
            tables=("relaxation", "creep"),
            page=("holds", "tension at end"),
        ),
        measured(
            "relaxation_drop",
            "1",
            "fraction of tension lost over the hold",
            shares_errors=True,
            tables=("relaxation",),
            page=("holds", "tension lost"),
            percent=True,
        ),
        measured(
            "relaxation_rate_per_decade",
            "1",
            "fraction of tension lost per decade of time",
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
            "long-time limit of the Prony series",
            shares_errors=True,
            tables=("relaxation",),
        ),
        label(
            "hold_criterion",
            "criterion that chose the number of Prony terms",
            tables=("relaxation",),
        ),
        label(
            "hold_refusal",
            "results of the hold that are not given, and why",
            tables=("relaxation",),
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
        stated(
            "prony_fraction_at_ramp_end",
            "1",
            "fraction of a Prony term left at the end of the ramp",
            CHECK,
            tables=("prony",),
        ),
        group="holds",
    ),
)

OF_PROGRAMME: tuple[Quantity, ...] = (
    *along(
        (),
        label("programme_step", "result type of the rope programme step"),
        group="programme",
    ),
    *along(
        _SPECIMEN,
        count("bedding_cycles", "number of bedding-in cycles", tables=("rope_programme",)),
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
            "apparent spring constant of the first cycle divided by the rated break strength",
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
            "apparent spring constant of the last cycle divided by the rated break strength",
            shares_errors=True,
            tables=("rope_programme",),
        ),
        measured(
            "bedding_stiffening",
            "1",
            "ratio of apparent spring constants, last to first cycle",
            shares_errors=True,
            tables=("rope_programme",),
        ),
        measured(
            "bedding_permanent_strain",
            "1",
            "shift in strain of the loop foot from the first to the last cycle, at "
            "the same tension",
            shares_errors=True,
            tables=("rope_programme",),
        ),
        count(
            "dynamic_cycles",
            "number of cycles averaged for the dynamic stiffness, the last ones of the step",
            tables=("rope_programme",),
        ),
        measured(
            "dynamic_frequency",
            "Hz",
            "cycle frequency at which the dynamic stiffness was measured",
            tables=("rope_programme",),
        ),
        measured(
            "dynamic_mean_tension",
            "N",
            "mean tension at which the dynamic stiffness was measured",
            shares_errors=True,
            tables=("rope_programme",),
        ),
        measured(
            "dynamic_mean_tension_over_strength",
            "1",
            "mean tension of the dynamic stiffness divided by the rated break strength",
            shares_errors=True,
            tables=("rope_programme",),
        ),
        measured(
            "dynamic_tension_amplitude",
            "N",
            "tension amplitude at which the dynamic stiffness was measured",
            shares_errors=True,
            tables=("rope_programme",),
        ),
        measured(
            "dynamic_tension_amplitude_over_strength",
            "1",
            "tension amplitude of the dynamic stiffness divided by the rated break strength",
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
            "dynamic stiffness divided by the rated break strength",
            shares_errors=True,
            tables=("rope_programme",),
        ),
        measured(
            "dynamic_stiffness_drift",
            "N",
            "change in dynamic stiffness per cycle, same cycles",
            shares_errors=True,
            tables=("rope_programme",),
        ),
        count(
            "cycles_to_failure",
            "cycles to failure, or to the end of the test",
            tables=("rope_programme",),
            source="003 Figure 19",
        ),
        flag(
            "cycles_are_run_out",
            "whether the specimen was still intact after these cycles",
            NO_YES,
            tables=("rope_programme",),
        ),
        stated(
            "failure_peak_tension",
            "N",
            "peak tension of a cycle, mean until failure",
            "mean over the cycles; each cycle has an uncertainty",
            tables=("rope_programme",),
        ),
        stated(
            "failure_peak_tension_over_strength",
            "1",
            "peak tension of a cycle, mean until failure, divided by the rated break strength",
            "mean over the cycles; each cycle has an uncertainty",
            tables=("rope_programme",),
        ),
        stated(
            "failure_valley_tension",
            "N",
            "minimum tension of a cycle, mean until failure",
            "mean over the cycles; each cycle has an uncertainty",
            tables=("rope_programme",),
        ),
        label(
            "failure_judged_by",
            "evidence for failure or survival",
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
            "peak tension of the pull",
            shares_errors=True,
            tables=("rope_programme", "tensile"),
        ),
        measured(
            "pull_peak_tension_over_strength",
            "1",
            "peak tension of the pull divided by the rated break strength",
            shares_errors=True,
            tables=("rope_programme", "tensile"),
        ),
        measured(
            "pull_peak_strain",
            "1",
            "strain at the peak tension of the pull",
            shares_errors=True,
            tables=("rope_programme", "tensile"),
        ),
        group="programme",
    ),
    *along(
        _PAIR,
        count("held_pair", "number of the pair of holds, one per specimen"),
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
            "time after loading to which static_stiffness refers",
            SETTING,
            tables=("static_stiffness",),
        ),
        measured(
            "static_stiffness",
            "N",
            "tension difference divided by strain difference between two holds, at "
            "the reference time",
            shares_errors=True,
            tables=("static_stiffness",),
        ),
        measured(
            "static_stiffness_over_strength",
            "1",
            "static stiffness divided by the rated break strength",
            shares_errors=True,
            tables=("static_stiffness",),
        ),
        measured(
            "static_stiffness_per_decade",
            "N",
            "change in static stiffness per decade of time",
            shares_errors=True,
            tables=("static_stiffness",),
        ),
        measured(
            "static_stiffness_per_decade_over_strength",
            "1",
            "change in static stiffness per decade of time, divided by the rated break strength",
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
        count("held_pair_point", "number of the point in stiffness against time"),
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
            "tension difference divided by strain difference between two holds, at that time",
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
            "held tension divided by the rated break strength",
            shares_errors=True,
            tables=("creep",),
        ),
        measured(
            "creep_compliance_per_decade",
            "1",
            "strain gained per decade of time, divided by the held tension relative to the rated"
            " break strength",
            shares_errors=True,
            tables=("creep",),
        ),
        group="programme",
    ),
)

OF_PROPERTIES: tuple[Quantity, ...] = (
    *along(
        _PROPERTY,
        count("property", "number of the change-in-length property in the campaign"),
        label("property_specimen", "rope to which the property belongs"),
        label(
            "property_name",
            "name of the change-in-length property",
            tables=("change_in_length",),
        ),
        label("property_test", "test or step that gave the property", tables=("change_in_length",)),
        stated(
            "property_low_tension",
            "N",
            "lower tension of the property; that of a hold",
            "as the step has it",
            tables=("change_in_length",),
        ),
        stated(
            "property_high_tension",
            "N",
            "upper tension of the property; that of a hold",
            "as the step has it",
            tables=("change_in_length",),
        ),
        stated(
            "property_reference_time",
            "s",
            "time after loading to which the property refers",
            SETTING,
            tables=("change_in_length",),
        ),
        measured(
            "property_stiffness",
            "N",
            "original, static or dynamic stiffness, force per unit strain",
            shares_errors=True,
            tables=("change_in_length",),
        ),
        measured(
            "property_stiffness_over_strength",
            "1",
            "original, static or dynamic stiffness divided by the rated break strength",
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
            "degrees of freedom of the random part; infinite if from many samples",
            COUNT,
        ),
        stated(
            "property_stiffness_over_strength_degrees_of_freedom",
            "1",
            "degrees of freedom of the random part; infinite if from many samples",
            COUNT,
        ),
        stated(
            "property_strain_degrees_of_freedom",
            "1",
            "degrees of freedom of the random part; infinite if from many samples",
            COUNT,
        ),
        label(
            "property_remark",
            "why the property is missing, or what it excludes",
            tables=("change_in_length",),
        ),
    ),
)
