"""Printed numbers in words, or whose words say how near they are meant: about, below, over."""

from __future__ import annotations

from dataclasses import replace

from reduction.published.cell import Cell, number_of, printed_step
from reduction.reproduce.item import Item, judge

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


def judge_as(
    cell: Cell, text: str, recomputed: float, how: str, *, tolerance: float | None = None
) -> Item:
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


def judge_word(cell: Cell, recomputed: float, how: str, *, step: float = 1.0) -> Item:
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
