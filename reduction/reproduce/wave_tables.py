"""Tables 5 to 8 of Zhang (2015): loads over time, their extremes, and how far two methods differ.

The settings are those of `reduction.predict.zhang2015`; the phase has omega = 2 pi / 3.57 s, with
which every load comes back to the last digit.  The vertical loads of the Airy theory are recomputed
with the velocity that equation (15) gives: the paper has another one in each of the two columns.

References
----------
.. [1] S. Zhang, C. Chen, Q. Zhang, D. Zhang and F. Zhang, "Wave Loads Computation for Offshore
   Floating Hose Based on Partially Immersed Cylinder Model of Improved Morison Formula," Open
   Petroleum Eng. J., vol. 8, 2015.
"""

from __future__ import annotations

from dataclasses import replace
from math import tanh

import numpy as np

from reduction.predict.harmonics import WaveHarmonics
from reduction.predict.morison import wave_load
from reduction.predict.zhang2015 import (
    DRAG_COEFFICIENT,
    INERTIA_COEFFICIENT,
    WATER_DENSITY,
    printed_airy_wave,
    printed_section,
    printed_stokes_wave,
)
from reduction.published.cell import Cell
from reduction.record import Floats
from reduction.reproduce.answers import Answer, Answers
from reduction.reproduce.wave_settings import (
    DEPTH,
    FREQUENCY,
    GRAVITY,
    HEIGHT,
    NUMBER,
    cells_of_table,
)

_METHODS = {"Morison theory": "F0", "improved Morison theory": "F1"}
_SETTINGS = "(1), (10) with 1030 kg/m3, z = 0, omega = 2 pi / 3.57 s, g = 9.8 m/s2"
_WITH_15 = "velocity of (15) in both columns"
_AS_PRINTED = "as printed with (pi H / T) tanh kd in F0 and pi H / T in F1"


def table_answers() -> Answers:
    """Answers to the loads, the extremes and the ratios.

    Returns
    -------
    answers : Answers
        By cell.
    """
    answers: Answers = {}
    for table, last in (("5", 5.0), ("6", 10.0)):
        for cell in cells_of_table(table):
            answers[cell.key] = _extreme(cell, last)
    for cell in cells_of_table("7"):
        answers[cell.key] = _load(cell)
    for cell in cells_of_table("8"):
        answers[cell.key] = _ratio(cell)
    return answers


def _wave(theory: str) -> WaveHarmonics:
    if theory.startswith("Stokes"):
        return replace(printed_stokes_wave(), angular_frequency=FREQUENCY)
    velocity = HEIGHT * GRAVITY * NUMBER / (2 * FREQUENCY) * tanh(NUMBER * DEPTH)
    return replace(
        printed_airy_wave(), angular_frequency=FREQUENCY, vertical_velocity=np.array([velocity])
    )


def _loads(theory: str, time: Floats) -> dict[str, Floats]:
    """Columns of Table 7 at these times, by their names."""
    load = wave_load(
        _wave(theory),
        printed_section(),
        time,
        drag_coefficient=DRAG_COEFFICIENT,
        inertia_coefficient=INERTIA_COEFFICIENT,
        water_density=WATER_DENSITY,
        vertical_width="immersion depth",
    )
    columns: dict[str, Floats] = {}
    for direction in ("horizontal", "vertical"):
        classic, improved = getattr(load, f"{direction}_classic"), getattr(load, direction)
        columns |= {
            f"{direction} load F0": classic,
            f"{direction} load F1": improved,
            f"{direction} difference F2": classic - improved,
            f"{direction} ratio P": 100 * (1 - improved / classic),
        }
    return columns


def _load(cell: Cell) -> Answer:
    theory, _, rest = cell.row.partition(", t = ")
    time = np.array([float(rest.removesuffix(" s"))])
    how = _SETTINGS
    if theory.startswith("Airy") and cell.column.startswith("vertical"):
        how = f"{_SETTINGS}, {_WITH_15}; {_AS_PRINTED}"
    return Answer(float(_loads(theory, time)[cell.column][0]), how)


def _extreme(cell: Cell, last: float) -> Answer:
    theory = "Airy theory" if cell.table == "5" else "Stokes theory"
    direction, _, end = cell.column.partition(" load, ")
    time = np.arange(round(10 * last) + 1) / 10
    series = _loads(theory, time)[f"{direction} load {_METHODS[cell.row]}"]
    how = f"{end} on a grid of 0.1 s up to {last:g} s; {_SETTINGS}"
    if cell.table == "5" and direction == "vertical":
        how += f", {_WITH_15}; {_AS_PRINTED}"
    return Answer(float(series.max() if end == "maximum" else series.min()), how)


def _ratio(cell: Cell) -> Answer:
    """From Table 7 as it ought to be, rounded as there."""
    direction, theory = cell.column[4:-1].split(", ")
    values = np.array(
        [
            one.value
            for one in cells_of_table("7")
            if one.row.startswith(theory) and one.column == f"{direction} ratio P"
        ],
        dtype=np.float64,
    )
    value = values.max() if cell.row == "maximum" else values.mean()
    how = f"{cell.row} of the {values.size} ratios in Table 7, as corrected"
    if theory.startswith("Stokes"):
        how += "; as printed without the row of 4.00 s"
    return Answer(float(value), how)
