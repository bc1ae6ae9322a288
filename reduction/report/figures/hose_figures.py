"""Predicted hoses, and measured hoses beside them.

References
----------
.. [1] W. Paul, "Hose Elements for Buoy Moorings: Design, Fabrication, and Mechanical
   Properties," Woods Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2004-06, 2004.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from reduction.prediction.hose_geometry import NEUTRAL_ANGLE, cord_strain_chart
from reduction.record.measurement import Bools, Floats
from reduction.report.figure_data import (
    Figure,
    Trace,
    axis,
    band,
    if_any,
    line,
    make_figure,
    plain_numbers,
)
from reduction.report.product_views import (
    EVENT_WORDS,
    SOURCE_WORDS,
    ComparisonView,
    HoseView,
    OneEvent,
)
from reduction.report.test_view import NORMAL, expand, factor_words
from reduction.report.text_style import (
    COLOURS,
    DASHES,
    DEGREES,
    LINE_DASHES,
    SYMBOLS,
    Shown,
    colour,
    plot_text,
    shown,
    source_words,
    symbol,
)

NET, CORDS, RUBBER = COLOURS[0], COLOURS[1], COLOURS[2]

GREY = COLOURS[6]

EVENT_SYMBOLS = {
    "deepest_slack": symbol(7), "pick_up": symbol(2), "working": symbol(0), "cord_break": symbol(5),
}  # fmt: skip

SLACKEST = EVENT_WORDS["deepest_slack"]

_ALPHA = 0.22

_SLACK = "rgba(140,140,140,0.16)"


def _percent(view: HoseView | ComparisonView) -> Floats:
    """Strains of a hose as shown."""
    return 100 * view.array("strain")


def _strain_axis(**more: Any) -> dict[str, Any]:
    """Return the axis that all figures of a hose share."""
    return axis("strain of the hose [%]", **more)


def _interval(
    strain: Floats, values: Floats, spread: Floats, factor: float, of_colour: str = NET
) -> Trace:
    """Return the band of 95 %; broken where nothing is known."""
    half = NORMAL * spread
    return band(
        strain, factor * (values - half), factor * (values + half), name="95 % band",
        colour=of_colour, alpha=_ALPHA,
    )  # fmt: skip


def _is_drawn(view: HoseView, event: OneEvent) -> bool:
    """Return whether an event lies on the curve; pick-up at rest is no event."""
    is_at_rest = event.name == "pick_up" and not view.is_slack_at_first
    return event.strain <= view.array("strain")[-1] * (1 + 1e-9) and not is_at_rest


def _event_marks(view: HoseView, quantity: str, unit: Shown) -> list[Trace]:
    """Return a mark with its words for each event; the slackest point is the bottom of a bowl."""
    lowest = "bottom center" if quantity == "cord_strain" else "top center"
    return [
        {
            "type": "scatter", "mode": "markers+text", "name": event.words,
            "x": plain_numbers(np.array([100 * event.strain])),
            "y": plain_numbers(np.array([unit.factor * getattr(event, quantity)])),
            "text": [event.words], "showlegend": False,
            "textposition": lowest if event.words == SLACKEST else "top left",
            "marker": {"symbol": EVENT_SYMBOLS[event.name], "size": 10, "color": NET},
        }
        for event in view.events.values()
        if _is_drawn(view, event)
    ]  # fmt: skip


def _slack_zone(view: HoseView) -> dict[str, Any]:
    """Return the shade where the rubber alone carries."""
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


_FAMILY = (45.0, 50.0, float(np.degrees(NEUTRAL_ANGLE)), 58.0, 61.0, 64.0, 66.0, 68.0, 70.0, 72.0)
"""Wrap angles of the chart. [deg]"""

_AS_OWN = 0.75
"""A line of the chart nearer than this to that of the hose is not drawn. [deg]"""

_POINTS = 201

_NEAR = 1.25
"""Cords within so many of their diameters of each other are worth a figure."""

_WHERE = {"working": "the hose works", "cord_break": "it breaks"}


def draw_chart(view: HoseView) -> list[Figure]:
    """Draw cord strain over hose strain for a family of angles, with this hose's heavy."""
    working, at_break = view.events["working"], view.events["cord_break"]
    own, last = float(DEGREES.factor * view.wrap_angle), 1.05 * at_break.strain
    family = np.array([one for one in _FAMILY if abs(one - own) > _AS_OWN])
    along = np.linspace(0, last, _POINTS)
    chart = cord_strain_chart(
        np.radians(family), along, dead_length_share=view.scalar("dead_length_share")
    )
    data: list[Trace] = []
    for angle, row in zip(family, chart.cord_strain, strict=True):
        kept = row <= at_break.cord_strain
        data.append(
            _labelled(100 * along[kept], 100 * row[kept], angle)
            | {"showlegend": False, "line": {"color": GREY, "width": 1.1}}
        )
    strain, cord = view.array("strain"), view.array("cord_strain")
    kept = cord <= at_break.cord_strain * (1 + 1e-9)
    data.append(
        line(100 * strain[kept], 100 * cord[kept], name=f"this hose, {own:.4g} deg", colour=NET,
             width=3.4)
    )  # fmt: skip
    for event, dash in ((working, "dashdot"), (at_break, "dash")):
        data.append(
            line(np.array([0.0, 100 * last]), np.full(2, 100 * event.cord_strain),
                 name=f"cord strain where {_WHERE[event.name]}", colour=CORDS, dash=dash,
                 width=1.2)
        )  # fmt: skip
    data += _event_marks(view, "cord_strain", Shown("%", 100.0))
    return if_any(
        make_figure(
            f"{view.key}-chart", f"Cord strain over hose strain, hose {view.name}",
            "Each line is a wrap angle, given at its end in degrees from the axis, with the dead"
            " length of this hose; it ends where its cords break. Below zero a cord is slack, as it"
            f" is at first above {np.degrees(NEUTRAL_ANGLE):.2f} degrees. Geometry of a long hose"
            " of constant volume, without load.",
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
                "Spacing of neighbouring cords of one layer over cord diameter. Below 1 the cords"
                " touch and jam, and the prediction does not hold.",
                strain, ratio, 1.0, "cord spacing over cord diameter [1]", "cords touch",
            )
        )  # fmt: skip
    least = view.scalar("minimum_inner_diameter")
    if least > 0:
        bore = small.factor * view.array("current_inner_diameter")
        figures.append(
            _limit(
                view, "bore", "Bore",
                "Bore of the stretched hose at constant volume. Below its limit the prediction"
                " does not hold: the contents of the bore are squeezed.",
                strain, bore, small.factor * least, small.label("bore"), "minimum allowed",
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
            line(strain, values, name=title.lower(), colour=NET, width=2.4),
            line(strain[[0, -1]], np.full(2, limit), name=words, colour=CORDS, dash="dash"),
        ],
        synthetic=view.is_synthetic, height=360, xaxis=_strain_axis(), yaxis=axis(label),
    )  # fmt: skip


def _labelled(x: Floats, y: Floats, angle: float) -> Trace:
    """Return a line with its angle at its end."""
    text = f"{angle:.4g}"
    return {
        "type": "scatter", "mode": "lines+text", "name": plot_text(f"{text} deg"),
        "x": plain_numbers(x), "y": plain_numbers(y), "text": [*[""] * (x.size - 1), text],
        "textposition": "top center", "cliponaxis": False,
    }  # fmt: skip


_LEAST_SHARE = 2.0
"""A source that never has so much of the variance stands with the others. [%]"""

_MOST_SOURCES = 6

_FACTOR = factor_words([NORMAL])

_STATIC = (
    " From the static curve of one cord and a long, straight, closed, water-filled hose. Not"
    " included: cycling, rate, temperature, compression, and end effects beyond the stated dead"
    " length."
)

_KINK = (
    ", only approximate near the strain of pick-up, where some hoses in the band have slack cords"
    " and others do not"
)


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
    data += _event_marks(view, "tension", force)
    about = f"Shaded blue: 95 % band ({_FACTOR}, at held strain){_KINK}. "
    about = about if view.sources else ""
    grey = " Grey: cords slack, the rubber carries all load." if view.is_slack_at_first else ""
    return if_any(
        make_figure(
            f"{view.key}-tension", f"Predicted tension, hose {view.name}",
            f"{about}Safe working load: a cord carries its working share of its break"
            f" load.{grey}{_STATIC}",
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
    data.append(line(strain, unit.factor * pressure, name="fill pressure", colour=NET, width=2.4))
    data += [mark for mark in _event_marks(view, "fill_pressure", unit) if mark["name"] != SLACKEST]
    about = f" Shaded blue: 95 % band ({_FACTOR}){_KINK}." if view.sources else ""
    return if_any(
        make_figure(
            f"{view.key}-pressure", f"Predicted fill pressure, hose {view.name}",
            "Pressure in the bore of a closed hose above that outside, caused by the cords; zero"
            f" while they are slack and in an open hose.{about}",
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
    return if_any(
        make_figure(
            f"{view.key}-budget", f"Where the uncertainty of tension comes from, hose {view.name}",
            "Share of each uncertain number in the variance of the tension at held strain. Sources"
            " are taken as independent; numbers without a stated uncertainty are treated as exact.",
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
                 dash=LINE_DASHES[index // len(COLOURS) % len(LINE_DASHES)])
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
                        "symbol": EVENT_SYMBOLS[name], "size": 9,
                        "color": [colour(index) for index, _ in shown_events],
                    },
                }
            )  # fmt: skip
    about = f" Shaded: 95 % band ({_FACTOR}), where uncertainties are stated." if any(
        view.sources for view in views
    ) else ""  # fmt: skip
    return if_any(
        make_figure(
            "hoses-tension", "Predicted tension of all hoses",
            f"Net tension against strain of the whole length, events marked.{about}"
            " The hoses need not share a cord or a cross section." + _STATIC,
            data, synthetic=any(view.is_synthetic for view in views), height=480, is_wide=True,
            xaxis=_strain_axis(), yaxis=axis(force.label("tension"), rangemode="tozero"),
        )
    )  # fmt: skip


_PREDICTED, _MEASURED, _CALIBRATED, _GREY = COLOURS[0], COLOURS[1], COLOURS[2], COLOURS[6]

_EVENT_SYMBOLS = {"pick_up": SYMBOLS[2], "working": SYMBOLS[0], "break": SYMBOLS[5]}

_LEAST_TENSION = 0.05
"""Share of the greatest measured tension below which no difference is given relative to it."""

_NEAR_THE_END = 0.8

_PULLED = {"static": "solid", "dynamic": "dash"}


def draw_comparison(view: ComparisonView) -> list[Figure]:
    """Draw both branches and the judged curve of the test with the prediction and its band."""
    force = shown("tension", view.units)
    strain, predicted = _percent(view), force.factor * view.array("predicted_tension")
    measured = force.factor * view.of_curve("measured_tension", view.judged)
    banded = {
        "the prediction": (
            predicted,
            view.array_like("predicted_tension_standard_uncertainty", predicted),
            _PREDICTED,
        ),
        "the test": (
            measured,
            view.of_curve("measured_tension_standard_uncertainty", view.judged),
            _MEASURED,
        ),
    }
    data: list[Trace] = []
    for whose, (curve, spread, tint) in banded.items():
        half = NORMAL * force.factor * spread
        if np.any(half > 0):
            data.append(
                band(strain, curve - half, curve + half, name=f"95 % band of {whose}",
                     colour=tint, alpha=_ALPHA)
            )  # fmt: skip
    has_band = bool(data)
    data.append(line(strain, predicted, name="predicted", colour=_PREDICTED, width=2.6))
    calibrated = force.factor * view.array_like("calibrated_tension", predicted)
    if np.isfinite(calibrated).any():
        data.append(
            line(strain, calibrated, name="calibrated", colour=_CALIBRATED, dash="dashdot",
                 width=1.6)
        )  # fmt: skip
    data += [_measured(view, curve, force) for curve in view.curves]
    data += _events(view, force)
    judged = view.judged if view.judged == "midline" else f"{view.judged} branch"
    about = f"{_shaded(view)} " if has_band else ""
    fitted = " Calibrated: with the numbers fitted to this test." if view.fitted else ""
    return if_any(
        make_figure(
            f"{view.key}-tension", f"Measured and predicted tension, {view.name}",
            f"{about}Thick: the {judged} of the test, which is compared with the"
            f" prediction.{fitted} Filled marks: predicted cord events; open: where the test"
            " reached that tension.",
            data, synthetic=view.is_synthetic, height=460, is_wide=True,
            xaxis=_strain_axis(), yaxis=axis(force.label("tension"), rangemode="tozero"),
        )
    )  # fmt: skip


def draw_compared_pressure(view: ComparisonView) -> list[Figure]:
    """Draw measured and predicted fill pressure, each with its band."""
    unit, strain = shown("stress", view.units), _percent(view)
    data: list[Trace] = []
    for whose, tint in (("predicted", _PREDICTED), ("measured", _MEASURED)):
        curve = unit.factor * view.array_like(f"{whose}_fill_pressure", strain)
        spread = view.array_like(f"{whose}_fill_pressure_standard_uncertainty", strain)
        half = NORMAL * unit.factor * spread
        if np.any(half > 0):
            data.append(
                band(strain, curve - half, curve + half, name=f"95 % band of the {whose}",
                     colour=tint, alpha=_ALPHA)
            )  # fmt: skip
        data.append(line(strain, curve, name=whose, colour=tint, width=2.4))
    return if_any(
        make_figure(
            f"{view.key}-fill-pressure", f"Measured and predicted fill pressure, {view.name}",
            f"In the bore, above the pressure outside. Shaded: 95 % ({factor_words([NORMAL])}).",
            data, synthetic=view.is_synthetic, height=400,
            xaxis=_strain_axis(), yaxis=axis(unit.label("fill pressure"), rangemode="tozero"),
        )
    )  # fmt: skip


def _shaded(view: ComparisonView) -> str:
    """Say what the bands hold."""
    shared = ", ".join(source_words(one) for one in view.shared_sources)
    of_test = f"scatter, and errors common to all samples: {shared}" if shared else "scatter alone"
    return (
        f"Shaded: expanded uncertainty, 95 % ({factor_words([NORMAL])}), of the prediction from"
        f" the stated errors of the hose, and of the compared curve of the test: {of_test}."
    )


def draw_error(view: ComparisonView) -> list[Figure]:
    """Draw predicted minus measured tension within what it may be, and what calibration leaves."""
    force = shown("tension", view.units)
    strain = _percent(view)
    allowed = force.factor * view.allowed
    data: list[Trace] = [
        band(strain, -allowed, allowed, name="band of U", colour=_GREY, alpha=_ALPHA)
    ]
    for name in view.curves:
        if name != view.judged:
            apart = force.factor * view.of_curve("tension_difference", name)
            data.append(
                line(strain, apart, name=name, colour=_MEASURED, dash=DASHES[name], width=1)
            )
    data.append(
        line(strain, force.factor * view.difference, name=f"{view.judged}, judged",
             colour=_MEASURED, width=2.6)
    )  # fmt: skip
    left = force.factor * view.calibrated_difference
    if np.isfinite(left).any():
        data.append(
            line(strain, left, name="left by the calibration", colour=_CALIBRATED, dash="dashdot",
                 width=1.6)
        )  # fmt: skip
    data += _marked(view, force)
    bounds = (
        f" Shaded: U, {view.scalar('coverage_factor'):.2f} combined standard uncertainties of test"
        " and prediction; the largest ratio of a correct prediction stays below this in 95 % of"
        " cases."
        if np.any(allowed > 0)
        else ""
    )
    return if_any(
        make_figure(
            f"{view.key}-error", f"Comparison error, {view.name}",
            "Predicted minus measured tension: above zero the hose is softer than predicted."
            f"{bounds} Marked: the largest, and the largest relative to its uncertainty.",
            data, synthetic=view.is_synthetic, height=440, is_wide=True,
            xaxis=_strain_axis(), yaxis=axis(force.label("predicted minus measured")),
        )
    )  # fmt: skip


def draw_cycle_bias(view: ComparisonView) -> list[Figure]:
    """Draw the bias of each cycle over its number; nothing for a single one."""
    number, bias = view.array("comparison_cycle_number"), view.array("cycle_bias")
    force = shown("tension", view.units)
    known = np.isfinite(bias)
    if np.count_nonzero(known) < 2:
        return []
    number, bias = number[known], force.factor * bias[known]
    data: list[Trace] = [
        line(number, bias, name="bias of the cycle", colour=_MEASURED, width=1.2,
             mode="lines+markers", marker={"size": 7, "color": _MEASURED, "symbol": SYMBOLS[0]})
    ]  # fmt: skip
    slope = force.factor * view.scalar("bias_per_decade")
    about = ""
    if np.isfinite(slope):
        decade = np.log10(number)
        fitted = bias.mean() + slope * (decade - decade.mean())
        data.append(
            line(number, fitted, name="straight over decades", colour=_GREY, dash="dash", width=1.6)
        )
        spread = expand(
            force.factor * view.scalar("bias_per_decade_standard_uncertainty"),
            degrees_of_freedom=max(number.size - 2, 1),
        )
        about = (
            f" Dashed: {slope:+.3g} {force.unit} per decade, ± {float(spread.half):.2g}"
            f" {force.unit} (95 %, {factor_words(spread.factors)}, scatter about the line)."
        )
    # a bias that hardly moves would fill the height, and noise would look like a trend
    middle, reach = bias.mean(), max(np.ptp(bias), 0.02 * _greatest(view) * force.factor)
    return [
        make_figure(
            f"{view.key}-cycles", f"Bias cycle by cycle, {view.name}",
            "Mean of predicted minus measured tension over the strains, each cycle at its"
            f" {view.judged}: it rises where the hose softens.{about}",
            data, synthetic=view.is_synthetic, height=360,
            xaxis=axis("cycle number [1]", type="log", **_cycle_ticks(number)),
            yaxis=axis(force.label("bias"), range=[middle - reach, middle + reach]),
        )
    ]  # fmt: skip


def draw_all_comparisons(views: Sequence[ComparisonView]) -> list[Figure]:
    """Draw all tests with their predictions, and the relative differences; not for one alone."""
    if len(views) < 2:
        return []
    groups: dict[tuple[str, ...], list[ComparisonView]] = {}
    for view in views:
        groups.setdefault((view.test, view.specimen, view.hose, view.loading), []).append(view)
    firsts = [own[0] for own in groups.values()]
    names = [", ".join(view.name for view in own) for own in groups.values()]
    is_synthetic = any(view.is_synthetic for view in views)
    force = shown("tension", views[0].units)
    shares: list[Trace] = []
    for index, (first, name) in enumerate(zip(firsts, names, strict=True)):
        measured = first.of_curve("measured_tension", first.judged)
        counts = _is_worth_a_ratio(measured)
        share = np.full(measured.shape, np.nan)
        share[counts] = 100 * first.difference[counts] / measured[counts]
        shares.append(
            line(_percent(first), share, name=name, colour=colour(index),
                 dash=_PULLED.get(first.loading, "dot"), width=2)
        )  # fmt: skip
    return [
        *if_any(
            make_figure(
                "comparisons-tension", "Measured and predicted tension of the hoses",
                "Solid: predicted from construction alone, shaded with its 95 % interval. Dashed:"
                " measured in a static test, at the compared curve; dotted: in a dynamic test.",
                _tensions(firsts, names, force), synthetic=is_synthetic, height=460, is_wide=True,
                xaxis=_strain_axis(), yaxis=axis(force.label("tension"), rangemode="tozero"),
            )
        ),
        *if_any(
            make_figure(
                "comparisons-relative", "Relative difference of all comparisons",
                "Predicted minus measured over measured tension, at the compared curve of each;"
                " solid: static, dashed: dynamic. Left out where less than"
                f" {100 * _LEAST_TENSION:g} % of the peak tension was measured, where relative"
                " differences mean little.",
                shares, synthetic=is_synthetic, height=460, is_wide=True,
                xaxis=_strain_axis(), yaxis=axis("difference over measured tension [%]"),
            )
        ),
    ]  # fmt: skip


def _tensions(views: Sequence[ComparisonView], names: Sequence[str], force: Shown) -> list[Trace]:
    """Return the prediction of each hose, where it reaches farthest, and its measured curves."""
    hoses = dict.fromkeys(view.hose for view in views)
    data: list[Trace] = []
    for place, hose in enumerate(hoses):
        own = [view for view in views if view.hose == hose]
        farthest = max(own, key=lambda view: float(view.array("strain")[-1]))
        predicted = force.factor * farthest.array("predicted_tension")
        spread = farthest.array_like("predicted_tension_standard_uncertainty", predicted)
        half = NORMAL * force.factor * spread
        strain = _percent(farthest)
        if np.any(half > 0):
            data.append(
                band(strain, predicted - half, predicted + half, name=f"{hose}: 95 % interval",
                     colour=colour(place), alpha=_ALPHA)
            )  # fmt: skip
        data.append(
            line(strain, predicted, name=f"{hose}, predicted", colour=colour(place), width=2.6)
        )
    for view, name in zip(views, names, strict=True):
        data.append(
            line(
                _percent(view), force.factor * view.of_curve("measured_tension", view.judged),
                name=f"{name}, measured", colour=colour(list(hoses).index(view.hose)),
                dash="dot" if view.loading == "dynamic" else "dash", width=1.6,
            )
        )  # fmt: skip
    return data


def _measured(view: ComparisonView, curve: str, force: Shown) -> Trace:
    is_judged = curve == view.judged
    return line(
        _percent(view), force.factor * view.of_curve("measured_tension", curve),
        name=f"measured, {curve}", colour=_MEASURED, dash=DASHES.get(curve, "solid"),
        width=2.4 if is_judged else 1,
    )  # fmt: skip


def _events(view: ComparisonView, force: Shown) -> list[Trace]:
    """Mark each event that lies on the curves: as predicted, and where the test had its tension."""
    last = view.array("strain")[-1] * (1 + 1e-9)
    marks = []
    for event in view.events:
        sign = _EVENT_SYMBOLS.get(event.name, SYMBOLS[3])
        tension = force.factor * event.tension
        for strain, filling, tint, words in (
            (event.strain, "", _PREDICTED, event.words),
            (event.measured_strain, "-open", _MEASURED, ""),
        ):
            if 0 < strain <= last:
                mark = _mark(100 * strain, tension, event.words, words, sign + filling, tint)
                # beside a rising curve there is room on the right, but at the edge of the figure
                is_last = strain > _NEAR_THE_END * last
                marks.append(mark | {"textposition": "top left" if is_last else "bottom right"})
    return marks


def _marked(view: ComparisonView, force: Shown) -> list[Trace]:
    """Mark the greatest difference, and the largest ratio where it is elsewhere."""
    strain, apart = view.array("strain"), force.factor * view.difference
    places = {
        "greatest difference": view.judged_scalar("worst_strain"),
        "largest ratio": view.scalar("largest_ratio_strain"),
    }
    if places["greatest difference"] == places["largest ratio"]:
        places = {"greatest difference and ratio": places["largest ratio"]}
    marks = []
    for index, (words, at) in enumerate(places.items()):
        if np.isfinite(at):
            y = float(apart[np.argmin(np.abs(strain - at))])
            mark = _mark(100 * at, y, words, words, SYMBOLS[5 - 3 * index], _MEASURED)
            marks.append(mark | {"textposition": "bottom left" if y < 0 else "top left"})
    return marks


def _mark(x: float, y: float, name: str, words: str, sign: str, tint: str) -> Trace:
    return {
        "type": "scatter", "mode": "markers+text" if words else "markers", "name": name,
        "x": plain_numbers(np.array([x])), "y": plain_numbers(np.array([y])), "text": [words],
        "showlegend": False, "cliponaxis": False,
        "marker": {"symbol": sign, "size": 11, "color": tint, "line": {"width": 2}},
    }  # fmt: skip


def _greatest(view: ComparisonView) -> float:
    return float(np.nanmax(view.of_curve("measured_tension", view.judged)))


def _is_worth_a_ratio(measured: Floats) -> Bools:
    limit = _LEAST_TENSION * np.nanmax(measured)
    return np.asarray(np.nan_to_num(measured, nan=-np.inf) >= limit)


def _cycle_ticks(number: Floats) -> dict[str, Any]:
    """Ticks at 1, 2, 5 of each decade: plotly names none of a span shorter than one."""
    first, last = np.floor(np.log10(number[[0, -1]])).astype(int)
    ticks = [m * 10**p for p in range(first, last + 1) for m in (1, 2, 5)]
    kept = [tick for tick in ticks if number[0] <= tick <= number[-1]]
    is_long = number[-1] > 1e3 * number[0]
    if is_long:
        kept = [10**p for p in range(first, last + 2)]
    return {"tickvals": kept, "ticktext": [f"{tick:,}" for tick in kept]}
