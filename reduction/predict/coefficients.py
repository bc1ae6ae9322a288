r"""Coefficients of drag and inertia with their sources, and where a case stands among them.

With the greatest velocity u and the diameter D,

.. math:: KC = \frac{u T}{D}, \qquad Re = \frac{u D}{\nu}, \qquad
          \frac{F_D}{F_I} = \frac{C_D}{\pi^2 C_M} KC

References
----------
.. [1] S. Zhang, C. Chen, Q. Zhang, D. Zhang and F. Zhang, "Wave Loads Computation for Offshore
   Floating Hose Based on Partially Immersed Cylinder Model of Improved Morison Formula," Open
   Petroleum Eng. J., vol. 8, 2015, Table 2 and eq. 12.
.. [2] G. H. Keulegan and L. H. Carpenter, "Forces on cylinders and plates in an oscillating
   fluid," J. Res. Nat. Bur. Standards, vol. 60, 1958, pp. 423-440.
.. [3] ITTC, "Fresh Water and Seawater Properties," Recommended Procedure 7.5-02-01-03, 2011.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_finite, as_positive
from reduction.predict.harmonics import WaveHarmonics
from reduction.predict.phaseseries import cosine_series, phase_derivative, root_phases, sum_at
from reduction.record import Floats, read_only_arrays

SEAWATER_VISCOSITY = 1.1892e-6
"""Kinematic, of standard seawater at 15 deg C ([3]_). [m2 s-1]"""
GREATEST_DIAMETER_TO_LENGTH = 0.2
"""Above it a cylinder changes the wave, and Morison's equation does not hold ([1]_, sec. 2). [1]"""


@dataclass(frozen=True)
class PublishedCoefficients:
    """One row of a table; where the source gives one number, low and high are equal.

    Parameters
    ----------
    wave_theory : str
        With which the source used them.
    drag_coefficient : tuple of 2 float
        C_D, low and high. [1]
    inertia_coefficient : float
        C_M = 1 + C_m, with the added mass C_m. [1]
    comment, source : str
        As printed.
    """

    wave_theory: str
    drag_coefficient: tuple[float, float]
    inertia_coefficient: float
    comment: str
    source: str


PUBLISHED_COEFFICIENTS = (
    PublishedCoefficients(
        "linear", (1.0, 1.0), 0.95,
        "mean values for ocean wave data on 13-24 in cylinders", "Wiegel et al. (1957)",
    ),
    PublishedCoefficients(
        "linear", (1.0, 1.4), 2.0,
        "recommended design values based on statistical analysis of published data",
        "Agerschou and Edens (1965)",
    ),
    PublishedCoefficients(
        "Stokes, third order", (1.34, 1.34), 1.6,
        "mean values for oscillatory flow for 2-3 in cylinders", "Keulegan and Carpenter (1958)",
    ),
    PublishedCoefficients(
        "Stokes, fifth order", (0.8, 1.0), 2.0,
        "recommended values based on statistical analysis of published data",
        "Agerschou and Edens (1965)",
    ),
)  # fmt: skip
"""Table 2 of [1]_; none is for a cylinder that floats."""

CODE_OF_HYDROLOGY = PublishedCoefficients(
    "any", (1.2, 1.2), 2.0,
    "settled for the sea area of China; used in all examples of the paper",
    "Code of Hydrology for Sea Harbour (1998)",
)  # fmt: skip
"""Eq. (12) of [1]_: the default of a wave load."""


@dataclass(frozen=True)
@read_only_arrays
class FlowRegime:
    """Where a hose in a wave stands; arrays have the shape (...) of the diameters.

    Parameters
    ----------
    greatest_velocity : float
        Of the water across the hose, over a period, current included. [m s-1]
    keulegan_carpenter_number, reynolds_number : ndarray
        KC, Re. [1]
    frequency_parameter : ndarray
        Re / KC. [1]
    drag_to_inertia : ndarray
        Greatest drag over greatest inertia of a whole cylinder in a sine. [1]
    diameter_to_length : ndarray
        Of the wave; at most 0.2 for Morison's equation. [1]
    """

    greatest_velocity: float
    keulegan_carpenter_number: Floats
    reynolds_number: Floats
    frequency_parameter: Floats
    drag_to_inertia: Floats
    diameter_to_length: Floats


def keulegan_carpenter_number(
    greatest_velocity: ArrayLike, wave_period: ArrayLike, outer_diameter: ArrayLike
) -> Floats:
    """Way of the water over the diameter, times pi in a sine.

    Parameters
    ----------
    greatest_velocity : array_like, shape (...)
        Of the water over a period. [m s-1]
    wave_period : array_like, shape (...)
        Of the wave. [s]
    outer_diameter : array_like, shape (...)
        Of the cylinder. [m]

    Returns
    -------
    keulegan_carpenter_number : ndarray, shape (...)
        KC. [1]

    Raises
    ------
    DataError
        If a velocity is not finite, or a period or diameter not positive.

    Notes
    -----
    Defined in [2]_.

    Examples
    --------
    The hose of [1]_ in its 6 m deep wave, 1.15 m/s: far in the region of drag, yet not steady.

    >>> print(keulegan_carpenter_number(1.15, 3.57, 0.114).round(1))
    36.0
    """
    speed = np.abs(as_finite("greatest_velocity", greatest_velocity))
    period = as_positive("wave_period", wave_period)
    return np.asarray(speed * period / as_positive("outer_diameter", outer_diameter))


def reynolds_number(
    greatest_velocity: ArrayLike,
    outer_diameter: ArrayLike,
    *,
    kinematic_viscosity: float = SEAWATER_VISCOSITY,
) -> Floats:
    """Inertia of the flow over its friction.

    Parameters
    ----------
    greatest_velocity : array_like, shape (...)
        Of the water over a period. [m s-1]
    outer_diameter : array_like, shape (...)
        Of the cylinder. [m]
    kinematic_viscosity : float
        Of the water. [m2 s-1]

    Returns
    -------
    reynolds_number : ndarray, shape (...)
        Re. [1]

    Raises
    ------
    DataError
        If a velocity is not finite, or a diameter or the viscosity not positive.

    Notes
    -----
    Viscosity of seawater from [3]_.

    Examples
    --------
    >>> print(reynolds_number(1.15, 0.114).round(-3))
    110000.0
    """
    speed = np.abs(as_finite("greatest_velocity", greatest_velocity))
    viscosity = as_positive("kinematic_viscosity", kinematic_viscosity)
    return np.asarray(speed * as_positive("outer_diameter", outer_diameter) / viscosity)


def drag_to_inertia(
    keulegan_carpenter_number: ArrayLike,
    *,
    drag_coefficient: float = CODE_OF_HYDROLOGY.drag_coefficient[0],
    inertia_coefficient: float = CODE_OF_HYDROLOGY.inertia_coefficient,
) -> Floats:
    """Greatest drag over greatest inertia of a whole cylinder in a sine.

    Parameters
    ----------
    keulegan_carpenter_number : array_like, shape (...)
        KC. [1]
    drag_coefficient, inertia_coefficient : float
        C_D, C_M. [1]

    Returns
    -------
    ratio : ndarray, shape (...)
        Above 1 the drag is the larger one. [1]

    Raises
    ------
    DataError
        If a number is not finite, or C_M not positive.

    Notes
    -----
    From eq. (1) of [1]_ with u = u_max cos: (C_D D u^2 / 2) / (C_M pi D^2 / 4 * 2 pi u / T).

    Examples
    --------
    >>> print(drag_to_inertia(36.0).round(2))
    2.19
    """
    number = as_finite("keulegan_carpenter_number", keulegan_carpenter_number)
    drag = as_finite("drag_coefficient", drag_coefficient)
    return np.asarray(
        drag * number / (pi**2 * as_positive("inertia_coefficient", inertia_coefficient))
    )


def flow_regime(
    wave: WaveHarmonics,
    outer_diameter: ArrayLike,
    *,
    current_velocity: float = 0.0,
    drag_coefficient: float = CODE_OF_HYDROLOGY.drag_coefficient[0],
    inertia_coefficient: float = CODE_OF_HYDROLOGY.inertia_coefficient,
    kinematic_viscosity: float = SEAWATER_VISCOSITY,
) -> FlowRegime:
    """Numbers by which coefficients are chosen, of hoses in one wave.

    Parameters
    ----------
    wave : WaveHarmonics
        At the hose.
    outer_diameter : array_like, shape (...)
        Of the hoses. [m]
    current_velocity : float
        Along the wave. [m s-1]
    drag_coefficient, inertia_coefficient : float
        C_D, C_M. [1]
    kinematic_viscosity : float
        Of the water. [m2 s-1]

    Returns
    -------
    regime : FlowRegime
        Arrays of shape (...).

    Raises
    ------
    DataError
        If a diameter, the viscosity or C_M is not positive.

    Notes
    -----
    Of the horizontal velocity, the current included; some sources give KC for the wave alone
    and the current apart.  Table 2 of [1]_ gives no range of KC or Re for its numbers,
    though [2]_ shows that they depend on KC.

    Examples
    --------
    >>> from reduction.predict.waves import airy_wave
    >>> wave = airy_wave(wave_height=1.25, wave_period=3.57, water_depth=6.0, elevation=-0.038)
    >>> print(flow_regime(wave, 0.114).keulegan_carpenter_number.round(1))
    35.4
    """
    period = 2 * pi / wave.angular_frequency
    velocity = cosine_series(wave.horizontal_velocity, current_velocity)
    speed = float(np.max(np.abs(sum_at(velocity, root_phases(phase_derivative(velocity))))))
    number = keulegan_carpenter_number(speed, period, outer_diameter)
    reynolds = reynolds_number(speed, outer_diameter, kinematic_viscosity=kinematic_viscosity)
    return FlowRegime(
        greatest_velocity=speed,
        keulegan_carpenter_number=number,
        reynolds_number=reynolds,
        frequency_parameter=np.asarray(reynolds / number),
        drag_to_inertia=drag_to_inertia(
            number, drag_coefficient=drag_coefficient, inertia_coefficient=inertia_coefficient
        ),
        diameter_to_length=np.asarray(
            as_positive("outer_diameter", outer_diameter) * wave.wave_number / (2 * pi)
        ),
    )
