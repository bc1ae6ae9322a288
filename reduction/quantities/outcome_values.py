"""Numbers of outcomes without a log: breaks, abrasion, cycles to failure."""

from __future__ import annotations

from reduction.quantities.flags import NO_YES, OUTCOME_PLACES, OUTCOME_QUANTITIES, OUTCOME_USES
from reduction.quantities.line_and_ropes import OF_PROGRAMME
from reduction.quantities.row import STATED, Quantity, again, along, count, flag, label, stated

_OUTCOME = ("outcome",)

_PROGRAMME = {row.name: row for row in OF_PROGRAMME}


OF_OUTCOMES: tuple[Quantity, ...] = (
    *along(
        _OUTCOME,
        count("outcome_row", "line of the table of results, its header being 1"),
        flag("outcome_quantity", "what the outcome is a value of", OUTCOME_QUANTITIES),
        again(_PROGRAMME["tensile_strength"], STATED, qualified_by=("outcome_use",)),
        again(_PROGRAMME["strain_at_failure"], STATED, qualified_by=("outcome_use",)),
        again(_PROGRAMME["cycles_to_failure"], STATED, dtype="f8", qualified_by=("outcome_use",)),
        stated(
            "abrasion_cycles",
            "1",
            "cycles of abrasion to failure, or to the end",
            STATED,
            qualified_by=("outcome_use",),
            source="003 Table 20",
        ),
        flag(
            "outcome_use",
            "what the value says of the line: itself, at least this, nothing",
            OUTCOME_USES,
        ),
        label("outcome_test", "test or break that gave the outcome"),
        label("outcome_specimen", "specimen of the outcome"),
        label("outcome_line", "line, in the laboratory's words"),
        label("outcome_material", "material of the line"),
        label("outcome_construction", "how the line is built"),
        label("outcome_condition", "condition of the line"),
        label("outcome_mode", "how it failed, in the laboratory's words"),
        label("outcome_note", "the laboratory's note"),
        stated("outcome_diameter", "m", "nominal diameter of the line", STATED),
        stated("outcome_exposure", "Julian_year", "time of the line in the field", STATED),
        stated("outcome_minimum_load", "N", "least load of each cycle", STATED),
        stated("outcome_peak_load", "N", "greatest load of each cycle", STATED),
        stated(
            "outcome_minimum_load_ratio", "1", "least load over the rated break strength", STATED
        ),
        stated(
            "outcome_peak_load_ratio", "1", "greatest load over the rated break strength", STATED
        ),
        flag("outcome_place", "where it failed", OUTCOME_PLACES),
        flag("outcome_is_valid", "the laboratory's word on the value", NO_YES),
        flag("outcome_is_suspended", "whether the test was stopped before failure", NO_YES),
    ),
)
