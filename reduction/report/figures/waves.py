"""Figures of a wave load: both directions over time, the surface, the section in the water."""

from __future__ import annotations

import numpy as np

from reduction.pipeline.waveload import PredictedWaveLoad
from reduction.predict.motion import particle_motion
from reduction.report.decimate import keep_extremes
from reduction.report.figure import Figure, Trace, axis, line, make_figure, plain_numbers
from reduction.report.style import COLOURS, SYMBOLS, Shown, faded, shown
from reduction.units import UnitSystem

_IMPROVED, _CLASSIC, _DRAG, _WATER, _GREY = (COLOURS[k] for k in (0, 1, 2, 5, 6))
THEORY_NAMES = {"airy": "Airy", "stokes": "Stokes, second order"}
_UP = {"horizontal": "along the wave", "vertical": "upwards"}
_MOST_MARKS = 200
_CIRCLE = np.linspace(0.0, 2 * np.pi, 181)


def force_per_length(units: UnitSystem) -> Shown:
    """Return how a load per length of hose is shown."""
    force, length = shown("tension", units), shown("length", units)
    return Shown(f"{force.unit}/{length.unit}", force.factor / length.factor)


def draw_wave_load(found: PredictedWaveLoad, units: UnitSystem) -> list[Figure]:
    """Draw each direction over time: improved with its drag part, classic, extremes marked."""
    return [_direction(found, name, force_per_length(units)) for name in ("horizontal", "vertical")]


def _direction(found: PredictedWaveLoad, name: str, unit: Shown) -> Figure:
    load = found.load
    own, classic, drag = (
        unit.factor * getattr(load, f"{name}{ending}") for ending in ("", "_classic", "_drag")
    )
    kept = keep_extremes(load.time, own, classic)
    time = load.time[kept]
    data: list[Trace] = [
        line(time, own[kept], name="improved: the part under water", colour=_IMPROVED, width=2.6),
        line(time, classic[kept], name="classic: the whole section", colour=_CLASSIC, dash="dash"),
        line(time, drag[kept], name="drag of the improved", colour=_DRAG, dash="dot", width=1.4),
        _extremes(found, name, _IMPROVED, unit),
        _extremes(found, f"{name}_classic", _CLASSIC, unit),
    ]
    less = 100 * float(getattr(found.difference, f"{name}_of_maximum"))
    return make_figure(
        f"wave-{name}", f"{name.capitalize()} load per length",
        f"Above zero: {_UP[name]}. Marked: greatest and least load of a period, found between the"
        f" times that are drawn. At its greatest the improved load is {less:.3g} % less than the"
        " classic one, which takes the hose as wholly under water. What is not drag is inertia.",
        data, synthetic=False, height=420, is_wide=True,
        xaxis=axis("time [s]"), yaxis=axis(unit.label(f"{name} load")),
    )  # fmt: skip


def _extremes(found: PredictedWaveLoad, name: str, tint: str, unit: Shown) -> Trace:
    """Mark the extremes wherever they come again in the time that is drawn."""
    span = getattr(found.extremes, name)
    period = 2 * np.pi / found.wave.angular_frequency
    last = float(found.load.time[-1])
    times, loads = [], []
    for end in ("maximum", "minimum"):
        first = float(getattr(span, f"time_of_{end}"))
        again = np.arange(first, last * (1 + 1e-12), period)[:_MOST_MARKS]
        times.append(again)
        loads.append(np.full(again.size, unit.factor * float(getattr(span, end))))
    return {
        "type": "scatter", "mode": "markers", "name": "extremes", "showlegend": False,
        "x": plain_numbers(np.concatenate(times)), "y": plain_numbers(np.concatenate(loads)),
        "marker": {"symbol": SYMBOLS[2], "size": 9, "color": tint},
    }  # fmt: skip


def draw_surface(found: PredictedWaveLoad, units: UnitSystem) -> list[Figure]:
    """Draw the surface over time at the hose, with the level at which its water moves."""
    length = shown("length", units)
    time = found.load.time
    surface = length.factor * particle_motion(found.wave, time).elevation
    kept = keep_extremes(time, surface)
    level = np.full(2, length.factor * found.elevation)
    return [
        make_figure(
            "wave-surface", "Surface of the water at the hose",
            f"Above the mean level, by the theory of {THEORY_NAMES[found.used]}: crest at time"
            " zero. Velocities and accelerations are taken at the dashed level, not where the"
            " surface is.",
            [
                line(time[kept], surface[kept], name="surface", colour=_WATER, width=2.4),
                line(time[[0, -1]], level, name="level of the load", colour=_GREY, dash="dash",
                     width=1.4),
            ],
            synthetic=False, height=360,
            xaxis=axis("time [s]"), yaxis=axis(length.label("elevation")),
        )
    ]  # fmt: skip


def draw_section(found: PredictedWaveLoad, units: UnitSystem) -> list[Figure]:
    """Draw the section of the hose in still water, to scale."""
    small, section = shown("small length", units), found.load.section
    radius = small.factor * float(section.outer_diameter) / 2
    depth = small.factor * float(section.immersion_depth)
    centre = radius - depth
    x, y = radius * np.sin(_CIRCLE), centre - radius * np.cos(_CIRCLE)
    under = np.minimum(y, 0.0)  # what is cut off by the waterline stands on it
    chord = np.sqrt(np.maximum(radius**2 - centre**2, 0.0))
    wet_x = np.where(y > 0, np.clip(x, -chord, chord), x)
    share = 100 * float(section.submerged_share)
    reach = 1.5 * radius
    data: list[Trace] = [
        {
            "type": "scatter", "mode": "lines", "name": "under water", "fill": "toself",
            "x": plain_numbers(wet_x), "y": plain_numbers(under),
            "fillcolor": faded(_WATER, 0.45), "line": {"width": 0, "color": _WATER},
            "hoverinfo": "skip",
        },
        line(x, y, name="hose", colour=_IMPROVED, width=2.6),
        line(np.array([-reach, reach]), np.zeros(2), name="still water", colour=_WATER, width=1.8),
        line(np.full(2, 1.2 * radius), np.array([-depth, 0.0]), name="immersion depth",
             colour=_GREY, dash="dot", width=1.6),
    ]  # fmt: skip
    return [
        make_figure(
            "wave-section", "Section of the hose in still water",
            f"To scale. {share:.1f} % of the section is under water: its weight over that of the"
            f" water it displaces. Immersion depth {depth:.4g} {small.unit} of"
            f" {2 * radius:.4g} {small.unit}. The immersion is kept in the wave: the hose follows"
            " the surface.",
            data, synthetic=False, height=360,
            xaxis=axis(small.label("across"), range=[-reach, reach], zeroline=False),
            yaxis=axis(
                small.label("above still water"), scaleanchor="x", scaleratio=1, zeroline=False
            ),
        )
    ]  # fmt: skip
