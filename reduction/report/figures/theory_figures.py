"""Armour and wave loads."""

from __future__ import annotations

from typing import Any

import numpy as np

from reduction.prediction.armour import (
    ARMOUR_QUANTITIES,
    SIMPLER_THEORIES,
    ArmourTheory,
    PredictedArmour,
    predict_armour,
    theory_errors,
    wound_at_all_angles,
)
from reduction.prediction.wave_load import PredictedWaveLoad
from reduction.prediction.wave_theory import particle_motion
from reduction.quantities.units import UnitSystem
from reduction.record.measurement import Floats
from reduction.report.figure_data import (
    Figure,
    Trace,
    axis,
    keep_extremes,
    line,
    make_figure,
    plain_numbers,
)
from reduction.report.text_style import COLOURS, SYMBOLS, Shown, faded, plot_text, shown

THEORY_WORDS = {
    "small": "small angles",
    "intermediate": "intermediate angles",
    "large": "large angles, a spring",
    "exact": "exact",
    "conjugate": "with an energy",
}

_COLOUR = {name: COLOURS[k] for name, k in zip(THEORY_WORDS, (4, 1, 3, 0, 2), strict=True)}

_DASH = {
    "small": "dash", "intermediate": "dot", "large": "longdash", "exact": "solid",
    "conjugate": "dashdot",
}  # fmt: skip

_WORDS = {
    "axial_force": "axial force",
    "shear_force": "shear force",
    "bending_moment": "bending moment",
    "torsion_moment": "torsion moment",
}

_DRAWN: tuple[ArmourTheory, ...] = ("exact", "conjugate", "small", "intermediate", "large")
"""Those that nearly agree lie dashed on the exact one."""

_MARGIN = 0.35

_LEAST_ERROR, _MOST_ERROR = -3.0, 3.0
"""Powers of ten of a percent that are drawn."""

_ABOUT = {
    "axial_force": "Along the wire: the cross section times its stress.",
    "shear_force": "On the section of the wire, along its binormal.",
    "bending_moment": "Above zero where it bends the wire more.",
    "torsion_moment": "About the wire. With the report's moments it vanishes and changes sign at"
    " 45 degrees; a rod with a strain energy has torsion there.",
}


def of_layers(found: PredictedArmour, name: str) -> Floats:
    """Return a number of the design, one a layer."""
    design = found.layers.design
    return np.broadcast_to(np.asarray(getattr(design, name), dtype=np.float64), design.shape)


def moment_unit(units: UnitSystem) -> Shown:
    """Return how a moment is shown."""
    force, length = shown("tension", units), shown("length", units)
    return Shown(f"{force.unit} {length.unit}", force.factor * length.factor)


def draw_wire(found: PredictedArmour, units: UnitSystem) -> list[Figure]:
    """Draw forces and moments of one wire of the first layer, were it wound at any angle."""
    designs = wound_at_all_angles(found.layers.design, 0)
    angle = np.degrees(designs.winding_angle)
    responses = {theory: predict_armour(designs, found.strain, theory=theory) for theory in _DRAWN}
    figures = []
    for name, words in _WORDS.items():
        unit = shown("tension", units) if name.endswith("force") else moment_unit(units)
        curves = {
            theory: unit.factor * getattr(response, name)[:, 0]
            for theory, response in responses.items()
        }
        reach, beyond = _reach(curves)
        figures.append(
            make_figure(
                f"armour-{name.replace('_', '-')}", f"{words.capitalize()} of one wire",
                f"{_ABOUT[name]} {_of_wire(found)}{beyond}",
                [
                    line(
                        angle, curve,
                        name=THEORY_WORDS[theory], colour=_COLOUR[theory], dash=_DASH[theory],
                        width=3 if theory == "exact" else 1.8,
                    )
                    for theory, curve in curves.items()
                ],
                synthetic=False, height=400, xaxis=_angle_axis(),
                yaxis=axis(unit.label(words), range=reach),
                **_own_angle(found),
            )
        )  # fmt: skip
    return figures


def draw_errors(found: PredictedArmour) -> list[Figure]:
    """Draw the size of the error of each theory against the exact rod, heavy where it holds."""
    designs = wound_at_all_angles(found.layers.design, 0)
    errors, use = theory_errors(designs, found.strain), found.use[0]
    angle = np.degrees(designs.winding_angle)
    tolerance = 100 * found.tolerance
    figures = []
    for j, quantity in enumerate(ARMOUR_QUANTITIES):
        words = _WORDS[quantity]
        data: list[Trace] = []
        for i, theory in enumerate(SIMPLER_THEORIES):
            size = 100 * np.abs(errors[i, j, :, 0])
            size = np.where(size > 0, size, np.nan)  # a logarithm has no zero
            within = np.where(use.is_within[i, j], size, np.nan)
            tint, name = _COLOUR[theory], THEORY_WORDS[theory]
            data.append(line(angle, size, name=name, colour=tint, dash=_DASH[theory], width=1.4))
            data.append(
                line(angle, within, name=f"{name}, holds", colour=tint, width=4, showlegend=False)
            )
        data.append(
            line(angle[[0, -1]], np.full(2, tolerance), name=f"tolerance, {tolerance:g} %",
                 colour=COLOURS[6], dash="solid", width=1)
        )  # fmt: skip
        relative = (
            " Relative to the torsion moment of the whole change of curvature and torsion, since"
            " the moment itself passes zero."
            if quantity == "torsion_moment"
            else ""
        )
        figures.append(
            make_figure(
                f"armour-error-{quantity.replace('_', '-')}", f"Error of the {words}",
                f"Magnitude of (theory - exact) / exact; thick: within {tolerance:g} %. More than"
                f" 1000 % and less than 0.001 % are not drawn.{relative} {_of_wire(found)}",
                data, synthetic=False, height=400, xaxis=_angle_axis(),
                yaxis=axis("error against exact [%]", type="log", exponentformat="power",
                           **_decades(data)),
                **_own_angle(found),
            )
        )  # fmt: skip
    return figures


def _of_wire(found: PredictedArmour) -> str:
    return (
        f"Wire and core of layer {found.layer_names[0]} at {100 * float(found.strain[0]):g} % of"
        " strain of the cable, wound at any angle; dotted: its actual angle."
    )


def _angle_axis() -> dict[str, Any]:
    return axis("winding angle from the axis [deg]", range=[0, 90], dtick=15)


def _own_angle(found: PredictedArmour) -> dict[str, Any]:
    """Mark the angle at which the layer is wound."""
    own = float(np.degrees(of_layers(found, "winding_angle")[0]))
    return {
        "shapes": [
            {
                "type": "line", "xref": "x", "yref": "paper", "x0": own, "x1": own, "y0": 0,
                "y1": 1, "line": {"color": COLOURS[6], "dash": "dot", "width": 1.5},
            }
        ],
        "annotations": [
            {
                "text": plot_text(f"{found.layer_names[0]}, {own:.4g} deg", 24), "x": own,
                "y": 1.0, "xref": "x", "yref": "paper", "yanchor": "bottom", "showarrow": False,
                "font": {"size": 10},
            }
        ],
    }  # fmt: skip


def _reach(curves: dict[ArmourTheory, Floats]) -> tuple[list[float], str]:
    """Range of the theories of a wire on a core, and what to say where the spring leaves it."""
    on_core = np.concatenate([curve for theory, curve in curves.items() if theory != "large"])
    spare = _MARGIN * np.ptp(on_core) or 1.0  # nothing happens without strain
    low, high = float(on_core.min() - spare), float(on_core.max() + spare)
    is_beyond = bool(np.any((curves["large"] < low) | (curves["large"] > high)))
    return [low, high], " The spring leaves the figure." if is_beyond else ""


def _decades(data: list[Trace]) -> dict[str, Any]:
    """Keep a zero of an error, and a theory that is quite wrong, from taking all the height."""
    known = np.array([y for trace in data for y in trace["y"] if y is not None], dtype=np.float64)
    top, bottom = np.ceil(np.log10(known.max())), np.floor(np.log10(known.min()))
    return {"range": [max(float(bottom), _LEAST_ERROR), min(float(top), _MOST_ERROR)], "dtick": 1}


_IMPROVED, _CLASSIC, _DRAG, _WATER, _GREY = (COLOURS[k] for k in (0, 1, 2, 5, 6))

THEORY_NAMES = {
    "airy": "Airy",
    "stokes": "Stokes, second order",
    "stokes 3": "Stokes, third order",
    "stokes 5": "Stokes, fifth order",
    "stream function": "the stream function",
}

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
        " classic one, which assumes full immersion. The rest of the load is inertia.",
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
            f" water that it displaces. Immersion depth {depth:.4g} {small.unit} of"
            f" {2 * radius:.4g} {small.unit}. The immersion is constant: the hose follows the"
            " surface.",
            data, synthetic=False, height=360,
            xaxis=axis(small.label("across"), range=[-reach, reach], zeroline=False),
            yaxis=axis(
                small.label("above still water"), scaleanchor="x", scaleratio=1, zeroline=False
            ),
        )
    ]  # fmt: skip
