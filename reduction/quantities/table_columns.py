"""Quantities that are in tables, in a look-up or in the catalogue, but in no archive."""

from __future__ import annotations

from reduction.quantities.row import (
    AXIS,
    BOUND,
    Quantity,
    along,
    count,
    label,
    measured,
    stated,
)

OF_TABLES: tuple[Quantity, ...] = (
    label("test", "test"),
    label("synthetic", "whether the data are synthetic"),
    # columns for reduced tests
    count("n_cycles", "number of complete cycles in the test"),
    *along(
        ("specimen", "cycle"),
        measured(
            "chord_modulus_ascending",
            "Pa",
            "end-to-end secant slope of the ascending branch",
            tables=("cycles",),
        ),
        measured(
            "chord_modulus_descending",
            "Pa",
            "end-to-end secant slope of the descending branch",
            tables=("cycles",),
        ),
    ),
    stated("strain_bin_low", "1", "lower edge of the strain bin", BOUND),
    stated("strain_bin_high", "1", "upper edge of the strain bin", BOUND),
    # statistics over the tests of a campaign
    measured("envelope_minimum", "Pa", "lowest tangent modulus of all tests of the campaign"),
    label("envelope_minimum_test", "test with the lowest tangent modulus"),
    measured("envelope_maximum", "Pa", "highest tangent modulus of all tests of the campaign"),
    label("envelope_maximum_test", "test with the highest tangent modulus"),
    count("n_tests", "number of tests with a tangent modulus at this strain"),
    label("static_test", "stepwise test"),
    label("static_specimen", "specimen of the stepwise test"),
    measured(
        "static_dynamic_ratio",
        "1",
        "static interval modulus divided by dynamic tangent modulus, same strain and branch",
    ),
    # columns for experiments, whose responses differ from row to row
    label("response", "response, or its transform"),
    label("unit", "unit of the column, or of the response in a row"),
    label("response_unit", "unit of the response before any transform"),
    label("coefficient_engineering_unit", "unit of the coefficient in engineering units"),
    # columns of the list of columns
    label("table", "file that contains the column"),
    label("column", "column"),
    label("meaning", "contents of the column"),
    label("no_uncertainty", "reason why the column has no standard uncertainty"),
)

OF_LOOK_UP: tuple[Quantity, ...] = (
    measured(
        "dynamic_modulus", "Pa", "apparent spring constant divided by the area at zero tension"
    ),
    measured("original_stiffness", "N", "chord of the first rise, to the peak of the first cycle"),
    stated("free_length", "m", "splice toe to splice toe", AXIS),
    stated("splice_strain", "1", "nominal strain of both splices together", AXIS),
)

OF_CATALOGUE: tuple[Quantity, ...] = (
    label("campaign", "campaign"),
    label("archive", "archive of the row, relative to the folder of archives"),
    label("test_kind", "kind of test, or of campaign archive"),
    label("control", "control mode of the machine"),
    label("waveform", "waveform of the controlled channel"),
    label("medium", "test medium"),
    stated("least_strain", "1", "minimum strain of the stored samples and cycles", BOUND),
    stated("greatest_strain", "1", "maximum strain of the stored samples and cycles", BOUND),
    # rows numbered only by their position in an archive
    count("anova_row", "row of the analysis of variance, from 1"),
    count("elastomer_fit", "number of the hyperelastic fit, from 1"),
    count("elastomer_parameter", "number of the hyperelastic parameter, from 1"),
    count("exposure_group", "group of specimens with the same exposure, from 1"),
    count("interval", "interval between two steps, from 1"),
    count("loading", "loading to break, from 1"),
    count("mark", "splice mark reading, from 1"),
    count("outcome", "outcome of a specimen, from 1"),
    count("reading", "diameter reading, from 1"),
    count("slip", "slip step of a splice, from 1"),
    count("standstill", "rest or hold of the crosshead, from 1"),
    count("step", "step of a stepwise test, from 1"),
    count("stretched_reading", "diameter reading on the stretched specimen, from 1"),
)
