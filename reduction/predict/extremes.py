r"""Greatest and least wave load over a period, between any samples.

A Morison load is a|u|u + b du/dt with sums of harmonics u and du/dt of the phase.  Where u keeps
its sign the derivative

.. math:: \pm 2 a\, u\, u' + b\, (\dot u)'

is a sum of harmonics too, of twice the order, whose zeros are roots of a polynomial.  Where u
changes its sign the derivative goes on without a jump, so that no extreme hides there.

References
----------
.. [1] S. Zhang, C. Chen, Q. Zhang, D. Zhang and F. Zhang, "Wave Loads Computation for Offshore
   Floating Hose Based on Partially Immersed Cylinder Model of Improved Morison Formula," Open
   Petroleum Eng. J., vol. 8, 2015, Tables 5 and 6.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_finite
from reduction.predict.coefficients import CODE_OF_HYDROLOGY
from reduction.predict.harmonics import WaveHarmonics
from reduction.predict.immersion import ImmersedSection
from reduction.predict.morison import SEAWATER_DENSITY, VerticalWidth, load_factors
from reduction.predict.phaseseries import (
    Coefficients,
    cosine_series,
    phase_derivative,
    root_phases,
    series_product,
    sine_series,
    sum_at,
)
from reduction.record import Floats, read_only_arrays


@dataclass(frozen=True)
@read_only_arrays
class LoadRange:
    """Greatest and least value over a period; arrays have the shape (...).

    Loads are in [N m-1]; times in [s], from 0 to the period, of one place where it happens.
    """

    maximum: Floats
    minimum: Floats
    time_of_maximum: Floats
    time_of_minimum: Floats

    @property
    def greatest(self) -> Floats:
        """Largest magnitude. [N m-1]."""
        return np.asarray(np.maximum(np.abs(self.maximum), np.abs(self.minimum)))


@dataclass(frozen=True)
class LoadExtremes:
    """Of the improved load and of the classic one, in both directions."""

    horizontal: LoadRange
    vertical: LoadRange
    horizontal_classic: LoadRange
    vertical_classic: LoadRange


def find_extremes(
    wave: WaveHarmonics,
    section: ImmersedSection,
    *,
    drag_coefficient: float = CODE_OF_HYDROLOGY.drag_coefficient[0],
    inertia_coefficient: float = CODE_OF_HYDROLOGY.inertia_coefficient,
    water_density: float = SEAWATER_DENSITY,
    current_velocity: float = 0.0,
    position: float = 0.0,
    vertical_width: VerticalWidth = "submerged",
) -> LoadExtremes:
    """Extremes of the loads of `reduction.predict.morison.wave_load` over a period.

    Parameters
    ----------
    wave : WaveHarmonics
        At the hose.
    section : ImmersedSection
        Arrays of shape (...).
    drag_coefficient, inertia_coefficient : float
        C_D and C_M = 1 + C_m. [1]
    water_density : float
        Of the sea. [kg m-3]
    current_velocity : float
        Along the wave. [m s-1]
    position : float
        Along the wave; the crest is at 0 at time 0. [m]
    vertical_width : {"submerged", "immersion depth"}
        See `reduction.predict.morison.load_factors`.

    Returns
    -------
    extremes : LoadExtremes
        Arrays of shape (...).

    Raises
    ------
    DataError
        If a coefficient, the current or the position is not finite, or the density or C_M
        is not positive.

    Notes
    -----
    Table 5 of [1]_ is the extreme on a grid of 0.1 s up to 5 s, its Table 6 up to 10 s; both
    miss the extremes of their own formula, by up to 0.4 N/m.

    Examples
    --------
    >>> from reduction.predict.immersion import immerse_hose
    >>> from reduction.predict.waves import airy_wave
    >>> hose = immerse_hose(outer_diameter=0.114, wall_thickness=0.006, wall_density=1250.0,
    ...                     content_density=830.0, water_density=1025.0)
    >>> wave = airy_wave(wave_height=1.25, wave_period=3.57, water_depth=6.0,
    ...                  elevation=float(hose.centre_elevation))
    >>> extremes = find_extremes(wave, hose)
    >>> print(extremes.horizontal_classic.maximum.round(2), extremes.horizontal.maximum.round(2))
    94.35 79.3
    """
    factors = load_factors(
        section,
        drag_coefficient=drag_coefficient,
        inertia_coefficient=inertia_coefficient,
        water_density=water_density,
        vertical_width=vertical_width,
    )
    current = float(as_finite("current_velocity", current_velocity))
    along = (
        cosine_series(wave.horizontal_velocity, current),
        sine_series(wave.horizontal_acceleration),
    )
    upwards = sine_series(wave.vertical_velocity), cosine_series(wave.vertical_acceleration)

    def of(motion: tuple[Coefficients, Coefficients], drag: Floats, inertia: Floats) -> LoadRange:
        return load_range(
            *motion, drag=drag, inertia=inertia, wave_number=wave.wave_number,
            angular_frequency=wave.angular_frequency, position=position,
        )  # fmt: skip

    return LoadExtremes(
        horizontal=of(along, factors.horizontal_drag, factors.inertia),
        vertical=of(upwards, factors.vertical_drag, factors.inertia),
        horizontal_classic=of(along, factors.classic_drag, factors.classic_inertia),
        vertical_classic=of(upwards, factors.classic_drag, factors.classic_inertia),
    )


def load_range(
    velocity: Coefficients,
    acceleration: Coefficients,
    *,
    drag: ArrayLike,
    inertia: ArrayLike,
    wave_number: float,
    angular_frequency: float,
    position: float = 0.0,
) -> LoadRange:
    """Greatest and least value of drag u|u| + inertia du/dt over a period.

    Parameters
    ----------
    velocity, acceleration : ndarray of complex, shape (2 n_harmonics + 1,)
        Coefficients of `reduction.predict.phaseseries`. [m s-1] and [m s-2]
    drag : array_like, shape (...)
        Factor of u|u|. [kg m-2]
    inertia : array_like, shape (...)
        Factor of the acceleration. [kg m-1]
    wave_number : float
        k. [rad m-1]
    angular_frequency : float
        omega. [rad s-1]
    position : float
        Along the wave. [m]

    Returns
    -------
    extremes : LoadRange
        Arrays of shape (...).

    Raises
    ------
    DataError
        If a factor or the position is not finite.

    Notes
    -----
    The load is tried at the phases of *all* roots of both branches with its true sign.  The
    extremes are among them, and no other phase can give more; so no root has to be judged.

    Examples
    --------
    2 cos|cos| + sin: the greatest value is at sin = 1/4.

    >>> u, a = cosine_series(np.array([1.0])), sine_series(np.array([1.0]))
    >>> extremes = load_range(u, a, drag=2.0, inertia=1.0, wave_number=1.0, angular_frequency=1.0)
    >>> print(extremes.maximum.round(6))
    2.125
    """
    drag_factor, inertia_factor = np.broadcast_arrays(
        as_finite("drag", drag), as_finite("inertia", inertia)
    )
    place = float(as_finite("position", position))
    squared = 2 * series_product(velocity, phase_derivative(velocity))
    slope = phase_derivative(acceleration)
    beside = (squared.size - slope.size) // 2
    slope = np.pad(slope, beside)
    candidates = [
        root_phases(
            sign * np.multiply.outer(drag_factor, squared)
            + np.multiply.outer(inertia_factor, slope)
        )
        for sign in (1.0, -1.0)
    ]
    phase = np.concatenate(candidates, axis=-1)
    speed = sum_at(velocity, phase)
    load = drag_factor[..., None] * speed * np.abs(speed)
    load += inertia_factor[..., None] * sum_at(acceleration, phase)
    time = np.mod(wave_number * place - phase, 2 * pi) / angular_frequency
    high, low = (pick(load, axis=-1, keepdims=True) for pick in (np.argmax, np.argmin))

    def at(values: Floats, index: np.ndarray) -> Floats:
        return np.asarray(np.take_along_axis(values, index, axis=-1)[..., 0])

    return LoadRange(
        maximum=at(load, high),
        minimum=at(load, low),
        time_of_maximum=at(time, high),
        time_of_minimum=at(time, low),
    )
