"""Figures of a test beside its predicted hose: curves, comparison error, cycles, all in one."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from reduction.record import Bools, Floats
from reduction.report.comparisonview import ComparisonView
from reduction.report.figure import Figure, Trace, axis, band, line, make_figure, plain_numbers
from reduction.report.sources import source_words
from reduction.report.style import COLOURS, DASHES, SYMBOLS, Shown, colour, shown
from reduction.report.uncertainty import NORMAL, expand, factor_words

_PREDICTED, _MEASURED, _CALIBRATED, _GREY = COLOURS[0], COLOURS[1], COLOURS[2], COLOURS[6]
_ALPHA = 0.22
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
    fitted = (
        " Calibrated: with the numbers of the hose that were fitted to this very test."
        if view.fitted
        else ""
    )
    return _kept(
        make_figure(
            f"{view.key}-tension", f"Measured and predicted tension, {view.name}",
            f"{about}Heavy: the {judged} of the test, by which the prediction is judged."
            f"{fitted}"
            " Filled marks: what is predicted to happen to the cords; open: where the test reached"
            " that tension.",
            data, synthetic=view.is_synthetic, height=460, is_wide=True,
            xaxis=_strain_axis(), yaxis=axis(force.label("tension"), rangemode="tozero"),
        )
    )  # fmt: skip


def _shaded(view: ComparisonView) -> str:
    """Say what the bands hold."""
    shared = ", ".join(source_words(one) for one in view.shared_sources)
    of_test = f"scatter, and what all samples share: {shared}" if shared else "scatter alone"
    return (
        f"Shaded: expanded uncertainty, 95 % ({factor_words([NORMAL])}), of the prediction from"
        f" what is stated of the hose, and of the judged curve of the test: {of_test}."
    )


def draw_error(view: ComparisonView) -> list[Figure]:
    """Draw predicted less measured tension within what it may be, and what calibration leaves."""
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
        f" Shaded: U, {view.scalar('coverage_factor'):.2f} standard uncertainties of test and"
        " prediction together, which the largest ratio of a right prediction stays below in 95 % of"
        " all cases."
        if np.any(allowed > 0)
        else ""
    )
    return _kept(
        make_figure(
            f"{view.key}-error", f"Comparison error, {view.name}",
            "Predicted less measured tension: above zero the hose is softer than predicted."
            f"{bounds} Marked: the greatest difference, and the largest in terms of its"
            " uncertainty.",
            data, synthetic=view.is_synthetic, height=440, is_wide=True,
            xaxis=_strain_axis(), yaxis=axis(force.label("predicted less measured")),
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
            f" Dashed: {slope:+.3g} {force.unit} a decade, ± {float(spread.half):.2g} {force.unit}"
            f" (95 %, {factor_words(spread.factors)}, scatter about the line)."
        )
    # a bias that hardly moves would fill the height, and noise would look like a trend
    middle, reach = bias.mean(), max(np.ptp(bias), 0.02 * _greatest(view) * force.factor)
    return [
        make_figure(
            f"{view.key}-cycles", f"Bias cycle by cycle, {view.name}",
            "Mean of predicted less measured tension over the strains, each cycle at its"
            f" {view.judged}: it rises where the hose softens.{about}",
            data, synthetic=view.is_synthetic, height=360,
            xaxis=axis("cycle number [1]", type="log", **_cycle_ticks(number)),
            yaxis=axis(force.label("bias"), range=[middle - reach, middle + reach]),
        )
    ]  # fmt: skip


def draw_all_comparisons(views: Sequence[ComparisonView]) -> list[Figure]:
    """Draw the relative difference of each comparison in one figure; nothing for one alone.

    Comparisons of one test with one hose, calibrated in several ways, are one line.
    """
    if len(views) < 2:
        return []
    groups: dict[tuple[str, ...], list[ComparisonView]] = {}
    for view in views:
        groups.setdefault((view.test, view.specimen, view.hose, view.loading), []).append(view)
    data: list[Trace] = []
    for index, own in enumerate(groups.values()):
        first = own[0]
        measured = first.of_curve("measured_tension", first.judged)
        counts = _is_worth_a_ratio(measured)
        share = np.full(measured.shape, np.nan)
        share[counts] = 100 * first.difference[counts] / measured[counts]
        data.append(
            line(
                _percent(first), share, name=", ".join(view.name for view in own),
                colour=colour(index), dash=_PULLED.get(first.loading, "dot"), width=2,
            )
        )  # fmt: skip
    return _kept(
        make_figure(
            "comparisons-relative", "Relative difference of all comparisons",
            "Predicted less measured over measured tension, at the judged curve of each; solid:"
            " static, dashed: dynamic. Left out where less than"
            f" {100 * _LEAST_TENSION:g} % of the greatest tension of the test was measured: there"
            " any difference is large beside it.",
            data, synthetic=any(view.is_synthetic for view in views), height=460, is_wide=True,
            xaxis=_strain_axis(), yaxis=axis("difference over measured tension [%]"),
        )
    )  # fmt: skip


def _percent(view: ComparisonView) -> Floats:
    return 100 * view.array("strain")


def _strain_axis() -> dict[str, Any]:
    return axis("strain of the hose [%]")


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


def _kept(figure: Figure) -> list[Figure]:
    return [figure] if figure.has_data else []
