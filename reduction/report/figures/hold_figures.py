"""Holds, slow pulls and rope programmes."""

from __future__ import annotations

import numpy as np

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
from reduction.report.product_views import RopeView, expanded_property
from reduction.report.test_view import (
    NORMAL,
    TestView,
    expanded_of,
    factor_words,
    plus_minus_of_tests,
)
from reduction.report.text_style import COLOURS, Kind, colour, marker, plot_text, shown
from reduction.stages.holds.prony_series import prony_tension

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
                    " began; dashed grey: the fitted Prony series, where the"
                    " record supports one.",
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
    fit = None if is_creep else _prony(view, hold, since, start)
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


def _prony(view: TestView, hold: int, since: Floats, start: float) -> tuple[Floats, Floats] | None:
    names = ("prony_tension", "prony_fraction_at_ramp_end", "prony_time")
    found = [view.array(name) for name in names]
    long_time, ended = view.array("long_time_tension"), view.array("hold_ramp_end_time")
    if long_time is None or np.isnan(long_time[hold]):
        return None
    tension, left, times = (one[hold] for one in found if one is not None)
    given = np.isfinite(tension)
    moments = np.geomspace(since[0], since[-1], FIT_POINTS)
    end = start if ended is None or np.isnan(ended[hold]) else float(ended[hold])
    series = prony_tension(
        moments + start - end,
        tension=(tension * left)[given],
        relaxation_time=times[given],
        long_time_tension=float(long_time[hold]),
    )
    return moments, series


_GREY = "#8C8C8C"


def draw_pull(view: TestView) -> list[Figure]:
    """Draw the load-strain curve of a slow pull, and the spring constant that is its slope."""
    grid, strain = view.array("tension_grid"), view.array("quasi_static_strain")
    constant = view.array("quasi_static_spring_constant")
    if grid is None or strain is None or constant is None:
        return []
    half = expanded_of(view, "quasi_static_spring_constant", constant).half
    force, percent = shown("tension", view.units), shown("strain", view.units)
    curves: list[Trace] = []
    slopes: list[Trace] = []
    for k, name in enumerate(view.specimens):
        if not np.isfinite(strain[k]).any():
            continue
        tint = colour(k)
        curves += _logged(view, k, percent.factor, force.factor)
        curves.append(
            line(
                strain[k] * percent.factor, grid * force.factor,
                name=f"{name}: cubic, range of use", colour=tint, width=2.2,
            )
        )  # fmt: skip
        low, high = (constant[k] + sign * half[k] for sign in (-1, 1))
        slopes += [
            band(
                grid * force.factor, low * force.factor, high * force.factor, name=name,
                colour=tint, alpha=0.25,
            ),
            line(grid * force.factor, constant[k] * force.factor, name=name, colour=tint),
        ]  # fmt: skip
    figures = (
        make_figure(
            f"{view.key}-pull", f"{view.id}: load against strain, slow pull",
            "Tension against strain as logged (grey), and strain as a cubic of tension over its"
            " range of use. Do not use it beyond that range.",
            curves, synthetic=view.is_synthetic, height=400,
            xaxis=axis(percent.label("strain")), yaxis=axis(force.label("tension")),
        ),
        make_figure(
            f"{view.key}-pull-constant", f"{view.id}: quasi-static spring constant",
            "K_0, the slope of tension on strain, against tension. Use the value at the mean"
            f" tension of interest. {_about_band(view)}",
            slopes, synthetic=view.is_synthetic, height=400,
            xaxis=axis(force.label("tension")),
            yaxis=axis(force.label("K_0"), rangemode="tozero"),
        ),
    )  # fmt: skip
    return [figure for figure in figures if figure.has_data]


def _about_band(view: TestView) -> str:
    return plus_minus_of_tests(
        [NORMAL], [view], ["quasi_static_spring_constant"], mark="Band",
        found_from="scatter about the cubic",
    )  # fmt: skip


def _logged(view: TestView, place: int, to_x: float, to_y: float) -> list[Trace]:
    strain, tension = view.array("strain"), view.array("tension")
    if strain is None or tension is None:
        return []
    known = np.isfinite(strain[place]) & np.isfinite(tension[place])
    x, y = strain[place, known] * to_x, tension[place, known] * to_y
    if x.size == 0:
        return []
    kept = keep_extremes(np.arange(x.size, dtype=np.float64), y)
    return [
        line(x[kept], y[kept], name=f"{view.specimens[place]}: as logged", colour=_GREY, width=5,
             opacity=0.5)
    ]  # fmt: skip


_STIFFNESS = ("original stiffness", "static stiffness", "dynamic stiffness")

_POINTS = 41


def draw_stiffness(view: RopeView) -> list[Figure]:
    """Draw the three stiffnesses against the tensions that they are between."""
    force = shown("tension", view.units)
    low, high = view.array("property_low_tension"), view.array("property_high_tension")
    values = view.array("property_stiffness")
    spread = expanded_property(view, "property_stiffness")
    data: list[Trace] = []
    for index, name in enumerate(_STIFFNESS):
        rows = view.rows_of(name)
        if rows:
            data.append(
                {
                    "type": "scatter",
                    "mode": "markers",
                    "name": plot_text(name),
                    "x": plain_numbers(force.factor * (low[rows] + high[rows]) / 2),
                    "y": plain_numbers(force.factor * values[rows]),
                    "error_x": _bars(force.factor * (high[rows] - low[rows]) / 2, index, 1),
                    "error_y": _bars(force.factor * spread.half[rows], index, 2),
                    "marker": marker(index, size=9),
                    "text": [plot_text(view.texts("property_test")[row]) for row in rows],
                }
            )
    if not data:
        return []
    return [
        make_figure(
            f"{view.key}-stiffness", f"Stiffness against tension, {view.specimen}",
            "Force per unit strain. Horizontal bars: tension range of the cycle or holds;"
            f" vertical bars: expanded uncertainty (95 %, {factor_words(spread.factors)}).",
            data, synthetic=view.is_synthetic, height=400,
            xaxis=axis(force.label("tension"), rangemode="tozero"),
            yaxis=axis(force.label("stiffness"), rangemode="tozero"),
        )
    ]  # fmt: skip


def _bars(values: Floats, index: int, width: int) -> dict[str, object]:
    return {
        "type": "data", "array": plain_numbers(values), "color": colour(index), "thickness": width,
    }  # fmt: skip


def draw_held_pairs(view: RopeView) -> list[Figure]:
    """Draw the static stiffness of each pair of holds against time since loading."""
    force, seconds = shown("tension", view.units), shown("time", view.units)
    data: list[Trace] = []
    for index, (test, pair) in enumerate(view.entries("held_pair", "static_stiffness_at_time")):
        elapsed, stiffness, level, slope, at, low, high = (
            np.asarray(test.data[name].values[pair], dtype=np.float64)
            for name in (
                "static_elapsed_time", "static_stiffness_at_time", "static_stiffness",
                "static_stiffness_per_decade", "static_reference_time", "held_pair_low_tension",
                "held_pair_high_tension",
            )
        )  # fmt: skip
        known = np.isfinite(elapsed) & np.isfinite(stiffness)
        if not known.any():
            continue
        ends = force.factor * np.array([low, high])
        name = f"{test.id}, {ends[0]:,.0f} to {ends[1]:,.0f} {force.unit}"
        span = np.geomspace(min(elapsed[known].min(), at), max(elapsed[known].max(), at), _POINTS)
        data += [
            {
                "type": "scatter",
                "mode": "markers",
                "name": plot_text(name, 60),
                "x": plain_numbers(elapsed[known]),
                "y": plain_numbers(force.factor * stiffness[known]),
                "marker": marker(index),
                "legendgroup": f"{index}",
            },
            line(
                span, force.factor * (level + slope * np.log10(span / at)), name="line in log time",
                colour=colour(index), legendgroup=f"{index}", showlegend=False,
            ),
            {
                "type": "scatter",
                "mode": "markers",
                "name": "at the reference time",
                "x": plain_numbers(np.atleast_1d(at)),
                "y": plain_numbers(force.factor * np.atleast_1d(level)),
                "marker": {"color": colour(index), "symbol": "circle-open", "size": 14},
                "legendgroup": f"{index}",
                "showlegend": not data,
            },
        ]  # fmt: skip
    if not data:
        return []
    return [
        make_figure(
            f"{view.key}-static", f"Static stiffness against time, {view.specimen}",
            "Secant from the end of the lower hold into the higher one, against time since the"
            " centre of the ramp. Line: straight in the logarithm of time; ring: the value at the"
            " reference time.",
            data, synthetic=view.is_synthetic, height=400,
            xaxis=axis(seconds.label("time since loading"), type="log", dtick=1),
            yaxis=axis(force.label("static stiffness")),
        )
    ]  # fmt: skip


def draw_creep(view: RopeView) -> list[Figure]:
    """Draw the strain of each hold that has a creep rate, from the reference time on."""
    force, seconds = shown("tension", view.units), shown("time", view.units)
    percent = shown("strain", view.units)
    times_of_polymer = view.array("property_reference_time")[view.rows_of("polymer strain")]
    if not times_of_polymer.size:
        return []
    at = float(times_of_polymer[0])
    data: list[Trace] = []
    kept = set(zip(view.texts("property_test"), view.names, strict=True))
    entries = [
        (test, hold)
        for test, hold in view.entries("hold", "strain_at_time")
        if (test.id, "polymer strain") in kept
    ]
    for index, (test, hold) in enumerate(entries):
        rate, start, duration, centre, first, last = (
            float(test.data[name].values[hold])
            for name in (
                "creep_rate_per_decade", "hold_start_time", "hold_duration",
                "hold_ramp_centre_time", "hold_initial_tension", "hold_final_tension",
            )
        )  # fmt: skip
        strain = np.asarray(test.data["strain_at_time"].values[hold], dtype=np.float64)
        delay = start - centre if np.isfinite(centre) else 0.0
        since = np.asarray(test.data["hold_time"].values, dtype=np.float64) + delay
        known = np.isfinite(strain)
        if not (known.any() and np.isfinite(rate)):
            continue
        since, strain = since[known], strain[known]
        # the straight line runs through the latest point, where its time counts least
        gained = strain - strain[-1] + rate * np.log10(since[-1] / at)
        span = np.geomspace(since[0], delay + duration, _POINTS)
        name = f"{test.id}, {force.factor * (first + last) / 2:,.0f} {force.unit}"
        data += [
            {
                "type": "scatter",
                "mode": "markers",
                "name": plot_text(name, 60),
                "x": plain_numbers(since),
                "y": plain_numbers(percent.factor * gained),
                "marker": marker(index, size=8),
                "legendgroup": f"{index}",
            },
            line(
                span, percent.factor * rate * np.log10(span / at), name="creep per decade",
                colour=colour(index), legendgroup=f"{index}", showlegend=False,
            ),
        ]  # fmt: skip
    if not data:
        return []
    return [
        make_figure(
            f"{view.key}-creep", f"Creep, {view.specimen}",
            f"Strain gained since {at:g} s after the centre of the ramp. Line: the creep per decade"
            " of the hold, through its latest point; its right end is the polymer strain.",
            data, synthetic=view.is_synthetic, height=400,
            xaxis=axis(seconds.label("time since loading"), type="log", dtick=1),
            yaxis=axis(percent.label("strain gained")),
        )
    ]  # fmt: skip
