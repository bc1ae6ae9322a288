"""Geometry of a predicted hose: the design chart of Figure 7 of [1]_, spacing, bore.

References
----------
.. [1] W. Paul, "Hose Elements for Buoy Moorings: Design, Fabrication, and Mechanical
   Properties," Woods Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2004-06, 2004.
"""

from __future__ import annotations

import numpy as np

from reduction.predict.designchart import cord_strain_chart
from reduction.predict.helix import NEUTRAL_ANGLE
from reduction.record import Floats
from reduction.report.figure import Figure, Trace, axis, line, make_figure, plain_numbers
from reduction.report.figures.hosemarks import (
    CORDS,
    GREY,
    NET,
    event_marks,
    kept_figure,
    percent,
    strain_axis,
)
from reduction.report.hoseview import HoseView
from reduction.report.style import DEGREES, Shown, plot_text, shown

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
    data += event_marks(view, "cord_strain", Shown("%", 100.0))
    return kept_figure(
        make_figure(
            f"{view.key}-chart", f"Cord strain over hose strain, hose {view.name}",
            "Each line is a wrap angle, given at its end in degrees from the axis, with the dead"
            " length of this hose; it ends where its cords break. Below zero a cord is slack: above"
            f" {np.degrees(NEUTRAL_ANGLE):.2f} degrees it is so at first. Geometry of a long hose"
            " that keeps its volume; no load is in it.",
            data, synthetic=view.is_synthetic, height=480, is_wide=True,
            xaxis=strain_axis(range=[0, 104 * last]), yaxis=axis("strain of the cords [%]"),
        )
    )  # fmt: skip


def draw_limits(view: HoseView) -> list[Figure]:
    """Draw spacing of the cords and bore, each only where its limit is near or stated."""
    figures: list[Figure] = []
    strain, diameter = percent(view), view.scalar("cord_diameter")
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
            line(strain, values, name=title.lower(), colour=NET, width=2.4),
            line(strain[[0, -1]], np.full(2, limit), name=words, colour=CORDS, dash="dash"),
        ],
        synthetic=view.is_synthetic, height=360, xaxis=strain_axis(), yaxis=axis(label),
    )  # fmt: skip


def _labelled(x: Floats, y: Floats, angle: float) -> Trace:
    """Return a line with its angle at its end."""
    text = f"{angle:.4g}"
    return {
        "type": "scatter", "mode": "lines+text", "name": plot_text(f"{text} deg"),
        "x": plain_numbers(x), "y": plain_numbers(y), "text": [*[""] * (x.size - 1), text],
        "textposition": "top center", "cliponaxis": False,
    }  # fmt: skip
