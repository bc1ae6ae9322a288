"""What changes from cycle to cycle: peaks, spring constant, energy, loss factor, slips."""

from __future__ import annotations

from typing import Any

import numpy as np

from reduction.record import Floats
from reduction.report.decimate import POINTS, keep_extremes
from reduction.report.figure import Figure, Trace, axis, band, line, make_figure
from reduction.report.style import Kind, colour, faded, plot_text, shown
from reduction.report.uncertainty import NORMAL, expanded_of, plus_minus
from reduction.report.view import TestView

LONG = 100
"""More cycles than this are drawn against the logarithm of their number."""
_UNDER_LABELS = 0.85
"""Height of the axes where the steps of a splice are named above them."""
_ROWS = (0.9, 0.97)
"""Heights of their names, so that two steps close together can be read."""
_PANELS: tuple[tuple[str, str, Kind, tuple[tuple[str, str], ...]], ...] = (
    ("peaks", "peak and valley tension", "tension",
     (("peak_tension", "solid"), ("valley_tension", "dash"))),
    ("spring-constant", "apparent spring constant", "tension",
     (("apparent_spring_constant", "solid"),)),
    ("energy", "hysteresis energy", "energy", (("hysteresis_energy", "solid"),)),
    ("loss-factor", "loss factor", "number", (("loss_factor", "solid"),)),
)  # fmt: skip
_CAPTIONS = {
    "peaks": "Greatest (solid) and least (dashed) tension of each cycle.",
    "spring-constant": "Tension amplitude over strain amplitude, force per unit strain.",
    "energy": "Closed-loop area of tension against strain: energy lost per cycle and unit of"
    " relaxed free length.",
    "loss-factor": "Loss over storage spring constant, from the fundamental of each cycle.",
}


def draw_trends(view: TestView) -> list[Figure]:
    """Draw one figure a quantity, a line a specimen; the steps of a splice are marked."""
    cycle = view.array("cycle")
    if cycle is None or cycle.size == 0:
        return []
    is_long = cycle.size > LONG
    place = np.log10(cycle) if is_long else cycle
    found = []
    for key, words, kind, quantities in _PANELS:
        unit = shown(kind, view.units)
        data: list[Trace] = []
        for name, dash in quantities:
            values = view.array(name)
            if values is None:
                continue
            for index, specimen in enumerate(view.specimens):
                kept = keep_extremes(place, values[index], limit=POINTS)
                x, y = cycle[kept], values[index, kept] * unit.factor
                spread = expanded_of(view.at_cycles(kept), name, values[:, kept]).half
                half = spread[index] * unit.factor
                label = specimen if dash == "solid" else f"{specimen}, {name.split('_')[0]}"
                data.append(
                    band(x, y - half, y + half, name=label, colour=colour(index), alpha=0.2)
                )
                data.append(_points(x, y, label, colour(index), dash, is_long=is_long))
        shapes, labels = _slips(view, is_long=is_long)
        figure = make_figure(
            f"{view.key}-{key}",
            f"{view.id}: {words}",
            f"{_CAPTIONS[key]}{_of_many(cycle.size)}{_slip_words(view)} {_about_band(view)}",
            [trace for trace in data if trace["y"]],
            synthetic=view.is_synthetic,
            height=340,
            xaxis=axis("cycle number [1]", **({"type": "log", "dtick": 1} if is_long else {})),
            yaxis=axis(unit.label(words), **({"domain": [0.0, _UNDER_LABELS]} if labels else {})),
            shapes=shapes,
            annotations=labels,
            meta={"cycles": "number"},
        )
        if figure.has_data:
            found.append(figure)
    return found


def _points(
    x: Floats, y: Floats, label: str, tint: str, dash: str, *, is_long: bool
) -> dict[str, Any]:
    marker: dict[str, Any] = (
        {} if is_long else {"mode": "lines+markers", "marker": {"size": 5, "color": tint}}
    )
    return line(x, y, name=label, colour=tint, dash=dash, width=1.4, **marker)


def _slips(view: TestView, *, is_long: bool) -> tuple[list[Trace], list[Trace]]:
    """Return a bar over the cycles in which each step may lie, and its label."""
    cycles = view.array("slip_cycle")
    if cycles is None:
        return [], []
    low, high = (
        view.array_like("slip_cycle_low", cycles),
        view.array_like("slip_cycle_high", cycles),
    )
    shapes: list[Trace] = []
    labels: list[Trace] = []
    for place, specimen in enumerate(view.texts("slip_specimen")):
        tint = colour(view.specimens.index(specimen))
        shapes += [
            {
                "type": "rect", "layer": "below", "xref": "x", "yref": "paper", "y0": 0,
                "y1": _UNDER_LABELS, "x0": low[place] - 0.5, "x1": high[place] + 0.5,
                "line": {"width": 0}, "fillcolor": faded(tint, 0.15),
            },
            {
                "type": "line", "xref": "x", "yref": "paper", "y0": 0, "y1": _UNDER_LABELS,
                "x0": cycles[place], "x1": cycles[place],
                "line": {"color": tint, "dash": "dot", "width": 1.5},
            },
        ]  # fmt: skip
        # plotly wants the logarithm for a label on a logarithmic axis, but not for a shape
        labels.append(
            {
                "text": f"{plot_text(specimen, 12)} {cycles[place]:.0f}",
                "x": float(np.log10(cycles[place])) if is_long else float(cycles[place]),
                "xref": "x", "yref": "paper", "y": _ROWS[place % len(_ROWS)], "yanchor": "middle",
                "xanchor": "center", "showarrow": False, "font": {"size": 10},
            }
        )  # fmt: skip
    return shapes, labels


def _about_band(view: TestView) -> str:
    if not view.texts("uncertainty_source"):
        return plus_minus([NORMAL], "noise, regression", mark="Band, ±")
    held = "noise, regression; and what all samples share, which moves all cycles alike"
    return plus_minus([NORMAL], held, left_out="", mark="Band, ±")


def _of_many(n_cycles: int) -> str:
    if n_cycles <= POINTS:
        return ""
    return f" Of {n_cycles:,} cycles those are drawn that are least or greatest of their stretch."


def _slip_words(view: TestView) -> str:
    words = " Vertical lines: steps of a splice, with specimen and cycle; shaded: where it may lie."
    return words if view.array("slip_cycle") is not None else ""
