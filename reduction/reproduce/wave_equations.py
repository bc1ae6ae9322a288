"""Equations of Zhang (2015) against the waves and the loads of the package.

A factor is the quotient of the package's own amplitude by the rest of the printed formula.

References
----------
.. [1] S. Zhang, C. Chen, Q. Zhang, D. Zhang and F. Zhang, "Wave Loads Computation for Offshore
   Floating Hose Based on Partially Immersed Cylinder Model of Improved Morison Formula," Open
   Petroleum Eng. J., vol. 8, 2015.
"""

from __future__ import annotations

from math import log, pi

import numpy as np

from reduction.predict.dispersion import STANDARD_GRAVITY, wave_period_of
from reduction.predict.harmonics import WaveHarmonics
from reduction.predict.morison import load_factors
from reduction.predict.waves import airy_wave, stokes_wave
from reduction.predict.zhang2015 import printed_section
from reduction.reproduce.answers import Answer, Answers
from reduction.reproduce.wave_settings import (
    DEPTH,
    FREQUENCY,
    HEIGHT,
    LENGTH,
    NUMBER,
    SPEED,
)


def equation_answers() -> Answers:
    """Answers to the numbers in equations (1) to (17).

    Returns
    -------
    answers : Answers
        By cell.
    """
    return _loads() | _airy() | _stokes()


def _loads() -> Answers:
    drag, inertia, density = 1.2, 2.0, 1025.0
    section = printed_section()
    diameter = float(section.outer_diameter)
    factors = load_factors(
        section, drag_coefficient=drag, inertia_coefficient=inertia, water_density=density
    )
    load, morison = "horizontal wave load per length", "Morison's load of a whole cylinder"
    frequency = FREQUENCY
    length = 2 * pi * SPEED / frequency
    return {
        ("eq 1", load, "factor of the drag term"): Answer(
            float(factors.classic_drag) / (drag * density * diameter), morison),
        ("eq 1", load, "divisor of pi D2 in the inertia term"): Answer(
            inertia * density * pi * diameter**2 / float(factors.classic_inertia), morison),
        ("eq 5", "buoyancy F_B", "acceleration of gravity"): Answer(
            STANDARD_GRAVITY, "a weight over its mass"),
        ("eq 9", "load across the surface", "width of the vertical drag"): Answer(
            2000 * float(factors.vertical_drag) / (drag * density),
            "width of the submerged part, seen along a vertical flow"),
        ("eq 14", "wave number k", "divisor of 2 pi"): Answer(
            length, "speed over frequency of Table 4, c T, which are rounded",
            tolerance=length * 0.05 / SPEED),
    }  # fmt: skip


def _wave(depth: float, *, stokes: bool) -> WaveHarmonics:
    theory = stokes_wave if stokes else airy_wave
    return theory(
        wave_height=HEIGHT,
        wave_period=float(wave_period_of(NUMBER, depth)),
        water_depth=depth,
        elevation=0.0,
    )


def _airy() -> Answers:
    wave = _wave(DEPTH, stokes=False)
    period = 2 * pi / wave.angular_frequency
    slope = HEIGHT * STANDARD_GRAVITY * NUMBER / wave.angular_frequency
    depth = NUMBER * DEPTH
    acceleration = pi**2 * HEIGHT / period**2
    how = "Airy wave of the package, at the mean level"
    along, upwards = wave.horizontal_velocity[0], wave.vertical_velocity[0]
    return {
        ("eq 13", "Airy horizontal velocity", "divisor, with omega"): Answer(
            float(slope / along), how),
        ("eq 13", "Airy horizontal acceleration", "factor of pi2 H / T2"): Answer(
            float(wave.horizontal_acceleration[0] * np.tanh(depth) / acceleration), how),
        ("eq 15", "Airy vertical velocity", "divisor, with omega"): Answer(
            float(slope * np.tanh(depth) / upwards), how),
        ("eq 15", "Airy vertical acceleration", "factor of pi2 H / T2"): Answer(
            float(wave.vertical_acceleration[0] / acceleration), how),
    }  # fmt: skip


def _stokes() -> Answers:
    how = "second-order Stokes wave of the package, at the mean level"
    answers: Answers = {}
    for equation, direction, wide in (
        ("eq 16", "horizontal", np.cosh),
        ("eq 17", "vertical", np.sinh),
    ):
        spread = []
        depths = np.array([3.0, 4.0])
        for depth in depths:
            wave = _wave(float(depth), stokes=True)
            period = 2 * pi / wave.angular_frequency
            velocity = getattr(wave, f"{direction}_velocity")[1]
            unit = pi * HEIGHT / period * pi * HEIGHT / LENGTH * wide(2 * NUMBER * depth)
            spread.append(float(velocity / unit))
        sinh = np.sinh(NUMBER * depths)
        power = -log(spread[1] / spread[0]) / log(sinh[1] / sinh[0])
        acceleration = getattr(wave, f"{direction}_acceleration")
        first = pi**2 * HEIGHT / period**2
        second = first * pi * HEIGHT / LENGTH * wide(2 * NUMBER * depth) / sinh[1] ** 4
        first *= wide(NUMBER * depth) / sinh[1]
        row = f"Stokes {direction}"
        answers |= {
            (equation, f"{row} velocity, second harmonic", "factor"): Answer(
                spread[0] * float(sinh[0]) ** 4, how),
            (equation, f"{row} velocity, second harmonic", "power of sinh(kd) in the divisor"):
                Answer(power, how + "; slope of a logarithm over the depth"),
            (equation, f"{row} acceleration, first harmonic", "factor"): Answer(
                float(acceleration[0] / first), how),
            (equation, f"{row} acceleration, second harmonic", "factor"): Answer(
                float(acceleration[1] / second), how),
        }  # fmt: skip
    return answers
