"""Columns of the tables of strength, of exposure, of fatigue and of life against load.

References
----------
.. [1] CG-D-39-80, Tables 10, 20 and 21, Figure 19.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class OutcomeColumn:
    """A column: name, SI unit (empty for text, ``count`` for a whole number), meaning.

    ``no_uncertainty`` says why no standard uncertainty stands beside it; empty where
    one does.
    """

    name: str
    unit: str
    long_name: str
    no_uncertainty: str = ""


def _measured(name: str, unit: str, long_name: str) -> tuple[OutcomeColumn, OutcomeColumn]:
    return (
        OutcomeColumn(name, unit, long_name),
        OutcomeColumn(
            f"{name}_standard_uncertainty", unit, f"standard uncertainty of {long_name}",
            "is an uncertainty",
        ),
    )  # fmt: skip


_LINE = (
    OutcomeColumn("line", "", "line, in the laboratory's words", "is a label"),
    OutcomeColumn("material", "", "material", "is a label"),
    OutcomeColumn("construction", "", "construction", "is a label"),
    OutcomeColumn("diameter", "m", "nominal diameter", "is stated"),
)
_GROUP = (
    *_LINE,
    OutcomeColumn("condition", "", "condition of the line", "is a label"),
    OutcomeColumn("exposure", "year", "time in the field, in years of 365.25 days", "is stated"),
)


def _of_strength(name: str, unit: str, words: str) -> tuple[OutcomeColumn, ...]:
    return (
        *_measured(name, unit, f"mean {words} of the valid tests"),
        OutcomeColumn(f"{name}_standard_deviation", unit, f"deviation of {words}", "is a scatter"),
        OutcomeColumn(
            f"{name}_relative_variability", "1", f"deviation over mean of {words}", "is a scatter"
        ),
        OutcomeColumn(f"{name}_minimum", unit, f"least {words}", "is an extreme"),
        OutcomeColumn(f"{name}_maximum", unit, f"greatest {words}", "is an extreme"),
        OutcomeColumn(f"{name}_count", "count", f"valid tests of {words}", "is a count"),
        OutcomeColumn(
            f"{name}_lower_bound_count", "count", "tests in which the termination broke first, "
            "or that were stopped", "is a count",
        ),
        OutcomeColumn(f"{name}_excluded_count", "count", "other invalid tests", "is a count"),
        OutcomeColumn(
            f"{name}_lower_bound_mean", unit, f"mean {words} reached in those tests: a lower bound",
            "is a bound",
        ),
        OutcomeColumn(
            f"{name}_with_lower_bounds", unit, f"mean {words}, maximum likelihood with the lower "
            "bounds as such", "has an interval",
        ),
        OutcomeColumn(f"{name}_with_lower_bounds_low", unit, "lower end, 95 %", "is a bound"),
        OutcomeColumn(f"{name}_with_lower_bounds_high", unit, "upper end, 95 %", "is a bound"),
        *_measured(f"{name}_change", "1", f"change of {words} against the reference"),
        OutcomeColumn(f"{name}_change_low", "1", "lower end of the change, 95 %", "is a bound"),
        OutcomeColumn(f"{name}_change_high", "1", "upper end of the change, 95 %", "is a bound"),
        OutcomeColumn(
            f"{name}_f_statistic", "1", "one-way F against the reference", "is a statistic"
        ),
        OutcomeColumn(f"{name}_p_value", "1", "of that F", "is a statistic"),
        OutcomeColumn(f"{name}_reason", "", "why a number of it is missing", "is a word"),
    )  # fmt: skip


STRENGTH_COLUMNS: tuple[OutcomeColumn, ...] = (
    *_GROUP,
    OutcomeColumn("reference_condition", "", "condition of the reference group", "is a label"),
    *_of_strength("tensile_strength", "N", "tensile strength"),
    *_of_strength("strain_at_failure", "1", "strain at failure"),
)
"""Columns of ``tables/strength.csv``, one row a group."""

EXPOSURE_COLUMNS: tuple[OutcomeColumn, ...] = (
    *_LINE,
    *_measured("strength_when_new", "N", "tensile strength of the fitted line at no exposure"),
    *_measured("strength_slope", "N year-1", "change of tensile strength by time in the field"),
    OutcomeColumn(
        "share_lost_per_year", "year-1", "share of the strength at no exposure lost in a year",
        "has an interval",
    ),
    OutcomeColumn("share_lost_per_year_low", "year-1", "lower end, 95 %", "is a bound"),
    OutcomeColumn("share_lost_per_year_high", "year-1", "upper end, 95 %", "is a bound"),
    OutcomeColumn("strength_scatter", "N", "deviation of one break from the line", "is a scatter"),
    OutcomeColumn("degrees_of_freedom", "count", "of that deviation", "is a count"),
    OutcomeColumn("lack_of_fit_p_value", "1", "a line against means by exposure", "is a statistic"),
    OutcomeColumn("exposure_low", "year", "shortest exposure of the fit", "is a bound"),
    OutcomeColumn("exposure_high", "year", "longest exposure of the fit", "is a bound"),
    OutcomeColumn("break_count", "count", "breaks in the fit", "is a count"),
    OutcomeColumn("lower_bound_count", "count", "lower bounds, not in the fit", "is a count"),
    OutcomeColumn("unused_count", "count", "tests without an exposure or a value", "is a count"),
    OutcomeColumn("exposure_reason", "", "why there is no line", "is a word"),
)  # fmt: skip
"""Columns of ``tables/exposure.csv``, one row a line broken at several exposures."""

FATIGUE_COLUMNS: tuple[OutcomeColumn, ...] = (
    OutcomeColumn("quantity", "", "cycles_to_failure or abrasion_cycles", "is a label"),
    *_GROUP,
    OutcomeColumn("peak_load", "N", "peak load", "is a setting"),
    OutcomeColumn("peak_load_ratio", "1", "peak load over rated break strength", "is a setting"),
    OutcomeColumn("minimum_load_ratio", "1", "minimum load over that", "is a setting"),
    OutcomeColumn("failed_count", "count", "specimens that failed", "is a count"),
    OutcomeColumn(
        "suspended_count", "count", "run-outs, suspended tests and failures of the termination",
        "is a count",
    ),
    OutcomeColumn("excluded_count", "count", "other invalid tests", "is a count"),
    *_measured("mean_cycles", "1", "mean cycles of the failures alone"),
    OutcomeColumn("cycles_standard_deviation", "1", "deviation of those", "is a scatter"),
    OutcomeColumn("cycles_relative_variability", "1", "that over their mean", "is a scatter"),
    OutcomeColumn("least_cycles", "1", "shortest test", "is an extreme"),
    OutcomeColumn("most_cycles", "1", "longest test", "is an extreme"),
    *_measured("median_life", "1", "cycles by which half have failed, run-outs included"),
    OutcomeColumn("median_life_low", "1", "lower end, 95 %, profile likelihood", "is a bound"),
    OutcomeColumn("median_life_high", "1", "upper end, 95 %, profile likelihood", "is a bound"),
    *_measured("log_life_scale", "1", "scatter of ln cycles; one over the shape of a Weibull law"),
    OutcomeColumn("life_distribution", "", "law of the lives", "is a label"),
    OutcomeColumn("life_reason", "", "why there is no median life", "is a word"),
)  # fmt: skip
"""Columns of ``tables/fatigue.csv``, one row a group and level of peak load."""

LOAD_LIFE_COLUMNS: tuple[OutcomeColumn, ...] = (
    *_GROUP,
    OutcomeColumn(
        "reference_load_ratio", "1", "peak load over rated break strength at which the life stands",
        "is a setting",
    ),
    *_measured("life_at_reference", "1", "median life there"),
    *_measured("life_exponent", "1", "m of ln N = a - m ln S"),
    *_measured("log_life_scale", "1", "scatter of ln cycles about the line"),
    OutcomeColumn("lack_of_fit_p_value", "1", "a line against medians by level", "is a statistic"),
    OutcomeColumn("peak_load_ratio_low", "1", "least peak load tested", "is a bound"),
    OutcomeColumn("peak_load_ratio_high", "1", "greatest peak load tested", "is a bound"),
    OutcomeColumn("failed_count", "count", "specimens that failed", "is a count"),
    OutcomeColumn("suspended_count", "count", "run-outs and suspended tests", "is a count"),
    OutcomeColumn(
        "unused_count", "count", "tests without a peak load ratio, and invalid ones", "is a count"
    ),
    OutcomeColumn("life_distribution", "", "law of the lives", "is a label"),
    OutcomeColumn("life_reason", "", "why there is no line", "is a word"),
)  # fmt: skip
"""Columns of ``tables/load_life.csv``, one row a group tested at several loads."""
