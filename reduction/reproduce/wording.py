"""Printed numbers whose words say how near they are meant to be: about, below, over."""

from __future__ import annotations

from reduction.published.cell import Cell, number_of, printed_step
from reduction.reproduce.item import Item, judge

__all__ = ["judge_limit", "judge_round", "last_counted_place"]


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


def judge_round(cell: Cell, recomputed: float, how: str) -> Item:
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


def judge_limit(cell: Cell, recomputed: float, how: str, *, is_upper: bool) -> Item:
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
        ``reproduced`` where the bound holds, else by `judge`.
    """
    printed = number_of(cell.printed)
    if printed is not None and (recomputed <= printed if is_upper else recomputed >= printed):
        side = "below" if is_upper else "above"
        return Item(cell, recomputed, "reproduced", f"{how}; {side} the limit")
    return judge(cell, recomputed, how)
