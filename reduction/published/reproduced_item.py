"""A printed number and the recomputed one, with a verdict."""

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
    which data, or why not. ``tolerance`` is the allowed difference in the printed unit; NaN
    where no number was compared: words, bounds, numbers that nothing else determines. ``z`` and
    ``power`` apply to a number that equations relate to a partner: its deviation, and one unit of
    its leading digit, in standard errors; NaN for any other number.
    """

    cell: Cell
    recomputed: float
    verdict: Verdict
    how: str
    tolerance: float = math.nan
    z: float = math.nan
    power: float = math.nan


DETECTED = 3.0
"""Standard errors at which a closure distinguishes a wrong number from a right one. [1]"""


def judge_repeat(
    cell: Cell, other: float, how: str, *, tolerance: float | None = None
) -> ReproducedItem:
    """Compare a printed number with another print of the same number.

    By `judge`, but ``repeated`` where they are equal: nothing was computed, and a wrong number may
    have been copied.
    """
    item = judge(cell, other, how, tolerance=tolerance)
    return replace(item, verdict="repeated") if item.verdict == "derived" else item


def closed_item(
    item: ReproducedItem, standard_error: float, *, spread: float = 0.0, how: str = ""
) -> ReproducedItem:
    """Judge a number that equations relate to a partner.

    ``open`` where the deviation exceeds `DETECTED` standard errors; ``closed`` where it does not,
    but one unit of the leading digit would; where such a coarse error would not be detected,
    ``measured`` in place of ``derived``, and otherwise unchanged.

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
    """Compare a printed number with the expected one.

    ``tolerance``: by default half the last printed digit; wider only where the inputs are rounded
    too, by the effect of their rounding. ``derived`` where the printed number is within the
    tolerance; else ``erratum`` or ``open`` where the cell says so and the corrected value, if any,
    is within it; else ``unexplained``. An erratum that confirms the printed number, and therefore
    has no confidence, explains no difference.
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
    """Judge a claim in words by whether the numbers support it.

    ``derived`` where the claim holds; else ``erratum`` or ``open`` where the cell says so; else
    ``unexplained``.
    """
    verdict = "derived" if holds else _known_of(cell, "unexplained")
    return ReproducedItem(cell, math.nan, verdict, how)


def measured_item(cell: Cell, why: str) -> ReproducedItem:
    """Item for a cell that nothing else in the report determines.

    ``erratum`` or ``open`` where the cell says so, since that is known.
    """
    return ReproducedItem(cell, math.nan, _known_of(cell, "measured"), why)


def compared_item(cell: Cell, recomputed: float, why: str) -> ReproducedItem:
    """Item for a cell that is not determined to its last digit, with a number for comparison."""
    return replace(measured_item(cell, why), recomputed=recomputed)


def _known_of(cell: Cell, otherwise: Verdict) -> Verdict:
    """Verdict from the erratum of a cell; none where it confirms the printed number."""
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
    """One unit of the last nonzero digit of a round number.

    0 where there is no number, and for zero.

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
    """Compare a number that the text itself calls round with the expected one."""
    place = last_counted_place(cell.printed)
    return judge(cell, recomputed, f"{how}; round to {place:g}", tolerance=0.5 * place)


def judge_limit(cell: Cell, recomputed: float, how: str, *, is_upper: bool) -> ReproducedItem:
    """Compare a printed limit with the number that it bounds.

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
    """Compare another notation of a printed number with the expected one."""
    item = judge(replace(cell, printed=text), recomputed, how, tolerance=tolerance)
    return replace(item, cell=cell)


def judge_word(cell: Cell, recomputed: float, how: str, *, step: float = 1.0) -> ReproducedItem:
    """Compare a number in words with the expected one.

    By `judge`, within half a step; words without a number are never reproduced.
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
    """Expected value of a cell, in the printed unit, and its source data.

    Parameters
    ----------
    value : float
        Recomputed.
    how : str
        Source data.
    tolerance : float, optional
        Effect of the rounding of the inputs, where they are rounded.
    bound : {"", "below", "above"}
        The report says that a number is below, or above, the printed one: ``less than 2 %``.
    meaning : float, optional
        Value of printed words without a number: 1 for ``the same``.
    """

    value: float
    how: str
    tolerance: float | None = None
    bound: Literal["", "below", "above"] = ""
    meaning: float | None = None


Answers = dict[Key, Answer | str]
"""Answers by cell; a text says why nothing in the report determines the cell."""


def items_from(report: ReportId, answers: Mapping[Key, Answer | str]) -> list[ReproducedItem]:
    """One item for each cell of a report.

    In the order of the cells.
    """
    cells = cells_of(report)
    unknown = answers.keys() - {cell.key for cell in cells}
    if unknown:
        raise DataError(f"{report} has no such cell", found=" / ".join(min(unknown)))
    return [item_of(cell, answers) for cell in cells]


def item_of(cell: Cell, answers: Mapping[Key, Answer | str]) -> ReproducedItem:
    """The item of one cell."""
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
        # words have no digits: the corrected number is used
        tolerance = 0.5 * printed_step(repr(cell.corrected))
    elif tolerance is None and printed_step(cell.printed) == 0:
        tolerance = _ROUND_OFF  # a fraction is exact
    return judge(cell, answer.value, answer.how, tolerance=tolerance)


def log_slope(variable: Floats | list[float], value: Floats | list[float]) -> float:
    """Exponent with which a value grows with a variable, from the first point to the last.

    Examples
    --------
    >>> round(log_slope([1.0, 3.0], [5.0, 45.0]), 12)
    2.0
    """
    return float(np.log(value[-1] / value[0]) / np.log(variable[-1] / variable[0]))
