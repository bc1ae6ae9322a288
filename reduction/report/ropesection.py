"""The section of the programme of one rope: properties, levels, held pairs, creep."""

from __future__ import annotations

from collections.abc import Sequence

from reduction.report.figures.ropes import draw_creep, draw_held_pairs, draw_stiffness
from reduction.report.ropetables import (
    bedding_table,
    creep_table,
    level_table,
    pair_table,
    property_table,
    told_of,
)
from reduction.report.ropeview import RopeView
from reduction.report.section import Section, make_part, provenance_of
from reduction.report.summary import Tile


def make_rope_section(view: RopeView) -> Section:
    """Return the section of one rope; parts with nothing in them are left out."""
    parts = [
        make_part(
            "Change in length", draw_stiffness(view), [property_table(view)],
            refusals=told_of(view, known=False),
        ),
        make_part("Bedding-in", (), [bedding_table(view)]),
        make_part("Dynamic stiffness", (), [level_table(view)]),
        make_part("Static stiffness", draw_held_pairs(view), [pair_table(view)]),
        make_part("Creep", draw_creep(view), [creep_table(view)]),
    ]  # fmt: skip
    provenance, documents = provenance_of(view.data.attrs)
    return Section(
        key=view.key,
        title=f"Programme of rope {view.specimen}",
        subtitle=f"steps in order: {', '.join(test.id for test in view.tests)}",
        parts=tuple(part for part in parts if part.figures or part.tables),
        notes=(),
        provenance=provenance,
        documents=documents,
        noun="rope",
    )


def rope_tiles(views: Sequence[RopeView]) -> list[Tile]:
    """Return how many ropes have a programme."""
    if not views:
        return []
    noun = "rope with a programme" if len(views) == 1 else "ropes with a programme"
    return [Tile(f"{len(views):,}", noun, views[0].key)]
