"""A response surface: over two loads in space, as contours at three levels, on the cube.

The cube is that of Figure 6 of [1]_; contours say, as it does not, where the runs say less
than at the worst of them.

References
----------
.. [1] CG-D-39-80, sec. 4.4.
"""

from __future__ import annotations

import numpy as np

from reduction.record import Bools, Floats
from reduction.report.experimentview import ExperimentView, in_words, response_unit
from reduction.report.figure import Figure, Trace, axis, make_figure, plain_numbers
from reduction.report.htmltable import number_text
from reduction.report.style import COLOURS, faded, plot_text
from reduction.report.surfacegrid import HELD, Planes, runs_on_plane
from reduction.surface.bands import evaluate_surfaces
from reduction.surface.product import ResponseSurfaces
from reduction.surface.tested import ABOVE_LEVERAGE
from reduction.vocabulary import RESPONSES

_SCALE = [[0.0, "#e4eef6"], [0.5, "#97c4e3"], [1.0, "#3a8fc8"]]
"""Light enough everywhere for dark labels upon it."""
_INK, _GREY = "#1b1f23", "#8C8C8C"
_DIGITS = 4


def base_response(name: str) -> str:
    """Return the response that a surface is of, before any transform.

    Examples
    --------
    >>> base_response("log_hysteresis_energy")
    'hysteresis_energy'
    """
    return next(base for base in RESPONSES if name.endswith(base))


def draw_surface(
    view: ExperimentView, surfaces: ResponseSurfaces, index: int, planes: Planes
) -> list[Figure]:
    """Draw the surface over two factors, the third in the middle, and the runs made there."""
    name = surfaces.response_names[index]
    unit = response_unit(base_response(name), view.units)
    words = in_words(base_response(name))
    x, y = (_shown(view, place, planes.coded) for place in planes.across)
    middle = planes.value[index, 1] * unit.factor
    data: list[Trace] = [
        {
            "type": "surface", "name": "surface", "x": plain_numbers(x), "y": plain_numbers(y),
            "z": [plain_numbers(row, _DIGITS) for row in middle], "colorscale": _SCALE,
            "showscale": False, "showlegend": False, "opacity": 0.92,
            "contours": {"z": {"show": True, "color": faded("#000000", 0.25)}},
        }
    ]  # fmt: skip
    data += _points_in_space(view, surfaces, index, planes)
    held, level = view.factors[planes.held], view.levels(planes.held)[1]
    title = f"{view.name}: {words} at {_at(view, planes.held, level)}"
    return _given(
        make_figure(
            f"{view.key}-{name}-surface", title,
            f"Surface of the {words} over {in_words(view.factors[planes.across[0]])} and"
            f" {in_words(view.factors[planes.across[1]])}, {in_words(held)} held in the middle of"
            f" its range{scale_words(name)}. Points: the runs made at this {in_words(held)}, lines"
            " their distance from the surface. Turn it with the pointer; the same values"
            " stand in the contours, whose SVG is lines throughout.",
            data, synthetic=view.is_synthetic, height=430,
            scene={
                "xaxis": axis(view.factor_label(planes.across[0])),
                "yaxis": axis(view.factor_label(planes.across[1])),
                "zaxis": axis(unit.label(words).replace(" ", "<br>", 1)),
                "camera": {
                    "eye": {"x": -1.4, "y": -1.58, "z": 0.8},
                    "center": {"x": 0, "y": 0, "z": -0.15},
                },
                "aspectmode": "cube",
            },
        )
    )  # fmt: skip


def draw_contours(
    view: ExperimentView, surfaces: ResponseSurfaces, index: int, planes: Planes
) -> list[Figure]:
    """Draw contours at the low, middle and high level of the held factor, one scale for all."""
    name = surfaces.response_names[index]
    unit = response_unit(base_response(name), view.units)
    words = in_words(base_response(name))
    x, y = (_shown(view, place, planes.coded) for place in planes.across)
    value = planes.value[index] * unit.factor
    if not np.isfinite(value).any():
        return []
    ends = {"zmin": float(np.nanmin(value)), "zmax": float(np.nanmax(value))}
    found = []
    for place, level in enumerate(HELD):
        ratio = planes.leverage_ratio[index, place]
        data: list[Trace] = [
            {
                "type": "contour", "name": words, "showlegend": False, **ends,
                "x": plain_numbers(x), "y": plain_numbers(y),
                "z": [plain_numbers(row, _DIGITS) for row in value[place]],
                "colorscale": _SCALE, "line": {"color": _INK, "width": 0.8},
                "contours": {"coloring": "fill", "showlabels": True,
                             "labelfont": {"color": _INK, "size": 10}},
                "colorbar": {
                    "title": {"text": unit.unit}, "thickness": 10, "tickfont": {"size": 10},
                    "exponentformat": "none", "separatethousands": True,
                },
            }
        ]  # fmt: skip
        is_thin = bool((ratio > ABOVE_LEVERAGE).any())
        if is_thin:
            data.append(_thin_region(x, y, ratio))
        on_plane = runs_on_plane(view, planes, level)
        points, labels = _points_on_plane(view, planes, on_plane)
        data += points
        at = _at(view, planes.held, view.levels(planes.held)[place])
        says = (
            " Grey: the runs say less there than at the worst of them (leverage above the greatest"
            " of a run); a value there leans on the form of the surface."
            if is_thin
            else ""
        )
        found.append(
            make_figure(
                f"{view.key}-{name}-contour-{place}", f"{view.name}: {words} at {at}",
                f"Contours of the {words}{scale_words(name)} at {at}. Points: the runs made there."
                f"{says}",
                data, synthetic=view.is_synthetic, height=380, annotations=labels,
                xaxis=axis(view.factor_label(planes.across[0])),
                yaxis=axis(view.factor_label(planes.across[1])),
            )
        )  # fmt: skip
    return found


def _shown(view: ExperimentView, place: int, coded: Floats) -> Floats:
    low, middle, high = view.levels(place)
    return middle + coded * (high - low) / 2


def _levels_reached(view: ExperimentView, place: int) -> Floats:
    return view.array("run_level")[:, place] * view.factor_units[place].factor


def _at(view: ExperimentView, place: int, level: float) -> str:
    return f"{number_text(level, 3)} {view.factor_units[place].unit}"


def scale_words(name: str) -> str:
    """Say on what scale a surface was fitted where it was not the response itself."""
    if name == base_response(name):
        return ""
    scale = "logarithm" if name.startswith("log_") else "Box-Cox transform"
    return f", fitted to its {scale} and brought back (medians)"


def _given(figure: Figure) -> list[Figure]:
    return [figure] if figure.has_data else []


def _points_in_space(
    view: ExperimentView, surfaces: ResponseSurfaces, index: int, planes: Planes
) -> list[Trace]:
    """Return the runs of the middle plane, and a line from each to the surface there."""
    name = base_response(surfaces.response_names[index])
    factor = response_unit(name, view.units).factor
    measured = view.per_run(f"{name}_measured")
    own = runs_on_plane(view, planes, 0.0) & np.isfinite(measured)
    if not own.any():
        return []
    x, y = (_levels_reached(view, place)[own] for place in planes.across)
    at = evaluate_surfaces(
        surfaces, view.array("run_coded_level")[own], units="coded", outside="flag"
    )
    z, foot = measured[own] * factor, at.value[index] * factor
    gap = np.full(z.size, np.nan)
    stems = {
        key: plain_numbers(np.stack(values, axis=1).ravel())
        for key, values in (("x", (x, x, gap)), ("y", (y, y, gap)), ("z", (z, foot, gap)))
    }
    return [
        {
            "type": "scatter3d", "mode": "lines", "name": "distance", "showlegend": False,
            "line": {"color": COLOURS[1], "width": 4}, "hoverinfo": "skip", **stems,
        },
        {
            "type": "scatter3d", "mode": "markers", "name": "runs", "showlegend": False,
            "x": plain_numbers(x), "y": plain_numbers(y), "z": plain_numbers(z),
            "text": [plot_text(run) for run, one in zip(view.runs, own, strict=True) if one],
            "marker": {"size": 4.5, "color": COLOURS[1]},
        },
    ]  # fmt: skip


def _points_on_plane(
    view: ExperimentView, planes: Planes, own: Bools
) -> tuple[list[Trace], list[Trace]]:
    """Return the runs of a plane at the levels they reached, and their labels; repeats have one."""
    if not own.any():
        return [], []
    cells = view.per_run("run_cell")
    x, y = (_levels_reached(view, place) for place in planes.across)
    middle = np.mean(view.levels(planes.across[0]))
    places = np.flatnonzero(own)
    labels: list[Trace] = []
    for k in places:
        mates = [j for j in places if cells[j] == cells[k] and cells[k] > 0] or [k]
        if mates[0] != k:
            continue
        # a veil behind it, or the numbers of the contours run through it
        is_left = bool(x[k] < middle)
        labels.append(
            {
                "text": plot_text(", ".join(view.runs[j] for j in mates)), "showarrow": False,
                "x": plain_numbers(x[k : k + 1])[0], "y": plain_numbers(y[k : k + 1])[0],
                "xanchor": "left" if is_left else "right", "xshift": 8 if is_left else -8,
                "font": {"size": 10, "color": _INK}, "bgcolor": "rgba(255,255,255,0.8)",
                "borderpad": 1,
            }
        )  # fmt: skip
    points: Trace = {
        "type": "scatter", "mode": "markers", "name": "runs", "showlegend": False,
        "x": plain_numbers(x[own]), "y": plain_numbers(y[own]), "cliponaxis": False,
        "text": [plot_text(view.runs[k]) for k in places],
        "marker": {"size": 9, "color": COLOURS[1], "line": {"width": 1.5, "color": "#ffffff"}},
    }  # fmt: skip
    return [points], labels


def _thin_region(x: Floats, y: Floats, ratio: Floats) -> Trace:
    """Return a grey veil with a dashed edge where the leverage is above that of every run.

    Plotly fills what does not meet a constraint.
    """
    return {
        "type": "contour", "name": "runs say little", "showlegend": False, "showscale": False,
        "x": plain_numbers(x), "y": plain_numbers(y),
        "z": [plain_numbers(row, 3) for row in ratio], "hoverinfo": "skip",
        "contours": {"type": "constraint", "operation": "<", "value": ABOVE_LEVERAGE},
        "fillcolor": faded("#555555", 0.38), "line": {"color": _INK, "width": 1.5, "dash": "dash"},
    }  # fmt: skip
