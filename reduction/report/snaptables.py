"""Lines that go slack in their cycles: what each level of peak load did to them, and in words."""

from __future__ import annotations

from reduction.outcomes.life_product import SnapLevels
from reduction.outcomes.series import load_series
from reduction.outcomes.snap import summarise_snap_loading
from reduction.report.htmltable import (
    Table,
    count,
    make_table,
    number,
    words,
)
from reduction.report.outcomeview import OutcomeView, group_names
from reduction.report.style import Shown

__all__ = ["snap_sentences", "snap_table"]

_PERCENT = Shown("%", 100.0)
_SNAP = "Upper bound of the share that fails by then, where all survived; one-sided, 95 %."


def _snaps(view: OutcomeView) -> list[tuple[str, SnapLevels]]:
    """Levels of each group whose line goes slack in its cycles, with its name."""
    found = [one for one in load_series(view.outcomes) if (one.minimum_load_ratio <= 0).any()]
    names = group_names([one.group for one in found], view.units)
    return [
        (
            name,
            summarise_snap_loading(
                one.peak_load_ratio, one.minimum_load_ratio, one.cycles, one.is_suspended
            ),
        )
        for name, one in zip(names, found, strict=True)
    ]


def snap_table(view: OutcomeView) -> Table | None:
    """Return what each level of peak load did to lines that go slack."""
    rows = [
        [
            words(name),
            number(levels.peak_load_ratio[place], _PERCENT, digits=3),
            count(float(levels.n_failed[place])),
            count(float(levels.n_suspended[place])),
            number(levels.mean_cycles[place], digits=4),
            number(levels.least_cycles[place], digits=4),
            number(levels.most_cycles[place], digits=4),
            number(levels.failed_share_high[place], _PERCENT, digits=2),
        ]
        for name, levels in _snaps(view)
        for place in range(levels.peak_load_ratio.size)
    ]
    if not rows:
        return None
    return make_table(
        "Lines that go slack in each cycle, by level of peak load.",
        (
            "group", "peak load [% of rated break strength]", "failed", "stopped",
            "mean of the failed [1]", "shortest [1]", "longest [1]", "share failing, at most [%]",
        ),
        rows, synthetic=view.is_synthetic, remarks=[_SNAP],
    )  # fmt: skip


def snap_sentences(view: OutcomeView) -> list[str]:
    """Return between which loads failures begin, and what speaks against a sharp load."""
    sentences = []
    for name, levels in _snaps(view):
        low, high = (_PERCENT.factor * end for end in (levels.threshold_low, levels.threshold_high))
        known = [f"no failure up to {low:.3g} %"] if low == low else []
        known += [f"the first at {high:.3g} %"] if high == high else []
        sentences.append(
            f"{name}: {', '.join(known)} of the rated break strength, of lines that go slack in"
            " each cycle. These are loads of the tests, and no safe load."
        )
        sentences += [f"{name}: {note}." for note in levels.notes]
    return sentences
