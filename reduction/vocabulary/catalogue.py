"""Words of the catalogue: where a number stands, and in what test."""

from __future__ import annotations

from reduction.vocabulary.row import Quantity

OF_CATALOGUE = (
    Quantity("campaign", "", "campaign"),
    Quantity("archive", "", "archive that the row is from, below the folder of the products"),
    Quantity("test_kind", "", "kind of test, or which archive of a whole campaign"),
    Quantity("control", "", "what the machine controlled"),
    Quantity("waveform", "", "shape of the controlled wave"),
    Quantity("medium", "", "what the specimen was tested in"),
    Quantity("least_strain", "1", "least strain of the samples and cycles kept of the test"),
    Quantity("greatest_strain", "1", "greatest strain of the samples and cycles kept of the test"),
    # rows that an archive numbers by their place alone
    Quantity("anova_row", "1", "row of the analysis of variance, from 1"),
    Quantity("elastomer_fit", "1", "fit of a law of rubber, from 1"),
    Quantity("elastomer_parameter", "1", "parameter of a law of rubber, from 1"),
    Quantity("exposure_group", "1", "group of specimens of one exposure, from 1"),
    Quantity("interval", "1", "interval between two steps, from 1"),
    Quantity("loading", "1", "loading to the break, from 1"),
    Quantity("mark", "1", "reading of the splice marks, from 1"),
    Quantity("outcome", "1", "outcome of a specimen, from 1"),
    Quantity("reading", "1", "reading of the diameter, from 1"),
    Quantity("slip", "1", "step of a splice, from 1"),
    Quantity("standstill", "1", "rest or hold of the crosshead, from 1"),
    Quantity("step", "1", "step of a stepwise test, from 1"),
    Quantity("stretched_reading", "1", "reading of the diameter when stretched, from 1"),
)
