"""The section of one predicted hose: its curve, its cords, how it is made, what to doubt."""

from __future__ import annotations

from collections.abc import Sequence

from reduction.notes import Severity
from reduction.report.figures.hosechart import draw_chart, draw_limits
from reduction.report.figures.hoses import draw_budget, draw_pressure, draw_tension
from reduction.report.hoseview import HoseView
from reduction.report.htmltable import number_text
from reduction.report.predictiontables import (
    cord_table,
    hose_curve_table,
    hose_design_table,
    hose_event_table,
    layer_table,
)
from reduction.report.section import Section, make_part, provenance_of
from reduction.report.style import DEGREES, shown
from reduction.report.summary import Finding, Tile
from reduction.report.summary import Severity as FindingSeverity

_FINDING: dict[Severity, FindingSeverity] = {
    "doubt": "warning", "refusal": "refusal", "note": "note", "method": "note",
}  # fmt: skip
_HOLDS = (
    "Predicted from the construction alone: no hose was pulled for it. It holds for a slow pull of"
    " a long, straight, closed hose full of water, on the static curve of one cord; not in"
    " compression, where a hose buckles, not over cycles or at speed, where cords and rubber are"
    " stiffer, and not at the ends, which in a real hose often give way first."
)


def make_hose_section(view: HoseView) -> Section:
    """Return the section of one hose; parts with nothing in them are left out."""
    parts = [
        make_part(
            "Tension and fill pressure",
            [*draw_tension(view), *draw_pressure(view), *draw_budget(view)],
            [hose_event_table(view)], [_story(view), _HOLDS],
            folded=make_part("The curve as numbers", (), [hose_curve_table(view)]),
            warnings=[text for text, kind in view.notes.items() if kind == "doubt"],
        ),
        make_part("Strain of the cords", [*draw_chart(view), *draw_limits(view)]),
        make_part("Layers that carry no load", (), [layer_table(view)]),
        make_part("Construction", (), [hose_design_table(view), cord_table(view)]),
    ]  # fmt: skip
    notes = list(view.notes)
    provenance, documents = provenance_of(view.data.attrs)
    return Section(
        key=view.key,
        title=f"Predicted hose {view.name}",
        subtitle=(
            f"wrap angle {DEGREES.factor * view.wrap_angle:.4g} deg from the axis;"
            f" {view.scalar('number_of_cords'):.0f} cords in two layers;"
            f" {view.text('rubber_law')} rubber"
        ),
        parts=tuple(part for part in parts if part.figures or part.tables or part.sentences),
        notes=(("What a reader of the numbers has to know", notes),) if notes else (),
        provenance=provenance,
        documents=documents,
        noun="hose",
    )


def hose_findings(view: HoseView) -> list[Finding]:
    """Return what a reader must know of a hose before its numbers."""
    return [
        Finding(_FINDING[kind], (f"hose {view.name}",), text) for text, kind in view.notes.items()
    ]


def hose_tiles(views: Sequence[HoseView]) -> list[Tile]:
    """Return how many hoses are predicted; of one alone what it bears, too."""
    if not views:
        return []
    noun = "predicted hose" if len(views) == 1 else "predicted hoses"
    found = [Tile(f"{len(views):,}", noun, views[0].key)]
    if len(views) == 1:
        force = shown("tension", views[0].units)
        load = number_text(force.factor * views[0].events["working"].tension)
        found.append(Tile(f"{load} {force.unit}", "safe working load", views[0].key))
    return found


def _story(view: HoseView) -> str:
    """Return the events as a sentence."""
    force = shown("tension", view.units)
    events = view.events

    def at(name: str) -> str:
        load = number_text(force.factor * events[name].tension, 3)
        return f"{100 * events[name].strain:.1f}\N{NO-BREAK SPACE}% ({load} {force.unit})"

    start = (
        f"The rubber alone carries up to {at('pick_up')}, where the cords pick up; before, they are"
        f" slack by up to {-100 * events['deepest_slack'].cord_strain:.1f} % of their length."
        if view.is_slack_at_first
        else "The cords carry from the first: there is no slack zone at this angle."
    )
    return (
        f"{start} The working load is reached at {at('working')}; the cords break at"
        f" {at('cord_break')}."
    )
