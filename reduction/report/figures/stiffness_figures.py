"""The three-parameter line over the runs, and the stiffness forms of mooring codes."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from reduction.record.measurement import Bools, Floats, Integers
from reduction.report.figure_data import Figure, Trace, axis, line, make_figure, plain_numbers
from reduction.report.product_views import FORM_WORDS, ExperimentView, response_unit
from reduction.report.surface_grid import expanded_of_runs
from reduction.report.test_view import TestView, factor_words
from reduction.report.text_style import COLOURS, SYMBOLS, colour, number_text, plot_text, shown

_GREY = "#8C8C8C"


def draw_single_time(
    view: ExperimentView, tests: Mapping[str, TestView] | None = None
) -> list[Figure]:
    """Draw the relaxation time against frequency, with the lines of one time and of 1/f."""
    exponent = view.scalar("single_time_exponent")
    unit = shown("time", view.units)
    frequency = view.per_run("run_frequency")
    time = view.per_run("relaxation_time_measured") * unit.factor
    spread = expanded_of_runs(view, "relaxation_time", {} if tests is None else tests)
    half = spread.half * unit.factor
    known = np.isfinite(frequency) & (time > 0)
    if not np.isfinite(exponent) or "frequency" not in view.factors or not known.any():
        return []
    groups = _groups(view, known)
    data: list[Trace] = []
    reach = np.array([frequency[known].min() / 1.1, frequency[known].max() * 1.1])
    centre = np.exp(np.mean(np.log(frequency[known]))), np.exp(np.mean(np.log(time[known])))
    for name, power, dash in (("one time, f⁰", 0.0, "dot"), ("as 1/f", 1.0, "dash")):
        y = centre[1] * (reach / centre[0]) ** -power
        data.append(line(reach, y, name=name, colour=_GREY, dash=dash, width=2))
    several = [own for own in groups.values() if np.unique(np.round(frequency[own], 3)).size > 1]
    for place, own in enumerate(several):
        height = np.exp(np.mean(np.log(time[own] * frequency[own] ** exponent)))
        tint = colour(place)
        ends = np.array([frequency[own].min(), frequency[own].max()])
        data.append(
            line(
                ends, height * ends**-exponent, name="fit", colour=tint, width=1.2,
                showlegend=False, hoverinfo="skip",
            )
        )  # fmt: skip
        data.append(
            _timed(view, own, (frequency, time, half), tint, SYMBOLS[place % len(SYMBOLS)],
                   _loads(view, own))
        )  # fmt: skip
    rest = np.array(sorted(set(np.flatnonzero(known)) - {k for own in several for k in own}), int)
    if rest.size:
        data.append(
            _timed(view, rest, (frequency, time, half), _GREY, "circle-open",
                   "loads at one frequency only")
        )  # fmt: skip
    low, high = (view.scalar(f"single_time_exponent_{end}") for end in ("low", "high"))
    times = time[known]
    span: dict[str, Any] = {}
    if times.max() < 3 * times.min():
        # a straight level would fill the height otherwise, and noise would look like a law
        middle = np.log10(centre[1])
        span["range"] = [float(middle - 0.5), float(middle + 0.5)]
    return [
        make_figure(
            f"{view.key}-single-time", f"{view.name}: relaxation time against frequency",
            "Relaxation time of each run, on logarithmic axes. One relaxation time would lie on the"
            " dotted level; dashed: as 1/f, which is a loss angle that does not change with"
            f" frequency. Thin: the fit, tau ~ f⁻ⁿ with n = {exponent:.4f} ({low:.4f} to"
            f" {high:.4f}), one factor for each pair of loads. Bars: expanded"
            f" uncertainty (95 %, {factor_words(spread.factors)}).",
            data, synthetic=view.is_synthetic, height=420, is_wide=True,
            xaxis=axis("frequency [Hz]", type="log", **_decade_ticks(reach)),
            yaxis=axis(unit.label("relaxation time"), type="log", **span),
        )
    ]  # fmt: skip


def draw_forms(view: ExperimentView) -> list[Figure]:
    """Draw the spring constant by each form of stiffness against the measured one."""
    unit = response_unit("apparent_spring_constant", view.units)
    measured = view.per_run("apparent_spring_constant_measured") * unit.factor
    fitted = view.array("stiffness_fitted")
    if fitted.size == 0 or not np.isfinite(fitted).any():
        return []
    forms = [str(name) for name in view.data["stiffness_form"].values]
    rows = {
        name: fitted[k] * unit.factor
        for k, name in enumerate(forms)
        if np.isfinite(fitted[k]).any()
    }
    rows["quadratic"] = view.per_run("apparent_spring_constant_fitted") * unit.factor
    known = np.isfinite(measured)
    everything = np.concatenate([measured[known], *(values[known] for values in rows.values())])
    ends = np.array([np.nanmin(everything), np.nanmax(everything)])
    force = shown("tension", view.units)
    tension = view.per_run("run_mean_tension") * force.factor
    span = np.array([np.nanmin(tension), np.nanmax(tension)])
    equal, missed = (
        [line(x, y, name="equal", colour=_GREY, dash="dot", showlegend=False)]
        for x, y in ((ends, ends), (span, np.zeros(2)))
    )
    for place, (name, values) in enumerate(rows.items()):
        equal.append(_by_form(view, place, name, measured, values))
        missed.append(_by_form(view, place, name, tension, measured - values))
    return [
        make_figure(
            f"{view.key}-forms", f"{view.name}: stiffness forms of mooring codes",
            "Apparent spring constant by each form against the measured one, a point a run;"
            " dotted: equal.",
            equal, synthetic=view.is_synthetic, height=400,
            xaxis=axis(unit.label("measured")), yaxis=axis(unit.label("by the form")),
        ),
        make_figure(
            f"{view.key}-forms-missed", f"{view.name}: what the forms miss",
            "Measured less form, against the mean tension: what bends here is the curve that a"
            " form of straight lines has no room for.",
            missed, synthetic=view.is_synthetic, height=400,
            xaxis=axis(force.label("mean tension")),
            yaxis=axis(unit.label("measured less form")),
        ),
    ]  # fmt: skip


def draw_derived(view: ExperimentView) -> list[Figure]:
    """Draw K_1 and tau from surfaces of E' and E'' against those of the runs' own loops."""
    found = []
    for name, symbol in (("dissipation_spring_constant", "K_1"), ("relaxation_time", "tau")):
        unit = response_unit(name, view.units)
        own = view.per_run(f"{name}_measured") * unit.factor
        smooth = view.per_run(f"derived_{name}") * unit.factor
        known = np.isfinite(own) & np.isfinite(smooth)
        if not known.any():
            continue
        both = np.concatenate([own[known], smooth[known]])
        ends = np.array([both.min(), both.max()])
        data = [
            line(ends, ends, name="equal", colour=_GREY, dash="dot", showlegend=False),
            {
                "type": "scatter", "mode": "markers", "name": "runs", "showlegend": False,
                "x": plain_numbers(own[known]), "y": plain_numbers(smooth[known]),
                "text": [plot_text(view.runs[k]) for k in np.flatnonzero(known)],
                "marker": {"size": 8, "color": COLOURS[0]},
            },
        ]  # fmt: skip
        found.append(
            make_figure(
                f"{view.key}-derived-{name}", f"{view.name}: {symbol} from surfaces of E' and E''",
                f"{symbol} from smooth surfaces of E' and E'' against {symbol} of the loops of each"
                " run; dotted: equal. A run off the line is one that its neighbours do not bear"
                " out.",
                data, synthetic=view.is_synthetic, height=400,
                xaxis=axis(unit.label(f"{symbol} of the loops")),
                yaxis=axis(unit.label(f"{symbol} from surfaces")),
            )
        )  # fmt: skip
    return found


def _by_form(view: ExperimentView, place: int, name: str, x: Floats, y: Floats) -> Trace:
    return {
        "type": "scatter", "mode": "markers", "name": FORM_WORDS.get(name, name),
        "x": plain_numbers(x), "y": plain_numbers(y),
        "text": [plot_text(run) for run in view.runs],
        "marker": {"size": 8, "color": COLOURS[place], "symbol": SYMBOLS[place]},
    }  # fmt: skip


def _groups(view: ExperimentView, known: Bools) -> dict[tuple[str, ...], Integers]:
    """Runs at equal loads as planned, of one specimen: places by what they have in common."""
    frequency = view.factors.index("frequency")
    others = np.delete(view.array("run_plan"), frequency, axis=1)
    specimens = view.texts("run_specimen")
    found: dict[tuple[str, ...], list[int]] = {}
    for k in np.flatnonzero(known):
        found.setdefault((specimens[k], *map(str, others[k])), []).append(int(k))
    return {key: np.array(own) for key, own in found.items()}


def _loads(view: ExperimentView, own: Integers) -> str:
    """Say the levels of a group of runs but for the frequency."""
    level = view.array("run_level")[own].mean(axis=0)
    parts = [
        f"{number_text(float(level[j]) * unit.factor, 3)} {unit.unit}"
        for j, unit in enumerate(view.factor_units)
        if view.factors[j] != "frequency"
    ]
    specimens = view.texts("run_specimen")
    who = f"{specimens[own[0]]}: " if len(set(specimens)) > 1 else ""
    return who + ", ".join(parts)


def _timed(
    view: ExperimentView,
    own: Integers,
    columns: tuple[Floats, Floats, Floats],
    tint: str,
    symbol: str,
    name: str,
) -> Trace:
    frequency, time, half = (column[own] for column in columns)
    return {
        "type": "scatter", "mode": "markers", "name": plot_text(name),
        "x": plain_numbers(frequency), "y": plain_numbers(time),
        "text": [plot_text(view.runs[k]) for k in own],
        "error_y": {"type": "data", "array": plain_numbers(half), "color": tint, "thickness": 1},
        "marker": {"size": 8, "color": tint, "symbol": symbol},
    }  # fmt: skip


def _decade_ticks(reach: Floats) -> dict[str, Any]:
    """Return ticks at 1, 2 and 5 of each decade: plotly labels the digits between them bare."""
    powers = np.arange(np.floor(np.log10(reach[0])) - 1, np.ceil(np.log10(reach[1])) + 1)
    ticks = [
        digit * 10.0**power
        for power in powers
        for digit in (1, 2, 3, 5)
        if reach[0] / 1.5 <= digit * 10.0**power <= reach[1] * 1.5
    ]
    return {
        "tickvals": plain_numbers(np.array(ticks)),
        "ticktext": [f"{tick:.3g}" for tick in ticks],
    }
