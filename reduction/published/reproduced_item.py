"""A printed number beside the recomputed one, with its verdict."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from reduction.published.printed_cells import Cell, ReportId, cells_of, number_of, printed_step
from reduction.record.errors import DataError
from reduction.record.measurement import Floats

Verdict = Literal[
    "derived", "closed", "repeated", "erratum", "open", "measured", "unexplained"
]  # fmt: skip


@dataclass(frozen=True)
class ReproducedItem:
    """One cell of a report.

    ``recomputed`` is in the printed unit, NaN where nothing can be computed; ``how`` says from
    what, or why not. ``tolerance`` is by how much the two may differ, in the printed unit; NaN
    where no number was held against another: words, bounds, what nothing else determines. ``z`` and
    ``power`` are of a number that equations close with a partner: how far off it is, and how far
    one unit of its leading digit would be, in standard errors; NaN of any other.
    """

    cell: Cell
    recomputed: float
    verdict: Verdict
    how: str
    tolerance: float = math.nan
    z: float = math.nan
    power: float = math.nan


DETECTED = 3.0
"""Standard errors at which a closure tells a wrong number from a right one. [1]"""


def judge_repeat(
    cell: Cell, other: float, how: str, *, tolerance: float | None = None
) -> ReproducedItem:
    """Hold a printed number against another print of the same number.

    Parameters
    ----------
    cell : Cell
        As printed.
    other : float
        The other print, in the printed unit.
    how : str
        Where it stands.
    tolerance : float, optional
        As of `judge`.

    Returns
    -------
    item : Item
        By `judge`, but ``repeated`` where they are equal: nothing was computed, and a wrong number
        may have been copied.
    """
    item = judge(cell, other, how, tolerance=tolerance)
    return replace(item, verdict="repeated") if item.verdict == "derived" else item


def closed_item(
    item: ReproducedItem, standard_error: float, *, spread: float = 0.0, how: str = ""
) -> ReproducedItem:
    """What is known of a number that equations join to a partner.

    Parameters
    ----------
    item : Item
        With the number that the partner asks for; known faults stay as they are.
    standard_error : float
        Of the printed number less that one; NaN or zero where nothing is known of it.
    spread : float
        How far apart the numbers are that the partner may ask for, of which the nearest is taken:
        so much of a fault it hides. [printed unit]
    how : str
        From what; that of the item where nothing is said.

    Returns
    -------
    item : Item
        ``open`` where the number is farther off than `DETECTED` standard errors; ``closed`` where
        it is not, and one unit of its leading digit would be; where so coarse a fault would not be
        seen, ``measured`` in place of ``derived``, and else as it is.

    Examples
    --------
    >>> cell = Cell("CG-D-39-80", "14", "", "", ".756", "1e4 lb", None, "", "", "", "")
    >>> for recomputed in (0.79, 1.11):
    ...     item = closed_item(compared_item(cell, recomputed, "K_ap and H"), 0.03)
    ...     print(item.verdict, round(item.z, 1), round(item.power, 1))
    closed -1.1 3.3
    open -11.8 3.3
    """
    printed = _printed_value(item.cell)
    if item.verdict not in ("derived", "repeated", "measured") or not (
        standard_error > 0 and printed and np.isfinite(item.recomputed)
    ):
        return item
    z = (printed - item.recomputed) / standard_error
    unit = float(10.0 ** np.floor(np.log10(abs(printed))))
    power = max(0.0, unit - spread) / standard_error
    verdict: Verdict = "closed" if abs(z) <= DETECTED else "open"
    if verdict == "closed" and power < DETECTED:
        verdict = "measured" if item.verdict == "derived" else item.verdict
    return replace(item, verdict=verdict, how=how or item.how, z=z, power=power)


def judge(
    cell: Cell, recomputed: float, how: str, *, tolerance: float | None = None
) -> ReproducedItem:
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
        ``derived`` where the printed number is within the tolerance; else ``erratum`` or
        ``open`` where the cell says so, and the corrected value, where there is one, is within it;
        else ``unexplained``. An erratum that lets the printed number stand, and has no confidence
        therefore, explains no difference from it.
    """
    half = 0.5 * printed_step(cell.printed)
    allowed = (half if tolerance is None else max(tolerance, half)) * (1 + 1e-9)
    verdict = _known_of(cell, "unexplained")
    if np.isfinite(recomputed) and abs(_printed_value(cell) - recomputed) <= allowed:
        verdict = "derived"
    elif verdict == "erratum" and cell.corrected is not None:
        verdict = "erratum" if abs(cell.corrected - recomputed) <= allowed else "unexplained"
    return ReproducedItem(cell, recomputed, verdict, how, allowed)


def agree(cell: Cell, holds: bool, how: str) -> ReproducedItem:
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
        ``derived`` where the claim holds; else ``erratum`` or ``open`` where the cell says so;
        else ``unexplained``.
    """
    verdict = "derived" if holds else _known_of(cell, "unexplained")
    return ReproducedItem(cell, math.nan, verdict, how)


def measured_item(cell: Cell, why: str) -> ReproducedItem:
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
    return ReproducedItem(cell, math.nan, _known_of(cell, "measured"), why)


def compared_item(cell: Cell, recomputed: float, why: str) -> ReproducedItem:
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
        By `measured_item`.
    """
    return replace(measured_item(cell, why), recomputed=recomputed)


def _known_of(cell: Cell, otherwise: Verdict) -> Verdict:
    """What is said against a cell; nothing where its erratum lets the printed number stand."""
    if not cell.erratum or not cell.confidence:
        return otherwise
    return "open" if cell.confidence == "open" else "erratum"


def _printed_value(cell: Cell) -> float:
    value = number_of(cell.printed)
    return math.nan if value is None else value


_WORDS = {
    "one": 1.0, "one-and-a-half": 1.5, "two": 2.0, "twice": 2.0, "three": 3.0, "four": 4.0,
    "five": 5.0, "six": 6.0, "nine": 9.0, "twelve": 12.0,
}  # fmt: skip


def last_counted_place(text: str) -> float:
    """One unit of the last digit of a round number that is not zero.

    Parameters
    ----------
    text : str
        As printed.

    Returns
    -------
    place : float
        0 where there is no number, and where it is zero.

    Examples
    --------
    >>> last_counted_place("350"), last_counted_place("about 500"), last_counted_place("85")
    (10.0, 100.0, 1.0)
    """
    value, place = number_of(text), printed_step(text)
    if not value:
        return 0.0
    while round(value / place) % 10 == 0:
        place *= 10
    return place


def judge_round(cell: Cell, recomputed: float, how: str) -> ReproducedItem:
    """Hold a round number, that the text itself calls one, against what it ought to be.

    Parameters
    ----------
    cell : Cell
        Printed with about, around, up to, or as a range of round numbers.
    recomputed : float
        In the printed unit.
    how : str
        From what it was computed.

    Returns
    -------
    item : Item
        By `judge`, within half of the last digit that is not zero.
    """
    place = last_counted_place(cell.printed)
    return judge(cell, recomputed, f"{how}; round to {place:g}", tolerance=0.5 * place)


def judge_limit(cell: Cell, recomputed: float, how: str, *, is_upper: bool) -> ReproducedItem:
    """Hold a printed limit against what it is said to bound.

    Parameters
    ----------
    cell : Cell
        Printed with less than, below, up to; or with over, above, at least.
    recomputed : float
        What is bounded, in the printed unit.
    how : str
        From what it was computed.
    is_upper : bool
        Whether the printed number bounds it from above.

    Returns
    -------
    item : Item
        ``derived`` where the bound holds, else by `judge`.
    """
    printed = number_of(cell.printed)
    if printed is not None and (recomputed <= printed if is_upper else recomputed >= printed):
        side = "below" if is_upper else "above"
        return ReproducedItem(cell, recomputed, "derived", f"{how}; {side} the limit")
    return judge(cell, recomputed, how)


def judge_as(
    cell: Cell, text: str, recomputed: float, how: str, *, tolerance: float | None = None
) -> ReproducedItem:
    """Hold another writing of a printed number against what it ought to be.

    Parameters
    ----------
    cell : Cell
        As printed.
    text : str
        Its number in digits.
    recomputed : float
        What it ought to be.
    how : str
        From what it was computed.
    tolerance : float, optional
        As of `judge`.

    Returns
    -------
    item : Item
        By `judge`; of the cell as printed.
    """
    item = judge(replace(cell, printed=text), recomputed, how, tolerance=tolerance)
    return replace(item, cell=cell)


def judge_word(cell: Cell, recomputed: float, how: str, *, step: float = 1.0) -> ReproducedItem:
    """Hold a number in words against what it ought to be.

    Parameters
    ----------
    cell : Cell
        Printed as ``twice``, ``two samples each``.
    recomputed : float
        What it ought to be.
    how : str
        From what it was computed.
    step : float
        In which it is said: 0.5 for ``one-and-a-half``.

    Returns
    -------
    item : Item
        By `judge`, within half a step; words that are no number are never reproduced.
    """
    said = next((_WORDS[word] for word in cell.printed.lower().split() if word in _WORDS), None)
    if said is None:
        return judge(cell, recomputed, how)
    return judge_as(cell, f"{said:.1f}", recomputed, how, tolerance=0.5 * step)


_ROUND_OFF = 1e-9

Key = tuple[str, str, str]
"""Table, row and column of a cell."""


@dataclass(frozen=True)
class Answer:
    """What a cell ought to be, in the printed unit, and from what.

    Parameters
    ----------
    value : float
        Recomputed.
    how : str
        From what.
    tolerance : float, optional
        What the rounding of the inputs does, where they are rounded.
    bound : {"", "below", "above"}
        The page says that a number is below, or above, the printed one: ``less than 2 %``.
    meaning : float, optional
        Of printed words that hold no number: 1 for ``the same``.
    """

    value: float
    how: str
    tolerance: float | None = None
    bound: Literal["", "below", "above"] = ""
    meaning: float | None = None


Answers = dict[Key, Answer | str]
"""By cell; a text says why nothing in the report determines it."""


def items_from(report: ReportId, answers: Mapping[Key, Answer | str]) -> list[ReproducedItem]:
    """One item for each cell of a report.

    Parameters
    ----------
    report : ReportId
        Which of the five.
    answers : mapping of Key to Answer or str
        By cell.

    Returns
    -------
    items : list of Item
        In the order of the cells.

    Raises
    ------
    DataError
        If a cell has no answer, or an answer no cell.
    """
    cells = cells_of(report)
    unknown = answers.keys() - {cell.key for cell in cells}
    if unknown:
        raise DataError(f"{report} has no such cell", found=" / ".join(min(unknown)))
    return [item_of(cell, answers) for cell in cells]


def item_of(cell: Cell, answers: Mapping[Key, Answer | str]) -> ReproducedItem:
    """The item of one cell.

    Parameters
    ----------
    cell : Cell
        As printed.
    answers : mapping of Key to Answer or str
        By cell.

    Returns
    -------
    item : Item
        With its verdict.

    Raises
    ------
    DataError
        If the cell has no answer.
    """
    if cell.key not in answers:
        raise DataError(f"nothing is said of a cell of {cell.report}", found=" / ".join(cell.key))
    answer = answers[cell.key]
    if isinstance(answer, str):
        return measured_item(cell, answer)
    printed = number_of(cell.printed)
    if answer.meaning is not None and abs(answer.meaning - answer.value) <= _ROUND_OFF:
        return ReproducedItem(cell, answer.value, "derived", answer.how)
    if answer.bound:
        is_upper = answer.bound == "below"
        return judge_limit(cell, answer.value, answer.how, is_upper=is_upper)
    tolerance = answer.tolerance
    if tolerance is None and printed is None and cell.corrected is not None:
        # words have no digits: those of the corrected number are judged
        tolerance = 0.5 * printed_step(repr(cell.corrected))
    elif tolerance is None and printed_step(cell.printed) == 0:
        tolerance = _ROUND_OFF  # a fraction is exact
    return judge(cell, answer.value, answer.how, tolerance=tolerance)


def log_slope(variable: Floats | list[float], value: Floats | list[float]) -> float:
    """Power with which a value grows with a variable, from the first point to the last.

    Examples
    --------
    >>> round(log_slope([1.0, 3.0], [5.0, 45.0]), 12)
    2.0
    """
    return float(np.log(value[-1] / value[0]) / np.log(variable[-1] / variable[0]))
