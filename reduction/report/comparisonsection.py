"""The section of one comparison: curves, error, cycles, energy, calibration, what to doubt."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reduction.notes import Severity
from reduction.report.comparisonview import ComparisonView
from reduction.report.figures.comparisons import draw_comparison, draw_cycle_bias, draw_error
from reduction.report.predictiontables import (
    calibration_table,
    compared_curve_table,
    compared_event_table,
    correlation_table,
    energy_table,
)
from reduction.report.section import Section, make_part, provenance_of
from reduction.report.summary import Finding, Tile
from reduction.report.summary import Severity as FindingSeverity

_FINDING: dict[Severity, FindingSeverity] = {
    "doubt": "warning", "refusal": "refusal", "note": "note", "method": "note",
}  # fmt: skip
_TAKE_NONE = ". The fitted values are one choice of many, and their intervals do not hold"


def make_comparison_section(view: ComparisonView) -> Section:
    """Return the section of one comparison; parts with nothing in them are left out."""
    parts = [
        make_part(
            "Measured and predicted tension", draw_comparison(view),
            [compared_curve_table(view), compared_event_table(view)], [f"Verdict: {view.verdict}."],
            warnings=[text for text, kind in _other_notes(view).items() if kind == "doubt"],
        ),
        make_part("Comparison error", draw_error(view), (), [_shape(view)]),
        make_part("Cycle by cycle", draw_cycle_bias(view)),
        make_part("Energy", (), [energy_table(view)]),
        make_part(
            "Calibration", (), [calibration_table(view), correlation_table(view)],
            _identified(view) if view.is_identified else [],
            warnings=[] if view.is_identified else _identified(view),
        ),
    ]  # fmt: skip
    notes = list(view.notes)
    provenance, documents = provenance_of(view.data.attrs)
    return Section(
        key=view.key,
        title=f"Comparison {view.name}",
        subtitle=(
            f"test {view.test} ({view.loading}), specimen {view.specimen}, against hose {view.hose}"
        ),
        parts=tuple(part for part in parts if part.figures or part.tables),
        notes=(("What a reader of the numbers has to know", notes),) if notes else (),
        provenance=provenance,
        documents=documents,
        noun="comparison",
    )


def comparison_findings(view: ComparisonView) -> list[Finding]:
    """Return what a reader must know of a comparison before its numbers."""
    of = (f"comparison {view.name}",)
    found = []
    if view.short_verdict == "differs":
        found.append(Finding("warning", of, f"The prediction {view.verdict}."))
    elif view.short_verdict != "agrees":
        found.append(Finding("note", of, f"{view.verdict[:1].upper()}{view.verdict[1:]}."))
    if view.is_identified is False:
        found += [Finding("warning", of, sentence) for sentence in _identified(view)]
    return found + [Finding(_FINDING[kind], of, text) for text, kind in _other_notes(view).items()]


def comparison_tiles(views: Sequence[ComparisonView]) -> list[Tile]:
    """Return how many comparisons there are, and how many of them differ."""
    if not views:
        return []
    noun = "comparison" if len(views) == 1 else "comparisons"
    found = [Tile(f"{len(views):,}", noun, views[0].key)]
    differing = [view for view in views if view.short_verdict == "differs"]
    if differing:
        words = "differs" if len(differing) == 1 else "differ"
        found.append(Tile(f"{len(differing):,}", words, differing[0].key, is_bad=True))
    return found


def _other_notes(view: ComparisonView) -> dict[str, Severity]:
    """Notes but the one whose words stand beside the fitted numbers."""
    said = view.text("identifiability")
    return {text: kind for text, kind in view.notes.items() if not (said and said in text)}


def _shape(view: ComparisonView) -> str:
    """Say what chi square says, which sees a wrong shape inside the band."""
    probability = view.scalar("chi_square_probability")
    if not np.isfinite(probability):
        return "Nothing is stated of which a shape of the difference could be made."
    chance = "less than 0.01 %" if probability < 1e-4 else f"{100 * probability:.2g} %"
    return (
        f"Chi square over all strains together is {view.scalar('chi_square'):.4g} with"
        f" {view.scalar('chi_square_freedom'):.0f} degrees of freedom; the stated errors alone"
        f" reach that in {chance} of all cases. It sees a wrong shape inside the band, and is given"
        " beside the verdict."
    )


def _identified(view: ComparisonView) -> list[str]:
    """Say whether the curve tells the fitted numbers apart; nothing without a calibration."""
    if view.is_identified is None:
        return []
    needed = 100 * view.scalar("needed_change")
    if view.is_identified:
        return [
            "The curve tells these numbers apart: along the direction that it sees least, one"
            f" plausible error changes it by {100 * view.scalar('least_change'):.2g} %, where"
            f" {needed:.2g} % is needed."
        ]
    return [
        f"The curve does not tell the fitted numbers apart: {view.text('identifiability')}, where"
        f" {needed:.2g} % is needed{_TAKE_NONE}."
    ]
