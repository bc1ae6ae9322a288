"""Every note of every stage in one list, with the stage that gave it."""

from __future__ import annotations

from reduction.archive.values import Values, texts
from reduction.product import ReducedTest


def note_values(test: ReducedTest) -> Values:
    """Return the notes in the order of the stages, by stage and text."""
    pairs = test.all_notes()
    return {
        "note": texts([text for _, text in pairs]),
        "note_stage": texts([stage for stage, _ in pairs]),
    }
