"""Figures of a predicted hose: the forms of Figures 7 and 11 of [1]_, and what is uncertain.

References
----------
.. [1] W. Paul, "Hose Elements for Buoy Moorings: Design, Fabrication, and Mechanical
   Properties," Woods Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2004-06, 2004.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from reduction.predict.cord import NEUTRAL_ANGLE
from reduction.predict.designchart import cord_strain_chart
from reduction.record import Floats
from reduction.report.figure import Figure, Trace, axis, band, line, make_figure, plain_numbers
from reduction.report.hoseview import DEGREES, EVENT_WORDS, SOURCE_WORDS, HoseView, OneEvent
from reduction.report.style import COLOURS, Shown, colour, plot_text, shown, symbol

__all__ = [
    "draw_all_hoses", "draw_budget", "draw_chart", "draw_limits", "draw_pressure", "draw_tension",
]  # fmt: skip

_NET, _CORDS, _RUBBER = COLOURS[0], COLOURS[1], COLOURS[2]
_GREY = COLOURS[6]
_ALPHA = 0.22
_BAND = 2.0
"""Standard uncertainties on either side: a band of 95 %."""
_SLACK = "rgba(140,140,140,0.16)"
_FAMILY = (45.0, 50.0, float(np.degrees(NEUTRAL_ANGLE)), 58.0, 61.0, 64.0, 66.0, 68.0, 70.0, 72.0)
"""Wrap angles of the chart. [deg]"""
_AS_OWN = 0.75
"""A line of the chart nearer than this to that of the hose is not drawn. [deg]"""
_CHART_POINTS = 201
_LEAST_SHARE = 2.0
"""A source that never has so much of the variance stands with the others. [%]"""
_MOST_SOURCES = 6
_NEAR = 1.25
"""Cords within so many of their diameters of each other are worth a figure."""
_STATIC = (
    " From the static curve of one cord and a long, straight, closed hose full of water: nothing of"
    " cycles, speed, heat or compression is in it, and of the ends only the stated dead length."
)
_KINK = (
    ", a rough one near the strain of pick-up, where of all hoses in it some have slack cords and"
    " others not"
)
_WHERE = {"working": "the hose works", "cord_break": "it breaks"}
_DASHES = ("solid", "dash", "dot", "dashdot")
_SYMBOLS = {
    "deepest_slack": symbol(7), "pick_up": symbol(2), "working": symbol(0), "cord_break": symbol(5),
}  # fmt: skip
_SLACKEST = EVENT_WORDS["deepest_slack"]


def draw_tension(view: HoseView) -> list[Figure]:
    """Draw tension against strain, what carries it, and what happens on the way."""
    force = shown("tension", view.units)
    strain, tension = _percent(view), view.array("tension")
    spread = view.array_like("tension_standard_uncertainty", tension)
    # no tension, no share of it
    cords = np.where(tension == 0, 0.0, tension * view.array("cord_share"))
    data: list[Trace] = []
    if view.sources:
        data.append(_interval(strain, tension, spread, force.factor))
    data += [
        line(strain, force.factor * tension, name="net tension", colour=_NET, width=2.6),
        line(strain, force.factor * cords, name="cords, less the end cap", colour=_CORDS,
             dash="dash"),
        line(strain, force.factor * (tension - cords), name="rubber", colour=_RUBBER, dash="dot"),
    ]  # fmt: skip
    working = view.events["working"]
    if working.strain <= view.array("strain")[-1]:
        at, load = 100 * working.strain, force.factor * working.tension
        data.append(
            line(np.array([0.0, at, at]), np.array([load, load, 0.0]), name="safe working load",
                 colour=_GREY, dash="dashdot", width=1.4)
        )  # fmt: skip
    data += _events(view, "tension", force)
    about = f"Shaded blue: 95 % band (two standard uncertainties at held strain){_KINK}. "
    about = about if view.sources else ""
    grey = " Grey: cords slack, the rubber alone carries." if view.is_slack_at_first else ""
    return _kept(
        make_figure(
            f"{view.key}-tension", f"Predicted tension, hose {view.name}",
            f"{about}The safe working load is that of the hose where a cord has its working share"
            f" of its break load.{grey}{_STATIC}",
            data, synthetic=view.is_synthetic, height=460, is_wide=True,
            xaxis=_strain_axis(), yaxis=axis(force.label("tension"), rangemode="tozero"),
            **_slack_zone(view),
        )
    )  # fmt: skip


def draw_pressure(view: HoseView) -> list[Figure]:
    """Draw fill pressure against strain."""
    unit = shown("stress", view.units)
    strain, pressure = _percent(view), view.array("fill_pressure")
    spread = view.array_like("fill_pressure_standard_uncertainty", pressure)
    data: list[Trace] = []
    if view.sources:
        data.append(_interval(strain, pressure, spread, unit.factor))
    data.append(line(strain, unit.factor * pressure, name="fill pressure", colour=_NET, width=2.4))
    data += [mark for mark in _events(view, "fill_pressure", unit) if mark["name"] != _SLACKEST]
    about = f" Shaded blue: 95 % band{_KINK}." if view.sources else ""
    return _kept(
        make_figure(
            f"{view.key}-pressure", f"Predicted fill pressure, hose {view.name}",
            "In the bore, above the pressure outside: what the cords squeeze out of the water of a"
            f" closed hose; none while they are slack, and none in an open hose.{about}",
            data, synthetic=view.is_synthetic, height=400,
            xaxis=_strain_axis(), yaxis=axis(unit.label("fill pressure"), rangemode="tozero"),
            **_slack_zone(view),
        )
    )  # fmt: skip


def draw_budget(view: HoseView) -> list[Figure]:
    """Draw the share of each source in the variance of the tension."""
    if not view.sources:
        return []
    variance = np.array([view.contribution(name) ** 2 for name in view.sources])
    total = variance.sum(axis=0)
    kept = np.isfinite(total) & (total > 0)
    if not kept.any():
        return []
    names, share = _largest(view.sources, 100 * variance[:, kept] / total[kept])
    strain = _percent(view)[kept]
    return _kept(
        make_figure(
            f"{view.key}-budget", f"Where the uncertainty of tension comes from, hose {view.name}",
            "Share of each uncertain number in the variance of the tension at held strain. Sources"
            " are taken as independent; numbers without a stated uncertainty count as known.",
            [
                line(
                    strain, row, name=name, colour=colour(index), width=0.8, stackgroup="share"
                )
                for index, (name, row) in enumerate(zip(names, share, strict=True))
            ],
            synthetic=view.is_synthetic, height=400, xaxis=_strain_axis(),
            yaxis=axis("share of the variance [%]", range=[0, 100]),
        )
    )  # fmt: skip


def _largest(sources: Sequence[str], share: Floats) -> tuple[list[str], list[Floats]]:
    """Return sources by their greatest share, the small ones as one."""
    most = share.max(axis=1)
    order = np.argsort(-most, kind="stable")
    kept = [k for k in order[:_MOST_SOURCES] if most[k] >= _LEAST_SHARE]
    rest = [k for k in order if k not in kept]
    names = [SOURCE_WORDS.get(sources[k], sources[k].replace("_", " ")) for k in [*kept, *rest]]
    if len(rest) < 2:
        return names, [*share[[*kept, *rest]]]
    return [*names[: len(kept)], f"{len(rest)} others"], [*share[kept], share[rest].sum(axis=0)]


def draw_chart(view: HoseView) -> list[Figure]:
    """Draw cord strain over hose strain for a family of angles, with this hose's heavy."""
    working, at_break = view.events["working"], view.events["cord_break"]
    own, last = float(DEGREES.factor * view.wrap_angle), 1.05 * at_break.strain
    family = np.array([one for one in _FAMILY if abs(one - own) > _AS_OWN])
    along = np.linspace(0, last, _CHART_POINTS)
    chart = cord_strain_chart(
        np.radians(family), along, dead_length_share=view.scalar("dead_length_share")
    )
    data: list[Trace] = []
    for angle, row in zip(family, chart.cord_strain, strict=True):
        kept = row <= at_break.cord_strain
        data.append(
            _labelled(100 * along[kept], 100 * row[kept], angle)
            | {"showlegend": False, "line": {"color": _GREY, "width": 1.1}}
        )
    strain, cord = view.array("strain"), view.array("cord_strain")
    kept = cord <= at_break.cord_strain * (1 + 1e-9)
    data.append(
        line(100 * strain[kept], 100 * cord[kept], name=f"this hose, {own:.4g} deg", colour=_NET,
             width=3.4)
    )  # fmt: skip
    for event, dash in ((working, "dashdot"), (at_break, "dash")):
        data.append(
            line(np.array([0.0, 100 * last]), np.full(2, 100 * event.cord_strain),
                 name=f"cord strain where {_WHERE[event.name]}", colour=_CORDS, dash=dash,
                 width=1.2)
        )  # fmt: skip
    data += _events(view, "cord_strain", Shown("%", 100.0))
    return _kept(
        make_figure(
            f"{view.key}-chart", f"Cord strain over hose strain, hose {view.name}",
            "Each line is a wrap angle, given at its end in degrees from the axis, with the dead"
            " length of this hose; it ends where its cords break. Below zero a cord is slack: above"
            f" {np.degrees(NEUTRAL_ANGLE):.2f} degrees it is so at first. Geometry of a long hose"
            " that keeps its volume; no load is in it.",
            data, synthetic=view.is_synthetic, height=480, is_wide=True,
            xaxis=_strain_axis(range=[0, 104 * last]), yaxis=axis("strain of the cords [%]"),
        )
    )  # fmt: skip


def draw_limits(view: HoseView) -> list[Figure]:
    """Draw spacing of the cords and bore, each only where its limit is near or stated."""
    figures: list[Figure] = []
    strain, diameter = _percent(view), view.scalar("cord_diameter")
    ratio = view.array("cord_spacing") / diameter
    small = shown("small length", view.units)
    if np.nanmin(ratio) < _NEAR:
        figures.append(
            _limit(
                view, "spacing", "Spacing of the cords",
                "Between centres of neighbouring cords of one layer, over their diameter. Below one"
                " they touch: the layer jams, and the prediction does not hold.",
                strain, ratio, 1.0, "cord spacing over cord diameter [1]", "cords touch",
            )
        )  # fmt: skip
    least = view.scalar("minimum_inner_diameter")
    if least > 0:
        bore = small.factor * view.array("current_inner_diameter")
        figures.append(
            _limit(
                view, "bore", "Bore",
                "Of the stretched hose, whose volume is kept. Below its limit the prediction does"
                " not hold: what lies in the bore is squeezed.",
                strain, bore, small.factor * least, small.label("bore"), "least that is allowed",
            )
        )  # fmt: skip
    return figures


def _limit(
    view: HoseView, key: str, title: str, caption: str, strain: Floats, values: Floats,
    limit: float, label: str, words: str,
) -> Figure:  # fmt: skip
    return make_figure(
        f"{view.key}-{key}", f"{title}, hose {view.name}", caption,
        [
            line(strain, values, name=title.lower(), colour=_NET, width=2.4),
            line(strain[[0, -1]], np.full(2, limit), name=words, colour=_CORDS, dash="dash"),
        ],
        synthetic=view.is_synthetic, height=360, xaxis=_strain_axis(), yaxis=axis(label),
    )  # fmt: skip


def draw_all_hoses(views: Sequence[HoseView]) -> list[Figure]:
    """Draw the tension of several hoses in one figure; nothing for one alone."""
    if len(views) < 2:
        return []
    force = shown("tension", views[0].units)
    data: list[Trace] = []
    for index, view in enumerate(views):
        strain, tension = _percent(view), view.array("tension")
        name = f"{view.name}, {DEGREES.factor * view.wrap_angle:.4g} deg"
        if view.sources:
            spread = view.array_like("tension_standard_uncertainty", tension)
            data.append(_interval(strain, tension, spread, force.factor, colour(index)))
        data.append(
            line(strain, force.factor * tension, name=name, colour=colour(index), width=2.2,
                 dash=_DASHES[index // len(COLOURS) % len(_DASHES)])
        )  # fmt: skip
    for name in ("pick_up", "working", "cord_break"):
        shown_events = [
            (index, view.events[name])
            for index, view in enumerate(views)
            if _is_drawn(view, view.events[name])
        ]
        if shown_events:
            data.append(
                {
                    "type": "scatter", "mode": "markers", "name": shown_events[0][1].words,
                    "x": plain_numbers(np.array([100 * one.strain for _, one in shown_events])),
                    "y": plain_numbers(
                        force.factor * np.array([one.tension for _, one in shown_events])
                    ),
                    "marker": {
                        "symbol": _SYMBOLS[name], "size": 9,
                        "color": [colour(index) for index, _ in shown_events],
                    },
                }
            )  # fmt: skip
    about = " Shaded: 95 % band, where uncertainties are stated." if any(
        view.sources for view in views
    ) else ""  # fmt: skip
    return _kept(
        make_figure(
            "hoses-tension", "Predicted tension of all hoses",
            f"Net tension against strain of the whole length, events marked.{about}"
            " The hoses need not share a cord or a cross section." + _STATIC,
            data, synthetic=any(view.is_synthetic for view in views), height=480, is_wide=True,
            xaxis=_strain_axis(), yaxis=axis(force.label("tension"), rangemode="tozero"),
        )
    )  # fmt: skip


def _percent(view: HoseView) -> Floats:
    return 100 * view.array("strain")


def _strain_axis(**more: Any) -> dict[str, Any]:
    return axis("strain of the hose [%]", **more)


def _interval(
    strain: Floats, values: Floats, spread: Floats, factor: float, of_colour: str = _NET
) -> Trace:
    half = _BAND * spread
    return band(
        strain, factor * (values - half), factor * (values + half), name="95 % band",
        colour=of_colour, alpha=_ALPHA,
    )  # fmt: skip


def _is_drawn(view: HoseView, event: OneEvent) -> bool:
    """Whether an event lies on the curve; pick-up at rest is no event."""
    is_at_rest = event.name == "pick_up" and not view.is_slack_at_first
    return event.strain <= view.array("strain")[-1] * (1 + 1e-9) and not is_at_rest


def _events(view: HoseView, quantity: str, unit: Shown) -> list[Trace]:
    """One mark with its words an event; the slackest point is at the bottom of a bowl."""
    lowest = "bottom center" if quantity == "cord_strain" else "top center"
    return [
        {
            "type": "scatter", "mode": "markers+text", "name": event.words,
            "x": plain_numbers(np.array([100 * event.strain])),
            "y": plain_numbers(np.array([unit.factor * getattr(event, quantity)])),
            "text": [event.words], "showlegend": False,
            "textposition": lowest if event.words == _SLACKEST else "top left",
            "marker": {"symbol": _SYMBOLS[event.name], "size": 10, "color": _NET},
        }
        for event in view.events.values()
        if _is_drawn(view, event)
    ]  # fmt: skip


def _slack_zone(view: HoseView) -> dict[str, Any]:
    """Shade where the rubber alone carries."""
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


def _labelled(x: Floats, y: Floats, angle: float) -> Trace:
    """Return a line with its angle at its end."""
    text = f"{angle:.4g}"
    return {
        "type": "scatter", "mode": "lines+text", "name": plot_text(f"{text} deg"),
        "x": plain_numbers(x), "y": plain_numbers(y), "text": [*[""] * (x.size - 1), text],
        "textposition": "top center", "cliponaxis": False,
    }  # fmt: skip


def _kept(figure: Figure) -> list[Figure]:
    return [figure] if figure.has_data else []
