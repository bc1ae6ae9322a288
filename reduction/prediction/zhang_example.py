"""The printed examples of Zhang (2015).

The numbers are those that the paper prints.  Where others are needed to reproduce its tables, they
were found from the tables, and this is stated.  No number here is a recommendation.

References
----------
.. [1] S. Zhang, C. Chen, Q. Zhang, D. Zhang and F. Zhang, "Wave Loads Computation for Offshore
   Floating Hose Based on Partially Immersed Cylinder Model of Improved Morison Formula," Open
   Petroleum Eng. J., vol. 8, 2015.
"""

from __future__ import annotations

from math import cosh, pi, sinh, tanh
from typing import Literal

import numpy as np

from reduction.prediction.wave_load import ImmersedSection
from reduction.prediction.wave_theory import WaveHarmonics
from reduction.record.errors import SettingsError

PrintedLoad = Literal["classic", "improved"]

DRAG_COEFFICIENT = 1.2
"""Eq. (12). [1]"""

INERTIA_COEFFICIENT = 2.0
"""Eq. (12). [1]"""

WATER_DENSITY = 1030.0
"""Density of Tables 5-7; Table 3 prints 1.025 g/cm3, used for the immersion. [kg m-3]"""

_WAVE_HEIGHT = 1.25  # m, Table 4

_WAVE_LENGTH = 20.0  # m, Table 4

_WAVE_PERIOD = 3.57  # s, Table 4; in the amplitudes

_ANGULAR_FREQUENCY = 1.76  # rad/s: 2 pi / 3.57; Table 4 prints 1.93

_GRAVITY = 9.8  # m/s2: not printed

_WAVE_NUMBER = 2 * pi / _WAVE_LENGTH  # eq. (14) prints 2 pi / T

_AIRY_DEPTH = 6.0  # m, sec. 5.1

_STOKES_DEPTH = 3.0  # m, sec. 5.2

# loads are at z = 0, the mean level; sec. 3 states the centre of the hose, 38 mm below


def printed_section() -> ImmersedSection:
    """Hose of the examples with the rounded immersion used in the tables.

    Notes
    -----
    `reduction.prediction.wave_load.immerse_hose` gives 95.124 mm and 0.0090994 m2 for it.

    Examples
    --------
    >>> print((printed_section().immersion_depth / printed_section().outer_diameter).round(3))
    0.834
    """
    return ImmersedSection(
        outer_diameter=np.array(0.114),
        submerged_section_area=np.array(0.0091),
        immersion_depth=np.array(0.0951),
    )


def printed_airy_wave(load: PrintedLoad = "improved") -> WaveHarmonics:
    """Linear wave, 6 m deep, as used in Tables 5 and 7.

    Notes
    -----
    Eq. (13): velocity H g k / (2 omega), acceleration 2 pi^2 H / T^2 coth kd; one would be the
    derivative of the other if length and period matched.  The vertical velocity of eq. (15) is
    H g k / (2 omega) tanh kd; the tables have pi H / T tanh kd in the classic column and
    pi H / T in the improved one.  This causes the 8.4 % between them at the largest vertical
    loads; with one velocity for both it is 16.7 %.

    Examples
    --------
    >>> wave = printed_airy_wave()
    >>> print(wave.horizontal_velocity.round(4), wave.vertical_velocity.round(4))
    [1.0933] [1.1]
    """
    depth = _WAVE_NUMBER * _AIRY_DEPTH
    rise = pi * _WAVE_HEIGHT / _WAVE_PERIOD
    vertical = {"classic": rise * tanh(depth), "improved": rise}
    if load not in vertical:
        raise SettingsError(
            "the paper has no such load", found=repr(load), needed="'classic' or 'improved'"
        )
    acceleration = 2 * pi**2 * _WAVE_HEIGHT / _WAVE_PERIOD**2
    return WaveHarmonics(
        wave_number=_WAVE_NUMBER,
        angular_frequency=_ANGULAR_FREQUENCY,
        elevation=np.array([_WAVE_HEIGHT / 2]),
        horizontal_velocity=np.array(
            [_WAVE_HEIGHT * _GRAVITY * _WAVE_NUMBER / (2 * _ANGULAR_FREQUENCY)]
        ),
        vertical_velocity=np.array([vertical[load]]),
        horizontal_acceleration=np.array([acceleration / tanh(depth)]),
        vertical_acceleration=np.array([-acceleration]),
    )


def printed_stokes_wave() -> WaveHarmonics:
    """Stokes' wave of second order, 3 m deep, as used in Tables 6 and 7.

    Notes
    -----
    Eq. (16) and (17), with omega rounded to 1.76 in the phase and T = 3.57 s in the amplitudes.
    The second harmonic of the surface is not printed; it is that of
    `reduction.prediction.wave_theory.stokes_wave`, and no load depends on it.

    Examples
    --------
    >>> print(printed_stokes_wave().horizontal_velocity.round(3))
    [1.494 0.389]
    """
    depth = _WAVE_NUMBER * _STOKES_DEPTH
    rise = pi * _WAVE_HEIGHT / _WAVE_PERIOD
    second = 3 / 4 * rise * pi * _WAVE_HEIGHT / _WAVE_LENGTH / sinh(depth) ** 4
    horizontal = np.array([rise / tanh(depth), second * cosh(2 * depth)])
    vertical = np.array([rise, second * sinh(2 * depth)])
    frequency = 2 * pi / _WAVE_PERIOD * np.array([1.0, 2.0])
    surface = _WAVE_NUMBER * _WAVE_HEIGHT**2 / 16
    surface *= cosh(depth) * (2 + cosh(2 * depth)) / sinh(depth) ** 3
    return WaveHarmonics(
        wave_number=_WAVE_NUMBER,
        angular_frequency=_ANGULAR_FREQUENCY,
        elevation=np.array([_WAVE_HEIGHT / 2, surface]),
        horizontal_velocity=horizontal,
        vertical_velocity=vertical,
        horizontal_acceleration=frequency * horizontal,
        vertical_acceleration=-frequency * vertical,
    )
