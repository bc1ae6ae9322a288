"""Dynamic modulus, loss factor and energy of each test against mean strain and amplitude."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reduction.record import Floats
from reduction.report.figure import Figure, Trace, axis, make_figure, plain_numbers
from reduction.report.style import Kind, marker, plot_text, shown
from reduction.report.uncertainty import expanded_of, plus_minus_of_tests
from reduction.report.view import TestView, all_specimens, any_synthetic


def draw_amplitude_pairs(tests: Sequence[TestView]) -> list[Figure]:
    """Draw dynamic modulus, loss factor and energy against mean strain, bars of amplitude."""
    panels: tuple[tuple[str, str, Kind], ...] = (
        ("test_dynamic_modulus", "dynamic modulus", "stress"),
        ("test_loss_factor", "loss factor", "number"),
        ("test_hysteresis_energy", "hysteresis energy", "energy"),
    )
    found = []
    names = all_specimens(tests)
    for name, words, kind in panels:
        data: list[Trace] = []
        units = tests[0].units if tests else "si"
        unit = shown(kind, units)
        in_legend: set[str] = set()
        drawn: dict[str, int] = {}
        factors: list[float] = []
        seen: dict[str, TestView] = {}
        for index, view in enumerate(tests):
            for order, specimen in enumerate(names):
                row = _summary(view, specimen, name)
                if row is not None and np.isfinite(row[2]):
                    data.append(_point(view.id, specimen, (index, order), row, unit.factor))
                    data[-1]["showlegend"] = view.id not in in_legend
                    in_legend.add(view.id)
                    factors.append(float(row[4]))
                    seen[view.id] = view
                    drawn[specimen] = order
        if len(drawn) > 1:
            data += [_entry(specimen, order) for specimen, order in drawn.items()]
        figure = make_figure(
            f"campaign-{name}", f"{words.capitalize()} of each test",
            f"{words.capitalize()}, mean over the cycles of a test, against mean strain. The"
            " level bar is the strain range of the cycles: tests at one mean strain and two"
            " amplitudes stand above each other. Colour and shape of a marker are"
            " the test's, its filling the specimen's (grey in the legend)."
            " " + plus_minus_of_tests(factors, [*seen.values()], [name], mark="Upright bar, ±"),
            data, synthetic=any_synthetic(tests), height=400,
            xaxis=axis("mean strain [%]"), yaxis=axis(unit.label(words)),
        )  # fmt: skip
        if figure.has_data:
            found.append(figure)
    return found


def _summary(view: TestView, specimen: str, name: str) -> Floats | None:
    """Return mean strain, strain amplitude, value, its expanded uncertainty and the factor."""
    mean, amplitude = view.array("test_mean_strain"), view.array("test_strain_amplitude")
    values = view.array(name)
    if mean is None or amplitude is None or values is None or specimen not in view.specimens:
        return None
    row = view.specimens.index(specimen)
    spread = expanded_of(view, name, values)
    return np.array([mean[row], amplitude[row], values[row], spread.half[row], spread.factor[row]])


def _point(test: str, specimen: str, places: tuple[int, int], row: Floats, factor: float) -> Trace:
    """Return one test and specimen; the legend has one entry for all specimens of a test."""
    look = marker(places[0], variant=places[1], size=9)
    bars = {"type": "data", "color": look["color"], "thickness": 1, "width": 3}
    mean, amplitude = 100.0 * row[:1], 100.0 * row[1:2]
    return {
        "type": "scatter",
        "mode": "markers",
        "name": plot_text(test),
        "legendgroup": plot_text(test),
        "text": plot_text(f"{test}, {specimen}", 80),
        "x": plain_numbers(mean),
        "y": plain_numbers(factor * row[2:3]),
        "error_x": {**bars, "array": plain_numbers(amplitude)},
        "error_y": {**bars, "array": plain_numbers(factor * row[3:4])},
        "marker": look,
    }


def _entry(specimen: str, order: int) -> Trace:
    """Return an entry of the legend that says which filling is the specimen's."""
    look = {**marker(0, variant=order, size=9), "color": "#8C8C8C"}
    name = plot_text(specimen)
    return {
        "type": "scatter", "mode": "markers", "name": name, "x": [None], "y": [None],
        "marker": look,
    }  # fmt: skip
