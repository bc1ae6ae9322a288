"""Numbers that stand in tables, in a look-up or in the catalogue, and in no archive."""

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
    label("synthetic", "whether the data are synthetic, not measured"),
    # of reduced tests
    count("n_cycles", "number of whole cycles of the test"),
    *along(
        ("specimen", "cycle"),
        measured(
            "chord_modulus_ascending",
            "Pa",
            "end-to-end slope of the ascending branch",
            tables=("cycles",),
        ),
        measured(
            "chord_modulus_descending",
            "Pa",
            "end-to-end slope of the descending branch",
            tables=("cycles",),
        ),
    ),
    stated("strain_bin_low", "1", "lower edge of the strain bin", BOUND),
    stated("strain_bin_high", "1", "upper edge of the strain bin", BOUND),
    # over the tests of a campaign
    measured("envelope_minimum", "Pa", "least tangent modulus of the tests of the campaign"),
    label("envelope_minimum_test", "test with the least tangent modulus"),
    measured("envelope_maximum", "Pa", "greatest tangent modulus of the tests of the campaign"),
    label("envelope_maximum_test", "test with the greatest tangent modulus"),
    count("n_tests", "number of tests with a tangent modulus at this strain"),
    label("static_test", "stepwise test"),
    label("static_specimen", "specimen of the stepwise test"),
    measured(
        "static_dynamic_ratio",
        "1",
        "static interval modulus over dynamic tangent modulus, at one strain and branch",
    ),
    # of experiments, whose responses differ from row to row
    label("response", "response, or its transform"),
    label("unit", "unit of the column, or of the response in a row"),
    label("response_unit", "unit of the response itself, before any transform"),
    label("coefficient_engineering_unit", "unit of the coefficient in engineering units"),
    # of the list of columns
    label("table", "file in which the column stands"),
    label("column", "column"),
    label("meaning", "what the column holds"),
    label("no_uncertainty", "why the column has no standard uncertainty beside it"),
)

OF_LOOK_UP: tuple[Quantity, ...] = (
    measured("dynamic_modulus", "Pa", "apparent spring constant over area at zero tension"),
    measured("original_stiffness", "N", "chord of the first rise, to the peak of the first cycle"),
    stated("free_length", "m", "splice toe to splice toe", AXIS),
    stated("splice_strain", "1", "nominal strain of both splices together", AXIS),
)

OF_CATALOGUE: tuple[Quantity, ...] = (
    label("campaign", "campaign"),
    label("archive", "archive that the row is from, below the folder of the products"),
    label("test_kind", "kind of test, or which archive of a whole campaign"),
    label("control", "what the machine controlled"),
    label("waveform", "shape of the controlled wave"),
    label("medium", "what the specimen was tested in"),
    stated("least_strain", "1", "least strain of the samples and cycles kept of the test", BOUND),
    stated(
        "greatest_strain", "1", "greatest strain of the samples and cycles kept of the test", BOUND
    ),
    # rows that an archive numbers by their place alone
    count("anova_row", "row of the analysis of variance, from 1"),
    count("elastomer_fit", "fit of a law of rubber, from 1"),
    count("elastomer_parameter", "parameter of a law of rubber, from 1"),
    count("exposure_group", "group of specimens of one exposure, from 1"),
    count("interval", "interval between two steps, from 1"),
    count("loading", "loading to the break, from 1"),
    count("mark", "reading of the splice marks, from 1"),
    count("outcome", "outcome of a specimen, from 1"),
    count("reading", "reading of the diameter, from 1"),
    count("slip", "step of a splice, from 1"),
    count("standstill", "rest or hold of the crosshead, from 1"),
    count("step", "step of a stepwise test, from 1"),
    count("stretched_reading", "reading of the diameter when stretched, from 1"),
)
