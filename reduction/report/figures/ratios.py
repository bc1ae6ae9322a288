"""Ratios of moduli: of one specimen to another, of the end of a test to its start."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from reduction.report.figure import (
    Figure,
    Trace,
    axis,
    band,
    line,
    make_figure,
    plain_numbers,
)
from reduction.report.style import DASHES, colour, marked, shown
from reduction.report.view import TestView, any_synthetic
from reduction.vocabulary import BRANCH_NAMES

_CYCLES_OF = ", cycles "
"""Between specimen and cycles, in the name of what a ratio is of."""


def draw_ratios(tests: Sequence[TestView]) -> list[Figure]:
    """Draw ratios of moduli: a figure a branch, or one for both where one test alone has them."""
    found: list[Figure] = []
    pairs = dict.fromkeys(pair for view in tests for pair in _compared(view))
    for pair in pairs:
        own = [(index, view) for index, view in enumerate(tests) if pair in _compared(view)]
        both = tuple(range(len(BRANCH_NAMES)))
        for places in [both] if len(own) == 1 else [(place,) for place in both]:
            data = [
                trace
                for index, view in own
                for place in places
                for trace in _ratio(view, pair, place, index, is_alone=len(own) == 1)
            ]
            branches = " and ".join(BRANCH_NAMES[place] for place in places)
            figure = make_figure(
                f"campaign-ratio-{len(found)}",
                _ratio_title(own[0][1] if len(own) == 1 else None, pair, branches),
                f"Tangent modulus of {pair[0]} over that of {pair[1]} at the same strain,"
                f" {branches}{'' if len(own) == 1 else ', each test'}; band: 95 % interval, of what"
                " the two do not share. Where it leaves out 1 the two differ.",
                [trace for trace in data if trace["y"]], synthetic=any_synthetic(tests),
                xaxis=axis("strain [%]"), yaxis=_ratio_axis(data),
                shapes=[_level(1.0)],
            )  # fmt: skip
            if figure.has_data:
                found.append(figure)
    return found


def _ratio(
    view: TestView, pair: tuple[str, str], place: int, index: int, *, is_alone: bool
) -> list[Trace]:
    """Return the ratio of a branch with its interval; of a test alone a colour is a branch."""
    strain, ratio = view.array("ratio_strain_bin"), view.array("modulus_ratio")
    if strain is None or ratio is None:
        return []
    at, branch = _compared(view).index(pair), BRANCH_NAMES[place]
    low, high = (view.array_like(f"modulus_ratio_{end}", ratio) for end in ("low", "high"))
    x = strain * shown("strain", view.units).factor
    look = place if is_alone else index
    name = branch if is_alone else view.id
    return [
        band(x, low[at, place], high[at, place], name=name, colour=colour(look), alpha=0.2),
        line(
            x, ratio[at, place], name=name, colour=colour(look), dash=DASHES[branch],
            **marked(look),
        ),
    ]  # fmt: skip


def _ratio_title(alone: TestView | None, pair: tuple[str, str], branches: str) -> str:
    """Name what is over what, and the test where only one compares the pair."""
    above, below = (words.partition(_CYCLES_OF) for words in pair)
    if above[1] and above[0] == below[0]:
        what = f"modulus, end over start, {above[0]}"
    else:
        what = f"modulus, {pair[0]} over {pair[1]}"
    return f"{alone.id}: {what}" if alone else f"{what[:1].upper()}{what[1:]}, {branches}"


def _compared(view: TestView) -> list[tuple[str, str]]:
    """What the ratios of a test are between, above and below the line."""
    return list(zip(view.texts("ratio_numerator"), view.texts("ratio_denominator"), strict=True))


def _ratio_axis(data: Sequence[Trace]) -> dict[str, Any]:
    """Return the axis: all ratios, and four fifths of the interval ends.

    Where few cycles reach, an interval may be so wide that it would hide the rest.
    """
    title = "ratio of moduli [1]"
    lines, ends = heights(data)
    if not lines:
        return axis(title)
    usual = np.quantile(ends, [0.1, 0.9]) if ends else np.ones(2)
    low, high = min(*lines, usual[0], 1.0), max(*lines, usual[1], 1.0)
    room = 0.1 * (high - low) + 0.01
    return axis(title, range=plain_numbers(np.array([low - room, high + room])))


def heights(data: Sequence[Trace]) -> tuple[list[float], list[float]]:
    """Return what the lines of a figure reach, and the edges of its bands."""
    lines = [y for trace in data if "fill" not in trace for y in trace["y"] if y is not None]
    ends = [y for trace in data if "fill" in trace for y in trace["y"] if y is not None]
    return lines, ends


def _level(height: float) -> Trace:
    return {
        "type": "line", "xref": "paper", "x0": 0, "x1": 1, "y0": height, "y1": height,
        "line": {"width": 1, "dash": "dot", "color": "#8C8C8C"},
    }  # fmt: skip
