"""A printed number beside what it ought to be, and the verdict."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from reduction.published.cell import Cell, number_of, printed_step

__all__ = ["Item", "Verdict", "judge", "not_testable"]

Verdict = Literal["reproduced", "erratum", "open", "not_testable", "unexplained"]


@dataclass(frozen=True)
class Item:
    """One cell of a report.

    ``recomputed`` is in the printed unit, NaN where nothing can be computed; ``how`` says from
    what, or why not.
    """

    cell: Cell
    recomputed: float
    verdict: Verdict
    how: str


def judge(cell: Cell, recomputed: float, how: str, *, tolerance: float | None = None) -> Item:
    """Hold a printed number against what it ought to be.

    Parameters
    ----------
    cell : Cell
        As printed.
    recomputed : float
        In the printed unit.
    how : str
        From what it was computed.
    tolerance : float, optional
        Half the last printed digit where nothing is said; wider only where the inputs are
        rounded too, by what their rounding does.

    Returns
    -------
    item : Item
        ``reproduced`` where the printed number is within the tolerance; else ``erratum`` or
        ``open`` where the cell says so, and the corrected value, where there is one, is within it;
        else ``unexplained``.
    """
    step = printed_step(cell.printed)
    allowed = (0.5 * step if tolerance is None else max(tolerance, 0.5 * step)) * (1 + 1e-9)
    printed = _printed_value(cell)
    verdict: Verdict = "unexplained"
    if np.isfinite(recomputed) and abs(printed - recomputed) <= allowed:
        verdict = "reproduced"
    elif cell.confidence == "open":
        verdict = "open"
    elif cell.erratum and (cell.corrected is None or abs(cell.corrected - recomputed) <= allowed):
        verdict = "erratum"
    return Item(cell, recomputed, verdict, how)


def not_testable(cell: Cell, why: str) -> Item:
    """A cell that nothing else in the report determines.

    Parameters
    ----------
    cell : Cell
        As printed.
    why : str
        Measured, a figure that the text lacks, a setting, ...

    Returns
    -------
    item : Item
        ``erratum`` or ``open`` where the cell says so: that much is known of it.
    """
    verdict: Verdict = "not_testable"
    if cell.confidence == "open":
        verdict = "open"
    elif cell.erratum:
        verdict = "erratum"
    return Item(cell, float("nan"), verdict, why)


def _printed_value(cell: Cell) -> float:
    value = number_of(cell.printed)
    return float("nan") if value is None else value
