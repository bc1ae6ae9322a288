"""Loads of a predicted hose over its strain: the form of Figure 11 of [1]_; uncertainty.

References
----------
.. [1] W. Paul, "Hose Elements for Buoy Moorings: Design, Fabrication, and Mechanical
   Properties," Woods Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2004-06, 2004.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reduction.record import Floats
from reduction.report.figure import Figure, Trace, axis, line, make_figure, plain_numbers
from reduction.report.figures.hosemarks import (
    CORDS,
    GREY,
    NET,
    RUBBER,
    SLACKEST,
    SYMBOLS,
    event_marks,
    interval,
    is_drawn,
    kept_figure,
    percent,
    slack_zone,
    strain_axis,
)
from reduction.report.hoseview import SOURCE_WORDS, HoseView
from reduction.report.style import COLOURS, DEGREES, colour, shown
from reduction.report.uncertainty import NORMAL, factor_words

_LEAST_SHARE = 2.0
"""A source that never has so much of the variance stands with the others. [%]"""
_MOST_SOURCES = 6
_FACTOR = factor_words([NORMAL])
_DASHES = ("solid", "dash", "dot", "dashdot")
_STATIC = (
    " From the static curve of one cord and a long, straight, closed hose full of water: nothing of"
    " cycles, speed, heat or compression is in it, and of the ends only the stated dead length."
)
_KINK = (
    ", a rough one near the strain of pick-up, where of all hoses in it some have slack cords and"
    " others not"
)


def draw_tension(view: HoseView) -> list[Figure]:
    """Draw tension against strain, what carries it, and what happens on the way."""
    force = shown("tension", view.units)
    strain, tension = percent(view), view.array("tension")
    spread = view.array_like("tension_standard_uncertainty", tension)
    # no tension, no share of it
    cords = np.where(tension == 0, 0.0, tension * view.array("cord_share"))
    data: list[Trace] = []
    if view.sources:
        data.append(interval(strain, tension, spread, force.factor))
    data += [
        line(strain, force.factor * tension, name="net tension", colour=NET, width=2.6),
        line(strain, force.factor * cords, name="cords, less the end cap", colour=CORDS,
             dash="dash"),
        line(strain, force.factor * (tension - cords), name="rubber", colour=RUBBER, dash="dot"),
    ]  # fmt: skip
    working = view.events["working"]
    if working.strain <= view.array("strain")[-1]:
        at, load = 100 * working.strain, force.factor * working.tension
        data.append(
            line(np.array([0.0, at, at]), np.array([load, load, 0.0]), name="safe working load",
                 colour=GREY, dash="dashdot", width=1.4)
        )  # fmt: skip
    data += event_marks(view, "tension", force)
    about = f"Shaded blue: 95 % band ({_FACTOR}, at held strain){_KINK}. "
    about = about if view.sources else ""
    grey = " Grey: cords slack, the rubber alone carries." if view.is_slack_at_first else ""
    return kept_figure(
        make_figure(
            f"{view.key}-tension", f"Predicted tension, hose {view.name}",
            f"{about}The safe working load is that of the hose where a cord has its working share"
            f" of its break load.{grey}{_STATIC}",
            data, synthetic=view.is_synthetic, height=460, is_wide=True,
            xaxis=strain_axis(), yaxis=axis(force.label("tension"), rangemode="tozero"),
            **slack_zone(view),
        )
    )  # fmt: skip


def draw_pressure(view: HoseView) -> list[Figure]:
    """Draw fill pressure against strain."""
    unit = shown("stress", view.units)
    strain, pressure = percent(view), view.array("fill_pressure")
    spread = view.array_like("fill_pressure_standard_uncertainty", pressure)
    data: list[Trace] = []
    if view.sources:
        data.append(interval(strain, pressure, spread, unit.factor))
    data.append(line(strain, unit.factor * pressure, name="fill pressure", colour=NET, width=2.4))
    data += [mark for mark in event_marks(view, "fill_pressure", unit) if mark["name"] != SLACKEST]
    about = f" Shaded blue: 95 % band ({_FACTOR}){_KINK}." if view.sources else ""
    return kept_figure(
        make_figure(
            f"{view.key}-pressure", f"Predicted fill pressure, hose {view.name}",
            "In the bore, above the pressure outside: what the cords squeeze out of the water of a"
            f" closed hose; none while they are slack, and none in an open hose.{about}",
            data, synthetic=view.is_synthetic, height=400,
            xaxis=strain_axis(), yaxis=axis(unit.label("fill pressure"), rangemode="tozero"),
            **slack_zone(view),
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
    strain = percent(view)[kept]
    return kept_figure(
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
            synthetic=view.is_synthetic, height=400, xaxis=strain_axis(),
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


def draw_all_hoses(views: Sequence[HoseView]) -> list[Figure]:
    """Draw the tension of several hoses in one figure; nothing for one alone."""
    if len(views) < 2:
        return []
    force = shown("tension", views[0].units)
    data: list[Trace] = []
    for index, view in enumerate(views):
        strain, tension = percent(view), view.array("tension")
        name = f"{view.name}, {DEGREES.factor * view.wrap_angle:.4g} deg"
        if view.sources:
            spread = view.array_like("tension_standard_uncertainty", tension)
            data.append(interval(strain, tension, spread, force.factor, colour(index)))
        data.append(
            line(strain, force.factor * tension, name=name, colour=colour(index), width=2.2,
                 dash=_DASHES[index // len(COLOURS) % len(_DASHES)])
        )  # fmt: skip
    for name in ("pick_up", "working", "cord_break"):
        shown_events = [
            (index, view.events[name])
            for index, view in enumerate(views)
            if is_drawn(view, view.events[name])
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
                        "symbol": SYMBOLS[name], "size": 9,
                        "color": [colour(index) for index, _ in shown_events],
                    },
                }
            )  # fmt: skip
    about = f" Shaded: 95 % band ({_FACTOR}), where uncertainties are stated." if any(
        view.sources for view in views
    ) else ""  # fmt: skip
    return kept_figure(
        make_figure(
            "hoses-tension", "Predicted tension of all hoses",
            f"Net tension against strain of the whole length, events marked.{about}"
            " The hoses need not share a cord or a cross section." + _STATIC,
            data, synthetic=any(view.is_synthetic for view in views), height=480, is_wide=True,
            xaxis=strain_axis(), yaxis=axis(force.label("tension"), rangemode="tozero"),
        )
    )  # fmt: skip
