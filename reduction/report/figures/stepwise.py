"""A stepwise test: tension against strain, and the moduli between and up to its readings."""

from __future__ import annotations

import numpy as np

from reduction.report.figure import Figure, Trace, axis, line, make_figure, plain_numbers
from reduction.report.style import COLOURS, DASHES, plot_text, shown
from reduction.report.uncertainty import NORMAL, expanded_of, plus_minus_of_tests
from reduction.report.view import TestView
from reduction.vocabulary import BRANCH_VALUES

OF_STEPS = "scatter of the readings of length, and of weight where that is stated"
"""What a number of a stepwise test has for itself: there are readings and no cycles."""

_TINTS = {"ascending": COLOURS[0], "descending": COLOURS[1]}


def flagged_steps(view: TestView) -> list[str]:
    """Return what is known against each reading, as words; empty where it is sound."""
    n_steps = int(view.data.sizes["step"])
    flags = view.array("step_flag")
    if flags is None:
        return [""] * n_steps
    meanings = view.flag_meanings("step_flag")
    return [
        ", ".join(name.replace("_", " ") for name, mask in meanings.items() if int(flag) & mask)
        for flag in flags
    ]


def draw_steps(view: TestView) -> list[Figure]:
    """Draw the readings, and the interval and secant moduli."""
    strain, tension = view.array("strain"), view.array("tension")
    if not view.is_stepwise or strain is None or tension is None:
        return []
    in_strain, in_tension = shown("strain", view.units), shown("tension", view.units)
    x, y = strain * in_strain.factor, tension * in_tension.factor
    branch = view.array_like("branch", strain)
    data: list[Trace] = [
        line(
            np.where(branch == BRANCH_VALUES[name], x, np.nan), y, name=name, colour=tint,
            dash=DASHES[name], mode="lines+markers", marker={"size": 6, "color": tint},
        )
        for name, tint in _TINTS.items()
    ]  # fmt: skip
    words = flagged_steps(view)
    flagged = np.array([bool(word) for word in words])
    if flagged.any():
        clock = np.array(view.texts("clock") or ("",) * flagged.size)
        data.append(
            {
                "type": "scatter", "mode": "markers+text", "name": "flagged",
                "x": plain_numbers(x[flagged]), "y": plain_numbers(y[flagged]),
                "text": [plot_text(time, 12) for time in clock[flagged]],
                "textposition": "bottom center", "textfont": {"size": 10},
                "marker": {
                    "symbol": "circle-open", "size": 14, "color": COLOURS[3],
                    "line": {"width": 2},
                },
            }
        )  # fmt: skip
    readings = make_figure(
        f"{view.key}-steps", f"{view.id}: tension against strain",
        "Each reading of the stepwise test; ascending solid, descending dashed; ringed readings"
        " are flagged and take no part in the moduli beside them"
        f"{_reasons(view, words)}.",
        data, synthetic=view.is_synthetic, height=400,
        xaxis=axis(in_strain.label("strain")), yaxis=axis(in_tension.label("tension")),
    )  # fmt: skip
    moduli = _moduli(view)
    return [figure for figure in (readings, moduli) if figure.has_data]


def _reasons(view: TestView, words: list[str]) -> str:
    clock = view.texts("clock") or tuple(f"reading {k}" for k in range(1, len(words) + 1))
    said = [f"{time}: {word}" for time, word in zip(clock, words, strict=True) if word]
    return f" ({'; '.join(said)})" if said else ""


def _moduli(view: TestView) -> Figure:
    in_strain, in_stress = shown("strain", view.units), shown("stress", view.units)
    data: list[Trace] = []
    middle, modulus = view.array("interval_strain"), view.array("interval_modulus")
    if middle is not None and modulus is not None:
        half = expanded_of(view, "interval_modulus", modulus).half
        branch = view.array_like("interval_branch", modulus)
        for name, tint in _TINTS.items():
            own = (branch == BRANCH_VALUES[name]) & np.isfinite(modulus)
            data.append(
                line(
                    middle[own] * in_strain.factor, modulus[own] * in_stress.factor,
                    name=f"interval, {name}", colour=tint, dash=DASHES[name],
                    mode="lines+markers", marker={"size": 6, "color": tint},
                    error_y={
                        "type": "data", "array": plain_numbers(half[own] * in_stress.factor),
                        "color": tint, "thickness": 1, "width": 3,
                    },
                )
            )  # fmt: skip
    strain, secant = view.array("strain"), view.array("secant_modulus")
    if strain is not None and secant is not None:
        data.append(
            line(
                strain * in_strain.factor, secant * in_stress.factor, name="secant",
                colour=COLOURS[2], dash="dot", width=1.2, mode="lines+markers",
                marker={"size": 5, "symbol": "diamond", "color": COLOURS[2]},
            )
        )  # fmt: skip
    said = plus_minus_of_tests(
        [NORMAL], [view], ["interval_modulus"], found_from=OF_STEPS, mark="Bars, ±"
    )
    return make_figure(
        f"{view.key}-step-moduli", f"{view.id}: interval and secant modulus",
        "Interval modulus: slope of stress on strain between two readings, at their middle."
        " Secant modulus: stress over strain of one reading."
        f" {said}",
        [trace for trace in data if trace["y"]], synthetic=view.is_synthetic, height=400,
        xaxis=axis(in_strain.label("strain")), yaxis=axis(in_stress.label("modulus")),
    )  # fmt: skip
