"""Files of the figures of the reports: SVG, PNG and CSV of each, and a page of a report."""

from __future__ import annotations

import base64
import io
from collections.abc import Sequence
from dataclasses import dataclass
from importlib import import_module
from importlib.resources import files
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
from jinja2 import Environment, StrictUndefined

from reduction import __version__
from reduction.archive.atomic_write import atomic_file
from reduction.archive.csv_columns import Cell, csv_text
from reduction.lines.report_figures import Axis, FigureRow, ReportFigure, Series
from reduction.published.reproduce_page import TITLES
from reduction.quantities.units import UnitSystem
from reduction.record.errors import SettingsError
from reduction.record.measurement import Floats
from reduction.report.figure_data import plain_numbers
from reduction.report.text_style import (
    COLOURS,
    PERCENT,
    Shown,
    shown_unit,
    superscript,
    with_prefix,
)

_IN_SI = ("Zhang-2015", "Wang-2022")

_DASHES = ("-", "--", ":", "-.")

_STYLE = {
    "axes.grid": True, "axes.spines.right": False, "axes.spines.top": False,
    "axes.titlesize": "medium", "grid.color": "#dddddd", "font.size": 9.0,
    "svg.fonttype": "none", "svg.hashsalt": "figure",
}  # fmt: skip

_DIGITS = 9

_MOST_OWN = 6
"""Greatest number of own series that can be told apart; for more the table has the names."""

_MANY, _LONG = 12, 40
"""Legend lines from which three columns are used, and name length that allows only two."""


@dataclass(frozen=True)
class _FigureFiles:
    """Files of one figure, and its description on a page."""

    row: FigureRow
    slug: str
    image: str
    spoken: str
    paths: tuple[Path, ...]


def units_of_report(report: str, asked: str | None) -> UnitSystem:
    """Requested units, else those of the report."""
    if asked is None:
        return "si" if report in _IN_SI else "us"
    return "us" if asked == "us" else "si"


def write_figure(figure: ReportFigure, folder: Path, units: UnitSystem) -> _FigureFiles:
    """Write SVG, PNG and CSV of one figure.

    Raises
    ------
    SettingsError
        If matplotlib is not installed.
    """
    try:
        library = import_module("matplotlib")
        canvas = import_module("matplotlib.figure")
    except ImportError:
        raise SettingsError(
            "figures are drawn by matplotlib, which is not installed",
            found="no module matplotlib", needed='pip install "mooring-reduction[figures]"',
        ) from None  # fmt: skip
    slug = figure.row.figure.replace("(", "").replace(")", "")
    scales = [_scale(figure, place, units) for place in range(len(figure.axes))]
    contents = {"csv": _table(figure, scales).encode()}
    with library.rc_context(_STYLE):
        drawn = canvas.Figure(layout="constrained", figsize=(7.4, 5.0))
        _draw(drawn, figure, scales)
        for ending, more in (("svg", {"metadata": {"Date": None}}), ("png", {"dpi": 110})):
            buffer = io.BytesIO()
            drawn.savefig(buffer, format=ending, **more)
            contents[ending] = buffer.getvalue()
    paths = tuple(folder / f"figure-{slug}.{ending}" for ending in ("svg", "png", "csv"))
    for path in paths:
        with atomic_file(path) as part:
            part.write_bytes(contents[path.suffix[1:]])
    labels = "; ".join(filter(None, (scale.label for scale in scales)))
    names = ", ".join(one.name for one in figure.series)
    return _FigureFiles(
        figure.row, slug, base64.b64encode(contents["svg"]).decode(),
        f"{figure.row.shows}. Axes: {labels}. Drawn: {names}.", paths,
    )  # fmt: skip


def write_page(
    report: str,
    drawn: Sequence[_FigureFiles],
    rows: Sequence[FigureRow],
    folder: Path,
    campaign: str,
) -> Path:
    """Write the page of a report; it opens from disk and fetches nothing."""
    environment = Environment(
        autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    source = files("reduction.pages") / "templates" / "report-figures.html"
    style = files("reduction.report") / "static" / "page.css"
    text = environment.from_string(source.read_text("utf-8")).render(
        report=report, title=next(title for one, title in TITLES.items() if one == report),
        drawn=drawn, others=[row for row in rows if not row.is_drawn], campaign=campaign,
        version=__version__, style=style.read_text("utf-8"),
    )  # fmt: skip
    path = folder / "index.html"
    with atomic_file(path) as part:
        part.write_bytes(text.encode())
    return path


@dataclass(frozen=True)
class _Scale:
    """An axis as drawn."""

    label: str
    factor: float
    axis: Axis


def _scale(figure: ReportFigure, place: int, units: UnitSystem) -> _Scale:
    axis = figure.axes[place]
    if not axis.unit:
        return _Scale(axis.words, 1.0, axis)
    values = np.concatenate([getattr(one, "xyzw"[place]).ravel() for one in figure.series])
    shown = PERCENT if axis.unit == "1" else shown_unit(axis.unit, units)
    shown = with_prefix(shown, float(np.nanmax(np.abs(values))))
    label = Shown(superscript(shown.unit), shown.factor).label(axis.words)
    return _Scale(label, shown.factor, axis)


def _table(figure: ReportFigure, scales: Sequence[_Scale]) -> str:
    """Every drawn number, in the units of the axes."""
    labels = [scale.label or "place" for scale in scales]
    head = ["series", "own", *labels]
    if has_points := any(one.form == "points" for one in figure.series):
        value = labels[-1]
        head += [f"curve there: {value}", f"error of reading: {value}", "erratum"]
    whose = "yes, synthetic" if figure.is_synthetic else "yes"
    rows: list[list[Cell]] = []
    for one in figure.series:
        columns: list[Sequence[Cell]] = [
            plain_numbers(values.ravel(), _DIGITS) for values in _scaled(one, scales)
        ]
        if names := scales[0].axis.names:
            columns[0] = [names[int(place)].replace("\n", " ") for place in one.x]
        if has_points:
            extra = [np.full(one.x.shape, np.nan)] * 2
            if one.form == "points":
                extra = [scales[-1].factor * values for values in (one.computed, one.half)]
            columns += [plain_numbers(values, _DIGITS) for values in extra]
            columns.append(one.errata or ("",) * one.x.size)
        own = whose if one.is_own else "no"
        rows += [[one.name, own, *row] for row in zip(*columns, strict=True)]
    return csv_text(head, rows)


def _draw(drawn: Any, figure: ReportFigure, scales: Sequence[_Scale]) -> None:
    forms = {one.form for one in figure.series}
    told = "\nown lines: SYNTHETIC DATA" if figure.is_synthetic else ""
    drawn.suptitle(
        f"{figure.row.report}, Figure {figure.row.figure}: {figure.row.shows}{told}", wrap=True,
        fontsize="medium",
    )  # fmt: skip
    if "edges" in forms:
        _draw_cube(drawn, figure, scales)
    elif "surface" in forms:
        _draw_surfaces(drawn, figure, scales)
    else:
        _draw_lines(drawn.subplots(), figure, scales)


def _colour(one: Series) -> str:
    return "#000000" if one.colour < 0 else COLOURS[one.colour % len(COLOURS)]


def _name(one: Series) -> str:
    return f"own: {one.name}" if one.is_own else one.name


def _draw_lines(axes: Any, figure: ReportFigure, scales: Sequence[_Scale]) -> None:
    turn = -1 if figure.is_flipped else 1
    first, second = scales[::turn]
    bars = "xerr" if figure.is_flipped else "yerr"
    named: set[str] = set()
    own = sum(one.is_own for one in figure.series)
    # dashes that mean nothing else tell the lines apart in grey
    is_plain = not any(one.dash for one in figure.series)
    for one in figure.series:
        at = [scale.factor * values for scale, values in zip(scales, (one.x, one.y), strict=True)]
        name, colour = _name(one), _colour(one)
        if not np.isfinite(one.y).any():
            name += " (no curve)"  # only its printed points are drawn
        if one.is_own and own > _MOST_OWN:
            name, colour = f"own: {own} series, see the table", "#00000080"
        look: dict[str, Any] = {"color": colour, "label": None if name in named else name}
        if one.form == "curve":
            dash = _DASHES[(one.colour if is_plain else one.dash) % len(_DASHES)]
            axes.plot(*at[::turn], linestyle=dash, linewidth=2.2 if one.is_own else 1.5, **look)
            named.add(name)
            continue
        has_erratum = np.array([bool(erratum) for erratum in one.errata], dtype=bool)
        errata = ", ".join(dict.fromkeys(" ".join(one.errata).split()))
        # printed points lie on their curves: the legend explains them once
        usual = name if one.is_own or one.colour < 0 else "printed"
        for chosen, fill, name in (
            (~has_erratum, colour, usual), (has_erratum, "none", f"printed, {errata}"),
        ):  # fmt: skip
            if chosen.any():
                bar = {bars: scales[1].factor * np.nan_to_num(one.half[chosen])}
                look |= {"label": None if name in named else name, "markerfacecolor": fill}
                axes.errorbar(
                    *(values[chosen] for values in at[::turn]), **bar, **look, linestyle="none",
                    marker="s" if one.dash else "o", markersize=5.0, capsize=2.0,
                    zorder=3.0,  # own lines must not hide printed ones
                )  # fmt: skip
                named.add(name)
    axes.set(xlabel=first.label, ylabel=second.label)
    if first.axis.is_log:
        axes.set_xscale("log")
    else:
        axes.xaxis.set_major_formatter("{x:,.6g}")
    axes.yaxis.set_major_formatter("{x:,.6g}")
    if first.axis.names:
        axes.set_xticks(range(len(first.axis.names)), first.axis.names, fontsize="x-small")
        axes.set_ylim(bottom=0.0)
    _legend(axes)


def _legend(axes: Any) -> None:
    """Place the legend below the drawing."""
    names = axes.get_legend_handles_labels()[1]
    are_short = max(map(len, names)) < _LONG
    axes.figure.legend(
        loc="outside lower center", fontsize="x-small",
        ncols=3 if are_short and len(names) > _MANY else 2,
    )  # fmt: skip


def _draw_surfaces(drawn: Any, figure: ReportFigure, scales: Sequence[_Scale]) -> None:
    """Surfaces in space, and their contours."""
    drawn.set_size_inches(10.0, 5.0)
    space = drawn.add_subplot(1, 2, 1, projection="3d")
    flat = drawn.add_subplot(1, 2, 2)
    for one in figure.series:
        x, y, z = _scaled(one, scales)
        space.plot_wireframe(x, y, z, color=_colour(one), linewidth=0.7, label=_name(one))
        if np.ptp(z[:, 0]):  # K_0 does not change with the amplitude
            lines = flat.contour(x, y, z, 8, colors=_colour(one), linewidths=1.0)
            flat.clabel(lines, fontsize=7.0, fmt=lambda value: f"{value:,.6g}")
    _in_space(space, scales[:3])
    for axis in (flat.xaxis, flat.yaxis):
        axis.set_major_formatter("{x:,.6g}")
    flat.set(xlabel=scales[0].label, ylabel=scales[1].label, title=f"contours of {scales[2].label}")
    _legend(space)


def _draw_cube(drawn: Any, figure: ReportFigure, scales: Sequence[_Scale]) -> None:
    """Twelve edges, and the value at each corner."""
    space = drawn.add_subplot(projection="3d")
    for one in figure.series:
        x, y, value, w = _scaled(one, scales)
        for first, last in combinations(range(8), 2):
            ends = [first, last]
            # corners are numbered by bits: an edge joins two that differ in one bit
            if (first ^ last).bit_count() == 1:
                space.plot(x[ends], y[ends], w[ends], color=_colour(one), linewidth=1.2)
        for at in range(value.size):
            space.text(x[at], y[at], w[at], f" {value[at]:,.5g}", fontsize="small", weight="bold")
        space.plot([], [], [], color=_colour(one), label=f"{_name(one)}: {scales[2].label}")
    _in_space(space, (scales[0], scales[1], scales[3]))
    _legend(space)


def _scaled(one: Series, scales: Sequence[_Scale]) -> list[Floats]:
    return [scale.factor * getattr(one, name) for name, scale in zip("xyzw", scales, strict=False)]


def _in_space(space: Any, scales: Sequence[_Scale]) -> None:
    space.set(xlabel=scales[0].label, ylabel=scales[1].label, zlabel=scales[2].label)
    space.set_box_aspect(None, zoom=0.8)
    space.view_init(elev=25.0, azim=-125.0)
    space.tick_params(labelsize="x-small")
    space.locator_params(nbins=5)
    for axis in (space.xaxis, space.yaxis, space.zaxis):
        axis.set_major_formatter("{x:,.6g}")
