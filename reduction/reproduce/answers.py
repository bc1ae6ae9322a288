"""Answers to the cells of a report, and the items that they make: one for every cell."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np

from reduction.errors import DataError
from reduction.published.cell import Cell, ReportId, number_of, printed_step
from reduction.published.read import cells_of
from reduction.record import Floats
from reduction.reproduce.item import Item, judge, not_testable
from reduction.reproduce.wording import judge_limit

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


def items_from(report: ReportId, answers: Mapping[Key, Answer | str]) -> list[Item]:
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


def item_of(cell: Cell, answers: Mapping[Key, Answer | str]) -> Item:
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
        return not_testable(cell, answer)
    printed = number_of(cell.printed)
    if answer.meaning is not None and abs(answer.meaning - answer.value) <= _ROUND_OFF:
        return Item(cell, answer.value, "reproduced", answer.how)
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
