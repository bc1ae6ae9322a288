"""Axes common to all archives: shared errors, and notes."""

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
        count("uncertainty_component", "number of the shared error"),
        label("uncertainty_source", "source of the uncertainty"),
        label("uncertainty_source_of", "instrument, specimen or model to which the error belongs"),
        count("uncertainty_source_number", "index among independent errors of one source"),
        stated(
            "uncertainty_source_degrees_of_freedom",
            "1",
            "degrees of freedom of the standard uncertainty of a shared error; infinite if stated",
            OF_UNCERTAINTY,
        ),
        group="uncertainty",
    ),
    *along(
        _NOTE,
        label("note", "quality note"),
        label(
            "note_stage",
            "processing stage that made the note",
            tables=("notes", "experiment_notes"),
        ),
        label(
            "note_code",
            "code of the note, the same in every version",
            tables=("notes", "experiment_notes"),
        ),
        label(
            "note_severity",
            "severity: warning, refusal or note",
            tables=("notes", "experiment_notes"),
        ),
        stated(
            "note_effect",
            "1",
            "relative change of the result that the note implies, if known",
            "magnitude of a possible error",
            tables=("notes", "experiment_notes"),
        ),
        group="notes",
    ),
)
