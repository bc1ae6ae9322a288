"""Intervals of K_1 and tau of an exported line against the line of scaled and shifted surfaces."""

from dataclasses import replace

import numpy as np
import pytest
from export_sources import LEVELS, REST, SPRING, TIME, loop, source, surface

from reduction.lines.export_dynamics import _half_widths, line_dynamics
from reduction.lines.line_lookup import look_up
from reduction.lines.lookup_product import LineCurve
from reduction.record.contributions import Component
from reduction.stages.three_parameter_line.line_model import identify_by_amplitude

CELL, CLOCK = Component("tension_gain", "cell"), Component("lag", "clock")
NAMES = ("quasi_static_spring_constant", "apparent_spring_constant", "hysteresis_energy")


def line(values, rows, sigma=0.0):
    """K_0, K_ap and H as flat surfaces; the rows are of the errors that all of them share."""
    one = source(curves=(), growth=0.0)
    surfaces = {}
    for name, value in zip(NAMES, values, strict=True):
        moved = {cause: found[name] for cause, found in rows.items()}
        table = np.zeros((len(moved), 10))
        table[:, 0] = list(moved.values())
        surfaces[name] = replace(
            surface(name, value, sigma=sigma * value), component=tuple(moved), contribution=table
        )
    return replace(one, surfaces=surfaces)


def found_half_widths(one):
    values = [look_up(one, name, **LEVELS) for name in NAMES]
    return _half_widths(identified(*(found.value for found in values)), *values)


def identified(rest, apparent, energy):
    return identify_by_amplitude(
        apparent_spring_constant=apparent, hysteresis_energy=energy, tension_amplitude=700.0,
        frequency=0.3, quasi_static_spring_constant=rest,
    )  # fmt: skip


VALUES = (REST, *loop())


def test_the_gain_of_one_load_cell_is_in_k_1_as_it_is_and_leaves_tau_alone():
    """At a true amplitude a cell that reads 1 % high makes H, an area over its square, 1 % low."""
    gain = dict(zip(NAMES, np.array([0.01, 0.01, -0.01]) * VALUES, strict=True))
    half = found_half_widths(line(VALUES, {CELL: gain}))
    assert half["dissipation_spring_constant"] == pytest.approx(1.96 * 0.01 * SPRING, rel=1e-6)
    assert half["relaxation_time"] == pytest.approx(0.0, abs=1e-9)
    assert half["dashpot_coefficient"] == pytest.approx(1.96 * 0.01 * SPRING * TIME, rel=1e-6)
    # as three errors, none of which knows the others, tau would not be left alone
    apart = {
        Component("tension_gain", name): {
            other: gain[name] * (other == name) for other in NAMES
        } for name in NAMES
    }  # fmt: skip
    assert found_half_widths(line(VALUES, apart))["relaxation_time"] > 0.03 * TIME


@pytest.mark.parametrize("shares", [(0.01, -0.004, 0.02), (0.0, 0.01, 0.0), (-0.02, 0.01, 0.01)])
def test_any_shared_error_moves_k_1_and_tau_as_another_line_would_have_them(shares):
    step = 1e-4
    rows = dict(zip(NAMES, step * np.array(shares) * VALUES, strict=True))
    half = found_half_widths(line(VALUES, {CLOCK: rows}))
    ends = [
        identified(*(np.array(VALUES) * (1 + side * step * np.array(shares)))) for side in (1, -1)
    ]
    for name, value in half.items():
        moved = abs(getattr(ends[0], name) - getattr(ends[1], name)) / 2
        assert value == pytest.approx(1.96 * moved, rel=1e-4, abs=1e-12)


def test_what_is_of_each_surface_alone_is_added_as_squares_with_that_of_k_0():
    half = found_half_widths(line(VALUES, {}, sigma=0.001))
    own = look_up(line(VALUES, {}, sigma=0.001), NAMES[1], **LEVELS)
    share = float((own.surface_high - own.value) / own.value)
    squares = 0.0
    for place in range(3):
        ends = []
        for side in (1, -1):
            values = list(VALUES)
            values[place] *= 1 + side * 1e-5
            ends.append(float(identified(*values).relaxation_time))
        squares += ((ends[0] - ends[1]) / 2e-5 * share) ** 2
    assert half["relaxation_time"] == pytest.approx(np.sqrt(squares), rel=1e-4)


def test_the_deck_says_how_well_they_are_known():
    gain = dict(zip(NAMES, np.array([0.01, 0.01, -0.01]) * VALUES, strict=True))
    notes = line_dynamics(line(VALUES, {CELL: gain}), LEVELS).notes
    assert "; 95 percent of K_1 +-588 N, of tau +-" in notes[0]
    rest = LineCurve(NAMES[0], "mean_tension", 0.0, 4000.0, coefficient=np.array([REST]))
    exact = line(VALUES, {}, sigma=0.001)
    del exact.surfaces[NAMES[0]]
    notes = line_dynamics(replace(exact, curves=(rest,)), LEVELS).notes
    assert notes[0].endswith("K_0 taken as exact: it has no interval")
    unknown = line(VALUES, {}, sigma=np.nan)
    assert line_dynamics(unknown, LEVELS).notes[0].endswith("and so have K_1 and tau none")
