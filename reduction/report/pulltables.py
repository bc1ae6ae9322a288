"""Tables of a slow pull: its cubic, and strain at round shares of the break strength."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reduction.report.htmltable import (
    Cell,
    Table,
    make_table,
    measured,
    number,
    span,
    words,
)
from reduction.report.style import Shown, shown, superscript
from reduction.report.uncertainty import (
    NORMAL,
    expanded_of,
    plus_minus_of_tests,
)
from reduction.report.view import TestView

__all__ = ["pull_share_table", "pull_table"]

_TERMS = ("1", "T", "T²", "T³")


def pull_table(view: TestView) -> Table | None:
    """Return the cubic of each slow pull, its range of use, and how it was made."""
    coefficient = view.array("pull_strain_coefficient")
    if coefficient is None:
        return None
    force, percent = shown("tension", view.units), shown("strain", view.units)
    half = expanded_of(view, "pull_strain_coefficient", coefficient).half
    given = [k for k in range(len(view.specimens)) if np.isfinite(coefficient[k]).any()]
    rows = []
    for power, term in enumerate(_TERMS):
        scale = 1.0 / force.factor**power
        per = "1" if power == 0 else superscript(f"{force.unit}-{power}")
        rows.append(
            [words(f"strain, coefficient of {term} [{per}]")]
            + [_scaled(coefficient[k, power], half[k, power], scale) for k in given]
        )
    low, high = (view.array_like(f"pull_tension_{e}", coefficient[:, 0]) for e in ("low", "high"))
    scalars: Sequence[tuple[str, str, Shown]] = (
        ("residual of the cubic", "pull_residual", percent),
        ("rate of strain", "pull_strain_rate", Shown("%/min", 6000.0)),
        ("waiting time before the pull", "pull_waiting_time", Shown("h", 1 / 3600.0)),
        ("tension at which the length was read", "pull_reference_tension", force),
    )
    rows += [
        [words(force.label("range of use"))]
        + [span(low[k], high[k], force, places=0) for k in given]
    ]  # fmt: skip
    for text, name, unit in scalars:
        values = view.array_like(name, coefficient[:, 0])
        rows.append([words(unit.label(text))] + [number(float(values[k]), unit) for k in given])
    return make_table(
        "Slow pull: strain as a cubic of tension T, and the conditions it holds for.",
        ("what, with its unit", *(view.specimens[k] for k in given)), rows,
        synthetic=view.is_synthetic,
        remarks=["K_0 is the inverse slope of the cubic at the mean tension of interest; it grows"
                 " with the rate of strain and with the waiting time.",
                 _about_pull(view, "pull_strain_coefficient")],
    )  # fmt: skip


def pull_share_table(view: TestView) -> Table | None:
    """Return strain and K_0 of the slow pull at round shares of the break strength."""
    share, strain = view.array("break_share"), view.array("strain_at_break_share")
    if share is None or strain is None:
        return None
    half = expanded_of(view, "strain_at_break_share", strain).half
    percent = shown("strain", view.units)
    kept = np.flatnonzero(np.isfinite(strain).any(axis=0))
    if kept.size == 0:
        return None
    rows = [
        [words(f"{100 * share[j]:g}")]
        + [measured(strain[k, j], half[k, j], percent) for k in range(len(view.specimens))]
        for j in kept
    ]
    return make_table(
        "Strain of the slow pull at round shares of the rated break strength, within its range.",
        ("tension [%RBS]", *(percent.label(name) for name in view.specimens)), rows,
        synthetic=view.is_synthetic,
        remarks=[_about_pull(view, "strain_at_break_share")],
    )  # fmt: skip


def _about_pull(view: TestView, name: str) -> str:
    return plus_minus_of_tests([NORMAL], [view], [name], found_from="scatter about the cubic")


def _scaled(value: float, half: float, scale: float) -> Cell:
    text = f"{value * scale:.6g}" + (f" ± {half * scale:.2g}" if np.isfinite(half) else "")
    return Cell(text, repr(float(value)), is_number=True)
