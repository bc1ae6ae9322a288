r"""Wave load on a floating hose per length, by Morison's equation and by its improved form.

.. math::
   f = \tfrac12 C_D \rho\, b\, (u + U) |u + U| + C_M \rho\, S\, \dot u

The classic form takes the whole section, b = D and S = pi D^2/4; the improved form what is
under water, S = S_1 and b = h for the horizontal load.

References
----------
.. [1] S. Zhang, C. Chen, Q. Zhang, D. Zhang and F. Zhang, "Wave Loads Computation for Offshore
   Floating Hose Based on Partially Immersed Cylinder Model of Improved Morison Formula," Open
   Petroleum Eng. J., vol. 8, 2015, eq. 1-3, 7-10.
.. [2] J. R. Morison, M. P. O'Brien, J. W. Johnson and S. A. Schaaf, "The force exerted by
   surface waves on piles," J. Petroleum Tech., vol. 2, 1950, pp. 149-154.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_finite, as_positive
from reduction.predict.coefficients import CODE_OF_HYDROLOGY
from reduction.predict.harmonics import WaveHarmonics
from reduction.predict.immersion import ImmersedSection
from reduction.predict.motion import particle_motion
from reduction.record import Floats, read_only_arrays

VerticalWidth = Literal["submerged", "immersion depth"]

SEAWATER_DENSITY = 1025.0
"""Table 3 of [1]_. [kg m-3]"""


@dataclass(frozen=True)
@read_only_arrays
class LoadFactors:
    """What u|u| and the acceleration are multiplied with; arrays have the shape (...).

    Drag factors are in [kg m-2], inertia factors in [kg m-1]; the classic load has the same
    in both directions.
    """

    horizontal_drag: Floats
    vertical_drag: Floats
    inertia: Floats
    classic_drag: Floats
    classic_inertia: Floats


@dataclass(frozen=True)
@read_only_arrays
class WaveLoad:
    """Load per length of hose over time; loads have the shape (..., n_times).

    Parameters
    ----------
    time : ndarray, shape (n_times,)
        When. [s]
    horizontal, vertical : ndarray
        Improved form, along the wave and upwards. [N m-1]
    horizontal_classic, vertical_classic : ndarray
        The same on a hose wholly under water. [N m-1]
    horizontal_drag, vertical_drag : ndarray
        Part of the improved form; the rest is inertia. [N m-1]
    section : ImmersedSection
        Of the hose, arrays of shape (...).
    """

    time: Floats
    horizontal: Floats
    vertical: Floats
    horizontal_classic: Floats
    vertical_classic: Floats
    horizontal_drag: Floats
    vertical_drag: Floats
    section: ImmersedSection


def load_factors(
    section: ImmersedSection,
    *,
    drag_coefficient: float = CODE_OF_HYDROLOGY.drag_coefficient[0],
    inertia_coefficient: float = CODE_OF_HYDROLOGY.inertia_coefficient,
    water_density: float = SEAWATER_DENSITY,
    vertical_width: VerticalWidth = "submerged",
) -> LoadFactors:
    """Drag and inertia of a section per velocity squared and per acceleration.

    Parameters
    ----------
    section : ImmersedSection
        Arrays of shape (...).
    drag_coefficient, inertia_coefficient : float
        C_D and C_M = 1 + C_m. [1]
    water_density : float
        Of the sea. [kg m-3]
    vertical_width : {"submerged", "immersion depth"}
        Width that the vertical flow meets: that of the part under water, seen from below (D
        once more than half is under), or h as [1]_ has it.

    Returns
    -------
    factors : LoadFactors
        Arrays of shape (...).

    Raises
    ------
    DataError
        If the density or C_M is not positive, or C_D is not finite.

    Notes
    -----
    Eq. (9) of [1]_ takes the height h for the vertical load too.  Water that rises meets the
    width, which is D for its hose: h understates the drag by 1 - h/D, 16.6 %.

    Examples
    --------
    >>> hose = ImmersedSection(np.array(0.114), np.array(0.0091), np.array(0.0951))
    >>> factors = load_factors(hose)
    >>> print(factors.horizontal_drag.round(2), factors.vertical_drag.round(2))
    58.49 70.11
    """
    drag = float(as_finite("drag_coefficient", drag_coefficient))
    inertia = float(as_positive("inertia_coefficient", inertia_coefficient))
    density = float(as_positive("water_density", water_density))
    width = section.submerged_width if vertical_width == "submerged" else section.immersion_depth
    return LoadFactors(
        horizontal_drag=np.asarray(drag * density / 2 * section.immersion_depth),
        vertical_drag=np.asarray(drag * density / 2 * width),
        inertia=np.asarray(inertia * density * section.submerged_section_area),
        classic_drag=np.asarray(drag * density / 2 * section.outer_diameter),
        classic_inertia=np.asarray(inertia * density * section.section_area),
    )


def wave_load(
    wave: WaveHarmonics,
    section: ImmersedSection,
    time: ArrayLike,
    *,
    drag_coefficient: float = CODE_OF_HYDROLOGY.drag_coefficient[0],
    inertia_coefficient: float = CODE_OF_HYDROLOGY.inertia_coefficient,
    water_density: float = SEAWATER_DENSITY,
    current_velocity: float = 0.0,
    position: float = 0.0,
    vertical_width: VerticalWidth = "submerged",
) -> WaveLoad:
    """Load of a wave, and of a current with it, on a hose that lies along the crest.

    Parameters
    ----------
    wave : WaveHarmonics
        At the hose: at `ImmersedSection.centre_elevation` for the consistent answer.
    section : ImmersedSection
        Arrays of shape (...).
    time : array_like, shape (n_times,)
        When. [s]
    drag_coefficient, inertia_coefficient : float
        C_D and C_M = 1 + C_m. [1]
    water_density : float
        Of the sea. [kg m-3]
    current_velocity : float
        Along the wave, added to its horizontal velocity before it is squared. [m s-1]
    position : float
        Along the wave; the crest is at 0 at time 0. [m]
    vertical_width : {"submerged", "immersion depth"}
        See `load_factors`.

    Returns
    -------
    load : WaveLoad
        Loads of shape (..., n_times).

    Raises
    ------
    DataError
        If a time or C_D is not finite, or the density or C_M is not positive.

    Notes
    -----
    Eq. (1) and (10) of [1]_.  The hose is held in place with its waterline at the mean level,
    as there; one that rides the wave meets less.  Drag is taken direction by direction; on a
    round section wholly under water it would go with the speed of both together, which is
    more.  Lift and the change of buoyancy are left out.

    Examples
    --------
    Table 7 of [1]_ prints 84.21 and 70.25 N/m at time 0; with a length that fits the period, the
    hose at its own depth and 1025 kg/m3 it is this.

    >>> from reduction.predict.immersion import immerse_hose
    >>> from reduction.predict.waves import airy_wave
    >>> hose = immerse_hose(outer_diameter=0.114, wall_thickness=0.006, wall_density=1250.0,
    ...                     content_density=830.0, water_density=1025.0)
    >>> wave = airy_wave(wave_height=1.25, wave_period=3.57, water_depth=6.0,
    ...                  elevation=float(hose.centre_elevation))
    >>> load = wave_load(wave, hose, 0.0)
    >>> print(load.horizontal_classic.round(2), load.horizontal.round(2))
    [89.51] [74.69]
    """
    factors = load_factors(
        section,
        drag_coefficient=drag_coefficient,
        inertia_coefficient=inertia_coefficient,
        water_density=water_density,
        vertical_width=vertical_width,
    )
    current = float(as_finite("current_velocity", current_velocity))
    motion = particle_motion(wave, time, position)
    along, upwards = motion.horizontal_velocity + current, motion.vertical_velocity
    along_squared, upwards_squared = along * np.abs(along), upwards * np.abs(upwards)
    drag = np.multiply.outer(factors.horizontal_drag, along_squared)
    lift = np.multiply.outer(factors.vertical_drag, upwards_squared)

    def times(factor: Floats, series: Floats) -> Floats:
        return np.asarray(np.multiply.outer(factor, series))

    return WaveLoad(
        time=np.atleast_1d(np.array(time, dtype=np.float64)),
        horizontal=drag + times(factors.inertia, motion.horizontal_acceleration),
        vertical=lift + times(factors.inertia, motion.vertical_acceleration),
        horizontal_classic=times(factors.classic_drag, along_squared)
        + times(factors.classic_inertia, motion.horizontal_acceleration),
        vertical_classic=times(factors.classic_drag, upwards_squared)
        + times(factors.classic_inertia, motion.vertical_acceleration),
        horizontal_drag=np.asarray(drag),
        vertical_drag=np.asarray(lift),
        section=section,
    )
