"""The section of outcomes without a log: strength, exposure, life, lines that go slack."""

from __future__ import annotations

from reduction.report.figures.outcomes import draw_exposure, draw_lives
from reduction.report.outcometables import (
    exposure_table,
    fatigue_table,
    load_life_table,
    snap_sentences,
    snap_table,
    strength_table,
)
from reduction.report.outcomeview import OutcomeView
from reduction.report.section import Section, make_part, provenance_of


def make_outcome_section(view: OutcomeView) -> Section:
    """Return the section; parts with nothing in them are left out."""
    parts = [
        make_part(
            "Strength", (),
            [strength_table(view, name) for name in ("tensile_strength", "strain_at_failure")],
        ),
        make_part("Strength against exposure", draw_exposure(view), [exposure_table(view)]),
        make_part(
            "Cycles to failure", draw_lives(view),
            [load_life_table(view), fatigue_table(view, "cycles_to_failure")],
        ),
        make_part(
            "Lines that go slack", (), [snap_table(view)], snap_sentences(view),
        ),
        make_part("Abrasion", (), [fatigue_table(view, "abrasion_cycles")]),
    ]  # fmt: skip
    provenance, documents = provenance_of(view.attributes)
    return Section(
        key="outcomes",
        title="Strength and life",
        subtitle=view.summary,
        parts=tuple(part for part in parts if part.figures or part.tables),
        notes=(),
        provenance=provenance,
        documents=documents,
    )
