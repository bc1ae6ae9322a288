"""The record as it was logged, and how the splices were taken out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from reduction.archive.test_variables import COEFFICIENTS
from reduction.quantities.flags import PHASE_VALUES
from reduction.record.measurement import Bools, Floats, Integers
from reduction.report.figure_data import (
    POINTS,
    Figure,
    Trace,
    axis,
    band,
    keep_extremes,
    least_and_greatest,
    line,
    make_figure,
    plain_numbers,
    with_gaps,
)
from reduction.report.test_view import NORMAL, TestView, factor_words
from reduction.report.text_style import (
    COLOURS,
    PHASE_FILLS,
    Shown,
    colour,
    number_text,
    plot_text,
    shown,
)
from reduction.stages.strain.strain_model import StrainModel, strain_by_model, strain_sensitivity_of

TIME_DIGITS = 9

MOST_PHASES = 150

FLAG_POINTS = 400

WHOLE_CYCLES = 8

DENSE = 300
"""More cycles than this cannot be told apart on the width of a page."""

LONG_RECORD = 7200.0
"""A longer record is shown in hours. [s]"""

SECONDS_IN_AN_HOUR = 3600.0

# said of whole stretches of a sound record, so not shown until a reader asks for them
MOVING = (PHASE_VALUES["approach"], PHASE_VALUES["cycling"])

COMMON_FLAGS = ("not_constant_rate", "resampled", "extrapolated")


def _position_of(view: TestView) -> tuple[str, Floats] | None:
    """Return what the crosshead channel is called and its values."""
    for name, words in (
        ("crosshead_position", "crosshead position"),
        ("crosshead_displacement", "crosshead displacement"),
    ):
        values = view.array(name)
        if values is not None:
            return words, values
    return None


def draw_record(view: TestView) -> list[Figure]:
    """Draw position over tension against time, phases shaded, flagged samples marked."""
    time, tension = view.array("time"), view.array("tension")
    if time is None or tension is None or not time.size or view.is_stepwise:
        return []
    in_tension = shown("tension", view.units)
    in_time, seconds = shown("time", view.units), 1.0
    if time[-1] - time[0] > LONG_RECORD:
        seconds = SECONDS_IN_AN_HOUR
        time, in_time = time / seconds, Shown("h", 1.0)
    data: list[Trace] = []
    # a line through so many cycles is a block of colour that hides the specimen behind it
    is_dense = view.is_whole and view.n_cycles > DENSE
    position = _position_of(view)
    if position is not None:
        words, values = position
        length = shown("length", view.units)
        data.append(
            _series(view, time, values * length.factor, words, "#8C8C8C", is_dense, yaxis="y2")
        )
        flags = view.array("crosshead_position_quality_flag")
        data += _flagged(view, "crosshead_position_quality_flag", time, values * length.factor,
                         flags, words, "#8C8C8C", "y2")  # fmt: skip
    flags = view.array("quality_flag")
    for index, specimen in enumerate(view.specimens):
        force = tension[index] * in_tension.factor
        data.append(_series(view, time, force, f"tension, {specimen}", colour(index), is_dense))
        of_specimen = None if flags is None else flags[index]
        data += _flagged(
            view, "quality_flag", time, force, of_specimen, specimen, colour(index), "y"
        )
    shapes, labels, left_out = _phases(view, time)
    layout: dict[str, Any] = {
        "xaxis": axis(in_time.label("time")),
        "yaxis": axis(in_tension.label("tension")),
        "shapes": shapes,
        "annotations": labels,
        "meta": {"cycles": "time", "seconds": seconds},
    }
    if position is not None:
        layout["yaxis"]["domain"] = [0.0, 0.52]
        layout["xaxis"]["anchor"] = "y"
        layout["yaxis2"] = axis(
            shown("length", view.units).label(position[0].replace("crosshead ", "")),
            domain=[0.6, 1.0],
        )
    caption = (
        "Position and tension against time. The background is the phase: "
        + ", ".join(PHASE_VALUES)
        + ". Marks: flagged samples. Flags of whole intervals"
        + " (rate not constant, resampled, extrapolated) can be switched on in the legend."
    )
    caption += _of_part(view)
    if is_dense:
        caption += (
            " Too many cycles to show individually: filled from minimum to maximum of each short"
            f" interval of the {time.shape[0]:,} samples."
        )
    elif time.shape[0] > POINTS:
        caption += (
            f" The {time.shape[0]:,} samples are reduced to the minimum and maximum of each short"
            " interval."
        )
    if left_out:
        caption += f" {left_out} short phases are not shaded."
    return [
        make_figure(
            f"{view.key}-record", f"{view.id}: record", caption, data,
            synthetic=view.is_synthetic, height=480, is_wide=True, **layout,
        )
    ]  # fmt: skip


def _series(
    view: TestView, time: Floats, values: Floats, name: str, tint: str, is_dense: bool, **more: Any
) -> Trace:
    """Return one channel against time: a line, or of many cycles what lies between its extremes."""
    if is_dense:
        # more than a cycle in each, or the edges would follow the cycles in steps
        most = min(POINTS // 4, 2 * view.n_cycles // 3)
        middle, least, greatest = least_and_greatest(time, values, n_intervals=most)
        return band(
            middle, least, greatest, name=name, colour=tint, alpha=0.3, showlegend=True,
            line={"width": 1, "color": tint}, **more,
        )  # fmt: skip
    # most of the time of a record that is stored in part has no sample to draw
    along = time if view.is_whole else np.arange(time.size, dtype=np.float64)
    kept = keep_extremes(along, values)
    return line(
        *with_gaps(view.pieces[kept], time[kept], values[kept]), name=name, colour=tint, width=1.2,
        x_digits=TIME_DIGITS, **more,
    )  # fmt: skip


def draw_tension_position(view: TestView) -> list[Figure]:
    """Draw tension against position; of a long test some whole cycles, and the rest thinned."""
    time, tension, position = view.array("time"), view.array("tension"), _position_of(view)
    if time is None or tension is None or position is None:
        return []
    phase = view.array("phase")
    if phase is not None and not np.isin(phase, MOVING).any():
        return []
    words, values = position
    length, force = shown("length", view.units), shown("tension", view.units)
    number, pieces = view.array("cycle_number"), view.pieces
    drawn = np.zeros(0)
    data: list[Trace] = []
    for index, specimen in enumerate(view.specimens):
        kept: NDArray[np.intp]
        if time.shape[0] <= 2 * POINTS or number is None or view.n_cycles == 0:
            kept = keep_extremes(time, values, tension[index], limit=2 * POINTS)
            x, y = with_gaps(pieces[kept], values[kept], tension[index][kept])
        else:
            # a polygon through the extremes of many cycles is no loop: draw whole ones
            drawn = view.stored_near(np.geomspace(1, view.n_cycles, WHOLE_CYCLES).round())
            shown_parts = [number == 0, *(number == cycle for cycle in drawn)]
            x, y = _pieces(time, values, tension[index], shown_parts, pieces)
        data.append(
            line(
                x * length.factor, y * force.factor, name=specimen, colour=colour(index), width=1.0
            )
        )
    caption = (
        f"Tension against crosshead position over the whole record, as logged.{_of_part(view)}"
    )
    if drawn.size:
        cycles = ", ".join(f"{cycle:.0f}" for cycle in drawn)
        caption = (
            "Tension against crosshead position: the record outside the cycles, and cycles"
            f" {cycles} of the {view.n_cycles:,}."
        )
    return [
        make_figure(
            f"{view.key}-tension-position", f"{view.id}: tension against position", caption, data,
            synthetic=view.is_synthetic, height=400, is_wide=True,
            xaxis=axis(length.label(words)), yaxis=axis(force.label("tension")),
        )
    ]  # fmt: skip


def _of_part(view: TestView) -> str:
    """Return what a caption says where samples of some cycles alone are stored."""
    if view.is_whole:
        return ""
    return (
        f" Of the {view.scalar('n_rows_kept'):,.0f} samples {view.scalar('n_rows_stored'):,.0f}"
        " are stored; the line is broken where cycles are left out."
    )


def _pieces(
    time: Floats, values: Floats, tension: Floats, parts: list[Bools], pieces: Integers
) -> tuple[Floats, Floats]:
    """Return the parts one after another, a gap between."""
    x: list[Floats] = []
    y: list[Floats] = []
    for is_part in parts:
        own = np.flatnonzero(is_part)
        if own.size:
            # a jump in the index is another visit to the same phase, and so is another piece
            jumps = (np.diff(own) > 1) | (np.diff(pieces[own]) > 0)
            visit = np.split(own, np.flatnonzero(jumps) + 1)
            limit = max(POINTS // len(parts) // len(visit), 20)
            for part in visit:
                kept = part[keep_extremes(time[part], values[part], tension[part], limit=limit)]
                x += [values[kept], np.array([np.nan])]
                y += [tension[kept], np.array([np.nan])]
    return np.concatenate(x), np.concatenate(y)


def _phases(view: TestView, time: Floats) -> tuple[list[Trace], list[Trace], int]:
    """Return shaded rectangles, their labels, and how many phases are too many to shade."""
    phase = view.array("phase")
    if phase is None:
        return [], [], 0
    starts = np.flatnonzero(np.diff(phase, prepend=np.nan) != 0)
    ends = np.append(starts[1:], phase.shape[0] - 1)
    duration = time[ends] - time[starts]
    longest = np.sort(np.argsort(-duration, kind="stable")[:MOST_PHASES])
    words = {value: name for name, value in PHASE_VALUES.items()}
    shapes: list[Trace] = []
    labels: list[Trace] = []
    whole = float(time[-1] - time[0])
    for place in longest:
        name = words.get(int(phase[starts[place]]))
        if name is None:
            continue
        left, right = float(time[starts[place]]), float(time[ends[place]])
        shapes.append(
            {
                "type": "rect", "layer": "below", "xref": "x", "yref": "paper", "x0": left,
                "x1": right, "y0": 0, "y1": 1, "line": {"width": 0},
                "fillcolor": PHASE_FILLS[name], "name": name,
            }
        )  # fmt: skip
        if duration[place] > 0.09 * whole:
            labels.append(
                {
                    "text": name, "x": (left + right) / 2, "y": 0.56, "xref": "x",
                    "yref": "paper", "showarrow": False, "yanchor": "middle",
                    "font": {"size": 11},
                }
            )  # fmt: skip
    return shapes, labels, int(starts.size - longest.size)


def _flagged(
    view: TestView, name: str, time: Floats, values: Floats, flags: Floats | None,
    words: str, marker_colour: str, axis_name: str,
) -> list[Trace]:  # fmt: skip
    """Return one marker trace a mask that is set; a missing value is marked on the line."""
    if flags is None or not flags.any():
        return []
    bits = flags.astype(np.int64)
    finite = np.isfinite(values)
    data: list[Trace] = []
    for meaning, mask in view.flag_meanings(name).items():
        own = np.flatnonzero(bits & mask)
        if own.size == 0:
            continue
        # the place of a missing value is that of its neighbours
        heights = (
            np.interp(own, np.flatnonzero(finite), values[finite])
            if finite.any()
            else np.zeros(own.size)
        )
        kept = keep_extremes(time[own], heights, limit=FLAG_POINTS)
        label = f"{meaning.replace('_', ' ')}, {words} ({own.size:,})"
        data.append(
            {
                "type": "scatter",
                "mode": "markers",
                "name": plot_text(label, 60),
                "x": plain_numbers(time[own][kept], TIME_DIGITS),
                "y": plain_numbers(heights[kept]),
                "yaxis": axis_name,
                "marker": {"color": marker_colour, "symbol": "x-thin-open", "size": 7},
                **({"visible": "legendonly"} if meaning in COMMON_FLAGS else {}),
            }
        )
    return data


_MARK, _METHOD, _OTHER = COLOURS[1], COLOURS[0], COLOURS[6]

_LENGTH, _BY_TENSION, _BY_BOTH = "relaxed_free_length", "tension-driven", "mixed"

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
    """Draw one figure a specimen with marks: length of its splices, and what the method misses."""
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
        "Above: length of both splices (position minus free length read at the marks) against"
        f" {by}, and the curve of the method {model.method} (band: 95 %, {factor_words([NORMAL])},"
        " from its coefficients). Below: strain by the method minus strain at the marks, in"
        " percentage points; shaded: the same 95 %. Filled: marks read in this test; open: those of"
        f" the specimen's other tests. Dotted: range of this test. Free length at zero tension:"
        f" {relaxed} {length.unit}.",
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
    along = tension = np.linspace(low, float(reached.max()), _STEPS)
    # of a method by tension the length of the splices is the same at every position
    position = np.full(_STEPS, marks.position.max()) if is_by_tension else along
    if model.method == _BY_BOTH:
        # neither alone determines the splices: the line joins its lengths at the marks
        order = np.argsort(marks.along, kind="stable")
        along, position, tension = marks.along[order], marks.position[order], marks.tension[order]
    free = model.coefficients[_LENGTH]
    strain = strain_by_model(model, position=position, tension=tension)
    splices = (position - free * (1 + strain)) * length.factor
    # that of the free length itself is in the strain, not in the splices
    spread = _spread(model, position, tension, left_out=_LENGTH)
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
        position = _position_of(view)
        values = np.zeros(0) if position is None else position[1]
    known = values[np.isfinite(values)]
    return known.max(initial=-np.inf, keepdims=True) if known.size else known
