"""What the figures of a hose share: the axis of strain, bands, events, the slack zone."""

from __future__ import annotations

from typing import Any

import numpy as np

from reduction.record import Floats
from reduction.report.figure import Figure, Trace, axis, band, plain_numbers
from reduction.report.hoseview import EVENT_WORDS, HoseView, OneEvent
from reduction.report.style import COLOURS, Shown, symbol
from reduction.report.uncertainty import NORMAL

NET, CORDS, RUBBER = COLOURS[0], COLOURS[1], COLOURS[2]
GREY = COLOURS[6]
SYMBOLS = {
    "deepest_slack": symbol(7), "pick_up": symbol(2), "working": symbol(0), "cord_break": symbol(5),
}  # fmt: skip
SLACKEST = EVENT_WORDS["deepest_slack"]
_ALPHA = 0.22
_SLACK = "rgba(140,140,140,0.16)"


def percent(view: HoseView) -> Floats:
    """Strains of a hose as shown."""
    return 100 * view.array("strain")


def strain_axis(**more: Any) -> dict[str, Any]:
    """Return the axis that all figures of a hose share."""
    return axis("strain of the hose [%]", **more)


def interval(
    strain: Floats, values: Floats, spread: Floats, factor: float, of_colour: str = NET
) -> Trace:
    """Return the band of 95 %; broken where nothing is known."""
    half = NORMAL * spread
    return band(
        strain, factor * (values - half), factor * (values + half), name="95 % band",
        colour=of_colour, alpha=_ALPHA,
    )  # fmt: skip


def is_drawn(view: HoseView, event: OneEvent) -> bool:
    """Return whether an event lies on the curve; pick-up at rest is no event."""
    is_at_rest = event.name == "pick_up" and not view.is_slack_at_first
    return event.strain <= view.array("strain")[-1] * (1 + 1e-9) and not is_at_rest


def event_marks(view: HoseView, quantity: str, unit: Shown) -> list[Trace]:
    """Return a mark with its words for each event; the slackest point is the bottom of a bowl."""
    lowest = "bottom center" if quantity == "cord_strain" else "top center"
    return [
        {
            "type": "scatter", "mode": "markers+text", "name": event.words,
            "x": plain_numbers(np.array([100 * event.strain])),
            "y": plain_numbers(np.array([unit.factor * getattr(event, quantity)])),
            "text": [event.words], "showlegend": False,
            "textposition": lowest if event.words == SLACKEST else "top left",
            "marker": {"symbol": SYMBOLS[event.name], "size": 10, "color": NET},
        }
        for event in view.events.values()
        if is_drawn(view, event)
    ]  # fmt: skip


def slack_zone(view: HoseView) -> dict[str, Any]:
    """Return the shade where the rubber alone carries."""
    if not view.is_slack_at_first:
        return {}
    end = 100 * min(view.events["pick_up"].strain, float(view.array("strain")[-1]))
    return {
        "shapes": [
            {
                "type": "rect", "layer": "below", "xref": "x", "yref": "paper", "x0": 0, "x1": end,
                "y0": 0, "y1": 1, "line": {"width": 0}, "fillcolor": _SLACK,
            }
        ],
        "annotations": [
            {
                "text": "cords slack", "x": end / 2, "y": 0.97, "xref": "x", "yref": "paper",
                "showarrow": False, "yanchor": "top", "font": {"size": 11},
            }
        ],
    }  # fmt: skip


def kept_figure(figure: Figure) -> list[Figure]:
    """Return a figure, or nothing where it is empty."""
    return [figure] if figure.has_data else []
