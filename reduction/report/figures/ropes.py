"""The programme of a rope: stiffness against tension, stiffness and creep against time."""

from __future__ import annotations

import numpy as np

from reduction.record import Floats
from reduction.report.figure import Figure, Trace, axis, line, make_figure, plain_numbers
from reduction.report.ropeview import RopeView, expanded_property
from reduction.report.style import colour, marker, plot_text, shown
from reduction.report.uncertainty import factor_words

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
            "Force per unit strain. Bars across: the tensions it is between, cycle or holds; bars"
            f" up: expanded uncertainty (95 %, {factor_words(spread.factors)}).",
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
