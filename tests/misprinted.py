"""Copies of printed cells with one digit changed, and what becomes of their verdict."""

import re
from dataclasses import replace

from reduction.published.printed_cells import cells_of
from reduction.published.reproduced_item import Answer, item_of

_DIGIT = re.compile(r"\d")


def misprint(text):
    """The text with its first digit that is not zero raised, or lowered where it is nine."""
    for found in _DIGIT.finditer(text):
        if found[0] != "0":
            other = "8" if found[0] == "9" else str(int(found[0]) + 1)
            return text[: found.start()] + other + text[found.end() :]
    return re.sub("0", "7", text, count=1)


def verdicts_of_misprints(report, answers):
    """Verdict of each cell that is reproduced, after one of its digits was changed."""
    verdicts = {}
    for cell in cells_of(report):
        answer = answers[cell.key]
        if not isinstance(answer, Answer) or answer.bound or not _DIGIT.search(cell.printed):
            continue
        if item_of(cell, answers).verdict == "derived":
            other = replace(cell, printed=misprint(cell.printed))
            verdicts[cell.key] = item_of(other, answers).verdict
    return verdicts
