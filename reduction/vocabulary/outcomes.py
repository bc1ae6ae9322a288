"""Quantities of outcomes without a log, and columns that tables alone have."""

from __future__ import annotations

from reduction.vocabulary.row import Quantity

OF_OUTCOMES = (
    # outcomes without a log, one row each
    Quantity("outcome_row", "1", "line of the table of results, its header being 1"),
    Quantity("outcome_quantity", "1", "what the outcome is a value of"),
    Quantity("tensile_strength", "N", "tensile strength", "003 Tables 10, 21"),
    Quantity("strain_at_failure", "1", "strain at failure", "003 Table 21"),
    Quantity("cycles_to_failure", "1", "cycles to failure, or to the end", "003 Figure 19"),
    Quantity(
        "abrasion_cycles", "1", "cycles of abrasion to failure, or to the end", "003 Table 20"
    ),
    Quantity("outcome_use", "1", "what the value says of the line: itself, at least this, nothing"),
    Quantity("outcome_test", "", "test or break that gave the outcome"),
    Quantity("outcome_specimen", "", "specimen of the outcome"),
    Quantity("outcome_line", "", "line, in the laboratory's words"),
    Quantity("outcome_material", "", "material of the line"),
    Quantity("outcome_construction", "", "how the line is built"),
    Quantity("outcome_condition", "", "condition of the line"),
    Quantity("outcome_diameter", "m", "nominal diameter of the line"),
    Quantity("outcome_exposure", "Julian_year", "time of the line in the field"),
    Quantity("outcome_minimum_load", "N", "least load of each cycle"),
    Quantity("outcome_peak_load", "N", "greatest load of each cycle"),
    Quantity("outcome_minimum_load_ratio", "1", "least load over the rated break strength"),
    Quantity("outcome_peak_load_ratio", "1", "greatest load over the rated break strength"),
    Quantity("outcome_mode", "", "how it failed, in the laboratory's words"),
    Quantity("outcome_place", "1", "where it failed"),
    Quantity("outcome_is_valid", "1", "the laboratory's word on the value"),
    Quantity("outcome_is_suspended", "1", "whether the test was stopped before failure"),
    Quantity("outcome_note", "", "the laboratory's note"),
    # columns that tables have beside the variables of the archives
    Quantity("test", "", "test"),
    Quantity("synthetic", "", "whether the data are synthetic, not measured"),
    Quantity("n_cycles", "1", "number of whole cycles of the test"),
    Quantity("strain_bin_low", "1", "lower edge of the strain bin"),
    Quantity("strain_bin_high", "1", "upper edge of the strain bin"),
    Quantity("envelope_minimum", "Pa", "least tangent modulus of the tests of the campaign"),
    Quantity("envelope_minimum_test", "", "test with the least tangent modulus"),
    Quantity("envelope_maximum", "Pa", "greatest tangent modulus of the tests of the campaign"),
    Quantity("envelope_maximum_test", "", "test with the greatest tangent modulus"),
    Quantity("static_test", "", "stepwise test"),
    Quantity("static_specimen", "", "specimen of the stepwise test"),
    Quantity(
        "static_dynamic_ratio",
        "1",
        "static interval modulus over dynamic tangent modulus, at one strain and branch",
    ),
    Quantity("n_tests", "1", "number of tests with a tangent modulus at this strain"),
    Quantity("table", "", "file in which the column stands"),
    Quantity("column", "", "column"),
    Quantity("unit", "", "unit of the column, or of the response in a row"),
    Quantity("meaning", "", "what the column holds"),
    Quantity("no_uncertainty", "", "why the column has no standard uncertainty beside it"),
)
