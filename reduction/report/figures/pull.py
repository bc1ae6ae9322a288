"""A slow pull: load against strain, and the spring constant that is its slope."""

from __future__ import annotations

import numpy as np

from reduction.report.decimate import keep_extremes
from reduction.report.figure import Figure, Trace, axis, band, line, make_figure
from reduction.report.style import colour, shown
from reduction.report.uncertainty import NORMAL, expanded_of, plus_minus_of_tests
from reduction.report.view import TestView

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
            " range of use, beyond which it is not to be taken.",
            curves, synthetic=view.is_synthetic, height=400,
            xaxis=axis(percent.label("strain")), yaxis=axis(force.label("tension")),
        ),
        make_figure(
            f"{view.key}-pull-constant", f"{view.id}: quasi-static spring constant",
            "K_0, the slope of tension on strain, against tension: to be taken at the mean tension"
            " of interest."
            f" {_about_band(view)}",
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
