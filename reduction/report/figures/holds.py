"""Holds: tension (or strain) against the logarithm of time, and the Prony series on it."""

from __future__ import annotations

import numpy as np

from reduction.holds.series import prony_tension
from reduction.record import Floats
from reduction.report.decimate import POINTS, keep_extremes
from reduction.report.figure import Figure, Trace, axis, line, make_figure
from reduction.report.style import COLOURS, Kind, colour, marker, shown
from reduction.report.view import TestView

FIT_POINTS = 120
_FIT = COLOURS[6]
"""Of a fit upon any colour, on white and on black."""


def draw_holds(view: TestView) -> list[Figure]:
    """Draw one figure a specimen and kind of hold; a colour and a marker a hold."""
    time, start = view.array("time"), view.array("hold_start_time")
    if time is None or start is None or start.size == 0:
        return []
    owners = np.array(view.texts("hold_specimen"))
    kinds = np.array(view.texts("hold_kind"))
    found = []
    for index, specimen in enumerate(view.specimens):
        for kind in dict.fromkeys(kinds.tolist()):
            own = np.flatnonzero((owners == specimen) & (kinds == kind))
            traces: list[Trace] = []
            for hold in own:
                traces += _one_hold(view, time, index, int(hold), is_creep=kind == "creep")
            if not any(trace["y"] for trace in traces):
                continue
            what: Kind = "strain" if kind == "creep" else "tension"
            held = "constant tension" if kind == "creep" else "constant length"
            found.append(
                make_figure(
                    f"{view.key}-hold-{kind}-{index}", f"{view.id}: {kind}, {specimen}",
                    f"{what.capitalize()} in the holds at {held} against time since the hold"
                    " began; dashed grey: the fitted Prony series,"
                    " which is for a step in length, where the record supports one.",
                    traces, synthetic=view.is_synthetic,
                    xaxis=axis(
                        shown("time", view.units).label("time since the hold began"),
                        type="log", dtick=1,
                    ),
                    yaxis=axis(shown(what, view.units).label(what)),
                )
            )  # fmt: skip
    return found


def _one_hold(
    view: TestView, time: Floats, specimen: int, hold: int, *, is_creep: bool
) -> list[Trace]:
    start = view.array_like("hold_start_time", time)[hold]
    length = view.array_like("hold_duration", time)[hold]
    held = view.array("hold_strain")
    values = view.array("strain" if is_creep else "tension")
    if values is None:
        return []
    unit = shown("strain" if is_creep else "tension", view.units)
    # time zero has no logarithm
    own = np.flatnonzero((time > start) & (time <= start + length))
    if own.size == 0:
        return []
    since, y = time[own] - start, values[specimen, own] * unit.factor
    kept = keep_extremes(np.log10(since), y, limit=POINTS // 2)
    level = "" if held is None or np.isnan(held[hold]) else f", strain {100 * held[hold]:.0f} %"
    number = view.hold_numbers[hold]
    name, order = f"hold {number}{level}", number - 1
    fit = None if is_creep else _prony(view, hold, since)
    traces = [
        line(
            since[kept], y[kept], name=name, colour=colour(order), width=1.2, legendgroup=name,
            mode="lines+markers", marker={**marker(order), "maxdisplayed": 6},
            opacity=1.0 if fit is None else 0.55,
        )
    ]  # fmt: skip
    if fit is not None:
        moments, tension = fit
        traces.append(
            line(
                moments, tension * unit.factor, name=f"{name}: Prony series",
                colour=_FIT, dash="dash", width=1.8, legendgroup=name, showlegend=False,
            )
        )  # fmt: skip
    return traces


def _prony(view: TestView, hold: int, since: Floats) -> tuple[Floats, Floats] | None:
    tension, times = view.array("prony_tension"), view.array("prony_time")
    long_time = view.array("long_time_tension")
    if tension is None or times is None or long_time is None or np.isnan(long_time[hold]):
        return None
    given = np.isfinite(tension[hold]) & np.isfinite(times[hold])
    moments = np.geomspace(since[0], since[-1], FIT_POINTS)
    series = prony_tension(
        moments,
        tension=tension[hold, given],
        relaxation_time=times[hold, given],
        long_time_tension=float(long_time[hold]),
    )
    return moments, series
