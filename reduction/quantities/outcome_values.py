"""Quantities of outcomes without a log: breaks, abrasion, cycles to failure."""

from __future__ import annotations

from reduction.quantities.flags import NO_YES, OUTCOME_PLACES, OUTCOME_QUANTITIES, OUTCOME_USES
from reduction.quantities.line_and_ropes import OF_PROGRAMME
from reduction.quantities.row import STATED, Quantity, again, along, count, flag, label, stated

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
