r"""Wind, current and wave together on a moored floating hose: the anchor force.

.. math:: F_P = F_{wind} + F_{wave} + F_{current}

Drag goes with the square of the velocity, so that wave and current do not add: their
velocities do.

References
----------
.. [1] S. Zhang, C. Chen, Q. Zhang, D. Zhang and F. Zhang, "Wave Loads Computation for Offshore
   Floating Hose Based on Partially Immersed Cylinder Model of Improved Morison Formula," Open
   Petroleum Eng. J., vol. 8, 2015, eq. 4, Fig. 3.
.. [2] ISO 2533:1975, Standard Atmosphere.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reduction.checks import as_finite, as_positive
from reduction.predict.coefficients import CODE_OF_HYDROLOGY
from reduction.predict.extremes import LoadRange, find_extremes
from reduction.predict.harmonics import WaveHarmonics
from reduction.predict.immersion import ImmersedSection
from reduction.predict.morison import SEAWATER_DENSITY, load_factors
from reduction.record import Floats, read_only_arrays

AIR_DENSITY = 1.225
"""At sea level, 15 deg C ([2]_). [kg m-3]"""


@dataclass(frozen=True)
@read_only_arrays
class AnchorForce:
    """Horizontal force on a length of hose; arrays have the shape (...), positive along the wave.

    Parameters
    ----------
    wind, current : ndarray
        Each alone, steady. [N]
    wave : ndarray
        Alone: that extreme of a period that makes the sum greatest. [N]
    separate : ndarray
        Their sum, eq. (4) as written. [N]
    combined : ndarray
        Wind, and wave and current as one flow: the extreme of the larger magnitude. [N]
    difference : ndarray
        Combined less separate force, over the combined one. [1]
    """

    wind: Floats
    current: Floats
    wave: Floats
    separate: Floats
    combined: Floats
    difference: Floats


def wind_load(
    section: ImmersedSection,
    *,
    wind_velocity: float,
    wind_drag_coefficient: float,
    air_density: float = AIR_DENSITY,
) -> Floats:
    """Load of a steady wind on the part of the hose above the water.

    Parameters
    ----------
    section : ImmersedSection
        Arrays of shape (...).
    wind_velocity : float
        Across the hose at its height, positive along the wave. [m s-1]
    wind_drag_coefficient : float
        On the emergent height. [1]
    air_density : float
        Of the air. [kg m-3]

    Returns
    -------
    load : ndarray, shape (...)
        Per length. [N m-1]

    Raises
    ------
    DataError
        If a velocity or coefficient is not finite, or the density not positive.

    Notes
    -----
    [1]_ names the load in eq. (4) and gives no form; this is drag on D - h.  A wind stated for
    a height of 10 m is larger than that at the hose.

    Examples
    --------
    >>> hose = ImmersedSection(np.array(0.114), np.array(0.0091), np.array(0.0951))
    >>> print(wind_load(hose, wind_velocity=10.0, wind_drag_coefficient=1.2).round(3))
    1.389
    """
    speed = float(as_finite("wind_velocity", wind_velocity))
    drag = float(as_finite("wind_drag_coefficient", wind_drag_coefficient))
    density = float(as_positive("air_density", air_density))
    return np.asarray(density / 2 * drag * section.emergent_height * speed * abs(speed))


def current_load(
    section: ImmersedSection,
    *,
    current_velocity: float,
    drag_coefficient: float = CODE_OF_HYDROLOGY.drag_coefficient[0],
    water_density: float = SEAWATER_DENSITY,
) -> Floats:
    """Load of a steady current alone.

    Parameters
    ----------
    section : ImmersedSection
        Arrays of shape (...).
    current_velocity : float
        Across the hose, positive along the wave. [m s-1]
    drag_coefficient : float
        C_D. [1]
    water_density : float
        Of the sea. [kg m-3]

    Returns
    -------
    load : ndarray, shape (...)
        Per length. [N m-1]

    Raises
    ------
    DataError
        If the velocity or C_D is not finite, or the density not positive.

    Notes
    -----
    The drag of eq. (9) of [1]_ with the current for the velocity.

    Examples
    --------
    >>> hose = ImmersedSection(np.array(0.114), np.array(0.0091), np.array(0.0951))
    >>> print(current_load(hose, current_velocity=0.5).round(3))
    14.622
    """
    speed = float(as_finite("current_velocity", current_velocity))
    factors = load_factors(section, drag_coefficient=drag_coefficient, water_density=water_density)
    return np.asarray(factors.horizontal_drag * speed * abs(speed))


def anchor_force(
    wave: WaveHarmonics,
    section: ImmersedSection,
    *,
    hose_length: float,
    current_velocity: float = 0.0,
    wind_velocity: float = 0.0,
    wind_drag_coefficient: float = CODE_OF_HYDROLOGY.drag_coefficient[0],
    drag_coefficient: float = CODE_OF_HYDROLOGY.drag_coefficient[0],
    inertia_coefficient: float = CODE_OF_HYDROLOGY.inertia_coefficient,
    water_density: float = SEAWATER_DENSITY,
    air_density: float = AIR_DENSITY,
) -> AnchorForce:
    """Greatest horizontal force of wind, wave and current, added and combined.

    Parameters
    ----------
    wave : WaveHarmonics
        At the hose.
    section : ImmersedSection
        Arrays of shape (...).
    hose_length : float
        That meets the same phase: lying along the crest. [m]
    current_velocity, wind_velocity : float
        Across the hose, positive along the wave. [m s-1]
    wind_drag_coefficient : float
        On the emergent height. [1]
    drag_coefficient, inertia_coefficient : float
        C_D and C_M = 1 + C_m. [1]
    water_density, air_density : float
        Of sea and air. [kg m-3]

    Returns
    -------
    force : AnchorForce
        Arrays of shape (...).

    Raises
    ------
    DataError
        If a velocity or C_D is not finite, or a length, density or C_M is not positive.

    Notes
    -----
    Eq. (4) of [1]_, the extreme case in which all act in one direction, adds loads; the cross
    term 2 u U of the squared velocity is missing there, so that the sum is too low where the
    current follows the wave, the very case meant.  Where the current opposes the wave the
    term takes from the load under the crest, and the sum is too high.

    Examples
    --------
    A current of 0.5 m/s and a wind of 10 m/s on 100 m of the hose of [1]_.

    >>> from reduction.predict.waves import airy_wave
    >>> hose = ImmersedSection(np.array(0.114), np.array(0.0091), np.array(0.0951))
    >>> wave = airy_wave(wave_height=1.25, wave_period=3.57, water_depth=6.0, elevation=-0.038)
    >>> force = anchor_force(wave, hose, hose_length=100.0, current_velocity=0.5,
    ...                      wind_velocity=10.0)
    >>> print(force.separate.round(0), force.combined.round(0), force.difference.round(3))
    9530.0 15996.0 0.404
    """
    length = float(as_positive("hose_length", hose_length))
    wind = length * wind_load(
        section,
        wind_velocity=wind_velocity,
        wind_drag_coefficient=wind_drag_coefficient,
        air_density=air_density,
    )
    current = length * current_load(
        section,
        current_velocity=current_velocity,
        drag_coefficient=drag_coefficient,
        water_density=water_density,
    )

    def water(velocity: float) -> LoadRange:
        return find_extremes(
            wave,
            section,
            drag_coefficient=drag_coefficient,
            inertia_coefficient=inertia_coefficient,
            water_density=water_density,
            current_velocity=velocity,
        ).horizontal

    alone, together = water(0.0), water(current_velocity)
    wave_force = _larger_sum(wind + current, length * alone.maximum, length * alone.minimum)
    separate = wind + current + wave_force
    combined = wind + _larger_sum(wind, length * together.maximum, length * together.minimum)
    return AnchorForce(
        wind=np.asarray(wind),
        current=np.asarray(current),
        wave=wave_force,
        separate=np.asarray(separate),
        combined=np.asarray(combined),
        difference=np.asarray((combined - separate) / np.where(combined == 0, np.nan, combined)),
    )


def _larger_sum(steady: Floats, maximum: Floats, minimum: Floats) -> Floats:
    """That extreme which with the steady force is of the larger magnitude."""
    return np.asarray(
        np.where(np.abs(steady + maximum) >= np.abs(steady + minimum), maximum, minimum)
    )
