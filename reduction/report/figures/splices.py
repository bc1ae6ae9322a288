"""How the splices were taken out: readings at their marks, the method on them, what it misses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reduction.archive.schema import COEFFICIENTS
from reduction.record import Bools, Floats
from reduction.report.figure import Figure, Trace, axis, band, line, make_figure, plain_numbers
from reduction.report.figures.record import position_of
from reduction.report.htmltable import number_text
from reduction.report.style import COLOURS, Shown, plot_text, shown
from reduction.report.uncertainty import NORMAL, factor_words
from reduction.report.view import TestView
from reduction.strain.evaluate import strain_by_model, strain_sensitivity_of
from reduction.strain.model import StrainModel

_MARK, _METHOD, _OTHER = COLOURS[1], COLOURS[0], COLOURS[6]
_LENGTH, _BY_TENSION = "relaxed_free_length", "tension-driven"
_STEPS = 120


@dataclass(frozen=True)
class _Marks:
    """Readings of one specimen; ``along`` is what the method goes by, tension or position. [SI]."""

    is_own: Bools
    names: tuple[str, ...]
    position: Floats
    tension: Floats
    strain: Floats
    residual: Floats
    along: Floats


def draw_splices(view: TestView) -> list[Figure]:
    """Draw one figure a specimen with marks: length of its splices, and what the method misses.

    Both against what the method goes by: tension, or crosshead position.
    """
    methods = view.texts("strain_method")
    if "mark_position" not in view.data or not methods:
        return []
    found = []
    for place, specimen in enumerate(view.specimens):
        model = _model_of(view, place)
        marks = _marks_of(view, specimen, is_by_tension=model.method == _BY_TENSION)
        if _LENGTH in model.coefficients and marks.along.size:
            found.append(_figure(view, place, model, marks))
    return found


def _figure(view: TestView, place: int, model: StrainModel, marks: _Marks) -> Figure:
    length, percent = shown("length", view.units), shown("strain", view.units)
    is_by_tension = model.method == _BY_TENSION
    across = shown("tension" if is_by_tension else "length", view.units)
    reach = _reach(view, place, is_by_tension=is_by_tension)
    shapes = [
        {
            "type": "line", "xref": "x", "yref": "paper", "y0": 0, "y1": 1, "x0": end, "x1": end,
            "line": {"width": 1, "dash": "dot", "color": _OTHER},
        }
        for end in plain_numbers(reach * across.factor)
    ]  # fmt: skip
    by = "tension" if is_by_tension else "crosshead position"
    relaxed = number_text(model.coefficients[_LENGTH] * length.factor)
    return make_figure(
        f"{view.key}-splices-{place}", f"{view.id}: splice correction, {model.specimen}",
        f"Above: length of both splices, which is position less the free length read at the marks,"
        f" against {by}, and the method {model.method} (95 %, {factor_words([NORMAL])}, of its"
        " coefficients). Below: strain by the method less strain at the marks, in points of strain;"
        " shaded: the same 95 %. Filled: marks read in this test; open: those of the specimen's"
        f" other tests. Dotted: how far this test goes. Free length at zero tension: {relaxed}"
        f" {length.unit}.",
        [
            *_upper(model, marks, np.append(reach, marks.along), length, across),
            *_lower(model, marks, percent, across),
        ],
        synthetic=view.is_synthetic, height=440, shapes=shapes,
        xaxis=axis(across.label(f"{by} at the marks"), anchor="y"),
        yaxis=axis(percent.label("method less marks"), domain=[0.0, 0.36], zeroline=True),
        yaxis2=axis(length.label("both splices"), domain=[0.46, 1.0]),
    )  # fmt: skip


def _upper(
    model: StrainModel, marks: _Marks, reached: Floats, length: Shown, across: Shown
) -> list[Trace]:
    """Draw the length of the splices: of the method a line with its band, of the marks points."""
    is_by_tension = model.method == _BY_TENSION
    low = 0.0 if is_by_tension else float(reached.min())
    along = np.linspace(low, float(reached.max()), _STEPS)
    # of a method by tension the length of the splices is the same at every position
    position = np.full(_STEPS, marks.position.max()) if is_by_tension else along
    free = model.coefficients[_LENGTH]
    strain = strain_by_model(model, position=position, tension=along)
    splices = (position - free * (1 + strain)) * length.factor
    # that of the free length itself is in the strain, not in the splices
    spread = _spread(model, position, along, left_out=_LENGTH)
    half = NORMAL * free * spread * length.factor
    x = along * across.factor
    read = (marks.position - free * (1 + marks.strain)) * length.factor
    return [
        band(x, splices - half, splices + half, name="of the method", colour=_METHOD, alpha=0.25,
             yaxis="y2"),
        line(x, splices, name=model.method, colour=_METHOD, width=1.8, yaxis="y2"),
        *_points(marks, read, across, "y2", is_named=True),
    ]  # fmt: skip


def _lower(model: StrainModel, marks: _Marks, percent: Shown, across: Shown) -> list[Trace]:
    """Draw what the method misses at each mark, within what its coefficients leave open."""
    order = np.argsort(marks.along, kind="stable")
    half = NORMAL * _spread(model, marks.position, marks.tension)[order] * percent.factor
    return [
        band(
            marks.along[order] * across.factor, -half, half, name="95 %", colour=_METHOD, alpha=0.25
        ),
        *_points(marks, marks.residual * percent.factor, across, "y", is_named=False),
    ]


def _points(
    marks: _Marks, values: Floats, across: Shown, axis_name: str, *, is_named: bool
) -> list[Trace]:
    return [
        {
            "type": "scatter", "mode": "markers", "name": words, "showlegend": is_named,
            "legendgroup": words, "x": plain_numbers(marks.along[own] * across.factor),
            "y": plain_numbers(values[own]), "yaxis": axis_name,
            "text": [marks.names[k] for k in np.flatnonzero(own)],
            "marker": {"color": tint, "symbol": symbol, "size": 8},
        }
        for own, words, tint, symbol in (
            (~marks.is_own, "marks of other tests", _OTHER, "diamond-open"),
            (marks.is_own, "marks of this test", _MARK, "circle"),
        )
        if own.any()
    ]  # fmt: skip


def _spread(model: StrainModel, position: Floats, tension: Floats, *, left_out: str = "") -> Floats:
    """Return the standard uncertainty of strain that follows from the coefficients."""
    names, slope = strain_sensitivity_of(model, position=position, tension=tension)
    kept = np.array([name != left_out for name in names])
    slope = slope[kept]
    covariance = model.covariance[np.ix_(kept, kept)]
    variance: Floats = np.einsum("i...,ij,j...->...", slope, covariance, slope)
    return np.sqrt(np.maximum(variance, 0.0))


def _marks_of(view: TestView, specimen: str, *, is_by_tension: bool) -> _Marks:
    own = np.array(view.texts("mark_specimen")) == specimen
    place = view.array_like("mark_position", np.zeros(own.size))
    position, tension, strain, residual = (
        view.array_like(f"mark_{name}", place)
        for name in ("position", "tension", "strain", "strain_residual")
    )
    along = np.maximum(tension, 0.0) if is_by_tension else position
    own = own & np.isfinite(along) & np.isfinite(strain)
    tests, holds = view.texts("mark_test"), view.texts("mark_hold")
    names = tuple(plot_text(f"{tests[k]}, {holds[k]}") for k in np.flatnonzero(own))
    is_own = (np.array(tests) == view.id)[own]
    return _Marks(
        is_own, names, position[own], tension[own], strain[own], residual[own], along[own]
    )


def _model_of(view: TestView, place: int) -> StrainModel:
    """Return method and coefficients of a specimen as the archive keeps them."""
    own_name = {stored: name for name, stored in COEFFICIENTS.items()}
    stored = view.texts("coefficient_name")
    nothing = np.full(len(view.specimens), np.nan)
    value, deviation = (
        np.array([view.array_like(f"{name}{end}", nothing)[place] for name in stored])
        for end in ("", "_standard_uncertainty")
    )
    known = np.isfinite(value)
    alike = view.array_like("strain_coefficient_correlation", np.zeros((1, *2 * known.shape)))
    covariance = np.nan_to_num(alike[place]) * np.outer(deviation, deviation)
    return StrainModel(
        view.specimens[place],
        view.texts("strain_method")[place],  # type: ignore[arg-type]
        {own_name[stored[k]]: float(value[k]) for k in np.flatnonzero(known)},
        np.nan_to_num(covariance[np.ix_(known, known)]),
    )


def _reach(view: TestView, place: int, *, is_by_tension: bool) -> Floats:
    """Return the greatest tension or position of the test; none where there is no record."""
    if is_by_tension:
        tension = view.array("tension")
        values = np.zeros(0) if tension is None else tension[place]
    else:
        position = position_of(view)
        values = np.zeros(0) if position is None else position[1]
    known = values[np.isfinite(values)]
    return known.max(initial=-np.inf, keepdims=True) if known.size else known
