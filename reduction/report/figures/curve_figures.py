"""Figures of a composite curve with its pieces, and of a deployed assembly."""

from __future__ import annotations

import numpy as np

from reduction.lines.assembly import DeployedLine
from reduction.lines.composite import CompositeCurve, PieceSource
from reduction.quantities.units import UnitSystem
from reduction.record.measurement import Bools, Floats
from reduction.report.figure_data import Figure, Trace, axis, band, line, make_figure, plain_numbers
from reduction.report.test_view import NORMAL, factor_words
from reduction.report.text_style import COLOURS, SYMBOLS, colour, shown

_CURVE, *_PIECES = COLOURS

_DASHES = {"cyclic": "solid", "static": "dash", "first-loading": "dot"}


def draw_composite(source: PieceSource, curve: CompositeCurve, units: UnitSystem) -> Figure:
    """Draw the curve with its uncertainty over its pieces; gaps are dotted."""
    percent, force = shown("strain", units), shown("tension", units)
    strain, load = percent.factor * curve.strain, force.factor * curve.tension
    spread = NORMAL * force.factor * curve.standard_uncertainty
    used = set(curve.piece_names)
    names = list(dict.fromkeys(one.name for one in source.pieces))
    data: list[Trace] = [
        band(
            strain, load - spread, load + spread, name="expanded uncertainty, 95 %", colour=_CURVE,
            alpha=0.13,
        )
    ]  # fmt: skip
    named: set[str] = set()
    for one in source.pieces:
        if one.name not in used:
            continue
        tint = _PIECES[names.index(one.name) % len(_PIECES)]
        data.append(
            line(
                percent.factor * one.strain, force.factor * one.tension,
                name=f"{one.name}, {one.kind}", colour=tint, dash=_DASHES[one.kind], width=1.4,
                showlegend=f"{one.name} {one.kind}" not in named,
            )
        )  # fmt: skip
        named.add(f"{one.name} {one.kind}")
    data += [
        line(strain, _of(load, ~curve.is_gap), name="composite", colour=_CURVE, width=3.4),
        line(
            strain, _of(load, curve.is_gap), name="gap", colour=_CURVE, dash="dot", width=1.8,
        ),
    ]  # fmt: skip
    return make_figure(
        "composite", f"Composite curve of {source.name}",
        "Thick: the curve, dotted where no piece reaches, with its expanded uncertainty (95 %,"
        f" {factor_words([NORMAL])}). Thin: its pieces, solid of cycles, dashed of static tests,"
        " dotted of first rises.",
        data, synthetic=source.is_synthetic, height=520, is_wide=True,
        xaxis=axis(percent.label("strain")), yaxis=axis(force.label("tension")),
    )  # fmt: skip


def _of(values: Floats, flags: Bools) -> Floats:
    """Values at the ends of the intervals that have a flag; NaN elsewhere."""
    ends = np.concatenate([[False], flags]) | np.concatenate([flags, [False]])
    return np.where(ends, values, np.nan)


def draw_assembly(found: DeployedLine, units: UnitSystem) -> Figure:
    """Draw tension against length with its uncertainty, and the working points."""
    assembly = found.deployed.assembly
    length, force = shown("length", units), shown("tension", units)
    at, load = length.factor * assembly.total_length, force.factor * assembly.tension
    spread = NORMAL * force.factor * assembly.standard_uncertainty
    data: list[Trace] = [
        band(
            at, load - spread, load + spread, name="expanded uncertainty, 95 %", colour=COLOURS[0],
            alpha=0.15,
        ),
        line(
            at, np.where(assembly.is_tested, load, np.nan), name="assembly", colour=COLOURS[0],
            width=2.6,
        ),
        line(
            at, np.where(assembly.is_tested, np.nan, load), name="not tested", colour=COLOURS[0],
            dash="dot",
        ),
    ]  # fmt: skip
    for number, state in enumerate(found.deployed.working, start=1):
        point, tint = state.point, colour(number)
        ends = np.array([point.minimum_tension, point.mean_tension, point.peak_tension])
        lengths = np.array([point.minimum_length, point.total_length, point.peak_length])
        data.append(
            {
                "type": "scatter", "mode": "lines+markers", "name": f"working point {number}",
                "x": plain_numbers(length.factor * lengths),
                "y": plain_numbers(force.factor * ends),
                "line": {"color": tint, "width": 3},
                "marker": {"color": tint, "size": 9, "symbol": SYMBOLS[number % len(SYMBOLS)]},
            }
        )  # fmt: skip
    return make_figure(
        "assembly", f"Tension of {found.name}",
        f"Band: expanded uncertainty (95 %, {factor_words([NORMAL])}). Dotted where a tether is at"
        " a strain that no test reaches. Marked: working points, with"
        " their cycles from valley to peak.",
        data, synthetic=found.source.is_synthetic, height=460, is_wide=True,
        xaxis=axis(length.label("length")), yaxis=axis(force.label("tension")),
    )  # fmt: skip


def draw_stiffness(found: DeployedLine, units: UnitSystem) -> Figure:
    """Draw the tangent EA against tension."""
    force = shown("tension", units)
    load = force.factor * found.deployed.assembly.tension
    stiffness = force.factor * found.deployed.apparent_spring_constant
    data = [line(load, stiffness, name="EA", colour=COLOURS[1])]
    return make_figure(
        "assembly-stiffness", "Stiffness",
        "EA, tangent, over the length at which the assembly goes slack. Its steps are those of the"
        " composite curve, where pieces hand over.",
        data, synthetic=found.source.is_synthetic,
        xaxis=axis(force.label("tension")), yaxis=axis(force.label("EA")),
    )  # fmt: skip
