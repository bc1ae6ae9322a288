"""Quantities without a log: outcomes (breaks, abrasion, lives), and weights hung by hand."""

from __future__ import annotations

from reduction.quantities.flags import (
    BRANCH_VALUES,
    NO_YES,
    OUTCOME_PLACES,
    OUTCOME_QUANTITIES,
    OUTCOME_USES,
    STEP_MASKS,
)
from reduction.quantities.line_and_ropes import OF_PROGRAMME
from reduction.quantities.row import (
    STATED,
    Quantity,
    again,
    along,
    count,
    flag,
    label,
    mask,
    measured,
    stated,
)
from reduction.quantities.samples_and_cycles import OF_RECORD

_OUTCOME = ("outcome",)

_PROGRAMME = {row.name: row for row in OF_PROGRAMME}


OF_OUTCOMES: tuple[Quantity, ...] = (
    *along(
        _OUTCOME,
        count("outcome_row", "line number in the table of results (the header is line 1)"),
        flag("outcome_quantity", "quantity of the outcome", OUTCOME_QUANTITIES),
        again(_PROGRAMME["tensile_strength"], STATED, qualified_by=("outcome_use",)),
        again(_PROGRAMME["strain_at_failure"], STATED, qualified_by=("outcome_use",)),
        again(_PROGRAMME["cycles_to_failure"], STATED, dtype="f8", qualified_by=("outcome_use",)),
        stated(
            "abrasion_cycles",
            "1",
            "abrasion cycles to failure, or to the end of the test",
            STATED,
            qualified_by=("outcome_use",),
            source="003 Table 20",
        ),
        flag(
            "outcome_use",
            "how the value is used: as a value, as a lower bound, or excluded",
            OUTCOME_USES,
        ),
        label("outcome_test", "test or break that gave the outcome"),
        label("outcome_specimen", "specimen of the outcome"),
        label("outcome_line", "line, as named by the laboratory"),
        label("outcome_material", "material of the line"),
        label("outcome_construction", "construction of the line"),
        label("outcome_condition", "condition of the line"),
        label("outcome_mode", "failure mode, as stated by the laboratory"),
        label("outcome_note", "note by the laboratory"),
        stated("outcome_diameter", "m", "nominal diameter of the line", STATED),
        stated("outcome_exposure", "Julian_year", "time in the field", STATED),
        stated("outcome_minimum_load", "N", "minimum load of each cycle", STATED),
        stated("outcome_peak_load", "N", "peak load of each cycle", STATED),
        stated(
            "outcome_minimum_load_ratio",
            "1",
            "minimum load divided by the rated break strength",
            STATED,
        ),
        stated(
            "outcome_peak_load_ratio", "1", "peak load divided by the rated break strength", STATED
        ),
        flag("outcome_place", "location of the failure", OUTCOME_PLACES),
        flag("outcome_is_valid", "whether the laboratory accepts the value", NO_YES),
        flag("outcome_is_suspended", "whether the test was stopped before failure", NO_YES),
    ),
)

_INTERVAL = ("interval",)

_STEP = ("step",)

_RECORD = {row.name: row for row in OF_RECORD}


OF_STEPS: tuple[Quantity, ...] = (
    *along(
        _STEP,
        label("clock", "clock time of the reading, as printed", tables=("stepwise",)),
        measured(
            "gauge_length",
            "m",
            "distance between the gauge marks at the step",
            tables=("stepwise",),
            source="002 Table 4",
        ),
        stated(
            "eye_to_eye_length",
            "m",
            "eye-to-eye length",
            "a tape reading",
            tables=("stepwise",),
            source="002 Table 4",
        ),
        stated("printed_strain", "1", "strain as recorded", STATED, tables=("stepwise",)),
        mask("step_flag", "quality of the reading", STEP_MASKS, tables=("stepwise",)),
    ),
    measured("relaxed_gauge_length", "m", "gauge length at zero tension, after recovery"),
    *along(
        _INTERVAL,
        stated(
            "interval_strain",
            "1",
            "mid-point strain between two readings",
            "middle of two readings",
            tables=("stepwise_moduli",),
        ),
        measured(
            "interval_modulus",
            "Pa",
            "slope of stress against strain between two readings",
            shares_errors=True,
            tables=("stepwise_moduli",),
        ),
        flag(
            "interval_branch",
            "branch between two readings",
            BRANCH_VALUES,
            tables=("stepwise_moduli",),
        ),
    ),
)

IN_PLACE_OF_RECORD: tuple[Quantity, ...] = (
    *along(
        _STEP,
        again(_RECORD["time"], tables=("stepwise",)),
        again(_RECORD["tension"], tables=("stepwise",)),
        again(_RECORD["strain"], qualified_by=("step_flag",), tables=("stepwise",)),
        again(_RECORD["branch"], tables=("stepwise",)),
        again(_RECORD["secant_modulus"], shares_errors=True, tables=("stepwise",)),
    ),
)
