"""Axes that every archive may have: errors that numbers share, and notes."""

from __future__ import annotations

from reduction.quantities.row import (
    COMPONENT,
    OF_UNCERTAINTY,
    Quantity,
    along,
    count,
    label,
    stated,
)

_NOTE = ("note",)

_SHARED_ERROR = (COMPONENT,)


AXES: tuple[Quantity, ...] = (
    *along(
        _SHARED_ERROR,
        count("uncertainty_component", "number of an error that the test shares"),
        label("uncertainty_source", "number of the design that is uncertain"),
        label("uncertainty_source_of", "instrument, specimen or model that the error is of"),
        count("uncertainty_source_number", "place among independent errors of one source"),
        stated(
            "uncertainty_source_degrees_of_freedom",
            "1",
            "degrees of freedom of the standard uncertainty of a shared error; infinite where "
            "stated",
            OF_UNCERTAINTY,
        ),
        group="uncertainty",
    ),
    *along(
        _NOTE,
        label("note", "quality note"),
        label("note_stage", "stage that gave the note", tables=("notes", "experiment_notes")),
        label(
            "note_code",
            "what the note is of, the same in every version",
            tables=("notes", "experiment_notes"),
        ),
        label(
            "note_severity",
            "warning, refusal or note: how serious the note is",
            tables=("notes", "experiment_notes"),
        ),
        stated(
            "note_effect",
            "1",
            "by what share the answer would move, where that is known",
            "size of a possible error",
            tables=("notes", "experiment_notes"),
        ),
        group="notes",
    ),
)
