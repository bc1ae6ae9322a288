"""Loops, trends over cycles, and dynamic modulus against amplitude."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from reduction.quantities.flags import BRANCH_VALUES
from reduction.record.measurement import Floats
from reduction.report.figure_data import (
    POINTS,
    Figure,
    Trace,
    axis,
    band,
    keep_extremes,
    line,
    make_figure,
    plain_numbers,
)
from reduction.report.test_view import (
    NORMAL,
    TestView,
    all_specimens,
    any_synthetic,
    expanded_of,
    plus_minus,
    plus_minus_of_tests,
)
from reduction.report.text_style import (
    COLOURS,
    DASHES,
    Kind,
    colour,
    faded,
    marker,
    plot_text,
    shown,
)


def draw_loops(view: TestView) -> list[Figure]:
    """Draw one figure a specimen; stress where an area is known, else tension."""
    strain, number, branch = view.array("strain"), view.array("cycle_number"), view.array("branch")
    if strain is None or number is None or branch is None or view.n_cycles == 0:
        return []
    load, words, in_load = (
        view.array("nominal_stress"),
        "nominal stress",
        shown("stress", view.units),
    )
    if load is None or not np.isfinite(load).any():
        load, words, in_load = view.array("tension"), "tension", shown("tension", view.units)
    if load is None:
        return []
    in_strain = shown("strain", view.units)
    # the number on the samples, not the coordinate: a selection of cycles is still right
    wanted = np.array([1, (view.n_cycles + 1) // 2, view.n_cycles], dtype=np.float64)
    cycles = view.stored_near(wanted).astype(int)
    of_stored = "" if view.is_whole else " of those whose samples are stored"
    found = []
    for index, specimen in enumerate(view.specimens):
        data: list[Trace] = []
        chord: tuple[float, float] | None = None
        for order, cycle in enumerate(cycles):
            for name, value in BRANCH_VALUES.items():
                if value == 0:
                    continue
                own = np.flatnonzero((number == cycle) & (branch == value))
                if own.size == 0:
                    continue
                kept = own[
                    keep_extremes(
                        own.astype(np.float64), strain[index, own], load[index, own],
                        limit=POINTS // 4,
                    )
                ]  # fmt: skip
                x, y = strain[index, kept], load[index, kept]
                chord = chord or _chord(x, y)
                opened = y - (chord[0] * x + chord[1])
                data += [
                    line(
                        x * in_strain.factor, values * in_load.factor,
                        name=f"cycle {cycle}, {name}", colour=COLOURS[(0, 4, 1)[order]],
                        dash=DASHES[name], width=1.6, legendgroup=f"cycle {cycle}",
                        meta={"cycle": int(cycle)}, yaxis=where, showlegend=where == "y2",
                    )
                    for values, where in ((y, "y2"), (opened, "y"))
                ]  # fmt: skip
        found.append(
            make_figure(
                f"{view.key}-loops-{index}", f"{view.id}: loops, {specimen}",
                f"Above: {words} against strain of the splice-free length, first, middle and last"
                f" cycle{of_stored}; ascending solid, descending dashed. Below: the same minus the"
                " chord of the first branch, which makes the loops visible.",
                data, synthetic=view.is_synthetic, height=520,
                xaxis=axis(in_strain.label("strain"), anchor="y"),
                yaxis=axis(in_load.label("less the chord"), domain=[0.0, 0.4], zeroline=True),
                yaxis2=axis(in_load.label(words), domain=[0.48, 1.0]),
            )
        )  # fmt: skip
    return found


def _chord(strain: Floats, load: Floats) -> tuple[float, float]:
    """Return slope and height at zero of the straight line between the ends of a branch."""
    known = np.flatnonzero(np.isfinite(strain) & np.isfinite(load))
    if known.size == 0:
        return 0.0, 0.0
    low, high = known[np.argmin(strain[known])], known[np.argmax(strain[known])]
    width = strain[high] - strain[low]
    slope = float((load[high] - load[low]) / width) if width > 0 else 0.0
    return slope, float(load[low] - slope * strain[low])


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
    "peaks": "Peak (solid) and minimum (dashed) tension of each cycle.",
    "spring-constant": "Tension amplitude over strain amplitude.",
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
                spread = expanded_of(view.at_cycles(name, kept), name, values[:, kept]).half
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
    held = "noise, regression; and errors common to all samples, which move all cycles together"
    return plus_minus([NORMAL], held, left_out="", mark="Band, ±")


def _of_many(n_cycles: int) -> str:
    if n_cycles <= POINTS:
        return ""
    return f" Of {n_cycles:,} cycles only the minima and maxima of short intervals are drawn."


def _slip_words(view: TestView) -> str:
    words = " Vertical lines: slips of a splice, with specimen and cycle; shaded: possible cycles."
    return words if view.array("slip_cycle") is not None else ""


def draw_amplitude_pairs(tests: Sequence[TestView]) -> list[Figure]:
    """Draw dynamic modulus, loss factor and energy against mean strain, bars of amplitude."""
    panels: tuple[tuple[str, str, Kind], ...] = (
        ("test_dynamic_modulus", "dynamic modulus", "stress"),
        ("test_loss_factor", "loss factor", "number"),
        ("test_hysteresis_energy", "hysteresis energy", "energy"),
    )
    found = []
    names = all_specimens(tests)
    for name, words, kind in panels:
        data: list[Trace] = []
        units = tests[0].units if tests else "si"
        unit = shown(kind, units)
        in_legend: set[str] = set()
        drawn: dict[str, int] = {}
        factors: list[float] = []
        seen: dict[str, TestView] = {}
        for index, view in enumerate(tests):
            for order, specimen in enumerate(names):
                row = _summary(view, specimen, name)
                if row is not None and np.isfinite(row[2]):
                    data.append(_point(view.id, specimen, (index, order), row, unit.factor))
                    data[-1]["showlegend"] = view.id not in in_legend
                    in_legend.add(view.id)
                    factors.append(float(row[4]))
                    seen[view.id] = view
                    drawn[specimen] = order
        if len(drawn) > 1:
            data += [_entry(specimen, order) for specimen, order in drawn.items()]
        of_whole = " (whole cycle)" if name == "test_dynamic_modulus" else ""
        figure = make_figure(
            f"campaign-{name}", f"{words.capitalize()} of each test",
            f"{words.capitalize()}{of_whole}, mean over the cycles of a test, against mean strain."
            " Horizontal bars: strain range of the cycles. Colour and shape of a marker: test;"
            " filling: specimen (grey in the legend)."
            " " + plus_minus_of_tests(factors, [*seen.values()], [name], mark="Upright bar, ±"),
            data, synthetic=any_synthetic(tests), height=400,
            xaxis=axis("mean strain [%]"), yaxis=axis(unit.label(words)),
        )  # fmt: skip
        if figure.has_data:
            found.append(figure)
    return found


def _summary(view: TestView, specimen: str, name: str) -> Floats | None:
    """Return mean strain, strain amplitude, value, its expanded uncertainty and the factor."""
    if specimen not in view.specimens:
        return None
    mean, amplitude = view.array("test_mean_strain"), view.array("test_strain_amplitude")
    values = view.array(name)
    if mean is None or amplitude is None or values is None:
        return None
    row = view.specimens.index(specimen)
    spread = expanded_of(view, name, values)
    return np.array([mean[row], amplitude[row], values[row], spread.half[row], spread.factor[row]])


def _point(test: str, specimen: str, places: tuple[int, int], row: Floats, factor: float) -> Trace:
    """Return one test and specimen; the legend has one entry for all specimens of a test."""
    look = marker(places[0], variant=places[1], size=9)
    bars = {"type": "data", "color": look["color"], "thickness": 1, "width": 3}
    mean, amplitude = 100.0 * row[:1], 100.0 * row[1:2]
    return {
        "type": "scatter",
        "mode": "markers",
        "name": plot_text(test),
        "legendgroup": plot_text(test),
        "text": plot_text(f"{test}, {specimen}", 80),
        "x": plain_numbers(mean),
        "y": plain_numbers(factor * row[2:3]),
        "error_x": {**bars, "array": plain_numbers(amplitude)},
        "error_y": {**bars, "array": plain_numbers(factor * row[3:4])},
        "marker": look,
    }


def _entry(specimen: str, order: int) -> Trace:
    """Return an entry of the legend that says which filling is the specimen's."""
    look = {**marker(0, variant=order, size=9), "color": "#8C8C8C"}
    name = plot_text(specimen)
    return {
        "type": "scatter", "mode": "markers", "name": name, "x": [None], "y": [None],
        "marker": look,
    }  # fmt: skip
