"""A printed number beside what it ought to be, and the verdict."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from reduction.published.cell import Cell, number_of, printed_step

Verdict = Literal["reproduced", "erratum", "open", "not_testable", "unexplained"]


@dataclass(frozen=True)
class Item:
    """One cell of a report.

    ``recomputed`` is in the printed unit, NaN where nothing can be computed; ``how`` says from
    what, or why not. ``tolerance`` is by how much the two may differ, in the printed unit; NaN
    where no number was held against another: words, bounds, what is not testable.
    """

    cell: Cell
    recomputed: float
    verdict: Verdict
    how: str
    tolerance: float = math.nan


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
        else ``unexplained``. An erratum that lets the printed number stand, and has no confidence
        therefore, explains no difference from it.
    """
    half = 0.5 * printed_step(cell.printed)
    allowed = (half if tolerance is None else max(tolerance, half)) * (1 + 1e-9)
    verdict = _known_of(cell, "unexplained")
    if np.isfinite(recomputed) and abs(_printed_value(cell) - recomputed) <= allowed:
        verdict = "reproduced"
    elif verdict == "erratum" and cell.corrected is not None:
        verdict = "erratum" if abs(cell.corrected - recomputed) <= allowed else "unexplained"
    return Item(cell, recomputed, verdict, how, allowed)


def agree(cell: Cell, holds: bool, how: str) -> Item:
    """A claim in words that numbers bear out or not.

    Parameters
    ----------
    cell : Cell
        As printed.
    holds : bool
        Whether they do.
    how : str
        From what.

    Returns
    -------
    item : Item
        ``reproduced`` where the claim holds; else ``erratum`` or ``open`` where the cell says so;
        else ``unexplained``.
    """
    verdict = "reproduced" if holds else _known_of(cell, "unexplained")
    return Item(cell, math.nan, verdict, how)


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
    return Item(cell, math.nan, _known_of(cell, "not_testable"), why)


def beside(cell: Cell, recomputed: float, why: str) -> Item:
    """A cell that nothing determines to its last digit, with a number to hold against it.

    Parameters
    ----------
    cell : Cell
        As printed.
    recomputed : float
        The number beside it, in the printed unit.
    why : str
        What it is, and why the cell does not follow from it.

    Returns
    -------
    item : Item
        By `not_testable`.
    """
    return replace(not_testable(cell, why), recomputed=recomputed)


def _known_of(cell: Cell, otherwise: Verdict) -> Verdict:
    """What is said against a cell; nothing where its erratum lets the printed number stand."""
    if not cell.erratum or not cell.confidence:
        return otherwise
    return "open" if cell.confidence == "open" else "erratum"


def _printed_value(cell: Cell) -> float:
    value = number_of(cell.printed)
    return math.nan if value is None else value
